/* What the name of an output has to end in. */
#ifndef RC_ENDING_H
#define RC_ENDING_H

#include "tool.h"

/* Ends the tool, the command line being wrong, when the picture that an option names (NULL: none) does
 * not end in .png, in whatever case. Devices, FIFOs and folders have the names that they have. */
void ending_demand_png(struct tool *tool, const char *option, const char *name);

#endif
