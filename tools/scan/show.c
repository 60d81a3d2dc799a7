/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the bars as a table and as a report. */
#include "scan.h"

#include <math.h>
#include <string.h>

static const char *const source_name[SCAN_SOURCES] = {"noise", "grid", "patch", "holes", "filter"};

static bool
is_studied(const struct scan *s, enum scan_source source)
{
    for (size_t k = 0; k < s->variants; k++)
        if (s->variant[k].source == source)
            return true;
    return false;
}

/* ---- the head ---- */

static void
put_command(const struct scan *s, FILE *out)
{
    const struct cost_command *command = &s->c->command;

    for (size_t k = 0; k < command->programs; k++) {
        fprintf(out, "%s%s", k > 0 ? " | " : "", command->program[k].name);
        for (size_t i = 0; i < command->program[k].words; i++) {
            putc(' ', out);
            shown_shell_word(out, command->program[k].word[i]);
        }
    }
}

static void
put_grid(const struct scan *s, FILE *out)
{
    if (s->slope[0] == 0)
        fputs("# grid: the noise is as steep as the map: whether its waves end cannot be judged\n",
              out);
    else if (isnan(s->ratio) && s->slope[0] < s->slope[1])
        fputs("# grid: without the noise the map is less steep than its means over 2 x 2 nodes: "
              "SIGMA may be too large\n",
              out);
    else if (isnan(s->ratio))
        fputs("# grid: the slope does not change: the waves end on this map\n", out);
    else {
        fprintf(out, "# grid: %s",
                s->unlimited
                    ? "the map has waves as short as its nodes: a finer scan would show more"
                    : "the waves end on this map");
        if (s->slope[1] > 0 && s->slope[2] > 0)
            fprintf(
                out,
                " (its rms slope grows by %s from a quarter to half of the nodes a side, and by %s "
                "from half to all)",
                shown_percent(s->slope[1] / s->slope[2] - 1, 2),
                shown_percent(s->slope[0] / s->slope[1] - 1, 2));
        putc('\n', out);
    }
}

static void
put_head(const struct scan *s, FILE *out)
{
    const struct cost_case *c = s->c;
    char name[SHOWN_NUMBER];

    fprintf(out, "# rc-cost: %s: %zu x %zu nodes, %zu thread%s\n# command: ",
            tool_where(c->tool, c->first), c->shape.nx, c->shape.ny, c->tool->threads,
            c->tool->threads == 1 ? "" : "s");
    put_command(s, out);
    putc('\n', out);
    if (s->sigma > 0) {
        fprintf(out, "# noise: %s", shown_in_unit_to(name, s->sigma, "m"));
        if (s->length > 0)
            fprintf(out, ", correlated over %s", shown_in_unit_to(name, s->length, "m"));
        fprintf(out, "; its slope is %.3g\n", s->noise_slope[0]);
    }
    if (is_studied(s, SCAN_GRID))
        put_grid(s, out);
    if (is_studied(s, SCAN_PATCH))
        fprintf(out, "# patch: quarters, levelled%s\n",
                rc_repeats(s->reflects) > 0 ? " and reflected" : "");
    if (is_studied(s, SCAN_FILTER))
        fprintf(out, "# filter: the largest change, %s the bar\n",
                s->options->filter_bar ? "part of" : "not part of");
    fputs("# +-90%: half width that holds the value of the true surface in 90 % of the cases, "
          "relative\n",
          out);
}

/* ---- the table ---- */

/* Cells are relative to the value. */
static void
put_share(FILE *out, int width, double part, double value)
{
    char text[32] = "-";

    const double percent = 100 * part / fabs(value);

    if (!isnan(percent) && isfinite(percent))
        snprintf(text, sizeof text,
                 percent < 1      ? "%.2g%%"
                 : percent < 1000 ? "%.1f%%"
                                  : "%.0e%%",
                 percent);
    fprintf(out, " %*s", width, text);
}

static bool
is_given(const struct scan_bar *b)
{
    return b->bar == 0 && b->note[0] == '\0';
}

static void
put_rows(const struct scan *s, int width, bool cases, FILE *out)
{
    for (size_t k = 0; k < s->bars; k++) {
        const struct scan_bar *b = &s->bar[k];

        if (is_given(b))
            continue;
        fprintf(out, "%-*s", width, b->name);
        if (cases)
            fprintf(out, " %4zu", b->line + 1);
        fprintf(out, " %11.4g %-7s", b->value, b->figure->unit[0] == '\0' ? "-" : b->figure->unit);
        put_share(out, 7, b->bar, b->value);
        for (size_t i = 0; i < SCAN_SOURCES; i++)
            if (is_studied(s, i))
                put_share(out, 7, b->part[i], b->value);
        fprintf(out, " %-8s %s\n", b->dominant == SCAN_SOURCES ? "-" : source_name[b->dominant],
                b->note);
    }
}

/* The names of the figures that do not depend on the map. */
static void
put_given(const struct scan *s, FILE *out)
{
    size_t n = 0;

    for (size_t k = 0; k < s->bars; k++)
        if (is_given(&s->bar[k]) && s->bar[k].line == 0)
            fprintf(out, "%s %s", n++ == 0 ? "# no change:" : ",", s->bar[k].name);
    if (n > 0)
        putc('\n', out);
}

/* Names the programs whose reports have values by component or depth only. */
static void
put_figureless(const struct cost_case *c, FILE *out)
{
    for (size_t p = 0; p < c->command.programs; p++) {
        bool has = !c->command.program[p].reports;

        for (size_t k = 0; k < c->figures; k++)
            has = has || c->figure[k].program == p;
        if (!has)
            fprintf(out,
                    "# %s: no bars: its report has values by component or depth, no single "
                    "figures\n",
                    c->command.program[p].name);
    }
}

void
scan_show_table(const struct scan *s, FILE *out)
{
    int width = 6;
    bool cases = false;
    char name[160];

    for (size_t k = 0; k < s->bars; k++) {
        const int own = (int)strlen(s->bar[k].name);

        width = own > width && !is_given(&s->bar[k]) ? own : width;
        cases = cases || s->bar[k].line > 0;
    }
    put_head(s, out);
    fprintf(out, "%-*s%s       value unit      +-90%%", width, "figure", cases ? " case" : "");
    for (size_t k = 0; k < SCAN_SOURCES; k++)
        if (is_studied(s, k))
            fprintf(out, " %7s", source_name[k]);
    fputs(" dominant note\n", out);
    put_rows(s, width, cases, out);
    put_given(s, out);
    put_figureless(s->c, out);
    for (size_t k = 0; k < s->variants; k++) {
        const struct cost_trial *t = &s->c->trial[s->variant[k].trial];

        if (t->state != COST_DONE)
            fprintf(out, "# %s: %s\n", cost_name(s->c, t, false, name),
                    t->why[0] == '\0' ? "left out: interrupted" : t->why);
    }
    if (!is_studied(s, SCAN_GRID))
        fputs("# the error of the grid is not in these bars: add --resolution\n", out);
}

void
scan_show_plan(const struct scan *s, FILE *out)
{
    const struct cost_case *c = s->c;
    const struct cost_trial *t = &c->trial[c->reference];

    fprintf(out, "%zu runs on %zu x %zu nodes", s->variants + 1, c->shape.nx, c->shape.ny);
    if (!isnan(t->expected))
        fprintf(out, ", about %.2g s each for %s", t->expected, c->command.program[0].name);
    putc('\n', out);
    for (size_t k = 0; k < c->trials; k++)
        fprintf(out, "  %-40s %s\n", c->trial[k].name,
                c->trial[k].state == COST_OPEN ? "" : c->trial[k].why);
}

/* ---- the report ---- */

static double
relative(double part, double value)
{
    return value == 0 ? NAN : part / fabs(value);
}

/* A row of a figure, b, or of a run, v; the other one is NULL. */
static void
report_row(const struct scan *s, const struct scan_bar *b, const struct scan_variant *v,
           struct report *out)
{
    static const char *const states[] = {[COST_OPEN] = "left out",
                                         [COST_DONE] = "done",
                                         [COST_LEFT_OUT] = "left out",
                                         [COST_STOPPED] = "stopped"};
    static const char *const relative_name[SCAN_SOURCES] = {
        "noise_relative", "grid_relative", "patch_relative", "holes_relative", "filter_relative"};
    const struct cost_case *c = s->c;
    const struct cost_trial *t = v == NULL ? NULL : &c->trial[v->trial];
    const char *note = b == NULL || b->note[0] == '\0' ? NULL : b->note;

    report_begin(out);
    report_text(out, "source", rc_grid_get(c->first, "source"));
    report_text(out, "what", b != NULL ? "figure" : "run");
    report_text(out, "name", b != NULL ? b->figure->name : v->name);
    report_text(out, "program", b != NULL ? c->command.program[b->figure->program].name : NULL);
    report_number(out, "case", b != NULL ? (double)b->line + 1 : NAN, NULL);
    report_text(out, "unit", b != NULL && b->figure->unit[0] != '\0' ? b->figure->unit : NULL);
    report_number(out, "value", b != NULL ? b->value : NAN, NULL);
    report_number(out, "bar", b != NULL ? b->bar : NAN, NULL);
    report_number(out, "bar_relative", b != NULL ? relative(b->bar, b->value) : NAN, NULL);
    for (size_t k = 0; k < SCAN_SOURCES; k++)
        report_number(out, source_name[k], b != NULL ? b->part[k] : NAN, NULL);
    for (size_t k = 0; k < SCAN_SOURCES; k++)
        report_number(out, relative_name[k], b != NULL ? relative(b->part[k], b->value) : NAN,
                      NULL);
    report_text(out, "dominant",
                b != NULL && b->dominant != SCAN_SOURCES ? source_name[b->dominant] : NULL);
    report_bool(out, "limit", b == NULL || !b->unlimited);
    report_text(out, "why", b != NULL ? note : t->why[0] == '\0' ? NULL : t->why);
    report_number(out, "noise_bias", b != NULL ? b->bias : NAN, NULL);
    report_number(out, "noise_scatter", b != NULL ? b->scatter : NAN, NULL);
    report_number(out, "half_grid", b != NULL ? b->coarse[0] : NAN, NULL);
    report_number(out, "quarter_grid", b != NULL ? b->coarse[1] : NAN, NULL);
    report_text(out, "state", t == NULL ? NULL : states[t->state]);
    report_number(out, "seconds", t == NULL ? NAN : t->seconds, "s");
    report_number(out, "noise_height", s->sigma > 0 ? s->sigma : NAN, "m");
    report_number(out, "noise_length", s->sigma > 0 ? s->length : NAN, "m");
    report_number(out, "slope_ratio", is_studied(s, SCAN_GRID) ? s->ratio : NAN, NULL);
    report_bool(out, "waves_end", !s->unlimited);
    report_finish_row(out);
}

void
scan_report(const struct scan *s, struct report *out)
{
    for (size_t k = 0; k < s->bars; k++)
        report_row(s, &s->bar[k], NULL, out);
    for (size_t k = 0; k < s->variants; k++)
        report_row(s, NULL, &s->variant[k], out);
}
