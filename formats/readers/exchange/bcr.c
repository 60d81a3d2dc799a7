/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * BCR and BCRF (ImageMet): a header of key = value lines, filled up to 2048 bytes, then numbers, row 0 first.
 * They are 16-bit in bit2nm nanometres, or 32-bit floats in zunit. Where zmin is given, the lowest of them is
 * at that height. In the "unicode" kind the header is of two-byte characters in 4096 bytes.
 */
#include <math.h>

#include "formats/format.h"

enum {
    HEADER = 2048 /* characters */
};

struct bcr {
    double header, columns, rows, width, height, bit2nm, order, missing, lowest;
    struct rc_piece x_unit, y_unit, z_unit;
};

static const struct rc_field fields[] = {
    {"headersize", RC_FIELD_NUMBER, offsetof(struct bcr, header)},
    {"xpixels", RC_FIELD_NUMBER, offsetof(struct bcr, columns)},
    {"ypixels", RC_FIELD_NUMBER, offsetof(struct bcr, rows)},
    {"xlength", RC_FIELD_NUMBER, offsetof(struct bcr, width)},
    {"ylength", RC_FIELD_NUMBER, offsetof(struct bcr, height)},
    {"bit2nm", RC_FIELD_NUMBER, offsetof(struct bcr, bit2nm)},
    {"intelmode", RC_FIELD_NUMBER, offsetof(struct bcr, order)},
    {"voidpixels", RC_FIELD_NUMBER, offsetof(struct bcr, missing)},
    {"zmin", RC_FIELD_NUMBER, offsetof(struct bcr, lowest)},
    {"xunit", RC_FIELD_TEXT, offsetof(struct bcr, x_unit)},
    {"yunit", RC_FIELD_TEXT, offsetof(struct bcr, y_unit)},
    {"zunit", RC_FIELD_TEXT, offsetof(struct bcr, z_unit)},
};

static const struct {
    const char *magic;
    size_t n;
    bool is_wide, is_float;
} kinds[] = {
    {"fileformat = bcrf_unicode", 25, false, true}, /* said so and not done */
    {"fileformat = bcrf", 17, false, true},
    {"fileformat = bcrstm", 19, false, false},
    {"f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0 \0=\0 \0b\0c\0r\0f\0", 34, true, true},
    {"f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0 \0=\0 \0b\0c\0r\0s\0t\0m\0", 38, true, false},
};

/* The index into kinds, or their number for another file. *mark: the bytes of the byte order mark. */
static size_t
kind_of(const struct rc_file *file, size_t *mark)
{
    size_t kind = 0;

    *mark = rc_file_holds(file, 0, "\xff\xfe", 2) ? 2 : 0;
    while (kind < sizeof kinds / sizeof *kinds &&
           !rc_file_holds(file, *mark, kinds[kind].magic, kinds[kind].n))
        kind++;
    return kind;
}

static double
length(double number, struct rc_piece unit)
{
    return number * (unit.n == 0 ? 1e-9 : rc_piece_metres(unit));
}

static enum rc_status
bcr_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct bcr b = {.width = NAN,
                    .height = NAN,
                    .bit2nm = 1,
                    .order = 1,
                    .missing = NAN,
                    .lowest = NAN,
                    .header = NAN};
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));
    size_t mark, kind = kind_of(file, &mark), n = 0, wide;
    char header[HEADER];
    double low, high;
    struct rc_lines lines = {.at = header};

    wide = kinds[kind].is_wide ? 2 : 1;
    for (size_t at = mark; n < HEADER && at + wide <= file->size; at += wide)
        header[n++] = (char)file->data[at]; /* the micro sign becomes that of Latin-1 */
    lines.end = header + n;
    if (rc_fields_read(fields, sizeof fields / sizeof *fields, &lines, "=", NULL, &b, err) !=
            RC_OK ||
        rc_map_size(map, b.columns, "xpixels", b.rows, "ypixels", err) != RC_OK)
        return RC_FAIL;
    map->at = HEADER * wide;
    if (b.header > (double)map->at && b.header <= (double)file->size && wide == 1)
        map->at = (size_t)b.header;
    map->raw = kinds[kind].is_float ? RC_RAW_F32 : RC_RAW_I16;
    map->big = b.order == 0;
    map->dx = length(b.width, b.x_unit) / b.columns;
    map->dy = length(b.height, b.y_unit.n > 0 ? b.y_unit : b.x_unit) / b.rows;
    rc_map_unit(map, rc_piece_of("nm"));
    if (kinds[kind].is_float && b.z_unit.n > 0)
        rc_map_unit(map, b.z_unit);
    map->scale = kinds[kind].is_float ? 1 : b.bit2nm;
    map->missing_from = map->missing_to = b.missing;
    if (kinds[kind].is_float && b.missing > 1e30) {
        map->missing_from = b.missing * (1 - 1e-6); /* few digits of the largest float */
        map->missing_to = INFINITY;
    }
    if (!isnan(b.lowest) && rc_map_range(map, file, &low, &high))
        map->zero = b.lowest - (map->scale < 0 ? high : low) * map->scale;
    return RC_OK;
}

static bool
is_bcr(const struct rc_file *file)
{
    size_t mark;

    return kind_of(file, &mark) < sizeof kinds / sizeof *kinds;
}

const struct rc_format rc_format_bcr = {
    .name = "bcr",
    .suffixes = ".bcr .bcrf",
    .summary = "BCR and BCRF (ImageMet)",
    .is = is_bcr,
    .refusal = "no BCR file: it does not begin with 'fileformat = bcr'",
    .find = bcr_find,
};
