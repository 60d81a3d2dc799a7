/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers and words for people to read. Without _to a text lives until the end of the block. */
#ifndef RC_SHOWN_NUMBERS_H
#define RC_SHOWN_NUMBERS_H

#include <stdio.h>

#include "libcontact/owned.h"

enum {
    SHOWN_NUMBER = 48
};

/* "1.29 u" for 1.29e-6 and "m": this many digits, and the prefix of the unit that brings the number to
 * 1..1000. The caller adds the unit. Only m, Pa and N get prefixes. */
const char *shown_number_to(char text[SHOWN_NUMBER], double value, int digits, const char *unit);
#define shown_number(value, digits, unit)                                                          \
    shown_number_to((char[SHOWN_NUMBER]){""}, value, digits, unit)
/* "1.29 um": six digits and the unit. */
const char *shown_in_unit_to(char text[SHOWN_NUMBER], double value, const char *unit);
#define shown_in_unit(value, unit) shown_in_unit_to((char[SHOWN_NUMBER]){""}, value, unit)
/* "0.012 %", "137 %" for 0.00012, 1.37: this many digits, but all before the decimal point. An exponent only
 * above 1e15 %. NaN: "unknown". */
const char *shown_percent_to(char text[SHOWN_NUMBER], double share, int digits);
#define shown_percent(share, digits) shown_percent_to((char[SHOWN_NUMBER]){""}, share, digits)
/* Text from a file, up to n bytes, without control characters of a terminal. */
void shown_words(FILE *out, const char *text, size_t n);
/* A word of a command, in quotes for a shell if it needs them. */
void shown_shell_word(FILE *out, const char *word);
/* "37 MiB", "7.4 MiB": in the largest unit not above it, with one decimal below 10. */
const char *shown_bytes_to(char text[SHOWN_NUMBER], double bytes);
#define shown_bytes(bytes) shown_bytes_to((char[SHOWN_NUMBER]){""}, bytes)
/* "0.163 mm2", for square metres. */
const char *shown_area_to(char text[SHOWN_NUMBER], double area);
#define shown_area(area) shown_area_to((char[SHOWN_NUMBER]){""}, area)

#endif
