/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers in a figure: a suitable unit, and marks at steps of 1, 2 or 5. */
#ifndef RC_TICKS_H
#define RC_TICKS_H

#include <stdbool.h>
#include <stddef.h>

enum {
    TICKS_TEXT = 64
};

struct scale {
    double size;           /* the unit in SI */
    char unit[TICKS_TEXT]; /* "µm", "GPa", "10⁻³"; may be empty */
};

/* "10⁻³"; without _to such a text lives until the end of the block. */
const char *power_text_to(char text[TICKS_TEXT], int power);
#define power_text(power) power_text_to((char[TICKS_TEXT]){""}, power)
/* A unit for print, with raised powers and the Greek mu: "m³/s". */
const char *unit_text_to(char text[TICKS_TEXT], const char *unit);
#define unit_text(unit) unit_text_to((char[TICKS_TEXT]){""}, unit)
/* A unit in which the magnitude of `largest` (SI) has one to three digits before the point. It has a prefix,
 * or a power of ten if the unit takes no prefix. `unit` is as in a stream. */
void scale_choose(struct scale *scale, double largest, const char *unit);
/* The unit without a prefix, for axes of many powers of ten. */
void scale_keep(struct scale *scale, const char *unit);
/* "5.83 GPa": four digits of the value in a suitable unit; "0" has no unit. */
const char *scale_value_to(char text[TICKS_TEXT], double value, const char *unit);
#define scale_value(value, unit) scale_value_to((char[TICKS_TEXT]){""}, value, unit)
/* The requested unit, such as "kN", "mm2", "1/GPa" or, for plain numbers, "%": `unit` with or without a
 * prefix. False for another text. */
bool scale_given(struct scale *scale, const char *asked, const char *unit);
/* "Gap (µm)": the label of an axis with the unit in brackets. */
void scale_label(char *text, size_t size, const char *quantity, const struct scale *scale);

/* Marks are at k * step for k from first to last; step is digit * 10^power. */
struct ticks {
    long long first, last;
    int digit, power;
};

/* The smallest step that divides lo..hi (lo < hi) into at most `most` parts. */
void ticks_choose(struct ticks *ticks, double lo, double hi, double most);
double ticks_at(const struct ticks *ticks, long long k);
const char *ticks_text_to(char text[TICKS_TEXT], const struct ticks *ticks, long long k);
#define ticks_text(ticks, k) ticks_text_to((char[TICKS_TEXT]){""}, ticks, k)

#endif
