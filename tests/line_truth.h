/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Displacements, times E* or the like, by a wave along one axis on a cell along the other: integrals of
 * closed forms and of symbols, by GSL. */
#ifndef LINE_TRUTH_H
#define LINE_TRUTH_H

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_bessel.h>

#include "tests/exact.h"
#include "libcontact/body/stack.h"

enum {
    MOST = 1200
};

static gsl_integration_workspace *space;

/* The mean over the cell about x = i d of f(x), times d. */
struct mean {
    double (*f)(double z);
    double d, scale; /* of z = x scale */
    double node;
};

static inline double
mean_at(double u, void *of)
{
    const struct mean *m = of;

    return m->f((m->node + u) * m->d * m->scale);
}

static inline double
cell(double (*f)(double), double d, double scale, size_t node)
{
    struct mean m = {f, d, scale, (double)node};
    gsl_function g = {mean_at, &m};
    double below, above, error;

    gsl_integration_qags(&g, -0.5, 0, 0, 2e-14, MOST, space, &below, &error);
    gsl_integration_qags(&g, 0, 0.5, 0, 2e-14, MOST, space, &above, &error);
    return d * (below + above);
}

static inline int
line_begin(void **state)
{
    (void)state;
    gsl_set_error_handler_off();
    space = gsl_integration_workspace_alloc(MOST);
    return space == NULL;
}

static inline int
line_end(void **state)
{
    (void)state;
    gsl_integration_workspace_free(space);
    return 0;
}

/* The integral over y of cos(Q y)/r, z = Q x (Gradshteyn and Ryzhik 3.754). */
static inline double
k0(double z)
{
    return fabs(z) > 700 ? 0 : 2 * gsl_sf_bessel_K0(fabs(z));
}

/* The integral of ln(|x|/datum) over a cell, over d. */
static inline double
log_cell(double cells, double d, double datum)
{
    long double from = fabsl(cells - 0.5L), to = cells + 0.5L, scale = (long double)d / datum;

    return (double)(to * (logl(to * scale) - 1) +
                    (cells == 0 ? 1 : -1) * from * (logl(from * scale) - 1));
}

/* A body under layers, bare or of a wave; its first layer is `material[0]`. */

struct coat {
    const struct rc_stack *stack;
    double d, wave, x;
};

/* (g(k) - g(infinity)) 2/k, k^2 = q^2 + Q^2, without its 1/k at Q = 0. */
static inline double
coat_wave(double q, void *of)
{
    const struct coat *c = of;
    double k = hypot(q, c->wave), t = c->stack->material[0].thickness, half = q * c->d / 2;
    double v = rc_stack_excess(c->stack, k);

    if (c->wave == 0)
        v -= (c->stack->bottom - c->stack->top) * exp(-q * t);
    return 2 * v / k * c->d * sin(half) / half * cos(q * c->x) / exact_pi;
}

/* The integral of ln(sqrt(x^2 + s^2)/datum). */
static inline double
smooth_log(double x, double s, double datum)
{
    return x * log(hypot(x, s) / datum) - x + s * atan(x / s);
}

static inline double
coat_truth(const struct rc_stack *s, double d, double wave, double datum, size_t i)
{
    double t = s->material[0].thickness, x = (double)i * d, sum = 0, part, error;
    struct coat c = {s, d, wave, x};
    gsl_function f = {coat_wave, &c};

    for (double from = 0, to = 1e-5 / t; from < 40 / t; from = to, to = fmin(8 * to, 40 / t)) {
        gsl_integration_qag(&f, from, to, 1e-15 * d * fmax(s->top, s->bottom), 1e-13, MOST,
                            GSL_INTEG_GAUSS61, space, &part, &error);
        sum += part;
    }
    if (wave > 0)
        return sum + 2 * s->top / (2 * exact_pi) * cell(k0, d, wave, i);
    return sum - 2 / exact_pi *
                     (s->top * d * log_cell((double)i, d, datum) +
                      (s->bottom - s->top) *
                          (smooth_log(x + d / 2, t, datum) - smooth_log(x - d / 2, t, datum)));
}

#endif
