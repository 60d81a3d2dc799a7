/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The parts of the estimated error of a solution at the end of a path, and the largest of them.
 */
#ifndef RC_TOOL_ERRORS_H
#define RC_TOOL_ERRORS_H

#include "tools/cli/cli.h"

/* Relative L1 errors, whose sum is the estimate; of the part of the increments, with the inherited one,
 * and of the part of the slabs the squares are added. A part is 0 if its cause is absent, and NAN if it is
 * unknown. */
struct error_parts {
    bool told;        /* there are several parts; otherwise the report contains null */
    double increment; /* from the increments of this load */
    double inherited; /* from earlier states */
    double iteration;
    double contact; /* from the tolerance of the contacts */
    double image;   /* from the edge of a map that is not periodic */
    double slab;    /* from the thickness of slabs; not reported here */
};

/* NAN if a part is unknown. */
double errors_sum(const struct error_parts *parts);
/* The one definition of `converged`: this estimate, the sum of all parts, is known and at most the goal. */
static inline bool
errors_within(double estimate, double goal)
{
    return estimate <= goal;
}
/* What reduces the largest part: "increments", "history", "tolerance", "map" or "slabs"; "unknown" if a part
 * is unknown, NULL if all are 0. */
const char *errors_limited_by(const struct error_parts *parts);
/* Keys from increment_error_estimate to error_limited_by. */
void errors_report(struct report *report, const struct error_parts *parts);

#endif
