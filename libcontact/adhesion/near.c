/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A times the part of a step that the bounds cut off. Most steps of a large map reach 0 at few nodes, and a
 * convolution for them would cost as much as the rest of the step. The coefficients of A fall with the third
 * power of the distance: the terms near each node suffice, and the sum of the others bounds the error.
 *
 * Ranks get the cut-off parts near their rows from those beside them. Each rank adds them in the order of the
 * map.
 */
#include <stdlib.h>
#include <string.h>

#include "gap.h"

enum {
    REACH = 16,
    SIDE = REACH + 1,
    ALL = RC_GAP_CLIP_OPEN + 1, /* sum of the sizes of coefficients */
    WINDOW = (2 * REACH + 1) * (2 * REACH + 1),
    SHARE = 4,     /* most multiplications a node of the grid for a step */
    PAIR = 50,     /* those of a convolution */
    FEWEST = 65536 /* nodes of the grid; on smaller ones the coefficients do not pay */
};

/* ---- coefficients ---- */

static bool
one_in(void *ctx, size_t j, void *to)
{
    const struct rc_gap *g = ctx;
    double *row = to;

    memset(row, 0, g->problem.px * sizeof *row);
    row[0] = g->problem.rows.first + j == 0;
    return row[0] != 0;
}

static bool
one_out(void *ctx, size_t j, void *from)
{
    struct rc_gap *g = ctx;
    const double *row = from;
    const size_t at = g->problem.rows.first + j;
    double *sums = rc_sums_of(&g->sums, j);

    for (size_t i = 0; i < g->problem.px; i++)
        sums[ALL] += fabs(row[i]);
    if (at < SIDE)
        memcpy(g->near.a + at * SIDE, row, SIDE * sizeof *row);
    return true;
}

/* A times a unit at node 0; the coefficients are even along x and along y. */
static bool
find_coefficients(struct rc_gap *g)
{
    const struct rc_ranks *ranks = g->problem.rows.ranks;
    double sums[RC_GAP_SUMS], *a;

    if (g->near.a != NULL)
        return true;
    if (g->problem.all < FEWEST || g->problem.px <= 2 * REACH || g->problem.py <= 2 * REACH)
        return false;
    a = calloc(SIDE * SIDE, sizeof *a);
    if (rc_ranks_agree(ranks, a != NULL ? RC_OK : RC_FAIL, NULL) != RC_OK) {
        free(a);
        return false;
    }
    g->near.a = a;
    rc_whole_rows(g->problem.whole, RC_WHOLE_INVERSE, one_in, one_out, g);
    rc_sums_total(&g->sums, sums);
    rc_ranks_each_sum(ranks, SIDE * SIDE, a); /* one rank has a row, the others have zeros */
    g->run.convolutions++;
    for (size_t k = 0; k < SIDE * SIDE; k++)
        sums[ALL] -= (k % SIDE > 0 ? 2 : 1) * (k / SIDE > 0 ? 2 : 1) * fabs(g->near.a[k]);
    g->near.rest = fmax(sums[ALL], 0);
    return true;
}

/* ---- A h, for a given mean ---- */

static bool
h_in(void *ctx, size_t j, void *to)
{
    const struct rc_gap *g = ctx;
    float *row = to;

    for (size_t i = 0; i < g->problem.px; i++)
        row[i] = (float)g->problem.h[j * g->problem.nx + i];
    return true;
}

static bool
h_out(void *ctx, size_t j, void *from)
{
    const struct rc_gap *g = ctx;

    memcpy(g->near.ah + j * g->problem.px, from, g->problem.px * sizeof(float));
    return true;
}

static void
find_ah(struct rc_gap *g)
{
    if (!g->near.known)
        rc_whole_rows(g->problem.whole, RC_WHOLE_ROUGH_INVERSE, h_in, h_out, g);
    g->run.convolutions += g->near.known ? 0 : 0.5;
    g->near.known = true;
}

/* ---- a step ---- */

/* A node of the grid, and the part of its step that was cut off. */
struct cut {
    size_t at;
    double c;
};

/* Adds A times this part, in the rows held here. */
static void
add_node(const struct rc_gap_problem *problem, const double *coefficients, double *a_step,
         const struct cut *cut)
{
    const struct rc_rows *rows = &problem->rows;
    const size_t px = problem->px, py = problem->py, j = cut->at / px, i = cut->at % px;

    for (size_t y = 0; y <= 2 * REACH; y++) {
        const double *a = coefficients + (y < REACH ? REACH - y : y - REACH) * SIDE;
        const size_t row = (j + y + py - REACH) % py;
        double *to = a_step + (row - rows->first) * px;
        if (row < rows->first || row >= rows->first + rows->n)
            continue;
        for (size_t x = 0; x <= 2 * REACH; x++)
            to[(i + x + px - REACH) % px] += cut->c * a[x < REACH ? REACH - x : x - REACH];
    }
}

/* The cut-off parts that a rank has: all, those in its first rows, and those in its last rows. */
struct counts {
    size_t all, first, last;
};
_Static_assert(sizeof(struct counts) <= RC_RANKS_ROOM, "RC_RANKS_ROOM is too small");

/* The cut-off parts in the rows held here, in the order of the map. NULL: memory is short. */
static struct cut *
find_cut(const struct rc_gap *g, double a, struct counts *count, struct rc_total *sum)
{
    const struct rc_gap_problem *problem = &g->problem;
    const struct rc_gap_maps *maps = &g->maps;
    const size_t rows = problem->rows.n;
    size_t most = 1;
    struct cut *cuts;

    *count = (struct counts){0};
    *sum = (struct rc_total){0};
    for (size_t j = 0; j < problem->on_map; j++)
        most += (size_t)rc_sums_of(&g->sums, j)[RC_GAP_CLIPPED];
    if ((cuts = malloc(most * sizeof *cuts)) == NULL)
        return NULL;
    for (size_t j = 0; j < problem->on_map; j++)
        for (size_t i = 0; i < problem->nx && rc_sums_of(&g->sums, j)[RC_GAP_CLIPPED] > 0; i++) {
            const size_t at = j * problem->px + i;
            const double c = maps->step[at] - a * maps->d[at];
            if (maps->x[at] + maps->step[at] != 0 || maps->step[at] == a * maps->d[at])
                continue;
            cuts[count->all++] = (struct cut){problem->rows.first * problem->px + at, c};
            count->first += j < REACH;
            count->last += j + REACH >= rows;
            rc_total_add(sum, fabs(c));
        }
    return cuts;
}

/* The first rows of rank r. */
static size_t
row_of(const struct rc_gap_problem *problem, size_t r)
{
    return rc_rows_dealt(problem->py, rc_rows_unit(problem->px),
                         rc_ranks_count(problem->rows.ranks), r);
}

/* Items of other ranks that reach the rows of rank r, on one side of it: *rows rows have them. */
static size_t
beside(const struct rc_gap_problem *problem, const struct counts *counts, size_t r, bool after,
       size_t *rows)
{
    const size_t count = rc_ranks_count(problem->rows.ranks);
    size_t n = 0;

    for (size_t q = r; *rows < REACH;) {
        q = after ? (q + 1) % count : (q + count - 1) % count;
        if (q == r)
            break;
        n += after ? counts[q].first : counts[q].last;
        *rows += row_of(problem, q + 1) - row_of(problem, q);
    }
    return n;
}

/* The items that each rank has, `from`, and needs: n of them from `first` on. */
static void
deal(const struct rc_gap_problem *problem, const struct counts *counts, size_t *from, size_t *first,
     size_t *n)
{
    const size_t count = rc_ranks_count(problem->rows.ranks);
    size_t all;

    from[0] = 0;
    for (size_t r = 0; r < count; r++)
        from[r + 1] = from[r] + counts[r].all;
    all = from[count];
    for (size_t r = 0; r < count; r++) {
        const size_t own = row_of(problem, r + 1) - row_of(problem, r);
        size_t above = 0, below = 0;
        const size_t before = own > 0 ? beside(problem, counts, r, false, &above) : 0;
        const size_t after = own > 0 ? beside(problem, counts, r, true, &below) : 0;
        n[r] = own > 0 ? before + counts[r].all + after : 0;
        first[r] = all > 0 ? (from[r] + all - before) % all : 0;
        if (n[r] >= all || above + own + below > problem->py) {
            first[r] = 0;
            n[r] = own > 0 ? all : 0;
        }
    }
}

/* Replaces the items by those that reach the rows held here; *count of them from *first on, the first after
 * the last. False if memory is short on a rank. */
static bool
fetch(const struct rc_gap_problem *problem, const struct counts *own, struct cut **cuts,
      size_t *count, size_t *first)
{
    const struct rc_ranks *ranks = problem->rows.ranks;
    const size_t all = rc_ranks_count(ranks), at = rc_ranks_own(ranks);
    RC_OWNED struct counts *counts = malloc(all * sizeof *counts);
    RC_OWNED size_t *dealt = malloc((3 * all + 1) * sizeof *dealt);
    size_t *starts = dealt + all + 1, *n = starts + all;
    struct cut *near = NULL;

    if (rc_ranks_agree(ranks, counts != NULL && dealt != NULL ? RC_OK : RC_FAIL, NULL) != RC_OK)
        return false;
    rc_ranks_gather(ranks, sizeof *own, own, counts);
    deal(problem, counts, dealt, starts, n);
    near = malloc((n[at] + 1) * sizeof *near);
    if (rc_ranks_agree(ranks, near != NULL ? RC_OK : RC_FAIL, NULL) != RC_OK) {
        free(near);
        return false;
    }
    rc_ranks_fetch(ranks, sizeof *near, dealt, starts, n, *cuts, near);
    free(*cuts);
    *cuts = near;
    *count = n[at];
    *first = starts[at] + n[at] > dealt[all] ? dealt[all] - starts[at] : 0;
    return true;
}

/* A times the step is `a` A d plus A times the cut-off parts. *sum: that of their sizes. False if memory is
 * short on a rank. */
static bool
add_cut(struct rc_gap *g, double a, double *sum)
{
    const struct rc_ranks *ranks = g->problem.rows.ranks;
    struct counts own;
    struct rc_total size;
    struct cut *cuts = find_cut(g, a, &own, &size);
    size_t count = own.all, first = 0;
    bool has = rc_ranks_agree(ranks, cuts != NULL ? RC_OK : RC_FAIL, NULL) == RC_OK;

    if (has && ranks != NULL)
        has = fetch(&g->problem, &own, &cuts, &count, &first);
    if (has) {
        *sum = rc_ranks_total(ranks, size);
#pragma omp parallel for num_threads(g->sums.threads) schedule(static)
        for (size_t k = 0; k < g->problem.n; k++)
            g->maps.a_step[k] = a * g->maps.ad[k];
        for (size_t k = 0; k < count; k++)
            add_node(&g->problem, g->near.a, g->maps.a_step, &cuts[(first + k) % count]);
    }
    free(cuts);
    return has;
}

/* For a given mean: all gaps become smaller by the same factor, so that closed nodes stay closed. */
static void
keep_mean(struct rc_gap_maps *maps, const float *ah, size_t n, int threads, double smaller)
{
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t k = 0; k < n; k++) {
        maps->a_step[k] -= smaller * (maps->au[k] + maps->a_step[k] - (double)ah[k]);
        maps->step[k] -= smaller * (maps->x[k] + maps->step[k]);
    }
}

bool
rc_gap_near(struct rc_gap *g, double a, size_t cut, double sum)
{
    double size;

    if (cut * WINDOW > SHARE * g->problem.all || !find_coefficients(g) || !add_cut(g, a, &size))
        return false;
    g->told.cut = g->near.rest * size;
    g->run.convolutions += (double)(cut * WINDOW) / ((double)g->problem.all * PAIR);
    if (g->set.control == RC_GAP_MEAN && sum > 0) {
        find_ah(g);
        keep_mean(&g->maps, g->near.ah, g->problem.n, g->sums.threads,
                  1 - g->set.given * (double)g->problem.all / sum);
    }
    return true;
}
