/*
 * Curves of one quantity over another, on axes that are linear or logarithmic: lines with markers,
 * bars, dashed laws; the legend stands under the plot.
 */
#ifndef RC_GRAPH_H
#define RC_GRAPH_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/grid.h"
#include "tools/canvas/canvas.h"

enum graph_kind {
    GRAPH_MARKS,  /* points joined by a line, each with a marker where they are few */
    GRAPH_POINTS, /* markers alone                                                  */
    GRAPH_LINE,
    GRAPH_LAW,  /* dashed, without markers                                          */
    GRAPH_BARS, /* from x[k] to x[k + 1], y[k] high: n is the number of edges       */
};

struct graph_point {
    bool hollow; /* of a second kind                                                   */
    bool front;  /* joined by a broad line under all series, and labelled where a label fits */
    char label[16];
};

struct graph_series {
    const char *name; /* NULL: not in the legend                                  */
    enum graph_kind kind;
    size_t place;        /* counted from 0: chooses colour and marker               */
    size_t mark;         /* 0: the marker goes with the colour; else counted from 1, and chooses it
                            and the dashes of the line                                */
    const double *x, *y; /* SI; a point that is not finite is a gap                 */
    const double *low, *high;        /* ends of error bars, SI; NULL: none                  */
    const struct graph_point *point; /* of each; NULL: nothing about them             */
    size_t n;
};

struct graph_axis {
    const char *quantity, *unit; /* as in a stream                                 */
    bool log;
    double lo, hi;           /* SI; NAN: what suits the points                               */
    const char *shown;       /* unit as asked for, see scale_given; NULL: what suits      */
    const char *const *word; /* of an axis x of categories: this stands at k, counted from 0 */
    size_t words;            /* 0: the axis is of numbers                            */
};

struct graph {
    const char *title, *subtitle; /* lines of the subtitle break at " · "          */
    const char *stamp;            /* NULL: none                                    */
    struct graph_axis x, y;
    const struct graph_series *series;
    size_t n;
    const double *upright; /* SI: a dashed line across the plot at each, where x is that */
    size_t uprights;
    const char
        *zero; /* what a load does whose y is 0: "sealed (no flow)"; NULL: no more than that */
    const char *note;           /* a line under the legend; NULL: none                        */
    const char *hollow, *front; /* what these points are, in the legend; NULL: there are none */
    double floor;               /* y below this means nothing; 0: all does                    */
    const char *floor_text;
    size_t width; /* pixels; 0: GRAPH_WIDTH                                     */
    double dpi;   /* as of a figure                                             */
    const char *family;
};

enum {
    GRAPH_WIDTH = 1200,
    GRAPH_COLOURS = 7 /* series after so many have a colour again, with another marker */
};

/* NULL when memory is short or an axis has no point: a logarithmic one holds none at or below 0. */
struct canvas *graph_draw(const struct graph *graph, struct rc_err *err);
/* Several, as wide as the first, one below the other. */
struct canvas *graphs_draw(const struct graph *graph, size_t n, struct rc_err *err);

#endif
