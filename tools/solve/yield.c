/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * --yield: body 1 yields in its volume. A load is first solved for an elastic body. If the stresses stay
 * below the yield stress everywhere, this is the solution, and no plastic volume was computed. Otherwise the
 * body is loaded from 0 in increments, and every later load of the list continues from the previous one.
 */
#include "solve.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

static struct {
    const char *law, *slabs; /* words of the command line, or NULL */
} args;

static struct {
    struct yield_law read;
    struct rc_yield_law law;
    size_t asked;        /* increments of a load on the command line; 0: auto */
    bool companion;      /* a second run with half of them estimates their error */
    size_t slab_count;   /* slabs on the command line; 0: auto */
    struct numbers list; /* or thicknesses                                                */
    bool on;             /* something has yielded                                       */
    const struct rc_yield_figures *found; /* NULL: no load was solved yet */
    size_t worst; /* the case with the largest error of increments, and its number of increments */
    size_t worst_increments;
    double worst_error;
} own;

/* clang-format off */
static const struct opt options[] = {
    {.group = yield_option, .base = &args.law,
     .against = RULES({.with = "hardness", .because = "--yield computes plasticity itself, which --hardness "
                                                      "approximates"},
                      {.with = "layer", .because = "it supports only bodies without layers"},
                      {.with = "estar", .because = "body 1 needs its own modulus",
                       .remedy = "give --E1 --nu1, and --E2 --nu2 or --E2 rigid"},
                      {.with = "approach", .because = "it needs a load",
                       .remedy = "give --load or --mean-pressure"},
                      {.with = "adhesion", .because = "plasticity in the volume supports pressures only, no "
                                                      "attraction"},
                      {.with = "discretization",
                       .remedy = "solve a coarser map in a second command instead"},
                      {.with = "tilt free",
                       .because = "with --yield the bodies move along their normal only"})},
    {.group = solve_increments},
    {.name = "slabs", .type = OPT_TEXT, .base = &args.slabs, .result = true, .arg = "N|LIST|auto",
     .needs = RULES({.with = "yield"}),
     .help = "layers that may yield: number or thicknesses, from the surface down (default auto)"},
    {.name = NULL},
};
/* clang-format on */

static const double deserved = 1e-2;       /* allowed error without --tol */
static const double order = 1.1;           /* the error falls with this power of the increments */
static const double image_order = 1 / 2.7; /* and with this power of the side of a free map */

/* ---- the command line ---- */

/* Reads "auto" (*count = 0), a whole number, or, if `list` is not NULL, a list of lengths. */
static void
read_count(struct run *run, const char *name, const char *text, size_t *count,
           struct numbers *lengths)
{
    char *end;
    unsigned long n;

    *count = 0;
    if (text == NULL || strcmp(text, "auto") == 0)
        return;
    n = strtoul(text, &end, 10);
    if (end != text && *end == '\0' && n > 0 && n <= RC_YIELD_INCREMENTS && text[0] != '-') {
        *count = n;
        return;
    }
    if (lengths == NULL || (end != text && *end == '\0'))
        tool_usage(&run->d.t, "--%s %s: it must be auto%s or a number from 1 to %d", name, text,
                   lengths == NULL ? "" : ", a list of thicknesses", RC_YIELD_INCREMENTS);
    if (unit_numbers(text, UNIT_M, lengths, &run->d.t.err) != RC_OK)
        tool_usage(&run->d.t, "--%s %s: %s", name, text, run->d.t.err.text);
    for (size_t k = 0; k < lengths->n; k++)
        if (!(lengths->v[k] > 0))
            tool_usage(&run->d.t, "--%s %s: a slab must have a thickness above 0", name, text);
}

/* Reads --increments, which may end with ",half". */
static void
read_increments(struct run *run, const char *text)
{
    enum {
        LEAST = 16 /* so that half the increments have an estimate too */
    };
    char count[32];
    const size_t length = text != NULL ? strcspn(text, ",") : 0;

    own.companion = length > 0 && length < sizeof count && strcmp(text + length, ",half") == 0;
    if (!own.companion) {
        read_count(run, "increments", text, &own.asked, NULL);
        return;
    }
    memcpy(count, text, length);
    count[length] = '\0';
    read_count(run, "increments", count, &own.asked, NULL);
    if (own.asked < LEAST || own.asked % 2 != 0)
        tool_usage(&run->d.t, "--increments %s: N,half needs an even number from %d", text, LEAST);
}

static bool
ask(struct run *run)
{
    (void)run;
    return args.law != NULL;
}

static void
read(struct run *run)
{
    if (yield_law_read(&own.read, args.law, &run->d.t.err) != RC_OK)
        tool_usage(&run->d.t, "--yield %s: %s", args.law, run->d.t.err.text);
    own.law = own.read.law;
    read_increments(run, run->args->increments);
    read_count(run, "slabs", args.slabs, &own.slab_count, &own.list);
    yield_law_check(&run->d.t, &own.read, run->physics);
    run->relief = "";
    if (!tool_given(&run->d.t, "output"))
        solve_add_frame("residual");
}

static void
close(struct run *run)
{
    (void)run;
    own.on = false;
    own.found = NULL;
}

static double
goal(const struct run *run)
{
    return run->args->tol > 0 ? run->args->tol : deserved;
}

static void
mark(struct run *run)
{
    const size_t bytes = own.law.points * sizeof(double);

    if (own.law.points > 0)
        course_mark_crc(
            &run->d.course, MARK_FILE, "yield",
            rc_crc32_add(rc_crc32_add(0, own.read.table.v[0], bytes), own.read.table.v[1], bytes));
}

/* ---- the loads ---- */

/* The error of the increments is that of the history. */
static void
set_problem(struct run *run, struct rc_problem *problem)
{
    (void)run;
    problem->history_part = 0;
}

static struct rc_model *
make(struct run *run, const struct rc_problem *contact)
{
    const struct rc_grid *g = run->g;
    const struct rc_yield_problem problem = {.contact = *contact,
                                             .law = own.law,
                                             .slabs = own.list.n > 0 ? own.list.n : own.slab_count,
                                             .thickness = own.list.n > 0 ? own.list.v : NULL,
                                             .increments = own.asked,
                                             .companion = own.companion};

    return tool_made(&run->d.t, g, rc_yield_new(rc_shape_of(g), g->v, &problem, &run->d.t.err));
}

/* Plans the remaining loads, before a load in N. */
static void
plan(struct run *run, struct rc_model *m, double load)
{
    const double *v = run->steps->v; /* in units of `unit` */
    /* the slabs of a contact that travels must be deep enough for higher spots, and for later passes */
    const double deeper = solve_moves(run) ? 2 : 1;
    double most = 0;

    for (size_t k = run->step; k < run->steps->n; k++)
        most = fmax(most, v[k]);
    if (!own.on && load > 0)
        rc_yield_plan(m, run->steps->n - run->step, deeper * most * load / v[run->step]);
}

static void
begin(struct run *run, struct rc_model *m, const struct rc_problem *problem)
{
    plan(run, m, problem->load);
    if (run->apart && own.on)
        run->d.course.checkpoint = run->d.checkpoint;
}

static enum rc_status
expect(struct run *run, const struct rc_problem *problem, struct rc_expected *expected,
       struct rc_err *err)
{
    struct rc_point to = {0};

    rc_point_set(&to, RC_LOAD, problem->load);
    return rc_model_plan(run->model, &to, expected, err);
}

/* Solves the elastic contact, which shows how deep the body yields. */
static void
plan_cost(struct run *run, const struct rc_problem *problem, struct rc_expected *expected)
{
    struct rc_point to = {0};
    enum rc_status status;
    struct rc_loops loops;

    plan(run, run->model, problem->load);
    rc_point_set(&to, RC_LOAD, problem->load);
    status = rc_model_go(run->model, &to, &run->d.t.err);
    do
        rc_model_progress(run->model, &loops);
    while (tool_interrupted() == 0 && status == RC_MORE && loops.coming == 0 &&
           (status = rc_model_step(run->model, &run->d.t.err)) == RC_MORE);
    if (status == RC_FAIL || expect(run, problem, expected, &run->d.t.err) != RC_OK)
        tool_refuse(&run->d.t, run->g, "%s", run->d.t.err.text);
}

static double
loads_cost(const struct run *run)
{
    const double other = 0.2; /* of a load that is not the largest so far, in a first load */
    double most = 0, loads = 0;

    if (solve_moves(run))
        return 1 + other * (double)run->cases;
    for (size_t k = 0; k < run->steps->n; k++) {
        loads += run->steps->v[k] > most ? 1 : other;
        most = fmax(most, run->steps->v[k]);
    }
    return loads;
}

static bool
look(struct run *run, struct rc_model *m, struct solution *s)
{
    (void)run;
    own.found = rc_yield_result(m);
    own.on = own.found->yielded;
    s->contact = own.found->contact;
    s->increments = own.on ? (double)own.found->last.increments : NAN;
    return true;
}

/* ---- results ---- */

/* True if a signal came before it was known whether body 1 yields under the load. */
static bool
is_unknown(const struct run *run)
{
    (void)run;
    return !own.on && tool_interrupted() != 0 &&
           !(own.found->max_mises_over_yield > 0 && own.found->max_mises_over_yield <= 1);
}

/* If the pressures of single nodes alternate, the largest mean over 2 x 2 nodes is judged. */
static void
find_peak(struct solution *s)
{
    const double soft =
        10; /* with hardening below so many times the yield stress, nodes alternate */

    if (yield_law_hardening(&own.law) >= soft * rc_yield_law_stress(&own.law, 0))
        return;
    s->peak_name = "largest pressure over 2 x 2 nodes";
    s->peak = own.found->last.max_pressure_mean4;
}

static void
set_errors(struct run *run, struct solution *s)
{
    const struct rc_yield_load *f;
    struct rc_contact *c = &s->contact;

    if (is_unknown(run)) { /* the error of the elastic contact is then no estimate */
        c->pressure_error = NAN;
        c->converged = false;
    }
    if (!own.on)
        return;
    f = &own.found->last;
    find_peak(s);
    snprintf(s->took, sizeof s->took, "%zu increments, %zu applications", f->increments,
             f->applications);
    c->convolutions = NAN; /* nearly all of the work is in the volume */
    s->errors = (struct error_parts){true,
                                     f->increment_error,
                                     f->inherited_error,
                                     f->iteration_error,
                                     f->contact_error,
                                     f->image_error,
                                     f->slab_error};
    if (run->d.status == RC_MORE) /* broken off */
        s->errors.increment = NAN;
    c->pressure_error = errors_sum(&s->errors);
    /* --increments asked for too few to estimate it */
    c->converged =
        run->d.status == RC_OK && c->converged &&
        (errors_within(c->pressure_error, goal(run)) ||
         ((own.asked > 0 || own.slab_count > 0 || own.list.n > 0) && isnan(c->pressure_error)));
    if (f->increment_error > own.worst_error) {
        own.worst_error = f->increment_error;
        own.worst = run->d.course.number;
        own.worst_increments = f->increments;
    }
}

/* ---- strain ---- */

static void
put_slab(struct run *run, const struct rc_model *m, struct rc_grid *frame, size_t slab,
         double depth, double *buffer)
{
    static const char *const names[RC_YIELD_STRAINS] = {"exx", "eyy", "exy", "exz", "eyz", "peeq"};

    tool_set_number(&run->d.t, frame, "depth", depth);
    tool_set_number(&run->d.t, frame, "thickness", own.found->thickness[slab]);
    for (size_t c = 0; c < RC_YIELD_STRAINS; c++) {
        double *to[RC_YIELD_STRAINS] = {NULL};
        struct rc_grid as = *frame; /* the frame in the output stream */
        to[c] = buffer;
        (void)rc_yield_strain(m, slab, to);
        as.channel = (char *)names[c]; /* tool_write only reads these strings */
        as.unit = (char *)"1";
        as.v = buffer;
        tool_write(&run->d.t, &as);
    }
}

/* Writes the plastic strain slab by slab, in frames like this one. */
static void
put_strain(struct run *run, const struct rc_model *m, struct rc_grid *like)
{
    RC_OWN(rc_grid, frame) = NULL;
    double z = 0;

    if (!own.on)
        return;
    frame = tool_frame_like(&run->d.t, like, NULL, like->channel, like->unit);
    for (size_t k = 0; k < own.found->slabs; k++) {
        put_slab(run, m, frame, k, z + own.found->thickness[k] / 2, like->v);
        z += own.found->thickness[k];
    }
}

/* Separated bodies have a shape too. */
static const double *
frame(struct run *run, struct rc_model *m, struct rc_grid *as, const char *word)
{
    if (strcmp(word, "strain") == 0)
        put_strain(run, m, as);
    if (strcmp(word, "plastic") != 0 || !run->apart)
        return NULL;
    tool_must(&run->d.t, run->g, rc_model_frame(m, word, as->v, &run->d.t.err));
    return as->v;
}

static void
set_keys(struct run *run, struct rc_grid *g)
{
    if (!own.on)
        return;
    /* slabs: a reader of the stream then expects the frames of plastic strain */
    tool_set_number(&run->d.t, g, "slabs", (double)own.found->slabs);
    tool_set_number(&run->d.t, g, "yield", rc_yield_law_stress(&own.law, 0));
    tool_set_number(&run->d.t, g, "hardening", yield_law_hardening(&own.law));
}

static void
warn_of_slabs(struct run *run, const char *where, const struct rc_yield_load *f)
{
    double bottom = 0, above = 0;
    size_t within = 0;

    for (size_t k = 0; k < own.found->slabs; k++) {
        above = bottom;
        bottom += own.found->thickness[k];
        within += above < f->depth;
    }
    if (f->max_strain == 0 && run->solution.contact.load > 0)
        course_warn(
            &run->d.course, "the voxels do not resolve the first yield",
            "%s: the largest Mises stress is above the yield stress, but the mean stress of "
            "each voxel is below it: take a finer grid, or thinner --slabs",
            where);
    if (f->depth > above)
        course_warn(
            &run->d.course, "the lowest slab yields",
            "%s: the lowest slab yields, so that the slabs are not deep enough: give more --slabs",
            where);
    if (within > 0 && within < 4)
        course_warn(&run->d.course, "few slabs in the depth that yields",
                    "%s: only %zu %s in the depth that yields, which is too coarse for its "
                    "stresses: take a finer grid, or thinner --slabs",
                    where, within, within == 1 ? "slab lies" : "slabs lie");
}

/* Warns of the largest part of the error, and names the option value that lowers it enough. */
static void
warn_of_part(struct run *run, const char *where, const struct solution *s)
{
    const struct rc_yield_load *f = &own.found->last;
    const struct error_parts *e = &s->errors;
    const double asked = goal(run), off = s->contact.pressure_error / asked;
    const char limit = errors_limited_by(e)[0]; /* first letter of increments, history,
                                                   tolerance, map, slabs */
    const size_t made = limit == 'h' ? own.worst_increments : f->increments;
    const double more = 2 * ceil((double)made * pow(off, order) / 2);
    const char *half = own.companion ? ",half" : "";
    char what[256], first[96];

    snprintf(first, sizeof first, "its estimated error is %.2g %%, above %.2g %%",
             100 * s->contact.pressure_error, 100 * asked);
    if (limit == 'i' && solve_moves(run))
        snprintf(what, sizeof what,
                 "%.2g %% come from the steps from position to position: take shorter ones",
                 100 * e->increment);
    else if (limit == 'i')
        snprintf(what, sizeof what, "%.2g %% come from its increments: give --increments %.0f%s",
                 100 * e->increment, more, half);
    else if (limit == 'h')
        snprintf(what, sizeof what,
                 "%.2g %% come from case %zu, which was reached in %zu increments: give "
                 "--increments %.0f%s",
                 100 * e->inherited, own.worst, made, more, half);
    else if (limit == 's')
        snprintf(what, sizeof what,
                 "%.2g %% come from the thickness of its slabs: give --slabs %.0f",
                 100 * f->slab_error,
                 ceil(1.1 * (double)own.found->slabs * sqrt(fmax(f->slab_error / asked, 1))));
    else if (limit == 'm' && rc_repeats(run->physics->boundary) == 1)
        snprintf(what, sizeof what,
                 "%.2g %% come from the edges of the map: give a map %.1f times as wide across the "
                 "axis that repeats, with the same contact",
                 100 * e->image, ceil(10 * pow(off, image_order)) / 10);
    else if (limit == 'm')
        snprintf(what, sizeof what,
                 "%.2g %% come from the edge of the map: give a map %.1f times as large with the "
                 "same contact, or --periodic if the map is a period",
                 100 * e->image, ceil(10 * pow(off, image_order)) / 10);
    else
        snprintf(what, sizeof what,
                 "%.2g %% come from the tolerance of contacts and iteration: give --tol %.0e",
                 100 * (e->iteration + e->contact), asked / 10);
    course_warn(&run->d.course, "errors above the goal", "%s: %s: %s", where, first, what);
}

static bool
end(struct run *run, const char *where, const struct solution *s)
{
    if (is_unknown(run)) {
        tool_warn(&run->d.t,
                  "%s: interrupted before it was known whether body 1 yields: the frames hold an "
                  "elastic solution with an unknown error",
                  where);
        return true;
    }
    if (!own.on)
        return false;
    if (run->d.status == RC_MORE)
        tool_warn(
            &run->d.t,
            "%s: interrupted in increment %zu of %zu: the frames hold an intermediate state, not "
            "a solution, and its error is unknown",
            where, own.found->increment, own.found->increments);
    else if (isnan(s->contact.pressure_error))
        course_warn(&run->d.course, "an unknown error",
                    "%s: its error is unknown, because a load was reached in fewer than 8 "
                    "increments: give --increments 8 or more",
                    where);
    else if (!s->contact.converged && run->d.status == RC_OK &&
             s->contact.pressure_error > goal(run))
        warn_of_part(run, where, s);
    else
        return false;
    return true;
}

static void
judge(struct run *run, const char *where, const struct solution *s)
{
    enum {
        SPOT = 113 /* nodes: 6 in the radius */
    };
    const struct rc_yield_load *f;

    if (!own.on)
        return;
    f = &own.found->last;
    warn_of_slabs(run, where, f);
    if (s->patches.count > 0 && s->contact.contact_nodes < SPOT * s->patches.count)
        course_warn(&run->d.course, "the plastic zone of a contact spot is not resolved",
                    "%s: a contact spot has %.0f nodes, and with a radius below 6 nodes its "
                    "plastic zone is not resolved: take a finer grid",
                    where, (double)s->contact.contact_nodes / (double)s->patches.count);
}

static const char *
state(const struct run *run)
{
    static char text[128];

    (void)run;
    if (own.on)
        return "on";
    if (own.found == NULL || !(own.found->max_mises_over_yield > 0))
        return "on: computed where the elastic stress exceeds the yield stress";
    snprintf(text, sizeof text,
             "left out: the largest Mises stress is %.3g of the yield stress, %s deep",
             own.found->max_mises_over_yield, shown_in_unit(own.found->max_mises_depth, "m"));
    return text;
}

static void
report(struct report *r, const struct run *run)
{
    const bool wanted = args.law != NULL;
    const struct figures of_volume[] = {{rc_figures("yield"), own.on ? own.found : NULL}, {0}},
                         of_stress[] = {{rc_figures("yield"), own.found}, {0}};

    report_number(r, "yield", wanted ? rc_yield_law_stress(&own.law, 0) : NAN, "Pa");
    report_number(r, "hardening", wanted && own.law.points == 0 ? own.law.modulus : NAN, "Pa");
    report_number(r, "increments", run->solution.increments, NULL);
    report_named(
        r, of_volume,
        "applications slabs slab_error_estimate plastic_depth plastic_volume max_plastic_strain "
        "plastic_work max_pressure_mean4");
    report_named(r, of_stress, "max_mises_over_yield max_mises_depth");
}

const struct effect solve_effect_yield = {
    .name = "yield",
    .title = "yield",
    .options = options,
    .ask = ask,
    .read = read,
    .sequence = true,
    .tol = TOL_FIXED,
    .close = close,
    .mark = mark,
    .problem = set_problem,
    .base = make,
    .expect = expect,
    .plan = plan_cost,
    .loads = loads_cost,
    .begin = begin,
    .look = look,
    .errors = set_errors,
    .judge = judge,
    .end = end,
    .foreign = (const char *const[]){"slabs", "yield", "hardening", NULL},
    .keys = set_keys,
    .frames = (const char *const[]){"residual", "strain", NULL},
    .frames_alone = "has no effect without --yield",
    .frame = frame,
    .off = "left out: no --yield",
    .state = state,
    .place = COLUMNS_OF_VOLUME,
    .columns = true,
    .report = report,
};
