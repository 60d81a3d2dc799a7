/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The command that is studied: programs of this family, and their options. No shell runs. */
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- words ---- */

static const char no_shell[] =
    "no shell runs it: give programs of this family, with '|' between them";

/* Splits a text into words, as a shell does with quotes and backslashes. */
static size_t
split(struct tool *t, const char *text, char **word)
{
    char *to = tool_room(t, 2 * strlen(text) + 2, 1, "a command");
    char quote = '\0';
    size_t n = 0;
    bool inside = false;

    for (const char *s = text;; s++) {
        const bool end = *s == '\0' || (quote == '\0' && strchr(" \t|", *s) != NULL);

        if (!end && quote == '\0' && strchr(";&<>()$`\n*?~#{}[]!", *s) != NULL)
            tool_usage(t, "the command has the shell character %c: %s", *s == '\n' ? ' ' : *s,
                       no_shell);
        if (!end && !inside) {
            if (n + 2 >= COST_WORDS * COST_PROGRAMS)
                tool_usage(t, "the command has too many words");
            word[n++] = to;
            inside = true;
        }
        if (end && inside) {
            *to++ = '\0';
            inside = false;
        }
        if (*s == '\0')
            break;
        if (end) {
            if (*s == '|')
                word[n++] = strcpy(to, "|"), to += 2;
        } else if (*s == quote || (quote == '\0' && (*s == '\'' || *s == '"'))) {
            quote = quote == '\0' ? *s : '\0';
        } else {
            s += *s == '\\' && quote != '\'' && s[1] != '\0';
            *to++ = *s;
        }
    }
    if (quote != '\0')
        tool_usage(t, "the command lacks a closing %c", quote);
    return n;
}

/* ---- options ---- */

/* True if the option of this object is `name`[0..n). */
static bool
is_named(const char *option, const char *name, size_t n)
{
    char own[COST_NAME], alias[COST_NAME];

    json_copy(json_member(option, "name"), own, sizeof own);
    json_copy(json_member(option, "alias"), alias, sizeof alias);
    return (strlen(own) == n && strncmp(own, name, n) == 0) ||
           (strlen(alias) == n && n > 0 && strncmp(alias, name, n) == 0);
}

/* The option with this name, or the only one that begins so, as getopt_long finds it. */
static const char *
option_of(const struct cost_program *p, const char *name, size_t n, bool whole)
{
    const char *found = NULL;
    size_t begun = 0;
    char own[COST_NAME];

    for (const char *o = json_first(json_member(p->json, "options")); o != NULL; o = json_next(o)) {
        if (is_named(o, name, n))
            return o;
        json_copy(json_member(o, "name"), own, sizeof own);
        if (!whole && n > 0 && strncmp(own, name, n) == 0) {
            found = o;
            begun++;
        }
    }
    return begun == 1 ? found : NULL;
}

const char *
cost_option(const struct cost_program *p, const char *name)
{
    return option_of(p, name, strlen(name), true);
}

static bool
takes_argument(const char *option)
{
    return !json_is(json_member(option, "type"), "flag") &&
           json_real(json_member(option, "optional")) != 1;
}

/* True if this word is the argument of an option that may have none, as for the programs themselves: one of
 * its words, a number, or for a text no option. */
static bool
is_argument(const char *option, const char *word)
{
    const char *const words = json_first(json_member(option, "words"));
    char *end;

    if (json_real(json_member(option, "optional")) != 1)
        return false;
    for (const char *w = words; w != NULL; w = json_next(w))
        if (json_is(w, word))
            return true;
    if (words == NULL && json_is(json_member(option, "type"), "text"))
        return *word != '-';
    (void)strtod(word, &end);
    return words == NULL && end != word;
}

/* The option of word k, and the number of words that it takes; NULL: an operand or an unknown option. */
static const char *
option_at(const struct cost_program *p, const char *const word[], size_t words, size_t k,
          size_t *takes)
{
    const char *w = word[k], *o;
    const size_t n = strcspn(w, "=");

    *takes = 1;
    if (w[0] != '-' || w[1] == '\0')
        return NULL;
    o = w[1] == '-' ? option_of(p, w + 2, n - 2, false) : option_of(p, w + 1, 1, true);
    if (o != NULL && w[w[1] == '-' ? n : 2] == '\0' && k + 1 < words &&
        (takes_argument(o) || is_argument(o, word[k + 1])))
        *takes = 2;
    return o;
}

const char *
cost_option_given(const struct cost_program *p, const char *name)
{
    const char *option = cost_option(p, name), *equals;
    size_t takes;

    for (size_t k = 0; k < p->words; k += takes) {
        if (option_at(p, p->word, p->words, k, &takes) != option || option == NULL)
            continue;
        if (takes == 2)
            return p->word[k + 1];
        equals = strchr(p->word[k], '=');
        return equals != NULL ? equals + 1 : "";
    }
    return NULL;
}

size_t
cost_option_put(struct tool *t, const struct cost_program *p, const char *word[], size_t words,
                const char *name, const char *value, char text[320])
{
    const char *option = cost_option(p, name);
    const bool plain = !takes_argument(option);
    size_t n = 0, place = SIZE_MAX, takes, need = 0;
    const char *own[2];

    for (size_t k = 0; k < words; k += takes) {
        if (option_at(p, word, words, k, &takes) == option) {
            place = place == SIZE_MAX ? n : place;
            continue;
        }
        for (size_t i = 0; i < takes; i++)
            word[n++] = word[k + i];
    }
    if (plain && strcmp(value, "no") == 0)
        return n;
    if (plain && strcmp(value, "yes") == 0)
        snprintf(text, 320, "--%s", name);
    else if (plain || value[0] == '-')
        snprintf(text, 320, "--%s=%s", name, value);
    else
        snprintf(text, 320, "--%s", name);
    own[need++] = text;
    if (!plain && value[0] != '-')
        own[need++] = value;
    if (n + need >= COST_WORDS)
        tool_usage(t, "the command has too many words");
    place = place == SIZE_MAX ? n : place;
    memmove(word + place + need, word + place, (n - place) * sizeof *word);
    memcpy(word + place, own, need * sizeof *word);
    return n + need;
}

/* ---- programs ---- */

/* The program of this family that a misspelt name means. */
static const char *
program_meant(const char *typed, char text[NAME_MEANT])
{
    char nearest[NAME_SIZE] = "", one[NAME_SIZE];

    for (const char *at = RC_PROGRAMS; *at != '\0'; at += strspn(at, " ")) {
        const int length = (int)strcspn(at, " ");
        snprintf(one, sizeof one, "%.*s", length, at);
        at += length;
        if (strcmp(one, "rc-cost") != 0)
            name_nearer(typed, one, nearest);
    }
    return name_meant(nearest, text);
}

static void
ask_program(struct cost_command *c, struct cost_program *p)
{
    const char *const word[] = {p->name, "--completions", "json", NULL};
    struct process process = {.in = c->nowhere, .out = -1, .allowed = 60, .doing = p->name};
    enum process_end end = process_run(c->tool, word, &process);
    char meant[NAME_MEANT];
    const char *why;

    if (end == PROCESS_INTERRUPTED)
        tool_die(c->tool, "interrupted before anything was measured");
    why = cost_message(process.said);
    if (end == PROCESS_FAILED && *why != '\0')
        tool_usage(c->tool, "'%s' is not a program of this family: %s%s", p->name, why,
                   program_meant(p->name, meant));
    if (end != PROCESS_ENDED || !json_is(json_member(process.said, "tool"), p->name))
        tool_die(c->tool, "%s does not say which options it has", p->name);
    p->json = process.said;
    p->reads = json_is(json_member(p->json, "reads"), "stream");
    p->streams = json_is(json_member(p->json, "writes"), "stream");
    p->reports = cost_option(p, "report") != NULL;
    p->plans = cost_option(p, "dry-run") != NULL;
}

/* Why the command cannot have this option; NULL: it can. */
static const char *
unwanted(const char *option)
{
    static const char *const own[] = {"o",        "threads", "memory",      "progress", "verbose",
                                      "debug",    "help",    "version",     "dry-run",  "resume",
                                      "interval", "quiet",   "completions", NULL};
    char argument[COST_NAME];

    for (size_t k = 0; own[k] != NULL; k++)
        if (is_named(option, own[k], strlen(own[k])))
            return k < 3 ? "give it to rc-cost, before FILE" : "it changes no result";
    json_copy(json_member(option, "argument"), argument, sizeof argument);
    if (strcmp(argument, "FILE") == 0 && json_real(json_member(option, "result")) == 0 &&
        !is_named(option, "like", 4))
        return "it writes a file";
    return NULL;
}

void
cost_option_check(struct tool *t, const char *option, const char *from)
{
    char name[COST_NAME];
    const char *why = unwanted(option);

    if (why != NULL)
        tool_usage(t, "%s: --%s cannot be varied: %s", from,
                   json_copy(json_member(option, "name"), name, sizeof name), why);
}

static void
check_words(struct cost_command *c, const struct cost_program *p)
{
    size_t takes;
    bool dash = false;

    for (size_t k = 0; k < p->words; k += takes) {
        const char *w = p->word[k], *o = option_at(p, p->word, p->words, k, &takes), *why;

        if (o == NULL && w[0] == '-' && w[1] != '\0')
            tool_usage(c->tool, "%s has no option %s; see %s --help", p->name, w, p->name);
        if (o == NULL && (w[strspn(w, "<>|&;012")] == '\0' && strpbrk(w, "<>|&;") != NULL))
            tool_usage(c->tool, "the command has the shell characters %s: %s", w, no_shell);
        if (o == NULL && p->reads)
            tool_usage(c->tool,
                       "%s gets its input from FILE or the program before it: leave out %s",
                       p->name, w);
        if (o != NULL && (why = unwanted(o)) != NULL)
            tool_usage(c->tool, "leave out %s of %s: %s", w, p->name, why);
        dash = dash || strcmp(w, "-") == 0;
    }
    if (!p->reads && !dash)
        tool_usage(c->tool, "%s does not read a grid stream: begin with a program that does",
                   p->name);
}

void
cost_command_read(struct cost_command *c, char **word, size_t words)
{
    char *own[COST_WORDS * COST_PROGRAMS];
    struct cost_program *p = NULL;

    if (words == 1 && strpbrk(word[0], " |") != NULL) {
        words = split(c->tool, word[0], own);
        word = own;
    }
    for (size_t k = 0; k < words; k++) {
        if (p == NULL) {
            const char *name = word[k];

            if (c->programs == COST_PROGRAMS)
                tool_usage(c->tool, "the command has more than %d programs", COST_PROGRAMS);
            if (strncmp(name, "rc-", 3) != 0 || strlen(name) > 20 || strcmp(name, "rc-cost") == 0 ||
                name[strspn(name, "abcdefghijklmnopqrstuvwxyz-")] != '\0')
                tool_usage(c->tool, "'%s' is not a program of this family: %s", name, no_shell);
            p = &c->program[c->programs++];
            p->name = name;
        } else if (strcmp(word[k], "|") == 0) {
            p = NULL;
        } else if (p->words + 8 >= COST_WORDS) {
            tool_usage(c->tool, "the command has too many words");
        } else {
            p->word[p->words++] = word[k];
        }
    }
    if (p == NULL)
        tool_usage(c->tool,
                   "a program is missing: give a command, as in rc-cost FILE -- rc-solve ...");
    for (size_t k = 0; k < c->programs; k++) {
        p = &c->program[k];
        ask_program(c, p);
        check_words(c, p);
        if (!p->streams && k + 1 < c->programs)
            tool_usage(c->tool, "%s writes no grid stream that %s could read", p->name,
                       c->program[k + 1].name);
    }
    if (!p->reports)
        tool_usage(c->tool, "%s has no --report: its results cannot be compared", p->name);
}
