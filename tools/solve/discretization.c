/* SPDX-License-Identifier: GPL-3.0-or-later */
/* --discretization: estimates the discretization error from a second solution on a coarser grid. */
#include "solve.h"

static bool on;

/* clang-format off */
static const struct opt options[] = {
    {.name = "discretization", .type = OPT_FLAG, .base = &on,
     .help = "estimate the discretization error, from a second solution on a coarser grid"},
    {.name = NULL},
};
/* clang-format on */

static bool
ask(struct run *run)
{
    (void)run;
    return on;
}

static void
set_problem(struct run *run, struct rc_problem *problem)
{
    (void)run;
    problem->discretization = true;
}

static void
judge(struct run *run, const char *where, const struct solution *s)
{
    const struct rc_contact *c = &s->contact;
    const struct rc_discretization *d = &c->discretization;

    tool_note(&run->d.t,
              "%s: estimated error by the grid: contact area %s, largest pressure %s, approach %s",
              where, shown_percent(d->contact_area, 2), shown_percent(d->max_pressure, 2),
              shown_percent(d->approach, 2));
    if (c->edge_pressure > 0 && !c->hardness_active)
        course_warn(
            &run->d.course, "no error of the grid at the edge of the map",
            "%s: the contact is at the edge of the map, where a finer grid raises the pressure "
            "without limit: largest pressure and approach have no estimate of the grid: take a "
            "wider map",
            where);
}

static const char *
state(const struct run *run)
{
    return run->d.course.resumed ? "left out: resumed, no coarser grid was solved" : "on";
}

const struct effect solve_effect_discretization = {
    .name = "discretization",
    .title = "accuracy",
    .options = options,
    .ask = ask,
    .problem = set_problem,
    .judge = judge,
    .off = "left out: no --discretization",
    .state = state,
};
