/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A case of rc-slip: solves its corners one after another and writes the frames of each. */
#include "slip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

const char *const slip_frames[] = {[SLIP_PRESSURE] = "pressure",
                                   [SLIP_TRACTION_X] = "traction-x",
                                   [SLIP_TRACTION_Y] = "traction-y",
                                   [SLIP_SLIP_X] = "slip-x",
                                   [SLIP_SLIP_Y] = "slip-y",
                                   [SLIP_STATE] = "state",
                                   [SLIP_HEIGHT] = "height",
                                   [SLIP_LENGTH] = "slip",
                                   [SLIP_TRACTION] = "traction",
                                   [SLIP_DISSIPATION] = "dissipation",
                                   [SLIP_FRAMES] = NULL};

/* ---- the input ---- */

static void
check_beside(struct slip_run *run, struct rc_grid *g)
{
    if (g == NULL)
        return;
    tool_demand_grid_of(&run->d.t, g, run->p);
    tool_demand_finite(&run->d.t, g, "solve the contact again");
}

static void
check_pressure(struct slip_run *run)
{
    size_t n = rc_grid_nodes(run->p), pulled = 0, without = 0;
    const struct rc_grid *touch;

    tool_demand_finite(&run->d.t, run->p, "recompute the map");
    for (size_t k = 0; k < n; k++)
        pulled += run->p->v[k] < 0;
    pulled = (size_t)ranks_sum(&run->d.t, (double)pulled);
    if (pulled > 0 || rc_grid_get(run->p, "adhesion") != NULL)
        tool_refuse(&run->d.t, run->p,
                    "it is the net pressure of an adhesive contact, negative at %zu of %zu nodes, "
                    "and friction needs the pressure of the touching nodes alone: solve the "
                    "contact without --adhesion",
                    pulled, rc_shape_of(run->p)->nx * rc_shape_of(run->p)->ny);
    touch = contact_frame(&run->d.t, run->p, run->contact);
    for (size_t k = 0; k < n; k++)
        without += rc_in_contact(run->p->v[k]) && !rc_in_contact(touch->v[k]);
    without = (size_t)ranks_sum(&run->d.t, (double)without);
    if (without > 0)
        tool_refuse(&run->d.t, run->contact,
                    "%zu nodes have a pressure, but are not in contact according to this frame: "
                    "solve the contact again",
                    without);
    run->load = ranks_total(&run->d.t, run->p->v, n) * run->p->dx * run->p->dy;
}

/* A new contact can be solved only for elastic bodies with known heights. */
static void
check_solvable(struct slip_run *run)
{
    static const char *const more[] = {"hardness", "yield", "adhesion"};
    const char *remedy =
        run->coupled ? "take --coupling none and the load of the stream alone; the slip that "
                       "pressing dissimilar bodies together causes is then left out"
                     : "use the load of the stream alone";

    if (!run->solves)
        return;
    if (run->height == NULL && run->alternates)
        tool_refuse(&run->d.t, run->p,
                    "its bodies are dissimilar (beta %.3g), so that tractions change the pressure, "
                    "and this needs a height in the same case: keep all frames of rc-solve, or "
                    "take --coupling goodman or none",
                    run->bodies.beta);
    if (run->height == NULL)
        tool_refuse(&run->d.t, run->p,
                    "the path has loads other than that of the stream, %g N, and these contacts "
                    "need a height in the same case: keep all frames of rc-solve",
                    run->load);
    if (tool_history_has(run->p, "rc-solve ", "--tilt free"))
        tool_refuse(
            &run->d.t, run->p,
            "its counter body was free to tilt, and rc-slip solves other loads without tilt: %s",
            remedy);
    for (size_t k = 0; k < sizeof more / sizeof *more; k++)
        if (rc_grid_get(run->p, more[k]) != NULL)
            tool_refuse(&run->d.t, run->p,
                        "its key %s says that the bodies are not elastic, and rc-slip solves other "
                        "loads for elastic bodies only: %s",
                        more[k], remedy);
}

/* ---- frames ---- */

void
slip_set_keys(struct slip_run *run, struct rc_grid *g, bool converged, double load, double approach)
{
    struct tool *t = &run->d.t;

    tool_set(t, g, "converged", converged && !map_says(g, "converged", "no") ? "yes" : "no");
    map_set_boundary(t, g, run->boundary);
    if (tool_given(t, "E1"))
        bodies_set(t, g, &run->bodies.pair, NULL);
    tool_sign(t, g);
    if (run->bodies.pair.estar > 0)
        tool_set_number(t, g, "nu", run->bodies.nu);
    if (run->number != rc_grid_case(run->p))
        tool_set_number(t, g, "case", (double)run->number);
    tool_set_number(t, g, "load", load);
    tool_set_number(t, g, "approach", approach);
    tool_set_number(t, g, "friction", run->args->mu);
    tool_set_number(t, g, "tau_max", run->args->tau_max);
}

/* The error of the pressure of a state that was solved. Between dissimilar bodies the tractions change the
 * pressure by about beta |q|, where |q| is at most mu p. Their errors change it likewise: in 12 random
 * contacts by 0.35 to 0.78 of beta times the error. */
static double
pressure_error(const struct slip_run *run, const struct rc_model *m)
{
    const struct slip_state *s = &run->state;
    const struct rc_friction_increment *f = &s->figures.last;
    const double own = rc_model_number(m, "pressure_error_estimate");

    return run->alternates ? own + fabs(run->bodies.beta) * s->traction_error * f->limit / f->load
                           : own;
}

static void
set_keys(struct drive *d, const struct rc_model *m, struct rc_grid *g)
{
    struct slip_run *run = (struct slip_run *)(void *)d;
    const struct slip_state *s = &run->state;
    const struct rc_friction_increment *f = &s->figures.last;
    bool apart = f->stick_nodes + f->slip_nodes == 0;

    if (run->alternates || (run->solves && s->corner->load != run->load))
        tool_set_error(&d->t, g, "pressure.error", pressure_error(run, m));
    slip_set_keys(run, g, s->converged, f->load, s->figures.approach);
    tool_set_error(&d->t, g, "traction.error", s->traction_error);
    tool_set_number(&d->t, g, "tangential_x", f->force[0]);
    tool_set_number(&d->t, g, "tangential_y", f->force[1]);
    tool_set_number(&d->t, g, "displacement_x", apart ? NAN : f->displacement[0]);
    tool_set_number(&d->t, g, "displacement_y", apart ? NAN : f->displacement[1]);
}

/* ---- corners ---- */

/* The approach at a state; if unknown, the approach of the stream, provided that the load is the same. */
static double
approach_of(const struct slip_run *run, const struct slip_state *s)
{
    double own;

    if (isfinite(s->figures.approach) || s->corner->load != run->load ||
        !rc_grid_number(run->p, "approach", &own))
        return s->figures.approach;
    return own;
}

/* Finds the figures at a corner, the parts of its error, and whether their sum is within the goal. */
static void
find_state(struct slip_run *run, const struct rc_model *m, struct slip_state *s)
{
    struct rc_friction_figures *f = &s->figures;

    s->corner = &run->corner[run->d.at];
    *f = *rc_friction_result(m);
    f->approach = approach_of(run, s);
    s->dissipated_total += f->last.dissipated;
    s->errors = (struct error_parts){.told = true,
                                     .increment = f->increment_error,
                                     .inherited = f->inherited_error,
                                     .iteration = f->traction_error,
                                     .contact = f->contact_error};
    s->traction_error = errors_sum(&s->errors);
    s->converged = f->converged && tool_interrupted() == 0 &&
                   (errors_within(s->traction_error, slip_goal(run)) ||
                    (run->increments > 0 && isnan(s->traction_error)));
}

/* Makes the model of the contact. It has the tolerance of friction, or less if both are solved alternately.
 * Without heights it is never solved. */
static struct rc_model *
new_contact(const struct slip_run *run, double tol, struct rc_err *err)
{
    const struct rc_problem problem = {.boundary = run->boundary,
                                       .pair = run->bodies.pair,
                                       .threads = run->d.t.threads,
                                       .ranks = ranks_of(&run->d.t),
                                       .tol = run->alternates ? tol / 4 : tol};

    return rc_elastic_new(rc_shape_of(run->p), run->solves ? run->height->v : run->p->v, &problem,
                          NULL, err);
}

static struct rc_model *
new_model(struct slip_run *run)
{
    struct rc_friction_problem law = run->law;
    const double tol = law.law.tol;

    for (size_t j = 0; j < law.fewer && run->alternates; j++)
        law.inner_of_fewer[j] =
            tool_made(&run->d.t, run->p, new_contact(run, tol / 10, &run->d.t.err));
    return tool_made(&run->d.t, run->p,
                     rc_friction_new(new_contact(run, tol, &run->d.t.err),
                                     run->solves ? run->height->v : NULL, &law, &run->d.t.err));
}

/* Adds the straight way of slip from the last corner to this one. */
static void
add_slip(struct slip_run *run, struct rc_model *m)
{
    const size_t n = rc_grid_nodes(run->p);
    double *x = run->slipped, *y = x + n, *way = y + n, *now;
    struct tool *t = &run->d.t;

    if (x == NULL)
        return;
    now = tool_room(t, 2 * n, sizeof *now, "the slip");
    tool_must(t, run->p, rc_model_frame(m, "slip-x", now, &t->err));
    tool_must(t, run->p, rc_model_frame(m, "slip-y", now + n, &t->err));
    for (size_t k = 0; k < n; k++)
        way[k] += hypot(now[k] - x[k], now[n + k] - y[k]);
    memcpy(x, now, 2 * n * sizeof *now);
    free(now);
}

/* The tool holds the heights and, without rolling, the path of slip; NULL: a frame of the model. */
const double *
slip_frame(struct drive *d, struct rc_model *m, struct rc_grid *frame, const char *word)
{
    struct slip_run *run = (struct slip_run *)(void *)d;
    const size_t n = rc_grid_nodes(frame);

    (void)m;
    if (strcmp(word, slip_frames[SLIP_HEIGHT]) == 0)
        return run->height->v;
    if (run->slipped == NULL || strcmp(word, slip_frames[SLIP_LENGTH]) != 0)
        return NULL;
    memcpy(frame->v, run->slipped + 2 * n, n * sizeof *frame->v);
    memset(run->slipped + 2 * n, 0, n * sizeof *frame->v);
    return frame->v;
}

/* The state of the model has the dissipation if it is wanted. */
static void
mark(struct drive *d)
{
    const struct slip_run *run = (struct slip_run *)(void *)d;

    course_mark(&d->course, MARK_OPTION, "output", run->law.dissipation ? "dissipation" : "");
}

static void
begin(struct drive *d, struct rc_model *m)
{
    struct slip_run *run = (struct slip_run *)(void *)d;

    (void)m;
    run->number += !run->corner[d->at].silent;
}

static void
judge(struct drive *d, struct rc_model *m)
{
    struct slip_run *run = (struct slip_run *)(void *)d;
    struct slip_state *s = &run->state;

    find_state(run, m, s);
    add_slip(run, m);
    if (!s->converged)
        tool_fails_with(&d->t, EXIT_SHORT);
    d->is.silent = s->corner->silent && tool_interrupted() == 0;
    if (!d->is.silent) {
        slip_judge(run, s);
        drive_tell(d, m);
    }
}

/* Solves the corners one after another, until a signal comes. */
static void
follow(struct slip_run *run)
{
    static const char *const tells[] = {"tangential_x",
                                        "tangential_y",
                                        "displacement_x",
                                        "displacement_y",
                                        "stick_fraction",
                                        "largest_slip_total",
                                        "dissipated_energy",
                                        "increment_error_estimate",
                                        "increments",
                                        "convolutions",
                                        NULL};
    struct drive *d = &run->d;

    if (run->args->output >> SLIP_LENGTH & 1)
        run->slipped =
            tool_room(&d->t, 3 * rc_grid_nodes(run->p), sizeof *run->slipped, "the slip");
    run->state = (struct slip_state){.dissipated_total = 0};
    d->calls.frame = slip_frame;
    d->unit = "m";
    d->tells = tells;
    d->calls.mark = mark;
    d->calls.begin = begin;
    d->calls.judge = judge;
    d->calls.all_keys = set_keys;
    d->calls.row = slip_report;
    d->points = run->corners;
    d->point = tool_room(&d->t, run->corners, sizeof *d->point, "a path");
    for (size_t k = 0; k < run->corners; k++)
        d->point[k] = slip_point(&run->corner[k]);
    drive_points(d, run->p, new_model(run));
    free(d->point);
    free(run->slipped);
    run->slipped = NULL;
    d->point = NULL;
}

/* ---- a case ---- */

/* The memory for friction and contacts, maps, and the state at the previous corner. The work of all
 * increments, measured on rough contacts and balls. */
static struct rc_expected
forecast(struct slip_run *run)
{
    const double passes = 2; /* seconds of a convolution, in sums */
    const double tol = isnan(run->args->tol) ? 1e-4 : run->args->tol;
    const double increment = 16 * fmax(1 + log10(1e-4 / tol) / 7, 0.3); /* convolutions of one */
    const double runs = 2 - pow(0.5, (double)run->law.fewer); /* with half of them, and a quarter */
    double work = 0;
    /* bytes a node, measured on 1024 x 1024 nodes: free, periodic; second row: dissimilar bodies */
    static const double bytes[2][2] = {{335, 240}, {367, 260}};
    static const double history = 57;            /* of a further way */
    static const double tractions[2] = {33, 49}; /* of all further ways together */
    const struct rc_problem contact = {.boundary = run->boundary,
                                       .pair = run->bodies.pair,
                                       .load = fmax(run->load, 1),
                                       .ranks = ranks_of(&run->d.t),
                                       .threads = run->d.t.threads};
    const size_t more = run->law.fewer, ways = 1 + more;
    /* maps of the passes of dissimilar bodies, of the first way and of the others; of the lag; of the state
     * of each way; of the known contact */
    const size_t maps =
        (run->alternates ? (more > 0 ? 10u : 6u) : 2u) + (more > 0 ? 2 : 0) + 8 * ways + 2;
    const double nodes = (double)rc_grid_nodes(run->p);
    struct rc_expected all = {0}, solver = {0};
    double each;

    tool_must(&run->d.t, run->p,
              rc_solver_expect(rc_shape_of(run->p), &contact, &solver, &run->d.t.err));
    each = solver.seconds / solver.convolutions;
    for (size_t k = 0; k < run->corners; k++)
        if (run->alternates || !run->corner[k].silent)
            work += runs * (double)run->corner[k].leg.increments * slip_passes(run);
    all.convolutions = work * (increment + (run->alternates ? solver.convolutions : 0));
    all.seconds = work * each * (passes * increment + (run->alternates ? solver.convolutions : 0));
    if (!run->solves)
        solver.memory = 0;
    all.memory =
        (size_t)(nodes *
                 (rc_by_padding(run->boundary, bytes[run->coupled][0], bytes[run->coupled][1]) +
                  history * (double)more + (more > 0 ? tractions[run->coupled] : 0))) +
        (run->alternates ? ways : 1) * solver.memory + maps * (size_t)nodes * sizeof(double);
    return all;
}

void
slip_case(struct slip_run *run)
{
    check_pressure(run);
    check_beside(run, run->gap);
    check_beside(run, run->height);
    run->boundary = contact_boundary(&run->d.t, run->p, &run->args->repeats);
    if (run->args->output >> SLIP_HEIGHT & 1 && run->height == NULL)
        tool_refuse(&run->d.t, run->p,
                    "--output height: there is no height beside it: take all that rc-solve writes");
    slip_find_bodies(run);
    run->motion->move(run);
}

/* ---- the row ---- */

/* The last row: without other motions there is a path. */
static bool
ask(const struct slip_args *args)
{
    (void)args;
    return true;
}

static void
move(struct slip_run *run)
{
    struct rc_expected expected;
    size_t told = 0;

    slip_plan_path(run);
    check_solvable(run);
    for (size_t k = 0; k < run->corners; k++)
        told += !run->corner[k].silent;
    if (told == 1 && rc_grid_case(run->p) > run->number)
        run->number = rc_grid_case(run->p) - 1;
    slip_judge_plan(run);
    expected = forecast(run);
    if (run->args->drive.dry_run) {
        slip_say_plan(run, &expected);
    } else {
        tool_demand_memory(&run->d.t, run->p, expected.memory);
        follow(run);
    }
    free(run->corner);
}

static bool
report(struct report *r, const struct slip_run *run, const struct rc_model *m)
{
    const struct slip_state *s = &run->state;
    struct rc_friction_figures f = s->figures;
    const struct figures from[] = {{rc_figures("friction"), &f}, {NULL, NULL}};

    (void)m;
    if (f.last.stick_nodes + f.last.slip_nodes == 0)
        f.last.displacement[0] = f.last.displacement[1] = NAN;
    report_named(r, from,
                 "load limit tangential_x tangential_y displacement_x displacement_y approach "
                 "stick_nodes slip_nodes stick_area slip_area stick_fraction largest_slip "
                 "tangential_stiffness dissipated_energy");
    report_value(r, "dissipated_total", s->dissipated_total);
    report_count(r, "increments", s->corner->leg.increments, NULL);
    report_named(r, from, "passes convolutions");
    report_number(r, "traction_error_estimate", s->traction_error, NULL);
    errors_report(r, &s->errors);
    return s->converged;
}

static void
report_last(struct report *r, const struct slip_run *run)
{
    const struct figures from[] = {{rc_figures("friction"), &run->state.figures}, {NULL, NULL}};

    report_named(r, from, "largest_slip_total");
}

static const struct slip_motion slip_motion_path = {.ask = ask,
                                                    .read = slip_read_path,
                                                    .move = move,
                                                    .report = report,
                                                    .report_last = report_last,
                                                    .tol = 1e-4,
                                                    .work = "",
                                                    .uncoupled = "--coupling goodman"};
const struct slip_motion *const slip_motions[] = {&slip_motion_steady, &slip_motion_rolling,
                                                  &slip_motion_path, NULL};
