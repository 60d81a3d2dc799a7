/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The interface of this folder: the shapes of rc-synth. */
#ifndef RC_SYNTH_SHAPES_H
#define RC_SYNTH_SHAPES_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

/* The command line; NAN and n = 0 if not given. */
struct synth_args {
    size_t nx, ny;
    double dx, dy;
    const char *like;
    struct numbers radius, place;
    double direction, slope, height, edge, amplitude;
    struct numbers wavelength;
    double hurst, rms_slope, rms_height, rolloff, short_cut, long_cut;
    double anisotropy, skewness, weibull;
    size_t seed;
};

/* The rows of the map on this process, and their heights. */
struct synth_map {
    struct tool *tool;
    const struct rc_shape *shape; /* of the whole map */
    size_t first, rows;
    double *h;
    bool periodic; /* the surface continues across the edges of the map */
};

struct synth_shape {
    const char *name;
    const char *needs[4], *takes[12]; /* options, ended by NULL                     */
    size_t radii;                     /* numbers of --radius; 0: none               */
    /* NULL, or ends the tool when options contradict each other or do not suit the grid. */
    void (*check)(struct tool *tool, const struct synth_args *args, const struct rc_shape *shape);
    enum rc_status (*make)(const struct synth_args *args, struct synth_map *map,
                           struct rc_err *err);
};

/* The last row has no name. */
extern const struct synth_shape synth_shapes[];

#endif
