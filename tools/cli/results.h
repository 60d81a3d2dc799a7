/* Results beside the height that they were computed from. */
#ifndef RC_RESULTS_H
#define RC_RESULTS_H

#include "tool.h"

/* Whether frames of this channel are computed from a height: what rc-solve, rc-deflect and
 * rc-stress write. */
bool results_channel(const char *channel);

/* For a tool that changes heights, of every frame that it passes on: a height that was changed does
 * not belong to the results beside it any more. Ends the tool, naming them, where a case holds both,
 * in whatever order they come. */
void results_demand_none(struct tool *tool, const struct rc_grid *grid);

#endif
