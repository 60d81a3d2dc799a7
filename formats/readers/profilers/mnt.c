/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Digital Surf Mountains, MNT: a compound file whose stream ScopedContents holds the document. It has 8 bytes
 * of length, then a tree of entries. An entry is a tag (u16), a length (u64) and its content, little-endian.
 * Entries of the list of objects have another length before them. Text is the byte 4 and UTF-16.
 *
 * Objects are known by the number of their class. Measured surfaces have heights. Surfaces computed from them
 * are not in the file: the program computes them again when it opens the document.
 *
 *     heights   int32 or int16, row 0 first, in zlib streams, each behind its first element (u64), its number
 *               of elements and of bytes (u32); count * step + origin, the origin in the unit shown
 *     mask      a byte a point, 9 where it was measured, with a border of one point, packed likewise
 *
 * The layout is the one that SurfaceTopography reads.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    FIRST = 0xffff, /* tag of the part that an object inherits */
    SURFACE = 9012,
    MEASURED = 9062,
    HEIGHTS = 9049,
    MASK = 9056,
    IS_MEASURED = 9,
    TAG = 2 + 8, /* bytes before the contents of an entry */
    WORD = 64
};

static const char stream_name[] = "ScopedContents";

struct part {
    const unsigned char *data;
    size_t n;
};

struct scale {
    double step, origin;
    char unit[WORD], shown[WORD];
};

struct surface {
    char name[WORD];
    struct scale x, y, z;
    size_t nx, ny;
    struct part heights, mask; /* packed; mask.data NULL: all points were measured */
};

/* ---- entries ---- */

static struct rc_bytes
bytes_of(struct part p)
{
    return (struct rc_bytes){.data = p.data, .size = p.n};
}

/* Takes the first entry of the rest, which then begins after it; `before` bytes precede entries. */
static bool
next_entry(struct part *rest, size_t before, unsigned *tag, struct part *entry)
{
    struct rc_bytes b = bytes_of(*rest);
    uint64_t n;

    if (rest->n < before + TAG)
        return false;
    b.at = before;
    *tag = rc_bytes_u16(&b);
    n = rc_bytes_u64(&b);
    if (n > rest->n - before - TAG)
        return false;
    *entry = (struct part){rest->data + before + TAG, (size_t)n};
    rest->data = entry->data + n;
    rest->n -= before + TAG + (size_t)n;
    return true;
}

/* Follows tags into the tree; returns an empty part if there is no such entry. */
static struct part
follow(struct part p, const uint16_t *tags, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        struct part rest = p, entry;
        unsigned tag;

        p = (struct part){NULL, 0};
        while (next_entry(&rest, 0, &tag, &entry))
            if (tag == tags[k]) {
                p = entry;
                break;
            }
    }
    return p;
}

#define FOLLOW(part, ...)                                                                          \
    follow(part, (const uint16_t[]){__VA_ARGS__},                                                  \
           sizeof(uint16_t[]){__VA_ARGS__} / sizeof(uint16_t))

static double
number_of(struct part p, enum rc_raw raw)
{
    struct rc_bytes b = bytes_of(p);

    return p.n == rc_raw_width(raw) ? rc_bytes_at(&b, 0, raw) : NAN;
}

static void
take_text(struct part p, char to[WORD])
{
    char text[3 * WORD + 3];
    size_t n = 0;

    for (size_t k = 1; p.n > 0 && p.data[0] == 4 && k + 1 < p.n && k / 2 < WORD; k += 2)
        n += rc_utf8_put(text + n, p.data[k] | (unsigned)p.data[k + 1] << 8);
    rc_text_clean(to, WORD, text, n);
}

static bool
is_of_class(struct part object, unsigned class)
{
    return number_of(FOLLOW(object, 1, 1), RC_RAW_U32) == class;
}

static void
take_scale(struct part p, struct scale *s)
{
    s->step = number_of(FOLLOW(p, 1), RC_RAW_F64);
    s->origin = number_of(FOLLOW(p, 5), RC_RAW_F64);
    take_text(FOLLOW(p, 2), s->unit);
    take_text(FOLLOW(p, 3), s->shown);
}

/* Reads an object of the document as a surface. Returns false for another kind of object. */
static bool
take_surface(struct part object, struct surface *s)
{
    struct part body, data, grid;

    if (!is_of_class(object, SURFACE))
        return false;
    body = FOLLOW(object, 2);
    data = FOLLOW(body, 1);
    if (!is_of_class(data, MEASURED))
        return false;
    data = FOLLOW(data, 2, FIRST);
    grid = FOLLOW(data, FIRST);
    if (!is_of_class(FOLLOW(data, 1), HEIGHTS))
        return false;
    *s = (struct surface){.heights = FOLLOW(data, 1, 2, 2)};
    if (is_of_class(FOLLOW(grid, 3), MASK))
        s->mask = FOLLOW(grid, 3, 2, 5, 2, 2);
    take_text(FOLLOW(grid, FIRST, FIRST, 1), s->name);
    if (s->name[0] == '\0')
        take_text(FOLLOW(body, FIRST, 4), s->name);
    take_scale(FOLLOW(grid, 1, FIRST, FIRST), &s->x);
    take_scale(FOLLOW(grid, 2, FIRST, FIRST), &s->y);
    take_scale(FOLLOW(data, 2, FIRST), &s->z);
    s->nx = (size_t)fmax(0, number_of(FOLLOW(grid, 1, FIRST, 1), RC_RAW_U32));
    s->ny = (size_t)fmax(0, number_of(FOLLOW(grid, 2, FIRST, 1), RC_RAW_U32));
    return true;
}

/* The list of objects in the document. */
static struct part
objects_of(struct part stream)
{
    size_t head = stream.n < 8 ? stream.n : 8; /* the length of the rest */
    struct part rest = {stream.data + head, stream.n - head};

    return FOLLOW(rest, 1, 0x2bd, 2, 1);
}

/* ---- packed arrays ---- */

/* The number at the start of a packed array: its bytes when unpacked; 0 if the array is shorter. */
static uint64_t
bytes_said(struct part p)
{
    struct rc_bytes b = bytes_of(p);
    uint64_t n = rc_bytes_u64(&b);

    return b.past ? 0 : n;
}

/* Unpacks n elements of `width` bytes into `to`; each has to come once. */
static enum rc_status
unpack(const char *what, struct part p, unsigned char *to, size_t n, size_t width,
       struct rc_err *err)
{
    struct rc_bytes b = bytes_of(p);
    size_t done = 0;

    b.at = 8;
    while (b.at < b.size) {
        uint64_t first = rc_bytes_u64(&b);
        size_t elements = rc_bytes_u32(&b), packed = rc_bytes_u32(&b);

        if (b.past || packed > b.size - b.at || first > n || elements > n - first ||
            elements > n - done)
            return rc_err_set(err, "the blocks of the %s do not fit the map of %zu points", what,
                              n);
        if (rc_inflate(what, p.data + b.at, packed, to + (size_t)first * width, elements * width,
                       err) != RC_OK)
            return RC_FAIL;
        b.at += packed;
        done += elements;
    }
    return rc_bytes_agree(what, (uint64_t)n * width, (uint64_t)done * width, err);
}

static enum rc_status
apply_mask(const struct surface *s, unsigned char *room, double *v, struct rc_err *err)
{
    if (unpack("marks of measured points", s->mask, room, (s->nx + 2) * (s->ny + 2), 1, err) !=
        RC_OK)
        return RC_FAIL;
    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = 0; i < s->nx; i++)
            if (room[(j + 1) * (s->nx + 2) + i + 1] != IS_MEASURED)
                v[j * s->nx + i] = NAN;
    return RC_OK;
}

static enum rc_status
read_heights(const struct surface *s, const struct rc_map *map, double *v, struct rc_err *err)
{
    size_t n = map->nx * map->ny, width = rc_raw_width(map->raw);
    size_t border = s->mask.data == NULL ? 0 : (map->nx + 2) * (map->ny + 2);
    struct rc_bytes b = {.size = n * width};
    RC_OWNED unsigned char *room = calloc(b.size > border ? b.size : border, 1);

    if (room == NULL)
        return rc_err_set(err, "out of memory for %zu bytes of heights", b.size);
    if (unpack("heights", s->heights, room, n, width, err) != RC_OK)
        return RC_FAIL;
    b.data = room;
    rc_bytes_values(&b, map->raw, v, n);
    return border == 0 ? RC_OK : apply_mask(s, room, v, err);
}

/* The stream of a document. */
struct document {
    unsigned char *stream;
    size_t n;
};

static void
document_close(void *opened)
{
    free(((struct document *)opened)->stream);
}

/* The surface that is number `wanted` in the document, from 0. */
static bool
find_surface(struct part stream, size_t wanted, struct surface *s)
{
    struct part rest = objects_of(stream), object;
    unsigned tag;

    while (next_entry(&rest, 8, &tag, &object))
        if (tag == 1 && take_surface(object, s) && wanted-- == 0)
            return true;
    return false;
}

static enum rc_status
fill_heights(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    const struct document *d = map->opened;
    struct surface s;

    (void)file;
    if (!find_surface((struct part){d->stream, d->n}, map->more, &s) || s.nx != map->nx ||
        s.ny != map->ny)
        return rc_err_set(err, "surface %zu cannot be found again", map->more + 1);
    return read_heights(&s, map, v, err);
}

/* ---- the file ---- */

static enum rc_status
add_surface(const struct rc_file *file, const struct surface *s, size_t number,
            struct rc_maps *maps, struct rc_err *err)
{
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(s->name));
    uint64_t said = bytes_said(s->heights), n = (uint64_t)s->nx * s->ny;
    double shown;

    if (rc_map_size(map, (double)s->nx, NULL, (double)s->ny, NULL, err) != RC_OK)
        return RC_FAIL;
    if (said / n * n != said || (said / n != 4 && said / n != 2))
        return rc_err_set(err, "%zu x %zu heights in %llu bytes: they must have 2 or 4 each", s->nx,
                          s->ny, (unsigned long long)said);
    map->raw = said / n == 4 ? RC_RAW_I32 : RC_RAW_I16;
    map->fill = fill_heights;
    map->more = number;
    rc_map_unit(map, rc_piece_of(s->z.unit));
    map->scale = s->z.step;
    shown = s->z.shown[0] == '\0' ? map->si : rc_word_metres(s->z.shown);
    map->zero = isnan(s->z.origin) ? 0 : s->z.origin * shown / map->si;
    map->dx = s->x.step * rc_word_metres(s->x.unit);
    map->dy = s->y.step * rc_word_metres(s->y.unit);
    return rc_map_bound(map, file, (double)said + (double)file->size, err);
}

static enum rc_status
mnt_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct document *d = rc_maps_open(maps, sizeof *d, document_close, err);
    struct part rest, object;
    struct surface s;
    unsigned tag;

    if (d == NULL || (d->stream = rc_ole_stream(file, stream_name, &d->n, err)) == NULL)
        return RC_FAIL;
    rest = objects_of((struct part){d->stream, d->n});
    for (size_t number = 0; next_entry(&rest, 8, &tag, &object);)
        if (tag == 1 && take_surface(object, &s) &&
            add_surface(file, &s, number++, maps, err) != RC_OK)
            return RC_FAIL;
    if (maps->n == 0)
        return rc_err_set(err, "the document has no measured surface, and computed ones are not in "
                               "the file: save SUR or X3P in the program");
    return RC_OK;
}

static int
mnt_score(const struct rc_file *file)
{
    return !rc_ole_is(file) ? 0 : rc_file_named(file, ".mnt") ? 90 : 30;
}

const struct rc_format rc_format_mnt = {
    .name = "mnt",
    .suffixes = ".mnt",
    .summary = "Digital Surf Mountains documents: surfaces as measured",
    .score = mnt_score,
    .find = mnt_find,
};
