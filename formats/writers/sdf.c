/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SDF in its text form, ISO 25178-71 (earlier EUNA 15178). A header of `key = value`, the heights row by row,
 * and a trailer, with an asterisk after each. A missing point is the word BAD; a resolution of -1 is
 * unknown. */
#include <math.h>

#include "encode.h"
#include "sdf_head.h"

static void
make_header(struct rc_buffer *b, const struct rc_grid *g, const struct rc_export_wish *wish)
{
    char date[RC_SDF_DATE];

    sdf_date(date, g, wish);
    rc_buffer_print(b,
                    "aISO-1.0\n"
                    "ManufacID   = %.10s\nCreateDate  = %s\nModDate     = %s\n"
                    "NumPoints   = %zu\nNumProfiles = %zu\nXscale      = %s\nYscale      = %s\n"
                    "Zscale      = 1\nZresolution = -1\nCompression = 0\nDataType    = 7\n"
                    "CheckType   = 0\n*\n",
                    sdf_maker(g), date, date, g->nx, g->ny, rc_number(g->dx), rc_number(g->dy));
}

static enum rc_status
put_row(FILE *out, const double *v, size_t n, const char *missing, struct rc_err *err)
{
    char number[RC_NUMBER_SIZE];

    for (size_t i = 0; i < n; i++) {
        rc_number_text(number, v[i]);
        if (fputs(isnan(v[i]) ? missing : number, out) == EOF ||
            fputc(i + 1 < n ? ' ' : '\n', out) == EOF)
            return rc_put_failed(err);
    }
    return RC_OK;
}

static enum rc_status
sdf_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    const char *missing = wish->missing == NULL ? "BAD" : wish->missing;
    const struct rc_grid *g = frame[0];
    RC_ENDS(rc_buffer_free) struct rc_buffer header = {0};
    struct rc_range range;

    (void)frames;
    make_header(&header, g, wish);
    if (rc_range_of(g, &range, err) != RC_OK || rc_buffer_write(&header, out, err) != RC_OK)
        return RC_FAIL;
    for (size_t j = 0; j < g->ny; j++)
        if (put_row(out, g->v + j * g->nx, g->nx, missing, err) != RC_OK)
            return RC_FAIL;
    return rc_put(out, "*\n*\n", 4, err);
}

const struct rc_export rc_export_sdf = {
    .name = "sdf",
    .suffixes = ".sdf",
    .summary = "ISO 25178-71 as text (aISO-1.0)",
    .text = true,
    .heights = true,
    .lengths = true,
    .write = sdf_write,
};
