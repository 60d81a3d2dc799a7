/*
 * Messages about a solution on standard error: warnings of its limits, and its figures with --verbose.
 */
#include "solve.h"

#include <math.h>

static const double linear = 0.1;     /* fraction of E*: above it a solid is not linear elastic */
static const double no_modulus = 1e5; /* Pa: lower than E* of any solid */
/* Fewest nodes that resolve a contact on a profile and on a map, and one of its patches. */
static const size_t fewest_nodes[] = {20, 100};
static const double fewest_each = 4;

const char *
solve_where(const struct run *run, const struct rc_grid *g, char *text, size_t size)
{
    const struct physics *a = &run->args->physics;
    const char *source = rc_grid_get(g, "source"), *name = "approach", *unit = "m";
    char position[SHOWN_NUMBER + 16] = "";

    if (run->travelling.wanted)
        snprintf(position, sizeof position, ", position %s",
                 shown_in_unit(travel_position(run, run->d.at), "m"));
    if (run->relaxing.wanted)
        snprintf(position, sizeof position, ", time %s",
                 shown_in_unit(relax_time(run, run->d.at), "s"));
    if (run->sliding.wanted)
        snprintf(position, sizeof position, ", speed %s",
                 shown_in_unit(slide_speed(run, run->d.at), "m/s"));
    if (source == NULL)
        source = run->d.t.source == NULL ? "standard input" : run->d.t.source;
    if (a->load.n > 0) {
        name = "load";
        unit = a->load.per_metre ? "N/m" : "N";
    } else if (a->mean_pressure.n > 0) {
        name = "mean pressure";
        unit = "Pa";
    }
    snprintf(text, size, "%s, case %zu, %s %s%s", source, run->d.course.number, name,
             shown_in_unit(run->steps->v[run->step], unit), position);
    return text;
}

/* ---- beyond the theory ---- */

/* Warns of a pressure above E*, which no solid carries: a unit is probably wrong. */
static void
suspect_unit(struct run *run, const struct rc_grid *g, const char *where, const struct solution *s)
{
    double width = g->dx * (double)g->nx, length = g->dy * (double)g->ny;
    double estar = run->args->physics.surface_estar;
    char peak[SHOWN_NUMBER], modulus[SHOWN_NUMBER], mean[SHOWN_NUMBER];
    const char *name;

    shown_in_unit_to(peak, yield_peak(run, s->contact.max_pressure, &name), "Pa");
    shown_in_unit_to(modulus, estar, "Pa");
    shown_in_unit_to(mean, s->contact.mean_pressure, "Pa");
    if (estar < no_modulus)
        course_warn(&run->d.course, "the largest pressure is above E*",
                    "%s: the %s, %s, is above E*, which is %s: was its unit forgotten, as in "
                    "114GPa?",
                    where, name, peak, modulus);
    else if (s->contact.mean_pressure > linear * estar)
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

void
solve_warn_of_theory(struct run *run, const struct rc_grid *g, const char *where,
                     const struct solution *s)
{
    double estar = run->args->physics.surface_estar;
    const char *name;
    double peak = yield_peak(run, s->contact.max_pressure, &name);

    if (peak > estar)
        suspect_unit(run, g, where, s);
    else if (peak > linear * estar && isfinite(run->hardness_max) && run->hardness_max >= peak)
        course_warn(&run->d.course, "a pressure at which a solid is not linear elastic",
                    "%s: the %s, %s, is %.2g of E*: beyond %g a solid is not linear elastic, and "
                    "--hardness, %s, is above that: is its unit right?",
                    where, name, shown_in_unit(peak, "Pa"), peak / estar, linear,
                    shown_in_unit(run->hardness_max, "Pa"));
    else if (peak > linear * estar)
        course_warn(&run->d.course, "a pressure at which a solid is not linear elastic",
                    "%s: the %s, %s, is %.2g of E*: beyond %g a solid is not linear elastic: give "
                    "%sa smaller load",
                    where, name, shown_in_unit(peak, "Pa"), peak / estar, linear,
                    run->yielding.wanted || run->args->physics.relaxes > 0 ? ""
                                                                           : "its --hardness, or ");
    drive_judge_slope(&run->d.course, s->slope, where);
}

/* ---- beyond the grid ---- */

static void
warn_of_grid(struct run *run, const struct rc_grid *g, const char *where, const struct solution *s)
{
    bool map = g->nx > 1 && g->ny > 1;
    size_t nodes = s->contact.contact_nodes;

    if (nodes >= fewest_nodes[map] && (double)nodes >= fewest_each * (double)s->patches.count)
        return;
    course_warn(&run->d.course, "the grid does not resolve the contact",
                "%s: %zu %s in contact, in %zu %s: the grid does not resolve it: area and "
                "largest pressure may be far off: --discretization estimates by how much",
                where, nodes, nodes == 1 ? "node" : "nodes", s->patches.count,
                s->patches.count == 1 ? "patch" : "patches");
}

/* ---- not converged ---- */

void
solve_warn_of_end(struct run *run, const char *where, const struct rc_contact *c)
{
    char error[64] = "its error is unknown";

    if (c->converged)
        return;
    if (!isnan(c->pressure_error))
        snprintf(error, sizeof error, "its estimated error is %.2g", c->pressure_error);
    if (tool_interrupted() != 0)
        tool_warn(&run->d.t,
                  "%s: interrupted after %zu iterations: the frames hold the best state so far, "
                  "not a solution: %s",
                  where, c->iterations, error);
    else if (run->tilt && c->hardness_active)
        course_warn(
            &run->d.course, "stopped short",
            "%s: not converged after %zu iterations: %s: yielding nodes may not be able to balance "
            "the load at this point: move --at nearer to the middle, or raise --hardness",
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
    double mean;

    if (c->yielded_nodes > 0) {
        shown_area_to(area, c->yielded_area);
        snprintf(yielded, sizeof yielded, "%s of it yields, ", area);
    }
    if (!isnan(c->pressure_error))
        snprintf(error, sizeof error, " to %.2g", c->pressure_error);
    mean = yield_peak(run, c->max_pressure, NULL);
    if (mean != c->max_pressure)
        snprintf(over_nodes, sizeof over_nodes, " (%s over 2 x 2 nodes)",
                 shown_in_unit(mean, "Pa"));
    yield_tell(run, c, took, sizeof took);
    tool_note(&run->d.t,
              "%s: force %s, contact area %s (%.3g %% of the map, %zu nodes in %zu %s), %slargest "
              "pressure %s%s, approach %s, mean gap %s; %s%s in %s, "
              "%.2g s",
              where, shown_in_unit(c->load, "N"), shown_area_to(area, c->contact_area),
              100 * c->contact_fraction, c->contact_nodes, s->patches.count,
              s->patches.count == 1 ? "patch" : "patches", yielded,
              shown_in_unit(c->max_pressure, "Pa"), over_nodes,
              isnan(c->approach) ? "unknown" : shown_in_unit(c->approach, "m"),
              shown_in_unit(c->mean_gap, "m"), c->converged ? "converged" : "not converged", error,
              took, tool_now() - run->d.began);
}

void
solve_warn_of_limits(struct run *run, const char *where)
{
    const struct rc_adhesion_state *f = run->adhering.figures;
    const bool holds = f != NULL && f->stable && f->converged && !f->separated;
    const struct drive_advice advice[] = {
        {"edge_load_fraction", NULL}, /* solve_judge has its own warning */
        {"stability", holds ? "a list of approaches passes the jump" : NULL},
        {NULL, NULL}};

    drive_judge(&run->d.course, run->model, advice, where);
}

void
solve_judge(struct run *run, const struct rc_grid *g, const struct solution *s)
{
    char where[512];

    solve_where(run, g, where, sizeof where);
    tell(run, where, s);
    yield_judge(run, where, s);
    solve_warn_of_limits(run, where);
    if (!run->args->physics.periodic &&
        s->contact.edge_load_fraction > rc_figure_find("edge_load_fraction")->limit)
        course_warn(&run->d.course, "the contact reaches the edge of the map",
                    "%s: %.1f %% of the load is on the outer 2 %% of the map: the contact reaches "
                    "its edge, beyond which there is no material: take a larger map, a smaller "
                    "load, or --periodic if the surface repeats",
                    where, 100 * s->contact.edge_load_fraction);
    if (tool_interrupted() == 0 && s->contact.contact_nodes > 0) {
        solve_warn_of_theory(run, g, where, s);
        warn_of_grid(run, g, where, s);
        slide_warn(run, where);
    }
    if (!yield_warn_of_end(run, where, s) && !relax_warn_of_end(run, where, &s->contact))
        solve_warn_of_end(run, where, &s->contact);
}
