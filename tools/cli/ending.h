/* What the name of a picture has to end in. */
#ifndef RC_ENDING_H
#define RC_ENDING_H

#include "tool.h"

/* "png", "svg" or "pdf", whatever the case of the name's own ending: what kind of picture it is. A
 * name with none of them, as devices, FIFOs and folders have it, and NULL are "png". */
const char *ending_of(const char *name);
/* Ends the tool, because the command line is wrong, when the picture that an option names (NULL:
 * none) has none of these endings; devices, FIFOs and folders may have any name. */
void ending_demand_picture(struct tool *tool, const char *option, const char *name);
/* Ends the tool where a stream was to go into a file (NULL: none) that is named as a picture. */
void ending_refuse_picture(struct tool *tool, const char *name);

#endif
