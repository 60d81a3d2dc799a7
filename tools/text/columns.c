/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "columns.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "formats/core/core.h"
#include "libcontact/owned.h"
#include "name_list.h"

enum {
    CELL = 48,                 /* largest size of a number, a name or a unit, with its end */
    LARGEST = 8 * 1024 * 1024, /* bytes of a file                                          */
    JOINED = 3                 /* most words of a name between blanks                      */
};

struct cell {
    const char *at;
    size_t n;
};
#define SHOWN(cell) (int)(cell).n, (cell).at /* for %.*s */

struct reading {
    const struct wanted_column *wanted;
    size_t kinds;
    struct columns *to;
    size_t line, lines;        /* number of the line, and of all */
    char separator;            /* of the line */
    size_t n;                  /* columns of the file; 0: not yet known */
    size_t kind[COLUMNS_MOST]; /* of a column of the file: index of `wanted` */
    char unit[COLUMNS_MOST][CELL];
    unsigned present; /* bits of the wanted columns in the heading */
    bool must_be_headed;
    bool decimal_comma;             /* a number shows that commas are decimal marks */
    bool headed, in_comment, units; /* there is a heading; in a comment; it has units */
};

/* ---- cells ---- */

static struct cell
trimmed(struct cell c)
{
    while (c.n > 0 && (c.at[0] == ' ' || c.at[0] == '"')) {
        c.at++;
        c.n--;
    }
    while (c.n > 0 && (c.at[c.n - 1] == ' ' || c.at[c.n - 1] == '"'))
        c.n--;
    return c;
}

/* The length of the first cell of a line. Between quotes a separator is part of the cell. */
static size_t
length_of_cell(const char *line, char separator)
{
    const char *open = line + strspn(line, " ");
    const char *close = *open == '"' ? strchr(open + 1, '"') : NULL;

    if (close != NULL) {
        close += 1 + (separator == ' ' ? 0 : strspn(close + 1, " "));
        if (*close == separator || *close == '\0')
            return (size_t)(close - line);
    }
    return strcspn(line, (char[]){separator, '\0'});
}

/* The cells of a line, at most one more than a table may have. Tabs and blanks may be repeated, and a last
 * semicolon or comma ends the line. */
static size_t
split(struct reading *r, const char *line, struct cell cell[COLUMNS_MOST + 1])
{
    static const char separators[] = "\t;, ";
    const char *s = separators, *end = line + strlen(line);
    size_t n = 0;

    while (s[1] != '\0' && line[length_of_cell(line, *s)] != *s)
        s++;
    r->separator = *s;
    while (line < end && n <= COLUMNS_MOST) {
        const size_t length = length_of_cell(line, *s);
        const struct cell c = trimmed((struct cell){line, length});

        line += length + 1;
        if (c.n > 0 || (line <= end && (*s == ';' || *s == ',')))
            cell[n++] = c;
    }
    while (n > 0 && cell[n - 1].n == 0)
        n--;
    return n;
}

/* The same cells with all that are empty, between tabs too. True: there is one for each column. */
static bool
split_with_empty(const struct reading *r, const char *line, struct cell cell[COLUMNS_MOST + 1])
{
    for (size_t n = 0; r->separator != ' '; n++) {
        const size_t length = length_of_cell(line, r->separator);
        const struct cell c = trimmed((struct cell){line, length});

        if (n == r->n && c.n > 0)
            return false;
        if (n < r->n)
            cell[n] = c;
        if (line[length] == '\0')
            return n + 1 >= r->n;
        line += length + 1;
    }
    return false;
}

/* False: it is too long; text then has its begin, without a cut character. */
static bool
copy(struct cell c, char text[CELL])
{
    size_t n = c.n < CELL ? c.n : CELL - 1;

    while (n > 0 && n < c.n && ((unsigned char)c.at[n] & 0xc0U) == 0x80)
        n--;
    snprintf(text, CELL, "%.*s", (int)n, c.at);
    return c.n < CELL;
}

static bool
is_number(struct cell c)
{
    char text[CELL];
    double value;

    copy(c, text);
    return rc_number_read(text, false, &value) != NULL;
}

/* ---- headings ---- */

static struct cell
first_name(const struct wanted_column *w)
{
    return (struct cell){w->names, strcspn(w->names, " ")};
}

/* The index of the wanted column with this name; r->kinds: none. */
static size_t
find_name(const struct reading *r, struct cell c)
{
    char name[CELL];
    size_t n = 0;

    for (size_t k = 0; k < c.n && n + 1 < CELL; k++)
        if (strchr(" _-.", c.at[k]) == NULL)
            name[n++] = (char)tolower((unsigned char)c.at[k]);
    for (size_t k = 0; k < r->kinds && n > 0; k++)
        for (const char *s = r->wanted[k].names; *s != '\0'; s += strspn(s, " ")) {
            const size_t length = strcspn(s, " ");
            if (length == n && strncasecmp(s, name, n) == 0)
                return k;
            s += length;
        }
    return r->kinds;
}

/* The same for a name and a symbol, as "Storage modulus E'". */
static size_t
find(const struct reading *r, struct cell c)
{
    size_t found = find_name(r, c);

    for (size_t k = c.n; k-- > 1 && found == r->kinds;)
        if (c.at[k] == ' ') {
            const size_t name = find_name(r, (struct cell){c.at, k});
            const size_t symbol = find_name(r, (struct cell){c.at + k + 1, c.n - k - 1});
            found = name == symbol ? name : found;
        }
    return found;
}

/* True for a column beside others that make it unnecessary. */
static bool
is_spare(const struct reading *r, size_t kind)
{
    return (r->wanted[kind].spare & r->present) != 0;
}

/* Parts "E/MPa", "E (MPa)", "E [MPa]" and "E/(N/mm2)" into a name and a unit. A name may have brackets, as
 * E(t) has. */
static void
part(const struct reading *r, struct cell c, struct cell *name, struct cell *unit)
{
    const char *slash = memchr(c.at, '/', c.n);
    size_t open = c.n;

    *name = c;
    *unit = (struct cell){c.at, 0};
    if (find(r, c) < r->kinds)
        return;
    if (c.n > 0 && (c.at[c.n - 1] == ')' || c.at[c.n - 1] == ']'))
        while (open > 0 && c.at[open - 1] != '(' && c.at[open - 1] != '[')
            open--;
    if (open < c.n && open > 0) {
        *unit = trimmed((struct cell){c.at + open, c.n - open - 1});
        c.n = open - 1;
        c = trimmed(c);
        c.n -= c.n > 0 && c.at[c.n - 1] == '/';
        *name = trimmed(c);
    } else if (slash != NULL) {
        *name = trimmed((struct cell){c.at, (size_t)(slash - c.at)});
        *unit = trimmed((struct cell){slash + 1, (size_t)(c.at + c.n - slash - 1)});
    }
}

static size_t
find_part(const struct reading *r, struct cell c)
{
    struct cell name, unit;

    part(r, c, &name, &unit);
    return find(r, name);
}

/* Joins words between blanks to names, and a unit in brackets or after a slash to its name. */
static size_t
join(const struct reading *r, size_t n, struct cell cell[])
{
    size_t joined = 0;

    for (size_t i = 0; i < n && r->separator == ' ';) {
        const char *start = cell[i].at, *end = start + cell[i].n;
        size_t last = i;

        for (size_t k = i; k < n && k < i + JOINED; k++) {
            const struct cell c = {start, (size_t)(cell[k].at + cell[k].n - start)};
            if (find_part(r, c) < r->kinds)
                last = k;
            if (memchr(cell[k].at, '/', cell[k].n) != NULL)
                break; /* a unit ends the name */
        }
        end = cell[last].at + cell[last].n;
        while (last + 1 < n && (strchr("([/", cell[last + 1].at[0]) != NULL || end[-1] == '/'))
            last++, end = cell[last].at + cell[last].n;
        cell[joined++] = (struct cell){start, (size_t)(end - start)};
        i = last + 1;
    }
    return r->separator == ' ' ? joined : n;
}

static enum rc_status
unknown(const struct reading *r, const char *name, struct rc_err *err)
{
    struct name_list list = {.asked = name};
    const char *names;
    char known[CELL];

    for (size_t k = 0; k < r->kinds; k++) {
        if (r->wanted[k].refused != NULL)
            continue;
        copy(first_name(&r->wanted[k]), known);
        name_list_add(&list, known);
    }
    names = name_list_end(&list);
    return rc_err_set(err, "there is no column '%s': the columns are %s%s", name, names,
                      strchr(names, '?') != NULL ? "" : ": remove it from the table");
}

/* "depth, bending, torsion[, yield]" */
static const char *
wanted_text(const struct reading *r, char text[], size_t size)
{
    size_t used = 0;

    text[0] = '\0';
    for (size_t k = 0; k < r->kinds && used < size; k++)
        if (r->wanted[k].spare == 0 && r->wanted[k].refused == NULL)
            used += (size_t)snprintf(text + used, size - used, "%s%s%.*s%s",
                                     r->wanted[k].optional ? "[" : "", used > 0 ? ", " : "",
                                     SHOWN(first_name(&r->wanted[k])),
                                     r->wanted[k].optional ? "]" : "");
    return text;
}

/* ---- numbers ---- */

/* "1,234": a comma between tabs may separate thousands. "0,001", "1,5" and "3,007985" have a decimal
 * comma. */
static bool
may_be_thousands(const char *text)
{
    const char *digits = "0123456789";
    const size_t sign = strspn(text, "+-"), whole = strspn(text + sign, digits);
    const char *comma = text + sign + whole;
    const size_t part = *comma == ',' ? strspn(comma + 1, digits) : 1;

    return whole >= 1 && whole <= 3 && text[sign] != '0' && (part == 0 || part == 3);
}

/* True for a number whose only comma can only be the decimal mark. */
static bool
must_be_decimal(const char *text)
{
    const char *digits = "0123456789", *s = text + strspn(text, "+-");
    const size_t whole = strspn(s, digits),
                 part = s[whole] == ',' ? strspn(s + whole + 1, digits) : 0;

    return whole > 0 && part > 0 && strpbrk(s + whole + 1, ",.") == NULL && !may_be_thousands(text);
}

/* True if the text is a number in quotes whose comma can only be the decimal mark. */
static bool
quoted_decimal(const char *text)
{
    const size_t n = *text == '"' ? strcspn(text + 1, "\"\r\n") : 0;
    char number[CELL];

    return n > 0 && text[1 + n] == '"' && copy((struct cell){text + 1, n}, number) &&
           must_be_decimal(number);
}

/* True if a number between tabs or in quotes shows that the commas of the file are decimal marks. */
static bool
has_decimal_comma(const char *file)
{
    const char *ends = "\t\r\n#";
    bool comment = false;
    bool after_tab = false;
    char text[CELL];

    for (const char *s = file; *s != '\0'; s++) {
        comment = *s != '\n' && (comment || *s == '#');
        if (!comment && quoted_decimal(s))
            return true;
    }
    for (const char *s = file; *s != '\0';) {
        const size_t n = strcspn(s, ends);
        if ((after_tab || s[n] == '\t') && copy(trimmed((struct cell){s, n}), text) &&
            must_be_decimal(text))
            return true;
        s += n + (s[n] == '#' ? strcspn(s + n, "\n") : 0);
        after_tab = *s == '\t' || (after_tab && n == 0 && *s != '\n' && *s != '\r');
        s += *s != '\0';
    }
    return false;
}

/* The value of a cell in column c of the file. Its own unit replaces that of the heading. */
static enum rc_status
read_value(const struct reading *r, size_t c, struct cell cell, double *value, struct rc_err *err)
{
    const struct wanted_column *w = &r->wanted[r->kind[c]];
    const struct cell name = first_name(w);
    const char *unit = r->unit[c], *end;
    char text[2 * CELL], *comma;
    struct rc_err why;
    bool percent;

    if (!copy(cell, text) || (end = rc_number_read(text, false, value)) == NULL) {
        if (!w->infinite || strcasecmp(text, "inf") != 0)
            return rc_err_set(err, "%.*s: '%s' is not a number", SHOWN(name), text);
        *value = INFINITY;
        return RC_OK;
    }
    if ((comma = strchr(text, ',')) != NULL && r->separator != ';' && may_be_thousands(text) &&
        (!r->decimal_comma || strchr(comma + 1, ',') != NULL))
        return rc_err_set(err,
                          "%.*s: '%s': is its comma the decimal mark? separate columns by "
                          "semicolons then, or write a point",
                          SHOWN(name), text);
    if (comma != NULL && strchr(text, '.') == NULL) {
        *comma = '.';
        end = rc_number_read(text, false, value);
    }
    if (end[strspn(end, " ")] != '\0')
        unit = "";
    else if (w->needs_unit && unit[0] == '\0' && *value != 0)
        return rc_err_set(err, "%.*s: give its unit, in the heading as in %.*s/%.*s, or with %s",
                          SHOWN(name), SHOWN(name), (int)strcspn(unit_usual(w->unit), " "),
                          unit_usual(w->unit), text);
    percent = w->unit == UNIT_NONE && strcmp(unit, "%") == 0;
    snprintf(text + strlen(text), CELL, "%s", percent ? "" : unit);
    if (unit_number(text, w->unit, value, &why) != RC_OK)
        return rc_err_set(err, "%.*s: %s", SHOWN(name), why.text);
    *value /= percent ? 100 : 1;
    return RC_OK;
}

/* The unit of column c of the file; "-" and "1" are none. */
static enum rc_status
take_unit(struct reading *r, size_t c, struct cell unit, struct rc_err *err)
{
    double value;

    if (unit.n > 1 && strchr("([", unit.at[0]) != NULL)
        unit = (struct cell){unit.at + 1, unit.n - 2};
    if (unit.n == 1 && strchr("-1", unit.at[0]) != NULL)
        unit.n = 0;
    r->units = r->units || unit.n > 0;
    if (!copy(unit, r->unit[c]))
        return rc_err_set(err, "the unit '%s...' is too long", r->unit[c]);
    return unit.n == 0 || is_spare(r, r->kind[c])
               ? RC_OK
               : read_value(r, c, (struct cell){"1", 1}, &value, err);
}

static enum rc_status
take_units(struct reading *r, const struct cell cell[], struct rc_err *err)
{
    for (size_t c = 0; c < r->n; c++)
        if (take_unit(r, c, cell[c], err) != RC_OK)
            return RC_FAIL;
    return RC_OK;
}

/* ---- lines ---- */

static enum rc_status
read_heading(struct reading *r, size_t n, const struct cell cell[], struct rc_err *err)
{
    struct cell name, unit[COLUMNS_MOST];
    char text[512];

    r->n = n;
    r->headed = true;
    r->units = false;
    r->present = 0;
    for (size_t c = 0; c < n; c++) {
        part(r, cell[c], &name, &unit[c]);
        r->kind[c] = find(r, name);
        copy(name, text);
        if (r->kind[c] == r->kinds)
            return unknown(r, text, err);
        if (r->wanted[r->kind[c]].refused != NULL)
            return rc_err_set(err, "column '%s': %s", text, r->wanted[r->kind[c]].refused);
        if ((r->present & 1U << r->kind[c]) != 0)
            return rc_err_set(err, "there are two columns %.*s",
                              SHOWN(first_name(&r->wanted[r->kind[c]])));
        r->present |= 1U << r->kind[c];
    }
    if (take_units(r, unit, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < r->kinds; k++)
        if ((r->present & 1U << k) == 0 && !r->wanted[k].optional)
            return rc_err_set(err, "there is no column %.*s: a table must hold %s",
                              SHOWN(first_name(&r->wanted[k])), wanted_text(r, text, sizeof text));
    return RC_OK;
}

/* Without a heading the columns are in the order of `wanted`. */
static enum rc_status
take_order(struct reading *r, size_t n, struct rc_err *err)
{
    size_t least = 0, most = 0;
    char text[512];

    for (size_t k = 0; k < r->kinds; k++)
        if (r->wanted[k].spare == 0 && r->wanted[k].refused == NULL) {
            least += !r->wanted[k].optional;
            r->kind[most++] = k;
        }
    if (n < least || n > most)
        return rc_err_set(err, "it must hold %s, and has %zu value%s",
                          wanted_text(r, text, sizeof text), n, n == 1 ? "" : "s");
    r->n = n;
    return RC_OK;
}

static enum rc_status
read_row(struct reading *r, size_t n, const struct cell cell[], struct rc_err *err)
{
    struct columns *to = r->to;

    if (n != r->n)
        return rc_err_set(err, "it has %zu value%s, and the table %zu columns", n,
                          n == 1 ? "" : "s", r->n);
    for (size_t c = 0; c < n; c++) {
        double **v = &to->v[r->kind[c]];

        if (is_spare(r, r->kind[c]))
            continue;
        if (*v == NULL && (*v = malloc(r->lines * sizeof **v)) == NULL)
            return rc_err_set(err, "out of memory");
        if (read_value(r, c, cell[c], &(*v)[to->n], err) != RC_OK)
            return RC_FAIL;
    }
    to->line[to->n++] = r->line;
    return RC_OK;
}

/* A comment may be the heading, or the units below it, as programs write them. */
static enum rc_status
read_comment(struct reading *r, const char *line, size_t n, struct cell cell[], struct rc_err *err)
{
    struct cell word[COLUMNS_MOST + 1];
    struct rc_err why;
    size_t joined, known = 0;

    memcpy(word, cell, sizeof word);
    joined = join(r, n, word);
    while (known < joined && find_part(r, word[known]) < r->kinds)
        known++;
    if (known == joined && known > 1 && !r->units) {
        r->in_comment = true;
        return read_heading(r, joined, word, err);
    }
    if (r->in_comment && !r->units && (n == r->n || split_with_empty(r, line, cell)) &&
        take_units(r, cell, &why) != RC_OK) {
        memset(r->unit, 0, sizeof r->unit);
        r->units = false;
    }
    return RC_OK;
}

enum kind {
    NUMBERS,
    UNITS, /* words, and 1 for no unit */
    WORDS
};

static enum kind
kind_of(size_t n, const struct cell cell[])
{
    size_t words = 0, ones = 0;

    for (size_t c = 0; c < n; c++) {
        words += !is_number(cell[c]);
        ones += cell[c].n == 1 && cell[c].at[0] == '1';
    }
    return words == n ? WORDS : words > 0 && words + ones == n ? UNITS : NUMBERS;
}

static enum rc_status
read_line(struct reading *r, char *line, struct rc_err *err)
{
    struct cell cell[COLUMNS_MOST + 1], word[COLUMNS_MOST + 1];
    const char *start = line + strspn(line, " \t");
    const bool comment = *start == '#', soft = !r->headed || r->in_comment;
    enum kind kind;
    size_t n;

    if (comment)
        start += strspn(start, "# \t");
    else
        line[strcspn(line, "#")] = '\0';
    n = split(r, start, cell);
    kind = r->to->n > 0 ? NUMBERS : kind_of(n, cell);
    if (n == 0 || (comment && (!soft || kind == NUMBERS || n > COLUMNS_MOST)))
        return RC_OK;
    if (n > COLUMNS_MOST)
        return rc_err_set(err, "it has more than %d columns", COLUMNS_MOST);
    if (comment)
        return read_comment(r, start, n, cell, err);
    memcpy(word, cell, sizeof word);
    if (kind == WORDS && (!r->headed || (r->in_comment && find_part(r, word[0]) < r->kinds))) {
        r->in_comment = false;
        return read_heading(r, join(r, n, word), word, err);
    }
    if (kind != NUMBERS && r->headed && !r->units) {
        if (n == r->n || split_with_empty(r, line, cell))
            return take_units(r, cell, err);
        return rc_err_set(err, "it has %zu unit%s, and the table %zu columns: write - for no unit",
                          n, n == 1 ? "" : "s", r->n);
    }
    if (!r->headed && r->must_be_headed)
        return rc_err_set(err, "it must be a heading with the names of the columns");
    return r->n == 0 && take_order(r, n, err) != RC_OK ? RC_FAIL : read_row(r, n, cell, err);
}

/* ---- files ---- */

static void
close_file(FILE **file)
{
    if (*file != NULL)
        fclose(*file);
}

/* The text in UTF-8, from Latin-1: its bytes are the first 256 code points. */
static char *
widened(const char *text, struct rc_err *err)
{
    RC_OWNED char *wide = malloc(2 * strlen(text) + 1);
    size_t n = 0;

    if (wide == NULL)
        return rc_err_null(err, "out of memory");
    for (; *text != '\0'; text++)
        n += rc_utf8_put(wide + n, (unsigned char)*text);
    wide[n] = '\0';
    return rc_give(&wide);
}

/* The text of a file in UTF-8, with an end. A file with other bytes is in Latin-1. */
static char *
text_of(const char *file, struct rc_err *err)
{
    RC_ENDS(close_file) FILE *in = fopen(file, "rb");
    RC_OWNED char *text = malloc(LARGEST + 1);
    size_t n;

    if (in == NULL)
        return rc_err_null(err, "%s", strerror(errno));
    if (text == NULL)
        return rc_err_null(err, "out of memory");
    n = fread(text, 1, LARGEST + 1, in);
    if (ferror(in))
        return rc_err_null(err, "%s", strerror(errno));
    if (n > LARGEST)
        return rc_err_null(err, "a table of more than %d MiB is not read", LARGEST >> 20);
    if (memchr(text, '\0', n) != NULL)
        return rc_err_null(err, "it holds binary data: a table must be a text file");
    text[n] = '\0';
    return rc_utf8_valid(text) ? rc_give(&text) : widened(text, err);
}

bool
columns_file(const char *text)
{
    static const char *const endings[] = {".tsv", ".csv", ".txt", ".dat"};
    const size_t n = strlen(text);
    double value;
    bool table = rc_number_read(text, false, &value) == NULL;

    for (size_t k = 0; k < sizeof endings / sizeof *endings; k++)
        table = table || (n > 4 && strcmp(text + n - 4, endings[k]) == 0);
    return table;
}

enum rc_status
columns_read(struct columns *columns, const char *file, const struct wanted_column *wanted,
             size_t n, bool headed, struct rc_err *err)
{
    struct reading r = {
        .wanted = wanted, .kinds = n, .must_be_headed = headed, .to = columns, .lines = 1};
    RC_OWNED char *text = text_of(file, err);
    char *at = text;
    struct rc_err why;

    *columns = (struct columns){0};
    if (text == NULL)
        return RC_FAIL;
    for (const char *s = text; *s != '\0'; s++)
        r.lines += *s == '\n';
    r.decimal_comma = has_decimal_comma(text);
    if ((columns->line = malloc(r.lines * sizeof *columns->line)) == NULL)
        return rc_err_set(err, "out of memory");
    at += strncmp(at, "\xef\xbb\xbf", 3) == 0 ? 3 : 0; /* the byte order mark */
    for (char *next; at != NULL; at = next) {
        next = strchr(at, '\n');
        if (next != NULL)
            *next++ = '\0';
        at[strcspn(at, "\r")] = '\0';
        r.line++;
        if (read_line(&r, at, &why) != RC_OK)
            return rc_err_set(err, "line %zu: %s", r.line, why.text);
    }
    return columns->n > 0 ? RC_OK : rc_err_set(err, "there is no row of numbers");
}

void
columns_free(struct columns *c)
{
    free(c->line);
    for (size_t k = 0; k < COLUMNS_MOST; k++)
        free(c->v[k]);
    *c = (struct columns){0};
}
