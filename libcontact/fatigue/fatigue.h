/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Criteria of the stress histories of material points. Internal: never installed.
 */
#ifndef RC_FATIGUE_H
#define RC_FATIGUE_H

#include "libcontact/common.h"
#include "libcontact/memory.h"

/* ---- ball.c ---- */

enum {
    RC_BALL_MOST = 5 /* dimensions */
};
struct rc_ball {
    double centre[RC_BALL_MOST], radius;
    size_t passes; /* over all points */
};
/* The smallest ball about n > 0 points x[k][t], k < dim (2 or 5), whose centre has only its first `free`
 * coordinates different from 0. room: n squared distances of the points from the centre. */
struct rc_ball rc_ball_about(size_t dim, size_t free, size_t n, const double *const *x,
                             double *room);

/* ---- criteria.c ---- */

/* Constants of the criteria for these limits. */
struct rc_fatigue_rule {
    unsigned wanted; /* bits of enum rc_criterion */
    bool full;       /* Dang Van: hydrostatic pressure lowers the index  */
    double k[RC_CRITERIA], limit[RC_CRITERIA];
};
struct rc_fatigue_rule rc_fatigue_rule_of(unsigned wanted, bool full,
                                          const struct rc_fatigue_limits *limits);

/* A history of n states, and room for the work on it. */
struct rc_history {
    size_t n;
    double *s[RC_COMPONENTS];
    double *x[RC_BALL_MOST], *h; /* deviator, whose square is J2; hydrostatic stress */
    double *u, *v, *room;
};
/* For at most so many states, in memory of `own`; NULL when that is short. */
struct rc_history *rc_history_new(struct rc_store *own, size_t most);

struct rc_fatigue_values {
    double of[RC_FATIGUES];
    double least, largest; /* hydrostatic stress, Pa                          */
    double decides;        /* hydrostatic stress at the instant that decides for Dang Van, Pa */
};
void rc_history_values(struct rc_history *history, const struct rc_fatigue_rule *rule,
                       struct rc_fatigue_values *values);

#endif
