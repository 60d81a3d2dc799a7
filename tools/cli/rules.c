/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Rules between options, from the option tables: .one_of, .needs and .against. They are checked here when the
 * command line has been read, and printed in --help and for programs.
 */
#include "parts.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

enum {
    TEXT = 1024, /* most bytes of the rules of an option, as text */
};

/* One option of a list like "speed|tilt free": its row, and the word, whose length is 0 without one. */
struct named {
    const struct opt *opt;
    const char *word;
    size_t n;
};

/* The next option of the list; NULL at its end. */
static const char *
next_named(const struct tool *t, const char *list, struct named *found)
{
    size_t length = strcspn(list, "|"), name = strcspn(list, " |");

    if (*list == '\0')
        return NULL;
    *found = (struct named){.word = list + name + (list[name] == ' ')};
    found->n = length - (size_t)(found->word - list);
    for (size_t k = 0; k < t->option.n; k++)
        if (strlen(t->option.row[k].name) == name &&
            strncmp(t->option.row[k].name, list, name) == 0)
            found->opt = &t->option.row[k];
    assert(found->opt != NULL);
    return list + length + (list[length] == '|');
}

static bool
same_word(const char *text, const char *word, size_t n)
{
    return text != NULL && strncmp(text, word, n) == 0 && (text[n] == '\0' || text[n] == ':');
}

static bool
is_given(const struct tool *t, const struct opt *o)
{
    return t->option.given[o - t->option.row];
}

/* True if the option has this value, which may be its default; n = 0: if it is given. */
static bool
has_word(const struct tool *t, const struct opt *o, const char *word, size_t n)
{
    const void *at = tool_value(t, o);

    if (n == 0)
        return is_given(t, o);
    switch (o->type) {
    case OPT_NUMBER:
        return same_word(o->word, word, n) ? isinf(*(const double *)at)
                                           : isfinite(*(const double *)at);
    case OPT_NUMBERS:
        return same_word(o->word, word, n) ? ((const struct numbers *)at)->n == 0
                                           : ((const struct numbers *)at)->n > 1;
    case OPT_WORDS:
        return *(const size_t *)at >> option_word_index(o, word, n) & 1;
    default:
        return same_word(*(const char *const *)at, word, n);
    }
}

/* The word of the list "x|y" that the option has: its length and start; the empty word for no list, NULL if
 * the option is not given or has none of them. */
static const char *
applies(const struct tool *t, const struct opt *o, const char *words, size_t *n)
{
    if (words == NULL)
        words = "";
    do {
        *n = strcspn(words, "|");
        if (is_given(t, o) && has_word(t, o, words, *n))
            return words;
        words += *n + (words[*n] == '|');
    } while (*words != '\0');
    return NULL;
}

/* ---- as text ---- */

struct text {
    char s[TEXT];
    size_t n;
};

static void __attribute__((format(printf, 2, 3))) add(struct text *to, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    vsnprintf(to->s + to->n, sizeof to->s - to->n, format, args);
    va_end(args);
    to->n += strlen(to->s + to->n);
}

/* "--tilt free" */
static void
add_option(struct text *to, const struct opt *o, const char *word, size_t n)
{
    add(to, "%s%s%s%.*s", o->name[1] == '\0' ? "-" : "--", o->name, n > 0 ? " " : "", (int)n, word);
}

/* "--creep, --tilt free or --speed": `last` stands before the last one. */
static void
add_options(struct text *to, const struct tool *t, const char *list, const char *last)
{
    struct named one;

    for (const char *next, *between = ""; (next = next_named(t, list, &one)) != NULL; list = next) {
        add(to, "%s", between);
        add_option(to, one.opt, one.word, one.n);
        between = strchr(next, '|') == NULL ? last : ", ";
    }
}

/* "give one of --load and --approach", or "give --mu" */
static void
add_one_of(struct text *to, const struct tool *t, const char *list)
{
    add(to, strchr(list, '|') == NULL ? "give " : "give one of ");
    add_options(to, t, list, " and ");
}

/* "with residual or strain: ", or nothing for a rule without words. */
static void
add_words(struct text *to, const char *words)
{
    size_t n;

    if (words == NULL)
        return;
    for (const char *s = words; *s != '\0'; s += n + (s[n] == '|')) {
        n = strcspn(s, "|");
        add(to, "%s%.*s", s == words ? "with " : s[n] == '\0' ? " or " : ", ", (int)n, s);
    }
    add(to, ": ");
}

static bool
same_words(const char *a, const char *b)
{
    return a == b || (a != NULL && b != NULL && strcmp(a, b) == 0);
}

static bool
is_rule(const struct opt_rule *r)
{
    return r != NULL && r->with != NULL;
}

const char *
rules_text(const struct tool *t, const struct opt *o)
{
    static struct text text;

    text.n = 0;
    text.s[0] = '\0';
    for (const struct opt_rule *r = o->one_of; is_rule(r); r++) {
        add(&text, text.n == 0 ? "" : "; ");
        if (strchr(r->with, '|') == NULL)
            add(&text, "required");
        else
            add_one_of(&text, t, r->with);
    }
    for (const struct opt_rule *r = o->needs; is_rule(r); r++) {
        add(&text, text.n == 0 ? "" : "; ");
        add_words(&text, r->word);
        add(&text, "needs ");
        add_options(&text, t, r->with, " or ");
    }
    for (const struct opt_rule *r = o->against; is_rule(r); r++) {
        if (r > o->against && same_words(r->word, r[-1].word)) {
            add(&text, ", ");
        } else {
            add(&text, text.n == 0 ? "" : "; ");
            add_words(&text, r->word);
            add(&text, "not with ");
        }
        add_options(&text, t, r->with, ", ");
    }
    return text.s;
}

/* ---- as JSON ---- */

static void
json_rules(struct json *json, const struct tool *t, const char *name, const struct opt_rule *r)
{
    struct named one;
    char word[64];

    json_begin(json, name, ']');
    for (; is_rule(r); r++) {
        json_begin(json, NULL, '}');
        option_json_list(json, "words", r->word == NULL ? "" : r->word);
        json_begin(json, "options", ']');
        for (const char *list = r->with, *next; (next = next_named(t, list, &one)) != NULL;
             list = next) {
            snprintf(word, sizeof word, "%.*s", (int)one.n, one.word);
            json_begin(json, NULL, '}');
            json_text(json, "name", one.opt->name);
            json_text(json, "word", one.n == 0 ? NULL : word);
            json_end(json, '}');
        }
        json_end(json, ']');
        json_text(json, "because", r->because);
        json_text(json, "remedy", r->remedy);
        json_end(json, '}');
    }
    json_end(json, ']');
}

void
rules_json(struct json *json, const struct tool *t, const struct opt *o)
{
    json_rules(json, t, "one_of", o->one_of);
    json_rules(json, t, "needs", o->needs);
    json_rules(json, t, "against", o->against);
    json_text(json, "rules", rules_text(t, o));
}

/* ---- the command line ---- */

/* Ends the tool with "WHAT, because WHY: WHAT TO DO". */
static _Noreturn void
refuse(struct tool *t, const struct text *what, const struct opt_rule *r, const char *remedy)
{
    tool_usage(t, "%s%s%s%s%s", what->s, r->because == NULL ? "" : ", because ",
               r->because == NULL ? "" : r->because, remedy == NULL ? "" : ": ",
               remedy == NULL ? "" : remedy);
}

/* How many options of the list are given, or have the word by default too. */
static size_t
count_met(const struct tool *t, const char *list, bool defaults, struct named *last)
{
    struct named one;
    size_t count = 0;

    for (; (list = next_named(t, list, &one)) != NULL;)
        if ((defaults || is_given(t, one.opt)) && has_word(t, one.opt, one.word, one.n)) {
            *last = one;
            count++;
        }
    return count;
}

static void
check_against(struct tool *t, const struct opt *o)
{
    struct text text = {.n = 0};
    struct named other;
    const char *word;
    size_t n;

    for (const struct opt_rule *r = o->against; is_rule(r); r++)
        if ((word = applies(t, o, r->word, &n)) != NULL &&
            count_met(t, r->with, false, &other) > 0) {
            add_option(&text, o, word, n);
            add(&text, " does not work with ");
            add_option(&text, other.opt, other.word, other.n);
            refuse(t, &text, r, r->remedy == NULL ? "leave out one of them" : r->remedy);
        }
}

static void
check_needs(struct tool *t, const struct opt *o)
{
    struct text text = {.n = 0};
    struct named other;
    const char *word;
    size_t n;

    for (const struct opt_rule *r = o->needs; is_rule(r); r++)
        if ((word = applies(t, o, r->word, &n)) != NULL &&
            count_met(t, r->with, true, &other) == 0) {
            add_option(&text, o, word, n);
            add(&text, " has no effect without ");
            add_options(&text, t, r->with, " or ");
            refuse(t, &text, r, r->remedy);
        }
}

static void
check_one_of(struct tool *t, const struct opt *o)
{
    struct text text = {.n = 0};
    struct named other;

    for (const struct opt_rule *r = o->one_of; is_rule(r); r++)
        if (count_met(t, r->with, false, &other) != 1) {
            add_one_of(&text, t, r->with);
            tool_usage(t, "%s%s%s", text.s, r->remedy == NULL ? "" : ", ",
                       r->remedy == NULL ? "" : r->remedy);
        }
}

void
rules_check(struct tool *t)
{
    static void (*const check[])(struct tool * t,
                                 const struct opt *o) = {check_against, check_needs, check_one_of};

    for (size_t i = 0; i < sizeof check / sizeof *check; i++)
        for (size_t k = 0; k < t->option.n; k++)
            check[i](t, &t->option.row[k]);
}
