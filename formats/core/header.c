/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "header.h"

#include <math.h>
#include <string.h>

#include "units.h"

enum {
    NUMBER_MOST = 64
};

static char
lower(char c)
{
    return (char)(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
}

static bool
same(const char *a, const char *b, size_t n)
{
    while (n > 0 && lower(*a) == lower(*b))
        a++, b++, n--;
    return n == 0;
}

struct rc_piece
rc_piece_of(const char *word)
{
    return (struct rc_piece){word, strlen(word)};
}

bool
rc_piece_begins(struct rc_piece piece, const char *word)
{
    return piece.n >= strlen(word) && same(piece.text, word, strlen(word));
}

bool
rc_piece_is(struct rc_piece piece, const char *words)
{
    size_t n = strcspn(words, "|");

    while (n != piece.n || !same(piece.text, words, n)) {
        if (words[n] == '\0')
            return false;
        words += n + 1;
        n = strcspn(words, "|");
    }
    return true;
}

const char *
rc_piece_find(struct rc_piece piece, const char *word)
{
    size_t n = strlen(word);
    const char *s = piece.text, *end = piece.text + piece.n;

    while ((size_t)(end - s) >= n && (s = memchr(s, *word, (size_t)(end - s) - n + 1)) != NULL) {
        if (memcmp(s, word, n) == 0)
            return s;
        s++;
    }
    return NULL;
}

struct rc_piece
rc_piece_trim(struct rc_piece piece)
{
    rc_trim(&piece.text, &piece.n);
    return piece;
}

struct rc_piece
rc_piece_bare(struct rc_piece piece)
{
    static const char *const pairs[] = {"\"\"", "[]", "()", "<>"};

    piece = rc_piece_trim(piece);
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs && piece.n >= 2; k++)
        if (piece.text[0] == pairs[k][0] && piece.text[piece.n - 1] == pairs[k][1])
            piece = rc_piece_trim((struct rc_piece){piece.text + 1, piece.n - 2});
    return piece;
}

struct rc_lines
rc_piece_lines(struct rc_piece piece)
{
    return (struct rc_lines){.at = piece.text, .end = piece.text + piece.n};
}

bool
rc_piece_part(struct rc_piece piece, const char *marks, struct rc_piece *before,
              struct rc_piece *after)
{
    for (size_t k = 0; k < piece.n; k++) {
        if (piece.text[k] == '\0' || strchr(marks, piece.text[k]) == NULL)
            continue;
        *before = rc_piece_trim((struct rc_piece){piece.text, k});
        *after = rc_piece_trim((struct rc_piece){piece.text + k + 1, piece.n - k - 1});
        return true;
    }
    return false;
}

bool
rc_piece_word(struct rc_piece *rest, const char *ends, struct rc_piece *word)
{
    size_t marks = strlen(ends), n;
    bool quoted;

    while (rest->n > 0 && memchr(ends, *rest->text, marks) != NULL)
        rest->text++, rest->n--;
    quoted = rest->n > 0 && *rest->text == '"' && memchr(rest->text + 1, '"', rest->n - 1) != NULL;
    for (n = quoted; n < rest->n; n++)
        if (quoted ? rest->text[n] == '"' : memchr(ends, rest->text[n], marks) != NULL)
            break;
    n += quoted;
    *word = rc_piece_bare((struct rc_piece){rest->text, n});
    rest->text += n;
    rest->n -= n;
    return n > 0;
}

/* Replaces the D of Fortran's exponents by e: 1.5D+03. */
static void
plain_power(char *s)
{
    for (; *s != '\0'; s++)
        if ((*s | 0x20) == 'd') {
            if (strchr("+-0123456789", s[1]) != NULL && s[1] != '\0')
                *s = 'e';
            return;
        } else if (strchr("+-.0123456789", *s) == NULL)
            return;
}

bool
rc_piece_number(struct rc_piece piece, double *value, struct rc_piece *rest)
{
    char copy[NUMBER_MOST];
    const char *end, *start = copy;
    size_t n;

    piece = rc_piece_trim(piece);
    n = piece.n < sizeof copy - 1 ? piece.n : sizeof copy - 1;
    memcpy(copy, piece.text, n);
    copy[n] = '\0';
    for (char *s = copy; *s != '\0'; s++)
        if (*s == ',')
            *s = '.';
    plain_power(copy);
    start += *copy == '+';
    if ((end = rc_number_read(start, true, value)) == NULL)
        return false;
    n = (size_t)(end - copy);
    if (n == sizeof copy - 1 && n < piece.n)
        return false; /* too long for a number */
    if (rest != NULL)
        *rest = rc_piece_trim((struct rc_piece){piece.text + n, piece.n - n});
    return true;
}

double
rc_piece_metres(struct rc_piece piece)
{
    double metres;

    return rc_length_unit(piece.text, piece.n, &metres) ? metres : NAN;
}

double
rc_piece_metres_in_capitals(struct rc_piece piece)
{
    static const struct {
        const char *name;
        double metres;
    } units[] = {{"M", 1},     {"MM", 1e-3},  {"UM", 1e-6},
                 {"NM", 1e-9}, {"PM", 1e-12}, {"IN", 25.4e-3}};

    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (rc_piece_is(piece, units[k].name))
            return units[k].metres;
    return rc_piece_metres(piece);
}

const char *
rc_piece_shown_to(char to[RC_SHOWN], struct rc_piece piece)
{
    return rc_text_shown_to(to, piece.text, piece.n);
}

enum rc_status
rc_piece_keep(struct rc_grid *g, const char *key, struct rc_piece piece, struct rc_err *err)
{
    return rc_text_keep(g, key, piece.text, piece.n, err);
}

/* Reads "300 nm" in metres; a number without a unit is in metres. */
static bool
read_length(struct rc_piece piece, double *metres)
{
    struct rc_piece rest;
    double number, unit = 1;

    if (!rc_piece_number(piece, &number, &rest))
        return false;
    if (rest.n > 0 && !rc_length_unit(rest.text, rest.n, &unit))
        return false;
    *metres = number * unit;
    return true;
}

enum rc_status
rc_field_take(const struct rc_field *field, size_t n, struct rc_piece key, struct rc_piece value,
              void *into, struct rc_err *err)
{
    for (size_t k = 0; k < n; k++) {
        void *at = (char *)into + field[k].at;

        if (!rc_piece_is(key, field[k].key))
            continue;
        if (field[k].kind == RC_FIELD_TEXT)
            memcpy(at, &value, sizeof value);
        else if (field[k].kind == RC_FIELD_NUMBER ? !rc_piece_number(value, at, NULL)
                                                  : !read_length(value, at))
            return rc_err_set(err, "%s is '%s', but must be a %s", field[k].key,
                              rc_piece_shown(value),
                              field[k].kind == RC_FIELD_NUMBER ? "number" : "length");
        break;
    }
    return RC_OK;
}

enum rc_status
rc_fields_read(const struct rc_field *field, size_t n, struct rc_lines *lines, const char *marks,
               const char *last, void *into, struct rc_err *err)
{
    struct rc_piece line, key, value;

    while (rc_lines_next(lines, &line.text, &line.n)) {
        line = rc_piece_trim(line);
        if (last != NULL && rc_piece_is(line, last))
            break;
        if (rc_piece_part(line, marks, &key, &value) &&
            rc_field_take(field, n, key, value, into, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

static bool
is_white(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r') || c == '\0';
}

bool
rc_piece_infinite(struct rc_piece piece, double *value)
{
    bool minus = piece.n > 0 && *piece.text == '-';

    if (piece.n > 0 && (minus || *piece.text == '+'))
        piece = (struct rc_piece){piece.text + 1, piece.n - 1};
    *value = minus ? -INFINITY : INFINITY;
    return rc_piece_is(piece, "inf|infinity|1.#inf");
}

enum rc_status
rc_flow_read(struct rc_piece *text, double *v, size_t n, struct rc_err *err)
{
    for (size_t k = 0; k < n; k++) {
        struct rc_piece word, rest;

        while (text->n > 0 && is_white(*text->text))
            text->text++, text->n--;
        word = (struct rc_piece){text->text, 0};
        while (text->n > 0 && !is_white(*text->text))
            text->text++, text->n--;
        word.n = (size_t)(text->text - word.text);
        if (word.n == 0)
            return rc_err_set(err, "the header promises %zu numbers, the file has %zu", n, k);
        if (rc_piece_is(word, "nan|na|bad|--|---"))
            v[k] = NAN;
        else if ((!rc_piece_number(word, &v[k], &rest) || rest.n > 0) &&
                 !rc_piece_infinite(word, &v[k]))
            return rc_err_set(err, "number %zu of the data is '%s': that is not a number", k + 1,
                              rc_piece_shown(word));
    }
    return RC_OK;
}
