/* Results beside the height that they were computed from. */
#ifndef RC_RESULTS_H
#define RC_RESULTS_H

#include "tool.h"

/* A tool that changes heights calls this for every frame that it passes on: results in the same
 * case were computed from the old heights. Where a case holds both, in either order, it ends the
 * tool and names the results. */
void results_demand_none(struct tool *tool, const struct rc_grid *grid);

#endif
