/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * An approximate inverse of the influence operator restricted to a set of nodes: z = E' A E r.
 *
 * With K restricted to the working set W, its exact inverse is the Schur complement of A = K^-1. This is A
 * applied to the extension of r off W with the least energy. Here E is the extension of pyramid.h, and A is a
 * factor of the operator in wave numbers. A free map lies in the operator's frame, in which E r continues and
 * decreases linearly to the end of the frame. The map r -> z is symmetric. No extension has less energy than
 * the exact one, so r'z >= r' (K_WW)^-1 r. Thus z bounds the error of the pressure on W in the energy norm
 * from above.
 *
 * A diagonal D that differs by node has no such factor. A is then the sum over some values d_l of D of s_l (K
 * + d_l I)^-1 s_l, with weights s_l of the nodes. s_l^2 decreases linearly in log D from 1 at d_l to 0 at the
 * next values. The sum of all s_l^2 is 1. Where all nodes have D = d_l this is the exact inverse. Then z is
 * an estimate, not a bound.
 *
 * Rows that move as a whole, by row R'R, are in A, in the waves along y. Where that motion is stiff, this is
 * too soft for the part of a row that is on W. Then M = Q E' A E Q + (I - Q) C, where Q takes the mean over W
 * off each row, and C is the inverse of the stiffness of a row.
 */
#ifndef RC_PRECONDITIONER_H
#define RC_PRECONDITIONER_H

#include "libcontact/operator/operator.h"

struct rc_preconditioner;

/* The caller owns `op`, which outlives the preconditioner. NULL when memory is short. */
struct rc_preconditioner *rc_preconditioner_new(struct rc_operator *op, struct rc_err *err);
/* The diagonal of the operator was changed: applies from the next set on. RC_FAIL when memory is short. */
enum rc_status rc_preconditioner_tune(struct rc_preconditioner *e, struct rc_err *err);
/* Convolutions in one rc_preconditioner_apply: 1 unless the diagonal differs by node. */
double rc_preconditioner_factors(const struct rc_preconditioner *e);
void rc_preconditioner_free(struct rc_preconditioner *e);
RC_OWNER(rc_preconditioner)
/* The working set: entries 1 of w (0 elsewhere), at least one. w is read until the next set. The call does no
 * convolution. If entries of w change afterwards, the map r -> z stays symmetric but E gets less accurate. */
void rc_preconditioner_set(struct rc_preconditioner *e, const unsigned char *w);
/* z = E' A E (r - offset) on the working set, zero elsewhere, in the units of the operator's rows. `done`
 * (NULL: none) is called for each row of z as soon as it is complete. It takes
 * rc_preconditioner_factors() convolutions. */
void rc_preconditioner_apply(struct rc_preconditioner *e, const float *r, float offset, float *z,
                             rc_row *done, void *ctx);
/* E r, with W the nodes where w is 1, in `out` at all other nodes. The working set must be set again
 * afterwards. The call does no convolution. */
void rc_preconditioner_extend(struct rc_preconditioner *e, const unsigned char *w, const float *r,
                              float *out);

/* For each node on W it is minus the node's share of the load of a common shift of W. */
#define RC_LEAST_SHARE                                                                             \
    1e-3F /* of a node that joined; not sensitive: half and double change no count */
static inline float
rc_load_share(float node)
{
    return node < 0 ? -node : RC_LEAST_SHARE; /* the node joined after the last set */
}

/* A common shift of W belongs to no residual, so its pressure M 1, M = E' A E, is taken out of z.
 * rc_load_share of these numbers is about M 1, up to a factor, for each node on W. */
const float *rc_preconditioner_nodes(const struct rc_preconditioner *e);
/* Sets rc_load_share to M 1 exactly, up to a factor, until the next set; z: scratch, a number for each node.
 * Costs one factor of a chain. */
void rc_preconditioner_spread(struct rc_preconditioner *e, float *z);

#endif
