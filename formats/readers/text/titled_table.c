#include "titled_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    HEADER_MOST = 1000 /* lines before a table */
};

/* UTF-8 from UTF-16; what is no valid character becomes '?'. */
static char *
narrow(const struct rc_file *file, size_t *n)
{
    bool big = file->data[0] == 0xfe;
    char *text = malloc(file->size / 2 * 3 + 1), *to = text;

    if (text == NULL)
        return NULL;
    for (size_t at = 2; at + 1 < file->size; at += 2) {
        unsigned c = big ? file->data[at] * 256U + file->data[at + 1]
                         : file->data[at + 1] * 256U + file->data[at];
        if (c >= 0xd800 && c < 0xe000)
            c = '?'; /* half of a surrogate pair */
        to += rc_utf8_put(to, c);
    }
    *n = (size_t)(to - text);
    return text;
}

/* The next word of a row: in quotes, or up to a separator. False at the end of the line. */
static bool
next_word(struct rc_piece *line, struct rc_piece *word)
{
    size_t n = 0;
    bool quoted;

    while (line->n > 0 && (*line->text == '\0' || strchr(" \t,;", *line->text) != NULL))
        line->text++, line->n--;
    if (line->n == 0)
        return false;
    quoted = *line->text == '"' && memchr(line->text + 1, '"', line->n - 1) != NULL;
    for (n = quoted; n < line->n; n++)
        if (quoted ? line->text[n] == '"'
                   : line->text[n] == '\0' || strchr(" \t,;", line->text[n]) != NULL)
            break;
    *word = rc_piece_bare((struct rc_piece){line->text, n + quoted});
    line->text += n + quoted;
    line->n -= n + quoted;
    return true;
}

/* Whether the line holds at least so many numbers and nothing else. */
static bool
is_row(struct rc_piece line, size_t columns)
{
    struct rc_piece word, rest;
    size_t numbers = 0;
    double value;

    line = rc_piece_trim(line);
    if (line.n == 0 || memchr("0123456789+-.\"", *line.text, 14) == NULL)
        return false;
    for (; next_word(&line, &word); numbers++)
        if (rc_piece_number(word, &value, &rest)
                ? rest.n > 0
                : word.n > 0 && !rc_piece_is(word, "--") && !rc_piece_is(word, "---") &&
                      !rc_piece_is(word, "BAD"))
            return false;
    return numbers >= columns;
}

/* ---- titles and units ---- */

/* The unit in a title: what stands in brackets, else a word that is a length. */
static struct rc_piece
unit_of(struct rc_piece title)
{
    static const char *const brackets[] = {"()", "[]", "<>"};

    for (size_t k = 0; k < sizeof brackets / sizeof *brackets; k++) {
        struct rc_piece before, inside, after;
        char open[2] = {brackets[k][0], '\0'}, shut[2] = {brackets[k][1], '\0'};

        if (rc_piece_part(title, open, &before, &after) &&
            rc_piece_part(after, shut, &inside, &before))
            return inside;
    }
    for (struct rc_piece rest = title, word; rest.n > 0;) {
        if (!rc_piece_part(rest, " \t_/", &word, &rest)) {
            word = rest;
            rest.n = 0;
        }
        if (!isnan(rc_piece_metres(word)))
            return word;
    }
    return (struct rc_piece){title.text, 0};
}

static struct rc_piece
without_mark(struct rc_piece line)
{
    line = rc_piece_trim(line);
    while (line.n > 0 && (*line.text == '#' || *line.text == '%'))
        line = rc_piece_trim((struct rc_piece){line.text + 1, line.n - 1});
    return line;
}

static size_t
part_at(struct rc_titled_table *t, struct rc_piece line, char separator)
{
    char marks[2] = {separator, '\0'};
    struct rc_piece one;

    t->titles = 0;
    while (t->titles < RC_TITLES_MOST && line.n > 0) {
        if (!rc_piece_part(line, marks, &one, &line)) {
            one = line;
            line.n = 0;
        }
        /* between white space a unit in brackets belongs to the word before */
        if (separator == ' ' && t->titles > 0 && one.n > 0 &&
            (*one.text == '[' || *one.text == '('))
            t->title[t->titles - 1].n = (size_t)(one.text + one.n - t->title[t->titles - 1].text);
        else if (one.n > 0 || separator != ' ')
            t->title[t->titles++] = one;
    }
    return t->titles;
}

/* Titles may stand apart by another mark than the numbers below them. */
static void
part_titles(struct rc_titled_table *t, struct rc_piece line)
{
    static const char others[] = ";\t,";

    line = without_mark(line);
    if (part_at(t, line, t->numbers.separator) == t->numbers.columns)
        return;
    for (const char *c = others; *c != '\0'; c++)
        if (*c != t->numbers.separator && part_at(t, line, *c) == t->numbers.columns)
            return;
    part_at(t, line, t->numbers.separator);
}

/* A line above the table: `x-unit = um`, or `sep=;` as spreadsheets write it. */
static bool
take_line(struct rc_titled_table *t, struct rc_piece line, char separator[2])
{
    static const char *const keys[] = {"x-unit", "y-unit", "z-unit"};
    struct rc_piece key, value;

    if (!rc_piece_part(without_mark(line), ":=", &key, &value))
        return false;
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        if (rc_piece_is(rc_piece_bare(key), keys[k])) {
            t->axis_unit[k] = rc_piece_bare(value);
            return true;
        }
    if (!rc_piece_is(key, "sep") || value.n != 1)
        return false;
    *separator = *value.text;
    return true;
}

struct rc_piece
rc_titled_table_unit(const struct rc_titled_table *t, size_t column, char axis)
{
    struct rc_piece unit = {"", 0};

    if (column < t->titles)
        unit = unit_of(rc_piece_bare(t->title[column]));
    return unit.n > 0 ? unit : t->axis_unit[axis - 'x'];
}

enum rc_status
rc_titled_table_open(struct rc_titled_table *t, const struct rc_file *file, size_t columns,
                     const struct rc_wish *wish, struct rc_err *err)
{
    struct rc_piece text = rc_file_piece(file), line, before = {"", 0};
    struct rc_wish said = *wish;
    struct rc_lines lines, ahead;
    char separator[2] = "";

    *t = (struct rc_titled_table){.axis_unit = {{"", 0}, {"", 0}, {"", 0}}};
    if (rc_file_is_utf16(file)) {
        if ((t->own = narrow(file, &text.n)) == NULL)
            return rc_err_set(err, "out of memory for %zu characters", file->size / 2);
        text.text = t->own;
    } else if (rc_file_holds(file, 0, "\xef\xbb\xbf", 3)) /* the byte order mark of UTF-8 */
        text = (struct rc_piece){text.text + 3, text.n - 3};
    lines = ahead = rc_piece_lines(text);
    for (;;) {
        if (lines.number == HEADER_MOST || !rc_lines_next(&ahead, &line.text, &line.n))
            return rc_err_set(err, "there is no table of numbers in the first %d lines",
                              HEADER_MOST);
        if (is_row(line, columns))
            break;
        if (rc_piece_trim(line).n > 0)
            before = take_line(t, line, separator) ? (struct rc_piece){"", 0} : line;
        lines = ahead;
    }
    if (said.separator == NULL && separator[0] != '\0')
        said.separator = separator;
    if (rc_number_table_open(&t->numbers, &lines, &said, err) != RC_OK)
        return RC_FAIL;
    part_titles(t, before);
    return RC_OK;
}

enum rc_status
rc_titled_table_read(struct rc_titled_table *t, struct rc_err *err)
{
    size_t n;

    if (rc_number_table_size(&t->numbers, &n, err) != RC_OK)
        return RC_FAIL;
    if ((t->v = malloc(n * sizeof *t->v)) == NULL)
        return rc_err_set(err, "out of memory for %zu values", n);
    return rc_number_table_read(&t->numbers, t->v, err);
}

void
rc_titled_table_close(struct rc_titled_table *t)
{
    free(t->own);
    free(t->v);
}
