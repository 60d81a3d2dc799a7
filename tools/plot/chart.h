/*
 * Points in a plane whose two axes are logarithmic, by series, with a front marked among them.
 */
#ifndef RC_CHART_H
#define RC_CHART_H

#include <stdbool.h>
#include <stddef.h>

#include "tools/canvas/canvas.h"

struct chart_point {
    double x, y; /* > 0; y below the lower end of the axis is drawn on it  */
    bool hollow; /* of a second kind                                       */
    bool front;  /* marked, and labelled where a label fits               */
    char label[16];
};

struct chart_series {
    const char *name;
    struct rgb colour;
    const struct chart_point *point; /* joined by a line in this order       */
    size_t n;
};

struct chart {
    const char *title, *subtitle;
    const char *across, *up; /* what the axes are, with units                 */
    const struct chart_series *series;
    size_t n;
    const char *hollow; /* what hollow points are; NULL: there are none  */
    double floor;       /* y below this means nothing; 0: all do         */
    const char *floor_text;
};

enum {
    CHART_WIDTH = 1200 /* pixels */
};

/* Pixels that it takes downwards. */
double chart_height(struct canvas *canvas, const struct chart *chart);
/* Draws it from y down, CHART_WIDTH wide. */
void chart_draw(struct canvas *canvas, double y, const struct chart *chart);

#endif
