/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A matrix as text. It has a header of four comment lines as in Gwyddion, then one line per row, with commas
 * between values. Every number has a point, so that no reader takes the comma for a decimal mark. */
#include <math.h>
#include <string.h>

#include "encode.h"
#include "formats/export.h"

/* The number, always with a point: "2.0", "1.0e-06". */
static const char *
number_text(char text[RC_NUMBER_SIZE], double value)
{
    size_t n;

    rc_number_text(text, value);
    n = strspn(text, "-0123456789");
    if (text[n] != '.' && strlen(text) + 3 <= RC_NUMBER_SIZE && !isinf(value)) {
        memmove(text + n + 2, text + n, strlen(text + n) + 1);
        memcpy(text + n, ".0", 2);
    }
    return text;
}

static enum rc_status
csv_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    const char *missing = wish->missing == NULL ? "NaN" : wish->missing;
    const struct rc_grid *g = frame[0];
    char number[RC_NUMBER_SIZE];

    (void)frames;
    fprintf(out, "# Channel: %s\n# Width: %s %s\n# Height: %s %s\n# Value units: %s\n", g->channel,
            rc_number((double)g->nx * g->dx), rc_grid_dunit(g), rc_number((double)g->ny * g->dy),
            rc_grid_dunit(g), g->unit);
    for (size_t j = 0; j < g->ny; j++)
        for (size_t i = 0; i < g->nx; i++) {
            double value = g->v[j * g->nx + i];

            if (fputs(isnan(value) ? missing : number_text(number, value), out) == EOF ||
                fputc(i + 1 < g->nx ? ',' : '\n', out) == EOF)
                return rc_put_failed(err);
        }
    return ferror(out) ? rc_put_failed(err) : RC_OK;
}

const struct rc_export rc_export_csv = {
    .name = "csv",
    .suffixes = ".csv",
    .summary = "matrix as text, with a header of size and unit",
    .text = true,
    .write = csv_write,
};
