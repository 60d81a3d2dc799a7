/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the files that make surfaces. Internal: never installed. */
#ifndef RC_SYNTH_H
#define RC_SYNTH_H

#include "libcontact/contact.h"

/* Cosine and sine of an angle in degrees, exact at right angles. */
void rc_synth_direction(double degrees, double *c, double *s);
/* True if the wanted heights are not Gaussian. */
bool rc_heights_skewed(const struct rc_selfaffine *what);
/* RC_FAIL when what->skewness or what->weibull is out of range, or both are given. */
enum rc_status rc_heights_check(const struct rc_selfaffine *what, struct rc_err *err);
/* Gives the heights of a periodic surface the wanted distribution, with mean 0 and RMS 1, in this number of
 * steps. The amplitudes of its waves stay near the original ones: *misfit is the RMS error of the amplitudes
 * over their RMS. RC_FAIL when memory is short. */
enum rc_status rc_heights_shape(const struct rc_shape *shape, const struct rc_selfaffine *what,
                                size_t steps, double *h, double *misfit, struct rc_err *err);

#endif
