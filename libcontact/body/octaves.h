/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A smooth function of a positive number, tabulated as polynomials on equal pieces of each octave, so that a
 * lookup takes no logarithm. Internal: never installed.
 */
#ifndef RC_OCTAVES_H
#define RC_OCTAVES_H

#include "libcontact/common.h"

struct rc_octaves;
/* The function itself. */
typedef double rc_octaves_of(const void *ctx, double x);

/* A table from `first` to `last`, both > 0. The function must be about as smooth as a power of x; values are
 * then accurate to 1e-12 of the largest value in the octave. The caller owns ctx, which outlives the table.
 * NULL when memory is short. */
struct rc_octaves *rc_octaves_new(double first, double last, rc_octaves_of *f, const void *ctx);
void rc_octaves_free(struct rc_octaves *octaves); /* NULL is allowed */
RC_OWNER(rc_octaves)
/* At n numbers x >= 0; outside the table the function is called. */
void rc_octaves_values(const struct rc_octaves *octaves, size_t n, const double *x, double *out);

#endif
