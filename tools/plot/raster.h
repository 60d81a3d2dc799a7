/* Maps on pixels: what a pixel covers, and lines across the map. */
#ifndef RC_RASTER_H
#define RC_RASTER_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/grid.h"

/* What is in a map. Infinite values are in neither min nor max. */
struct survey {
    double min, max;       /* NaN when there is no finite value         */
    size_t min_at, max_at; /* the first nodes of these values      */
    size_t missing;        /* NaN                                       */
    size_t zeros;          /* nodes of value 0: no contact in pressures */
};

void survey_map(const struct rc_grid *grid, struct survey *survey);

/* The map on w by h cells, each the mean of what it covers. A cell can lie inside a node (a small
 * map enlarged) or hold many (a large one reduced). */
struct raster {
    size_t w, h;
    double *v;      /* mean of the values there; NaN: none                        */
    float *none;    /* part of the cell, 0 to 1, that is not in contact           */
    float *missing; /* part of the cell that was not measured                     */
};

/* With `zero_is_none` value 0 means no contact and is left out of the means. NULL: memory is
 * short. */
struct raster *raster_new(const struct rc_grid *grid, bool zero_is_none, size_t w, size_t h,
                          struct rc_err *err);
/* So many of its h rows alone, from `first` on. */
struct raster *raster_rows(const struct rc_grid *grid, bool zero_is_none, size_t w, size_t h,
                           size_t first, size_t rows, struct rc_err *err);
/* The same with the largest value of the nodes that a cell covers in place of their mean; a cell is
 * in contact, and measured, where one of its nodes is. */
struct raster *raster_rows_max(const struct rc_grid *grid, bool zero_is_none, size_t w, size_t h,
                               size_t first, size_t rows, struct rc_err *err);
void raster_free(struct raster *raster); /* NULL is allowed */

/* Straight pieces of lines, in cells from the upper left corner: the middle of cell (i, j) is
 * (i + 0.5, j + 0.5). Zeroed before first use; the caller frees `at`. */
struct lines {
    double (*at)[4]; /* x0 y0 x1 y1 */
    size_t n, capacity;
};

/* Adds the line where the map, linear between the middles of its cells, has the value `level`;
 * parts without contact count as 0, missing cells have no line. */
enum rc_status raster_contour(const struct raster *raster, double level, struct lines *lines,
                              struct rc_err *err);
/* Adds the borders between nodes of at least `level` (above 0: level 0) and the others, along the
 * edges of their cells, in cells of a raster of w by h. */
enum rc_status raster_border(const struct rc_grid *grid, double level, size_t w, size_t h,
                             struct lines *lines, struct rc_err *err);

#endif
