/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points as text have x, y and value of every node, x fastest, in SI. The origin is in the middle of the map,
 * or at wave number 0 of a spectrum. NaN marks a missing point, so that the raster is complete. In a section
 * the second number is the depth. */
#include <math.h>
#include <stdlib.h>

#include "encode.h"
#include "formats/export.h"

static enum rc_status
xyz_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    const char *missing = wish->missing == NULL ? "NaN" : wish->missing;
    bool section = rc_grid_get(frame[0], "section") && rc_grid_get(frame[0], "depths");
    char y[RC_NUMBER_SIZE], z[RC_NUMBER_SIZE];
    const struct rc_grid *g = frame[0];
    RC_OWNED double *at = malloc(g->ny * sizeof *at);
    double middle, row;

    (void)frames;
    if (at == NULL)
        return rc_err_set(err, "out of memory for %zu rows", g->ny);
    rc_grid_origin(g, &middle, &row);
    for (size_t j = 0; j < g->ny; j++)
        at[j] = ((double)j - row) * g->dy;
    if (section && rc_export_depths(g, at, err) != RC_OK)
        return RC_FAIL;
    for (size_t j = 0; j < g->ny; j++) {
        rc_number_text(y, at[j]);
        for (size_t i = 0; i < g->nx; i++) {
            double value = g->v[j * g->nx + i];

            rc_number_text(z, value);
            if (fprintf(out, "%s %s %s\n", rc_number(((double)i - middle) * g->dx), y,
                        isnan(value) ? missing : z) < 0) {
                rc_put_failed(err);
                return RC_FAIL;
            }
        }
    }
    return RC_OK;
}

const struct rc_export rc_export_xyz = {
    .name = "xyz",
    .suffixes = ".xyz",
    .summary = "points as text: x, y, value",
    .text = true,
    .uneven = true,
    .write = xyz_write,
};
