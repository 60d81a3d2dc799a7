/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Figures for publications: a map with axes, colour bar, title and legend. The two axes of a map have the
 * same scale unless the map would be a very thin strip (FIGURE_ASPECT); the figure then says so.
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
    FIGURE_POINTS = 7,   /* size of the numbers at the marks, in points on paper         */
    FIGURE_WIDE = 16000, /* bounds of a requested width, pixels                          */
};

/* A medium between two depths of a section. */
struct medium {
    double bottom;  /* m; INFINITY: the last */
    char text[128]; /* text of the legend */
};

/* The words above a plot, and the size of the picture. */
struct paper {
    const char *title;
    const char *subtitle; /* below the title; lines break at " · "                          */
    const char *stamp;    /* a warning in a separate frame; NULL: none                      */
    size_t width;         /* pixels of the whole picture; 0: automatic                      */
    double dpi;           /* dpi per inch, for text of its size on paper; 0: marks of
                             FIGURE_POINTS */
    const char *family;   /* font of the text; NULL: sans */
};

/* The colours of values and their bar. */
struct bar {
    const char *quantity; /* name of the values: "Gap"       */
    const char *unit;     /* unit of the values, as in a stream */
    const struct colormap *map;
    double lo, hi;    /* values at the ends of the colour bar, lo < hi */
    bool log;         /* logarithmic colours; 0 < lo                   */
    const char *note; /* about the colours, in the legend; NULL: none  */
    double min, max;  /* min and max of the values: the bar has an arrow towards values beyond its
                         end */
};

/* The position of a map, and its axes. */
struct extent {
    const char *across, *down;       /* names of the axes: "x", "y", "depth"             */
    const char *dunit;               /* unit of the axes; NULL: m                        */
    double left, right, top, bottom; /* outer edges in that unit: left < right, top < bottom */
    bool section;                    /* y is the depth, whose axis has a separate unit   */
    double aspect;                   /* vertical scale over the horizontal one; 0: automatic */
    double exaggeration;             /* exaggeration of a relief of lengths; 0: automatic */
};

/* What is drawn over the colours, with its text in the legend (NULL: it is not drawn). */
struct mark {
    const char *largest; /* a cross at (x, y)                   */
    double x, y;
    const char *circle; /* a dashed circle about the origin, or two lines */
    double radius;      /* m; of lines their distance from the origin */
    char across;        /* the axis across the lines, x or y; 0: a circle */
};

/* Lines on a map. */
struct edge {
    const struct rc_grid *contact;  /* on the same grid: its edge is drawn; NULL: unknown        */
    const struct rc_grid *pressure; /* on the same grid; NULL: unknown                           */
    double hard;  /* pressures that reach this hardness get a line around them; 0: none          */
    bool contour; /* lines at the marks of the bar, and the edge of the contact                  */
    bool border;  /* only the edge of the contact                                                */
};

/* Nodes without a value, and nodes whose value is a word. */
struct nodes {
    size_t missing;         /* number of NaN nodes                              */
    size_t all;             /* among this number of nodes; 0: those of the map  */
    const char *missing_is; /* meaning of missing nodes; NULL: not measured     */
    bool zero_is_none;      /* the value 0 has a separate colour                */
    size_t zeros;           /* number of nodes with the value 0                 */
    const char *none;       /* its meaning: "no contact"                        */
    /* Meanings of the values 1 and 2 (NULL: not present) of categories, which have a legend in place of the
     * bar; NULL: no categories. */
    const char *const *is;
};

struct figure {
    struct paper paper;
    struct bar bar;
    struct extent at;
    struct mark mark;
    struct edge edge;
    struct nodes nodes;
    struct medium *medium; /* media of a section, the top first; NULL: one medium */
    size_t media;
    bool keep_max;  /* a reduced map shows the largest value in each pixel */
    bool hillshade; /* with light and shadow                               */
    bool vector;    /* for a PDF or SVG: the map keeps its resolution      */
};

/* The position of a value in the range of colours, from 0 to 1 or beyond. */
double figure_place(const struct figure *figure, double value);

/* The grid holds values, nx and ny; *figure has their positions. NULL when memory is short. */
struct canvas *figure_draw(const struct figure *figure, const struct rc_grid *grid,
                           struct rc_err *err);

/* ---- several maps in one picture, with one colour bar and the axes of the outermost ---- */

struct panel {
    struct figure figure; /* equal except for positions, zeros and missing nodes */
    const struct rc_grid *grid;
    char label[256]; /* title above it: "a) load 10 N" */
};

struct panels {
    const struct figure *figure; /* for all maps: paper, colours, and their numbers of nodes */
    const struct panel *panel;
    size_t n, columns;
};

enum {
    SHEET_WIDTH = 1400 /* default width in pixels */
};

/* The number of columns that gives a page of good proportions for n panels with this width over height. */
size_t panels_columns(size_t n, double aspect);
/* NULL when memory is short or the width is too small for these columns. */
struct canvas *panels_draw(const struct panels *panels, struct rc_err *err);

#endif
