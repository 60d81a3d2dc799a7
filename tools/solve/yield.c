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
    struct yielding *y = &run->yielding;
    char count[32];
    const size_t length = text != NULL ? strcspn(text, ",") : 0;

    y->companion = length > 0 && length < sizeof count && strcmp(text + length, ",half") == 0;
    if (!y->companion) {
        read_count(run, "increments", text, &y->asked, NULL);
        return;
    }
    memcpy(count, text, length);
    count[length] = '\0';
    read_count(run, "increments", count, &y->asked, NULL);
    if (y->asked < LEAST || y->asked % 2 != 0)
        tool_usage(&run->d.t, "--increments %s: N,half needs an even number from %d", text, LEAST);
    if (run->args->travel.n > 0)
        tool_usage(
            &run->d.t,
            "--increments %s: a contact that travels has no second run: give --increments %zu",
            text, y->asked);
}

void
yield_read(struct run *run)
{
    const struct solve_args *args = run->args;
    const struct physics *a = &args->physics;
    struct yielding *y = &run->yielding;

    y->wanted = args->yield != NULL;
    if (!y->wanted && (args->slabs != NULL || (args->increments != NULL && !run->relaxing.wanted)))
        tool_usage(&run->d.t, "--increments and --slabs have no effect without --yield");
    for (int f = SOLVE_RESIDUAL; !y->wanted && f <= SOLVE_STRAIN; f++)
        if (solve_wanted(args, f))
            tool_usage(&run->d.t, "--output %s has no effect without --yield", solve_frames[f]);
    if (!y->wanted)
        return;
    if (yield_law_read(&y->read, args->yield, &run->d.t.err) != RC_OK)
        tool_usage(&run->d.t, "--yield %s: %s", args->yield, run->d.t.err.text);
    y->law = y->read.law;
    read_increments(run, args->increments);
    read_count(run, "slabs", args->slabs, &y->slab_count, &y->list);
    yield_law_check(&run->d.t, &y->read, a);
    yield_law_refuse(&run->d.t, args->discretization, "--discretization",
                     "solve a coarser map in a second command instead");
    yield_law_refuse(&run->d.t, run->tilt, "--tilt free",
                     "with --yield the bodies move along their normal only");
}

void
yield_free(struct run *run)
{
    struct yielding *y = &run->yielding;

    y->on = false;
    y->found = NULL;
}

static double
goal(const struct run *run)
{
    return run->args->tol > 0 ? run->args->tol : deserved;
}

void
yield_mark(struct run *run)
{
    const struct yielding *y = &run->yielding;
    const size_t bytes = y->law.points * sizeof(double);

    if (y->law.points > 0)
        course_mark_crc(
            &run->d.course, MARK_FILE, "yield",
            rc_crc32_add(rc_crc32_add(0, y->read.table.v[0], bytes), y->read.table.v[1], bytes));
}

/* ---- the loads ---- */

struct rc_model *
yield_model(struct run *run, const struct rc_grid *g, const struct rc_problem *contact)
{
    struct yielding *y = &run->yielding;
    const struct rc_yield_problem problem = {.contact = *contact,
                                             .law = y->law,
                                             .slabs = y->list.n > 0 ? y->list.n : y->slab_count,
                                             .thickness = y->list.n > 0 ? y->list.v : NULL,
                                             .increments = y->asked,
                                             .companion = y->companion};

    return tool_made(&run->d.t, g, rc_yield_new(rc_shape_of(g), g->v, &problem, &run->d.t.err));
}

void
yield_plan(struct run *run, struct rc_model *m, double load)
{
    const double *v = run->steps->v; /* in units of `unit` */
    /* the slabs of a contact that travels must be deep enough for higher spots, and for later passes */
    const double deeper = run->travelling.wanted ? 2 : 1;
    double most = 0;

    for (size_t k = run->step; k < run->steps->n; k++)
        most = fmax(most, v[k]);
    if (!run->yielding.on && load > 0)
        rc_yield_plan(m, run->steps->n - run->step, deeper * most * load / v[run->step]);
}

double
yield_expect(struct run *run, double load, struct rc_expected *expected)
{
    const double other = 0.2; /* of a load that is not the largest so far, in a first load */
    struct rc_point to = {0};
    enum rc_status status;
    struct rc_loops loops;
    double most = 0, loads = 0;

    yield_plan(run, run->model, load);
    rc_point_set(&to, RC_LOAD, load);
    status = rc_model_go(run->model, &to, &run->d.t.err);
    do
        rc_model_progress(run->model, &loops);
    while (tool_interrupted() == 0 && status == RC_MORE && loops.coming == 0 &&
           (status = rc_model_step(run->model, &run->d.t.err)) == RC_MORE);
    if (status == RC_FAIL || rc_model_plan(run->model, &to, expected, &run->d.t.err) != RC_OK)
        tool_refuse(&run->d.t, run->g, "%s", run->d.t.err.text);
    for (size_t k = 0; k < run->steps->n; k++) {
        loads += run->steps->v[k] > most ? 1 : other;
        most = fmax(most, run->steps->v[k]);
    }
    if (run->travelling.wanted)
        loads = 1 + other * (double)travel_points(run);
    return loads;
}

void
yield_found(struct run *run, const struct rc_model *m)
{
    struct yielding *y = &run->yielding;

    y->found = rc_yield_result(m);
    y->on = y->found != NULL && y->found->yielded;
}

/* ---- results ---- */

/* True if a signal came before it was known whether body 1 yields under the load. */
static bool
is_unknown(const struct run *run)
{
    const struct yielding *y = &run->yielding;

    return y->wanted && !y->on && tool_interrupted() != 0 &&
           !(y->found->max_mises_over_yield > 0 && y->found->max_mises_over_yield <= 1);
}

void
yield_look(struct run *run, struct solution *s)
{
    struct yielding *y = &run->yielding;
    const struct rc_yield_load *f;
    struct rc_contact *c = &s->contact;

    if (is_unknown(run)) { /* the error of the elastic contact is then no estimate */
        c->pressure_error = NAN;
        c->converged = false;
    }
    if (!y->on)
        return;
    f = &y->found->last;
    c->convolutions = NAN; /* nearly all of the work is in the volume */
    s->errors = (struct error_parts){
        true,          f->increment_error, f->inherited_error, f->iteration_error, f->contact_error,
        f->image_error};
    if (run->d.status == RC_MORE) /* broken off */
        s->errors.increment = NAN;
    c->pressure_error = errors_sum(&s->errors);
    /* --increments asked for too few to estimate it */
    c->converged =
        run->d.status == RC_OK && c->converged &&
        (errors_within(c->pressure_error, goal(run)) || (y->asked > 0 && isnan(c->pressure_error)));
    if (f->increment_error > y->worst_error) {
        y->worst_error = f->increment_error;
        y->worst = run->d.course.number;
        y->worst_increments = f->increments;
    }
}

double
yield_peak(const struct run *run, double max_pressure, const char **name)
{
    const double soft =
        10; /* with hardening below so many times the yield stress, nodes alternate */
    const struct yielding *y = &run->yielding;
    const bool alternates =
        y->on && yield_law_hardening(&y->law) < soft * rc_yield_law_stress(&y->law, 0);

    if (name != NULL)
        *name = alternates ? "largest pressure over 2 x 2 nodes" : "largest pressure";
    return alternates ? y->found->last.max_pressure_mean4 : max_pressure;
}

/* ---- strain ---- */

static void
put_slab(struct run *run, const struct rc_model *m, struct rc_grid *frame, size_t slab,
         double depth, double *buffer)
{
    static const char *const names[RC_YIELD_STRAINS] = {"exx", "eyy", "exy", "exz", "eyz", "peeq"};
    const struct yielding *y = &run->yielding;

    tool_set_number(&run->d.t, frame, "depth", depth);
    tool_set_number(&run->d.t, frame, "thickness", y->found->thickness[slab]);
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

void
yield_put_strain(struct run *run, const struct rc_model *m, const struct rc_grid *like)
{
    const struct yielding *y = &run->yielding;
    RC_OWN(rc_grid, frame) = NULL;
    double z = 0;

    if (!y->on)
        return;
    frame = tool_frame_like(&run->d.t, like, NULL, like->channel, like->unit);
    for (size_t k = 0; k < y->found->slabs; k++) {
        put_slab(run, m, frame, k, z + y->found->thickness[k] / 2, like->v);
        z += y->found->thickness[k];
    }
}

static void
warn_of_slabs(struct run *run, const char *where, const struct rc_yield_load *f)
{
    const struct yielding *y = &run->yielding;
    double bottom = 0, above = 0;
    size_t within = 0;

    for (size_t k = 0; k < y->found->slabs; k++) {
        above = bottom;
        bottom += y->found->thickness[k];
        within += above < f->depth;
    }
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
    const struct yielding *y = &run->yielding;
    const struct rc_yield_load *f = &y->found->last;
    const struct error_parts *e = &s->errors;
    const double asked = goal(run), off = s->contact.pressure_error / asked;
    const char limit = errors_limited_by(e)[0]; /* first letter of increments, history,
                                                   tolerance, map */
    const size_t made = limit == 'h' ? y->worst_increments : f->increments;
    const double more = 2 * ceil((double)made * pow(off, order) / 2);
    const char *half = y->companion ? ",half" : "";
    char what[256], first[96];

    snprintf(first, sizeof first, "its estimated error is %.2g %%, above %.2g %%",
             100 * s->contact.pressure_error, 100 * asked);
    if (limit == 'i' && run->travelling.wanted)
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
                 100 * e->inherited, y->worst, made, more, half);
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

bool
yield_warn_of_end(struct run *run, const char *where, const struct solution *s)
{
    const struct yielding *y = &run->yielding;

    if (is_unknown(run)) {
        tool_warn(&run->d.t,
                  "%s: interrupted before it was known whether body 1 yields: the frames hold an "
                  "elastic solution with an unknown error",
                  where);
        return true;
    }
    if (!y->on)
        return false;
    if (run->d.status == RC_MORE)
        tool_warn(
            &run->d.t,
            "%s: interrupted in increment %zu of %zu: the frames hold an intermediate state, not "
            "a solution, and its error is unknown",
            where, y->found->increment, y->found->increments);
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

void
yield_judge(struct run *run, const char *where, const struct solution *s)
{
    enum {
        SPOT = 113 /* nodes: 6 in the radius */
    };
    const struct rc_yield_load *f;

    if (!run->yielding.on)
        return;
    f = &run->yielding.found->last;
    warn_of_slabs(run, where, f);
    if (s->patches.count > 0 && s->contact.contact_nodes < SPOT * s->patches.count)
        course_warn(&run->d.course, "the plastic zone of a contact spot is not resolved",
                    "%s: a contact spot has %.0f nodes, and with a radius below 6 nodes its "
                    "plastic zone is not resolved: take a finer grid",
                    where, (double)s->contact.contact_nodes / (double)s->patches.count);
}

void
yield_tell(const struct run *run, const struct rc_contact *c, char *text, size_t size)
{
    const struct rc_yield_load *f;

    if (!run->yielding.on) {
        snprintf(text, size, "%zu iterations, %.3g convolutions", c->iterations, c->convolutions);
        return;
    }
    f = &run->yielding.found->last;
    snprintf(text, size, "%zu increments, %zu applications", f->increments, f->applications);
}

const char *
yield_state(const struct run *run)
{
    static char text[128];
    const struct yielding *y = &run->yielding;

    if (!y->wanted)
        return "left out: no --yield";
    if (y->on)
        return "on";
    if (y->found == NULL || !(y->found->max_mises_over_yield > 0))
        return "on where the elastic stress exceeds it; costs nothing elsewhere";
    snprintf(text, sizeof text,
             "left out: the largest Mises stress is %.3g of the yield stress, %s deep",
             y->found->max_mises_over_yield, shown_in_unit(y->found->max_mises_depth, "m"));
    return text;
}

void
yield_report(struct report *r, const struct run *run)
{
    const struct yielding *y = &run->yielding;
    const bool relaxes = run->relaxing.wanted;
    const struct figures of_steps[] = {{rc_figures(relaxes ? "viscoelastic" : "yield"),
                                        relaxes ? (const void *)run->relaxing.found
                                        : y->on ? y->found
                                                : NULL},
                                       {0}},
                         of_volume[] = {{rc_figures("yield"), y->on ? y->found : NULL}, {0}},
                         of_stress[] = {{rc_figures("yield"), y->wanted ? y->found : NULL}, {0}};

    report_number(r, "yield", y->wanted ? rc_yield_law_stress(&y->law, 0) : NAN, "Pa");
    report_number(r, "hardening", y->wanted && y->law.points == 0 ? y->law.modulus : NAN, "Pa");
    report_named(r, of_steps, "increments");
    report_named(r, of_volume,
                 "applications slabs plastic_depth plastic_volume max_plastic_strain "
                 "plastic_work max_pressure_mean4");
    report_named(r, of_stress, "max_mises_over_yield max_mises_depth");
}
