/*
 * A smooth function of a positive number, tabulated as polynomials on even pieces of each octave, so that
 * looking it up takes no logarithm. Internal: never installed.
 */
#ifndef RC_OCTAVES_H
#define RC_OCTAVES_H

#include "libcontact/common.h"

struct rc_octaves;
/* The function itself. */
typedef double rc_octaves_of(const void *ctx, double x);

/* From `first` to `last`, both > 0. It has to be about as smooth as a power of x: then values are right to
 * 1e-12 of the largest in the octave. ctx stays the caller's and outlives it. NULL when memory is short. */
struct rc_octaves *rc_octaves_new(double first, double last, rc_octaves_of *f, const void *ctx);
void rc_octaves_free(struct rc_octaves *octaves); /* NULL is allowed */
/* At n numbers x >= 0; outside the table the function is called. */
void rc_octaves_values(const struct rc_octaves *octaves, size_t n, const double *x, double *out);

#endif
