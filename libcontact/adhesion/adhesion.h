/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Functions shared by the files of this folder; its model is in contact.h. Internal: never installed.
 */
#ifndef RC_ADHESION_H
#define RC_ADHESION_H

#include "gap.h"
#include "law.h"
#include "retraction.h"

struct rc_adhesion_solver;

/* What a path keeps from earlier states in addition to pressure and approach (m), so that it can start again
 * (rc_adhesion_solver_start). */
struct rc_adhesion_solver_past {
    double dents[2]; /* error of their dents relative to the pressures; this error times the sum of
                        the pressures */
    bool begun;      /* there was a state */
    bool separated;  /* the bodies are apart in the last one */
};
struct rc_adhesion_solver_past *rc_adhesion_solver_past(struct rc_adhesion_solver *a);
double rc_adhesion_solver_approach(const struct rc_adhesion_solver *a);

/* sigma, Pa, at the gaps of a map, m. Fails as rc_adhesion_check. */
enum rc_status rc_adhesion_attraction(const struct rc_shape *shape,
                                      const struct rc_adhesion_problem *problem, const double *gap,
                                      double *sigma, struct rc_err *err);

/* ---- a path of states ---- */

/* h: nx ny m, copied. NULL when the problem is invalid, when the engine or method does not suit it, or memory
 * is short. The path starts with undeformed bodies. Among ranks maps are the rows held here, and all ranks
 * call every function; of `progress` each rank has the same. */
struct rc_adhesion_solver *rc_adhesion_solver_new(const struct rc_shape *shape, const double *h,
                                                  const struct rc_adhesion_problem *problem,
                                                  struct rc_err *err);
/* The next state of the path has this load, N, of either sign. Under a tensile load it is the next stable
 * state of lower energy, if there is one: see `separated`. */
enum rc_status rc_adhesion_solver_set_load(struct rc_adhesion_solver *a, double load,
                                           struct rc_err *err);
/* The next state of the path has this approach, m, 0 at first touch, negative apart; with this control a
 * state always exists. RC_FAIL on a periodic map where the mean gap would not be positive. */
enum rc_status rc_adhesion_solver_set_approach(struct rc_adhesion_solver *a, double approach,
                                               struct rc_err *err);
/* Retracts the bodies from the present state, approach by approach, until they separate, and finds the lowest
 * load on the way. RC_FAIL when there is no state yet, or memory for three states is short. */
enum rc_status rc_adhesion_solver_pull_off(struct rc_adhesion_solver *a, struct rc_err *err);
/* Sets the state of the path to this pressure (nx ny Pa, net) and approach, m, of an earlier object of the
 * same problem. The next state starts there. RC_FAIL when a value is not finite. */
enum rc_status rc_adhesion_solver_start(struct rc_adhesion_solver *a, const double *pressure,
                                        double approach, struct rc_err *err);
/* Other heights (nx ny m, copied), which include the dents (NULL: none): the next state starts with the
 * displacement of the last one, and its load or approach must be set. RC_FAIL when one is not a finite
 * number, which leaves all as it was. */
enum rc_status rc_adhesion_solver_set_heights(struct rc_adhesion_solver *a, const double *h,
                                              const double *dent, struct rc_err *err);
/* One step of the gap, or of the eigenvector. RC_MORE until the state is found, then RC_OK. RC_SHORT if it
 * stopped short of tol or the bodies separate. RC_FAIL when no load or approach is set. */
enum rc_status rc_adhesion_solver_step(struct rc_adhesion_solver *a, struct rc_err *err);
struct rc_adhesion_solver_progress {
    size_t state;        /* number of the state of a retraction, from 1 */
    size_t iterations;   /* iterations of this state                                     */
    bool eigenvalue;     /* iterations of its stability                                  */
    bool coarser;        /* the first state starts on a coarser grid, without a pressure yet */
    double load;         /* N, as set; NAN: an approach was set                          */
    double approach;     /* m, as set, also in a retraction; NAN: a load was set         */
    double error, tol;   /* estimated error of the pressure, NAN at first; the asked one */
    double convolutions; /* for the state so far, as in rc_adhesion_state */
};
void rc_adhesion_solver_progress(const struct rc_adhesion_solver *a,
                                 struct rc_adhesion_solver_progress *progress);
/* Maps of the present state, valid until the next step; after a retraction, those of the state of lowest
 * load. rc_adhesion_solver_result ends a start on a coarser grid early. */
const struct rc_adhesion_state *rc_adhesion_solver_result(struct rc_adhesion_solver *a);
/* nx ny values each: net pressure, Pa; gap, m, never negative except at the hardness; displacement K p, m;
 * sigma, Pa. */
void rc_adhesion_solver_pressure(const struct rc_adhesion_solver *a, double *pressure);
void rc_adhesion_solver_gap(const struct rc_adhesion_solver *a, double *gap);
void rc_adhesion_solver_displacement(const struct rc_adhesion_solver *a, double *displacement);
void rc_adhesion_solver_traction(const struct rc_adhesion_solver *a, double *traction);
/* Elastic unloading where the hardness was reached. It subtracts the overlap from the heights of the path
 * from here on, and from h. h, nx ny m (or NULL), holds the first heights less the overlap that was
 * subtracted before. No effect if no node has yielded. rc_adhesion_solver_pull_off calls it first. */
void rc_adhesion_solver_keep_shape(struct rc_adhesion_solver *a, double *h);
void rc_adhesion_solver_free(struct rc_adhesion_solver *a); /* NULL is allowed */

#endif
