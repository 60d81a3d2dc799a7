/*
 * What the files of this folder share beside the face, which is in contact.h. Internal: never installed.
 */
#ifndef RC_SLIP_H
#define RC_SLIP_H

#include "discs.h"
#include "libcontact/model/row.h"

struct rc_slip;
/* The next increment starts from these tractions, Pa, instead of from the last. Before its force is set. */
void rc_slip_start(struct rc_slip *slip, const double *const q[2]);
/* What the increments that were kept have left, as numbers. What is asked of the next one is not among
 * them. */
void rc_slip_history(struct rc_slip *slip, struct rc_state *state);
/* Copies maps of n values; the change over what there is now, in L1. */
double rc_slip_take(size_t n, int maps, const double *const v[], double *const to[]);
/* Passes that find pressure and tractions in turn: how far they are from their end, c/(1 - c) of the last
 * change where each is c times the one before. */
double rc_slip_left_over(size_t passes, double change, double before);

#endif
