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
    .off = "left out: no --discretization",
    .state = state,
};
