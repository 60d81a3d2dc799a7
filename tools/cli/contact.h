/*
 * Finds the nodes in contact from the frames of a case. All tools use this one definition.
 */
#ifndef RC_TOOL_CONTACT_H
#define RC_TOOL_CONTACT_H

#include "tool.h"

#define CONTACT_CHANNEL "contact"

/* The frame from whose values rc_in_contact finds the touching nodes. It is `contact`, in the case of the
 * pressure p and on its grid, or p itself if `contact` is NULL. NULL if both are NULL. Also NULL, with a
 * warning, if p is a net pressure of bodies that attract each other, which does not determine the contact.
 * Ends the tool if a value of `contact` is neither 0 nor 1, and warns if the pressure of other bodies is
 * negative. */
const struct rc_grid *contact_frame(struct tool *tool, const struct rc_grid *p,
                                    const struct rc_grid *contact);
/* The same, but ends the tool instead of returning NULL; `what` needs the contact (with a verb, as in
 * "--patches needs to know"). */
const struct rc_grid *contact_demand(struct tool *tool, const struct rc_grid *p,
                                     const struct rc_grid *contact);

#endif
