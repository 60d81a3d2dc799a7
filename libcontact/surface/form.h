/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Forms that are removed from a surface. Internal: never installed.
 */
#ifndef RC_FORM_H
#define RC_FORM_H

#include "libcontact/contact.h"

/* Finds the smallest box with all measured points, columns left to right and rows top to bottom. Also finds
 * the number of these points, and how many of them are infinite. */
struct rc_box {
    size_t left, right, top, bottom, count, infinite;
};
struct rc_box rc_box_of(const struct rc_shape *shape, const double *h);
/* The same piece by piece: adds n rows from row `first` on to a box that began as rc_box_none. */
struct rc_box rc_box_none(const struct rc_shape *shape);
void rc_box_add(struct rc_box *box, size_t nx, size_t first, size_t n, const double *h);

/* rc_detrend_form for a sphere and a cylinder, on a profile a circle. */
enum rc_status rc_detrend_round(const struct rc_shape *shape, const struct rc_form *form, double *h,
                                double *radius, struct rc_err *err);

#endif
