/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A map as a lit surface in a box, seen obliquely from above, without perspective: parts behind higher ones
 * are hidden.
 */
#ifndef RC_RELIEF_H
#define RC_RELIEF_H

#include "figure.h"

struct view {
    double azimuth;   /* degrees: the azimuth of the viewer, from the lower edge of the map (0)
                         counterclockwise to its right edge (90) */
    double elevation; /* degrees above the map: 0 < elevation <= 90 */
    bool peaks;       /* a piece of a reduced map has the largest value of its nodes, not the
                         mean */
};

enum {
    RELIEF_SIDE = 1000, /* most pieces along a side */
    RELIEF_WIDTH = 1200 /* default width in pixels */
};

/* For values that are lengths, the vertical scale over the horizontal one: 1, 2 or 5 times a power of ten. */
/* True if heights and positions are both lengths: then z is exaggerated by this factor. */
bool relief_to_scale(const struct figure *figure);
double relief_exaggeration(const struct figure *figure);
/* The box reaches from lo to hi of the figure. NULL when memory is short. */
struct canvas *relief_draw(const struct figure *figure, const struct view *view,
                           const struct rc_grid *grid, struct rc_err *err);

#endif
