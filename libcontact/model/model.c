/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The verbs of all models, and the axes of their histories.
 */
#include "row.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- axes and points ---- */

static const struct rc_axis_info axes[RC_AXES] = {
    [RC_LOAD] = {"load", "N", "Load", false, RC_APPROACH},
    [RC_APPROACH] = {"approach", "m", "Approach", false, RC_LOAD},
    [RC_TANGENTIAL_X] = {"tangential_x", "N", "Force along x", false, RC_DISPLACEMENT_X},
    [RC_TANGENTIAL_Y] = {"tangential_y", "N", "Force along y", false, RC_DISPLACEMENT_Y},
    [RC_DISPLACEMENT_X] = {"displacement_x", "m", "Displacement along x", false, RC_TANGENTIAL_X},
    [RC_DISPLACEMENT_Y] = {"displacement_y", "m", "Displacement along y", false, RC_TANGENTIAL_Y},
    [RC_CREEP_X] = {"creep_x", NULL, "Creepage along x", false, RC_CREEP_X},
    [RC_CREEP_Y] = {"creep_y", NULL, "Creepage along y", false, RC_CREEP_Y},
    [RC_SPIN] = {"spin", "rad/m", "Spin", false, RC_SPIN},
    [RC_TIME] = {"time", "s", "Time", true, RC_TIME},
    [RC_DISTANCE] = {"distance", "m", "Sliding distance", true, RC_DISTANCE},
    [RC_POSITION] = {"position", "m", "Position", false, RC_POSITION},
    [RC_SPEED] = {"speed", "m/s", "Sliding speed", false, RC_SPEED},
};

const struct rc_axis_info *
rc_axis_info(size_t k)
{
    return k < RC_AXES ? &axes[k] : NULL;
}

void
rc_point_set(struct rc_point *p, enum rc_axis axis, double value)
{
    const enum rc_axis partner = axes[axis].partner;

    p->given |= 1u << axis;
    if (partner != axis)
        p->given &= ~(1u << partner);
    p->at[axis] = value;
}

bool
rc_point_has(const struct rc_point *p, enum rc_axis axis)
{
    return p->given >> axis & 1;
}

struct rc_point
rc_point_between(const struct rc_point *from, const struct rc_point *to, double part)
{
    struct rc_point p = *to;

    for (enum rc_axis k = 0; k < RC_AXES && part < 1; k++)
        p.at[k] = from->at[k] + part * (to->at[k] - from->at[k]);
    return p;
}

static unsigned
taken(const struct rc_model *m)
{
    return m == NULL ? 0 : m->row->takes | taken(m->inner);
}

struct rc_point
rc_point_for(const struct rc_model *m, const struct rc_point *point)
{
    struct rc_point p = *point;

    p.given &= taken(m);
    return p;
}

/* Sets the next point: the given axes of `to`, and the last values of the others. Checks each value. */
static enum rc_status
aim(const struct rc_model *m, const struct rc_point *to, struct rc_point *next, struct rc_err *err)
{
    *next = m->from;
    for (enum rc_axis k = 0; k < RC_AXES; k++) {
        const struct rc_axis_info *a = &axes[k];
        const double v = to->at[k];
        if (!rc_point_has(to, k))
            continue;
        if (!(taken(m) >> k & 1))
            return rc_err_set(err, "a point gives the %s, which the %s model does not have",
                              a->name, m->row->name);
        if (isnan(v) || (isinf(v) && !(k == RC_APPROACH && v < 0)))
            return rc_err_set(err, "%s %g: it must be a finite number", a->name, v);
        if (a->rises && rc_point_has(&m->from, k) && v < m->from.at[k])
            return rc_err_set(err, "%s %g %s: it must be at least that of the previous point, %g",
                              a->name, v, a->unit, m->from.at[k]);
        rc_point_set(next, k, v);
    }
    for (enum rc_axis k = 0; k < RC_AXES; k++)
        if (m->row->needs >> k & 1 && !rc_point_has(next, k) &&
            !rc_point_has(next, axes[k].partner))
            return rc_err_set(err, "a point of the %s model needs the %s", m->row->name,
                              axes[k].name);
    return RC_OK;
}

/* ---- verbs ---- */

enum rc_status
rc_model_go(struct rc_model *m, const struct rc_point *to, struct rc_err *err)
{
    struct rc_point next;

    m->looked = false;
    if (aim(m, to, &next, err) != RC_OK)
        return m->status = RC_FAIL;
    if ((m->moved ? rc_model_recall(m, err) : rc_model_remember(m, err)) != RC_OK)
        return m->status = RC_FAIL;
    m->to = next;
    m->moved = true;
    return m->status = m->row->go(m, err) == RC_OK ? RC_MORE : RC_FAIL;
}

enum rc_status
rc_model_step(struct rc_model *m, struct rc_err *err)
{
    if (m->status == RC_FAIL)
        return rc_err_set(err,
                          "the %s model has no next point, because its last rc_model_go failed",
                          m->row->name);
    if (m->status != RC_MORE)
        return m->status;
    m->looked = false;
    m->status = m->row->step(m, err);
    m->looked = m->looked && m->status != RC_FAIL;
    return m->status;
}

enum rc_status
rc_model_run(struct rc_model *m, const struct rc_point *to, struct rc_err *err)
{
    enum rc_status s = rc_model_go(m, to, err);

    while (s == RC_MORE)
        s = rc_model_step(m, err);
    return s;
}

/* Outer models overwrite found axes of inner ones, because their heights differ. */
enum rc_status
rc_model_look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct rc_point own = m->to;

    for (enum rc_axis k = 0; k < RC_AXES && at != NULL; k++)
        at->at[k] = NAN;
    if (at != NULL)
        at->given = 0;
    if (m->status == RC_FAIL)
        return rc_err_set(err,
                          "the %s model has no figures, because its last rc_model_go or "
                          "rc_model_step failed",
                          m->row->name);
    if (m->inner != NULL) {
        if (rc_model_look(m->inner, &own, err) != RC_OK)
            return RC_FAIL;
        for (enum rc_axis k = 0; k < RC_AXES; k++)
            if (rc_point_has(&m->to, k))
                own.at[k] = m->to.at[k];
        own.given = m->to.given;
    }
    if (m->row->look(m, &own, err) != RC_OK)
        return RC_FAIL;
    m->looked = true;
    if (at != NULL)
        *at = own;
    return RC_OK;
}

enum rc_status
rc_model_keep(struct rc_model *m, struct rc_err *err)
{
    struct rc_point at;

    if (m->status != RC_OK && m->status != RC_SHORT)
        return rc_err_set(err,
                          "the point is not reached yet: call rc_model_step before rc_model_keep");
    if (!m->moved)
        return RC_OK;
    if (rc_model_look(m, &at, err) != RC_OK ||
        (m->row->keep != NULL && m->row->keep(m, err) != RC_OK))
        return RC_FAIL;
    m->from = m->to;
    m->moved = false;
    /* the next point may give an axis that the model has found here */
    for (enum rc_axis k = 0; k < RC_AXES; k++)
        if (isfinite(at.at[k]) && !(rc_point_has(&m->to, k) && isfinite(m->to.at[k])))
            m->from.at[k] = at.at[k];
    return RC_OK;
}

enum rc_status
rc_model_set_heights(struct rc_model *m, const double *h, struct rc_err *err)
{
    return m->row->heights != NULL
               ? m->row->heights(m, h, err)
               : rc_err_set(err, "the heights of the %s model cannot change", m->row->name);
}

enum rc_status
rc_model_set_compliance(struct rc_model *m, double c, const double *part, double along,
                        struct rc_err *err)
{
    if (!(c >= 0) || isinf(c))
        return rc_err_set(err, "compliance %g m/Pa: it must be at least 0 and finite", c);
    if (!(along >= 0) || isinf(along))
        return rc_err_set(err, "compliance of rows %g 1/Pa: it must be at least 0 and finite",
                          along);
    return m->row->compliance != NULL
               ? m->row->compliance(m, c, part, along, err)
               : rc_err_set(err, "the %s model has no compliance of its nodes", m->row->name);
}

bool
rc_model_takes_heights(const struct rc_model *m)
{
    return m->row->heights != NULL;
}

bool
rc_model_takes_start(const struct rc_model *m)
{
    return m->row->start != NULL;
}

enum rc_status
rc_model_start(struct rc_model *m, double load, const double *p, struct rc_err *err)
{
    return m->row->start != NULL ? m->row->start(m, load, p, err) : RC_OK;
}

void
rc_model_set_accuracy(struct rc_model *m, double part)
{
    m->row->accuracy(m, part);
}

const struct rc_model *
rc_model_find(const struct rc_model *m, const struct rc_model_row *row)
{
    while (m != NULL && m->row != row)
        m = m->inner;
    return m;
}

struct rc_solver *
rc_model_solver(const struct rc_model *m)
{
    for (; m != NULL; m = m->inner)
        if (m->row->solver != NULL)
            return m->row->solver(m);
    return NULL;
}

enum rc_status
rc_model_respond(struct rc_model *m, const double *e, double *z, struct rc_err *err)
{
    if (m->row->respond != NULL)
        return m->row->respond(m, e, z, err);
    memset(z, 0, rc_model_nodes(m) * sizeof *z);
    return RC_OK;
}

struct rc_shape
rc_model_shape(const struct rc_model *m)
{
    return m->shape;
}

const char *
rc_model_name(const struct rc_model *m)
{
    return m->row->name;
}

/* ---- figures and frames of a chain of models, inner models first ---- */

/* True if an outer model has a figure of this name, which then hides this one. */
static bool
is_outer(const struct rc_model *outer, const struct rc_model *m, const char *name)
{
    for (; outer != m; outer = outer->inner)
        for (const struct rc_figure_set *s = outer->row->figures; s->table != NULL; s++)
            for (const struct rc_figure *f = s->table; f->name != NULL; f++)
                if (strcmp(f->name, name) == 0)
                    return true;
    return false;
}

static const struct rc_figure *
figure_at(const struct rc_model *top, const struct rc_model *m, size_t *k, const void **data)
{
    const struct rc_figure *f = m->inner == NULL ? NULL : figure_at(top, m->inner, k, data);

    for (const struct rc_figure_set *s = m->row->figures; f == NULL && s->table != NULL; s++) {
        *data = top->looked ? (const char *)m + s->at : NULL;
        for (const struct rc_figure *at = s->table; f == NULL && at->name != NULL; at++)
            if (!is_outer(top, m, at->name) && (*k)-- == 0)
                f = at;
    }
    return f;
}

const struct rc_figure *
rc_model_figure(const struct rc_model *m, size_t k, const void **data)
{
    return figure_at(m, m, &k, data);
}

double
rc_model_number(const struct rc_model *m, const char *name)
{
    const struct rc_figure *f;
    const void *data;

    for (size_t k = 0; (f = rc_model_figure(m, k, &data)) != NULL; k++)
        if (strcmp(f->name, name) == 0)
            return rc_figure_number(f, data);
    return NAN;
}

const struct rc_frame_kind *
rc_model_frame_kind(const struct rc_model *m, size_t k)
{
    for (; m != NULL; m = m->inner)
        for (const struct rc_frame_kind *f = m->row->frame; f->name != NULL; f++)
            if (k-- == 0)
                return f;
    return NULL;
}

static const char *
frame_name(const void *of, size_t k)
{
    const struct rc_frame_kind *f = rc_model_frame_kind(of, k);

    return f == NULL ? NULL : f->name;
}

enum rc_status
rc_model_frame(struct rc_model *m, const char *name, double *to, struct rc_err *err)
{
    for (struct rc_model *at = m; at != NULL; at = at->inner)
        for (size_t k = 0; at->row->frame[k].name != NULL; k++)
            if (strcmp(at->row->frame[k].name, name) == 0)
                return m->looked ? at->row->fill(at, k, to, err)
                                 : rc_err_set(err, "call rc_model_look before reading a frame");
    rc_err_set(err, "the %s model has no frame '%s'", m->row->name, name);
    return rc_err_choices(err, frame_name, m);
}

/* ---- before and during an iteration ---- */

enum rc_status
rc_model_plan(const struct rc_model *m, const struct rc_point *most, struct rc_expected *expected,
              struct rc_err *err)
{
    struct rc_point next;

    if (aim(m, most, &next, err) != RC_OK)
        return RC_FAIL;
    if (m->row->plan != NULL)
        return m->row->plan(m, &next, expected, err);
    next = rc_point_for(m->inner, &next);
    if (m->inner != NULL)
        return rc_model_plan(m->inner, &next, expected, err);
    *expected = (struct rc_expected){NAN, NAN, 0};
    return RC_OK;
}

void
rc_loops_add(struct rc_loops *s, const char *what, const char *unit, double at, double of)
{
    if (s->n < RC_LOOPS)
        s->loop[s->n++] = (struct rc_loop){what, unit, at, of};
}

void
rc_model_progress(const struct rc_model *m, struct rc_loops *s)
{
    *s = (struct rc_loops){.grid = m->shape, .error = NAN, .tol = NAN, .worth = true};
    for (; m != NULL; m = m->inner)
        if (m->row->progress != NULL)
            m->row->progress(m, s);
}

/* ---- making ---- */

const void *
rc_model_result(const struct rc_model *m, const struct rc_figure *table)
{
    for (; m != NULL; m = m->inner)
        for (const struct rc_figure_set *s = m->row->figures; s->table != NULL; s++)
            if (s->table == table)
                return (const char *)m + s->at;
    return NULL;
}

struct rc_model *
rc_model_make(const struct rc_model_row *row, size_t size, const struct rc_shape *shape,
              const struct rc_ranks *ranks, struct rc_err *err)
{
    struct rc_model *m = calloc(1, size);

    if (rc_ranks_need(ranks, m != NULL, err, "out of memory for the %s model", row->name) !=
        RC_OK) {
        free(m);
        return NULL;
    }
    m->row = row;
    m->shape = *shape;
    m->rows = rc_rows_of(ranks, shape);
    return m;
}

enum rc_status
rc_model_room(const struct rc_model *m, struct rc_err *err)
{
    return rc_ranks_need(m->rows.ranks, !m->own.failed, err,
                         "out of memory for the %s model of %zu x %zu nodes", m->row->name,
                         m->shape.nx, m->shape.ny);
}

struct rc_model *
rc_model_make_outer(const struct rc_model_row *row, size_t size, struct rc_model *inner,
                    struct rc_err *err)
{
    struct rc_model *m =
        inner == NULL ? NULL : rc_model_make(row, size, &inner->shape, inner->rows.ranks, err);

    if (m == NULL)
        rc_model_free(inner);
    else
        m->inner = inner;
    if (m != NULL) {
        m->boundary = inner->boundary;
        inner->inside = true;
    }
    return m;
}

enum rc_status
rc_model_same_boundary(const struct rc_model *m, struct rc_boundary boundary, struct rc_err *err)
{
    return rc_same_boundary(m->boundary, boundary)
               ? RC_OK
               : rc_err_set(err,
                            "the boundary of the %s model is %s, and that of its %s model %s: "
                            "give both the same",
                            m->row->name, rc_boundary_word(boundary), m->inner->row->name,
                            rc_boundary_word(m->boundary));
}

void
rc_model_free(struct rc_model *m)
{
    if (m == NULL)
        return;
    if (m->row->free != NULL)
        m->row->free(m);
    rc_model_free(m->inner);
    rc_store_free(&m->own);
    rc_state_forget(&m->kept);
    free(m);
}
