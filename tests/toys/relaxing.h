/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A model that is not part of the library: a relaxing layer of springs on one of the bodies. */
#ifndef TOY_RELAXING_H
#define TOY_RELAXING_H

#include "libcontact/contact.h"

struct toy_relaxing {
    double compliance; /* m/Pa: final settlement over pressure                   */
    double tau;        /* s                                                      */
    double tol;        /* permitted error of a step, relative to the settlement  */
};
struct toy_figures {
    double time, mean_settlement, step_error;
    size_t steps, rejected;
};
/* Takes RC_TIME and the axes of `inner`, which must have RC_LOAD; h: the heights of `inner`. It owns the
 * inner model. */
struct rc_model *toy_relaxing_new(struct rc_model *inner, const double *h,
                                  const struct toy_relaxing *law, struct rc_err *err);

#endif
