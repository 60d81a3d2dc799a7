#include "nested.h"

#include <math.h>
#include <stdlib.h>

#include "libcontact/memory.h"

enum {
    COARSEST = 24 /* nodes a side from which a coarser grid is worth solving first */
};
static const double coarse_tol = 3e-2;

/* Means of the (up to) four nodes under each coarse node. */
static void
coarsen(const struct rc_solver *s, const struct rc_shape *coarse, double *h)
{
    size_t nx = s->shape.nx, ny = s->shape.ny;

#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (size_t j = 0; j < coarse->ny; j++) {
        const double *a = s->h + 2 * j * nx, *b = 2 * j + 1 < ny ? a + nx : a;
        double *to = h + j * coarse->nx;
        for (size_t i = 0; i < nx / 2; i++)
            to[i] = (a[2 * i] + a[2 * i + 1] + b[2 * i] + b[2 * i + 1]) / 4;
        if (nx % 2 == 1)
            to[nx / 2] = (a[nx - 1] + b[nx - 1]) / 2;
    }
}

static void
repeat(struct rc_solver *s, const struct rc_solver *c)
{
    size_t nx = s->shape.nx, ny = s->shape.ny;

#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            s->p[j * nx + i] = c->p[j / 2 * c->shape.nx + i / 2];
    if (fabs(rc_solver_carried(s) - s->sum) <= 1e-14 * s->sum)
        return;
    /* an odd line too much; should nodes have to join, the highest first */
    for (size_t k = 0; k < s->n; k++)
        s->v[k] = -s->h[k];
    if (rc_box_balance(s->n, s->hardness, s->sum, s->v, s->p, NULL) != RC_OK)
        for (size_t k = 0; k < s->n; k++)
            s->p[k] = s->sum / (double)s->n;
}

/* What the grid leaves out is seen where the coarser one is solved to below it, which goes with the
 * spacing. */
static double
tolerance(const struct rc_solver *s, const struct rc_shape *coarse)
{
    if (s->stages)
        return fmax(0.1 / sqrt((double)(coarse->nx * coarse->ny)), s->tol);
    return fmax(coarse_tol, s->tol);
}

static double
largest(const double *v, size_t n)
{
    double most = v[0];

    for (size_t k = 1; k < n; k++)
        most = v[k] > most ? v[k] : most;
    return most;
}

/* Figures of the coarse solution. An approach that was asked for is right on both grids. */
static void
compare(struct rc_solver *s, struct rc_solver *c)
{
    size_t contact = 0;

    for (size_t k = 0; k < c->n; k++)
        contact += c->p[k] > 0;
    s->coarse.contact_area = (double)contact * c->cell;
    s->coarse.max_pressure = largest(c->p, c->n);
    rc_solver_shift(c);
    s->coarse.approach = c->elastic > 0 && s->seek.target == 0 ? c->shift : NAN;
}

void
rc_nested_start(struct rc_solver *s)
{
    struct rc_shape coarse = {(s->shape.nx + 1) / 2, (s->shape.ny + 1) / 2, 2 * s->shape.dx,
                              2 * s->shape.dy};
    struct rc_problem problem = {.boundary = s->boundary,
                                 .estar = s->estar,
                                 .load = s->load,
                                 .hardness = s->hardness,
                                 .tol = tolerance(s, &coarse),
                                 .method = "pcg",
                                 .threads = (size_t)s->threads,
                                 .watch = s->watch,
                                 .watcher = s->watcher};
    struct rc_solver *c;
    double *h, lower;

    if (s->shape.nx < COARSEST || s->shape.ny < COARSEST)
        return;
    h = rc_alloc(coarse.nx * coarse.ny, sizeof *h);
    if (h == NULL)
        return;
    coarsen(s, &coarse, h);
    lower = -largest(h, coarse.nx * coarse.ny); /* that of the fine heights is 0 */
    if (s->seek.target > 2 * lower)
        problem.approach = s->seek.target - lower;
    c = rc_solver_rough(&coarse, h, &problem, NULL);
    free(h);
    if (c == NULL)
        return;
    while (rc_solver_step(c) == RC_MORE)
        ;
    if (problem.approach == 0 || rc_solver_set_load(s, c->load, NULL) == RC_OK)
        repeat(s, c);
    if (s->stages)
        compare(s, c);
    s->convolutions += c->convolutions * (double)c->n / (double)s->n;
    rc_solver_free(c);
}
