/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * TrueMap: a line that says so, a comment that ends in NUL, sizes, lengths and offsets, 32-bit
 * floats, little-endian, row 0 first. There is no unit in the file. It is millimetres from GelSight, which
 * leaves the comment empty. Where TrueMap wrote it micrometres are taken, as surfalize 0.19.2 does; Gwyddion
 * 2.71 and SurfaceTopography 1.27.1 take millimetres there too, hence the doubt.
 */
#include <string.h>

#include "formats/format.h"

enum {
    MAGIC = 32,
    NUMBERS = 24 /* bytes: i32 columns, rows, f32 width, height, two offsets */
};

static const char magic[MAGIC + 1] = "Binary TrueMap Data File v2.0\r\n";

static enum rc_status
tmd_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));
    const unsigned char *comment, *nul;
    size_t at, n;

    comment = file->data + MAGIC;
    if ((nul = memchr(comment, 0, file->size - MAGIC)) == NULL)
        return rc_err_set(err, "the comment does not end: there is no NUL behind it");
    n = (size_t)(nul - comment);
    at = MAGIC + n + 1;
    if (rc_map_size(map, rc_bytes_at(&b, at, RC_RAW_I32), NULL, rc_bytes_at(&b, at + 4, RC_RAW_I32),
                    NULL, err) != RC_OK)
        return RC_FAIL;
    rc_map_unit(map, rc_piece_of(n == 0 ? "mm" : "um"));
    if (n > 0)
        map->doubt = "the file gives no unit, and micrometres are assumed; other programs assume "
                     "millimetres: if the map is 1000 times too small, give --z-unit mm and --dx";
    map->raw = RC_RAW_F32;
    map->at = at + NUMBERS;
    map->dx = rc_bytes_at(&b, at + 8, RC_RAW_F32) * map->si / (double)map->nx;
    map->dy = rc_bytes_at(&b, at + 12, RC_RAW_F32) * map->si / (double)map->ny;
    rc_maps_key(maps, "file.comment", (struct rc_piece){(const char *)comment, n});
    return RC_OK;
}

const struct rc_format rc_format_tmd = {
    .name = "tmd",
    .suffixes = ".tmd",
    .summary = "TrueMap, GelSight",
    .magic = {{magic, MAGIC}},
    .refusal = "no TrueMap file: it does not begin with 'Binary TrueMap Data File v2.0'",
    .find = tmd_find,
};
