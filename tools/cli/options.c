/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Reads a command line by an option table, and prints --help.
 */
#include "tool.h"

#include <assert.h>
#include <ctype.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "libcontact/contact.h"
#include "tools/text/text.h"
#include "parts.h"

/* Options of every tool. Their offsets are in struct tool itself; `type` is read separately. */
/* clang-format off */
static const struct opt common[] = {
    {.name = "threads", .type = OPT_COUNT, .at = offsetof(struct tool, threads), .min = 1,
     .max = 4096, .arg = "N", .help = "threads to use (default: RC_THREADS, else a share of the cores)"},
    {.name = "memory", .type = OPT_NUMBER, .unit = UNIT_BYTES, .min = 1, .max = 1e18,
     .arg = "LIMIT", .help = "limit of the memory, as 512M or 4G; larger runs are refused"},
    {.name = "type", .type = OPT_CHOICE, .arg = "f64|f32", .help = "type of the values written"},
    {.name = "quiet", .type = OPT_FLAG, .at = offsetof(struct tool, quiet),
     .help = "no warnings"},
    {.name = "verbose", .type = OPT_FLAG, .at = offsetof(struct tool, verbose),
     .help = "print messages about each step"},
    {.name = "debug", .type = OPT_FLAG, .at = offsetof(struct tool, debug),
     .help = "the same, and at the end the memory used"},
    {.name = "progress", .type = OPT_CHOICE, .at = offsetof(struct tool, progress), .optional = true,
     .arg = "line|json", .help = "show progress even without a terminal; json: for programs"},
    {.name = "help", .type = OPT_FLAG, .help = "print this and exit"},
    {.name = "version", .type = OPT_FLAG, .help = "print the version and exit"},
    {.name = NULL},
};
/* instead of "help", in a tool whose options have headings */
static const struct opt help_of_groups = {
    .name = "help", .type = OPT_TEXT, .optional = true, .arg = "GROUP",
    .help = "print this, or only the options of a group, and exit"};
/* clang-format on */

enum {
    OWN = 1000,    /* getopt values of the rows of the tool */
    COMMON = 2000, /* getopt values of the common rows     */
    COLUMN = 28,   /* column at which help texts start     */
    WIDTH = 100,   /* columns of lines with rules           */
    LIST = 256,    /* most bytes of a list of words        */
};

static const char letters[] = ":o:h"; /* one-letter options for getopt */

/* ---- the table ---- */

static bool
is_row(const struct opt *o)
{
    return o->name != NULL || o->group != NULL || o->title != NULL;
}

/* Under the heading `title`; NULL: --help has no headings. */
static void
add_rows(struct tool *t, const struct opt *table, void *base, size_t at, const char *title)
{
    for (const struct opt *o = table; is_row(o); o++) {
        struct opt row = *o;
        if (row.base == NULL) {
            row.base = base;
            row.at += at;
        }
        row.title = title == NULL || o->title == NULL ? title : o->title;
        if (o->group != NULL) {
            const size_t first = t->option.n;
            add_rows(t, o->group, row.base, row.at, row.title);
            for (size_t k = first; k < t->option.n; k++) {
                t->option.row[k].needs = o->needs != NULL ? o->needs : t->option.row[k].needs;
                t->option.row[k].against =
                    o->against != NULL ? o->against : t->option.row[k].against;
            }
        } else if (o->name == NULL) {
            title = row.title;
        } else {
            assert(t->option.n < TOOL_OPTIONS);
            t->option.row[t->option.n++] = row;
        }
    }
}

static bool
has_headings(const struct opt *table)
{
    while (is_row(table) && table->title == NULL)
        table++;
    return table->title != NULL;
}

/* The n-th of the headings, in the order of their first options; NULL past the last. */
static const char *
heading(const struct tool *t, size_t n)
{
    for (size_t k = 0, i; k < t->option.n && t->option.row[k].title != NULL; k++) {
        for (i = 0; strcmp(t->option.row[i].title, t->option.row[k].title) != 0;)
            i++;
        if (i == k && n-- == 0)
            return t->option.row[k].title;
    }
    return NULL;
}

/* Row k of the table of common options. */
static const struct opt *
common_row(const struct tool *t, size_t k)
{
    return heading(t, 0) != NULL && strcmp(common[k].name, "help") == 0 ? &help_of_groups
                                                                        : &common[k];
}

const struct opt *
option_common(const struct tool *t, size_t k)
{
    for (size_t i = 0; common[i].name != NULL; i++)
        if ((strcmp(common[i].name, "type") != 0 || t->info->writes == WRITES_STREAM) && k-- == 0)
            return common_row(t, i);
    return NULL;
}

/* ---- words ---- */

const char *
option_word(const struct opt *o, size_t k, size_t *n)
{
    const char *word = o->list != NULL ? o->list[k] : o->words != NULL ? o->words(k) : o->arg;

    if (o->words == NULL && o->list == NULL) {
        for (; k > 0 && *word != '\0'; k--)
            word += strcspn(word, "|") + (word[strcspn(word, "|")] == '|');
        *n = strcspn(word, "|");
        return *n == 0 ? NULL : word;
    }
    *n = word == NULL ? 0 : strlen(word);
    return word;
}

int
option_word_index(const struct opt *o, const char *text, size_t n)
{
    const char *word;
    size_t length;

    for (size_t k = 0; (word = option_word(o, k, &length)) != NULL; k++)
        if (name_same(text, n, word, length))
            return (int)k;
    return -1;
}

static const char *
word_list(char list[LIST], const struct opt *o, const char *between)
{
    const char *word;
    size_t length, used = 0;

    list[0] = '\0';
    for (size_t k = 0; (word = option_word(o, k, &length)) != NULL && used < LIST; k++)
        used += (size_t)snprintf(list + used, LIST - used, "%s%.*s", k == 0 ? "" : between,
                                 (int)length, word);
    return list;
}

/* ": did you mean WORD?", or "" if no word of the option is similar. */
static const char *
word_meant(char text[NAME_MEANT], const struct opt *o, const char *typed, size_t n)
{
    char name[NAME_SIZE], near[NAME_SIZE] = "", other[NAME_SIZE];
    const char *word;
    size_t length;

    snprintf(name, sizeof name, "%.*s", (int)n, typed);
    for (size_t k = 0; (word = option_word(o, k, &length)) != NULL; k++) {
        snprintf(other, sizeof other, "%.*s", (int)length, word);
        name_nearer(name, other, near);
    }
    return name_meant(near, text);
}

/* ---- help ---- */

static void
help_row(const char *left, const struct opt *o)
{
    const char *arg = o->arg, *mark = strstr(o->help, "%s");
    char list[LIST];
    int n;

    if (o->type == OPT_CHOICE)
        arg = word_list(list, o, "|");
    n = printf("  %s%s%s%s%s%s%s", left, o->name, o->alias == NULL ? "" : ", --",
               o->alias == NULL ? "" : o->alias,
               arg == NULL   ? ""
               : o->optional ? " ["
                             : " ",
               arg == NULL ? "" : arg, o->optional ? "]" : "");
    if (n >= COLUMN)
        printf("\n%*s", COLUMN, "");
    else
        printf("%*s", COLUMN - n, "");
    if (mark == NULL)
        printf("%s\n", o->help);
    else
        printf("%.*s%s%s\n", (int)(mark - o->help), o->help, word_list(list, o, ","), mark + 2);
}

/* The rules of an option, on lines of their own. */
static void
help_rules(const struct tool *t, const struct opt *o)
{
    const char *text = rules_text(t, o);

    for (size_t n, column; *text != '\0'; printf("\n"))
        for (column = (size_t)printf("%*s", COLUMN - 1, "");
             *text != '\0' && (column == COLUMN - 1 || column + strcspn(text, " ") < WIDTH);
             text += n + (text[n] == ' ')) {
            n = strcspn(text, " ");
            column += (size_t)printf(" %.*s", (int)n, text);
        }
}

/* The options under this heading; NULL: all options of a tool without headings. */
static void
help_rows(const struct tool *t, const char *title)
{
    if (title != NULL)
        printf("%c%s:\n", toupper((unsigned char)*title), title + 1);
    for (size_t k = 0; k < t->option.n; k++)
        if (title == NULL || strcmp(t->option.row[k].title, title) == 0) {
            help_row("--", &t->option.row[k]);
            help_rules(t, &t->option.row[k]);
        }
    if (t->option.n > 0)
        printf("\n");
}

/* True if a word of the list, of blanks between words, begins with this text; `whole`: is it. */
static bool
has_word(const char *list, const char *text, bool whole)
{
    for (const char *at = list; *at != '\0'; at += strspn(at, " ")) {
        const size_t n = strcspn(at, " ");

        if (strncasecmp(at, text, strlen(text)) == 0 && (!whole || strlen(text) == n))
            return true;
        at += n;
    }
    return false;
}

/* The topic of this word, or the only one with a word that begins with it; NULL: there is none. */
static const struct help_topic *
topic_named(const struct tool *t, const char *text)
{
    const struct help_topic *found = NULL;
    size_t matches = 0;

    for (const struct help_topic *p = t->info->topics; p != NULL && p->words != NULL; p++) {
        if (has_word(p->words, text, true))
            return p;
        if (has_word(p->words, text, false)) {
            found = p;
            matches++;
        }
    }
    return matches == 1 ? found : NULL;
}

static void
help_topic(const struct tool *t, const struct help_topic *topic)
{
    const int n = (int)strcspn(topic->words, " ");

    if (*topic->options != '\0')
        printf("%c%.*s:\n", toupper((unsigned char)*topic->words), n - 1, topic->words + 1);
    for (size_t k = 0; k < t->option.n; k++)
        if (has_word(topic->options, t->option.row[k].name, true)) {
            help_row("--", &t->option.row[k]);
            help_rules(t, &t->option.row[k]);
        }
    printf("%sThe manual is contact-%.*s(7).\n", *topic->options != '\0' ? "\n" : "", n,
           topic->words);
}

/* The heading that begins with this text; ends the tool if there is none, or several. */
static const char *
heading_named(struct tool *t, const char *text)
{
    const char *found = NULL, *title;
    char list[LIST] = "";
    size_t matches = 0, used = 0;

    for (size_t k = 0; (title = heading(t, k)) != NULL; k++) {
        if (strcasecmp(title, text) == 0)
            return title;
        if (strncasecmp(title, text, strlen(text)) == 0) {
            found = title;
            matches++;
        }
        if (used < LIST)
            used += (size_t)snprintf(list + used, LIST - used, "%s%s", k == 0 ? "" : ", ", title);
    }
    for (const struct help_topic *p = t->info->topics; p != NULL && p->words != NULL; p++)
        if (used < LIST)
            used += (size_t)snprintf(list + used, LIST - used, ", %.*s",
                                     (int)strcspn(p->words, " "), p->words);
    if (matches != 1)
        tool_usage(t, "--help %s: %s group of options: the groups are %s", text,
                   matches == 0 ? "there is no such" : "this begins more than one", list);
    return found;
}

/* True if this text is a heading, or begins one. */
static bool
begins_heading(const struct tool *t, const char *text)
{
    const char *title;

    for (size_t k = 0; (title = heading(t, k)) != NULL; k++)
        if (strncasecmp(title, text, strlen(text)) == 0)
            return true;
    return false;
}

/* Prints the options of one group, or the whole help with NULL. */
static _Noreturn void
print_help(struct tool *t, const char *group)
{
    const struct tool_info *info = t->info;
    const struct opt *o;
    const char *title;

    if (group != NULL) {
        const struct help_topic *topic = begins_heading(t, group) ? NULL : topic_named(t, group);

        if (topic != NULL)
            help_topic(t, topic);
        else
            help_rows(t, heading_named(t, group));
        exit(fflush(stdout) == 0 && !ferror(stdout) ? 0 : EXIT_IMPOSSIBLE);
    }
    printf("Usage: %s [OPTION]... %s\n%s.\n\n", info->name, info->operands, info->summary);
    for (size_t k = 0; (title = heading(t, k)) != NULL; k++)
        help_rows(t, title);
    if (heading(t, 0) == NULL)
        help_rows(t, NULL);
    else
        printf("All tools:\n");
    printf("  %-*swrite to FILE, which appears whole or not at all\n", COLUMN - 2, "-o FILE");
    for (size_t k = 0; (o = option_common(t, k)) != NULL; k++)
        help_row("--", o);
    printf("\nNumbers may carry a unit (1.1um, 240N, 6GPa); without one they are SI.\n");
    if (info->examples != NULL)
        printf("\nExamples:\n%s", info->examples);
    printf("\nThe manual is %s(1); the grid stream is described in rcg(5).\n", info->name);
    exit(fflush(stdout) == 0 && !ferror(stdout) ? 0 : EXIT_IMPOSSIBLE);
}

/* ---- values ---- */

static void
check_bounds(struct tool *t, const struct opt *o, double value, bool per_metre)
{
    bool low = o->above ? value <= o->min : value < o->min;
    const char *unit = o->unit == UNIT_NONE ? "" : " ";
    const char *name = per_metre ? "N/m" : unit_name(o->unit);

    if (!(o->min < o->max) || (!low && value <= o->max))
        return;
    if (isinf(o->max))
        tool_usage(t, "--%s %s%s%s: it must be %s %s", o->name, rc_number(value), unit, name,
                   o->above ? "above" : "at least", rc_number(o->min));
    tool_usage(t, "--%s %s%s%s: it must be %s %s and at most %s", o->name, rc_number(value), unit,
               name, o->above ? "above" : "at least", rc_number(o->min), rc_number(o->max));
}

static double
number(struct tool *t, const struct opt *o, const char *text)
{
    double value;

    if (unit_number(text, o->unit, &value, &t->err) != RC_OK)
        tool_usage(t, "--%s %s: %s%s", o->name, text, t->err.text,
                   t->info->of_materials != NULL && isalpha((unsigned char)*text)
                       ? "; a material by its name is --body1 or --body2, and --materials prints "
                         "the names"
                       : "");
    check_bounds(t, o, value, false);
    if (o->unit == UNIT_HARD)
        t->vickers = unit_vickers(text) ? text : NULL;
    return value;
}

static double
whole(struct tool *t, const struct opt *o, const char *text)
{
    double value = number(t, o, text);

    if (value != floor(value) || fabs(value) > 9e15)
        tool_usage(t, "--%s %s: it must be a whole number", o->name, text);
    return value;
}

/* Converts a number to size_t: with 32-bit addresses the number may be too large. */
static size_t
count(struct tool *t, const struct opt *o, const char *text)
{
    double value = whole(t, o, text);

    if (value > (double)SIZE_MAX)
        tool_usage(t, "--%s %s: this machine counts to %zu", o->name, text, SIZE_MAX);
    return (size_t)value;
}

/* Replaces the word by its spelling in the table. */
static const char *
choice(struct tool *t, const struct opt *o, const char *text)
{
    char list[LIST], meant[NAME_MEANT];
    int k = text == NULL ? 0 : option_word_index(o, text, strlen(text));

    if (text == NULL)
        return "";
    if (k < 0)
        tool_usage(t, "--%s %s: it must be one of %s%s", o->name, text, word_list(list, o, "|"),
                   word_meant(meant, o, text, strlen(text)));
    return o->list != NULL ? o->list[k] : o->words != NULL ? o->words((size_t)k) : text;
}

static size_t
word_set(struct tool *t, const struct opt *o, const char *text)
{
    char list[LIST], meant[NAME_MEANT];
    size_t set = 0;

    for (const char *s = text;; s++) {
        size_t n = strcspn(s, ",");
        int k = option_word_index(o, s, n);
        if (k < 0)
            tool_usage(t, "--%s %s: '%.*s' is none of %s%s", o->name, text, (int)n, s,
                       word_list(list, o, "|"), word_meant(meant, o, s, n));
        set |= (size_t)1 << k;
        s += n;
        if (*s == '\0')
            return set;
    }
}

/* A step that takes one of some words. */
static bool
takes_word(const struct opt *o)
{
    return o->type == OPT_STEP && o->arg != NULL && strchr(o->arg, '|') != NULL;
}

static void
add_step(struct tool *t, const struct opt *o, struct steps *steps, const char *text)
{
    size_t most = sizeof steps->step / sizeof *steps->step;
    double value = 0;

    if (steps->n == most)
        tool_usage(t, "more than %zu steps: use two commands", most);
    if (takes_word(o))
        value = text == NULL ? -1 : option_word_index(o, choice(t, o, text), strlen(text));
    else if (o->type == OPT_STEP && o->arg != NULL)
        value = o->unit == UNIT_NONE && !o->real ? whole(t, o, text) : number(t, o, text);
    steps->step[steps->n++] = (struct step){.opt = o, .value = value, .text = text, .typed = text};
}

static void
set_list(struct tool *t, const struct opt *o, struct numbers *list, const char *text)
{
    free(list->v);
    *list = (struct numbers){0};
    if (o->word != NULL && strcmp(text, o->word) == 0)
        return;
    if ((o->per_metre ? unit_forces(text, list, &t->err)
         : o->whole   ? unit_whole_numbers(text, list, &t->err)
                      : unit_numbers(text, o->unit, list, &t->err)) != RC_OK)
        tool_die_at(t, NULL, list->no_memory ? EXIT_IMPOSSIBLE : EXIT_USAGE, "--%s %s: %s", o->name,
                    text, t->err.text);
    for (size_t k = 0; k < list->n; k++) {
        check_bounds(t, o, list->v[k], list->per_metre);
        if (o->whole && list->v[k] != floor(list->v[k]))
            tool_usage(t, "--%s %s: it must be a whole number", o->name, text);
    }
}

static void
set_value(struct tool *t, const struct opt *o, void *at, const char *text)
{
    switch (o->type) {
    case OPT_FLAG:
        *(bool *)at = true;
        break;
    case OPT_NUMBER:
        *(double *)at =
            o->word != NULL && strcmp(text, o->word) == 0 ? INFINITY : number(t, o, text);
        break;
    case OPT_COUNT:
        *(size_t *)at = count(t, o, text);
        break;
    case OPT_CHOICE:
        *(const char **)at = choice(t, o, text);
        break;
    case OPT_WORDS:
        *(size_t *)at = word_set(t, o, text);
        break;
    case OPT_TEXT:
    case OPT_REPORT:
        *(const char **)at = text;
        break;
    case OPT_NUMBERS:
        set_list(t, o, at, text);
        break;
    case OPT_STEP:
    case OPT_TEXTS:
        add_step(t, o, at, text);
        break;
    }
}

static void
set_row(struct tool *t, size_t k, const char *text)
{
    t->option.text[k] = text;
    set_value(t, &t->option.row[k], tool_value(t, &t->option.row[k]), text);
}

/* ---- the command line ---- */

static void
set_common(struct tool *t, const struct opt *o, const char *text)
{
    if (strcmp(o->name, "help") == 0)
        print_help(t, text);
    if (strcmp(o->name, "version") == 0) {
        printf("%s (libcontact) %s\n", t->info->name, rc_version());
        exit(fflush(stdout) == 0 && !ferror(stdout) ? 0 : EXIT_IMPOSSIBLE);
    }
    if (strcmp(o->name, "memory") == 0) {
        t->memory = unit_size(number(t, o, text));
    } else if (strcmp(o->name, "type") == 0) {
        t->output.type_given = true;
        t->output.type = strcmp(choice(t, o, text), "f32") == 0 ? RC_F32 : RC_F64;
    } else {
        set_value(t, o, (char *)t + o->at, text);
    }
}

struct getopt_rows {
    struct option *row;
    size_t n;
};

/* Adds a row, and one for the other spelling of its name. */
static void
add_name(struct getopt_rows *rows, const char *name, int has_arg, int val)
{
    char other[NAME_SIZE];

    rows->row[rows->n++] = (struct option){.name = name, .has_arg = has_arg, .val = val};
    if (name_respelt(name, other) != NULL && (name = strdup(other)) != NULL)
        rows->row[rows->n++] = (struct option){.name = name, .has_arg = has_arg, .val = val};
}

static int
argument_kind(const struct opt *o)
{
    if (o->optional)
        return optional_argument;
    return o->arg == NULL && o->words == NULL && o->list == NULL ? no_argument : required_argument;
}

/* Rows for getopt: an alias has a separate row with the value of the option. They exist as long as the tool,
 * for its messages. */
static const struct option *
getopt_table(const struct tool *t)
{
    static struct getopt_rows rows;

    rows.row = calloc(4 * t->option.n + 2 * sizeof common / sizeof *common, sizeof *rows.row);
    if (rows.row == NULL)
        return NULL;
    for (size_t k = 0; k < t->option.n; k++) {
        const struct opt *o = &t->option.row[k];

        add_name(&rows, o->name, argument_kind(o), OWN + (int)k);
        if (o->alias != NULL)
            add_name(&rows, o->alias, argument_kind(o), OWN + (int)k);
    }
    for (size_t k = 0; common[k].name != NULL; k++)
        add_name(&rows, common[k].name, argument_kind(common_row(t, k)), COMMON + (int)k);
    return rows.row;
}

/* ---- faults of an option ---- */

/* Ends the tool if an abbreviated name, which getopt accepts, matches several options. */
static void
check_ambiguous(struct tool *t, const struct option *table, const char *typed)
{
    char list[LIST] = "";
    size_t n = 0, used = 0;
    int last = 0;

    for (const struct option *o = table; o->name != NULL && used < LIST; o++)
        if (strncmp(o->name, typed, strlen(typed)) == 0 && o->val != last) {
            used +=
                (size_t)snprintf(list + used, LIST - used, "%s--%s", n++ == 0 ? "" : ", ", o->name);
            last = o->val; /* the names of an option are adjacent */
        }
    if (n > 1)
        tool_usage(t, "option --%s is ambiguous: %s", typed, list);
}

/* `word` on the command line, with `hyphens` hyphens before the name. */
static _Noreturn void
unknown_option(struct tool *t, const struct option *table, const char *word, size_t hyphens)
{
    char typed[NAME_SIZE], nearest[NAME_SIZE] = "";
    int n = (int)strcspn(word, "=");

    snprintf(typed, sizeof typed, "%.*s", n - (int)hyphens, word + hyphens);
    if (hyphens == 2)
        check_ambiguous(t, table, typed);
    for (const struct option *o = table; o->name != NULL; o++)
        name_nearer(typed, o->name, nearest);
    if (*nearest != '\0')
        tool_usage(t, "unknown option %.*s: did you mean --%s?", n, word, nearest);
    tool_usage(t, "unknown option %.*s: see %s --help", n, word, t->info->name);
}

static bool
could_be_argument(const struct opt *o, const char *word)
{
    double value;

    if (o->type == OPT_TEXT)
        return *word != '-';
    if (o->type == OPT_CHOICE || takes_word(o))
        return option_word_index(o, word, strlen(word)) >= 0;
    return unit_number(word, o->unit, &value, NULL) == RC_OK;
}

/* The optional argument of an option. It follows the "=", or is the next word if that is a number, for a
 * choice one of its words, for a text no option. NULL without an argument. */
static const char *
optional_argument_of(const struct opt *o, int argc, char **argv)
{
    if (optarg == NULL && o->optional && optind < argc && could_be_argument(o, argv[optind]))
        return argv[optind++];
    return optarg;
}

static _Noreturn void
bad_option(struct tool *t, int what, char **argv, const struct option *table)
{
    const char *word = argv[optind - 1], *rest = argv[optind];
    char letter[3];

    if (what == ':')
        tool_usage(t, "option %s needs an argument: see %s --help", word, t->info->name);
    if (optopt >= OWN)
        tool_usage(t, "option %s takes no argument: see %s --help", word, t->info->name);
    if (optopt == 0)
        unknown_option(t, table, word, 2);
    snprintf(letter, sizeof letter, "-%c", optopt);
    if (rest != NULL && strncmp(rest, letter, 2) == 0) /* one hyphen, followed by several letters */
        unknown_option(t, table, rest, 1);
    tool_usage(t, "unknown option %s: see %s --help", letter, t->info->name);
}

/* True if this word is an option of the tool; a negative number is none. */
static bool
is_option(const struct option *table, const char *word)
{
    const size_t n = strcspn(word, "=");

    if (strcmp(word, "-o") == 0 || strcmp(word, "-h") == 0)
        return true;
    if (strncmp(word, "--", 2) != 0)
        return false;
    while (table->name != NULL &&
           (strlen(table->name) != n - 2 || strncmp(table->name, word + 2, n - 2) != 0))
        table++;
    return table->name != NULL;
}

/* getopt takes any next word as the value of an option: in "--sheet -o FILE" the value is forgotten. */
static void
check_value(struct tool *t, int what, char **argv, const struct option *table)
{
    if (optarg == NULL || optarg != argv[optind - 1] || !is_option(table, optarg))
        return;
    if (what == 'o')
        tool_usage(t, "-o needs a value; write -o%s for this one", optarg);
    while (table->val != what)
        table++;
    tool_usage(t, "--%s needs a value; write --%s=%s for this one", table->name, table->name,
               optarg);
}

/* True if the option takes one number as well as several. */
static bool
may_be_one_number(const struct opt *o)
{
    return (o->type == OPT_NUMBERS || o->type == OPT_TEXT) && o->arg != NULL && !o->whole &&
           (strstr(o->arg, "LIST") != NULL || strstr(o->arg, "[,") != NULL);
}

/* "--load 1,5" and "--load 0,5N" give two loads; the user may have meant one, 1.5 or 0.5 N. */
static void
warn_of_commas(struct tool *t)
{
    for (size_t k = 0; k < t->option.n; k++) {
        const struct opt *o = &t->option.row[k];
        const char *text = t->option.text[k], *comma, *digits, *unit, *blank;
        int first, second;
        if (text == NULL || !may_be_one_number(o) || !unit_decimal_comma(text))
            continue;
        comma = strchr(text, ',');
        first = (int)(comma++ - text);
        digits = comma + strspn(comma, "0");
        second = (int)strspn(digits, "0123456789");
        unit = digits[second] != '\0' ? digits + second + strspn(digits + second, " ")
                                      : unit_name(o->unit);
        blank = *unit == '\0' ? "" : " ";
        tool_warn(t,
                  "--%s %s: two values, %g%s%s and %g%s%s: for one number write %.*s.%s, for two "
                  "%.*s%s,%.*s%s",
                  o->name, text, strtod(text, NULL), blank, unit, strtod(comma, NULL), blank, unit,
                  first, text, comma, first, text, *unit == '\0' ? ".0" : unit, second, digits,
                  unit);
    }
}

/* Flags, steps and layers may be repeated; of other options only the last one counts. */
static void
warn_of_repetition(struct tool *t, const bool *twice)
{
    for (size_t k = 0; k < t->option.n; k++)
        if (twice[k] && t->option.row[k].type != OPT_FLAG && t->option.row[k].type != OPT_STEP &&
            t->option.row[k].type != OPT_TEXTS)
            tool_warn(t, "--%s is given twice: only the last one counts", t->option.row[k].name);
}

/* True if standard output is text because of this option. */
static bool
asks_for_text(const struct tool *t, int what, const char *text)
{
    const struct opt *o;

    if (what == 'h')
        return true;
    if (what < OWN)
        return false;
    if (what >= COMMON) {
        o = &common[what - COMMON];
        return strcmp(o->name, "help") == 0 || strcmp(o->name, "version") == 0;
    }
    o = &t->option.row[what - OWN];
    return o->text || strcmp(o->name, "dry-run") == 0 ||
           (o->type == OPT_REPORT && strcmp(text, "-") == 0);
}

/* Searches the whole line for the output first, so that the reader of a pipe gets every error of the line. */
static void
look_for_output(struct tool *t, int argc, char **argv, const struct option *table)
{
    char **copy = tool_room(t, (size_t)argc + 1, sizeof *copy, "the command line");
    int what; /* a copy because getopt sorts its words */

    memcpy(copy, argv, ((size_t)argc + 1) * sizeof *copy);
    t->output.expected = t->info->writes == WRITES_STREAM;
    while ((what = getopt_long(argc, copy, letters, table, NULL)) != -1)
        if (what == 'o' ? strcmp(optarg, "-") != 0 : asks_for_text(t, what, optarg))
            t->output.expected = false;
    free(copy);
    optind = 0; /* starts again without memory of the first pass */
}

void
options_read(struct tool *t, int argc, char **argv)
{
    bool twice[TOOL_OPTIONS] = {false};
    const struct option *table;
    const struct opt *o;
    const char *text;
    int what;

    add_rows(t, t->info->opts, NULL, 0, has_headings(t->info->opts) ? "other" : NULL);
    /* for the build, which installs completions; not in the table and not in --help */
    if (argc == 3 && strcmp(argv[1], "--completions") == 0 && completions_print(t, argv[2]))
        exit(fflush(stdout) == 0 && !ferror(stdout) ? 0 : EXIT_IMPOSSIBLE);
    if ((table = getopt_table(t)) == NULL)
        tool_die(t, "out of memory");
    opterr = 0;
    look_for_output(t, argc, argv, table);
    while ((what = getopt_long(argc, argv, letters, table, NULL)) != -1) {
        if (what != ':' && what != '?')
            check_value(t, what, argv, table);
        if (what == 'h')
            print_help(t, heading(t, 0) == NULL
                              ? NULL
                              : optional_argument_of(&help_of_groups, argc, argv));
        if (what == 'o') {
            t->out_name = strcmp(optarg, "-") == 0 ? NULL : optarg;
        } else if (what >= COMMON) {
            o = common_row(t, (size_t)(what - COMMON));
            set_common(t, o, optional_argument_of(o, argc, argv));
        } else if (what >= OWN) {
            twice[what - OWN] = t->option.given[what - OWN];
            t->option.given[what - OWN] = true;
            if (t->option.row[what - OWN].text)
                t->writes = WRITES_TEXT;
            text = optional_argument_of(&t->option.row[what - OWN], argc, argv);
            if (text != NULL || !t->option.row[what - OWN].optional ||
                t->option.row[what - OWN].type == OPT_CHOICE ||
                t->option.row[what - OWN].type == OPT_STEP)
                set_row(t, (size_t)(what - OWN), text);
        } else {
            bad_option(t, what, argv, table);
        }
    }
    t->operand = argv + optind;
    t->operands = (size_t)(argc - optind);
    t->verbose = t->verbose || t->debug;
    warn_of_commas(t);
    warn_of_repetition(t, twice);
}

bool
tool_given(const struct tool *t, const char *name)
{
    for (size_t k = 0; k < t->option.n; k++)
        if (strcmp(t->option.row[k].name, name) == 0)
            return t->option.given[k];
    return false;
}

void
tool_set_option(struct tool *t, const char *name, const char *text)
{
    const char *vickers = t->vickers; /* only what the line gives needs a message */

    for (size_t k = 0; k < t->option.n; k++)
        if (strcmp(t->option.row[k].name, name) == 0) {
            t->option.given[k] = true;
            set_row(t, k, text);
        }
    t->vickers = vickers;
}
