/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rolling under the pressure of the stream: its options, its model, and its plan. */
#include "slip.h"

#include <math.h>
#include <string.h>

#include "formats/core/core.h"

enum {
    COMPONENTS = 3 /* of --creep: along x, along y, spin */
};

static struct {
    struct numbers creep[COMPONENTS]; /* of --creep: 1, 1, rad/m; n = 0: not given */
    size_t cases;                     /* points of each case of the input          */
    struct rc_point *point;
    struct rc_model *path; /* rolls from case to case; NULL: not yet */
    double first[9];       /* its grid, boundary and bodies */
    struct rc_rolling_contact known;
    double position; /* m, of the last case; NAN: unknown    */
} own = {.position = NAN, .cases = 1};

static bool
forced(const struct slip_run *run)
{
    return run->args->creep_force.n > 0;
}

static bool
ask(const struct slip_args *a)
{
    return a->creep != NULL || a->creep_force.n > 0;
}

static bool
ask_steady(const struct slip_args *a)
{
    return a->steady && ask(a);
}

/* Reads a component of --creep, text[0..n). */
static void
read_component(struct tool *t, int k, const char *text, size_t n)
{
    RC_OWNED char *one = tool_room(t, n + 1, 1, "a creepage");

    memcpy(one, text, n);
    one[n] = '\0';
    if (unit_numbers(one, k == 2 ? UNIT_SPIN : UNIT_CREEP, &own.creep[k], &t->err) != RC_OK)
        tool_usage(t, "--creep %s: %s", one, t->err.text);
    if (k < 2)
        creep_judge(t, one, own.creep[k].v, own.creep[k].n);
}

/* Each component is a number or a range; ranges have one length, and a number holds for all cases.
 * One component alone is the creepage along x. */
static void
read_creep(struct tool *t, const struct slip_args *a)
{
    const char *s = a->creep;
    int components = 1;

    for (const char *comma = s; (comma = strchr(comma, ',')) != NULL; comma++)
        components++;
    if (components > COMPONENTS)
        tool_usage(t,
                   "--creep %s: it must be a creepage along x, or two (x and y), or these and a "
                   "spin, as in 1e-3,0,20",
                   s);
    for (int k = 0; k < components; k++) {
        const size_t n = strcspn(s, ",");
        read_component(t, k, s, n);
        s += n + 1;
        if (own.creep[k].n > 1 && own.cases > 1 && own.creep[k].n != own.cases)
            tool_usage(t,
                       "--creep %s: its ranges have %zu and %zu values: give them the same number",
                       a->creep, own.cases, own.creep[k].n);
        if (own.creep[k].n > 1)
            own.cases = own.creep[k].n;
    }
    if (components == 1)
        read_component(t, 1, "0", 1);
    if (own.cases > 1 && !a->steady)
        tool_usage(t,
                   "--creep %s: a range is for --steady, where each value is a case of its own; "
                   "a contact that rolls from case to case has one creepage",
                   a->creep);
}

static void
read(struct slip_run *run, struct slip_args *a)
{
    struct tool *t = &run->d.t;

    if (forced(run) && a->creep_force.n > 2)
        tool_usage(t,
                   "--creep-force: it must be one value (along x) or two (x and y), as in 36N,0");
    if (!forced(run))
        read_creep(t, a);
    own.point = tool_room(t, own.cases, sizeof *own.point, "the creepages");
    if (run->coupling == RC_COUPLING_FULL)
        run->coupling = RC_COUPLING_GOODMAN;
}

/* ---- a point ---- */

/* Point k of this case. */
static struct rc_point
point_of(const struct slip_run *run, size_t k)
{
    static const enum rc_axis axis[COMPONENTS] = {RC_CREEP_X, RC_CREEP_Y, RC_SPIN};
    const struct numbers *f = &run->args->creep_force;
    struct rc_point to = {0};

    rc_point_set(&to, RC_LOAD, run->load);
    if (forced(run)) {
        rc_point_set(&to, RC_TANGENTIAL_X, f->v[0]);
        rc_point_set(&to, RC_TANGENTIAL_Y, f->n > 1 ? f->v[1] : 0);
    }
    for (int c = 0; c < COMPONENTS; c++)
        if (own.creep[c].n > 0)
            rc_point_set(&to, axis[c], own.creep[c].v[own.creep[c].n > 1 ? k : 0]);
    if (!isnan(own.position))
        rc_point_set(&to, RC_POSITION, own.position);
    return to;
}

static void
begin(struct drive *d, struct rc_model *m)
{
    struct slip_run *run = (struct slip_run *)(void *)d;

    (void)m;
    run->number = d->course.number;
}

static void
set_keys(struct drive *d, const struct rc_model *m, struct rc_grid *g)
{
    struct slip_run *run = (struct slip_run *)(void *)d;
    const struct rc_rolling_figures *f = rc_rolling_result(m);
    double approach = NAN;

    (void)rc_grid_number(g, "approach", &approach);
    slip_set_keys(run, g, d->status == RC_OK, f->load, approach);
    tool_set_error(&d->t, g, "traction.error", rc_model_number(m, "traction_error_estimate"));
    tool_set_number(&d->t, g, "creep_x", f->creep[0]);
    tool_set_number(&d->t, g, "creep_y", f->creep[1]);
    tool_set_number(&d->t, g, "spin", f->spin);
    tool_set_number(&d->t, g, "tangential_x", f->force[0]);
    tool_set_number(&d->t, g, "tangential_y", f->force[1]);
}

/* ---- a case ---- */

/* Takes the positions of the contact and of the map, and checks them against the case before. */
static void
find_position(struct slip_run *run)
{
    const bool steady = run->args->steady;
    double position = NAN;

    (void)rc_grid_number(run->p, "position", &position);
    if (!steady && isnan(position))
        tool_refuse(&run->d.t, run->p,
                    "it has no key position, and rolling from case to case needs the positions of "
                    "rc-solve --travel: give --steady for steady rolling under one pressure");
    if (steady && (own.position < position || own.position > position))
        tool_refuse(&run->d.t, run->p,
                    "its position is %g m, that of the case before %g m: in steady rolling the "
                    "pressure does not change; leave out --steady to roll from case to case",
                    position, own.position);
    own.position = position;
    own.known = (struct rc_rolling_contact){.p = run->p->v};
    (void)rc_grid_number(run->p, "window_x", &own.known.x);
}

static struct rc_model *
new_model(struct slip_run *run)
{
    const struct rc_problem contact = {.boundary = run->boundary,
                                       .pair = run->bodies.pair,
                                       .threads = run->d.t.threads,
                                       .ranks = ranks_of(&run->d.t)};
    const struct rc_rolling_problem law = {
        .law = run->law.law, .force = forced(run), .path = !run->args->steady, .known = &own.known};
    return tool_made(&run->d.t, run->p,
                     rc_rolling_new(rc_elastic_new(rc_shape_of(run->p), run->p->v, &contact, NULL,
                                                   &run->d.t.err),
                                    &law, &run->d.t.err));
}

/* The model of a path serves all its cases, which differ in pressure and position only. */
static struct rc_model *
model_of(struct slip_run *run)
{
    const struct rc_grid *p = run->p;
    const struct slip_pair *b = &run->bodies;
    const struct rc_boundary on = run->boundary;
    const double now[] = {(double)p->nx, (double)p->ny, p->dx,  p->dy,  on.x,
                          on.y,          on.datum,      b->kap, b->beta};

    if (run->args->steady)
        return new_model(run);
    if (own.path == NULL) {
        own.path = new_model(run);
        tool_must(&run->d.t, p, /* the map of this case is freed before the next one */
                  rc_model_set_heights(own.path, p->v, &run->d.t.err));
    } else if (memcmp(now, own.first, sizeof own.first) != 0)
        tool_refuse(&run->d.t, p,
                    "its grid, boundary or bodies differ from those of the case before: roll over "
                    "the cases of one rc-solve --travel");
    memcpy(own.first, now, sizeof own.first);
    return own.path;
}

static const struct drive_advice advice[] = {
    {"discretization_error_estimate",
     "take a finer map, or the extrapolated figures of the report"},
    {NULL, NULL}};

static void
move(struct slip_run *run)
{
    static const char *const tells[] = {"tangential_x", "tangential_y",   "creep_x",
                                        "creep_y",      "stick_fraction", "power_slip",
                                        "steps",        "convolutions",   NULL};
    struct drive *d = &run->d;
    struct rc_expected expected;
    struct rc_model *m;

    find_position(run);
    for (size_t k = 0; k < own.cases; k++)
        own.point[k] = point_of(run, k);
    run->coupled = run->bodies.beta != 0 && run->coupling == RC_COUPLING_GOODMAN;
    run->law = slip_law(run);
    run->law.law.uncoupled = !run->coupled;
    run->law.law.tol = isnan(run->args->tol) ? 0 : run->args->tol;
    if (own.path == NULL)
        slip_judge_plan(run);
    m = model_of(run);
    tool_must(&d->t, run->p, rc_model_plan(m, own.point, &expected, &d->t.err));
    if (d->args->dry_run) {
        expected.convolutions *= (double)own.cases;
        expected.seconds *= (double)own.cases;
        slip_say_plan(run, &expected);
        if (m != own.path)
            rc_model_free(m);
        return;
    }
    tool_demand_memory(&d->t, run->p, m == own.path && run->number > 0 ? 0 : expected.memory);
    d->is.lasts = m == own.path;
    d->calls.frame = slip_frame;
    d->unit = "m";
    d->advice = advice;
    d->tells = tells;
    d->calls.begin = begin;
    d->calls.all_keys = set_keys;
    d->calls.row = slip_report;
    d->points = own.cases;
    d->point = own.point;
    d->course.number = rc_grid_case(run->p) > run->number ? rc_grid_case(run->p) - 1 : run->number;
    drive_points(d, run->p, m);
    d->point = NULL;
}

static void
close(void)
{
    rc_model_free(own.path);
}

static bool
report(struct report *r, const struct slip_run *run, const struct rc_model *m)
{
    const struct figures from[] = {{rc_figures("rolling"), rc_rolling_result(m)}, {NULL, NULL}};

    report_number(r, "position", own.position, "m");
    report_named(
        r, from,
        "load limit creep_x creep_y spin tangential_x tangential_y moment stick_nodes "
        "slip_nodes stick_fraction power power_slip extrapolated_creep_x "
        "extrapolated_creep_y extrapolated_tangential_x extrapolated_tangential_y "
        "extrapolated_moment ellipse_x ellipse_y kalker_c11 kalker_c22 kalker_c23 "
        "kalker_tangential_x kalker_tangential_y fastsim_tangential_x fastsim_tangential_y "
        "steps convolutions "
        "traction_error_estimate discretization_error_estimate");
    return run->d.status == RC_OK;
}

const struct slip_motion slip_motion_steady = {.ask = ask_steady,
                                               .read = read,
                                               .move = move,
                                               .report = report,
                                               .tol = 1e-3,
                                               .work = ", steady rolling",
                                               .uncoupled = "rolling"};
/* From case to case. */
const struct slip_motion slip_motion_rolling = {.ask = ask,
                                                .read = read,
                                                .move = move,
                                                .report = report,
                                                .close = close,
                                                .tol = 1e-2,
                                                .work = ", each position of a path",
                                                .uncoupled = "rolling"};
