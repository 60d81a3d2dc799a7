/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Keyence ZON (macroscopes VR): KPK0 or KPK1, the length of a picture (u32), the picture, and a ZIP archive
 * whose members have numbers for names. One member is XML with the metres per pixel and per count, and one
 * has the heights. A third one has the quality of each height, in one byte. Such arrays begin with columns,
 * rows, bytes of an element and bytes of a row (i32 each), little-endian; row 0 is the first. A height is
 * int32 * metres per count; if one of the two lowest bits of the byte is set, the point is missing or
 * excluded.
 *
 * In files that begin with KPK1 each member is packed by zstd too, which its first bytes say as well.
 *
 * The layout is the one that SurfaceTopography reads.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    FIRST = 8, /* byte of the picture */
    HEAD = 16, /* size of the head of an array */
    NOT_MEASURED = 3,
    XML_MOST = 1 << 20
};

static const char heights_name[] = "4cdb0c75-5706-48cc-a9a1-adf395d609ae";
static const char marks_name[] = "9e7ca6dd-0e6a-4d7b-8986-f0a7b773c916";

/* An array: its head, and its bytes. */
struct array {
    size_t nx, ny, row;
    unsigned char *bytes;
    size_t n;
};

struct zon {
    struct rc_zip_read *archive;
    struct array heights;
    double pixel, count; /* m */
    struct rc_maps *maps;
};

/* ---- the archive ---- */

static bool
is_packed(const struct rc_file *file)
{
    return rc_file_holds(file, 0, "KPK1", 4);
}

/* Its offsets count from the start of the archive or of the file. */
static struct rc_zip_read *
open_archive(const struct rc_file *file, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    size_t picture = (size_t)rc_bytes_at(&b, 4, RC_RAW_U32), member;
    struct rc_file part = *file;
    RC_OWN(rc_zip_read, behind) = NULL;
    RC_OWN(rc_zip_read, whole) = NULL;

    if (is_packed(file) && !rc_zstd_is_there())
        return rc_err_null(
            err, "the file is packed by zstd (KPK1), but this program was built without zstd: "
                 "export the heights as CSV in Keyence's program");
    if (b.past || picture > file->size - FIRST)
        return rc_err_null(err, "the picture takes %zu bytes, the file has %zu", picture,
                           file->size);
    part.data += FIRST + picture;
    part.size -= FIRST + picture;
    if ((behind = rc_zip_read_behind(&part, NULL)) != NULL &&
        rc_zip_read_find(behind, heights_name, &member, NULL) == RC_OK)
        return rc_give(&behind);
    if ((whole = rc_zip_read_behind(file, err)) == NULL ||
        rc_zip_read_find(whole, heights_name, &member, NULL) == RC_OK)
        return rc_give(&whole);
    return rc_err_null(err, "the archive in the file has no heights (member %s)", heights_name);
}

/* The n bytes of a member, unpacked, with a NUL behind them, which the caller frees; NULL with the
 * reason. */
static unsigned char *
member_bytes(const struct zon *z, const struct rc_file *file, size_t member, const char *what,
             size_t *n, struct rc_err *err)
{
    size_t most = rc_memory_limit(file->size), packed_n;
    RC_OWNED unsigned char *packed = NULL;
    uint64_t size;

    if (rc_zip_read_size(z->archive, member, &size, err) != RC_OK)
        return NULL;
    if (size > most / 2)
        return rc_err_null(err,
                           "the archive promises %g MB of %s, the file has %g MB: it is damaged",
                           (double)size / 1e6, what, (double)file->size / 1e6);
    packed = rc_zip_read_bytes(z->archive, member, size, &packed_n, NULL, err);
    if (packed == NULL || packed_n < 4 || memcmp(packed, "\x28\xb5\x2f\xfd", 4) != 0) {
        *n = packed_n;
        return rc_give(&packed);
    }
    return rc_zstd_unpack(what, packed, packed_n, most / 2, n, err);
}

static void
array_free(struct array *a)
{
    free(a->bytes);
}

static void
zon_close(void *opened)
{
    struct zon *z = opened;

    rc_zip_read_free(z->archive);
    array_free(&z->heights);
}

/* Reads an array, which the caller frees. `width`: bytes that an element must have. */
static enum rc_status
read_array(const struct zon *z, const struct rc_file *file, const char *name, size_t width,
           struct array *a, struct rc_err *err)
{
    struct rc_bytes b = {0};
    size_t member, element;

    if (rc_zip_read_find(z->archive, name, &member, err) != RC_OK ||
        (a->bytes = member_bytes(z, file, member, "heights or marks", &a->n, err)) == NULL)
        return RC_FAIL;
    b.data = a->bytes;
    b.size = a->n;
    if (rc_map_count("columns", rc_bytes_at(&b, 0, RC_RAW_I32), &a->nx, err) != RC_OK ||
        rc_map_count("rows", rc_bytes_at(&b, 4, RC_RAW_I32), &a->ny, err) != RC_OK)
        return RC_FAIL;
    element = (size_t)rc_bytes_u32(&b);
    a->row = rc_bytes_u32(&b);
    if (element != width || a->nx > a->row / width || a->ny > (a->n - HEAD) / a->row)
        return rc_err_set(
            err,
            "the array '%s' promises %zu x %zu elements of %zu bytes in rows of %zu, it has "
            "%zu bytes and elements of %zu",
            name, a->nx, a->ny, element, a->row, a->n, width);
    return RC_OK;
}

/* ---- XML ---- */

static const struct {
    const char *member, *path, *key; /* path below the root; key NULL: a length for z */
    size_t to;
} elements[] = {
    {"686613b8-27b5-4a29-8ffc-438c2780873e", "XYCalibration/MeterPerPixel", NULL,
     offsetof(struct zon, pixel)},
    {"686613b8-27b5-4a29-8ffc-438c2780873e", "ZCalibration/MeterPerUnit", NULL,
     offsetof(struct zon, count)},
    {"cbc1d39b-215f-4d56-a20e-cf8e5f570755", "DeviceModelName", "file.model", 0},
    {"cbc1d39b-215f-4d56-a20e-cf8e5f570755", "DeviceSerialId", "file.serial", 0},
    {"1d35862b-3b48-4df2-9235-833ef590b043", "ScanDateTime", "file.date", 0},
};

static enum rc_status
take_element(void *arg, const char *path, const char *text, struct rc_err *err)
{
    struct zon *z = arg;

    path += strcspn(path, "/");
    path += *path == '/';
    for (size_t k = 0; k < sizeof elements / sizeof *elements; k++) {
        if (strcmp(path, elements[k].path) != 0)
            continue;
        if (elements[k].key != NULL)
            rc_maps_key(z->maps, elements[k].key, rc_piece_of(text));
        else
            return rc_xml_number("the calibration", path, text,
                                 (double *)((char *)z + elements[k].to), err);
    }
    return RC_OK;
}

static enum rc_status
read_document(struct zon *z, const struct rc_file *file, size_t member, struct rc_err *err)
{
    size_t n;
    RC_OWNED unsigned char *bytes = member_bytes(z, file, member, "settings", &n, err);

    if (bytes != NULL && n > XML_MOST)
        return rc_err_set(err, "the settings have %zu bytes: the file is damaged", n);
    return bytes != NULL ? rc_xml_read("a document", bytes, n, take_element, z, err) : RC_FAIL;
}

static enum rc_status
read_elements(struct zon *z, const struct rc_file *file, struct rc_err *err)
{
    const char *last = "";

    for (size_t k = 0; k < sizeof elements / sizeof *elements; k++) {
        size_t member;

        if (strcmp(elements[k].member, last) == 0)
            continue;
        last = elements[k].member;
        if (rc_zip_read_find(z->archive, last, &member, NULL) == RC_OK &&
            read_document(z, file, member, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

/* ---- heights ---- */

static enum rc_status
apply_marks(const struct zon *z, const struct rc_file *file, const struct rc_map *map, double *v,
            struct rc_err *err)
{
    RC_ENDS(array_free) struct array marks = {0};
    size_t member;

    if (rc_zip_read_find(z->archive, marks_name, &member, NULL) != RC_OK)
        return RC_OK;
    if (read_array(z, file, marks_name, 1, &marks, err) != RC_OK)
        return RC_FAIL;
    if (marks.nx == map->nx && marks.ny == map->ny)
        for (size_t k = 0; k < map->nx * map->ny; k++)
            if ((marks.bytes[HEAD + k / map->nx * marks.row + k % map->nx] & NOT_MEASURED) != 0)
                v[k] = NAN;
    return marks.nx == map->nx && marks.ny == map->ny
               ? RC_OK
               : rc_err_set(err, "%zu x %zu heights and %zu x %zu marks do not belong together",
                            map->nx, map->ny, marks.nx, marks.ny);
}

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    const struct zon *z = map->opened;
    struct rc_bytes b = {.data = z->heights.bytes, .size = z->heights.n};

    for (size_t j = 0; j < map->ny; j++) {
        b.at = HEAD + j * z->heights.row;
        rc_bytes_values(&b, RC_RAW_I32, v + j * map->nx, map->nx);
    }
    return apply_marks(z, file, map, v, err);
}

static enum rc_status
zon_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct zon *z = rc_maps_open(maps, sizeof *z, zon_close, err);
    struct rc_map *map;

    if (z == NULL)
        return RC_FAIL;
    z->pixel = z->count = NAN;
    z->maps = maps;
    if ((z->archive = open_archive(file, err)) == NULL || read_elements(z, file, err) != RC_OK ||
        read_array(z, file, heights_name, 4, &z->heights, err) != RC_OK)
        return RC_FAIL;
    map = rc_maps_add(maps, rc_piece_of(""));
    map->nx = z->heights.nx;
    map->ny = z->heights.ny;
    map->dx = map->dy = z->pixel;
    map->fill = fill_heights;
    if (!isnan(z->count)) {
        strcpy(map->unit, "m");
        map->scale = z->count;
    }
    rc_maps_key(maps, "file.manufacturer", rc_piece_of("Keyence"));
    return rc_map_bound(map, file, 2 * (double)z->heights.n, err);
}

const struct rc_format rc_format_zon = {
    .name = "zon",
    .suffixes = ".zon",
    .summary = "Keyence ZON (VR): heights of a one-shot macroscope",
    .magic = {{"KPK0", 4}, {"KPK1", 4}},
    .refusal = "not a ZON file: it must begin with KPK0 or KPK1",
    .find = zon_find,
};
