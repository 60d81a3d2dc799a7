/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Digital Surf has a 512-byte header and whole numbers, little-endian, row 0 first. Lengths are in mm, as in
 * Digital Surf's programs; value = number * step + offset.
 *
 * Some readers subtract the smallest number first and others do not, so it is 0 here. Step and offset are
 * floats: they are rounded before the numbers are computed, so that the rounding does not affect the values.
 * A missing point is the number two below the smallest, and the header announces missing points.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "encode.h"
#include "formats/export.h"

enum {
    TYPES = RC_TYPE_I16 | RC_TYPE_I32,
    HEADER = 512,
    MISSING = -2,
};

struct plan {
    struct rc_code code; /* in the units of the frame */
    const char *unit;    /* unit of the values in the file */
    double worth;        /* SI value of one unit      */
    float step, offset;  /* in that unit              */
    int32_t most;        /* largest number            */
    bool missing;
};

static struct plan
make_plan(const struct rc_grid *g, const struct rc_range *range, const struct rc_export_wish *wish)
{
    bool length = strcmp(g->unit, "m") == 0;
    struct plan p = {.code = {.raw = rc_export_raw(g, wish, TYPES), .missing = MISSING},
                     .unit = length ? "mm" : g->unit,
                     .worth = length ? 1e-3 : 1,
                     .missing = range->missing > 0};
    double low = range->min / p.worth, high = range->max / p.worth;

    p.most = p.code.raw == RC_RAW_I16 ? INT16_MAX : INT32_MAX;
    p.offset = (float)low;
    if ((double)p.offset > low)
        p.offset = nextafterf(p.offset, -INFINITY);
    p.step = (float)((high - (double)p.offset) / p.most);
    if ((double)p.step * p.most < high - (double)p.offset)
        p.step = nextafterf(p.step, INFINITY);
    if (p.step == 0)
        p.step = 1;
    p.code.increment = (double)p.step * p.worth;
    p.code.offset = (double)p.offset * p.worth;
    return p;
}

/* ---- the header ---- */

/* Text of n characters, cut or filled up with NUL. */
static void
text(struct rc_buffer *b, const char *s, size_t n)
{
    for (size_t k = 0; k < n; k++)
        rc_buffer_add(b, *s == '\0' ? "" : s, 1), s += *s != '\0';
}

static void
fill(struct rc_buffer *b, size_t until)
{
    while (b->n < until && !b->failed)
        rc_buffer_add(b, "", 1);
}

static void
words(struct rc_buffer *b, size_t n, const uint16_t *word)
{
    for (size_t k = 0; k < n; k++)
        rc_buffer_u16(b, word[k]);
}

static void
date_fields(struct rc_buffer *b, const struct rc_grid *g, const struct rc_export_wish *wish)
{
    static const unsigned char at[] = {17, 14, 11, 8, 5, 0}; /* seconds first, year last */
    char date[RC_DATE];

    rc_export_date(date, g, wish);
    for (size_t k = 0; k < sizeof at; k++)
        rc_buffer_u16(b, (uint16_t)strtol(date + at[k], NULL, 10));
}

static void
make_header(struct rc_buffer *b, const struct rc_grid *g, const struct plan *p,
            const struct rc_export_wish *wish)
{
    const char *length = "mm";
    uint16_t bits = p->code.raw == RC_RAW_I16 ? 16 : 32;

    text(b, "DIGITAL SURF", 12);
    words(b, 4, (const uint16_t[]){0, 1, 1, 2}); /* PC, one object, version, a surface */
    text(b, g->channel, 30);
    text(b, "", 30);
    words(b, 5, (const uint16_t[]){0, 0, 1, p->missing, 1});
    fill(b, 98);
    rc_buffer_u16(b, bits);
    rc_buffer_u32(b, 0);
    rc_buffer_u32(b, (uint32_t)p->most);
    rc_buffer_u32(b, (uint32_t)g->nx);
    rc_buffer_u32(b, (uint32_t)g->ny);
    rc_buffer_u32(b, (uint32_t)(g->nx * g->ny));
    rc_buffer_f32(b, (float)(g->dx * 1e3));
    rc_buffer_f32(b, (float)(g->dy * 1e3));
    rc_buffer_f32(b, p->step);
    text(b, "X", 16);
    text(b, "Y", 16);
    text(b, "Z", 16);
    for (int k = 0; k < 2; k++) { /* unit of a step, then of the whole length */
        text(b, length, 16);
        text(b, length, 16);
        text(b, p->unit, 16);
    }
    for (int k = 0; k < 3; k++)
        rc_buffer_f32(b, 1); /* factor between units */
    words(b, 2, (const uint16_t[]){1, 0});
    fill(b, 306);
    date_fields(b, g, wish);
    fill(b, 474);
    rc_buffer_f32(b, p->offset);
    fill(b, HEADER);
}

static enum rc_status
sur_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    const struct rc_grid *g = frame[0];
    RC_ENDS(rc_buffer_free) struct rc_buffer header = {0};
    struct rc_range range;
    struct plan plan;

    (void)frames;
    if (g->nx > INT32_MAX / g->ny)
        return rc_err_set(err, "%zu x %zu nodes are more than a sur file can count", g->nx, g->ny);
    if (rc_range_of(g, &range, err) != RC_OK)
        return RC_FAIL;
    plan = make_plan(g, &range, wish);
    if (!isfinite(plan.step) || !isfinite(plan.offset))
        return rc_err_set(err, "values up to %g are beyond the floats of a sur header", range.max);
    make_header(&header, g, &plan, wish);
    return rc_buffer_write(&header, out, err) == RC_OK
               ? rc_encode_file(&plan.code, g->v, g->nx * g->ny, out, err)
               : RC_FAIL;
}

const struct rc_export rc_export_sur = {
    .name = "sur",
    .suffixes = ".sur",
    .summary = "Digital Surf (MountainsMap), not compressed",
    .types = TYPES,
    .lengths = true,
    .write = sur_write,
};
