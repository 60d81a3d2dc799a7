/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scattered points on a raster: its axes from their positions. */
#ifndef RC_CORE_RASTER_H
#define RC_CORE_RASTER_H

#include "file.h"

struct rc_raster_axis {
    double first, step;
    size_t n;
    size_t empty; /* its nodes without a point */
};

/* The axis with the name 'x' or 'y' of a raster. sorted[0..points) are the positions of its points,
 * rising. They may be rounded, and some nodes may have no point. RC_FAIL for positions that lie near no
 * evenly spaced ones. */
enum rc_status rc_raster_axis(char name, const double *sorted, size_t points,
                              struct rc_raster_axis *axis, struct rc_err *err);
/* The node of a position. */
size_t rc_raster_node(const struct rc_raster_axis *axis, double position);
/* Explains why points x[k], y[k] are on no raster: sets the error to the angle by which it is turned, or
 * to its deviation. Without a raster nearby the error stays as it is. Always RC_FAIL. */
enum rc_status rc_raster_explain(const double *x, const double *y, size_t points,
                                 struct rc_err *err);

#endif
