/*
 * Figures as people publish them: a map with axes, colour bar, title and legend, or, of a map with
 * one row or column, a curve. Lengths on the two axes of a map have the same scale unless that
 * would leave a strip too thin to see (FIGURE_ASPECT); the figure then says so.
 */
#ifndef RC_FIGURE_H
#define RC_FIGURE_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/grid.h"
#include "canvas.h"
#include "colormap.h"

enum {
    FIGURE_ASPECT = 12, /* longest side of a plot over its shortest                      */
    FIGURE_NARROW = 320,
    FIGURE_WIDE = 16000, /* bounds of a width that is asked for, pixels                  */
};

struct figure {
    const char *title;         /* large, over everything                                */
    const char *subtitle;      /* under it; lines break at " · "                        */
    const char *stamp;         /* a warning in a frame of its own; NULL: none            */
    const char *quantity;      /* what the values are: "Gap"                            */
    const char *unit;          /* of the values, as in a stream                         */
    const char *across, *down; /* what the axes are: "x", "y", "depth"                  */
    double left, right;        /* metres, the outer edges of the map: left < right      */
    double top, bottom;        /* the same downwards: top < bottom                      */
    const double *row_edge;    /* metres, ny + 1 rising numbers; NULL: even rows        */
    const struct colormap *map;
    double lo, hi;     /* values at the ends of the colour bar, lo < hi         */
    double min, max;   /* of the values there are: the bar gets a point where
                                   they go on beyond its end                             */
    size_t missing;    /* nodes that are NaN                                    */
    size_t nodes;      /* of so many; 0: those of the map                       */
    bool zero_is_none; /* value 0 means no contact                              */
    size_t zeros;      /* nodes of that value                                   */
    bool contour;      /* lines at the marks of the bar, and the contact's edge */
    bool hillshade;    /* with light and shadow                                 */
    size_t width;      /* pixels of the whole figure; 0: what suits the map     */
};

/* The grid holds values, nx and ny; *figure says where they lie. NULL when memory is short. */
struct canvas *figure_draw(const struct figure *figure, const struct rc_grid *grid,
                           struct rc_err *err);

#endif
