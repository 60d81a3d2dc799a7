/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "units.h"

#include <math.h>
#include <string.h>

#include "header.h"

const struct rc_prefix rc_prefixes[] = {
    {"f", -15},       {"p", -12}, {"n", -9}, {"u", -6}, {"\xc2\xb5", -6}, /* U+00B5, micro sign */
    {"\xce\xbc", -6},                                                     /* U+03BC, Greek mu   */
    {"m", -3},        {"c", -2},  {"", 0},   {"k", 3},  {"M", 6},
    {"G", 9},         {"T", 12},  {NULL, 0},
};

bool
rc_prefix_power(const char *text, size_t n, int *power)
{
    for (const struct rc_prefix *p = rc_prefixes; p->text != NULL; p++)
        if (strlen(p->text) == n && memcmp(p->text, text, n) == 0) {
            *power = p->power;
            return true;
        }
    return false;
}

const char *
rc_prefix_of(int power)
{
    if (power % 3 != 0)
        return NULL;
    for (const struct rc_prefix *p = rc_prefixes; p->text != NULL; p++)
        if (p->power == power)
            return p->text;
    return NULL;
}

double
rc_prefix_factor(int power)
{
    double whole = 1; /* exact up to 1e22 */

    for (int k = 0; k < (power < 0 ? -power : power); k++)
        whole *= 10;
    return power < 0 ? 1 / whole : whole;
}

/* Symbols, which are case-sensitive, and words in upper or lower case, singular and plural, separated by '|'.
 * The micro sign is U+00B5, the Greek mu or a byte of Latin-1, and NanoScope writes ~ for it. Angstrom is a
 * letter, a separate sign or a byte of Latin-1. */
static const struct {
    double metres;
    const char *symbols, *words;
} lengths[] = {
    {1, "m", "metre|meter"},
    {1e-9, "nm", "nanometre|nanometer"},
    {1e-6, "um|\xc2\xb5m|\xce\xbcm|\xb5m|~m", "micrometre|micrometer|mikrometer|micron"},
    {1e-3, "mm", "millimetre|millimeter"},
    {1e-2, "cm", "centimetre|centimeter"},
    {1e3, "km", ""},
    {1e-12, "pm", "picometre|picometer"},
    {1e-15, "fm", ""},
    {1e-10, "\xc3\x85|\xe2\x84\xab|\xc5|AA",
     "ang|angstrom|\xc3\xa5ngstr\xc3\xb6m|\xc3\x85ngstr\xc3\xb6m"},
    {25.4e-3, "in|\"", "inch|inche"}, /* and s */
    {25.4e-6, "", "mil|thou"},
    {25.4e-9, "uin|u\"|\xc2\xb5in|\xce\xbcin|\xb5in|\xc2\xb5\"|\xce\xbc\"|\xb5\"",
     "microinch|microinche|uinch|\xc2\xb5inch|\xce\xbcinch|\xb5inch"},
};

static bool
is_among(const char *text, size_t n, const char *symbols)
{
    size_t length = strcspn(symbols, "|");

    while (length != n || memcmp(symbols, text, n) != 0) {
        if (symbols[length] == '\0')
            return false;
        symbols += length + 1;
        length = strcspn(symbols, "|");
    }
    return n > 0;
}

bool
rc_length_unit(const char *text, size_t n, double *metres)
{
    struct rc_piece word = {text, n},
                    one = {text, n > 1 && (text[n - 1] | 0x20) == 's' ? n - 1 : n};

    for (int words = 0; words < 2 && n > 0; words++)
        for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++)
            if (words ? rc_piece_is(word, lengths[k].words) || rc_piece_is(one, lengths[k].words)
                      : is_among(text, n, lengths[k].symbols)) {
                *metres = lengths[k].metres;
                return true;
            }
    return false;
}

double
rc_word_metres(const char *word)
{
    double metres;

    return rc_length_unit(word, strlen(word), &metres) ? metres : NAN;
}
