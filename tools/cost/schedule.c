/*
 * Which trials are run, in what order, and how often.
 */
#include "cost.h"

#include <math.h>
#include <string.h>

enum {
    SMALLEST = 8 /* nodes along a side from which a coarser grid is worth a look */
};

/* Why a trial cannot be run, or need not be; NULL: it is to be run. */
static const char *
obstacle(const struct cost_case *c, const struct cost_trial *m)
{
    static char text[200];
    char list[128];
    size_t least = m->shape.nx < m->shape.ny ? m->shape.nx : m->shape.ny;

    if (c->problem.boundary == RC_PERIODIC && !words_engine_named(m->settings.kernel)->periodic) {
        snprintf(text, sizeof text, "left out: on a periodic boundary only %s sums",
                 words_periodic_engines(list, sizeof list));
        return text;
    }
    if (m->settings.coarse > 1 && (least == 1 ? m->shape.nx * m->shape.ny : least) < SMALLEST)
        return "left out: the grid is too small to be coarsened so far";
    if (c->tool->memory != 0 && cost_memory(c, m) > c->tool->memory)
        return "left out: it needs more than --memory";
    return NULL;
}

void
cost_exclude(struct cost_case *c)
{
    for (size_t k = 0; k < c->trials; k++) {
        struct cost_trial *m = &c->trial[k];
        const char *why = obstacle(c, m);

        if (why == NULL)
            continue;
        m->state = COST_LEFT_OUT;
        snprintf(m->why, sizeof m->why, "%s", why);
    }
}

/* Seconds beyond which a trial need not be run to make the choice: three times those of the
 * quickest that is good enough, or of the budget, once anything has been measured. Expectations may
 * be that far off. */
static double
too_slow(const struct cost_case *c)
{
    double least = INFINITY;
    bool any = false;

    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *m = &c->trial[k];

        if (m->state != COST_DONE)
            continue;
        any = true;
        if (m->error <= c->error)
            least = fmin(least, m->seconds);
    }
    if (!c->choosing || c->shown || !any)
        return INFINITY;
    return 3 * (isnan(c->budget) ? least : c->budget);
}

static bool
fits(const struct cost_case *c, struct cost_trial *m, double left)
{
    if (m->expected > left)
        snprintf(m->why, sizeof m->why,
                 "left out: it would take about %.2g s, and %.2g s are left of --limit",
                 m->expected, fmax(left, 0));
    else if (m->expected > too_slow(c))
        snprintf(m->why, sizeof m->why, "left out: about %.2g s, it would not be chosen",
                 m->expected);
    else
        return true;
    m->state = COST_LEFT_OUT;
    return false;
}

static double
left(const struct cost_case *c)
{
    return c->limit - (tool_now() - c->began);
}

/* Part of the limit: trials that are expected to take more come last, because they may use up the
 * time. Before them the quick ones are repeated and the stresses are run. */
static const double slow = 1 / 30.0;

/* Whether it took longer than a trial that does the same work and more: then other programs took
 * part of its time. */
static bool
disturbed(const struct cost_case *c, const struct cost_trial *m)
{
    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *o = &c->trial[k];

        if (o->state == COST_DONE && strcmp(o->settings.method, m->settings.method) == 0 &&
            strcmp(o->settings.kernel, m->settings.kernel) == 0 &&
            o->settings.coarse <= m->settings.coarse && o->settings.tol <= m->settings.tol &&
            o->settings.increments >= m->settings.increments &&
            o->settings.stack >= m->settings.stack && m->seconds > 1.1 * o->seconds)
            return true;
    }
    return false;
}

bool
cost_again(size_t runs, double seconds)
{
    return runs < 5 && (double)runs * seconds < 0.5;
}

static bool
again(const struct cost_case *c, const struct cost_trial *m)
{
    if (m->state != COST_DONE || m->seconds > left(c))
        return false;
    return cost_again(m->runs, m->seconds) || (m->runs < 2 && m->seconds < slow * c->limit) ||
           (m->runs < 5 && disturbed(c, m));
}

/* In turns, so that a disturbance does not fall on one trial alone. */
static void
repeat(struct cost_case *c)
{
    bool more = true;

    while (more && tool_interrupted() == 0) {
        more = false;
        for (size_t k = 0; k < c->trials && tool_interrupted() == 0; k++)
            if (again(c, &c->trial[k])) {
                more = true;
                cost_trial_run(c, &c->trial[k], left(c), NULL);
            }
    }
}

/* In half of the time that is left. */
static void
run_stresses(struct cost_case *c)
{
    double end = tool_now() + left(c) / 2;

    if (c->stresses > 0 && c->depths.n == 0 && tool_interrupted() == 0)
        cost_stress_depths(c);
    for (size_t k = 0; k < c->stresses && tool_interrupted() == 0; k++) {
        struct cost_stress *s = &c->stress[k];
        double rest = fmax(end - tool_now(), 0);

        s->expected = cost_expect_stress(c, s);
        if (s->expected <= rest) {
            cost_stress_run(c, s, rest);
            continue;
        }
        s->state = COST_LEFT_OUT;
        snprintf(s->why, sizeof s->why,
                 "left out: it would take about %.2g s, and %.2g s are left for stresses",
                 s->expected, rest);
    }
}

/* The quickest that is still to be run. */
static struct cost_trial *
next(struct cost_case *c)
{
    struct cost_trial *least = NULL;

    for (size_t k = 0; k < c->trials; k++) {
        struct cost_trial *m = &c->trial[k];

        if (m->state != COST_OPEN)
            continue;
        m->expected = cost_expect(c, m);
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
        } else if (fits(c, m, left(c))) {
            cost_trial_run(c, m, left(c), NULL);
        }
    }
    repeat(c);
}
