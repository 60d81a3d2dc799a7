/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Transfers smooth fields between a map and a coarser grid of every s-th node. Internal: never installed.
 */
#ifndef RC_COARSE_GRID_H
#define RC_COARSE_GRID_H

#include "stress.h"

struct rc_coarse;

/* Largest spacing (m) of a grid for the kernels of this depth. With it the error of a stress is at most tol
 * times the largest pressure, or rounding, whatever the signs of the pressures. */
double rc_coarse_spacing(double depth, double tol);
/* Steps in x and y for that spacing, 1 along an axis that repeats; false when no coarser grid pays. */
bool rc_coarse_steps(const struct rc_shape *shape, struct rc_boundary boundary, double spacing,
                     size_t *sx, size_t *sy);
/* The coarser grid; its nodes extend beyond the map. */
struct rc_shape rc_coarse_shape(const struct rc_shape *shape, size_t sx, size_t sy);

/* Where ranks share the map, both grids have the rows of rc_rows_of. NULL when memory is short. */
struct rc_coarse *rc_coarse_new(const struct rc_ranks *ranks, const struct rc_shape *shape,
                                size_t sx, size_t sy, size_t threads, struct rc_err *err);
void rc_coarse_free(struct rc_coarse *coarse);
RC_OWNER(rc_coarse)
/* Reduces pressures (forces) of the map to the coarser grid, and interpolates a field back. `error`: an
 * estimate of the error of both is added; NULL: not requested. */
void rc_coarse_reduce(struct rc_coarse *coarse, const double *p, double *out);
void rc_coarse_expand(struct rc_coarse *coarse, const double *u, double *out, double *error);

#endif
