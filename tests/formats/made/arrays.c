/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of arrays as NumPy, MATLAB and other programs write them. */
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "made.h"

enum {
    MI_INT8 = 1,
    MI_UINT16 = 4,
    MI_INT32 = 5,
    MI_UINT32 = 6,
    MI_DOUBLE = 9,
    MI_MATRIX = 14,
    MI_PACKED = 15
};

static void
add_padding(struct bytes *m, size_t from, size_t to)
{
    add_zeros(m, (to - (m->n - from) % to) % to);
}

/* An element of at most four bytes in the short form, a longer one in the long form. */
static void
add_element(struct bytes *m, unsigned type, const void *bytes, size_t n)
{
    size_t at = m->n;

    if (n <= 4)
        add_raw(m, RC_RAW_U32, (double)(n << 16 | type));
    else {
        add_raw(m, RC_RAW_U32, type);
        add_raw(m, RC_RAW_U32, (double)n);
    }
    add(m, bytes, n);
    add_padding(m, at, 8);
}

void
mat_header(struct bytes *m, bool big)
{
    static const char text[] = "MATLAB 5.0 MAT-file, made by hand";

    add_text(m, text);
    while (m->n < 124)
        add_text(m, " ");
    m->big = big;
    add_raw(m, RC_RAW_U16, 0x0100);
    add_raw(m, RC_RAW_U16, 'M' << 8 | 'I');
}

void
mat_array(struct bytes *m, const char *name, unsigned flags, size_t rows, size_t columns,
          unsigned type, const void *numbers, size_t n)
{
    struct bytes words = {.big = m->big};
    size_t at = m->n;

    add_raw(m, RC_RAW_U32, MI_MATRIX);
    add_raw(m, RC_RAW_U32, 0);
    add_raw(&words, RC_RAW_U32, flags);
    add_raw(&words, RC_RAW_U32, 0);
    add_raw(&words, RC_RAW_I32, (double)rows);
    add_raw(&words, RC_RAW_I32, (double)columns);
    add_element(m, MI_UINT32, words.data, 8);
    add_element(m, MI_INT32, words.data + 8, 8);
    add_element(m, MI_INT8, name, strlen(name));
    add_element(m, type, numbers, n);
    close_object(m, at + 4);
    drop(&words);
}

void
mat_pack(struct bytes *m, size_t at)
{
    uLongf n = compressBound(m->n - at);
    unsigned char *packed = malloc(n);

    if (packed == NULL || compress(packed, &n, m->data + at, m->n - at) != Z_OK)
        abort();
    m->n = at;
    add_raw(m, RC_RAW_U32, MI_PACKED);
    add_raw(m, RC_RAW_U32, (double)n);
    add(m, packed, n);
    free(packed);
}

void
mat_number(struct bytes *m, const char *name, double value)
{
    struct bytes number = {.big = m->big};

    add_raw(&number, RC_RAW_F64, value);
    mat_array(m, name, 6, 1, 1, MI_DOUBLE, number.data, number.n);
    drop(&number);
}

void
mat_text(struct bytes *m, const char *name, const char *text)
{
    struct bytes letters = {.big = m->big};

    for (const char *s = text; *s != '\0'; s++)
        add_raw(&letters, RC_RAW_U16, (unsigned char)*s);
    mat_array(m, name, 4, 1, strlen(text), MI_UINT16, letters.data, letters.n);
    drop(&letters);
}

/* 0: doubles; 1: packed variables; 2: whole numbers of 16 bits in an array of doubles, most significant byte
 * first; 3: axes as meshgrid makes them, y falling; 4: axes as vectors */
void
make_mat(struct bytes *m, int variant)
{
    static const unsigned types[] = {9, 9, 3, 7, 9};
    static const enum rc_raw raws[] = {RC_RAW_F64, RC_RAW_F64, RC_RAW_I16, RC_RAW_F32, RC_RAW_F64};
    struct bytes map = {.big = variant == 2}, x = {0}, y = {0};
    size_t at;

    mat_header(m, variant == 2);
    add_map(&map, raws[variant], COLUMNS, variant == 2 ? 50 : (double)NAN, 0);
    if (variant < 3) {
        mat_number(m, "dx", 1.1e-6);
        mat_number(m, "dy", 1.29e-6);
        mat_text(m, "dunit", "m");
    } else
        mat_text(m, "dunit", "um");
    for (size_t k = 0; k < NX * NY; k++) {
        if (variant == 3 || k % NY == 0)
            add_f64(&x, 1.1 * (double)(k / NY) - 7);
        if (variant == 3 || k < NY)
            add_f64(&y, variant == 3 ? 5 - 1.29 * (double)(k % NY) : 1.29 * (double)k);
    }
    if (variant >= 3) {
        mat_array(m, variant == 3 ? "X" : "x", 6, variant == 3 ? NY : 1, NX, MI_DOUBLE, x.data,
                  x.n);
        mat_array(m, variant == 3 ? "Y" : "y", 6, NY, variant == 3 ? NX : 1, MI_DOUBLE, y.data,
                  y.n);
    }
    mat_text(m, "unit", "nm");
    at = m->n;
    mat_array(m, "a_map", 6, NY, NX, types[variant], map.data, map.n);
    if (variant == 1)
        mat_pack(m, at);
    m->big = false;
    drop(&map);
    drop(&x);
    drop(&y);
}

/* 0: floats; 1: whole numbers of 16 bits, highest byte first, steps between nodes; 2: packed with
 * gzip; 3: text; 4: with directions in space; 5: with an axis of one value */
void
make_nrrd(struct bytes *m, int variant)
{
    static const char *const heads[] = {
        "type: float\nencoding: raw\nendian: little\ndimension: 2\nsizes: 3 2\naxismins: 1 1\n"
        "axismaxs: 4.3 3.58\nunits: \"um\" \"um\"\nsampleunits: \"nm\"\n\n",
        "# a comment\ntype: signed short int\nencoding: raw\nendian: big\ndimension: 2\nsizes: 3 "
        "2\n"
        "axis mins: 0 0\naxis maxs: 2.2 1290\ncenterings: node node\nunits: \"um\" \"nm\"\n"
        "sample units: \"nm\"\na key:=of a value\n\n",
        "type: double\nencoding: gz\nendian: little\ndimension: 2\nsizes: 3 2\n"
        "spacings: 1.1 1.29\nunits: \"um\" \"um\"\nsample units: \"nm\"\n\n",
        "type: float\nencoding: ascii\ndimension: 2\nsizes: 3 2\nspacings: 1.1 1.29\n"
        "units: \"um\" \"um\"\nsample units: \"nm\"\n\n10 -20 30\n40 nan -60\n",
        "type: float\nencoding: raw\nendian: little\ndimension: 3\nspace dimension: 3\nsizes: 3 2 "
        "1\n"
        "space directions: (1.1,0,0) (0, 0, -1.29) none\nspace units: \"um\" \"um\" \"um\"\n"
        "sample units: \"nm\"\n\n",
        "type: int\nencoding: raw\nendian: little\ndimension: 3\nsizes: 1 3 2\n"
        "spacings: nan 1.1 1.29\nunits: \"\" \"um\" \"um\"\nsample units: \"nm\"\n\n",
    };
    static const enum rc_raw raws[] = {RC_RAW_F32, RC_RAW_I16, RC_RAW_F64,
                                       RC_RAW_F32, RC_RAW_F32, RC_RAW_I32};
    struct bytes map = {.big = variant == 1};

    add_text(m, variant == 3 ? "NRRD0001\n" : "NRRD0004\n");
    add_text(m, heads[variant]);
    if (variant == 3)
        return;
    add_map(&map, raws[variant], ROWS, variant == 0 || variant == 2 ? (double)NAN : 50, 0);
    if (variant == 2) {
        unsigned char packed[512];
        z_stream z = {.next_in = map.data,
                      .avail_in = (uInt)map.n,
                      .next_out = packed,
                      .avail_out = sizeof packed};

        if (deflateInit2(&z, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK ||
            deflate(&z, Z_FINISH) != Z_STREAM_END)
            abort();
        add(m, packed, z.total_out);
        deflateEnd(&z);
    } else
        add(m, map.data, map.n);
    drop(&map);
}
