/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Suffixes of the names of pictures. */
#ifndef RC_ENDING_H
#define RC_ENDING_H

#include "tool.h"

/* The kind of picture from the suffix of its name, in upper or lower case: "png", "svg" or "pdf". Names
 * without such a suffix, as of devices, FIFOs and folders, and NULL give "png". */
const char *ending_of(const char *name);
/* Ends the tool with a wrong command line if the picture of an option (NULL: none) has none of these
 * suffixes. Devices, FIFOs and folders may have any name. */
void ending_demand_picture(struct tool *tool, const char *option, const char *name);
/* Ends the tool if the file for a stream (NULL: none) has the suffix of a picture. */
void ending_refuse_picture(struct tool *tool, const char *name);

#endif
