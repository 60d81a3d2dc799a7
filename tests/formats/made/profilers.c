/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of profilometers and interferometers, made by hand. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <zlib.h>

#include "made.h"

void
make_sdf_text(struct bytes *m, int variant)
{
    add_text(m, variant == 0 ? "aISO-1.0\r\n" : "aBCR-1.0\n");
    add_text(m, "ManufacID = maker\nCreateDate = 010203040506\nModDate = 0\nNumPoints = 3\n"
                "NumProfiles = 2\nXscale = 1.1E-6\nYscale=1.29e-6\nZscale = 1e-9\nZresolution = 1\n"
                "Compression = 0\nDataType = 7\nCheckType = 0\n*\n");
    add_text(m, variant == 0 ? "10 -20 30\n40 BAD -60\n*\n<a>b</a>\n*\n"
                             : "10\n-20\r\n30 40\t\tNaN\n-60\n*");
}

void
make_sdf_binary(struct bytes *m, int variant)
{
    static const struct {
        enum rc_raw raw;
        double missing;
    } types[] = {
        {RC_RAW_U8, 50},
        {RC_RAW_U16, 50},
        {RC_RAW_U32, 50},
        {RC_RAW_F32, NAN},
        {RC_RAW_I8, -128},
        {RC_RAW_I16, -32768},
        {RC_RAW_I32, -2147483648.0},
        {RC_RAW_F64, NAN},
    };

    add_text(m, "bISO-1.0maker     010203040506010203040506");
    add_raw(m, RC_RAW_U16, NX);
    add_raw(m, RC_RAW_U16, NY);
    add_raw(m, RC_RAW_F64, 1.1e-6);
    add_raw(m, RC_RAW_F64, 1.29e-6);
    add_raw(m, RC_RAW_F64, 1e-9);
    add_raw(m, RC_RAW_F64, 1);
    add_raw(m, RC_RAW_U8, 0);
    add_raw(m, RC_RAW_U8, variant);
    add_raw(m, RC_RAW_U8, 0);
    add_map(m, types[variant].raw, ROWS, types[variant].missing, 0);
}

/* 0: 16 bits, 1: 32 bits, 2: compressed in two streams, 3: without missing points */
void
make_sur(struct bytes *m, int variant)
{
    struct bytes raw = {0};

    add_zeros(m, 512);
    set_text(m, 0, variant == 2 ? "DSCOMPRESSED" : "DIGITAL SURF");
    set_raw(m, 18, RC_RAW_I16, 2);
    set_text(m, 20, "name of it");
    set_raw(m, 86, RC_RAW_I16, variant != 3);
    set_raw(m, 98, RC_RAW_I16, variant == 0 ? 16 : 32);
    set_raw(m, 100, RC_RAW_I32, -60);
    set_raw(m, 104, RC_RAW_I32, 40);
    set_raw(m, 108, RC_RAW_I32, NX);
    set_raw(m, 112, RC_RAW_I32, NY);
    set_raw(m, 116, RC_RAW_I32, NX * NY);
    set_raw(m, 120, RC_RAW_F32, 1.1);
    set_raw(m, 124, RC_RAW_F32, 0.00129);
    set_raw(m, 128, RC_RAW_F32, 0.25);
    set_text(m, 180, "\xb5m");
    set_text(m, 196, "mm");
    set_text(m, 212, "nm");
    set_raw(m, 334, RC_RAW_I16, 7);
    set_raw(m, 336, RC_RAW_I16, 5);
    set_raw(m, 474, RC_RAW_F32, 100);
    add_text(m, "commentPRIVA");
    add_map(variant == 2 ? &raw : m, variant == 0 ? RC_RAW_I16 : RC_RAW_I32, ROWS,
            variant == 3 ? 50 : -62, 0);
    if (variant == 2) {
        unsigned char small[2][100];
        uLongf n[2] = {100, 100};

        compress(small[0], &n[0], raw.data, 10);
        compress(small[1], &n[1], raw.data + 10, raw.n - 10);
        add_raw(m, RC_RAW_U32, 2);
        add_raw(m, RC_RAW_U32, 10);
        add_raw(m, RC_RAW_U32, (double)n[0]);
        add_raw(m, RC_RAW_U32, (double)(raw.n - 10));
        add_raw(m, RC_RAW_U32, (double)n[1]);
        add(m, small[0], n[0]);
        add(m, small[1], n[1]);
        drop(&raw);
    }
}

static void
opd_entry(struct bytes *m, const char *name, int type, double length)
{
    size_t at = m->n;

    add_zeros(m, 24);
    set_text(m, at, name);
    set_raw(m, at + 16, RC_RAW_I16, type);
    set_raw(m, at + 18, RC_RAW_I32, length);
    set_raw(m, at + 22, RC_RAW_U16, 0xffff);
}

/* 0: floats in RAW_DATA, 1: 16 bits in "RAW DATA", 2: floats in Raw, and header numbers of unusual types */
void
make_opd(struct bytes *m, int variant)
{
    static const char *const names[] = {"RAW_DATA", "RAW DATA", "Raw"};

    add_raw(m, RC_RAW_U16, 1);
    opd_entry(m, "Directory", 1, 8 * 24);
    opd_entry(m, "odd \xff\xfe block", 15, 3);
    opd_entry(m, names[variant], 3, 6 + 6 * (variant == 1 ? 2 : 4));
    opd_entry(m, "Wavelength", variant == 2 ? 12 : 7, 4);
    opd_entry(m, "Pixel_size", 7, 4);
    opd_entry(m, "Aspect", variant == 2 ? 8 : 7, variant == 2 ? 8 : 4);
    opd_entry(m, "Mult", variant == 2 ? 7 : 6, variant == 2 ? 4 : 2);
    opd_entry(m, "Title", 5, 8);
    add_text(m, "abc");
    add_raw(m, RC_RAW_U16, NX);
    add_raw(m, RC_RAW_U16, NY);
    add_raw(m, RC_RAW_U16, variant == 1 ? 2 : 4);
    add_map(m, variant == 1 ? RC_RAW_I16 : RC_RAW_F32, COLUMNS | BOTTOM,
            variant == 1 ? 32767 : 1e38, 0);
    add_raw(m, variant == 2 ? RC_RAW_I32 : RC_RAW_F32, 640);
    add_raw(m, RC_RAW_F32, 1.1e-3);
    add_raw(m, variant == 2 ? RC_RAW_F64 : RC_RAW_F32, 1.25);
    add_raw(m, variant == 2 ? RC_RAW_F32 : RC_RAW_I16, 8);
    add_text(m, "a title");
    add_zeros(m, 1);
}

/* The phase resolution; 1 with the second magic, 2 with the third */
void
make_metropro(struct bytes *m, int variant)
{
    m->big = true;
    add_zeros(m, 834);
    set_raw(m, 0, RC_RAW_U32, 0x881b036fU + (unsigned)variant);
    set_raw(m, 4, RC_RAW_I16, 1 + variant);
    set_raw(m, 6, RC_RAW_U32, 834);
    set_raw(m, 52, RC_RAW_I16, 1);
    set_raw(m, 54, RC_RAW_I16, 4);
    set_raw(m, 56, RC_RAW_I16, 1);
    set_raw(m, 60, RC_RAW_I32, 8);
    set_raw(m, 68, RC_RAW_I16, NX);
    set_raw(m, 70, RC_RAW_I16, NY);
    set_raw(m, 72, RC_RAW_I32, 4 * NX * NY);
    set_raw(m, 164, RC_RAW_F32, 0.5);
    set_raw(m, 168, RC_RAW_F32, 6.25e-7);
    set_raw(m, 176, RC_RAW_F32, 2);
    set_raw(m, 184, RC_RAW_F32, 1.1e-6);
    set_raw(m, 218, RC_RAW_I16, variant);
    add_zeros(m, 8);
    add_map(m, RC_RAW_I32, ROWS, 2147483640, 0);
}

static void
al3d_tag(struct bytes *m, const char *key, const char *value)
{
    size_t at = m->n;

    add_zeros(m, 52);
    set_text(m, at, key);
    set_text(m, at + 20, value);
    set_text(m, at + 50, "\r\n");
}

void
make_al3d(struct bytes *m, int variant)
{
    (void)variant;
    add(m, "AliconaImaging\0\r\n", 17);
    al3d_tag(m, "Version", "1");
    al3d_tag(m, "TagCount", "8");
    al3d_tag(m, "Cols", "3");
    al3d_tag(m, "PlaceHolder", "BM\x1b\xff");
    al3d_tag(m, "Rows", "2");
    al3d_tag(m, "DepthImageOffset", "800");
    al3d_tag(m, "PixelSizeXMeter", "1.1e-06");
    al3d_tag(m, "PixelSizeYMeter", "1.29e-06");
    al3d_tag(m, "InvalidPixelValue", "3.00000002e+15");
    al3d_tag(m, "Creator", "x");
    add_zeros(m, 800 - m->n);
    set_text(m, 17 + 52 * 10 + 254, "\r\n"); /* a comment of 256 bytes */
    add_map(m, RC_RAW_F32, ROWS, 3.00000002e15, 4);
}

void
make_plu(struct bytes *m, int variant)
{
    (void)variant;
    add_zeros(m, 0x1fc);
    set_text(m, 0, "Fri Mar 10 16:35:59 2023");
    set_raw(m, 0x184, RC_RAW_U32, NY);
    set_raw(m, 0x188, RC_RAW_U32, NX);
    set_raw(m, 0x194, RC_RAW_F32, 1.1);
    set_raw(m, 0x198, RC_RAW_F32, 1.29);
    set_raw(m, 0x18c, RC_RAW_U32, NX);
    set_raw(m, 0x1ac, RC_RAW_U32, 3);
    set_raw(m, 0x1f4, RC_RAW_U32, NY);
    set_raw(m, 0x1f8, RC_RAW_U32, NX);
    add_map(m, RC_RAW_F32, ROWS, 1000001, 0);
}
