/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The elastic model: a contact by rc_solver, under a load or at an approach, with a hardness and a counter
 * body that is free to tilt. Its figures include the stiffness and the conductance. Keeping a point adds its
 * plastic dents to the shape.
 */
#include "elastic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/expected.h"
#include "libcontact/memory.h"
#include "libcontact/model/row.h"
#include "solver.h"

/* Own compliance of the nodes and of the rows. */
struct soft {
    double compliance;  /* m/Pa, of every node, times its part */
    const double *part; /* the caller's array; NULL: 1 everywhere */
    double along;       /* 1/Pa, of the rows */
};

/* Inside another model a contact is short, so that a state on the way has its start: the pressure, or
 * `fresh`, the load (a guess if the approach is given) and the number of the method. */
struct start {
    double *p, load, number;
    bool fresh;
};

struct elastic {
    struct rc_model base;
    struct rc_problem problem;
    struct rc_elastic_asks asks;
    const struct rc_along *compliant; /* compliance that differs along x; NULL: it is the same */
    size_t n;                         /* nodes of this rank                                     */
    const double *given; /* undeformed heights: until the first go the caller's array, then h */
    double *h;           /* a copy of `given`; freed when the solver has its own copy */
    double *dent;        /* present minus undeformed heights; NULL: no dents */
    struct soft soft;
    double tol; /* as given to the maker; problem.tol belongs to the next contact  */
    /* m, N: error of the heights; error of the loads that made the dents */
    double height_error, off;
    double first_top, top;    /* m: highest node of the first shape, and of the present one   */
    struct rc_solver *solver; /* NULL: no load so far                                         */
    bool apart;               /* no load at this point */
    struct start start;
    bool fresh_held;       /* rc_elastic_hold has convolved in double precision */
    bool again;            /* a state was read whose contact is solved: the next step returns */
    enum rc_status solved; /* this */
    bool deformed;         /* the dents of this point are in the shape */
    struct rc_elastic_figures figures;
};

const struct rc_figure rc_figures_elastic[] = {
#define FIGURE(member) RC_FIGURE(struct rc_elastic_figures, member)
    {FIGURE(stiffness), "N/m", "Stiffness", .says = "increase of the load with the approach"},
    {FIGURE(conductance), NULL, "Conductance", .says = "W/K or S, as the conductivities"},
    {FIGURE(conductance_lower), NULL, "Lower bound of the conductance"},
    {FIGURE(indentation), "m", "Indentation",
     .says = "approach from the first touch of the first shape"},
    {FIGURE(residual_indentation), "m", "Residual indentation",
     .says =
         "first touch of the shape after the load, counted from first touch of the first shape"},
    {FIGURE(tilt_x), "rad", "Tilt along x", .says = "of the counter body"},
    {FIGURE(tilt_y), "rad", "Tilt along y", .says = "of the counter body"},
    {FIGURE(kernel), NULL, "Engine", .says = "by which displacements are summed"},
    {FIGURE(method), NULL, "Method", .says = "by which the contact is iterated"},
    {0},
};
static const struct rc_figure_set sets[] = {
    {rc_figures_contact, offsetof(struct elastic, figures.contact)},
    {rc_figures_elastic, offsetof(struct elastic, figures)},
    {NULL, 0},
};

enum {
    SHAPE = RC_CONTACT_FRAMES
};
static const struct rc_frame_kind frames[] = {
    RC_CONTACT_FRAME_KINDS,
    [SHAPE] = {"plastic", "m", "Height after yield"},
    {NULL, NULL, NULL},
};

/* ---- the solver ---- */

static double
highest(const struct elastic *e)
{
    return e->solver != NULL ? e->solver->posed.top
                             : rc_ranks_most(e->problem.ranks, rc_highest(e->given, e->n));
}

/* Sets this load or approach; makes the solver at the first call. */
static enum rc_status
press(struct elastic *e, double load, double approach, struct rc_err *err)
{
    struct rc_problem problem = e->problem;

    if (e->solver != NULL)
        return rc_solver_set_load(e->solver, load, approach, err);
    problem.load = load;
    problem.approach = approach;
    problem.height_error = e->height_error;
    e->solver = rc_solver_new_along(&e->base.shape, e->given, &problem, e->compliant, err);
    if (e->solver == NULL)
        return RC_FAIL;
    if (rc_solver_set_diagonal(e->solver, e->soft.compliance, e->soft.part, e->soft.along, err) !=
        RC_OK)
        return RC_FAIL;
    e->solver->posed.dents = e->off;
    free(e->h); /* the solver has a copy */
    e->h = NULL;
    e->given = NULL;
    return RC_OK;
}

/* Gives the model its own copy of the heights. */
static enum rc_status
own_heights(struct elastic *e, const double *h, struct rc_err *err)
{
    if (e->h == NULL)
        e->h = rc_alloc(e->n, sizeof *e->h);
    if (rc_ranks_need(e->base.rows.ranks, e->h != NULL, err, "out of memory for the heights") !=
        RC_OK)
        return RC_FAIL;
    if (h != e->h)
        memcpy(e->h, h, e->n * sizeof *h);
    e->given = e->h;
    return RC_OK;
}

/* The present heights. */
static void
shape(const struct elastic *e, double *to)
{
    for (size_t k = 0; k < e->n; k++)
        to[k] = e->solver != NULL ? e->solver->posed.h[k] + e->solver->posed.top : e->given[k];
}

static enum rc_status
set_shape(struct elastic *e, const double *h, struct rc_err *err)
{
    if (e->solver == NULL)
        return own_heights(e, h, err);
    if (rc_solver_next_heights(e->solver, h, err) != RC_OK)
        return RC_FAIL;
    e->solver->posed.height_error = e->height_error;
    e->solver->posed.dents = e->off;
    return RC_OK;
}

/* Keeps the start of the contact. */
static enum rc_status
keep_start(struct elastic *e, struct rc_err *err)
{
    double none = 0;

    if (!e->base.inside || e->apart)
        return RC_OK;
    e->start.fresh = rc_nested_untouched(e->solver);
    e->start.load = rc_solver_load(e->solver);
    e->start.number = *rc_solver_lasting(e->solver, &none);
    if (e->start.fresh)
        return RC_OK;
    if (rc_ranks_need(e->base.rows.ranks, rc_store_need(&e->base.own, e->n, &e->start.p), err,
                      "out of memory for the start of a contact") != RC_OK)
        return RC_FAIL;
    memcpy(e->start.p, rc_solver_pressure(e->solver), e->n * sizeof *e->start.p);
    return RC_OK;
}

/* ---- verbs ---- */

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct elastic *e = (struct elastic *)m;
    const bool by_approach = rc_point_has(&m->to, RC_APPROACH);
    const double v = m->to.at[by_approach ? RC_APPROACH : RC_LOAD];
    enum rc_status status = RC_OK;

    if (!(v >= 0) || isinf(v))
        return rc_err_set(
            err, "%s %g %s: it must not be negative, because the bodies do not attract each other",
            by_approach ? "approach" : "load", v, by_approach ? "m" : "N");
    e->deformed = e->again = false;
    e->apart = v == 0;
    if (!e->apart)
        status = press(e, by_approach ? 0 : v, by_approach ? v : 0, err);
    else if (e->solver == NULL)
        status = own_heights(e, e->given, err);
    if (status == RC_OK)
        e->top = highest(e); /* known to a solver */
    if (m->from.given == 0)
        e->first_top = e->top;
    return status == RC_OK ? keep_start(e, err) : status;
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct elastic *e = (struct elastic *)m;

    (void)err;
    if (e->again) {
        e->again = false;
        return e->solved;
    }
    return e->apart ? RC_OK : rc_solver_step(e->solver);
}

static enum rc_status
start(struct rc_model *m, double load, const double *p, struct rc_err *err)
{
    struct elastic *e = (struct elastic *)m;

    if (e->apart)
        return RC_OK;
    return rc_solver_warm_start(e->solver, load, p, err) == RC_OK ? keep_start(e, err) : RC_FAIL;
}

/* Finds the stiffness. If no node is at the hardness, the conductance already contains it. */
static enum rc_status
look_at_stiffness(struct elastic *e, struct rc_err *err)
{
    struct rc_elastic_figures *f = &e->figures;
    const double *k = e->asks.conductivity;
    struct rc_conductance c = {NAN, NAN, NAN};

    f->stiffness = NAN;
    if (k[0] > 0 && rc_solver_conductance(e->solver, k[0], k[1], &c, err) != RC_OK)
        return RC_FAIL;
    f->conductance = c.value;
    f->conductance_lower = c.lower;
    if (!e->asks.stiffness)
        return RC_OK;
    if (k[0] > 0 && f->contact.plastic_nodes == 0)
        f->stiffness = c.stiffness;
    else
        return rc_solver_stiffness(e->solver, &f->stiffness, err);
    return RC_OK;
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    struct elastic *e = (struct elastic *)m;
    struct rc_elastic_figures *f = &e->figures;

    if ((e->apart || e->solver == NULL) && !m->looked) {
        rc_contact_apart(e->problem.ranks, &m->shape,
                         e->solver != NULL ? e->solver->posed.h : e->given, NULL, &f->contact);
        f->stiffness = NAN;
        f->conductance = f->conductance_lower = e->asks.conductivity[0] > 0 ? 0 : NAN;
    } else if (!m->looked) {
        rc_solver_result(e->solver, NULL, NULL, &f->contact);
        f->kernel = rc_solver_engine(e->solver);
        f->method = rc_solver_method(e->solver);
        if (look_at_stiffness(e, err) != RC_OK)
            return RC_FAIL;
        f->contact.convolutions = rc_solver_convolutions(e->solver);
    }
    f->tilt_x = e->problem.tilt_free ? atan(f->contact.tilt[0]) : NAN;
    f->tilt_y = e->problem.tilt_free ? atan(f->contact.tilt[1]) : NAN;
    f->indentation = e->apart ? e->first_top - e->top : f->contact.approach + e->first_top - e->top;
    f->residual_indentation = e->deformed || e->apart ? e->first_top - highest(e) : NAN;
    at->at[RC_LOAD] = f->contact.load;
    at->at[RC_APPROACH] = f->contact.approach;
    return RC_OK;
}

/* Finds the shape after elastic unloading, and the dents: this shape minus the undeformed heights. */
static enum rc_status
dent(struct elastic *e, struct rc_err *err)
{
    RC_OWNED double *left = rc_alloc(e->n, sizeof *left);
    enum rc_status status;

    if (rc_ranks_need(e->base.rows.ranks,
                      left != NULL && rc_store_need(&e->base.own, e->n, &e->dent), err,
                      "out of memory for the shape after yield") != RC_OK)
        return RC_FAIL;
    shape(e, left);
    for (size_t k = 0; k < e->n; k++)
        e->dent[k] -= left[k];
    status = rc_solver_keep_shape(e->solver, &e->figures.contact, left, err);
    for (size_t k = 0; k < e->n; k++)
        e->dent[k] += left[k];
    e->height_error = e->solver->posed.height_error;
    e->off = e->solver->posed.dents;
    return status;
}

static enum rc_status
keep(struct rc_model *m, struct rc_err *err)
{
    struct elastic *e = (struct elastic *)m;

    if (!e->apart && e->figures.contact.yielded_nodes > 0) {
        if (e->problem.tilt_free)
            return rc_err_set(err, "a history of dents with a free tilt is not implemented");
        if (dent(e, err) != RC_OK)
            return RC_FAIL;
    }
    e->deformed = true;
    e->figures.residual_indentation = e->first_top - highest(e);
    return RC_OK;
}

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    struct elastic *e = (struct elastic *)m;
    const struct rc_solver *s = e->solver;
    const double rise = s == NULL ? 0 : s->op->rise * s->load.sum; /* by the datum */
    struct rc_contact again;

    if (!e->apart && s == NULL)
        return rc_err_set(err, "call rc_model_look before reading a frame");
    if ((frame == RC_FRAME_GAP || frame == RC_FRAME_DISPLACEMENT) && !e->apart && !s->it.known) {
        (void)rc_iterate_displace_rows(e->solver);
        rc_iterate_shift(e->solver);
    }
    if (frame == SHAPE && !e->apart && !e->deformed)
        return rc_solver_plastic(e->solver, to, err);
    if (frame == SHAPE)
        shape(e, to);
    else if (e->apart && frame == RC_FRAME_GAP)
        rc_contact_apart(e->problem.ranks, &m->shape, s != NULL ? s->posed.h : e->given, to,
                         &again);
    else if (e->apart)
        memset(to, 0, e->n * sizeof *to);
    else if (frame == RC_FRAME_PRESSURE || frame == RC_FRAME_CONTACT)
        memcpy(to, rc_solver_pressure(s), e->n * sizeof *to);
    else
        for (size_t k = 0; k < e->n; k++)
            to[k] = frame == RC_FRAME_GAP ? s->it.v[k] - s->it.shift
                                          : s->it.v[k] + s->posed.h[k] -
                                                rc_operator_own_motion(s->op, k, s->it.p[k]) + rise;
    for (size_t k = 0; k < e->n && frame == RC_FRAME_CONTACT; k++)
        to[k] = rc_in_contact(to[k]) ? 1 : 0;
    return RC_OK;
}

/* Adds the dents to the new heights. */
static enum rc_status
set_heights(struct rc_model *m, const double *h, struct rc_err *err)
{
    struct elastic *e = (struct elastic *)m;
    RC_OWNED double *dented = NULL;

    if (e->dent == NULL)
        return set_shape(e, h, err);
    dented = rc_alloc(e->n, sizeof *dented);
    if (rc_ranks_need(e->base.rows.ranks, dented != NULL, err, "out of memory for the heights") !=
        RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < e->n; k++)
        dented[k] = h[k] + e->dent[k];
    return set_shape(e, dented, err);
}

static enum rc_status
set_compliance(struct rc_model *m, double c, const double *part, double along, struct rc_err *err)
{
    struct elastic *e = (struct elastic *)m;
    const size_t n = part != NULL ? e->n : 0;
    enum rc_status status = RC_OK;

    if ((c > 0 || along > 0) &&
        (e->problem.tilt_free || e->asks.stiffness || e->asks.conductivity[0] > 0))
        return rc_err_set(err, "a compliance of the nodes together with a free tilt, the stiffness "
                               "or the conductance is not implemented");
    if (part != NULL && along > 0)
        return rc_err_set(err, "a compliance that differs by node together with one of the rows is "
                               "not implemented");
    for (size_t k = 0; k < n && status == RC_OK; k++)
        if (!(part[k] >= 0) || isinf(part[k]))
            status = rc_err_set(err,
                                "part %g of the compliance at node %zu: it must be at least 0 "
                                "and finite",
                                part[k], e->base.rows.first * m->shape.nx + k);
    if (rc_ranks_agree(e->base.rows.ranks, status, err) != RC_OK)
        return RC_FAIL;
    e->soft.compliance = c;
    e->soft.part = part;
    e->soft.along = along;
    return e->solver != NULL ? rc_solver_set_diagonal(e->solver, c, part, along, err) : RC_OK;
}

static void
set_accuracy(struct rc_model *m, double part)
{
    struct elastic *e = (struct elastic *)m;

    e->problem.tol = part * e->tol;
    if (e->solver != NULL && e->tol > 0)
        rc_solver_set_tol(e->solver, e->problem.tol);
}

/* The elastic nodes do not change, and the preconditioner gives their response nearly exactly. */
static enum rc_status
respond(struct rc_model *m, const double *e, double *z, struct rc_err *err)
{
    struct elastic *v = (struct elastic *)m;

    if (!m->looked || v->apart)
        return rc_err_set(
            err, "call rc_model_look before asking for the response to a change of heights");
    rc_solver_respond(v->solver, e, z);
    return RC_OK;
}

/* ---- states ---- */

/* Replaces the dents of the shape by those of the state. Equal dents stay, so that heights are rounded only
 * once. */
static void
read_dent(struct elastic *e, struct rc_state *s, bool some)
{
    const double *now = some ? rc_state_read_map(s, e->n) : NULL;
    RC_OWNED double *h = rc_alloc(e->n, sizeof *h);
    bool others = false;
    struct rc_err err;

    if (h == NULL || !rc_store_need(&e->base.own, e->n, &e->dent))
        rc_state_refuse(s, "memory is short");
    if (!rc_state_agree(s, e->base.rows.ranks))
        return;
    shape(e, h);
    for (size_t k = 0; k < e->n; k++) {
        const double dent = now != NULL ? now[k] : 0, more = dent - e->dent[k];
        others |= more != 0;
        h[k] += more;
        e->dent[k] = dent;
    }
    others = rc_ranks_most(e->problem.ranks, others) > 0;
    if (rc_state_reads(s) && others && set_shape(e, h, &err) != RC_OK)
        rc_state_refuse(s, err.text[0] != '\0' ? "its shape is not finite" : "memory is short");
}

/* Sets the load or the approach, and takes the stored pressure as start. */
static void
read_pressure(struct elastic *e, struct rc_state *s, double load)
{
    const struct rc_point *to = &e->base.to;
    const bool by_approach = rc_point_has(to, RC_APPROACH);
    const double *p = rc_state_read_map(s, e->n);
    struct rc_err err;

    if (rc_state_agree(s, e->base.rows.ranks) &&
        (press(e, by_approach ? 0 : to->at[RC_LOAD], by_approach ? to->at[RC_APPROACH] : 0, &err) !=
             RC_OK ||
         rc_solver_warm_start(e->solver, load, p, &err) != RC_OK))
        rc_state_refuse(s, "its load or its pressure is not finite or negative");
    e->base.status = RC_MORE; /* the next step decides whether it is the solution */
}

/* The numbers of an iteration in a state. */
struct iteration {
    double load, number, error, load_error, convolutions;
    double top; /* of the heights of the solver */
    size_t iterations;
    bool pressed, fresh;
};

/* Inside another model the contact begins again from its start, or is solved. */
static void
read_inside(struct elastic *e, struct rc_state *s, const struct iteration *it, bool dented)
{
    const struct rc_point *to = &e->base.to;
    const bool by_approach = rc_point_has(to, RC_APPROACH) && !e->apart;
    const double *p = it->fresh ? NULL : rc_state_read_map(s, e->n);
    const double *h = dented ? rc_state_read_map(s, e->n) : NULL;
    const enum rc_status status = e->base.status;
    struct rc_err err;
    double none;

    if (!rc_state_agree(s, e->base.rows.ranks) || !rc_state_reads(s))
        return;
    if (press(e, by_approach ? 0 : it->load, by_approach ? to->at[RC_APPROACH] : 0, &err) !=
            RC_OK ||
        (by_approach && rc_load_set(e->solver, it->load, &err) != RC_OK) ||
        rc_solver_warm_start(e->solver, it->load, p, &err) != RC_OK) {
        rc_state_refuse(s, "its load or its pressure is not finite or negative");
        return;
    }
    *rc_solver_lasting(e->solver, &none) = it->number;
    if (h != NULL) { /* the heights and the dents give them only within rounding */
        memcpy(e->solver->posed.h, h, e->n * sizeof *h);
        e->solver->posed.top = it->top;
    }
    if (status == RC_SHORT ||
        (status == RC_OK && (e->apart || !e->base.moved || it->error <= e->solver->posed.tol))) {
        if (!e->apart)
            rc_solver_found(e->solver, it->error, it->load_error, it->iterations, it->convolutions);
        e->solved = status;
        e->again = e->base.moved;
        if (e->base.moved)
            e->base.status = RC_MORE; /* an outer model takes one step */
        return;
    }
    e->base.status = RC_MORE; /* on the way, or solved with a larger tolerance */
    if (keep_start(e, &err) != RC_OK)
        rc_state_refuse(s, "memory is short");
}

/* A state holds the dents of earlier points and the pressure. The pressure of a kept point is the start
 * of the next contact: it is left out unless this is an inner model. */
static void
state(struct rc_model *m, struct rc_state *s)
{
    struct elastic *e = (struct elastic *)m;
    struct rc_solver *v = e->solver;
    const bool inside = m->inside && !rc_state_is_copy(s),
               way = inside && m->status == RC_MORE && !e->apart && !e->again;
    bool dented = e->dent != NULL;
    struct iteration it = {.pressed = v != NULL && (inside || (m->moved && !e->apart))};
    struct rc_err err;

    if (v != NULL) {
        it.number = way ? e->start.number : *rc_solver_lasting(v, &it.number);
        it.load = way ? e->start.load : rc_solver_load(v);
        it.fresh = way ? e->start.fresh : rc_nested_untouched(v);
        it.error = v->it.error;
        it.load_error = way ? 0 : rc_load_error(v);
        it.top = v->posed.top;
        it.iterations = v->it.iterations;
        it.convolutions = v->it.convolutions;
    }
    RC_STATE_FLAGS(s, &dented, &e->apart, &it.pressed, &it.fresh);
    RC_STATE_NUMBERS(s, &e->first_top, &e->top, &e->height_error, &e->off, &it.load, &it.number,
                     &it.top, &it.convolutions);
    RC_STATE_OPEN(s, &it.error, &it.load_error);
    RC_STATE_COUNTS(s, &it.iterations);
    if (rc_state_refused(s))
        return;
    if (!rc_state_reads(s)) { /* writing: the solver's pressure is not changed */
        if (dented)
            rc_state_map(s, e->n, e->dent);
        if (it.pressed && !(inside && it.fresh))
            rc_state_map(s, e->n, way ? e->start.p : v->it.p);
        if (it.pressed && inside && dented)
            rc_state_map(s, e->n, v->posed.h);
        return;
    }
    e->deformed = e->again = false;
    if (dented || e->dent != NULL)
        read_dent(e, s, dented);
    if (m->moved && !e->apart && !it.pressed)
        rc_state_refuse(s, "the pressure of its point is missing");
    if (it.pressed && rc_state_reads(s) && inside)
        read_inside(e, s, &it, dented);
    else if (it.pressed && rc_state_reads(s))
        read_pressure(e, s, it.load);
    if (e->solver == NULL && own_heights(e, e->given, &err) != RC_OK)
        rc_state_refuse(s, "memory is short");
}

static void
progress(const struct rc_model *m, struct rc_loops *s)
{
    const struct elastic *e = (const struct elastic *)m;
    struct rc_progress at;

    if (e->solver == NULL)
        return;
    rc_solver_progress(e->solver, &at);
    rc_loops_add(s, "iteration", NULL, (double)at.iterations, NAN);
    s->grid = at.grid;
    s->error = at.error;
    s->tol = at.tol;
    s->worth = !at.coarser && at.iterations > 0;
}

static enum rc_status
plan(const struct rc_model *m, const struct rc_point *most, struct rc_expected *expected,
     struct rc_err *err)
{
    const struct elastic *e = (const struct elastic *)m;
    struct rc_problem problem = e->problem;
    const bool by_approach = rc_point_has(most, RC_APPROACH);

    problem.load = by_approach ? 0 : most->at[RC_LOAD];
    problem.approach = by_approach ? most->at[RC_APPROACH] : 0;
    if (rc_solver_expect(&m->shape, &problem, expected, err) != RC_OK)
        return RC_FAIL;
    if (e->asks.stiffness || e->asks.conductivity[0] > 0) {
        expected->seconds *= 1 + RC_STIFFNESS_WORK / expected->convolutions;
        expected->convolutions += RC_STIFFNESS_WORK;
        expected->memory +=
            e->n * (e->asks.conductivity[0] > 0 ? RC_CONDUCTANCE_BYTES : RC_STIFFNESS_BYTES);
    }
    if (m->inside)
        expected->memory += e->n * sizeof *e->start.p;
    return RC_OK;
}

static struct rc_solver *
solver(const struct rc_model *m)
{
    return ((const struct elastic *)m)->solver;
}

static void
release(struct rc_model *m)
{
    struct elastic *e = (struct elastic *)m;

    rc_solver_free(e->solver);
    free(e->h);
}

/* ---- for an outer model with heights of its own ---- */

static struct rc_solver *
solver_of(const struct rc_model *m)
{
    return ((const struct elastic *)m)->solver;
}

const double *
rc_elastic_pressure(const struct rc_model *m)
{
    return solver_of(m)->it.p;
}

double
rc_elastic_own(const struct rc_model *m)
{
    const struct elastic *e = (const struct elastic *)m;

    return e->solver != NULL ? e->solver->op->diagonal : 0;
}

enum rc_status
rc_elastic_reach(const struct rc_model *m, const double *h, double approach, struct rc_err *err)
{
    const struct elastic *e = (const struct elastic *)m;
    const struct rc_ranks *ranks = e->base.rows.ranks;

    if (e->solver == NULL || !rc_load_completes(e->solver))
        return RC_OK;
    return rc_load_reach(approach,
                         rc_ranks_highest(ranks, h, e->n) -
                             rc_ranks_sum_of(ranks, h, e->n) / (double)e->solver->posed.nodes,
                         err);
}

double
rc_elastic_top(const struct rc_model *m)
{
    return solver_of(m)->posed.top;
}

void
rc_elastic_displacement(const struct rc_model *m, bool add, double *u)
{
    const struct rc_solver *s = solver_of(m);

    for (size_t k = 0; k < s->posed.n; k++)
        u[k] = (add ? u[k] : 0) + (s->it.v[k] + s->posed.h[k]);
}

const double *
rc_elastic_hold(struct rc_model *m, bool fresh)
{
    struct elastic *e = (struct elastic *)m;
    struct rc_solver *s = e->solver;

    e->fresh_held = fresh;
    if (fresh) {
        rc_operator_apply(s->op, s->it.p, s->it.v);
        rc_iterate_count(s, 1);
    } else {
        for (size_t k = 0; k < s->posed.n; k++)
            s->it.v[k] += s->posed.h[k];
    }
    return s->it.v;
}

double
rc_elastic_work(const struct rc_model *m, size_t *iterations)
{
    *iterations = solver_of(m)->it.iterations;
    return rc_solver_convolutions(solver_of(m));
}

static enum rc_status
take_heights(struct rc_solver *s, const struct rc_elastic_heights *to, struct rc_err *err)
{
    if (to->approach > 0)
        s->load.target = to->approach;
    return rc_solver_set_heights(s, to->h, err);
}

enum rc_status
rc_elastic_judge(struct rc_model *m, const struct rc_elastic_heights *to, double tol, double *error,
                 struct rc_err *err)
{
    struct rc_solver *s = solver_of(m);

    s->posed.tol = tol;
    if (take_heights(s, to, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < s->posed.n; k++)
        s->it.v[k] -= s->posed.h[k];
    s->it.known = true;
    rc_iterate_shift(s);
    rc_working_set_find(s, false);
    *error = rc_working_set_estimate(s);
    s->it.fresh = ((struct elastic *)m)->fresh_held;
    return RC_OK;
}

bool
rc_elastic_reached(const struct rc_model *m)
{
    return rc_load_reached(solver_of(m));
}

void
rc_elastic_conclude(struct rc_model *m, double error)
{
    struct rc_solver *s = solver_of(m);

    rc_iterate_checked(s, error, 1);
    s->stage = RC_STAGE_STEPPED;
    m->status = RC_OK;
}

void
rc_elastic_set_rough(struct rc_model *m, bool rough)
{
    solver_of(m)->posed.rough = rough;
}

enum rc_status
rc_elastic_resume(struct rc_model *m, const struct rc_elastic_heights *to, double tol, bool rough,
                  struct rc_err *err)
{
    rc_elastic_set_rough(m, rough);
    rc_solver_set_tol(solver_of(m), tol);
    if (take_heights(solver_of(m), to, err) != RC_OK)
        return RC_FAIL;
    m->status = RC_MORE;
    return RC_OK;
}

/* ---- the makers ---- */

struct rc_model *
rc_elastic_new(const struct rc_shape *shape, const double *h, const struct rc_problem *problem,
               const struct rc_elastic_asks *asks, struct rc_err *err)
{
    struct rc_model *m;
    struct elastic *e;

    if (rc_solver_check(shape, problem, err) != RC_OK ||
        (m = rc_model_make(&rc_model_elastic, sizeof *e, shape, problem->ranks, err)) == NULL)
        return NULL;
    e = (struct elastic *)m;
    e->problem = *problem;
    e->asks = asks != NULL ? *asks : (struct rc_elastic_asks){false, {0, 0}};
    e->height_error = problem->height_error;
    e->tol = problem->tol;
    e->n = rc_model_nodes(m);
    e->given = h;
    m->boundary = problem->boundary;
    return m;
}

struct rc_model *
rc_elastic_new_along(const struct rc_shape *shape, const double *h,
                     const struct rc_problem *problem, const struct rc_along *along,
                     struct rc_err *err)
{
    struct rc_problem own = *problem;
    struct rc_model *m;

    if (rc_has_mean(problem->boundary)) /* only the transforms take a factor of the displacement */
        own.engine = rc_engine_of_transforms()->info.name;
    m = rc_elastic_new(shape, h, &own, NULL, err);
    if (m != NULL)
        ((struct elastic *)m)->compliant = along;
    return m;
}

const struct rc_model_row rc_model_elastic = {
    .name = "elastic",
    .summary = "elastic bodies, with a hardness",
    .needs = 1u << RC_LOAD,
    .takes = 1u << RC_LOAD | 1u << RC_APPROACH,
    .forgets = true,
    RC_MODEL_VERBS,
    .frame = frames,
    .free = release,
    .keep = keep,
    .heights = set_heights,
    .compliance = set_compliance,
    .accuracy = set_accuracy,
    .start = start,
    .respond = respond,
    .plan = plan,
    .solver = solver,
};
