/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The line of a tool in the history of a stream: its name, the version, and the options that change the
 * result.
 */
#include "tool.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/contact.h"
#include "parts.h"

struct line {
    struct tool *tool;
    char *text;
    size_t n, size;
    char between; /* separator of single words; 0: the blank at the beginning of `a` */
};

/* Lists of loads and paths may be long: the buffer grows with them. */
static void
add(struct line *line, const char *a, const char *b)
{
    size_t more = strlen(a) + strlen(b);

    if (line->size - line->n <= more) {
        size_t size = 2 * (line->n + more + 1);
        char *text = realloc(line->text, size);
        if (text == NULL)
            tool_die(line->tool, "out of memory for %zu bytes of history", size);
        line->text = text;
        line->size = size;
    }
    snprintf(line->text + line->n, line->size - line->n, "%s%s", a, b);
    if (a[0] == ' ')
        line->text[line->n] = line->between;
    line->n += more;
}

static void
add_words(struct line *line, const struct opt *o, size_t set)
{
    const char *word, *before = " ";
    char text[64];
    size_t n;

    for (size_t k = 0; (word = option_word(o, k, &n)) != NULL; k++)
        if (set >> k & 1) {
            snprintf(text, sizeof text, "%.*s", (int)n, word);
            add(line, before, text);
            before = ",";
        }
}

static void
add_numbers(struct line *line, const struct opt *o, const struct numbers *list)
{
    if (list->n == 0)
        add(line, " ", o->word);
    for (size_t k = 0; k < list->n; k++) {
        add(line, k == 0 ? " " : ",", rc_number(list->v[k]));
        add(line, list->per_metre ? "N/m" : "", "");
    }
}

static void
add_value(struct line *line, const struct opt *o, const void *at)
{
    char text[RC_NUMBER_SIZE];

    if (o->type == OPT_NUMBER) {
        double value = *(const double *)at;
        if (o->optional && isnan(value))
            return; /* the option is written without its number */
        add(line, " ", o->word != NULL && isinf(value) ? o->word : rc_number_text(text, value));
    } else if (o->type == OPT_COUNT) {
        snprintf(text, sizeof text, "%zu", *(const size_t *)at);
        add(line, " ", text);
    } else if (o->type == OPT_TEXT || o->type == OPT_CHOICE) {
        const char *word = *(const char *const *)at;
        add(line, *word == '\0' ? "" : " ", word);
    } else if (o->type == OPT_WORDS) {
        add_words(line, o, *(const size_t *)at);
    } else if (o->type == OPT_NUMBERS) {
        add_numbers(line, o, at);
    }
}

static void
add_steps(struct line *line, const struct steps *steps)
{
    for (size_t k = 0; k < steps->n; k++) {
        add(line, " --", steps->step[k].opt->name);
        if (steps->step[k].opt->optional && steps->step[k].text == NULL)
            continue;
        if (steps->step[k].opt->type == OPT_TEXTS ||
            (steps->step[k].opt->arg != NULL && strchr(steps->step[k].opt->arg, '|') != NULL))
            add(line, " ", steps->step[k].text);
        else if (steps->step[k].opt->arg != NULL)
            add(line, " ", rc_number(steps->step[k].value));
    }
}

/* True if the option was given and changes the result. */
static bool
is_told(const struct tool *t, size_t k)
{
    return t->option.given[k] && t->option.row[k].result;
}

/* Adds an option with its value. All steps are in one list, in the order of the line. */
static void
add_option(struct line *line, const struct tool *t, const struct opt *o)
{
    const void *at = tool_value(t, o);

    if (o->type == OPT_STEP || o->type == OPT_TEXTS) {
        add_steps(line, at);
        return;
    }
    add(line, " --", o->name);
    add_value(line, o, at);
}

static void
fill(struct tool *t, struct line *line)
{
    bool steps_done = false;

    line->tool = t;
    line->n = 0;
    add(line, t->info->name, "");
    add(line, " ", rc_version());
    for (size_t k = 0; k < t->option.n; k++) {
        const struct opt *o = &t->option.row[k];
        const bool step = o->type == OPT_STEP || o->type == OPT_TEXTS;
        if (is_told(t, k) && !(step && steps_done))
            add_option(line, t, o);
        steps_done = steps_done || (step && is_told(t, k));
    }
}

const char *
tool_history(struct tool *t)
{
    static struct line line = {.between = ' '};

    fill(t, &line);
    return line.text;
}

const char *
tool_result_value(struct tool *t, size_t k)
{
    static struct line line = {.between = ' '};
    const struct opt *o = &t->option.row[k];
    const size_t name = strlen(" --") + strlen(o->name);

    if (!is_told(t, k))
        return "";
    line.tool = t;
    line.n = 0;
    add_option(&line, t, o);
    return line.n > name ? line.text + name + 1 : "yes";
}

size_t
tool_result_words(struct tool *t, const char *word[], size_t most)
{
    static struct line line = {.between = '\0'};
    size_t n = 0;

    fill(t, &line);
    for (size_t at = 0, k = 0; at < line.n; at += strlen(line.text + at) + 1, k++)
        if (k >= 2 && n < most) /* name and version come before */
            word[n++] = line.text + at;
    return n;
}

bool
tool_history_has(const struct rc_grid *g, const char *name, const char *text)
{
    const char *last = NULL, *found;

    for (const char *s = rc_grid_get(g, "history"); s != NULL && (s = strstr(s, name)) != NULL; s++)
        last = s;
    found = last == NULL ? NULL : strstr(last, text);
    return found != NULL && memchr(last, '|', (size_t)(found - last)) == NULL;
}
