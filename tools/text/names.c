/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "names.h"

#include <ctype.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* ---- spelling ---- */

static const struct {
    const char *british, *american;
} spellings[] = {
    {"isation", "ization"},
    {"colour", "color"},
    {"grey", "gray"},
    {"centre", "center"},
};

enum {
    SPELLINGS = sizeof spellings / sizeof *spellings
};

/* Writes `name` with `to` in place of the first `from`; false if `from` does not occur or the text is too
 * long. */
static bool
replace(const char *name, const char *from, const char *to, char text[NAME_SIZE])
{
    const char *at = strstr(name, from);

    if (at == NULL || strlen(name) - strlen(from) + strlen(to) >= NAME_SIZE)
        return false;
    snprintf(text, NAME_SIZE, "%.*s%s%s", (int)(at - name), name, to, at + strlen(from));
    return true;
}

const char *
name_respelt(const char *name, char text[NAME_SIZE])
{
    for (size_t k = 0; k < SPELLINGS; k++)
        if (replace(name, spellings[k].british, spellings[k].american, text) ||
            replace(name, spellings[k].american, spellings[k].british, text))
            return text;
    return NULL;
}

bool
name_same(const char *a, size_t n, const char *b, size_t m)
{
    char typed[NAME_SIZE], other[NAME_SIZE];

    if (n == m && memcmp(a, b, n) == 0)
        return true;
    if (n >= NAME_SIZE)
        return false;
    snprintf(typed, sizeof typed, "%.*s", (int)n, a);
    return name_respelt(typed, other) != NULL && strlen(other) == m && memcmp(other, b, m) == 0;
}

/* ---- mistakes ---- */

static size_t
least(size_t a, size_t b)
{
    return a < b ? a : b;
}

static bool
same_letter(char a, char b)
{
    return tolower((unsigned char)a) == tolower((unsigned char)b);
}

/* Damerau-Levenshtein distance, row by row of its table. d[i][j] is the distance of the first i letters of a
 * from the first j of b. */
static size_t
mistakes(const char *a, size_t n, const char *b, size_t m)
{
    size_t row[3][NAME_SIZE];
    size_t *before = row[0], *last = row[1], *now = row[2], *spare;

    for (size_t j = 0; j <= m; j++)
        last[j] = j;
    for (size_t i = 1; i <= n; i++) {
        now[0] = i;
        for (size_t j = 1; j <= m; j++) {
            now[j] = last[j - 1] + !same_letter(a[i - 1], b[j - 1]);
            now[j] = least(now[j], least(last[j], now[j - 1]) + 1);
            if (i > 1 && j > 1 && same_letter(a[i - 1], b[j - 2]) &&
                same_letter(a[i - 2], b[j - 1]))
                now[j] = least(now[j], before[j - 2] + 1);
        }
        spare = before;
        before = last;
        last = now;
        now = spare;
    }
    return last[m];
}

static bool
is_joint(char c)
{
    return c == '-' || c == '_' || c == '.';
}

/* True if `part` is a whole part of the name, between hyphens, underscores or points. */
static bool
is_part(const char *part, size_t n, const char *name)
{
    for (const char *s = name; (s = strstr(s, part)) != NULL; s++)
        if ((s == name || is_joint(s[-1])) && (s[n] == '\0' || is_joint(s[n])))
            return true;
    return false;
}

/* Distance of a typed name from a name: the number of letters left out, added, changed, or exchanged with
 * their neighbour. Upper and lower case are equal. The typed name may be a whole part of the name, as
 * "pressure" of "mean-pressure" and "area" of "contact_area". Its distance is then slightly larger than for
 * the most mistakes allowed. SIZE_MAX: too different. */
static size_t
distance(const char *typed, const char *name)
{
    size_t n = strlen(typed), m = strlen(name), most = n < 4 ? 1 : n < 9 ? 2 : 3, d;

    if (n == 0 || n >= NAME_SIZE || m >= NAME_SIZE)
        return SIZE_MAX;
    d = mistakes(typed, n, name, m);
    if (d <= most && d < n)
        return d;
    return n > 2 && is_part(typed, n, name) ? most + 1 : SIZE_MAX;
}

/* The next digit of a name, or its end. */
static const char *
next_digit(const char *s)
{
    return s + strcspn(s, "0123456789");
}

bool
name_misspelt(const char *typed, const char *name)
{
    const size_t letters_per_mistake = 5, n = strlen(typed), m = strlen(name);
    const char *a = next_digit(typed), *b = next_digit(name);

    if (n < 3 || n >= NAME_SIZE || m >= NAME_SIZE)
        return false;
    while (*a != '\0' && *a == *b) {
        a = next_digit(a + 1);
        b = next_digit(b + 1);
    }
    return *a == *b &&
           mistakes(typed, n, name, m) <= (n < letters_per_mistake ? 1 : n / letters_per_mistake);
}

void
name_nearer(const char *typed, const char *name, char nearest[NAME_SIZE])
{
    if (distance(typed, name) < distance(typed, nearest))
        snprintf(nearest, NAME_SIZE, "%s", name);
}

const char *
name_meant(const char *nearest, char text[NAME_MEANT])
{
    text[0] = '\0';
    if (*nearest != '\0')
        snprintf(text, NAME_MEANT, ": did you mean %s?", nearest);
    return text;
}
