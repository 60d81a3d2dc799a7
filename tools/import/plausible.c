/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Warns of sizes that surfaces hardly ever have: most often the file has a wrong unit. */
#include "import.h"

#include <math.h>
#include <string.h>

static const double longest = 1, shortest = 10e-9, /* m, of a side */
    coarse =
        1e-3; /* m: a spacing above it, with heights that span more, are those of a file in mm */

/* Range of the heights. */
static double
span_of(const struct rc_grid *g)
{
    double least = INFINITY, most = -INFINITY;

    for (size_t k = 0; k < g->nx * g->ny; k++) {
        least = fmin(least, g->v[k]);
        most = fmax(most, g->v[k]);
    }
    return most - least;
}

/* RMS slope in x, from neighbours. */
static double
slope_of(const struct rc_grid *g)
{
    double sum = 0;
    size_t n = 0;

    for (size_t k = 1; k < g->nx * g->ny; k++) {
        double d = (g->v[k] - g->v[k - 1]) / g->dx;

        if (k % g->nx == 0 || !isfinite(d))
            continue;
        sum += d * d;
        n++;
    }
    return n == 0 ? 0 : sqrt(sum / (double)n);
}

/* Lengths and heights that are a thousand times too large have plausible slopes. */
static void
judge_millimetres(struct tool *t, const struct rc_grid *g, double unit, double span)
{
    char spacing[SHOWN_NUMBER], advice[96] = "--dx and --z-unit give the right ones";

    if (!(fmin(g->dx, g->dy) > coarse && span > coarse))
        return;
    snprintf(spacing, sizeof spacing, "%.6g", 1e3 * g->dx);
    if (unit == 1 && g->dx == g->dy)
        snprintf(advice, sizeof advice, "give --dx %sum --z-unit mm", spacing);
    tool_warn(t,
              "%s: the spacing is %s mm and the heights span %.4g mm, which is much for a surface: "
              "if the file has millimetres where it promises metres, %s",
              t->input.source, spacing, 1e3 * span, advice);
}

void
import_judge(struct tool *t, const struct rc_grid *g, const struct rc_wish *wish, double unit)
{
    double x = (double)g->nx * g->dx, y = g->ny > 1 ? (double)g->ny * g->dy : x;
    double span = strcmp(g->unit, "m") == 0 ? span_of(g) : 0;
    char by[32] = " long";

    if (g->ny > 1)
        snprintf(by, sizeof by, " by %.4g m", y);
    if (isnan(wish->dx) && (fmax(x, y) > longest || fmin(x, y) < shortest))
        tool_warn(t,
                  "%s: the %s is %.4g m%s, which is implausible: if the file means another unit, "
                  "--dx%s the spacing",
                  t->input.source, g->ny > 1 ? "map" : "profile", x, by,
                  g->ny > 1 ? " and --dy give" : " gives");
    if (isnan(wish->z_unit) && span > fmax(x, y))
        tool_warn(t,
                  "%s: the heights span %.4g m, more than the %.4g m of the longer side, which is "
                  "implausible: if the unit is wrong, give --z-unit for the heights, or --dx for "
                  "the spacing",
                  t->input.source, span, fmax(x, y));
    else if (strcmp(g->unit, "m") == 0 &&
             tool_judge_slope(t, t->input.source, slope_of(g),
                              isnan(wish->z_unit)
                                  ? "if a unit is wrong, give --z-unit for the heights, or --dx "
                                    "for the spacing"
                                  : "are --z-unit and the spacing right?"))
        return;
    else if (isnan(wish->dx) && isnan(wish->z_unit) && fmax(x, y) <= longest)
        judge_millimetres(t, g, unit, span);
}

/* ---- marks of missing points ---- */

/* An extreme value, the number of its nodes, and the next value inside the range. */
struct end {
    double value, next; /* `next`: the nearest other value */
    size_t n;
};

static void
find_end(const struct rc_grid *g, bool least, struct end *end)
{
    double way = least ? 1 : -1;

    *end = (struct end){.value = way * INFINITY, .next = way * INFINITY};
    for (size_t k = 0; k < g->nx * g->ny; k++) {
        double v = g->v[k];

        if (!isfinite(v))
            continue;
        if (v == end->value)
            end->n++;
        else if (way * v < way * end->value) {
            end->next = end->value;
            end->value = v;
            end->n = 1;
        } else if (way * v < way * end->next)
            end->next = v;
    }
}

/* True if programs use the number for missing points: nines, a power of two less one, or a very large
 * number. */
static bool
is_usual_mark(double value)
{
    static const double marks[] = {999,   9999,  99999, 999999,     9999999,
                                   32767, 32768, 65535, 2147483647, 2147483648.0};

    for (size_t k = 0; k < sizeof marks / sizeof *marks; k++)
        if (fabs(fabs(value) / marks[k] - 1) < 1e-12)
            return true;
    return fabs(value) >= 1e30;
}

static void
judge_end(struct tool *t, const struct rc_grid *g, double unit, const struct end *end,
          double other_end, size_t finite)
{
    double rest = fabs(other_end - end->next), gap = fabs(end->value - end->next);
    double mark = end->value / unit;
    char number[32], in_unit[SHOWN_NUMBER];

    if (!isfinite(gap) || rest == 0 || finite - end->n < 3)
        return;
    if (is_usual_mark(mark) ? gap < rest : gap < 3 * rest || end->n * 100 < finite || end->n < 2)
        return;
    snprintf(number, sizeof number, "%.10g", mark);
    snprintf(in_unit, sizeof in_unit, "%.4g", end->value);
    tool_warn(t,
              "%s: %zu of %zu values are %s in the file (%s %s), far from all others: if it marks "
              "missing points, --missing=%s says so",
              t->input.source, end->n, g->nx * g->ny, number, in_unit, g->unit, number);
}

void
import_judge_marks(struct tool *t, const struct rc_grid *g, double unit)
{
    struct end least, most;
    size_t finite = 0;

    for (size_t k = 0; k < g->nx * g->ny; k++)
        finite += isfinite(g->v[k]) != 0;
    find_end(g, true, &least);
    find_end(g, false, &most);
    judge_end(t, g, unit, &least, most.value, finite);
    judge_end(t, g, unit, &most, least.value, finite);
}
