/* What the files that make surfaces share. Internal: never installed. */
#ifndef RC_SYNTH_H
#define RC_SYNTH_H

#include "libcontact/contact.h"

/* Whether the heights asked for are other than Gaussian. */
bool rc_heights_skewed(const struct rc_selfaffine *what);
/* RC_FAIL when what->skewness or what->weibull is out of bounds, or both are given. */
enum rc_status rc_heights_check(const struct rc_selfaffine *what, struct rc_err *err);
/* Gives the heights of a periodic surface the distribution asked for, with mean 0 and RMS 1, in so
 * many steps, and its waves amplitudes near to those that they had: *misfit is the RMS error of the
 * amplitudes over their RMS. RC_FAIL when memory is short. */
enum rc_status rc_heights_shape(const struct rc_shape *shape, const struct rc_selfaffine *what,
                                size_t steps, double *h, double *misfit, struct rc_err *err);

#endif
