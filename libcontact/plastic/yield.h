/*
 * How a material yields: von Mises, with isotropic hardening. Internal: never installed.
 *
 * Tensors are symmetric and without trace: five numbers, of which zz = -xx - yy is left out, shears those
 * of the tensor.
 */
#ifndef RC_YIELD_H
#define RC_YIELD_H

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

/* Mises' equivalent of a stress; of a plastic strain 2/3 of this. */
static inline double
rc_mises_of(const double *s)
{
    return sqrt(1.5 * rc_deviator_product(s, s));
}

enum rc_status rc_yield_check(const struct rc_yield *law, struct rc_err *err);
/* The work that hardening has taken from 0 to this strain, J/m^3: the integral of the yield stress. */
double rc_yield_work(const struct rc_yield *law, double strain);
/* The growth of the equivalent strain that takes a Mises stress back to the yield stress, which it lowers
 * by `stiffness` (3 mu) per strain: 0 where it does not yield. */
double rc_yield_return(const struct rc_yield *law, double stiffness, double strain, double mises);

#endif
