/* The face of this folder: the steps of rc-pick that cut, resample and turn maps. */
#ifndef RC_PICK_H
#define RC_PICK_H

#include "tools/cli/cli.h"

/* Whether a step is one of them. */
bool pick_geometry(const struct step *step);
/* Ends the tool when the step's argument makes no sense; lengths in it are in metres from here on,
 * as history has them. */
void pick_geometry_settle(struct tool *tool, struct step *step);
/* Does it to a frame, and to the keys that tell of the whole map. Ends the tool where it cannot be
 * done to this frame. */
void pick_geometry_do(struct tool *tool, struct rc_grid *grid, const struct step *step);

#endif
