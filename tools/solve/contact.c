/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of every contact: layers, the form, the boundary, the approach. */
#include "solve.h"

#include <math.h>
#include <string.h>

static const char *
layers_state(const struct run *run)
{
    static char text[64];
    size_t n = run->physics->pair.one.layers;

    if (n == 0)
        return "left out: one material";
    snprintf(text, sizeof text, "on: %zu on a substrate", n);
    return text;
}

static const char *
sphere_state(const struct run *run)
{
    return isnan(run->physics->radius) ? "left out: no --radius" : "on";
}

static const char *
cylinder_state(const struct run *run)
{
    return isnan(run->physics->cylinder)                         ? "left out: no --cylinder"
           : physics_cylinder_axis(run->physics, run->g) == RC_X ? "on: along x"
                                                                 : "on: along y";
}

static const char *
padding_state(const struct run *run)
{
    return boundary_padding(run->physics->boundary);
}

static const char *
approach_state(const struct run *run)
{
    return run->physics->approach.n > 0 ? "on" : "left out: the load is given";
}

static void
approach_keys(struct run *run, struct rc_grid *g)
{
    tool_set_number(&run->d.t, g, "approach", run->solution.contact.approach);
}

const struct effect solve_effect_layers = {.name = "layers", .state = layers_state};
const struct effect solve_effect_sphere = {.name = "sphere", .state = sphere_state};
const struct effect solve_effect_cylinder = {.name = "cylinder", .state = cylinder_state};
const struct effect solve_effect_padding = {.name = "padding", .state = padding_state};
const struct effect solve_effect_approach = {
    .name = "approach", .state = approach_state, .keys = approach_keys};
