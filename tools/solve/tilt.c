/* SPDX-License-Identifier: GPL-3.0-or-later */
/* --tilt free: the counter body turns until no moment acts on it. */
#include "solve.h"

#include <math.h>
#include <string.h>

static struct tilt_args args;
static bool on;

/* clang-format off */
static const struct opt options[] = {
    {.group = tilt_options, .base = &args},
    {.name = NULL},
};
/* clang-format on */

static bool
ask(struct run *run)
{
    (void)run;
    on = args.tilt != NULL && strcmp(args.tilt, "free") == 0;
    return on;
}

static void
read(struct run *run)
{
    if (args.at.n > 0 && args.at.n != 2)
        tool_usage(&run->d.t, "--at: it must be X,Y, from the middle of the map, as in 0.1mm,0");
}

static void
set_problem(struct run *run, struct rc_problem *problem)
{
    (void)run;
    problem->tilt_free = true;
    for (size_t k = 0; k < args.at.n; k++)
        problem->force_at[k] = args.at.v[k];
}

static bool
end(struct run *run, const char *where, const struct solution *s)
{
    const struct rc_contact *c = &s->contact;
    char error[64] = "its error is unknown";

    if (c->converged || tool_interrupted() != 0 || !c->hardness_active)
        return false;
    if (!isnan(c->pressure_error))
        snprintf(error, sizeof error, "its estimated error is %.2g", c->pressure_error);
    course_warn(
        &run->d.course, "stopped short",
        "%s: not converged after %zu iterations: %s: yielding nodes may not be able to balance "
        "the load at this point: move --at nearer to the middle, or raise --hardness",
        where, c->iterations, error);
    return true;
}

static void
report(struct report *r, const struct run *run)
{
    report_number(r, "tilt_x", on ? atan(run->solution.contact.tilt[0]) : NAN, "rad");
    report_number(r, "tilt_y", on ? atan(run->solution.contact.tilt[1]) : NAN, "rad");
}

const struct effect solve_effect_tilt = {
    .name = "tilt",
    .title = "load and bodies",
    .options = options,
    .ask = ask,
    .read = read,
    .problem = set_problem,
    .end = end,
    .off = "left out: no --tilt free",
    .place = COLUMNS_OF_BODIES,
    .columns = true,
    .report = report,
};
