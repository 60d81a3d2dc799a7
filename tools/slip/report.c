/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Report, plan and warnings of rc-slip. */
#include "slip.h"

#include <math.h>

static const char *
coupling_of(const struct slip_run *run)
{
    return run->bodies.beta == 0                  ? "left out: beta = 0"
           : run->coupling == RC_COUPLING_FULL    ? "full"
           : run->coupling == RC_COUPLING_GOODMAN ? "goodman"
                                                  : "none";
}

/* The effects: computed, or why not. */
static const struct effect_state *
effects_of(const struct slip_run *run)
{
    static struct effect_state list[5];
    const struct slip_pair *b = &run->bodies;

    list[0] = (struct effect_state){
        "coupling", b->beta == 0
                        ? "left out: beta = 0, so that pressure and tractions do not influence "
                          "each other"
                    : run->alternates                      ? "on: both ways"
                    : run->coupling == RC_COUPLING_GOODMAN ? "on: the pressure moves the bodies"
                                                           : "left out: --coupling none"};
    list[1] = (struct effect_state){"transverse_slip", b->kap == 0 ? "left out: nu = 0" : "on"};
    list[2] =
        (struct effect_state){"bound", isnan(run->args->tau_max) ? "left out: no --tau-max" : "on"};
    list[3] =
        (struct effect_state){"contact", run->alternates ? "on: solved in each pass"
                                         : run->solves   ? "on: solved where the load changes"
                                                         : "left out: the stream has the pressure"};
    return list;
}

/* The tolerance in use. */
static double
slip_tol(const struct slip_run *run)
{
    return !isnan(run->args->tol) ? run->args->tol : run->motion->tol;
}

static void
end_row(struct drive *d, bool converged)
{
    struct slip_run *run = (struct slip_run *)(void *)d;
    struct report *r = &d->report;

    report_bool(r, "converged", converged);
    report_number(r, "tol", slip_tol(run), NULL);
    report_effects(r, effects_of(run));
    report_seconds(r,
                   (const struct report_phase[]){
                       {"setup", d->is.setup}, {"iterate", d->course.iterate}, {NULL, 0}},
                   d->is.looked - d->is.began);
    report_memory(r);
}

void
slip_report(struct drive *d, const struct rc_model *m)
{
    const struct slip_run *run = (const struct slip_run *)(const void *)d;
    struct report *r = &d->report;

    report_map(r, run->p, run->number);
    boundary_report(r, run->p, run->boundary);
    report_count(r, "threads", run->d.t.threads, NULL);
    report_number(r, "mu", run->args->mu, NULL);
    report_number(r, "tau_max", run->args->tau_max, "Pa");
    report_number(r, "beta", run->bodies.beta, NULL);
    report_text(r, "coupling", coupling_of(run));
    end_row(d, run->motion->report(r, run, m));
    if (run->motion->report_last != NULL)
        run->motion->report_last(r, run);
}

/* ---- warnings ---- */

static const double near_sliding = 0.99;
static const double coarse = 0.05; /* an error above this gets a warning */

double
slip_goal(const struct slip_run *run)
{
    static const double usual = 0.1; /* without --tol, whose default concerns the iteration alone */

    return isnan(run->args->tol) ? usual : run->args->tol;
}

/* Warns if the error exceeds `most`: names its largest part and how to lower it, for all corners so far. */
static void
say_what_is_left(struct slip_run *run, struct slip_state *s, double most, const char *where)
{
    /* The error falls as the number of increments to the power -1, by a little less to be safe. */
    static const double order = 1.1, affordable = 1000, margin = 1.5;
    double n = 0, increments = s->errors.increment, few;

    for (const struct slip_corner *c = run->corner; c <= s->corner; c++)
        n = fmax(n, (double)c->leg.increments);
    few = fmax(affordable, n);
    s->needed = fmax(s->needed, fmax(ceil(n * pow(increments / most, order)), 8));
    s->reached = fmax(s->reached, margin * increments * pow(n / few, 1 / order));

    if (isnan(s->traction_error))
        tool_warn(&run->d.t,
                  "%s: --increments %zu is too few to estimate the error: take 4 or more, or auto",
                  where, run->increments);
    else if (s->traction_error > most && increments > s->traction_error / 2 && s->needed > few)
        tool_warn(&run->d.t,
                  "%s: the increments cause an error of %.2g %% of the tractions, and %.2g %% "
                  "would take about %.1g of them: take --increments %.0f --tol %.1g",
                  where, 100 * increments, 100 * most, s->needed, few, s->reached);
    else if (s->traction_error > most && increments > s->traction_error / 2)
        tool_warn(&run->d.t,
                  "%s: the increments cause an error of %.2g %% of the tractions: take "
                  "--increments %.0f for %.2g %%, with about %.2g times the work",
                  where, 100 * increments, s->needed, 100 * most, s->needed / n);
    else if (s->traction_error > most || !s->converged)
        tool_warn(
            &run->d.t,
            "%s: the error of the iteration is %.1e of the tractions, above the goal of %.1e: take "
            "--tol %.0e; near sliding give --displacement, which is easier to solve than a force",
            where, s->traction_error - increments, slip_goal(run), slip_goal(run) / 10);
}

/* Warns that rc-slip treats bodies that have yielded as elastic. */
static void
say_what_yielded(struct slip_run *run, const char *where)
{
    double limit, most = 0;

    for (size_t k = 0; k < rc_grid_nodes(run->p); k++)
        most = fmax(most, run->p->v[k]);
    most = ranks_most(&run->d.t, most);
    if (rc_grid_number(run->p, "yield", &limit) ||
        (rc_grid_number(run->p, "hardness", &limit) && most >= limit * (1 - 1e-9)))
        tool_warn(
            &run->d.t,
            "%s: the body has yielded (%s %.4g Pa): rc-slip uses its pressure, but treats the "
            "bodies as elastic, without residual strain and without yield under tractions",
            where, rc_grid_get(run->p, "yield") != NULL ? "yield stress" : "hardness", limit);
}

void
slip_judge_plan(struct slip_run *run)
{
    /* Errors of the tractions over beta on rough surfaces with beta from 0.007 to 0.11, at most 5 and 0.21;
     * further dissimilar bodies were measured one by one. */
    const double of_none = 6, of_goodman = 0.3, small = 0.1, least = 0.01;
    const char *where = tool_where(&run->d.t, run->p);
    const bool none = run->coupling == RC_COUPLING_NONE;
    const double beta = fabs(run->bodies.beta), part = beta * (none ? of_none : of_goodman);

    say_what_yielded(run, where);
    if (beta == 0 || run->coupling == RC_COUPLING_FULL || part < least)
        return;
    if (beta < small) {
        tool_warn(
            &run->d.t,
            "%s: the bodies are dissimilar (beta %.3g), and %s neglects %s: on rough surfaces "
            "tractions are wrong by up to %.2g %%",
            where, run->bodies.beta, none ? "--coupling none" : run->motion->uncoupled,
            none ? "the tangential displacement due to their pressure"
                 : "the effect of tractions on the pressure",
            100 * part);
        return;
    }
    if (none)
        tool_warn(&run->d.t,
                  "%s: the bodies are dissimilar (beta %.3g), and --coupling none neglects the "
                  "tangential displacement due to their pressure: on rough surfaces tractions were "
                  "wrong by 16 to 87 %%",
                  where, run->bodies.beta);
    else
        tool_warn(&run->d.t,
                  "%s: the bodies are dissimilar (beta %.3g), and %s neglects the "
                  "effect of tractions on the pressure: on rough surfaces tractions were wrong by "
                  "2 to 13 %%, pressures by 1 to 8 %%",
                  where, run->bodies.beta, run->motion->uncoupled);
}

void
slip_judge(struct slip_run *run, struct slip_state *s)
{
    const struct rc_friction_increment *f = &s->figures.last;
    const double sum = hypot(f->force[0], f->force[1]),
                 force = sum > 1e-9 * f->limit ? sum : 0; /* of the order of rounding */
    char where[320];
    const char *frame = tool_where(&run->d.t, run->p);

    snprintf(where, sizeof where, "%s, at a load of %.6g N and a force of %.6g N", frame, f->load,
             force);
    if (tool_interrupted() != 0)
        tool_warn(&run->d.t,
                  "%s: interrupted on the way to this point: the written frames are not a solution",
                  where);
    else
        say_what_is_left(run, s, fmin(coarse, slip_goal(run)), where);
    if (!s->corner->moved && force > near_sliding * f->limit && f->limit > 0)
        tool_warn(
            &run->d.t,
            "%s: the force is %.6g of the friction limit, where the displacement grows without "
            "bound and is sensitive to errors of the pressure: give --displacement instead",
            where, force / f->limit);
}

/* ---- the plan ---- */

/* The expected number of passes: each multiplies the error by about 0.7 mu beta. */
double
slip_passes(const struct slip_run *run)
{
    double c = 0.7 * run->args->mu * fabs(run->bodies.beta);
    double tol = isnan(run->args->tol) ? 1e-4 : run->args->tol;

    if (!run->alternates)
        return 1;
    return c < 1 ? 1 + ceil(log(tol / 4) / log(c)) : 50;
}

void
slip_say_plan(struct slip_run *run, const struct rc_expected *expected)
{
    const struct slip_pair *b = &run->bodies;
    const struct plan plan = plan_begin(&run->d.t, &run->d.report, run->p, rc_grid_case(run->p),
                                        rc_boundary_word(run->boundary), run->motion->work);

    plan_effects(&plan, effects_of(run));
    if (b->beta != 0)
        plan_say(&plan, "beta", "%.3g: %s%.0f pass%s an increment", b->beta,
                 run->alternates ? "about " : "", slip_passes(run),
                 slip_passes(run) == 1 ? "" : "es");
    if (b->kap != 0)
        plan_say(&plan, "kap", "%.3g", b->kap);
    for (size_t k = 0; k < run->corners; k++) {
        const struct slip_corner *c = &run->corner[k];
        if (!c->silent)
            plan_say(&plan, "to", "P %g N, %g %s, %g %s: %zu increment%s", c->load, c->to[0],
                     c->moved ? "m" : "N", c->to[1], c->moved ? "m" : "N", c->leg.increments,
                     c->leg.increments == 1 ? "" : "s");
    }
    if (run->law.fewer > 0)
        plan_say(&plan, "increments", "solved also with half of them%s, for the error",
                 run->law.fewer < RC_FEWER ? "" : " and a quarter");
    plan_end(&plan, expected->convolutions, course_seconds(run->p, expected->seconds, 1),
             course_peak(expected->memory));
}
