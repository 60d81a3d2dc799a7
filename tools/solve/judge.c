/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Messages about a solution on standard error: warnings of its limits, and its figures with --verbose.
 */
#include "solve.h"

#include <math.h>

static const double no_modulus = 1e5; /* Pa: lower than E* of any solid */
/* Fewest nodes that resolve a contact on a profile and on a map, and one of its patches. */
static const size_t fewest_nodes[] = {20, 100};
static const double fewest_each = 4;

bool
solve_pulls_off(const struct run *run)
{
    const struct rc_point *to = &run->d.point[run->d.at];

    return (to->given >> RC_APPROACH & 1) && isinf(to->at[RC_APPROACH]);
}

const char *
solve_where(const struct run *run, const struct rc_grid *g, char *text, size_t size)
{
    const struct physics *a = run->physics;
    const char *source = rc_grid_get(g, "source"), *name = "approach", *unit = "m";
    char axes[2 * SHOWN_NUMBER + 64] = "";
    size_t at = 0;

    for (size_t k = 0; k < RC_AXES && at < sizeof axes; k++)
        if (k != RC_LOAD && k != RC_APPROACH && (run->d.point[run->d.at].given >> k & 1)) {
            double value = run->asked != NULL && (k == RC_TIME || k == RC_SPEED)
                               ? run->asked[run->d.at]
                               : run->d.point[run->d.at].at[k];

            at += (size_t)snprintf(axes + at, sizeof axes - at, ", %s %s", rc_axis_info(k)->name,
                                   shown_in_unit(value, rc_axis_info(k)->unit));
        }
    if (source == NULL)
        source = run->d.t.input.source == NULL ? "standard input" : run->d.t.input.source;
    if (a->load.n > 0) {
        name = "load";
        unit = a->load.per_metre ? "N/m" : "N";
    } else if (a->mean_pressure.n > 0) {
        name = "mean pressure";
        unit = "Pa";
    }
    if (solve_pulls_off(run))
        snprintf(text, size, "%s, case %zu, pull-off", source, run->d.course.number);
    else
        snprintf(text, size, "%s, case %zu, %s %s%s", source, run->d.course.number, name,
                 shown_in_unit(run->steps->v[run->step], unit), axes);
    return text;
}

/* ---- beyond the theory ---- */

/* Warns of a pressure above E*, which no solid carries: a unit is probably wrong. */
static void
suspect_unit(struct run *run, const char *where, const struct solution *s)
{
    const struct rc_grid *g = run->g;
    double width = g->dx * (double)g->nx, length = g->dy * (double)g->ny;
    double estar = run->physics->surface_estar;
    char peak[SHOWN_NUMBER], modulus[SHOWN_NUMBER], mean[SHOWN_NUMBER];
    const char *name = s->peak_name;

    shown_in_unit_to(peak, s->peak, "Pa");
    shown_in_unit_to(modulus, estar, "Pa");
    shown_in_unit_to(mean, s->contact.mean_pressure, "Pa");
    if (estar < no_modulus)
        course_warn(&run->d.course, "the largest pressure is above E*",
                    "%s: the %s, %s, is above E*, which is %s: was its unit forgotten, as in "
                    "114GPa?",
                    where, name, peak, modulus);
    else if (s->contact.mean_pressure > SOLVE_LINEAR * estar)
        course_warn(&run->d.course, "the largest pressure is above E*",
                    "%s: the %s, %s, is above E* = %s; on a map of %s by %s the mean is %s: "
                    "are the load, %s, and E* in their right units?",
                    where, name, peak, modulus, shown_in_unit(width, "m"),
                    shown_in_unit(length, "m"), mean, shown_in_unit(s->contact.load, "N"));
    else
        course_warn(
            &run->d.course, "the largest pressure is above E*",
            "%s: the %s, %s, is above E* = %s, and the RMS slope in contact is %.3g: are heights "
            "and spacings in their right units (rc-import --z-unit, --dx)?",
            where, name, peak, modulus, s->slope);
}

static bool
is_high(struct run *run, const char *where, const struct solution *s)
{
    bool warned = false;

    SOLVE_EACH (run, e, high)
        warned = warned || e->high(run, where, s);
    return warned;
}

void
solve_warn_of_theory(struct run *run, const char *where, const struct solution *s)
{
    const double soft =
        1e8; /* Pa: rubbers and gels are softer; metals, ceramics, hard polymers are not */
    const bool creeps = s->softer > 1;
    const double estar = run->physics->surface_estar / (creeps ? s->softer : 1);
    const char *of = creeps                      ? "E* at this time"
                     : run->physics->relaxes > 0 ? "the instantaneous E*"
                                                 : "E*";

    if (s->peak > run->physics->surface_estar)
        suspect_unit(run, where, s);
    else if (s->peak > SOLVE_LINEAR * estar && estar < soft && !is_high(run, where, s))
        course_warn(
            &run->d.course, "a pressure at which a solid is not linear elastic",
            "%s: the %s, %s, is %.2g of %s: beyond %g a solid is not linear elastic, and "
            "the result is an estimate. So soft a solid does not yield: a hardness does not "
            "help. Solve it also with a smaller load or with the short wavelengths removed "
            "(rc-detrend --lowpass): figures that change much depend on these pressures",
            where, s->peak_name, shown_in_unit(s->peak, "Pa"), s->peak / estar, of, SOLVE_LINEAR);
    else if (s->peak > SOLVE_LINEAR * estar && !is_high(run, where, s))
        course_warn(&run->d.course, "a pressure at which a solid is not linear elastic",
                    "%s: the %s, %s, is %.2g of %s: beyond %g a solid is not linear elastic: give "
                    "%sa smaller load",
                    where, s->peak_name, shown_in_unit(s->peak, "Pa"), s->peak / estar, of,
                    SOLVE_LINEAR, run->relief);
    drive_judge_slope(&run->d.course, s->slope, where);
}

/* ---- beyond the grid ---- */

/* At a sharp edge the pressure of a punch has no bound. */
static bool
is_punch(const struct rc_contact *c)
{
    return c->edge_pressure > 0 && c->edge_pressure >= c->max_pressure && !c->hardness_active;
}

static bool
reaches_edge(const struct run *run, const struct rc_contact *c)
{
    return rc_has_mean(run->physics->boundary) &&
           c->edge_load_fraction > rc_figure_find("edge_load_fraction")->limit;
}

static void
warn_of_reach(struct run *run, const char *where, const struct rc_contact *c)
{
    const struct physics *a = run->physics;
    char punch[128 + SHOWN_NUMBER] = "";

    if (is_punch(c))
        snprintf(punch, sizeof punch,
                 " and the largest pressure, %s, at the edge itself, where a finer grid raises it "
                 "without limit",
                 shown_in_unit(c->max_pressure, "Pa"));
    course_warn(&run->d.course, "the contact reaches the edge of the map",
                "%s: %.1f %% of the load is on the outer 2 %% of the map%s: the contact reaches "
                "its edge, beyond which there is no material: take a larger map%s",
                where, 100 * c->edge_load_fraction, punch,
                rc_repeats(a->boundary) > 0 ? " or a smaller load"
                : isnan(a->cylinder) ? ", a smaller load, or --periodic if the surface repeats"
                : physics_cylinder_axis(a, run->g) == RC_X
                    ? ", a smaller load, or --periodic=x if the roller continues along its axis"
                    : ", a smaller load, or --periodic=y if the roller continues along its axis");
}

static void
warn_of_edge(struct run *run, const char *where, const struct solution *s)
{
    const struct rc_contact *c = &s->contact;

    if (is_punch(c) && !reaches_edge(run, c))
        course_warn(&run->d.course, "the largest pressure is at the edge of the map",
                    "%s: the largest pressure, %s, is at the edge of the map, as under a punch: a "
                    "finer grid raises it without limit: take a wider map, or other figures",
                    where, shown_in_unit(c->max_pressure, "Pa"));
}

static void
warn_of_grid(struct run *run, const struct rc_grid *g, const char *where, const struct solution *s)
{
    bool map = g->nx > 1 && g->ny > 1;
    size_t nodes = s->contact.contact_nodes;

    if (nodes >= fewest_nodes[map] && (double)nodes >= fewest_each * (double)s->patches.count)
        return;
    course_warn(&run->d.course, "the grid does not resolve the contact",
                "%s: %zu %s in contact, in %zu %s: the grid does not resolve it: area and "
                "largest pressure may be far off: take a finer grid; --discretization estimates "
                "the error of the area",
                where, nodes, nodes == 1 ? "node" : "nodes", s->patches.count,
                s->patches.count == 1 ? "patch" : "patches");
}

/* ---- not converged ---- */

void
solve_warn_of_end(struct run *run, const char *where, const struct solution *s)
{
    const struct rc_contact *c = &s->contact;
    char error[64] = "its error is unknown";

    SOLVE_EACH (run, e, end)
        if (e->end(run, where, s))
            return;
    if (c->converged)
        return;
    if (!isnan(c->pressure_error))
        snprintf(error, sizeof error, "its estimated error is %.2g", c->pressure_error);
    if (tool_interrupted() != 0)
        tool_warn(&run->d.t,
                  "%s: interrupted after %zu iterations: the frames hold the best state so far, "
                  "not a solution: %s",
                  where, c->iterations, error);
    else if (c->inherited_error > c->pressure_error / 2)
        course_warn(&run->d.course, "stopped short",
                    "%s: %s, of which %.2g come from earlier loads, whose shape it has: take a "
                    "smaller --tol",
                    where, error, c->inherited_error);
    else
        course_warn(&run->d.course, "stopped short",
                    "%s: not converged after %zu iterations: %s: accept it with a larger --tol",
                    where, c->iterations, error);
}

/* ---- figures ---- */

static void
tell(struct run *run, const char *where, const struct solution *s)
{
    const struct rc_contact *c = &s->contact;
    char area[SHOWN_NUMBER];
    char yielded[SHOWN_NUMBER + 32] = "", took[96], error[32] = "";
    char over_nodes[SHOWN_NUMBER + 32] = "";

    if (c->yielded_nodes > 0) {
        shown_area_to(area, c->yielded_area);
        snprintf(yielded, sizeof yielded, "%s of it yields, ", area);
    }
    if (!isnan(c->pressure_error))
        snprintf(error, sizeof error, " to %.2g", c->pressure_error);
    if (s->peak != c->max_pressure)
        snprintf(over_nodes, sizeof over_nodes, " (%s over 2 x 2 nodes)",
                 shown_in_unit(s->peak, "Pa"));
    if (*s->took == '\0')
        snprintf(took, sizeof took, "%zu iterations, %.3g convolutions", c->iterations,
                 c->convolutions);
    tool_note(&run->d.t,
              "%s: force %s, contact area %s (%.3g %% of the map, %zu node%s in %zu %s), %slargest "
              "pressure %s%s, approach %s, mean gap %s; %s%s in %s, "
              "%.2g s",
              where, shown_in_unit(c->load, "N"), shown_area_to(area, c->contact_area),
              100 * c->contact_fraction, c->contact_nodes, c->contact_nodes == 1 ? "" : "s",
              s->patches.count, s->patches.count == 1 ? "patch" : "patches", yielded,
              shown_in_unit(c->max_pressure, "Pa"), over_nodes,
              isnan(c->approach) ? "unknown" : shown_in_unit(c->approach, "m"),
              shown_in_unit(c->mean_gap, "m"), c->converged ? "converged" : "not converged", error,
              *s->took != '\0' ? s->took : took, tool_now() - run->d.is.began);
}

void
solve_warn_of_limits(struct run *run, const char *where, const char *unstable)
{
    const struct drive_advice advice[] = {
        {"edge_load_fraction", NULL}, /* judge_pressure has its own warning */
        {"stability", unstable},
        {NULL, NULL}};

    drive_judge(&run->d.course, run->model, advice, where);
}

/* Of bodies that only press. */
static void
judge_pressure(struct run *run, const char *where, const struct solution *s)
{
    tell(run, where, s);
    SOLVE_EACH (run, e, judge)
        e->judge(run, where, s);
    solve_warn_of_limits(run, where, NULL);
    if (reaches_edge(run, &s->contact))
        warn_of_reach(run, where, &s->contact);
    if (tool_interrupted() == 0 && s->contact.contact_nodes > 0) {
        solve_warn_of_theory(run, where, s);
        warn_of_grid(run, run->g, where, s);
        warn_of_edge(run, where, s);
    }
    solve_warn_of_end(run, where, s);
}

void
solve_judge(struct run *run, const struct solution *s)
{
    const struct effect *alone = SOLVE_FIRST(run, judge_alone);
    char where[512];

    solve_where(run, run->g, where, sizeof where);
    (alone != NULL ? alone->judge_alone : judge_pressure)(run, where, s);
}
