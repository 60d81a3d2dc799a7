/* Light and shadow on a flat map. */
#ifndef RC_HILLSHADE_H
#define RC_HILLSHADE_H

#include "libcontact/grid.h"
#include "raster.h"

/* The brightness of each cell of the raster, lit from the upper left: 1 if it is flat or missing. `aspect` is
 * the height of a cell over its width. Slopes are relative to the RMS slope of the map, so that the shades of
 * all channels look similar. The caller frees it; NULL: memory is short. */
float *hillshade_new(const struct raster *raster, double aspect, struct rc_err *err);

#endif
