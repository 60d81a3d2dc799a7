/*
 * Functions shared by the files of this folder. Its interface is in contact.h. Internal: never installed.
 */
#ifndef RC_ADHESION_H
#define RC_ADHESION_H

#include "gap.h"
#include "law.h"
#include "retraction.h"

/* What a path keeps from earlier states in addition to pressure and approach (m), so that it can start again
 * (rc_adhesion_start). */
struct rc_adhesion_past {
    double dents[2]; /* error of their dents relative to the pressures; this error times the sum of
                        the pressures */
    bool begun;      /* there was a state */
};
struct rc_adhesion_past *rc_adhesion_past(struct rc_adhesion *a);
double rc_adhesion_approach(const struct rc_adhesion *a);
/* Does the same as rc_adhesion_set_heights, for heights of undeformed bodies plus `dent`. */
enum rc_status rc_adhesion_set_dented(struct rc_adhesion *a, const double *h, const double *dent,
                                      struct rc_err *err);

#endif
