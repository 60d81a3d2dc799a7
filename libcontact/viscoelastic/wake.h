/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The displacement of a viscoelastic half-space over which a body slides, on a free map. Internal: never
 * installed.
 */
#ifndef RC_WAKE_H
#define RC_WAKE_H

#include "libcontact/body/body.h"

/* K = V exp(i d) on a padded map, with V > 0. `steepest` is the largest tan d of its waves, INFINITY
 * where the real part of K is not positive. `along` is V over the displacement of an elastic half-space with
 * the compliance `typical`. */
struct rc_wake {
    struct rc_along along;
    double steepest;
};
struct rc_sliding_medium {
    const struct rc_relaxation *material;
    double compliance; /* of body 2, 1/Pa                                   */
    double speed;      /* along x, not 0                                    */
    double typical;    /* 1/Pa                                              */
};
/* The mean of J(i w) over -omega < w < omega, 1/Pa (prony.c). It is real: instant + sum of compliance[j]
 * atan(y)/y with y = omega retardation[j]. */
double rc_relaxation_mean_compliance(const struct rc_relaxation *r, double omega);
struct rc_wake *rc_wake_new(const struct rc_shape *shape, const struct rc_sliding_medium *medium,
                            size_t threads, struct rc_err *err);
void rc_wake_free(struct rc_wake *wake); /* NULL is allowed */
RC_OWNER(rc_wake)
/* Takes the pressure p for the fields below. */
void rc_wake_load(struct rc_wake *wake, const double *p);
enum rc_wake_field {
    RC_WAKE_LAG,     /* (K - V) p                                     */
    RC_WAKE_REFLECT, /* G, which becomes i tan(d/2) (2 V p + G); at first it is 0 */
    RC_WAKE_SLOPE,   /* the part of the derivative of K p along |v| on which p does work */
    RC_WAKE_EVEN     /* V p                                           */
};
void rc_wake_field(struct rc_wake *wake, enum rc_wake_field field, double *u);
/* All waves of G: `n` numbers. */
double *rc_wake_waves(struct rc_wake *wake, size_t *n);

#endif
