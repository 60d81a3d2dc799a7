/*
 * Forms that are taken off a surface. Internal: never installed.
 */
#ifndef RC_FORM_H
#define RC_FORM_H

#include "libcontact/contact.h"

/* Nodes i of left <= i <= right and rows j of top <= j <= bottom hold all the points that are
 * there, how many they are, and how many of them are infinite. */
struct rc_box {
    size_t left, right, top, bottom, count, infinite;
};
struct rc_box rc_box_of(const struct rc_shape *shape, const double *h);

/* rc_detrend_form for a sphere and a cylinder, on a profile a circle. */
enum rc_status rc_detrend_round(const struct rc_shape *shape, const struct rc_form *form, double *h,
                                double *radius, struct rc_err *err);

#endif
