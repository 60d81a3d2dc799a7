/*
 * The face of this folder: figures, charts, colours, pictures as files. It knows grids and no tool.
 */
#ifndef RC_PLOT_H
#define RC_PLOT_H

#include "canvas.h"
#include "chart.h"
#include "colormap.h"
#include "figure.h"
#include "graph.h"
#include "panels.h"
#include "png.h"
#include "raster.h"
#include "relief.h"
#include "ticks.h"

#endif
