/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SI prefixes (powers of ten before a unit), and units of length. */
#ifndef RC_CORE_UNITS_H
#define RC_CORE_UNITS_H

#include <stdbool.h>
#include <stddef.h>

struct rc_prefix {
    const char *text; /* UTF-8 */
    int power;        /* power of ten */
};

/* The prefixes run from femto to tera, with "" for none, and centi, in the order of their powers. The usual
 * spelling of a power comes first ("u", then U+00B5, then U+03BC). The last has text NULL. */
extern const struct rc_prefix rc_prefixes[];

/* The power of the prefix text[0..n); false when it is not a prefix. */
bool rc_prefix_power(const char *text, size_t n, int *power);
/* The usual spelling of a power from -15 to 12 in steps of 3; NULL for another power. */
const char *rc_prefix_of(int power);
/* Ten to the power of a prefix, rounded correctly: the double 1e-06 for -6. */
double rc_prefix_factor(int power);

/* Metres per unit of "nm", "um", "µm" (UTF-8 or Latin-1, either code point), "Å", "in", ... Words may be in
 * upper or lower case, singular or plural: "Micrometers", "mil", "inches". False when it is not a unit of
 * length. */
bool rc_length_unit(const char *text, size_t n, double *metres);
/* The same for a word that ends with NUL; NAN if it is not a unit of length. */
double rc_word_metres(const char *word);

#endif
