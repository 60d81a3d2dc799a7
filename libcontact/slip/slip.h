/*
 * What the files of this folder share beside the face, which is in contact.h. Internal: never installed.
 */
#ifndef RC_SLIP_H
#define RC_SLIP_H

#include "discs.h"

struct rc_slip;
/* The next increment starts from these tractions, Pa, instead of from the last. Before its force is set. */
void rc_slip_start(struct rc_slip *slip, const double *const q[2]);

#endif
