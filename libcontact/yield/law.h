/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The yield law: von Mises with isotropic hardening. Internal: never installed.
 *
 * Tensors are symmetric and traceless: five numbers without zz = -xx - yy, with tensor shears.
 */
#ifndef RC_YIELD_LAW_H
#define RC_YIELD_LAW_H

#include <math.h>

#include "libcontact/contact.h"

enum {
    RC_DEVIATOR = 5 /* xx, yy, xy, xz, yz */
};

/* a : b */
static inline double
rc_deviator_product(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + (a[0] + a[1]) * (b[0] + b[1]) +
           2 * (a[2] * b[2] + a[3] * b[3] + a[4] * b[4]);
}

/* The Mises stress of a stress deviator; 2/3 of it is the equivalent of a plastic strain. */
static inline double
rc_mises_of(const double *s)
{
    return sqrt(1.5 * rc_deviator_product(s, s));
}

enum rc_status rc_yield_law_check(const struct rc_yield_law *law, struct rc_err *err);
/* The plastic work from 0 to this strain, J/m^3: the integral of the yield stress. */
double rc_yield_law_work(const struct rc_yield_law *law, double strain);
/* The growth of the equivalent strain that returns a Mises stress to the yield stress. The stress falls by
 * `stiffness` (3 mu) per strain. 0 if the stress does not yield. */
double rc_yield_law_return(const struct rc_yield_law *law, double stiffness, double strain,
                           double mises);

#endif
