/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A synthetic file with one false field is refused, and the message names the field. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "formats/format.h"
#include "made/made.h"

/* A field of a synthetic file that gets another value, and the expected message. */
static const struct {
    const char *format;
    void (*make)(struct bytes *m, int variant);
    int variant;
    bool big;
    size_t at;
    enum rc_raw raw;
    double value;
    const char *why;
} fields[] = {
    {"sdf", make_sdf_binary, 5, false, 42, RC_RAW_U16, 0, "NumPoints) is 0"},
    {"sdf", make_sdf_binary, 5, false, 42, RC_RAW_U16, 65535, "65535 x 2 values"},
    {"sdf", make_sdf_binary, 5, false, 46, RC_RAW_F64, 0, "spacing in x is 0 m"},
    {"sdf", make_sdf_binary, 5, false, 46, RC_RAW_F64, -1e-6, "spacing in x is -1e-06 m"},
    {"sdf", make_sdf_binary, 5, false, 54, RC_RAW_F64, INFINITY, "spacing in y is inf"},
    {"sdf", make_sdf_binary, 5, false, 46, RC_RAW_F64, NAN, "does not give the spacing in x"},
    {"sdf", make_sdf_binary, 5, false, 62, RC_RAW_F64, 0, "not 0"},
    {"sdf", make_sdf_binary, 5, false, 62, RC_RAW_F64, NAN, "must be finite"},
    {"sdf", make_sdf_binary, 5, false, 78, RC_RAW_U8, 1, "Compression is 1"},
    {"sdf", make_sdf_binary, 5, false, 79, RC_RAW_U8, 8, "DataType is 8"},
    {"sur", make_sur, 0, false, 108, RC_RAW_I32, -1, "columns is -1"},
    {"sur", make_sur, 0, false, 108, RC_RAW_I32, 2147483647, "2147483647 x 2 values"},
    {"sur", make_sur, 2, false, 108, RC_RAW_I32, 2147483647, "the file is damaged"},
    {"sur", make_sur, 2, false, 108, RC_RAW_I32, 4, "heights"},
    {"sur", make_sur, 2, false, 524, RC_RAW_U32, 4294967295.0, "no room for their table"},
    {"sur", make_sur, 2, false, 528, RC_RAW_U32, 4294967295.0, "stream 1 promises"},
    {"sur", make_sur, 2, false, 532, RC_RAW_U32, 4294967295.0, "stream 1 promises"},
    {"sur", make_sur, 2, false, 532, RC_RAW_U32, 3, "damaged"},
    {"sur", make_sur, 0, false, 98, RC_RAW_I16, 8, "8 bits"},
    {"sur", make_sur, 0, false, 334, RC_RAW_I16, -1, "comment and private part"},
    {"sur", make_sur, 0, false, 120, RC_RAW_F32, 0, "spacing in x is 0"},
    {"sur", make_sur, 0, false, 18, RC_RAW_I16, 12, "colour image (type 12)"},
    {"sur", make_sur, 0, false, 18, RC_RAW_I16, 99, "of type 99"},
    {"opd", make_opd, 0, false, 2 + 18, RC_RAW_I32, 2147483647, "directory takes"},
    {"opd", make_opd, 0, false, 2 + 18, RC_RAW_I32, 24, "no block RAW_DATA"},
    {"opd", make_opd, 0, false, 2 + 24 + 18, RC_RAW_I32, -1, "takes -1 bytes"},
    {"opd", make_opd, 0, false, 2 + 48 + 18, RC_RAW_I32, 2147483647, "'RAW_DATA' takes"},
    {"opd", make_opd, 0, false, 197, RC_RAW_U16, 4, "4 x 2 heights"},
    {"opd", make_opd, 0, false, 201, RC_RAW_U16, 8, "8 bytes"},
    {"metropro", make_metropro, 0, true, 68, RC_RAW_I16, 4, "do not make"},
    {"metropro", make_metropro, 0, true, 72, RC_RAW_I32, 0, "no phase"},
    {"metropro", make_metropro, 0, true, 218, RC_RAW_I16, 3, "resolution is 3"},
    {"metropro", make_metropro, 0, true, 6, RC_RAW_U32, 4294967295.0, "header and intens"},
    {"metropro", make_metropro, 0, true, 184, RC_RAW_F32, 0, "does not give the spacing"},
    {"plu", make_plu, 0, false, 0x1f4, RC_RAW_U32, 7, "repeat the sizes"},
    {"plu", make_plu, 0, false, 0x1ac, RC_RAW_U32, 0, "an image (type 0)"},
    {"plu", make_plu, 0, false, 0x1ac, RC_RAW_U32, 4294967295.0, "something else"},
    {"plu", make_plu, 0, false, 0x194, RC_RAW_F32, -1, "spacing in x is -1e-06"},
    {"ibw", make_ibw, 0, false, 148, RC_RAW_F64, -1, "spacing in x is -1e-06"},
    {"ibw", make_ibw, 0, false, 80, RC_RAW_I16, 3, "complex"},
    {"ibw", make_ibw, 0, false, 80, RC_RAW_I16, 0, "text"},
    {"ibw", make_ibw, 2, false, 136, RC_RAW_I32, 0, "2 layers of no rows"},
    {"ibw", make_ibw, 0, false, 144, RC_RAW_I32, 2, "4 dimensions"},
    {"ibw", make_ibw, 0, false, 132, RC_RAW_I32, 2147483647, "promises"},
    {"ibw", make_ibw, 0, false, 0, RC_RAW_I16, 2, "version 2"},
    {"frt", make_frt, 0, false, 16, RC_RAW_U16, 65535, "block 7 of 65535"},
    {"frt", make_frt, 0, false, 16, RC_RAW_U16, 5, "no block of heights"},
    {"frt", make_frt, 1, false, 20, RC_RAW_U64, 18446744073709549568.0, "does not end"},
    {"vk", make_vk4, 0, false, 36, RC_RAW_U32, 4294967295.0, "height image 1 begins"},
    {"vk", make_vk4, 0, false, 36, RC_RAW_U32, 0, "no height image"},
    {"vk", make_vk4, 0, false, 12, RC_RAW_U32, 4294967295.0, "conditions"},
    {"vk", make_vk4, 0, false, 388 + 12, RC_RAW_U32, 1, "compressed"},
    {"vk", make_vk4, 0, false, 388 + 16, RC_RAW_U32, 25, "do not make"},
    {"vk", make_vk4, 0, false, 388 + 8, RC_RAW_U32, 24, "24 bits"},
    {"grd", make_grd, 1, false, 4, RC_RAW_I16, -1, "columns is -1"},
    {"grd", make_grd, 2, false, 16, RC_RAW_I32, -1, "promises -1 bytes"},
    {"grd", make_grd, 2, false, 24, RC_RAW_I32, 2147483647, "DATA has 48 bytes"},
    {"grd", make_grd, 2, false, 76, RC_RAW_F64, 45, "rotated"},
    {"tmd", make_tmd, 1, false, 33, RC_RAW_I32, 0, "columns is 0"},
    {"tmd", make_tmd, 1, false, 41, RC_RAW_F32, NAN, "does not give the spacing in x"},
};

/* Headers of text with one line changed. */
static const struct {
    const char *format;
    void (*make)(struct bytes *m, int variant);
    int variant;
    const char *from, *to; /* words of the same length */
    const char *why;
    int flags;
} lines[] = {
    {"sdf", make_sdf_text, 0, "NumPoints = 3", "NumPoints = 9", "the file has", 0},
    {"sdf", make_sdf_text, 0, "NumPoints = 3", "NumPoints = x", "'x', but must be a number", 0},
    {"sdf", make_sdf_text, 0, "BAD", "bed", "'bed': that is not a number", 0},
    {"sdf", make_sdf_text, 0, "1.1E-6", "-1.1E6", "spacing in x is -1100000", 0},
    {"al3d", make_al3d, 0, "800\0", "9999", "begins at byte 9999", 0},
    {"nanoscope", make_nanoscope, 0, "offset: 1024", "offset: 1034", "from byte 1034", 0},
    {"nanoscope", make_nanoscope, 0, "Samps/line: 3", "Samps/line: 0", "Samps/line) is 0", 0},
    {"nanoscope", make_nanoscope, 0, "File list end", "Fool list end", "does not end", 0},
    {"nanoscope", make_nanoscope, 0, "65.536", "sixty!", "no value is found", 0},
    {"nid", make_nid, 0, "SaveBits=16", "SaveBits=17", "SaveBits is 17", 0},
    {"nid", make_nid, 0, "SaveBits=16\r", "SaveBits=nan", "SaveBits is nan", 0}, /* fuzzing */
    {"nid", make_nid, 0, "Points=3", "Points=9", "the file has", 0},
    {"nid", make_nid, 0, "=DataSet-0:1", "=DataSet-9:1", "not there", 0},
    {"gsf", make_gsf, 0, "XRes = 3", "XRes = 0", "XRes) is 0", 0},
    {"gsf", make_gsf, 0, "XRes = 3", "XRes = 9", "the file has", 0},
    {"gsf", make_gsf, 0, "XYUnits = m", "XYUnits = s", "does not give the spacing", 0},
    {"mi", make_mi, 0, "xPixels       3", "xPixels       9", "the file has", 0},
    {"mi", make_mi, 0, "BINARY", "ASCII!", "only BINARY", 0},
    {"mi", make_mi, 0, "Image", "Spect", "not an image but 'Spect'", 0},
    {"wsxm", make_wsxm, 0, "columns: 3", "columns: 9", "the file has", 0},
    {"wsxm", make_wsxm, 0, "short", "shirt", "'shirt'", 0},
    {"wsxm", make_wsxm, 0, "size:   512", "size: 99999", "99999 bytes", 0},
    {"sxm", make_sxm, 0, "       3       2", "       9       2", "maps of 9 x 2 floats", 0},
    {"sxm", make_sxm, 0, "       3       2", "    2000000000 2", "2000000000 x 2", 0},
    {"sxm", make_sxm, 0, "       3       2", "       3      no", "(SCAN_PIXELS) is nan", 0},
    {"sxm", make_sxm, 0, "3.300000E-6", "-3.30000E-6", "spacing in x is -1.1", 0},
    {"sxm", make_sxm, 0, "SCANIT_END", "SCANIT_EMD", "does not end", 0},
    {"sxm", make_sxm, 0, "MSBFIRST", "FSBFIRST", "it must be FLOAT MSBFIRST", 0},
    {"sxm", make_sxm, 0, "SCANIT_TYPE", "SCANIT_TIPE", "no SCANIT_TYPE", 0},
    {"sxm", make_sxm, 0, "both", "bath", "a direction in DATA_INFO is 'bath'", 0},
    {"sxm", make_sxm, 0, "\tboth\t", " both ", "a row without name", 0},
    {"sxm", make_sxm, 0, "DATA_INFO", "DATA-INFO", "no map in the file", 0},
    {"keyence", make_keyence, 0, "\"Horizontal\",\"3\"", "\"Horizontal\",\"4\"",
     "has 3 columns and 2 rows", 0},
    {"keyence", make_keyence, 0, "\"Vertical\",\"2\"", "\"Vertical\",\"9\"",
     "does not have these two sizes", 0},
    {"keyence", make_keyence, 0, "1100.000", "-100.000", "spacing in x is -1", 0},
    {"keyence", make_keyence, 0, "\"nm\"", "\"no\"", "has no row of a name, a number and a unit",
     0},
    {"keyence", make_keyence, 0, "ImageDataCsv", "ImageDataTsv", "there is no 'ImageDataCsv'", 0},
    {"keyence", make_keyence, 0, "\"10.0\"", "\"ten \"", "is not a number", 0},
    {"keyence", make_keyence, 0, "\"Unit\",\"nm\"", "\"Unit\",\"--\"", "--z-unit", 0},
    {"wykotext", make_wykotext, 0, "X Size\t3", "X Size\t9", "the file has", 0},
    {"wykotext", make_wykotext, 0, "X Size\t3", "X Seze\t3", "X Size) is nan", 0},
    {"wykotext", make_wykotext, 0, "Bad", "bed", "'bed': that is not a number", 0},
    {"wykotext", make_wykotext, 0, "RAW_DATA", "RAW-DATA", "no block RAW_DATA", 0},
    {"wykotext", make_wykotext, 0, "Wavelength", "Wavelenght", "--z-unit", 0},
    {"wykotext", make_wykotext, 0, "Pixel_size", "Pixel-size", "does not give the spacing", 0},
    {"wykotext", make_wykotext, 0, "\t640", "\tabc", "abc", 0},
    {"wykotext", make_wykotext, 0, "Y Size\t2", "Y Size\t1", "it must have the 1 of Y Size", 0},
    {"wykotext", make_wykotext, 2, "Y Size\t2", "Y Size\t1", "the 1 points of a column", 0},
    {"wykotext", make_wykotext, 2, "X Size\t3", "X Size\t4", "the file ends before", 0},
    {"wykotext", make_wykotext, 2, "0.001100\t0.001290", "0.001200\t0.001290", "is at x = 0.0012",
     0},
    {"wykotext", make_wykotext, 2, "Bad", "bed", "a height or 'Bad' are expected", 0},
    {"zygo", make_zygo, 0, "10 20 3 2", "10 20 2 2", "is outside the 2 x 2 of the header", 0},
    {"zygo", make_zygo, 0, "10 20 3 2", "11 20 3 2", "is outside the 3 x 2 of the header", 0},
    {"zygo", make_zygo, 0, "10 20 3 2", "10 20 0 2", "columns (line 4) is 0", 0},
    {"zygo", make_zygo, 0, "No Data", "No Date", "a column, a row and a height or 'No Data'", 0},
    {"zygo", make_zygo, 0, "1.1e-006", "0000e-06", "does not give the spacing", 0},
    {"zygo", make_zygo, 0, "0.03\n#", "0.03\n-", "do not end with a line '#'", 0},
    {"zygo", make_zygo, 1, "10 20 3 2", "10 20 9 2", "promises 9 x 2 numbers", 0},
    {"zygo", make_zygo, 1, "0 1 20 2 0", "7 1 20 2 0", "phase resolution (line 11) is 7", 0},
    {"zygo", make_zygo, 1, "6.25e-007", "0.00e-007", "not 0", 0},
    {"zygo", make_zygo, 1, "4 5 6\n#", "4 5 6\n-", "do not end with a line '#'", 0},
    {"bcr", make_bcr, 0, "xpixels = 3", "xpixels = 9", "the file has", 0},
    {"bcr", make_bcr, 0, "xlength = 3300", "xlength = -300", "spacing in x is -1.0", 0},
    {"bcr", make_bcr, 0, "bit2nm = 0.25", "bit2nm = 0.00", "not 0", 0},
    {"grd", make_grd, 0, "3 2", "9 2", "the file has 6", NO_SPACING | NO_UNIT},
    {"esri", make_esri, 0, "ncols 3", "ncols 4", "the file has 6", NO_SPACING | NO_UNIT},
    {"npy", make_npy, 0, "(2, 3)", "(2, 9)", "the file has", 0},
    {"npy", make_npy, 0, "(2, 3)", "(1,2,3", "no shape", 0},
    {"npy", make_npy, 0, "<f8", "<c8", "is of type '<c8': real", 0},
    {"gwy", make_gwy, 0, "GwyContainer", "GwyContained", "GwyContainer", 0},
    {"gwy", make_gwy, 0, "GwyDataField", "GwyDataFeeld", "is not one", 0},
    {"vk", make_vk6, 0, "Vk4File", "Vk4Fool", "no archive with a member", 0},
};

static void
refused(const char *format, const struct bytes *m, int flags, const char *what, const char *why)
{
    struct rc_file file = {"made", m->data, m->n};
    struct rc_wish wish = wish_for(flags);
    struct rc_err err = {""};
    struct rc_grid *g = read_map(rc_format_named(format), &file, &wish, 0, NULL, &err);

    if (g != NULL || !gives_reason(err.text, why))
        fail_msg("%s with %s: %s", format, what, g == NULL ? err.text : "read");
}

static void
fields_that_lie(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof fields / sizeof *fields; k++) {
        struct bytes m = {0};
        char what[80];

        fields[k].make(&m, fields[k].variant);
        m.big = fields[k].big;
        set_raw(&m, fields[k].at, fields[k].raw, fields[k].value);
        snprintf(what, sizeof what, "%g at %zu", fields[k].value, fields[k].at);
        refused(fields[k].format, &m, 0, what, fields[k].why);
        drop(&m);
    }
}

static void
lines_that_lie(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        size_t n = strlen(lines[k].to), changed = 0;
        struct bytes m = {0};

        lines[k].make(&m, lines[k].variant);
        for (size_t at = 0; at + n <= m.n; at++)
            if (memcmp(m.data + at, lines[k].from, n) == 0) {
                memcpy(m.data + at, lines[k].to, n);
                changed++;
            }
        assert_true(changed > 0);
        refused(lines[k].format, &m, lines[k].flags, lines[k].to, lines[k].why);
        drop(&m);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_that_lie),
        cmocka_unit_test(lines_that_lie),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
