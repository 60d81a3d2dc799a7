/*
 * Which rungs are run, in what order, and how often.
 */
#include "cost.h"

#include <math.h>
#include <string.h>

enum {
    SMALLEST = 8 /* nodes along a side from which a coarser grid is worth a look */
};

/* What can be said of a rung before it runs: it cannot be done, or need not. */
static const char *
obstacle(const struct cost_case *c, const struct cost *m)
{
    bool summed = strncmp(m->rung.kernel, "fft", 3) != 0;
    struct rc_problem problem = c->problem;
    size_t least = m->shape.nx < m->shape.ny ? m->shape.nx : m->shape.ny;

    problem.engine = m->rung.kernel;
    problem.method = m->rung.method;
    problem.tol = m->rung.tol;
    if (summed && c->problem.boundary == RC_PERIODIC)
        return "left out: on a periodic boundary only fft sums";
    if (m->rung.coarse > 1 && (least == 1 ? m->shape.nx * m->shape.ny : least) < SMALLEST)
        return "left out: the grid is too small to be coarsened so far";
    if (m->rung.coarse > 1 && c->choosing && !c->shown)
        return "left out: rc-solve does not coarsen";
    if (c->tool->memory != 0 && rc_solver_memory(&m->shape, &problem) > c->tool->memory)
        return "left out: it needs more than --memory";
    return NULL;
}

void
cost_sift(struct cost_case *c)
{
    for (size_t k = 0; k < c->rungs; k++) {
        struct cost *m = &c->rung[k];
        const char *why = obstacle(c, m);

        if (why == NULL)
            continue;
        m->state = COST_LEFT_OUT;
        snprintf(m->why, sizeof m->why, "%s", why);
    }
}

/* Time beyond which a rung need not be tried to make the choice: three times that of the
 * quickest that is good enough, or of the budget, once anything has been measured. Expectations
 * may be that far off. */
static double
too_slow(const struct cost_case *c)
{
    double least = INFINITY;
    bool any = false;

    for (size_t k = 0; k < c->rungs; k++) {
        const struct cost *m = &c->rung[k];

        if (m->state != COST_DONE || m->rung.coarse > 1)
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
fits(const struct cost_case *c, struct cost *m, double left)
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
    return c->limit - (cost_now() - c->began);
}

/* Before what is slow begins, and may use up the time, what is quick is timed well, and stresses
 * have their turn. */
static const double slow = 1 / 30.0;

/* Whether it took longer than one that does the same and more: then others were at work beside it. */
static bool
disturbed(const struct cost_case *c, const struct cost *m)
{
    for (size_t k = 0; k < c->rungs; k++) {
        const struct cost *o = &c->rung[k];

        if (o->state == COST_DONE && strcmp(o->rung.method, m->rung.method) == 0 &&
            strcmp(o->rung.kernel, m->rung.kernel) == 0 && o->rung.coarse <= m->rung.coarse &&
            o->rung.tol <= m->rung.tol && m->seconds > 1.1 * o->seconds)
            return true;
    }
    return false;
}

static bool
again(const struct cost_case *c, const struct cost *m)
{
    if (m->state != COST_DONE || m->seconds > left(c))
        return false;
    return cost_again(m->runs, m->seconds) || (m->runs < 2 && m->seconds < slow * c->limit) ||
           (m->runs < 5 && disturbed(c, m));
}

/* In turns, so that a disturbance does not fall on one rung alone. */
static void
repeat(struct cost_case *c)
{
    bool more = true;

    while (more && tool_interrupted() == 0) {
        more = false;
        for (size_t k = 0; k < c->rungs && tool_interrupted() == 0; k++)
            if (again(c, &c->rung[k])) {
                more = true;
                cost_solve(c, &c->rung[k], left(c), NULL);
            }
    }
}

/* In half of the time that is left. */
static void
climb_stresses(struct cost_case *c)
{
    double end = cost_now() + left(c) / 2;

    if (c->stresses > 0 && c->depths.n == 0 && tool_interrupted() == 0)
        cost_stress_depths(c);
    for (size_t k = 0; k < c->stresses && tool_interrupted() == 0; k++) {
        struct cost_stress *s = &c->stress[k];
        double rest = fmax(end - cost_now(), 0);

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
static struct cost *
next(struct cost_case *c)
{
    struct cost *least = NULL;

    for (size_t k = 0; k < c->rungs; k++) {
        struct cost *m = &c->rung[k];

        if (m->state != COST_OPEN)
            continue;
        m->expected = cost_expect(c, m);
        if (least == NULL || m->expected < least->expected)
            least = m;
    }
    return least;
}

void
cost_climb(struct cost_case *c)
{
    bool quick = true;

    c->began = cost_now();
    while (tool_interrupted() == 0) {
        struct cost *m = next(c);

        if (quick && (m == NULL || m->expected > slow * c->limit)) {
            quick = false;
            repeat(c);
            climb_stresses(c);
        } else if (m == NULL) {
            break;
        } else if (fits(c, m, left(c))) {
            cost_solve(c, m, left(c), NULL);
        }
    }
    repeat(c);
}
