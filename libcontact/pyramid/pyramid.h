/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The extension E of numbers on a set W of nodes to all nodes, by a pyramid of coarser grids.
 *
 * Each coarser grid has half the nodes a side. The direction with the larger spacing is halved only when the
 * other has reached the same spacing. P interpolates linearly from level l + 1 to level l, P' is its
 * transpose. X are sums of the numbers, w sums of their weights, and y = E r:
 *
 *     X_0 = r on W, w_0 = 1 on W;   X_l+1 = k P' (c X_l),   w_l+1 = k P' min(w_l, 1),   c = min(1, 1/w_l)
 *     y_l = (X_l + t P y_l+1) / (w_l + t);   y_0 = r on W, P y_1 elsewhere
 *
 * A node off W gets the mean over a part of W whose width is about its distance. This is nearly the field of
 * least energy. The inverse of the influence operator grows as A(q) ~ q^a. The constants k and t of a level
 * follow from the power a at waves as long as the spacing of the level. Far from a single patch the field of
 * least energy decreases as |x|^(a-d) in d directions, which gives k = 2^(a-d), at most 1. The coarser values
 * have the weight t: 2 for a = 1, 1/2 for a = 2, and half as much for each further unit of a. Bending bodies
 * need a smooth field. On a line t = 32 for a = 0, where E r is near 0 off W, as on a long narrow map (strips
 * in operator.c). With a = 1 a map of 65536 x 16 nodes with 6 % contact took 528 steps in place of 9. An
 * alternative is one mean over W with weights |x|^(-5/2) by a convolution. It had eigenvalues of E' A E K up
 * to 2.6 at 2 % contact, this one up to 1.15. Under coatings 400 times as stiff as their base these are 9 and
 * 4.
 *
 * Pairs of numbers, one for each direction along the surface, have symmetric 2 x 2 weights: W_0 between 0 and
 * 1, X_0 = W_0 r. min and max act on the eigenvalues.
 */
#ifndef RC_PYRAMID_H
#define RC_PYRAMID_H

#include <stdbool.h>

#include "libcontact/operator/operator.h"

struct rc_pyramid;

/* The finest grid: `shape` describes the whole of it; rows first .. first + n - 1 are held here. */
struct rc_pyramid_base {
    struct rc_shape shape;
    size_t first, n;
    size_t unit;  /* the first row of each rank is a multiple of this even number */
    size_t count; /* number of ranks that share it */
    struct rc_boundary boundary;
    bool pairs; /* pairs of numbers, with matrices as weights */
    int threads;
    const struct rc_ranks *ranks; /* NULL: none                                              */
};
/* The same of a map of this shape in a frame, of which this rank holds these rows with their part of the
 * frame. */
struct rc_pyramid_base rc_pyramid_base_of(const struct rc_shape *shape, struct rc_boundary boundary,
                                          struct rc_frame frame, const struct rc_rows *rows);
/* The power a at wave number q (per unit of the spacings). */
typedef double rc_power_at(const void *of, double q);
/* NULL when memory is short on any rank. */
struct rc_pyramid *rc_pyramid_new(const struct rc_pyramid_base *base, rc_power_at *power,
                                  const void *of, struct rc_err *err);
/* Changes the power, from the next set on. */
void rc_pyramid_tune(struct rc_pyramid *pyramid, rc_power_at *power, const void *of);
void rc_pyramid_free(struct rc_pyramid *pyramid);
RC_OWNER(rc_pyramid)

/* Adds `weight` times row j (of those held here) of component c to `to`; several threads call it. */
typedef void rc_pyramid_add(const void *of, int c, size_t j, float weight, float *to);
/* Sets W from rows that hold 1 on W, else 0; for pairs the components xx, yy, xy of w_0, at most 1.
 * Afterwards rc_pyramid_row gives for each node the part of its surroundings that is on W, weighted with the
 * distance r as r^(-5/2). */
void rc_pyramid_set(struct rc_pyramid *pyramid, rc_pyramid_add *w, const void *of);
/* Extends r, given by rows that are zero off W (for pairs w_0 r): afterwards rc_pyramid_row gives E r off W,
 * for pairs P y_1. `beyond` is y beyond the coarsest level, one number per component; NULL: 0. */
void rc_pyramid_extend(struct rc_pyramid *pyramid, rc_pyramid_add *r, const void *of,
                       const double *beyond);
/* The transpose: from the rows of f off W, zero on W. Afterwards rc_pyramid_row gives E' f on W without f
 * itself (for pairs to be multiplied by w_0). `beyond`, unless NULL, becomes the derivative with respect to y
 * beyond the coarsest level. */
void rc_pyramid_gather(struct rc_pyramid *pyramid, rc_pyramid_add *f, const void *of,
                       double *beyond);
/* Row j (of those held here) of component c; several threads call it. */
void rc_pyramid_row(const struct rc_pyramid *pyramid, int c, size_t j, float *row);

#endif
