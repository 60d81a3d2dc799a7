/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Convolution by fast Fourier transforms: exact to rounding on all boundaries, N log N.
 */
#include <math.h>
#include <stdlib.h>

#include "engine.h"
#include "fft.h"
#include "libcontact/expected.h"

struct plan {
    struct rc_fft *fft;
    struct rc_spectrum *kernel;
    double error;
};

static enum rc_precision
precision(const struct rc_sum *sum)
{
    return sum->tol >= RC_SINGLE_FLOOR && !sum->precise ? RC_SINGLE : RC_DOUBLE;
}

static void
plan_free(void *at)
{
    struct plan *plan = at;

    if (plan == NULL)
        return;
    rc_fft_free(plan->fft);
    rc_spectrum_free(plan->kernel);
    free(plan);
}

RC_OWNER(plan)

static void *
plan_new(const struct rc_sum *sum, struct rc_err *err)
{
    RC_OWN(plan, plan) = calloc(1, sizeof *plan);

    if (rc_ranks_need(sum->ranks, plan != NULL, err, "out of memory for a plan") != RC_OK)
        return NULL;
    plan->fft =
        rc_fft_new(sum->ranks, NULL, &sum->shape, sum->boundary, precision(sum), sum->threads, err);
    if (plan->fft == NULL || (plan->kernel = rc_spectrum_new(plan->fft, err)) == NULL ||
        rc_spectrum_set(plan->kernel, plan->fft, &sum->kernel, err) != RC_OK)
        return NULL;
    /* rounding grows with the depth of the transforms */
    plan->error = (precision(sum) == RC_SINGLE ? 6e-8 : 1e-16) *
                  log2(4 * (double)sum->shape.nx * (double)sum->shape.ny);
    return rc_give(&plan);
}

static void
apply(void *at, const double *p, double *u)
{
    struct plan *plan = at;

    rc_fft_apply(plan->fft, plan->kernel, p, u);
}

static double
error(const void *at)
{
    return ((const struct plan *)at)->error;
}

static struct rc_fft *
fft(void *at)
{
    return ((struct plan *)at)->fft;
}

static double
seconds(const struct rc_sum *sum)
{
    const double n = (double)(sum->shape.nx * sum->shape.ny);
    const bool profile = sum->shape.nx == 1 || sum->shape.ny == 1;

    return RC_SUM_START +
           (profile ? RC_SUM_PROFILE * n
                    : rc_by_padding(sum->boundary, RC_SUM_FREE * n,
                                    RC_SUM_PERIODIC * n + RC_SUM_PAST * fmax(n - 1e6, 0)));
}

const struct rc_engine rc_engine_fft = {
    .info = {.name = "fft",
             .summary = "fast Fourier transforms: exact to rounding, N log N",
             .periodic = true,
             .mixed = true,
             .order = 1,
             .sum_bytes = {12.7, 5.4},
             .contact_bytes = {81.3, 59.5}},
    .precise =
        {.name = "fft64",
         .summary =
             "fast Fourier transforms in double precision: exact to rounding for any tolerance",
         .periodic = true,
         .precise = true,
         .order = 1,
         .sum_bytes = {24.7, 10.4},
         .contact_bytes = {97.3, 75.5}},
    .transforms = true,
    .seconds = seconds,
    .new = plan_new,
    .apply = apply,
    .error = error,
    .free = plan_free,
    .fft = fft,
};
