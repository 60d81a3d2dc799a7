/* SPDX-License-Identifier: GPL-3.0-or-later */
/* SDF in its binary form, ISO 25178-71. It has an 81-byte header and the heights, little-endian. There is no
 * offset: height = number * Zscale. A missing point is the smallest number of an integer type, or NaN. */
#include <math.h>

#include "encode.h"
#include "sdf_head.h"

enum {
    TYPES = RC_TYPE_I16 | RC_TYPE_I32 | RC_TYPE_F64,
    MAKER = 10,
    DATE = 12
};

static struct rc_code
make_code(const struct rc_grid *g, const struct rc_range *range, const struct rc_export_wish *wish)
{
    enum rc_raw raw = rc_export_raw(g, wish, TYPES);
    int32_t most = raw == RC_RAW_I16 ? INT16_MAX : INT32_MAX;
    double high = fmax(fabs(range->min), fabs(range->max));
    struct rc_range about_zero = {.min = -high, .max = high};
    struct rc_code code = rc_code_for(raw, &about_zero, -most, most, -most - 1);

    code.offset = 0;
    return code;
}

static void
make_header(struct rc_buffer *b, const struct rc_grid *g, const struct rc_code *code,
            const struct rc_export_wish *wish)
{
    static const char type[] = {[RC_RAW_I16] = 5, [RC_RAW_I32] = 6, [RC_RAW_F64] = 7};
    char maker[MAKER + 1], date[RC_SDF_DATE];

    snprintf(maker, sizeof maker, "%-10.10s", sdf_maker(g));
    sdf_date(date, g, wish);
    rc_buffer_add(b, "bISO-1.0", 8);
    rc_buffer_add(b, maker, MAKER);
    rc_buffer_add(b, date, DATE);
    rc_buffer_add(b, date, DATE);
    rc_buffer_u16(b, (uint16_t)g->nx);
    rc_buffer_u16(b, (uint16_t)g->ny);
    rc_buffer_f64(b, g->dx);
    rc_buffer_f64(b, g->dy);
    rc_buffer_f64(b, code->increment);
    rc_buffer_f64(b, code->raw == RC_RAW_F64 ? -1 : code->increment);
    rc_buffer_add(b, "\0", 1);
    rc_buffer_add(b, &type[code->raw], 1);
    rc_buffer_add(b, "\0", 1);
}

static enum rc_status
sdf_binary_write(FILE *out, struct rc_grid *const *frame, size_t frames,
                 const struct rc_export_wish *wish, struct rc_err *err)
{
    const struct rc_grid *g = frame[0];
    RC_ENDS(rc_buffer_free) struct rc_buffer header = {0};
    struct rc_range range;
    struct rc_code code;

    (void)frames;
    if (g->nx > UINT16_MAX || g->ny > UINT16_MAX)
        return rc_err_set(err, "%zu x %zu nodes: a binary SDF file has at most %d of either", g->nx,
                          g->ny, UINT16_MAX);
    if (rc_range_of(g, &range, err) != RC_OK)
        return RC_FAIL;
    code = make_code(g, &range, wish);
    make_header(&header, g, &code, wish);
    return rc_buffer_write(&header, out, err) == RC_OK
               ? rc_encode_file(&code, g->v, g->nx * g->ny, out, err)
               : RC_FAIL;
}

const struct rc_export rc_export_sdf_binary = {
    .name = "sdf-binary",
    .suffixes = ".bsdf",
    .summary = "ISO 25178-71 in binary (bISO-1.0)",
    .heights = true,
    .types = TYPES,
    .lengths = true,
    .write = sdf_binary_write,
};
