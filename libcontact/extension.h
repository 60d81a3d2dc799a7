/*
 * An approximate inverse of the influence operator restricted to a set of nodes: z = E' A E r.
 *
 * With K restricted to the working set W, its exact inverse is the Schur complement of A = K^-1: A
 * applied to the extension of r off W that has the least energy. Here E is an explicit extension,
 *
 *     (E r)_i = r_i on W,   sum_j G_ij r_j / (sum_j G_ij + d_i^(-1/2) / 2) elsewhere, j over W,
 *     G_ij = |x_i - x_j|^(-5/2),
 *
 * lengths in units of sqrt(dx dy), d_i the distance from i to W less half a unit, at least 1/4; A is
 * the reciprocal of the padded kernel's spectrum, or of the symbol, E* |q| / 2, on a periodic map. The map r -> z is symmetric, and as E r has no
 * less energy than the least, r'z >= r' (K_WW)^-1 r: z bounds the error of the pressure on W in the
 * energy norm from above.
 */
#ifndef RC_EXTENSION_H
#define RC_EXTENSION_H

#include "inside.h"

struct rc_extension;

struct rc_extension *rc_extension_new(const struct rc_shape *shape, enum rc_boundary boundary,
                                      double estar, size_t threads, struct rc_err *err);
void rc_extension_free(struct rc_extension *extension);
/* The working set: nonzero entries of w, at least one. Costs one convolution in
 * single precision. */
void rc_extension_set(struct rc_extension *extension, const unsigned char *w);
/* z = E' A E r on the working set, zero elsewhere; r is zero off it. Costs three of
 * them. */
void rc_extension_apply(struct rc_extension *extension, const double *r, double *z);

/* distance.c: squared distance of every node to the nearest one with w != 0, lengths as dx and dy are.
 * `scratch` holds rc_distance_scratch numbers. O(nx ny) (Felzenszwalb and Huttenlocher, Theory of
 * Computing 8, 2012). */
size_t rc_distance_scratch(const struct rc_shape *shape, int threads);
void rc_distance_squared(const struct rc_shape *shape, const unsigned char *w, int threads,
                         double *scratch, double *d2);

#endif
