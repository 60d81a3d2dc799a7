/*
 * The one command line for a time or an accuracy.
 */
#include "cost.h"

#include <math.h>
#include <string.h>

static bool
better(const struct cost_case *c, const struct cost_trial *a, const struct cost_trial *b)
{
    return b == NULL || (isnan(c->budget) ? a->seconds < b->seconds
                                          : a->error < b->error ||
                                                (a->error == b->error && a->seconds < b->seconds));
}

/* A word as a shell reads it. */
static void
put_word(FILE *out, const char *word)
{
    const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:+@%=";

    const char *before = word[0] == '-' && word[1] != '\0' ? "./" : ""; /* a name, not an option */

    if (word[0] != '\0' && strspn(word, plain) == strlen(word)) {
        fprintf(out, " %s%s", before, word);
        return;
    }
    fprintf(out, " %s'", before);
    for (; *word != '\0'; word++)
        if (*word == '\'')
            fputs("'\\''", out);
        else
            fputc(*word, out);
    fputc('\'', out);
}

static void
put_files(const struct tool *t, FILE *out)
{
    for (size_t k = 0; k < t->operands; k++)
        put_word(out, t->operand[k]);
}

/* On a coarser grid rc-pick makes the means of the cells first; a sphere that rc-solve adds is on any grid
 * what its means are, but for a constant. */
static void
put_command(struct tool *t, const struct cost_trial *m, FILE *out)
{
    const char *physics = strstr(tool_history(t), " --"); /* name and version stand before */
    bool coarse = m->settings.coarse > 1;
    char tol[RC_NUMBER_SIZE];

    if (coarse) {
        fprintf(out, "rc-pick --resample %zux%zu", m->shape.nx, m->shape.ny);
        put_files(t, out);
        fputs(" | ", out);
    }
    fprintf(out, "rc-solve%s", physics);
    if (!m->settings.attracts) /* there is one method, with one kernel */
        fprintf(out, " --method %s --kernel %s", m->settings.method, m->settings.kernel);
    if (m->settings.increments == 0)
        fprintf(out, " --tol %s", rc_number_text(tol, m->settings.tol));
    else /* its contacts have the tolerance that rc-solve takes by itself */
        fprintf(out, " --increments %zu --slabs %zu", m->settings.increments, m->slabs);
    if (t->threads != rc_threads_available())
        fprintf(out, " --threads %zu", t->threads);
    if (!coarse)
        put_files(t, out);
    fputc('\n', out);
}

/* By the triangle inequality the error is at most the distance from the reference plus the error of
 * the reference. On a coarser grid it is the error of the pressures there, which are means over its
 * cells. */
void
cost_command(const struct cost_case *c, FILE *out)
{
    const struct cost_trial *best = NULL, *nearest = NULL;
    char name[128], own[32] = "none"; /* of few increments */

    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *m = &c->trial[k];

        if (m->state != COST_DONE || !m->contact.converged)
            continue;
        if ((isnan(c->budget) ? m->error + c->reference.contact.pressure_error <= c->error
                              : m->seconds <= c->budget) &&
            better(c, m, best))
            best = m;
        if (nearest == NULL ||
            (isnan(c->budget) ? m->error < nearest->error : m->seconds < nearest->seconds))
            nearest = m;
    }
    if (best != NULL) {
        if (!isnan(best->contact.pressure_error))
            snprintf(own, sizeof own, "%.1e", best->contact.pressure_error);
        tool_warn(c->tool,
                  "%s: %.3g s, off by %.2g %% of the pressure (estimate on its own grid %s)",
                  cost_name(name, best), best->seconds, 100 * best->error, own);
        put_command(c->tool, best, out);
    } else if (nearest != NULL) {
        tool_die(c->tool, EXIT_IMPOSSIBLE,
                 "nothing measured %s: the best was %s, %.3g s, error %.1e; raise %s",
                 isnan(c->budget) ? "is so near" : "is so quick", cost_name(name, nearest),
                 nearest->seconds, nearest->error,
                 isnan(c->budget) ? "--error or --limit" : "--budget");
    } else {
        tool_die(c->tool, EXIT_IMPOSSIBLE, "nothing was measured: raise --limit");
    }
}
