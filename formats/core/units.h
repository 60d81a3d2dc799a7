/* SI prefixes, the powers of ten that stand before a unit, and the units of length. */
#ifndef RC_CORE_UNITS_H
#define RC_CORE_UNITS_H

#include <stdbool.h>
#include <stddef.h>

struct rc_prefix {
    const char *text; /* UTF-8 */
    int power;        /* of ten */
};

/* Those from femto to tera, "" for none, and centi, in the order of their powers; of several
 * spellings of one power the usual one stands first ("u", then U+00B5, then U+03BC). Ended by text
 * NULL. */
extern const struct rc_prefix rc_prefixes[];

/* The power that text[0..n) stands for; false when it is no prefix. */
bool rc_prefix_power(const char *text, size_t n, int *power);
/* The usual spelling of a power from -15 to 12 in steps of 3; NULL for another power. */
const char *rc_prefix_of(int power);
/* Ten to the power of a prefix, rounded correctly: the double 1e-06 for -6. */
double rc_prefix_factor(int power);

/* Metres per unit of "nm", "um", "µm" (UTF-8 or Latin-1, either code point), "Å", "in", ..., and of
 * words in either case, one or several: "Micrometers", "mil", "inches"; false when it is no unit of
 * length. */
bool rc_length_unit(const char *text, size_t n, double *metres);
/* The same of a word up to its NUL; NAN when it is no unit of length. */
double rc_word_metres(const char *word);

#endif
