/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK ImageData: see volume.h. */
#include "volume.h"

static enum rc_status
vti_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    return rc_vtk_write(out, frame, frames, true, wish, err);
}

const struct rc_export rc_export_vti = {
    .name = "vti",
    .suffixes = ".vti",
    .summary = "VTK ImageData (ParaView): frames as arrays, even depths as a stack",
    .several = true,
    .types = RC_VTK_TYPES,
    .write = vti_write,
};
