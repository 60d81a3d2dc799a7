/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Wyko OPD: the directory begins at byte 2, and the blocks follow it in the same order. The heights are in
 * one block, column by column, the bottom row first, in units of the wavelength over Mult. Each of the other
 * relevant blocks holds one number or text.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    START = 2,
    ENTRY = 24, /* bytes of a directory entry: 16 of name, i16 type, i32 length, u16 attribute */
    NAME = 16,
    MATRIX = 6 /* bytes before the numbers of a matrix: columns, rows, size of a number      */
};

struct block {
    struct rc_piece name;
    int type; /* 6: int16, 7: float, 8: double, 12: int32; other ones are not numbers */
    size_t at, n;
};

struct opd {
    struct block heights;
    double wavelength, pixel, aspect, factor;
};

static const struct rc_keep texts[] = {
    {"Title", "file.title"},
    {"Date", "file.date"},
    {"Time", "file.time"},
    {"Note", "file.comment"},
};

static bool
has_directory(const struct rc_file *file)
{
    return file->size >= START + ENTRY && rc_file_holds(file, 0, "\1", 2) &&
           rc_file_holds(file, START, "Directory", 10);
}

/* The type of the number of a block. It comes from its type field, or from known files. */
static enum rc_raw
number_of(const struct block *b, enum rc_raw usual)
{
    return b->type == 6    ? RC_RAW_I16
           : b->type == 7  ? RC_RAW_F32
           : b->type == 8  ? RC_RAW_F64
           : b->type == 12 ? RC_RAW_I32
                           : usual;
}

static void
take_block(const struct rc_file *file, struct block b, struct opd *o, struct rc_maps *maps)
{
    static const struct {
        const char *name;
        enum rc_raw raw;
        size_t at;
    } numbers[] = {
        {"Wavelength", RC_RAW_F32, offsetof(struct opd, wavelength)},
        {"Pixel_size", RC_RAW_F32, offsetof(struct opd, pixel)},
        {"Aspect", RC_RAW_F32, offsetof(struct opd, aspect)},
        {"Mult", RC_RAW_I16, offsetof(struct opd, factor)},
    };
    struct rc_bytes bytes = rc_file_bytes(file, false);

    if (rc_piece_is(b.name, "RAW_DATA|RAW DATA|Raw") && b.n >= MATRIX && o->heights.n == 0)
        o->heights = b;
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        enum rc_raw raw = number_of(&b, numbers[k].raw);

        if (rc_piece_is(b.name, numbers[k].name) && b.n >= rc_raw_width(raw)) {
            double value = rc_bytes_at(&bytes, b.at, raw);
            memcpy((char *)o + numbers[k].at, &value, sizeof value);
        }
    }
    rc_maps_keep(maps, texts, sizeof texts / sizeof *texts, b.name, rc_file_text(file, b.at, b.n));
}

static enum rc_status
read_directory(const struct rc_file *file, struct opd *o, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_bytes bytes = rc_file_bytes(file, false);
    double length = rc_bytes_at(&bytes, START + NAME + 2, RC_RAW_I32);
    size_t entries, at;

    if (!(length >= ENTRY) || length > (double)(file->size - START))
        return rc_err_set(err, "the directory takes %g bytes, the file has %zu", length,
                          file->size);
    entries = (size_t)length / ENTRY;
    at = START + (size_t)length;
    for (size_t k = 1; k < entries; k++) {
        size_t entry = START + ENTRY * k;
        const char *name = (const char *)file->data + entry;
        struct block b = {
            {name, strnlen(name, NAME)}, (int)rc_bytes_at(&bytes, entry + NAME, RC_RAW_I16), at, 0};

        length = rc_bytes_at(&bytes, entry + NAME + 2, RC_RAW_I32);
        if (length < 0 || length > (double)(file->size - at))
            return rc_err_set(err,
                              "block '%s' takes %g bytes from byte %zu on, the file has %zu in all",
                              rc_piece_shown(b.name), length, at, file->size);
        b.n = (size_t)length;
        at += b.n;
        b.name = rc_piece_trim(b.name);
        take_block(file, b, o, maps);
    }
    return RC_OK;
}

static enum rc_status
opd_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct opd o = {.wavelength = NAN, .pixel = NAN, .aspect = 1, .factor = 1};
    struct rc_bytes bytes = rc_file_bytes(file, false);
    struct rc_map *map;
    double size;

    if (read_directory(file, &o, maps, err) != RC_OK)
        return RC_FAIL;
    if (o.heights.n == 0)
        return rc_err_set(err, "the file has no block RAW_DATA, RAW DATA or Raw");
    map = rc_maps_add(maps, rc_piece_of(""));
    if (rc_map_size(map, rc_bytes_at(&bytes, o.heights.at, RC_RAW_U16), NULL,
                    rc_bytes_at(&bytes, o.heights.at + 2, RC_RAW_U16), NULL, err) != RC_OK)
        return RC_FAIL;
    size = rc_bytes_at(&bytes, o.heights.at + 4, RC_RAW_U16);
    if (size != 2 && size != 4)
        return rc_err_set(err, "a height takes %g bytes: it must take 2 or 4", size);
    if ((double)(o.heights.n - MATRIX) < (double)map->nx * (double)map->ny * size)
        return rc_err_set(err, "the header promises %zu x %zu heights, their block has %zu bytes",
                          map->nx, map->ny, o.heights.n);
    map->at = o.heights.at + MATRIX;
    map->by_columns = map->bottom_first = true;
    map->raw = size == 2 ? RC_RAW_I16 : RC_RAW_F32;
    /* rounded to a float, which the constant alone is not where floats are computed as doubles */
    map->missing_from = size == 2 ? 32766 : (double)(float)1e38;
    map->missing_to = INFINITY;
    map->scale = (isnan(o.wavelength) ? 1 : o.wavelength) / o.factor;
    map->dx = o.pixel * 1e-3;
    map->dy = o.pixel * o.aspect * 1e-3;
    if (isnan(o.wavelength)) /* the numbers are in units of it: the user has to say it */
        return RC_OK;
    rc_map_unit(map, rc_piece_of("nm"));
    return RC_OK;
}

const struct rc_format rc_format_opd = {
    .name = "opd",
    .suffixes = ".opd",
    .summary = "Wyko (Veeco, Bruker) interferometers",
    .is = has_directory,
    .refusal = "no OPD file: it does not begin with a directory",
    .find = opd_find,
};
