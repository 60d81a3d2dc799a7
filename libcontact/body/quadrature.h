/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Integrals over the cells of a grid of functions that are smooth on the scale of their distance. Gauss's
 * rule takes fewer points at larger distances. At the largest distances means are computed from the values at
 * the nodes. Internal: never installed.
 */
#ifndef RC_QUADRATURE_H
#define RC_QUADRATURE_H

/* Points of a rule on (-1, 1). */
struct rc_gauss {
    double x, w;
};
enum {
    RC_GAUSS_MOST = 12
};
/* Point k of n, from the lowest; n = 3..9 or 12. */
struct rc_gauss rc_gauss_point(int n, int k);

/* The number of points of Gauss's rule in one direction, for a cell of this half side in that direction whose
 * middle is at this distance. For any kernel of a half-space the error is below 1e-13 of load times (cell /
 * distance)^2 / 2 pi. 0: no rule is accurate enough, below three half sides. Narrows *low to *high to the
 * distances that need the same number. */
int rc_gauss_points(double distance, double half_side, double *low, double *high);

/* The mean of a smooth function over a cell from its values f at the nodes: mean[0] f_0 + mean[1] (f_-1 +
 * f_1) + ... Beyond the distance `far` of cell.c its error is below 1e-13 of a load's field. */
enum {
    RC_MEAN_REACH = 3
};
extern const double rc_mean_of[RC_MEAN_REACH + 1];

#endif
