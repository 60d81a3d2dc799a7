/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A start from coarser grids. The contact is first solved roughly on a grid of half the nodes a side, which
 * starts from a coarser grid itself. A profile stays one node wide, and a strip becomes one node wide. The
 * load of each coarse node is then divided among the fine nodes that it covers. A call of rc_nested_step does
 * one iteration on one coarser grid, or plans one, so the caller sees every iteration.
 */
#include "solver.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    MANY = 16, /* coarse nodes that are refined together */
    /* Most rounds of Newton's method for the fine nodes of a coarse node. Not sensitive: half and
     * double change no bit of 123 contacts (bench/constants.py). */
    ROUNDS = 8,
    /* Nodes along the map; a smaller coarse grid does not pay. Not sensitive: half takes 1 % more
     * convolutions, double 1 % fewer (74 contacts of bench/constants.py). */
    COARSEST = 24,
    FEW_NODES = 16384 /* limit of nodes of a rank; with fewer, each rank solves the whole grid
                         itself */
};
/* Tolerances of the coarse solution. A more accurate start saves no steps, unless nodes are at their
 * upper bounds. Half and double change the convolutions by less than 2 %, and the errors stay below
 * their estimates (74 contacts of bench/constants.py). */
static const double coarse_tol = 8e-2, coarse_tol_yielding = 3e-2;

void
rc_nested_new(struct rc_solver *s)
{
    size_t nx = s->posed.whole.nx, ny = s->posed.whole.ny;
    bool long_enough = nx >= COARSEST || ny >= COARSEST;

    s->nested = (struct rc_nested){.ahead = s->method->nested && long_enough};
}

void
rc_nested_free(struct rc_solver *s)
{
    rc_solver_free(s->nested.coarse);
    rc_memory_return(s->nested.lent);
    s->nested = (struct rc_nested){.ahead = false};
}

bool
rc_nested_untouched(const struct rc_solver *s)
{
    return s->nested.ahead && s->nested.coarse == NULL;
}

const struct rc_solver *
rc_nested_at_work(const struct rc_solver *s)
{
    while (s->nested.coarse != NULL)
        s = s->nested.coarse;
    return s;
}

double
rc_nested_convolutions(const struct rc_solver *s)
{
    const struct rc_solver *c;

    if (s->nested.coarse == NULL)
        return 0;
    c = s->nested.coarse;
    return (c->it.convolutions + rc_nested_convolutions(c)) * (double)c->posed.nodes /
           (double)s->posed.nodes;
}

/* ---- rows ---- */

/* Rows of the coarser grid that cover the rows held here. The two fine rows of a coarse row are always on the
 * same rank. */
static size_t
rows_under(const struct rc_rows *fine)
{
    return (fine->n + 1) / 2;
}

/* Means over the (up to) four fine nodes of each coarse node, of these rows. */
static void
coarsen(const struct rc_posed *fine, const double *v, size_t coarse_nx, double *h)
{
    size_t nx = fine->shape.nx, ny = fine->shape.ny;

#pragma omp parallel for num_threads(fine->threads) schedule(static)
    for (size_t j = 0; j < rows_under(&fine->rows); j++) {
        const double *a = v + 2 * j * nx, *b = 2 * j + 1 < ny ? a + nx : a;
        double *to = h + j * coarse_nx;
        for (size_t i = 0; i < nx / 2; i++)
            to[i] = (a[2 * i] + a[2 * i + 1] + b[2 * i] + b[2 * i + 1]) / 4;
        if (nx % 2 == 1)
            to[nx / 2] = (a[nx - 1] + b[nx - 1]) / 2;
    }
}

/* ---- between ranks ---- */

/* The first coarse row of each rank: `under`: the first that covers its fine rows; `own`: the
 * first that it solves. */
struct dealt {
    size_t *under, *own;
};

static struct dealt
deal(const struct rc_posed *fine, const struct rc_rows *coarse, struct rc_store *room)
{
    size_t count = rc_ranks_count(fine->rows.ranks);
    struct dealt d = {rc_store_take(room, count + 1, sizeof *d.under),
                      rc_store_take(room, count + 1, sizeof *d.own)};

    for (size_t r = 0; r <= count && !room->failed; r++) {
        size_t unit = rc_rows_unit(fine->whole.nx), nx = (fine->whole.nx + 1) / 2;
        d.under[r] = (rc_rows_dealt(fine->whole.ny, unit, count, r) + 1) / 2;
        d.own[r] = rc_rows_dealt(coarse->ny, rc_rows_unit(nx), count, r);
    }
    return d;
}

/* NULL for a small grid, which every rank solves by itself: communication would take longer. */
static const struct rc_ranks *
ranks_for(const struct rc_solver *s, const struct rc_shape *coarse)
{
    const struct rc_ranks *ranks = s->posed.rows.ranks;

    return coarse->nx * coarse->ny < FEW_NODES * rc_ranks_count(ranks) ? NULL : ranks;
}

/* This map on the coarser grid, for the rows that this rank solves. NULL when memory is short on any rank. */
static double *
coarse_map(const struct rc_solver *s, const double *map, const struct rc_shape *shape,
           const struct rc_rows *rows)
{
    const struct rc_ranks *ranks = s->posed.rows.ranks;
    RC_OWNED double *h = rc_alloc(rows_under(&s->posed.rows) * shape->nx, sizeof *h);
    RC_OWNED double *own = ranks == NULL ? NULL : rc_alloc(rows->n * shape->nx, sizeof *own);
    RC_ENDS(rc_store_free) struct rc_store room = {0};
    const struct dealt d = deal(&s->posed, rows, &room);
    const bool fine = h != NULL && (ranks == NULL || own != NULL) && !room.failed;

    if (rc_ranks_agree(s->posed.all, fine ? RC_OK : RC_FAIL, NULL) != RC_OK)
        return NULL;
    coarsen(&s->posed, map, shape->nx, h);
    if (ranks == NULL)
        return rc_give(&h);
    rc_ranks_move(ranks, shape->nx * sizeof *h, d.under, rows->ranks == NULL ? NULL : d.own, 0, h,
                  own);
    return rc_give(&own);
}

/* Returns the rows of a coarse map that cover the fine rows held here. Where several ranks share the coarse
 * grid, they are moved into memory of `room`. NULL when memory is short on any rank. */
static const double *
map_under(const struct rc_solver *s, const struct rc_solver *c, const double *map,
          struct rc_store *room)
{
    const struct rc_ranks *ranks = s->posed.rows.ranks;
    size_t nx = c->posed.whole.nx;
    struct dealt d;
    double *to;

    if (c->posed.rows.ranks == NULL) /* this rank has all rows */
        return map + (s->posed.rows.first + 1) / 2 * nx;
    to = rc_store_take(room, rows_under(&s->posed.rows) * nx, sizeof *to);
    d = deal(&s->posed, &c->posed.rows, room);
    if (rc_ranks_agree(ranks, room->failed ? RC_FAIL : RC_OK, NULL) != RC_OK)
        return NULL;
    rc_ranks_move(ranks, nx * sizeof *to, d.own, d.under, 0, map, to);
    return to;
}

/* ---- down ---- */

/* The discretization error, proportional to the spacing, is the difference of two grids. The error of the
 * coarse solution must be smaller than this difference: half of
 * 0.1 takes up to 5 % more convolutions, double changes no bit (4 contacts of bench/constants.py). */
static double
tolerance(const struct rc_solver *s, const struct rc_shape *coarse)
{
    double nodes = (double)(coarse->nx * coarse->ny);
    bool line = coarse->nx == 1 || coarse->ny == 1;

    if (s->posed.discretization)
        return fmax(0.1 / (line ? nodes : sqrt(nodes)), s->load.tol);
    return fmax(s->load.target > 0 ? coarse_tol_yielding : coarse_tol, s->load.tol);
}

/* NULL when memory is short: the constant start is then kept. */
static struct rc_solver *
coarse_new(const struct rc_solver *s, bool *sought)
{
    const struct rc_shape shape = rc_shape_coarser(&s->posed.whole);
    struct rc_problem problem = {.boundary = s->posed.boundary,
                                 .load = s->load.load,
                                 .tol = tolerance(s, &shape),
                                 .threads = (size_t)s->posed.threads,
                                 .ranks = ranks_for(s, &shape),
                                 .hurry = s->posed.hurry};
    struct rc_rows rows = rc_rows_of(problem.ranks, &shape);
    const double *fine_highs = s->posed.bounds.box.highs;
    RC_OWNED double *h = coarse_map(s, s->posed.h, &shape, &rows);
    RC_OWNED double *highs = NULL;
    RC_OWN(rc_solver, c) = NULL;
    double lower;

    /* The bound of a coarse node is the mean of the bounds of its four nodes. If one of them has no bound,
     * the coarse node has none. */
    if (h != NULL && fine_highs != NULL)
        highs = coarse_map(s, fine_highs, &shape, &rows);
    if (h == NULL || (fine_highs != NULL && highs == NULL))
        return NULL;
    rc_bounds_pose(&s->posed.bounds, highs, &problem);
    lower = -rc_ranks_most(rows.ranks,
                           rc_highest(h, rows.n * shape.nx)); /* the largest fine height is 0 */
    rc_tilt_pose(s, &problem);
    *sought =
        /* a free tilt changes `lower` */
        s->load.target > 2 * lower && !problem.tilt_free;
    if (*sought)
        problem.approach = s->load.target - lower;
    c = rc_solver_coarse(s, &shape, h, &problem, NULL);
    return rc_ranks_agree(s->posed.all, c == NULL ? RC_FAIL : RC_OK, NULL) == RC_OK ? rc_give(&c)
                                                                                    : NULL;
}

/* ---- up ---- */

/* The coarse solution over the rows held here. */
struct known {
    size_t nx, rows;     /* columns of the coarse grid; number of its rows that cover the rows
                            held here */
    const double *p, *u; /* pressure, and displacement up to a constant */
    const double *before, *after; /* rows of u before and after them; NULL: none */
    struct rc_store room; /* for p, u and the rows beside them, if ranks share the coarse grid */
    double stiffness;     /* Pa/m: stiffness of a fine node whose neighbours are fixed */
    struct rc_boundary boundary;
};

/* Fetches the coarse solution; u replaces c->it.v. False when memory is short on any rank. */
static bool
known_under(const struct rc_solver *s, struct rc_solver *c, struct known *k)
{
    size_t nx = c->posed.whole.nx, ny = c->posed.whole.ny, rows = rows_under(&s->posed.rows);
    size_t first = (s->posed.rows.first + 1) / 2, last = first + rows;
    bool shared = c->posed.rows.ranks != NULL, beside[2];
    double *u = c->it.v, *ends;

    *k = (struct known){.nx = nx,
                        .rows = rows,
                        .stiffness = rc_iterate_stiffness(s),
                        .boundary = s->posed.boundary};
#pragma omp parallel for num_threads(c->posed.threads) schedule(static)
    for (size_t i = 0; i < c->posed.n; i++)
        u[i] += c->posed.h[i];
    if ((k->p = map_under(s, c, c->it.p, &k->room)) == NULL ||
        (k->u = map_under(s, c, u, &k->room)) == NULL)
        return false;
    if (!shared) {
        k->before = first > 0 ? u + (first - 1) * nx : k->boundary.y ? u + (ny - 1) * nx : NULL;
        k->after = last < ny ? u + last * nx : k->boundary.y ? u : NULL;
        return true;
    }
    ends = rc_store_take(&k->room, 2 * nx, sizeof *ends);
    if (rc_ranks_agree(s->posed.rows.ranks, ends != NULL ? RC_OK : RC_FAIL, NULL) != RC_OK)
        return false;
    rc_ranks_beside(&s->posed.rows, k->boundary.y, nx * sizeof *ends, k->u,
                    k->u + (rows > 0 ? rows - 1 : 0) * nx, ends, ends + nx, beside);
    k->before = beside[0] ? ends : NULL;
    k->after = beside[1] ? ends + nx : NULL;
    return true;
}

/* Coarse nodes in a row, and their fine nodes: two of the first fine row, then two of the second. */
struct over {
    size_t n;
    double p[MANY], load[MANY];        /* coarse pressure, and load of the fine nodes */
    double y[4][MANY];                 /* pressures up to a common shift; then the pressures */
    double high[4][MANY], on[4][MANY]; /* upper bounds; 0 beyond the map, else 1 */
};

/* Finds the common shifts by Newton's method; projection onto the load of the map later corrects their
 * remainders. If one of the nodes would yield, the coarse displacement does not tell which others yield, so
 * all get the same pressure. */
RC_CLONES static void
share(struct over *o, double low)
{
    double mu[MANY], left = 1;

#pragma omp simd
    for (size_t i = 0; i < o->n; i++) {
        double sum = 0, nodes = 0;
        for (size_t q = 0; q < 4; q++) {
            sum += o->y[q][i];
            nodes += o->on[q][i];
        }
        o->load[i] = nodes * o->p[i];
        mu[i] = (o->load[i] - sum) / nodes;
    }
    for (int round = 0; round < ROUNDS && left > 0; round++) {
        left = 0;
#pragma omp simd reduction(+ : left)
        for (size_t i = 0; i < o->n; i++) {
            double excess = -o->load[i], between = 0, was = mu[i], next;
            for (size_t q = 0; q < 4; q++) {
                double v = o->y[q][i] + mu[i], high = o->high[q][i], p = v > low ? v : low;
                excess += o->on[q][i] * (p < high ? p : high);
                between += ((v > low) & (v < high)) ? o->on[q][i] : 0;
            }
            next = was - excess / between;
            next = fabs(excess) > 4 * DBL_EPSILON * o->load[i] ? next : was;
            mu[i] = next = between > 0 ? next : was;
            left += next != was ? 1 : 0;
        }
    }
#pragma omp simd
    for (size_t i = 0; i < o->n; i++) {
        double yields = 0;
        for (size_t q = 0; q < 4; q++)
            yields += o->y[q][i] + mu[i] >= o->high[q][i] ? o->on[q][i] : 0;
        for (size_t q = 0; q < 4; q++) {
            double v = yields > 0 ? o->p[i] : o->y[q][i] + mu[i], high = o->high[q][i];
            v = v > low ? v : low;
            o->y[q][i] = v < high ? v : high;
        }
    }
}

/* The node after or before i on a coarse line of n nodes. Returns i at an end of the line. */
static size_t
beside(size_t i, bool after, size_t n, bool round)
{
    if (after)
        return i + 1 < n ? i + 1 : round ? 0 : i;
    return i > 0 ? i - 1 : round ? n - 1 : i;
}

/* A part of a coarse row with the nodes before and after it. */
static void
take(const struct known *c, const double *row, size_t first, size_t n, double *to)
{
    to[0] = row[beside(first, false, c->nx, c->boundary.x)];
    memcpy(to + 1, row + first, n * sizeof *to);
    to[n + 1] = row[beside(first + n - 1, true, c->nx, c->boundary.x)];
}

/* Fine nodes, of every other column of a row. They lie a quarter of the coarse spacing from their coarse
 * nodes u, towards the nodes to this side and v of the next row. The displacement there is interpolated
 * linearly. */
RC_CLONES static void
aim(size_t n, double stiffness, const double *restrict u, const double *restrict v, ptrdiff_t side,
    const double *restrict h, const double *restrict p, double low, double *restrict y)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        double at = (9 * u[i] + 3 * (u[(ptrdiff_t)i + side] + v[i]) + v[(ptrdiff_t)i + side]) / 16;
        double own = stiffness * (h[2 * i] - at);
        y[i] = p[i] > low ? own : p[i];
    }
}

/* Coarse nodes from column `first` of row j on. Nodes up to `low` repeat the coarse pressure. */
static void
refine_some(struct rc_solver *s, const struct known *c, double low, size_t first, size_t j)
{
    const struct rc_box box = rc_box(s, 0);
    const size_t nx = s->posed.shape.nx, ny = s->posed.shape.ny;
    const double *u = c->u + j * c->nx;
    double own[MANY + 2], other[MANY + 2];
    const double *p = c->p + j * c->nx + first;
    struct over o = {.n = c->nx - first < MANY ? c->nx - first : MANY};
    size_t pressed = 0;

    for (size_t i = 0; i < o.n; i++)
        pressed += p[i] > low ? 1 : 0;
    for (size_t y = 2 * j; pressed == 0 && y < 2 * j + 2 && y < ny; y++)
        for (size_t x = 2 * first; x < 2 * (first + o.n) && x < nx; x++)
            s->it.p[y * nx + x] = rc_clip(box, y * nx + x, p[x / 2 - first]);
    if (pressed == 0)
        return;
    memcpy(o.p, p, o.n * sizeof *p);
    take(c, u, first, o.n, own);
    for (size_t q = 0; q < 4; q++) {
        const size_t y = 2 * j + q / 2, x = 2 * first + q % 2, k = y * nx + x;
        const double *v = q > 1   ? j + 1 < c->rows ? u + c->nx : c->after
                          : j > 0 ? u - c->nx
                                  : c->before;
        take(c, v == NULL || s->posed.whole.ny == 1 ? u : v, first, o.n, other);
        for (size_t i = 0; i < o.n && y < ny && x + 2 * i < nx; i++) {
            o.on[q][i] = 1;
            o.high[q][i] = rc_high(box, k + 2 * i);
        }
        aim(y < ny ? (nx - x + 1) / 2 < o.n ? (nx - x + 1) / 2 : o.n : 0, c->stiffness, own + 1,
            other + 1, q % 2 == 1 ? 1 : -1, s->posed.h + k, o.p, low, o.y[q]);
    }
    share(&o, rc_low(box, 0));
    for (size_t q = 0; q < 4; q++)
        for (size_t i = 0; i < o.n; i++)
            if (o.on[q][i] > 0)
                s->it.p[(2 * j + q / 2) * nx + 2 * (first + i) + q % 2] = o.y[q][i];
}

/* Divides the load of each coarse node among its fine nodes. The higher a fine node lies above the
 * interpolated displacement, the larger its pressure, with the stiffness of a node whose neighbours are
 * fixed. Repeating the coarse pressure instead starts with four to five times the error; this is done where
 * the displacement is unknown. */
static void
refine(struct rc_solver *s, struct rc_solver *c)
{
    bool known = c->it.known && !rc_solver_hurried(s); /* repeating takes half the time */
    struct known k;

    if (!known_under(s, c, &k)) {
        rc_store_free(&k.room);
        return;
    }
#pragma omp parallel for num_threads(s->posed.threads) schedule(static)
    for (size_t j = 0; j < k.rows; j++)
        for (size_t i = 0; i < k.nx; i += MANY)
            refine_some(s, &k, known ? rc_low(rc_box(s, 0), 0) : INFINITY, i, j);
    rc_store_free(&k.room);
    if (fabs(rc_iterate_carried(s) - s->load.sum) <= 1e-14 * s->load.sum)
        return;
    /* an odd line was counted twice; if nodes have to join, the highest joins first */
    for (size_t i = 0; i < s->posed.n; i++)
        s->it.v[i] = -s->posed.h[i];
    rc_projection_balance(s, s->it.v);
}

/* Figures of the coarse solution, its approach from the highest node of the fine grid. If the approach is
 * given, it is equal on both grids, and its difference is no estimate. */
static void
compare(struct rc_solver *s, struct rc_solver *c)
{
    size_t contact = 0;

    for (size_t k = 0; k < c->posed.n; k++)
        contact += !rc_at_low(rc_box(c, 0), k, c->it.p[k]);
    s->coarse.contact_area = (double)rc_ranks_sum(c->posed.rows.ranks, contact) * c->posed.cell;
    s->coarse.max_pressure = rc_ranks_most(c->posed.rows.ranks, rc_highest(c->it.p, c->posed.n));
    rc_iterate_shift(c);
    s->coarse.approach = c->it.elastic > 0 && s->load.target == 0
                             ? rc_tilt_approach(c) - (s->tilt != NULL ? 0 : c->posed.top)
                             : NAN;
}

void
rc_nested_end(struct rc_solver *s)
{
    struct rc_solver *c = s->nested.coarse;

    if (c != NULL) {
        rc_nested_end(c);
        if (s->posed.discretization && c->it.known)
            compare(s, c);
        rc_tilt_from_coarse(s, c);
        if (!s->nested.sought || rc_load_set(s, c->load.load, NULL) == RC_OK)
            refine(s, c);
        rc_iterate_count(s, c->it.convolutions * (double)c->posed.nodes / (double)s->posed.nodes);
    }
    rc_nested_free(s);
}

void
rc_nested_step(struct rc_solver *s)
{
    struct rc_solver *c;

    if (s->nested.coarse == NULL) {
        rc_memory_lend();
        s->nested.coarse = coarse_new(s, &s->nested.sought);
        s->nested.lent = rc_memory_lent();
        if (s->nested.coarse == NULL)
            rc_nested_free(s);
        return;
    }
    c = s->nested.coarse;
    if (c->load.target == 0 && c->set.saturated > 0)
        c->load.tol = fmin(c->load.tol, fmax(coarse_tol_yielding, s->load.tol));
    if (rc_solver_step(c) != RC_MORE)
        rc_nested_end(s);
}
