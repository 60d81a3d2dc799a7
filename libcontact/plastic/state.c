/*
 * The state of a body that yields as a list of numbers, from which another like it goes on: figures, the
 * pressure of the contact, and the voxels one after another, of which less is told where less is needed:
 *
 *     a load is reached          place, e, equivalent strain, what the order of the integration adds to e
 *     between two increments     and the last increment, which is where the next begins
 *     within one                 and what is tried, with what the trial before it did
 *
 * What follows from these is found anew. All numbers are finite, in single precision too.
 */
#include "plastic.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { /* figures, in order */
    FORM,
    NX,
    NY,
    SLABS,
    INCREMENTS,
    COLUMNS,
    VOXELS,
    STAGE,
    COUNT, /* increments of this load */
    START,
    LOW,
    HIGH,
    TAKEN,
    TOL,
    KEPT,
    ELASTIC,
    FEW,
    ONCE, /* 1: once; 2: thorough */
    INCREMENT,
    TRIAL,
    FROM,
    TO,
    SET,
    RESISTANCE, /* 0: none has been met */
    ALONE,
    STOPPED,
    PRESSED,
    LOAD, /* of the pressure */
    APPLICATIONS,
    LAG,
    INCREMENT_ERROR, /* -1: unknown */
    INHERITED_ERROR, /* the same */
    ITERATION_ERROR,
    FIGURES
};
static const double form = 4; /* of this list */

enum {                        /* numbers of a voxel behind its place */
    STRAIN = RC_DEVIATOR + 1, /* the place of the equivalent strain */
    REACHED = 2 * RC_DEVIATOR + 1,
    BETWEEN = REACHED + 2 * RC_DEVIATOR + 1,
    WITHIN = BETWEEN + 3 * RC_DEVIATOR
};

static size_t
columns_of(const struct rc_plastic *p)
{
    if (p->stage <= RC_PLASTIC_PROBE || p->stage >= RC_PLASTIC_AGAIN)
        return REACHED;
    return p->trial == 0 ? BETWEEN : WITHIN;
}

/* ---- a voxel ---- */

/* Its numbers one by one, in double or single precision; the same for both directions. */
struct part {
    double *wide;
    float *narrow;
    size_t n;
};

enum {
    PARTS = 9
};

static void
parts_of(struct rc_voxel *v, struct part part[PARTS])
{
    const struct part all[PARTS] = {
        {v->e, NULL, RC_DEVIATOR},    {&v->strain, NULL, 1},         {NULL, v->before, RC_DEVIATOR},
        {v->last, NULL, RC_DEVIATOR}, {&v->grown, NULL, 1},          {NULL, v->missed, RC_DEVIATOR},
        {v->x, NULL, RC_DEVIATOR},    {NULL, v->moved, RC_DEVIATOR}, {NULL, v->left, RC_DEVIATOR}};

    memcpy(part, all, sizeof all);
}

static void
give(const struct rc_voxel *voxel, size_t columns, double *to)
{
    struct rc_voxel v = *voxel;
    struct part part[PARTS];

    for (size_t a = 0; a < RC_DEVIATOR && columns == REACHED; a++)
        v.before[a] += v.missed[a];
    parts_of(&v, part);
    for (size_t k = 0, done = 0; done < columns; done += part[k++].n)
        for (size_t a = 0; a < part[k].n; a++)
            to[done + a] = part[k].wide != NULL ? part[k].wide[a] : (double)part[k].narrow[a];
}

static void
take(struct rc_voxel *v, size_t columns, const double *from)
{
    struct part part[PARTS];

    parts_of(v, part);
    for (size_t k = 0, done = 0; done < columns; done += part[k++].n)
        for (size_t a = 0; a < part[k].n; a++)
            if (part[k].wide != NULL)
                part[k].wide[a] = from[done + a];
            else
                part[k].narrow[a] = (float)from[done + a];
}

/* ---- the state ---- */

size_t
rc_plastic_state_size(const struct rc_plastic *p)
{
    return FIGURES + p->n + rc_voxels_count(&p->voxels) * (1 + columns_of(p));
}

void
rc_plastic_state(const struct rc_plastic *p, double *state)
{
    const struct rc_plastic_figures *f = &p->figures;
    size_t columns = columns_of(p);
    const double figures[FIGURES] = {
        [FORM] = form,
        [NX] = (double)p->shape.nx,
        [NY] = (double)p->shape.ny,
        [SLABS] = (double)p->voxels.slabs,
        [INCREMENTS] = (double)p->increments,
        [COLUMNS] = (double)columns,
        [VOXELS] = (double)rc_voxels_count(&p->voxels),
        [STAGE] = p->stage,
        [COUNT] = (double)p->count,
        [START] = p->start,
        [LOW] = p->low,
        [HIGH] = p->high,
        [TAKEN] = (double)p->taken,
        [TOL] = p->tol,
        [KEPT] = p->kept,
        [ELASTIC] = p->elastic,
        [FEW] = p->few,
        [ONCE] = p->once + 2 * p->thorough,
        [INCREMENT] = (double)p->increment,
        [TRIAL] = (double)p->trial,
        [FROM] = p->from,
        [TO] = p->to,
        [SET] = p->set,
        [RESISTANCE] = isinf(p->resistance) ? 0 : p->resistance,
        [ALONE] = p->alone,
        [STOPPED] = p->stopped,
        [PRESSED] = p->pressed,
        [LOAD] = rc_solver_load(p->solver),
        [APPLICATIONS] = (double)f->applications,
        [LAG] = f->lag,
        [INCREMENT_ERROR] = isnan(f->increment_error) ? -1 : f->increment_error,
        [INHERITED_ERROR] = isnan(f->inherited_error) ? -1 : f->inherited_error,
        [ITERATION_ERROR] = f->iteration_error};

    memcpy(state, figures, sizeof figures);
    state += FIGURES;
    memcpy(state, rc_solver_pressure(p->solver), p->n * sizeof *state);
    state += p->n;
    for (size_t r = 0; r < p->voxels.slabs * p->voxels.rows; r++)
        for (size_t k = 0; k < p->voxels.row[r].n; k++) {
            const struct rc_voxel *v = &p->voxels.row[r].v[k];
            *state++ = (double)(r * p->shape.nx + v->i);
            give(v, columns, state);
            state += columns;
        }
}

/* ---- and back ---- */

static bool
whole_below(double v, double limit)
{
    return v >= 0 && v < limit && v == floor(v);
}

/* Whether the figures are those of a body like this one, and the rest as long as they say. */
static enum rc_status
check_figures(const struct rc_plastic *p, const double *s, size_t n, struct rc_err *err)
{
    if (n < FIGURES + p->n || s[FORM] != form)
        return rc_err_set(err, "no state of a body that yields, or one of another version");
    if (s[NX] != (double)p->shape.nx || s[NY] != (double)p->shape.ny ||
        s[SLABS] != (double)p->voxels.slabs)
        return rc_err_set(err,
                          "the state is that of %g x %g nodes with %g slabs, not of %zu x %zu with "
                          "%zu",
                          s[NX], s[NY], s[SLABS], p->shape.nx, p->shape.ny, p->voxels.slabs);
    if ((s[COLUMNS] != REACHED && s[COLUMNS] != BETWEEN && s[COLUMNS] != WITHIN) ||
        !whole_below(s[VOXELS], (double)n) ||
        s[VOXELS] * (1 + s[COLUMNS]) != (double)(n - FIGURES - p->n) ||
        !whole_below(s[STAGE], RC_PLASTIC_DONE + 1) || !whole_below(s[INCREMENTS] - 1, 1e9) ||
        !whole_below(s[COUNT], s[INCREMENTS] + 1) ||
        !whole_below(s[INCREMENT], s[INCREMENTS] + 2) || !whole_below(s[TAKEN], 1e15) ||
        !(s[START] >= 0) || !(s[LOW] >= 0) || !(s[HIGH] >= s[LOW]) || !(s[TOL] > 0) ||
        !(s[KEPT] >= 0) || !whole_below(s[TRIAL], 1e9) || !whole_below(s[APPLICATIONS], 1e15) ||
        !(s[FROM] >= 0) || !(s[TO] >= 0) || !(s[SET] >= 0) || !(s[RESISTANCE] >= 0) ||
        !(s[LOAD] > 0) || !(s[LAG] >= 0) || !(s[ITERATION_ERROR] >= 0))
        return rc_err_set(err, "the state is damaged: its figures do not go together");
    return RC_OK;
}

static enum rc_status
check(const struct rc_plastic *p, const double *s, size_t n, struct rc_err *err)
{
    double last = -1, places = (double)p->voxels.slabs * (double)p->n;
    size_t step;

    for (size_t k = 0; k < n; k++)
        if (!(fabs(s[k]) <= (double)FLT_MAX))
            return rc_err_set(err, "the state is damaged: number %zu of it is not finite", k);
    if (check_figures(p, s, n, err) != RC_OK)
        return RC_FAIL;
    step = 1 + (size_t)s[COLUMNS];
    for (size_t k = FIGURES + p->n; k < n; k += step) {
        if (!whole_below(s[k], places) || !(s[k] > last) || !(s[k + STRAIN] >= 0))
            return rc_err_set(err, "the state is damaged at voxel %zu",
                              (k - FIGURES - p->n) / step);
        last = s[k];
    }
    return RC_OK;
}

/* The voxels, which stand row by row. */
static enum rc_status
take_voxels(struct rc_plastic *p, size_t columns, size_t n, const double *at)
{
    size_t nx = p->shape.nx, step = 1 + columns;
    uint32_t *place = malloc(nx * sizeof *place);
    enum rc_status status = place == NULL ? RC_FAIL : RC_OK;

    rc_voxels_clear(&p->voxels);
    while (n > 0 && status == RC_OK) {
        size_t r = (size_t)at[0] / nx, count = 0;
        struct rc_voxel_row *row = &p->voxels.row[r];

        for (; count < n && (size_t)at[count * step] / nx == r; count++)
            place[count] = (uint32_t)((size_t)at[count * step] % nx);
        status = rc_voxels_add(row, count, place);
        for (size_t k = 0; k < count && status == RC_OK; k++) {
            take(&row->v[k], columns, at + k * step + 1);
            if (columns < WITHIN)
                memcpy(row->v[k].x, row->v[k].last, sizeof row->v[k].x);
        }
        n -= count;
        at += count * step;
    }
    free(place);
    return status;
}

static void
take_figures(struct rc_plastic *p, const double *s)
{
    enum rc_plastic_stage stage = (enum rc_plastic_stage)s[STAGE];

    p->stage = stage == RC_PLASTIC_DONE ? RC_PLASTIC_AGAIN : stage;
    p->increments = (size_t)s[INCREMENTS];
    p->count = (size_t)s[COUNT];
    p->start = s[START];
    p->taken = (size_t)s[TAKEN];
    p->kept = s[KEPT];
    p->elastic = s[ELASTIC] != 0;
    p->few = s[FEW] != 0;
    p->once = s[ONCE] == 1;
    p->thorough = s[ONCE] >= 2;
    p->low = s[LOW];
    p->high = s[HIGH];
    p->increment = (size_t)s[INCREMENT];
    p->trial = (size_t)s[TRIAL];
    p->from = s[FROM];
    p->to = s[TO];
    p->set = s[SET];
    p->order = stage != RC_PLASTIC_PROBE && p->increment > 1 ? RC_PLASTIC_BETA : 0;
    p->resistance = s[RESISTANCE] > 0 ? s[RESISTANCE] : INFINITY;
    p->alone = s[ALONE] != 0;
    p->stopped = s[STOPPED] != 0;
    p->pressed = s[PRESSED] != 0;
    p->figures = (struct rc_plastic_figures){
        .increments = p->count,
        .applications = (size_t)s[APPLICATIONS],
        .lag = s[LAG],
        .increment_error = s[INCREMENT_ERROR] < 0 ? NAN : s[INCREMENT_ERROR],
        .inherited_error = s[INHERITED_ERROR] < 0 ? NAN : s[INHERITED_ERROR],
        .iteration_error = s[ITERATION_ERROR]};
}

enum rc_status
rc_plastic_restore(struct rc_plastic *p, const double *state, size_t n, struct rc_err *err)
{
    if (check(p, state, n, err) != RC_OK)
        return RC_FAIL;
    if (take_voxels(p, (size_t)state[COLUMNS], (size_t)state[VOXELS], state + FIGURES + p->n) !=
        RC_OK)
        return rc_err_set(err, "out of memory for the strain of %g voxels", state[VOXELS]);
    take_figures(p, state);
    p->moved = true; /* what strain does to the surface is found anew */
    rc_plastic_solve_to(p, state[TOL]);
    if (rc_solver_set_load(p->solver, state[LOAD], 0, err) != RC_OK ||
        (p->pressed && rc_solver_warm_start(p->solver, state[LOAD], state + FIGURES, err) != RC_OK))
        return RC_FAIL;
    rc_plastic_keep_pressure(p);
    return RC_OK;
}
