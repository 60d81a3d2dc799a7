/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The state of a body that yields: figures, the pressure of the contact, and the voxels row by row. The
 * numbers of a voxel depend on what the next step needs:
 *
 *     a load is reached        place, e, equivalent strain, the terms of second order in e
 *     between two increments,  also the last increment, from which the next one starts
 *     or two positions
 *     within an increment      also the trial, and the changes by the previous trial
 *
 * All other values are computed again. All numbers are finite, also in single precision.
 */
#include "yield.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { /* numbers of a voxel after its place */
    REACHED = 2 * RC_DEVIATOR + 1,
    BETWEEN = REACHED + 2 * RC_DEVIATOR + 1,
    WITHIN = BETWEEN + 3 * RC_DEVIATOR
};

static size_t
columns_of(const struct rc_yield_solver *p)
{
    const bool rests = p->stage <= RC_YIELD_PROBE || p->stage >= RC_YIELD_AGAIN;

    if (rests && !p->asked.travels)
        return REACHED;
    return rests || p->run.trial == 0 ? BETWEEN : WITHIN;
}

/* ---- voxels ---- */

static void
exchange_voxel(struct rc_state *s, size_t columns, struct rc_voxel *voxel)
{
    struct rc_voxel v = *voxel;
    const struct {
        double *wide;
        float *narrow;
        size_t n;
    } part[] = {
        {v.e, NULL, RC_DEVIATOR},    {&v.strain, NULL, 1},         {NULL, v.before, RC_DEVIATOR},
        {v.last, NULL, RC_DEVIATOR}, {&v.grown, NULL, 1},          {NULL, v.missed, RC_DEVIATOR},
        {v.x, NULL, RC_DEVIATOR},    {NULL, v.moved, RC_DEVIATOR}, {NULL, v.left, RC_DEVIATOR}};
    double numbers[WITHIN];

    for (size_t a = 0; a < RC_DEVIATOR && columns == REACHED && !rc_state_reads(s); a++)
        v.before[a] += v.missed[a];
    for (size_t k = 0, at = 0; at < columns; at += part[k++].n)
        for (size_t a = 0; a < part[k].n; a++)
            numbers[at + a] = part[k].wide != NULL ? part[k].wide[a] : (double)part[k].narrow[a];
    rc_state_finite(s, columns, numbers);
    if (!rc_state_reads(s))
        return;
    for (size_t k = 0, at = 0; at < columns; at += part[k++].n)
        for (size_t a = 0; a < part[k].n; a++)
            if (part[k].wide != NULL)
                part[k].wide[a] = numbers[at + a];
            else
                part[k].narrow[a] = (float)numbers[at + a];
    if (columns < WITHIN)
        memcpy(v.x, v.last, sizeof v.x);
    if (!(v.strain >= 0))
        rc_state_refuse(s, "an equivalent strain is negative");
    *voxel = v;
}

static void
exchange_row(struct rc_state *s, size_t columns, size_t nx, struct rc_voxel_row *row)
{
    size_t n = row->n;

    rc_state_count(s, &n, nx);
    if (rc_state_reads(s) && n > 0 && (row->v = calloc(n, sizeof *row->v)) == NULL)
        rc_state_refuse(s, "memory is short");
    else if (rc_state_reads(s))
        row->n = n;
    for (size_t k = 0; k < row->n; k++) {
        size_t i = row->v[k].i;
        rc_state_count(s, &i, nx - 1);
        if (rc_state_reads(s) && k > 0 && i <= row->v[k - 1].i)
            rc_state_refuse(s, "its voxels are not in order");
        row->v[k].i = (uint32_t)i;
        exchange_voxel(s, columns, &row->v[k]);
    }
}

/* What rc_state_parts exchanges. */
struct part {
    struct rc_yield_solver *plastic;
    size_t columns;
};

/* Exchanges the voxels of n rows of the map, slab by slab. */
static void
exchange_rows(void *of, struct rc_state *s, size_t first, size_t n)
{
    const struct part *part = of;
    struct rc_yield_solver *p = part->plastic;

    for (size_t slab = 0; slab < p->voxels.slabs; slab++) {
        const size_t level = rc_slabs_level(p->slabs, slab);
        for (size_t j = first >> level; j << level < first + n; j++)
            exchange_row(s, part->columns, p->shape.nx >> level,
                         rc_voxels_row(&p->voxels, slab, j));
    }
}

/* ---- figures ---- */

/* Exchanges a number of at least 0, or one that is not finite, for which `mark` is written. */
static void
number_or(struct rc_state *s, double *v, double mark, double unknown)
{
    double stored = isfinite(*v) ? *v : mark;

    rc_state_number(s, &stored, fmin(mark, 0));
    if (rc_state_reads(s))
        *v = stored > mark ? stored : unknown;
}

static void
exchange_figures(struct rc_yield_solver *p, struct rc_state *s)
{
    struct rc_yield_load *f = &p->figures;

    if (rc_state_reads(s))
        *f = (struct rc_yield_load){0};
    RC_STATE_COUNTS(s, &p->asked.increments);
    rc_state_count(s, &p->run.count, p->asked.increments);
    rc_state_count(s, &p->run.increment, p->asked.increments + 1);
    RC_STATE_COUNTS(s, &p->run.trial, &p->run.taken, &f->applications);
    RC_STATE_FLAGS(s, &p->is.elastic, &p->errors.few, &p->asked.once, &p->asked.thorough,
                   &p->asked.follows, &p->is.alone, &p->is.stopped, &p->is.pressed,
                   &p->asked.yields);
    RC_STATE_SIZES(s, &p->way.start, &p->way.low, &p->errors.kept, &p->way.from, &p->way.to,
                   &p->way.set, &p->errors.worst, &f->lag, &f->iteration_error);
    rc_state_number(s, &p->way.high, p->way.low);
    rc_state_number(s, &p->run.tol, DBL_MIN);
    number_or(s, &p->run.resistance, 0, INFINITY);
    number_or(s, &f->increment_error, -1, NAN);
    number_or(s, &f->inherited_error, -1, NAN);
    number_or(s, &f->slab_error, -1, NAN);
}

/* ---- the state ---- */

/* Computes what follows from the numbers that were read. */
static void
resume(struct rc_yield_solver *p, struct rc_state *s, enum rc_yield_solver_stage stage, double load)
{
    struct rc_err err;

    p->stage = stage == RC_YIELD_DONE ? RC_YIELD_AGAIN : stage;
    p->run.order =
        stage != RC_YIELD_PROBE && (p->run.increment > 1 || p->asked.follows) ? RC_YIELD_BETA : 0;
    for (size_t r = 0; r < p->voxels.slabs * p->voxels.rows && stage == RC_YIELD_DONE; r++)
        for (size_t k = 0; k < p->voxels.row[r].n; k++)
            memset(p->voxels.row[r].v[k].x, 0, sizeof p->voxels.row[r].v[k].x);
    p->figures.increments = p->run.count;
    p->is.moved = true; /* the displacement due to the strain is computed again */
    rc_yield_solver_solve_to(p, p->run.tol);
    if (rc_solver_set_load(p->solver, load, 0, &err) != RC_OK ||
        (p->is.pressed && rc_solver_warm_start(p->solver, load, p->maps.other, &err) != RC_OK))
        rc_state_refuse(s, "its load or its pressure is not finite or negative");
    else
        rc_yield_solver_keep_pressure(p);
}

void
rc_yield_solver_exchange(void *plastic, struct rc_state *s)
{
    struct rc_yield_solver *p = plastic;
    struct part part = {p, columns_of(p)};
    size_t stage = p->stage, *columns = &part.columns;
    double load = rc_solver_load(p->solver);

    rc_state_count(s, &stage, RC_YIELD_DONE);
    rc_state_count(s, columns, WITHIN);
    if (*columns != REACHED && *columns != BETWEEN && *columns != WITHIN)
        rc_state_refuse(s, "a size is out of range");
    rc_state_number(s, &load, DBL_MIN);
    exchange_figures(p, s);
    /* the cast is safe: writing does not change the pressure */
    rc_state_map(s, p->n,
                 rc_state_reads(s) ? p->maps.other : (double *)rc_solver_pressure(p->solver));
    if (rc_state_reads(s))
        rc_voxels_clear(&p->voxels);
    rc_state_parts(s, &p->rows, p->shape.nx, exchange_rows, &part);
    if (rc_state_reads(s))
        resume(p, s, (enum rc_yield_solver_stage)stage, load);
}
