/* Instrument and exchange files -> a stream of height maps, a case each. */
#include "tools/cli/cli.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "formats/format.h"
#include "formats/core/core.h"

enum {
    CHANNELS_MOST = 64 /* that are looked at in one file */
};

static struct args {
    const char *format, *channel, *z_unit, *decimal, *separator, *missing;
    double dx, dy;
    bool list, formats;
} args = {.dx = NAN, .dy = NAN};

static const char *
format_word(size_t k)
{
    return rc_formats[k] == NULL ? NULL : rc_formats[k]->name;
}

/* clang-format off */
static const struct opt opts[] = {
    {.name = "format", .type = OPT_TEXT, .at = offsetof(struct args, format), .result = true,
     .words = format_word, .arg = "NAME", .help = "read as this format (default: found out)"},
    {.name = "formats", .type = OPT_FLAG, .at = offsetof(struct args, formats), .text = true,
     .help = "print the table of formats"},
    {.name = "list", .type = OPT_FLAG, .at = offsetof(struct args, list), .text = true,
     .help = "print the channels of the files"},
    {.name = "channel", .type = OPT_TEXT, .at = offsetof(struct args, channel), .result = true,
     .arg = "NAME", .help = "channel by name or number (default: the first height)"},
    {.name = "dx", .type = OPT_NUMBER, .unit = UNIT_M, .at = offsetof(struct args, dx),
     .max = INFINITY, .above = true, .result = true, .arg = "LENGTH",
     .help = "spacing of columns, whatever the file says"},
    {.name = "dy", .type = OPT_NUMBER, .unit = UNIT_M, .at = offsetof(struct args, dy),
     .max = INFINITY, .above = true, .result = true, .arg = "LENGTH",
     .help = "spacing of rows (default with --dx: the same)"},
    {.name = "z-unit", .type = OPT_TEXT, .at = offsetof(struct args, z_unit), .result = true,
     .arg = "UNIT", .help = "unit of the file's heights: um, nm or a number of metres"},
    {.name = "decimal", .type = OPT_TEXT, .at = offsetof(struct args, decimal), .result = true,
     .arg = "MARK", .help = "decimal mark in text: . or , (default: found out)"},
    {.name = "separator", .type = OPT_TEXT, .at = offsetof(struct args, separator),
     .result = true, .arg = "MARK",
     .help = "between columns of text: space, tab, comma, semicolon or a character"},
    {.name = "missing", .type = OPT_TEXT, .at = offsetof(struct args, missing), .result = true,
     .arg = "WORD", .help = "marks missing values in text, beside NaN, BAD, --- and the like"},
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

/* ---- what the user says beside the file ---- */

static void
wish_unit(struct tool *t, struct rc_wish *wish)
{
    static char si[RC_NUMBER_SIZE];
    struct rc_err err;

    if (args.z_unit == NULL)
        return;
    if (!rc_length_unit(args.z_unit, strlen(args.z_unit), &wish->z_unit) &&
        unit_number(args.z_unit, UNIT_M, &wish->z_unit, &err) != RC_OK)
        tool_die(t, EXIT_USAGE,
                 "--z-unit %s: a unit of length (um, nm, ...) or a number of metres "
                 "is expected",
                 args.z_unit);
    if (!(wish->z_unit > 0))
        tool_die(t, EXIT_USAGE, "--z-unit %s: it must be above 0", args.z_unit);
    args.z_unit = rc_number_text(si, wish->z_unit); /* history is in SI */
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
        tool_die(t, EXIT_USAGE,
                 "--separator '%s': space, tab, comma, semicolon or one character "
                 "that is no part of a number is expected",
                 text);
    return text;
}

static struct rc_wish
make_wish(struct tool *t)
{
    struct rc_wish wish = {.dx = args.dx, .dy = args.dy, .z_unit = NAN, .missing = args.missing};

    wish_unit(t, &wish);
    wish.separator = wish_separator(t);
    if (args.decimal != NULL) {
        if (strcmp(args.decimal, ".") != 0 && strcmp(args.decimal, ",") != 0)
            tool_die(t, EXIT_USAGE, "--decimal %s: it must be . or ,", args.decimal);
        wish.decimal = args.decimal[0];
    }
    if (wish.separator != NULL && wish.separator[0] == wish.decimal)
        tool_die(t, EXIT_USAGE, "--decimal and --separator are both '%c'", wish.decimal);
    if (args.format != NULL && rc_format_named(args.format) == NULL)
        tool_die(t, EXIT_USAGE, "--format %s: no such format; --formats prints them", args.format);
    return wish;
}

/* ---- files ---- */

static FILE *
open_file(struct tool *t, const char *name)
{
    bool standard = strcmp(name, "-") == 0;
    FILE *in = standard ? stdin : fopen(name, "rb");

    t->source = standard ? "standard input" : name;
    if (in == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: %s", name, strerror(errno));
    if (isatty(fileno(in)))
        tool_die(t, EXIT_USAGE, "%s is a terminal: name a file", t->source);
    return in;
}

/* Bytes to begin with: the whole of a file, when it says how large it is. */
static size_t
first_size(FILE *in)
{
    struct stat st;

    if (fstat(fileno(in), &st) == 0 && S_ISREG(st.st_mode) && st.st_size > 0 &&
        (uintmax_t)st.st_size < SIZE_MAX / 2)
        return (size_t)st.st_size + 1;
    return 1 << 16;
}

/* The bytes of the file, which the caller frees. */
static unsigned char *
read_file(struct tool *t, const char *name, struct rc_file *file)
{
    FILE *in = open_file(t, name);
    const char *slash = strrchr(name, '/');
    size_t size = first_size(in), n = 0, got;
    unsigned char *data = NULL, *more;

    for (;;) {
        if (t->memory != 0 && size > t->memory)
            tool_die(t, EXIT_IMPOSSIBLE,
                     "%s: reading it needs more memory than the %zu MiB of "
                     "--memory",
                     t->source, t->memory >> 20);
        if ((more = realloc(data, size)) == NULL)
            tool_die(t, EXIT_IMPOSSIBLE, "%s: out of memory for %zu bytes", t->source, size);
        data = more;
        while (n < size && (got = fread(data + n, 1, size - n, in)) > 0)
            n += got;
        if (n < size)
            break;
        size *= 2;
    }
    if (ferror(in))
        tool_die(t, EXIT_IMPOSSIBLE, "%s: reading failed (%s)", t->source, strerror(errno));
    if (in != stdin)
        fclose(in);
    *file = (struct rc_file){slash == NULL ? name : slash + 1, data, n};
    return data;
}

static const struct rc_format *
format_of(struct tool *t, const struct rc_file *file)
{
    const struct rc_format *format;
    struct rc_err err;

    if (args.format != NULL)
        return rc_format_named(args.format);
    if ((format = rc_format_find(file, &err)) == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: %s", t->source, err.text);
    return format;
}

static size_t
list_of(struct tool *t, const struct rc_format *format, const struct rc_file *file,
        const struct rc_wish *wish, struct rc_channel channel[CHANNELS_MOST])
{
    struct rc_err err;
    size_t n = format->list(file, wish, channel, CHANNELS_MOST, &err);

    if (n == 0)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: %s", t->source, err.text);
    if (n > CHANNELS_MOST)
        tool_warn(t, "%s: only the first %d of its %zu channels are looked at", t->source,
                  CHANNELS_MOST, n);
    return n < CHANNELS_MOST ? n : CHANNELS_MOST;
}

/* ---- text output ---- */

static void
print_formats(struct tool *t)
{
    for (const struct rc_format *const *f = rc_formats; *f != NULL; f++)
        fprintf(t->out, "%-10s  %-20s  %s\n", (*f)->name, (*f)->suffixes, (*f)->summary);
}

static const char *
number_or_dash(char text[RC_NUMBER_SIZE], double value)
{
    return isnan(value) ? "-" : rc_number_text(text, value);
}

/* Least and greatest value of a channel, in its unit or, where the file gives none, as it stands
 * there; false when it cannot be read, which is said. */
static bool
range_of(struct tool *t, const struct rc_format *format, const struct rc_file *file,
         const struct rc_wish *wish, const struct rc_channel *channel, size_t index,
         double range[2])
{
    struct rc_wish lax = *wish;
    struct rc_grid *g;
    struct rc_err err;

    if (isnan(lax.dx) && isnan(channel->dx))
        lax.dx = 1;
    if (isnan(lax.z_unit) && channel->unit[0] == '\0')
        lax.z_unit = 1;
    range[0] = INFINITY;
    range[1] = -INFINITY;
    if ((g = format->read(file, &lax, index, NULL, &err)) == NULL) {
        tool_warn(t, "%s: channel %zu: %s", t->source, index + 1, err.text);
        return false;
    }
    for (size_t k = 0; k < g->nx * g->ny; k++) {
        range[0] = g->v[k] < range[0] ? g->v[k] : range[0];
        range[1] = g->v[k] > range[1] ? g->v[k] : range[1];
    }
    rc_grid_free(g);
    return range[0] <= range[1];
}

static void
print_list(struct tool *t, const struct rc_format *format, const struct rc_file *file,
           const struct rc_wish *wish)
{
    struct rc_channel channel[CHANNELS_MOST];
    size_t n = list_of(t, format, file, wish, channel);
    char dx[RC_NUMBER_SIZE], dy[RC_NUMBER_SIZE], low[RC_NUMBER_SIZE], high[RC_NUMBER_SIZE];

    fprintf(t->out, "%s: %s\n", t->source, format->name);
    fprintf(t->out, "%7s %8s %8s %22s %22s %-6s %24s %24s %s\n", "channel", "nx", "ny", "dx/m",
            "dy/m", "unit", "least", "greatest", "name");
    for (size_t k = 0; k < n; k++) {
        double range[2];
        bool known = range_of(t, format, file, wish, &channel[k], k, range);

        fprintf(t->out, "%7zu %8zu %8zu %22s %22s %-6s %24s %24s %s\n", k + 1, channel[k].nx,
                channel[k].ny, number_or_dash(dx, channel[k].dx), number_or_dash(dy, channel[k].dy),
                channel[k].unit[0] == '\0' ? "-" : channel[k].unit,
                number_or_dash(low, known ? range[0] : NAN),
                number_or_dash(high, known ? range[1] : NAN), channel[k].name);
    }
}

/* ---- heights ---- */

/* "1 'Phase' in deg, 2 'Current' in A" */
static const char *
channel_names(const struct rc_channel *channel, size_t n, char *names, size_t size)
{
    names[0] = '\0';
    for (size_t k = 0; k < n; k++) {
        size_t used = strlen(names);
        bool in = channel[k].unit[0] != '\0';
        snprintf(names + used, size - used, "%s%zu '%.*s'%s%s", used == 0 ? "" : ", ", k + 1,
                 (int)sizeof channel[k].name - 1, channel[k].name, in ? " in " : "",
                 channel[k].unit);
    }
    return names;
}

static size_t
pick_channel(struct tool *t, const struct rc_wish *wish, const struct rc_channel *channel, size_t n)
{
    char names[CHANNELS_MOST * (sizeof *channel + 16)];
    double number;
    const char *end;

    if (args.channel == NULL) {
        for (size_t k = 0; k < n; k++)
            if (strcmp(channel[k].unit, "m") == 0)
                return k;
        if (!isnan(wish->z_unit) || channel[0].unit[0] == '\0')
            return 0; /* its reader says what it lacks */
        tool_die(t, EXIT_IMPOSSIBLE,
                 "%s: no channel is a height: there are %s; --channel takes one "
                 "as it is, --z-unit says how many metres its unit is",
                 t->source, channel_names(channel, n, names, sizeof names));
    }
    for (size_t k = 0; k < n; k++)
        if (strcmp(channel[k].name, args.channel) == 0)
            return k;
    end = rc_number_read(args.channel, false, &number);
    if (end != NULL && *end == '\0' && number >= 1 && number <= (double)n &&
        number == floor(number))
        return (size_t)number - 1;
    tool_die(t, EXIT_IMPOSSIBLE, "%s: no channel '%s'; there are %s", t->source, args.channel,
             channel_names(channel, n, names, sizeof names));
}

static void
check_memory(struct tool *t, const struct rc_file *file, const struct rc_channel *channel)
{
    double bytes = (double)file->size + 8.0 * (double)channel->nx * (double)channel->ny;

    if (t->memory != 0 && bytes > (double)t->memory)
        tool_die(t, EXIT_IMPOSSIBLE,
                 "%s: %zu x %zu nodes and the file need about %.0f MiB, "
                 "--memory allows %zu",
                 t->source, channel->nx, channel->ny, ceil(bytes / 1048576), t->memory >> 20);
}

static void
write_heights(struct tool *t, const struct rc_format *format, const struct rc_file *file,
              const struct rc_wish *wish, size_t number)
{
    struct rc_channel channel[CHANNELS_MOST];
    size_t n = list_of(t, format, file, wish, channel);
    size_t index = pick_channel(t, wish, channel, n);
    struct rc_notes notes = {0};
    struct rc_grid *g;
    struct rc_err err;

    check_memory(t, file, &channel[index]);
    if ((g = format->read(file, wish, index, &notes, &err)) == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: %s", t->source, err.text);
    for (size_t k = 0; k < notes.n; k++)
        tool_warn(t, "%s: %s", t->source, notes.text[k]);
    if ((strcmp(file->name, "-") != 0 &&
         rc_text_keep(g, "source", file->name, strlen(file->name), &err) != RC_OK) ||
        (t->operands > 1 && rc_grid_set_number(g, "case", (double)number, &err) != RC_OK) ||
        rc_grid_history(g, tool_history(t), &err) != RC_OK)
        tool_die(t, EXIT_IMPOSSIBLE, "%s: %s", t->source, err.text);
    tool_note(t, "%s: %s, channel %zu '%s', %zu x %zu nodes", t->source, format->name, index + 1,
              channel[index].name, g->nx, g->ny);
    tool_write(t, g);
    rc_grid_free(g);
}

int
main(int argc, char **argv)
{
    struct rc_wish wish;
    struct rc_file file;
    struct tool t;

    tool_start(&t, &info, argc, argv, &args);
    wish = make_wish(&t);
    if (args.formats) {
        print_formats(&t);
        return tool_finish(&t);
    }
    if (t.operands == 0)
        tool_die(&t, EXIT_USAGE, "name the files to import, or - for standard input");
    for (size_t k = 0; k < t.operands; k++) {
        unsigned char *data = read_file(&t, t.operand[k], &file);
        const struct rc_format *format = format_of(&t, &file);

        if (args.list)
            print_list(&t, format, &file, &wish);
        else
            write_heights(&t, format, &file, &wish, k + 1);
        free(data);
    }
    return tool_finish(&t);
}
