/*
 * The face of this folder is in contact.h; here is what its files share. Internal: never installed.
 */
#ifndef RC_ADHESION_H
#define RC_ADHESION_H

#include "gap.h"
#include "law.h"
#include "retraction.h"

/* What a path has of its earlier states, beside its pressure and its approach, m, from which it can start
 * again (rc_adhesion_start). */
struct rc_adhesion_past {
    double
        dents[2]; /* error of their dents relative to the pressures, and times the sum of these */
    bool begun;   /* there was a state */
};
struct rc_adhesion_past *rc_adhesion_past(struct rc_adhesion *a);
double rc_adhesion_approach(const struct rc_adhesion *a);
/* As rc_adhesion_set_heights, for heights that are those of the undeformed bodies plus `dent`. */
enum rc_status rc_adhesion_set_dented(struct rc_adhesion *a, const double *h, const double *dent,
                                      struct rc_err *err);

#endif
