/*
 * An approximate inverse of the influence operator restricted to a set of nodes: z = E' A E r.
 *
 * With K restricted to the working set W, its exact inverse is the Schur complement of A = K^-1: A
 * applied to the extension of r off W that has the least energy. Here E is an explicit extension,
 *
 *     (E r)_i = r_i on W,   sum_j G_ij r_j / (sum_j G_ij + f_i) elsewhere, j over W,
 *     G_ij = |x_i - x_j|^(-5/2),   f_i = c d_i^(-1/2) / (1 + (S_i/3)^4),   S_i = d_i^(1/2) sum_j G_ij,
 *
 * lengths in units of sqrt(dx dy), d_i the distance from i to W less half a unit, at least 1/4. A, its
 * factor in wave numbers, and the constant c are the operator's. On a period of one line the power is
 * -3/2, c is smaller, and 3 is 5/4, which S_i is to a half-line as 3 is to a half-plane. A free map lies
 * in the operator's frame, in which E r goes on and falls off linearly to its end. Where the operator
 * bends, G_ij is divided by (1 + |x_i - x_j| / bends)^(3/2), and f_i is next to nothing. The map r -> z
 * is symmetric, and as E r has no less energy than the least, r'z >= r' (K_WW)^-1 r: z bounds the error
 * of the pressure on W in the energy norm from above.
 */
#ifndef RC_PRECONDITIONER_H
#define RC_PRECONDITIONER_H

#include "libcontact/operator/operator.h"

struct rc_preconditioner;

/* `op` stays the caller's and outlives it. NULL when memory is short. */
struct rc_preconditioner *rc_preconditioner_new(struct rc_operator *op, struct rc_err *err);
void rc_preconditioner_free(struct rc_preconditioner *e);
size_t rc_preconditioner_memory(const struct rc_shape *shape, enum rc_boundary boundary,
                                size_t ranks);
/* The working set: entries 1 of w (0 elsewhere), at least one; w is referred to until the next
 * set. With `measure` the distances d_i are found too, else those of the last set are kept: they
 * change little when the set does. Costs one factor of a chain; with `measure` up to three times
 * that. Entries of w may change afterwards: the map r -> z stays symmetric, but E gets less
 * accurate. */
void rc_preconditioner_set(struct rc_preconditioner *e, const unsigned char *w, bool measure);
/* z = E' A E (r - offset) on the working set, zero elsewhere, in the units of the operator's rows.
 * `done` (NULL: none) is called with each row of the result, complete in z, as soon as it is there.
 * Costs three factors of a chain. */
void rc_preconditioner_apply(struct rc_preconditioner *e, const float *r, float offset, float *z,
                             rc_row *done, void *ctx);

/* A number for each node: on W its share of the load of a shift of all of W, off W the weight of
 * the extension there. Both are positive and no node has both, so one number holds either: minus
 * the share, or the weight. */
#define RC_LEAST_SHARE 1e-3F
static inline float
rc_node_on(float share)
{
    return -share;
}
static inline float
rc_node_off(float weight)
{
    return weight;
}
static inline float
rc_load_share(float node)
{
    return node < 0 ? -node : RC_LEAST_SHARE; /* a node that has joined since */
}
static inline float
rc_extension_weight(float node)
{
    return node > 0 ? node : 0; /* a node that has left since */
}

/* A shift of all of W belongs to no residual, and its pressure M 1, M = E' A E, has to be taken out of
 * z. rc_load_share of these numbers is about M 1, up to a factor, for each node on W. */
const float *rc_preconditioner_nodes(const struct rc_preconditioner *e);
/* Sets rc_load_share to M 1 itself, up to a factor, until the next set; z: scratch of a number for each
 * node. Costs three factors of a chain. */
void rc_preconditioner_spread(struct rc_preconditioner *e, float *z);

/* distance.c: how far every node is from the nearest one with w != 0, exactly but for rounding, in
 * two passes. First the number of steps along its column, for all nodes of these rows (rows->ranks
 * NULL: of all; else `lines` is scratch of three lines) ... */
void rc_distance_columns(const struct rc_shape *shape, const struct rc_rows *rows,
                         enum rc_boundary boundary, const unsigned char *w, int threads,
                         double *lines, float *steps);
/* ... then, row by row, the square of the distance, lengths as dx and dy are, from those of the
 * row; infinite when there is no such node. `scratch` holds rc_distance_scratch numbers and belongs
 * to one thread. */
size_t rc_distance_scratch(const struct rc_shape *shape);
void rc_distance_row(const struct rc_shape *shape, enum rc_boundary boundary, float *scratch,
                     const float *steps, float *d2);

#endif
