/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Maps on pixels: the values in a pixel, and lines across the map. */
#ifndef RC_RASTER_H
#define RC_RASTER_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/owned.h"

/* Statistics of a map. Infinite values are in neither min nor max. */
struct survey {
    double min, max;       /* NaN without a finite value                */
    size_t min_at, max_at; /* the first nodes with these values         */
    size_t missing;        /* NaN                                       */
    size_t zeros;          /* number of nodes with the value 0: no contact in pressures */
};

void survey_map(const struct rc_grid *grid, struct survey *survey);

/* The map on w by h cells, each with the mean of the nodes that it covers. A cell may be inside a node (a
 * small map, enlarged) or cover many nodes (a large map, reduced). */
struct raster {
    size_t w, h;
    double *v;      /* mean of its values; NaN: none */
    float *none;    /* fraction of the cell, 0 to 1, that is not in contact */
    float *missing; /* fraction of the cell that was not measured; NULL: all were */
};

/* The same of cell k. */
double raster_missing(const struct raster *raster, size_t k);

/* With `zero_is_none` the value 0 means no contact and is excluded from the means. NULL: memory is short. */
struct raster *raster_new(const struct rc_grid *grid, bool zero_is_none, size_t w, size_t h,
                          struct rc_err *err);
/* Makes only some of its h rows, from `first` on. */
struct raster *raster_rows(const struct rc_grid *grid, bool zero_is_none, size_t w, size_t h,
                           size_t first, size_t rows, struct rc_err *err);
/* The same with the largest value of the nodes of a cell in place of their mean. A cell is in contact, or
 * measured, if one of its nodes is. */
struct raster *raster_rows_max(const struct rc_grid *grid, bool zero_is_none, size_t w, size_t h,
                               size_t first, size_t rows, struct rc_err *err);
void raster_free(struct raster *raster); /* NULL is allowed */
RC_OWNER(raster)

/* Straight pieces of lines, in cells from the upper left corner: the centre of cell (i, j) is (i + 0.5, j +
 * 0.5). Initialise with 0; the caller frees `at`. */
struct lines {
    double (*at)[4]; /* x0 y0 x1 y1 */
    size_t n, capacity;
};

/* Adds the line on which the map, linear between the centres of its cells, has the value `level`. Parts
 * without contact count as 0, missing cells have no line. */
enum rc_status raster_contour(const struct raster *raster, double level, struct lines *lines,
                              struct rc_err *err);
/* Adds the borders between nodes with at least `level` (for level 0: above 0) and the others. They run along
 * the edges of nodes, in units of cells of a raster of w by h. */
enum rc_status raster_border(const struct rc_grid *grid, double level, size_t w, size_t h,
                             struct lines *lines, struct rc_err *err);

/* The brightness of each cell of the raster, lit from the upper left: 1 if it is flat or missing. `aspect` is
 * the height of a cell over its width. Slopes are relative to the RMS slope of the map, so that the shades of
 * all channels look similar. The caller frees it; NULL: memory is short. In hillshade.c. */
float *hillshade_new(const struct raster *raster, double aspect, struct rc_err *err);

#endif
