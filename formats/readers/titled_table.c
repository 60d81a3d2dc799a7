#include "titled_table.h"

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

/* Whether the line holds at least so many numbers and nothing else. */
static bool
is_row(struct rc_piece line, size_t columns)
{
    size_t numbers = 0;

    line = rc_piece_trim(line);
    if (line.n == 0 || memchr("0123456789+-.", *line.text, 13) == NULL)
        return false;
    for (size_t k = 0; k < line.n;) {
        struct rc_piece word = {line.text + k, 0}, rest;
        double value;

        while (k < line.n && line.text[k] != '\0' && strchr(" \t,;", line.text[k]) == NULL)
            k++, word.n++;
        k++;
        if (word.n == 0)
            continue;
        if (rc_piece_number(word, &value, &rest)
                ? rest.n > 0
                : !rc_piece_is(word, "--") && !rc_piece_is(word, "---") &&
                      !rc_piece_is(word, "BAD"))
            return false;
        numbers++;
    }
    return numbers >= columns;
}

static void
part_titles(struct rc_titled_table *t, struct rc_piece line)
{
    char marks[2] = {t->numbers.separator, '\0'};
    struct rc_piece one;

    line = rc_piece_trim(line);
    while (line.n > 0 && (*line.text == '#' || *line.text == '%'))
        line = rc_piece_trim((struct rc_piece){line.text + 1, line.n - 1});
    while (t->titles < RC_TITLES_MOST && line.n > 0) {
        if (!rc_piece_part(line, marks, &one, &line)) {
            one = line;
            line.n = 0;
        }
        /* between white space a unit in brackets belongs to the word before */
        if (t->numbers.separator == ' ' && t->titles > 0 && one.n > 0 &&
            (*one.text == '[' || *one.text == '('))
            t->title[t->titles - 1].n = (size_t)(one.text + one.n - t->title[t->titles - 1].text);
        else if (one.n > 0 || t->numbers.separator != ' ')
            t->title[t->titles++] = one;
    }
}

enum rc_status
rc_titled_table_open(struct rc_titled_table *t, const struct rc_file *file, size_t columns,
                     const struct rc_wish *wish, struct rc_err *err)
{
    struct rc_piece text = rc_file_piece(file), line, before = {"", 0};
    struct rc_lines lines, ahead;

    *t = (struct rc_titled_table){0};
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
            before = line;
        lines = ahead;
    }
    if (rc_number_table_open(&t->numbers, &lines, wish, err) != RC_OK)
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
