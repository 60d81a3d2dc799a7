/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The exponential law over the shortest range that the grid resolves, for use if only the work matters.
 */
#include "law.h"

static void
set(struct rc_attraction *a, double diagonal)
{
    rc_adhesion_exponential.set(a, diagonal);
}

static double
range(double work, double cohesive, double diagonal)
{
    return rc_adhesion_exponential.range(work, cohesive, diagonal);
}

static void
at(const struct rc_attraction *a, size_t n, const double *restrict g, double *restrict v,
   double *restrict s, double *restrict d)
{
    rc_adhesion_exponential.at(a, n, g, v, s, d);
}

const struct rc_adhesion_law rc_adhesion_jkr = {
    .info = {.name = "jkr",
             .summary = "exponential over the shortest range that the grid resolves: only the work "
                        "matters"},
    .set = set,
    .range = range,
    .at = at,
};
