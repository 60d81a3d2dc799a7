/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * sigma(0) up to the range w/sigma(0), then 0 (Maugis 1992). A straight line, centred at this range, replaces
 * the jump; the grid resolves its slope, and w does not change.
 */
#include "law.h"

/* The spread relative to the displacement of a node by sigma(0), and its bounds relative to the range.
 * On the 5 maps of bench/constants.py with this law `least` decides, as a
 * choice of the law: half and double change the pull-off load by up to 0.2 and 0.4 %, those of the
 * others no bit. */
static const double nodes = 2, least = 0.05, most = 2;

static void
set(struct rc_attraction *a, double diagonal)
{
    a->strength = a->work / a->range;
    a->spread = fmin(fmax(nodes * a->strength * diagonal, least * a->range), most * a->range);
    a->steepest = a->strength / a->spread;
    a->reach = a->range + a->spread / 2;
}

/* The grid determines the cohesive length, unless the spread is at a bound; at the upper bound, steepest = w
 * / (most range^2). */
static double
range(double work, double cohesive, double diagonal)
{
    return fmax(sqrt(work * cohesive / most), sqrt(work * diagonal * nodes / most));
}

RC_CLONES static void
at(const struct rc_attraction *a, size_t n, const double *restrict g, double *restrict v,
   double *restrict s, double *restrict d)
{
    const double first = a->range - a->spread / 2, last = a->range + a->spread / 2;
    const double strength = a->strength, slope = strength / a->spread;

    for (size_t k = 0; k < n; k++) {
        /* the part of the line beyond the gap */
        double x = g[k] < last ? g[k] : last, rest = last - (x > first ? x : first);
        s[k] = slope * rest;
        v[k] = -slope * rest * rest / 2 + strength * (x < first ? x - first : 0);
        d[k] = g[k] >= first && g[k] < last && g[k] >= 0 ? slope : 0;
    }
}

const struct rc_adhesion_law rc_adhesion_dugdale = {
    .info = {.name = "dugdale",
             .summary = "the same traction up to the range, then none (Maugis)",
             .ranged = true},
    .set = set,
    .range = range,
    .at = at,
};
