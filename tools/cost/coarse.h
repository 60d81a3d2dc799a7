/*
 * A map on fewer nodes, and back. The coarse grid tiles the same area, so that a period stays what
 * it was and a load has the same mean: where the number of nodes cannot be divided its cells are a
 * little wider or narrower.
 */
#ifndef RC_COARSE_H
#define RC_COARSE_H

#include "libcontact/grid.h"

/* About 1/factor of the nodes a side; a side of one node keeps it. */
struct rc_shape coarse_shape(const struct rc_shape *fine, unsigned factor);
/* Heights: the mean over each coarse cell. Means lower the peaks; nodes picked from the map
 * would keep some of them, but alias every wave that the coarse grid cannot hold. */
void coarse_means(const struct rc_shape *fine, const double *h, const struct rc_shape *coarse,
                  double *to);
/* Pressures: constant over each coarse cell, so that the load is kept. */
void coarse_spread(const struct rc_shape *coarse, const double *p, const struct rc_shape *fine,
                   double *to);

#endif
