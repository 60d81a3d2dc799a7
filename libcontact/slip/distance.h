/*
 * How far every node is from the nearest one with w != 0, exactly but for rounding, in two passes.
 */
#ifndef RC_DISTANCE_H
#define RC_DISTANCE_H

#include "libcontact/common.h"

/* First the number of steps along its column, for all nodes ... */
void rc_distance_columns(const struct rc_shape *shape, enum rc_boundary boundary,
                         const unsigned char *w, int threads, float *steps);
/* ... then, row by row, the square of the distance, lengths as dx and dy are, from those of the
 * row; infinite when there is no such node. `scratch` holds rc_distance_scratch numbers and belongs
 * to one thread. */
size_t rc_distance_scratch(const struct rc_shape *shape);
void rc_distance_row(const struct rc_shape *shape, enum rc_boundary boundary, float *scratch,
                     const float *steps, float *d2);

#endif
