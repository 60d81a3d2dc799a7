/*
 * The face of this folder: figures, charts, colours, pictures as files, and which frame is drawn.
 */
#ifndef RC_PLOT_H
#define RC_PLOT_H

#include "chart.h"
#include "choice.h"
#include "colormap.h"
#include "figure.h"
#include "png.h"
#include "raster.h"
#include "ticks.h"

#endif
