/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Igor binary wave, version 5, in either byte order. It has 64 bytes of lengths, 320 of wave header, the
 * numbers, then texts of those lengths. A wave of one dimension is a profile, of two a map. The third one
 * counts channels, whose names are the labels of that dimension. x runs fastest, the bottom row comes first.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    DIMENSIONS = 4,
    LABEL = 32, /* bytes of one */
    AT_FORMULA = 8,
    AT_LENGTHS = 12, /* lengths of the note, data unit, units of 4 dimensions, labels of 4
                        dimensions */
    AT_TYPE = 80,
    AT_NAME = 92,
    AT_SIZES = 132,
    AT_STEPS = 148,
    AT_DATA_UNIT = 212,
    AT_UNITS = 216,
    UNIT = 4,
    DATA = 384,
    COMPLEX = 1,
    UNSIGNED = 0x40
};

/* clang-format off */
static const struct {
    int type;
    enum rc_raw raw;
} types[] = {
    {2, RC_RAW_F32},     {4, RC_RAW_F64},
    {8, RC_RAW_I8},      {0x10, RC_RAW_I16},
    {0x20, RC_RAW_I32},  {8 | UNSIGNED, RC_RAW_U8},
    {0x10 | UNSIGNED, RC_RAW_U16}, {0x20 | UNSIGNED, RC_RAW_U32},
};
/* clang-format on */

/* Microscopes of Asylum Research keep all channels in one wave, in SI units. The wave has the unit of the
 * first channel, or none; these labels show that a channel has another. Rows with a note apply only if the
 * note has the settings of such a microscope. */
/* clang-format off */
static const struct {
    const char *begins, *unit;
    bool wants_note;
} other_units[] = {
    {"Phase", "deg", false}, {"Potential", "V", false}, {"Current", "A", false}, {"Frequency", "Hz", false},
    {"Height", "m", true}, {"Amplitude", "m", true}, {"Deflection", "m", true}, {"ZSensor", "m", true},
    {"LatPhase", "deg", true}, {"Lat", "V", true}, {"UserIn", "V", true},
};
/* clang-format on */

/* The sensitivity of the height sensor in m/V, -1 where it is not calibrated; NaN where the note does
 * not give it. */
static double
sensor_of(struct rc_piece note)
{
    struct rc_lines lines = rc_piece_lines(note);
    struct rc_piece line, key, value, rest;
    double sensitivity;

    while (rc_lines_next(&lines, &line.text, &line.n))
        if (rc_piece_part(line, ":", &key, &value) && rc_piece_is(key, "ZLVDTSens") &&
            rc_piece_number(value, &sensitivity, &rest))
            return sensitivity;
    return NAN;
}

/* The unit of a channel by its label, which replaces the unit of the wave; or NULL. A second pass over a
 * line, at a distance, puts Nap before the label. */
static const char *
other_unit(struct rc_piece label, double sensor)
{
    if (rc_piece_begins(label, "Nap"))
        label = (struct rc_piece){label.text + 3, label.n - 3};
    if (rc_piece_begins(label, "ZSensor") && !(sensor > 0))
        return NULL; /* volts, or the unit of the wave */
    for (size_t k = 0; k < sizeof other_units / sizeof *other_units; k++)
        if (rc_piece_begins(label, other_units[k].begins) &&
            (!other_units[k].wants_note || !isnan(sensor)))
            return other_units[k].unit;
    return NULL;
}

/* The note behind the data; empty when it is not all there. */
static struct rc_piece
note_of(const struct rc_file *file, struct rc_bytes *b, size_t after_data)
{
    double at = (double)after_data + rc_bytes_at(b, AT_FORMULA, RC_RAW_I32);
    double n = rc_bytes_at(b, AT_LENGTHS, RC_RAW_I32);

    if (!(at >= (double)after_data && n > 0 && at + n <= (double)file->size))
        return (struct rc_piece){"", 0};
    return (struct rc_piece){(const char *)file->data + (size_t)at, (size_t)n};
}

/* Where the labels of dimension 2 begin, or 0 when they are not all there. */
static size_t
labels_at(const struct rc_file *file, struct rc_bytes *b, size_t after_data, size_t count)
{
    double at = (double)after_data + rc_bytes_at(b, AT_FORMULA, RC_RAW_I32), n = 0;

    for (size_t k = 0; k < 2 + DIMENSIONS + 2; k++) { /* up to the labels of dimension 1 */
        double length = rc_bytes_at(b, AT_LENGTHS + 4 * k, RC_RAW_I32);
        if (length < 0)
            return 0;
        at += length;
    }
    n = rc_bytes_at(b, AT_LENGTHS + 4 * (2 + DIMENSIONS + 2), RC_RAW_I32);
    if (n < (double)((count + 1) * LABEL) || at < 0 || at + n > (double)file->size)
        return 0;
    return (size_t)at;
}

static enum rc_status
judge(const struct rc_file *file, struct rc_bytes *b, enum rc_raw *raw, size_t size[DIMENSIONS],
      struct rc_err *err)
{
    int version, type;
    size_t k;

    b->big = file->size >= 2 && file->data[0] == 0;
    version = (int)rc_bytes_at(b, 0, RC_RAW_I16);
    if (version != 5)
        return rc_err_set(err, "it is an Igor wave of version %d, or none: only version 5 has maps",
                          version);
    if (file->size < DATA)
        return rc_err_set(err, "the header takes %d bytes, the file has %zu", DATA, file->size);
    type = (int)rc_bytes_at(b, AT_TYPE, RC_RAW_I16);
    for (k = 0; k < sizeof types / sizeof *types && types[k].type != type; k++)
        ;
    if (k == sizeof types / sizeof *types)
        return rc_err_set(err, "the wave is of type %d%s: only real numbers are read", type,
                          type == 0               ? ", text"
                          : (type & COMPLEX) != 0 ? ", complex numbers"
                                                  : "");
    *raw = types[k].raw;
    for (k = 0; k < DIMENSIONS; k++) {
        double n = rc_bytes_at(b, AT_SIZES + 4 * k, RC_RAW_I32);
        size[k] = n > 0 ? (size_t)n : 0;
    }
    if (size[0] == 0)
        return rc_err_set(err, "the wave has no points");
    if (size[3] > 1)
        return rc_err_set(err, "the wave has 4 dimensions: a map has 2, or 3 with channels");
    if (size[1] == 0 && size[2] > 0)
        return rc_err_set(err, "the wave has %zu layers of no rows", size[2]);
    return RC_OK;
}

/* The spacings; a profile has one. */
static void
take_steps(const struct rc_file *file, struct rc_bytes *b, bool profile, struct rc_map *map)
{
    double step[2];

    for (size_t k = 0; k < 2; k++)
        step[k] = rc_bytes_at(b, AT_STEPS + 8 * (profile ? 0 : k), RC_RAW_F64);
    map->dx = step[0] * rc_piece_metres(rc_file_text(file, AT_UNITS, UNIT));
    map->dy = step[1] * rc_piece_metres(rc_file_text(file, AT_UNITS + (profile ? 0 : UNIT), UNIT));
    if (isnan(map->dx))
        rc_map_hint(map, step[0], step[1]);
}

static enum rc_status
ibw_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    size_t size[DIMENSIONS], layer, all, channels, labels;
    struct rc_piece name;
    const char *other;
    enum rc_raw raw;
    double sensor;
    bool profile;

    if (judge(file, &b, &raw, size, err) != RC_OK)
        return RC_FAIL;
    profile = size[1] == 0;
    size[1] = profile ? 1 : size[1];
    if (rc_size_mul(size[0] * rc_raw_width(raw), size[1], &layer, err) != RC_OK)
        return RC_FAIL;
    channels = size[2] == 0 ? 1 : size[2];
    if (rc_size_mul(layer, channels, &all, err) != RC_OK)
        return RC_FAIL;
    if (all > file->size - DATA)
        return rc_err_set(err,
                          "the header promises %zu x %zu x %zu values, %zu bytes, the file has %zu",
                          size[0], size[1], channels, all, file->size - DATA);
    labels = size[2] == 0 ? 0 : labels_at(file, &b, DATA + all, channels);
    sensor = sensor_of(note_of(file, &b, DATA + all));
    for (size_t k = 0; k < channels; k++) {
        struct rc_map *map;

        name = labels == 0 ? rc_file_text(file, AT_NAME, LABEL)
                           : rc_file_text(file, labels + LABEL * (k + 1), LABEL);
        map = rc_maps_add(maps, name);
        map->nx = size[0];
        map->ny = size[1];
        map->raw = raw;
        map->big = b.big;
        map->at = DATA + k * layer;
        map->bottom_first = true;
        take_steps(file, &b, profile, map);
        rc_map_unit(map, rc_file_text(file, AT_DATA_UNIT, UNIT));
        if (labels != 0 && (other = other_unit(name, sensor)) != NULL)
            rc_map_unit(map, rc_piece_of(other));
    }
    return RC_OK;
}

/* Two bytes are a weak magic: the sizes must fit as well. */
static int
ibw_score(const struct rc_file *file)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    bool named = rc_file_named(file, ".ibw");
    size_t size[DIMENSIONS];
    enum rc_raw raw;
    double version;

    b.big = file->size >= 2 && file->data[0] == 0;
    version = rc_bytes_at(&b, 0, RC_RAW_I16);
    if (b.past || (version != 1 && version != 2 && version != 3 && version != 5))
        return 0;
    if (version == 5 && judge(file, &b, &raw, size, NULL) == RC_OK)
        return named ? 95 : 70;
    return named ? 60 : 0; /* so that the refusal names the reason */
}

const struct rc_format rc_format_ibw = {
    .name = "ibw",
    .suffixes = ".ibw",
    .summary = "Igor binary waves of one to three dimensions",
    .score = ibw_score,
    .find = ibw_find,
};
