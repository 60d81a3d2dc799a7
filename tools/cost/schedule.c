/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Selects, orders and repeats the trials. The expected time of each is rc-solve's, corrected by the measured
 * times of earlier trials on this map. A machine may differ by several times, and a surface may need fewer or
 * more convolutions.
 */
#include "cost.h"

#include <math.h>
#include <string.h>

/* ---- expected times ---- */

/* The measured trial on the map's own grid with the nearest tolerance, the same engine and, if there is one,
 * the same method. Without such a trial it is the reference. */
static const struct cost_trial *
nearest(const struct cost_case *c, const struct cost_trial *t)
{
    const struct cost_trial *near = &c->reference;
    double least = INFINITY;

    for (size_t k = 0; k < c->pressures; k++) {
        const struct cost_trial *m = &c->trial[k];
        double off = fabs(log(m->tol / t->tol)) + (strcmp(m->method, t->method) == 0 ? 0 : 1e3);

        if (m->state == COST_DONE && m->coarse == 1 && strcmp(m->kernel, t->kernel) == 0 &&
            off <= least) {
            least = off;
            near = m;
        }
    }
    return near;
}

/* Convolutions per depth, in units of one for displacements: with the transforms of the first engine all
 * components share a plan. With other engines they do not. The error needs the exact stresses, and a second
 * computation of the stresses of the trial. */
static double
expect_stress(const struct cost_case *c, const struct cost_trial *t)
{
    const struct cost_trial *exact = &c->trial[c->pressures];
    const double sums = t->kernel == exact->kernel ? 1 : 7.0 / 3;
    const struct rc_conv_options by = {.boundary = c->line.boundary,
                                       .engine = t->kernel,
                                       .tol = t->tol,
                                       .threads = c->tool->threads},
                                 of = {.boundary = by.boundary,
                                       .engine = exact->kernel,
                                       .threads = c->tool->threads};
    double each;

    if (exact->state != COST_DONE)
        return c->reference.is.seconds;
    each = exact->is.seconds * sums * rc_conv_seconds(&c->shape, &by) /
           rc_conv_seconds(&c->shape, &of);
    return 2 * each + exact->is.seconds + 3 * c->around;
}

/* Expected seconds. They come from trials measured on this map, else from the plan. */
static double
expect(const struct cost_case *c, const struct cost_trial *t)
{
    const struct cost_trial *near;

    if (t->about & COST_STRESS)
        return expect_stress(c, t);
    near = nearest(c, t);
    if (near->state != COST_DONE)
        return t->planned;
    return t->planned * near->is.seconds / near->planned + c->around;
}

/* ---- the order ---- */

bool
cost_is_near(const struct cost_case *c, const struct cost_trial *m)
{
    const double error = m->is.error;

    if (m->state != COST_DONE || !m->converged)
        return false;
    if (m->about & COST_YIELD)
        return error <= c->error && !isnan(m->is.estimate);
    return error + c->reference.is.estimate <= c->error;
}

/* Seconds beyond which a trial is not needed for the choice, once something has been measured. They are three
 * times those of the fastest trial that is accurate enough, or of the budget. Expected times may be wrong by
 * this factor. */
static double
too_slow(const struct cost_case *c)
{
    double least = INFINITY;
    bool any = false;

    for (size_t k = 0; k < c->pressures; k++) {
        const struct cost_trial *m = &c->trial[k];

        if (m->state != COST_DONE)
            continue;
        any = true;
        if (cost_is_near(c, m))
            least = fmin(least, m->is.seconds);
    }
    if (!c->choosing || c->shown || !any)
        return INFINITY;
    return 3 * (isnan(c->budget) ? least : c->budget) + c->around;
}

static bool
fits(const struct cost_case *c, struct cost_trial *m, double left)
{
    if (m->expected > left)
        snprintf(m->why, sizeof m->why,
                 "left out: it would take about %.2g s, and %.2g s are left %s", m->expected,
                 fmax(left, 0), m->about & COST_STRESS ? "for stresses" : "of --limit");
    else if (!(m->about & COST_STRESS) && m->expected > too_slow(c))
        snprintf(m->why, sizeof m->why, "left out: about %.2g s, it would not be chosen",
                 m->expected);
    else
        return true;
    m->state = COST_LEFT_OUT;
    return false;
}

static double
left(double began, double limit)
{
    return limit - (tool_now() - began);
}

/* Fraction of the limit: trials with a longer expected time come last, because they may use up the time.
 * Before them fast trials are repeated and the stresses are computed. */
static const double slow = 1 / 30.0;

/* True if the trial took longer than another trial with the same and further work: other programs then took
 * part of its time. */
static bool
disturbed(const struct cost_trial *trial, size_t pressures, const struct cost_trial *m)
{
    for (size_t k = 0; k < pressures; k++) {
        const struct cost_trial *o = &trial[k];

        if (o->state == COST_DONE && strcmp(o->method, m->method) == 0 &&
            strcmp(o->kernel, m->kernel) == 0 && o->coarse <= m->coarse && o->tol <= m->tol &&
            o->increments >= m->increments && o->stack >= m->stack &&
            m->is.seconds > 1.1 * o->is.seconds)
            return true;
    }
    return false;
}

bool
cost_again(double runs, double seconds)
{
    return runs < 5 && runs * seconds < 0.5;
}

static bool
again(const struct cost_case *c, const struct cost_trial *m)
{
    const double runs = m->is.runs, seconds = m->is.seconds;

    if (m->state != COST_DONE || seconds + c->around > left(c->began, c->limit))
        return false;
    return cost_again(runs, seconds) || (runs < 2 && seconds < slow * c->limit) ||
           (runs < 5 && disturbed(c->trial, c->pressures, m));
}

/* Repeats trials in turns, so that a disturbance does not affect one trial alone; not while repetitions
 * fail. */
static void
repeat(struct cost_case *c)
{
    bool more = true;

    while (more && tool_interrupted() == 0) {
        more = false;
        for (size_t k = 0; k < c->pressures && tool_interrupted() == 0; k++)
            if (again(c, &c->trial[k])) {
                const double runs = c->trial[k].is.runs;

                cost_trial_run(c, &c->trial[k], left(c->began, c->limit));
                more = more || c->trial[k].is.runs > runs;
            }
    }
}

/* Runs the stresses in half of the remaining time. */
static void
run_stresses(struct cost_case *c)
{
    double end = tool_now() + left(c->began, c->limit) / 2;

    for (size_t k = c->pressures; k < c->trials && tool_interrupted() == 0; k++) {
        struct cost_trial *m = &c->trial[k];
        double rest = fmax(end - tool_now(), 0);

        m->expected = expect(c, m);
        if (fits(c, m, rest))
            cost_trial_run(c, m, rest);
    }
}

/* The fastest trial that has not been run. */
static struct cost_trial *
next(struct cost_case *c)
{
    struct cost_trial *least = NULL;

    for (size_t k = 0; k < c->pressures; k++) {
        struct cost_trial *m = &c->trial[k];

        if (m->state != COST_OPEN)
            continue;
        m->expected = expect(c, m);
        if (least == NULL || m->expected < least->expected)
            least = m;
    }
    return least;
}

void
cost_run_trials(struct cost_case *c)
{
    bool quick = true;

    c->began = tool_now();
    while (tool_interrupted() == 0) {
        struct cost_trial *m = next(c);

        if (quick && (m == NULL || m->expected > slow * c->limit)) {
            quick = false;
            repeat(c);
            run_stresses(c);
        } else if (m == NULL) {
            break;
        } else if (fits(c, m, left(c->began, c->limit))) {
            cost_trial_run(c, m, left(c->began, c->limit));
        }
    }
    repeat(c);
}
