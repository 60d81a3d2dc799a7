/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The start of a path from coarser grids. The first state is found roughly on a grid with every other node,
 * which starts from a coarser grid itself. Its heights are samples: means would lower short waves, so that
 * spots would close at other approaches than on the fine grid. The displacement is smooth; between the coarse
 * nodes cubic polynomials through four nodes of a line give it.
 */
#include "gap.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The coarse nodes for a fine node of a line, and their weights. */
struct between {
    size_t at[4];
    double weight[4];
};

/* Node i of a line of n nodes; the map has the first m. Beyond the middle of the padding the line continues
 * at the first node, with i - n. */
static struct between
between(size_t i, size_t m, size_t n, size_t coarse)
{
    static const double middle[4] = {-1.0 / 16, 9.0 / 16, 9.0 / 16, -1.0 / 16};
    const size_t back = n - i, half = i < m + (n - m) / 2 ? i / 2 : 2 * coarse - (back + 1) / 2;
    const bool odd = (i < m + (n - m) / 2 ? i : back) % 2 == 1;
    struct between b;

    for (size_t k = 0; k < 4; k++) {
        b.at[k] = n == 1 ? 0 : (half + coarse + k - 1) % coarse;
        b.weight[k] = odd ? middle[k] : k == 1;
    }
    return b;
}

/* Rows of the coarse grid, from `first` on, the first row after the last one; h on the map only. */
struct under {
    const struct rc_gap_problem *of;
    size_t first;
    const double *x, *h;
};

/* The gap of a node of this height. It is 0 where all coarse nodes around are closed, and below 0 only where
 * some have yielded. Beyond the map: u - c. */
static double
gap_at(const struct under *coarse, const struct between *x, const struct between *y, double factor,
       bool on_map, double h)
{
    const struct rc_gap_problem *of = coarse->of;

    double u = 0, least = 0;
    bool apart = false;

    for (size_t b = 0; b < 4; b++)
        for (size_t a = 0; a < 4; a++) {
            const size_t i = x->at[a], j = (y->at[b] + of->py - coarse->first) % of->py;
            const double weight = x->weight[a] * y->weight[b], gap = coarse->x[j * of->px + i];
            const bool map = i < of->nx && y->at[b] < of->ny;
            u += weight * (map ? gap + coarse->h[j * of->nx + i] : gap);
            apart |= weight > 0 && !(map && gap == 0);
            least = weight > 0 && map ? fmin(least, gap) : least;
        }
    return !apart ? 0 : on_map ? fmax(factor * u - h, factor * least) : factor * u;
}

/* The rows of the coarse grid under rows j .. j + n - 1 of the fine one: *count from *first on. */
static void
rows_under(const struct rc_gap_problem *fine, const struct rc_gap_problem *coarse, size_t j,
           size_t n, size_t *first, size_t *count)
{
    const size_t ny = coarse->py;
    /* with one more period, so that no row before the first is negative */
    size_t low = SIZE_MAX, high = 0;

    for (size_t k = j; k < j + n; k++) {
        const struct between y = between(k, fine->ny, fine->py, ny);
        const size_t before = y.at[1] + ny - 1; /* at[1] is the row before, or at, row k */
        low = before < low ? before : low;
        high = before + 3 > high ? before + 3 : high;
    }
    *count = n == 0 ? 0 : high - low + 1 < ny ? high - low + 1 : ny;
    *first = n == 0 || *count == ny ? 0 : low % ny;
}

/* Fetches these rows. False if memory is short on a rank; free(*x) in either case. */
static bool
fetch(const struct rc_gap_problem *fine, const struct rc_gap *coarse, struct under *under,
      double **x)
{
    const struct rc_gap_problem *of = &coarse->problem;
    const struct rc_ranks *ranks = of->rows.ranks;
    const size_t count = rc_ranks_count(ranks), own = rc_ranks_own(ranks);
    RC_OWNED size_t *from = malloc((3 * count + 1) * sizeof *from);
    size_t *first = from != NULL ? from + count + 1 : NULL;
    size_t *n = first != NULL ? first + count : NULL;
    double *spread = coarse->maps.step; /* h on rows of the grid: the coarse iteration has ended */

    for (size_t r = 0; r <= count && from != NULL; r++) {
        const size_t unit = rc_rows_unit(fine->px);
        const size_t j = rc_rows_dealt(fine->py, unit, count, r);
        from[r] = rc_rows_dealt(of->py, rc_rows_unit(of->px), count, r);
        if (r < count)
            rows_under(fine, of, j, rc_rows_dealt(fine->py, unit, count, r + 1) - j, &first[r],
                       &n[r]);
    }
    if (n != NULL)
        *x = rc_alloc(n[own] * (of->px + of->nx), sizeof **x);
    if (rc_ranks_agree(ranks, *x != NULL ? RC_OK : RC_FAIL, NULL) != RC_OK || n == NULL)
        return false;
    memset(spread, 0, of->rows.n * of->nx * sizeof *spread);
    if (of->on_map > 0)
        memcpy(spread, of->h, of->on_map * of->nx * sizeof *spread);
    rc_ranks_fetch(ranks, of->px * sizeof **x, from, first, n, coarse->maps.x, *x);
    rc_ranks_fetch(ranks, of->nx * sizeof **x, from, first, n, spread, *x + n[own] * of->px);
    *under = (struct under){of, first[own], *x, *x + n[own] * of->px};
    return true;
}

bool
rc_gap_refine(struct rc_gap *g, const struct rc_gap *coarse)
{
    const struct rc_gap_problem *of = &coarse->problem;
    const double factor = of->whole->length / g->problem.whole->length;
    struct under under = {of, 0, coarse->maps.x, of->h};
    RC_OWNED double *rows = NULL;

    if (of->rows.ranks != NULL && !fetch(&g->problem, coarse, &under, &rows))
        return false;
#pragma omp parallel for num_threads(g->sums.threads) schedule(static)
    for (size_t j = 0; j < g->problem.rows.n; j++) {
        const struct between y =
            between(g->problem.rows.first + j, g->problem.ny, g->problem.py, of->py);
        const size_t m = rc_gap_on_map(&g->problem, j);
        for (size_t i = 0; i < g->problem.px; i++) {
            const struct between x = between(i, g->problem.nx, g->problem.px, of->px);
            const double h = i < m ? g->problem.h[j * g->problem.nx + i] : 0;
            g->maps.x[j * g->problem.px + i] = gap_at(&under, &x, &y, factor, i < m, h);
        }
    }
    return true;
}
