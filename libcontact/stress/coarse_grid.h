/*
 * Between a map and a coarser grid of every s-th node, for fields that are smooth on it. Internal:
 * never installed.
 */
#ifndef RC_COARSE_GRID_H
#define RC_COARSE_GRID_H

#include "stress.h"

struct rc_coarse;

/* Largest spacing (m) at which the kernels of this depth may be known: the error of a stress is
 * then at most tol times the largest pressure, whatever its signs. 0: none. */
double rc_coarse_spacing(double depth, double tol);
/* Steps in x and y that go with it; false when no coarser grid pays. */
bool rc_coarse_steps(const struct rc_shape *shape, double spacing, size_t *sx, size_t *sy);
/* The coarser grid: its nodes overhang the map. */
struct rc_shape rc_coarse_shape(const struct rc_shape *shape, size_t sx, size_t sy);

/* NULL when memory is short. */
struct rc_coarse *rc_coarse_new(const struct rc_shape *shape, size_t sx, size_t sy, size_t threads,
                                struct rc_err *err);
void rc_coarse_free(struct rc_coarse *coarse);
/* Pressures (forces) of the map on the coarser grid, and a field back from it. */
void rc_coarse_reduce(struct rc_coarse *coarse, const double *p, double *out);
void rc_coarse_expand(struct rc_coarse *coarse, const double *u, double *out);

#endif
