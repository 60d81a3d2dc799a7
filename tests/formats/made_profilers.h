/* Files of profilometers and interferometers, made by hand. */
#ifndef MADE_PROFILERS_H
#define MADE_PROFILERS_H

#include <zlib.h>

#include "made_bytes.h"

static void
make_sdf_text(struct made *m, int variant)
{
    text(m, variant == 0 ? "aISO-1.0\r\n" : "aBCR-1.0\n");
    text(m, "ManufacID = maker\nCreateDate = 010203040506\nModDate = 0\nNumPoints = 3\n"
            "NumProfiles = 2\nXscale = 1.1E-6\nYscale=1.29e-6\nZscale = 1e-9\nZresolution = 1\n"
            "Compression = 0\nDataType = 7\nCheckType = 0\n*\n");
    text(m, variant == 0 ? "10 -20 30\n40 BAD -60\n*\n<a>b</a>\n*\n"
                         : "10\n-20\r\n30 40\t\tNaN\n-60\n*");
}

static void
make_sdf_binary(struct made *m, int variant)
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

    text(m, "bISO-1.0maker     010203040506010203040506");
    number(m, RC_RAW_U16, NX);
    number(m, RC_RAW_U16, NY);
    number(m, RC_RAW_F64, 1.1e-6);
    number(m, RC_RAW_F64, 1.29e-6);
    number(m, RC_RAW_F64, 1e-9);
    number(m, RC_RAW_F64, 1);
    number(m, RC_RAW_U8, 0);
    number(m, RC_RAW_U8, variant);
    number(m, RC_RAW_U8, 0);
    numbers(m, types[variant].raw, ROWS, types[variant].missing, 0);
}

/* 0: 16 bits, 1: 32 bits, 2: compressed in two streams, 3: without missing points */
static void
make_sur(struct made *m, int variant)
{
    struct made raw = {0};

    zeros(m, 512);
    text_at(m, 0, variant == 2 ? "DSCOMPRESSED" : "DIGITAL SURF");
    number_at(m, 18, RC_RAW_I16, 2);
    text_at(m, 20, "name of it");
    number_at(m, 86, RC_RAW_I16, variant != 3);
    number_at(m, 98, RC_RAW_I16, variant == 0 ? 16 : 32);
    number_at(m, 100, RC_RAW_I32, -60);
    number_at(m, 104, RC_RAW_I32, 40);
    number_at(m, 108, RC_RAW_I32, NX);
    number_at(m, 112, RC_RAW_I32, NY);
    number_at(m, 116, RC_RAW_I32, NX * NY);
    number_at(m, 120, RC_RAW_F32, 1.1);
    number_at(m, 124, RC_RAW_F32, 0.00129);
    number_at(m, 128, RC_RAW_F32, 0.25);
    text_at(m, 180, "\xb5m");
    text_at(m, 196, "mm");
    text_at(m, 212, "nm");
    number_at(m, 334, RC_RAW_I16, 7);
    number_at(m, 336, RC_RAW_I16, 5);
    number_at(m, 474, RC_RAW_F32, 100);
    text(m, "commentPRIVA");
    numbers(variant == 2 ? &raw : m, variant == 0 ? RC_RAW_I16 : RC_RAW_I32, ROWS,
            variant == 3 ? 50 : -62, 0);
    if (variant == 2) {
        unsigned char small[2][100];
        uLongf n[2] = {100, 100};

        compress(small[0], &n[0], raw.b, 10);
        compress(small[1], &n[1], raw.b + 10, raw.n - 10);
        number(m, RC_RAW_U32, 2);
        number(m, RC_RAW_U32, 10);
        number(m, RC_RAW_U32, (double)n[0]);
        number(m, RC_RAW_U32, (double)(raw.n - 10));
        number(m, RC_RAW_U32, (double)n[1]);
        put(m, small[0], n[0]);
        put(m, small[1], n[1]);
        free(raw.b);
    }
}

static void
opd_entry(struct made *m, const char *name, int type, double length)
{
    size_t at = m->n;

    zeros(m, 24);
    text_at(m, at, name);
    number_at(m, at + 16, RC_RAW_I16, type);
    number_at(m, at + 18, RC_RAW_I32, length);
    number_at(m, at + 22, RC_RAW_U16, 0xffff);
}

/* 0: floats in RAW_DATA, 1: 16 bits in "RAW DATA", 2: floats in Raw */
static void
make_opd(struct made *m, int variant)
{
    static const char *const names[] = {"RAW_DATA", "RAW DATA", "Raw"};

    number(m, RC_RAW_U16, 1);
    opd_entry(m, "Directory", 1, 8 * 24);
    opd_entry(m, "odd \xff\xfe block", 15, 3);
    opd_entry(m, names[variant], 3, 6 + 6 * (variant == 1 ? 2 : 4));
    opd_entry(m, "Wavelength", 7, 4);
    opd_entry(m, "Pixel_size", 7, 4);
    opd_entry(m, "Aspect", 7, 4);
    opd_entry(m, "Mult", 6, 2);
    opd_entry(m, "Title", 5, 8);
    text(m, "abc");
    number(m, RC_RAW_U16, NX);
    number(m, RC_RAW_U16, NY);
    number(m, RC_RAW_U16, variant == 1 ? 2 : 4);
    numbers(m, variant == 1 ? RC_RAW_I16 : RC_RAW_F32, COLUMNS | BOTTOM,
            variant == 1 ? 32767 : 1e38, 0);
    number(m, RC_RAW_F32, 640);
    number(m, RC_RAW_F32, 1.1e-3);
    number(m, RC_RAW_F32, 1.25);
    number(m, RC_RAW_I16, 8);
    text(m, "a title");
    zeros(m, 1);
}

/* The phase resolution; 1 with the second magic, 2 with the third */
static void
make_metropro(struct made *m, int variant)
{
    m->big = true;
    zeros(m, 834);
    number_at(m, 0, RC_RAW_U32, 0x881b036fU + (unsigned)variant);
    number_at(m, 4, RC_RAW_I16, 1 + variant);
    number_at(m, 6, RC_RAW_U32, 834);
    number_at(m, 52, RC_RAW_I16, 1);
    number_at(m, 54, RC_RAW_I16, 4);
    number_at(m, 56, RC_RAW_I16, 1);
    number_at(m, 60, RC_RAW_I32, 8);
    number_at(m, 68, RC_RAW_I16, NX);
    number_at(m, 70, RC_RAW_I16, NY);
    number_at(m, 72, RC_RAW_I32, 4 * NX * NY);
    number_at(m, 164, RC_RAW_F32, 0.5);
    number_at(m, 168, RC_RAW_F32, 6.25e-7);
    number_at(m, 176, RC_RAW_F32, 2);
    number_at(m, 184, RC_RAW_F32, 1.1e-6);
    number_at(m, 218, RC_RAW_I16, variant);
    zeros(m, 8);
    numbers(m, RC_RAW_I32, ROWS, 2147483640, 0);
}

static void
al3d_tag(struct made *m, const char *key, const char *value)
{
    size_t at = m->n;

    zeros(m, 52);
    text_at(m, at, key);
    text_at(m, at + 20, value);
    text_at(m, at + 50, "\r\n");
}

static void
make_al3d(struct made *m, int variant)
{
    (void)variant;
    put(m, "AliconaImaging\0\r\n", 17);
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
    zeros(m, 800 - m->n);
    text_at(m, 17 + 52 * 10 + 254, "\r\n"); /* a comment of 256 bytes */
    numbers(m, RC_RAW_F32, ROWS, 3.00000002e15, 4);
}

static void
make_plu(struct made *m, int variant)
{
    (void)variant;
    zeros(m, 0x1fc);
    text_at(m, 0, "Fri Mar 10 16:35:59 2023");
    number_at(m, 0x184, RC_RAW_U32, NY);
    number_at(m, 0x188, RC_RAW_U32, NX);
    number_at(m, 0x194, RC_RAW_F32, 1.1);
    number_at(m, 0x198, RC_RAW_F32, 1.29);
    number_at(m, 0x18c, RC_RAW_U32, NX);
    number_at(m, 0x1ac, RC_RAW_U32, 3);
    number_at(m, 0x1f4, RC_RAW_U32, NY);
    number_at(m, 0x1f8, RC_RAW_U32, NX);
    numbers(m, RC_RAW_F32, ROWS, 1000001, 0);
}

#endif
