/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Curves of one quantity over another on linear or logarithmic axes: lines with markers, bars, dashed laws;
 * the legend is under the plot.
 */
#ifndef RC_GRAPH_H
#define RC_GRAPH_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/grid.h"
#include "tools/canvas/canvas.h"
#include "figure.h"

enum graph_kind {
    GRAPH_MARKS,  /* points joined by a line, with markers if there are few */
    GRAPH_POINTS, /* markers alone                                                  */
    GRAPH_LINE,
    GRAPH_LAW,  /* dashed, without markers                                          */
    GRAPH_BARS, /* from x[k] to x[k + 1], y[k] high: n is the number of edges       */
};

struct graph_point {
    bool hollow; /* points of a second kind */
    bool front;  /* points joined by a broad line under all series, and labelled if a label fits */
    char label[16];
};

struct graph_series {
    const char *name; /* NULL: not in the legend                                  */
    enum graph_kind kind;
    size_t place;             /* counted from 0: chooses colour and marker        */
    size_t mark;              /* 0: the marker follows the colour; else counted from 1, chooses the
                                 marker and the dashes of the line */
    const double *x, *y;      /* SI; a point that is not finite is a gap */
    const double *low, *high; /* ends of error bars, SI; NULL: none */
    const struct graph_point *point; /* label of each point; NULL: none */
    size_t n;
};

struct graph_axis {
    const char *quantity, *unit; /* unit, as in a stream */
    bool log;
    double lo, hi;           /* ends of the axis, SI; NAN: from the points */
    const char *shown;       /* requested unit, see scale_given; NULL: automatic   */
    const char *const *word; /* an axis x of categories: its word at k, counted from 0 */
    size_t words;            /* number of categories; 0: an axis of numbers */
};

struct graph {
    struct paper paper; /* width 0: GRAPH_WIDTH */
    struct graph_axis x, y;
    const struct graph_series *series;
    size_t n;
    const double *upright; /* SI: a dashed line across the plot at each of these x */
    size_t uprights;
    const char *zero;           /* the meaning of y = 0: "sealed (no flow)"; NULL: none */
    const char *note;           /* a line under the legend; NULL: none */
    const char *hollow, *front; /* name of these points in the legend; NULL: there are none */
    double floor;               /* y below this is only rounding; 0: no limit   */
    const char *floor_text;
};

enum {
    GRAPH_WIDTH = 1200,
    GRAPH_COLOURS = 7 /* number of colours; further series repeat them with another marker */
};

/* NULL when memory is short or an axis has no point; a logarithmic axis has none at or below 0. */
struct canvas *graph_draw(const struct graph *graph, struct rc_err *err);
/* Several graphs, as wide as the first, one below the other. */
struct canvas *graphs_draw(const struct graph *graph, size_t n, struct rc_err *err);

#endif
