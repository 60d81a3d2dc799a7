#include "units.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

/* clang-format off */
static const struct word_unit { /* units that do not go by prefixes */
    const char *text;
    double size;
} size_units[] = {
    {"", 1},
    {"B", 1},
    {"k", 1024.0},
    {"K", 1024.0},
    {"KiB", 1024.0},
    {"kB", 1e3},
    {"M", 1048576.0},
    {"MiB", 1048576.0},
    {"MB", 1e6},
    {"G", 1073741824.0},
    {"GiB", 1073741824.0},
    {"GB", 1e9},
    {"T", 1099511627776.0},
    {"TiB", 1099511627776.0},
    {"TB", 1e12},
    {NULL, 0},
}, time_units[] = {
    {"min", 60},
    {"h", 3600},
    {NULL, 0},
};
/* clang-format on */

const char *
unit_name(enum unit unit)
{
    static const char *const names[] = {"", "m", "N", "Pa", "s", "bytes"};

    return names[unit];
}

static bool
same(const char *word, const char *text, size_t n)
{
    return strlen(word) == n && memcmp(word, text, n) == 0;
}

/* Scales *value, read from digits[0..length), by ten to the power: by way of the decimal text, so
 * that 1.29um is the double nearest to 1.29e-06. */
static bool
shift(const char *digits, size_t length, int power, double *value)
{
    char text[64];
    size_t mantissa = strcspn(digits, "eE");
    int own = 0;

    if (mantissa > length)
        mantissa = length;
    else if (mantissa < length)
        own = (int)strtol(digits + mantissa + 1, NULL, 10);
    if (mantissa > 40 || own < -400 || own > 400) {
        *value *= pow(10, power);
        return true;
    }
    snprintf(text, sizeof text, "%.*se%d", (int)mantissa, digits, own + power);
    return rc_number_read(text, false, value) != NULL;
}

/* Applies the unit written as suffix[0..n) after the number digits[0..length); false when there is
 * no such unit. */
static bool
apply_unit(const char *digits, size_t length, const char *suffix, size_t n, enum unit unit,
           double *value)
{
    const char *base = unit_name(unit);
    size_t tail = strlen(base);
    int power;

    if (unit == UNIT_BYTES || unit == UNIT_S)
        for (const struct word_unit *w = unit == UNIT_S ? time_units : size_units; w->text != NULL;
             w++)
            if (same(w->text, suffix, n)) {
                *value *= w->size;
                return true;
            }
    if (unit == UNIT_BYTES)
        return false;
    if (n == 0)
        return true;
    if (unit == UNIT_NONE || n < tail || memcmp(suffix + n - tail, base, tail) != 0)
        return false;
    return rc_prefix_power(suffix, n - tail, &power) && shift(digits, length, power, value);
}

/* "f p n u m c k M G T": those that can be typed on every keyboard. */
static const char *
prefix_list(char *list, size_t size)
{
    size_t n = 0;

    list[0] = '\0';
    for (const struct rc_prefix *p = rc_prefixes; p->text != NULL && n < size; p++)
        if (p->text[0] != '\0' && (unsigned char)p->text[0] < 0x80)
            n += (size_t)snprintf(list + n, size - n, "%s%s", n == 0 ? "" : " ", p->text);
    return list;
}

/* The number in text[0..n), and whether it carries a unit. */
static enum rc_status
read_one(const char *text, size_t n, enum unit unit, double *value, bool *with_unit,
         struct rc_err *err)
{
    const char *end, *stop = text + n;
    char list[64];
    size_t length;

    while (n > 0 && *text == ' ') {
        text++;
        n--;
    }
    end = n == 0 ? NULL : rc_number_read(text, false, value);
    if (end == NULL || end > stop)
        return rc_err_set(err, "'%.*s' is not a number", (int)n, text);
    length = (size_t)(end - text);
    while (end < stop && *end == ' ')
        end++;
    *with_unit = end < stop;
    if (!apply_unit(text, length, end, (size_t)(stop - end), unit, value)) {
        if (unit == UNIT_NONE)
            return rc_err_set(err, "'%.*s' after %.*s: a plain number without a unit is expected",
                              (int)(stop - end), end, (int)length, text);
        if (unit == UNIT_BYTES)
            return rc_err_set(err,
                              "unknown unit '%.*s': a size in bytes is expected, as in 512M "
                              "or 4GiB",
                              (int)(stop - end), end);
        return rc_err_set(err,
                          "unknown unit '%.*s': %s is expected, with or without one of the "
                          "prefixes %s%s",
                          (int)(stop - end), end, unit_name(unit), prefix_list(list, sizeof list),
                          unit == UNIT_S ? ", or min or h" : "");
    }
    if (!isfinite(*value))
        return rc_err_set(err, "'%.*s' is too large", (int)n, text);
    return RC_OK;
}

enum rc_status
unit_number(const char *text, enum unit unit, double *value, struct rc_err *err)
{
    bool with_unit;

    return read_one(text, strlen(text), unit, value, &with_unit, err);
}

struct pieces {
    bool with, without; /* a number with a unit was seen, one without that is not 0 */
};

static enum rc_status
read_piece(const char *text, size_t n, enum unit unit, struct pieces *seen, double *value,
           struct rc_err *err)
{
    bool with_unit;

    if (read_one(text, n, unit, value, &with_unit, err) != RC_OK)
        return RC_FAIL;
    if (with_unit)
        seen->with = true;
    else if (*value != 0)
        seen->without = true;
    if (seen->with && seen->without)
        return rc_err_set(err, "numbers with and without a unit in one list: give each its unit, "
                               "or none");
    return RC_OK;
}

/* Steps between decimal numbers are meant to be decimal: 6e-06, not 5.999999999999999e-06. */
static double
decimal(double x)
{
    char text[32];

    snprintf(text, sizeof text, "%.14g", x);
    return strtod(text, NULL);
}

/* a:b:n with the colons at `first` and `second`. */
static enum rc_status
read_range(const char *text, const char *first, const char *second, enum unit unit,
           struct numbers *list, struct rc_err *err)
{
    struct pieces seen = {0};
    double a, b, n;

    if (read_piece(text, (size_t)(first - text), unit, &seen, &a, err) != RC_OK ||
        read_piece(first + 1, (size_t)(second - first - 1), unit, &seen, &b, err) != RC_OK ||
        unit_number(second + 1, UNIT_NONE, &n, err) != RC_OK)
        return RC_FAIL;
    if (n != floor(n) || n < 2 || n > 1e6)
        return rc_err_set(err, "'%s' in a:b:n must be a whole number of values, at least 2",
                          second + 1);
    list->n = (size_t)n;
    list->v = malloc(list->n * sizeof *list->v);
    if (list->v == NULL)
        return rc_err_set(err, "out of memory for %zu numbers", list->n);
    for (size_t k = 0; k < list->n; k++)
        list->v[k] = k + 1 == list->n ? b : decimal(a + (b - a) * (double)k / (n - 1));
    return RC_OK;
}

enum rc_status
unit_numbers(const char *text, enum unit unit, struct numbers *list, struct rc_err *err)
{
    struct pieces seen = {0};
    const char *colon = strchr(text, ':');
    size_t n = 1;

    *list = (struct numbers){0};
    if (colon != NULL) {
        const char *second = strchr(colon + 1, ':');
        if (second == NULL)
            return rc_err_set(err, "'%s': a range is a:b:n, n values from a to b", text);
        return read_range(text, colon, second, unit, list, err);
    }
    for (const char *s = text; *s != '\0'; s++)
        n += *s == ',';
    list->v = malloc(n * sizeof *list->v);
    if (list->v == NULL)
        return rc_err_set(err, "out of memory for %zu numbers", n);
    for (; list->n < n; list->n++) {
        size_t length = strcspn(text, ",");
        if (read_piece(text, length, unit, &seen, &list->v[list->n], err) != RC_OK) {
            free(list->v);
            *list = (struct numbers){0};
            return RC_FAIL;
        }
        text += length + 1;
    }
    return RC_OK;
}
