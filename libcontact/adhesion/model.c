/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The model of adhesion: rc_adhesion_solver along a history of loads or approaches; the approach -INFINITY is
 * a retraction to the pull-off load. Keeping a point adds its plastic dents to the shape.
 */
#include "adhesion.h"

#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "libcontact/model/row.h"

/* The state from which the bodies last moved apart: there a retraction begins that would otherwise begin
 * beyond the pull-off. Between this state and the last kept one the approach only falls. */
struct turn {
    bool here;     /* it is the last kept state */
    bool known;    /* else: `pressure` (Pa, net) and `approach` (m) are those of the state */
    bool passed;   /* the load has risen since, or the contact is lost */
    double lowest; /* N, of all loads since */
    double last;   /* m: the last kept approach; -INFINITY: none, or separated */
    double approach;
    double *pressure; /* NULL: there was none so far */
};

struct adhesion {
    struct rc_model base;
    struct rc_adhesion_problem problem;
    size_t n;     /* nodes of this rank */
    double *h;    /* m: present heights                                               */
    double *dent; /* m: present minus undeformed heights; NULL: no dents */
    struct rc_adhesion_solver
        *path;    /* NULL: no point so far                                            */
    bool started; /* the path was stepped on this grid: its pressure belongs to a state */
    bool pulls;   /* the point is a retraction                                        */
    bool again;   /* a state was read: the next step sets the point                   */
    bool returns; /* the state at the last kept point is being read                   */
    struct turn turn;
    bool turned;                    /* the retraction began at the turn */
    struct rc_adhesion_state spent; /* states and work of a retraction before it turned */
    struct rc_adhesion_figures figures;
};

static const struct rc_figure_set sets[] = {
    {rc_figures_contact, offsetof(struct adhesion, figures.contact)},
    {rc_figures_adhesion, offsetof(struct adhesion, figures.state)},
    {NULL, 0},
};

enum {
    TRACTION = RC_CONTACT_FRAMES,
    SHAPE
};
static const struct rc_frame_kind frames[] = {
    RC_CONTACT_FRAME_KINDS,
    [TRACTION] = {"adhesion", "Pa", "Attraction"},
    [SHAPE] = {"plastic", "m", "Height after yield"},
    {NULL, NULL, NULL},
};

/* ---- verbs ---- */

/* Gives the path the present heights. The errors of the dents stay. */
static enum rc_status
pass_heights(struct adhesion *a, struct rc_err *err)
{
    struct rc_adhesion_solver_past past;

    if (a->path == NULL)
        return RC_OK;
    past = *rc_adhesion_solver_past(a->path);
    if (rc_adhesion_solver_set_heights(a->path, a->h, a->dent, err) != RC_OK)
        return RC_FAIL;
    *rc_adhesion_solver_past(a->path) = past;
    return RC_OK;
}

static enum rc_status
make_path(struct adhesion *a, struct rc_err *err)
{
    if (a->path != NULL)
        return RC_OK;
    if ((a->path = rc_adhesion_solver_new(&a->base.shape, a->h, &a->problem, err)) == NULL)
        return RC_FAIL;
    return a->dent != NULL ? pass_heights(a, err) : RC_OK;
}

/* Stores the last kept state before the path leaves it, if the bodies may move apart from there. */
static enum rc_status
store_turn(struct adhesion *a, struct rc_err *err)
{
    struct turn *t = &a->turn;

    if (!t->here)
        return RC_OK;
    if (rc_ranks_need(a->base.rows.ranks, rc_store_need(&a->base.own, a->n, &t->pressure), err,
                      "out of memory for the state at which a retraction begins") != RC_OK)
        return RC_FAIL;
    rc_adhesion_solver_pressure(a->path, t->pressure);
    t->approach = t->last;
    t->known = true;
    t->here = false;
    return RC_OK;
}

/* Notes the state that is kept, if a retraction may follow. */
static void
note_turn(struct adhesion *a)
{
    const struct rc_adhesion_state *f = &a->figures.state;
    const bool touches = !f->separated && f->contact_nodes > 0;
    struct turn *t = &a->turn;

    if (!a->problem.pull_off || a->pulls)
        return;
    t->here = touches && f->approach > t->last;
    t->passed = !t->here && (t->passed || !touches || f->load > t->lowest);
    t->lowest = t->here ? f->load : fmin(t->lowest, f->load);
    t->last = f->separated ? -INFINITY : f->approach;
}

static bool
may_turn(const struct adhesion *a)
{
    return a->turn.known && !a->turn.here && !a->turned;
}

/* Begins a retraction at the last state, or at the turn. */
static enum rc_status
retract(struct adhesion *a, bool turns, struct rc_err *err)
{
    if (turns) {
        a->turned = true;
        if (rc_adhesion_solver_start(a->path, a->turn.pressure, a->turn.approach, err) != RC_OK)
            return RC_FAIL;
        rc_adhesion_solver_past(a->path)->separated = false;
    }
    return rc_adhesion_solver_pull_off(a->path, err);
}

static enum rc_status
set_point(struct adhesion *a, struct rc_err *err)
{
    const struct rc_point *to = &a->base.to;

    a->again = a->turned = false;
    a->spent = (struct rc_adhesion_state){0};
    if (make_path(a, err) != RC_OK)
        return RC_FAIL;
    a->pulls = rc_point_has(to, RC_APPROACH) && isinf(to->at[RC_APPROACH]);
    if (!a->pulls && store_turn(a, err) != RC_OK)
        return RC_FAIL;
    return a->pulls ? retract(a, may_turn(a) && a->turn.passed, err)
           : rc_point_has(to, RC_APPROACH)
               ? rc_adhesion_solver_set_approach(a->path, to->at[RC_APPROACH], err)
               : rc_adhesion_solver_set_load(a->path, to->at[RC_LOAD], err);
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct adhesion *a = (struct adhesion *)m;

    return set_point(a, err);
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct adhesion *a = (struct adhesion *)m;
    struct rc_adhesion_solver_progress at;
    enum rc_status status;

    if (a->again && set_point(a, err) != RC_OK)
        return RC_FAIL;
    status = rc_adhesion_solver_step(a->path, err);
    rc_adhesion_solver_progress(a->path, &at);
    a->started |= !at.coarser;
    if (!a->pulls || status == RC_MORE || status == RC_FAIL || !may_turn(a) ||
        !rc_adhesion_solver_result(a->path)->pull_off_at_start)
        return status;
    a->spent = *rc_adhesion_solver_result(a->path);
    return retract(a, true, err) == RC_OK ? RC_MORE : RC_FAIL;
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct adhesion *a = (struct adhesion *)m;
    struct rc_adhesion_state *f = &a->figures.state;

    if (a->path == NULL)
        return rc_err_set(err, "there are no figures before the first point");
    *f = *rc_adhesion_solver_result(a->path);
    f->states += a->spent.states;
    f->iterations += a->spent.iterations;
    f->eigen_steps += a->spent.eigen_steps;
    f->convolutions += a->spent.convolutions;
    f->pull_off_from = a->turned ? a->turn.approach : a->pulls ? a->turn.last : NAN;
    a->figures.contact = (struct rc_contact){.load = f->load,
                                             .mean_pressure = f->mean_pressure,
                                             .max_pressure = f->max_pressure,
                                             .contact_nodes = f->contact_nodes,
                                             .contact_area = f->contact_area,
                                             .contact_fraction = f->contact_fraction,
                                             .plastic_nodes = f->plastic_nodes,
                                             .plastic_area = f->plastic_area,
                                             .yielded_nodes = f->plastic_nodes,
                                             .yielded_area = f->plastic_area,
                                             .hardness_active = f->plastic_nodes > 0,
                                             .edge_load_fraction = NAN,
                                             .elastic_energy = NAN,
                                             .approach = f->approach,
                                             .mean_gap = f->mean_gap,
                                             .gap_error = f->gap_error,
                                             .shape_error = f->gap_error,
                                             .kkt_residual = f->kkt_residual,
                                             .pressure_error = f->pressure_error,
                                             .inherited_error = f->inherited_error,
                                             .iterations = f->iterations,
                                             .convolutions = f->convolutions,
                                             .discretization = {NAN, NAN, NAN},
                                             .converged = f->converged};
    at->at[RC_LOAD] = f->load;
    at->at[RC_APPROACH] = f->approach;
    return RC_OK;
}

static enum rc_status
keep(struct rc_model *m, struct rc_err *err)
{
    struct adhesion *a = (struct adhesion *)m;

    note_turn(a);
    a->pulls = false;
    if (a->figures.state.plastic_nodes == 0)
        return RC_OK;
    if (rc_ranks_need(a->base.rows.ranks, rc_store_need(&a->base.own, a->n, &a->dent), err,
                      "out of memory for the shape after yield") != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < a->n; k++)
        a->dent[k] -= a->h[k];
    rc_adhesion_solver_keep_shape(a->path, a->h);
    for (size_t k = 0; k < a->n; k++)
        a->dent[k] += a->h[k];
    return RC_OK;
}

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    struct adhesion *a = (struct adhesion *)m;

    (void)err;
    if (frame == RC_FRAME_PRESSURE)
        rc_adhesion_solver_pressure(a->path, to);
    else if (frame == RC_FRAME_DISPLACEMENT)
        rc_adhesion_solver_displacement(a->path, to);
    else if (frame == TRACTION)
        rc_adhesion_solver_traction(a->path, to);
    else
        rc_adhesion_solver_gap(a->path, to);
    for (size_t k = 0; k < a->n && frame == RC_FRAME_CONTACT; k++)
        to[k] = to[k] > 0 ? 0 : 1; /* the net pressure does not determine the contact */
    for (size_t k = 0; k < a->n && frame == SHAPE; k++)
        to[k] = a->h[k] + fmin(to[k], 0);
    return RC_OK;
}

/* Adds the dents to the new heights. */
static enum rc_status
set_heights(struct rc_model *m, const double *h, struct rc_err *err)
{
    struct adhesion *a = (struct adhesion *)m;

    for (size_t k = 0; k < a->n; k++)
        a->h[k] = h[k] + (a->dent != NULL ? a->dent[k] : 0);
    a->turn = (struct turn){.last = -INFINITY, .pressure = a->turn.pressure};
    return pass_heights(a, err);
}

/* ---- states ---- */

/* Replaces the dents of the shape by those of the state, if these differ. */
static void
read_dent(struct adhesion *a, struct rc_state *s, bool some)
{
    const double *now = some ? rc_state_read_map(s, a->n) : NULL;
    bool differ = false;
    struct rc_err err;

    if (!rc_store_need(&a->base.own, a->n, &a->dent))
        rc_state_refuse(s, "memory is short");
    if (!rc_state_agree(s, a->base.rows.ranks))
        return;
    for (size_t k = 0; k < a->n; k++) {
        const double dent = now != NULL ? now[k] : 0, more = dent - a->dent[k];
        differ |= more != 0;
        a->h[k] += more;
        a->dent[k] = dent;
    }
    if (rc_ranks_most(a->base.rows.ranks, differ) > 0 && pass_heights(a, &err) != RC_OK)
        rc_state_refuse(s, "its shape is not finite");
}

/* The path starts from this net pressure and approach. */
static void
read_path(struct adhesion *a, struct rc_state *s, double approach,
          const struct rc_adhesion_solver_past *past)
{
    const double *p = rc_state_read_map(s, a->n);
    struct rc_err err;

    if (!rc_state_agree(s, a->base.rows.ranks))
        return;
    if (make_path(a, &err) != RC_OK ||
        rc_adhesion_solver_start(a->path, p, approach, &err) != RC_OK)
        rc_state_refuse(s, err.text);
    else
        *rc_adhesion_solver_past(a->path) = *past;
}

/* The turn; its map is exchanged by the caller. */
static void
turn_state(struct turn *t, struct rc_state *s)
{
    RC_STATE_FLAGS(s, &t->here, &t->known, &t->passed);
    RC_STATE_NUMBERS(s, &t->approach);
    RC_STATE_OPEN(s, &t->lowest, &t->last);
}

static void
read_turn(struct adhesion *a, struct rc_state *s)
{
    const double *p = rc_state_read_map(s, a->n);

    if (!rc_store_need(&a->base.own, a->n, &a->turn.pressure))
        rc_state_refuse(s, "memory is short");
    if (rc_state_agree(s, a->base.rows.ranks))
        memcpy(a->turn.pressure, p, a->n * sizeof *p);
}

/* Reads the state at the last kept point, from which a retraction or a separation is repeated. */
static void
read_start(struct adhesion *a, struct rc_state *s)
{
    struct rc_err err = {"the state at its start is missing"};

    if (a->returns) {
        rc_state_refuse(s, err.text);
        return;
    }
    a->returns = true;
    if (rc_model_recall(&a->base, &err) != RC_OK)
        rc_state_refuse(s, err.text);
    a->returns = false;
}

/* True on the way to a later point: the iteration may be beyond barriers of the energy. */
static bool
goes_on(struct adhesion *a)
{
    return a->base.status == RC_MORE && rc_adhesion_solver_past(a->path)->begun;
}

/* A state holds the dents, the approach and the net pressure, and those of the turn. On the way to a later
 * point, and if the bodies have separated, it holds the state at the last kept point. */
static void
state(struct rc_model *m, struct rc_state *s)
{
    struct adhesion *a = (struct adhesion *)m;
    struct rc_adhesion_solver_past past = {{0, 0}, false, false};
    bool started = a->started, dented = a->dent != NULL,
         anew = m->moved && started &&
                (a->pulls || goes_on(a) || rc_adhesion_solver_result(a->path)->separated);
    double approach = started ? rc_adhesion_solver_approach(a->path) : 0, *to;

    if (started)
        past = *rc_adhesion_solver_past(a->path);
    RC_STATE_FLAGS(s, &anew);
    if (rc_state_refused(s))
        return;
    if (rc_state_reads(s) && m->moved && m->status != RC_FAIL)
        m->status = RC_MORE; /* the next step decides whether it is the solution */
    if (anew) {
        if (rc_state_reads(s))
            read_start(a, s);
        return;
    }
    RC_STATE_FLAGS(s, &started, &past.begun, &past.separated, &dented);
    RC_STATE_NUMBERS(s, &approach, &past.dents[0], &past.dents[1]);
    turn_state(&a->turn, s);
    if (rc_state_refused(s))
        return;
    if (!rc_state_reads(s)) {
        if (dented)
            rc_state_map(s, a->n, a->dent);
        if (started && (to = rc_state_map(s, a->n, NULL)) != NULL)
            rc_adhesion_solver_pressure(a->path, to);
        if (a->turn.known)
            rc_state_map(s, a->n, a->turn.pressure);
        return;
    }
    a->pulls = false;
    if (dented || a->dent != NULL)
        read_dent(a, s, dented);
    if (started) {
        read_path(a, s, approach, &past);
    } else {
        rc_adhesion_solver_free(a->path);
        a->path = NULL;
    }
    if (a->turn.known && !rc_state_refused(s))
        read_turn(a, s);
    a->started = started;
    a->again = true;
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    const struct adhesion *a = (const struct adhesion *)m;
    struct rc_adhesion_solver_progress at;

    if (a->path == NULL)
        return;
    rc_adhesion_solver_progress(a->path, &at);
    if (a->pulls)
        rc_loops_add(l, "state", NULL, (double)at.state, NAN);
    if (isnan(at.load))
        rc_loops_add(l, "approach", "m", at.approach, NAN);
    else
        rc_loops_add(l, "load", "N", at.load, NAN);
    rc_loops_add(l, at.eigenvalue ? "stability, step" : "iteration", NULL, (double)at.iterations,
                 NAN);
    l->error = at.error;
    l->tol = at.tol;
}

static enum rc_status
plan(const struct rc_model *m, const struct rc_point *most, struct rc_expected *expected,
     struct rc_err *err)
{
    (void)most;
    return rc_adhesion_expect(&m->shape, &((const struct adhesion *)m)->problem, expected, err);
}

static void
release(struct rc_model *m)
{
    struct adhesion *a = (struct adhesion *)m;

    rc_adhesion_solver_free(a->path);
}

const struct rc_model_row rc_model_adhesion = {
    .name = "adhesion",
    .summary = "bodies that attract each other, with a hardness",
    .needs = 1u << RC_LOAD,
    .takes = 1u << RC_LOAD | 1u << RC_APPROACH,
    RC_MODEL_VERBS,
    .frame = frames,
    .free = release,
    .keep = keep,
    .heights = set_heights,
    .plan = plan,
};

struct rc_model *
rc_adhesion_new(const struct rc_shape *shape, const double *h,
                const struct rc_adhesion_problem *problem, struct rc_err *err)
{
    struct rc_adhesion_scales scales;
    RC_OWN(rc_model, m) = NULL;
    struct adhesion *a;

    if (rc_adhesion_check(shape, problem, &scales, err) != RC_OK ||
        (m = rc_model_make(&rc_model_adhesion, sizeof *a, shape, problem->contact.ranks, err)) ==
            NULL)
        return NULL;
    a = (struct adhesion *)m;
    a->problem = *problem;
    a->problem.contact.ranks = m->rows.ranks;
    m->boundary = problem->contact.boundary;
    a->n = rc_model_nodes(m);
    a->turn.last = -INFINITY;
    a->h = rc_store_copy(&m->own, a->n, sizeof *h, h);
    return rc_model_room(m, err) == RC_OK ? rc_give(&m) : NULL;
}

const struct rc_adhesion_figures *
rc_adhesion_result(const struct rc_model *m)
{
    const struct adhesion *found = (const struct adhesion *)rc_model_find(m, &rc_model_adhesion);

    return found != NULL ? &found->figures : NULL;
}
