/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Zygo MetroPro: a header of big-endian fields, an intensity image that is passed over, and the
 * phase as 32-bit numbers, row 0 first. A height is phase * S * O * wavelength / R, where R is the
 * resolution of the phase.
 */
#include <math.h>
#include <string.h>

#include "formats/format.h"

enum {
    AT_HEADER = 6, /* its size */
    AT_SOFTWARE_DATE = 16,
    AT_INTENSITY = 60, /* bytes of the intensity image */
    AT_COLUMNS = 68,
    AT_ROWS = 70,
    AT_BYTES = 72, /* number of bytes of the phase */
    AT_SCALE = 164,
    AT_WAVELENGTH = 168,
    AT_OBLIQUITY = 176,
    AT_LATERAL = 184,
    AT_FINENESS = 218,
    DATE = 30,
    LEAST = 220, /* bytes of a header with all these fields */
    MISSING_FROM = 2147483640
};

static bool
has_magic(const struct rc_file *file)
{
    return rc_file_holds(file, 0, "\x88\x1b\x03", 3) && file->size > 4 && file->data[3] >= 0x6f &&
           file->data[3] <= 0x71;
}

static enum rc_status
metropro_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    static const double finenesses[] = {4096, 32768, 131072};
    struct rc_bytes b = rc_file_bytes(file, true);
    struct rc_map *map;
    double header, intensity, fineness, bytes;

    if (file->size < LEAST)
        return rc_err_set(err, "the header takes more than %d bytes, the file has %zu", LEAST,
                          file->size);
    map = rc_maps_add(maps, rc_piece_of("Phase"));
    header = rc_bytes_at(&b, AT_HEADER, RC_RAW_U32);
    intensity = rc_bytes_at(&b, AT_INTENSITY, RC_RAW_I32);
    bytes = rc_bytes_at(&b, AT_BYTES, RC_RAW_I32);
    fineness = rc_bytes_at(&b, AT_FINENESS, RC_RAW_I16);
    if (header < LEAST || intensity < 0 || header + intensity > (double)file->size)
        return rc_err_set(err, "header and intensities take %g and %g bytes, the file has %zu",
                          header, intensity, file->size);
    if (bytes == 0)
        return rc_err_set(err, "the file has only intensities, no phase");
    if (rc_map_size(map, rc_bytes_at(&b, AT_COLUMNS, RC_RAW_I16), NULL,
                    rc_bytes_at(&b, AT_ROWS, RC_RAW_I16), NULL, err) != RC_OK)
        return RC_FAIL;
    if (bytes != 4 * (double)map->nx * (double)map->ny)
        return rc_err_set(
            err, "%zu x %zu phases of 4 bytes do not make the %g bytes that the header promises",
            map->nx, map->ny, bytes);
    if (fineness != 0 && fineness != 1 && fineness != 2)
        return rc_err_set(err, "the phase resolution is %g: it must be 0, 1 or 2", fineness);
    strcpy(map->unit, "m");
    map->at = (size_t)header + (size_t)intensity;
    map->raw = RC_RAW_I32;
    map->big = true;
    map->missing_from = MISSING_FROM;
    map->missing_to = INFINITY;
    map->scale = rc_bytes_at(&b, AT_SCALE, RC_RAW_F32) * rc_bytes_at(&b, AT_OBLIQUITY, RC_RAW_F32) *
                 rc_bytes_at(&b, AT_WAVELENGTH, RC_RAW_F32) / finenesses[(size_t)fineness];
    map->dx = map->dy = rc_bytes_at(&b, AT_LATERAL, RC_RAW_F32);
    if (map->dx == 0)
        map->dx = map->dy = NAN; /* an instrument that was not calibrated */
    rc_maps_key(maps, "file.software-date", rc_file_text(file, AT_SOFTWARE_DATE, DATE));
    return RC_OK;
}

const struct rc_format rc_format_metropro = {
    .name = "metropro",
    .suffixes = ".dat",
    .summary = "Zygo MetroPro",
    .is = has_magic,
    .refusal = "no MetroPro file: it does not begin 88 1b 03 6f, ...70 or ...71",
    .find = metropro_find,
};
