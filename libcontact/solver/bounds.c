/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The bounds of the pressure and the load that they can carry.
 */
#include "bounds.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "libcontact/memory.h"
#include "libcontact/operator/operator.h"

/* ---- from a problem ---- */

static struct rc_bounds
of_numbers(double high, size_t nodes)
{
    const double low = 0;

    return (struct rc_bounds){.box = {.low = low, .high = high},
                              .unit = high - low,
                              .highest = isinf(high) ? low : high,
                              .open = isinf(high),
                              .floor = low * (double)nodes,
                              .full = high * (double)nodes};
}

/* Figures of a map of upper bounds. */
struct survey {
    double least, most;  /* range over the nodes that have a bound */
    double sum;          /* sum over all nodes; INFINITY if a node has no bound */
    size_t numbers, bad; /* number of nodes with a bound; of nodes with a bound of 0 or less */
    size_t first_bad;    /* index in the whole map                                   */
};

static struct survey
survey_of(const double *map, const struct rc_rows *rows, size_t nx)
{
    struct survey s = {.least = INFINITY, .most = 0, .first_bad = rows->ny * nx};
    struct rc_total sum = {0};

    for (size_t k = 0; k < rows->n * nx; k++) {
        bool none = isnan(map[k]) || (isinf(map[k]) && map[k] > 0);
        if (!none && !(map[k] > 0) && s.bad++ == 0)
            s.first_bad = rows->first * nx + k;
        if (!none) {
            s.least = fmin(s.least, map[k]);
            s.most = fmax(s.most, map[k]);
            s.numbers++;
        }
        rc_total_add(&sum, none ? INFINITY : map[k]);
    }
    s.least = -rc_ranks_most(rows->ranks, -s.least);
    s.most = rc_ranks_most(rows->ranks, s.most);
    s.sum = rc_ranks_total(rows->ranks, sum);
    s.numbers = rc_ranks_sum(rows->ranks, s.numbers);
    s.bad = rc_ranks_sum(rows->ranks, s.bad);
    s.first_bad = (size_t)-rc_ranks_most(rows->ranks, -(double)s.first_bad);
    return s;
}

enum rc_status
rc_bounds_of(struct rc_bounds *b, const struct rc_problem *problem, const struct rc_shape *whole,
             struct rc_err *err)
{
    const struct rc_rows rows = rc_rows_of(problem->ranks, whole);
    size_t nodes = whole->nx * whole->ny;
    struct survey s;

    if (!(problem->hardness >= 0))
        return rc_err_set(err, "hardness %g Pa: it must be positive", problem->hardness);
    *b = of_numbers(problem->hardness == 0 ? INFINITY : problem->hardness, nodes);
    if (problem->hardness_map == NULL)
        return RC_OK;
    if (!isinf(b->box.high))
        return rc_err_set(err, "hardness %g Pa and a map of hardness: give only one of them",
                          b->box.high);
    s = survey_of(problem->hardness_map, &rows, whole->nx);
    if (s.bad > 0)
        return rc_err_set(err,
                          "%zu of %zu hardnesses are not above 0, the first in column %zu of row "
                          "%zu: each must be above 0, or NaN for a node without a hardness",
                          s.bad, nodes, s.first_bad % whole->nx, s.first_bad / whole->nx);
    if (s.numbers == 0 || (s.numbers == nodes && s.least == s.most)) {
        *b = of_numbers(s.numbers == 0 ? INFINITY : s.most, nodes);
        return RC_OK;
    }
    b->unit = ldexp(1, ilogb(s.least)); /* a power of 2: nothing is rounded */
    b->box.highs = problem->hardness_map;
    b->box.per_unit = 1 / b->unit;
    b->highest = s.most;
    b->open = s.numbers < nodes;
    b->full = s.sum;
    return RC_OK;
}

enum rc_status
rc_bounds_keep(struct rc_bounds *b, size_t n)
{
    if (b->box.highs == NULL)
        return RC_OK;
    if ((b->own = rc_alloc(n, sizeof *b->own)) == NULL)
        return RC_FAIL;
    for (size_t k = 0; k < n; k++)
        b->own[k] = isnan(b->box.highs[k]) ? INFINITY : b->box.highs[k];
    b->box.highs = b->own;
    return RC_OK;
}

void
rc_bounds_free(struct rc_bounds *b)
{
    free(b->own);
}

void
rc_bounds_pose(const struct rc_bounds *b, const double *highs, struct rc_problem *problem)
{
    problem->hardness = b->box.high;
    problem->hardness_map = highs;
}

void
rc_bounds_keep_load(struct rc_bounds *b, double sum)
{
    double apart = b->box.highs != NULL ? b->unit : b->highest - b->box.low;

    b->box.rest = rc_bounded(b) ? fmax(ldexp(apart, -42), 1e-14 * rc_above(b, sum)) : 0;
}

/* ---- the load that they can carry ---- */

enum rc_status
rc_bounds_carry(const struct rc_bounds *b, double load, double cell, size_t nodes,
                struct rc_err *err)
{
    double area = cell * (double)nodes;
    double most = b->box.highs != NULL ? b->full * cell : b->box.high * area;

    if (!(load > most * (1 + 4 * DBL_EPSILON)))
        return RC_OK;
    if (b->box.highs != NULL)
        return rc_err_set(err,
                          "load %.9g N is above the sum of the hardness map times the cell, "
                          "%.9g Pa x %.9g m2 = %.9g N, where every node yields: no solution "
                          "exists; lower the load or raise the hardness",
                          load, b->full, cell, most);
    return rc_err_set(err,
                      "load %.9g N is above hardness times area, %.9g Pa x %.9g m2 = "
                      "%.9g N, where every node yields: no solution exists; lower the "
                      "load or raise the hardness",
                      load, b->box.high, area, most);
}
