/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rolling under the pressure of the stream: its options, its model, and its plan. */
#include "slip.h"

#include <math.h>
#include <string.h>

#include "formats/core/core.h"

static struct {
    struct rc_model *path; /* rolls from case to case; NULL: not yet */
    double first[9];       /* its grid, boundary and bodies */
    struct rc_rolling_contact known;
    double position; /* m, of the last case; NAN: unknown    */
} own = {.position = NAN};

static bool
forced(const struct slip_run *run)
{
    return run->args->creep_force.n > 0;
}

static bool
ask(const struct slip_args *a)
{
    return a->creep.n > 0 || a->creep_force.n > 0;
}

static bool
ask_steady(const struct slip_args *a)
{
    return a->steady && ask(a);
}

static void
read(struct slip_run *run, struct slip_args *a)
{
    struct tool *t = &run->d.t;
    const char *which = forced(run) ? "creep-force" : "creep";

    if (forced(run) ? a->creep_force.n > 2 : a->creep.n < 2 || a->creep.n > 3)
        tool_usage(t, "--%s: it must be %s", which,
                   forced(run) ? "one value (along x) or two (x and y), as in 36N,0"
                               : "two creepages (x and y), or these and a spin, as in 1e-3,0,20");
    if (run->coupling == RC_COUPLING_FULL)
        run->coupling = RC_COUPLING_GOODMAN;
}

/* ---- a point ---- */

static struct rc_point
point_of(const struct slip_run *run)
{
    const struct numbers *v = forced(run) ? &run->args->creep_force : &run->args->creep;
    const enum rc_axis x = forced(run) ? RC_TANGENTIAL_X : RC_CREEP_X;
    struct rc_point to = {0};

    rc_point_set(&to, RC_LOAD, run->load);
    rc_point_set(&to, x, v->v[0]);
    rc_point_set(&to, x + 1, v->n > 1 ? v->v[1] : 0);
    if (v->n > 2)
        rc_point_set(&to, RC_SPIN, v->v[2]);
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
    const struct rc_problem contact = {
        .boundary = run->boundary, .pair = run->bodies.pair, .threads = run->d.t.threads};
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
    struct drive *d = &run->d;
    struct rc_point to;
    struct rc_expected expected;
    struct rc_model *m;

    find_position(run);
    to = point_of(run);
    run->coupled = run->bodies.beta != 0 && run->coupling == RC_COUPLING_GOODMAN;
    run->law = slip_law(run);
    run->law.law.uncoupled = !run->coupled;
    run->law.law.tol = isnan(run->args->tol) ? 0 : run->args->tol;
    if (own.path == NULL)
        slip_judge_plan(run);
    m = model_of(run);
    tool_must(&d->t, run->p, rc_model_plan(m, &to, &expected, &d->t.err));
    if (d->args->dry_run) {
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
    d->calls.begin = begin;
    d->calls.all_keys = set_keys;
    d->calls.row = slip_report;
    d->points = 1;
    d->point = &to;
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
    report_named(r, from,
                 "load limit creep_x creep_y spin tangential_x tangential_y moment stick_nodes "
                 "slip_nodes stick_fraction power power_slip extrapolated_creep_x "
                 "extrapolated_creep_y extrapolated_tangential_x extrapolated_tangential_y "
                 "extrapolated_moment kalker_tangential_x kalker_tangential_y steps convolutions "
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
