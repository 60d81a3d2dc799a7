/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * --relaxation with --speed: body 2 slides steadily over the viscoelastic body 1, a case a speed. One load
 * has a list of speeds, one speed a list of loads, and lists of equal length belong together.
 */
#include "solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

static struct {
    struct numbers speed;
    const char *along, *track; /* x or y; fresh or repeated  */
} args = {.along = "x", .track = "fresh"};

static struct {
    struct rc_relaxation *material; /* of E/(1 - nu^2) */
    const struct rc_sliding_figures *found;
    struct rc_sliding_figures shown; /* the same at the speed asked for    */
    struct numbers real;             /* speeds asked for, if several shifts make others of them */
} own;

/* clang-format off */
static const struct opt options[] = {
    {.name = "speed", .type = OPT_NUMBERS, .unit = UNIT_SPEED, .base = &args.speed, .min = -INFINITY,
     .max = INFINITY, .result = true, .points = true, .arg = "LIST",
     .needs = RULES({.with = "relaxation", .because = "it needs the material of body 1"}),
     .against = RULES({.with = "time", .because = "a steady state has no time"},
                      {.with = "history", .because = "each case is a steady state of its own"},
                      {.with = "layer|stiffness|conductivity", .because = "it is not implemented"}),
     .help = "with --relaxation, body 2 slides steadily over body 1: m/s along +x, each a case"},
    {.name = "along", .type = OPT_CHOICE, .base = &args.along, .result = true, .arg = "x|y",
     .needs = RULES({.with = "speed"}),
     .help = "direction in which it slides (default x)"},
    {.name = "track", .type = OPT_CHOICE, .base = &args.track, .result = true, .arg = "fresh|repeated",
     .needs = RULES({.with = "speed"}, {.with = "periodic", .word = "repeated",
                                        .because = "only a map that repeats has one"}),
     .help = "whether it meets its own grooves again after a period (default fresh)"},
    {.name = NULL},
};
/* clang-format on */

static bool
slides_along_y(void)
{
    return strcmp(args.along, "y") == 0;
}

static bool
repeats(void)
{
    return strcmp(args.track, "repeated") == 0;
}

/* ---- the command line ---- */

/* The relaxation of E/(1 - nu^2) of body 1. */
static void
make_material(struct run *run)
{
    const struct rc_relaxation *m = run->material->material;
    const double nu = run->physics->nu1, plane = 1 - nu * nu;
    double *modulus = malloc((m->terms + 1) * sizeof *modulus);
    struct rc_err err = {"out of memory for the material"};

    for (size_t k = 0; k < m->terms && modulus != NULL; k++)
        modulus[k] = m->modulus[k] / plane;
    if (modulus != NULL)
        own.material = rc_relaxation_new(m->relaxed / plane, m->terms, modulus, m->time, &err);
    free(modulus);
    if (own.material == NULL)
        tool_usage(&run->d.t, "--relaxation: %s", err.text);
}

static bool
ask(struct run *run)
{
    (void)run;
    return args.speed.n > 0;
}

/* A list of shifts: body 1 at the factor a and the speed v is that at the factor 1 and the speed a v. */
static void
reduce_speeds(struct run *run)
{
    const struct numbers *factor = &run->material->shift->factor;
    const size_t n = factor->n, speeds = args.speed.n;
    struct tool *t = &run->d.t;
    double *reduced;

    if (speeds != 1 && speeds != n)
        tool_usage(t,
                   "--speed has %zu values, and --shift or --temperature %zu: give lists of equal "
                   "length, or one speed",
                   speeds, n);
    own.real = (struct numbers){tool_room(t, n, sizeof *own.real.v, "the speeds"), n, false, false};
    reduced = tool_room(t, n, sizeof *reduced, "the speeds");
    for (size_t k = 0; k < n; k++) {
        own.real.v[k] = args.speed.v[speeds > 1 ? k : 0];
        reduced[k] = own.real.v[k] * factor->v[k];
    }
    free(args.speed.v);
    args.speed.v = reduced;
    args.speed.n = n;
    run->asked = own.real.v;
}

static void
read(struct run *run)
{
    struct tool *t = &run->d.t;

    if (!(run->material->material->relaxed > 0))
        tool_usage(
            t, "--relaxation: the relaxed modulus is 0: body 2 would sink without end, and there "
               "is no steady state for --speed");
    if (run->material->shift != NULL)
        reduce_speeds(run);
    if (run->steps->n > 1 && args.speed.n > 1 && run->steps->n != args.speed.n)
        tool_usage(t,
                   "--speed has %zu values, and the list of loads or approaches %zu: give lists of "
                   "equal length, or one load or one speed",
                   args.speed.n, run->steps->n);
    make_material(run);
}

/* ---- the model ---- */

static struct rc_model *
make(struct run *run, const struct rc_problem *problem)
{
    const struct physics *a = run->physics;
    const struct rc_sliding_problem law = {
        .material = own.material,
        .compliance = fmax(1 / a->surface_estar - (1 - a->nu1 * a->nu1) / a->e1, 0),
        .along_y = slides_along_y(),
        .repeats = repeats()};

    return tool_made(&run->d.t, run->g,
                     rc_sliding_new(rc_shape_of(run->g), run->g->v, problem, &law, &run->d.t.err));
}

static enum rc_status
expect(struct run *run, const struct rc_problem *problem, struct rc_expected *expected,
       struct rc_err *err)
{
    (void)problem;
    return rc_model_plan(run->model, &run->d.point[run->step], expected, err);
}

/* ---- results ---- */

static bool
look(struct run *run, struct rc_model *m, struct solution *s)
{
    const struct rc_sliding_figures *f = own.found = rc_sliding_result(m);
    struct rc_contact *c = &s->contact;

    c->approach = f->approach;
    c->iterations = f->iterations;
    c->convolutions = f->convolutions;
    c->pressure_error = f->pressure_error;
    c->elastic_energy = f->elastic_energy;
    c->converged = f->converged;
    own.shown = *f;
    if (own.real.n > 0) {
        own.shown.speed = own.real.v[run->d.at];
        own.shown.dissipated_power = f->friction_force * fabs(own.shown.speed);
    }
    return true;
}

/* Those of the contacts are not all. */
static void
set_errors(struct run *run, struct solution *s)
{
    (void)run;
    s->contact.convolutions = own.found->convolutions;
}

/* Length of the map along the sliding direction, and the one of 8 nodes. */
static double
length_of(const struct run *run, bool map)
{
    const struct rc_grid *g = run->g;
    const bool y = slides_along_y();

    return (map ? (double)(y ? g->ny : g->nx) : 8) * (y ? g->dy : g->dx);
}

/* A wave of length L excites the material at the frequency |speed|/L. NULL: the table has this frequency. */
static const char *
wave_outside_to(char text[RELAXATION_OUTSIDE], const struct run *run, double length)
{
    const double omega = 2 * 3.141592653589793 * fabs(own.shown.speed) / length;

    return own.shown.speed == 0 ? NULL
                                : relaxation_outside_to(text, run->material, run->d.at, omega);
}

static void
warn_of_wave(struct run *run, const char *where, const char *waves, double length)
{
    char outside[RELAXATION_OUTSIDE];

    if (wave_outside_to(outside, run, length) != NULL)
        tool_warn(&run->d.t, "%s: at %s waves %s (%s) excite the material at %s", where,
                  shown_in_unit(fabs(own.shown.speed), "m/s"), waves, shown_in_unit(length, "m"),
                  outside);
}

static void
warn(struct run *run, const char *where)
{
    const double traction = 0.3;

    if (own.found->friction > traction)
        tool_warn(&run->d.t,
                  "%s: the coefficient of friction is %.3g, and the contact is that of smooth "
                  "bodies without friction: above %g the tractions along the surface change it",
                  where, own.found->friction, traction);
    warn_of_wave(run, where, "of 8 nodes", length_of(run, false));
    warn_of_wave(run, where, "as long as the map", length_of(run, true));
}

static bool
end(struct run *run, const char *where, const struct solution *s)
{
    if (tool_interrupted() == 0 && s->contact.contact_nodes > 0)
        warn(run, where);
    return false;
}

static void
set_keys(struct run *run, struct rc_grid *g)
{
    tool_set_number(&run->d.t, g, "speed",
                    own.real.n > 0 ? own.real.v[run->d.at] : run->d.point[run->d.at].at[RC_SPEED]);
}

static void
report_by_name(struct report *r, const char *names)
{
    const struct figures from[] = {{rc_figures("sliding"), own.found == NULL ? NULL : &own.shown},
                                   {NULL, NULL}};

    report_named(r, from, names);
}

static void
report(struct report *r, const struct run *run)
{
    (void)run;
    report_by_name(r,
                   "speed friction friction_force friction_error_estimate dissipated_power track "
                   "tan_delta_max contacts");
}

static void
report_last(struct report *r, const struct run *run)
{
    report_by_name(r, "friction_by_heights");
    solve_report_shift(r, run);
}

static void
report_range(struct report *r, const struct run *run)
{
    char text[RELAXATION_OUTSIDE];

    solve_report_extrapolated(r, wave_outside_to(text, run, length_of(run, false)) != NULL ||
                                     wave_outside_to(text, run, length_of(run, true)) != NULL);
}

static const char *
state(const struct run *run)
{
    static char text[128];

    (void)run;
    snprintf(text, sizeof text, "on: along %s, %s track", args.along, args.track);
    return text;
}

const struct effect solve_effect_sliding = {
    .name = "sliding",
    .title = "sliding",
    .options = options,
    .ask = ask,
    .read = read,
    .no_stiffness = "no --stiffness",
    .axis = RC_SPEED,
    .list = &args.speed,
    .noun = "speed",
    .base = make,
    .at_once = true,
    .by_gap = true,
    .expect = expect,
    .look = look,
    .errors = set_errors,
    .end = end,
    .keys = set_keys,
    .off = "left out: no --speed",
    .state = state,
    .report = report,
    .report_last = report_last,
    .report_end = report_range,
};
