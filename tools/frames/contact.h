/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The nodes in contact and the boundary, from the frames of a case. All tools use these definitions.
 */
#ifndef RC_TOOL_CONTACT_H
#define RC_TOOL_CONTACT_H

#include "libcontact/contact.h"
#include "tools/cli/cli.h"

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

/* The boundary of a result is in its key `boundary`; without it, a map whose key `periodic` is yes is
 * periodic. */
enum rc_boundary map_boundary(const struct rc_grid *g);
/* The boundary of the contact that p was solved for; if p does not say, `periodic` (--periodic) does. Ends
 * the tool if the two contradict each other. */
enum rc_boundary contact_boundary(struct tool *tool, const struct rc_grid *p, bool periodic);

#endif
