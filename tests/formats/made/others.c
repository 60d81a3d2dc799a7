/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of other instruments and programs, made by hand. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <zip.h>

#include "made.h"

/* 0: i16, 1: i16 most significant byte first, 2: floats in um, 3: the same with a wide header */
void
make_bcr(struct bytes *m, int variant)
{
    struct bytes head = {0};

    add_text(&head, variant < 2    ? "fileformat = bcrstm\n"
                    : variant == 2 ? "fileformat = bcrf\n"
                                   : "fileformat = bcrf_unicode\n");
    add_text(&head,
             "%\nheadersize = 2048\nxpixels = 3\nypixels = 2\nxlength = 3300\nylength = 2580\n"
             "bit2nm = 0.25\n");
    add_text(&head, variant == 1 ? "intelmode = 0\n" : "intelmode = 1\n");
    add_text(&head, variant < 2
                        ? "voidpixels = 32767\n"
                        : "voidpixels = 3.402823E+38\nxunit = nm\nyunit = nm\nzunit = um\n");
    while (head.n < 2048)
        add_text(&head, " ");
    for (size_t k = 0; k < head.n; k++)
        add(m, (char[]){(char)head.data[k], '\0'}, variant == 3 ? 2 : 1);
    drop(&head);
    m->big = variant == 1;
    add_map(m, variant < 2 ? RC_RAW_I16 : RC_RAW_F32, ROWS,
            variant < 2 ? 32767 : 3.4028234663852886e38, 0);
}

static void
frt_block(struct bytes *m, bool is_long, int kind, double n)
{
    add_raw(m, RC_RAW_U16, kind);
    add_raw(m, is_long ? RC_RAW_U64 : RC_RAW_U32, n);
}

void
make_frt(struct bytes *m, int variant)
{
    bool is_long = variant == 1;

    add_text(m, is_long ? "FRTM_GLIDERV1.01" : "FRTM_GLIDERV1.00");
    add_raw(m, RC_RAW_U16, 6);
    frt_block(m, is_long, 0x65, 5);
    add_text(m, "hello");
    frt_block(m, is_long, 0x66, 12);
    add_raw(m, RC_RAW_U32, NX);
    add_raw(m, RC_RAW_U32, NY);
    add_raw(m, RC_RAW_U32, is_long ? 32 : 16);
    frt_block(m, is_long, 0x67, 44);
    add_raw(m, RC_RAW_F64, 3.3e-6);
    add_raw(m, RC_RAW_F64, 2.58e-6);
    add_zeros(m, 28);
    frt_block(m, is_long, 0x1234, 3);
    add_zeros(m, 3);
    frt_block(m, is_long, 0x6c, 12);
    add_raw(m, RC_RAW_U32, 300);
    add_raw(m, RC_RAW_F64, 1e-9);
    frt_block(m, is_long, 0x0b, is_long ? 24 : 12);
    add_map(m, is_long ? RC_RAW_I32 : RC_RAW_U16, BOTTOM, 1, 0);
}

void
make_tmd(struct bytes *m, int variant)
{
    add(m, "Binary TrueMap Data File v2.0\r\n", 32);
    add_text(m, variant == 0 ? "Created by TrueMap v6\r\n" : "");
    add_zeros(m, 1);
    add_raw(m, RC_RAW_I32, NX);
    add_raw(m, RC_RAW_I32, NY);
    add_raw(m, RC_RAW_F32, variant == 0 ? 3.3 : 3.3e-3);
    add_raw(m, RC_RAW_F32, variant == 0 ? 2.58 : 2.58e-3);
    add_zeros(m, 8);
    add_map(m, RC_RAW_F32, ROWS, NAN, 0);
}

/* 0: text, 1: version 6, 2: version 7 with its own blank */
void
make_grd(struct bytes *m, int variant)
{
    if (variant == 0) {
        add_text(m, "DSAA\r\n3 2\r\n0 2.2\r\n5 6.29\r\n-60 40\r\n40 1.70141e+038\r\n-60\r\n\r\n"
                    "10 -20 30\r\n");
    } else if (variant == 1) {
        add_text(m, "DSBB");
        add_raw(m, RC_RAW_I16, NX);
        add_raw(m, RC_RAW_I16, NY);
        for (size_t k = 0; k < 6; k++)
            add_raw(m, RC_RAW_F64, (double[]){0, 2.2, 5, 6.29, -60, 40}[k]);
        add_map(m, RC_RAW_F32, BOTTOM, 1.70141e38, 0);
    } else {
        add_text(m, "DSRB");
        add_raw(m, RC_RAW_I32, 4);
        add_raw(m, RC_RAW_I32, 2);
        add_text(m, "GRID");
        add_raw(m, RC_RAW_I32, 72);
        add_raw(m, RC_RAW_I32, NY);
        add_raw(m, RC_RAW_I32, NX);
        for (size_t k = 0; k < 8; k++)
            add_raw(m, RC_RAW_F64, (double[]){0, 5, 1.1, 1.29, -60, 40, 0, 1e20}[k]);
        add_text(m, "ODD ");
        add_raw(m, RC_RAW_I32, 3);
        add_zeros(m, 3);
        add_text(m, "DATA");
        add_raw(m, RC_RAW_I32, 48);
        add_map(m, RC_RAW_F64, BOTTOM, 1e20, 0);
    }
}

void
make_esri(struct bytes *m, int variant)
{
    add_text(m, variant == 0 ? "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1.1\n"
                               "NODATA_value -1e3\n10 -20 30\n40 -1000 -60\n"
                             : "NCOLS 3\r\nNROWS 2\r\nXLLCENTER 0\r\nYLLCENTER 0\r\nDX 1.1\r\n"
                               "DY 1.29\r\n 10 -20 30 40\r\n-9999 -60");
}

/* Corner (i, j) of a triangle in mm. */
static void
stl_corner(struct bytes *m, int variant, size_t i, size_t j)
{
    double z = value_of(j * NX + i, true), x = 1.1e-3 * (double)i,
           y = 1.29e-3 * (double)(NY - 1 - j);
    char text[80];

    if (variant == 0) {
        add_raw(m, RC_RAW_F32, x);
        add_raw(m, RC_RAW_F32, y);
        add_raw(m, RC_RAW_F32, z);
        return;
    }
    snprintf(text, sizeof text, "   vertex %.4f %.5f %g\r\n", x, y, z);
    add_text(m, text);
}

/* A triangle over a cell, counterclockwise from above, with a normal of 0. */
static void
stl_triangle(struct bytes *m, int variant, size_t i, size_t j, bool upper)
{
    if (variant == 0)
        add_zeros(m, 12);
    else
        add_text(m, " facet normal 0 0 0\r\n  outer loop\r\n");
    stl_corner(m, variant, i, j);
    stl_corner(m, variant, upper ? i + 1 : i, j + 1);
    stl_corner(m, variant, i + 1, upper ? j : j + 1);
    if (variant == 0)
        add_zeros(m, 2);
    else
        add_text(m, "  endloop\r\n endfacet\r\n");
}

/* 0: binary, 1: text */
void
make_stl(struct bytes *m, int variant)
{
    if (variant == 0) {
        add_zeros(m, 80);
        add_raw(m, RC_RAW_U32, 4);
    } else
        add_text(m, "solid sheet\r\n");
    for (size_t i = 0; i + 1 < NX; i++) {
        stl_triangle(m, variant, i, 0, false);
        stl_triangle(m, variant, i, 0, true);
    }
    if (variant == 1)
        add_text(m, "endsolid sheet\r\n");
}

/* Variants 0 to 9 differ in the type. 10: the first transposed; 11: version 2 of the header, big */
void
make_npy(struct bytes *m, int variant)
{
    static const char *const names[] = {"<f8", "<f4", "|i1", ">i2", "<i4", "<i8",
                                        "|u1", "<u2", ">u4", "<u8", ">f8", "<f8"};
    static const enum rc_raw raws[] = {RC_RAW_F64, RC_RAW_F32, RC_RAW_I8,  RC_RAW_I16,
                                       RC_RAW_I32, RC_RAW_I64, RC_RAW_U8,  RC_RAW_U16,
                                       RC_RAW_U32, RC_RAW_U64, RC_RAW_F64, RC_RAW_F64};
    char header[200];

    snprintf(header, sizeof header, "{'descr': '%s', 'fortran_order': %s, 'shape': (2, 3), }\n",
             names[variant], variant == 10 ? "True" : "False");
    add_text(m, "\x93NUMPY");
    add(m, variant == 11 ? "\2\0" : "\1\0", 2);
    add_raw(m, variant == 11 ? RC_RAW_U32 : RC_RAW_U16, (double)strlen(header));
    add_text(m, header);
    m->big = names[variant][0] == '>';
    add_map(m, raws[variant], variant == 10 ? COLUMNS : ROWS, variant < 2 || variant > 9 ? NAN : 50,
            0);
}

static void
opdx_name(struct bytes *m, const char *name, int type)
{
    add_raw(m, RC_RAW_U32, (double)strlen(name));
    add_text(m, name);
    add_raw(m, RC_RAW_U8, type);
}

static size_t
opdx_open(struct bytes *m, const char *name, int type)
{
    opdx_name(m, name, type);
    add_raw(m, RC_RAW_U8, 4);
    add_zeros(m, 4);
    return m->n - 4;
}

static void
opdx_close(struct bytes *m, size_t at)
{
    opdx_name(m, "", 0x7f);
    add(m, "\xff\xff", 2);
    close_object(m, at);
}

static void
opdx_quantity(struct bytes *m, const char *name, double value, const char *unit)
{
    opdx_name(m, name, 0x13);
    add_raw(m, RC_RAW_U8, 1);
    add_raw(m, RC_RAW_U8, (double)(8 + 4 + 4 + 4 + strlen(unit)));
    add_raw(m, RC_RAW_F64, value);
    add_raw(m, RC_RAW_U32, 4);
    add_text(m, "Unit");
    add_raw(m, RC_RAW_U32, (double)strlen(unit));
    add_text(m, unit);
}

/* 0: a map in Matrix, 1: the same in the variant without a name */
void
make_opdx(struct bytes *m, int variant)
{
    size_t top, channel, raw;

    add(m, "VCA DATA\1\0\0U", 12);
    top = opdx_open(m, "2D_Data", 0x7d);
    channel = opdx_open(m, "Raw", 0x47);
    opdx_quantity(m, "Dimension1Extent", 1.29, "\xc2\xb5m");
    opdx_quantity(m, "Dimension2Extent", 2200, "nm");
    opdx_quantity(m, "DataScale", 0.25, "nm");
    opdx_name(m, "flag", 0x01);
    add_raw(m, RC_RAW_U8, 1);
    opdx_name(m, "when", 0x15);
    add_zeros(m, 9);
    opdx_name(m, "Matrix", variant == 0 ? 0x00 : 0x45);
    add_raw(m, RC_RAW_U32, 6);
    add_text(m, "Matrix");
    if (variant == 0) {
        add_raw(m, RC_RAW_U32, 1);
        add_raw(m, RC_RAW_U32, 5);
        add_text(m, "float");
    }
    add_raw(m, RC_RAW_U8, 2);
    add_raw(m, RC_RAW_U16, 8 + 24);
    raw = m->n;
    add_raw(m, RC_RAW_U32, NY);
    add_raw(m, RC_RAW_U32, NX);
    add_map(m, RC_RAW_F32, ROWS, NAN, 0);
    (void)raw;
    opdx_close(m, channel);
    opdx_close(m, top);
    top = opdx_open(m, "MetaData", 0x7d);
    opdx_name(m, "Date", 0x12);
    add_raw(m, RC_RAW_U8, 1);
    add_raw(m, RC_RAW_U8, 9);
    add_text(m, "2/11/2021");
    opdx_close(m, top);
    opdx_name(m, "", 0x7f);
    add(m, "\xff\xff", 2);
}

void
make_vk4(struct bytes *m, int variant)
{
    static const enum rc_raw raws[] = {RC_RAW_U32, RC_RAW_U16, RC_RAW_U8};
    size_t conditions = variant == 1 ? 80 : 84, image = conditions + 304;
    enum rc_raw raw = raws[variant];

    add_zeros(m, image + 28 + 768);
    set_text(m, 0, variant == 1 ? "VK3_" : "VK4_");
    set_raw(m, 12, RC_RAW_U32, (double)conditions);
    set_raw(m, conditions, RC_RAW_U32, 304);
    set_raw(m, 36, RC_RAW_U32, (double)image);
    for (size_t k = 0; k < 6; k++)
        set_raw(m, conditions + 4 + 4 * k, RC_RAW_U32, (double[]){2020, 2, 29, 13, 14, 15}[k]);
    set_raw(m, conditions + 168, RC_RAW_U32, 1100000);
    set_raw(m, conditions + 172, RC_RAW_U32, 1290000);
    set_raw(m, conditions + 176, RC_RAW_U32, 100);
    set_raw(m, image, RC_RAW_U32, NX);
    set_raw(m, image + 4, RC_RAW_U32, NY);
    set_raw(m, image + 8, RC_RAW_U32, (double)(8 * rc_raw_width(raw)));
    set_raw(m, image + 16, RC_RAW_U32, (double)(6 * rc_raw_width(raw)));
    add_map(m, raw, ROWS, 50, 0);
}

/* The last position of these four bytes. */
static size_t
last_of(const struct bytes *m, const char *bytes)
{
    size_t at = m->n - 4;

    while (memcmp(m->data + at, bytes, 4) != 0)
        at--;
    return at;
}

/* VK6 (variant 0) and VK7: a picture that contains the bytes PK 3 4 too, and an archive. In VK7 the offsets
 * of the archive count from the start of the file. */
void
make_vk6(struct bytes *m, int variant)
{
    zip_source_t *source = zip_source_buffer_create(NULL, 0, 0, NULL);
    zip_t *zip = zip_open_from_source(source, ZIP_TRUNCATE, NULL);
    struct bytes inner = {0};
    unsigned char *bytes;
    size_t before;
    zip_stat_t st;

    make_vk4(&inner, 0);
    zip_source_keep(source);
    zip_file_add(zip, "Vk4File", zip_source_buffer(zip, inner.data, inner.n, 0), ZIP_FL_ENC_UTF_8);
    zip_close(zip);
    zip_source_stat(source, &st);
    bytes = malloc((size_t)st.size);
    zip_source_open(source);
    zip_source_read(source, bytes, st.size);
    zip_source_close(source);
    zip_source_free(source);
    add_text(m, variant == 0 ? "VK6" : "VK7");
    add_text(m, "BM a picture with PK\3\4 in it");
    before = m->n;
    add(m, bytes, (size_t)st.size);
    if (variant == 1) {
        size_t end = last_of(m, "PK\5\6");
        struct rc_bytes b = {.data = m->data, .size = m->n};
        set_raw(m, last_of(m, "PK\1\2") + 42, RC_RAW_U32, (double)before);
        set_raw(m, end + 16, RC_RAW_U32, rc_bytes_at(&b, end + 16, RC_RAW_U32) + (double)before);
    }
    free(bytes);
    drop(&inner);
}

/* Points in two orders, with commas and a header, and without one of the points. */
void
make_xyz(struct bytes *m, int variant)
{
    add_text(m,
             variant == 0   ? "0 5 10\n1.1 5 -20\n2.2 5 30\n0 6.29 40\n2.2 6.29 -60\n1.1 6.29 nan\n"
             : variant == 1 ? "# some points\nx, y, z\n0,6.29,40\n0,5,10\n1.1,5,-20\n2.2,6.29,-60\n"
                              "2.2,5,30\n"
                            : "2.2\t6.29\t-60\r\n1.1\t6.29\tNaN\r\n0\t6.29\t40\r\n2.2\t5\t30\r\n"
                              "1.1\t5\t-20\r\n0\t5\t10\r\n");
}
