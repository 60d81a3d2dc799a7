/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Digital Surf: a header of 512 bytes, little-endian, a comment, a part private to the writer, and
 * the heights as whole numbers, row 0 first. A height is number * step + offset in the unit of z.
 * In a compressed file the heights are in zlib streams behind a table of their lengths.
 *
 * The zero level is the header's offset. Programs are known that count from the smallest number
 * instead: then their heights differ from these by a constant.
 */
#include <stdlib.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    HEADER = 512,
    MAGIC = 12,
    PROFILE = 1,
    SURFACE = 2,
    SPECTRUM = 20,
    STREAMS_MOST = 1 << 20
};

/* Places in the header. */
enum {
    AT_TYPE = 18,
    AT_NAME = 20,
    AT_OPERATOR = 50,
    AT_MISSING = 86, /* 1: the number two below the smallest is a missing point */
    AT_BITS = 98,
    AT_LEAST = 100,
    AT_COLUMNS = 108,
    AT_ROWS = 112,
    AT_X = 120,
    AT_Y = 124,
    AT_Z = 128,
    AT_X_UNIT = 180,
    AT_Y_UNIT = 196,
    AT_Z_UNIT = 212,
    AT_COMMENT = 334,
    AT_PRIVATE = 336,
    AT_Z_OFFSET = 474,
    NAME = 30, /* bytes of a name */
    UNIT = 16
};

static const char plain[] = "DIGITAL SURF", packed[] = "DSCOMPRESSED";

/* clang-format off */
static const struct {
    int type;
    const char *name;
} other_types[] = {
    {3, "a binary image"},       {4, "a series of profiles"},  {5, "a series of surfaces"},
    {6, "a set of discs"},       {7, "a multilayer profile"},  {8, "a multilayer surface"},
    {9, "a set of discs"},       {10, "an intensity image"},   {11, "a surface with intensities"},
    {12, "a colour image"},      {13, "a surface with colours"}, {14, "a force curve"},
    {15, "a series of force curves"}, {16, "a surface with colours"}, {20, "a series of spectra"},
    {21, "a spectral map"},
};
/* clang-format on */

/* ---- compressed heights ---- */

/* The streams one behind the other; each must be in the file and together they must fill the map.
 */
static enum rc_status
unpack_all(const struct rc_file *file, const struct rc_map *map, unsigned char *to, size_t size,
           struct rc_err *err)
{
    struct rc_bytes table = rc_file_bytes(file, false);
    size_t streams = (size_t)rc_bytes_at(&table, map->more, RC_RAW_U32), at, done = 0;

    if (table.past || streams == 0 || streams > STREAMS_MOST ||
        streams > (file->size - table.at) / 8)
        return rc_err_set(err,
                          "the heights are in %zu compressed streams: there is no room for their "
                          "table in the file",
                          streams);
    at = table.at + 8 * streams;
    for (size_t k = 0; k < streams; k++) {
        size_t raw = rc_bytes_u32(&table), small = rc_bytes_u32(&table);

        if (raw > size - done || small > file->size - at)
            return rc_err_set(err,
                              "compressed stream %zu promises %zu bytes out of %zu: %zu are "
                              "wanted, %zu are there",
                              k + 1, raw, small, size - done, file->size - at);
        if (rc_inflate("heights", file->data + at, small, to + done, raw, err) != RC_OK)
            return RC_FAIL;
        done += raw;
        at += small;
    }
    return rc_bytes_agree("heights", size, done, err);
}

static unsigned char *
unpack(const struct rc_file *file, const struct rc_map *map, size_t *n, struct rc_err *err)
{
    RC_OWNED unsigned char *raw = malloc(*n = map->nx * map->ny * rc_raw_width(map->raw));

    if (raw == NULL)
        return rc_err_null(err, "out of memory for %zu bytes of heights", *n);
    return unpack_all(file, map, raw, *n, err) == RC_OK ? rc_give(&raw) : NULL;
}

/* ---- header ---- */

static enum rc_status
judge_type(int type, double rows, struct rc_err *err)
{
    if (type == PROFILE || type == SURFACE || (type == SPECTRUM && rows == 1))
        return RC_OK;
    for (size_t k = 0; k < sizeof other_types / sizeof *other_types; k++)
        if (other_types[k].type == type)
            return rc_err_set(err,
                              "the file has %s (type %d), but only surfaces and profiles are read",
                              other_types[k].name, type);
    return rc_err_set(err, "the file is of type %d: only surfaces (2) and profiles (1) are read",
                      type);
}

static double
step(const struct rc_file *file, struct rc_bytes *bytes, size_t at, size_t unit_at)
{
    struct rc_piece unit = rc_file_text(file, unit_at, UNIT);

    return rc_bytes_at(bytes, at, RC_RAW_F32) * rc_piece_metres(unit);
}

static enum rc_status
sur_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_bytes bytes = rc_file_bytes(file, false);
    bool is_packed = rc_file_holds(file, 0, packed, MAGIC);
    struct rc_map *map;
    double bits, comment_n, private_n, columns, rows;

    if (file->size < HEADER)
        return rc_err_set(err, "the header takes %d bytes, the file has %zu", HEADER, file->size);
    columns = rc_bytes_at(&bytes, AT_COLUMNS, RC_RAW_I32);
    rows = rc_bytes_at(&bytes, AT_ROWS, RC_RAW_I32);
    if (judge_type((int)rc_bytes_at(&bytes, AT_TYPE, RC_RAW_I16), rows, err) != RC_OK)
        return RC_FAIL;
    map = rc_maps_add(maps, rc_file_text(file, AT_NAME, NAME));
    if (rc_map_size(map, columns, NULL, rows, NULL, err) != RC_OK)
        return RC_FAIL;
    bits = rc_bytes_at(&bytes, AT_BITS, RC_RAW_I16);
    if (bits != 16 && bits != 32)
        return rc_err_set(err, "a height has %g bits: it must have 16 or 32", bits);
    map->raw = bits == 16 ? RC_RAW_I16 : RC_RAW_I32;
    rc_map_unit(map, rc_file_text(file, AT_Z_UNIT, UNIT));
    map->scale = rc_bytes_at(&bytes, AT_Z, RC_RAW_F32);
    map->zero = rc_bytes_at(&bytes, AT_Z_OFFSET, RC_RAW_F32);
    map->dx = step(file, &bytes, AT_X, AT_X_UNIT);
    map->dy = step(file, &bytes, AT_Y, AT_Y_UNIT);
    if (rc_bytes_at(&bytes, AT_MISSING, RC_RAW_I16) == 1)
        map->missing_from = map->missing_to = rc_bytes_at(&bytes, AT_LEAST, RC_RAW_I32) - 2;
    comment_n = rc_bytes_at(&bytes, AT_COMMENT, RC_RAW_I16);
    private_n = rc_bytes_at(&bytes, AT_PRIVATE, RC_RAW_I16);
    if (comment_n < 0 || private_n < 0 || HEADER + comment_n + private_n > (double)file->size)
        return rc_err_set(err, "comment and private part take %g and %g bytes, the file has %zu",
                          comment_n, private_n, file->size);
    map->at = HEADER + (size_t)comment_n + (size_t)private_n;
    if (is_packed) {
        map->unpack = unpack;
        map->more = map->at;
        map->at = 0;
        if (rc_map_bound(map, file, columns * rows * bits / 8, err) != RC_OK)
            return RC_FAIL;
    }
    rc_maps_key(maps, "file.comment", rc_file_text(file, HEADER, (size_t)comment_n));
    rc_maps_key(maps, "file.operator", rc_file_text(file, AT_OPERATOR, NAME));
    return RC_OK;
}

const struct rc_format rc_format_sur = {
    .name = "sur",
    .suffixes = ".sur .pro",
    .summary = "Digital Surf surfaces and profiles, compressed too",
    .magic = {{plain, MAGIC}, {packed, MAGIC}},
    .refusal = "not a Digital Surf file: it must begin with DIGITAL SURF or DSCOMPRESSED",
    .find = sur_find,
};
