/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stresses in the half-space under a pressure map: slice by slice, or in a vertical plane. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tools/materials/materials.h"
#include "tools/stress/stress.h"

static struct args {
    struct numbers depths; /* none: auto */
    size_t components;     /* bits of enum rc_component */
    const char *section, *report;
    bool dry_run;
    struct stress_asked asked;
} args = {.asked = STRESS_ASKED, .components = (2u << RC_MISES) - 1};

#define AT(field) .at = offsetof(struct args, field)
/* clang-format off */
static const struct opt opts[] = {
    {.name = "depths", .type = OPT_NUMBERS, .unit = UNIT_M, AT(depths), .min = 0,
     .max = INFINITY, .result = true, .word = "auto", .arg = "LIST",
     .one_of = RULES({.with = "depths",
                      .remedy = "as in --depths 0,1um,5um or --depths 0:50um:26, or leave their "
                                                "choice to --depths auto"}),
     .help = "depths: a,b,c, a:b:n or a:b:log:n, or auto: dense near the surface"},
    {.name = "components", .type = OPT_WORDS, AT(components), .result = true,
     .words = words_component, .arg = "LIST", .help = "of %s (default: the six and mises)"},
    {.group = stress_body_options, AT(asked)},
    {.group = material_options_of_one},
    {.name = "section", .type = OPT_TEXT, AT(section), .result = true, .arg = "AXIS=PLACE",
     .help = "only the vertical plane y=PLACE or x=PLACE: one frame whose rows are depths"},
    {.name = "residual", .type = OPT_FLAG, AT(asked.residual), .result = true,
     .help = "without the pressure: only the stresses of plastic strain and of layers (rc-solve)"},
    {.group = stress_sum_options, AT(asked)},
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object per case, or a row of FILE.tsv or .csv: extreme values, counts, cost"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run), .text = true,
     .help = "print what would be computed, with memory and time, and stop"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-stress",
    .summary = "Stresses in an elastic half-space, coated or not, under a pressure map",
    .operands = "[FILE...]",
    .examples = "  rc-solve --load 240N --estar 114GPa surface.rcg |\n"
                "      rc-stress --nu 0.3 --depths 0:50um:26 --components mises -o mises.rcg\n"
                "  rc-solve --load 240N --estar 114GPa surface.rcg |\n"
                "      rc-stress --nu 0.3 --section y=0 --depths auto --components mises |\n"
                "      rc-render -o section.png\n",
    .opts = opts,
    .figures = (const char *const[]){"stress", NULL},
    .fill = materials_fill,
    .of_materials = (const char *const[]){"nu", NULL},
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
    .shares = true,
};

struct run {
    struct tool t;
    struct rc_stress_options options; /* options of the case */
    struct stress_input input;        /* input of the case */
    struct stress_strain strain;      /* strain of the case */
    struct numbers depths;            /* depths of the case */
    struct rc_grid *frame[RC_STRESSES];
    struct stress_report report;
    struct report out;
};

static bool
wanted(int channel)
{
    return args.components >> channel & 1;
}

static size_t
channels(void)
{
    size_t n = 0;

    for (int c = 0; c < RC_STRESSES; c++)
        n += wanted(c);
    return n;
}

/* ---- the command line ---- */

/* Reads the axis and the position from "y=12um"; the history has the position in SI. */
static void
read_section(struct run *run)
{
    static char si[RC_NUMBER_SIZE + 3];
    const char *s = args.section;

    if (s == NULL)
        return;
    if ((s[0] != 'x' && s[0] != 'y') || s[1] != '=')
        tool_usage(&run->t, "--section %s: it must be x=PLACE or y=PLACE, as in y=0", s);
    if (unit_number(s + 2, UNIT_M, &run->options.at, &run->t.err) != RC_OK)
        tool_usage(&run->t, "--section %s: %s", s, run->t.err.text);
    run->options.section = s[0];
    snprintf(si, sizeof si, "%c=%s", s[0], rc_number(run->options.at));
    args.section = si;
}

static void
check_arguments(struct run *run)
{
    struct tool *t = &run->t;
    char list[128];

    read_section(run);
    for (size_t k = 1; args.section != NULL && k < args.depths.n; k++)
        if (!(args.depths.v[k] > args.depths.v[k - 1]))
            tool_usage(t, "--depths: the depths of a section must increase");
    if (args.section != NULL && stress_on_free_maps_only(args.asked.kernel))
        tool_usage(t, "--section is summed by %s: leave out --kernel %s",
                   words_periodic_engines(list, sizeof list), args.asked.kernel);
    report_open(&run->out, t, args.report);
}

/* ---- a case ---- */

static void
set_options(struct run *run, const struct rc_grid *p)
{
    stress_input_read(&run->t, p, &args.asked, &run->input, &run->options);
    run->options.wanted = (unsigned)args.components;
    run->options.estimate = report_wanted(&run->out);
    if (stress_strain_whole(&run->t, p, &run->strain)) {
        run->options.strain = &run->strain.strain;
        if (!rc_grid_number(p, "e1", &run->options.body.e))
            tool_refuse(&run->t, p,
                        "its key e1, the modulus of the body that has yielded, is not there");
    }
    if (args.asked.residual && run->options.strain == NULL && run->options.residual == NULL)
        tool_refuse(&run->t, p,
                    "--residual: the case has no plastic strain: see rc-solve --yield and --output "
                    "strain, or --layer for a residual stress of layers");
    tool_must(&run->t, p, rc_stress_check(rc_shape_of(p), &run->options, &run->t.err));
}

static void
set_depths(struct run *run, const struct rc_grid *p)
{
    run->depths = args.depths;
    if (args.depths.n == 0 && run->options.strain != NULL) {
        run->depths.v = stress_strain_depths(&run->strain, &run->depths.n);
        if (run->depths.v == NULL)
            tool_refuse(&run->t, p, "out of memory for the depths");
        tool_note(&run->t, "%zu depths, down to %g m", run->depths.n,
                  run->depths.v[run->depths.n - 1]);
    }
    stress_depths_read(&run->t, p, &run->options, &run->depths);
}

/* ---- frames ---- */

static struct rc_shape
frame_shape(const struct run *run, const struct rc_grid *p)
{
    struct rc_shape s = rc_grid_shape(p);
    const struct numbers *d = &run->depths;

    if (run->options.section == 0)
        return s;
    if (run->options.section == 'x')
        s = (struct rc_shape){.nx = s.ny, .dx = s.dy};
    s.ny = d->n;
    s.dy = d->n > 1 ? (d->v[d->n - 1] - d->v[0]) / (double)(d->n - 1) : s.dx;
    return s;
}

static void
set_keys(struct run *run, const struct rc_grid *p, struct rc_grid *g)
{
    const struct rc_stress_options *o = &run->options;
    const char section[2] = {o->section, '\0'};
    const size_t longest = 60000; /* of the key */
    const bool plane = o->section != 0;
    struct tool *t = &run->t;

    tool_set(t, g, "nu", NULL);
    tool_set_number(t, g, "nu", run->input.layers.text == NULL ? o->body.nu : NAN);
    map_set_boundary(t, g, o->boundary);
    tool_set(t, g, "mu", NULL);
    tool_set_number(t, g, "mu", args.asked.mu != 0 ? args.asked.mu : NAN);
    tool_set_number(t, g, "frames", (double)(channels() * (plane ? 1 : run->depths.n)));
    if (plane) {
        tool_set(t, g, "section", section);
        tool_set_number(t, g, "at", o->at);
        tool_set_numbers(t, g, "depths", run->depths.v, run->depths.n);
        if (strlen(rc_grid_get(g, "depths")) >= longest)
            tool_refuse(t, p, "%zu depths are too many for the header of a section: ask for fewer",
                        run->depths.n);
    }
    tool_sign(t, g);
}

/* Makes a grid with the keys of p and another shape. */
static struct rc_grid *
new_frame(struct run *run, const struct rc_grid *p, int channel)
{
    const struct rc_shape shape = frame_shape(run, p);
    struct rc_grid *g = tool_frame_like(&run->t, p, run->options.section != 0 ? &shape : NULL,
                                        rc_component_names[channel], "Pa");

    set_keys(run, p, g);
    return g;
}

/* ---- the work ---- */

/* The components that are summed: mises, tresca and the principal stresses need all six. */
static size_t
summed(void)
{
    const bool all = args.components >> RC_COMPONENTS != 0;
    size_t n = 0;

    for (int c = 0; c < RC_COMPONENTS; c++)
        n += all || wanted(c);
    return n;
}

/* Bytes of the slices, of the components that no frame holds, and of the plan. */
static size_t
memory_for(const struct run *run, const struct rc_grid *p)
{
    const struct rc_shape frame = frame_shape(run, p);
    const bool plane = run->options.section != 0;
    size_t maps = channels() + (plane ? 0 : summed());

    for (int c = 0; c < RC_COMPONENTS && !plane; c++)
        maps -= wanted(c);
    return maps * frame.nx * (plane ? frame.ny : p->ny - p->elsewhere) * sizeof(double) +
           stress_plan_bytes(p, &run->options, summed());
}

/* Sets the keys of a slice: its depth and, for a coated body, its material. */
static void
set_place(struct run *run, struct rc_grid *g, double depth)
{
    const struct rc_body *body = &run->options.body;

    tool_set_number(&run->t, g, "depth", depth);
    if (body->layers > 0)
        tool_set_number(&run->t, g, "material", (double)rc_body_material(body, depth) + 1);
}

static void
do_depth(struct run *run, struct rc_stress *stress, size_t k)
{
    double *s[RC_STRESSES] = {NULL};
    bool plane = run->options.section != 0;

    tool_progress(&run->t, (double)k / (double)run->depths.n, "depth %zu of %zu", k + 1,
                  run->depths.n);
    for (int c = 0; c < RC_STRESSES; c++)
        if (wanted(c))
            s[c] = run->frame[c]->v + (plane ? k * run->frame[c]->nx : 0);
    run->report.depth_began = tool_now();
    tool_must(&run->t, NULL, rc_stress_slice(stress, run->depths.v[k], s, &run->t.err));
    stress_report_depth(&run->report, &run->t, k, rc_stress_values(stress), s);
    for (int c = 0; c < RC_STRESSES && !plane; c++) {
        if (!wanted(c))
            continue;
        set_place(run, run->frame[c], run->depths.v[k]);
        tool_write(&run->t, run->frame[c]);
    }
}

static void
plan_case(struct run *run, const struct rc_grid *p)
{
    double memory = ranks_most(&run->t, (double)tool_memory_with(memory_for(run, p)));

    tool_must(&run->t, p,
              stress_report_plan(&run->t, &run->out, p, &run->options, &run->depths, (size_t)memory,
                                 &run->t.err));
}

static void
do_case(struct run *run, const struct rc_grid *p)
{
    struct rc_stress *stress;

    tool_must(&run->t, p,
              stress_report_begin(&run->report, p, &run->options, &run->depths,
                                  report_wanted(&run->out), &run->t.err));
    tool_demand_memory(&run->t, p, memory_for(run, p));
    stress = tool_made(&run->t, p, rc_stress_new(rc_shape_of(p), p->v, &run->options, &run->t.err));
    run->report.setup = tool_now() - run->report.began;
    for (int c = 0; c < RC_STRESSES; c++)
        if (wanted(c))
            run->frame[c] = new_frame(run, p, c);
    for (size_t k = 0; k < run->depths.n; k++)
        do_depth(run, stress, k);
    tool_progress_end(&run->t);
    for (int c = 0; c < RC_STRESSES; c++) {
        if (wanted(c) && run->options.section != 0)
            tool_write(&run->t, run->frame[c]);
        rc_grid_free(run->frame[c]);
        run->frame[c] = NULL;
    }
    stress_report_write(&run->report, &run->out, stress);
    stress_report_free(&run->report);
    rc_stress_free(stress);
}

/* ---- start ---- */

/* Keeps the frames that may accompany the pressure. */
static bool
take(void *ctx, struct tool *t, const struct rc_grid *p, struct rc_grid *g)
{
    struct run *run = ctx;
    return stress_input_take(t, p, g, &run->input) ||
           (p != NULL && stress_strain_take(t, p, g, &run->strain));
}

static void
forget_case(struct run *run)
{
    if (run->depths.v != args.depths.v)
        free(run->depths.v);
    stress_input_free(&run->input);
    stress_strain_free(&run->strain);
}

int
main(int argc, char **argv)
{
    static struct run run;
    struct rc_grid *p;

    tool_start(&run.t, &info, argc, argv, &args);
    check_arguments(&run);
    while ((p = tool_channel_with(&run.t, "pressure", take, &run)) != NULL) {
        tool_demand_finite(&run.t, p, "recompute the map");
        set_options(&run, p);
        set_depths(&run, p);
        if (args.asked.residual)
            memset(p->v, 0, rc_grid_nodes(p) * sizeof *p->v);
        if (args.dry_run)
            plan_case(&run, p);
        else
            do_case(&run, p);
        forget_case(&run);
        rc_grid_free(p);
    }
    report_close(&run.out);
    free(args.depths.v);
    return tool_finish(&run.t);
}
