/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Output of a tool for people: messages, progress, and the message when it cannot continue.
 */
#include "tool.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "formats/core/core.h"
#include "parts.h"
#include "ranks.h"

/* Writes the text of a function with a format and further arguments. */
#define WRITE(text, format)                                                                        \
    do {                                                                                           \
        va_list ap;                                                                                \
        va_start(ap, format);                                                                      \
        vsnprintf(text, sizeof text, format, ap);                                                  \
        va_end(ap);                                                                                \
    } while (0)

/* Replaces control characters: messages contain names, keys and words of files, which must not act on a
 * terminal. */
static void
say(struct tool *t, char *text)
{
    if (!ranks_speak(t)) /* the first of several processes prints the message */
        return;
    tool_progress_end(t);
    fprintf(stderr, "%s: %s\n", t->info->name, rc_text_harmless(text, '?'));
}

/* The text of a warning without the name of the input, which may stand before it. */
static const char *
without_source(const struct tool *t, const char *text)
{
    size_t n = strlen(t->input.source);

    return strncmp(text, t->input.source, n) == 0 && text[n] == ':' ? text + n + 2 : text;
}

/* True if the words of a format say which warning it is; "%s: %s" has any. */
static bool
has_words(const char *format)
{
    size_t letters = 0;

    for (; *format != '\0'; format++)
        letters += (*format >= 'a' && *format <= 'z') != 0;
    return letters > 12;
}

/* True if this kind of warning was printed about another input; counts it. */
static bool
is_repeated(struct tool *t, const char *format, const char *text)
{
    const char *kind = has_words(format) ? "" : without_source(t, text);
    struct repeat *r = t->repeats.kind;
    size_t k = 0;

    if (t->verbose || t->operands < 2 || t->input.source == NULL)
        return false;
    while (k < t->repeats.n &&
           (r[k].format != format || strncmp(r[k].text, kind, sizeof r[k].text - 1) != 0))
        k++;
    if (k < t->repeats.n) {
        if (strcmp(r[k].source, t->input.source) == 0)
            return false;
        r[k].others += strcmp(r[k].last, t->input.source) != 0;
        r[k].last = t->input.source;
        return true;
    }
    if (k == WARNING_KINDS)
        return false;
    r[k] = (struct repeat){.format = format, .source = t->input.source, .last = t->input.source};
    snprintf(r[k].text, sizeof r[k].text, "%.*s", WARNING_TEXT - 1, kind);
    snprintf(r[k].first, sizeof r[k].first, "%.*s", WARNING_TEXT - 1, without_source(t, text));
    t->repeats.n++;
    return false;
}

void
tool_warn(struct tool *t, const char *format, ...)
{
    char text[1024];

    if (t->quiet)
        return;
    WRITE(text, format);
    if (!is_repeated(t, format, text))
        say(t, text);
}

void
tool_warn_first(struct tool *t, const char *what, const char *format, ...)
{
    char text[1024];
    size_t k = 0;

    while (k < t->firsts.n && strcmp(t->firsts.what[k], what) != 0)
        k++;
    if (k < t->firsts.n && !t->verbose) {
        t->firsts.others[k]++;
        return;
    }
    if (k == t->firsts.n && k < WARNING_KINDS)
        t->firsts.what[t->firsts.n++] = what;
    WRITE(text, format);
    tool_warn(t, "%s", text);
}

void
tool_count_warnings(struct tool *t)
{
    for (size_t k = 0; k < t->firsts.n; k++)
        if (t->firsts.others[k] > 0)
            tool_warn(t, "%zu other case%s too: %s", t->firsts.others[k],
                      t->firsts.others[k] == 1 ? "" : "s", t->firsts.what[k]);
    t->firsts.n = 0;
    for (size_t k = 0; k < t->repeats.n; k++) {
        const struct repeat *r = &t->repeats.kind[k];
        char text[2 * WARNING_TEXT];
        const size_t others = r->others;

        if (others == 0)
            continue;
        snprintf(text, sizeof text, "%zu other input%s cause%s the same warning as %s: %.100s%s",
                 others, others == 1 ? "" : "s", others == 1 ? "s" : "", r->source, r->first,
                 strlen(r->first) > 100 ? "..." : "");
        say(t, text);
    }
    t->repeats.n = 0;
}

void
tool_fail(struct tool *t, const char *format, ...)
{
    char text[1024];

    WRITE(text, format);
    tool_add_refusal(t, NULL, text, sizeof text);
    say(t, text);
    tool_fails_with(t, EXIT_IMPOSSIBLE);
}

void
tool_note(struct tool *t, const char *format, ...)
{
    char text[1024];

    if (!t->verbose)
        return;
    WRITE(text, format);
    say(t, text);
}

void
tool_tell(struct tool *t, const char *format, ...)
{
    char text[1024];

    if (t->quiet || !(t->verbose || isatty(STDERR_FILENO)))
        return;
    WRITE(text, format);
    say(t, text);
}

/* Prints progress for programs, which recognise the line by its first key. */
static void
put_progress(const struct tool *t, double done, const char *text)
{
    struct json json;

    json_open(&json, stderr);
    json_number(&json, "progress", done);
    json_text(&json, "tool", t->info->name);
    json_text(&json, "text", text);
    json_close(&json);
}

void
tool_progress(struct tool *t, double done, const char *format, ...)
{
    bool terminal = isatty(STDERR_FILENO);
    char text[512];

    if (t->quiet || !ranks_speak(t) || !(terminal || t->progress != NULL) ||
        tool_now() - t->line.at < 0.1)
        return;
    t->line.at = tool_now();
    WRITE(text, format);
    if (t->progress != NULL && strcmp(t->progress, "json") == 0) {
        put_progress(t, done, text);
        return;
    }
    fprintf(stderr, terminal ? "\r\033[K%s: %s" : "%s: %s\n", t->info->name, text);
    fflush(stderr);
    t->line.shown = terminal;
}

void
tool_progress_end(struct tool *t)
{
    if (t->line.shown)
        fputs("\r\033[K", stderr);
    t->line.shown = false;
}

static void
last_words(struct tool *t, int status, const char *text)
{
    char whole[1500];

    tool_progress_end(t);
    fprintf(stderr, "%s: %s\n", t->info->name, text);
    snprintf(whole, sizeof whole, "%s: %s", t->info->name, text);
    output_abandon(t, whole, status);
}

static _Noreturn void
die(struct tool *t, int status, char *text)
{
    rc_text_harmless(text, '?');
    tool_count_warnings(t);
    if (t->ranks != NULL)
        ranks_die(t, status, text, last_words);
    last_words(t, status, text);
    exit(status);
}

void
fail_as_before(struct tool *t, const char *message, int status)
{
    tool_note(t, "%s: the program that wrote it failed: %s", t->input.source, message);
    tool_progress_end(t);
    output_abandon(t, message, status);
    exit(status);
}

const char *
tool_where_to(const struct tool *t, const struct rc_grid *g, char text[WHERE])
{
    const char *source = g == NULL ? NULL : rc_grid_get(g, "source");

    if (source == NULL)
        source = t->input.source == NULL ? "standard input" : t->input.source;
    if (g == NULL)
        snprintf(text, WHERE, "%s", source);
    else
        snprintf(text, WHERE, "%s, case %zu, frame %zu (%s)", source, rc_grid_case(g),
                 t->input.frame, g->channel);
    return rc_text_harmless(text, '?');
}

void
tool_die_at(struct tool *t, const struct rc_grid *g, int status, const char *format, ...)
{
    char text[1024], whole[1400];

    WRITE(text, format);
    tool_add_refusal(t, g, text, sizeof text);
    snprintf(whole, sizeof whole, "%s%s%s", g == NULL ? "" : tool_where(t, g),
             g == NULL ? "" : ": ", text);
    die(t, status, whole);
}

void
tool_must(struct tool *t, const struct rc_grid *g, enum rc_status status)
{
    if (status != RC_OK)
        tool_refuse(t, g, "%s", t->err.text);
}

void *
tool_made(struct tool *t, const struct rc_grid *g, void *made)
{
    tool_must(t, g, made == NULL ? RC_FAIL : RC_OK);
    return made;
}

/* ---- frames and their keys ---- */

bool
map_says(const struct rc_grid *g, const char *key, const char *value)
{
    const char *own = rc_grid_get(g, key);

    return own != NULL && strcmp(own, value) == 0;
}

struct rc_grid *
tool_frame_like(struct tool *t, const struct rc_grid *like, const struct rc_shape *shape,
                const char *channel, const char *unit)
{
    struct rc_grid as = *like;
    size_t first, rows;

    if (shape != NULL) {
        as.nx = shape->nx;
        as.ny = shape->ny;
        ranks_rows(t, shape, &first, &rows);
        as.elsewhere = shape->ny - rows;
        as.dx = shape->dx;
        as.dy = shape->dy;
    }
    return tool_made(t, like, rc_grid_like(&as, channel, unit, &t->err));
}

void
tool_set(struct tool *t, struct rc_grid *g, const char *name, const char *value)
{
    tool_must(t, g, rc_grid_set(g, name, value, &t->err));
}

void
tool_set_number(struct tool *t, struct rc_grid *g, const char *name, double value)
{
    tool_set(t, g, name, isfinite(value) ? rc_number(value) : NULL);
}

void
tool_set_error(struct tool *t, struct rc_grid *g, const char *name, double value)
{
    char text[RC_NUMBER_SIZE];

    snprintf(text, sizeof text, "%.2e", 1.005 * value); /* half a unit of the last digit more */
    tool_set(t, g, name, isfinite(value) ? text : NULL);
}

void
tool_set_numbers(struct tool *t, struct rc_grid *g, const char *name, const double *v, size_t n)
{
    size_t size = n * RC_NUMBER_SIZE + 1, at = 0;
    RC_OWNED char *text = tool_room(t, size, 1, name);

    for (size_t k = 0; k < n; k++)
        at += (size_t)snprintf(text + at, size - at, "%s%s", k == 0 ? "" : ",", rc_number(v[k]));
    tool_set(t, g, name, text);
}

void
tool_sign(struct tool *t, struct rc_grid *g)
{
    tool_must(t, g, rc_grid_history(g, tool_history(t), &t->err));
}

/* ---- memory that must be there ---- */

static void *
demand(struct tool *t, void *v, const char *what)
{
    if (v == NULL)
        tool_die(t, "out of memory for %s", what);
    return v;
}

void *
tool_room(struct tool *t, size_t n, size_t size, const char *what)
{
    return demand(t, calloc(n > 0 ? n : 1, size), what);
}

void *
tool_grown(struct tool *t, void *v, size_t n, size_t *room, size_t size, const char *what)
{
    if (n < *room)
        return v;
    *room = *room == 0 ? 64 : 2 * *room;
    return demand(t, realloc(v, *room * size), what);
}

char *
tool_copy(struct tool *t, const char *text)
{
    return demand(t, strdup(text), "a text");
}
