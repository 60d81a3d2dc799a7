/*
 * The extension E of numbers on a set W of nodes to all nodes, over coarser and coarser grids.
 *
 * Each coarser grid has half the nodes a side (along the wider spaced direction only once the other has
 * caught up). P interpolates linearly from level l + 1 to level l, P' sums back; X are sums of numbers, w of
 * their weights, and y = E r:
 *
 *     X_0 = r on W, w_0 = 1 on W;   X_l+1 = k P' (c X_l),   w_l+1 = k P' min(w_l, 1),   c = min(1, 1/w_l)
 *     y_l = (X_l + t P y_l+1) / (w_l + t);   y_0 = r on W, P y_1 elsewhere
 *
 * So a node off W takes the mean over W of a region about as wide as it is far away, as the energy wants it.
 * How much is said of that by the power a with which the inverse of the influence operator, A(q) ~ q^a, grows
 * at waves as long as the grid of a level is wide, k and t. Far from a patch alone the field of least energy
 * falls off as |x|^(a-d) in d directions, to which belongs k = 2^(a-d), at most 1. A weight t is given to
 * what the coarser grids say: 2 for a = 1, 1/2 for a = 2, and half for each further one, since a body that
 * bends wants what is smooth; on a line 32 for a = 0, where E r is near 0 off W, as on a long strip that ends
 * at its sides (operator.c): with a = 1 there 65536 x 16 nodes with 6 % contact took 528 steps in place of 9.
 * Tried beside it: one mean over W with weights |x|^(-5/2), by a convolution, had eigenvalues of E' A E K up to
 * 2.6 at 2 % contact, where these are up to 1.15; under coats 400 times as stiff as their base 9, now 4.
 *
 * Pairs of numbers, one for each direction along the surface, have symmetric 2 x 2 weights, W_0 anything from 0
 * to 1, X_0 = W_0 r; min and max are those of the eigenvalues.
 */
#ifndef RC_PYRAMID_H
#define RC_PYRAMID_H

#include <stdbool.h>

#include "libcontact/operator/operator.h"

struct rc_pyramid;

/* The finest grid: `shape` all of its nodes, of which rows first .. first + n - 1 are held here. */
struct rc_pyramid_base {
    struct rc_shape shape;
    size_t first, n;
    size_t unit;  /* the first row held by any rank is a multiple of it, which is even */
    size_t count; /* of ranks that share it                                            */
    bool round;   /* the map repeats                                         */
    bool pairs;   /* of numbers, with weights that are matrices; on one rank */
    int threads;
    const struct rc_ranks *ranks; /* NULL: none                                              */
};
/* The power a at wave number q, over the unit of the spacings. */
typedef double rc_power_at(const void *of, double q);
/* NULL when memory is short on any rank. */
struct rc_pyramid *rc_pyramid_new(const struct rc_pyramid_base *base, rc_power_at *power,
                                  const void *of, struct rc_err *err);
void rc_pyramid_free(struct rc_pyramid *pyramid);
/* Bytes of it on a rank that holds base->n rows; `ranks` does not count. */
size_t rc_pyramid_memory(const struct rc_pyramid_base *base);

/* Adds `weight` times row j of those held here, of component c, to `to`; called by several threads. */
typedef void rc_pyramid_add(const void *of, int c, size_t j, float weight, float *to);
/* Takes W: its rows hold 1 on W, else 0; of pairs the components xx, yy, xy of w_0, at most 1. Afterwards
 * rc_pyramid_row gives the part of the surroundings of each node that is on W, those at a distance r weighted
 * as r^(-5/2). */
void rc_pyramid_set(struct rc_pyramid *pyramid, rc_pyramid_add *w, const void *of);
/* From the rows of r on W, zero elsewhere (of pairs w_0 r): afterwards rc_pyramid_row gives E r off W, of pairs
 * P y_1. `beyond` stands for y beyond the coarsest level, a number a component; NULL: 0. */
void rc_pyramid_extend(struct rc_pyramid *pyramid, rc_pyramid_add *r, const void *of,
                       const double *beyond);
/* The transpose: from the rows of f off W, zero on W; afterwards rc_pyramid_row gives what E' f has on
 * W beside f (of pairs to be multiplied by w_0). `beyond`, unless NULL: what it has of y beyond the coarsest
 * level. */
void rc_pyramid_gather(struct rc_pyramid *pyramid, rc_pyramid_add *f, const void *of,
                       double *beyond);
/* Row j of those held here, of component c; called by several threads. */
void rc_pyramid_row(const struct rc_pyramid *pyramid, int c, size_t j, float *row);

#endif
