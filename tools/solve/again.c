/*
 * Warnings that a list of loads calls for again and again: said in full of the first case, and at
 * the end of all others in one line.
 */
#include "solve.h"

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
solve_warn(struct run *run, const char *words, const char *format, ...)
{
    struct again *a = run->again;
    char text[1024];
    va_list ap;

    while (a < run->again + SOLVE_WARNINGS && a->words != NULL && strcmp(a->words, words) != 0)
        a++;
    if (a < run->again + SOLVE_WARNINGS && a->words != NULL && run->course.number != a->first) {
        add_case(a, run->course.number);
        return;
    }
    if (a < run->again + SOLVE_WARNINGS) {
        a->words = words;
        a->first = run->course.number;
    }
    va_start(ap, format);
    vsnprintf(text, sizeof text, format, ap);
    va_end(ap);
    tool_warn(&run->t, "%s", text);
}

void
solve_warn_at_end(struct run *run)
{
    for (struct again *a = run->again; a < run->again + SOLVE_WARNINGS && a->words != NULL; a++) {
        bool several = a->several || a->from != a->to;

        if (a->from == 0)
            continue;
        add_range(a);
        tool_warn(&run->t, "case%s %s too: %s", several ? "s" : "", a->cases, a->words);
    }
}
