/*
 * An approximate inverse of the influence operator restricted to a set of nodes: z = E' A E r.
 *
 * With K restricted to the working set W, its exact inverse is the Schur complement of A = K^-1: A
 * applied to the extension of r off W that has the least energy. Here E is an explicit extension,
 *
 *     (E r)_i = r_i on W,   sum_j G_ij r_j / (sum_j G_ij + d_i^(-1/2) / 2) elsewhere, j over W,
 *     G_ij = |x_i - x_j|^(-5/2),
 *
 * lengths in units of sqrt(dx dy), d_i the distance from i to W less half a unit, at least 1/4; A
 * is the reciprocal of the padded kernel's spectrum, or of the symbol, E* |q| / 2, on a periodic
 * map. The map r -> z is symmetric, and as E r has no less energy than the least, r'z >= r'
 * (K_WW)^-1 r: z bounds the error of the pressure on W in the energy norm from above.
 */
#ifndef RC_PRECONDITIONER_H
#define RC_PRECONDITIONER_H

#include "libcontact/operator/operator.h"

struct rc_preconditioner;

struct rc_preconditioner *rc_preconditioner_new(const struct rc_shape *shape,
                                                enum rc_boundary boundary, size_t threads,
                                                struct rc_err *err);
void rc_preconditioner_free(struct rc_preconditioner *extension);
size_t rc_preconditioner_memory(const struct rc_shape *shape, enum rc_boundary boundary);
/* The working set: entries 1 of w (0 elsewhere), at least one; w is referred to until the next
 * set. With `measure` the distances d_i are found too, else those of the last set are kept: they
 * change little when it does. Costs one convolution in single precision, and with them several
 * times its time. Entries of w may change afterwards: the map stays symmetric, but E loses
 * quality as they do. */
void rc_preconditioner_set(struct rc_preconditioner *extension, const unsigned char *w,
                           bool measure);
/* z = E' A E (r - offset) on the working set, zero elsewhere, for E* = 1 and lengths in units of
 * sqrt(dx dy). `done` is called with each row of the result, complete in z, as soon as it is
 * there; NULL: nobody wants to know. Costs three of them. */
void rc_preconditioner_apply(struct rc_preconditioner *extension, const float *r, float offset,
                             float *z, rc_row *done, void *ctx);
/* The influence of a pressure, in the same units, in single precision: `in` writes its rows,
 * `out` takes those of the displacement. Costs one. */
void rc_preconditioner_displace(struct rc_preconditioner *extension, rc_row *in, rc_row *out,
                                void *ctx);

/* distance.c: how far every node is from the nearest one with w != 0, exactly but for rounding, in
 * two passes. First the number of steps along its column, for all nodes ... */
void rc_distance_columns(const struct rc_shape *shape, enum rc_boundary boundary,
                         const unsigned char *w, int threads, float *steps);
/* ... then, row by row, the square of the distance, lengths as dx and dy are, from those of the
 * row; infinite when there is no such node. `scratch` holds rc_distance_scratch numbers and belongs
 * to one thread. */
size_t rc_distance_scratch(const struct rc_shape *shape);
void rc_distance_row(const struct rc_shape *shape, enum rc_boundary boundary, float *scratch,
                     const float *steps, float *d2);

#endif
