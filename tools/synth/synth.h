/* The face of this folder: the shapes of rc-synth. */
#ifndef RC_SYNTH_SHAPES_H
#define RC_SYNTH_SHAPES_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

/* The command line; NAN and n = 0 where nothing was given. */
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

struct synth_shape {
    const char *name;
    const char *needs[4], *takes[12]; /* options, ended by NULL                               */
    size_t maps; /* arrays of the map's size that it takes to make it                         */
    /* NULL, or ends the tool when options contradict each other or the grid. */
    void (*check)(struct tool *tool, const struct synth_args *args, const struct rc_shape *shape);
    /* Sets *periodic where the surface goes on when the map is repeated. */
    enum rc_status (*make)(const struct synth_args *args, const struct rc_shape *shape, double *h,
                           bool *periodic, struct rc_err *err);
};

/* Ended by a row without a name. */
extern const struct synth_shape synth_shapes[];

#endif
