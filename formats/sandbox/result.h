/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Transfers the result of a sandbox's child to the parent: its notes and message, then the channels or the
 * grid as a stream RCG1. The parent checks all of it, because the file may control the child. */
#ifndef RC_RESULT_H
#define RC_RESULT_H

#include <stdio.h>

#include "formats/core/core.h"

struct rc_result {
    size_t n; /* channels, or grids: 0 or 1; 0: `said` is the reason */
    struct rc_notes noted;
    struct rc_err said;
};

/* All return whether the transfer was complete. Of each map the struct rc_channel is sent. */
bool rc_result_send_list(FILE *to, const struct rc_result *result, const struct rc_maps *maps);
bool rc_result_send_grid(FILE *to, const struct rc_result *result, struct rc_grid *grid);
bool rc_result_receive(FILE *from, struct rc_result *result);
bool rc_result_receive_list(FILE *from, const struct rc_result *result, struct rc_maps *maps);
/* A grid within the limits of the file, or NULL. */
struct rc_grid *rc_result_receive_grid(FILE *from, const struct rc_file *file);

#endif
