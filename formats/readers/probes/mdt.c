/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * NT-MDT (Nova) has 33 bytes of header. Then come frames of any kind, each with its size, type and date. Two
 * kinds are maps, little-endian, the lowest row first:
 *
 *     0    a scan: steps, offsets and codes of units of the three axes, the signal, then size and int16
 *     106  an array (MDA): its axes and its values are described by calibrations with units as text or as
 *          code of SI; those with two axes and one value are maps
 *
 * A height is number * step + offset. The layout is the one that Gwyddion, SurfaceTopography and SciFiReaders
 * read.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    HEADER = 33,
    AT_LAST = 12, /* number of the last frame, from 0 */
    FRAME = 22,
    SCAN = 0,
    ARRAY = 106,
    SCAN_VARIABLES = 36, /* bytes of the variables that are read */
    MODE = 8,
    DOTS = 14, /* before points of spectra, if there are any */
    DOT = 16,
    UNITS_FIRST = -5
};

static const char magic[] = "\x01\xb0\x93\xff";

/* Units of scans by their code, from UNITS_FIRST on. */
static const char *const units[] = {"m",   "cm",  "mm", "um", "nm", "\xc3\x85", "nA", "V",  "",
                                    "kHz", "deg", "%",  "",   "V",  "s",        "ms", "us", "ns"};

/* The recorded quantity, by the channel of the converter. */
static const char *const signals[] = {"Height",  "DFL",    "Lateral F", "Bias V",    "Current",
                                      "FB-Out",  "MAG",    "MAG*Sin",   "MAG*Cos",   "RMS",
                                      "CalcMag", "Phase1", "Phase2",    "CalcPhase", "Ex1",
                                      "Ex2",     "HvX",    "HvY",       "Snap Back"};

/* Units of arrays by their code of SI. */
static const struct {
    uint64_t code;
    const char *unit;
} si_units[] = {{0x101, "m"}, {0x100001, "A"}, {0xfffd010200, "V"}, {0x1000001, "s"}};

static const struct {
    int code;
    enum rc_raw raw;
} types[] = {{-1, RC_RAW_I8},     {1, RC_RAW_U8},      {-2, RC_RAW_I16}, {2, RC_RAW_U16},
             {-4, RC_RAW_I32},    {4, RC_RAW_U32},     {-8, RC_RAW_I64}, {8, RC_RAW_U64},
             {-5892, RC_RAW_F32}, {-13320, RC_RAW_F64}};

static struct rc_piece
unit_of(int code)
{
    size_t k = (size_t)(code - UNITS_FIRST);

    return rc_piece_of(code >= UNITS_FIRST && k < sizeof units / sizeof *units ? units[k] : "");
}

/* A text of its length before it, at the cursor; "" where it does not fit. */
static struct rc_piece
text_of(struct rc_bytes *b)
{
    size_t n = rc_bytes_u32(b);
    struct rc_piece text = {"", 0};

    if (!b->past && n <= b->size - b->at) {
        text = (struct rc_piece){(const char *)b->data + b->at, n};
        b->at += n;
    }
    return text;
}

/* ---- scans ---- */

/* The frame is the cursor's: it begins at 0 and ends with b->size. */
static enum rc_status
add_scan(struct rc_bytes *b, size_t start, size_t number, size_t variables, struct rc_maps *maps,
         struct rc_err *err)
{
    double step[3], offset[3];
    int unit[3];
    size_t signal, nx, ny, dots;
    struct rc_bytes behind = *b;
    struct rc_piece title;
    struct rc_map *map;

    for (int k = 0; k < 3; k++) {
        offset[k] = rc_bytes_at(b, FRAME + 10 * (size_t)k, RC_RAW_F32);
        step[k] = rc_bytes_at(b, b->at, RC_RAW_F32);
        unit[k] = (int)rc_bytes_at(b, b->at, RC_RAW_I16);
    }
    signal = (size_t)rc_bytes_at(b, FRAME + 30, RC_RAW_U8);
    b->at = FRAME + variables + 2;
    nx = rc_bytes_u16(b);
    ny = rc_bytes_u16(b);
    dots = rc_bytes_u16(b);
    if (b->past || variables < SCAN_VARIABLES)
        return rc_err_set(err, "frame %zu is too short for a scan", number);
    if (nx == 0 || ny == 0)
        return RC_OK; /* points of spectra alone */
    behind.at = FRAME + variables + MODE + (dots > 0 ? DOTS + DOT * dots : 0);
    if (behind.at > behind.size || nx > (behind.size - behind.at) / 2 / ny)
        return rc_err_set(err, "frame %zu promises %zu x %zu values, but has only %zu bytes",
                          number, nx, ny, b->size);
    b->at = behind.at;
    behind.at += 2 * nx * ny;
    title = text_of(&behind);
    if (title.n == 0 && signal < sizeof signals / sizeof *signals)
        title = rc_piece_of(signals[signal]);
    map = rc_maps_add(maps, title);
    map->nx = nx;
    map->ny = ny;
    map->raw = RC_RAW_I16;
    map->at = start + b->at;
    map->bottom_first = true;
    map->scale = step[2] == 0 || isnan(step[2]) ? 1 : step[2];
    map->zero = isnan(offset[2]) ? 0 : offset[2];
    rc_map_unit(map, unit_of(unit[2]));
    map->dx = fabs(step[0]) * rc_piece_metres(unit_of(unit[0]));
    map->dy = fabs(step[1]) * rc_piece_metres(unit_of(unit[1]));
    return RC_OK;
}

/* ---- arrays ---- */

struct calibration {
    struct rc_piece unit;
    double bias, scale;
    uint64_t first, last;
    int type;
};

/* Reads the calibration at the cursor, and moves the cursor behind it. */
static void
next_calibration(struct rc_bytes *b, struct calibration *c)
{
    size_t start = b->at, all = rc_bytes_u32(b), fixed = rc_bytes_u32(b), end = b->at, skip, n;
    uint64_t code;

    skip = (size_t)rc_bytes_u32(b);
    skip += rc_bytes_u32(b);
    n = rc_bytes_u32(b);
    code = rc_bytes_u64(b);
    c->bias = rc_bytes_at(b, b->at + 16, RC_RAW_F64);
    c->scale = rc_bytes_at(b, b->at, RC_RAW_F64);
    c->first = rc_bytes_u64(b);
    c->last = rc_bytes_u64(b);
    c->type = (int)rc_bytes_at(b, b->at, RC_RAW_I32);
    c->unit = (struct rc_piece){"", 0};
    for (size_t k = 0; k < sizeof si_units / sizeof *si_units; k++)
        if (si_units[k].code == code)
            c->unit = (struct rc_piece){si_units[k].unit, 1};
    if (b->past || all > b->size - start || fixed > b->size - end || skip > b->size - end - fixed ||
        n > b->size - end - fixed - skip) {
        b->past = true;
        return;
    }
    if (n > 0)
        c->unit = (struct rc_piece){(const char *)b->data + end + fixed + skip, n};
    b->at = start + all;
}

static bool
count_of(const struct calibration *c, size_t *n)
{
    uint64_t nodes = c->last - c->first + 1;

    *n = (size_t)nodes;
    return c->last >= c->first && nodes > 0 && nodes <= 1 << 30;
}

static enum rc_status
add_array(struct rc_bytes *b, size_t start, size_t number, struct rc_maps *maps, struct rc_err *err)
{
    size_t head = (size_t)rc_bytes_at(b, FRAME, RC_RAW_U32), part[6], fixed, axes, values;
    struct calibration c[3];
    struct rc_map *map;

    b->at = FRAME + 4 + 4 + 2 * 16 + 4;
    for (int k = 0; k < 5; k++) /* name, comment, view, specification, source */
        part[k] = rc_bytes_u32(b);
    b->at = FRAME + (head < b->size - FRAME ? head : b->size - FRAME);
    part[5] = b->at;
    for (int k = 0; k < 5 && !b->past; k++) {
        b->past = part[k] > b->size - b->at;
        b->at += b->past ? 0 : part[k];
    }
    rc_bytes_u32(b);
    fixed = rc_bytes_u32(b);
    values = b->at;
    axes = (size_t)rc_bytes_at(b, values + 12, RC_RAW_U32);
    if (b->past || fixed > b->size - values)
        return rc_err_set(err, "frame %zu is too short for its array", number);
    if (axes != 2 || rc_bytes_at(b, values + 16, RC_RAW_U32) != 1)
        return RC_OK; /* a curve, or spectra of points */
    b->at = values + fixed;
    for (int k = 0; k < 3; k++)
        next_calibration(b, &c[k]);
    if (b->past)
        return rc_err_set(err, "frame %zu is too short for its axes", number);
    map = rc_maps_add(maps, (struct rc_piece){(const char *)b->data + part[5], part[0]});
    if (!count_of(&c[0], &map->nx) || !count_of(&c[1], &map->ny))
        return rc_err_set(err, "frame %zu gives no sizes for its map", number);
    map->at = start + b->at;
    map->bottom_first = true;
    map->scale = c[2].scale;
    map->zero = c[2].bias;
    rc_map_unit(map, c[2].unit);
    map->dx = fabs(c[0].scale) * rc_piece_metres(c[0].unit);
    map->dy = fabs(c[1].scale) * rc_piece_metres(c[1].unit);
    for (size_t k = 0; k < sizeof types / sizeof *types; k++)
        if (types[k].code == c[2].type) {
            map->raw = types[k].raw;
            return RC_OK;
        }
    return rc_err_set(err, "the values of frame %zu have the type %d, which is not supported",
                      number, c[2].type);
}

/* ---- the file ---- */

static enum rc_status
mdt_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    size_t frames, at = HEADER;

    frames = (size_t)rc_bytes_at(&b, AT_LAST, RC_RAW_U16) + 1;
    for (size_t k = 1; k <= frames; k++) {
        struct rc_bytes frame = rc_file_bytes(file, false);
        enum rc_status status = RC_OK;
        size_t size, type, variables;

        if (at > file->size || file->size - at < FRAME)
            return rc_err_set(err, "the file ends before frame %zu of %zu", k, frames);
        size = (size_t)rc_bytes_at(&b, at, RC_RAW_U32);
        type = rc_bytes_u16(&b);
        if (size < FRAME || size > file->size - at)
            return rc_err_set(err, "frame %zu promises %zu bytes, the file has %zu for it", k, size,
                              file->size - at);
        frame.data += at;
        frame.size = size;
        variables = (size_t)rc_bytes_at(&frame, FRAME - 2, RC_RAW_U16);
        if (type == SCAN)
            status = add_scan(&frame, at, k, variables, maps, err);
        else if (type == ARRAY)
            status = add_array(&frame, at, k, maps, err);
        if (status != RC_OK)
            return RC_FAIL;
        if (type == SCAN || type == ARRAY)
            rc_maps_date(maps, frame, 8, RC_RAW_U16); /* keeps the date of the first one */
        at += size;
    }
    if (maps->n == 0)
        return rc_err_set(
            err,
            "none of the %zu frames in the file is a map: spectra, curves and texts are not read",
            frames);
    return RC_OK;
}

const struct rc_format rc_format_mdt = {
    .name = "mdt",
    .suffixes = ".mdt",
    .summary = "NT-MDT (Nova): scans and arrays of two axes",
    .magic = {{magic, 4}},
    .refusal = "no file of NT-MDT: it does not begin with the bytes 01 b0 93 ff",
    .find = mdt_find,
};
