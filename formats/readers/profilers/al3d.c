/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Alicona AL3D: tags of 52 bytes (a key of 20, a value of 30, CR LF), then images at the places
 * that the tags name. The depth image is of 32-bit floats in metres, little-endian, row 0 first,
 * each row filled up to a multiple of 8 bytes.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    MAGIC = 17,
    TAG = 52,
    KEY = 20,
    VALUE = 30,
    TAGS_MOST = 10000
};

static const char magic[MAGIC + 1] = "AliconaImaging\0\r\n";

struct al3d {
    double tags, columns, rows, at, dx, dy, missing;
    struct rc_piece creator;
};

static const struct rc_field fields[] = {
    {"TagCount", RC_FIELD_NUMBER, offsetof(struct al3d, tags)},
    {"Cols", RC_FIELD_NUMBER, offsetof(struct al3d, columns)},
    {"Rows", RC_FIELD_NUMBER, offsetof(struct al3d, rows)},
    {"DepthImageOffset", RC_FIELD_NUMBER, offsetof(struct al3d, at)},
    {"PixelSizeXMeter", RC_FIELD_NUMBER, offsetof(struct al3d, dx)},
    {"PixelSizeYMeter", RC_FIELD_NUMBER, offsetof(struct al3d, dy)},
    {"InvalidPixelValue", RC_FIELD_NUMBER, offsetof(struct al3d, missing)},
    {"CreatingApplication", RC_FIELD_TEXT, offsetof(struct al3d, creator)},
};

/* Version and TagCount come first, TagCount further ones behind them. */
static enum rc_status
read_tags(const struct rc_file *file, struct al3d *a, struct rc_err *err)
{
    size_t tags = 2;

    for (size_t k = 0; k < tags; k++) {
        size_t at = MAGIC + TAG * k;

        if (at + TAG > file->size)
            return rc_err_set(err, "the file ends in tag %zu of %zu", k + 1, tags);
        if (rc_field_take(fields, sizeof fields / sizeof *fields, rc_file_text(file, at, KEY),
                          rc_file_text(file, at + KEY, VALUE), a, err) != RC_OK)
            return RC_FAIL;
        if (k == 1 && !(a->tags >= 0 && a->tags <= TAGS_MOST))
            return rc_err_set(err, "TagCount is %g: it must be 0 to %d", a->tags, TAGS_MOST);
        if (k == 1)
            tags += (size_t)a->tags;
    }
    return RC_OK;
}

static enum rc_status
al3d_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct al3d a = {.dx = NAN, .dy = NAN, .missing = NAN};
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));

    if (read_tags(file, &a, err) != RC_OK)
        return RC_FAIL;
    if (!(a.at >= MAGIC && a.at <= (double)file->size))
        return rc_err_set(err, "the depth image begins at byte %g of a file of %zu", a.at,
                          file->size);
    if (rc_map_size(map, a.columns, "Cols", a.rows, "Rows", err) != RC_OK)
        return RC_FAIL;
    strcpy(map->unit, "m");
    map->raw = RC_RAW_F32;
    map->at = (size_t)a.at;
    map->padding = map->nx % 2 * 4;
    map->dx = a.dx;
    map->dy = a.dy;
    map->missing_from = a.missing - 1e-6 * fabs(a.missing); /* it has the digits of a float */
    map->missing_to = a.missing + 1e-6 * fabs(a.missing);
    rc_maps_key(maps, "file.creator", a.creator);
    return RC_OK;
}

const struct rc_format rc_format_al3d = {
    .name = "al3d",
    .suffixes = ".al3d",
    .summary = "Alicona focus variation",
    .magic = {{magic, MAGIC}},
    .refusal = "no AL3D file: it does not begin with AliconaImaging",
    .find = al3d_find,
};
