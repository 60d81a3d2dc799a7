/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * sigma = sigma(0) (1 - g/gc)^2 up to gc = 3 w/sigma(0), where sigma and its slope are 0. The law is smooth
 * and has a finite range.
 */
#include "law.h"

static void
set(struct rc_attraction *a, double diagonal)
{
    (void)diagonal;
    a->strength = 3 * a->work / a->range;
    a->steepest = 2 * a->strength / a->range;
    a->reach = a->range;
    a->spread = 0;
}

static double
range(double work, double cohesive, double diagonal)
{
    (void)diagonal;
    return sqrt(6 * work * cohesive);
}

RC_CLONES static void
at(const struct rc_attraction *a, size_t n, const double *restrict g, double *restrict v,
   double *restrict s, double *restrict d)
{
    const double per = 1 / a->range, strength = a->strength, work = a->work;

    for (size_t k = 0; k < n; k++) {
        double below = g[k] < 0 ? g[k] : 0, x = 1 - (g[k] - below) * per;
        x = x > 0 ? x : 0;
        s[k] = strength * x * x;
        v[k] = strength * below - work * x * x * x;
        d[k] = g[k] < 0 ? 0 : 2 * strength * per * x;
    }
}

const struct rc_adhesion_law rc_adhesion_compact = {
    .info = {.name = "compact",
             .summary = "traction falls as a parabola that ends at the range",
             .ranged = true},
    .set = set,
    .range = range,
    .at = at,
};
