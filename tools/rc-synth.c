/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rc-synth: surfaces made from a formula or from a seed. */

#include <math.h>
#include <string.h>

#include "tools/synth/synth.h"

static struct synth_args args = {
    .dx = NAN,
    .dy = NAN,
    .direction = NAN,
    .slope = NAN,
    .height = NAN,
    .edge = NAN,
    .amplitude = NAN,
    .hurst = NAN,
    .rms_slope = NAN,
    .rms_height = NAN,
    .rolloff = NAN,
    .short_cut = NAN,
    .long_cut = NAN,
    .anisotropy = NAN,
    .skewness = NAN,
    .weibull = NAN,
    .seed = 1,
};

#define LENGTH(word, member, what)                                                                 \
    {                                                                                              \
        .name = word, .type = OPT_NUMBER, .unit = UNIT_M,                                          \
        .at = offsetof(struct synth_args, member), .max = INFINITY, .above = true, .result = true, \
        .arg = "LENGTH", .help = what                                                              \
    }

/* clang-format off */
static const struct opt opts[] = {
    {.name = "nx", .type = OPT_COUNT, .at = offsetof(struct synth_args, nx), .min = 1, .max = 1e9,
     .result = true, .arg = "N", .help = "nodes in a row"},
    {.name = "ny", .type = OPT_COUNT, .at = offsetof(struct synth_args, ny), .min = 1, .max = 1e9,
     .result = true, .arg = "N", .help = "nodes in a column (default: as --nx; 1 makes a profile)"},
    LENGTH("dx", dx, "distance of nodes in a row"),
    LENGTH("dy", dy, "distance of rows (default: as --dx)"),
    {.name = "like", .type = OPT_TEXT, .at = offsetof(struct synth_args, like), .arg = "FILE",
     .against = RULES({.with = "nx|ny|dx|dy", .because = "the file defines the grid"}),
     .help = "the grid of FILE's first frame instead"},
    {.name = "radius", .type = OPT_NUMBERS, .unit = UNIT_M, .at = offsetof(struct synth_args, radius),
     .max = INFINITY, .above = true, .result = true, .arg = "R1[,R2]",
     .help = "sphere, cylinder, punch: its radius; paraboloid: two"},
    {.name = "slope", .type = OPT_NUMBER, .at = offsetof(struct synth_args, slope), .max = INFINITY,
     .above = true, .result = true, .arg = "SLOPE", .help = "cone: slope of its flank"},
    {.name = "height", .type = OPT_NUMBER, .unit = UNIT_M, .at = offsetof(struct synth_args, height),
     .max = INFINITY, .above = true, .result = true, .arg = "HEIGHT",
     .help = "punch: height of its end above the surrounding plane"},
    LENGTH("edge", edge, "punch: radius of its edge (default: sharp)"),
    {.name = "direction", .type = OPT_NUMBER, .at = offsetof(struct synth_args, direction), .min = -360,
     .max = 360, .result = true, .arg = "DEGREES",
     .help = "direction of a cylinder's axis, of a paraboloid's R1, of the lay of selfaffine"},
    {.name = "place", .type = OPT_NUMBERS, .unit = UNIT_M, .at = offsetof(struct synth_args, place),
     .result = true, .word = "highest", .arg = "X,Y|highest",
     .needs = RULES({.with = "like", .word = "highest", .because = "the file has the highest point"}),
     .help = "indenters: position of the apex (default: the middle)"},
    {.name = "amplitude", .type = OPT_NUMBER, .unit = UNIT_M,
     .at = offsetof(struct synth_args, amplitude), .max = INFINITY, .above = true, .result = true,
     .arg = "HEIGHT", .help = "wave: height of the crests above the mean plane"},
    {.name = "wavelength", .type = OPT_NUMBERS, .unit = UNIT_M,
     .at = offsetof(struct synth_args, wavelength), .max = INFINITY, .result = true, .arg = "LX[,LY]",
     .help = "wave: along x, or along x and y (0: none)"},
    {.name = "hurst", .type = OPT_NUMBER, .at = offsetof(struct synth_args, hurst), .max = 1,
     .above = true, .result = true, .arg = "H", .help = "selfaffine: Hurst exponent"},
    {.name = "rms-slope", .type = OPT_NUMBER, .at = offsetof(struct synth_args, rms_slope),
     .max = INFINITY, .above = true, .result = true, .arg = "SLOPE",
     .help = "selfaffine: RMS slope, or"},
    {.name = "rms-height", .type = OPT_NUMBER, .unit = UNIT_M,
     .at = offsetof(struct synth_args, rms_height), .max = INFINITY, .above = true, .result = true,
     .arg = "HEIGHT",
     .against = RULES({.with = "rms-slope", .because = "one follows from the other"}),
     .help = "selfaffine: RMS height"},
    LENGTH("rolloff", rolloff, "selfaffine: flat above (default: not flat)"),
    LENGTH("short-cut", short_cut, "selfaffine: shortest wave (default: 2 nodes)"),
    LENGTH("long-cut", long_cut, "selfaffine: longest wave (default: the map)"),
    {.name = "anisotropy", .type = OPT_NUMBER, .at = offsetof(struct synth_args, anisotropy), .min = 1,
     .max = INFINITY, .result = true, .arg = "RATIO",
     .help = "selfaffine: length of waves along the lay over that across it"},
    {.name = "skewness", .type = OPT_NUMBER, .at = offsetof(struct synth_args, skewness),
     .min = -RC_SKEWNESS_MAX, .max = RC_SKEWNESS_MAX, .result = true, .arg = "S",
     .against = RULES({.with = "weibull", .because = "heights have one distribution"}),
     .help = "selfaffine: skewness of the heights, by a gamma distribution"},
    {.name = "weibull", .type = OPT_NUMBER, .at = offsetof(struct synth_args, weibull),
     .min = RC_WEIBULL_MIN, .max = RC_WEIBULL_MAX, .result = true, .arg = "SHAPE",
     .help = "selfaffine: heights of a Weibull distribution"},
    {.name = "seed", .type = OPT_COUNT, .at = offsetof(struct synth_args, seed), .max = 9e15,
     .result = true, .arg = "N", .help = "selfaffine: seed of the random numbers (default: 1)"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-synth",
    .summary = "Make an analytic or a random surface",
    .operands = "sphere|cylinder|paraboloid|cone|punch|wave|selfaffine",
    .examples = "  rc-synth sphere --radius 2mm --nx 65 --dx 1um > sphere.rcg\n"
                "  rc-synth cone --slope 0.05 --nx 65 --dx 1um > cone.rcg\n"
                "  rc-synth selfaffine --hurst 0.8 --rms-slope 0.1 --nx 512 --dx 1um | rc-info\n",
    .opts = opts,
    .reads = READS_FILES,
    .writes = WRITES_STREAM,
    .shares = true,
};

/* ---- the command line ---- */

static const char *const grid_options[] = {"nx", "ny", "dx", "dy", "like", NULL};

static bool
listed(const char *const *list, const char *name)
{
    for (; *list != NULL; list++)
        if (strcmp(*list, name) == 0)
            return true;
    return false;
}

static const struct synth_shape *
find_shape(struct tool *t)
{
    if (t->operands == 0)
        tool_usage(t, "no shape named: one of %s; see rc-synth --help", info.operands);
    if (t->operands > 1)
        tool_usage(t, "'%s' after %s: one shape at a time", t->operand[1], t->operand[0]);
    for (const struct synth_shape *row = synth_shapes; row->name != NULL; row++)
        if (strcmp(row->name, t->operand[0]) == 0)
            return row;
    tool_usage(t, "unknown shape '%s': one of %s", t->operand[0], info.operands);
}

/* Checks that all options of the shape are given, and no others. */
static void
check_options(struct tool *t, const struct synth_shape *row)
{
    for (const char *const *name = row->needs; *name != NULL; name++)
        if (!tool_given(t, *name))
            tool_usage(t, "%s needs --%s", row->name, *name);
    for (const struct opt *o = opts; o->name != NULL; o++)
        if (tool_given(t, o->name) && !listed(grid_options, o->name) &&
            !listed(row->needs, o->name) && !listed(row->takes, o->name))
            tool_usage(t, "--%s has no meaning for %s", o->name, row->name);
}

/* Uses the position of the highest measured node for --place. */
static void
place_highest(struct tool *t, const struct rc_grid *g)
{
    const struct rc_shape shape = rc_grid_shape(g);
    size_t n = rc_grid_nodes(g), top = n, first, rows;
    double place[2];

    for (size_t k = 0; k < n; k++)
        if (isfinite(g->v[k]) && (top == n || g->v[k] > g->v[top]))
            top = k;
    if (ranks_most(t, top < n) == 0)
        tool_die(t, "--like %s: no height was measured: --place highest is nowhere", args.like);
    ranks_rows(t, &shape, &first, &rows);
    place[0] = ((double)(top % g->nx) - 0.5 * (double)(g->nx - 1)) * g->dx;
    place[1] = ((double)(first + top / g->nx) - 0.5 * (double)(g->ny - 1)) * g->dy;
    ranks_share(t, ranks_where_most(t, top < n ? g->v[top] : -INFINITY), place, sizeof place);
    args.place.n = 2;
    args.place.v = tool_room(t, 2, sizeof *args.place.v, "a place");
    args.place.v[0] = place[0];
    args.place.v[1] = place[1];
}

static struct rc_shape
shape_of_file(struct tool *t)
{
    bool highest = tool_given(t, "place") && args.place.n == 0;
    RC_OWN(rc_grid, g) = tool_frame_of_file(t, "like", args.like, highest ? "height" : NULL);
    struct rc_shape shape = rc_grid_shape(g);

    if (highest)
        place_highest(t, g);
    return shape;
}

static void
check_place(struct tool *t, const struct rc_shape *shape)
{
    double x = 0.5 * (double)shape->nx * shape->dx, y = 0.5 * (double)shape->ny * shape->dy;

    if (!tool_given(t, "place"))
        return;
    if (args.place.n != 2)
        tool_usage(t, "--place takes X,Y from the middle of the map, or, with --like, highest");
    if (fabs(args.place.v[0]) > x || fabs(args.place.v[1]) > y)
        tool_usage(
            t, "--place %g,%g m: beyond the map, which reaches to %g m and %g m from its middle",
            args.place.v[0], args.place.v[1], x, y);
}

static void
check_radii(struct tool *t, const struct synth_shape *row)
{
    if (row->radii == 1 && args.radius.n != 1)
        tool_usage(t, "--radius takes one radius of a %s, not %zu", row->name, args.radius.n);
    if (row->radii == 2 && args.radius.n != 2)
        tool_usage(t, "--radius takes the two radii of a paraboloid, R1,R2");
}

static struct rc_shape
wanted_shape(struct tool *t)
{
    if (args.like != NULL)
        return shape_of_file(t);
    if (!tool_given(t, "nx") || !tool_given(t, "dx"))
        tool_usage(t, "the grid is not known: give --nx and --dx, or --like FILE");
    return (struct rc_shape){
        .nx = args.nx,
        .ny = tool_given(t, "ny") ? args.ny : args.nx,
        .dx = args.dx,
        .dy = tool_given(t, "dy") ? args.dy : args.dx,
    };
}

static void
add_keys(struct tool *t, const struct synth_shape *row, struct rc_grid *g, bool periodic)
{
    char step[1024], source[64], form[RC_NUMBER_SIZE + 10];

    if (listed(row->takes, "seed"))
        snprintf(source, sizeof source, "%s-seed-%zu", row->name, args.seed);
    else
        snprintf(source, sizeof source, "%s", row->name);
    snprintf(step, sizeof step, "%s %s", tool_history(t), row->name);
    tool_set(t, g, "source", source);
    if (periodic)
        tool_set(t, g, "periodic", "yes");
    if (strcmp(row->name, "sphere") == 0 && !tool_given(t, "place")) {
        snprintf(form, sizeof form, "sphere %s", rc_number(args.radius.v[0]));
        tool_set(t, g, "form", form);
    }
    tool_must(t, NULL, rc_grid_history(g, step, &t->err));
}

int
main(int argc, char **argv)
{
    const struct synth_shape *row;
    struct synth_map map = {.tool = NULL};
    struct rc_shape shape;
    struct rc_grid *g;
    struct tool t;
    enum rc_status status;

    tool_start(&t, &info, argc, argv, &args);
    row = find_shape(&t);
    check_options(&t, row);
    shape = wanted_shape(&t);
    check_place(&t, &shape);
    check_radii(&t, row);
    if (row->check != NULL)
        row->check(&t, &args, &shape);
    t.remedy = "take fewer nodes: --nx, --ny";
    tool_must(&t, NULL, rc_shape_check(&shape, &t.err));
    map = (struct synth_map){.tool = &t, .shape = &shape};
    ranks_rows(&t, &shape, &map.first, &map.rows);
    tool_must(&t, NULL, tool_ask_memory(&t, &shape, shape.nx * map.rows * sizeof *g->v, &t.err));
    g = tool_made(&t, NULL, rc_grid_new_part(&shape, map.rows, "height", "m", &t.err));
    map.h = g->v;
    status = row->make(&args, &map, &t.err);
    tool_must(&t, NULL, ranks_agree(&t, status, &t.err));
    add_keys(&t, row, g, map.periodic);
    tool_write(&t, g);
    rc_grid_free(g);
    return tool_finish(&t);
}
