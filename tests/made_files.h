/*
 * Small files of every flat format, byte by byte as its specification has them and not by a writer
 * of ours: 3 columns, 2 rows, and every variant that the readers know. The numbers are
 *
 *      10  20  30      and -20, -60 instead where the type has a sign;
 *      40  50  60      50 is missing where the format can say so
 */
#ifndef MADE_FILES_H
#define MADE_FILES_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <zip.h>
#include <zlib.h>

#include "formats/bytes.h"

enum {
    NX = 3,
    NY = 2,
    LOST_AT = 4
};

struct made {
    unsigned char *b;
    size_t n, room;
    bool big;
};

static inline void
put(struct made *m, const void *bytes, size_t n)
{
    while (m->n + n > m->room) {
        m->room = m->room == 0 ? 4096 : 2 * m->room;
        m->b = realloc(m->b, m->room);
    }
    memcpy(m->b + m->n, bytes, n);
    m->n += n;
}

static inline void
text(struct made *m, const char *s)
{
    put(m, s, strlen(s));
}

static inline void
zeros(struct made *m, size_t n)
{
    for (; n > 0; n--)
        put(m, "", 1);
}

/* The number in that type and the byte order of m. */
static inline void
number(struct made *m, enum rc_raw raw, double value)
{
    size_t n = rc_raw_width(raw);
    unsigned char bytes[8];
    uint64_t bits;
    float f = (float)value;
    uint32_t f_bits;

    bits = value < 0 ? (uint64_t)(int64_t)value : (uint64_t)(value < 1e19 ? value : 0);
    if (raw == RC_RAW_F64)
        memcpy(&bits, &value, 8);
    if (raw == RC_RAW_F32) {
        memcpy(&f_bits, &f, 4);
        bits = f_bits;
    }
    for (size_t k = 0; k < n; k++)
        bytes[m->big ? n - 1 - k : k] = (unsigned char)(bits >> 8 * k);
    put(m, bytes, n);
}

static inline void
number_at(struct made *m, size_t at, enum rc_raw raw, double value)
{
    struct made part = {.big = m->big};

    number(&part, raw, value);
    memcpy(m->b + at, part.b, part.n);
    free(part.b);
}

static inline void
text_at(struct made *m, size_t at, const char *s)
{
    memcpy(m->b + at, s, strlen(s));
}

static inline double
value_of(size_t k, bool has_sign)
{
    static const double plain[] = {10, 20, 30, 40, 50, 60};

    return has_sign && k % 4 == 1 ? -plain[k] : plain[k];
}

static inline bool
has_sign(enum rc_raw raw)
{
    return raw != RC_RAW_U8 && raw != RC_RAW_U16 && raw != RC_RAW_U32 && raw != RC_RAW_U64;
}

enum order {
    ROWS = 0,
    COLUMNS = 1,
    BOTTOM = 2,
    RIGHT = 4
};

/* The six numbers; `lost` stands for the missing one (pass 50 for none). */
static inline void
numbers(struct made *m, enum rc_raw raw, int order, double lost, size_t padding)
{
    size_t outer = (order & COLUMNS) != 0 ? NX : NY, inner = NX * NY / outer;

    for (size_t o = 0; o < outer; o++) {
        for (size_t k = 0; k < inner; k++) {
            size_t row = (order & COLUMNS) != 0 ? k : o, col = (order & COLUMNS) != 0 ? o : k;
            size_t at;
            row = (order & BOTTOM) != 0 ? NY - 1 - row : row;
            col = (order & RIGHT) != 0 ? NX - 1 - col : col;
            at = row * NX + col;
            number(m, raw, at == LOST_AT ? lost : value_of(at, has_sign(raw)));
        }
        zeros(m, padding);
    }
}

/* ---- formats ---- */

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
        double lost;
    } types[] = {
        {RC_RAW_U8, 50},     {RC_RAW_U16, 50},     {RC_RAW_U32, 50},
        {RC_RAW_F32, NAN},   {RC_RAW_I8, -128},    {RC_RAW_I16, -32768},
        {RC_RAW_I32, -2147483648.0}, {RC_RAW_F64, NAN},
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
    numbers(m, types[variant].raw, ROWS, types[variant].lost, 0);
}

/* 0: 16 bits, 1: 32 bits, 2: compressed in two streams, 3: without lost points */
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

/* 0: 16 bits; 1: 32 bits that the header calls 2 bytes, mV; 2: no sensitivity but nm, one size */
static void
make_nanoscope(struct made *m, int variant)
{
    char line[200];

    text(m, variant == 1 ? "\\*File list\r\n\\Version: 0x09300201\r\n"
                         : "\\*File list\r\n\\Version: 0x05310001\r\n");
    text(m, "\\Data length: 1024\r\n\\Date: 02:03:59 PM "
            "Wed May 06 2015\r\n"
            "\\*Scanner list\r\n\\@Sens. Zscan: V 12.5 nm/V\r\n"
            "\\*Ciao scan list\r\n\\Scan size: 3300 nm\r\n"
            "\\*Ciao image list\r\n\\Data offset: 1024\r\n");
    snprintf(line, sizeof line, "\\Data length: %d\r\n", variant == 1 ? 24 : 12);
    text(m, line);
    text(m, "\\Bytes/pixel: 2\r\n\\Samps/line: 3\r\n\\Number of lines: 2\r\n");
    if (variant != 2)
        text(m, "\\Scan Size: 3.3 2.58 ~m\r\n");
    text(m, "\\@2:Image Data: S [Height] \"Height Sensor\"\r\n");
    text(m, variant == 0   ? "\\@2:Z scale: V [Sens. Zscan] (0.01 V/LSB) 65.536 V\r\n"
            : variant == 1 ? "\\@2:Z scale: V [Sens. Zscan] (1 mV/LSB) 65536.0 mV\r\n"
                           : "\\@2:Z scale: V (0.01 nm/LSB) 655.36 nm\r\n");
    text(m, "\\*File list end\r\n\x1a");
    zeros(m, 1024 - m->n);
    numbers(m, variant == 1 ? RC_RAW_I32 : RC_RAW_I16, BOTTOM, 50, 0);
}

/* 0: 16 bits; 1: 32; 2: unsigned; 3: most significant byte first. A curve and another map before.
 */
static void
make_nid(struct made *m, int variant)
{
    char line[400];

    text(m, "[DataSet]\r\nVersion=2\r\nGroupCount=2\r\nGr0-Count=2\r\nGr1-Count=1\r\nGr1-Ch0="
            "DataSet-1:0\r\n"
            "Gr0-Ch1=DataSet-0:1\r\nGr0-Ch0=DataSet-0:0\r\n\r\n[DataSet-Info]\r\n"
            "Date=24-01-2008\r\n\r\n");
    for (int set = 0; set < 3; set++) {
        snprintf(line, sizeof line,
                 "[DataSet-%d:%d]\r\nPoints=%d\r\nLines=%d\r\nFrame=%s\r\nDim0Unit=%s\r\n"
                 "Dim0Range=3.3e-06\r\nDim1Unit=m\r\nDim1Range=2.58e-06\r\nDim2Name=Topo\r\n"
                 "Dim2Unit=%s\r\nDim2Range=%s\r\nDim2Min=%s\r\nSaveMode=Binary\r\n",
                 set / 2, set % 2, set == 0 ? 7 : NX, set == 0 ? 1 : NY,
                 set == 0   ? "Spectrum"
                 : set == 1 ? "Scan forward"
                            : "Scan backward",
                 set == 0 ? "Hz" : "m", set == 1 ? "V" : "nm",
                 variant == 1 ? "4294967.296" : "65.536",
                 variant == 1 ? "-2147483.648" : "-32.768");
        text(m, line);
        snprintf(line, sizeof line, "SaveBits=%d\r\nSaveSign=%s\r\nSaveOrder=%s\r\n\r\n",
                 variant == 1 ? 32 : 16, variant == 2 ? "Unsigned" : "Signed",
                 variant == 3 ? "Motorola" : "Intel");
        text(m, line);
    }
    text(m, "#!");
    m->big = variant == 3;
    zeros(m, (variant == 1 ? 4 : 2) * (7 + 6));
    numbers(m, variant == 1 ? RC_RAW_I32 : variant == 2 ? RC_RAW_U16 : RC_RAW_I16, BOTTOM, 50, 0);
}

/* Puts the length of what follows `at` there, the length of four bytes. */
static void
close_object(struct made *m, size_t at)
{
    number_at(m, at, RC_RAW_U32, (double)(m->n - at - 4));
}

static size_t
open_object(struct made *m, const char *name, const char *type)
{
    if (name != NULL) {
        put(m, name, strlen(name) + 1);
        text(m, "o");
    }
    put(m, type, strlen(type) + 1);
    zeros(m, 4);
    return m->n - 4;
}

static void
gwy_item(struct made *m, const char *name, char type, double value)
{
    put(m, name, strlen(name) + 1);
    put(m, &type, 1);
    number(m, type == 'd' ? RC_RAW_F64 : type == 'b' ? RC_RAW_U8 : RC_RAW_I32, value);
}

static void
gwy_text(struct made *m, const char *name, const char *value)
{
    put(m, name, strlen(name) + 1);
    text(m, "s");
    put(m, value, strlen(value) + 1);
}

static void
gwy_field(struct made *m, const char *name, const char *unit, bool is_mask)
{
    size_t field = open_object(m, name, "GwyDataField"), inner;

    gwy_item(m, "xres", 'i', NX);
    gwy_item(m, "yres", 'i', NY);
    gwy_item(m, "xreal", 'd', 3.3e-6);
    gwy_item(m, "yreal", 'd', 2.58e-6);
    inner = open_object(m, "si_unit_xy", "GwySIUnit");
    gwy_text(m, "unitstr", "m");
    close_object(m, inner);
    inner = open_object(m, "si_unit_z", "GwySIUnit");
    gwy_text(m, "unitstr", unit);
    close_object(m, inner);
    put(m, "data\0D", 6);
    number(m, RC_RAW_U32, NX * NY);
    if (!is_mask)
        numbers(m, RC_RAW_F64, ROWS, 50, 0);
    for (size_t k = 0; is_mask && k < NX * NY; k++)
        number(m, RC_RAW_F64, k == LOST_AT);
    close_object(m, field);
}

/* A mask and a title before their field, another channel and items of every kind between. */
static void
make_gwy(struct made *m, int variant)
{
    size_t top;

    (void)variant;
    text(m, "GWYP");
    top = open_object(m, NULL, "GwyContainer");
    gwy_field(m, "/3/mask", "", true);
    gwy_text(m, "/3/data/title", "The heights");
    gwy_item(m, "/3/data/visible", 'b', 1);
    put(m, "some\0I", 6);
    number(m, RC_RAW_U32, 2);
    zeros(m, 8);
    put(m, "words\0S", 7);
    number(m, RC_RAW_U32, 2);
    put(m, "a\0b", 4);
    gwy_field(m, "/12/data", "V", false);
    gwy_field(m, "/3/data", "nm", false);
    close_object(m, top);
}

/* Titles of which each leaves another number of NUL before the data */
static void
make_gsf(struct made *m, int variant)
{
    static const char *const titles[] = {"T", "Ti", "Tit", "Titl"};

    text(m, "Gwyddion Simple Field 1.0\nXRes = 3\nYRes = 2\nXReal = 3.3e-6\nYReal = 2.58e-6\n"
            "XYUnits = m\nZUnits = nm\nTitle = ");
    text(m, titles[variant]);
    text(m, "\n");
    zeros(m, 4 - m->n % 4);
    numbers(m, RC_RAW_F32, ROWS, NAN, 0);
}

static int
igor_sum(const struct made *m)
{
    struct rc_bytes b = {.data = m->b, .size = 384, .big = m->big};
    unsigned sum = 0;

    for (size_t k = 0; k < 192; k++)
        sum += rc_bytes_u16(&b);
    sum &= 0xffff;
    return sum < 0x8000 ? (int)sum : (int)sum - 0x10000;
}

/* 0: f32, 1: f64 most significant byte first, 2: i16 with labels, second channel of two */
static void
make_ibw(struct made *m, int variant)
{
    static const int types[] = {2, 4, 0x10};
    static const enum rc_raw raws[] = {RC_RAW_F32, RC_RAW_F64, RC_RAW_I16};

    m->big = variant == 1;
    zeros(m, 384);
    number_at(m, 0, RC_RAW_I16, 5);
    number_at(m, 12, RC_RAW_I32, 4);                           /* note */
    number_at(m, 12 + 4 * 8, RC_RAW_I32, variant == 2 ? 96 : 0); /* labels of dimension 2 */
    number_at(m, 80, RC_RAW_I16, types[variant]);
    text_at(m, 92, "wave0");
    number_at(m, 132, RC_RAW_I32, NX);
    number_at(m, 136, RC_RAW_I32, NY);
    number_at(m, 140, RC_RAW_I32, variant == 2 ? 2 : 0);
    number_at(m, 148, RC_RAW_F64, 1.1);
    number_at(m, 156, RC_RAW_F64, 1.29);
    text_at(m, 212, "nm");
    text_at(m, 216, "um");
    text_at(m, 220, "um");
    number_at(m, 4, RC_RAW_I32, 320 + (double)(NX * NY * rc_raw_width(raws[variant])));
    number_at(m, 76, RC_RAW_I32, NX * NY * (variant == 2 ? 2 : 1));
    number_at(m, 2, RC_RAW_I16, -igor_sum(m)); /* so that all 16-bit numbers sum up to 0 */
    if (variant == 2)
        zeros(m, 12);
    numbers(m, raws[variant], BOTTOM, variant == 2 ? 50 : NAN, 0);
    text(m, "note");
    if (variant == 2) {
        size_t at = m->n;
        zeros(m, 96);
        text_at(m, at + 32, "PhaseTrace");
        text_at(m, at + 64, "HeightTrace");
    }
}

static void
make_mi(struct made *m, int variant)
{
    text(m, "fileType      Image\nversion       PicoView\nxSensitivity  1\n"
            "xNonlinearity21.23\nxPixels       3\nyPixels       2\nxLength       3.3e-006\n"
            "yLength       2.58e-006\nbufferLabel   Friction\nbufferRange   1\n"
            "bufferUnit    V\nbufferLabel   Topography\nbufferRange   0.032768\n"
            "bufferUnit    um\n");
    text(m, variant == 0 ? "data          BINARY\n" : "data          BINARY_32\n");
    zeros(m, variant == 0 ? 12 : 24);
    numbers(m, variant == 0 ? RC_RAW_I16 : RC_RAW_I32, BOTTOM, 50, 0);
}

static void
make_wsxm(struct made *m, int variant)
{
    static const char *const types[] = {"short", "float", "double"};
    static const enum rc_raw raws[] = {RC_RAW_I16, RC_RAW_F32, RC_RAW_F64};
    char line[100];

    text(m, "WSxM file copyright Nanotec Electronica\r\nSxM Image file\r\n"
            "Image header size:   512\r\n\r\n[Control]\r\n\r\n    X Amplitude: 3.3 \xb5m\r\n"
            "    Y Amplitude: 2580 nm\r\n\r\n[General Info]\r\n\r\n"
            "    Acquisition channel: Topo\r\n");
    snprintf(line, sizeof line, "    Image Data Type: %s\r\n", types[variant]);
    text(m, line);
    text(m, "    Number of columns: 3\r\n    Number of rows: 2\r\n    Z Amplitude: 11 nm\r\n"
            "\r\n[Header end]\r\n");
    zeros(m, 512 - m->n);
    numbers(m, raws[variant], BOTTOM | RIGHT, 50, 0);
}

/* 0: i16, 1: i16 most significant byte first, 2: floats in um, 3: the same with a wide header */
static void
make_bcr(struct made *m, int variant)
{
    struct made head = {0};

    text(&head, variant < 2    ? "fileformat = bcrstm\n"
                : variant == 2 ? "fileformat = bcrf\n"
                               : "fileformat = bcrf_unicode\n");
    text(&head, "%\nheadersize = 2048\nxpixels = 3\nypixels = 2\nxlength = 3300\nylength = 2580\n"
                "bit2nm = 0.25\n");
    text(&head, variant == 1 ? "intelmode = 0\n" : "intelmode = 1\n");
    text(&head, variant < 2 ? "voidpixels = 32767\n"
                            : "voidpixels = 3.402823E+38\nxunit = nm\nyunit = nm\nzunit = um\n");
    while (head.n < 2048)
        text(&head, " ");
    for (size_t k = 0; k < head.n; k++)
        put(m, (char[]){(char)head.b[k], '\0'}, variant == 3 ? 2 : 1);
    free(head.b);
    m->big = variant == 1;
    numbers(m, variant < 2 ? RC_RAW_I16 : RC_RAW_F32, ROWS,
            variant < 2 ? 32767 : 3.4028234663852886e38, 0);
}

static void
frt_block(struct made *m, bool is_long, int kind, double n)
{
    number(m, RC_RAW_U16, kind);
    number(m, is_long ? RC_RAW_U64 : RC_RAW_U32, n);
}

static void
make_frt(struct made *m, int variant)
{
    bool is_long = variant == 1;

    text(m, is_long ? "FRTM_GLIDERV1.01" : "FRTM_GLIDERV1.00");
    number(m, RC_RAW_U16, 6);
    frt_block(m, is_long, 0x65, 5);
    text(m, "hello");
    frt_block(m, is_long, 0x66, 12);
    number(m, RC_RAW_U32, NX);
    number(m, RC_RAW_U32, NY);
    number(m, RC_RAW_U32, is_long ? 32 : 16);
    frt_block(m, is_long, 0x67, 44);
    number(m, RC_RAW_F64, 3.3e-6);
    number(m, RC_RAW_F64, 2.58e-6);
    zeros(m, 28);
    frt_block(m, is_long, 0x1234, 3);
    zeros(m, 3);
    frt_block(m, is_long, 0x6c, 12);
    number(m, RC_RAW_U32, 300);
    number(m, RC_RAW_F64, 1e-9);
    frt_block(m, is_long, 0x0b, is_long ? 24 : 12);
    numbers(m, is_long ? RC_RAW_I32 : RC_RAW_U16, BOTTOM, 1, 0);
}

static void
make_tmd(struct made *m, int variant)
{
    put(m, "Binary TrueMap Data File v2.0\r\n", 32);
    text(m, variant == 0 ? "Created by TrueMap v6\r\n" : "");
    zeros(m, 1);
    number(m, RC_RAW_I32, NX);
    number(m, RC_RAW_I32, NY);
    number(m, RC_RAW_F32, variant == 0 ? 3.3 : 3.3e-3);
    number(m, RC_RAW_F32, variant == 0 ? 2.58 : 2.58e-3);
    zeros(m, 8);
    numbers(m, RC_RAW_F32, ROWS, NAN, 0);
}

/* 0: text, 1: version 6, 2: version 7 with its own blank */
static void
make_grd(struct made *m, int variant)
{
    if (variant == 0) {
        text(m, "DSAA\r\n3 2\r\n0 2.2\r\n5 6.29\r\n-60 40\r\n40 1.70141e+038\r\n-60\r\n\r\n"
                "10 -20 30\r\n");
    } else if (variant == 1) {
        text(m, "DSBB");
        number(m, RC_RAW_I16, NX);
        number(m, RC_RAW_I16, NY);
        for (size_t k = 0; k < 6; k++)
            number(m, RC_RAW_F64, (double[]){0, 2.2, 5, 6.29, -60, 40}[k]);
        numbers(m, RC_RAW_F32, BOTTOM, 1.70141e38, 0);
    } else {
        text(m, "DSRB");
        number(m, RC_RAW_I32, 4);
        number(m, RC_RAW_I32, 2);
        text(m, "GRID");
        number(m, RC_RAW_I32, 72);
        number(m, RC_RAW_I32, NY);
        number(m, RC_RAW_I32, NX);
        for (size_t k = 0; k < 8; k++)
            number(m, RC_RAW_F64, (double[]){0, 5, 1.1, 1.29, -60, 40, 0, 1e20}[k]);
        text(m, "ODD ");
        number(m, RC_RAW_I32, 3);
        zeros(m, 3);
        text(m, "DATA");
        number(m, RC_RAW_I32, 48);
        numbers(m, RC_RAW_F64, BOTTOM, 1e20, 0);
    }
}

static void
make_esri(struct made *m, int variant)
{
    text(m, variant == 0 ? "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1.1\n"
                           "NODATA_value -1e3\n10 -20 30\n40 -1000 -60\n"
                         : "NCOLS 3\r\nNROWS 2\r\nXLLCENTER 0\r\nYLLCENTER 0\r\nDX 1.1\r\n"
                           "DY 1.29\r\n 10 -20 30 40\r\n-9999 -60");
}

/* By type; 10: the first transposed, 11: version 2 of the header, big */
static void
make_npy(struct made *m, int variant)
{
    static const char *const names[] = {"<f8", "<f4", "|i1", ">i2", "<i4", "<i8",
                                        "|u1", "<u2", ">u4", "<u8", ">f8", "<f8"};
    static const enum rc_raw raws[] = {RC_RAW_F64, RC_RAW_F32, RC_RAW_I8,  RC_RAW_I16,
                                       RC_RAW_I32, RC_RAW_I64, RC_RAW_U8,  RC_RAW_U16,
                                       RC_RAW_U32, RC_RAW_U64, RC_RAW_F64, RC_RAW_F64};
    char header[200];

    snprintf(header, sizeof header, "{'descr': '%s', 'fortran_order': %s, 'shape': (2, 3), }\n",
             names[variant], variant == 10 ? "True" : "False");
    text(m, "\x93NUMPY");
    put(m, variant == 11 ? "\2\0" : "\1\0", 2);
    number(m, variant == 11 ? RC_RAW_U32 : RC_RAW_U16, (double)strlen(header));
    text(m, header);
    m->big = names[variant][0] == '>';
    numbers(m, raws[variant], variant == 10 ? COLUMNS : ROWS, variant < 2 || variant > 9 ? NAN : 50,
            0);
}

static void
opdx_name(struct made *m, const char *name, int type)
{
    number(m, RC_RAW_U32, (double)strlen(name));
    text(m, name);
    number(m, RC_RAW_U8, type);
}

static size_t
opdx_open(struct made *m, const char *name, int type)
{
    opdx_name(m, name, type);
    number(m, RC_RAW_U8, 4);
    zeros(m, 4);
    return m->n - 4;
}

static void
opdx_close(struct made *m, size_t at)
{
    opdx_name(m, "", 0x7f);
    put(m, "\xff\xff", 2);
    close_object(m, at);
}

static void
opdx_quantity(struct made *m, const char *name, double value, const char *unit)
{
    opdx_name(m, name, 0x13);
    number(m, RC_RAW_U8, 1);
    number(m, RC_RAW_U8, (double)(8 + 4 + 4 + 4 + strlen(unit)));
    number(m, RC_RAW_F64, value);
    number(m, RC_RAW_U32, 4);
    text(m, "Unit");
    number(m, RC_RAW_U32, (double)strlen(unit));
    text(m, unit);
}

/* 0: a map in Matrix, 1: the same in the kind without a name of its own */
static void
make_opdx(struct made *m, int variant)
{
    size_t top, channel, raw;

    put(m, "VCA DATA\1\0\0U", 12);
    top = opdx_open(m, "2D_Data", 0x7d);
    channel = opdx_open(m, "Raw", 0x47);
    opdx_quantity(m, "Dimension1Extent", 1.29, "\xc2\xb5m");
    opdx_quantity(m, "Dimension2Extent", 2200, "nm");
    opdx_quantity(m, "DataScale", 0.25, "nm");
    opdx_name(m, "flag", 0x01);
    number(m, RC_RAW_U8, 1);
    opdx_name(m, "when", 0x15);
    zeros(m, 9);
    opdx_name(m, "Matrix", variant == 0 ? 0x00 : 0x45);
    number(m, RC_RAW_U32, 6);
    text(m, "Matrix");
    if (variant == 0) {
        number(m, RC_RAW_U32, 1);
        number(m, RC_RAW_U32, 5);
        text(m, "float");
    }
    number(m, RC_RAW_U8, 2);
    number(m, RC_RAW_U16, 8 + 24);
    raw = m->n;
    number(m, RC_RAW_U32, NY);
    number(m, RC_RAW_U32, NX);
    numbers(m, RC_RAW_F32, ROWS, NAN, 0);
    (void)raw;
    opdx_close(m, channel);
    opdx_close(m, top);
    top = opdx_open(m, "MetaData", 0x7d);
    opdx_name(m, "Date", 0x12);
    number(m, RC_RAW_U8, 1);
    number(m, RC_RAW_U8, 9);
    text(m, "2/11/2021");
    opdx_close(m, top);
    opdx_name(m, "", 0x7f);
    put(m, "\xff\xff", 2);
}

static void
make_vk4(struct made *m, int variant)
{
    static const enum rc_raw raws[] = {RC_RAW_U32, RC_RAW_U16, RC_RAW_U8};
    size_t conditions = variant == 1 ? 80 : 84, image = conditions + 304;
    enum rc_raw raw = raws[variant];

    zeros(m, image + 28 + 768);
    text_at(m, 0, variant == 1 ? "VK3_" : "VK4_");
    number_at(m, 12, RC_RAW_U32, (double)conditions);
    number_at(m, conditions, RC_RAW_U32, 304);
    number_at(m, 36, RC_RAW_U32, (double)image);
    for (size_t k = 0; k < 6; k++)
        number_at(m, conditions + 4 + 4 * k, RC_RAW_U32, (double[]){2020, 2, 29, 13, 14, 15}[k]);
    number_at(m, conditions + 168, RC_RAW_U32, 1100000);
    number_at(m, conditions + 172, RC_RAW_U32, 1290000);
    number_at(m, conditions + 176, RC_RAW_U32, 100);
    number_at(m, image, RC_RAW_U32, NX);
    number_at(m, image + 4, RC_RAW_U32, NY);
    number_at(m, image + 8, RC_RAW_U32, (double)(8 * rc_raw_width(raw)));
    number_at(m, image + 16, RC_RAW_U32, (double)(6 * rc_raw_width(raw)));
    numbers(m, raw, ROWS, 50, 0);
}

/* Where these four bytes stand last. */
static size_t
last_of(const struct made *m, const char *bytes)
{
    size_t at = m->n - 4;

    while (memcmp(m->b + at, bytes, 4) != 0)
        at--;
    return at;
}

/* VK6 (variant 0) and VK7: a picture, in which PK 3 4 stands too, and an archive. In the second one
 * the archive counts from the start of the file. */
static void
make_vk6(struct made *m, int variant)
{
    zip_source_t *source = zip_source_buffer_create(NULL, 0, 0, NULL);
    zip_t *zip = zip_open_from_source(source, ZIP_TRUNCATE, NULL);
    struct made inner = {0};
    unsigned char *bytes;
    size_t before;
    zip_stat_t st;

    make_vk4(&inner, 0);
    zip_source_keep(source);
    zip_file_add(zip, "Vk4File", zip_source_buffer(zip, inner.b, inner.n, 0), ZIP_FL_ENC_UTF_8);
    zip_close(zip);
    zip_source_stat(source, &st);
    bytes = malloc((size_t)st.size);
    zip_source_open(source);
    zip_source_read(source, bytes, st.size);
    zip_source_close(source);
    zip_source_free(source);
    text(m, variant == 0 ? "VK6" : "VK7");
    text(m, "BM a picture with PK\3\4 in it");
    before = m->n;
    put(m, bytes, (size_t)st.size);
    if (variant == 1) {
        size_t end = last_of(m, "PK\5\6");
        struct rc_bytes b = {.data = m->b, .size = m->n};
        number_at(m, last_of(m, "PK\1\2") + 42, RC_RAW_U32, (double)before);
        number_at(m, end + 16, RC_RAW_U32, rc_bytes_at(&b, end + 16, RC_RAW_U32) + (double)before);
    }
    free(bytes);
    free(inner.b);
}

/* In two orders, with commas and a header, and one of the points left out. */
static void
make_xyz(struct made *m, int variant)
{
    text(m, variant == 0   ? "0 5 10\n1.1 5 -20\n2.2 5 30\n0 6.29 40\n2.2 6.29 -60\n1.1 6.29 nan\n"
            : variant == 1 ? "# some points\nx, y, z\n0,6.29,40\n0,5,10\n1.1,5,-20\n2.2,6.29,-60\n"
                             "2.2,5,30\n"
                           : "2.2\t6.29\t-60\r\n1.1\t6.29\tNaN\r\n0\t6.29\t40\r\n2.2\t5\t30\r\n"
                             "1.1\t5\t-20\r\n0\t5\t10\r\n");
}

enum {
    NO_SPACING = 1, /* the file lacks the spacing: 1.1e-6 and 1.29e-6 are wished */
    NO_UNIT = 2,    /* the file lacks the unit: nanometres are wished            */
    HAS_LOST = 4,
    PLAIN = 8,      /* the type has no sign */
    SQUARE = 16,    /* dy = dx = 1.1e-6     */
    IS_TEXT = 32    /* cut at its end it may still be a file */
};

/* Every made file: heights are number * scale + zero metres. */
static const struct made_file {
    const char *title, *format, *name;
    void (*make)(struct made *m, int variant);
    int variant, flags;
    double scale, zero;
} made_files[] = {
    {"SDF text", "sdf", "a.sdf", make_sdf_text, 0, HAS_LOST | IS_TEXT, 1e-9, 0},
    {"SDF text, BCR", "sdf", "a.sdf", make_sdf_text, 1, HAS_LOST | IS_TEXT, 1e-9, 0},
    {"SDF u8", "sdf", "a.sdf", make_sdf_binary, 0, PLAIN, 1e-9, 0},
    {"SDF u16", "sdf", "a.sdf", make_sdf_binary, 1, PLAIN, 1e-9, 0},
    {"SDF u32", "sdf", "a.sdf", make_sdf_binary, 2, PLAIN, 1e-9, 0},
    {"SDF f32", "sdf", "a.sdf", make_sdf_binary, 3, HAS_LOST, 1e-9, 0},
    {"SDF i8", "sdf", "a.sdf", make_sdf_binary, 4, HAS_LOST, 1e-9, 0},
    {"SDF i16", "sdf", "a.sdf", make_sdf_binary, 5, HAS_LOST, 1e-9, 0},
    {"SDF i32", "sdf", "a.sdf", make_sdf_binary, 6, HAS_LOST, 1e-9, 0},
    {"SDF f64", "sdf", "a.sdf", make_sdf_binary, 7, HAS_LOST, 1e-9, 0},
    {"SUR 16 bits", "sur", "a.sur", make_sur, 0, HAS_LOST, 0.25e-9, 100e-9},
    {"SUR 32 bits", "sur", "a.sur", make_sur, 1, HAS_LOST, 0.25e-9, 100e-9},
    {"SUR compressed", "sur", "a.sur", make_sur, 2, HAS_LOST, 0.25e-9, 100e-9},
    {"SUR without lost points", "sur", "a.sur", make_sur, 3, 0, 0.25e-9, 100e-9},
    {"OPD floats", "opd", "a.opd", make_opd, 0, HAS_LOST, 80e-9, 0},
    {"OPD 16 bits", "opd", "a.opd", make_opd, 1, HAS_LOST, 80e-9, 0},
    {"OPD Raw", "opd", "a.opd", make_opd, 2, HAS_LOST, 80e-9, 0},
    {"MetroPro 0", "metropro", "a.dat", make_metropro, 0, HAS_LOST | SQUARE, 6.25e-7 / 4096, 0},
    {"MetroPro 1", "metropro", "a.dat", make_metropro, 1, HAS_LOST | SQUARE, 6.25e-7 / 32768, 0},
    {"MetroPro 2", "metropro", "a.dat", make_metropro, 2, HAS_LOST | SQUARE, 6.25e-7 / 131072, 0},
    {"AL3D padded", "al3d", "a.al3d", make_al3d, 0, HAS_LOST, 1, 0},
    {"PLU", "plu", "a.plu", make_plu, 0, HAS_LOST, 1e-6, 0},
    {"NanoScope 16 bits", "nanoscope", "a.001", make_nanoscope, 0, 0, 12.5e-12, 0},
    {"NanoScope 32 bits, mV", "nanoscope", "a.spm", make_nanoscope, 1, 0, 12.5e-12, 0},
    {"NanoScope in nm", "nanoscope", "a.spm", make_nanoscope, 2, SQUARE, 0.01e-9, 0},
    {"NID 16 bits", "nid", "a.nid", make_nid, 0, 0, 1e-12, 0},
    {"NID 32 bits", "nid", "a.nid", make_nid, 1, 0, 1e-12, 0},
    {"NID unsigned", "nid", "a.nid", make_nid, 2, PLAIN, 1e-12, -32.768e-9},
    {"NID Motorola", "nid", "a.nid", make_nid, 3, 0, 1e-12, 0},
    {"GWY", "gwy", "a.gwy", make_gwy, 0, HAS_LOST, 1e-9, 0},
    {"GSF, 4 NUL", "gsf", "a.gsf", make_gsf, 0, HAS_LOST, 1e-9, 0},
    {"GSF, 3 NUL", "gsf", "a.gsf", make_gsf, 1, HAS_LOST, 1e-9, 0},
    {"GSF, 2 NUL", "gsf", "a.gsf", make_gsf, 2, HAS_LOST, 1e-9, 0},
    {"GSF, 1 NUL", "gsf", "a.gsf", make_gsf, 3, HAS_LOST, 1e-9, 0},
    {"IBW f32", "ibw", "a.ibw", make_ibw, 0, HAS_LOST, 1e-9, 0},
    {"IBW f64 of Macintosh", "ibw", "a.ibw", make_ibw, 1, HAS_LOST, 1e-9, 0},
    {"IBW i16, labels", "ibw", "a.ibw", make_ibw, 2, 0, 1e-9, 0},
    {"MI 16 bits", "mi", "a.mi", make_mi, 0, 0, 1e-12, 0},
    {"MI 32 bits", "mi", "a.mi", make_mi, 1, 0, 1e-12 / 65536, 0},
    {"WSxM short", "wsxm", "a.top", make_wsxm, 0, 0, 0.1e-9, 0},
    {"WSxM float", "wsxm", "a.stp", make_wsxm, 1, 0, 0.1e-9, 0},
    {"WSxM double", "wsxm", "a.stp", make_wsxm, 2, 0, 0.1e-9, 0},
    {"BCR", "bcr", "a.bcr", make_bcr, 0, HAS_LOST, 0.25e-9, 0},
    {"BCR of Macintosh", "bcr", "a.bcr", make_bcr, 1, HAS_LOST, 0.25e-9, 0},
    {"BCRF", "bcr", "a.bcrf", make_bcr, 2, HAS_LOST, 1e-6, 0},
    {"BCRF, wide", "bcr", "a.bcrf", make_bcr, 3, HAS_LOST, 1e-6, 0},
    {"FRT 1.00", "frt", "a.frt", make_frt, 0, HAS_LOST | PLAIN, 1e-9, 0},
    {"FRT 1.01", "frt", "a.frt", make_frt, 1, HAS_LOST, 1e-9, 0},
    {"TrueMap", "tmd", "a.tmd", make_tmd, 0, HAS_LOST, 1e-6, 0},
    {"GelSight", "tmd", "a.tmd", make_tmd, 1, HAS_LOST, 1e-3, 0},
    {"Surfer text", "grd", "a.grd", make_grd, 0, HAS_LOST | NO_SPACING | NO_UNIT | IS_TEXT, 1e-9,
     0},
    {"Surfer 6", "grd", "a.grd", make_grd, 1, HAS_LOST | NO_SPACING | NO_UNIT, 1e-9, 0},
    {"Surfer 7", "grd", "a.grd", make_grd, 2, HAS_LOST | NO_SPACING | NO_UNIT, 1e-9, 0},
    {"ESRI", "esri", "a.asc", make_esri, 0, HAS_LOST | NO_SPACING | NO_UNIT | IS_TEXT, 1e-9, 0},
    {"ESRI, DX DY", "esri", "a.asc", make_esri, 1, HAS_LOST | NO_SPACING | NO_UNIT | IS_TEXT, 1e-9,
     0},
    {"NPY <f8", "npy", "a.npy", make_npy, 0, HAS_LOST | NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY <f4", "npy", "a.npy", make_npy, 1, HAS_LOST | NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY |i1", "npy", "a.npy", make_npy, 2, NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY >i2", "npy", "a.npy", make_npy, 3, NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY <i4", "npy", "a.npy", make_npy, 4, NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY <i8", "npy", "a.npy", make_npy, 5, NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY |u1", "npy", "a.npy", make_npy, 6, NO_SPACING | NO_UNIT | PLAIN, 1e-9, 0},
    {"NPY <u2", "npy", "a.npy", make_npy, 7, NO_SPACING | NO_UNIT | PLAIN, 1e-9, 0},
    {"NPY >u4", "npy", "a.npy", make_npy, 8, NO_SPACING | NO_UNIT | PLAIN, 1e-9, 0},
    {"NPY <u8", "npy", "a.npy", make_npy, 9, NO_SPACING | NO_UNIT | PLAIN, 1e-9, 0},
    {"NPY >f8 of Fortran", "npy", "a.npy", make_npy, 10, HAS_LOST | NO_SPACING | NO_UNIT, 1e-9, 0},
    {"NPY version 2", "npy", "a.npy", make_npy, 11, HAS_LOST | NO_SPACING | NO_UNIT, 1e-9, 0},
    {"OPDx map", "opdx", "a.opdx", make_opdx, 0, HAS_LOST, 0.25e-9, 0},
    {"OPDx map, no name", "opdx", "a.opdx", make_opdx, 1, HAS_LOST, 0.25e-9, 0},
    {"VK4", "vk", "a.vk4", make_vk4, 0, PLAIN, 100e-12, 0},
    {"VK3, 16 bits", "vk", "a.vk3", make_vk4, 1, PLAIN, 100e-12, 0},
    {"VK4, 8 bits", "vk", "a.vk4", make_vk4, 2, PLAIN, 100e-12, 0},
    {"VK6", "vk", "a.vk6", make_vk6, 0, PLAIN, 100e-12, 0},
    {"VK7", "vk", "a.vk7", make_vk6, 1, PLAIN, 100e-12, 0},
    {"XYZ", "xyz", "a.xyz", make_xyz, 0, HAS_LOST | NO_SPACING | NO_UNIT | IS_TEXT, 1e-9, 0},
    {"XYZ, commas, a hole", "xyz", "a.txt", make_xyz, 1, HAS_LOST | NO_SPACING | NO_UNIT | IS_TEXT,
     1e-9, 0},
    {"XYZ, backwards", "xyz", "a.txt", make_xyz, 2, HAS_LOST | NO_SPACING | NO_UNIT | IS_TEXT, 1e-9,
     0},
};

enum {
    MADE_FILES = sizeof made_files / sizeof *made_files
};

#endif
