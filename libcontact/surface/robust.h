/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Robust statistics, insensitive to single points that lie far off: the median, and weights that exclude such
 * points. Internal: never installed.
 */
#ifndef RC_ROBUST_H
#define RC_ROBUST_H

#include <math.h>
#include <stddef.h>

#include "libcontact/contact.h"

/* The median of v - about or, with `magnitude`, of |v - about|, over the values that are not NaN. For an even
 * number of them it is the mean of the two in the middle. Exact, independent of the number of threads. NAN
 * when all are NaN. */
double rc_median(const double *v, size_t n, double about, bool magnitude, int threads);

/* The difference of each height from the median of the others in the 5 x 5 nodes around it, NAN where there
 * is none, and the spread of these differences: 1.4826 times their median absolute deviation. RC_FAIL when a
 * height is infinite or memory is short. */
enum rc_status rc_median_differences(const struct rc_shape *shape, struct rc_boundary boundary,
                                     size_t threads, const double *h, double *d, double *spread,
                                     struct rc_err *err);

/* The median of |r| times this is the residual at which a point loses all weight (ISO 16610-31, 16610-71):
 * three standard deviations for Gaussian residuals. */
static const double rc_biweight_reach = 4.4478;

/* Reweighting stops when the relative change of the reach is below the first number. It also stops when
 * the reach over the heights is below the second, so that only rounding is left, or after
 * RC_REWEIGHT_MAX rounds. A relative change of 1e-3 of the reach changes weights by as little. */
static const double rc_reweight_tol = 1e-3;
static const double rc_reweight_floor = 1e-13;
enum {
    RC_REWEIGHT_MAX = 40
};

/* Weight of a point with the residual r (Beaton and Tukey 1974): 0 for |r| >= reach and where r is NaN. */
static inline double
rc_biweight(double r, double reach)
{
    double s = r / reach, left = 1 - s * s;

    return left > 0 ? left * left : 0;
}

/* True if reweighting has converged; `before` is the reach of the last round, `size` that of the heights. */
static inline bool
rc_reweighted(double reach, double before, double size)
{
    return !(reach > rc_reweight_floor * size) || fabs(reach - before) <= rc_reweight_tol * before;
}

#endif
