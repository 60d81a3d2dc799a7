/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "open.h"

size_t
list_maps(const struct rc_format *format, const struct rc_file *file, const struct rc_wish *wish,
          struct rc_channel *channel, size_t most, struct rc_err *err)
{
    RC_OWN(rc_maps, maps) = rc_format_open(format, file, wish, err);

    return maps == NULL ? 0 : rc_maps_list(maps, channel, most);
}

struct rc_grid *
read_map(const struct rc_format *format, const struct rc_file *file, const struct rc_wish *wish,
         size_t index, struct rc_notes *notes, struct rc_err *err)
{
    RC_OWN(rc_maps, maps) = rc_format_open(format, file, wish, err);

    return maps == NULL ? NULL : rc_format_read(maps, wish, index, notes, err);
}
