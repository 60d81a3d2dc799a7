/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * An effect that is not part of rc-solve, in one file and one row of a list: --settle-time, the contact on a
 * bed of springs, which is the model of relaxing.c around that of the other effects.
 */
#include <math.h>

#include "relaxing.h"
#include "tools/solve/solve.h"

static struct {
    double compliance, tau;
    struct numbers time;
} args = {.tau = 1};

/* clang-format off */
static const struct opt options[] = {
    {.name = "settle-time", .type = OPT_NUMBERS, .unit = UNIT_S, .base = &args.time,
     .min = 0, .max = INFINITY,
     .above = true, .result = true, .points = true, .arg = "LIST", .help = "times of the loads, each a case",
     .needs = RULES({.with = "settle-compliance", .because = "nothing settles"}),
     .against = RULES({.with = "yield|adhesion|relaxation|travel|tilt free",
                       .because = "it is not implemented"})},
    {.name = "settle-compliance", .type = OPT_NUMBER, .base = &args.compliance, .min = 0, .max = INFINITY,
     .above = true, .result = true, .arg = "M/PA", .help = "final settlement over pressure",
     .needs = RULES({.with = "settle-time"})},
    {.name = "settle-tau", .type = OPT_NUMBER, .unit = UNIT_S, .base = &args.tau, .min = 0, .max = INFINITY,
     .above = true, .result = true, .arg = "TIME", .help = "time constant (default 1 s)",
     .needs = RULES({.with = "settle-time"})},
    {.name = NULL},
};
/* clang-format on */

static bool
ask(struct run *run)
{
    (void)run;
    return args.time.n > 0;
}

static struct rc_model *
put_around(struct run *run, struct rc_model *inner)
{
    const struct toy_relaxing law = {args.compliance, args.tau,
                                     run->args->tol > 0 ? run->args->tol : 1e-3};

    return tool_made(&run->d.t, run->g, toy_relaxing_new(inner, run->g->v, &law, &run->d.t.err));
}

static void
set_keys(struct run *run, struct rc_grid *g)
{
    tool_set_number(&run->d.t, g, "time", run->d.point[run->d.at].at[RC_TIME]);
}

static void
report(struct report *r, const struct run *run)
{
    report_number(r, "settle_time", run->d.point[run->d.at].at[RC_TIME], "s");
    report_number(r, "mean_settlement", rc_model_number(run->model, "mean_settlement"), "m");
    report_number(r, "step_error", rc_model_number(run->model, "step_error"), NULL);
}

const struct effect solve_effect_settling = {
    .name = "settling",
    .title = "settling",
    .options = options,
    .ask = ask,
    .sequence = true,
    .axis = RC_TIME,
    .list = &args.time,
    .noun = "time",
    .outer = put_around,
    .keys = set_keys,
    .frames = (const char *const[]){"settlement", NULL},
    .frames_alone = "needs --settle-time",
    .off = "left out: no --settle-time",
    .report = report,
};
