/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Selects, orders and repeats the trials. The expected time of each is that of the nearest measured trial,
 * corrected by the forecasts of the first program. A machine may differ by several times, and a surface may
 * need fewer or more convolutions.
 */
#include "cost.h"

#include <math.h>
#include <string.h>

/* ---- expected times ---- */

/* The measured trial with the nearest values of all lists. */
static const struct cost_trial *
nearest(const struct cost_case *c, const struct cost_trial *t)
{
    const struct cost_trial *near = NULL;
    double least = INFINITY;

    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *m = &c->trial[k];
        double off = 0;

        for (size_t l = 0; l < c->lists; l++) {
            const struct cost_list *list = &c->list[l];
            const double ratio = list->number[m->pick[l]] / list->number[t->pick[l]];

            if (m->pick[l] != t->pick[l])
                off += list->numbers && ratio > 0 ? fabs(log(ratio)) : 1e3;
        }
        if (m->state == COST_DONE && off < least) {
            least = off;
            near = m;
        }
    }
    return near;
}

/* Expected seconds of the programs that have not run. */
static double
expect(const struct cost_case *c, const struct cost_trial *t)
{
    const struct cost_trial *near = nearest(c, t);
    double sum = 0, ratio;

    if (near == NULL || t->runs == 0)
        return c->run == NULL || t->runs == 0 ? NAN : c->run[t->run[0]].planned;
    ratio = c->run[t->run[0]].planned / c->run[near->run[0]].planned;
    if (!(ratio > 0)) {
        const struct rc_shape own = cost_shape(c, t), of = cost_shape(c, near);

        ratio = (double)(own.nx * own.ny) / (double)(of.nx * of.ny);
    }
    for (size_t k = 0; k < t->runs; k++)
        if (c->run[t->run[k]].state == COST_OPEN)
            sum += c->run[near->run[k]].seconds * ratio + c->around;
    return sum;
}

/* ---- the order ---- */

bool
cost_is_near(const struct cost_case *c, const struct cost_trial *t)
{
    return t->state == COST_DONE && t->converged && !t->optimistic && t->bound <= c->error;
}

/* Seconds beyond which a trial is not needed for the choice, once something has been measured. They are three
 * times those of the fastest trial that is accurate enough, or of the budget. Expected times may be wrong by
 * this factor. */
static double
too_slow(const struct cost_case *c)
{
    double least = INFINITY;

    if (!c->choosing || c->shown)
        return INFINITY;
    for (size_t k = 0; k < c->trials; k++)
        if (cost_is_near(c, &c->trial[k]))
            least = fmin(least, c->trial[k].seconds);
    return 3 * (isnan(c->budget) ? least : c->budget) + c->around;
}

static bool
fits(const struct cost_case *c, struct cost_trial *t, double left)
{
    if (!(left > 0))
        snprintf(t->why, sizeof t->why, "left out: nothing is left of --limit");
    else if (t->expected > left)
        snprintf(t->why, sizeof t->why,
                 "left out: it would take about %.2g s, and %.2g s are left of --limit",
                 t->expected, left);
    else if (t->expected > too_slow(c))
        snprintf(t->why, sizeof t->why, "left out: about %.2g s, it would not be chosen",
                 t->expected);
    else
        return true;
    t->state = COST_LEFT_OUT;
    return false;
}

/* Seconds of --limit that the trials have left. */
static double
left(const struct cost_case *c)
{
    return c->limit - c->spent - (c->began > 0 ? tool_now() - c->began : 0);
}

/* Runs a trial before the others, in the time of --limit. */
static void
run_early(struct cost_case *c, size_t k)
{
    const double start = tool_now();

    c->trial[k].expected = expect(c, &c->trial[k]);
    if (c->trial[k].state == COST_OPEN && fits(c, &c->trial[k], left(c)))
        cost_trial_run(c, k, left(c));
    c->spent += tool_now() - start;
}

/* Fraction of the limit: trials with a longer expected time come last, because they may use up the time.
 * Before them fast trials are repeated. */
static const double slow = 1 / 30.0;

/* True if the trial took longer than another one that does the same and further work: other programs then
 * took part of its time. */
static bool
disturbed(const struct cost_case *c, const struct cost_trial *t)
{
    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *o = &c->trial[k];
        bool more = o->state == COST_DONE && t->seconds > 1.1 * o->seconds;

        for (size_t l = 0; l < c->lists && more; l++)
            more = o->pick[l] == t->pick[l] ||
                   (c->list[l].numbers && cost_list_rank(&c->list[l], o->pick[l]) >=
                                              cost_list_rank(&c->list[l], t->pick[l]));
        if (more)
            return true;
    }
    return false;
}

bool
cost_again(double runs, double seconds)
{
    return runs < 5 && runs * seconds < 0.5;
}

/* Repeats trials in turns, so that a disturbance does not affect one trial alone. */
static void
repeat(struct cost_case *c)
{
    bool more = true;

    while (more && tool_interrupted() == 0) {
        more = false;
        c->turn++;
        for (size_t k = 0; k < c->trials && tool_interrupted() == 0; k++) {
            struct cost_trial *t = &c->trial[k];

            for (size_t i = 0; i < t->runs && t->state == COST_DONE; i++) {
                struct cost_run *r = &c->run[t->run[i]];
                const size_t runs = r->runs;

                if (r->turn == c->turn || r->seconds + c->around > left(c) ||
                    !(cost_again((double)runs, r->seconds) ||
                      (runs < 2 && r->seconds < slow * c->limit) || (runs < 9 && disturbed(c, t))))
                    continue;
                r->turn = c->turn;
                cost_run_again(c, t, t->run[i], left(c));
                more = more || c->run[t->run[i]].runs > runs;
            }
            if (t->state == COST_DONE)
                cost_trial_sum(c, t);
        }
    }
}

/* The fastest trial that has not been run. */
static size_t
next(struct cost_case *c)
{
    size_t least = SIZE_MAX;

    for (size_t k = 0; k < c->trials; k++) {
        struct cost_trial *t = &c->trial[k];

        if (t->state != COST_OPEN)
            continue;
        t->expected = expect(c, t);
        if (least == SIZE_MAX || t->expected < c->trial[least].expected)
            least = k;
    }
    return least;
}

/* ---- the reference ---- */

/* True if the first trial does much more work than the second. */
static bool
costs_more(const struct cost_trial *a, const struct cost_trial *b)
{
    return isnan(a->convolutions) || isnan(b->convolutions)
               ? a->processor > 1.5 * b->processor
               : a->convolutions > 1.1 * b->convolutions;
}

void
cost_find_directions(struct cost_case *c)
{
    for (size_t l = 0; l < c->lists && tool_interrupted() == 0; l++) {
        struct cost_list *list = &c->list[l];
        size_t low = 0, high = 0, of[2];

        if (!list->numbers || list->tight != 0)
            continue;
        for (size_t k = 0; k < list->given; k++) {
            low = list->number[k] < list->number[low] ? k : low;
            high = list->number[k] > list->number[high] ? k : high;
        }
        for (size_t k = 0; k < 2; k++) { /* with the last values of the other lists */
            size_t pick[COST_LISTS];

            for (size_t i = 0; i < c->lists; i++)
                pick[i] = c->list[i].given - 1;
            pick[l] = k == 0 ? low : high;
            of[k] = cost_trial_find(c, pick, false);
            cost_plan(c, &c->trial[of[k]]);
            if (low != high)
                run_early(c, of[k]);
        }
        if (low == high || c->trial[of[0]].state != COST_DONE || c->trial[of[1]].state != COST_DONE)
            continue; /* cost_list_close chooses */
        if (costs_more(&c->trial[of[0]], &c->trial[of[1]]))
            list->tight = -1;
        if (costs_more(&c->trial[of[1]], &c->trial[of[0]]))
            list->tight = 1;
    }
}

/* The trial of these values, with its plan. */
static size_t
add_trial(struct cost_case *c, const size_t pick[COST_LISTS], bool reference)
{
    const size_t k = cost_trial_find(c, pick, true);

    c->trial[k].reference = reference;
    cost_plan(c, &c->trial[k]);
    return k;
}

/* Runs the trial of these values as the reference. */
static const struct cost_trial *
try_reference(struct cost_case *c, const size_t pick[COST_LISTS])
{
    c->reference = add_trial(c, pick, true);
    if (c->trial[c->reference].state == COST_OPEN)
        cost_trial_run(c, c->reference, c->limit);
    if (tool_interrupted() != 0)
        tool_die(c->tool, "interrupted before anything was measured");
    return &c->trial[c->reference];
}

/* Ends the tool. A reference that was stopped needs more time, or less accuracy. */
static void
no_reference(const struct cost_case *c, const struct cost_trial *t)
{
    const bool late = strstr(t->why, "stopped after") != NULL;
    char name[160], more[320] = "";

    if (late && c->lists > 0)
        snprintf(more, sizeof more,
                 " (%s): raise --limit, or give lists that end at less accurate values, as in "
                 "--tol 1e-1,1e-2",
                 cost_name(c, t, false, name));
    else if (late)
        snprintf(more, sizeof more, ": raise --limit");
    tool_die_at(c->tool, c->usage ? NULL : c->first, c->usage ? EXIT_USAGE : EXIT_IMPOSSIBLE,
                "no reference: %s%s", strncmp(t->why, "left out: ", 10) == 0 ? t->why + 10 : t->why,
                more);
}

/* Runs the reference. If the step beyond the tightest values fails, these are the reference. */
static void
run_reference(struct cost_case *c)
{
    size_t pick[COST_LISTS], beyond = 0;
    const struct cost_trial *t;

    for (size_t l = 0; l < c->lists; l++)
        pick[l] = c->list[l].reference;
    t = try_reference(c, pick);
    for (size_t l = 0; l < c->lists && t->state != COST_DONE; l++)
        if (!c->list[l].fixed && !c->list[l].grid && c->list[l].last != SIZE_MAX &&
            pick[l] >= c->list[l].given) {
            cost_list_shorten(&c->list[l]);
            pick[l] = c->list[l].reference;
            beyond++;
        }
    if (beyond > 0 && strncmp(t->why, "stopped", 7) != 0) {
        c->trial[c->reference].reference = false;
        t = try_reference(c, pick);
    }
    if (t->state != COST_DONE)
        no_reference(c, t);
}

void
cost_run_reference(struct cost_case *c)
{
    run_reference(c);
    cost_reference_read(c);
    for (size_t l = 0; l < c->lists && tool_interrupted() == 0; l++) {
        size_t pick[COST_LISTS];

        if (c->list[l].last == SIZE_MAX)
            continue;
        memcpy(pick, c->trial[c->reference].pick, sizeof pick);
        pick[l] = c->list[l].last;
        run_early(c, add_trial(c, pick, false));
    }
}

void
cost_run_trials(struct cost_case *c)
{
    bool quick = true;

    c->began = tool_now();
    while (tool_interrupted() == 0) {
        const size_t k = next(c);

        cost_judge(c);
        if (quick && (k == SIZE_MAX || c->trial[k].expected > slow * c->limit)) {
            quick = false;
            repeat(c);
        } else if (k == SIZE_MAX) {
            break;
        } else if (fits(c, &c->trial[k], left(c))) {
            cost_trial_run(c, k, left(c));
        }
    }
    repeat(c);
    cost_judge(c);
}
