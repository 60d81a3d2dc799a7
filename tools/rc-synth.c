#include "tools/cli/cli.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#include "libcontact/contact.h"

static struct args {
    size_t nx, ny;
    double dx, dy;
    const char *like;
    double radius, amplitude;
    struct numbers wavelength;
    double hurst, rms_slope, rms_height, rolloff, short_cut, long_cut;
    size_t seed;
} args = {
    .dx = NAN,
    .dy = NAN,
    .radius = NAN,
    .amplitude = NAN,
    .hurst = NAN,
    .rms_slope = NAN,
    .rms_height = NAN,
    .rolloff = NAN,
    .short_cut = NAN,
    .long_cut = NAN,
    .seed = 1,
};

#define LENGTH(word, member, what)                                                                 \
    {                                                                                              \
        .name = word, .type = OPT_NUMBER, .unit = UNIT_M, .at = offsetof(struct args, member),     \
        .max = INFINITY, .above = true, .result = true, .arg = "LENGTH", .help = what              \
    }

/* clang-format off */
static const struct opt opts[] = {
    {.name = "nx", .type = OPT_COUNT, .at = offsetof(struct args, nx), .min = 1, .max = 1e9,
     .result = true, .arg = "N", .help = "nodes in a row"},
    {.name = "ny", .type = OPT_COUNT, .at = offsetof(struct args, ny), .min = 1, .max = 1e9,
     .result = true, .arg = "N", .help = "rows (default: as --nx; 1 makes a profile)"},
    LENGTH("dx", dx, "distance of nodes in a row"),
    LENGTH("dy", dy, "distance of rows (default: as --dx)"),
    {.name = "like", .type = OPT_TEXT, .at = offsetof(struct args, like), .arg = "FILE",
     .help = "the grid of FILE's first frame instead"},
    LENGTH("radius", radius, "sphere: its radius"),
    {.name = "amplitude", .type = OPT_NUMBER, .unit = UNIT_M,
     .at = offsetof(struct args, amplitude), .max = INFINITY, .above = true, .result = true,
     .arg = "HEIGHT", .help = "wave: mean plane to crest"},
    {.name = "wavelength", .type = OPT_NUMBERS, .unit = UNIT_M,
     .at = offsetof(struct args, wavelength), .max = INFINITY, .result = true, .arg = "LX[,LY]",
     .help = "wave: along x, or along x and y (0: none)"},
    {.name = "hurst", .type = OPT_NUMBER, .at = offsetof(struct args, hurst), .max = 1,
     .above = true, .result = true, .arg = "H", .help = "selfaffine: Hurst exponent"},
    {.name = "rms-slope", .type = OPT_NUMBER, .at = offsetof(struct args, rms_slope),
     .max = INFINITY, .above = true, .result = true, .arg = "SLOPE",
     .help = "selfaffine: RMS slope, or"},
    {.name = "rms-height", .type = OPT_NUMBER, .unit = UNIT_M,
     .at = offsetof(struct args, rms_height), .max = INFINITY, .above = true, .result = true,
     .arg = "HEIGHT", .help = "selfaffine: RMS height"},
    LENGTH("rolloff", rolloff, "selfaffine: flat above (default: not flat)"),
    LENGTH("short-cut", short_cut, "selfaffine: shortest wave (default: 2 nodes)"),
    LENGTH("long-cut", long_cut, "selfaffine: longest wave (default: the map)"),
    {.name = "seed", .type = OPT_COUNT, .at = offsetof(struct args, seed), .max = 9e15,
     .result = true, .arg = "N", .help = "selfaffine: another one, another surface (default: 1)"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-synth",
    .summary = "Make an analytic or a random surface",
    .operands = "sphere|wave|selfaffine",
    .examples = "  rc-synth sphere --radius 2mm --nx 65 --dx 1um > sphere.rcg\n"
                "  rc-synth selfaffine --hurst 0.8 --rms-slope 0.1 --nx 512 --dx 1um | rc-info\n",
    .opts = opts,
    .reads = READS_FILES,
    .writes = WRITES_STREAM,
};

/* ---- shapes: check, make, and the table ---- */

/* Whether whole waves fit the side; a tolerance for nx * dx / wavelength in decimal numbers. */
static bool
fits(size_t n, double d, double wavelength)
{
    double waves = (double)n * d / wavelength;

    return n == 1 || isinf(wavelength) ||
           (waves > 0.5 && fabs(waves - round(waves)) <= 1e-9 * waves);
}

/* A side of the grid that a wave runs along has at least two nodes for each period. */
static void
check_wave(struct tool *t, const struct rc_shape *shape)
{
    const struct numbers *w = &args.wavelength;
    const double d[] = {shape->dx, shape->dy};
    const size_t n[] = {shape->nx, shape->ny};

    if (w->n > 2 || w->v[0] + (w->n == 2 ? w->v[1] : 0) == 0)
        tool_die(t, EXIT_USAGE, "--wavelength takes LX, or LX,LY where one of them may be 0");
    for (size_t k = 0; k < w->n; k++)
        if (n[k] > 1 && w->v[k] != 0 && w->v[k] < 2 * d[k] * (1 - 1e-9))
            tool_die(t, EXIT_USAGE,
                     "--wavelength %g m: shorter than two nodes %g m apart: take a "
                     "finer grid",
                     w->v[k], d[k]);
}

static enum rc_status
make_wave(const struct rc_shape *shape, double *h, bool *periodic, struct rc_err *err)
{
    const struct numbers *w = &args.wavelength;
    double x = w->v[0] == 0 ? INFINITY : w->v[0];
    double y = w->n < 2 || w->v[1] == 0 ? INFINITY : w->v[1];

    (void)err;
    rc_synth_wave(shape, args.amplitude, x, y, h);
    *periodic = fits(shape->nx, shape->dx, x) && fits(shape->ny, shape->dy, y);
    return RC_OK;
}

static enum rc_status
make_sphere(const struct rc_shape *shape, double *h, bool *periodic, struct rc_err *err)
{
    (void)err;
    rc_synth_sphere(shape, args.radius, h);
    *periodic = false;
    return RC_OK;
}

static void
check_selfaffine(struct tool *t, const struct rc_shape *shape)
{
    (void)shape;
    if (isnan(args.rms_slope) == isnan(args.rms_height))
        tool_die(t, EXIT_USAGE,
                 "selfaffine needs one of --rms-slope and --rms-height: the other "
                 "one follows");
}

/* The library's word for what was not given is 0. */
static double
or_default(double value)
{
    return isnan(value) ? 0 : value;
}

static enum rc_status
make_selfaffine(const struct rc_shape *shape, double *h, bool *periodic, struct rc_err *err)
{
    const struct rc_selfaffine what = {
        .hurst = args.hurst,
        .rms_height = or_default(args.rms_height),
        .rms_slope = or_default(args.rms_slope),
        .long_cut = or_default(args.long_cut),
        .rolloff = or_default(args.rolloff),
        .short_cut = or_default(args.short_cut),
        .seed = args.seed,
    };

    *periodic = true;
    return rc_synth_selfaffine(shape, &what, h, err);
}

/* clang-format off */
static const struct shape_row {
    const char *name;
    const char *needs[4], *takes[8]; /* options, ended by NULL                               */
    size_t maps;                     /* arrays of the map's size that it takes to make it    */
    void (*check)(struct tool *t, const struct rc_shape *shape); /* may be NULL              */
    enum rc_status (*make)(const struct rc_shape *shape, double *h, bool *periodic,
                           struct rc_err *err);
} shapes[] = {
    {.name = "sphere", .needs = {"radius"}, .maps = 1, .make = make_sphere},
    {.name = "wave", .needs = {"amplitude", "wavelength"}, .maps = 1, .check = check_wave,
     .make = make_wave},
    {.name = "selfaffine", .needs = {"hurst"},
     .takes = {"rms-slope", "rms-height", "rolloff", "short-cut", "long-cut", "seed"}, .maps = 2,
     .check = check_selfaffine, .make = make_selfaffine},
    {.name = NULL},
};
/* clang-format on */

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

static const struct shape_row *
find_shape(struct tool *t)
{
    if (t->operands == 0)
        tool_die(t, EXIT_USAGE, "no shape named: one of %s; see rc-synth --help", info.operands);
    if (t->operands > 1)
        tool_die(t, EXIT_USAGE, "'%s' after %s: one shape at a time", t->operand[1], t->operand[0]);
    for (const struct shape_row *row = shapes; row->name != NULL; row++)
        if (strcmp(row->name, t->operand[0]) == 0)
            return row;
    tool_die(t, EXIT_USAGE, "unknown shape '%s': one of %s", t->operand[0], info.operands);
}

/* Every option that the shape needs is given, and none that it has no use for. */
static void
check_options(struct tool *t, const struct shape_row *row)
{
    for (const char *const *name = row->needs; *name != NULL; name++)
        if (!tool_given(t, *name))
            tool_die(t, EXIT_USAGE, "%s needs --%s", row->name, *name);
    for (const struct opt *o = opts; o->name != NULL; o++)
        if (tool_given(t, o->name) && !listed(grid_options, o->name) &&
            !listed(row->needs, o->name) && !listed(row->takes, o->name))
            tool_die(t, EXIT_USAGE, "--%s has no meaning for %s", o->name, row->name);
}

static struct rc_shape
shape_of_file(struct tool *t)
{
    bool standard = strcmp(args.like, "-") == 0;
    FILE *file = standard ? stdin : fopen(args.like, "rb");
    struct rc_reader *reader;
    struct rc_grid *g = NULL;
    struct rc_shape shape;
    struct rc_err err;
    enum rc_status status;

    if (file == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "--like %s: %s", args.like, strerror(errno));
    reader = rc_reader_new(file, 0, t->memory, &err);
    status = reader == NULL ? RC_FAIL : rc_reader_next(reader, &g, &err);
    if (status == RC_FAIL)
        tool_die(t, EXIT_IMPOSSIBLE, "--like %s: %s", args.like, err.text);
    if (g == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "--like %s: no frame is in it", args.like);
    shape = rc_grid_shape(g);
    rc_grid_free(g);
    rc_reader_free(reader);
    if (!standard)
        fclose(file);
    return shape;
}

static struct rc_shape
wanted_shape(struct tool *t)
{
    for (const char *const *name = grid_options; strcmp(*name, "like") != 0; name++)
        if (args.like != NULL && tool_given(t, *name))
            tool_die(t, EXIT_USAGE, "--like gives the whole grid: leave out --%s", *name);
    if (args.like != NULL)
        return shape_of_file(t);
    if (!tool_given(t, "nx") || !tool_given(t, "dx"))
        tool_die(t, EXIT_USAGE, "the grid is not known: give --nx and --dx, or --like FILE");
    return (struct rc_shape){
        .nx = args.nx,
        .ny = tool_given(t, "ny") ? args.ny : args.nx,
        .dx = args.dx,
        .dy = tool_given(t, "dy") ? args.dy : args.dx,
    };
}

static void
check_memory(struct tool *t, const struct shape_row *row, const struct rc_shape *shape)
{
    double bytes = 8.0 * (double)row->maps * (double)shape->nx * (double)shape->ny;

    if (t->memory > 0 && bytes > (double)t->memory)
        tool_die(t, EXIT_IMPOSSIBLE,
                 "%zu x %zu nodes of %s need %.0f bytes, more than --memory "
                 "allows",
                 shape->nx, shape->ny, row->name, bytes);
}

static void
add_keys(struct tool *t, const struct shape_row *row, struct rc_grid *g, bool periodic)
{
    char step[1024];
    struct rc_err err;

    snprintf(step, sizeof step, "%s %s", tool_history(t), row->name);
    if ((periodic && rc_grid_set(g, "periodic", "yes", &err) != RC_OK) ||
        rc_grid_history(g, step, &err) != RC_OK)
        tool_die(t, EXIT_IMPOSSIBLE, "%s", err.text);
}

int
main(int argc, char **argv)
{
    const struct shape_row *row;
    struct rc_shape shape;
    struct rc_grid *g;
    struct rc_err err;
    struct tool t;
    bool periodic;

    tool_start(&t, &info, argc, argv, &args);
    row = find_shape(&t);
    check_options(&t, row);
    shape = wanted_shape(&t);
    if (row->check != NULL)
        row->check(&t, &shape);
    check_memory(&t, row, &shape);
    g = rc_grid_new(&shape, "height", "m", &err);
    if (g == NULL || row->make(&shape, g->v, &periodic, &err) != RC_OK)
        tool_die(&t, EXIT_IMPOSSIBLE, "%s", err.text);
    add_keys(&t, row, g, periodic);
    tool_write(&t, g);
    rc_grid_free(g);
    return tool_finish(&t);
}
