/*
 * Profiles whose points are not evenly apart: told, and resampled where the user wishes it.
 *
 * Between neighbouring points a profile is taken for straight. Across a gap of more than
 * RC_EVEN_GAP steps (or median spacings, where the step is finer) it is not known, and neither
 * next to a missing point. The step of its own is the median of the spacings, so that a gap or a
 * cluster of points does not change it, fitted so that whole steps fill the length.
 */
#ifndef RC_EVEN_H
#define RC_EVEN_H

#include "file.h"
#include "wish.h"

enum {
    RC_EVEN_GAP = 5
};

struct rc_even {
    double first, step; /* of the nodes, in the unit of the positions         */
    size_t n;           /* nodes                                              */
    double widest;      /* gap that is bridged; 0: the points are the nodes   */
};

/* Lays nodes along points at x[0] < x[1] < ..., `metres` each (NAN: not known): by the wish, or the
 * points themselves where they are even, give or take a twentieth of a step or the last decimal
 * that is there. RC_FAIL where they are not and no wish says what then, and for a step that does
 * not fit. */
enum rc_status rc_even_new(const double *x, size_t points, double metres,
                           const struct rc_file *file, const struct rc_wish *wish,
                           struct rc_even *even, struct rc_err *err);
/* The heights at the nodes of those at the points. */
void rc_even_heights(const struct rc_even *even, const double *x, const double *z, size_t points,
                     double *v);

#endif
