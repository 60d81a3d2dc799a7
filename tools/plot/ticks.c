/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ticks.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

#define MINUS "\xe2\x88\x92"

/* Prints a number with a minus sign in place of the hyphen. */
static void
put_number(char text[TICKS_TEXT], const char *format, int digits, double value)
{
    char plain[TICKS_TEXT];
    size_t n = 0;

    snprintf(plain, sizeof plain, format, digits, value);
    if (strspn(plain, "-0.") == strlen(plain)) /* -0.00 */
        value = 0;
    snprintf(plain, sizeof plain, format, digits, value == 0 ? 0.0 : value);
    for (const char *s = plain; *s != '\0' && n + 4 < TICKS_TEXT; s++) {
        if (*s == '-') {
            memcpy(text + n, MINUS, 3);
            n += 3;
        } else {
            text[n++] = *s;
        }
    }
    text[n] = '\0';
}

/* ---- units ---- */

static bool
takes_prefix(const char *unit)
{
    static const char *const units[] = {"m",  "Pa", "N",   "J",   "W",    "s",    "V",  "A",
                                        "Hz", "K",  "N/m", "m/s", "J/m2", "W/m2", "Nm", "J/m"};

    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (strcmp(units[k], unit) == 0)
            return true;
    return false;
}

static const char *const raised_digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};

const char *
power_text_to(char text[TICKS_TEXT], int power)
{
    char digits[16];

    snprintf(digits, sizeof digits, "%d", abs(power));
    strcpy(text, power < 0 ? "10⁻" : "10");
    for (const char *s = digits; *s != '\0'; s++)
        strcat(text, raised_digits[*s - '0']);
    return text;
}

/* Writes a prefix with the Greek letter mu. */
static const char *
prefix_of(int power)
{
    const char *prefix = rc_prefix_of(power);

    return prefix != NULL && strcmp(prefix, "u") == 0 ? "µ" : prefix;
}

/* A unit for print: raised powers, the Greek mu and a raised point. A digit is a power if a letter is before
 * it and none after it: m2, not H2O. */
const char *
unit_text_to(char text[TICKS_TEXT], const char *unit)
{
    size_t n = 0;

    if (strcmp(unit, "um") == 0)
        unit = "µm";
    for (const char *s = unit; *s != '\0' && n + 8 < TICKS_TEXT; s++) {
        bool behind = s > unit && isalpha((unsigned char)s[-1]);
        bool minus = behind && *s == '-' && isdigit((unsigned char)s[1]);
        const char *digit = minus ? s + 1 : s;
        bool power = behind && isdigit((unsigned char)*digit) && !isalnum((unsigned char)digit[1]);

        if (power) {
            /* 0 to 9; the analyzer cannot conclude this from isdigit */
            /* NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage) */
            n += (size_t)sprintf(text + n, "%s%s", minus ? "⁻" : "", raised_digits[*digit - '0']);
            s = digit;
        } else if (*s == '*') {
            n += (size_t)sprintf(text + n, "·");
        } else {
            text[n++] = *s;
        }
    }
    text[n] = '\0';
    return text;
}

void
scale_choose(struct scale *scale, double largest, const char *unit)
{
    const int least = -306; /* of a power of 10 with full precision */
    double size = fabs(largest);
    int power = size > 0 && isfinite(size) ? 3 * (int)floor(log10(size) / 3 + 1e-12) : 0;

    if (strcmp(unit, "1") == 0)
        unit = "";
    if (!takes_prefix(unit) && size >= 0.1 && size < 1e4)
        power = 0;
    power = power < least ? least : power;
    scale->size = pow(10, power);
    if (takes_prefix(unit) && prefix_of(power) != NULL)
        snprintf(scale->unit, sizeof scale->unit, "%s%.48s", prefix_of(power), unit_text(unit));
    else if (power == 0)
        snprintf(scale->unit, sizeof scale->unit, "%.48s", unit_text(unit));
    else
        snprintf(scale->unit, sizeof scale->unit, "%.30s%s%.24s", power_text(power),
                 *unit == '\0' ? "" : " ", unit_text(unit));
}

void
scale_keep(struct scale *s, const char *unit)
{
    s->size = 1;
    unit_text_to(s->unit, strcmp(unit, "1") == 0 ? "" : unit);
}

/* A prefix is raised to the power of the unit: mm2 is 1e-6 m2. */
bool
scale_given(struct scale *scale, const char *asked, const char *unit)
{
    bool under = strncmp(unit, "1/", 2) == 0;
    const char *micro = strncmp(asked, "µ", 2) == 0 ? asked + 2 : NULL, *own = unit, *prefixed;
    size_t letters = strcspn(unit, "/ 0123456789"),
           n; /* of the first symbol, which has the prefix */
    int power = 0, raised = isdigit((unsigned char)unit[letters]) ? atoi(unit + letters) : 1;
    char text[TICKS_TEXT];

    if (under) {
        if (strncmp(asked, "1/", 2) != 0 || !scale_given(scale, asked + 2, unit + 2))
            return false;
        snprintf(text, sizeof text, "1/%.40s", scale->unit);
        strcpy(scale->unit, text);
        scale->size = 1 / scale->size;
        return true;
    }
    if (strcmp(unit, "1") == 0) {
        scale->size = strcmp(asked, "%") == 0 ? 0.01 : 1;
        strcpy(scale->unit, strcmp(asked, "%") == 0 ? "%" : "");
        return strcmp(asked, "%") == 0 || strcmp(asked, "1") == 0;
    }
    prefixed = micro != NULL ? micro : asked;
    if (strlen(prefixed) < strlen(own) ||
        strcmp(prefixed + strlen(prefixed) - strlen(own), own) != 0)
        return false;
    n = strlen(prefixed) - strlen(own);
    if (micro != NULL ? n != 0 : n > 0 && !rc_prefix_power(asked, n, &power))
        return false;
    scale->size = pow(10, raised * (micro != NULL ? -6 : power));
    snprintf(scale->unit, sizeof scale->unit, "%.4s%.48s",
             micro != NULL || power == -6 ? "µ"
             : n > 0                      ? prefix_of(power)
                                          : "",
             unit_text(own));
    return true;
}

const char *
scale_value_to(char text[TICKS_TEXT], double value, const char *unit)
{
    struct scale scale;
    size_t n;

    /* rounded first, because the rounded number may need the next prefix: 999.96 nm is 1 um */
    snprintf(text, TICKS_TEXT, "%.3e", value);
    value = strtod(text, NULL);
    scale_choose(&scale, value, unit);
    put_number(text, "%.*g", 4, value / scale.size);
    n = strlen(text);
    if (value != 0 && scale.unit[0] != '\0')
        snprintf(text + n, TICKS_TEXT - n, "%s%.36s", strncmp(scale.unit, "10", 2) ? " " : "·",
                 scale.unit);
    return text;
}

void
scale_label(char *text, size_t size, const char *quantity, const struct scale *scale)
{
    if (scale->unit[0] == '\0')
        snprintf(text, size, "%s", quantity);
    else
        snprintf(text, size, "%s (%s)", quantity, scale->unit);
}

/* ---- marks ---- */

void
ticks_choose(struct ticks *t, double lo, double hi, double most)
{
    static const int digits[] = {1, 2, 5, 10};
    const double slack = 1e-9; /* a mark exactly at the end is included */
    double least = (hi - lo) / most, step;
    int k = 0;

    *t = (struct ticks){.digit = 1, .first = 1, .last = 0}; /* no marks */
    if (!isfinite(lo) || !isfinite(hi))
        return;
    /* within the resolution of doubles, so that a range of one unit in the last place gets a mark too; and
     * within their range */
    least = fmax(least, 1e-15 * fmax(fabs(lo), fabs(hi)));
    least = fmin(fmax(least, 1e-307), 1e307);
    t->power = (int)floor(log10(least));
    while (k < 3 && digits[k] * pow(10, t->power) < least * (1 - slack))
        k++;
    t->digit = digits[k];
    if (t->digit == 10) {
        t->digit = 1;
        t->power++;
    }
    step = ticks_at(t, 1);
    t->first = (long long)ceil(lo / step - slack);
    t->last = (long long)floor(hi / step + slack);
}

double
ticks_at(const struct ticks *t, long long k)
{
    double n = (double)k * t->digit;

    /* dividing by a whole power of ten is exact where multiplying by 0.1 is not */
    return t->power < 0 ? n / pow(10, -t->power) : n * pow(10, t->power);
}

const char *
ticks_text_to(char text[TICKS_TEXT], const struct ticks *t, long long k)
{
    put_number(text, "%.*f", t->power < 0 ? -t->power : 0, ticks_at(t, k));
    return text;
}
