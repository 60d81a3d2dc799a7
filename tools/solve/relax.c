/*
 * --relaxation with --time: viscoelastic bodies, a case a time. One load that acts from 0 s on has a list of
 * times, and a list of loads has the time of each.
 */
#include "solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

/* ---- the command line ---- */

static void
refuse(struct run *run, bool given, const char *what, const char *why)
{
    if (given)
        tool_usage(&run->d.t, "--relaxation does not work with %s: %s", what, why);
}

/* Before the checks of the bodies: body 1 has this material. */
void
relax_read(struct run *run, struct solve_args *args)
{
    struct relaxing *x = &run->relaxing;
    struct physics *a = &args->physics;
    struct tool *t = &run->d.t;

    x->wanted = args->relaxation != NULL && args->speed.n == 0;
    if (args->relaxation == NULL && (args->time.n > 0 || tool_given(t, "shift")))
        tool_usage(t, "--time and --shift have no effect without --relaxation");
    if (args->relaxation == NULL)
        return;
    refuse(run, tool_given(t, "E1") && !isinf(a->e1), "--E1",
           "the moduli of body 1 are those of --relaxation (or --E1 rigid below a layer of it)");
    refuse(run, tool_given(t, "estar"), "--estar",
           "body 1 needs its Poisson's ratio: give --nu1, and --E2 --nu2 or --E2 rigid");
    if (relaxation_law_read(&x->law, args->relaxation, args->shift, &t->err) != RC_OK)
        tool_usage(t, "--relaxation %s: %s", args->relaxation, t->err.text);
    a->relaxes = 1 / x->law.material->instant;
    a->history = x->wanted; /* each time continues from the last one */
}

/* The time of the first load is 0. One load acts from 0 on, also if the first asked time is later. */
static void
check_times(struct run *run)
{
    const struct numbers *time = &run->args->time;
    struct relaxing *x = &run->relaxing;
    struct tool *t = &run->d.t;

    if (time->n == 0)
        tool_usage(t, "--relaxation needs the times of the cases: give --time LIST");
    if (run->steps->n > 1 && run->steps->n != time->n)
        tool_usage(t,
                   "--time has %zu values, and the list of loads or approaches %zu: give lists of "
                   "equal length, or one load",
                   time->n, run->steps->n);
    if (time->v[0] < 0 || (time->v[0] > 0 && run->steps->n > 1))
        tool_usage(t, "--time: the first time is %g s: it must be 0", time->v[0]);
    x->before = time->v[0] > 0;
    x->shortest = INFINITY;
    for (size_t k = 0; k < time->n; k++) {
        const double leg = time->v[k] - (k > 0 ? time->v[k - 1] : 0);
        if (!(leg >= 0) || isinf(leg) || (leg == 0 && k > 0 && run->steps->n == 1))
            tool_usage(t, "--time: %g s after %g s: the times must rise%s", time->v[k],
                       k > 0 ? time->v[k - 1] : 0,
                       run->steps->n > 1 ? ", or be equal at a jump" : "");
        if (leg > 0)
            x->shortest = fmin(x->shortest, leg);
    }
    if (isinf(x->shortest))
        x->shortest = 0;
}

void
relax_warn_of_material(struct run *run)
{
    const struct relaxing *x = &run->relaxing;
    const struct rc_relaxation *m = x->law.material;
    const struct physics *a = &run->args->physics;
    const double contradicts = 0.05, rubber = 0.45, nu = isinf(a->e1) ? a->layers[0].nu : a->nu1;

    if (x->law.misfit > contradicts)
        tool_warn(&run->d.t,
                  "--relaxation: the RMS misfit of the master curve is %.2g: its storage and loss "
                  "moduli contradict each other, or are scattered",
                  x->law.misfit);
    if (m->relaxed == 0)
        tool_warn(&run->d.t, "--relaxation: the relaxed modulus is 0, so that body 1 flows without "
                             "end under a load: for a solid give the modulus that stays, first as "
                             "in 1MPa,9MPa:1ms, or in a line `inf E` of a table");
    if (m->terms > 0 && x->shortest > 0 && x->shortest < m->time[0])
        tool_warn(&run->d.t,
                  "--time: %s passes between two times, and the shortest relaxation time is %s: "
                  "there the "
                  "answer rests on the instantaneous modulus alone",
                  shown_in_unit(x->shortest, "s"), shown_in_unit(m->time[0], "s"));
    if (nu < rubber)
        tool_warn(&run->d.t,
                  "Poisson's ratio %g is constant in time, which holds for rubber (0.5): a "
                  "compressible polymer relaxes less in its volume than in shear",
                  nu);
}

/* After the checks of the bodies. */
void
relax_check(struct run *run)
{
    const struct solve_args *args = run->args;
    struct relaxing *x = &run->relaxing;

    if (!x->wanted)
        return;
    refuse(run, !isinf(args->physics.hardness), "--hardness", "it is not implemented");
    refuse(run, args->physics.layer.n > 0 && !(isinf(args->physics.e1) && isinf(args->physics.e2)),
           "--layer", "a layer must relax alone: give --E1 rigid and --E2 rigid");
    refuse(run, args->physics.layer.n != args->physics.relaxing_layers, "--layer",
           "all layers must relax alike: give " LAYER_RELAXES
           " for the modulus of each, as in 1mm," LAYER_RELAXES ",0.49");
    refuse(run, args->yield != NULL, "--yield", "it is not implemented");
    refuse(run, args->adhesion != NULL, "--adhesion", "it is not implemented");
    refuse(run, args->travel.n > 0, "--travel", "it is not implemented");
    refuse(run, run->tilt, "--tilt free", "the bodies move along their normal only");
    refuse(run, args->discretization, "--discretization",
           "solve a coarser map in a second command instead");
    refuse(run, ranks_of(&run->d.t) != NULL, "several processes", "take one");
    check_times(run);
    relax_warn_of_material(run);
    if (args->increments != NULL && strcmp(args->increments, "auto") != 0) {
        char *end;
        x->increments = strtoul(args->increments, &end, 10);
        if (*end != '\0' || args->increments[0] == '-' || x->increments < 2 ||
            x->increments > RC_YIELD_INCREMENTS)
            tool_usage(&run->d.t, "--increments %s: it must be auto or a number from 2 to %d",
                       args->increments, RC_YIELD_INCREMENTS);
    }
}

/* ---- points ---- */

double
relax_part(const struct run *run, bool contacts)
{
    return !run->relaxing.wanted ? 1 : contacts ? 0.1 : 0.8;
}

size_t
relax_points(const struct run *run)
{
    return run->args->time.n + run->relaxing.before;
}

double
relax_time(const struct run *run, size_t point)
{
    const size_t before = run->relaxing.before;

    return point < before ? 0 : run->args->time.v[point - before];
}

size_t
relax_step(const struct run *run, size_t point)
{
    return run->steps->n == 1 ? 0 : point;
}

/* The largest load of the history, for the forecast. */
size_t
relax_largest(const struct run *run)
{
    size_t most = 0;

    for (size_t k = 0; k < run->steps->n; k++)
        if (run->steps->v[k] > run->steps->v[most])
            most = k;
    return most;
}

struct rc_model *
relax_model(struct run *run, struct rc_model *inner)
{
    const struct physics *a = &run->args->physics;
    const struct relaxing *x = &run->relaxing;
    const struct rc_viscoelastic_problem problem = {
        .tol = run->args->tol * relax_part(run, false),
        .material = x->law.material,
        .share = isinf(a->e1) ? 1 : fmin(1, (1 - a->nu1 * a->nu1) / a->e1 * a->surface_estar),
        .shortest = x->shortest,
        .longest = run->args->time.v[run->args->time.n - 1],
        .points = relax_points(run),
        .increments = x->increments};

    return tool_made(&run->d.t, run->g,
                     rc_viscoelastic_new(inner, run->g->v, &problem, &run->d.t.err));
}

/* The material may come from a file. The steps depend on the shortest and the longest time of the list. */
void
relax_mark(struct run *run)
{
    const struct relaxing *x = &run->relaxing;
    const struct rc_relaxation *m = x->law.material;
    struct course *c = &run->d.course;
    uint32_t crc;

    if (m == NULL)
        return;
    crc = rc_crc32_add(0, &m->relaxed, sizeof m->relaxed);
    crc = rc_crc32_add(crc, m->modulus, m->terms * sizeof *m->modulus);
    crc = rc_crc32_add(crc, m->time, m->terms * sizeof *m->time);
    course_mark_crc(c, MARK_FILE, "relaxation", crc);
    if (!x->wanted)
        return;
    course_mark(c, MARK_POINT, "shortest time", rc_number(x->shortest));
    course_mark(c, MARK_POINT, "last time", rc_number(relax_time(run, relax_points(run) - 1)));
}

/* ---- results ---- */

/* Takes the figures of a time. False: the start of a load, which is not a case. */
bool
relax_look(struct run *run, const struct rc_model *m)
{
    struct relaxing *x = &run->relaxing;

    if (!x->wanted)
        return true;
    x->found = rc_viscoelastic_result(m);
    run->apart = x->found->contact.contact_nodes == 0;
    if (run->d.at == 0 && x->before && tool_interrupted() == 0) {
        run->d.silent = true;
        run->d.course.number--;
        return false;
    }
    return true;
}

void
relax_parts(const struct run *run, struct solution *s)
{
    const struct relaxing *x = &run->relaxing;

    if (x->wanted && !run->apart)
        s->errors =
            (struct error_parts){.told = true,
                                 .increment = x->found->increment_error,
                                 .contact = s->contact.pressure_error - x->found->increment_error};
}

/* Warns of a time at which the steps are too long. False: there was no warning. */
bool
relax_warn_of_end(struct run *run, const char *where, const struct rc_contact *c)
{
    const struct relaxing *x = &run->relaxing;

    if (!x->wanted || c->converged || tool_interrupted() != 0 ||
        x->found->increment_error < c->pressure_error / 2)
        return false;
    course_warn(
        &run->d.course, "stopped short",
        "%s: the error of the steps in time is %.2g of the pressure: take more --increments "
        "than %zu",
        where, x->found->increment_error, x->increments > 0 ? x->increments : 320);
    return true;
}

void
relax_report(struct report *r, const struct run *run)
{
    const struct relaxing *x = &run->relaxing;
    const struct figures from[] = {{rc_figures("viscoelastic"), x->found}, {NULL, NULL}};

    if (run->args->relaxation == NULL)
        return;
    if (x->wanted)
        report_named(r, from, "time equivalent_load");
    else
        slide_report(r, run);
    report_count(r, "relaxation_terms", x->law.material->terms, NULL);
    report_number(r, "relaxation_misfit", x->law.misfit, NULL);
    report_number(r, "modulus_instant", run->args->physics.relaxes, "Pa");
    report_number(r, "modulus_relaxed", x->law.material->relaxed, "Pa");
}

const char *
relax_state(const struct run *run)
{
    static char text[128];
    const struct relaxing *x = &run->relaxing;

    if (run->args->relaxation == NULL)
        return "left out: no --relaxation";
    snprintf(text, sizeof text, "on: %zu terms, E from %s to %s", x->law.material->terms,
             shown_in_unit(run->args->physics.relaxes, "Pa"),
             shown_in_unit(x->law.material->relaxed, "Pa"));
    return text;
}
