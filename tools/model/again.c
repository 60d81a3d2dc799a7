/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Warnings that several cases share: of the first case in full, of the others in one line at the end.
 */
#include "model.h"

#include <stdarg.h>
#include <string.h>

static void
add_range(struct again *a)
{
    size_t n = strlen(a->cases);

    if (n + 48 > sizeof a->cases) {
        snprintf(a->cases + n, sizeof a->cases - n, "%s",
                 n > 3 && a->cases[n - 1] == '.' ? "" : ", ...");
        return;
    }
    snprintf(a->cases + n, sizeof a->cases - n, a->from == a->to ? "%s%zu" : "%s%zu to %zu",
             n == 0 ? "" : ", ", a->from, a->to);
}

static void
add_case(struct again *a, size_t number)
{
    if (a->from > 0 && (number == a->to || number == a->to + 1)) {
        a->to = number;
        return;
    }
    if (a->from > 0)
        add_range(a);
    a->from = a->to = number;
    a->several = *a->cases != '\0';
}

void
course_warn(struct course *c, const char *words, const char *format, ...)
{
    struct again *a = c->again, *const end = a + COURSE_WARNINGS;
    char text[1024];
    va_list ap;

    while (a < end && a->words != NULL && strcmp(a->words, words) != 0)
        a++;
    if (a < end && a->words != NULL && c->number != a->first) {
        add_case(a, c->number);
        return;
    }
    if (a < end) {
        a->words = words;
        a->first = c->number;
    }
    va_start(ap, format);
    vsnprintf(text, sizeof text, format, ap);
    va_end(ap);
    tool_warn(c->t, "%s", text);
}

void
course_warn_at_end(struct course *c)
{
    for (struct again *a = c->again; a < c->again + COURSE_WARNINGS && a->words != NULL; a++) {
        const bool several = a->several || a->from != a->to;

        if (a->from == 0)
            continue;
        add_range(a);
        tool_warn(c->t, "case%s %s too: %s", several ? "s" : "", a->cases, a->words);
    }
}
