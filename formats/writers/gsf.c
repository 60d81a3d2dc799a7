/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gwyddion Simple Field: a header of `key = value`, one to four NUL bytes up to a multiple of four, and the
 * values. These are float, little-endian, top row first; NaN for a missing point. */
#include <string.h>

#include "encode.h"
#include "formats/export.h"

static enum rc_status
gsf_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    static const char padding[4];
    const struct rc_grid *g = frame[0];
    const struct rc_code code = {.raw = RC_RAW_F32};
    RC_ENDS(rc_buffer_free) struct rc_buffer b = {0};
    double i, j;

    (void)frames, (void)wish;
    rc_buffer_print(&b,
                    "Gwyddion Simple Field 1.0\nXRes = %zu\nYRes = %zu\nXReal = %s\nYReal = %s\n"
                    "XYUnits = %s\nZUnits = %s\nTitle = %s\n",
                    g->nx, g->ny, rc_number((double)g->nx * g->dx),
                    rc_number((double)g->ny * g->dy), rc_grid_dunit(g), g->unit, g->channel);
    if (strcmp(rc_grid_dunit(g), "m") != 0) { /* the position of wave number 0 */
        rc_grid_origin(g, &i, &j);
        rc_buffer_print(&b, "XOffset = %s\nYOffset = %s\n", rc_number(-(i + 0.5) * g->dx),
                        rc_number(-(j + 0.5) * g->dy));
    }
    rc_buffer_add(&b, padding, 4 - b.n % 4);
    return rc_buffer_write(&b, out, err) == RC_OK
               ? rc_encode_file(&code, g->v, g->nx * g->ny, out, err)
               : RC_FAIL;
}

const struct rc_export rc_export_gsf = {
    .name = "gsf",
    .suffixes = ".gsf",
    .summary = "Gwyddion Simple Field",
    .types = RC_TYPE_F32,
    .write = gsf_write,
};
