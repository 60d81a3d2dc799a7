/*
 * An approximate inverse of the influence operator restricted to a set of nodes: z = E' A E r.
 *
 * With K restricted to the working set W, its exact inverse is the Schur complement of A = K^-1: A
 * applied to the extension of r off W that has the least energy. Here E is the extension of pyramid.h. A is
 * the operator's factor in wave numbers. A free map lies in the operator's frame, in which E r goes on
 * and falls off linearly to its end. The map r -> z is symmetric, and as E r has no less energy than the
 * least, r'z >= r' (K_WW)^-1 r: z bounds the error of the pressure on W in the energy norm from above.
 */
#ifndef RC_PRECONDITIONER_H
#define RC_PRECONDITIONER_H

#include "libcontact/operator/operator.h"

struct rc_preconditioner;

/* `op` stays the caller's and outlives it. NULL when memory is short. */
struct rc_preconditioner *rc_preconditioner_new(struct rc_operator *op, struct rc_err *err);
void rc_preconditioner_free(struct rc_preconditioner *e);
size_t rc_preconditioner_memory(const struct rc_shape *shape,
                                const struct rc_operator_options *options);
/* The working set: entries 1 of w (0 elsewhere), at least one; w is referred to until the next
 * set. Costs no factor of a chain. Entries of w may change afterwards: the map r -> z stays symmetric, but E
 * gets less accurate. */
void rc_preconditioner_set(struct rc_preconditioner *e, const unsigned char *w);
/* z = E' A E (r - offset) on the working set, zero elsewhere, in the units of the operator's rows.
 * `done` (NULL: none) is called with each row of the result, complete in z, as soon as it is there.
 * Costs one factor of a chain. */
void rc_preconditioner_apply(struct rc_preconditioner *e, const float *r, float offset, float *z,
                             rc_row *done, void *ctx);
/* E r, with W the nodes where w is 1, in `out` at all others. The working set has to be set anew afterwards.
 * Costs no factor of a chain. */
void rc_preconditioner_extend(struct rc_preconditioner *e, const unsigned char *w, const float *r,
                              float *out);

/* For each node on W minus its share of the load of a shift of all of W. */
#define RC_LEAST_SHARE 1e-3F
static inline float
rc_load_share(float node)
{
    return node < 0 ? -node : RC_LEAST_SHARE; /* a node that has joined since */
}

/* A shift of all of W belongs to no residual, and its pressure M 1, M = E' A E, has to be taken out of
 * z. rc_load_share of these numbers is about M 1, up to a factor, for each node on W. */
const float *rc_preconditioner_nodes(const struct rc_preconditioner *e);
/* Sets rc_load_share to M 1 itself, up to a factor, until the next set; z: scratch of a number for each
 * node. Costs one factor of a chain. */
void rc_preconditioner_spread(struct rc_preconditioner *e, float *z);

#endif
