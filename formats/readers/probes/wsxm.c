/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * WSxM (Nanotec): a text header that states its size, then the numbers, little-endian, from the bottom right
 * corner backwards. Only Z Amplitude, the height from the lowest to the highest number, gives their scale: a
 * value is number * amplitude / (highest - lowest).
 *
 *     WSxM file copyright ...
 *     SxM Image file
 *     Image header size: 2996
 *
 *     [General Info]
 *
 *         Image Data Type: short
 *         Z Amplitude: 59.7449 nm
 */
#include <math.h>

#include "formats/format.h"

struct wsxm {
    double header, columns, rows, width, height;
    struct rc_piece type, amplitude, channel, date, comment;
};

static const struct rc_field fields[] = {
    {"Image header size", RC_FIELD_NUMBER, offsetof(struct wsxm, header)},
    {"Number of columns", RC_FIELD_NUMBER, offsetof(struct wsxm, columns)},
    {"Number of rows", RC_FIELD_NUMBER, offsetof(struct wsxm, rows)},
    {"X Amplitude", RC_FIELD_LENGTH, offsetof(struct wsxm, width)},
    {"Y Amplitude", RC_FIELD_LENGTH, offsetof(struct wsxm, height)},
    {"Z Amplitude", RC_FIELD_TEXT, offsetof(struct wsxm, amplitude)},
    {"Image Data Type", RC_FIELD_TEXT, offsetof(struct wsxm, type)},
    {"Acquisition channel", RC_FIELD_TEXT, offsetof(struct wsxm, channel)},
    {"Acquisition time", RC_FIELD_TEXT, offsetof(struct wsxm, date)},
    {"Comments", RC_FIELD_TEXT, offsetof(struct wsxm, comment)},
};

static const struct {
    const char *name;
    enum rc_raw raw;
} types[] = {
    {"short|short data", RC_RAW_I16},
    {"float", RC_RAW_F32},
    {"double", RC_RAW_F64},
};

static bool
has_magic(const struct rc_file *file)
{
    struct rc_piece start = {(const char *)file->data, file->size < 200 ? file->size : 200};

    return rc_file_holds(file, 0, "WSxM file copyright", 19) &&
           rc_piece_find(start, "SxM Image file") != NULL;
}

/* Sets the scale from the amplitude and the numbers, which lie in the file as the map says. */
static enum rc_status
set_scale(const struct rc_file *file, const struct wsxm *w, struct rc_map *map, struct rc_err *err)
{
    double amplitude, low, high;
    struct rc_piece unit;

    if (!rc_piece_number(w->amplitude, &amplitude, &unit))
        return rc_err_set(err, "Z Amplitude is '%s': that is not a number",
                          rc_piece_shown(w->amplitude));
    rc_map_unit(map, unit);
    if (rc_map_range(map, file, &low, &high) && high > low)
        map->scale = amplitude / (high - low);
    return RC_OK;
}

static enum rc_status
wsxm_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_lines lines = rc_piece_lines(rc_file_piece(file));
    struct wsxm w = {
        .width = NAN, .height = NAN, .amplitude = {"", 0}, .channel = {"", 0}, .date = {"", 0}};
    struct rc_map *map;
    size_t t = 0;

    if (rc_fields_read(fields, sizeof fields / sizeof *fields, &lines, ":", "[Header end]", &w,
                       err) != RC_OK)
        return RC_FAIL;
    if (!(w.header >= 0 && w.header <= (double)file->size))
        return rc_err_set(err, "the header takes %g bytes of a file of %zu", w.header, file->size);
    map = rc_maps_add(maps, w.channel);
    if (rc_map_size(map, w.columns, NULL, w.rows, NULL, err) != RC_OK)
        return RC_FAIL;
    while (t < sizeof types / sizeof *types && w.type.n > 0 && !rc_piece_is(w.type, types[t].name))
        t++;
    if (t == sizeof types / sizeof *types)
        return rc_err_set(err, "Image Data Type is '%s': short, float and double are read",
                          rc_piece_shown(w.type));
    map->raw = types[t].raw; /* old files give none: short */
    map->at = (size_t)w.header;
    map->dx = w.width / (double)map->nx;
    map->dy = w.height / (double)map->ny;
    map->bottom_first = map->right_first = true;
    rc_maps_key(maps, "file.date", w.date);
    if (w.comment.n > 0)
        rc_maps_key(maps, "file.comment", w.comment);
    return set_scale(file, &w, map, err);
}

const struct rc_format rc_format_wsxm = {
    .name = "wsxm",
    .suffixes = ".stp .top",
    .summary = "WSxM (Nanotec) images",
    .is = has_magic,
    .refusal = "no WSxM image: it does not begin with 'WSxM file copyright' and 'SxM Image file'",
    .find = wsxm_find,
};
