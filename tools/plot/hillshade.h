/* Light and shadow on a map seen from above. */
#ifndef RC_HILLSHADE_H
#define RC_HILLSHADE_H

#include "libcontact/grid.h"
#include "raster.h"

/* How bright each cell of the raster is, lit from the upper left: 1 where it lies flat or is
 * missing. `aspect` is the height of a cell over its width. Slopes count by their size over the RMS
 * slope of the map, so that the shades of any channel look alike. The caller frees it; NULL: memory
 * is short. */
float *hillshade_new(const struct raster *raster, double aspect, struct rc_err *err);

#endif
