/* Numbers and words for people to read. */
#ifndef RC_SHOWN_NUMBERS_H
#define RC_SHOWN_NUMBERS_H

#include <stdio.h>

enum {
    SHOWN_NUMBER = 48
};

/* "1.29 u" for 1.29e-6 and "m": this many digits, and the prefix of the unit that brings the number to
 * 1..1000. The caller adds the unit. Only m, Pa and N get prefixes. */
const char *shown_number(char text[SHOWN_NUMBER], double value, int digits, const char *unit);
/* "1.29 um": six digits and the unit. */
const char *shown_in_unit(char text[SHOWN_NUMBER], double value, const char *unit);
/* Text from a file, up to n bytes, without control characters of a terminal. */
void shown_words(FILE *out, const char *text, size_t n);
/* "37 MiB", "7.4 MiB": in the largest unit not above it, with one decimal below 10. */
const char *shown_bytes(char text[SHOWN_NUMBER], double bytes);
/* "0.163 mm2", for square metres. */
const char *shown_area(char text[SHOWN_NUMBER], double area);

#endif
