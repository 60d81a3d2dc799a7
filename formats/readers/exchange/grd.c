/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Surfer grids, bottom row first, have three kinds. DSAA is text: columns and rows, limits of x, y and z, the
 * values. DSBB is the same in binary with 32-bit floats. DSRB has sections of a name, a length and bytes. The
 * outermost nodes are on the limits. The files have no unit.
 */
#include <math.h>

#include "formats/format.h"

#define BLANK 1.70141e38 /* this value and larger ones: missing */

enum {
    SECTION = 8,  /* bytes before a section: name, i32 length */
    GRID = 72,    /* i32 rows, columns, f64 x, y, dx, dy, z limits, rotation, blank */
    OLD_DATA = 56 /* first byte of the values of DSBB */
};

static void
set_limits(struct rc_map *map, const double limit[4])
{
    double dx = (limit[1] - limit[0]) / ((double)map->nx - 1);
    double dy = (limit[3] - limit[2]) / ((double)map->ny - 1);

    rc_map_hint(map, dx, map->ny > 1 ? dy : dx);
}

static enum rc_status
find_text(const struct rc_file *file, struct rc_map *map, struct rc_err *err)
{
    struct rc_piece text = {(const char *)file->data + 4, file->size - 4};
    double head[8];

    if (rc_flow_read(&text, head, 8, err) != RC_OK ||
        rc_map_size(map, head[0], NULL, head[1], NULL, err) != RC_OK)
        return RC_FAIL;
    set_limits(map, head + 2);
    return rc_map_is_text(map, file, file->size - text.n, err);
}

static enum rc_status
find_old(const struct rc_file *file, struct rc_map *map, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    double limit[4];

    if (rc_map_size(map, rc_bytes_at(&b, 4, RC_RAW_I16), NULL, rc_bytes_at(&b, 6, RC_RAW_I16), NULL,
                    err) != RC_OK)
        return RC_FAIL;
    b.at = 8;
    rc_bytes_values(&b, RC_RAW_F64, limit, 4);
    map->raw = RC_RAW_F32;
    map->at = OLD_DATA;
    set_limits(map, limit);
    return RC_OK;
}

static enum rc_status
find_new(const struct rc_file *file, struct rc_map *map, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    double dx = NAN, dy = NAN, n, nx = NAN, ny = NAN;

    for (size_t at = 0; file->size - at >= SECTION; at += SECTION + (size_t)n) {
        n = rc_bytes_at(&b, at + 4, RC_RAW_I32);
        if (n < 0 || n > (double)(file->size - at - SECTION))
            return rc_err_set(
                err, "section '%s' at byte %zu promises %g bytes, and the file has %zu bytes",
                rc_text_shown((const char *)file->data + at, 4), at, n, file->size);
        if (rc_file_holds(file, at, "GRID", 4) && n >= GRID) {
            ny = rc_bytes_at(&b, at + SECTION, RC_RAW_I32);
            nx = rc_bytes_at(&b, at + SECTION + 4, RC_RAW_I32);
            dx = rc_bytes_at(&b, at + SECTION + 24, RC_RAW_F64);
            dy = rc_bytes_at(&b, at + SECTION + 32, RC_RAW_F64);
            map->missing_from = rc_bytes_at(&b, at + SECTION + 64, RC_RAW_F64);
            if (rc_bytes_at(&b, at + SECTION + 56, RC_RAW_F64) != 0)
                return rc_err_set(err, "the grid is rotated: that is not read");
        }
        if (rc_file_holds(file, at, "DATA", 4) && map->at == 0) {
            map->at = at + SECTION;
            map->more = (size_t)n;
        }
    }
    if (rc_map_size(map, nx, NULL, ny, NULL, err) != RC_OK)
        return RC_FAIL;
    if (map->at == 0 || (double)map->more < 8 * nx * ny)
        return rc_err_set(err, "%zu x %zu values are promised, the section DATA has %zu bytes",
                          map->nx, map->ny, map->more);
    map->raw = RC_RAW_F64;
    rc_map_hint(map, dx, dy);
    return RC_OK;
}

static enum rc_status
grd_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));

    map->bottom_first = true;
    map->missing_from = BLANK;
    map->missing_to = INFINITY;
    return rc_file_holds(file, 0, "DSAA", 4)   ? find_text(file, map, err)
           : rc_file_holds(file, 0, "DSBB", 4) ? find_old(file, map, err)
                                               : find_new(file, map, err);
}

const struct rc_format rc_format_grd = {
    .name = "grd",
    .suffixes = ".grd",
    .summary = "Surfer grids: text, version 6 and 7",
    .magic = {{"DSAA", 4}, {"DSBB", 4}, {"DSRB", 4}},
    .sure = 90,
    .refusal = "no Surfer grid: it begins with none of DSAA, DSBB, DSRB",
    .find = grd_find,
};
