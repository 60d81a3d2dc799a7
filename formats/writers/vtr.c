/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK RectilinearGrid: like vti.c, with the position of every node, so that depths may have uneven steps. */
#include "volume.h"

static enum rc_status
vtr_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    return rc_vtk_write(out, frame, frames, false, wish, err);
}

const struct rc_export rc_export_vtr = {
    .name = "vtr",
    .suffixes = ".vtr",
    .summary = "VTK RectilinearGrid (ParaView): as vti, for uneven depths",
    .several = true,
    .types = RC_VTK_TYPES,
    .uneven = true,
    .write = vtr_write,
};
