/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Instrument and exchange files -> a stream of height maps, one case each. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "tools/import/import.h"

static struct args {
    const char *format, *channel, *z_unit, *xy_unit, *decimal, *separator, *missing, *labels, *mask;
    double dx, dy, even;
    size_t skip;
    bool list, formats, keep_going;
} args = {.dx = NAN, .dy = NAN, .even = NAN};

static const char *
format_word(size_t k)
{
    return rc_formats[k] == NULL ? NULL : rc_formats[k]->name;
}

/* In the order of enum rc_label. */
static const char *const label_words[] = {"auto", "keep", "row", "column", "both", NULL};

/* clang-format off */
static const struct opt opts[] = {
    {.name = "format", .type = OPT_TEXT, .at = offsetof(struct args, format), .result = true,
     .words = format_word, .arg = "NAME", .help = "read as this format (default: detected)"},
    {.name = "formats", .type = OPT_FLAG, .at = offsetof(struct args, formats), .text = true,
     .help = "print the table of formats"},
    {.name = "list", .type = OPT_FLAG, .at = offsetof(struct args, list), .text = true,
     .help = "print the channels of the files; * marks the one that is read"},
    {.name = "channel", .type = OPT_TEXT, .at = offsetof(struct args, channel), .result = true,
     .arg = "NAME", .help = "channel by number, name or its first letters (default: the topography)"},
    {.name = "dx", .type = OPT_NUMBER, .unit = UNIT_M, .at = offsetof(struct args, dx),
     .max = INFINITY, .above = true, .result = true, .arg = "LENGTH",
     .help = "spacing of columns, in place of that of the file"},
    {.name = "dy", .type = OPT_NUMBER, .unit = UNIT_M, .at = offsetof(struct args, dy),
     .max = INFINITY, .above = true, .result = true, .arg = "LENGTH",
     .help = "spacing of rows (default with --dx: the same)"},
    {.name = "even", .type = OPT_NUMBER, .unit = UNIT_M, .at = offsetof(struct args, even),
     .max = INFINITY, .above = true, .result = true, .optional = true, .arg = "STEP",
     .against = RULES({.with = "dx", .word = "STEP", .because = "both say how wide a step is"}),
     .help = "resample uneven profiles (default: median spacing)"},
    {.name = "z-unit", .type = OPT_TEXT, .at = offsetof(struct args, z_unit), .result = true,
     .arg = "UNIT", .help = "unit of the file's heights: um, nm or a number of metres"},
    {.name = "xy-unit", .type = OPT_TEXT, .at = offsetof(struct args, xy_unit), .result = true,
     .arg = "UNIT", .help = "unit of positions or steps if the file does not give it"},
    {.name = "labels", .type = OPT_CHOICE, .at = offsetof(struct args, labels), .result = true,
     .list = label_words, .arg = "WHICH",
     .help = "labels in a matrix of text: keep (none), row, column, both (default auto)"},
    {.name = "skip", .type = OPT_COUNT, .at = offsetof(struct args, skip), .max = 1e9,
     .result = true, .arg = "N", .help = "skip the first N lines of a text file"},
    {.name = "mask", .type = OPT_CHOICE, .at = offsetof(struct args, mask), .result = true,
     .arg = "apply|ignore",
     .help = "apply: points under the file's mask are missing; ignore: they are kept (default apply)"},
    {.name = "keep-going", .type = OPT_FLAG, .at = offsetof(struct args, keep_going),
     .help = "continue after a file that cannot be read; exit 1 at the end"},
    {.name = "decimal", .type = OPT_TEXT, .at = offsetof(struct args, decimal), .result = true,
     .arg = "MARK", .help = "decimal mark in text: . or , (default: detected)"},
    {.name = "separator", .type = OPT_TEXT, .at = offsetof(struct args, separator),
     .result = true, .arg = "MARK",
     .help = "separator of columns in text: space, tab, comma, semicolon or a character"},
    {.name = "missing", .type = OPT_TEXT, .at = offsetof(struct args, missing), .result = true,
     .arg = "WORD", .help = "mark of missing values: a number, or in text a word besides NaN, BAD, ---"},
    {.name = NULL},
};
/* clang-format on */

static const struct tool_info info = {
    .name = "rc-import",
    .summary = "Reads instrument and exchange files and writes their heights as a grid stream",
    .operands = "FILE...",
    .examples = "  rc-import surface.x3p | rc-detrend --plane -o level.rcg\n"
                "  rc-import --list surface.x3p\n"
                "  rc-import --dx 1.1um --z-unit nm heights.txt | rc-info\n",
    .opts = opts,
    .reads = READS_FILES,
    .writes = WRITES_STREAM,
};

/* ---- options that supplement the file ---- */

/* The value in metres of --NAME; its text becomes this number, because the history is in SI. */
static double
wish_unit(struct tool *t, const char *name, const char **text, char si[RC_NUMBER_SIZE])
{
    struct rc_err err;
    double metres;

    if (*text == NULL)
        return NAN;
    if (!rc_length_unit(*text, strlen(*text), &metres) &&
        unit_number(*text, UNIT_M, &metres, &err) != RC_OK)
        tool_usage(t, "--%s %s: a unit of length (um, nm, ...) or a number of metres is expected",
                   name, *text);
    if (!(metres > 0))
        tool_usage(t, "--%s %s: it must be above 0", name, *text);
    *text = rc_number_text(si, metres);
    return metres;
}

static const char *
wish_separator(struct tool *t)
{
    static const struct {
        const char *name, *mark;
    } names[] = {{"space", " "}, {"tab", "\t"}, {"comma", ","}, {"semicolon", ";"}};
    const char *text = args.separator;

    for (size_t k = 0; text != NULL && k < sizeof names / sizeof *names; k++)
        if (strcmp(text, names[k].name) == 0 || strcmp(text, names[k].mark) == 0) {
            args.separator = names[k].name; /* a tab would be hard to see in the history */
            return names[k].mark;
        }
    if (text != NULL && (strlen(text) != 1 || text[0] < '!' || strchr("0123456789+-.", text[0]) ||
                         (text[0] | 0x20) == 'e'))
        tool_usage(t,
                   "--separator '%s': space, tab, comma, semicolon or one character "
                   "that is not part of a number is expected",
                   text);
    return text;
}

static struct rc_wish
make_wish(struct tool *t)
{
    static char z_unit[RC_NUMBER_SIZE], xy_unit[RC_NUMBER_SIZE];
    struct rc_wish wish = {.dx = args.dx, .dy = args.dy, .missing = args.missing};

    wish.even = tool_given(t, "even");
    wish.even_step = isnan(args.even) ? 0 : args.even;
    wish.z_unit = wish_unit(t, "z-unit", &args.z_unit, z_unit);
    wish.xy_unit = wish_unit(t, "xy-unit", &args.xy_unit, xy_unit);
    for (size_t k = 0; args.labels != NULL && label_words[k] != NULL; k++)
        if (strcmp(args.labels, label_words[k]) == 0)
            wish.labels = (enum rc_label)k;
    wish.ignore_mask = args.mask != NULL && strcmp(args.mask, "ignore") == 0;
    wish.separator = wish_separator(t);
    if (args.decimal != NULL) {
        if (strcmp(args.decimal, ".") != 0 && strcmp(args.decimal, ",") != 0)
            tool_usage(t, "--decimal %s: it must be . or ,", args.decimal);
        wish.decimal = args.decimal[0];
    }
    if (wish.separator != NULL && wish.separator[0] == wish.decimal)
        tool_usage(t, "--decimal and --separator are both '%c'", wish.decimal);
    if (args.format != NULL && rc_format_named(args.format) == NULL)
        tool_usage(t, "--format %s: no such format; --formats prints them", args.format);
    return wish;
}

/* ---- files ---- */

/* A file that has been read, and its contents. */
struct source {
    unsigned char *data;
    struct rc_file file; /* describes data; its name is without .gz if it was packed */
    const char *name;    /* name of the file, without its folder */
    char inner[256];
    struct rc_maps *maps; /* the file, opened */
    struct rc_channel channel[CHANNELS_MOST];
    size_t n;
};

static enum rc_status
refuse_stream(const char *name, struct rc_err *err)
{
    bool piped = strcmp(name, "-") == 0;

    return rc_err_set(err,
                      "it is a grid stream already and needs no import: give it to the next "
                      "tool, as in '%s%s'",
                      piped ? "... | rc-info" : "rc-info ", piped ? "" : name);
}

/* Replaces a gzip file by its contents. --memory limits all that the process holds. */
static enum rc_status
unpack(const struct tool *t, struct source *s, struct rc_err *err)
{
    const size_t held = rc_memory_held().held;
    size_t most = t->memory == 0          ? rc_memory_limit(s->file.size)
                  : t->room.budget > held ? t->room.budget - held
                                          : 0;
    size_t size, n = strlen(s->name);
    unsigned char *data = rc_file_unpack(&s->file, most, &size, err);

    if (data == NULL)
        return RC_FAIL;
    free(s->data);
    s->data = data;
    s->file = (struct rc_file){s->name, data, size};
    if (rc_file_named(&s->file, ".gz") && n < sizeof s->inner) { /* the suffix before it counts */
        memcpy(s->inner, s->name, n - strlen(".gz"));
        s->inner[n - strlen(".gz")] = '\0';
        s->file.name = s->inner;
    }
    return RC_OK;
}

/* Replaces a ZIP archive with a single file, or an NPZ with a single array, by it; archives of several files
 * stay unchanged. */
static enum rc_status
unzip(const struct tool *t, struct source *s, struct rc_err *err)
{
    struct rc_zip_read *archive =
        rc_file_holds(&s->file, 0, "PK", 2) ? rc_zip_read_new(&s->file, NULL) : NULL;
    size_t most = t->memory == 0 ? rc_memory_limit(s->file.size) : t->memory, first, size = 0;
    const char *name, *slash;
    unsigned char *data = NULL;
    enum rc_status status = RC_OK;

    if (archive == NULL)
        return RC_OK;
    if (rc_zip_read_files(archive, &first) == 1) {
        name = rc_zip_read_name(archive, first);
        slash = strrchr(name, '/');
        name = slash == NULL ? name : slash + 1;
        if (strcmp(name, "main.xml") != 0) { /* the main file of an X3P */
            data = rc_zip_read_bytes(archive, first, most, &size, NULL, err);
            status = data == NULL ? RC_FAIL : RC_OK;
            snprintf(s->inner, sizeof s->inner, "%s", name);
        }
    }
    rc_zip_read_free(archive);
    if (s->inner[0] != '\0' && status == RC_OK) {
        free(s->data);
        s->data = data;
        s->file = (struct rc_file){s->inner, data, size};
    }
    return status;
}

/* Reads a file and determines its contents; source_close frees it in either case. */
static enum rc_status
source_open(struct tool *t, const char *name, const struct rc_wish *wish, struct source *s,
            struct rc_err *err)
{
    *s = (struct source){0};
    t->input.source = import_source(name);
    if ((s->data = import_read(t, name, &s->file, err)) == NULL)
        return RC_FAIL;
    s->name = s->file.name;
    if (rc_file_packed(&s->file) && unpack(t, s, err) != RC_OK)
        return RC_FAIL;
    if (s->inner[0] == '\0' && unzip(t, s, err) != RC_OK)
        return RC_FAIL;
    if (args.skip > 0 && import_skip(&s->file, s->data, args.skip, err) != RC_OK)
        return RC_FAIL;
    if (rc_file_holds(&s->file, 0, "RCG1\n", 5))
        return refuse_stream(name, err);
    s->maps = rc_format_open(args.format == NULL ? NULL : rc_format_named(args.format), &s->file,
                             wish, err);
    if (s->maps == NULL)
        return RC_FAIL;
    s->n = rc_maps_list(s->maps, s->channel, CHANNELS_MOST);
    if (s->n > CHANNELS_MOST) {
        tool_warn(t, "%s: only the first %d of its %zu channels are looked at", t->input.source,
                  CHANNELS_MOST, s->n);
        s->n = CHANNELS_MOST;
    }
    return RC_OK;
}

static void
source_close(struct source *s)
{
    rc_maps_free(s->maps);
    free(s->data);
}

static enum rc_status
pick_channel(const struct source *s, const struct rc_wish *wish, struct pick *pick,
             struct rc_err *err)
{
    return import_pick(s->channel, s->n, args.channel, !isnan(wish->z_unit), pick, err);
}

/* ---- text output ---- */

static void
print_formats(struct tool *t)
{
    for (const struct rc_format *const *f = rc_formats; *f != NULL; f++)
        fprintf(t->output.file, "%-10s  %-20s  %s\n", (*f)->name, (*f)->suffixes, (*f)->summary);
}

static const char *
number_or_dash(char text[RC_NUMBER_SIZE], double value)
{
    if (isnan(value))
        return "-";
    snprintf(text, RC_NUMBER_SIZE, "%.6g", value); /* rounded for people; the stream has all
                                                      digits */
    return text;
}

/* Smallest and largest value of a channel, in its unit or, if the file gives none, as stored. false, after a
 * message, when it cannot be read. */
static bool
range_of(struct tool *t, const struct source *s, const struct rc_wish *wish, size_t index,
         double range[2])
{
    const struct rc_channel *channel = &s->channel[index];
    struct rc_wish lax = *wish;
    struct rc_grid *g;
    struct rc_err err;

    if (isnan(lax.dx) && isnan(channel->dx))
        lax.dx = 1;
    if (isnan(lax.z_unit) && channel->unit[0] == '\0')
        lax.z_unit = 1;
    range[0] = INFINITY;
    range[1] = -INFINITY;
    if ((g = rc_format_read(s->maps, &lax, index, NULL, &err)) == NULL) {
        tool_fail(t, "%s: channel %zu: %s", t->input.source, index + 1, err.text);
        return false;
    }
    for (size_t k = 0; k < g->nx * g->ny; k++) {
        range[0] = g->v[k] < range[0] ? g->v[k] : range[0];
        range[1] = g->v[k] > range[1] ? g->v[k] : range[1];
    }
    rc_grid_free(g);
    return range[0] <= range[1];
}

/* A star marks the channel that would be read. */
static void
print_list(struct tool *t, const struct source *s, const struct rc_wish *wish)
{
    char dx[RC_NUMBER_SIZE], dy[RC_NUMBER_SIZE], low[RC_NUMBER_SIZE], high[RC_NUMBER_SIZE];
    struct pick pick;

    if (pick_channel(s, wish, &pick, NULL) != RC_OK)
        pick.index = s->n;
    shown_words(t->output.file, t->input.source, strlen(t->input.source));
    fprintf(t->output.file, ": %s\n", s->maps->format->name);
    fprintf(t->output.file, "%9s %8s %8s %12s %12s %-6s %12s %12s %s\n", "channel", "nx", "ny",
            "dx/m", "dy/m", "unit", "least", "greatest", "name");
    for (size_t k = 0; k < s->n; k++) {
        const struct rc_channel *c = &s->channel[k];
        double range[2];
        bool known = range_of(t, s, wish, k, range);

        fprintf(t->output.file, "%c %7zu %8zu %8zu %12s %12s %-6s %12s %12s %s\n",
                k == pick.index ? '*' : ' ', k + 1, c->nx, c->ny, number_or_dash(dx, c->dx),
                number_or_dash(dy, c->dy), c->unit[0] == '\0' ? "-" : c->unit,
                number_or_dash(low, known ? range[0] : NAN),
                number_or_dash(high, known ? range[1] : NAN), c->name);
    }
}

/* After a file that cannot be listed the next ones are still listed. */
static void
list_file(struct tool *t, const char *name, const struct rc_wish *wish)
{
    struct source s;
    struct rc_err err;

    if (source_open(t, name, wish, &s, &err) == RC_OK) {
        print_list(t, &s, wish);
    } else {
        fflush(t->output.file); /* so that messages and list appear in order on a terminal */
        tool_fail(t, "%s: %s", t->input.source, err.text);
    }
    source_close(&s);
}

/* ---- heights ---- */

/* The file is in memory already; unpacking needs more besides the map. A map that a child process reads
 * exists twice during its transfer. An untouched block, *reserved, counts the memory of the child. */
static enum rc_status
reserve(struct tool *t, const struct source *s, const struct rc_channel *channel, void **reserved,
        struct rc_err *err)
{
    const struct rc_shape shape = {channel->nx, channel->ny, 1, 1};
    size_t nodes, map, more;

    *reserved = NULL;
    if (rc_size_mul(channel->nx, channel->ny, &nodes, err) != RC_OK ||
        rc_size_mul(nodes, sizeof(double), &map, err) != RC_OK)
        return RC_FAIL;
    more = channel->beside < (double)SIZE_MAX ? (size_t)channel->beside : SIZE_MAX;
    if (s->maps->format->sandboxed)
        more = size_sum(more, size_sum(map, s->maps->format->copies ? s->file.size : 0));
    if (tool_ask_memory(t, &shape, size_sum(map, more), err) != RC_OK)
        return RC_FAIL;
    if (s->maps->format->sandboxed && (*reserved = malloc(more)) == NULL)
        return rc_err_set(err, "out of memory for a process that reads the file");
    return RC_OK;
}

/* Prints the difference between the extremes of a profile and those of its nodes. */
static void
say_extremes(struct tool *t, const struct rc_notes *notes)
{
    if (fmax(notes->above, notes->below) > 1e-6) /* the usual number of digits of heights */
        tool_warn(t,
                  "%s: between the nodes the file has a point %.2g %% of its span of heights above "
                  "the highest "
                  "node and one %.2g %% below the lowest: a finer --even STEP comes nearer",
                  t->input.source, 100 * notes->above, 100 * notes->below);
}

/* Resamples a profile to the step of --even, and prints which nodes are unknown and which extremes are
 * lost. */
static enum rc_status
even_out(struct tool *t, const struct source *s, const struct rc_wish *wish, struct rc_grid *g,
         struct rc_notes *notes, struct rc_err *err)
{
    size_t missing = 0;

    if (wish->even_step > 0 && import_even(&s->file, wish, g, notes, err) != RC_OK)
        return RC_FAIL;
    say_extremes(t, notes);
    for (size_t k = 0; k < g->nx && g->ny == 1; k++)
        missing += isnan(g->v[k]) != 0;
    if (missing > 0)
        tool_warn(t,
                  "%s: %zu of %zu nodes are missing: the points next to them are, or are more than "
                  "%d steps apart",
                  t->input.source, missing, g->nx, RC_EVEN_GAP);
    /* the history records the step, unless --dx does */
    args.even = wish->even_step > 0 ? wish->even_step : g->ny == 1 && isnan(wish->dx) ? g->dx : NAN;
    return RC_OK;
}

/* Sets the keys that an import adds to those of the reader. */
static enum rc_status
add_keys(struct tool *t, const struct source *s, size_t number, struct rc_grid *g,
         struct rc_err *err)
{
    if (strcmp(s->name, "-") != 0 &&
        rc_text_keep(g, "source", s->name, strlen(s->name), err) != RC_OK)
        return RC_FAIL;
    if (t->operands > 1 && rc_grid_set_number(g, "case", (double)number, err) != RC_OK)
        return RC_FAIL;
    return rc_grid_history(g, tool_history(t), err);
}

/* Sets values equal to the number of --missing in the file, which is not text any more, to missing. `unit` is
 * the value of 1 of the file in the grid's unit. */
static void
take_missing(const char *missing, struct rc_grid *g, double unit)
{
    double mark;
    const char *end = rc_number_read(missing, false, &mark);

    for (size_t k = 0; end != NULL && *end == '\0' && k < g->nx * g->ny; k++)
        if (fabs(g->v[k] / unit - mark) <= 1e-9 * fabs(mark))
            g->v[k] = NAN;
}

static enum rc_status
write_heights(struct tool *t, const struct source *s, const struct rc_wish *wish, size_t number,
              struct rc_err *err)
{
    struct rc_notes notes = {0};
    char names[IMPORT_NAMES];
    struct rc_grid *g;
    struct pick pick;
    void *reserved;
    double unit;

    if (pick_channel(s, wish, &pick, err) != RC_OK ||
        reserve(t, s, &s->channel[pick.index], &reserved, err) != RC_OK)
        return RC_FAIL;
    g = rc_format_read(s->maps, wish, pick.index, &notes, err);
    free(reserved);
    if (g == NULL)
        return RC_FAIL;
    if (notes.held > 0)
        tool_memory_beside(t, notes.held, 0);
    if (pick.said[0] != '\0')
        tool_warn(t, "%s: %s", t->input.source, pick.said);
    else if (s->maps->format->columns && s->n > 1 && args.channel == NULL)
        tool_warn(t, "%s: '%s' is read; other columns are channels: %s; --channel takes one",
                  t->input.source, s->channel[pick.index].name,
                  import_names(s->channel, s->n, pick.index, names));
    for (size_t k = 0; k < notes.n; k++)
        tool_warn(t, "%s: %s", t->input.source, notes.text[k]);
    unit = notes.metres > 0 && strcmp(g->unit, "m") == 0 ? notes.metres : 1;
    if (wish->missing != NULL)
        take_missing(wish->missing, g, unit);
    import_judge(t, g, wish, unit);
    import_judge_marks(t, g, unit);
    if ((wish->even && even_out(t, s, wish, g, &notes, err) != RC_OK) ||
        add_keys(t, s, number, g, err) != RC_OK) {
        rc_grid_free(g);
        return RC_FAIL;
    }
    tool_note(t, "%s: %s, channel %zu '%s', %zu x %zu nodes", t->input.source,
              s->maps->format->name, pick.index + 1, s->channel[pick.index].name, g->nx, g->ny);
    tool_write(t, g);
    rc_grid_free(g);
    return RC_OK;
}

/* With --keep-going a file that cannot be read leaves its case number unused. */
static bool
import_file(struct tool *t, const char *name, const struct rc_wish *wish, size_t number)
{
    struct source s;
    bool good = source_open(t, name, wish, &s, &t->err) == RC_OK &&
                write_heights(t, &s, wish, number, &t->err) == RC_OK;

    if (!good && !args.keep_going)
        tool_die(t, "%s: %s", t->input.source, t->err.text);
    if (!good)
        tool_fail(t, "%s: %s", t->input.source, t->err.text);
    source_close(&s);
    return good;
}

int
main(int argc, char **argv)
{
    struct rc_wish wish;
    size_t good = 0;
    struct tool t;

    tool_start(&t, &info, argc, argv, &args);
    t.remedy = "the file itself takes memory too";
    t.input.missing = t.input.infinite = true; /* unit, as in the file */
    wish = make_wish(&t);
    if (args.formats) {
        print_formats(&t);
        return tool_finish(&t);
    }
    if (t.operands == 0)
        tool_usage(&t, "name the files to import, or - for standard input");
    for (size_t k = 0; k < t.operands; k++)
        if (args.list)
            list_file(&t, t.operand[k], &wish);
        else
            good += import_file(&t, t.operand[k], &wish, k + 1);
    if (!args.list && good == 0)
        tool_die(&t, "none of the %zu files can be read", t.operands);
    return tool_finish(&t);
}
