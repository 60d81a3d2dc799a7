/*
 * Transfers fields between a map and every s-th node of it, by polynomials through eight nodes in each
 * direction.
 *
 * Deep below the surface the kernels are smooth on the scale of the depth, so a coarser grid is enough.
 * Pressures are reduced to it by the transpose of the interpolation, the coarse field is the same sum over
 * fewer nodes, and is interpolated back (the multi-level sum of Polonsky and Keer 1999, eqs. 10 and 15, where
 * no corrections are needed).
 */
#include "coarse_grid.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum {
    ORDER = 8 /* nodes of a polynomial */
};

/* Coarse node I lies on fine node (I - ORDER/2 + 1) s; fine node J s + r is interpolated from
 * coarse nodes J .. J + ORDER - 1. */
struct axis {
    size_t n, s, coarse;
    double *weight; /* ORDER for each r < s */
};

struct rc_coarse {
    struct axis x, y;
    int threads;
    double *rows;    /* ny rows of x.coarse, after the first direction of a reduction */
    double *scratch; /* memory for each thread: a coarse row, and the fine nodes of one residue */
};

/* Largest error of this interpolation, of source and field, for any kernel and pressures of size 1 with the
 * worst signs, at this ratio of depth to coarse spacing. It was measured for s = 4, at the worst of all
 * positions of source and field between coarse nodes. */
static const struct {
    double ratio, error;
} measured[] = {{1.42, 1.4e-1}, {2, 3.6e-2},    {2.83, 7.1e-3}, {4, 9.7e-4},   {5.66, 9.2e-5},
                {8, 7.5e-6},    {11.4, 5.3e-7}, {16, 3.6e-8},   {22.7, 2.3e-9}};

double
rc_coarse_spacing(double depth, double tol)
{
    for (size_t k = 0; k < sizeof measured / sizeof *measured; k++)
        if (measured[k].error <= tol)
            return depth / measured[k].ratio;
    return 0;
}

static size_t
coarse_nodes(size_t n, size_t s)
{
    return s == 1 ? n : (n - 1) / s + ORDER;
}

/* The largest power of 2 for which so many d are at most `spacing` and the axis becomes shorter. */
static size_t
step(size_t n, double d, double spacing)
{
    size_t s = 1;

    while (2 * (double)s * d <= spacing && coarse_nodes(n, 2 * s) < coarse_nodes(n, s))
        s *= 2;
    return s;
}

bool
rc_coarse_steps(const struct rc_shape *shape, double spacing, size_t *sx, size_t *sy)
{
    *sx = step(shape->nx, shape->dx, spacing);
    *sy = step(shape->ny, shape->dy, spacing);
    /* the gain must exceed the cost of the interpolation */
    return 2 * coarse_nodes(shape->nx, *sx) * coarse_nodes(shape->ny, *sy) < shape->nx * shape->ny;
}

struct rc_shape
rc_coarse_shape(const struct rc_shape *s, size_t sx, size_t sy)
{
    return (struct rc_shape){coarse_nodes(s->nx, sx), coarse_nodes(s->ny, sy), (double)sx * s->dx,
                             (double)sy * s->dy};
}

/* Lagrange's polynomials at each r / s between the two middle nodes of ORDER. */
static bool
set_axis(struct axis *a, size_t n, size_t s)
{
    *a = (struct axis){.n = n, .s = s, .coarse = coarse_nodes(n, s)};
    if ((a->weight = malloc(s * ORDER * sizeof *a->weight)) == NULL)
        return false;
    for (size_t r = 0; r < s; r++)
        for (int k = 0; k < ORDER; k++) {
            double at = (double)r / (double)s + (double)(ORDER / 2 - 1), w = 1;
            for (int l = 0; l < ORDER; l++)
                if (l != k)
                    w *= (at - l) / (k - l);
            a->weight[r * ORDER + (size_t)k] = w;
        }
    return true;
}

/* Doubles of scratch of one thread. */
static size_t
scratch_size(const struct rc_coarse *c)
{
    return 2 * (c->x.coarse + ORDER);
}

struct rc_coarse *
rc_coarse_new(const struct rc_shape *shape, size_t sx, size_t sy, size_t threads,
              struct rc_err *err)
{
    struct rc_coarse *c = calloc(1, sizeof *c);

    if (c != NULL && set_axis(&c->x, shape->nx, sx) && set_axis(&c->y, shape->ny, sy)) {
        c->threads = rc_useful_threads(shape, threads);
        c->rows = malloc(shape->ny * c->x.coarse * sizeof *c->rows);
        c->scratch = malloc((size_t)c->threads * scratch_size(c) * sizeof *c->scratch);
    }
    if (c == NULL || c->rows == NULL || c->scratch == NULL) {
        rc_err_set(err, "out of memory for a coarser grid of %zu x %zu nodes", shape->nx,
                   shape->ny);
        rc_coarse_free(c);
        return NULL;
    }
    return c;
}

void
rc_coarse_free(struct rc_coarse *c)
{
    if (c == NULL)
        return;
    free(c->x.weight);
    free(c->y.weight);
    free(c->rows);
    free(c->scratch);
    free(c);
}

/* ---- reduction ---- */

static void
reduce_row(const struct axis *a, const double *p, double *out)
{
    if (a->s == 1) {
        memcpy(out, p, a->n * sizeof *out);
        return;
    }
    memset(out, 0, a->coarse * sizeof *out);
    for (size_t i = 0; i < a->n; i++) {
        const double *w = a->weight + i % a->s * ORDER;
        double *to = out + i / a->s;
        for (int k = 0; k < ORDER; k++)
            to[k] += w[k] * p[i];
    }
}

void
rc_coarse_reduce(struct rc_coarse *c, const double *p, double *out)
{
    const struct axis *a = &c->y;
    size_t wide = c->x.coarse;

#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t j = 0; j < a->n; j++)
        reduce_row(&c->x, p + j * c->x.n, c->rows + j * wide);
#pragma omp parallel for num_threads(c->threads) schedule(dynamic)
    for (size_t J = 0; J < a->coarse; J++) {
        double *to = out + J * wide;
        memset(to, 0, wide * sizeof *to);
        for (size_t k = 0; k < (a->s == 1 ? 1 : (size_t)ORDER); k++)
            for (size_t r = 0; J >= k && r < a->s && (J - k) * a->s + r < a->n; r++) {
                const double *row = c->rows + ((J - k) * a->s + r) * wide;
                double w = a->s == 1 ? 1 : a->weight[r * ORDER + k];
                for (size_t i = 0; i < wide; i++)
                    to[i] += w * row[i];
            }
    }
}

/* ---- interpolation ---- */

RC_WIDE_CLONES static void
weigh_rows(size_t n, size_t stride, const double *restrict w, const double *restrict rows,
           double *restrict out)
{
    for (size_t i = 0; i < n; i++) {
        double sum = 0;
        for (int k = 0; k < ORDER; k++)
            sum += w[k] * rows[i + (size_t)k * stride];
        out[i] = sum;
    }
}

static void
expand_row(const struct axis *a, const double *row, double *residue, double *out)
{
    for (size_t r = 0; r < a->s; r++) {
        size_t n = r < a->n ? (a->n - r + a->s - 1) / a->s : 0;
        weigh_rows(n, 1, a->weight + r * ORDER, row, residue);
        for (size_t i = 0; i < n; i++)
            out[i * a->s + r] = residue[i];
    }
}

void
rc_coarse_expand(struct rc_coarse *c, const double *u, double *out)
{
    size_t wide = c->x.coarse;

#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t j = 0; j < c->y.n; j++) {
        double *row = c->scratch + (size_t)omp_get_thread_num() * scratch_size(c),
               *to = out + j * c->x.n;
        const double *from = u + j / c->y.s * wide;
        if (c->y.s > 1)
            weigh_rows(wide, wide, c->y.weight + j % c->y.s * ORDER, from, row);
        else
            memcpy(row, from, wide * sizeof *row);
        if (c->x.s > 1)
            expand_row(&c->x, row, row + wide + ORDER, to);
        else
            memcpy(to, row, c->x.n * sizeof *to);
    }
}
