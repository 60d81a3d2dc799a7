/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "leak.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The flow if each square of the map had one such critical constriction (Persson and Yang, J. Phys.: Condens.
 * Matter 20, 2008, 315011). */
static double
critical_conductance(const struct leak_case *c)
{
    const struct rc_grid *g = c->gap;
    double x = (double)g->nx * g->dx, y = (double)g->ny * g->dy, gap = c->figures->critical_gap;

    return gap * gap * gap * (c->direction == 'y' ? x / y : y / x);
}

/* The flow that the sliding faces drag along, m^3/s. In the frame of the rough body the smooth one slides
 * over it; the fluid moves with the frame. */
static double
shear_flow(const struct leak_case *c)
{
    const struct rc_grid *g = c->gap;
    double wide = c->direction == 'y' ? (double)g->nx * g->dx : (double)g->ny * g->dy;

    return wide * c->figures->mean_gap *
           (c->rough + (c->smooth - c->rough) / 2 * c->figures->shear_stress_factor);
}

const struct effect_state *
leak_effects(const struct leak_case *c)
{
    static struct effect_state list[6];

    list[0] = (struct effect_state){
        "contact", c->pressed ? "on: no fluid where the bodies touch"
                              : "left out: no frame contact or pressure, fluid flows in every gap"};
    list[1] = (struct effect_state){
        "sliding", isnan(c->smooth) ? "left out: no --sliding, the bodies are at rest" : "on"};
    list[2] = (struct effect_state){
        "flow_rate", isnan(c->rate) ? "left out: no --viscosity and --pressure-drop" : "on"};
    list[3] = (struct effect_state){"sides", c->around ? "on: the edges along the flow join"
                                                       : "left out: they are walls"};
    list[4] = (struct effect_state){"fluid_load",
                                    "left out: the pressure of the fluid does not lift the bodies"};
    return list;
}

/* A number of the stream, which distinguishes its cases; NAN: it has none. */
static double
key_of(const struct rc_grid *g, const char *key)
{
    double value;

    return rc_grid_number(g, key, &value) ? value : NAN;
}

void
leak_report(struct report *r, const struct leak_case *c)
{
    const struct rc_leak_figures *f = c->figures;
    const struct figures from[] = {{rc_figures("leak"), f}, {NULL, NULL}};
    const struct rc_grid *g = c->gap;
    const char direction[2] = {c->direction, '\0'};

    report_begin(r);
    report_map(r, g, rc_grid_case(g));
    report_text(r, "boundary", rc_grid_get(g, "boundary"));
    report_text(r, "direction", direction);
    report_text(r, "sides", c->around ? "periodic" : "closed");
    report_count(r, "threads", r->tool->threads, NULL);
    report_value(r, "time", key_of(g, "time"));
    report_value(r, "load", key_of(g, "load"));
    report_value(r, "mean_pressure", c->mean);
    report_value(r, "contact_fraction", c->contact);
    report_number(r, "viscosity", c->viscosity, "Pas");
    report_number(r, "pressure_drop", c->drop, "Pa");
    report_number(r, "sliding", c->smooth, "m/s");
    report_number(r, "sliding_rough", isnan(c->smooth) ? NAN : c->rough, "m/s");
    report_value(r, "flow_rate", c->rate * f->conductance);
    report_value(r, "shear_flow", shear_flow(c));
    report_named(r, from,
                 "flow_conductance flow_conductance_linear conductance_lower conductance_upper "
                 "discretization_error_estimate flow_factor shear_flow_factor shear_stress_factor "
                 "mean_gap gap_rms gap_slope percolates "
                 "percolates_diagonal critical_gap critical_x critical_y");
    report_value(r, "critical_flow", c->rate * critical_conductance(c));
    report_named(r, from, "throat_nodes fluid_nodes dead_nodes unknowns");
    report_text(r, "tol", NULL); /* of an elimination, which has none */
    report_carried(r, rc_grid_get(g, "converged"));
    report_effects(r, leak_effects(c));
    report_seconds(
        r, (const struct report_phase[]){{"setup", c->setup}, {"solve", c->solve}, {NULL, 0}},
        c->setup + c->solve);
    report_memory(r);
    report_value(r, "speed", key_of(g, "speed"));
    report_value(r, "position", key_of(g, "position"));
    report_finish_row(r);
}

void
leak_tell(struct tool *t, const struct leak_case *c)
{
    const struct rc_leak_figures *f = c->figures;
    char text[512] = "no path from edge to edge: sealed";
    size_t n = strlen(text);

    if (f->percolates && !isnan(c->rate))
        n = (size_t)snprintf(text, sizeof text, "flow %.3g m3/s", c->rate * f->conductance);
    else if (f->percolates)
        n = (size_t)snprintf(text, sizeof text, "flow conductance %.3g m3", f->conductance);
    if (!isnan(c->smooth))
        n += (size_t)snprintf(text + n, sizeof text - n, ", dragged along by sliding %.3g m3/s",
                              shear_flow(c));
    if (!isnan(c->contact))
        n += (size_t)snprintf(text + n, sizeof text - n, ", contact %s",
                              shown_percent(c->contact, 3));
    if (f->percolates)
        snprintf(text + n, sizeof text - n, ", narrowest gap %s",
                 shown_in_unit(f->critical_gap, "m"));
    tool_note(t, "%s: %s; %zu unknowns, %.2g s", tool_where(t, c->gap), text, f->unknowns,
              c->setup + c->solve);
}

/* ---- what is wrong with it ---- */

static const double steep = 0.3;  /* slope beyond which a film is not thin               */
static const double rough = 0.05; /* error of the grid that causes a warning */
static const double lifts = 0.1;  /* part of the mean contact pressure */

enum {
    THROAT = 3 /* nodes across the constriction; with fewer the error may be a third */
};

void
leak_judge(struct tool *t, const struct leak_case *c)
{
    const struct rc_leak_figures *f = c->figures;
    const char *where = tool_where(t, c->gap);

    if (!c->pressed)
        tool_warn_first(
            t, "no pressure frame",
            "%s: without a pressure frame fluid flows wherever the gap is above 0, also in the "
            "contact, where gaps are only rounding: write both with rc-solve --output "
            "pressure,gap",
            where);
    if (f->percolates != f->percolates_diagonal)
        tool_warn_first(
            t, "a path through corners of cells",
            "%s: the only remaining path runs through cell corners; this grid cannot decide "
            "whether it leaks: take a finer one",
            where);
    if (!f->percolates)
        return;
    if (f->throat_nodes < THROAT)
        tool_warn_first(
            t, "a narrow critical constriction",
            "%s: the critical constriction, at x = %g m, y = %g m, is %zu node%s wide, and "
            "with fewer than %d the error of the flow may be a third: take a finer grid",
            where, f->critical_x, f->critical_y, f->throat_nodes, f->throat_nodes == 1 ? "" : "s",
            THROAT);
    if (f->error > rough)
        tool_warn_first(
            t, "the error of the grid",
            "%s: the estimated error of the grid is %.0f %% of the flow: take a finer one", where,
            100 * f->error);
    if (f->slope > steep)
        tool_warn_first(
            t, "the slope of the gap",
            "%s: the RMS slope of the gap is %.2g where fluid flows, but the theory of thin "
            "films needs a slope below %g",
            where, f->slope, steep);
    if (c->drop > lifts * c->mean)
        tool_warn_first(t, "a large pressure drop",
                        "%s: the pressure drop, %g Pa, is more than a tenth of the mean contact "
                        "pressure, %g Pa: "
                        "fluid would lift the bodies, which is not computed",
                        where, c->drop, c->mean);
}
