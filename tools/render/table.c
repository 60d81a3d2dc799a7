/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Columns of numbers from reports: tables with tabs or commas, whose first line names the columns as
 * `load/N`, and JSON with one object per row. An array of JSON is a column: each object with arrays is then a
 * separate curve.
 */
#include "render.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    INSIDE = 32,  /* depth of nested objects and arrays of JSON */
    PATH = 512,   /* most bytes of a name with those of its outer objects */
    CELLS = 1024, /* most columns of a table */
};

static const size_t most_bytes = (size_t)1 << 30; /* most bytes of a file, without --memory */

struct reading {
    struct tool *tool;
    struct table *table;
    const char *at, *end;
    struct name_list there; /* names of the existing columns */
    size_t line;
    char separator; /* separator of the cells of a table */
    /* of JSON */
    char path[PATH];
    size_t depth;
    struct { /* the values of the current object for each column */
        double *v;
        size_t n, capacity;
        bool array, taken;
    } * got;
};

const char *
table_remedy(const char *head)
{
    if (head[0] == '{' || (isalpha((unsigned char)head[0]) && strpbrk(head, "\t,") != NULL))
        return "it looks like a table: draw columns of it, as in --curve load:contact_fraction";
    return NULL;
}

static _Noreturn void
bad(struct reading *r, const char *what)
{
    tool_die(r->tool, "%s, line %zu: %s", r->table->source, r->line, what);
}

/* ---- the file ---- */

/* The whole file, terminated by a NUL. */
static char *
read_file(struct tool *t, const char *source, FILE *file, size_t *size)
{
    size_t most = t->memory != 0 ? t->memory : most_bytes, capacity = 0, n = 0, got;
    char *text = tool_grown(t, NULL, 0, &capacity, 1, "a table");

    while ((got = fread(text + n, 1, capacity - n - 1, file)) > 0) {
        n += got;
        if (n > most)
            tool_die(t, "%s: a table of more than %zu bytes is not read", source, most);
        text = tool_grown(t, text, n + 1, &capacity, 1, "a table");
    }
    if (ferror(file))
        tool_die(t, "%s: %s", source, strerror(errno));
    text[n] = '\0';
    *size = n;
    return text;
}

/* ---- rows ---- */

/* Appends value number `row` to a column. */
static void
put(struct reading *r, size_t column, size_t row, double value)
{
    struct column *c = &r->table->column[column];

    c->v = tool_grown(r->tool, c->v, row, &c->room, sizeof *c->v, "a table");
    c->v[row] = value;
}

static void
begin_piece(struct reading *r)
{
    struct table *table = r->table;

    table->piece = tool_grown(r->tool, table->piece, table->pieces, &table->piece_room,
                              sizeof *table->piece, "a table");
    table->piece[table->pieces++] = table->rows;
}

/* Records the name of an existing column. */
static void
add_name(struct reading *r, const char *name)
{
    name_list_add(&r->there, name);
    for (size_t c = 0; c < r->table->columns; c++)
        name_nearer(r->table->column[c].name, name, r->table->column[c].nearest);
}

/* ---- tables with tabs or commas ---- */

/* A number, or 1 and 0 for true and false; NAN for other texts. */
static double
cell_value(const char *text, size_t n, bool *words)
{
    static const struct {
        const char *word;
        double value;
    } known[] = {{"true", 1}, {"false", 0}, {"yes", 1}, {"no", 0}, {"null", NAN}, {"", NAN}};
    char word[64];
    const char *end;
    double value;

    snprintf(word, sizeof word, "%.*s", (int)(n < sizeof word ? n : sizeof word - 1), text);
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strcmp(word, known[k].word) == 0)
            return known[k].value;
    end = rc_number_read(word, true, &value);
    if (end != NULL && *end == '\0' && n < sizeof word)
        return value;
    *words = true;
    return NAN;
}

/* The index of a word among those of its column. */
static double
label_value(struct reading *r, struct column *column, const char *text, size_t n)
{
    char word[PATH];
    size_t k = 0;

    snprintf(word, sizeof word, "%.*s", (int)(n < sizeof word ? n : sizeof word - 1), text);
    for (char *two = word; (two = strstr(two, "\"\"")) != NULL && r->separator == ','; two++)
        memmove(two, two + 1, strlen(two)); /* one quote inside quotes */
    if (*word == '\0' || strcmp(word, "null") == 0 || strcmp(word, "NaN") == 0)
        return NAN;
    while (k < column->word_count && strcmp(column->word[k], word) != 0)
        k++;
    if (k < column->word_count)
        return (double)k;
    if (k == CELLS) /* more than a picture can distinguish: all others have the last index */
        return CELLS - 1;
    column->word = tool_grown(r->tool, column->word, k, &column->word_room, sizeof *column->word,
                              "the words of a table");
    column->word[k] = tool_copy(r->tool, word);
    return (double)column->word_count++;
}

/* A number, or the index of a word as long as no cell of the column is a number. */
static double
either_value(struct reading *r, size_t c, const char *text, size_t n, bool quoted)
{
    struct column *column = &r->table->column[c];
    bool word = quoted;
    double value = quoted ? NAN : cell_value(text, n, &word);

    if (isfinite(value) && !column->numbers) {
        for (size_t k = 0; column->words && k < r->table->rows; k++)
            column->v[k] = NAN;
        for (size_t k = 0; column->words && r->got != NULL && k < r->got[c].n; k++)
            r->got[c].v[k] = NAN;
        column->numbers = true;
    }
    column->words = column->words || word;
    return word && !column->numbers ? label_value(r, column, text, n) : value;
}

/* The value of a cell in column c. */
static double
any_value(struct reading *r, size_t c, const char *text, size_t n, bool quoted)
{
    struct column *column = &r->table->column[c];

    if (column->either)
        return either_value(r, c, text, n, quoted);
    column->words = column->words || quoted;
    if (column->label)
        return label_value(r, column, text, n);
    return quoted ? NAN : cell_value(text, n, &column->words);
}

static const char *
line_end(const struct reading *r)
{
    const char *end = memchr(r->at, '\n', (size_t)(r->end - r->at));

    return end == NULL ? r->end : end;
}

/* The end of the cell that begins at `s`: a separator outside of quotes, or `end`. */
static const char *
cell_end(const struct reading *r, const char *s, const char *end)
{
    bool inside = false;

    for (; s < end && (inside || *s != r->separator); s++)
        inside = inside != (*s == '"' && r->separator == ',');
    return s;
}

/* The cells of the line that ends at `end`, without their quotes; returns their number. */
static size_t
split(struct reading *r, const char *end, const char *start[CELLS], size_t length[CELLS])
{
    size_t n = 0;

    if (end > r->at && end[-1] == '\r')
        end--;
    for (const char *s = r->at, *next;; s = next + 1) {
        bool quoted;

        next = cell_end(r, s, end);
        quoted = r->separator == ',' && next > s + 1 && *s == '"' && next[-1] == '"';
        if (n == CELLS)
            bad(r, "it has more than 1024 columns");
        start[n] = s + quoted;
        length[n++] = (size_t)(next - s) - 2 * quoted;
        if (next == end)
            return n;
    }
}

/* The cell of each column; CELLS: none. */
static void
read_heading(struct reading *r, const char *start[CELLS], const size_t length[CELLS], size_t n,
             size_t *where)
{
    char name[PATH];

    for (size_t c = 0; c < r->table->columns; c++)
        where[c] = CELLS;
    for (size_t k = 0; k < n; k++) {
        const char *slash = memchr(start[k], '/', length[k]);
        size_t size = slash == NULL ? length[k] : (size_t)(slash - start[k]);

        snprintf(name, sizeof name, "%.*s", (int)(size < PATH ? size : PATH - 1), start[k]);
        add_name(r, name);
        for (size_t c = 0; c < r->table->columns; c++) {
            struct column *column = &r->table->column[c];

            if (column->found || strcmp(column->name, name) != 0)
                continue;
            column->found = true;
            where[c] = k;
            if (slash != NULL)
                snprintf(column->unit, sizeof column->unit, "%.*s", (int)(length[k] - size - 1),
                         slash + 1);
        }
    }
}

static void
read_lines(struct reading *r)
{
    const char **start = tool_room(r->tool, CELLS, sizeof *start, "a table"), *end;
    size_t *length = tool_room(r->tool, CELLS, sizeof *length, "a table"), cells, n;
    RC_OWNED size_t *where = tool_room(r->tool, r->table->columns, sizeof *where, "a table");
    char text[128];

    end = line_end(r);
    r->separator = memchr(r->at, '\t', (size_t)(end - r->at)) != NULL ? '\t' : ',';
    n = split(r, end, start, length);
    read_heading(r, start, length, n, where);
    begin_piece(r);
    while (r->line++, end < r->end && (r->at = end + 1) < r->end) {
        end = line_end(r);
        if (end == r->at || *r->at == '\r')
            continue;
        if ((cells = split(r, end, start, length)) != n) {
            snprintf(text, sizeof text, "it has %zu columns, the heading has %zu", cells, n);
            bad(r, text);
        }
        for (size_t c = 0; c < r->table->columns; c++)
            put(r, c, r->table->rows,
                where[c] == CELLS ? NAN
                                  : any_value(r, c, start[where[c]], length[where[c]], false));
        r->table->rows++;
    }
    free(start);
    free(length);
}

/* ---- JSON ---- */

static void read_value(struct reading *r, bool element);

static char
peek(struct reading *r)
{
    while (r->at < r->end && strchr(" \t\r\n", *r->at) != NULL && *r->at != '\0')
        r->line += *r->at++ == '\n';
    return r->at < r->end ? *r->at : '\0';
}

static void
expect(struct reading *r, char c)
{
    char text[64];

    if (peek(r) != c) {
        snprintf(text, sizeof text, "this is not JSON: '%c' is missing", c);
        bad(r, text);
    }
    r->at++;
}

/* Skips a string; escapes are not decoded. */
static void
read_string(struct reading *r, const char **start, size_t *n)
{
    expect(r, '"');
    *start = r->at;
    while (r->at < r->end && *r->at != '"' && *r->at != '\n')
        r->at += *r->at == '\\' && r->at + 1 < r->end ? 2 : 1;
    if (r->at >= r->end || *r->at != '"')
        bad(r, "this is not JSON: a text does not end");
    *n = (size_t)(r->at++ - *start);
}

/* True if the path of a value is the name of a column, or ends in a point and that name. Words need the whole
 * path: the report of rc-solve has the word "effects.height" before the number "height". */
static bool
is_named(const char *path, const char *name, bool words)
{
    size_t p = strlen(path), n = strlen(name);

    return (p == n || !words) && p >= n && strcmp(path + p - n, name) == 0 &&
           (p == n || path[p - n - 1] == '.');
}

/* A value as text in the file; `words`: it is in quotes. */
static void
take(struct reading *r, const char *text, size_t length, bool words, bool element)
{
    if (!element && r->table->rows == 0)
        add_name(r, r->path);
    for (size_t c = 0; c < r->table->columns; c++) {
        size_t n = r->got[c].n;

        if (!is_named(r->path, r->table->column[c].name, words && !element) || r->got[c].taken)
            continue;
        r->got[c].v = tool_grown(r->tool, r->got[c].v, n, &r->got[c].capacity, sizeof *r->got[c].v,
                                 "a table");
        r->got[c].v[n] = any_value(r, c, text, length, words);
        r->got[c].n++;
        r->got[c].array = element;
        r->got[c].taken = !element;
        r->table->column[c].found = true;
    }
}

static void
read_array(struct reading *r)
{
    char path[PATH];

    expect(r, '[');
    if (r->table->rows == 0)
        add_name(r, r->path);
    snprintf(path, sizeof path, "%s", r->path);
    if (peek(r) == ']')
        r->at++;
    else
        for (;;) {
            read_value(r, true);
            if (peek(r) == ']') {
                r->at++;
                break;
            }
            expect(r, ',');
        }
    for (size_t c = 0; c < r->table->columns; c++)
        r->got[c].taken = r->got[c].taken || r->got[c].n > 0;
}

static void
read_object(struct reading *r)
{
    size_t base = strlen(r->path), n;
    const char *key;

    expect(r, '{');
    if (peek(r) == '}') {
        r->at++;
        return;
    }
    for (;;) {
        peek(r);
        read_string(r, &key, &n);
        if (base + n + 2 > PATH)
            bad(r, "a name is longer than 500 bytes");
        snprintf(r->path + base, PATH - base, "%s%.*s", base == 0 ? "" : ".", (int)n, key);
        expect(r, ':');
        read_value(r, false);
        r->path[base] = '\0';
        if (peek(r) == '}') {
            r->at++;
            return;
        }
        expect(r, ',');
    }
}

static void
read_word(struct reading *r, bool element)
{
    const char *start = r->at;
    bool words = false;

    while (r->at < r->end && (isalnum((unsigned char)*r->at) || strchr("+-.", *r->at) != NULL) &&
           *r->at != '\0')
        r->at++;
    cell_value(start, (size_t)(r->at - start), &words);
    if (words || r->at == start)
        bad(r, "this is not JSON: a value is not a number, text, true, false or null");
    take(r, start, (size_t)(r->at - start), false, element);
}

static void
read_value(struct reading *r, bool element)
{
    const char *text;
    size_t n;

    if (++r->depth > INSIDE)
        bad(r, "its JSON is nested too deep");
    switch (peek(r)) {
    case '{':
        read_object(r);
        break;
    case '[':
        read_array(r);
        break;
    case '"':
        read_string(r, &text, &n);
        take(r, text, n, true, element);
        break;
    default:
        read_word(r, element);
    }
    r->depth--;
}

/* Converts an object to a row or, with arrays, to a piece with a row for each element. */
static void
add_rows(struct reading *r)
{
    struct table *table = r->table;
    size_t rows = 1;
    bool arrays = false;
    char text[128];

    for (size_t c = 0; c < table->columns; c++) {
        if (!r->got[c].array || r->got[c].n == 0)
            continue;
        if (arrays && r->got[c].n != rows) {
            snprintf(text, sizeof text, "its arrays have %zu and %zu values", rows, r->got[c].n);
            bad(r, text);
        }
        rows = r->got[c].n;
        arrays = true;
    }
    if (arrays || table->pieces == 0)
        begin_piece(r);
    for (size_t c = 0; c < table->columns; c++) {
        for (size_t k = 0; k < rows; k++)
            put(r, c, table->rows + k,
                r->got[c].n == 0  ? NAN
                : r->got[c].array ? r->got[c].v[k]
                                  : r->got[c].v[0]);
        r->got[c].n = 0;
        r->got[c].array = r->got[c].taken = false;
    }
    table->rows += rows;
}

static void
read_json(struct reading *r)
{
    r->got = tool_room(r->tool, r->table->columns, sizeof *r->got, "a table");
    while (peek(r) != '\0') {
        if (*r->at != '{')
            bad(r, "this is not JSON: an object has to begin with '{'");
        read_value(r, false);
        add_rows(r);
    }
    for (size_t c = 0; c < r->table->columns; c++)
        free(r->got[c].v);
    free(r->got);
}

/* ---- the whole ---- */

static void
check_columns(struct reading *r)
{
    const struct table *table = r->table;
    char meant[NAME_MEANT];

    for (size_t c = 0; c < table->columns; c++) {
        const struct column *column = &table->column[c];
        bool any = false;

        if (column->optional)
            continue;
        if (!column->found)
            tool_die(r->tool, "%s: there is no column %s: there are %s%s", table->source,
                     column->name, name_list_end(&r->there), name_meant(column->nearest, meant));
        for (size_t k = 0; k < table->rows; k++)
            any = any || isfinite(column->v[k]);
        if (!any)
            tool_die(r->tool, "%s: column %s holds no %s%s", table->source, column->name,
                     column->label ? "value" : "number", column->words ? ", but words" : "");
    }
}

void
table_read(struct table *table, struct tool *t, const char *file)
{
    struct reading r = {.tool = t, .table = table, .line = 1};
    bool standard = strcmp(file, "-") == 0;
    FILE *in = standard ? stdin : fopen(file, "rb");
    size_t size;
    char *text;

    table->source = standard ? "standard input" : file;
    if (in == NULL)
        tool_die(t, "%s: %s", file, strerror(errno));
    if (isatty(fileno(in)))
        tool_usage(t, "%s is a terminal: pipe a table in or name a file", table->source);
    text = read_file(t, table->source, in, &size);
    if (!standard)
        fclose(in);
    r.at = text;
    r.end = text + size;
    if (strncmp(text, "RCG", 3) == 0)
        tool_die(t,
                 "%s is a grid stream: --curve draws tables, such as rc-solve --report FILE.tsv "
                 "writes; of a map draw a line with --cut, or leave out --curve",
                 table->source);
    if (size == 0)
        tool_die(t, "%s is empty: there is no table to draw", table->source);
    if (memchr(text, '\0', size) != NULL)
        tool_die(t, "%s is not a table: it holds binary data", table->source);
    if (peek(&r) == '{')
        read_json(&r);
    else
        read_lines(&r);
    free(text);
    if (table->rows == 0)
        tool_die(t, "%s: the table has a heading and no row", table->source);
    check_columns(&r);
}

void
table_free(struct table *table)
{
    for (size_t c = 0; c < table->columns; c++) {
        for (size_t k = 0; k < table->column[c].word_count; k++)
            free(table->column[c].word[k]);
        free(table->column[c].word);
        free(table->column[c].v);
    }
    free(table->piece);
}
