/*
 * Completions of bash, zsh and fish, made from the option tables. They contain names of options, their words,
 * units after numbers, files, and the channels of the streams on the command line. The tables are also
 * written as JSON, from which the Python package makes its functions.
 */
#include "parts.h"

#include <math.h>
#include <string.h>

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
    return o->words != NULL || o->type == OPT_CHOICE || (o->arg != NULL && are_words(o->arg));
}

static enum argument
argument_of(const struct tool_info *info, const struct opt *o)
{
    if (o->arg == NULL && o->words == NULL)
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

/* Writes text inside single quotes; each of `marks` gets a backslash. */
static void
put_text(const char *text, size_t n, const char *marks, bool fish)
{
    for (; n > 0; text++, n--) {
        if (*text == '\'')
            fputs(fish ? "\\" : "'\\'", stdout);
        else if (strchr(marks, *text) != NULL)
            putchar('\\');
        putchar(*text);
    }
}

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

static void
put_operand_words(const char *words)
{
    for (; *words != '\0'; words++)
        putchar(*words == '|' ? ' ' : *words);
}

/* Writes the help line without the words of the option, which are completed. */
static void
put_help(const struct opt *o, const char *marks, bool fish)
{
    const char *mark = strstr(o->help, "%s");

    if (mark == NULL) {
        put_text(o->help, strlen(o->help), marks, fish);
    } else {
        put_text(o->help, (size_t)(mark - o->help), marks, fish);
        fputs("these", stdout);
        put_text(mark + 2, strlen(mark + 2), marks, fish);
    }
}

/* "rc-solve" as part of the name of a function. */
static void
put_function(const struct tool_info *info, const char *rest)
{
    putchar('_');
    for (const char *s = info->name; *s != '\0'; s++)
        putchar(*s == '-' ? '_' : *s);
    fputs(rest, stdout);
}

static const char *
dashes(const char *name)
{
    return name[1] == '\0' ? "-" : "--";
}

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
    return k == t->option.n ? &out : option_common(t->info, k - t->option.n - 1);
}

static void
walk(const struct tool *t, void (*row)(const struct tool_info *, const struct opt *))
{
    const struct opt *o;

    for (size_t k = 0; (o = row_at(t, k)) != NULL; k++)
        row(t->info, o);
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

/* Reads the channels in the first 64 MB of a stream. */
#define FIND_CHANNELS                                                                              \
    "head -c 64000000 \"$file\" | LC_ALL=C sed -n 's/^channel=\\([A-Za-z0-9._-]*\\)$/\\1/p'"

/* ---- bash ---- */

static void
bash_case(const struct tool_info *info, const struct opt *o)
{
    enum argument argument = argument_of(info, o);

    if (argument == NOTHING)
        return;
    printf("    %s%s", dashes(o->name), o->name);
    if (o->alias != NULL)
        printf(" | --%s", o->alias);
    printf(")");
    if (argument == WORD || argument == LIST || o->word != NULL) {
        printf(" %s='", argument == LIST ? "list" : "words");
        put_words(o);
        printf("'");
    }
    if (argument == NUMBER)
        printf(" units='%s'", unit_usual(o->unit));
    if (argument == FILE_NAME)
        printf(" files=yes");
    if (argument == CHANNELS) {
        printf(" list=$(");
        put_function(info, "_channels)");
    }
    printf(" ;;\n");
}

static void
bash_name(const struct tool_info *info, const struct opt *o)
{
    (void)info;
    printf(" %s%s", dashes(o->name), o->name);
    if (o->alias != NULL)
        printf(" --%s", o->alias);
}

static void
bash_channels(const struct tool *t)
{
    put_function(t->info, "_channels()\n{\n");
    printf("    local file\n"
           "    for file in \"${COMP_WORDS[@]}\"; do\n"
           "        [ -f \"$file\" ] && " FIND_CHANNELS "\n"
           "    done 2>/dev/null | sort -u\n"
           "}\n");
}

static void
bash_print(const struct tool *t)
{
    const char *words = operand_words(t->info);

    if (takes(t, CHANNELS))
        bash_channels(t);
    put_function(t->info, "()\n{\n");
    printf("    local word=${COMP_WORDS[COMP_CWORD]} n=$((COMP_CWORD - 1))\n"
           "    local words= list= units= files= unit\n"
           "    COMPREPLY=()\n"
           "    # bash takes the marks in --option=word and 0:1 for words\n"
           "    [[ $word == [:=] ]] && word= n=$COMP_CWORD\n"
           "    while [[ ${COMP_WORDS[n]} == [:=] ]]; do\n"
           "        [[ ${COMP_WORDS[n]} == : ]] && n=$((n - 1))\n"
           "        n=$((n - 1))\n"
           "    done\n"
           "    case ${COMP_WORDS[n]} in\n");
    walk(t, bash_case);
    printf("    *)\n        case $word in\n        -*) words='");
    walk(t, bash_name);
    if (words != NULL) {
        printf("' ;;\n        *) words='");
        put_operand_words(words);
        printf("' ;;\n");
    } else {
        printf("' ;;\n        *) files=yes ;;\n");
    }
    printf(
        "        esac\n        ;;\n    esac\n"
        "    [ -z \"$words\" ] || mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
        "    if [ -n \"$list\" ]; then\n"
        "        mapfile -t COMPREPLY < \\\n"
        "            <(compgen -P \"${word%%\"${word##*,}\"}\" -W \"$list\" -- \"${word##*,}\")\n"
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
        "complete -F ");
    put_function(t->info, "");
    printf(" %s\n", t->info->name);
}

/* ---- zsh ---- */

/* Writes a specification for _arguments, in which brackets and colons have a special meaning. */
static void
zsh_name(const struct tool_info *info, const struct opt *o, const char *name)
{
    static const char marks[] = "[]:\\";
    enum argument argument = argument_of(info, o);

    printf("    '*%s%s%s[", dashes(name), name,
           argument == NOTHING ? ""
           : strlen(name) == 1 ? "+"
                               : "=");
    put_help(o, marks, false);
    putchar(']');
    if (argument != NOTHING) {
        putchar(':');
        put_text(o->arg == NULL ? o->name : o->arg, strlen(o->arg == NULL ? o->name : o->arg),
                 marks, false);
        putchar(':');
    }
    switch (argument) {
    case NOTHING:
        break;
    case ANYTHING:
        putchar(' ');
        break;
    case WORD:
        putchar('(');
        put_words(o);
        putchar(')');
        break;
    case LIST:
        printf("_sequence compadd - ");
        put_words(o);
        break;
    case NUMBER:
        putchar(' '); /* otherwise _arguments would put its own words before these */
        put_function(info, "_number \"");
        put_words(o);
        printf("\" %s", unit_usual(o->unit));
        break;
    case FILE_NAME:
        printf("_files");
        break;
    case CHANNELS:
        put_function(info, "_channels");
        break;
    }
    printf("'\n");
}

static void
zsh_option(const struct tool_info *info, const struct opt *o)
{
    zsh_name(info, o, o->name);
    if (o->alias != NULL)
        zsh_name(info, o, o->alias);
}

static void
zsh_number(const struct tool *t)
{
    put_function(t->info, "_number()\n{\n");
    printf("    compadd -- ${=1}\n"
           "    compset -P '*[:,]'\n"
           "    compset -P '[0-9.]##' && compadd -- ${@:2}\n"
           "}\n");
}

static void
zsh_channels(const struct tool *t)
{
    put_function(t->info, "_channels()\n{\n");
    printf("    local file\n"
           "    local -a found\n"
           "    for file in $words; do\n"
           "        [[ -f $file ]] && found+=($(" FIND_CHANNELS " 2>/dev/null))\n"
           "    done\n"
           "    (( $#found )) && _sequence compadd - ${(u)found}\n"
           "}\n");
}

static void
zsh_print(const struct tool *t)
{
    const char *words = operand_words(t->info);

    printf("#compdef %s\n", t->info->name);
    zsh_number(t);
    if (takes(t, CHANNELS))
        zsh_channels(t);
    printf("local -a specs=(\n");
    walk(t, zsh_option);
    printf("    '*:%s:", words == NULL ? "file" : "word");
    if (words != NULL) {
        putchar('(');
        put_operand_words(words);
        putchar(')');
    } else {
        printf("_files");
    }
    printf("'\n)\n_arguments -S : $specs\n");
}

/* ---- fish ---- */

static void
fish_option(const struct tool_info *info, const struct opt *o)
{
    enum argument argument = argument_of(info, o);

    printf("complete -c %s -%c %s", info->name, strlen(o->name) == 1 ? 's' : 'l', o->name);
    if (o->alias != NULL)
        printf(" -l %s", o->alias);
    switch (argument) {
    case NOTHING:
        break;
    case ANYTHING:
        printf(" -x");
        break;
    case WORD:
        printf(" -x -a '");
        put_words(o);
        putchar('\'');
        break;
    case LIST:
        printf(" -x -a '(__fish_append , ");
        put_words(o);
        printf(")'");
        break;
    case NUMBER:
        printf(" -x -a '");
        put_words(o);
        printf("%s(_", o->word == NULL ? "" : " ");
        put_function(info, "_number ");
        printf("%s)'", unit_usual(o->unit));
        break;
    case FILE_NAME:
        printf(" -r -F");
        break;
    case CHANNELS:
        printf(" -x -a '(__fish_append , (_");
        put_function(info, "_channels))'");
        break;
    }
    printf(" -d '");
    put_help(o, "\\", true);
    printf("'\n");
}

static void
fish_number(const struct tool *t)
{
    printf("function _");
    put_function(t->info, "_number\n");
    printf("    set -l typed (commandline -ct | string replace -r '^--[^=]*=' '')\n"
           "    string match -qr '^(.*[:,])?[0-9]*\\.?[0-9]+$' -- $typed\n"
           "    and printf '%%s\\n' $typed$argv\n"
           "end\n");
}

static void
fish_channels(const struct tool *t)
{
    printf("function _");
    put_function(t->info, "_channels\n");
    printf("    for file in (commandline -opc)\n"
           "        test -f $file; and " FIND_CHANNELS "\n"
           "    end 2>/dev/null | sort -u\n"
           "end\n");
}

static void
fish_print(const struct tool *t)
{
    const char *words = operand_words(t->info);

    fish_number(t);
    if (takes(t, CHANNELS))
        fish_channels(t);
    if (words != NULL) {
        printf("complete -c %s -f -a '", t->info->name);
        put_operand_words(words);
        printf("'\n");
    }
    walk(t, fish_option);
}

/* ---- for programs: the table as JSON ---- */

/* Writes the words of a list, separated by blanks or '|', as an array. */
static void
json_list(struct json *json, const char *name, const char *words)
{
    char word[64];

    json_array(json, name);
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

    json_array(json, "words");
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
json_option(struct json *json, const struct opt *o)
{
    static const char *const types[] = {
        [OPT_FLAG] = "flag",   [OPT_NUMBER] = "number",   [OPT_COUNT] = "count",
        [OPT_TEXT] = "text",   [OPT_REPORT] = "report",   [OPT_CHOICE] = "choice",
        [OPT_WORDS] = "words", [OPT_NUMBERS] = "numbers", [OPT_STEP] = "step",
        [OPT_TEXTS] = "texts"};

    json_object(json, NULL);
    json_text(json, "name", o->name);
    json_text(json, "alias", o->alias);
    json_text(json, "type", types[o->type]);
    json_text(json, "argument", o->arg);
    json_text(json, "unit", unit_name(o->unit));
    json_list(json, "units", unit_usual(o->unit));
    json_number(json, "least", o->min < o->max ? o->min : NAN);
    json_number(json, "most", o->min < o->max ? o->max : NAN);
    json_bool(json, "above_least", o->above);
    json_words(json, o);
    json_bool(json, "only_words", o->type == OPT_CHOICE || o->type == OPT_WORDS);
    json_bool(json, "optional", o->optional);
    json_bool(json, "repeats", o->type == OPT_TEXTS || o->type == OPT_STEP);
    json_text(json, "help", o->help);
    json_end(json, '}');
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
    json_list(&json, "operand_words", operand_words(t->info) == NULL ? "" : t->info->operands);
    json_text(&json, "reads", reads[t->info->reads]);
    json_text(&json, "writes", writes[t->info->writes]);
    json_array(&json, "options");
    for (size_t k = 0; (o = row_at(t, k)) != NULL; k++)
        json_option(&json, o);
    json_end(&json, ']');
    json_close(&json);
}

/* ---- all completions ---- */

bool
completions_print(const struct tool *t, const char *shell)
{
    static const struct shell {
        const char *name;
        void (*print)(const struct tool *t);
    } shells[] = {
        {"bash", bash_print}, {"zsh", zsh_print}, {"fish", fish_print}, {"json", table_print}};

    for (size_t k = 0; k < sizeof shells / sizeof *shells; k++)
        if (strcmp(shells[k].name, shell) == 0) {
            shells[k].print(t);
            return true;
        }
    return false;
}
