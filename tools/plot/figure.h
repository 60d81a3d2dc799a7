/*
 * Figures as people publish them: a map with axes, colour bar, title and legend. Lengths on the two axes of
 * a map have the same scale unless that would leave a strip too thin to see (FIGURE_ASPECT); the figure
 * then says so.
 */
#ifndef RC_FIGURE_H
#define RC_FIGURE_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/grid.h"
#include "tools/canvas/canvas.h"

#define FIGURE_PI 3.14159265358979323846

enum {
    FIGURE_ASPECT = 12, /* longest side of a plot over its shortest                      */
    FIGURE_NARROW = 320,
    FIGURE_POINTS = 7,   /* of the text at the marks, where the size on paper counts           */
    FIGURE_WIDE = 16000, /* bounds of a width that is asked for, pixels                  */
};

/* What lies between two depths of a section. */
struct medium {
    double bottom;  /* m; INFINITY: the last */
    char text[128]; /* of the legend        */
};

struct figure {
    const char *title;         /* large, over everything                                */
    const char *subtitle;      /* under it; lines break at " · "                        */
    const char *stamp;         /* a warning in a frame of its own; NULL: none            */
    const char *quantity;      /* what the values are: "Gap"                            */
    const char *unit;          /* of the values, as in a stream                         */
    const char *across, *down; /* what the axes are: "x", "y", "depth"                  */
    const char *dunit;         /* of the axes; NULL: m                                  */
    double left, right;        /* the outer edges of the map in that unit: left < right */
    double top, bottom;        /* the same downwards: top < bottom                      */
    bool section;              /* y is depth: its axis has a unit of its own            */
    const char *largest;       /* a cross at (x, y), and this in the legend; NULL: none */
    double largest_x, largest_y;
    struct medium *medium; /* of a section, the top first, with lines between them; NULL: one */
    size_t media;
    const char *circle;             /* dashes about the origin, and this in the legend; NULL */
    double radius;                  /* metres                                                */
    const struct rc_grid *contact;  /* on the same grid: `contour` has its edge; NULL: unknown */
    const struct rc_grid *pressure; /* on the same grid; NULL: unknown                       */
    double hard;   /* some of these reach it, and have a line about them; 0: none */
    bool keep_max; /* a reduced map keeps the largest value of each pixel   */
    const struct colormap *map;
    double lo, hi;          /* values at the ends of the colour bar, lo < hi         */
    bool log;               /* the colours go by the logarithm; 0 < lo               */
    const char *note;       /* on the colours, in the legend; NULL: none             */
    double min, max;        /* of the values there are: the bar gets a point where
                                   they go on beyond its end                             */
    size_t missing;         /* nodes that are NaN                                    */
    size_t nodes;           /* of so many; 0: those of the map                       */
    bool zero_is_none;      /* value 0 has no colour of the bar                      */
    size_t zeros;           /* nodes of that value                                   */
    const char *none;       /* what it means: "no contact"                           */
    const char *const *is;  /* what values 1 and 2 mean (NULL: none has it): categories, which have
                               a legend in place of the bar; NULL: values           */
    const char *missing_is; /* what missing nodes are; NULL: not measured        */
    bool contour;           /* lines at the marks of the bar, and the contact's edge */
    bool border;            /* of these the contact's edge alone                     */
    double aspect;          /* scale downwards over that across; 0: what suits       */
    double exaggeration;    /* of a relief of lengths; 0: what suits                 */
    bool hillshade;         /* with light and shadow                                 */
    size_t width;           /* pixels of the whole figure; 0: what suits the map     */
    double dpi;             /* of them an inch: text has its size on paper then;
                                   0: as many as give the marks FIGURE_POINTS           */
    bool vector;            /* for a PDF or SVG: the map keeps its own resolution    */
    bool paper;             /* of these a PDF */
    const char *family;     /* of the text; NULL: sans                               */
};

/* Where a value is in the colours, from 0 to 1 or beyond, and its colour. */
double figure_place(const struct figure *figure, double value);
struct rgb figure_colour(const struct figure *figure, double value);

/* The grid holds values, nx and ny; *figure says where they lie. NULL when memory is short. */
struct canvas *figure_draw(const struct figure *figure, const struct rc_grid *grid,
                           struct rc_err *err);

/* ---- several maps in one picture, with one colour bar and the axes of the outermost ---- */

struct panel {
    struct figure figure; /* all alike but for where they lie, zeros and missing */
    const struct rc_grid *grid;
    char label[256]; /* over it: "a) load 10 N" */
};

struct panels {
    const struct figure *figure; /* of the whole: title, subtitle, stamp, the colours, and how many
                                    nodes of all maps are missing or 0 */
    const struct panel *panel;
    size_t n, columns;
};

enum {
    SHEET_WIDTH = 1400 /* pixels where the figure asks for none */
};

/* Columns that give n panels of that aspect, width over height, a page of fair shape. */
size_t panels_columns(size_t n, double aspect);
/* NULL when memory is short or the width too small for so many columns. */
struct canvas *panels_draw(const struct panels *panels, struct rc_err *err);

#endif
