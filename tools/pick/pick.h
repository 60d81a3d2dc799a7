/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The interface of this folder: the steps of rc-pick that cut, resample and rotate maps. */
#ifndef RC_PICK_H
#define RC_PICK_H

#include "tools/cli/cli.h"
#include "tools/frames/frames.h"

/* Where the part of a map that a frame keeps begins in it. */
struct part {
    size_t left, top;
};

/* True for one of these steps. */
bool pick_geometry(const struct step *step);
/* True if the step, one of these or not, works on frames without their values. */
bool pick_by_rows(const struct step *step);
/* Ends the tool when the step's argument is invalid; its lengths are in metres afterwards, as in the
 * history. */
void pick_geometry_settle(struct tool *tool, struct step *step);
/* Applies the step to a frame and to the keys that describe the whole map; if its values are not in memory,
 * only sets the shape and the part. Ends the tool where the step cannot be applied. */
void pick_geometry_do(struct tool *tool, struct rc_grid *grid, const struct step *step,
                      struct part *part);

#endif
