/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Functions of the distance from a load, given by their Hankel transforms G:
 *
 *     f(r) = integral from 0 to infinity of G(q) J_m(q r) q dq
 *
 * tabulated once for all grids, several functions together. Internal: never installed.
 */
#ifndef RC_RADIAL_H
#define RC_RADIAL_H

#include "libcontact/common.h"

struct rc_radial;

enum {
    RC_RADIAL_MOST = 11
};

struct rc_radial_source {
    size_t n;         /* functions that are looked up together, at most RC_RADIAL_MOST      */
    const int *order; /* m >= 0 of each                                                     */
    double scale;     /* m: f is smooth on this scale s; its nearest singularity is r = i s */
    double unit;      /* m: the unit of wave numbers is 1/unit                              */
    double last;      /* G = 0 where q unit is above this                                   */
    double tail;      /* G -> tail/q as q -> 0: f -> tail/r far away; of order 0            */
    void (*wave)(const void *ctx, double q, double *g); /* all n G */
    const void *ctx;
};

/* NULL when memory is short. */
struct rc_radial *rc_radial_new(const struct rc_radial_source *source);
void rc_radial_free(struct rc_radial *radial); /* NULL is allowed */
RC_OWNER(rc_radial)
/* f at `points` distances r >= 0, m: out[point * n + function]. */
void rc_radial_values(const struct rc_radial *radial, size_t points, const double *r, double *out);

#endif
