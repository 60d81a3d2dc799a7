/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Nodes yield at a hardness: --hardness, which all contacts have, or a map of it in the case. With --history
 * the shape that they leave stays for later loads.
 */
#include "solve.h"

#include <math.h>

static struct rc_grid *map; /* NULL: a number or none */

/* ---- hardness ---- */

static void
read(struct run *run)
{
    run->relief = "its --hardness, or ";
}

/* The hardness of a case is a number or a map. */
static void
take(struct run *run)
{
    const double *v = map != NULL ? map->v : &run->physics->hardness;
    double low = INFINITY, high = -INFINITY;

    physics_hardness(&run->d.t, map);
    for (size_t k = 0; k < (map != NULL ? rc_grid_nodes(map) : 1); k++)
        if (isfinite(v[k])) {
            low = fmin(low, v[k]);
            high = fmax(high, v[k]);
        }
    run->bound_min = -ranks_most(&run->d.t, -low);
    run->bound_max = ranks_most(&run->d.t, high);
    run->bound_varies = map != NULL;
}

static void
set_problem(struct run *run, struct rc_problem *problem)
{
    (void)run;
    problem->hardness_map = map != NULL ? map->v : NULL;
}

static bool
judge_high(struct run *run, const char *where, const struct solution *s)
{
    if (!isfinite(run->bound_max) || !(run->bound_max >= s->peak))
        return false;
    course_warn(&run->d.course, "a pressure at which a solid is not linear elastic",
                "%s: the %s, %s, is %.2g of E*: beyond %g a solid is not linear elastic, and "
                "--hardness, %s, is above that: is its unit right?",
                where, s->peak_name, shown_in_unit(s->peak, "Pa"),
                s->peak / run->physics->surface_estar, SOLVE_LINEAR,
                shown_in_unit(run->bound_max, "Pa"));
    return true;
}

static void
set_keys(struct run *run, struct rc_grid *g)
{
    tool_set_number(&run->d.t, g, "hardness", run->physics->hardness);
    if (map != NULL)
        tool_set(&run->d.t, g, "hardness_map", "yes");
}

static const char *
state(const struct run *run)
{
    if (isinf(run->bound_min))
        return map != NULL ? "left out: the map of hardness holds no number"
                           : "left out: no --hardness, and no map of hardness in the case";
    if (run->args->drive.dry_run)
        return "on: computed where the elastic pressure exceeds the hardness";
    return run->solution.contact.hardness_active
               ? "on"
               : "left out: the largest elastic pressure is below it";
}

static void
report(struct report *r, const struct run *run)
{
    report_number(r, "hardness_min", run->bound_min, "Pa");
    report_number(r, "hardness_max", run->bound_max, "Pa");
}

const struct effect solve_effect_hardness = {
    .name = "hardness",
    .read = read,
    .map = {"hardness", &map},
    .beside = true,
    .take = take,
    .problem = set_problem,
    .high = judge_high,
    .keys = set_keys,
    .state = state,
    .place = COLUMNS_OF_BOUNDS,
    .report = report,
};

/* ---- history ---- */

static void
warn_of_nothing(struct run *run)
{
    if (run->physics->history && isinf(run->bound_min) && SOLVE_FIRST(run, sequence) == NULL)
        tool_warn(&run->d.t,
                  "--history has no effect, because nothing yields without --hardness, a "
                  "map of it, or --yield: give one of them");
}

/* Sets the fraction of the tolerance for a load at which nodes yield. The error of its shape stays for
 * later loads, and relative to a smaller load it is larger: the sum stays within the tolerance. 0: no
 * load changes the shape. */
static void
set_part(struct run *run, struct rc_problem *problem)
{
    const struct numbers *steps = run->steps;
    /* the load grows at most with this power of the approach */
    const double power = run->physics->approach.n > 0 ? 2 : 1;
    double most = 0, smallest = 1;

    if (!run->physics->history || isinf(run->bound_min) || steps->n < 2)
        return;
    for (size_t k = 0; k < steps->n; k++) {
        most = fmax(most, steps->v[k]);
        if (steps->v[k] > 0)
            smallest = fmin(smallest, steps->v[k] / most);
    }
    problem->history_part = pow(smallest, power) / fmax(10, (double)steps->n);
}

/* The dents. */
static size_t
bytes(const struct run *run)
{
    return run->physics->history && !isinf(run->bound_min) ? sizeof(double) : 0;
}

static const char *
state_of_history(const struct run *run)
{
    return run->physics->history ? "on: each load acts on the shape after the previous load"
                                 : "left out: no --history";
}

static void
report_history(struct report *r, const struct run *run)
{
    solve_report_named(r, run,
                       "indentation residual_indentation contact_area_inside "
                       "contact_fraction_inside");
}

const struct effect solve_effect_history = {
    .name = "history",
    .take = warn_of_nothing,
    .problem = set_part,
    .bytes = bytes,
    .state = state_of_history,
    .place = COLUMNS_OF_BODIES,
    .report = report_history,
};

/* Its option is below those of the effects that imply it, so that a checkpoint is refused by their
 * names first. */

static bool given;

/* clang-format off */
static const struct opt options[] = {
    {.group = history_option, .base = &given},
    {.name = NULL},
};
/* clang-format on */

static bool
ask(struct run *run)
{
    run->physics->history = run->physics->history || given;
    return given;
}

const struct effect solve_effect_sequence = {
    .title = "load and bodies", .options = options, .ask = ask};
