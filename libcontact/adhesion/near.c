/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A times the part of a step that the bounds cut off. Most steps of a large map reach 0 at few nodes, and a
 * convolution for them would cost as much as the rest of the step. The coefficients of A fall with the third
 * power of the distance: the terms near each node suffice, and the sum of the others bounds the error.
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
    row[0] = j == 0;
    return j == 0;
}

static bool
one_out(void *ctx, size_t j, void *from)
{
    struct rc_gap *g = ctx;
    const double *row = from;
    double *sums = rc_sums_of(&g->sums, j);

    for (size_t i = 0; i < g->problem.px; i++)
        sums[ALL] += fabs(row[i]);
    if (j < SIDE)
        memcpy(g->near.a + j * SIDE, row, SIDE * sizeof *row);
    return true;
}

/* A times a unit at node 0; the coefficients are even along x and along y. */
static bool
find_coefficients(struct rc_gap *g)
{
    double sums[RC_GAP_SUMS];

    if (g->near.a != NULL)
        return true;
    if (g->problem.n < FEWEST || g->problem.px <= 2 * REACH || g->problem.py <= 2 * REACH ||
        (g->near.a = malloc(SIDE * SIDE * sizeof *g->near.a)) == NULL)
        return false;
    rc_whole_rows(g->problem.whole, RC_WHOLE_INVERSE, one_in, one_out, g);
    rc_sums_total(&g->sums, sums);
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

/* Adds A times c at node i of row j. */
static void
add_node(const struct rc_gap_problem *problem, const double *coefficients, double *a_step, size_t j,
         size_t i, double c)
{
    for (size_t y = 0; y <= 2 * REACH; y++) {
        const double *a = coefficients + (y < REACH ? REACH - y : y - REACH) * SIDE;
        double *to = a_step + (j + y + problem->py - REACH) % problem->py * problem->px;
        for (size_t x = 0; x <= 2 * REACH; x++)
            to[(i + x + problem->px - REACH) % problem->px] +=
                c * a[x < REACH ? REACH - x : x - REACH];
    }
}

/* A times the step is `a` A d plus A times the cut-off parts. Returns the sum of their sizes. */
static double
add_cut(const struct rc_gap_problem *problem, const double *coefficients,
        const struct rc_sums *clipped, struct rc_gap_maps *maps, double a)
{
    const size_t nx = problem->nx, px = problem->px;
    double sum = 0;

#pragma omp parallel for num_threads(clipped->threads) schedule(static)
    for (size_t k = 0; k < problem->n; k++)
        maps->a_step[k] = a * maps->ad[k];
    for (size_t j = 0; j < problem->ny; j++)
        for (size_t i = 0; i < nx && rc_sums_of(clipped, j)[RC_GAP_CLIPPED] > 0; i++) {
            const size_t at = j * px + i;
            if (maps->x[at] + maps->step[at] != 0 || maps->step[at] == a * maps->d[at])
                continue;
            add_node(problem, coefficients, maps->a_step, j, i, maps->step[at] - a * maps->d[at]);
            sum += fabs(maps->step[at] - a * maps->d[at]);
        }
    return sum;
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
    if (cut * WINDOW > SHARE * g->problem.n || !find_coefficients(g))
        return false;
    g->told.cut = g->near.rest * add_cut(&g->problem, g->near.a, &g->sums, &g->maps, a);
    g->run.convolutions += (double)(cut * WINDOW) / ((double)g->problem.n * PAIR);
    if (g->set.control == RC_GAP_MEAN && sum > 0) {
        find_ah(g);
        keep_mean(&g->maps, g->near.ah, g->problem.n, g->sums.threads,
                  1 - g->set.given * (double)g->problem.n / sum);
    }
    return true;
}
