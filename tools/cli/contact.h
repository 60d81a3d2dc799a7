/*
 * What touches, by the frames of a case: one meaning for all tools.
 */
#ifndef RC_TOOL_CONTACT_H
#define RC_TOOL_CONTACT_H

#include "tool.h"

#define CONTACT_CHANNEL "contact"

/* The frame whose values tell rc_in_contact which nodes touch: `contact`, of the case of the pressure p and
 * on its grid, or where that is NULL p itself; both NULL: NULL. NULL also, with a warning, where p is the
 * net pressure of bodies that attract each other and does not tell. Ends the tool where a value of
 * `contact` is neither 0 nor 1, and warns where the pressure of other bodies is negative. */
const struct rc_grid *contact_frame(struct tool *tool, const struct rc_grid *p,
                                    const struct rc_grid *contact);
/* The same, but ends the tool where that is NULL: what needs it (a verb, as in "--patches needs to know"). */
const struct rc_grid *contact_demand(struct tool *tool, const struct rc_grid *p,
                                     const struct rc_grid *contact);

#endif
