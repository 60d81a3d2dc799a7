/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of scanning probe microscopes and of their programs, made by hand. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "made.h"

/* 0: 16 bits; 1: 32 bits although the header has 2 bytes, mV; 2: nm without a sensitivity, one size */
void
make_nanoscope(struct bytes *m, int variant)
{
    char line[200];

    add_text(m, variant == 1 ? "\\*File list\r\n\\Version: 0x09300201\r\n"
                             : "\\*File list\r\n\\Version: 0x05310001\r\n");
    add_text(m, "\\Data length: 1024\r\n\\Date: 02:03:59 PM "
                "Wed May 06 2015\r\n"
                "\\*Scanner list\r\n\\@Sens. Zscan: V 12.5 nm/V\r\n"
                "\\*Ciao scan list\r\n\\Scan size: 3300 nm\r\n"
                "\\*Ciao image list\r\n\\Data offset: 1024\r\n");
    snprintf(line, sizeof line, "\\Data length: %d\r\n", variant == 1 ? 24 : 12);
    add_text(m, line);
    add_text(m, "\\Bytes/pixel: 2\r\n\\Samps/line: 3\r\n\\Number of lines: 2\r\n");
    if (variant != 2)
        add_text(m, "\\Scan Size: 3.3 2.58 ~m\r\n");
    add_text(m, "\\@2:Image Data: S [Height] \"Height Sensor\"\r\n");
    add_text(m, variant == 0   ? "\\@2:Z scale: V [Sens. Zscan] (0.01 V/LSB) 65.536 V\r\n"
                : variant == 1 ? "\\@2:Z scale: V [Sens. Zscan] (1 mV/LSB) 65536.0 mV\r\n"
                               : "\\@2:Z scale: V (0.01 nm/LSB) 655.36 nm\r\n");
    add_text(m, "\\*File list end\r\n\x1a");
    add_zeros(m, 1024 - m->n);
    add_map(m, variant == 1 ? RC_RAW_I32 : RC_RAW_I16, BOTTOM, 50, 0);
}

/* 0: 16 bits; 1: 32; 2: unsigned; 3: most significant byte first. A curve and another map come before.
 */
void
make_nid(struct bytes *m, int variant)
{
    char line[400];

    add_text(m, "[DataSet]\r\nVersion=2\r\nGroupCount=2\r\nGr0-Count=2\r\nGr1-Count=1\r\nGr1-Ch0="
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
        add_text(m, line);
        snprintf(line, sizeof line, "SaveBits=%d\r\nSaveSign=%s\r\nSaveOrder=%s\r\n\r\n",
                 variant == 1 ? 32 : 16, variant == 2 ? "Unsigned" : "Signed",
                 variant == 3 ? "Motorola" : "Intel");
        add_text(m, line);
    }
    add_text(m, "#!");
    m->big = variant == 3;
    add_zeros(m, (variant == 1 ? 4 : 2) * (7 + 6));
    add_map(m, variant == 1 ? RC_RAW_I32 : variant == 2 ? RC_RAW_U16 : RC_RAW_I16, BOTTOM, 50, 0);
}

static size_t
open_object(struct bytes *m, const char *name, const char *type)
{
    if (name != NULL) {
        add(m, name, strlen(name) + 1);
        add_text(m, "o");
    }
    add(m, type, strlen(type) + 1);
    add_zeros(m, 4);
    return m->n - 4;
}

static void
gwy_item(struct bytes *m, const char *name, char type, double value)
{
    add(m, name, strlen(name) + 1);
    add(m, &type, 1);
    add_raw(m, type == 'd' ? RC_RAW_F64 : type == 'b' ? RC_RAW_U8 : RC_RAW_I32, value);
}

static void
gwy_text(struct bytes *m, const char *name, const char *value)
{
    add(m, name, strlen(name) + 1);
    add_text(m, "s");
    add(m, value, strlen(value) + 1);
}

static void
gwy_field(struct bytes *m, const char *name, const char *unit, bool is_mask)
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
    add(m, "data\0D", 6);
    add_raw(m, RC_RAW_U32, NX * NY);
    if (!is_mask)
        add_map(m, RC_RAW_F64, ROWS, 50, 0);
    for (size_t k = 0; is_mask && k < NX * NY; k++)
        add_raw(m, RC_RAW_F64, k == MISSING_AT);
    close_object(m, field);
}

/* A mask and a title before their field, with another channel and items of every type between. */
void
make_gwy(struct bytes *m, int variant)
{
    size_t top;

    (void)variant;
    add_text(m, "GWYP");
    top = open_object(m, NULL, "GwyContainer");
    gwy_field(m, "/3/mask", "", true);
    gwy_text(m, "/3/data/title", "The heights");
    gwy_item(m, "/3/data/visible", 'b', 1);
    add(m, "some\0I", 6);
    add_raw(m, RC_RAW_U32, 2);
    add_zeros(m, 8);
    add(m, "words\0S", 7);
    add_raw(m, RC_RAW_U32, 2);
    add(m, "a\0b", 4);
    gwy_field(m, "/12/data", "V", false);
    gwy_field(m, "/3/data", "nm", false);
    close_object(m, top);
}

/* Titles of different lengths, which give different numbers of NUL bytes before the data */
void
make_gsf(struct bytes *m, int variant)
{
    static const char *const titles[] = {"T", "Ti", "Tit", "Titl"};

    add_text(m, "Gwyddion Simple Field 1.0\nXRes = 3\nYRes = 2\nXReal = 3.3e-6\nYReal = 2.58e-6\n"
                "XYUnits = m\nZUnits = nm\nTitle = ");
    add_text(m, titles[variant]);
    add_text(m, "\n");
    add_zeros(m, 4 - m->n % 4);
    add_map(m, RC_RAW_F32, ROWS, NAN, 0);
}

static int
igor_sum(const struct bytes *m)
{
    struct rc_bytes b = {.data = m->data, .size = 384, .big = m->big};
    unsigned sum = 0;

    for (size_t k = 0; k < 192; k++)
        sum += rc_bytes_u16(&b);
    sum &= 0xffff;
    return sum < 0x8000 ? (int)sum : (int)sum - 0x10000;
}

/* 0: f32, 1: f64 most significant byte first, 2: i16 with labels, second channel of two */
void
make_ibw(struct bytes *m, int variant)
{
    static const int types[] = {2, 4, 0x10};
    static const enum rc_raw raws[] = {RC_RAW_F32, RC_RAW_F64, RC_RAW_I16};

    m->big = variant == 1;
    add_zeros(m, 384);
    set_raw(m, 0, RC_RAW_I16, 5);
    set_raw(m, 12, RC_RAW_I32, 4);                             /* note */
    set_raw(m, 12 + 4 * 8, RC_RAW_I32, variant == 2 ? 96 : 0); /* labels of dimension 2 */
    set_raw(m, 80, RC_RAW_I16, types[variant]);
    set_text(m, 92, "wave0");
    set_raw(m, 132, RC_RAW_I32, NX);
    set_raw(m, 136, RC_RAW_I32, NY);
    set_raw(m, 140, RC_RAW_I32, variant == 2 ? 2 : 0);
    set_raw(m, 148, RC_RAW_F64, 1.1);
    set_raw(m, 156, RC_RAW_F64, 1.29);
    set_text(m, 212, "nm");
    set_text(m, 216, "um");
    set_text(m, 220, "um");
    set_raw(m, 4, RC_RAW_I32, 320 + (double)(NX * NY * rc_raw_width(raws[variant])));
    set_raw(m, 76, RC_RAW_I32, NX * NY * (variant == 2 ? 2 : 1));
    set_raw(m, 2, RC_RAW_I16, -igor_sum(m)); /* so that the sum of all 16-bit numbers is 0 */
    if (variant == 2)
        add_zeros(m, 12);
    add_map(m, raws[variant], BOTTOM, variant == 2 ? 50 : NAN, 0);
    add_text(m, "note");
    if (variant == 2) {
        size_t at = m->n;
        add_zeros(m, 96);
        set_text(m, at + 32, "PhaseTrace");
        set_text(m, at + 64, "HeightTrace");
    }
}

void
make_mi(struct bytes *m, int variant)
{
    add_text(m, "fileType      Image\nversion       PicoView\nxSensitivity  1\n"
                "xNonlinearity21.23\nxPixels       3\nyPixels       2\nxLength       3.3e-006\n"
                "yLength       2.58e-006\nbufferLabel   Friction\nbufferRange   1\n"
                "bufferUnit    V\nbufferLabel   Topography\nbufferRange   0.032768\n"
                "bufferUnit    um\n");
    add_text(m, variant == 0 ? "data          BINARY\n" : "data          BINARY_32\n");
    add_zeros(m, variant == 0 ? 12 : 24);
    add_map(m, variant == 0 ? RC_RAW_I16 : RC_RAW_I32, BOTTOM, 50, 0);
}

void
make_wsxm(struct bytes *m, int variant)
{
    static const char *const types[] = {"short", "float", "double"};
    static const enum rc_raw raws[] = {RC_RAW_I16, RC_RAW_F32, RC_RAW_F64};
    char line[100];

    add_text(m, "WSxM file copyright Nanotec Electronica\r\nSxM Image file\r\n"
                "Image header size:   512\r\n\r\n[Control]\r\n\r\n    X Amplitude: 3.3 \xb5m\r\n"
                "    Y Amplitude: 2580 nm\r\n\r\n[General Info]\r\n\r\n"
                "    Acquisition channel: Topo\r\n");
    snprintf(line, sizeof line, "    Image Data Type: %s\r\n", types[variant]);
    add_text(m, line);
    add_text(m, "    Number of columns: 3\r\n    Number of rows: 2\r\n    Z Amplitude: 11 nm\r\n"
                "\r\n[Header end]\r\n");
    add_zeros(m, 512 - m->n);
    add_map(m, raws[variant], BOTTOM | RIGHT, 50, 0);
}

/* 0: an upward scan, the second of two channels, after its backward scan; 1: a downward scan in the other
 * byte order */
void
make_sxm(struct bytes *m, int variant)
{
    bool up = variant == 0;

    add_text(m, ":NANONIS_VERSION:\n2\n:SCANIT_TYPE:\n");
    add_text(m, up ? "              FLOAT            MSBFIRST\n" : "FLOAT LSBFIRST\n");
    add_text(m, ":REC_DATE:\n 16.08.2016\n:REC_TIME:\n16:29:15\n:SCAN_PIXELS:\n       3       2\n"
                ":SCAN_RANGE:\n           3.300000E-6           2.580000E-6\n:SCAN_DIR:\n");
    add_text(m, up ? "up\n" : "down\n");
    add_text(
        m, ":Z-CONTROLLER:\n\tName\ton\n\tlog Current\t1\n:COMMENT:\nof two\nlines\n\n:DATA_INFO:\n"
           "\tChannel\tName\tUnit\tDirection\tCalibration\tOffset\n"
           "\t0\tCurrent\tnA\tforward\t1.000E-9\t0.000E+0\n");
    add_text(m, up ? "\t14\tZ\tnm\tboth\t-9.000E-9\t0.000E+0\n"
                   : "\t14\tZ\tnm\tbackward\t-9.000E-9\t0.000E+0\n");
    add_text(m, "\n:SCANIT_END:\n\n\n");
    add(m, "\x1a\x04", 2);
    m->big = up;
    for (int k = 0; k < 6; k++)
        add_f32(m, -k);
    if (up)
        add_map(m, RC_RAW_F32, BOTTOM, NAN, 0);
    add_map(m, RC_RAW_F32, up ? BOTTOM | RIGHT : RIGHT, NAN, 0);
    m->big = false;
}

/* One axis or value of an array of NT-MDT; the unit is a text or the code of an SI unit. */
static void
mdt_calibration(struct bytes *m, const char *unit, unsigned code, double bias, double scale,
                size_t n, int type)
{
    size_t at = m->n;

    add_raw(m, RC_RAW_U32, 0);
    add_raw(m, RC_RAW_U32, 76);
    add_raw(m, RC_RAW_U32, 2); /* bytes of the name */
    add_raw(m, RC_RAW_U32, 1); /* bytes of the comment */
    add_raw(m, RC_RAW_U32, (double)strlen(unit));
    add_raw(m, RC_RAW_U64, code);
    add_f64(m, 0);
    add_zeros(m, 8);
    add_f64(m, bias);
    add_f64(m, scale);
    add_raw(m, RC_RAW_U64, 5);
    add_raw(m, RC_RAW_U64, (double)n + 4);
    add_raw(m, RC_RAW_I32, type);
    add_raw(m, RC_RAW_U32, 0);
    add_zeros(m, 8 + 76 - (m->n - at));
    add_text(m, "Nmc");
    add_text(m, unit);
    set_raw(m, at, RC_RAW_U32, (double)(m->n - at));
}

static size_t
mdt_frame(struct bytes *m, unsigned type, unsigned variables)
{
    static const unsigned date[] = {2015, 3, 24, 13, 49, 17};
    size_t at = m->n;

    add_raw(m, RC_RAW_U32, 0);
    add_raw(m, RC_RAW_U16, type);
    add_raw(m, RC_RAW_U16, 0);
    for (int k = 0; k < 6; k++)
        add_raw(m, RC_RAW_U16, date[k]);
    add_raw(m, RC_RAW_U16, variables);
    return at;
}

/* A scan of the phase in degrees, or of the height after points of spectra. */
static void
mdt_scan(struct bytes *m, bool height)
{
    size_t at = mdt_frame(m, 0, 70);
    static const double step[] = {-1.1, 1.29, 0.5};

    for (int k = 0; k < 3; k++) {
        add_f32(m, k == 2 ? 25 : 7);
        add_f32(m, step[k]);
        add_raw(m, RC_RAW_I16, k < 2 ? -2 : height ? -1 : 5);
    }
    add_raw(m, RC_RAW_U8, height ? 0 : 11);
    add_zeros(m, 70 - 31);
    add_raw(m, RC_RAW_U16, 0);
    add_raw(m, RC_RAW_U16, NX);
    add_raw(m, RC_RAW_U16, NY);
    add_raw(m, RC_RAW_U16, height ? 2 : 0);
    add_zeros(m, height ? 14 + 2 * 16 : 0);
    add_map(m, RC_RAW_I16, BOTTOM, 50, 0);
    add_raw(m, RC_RAW_U32, height ? 8 : 0);
    add_text(m, height ? "a Height" : "");
    set_raw(m, at, RC_RAW_U32, (double)(m->n - at));
}

/* 0: a scan, after a scan of another quantity and a text; 1: an array of 16 bits; 2: an array of floats, with
 * units by code */
void
make_mdt(struct bytes *m, int variant)
{
    size_t at;

    add(m, "\x01\xb0\x93\xff", 4);
    add_zeros(m, 8);
    add_raw(m, RC_RAW_U16, variant == 0 ? 2 : 0);
    add_zeros(m, 33 - m->n);
    if (variant == 0) {
        mdt_scan(m, false);
        at = mdt_frame(m, 3, 4);
        add_zeros(m, 40);
        set_raw(m, at, RC_RAW_U32, (double)(m->n - at));
        mdt_scan(m, true);
    } else {
        at = mdt_frame(m, 106, 4);
        add_raw(m, RC_RAW_U32, 76); /* bytes up to the name */
        add_zeros(m, 4 + 32 + 4);
        for (unsigned k = 0; k < 5; k++)
            add_raw(m, RC_RAW_U32, k == 0 ? 6 : k);
        add_zeros(m, 76 - (m->n - at - 22));
        add_text(m, "Height");
        add_zeros(m, 1 + 2 + 3 + 4);
        add_raw(m, RC_RAW_U32, 0);
        add_raw(m, RC_RAW_U32, 24);
        add_zeros(m, 12);
        add_raw(m, RC_RAW_U32, 2);
        add_raw(m, RC_RAW_U32, 1);
        add_zeros(m, 4);
        mdt_calibration(m, variant == 1 ? "um" : "", 0x101, 0, variant == 1 ? 1.1 : 1.1e-6, NX, 0);
        mdt_calibration(m, variant == 1 ? "um" : "", 0x101, 0, variant == 1 ? 1.29 : 1.29e-6, NY,
                        0);
        mdt_calibration(m, variant == 1 ? "nm" : "", 0x101, variant == 1 ? 25 : 25e-9,
                        variant == 1 ? 0.5 : 0.5e-9, 0, variant == 1 ? -2 : -5892);
        add_map(m, variant == 1 ? RC_RAW_I16 : RC_RAW_F32, BOTTOM, 50, 0);
        set_raw(m, at, RC_RAW_U32, (double)(m->n - at));
    }
    set_raw(m, 4, RC_RAW_U32,
            (double)(m->n - 33)); /* without this byte other programs refuse the file */
}

/* 0: 16 bits; 1: floats, where counts in nanometres are labelled Angstrom; 2: compressed, Angstrom. A plane
 * of another quantity follows. */
void
make_createc(struct bytes *m, int variant)
{
    enum rc_raw raw = variant == 0 ? RC_RAW_I16 : RC_RAW_F32;
    static const char *const magics[] = {"[Parameter]", "[Paramet32]", "[Paramco32]"};
    /* 11 Angstrom a node: 55 counts of 0.02 nm, or of 0.2 Angstrom */
    static const char *const scales[] = {
        "Dactonmz=0.02\r\n", "Delta X / Delta X [Dac]=550\r\nDacto[A]xy=2\r\nDacto[A]z=0.02\r\n",
        "Delta X / Delta X [Dac]=550\r\nDacto[A]xy=20\r\nDacto[A]z=0.2\r\n"};
    struct bytes planes = {0};
    uLongf n;

    add_text(m, magics[variant]);
    add_text(m,
             "\r\nDAC-Type=20bit\r\nTitel / Titel=a scan\r\nNum.X / Num.X=3\r\nNum.Y / Num.Y=2\r\n"
             "Length x[A]=33000\r\nLength y[A]=25800\r\nChannels / Channels=2\r\n");
    add_text(m, scales[variant]);
    add_zeros(m, 16384 - m->n);
    add_zeros(&planes, rc_raw_width(raw));
    add_map(&planes, raw, ROWS, 50, 0);
    add_zeros(&planes, 6 * rc_raw_width(raw));
    if (variant < 2)
        add(m, planes.data, planes.n);
    else {
        size_t header = m->n;
        n = compressBound(planes.n);
        add_zeros(m, n);
        if (compress(m->data + header, &n, planes.data, planes.n) != Z_OK)
            abort();
        m->n = header + n;
    }
    drop(&planes);
}

/* 0: one channel, from the upper left; 1: two, the second of heights, column after column from the
 * lower right */
void
make_iso28600(struct bytes *m, int variant)
{
    static const char *const lines[][2] = {
        [1] = {"ISO/TC 201 SPM data transfer format", NULL},
        [8] = {"MAP_SC", "MAP_MC"},
        [17] = {"REGULAR MAPPING", NULL},
        [20] = {"X", "Y"},
        [21] = {"left to right", "bottom to top"},
        [23] = {"top to bottom", "right to left"},
        [24] = {"3", NULL},
        [25] = {"2", NULL},
        [26] = {"um", "nm"},
        [27] = {"um", NULL},
        [28] = {"3.3", "3300"},
        [29] = {"2.58", NULL},
        [69] = {"Depth", "of none"},
        [70] = {"nm", "V"},
        [94] = {"", "2"},
        [95] = {"", "Current"},
        [96] = {"", "nA"},
        [98] = {"", "Height"},
        [99] = {"", "nm"},
        [128] = {"end of header", NULL},
    };
    char number[32];

    for (size_t k = 1; k <= 128; k++) {
        const char *one = k < sizeof lines / sizeof *lines ? lines[k][0] : NULL;
        const char *two = k < sizeof lines / sizeof *lines ? lines[k][1] : NULL;

        add_text(m, variant == 1 && two != NULL ? two : one != NULL ? one : "");
        add_text(m, variant == 1 ? "\r\n" : "\n");
    }
    for (size_t k = 0; k < NX * NY; k++) {
        size_t at = variant == 0 ? k : (NY - 1 - k % NY) * NX + (NX - 1 - k / NY);

        snprintf(number, sizeof number, variant == 0 ? "%g" : "7.5, %.1f", value_of(at, true));
        add_text(m, at == MISSING_AT ? (variant == 0 ? "nan" : "7.5,NaN") : number);
        add_text(m, variant == 1 ? "\r\n" : "\n");
    }
    add_text(m, "end of experiment\n");
}
