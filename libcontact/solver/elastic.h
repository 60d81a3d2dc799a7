/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The elastic model for an outer model that solves another contact by a sequence of elastic ones on its own
 * heights (viscoelastic/sliding.c). Between two contacts the pressure stays, and the outer model has it
 * judged with other heights without a convolution. Pressures are in Pa, displacements and heights in m, n
 * numbers.
 */
#ifndef RC_ELASTIC_H
#define RC_ELASTIC_H

#include "libcontact/operator/operator.h"

/* rc_elastic_new with a compliance that differs along x (NULL: it does not). The caller keeps `along` as long
 * as the model. */
struct rc_model *rc_elastic_new_along(const struct rc_shape *shape, const double *h,
                                      const struct rc_problem *problem,
                                      const struct rc_along *along, struct rc_err *err);

/* Heights, and the wanted approach from their first touch; 0: the load is given. */
struct rc_elastic_heights {
    const double *h;
    double approach;
};

const double *rc_elastic_pressure(const struct rc_model *m);
/* The highest node of the present heights. */
double rc_elastic_top(const struct rc_model *m);
/* m/Pa: displacement of a node under unit pressure on its own cell; 0 before the first contact. */
double rc_elastic_own(const struct rc_model *m);
/* RC_FAIL for an approach, m, at which the contact of these heights is complete; RC_OK before the first
 * contact. For an outer model whose contacts have other heights and approaches. */
enum rc_status rc_elastic_reach(const struct rc_model *m, const double *h, double approach,
                                struct rc_err *err);
/* u = K p as the iteration follows it, or the same added to u. */
void rc_elastic_displacement(const struct rc_model *m, bool add, double *u);
/* The same by a fresh convolution in double precision or, not `fresh`, as the iteration follows it, in a map
 * of the model. It stays until rc_elastic_judge, which must be the next call. */
const double *rc_elastic_hold(struct rc_model *m, bool fresh);
/* Convolutions so far, in equivalents, and iterations; new heights set both to 0. */
double rc_elastic_work(const struct rc_model *m, size_t *iterations);

/* The model gets these heights and this tolerance, and keeps the pressure and the held displacement. *error:
 * the estimated relative L1 error of the pressure as that of the elastic contact with these heights. */
enum rc_status rc_elastic_judge(struct rc_model *m, const struct rc_elastic_heights *to, double tol,
                                double *error, struct rc_err *err);
/* The pressure judged last is the solution, with this error. False if the approach is not yet reached. */
bool rc_elastic_reached(const struct rc_model *m);
void rc_elastic_conclude(struct rc_model *m, double error);
/* The next steps solve the contact with these heights, from the present pressure. `rough`: its tolerance
 * permits single precision. */
enum rc_status rc_elastic_resume(struct rc_model *m, const struct rc_elastic_heights *to,
                                 double tol, bool rough, struct rc_err *err);
void rc_elastic_set_rough(struct rc_model *m, bool rough);

#endif
