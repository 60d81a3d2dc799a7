/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "grid.h"
#include "memory.h"

#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h> /* vsnprintf only: this library reads and writes nothing */
#include <stdlib.h>
#include <string.h>

enum {
    HISTORY_MAX = 32 * 1024
};

enum rc_status
rc_err_set(struct rc_err *err, const char *format, ...)
{
    if (err != NULL) {
        va_list ap;
        va_start(ap, format);
        vsnprintf(err->text, sizeof err->text, format, ap);
        va_end(ap);
    }
    return RC_FAIL;
}

enum rc_status
rc_size_mul(size_t a, size_t b, size_t *product, struct rc_err *err)
{
    if (a != 0 && b > SIZE_MAX / a)
        return rc_err_set(err, "%zu x %zu is more than this machine can address", a, b);
    *product = a * b;
    return RC_OK;
}

/* ---- boundaries ---- */

static const struct {
    const char *word;
    struct rc_boundary boundary;
} boundaries[] = {
    {"free", {.x = false}},
    {"periodic", {.x = true, .y = true}},
    {"periodic-x", {.x = true}},
    {"periodic-y", {.y = true}},
};

const char *
rc_boundary_word(struct rc_boundary boundary)
{
    size_t k = 0;

    while (!rc_same_boundary(boundaries[k].boundary, boundary))
        k++;
    return boundaries[k].word;
}

bool
rc_boundary_named(const char *word, struct rc_boundary *boundary)
{
    size_t k = 0;
    const size_t n = sizeof boundaries / sizeof *boundaries;

    while (k < n && strcmp(boundaries[k].word, word) != 0)
        k++;
    if (k < n)
        *boundary = boundaries[k].boundary;
    return k < n;
}

struct rc_boundary
rc_boundary_on(const struct rc_shape *s, struct rc_boundary boundary)
{
    if (rc_repeats(boundary) == 1 && boundary.datum == 0)
        boundary.datum = boundary.x ? (double)s->ny * s->dy : (double)s->nx * s->dx;
    return boundary;
}

/* Areas, wave numbers and their powers are numbers of double precision within these spacings. */
static const double least_spacing = 1e-60, largest_spacing = 1e60;

enum rc_status
rc_shape_check(const struct rc_shape *s, struct rc_err *err)
{
    size_t nodes = 0, bytes = 0;

    if (s->nx == 0 || s->ny == 0)
        return rc_err_set(err, "a grid of %zu x %zu nodes is empty: both sizes must be at least 1",
                          s->nx, s->ny);
    if (!(s->dx > 0 && s->dy > 0) || isinf(s->dx) || isinf(s->dy))
        return rc_err_set(err, "spacing dx=%g dy=%g m: both must be positive and finite", s->dx,
                          s->dy);
    if (fmin(s->dx, s->dy) < least_spacing || fmax(s->dx, s->dy) > largest_spacing)
        return rc_err_set(err, "spacing dx=%g dy=%g m: both must be from %g to %g", s->dx, s->dy,
                          least_spacing, largest_spacing);
    if (rc_size_mul(s->nx, s->ny, &nodes, err) != RC_OK ||
        rc_size_mul(nodes, sizeof(double), &bytes, err) != RC_OK)
        return RC_FAIL;
    return RC_OK;
}

/* Keys of the header that are fields of the struct. */
static bool
is_field(const char *name)
{
    static const char *const fields[] = {"channel", "nx", "ny", "dx", "dy", "unit", "type"};

    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++)
        if (strcmp(name, fields[k]) == 0)
            return true;
    return false;
}

bool
rc_key_valid(const char *name)
{
    if (!(name[0] >= 'a' && name[0] <= 'z'))
        return false;
    return name[strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789._-")] == '\0';
}

enum rc_status
rc_text_set(char **text, const char *value, struct rc_err *err)
{
    size_t size = strlen(value) + 1;
    char *copy = malloc(size);

    if (copy == NULL)
        return rc_err_set(err, "out of memory for %zu bytes of text", size);
    memcpy(copy, value, size);
    free(*text);
    *text = copy;
    return RC_OK;
}

struct rc_grid *
rc_grid_new(const struct rc_shape *shape, const char *channel, const char *unit, struct rc_err *err)
{
    return rc_grid_new_part(shape, shape->ny, channel, unit, err);
}

struct rc_grid *
rc_grid_new_part(const struct rc_shape *shape, size_t rows, const char *channel, const char *unit,
                 struct rc_err *err)
{
    RC_OWN(rc_grid, g) = NULL;
    size_t bytes;

    if (rc_shape_check(shape, err) != RC_OK)
        return NULL;
    bytes = shape->nx * rows * sizeof(double);
    g = calloc(1, sizeof *g);
    if (g == NULL || (g->v = rc_alloc(bytes, 1)) == NULL)
        return rc_err_null(err, "out of memory for a map of %zu x %zu nodes (%zu bytes)", shape->nx,
                           shape->ny, bytes);
    g->nx = shape->nx;
    g->ny = shape->ny;
    g->elsewhere = shape->ny - rows;
    g->dx = shape->dx;
    g->dy = shape->dy;
    g->type = RC_F64;
    return rc_text_set(&g->channel, channel, err) == RC_OK &&
                   rc_text_set(&g->unit, unit, err) == RC_OK
               ? rc_give(&g)
               : NULL;
}

struct rc_grid *
rc_grid_like(const struct rc_grid *like, const char *channel, const char *unit, struct rc_err *err)
{
    struct rc_shape shape = rc_grid_shape(like);
    RC_OWN(rc_grid, g) = rc_grid_new_part(&shape, like->ny - like->elsewhere, channel, unit, err);

    for (size_t k = 0; g != NULL && k < like->keys; k++)
        if (rc_grid_set(g, like->key[k].name, like->key[k].value, err) != RC_OK)
            return NULL;
    return rc_give(&g);
}

void
rc_grid_free(struct rc_grid *g)
{
    if (g == NULL)
        return;
    for (size_t k = 0; k < g->keys; k++) {
        free(g->key[k].name);
        free(g->key[k].value);
    }
    free(g->key);
    free(g->channel);
    free(g->unit);
    free(g->v);
    free(g);
}

struct rc_shape
rc_grid_shape(const struct rc_grid *g)
{
    return (struct rc_shape){.nx = g->nx, .ny = g->ny, .dx = g->dx, .dy = g->dy};
}

size_t
rc_grid_nodes(const struct rc_grid *g)
{
    return g->nx * (g->ny - g->elsewhere);
}

static struct rc_key *
find(const struct rc_grid *g, const char *name)
{
    for (size_t k = 0; k < g->keys; k++)
        if (strcmp(g->key[k].name, name) == 0)
            return &g->key[k];
    return NULL;
}

const char *
rc_grid_get(const struct rc_grid *g, const char *name)
{
    const struct rc_key *key = find(g, name);

    return key == NULL ? NULL : key->value;
}

static void
remove_key(struct rc_grid *g, struct rc_key *key)
{
    free(key->name);
    free(key->value);
    g->keys--;
    memmove(key, key + 1, (size_t)(g->key + g->keys - key) * sizeof *key);
}

enum rc_status
rc_grid_set(struct rc_grid *g, const char *name, const char *value, struct rc_err *err)
{
    struct rc_key *key = find(g, name);

    if (!rc_key_valid(name))
        return rc_err_set(err, "key '%s' is not of the form [a-z][a-z0-9._-]*", name);
    if (is_field(name))
        return rc_err_set(err, "'%s' is a field of the grid, not a key", name);
    if (value == NULL) {
        if (key != NULL)
            remove_key(g, key);
        return RC_OK;
    }
    if (key == NULL) {
        struct rc_key *more = realloc(g->key, (g->keys + 1) * sizeof *more);
        if (more == NULL)
            return rc_err_set(err, "out of memory for %zu keys", g->keys + 1);
        g->key = more;
        key = &more[g->keys];
        *key = (struct rc_key){0};
        if (rc_text_set(&key->name, name, err) != RC_OK)
            return RC_FAIL;
        if (rc_text_set(&key->value, value, err) != RC_OK) {
            free(key->name);
            return RC_FAIL;
        }
        g->keys++;
        return RC_OK;
    }
    return rc_text_set(&key->value, value, err);
}

enum rc_status
rc_grid_set_number(struct rc_grid *g, const char *name, double value, struct rc_err *err)
{
    char text[RC_NUMBER_SIZE];

    return rc_grid_set(g, name, rc_number_text(text, value), err);
}

bool
rc_grid_number(const struct rc_grid *g, const char *name, double *value)
{
    const char *text = rc_grid_get(g, name);
    const char *end = text == NULL ? NULL : rc_number_read(text, false, value);

    return end != NULL && *end == '\0' && isfinite(*value);
}

const char *
rc_grid_dunit(const struct rc_grid *grid)
{
    const char *unit = rc_grid_get(grid, "dunit");

    return unit == NULL ? "m" : unit;
}

void
rc_grid_origin(const struct rc_grid *grid, double *i, double *j)
{
    bool waves = strcmp(rc_grid_dunit(grid), "rad/m") == 0;

    *i = waves ? (double)(grid->nx / 2) : 0.5 * ((double)grid->nx - 1);
    *j = waves ? (double)(grid->ny / 2) : 0.5 * ((double)grid->ny - 1);
}

size_t
rc_grid_case(const struct rc_grid *g)
{
    const char *text = rc_grid_get(g, "case");
    size_t n = 0;

    if (text == NULL)
        return 1;
    if (*text == '\0' || strlen(text) > 15 || text[strspn(text, "0123456789")] != '\0')
        return 0;
    for (; *text != '\0'; text++)
        n = 10 * n + (size_t)(*text - '0');
    return n;
}

/* Keeps the first step and as many of the last steps as fit; "..." replaces the others. */
static void
shorten(char *history)
{
    static const char gap[] = " | ...";
    char *head = strstr(history, " | ");
    char *tail = head;

    if (head == NULL)
        return;
    while (tail != NULL && (size_t)(head - history) + strlen(gap) + strlen(tail) > HISTORY_MAX)
        tail = strstr(tail + 1, " | ");
    if (tail == NULL || (size_t)(tail - head) < strlen(gap))
        return;
    memcpy(head, gap, strlen(gap));
    memmove(head + strlen(gap), tail, strlen(tail) + 1);
}

enum rc_status
rc_grid_history(struct rc_grid *g, const char *step, struct rc_err *err)
{
    static const size_t most = HISTORY_MAX / 2 - 16; /* bytes of a step at most: two steps fit */
    const char *old = rc_grid_get(g, "history");
    size_t n = strlen(step), keep = n <= most ? n : most;
    size_t size = (old == NULL ? 0 : strlen(old)) + keep + 8;
    RC_OWNED char *text = malloc(size);

    if (text == NULL)
        return rc_err_set(err, "out of memory for %zu bytes of history", size);
    while (keep < n && (step[keep] & 0xc0) == 0x80) /* within a character of UTF-8 */
        keep--;
    snprintf(text, size, "%s%s%.*s%s", old == NULL ? "" : old, old == NULL ? "" : " | ", (int)keep,
             step, keep < n ? "..." : "");
    if (strlen(text) > HISTORY_MAX)
        shorten(text);
    return rc_grid_set(g, "history", text, err);
}

/* printf and strtod follow the locale of the process; a stream must not. */
static char
locale_point(void)
{
    return localeconv()->decimal_point[0];
}

const char *
rc_number_text(char text[RC_NUMBER_SIZE], double value)
{
    char point = locale_point();

    if (isnan(value))
        return strcpy(text, "nan");
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, RC_NUMBER_SIZE, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    if (point != '.') {
        char *at = strchr(text, point);
        if (at != NULL)
            *at = '.';
    }
    return text;
}

static const char *
skip_digits(const char *s)
{
    return s + strspn(s, "0123456789");
}

/* End of [+-]digits[.digits][e[+-]digits] at s, or NULL. */
static const char *
decimal_end(const char *s)
{
    const char *start, *end;
    size_t digits;

    if (*s == '+' || *s == '-')
        s++;
    start = s;
    end = skip_digits(s);
    digits = (size_t)(end - start);
    if (*end == '.') {
        const char *fraction = end + 1;
        end = skip_digits(fraction);
        digits += (size_t)(end - fraction);
    }
    if (digits == 0)
        return NULL;
    if (*end == 'e' || *end == 'E') {
        const char *power = end + 1;
        if (*power == '+' || *power == '-')
            power++;
        if (skip_digits(power) > power)
            end = skip_digits(power);
    }
    return end;
}

static bool
same_letters(const char *s, const char *word, size_t n)
{
    for (size_t k = 0; k < n; k++)
        if ((s[k] | 0x20) != word[k])
            return false;
    return true;
}

static const char *
read_special(const char *s, double *value)
{
    bool minus = *s == '-';
    const char *word = *s == '+' || *s == '-' ? s + 1 : s;

    if (same_letters(word, "nan", 3)) {
        *value = NAN;
        return word + 3;
    }
    if (same_letters(word, "inf", 3)) {
        *value = minus ? -INFINITY : INFINITY;
        return same_letters(word, "infinity", 8) ? word + 8 : word + 3;
    }
    return NULL;
}

const char *
rc_number_read(const char *text, bool special, double *value)
{
    const char *end = decimal_end(text);
    char copy[512]; /* 17 digits determine a double; strtod rounds longer texts */
    size_t n;

    if (end == NULL)
        return special ? read_special(text, value) : NULL;
    n = (size_t)(end - text);
    if (n >= sizeof copy)
        return NULL;
    memcpy(copy, text, n);
    copy[n] = '\0';
    if (locale_point() != '.') {
        char *at = strchr(copy, '.');
        if (at != NULL)
            *at = locale_point();
    }
    *value = strtod(copy, NULL);
    return end;
}
