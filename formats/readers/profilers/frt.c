/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * FRT MicroProf has a magic line, the number of blocks, and the blocks. A block has a 16-bit kind, a length
 * and that many bytes, little-endian. Heights are whole numbers from the bottom row on; 1 marks a missing
 * point.
 */
#include <string.h>

#include "formats/format.h"

enum {
    MAGIC = 12,
    VERSION = 4,
    BLOCKS_AT = 16,
    FIRST = 18,
    GRID = 0x66,  /* u32 columns, rows, bits         */
    SIZE = 0x67,  /* f64 width, height in m          */
    RANGE = 0x6c, /* u32, f64 m a count              */
    HEIGHTS = 0x0b,
    COMMENT = 0x65,
    MISSING = 1
};

static const char magic[] = "FRTM_GLIDERV";

struct block {
    size_t at, n;
};

struct frt {
    struct block grid, size, range, heights;
};

static enum rc_status
read_blocks(const struct rc_file *file, struct frt *f, struct rc_maps *maps, struct rc_err *err)
{
    bool long_lengths = rc_file_holds(file, MAGIC, "1.01", VERSION);
    const struct {
        int kind;
        size_t least;
        struct block *into;
    } wanted[] = {
        {GRID, 12, &f->grid},
        {SIZE, 16, &f->size},
        {RANGE, 12, &f->range},
        {HEIGHTS, 1, &f->heights},
    };
    struct rc_bytes b = rc_file_bytes(file, false);
    struct rc_piece comment = {"", 0};
    size_t blocks;

    b.at = BLOCKS_AT;
    blocks = rc_bytes_u16(&b);
    for (size_t k = 0; k < blocks; k++) {
        int kind = rc_bytes_u16(&b);
        uint64_t n = long_lengths ? rc_bytes_u64(&b) : rc_bytes_u32(&b);

        if (b.past || n > file->size - b.at)
            return rc_err_set(err, "block %zu of %zu does not end inside the file", k + 1, blocks);
        for (size_t w = 0; w < sizeof wanted / sizeof *wanted; w++)
            if (kind == wanted[w].kind && n >= wanted[w].least)
                *wanted[w].into = (struct block){b.at, (size_t)n};
        if (kind == COMMENT)
            comment = rc_file_text(file, b.at, (size_t)n);
        b.at += (size_t)n;
    }
    rc_maps_key(maps, "file.comment", comment);
    if (f->grid.n == 0 || f->size.n == 0 || f->range.n == 0 || f->heights.n == 0)
        return rc_err_set(err, "the file has no block of %s",
                          f->grid.n == 0    ? "sizes (0x66)"
                          : f->size.n == 0  ? "lengths (0x67)"
                          : f->range.n == 0 ? "the height of a count (0x6c)"
                                            : "heights (0x0b)");
    return RC_OK;
}

static enum rc_status
frt_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct rc_bytes b = rc_file_bytes(file, false);
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(""));
    struct frt f = {0};
    double bits;

    if (!rc_file_holds(file, 0, magic, MAGIC) || file->size < FIRST)
        return rc_err_set(err, "no FRT file: it does not begin with %s", magic);
    if (!rc_file_holds(file, MAGIC, "1.00", VERSION) &&
        !rc_file_holds(file, MAGIC, "1.01", VERSION))
        return rc_err_set(err, "the file is of version '%s': 1.00 and 1.01 are read",
                          rc_text_shown((const char *)file->data + MAGIC, VERSION));
    if (read_blocks(file, &f, maps, err) != RC_OK ||
        rc_map_size(map, rc_bytes_at(&b, f.grid.at, RC_RAW_U32), NULL,
                    rc_bytes_at(&b, f.grid.at + 4, RC_RAW_U32), NULL, err) != RC_OK)
        return RC_FAIL;
    bits = rc_bytes_at(&b, f.grid.at + 8, RC_RAW_U32);
    if (bits != 16 && bits != 32)
        return rc_err_set(err, "a height has %g bits: it must have 16 or 32", bits);
    if ((double)f.heights.n < bits / 8 * (double)map->nx * (double)map->ny)
        return rc_err_set(err,
                          "%zu x %zu heights of %g bits are promised, their block has %zu bytes",
                          map->nx, map->ny, bits, f.heights.n);
    strcpy(map->unit, "m");
    map->raw = bits == 16 ? RC_RAW_U16 : RC_RAW_I32;
    map->at = f.heights.at;
    map->bottom_first = true;
    map->missing_from = map->missing_to = MISSING;
    map->scale = rc_bytes_at(&b, f.range.at + 4, RC_RAW_F64);
    map->dx = rc_bytes_at(&b, f.size.at, RC_RAW_F64) / (double)map->nx;
    map->dy = rc_bytes_at(&b, f.size.at + 8, RC_RAW_F64) / (double)map->ny;
    return RC_OK;
}

const struct rc_format rc_format_frt = {
    .name = "frt",
    .suffixes = ".frt",
    .summary = "FRT MicroProf",
    .magic = {{magic, MAGIC}},
    .find = frt_find,
};
