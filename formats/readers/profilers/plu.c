/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Sensofar PLU is little-endian. It has a date as text, the sizes twice in the header, and 32-bit floats in
 * micrometres from byte 508 on, row 0 first. 1000001 marks a missing point.
 */
#include <string.h>

#include "formats/format.h"

enum {
    DATE = 128, /* bytes of its text */
    AT_ROWS = 0x184,
    AT_COLUMNS = 0x188,
    AT_X = 0x194,
    AT_Y = 0x198,
    AT_TYPE = 0x1ac,
    AT_ROWS_AGAIN = 0x1f4,
    AT_COLUMNS_AGAIN = 0x1f8,
    HEADER = 0x1fc,
    MISSING = 1000001,
    TOPOGRAPHY = 3
};

static const char *const types[] = {"an image",    "a profile",   "profiles",      NULL,
                                    "coordinates", "thicknesses", "something else"};

static bool
sizes_agree(const struct rc_file *file)
{
    return file->size >= HEADER && memcmp(file->data + AT_ROWS, file->data + AT_ROWS_AGAIN, 8) == 0;
}

static enum rc_status
plu_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));
    double type;

    if (!sizes_agree(file))
        return rc_err_set(err, "no PLU map: bytes %d to %d should repeat the sizes at byte %d",
                          AT_ROWS_AGAIN, HEADER - 1, AT_ROWS);
    if (rc_map_size(map, rc_bytes_at(&b, AT_COLUMNS, RC_RAW_U32), NULL,
                    rc_bytes_at(&b, AT_ROWS, RC_RAW_U32), NULL, err) != RC_OK)
        return RC_FAIL;
    type = rc_bytes_at(&b, AT_TYPE, RC_RAW_U32);
    if (type != TOPOGRAPHY)
        return rc_err_set(err, "the file has %s (type %g), but only topographies are read",
                          types[type < 6 ? (size_t)type : 6], type);
    rc_map_unit(map, rc_piece_of("um"));
    map->raw = RC_RAW_F32;
    map->at = HEADER;
    map->dx = rc_bytes_at(&b, AT_X, RC_RAW_F32) * 1e-6;
    map->dy = rc_bytes_at(&b, AT_Y, RC_RAW_F32) * 1e-6;
    map->missing_from = map->missing_to = MISSING;
    rc_maps_key(maps, "file.date", rc_file_text(file, 0, DATE));
    return RC_OK;
}

/* There is no magic: the day of the week and the sizes that agree with the length. */
static int
plu_score(const struct rc_file *file)
{
    static const char days[] = "MonTueWedThuFriSatSun";
    struct rc_maps maps = {0};
    bool has_day = false;

    if (!sizes_agree(file))
        return 0;
    for (size_t k = 0; k < 7; k++)
        has_day = has_day || rc_file_holds(file, 0, days + 3 * k, 3);
    if (!has_day && !rc_file_named(file, ".plu"))
        return 0;
    if (plu_find(file, &maps, NULL) == RC_OK)
        return has_day ? 80 : 40;
    return has_day ? 20 : 0; /* so that the refusal names the contents */
}

const struct rc_format rc_format_plu = {
    .name = "plu",
    .suffixes = ".plu",
    .summary = "Sensofar confocal and interferometric maps",
    .score = plu_score,
    .find = plu_find,
};
