/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flow through the gap of a contact, from one edge of the map to the opposite one. */
#include <math.h>
#include <string.h>

#include "tools/frames/frames.h"
#include "tools/leak/leak.h"
#include "tools/model/model.h"

static const struct frame_kind {
    const char *name, *unit, *driven_unit; /* without and with a pressure drop */
    void (*get)(const struct rc_leak *leak, double *v);
} frames[] = {
    {"fluid-pressure", "1", "Pa", rc_leak_pressure},
    {"flux", "m2", "m2/s", rc_leak_flux},
    {"channel", "1", "1", rc_leak_channel},
};

enum {
    PRESSURE,
    FLUX,
    FRAMES = sizeof frames / sizeof *frames
};

static const char *
frame_word(size_t k)
{
    return k < FRAMES ? frames[k].name : NULL;
}

static struct args {
    double viscosity, drop;
    struct numbers sliding;
    const char *direction, *sides, *report;
    size_t output; /* bits of frames */
    bool dry_run;
} args = {.viscosity = NAN, .drop = NAN, .direction = "x", .output = (1u << FRAMES) - 1};

#define AT(field) .at = offsetof(struct args, field)
/* clang-format off */
static const struct opt opts[] = {
    {.name = "direction", .type = OPT_CHOICE, AT(direction), .result = true, .arg = "x|y",
     .help = "flow from the left to the right edge (x) or from top to bottom (y); default x"},
    {.name = "sides", .type = OPT_CHOICE, AT(sides), .result = true, .arg = "periodic|closed",
     .help = "the two edges along the flow join or are walls (default: the stream's boundary)"},
    {.name = "viscosity", .type = OPT_NUMBER, .unit = UNIT_PAS, AT(viscosity), .min = 0,
     .max = INFINITY, .above = true, .result = true, .arg = "ETA",
     .needs = RULES({.with = "pressure-drop", .because = "the flow rate depends on both"}),
     .help = "of the fluid; the report then has a flow rate"},
    {.name = "pressure-drop", .type = OPT_NUMBER, .unit = UNIT_PA, AT(drop), .min = 0,
     .max = INFINITY, .above = true, .result = true, .arg = "DP",
     .needs = RULES({.with = "viscosity", .because = "the flow rate depends on both"}),
     .help = "difference of the fluid pressure between the edges"},
    {.name = "sliding", .type = OPT_NUMBERS, .unit = UNIT_SPEED, AT(sliding), .min = -INFINITY,
     .max = INFINITY, .result = true, .arg = "U[,U1]",
     .help = "speeds along the flow: of the smooth body, and of the rough one (default 0); the report has "
             "a shear flow"},
    {.name = "output", .type = OPT_WORDS, AT(output), .words = frame_word, .arg = "LIST",
     .help = "frames to write, of %s (default: all)"},
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object per case, or a row of FILE.tsv or .csv: flow, bounds, constriction"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run), .text = true,
     .help = "print the expected memory and time, and stop"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-leak",
    .summary = "Flow through the gap between the bodies",
    .operands = "[FILE...]",
    .examples =
        "  rc-solve --periodic --mean-pressure 1MPa:8MPa:8 --estar 1GPa --output pressure,gap "
        "surface.rcg |\n"
        "      rc-leak --viscosity 1mPas --pressure-drop 100kPa --report leak.tsv -o flow.rcg\n",
    .opts = opts,
    .figures = (const char *const[]){"leak", NULL},
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
    .alone = "rc-pick --crop cuts a smaller map out",
};

struct run {
    struct tool t;
    struct report report;
    struct rc_grid *p, *contact; /* pressure of the case; NULL: none */
};

/* ---- a case ---- */

/* True if the edges along the flow join: the map repeats across the flow. */
static bool
sides_meet(struct run *run, const struct rc_grid *g)
{
    const enum rc_map_axis across = args.direction[0] == 'x' ? RC_Y : RC_X;
    const char *boundary = rc_grid_get(g, "boundary");
    const bool meet = rc_wraps(map_boundary(g), across);

    if (args.sides == NULL)
        return meet;
    if (strcmp(args.sides, "closed") == 0)
        return false;
    if (boundary != NULL && !meet)
        tool_refuse(&run->t, g,
                    "boundary=%s contradicts --sides periodic, which needs a map that repeats "
                    "along %c: remove that option",
                    boundary, across == RC_X ? 'x' : 'y');
    return true;
}

/* The frame that defines the contact, and the mean pressure. NULL: the stream does not say. */
static const struct rc_grid *
look_at_contact(struct run *run, struct leak_case *c)
{
    const struct rc_grid *p = run->p, *touch;
    size_t n = rc_grid_nodes(c->gap), touching = 0;

    if (p != NULL) {
        tool_demand_grid_of(&run->t, p, c->gap);
        tool_demand_finite(&run->t, p, "recompute the map");
        c->mean = rc_sum(p->v, n) / (double)n;
    }
    if ((touch = contact_demand(&run->t, p, run->contact)) == NULL)
        return NULL;
    tool_demand_grid_of(&run->t, touch, c->gap);
    for (size_t k = 0; k < n; k++)
        touching += rc_in_contact(touch->v[k]);
    c->pressed = true;
    c->contact = (double)touching / (double)n;
    return touch;
}

static void
set_keys(struct tool *t, const struct leak_case *c, struct rc_grid *g)
{
    const struct rc_leak_figures *f = c->figures;
    const char direction[2] = {c->direction, '\0'};

    tool_set(t, g, "direction", direction);
    tool_set_number(t, g, "flow_conductance", f->conductance);
    if (!isnan(c->drop)) {
        tool_set_number(t, g, "flow_rate", c->rate * f->conductance);
        tool_set_number(t, g, "pressure_drop", c->drop);
        tool_set_number(t, g, "viscosity", c->viscosity);
    }
    if (f->percolates) {
        tool_set_number(t, g, "throat_x", f->critical_x);
        tool_set_number(t, g, "throat_y", f->critical_y);
    }
    tool_sign(t, g);
}

static void
write_frame(struct run *run, const struct leak_case *c, const struct rc_leak *leak, size_t kind)
{
    double scale = isnan(c->drop) ? 1 : kind == PRESSURE ? c->drop : kind == FLUX ? c->rate : 1;
    const char *unit = isnan(c->drop) ? frames[kind].unit : frames[kind].driven_unit;
    RC_OWN(rc_grid, g) = tool_frame_like(&run->t, c->gap, NULL, frames[kind].name, unit);

    set_keys(&run->t, c, g);
    frames[kind].get(leak, g->v);
    for (size_t k = 0; k < rc_grid_nodes(g) && scale != 1; k++)
        g->v[k] *= scale;
    run->t.input.missing = kind == PRESSURE || kind == FLUX; /* contact has none */
    tool_write(&run->t, g);
}

static void
solve(struct run *run, const struct leak_case *c, struct rc_leak *leak)
{
    enum rc_status status;

    tool_demand_memory(&run->t, c->gap,
                       rc_grid_nodes(c->gap) * sizeof(double)); /* another frame follows */
    tool_progress(&run->t, NAN, "flow through %zu nodes", c->figures->unknowns);
    while ((status = rc_leak_step(leak, &run->t.err)) == RC_MORE)
        continue;
    tool_progress_end(&run->t);
    tool_must(&run->t, c->gap, status);
}

static void
show_plan(struct run *run, const struct leak_case *c)
{
    const double fluid = (isnan(c->contact) ? 1 : 1 - c->contact) * (double)rc_grid_nodes(c->gap);

    const struct plan plan = plan_begin(&run->t, &run->report, c->gap, rc_grid_case(c->gap),
                                        rc_grid_get(c->gap, "boundary"), "");

    plan_effects(&plan, leak_effects(c));
    course_plan(&plan, c->gap, rc_leak_expect((size_t)fluid, run->t.threads), 1);
}

static void
do_case(struct run *run, const struct rc_grid *gap)
{
    struct leak_case c = {.gap = gap,
                          .direction = args.direction[0],
                          .around = sides_meet(run, gap),
                          .contact = NAN,
                          .mean = NAN,
                          .drop = args.drop,
                          .viscosity = args.viscosity,
                          .rate = args.drop / (12 * args.viscosity),
                          .smooth = args.sliding.n > 0 ? args.sliding.v[0] : NAN,
                          .rough = args.sliding.n > 1 ? args.sliding.v[1] : 0};
    const struct rc_leak_options options = {
        .direction = c.direction, .around = c.around, .threads = run->t.threads};
    const struct rc_grid *touch;
    double began = tool_now();
    struct rc_leak *leak;

    tool_demand_finite(&run->t, gap, "recompute the map");
    touch = look_at_contact(run, &c);
    if (args.dry_run) {
        show_plan(run, &c);
        return;
    }
    leak = tool_made(&run->t, gap,
                     rc_leak_new(rc_shape_of(gap), touch == NULL ? NULL : touch->v, gap->v,
                                 &options, &run->t.err));
    c.figures = rc_leak_result(leak);
    c.setup = tool_now() - began;
    solve(run, &c, leak);
    c.solve = tool_now() - began - c.setup;
    leak_tell(&run->t, &c);
    leak_judge(&run->t, &c);
    for (size_t kind = 0; kind < FRAMES; kind++)
        if (args.output >> kind & 1)
            write_frame(run, &c, leak, kind);
    leak_report(&run->report, &c);
    rc_leak_free(leak);
}

/* ---- start ---- */

int
main(int argc, char **argv)
{
    static struct run run;
    struct tool_frame beside[] = {
        {"pressure", &run.p}, {CONTACT_CHANNEL, &run.contact}, {NULL, NULL}};
    struct rc_grid *gap;

    tool_start(&run.t, &info, argc, argv, &args);
    if (args.sliding.n > 2)
        tool_usage(&run.t, "--sliding: it must be one speed (the rough body at rest) or two");
    report_open(&run.report, &run.t, args.report);
    while ((gap = tool_channel_with(&run.t, "gap", tool_take_frames, beside)) != NULL) {
        do_case(&run, gap);
        rc_grid_free(gap);
        tool_free_frames(beside);
    }
    report_close(&run.report);
    return tool_finish(&run.t);
}
