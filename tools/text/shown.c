/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shown.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

enum {
    DIGITS = 6
};

const char *
shown_number_to(char text[SHOWN_NUMBER], double value, int digits, const char *unit)
{
    bool known = (strcmp(unit, "m") == 0 || strcmp(unit, "Pa") == 0 || strcmp(unit, "N") == 0) &&
                 isfinite(value);
    int most = strcmp(unit, "m") == 0 ? 0 : 12, power = 0; /* Mm are not usual */

    if (known && value != 0) {
        power = 3 * (int)floor(log10(fabs(value)) / 3);
        power = power > most ? most : rc_prefix_of(power) == NULL ? 0 : power;
    }
    snprintf(text, SHOWN_NUMBER, "%.*g", digits, value / pow(10, power));
    if (known && fabs(atof(text)) >= 1000 && power + 3 <= most) { /* rounding gave 1000 */
        power += 3;
        snprintf(text, SHOWN_NUMBER, "%.*g", digits, value / pow(10, power));
    }
    snprintf(text + strlen(text), SHOWN_NUMBER - strlen(text), "%s%s", *unit == '\0' ? "" : " ",
             rc_prefix_of(power));
    return text;
}

const char *
shown_in_unit_to(char text[SHOWN_NUMBER], double value, const char *unit)
{
    size_t n;

    shown_number_to(text, value, DIGITS, unit);
    n = strlen(text);
    snprintf(text + n, SHOWN_NUMBER - n, "%s", unit);
    return text;
}

const char *
shown_percent_to(char text[SHOWN_NUMBER], double share, int digits)
{
    const double percent = 100 * share, large = 1e15;
    const int most = 15; /* decimals */
    char rounded[SHOWN_NUMBER];
    int decimals;
    size_t n;

    if (isnan(share))
        return strcpy(text, "unknown");
    snprintf(rounded, sizeof rounded, "%.*e", digits - 1, percent);
    if (!(fabs(percent) < large)) {
        snprintf(text, SHOWN_NUMBER, "%.*g %%", digits, percent);
        return text;
    }
    decimals = digits - 1 - atoi(strchr(rounded, 'e') + 1);
    decimals = decimals < 0 ? 0 : decimals > most ? most : decimals;
    n = (size_t)snprintf(text, SHOWN_NUMBER, "%.*f", decimals, percent);
    while (decimals > 0 && text[n - 1] == '0') /* as %g */
        n--;
    snprintf(text + (text[n - 1] == '.' ? n - 1 : n), 3, " %%");
    return text;
}

void
shown_words(FILE *out, const char *text, size_t n)
{
    size_t size;

    for (size_t k = 0; k < n && text[k] != '\0'; k += size == 0 ? 1 : size)
        putc((size = rc_control_size(text + k)) > 0 ? '?' : text[k], out);
}

const char *
shown_bytes_to(char text[SHOWN_NUMBER], double bytes)
{
    static const char *const name[] = {"bytes", "KiB", "MiB"};
    size_t k = 0;
    int decimals;

    while (k + 1 < sizeof name / sizeof *name && round(bytes) >= 1024) { /* rounded as printed */
        bytes /= 1024;
        k++;
    }
    decimals = round(bytes) < 10 && round(10 * bytes) != 10 * round(bytes);
    snprintf(text, SHOWN_NUMBER, "%.*f %s", decimals, bytes, name[k]);
    return text;
}

const char *
shown_area_to(char text[SHOWN_NUMBER], double area)
{
    static const struct {
        const char *name;
        double size;
    } unit[] = {{"m2", 1}, {"mm2", 1e-6}, {"um2", 1e-12}, {"nm2", 1e-18}};
    size_t k = 0;

    while (k + 1 < sizeof unit / sizeof *unit && area < 1e-3 * unit[k].size)
        k++;
    snprintf(text, SHOWN_NUMBER, "%.*g %s", DIGITS, area / unit[k].size, unit[k].name);
    return text;
}

void
shown_shell_word(FILE *out, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "%+,-./:=@_";

    if (*word != '\0' && word[strspn(word, plain)] == '\0') {
        fputs(word, out);
        return;
    }
    putc('\'', out);
    for (; *word != '\0'; word++)
        fputs(*word == '\'' ? "'\\''" : (const char[]){*word, '\0'}, out);
    putc('\'', out);
}
