/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the results as a table, as a report, and as the one command for a time or an accuracy. */
#include "cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* clang-format off */
#define FIGURE(member) {RC_FIGURE(struct cost_figures, member)}
#define IN(si, member) {RC_FIGURE(struct cost_figures, member), .unit = si}
#define BOTH (COST_PRESSURE | COST_STRESS)
const struct cost_column cost_columns[] = {
    {FIGURE(increments), .of = COST_YIELD, "increments", "%10.0f", .early = true},
    {FIGURE(slabs), .of = COST_YIELD, "slabs", "%5.0f", "slabs", .early = true},
    {FIGURE(applications), .of = COST_YIELD, "applications", "%12.0f", "applications"},
    {FIGURE(cohesive_nodes), .of = COST_ADHESION, "cohesive_nodes", "%14.3g", "cohesive_nodes"},
    {IN("s", seconds), .of = BOTH, "time[s]", "%9.4f"},
    {FIGURE(runs), .of = BOTH, "runs", "%4.0f", .early = true},
    {FIGURE(coarse_depths), .of = COST_STRESS, "coarse_depths", "%13.0f", "coarse_depths"},
    {FIGURE(convolutions), .of = COST_PRESSURE, "convolutions", "%12.1f", "convolutions"},
    {IN("B", memory), .of = BOTH, "memory[MiB]", "%11.1f", "peak_memory", .scale = 1048576},
    {FIGURE(iterations), .of = COST_PRESSURE, NULL, NULL, "iterations"},
    {{RC_FIGURE_AS("pressure_error_estimate", struct cost_figures, estimate)}, .of = COST_PRESSURE,
     "estimate", "%9.2e", "pressure_error_estimate"},
    {FIGURE(error), .of = BOTH, "error", "%9.2e"},
    {FIGURE(contact_area_error), .of = COST_PRESSURE, "area_error", "%10.2e", "contact_area", true},
    {FIGURE(max_pressure_error), .of = COST_PRESSURE, "peak_error", "%10.2e", "max_pressure", true},
    {FIGURE(approach_error), .of = COST_PRESSURE, "approach_error", "%14.2e", "approach", true},
    {FIGURE(rms_error), .of = COST_STRESS, "rms_error", "%9.2e"},
    {FIGURE(mises_error), .of = COST_STRESS, "mises", "%10.2e"},
    {IN("m3", flow_conductance), .of = COST_LEAK, NULL, NULL, "flow_conductance"},
    {FIGURE(flow_error), .of = COST_LEAK, "flow_error", "%10.2e", "flow_conductance", true},
    {IN("s", flow_seconds), .of = COST_LEAK, "flow_time[s]", "%12.4f", "total"},
    {.of = 0},
};
/* clang-format on */

double *
cost_value(const struct cost_column *column, struct cost_figures *figures)
{
    return (double *)(void *)((char *)figures + column->figure.at);
}

/* Figures that are settings: last in the table, first in the report. */
static bool
is_setting(const struct cost_column *column)
{
    return (column->of & (COST_YIELD | COST_ADHESION)) != 0;
}

/* ---- marks ---- */

/* Errors below the error of the reference count as equal; the error of the exact stresses counts as
 * rounding. */
static double
error_of(const struct cost_case *c, const struct cost_trial *t)
{
    return (t->about & COST_STRESS) ? t->reference ? 0 : t->is.error
                                    : fmax(t->is.error, c->reference.is.estimate);
}

static bool
beaten(const struct cost_case *c, const struct cost_trial *a, const struct cost_trial *by)
{
    double seconds = by->is.seconds - a->is.seconds, error = error_of(c, by) - error_of(c, a);

    return by->state == COST_DONE && ((a->about ^ by->about) & COST_STRESS) == 0 && seconds <= 0 &&
           error <= 0 && (seconds < 0 || error < 0);
}

void
cost_mark(struct cost_case *c)
{
    const struct cost_trial *r = &c->reference;

    for (size_t k = 0; k < c->trials; k++) {
        struct cost_trial *t = &c->trial[k];

        t->front = t->state == COST_DONE;
        for (size_t l = 0; l < c->trials; l++)
            t->front = t->front && !beaten(c, t, &c->trial[l]);
        t->optimistic = t->state == COST_DONE && !(t->about & COST_STRESS) && t->coarse == 1 &&
                        t->stack == r->stack &&
                        t->is.error > 1.01 * t->is.estimate + r->is.estimate;
    }
}

/* ---- the table ---- */

const char *
cost_body(const struct cost_case *c, const char *between, char text[COST_BODY])
{
    const char *layers = strstr(c->solved, "\"layers\": \"on: ");
    long n = layers == NULL ? 0 : strtol(layers + 15, NULL, 10);

    text[0] = '\0';
    if (c->about & COST_YIELD)
        snprintf(text, COST_BODY, "%syields at %s", between,
                 shown_in_unit(cost_number(c->solved, "yield"), "Pa"));
    if (c->about & COST_ADHESION)
        snprintf(text, COST_BODY, "%sattracted by %s", between,
                 shown_in_unit(cost_number(c->solved, "adhesion_work"), "J/m2"));
    if (n > 0)
        snprintf(text, COST_BODY, "%s%ld layer%s", between, n, n == 1 ? "" : "s");
    return text;
}

static void
put_head(const struct cost_case *c, FILE *out)
{
    const struct cost_trial *r = &c->reference;
    const double approach = cost_number(c->solved, "asked_approach"),
                 area = cost_number(c->solved, "contact_area");
    char body[COST_BODY];

    fprintf(out, "# %s: %zu x %zu nodes, %s, ", tool_where(c->tool, c->heights), c->shape.nx,
            c->shape.ny, rc_boundary_word(c->line.boundary));
    if (isnan(approach))
        fprintf(out, "load %.9g N", cost_number(c->solved, "load"));
    else
        fprintf(out, "approach %.9g m", approach);
    fprintf(out, "%s, %zu threads\n", cost_body(c, ", ", body), c->tool->threads);
    fprintf(out,
            "# reference: %s, %s in %s precision, estimated error %.1e (asked %.0e), %.0f steps, "
            "%.3g s: contact area %.9g m2 (%.4g %% of the map, %.3g %% at the hardness), largest "
            "pressure %.9g Pa, approach %.9g m\n",
            r->method, r->kernel, r->arithmetic, r->is.estimate, r->tol, r->is.iterations,
            r->is.seconds, area, 100 * cost_number(c->solved, "contact_fraction"),
            area > 0 ? 100 * cost_number(c->solved, "plastic_area") / area : 0,
            cost_number(c->solved, "max_pressure"), cost_number(c->solved, "approach"));
    if (c->about & COST_YIELD)
        fprintf(out, "# it yields: the reference has %zu increments and %.0f slabs\n",
                r->increments, r->is.slabs);
    if (c->about & COST_ADHESION)
        fprintf(out,
                "# pressures are net, tension negative; the cohesive length is %.3g nodes of the "
                "map, each trial's own is in its column: below 1.5 the grid pins the edge of the "
                "contact\n",
                r->is.cohesive_nodes);
    if (c->line.leak != NULL)
        fprintf(out,
                "# flow along %s: the reference has a conductance of %.9g m3; flow_error: relative "
                "to it, each on its own grid\n",
                c->line.leak, r->is.flow_conductance);
    fprintf(out, "# error: sum |p - reference| / sum reference, on the map's own grid; area, peak, "
                 "approach: relative to the reference; estimate: error that the solver estimates "
                 "for its own grid\n");
}

/* The depths of the stresses, from the report of the exact ones. */
static size_t
depths(const char *stressed, double *first, double *last)
{
    const char *at = strstr(stressed == NULL ? "" : stressed, "\"depths\": [");
    size_t n = 0;
    char *end;

    *first = *last = NAN;
    for (at = at == NULL ? "" : at + 11; *at != '\0' && *at != ']';
         at = *end == ',' ? end + 1 : end) {
        *last = strtod(at, &end);
        if (end == at)
            break;
        if (n++ == 0)
            *first = *last;
    }
    return n;
}

static void
put_stress_head(const struct cost_case *c, FILE *out)
{
    double first, last;
    size_t n = depths(c->stressed, &first, &last);

    fprintf(out,
            "\n# stresses under the reference: six components and Mises at %zu depths, %.3g to "
            "%.3g m, nu %.3g, mu %.3g; error: of a component, over the largest pressure; mises: of "
            "its largest value\n",
            n, first, last, cost_number(c->stressed, "nu"), cost_number(c->stressed, "mu"));
}

static const char *
note(const struct cost_trial *m)
{
    static char text[64];

    snprintf(text, sizeof text, "%s%s%s%s",
             (m->about & COST_STRESS) && m->reference ? ",reference" : "", m->front ? ",front" : "",
             m->converged || (m->about & COST_STRESS) ? "" : ",short",
             m->optimistic ? ",optimistic" : "");
    return text[0] == '\0' ? "-" : text + 1;
}

/* Prints the cells of a trial; NULL: the headings. */
static void
put_cells(unsigned about, const struct cost_trial *m, bool settings, FILE *out)
{
    for (const struct cost_column *col = cost_columns; col->figure.name != NULL; col++) {
        /* leakage is the last column */
        if (col->head == NULL || !(col->of & about) ||
            (is_setting(col) || col->of == COST_LEAK) != settings)
            continue;
        if (m == NULL)
            fprintf(out, "%*s ", (int)strtol(col->format + 1, NULL, 10), col->head);
        else
            fprintf(out, col->format,
                    rc_figure_number(&col->figure, &m->is) / (col->scale > 0 ? col->scale : 1));
        if (m != NULL)
            putc(' ', out);
    }
}

static void
put_rows(const struct cost_case *c, size_t from, size_t to, FILE *out)
{
    unsigned about = from < to ? c->trial[from].about : 0;
    const bool stress = (about & COST_STRESS) != 0;
    char name[128], grid[64];

    if (from == to)
        return;
    if (stress)
        fprintf(out, "%-6s %6s ", "kernel", "tol");
    else
        fprintf(out, "%-6s %-6s %-10s %6s %11s ", "method", "kernel", "arithmetic", "tol", "grid");
    put_cells(about, NULL, false, out);
    put_cells(about, NULL, true, out);
    fputs("note\n", out);
    for (size_t k = from; k < to; k++) {
        const struct cost_trial *m = &c->trial[k];

        if (m->state != COST_DONE)
            continue;
        snprintf(grid, sizeof grid, "%zux%zu", m->shape.nx, m->shape.ny);
        if (stress)
            fprintf(out, "%-6s %6.0e ", m->kernel, m->tol);
        else
            fprintf(out, "%-6s %-6s %-10s %6.0e %11s ", m->method, m->kernel, m->arithmetic, m->tol,
                    grid);
        put_cells(about, m, false, out);
        put_cells(about, m, true, out);
        fprintf(out, "%s\n", note(m));
    }
    for (size_t k = from; k < to; k++)
        if (c->trial[k].state != COST_DONE)
            fprintf(out, "# %s: %s\n", cost_name(name, &c->trial[k]), c->trial[k].why);
}

void
cost_table(const struct cost_case *c, FILE *out)
{
    put_head(c, out);
    put_rows(c, 0, c->pressures, out);
    if (c->trials > c->pressures)
        put_stress_head(c, out);
    put_rows(c, c->pressures, c->trials, out);
}

/* ---- the report ---- */

static void
report_figures(const struct cost_case *c, const struct cost_trial *m, bool settings,
               struct report *out)
{
    for (const struct cost_column *col = cost_columns; col->figure.name != NULL; col++) {
        const struct rc_figure *f = &col->figure;
        const bool known = m->state == COST_DONE || col->early;

        if (is_setting(col) != settings || !(col->of & c->about))
            continue;
        if (col->of & m->about)
            report_number(out, f->name, rc_figure_number(f, known ? &m->is : NULL), f->unit);
        else
            report_column(out, f->name, f->unit);
    }
}

static void
report_trial(const struct cost_case *c, const struct cost_trial *m, struct report *out)
{
    static const char *const states[] = {[COST_OPEN] = "left out",
                                         [COST_DONE] = "done",
                                         [COST_LEFT_OUT] = "left out",
                                         [COST_STOPPED] = "stopped"};
    const bool stress = (m->about & COST_STRESS) != 0;
    double first, last;

    report_begin(out);
    report_count(out, "case", rc_grid_case(c->heights), NULL);
    report_text(out, "source", rc_grid_get(c->heights, "source"));
    report_text(out, "what",
                stress         ? m->reference ? "stress reference" : "stress"
                : m->reference ? "reference"
                               : "pressure");
    if (!stress)
        report_text(out, "method", m->method);
    report_text(out, "kernel", m->kernel);
    if (!stress)
        report_text(out, "arithmetic", m->arithmetic);
    report_number(out, "tol", m->tol, NULL);
    if (stress)
        report_count(out, "depths", depths(c->stressed, &first, &last), NULL);
    else
        report_count(out, "coarse", m->coarse, NULL);
    report_figures(c, m, true, out);
    if (!stress) {
        report_count(out, "nx", m->shape.nx, NULL);
        report_count(out, "ny", m->shape.ny, NULL);
        report_count(out, "threads", c->tool->threads, NULL);
    }
    report_text(out, "state", states[m->state]);
    report_text(out, "why", m->why[0] == '\0' ? NULL : m->why);
    report_number(out, "expected_seconds", m->expected, "s");
    report_figures(c, m, false, out);
    if (!stress)
        report_bool(out, "converged", m->converged);
    report_bool(out, "front", m->front);
    if (!stress)
        report_bool(out, "optimistic", m->optimistic);
    if (!stress && (c->about & COST_STRESS))
        report_column(out, "depths", NULL);
    report_finish_row(out);
}

void
cost_report(const struct cost_case *c, struct report *out)
{
    report_trial(c, &c->reference, out);
    for (size_t k = 0; k < c->trials; k++)
        report_trial(c, &c->trial[k], out);
}

/* ---- the command ---- */

static void
put_word(FILE *out, const char *word)
{
    fputc(' ', out);
    shown_shell_word(out, word);
}

static void
put_files(const struct tool *t, FILE *out)
{
    char name[4096];

    for (size_t k = 0; k < t->operands; k++) {
        const char *word = t->operand[k];
        snprintf(name, sizeof name, "./%s", word);
        put_word(out, word[0] == '-' && word[1] != '\0' ? name : word); /* a name, not an option */
    }
}

/* On a coarser grid rc-pick averages the cells first. A sphere that rc-solve adds equals its cell means on
 * any grid, up to a constant. */
static void
put_command(const struct cost_line *line, const struct tool *t, const struct cost_trial *m,
            FILE *out)
{
    const char *word[COST_WORDS];
    size_t n;

    if (m->coarse > 1) {
        fprintf(out, "rc-pick --resample %zux%zu", m->shape.nx, m->shape.ny);
        put_files(t, out);
        fputs(" | ", out);
    }
    fputs("rc-solve", out);
    for (size_t k = 0; k < line->words; k++)
        put_word(out, line->word[k]);
    n = cost_trial_words(m, word, 0);
    for (size_t k = 0; k < n; k++)
        put_word(out, word[k]);
    if (t->threads != rc_threads_available())
        fprintf(out, " --threads %zu", t->threads);
    if (m->coarse == 1)
        put_files(t, out);
    fputc('\n', out);
}

static bool
better(double budget, const struct cost_trial *a, const struct cost_trial *b)
{
    double seconds, error;

    if (b == NULL)
        return true;
    seconds = a->is.seconds - b->is.seconds;
    error = a->is.error - b->is.error;
    return isnan(budget) ? seconds < 0 : error < 0 || (error == 0 && seconds < 0);
}

void
cost_command(const struct cost_case *c, FILE *out)
{
    const struct cost_trial *best = NULL, *nearest = NULL;
    const bool timed = !isnan(c->budget);
    char name[128], own[32] = "none"; /* from few increments */

    for (size_t k = 0; k < c->pressures; k++) {
        const struct cost_trial *m = &c->trial[k];

        if (m->state != COST_DONE || !m->converged)
            continue;
        if ((timed ? m->is.seconds <= c->budget : cost_is_near(c, m)) && better(c->budget, m, best))
            best = m;
        if (nearest == NULL ||
            (timed ? m->is.seconds < nearest->is.seconds : m->is.error < nearest->is.error))
            nearest = m;
    }
    if (best != NULL) {
        if (!isnan(best->is.estimate))
            snprintf(own, sizeof own, "%.1e", best->is.estimate);
        tool_warn(c->tool,
                  "%s: %.3g s, off by %.2g %% of the pressure (estimate on its own grid %s)",
                  cost_name(name, best), best->is.seconds, 100 * best->is.error, own);
        put_command(&c->line, c->tool, best, out);
    } else if (nearest != NULL) {
        tool_die(c->tool, "no trial was %s: the best was %s, %.3g s, error %.1e; raise %s",
                 timed ? "fast enough" : "accurate enough", cost_name(name, nearest),
                 nearest->is.seconds, nearest->is.error, timed ? "--budget" : "--error or --limit");
    } else {
        tool_die(c->tool, "no trial was run: raise --limit");
    }
}
