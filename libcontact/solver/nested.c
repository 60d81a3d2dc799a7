/*
 * A start from coarser grids: the pressure of the same contact on every second node, solved roughly
 * (and there by the same start), is repeated on this grid. Each call of rc_nested_step does one
 * iteration somewhere below, or plans one grid, so that the caller sees them pass.
 */
#include "solver.h"

#include <math.h>
#include <stdlib.h>

#include "libcontact/memory.h"

enum {
    COARSEST = 24 /* nodes a side from which a coarser grid is worth solving first */
};
/* A nearer start saves no step, but where nodes are at the hardness. */
static const double coarse_tol = 8e-2, coarse_tol_yielding = 3e-2;

struct rc_nested {
    struct rc_solver *coarse; /* NULL: not yet begun                                   */
    bool sought;              /* the load is sought there too: the one found counts here */
};

void
rc_nested_new(struct rc_solver *s)
{
    if (!s->method->nested || s->posed.shape.nx < COARSEST || s->posed.shape.ny < COARSEST)
        return;
    s->nested = calloc(1, sizeof *s->nested);
}

void
rc_nested_free(struct rc_solver *s)
{
    if (s->nested == NULL)
        return;
    rc_solver_free(s->nested->coarse);
    free(s->nested);
    s->nested = NULL;
}

bool
rc_nested_untouched(const struct rc_solver *s)
{
    return s->nested != NULL && s->nested->coarse == NULL;
}

const struct rc_solver *
rc_nested_at_work(const struct rc_solver *s)
{
    while (s->nested != NULL && s->nested->coarse != NULL)
        s = s->nested->coarse;
    return s;
}

double
rc_nested_convolutions(const struct rc_solver *s)
{
    const struct rc_solver *c;

    if (s->nested == NULL || s->nested->coarse == NULL)
        return 0;
    c = s->nested->coarse;
    return (c->it.convolutions + rc_nested_convolutions(c)) * (double)c->posed.n /
           (double)s->posed.n;
}

/* ---- down ---- */

/* Means of the (up to) four nodes under each coarse node. */
static void
coarsen(const struct rc_posed *fine, const struct rc_shape *coarse, double *h)
{
    size_t nx = fine->shape.nx, ny = fine->shape.ny;

#pragma omp parallel for num_threads(fine->threads) schedule(static)
    for (size_t j = 0; j < coarse->ny; j++) {
        const double *a = fine->h + 2 * j * nx, *b = 2 * j + 1 < ny ? a + nx : a;
        double *to = h + j * coarse->nx;
        for (size_t i = 0; i < nx / 2; i++)
            to[i] = (a[2 * i] + a[2 * i + 1] + b[2 * i] + b[2 * i + 1]) / 4;
        if (nx % 2 == 1)
            to[nx / 2] = (a[nx - 1] + b[nx - 1]) / 2;
    }
}

static double
largest(const double *v, size_t n)
{
    double most = v[0];

    for (size_t k = 1; k < n; k++)
        most = v[k] > most ? v[k] : most;
    return most;
}

/* What the grid leaves out is seen where the coarser one is solved to below it, which goes with the
 * spacing. */
static double
tolerance(const struct rc_solver *s, const struct rc_shape *coarse)
{
    if (s->posed.discretization)
        return fmax(0.1 / sqrt((double)(coarse->nx * coarse->ny)), s->load.tol);
    return fmax(s->load.target > 0 ? coarse_tol_yielding : coarse_tol, s->load.tol);
}

/* NULL when memory is short: then the constant start stays. */
static struct rc_solver *
coarse_new(const struct rc_solver *s, bool *sought)
{
    const struct rc_shape *fine = &s->posed.shape;
    struct rc_shape shape = {(fine->nx + 1) / 2, (fine->ny + 1) / 2, 2 * fine->dx, 2 * fine->dy};
    struct rc_problem problem = {.boundary = s->posed.boundary,
                                 .load = s->load.load,
                                 .hardness = s->posed.hardness,
                                 .tol = tolerance(s, &shape),
                                 .threads = (size_t)s->posed.threads};
    double *h = rc_alloc(shape.nx * shape.ny, sizeof *h), lower;
    struct rc_solver *c;

    if (h == NULL)
        return NULL;
    coarsen(&s->posed, &shape, h);
    lower = -largest(h, shape.nx * shape.ny); /* that of the fine heights is 0 */
    *sought = s->load.target > 2 * lower;
    if (*sought)
        problem.approach = s->load.target - lower;
    c = rc_solver_coarse(s, &shape, h, &problem, NULL);
    free(h);
    return c;
}

/* ---- up ---- */

static void
repeat(struct rc_solver *s, const struct rc_solver *c)
{
    size_t nx = s->posed.shape.nx, ny = s->posed.shape.ny, n = s->posed.n;
    double *p = s->it.p, *v = s->it.v;

#pragma omp parallel for num_threads(s->posed.threads) schedule(static)
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            p[j * nx + i] = c->it.p[j / 2 * c->posed.shape.nx + i / 2];
    if (fabs(rc_iterate_carried(s) - s->load.sum) <= 1e-14 * s->load.sum)
        return;
    /* an odd line too much; should nodes have to join, the highest first */
    for (size_t k = 0; k < n; k++)
        v[k] = -s->posed.h[k];
    if (rc_projection_balance(n, s->posed.hardness, s->load.sum, v, p, NULL) != RC_OK)
        rc_iterate_level(s);
}

/* Figures of the coarse solution. An approach that was asked for is right on both grids. */
static void
compare(struct rc_solver *s, struct rc_solver *c)
{
    size_t contact = 0;

    for (size_t k = 0; k < c->posed.n; k++)
        contact += c->it.p[k] > 0;
    s->coarse.contact_area = (double)contact * c->posed.cell;
    s->coarse.max_pressure = largest(c->it.p, c->posed.n);
    rc_iterate_shift(c);
    s->coarse.approach = c->it.elastic > 0 && s->load.target == 0 ? c->it.shift : NAN;
}

void
rc_nested_end(struct rc_solver *s)
{
    struct rc_solver *c = s->nested == NULL ? NULL : s->nested->coarse;

    if (c != NULL) {
        rc_nested_end(c);
        if (!s->nested->sought || rc_load_set(s, c->load.load, NULL) == RC_OK)
            repeat(s, c);
        if (s->posed.discretization && c->it.iterations > 0)
            compare(s, c);
        rc_iterate_count(s, c->it.convolutions * (double)c->posed.n / (double)s->posed.n);
    }
    rc_nested_free(s);
}

void
rc_nested_step(struct rc_solver *s)
{
    struct rc_solver *c;

    if (s->nested->coarse == NULL) {
        s->nested->coarse = coarse_new(s, &s->nested->sought);
        if (s->nested->coarse == NULL)
            rc_nested_free(s);
        return;
    }
    c = s->nested->coarse;
    if (c->load.target == 0 && c->set.saturated > 0)
        c->load.tol = fmin(c->load.tol, fmax(coarse_tol_yielding, s->load.tol));
    if (rc_solver_step(c) != RC_MORE)
        rc_nested_end(s);
}
