/* SPDX-License-Identifier: GPL-3.0-or-later */
/* MATLAB, MAT version 5, not compressed: the map with the name of its channel, rows first, and dx, dy, dunit
 * and unit. Numbers are stored column after column. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "encode.h"
#include "formats/export.h"

enum {
    TYPES = RC_TYPE_F32 | RC_TYPE_F64,
    TEXT_SIZE = 116, /* size of the text of the header */
    NAME_MOST = 63,
    /* types of elements */
    INT8 = 1,
    UINT16 = 4,
    INT32 = 5,
    UINT32 = 6,
    SINGLE = 7,
    DOUBLE = 9,
    MATRIX = 14,
    /* classes of arrays */
    CHAR_ARRAY = 4,
    DOUBLE_ARRAY = 6,
    SINGLE_ARRAY = 7
};

#define BYTES_MOST UINT32_C(0x7fffffff) /* largest bytes of an array, MATLAB's limit */

static uint32_t
padded(size_t n)
{
    return (uint32_t)((n + 7) / 8 * 8);
}

static void
put_padding(struct rc_buffer *b, size_t n)
{
    static const char none[8] = {0};

    rc_buffer_add(b, none, padded(n) - n);
}

/* Writes an array up to its numbers, which have n bytes. */
static void
start_array(struct rc_buffer *b, const char *name, uint32_t class, size_t rows, size_t columns,
            uint32_t type, size_t n)
{
    rc_buffer_u32(b, MATRIX);
    rc_buffer_u32(b, 16 + 16 + 8 + padded(strlen(name)) + 8 + padded(n));
    rc_buffer_u32(b, UINT32);
    rc_buffer_u32(b, 8);
    rc_buffer_u32(b, class);
    rc_buffer_u32(b, 0);
    rc_buffer_u32(b, INT32);
    rc_buffer_u32(b, 8);
    rc_buffer_u32(b, (uint32_t)rows);
    rc_buffer_u32(b, (uint32_t)columns);
    rc_buffer_u32(b, INT8);
    rc_buffer_u32(b, (uint32_t)strlen(name));
    rc_buffer_add(b, name, strlen(name));
    put_padding(b, strlen(name));
    rc_buffer_u32(b, type);
    rc_buffer_u32(b, (uint32_t)n);
}

static void
put_number(struct rc_buffer *b, const char *name, double value)
{
    start_array(b, name, DOUBLE_ARRAY, 1, 1, DOUBLE, 8);
    rc_buffer_f64(b, value);
}

/* Units are ASCII except a few with special characters, which are omitted. */
static void
put_text(struct rc_buffer *b, const char *name, const char *text)
{
    size_t n = 0;

    for (const char *s = text; *s != '\0'; s++)
        n += isascii((unsigned char)*s) != 0;
    start_array(b, name, CHAR_ARRAY, 1, n, UINT16, 2 * n);
    for (const char *s = text; *s != '\0'; s++)
        if (isascii((unsigned char)*s))
            rc_buffer_u16(b, (uint16_t)*s);
    put_padding(b, 2 * n);
}

/* The channel as a name of MATLAB: letters, digits and underscores, a letter first. */
static void
make_name(char name[NAME_MOST + 1], const char *channel)
{
    size_t n = 0;

    if (!isalpha((unsigned char)channel[0]))
        name[n++] = 'z';
    for (; *channel != '\0' && n < NAME_MOST; channel++)
        name[n++] = isalnum((unsigned char)*channel) ? *channel : '_';
    name[n] = '\0';
}

static enum rc_status
put_columns(FILE *out, const struct rc_grid *g, const struct rc_code *code, struct rc_err *err)
{
    RC_OWNED double *column = malloc(g->ny * sizeof *column);
    enum rc_status status = RC_OK;

    if (column == NULL)
        return rc_err_set(err, "out of memory for a column of %zu values", g->ny);
    for (size_t i = 0; status == RC_OK && i < g->nx; i++) {
        for (size_t j = 0; j < g->ny; j++)
            column[j] = g->v[j * g->nx + i];
        status = rc_encode_file(code, column, g->ny, out, err);
    }
    return status;
}

static enum rc_status
mat_write(FILE *out, struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
          struct rc_err *err)
{
    const struct rc_grid *g = frame[0];
    const struct rc_code code = {.raw = rc_export_raw(g, wish, TYPES)};
    bool single = code.raw == RC_RAW_F32;
    size_t bytes = rc_raw_width(code.raw);
    RC_ENDS(rc_buffer_free) struct rc_buffer head = {0};
    RC_ENDS(rc_buffer_free) struct rc_buffer end = {0};
    char name[NAME_MOST + 1];

    (void)frames;
    if (g->nx > BYTES_MOST / bytes / g->ny)
        return rc_err_set(
            err,
            "%zu x %zu values are more than the 2 GiB of an array in MAT version 5: write hdf5",
            g->nx, g->ny);
    bytes *= g->nx * g->ny;
    make_name(name, g->channel);
    rc_buffer_print(&head, "%-*.*s", TEXT_SIZE, TEXT_SIZE, "MATLAB 5.0 MAT-file, by libcontact");
    rc_buffer_u64(&head, 0);
    rc_buffer_u16(&head, 0x0100);
    rc_buffer_add(&head, "IM", 2);
    put_number(&head, "dx", g->dx);
    put_number(&head, "dy", g->dy);
    put_text(&head, "dunit", rc_grid_dunit(g));
    put_text(&head, "unit", g->unit);
    start_array(&head, name, single ? SINGLE_ARRAY : DOUBLE_ARRAY, g->ny, g->nx,
                single ? SINGLE : DOUBLE, bytes);
    put_padding(&end, bytes);
    return rc_buffer_write(&head, out, err) == RC_OK && put_columns(out, g, &code, err) == RC_OK
               ? rc_buffer_write(&end, out, err)
               : RC_FAIL;
}

const struct rc_export rc_export_mat = {
    .name = "mat",
    .suffixes = ".mat",
    .summary = "MATLAB array, MAT version 5, with dx, dy and the units beside it",
    .types = TYPES,
    .write = mat_write,
};
