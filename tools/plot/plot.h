/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The interface of this folder: figures and charts on a canvas. It uses grids, but no tool.
 */
#ifndef RC_PLOT_H
#define RC_PLOT_H

#include "tools/canvas/canvas.h"
#include "figure.h"
#include "graph.h"
#include "raster.h"
#include "relief.h"
#include "ticks.h"

#endif
