/*
 * Rules between options, from the option tables: .one_of, .needs and .against. They are checked here when the
 * command line has been read, and printed in --help and for programs.
 */
#include "parts.h"

#include <assert.h>
#include <math.h>
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

static char *
add_part(char *end, const char *limit, const char *text, size_t n)
{
    if (n > (size_t)(limit - end) - 1)
        n = (size_t)(limit - end) - 1;
    memcpy(end, text, n);
    end[n] = '\0';
    return end + n;
}

static char *
add(char *end, const char *limit, const char *text)
{
    return add_part(end, limit, text, strlen(text));
}

/* "--tilt free" */
static char *
add_option(char *end, const char *limit, const struct opt *o, const char *word, size_t n)
{
    end = add(end, limit, o->name[1] == '\0' ? "-" : "--");
    end = add(end, limit, o->name);
    end = add(end, limit, n > 0 ? " " : "");
    return add_part(end, limit, word, n);
}

/* "--creep, --tilt free or --speed": `last` stands before the last one. */
static char *
add_options(char *end, const char *limit, const struct tool *t, const char *list, const char *last)
{
    struct named one;
    const char *between = "", *next;

    for (; (next = next_named(t, list, &one)) != NULL; list = next) {
        end = add(end, limit, between);
        end = add_option(end, limit, one.opt, one.word, one.n);
        between = strchr(next, '|') == NULL ? last : ", ";
    }
    return end;
}

/* "with residual or strain: ", or nothing for a rule without words. */
static char *
add_words(char *end, const char *limit, const char *words)
{
    size_t n;

    for (const char *s = words; s != NULL && *s != '\0'; s += n + (s[n] == '|')) {
        n = strcspn(s, "|");
        end = add(end, limit, s == words ? "with " : s[n] == '\0' ? " or " : ", ");
        end = add_part(end, limit, s, n);
    }
    return add(end, limit, words == NULL ? "" : ": ");
}

static bool
same_words(const char *a, const char *b)
{
    return a == b || (a != NULL && b != NULL && strcmp(a, b) == 0);
}

const char *
rules_text(const struct tool *t, const struct opt *o)
{
    static char text[TEXT];
    const char *const limit = text + sizeof text;
    char *end = text;

    *end = '\0';
    for (const struct opt_rule *r = o->one_of; r != NULL && r->with != NULL; r++) {
        end = add(end, limit, end == text ? "" : "; ");
        if (strchr(r->with, '|') == NULL) {
            end = add(end, limit, "required");
        } else {
            end = add(end, limit, "give one of ");
            end = add_options(end, limit, t, r->with, " and ");
        }
    }
    for (const struct opt_rule *r = o->needs; r != NULL && r->with != NULL; r++) {
        end = add(end, limit, end == text ? "" : "; ");
        end = add_words(end, limit, r->word);
        end = add(end, limit, "needs ");
        end = add_options(end, limit, t, r->with, " or ");
    }
    for (const struct opt_rule *r = o->against; r != NULL && r->with != NULL; r++) {
        if (r > o->against && same_words(r->word, r[-1].word)) {
            end = add(end, limit, ", ");
        } else {
            end = add(end, limit, end == text ? "" : "; ");
            end = add_words(end, limit, r->word);
            end = add(end, limit, "not with ");
        }
        end = add_options(end, limit, t, r->with, ", ");
    }
    return text;
}

/* ---- as JSON ---- */

static void
json_words_of(struct json *json, const char *words)
{
    char text[64];
    size_t n;

    json_begin(json, "words", ']');
    for (; words != NULL && *words != '\0'; words += n + (words[n] == '|')) {
        n = strcspn(words, "|");
        snprintf(text, sizeof text, "%.*s", (int)n, words);
        json_text(json, NULL, text);
    }
    json_end(json, ']');
}

static void
json_rules(struct json *json, const struct tool *t, const char *name, const struct opt_rule *r)
{
    struct named one;
    char word[64];

    json_begin(json, name, ']');
    for (; r != NULL && r->with != NULL; r++) {
        json_begin(json, NULL, '}');
        json_words_of(json, r->word);
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
refuse(struct tool *t, const char *what, const struct opt_rule *r, const char *remedy)
{
    const char *because = r->because == NULL ? "" : r->because;

    tool_usage(t, "%s%s%s%s%s", what, *because == '\0' ? "" : ", because ", because,
               *remedy == '\0' ? "" : ": ", remedy);
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
    char text[TEXT], *end;
    const char *const limit = text + sizeof text, *word;
    struct named other;
    size_t n;

    for (const struct opt_rule *r = o->against; r != NULL && r->with != NULL; r++)
        if ((word = applies(t, o, r->word, &n)) != NULL &&
            count_met(t, r->with, false, &other) > 0) {
            end = add_option(text, limit, o, word, n);
            end = add(end, limit, " does not work with ");
            add_option(end, limit, other.opt, other.word, other.n);
            refuse(t, text, r, r->remedy == NULL ? "leave out one of them" : r->remedy);
        }
}

static void
check_needs(struct tool *t, const struct opt *o)
{
    char text[TEXT], *end;
    const char *const limit = text + sizeof text, *word;
    struct named other;
    size_t n;

    for (const struct opt_rule *r = o->needs; r != NULL && r->with != NULL; r++)
        if ((word = applies(t, o, r->word, &n)) != NULL &&
            count_met(t, r->with, true, &other) == 0) {
            end = add_option(text, limit, o, word, n);
            end = add(end, limit, " has no effect without ");
            add_options(end, limit, t, r->with, " or ");
            refuse(t, text, r, r->remedy == NULL ? "" : r->remedy);
        }
}

static void
check_one_of(struct tool *t, const struct opt *o)
{
    char text[TEXT], *end;
    const char *const limit = text + sizeof text;
    struct named other;

    for (const struct opt_rule *r = o->one_of; r != NULL && r->with != NULL; r++)
        if (count_met(t, r->with, false, &other) != 1) {
            end = add(text, limit, strchr(r->with, '|') == NULL ? "give " : "give one of ");
            add_options(end, limit, t, r->with, " and ");
            tool_usage(t, "%s%s%s", text, r->remedy == NULL ? "" : ", ",
                       r->remedy == NULL ? "" : r->remedy);
        }
}

void
rules_check(struct tool *t)
{
    for (size_t k = 0; k < t->option.n; k++)
        check_against(t, &t->option.row[k]);
    for (size_t k = 0; k < t->option.n; k++)
        check_needs(t, &t->option.row[k]);
    for (size_t k = 0; k < t->option.n; k++)
        check_one_of(t, &t->option.row[k]);
}
