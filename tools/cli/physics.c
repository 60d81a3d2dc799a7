#include "physics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the command line ---- */

#define AT(field) .at = offsetof(struct physics, field)
#define ABOVE_0 .min = 0, .max = INFINITY, .above = true
/* clang-format off */
const struct opt physics_options[] = {
    {.name = "load", .type = OPT_NUMBERS, .unit = UNIT_N, AT(load), ABOVE_0, .result = true,
     .per_metre = true, .arg = "LIST",
     .help = "total normal force: one, or a,b,c, a:b:n or a:b:log:n, each a case"},
    {.name = "mean-pressure", .type = OPT_NUMBERS, .unit = UNIT_PA, AT(mean_pressure), ABOVE_0,
     .result = true, .arg = "LIST", .help = "the load as a mean over the whole map, also a list"},
    {.name = "approach", .type = OPT_NUMBERS, .unit = UNIT_M, AT(approach), ABOVE_0,
     .result = true, .arg = "LIST",
     .help = "instead of the load: how far to come together after first touch"},
    {.name = "estar", .type = OPT_NUMBER, .unit = UNIT_PA, AT(estar), ABOVE_0, .result = true,
     .arg = "MODULUS", .help = "composite modulus E*, 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2"},
    {.name = "E1", .type = OPT_NUMBER, .unit = UNIT_PA, AT(e1), ABOVE_0, .result = true,
     .arg = "MODULUS", .help = "Young's modulus of body 1, the one that is analysed"},
    {.name = "nu1", .type = OPT_NUMBER, AT(nu1), .min = -1, .max = 0.5, .above = true,
     .result = true, .arg = "RATIO", .help = "Poisson's ratio of body 1"},
    {.name = "E2", .type = OPT_NUMBER, .unit = UNIT_PA, AT(e2), ABOVE_0, .result = true,
     .word = "rigid", .arg = "MODULUS", .help = "Young's modulus of body 2, or rigid"},
    {.name = "nu2", .type = OPT_NUMBER, AT(nu2), .min = -1, .max = 0.5, .above = true,
     .result = true, .arg = "RATIO", .help = "Poisson's ratio of body 2"},
    {.name = "hardness", .type = OPT_NUMBER, .unit = UNIT_PA, AT(hardness), ABOVE_0,
     .result = true, .arg = "PRESSURE", .help = "upper bound of the pressure: above it, yield"},
    {.name = "radius", .type = OPT_NUMBER, .unit = UNIT_M, AT(radius), ABOVE_0, .result = true,
     .arg = "LENGTH", .help = "add a sphere of this composite radius about the origin"},
    {.name = "periodic", .type = OPT_FLAG, AT(periodic), .result = true,
     .help = "the map repeats for ever (default: a free half-space, loaded on the map only)"},
    {.name = NULL},
};
/* clang-format on */

void
physics_check(struct tool *t, struct physics *a)
{
    int bodies =
        tool_given(t, "E1") + tool_given(t, "nu1") + tool_given(t, "E2") + tool_given(t, "nu2");

    if (tool_given(t, "load") + tool_given(t, "mean-pressure") + tool_given(t, "approach") != 1)
        tool_die(t, EXIT_USAGE, "give one of --load, --mean-pressure and --approach");
    if (a->load.per_metre)
        tool_die(t, EXIT_USAGE, "--load in N/m: give the whole force, in N");
    if (tool_given(t, "estar") ? bodies > 0 : bodies != 4)
        tool_die(t, EXIT_USAGE,
                 "give the elasticity, either as --estar or as --E1 --nu1 --E2 "
                 "--nu2, all four");
    if (bodies > 0)
        a->estar = 1 / ((1 - a->nu1 * a->nu1) / a->e1 + (1 - a->nu2 * a->nu2) / a->e2);
}

const struct numbers *
physics_steps(const struct physics *a)
{
    return a->load.n > 0 ? &a->load : a->mean_pressure.n > 0 ? &a->mean_pressure : &a->approach;
}

/* ---- a height map ---- */

static void
add_sphere(struct tool *t, const struct physics *a, struct rc_grid *g)
{
    struct rc_shape along = {g->nx, 1, g->dx, g->dy}, across = {1, g->ny, g->dx, g->dy};
    double *row = malloc((g->nx + g->ny) * sizeof *row), *column = row + g->nx;

    if (row == NULL)
        tool_die_at(t, g, EXIT_IMPOSSIBLE, "out of memory");
    rc_synth_sphere(&along, a->radius, row); /* a parabola is the sum of two */
    rc_synth_sphere(&across, a->radius, column);
    for (size_t j = 0; j < g->ny; j++)
        for (size_t i = 0; i < g->nx; i++)
            g->v[j * g->nx + i] += row[i] + column[j];
    free(row);
}

static void
warn(struct tool *t, const struct physics *a, const struct rc_grid *g, double rms_slope)
{
    const char *periodic = rc_grid_get(g, "periodic");
    char where[256];

    tool_where(t, g, where, sizeof where);
    if (!a->periodic && periodic != NULL && strcmp(periodic, "yes") == 0 && isnan(a->radius))
        tool_warn(t,
                  "%s: the surface is periodic, the solution is not: beyond the map there "
                  "is no material",
                  where);
    if (!a->periodic && g->ny == 1 && g->nx > 1)
        tool_warn(t,
                  "%s: a profile is solved as a strip %g m wide, not as a ridge without "
                  "end",
                  where, g->dy);
    if (rms_slope > 0.3)
        tool_warn(t,
                  "%s: RMS slope %.2f is beyond the theory of small slopes (0.3): expect "
                  "pressures that are too high",
                  where, rms_slope);
}

void
physics_heights(struct tool *t, const struct physics *a, struct rc_grid *g)
{
    struct rc_shape shape = rc_grid_shape(g);
    struct rc_statistics st;

    if (strcmp(g->unit, "m") != 0)
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "its unit is '%s': heights are in metres; import the file again with --z-unit",
                    g->unit);
    if (!isnan(a->radius))
        add_sphere(t, a, g);
    rc_measure(&shape, g->v, &st);
    if (st.missing + st.infinite > 0) /* the slow way, which finds the first */
        tool_demand_finite(t, g, "fill them with rc-detrend --fill");
    warn(t, a, g, st.rms_slope);
}

struct rc_problem
physics_problem(const struct physics *a, const struct rc_grid *g, size_t step)
{
    double number = physics_steps(a)->v[step];
    double area = g->dx * g->dy * (double)(g->nx * g->ny);

    return (struct rc_problem){
        .boundary = a->periodic ? RC_PERIODIC : RC_FREE,
        .estar = a->estar,
        .load = a->load.n > 0            ? number
                : a->mean_pressure.n > 0 ? number * area
                                         : 0,
        .approach = a->approach.n > 0 ? number : 0,
        .hardness = a->hardness,
    };
}
