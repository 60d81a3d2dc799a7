/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Gwyddion Simple Field: a line that says so, `key = value` lines, and 1 to 4 NUL up to a multiple of 4
 * bytes. Then follow 32-bit floats, little-endian, the top row first; NaN is a missing point.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

static const char magic[] = "Gwyddion Simple Field 1.0\n";

struct gsf {
    double columns, rows, width, height;
    struct rc_piece xy, z, title;
};

static const struct rc_field fields[] = {
    {"XRes", RC_FIELD_NUMBER, offsetof(struct gsf, columns)},
    {"YRes", RC_FIELD_NUMBER, offsetof(struct gsf, rows)},
    {"XReal", RC_FIELD_NUMBER, offsetof(struct gsf, width)},
    {"YReal", RC_FIELD_NUMBER, offsetof(struct gsf, height)},
    {"XYUnits", RC_FIELD_TEXT, offsetof(struct gsf, xy)},
    {"ZUnits", RC_FIELD_TEXT, offsetof(struct gsf, z)},
    {"Title", RC_FIELD_TEXT, offsetof(struct gsf, title)},
};

static enum rc_status
gsf_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    const char *text = (const char *)file->data, *nul;
    struct gsf g = {.width = NAN, .height = NAN, .xy = {"", 0}, .z = {"", 0}, .title = {"", 0}};
    struct rc_lines lines = {.at = text + strlen(magic)};
    struct rc_map *map;

    if ((nul = memchr(text, '\0', file->size)) == NULL)
        return rc_err_set(err, "the header does not end: there is no NUL behind it");
    lines.end = nul;
    if (rc_fields_read(fields, sizeof fields / sizeof *fields, &lines, "=", NULL, &g, err) != RC_OK)
        return RC_FAIL;
    map = rc_maps_add(maps, g.title);
    if (rc_map_size(map, g.columns, "XRes", g.rows, "YRes", err) != RC_OK)
        return RC_FAIL;
    map->raw = RC_RAW_F32;
    map->at = (size_t)(nul - text) / 4 * 4 + 4;
    rc_map_steps(map, g.width / g.columns, g.height / g.rows, g.xy);
    rc_map_unit(map, g.z);
    return RC_OK;
}

const struct rc_format rc_format_gsf = {
    .name = "gsf",
    .suffixes = ".gsf",
    .summary = "Gwyddion Simple Field",
    .magic = {{magic, sizeof magic - 1}},
    .refusal = "no GSF file: it does not begin with Gwyddion Simple Field 1.0",
    .find = gsf_find,
};
