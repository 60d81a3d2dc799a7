/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Transfers fields between a map and every s-th node of it, by polynomials through 24 nodes in each
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

#include "libcontact/memory.h"

enum {
    ORDER = 24 /* nodes of a polynomial */
};

/* Coarse node I lies on fine node (I - ORDER/2 + 1) s; fine node J s + r is interpolated from
 * coarse nodes J .. J + ORDER - 1. */
struct axis {
    size_t n, s, coarse;
    double *weight;           /* ORDER for each r < s */
    double missed[ORDER + 1]; /* differences of this order over 2^ORDER */
};

/* Errors of about the same size: of the source, of the field, and of its waves between coarse nodes. */
static const double parts = 2.5;

struct rc_coarse {
    struct axis x, y;
    int threads;
    double *rows;    /* after the first direction: rows of x.coarse or of nx */
    double *scratch; /* memory for each thread: the fine nodes of one residue */
    /* Rows of each rank: its first one on the map and on the coarse grid; the first row of the map that its
     * coarse rows need, `from`; and the first coarse row that its rows of the map need, `under`. */
    const struct rc_ranks *ranks;
    size_t own, order, *fine, *coarse, *from, *under;
    double *window; /* rows of x.coarse numbers from other ranks; NULL: no ranks */
    struct rc_store memory;
};

/* Largest error of this interpolation, of source and field, for any kernel and pressures of size 1 with the
 * worst signs, at this ratio of depth to coarse spacing. It was measured for s = 4, at the worst of all
 * positions of source and field between coarse nodes. The last row is rounding. */
static const struct {
    double ratio, error;
} measured[] = {{1.42, 1.8e-1}, {1.68, 8.0e-2},  {2, 3.1e-2},     {2.38, 1.1e-2}, {2.83, 3.2e-3},
                {3.36, 8.3e-4}, {3.67, 4.0e-4},  {4, 1.8e-4},     {4.36, 7.6e-5}, {4.76, 3.0e-5},
                {5.19, 1.1e-5}, {5.66, 3.7e-6},  {6.17, 1.2e-6},  {6.73, 3.5e-7}, {8, 2.6e-8},
                {9.51, 1.5e-9}, {11.3, 6.5e-11}, {13.5, 2.1e-12}, {16, 6.7e-14},  {18, 5.9e-15}};

double
rc_coarse_spacing(double depth, double tol)
{
    size_t k = 0;

    while (measured[k].error > tol && k + 1 < sizeof measured / sizeof *measured)
        k++;
    return depth / measured[k].ratio;
}

static size_t
coarse_nodes(size_t n, size_t s)
{
    return s == 1 ? n : (n - 1) / s + ORDER;
}

/* The spacing of the coarse nodes of an axis, as a multiple of d: the largest of 1, 2, 3, 4, 6, 8, 12, ...
 * that is at most `spacing` and leaves fewer nodes. With so few choices slices of similar depths share a
 * grid. */
static size_t
step(size_t n, double d, double spacing)
{
    size_t s = 1, next = 2;

    while ((double)next * d <= spacing && (s == 1 || coarse_nodes(n, next) < coarse_nodes(n, s))) {
        s = next;
        next = s % 3 == 0 ? s / 3 * 4 : s / 2 * 3;
    }
    return coarse_nodes(n, s) < n ? s : 1;
}

bool
rc_coarse_steps(const struct rc_shape *shape, struct rc_boundary boundary, double spacing,
                size_t *sx, size_t *sy)
{
    *sx = boundary.x ? 1 : step(shape->nx, shape->dx, spacing);
    *sy = boundary.y ? 1 : step(shape->ny, shape->dy, spacing);
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
static void
set_axis(struct axis *a, struct rc_store *memory, size_t n, size_t s)
{
    double missed = ldexp(1, -ORDER);

    *a = (struct axis){.n = n,
                       .s = s,
                       .coarse = coarse_nodes(n, s),
                       .weight = rc_store_take(memory, s, ORDER * sizeof(double))};
    for (size_t r = 0; r < s && a->weight != NULL; r++)
        for (int k = 0; k < ORDER; k++) {
            double at = (double)r / (double)s + (double)(ORDER / 2 - 1), w = 1;
            for (int l = 0; l < ORDER; l++)
                if (l != k)
                    w *= (at - l) / (k - l);
            a->weight[r * ORDER + (size_t)k] = w;
        }
    for (int k = 0; k <= ORDER; k++) {
        a->missed[k] = missed;
        missed *= -(double)(ORDER - k) / (k + 1);
    }
}

/* Doubles of scratch of one thread. */
static size_t
scratch_size(const struct rc_coarse *c)
{
    return c->x.coarse + ORDER;
}

/* Deals the rows of both grids to the ranks. */
static void
deal(struct rc_coarse *c)
{
    const size_t count = rc_ranks_count(c->ranks), s = c->y.s;

    c->own = rc_ranks_own(c->ranks);
    c->order = s == 1 ? 1 : ORDER;
    if ((c->fine = rc_store_take(&c->memory, 4 * (count + 1), sizeof *c->fine)) == NULL)
        return;
    c->coarse = c->fine + count + 1;
    c->from = c->coarse + count + 1;
    c->under = c->from + count + 1;
    for (size_t r = 0; r <= count; r++) {
        c->fine[r] = rc_rows_dealt(c->y.n, rc_rows_unit(c->x.n), count, r);
        c->coarse[r] = rc_rows_dealt(c->y.coarse, rc_rows_unit(c->x.coarse), count, r);
        c->from[r] = c->coarse[r] < c->order ? 0 : (c->coarse[r] - c->order + 1) * s;
        c->under[r] = c->fine[r] / s;
    }
}

/* Rows first[own] .. first[own + 1] - 1 + more, of at most `all`. */
static size_t
rows_of(const struct rc_coarse *c, const size_t *first, size_t more, size_t all)
{
    size_t end = first[c->own + 1] + more < all ? first[c->own + 1] + more : all;

    return end > first[c->own] ? end - first[c->own] : 0;
}

static void
allocate(struct rc_coarse *c)
{
    const size_t reach = (c->order - 1) * c->y.s, held = rows_of(c, c->fine, 0, c->y.n);
    const size_t from = rows_of(c, c->from, reach, c->y.n);
    const size_t under = rows_of(c, c->under, c->order, c->y.coarse);

    c->rows = rc_store_take(
        &c->memory, held * c->x.coarse > under * c->x.n ? held * c->x.coarse : under * c->x.n,
        sizeof *c->rows);
    c->scratch = rc_store_take(&c->memory, (size_t)c->threads * scratch_size(c), sizeof(double));
    if (c->ranks != NULL)
        c->window = rc_store_take(&c->memory, (from > under ? from : under) * c->x.coarse,
                                  sizeof *c->window);
}

struct rc_coarse *
rc_coarse_new(const struct rc_ranks *ranks, const struct rc_shape *shape, size_t sx, size_t sy,
              size_t threads, struct rc_err *err)
{
    RC_OWN(rc_coarse, c) = calloc(1, sizeof *c);

    if (c != NULL) {
        set_axis(&c->x, &c->memory, shape->nx, sx);
        set_axis(&c->y, &c->memory, shape->ny, sy);
        c->ranks = ranks;
        c->threads = rc_useful_threads(shape, threads);
        deal(c);
        if (!c->memory.failed)
            allocate(c);
    }
    return rc_ranks_need(ranks, c != NULL && !c->memory.failed, err,
                         "out of memory for a coarser grid of %zu x %zu nodes", shape->nx,
                         shape->ny) == RC_OK
               ? rc_give(&c)
               : NULL;
}

void
rc_coarse_free(struct rc_coarse *c)
{
    if (c == NULL)
        return;
    rc_store_free(&c->memory);
    free(c);
}

/* ---- reduction ---- */

RC_WIDE_CLONES static void
reduce_row(const struct axis *a, const double *restrict p, double *restrict out)
{
    if (a->s == 1) {
        memcpy(out, p, a->n * sizeof *out);
        return;
    }
    memset(out, 0, a->coarse * sizeof *out);
    for (size_t i = 0; i < a->n; i++) {
        const double *w = a->weight + i % a->s * ORDER;
        double *to = out + i / a->s;
        for (int k = 0; k < (p[i] != 0 ? ORDER : 0); k++)
            to[k] += w[k] * p[i];
    }
}

/* Rows of x.coarse numbers, from those held here by `held` to those needed here; or `rows` themselves. */
static const double *
fetch(struct rc_coarse *c, const size_t *held, const size_t *first, size_t more, const double *rows)
{
    if (c->ranks == NULL)
        return rows;
    rc_ranks_move(c->ranks, c->x.coarse * sizeof *rows, held, first, more, rows, c->window);
    return c->window;
}

void
rc_coarse_reduce(struct rc_coarse *c, const double *p, double *out)
{
    const struct axis *a = &c->y;
    const size_t wide = c->x.coarse, first = c->coarse[c->own], from = c->from[c->own];
    const double *rows;

#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t j = 0; j < rows_of(c, c->fine, 0, a->n); j++)
        reduce_row(&c->x, p + j * c->x.n, c->rows + j * wide);
    rows = fetch(c, c->fine, c->from, (c->order - 1) * a->s, c->rows);
#pragma omp parallel for num_threads(c->threads) schedule(dynamic)
    for (size_t J = first; J < c->coarse[c->own + 1]; J++) {
        double *to = out + (J - first) * wide;
        memset(to, 0, wide * sizeof *to);
        for (size_t k = 0; k < c->order; k++)
            for (size_t r = 0; J >= k && r < a->s && (J - k) * a->s + r < a->n; r++) {
                const double *row = rows + ((J - k) * a->s + r - from) * wide;
                double w = a->s == 1 ? 1 : a->weight[r * ORDER + k];
                for (size_t i = 0; i < wide; i++)
                    to[i] += w * row[i];
            }
    }
}

/* ---- interpolation ---- */

/* Eight nodes: a line of 64 sums stays in registers, which plain loops do not achieve. */
typedef double vector __attribute__((vector_size(64), aligned(8)));

RC_WIDE_CLONES static void
weigh_rows(size_t n, size_t stride, const double *restrict w, const double *restrict rows,
           double *restrict out)
{
    enum {
        WIDE = 64
    };
    size_t first = 0;

    for (; first + WIDE <= n; first += WIDE) {
        vector sum[WIDE / 8] = {{0}};
        for (int k = 0; k < ORDER; k++)
#pragma GCC unroll 8
            for (size_t i = 0; i < WIDE / 8; i++)
                sum[i] += w[k] * *(const vector *)(rows + first + 8 * i + (size_t)k * stride);
        for (size_t i = 0; i < WIDE / 8; i++)
            *(vector *)(out + first + 8 * i) = sum[i];
    }
    for (size_t i = first; i < n; i++) {
        double sum = 0;
#pragma GCC unroll 24
        for (int k = 0; k < ORDER; k++)
            sum += w[k] * rows[i + (size_t)k * stride];
        out[i] = sum;
    }
}

static void
expand_row(const struct axis *a, const double *row, double *residue, double *out)
{
    if (a->s == 1)
        memcpy(out, row, a->n * sizeof *out);
    for (size_t r = 0; a->s > 1 && r < a->s; r++) {
        size_t n = r < a->n ? (a->n - r + a->s - 1) / a->s : 0;
        weigh_rows(n, 1, a->weight + r * ORDER, row, residue);
        for (size_t i = 0; i < n; i++)
            out[i * a->s + r] = residue[i];
    }
}

/* Adds the waves that the interpolation along an axis misses: `lines` lines of n coarse nodes. The lines of a
 * part are summed in their order, so that the sum does not depend on the number of threads. */
static void
add_missed(const struct axis *a, int threads, const double *u, size_t lines, size_t pitch, size_t n,
           size_t step, double nodes, double *error)
{
    enum {
        PARTS = 256
    };
    double sum[PARTS] = {0}, all = 0;

#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t part = 0; part < PARTS; part++)
        for (size_t j = lines * part / PARTS; j < lines * (part + 1) / PARTS; j++) {
            const double *line = u + j * pitch;
            for (size_t i = 0; i + ORDER < n; i++) {
                double d = 0;
                for (size_t k = 0; k <= ORDER; k++)
                    d += a->missed[k] * line[(i + k) * step];
                sum[part] += fabs(d);
            }
        }
    for (size_t part = 0; part < PARTS; part++)
        all += sum[part];
    *error += parts * all * nodes;
}

/* Of a wave with the phase w from coarse node to coarse node, interpolation through n nodes misses, in the
 * middle between two of them, the integral of sin^(n - 1)(t/2) from 0 to w over that from 0 to pi. This is
 * less than sin^n(w/2), the factor of its n-th difference over 2^n. The reduction is the transpose of the
 * interpolation, and the kernels are even or odd: its errors are about as large. */
static void
add_error(struct rc_coarse *c, const double *u, size_t rows, size_t held, double *error)
{
    const struct axis *x = &c->x, *y = &c->y;
    const double nodes = (double)(x->s * y->s);
    const size_t above = y->s > 1 && rows > ORDER ? ORDER / 2 : 0;
    const size_t lines = y->s == 1 ? held : rows - 2 * above;

    if (x->s > 1)
        add_missed(x, c->threads, u + above * x->coarse, lines, x->coarse, x->coarse, 1, nodes,
                   error);
    if (y->s > 1)
        add_missed(y, c->threads, c->rows, (x->n + x->s - 1) / x->s, x->s, rows, x->n, nodes,
                   error);
}

void
rc_coarse_expand(struct rc_coarse *c, const double *u, double *out, double *error)
{
    enum {
        PIECE = 128 /* columns whose ORDER rows fit into the first cache */
    };
    const size_t nx = c->x.n, s = c->y.s, first = c->fine[c->own], end = c->fine[c->own + 1];
    const size_t under = c->under[c->own], rows = rows_of(c, c->under, c->order, c->y.coarse);

    u = fetch(c, c->coarse, c->under, c->order, u);
#pragma omp parallel num_threads(c->threads)
    {
#pragma omp for schedule(static)
        for (size_t J = 0; J < (s > 1 ? rows : end - first); J++)
            expand_row(&c->x, u + J * c->x.coarse,
                       c->scratch + (size_t)omp_get_thread_num() * scratch_size(c),
                       s > 1 ? c->rows + J * nx : out + J * nx);
#pragma omp for schedule(static)
        for (size_t J = under; J < (s > 1 ? (end + s - 1) / s : under); J++)
            for (size_t i = 0; i < nx; i += PIECE)
                for (size_t j = J * s > first ? J * s : first; j < (J + 1) * s && j < end; j++)
                    weigh_rows(nx - i < PIECE ? nx - i : PIECE, nx, c->y.weight + j % s * ORDER,
                               c->rows + (J - under) * nx + i, out + (j - first) * nx + i);
    }
    if (error != NULL)
        add_error(c, u, rows, end - first, error);
}
