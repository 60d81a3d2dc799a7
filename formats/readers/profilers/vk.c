/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Keyence VK: VK3_ and VK4_ begin with a table of offsets, little-endian. They lead to the conditions of the
 * measurement and to up to three height images of whole numbers, row 0 first, lengths in picometres. VK6 and
 * VK7 are a picture and a ZIP archive whose member Vk4File is a VK4 file.
 */
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    LEAD = 12,       /* magic, version, kind */
    HEIGHTS_AT = 36, /* the offsets of the height images */
    HEIGHTS = 3,
    AT_YEAR = 4, /* in the conditions; month, day, hour, minute, second follow */
    AT_X = 168,
    AT_Y = 172,
    AT_Z = 176,
    CONDITIONS = 180,
    IMAGE = 28 + 768, /* bytes before the numbers: 7 of u32, a palette */
    STARTS_MOST = 16  /* places at which an archive is tried */
};

static const char member_name[] = "Vk4File";

static bool
is_plain(const struct rc_file *file)
{
    return rc_file_holds(file, 0, "VK3_", 4) || rc_file_holds(file, 0, "VK4_", 4);
}

static bool
is_packed(const struct rc_file *file)
{
    return rc_file_holds(file, 0, "VK6", 3) || rc_file_holds(file, 0, "VK7", 3);
}

/* ---- the archive ---- */

static unsigned char *
unpack_member(struct rc_zip_read *archive, size_t member, const struct rc_file *file, size_t *n,
              struct rc_err *err)
{
    uint64_t size;

    if (rc_zip_read_size(archive, member, &size, err) != RC_OK)
        return NULL;
    if (size > rc_memory_limit(file->size))
        return rc_err_null(
            err, "the archive in the file promises %g MB, the file has %g MB: it is damaged",
            (double)size / 1e6, (double)file->size / 1e6);
    return rc_zip_read_bytes(archive, member, size, n, NULL, err);
}

/* The n bytes of the VK4 file in the archive, which the caller frees; NULL with the reason. The offsets in
 * the archive count from the start of the file or of the archive, PK 3 4. The picture may contain these bytes
 * by chance. */
static unsigned char *
unpack(const struct rc_file *file, size_t *n, struct rc_err *err)
{
    struct rc_piece rest = rc_file_piece(file);
    const char *at = rest.text;

    for (size_t k = 0; k < STARTS_MOST && at != NULL; k++) {
        size_t start = (size_t)(at - (const char *)file->data), member;
        struct rc_file part = {file->name, file->data + start, file->size - start};
        RC_OWN(rc_zip_read, archive) = rc_zip_read_behind(&part, NULL);

        if (archive != NULL && rc_zip_read_find(archive, member_name, &member, NULL) == RC_OK)
            return unpack_member(archive, member, file, n, err);
        rest = (struct rc_piece){at + 1, file->size - start - 1};
        at = rc_piece_find(rest, "PK\3\4");
    }
    return rc_err_null(err, "the file has no archive with a member %s", member_name);
}

/* ---- VK4 ---- */

static enum rc_status
add_heights(const struct rc_file *file, size_t at, size_t conditions, size_t number,
            struct rc_maps *maps, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    struct rc_map *map = number == 1   ? rc_maps_add(maps, rc_piece_of("height"))
                         : number == 2 ? rc_maps_add(maps, rc_piece_of("height 2"))
                                       : rc_maps_add(maps, rc_piece_of("height 3"));
    double bits, promised;

    if (rc_map_size(map, rc_bytes_at(&b, at, RC_RAW_U32), NULL, rc_bytes_at(&b, at + 4, RC_RAW_U32),
                    NULL, err) != RC_OK)
        return RC_FAIL;
    bits = rc_bytes_at(&b, at + 8, RC_RAW_U32);
    if (bits != 8 && bits != 16 && bits != 32)
        return rc_err_set(err, "a height has %g bits: it must have 8, 16 or 32", bits);
    if (rc_bytes_at(&b, at + 12, RC_RAW_U32) != 0)
        return rc_err_set(err, "the heights are compressed: that is not read");
    promised = rc_bytes_at(&b, at + 16, RC_RAW_U32);
    if (promised != bits / 8 * (double)map->nx * (double)map->ny)
        return rc_err_set(
            err, "%zu x %zu heights of %g bits do not make the %g bytes that the header promises",
            map->nx, map->ny, bits, promised);
    if (promised > (double)file->size - (double)at - IMAGE)
        return rc_err_set(err,
                          "the heights take %g bytes from byte %zu on, the file has %zu in all",
                          promised, at + IMAGE, file->size);
    map->raw = bits == 8 ? RC_RAW_U8 : bits == 16 ? RC_RAW_U16 : RC_RAW_U32;
    map->at = at + IMAGE;
    rc_map_unit(map, rc_piece_of("pm"));
    map->scale = rc_bytes_at(&b, conditions + AT_Z, RC_RAW_U32);
    map->dx = rc_bytes_at(&b, conditions + AT_X, RC_RAW_U32) * 1e-12;
    map->dy = rc_bytes_at(&b, conditions + AT_Y, RC_RAW_U32) * 1e-12;
    return RC_OK;
}

static enum rc_status
find_plain(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    size_t conditions = (size_t)rc_bytes_at(&b, LEAD, RC_RAW_U32), at;

    if (!is_plain(file))
        return rc_err_set(err, "not a VK file: it must begin with VK3_, VK4_, VK6 or VK7");
    if (b.past || conditions > file->size || file->size - conditions < CONDITIONS)
        return rc_err_set(err,
                          "the conditions of the measurement begin at byte %zu of a file of %zu",
                          conditions, file->size);
    for (size_t k = 0; k < HEIGHTS; k++) {
        at = (size_t)rc_bytes_at(&b, HEIGHTS_AT + 4 * k, RC_RAW_U32);
        if (at == 0)
            continue;
        if (at > file->size || file->size - at < IMAGE)
            return rc_err_set(err, "height image %zu begins at byte %zu of a file of %zu", k + 1,
                              at, file->size);
        if (add_heights(file, at, conditions, k + 1, maps, err) != RC_OK)
            return RC_FAIL;
    }
    rc_maps_date(maps, b, conditions + AT_YEAR, RC_RAW_U32);
    if (maps->n == 0)
        return rc_err_set(err, "the file has no height image");
    return RC_OK;
}

static enum rc_status
find_packed(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_file inner = {.name = member_name};
    unsigned char **bytes = rc_maps_open(maps, sizeof *bytes, rc_release, err);
    enum rc_status status;

    if (bytes == NULL || (*bytes = unpack(file, &inner.size, err)) == NULL)
        return RC_FAIL;
    inner.data = *bytes;
    status = find_plain(&inner, maps, err);
    for (size_t k = 0; k < maps->n && status == RC_OK; k++) {
        maps->map[k].within = inner;
        status = rc_map_bound(&maps->map[k], file, (double)inner.size, err);
    }
    return status;
}

static enum rc_status
vk_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    return is_packed(file) ? find_packed(file, maps, err) : find_plain(file, maps, err);
}

static int
vk_score(const struct rc_file *file)
{
    if (is_plain(file))
        return 95;
    return !is_packed(file) ? 0 : rc_file_named(file, ".vk6 .vk7") ? 95 : 60;
}

const struct rc_format rc_format_vk = {
    .name = "vk",
    .suffixes = ".vk3 .vk4 .vk6 .vk7",
    .summary = "Keyence VK confocal microscopes",
    .score = vk_score,
    .find = vk_find,
};
