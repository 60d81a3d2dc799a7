#include "tools/cli/cli.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "formats/export.h"
#include "libcontact/contact.h"

static struct args {
    const char *format, *channel, *type, *missing;
    bool formats;
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

/* clang-format off */
static const struct opt opts[] = {
    {.name = "format", .type = OPT_TEXT, .at = offsetof(struct args, format), .result = true,
     .arg = "NAME",
     .help = "write this format (default: as the suffix of -o FILE says)"},
    {.name = "formats", .type = OPT_FLAG, .at = offsetof(struct args, formats), .text = true,
     .help = "print the table of formats"},
    {.name = "channel", .type = OPT_TEXT, .at = offsetof(struct args, channel), .arg = "LIST",
     .help = "only the frames of these channels, separated by commas"},
    {.name = "type", .type = OPT_CHOICE, .at = offsetof(struct args, type), .result = true,
     .words = type_word,
     .help = "of the values in the file, where the format leaves it open"},
    {.name = "missing", .type = OPT_TEXT, .at = offsetof(struct args, missing), .arg = "WORD",
     .help = "stands for a missing point in text (default: the format's own)"},
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

/* ---- what is to be written ---- */

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
        tool_die(t, EXIT_USAGE, "--type %s: %s is text and has no types", args.type, format->name);
    if (wish.typed && (format->types >> wish.raw & 1) == 0)
        tool_die(t, EXIT_USAGE, "--type %s: %s holds only %s", args.type, format->name,
                 types_text(list, format->types));
}

static void
settle_missing(struct tool *t)
{
    wish.missing = args.missing;
    if (wish.missing != NULL && !format->text)
        tool_die(t, EXIT_USAGE, "--missing: %s is no text and marks missing points by its own rule",
                 format->name);
    for (const char *s = wish.missing; s != NULL && *s != '\0'; s++)
        if (*s <= ' ' || *s > '~' || strchr(",;*", *s) != NULL)
            tool_die(t, EXIT_USAGE,
                     "--missing '%s': one word without blanks, commas, semicolons and "
                     "asterisks is expected",
                     wish.missing);
    if (wish.missing != NULL && *wish.missing == '\0')
        tool_die(t, EXIT_USAGE, "--missing: a word is expected");
}

/* Formats that must bear a date get today's, or the one that reproducible builds agree on. */
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
        tool_die(t, EXIT_USAGE, "SOURCE_DATE_EPOCH=%s: it must be seconds since 1970", given);
}

static void
settle(struct tool *t)
{
    static char creator[64];

    if (args.formats)
        return;
    if (args.format != NULL && (format = rc_export_named(args.format)) == NULL)
        tool_die(t, EXIT_USAGE, "--format %s: no such format; --formats prints them", args.format);
    if (format == NULL && t->out_name != NULL && (format = rc_export_suffixed(t->out_name)) == NULL)
        tool_die(t, EXIT_USAGE,
                 "-o %s: no format has this suffix: --format NAME says which one to "
                 "write, --formats prints them",
                 t->out_name);
    if (format == NULL)
        tool_die(t, EXIT_USAGE,
                 "which format? --format NAME says it, or the suffix of -o FILE; "
                 "--formats prints them");
    settle_type(t);
    settle_missing(t);
    settle_time(t);
    snprintf(creator, sizeof creator, "rc-export %s", rc_version());
    wish.creator = creator;
    if (format->text)
        t->writes = WRITES_TEXT;
}

/* ---- frames ---- */

static bool
is_wanted(const struct rc_grid *g)
{
    const char *s = args.channel;
    size_t n;

    for (; s != NULL; s = s[n] == ',' ? s + n + 1 : NULL) {
        n = strcspn(s, ",");
        if (strlen(g->channel) == n && strncmp(g->channel, s, n) == 0)
            return true;
    }
    return args.channel == NULL;
}

static void
add_name(char *list, size_t size, const char *name)
{
    size_t used = strlen(list);

    snprintf(list + used, size - used, "%s%s", used == 0 ? "" : " ", name);
}

static void
check_frame(struct tool *t, const struct rc_grid *g, size_t frames)
{
    if (frames > 0 && !format->several)
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "a second frame%s%s, and %s holds one map: choose by --channel, or send one "
                    "case and depth",
                    args.channel == NULL ? "" : " of channel ",
                    args.channel == NULL ? "" : args.channel, format->name);
    if (format->heights && strcmp(g->unit, "m") != 0)
        tool_die_at(t, g, EXIT_IMPOSSIBLE,
                    "%s holds heights in metres, these values are in '%s': choose a format that "
                    "names the unit (gsf, gwy, vti, hdf5)",
                    format->name, g->unit);
}

/* All frames that are wanted, which main frees. */
static struct rc_grid **
read_frames(struct tool *t, size_t *frames)
{
    struct rc_grid **frame = NULL, **more, *g;
    char others[256] = "";
    struct rc_err err;
    size_t bytes = 0;

    *frames = 0;
    while ((g = tool_read(t)) != NULL) {
        if (!is_wanted(g)) {
            add_name(others, sizeof others, g->channel);
            rc_grid_free(g);
            continue;
        }
        check_frame(t, g, *frames);
        if (rc_grid_history(g, tool_history(t), &err) != RC_OK)
            tool_die_at(t, g, EXIT_IMPOSSIBLE, "%s", err.text);
        bytes += g->nx * g->ny * sizeof *g->v;
        tool_demand_memory(t, g, bytes);
        if ((more = realloc(frame, (*frames + 1) * sizeof(struct rc_grid *))) == NULL)
            tool_die(t, EXIT_IMPOSSIBLE, "out of memory for %zu frames", *frames + 1);
        frame = more;
        frame[(*frames)++] = g;
    }
    if (*frames == 0 && others[0] != '\0')
        tool_die(t, EXIT_IMPOSSIBLE, "%s: no frame with the channel %s, only %s", t->source,
                 args.channel, others);
    if (*frames == 0)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: the stream holds no frame", t->source);
    return frame;
}

static void
print_formats(struct tool *t)
{
    char list[32];

    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++)
        fprintf(t->out, "%-10s  %-12s  %-16s  %-7s  %s\n", (*e)->name, (*e)->suffixes,
                (*e)->types == 0 ? "text" : types_text(list, (*e)->types),
                (*e)->several ? "several" : "one map", (*e)->summary);
}

int
main(int argc, char **argv)
{
    struct rc_grid **frame;
    struct rc_err err;
    struct tool t;
    size_t frames;

    tool_start(&t, &info, argc, argv, &args);
    if (args.formats) {
        print_formats(&t);
        return tool_finish(&t);
    }
    frame = read_frames(&t, &frames);
    if (format->write(t.out, frame, frames, &wish, &err) != RC_OK)
        tool_die_at(&t, frame[0], EXIT_IMPOSSIBLE, "%s", err.text);
    tool_note(&t, "%zu frame%s as %s", frames, frames == 1 ? "" : "s", format->name);
    for (size_t k = 0; k < frames; k++)
        rc_grid_free(frame[k]);
    free(frame);
    return tool_finish(&t);
}
