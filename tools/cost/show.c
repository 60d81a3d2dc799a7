/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the results as a table, as a report, and as the one command for a time or an accuracy. */
#define _GNU_SOURCE /* open_memstream, in POSIX since 2008 */
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- commands ---- */

static void
put_files(const struct tool *t, FILE *out)
{
    char name[4096];

    for (size_t k = 0; k < t->operands; k++) {
        const char *word = t->operand[k];
        snprintf(name, sizeof name, "./%s", word);
        putc(' ', out);
        shown_shell_word(out, word[0] == '-' && word[1] != '\0' ? name : word); /* not an option */
    }
}

/* The pipe of a trial. For a coarser grid rc-pick averages the cells first. */
static void
put_command(const struct cost_case *c, const struct cost_trial *t, FILE *out)
{
    const struct tool *tool = c->tool;
    const bool own = t->coarse == 1 && c->command.program[0].reads;

    if (t->coarse > 1) {
        const struct rc_shape shape = cost_shape(c, t);

        fprintf(out, "rc-pick --resample %zux%zu", shape.nx, shape.ny);
        put_files(tool, out);
        fputs(" | ", out);
    } else if (!own && tool->operands > 0) {
        fputs("cat", out);
        put_files(tool, out);
        fputs(" | ", out);
    }
    for (size_t k = 0; k < t->runs; k++) {
        const char *const *word = c->run[t->run[k]].word;

        fputs(k > 0 ? " | " : "", out);
        for (size_t i = 0; word[i] != NULL; i++) {
            if (strcmp(word[i], "--threads") == 0 || strcmp(word[i], "--memory") == 0) {
                i++;
                continue;
            }
            fputs(i > 0 ? " " : "", out);
            shown_shell_word(out, word[i]);
        }
        if (tool->threads != rc_threads_available() && !tool->part)
            fprintf(out, " --threads %zu", tool->threads);
        if (k == 0 && own)
            put_files(tool, out);
    }
}

/* ---- the table ---- */

static double
figure_of_reference(const struct cost_case *c, size_t k)
{
    const struct cost_trial *r = &c->trial[c->reference];
    const char *at = c->run[r->run[c->figure[k].program]].report, *line;
    double value = NAN;

    while ((line = cost_line(&at)) != NULL)
        value = json_real(json_member(line, c->figure[k].name));
    return value;
}

/* The figures of the table: --of, and those of the last program first, if they differ. */
static size_t
shown_figures(const struct cost_case *c, size_t shown[COST_SHOWN])
{
    size_t n = 0;

    if (c->ranked.known && !c->ranked.frame)
        shown[n++] = c->ranked.k;
    for (int less = 0; less < 2 && n == 0; less++) /* those that do not differ, if none does */
        for (size_t k = 0; k < c->figures && n < COST_SHOWN; k++)
            if ((c->figure[k].differs || (less > 0 && !isnan(figure_of_reference(c, k)))) &&
                (n == 0 || shown[0] != k))
                shown[n++] = k;
    return n;
}

static void
put_head(const struct cost_case *c, const size_t figure[], size_t figures, FILE *out)
{
    const struct cost_trial *r = &c->trial[c->reference];
    const struct cost_object *of = &c->ranked;
    char name[160];

    fprintf(out, "# rc-cost: %s: %zu x %zu nodes, ", tool_where(c->tool, c->first), c->shape.nx,
            c->shape.ny);
    if (c->cases > 1)
        fprintf(out, "%zu cases, ", c->cases);
    fprintf(out, "%zu thread%s\n# reference: ", c->tool->threads, c->tool->threads == 1 ? "" : "s");
    put_command(c, r, out);
    fprintf(out, "\n# reference: %s, %.3g s", cost_name(c, r, false, name), r->seconds);
    if (isnan(c->reference_error))
        fputs(", its error is unknown", out);
    else
        fprintf(out, ", its error is at most about %.1e", c->reference_error);
    for (size_t k = 0; k < figures; k++) {
        const struct cost_figure *f = &c->figure[figure[k]];

        fprintf(out, "%s %s %.9g%s%s", k == 0 ? ":" : ",", f->shown,
                figure_of_reference(c, figure[k]), f->unit[0] == '\0' ? "" : " ", f->unit);
    }
    fprintf(out, "%s\n# error: of %s, ", r->converged ? "" : "; it stopped short",
            cost_object_name(c, *of));
    if (!of->known)
        fputs("because no result differs", out);
    else if (!of->frame)
        fputs("relative to the reference", out);
    else if (c->channel[of->k].whole)
        fputs("the share of the nodes that differ", out);
    else
        fputs("sum |a - reference| / sum |reference|, on the map's own grid", out);
    fputs("; bound: with the error of the reference\n# estimate: ", out);
    if (isnan(r->estimate))
        fputs("the command gives none", out);
    else
        fprintf(out, "error of %s that the command gives for its own grid",
                cost_object_name(c, c->judged));
    fprintf(out, "%s\n", figures > 0 ? "; figures: relative to the reference" : "");
}

static const char *
note(const struct cost_trial *t, char text[80])
{
    snprintf(text, 80, "%s%s%s%s%s", t->reference ? ",reference" : "", t->front ? ",front" : "",
             t->converged ? "" : ",short", t->optimistic ? ",optimistic" : "",
             t->unjudged ? ",unjudged" : "");
    return text[0] == '\0' ? "-" : text + 1;
}

/* Prints a cell of this width; NAN: "-". */
static void
put_cell(FILE *out, int width, const char *format, double value)
{
    char text[64];

    snprintf(text, sizeof text, format, value);
    fprintf(out, "%*s ", width, isnan(value) ? "-" : text);
}

static int
wide(const char *name, int least)
{
    return (int)strlen(name) > least ? (int)strlen(name) : least;
}

static int
list_width(const struct cost_list *l)
{
    char text[COST_NAME];
    int width = wide(l->name, 5);

    for (size_t k = 0; k < l->n; k++)
        width = wide(cost_value(l, k, text), width);
    return width;
}

static void
put_row(const struct cost_case *c, const struct cost_trial *t, const size_t figure[],
        size_t figures, FILE *out)
{
    char text[80];

    for (size_t l = 0; l < c->lists; l++)
        fprintf(out, "%*s ", list_width(&c->list[l]), cost_value(&c->list[l], t->pick[l], text));
    put_cell(out, 9, "%.4f", t->seconds);
    put_cell(out, 7, "%.4f", t->processor);
    put_cell(out, 4, "%.0f", (double)c->run[t->run[t->runs - 1]].runs);
    put_cell(out, 12, "%.1f", t->convolutions);
    put_cell(out, 11, "%.1f", t->memory / 1048576);
    put_cell(out, 9, "%.2e", t->estimate);
    put_cell(out, 9, "%.2e", t->error);
    put_cell(out, 9, "%.2e", t->bound);
    for (size_t k = 0; k < figures; k++)
        put_cell(out, wide(c->figure[figure[k]].shown, 9), "%.2e", t->figure[figure[k]]);
    fprintf(out, "%s\n", note(t, text));
}

void
cost_show_table(const struct cost_case *c, FILE *out)
{
    static const char *const heads[] = {"   time[s]",   " cpu[s] ",   "runs",      " convolutions",
                                        " memory[MiB]", " estimate ", "   error ", "   bound"};
    size_t figure[COST_SHOWN], figures = shown_figures(c, figure);
    char name[160];

    put_head(c, figure, figures, out);
    for (size_t l = 0; l < c->lists; l++)
        fprintf(out, "%s%*s", l > 0 ? " " : "", list_width(&c->list[l]), c->list[l].name);
    for (size_t k = 0; k < sizeof heads / sizeof *heads; k++)
        fputs(heads[k], out);
    for (size_t k = 0; k < figures; k++)
        fprintf(out, " %*s", wide(c->figure[figure[k]].shown, 9), c->figure[figure[k]].shown);
    fputs(" note\n", out);
    for (size_t k = 0; k < c->trials; k++)
        if (c->trial[k].state == COST_DONE)
            put_row(c, &c->trial[k], figure, figures, out);
    for (size_t k = 0; k < c->trials; k++)
        if (c->trial[k].state != COST_DONE)
            fprintf(out, "# %s: %s\n", cost_name(c, &c->trial[k], false, name),
                    c->trial[k].why[0] == '\0' ? "left out: interrupted" : c->trial[k].why);
}

/* One warning for each object whose estimate is below its error. */
void
cost_warn(const struct cost_case *c)
{
    for (size_t e = 0; e < c->estimates; e++) {
        const struct cost_object o = cost_object_of(c, &c->estimate[e]);
        const struct cost_trial *worst = NULL;
        size_t n = 0;
        char name[160];

        for (size_t k = 0; k < e && o.known; k++) {
            const struct cost_object before = cost_object_of(c, &c->estimate[k]);

            if (before.frame == o.frame && before.k == o.k)
                n = c->trials; /* said already */
        }
        for (size_t k = 0; k < c->trials && n < c->trials; k++) {
            const struct cost_trial *t = &c->trial[k];

            if (t->reference || !cost_is_optimistic(c, t, o))
                continue;
            n++;
            if (worst == NULL || fabs(cost_error_of(c, t, o)) > fabs(cost_error_of(c, worst, o)))
                worst = t;
        }
        if (worst != NULL)
            tool_warn(c->tool, "%s: the estimate for %s, %.1e, is below the true error %.1e%s",
                      cost_name(c, worst, false, name), cost_object_name(c, o),
                      cost_estimate_of(c, worst, o, false), fabs(cost_error_of(c, worst, o)),
                      n > 1 ? "; so are others" : "");
    }
}

/* ---- the report ---- */

static void
report_trial(const struct cost_case *c, const struct cost_trial *t, struct report *out)
{
    static const char *const states[] = {[COST_OPEN] = "left out",
                                         [COST_DONE] = "done",
                                         [COST_LEFT_OUT] = "left out",
                                         [COST_STOPPED] = "stopped"};
    const bool done = t->state == COST_DONE;
    const struct rc_shape shape = cost_shape(c, t);
    char *command = NULL;
    size_t size, columns = 0;
    FILE *text;

    report_begin(out);
    report_text(out, "source", rc_grid_get(c->first, "source"));
    report_text(out, "what", t->reference ? "reference" : "trial");
    for (size_t l = 0; l < c->lists; l++) {
        const struct cost_list *list = &c->list[l];

        if (list->numbers)
            report_number(out, list->name, list->number[t->pick[l]], NULL);
        else
            report_text(out, list->name, list->value[t->pick[l]]);
    }
    report_count(out, "nx", shape.nx, NULL);
    report_count(out, "ny", shape.ny, NULL);
    report_count(out, "cases", c->cases, NULL);
    report_count(out, "threads", c->tool->threads, NULL);
    report_text(out, "state", states[t->state]);
    report_text(out, "why", t->why[0] == '\0' ? NULL : t->why);
    report_number(out, "expected_seconds", t->expected, "s");
    report_number(out, "seconds", t->seconds, "s");
    report_number(out, "processor_seconds", t->processor, "s");
    report_count(out, "runs", done ? c->run[t->run[t->runs - 1]].runs : 0, NULL);
    report_number(out, "convolutions", t->convolutions, NULL);
    report_number(out, "memory", t->memory, "B");
    report_text(out, "of", cost_object_name(c, c->ranked));
    report_number(out, "error", t->error, NULL);
    report_number(out, "bound", t->bound, NULL);
    report_text(out, "estimate_of", cost_object_name(c, c->judged));
    report_number(out, "estimate", t->estimate, NULL);
    report_number(out, "estimate_of_error", fabs(cost_error_of(c, t, c->judged)), NULL);
    report_bool(out, "converged", done && t->converged);
    report_bool(out, "front", t->front);
    report_bool(out, "optimistic", t->optimistic);
    report_bool(out, "unjudged", t->unjudged);
    if (t->runs > 0 && (text = open_memstream(&command, &size)) != NULL) {
        put_command(c, t, text);
        fclose(text);
    }
    report_text(out, "command", command);
    free(command);
    for (size_t k = 0; k < c->figures && columns < 64; k++) {
        bool twice = !c->figure[k].differs;

        for (size_t i = 0; i < k; i++)
            twice = twice ||
                    (c->figure[i].differs && strcmp(c->figure[i].column, c->figure[k].column) == 0);
        columns += !twice;
        if (!twice)
            report_number(out, c->figure[k].column, t->figure[k], NULL);
    }
    report_finish_row(out);
}

void
cost_report(const struct cost_case *c, struct report *out)
{
    report_trial(c, &c->trial[c->reference], out);
    for (size_t k = 0; k < c->trials; k++)
        if (k != c->reference)
            report_trial(c, &c->trial[k], out);
}

/* ---- the proposal ---- */

/* The reference, which the lists do not have, only if nothing else will do. */
static bool
better(double budget, const struct cost_trial *a, const struct cost_trial *b)
{
    double seconds, error;

    if (b == NULL || a->reference != b->reference)
        return b == NULL || b->reference;
    seconds = a->seconds - b->seconds;
    error = a->error - b->error;
    return isnan(budget) ? seconds < 0 : error < 0 || (error == 0 && seconds < 0);
}

/* The ranked object has the error of --error; names other figures that do not, the worst ones first. */
static void
warn_of_others(const struct cost_case *c, const struct cost_trial *t)
{
    char text[COST_SHOWN * (COST_NAME + 40)];
    size_t at = 0, others = 0;
    double below = INFINITY;

    for (size_t n = 0; n <= COST_SHOWN; n++) {
        size_t worst = SIZE_MAX, as_bad = 0;

        for (size_t k = 0; k < c->figures; k++) {
            const double error = fabs(t->figure[k]);

            if (!(error > c->error) || !(error < below) ||
                (c->ranked.known && !c->ranked.frame && c->ranked.k == k))
                continue;
            as_bad++;
            if (worst == SIZE_MAX || error > fabs(t->figure[worst]))
                worst = k;
        }
        others = as_bad;
        if (worst == SIZE_MAX || n == COST_SHOWN)
            break;
        below = fabs(t->figure[worst]);
        at += (size_t)snprintf(text + at, sizeof text - at, "%s%s %.2g %%", n > 0 ? ", " : "",
                               c->figure[worst].shown, 100 * below);
    }
    if (at > 0)
        tool_warn(c->tool,
                  "other figures are off by more than %.2g %%: %s%s; --of NAME chooses one",
                  100 * c->error, text, others > 0 ? " and others" : "");
}

void
cost_show_command(const struct cost_case *c, FILE *out)
{
    const struct cost_trial *best = NULL, *nearest = NULL;
    const bool timed = !isnan(c->budget);
    char name[160], own[64] = "without an estimate of its own";

    for (size_t k = 0; k < c->trials; k++) {
        const struct cost_trial *t = &c->trial[k];

        if (t->state != COST_DONE || !t->converged || isnan(t->error))
            continue;
        if ((timed ? t->seconds <= c->budget : cost_is_near(c, t)) && better(c->budget, t, best))
            best = t;
        if (nearest == NULL || (timed ? t->seconds < nearest->seconds : t->bound < nearest->bound))
            nearest = t;
    }
    if (best == NULL && nearest == NULL)
        tool_die(c->tool, "no trial was run to its tolerance: raise --limit");
    if (best == NULL)
        tool_die(c->tool,
                 "no trial was %s: the best was %s, %.3g s, error at most %.1e%s; raise %s",
                 timed ? "fast enough" : "accurate enough", cost_name(c, nearest, false, name),
                 nearest->seconds, nearest->bound,
                 nearest->optimistic ? ", its own estimate is too small" : "",
                 timed ? "--budget" : "--error or --limit");
    if (!isnan(best->estimate))
        snprintf(own, sizeof own, "its own estimate is %.1e", best->estimate);
    tool_warn(c->tool, "%s: %.3g s, %s off by at most %.2g %% (%s)",
              cost_name(c, best, false, name), best->seconds, cost_object_name(c, c->ranked),
              100 * best->bound, own);
    if (!timed)
        warn_of_others(c, best);
    put_command(c, best, out);
    putc('\n', out);
}
