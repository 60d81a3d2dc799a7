/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "units.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

/* clang-format off */
static const struct { /* units without prefixes */
    enum unit unit;
    const char *text;
    double size;
} words[] = {
    {UNIT_BYTES, "", 1},
    {UNIT_BYTES, "B", 1},
    {UNIT_BYTES, "k", 1024.0},
    {UNIT_BYTES, "K", 1024.0},
    {UNIT_BYTES, "KiB", 1024.0},
    {UNIT_BYTES, "kB", 1e3},
    {UNIT_BYTES, "M", 1048576.0},
    {UNIT_BYTES, "MiB", 1048576.0},
    {UNIT_BYTES, "MB", 1e6},
    {UNIT_BYTES, "G", 1073741824.0},
    {UNIT_BYTES, "GiB", 1073741824.0},
    {UNIT_BYTES, "GB", 1e9},
    {UNIT_BYTES, "T", 1099511627776.0},
    {UNIT_BYTES, "TiB", 1099511627776.0},
    {UNIT_BYTES, "TB", 1e12},
    {UNIT_S, "min", 60},
    {UNIT_S, "h", 3600},
    {UNIT_S, "d", 86400},
    {UNIT_N, "gf", 9.80665e-3},
    {UNIT_N, "kgf", 9.80665},
    {UNIT_SPIN, "/m", 1},
    {UNIT_ANGLE, "deg", 3.141592653589793 / 180},
    {UNIT_ANGLE, "degrees", 3.141592653589793 / 180},
    {UNIT_ANGLE, "\302\260", 3.141592653589793 / 180},
};
static const struct { /* units that are a power of ten of the SI unit but have another name */
    enum unit unit;
    const char *text;
    int power;
} decimals[] = {
    {UNIT_PA, "bar", 5},
    {UNIT_HARD, "bar", 5},
    {UNIT_PAS, "P", -1}, /* poise */
    {UNIT_PAS, "Pa.s", 0},
    {UNIT_PAS, "Pa s", 0},
    {UNIT_WORK, "J/m^2", 0},
    {UNIT_WORK, "N/m", 0},
    {UNIT_CREEP, "%", -2},
    {UNIT_PER_PA, "/Pa", 0},
    {UNIT_PER_PA, "/MPa", -6},
    {UNIT_PER_PA, "/GPa", -9},
    {UNIT_PER_PA, "1/MPa", -6},
    {UNIT_PER_PA, "1/GPa", -9},
};
/* clang-format on */

static const struct {
    const char *name, *usual;
    const char *also; /* further units, for messages; NULL: none */
    bool needed;      /* only 0 has no unit */
} names[] = {
    [UNIT_NONE] = {"", "", NULL},
    [UNIT_M] = {"m", "nm um mm m", "inch, mil or microinch"},
    [UNIT_N] = {"N", "mN N kN", "kgf"},
    [UNIT_PA] = {"Pa", "kPa MPa GPa", "N/mm2 or bar"},
    [UNIT_S] = {"s", "s min h d", "min, h or d"},
    [UNIT_BYTES] = {"bytes", "M G", NULL},
    [UNIT_HARD] = {"Pa", "HV MPa GPa", "N/mm2, bar or HV"},
    [UNIT_WORK] = {"J/m2", "mJ/m2 J/m2", "N/m"},
    [UNIT_PAS] = {"Pas", "mPas Pas", "cP"},
    [UNIT_K] = {"K", "K degC", "degC"},
    [UNIT_SPEED] = {"m/s", "mm/s m/s km/h", "km/h"},
    [UNIT_DIFFUSIVITY] = {"m2/s", "mm2/s m2/s", NULL},
    [UNIT_HEAT] = {"J/m3K", "kJ/m3K MJ/m3K", NULL},
    [UNIT_HZ] = {"Hz", "Hz kHz", NULL},
    [UNIT_RAD_S] = {"rad/s", "rad/s", NULL},
    [UNIT_W_MK] = {"W/mK or S/m", "W/mK", NULL},
    [UNIT_S_M] = {"W/mK or S/m", "S/m", NULL},
    [UNIT_CREEP] = {"", "%", NULL},
    [UNIT_SPIN] = {"rad/m", "rad/m", "1/m"},
    [UNIT_WEAR] = {"m2/N", "mm3/Nm", "mm3/Nm or 1/GPa", true},
    [UNIT_WEAR_ENERGY] = {"m3/J", "mm3/J", NULL, true},
    [UNIT_PER_PA] = {"1/Pa", "1/GPa 1/Pa", NULL},
    [UNIT_MOLAR] = {"J/mol", "kJ/mol", NULL},
    [UNIT_ANGLE] = {"rad", "deg rad", "deg"},
};

const char *
unit_name(enum unit unit)
{
    return names[unit].name;
}

const char *
unit_usual(enum unit unit)
{
    return names[unit].usual;
}

static bool
same(const char *word, const char *text, size_t n)
{
    return strlen(word) == n && memcmp(word, text, n) == 0;
}

/* Multiplies *value, read from digits[0..length), by ten to the power: through the decimal text, so that
 * 1.29um is the double nearest to 1.29e-06. */
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

/* The power of ten of a unit with its prefix, text[0..n); false when it is another unit. */
static bool
power_of(const char *text, size_t n, const char *base, int *power)
{
    size_t tail = strlen(base);

    return n >= tail && memcmp(text + n - tail, base, tail) == 0 &&
           rc_prefix_power(text, n - tail, power);
}

static bool
unit_power(const char *text, size_t n, enum unit unit, int *power)
{
    return *unit_name(unit) != '\0' && power_of(text, n, unit_name(unit), power);
}

/* "HV", "HV10", "HV0.3": the test force in kilograms-force may follow. */
static bool
is_vickers(const char *text, size_t n)
{
    return n >= 2 && memcmp(text, "HV", 2) == 0 && strspn(text + 2, "0123456789.") >= n - 2;
}

bool
unit_vickers(const char *text)
{
    const char *unit = strstr(text, "HV");

    return unit != NULL && is_vickers(unit, strlen(unit));
}

double
unit_vickers_on_faces(double pressure)
{
    return pressure * sin(68 * acos(-1) / 180);
}

/* "N/mm2", "kN/m^2": the power of ten of a force over an area. */
static bool
stress_power(const char *text, size_t n, int *power)
{
    const char *slash = memchr(text, '/', n);
    size_t tail = slash == NULL ? 0 : (size_t)(text + n - slash - 1), side;
    int above, below;

    if (tail < 2 || slash[tail] != '2')
        return false;
    side = tail - (slash[tail - 1] == '^' ? 2 : 1);
    if (!power_of(text, (size_t)(slash - text), "N", &above) ||
        !power_of(slash + 1, side, "m", &below))
        return false;
    *power = above - 2 * below;
    return true;
}

static bool
decimal_power(const char *text, size_t n, enum unit unit, int *power)
{
    for (size_t k = 0; k < sizeof decimals / sizeof *decimals; k++)
        if (decimals[k].unit == unit && power_of(text, n, decimals[k].text, power)) {
            *power += decimals[k].power;
            return true;
        }
    return (unit == UNIT_PA || unit == UNIT_HARD) && stress_power(text, n, power);
}

/* Quotients: a power of a unit with its prefix, over other units. "J/(m3 K)", "J/m^3/K" and "J/m3K" are the
 * same. */
static const struct quotient {
    enum unit unit;
    const char *above, *below;
    int exponent; /* of the unit above */
    int power;    /* of ten: size of the quotient in SI, times `over` */
    double over;
    bool metre; /* below comes a metre with its prefix, and then `below` */
} quotients[] = {
    {UNIT_SPEED, "m", "s", 1, 0, 1, false},    {UNIT_SPEED, "m", "min", 1, 0, 60, false},
    {UNIT_SPEED, "m", "h", 1, 0, 3600, false}, {UNIT_DIFFUSIVITY, "m", "s", 2, 0, 1, false},
    {UNIT_HEAT, "J", "m3K", 1, 0, 1, false},   {UNIT_HEAT, "J", "cm3K", 1, 6, 1, false},
    {UNIT_W_MK, "W", "K", 1, 0, 1, true},      {UNIT_S_M, "S", "", 1, 0, 1, true},
    {UNIT_WEAR, "m", "Nm", 3, 0, 1, false},    {UNIT_WEAR, "m", "N", 2, 0, 1, false},
    {UNIT_WEAR, "1", "Pa", 1, 0, 1, false},    {UNIT_WEAR, "1", "MPa", 1, -6, 1, false},
    {UNIT_WEAR, "1", "GPa", 1, -9, 1, false},  {UNIT_WEAR_ENERGY, "m", "J", 3, 0, 1, false},
    {UNIT_SPIN, "rad", "", 1, 0, 1, true},     {UNIT_SPIN, "1", "", 1, 0, 1, true},
};

/* The letters and digits of text[0..n). */
static void
bare(const char *text, size_t n, char *to, size_t size)
{
    size_t used = 0;

    for (size_t k = 0; k < n; k++)
        if (strchr(" ()*./^", text[k]) == NULL && used + 1 < size)
            to[used++] = text[k];
    to[used] = '\0';
}

static bool
apply_quotient(const char *digits, size_t length, const char *suffix, size_t n, enum unit unit,
               double *value)
{
    const char *slash = memchr(suffix, '/', n);
    char above[16], below[16];
    int power, metre = 0;

    if (slash == NULL)
        return false;
    bare(suffix, (size_t)(slash - suffix), above, sizeof above);
    bare(slash, (size_t)(suffix + n - slash), below, sizeof below);
    for (size_t k = 0; k < sizeof quotients / sizeof *quotients; k++) {
        const struct quotient *q = &quotients[k];
        const size_t tail = q->exponent > 1 ? 1 : 0, used = strlen(above);
        const size_t before = strlen(below) - strlen(q->below);
        if (q->unit != unit || strlen(below) < strlen(q->below) ||
            strcmp(q->below, below + before) != 0 ||
            !(q->metre ? unit_power(below, before, UNIT_M, &metre) : before == 0) || used <= tail ||
            (tail > 0 && above[used - 1] != '0' + q->exponent) ||
            !power_of(above, used - tail, q->above, &power) ||
            !shift(digits, length, q->exponent * power + q->power - metre, value))
            continue;
        *value /= q->over;
        return true;
    }
    return false;
}

/* Applies the unit written as suffix[0..n) after the number digits[0..length); false when there is
 * no such unit. */
static bool
apply_unit(const char *digits, size_t length, const char *suffix, size_t n, enum unit unit,
           double *value)
{
    double metres;
    int power;

    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (words[k].unit == unit && same(words[k].text, suffix, n)) {
            *value *= words[k].size;
            return true;
        }
    if (unit == UNIT_BYTES)
        return false;
    if (n == 0)
        return !names[unit].needed || *value == 0;
    if (unit == UNIT_NONE)
        return false;
    if (unit == UNIT_HARD && is_vickers(suffix, n)) {
        *value *= 9.80665e6 / unit_vickers_on_faces(1);
        return true;
    }
    if (unit == UNIT_K && (same("degC", suffix, n) || same("\302\260C", suffix, n))) {
        *value += 273.15;
        return true;
    }
    if (apply_quotient(digits, length, suffix, n, unit, value))
        return true;
    if (unit_power(suffix, n, unit, &power) || decimal_power(suffix, n, unit, &power))
        return shift(digits, length, power, value);
    for (size_t k = 0; k < n; k++)
        if ((suffix[k] | 0x20) < 'a' || (suffix[k] | 0x20) > 'z')
            return false;
    if (unit != UNIT_M || !rc_length_unit(suffix, n, &metres))
        return false;
    *value *= metres; /* inches and other units with names */
    return true;
}

/* The same for a force over a length, "mN/m" or "N/mm". */
static bool
apply_force_per_length(const char *digits, size_t length, const char *suffix, size_t n,
                       double *value)
{
    const char *slash = memchr(suffix, '/', n);
    int above, below;

    return slash != NULL && unit_power(suffix, (size_t)(slash - suffix), UNIT_N, &above) &&
           unit_power(slash + 1, (size_t)(suffix + n - slash - 1), UNIT_M, &below) &&
           shift(digits, length, above - below, value);
}

/* "f p n u m c k M G T": prefixes that every keyboard can type. */
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

/* What a number contained. `per_metre`: before, whether N/m is accepted for N; after, whether it was used. */
struct seen {
    bool with_unit, per_metre;
    bool listed; /* the number is one of a list */
};

/* Why another hardness scale is not a pressure; NULL: it is none of them. */
static const char *
other_scale(const char *suffix, size_t n)
{
    static const struct {
        const char *begins, *why;
    } scales[] = {
        {"HB",
         "Brinell's number is the force over the curved dent of a ball, and changes with the ball "
         "and the force"},
        {"HR", "Rockwell's number is a depth, from which no pressure follows"},
        {"HK",
         "Knoop's number is of a long dent that springs back across, and is not a mean pressure"},
        {"HL", "Leeb's number is a speed of rebound, from which no pressure follows"},
    };

    for (size_t k = 0; k < sizeof scales / sizeof *scales; k++)
        if (n >= 2 && memcmp(suffix, scales[k].begins, 2) == 0)
            return scales[k].why;
    return NULL;
}

/* Says which units are accepted instead of suffix[0..n), which is empty for a number that needs its unit. */
static enum rc_status
unknown_unit(const char *suffix, size_t n, enum unit unit, bool per_metre, struct rc_err *err)
{
    char list[64];
    const char *scale = unit == UNIT_HARD ? other_scale(suffix, n) : NULL;
    const char *also = names[unit].also;

    if (scale != NULL)
        return rc_err_set(err, "%s: give a pressure, as in 6GPa, or Vickers' number, as in 600HV",
                          scale);
    if (unit == UNIT_BYTES)
        return rc_err_set(err,
                          "unknown unit '%.*s': a size in bytes is expected, as in 512M or 4GiB",
                          (int)n, suffix);
    if (unit == UNIT_CREEP)
        return rc_err_set(err,
                          "unknown unit '%.*s': a plain number or a percentage is expected, as in "
                          "0.5%%",
                          (int)n, suffix);
    return rc_err_set(err, "%s%.*s%s: %s%s is expected, with or without one of the prefixes %s%s%s",
                      n == 0 ? "the number has no unit" : "unknown unit '", (int)n, suffix,
                      n == 0 ? "" : "'", unit_name(unit), per_metre ? " or N/m" : "",
                      prefix_list(list, sizeof list), also != NULL ? ", or " : "",
                      also != NULL ? also : "");
}

/* text[0..n) with 2 and 3 for the superscripts behind letters; false: it is too long. */
static bool
without_superscripts(const char *text, size_t n, char *to, size_t size)
{
    size_t used = 0;

    for (size_t k = 0; k < n; k++) {
        const bool raised = k > 0 && k + 1 < n && isalpha((unsigned char)text[k - 1]) &&
                            text[k] == '\302' && (text[k + 1] == '\262' || text[k + 1] == '\263');
        if (used + 1 >= size)
            return false;
        k += raised;
        to[used++] = (char)(raised ? text[k] - '\262' + '2' : text[k]);
    }
    to[used] = '\0';
    return true;
}

/* The number in text[0..n). */
static enum rc_status
read_one(const char *text, size_t n, enum unit unit, double *value, struct seen *seen,
         struct rc_err *err)
{
    bool per_metre = seen->per_metre;
    const char *end, *stop;
    char plain[128];
    size_t length, rest;

    if (memchr(text, '\302', n) != NULL && without_superscripts(text, n, plain, sizeof plain)) {
        text = plain; /* J/m\302\262 */
        n = strlen(plain);
    }
    stop = text + n;

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
    rest = (size_t)(stop - end);
    seen->with_unit = rest > 0;
    seen->per_metre = per_metre && apply_force_per_length(text, length, end, rest, value);
    if (!seen->per_metre && !apply_unit(text, length, end, rest, unit, value)) {
        if (unit == UNIT_NONE)
            return rc_err_set(err, "'%.*s' after %.*s: a number without a unit is expected%s",
                              (int)rest, end, (int)length, text,
                              seen->listed ? ", or several with commas, as in 1,2,3" : "");
        return unknown_unit(end, rest, unit, per_metre, err);
    }
    if (!isfinite(*value))
        return rc_err_set(err, "'%.*s' is too large", (int)n, text);
    return RC_OK;
}

enum rc_status
unit_number(const char *text, enum unit unit, double *value, struct rc_err *err)
{
    struct seen seen = {0};

    return read_one(text, strlen(text), unit, value, &seen, err);
}

/* ---- lists ---- */

/* How a list is read, and what it contained. */
struct list_state {
    enum unit unit;
    bool forces;                   /* N/m is accepted for N                                     */
    bool spans;                    /* A-B is accepted for the whole numbers from A to B         */
    bool with, without;            /* some number had a unit; some number other than 0 had none */
    bool per_metre, not_per_metre; /* with a unit                                               */
};

static enum rc_status
read_piece(const char *text, size_t n, struct list_state *state, double *value, struct rc_err *err)
{
    struct seen seen = {.per_metre = state->forces, .listed = true};

    if (read_one(text, n, state->unit, value, &seen, err) != RC_OK)
        return RC_FAIL;
    if (seen.with_unit) {
        state->with = true;
        state->per_metre |= seen.per_metre;
        state->not_per_metre |= !seen.per_metre;
    } else if (*value != 0 || state->unit == UNIT_K) { /* 0 degC is not 0 K */
        state->without = true;
    }
    if (state->with && state->without)
        return rc_err_set(err, "numbers with and without a unit in one list: give each its unit, "
                               "or none; the decimal mark is a point");
    if (state->per_metre && state->not_per_metre)
        return rc_err_set(err, "N and N/m in one list: give all in one of them");
    return RC_OK;
}

/* Steps between decimal numbers should be decimal: 6e-06, not 5.999999999999999e-06. */
static double
decimal(double x)
{
    char text[32];

    snprintf(text, sizeof text, "%.14g", x);
    return strtod(text, NULL);
}

/* Value k of n from a to b, in equal steps or equal ratios. */
static double
between(double a, double b, bool by_ratio, size_t k, double n)
{
    double part = (double)k / (n - 1);

    if (k == 0)
        return a;
    if ((double)k + 1 == n)
        return b;
    return decimal(by_ratio ? a * pow(b / a, part) : a + (b - a) * part);
}

enum {
    MOST = 1000000 /* numbers of a list */
};

/* Room for n more numbers. */
static enum rc_status
add_room(struct numbers *list, double n, struct rc_err *err)
{
    double *v;

    if (n > (double)(MOST - list->n))
        return rc_err_set(err, "a list has at most %d numbers", MOST);
    v = realloc(list->v, (list->n + (size_t)n) * sizeof *v);
    list->no_memory = v == NULL;
    if (v == NULL)
        return rc_err_set(err, "out of memory for %.0f numbers", (double)list->n + n);
    list->v = v;
    return RC_OK;
}

/* a:b:n or a:b:log:n, with the first colon at `first`. */
static enum rc_status
read_range(const char *text, size_t length, const char *first, struct list_state *state,
           struct numbers *list, struct rc_err *err)
{
    const char *end = text + length, *second = memchr(first + 1, ':', (size_t)(end - first - 1)),
               *count;
    struct seen seen = {0};
    bool by_ratio;
    double a, b, n;

    if (second == NULL || (end - second == 4 && strncmp(second, ":log", 4) == 0))
        return rc_err_set(err,
                          "'%.*s': a range is a:b:n, n values from a to b, or a:b:log:n, the same "
                          "by ratio",
                          (int)length, text);
    by_ratio = strncmp(second + 1, "log:", 4) == 0;
    count = second + (by_ratio ? 5 : 1);
    if (read_piece(text, (size_t)(first - text), state, &a, err) != RC_OK ||
        read_piece(first + 1, (size_t)(second - first - 1), state, &b, err) != RC_OK ||
        read_one(count, (size_t)(end - count), UNIT_NONE, &n, &seen, err) != RC_OK)
        return RC_FAIL;
    if (n != floor(n) || n < 2)
        return rc_err_set(err, "'%.*s' in %s must be a whole number of values, at least 2",
                          (int)(end - count), count, by_ratio ? "a:b:log:n" : "a:b:n");
    if (by_ratio && !(a > 0 && b > 0))
        return rc_err_set(err, "from %g to %g: a range by ratio needs both ends above 0", a, b);
    if (add_room(list, n, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < (size_t)n; k++)
        list->v[list->n++] = between(a, b, by_ratio, k, n);
    return RC_OK;
}

/* True for A-B, two whole numbers. */
static bool
is_span(const char *text, size_t length, double ends[2])
{
    const char *digits = "0123456789";
    const size_t first = strspn(text, digits);

    if (first == 0 || first + 1 >= length || text[first] != '-' ||
        first + 1 + strspn(text + first + 1, digits) != length)
        return false;
    (void)rc_number_read(text, false, &ends[0]);
    (void)rc_number_read(text + first + 1, false, &ends[1]);
    return true;
}

static enum rc_status
read_span(const char *text, size_t length, const double ends[2], struct numbers *list,
          struct rc_err *err)
{
    const double n = ends[1] - ends[0] + 1;

    if (!(n >= 1 && n <= MOST))
        return rc_err_set(err, "'%.*s': a range goes up, and has at most %d numbers", (int)length,
                          text, MOST);
    if (add_room(list, n, err) != RC_OK)
        return RC_FAIL;
    for (double v = ends[0]; v <= ends[1]; v++)
        list->v[list->n++] = v;
    return RC_OK;
}

/* One number, or a range. */
static enum rc_status
read_entry(const char *text, size_t length, struct list_state *state, struct numbers *list,
           struct rc_err *err)
{
    const char *colon = memchr(text, ':', length);
    double ends[2], value;

    if (colon != NULL)
        return read_range(text, length, colon, state, list, err);
    if (state->spans && is_span(text, length, ends))
        return read_span(text, length, ends, list, err);
    if (read_piece(text, length, state, &value, err) != RC_OK || add_room(list, 1, err) != RC_OK)
        return RC_FAIL;
    list->v[list->n++] = value;
    return RC_OK;
}

static enum rc_status
read_list(const char *text, struct list_state *state, struct numbers *list, struct rc_err *err)
{
    const char *digits = "0123456789";
    size_t whole = 0; /* digits of the last entry, if it has nothing else */

    for (const char *s = text, *end; s != NULL; s = *end == ',' ? end + 1 : NULL) {
        end = s + strcspn(s, ",");
        if (whole > 0 && strspn(s, digits) > 0 && memchr(s, ':', (size_t)(end - s)) != NULL)
            return rc_err_set(err,
                              "'%.*s': the decimal mark is a point; for a number before a range "
                              "write the range first, or '%.*s.0'",
                              (int)((size_t)(end - s) + whole + 1), s - whole - 1, (int)whole,
                              s - whole - 1);
        whole = strspn(s, digits) == (size_t)(end - s) ? (size_t)(end - s) : 0;
        if (read_entry(s, (size_t)(end - s), state, list, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

static enum rc_status
read_numbers(const char *text, struct list_state state, struct numbers *list, struct rc_err *err)
{
    *list = (struct numbers){0};
    if (read_list(text, &state, list, err) == RC_OK) {
        list->per_metre = state.per_metre;
        return RC_OK;
    }
    free(list->v);
    *list = (struct numbers){.no_memory = list->no_memory};
    return RC_FAIL;
}

enum rc_status
unit_numbers(const char *text, enum unit unit, struct numbers *list, struct rc_err *err)
{
    return read_numbers(text, (struct list_state){.unit = unit}, list, err);
}

enum rc_status
unit_whole_numbers(const char *text, struct numbers *list, struct rc_err *err)
{
    return read_numbers(text, (struct list_state){.spans = true}, list, err);
}

enum rc_status
unit_forces(const char *text, struct numbers *list, struct rc_err *err)
{
    return read_numbers(text, (struct list_state){.unit = UNIT_N, .forces = true}, list, err);
}

/* "0,5", "0,05m" and "0,1%". In "0,10um" and "0,100" the list is as likely: a decimal rarely ends with 0. */
static bool
fraction(const char *digits, size_t n)
{
    const char *unit = digits + n;

    if (strtod(digits, NULL) == 0 || (digits[n - 1] == '0' && digits[0] != '0'))
        return false;
    return strpbrk(unit, ".,:") == NULL &&
           !((*unit == 'e' || *unit == 'E') && strchr("+-0123456789", unit[1]) != NULL);
}

bool
unit_decimal_comma(const char *text)
{
    const char *digits = "0123456789", *s = text + (*text == '-' || *text == '+'), *end;
    size_t whole = strspn(s, digits), part;
    double a, b;

    if (whole == 0 || s[whole] != ',')
        return false;
    part = strspn(s + whole + 1, digits);
    if (part == 0)
        return false;
    if (whole == 1 && *s == '0')
        return fraction(s + whole + 1, part);
    end = s + whole + 1 + part;
    if (*end != '\0' || (part > 3 && strcmp(end - 3, "000") == 0))
        return false; /* a list of large numbers, not digits after a comma */
    a = strtod(s, NULL);
    b = strtod(s + whole + 1, NULL);
    return a > 0 && b > 0 && a < 10 * b && b < 10 * a;
}

/* ---- conductivities ---- */

enum rc_status
unit_conductivities(const char *text, double k[2], const char **conductance, struct rc_err *err)
{
    const bool heat = strchr(text, 'W') != NULL, current = strchr(text, 'S') != NULL;
    struct numbers list;

    if (heat && current)
        return rc_err_set(err, "give both in W/mK or both in S/m, or both without a unit");
    if (unit_numbers(text, current ? UNIT_S_M : UNIT_W_MK, &list, err) != RC_OK)
        return RC_FAIL;
    for (size_t b = 0; b < 2; b++)
        k[b] = list.n == 2 ? list.v[b] : NAN;
    free(list.v);
    if (isnan(k[0]))
        return rc_err_set(err, "it must be K1,K2, one for each body, as in 45W/mK,16W/mK");
    if (!(fmin(k[0], k[1]) > 0))
        return rc_err_set(err, "%g: it must be above 0", fmin(k[0], k[1]));
    *conductance = heat ? "W/K" : current ? "S" : NULL;
    return RC_OK;
}
