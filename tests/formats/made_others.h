/* Files of other instruments and programs, made by hand. */
#ifndef MADE_OTHERS_H
#define MADE_OTHERS_H

#include <zip.h>

#include "made_bytes.h"

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

#endif
