/*
 * The parts of the estimated error of a solution that a path has led to, and which of them is the largest.
 */
#ifndef RC_TOOL_ERRORS_H
#define RC_TOOL_ERRORS_H

#include "tools/cli/cli.h"

/* Relative L1 errors, which add up; 0: the effect does not act; NAN: unknown. */
struct error_parts {
    bool told;        /* there are several parts: else the report holds null */
    double increment; /* of the increments of this load                      */
    double inherited; /* of the states before                                */
    double iteration;
    double contact; /* of the tolerance of the contacts                    */
    double image;   /* of the edge of a map that does not repeat           */
};

/* NAN where a part is unknown. */
double errors_sum(const struct error_parts *parts);
/* The one meaning of `converged`: this estimate, the sum of all parts, is known and at most the goal. */
static inline bool
errors_within(double estimate, double goal)
{
    return estimate <= goal;
}
/* What lowers the largest part: "increments", "history", "tolerance", "map"; "unknown" where a part is
 * unknown, NULL where all are 0. */
const char *errors_limited_by(const struct error_parts *parts);
/* Keys from increment_error_estimate to error_limited_by. */
void errors_report(struct report *report, const struct error_parts *parts);

#endif
