/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The model of friction: rc_friction_solver under the pressure of an inner model, or under a known one.
 * Friction depends on the path, so load, force and displacement change in proportion from point to point, in
 * increments.
 *
 * Dissimilar bodies are coupled. Tractions move the surface along its normal, so that the inner model gets
 * heights without this displacement. Pressure moves the bodies along each other. Pressure and tractions are
 * found in turn, in passes that contract by about 0.7 mu beta. Where beta is 0, or the coupling neglects the
 * effect of tractions on the pressure (Goodman 1962), the pressure is found once for each load.
 *
 * Two further solutions may be computed, with half and with a quarter of the increments. They give the error
 * of the increments (increments.c). Both start from the tractions of the solution with all increments. Only
 * one solution iterates at a time, so that all share one operator and one iteration.
 */
#include "friction.h"

#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum stage {
    REST,     /* the last increment is part of the history */
    PRESSING, /* the inner model steps                      */
    SLIDING,  /* rc_friction_solver steps, under the pressure p        */
    THERE     /* the increment is solved                    */
};

/* One solution: with all increments, or with half or a quarter of them. The maps of these two are the same,
 * because their increments are kept one after another. */
struct way {
    struct rc_model *inner; /* NULL: takes the pressure of the first way */
    struct rc_friction_solver *slip;
    double *less, *p, *gap; /* less: heights of the inner model, the map of all ways */
    double *before[2];      /* tractions of the previous pass                        */
    bool has_gap, contact_good;
    double tol;              /* tolerance of the tractions, with all passes */
    struct rc_point pressed; /* the point of p, in the axes of the inner model */
    double inherited[2];     /* Pa: sums over the map of the errors of earlier increments: of their
                                iteration and of their contacts */
    /* of the present increment */
    struct rc_point at; /* its end */
    size_t stage, passes;
    double pressure_change, traction_change, factor, lowered, pressure_error, approach;
    double convolutions; /* convolutions of all contacts */
};

struct friction {
    struct rc_model base;
    struct rc_friction_problem problem;
    size_t n;
    bool alternates;
    double *h;       /* heights; NULL where tractions do not change them */
    bool known_only; /* there are no heights: only the known pressure is possible */
    struct way way[1 + RC_FEWER];
    struct rc_leg before, leg; /* the legs to this point, and to the next one  */
    /* of the present leg */
    size_t increment, running, fewer_done; /* running: index of the way that steps */
    size_t passes;                         /* passes of the earlier increments */
    double dissipated, convolutions;       /* J, since the last kept point; convolutions until
                                              then */
    /* Pa: sum over the map of the error of the increments; the same at the last kept point */
    double lagging, lag_before;
    double doubt; /* relative: error of the iteration with half of the increments */
    /* Pa: tractions with all increments minus tractions with half of them, at the last kept point */
    double *lag[2];
    double *energy; /* J/m2: the map of `dissipated`; NULL: not asked for */
    bool good;      /* all contacts and increments have converged           */
    bool again;     /* a state was read: its increment must be solved again */
    struct rc_friction_figures figures;
};

static const struct rc_figure own_figures[] = {
    {RC_FIGURE_AS("increments", struct friction, leg.increments), NULL, "Increments",
     .role = RC_FIGURE_COST},
    {0}};
static const struct rc_figure_set sets[] = {
    {rc_figures_friction, offsetof(struct friction, figures)}, {own_figures, 0}, {NULL, 0}};

static const struct rc_frame_kind frames[] = {
    RC_SLIP_FRAME_KINDS("m", ""),
    [RC_SLIP_DISSIPATION] = {"dissipation", "J/m2", "Dissipated energy"},
    {NULL, NULL, NULL}};

/* ---- passes ---- */

/* Copies maps of n values. Returns the L1 norm of the change over the L1 norm of the new values. */
static double
take(const struct friction *f, int maps, const double *const v[], double *const to[])
{
    struct rc_total of[2] = {{0, 0}, {0, 0}}; /* the change, all */
    double sum[2];

    for (int c = 0; c < maps; c++)
        for (size_t k = 0; k < f->n; k++) {
            rc_total_add(&of[0], fabs(v[c][k] - to[c][k]));
            rc_total_add(&of[1], fabs(v[c][k]));
            to[c][k] = v[c][k];
        }
    rc_ranks_totals(f->base.rows.ranks, 2, of, sum, 0, NULL);
    return sum[1] > 0 ? sum[0] / sum[1] : 0;
}

/* The change by all further passes over the last change: c/(1 - c), if each change is c times the previous
 * one. */
static double
left_over(size_t passes, double change, double before)
{
    /* The changes of slow passes rise and fall, and a ratio near 1 would make the sum infinite. Half
     * and double change no bit (30 runs of bench/constants.py). */
    static const double worst = 0.95;
    double c = passes > 2 && before > 0 ? fmin(change / before, worst) : 0.5;

    return fmax(1, c / (1 - c));
}

/* ---- the contact of an increment ---- */

static bool
moves(const struct friction *f)
{
    return rc_point_has(&f->base.to, RC_DISPLACEMENT_X);
}

/* True without load: the pressure is then 0 for any tractions. */
static bool
apart(const struct way *w)
{
    return rc_point_has(&w->at, RC_LOAD) && w->at.at[RC_LOAD] == 0;
}

/* The end of increment k of n. */
static struct rc_point
end_of_increment(const struct friction *f, size_t k, size_t n)
{
    return rc_point_between(&f->base.from, &f->base.to, rc_leg_part(&f->leg, k, n));
}

/* True if two points agree in all axes of the inner model. */
static bool
same(const struct way *w, const struct rc_point *a, const struct rc_point *b)
{
    /* Relative: rounding. Half and double change no bit (30 runs of bench/constants.py). */
    static const double rounding = 1e-12;
    const struct rc_point p = rc_point_for(w->inner, a), q = rc_point_for(w->inner, b);

    for (int k = 0; k < RC_AXES; k++)
        if (rc_point_has(&p, k) != rc_point_has(&q, k) ||
            (rc_point_has(&p, k) && !(fabs(p.at[k] - q.at[k]) <= rounding * fabs(p.at[k]))))
            return false;
    return true;
}

/* Gives the inner model the heights minus the normal displacement due to the present tractions. */
static enum rc_status
lower_heights(struct friction *f, struct way *w, struct rc_err *err)
{
    w->lowered = 0;
    if (apart(w))
        return rc_model_set_heights(w->inner, f->h, err);
    rc_friction_solver_normal(w->slip, w->less);
    for (size_t k = 0; k < f->n; k++)
        w->less[k] = f->h[k] - w->less[k];
    w->lowered = rc_ranks_highest(f->base.rows.ranks, f->h, f->n) -
                 rc_ranks_highest(f->base.rows.ranks, w->less, f->n);
    return rc_model_set_heights(w->inner, w->less, err);
}

/* Sends the inner model to the end of the increment. */
static enum rc_status
press(struct friction *f, struct way *w, struct rc_err *err)
{
    struct rc_point to = rc_point_for(w->inner, &w->at);

    if (f->known_only)
        return rc_err_set(
            err, "load %g N: its pressure is unknown, and without heights it cannot be solved",
            w->at.at[RC_LOAD]);
    if (f->alternates && lower_heights(f, w, err) != RC_OK)
        return RC_FAIL;
    to.at[RC_APPROACH] -= w->lowered; /* counted from first touch of the heights h */
    w->stage = PRESSING;
    if (rc_model_go(w->inner, &to, err) != RC_MORE)
        return RC_FAIL;
    if (w == f->way || w->passes > 0)
        return RC_MORE;
    return rc_model_start(w->inner, rc_model_number(f->way->inner, "load"), f->way->p, err) == RC_OK
               ? RC_MORE
               : RC_FAIL;
}

/* Gives rc_friction_solver the pressure, and the force or displacement at the end of the increment. */
static enum rc_status
pose(struct friction *f, struct way *w, struct rc_err *err)
{
    const enum rc_axis x = moves(f) ? RC_DISPLACEMENT_X : RC_TANGENTIAL_X;

    w->stage = SLIDING;
    if (rc_friction_solver_set_pressure(w->slip, apart(w) ? NULL : w->p, w->has_gap ? w->gap : NULL,
                                        err) != RC_OK ||
        (moves(f)
             ? rc_friction_solver_set_displacement(w->slip, w->at.at[x], w->at.at[x + 1], err)
             : rc_friction_solver_set_force(w->slip, w->at.at[x], w->at.at[x + 1], err)) != RC_OK)
        return RC_FAIL;
    return RC_MORE;
}

/* True if the pressure at the end of the increment needs no inner model. It is then the pressure of the first
 * way or of the previous increment, the known pressure, or 0. */
static bool
finds_pressure(struct friction *f, struct way *w)
{
    const struct rc_friction_problem *o = &f->problem;
    struct rc_point known = w->at;

    known.at[RC_LOAD] = o->known_load;
    w->contact_good = true;
    if (w != f->way && !f->alternates) {
        w->has_gap = f->way->has_gap;
        return true;
    }
    if (f->alternates)
        return false;
    if (w->pressed.given != 0 && same(w, &w->at, &w->pressed))
        return true;
    if (f->known_only && apart(w)) {
        w->has_gap = false;
        memset(w->p, 0, f->n * sizeof *w->p);
    } else if (o->known_load > 0 && rc_point_has(&w->at, RC_LOAD) && same(w, &w->at, &known)) {
        memcpy(w->p, o->known_p, f->n * sizeof *w->p);
        if ((w->has_gap = o->known_gap != NULL))
            memcpy(w->gap, o->known_gap, f->n * sizeof *w->gap);
    } else {
        return false;
    }
    w->approach = NAN;
    w->pressed = w->at;
    return true;
}

static enum rc_status
find_pressure(struct friction *f, struct way *w, struct rc_err *err)
{
    return finds_pressure(f, w) ? pose(f, w, err) : press(f, w, err);
}

static enum rc_status
step_contact(struct friction *f, struct way *w, struct rc_err *err)
{
    struct rc_model *inner = w->inner;
    enum rc_status status = rc_model_step(inner, err);
    const double *p = w->less; /* used as a buffer: lower_heights() fills it again */
    double error;

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    w->contact_good = status == RC_OK;
    if (rc_model_look(inner, NULL, err) != RC_OK ||
        rc_model_frame(inner, "pressure", f->alternates ? w->less : w->p, err) != RC_OK ||
        rc_model_frame(inner, "gap", w->gap, err) != RC_OK)
        return RC_FAIL;
    if (f->alternates)
        w->pressure_change = take(f, 1, &p, &w->p);
    w->convolutions += rc_model_number(inner, "convolutions");
    error = rc_model_number(inner, "pressure_error_estimate");
    w->pressure_error = isnan(error) ? 0 : error; /* NAN: the bodies are separated */
    w->approach = rc_model_number(inner, "approach") + w->lowered;
    w->has_gap = true;
    w->pressed = w->at;
    return pose(f, w, err);
}

/* ---- an increment of a way ---- */

static enum rc_status
begin_increment(struct friction *f, struct way *w, const struct rc_point *at, struct rc_err *err)
{
    w->at = *at;
    w->passes = 0;
    w->pressure_change = w->traction_change = w->factor = w->pressure_error = 0;
    return find_pressure(f, w, err);
}

static enum rc_status
slide(struct friction *f, struct way *w, struct rc_err *err)
{
    enum {
        PASSES = 50
    };
    const double *q[2] = {rc_friction_solver_traction(w->slip, 0),
                          rc_friction_solver_traction(w->slip, 1)};
    const size_t most = f->problem.max_passes > 0 ? f->problem.max_passes : PASSES;
    const double before = w->traction_change;
    enum rc_status status = rc_friction_solver_step(w->slip, err);

    if (status == RC_MORE || status == RC_FAIL)
        return status;
    w->passes++;
    if (f->alternates && !apart(w)) {
        w->traction_change = take(f, 2, q, w->before);
        w->factor = left_over(w->passes, w->traction_change, before);
        if (!(w->factor * w->traction_change <= w->tol / 2 &&
              w->factor * w->pressure_change <= w->tol / 2)) {
            if (w->passes < most)
                return press(f, w, err);
            status = RC_SHORT;
        }
    }
    w->stage = THERE;
    return status == RC_OK && w->contact_good ? RC_OK : RC_SHORT;
}

/* Returns the sum of |q| over the map, Pa. add: the errors that this increment adds to the sum. These are the
 * error of its iteration, and the error due to the pressure, which limits |q|. */
static double
added(const struct friction *f, const struct way *w, double error, double limit, double add[2])
{
    const double *q[2] = {rc_friction_solver_traction(w->slip, 0),
                          rc_friction_solver_traction(w->slip, 1)};
    struct rc_total sum = {0};
    double size;

    for (size_t k = 0; k < f->n; k++)
        rc_total_add(&sum, hypot(q[0][k], q[1][k]));
    size = rc_ranks_total(f->base.rows.ranks, sum);
    add[0] = size > 0 ? error * size : 0;
    add[1] = w->pressure_error * limit / (f->base.shape.dx * f->base.shape.dy);
    return size;
}

/* Computes the figures of the increment. */
static void
find_figures(const struct friction *f, const struct way *w, struct rc_friction_figures *to)
{
    double size, add[2];

    *to = (struct rc_friction_figures){.passes = w->passes,
                                       .pressure_change = w->pressure_change,
                                       .traction_change = w->traction_change,
                                       .approach = w->approach};
    rc_friction_solver_result(w->slip, &to->last);
    to->traction_error = to->last.traction_error + w->factor * w->traction_change;
    size = added(f, w, to->traction_error, to->last.limit, add);
    if (size > 0 && !apart(w)) {
        to->inherited_error = w->inherited[0] / size;
        to->contact_error = (w->inherited[1] + add[1]) / size;
    }
}

/* Makes the increment part of the history, also of the inner model. An increment minimises the energy
 * from the tractions before it, so that their error stays, but does not grow. Separated bodies inherit no
 * error. */
static enum rc_status
keep_increment(struct friction *f, struct way *w, struct rc_err *err)
{
    struct rc_friction_figures figures;
    double add[2];

    find_figures(f, w, &figures);
    added(f, w, figures.traction_error, figures.last.limit, add);
    for (int k = 0; k < 2; k++)
        w->inherited[k] = apart(w) ? 0 : w->inherited[k] + add[k];
    rc_friction_solver_keep(w->slip);
    w->stage = REST;
    return w->inner == NULL ? RC_OK : rc_model_keep(w->inner, err);
}

/* ---- all solutions of a leg ---- */

static enum rc_status
next_increment(struct friction *f, struct rc_err *err)
{
    const struct rc_point at = end_of_increment(f, ++f->increment, f->leg.increments);

    f->running = f->fewer_done = 0;
    return begin_increment(f, f->way, &at, err);
}

/* Begins increment k of n of a way with fewer increments, from the tractions of the first way. */
static enum rc_status
begin_fewer(struct friction *f, struct way *w, size_t k, size_t n, struct rc_err *err)
{
    const double *q[2] = {rc_friction_solver_traction(f->way->slip, 0),
                          rc_friction_solver_traction(f->way->slip, 1)};
    const struct rc_point at = end_of_increment(f, k, n);

    rc_friction_solver_start(w->slip, q);
    if (f->alternates) {
        memcpy(w->p, f->way->p, f->n * sizeof *w->p);
        take(f, 2, q, w->before);
    }
    return begin_increment(f, w, &at, err);
}

/* Called when the first way has reached the end of an increment. The other ways follow if one of their
 * increments ends there too. */
static enum rc_status
follow(struct friction *f, struct rc_err *err)
{
    const size_t n = f->leg.increments;
    struct rc_friction_figures figures;

    f->running = 0;
    while (f->fewer_done < f->problem.fewer) {
        const size_t j = f->fewer_done + 1, all = rc_leg_fewer(&f->leg, j),
                     done = f->increment * all / n;
        if (done > (f->increment - 1) * all / n) {
            f->running = j;
            return begin_fewer(f, &f->way[j], done, all, err);
        }
        f->fewer_done++;
    }
    if (f->increment == n)
        return f->good ? RC_OK : RC_SHORT;
    find_figures(f, f->way, &figures);
    f->dissipated += figures.last.dissipated;
    if (f->energy != NULL)
        rc_friction_solver_add_dissipation(f->way->slip, f->energy);
    f->passes += figures.passes;
    return keep_increment(f, f->way, err) == RC_OK ? next_increment(f, err) : RC_FAIL;
}

/* A force that is too large within the leg is too large at its end too. The message names the numbers at the
 * end, because the user has given those. */
static enum rc_status
refuse(struct friction *f, struct rc_err *err)
{
    const struct rc_point end = end_of_increment(f, 1, 1);
    struct rc_err last;
    enum rc_status status;

    if (f->running > 0 || f->increment == f->leg.increments)
        return RC_FAIL;
    f->increment = f->leg.increments;
    status = begin_increment(f, f->way, &end, &last);
    while (status == RC_MORE)
        status =
            f->way->stage == PRESSING ? step_contact(f, f->way, &last) : slide(f, f->way, &last);
    return status == RC_FAIL ? rc_err_set(err, "%s", last.text) : RC_FAIL;
}

static enum rc_status
step(struct rc_model *m, struct rc_err *err)
{
    struct friction *f = (struct friction *)m;
    struct way *w = &f->way[f->running];
    struct rc_friction_figures figures;
    enum rc_status status;

    if (f->again) {
        f->again = false;
        if (f->alternates)
            return find_pressure(f, w, err);
        return finds_pressure(f, w) ? pose(f, w, err) : step_contact(f, w, err);
    }
    status = w->stage == PRESSING ? step_contact(f, w, err) : slide(f, w, err);
    if (status == RC_MORE)
        return RC_MORE;
    if (status == RC_FAIL)
        return refuse(f, err);
    f->good = f->good && status == RC_OK;
    if (f->running > 0) {
        find_figures(f, w, &figures);
        if (f->running == 1)
            f->doubt = figures.traction_error + figures.inherited_error;
        if (keep_increment(f, w, err) != RC_OK)
            return RC_FAIL;
        f->fewer_done++;
    }
    return follow(f, err);
}

/* ---- the error of the increments ---- */

/* The present tractions of the first way, the kept ones of another way. */
static const double *
tractions(const struct friction *f, const struct way *w, int c)
{
    return w == f->way ? rc_friction_solver_traction(w->slip, c)
                       : rc_friction_solver_kept(w->slip, c);
}

/* The sum over the map of |q_a - q_b - lag|, Pa. b or lag NULL: 0. */
static double
distance(const struct friction *f, const struct way *a, const struct way *b, double *const lag[2])
{
    struct rc_total sum = {0};

    for (size_t k = 0; k < f->n; k++) {
        double d[2];
        for (int c = 0; c < 2; c++)
            d[c] = tractions(f, a, c)[k] - (b == NULL ? 0 : tractions(f, b, c)[k]) -
                   (lag == NULL ? 0 : lag[c][k]);
        rc_total_add(&sum, hypot(d[0], d[1]));
    }
    return rc_ranks_total(f->base.rows.ranks, sum);
}

/* The relative error of the increments; NAN: unknown. */
static double
increment_error(struct friction *f)
{
    const struct way *w = f->way;
    const double size = distance(f, w, NULL, NULL), doubt = f->doubt * size;
    const size_t fewer = f->problem.fewer;
    double d = NAN, d2 = NAN, lagged = NAN, error;

    if (fewer > 0) {
        d = distance(f, w, w + 1, NULL) + doubt;
        lagged = distance(f, w, w + 1, f->lag) + doubt;
    }
    if (fewer > 1)
        d2 = distance(f, w + 1, w + 2, NULL);
    error = f->leg.told == RC_TOLD_EXACT ? 0
            : fewer < (f->leg.late ? (size_t)1 : RC_FEWER)
                ? NAN
                : rc_leg_error(&f->leg, f->lag_before, d, d2, lagged);
    f->lagging = isnan(error) ? 0 : error;
    return size > 0 ? error / size : 0;
}

/* ---- verbs ---- */

static double
all_convolutions(const struct friction *f)
{
    double sum = rc_friction_solver_convolutions(f->way->slip);

    for (size_t j = 0; j <= f->problem.fewer; j++)
        sum += f->way[j].convolutions;
    return sum;
}

static enum rc_status
go(struct rc_model *m, struct rc_err *err)
{
    struct friction *f = (struct friction *)m;

    if (rc_point_has(&m->to, RC_TANGENTIAL_X) != rc_point_has(&m->to, RC_TANGENTIAL_Y))
        return rc_err_set(err, "a force along one direction and a displacement along the other: "
                               "give two forces or two displacements");
    f->leg = rc_friction_leg(&f->problem, &f->before, &m->from, &m->to);
    f->increment = f->passes = 0;
    f->dissipated = 0;
    if (f->energy != NULL)
        memset(f->energy, 0, f->n * sizeof *f->energy);
    f->good = true;
    f->again = false;
    f->convolutions = all_convolutions(f);
    for (size_t k = 0; k < f->n && f->problem.fewer > 0; k++)
        for (int c = 0; c < 2; c++)
            f->lag[c][k] = tractions(f, f->way, c)[k] - tractions(f, f->way + 1, c)[k];
    return next_increment(f, err) == RC_MORE ? RC_OK : refuse(f, err);
}

/* Solves the point of a state again, starting from the tractions of the state. */
static enum rc_status
find_again(struct friction *f, struct rc_err *err)
{
    enum rc_status status = RC_MORE;

    while (status == RC_MORE)
        status = step(&f->base, err);
    return status;
}

static enum rc_status
look(struct rc_model *m, struct rc_point *at, struct rc_err *err)
{
    static const enum rc_axis axis[2][2] = {{RC_TANGENTIAL_X, RC_TANGENTIAL_Y},
                                            {RC_DISPLACEMENT_X, RC_DISPLACEMENT_Y}};
    struct friction *f = (struct friction *)m;
    struct rc_friction_figures *to = &f->figures;

    if (f->again && m->status != RC_MORE &&
        (find_again(f, err) == RC_FAIL || rc_model_look(m->inner, at, err) != RC_OK))
        return RC_FAIL;
    if (f->way->stage != REST) { /* at rest the figures belong to the kept point */
        find_figures(f, f->way, to);
        to->last.dissipated += f->dissipated;
        to->passes += f->passes;
        to->convolutions = all_convolutions(f) - f->convolutions;
        to->increment_error = increment_error(f);
        to->largest_slip_total = rc_friction_solver_largest_slip(f->way->slip);
        to->converged = f->way->stage == THERE && f->good;
    }
    if (!rc_point_has(&m->to, RC_APPROACH))
        at->at[RC_APPROACH] = to->approach;
    to->approach = at->at[RC_APPROACH];
    for (int c = 0; c < 2; c++)
        at->at[axis[moves(f) ? 0 : 1][c]] = moves(f) ? to->last.force[c] : to->last.displacement[c];
    return RC_OK;
}

static enum rc_status
keep(struct rc_model *m, struct rc_err *err)
{
    struct friction *f = (struct friction *)m;

    f->lag_before = f->lagging;
    f->before = f->leg;
    if (f->energy != NULL && f->way->stage == THERE)
        rc_friction_solver_add_dissipation(f->way->slip, f->energy);
    return keep_increment(f, f->way, err);
}

static enum rc_status
fill(struct rc_model *m, size_t frame, double *to, struct rc_err *err)
{
    struct friction *f = (struct friction *)m;
    const struct way *w = f->way;

    if (frame == RC_SLIP_DISSIPATION && f->energy == NULL)
        return rc_err_set(err, "the map of the dissipated energy was not asked for");
    if (frame == RC_SLIP_STATE)
        rc_friction_solver_state(w->slip, to);
    else if (frame == RC_SLIP_TRACTION)
        for (size_t k = 0; k < f->n; k++)
            to[k] = hypot(rc_friction_solver_traction(w->slip, 0)[k],
                          rc_friction_solver_traction(w->slip, 1)[k]);
    else if (frame == RC_SLIP_SLIP_X || frame == RC_SLIP_SLIP_Y)
        rc_friction_solver_slip(w->slip, (int)frame - RC_SLIP_SLIP_X, to);
    else
        memcpy(to,
               frame == RC_SLIP_PRESSURE ? w->p
               : frame == RC_SLIP_DISSIPATION
                   ? f->energy
                   : rc_friction_solver_traction(w->slip, (int)frame - RC_SLIP_TRACTION_X),
               f->n * sizeof *to);
    if (frame == RC_SLIP_DISSIPATION && w->stage == THERE)
        rc_friction_solver_add_dissipation(w->slip, to);
    return RC_OK;
}

/* The new heights apply from the next increment on. */
static enum rc_status
set_heights(struct rc_model *m, const double *h, struct rc_err *err)
{
    struct friction *f = (struct friction *)m;

    if (f->h != NULL)
        memcpy(f->h, h, f->n * sizeof *h);
    for (size_t j = 0; j <= f->problem.fewer; j++) {
        f->way[j].pressed.given = 0;
        if (f->way[j].inner != NULL && rc_model_set_heights(f->way[j].inner, h, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

/* ---- states ---- */

/* Reads or writes the present increment. The state of the inner model holds the pressure only while that
 * model steps; afterwards the contact is solved again when the state was read. */
static void
exchange_increment(struct friction *f, struct rc_state *s)
{
    struct way *w = f->way;
    struct rc_err err;

    rc_state_count(s, &w->passes, SIZE_MAX / 2);
    RC_STATE_NUMBERS(s, &w->pressure_change, &w->traction_change, &w->factor, &w->pressure_error);
    for (int c = 0; c < 3 && f->alternates; c++) /* tractions of the previous pass */
        rc_state_map(s, f->n, c < 2 ? w->before[c] : w->p);
    for (int c = 0; c < 2 && f->problem.fewer > 0; c++)
        rc_state_map(s, f->n, f->lag[c]);
    if (f->alternates) /* else the increment begins again */
        rc_friction_solver_increment(w->slip, s);
    if (!rc_state_agree(s, f->base.rows.ranks) || !rc_state_reads(s))
        return;
    f->leg = rc_friction_leg(&f->problem, &f->before, &f->base.from, &f->base.to);
    if (f->increment == 0 || f->increment > f->leg.increments) {
        rc_state_refuse(s, "an increment is out of range");
        return;
    }
    w->at = end_of_increment(f, f->increment, f->leg.increments);
    f->again = w->stage != PRESSING;
    if (f->alternates && lower_heights(f, w, &err) != RC_OK)
        rc_state_refuse(s, "its heights are not finite");
}

/* Reads or writes the history of each way. An increment of a way with fewer increments begins anew. */
static void
exchange_ways(struct friction *f, struct rc_state *s)
{
    for (size_t j = 0; j <= f->problem.fewer; j++) {
        struct way *w = &f->way[j];
        rc_state_finite(s, 2, w->inherited);
        rc_friction_solver_history(w->slip, s);
        if (j > 0 && w->inner != NULL)
            rc_state_model(s, w->inner);
        if (rc_state_reads(s))
            w->pressed.given = 0;
    }
}

static void
state(struct rc_model *m, struct rc_state *s)
{
    struct friction *f = (struct friction *)m;
    size_t told = f->before.told;

    rc_state_count(s, &f->way->stage, THERE);
    RC_STATE_COUNTS(s, &f->increment, &f->passes);
    rc_state_count(s, &f->fewer_done, f->problem.fewer);
    RC_STATE_FLAGS(s, &f->good, &f->before.carries);
    rc_state_count(s, &told, RC_TOLD_UNKNOWN);
    if (f->energy != NULL)
        rc_state_map(s, f->n, f->energy);
    RC_STATE_NUMBERS(s, &f->dissipated, &f->lagging, &f->lag_before, &f->doubt);
    exchange_ways(f, s);
    if (rc_state_reads(s)) {
        f->before.told = (enum rc_told)told;
        f->running = 0;
        f->again = false;
        f->convolutions =
            all_convolutions(f); /* the convolutions of the run that wrote the state do not count */
    }
    if (f->way->stage != REST)
        exchange_increment(f, s);
}

static void
progress(const struct rc_model *m, struct rc_loops *l)
{
    const struct friction *f = (const struct friction *)m;

    rc_loops_add(l, "increment", NULL, (double)f->increment, (double)f->leg.increments);
}

static void
release(struct rc_model *m)
{
    struct friction *f = (struct friction *)m;

    for (size_t j = RC_FEWER + 1; j-- > 0;) {
        rc_friction_solver_free(f->way[j].slip);
        if (j > 0)
            rc_model_free(f->way[j].inner);
    }
}

const struct rc_model_row rc_model_friction = {
    .name = "friction",
    .summary = "friction over an inner model",
    .needs = 1u << RC_TANGENTIAL_X | 1u << RC_TANGENTIAL_Y,
    .takes = 1u << RC_TANGENTIAL_X | 1u << RC_TANGENTIAL_Y | 1u << RC_DISPLACEMENT_X |
             1u << RC_DISPLACEMENT_Y,
    RC_MODEL_VERBS,
    .frame = frames,
    .free = release,
    .keep = keep,
    .heights = set_heights,
};

/* ---- the maker ---- */

/* Begins with separated bodies, because the gap before contact shows which nodes came into contact later. */
static enum rc_status
begin(struct way *w, const double *gap, struct rc_err *err)
{
    enum rc_status status;

    if (rc_friction_solver_set_pressure(w->slip, NULL, gap, err) != RC_OK ||
        rc_friction_solver_set_force(w->slip, 0, 0, err) != RC_OK)
        return RC_FAIL;
    while ((status = rc_friction_solver_step(w->slip, err)) == RC_MORE)
        ;
    rc_friction_solver_keep(w->slip);
    return status;
}

static enum rc_status
make_maps(struct friction *f, size_t j, struct rc_err *err)
{
    struct way *w = &f->way[j];
    const struct way *like = j > 1 ? w - 1 : f->way; /* the way whose maps this one takes */
    double **maps[] = {&w->p, &w->gap, &w->before[0], &w->before[1], &w->less};
    double *const from[] = {like->p, like->gap, like->before[0], like->before[1], like->less};
    /* the first way has all maps, and the second one its own contact */
    const size_t own = j == 0 ? (f->alternates ? 5 : 2) : j == 1 && f->alternates ? 4 : 0;

    for (size_t k = 0; k < 5; k++)
        *maps[k] = k < own ? rc_store_zeros(&f->base.own, f->n, sizeof **maps[k]) : from[k];
    return rc_model_room(&f->base, err);
}

/* Makes way j. Half of its tolerance is for the passes. The error of a way with fewer increments enters the
 * estimate several times, so that its tolerance is a tenth. */
static enum rc_status
make_way(struct friction *f, size_t j, const double *h, struct rc_err *err)
{
    /* Increments have errors of about 1e-2: the iteration adds little to them. */
    static const double usual = 1e-4;
    struct way *w = &f->way[j];
    struct rc_friction_law slip = f->problem.law;
    struct rc_contact contact;

    w->tol = (slip.tol > 0 ? slip.tol : usual) / (j > 0 ? 10 : 1);
    slip.tol = f->alternates ? w->tol / 2 : w->tol;
    w->approach = NAN;
    w->slip = j == 0 ? rc_friction_solver_new(&f->base.shape, &slip, err)
                     : rc_friction_solver_beside(f->way->slip, slip.tol, err);
    if (w->slip == NULL || make_maps(f, j, err) != RC_OK)
        return RC_FAIL;
    if (h == NULL)
        return RC_OK;
    rc_contact_apart(f->base.rows.ranks, &f->base.shape, h, w->gap, &contact);
    return begin(w, w->gap, err);
}

static enum rc_status
make(struct friction *f, const double *h, struct rc_err *err)
{
    const struct rc_friction_problem *o = &f->problem;
    struct rc_shear shear;

    f->n = rc_model_nodes(&f->base);
    f->problem.law.ranks = f->base.rows.ranks;
    f->known_only = h == NULL;
    f->problem.law.uncoupled = o->coupling == RC_COUPLING_NONE;
    f->way->inner = f->base.inner;
    for (size_t j = 1; j <= RC_FEWER; j++)
        f->way[j].inner = o->inner_of_fewer[j - 1];
    if (rc_pair_shear(&o->law.pair, o->law.nu, &shear, err) != RC_OK ||
        rc_model_same_boundary(&f->base, o->law.boundary, err) != RC_OK)
        return RC_FAIL;
    f->alternates = o->coupling == RC_COUPLING_FULL && shear.beta != 0;
    if (o->fewer > RC_FEWER)
        return rc_err_set(err, "%zu ways with fewer increments: it must be 0, 1 or 2", o->fewer);
    if (f->alternates && h == NULL)
        return rc_err_set(err, "the pressure of dissimilar bodies depends on their tractions: give "
                               "heights, or choose another coupling");
    if (f->alternates && !rc_model_takes_heights(f->base.inner))
        return rc_err_set(err,
                          "the bodies are dissimilar, so that tractions change the heights, but "
                          "the %s model cannot change its heights: choose another coupling",
                          rc_model_name(f->base.inner));
    for (size_t j = 1; j <= o->fewer && f->alternates; j++)
        if (f->way[j].inner == NULL)
            return rc_err_set(err, "the bodies are dissimilar: each way with fewer increments "
                                   "needs its own inner model");
    if (f->alternates)
        f->h = rc_store_copy(&f->base.own, f->n, sizeof *h, h);
    if (o->dissipation)
        f->energy = rc_store_zeros(&f->base.own, f->n, sizeof *f->energy);
    for (int c = 0; c < 2 && o->fewer > 0; c++)
        f->lag[c] = rc_store_take(&f->base.own, f->n, sizeof *f->lag[c]);
    for (size_t j = 0; j <= o->fewer; j++)
        if (make_way(f, j, h, err) != RC_OK)
            return RC_FAIL;
    return RC_OK;
}

struct rc_model *
rc_friction_new(struct rc_model *inner, const double *h, const struct rc_friction_problem *problem,
                struct rc_err *err)
{
    RC_OWN(rc_model, m) =
        rc_model_make_outer(&rc_model_friction, sizeof(struct friction), inner, err);

    if (m == NULL) {
        for (size_t j = 0; j < RC_FEWER; j++)
            rc_model_free(problem->inner_of_fewer[j]);
        return NULL;
    }
    ((struct friction *)m)->problem = *problem;
    return make((struct friction *)m, h, err) == RC_OK ? rc_give(&m) : NULL;
}
