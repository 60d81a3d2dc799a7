/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Results in a case with the height from which they were computed. */
#ifndef RC_RESULTS_H
#define RC_RESULTS_H

#include "tool.h"

/* A tool that changes heights calls this for every frame that it passes on. Results in the same case were
 * computed from the old heights. If a case holds both, in either order, this ends the tool and names the
 * results. */
void results_demand_none(struct tool *tool, const struct rc_grid *grid);

#endif
