/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Frames as one block of nodes, for the formats of VTK. The block has maps on one grid beside each other,
 * maps at several depths above each other, or a section with its depths.
 *
 * x, y and z are those of the grid stream: the origin in the middle of the map, y down the picture, z into
 * the body. Together they are right-handed.
 */
#ifndef RC_VOLUME_H
#define RC_VOLUME_H

#include "formats/export.h"

enum {
    RC_VTK_TYPES = RC_TYPE_F32 | RC_TYPE_F64
};

/* Writes them as a file of VTK: XML with raw appended values, with a 64-bit length before each array.
 * `image`: as ImageData, whose steps are even; else as RectilinearGrid. */
enum rc_status rc_vtk_write(FILE *out, struct rc_grid *const *frame, size_t frames, bool image,
                            const struct rc_export_wish *wish, struct rc_err *err);

#endif
