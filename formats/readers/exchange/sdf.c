/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * SDF, the surface data file of ISO 25178-71 (EUNA 15178): as text,
 *
 *     aISO-1.0                  or aBCR-...
 *     NumPoints = 7             columns
 *     NumProfiles = 4           rows
 *     Xscale = 1.0E-6           metres
 *     ...
 *     *
 *     1.00000 0.99874 ...       times Zscale metres; BAD is a missing one
 *     *
 *
 * or binary, little-endian. The same fields take 81 bytes behind bISO-1.0 or bBCR-.... They take 85 behind
 * bISO-2.0 (ISO 25178-71:2026), whose counts have 32 bits. CheckType is 0: no checksums among the heights.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    MAGIC = 8,
    HEADER = 81, /* bytes of the binary one, of version 1 */
    WIDER = 4,   /* more in version 2, behind ROWS_AT     */
    MAKER_AT = 8,
    CREATED_AT = 18,
    CHANGED_AT = 30,
    COLUMNS_AT = 42,
    ROWS_AT = 44,
    X_AT = 46,
    Y_AT = 54,
    Z_AT = 62,
    COMPRESSION_AT = 78,
    TYPE_AT = 79,
    CHECK_AT = 80
};

struct sdf {
    struct rc_piece maker, created, changed;
    double columns, rows, dx, dy, scale, type, compression, check;
};

static const struct rc_field fields[] = {
    {"ManufacID", RC_FIELD_TEXT, offsetof(struct sdf, maker)},
    {"CreateDate", RC_FIELD_TEXT, offsetof(struct sdf, created)},
    {"ModDate", RC_FIELD_TEXT, offsetof(struct sdf, changed)},
    {"NumPoints", RC_FIELD_NUMBER, offsetof(struct sdf, columns)},
    {"NumProfiles", RC_FIELD_NUMBER, offsetof(struct sdf, rows)},
    {"Xscale", RC_FIELD_NUMBER, offsetof(struct sdf, dx)},
    {"Yscale", RC_FIELD_NUMBER, offsetof(struct sdf, dy)},
    {"Zscale", RC_FIELD_NUMBER, offsetof(struct sdf, scale)},
    {"Compression", RC_FIELD_NUMBER, offsetof(struct sdf, compression)},
    {"CheckType", RC_FIELD_NUMBER, offsetof(struct sdf, check)},
};

/* By DataType. Missing is the least number of the signed types and of floats, which may be NaN too, and the
 * largest of the unsigned ones. */
/* clang-format off */
static const struct {
    enum rc_raw raw;
    double missing;
} types[] = {
    {RC_RAW_U8, 255},
    {RC_RAW_U16, 65535},
    {RC_RAW_U32, 4294967295.0},
    {RC_RAW_F32, -FLT_MAX},
    {RC_RAW_I8, -128},
    {RC_RAW_I16, -32768},
    {RC_RAW_I32, -2147483648.0},
    {RC_RAW_F64, -DBL_MAX},
};
/* clang-format on */

static bool
begins(const struct rc_file *file, char kind)
{
    return file->size > MAGIC && *file->data == (unsigned char)kind &&
           (rc_file_holds(file, 1, "ISO-", 4) || rc_file_holds(file, 1, "BCR-", 4));
}

static enum rc_status
find_text(const struct rc_file *file, struct sdf *s, struct rc_map *map, struct rc_err *err)
{
    const char *text = (const char *)file->data;
    struct rc_lines lines = {.at = text + MAGIC, .end = text + file->size};

    if (rc_fields_read(fields, sizeof fields / sizeof *fields, &lines, "=", "*", s, err) != RC_OK)
        return RC_FAIL;
    map->at = (size_t)(lines.at - text);
    return RC_OK;
}

static enum rc_status
find_binary(const struct rc_file *file, struct sdf *s, struct rc_map *map, struct rc_err *err)
{
    struct rc_bytes bytes = rc_file_bytes(file, false);
    const char *text = (const char *)file->data;
    const size_t known = sizeof types / sizeof *types;
    bool second = rc_file_holds(file, 1, "ISO-2", 5);
    size_t more = second ? WIDER : 0;

    if (file->size < HEADER + more)
        return rc_err_set(err, "the header takes %zu bytes, the file has %zu", HEADER + more,
                          file->size);
    s->maker = (struct rc_piece){text + MAKER_AT, CREATED_AT - MAKER_AT};
    s->created = (struct rc_piece){text + CREATED_AT, CHANGED_AT - CREATED_AT};
    s->changed = (struct rc_piece){text + CHANGED_AT, COLUMNS_AT - CHANGED_AT};
    s->columns = rc_bytes_at(&bytes, COLUMNS_AT, second ? RC_RAW_U32 : RC_RAW_U16);
    s->rows = rc_bytes_at(&bytes, ROWS_AT + more / 2, second ? RC_RAW_U32 : RC_RAW_U16);
    s->dx = rc_bytes_at(&bytes, X_AT + more, RC_RAW_F64);
    s->dy = rc_bytes_at(&bytes, Y_AT + more, RC_RAW_F64);
    s->scale = rc_bytes_at(&bytes, Z_AT + more, RC_RAW_F64);
    s->compression = rc_bytes_at(&bytes, COMPRESSION_AT + more, RC_RAW_U8);
    s->type = rc_bytes_at(&bytes, TYPE_AT + more, RC_RAW_U8);
    s->check = rc_bytes_at(&bytes, CHECK_AT + more, RC_RAW_U8);
    if (!(s->type < (double)known))
        return rc_err_set(err, "DataType is %g: it must be 0 to %zu", s->type, known - 1);
    map->at = HEADER + more;
    map->raw = types[(size_t)s->type].raw;
    map->missing_from = map->missing_to = types[(size_t)s->type].missing;
    return RC_OK;
}

/* Reads the numbers of the text; only the end of their part may follow: '*' or the end of the file. */
static enum rc_status
fill_text(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    struct rc_piece text = {(const char *)file->data + map->at, file->size - map->at};

    if (rc_flow_read(&text, v, map->nx * map->ny, err) != RC_OK)
        return RC_FAIL;
    while (text.n > 0 && (*text.text == '\0' || *text.text == '\x1a')) /* some writers' last byte */
        text = (struct rc_piece){text.text + 1, text.n - 1};
    text = rc_piece_trim(text);
    if (text.n == 0 || *text.text == '*')
        return RC_OK;
    return rc_err_set(err,
                      "'%s' follows the last of the %zu x %zu heights that the header promises: "
                      "there are more of them, or checksums among them",
                      rc_text_shown(text.text, text.n < 12 ? text.n : 12), map->nx, map->ny);
}

static enum rc_status
sdf_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct sdf s = {.dx = NAN, .dy = NAN, .scale = 1};
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));
    bool is_text = begins(file, 'a');

    if ((is_text ? find_text(file, &s, map, err) : find_binary(file, &s, map, err)) != RC_OK ||
        rc_map_size(map, s.columns, "NumPoints", s.rows, "NumProfiles", err) != RC_OK)
        return RC_FAIL;
    if (s.compression != 0)
        return rc_err_set(err, "the heights are compressed (Compression is %g): that is not read",
                          s.compression);
    if (s.check != 0)
        return rc_err_set(
            err,
            "CheckType is %g: heights with checksums are not read; save the file with CheckType 0",
            s.check);
    if (is_text && rc_map_is_text(map, file, map->at, err) != RC_OK)
        return RC_FAIL;
    if (is_text)
        map->fill = fill_text;
    strcpy(map->unit, "m");
    map->dx = s.dx;
    map->dy = s.dy;
    map->scale = s.scale;
    rc_maps_key(maps, "file.creator", s.maker);
    rc_maps_key(maps, "file.date", s.created);
    rc_maps_key(maps, "file.changed", s.changed);
    return RC_OK;
}

static bool
is_sdf(const struct rc_file *file)
{
    return begins(file, 'a') || begins(file, 'b');
}

const struct rc_format rc_format_sdf = {
    .name = "sdf",
    .suffixes = ".sdf",
    .summary = "ISO 25178-71 (EUNA 15178), text and binary",
    .is = is_sdf,
    .refusal = "not an SDF file: it must begin with aISO-, aBCR-, bISO- or bBCR-",
    .find = sdf_find,
};
