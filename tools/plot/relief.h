/*
 * A map as a lit surface in a box, seen from above at an angle, without perspective: what lies
 * behind something higher is hidden.
 */
#ifndef RC_RELIEF_H
#define RC_RELIEF_H

#include "figure.h"

struct view {
    double azimuth;   /* degrees: where the viewer stands, from the lower edge of the map (0)
                         counterclockwise to its right edge (90) */
    double elevation; /* degrees above the map: 0 < elevation <= 90 */
    bool peaks;       /* nodes that share a piece of a reduced map give it the largest of their
                         values, not the mean */
};

enum {
    RELIEF_SIDE = 1000, /* pieces a side at most */
    RELIEF_WIDTH = 1200 /* pixels where the figure asks for none */
};

/* Where values are lengths, the scale upwards over that across: 1, 2 or 5 times a power of ten. */
/* Whether heights and places are both lengths: then z is drawn that many times too high. */
bool relief_to_scale(const struct figure *figure);
double relief_exaggeration(const struct figure *figure);
/* lo and hi of the figure are the bottom and the top of the box. NULL when memory is short. */
struct canvas *relief_draw(const struct figure *figure, const struct view *view,
                           const struct rc_grid *grid, struct rc_err *err);

#endif
