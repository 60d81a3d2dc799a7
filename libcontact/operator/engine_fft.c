/*
 * Convolution by fast Fourier transforms: exact to rounding on both boundaries, N log N.
 */
#include "engine_fft.h"

#include <math.h>
#include <stdlib.h>

struct plan {
    struct rc_fft *fft;
    struct rc_spectrum *kernel;
    double error;
};

void
rc_engine_fft_free(void *at)
{
    struct plan *plan = at;

    if (plan == NULL)
        return;
    rc_fft_free(plan->fft);
    rc_spectrum_free(plan->kernel);
    free(plan);
}

void *
rc_engine_fft_new(const struct rc_sum *sum, enum rc_precision precision, struct rc_err *err)
{
    struct plan *plan = calloc(1, sizeof *plan);

    if (plan == NULL) {
        rc_err_set(err, "out of memory for a plan");
        return NULL;
    }
    if ((plan->fft = rc_fft_new(&sum->shape, sum->boundary, precision, sum->threads, err)) ==
            NULL ||
        (plan->kernel = rc_spectrum_new(plan->fft, err)) == NULL ||
        rc_spectrum_set(plan->kernel, plan->fft, sum->kernel, sum->component, &sum->medium, err) !=
            RC_OK) {
        rc_engine_fft_free(plan);
        return NULL;
    }
    /* rounding grows with the depth of the transforms */
    plan->error = (precision == RC_SINGLE ? 6e-8 : 1e-16) *
                  log2(4 * (double)sum->shape.nx * (double)sum->shape.ny);
    return plan;
}

size_t
rc_engine_fft_memory(const struct rc_sum *sum, enum rc_precision precision)
{
    return rc_fft_memory(&sum->shape, sum->boundary, precision);
}

void
rc_engine_fft_apply(void *at, const double *p, double *u)
{
    struct plan *plan = at;

    rc_fft_apply(plan->fft, plan->kernel, p, u);
}

double
rc_engine_fft_error(const void *plan)
{
    return ((const struct plan *)plan)->error;
}

/* ---- the precision that is needed ---- */

/* Errors below this are asked of double precision; single gives some 1e-6 of the largest |u|. */
static const double single_floor = 1e-5;

static enum rc_precision
precision(const struct rc_sum *sum)
{
    return sum->tol >= single_floor ? RC_SINGLE : RC_DOUBLE;
}

static void *
plan_new(const struct rc_sum *sum, struct rc_err *err)
{
    return rc_engine_fft_new(sum, precision(sum), err);
}

static size_t
memory(const struct rc_sum *sum)
{
    return rc_engine_fft_memory(sum, precision(sum));
}

const struct rc_engine rc_engine_fft = {
    .name = "fft",
    .summary = "fast Fourier transforms: exact to rounding, N log N",
    .memory = memory,
    .new = plan_new,
    .apply = rc_engine_fft_apply,
    .error = rc_engine_fft_error,
    .free = rc_engine_fft_free,
};
