/* Numbers as a figure shows them: a unit that fits, and marks at steps of 1, 2 or 5. */
#ifndef RC_TICKS_H
#define RC_TICKS_H

#include <stdbool.h>
#include <stddef.h>

enum {
    TICKS_TEXT = 64
};

struct scale {
    double size;           /* of the unit, in SI               */
    char unit[TICKS_TEXT]; /* "µm", "GPa", "10⁻³"; may be empty */
};

/* "10⁻³" */
const char *power_text(char text[TICKS_TEXT], int power);
/* A unit as it is printed: powers raised, a real mu: "m³/s". */
const char *unit_text(char text[TICKS_TEXT], const char *unit);
/* A unit in which `largest` (SI, its size counts) is written with one to three digits before the
 * point: a prefix where the unit takes one, a power of ten where not. `unit` is as in a stream. */
void scale_choose(struct scale *scale, double largest, const char *unit);
/* "5.83 GPa": four digits of the value in the unit that fits it; "0" has none. */
const char *scale_value(char text[TICKS_TEXT], double value, const char *unit);
/* The unit that was asked for, as in "kN", "mm2", "1/GPa" or, of what has none, "%": `unit` itself or
 * with a prefix. Whether it is one. */
bool scale_given(struct scale *scale, const char *asked, const char *unit);
/* "Gap (µm)": what an axis is, with the unit in brackets. */
void scale_label(char *text, size_t size, const char *quantity, const struct scale *scale);

/* Marks at k * step for k from first to last; step is digit * 10^power. */
struct ticks {
    long long first, last;
    int digit, power;
};

/* The smallest step that cuts lo..hi (lo < hi) into at most `most` parts. */
void ticks_choose(struct ticks *ticks, double lo, double hi, double most);
double ticks_at(const struct ticks *ticks, long long k);
const char *ticks_text(char text[TICKS_TEXT], const struct ticks *ticks, long long k);

#endif
