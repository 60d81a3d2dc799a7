/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * --relaxation: body 1 is viscoelastic. With --time each case is a time: one load that acts from 0 s on has a
 * list of times, and a list of loads has the time of each.
 */
#include "solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

/* ---- the material ---- */

static struct {
    const char *law;                 /* words of the command line, or NULL */
    const char *shift, *temperature; /* a factor of all times, or a law for a temperature */
    struct numbers time;
} args;

static struct relaxation_law law;
static struct relaxation_shift shift;
static double shortest; /* s, between two times; 0: there are no times */
static double soonest;  /* s, from a change of the load to the next time; 0: there are no times */

static struct {
    struct numbers times; /* of the points */
    struct numbers real;  /* the times asked for, if several shifts make others of them */
    bool before;          /* the load acts before the first asked time */
    size_t increments;    /* on the command line; 0: auto */
    const struct rc_viscoelastic_figures *found;
} own;

/* clang-format off */
static const struct opt options[] = {
    {.name = "relaxation", .type = OPT_TEXT, .base = &args.law, .result = true,
     .arg = "EINF,E1:TAU1,...|FILE",
     .needs = RULES({.with = "time|speed", .because = "each case is a time or a speed"}),
     .against = RULES({.with = "E1 MODULUS", .because = "the moduli of body 1 are those of --relaxation",
                       .remedy = "leave out --E1 (or give --E1 rigid below a layer of it)"},
                      {.with = "estar", .because = "body 1 needs its Poisson's ratio",
                       .remedy = "give --nu1, and --E2 --nu2 or --E2 rigid"},
                      {.with = "hardness|yield|adhesion|travel", .because = "it is not implemented"},
                      {.with = "tilt free", .because = "the bodies move along their normal only"},
                      {.with = "discretization",
                       .remedy = "solve a coarser map in a second command instead"}),
     .help = "body 1 is viscoelastic: relaxed modulus and terms of E(t), or a file (instead of --E1)"},
    {.name = "shift", .type = OPT_TEXT, .base = &args.shift, .result = true,
     .arg = "LIST|wlf,C1,C2,T0|arrhenius,EA,T0",
     .needs = RULES({.with = "relaxation"}),
     .help = "multiply all times of --relaxation, by factors (default 1) or by the law of Williams, "
             "Landel and Ferry, or of Arrhenius, for --temperature; EA in J/mol"},
    {.name = "temperature", .type = OPT_TEXT, .base = &args.temperature, .result = true, .arg = "LIST",
     .needs = RULES({.with = "shift", .because = "it needs a law"}),
     .help = "temperatures of body 1 for --shift, as 40degC or 313K; several are a case each"},
    {.name = NULL},
};
static const struct opt time_options[] = {
    {.name = "time", .type = OPT_NUMBERS, .unit = UNIT_S, .base = &args.time, .min = 0, .max = INFINITY,
     .result = true, .points = true, .arg = "LIST",
     .needs = RULES({.with = "relaxation"}),
     .help = "with --relaxation, times of the loads or of the results of one load, each a case"},
    {.name = NULL},
};
/* clang-format on */

static void
refuse(struct run *run, bool given, const char *what, const char *why)
{
    if (given)
        tool_usage(&run->d.t, "--relaxation does not work with %s: %s", what, why);
}

static void
forget_relief(struct run *run)
{
    run->relief = "";
}

static bool
ask(struct run *run)
{
    struct physics *a = run->physics;
    struct tool *t = &run->d.t;

    if (args.law == NULL)
        return false;
    if (args.shift != NULL &&
        relaxation_shift_read(args.shift, args.temperature, &shift, &t->err) != RC_OK)
        tool_usage(t, "--shift %s: %s", args.shift, t->err.text);
    if (relaxation_law_read(&law, args.law, args.shift == NULL ? NULL : &shift, &t->err) != RC_OK)
        tool_usage(t, "--relaxation %s: %s", args.law, t->err.text);
    a->relaxes = 1 / law.material->instant;
    run->material = &law;
    return true;
}

/* A time t excites the material at the angular frequency 1/t. Case k has the time t times its factor. 1: this
 * frequency is above those of the table, -1: it is below them. */
static int
side_of(double t, size_t k, char text[RELAXATION_OUTSIDE])
{
    const double omega = 1 / (t * relaxation_factor(law.shift, k));

    return relaxation_outside_to(text, &law, k, omega) == NULL ? 0 : 1 / t > law.highest ? 1 : -1;
}

/* Warns of the time t of case k, if it is outside the table on this side, and says how many later cases are
 * there too. */
static void
warn_of_time(struct run *run, double t, size_t k, int side)
{
    char outside[RELAXATION_OUTSIDE], text[RELAXATION_OUTSIDE], others[64] = "";
    size_t later = 0;

    if (!(t > 0) || side_of(t, k, outside) != side)
        return;
    for (size_t i = k; i < args.time.n; i++)
        later += args.time.v[i] > t && side_of(args.time.v[i], i, text) == side;
    if (later > 0)
        snprintf(others, sizeof others, "; so it is in %zu later case%s", later,
                 later == 1 ? "" : "s");
    tool_warn(&run->d.t, "--time: %s excites the material at 1/(2 pi t), %s%s",
              shown_in_unit(t * relaxation_factor(law.shift, k), "s"), outside, others);
}

/* Of the shortest time after a change of the load, and of the first case that is too late. */
static void
warn_of_times(struct run *run)
{
    char text[RELAXATION_OUTSIDE];
    size_t k = 0;

    warn_of_time(run, soonest, args.time.v[0] > 0 ? 0U : 1U, 1);
    while (k < args.time.n && side_of(args.time.v[k], k, text) != -1)
        k++;
    if (k < args.time.n)
        warn_of_time(run, args.time.v[k], k, -1);
}

static void
warn_of_material(struct run *run)
{
    const struct rc_relaxation *m = law.material;
    const struct physics *a = run->physics;
    const double contradicts = 0.05, rubber = 0.45, nu = isinf(a->e1) ? a->layers[0].nu : a->nu1;

    if (law.misfit > contradicts)
        tool_warn(
            &run->d.t,
            "--relaxation: the terms differ from the measured moduli by %.2g (RMS, relative): "
            "the moduli are scattered, E(t) rises, or storage and loss contradict each other",
            law.misfit);
    if (m->relaxed == 0)
        tool_warn(&run->d.t, "--relaxation: the relaxed modulus is 0, so that body 1 flows without "
                             "end under a load: for a solid give its relaxed modulus, first as in "
                             "1MPa,9MPa:1ms, or in a line `inf E` of a table");
    if (args.time.n > 0) {
        warn_of_times(run);
    }
    if (isnan(law.misfit) && m->terms > 0 && soonest > 0 && soonest < m->time[0])
        tool_warn(&run->d.t,
                  "--time: %s passes %s, and the shortest relaxation time is %s: "
                  "there the "
                  "answer rests on the instantaneous modulus alone",
                  shown_in_unit(soonest, "s"),
                  run->steps->n > 1 ? "between two times" : "before the first result",
                  shown_in_unit(m->time[0], "s"));
    if (nu < rubber)
        tool_warn(&run->d.t,
                  "Poisson's ratio %g is constant in time, which holds for rubber (0.5): a "
                  "compressible polymer relaxes less in its volume than in shear",
                  nu);
}

/* The material may come from a file. */
static void
mark(struct run *run)
{
    const struct rc_relaxation *m = law.material;
    uint32_t crc = rc_crc32_add(0, &m->relaxed, sizeof m->relaxed);

    crc = rc_crc32_add(crc, m->modulus, m->terms * sizeof *m->modulus);
    crc = rc_crc32_add(crc, m->time, m->terms * sizeof *m->time);
    course_mark_crc(&run->d.course, MARK_FILE, "relaxation", crc);
}

static void
refuse_map(struct run *run)
{
    if (run->bound_varies)
        tool_refuse(&run->d.t, run->g, "--relaxation with a map of hardness is not implemented");
}

static const char *
state(const struct run *run)
{
    static char text[128];

    snprintf(text, sizeof text, "on: %zu terms, E from %s to %s", law.material->terms,
             shown_in_unit(run->physics->relaxes, "Pa"),
             shown_in_unit(law.material->relaxed, "Pa"));
    return text;
}

static void
report(struct report *r, const struct run *run)
{
    report_count(r, "relaxation_terms", law.material->terms, NULL);
    report_number(r, "relaxation_misfit", law.misfit, NULL);
    report_number(r, "modulus_instant", run->physics->relaxes, "Pa");
    report_number(r, "modulus_relaxed", law.material->relaxed, "Pa");
}

void
solve_report_shift(struct report *r, const struct run *run)
{
    report_number(r, "shift", relaxation_factor(&shift, run->d.at - own.before), NULL);
    report_number(r, "temperature", relaxation_kelvin(&shift, run->d.at - own.before), "K");
}

void
solve_report_extrapolated(struct report *r, int outside)
{
    if (law.highest < INFINITY)
        report_bool(r, "extrapolated", outside != 0);
    else
        report_text(r, "extrapolated", NULL); /* of given terms */
}

const struct effect solve_effect_relaxation = {
    .name = "relaxation",
    .title = "time",
    .options = options,
    .ask = ask,
    .read = forget_relief,
    .warn = warn_of_material,
    .take = refuse_map,
    .mark = mark,
    .off = "left out: no --relaxation",
    .state = state,
    .place = COLUMNS_LAST,
    .report = report,
};

/* ---- times ---- */

static bool
ask_time(struct run *run)
{
    (void)run;
    return args.time.n > 0;
}

/* A list of shifts: body 1 at the factor a and the time t is that at the factor 1 and the time t/a. */
static void
reduce_times(struct run *run)
{
    const size_t n = shift.factor.n, times = args.time.n;
    struct tool *t = &run->d.t;
    double *reduced;

    if (run->steps->n > 1)
        tool_usage(t, "a list of --shift or --temperature needs one load or approach with --time: "
                      "a history has one temperature");
    if (times != 1 && times != n)
        tool_usage(t,
                   "--time has %zu values, and --shift or --temperature %zu: give lists of equal "
                   "length, or one time",
                   times, n);
    own.real = (struct numbers){tool_room(t, n, sizeof *own.real.v, "the times"), n, false, false};
    reduced = tool_room(t, n, sizeof *reduced, "the times");
    for (size_t k = 0; k < n; k++) {
        own.real.v[k] = args.time.v[times > 1 ? k : 0];
        reduced[k] = own.real.v[k] / shift.factor.v[k];
        if (k > 0 && !(reduced[k] > reduced[k - 1]))
            tool_usage(t,
                       "case %zu relaxes less than the one before, %g s over the factor %g: put "
                       "the cases in the order of their times over their factors, as rising "
                       "temperatures are",
                       k + 1, own.real.v[k], shift.factor.v[k]);
    }
    free(args.time.v);
    args.time.v = reduced;
    args.time.n = n;
}

/* The time of a case as it was asked for. */
static double
real_time(const struct run *run)
{
    return run->asked != NULL ? run->asked[run->d.at] : own.found->time;
}

/* The time of the first load is 0. One load acts from 0 on, also if the first asked time is later. */
static void
check_times(struct run *run)
{
    const struct numbers *time = &args.time;
    struct tool *t = &run->d.t;

    if (run->steps->n > 1 && (time->v[0] > 0 || (time->n == 1 && time->v[0] == 0)))
        tool_usage(t,
                   "--time: %s: a list of loads or approaches is a history, which begins at 0 s "
                   "and has a time for each, as in --load 1N,2N --time 0,10; if they are "
                   "independent, run rc-solve once for each: for p in 1N 2N; do rc-solve --load "
                   "$p --time 10 ...; done",
                   shown_in_unit(time->v[0], "s"));
    if (run->steps->n > 1 && run->steps->n != time->n)
        tool_usage(t,
                   "--time has %zu values, and the list of loads or approaches %zu: give lists of "
                   "equal length, or one load",
                   time->n, run->steps->n);
    if (time->v[0] < 0)
        tool_usage(t, "--time: the first time is %g s: it must be 0 or above", time->v[0]);
    own.before = time->v[0] > 0;
    shortest = soonest = INFINITY;
    for (size_t k = 0; k < time->n; k++) {
        const double leg = time->v[k] - (k > 0 ? time->v[k - 1] : 0);
        if (!(leg >= 0) || isinf(leg) || (leg == 0 && k > 0 && run->steps->n == 1))
            tool_usage(t, "--time: %g s after %g s: the times must rise%s", time->v[k],
                       k > 0 ? time->v[k - 1] : 0,
                       run->steps->n > 1 ? ", or be equal at a jump" : "");
        if (leg > 0)
            shortest = fmin(shortest, leg);
        if (leg > 0 && (run->steps->n > 1 || isinf(soonest))) /* one load changes at 0 only */
            soonest = fmin(soonest, leg);
    }
    if (isinf(shortest))
        shortest = soonest = 0;
}

/* The times of the points. */
static void
set_times(struct run *run)
{
    const size_t before = own.before;

    own.times.n = args.time.n + before;
    own.times.v = tool_room(&run->d.t, own.times.n, sizeof *own.times.v, "the times");
    memcpy(own.times.v + before, args.time.v, args.time.n * sizeof *own.times.v);
    if (own.real.n > 0) {
        double *asked = tool_room(&run->d.t, own.times.n, sizeof *asked, "the times");

        memcpy(asked + before, own.real.v, own.real.n * sizeof *asked);
        run->asked = asked;
    }
}

static void
read_time(struct run *run)
{
    const struct physics *a = run->physics;
    const char *text = run->args->increments;
    struct tool *t = &run->d.t;
    char *end;

    refuse(run, a->layer.n > 0 && !(isinf(a->e1) && isinf(a->e2)), "--layer",
           "a layer must relax alone: give --E1 rigid and --E2 rigid");
    refuse(run, a->layer.n != a->relaxing_layers, "--layer",
           "all layers must relax alike: give " LAYER_RELAXES
           " for the modulus of each, as in 1mm," LAYER_RELAXES ",0.49");
    if (shift.factor.n > 1)
        reduce_times(run);
    check_times(run);
    set_times(run);
    if (text == NULL || strcmp(text, "auto") == 0)
        return;
    own.increments = strtoul(text, &end, 10);
    if (*end != '\0' || text[0] == '-' || own.increments < 2 ||
        own.increments > RC_YIELD_INCREMENTS)
        tool_usage(t, "--increments %s: it must be auto or a number from 2 to %d", text,
                   RC_YIELD_INCREMENTS);
}

static void
mark_times(struct run *run)
{
    struct course *c = &run->d.course;

    course_mark(c, MARK_POINT, "shortest time", rc_number(shortest));
    course_mark(c, MARK_POINT, "last time", rc_number(own.times.v[own.times.n - 1]));
}

/* ---- the model ---- */

/* Part of the tolerance for each contact. */
static const double of_contacts = 0.1;
/* Falls of the load that lower the tolerance of the contacts: further ones would demand more than double
 * precision has. */
static const double deepest = 1e-4;

/* The start of the load is not a case. */
static void
leave_start_out(struct run *run)
{
    run->cases -= own.before;
}

/* The largest fall of the load or approach, as the ratio of a value to an earlier one; 1 without a fall. */
static double
deepest_fall(const struct numbers *steps)
{
    double high = 0, part = 1;

    for (size_t k = 0; k < steps->n; k++) {
        high = fmax(high, steps->v[k]);
        if (steps->v[k] > 0)
            part = fmin(part, steps->v[k] / high);
    }
    return part;
}

/* Most of the tolerance is for the steps in time. The errors of the contacts remain in the bodies, where they
 * are larger beside a smaller load. */
static void
set_problem(struct run *run, struct rc_problem *problem)
{
    const double part = fmax(deepest_fall(run->steps), deepest),
                 usual = fmin(1e-3, pow((double)(run->g->nx * run->g->ny), -0.75));

    if (problem->tol > 0)
        problem->tol *= of_contacts * part;
    else if (part < 1)
        problem->tol = usual * part;
}

/* The times after the begin, which take steps. */
static double
later(const struct run *run)
{
    size_t n = 0;

    (void)run;
    for (size_t k = 0; k < own.times.n; k++)
        n += own.times.v[k] > 0;
    return fmax((double)n, 1);
}

/* Of body 1, in the compliance of the pair at once. */
static double
share_of(const struct physics *a)
{
    return isinf(a->e1) ? 1 : fmin(1, (1 - a->nu1 * a->nu1) / a->e1 * a->surface_estar);
}

static struct rc_model *
put_around(struct run *run, struct rc_model *inner)
{
    const struct rc_viscoelastic_problem problem = {.tol = run->args->tol * (1 - of_contacts),
                                                    .material = law.material,
                                                    .share = share_of(run->physics),
                                                    .shortest = shortest,
                                                    .longest = args.time.v[args.time.n - 1],
                                                    .points = (size_t)later(run),
                                                    .increments = own.increments};

    return tool_made(&run->d.t, run->g,
                     rc_viscoelastic_new(inner, run->g->v, &problem, &run->d.t.err));
}

/* The cost of the largest load of the history. */
static enum rc_status
expect(struct run *run, const struct rc_problem *problem, struct rc_expected *expected,
       struct rc_err *err)
{
    struct rc_point to = {0};
    size_t most = 0;

    (void)problem;
    for (size_t k = 0; k < run->steps->n; k++)
        if (run->steps->v[k] > run->steps->v[most])
            most = k;
    to = run->d.point[most < run->d.points ? most : 0];
    rc_point_set(&to, RC_TIME, 0);
    return rc_model_plan(run->model, &to, expected, err);
}

static void
begin(struct run *run, struct rc_model *m, const struct rc_problem *problem)
{
    (void)m, (void)problem;
    run->d.course.checkpoint = own.before && run->d.at == 0 ? NULL : run->d.checkpoint;
}

/* ---- results ---- */

/* E* at once over that of the time: the equivalent load over the load, and after a fall of the load at most
 * the creep of the whole time. */
static double
softening(const struct run *run)
{
    const struct rc_viscoelastic_figures *f = own.found;
    const double share = share_of(run->physics),
                 creep = rc_relaxation_compliance(law.material, f->time) / law.material->instant;

    return fmin(f->equivalent_load / f->contact.load, 1 - share + share * creep);
}

/* Takes the figures of a time. False: the start of a load, which is not a case. */
static bool
look(struct run *run, struct rc_model *m, struct solution *s)
{
    own.found = rc_viscoelastic_result(m);
    s->contact = own.found->contact;
    s->increments = (double)own.found->increments;
    s->softer = softening(run);
    run->apart = s->contact.contact_nodes == 0;
    if (run->d.at == 0 && own.before && tool_interrupted() == 0) {
        run->d.is.silent = true;
        run->d.course.number--;
        return false;
    }
    return true;
}

static void
set_errors(struct run *run, struct solution *s)
{
    s->contact.convolutions = own.found->contact.convolutions;
    if (!run->apart)
        s->errors =
            (struct error_parts){.told = true,
                                 .increment = own.found->increment_error,
                                 .inherited = s->contact.inherited_error,
                                 .contact = s->contact.pressure_error - own.found->increment_error -
                                            s->contact.inherited_error};
}

/* Warns of a time at which the steps are too long. */
static bool
end(struct run *run, const char *where, const struct solution *s)
{
    const struct rc_contact *c = &s->contact;

    if (c->converged || tool_interrupted() != 0 ||
        own.found->increment_error < c->pressure_error / 2)
        return false;
    course_warn(
        &run->d.course, "stopped short",
        "%s: the error of the steps in time is %.2g %% of the pressure: take more --increments "
        "than %zu",
        where, 100 * own.found->increment_error, own.increments > 0 ? own.increments : 320);
    return true;
}

static void
set_keys(struct run *run, struct rc_grid *g)
{
    tool_set_number(&run->d.t, g, "time", real_time(run));
}

static void
report_time(struct report *r, const struct run *run)
{
    struct rc_viscoelastic_figures shown = {0};
    const struct figures from[] = {{rc_figures("viscoelastic"), own.found == NULL ? NULL : &shown},
                                   {NULL, NULL}};

    if (own.found != NULL) {
        shown = *own.found;
        shown.time = real_time(run);
    }
    report_named(r, from, "time equivalent_load");
}

static void
report_range(struct report *r, const struct run *run)
{
    char text[RELAXATION_OUTSIDE];

    solve_report_extrapolated(r, side_of(own.times.v[run->d.at], run->d.at - own.before, text));
}

const struct effect solve_effect_time = {
    .title = "time",
    .options = time_options,
    .ask = ask_time,
    .read = read_time,
    .sequence = true,
    .mark = mark_times,
    .axis = RC_TIME,
    .list = &own.times,
    .points = leave_start_out,
    .noun = "time",
    .problem = set_problem,
    .outer = put_around,
    .at_once = true,
    .expect = expect,
    .loads = later,
    .begin = begin,
    .look = look,
    .errors = set_errors,
    .end = end,
    .keys = set_keys,
    .report = report_time,
    .report_last = solve_report_shift,
    .report_end = report_range,
};
