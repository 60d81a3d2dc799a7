/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "titled_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    HEADER_MOST = 1000 /* lines before a table */
};

/* UTF-8 from UTF-16; an invalid character becomes '?'. */
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

/* True if the line has at least so many numbers, and only numbers. */
static bool
is_row(struct rc_piece line, size_t columns)
{
    struct rc_piece word, rest;
    size_t numbers = 0;
    double value;

    line = rc_piece_trim(line);
    if (line.n == 0 || memchr("0123456789+-.\"", *line.text, 14) == NULL)
        return false;
    for (; rc_piece_word(&line, " \t,;", &word); numbers++)
        if (rc_piece_number(word, &value, &rest) ? rest.n > 0
                                                 : word.n > 0 && !rc_piece_is(word, "--|---|BAD"))
            return false;
    return numbers >= columns;
}

/* ---- titles and units ---- */

struct rc_piece
rc_title_unit(struct rc_piece title)
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
        if (!isnan(rc_piece_metres(word)) && !rc_piece_is(word, "in")) /* "x in um" */
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

bool
rc_title_next(struct rc_piece *line, char separator, struct rc_piece *title)
{
    const char *end = line->text;
    bool quoted;

    while (separator == ' ' && line->n > 0 && (*line->text == ' ' || *line->text == '\t'))
        line->text++, line->n--;
    if (line->n == 0)
        return false;
    quoted = *line->text == '"' && memchr(line->text + 1, '"', line->n - 1) != NULL;
    for (end = line->text + quoted; end < line->text + line->n; end++)
        if (quoted)
            quoted = *end != '"';
        else if (*end == separator || (separator == ' ' && *end == '\t'))
            break;
    *title = rc_piece_trim((struct rc_piece){line->text, (size_t)(end - line->text)});
    end += end < line->text + line->n;
    line->n -= (size_t)(end - line->text);
    line->text = end;
    return true;
}

static size_t
part_at(struct rc_titled_table *t, struct rc_piece line, char separator)
{
    struct rc_piece one;

    t->titles = 0;
    t->title_line = line;
    t->title_separator = separator;
    while (rc_title_next(&line, separator, &one)) {
        /* between white space a unit in brackets belongs to the word before */
        if (separator == ' ' && t->titles > 0 && t->titles <= RC_TITLES_MOST && one.n > 0 &&
            (*one.text == '[' || *one.text == '('))
            t->title[t->titles - 1].n = (size_t)(one.text + one.n - t->title[t->titles - 1].text);
        else if (t->titles++ < RC_TITLES_MOST)
            t->title[t->titles - 1] = one;
    }
    return t->titles;
}

/* Titles may have another separator than the numbers below them. */
static void
part_titles(struct rc_titled_table *t, struct rc_piece line)
{
    static const char others[] = ";\t,";

    while (line.n > 0 && strchr(" \r\n", line.text[line.n - 1]) != NULL &&
           line.text[line.n - 1] != '\0')
        line.n--;
    if (without_mark(line).n < rc_piece_trim(line).n)
        line = without_mark(line);
    if (part_at(t, line, t->numbers.separator) == t->numbers.columns)
        return;
    for (const char *c = others; *c != '\0'; c++)
        if (*c != t->numbers.separator && part_at(t, line, *c) == t->numbers.columns)
            return;
    part_at(t, line, t->numbers.separator);
}

/* If every title is a unit, the names are in the line above. */
static void
part_names(struct rc_titled_table *t, struct rc_piece line)
{
    struct rc_titled_table above = {.titles = 0};

    for (size_t c = 0; c < t->titles; c++)
        if (c >= RC_TITLES_MOST || isnan(rc_piece_metres(rc_piece_bare(t->title[c]))))
            return;
    t->has_over =
        t->titles > 1 && part_at(&above, without_mark(line), t->title_separator) == t->titles;
    memcpy(t->over, above.title, sizeof t->over);
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

    if (column < t->titles && column < RC_TITLES_MOST)
        unit = rc_title_unit(rc_piece_bare(t->title[column]));
    return unit.n > 0 ? unit : t->axis_unit[axis - 'x'];
}

/* ---- roles ---- */

/* The words of a title that give the kind of its column; a single letter has priority. */
static const struct {
    const char *words;
    enum rc_role role;
} roles[] = {
    {"x|distance|position|pos|lateral|length|abscissa|abstand|weg|strecke|encoder1", RC_ROLE_X},
    {"y|encoder2", RC_ROLE_Y},
    {"z|height|heights|altitude|elevation|topography|depth|hoehe|h\xc3\xb6he|h\xf6he|hauteur",
     RC_ROLE_Z},
    {"index|counter|count|row|point|no|nr|number|num|idx|id|unnamed", RC_ROLE_INDEX},
    {"valid", RC_ROLE_VALID},
};

static bool
in_word(char c)
{
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           (unsigned char)c >= 0x80;
}

static struct rc_piece
title_of(const struct rc_titled_table *t, size_t column)
{
    bool known = column < t->titles && column < RC_TITLES_MOST;

    return known ? rc_piece_bare((t->has_over ? t->over : t->title)[column])
                 : (struct rc_piece){"", 0};
}

static struct rc_piece
name_of(struct rc_piece title)
{
    struct rc_piece before, after;

    return rc_piece_part(title, "([<", &before, &after) && before.n > 0 ? before : title;
}

struct rc_piece
rc_titled_table_name(const struct rc_titled_table *t, size_t column)
{
    return name_of(title_of(t, column));
}

/* "z" of z1, but "encoder1" whole. */
static enum rc_role
role_of_word(struct rc_piece word)
{
    size_t letters = word.n;

    while (letters > 1 && word.text[letters - 1] >= '0' && word.text[letters - 1] <= '9')
        letters--;
    if (letters == 1)
        word.n = 1;
    for (size_t k = 0; k < sizeof roles / sizeof *roles; k++)
        if (rc_piece_is(word, roles[k].words))
            return roles[k].role;
    return RC_ROLE_NONE;
}

enum rc_role
rc_title_role(struct rc_piece title)
{
    struct rc_piece name = name_of(title);
    enum rc_role role = RC_ROLE_NONE, other;

    for (size_t k = 0, n; k < name.n; k += n + 1) {
        for (n = 0; k + n < name.n && in_word(name.text[k + n]);)
            n++;
        if (n == 0)
            continue;
        other = role_of_word((struct rc_piece){name.text + k, n});
        if (n == 1 && other != RC_ROLE_NONE)
            return other;
        role = role == RC_ROLE_NONE ? other : role;
    }
    return role;
}

enum rc_role
rc_titled_table_role(const struct rc_titled_table *t, size_t column)
{
    return rc_title_role(title_of(t, column));
}

size_t
rc_titled_table_column(const struct rc_titled_table *t, enum rc_role role)
{
    size_t columns = t->numbers.columns;

    for (size_t c = 0; c < columns && c < t->titles && c < RC_TITLES_MOST; c++)
        if (rc_titled_table_role(t, c) == role)
            return c;
    return columns;
}

/* Letters before the number that the title ends in; SIZE_MAX where it ends in none. */
static size_t
letters_before_number(struct rc_piece title)
{
    size_t n = title.n;

    while (n > 0 && title.text[n - 1] >= '0' && title.text[n - 1] <= '9')
        n--;
    return n < title.n ? n : SIZE_MAX;
}

bool
rc_titled_table_numbered(const struct rc_titled_table *t)
{
    struct rc_piece line = t->title_line, title, first = {"", 0};
    size_t n = 0, letters = SIZE_MAX, missing = t->titles + 1 == t->numbers.columns;
    bool numbers = true, alike = true;
    double value;

    for (; rc_title_next(&line, t->title_separator, &title); n++) {
        struct rc_piece rest;

        title = rc_piece_bare(title);
        if (n == 0 && !missing && t->numbers.columns > 3 &&
            letters_before_number(title) == SIZE_MAX)
            continue; /* the corner */
        if (n == 0 && !missing && title.n == 0)
            continue;
        numbers = numbers && rc_piece_number(title, &value, &rest) && rest.n == 0;
        if (first.n == 0) {
            first = title;
            letters = letters_before_number(title);
        }
        alike = alike && letters != SIZE_MAX && letters_before_number(title) == letters &&
                memcmp(title.text, first.text, letters) == 0;
    }
    return n > 1 && (numbers || alike);
}

bool
rc_titled_table_is_matrix(const struct rc_titled_table *t)
{
    size_t columns = t->numbers.columns;

    if (columns < 3)
        return false;
    if (t->titles + 1 != columns && t->titles != columns)
        return columns > 3;
    if (rc_titled_table_numbered(t))
        return true;
    for (size_t c = 0; c < columns && c < RC_TITLES_MOST; c++) {
        enum rc_role role = rc_titled_table_role(t, c);

        if (role == RC_ROLE_X || role == RC_ROLE_Y)
            return false;
    }
    return rc_titled_table_unit(t, rc_titled_table_role(t, 0) == RC_ROLE_INDEX, 'x').n == 0;
}

void
rc_titled_table_left_out(const struct rc_titled_table *t, struct rc_notes *notes)
{
    char names[120] = "", quote[RC_SHOWN];
    size_t used = 0, n = 0;

    for (size_t c = 0; c < t->numbers.columns && c < RC_TITLES_MOST; c++) {
        if (rc_titled_table_role(t, c) != RC_ROLE_INDEX)
            continue;
        rc_piece_shown_to(quote, title_of(t, c));
        if (used + strlen(quote) + 8 < sizeof names)
            used += (size_t)snprintf(names + used, sizeof names - used, "%s'%s'",
                                     n == 0 ? "" : ", ", quote);
        n++;
    }
    if (t->numeric != NULL)
        rc_note(notes,
                t->words[0] == '\0' ? "a column of words is left out"
                                    : "the column '%s' holds words and is left out",
                t->words);
    if (n > 0)
        rc_note(notes, "the column%s %s %s no heights and %s left out", n == 1 ? "" : "s", names,
                n == 1 ? "holds" : "hold", n == 1 ? "is" : "are");
}

/* ---- the table ---- */

/* True if the only comma of a row, as in 1,5, separates columns. It does if one comma separates their
 * titles, and both titles name a column or have a unit in brackets. */
static bool
comma_parts_titles(struct rc_piece before, struct rc_piece row)
{
    struct rc_piece titles = without_mark(before), title, a, b;
    size_t n = 0;

    row = rc_piece_trim(row);
    if (rc_piece_part(row, " \t;", &a, &b) || !rc_piece_part(row, ",", &a, &b) ||
        rc_piece_part(b, ",", &a, &b))
        return false;
    for (; rc_title_next(&titles, ',', &title); n++) {
        title = rc_piece_bare(title);
        if (rc_title_role(title) == RC_ROLE_NONE && name_of(title).n == title.n)
            return false;
    }
    return n == 2;
}

/* The text of the file, as UTF-8 or Latin-1, without its mark. */
static enum rc_status
text_of(struct rc_titled_table *t, struct rc_piece *text, struct rc_err *err)
{
    *text = rc_file_piece(t->file);
    if (rc_file_is_utf16(t->file)) {
        if ((t->own = narrow(t->file, &text->n)) == NULL)
            return rc_err_set(err, "out of memory for %zu characters", t->file->size / 2);
        text->text = t->own;
    } else if (rc_file_holds(t->file, 0, "\xef\xbb\xbf", 3)) /* the byte order mark of UTF-8 */
        *text = (struct rc_piece){text->text + 3, text->n - 3};
    return RC_OK;
}

/* Finds the first table of at least so many columns: rows and titles. */
static enum rc_status
find_table(struct rc_titled_table *t, struct rc_piece text, size_t columns, struct rc_err *err)
{
    struct rc_piece line, before = {"", 0}, above = {"", 0};
    struct rc_wish said = *t->wish;
    struct rc_lines lines, ahead;
    char separator[2] = "";

    t->skipped = 0;
    for (size_t k = 0; k < sizeof t->axis_unit / sizeof *t->axis_unit; k++)
        t->axis_unit[k] = (struct rc_piece){"", 0};
    lines = ahead = rc_piece_lines(text);
    for (;;) {
        if (lines.number == HEADER_MOST || !rc_lines_next(&ahead, &line.text, &line.n))
            return rc_err_set(err, "there is no table of numbers in the first %d lines",
                              HEADER_MOST);
        if (is_row(line, columns))
            break;
        if (rc_piece_trim(line).n > 0) {
            if (before.n > 0 && t->skipped++ == 0)
                t->first_skipped = before;
            above = before;
            before = take_line(t, line, separator) ? (struct rc_piece){"", 0} : line;
        }
        lines = ahead;
    }
    if (said.separator == NULL && separator[0] != '\0')
        said.separator = separator;
    if (said.separator == NULL && said.decimal == 0 && comma_parts_titles(before, line))
        said.separator = ",";
    if (rc_number_table_open(&t->numbers, &lines, &said, err) != RC_OK)
        return RC_FAIL;
    part_titles(t, before);
    part_names(t, above);
    if (before.n > 0 && t->titles != t->numbers.columns && t->titles + 1 != t->numbers.columns &&
        t->skipped++ == 0)
        t->first_skipped = before;
    return RC_OK;
}

/* ---- columns of words ---- */

enum {
    FIELDS_MOST = 32
};

/* Which fields of a row are words. Returns the number of fields; 0 for a row without a word or with
 * fewer numbers. */
static size_t
fields_of(struct rc_piece line, char separator, size_t fewest, bool word[FIELDS_MOST])
{
    struct rc_piece field, rest;
    size_t n = 0, numbers = 0, words = 0;
    double value;

    line = rc_piece_trim(line);
    for (; rc_title_next(&line, separator, &field); n++) {
        bool is_number = rc_piece_number(field, &value, &rest) && rest.n == 0;

        if (n == FIELDS_MOST)
            return 0;
        word[n] = !is_number && field.n > 0;
        numbers += is_number;
        words += word[n];
    }
    return numbers >= fewest && words > 0 ? n : 0;
}

/* Appends a line without the fields that are words in other lines. */
static char *
put_numbers(char *to, struct rc_piece line, char separator, const bool word[FIELDS_MOST])
{
    struct rc_piece field;
    bool first = true;

    for (size_t k = 0; rc_title_next(&line, separator, &field); k++) {
        if (word[k])
            continue;
        if (!first)
            *to++ = separator;
        memcpy(to, field.text, field.n);
        to += field.n;
        first = false;
    }
    return to;
}

/* Keeps the title of the first column of words, from the line above the first row. */
static void
keep_title(struct rc_titled_table *t, struct rc_piece line, char separator,
           const bool word[FIELDS_MOST])
{
    struct rc_piece field = {"", 0};

    for (size_t k = 0; rc_title_next(&line, separator, &field) && !word[k];)
        k++;
    rc_piece_shown_to(t->words, field);
}

/* Copies the text without the columns that hold words in every row; false where there are none, three
 * rows or more. */
static bool
drop_words(struct rc_titled_table *t, struct rc_piece text, char separator)
{
    bool word[FIELDS_MOST] = {false}, here[FIELDS_MOST];
    size_t fields = 0, rows = 0, n;
    struct rc_piece line, title = {text.text, 0};
    struct rc_lines lines = rc_piece_lines(text);
    RC_OWNED char *copy = NULL;
    char *to;

    while (rc_lines_next(&lines, &line.text, &line.n)) {
        n = fields_of(line, separator, fields == 0 ? 2 : 1, here);
        if (fields == 0 && n == 0) {
            if (lines.number > HEADER_MOST)
                return false;
            title = rc_piece_trim(line).n > 0 ? line : title;
        } else if (fields == 0) {
            fields = n;
            memcpy(word, here, sizeof word);
        } else if (rc_piece_trim(line).n > 0 && (n != fields || memcmp(word, here, n) != 0))
            return false;
        rows += n > 0;
    }
    if (rows < 3 || (to = copy = malloc(text.n + 1)) == NULL)
        return false;
    keep_title(t, title, separator, word);
    lines = rc_piece_lines(text);
    while (rc_lines_next(&lines, &line.text, &line.n)) {
        bool below = line.text >= title.text && rc_piece_trim(line).n > 0;

        if (below)
            to = put_numbers(to, rc_piece_trim(line), separator, word);
        else
            to = (char *)memcpy(to, line.text, line.n) + line.n;
        if (line.text + line.n < text.text + text.n)
            *to++ = '\n';
    }
    t->numeric = rc_give(&copy);
    t->numeric[to - t->numeric] = '\0';
    return true;
}

/* Finds a table beside columns of words: the text is then t->numeric. */
static enum rc_status
find_beside_words(struct rc_titled_table *t, struct rc_piece text)
{
    static const char separators[] = ",;\t";

    for (const char *c = separators; *c != '\0'; c++)
        if (drop_words(t, text, *c)) {
            if (find_table(t, rc_piece_of(t->numeric), 2, NULL) == RC_OK)
                return RC_OK;
            free(t->numeric);
            t->numeric = NULL;
            return RC_FAIL;
        }
    return RC_FAIL;
}

static void
table_close(void *opened)
{
    struct rc_titled_table *t = opened;

    for (size_t k = 0; k < RC_TABLE_KINDS; k++) {
        if (t->as[k].found != NULL && t->as[k].kind->close != NULL)
            t->as[k].kind->close(t->as[k].found);
        free(t->as[k].found);
    }
    free(t->own);
    free(t->numeric);
    free(t->v);
}

/* NULL when memory is out. */
static struct rc_titled_table *
table_of(struct rc_maps *maps, struct rc_err *err)
{
    struct rc_titled_table *t = maps->opened;
    struct rc_piece text;

    if (t != NULL || (t = rc_maps_open(maps, sizeof *t, table_close, err)) == NULL)
        return t;
    t->file = maps->file;
    t->wish = maps->wish;
    t->status = text_of(t, &text, &t->why);
    if (t->status == RC_OK && find_table(t, text, 2, NULL) != RC_OK &&
        find_beside_words(t, text) != RC_OK)
        t->status = find_table(t, text, 1, &t->why);
    return t;
}

void *
rc_table_as(struct rc_maps *maps, const struct rc_table_kind *kind, enum rc_status *status,
            struct rc_err *err)
{
    struct rc_titled_table *t = table_of(maps, err);
    struct rc_table_found *as = t == NULL ? NULL : &t->as[kind->index];

    *status = RC_FAIL;
    if (as != NULL && as->kind == NULL && (as->found = calloc(1, kind->size)) != NULL) {
        as->kind = kind;
        as->status = kind->open(as->found, t, &as->why);
    }
    if (as == NULL || as->found == NULL)
        return rc_err_null(err, "out of memory for a table");
    if ((*status = as->status) != RC_OK)
        rc_err_set(err, "%s", as->why.text);
    return as->found;
}

enum rc_status
rc_titled_table_check(const struct rc_titled_table *t, struct rc_err *err)
{
    return t->status == RC_OK ? RC_OK : rc_err_set(err, "%s", t->why.text);
}

enum rc_status
rc_titled_table_read(struct rc_titled_table *t, struct rc_err *err)
{
    RC_OWNED double *v = NULL;
    size_t n;

    if (t->v != NULL)
        return RC_OK;
    if (rc_number_table_size(&t->numbers, &n, err) != RC_OK)
        return RC_FAIL;
    if ((v = malloc(n * sizeof *v)) == NULL)
        return rc_err_set(err, "out of memory for %zu values", n);
    if (rc_number_table_read(&t->numbers, v, err) != RC_OK)
        return RC_FAIL;
    t->v = rc_give(&v);
    return RC_OK;
}
