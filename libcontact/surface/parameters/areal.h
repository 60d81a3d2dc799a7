/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The parts of an areal description. Each function sets its own fields. Internal: never installed.
 */
#ifndef RC_SURFACE_AREAL_H
#define RC_SURFACE_AREAL_H

#include "libcontact/common.h"

/* A map and its figures that all parts need. */
struct rc_relief {
    struct rc_shape shape;
    const double *h;
    struct rc_boundary boundary;
    int threads;
    size_t there; /* measured: finite */
    double mean, minimum, maximum;
};

/* material_ratio.c: sk to sxp. RC_FAIL when memory is short. */
enum rc_status rc_material_ratio(const struct rc_relief *relief, struct rc_areal *areal,
                                 struct rc_err *err);

/* texture.c: sal, str, std, where they are defined. RC_FAIL as in rc_areal. */
enum rc_status rc_texture(const struct rc_relief *relief, struct rc_areal *areal,
                          struct rc_err *err);

/* spectrum.c: a map times a window along each side, after its windowed mean is subtracted. A map that repeats
 * along one axis has none along this axis. Missing values are 0. */
struct rc_windowed {
    const struct rc_shape *shape;
    const double *h;
    const struct rc_window *window;
    struct rc_boundary boundary;
    double *wx;  /* nx numbers: the weights along x, from rc_windowed_lay */
    double mean; /* the windowed mean, likewise                           */
};
extern const struct rc_window *const rc_window_hann;
/* Lays the window on the map; returns the mean square of the heights about `mean`, their plain mean. */
double rc_windowed_lay(struct rc_windowed *w, double mean);
/* Row j, for rc_power. */
void rc_windowed_row(const void *windowed, size_t j, double *row);

#endif
