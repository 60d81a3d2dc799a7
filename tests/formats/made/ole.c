/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compound files of one stream, and documents of Mountains in them. */
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "made.h"

enum {
    SECTOR = 512,
    SMALL = 64,
    CUTOFF = 4096,
    FIRST = 0xffff
};

/* An entry of the directory, which is a binary tree. Names to the right of an entry come after it in the
 * order, and the child of the root entry is the top of the tree. */
static void
ole_entry(struct bytes *b, const char *name, int type, unsigned right, unsigned child,
          unsigned start, size_t size)
{
    size_t at = b->n, n = strlen(name);

    for (size_t k = 0; k < n; k++)
        add_raw(b, RC_RAW_U16, (unsigned char)name[k]);
    add_zeros(b, 64 - 2 * n);
    add_raw(b, RC_RAW_U16, n == 0 ? 0 : 2 * (double)(n + 1));
    add_raw(b, RC_RAW_U8, type);
    add_zeros(b, 1);
    add_raw(b, RC_RAW_U32, 0xffffffff);
    add_raw(b, RC_RAW_U32, right);
    add_raw(b, RC_RAW_U32, child);
    add_zeros(b, 116 - (b->n - at));
    add_raw(b, RC_RAW_U32, start);
    add_raw(b, RC_RAW_U64, (double)size);
}

/* Links of the n sectors from `first` on, then unused links up to the end of a sector. */
static void
ole_chain(struct bytes *b, size_t start, unsigned first, size_t n)
{
    for (size_t k = 0; k < n; k++)
        add_raw(b, RC_RAW_U32, k + 1 < n ? (double)(first + k + 1) : 0xfffffffe);
    while ((b->n - start) % SECTOR != 0)
        add_raw(b, RC_RAW_U32, 0xffffffff);
}

/* Sectors: 0 is the table, 1 the directory, 2 the table of small sectors. From 3 on there is the stream, or
 * the root's stream of small sectors that contains it. */
void
ole_file(struct bytes *b, const char *name, const struct bytes *stream)
{
    bool small = stream->n < CUTOFF;
    size_t sectors = (stream->n + SECTOR - 1) / SECTOR, start;

    add(b, "\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", 8);
    add_zeros(b, 16);
    add_raw(b, RC_RAW_U16, 0x3e);
    add_raw(b, RC_RAW_U16, 3);
    add_raw(b, RC_RAW_U16, 0xfffe);
    add_raw(b, RC_RAW_U16, 9);
    add_raw(b, RC_RAW_U16, 6);
    add_zeros(b, 44 - b->n);
    add_raw(b, RC_RAW_U32, 1); /* first sector of the table */
    add_raw(b, RC_RAW_U32, 1);
    add_zeros(b, 4);
    add_raw(b, RC_RAW_U32, CUTOFF);
    add_raw(b, RC_RAW_U32, 2);
    add_raw(b, RC_RAW_U32, 1);
    add_raw(b, RC_RAW_U32, 0xfffffffe);
    add_raw(b, RC_RAW_U32, 0);
    add_raw(b, RC_RAW_U32, 0);
    while (b->n < SECTOR)
        add_raw(b, RC_RAW_U32, 0xffffffff);
    add_raw(b, RC_RAW_U32, 0xfffffffd);
    add_raw(b, RC_RAW_U32, 0xfffffffe);
    add_raw(b, RC_RAW_U32, 0xfffffffe);
    ole_chain(b, SECTOR, 3, sectors);
    ole_entry(b, "Root Entry", 5, 0xffffffff, 1, small ? 3 : 0xfffffffe,
              small ? sectors * SECTOR : 0);
    ole_entry(b, "Another", 2, 2, 0xffffffff, 0xfffffffe, 0);
    ole_entry(b, name, 2, 0xffffffff, 0xffffffff, small ? 0 : 3, stream->n);
    ole_entry(b, "", 0, 0xffffffff, 0xffffffff, 0, 0);
    start = b->n;
    ole_chain(b, start, 0, small ? (stream->n + SMALL - 1) / SMALL : 0);
    while (b->n < start + SECTOR)
        add_raw(b, RC_RAW_U32, 0xffffffff);
    add(b, stream->data, stream->n);
    add_zeros(b, sectors * SECTOR - stream->n);
}

/* ---- entries of a document ---- */

/* An entry whose length `close` sets; an entry of a list has another length before it. */
static size_t
open_entry(struct bytes *b, unsigned tag, bool listed)
{
    if (listed)
        add_raw(b, RC_RAW_U64, 1);
    add_raw(b, RC_RAW_U16, tag);
    add_raw(b, RC_RAW_U64, 0);
    return b->n;
}

static void
close_entry(struct bytes *b, size_t at)
{
    set_raw(b, at - 8, RC_RAW_U64, (double)(b->n - at));
}

static void
number_entry(struct bytes *b, unsigned tag, enum rc_raw raw, double value)
{
    size_t at = open_entry(b, tag, false);

    add_raw(b, raw, value);
    close_entry(b, at);
}

static void
text_entry(struct bytes *b, unsigned tag, const char *text)
{
    size_t at = open_entry(b, tag, false);

    add_raw(b, RC_RAW_U8, 4);
    for (; *text != '\0'; text++)
        add_raw(b, RC_RAW_U16, (unsigned char)*text); /* Latin-1 */
    close_entry(b, at);
}

static void
class_entry(struct bytes *b, unsigned number)
{
    size_t at = open_entry(b, 1, false);

    number_entry(b, 1, RC_RAW_U32, number);
    close_entry(b, at);
}

static void
scale_entry(struct bytes *b, double step, const char *unit, const char *shown, double origin)
{
    size_t at = open_entry(b, FIRST, false);

    number_entry(b, 1, RC_RAW_F64, step);
    text_entry(b, 2, unit);
    text_entry(b, 3, shown);
    number_entry(b, 5, RC_RAW_F64, origin);
    close_entry(b, at);
}

static void
axis_entry(struct bytes *b, unsigned tag, double step, size_t n)
{
    size_t at = open_entry(b, tag, false), axis = open_entry(b, FIRST, false);

    scale_entry(b, step, "mm", "\xb5m", 7);
    number_entry(b, 1, RC_RAW_U32, (double)n);
    close_entry(b, axis);
    close_entry(b, at);
}

/* A packed array in two blocks, the later one first. */
static void
array_entry(struct bytes *b, unsigned tag, unsigned class, const struct bytes *raw, size_t width)
{
    size_t at = open_entry(b, tag, false), array, data, n = raw->n / width, half = n / 2;

    class_entry(b, class);
    array = open_entry(b, 2, false);
    number_entry(b, 1, RC_RAW_U32, (double)n);
    data = open_entry(b, 2, false);
    add_raw(b, RC_RAW_U64, (double)raw->n);
    for (int k = 1; k >= 0; k--) {
        size_t first = k == 1 ? half : 0, many = k == 1 ? n - half : half;
        uLongf size = compressBound(many * width);
        unsigned char *packed = malloc(size);

        if (packed == NULL ||
            compress(packed, &size, raw->data + first * width, many * width) != Z_OK)
            abort();
        add_raw(b, RC_RAW_U64, (double)first);
        add_raw(b, RC_RAW_U32, (double)many);
        add_raw(b, RC_RAW_U32, (double)size);
        add(b, packed, size);
        free(packed);
    }
    close_entry(b, data);
    close_entry(b, array);
    close_entry(b, at);
}

static void
mask_entry(struct bytes *b)
{
    size_t at = open_entry(b, 3, false), mask;
    struct bytes marks = {0};

    class_entry(b, 9056);
    mask = open_entry(b, 2, false);
    number_entry(b, 1, RC_RAW_U32, NX);
    number_entry(b, 2, RC_RAW_U32, NY);
    for (size_t k = 0; k < (NX + 2) * (NY + 2); k++) {
        size_t i = k % (NX + 2), j = k / (NX + 2);
        bool border = i == 0 || j == 0 || i == NX + 1 || j == NY + 1;

        add_raw(&marks, RC_RAW_U8, border ? 0 : (j - 1) * NX + i - 1 == MISSING_AT ? 22 : 9);
    }
    array_entry(b, 5, 9048, &marks, 1);
    close_entry(b, mask);
    close_entry(b, at);
    drop(&marks);
}

static void
surface_entry(struct bytes *b, int variant)
{
    size_t object = open_entry(b, 1, true), body, data, inner, measured, grid, name[3];
    struct bytes heights = {0};

    class_entry(b, 9012);
    body = open_entry(b, 2, false);
    data = open_entry(b, 1, false);
    class_entry(b, 9062);
    inner = open_entry(b, 2, false);
    measured = open_entry(b, FIRST, false);
    grid = open_entry(b, FIRST, false);
    for (int k = 0; k < 2; k++)
        name[k] = open_entry(b, FIRST, false);
    text_entry(b, 1, "My \xb5 surface");
    for (int k = 1; k >= 0; k--)
        close_entry(b, name[k]);
    axis_entry(b, 1, 1.1e-3, NX);
    axis_entry(b, 2, 1.29e-3, NY);
    if (variant == 0)
        mask_entry(b);
    close_entry(b, grid);
    add_map(&heights, variant == 0 ? RC_RAW_I32 : RC_RAW_I16, ROWS, 50, 0);
    array_entry(b, 1, 9049, &heights, variant == 0 ? 4 : 2);
    drop(&heights);
    grid = open_entry(b, 2, false);
    scale_entry(b, 0.5, "nm", "\xb5m", 0.025);
    close_entry(b, grid);
    close_entry(b, measured);
    close_entry(b, inner);
    close_entry(b, data);
    close_entry(b, body);
    close_entry(b, object);
}

/* 0: 32 bits and a mask, in small sectors; 1: 16 bits, after so many other bytes that they are in large
 * sectors */
void
make_mnt(struct bytes *m, int variant)
{
    struct bytes b = {0};
    size_t top, list[3], other;

    add_zeros(&b, 8);
    top = open_entry(&b, 1, false);
    text_entry(&b, 0xcb, "DS-1");
    list[0] = open_entry(&b, 0x2bd, false);
    list[1] = open_entry(&b, 2, false);
    list[2] = open_entry(&b, 1, false);
    other = open_entry(&b, 1, true); /* an object of another class */
    class_entry(&b, 42);
    if (variant == 1) {
        size_t at = open_entry(&b, 2, false);

        add_zeros(&b, 5000);
        close_entry(&b, at);
    }
    close_entry(&b, other);
    surface_entry(&b, variant);
    for (int k = 2; k >= 0; k--)
        close_entry(&b, list[k]);
    close_entry(&b, top);
    set_raw(&b, 0, RC_RAW_U64, (double)b.n - 8);
    ole_file(m, "ScopedContents", &b);
    drop(&b);
}
