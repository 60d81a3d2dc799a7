/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file that is opened for one list of its maps, or for one of them. */
#ifndef MADE_OPEN_H
#define MADE_OPEN_H

#include "formats/format.h"

/* The number of maps, of which the first `most` are listed; 0 with the reason. */
size_t list_maps(const struct rc_format *format, const struct rc_file *file,
                 const struct rc_wish *wish, struct rc_channel *channel, size_t most,
                 struct rc_err *err);
/* NULL with the reason. */
struct rc_grid *read_map(const struct rc_format *format, const struct rc_file *file,
                         const struct rc_wish *wish, size_t index, struct rc_notes *notes,
                         struct rc_err *err);

#endif
