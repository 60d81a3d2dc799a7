/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tools/cli/cli.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "formats/export.h"
#include "tools/frames/frames.h"

enum {
    EVEN_ROWS = 4096 /* largest number of rows made by --even */
};

static struct args {
    struct wanted wanted;
    const char *format, *type, *missing;
    bool formats, even;
    double relief;
} args;

static const struct {
    const char *name;
    enum rc_raw raw;
} types[] = {{"i16", RC_RAW_I16}, {"i32", RC_RAW_I32}, {"f32", RC_RAW_F32}, {"f64", RC_RAW_F64}};

static const char *
type_word(size_t k)
{
    return k < sizeof types / sizeof *types ? types[k].name : NULL;
}

static const char *
format_word(size_t k)
{
    return rc_exports[k] == NULL ? NULL : rc_exports[k]->name;
}

/* clang-format off */
static const struct opt opts[] = {
    {.name = "format", .type = OPT_TEXT, .at = offsetof(struct args, format), .result = true,
     .words = format_word, .arg = "NAME",
     .help = "write this format (default: as the suffix of -o FILE says)"},
    {.name = "formats", .type = OPT_FLAG, .at = offsetof(struct args, formats), .text = true,
     .help = "print the table of formats"},
    WANTED_OPTIONS(struct args, wanted, false),
    {.name = "even", .type = OPT_FLAG, .at = offsetof(struct args, even), .result = true,
     .help = "interpolate sections with uneven depths to even ones, linearly"},
    {.name = "type", .type = OPT_CHOICE, .at = offsetof(struct args, type), .result = true,
     .words = type_word,
     .help = "unit of the values in the file, if the format permits a choice"},
    {.name = "missing", .type = OPT_TEXT, .at = offsetof(struct args, missing), .arg = "WORD",
     .help = "word for a missing point in text (default: the format's own)"},
    {.name = "relief", .type = OPT_NUMBER, .unit = UNIT_M, .at = offsetof(struct args, relief),
     .max = INFINITY, .above = true, .result = true, .arg = "HEIGHT",
     .help = "height of a print from its lowest to its highest point (default: to scale)"},
    {.name = NULL},
};
/* clang-format on */

static void settle(struct tool *t);

static const struct tool_info info = {
    .name = "rc-export",
    .summary = "Writes the frames of a grid stream as a file that other programs read",
    .operands = "[FILE...]",
    .examples = "  rc-import surface.x3p | rc-detrend --plane | rc-export -o level.sdf\n"
                "  rc-stress --nu 0.28 --depths 0:20um:5 result.rcg | rc-export -o stress.vti\n"
                "  rc-export --format csv --channel pressure result.rcg | wc\n",
    .opts = opts,
    .reads = READS_STREAM,
    .writes = WRITES_BYTES,
    .settle = settle,
};

static const struct rc_export *format;
static struct rc_export_wish wish;

/* ---- frames to be written ---- */

static const char *
types_text(char text[32], unsigned set)
{
    text[0] = '\0';
    for (size_t k = 0; k < sizeof types / sizeof *types; k++)
        if (set >> types[k].raw & 1) {
            strcat(text, *text == '\0' ? "" : " ");
            strcat(text, types[k].name);
        }
    return text;
}

static void
settle_type(struct tool *t)
{
    char list[32];

    wish.typed = args.type != NULL;
    for (size_t k = 0; wish.typed && k < sizeof types / sizeof *types; k++)
        if (strcmp(types[k].name, args.type) == 0)
            wish.raw = types[k].raw;
    if (wish.typed && format->types == 0)
        tool_usage(t, "--type %s: %s is text and has no types", args.type, format->name);
    if (wish.typed && (format->types >> wish.raw & 1) == 0)
        tool_usage(t, "--type %s: %s holds only %s", args.type, format->name,
                   types_text(list, format->types));
}

static void
settle_missing(struct tool *t)
{
    wish.missing = args.missing;
    if (wish.missing != NULL && !format->text)
        tool_usage(t, "--missing: %s is not a text format and marks missing points by its own rule",
                   format->name);
    for (const char *s = wish.missing; s != NULL && *s != '\0'; s++)
        if (*s <= ' ' || *s > '~' || strchr(",;*", *s) != NULL)
            tool_usage(t,
                       "--missing '%s': one word without blanks, commas, semicolons and "
                       "asterisks is expected",
                       wish.missing);
    if (wish.missing != NULL && *wish.missing == '\0')
        tool_usage(t, "--missing: a word is expected");
}

static void
settle_relief(struct tool *t)
{
    wish.relief = args.relief;
    if (wish.relief > 0 && !format->relief)
        tool_usage(t, "--relief: %s keeps the heights, and is not a format for printers",
                   format->name);
}

/* Formats that require a date get today's, or SOURCE_DATE_EPOCH, for reproducible builds. */
static void
settle_time(struct tool *t)
{
    const char *given = getenv("SOURCE_DATE_EPOCH");
    char *end;

    wish.time = (int64_t)time(NULL);
    if (given == NULL || *given == '\0')
        return;
    errno = 0;
    wish.time = strtoll(given, &end, 10);
    if (errno != 0 || *end != '\0' || wish.time < 0)
        tool_usage(t, "SOURCE_DATE_EPOCH=%s: it must be seconds since 1970", given);
}

static void
settle(struct tool *t)
{
    static char creator[64];

    if (args.formats)
        return;
    if (args.format != NULL && (format = rc_export_named(args.format)) == NULL)
        tool_usage(t, "--format %s: no such format; --formats prints them", args.format);
    if (format == NULL && t->out_name != NULL && (format = rc_export_suffixed(t->out_name)) == NULL)
        tool_usage(t,
                   "-o %s: no format has this suffix: --format NAME says which one to "
                   "write, --formats prints them",
                   t->out_name);
    if (format == NULL)
        tool_usage(t, "which format? --format NAME says it, or the suffix of -o FILE; "
                      "--formats prints them");
    wanted_check(&args.wanted, t);
    settle_type(t);
    settle_missing(t);
    settle_relief(t);
    settle_time(t);
    snprintf(creator, sizeof creator, "rc-export %s", rc_version());
    wish.creator = creator;
    if (format->text)
        t->writes = WRITES_TEXT;
}

/* ---- sections: rows are depths ---- */

/* Between decimal depths the interpolated ones are decimal: 6e-06, not 6.000000000000001e-06. */
static double
decimal(double x)
{
    char text[32];

    snprintf(text, sizeof text, "%.14g", x);
    return strtod(text, NULL);
}

static void
set_depths(struct tool *t, struct rc_grid *g, double first, double step)
{
    RC_OWNED double *z = tool_room(t, g->ny, sizeof *z, "the depths of a section");

    for (size_t j = 0; j < g->ny; j++)
        z[j] = decimal(first + (double)j * step);
    tool_set_numbers(t, g, "depths", z, g->ny);
}

/* Interpolates rows of `to`, at equal steps from the first depth, from those of `from` at the depths `at`. */
static void
interpolate(const struct rc_grid *from, const double *at, struct rc_grid *to, double step)
{
    size_t nx = from->nx, k = 0;

    for (size_t j = 0; j < to->ny; j++) {
        double z = j + 1 < to->ny ? at[0] + (double)j * step : at[from->ny - 1], part;
        const double *a, *b;

        while (k + 2 < from->ny && at[k + 1] <= z)
            k++;
        part = (z - at[k]) / (at[k + 1] - at[k]);
        a = from->v + k * nx;
        b = a + nx;
        for (size_t i = 0; i < nx; i++) /* a row at the same depth is copied, even beside NaN */
            to->v[j * nx + i] = part <= 0   ? a[i]
                                : part >= 1 ? b[i]
                                            : (1 - part) * a[i] + part * b[i];
    }
}

/* Number of rows at steps of the smallest depth difference, up to the limit. */
static size_t
rows_needed(struct tool *t, const struct rc_grid *g, const double *at)
{
    double range = at[g->ny - 1] - at[0], smallest = range, needed;

    for (size_t j = 1; j < g->ny; j++)
        smallest = fmin(smallest, at[j] - at[j - 1]);
    needed = ceil(range / smallest * (1 - 1e-9)) + 1;
    if (needed <= EVEN_ROWS)
        return (size_t)needed;
    tool_warn(t, "--even: the smallest step of its depths would make %.0f rows: %d are made",
              needed, EVEN_ROWS);
    return EVEN_ROWS;
}

/* The frame itself or, for a section with uneven depths, one with even depths. */
static struct rc_grid *
even_rows(struct tool *t, struct rc_grid *g)
{
    struct rc_shape shape = rc_grid_shape(g);
    struct rc_grid *even = NULL;
    double *at, step;

    if (rc_grid_get(g, "section") == NULL || rc_grid_get(g, "depths") == NULL)
        return g;
    at = tool_room(t, g->ny, sizeof *at, "the depths of a section");
    tool_must(t, g, rc_export_depths(g, at, &t->err));
    if (!rc_export_even(at, g->ny, &step)) {
        shape.ny = rows_needed(t, g, at);
        shape.dy = step = decimal((at[g->ny - 1] - at[0]) / (double)(shape.ny - 1));
        even = tool_frame_like(t, g, &shape, g->channel, g->unit);
        even->type = g->type;
        interpolate(g, at, even, step);
        set_depths(t, even, at[0], step);
        rc_grid_free(g);
    }
    free(at);
    return even == NULL ? g : even;
}

/* ---- frames ---- */

/* True if the frame is another depth of the first one. */
static bool
is_deeper(const struct rc_grid *first, const struct rc_grid *g)
{
    return rc_grid_get(first, "depth") != NULL && rc_grid_get(g, "depth") != NULL &&
           strcmp(first->channel, g->channel) == 0 && rc_grid_case(first) == rc_grid_case(g);
}

static void
check_frame(struct tool *t, const struct rc_grid *first, const struct rc_grid *g)
{
    const char *channel = args.wanted.channel;

    if (first != NULL && !format->several && !(format->stack && is_deeper(first, g)))
        tool_refuse(
            t, g,
            "a second frame%s%s, but %s holds one map%s: choose with --channel, --case and --depth",
            channel == NULL ? "" : " of channel ", channel == NULL ? "" : channel, format->name,
            format->stack ? " or the depths of one channel and case" : "");
    if (format->heights && strcmp(g->unit, "m") != 0)
        tool_refuse(t, g,
                    "%s holds heights in metres, but these values are in '%s': choose a format "
                    "that stores the unit (gsf, gwy, vti, hdf5)",
                    format->name, g->unit);
}

/* All selected frames, which main frees. */
static struct rc_grid **
read_frames(struct tool *t, size_t *frames)
{
    struct rc_grid **frame = NULL, **more, *g;

    *frames = 0;
    while ((g = wanted_read(&args.wanted, t)) != NULL) {
        check_frame(t, *frames == 0 ? NULL : frame[0], g);
        if (args.even)
            g = even_rows(t, g);
        tool_sign(t, g);
        if ((more = realloc(frame, (*frames + 1) * sizeof(struct rc_grid *))) == NULL)
            tool_die(t, "out of memory for %zu frames", *frames + 1);
        frame = more;
        frame[(*frames)++] = g;
    }
    return frame;
}

/* Prints the size of the result if it differs from the size of the frame. */
static void
foretell(struct tool *t, const struct rc_grid *g)
{
    char text[200] = "";

    if (format->foretell != NULL)
        format->foretell(g, &wish, text, sizeof text);
    if (text[0] != '\0')
        tool_note(t, "%s: %s", format->name, text);
}

static void
print_formats(struct tool *t)
{
    char list[32];

    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++)
        fprintf(t->output.file, "%-10s  %-12s  %-16s  %-7s  %s\n", (*e)->name, (*e)->suffixes,
                (*e)->types == 0 ? "text" : types_text(list, (*e)->types),
                (*e)->several ? "several"
                : (*e)->stack ? "a stack"
                              : "one map",
                (*e)->summary);
}

int
main(int argc, char **argv)
{
    struct rc_grid **frame;
    struct tool t;
    size_t frames;

    tool_start(&t, &info, argc, argv, &args);
    if (args.formats) {
        print_formats(&t);
        return tool_finish(&t);
    }
    frame = read_frames(&t, &frames);
    if (frames > 0)
        foretell(&t, frame[0]);
    tool_must(&t, frame[0], rc_export_write(format, t.output.file, frame, frames, &wish, &t.err));
    tool_note(&t, "%zu frame%s as %s", frames, frames == 1 ? "" : "s", format->name);
    for (size_t k = 0; k < frames; k++)
        rc_grid_free(frame[k]);
    free(frame);
    return tool_finish(&t);
}
