/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Reads input: the frames of all streams, one after another, with checks of them.
 */
#include "tool.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "foreign.h"
#include "libcontact/contact.h"
#include "parts.h"
#include "tools/machine/machine.h"
#include "ranks.h"
#include "results.h"

static const double seconds =
    0.1; /* seconds for which the free memory of the machine is assumed constant */

/* Updates the budget before a frame is read: other processes may have allocated or freed memory since the
 * last one. */
static enum rc_status
allow(void *tool, const struct rc_shape *shape, size_t bytes, struct rc_err *err)
{
    struct tool *t = tool;
    const char *remedy = t->remedy;
    enum rc_status status;

    if (tool_now() > t->room.at + seconds)
        tool_budget(t);
    t->remedy = "use a coarser or smaller map, or raise --memory";
    status = tool_ask_memory(t, shape, bytes, err);
    t->remedy = remedy;
    return status;
}

/* Advice for `--load 60 N`, whose last word is taken for a file. */
static bool
is_unit(const char *name)
{
    static const enum unit units[] = {UNIT_N, UNIT_PA, UNIT_M, UNIT_S, UNIT_BYTES};
    char number[32];
    struct rc_err err;
    double value;

    if (!isalpha((unsigned char)*name) || strlen(name) > 4)
        return false;
    snprintf(number, sizeof number, "1%s", name);
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (unit_number(number, units[k], &value, &err) == RC_OK)
            return true;
    return false;
}

static void
open_next(struct tool *t)
{
    const char *name = t->operands == 0 ? "-" : t->operand[t->input.next];

    t->input.next++;
    t->input.frame = 0;
    if (strcmp(name, "-") == 0) {
        t->input.file = stdin;
        t->input.source = "standard input";
    } else {
        t->input.source = name;
        if ((t->input.file = fopen(name, "rb")) == NULL)
            tool_die(t, "%s: %s%s%s", name, strerror(errno),
                     is_unit(name) ? ": a unit follows its number without a blank, as in 60" : "",
                     is_unit(name) ? name : "");
    }
    if (t->ranks != NULL && (t->input.file == stdin || fseeko(t->input.file, 0, SEEK_CUR) != 0))
        tool_usage(
            t, "%s: several processes read a file, each its part of it: name one instead of a pipe",
            t->input.source);
    if (isatty(fileno(t->input.file)))
        tool_usage(t, "%s is a terminal: pipe a grid stream in or name a file", t->input.source);
    setvbuf(t->input.file, NULL, _IOFBF, TOOL_BUFFER);
    pipe_widen(fileno(t->input.file));
    t->input.reader =
        tool_made(t, NULL, rc_reader_new(t->input.file, t->input.last_case, 0, &t->err));
    if (t->ranks != NULL) {
        t->input.share = ranks_read(t, name);
        rc_reader_share(t->input.reader, t->input.share);
    }
    rc_reader_ask(t->input.reader, allow, t);
    if (t->input.by_rows)
        rc_reader_by_rows(t->input.reader);
}

static void
close_input(struct tool *t)
{
    t->input.last_case = rc_reader_last_case(t->input.reader);
    rc_reader_free(t->input.reader);
    t->input.reader = NULL;
    ranks_close(t, t->input.share);
    t->input.share = NULL;
    if (t->input.file != stdin)
        fclose(t->input.file);
}

static void
check_convergence(struct tool *t, const struct rc_grid *g)
{
    if (!map_says(g, "converged", "no"))
        return;
    if (!t->input.warned_short)
        tool_warn(t,
                  map_says(g, "separated", "yes")
                      ? "%s: the bodies have separated (separated=yes), because no state carries "
                        "the asked load: force and pressure are 0"
                      : "%s: this solution stopped short of its accuracy (converged=no): results "
                        "from it are no more accurate",
                  tool_where(t, g));
    t->input.warned_short = true;
    tool_fails_with(t, EXIT_SHORT);
}

/* Ends the tool at a key whose value no tool would understand. */
static void
check_keys(struct tool *t, const struct rc_grid *g)
{
    if (!t->info->mends && rc_keys_check(g, &t->err) != RC_OK)
        tool_refuse(t, g, "%s: correct it with rc-pick --set", t->err.text);
}

/* An error that a program before this one in the pipe has reported is not reported again. */
static _Noreturn void
cannot_read(struct tool *t, size_t frame, const struct rc_err *err)
{
    int status;
    const char *failure = rc_reader_failure(t->input.reader, &status), *head, *remedy;
    char text[1024];

    if (failure != NULL && pipe_is(fileno(t->input.file)))
        fail_as_before(t, failure, status);
    if (rc_reader_foreign(t->input.reader, &head) && head != NULL && t->info->foreign != NULL &&
        (remedy = t->info->foreign(head)) != NULL)
        tool_die(t, "%s is not a grid stream: %s", t->input.source, remedy);
    if (rc_reader_foreign(t->input.reader, &head) && head != NULL)
        tool_die(t, "%s",
                 foreign_message(text, sizeof text, t->info->name,
                                 t->input.file == stdin ? "-" : t->input.source, head));
    if (rc_reader_foreign(t->input.reader, &head))
        tool_die(t, "%s is empty, the stream stops before it begins: %s", t->input.source,
                 pipe_is(fileno(t->input.file))
                     ? "the program before this one in the pipe wrote no output"
                     : "make it again");
    tool_die(t, "%s, frame %zu: %s", t->input.source, frame, err->text);
}

struct not_finite
not_finite_in(enum rc_type type, const double *v, size_t n)
{
    const double most = type == RC_F32 ? (double)FLT_MAX : DBL_MAX;
    struct not_finite found = {0, 0};
    size_t outside = 0; /* the compiler vectorises an integer count */

    for (size_t k = 0; k < n; k++) /* most frames have none */
        outside += fabs(v[k]) <= most ? 0 : 1;
    for (size_t k = 0; outside > 0 && k < n; k++) {
        found.missing += isnan(v[k]) ? 1 : 0;
        found.infinite += fabs(v[k]) > most ? 1 : 0;
    }
    return found;
}

struct not_finite
not_finite(const struct tool *t, const struct rc_grid *g)
{
    struct not_finite n = not_finite_in(g->type, g->v, rc_grid_nodes(g));

    n.missing = (size_t)ranks_sum(t, (double)n.missing);
    n.infinite = (size_t)ranks_sum(t, (double)n.infinite);
    return n;
}

static void
note_not_finite(struct tool *t, const struct rc_grid *g)
{
    struct not_finite n;

    if (t->input.missing && t->input.infinite)
        return;
    n = not_finite(t, g);
    t->input.missing |= n.missing > 0;
    t->input.infinite |= n.infinite > 0;
}

/* ---- row by row ---- */

enum {
    TOGETHER = 1 << 16 /* values that are read or written together */
};

void
tool_by_rows(struct tool *t)
{
    t->input.by_rows = true;
}

size_t
tool_rows_together(size_t nx)
{
    return nx < TOGETHER ? TOGETHER / nx : 1;
}

size_t
tool_rows_left(const struct tool *t)
{
    return t->input.reader == NULL ? 0 : rc_reader_left(t->input.reader);
}

void
tool_read_rows(struct tool *t, size_t n, double *v)
{
    const size_t values = n * t->input.row;
    struct not_finite found;
    struct rc_err err;

    if (rc_reader_rows(t->input.reader, n, v, &err) != RC_OK)
        cannot_read(t, t->input.frame, &err);
    found = not_finite_in(t->input.type, v, values);
    t->input.missing |= found.missing > 0;
    t->input.infinite |= found.infinite > 0;
    for (size_t k = 0; found.infinite > 0 && k < values; k++)
        if (isinf(v[k]) && t->input.infinite_count++ == 0)
            t->input.infinite_first = t->input.read + k;
    t->input.read += values;
}

void
tool_skip_rows(struct tool *t, size_t n)
{
    const size_t together = tool_rows_together(t->input.row);
    RC_OWNED double *v = NULL;

    if (n > 0)
        v = tool_room(t, together * t->input.row, sizeof *v, "some rows of a map");
    for (size_t m; n > 0; n -= m) {
        m = n < together ? n : together;
        tool_read_rows(t, m, v);
    }
}

bool
tool_reads_file(const struct tool *t)
{
    struct stat st;

    return fstat(fileno(t->input.file), &st) == 0 && S_ISREG(st.st_mode);
}

void
tool_read_again(struct tool *t)
{
    struct rc_err err;

    if (rc_reader_again(t->input.reader, &err) != RC_OK)
        cannot_read(t, t->input.frame, &err);
    t->input.read = t->input.infinite_count = 0;
}

void
tool_load(struct tool *t, struct rc_grid *g)
{
    const struct rc_shape shape = rc_grid_shape(g);
    RC_OWN(rc_grid, whole) = NULL;
    struct rc_err err;
    double *none = g->v;

    if (tool_has_values(g))
        return;
    if (allow(t, &shape, g->nx * g->ny * sizeof *g->v, &err) != RC_OK ||
        (whole = rc_grid_new(&shape, g->channel, g->unit, &err)) == NULL)
        cannot_read(t, t->input.frame, &err);
    tool_read_rows(t, g->ny, whole->v);
    g->v = whole->v;
    g->elsewhere = 0;
    whole->v = none;
}

/* ---- frame by frame ---- */

/* Reads the header of the next frame of the open input to `ahead`. False at the end of the input, which is
 * then closed. */
static bool
look_ahead(struct tool *t)
{
    struct rc_err err;

    if (t->input.ahead != NULL || t->input.reader == NULL)
        return t->input.ahead != NULL;
    if (t->input.by_rows && t->input.frame > 0)
        tool_skip_rows(t, tool_rows_left(t));
    switch (rc_reader_head(t->input.reader, &t->input.ahead, &err)) {
    case RC_MORE:
        return true;
    case RC_OK:
        close_input(t);
        return false;
    default:
        cannot_read(t, t->input.frame + 1, &err);
    }
}

/* Reads the values of the frame `ahead`. */
static struct rc_grid *
take_ahead(struct tool *t)
{
    struct rc_grid *g = t->input.ahead;
    struct rc_err err;

    t->input.ahead = NULL;
    t->input.type = g->type;
    t->input.row = g->nx;
    t->input.read = t->input.infinite_count = 0;
    if (!t->input.by_rows && rc_reader_values(t->input.reader, g, &err) != RC_OK)
        cannot_read(t, t->input.frame + 1, &err);
    t->input.frame++;
    check_keys(t, g);
    check_convergence(t, g);
    note_not_finite(t, g);
    return g;
}

struct rc_grid *
tool_read(struct tool *t)
{
    size_t inputs = t->operands == 0 ? 1 : t->operands;

    while (!look_ahead(t)) {
        if (t->input.next == inputs)
            return NULL;
        open_next(t);
    }
    return take_ahead(t);
}

static void
end_case(struct tool *t, const char *channel)
{
    if (t->current.number != 0 && t->current.found == 0)
        tool_die(t, "%s, case %zu: no frame with the channel %s, only %s%s", t->current.source,
                 t->current.number, channel, t->current.names,
                 strcmp(channel, "pressure") == 0 && strstr(t->current.names, "height") != NULL
                     ? ": rc-solve finds the pressure of heights under a load"
                 : strcmp(channel, "dissipation") == 0
                     ? ": rc-slip writes it with --output pressure,dissipation"
                 : strcmp(channel, "heat") == 0 && strstr(t->current.names, "pressure") != NULL
                     ? ": the heat of sliding follows from the pressure and --mu, that of rolling "
                       "from --rolling and the frame dissipation of rc-slip --creep"
                     : "");
}

static void
begin_case(struct tool *t, size_t number)
{
    t->current.number = number;
    t->current.source = t->input.source;
    t->current.found = 0;
    t->current.names[0] = '\0';
}

/* Records that the case has this frame. */
static void
note_frame(struct tool *t, const struct rc_grid *g)
{
    size_t used = strlen(t->current.names);

    snprintf(t->current.names + used, sizeof t->current.names - used, "%s%s", used == 0 ? "" : " ",
             g->channel);
}

void
tool_keep_frame(struct tool *t, struct rc_grid *g, struct rc_grid **kept)
{
    if (*kept != NULL)
        tool_refuse(t, g,
                    "two '%s' frames in case %zu; give unrelated maps different numbers "
                    "(rc-pick --set case=2)",
                    g->channel, rc_grid_case(g));
    *kept = g;
}

void
tool_demand_lengths(struct tool *t, const struct rc_grid *g)
{
    if (strcmp(rc_grid_dunit(g), "m") != 0)
        tool_refuse(t, g, "its dx and dy are in %s (key dunit), but must be in m",
                    rc_grid_dunit(g));
}

void
tool_demand_grid_of(struct tool *t, const struct rc_grid *g, const struct rc_grid *of)
{
    if (g->nx != of->nx || g->ny != of->ny || fabs(g->dx / of->dx - 1) > RC_SAME_SPACING ||
        fabs(g->dy / of->dy - 1) > RC_SAME_SPACING)
        tool_refuse(t, g,
                    "%zu x %zu nodes %g x %g m apart, but %s has %zu x %zu nodes %g x %g m apart: "
                    "bring them to one grid with rc-pick --resample",
                    g->nx, g->ny, g->dx, g->dy, of->channel, of->nx, of->ny, of->dx, of->dy);
}

struct rc_grid *
tool_channel_with(struct tool *t, const char *channel, tool_take *take, void *ctx)
{
    struct rc_grid *g, *kept = NULL;

    if ((g = tool_read(t)) == NULL && t->current.number == 0)
        tool_die(t, "%s: the stream has no frame", t->input.source);
    if (g == NULL)
        return NULL;
    begin_case(t, rc_grid_case(g));
    for (;;) {
        note_frame(t, g);
        if (strcmp(g->channel, channel) == 0)
            tool_keep_frame(t, g, &kept);
        else if (!take(ctx, t, kept, g))
            rc_grid_free(g);
        if (!look_ahead(t) || rc_grid_case(t->input.ahead) != t->current.number)
            break;
        g = take_ahead(t);
    }
    t->current.found = kept != NULL;
    end_case(t, channel);
    tool_demand_lengths(t, kept);
    return kept;
}

bool
tool_take_frames(void *ctx, struct tool *t, const struct rc_grid *kept, struct rc_grid *g)
{
    const struct tool_frame *f = ctx;

    (void)kept;
    while (f->channel != NULL && strcmp(g->channel, f->channel) != 0)
        f++;
    if (f->channel != NULL)
        tool_keep_frame(t, g, f->frame);
    return f->channel != NULL;
}

void
tool_demand_full_sliding(struct tool *t, const struct rc_grid *g, const char *instead)
{
    static const char *const partial[] = {"traction-x", "traction-y",  "traction",
                                          "slip-x",     "slip-y",      "slip",
                                          "state",      "dissipation", NULL};
    char names[sizeof t->current.names], *at = NULL;

    memcpy(names, t->current.names, sizeof names);
    for (char *name = strtok_r(names, " ", &at); name != NULL; name = strtok_r(NULL, " ", &at))
        for (const char *const *p = partial; *p != NULL; p++)
            if (strcmp(name, *p) == 0)
                tool_refuse(
                    t, g,
                    "the case has friction of rc-slip, a frame %s, by which nodes may stick: "
                    "%s; where all nodes slide, take the frames of the contact alone by "
                    "rc-pick --channel",
                    name, instead);
}

void
tool_free_frames(const struct tool_frame *list)
{
    for (const struct tool_frame *f = list; f->channel != NULL; f++) {
        rc_grid_free(*f->frame);
        *f->frame = NULL;
    }
}

struct rc_grid *
tool_channel_beside(struct tool *t, const char *channel, const char *beside, struct rc_grid **other)
{
    struct tool_frame with[] = {{beside, other}, {NULL, NULL}};
    struct rc_grid *kept;

    *other = NULL;
    kept = tool_channel_with(t, channel, tool_take_frames, with);
    if (*other != NULL)
        tool_demand_grid_of(t, *other, kept);
    return kept;
}

struct rc_grid *
tool_channel(struct tool *t, const char *channel, bool pass)
{
    struct rc_grid *g;

    while ((g = tool_read(t)) != NULL) {
        size_t number = rc_grid_case(g);

        if (number != t->current.number) {
            end_case(t, channel);
            begin_case(t, number);
        }
        if (pass)
            results_demand_none(t, g);
        note_frame(t, g);
        if (strcmp(g->channel, channel) == 0) {
            if (t->current.found++ > 0)
                tool_refuse(t, g,
                            "two '%s' frames in case %zu; give unrelated maps different numbers "
                            "(rc-pick --set case=2)",
                            channel, number);
            tool_demand_lengths(t, g);
            return g;
        }
        if (pass && t->info->passing != NULL)
            t->info->passing(t, g);
        if (pass)
            tool_write(t, g);
        rc_grid_free(g);
    }
    end_case(t, channel);
    if (t->current.number == 0)
        tool_die(t, "%s: the stream has no frame", t->input.source);
    return NULL;
}

struct rc_grid *
tool_frame_of_file(struct tool *t, const char *option, const char *name, const char *channel)
{
    bool standard = strcmp(name, "-") == 0;
    FILE *file = standard ? stdin : fopen(name, "rb");
    const struct rc_share *share;
    struct rc_reader *reader;
    struct rc_grid *g = NULL;
    enum rc_status status;

    if (file == NULL)
        tool_die(t, "--%s %s: %s", option, name, strerror(errno));
    if ((reader = rc_reader_new(file, 0, t->memory, &t->err)) == NULL)
        tool_die(t, "--%s %s: %s", option, name, t->err.text);
    share = standard ? NULL : ranks_read(t, name);
    rc_reader_share(reader, share);
    do {
        rc_grid_free(g);
        status = rc_reader_next(reader, &g, &t->err);
    } while (status == RC_MORE && channel != NULL && strcmp(g->channel, channel) != 0);
    if (status == RC_FAIL)
        tool_die(t, "--%s %s: %s", option, name, t->err.text);
    if (g == NULL)
        tool_die(t, "--%s %s: no %s%sframe is in it", option, name, channel == NULL ? "" : channel,
                 channel == NULL ? "" : " ");
    if (rc_keys_check(g, &t->err) != RC_OK)
        tool_die(t, "--%s %s: %s: correct it with rc-pick --set", option, name, t->err.text);
    if (strcmp(rc_grid_dunit(g), "m") != 0)
        tool_die(t, "--%s %s: its dx and dy are in %s (key dunit), not in m", option, name,
                 rc_grid_dunit(g));
    rc_reader_free(reader);
    ranks_close(t, share);
    if (!standard)
        fclose(file);
    return g;
}

size_t
tool_first_row(const struct tool *t, const struct rc_grid *g)
{
    size_t first, n;

    ranks_rows(t, rc_shape_of(g), &first, &n);
    return first;
}

void
tool_demand_measured(struct tool *t, const struct rc_grid *g)
{
    size_t count = 0, first = 0;

    for (size_t k = rc_grid_nodes(g); k-- > 0;)
        if (isinf(g->v[k])) {
            count++;
            first = k;
        }
    if (!tool_has_values(g)) {
        count = t->input.infinite_count;
        first = t->input.infinite_first;
    }
    if (count > 0)
        tool_refuse(t, g,
                    "%zu heights are infinite, the first in column %zu of row %zu: a point without "
                    "a measurement is NaN",
                    count, first % g->nx, first / g->nx);
}

bool
tool_judge_slope(struct tool *t, const char *where, double slope, const char *remedy)
{
    static const double steep = 3; /* 72 degrees on average */

    if (slope > steep)
        tool_warn(t, "%s: the RMS slope is %.3g (%.0f degrees), which is implausible: %s", where,
                  slope, atan(slope) * 180 / 3.14159265358979323846, remedy);
    return slope > steep;
}

void
tool_demand_finite(struct tool *t, const struct rc_grid *g, const char *remedy)
{
    const size_t nodes = rc_grid_nodes(g);
    size_t count = 0, first = g->nx * g->ny, before = tool_first_row(t, g) * g->nx;

    for (size_t k = 0; k < nodes; k++)
        count += fabs(g->v[k]) <= DBL_MAX ? 0 : 1;
    for (size_t k = count > 0 ? nodes : 0; k-- > 0;)
        if (!isfinite(g->v[k]))
            first = before + k;
    count = (size_t)ranks_sum(t, (double)count);
    first = (size_t)-ranks_most(t, -(double)first);
    tool_demand_none(t, g, count, first, remedy);
}

void
tool_demand_none(struct tool *t, const struct rc_grid *g, size_t count, size_t first,
                 const char *remedy)
{
    if (count > 0)
        tool_refuse(t, g,
                    "%zu of %zu values are NaN or infinite, the first in column %zu of row %zu: %s",
                    count, g->nx * g->ny, first % g->nx, first / g->nx, remedy);
}
