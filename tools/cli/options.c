/* The option tables: parsing, --help, and the line that goes into history. */
#include "tool.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/contact.h"

/* What every tool has. Offsets point into struct tool itself; `type` is read apart. */
/* clang-format off */
static const struct opt common[] = {
    {.name = "threads", .type = OPT_COUNT, .at = offsetof(struct tool, threads), .min = 1,
     .max = 4096, .arg = "N", .help = "threads to use (default: RC_THREADS, else all cores)"},
    {.name = "memory", .type = OPT_NUMBER, .unit = UNIT_BYTES, .min = 1, .max = 1e18,
     .arg = "LIMIT", .help = "refuse what needs more memory, as in 512M or 4G"},
    {.name = "type", .type = OPT_CHOICE, .arg = "f64|f32", .help = "of the values written"},
    {.name = "quiet", .type = OPT_FLAG, .at = offsetof(struct tool, quiet),
     .help = "no warnings"},
    {.name = "verbose", .type = OPT_FLAG, .at = offsetof(struct tool, verbose),
     .help = "say what is done"},
    {.name = "progress", .type = OPT_FLAG, .at = offsetof(struct tool, progress),
     .help = "show progress even when standard error is no terminal"},
    {.name = "help", .type = OPT_FLAG, .help = "print this and exit"},
    {.name = "version", .type = OPT_FLAG, .help = "print the version and exit"},
    {.name = NULL},
};
/* clang-format on */

enum {
    OWN = 1000,    /* getopt values of the tool's own rows  */
    COMMON = 2000, /* getopt values of the common rows      */
    COLUMN = 28,   /* where help texts start                */
};

static size_t
rows(const struct opt *table)
{
    size_t n = 0;

    while (table[n].name != NULL)
        n++;
    return n;
}

static void
help_row(const char *left, const struct opt *o)
{
    int n = printf("  %s%s%s%s", left, o->name, o->arg == NULL ? "" : " ",
                   o->arg == NULL ? "" : o->arg);

    if (n >= COLUMN)
        printf("\n%*s", COLUMN, "");
    else
        printf("%*s", COLUMN - n, "");
    printf("%s\n", o->help);
}

static _Noreturn void
print_help(const struct tool_info *info)
{
    printf("Usage: %s [OPTION]... %s\n%s.\n\n", info->name, info->operands, info->summary);
    for (const struct opt *o = info->opts; o->name != NULL; o++)
        help_row("--", o);
    if (info->opts->name != NULL)
        printf("\n");
    printf("  %-*swrite to FILE, which appears whole or not at all\n", COLUMN - 2, "-o FILE");
    for (const struct opt *o = common; o->name != NULL; o++)
        if (strcmp(o->name, "type") != 0 || info->writes == WRITES_STREAM)
            help_row("--", o);
    printf("\nNumbers may carry a unit (1.1um, 240N, 6GPa); without one they are SI.\n");
    if (info->examples != NULL)
        printf("\nExamples:\n%s", info->examples);
    printf("\nThe manual is %s(1); the grid stream is described in rcg(5).\n", info->name);
    exit(fflush(stdout) == 0 ? 0 : EXIT_IMPOSSIBLE);
}

static void
check_bounds(struct tool *t, const struct opt *o, double value)
{
    bool low = o->above ? value <= o->min : value < o->min;
    char a[RC_NUMBER_SIZE], b[RC_NUMBER_SIZE], c[RC_NUMBER_SIZE];
    const char *unit = o->unit == UNIT_NONE ? "" : " ";

    if (!(o->min < o->max) || (!low && value <= o->max))
        return;
    if (isinf(o->max))
        tool_die(t, EXIT_USAGE, "--%s %s%s%s: it must be %s %s", o->name, rc_number_text(a, value),
                 unit, unit_name(o->unit), o->above ? "above" : "at least",
                 rc_number_text(b, o->min));
    tool_die(t, EXIT_USAGE, "--%s %s%s%s: it must be %s %s and at most %s", o->name,
             rc_number_text(a, value), unit, unit_name(o->unit), o->above ? "above" : "at least",
             rc_number_text(b, o->min), rc_number_text(c, o->max));
}

static double
number(struct tool *t, const struct opt *o, const char *text)
{
    struct rc_err err;
    double value;

    if (unit_number(text, o->unit, &value, &err) != RC_OK)
        tool_die(t, EXIT_USAGE, "--%s %s: %s", o->name, text, err.text);
    check_bounds(t, o, value);
    return value;
}

static double
whole(struct tool *t, const struct opt *o, const char *text)
{
    double value = number(t, o, text);

    if (value != floor(value) || fabs(value) > 9e15)
        tool_die(t, EXIT_USAGE, "--%s %s: it must be a whole number", o->name, text);
    return value;
}

/* Place of text[0..n) among words separated by '|', or -1. */
static int
word_index(const char *words, const char *text, size_t n)
{
    for (int k = 0;; k++) {
        size_t length = strcspn(words, "|");
        if (length == n && n > 0 && strncmp(words, text, n) == 0)
            return k;
        if (words[length] == '\0')
            return -1;
        words += length + 1;
    }
}

static void
check_choice(struct tool *t, const struct opt *o, const char *text)
{
    if (word_index(o->arg, text, strlen(text)) < 0)
        tool_die(t, EXIT_USAGE, "--%s %s: it must be one of %s", o->name, text, o->arg);
}

static size_t
word_set(struct tool *t, const struct opt *o, const char *text)
{
    size_t set = 0;

    for (const char *s = text;; s++) {
        size_t n = strcspn(s, ",");
        int k = word_index(o->words, s, n);
        if (k < 0)
            tool_die(t, EXIT_USAGE, "--%s %s: '%.*s' is none of %s", o->name, text, (int)n, s,
                     o->words);
        set |= (size_t)1 << k;
        s += n;
        if (*s == '\0')
            return set;
    }
}

static void
add_step(struct tool *t, const struct opt *o, struct steps *steps, const char *text)
{
    size_t most = sizeof steps->step / sizeof *steps->step;
    double value = 0;

    if (steps->n == most)
        tool_die(t, EXIT_USAGE, "more than %zu steps: use two commands", most);
    if (o->arg != NULL)
        value = o->unit == UNIT_NONE ? whole(t, o, text) : number(t, o, text);
    steps->step[steps->n++] = (struct step){.opt = o, .value = value};
}

static void
set_list(struct tool *t, const struct opt *o, struct numbers *list, const char *text)
{
    struct rc_err err;

    free(list->v);
    *list = (struct numbers){0};
    if (o->words != NULL && strcmp(text, o->words) == 0)
        return;
    if (unit_numbers(text, o->unit, list, &err) != RC_OK)
        tool_die(t, EXIT_USAGE, "--%s %s: %s", o->name, text, err.text);
    for (size_t k = 0; k < list->n; k++)
        check_bounds(t, o, list->v[k]);
}

static void
set_value(struct tool *t, const struct opt *o, void *base, const char *text)
{
    char *at = (char *)base + o->at;

    switch (o->type) {
    case OPT_FLAG:
        *(bool *)(void *)at = true;
        break;
    case OPT_NUMBER:
        *(double *)(void *)at = number(t, o, text);
        break;
    case OPT_COUNT:
        *(size_t *)(void *)at = (size_t)whole(t, o, text);
        break;
    case OPT_CHOICE:
        check_choice(t, o, text);
        *(const char **)(void *)at = text;
        break;
    case OPT_WORDS:
        *(size_t *)(void *)at = word_set(t, o, text);
        break;
    case OPT_TEXT:
        *(const char **)(void *)at = text;
        break;
    case OPT_NUMBERS:
        set_list(t, o, (struct numbers *)(void *)at, text);
        break;
    case OPT_STEP:
        add_step(t, o, (struct steps *)(void *)at, text);
        break;
    }
}

static void
set_common(struct tool *t, const struct opt *o, const char *text)
{
    if (strcmp(o->name, "help") == 0)
        print_help(t->info);
    if (strcmp(o->name, "version") == 0) {
        printf("%s (libcontact) %s\n", t->info->name, rc_version());
        exit(fflush(stdout) == 0 ? 0 : EXIT_IMPOSSIBLE);
    }
    if (strcmp(o->name, "memory") == 0) {
        t->memory = (size_t)number(t, o, text);
    } else if (strcmp(o->name, "type") == 0) {
        check_choice(t, o, text);
        t->type_given = true;
        t->type = strcmp(text, "f32") == 0 ? RC_F32 : RC_F64;
    } else {
        set_value(t, o, t, text);
    }
}

static struct option *
getopt_table(const struct opt *own)
{
    size_t a = rows(own), b = rows(common);
    struct option *table = calloc(a + b + 1, sizeof *table);

    for (size_t k = 0; table != NULL && k < a + b; k++) {
        const struct opt *o = k < a ? &own[k] : &common[k - a];
        table[k] = (struct option){
            .name = o->name,
            .has_arg = o->arg == NULL ? no_argument : required_argument,
            .val = k < a ? OWN + (int)k : COMMON + (int)(k - a),
        };
    }
    return table;
}

static _Noreturn void
bad_option(struct tool *t, int what, char **argv)
{
    const char *word = argv[optind - 1];

    if (what == ':')
        tool_die(t, EXIT_USAGE, "option %s needs an argument: see %s --help", word, t->info->name);
    if (optopt != 0 && optopt < OWN)
        tool_die(t, EXIT_USAGE, "unknown option -%c: see %s --help", optopt, t->info->name);
    if (optopt >= OWN)
        tool_die(t, EXIT_USAGE, "option %s takes no argument: see %s --help", word, t->info->name);
    tool_die(t, EXIT_USAGE, "unknown or ambiguous option %s: see %s --help", word, t->info->name);
}

void
tool_options(struct tool *t, int argc, char **argv)
{
    struct option *table = getopt_table(t->info->opts);
    int what;

    if (table == NULL)
        tool_die(t, EXIT_IMPOSSIBLE, "out of memory");
    opterr = 0;
    while ((what = getopt_long(argc, argv, ":o:h", table, NULL)) != -1) {
        if (what == 'h')
            print_help(t->info);
        if (what == 'o') {
            t->out_name = strcmp(optarg, "-") == 0 ? NULL : optarg;
        } else if (what >= COMMON) {
            set_common(t, &common[what - COMMON], optarg);
        } else if (what >= OWN) {
            t->given[what - OWN] = true;
            if (t->info->opts[what - OWN].text)
                t->writes = WRITES_TEXT;
            set_value(t, &t->info->opts[what - OWN], t->args, optarg);
        } else {
            bad_option(t, what, argv);
        }
    }
    free(table);
    t->operand = argv + optind;
    t->operands = (size_t)(argc - optind);
}

bool
tool_given(const struct tool *t, const char *name)
{
    for (size_t k = 0; t->info->opts[k].name != NULL; k++)
        if (strcmp(t->info->opts[k].name, name) == 0)
            return t->given[k];
    return false;
}

/* ---- history ---- */

struct line {
    char text[8192];
    size_t n;
};

static void
add(struct line *line, const char *a, const char *b)
{
    size_t left = sizeof line->text - line->n;
    int n = snprintf(line->text + line->n, left, "%s%s", a, b);

    line->n += n < 0 ? 0 : (size_t)n < left ? (size_t)n : left - 1;
}

static void
add_words(struct line *line, const char *words, size_t set)
{
    char word[64];
    const char *before = " ";

    for (; set != 0; set >>= 1) {
        size_t n = strcspn(words, "|");
        if (set & 1) {
            snprintf(word, sizeof word, "%.*s", (int)n, words);
            add(line, before, word);
            before = ",";
        }
        words += n + (words[n] == '|');
    }
}

static void
add_value(struct line *line, const struct opt *o, const void *base)
{
    const char *at = (const char *)base + o->at;
    const struct numbers *list;
    char text[RC_NUMBER_SIZE];

    if (o->type == OPT_NUMBER) {
        add(line, " ", rc_number_text(text, *(const double *)(const void *)at));
    } else if (o->type == OPT_COUNT) {
        snprintf(text, sizeof text, "%zu", *(const size_t *)(const void *)at);
        add(line, " ", text);
    } else if (o->type == OPT_TEXT || o->type == OPT_CHOICE) {
        add(line, " ", *(const char *const *)(const void *)at);
    } else if (o->type == OPT_WORDS) {
        add_words(line, o->words, *(const size_t *)(const void *)at);
    } else if (o->type == OPT_NUMBERS) {
        list = (const struct numbers *)(const void *)at;
        if (list->n == 0)
            add_words(line, o->words, 1);
        for (size_t k = 0; k < list->n; k++)
            add(line, k == 0 ? " " : ",", rc_number_text(text, list->v[k]));
    }
}

static void
add_steps(struct line *line, const struct steps *steps)
{
    char text[RC_NUMBER_SIZE];

    for (size_t k = 0; k < steps->n; k++) {
        add(line, " --", steps->step[k].opt->name);
        if (steps->step[k].opt->arg != NULL)
            add(line, " ", rc_number_text(text, steps->step[k].value));
    }
}

const char *
tool_history(const struct tool *t)
{
    static struct line line;
    bool steps_done = false;

    line.n = 0;
    add(&line, t->info->name, " ");
    add(&line, rc_version(), "");
    for (size_t k = 0; t->info->opts[k].name != NULL; k++) {
        const struct opt *o = &t->info->opts[k];
        if (!t->given[k] || !o->result)
            continue;
        if (o->type == OPT_STEP) {
            if (!steps_done)
                add_steps(&line, (const struct steps *)(const void *)((char *)t->args + o->at));
            steps_done = true;
            continue;
        }
        add(&line, " --", o->name);
        add_value(&line, o, t->args);
    }
    return line.text;
}
