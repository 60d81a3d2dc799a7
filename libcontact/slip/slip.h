/*
 * What the files of this folder share beside the interface in contact.h. Internal: never installed.
 */
#ifndef RC_SLIP_H
#define RC_SLIP_H

#include "discs.h"
#include "libcontact/model/row.h"

struct rc_slip;
/* The next increment starts from these tractions, Pa, instead of the last ones; call it before the force
 * is set. */
void rc_slip_start(struct rc_slip *slip, const double *const q[2]);
/* The history that the kept increments have left, as numbers; and the tractions of the increment that is
 * being solved, which continues from there when they were read. */
void rc_slip_history(struct rc_slip *slip, struct rc_state *state);
void rc_slip_increment(struct rc_slip *slip, struct rc_state *state);

/* ---- increments.c ---- */

/* Increments of a way with half (1) or a quarter (2) of them. */
size_t rc_leg_fewer(const struct rc_leg *leg, size_t halvings);
/* The part of a leg at which increment k of n ends. */
double rc_leg_part(const struct rc_leg *leg, size_t k, size_t n);
/* The error of the increments at the end of a leg, as a sum over the map, Pa; NAN: unknown. before: that
 * at its start. d, d2: distances of the tractions of all increments from those of half of them, and of
 * these from those of a quarter. lagged: by how much the first distance, as a vector, has grown on this
 * leg. */
double rc_leg_error(const struct rc_leg *leg, double before, double d, double d2, double lagged);

#endif
