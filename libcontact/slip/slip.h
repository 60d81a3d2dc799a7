/*
 * Functions shared by the files of this folder, besides the interface in contact.h. Internal: never
 * installed.
 */
#ifndef RC_SLIP_H
#define RC_SLIP_H

#include "discs.h"
#include "libcontact/model/row.h"

struct rc_slip;
/* The next increment starts from these tractions, Pa, instead of the last ones; call it before the force
 * is set. */
void rc_slip_start(struct rc_slip *slip, const double *const q[2]);
/* Reads or writes the history of the kept increments as numbers, and the tractions of the increment that is
 * being solved. After reading, the increment continues from these tractions. */
void rc_slip_history(struct rc_slip *slip, struct rc_state *state);
void rc_slip_increment(struct rc_slip *slip, struct rc_state *state);

/* Checks a problem of friction, and finds the shear of its bodies. */
enum rc_status rc_slip_check(const struct rc_shape *shape, const struct rc_slip_problem *p,
                             struct rc_shear *shear, struct rc_err *err);

/* Coefficients C11, C22, C23 of an ellipse: a/b, with a along x, and Poisson's ratio. NAN beyond 0.1 to 10, or
 * where nu is not in 0 to 0.5. */
void rc_kalker(double ratio, double nu, double c[3]);

/* The frames of friction and of rolling. */
enum {
    RC_SLIP_PRESSURE,
    RC_SLIP_TRACTION_X,
    RC_SLIP_TRACTION_Y,
    RC_SLIP_SLIP_X,
    RC_SLIP_SLIP_Y,
    RC_SLIP_STATE
};
/* clang-format off */
#define RC_SLIP_FRAME_KINDS(unit, per)                                                             \
    [RC_SLIP_PRESSURE] = {"pressure", "Pa", "Pressure"},                                           \
    [RC_SLIP_TRACTION_X] = {"traction-x", "Pa", "Traction along x"},                               \
    [RC_SLIP_TRACTION_Y] = {"traction-y", "Pa", "Traction along y"},                               \
    [RC_SLIP_SLIP_X] = {"slip-x", unit, "Slip along x" per},                                       \
    [RC_SLIP_SLIP_Y] = {"slip-y", unit, "Slip along y" per},                                       \
    [RC_SLIP_STATE] = {"state", "1", "State"}
/* clang-format on */

/* ---- increments.c ---- */

/* The number of increments of a way with half (1) or a quarter (2) of them. */
size_t rc_leg_fewer(const struct rc_leg *leg, size_t halvings);
/* The part of a leg at which increment k of n ends. */
double rc_leg_part(const struct rc_leg *leg, size_t k, size_t n);
/* The error of the increments at the end of a leg, as a sum over the map, Pa; NAN: unknown. before: the error
 * at its start. d: distance between the tractions with all increments and with half of them. d2: the same
 * with half and with a quarter. lagged: the growth of the first distance, as a vector, on this leg. */
double rc_leg_error(const struct rc_leg *leg, double before, double d, double d2, double lagged);

#endif
