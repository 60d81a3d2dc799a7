/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Stresses inside a half-space of one material, from the closed forms of forms.c.
 */
#include <math.h>
#include <stdlib.h>

#include "forms.h"
#include "uniform.h"

struct inside {
    struct rc_inside in;
    struct rc_closed closed;
};

static const struct rc_closed *
closed_of(const struct rc_inside *in)
{
    return &((const struct inside *)in)->closed;
}

static size_t
numbers(bool shear)
{
    (void)shear;
    return 1; /* exp(-q z) */
}

static struct rc_inside *
inside_new(const struct rc_solid *solid, double depth, bool shear, struct rc_boundary boundary,
           struct rc_err *err)
{
    struct inside *s = malloc(sizeof *s);

    (void)shear, (void)boundary;
    if (s == NULL)
        return rc_err_null(err, "out of memory for the depth %g m", depth);
    *s = (struct inside){{&rc_uniform_inside, depth}, {depth, rc_uniform_nu(solid)}};
    return &s->in;
}

static void
inside_free(struct rc_inside *in)
{
    free(in);
}

static void
waves(const struct rc_inside *in, size_t n, const double *q, double *decay)
{
    for (size_t k = 0; k < n; k++)
        decay[k] = exp(-q[k] * in->depth);
}

static void
symbol(const struct rc_inside *in, int kernel, const struct rc_waves *w, double *out)
{
    rc_stress_forms[kernel].symbol(w, in->depth, closed_of(in)->nu, out);
}

/* The mean over the directions of q is also the stress under the middle of a uniform load that grows without
 * limit: sxx = syy = -(1 + 2 nu)/2. The sum of the normal stresses is -2 (1 + nu), as for every wave. On a
 * profile q has one direction, and the strain is plane. */
static double
mean(const struct rc_inside *in, int kernel, const struct rc_shape *shape)
{
    static const double xs[] = {1, 0}, ys[] = {0, 1}, ones[] = {1, 1};
    const struct rc_waves two = {2, xs, ys, ones, ones};
    double of[2];

    if (rc_stress_parity[kernel] != 0)
        return 0;
    rc_stress_forms[kernel].symbol(&two, 0, closed_of(in)->nu, of);
    if ((shape->nx == 1) == (shape->ny == 1))
        return (of[0] + of[1]) / 2;
    return shape->nx == 1 ? of[1] : of[0];
}

static void
coefficients(const struct rc_inside *in, const struct rc_cell *cell, unsigned kernels, size_t n,
             const double *x, const double *y, double *const out[RC_STRESS_KERNELS])
{
    rc_closed_coefficients(closed_of(in), cell, kernels, n, x, y, out);
}

static void
line(const struct rc_inside *in, const struct rc_cell *cell, unsigned kernels, double step,
     size_t n, double y, double *const out[RC_STRESS_KERNELS])
{
    rc_closed_line(closed_of(in), cell, kernels, step, n, y, out);
}

const struct rc_inside_type rc_uniform_inside = {
    .shares = true,
    .coarsens = true,
    .numbers = numbers,
    .new = inside_new,
    .free = inside_free,
    .waves = waves,
    .symbol = symbol,
    .mean = mean,
    .coefficients = coefficients,
    .line = line,
};
