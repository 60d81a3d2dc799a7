/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * ESRI ASCII grid. Lines of a key and a number (ncols, nrows, corner, cellsize, NODATA_value) come first.
 * Then come the values, the top row first. The file has no unit.
 */
#include <math.h>

#include "formats/format.h"

struct esri {
    double columns, rows, cell, dx, dy, missing;
};

static const struct rc_field fields[] = {
    {"ncols", RC_FIELD_NUMBER, offsetof(struct esri, columns)},
    {"nrows", RC_FIELD_NUMBER, offsetof(struct esri, rows)},
    {"cellsize", RC_FIELD_NUMBER, offsetof(struct esri, cell)},
    {"dx", RC_FIELD_NUMBER, offsetof(struct esri, dx)},
    {"dy", RC_FIELD_NUMBER, offsetof(struct esri, dy)},
    {"nodata_value", RC_FIELD_NUMBER, offsetof(struct esri, missing)},
};

static bool
begins(const struct rc_file *file, const char *word)
{
    struct rc_piece text = {(const char *)file->data, file->size < 64 ? file->size : 64};

    return rc_piece_begins(rc_piece_trim(text), word);
}

static bool
has_magic(const struct rc_file *file)
{
    return begins(file, "ncols ") || begins(file, "nrows ") || begins(file, "ncols\t") ||
           begins(file, "nrows\t");
}

static enum rc_status
esri_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    const char *text = (const char *)file->data, *at = text;
    struct rc_lines lines = rc_piece_lines(rc_file_piece(file));
    struct esri e = {.cell = NAN, .dx = NAN, .dy = NAN, .missing = -9999};
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));
    struct rc_piece line, key, value;

    /* the header ends where a line does not begin with a letter */
    while (rc_lines_next(&lines, &line.text, &line.n)) {
        line = rc_piece_trim(line);
        if (line.n > 0 && (*line.text < 'A' || *line.text > 'z' || rc_piece_begins(line, "nan")))
            break;
        if (rc_piece_part(line, " \t", &key, &value) &&
            rc_field_take(fields, sizeof fields / sizeof *fields, key, value, &e, err) != RC_OK)
            return RC_FAIL;
        at = lines.at;
    }
    if (rc_map_size(map, e.columns, "ncols", e.rows, "nrows", err) != RC_OK)
        return RC_FAIL;
    if (rc_map_is_text(map, file, (size_t)(at - text), err) != RC_OK)
        return RC_FAIL;
    map->missing_from = map->missing_to = e.missing;
    rc_map_hint(map, isnan(e.dx) ? e.cell : e.dx, isnan(e.dy) ? e.cell : e.dy);
    return RC_OK;
}

const struct rc_format rc_format_esri = {
    .name = "esri",
    .suffixes = ".asc",
    .summary = "ESRI ASCII grid",
    .is = has_magic,
    .sure = 90,
    .refusal = "no ESRI grid: it does not begin with ncols or nrows",
    .find = esri_find,
};
