/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Displacement of the surface under a given pressure map. */
#include <math.h>
#include <string.h>

#include "tools/cli/cli.h"
#include "tools/frames/frames.h"

static struct args {
    double estar, tol;
    size_t order, correction;
    const char *kernel;
    struct boundary_args repeats;
    bool dry_run;
    const char *report;
} args = {.repeats = BOUNDARY_NONE, .estar = NAN, .tol = NAN, .kernel = "auto"};

#define AT(field) .at = offsetof(struct args, field)
/* clang-format off */
static const struct opt opts[] = {
    {.name = "estar", .type = OPT_NUMBER, .unit = UNIT_PA, AT(estar), .min = 0, .max = INFINITY,
     .above = true, .result = true, .arg = "MODULUS",
     .help = "composite modulus E* (default: the stream's own)"},
    OPT_PERIODIC(offsetof(struct args, repeats),
                 "the map repeats without end, along both axes or the given one; where both "
                 "repeat, the mean displacement is undetermined"),
    OPT_DATUM(offsetof(struct args, repeats)),
    {.name = "kernel", .alias = "engine", .type = OPT_CHOICE, AT(kernel),
     .words = words_engine_or_auto, .help = "engine that sums displacements (default auto)"},
    {.name = "tol", .type = OPT_NUMBER, AT(tol), .min = 0, .max = 1, .above = true,
     .result = true, .arg = "ERROR",
     .help = "permitted error, relative to the sum of |K| |p| (default: rounding)"},
    {.name = "order", .type = OPT_COUNT, AT(order), .min = 1, .max = 50, .result = true,
     .arg = "T",
     .needs = RULES({.with = "correction"}),
     .help = "multi-level sums: transfers of order 2T"},
    {.name = "correction", .type = OPT_COUNT, AT(correction), .min = 1, .max = 1000,
     .result = true, .arg = "M",
     .needs = RULES({.with = "order"}),
     .help = "multi-level sums: corrections over 2M+1 by 2M+1 nodes"},
    {.name = "report", .type = OPT_REPORT, AT(report), .arg = "FILE",
     .help = "write one JSON object per case, or a row of FILE.tsv or .csv"},
    {.name = "dry-run", .type = OPT_FLAG, AT(dry_run), .text = true,
     .help = "print what would be computed, its memory and time, and exit"},
    {.name = NULL},
};
/* clang-format on */

static const struct rc_figure figures[] = {
    {.name = "min_displacement", .unit = "m", .title = "Least displacement"},
    {.name = "max_displacement", .unit = "m", .title = "Largest displacement"},
    {.name = "mean_displacement", .unit = "m", .title = "Mean displacement"},
    {.name = "displacement_error_estimate",
     .title = "Error of the displacement",
     .role = RC_FIGURE_ERROR,
     .by = "tol",
     .of = "displacement"},
    {0},
};

static const struct tool_info info = {
    .name = "rc-deflect",
    .summary = "Displacement of an elastic half-space under a pressure map",
    .operands = "[FILE...]",
    .examples = "  rc-solve --load 240N --estar 114GPa surface.rcg |\n"
                "      rc-deflect --kernel mlms --tol 1e-6 -o displacement.rcg\n",
    .opts = opts,
    .own = figures,
    .reads = READS_STREAM,
    .writes = WRITES_STREAM,
    .shares = true,
};

/* The bodies that the pressure was solved for; for uniform ones --estar overrides them. */
static struct rc_pair
pair_of(struct tool *t, const struct rc_grid *p, struct layers *layers)
{
    struct rc_pair pair = {.estar = args.estar};

    if (isnan(args.estar))
        bodies_demand_elastic(t, p, "take the displacement that rc-solve writes, or give --estar");
    tool_must(t, p, layers_read(p, layers, &t->err));
    if (layers->text != NULL && !isnan(args.estar))
        tool_refuse(t, p, "the stream already defines the layers; remove --estar");
    if (isnan(args.estar) && bodies_read(p, layers, &pair, &t->err) != RC_OK)
        tool_die_at(t, p, layers->text == NULL ? EXIT_USAGE : EXIT_IMPOSSIBLE, "%s", t->err.text);
    return pair;
}

static double
loaded_fraction(const struct tool *t, const struct rc_grid *p)
{
    size_t count = 0;

    for (size_t k = 0; k < rc_grid_nodes(p); k++)
        count += p->v[k] != 0;
    return ranks_sum(t, (double)count) / (double)(p->nx * p->ny);
}

struct demand {
    const struct rc_grid *p;
    const struct rc_conv_options *options;
};

static size_t
memory_by(const void *ctx, const char *engine)
{
    const struct demand *d = ctx;
    struct rc_conv_options options = *d->options;
    const struct rc_engine_info *e;
    const char *reason, *name;
    double bytes = sizeof *d->p->v;

    options.engine = engine;
    name = rc_conv_choice(rc_shape_of(d->p), &options, &reason);
    for (size_t k = 0; (e = rc_engine_info(k)) != NULL; k++)
        if (strcmp(e->name, name) == 0) {
            if (e->mixed && !(options.tol >= RC_SINGLE_FLOOR))
                e = rc_engine_info(k + 1); /* the same in double precision */
            bytes += rc_by_padding(options.boundary, e->sum_bytes[0], e->sum_bytes[1]);
            break;
        }
    return (size_t)(bytes * (double)rc_grid_nodes(d->p));
}

/* If the map would fit into the memory with another engine, the message says so. */
static void
demand_memory(struct tool *t, const struct rc_grid *p, const struct rc_conv_options *options)
{
    const struct demand d = {p, options};

    t->remedy = tool_leaner_engine(t, rc_repeats(options->boundary) > 0, memory_by, &d);
    tool_demand_memory(t, p, memory_by(&d, options->engine));
    t->remedy = NULL;
}

/* The effects: computed, or why not. */
static const struct effect_state *
effects(const struct rc_conv_options *options, const struct layers *layers)
{
    static struct effect_state list[3];

    list[0] =
        (struct effect_state){"layers", layers->text != NULL ? "on" : "left out: one material"};
    list[1] = (struct effect_state){"padding", boundary_padding(options->boundary)};
    return list;
}

static void
put_report(struct report *r, const struct rc_grid *p, const struct rc_conv *conv,
           const struct rc_conv_options *options, const struct layers *layers, const double *u,
           const double seconds[2])
{
    double lowest = -INFINITY, highest = -INFINITY, sum = 0; /* lowest: of -u */

    for (size_t k = 0; k < rc_grid_nodes(p); k++) {
        lowest = fmax(lowest, -u[k]);
        highest = fmax(highest, u[k]);
        sum += u[k];
    }
    report_begin(r);
    report_map(r, p, rc_grid_case(p));
    boundary_report(r, p, options->boundary);
    report_text(r, "kernel", rc_conv_engine(conv));
    report_count(r, "threads", r->tool->threads, NULL);
    report_value(r, "min_displacement", -ranks_most(r->tool, lowest));
    report_value(r, "max_displacement", ranks_most(r->tool, highest));
    report_value(r, "mean_displacement", ranks_sum(r->tool, sum) / ((double)p->nx * (double)p->ny));
    /* relative to the sum of |K| |p| */
    report_number(r, "displacement_error_estimate", rc_conv_error(conv), NULL);
    report_number(r, "tol", options->tol, NULL);
    report_carried(r, rc_grid_get(p, "converged"));
    report_effects(r, effects(options, layers));
    report_seconds(
        r, (const struct report_phase[]){{"setup", seconds[0]}, {"sum", seconds[1]}, {NULL, 0}},
        seconds[0] + seconds[1]);
    report_memory(r);
    report_finish_row(r);
}

static void
show_plan(struct tool *t, struct report *r, const struct rc_grid *p,
          const struct rc_conv_options *options, const struct layers *layers)
{
    const struct demand d = {p, options};
    const char *reason;
    const struct plan plan =
        plan_begin(t, r, p, rc_grid_case(p), rc_boundary_word(options->boundary), "");

    plan_say(&plan, "kernel", "%s", rc_conv_choice(rc_shape_of(p), options, &reason));
    plan_effects(&plan, effects(options, layers));
    plan_end(&plan, 1, rc_conv_seconds(rc_shape_of(p), options),
             tool_memory_with(memory_by(&d, options->engine)));
}

static void
do_case(struct tool *t, struct report *r, const struct rc_grid *p)
{
    double began = tool_now(), seconds[2];
    struct rc_conv_options options = {.boundary = contact_boundary(t, p, &args.repeats),
                                      .engine = args.kernel,
                                      .tol = isnan(args.tol) ? 0 : args.tol,
                                      .order = args.order,
                                      .correction = args.correction,
                                      .memory = tool_memory_left(t),
                                      .loaded = loaded_fraction(t, p),
                                      .threads = t->threads,
                                      .ranks = ranks_of(t)};
    struct layers layers;
    struct rc_pair pair = pair_of(t, p, &layers);
    struct rc_conv *conv;
    RC_OWN(rc_grid, u) = NULL;

    tool_demand_finite(t, p, "recompute the map");
    if (args.dry_run) {
        show_plan(t, r, p, &options, &layers);
        layers_free(&layers);
        return;
    }
    demand_memory(t, p, &options);
    conv = tool_made(t, p, rc_conv_new(rc_shape_of(p), &pair, &options, &t->err));
    tool_note(t, "summed by %s, because %s; error at most %.1e of the sum of |K| |p|",
              rc_conv_engine(conv), rc_conv_reason(conv), rc_conv_error(conv));
    seconds[0] = tool_now() - began;
    u = tool_frame_like(t, p, NULL, "displacement", "m");
    if (pair.estar > 0)
        tool_set_number(t, u, "estar", pair.estar);
    map_set_boundary(t, u, options.boundary);
    tool_sign(t, u);
    began = tool_now();
    rc_conv_apply(conv, p->v, u->v);
    seconds[1] = tool_now() - began;
    tool_write(t, u);
    if (report_wanted(r))
        put_report(r, p, conv, &options, &layers, u->v, seconds);
    rc_conv_free(conv);
    layers_free(&layers);
}

int
main(int argc, char **argv)
{
    struct tool t;
    struct report report;
    struct rc_grid *p;

    tool_start(&t, &info, argc, argv, &args);
    report_open(&report, &t, args.report);
    while ((p = tool_channel(&t, "pressure", false)) != NULL) {
        do_case(&t, &report, p);
        rc_grid_free(p);
    }
    report_close(&report);
    return tool_finish(&t);
}
