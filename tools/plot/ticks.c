#include "ticks.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

#define MINUS "\xe2\x88\x92"

/* Prints a number with a real minus sign in place of the hyphen. */
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
    static const char *const units[] = {"m", "Pa", "N", "J", "W", "s", "V", "A", "Hz", "K", "N/m"};

    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (strcmp(units[k], unit) == 0)
            return true;
    return false;
}

const char *
power_text(char text[TICKS_TEXT], int power)
{
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    char digits[16];

    snprintf(digits, sizeof digits, "%d", abs(power));
    strcpy(text, power < 0 ? "10⁻" : "10");
    for (const char *s = digits; *s != '\0'; s++)
        strcat(text, raised[*s - '0']);
    return text;
}

/* As figures have it: a real mu. */
static const char *
prefix_of(int power)
{
    const char *prefix = rc_prefix_of(power);

    return prefix != NULL && strcmp(prefix, "u") == 0 ? "µ" : prefix;
}

void
scale_choose(struct scale *scale, double largest, const char *unit)
{
    double size = fabs(largest);
    char text[TICKS_TEXT];
    int power = size > 0 && isfinite(size) ? 3 * (int)floor(log10(size) / 3 + 1e-12) : 0;

    if (strcmp(unit, "1") == 0)
        unit = "";
    if (!takes_prefix(unit) && size >= 0.1 && size < 1e4)
        power = 0;
    scale->size = pow(10, power);
    if (takes_prefix(unit) && prefix_of(power) != NULL)
        snprintf(scale->unit, sizeof scale->unit, "%s%s", prefix_of(power), unit);
    else if (power == 0)
        snprintf(scale->unit, sizeof scale->unit, "%.48s", unit);
    else
        snprintf(scale->unit, sizeof scale->unit, "%.30s%s%.24s", power_text(text, power),
                 *unit == '\0' ? "" : " ", unit);
}

const char *
scale_value(char text[TICKS_TEXT], double value, const char *unit)
{
    struct scale scale;
    size_t n;

    /* rounded first, because that can be what needs the next prefix: 999.96 nm is 1 um */
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
    const double slack = 1e-9; /* a mark at the very end is meant to be there */
    double least = (hi - lo) / most, step;
    int k = 0;

    /* as far as doubles tell numbers apart: a range of one unit in the last place gets a mark too
     */
    least = fmax(least, 1e-15 * fmax(fabs(lo), fabs(hi)));
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
ticks_text(char text[TICKS_TEXT], const struct ticks *t, long long k)
{
    put_number(text, "%.*f", t->power < 0 ? -t->power : 0, ticks_at(t, k));
    return text;
}
