/*
 * How long a rung will take: convolutions that its method will need, times what one takes by its kernel. Both come from
 * the rungs that have been run on this map; before there are any, from bench-solve and bench-convolution (1024^2, two
 * threads of 2026), which a machine may be several times off.
 */
#include "cost.h"

#include <math.h>
#include <string.h>

static double
digits(double tol)
{
    return -log10(tol);
}

static double
nodes(const struct rc_shape *shape)
{
    return (double)(shape->nx * shape->ny);
}

/* ---- what one convolution takes, for one node of the map, in seconds ---- */

/* mlms: N (log 1/tol)^2. */
static double
orders(double tol)
{
    return pow(digits(tol) + 2, 2) / pow(6, 2);
}

static double
known_pace(const struct cost_case *c, const char *kernel, double tol)
{
    double threads = 2 / (double)c->tool->threads;
    double transform = c->problem.boundary == RC_FREE ? 18e-9 : 8e-9;

    if (strcmp(kernel, "direct") == 0)
        return 2.6e-9 * nodes(&c->shape) * threads;
    return (strcmp(kernel, "mlms") == 0 ? 20e-9 * orders(tol) : transform) * threads;
}

static double
pace_of(const struct cost_case *c, const struct cost *m)
{
    return m->seconds / m->convolutions / nodes(&c->shape);
}

static double
pace(const struct cost_case *c, const char *kernel, double tol)
{
    double machine = 1;

    for (size_t k = c->rungs; k-- > 0;) {
        const struct cost *m = &c->rung[k];

        if (m->state == COST_DONE && m->rung.coarse == 1 && strcmp(m->rung.kernel, kernel) == 0)
            return pace_of(c, m) * (strcmp(kernel, "mlms") == 0 ? orders(tol) / orders(m->rung.tol) : 1);
    }
    if (c->reference.state == COST_DONE)
        machine = pace_of(c, &c->reference) / known_pace(c, c->reference.rung.kernel, 1);
    return machine * known_pace(c, kernel, tol);
}

/* ---- how many of them ---- */

static double
known_convolutions(const struct cost_case *c, const struct cost *rung)
{
    double d = digits(rung->rung.tol);
    double some = strcmp(rung->rung.method, "pk99") == 0 ? 0.25 * sqrt(nodes(&c->shape)) * d
                                                         : 8 + 3.5 * d;

    return c->problem.approach > 0 ? 3 * some : some;
}

static double
convolutions(const struct cost_case *c, const struct cost *rung)
{
    const struct cost *near = NULL;

    for (size_t k = 0; k < c->rungs; k++) {
        const struct cost *m = &c->rung[k];

        if (m->state == COST_DONE && m->rung.coarse == 1 && strcmp(m->rung.method, rung->rung.method) == 0 &&
            (near == NULL || fabs(log(m->rung.tol / rung->rung.tol)) <= fabs(log(near->rung.tol / rung->rung.tol))))
            near = m;
    }
    if (near == NULL && strcmp(rung->rung.method, c->reference.rung.method) == 0 &&
        c->reference.state == COST_DONE)
        near = &c->reference;
    if (near == NULL)
        return known_convolutions(c, rung);
    return near->convolutions * known_convolutions(c, rung) / known_convolutions(c, near);
}

double
cost_expect(const struct cost_case *c, const struct cost *rung)
{
    double part = nodes(&rung->shape) / nodes(&c->shape);

    return convolutions(c, rung) * pace(c, rung->rung.kernel, rung->rung.tol) * nodes(&rung->shape) *
           (strcmp(rung->rung.kernel, "direct") == 0 ? part : 1);
}

/* ---- stresses ---- */

/* Exact slices take some 30 transforms' time a depth, six sums by another engine seven times theirs. Beside
 * each slice the exact one is computed, to compare. */
double
cost_expect_stress(const struct cost_case *c, const struct cost_stress *s)
{
    double n = nodes(&c->shape), depths = (double)c->depths.n;
    double exact = 5e-8 * n * depths * 2 / (double)c->tool->threads, each;

    for (size_t k = 0; k < c->stresses; k++) {
        const struct cost_stress *m = &c->stress[k];

        if (m->state == COST_DONE && m->reference)
            exact = m->seconds;
    }
    if (strcmp(s->kernel, "fft") == 0)
        return 2 * exact;
    each = pace(c, s->kernel, s->tol > 0 ? s->tol : 1e-14);
    for (size_t k = 0; k < c->stresses; k++) {
        const struct cost_stress *m = &c->stress[k];

        if (m->state == COST_DONE && strcmp(m->kernel, s->kernel) == 0)
            return exact + m->seconds * orders(s->tol) / orders(m->tol);
    }
    return exact + 7 * each * n * depths;
}
