/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Unevenly spaced profiles: refused, or resampled if the user asks for it.
 *
 * Between neighbouring points a profile is interpolated linearly. It is unknown across a gap of more than
 * RC_EVEN_GAP steps (or median spacings, where the step is finer) and next to a missing point. The
 * profile's own step is the median of the spacings, so that a gap or a cluster of points does not change
 * it. It is fitted so that whole steps fill the length.
 */
#ifndef RC_EVEN_H
#define RC_EVEN_H

#include "file.h"
#include "wish.h"

enum {
    RC_EVEN_GAP = 5
};

struct rc_even {
    double first, step; /* first node and step, in the unit of the positions             */
    size_t n;           /* nodes                                                         */
    double widest;      /* largest gap that is interpolated; 0: the points are the nodes */
};

/* Nodes for points at x[0] < x[1] < ... in units of `metres` (NAN: unknown), at the user's step. Without
 * such a step the nodes are the points themselves. They must then be even to a twentieth of a step, or
 * to the last decimal in the file. RC_FAIL for uneven points without a wish, and for an unsuitable step. */
enum rc_status rc_even_new(const double *x, size_t points, double metres,
                           const struct rc_file *file, const struct rc_wish *wish,
                           struct rc_even *even, struct rc_err *err);
/* Interpolates the heights z at the points to the nodes. Points between two nodes may be higher than both:
 * notes->above and below hold the difference. */
void rc_even_heights(const struct rc_even *even, const double *x, const double *z, size_t points,
                     double *v, struct rc_notes *notes);
/* True if the positions x[0], x[stride], ... run one way, except for steps back that are a tenth of
 * their path at most: those of a drive that vibrates, or rounded positions. */
bool rc_even_one_way(const double *x, size_t points, size_t stride);
/* The step of an axis of n > 1 increasing or decreasing points, even in the same sense. RC_FAIL where they
 * are not even; `name` is the axis in messages. A decreasing x is reversed. */
enum rc_status rc_axis_step(const char *name, double *x, size_t n, double *step,
                            struct rc_err *err);

#endif
