/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Completions of bash, zsh and fish, made from the option tables. They contain names of options, their words,
 * units after numbers, files, and the channels of the streams on the command line. The tables are also
 * written as JSON, from which the Python package makes its functions.
 */
#include "parts.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "libcontact/model.h"

enum {
    FIGURES = 256 /* most figures of a tool */
};

/* The argument of an option. */
enum argument {
    NOTHING,  /* no argument                                         */
    ANYTHING, /* an argument without known values                    */
    WORD,     /* one word of the option */
    LIST,     /* some words of the option, separated by commas */
    NUMBER,   /* numbers with a unit, or the word that may replace them */
    FILE_NAME,
    CHANNELS, /* channels of the streams on the line, separated by commas */
};

/* True if a text is a list of words, "x|y"; the texts of arguments and operands may be such lists. */
static bool
are_words(const char *text)
{
    return strchr(text, '|') != NULL &&
           text[strspn(text, "abcdefghijklmnopqrstuvwxyz0123456789-|")] == '\0';
}

static bool
has_words(const struct opt *o)
{
    return o->words != NULL || o->list != NULL || o->type == OPT_CHOICE ||
           (o->arg != NULL && are_words(o->arg));
}

static enum argument
argument_of(const struct tool_info *info, const struct opt *o)
{
    if (o->arg == NULL && o->words == NULL && o->list == NULL)
        return NOTHING;
    if (o->type == OPT_WORDS)
        return LIST;
    if (has_words(o))
        return WORD;
    if (o->unit != UNIT_NONE || o->word != NULL)
        return NUMBER;
    if (strstr(o->arg, "FILE") != NULL)
        return FILE_NAME;
    return strcmp(o->name, "channel") == 0 && info->reads == READS_STREAM ? CHANNELS : ANYTHING;
}

/* The operands if they are words, "sphere|wave"; else NULL. */
static const char *
operand_words(const struct tool_info *info)
{
    return are_words(info->operands) ? info->operands : NULL;
}

/* ---- pieces ---- */

/* Row k of the tool's rows, -o, and the common rows; NULL past the last. */
static const struct opt *
row_at(const struct tool *t, size_t k)
{
    static const struct opt out = {.name = "o",
                                   .type = OPT_TEXT,
                                   .arg = "FILE",
                                   .help = "write to FILE, which appears whole or not at all"};

    if (k < t->option.n)
        return &t->option.row[k];
    return k == t->option.n ? &out : option_common(t, k - t->option.n - 1);
}

/* True if one of the tool's own options takes such an argument. */
static bool
takes(const struct tool *t, enum argument argument)
{
    for (size_t k = 0; k < t->option.n; k++)
        if (argument_of(t->info, &t->option.row[k]) == argument)
            return true;
    return false;
}

/* Prints the words of an option with blanks between them. */
static void
put_words(const struct opt *o)
{
    const char *word;
    size_t n;

    if (has_words(o))
        for (size_t k = 0; (word = option_word(o, k, &n)) != NULL; k++)
            printf("%s%.*s", k == 0 ? "" : " ", (int)n, word);
    else if (o->word != NULL)
        fputs(o->word, stdout);
}

/* Prints the text with another character in place of `from`. */
static void
put_changed(const char *text, char from, char to)
{
    for (; *text != '\0'; text++)
        putchar(*text == from ? to : *text);
}

/* ---- the scripts ---- */

/* A shell. Its texts contain marks, see `put`. */
struct shell {
    const char *script;   /* the whole file                                       */
    const char *channels; /* a function that finds the channels of the named files */
    const char *row;      /* of an option                                         */
    const char *name;     /* of an option in a list of names                      */
    const char *alias;    /* before the other name of an option                   */
    const char *argument[CHANNELS + 1];
    const char *operands, *files; /* operands that are words, or files */
    const char *escaped, *quote;  /* characters that get a backslash; before a single quote */
    bool rows_for_aliases, only_with_argument;
};

/* Reads the channels in the first 64 MB of a stream. */
#define FIND_CHANNELS                                                                              \
    "head -c 64000000 \"$file\" | LC_ALL=C sed -n 's/^channel=\\([A-Za-z0-9._-]*\\)$/\\1/p'"

static const struct shell bash = {
    .script =
        "!k!f()\n{\n"
        "    local word=${COMP_WORDS[COMP_CWORD]} n=$((COMP_CWORD - 1))\n"
        "    local words= list= units= files= unit\n"
        "    COMPREPLY=()\n"
        "    # bash takes the marks in --option=word and 0:1 for words\n"
        "    [[ $word == [:=] ]] && word= n=$COMP_CWORD\n"
        "    while [[ ${COMP_WORDS[n]} == [:=] ]]; do\n"
        "        [[ ${COMP_WORDS[n]} == : ]] && n=$((n - 1))\n"
        "        n=$((n - 1))\n"
        "    done\n"
        "    case ${COMP_WORDS[n]} in\n!r"
        "    *)\n        case $word in\n        -*) words='!m' ;;\n        *) !p ;;\n"
        "        esac\n        ;;\n    esac\n"
        "    [ -z \"$words\" ] || mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
        "    if [ -n \"$list\" ]; then\n"
        "        mapfile -t COMPREPLY < \\\n"
        "            <(compgen -P \"${word%\"${word##*,}\"}\" -W \"$list\" -- \"${word##*,}\")\n"
        "        compopt -o nospace 2>/dev/null\n"
        "    fi\n"
        "    if [[ $word =~ ^(.*,)?[0-9]*\\.?[0-9]+$ ]]; then\n"
        "        for unit in $units; do\n"
        "            COMPREPLY+=(\"$word$unit\")\n"
        "        done\n"
        "    fi\n"
        "    if [ -n \"$files\" ]; then\n"
        "        compopt -o filenames 2>/dev/null\n"
        "        mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"
        "    fi\n"
        "}\n"
        "complete -F !f !t\n",
    .channels = "!f_channels()\n{\n"
                "    local file\n"
                "    for file in \"${COMP_WORDS[@]}\"; do\n"
                "        [ -f \"$file\" ] && " FIND_CHANNELS "\n"
                "    done 2>/dev/null | sort -u\n"
                "}\n",
    .row = "    !d!n!l)!a ;;\n",
    .name = " !d!n!i",
    .alias = " | --",
    .argument = {[ANYTHING] = "",
                 [WORD] = " words='!w'",
                 [LIST] = " list='!w'",
                 [NUMBER] = "!b units='!u'",
                 [FILE_NAME] = " files=yes",
                 [CHANNELS] = " list=$(!f_channels)"},
    .operands = "words='!o'",
    .files = "files=yes",
    .only_with_argument = true,
};

/* In a specification for _arguments, brackets and colons have a special meaning. A blank before a function
 * keeps _arguments from putting its own words before the arguments of the function. */
static const struct shell zsh = {
    .script = "#compdef !t\n!f_number()\n{\n"
              "    compadd -- ${=1}\n"
              "    compset -P '*[:,]'\n"
              "    compset -P '[0-9.]##' && compadd -- ${@:2}\n"
              "}\n"
              "!klocal -a specs=(\n!r    '*:!p'\n)\n_arguments -S : $specs\n",
    .channels = "!f_channels()\n{\n"
                "    local file\n"
                "    local -a found\n"
                "    for file in $words; do\n"
                "        [[ -f $file ]] && found+=($(" FIND_CHANNELS " 2>/dev/null))\n"
                "    done\n"
                "    (( $#found )) && _sequence compadd - ${(u)found}\n"
                "}\n",
    .row = "    '*!d!n!e[!h]!a'\n",
    .argument = {[NOTHING] = "",
                 [ANYTHING] = ":!g: ",
                 [WORD] = ":!g:(!w)",
                 [LIST] = ":!g:_sequence compadd - !w",
                 [NUMBER] = ":!g: !f_number \"!w\" !u",
                 [FILE_NAME] = ":!g:_files",
                 [CHANNELS] = ":!g:!f_channels"},
    .operands = "word:(!o)",
    .files = "file:_files",
    .escaped = "[]:\\",
    .quote = "'\\'",
    .rows_for_aliases = true,
};

static const struct shell fish = {
    .script = "function _!f_number\n"
              "    set -l typed (commandline -ct | string replace -r '^--[^=]*=' '')\n"
              "    string match -qr '^(.*[:,])?[0-9]*\\.?[0-9]+$' -- $typed\n"
              "    and printf '%s\\n' $typed$argv\n"
              "end\n!k!p!r",
    .channels = "function _!f_channels\n"
                "    for file in (commandline -opc)\n"
                "        test -f $file; and " FIND_CHANNELS "\n"
                "    end 2>/dev/null | sort -u\n"
                "end\n",
    .row = "complete -c !t -!c !n!l!a -d '!h'\n",
    .alias = " -l ",
    .argument = {[NOTHING] = "",
                 [ANYTHING] = " -x",
                 [WORD] = " -x -a '!w'",
                 [LIST] = " -x -a '(__fish_append , !w)'",
                 [NUMBER] = " -x -a '!w!s(_!f_number !u)'",
                 [FILE_NAME] = " -r -F",
                 [CHANNELS] = " -x -a '(__fish_append , (_!f_channels))'"},
    .operands = "complete -c !t -f -a '!o'\n",
    .files = "",
    .escaped = "\\",
    .quote = "\\",
};

/* Prints text inside single quotes; "%s" in it stands for words that are completed. */
static void
put_quoted(const struct shell *s, const char *text)
{
    for (; *text != '\0'; text++) {
        if (strncmp(text, "%s", 2) == 0) {
            fputs("these", stdout);
            text++;
            continue;
        }
        if (*text == '\'')
            fputs(s->quote, stdout);
        else if (strchr(s->escaped, *text) != NULL)
            putchar('\\');
        putchar(*text);
    }
}

static void put(const struct shell *s, const struct tool *t, const char *text, const struct opt *o,
                const char *name);

static void
put_rows(const struct shell *s, const struct tool *t, const char *row)
{
    const struct opt *o;

    for (size_t k = 0; (o = row_at(t, k)) != NULL; k++) {
        if (row == s->row && s->only_with_argument && argument_of(t->info, o) == NOTHING)
            continue;
        put(s, t, row, o, o->name);
        if (s->rows_for_aliases && o->alias != NULL)
            put(s, t, row, o, o->alias);
    }
}

/* Replaces a mark of a script by a text of the tool. */
static void
put_script(const struct shell *s, const struct tool *t, char mark)
{
    const char *words = operand_words(t->info);

    switch (mark) {
    case 't': /* the tool */
        fputs(t->info->name, stdout);
        break;
    case 'f': /* its name as part of that of a function */
        putchar('_');
        put_changed(t->info->name, '-', '_');
        break;
    case 'k': /* the function of the channels, where an option takes them */
        put(s, t, takes(t, CHANNELS) ? s->channels : "", NULL, NULL);
        break;
    case 'r':
        put_rows(s, t, s->row);
        break;
    case 'm':
        put_rows(s, t, s->name);
        break;
    case 'p':
        put(s, t, words != NULL ? s->operands : s->files, NULL, NULL);
        break;
    case 'o': /* words of operands */
        put_changed(words, '|', ' ');
        break;
    }
}

/* Replaces a mark of an option, whose name is the first or the other one. */
static void
put_option(const struct shell *s, const struct tool *t, char mark, const struct opt *o,
           const char *name)
{
    bool letter = name[1] == '\0';

    switch (mark) {
    case 'd':
        fputs(letter ? "-" : "--", stdout);
        break;
    case 'c': /* fish: short or long */
        putchar(letter ? 's' : 'l');
        break;
    case 'e': /* zsh: before an argument */
        fputs(argument_of(t->info, o) == NOTHING ? "" : letter ? "+" : "=", stdout);
        break;
    case 'n':
        fputs(name, stdout);
        break;
    case 'l':
    case 'i':
        if (o->alias != NULL)
            printf("%s%s", mark == 'i' ? " --" : s->alias, o->alias);
        break;
    case 'h':
        put_quoted(s, o->help);
        break;
    case 'g':
        put_quoted(s, o->arg == NULL ? o->name : o->arg);
        break;
    case 'a':
        put(s, t, s->argument[argument_of(t->info, o)], o, name);
        break;
    case 'w':
        put_words(o);
        break;
    case 'b': /* bash: a word that may replace a number */
        put(s, t, o->word == NULL ? "" : s->argument[WORD], o, name);
        break;
    case 's': /* a blank behind such a word */
        fputs(o->word == NULL ? "" : " ", stdout);
        break;
    case 'u':
        fputs(unit_usual(o->unit), stdout);
        break;
    default:
        put_script(s, t, mark);
    }
}

/* Prints a text of the shell. A mark is an exclamation mark and a letter. */
static void
put(const struct shell *s, const struct tool *t, const char *text, const struct opt *o,
    const char *name)
{
    for (; *text != '\0'; text++)
        if (*text != '!')
            putchar(*text);
        else if (o == NULL)
            put_script(s, t, *++text);
        else
            put_option(s, t, *++text, o, name);
}

/* ---- for programs: the table as JSON ---- */

void
option_json_list(struct json *json, const char *name, const char *words)
{
    char word[64];

    json_begin(json, name, ']');
    for (size_t n; *words != '\0'; words += n + (words[n] != '\0')) {
        n = strcspn(words, " |");
        snprintf(word, sizeof word, "%.*s", (int)n, words);
        json_text(json, NULL, word);
    }
    json_end(json, ']');
}

/* Writes the words that an option takes: also .word, which may replace numbers. */
static void
json_words(struct json *json, const struct opt *o)
{
    const char *word;
    char text[64];
    size_t n;

    json_begin(json, "words", ']');
    if (has_words(o)) {
        for (size_t k = 0; (word = option_word(o, k, &n)) != NULL; k++) {
            snprintf(text, sizeof text, "%.*s", (int)n, word);
            json_text(json, NULL, text);
        }
    } else if (o->word != NULL) {
        json_text(json, NULL, o->word);
    }
    json_end(json, ']');
}

static void
json_option(struct json *json, const struct tool *t, const struct opt *o)
{
    static const char *const types[] = {
        [OPT_FLAG] = "flag",   [OPT_NUMBER] = "number",   [OPT_COUNT] = "count",
        [OPT_TEXT] = "text",   [OPT_REPORT] = "report",   [OPT_CHOICE] = "choice",
        [OPT_WORDS] = "words", [OPT_NUMBERS] = "numbers", [OPT_STEP] = "step",
        [OPT_TEXTS] = "texts"};

    json_begin(json, NULL, '}');
    json_text(json, "name", o->name);
    json_text(json, "alias", o->alias);
    json_text(json, "type", types[o->type]);
    json_text(json, "argument", o->arg);
    json_text(json, "unit", unit_name(o->unit));
    option_json_list(json, "units", unit_usual(o->unit));
    json_number(json, "least", o->min < o->max ? o->min : NAN);
    json_number(json, "most", o->min < o->max ? o->max : NAN);
    json_bool(json, "above_least", o->above);
    json_words(json, o);
    json_bool(json, "only_words", o->type == OPT_CHOICE || o->type == OPT_WORDS);
    json_bool(json, "optional", o->optional);
    json_bool(json, "result", o->result);
    json_bool(json, "repeats", o->type == OPT_TEXTS || o->type == OPT_STEP);
    rules_json(json, t, o);
    json_text(json, "help", o->help);
    json_end(json, '}');
}

/* The figures of the reports: what they are, and of an error what it belongs to and what lowers it. */
static void
json_figures(struct json *json, const struct tool *t)
{
    static const char *const kinds[] = {
        [RC_NUMBER] = "number", [RC_COUNT] = "count", [RC_YESNO] = "bool", [RC_WORD] = "word"};
    static const char *const roles[] = {[RC_FIGURE_RESULT] = "result",
                                        [RC_FIGURE_ERROR] = "error",
                                        [RC_FIGURE_CHECK] = "check",
                                        [RC_FIGURE_COST] = "cost"};
    const struct rc_figure *row[FIGURES];
    size_t n = 0, k;

    for (size_t table = 0;; table++) {
        const bool own = t->info->figures == NULL || t->info->figures[table] == NULL;
        const struct rc_figure *f = own ? t->info->own : rc_figures(t->info->figures[table]);
        for (; f != NULL && f->name != NULL; f++) {
            for (k = 0; k < n && strcmp(row[k]->name, f->name) != 0; k++)
                continue;
            assert(n < FIGURES);
            if (k == n)
                row[n++] = f;
        }
        if (own)
            break;
    }
    json_begin(json, "figures", ']');
    for (k = 0; k < n; k++) {
        json_begin(json, NULL, '}');
        json_text(json, "name", row[k]->name);
        json_text(json, "unit", row[k]->unit);
        json_text(json, "kind", kinds[row[k]->kind]);
        json_text(json, "role", roles[row[k]->role]);
        json_text(json, "by", row[k]->by);
        json_text(json, "of", row[k]->of);
        json_text(json, "title", row[k]->title);
        json_end(json, '}');
    }
    json_end(json, ']');
}

static void
table_print(const struct tool *t)
{
    static const char *const reads[] = {"nothing", "stream", "files"}, *const writes[] = {"stream",
                                                                                          "bytes",
                                                                                          "text"};
    const struct opt *o;
    struct json json;

    json_open(&json, stdout);
    json_text(&json, "tool", t->info->name);
    json_text(&json, "summary", t->info->summary);
    json_text(&json, "operands", t->info->operands);
    option_json_list(&json, "operand_words",
                     operand_words(t->info) == NULL ? "" : t->info->operands);
    json_text(&json, "reads", reads[t->info->reads]);
    json_text(&json, "writes", writes[t->info->writes]);
    json_begin(&json, "options", ']');
    for (size_t k = 0; (o = row_at(t, k)) != NULL; k++)
        json_option(&json, t, o);
    json_end(&json, ']');
    json_figures(&json, t);
    json_close(&json);
}

/* ---- all completions ---- */

bool
completions_print(const struct tool *t, const char *shell)
{
    static const struct {
        const char *name;
        const struct shell *shell; /* NULL: JSON */
    } shells[] = {{"bash", &bash}, {"zsh", &zsh}, {"fish", &fish}, {"json", NULL}};

    for (size_t k = 0; k < sizeof shells / sizeof *shells; k++) {
        if (strcmp(shells[k].name, shell) != 0)
            continue;
        if (shells[k].shell == NULL)
            table_print(t);
        else
            put(shells[k].shell, t, shells[k].shell->script, NULL, NULL);
        return true;
    }
    return false;
}
