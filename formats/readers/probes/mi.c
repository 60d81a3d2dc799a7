/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * PicoView MI (Molecular Imaging, Agilent): lines with the key in the first 14 columns, and a line "data"
 * that says how the numbers are stored. Then come the numbers of all buffers in sequence, little-endian, the
 * bottom row first. A value is number / 2^(bits-1) * bufferRange in bufferUnit.
 */
#include <math.h>

#include "formats/format.h"

enum {
    KEY = 14
};

struct mi {
    double columns, rows, width, height;
    struct rc_piece type, storage;
};

static const struct rc_field fields[] = {
    {"fileType", RC_FIELD_TEXT, offsetof(struct mi, type)},
    {"xPixels", RC_FIELD_NUMBER, offsetof(struct mi, columns)},
    {"yPixels", RC_FIELD_NUMBER, offsetof(struct mi, rows)},
    {"xLength", RC_FIELD_LENGTH, offsetof(struct mi, width)},
    {"yLength", RC_FIELD_LENGTH, offsetof(struct mi, height)},
    {"data", RC_FIELD_TEXT, offsetof(struct mi, storage)},
};

static const struct rc_keep keys[] = {
    {"version", "file.version"},
    {"dateAcquired", "file.date"},
    {"comment", "file.comment"},
    {"mode", "file.mode"},
};

static const struct {
    const char *name;
    enum rc_raw raw;
    int bits;
} storages[] = {
    {"BINARY", RC_RAW_I16, 16},
    {"BINARY_32", RC_RAW_I32, 32},
};

static bool
has_magic(const struct rc_file *file)
{
    return rc_file_holds(file, 0, "fileType      ", KEY);
}

/* A line that belongs to a buffer; each label begins the next one. */
static enum rc_status
take_buffer(struct rc_maps *maps, struct rc_map **map, struct rc_piece key, struct rc_piece value,
            struct rc_err *err)
{
    if (rc_piece_is(key, "bufferLabel"))
        *map = rc_maps_add(maps, value);
    if (*map == NULL)
        return RC_OK;
    if (rc_piece_is(key, "bufferUnit"))
        rc_map_unit(*map, value);
    if (rc_piece_is(key, "bufferRange") && !rc_piece_number(value, &(*map)->scale, NULL))
        return rc_err_set(err, "bufferRange is '%s': that is not a number", rc_piece_shown(value));
    return RC_OK;
}

static enum rc_status
place_buffers(const struct mi *m, size_t at, struct rc_maps *maps, struct rc_err *err)
{
    size_t s = 0, nx, ny, bytes;

    if (rc_map_count("columns (xPixels)", m->columns, &nx, err) != RC_OK ||
        rc_map_count("rows (yPixels)", m->rows, &ny, err) != RC_OK)
        return RC_FAIL;
    while (s < sizeof storages / sizeof *storages && !rc_piece_is(m->storage, storages[s].name))
        s++;
    if (s == sizeof storages / sizeof *storages)
        return rc_err_set(err, "the data are stored as '%s': only BINARY and BINARY_32 are read",
                          rc_piece_shown(m->storage));
    if (rc_size_mul(nx * rc_raw_width(storages[s].raw), ny, &bytes, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < maps->n && k < RC_MAPS_MOST; k++) {
        struct rc_map *map = &maps->map[k];

        map->nx = nx;
        map->ny = ny;
        map->dx = m->width / (double)nx;
        map->dy = m->height / (double)ny;
        map->raw = storages[s].raw;
        map->scale = ldexp(map->scale, 1 - storages[s].bits);
        map->bottom_first = true;
        map->at = at;
        at = bytes > SIZE_MAX - at ? SIZE_MAX : at + bytes;
    }
    return RC_OK;
}

static enum rc_status
mi_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    const char *text = (const char *)file->data;
    struct rc_lines lines = rc_piece_lines(rc_file_piece(file));
    struct mi m = {.width = NAN, .height = NAN};
    struct rc_map *map = NULL;
    struct rc_piece line;

    while (m.storage.n == 0) {
        struct rc_piece key, value;

        if (!rc_lines_next(&lines, &line.text, &line.n))
            return rc_err_set(err, "the header does not end: there is no line 'data'");
        key = rc_piece_trim((struct rc_piece){line.text, line.n < KEY ? line.n : KEY});
        value = line.n < KEY ? (struct rc_piece){"", 0}
                             : rc_piece_trim((struct rc_piece){line.text + KEY, line.n - KEY});
        if (rc_field_take(fields, sizeof fields / sizeof *fields, key, value, &m, err) != RC_OK ||
            take_buffer(maps, &map, key, value, err) != RC_OK)
            return RC_FAIL;
        rc_maps_keep(maps, keys, sizeof keys / sizeof *keys, key, value);
    }
    if (!rc_piece_is(m.type, "Image"))
        return rc_err_set(err, "the file is not an image but '%s'", rc_piece_shown(m.type));
    return place_buffers(&m, (size_t)(lines.at - text), maps, err);
}

const struct rc_format rc_format_mi = {
    .name = "mi",
    .suffixes = ".mi",
    .summary = "PicoView (Molecular Imaging, Agilent) images",
    .is = has_magic,
    .refusal = "no MI file: it does not begin with fileType",
    .find = mi_find,
};
