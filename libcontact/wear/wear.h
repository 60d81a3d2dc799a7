/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the two models of wear share: the same points stay in contact or a track passes (wear.c), or two rough
 * bodies slide over each other (two_bodies.c). */
#ifndef RC_WEAR_H
#define RC_WEAR_H

#include "libcontact/model/row.h"

enum {
    RC_WEAR_GAP,
    RC_WEAR_HEIGHT,
    RC_WEAR_BOTH,
    RC_WEAR_1,
    RC_WEAR_2
};
extern const struct rc_frame_kind rc_wear_frames[];

/* Checks the law for the map of the model, and sets its tolerance if that is 0. */
enum rc_status rc_wear_check(const struct rc_model *m, struct rc_wear_problem *law,
                             struct rc_err *err);
/* Refuses a next point of the model without a load. */
enum rc_status rc_wear_check_point(const struct rc_model *m, struct rc_err *err);
/* The point for the inner model after the sliding distance s. Between two points the load changes in
 * proportion to the distance. */
struct rc_point rc_wear_load(const struct rc_model *m, double s);
/* m: the first step. */
double rc_wear_first_step(const struct rc_wear_problem *law, const struct rc_shape *s);
/* The standard deviation of the pressure in contact over its mean. */
double rc_wear_spread(const struct rc_ranks *ranks, const double *p, size_t n);

struct rc_model *rc_wear_two_bodies_new(struct rc_model *inner, const double *h,
                                        const struct rc_wear_problem *law, struct rc_err *err);

#endif
