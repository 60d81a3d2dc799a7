/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the tests of steady sliding share: materials, maps and a model that is driven to a speed. */
#ifndef TESTS_VISCO_SLIDING_H
#define TESTS_VISCO_SLIDING_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "libcontact/contact.h"
#include "tests/exact.h"

static struct rc_err err;

/* A standard linear solid: instantaneous and relaxed compliance 1/10 and 1, retardation time 1. */
static struct rc_relaxation *
standard(void)
{
    struct rc_relaxation *r = rc_relaxation_new(1, 1, (double[]){9}, (double[]){0.1}, &err);

    assert_non_null(r);
    return r;
}

/* Loss and storage as w^power over six decades; tan delta is about 0.95 with 0.45. */
static struct rc_relaxation *
power_law(double power, double relaxed)
{
    double modulus[14], time[14];
    struct rc_relaxation *r;

    for (int k = 0; k < 14; k++) {
        time[k] = pow(10, k / 2.0 - 5);
        modulus[k] = pow(time[k], -power);
    }
    r = rc_relaxation_new(relaxed, 14, modulus, time, &err);
    assert_non_null(r);
    return r;
}

static struct rc_model *
sliding(struct rc_shape s, struct rc_boundary boundary, const double *h, double tol,
        const struct rc_sliding_problem *law)
{
    const struct rc_problem problem = {.boundary = boundary, .tol = tol, .threads = 1};
    struct rc_model *m = rc_sliding_new(&s, h, &problem, law, &err);

    if (m == NULL)
        fail_msg("%s", err.text);
    return m;
}

/* Slides under a load or an approach. */
static const struct rc_sliding_figures *
slide_by(struct rc_model *m, int what, double amount, double speed)
{
    struct rc_point to = {0};

    rc_point_set(&to, what, amount);
    rc_point_set(&to, RC_SPEED, speed);
    if (rc_model_run(m, &to, &err) != RC_OK || rc_model_look(m, NULL, &err) != RC_OK)
        fail_msg("%s", err.text);
    return rc_sliding_result(m);
}

static void
frame(struct rc_model *m, const char *name, double *to)
{
    assert_int_equal(rc_model_frame(m, name, to, &err), RC_OK);
}

static double
difference(const double *a, const double *b, size_t n)
{
    double sum = 0, all = 0;

    for (size_t k = 0; k < n; k++) {
        sum += fabs(a[k] - b[k]);
        all += fabs(b[k]);
    }
    return sum / all;
}

/* A self-affine map with the RMS slope 1, and a dome of height `dome` so that it touches in its middle. */
static void
rough(struct rc_shape s, double cut, double dome, uint64_t seed, double *h)
{
    const struct rc_selfaffine o = {
        .hurst = 0.8, .rms_slope = 1, .short_cut = cut * s.dx, .long_cut = 0.25, .seed = seed};

    if (rc_synth_selfaffine(&s, &o, h, &err) != RC_OK)
        fail_msg("%s", err.text);
    for (size_t k = 0; k < s.nx * s.ny; k++) {
        const double x = ((double)(k % s.nx) + 0.5) / (double)s.nx - 0.5,
                     y = ((double)(k / s.nx) + 0.5) / (double)s.ny - 0.5;
        h[k] -= dome * (x * x + y * y);
    }
}

/* Estimates over errors, of errors above 1e-5. */
struct ratios {
    size_t n, below;
    double of[2000];
};

static void
add_ratio(struct ratios *r, double estimate, double error)
{
    if (!(error > 1e-5))
        return;
    assert_true(r->n < sizeof r->of / sizeof *r->of);
    r->of[r->n++] = estimate / error;
    r->below += estimate < error;
}

static int
by_size(const void *a, const void *b)
{
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

static void
show_ratios(struct ratios *r, const char *what)
{
    if (r->n == 0)
        return;
    qsort(r->of, r->n, sizeof *r->of, by_size);
    printf(
        "%s: %zu estimates, %zu below the error; the least is %.3f, the median %.2f, 90 %% %.1f\n",
        what, r->n, r->below, r->of[0], r->of[r->n / 2], r->of[r->n * 9 / 10]);
}

#endif
