/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The start of a path from coarser grids. The first state is found roughly on a grid with every other node,
 * which starts from a coarser grid itself. Its heights are samples: means would lower short waves, so that
 * spots would close at other approaches than on the fine grid. The displacement is smooth; between the coarse
 * nodes cubic polynomials through four nodes of a line give it.
 */
#include "gap.h"

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

/* The gap of a node of this height. It is 0 where all coarse nodes around are closed, and below 0 only where
 * some have yielded. Beyond the map: u - c. */
static double
gap_at(const struct rc_gap_problem *problem, const double *gaps, const struct between *x,
       const struct between *y, double factor, bool on_map, double h)
{
    double u = 0, least = 0;
    bool apart = false;

    for (size_t b = 0; b < 4; b++)
        for (size_t a = 0; a < 4; a++) {
            const size_t i = x->at[a], j = y->at[b];
            const double weight = x->weight[a] * y->weight[b], gap = gaps[j * problem->px + i];
            const bool map = i < rc_gap_on_map(problem, j);
            u += weight * (map ? gap + problem->h[j * problem->nx + i] : gap);
            apart |= weight > 0 && !(map && gap == 0);
            least = weight > 0 && map ? fmin(least, gap) : least;
        }
    return !apart ? 0 : on_map ? fmax(factor * u - h, factor * least) : factor * u;
}

void
rc_gap_refine(struct rc_gap *g, const struct rc_gap *coarse)
{
    const double factor = coarse->problem.whole->length / g->problem.whole->length;

#pragma omp parallel for num_threads(g->sums.threads) schedule(static)
    for (size_t j = 0; j < g->problem.py; j++) {
        const struct between y = between(j, g->problem.ny, g->problem.py, coarse->problem.py);
        const size_t m = rc_gap_on_map(&g->problem, j);
        for (size_t i = 0; i < g->problem.px; i++) {
            const struct between x = between(i, g->problem.nx, g->problem.px, coarse->problem.px);
            const double h = i < m ? g->problem.h[j * g->problem.nx + i] : 0;
            g->maps.x[j * g->problem.px + i] =
                gap_at(&coarse->problem, coarse->maps.x, &x, &y, factor, i < m, h);
        }
    }
}
