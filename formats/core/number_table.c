/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "number_table.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "header.h"

enum {
    NUMBER_MOST = 400 /* most characters of one number */
};

static bool
ends_line(char c)
{
    return c == '\n' || c == '\r';
}

/* White space other than the separator. */
static bool
is_blank(const struct rc_number_table *t, char c)
{
    return c == ' ' || (c == '\t' && t->separator != '\t');
}

static const char *
skip_blanks(const struct rc_number_table *t, const char *s)
{
    while (s < t->end && is_blank(t, *s))
        s++;
    return s;
}

static bool
ends_field(const struct rc_number_table *t, const char *s)
{
    return s == t->end || ends_line(*s) || is_blank(t, *s) || *s == t->separator;
}

/* ---- numbers ---- */

struct number {
    uint64_t digits; /* all digits as one integer, as long as it is exact in a double */
    int power;       /* the power of ten for the digits                                        */
    bool exact;      /* true: the two above give the number exactly */
    char mark;       /* decimal mark met, or 0                                                 */
    const char *mark_at;
};

static bool
is_digit(const struct rc_number_table *t, const char *s)
{
    return s < t->end && *s >= '0' && *s <= '9';
}

/* Reads digits from s on; after 2^53 they are only counted. */
static const char *
gather(const struct rc_number_table *t, const char *s, struct number *n, bool fraction)
{
    for (; is_digit(t, s); s++) {
        if (n->digits >= (UINT64_C(1) << 53) / 10 - 1)
            n->exact = false;
        else {
            n->digits = 10 * n->digits + (uint64_t)(*s - '0');
            n->power -= fraction;
        }
    }
    return s;
}

static const char *
gather_power(const struct rc_number_table *t, const char *s, struct number *n)
{
    const char *digit = s + 1;
    bool minus = digit < t->end && *digit == '-';
    int power = 0;

    if (digit < t->end && (*digit == '-' || *digit == '+'))
        digit++;
    if (!is_digit(t, digit))
        return s;
    for (; is_digit(t, digit); digit++)
        if (power < 10000)
            power = 10 * power + (*digit - '0');
    n->power += minus ? -power : power;
    return digit;
}

/* The slow way takes any number of digits and rounds correctly. */
static bool
read_slowly(const char *start, const char *end, const char *mark_at, const char *power_at,
            double *value)
{
    char copy[NUMBER_MOST + 1];
    size_t n = (size_t)(end - start);
    const char *stop;

    if (n > NUMBER_MOST)
        return false;
    memcpy(copy, start, n);
    copy[n] = '\0';
    if (mark_at != NULL)
        copy[mark_at - start] = '.';
    if (power_at != NULL)
        copy[power_at - start] = 'e';
    stop = rc_number_read(copy, false, value);
    return stop != NULL && *stop == '\0' && isfinite(*value);
}

/* The number at s and where it ends, or NULL when there is none. Up to 2^53 and 10^22 both parts
 * are exact in a double, so that one multiplication or division rounds correctly. */
static const char *
read_number(const struct rc_number_table *t, const char *s, char decimal, struct number *n,
            double *value)
{
    static const double tens[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const char *start = s, *digits, *whole, *power_at = NULL;
    bool minus = s < t->end && *s == '-';

    *n = (struct number){.exact = true};
    if (s < t->end && (*s == '-' || *s == '+'))
        s++;
    digits = s;
    s = whole = gather(t, s, n, false);
    if (s < t->end && *s != t->separator &&
        (decimal == 0 ? *s == '.' || *s == ',' : *s == decimal)) {
        n->mark = *s;
        n->mark_at = s;
        s = gather(t, s + 1, n, true);
        whole = s - 1;
    }
    if (whole == digits)
        return NULL;
    if (s < t->end &&
        ((*s | 0x20) == 'e' || (*s | 0x20) == 'd')) { /* D: as Fortran writes doubles */
        power_at = s;
        s = gather_power(t, s, n);
        power_at = s > power_at ? power_at : NULL;
    }
    if (!n->exact || n->power < -22 || n->power > 22)
        return read_slowly(start, s, n->mark_at, power_at, value) ? s : NULL;
    *value =
        n->power < 0 ? (double)n->digits / tens[-n->power] : (double)n->digits * tens[n->power];
    if (minus)
        *value = -*value;
    return s;
}

/* ---- words ---- */

static bool
is_missing(const struct rc_number_table *t, const char *s, size_t n)
{
    if (t->missing != NULL && strlen(t->missing) == n && memcmp(t->missing, s, n) == 0)
        return true;
    /* some C libraries print NaN as one of the last three words */
    return rc_piece_is((struct rc_piece){s, n}, "nan|na|n/a|bad|--|---|-nan|1.#qnan|-1.#ind");
}

/* The value of one field; s is at its first character. The first number with a mark determines *decimal. NULL
 * if it is neither a number nor missing. */
static const char *
read_field(const struct rc_number_table *t, const char *s, char *decimal, double *value)
{
    struct number n;
    const char *end = read_number(t, s, *decimal, &n, value);

    if (end != NULL && ends_field(t, end)) {
        if (n.mark != 0)
            *decimal = n.mark;
        if (*value == t->missing_number)
            *value = NAN;
        return end;
    }
    for (end = s; !ends_field(t, end);)
        end++;
    if (rc_piece_infinite((struct rc_piece){s, (size_t)(end - s)}, value))
        return end;
    *value = NAN;
    return is_missing(t, s, (size_t)(end - s)) ? end : NULL;
}

/* The same for a field in quotes; an empty or blank field is a missing value. */
static const char *
read_quoted(const struct rc_number_table *t, const char *s, char *decimal, double *value)
{
    struct rc_number_table inside = *t;
    struct rc_piece piece;
    const char *shut = ++s;

    while (shut < t->end && *shut != '"' && !ends_line(*shut))
        shut++;
    if (shut == t->end || *shut != '"' || !ends_field(t, shut + 1))
        return NULL;
    piece = rc_piece_trim((struct rc_piece){s, (size_t)(shut - s)});
    *value = NAN;
    if (piece.n == 0)
        return shut + 1;
    inside.end = piece.text + piece.n;
    inside.separator = '\0'; /* a comma there separates no columns */
    return read_field(&inside, piece.text, decimal, value) == inside.end ? shut + 1 : NULL;
}

static const char *
separator_name(char c)
{
    return c == '\t' ? "tabs" : c == ',' ? "commas" : c == ';' ? "semicolons" : "another character";
}

static enum rc_status
bad_field(const struct rc_number_table *t, size_t line, const char *s, char decimal,
          struct rc_err *err)
{
    const char *end = s;
    char quote[RC_SHOWN], other = decimal == '.' ? ',' : '.';

    if (s == NULL)
        return rc_err_set(err,
                          "line %zu: two values with white space between them, but columns are "
                          "separated by %s: give --separator",
                          line, separator_name(t->separator));
    while (!ends_field(t, end))
        end++;
    rc_text_shown_to(quote, s, (size_t)(end - s));
    if (decimal != 0 && memchr(s, other, (size_t)(end - s)) != NULL)
        return rc_err_set(
            err,
            "line %zu: '%s' is not a number with the decimal mark '%c': give --decimal "
            "and --separator",
            line, quote, decimal);
    return rc_err_set(
        err,
        "line %zu: '%s' is not a number: give --separator for the columns, or --missing "
        "WORD for missing values",
        line, quote);
}

/* Reads one row from s, which is not at an empty line. Values beyond `most` are counted, not
 * stored. Returns the end of the row, before its line end; or NULL, with *bad at the field that is
 * wrong. */
static const char *
read_row(const struct rc_number_table *t, const char *s, size_t most, double *v, size_t *count,
         char *decimal, const char **bad)
{
    bool strict = t->separator != ' ', after = false; /* after: a separator came just before */
    double value;

    *count = 0;
    *bad = NULL;
    for (;;) {
        s = skip_blanks(t, s);
        if (s == t->end || ends_line(*s)) {
            if (strict && after && *count + 1 == most)
                v[(*count)++] = NAN;
            return s;
        }
        if (strict && *s == t->separator) {
            value = NAN; /* nothing before it */
        } else {
            *bad = s;
            s = *s == '"' ? read_quoted(t, s, decimal, &value) : read_field(t, s, decimal, &value);
            if (s == NULL)
                return NULL;
            s = skip_blanks(t, s);
        }
        if (*count < most)
            v[*count] = value;
        ++*count;
        after = strict && s < t->end && *s == t->separator;
        if (after)
            s++;
        else if (strict && s < t->end && !ends_line(*s)) {
            *bad = NULL; /* two values with only white space between them */
            return NULL;
        }
    }
}

/* ---- lines ---- */

/* The first row from s on, past empty lines and comments; counts lines. */
static const char *
next_row(const struct rc_number_table *t, const char *s, size_t *line)
{
    for (;;) {
        s = skip_blanks(t, s);
        if (s == t->end)
            return s;
        if (*s == '#' || *s == '%')
            while (s < t->end && !ends_line(*s))
                s++;
        else if (!ends_line(*s))
            return s;
        if (s < t->end) {
            s += *s == '\r' && s + 1 < t->end && s[1] == '\n' ? 2 : 1;
            ++*line;
        }
    }
}

static const char *
line_end(const struct rc_number_table *t, const char *s)
{
    while (s < t->end && !ends_line(*s))
        s++;
    return s;
}

/* How often the character is there outside quotes. */
static size_t
count_of(const char *s, const char *end, char c)
{
    size_t n = 0;
    bool quoted = false;

    for (; s < end; s++) {
        quoted = quoted != (*s == '"');
        n += !quoted && *s == c;
    }
    return n;
}

/* Commas outside quotes with white space on a side. */
static size_t
loose_commas(const char *s, const char *end)
{
    size_t n = 0;
    bool quoted = false;

    for (const char *c = s; c < end; c++) {
        quoted = quoted != (*c == '"');
        if (!quoted && *c == ',' && ((c > s && (c[-1] == ' ')) || c + 1 == end || c[1] == ' '))
            n++;
    }
    return n;
}

static bool
has_quotes(const struct rc_number_table *t)
{
    return memchr(t->start, '"', (size_t)(line_end(t, t->start) - t->start)) != NULL;
}

/* The separator, from the first row. A comma is a separator if the row also has points, or if every comma has
 * white space next to it. It is one, too, if the row has no other white space. */
static enum rc_status
find_separator(struct rc_number_table *t, const char *s, size_t line, struct rc_err *err)
{
    const char *end = line_end(t, s);
    size_t commas, loose;

    while (end > s && (end[-1] == ' ' || end[-1] == '\t'))
        end--;
    commas = count_of(s, end, ',');
    loose = loose_commas(s, end);
    if (count_of(s, end, ';') > 0)
        t->separator = ';';
    else if (count_of(s, end, '\t') > 0)
        t->separator = '\t';
    else if (commas == 0 || (t->decimal == ',' && !has_quotes(t)))
        t->separator = ' ';
    else if (count_of(s, end, '.') > 0 || loose == commas || count_of(s, end, ' ') == 0 ||
             t->decimal == '.')
        t->separator = ',';
    else if (loose == 0)
        t->separator = ' ';
    else
        return rc_err_set(err,
                          "line %zu: some commas look like decimal marks, others like separators: "
                          "give --decimal and --separator",
                          line);
    return RC_OK;
}

/* RC_FAIL where "1,5" may be two columns of whole numbers or one of fractions: only the user knows
 * which. */
static enum rc_status
refuse_ambiguous_comma(const struct rc_number_table *t, const struct rc_wish *wish,
                       struct rc_err *err)
{
    if (t->columns != 2 || has_quotes(t) || t->separator != ',' || wish->separator != NULL ||
        wish->decimal != 0 || memchr(t->start, '.', (size_t)(t->end - t->start)) != NULL ||
        memchr(t->start, ' ', (size_t)(t->end - t->start)) != NULL)
        return RC_OK;
    return rc_err_set(
        err,
        "line %zu: the comma may be a decimal mark or a separator: give --decimal or --separator",
        t->first_line);
}

enum rc_status
rc_number_table_open(struct rc_number_table *t, const struct rc_lines *lines,
                     const struct rc_wish *wish, struct rc_err *err)
{
    const char *s, *end, *bad;
    size_t line = lines->number + 1;
    char decimal;

    *t = (struct rc_number_table){.start = lines->at,
                                  .end = lines->end,
                                  .first_line = line,
                                  .separator = wish->separator == NULL ? '\0' : wish->separator[0],
                                  .decimal = wish->decimal,
                                  .missing = wish->missing};
    t->missing_number = NAN;
    if (t->missing != NULL &&
        ((end = rc_number_read(t->missing, false, &t->missing_number)) == NULL || *end != '\0'))
        t->missing_number = NAN;
    s = next_row(t, t->start, &line);
    if (s == t->end)
        return rc_err_set(err, "there are no numbers in the file");
    t->start = s;
    t->first_line = line;
    if (t->separator == '\0' && find_separator(t, s, line, err) != RC_OK)
        return RC_FAIL;
    while (t->separator == '\t' && t->start > lines->at && t->start[-1] == '\t')
        s = --t->start; /* there is a missing value before it */
    if (t->separator == ',' && t->decimal == ',' && !has_quotes(t))
        return rc_err_set(err, "the comma cannot be separator and decimal mark at once");
    if (t->separator == ',' && t->decimal == 0 && !has_quotes(t))
        t->decimal = '.'; /* in quotes a comma may be the decimal mark */
    decimal = t->decimal;
    if ((s = read_row(t, s, 0, NULL, &t->columns, &decimal, &bad)) == NULL)
        return bad_field(t, line, bad, decimal, err);
    for (t->rows = 1; (s = next_row(t, s, &line)) < t->end; t->rows++)
        s = line_end(t, s);
    return refuse_ambiguous_comma(t, wish, err);
}

enum rc_status
rc_number_table_size(const struct rc_number_table *t, size_t *n, struct rc_err *err)
{
    size_t bytes = (size_t)(t->end - t->start);

    if (rc_size_mul(t->rows, t->columns, n, err) != RC_OK)
        return RC_FAIL;
    if (*n > bytes + 1) /* each value except the last takes at least one byte */
        return rc_err_set(err, "%zu columns and %zu rows in %zu bytes: some row is too short",
                          t->columns, t->rows, bytes);
    return RC_OK;
}

enum rc_status
rc_number_table_read(struct rc_number_table *t, double *v, struct rc_err *err)
{
    const char *s = t->start, *bad;
    size_t line = t->first_line, count;

    for (size_t j = 0; j < t->rows; j++, v += t->columns) {
        if ((s = read_row(t, s, t->columns, v, &count, &t->decimal, &bad)) == NULL)
            return bad_field(t, line, bad, t->decimal, err);
        if (count != t->columns)
            return rc_err_set(err, "line %zu: %zu values, where the first row (line %zu) has %zu",
                              line, count, t->first_line, t->columns);
        s = next_row(t, s, &line);
    }
    return RC_OK;
}

enum rc_status
rc_number_table_edges(const struct rc_number_table *t, double *row, double *column,
                      struct rc_err *err)
{
    const char *s = t->start, *bad, *here;
    size_t line = t->first_line, count;
    char decimal = t->decimal;

    if ((here = read_row(t, s, t->columns, row, &count, &decimal, &bad)) == NULL)
        return bad_field(t, line, bad, decimal, err);
    for (size_t j = 0; j < t->rows; j++) {
        double *first = &column[j];

        here = skip_blanks(t, s);
        *first = NAN;
        if (*here != t->separator || t->separator == ' ')
            if ((*here == '"' ? read_quoted(t, here, &decimal, first)
                              : read_field(t, here, &decimal, first)) == NULL)
                return bad_field(t, line, here, decimal, err);
        s = next_row(t, line_end(t, s), &line);
    }
    return RC_OK;
}
