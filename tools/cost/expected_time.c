/*
 * How long a trial will take: convolutions that its method will need, times what one takes by its
 * kernel. Both come from the trials that have been run on this map; before there are any, from
 * bench-solve and bench-convolution (1024^2, two threads of 2026), which a machine may be several
 * times off.
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

/* Beside mlms' own work, (log 1/tol)^2, stands that of the method. */
static double
orders(double tol)
{
    return (digits(tol) + 6) / 10;
}

static double
known_pace(const struct cost_case *c, const char *kernel, double tol)
{
    double threads = 2 / (double)c->tool->threads;
    double transform = c->problem.boundary == RC_FREE ? 18e-9 : 10e-9;

    if (strcmp(kernel, "direct") == 0)
        return 2.6e-9 * nodes(&c->shape) * threads;
    return (strcmp(kernel, "mlms") == 0 ? 18e-9 * orders(tol) : transform) * threads;
}

/* The nearest tolerance that was run: by the same kernel, if possible by the same method; its
 * convolutions are of the same kind only then. */
static const struct cost_trial *
nearest(const struct cost_case *c, const struct cost_settings *r, bool same_method,
        bool same_kernel)
{
    const struct cost_trial *near = NULL;

    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *m = &c->trial[k];

        if (m->state == COST_DONE && m->settings.coarse == 1 &&
            (!same_method || strcmp(m->settings.method, r->method) == 0) &&
            (!same_kernel || strcmp(m->settings.kernel, r->kernel) == 0) &&
            (near == NULL ||
             fabs(log(m->settings.tol / r->tol)) <= fabs(log(near->settings.tol / r->tol))))
            near = m;
    }
    return near;
}

static double
pace_of(const struct cost_case *c, const struct cost_trial *m)
{
    return m->seconds / m->convolutions / nodes(&c->shape);
}

static double
pace(const struct cost_case *c, const struct cost_settings *r)
{
    const struct cost_trial *near = nearest(c, r, true, true);

    if (near == NULL)
        near = nearest(c, r, false, true);
    if (near == NULL && c->reference.state == COST_DONE)
        near = &c->reference;
    if (near == NULL)
        return known_pace(c, r->kernel, r->tol);
    return pace_of(c, near) * known_pace(c, r->kernel, r->tol) /
           known_pace(c, near->settings.kernel, near->settings.tol);
}

/* ---- how many of them ---- */

/* pk99 has to find the contact first, and is quick then. */
static double
known_convolutions(const struct cost_case *c, const struct cost_settings *r)
{
    double d = digits(r->tol);
    double some =
        strcmp(r->method, "pk99") != 0
            ? 8 + 3.5 * d
            : 0.3 * sqrt(nodes(&c->shape)) * (d < 4 ? pow(3, d / 2 - 1) : 3 + 0.3 * (d - 4));

    return c->problem.approach > 0 ? 3 * some : some;
}

static double
convolutions(const struct cost_case *c, const struct cost_settings *r)
{
    const struct cost_trial *near = nearest(c, r, true, false);

    if (near == NULL && strcmp(r->method, c->reference.settings.method) == 0 &&
        c->reference.state == COST_DONE)
        near = &c->reference;
    if (near == NULL)
        return known_convolutions(c, r);
    return near->convolutions * known_convolutions(c, r) / known_convolutions(c, &near->settings);
}

double
cost_expect(const struct cost_case *c, const struct cost_trial *trial)
{
    double part = nodes(&trial->shape) / nodes(&c->shape);

    return convolutions(c, &trial->settings) * pace(c, &trial->settings) * nodes(&trial->shape) *
           (strcmp(trial->settings.kernel, "direct") == 0 ? part : 1);
}

/* ---- stresses ---- */

/* Exact slices take some 30 transforms' time a depth, six sums by another engine seven times
 * theirs. Beside each slice the exact one is computed, to compare. */
double
cost_expect_stress(const struct cost_case *c, const struct cost_stress *s)
{
    double n = nodes(&c->shape), depths = (double)c->depths.n;
    double exact = 5e-8 * n * depths * 2 / (double)c->tool->threads, each;
    struct cost_settings r = {
        .method = "pk99", .kernel = s->kernel, .tol = s->tol > 0 ? s->tol : 1e-14};

    for (size_t k = 0; k < c->stresses; k++) {
        const struct cost_stress *m = &c->stress[k];

        if (m->state == COST_DONE && m->reference)
            exact = m->seconds;
    }
    if (strcmp(s->kernel, "fft") == 0)
        return 2 * exact;
    each = pace(c, &r);
    for (size_t k = 0; k < c->stresses; k++) {
        const struct cost_stress *m = &c->stress[k];

        if (m->state == COST_DONE && strcmp(m->kernel, s->kernel) == 0)
            return exact + m->seconds * orders(s->tol) / orders(m->tol);
    }
    return exact + 7 * each * n * depths;
}
