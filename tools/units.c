#include "units.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const struct prefix {
    const char *text;
    double factor;
} si_prefixes[] = {
    {"", 1},    {"f", 1e-15}, {"p", 1e-12}, {"n", 1e-9}, {"u", 1e-6}, {"\xc2\xb5", 1e-6},
    {"\xce\xbc", 1e-6}, {"m", 1e-3}, {"c", 1e-2}, {"k", 1e3}, {"M", 1e6}, {"G", 1e9},
    {"T", 1e12}, {NULL, 0},
};

static const struct prefix byte_units[] = {
    {"", 1},           {"B", 1},          {"k", 1024.0},     {"K", 1024.0},
    {"KiB", 1024.0},   {"kB", 1e3},       {"M", 1048576.0},  {"MiB", 1048576.0},
    {"MB", 1e6},       {"G", 1073741824.0}, {"GiB", 1073741824.0}, {"GB", 1e9},
    {"T", 1099511627776.0}, {"TiB", 1099511627776.0}, {NULL, 0},
};

const char *
unit_name(enum unit unit)
{
    static const char *const names[] = {"", "m", "N", "Pa", "bytes"};

    return names[unit];
}

static double
find(const struct prefix *table, const char *text, size_t n)
{
    for (; table->text != NULL; table++)
        if (strlen(table->text) == n && memcmp(table->text, text, n) == 0)
            return table->factor;
    return 0;
}

/* Factor to SI of a unit written as `suffix` (n bytes), 0 when there is no such unit. */
static double
factor_of(const char *suffix, size_t n, enum unit unit)
{
    const char *base = unit_name(unit);
    size_t length = strlen(base);

    if (unit == UNIT_BYTES)
        return find(byte_units, suffix, n);
    if (n == 0)
        return 1;
    if (unit == UNIT_NONE || n < length || memcmp(suffix + n - length, base, length) != 0)
        return 0;
    return find(si_prefixes, suffix, n - length);
}

/* The number in text[0..n), and whether it carries a unit. */
static enum rc_status
read_one(const char *text, size_t n, enum unit unit, double *value, bool *with_unit,
         struct rc_err *err)
{
    const char *end, *stop = text + n;
    double factor;

    while (n > 0 && *text == ' ') {
        text++;
        n--;
    }
    end = n == 0 ? NULL : rc_number_read(text, false, value);
    if (end == NULL || end > stop)
        return rc_err_set(err, "'%.*s' is not a number", (int)n, text);
    while (end < stop && *end == ' ')
        end++;
    *with_unit = end < stop;
    factor = factor_of(end, (size_t)(stop - end), unit);
    if (factor == 0) {
        if (unit == UNIT_NONE)
            return rc_err_set(err, "'%.*s' after %.*s: a plain number without a unit is expected",
                              (int)(stop - end), end, (int)(end - text), text);
        if (unit == UNIT_BYTES)
            return rc_err_set(err, "unknown unit '%.*s': a size in bytes is expected, as in 512M "
                                   "or 4GiB", (int)(stop - end), end);
        return rc_err_set(err, "unknown unit '%.*s': %s is expected, with or without one of the "
                               "prefixes f p n u m c k M G T", (int)(stop - end), end,
                          unit_name(unit));
    }
    *value *= factor;
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
        list->v[k] = k + 1 == list->n ? b : a + (b - a) * (double)k / (n - 1);
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
