/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Park Systems TIFF: the image is a thumbnail; the data are the bytes of the private tag 50434, and 50435 is
 * their header. All values are little-endian in any TIFF; text is UTF-16; the lowest row comes first. A
 * height is gain * (scale * number + offset) in the header's unit, in micrometres where it names none, and a
 * scale of 0 is 1.
 */
#include <math.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    MAGIC_TAG = 50432,
    VERSION_TAG,
    DATA_TAG,
    HEADER_TAG,
    MAGIC = 0x0e031301,
    VERSION_1 = 0x1000001,
    VERSION_2 = 0x1000002,
    HEADER_1 = 284, /* bytes of a header of version 1 */
    HEADER_2 = 352, /* bytes of version 2, up to the type of data */
    /* places in the header */
    KIND_AT = 0,
    NAME_AT = 4,
    MODE_AT = 68,
    NX_AT = 100,
    WIDTH_AT = 140,
    GAIN_AT = 220,
    UNIT_AT = 244,
    TYPE_AT = 348,
    TYPE_LONG = 4,
};

struct park {
    struct rc_tiff *tiff;
    char name[64], mode[32], unit[16], date[32], program[64];
    size_t nx, ny;
    double width, height; /* m */
    double gain, scale, offset;
    enum rc_raw raw;
    const unsigned char *data;
    size_t size;
};

/* Converts n characters of UTF-16LE at `at` that are Latin-1, as names and units are. */
static void
narrow(const struct rc_bytes *header, size_t at, size_t n, char *to, size_t size)
{
    struct rc_bytes b = *header;
    char text[64];
    size_t k = 0;

    b.at = at;
    while (k < n && k < sizeof text) {
        unsigned c = rc_bytes_u16(&b);
        if (c == 0 || b.past)
            break;
        text[k++] = (char)(c == 0x3bc ? 0xb5 : c < 0x100 ? c : '?');
    }
    rc_text_clean(to, size, text, k);
}

static double
number_at(const struct rc_bytes *header, size_t at)
{
    struct rc_bytes b = *header;
    double value;

    b.at = at;
    rc_bytes_values(&b, RC_RAW_F64, &value, 1);
    return value;
}

static uint32_t
word_at(const struct rc_bytes *header, size_t at)
{
    struct rc_bytes b = *header;

    b.at = at;
    return rc_bytes_u32(&b);
}

static enum rc_status
judge_type(struct park *p, const struct rc_bytes *header, bool second, struct rc_err *err)
{
    static const enum rc_raw raw[] = {RC_RAW_I16, RC_RAW_I32, RC_RAW_F32};
    uint32_t kind = word_at(header, KIND_AT), type = second ? word_at(header, TYPE_AT) : 0;

    if (kind == 1)
        return rc_err_set(err, "a line profile of Park Systems: only images are read");
    if (kind > 2)
        return rc_err_set(err,
                          "image type %u of Park Systems: only 0, an image, and 2, one with "
                          "spectroscopy, are read",
                          (unsigned)kind);
    if (type >= sizeof raw / sizeof *raw)
        return rc_err_set(err, "data type %u: it must be 0 (int16), 1 (int32) or 2 (float)",
                          (unsigned)type);
    p->raw = raw[type];
    return RC_OK;
}

static enum rc_status
take_header(struct park *p, const struct rc_bytes *header, bool second, struct rc_err *err)
{
    size_t n, bytes;

    if (header->size < (size_t)(second ? HEADER_2 : HEADER_1))
        return rc_err_set(err, "the header in tag %d has %zu bytes, %d are needed", HEADER_TAG,
                          header->size, second ? HEADER_2 : HEADER_1);
    narrow(header, NAME_AT, 32, p->name, sizeof p->name);
    narrow(header, MODE_AT, 8, p->mode, sizeof p->mode);
    narrow(header, UNIT_AT, 8, p->unit, sizeof p->unit);
    p->nx = word_at(header, NX_AT);
    p->ny = word_at(header, NX_AT + 4);
    p->width = number_at(header, WIDTH_AT) * 1e-6;
    p->height = number_at(header, WIDTH_AT + 8) * 1e-6;
    p->gain = number_at(header, GAIN_AT);
    p->scale = number_at(header, GAIN_AT + 8);
    p->offset = number_at(header, GAIN_AT + 16);
    if (p->scale == 0)
        p->scale = 1;
    if (!isfinite(p->gain) || !isfinite(p->scale) || !isfinite(p->offset))
        return rc_err_set(err, "gain %g, scale %g, offset %g: they must be finite", p->gain,
                          p->scale, p->offset);
    if (p->nx == 0 || p->ny == 0)
        return rc_err_set(err, "an image of %zu x %zu points is empty", p->nx, p->ny);
    if (judge_type(p, header, second, err) != RC_OK ||
        rc_size_mul(p->nx, p->ny, &n, err) != RC_OK ||
        rc_size_mul(n, rc_raw_width(p->raw), &bytes, err) != RC_OK)
        return RC_FAIL;
    return rc_bytes_agree("data", bytes, p->size, err);
}

static void
park_close(void *opened)
{
    rc_tiff_free(((struct park *)opened)->tiff);
}

static enum rc_status
park_open(struct park *p, const struct rc_file *file, struct rc_err *err)
{
    double magic = 0, version = 0;
    struct rc_bytes header = {0};

    if ((p->tiff = rc_tiff_new(file, err)) == NULL)
        return RC_FAIL;
    if (!rc_tiff_number(p->tiff, MAGIC_TAG, &magic) || magic != MAGIC)
        return rc_err_set(err,
                          "a TIFF, but none of Park Systems: tag %d is not 0x%08x; pictures "
                          "without heights are not read",
                          MAGIC_TAG, MAGIC);
    rc_tiff_number(p->tiff, VERSION_TAG, &version);
    if (version != VERSION_1 && version != VERSION_2)
        return rc_err_set(err,
                          "version 0x%08x of Park Systems' TIFF: only 0x%08x and 0x%08x are read",
                          (unsigned)version, VERSION_1, VERSION_2);
    if (!rc_tiff_bytes(p->tiff, DATA_TAG, &p->data, &p->size) ||
        !rc_tiff_bytes(p->tiff, HEADER_TAG, &header.data, &header.size))
        return rc_err_set(err, "tag %d (data) or tag %d (header of the data) is missing", DATA_TAG,
                          HEADER_TAG);
    rc_tiff_text(p->tiff, RC_TIFF_DATE, p->date, sizeof p->date);
    rc_tiff_text(p->tiff, RC_TIFF_SOFTWARE, p->program, sizeof p->program);
    return take_header(p, &header, version == VERSION_2, err);
}

static enum rc_status
fill_values(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    const struct park *p = map->opened;
    struct rc_bytes b = {.data = p->data, .size = p->size};

    (void)file;
    (void)err;
    rc_bytes_values(&b, p->raw, v, map->nx * map->ny);
    for (size_t k = 0; k < map->nx * map->ny; k++)
        v[k] = p->gain * (p->scale * v[k] + p->offset);
    return RC_OK;
}

static enum rc_status
park_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct park *p = rc_maps_open(maps, sizeof *p, park_close, err);
    struct rc_map *map;

    if (p == NULL || park_open(p, file, err) != RC_OK)
        return RC_FAIL;
    map = rc_maps_add(maps, rc_piece_of(p->name));
    map->nx = p->nx;
    map->ny = p->ny;
    map->dx = p->width / (double)p->nx;
    map->dy = p->height / (double)p->ny;
    rc_map_unit(map, rc_piece_of(p->unit[0] == '\0' ? "um" : p->unit));
    map->bottom_first = true;
    map->fill = fill_values;
    rc_maps_key(maps, "file.date", rc_piece_of(p->date));
    rc_maps_key(maps, "file.version", rc_piece_of(p->program));
    rc_maps_key(maps, "file.mode", rc_piece_of(p->mode));
    return RC_OK;
}

/* ---- the entry in formats.list ---- */

static bool
is_park(const struct rc_file *file)
{
    return rc_tiff_is(file) && rc_tiff_hints(file, MAGIC_TAG, TYPE_LONG) &&
           rc_tiff_hints(file, VERSION_TAG, TYPE_LONG);
}

const struct rc_format rc_format_park = {
    .name = "park",
    .suffixes = ".tif .tiff",
    .summary = "Park Systems TIFF",
    .is = is_park,
    .sure = 90,
    .find = park_find,
    .sandboxed = true,
    .copies = true,
};
