/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Functions shared by the files of this folder; models are in contact.h. Internal: never installed.
 */
#ifndef RC_FRICTION_H
#define RC_FRICTION_H

#include "discs.h"
#include "libcontact/model/row.h"

/* ---- slip.c: friction in a contact with a given pressure, increment by increment ---- */

struct rc_friction_solver;
/* NULL when the problem is invalid, or memory is short. The bodies start separated. */
struct rc_friction_solver *rc_friction_solver_new(const struct rc_shape *shape,
                                                  const struct rc_friction_law *problem,
                                                  struct rc_err *err);
/* A further history of the same bodies, with a tolerance of its own. It shares the operator and the iteration
 * with `main`, which is freed after it, and the work of an increment with all others that are made so. Their
 * increments must therefore be kept one after another: only tractions of kept increments remain. The
 * increment of `main` remains. */
struct rc_friction_solver *rc_friction_solver_beside(struct rc_friction_solver *main, double tol,
                                                     struct rc_err *err);
/* The pressure of this increment (nx ny Pa, copied; NULL: the bodies are apart) and its gap (nx ny m,
 * used until the increment is kept; NULL: unknown). A node that comes into contact in this increment
 * has moved with its body until then. With the gap before, this motion is known to first order, and
 * exactly for nu = 0 and force proportional to load (Jaeger 1998; Ciavarella 1998). Without a gap the
 * node keeps its position from before the increment. RC_FAIL when a pressure is negative or not finite. */
enum rc_status rc_friction_solver_set_pressure(struct rc_friction_solver *slip, const double *p,
                                               const double *gap, struct rc_err *err);
/* Force (N) or displacement (m) at the end of the increment, along x and y; call after its pressure is
 * set. RC_FAIL, with both numbers, when friction cannot carry the force (the bodies slide), or under a
 * displacement with a datum within the contact; the increment is then unchanged. With a displacement,
 * nodes that come into contact start as without a gap. Separated bodies have no history: slip and
 * displacement are 0, and count from the next touch. */
enum rc_status rc_friction_solver_set_force(struct rc_friction_solver *slip, double fx, double fy,
                                            struct rc_err *err);
enum rc_status rc_friction_solver_set_displacement(struct rc_friction_solver *slip, double dx,
                                                   double dy, struct rc_err *err);
/* One step, of 7 to 12 convolutions. It returns RC_MORE, RC_OK when the estimated error is below tol, or
 * RC_SHORT when rounding prevents this. It returns RC_FAIL when no force or displacement is set, or memory is
 * short. */
enum rc_status rc_friction_solver_step(struct rc_friction_solver *slip, struct rc_err *err);
void rc_friction_solver_result(struct rc_friction_solver *slip,
                               struct rc_friction_increment *figures);
/* Makes the increment history, on which the next one builds. Before this, pressure and force may be set
 * again. */
void rc_friction_solver_keep(struct rc_friction_solver *slip);
/* Tractions, Pa, nx ny, along x (0) or y (1), valid until the next step. Slip since first touch, m, including
 * this increment; it is 0 out of contact. */
const double *rc_friction_solver_traction(const struct rc_friction_solver *slip, int direction);
/* The tractions of the last kept increment. */
const double *rc_friction_solver_kept(const struct rc_friction_solver *slip, int direction);
void rc_friction_solver_slip(const struct rc_friction_solver *slip, int direction, double *to);
/* m: the largest slip of a node since the bodies touched. */
double rc_friction_solver_largest_slip(const struct rc_friction_solver *slip);
/* So far, with all solvers beside it, in equivalents of a single map in double precision. */
double rc_friction_solver_convolutions(const struct rc_friction_solver *slip);
/* nx ny: 0 where no load is carried, 1 where a node sticks, 2 where it slips. */
void rc_friction_solver_state(const struct rc_friction_solver *slip, double *to);
/* Normal displacement due to the tractions, nx ny m, into the bodies; it is 0 for identical bodies.
 * Subtracted from the heights, it gives the contact under these tractions. */
void rc_friction_solver_normal(struct rc_friction_solver *slip, double *uz);
void rc_friction_solver_free(struct rc_friction_solver *slip); /* NULL is allowed */
RC_OWNER(rc_friction_solver)
/* The next increment starts from these tractions, Pa, instead of the last ones; call it before the force
 * is set. */
void rc_friction_solver_start(struct rc_friction_solver *slip, const double *const q[2]);
/* Adds the energy that friction dissipates in this increment, J/m2 at each node. */
void rc_friction_solver_add_dissipation(const struct rc_friction_solver *slip, double *to);
/* Reads or writes the history of the kept increments as numbers, and the tractions of the increment that is
 * being solved. After reading, the increment continues from these tractions. */
void rc_friction_solver_history(struct rc_friction_solver *slip, struct rc_state *state);
void rc_friction_solver_increment(struct rc_friction_solver *slip, struct rc_state *state);

/* Checks a problem of friction, and finds the shear of its bodies. */
enum rc_status rc_friction_solver_check(const struct rc_shape *shape,
                                        const struct rc_friction_law *p, struct rc_shear *shear,
                                        struct rc_err *err);

/* Coefficients C11, C22, C23 of an ellipse: a/b, with a along x, and Poisson's ratio. NAN beyond 0.1 to 10,
 * or where nu is not in 0 to 0.5. */
void rc_kalker(double ratio, double nu, double c[3]);
/* Kalker's simplified theory: the force, N, on body 1 of the ellipse with the semi-axes axis[], m,
 * along x and y, whose coefficients are c[]. The contact rolls towards +x; g: shear modulus, Pa; limit:
 * the largest force; creep and spin as in contact.h. */
void rc_fastsim(const double axis[2], double g, const double c[3], double limit,
                const double creep[2], double spin, double force[2]);

/* The frames of friction and of rolling. */
enum {
    RC_SLIP_PRESSURE,
    RC_SLIP_TRACTION_X,
    RC_SLIP_TRACTION_Y,
    RC_SLIP_SLIP_X,
    RC_SLIP_SLIP_Y,
    RC_SLIP_STATE,
    RC_SLIP_TRACTION,
    RC_SLIP_DISSIPATION,
    RC_SLIP_LENGTH /* of rolling only */
};
/* clang-format off */
#define RC_SLIP_FRAME_KINDS(unit, per)                                                             \
    [RC_SLIP_PRESSURE] = {"pressure", "Pa", "Pressure"},                                           \
    [RC_SLIP_TRACTION_X] = {"traction-x", "Pa", "Traction along x"},                               \
    [RC_SLIP_TRACTION_Y] = {"traction-y", "Pa", "Traction along y"},                               \
    [RC_SLIP_SLIP_X] = {"slip-x", unit, "Slip along x" per},                                       \
    [RC_SLIP_SLIP_Y] = {"slip-y", unit, "Slip along y" per},                                       \
    [RC_SLIP_STATE] = {"state", "1", "State"},                                                     \
    [RC_SLIP_TRACTION] = {"traction", "Pa", "Traction"}
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
