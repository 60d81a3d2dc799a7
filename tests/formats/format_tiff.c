/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JPK and LEXT files made by this test are read in both byte orders. Damaged files, and files that would take
 * much memory or time, are refused. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <zlib.h>

#include "made/made.h"

extern const struct rc_format rc_format_jpk, rc_format_park, rc_format_lext;

/* ---- JPK ---- */

enum {
    SLOT = 0x8090,
    STRIDE = 0x30
};

/* A thumbnail with the size of the scan, a channel in metres and one in volts. */
static struct bytes
jpk_pages(bool big, bool reflected, const char *scaling, double multiply, bool second)
{
    const struct tag scan[] = {text_tag(0x8003, "2017-01-16 16:00"),
                               number_tag(0x8042, 12, 3.3e-6),
                               number_tag(0x8043, 12, 2.2e-6),
                               {0}};
    const struct tag heights[] = {number_tag(339, 3, 2),
                                  number_tag(0x8045, 3, reflected),
                                  text_tag(0x8050, "height"),
                                  number_tag(0x8051, 8, 1),
                                  text_tag(0x8052, "Height (measured)"),
                                  number_tag(0x8080, 4, 2),
                                  text_tag(0x8081, "calibrated"),
                                  text_tag(SLOT, "raw"),
                                  text_tag(SLOT + 0x13, "NullScaling"),
                                  text_tag(SLOT + STRIDE, "calibrated"),
                                  text_tag(SLOT + STRIDE + 0x12, "m"),
                                  text_tag(SLOT + STRIDE + 0x13, scaling),
                                  number_tag(SLOT + STRIDE + 0x14, 12, multiply),
                                  number_tag(SLOT + STRIDE + 0x15, 12, 5e-7),
                                  {0}};
    const struct tag volts[] = {number_tag(339, 3, 2),
                                text_tag(0x8050, "error"),
                                number_tag(0x8080, 4, 1),
                                text_tag(0x8081, "raw"),
                                text_tag(SLOT, "raw"),
                                text_tag(SLOT + 0x12, "V"),
                                text_tag(SLOT + 0x13, "NullScaling"),
                                {0}};
    struct bytes b, pixels = {.big = big};
    size_t last = 4;

    pixels_i32(&pixels, raw_counts, 6);
    tiff_start(&b, big);
    last = tiff_page(&b, last, 2, 1, 8, 1, NULL, "\1\2", 2, scan);
    last = tiff_page(&b, last, 3, 2, 32, 1, NULL, pixels.data, pixels.n, heights);
    if (second)
        tiff_page(&b, last, 3, 2, 32, 1, NULL, pixels.data, pixels.n, volts);
    drop(&pixels);
    return b;
}

static struct bytes
jpk_file(bool big, bool reflected, const char *scaling, double multiply)
{
    return jpk_pages(big, reflected, scaling, multiply, true);
}

static void
jpk_is_read(void **state)
{
    (void)state;
    for (int big = 0; big < 2; big++)
        for (int reflected = 0; reflected < 2; reflected++) {
            struct bytes b = jpk_file(big, reflected, "LinearScaling", -2e-10);
            struct rc_file file = file_of(&b, "made");
            struct rc_channel channel[4];
            struct rc_grid *g;
            double v[6];

            assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_jpk);
            assert_int_equal(list_maps(&rc_format_jpk, &file, &rc_no_wish, channel, 4, NULL), 2);
            assert_string_equal(channel[0].name, "Height (measured, retrace)");
            assert_string_equal(channel[0].unit, "m");
            assert_string_equal(channel[1].name, "error");
            assert_string_equal(channel[1].unit, "V");
            for (size_t k = 0; k < 6; k++)
                v[k] = raw_counts[reflected ? k : (k + 3) % 6] * -2e-10 + 5e-7;
            g = read_well(&rc_format_jpk, &b, 0);
            check_map(g, 3, 2, 1.1e-6, 1.1e-6, v);
            assert_string_equal(rc_grid_get(g, "file.date"), "2017-01-16 16:00");
            rc_grid_free(g);
            drop(&b);
        }
}

static void
jpk_volts_stay_volts_or_get_a_unit(void **state)
{
    struct bytes b = jpk_file(false, true, "LinearScaling", 1);
    struct rc_wish wish = {.dx = NAN, .dy = NAN, .z_unit = 2e-9};
    struct rc_err err;
    struct rc_grid *g;
    double v[6];

    (void)state;
    g = read_well(&rc_format_jpk, &b, 1);
    assert_string_equal(g->unit, "V");
    assert_string_not_equal(g->channel, "height");
    assert_string_equal(g->channel, rc_grid_get(g, "file.channel"));
    for (size_t k = 0; k < 6; k++)
        assert_true(g->v[k] == raw_counts[(k + 3) % 6]);
    rc_grid_free(g);
    g = try_read(&rc_format_jpk, &b, &wish, 1, &err);
    assert_non_null(g);
    for (size_t k = 0; k < 6; k++)
        v[k] = raw_counts[(k + 3) % 6] * 2e-9; /* the grid of this page is not reflected */
    check_map(g, 3, 2, 1.1e-6, 1.1e-6, v);
    rc_grid_free(g);
    assert_null(try_read(&rc_format_jpk, &b, &rc_no_wish, 2, &err));
    assert_non_null(strstr(err.text, "there is no channel 3: the file has 2"));
    drop(&b);
}

static void
jpk_is_refused(void **state)
{
    struct bytes b = jpk_file(false, false, "OffsetScaling", 1);
    const struct tag none[] = {number_tag(0x8042, 12, 0), number_tag(0x8043, 12, NAN), {0}};
    size_t last;

    (void)state;
    refuse(&rc_format_jpk, &b, "no linear scale");
    drop(&b);
    b = jpk_file(false, false, "LinearScaling", INFINITY);
    refuse(&rc_format_jpk, &b, "infinite");
    drop(&b);
    tiff_start(&b, false);
    tiff_page(&b, 4, 2, 1, 8, 1, NULL, "\1\2", 2, NULL);
    refuse(&rc_format_jpk, &b, "no JPK scan");
    drop(&b);
    tiff_start(&b, false);
    last = tiff_page(&b, 4, 2, 1, 8, 1, NULL, "\1\2", 2, none);
    (void)last;
    refuse(&rc_format_jpk, &b, "without a channel");
    drop(&b);
    b = jpk_pages(true, false, "LinearScaling", 1, false);
    refuse_cuts(&rc_format_jpk, &b, b.n - 4,
                1); /* the last four bytes state that no page follows */
    survive_changes(&rc_format_jpk, &b, 150);
    drop(&b);
}

/* ---- LEXT ---- */

static const char lext_xml[] =
    "<?xml version=\"1.0\" encoding=\"utf-8\"?>\r\n<TiffTagDescData v=\"1\"><HeightInfo>"
    "<HeightDataPerPixelX>1250000</HeightDataPerPixelX>"
    "<HeightDataPerPixelY>2500000</HeightDataPerPixelY>"
    "<HeightDataPerPixelZ>625</HeightDataPerPixelZ></HeightInfo></TiffTagDescData>";
static const char exif_xml[] = "<ExifTagDescData><ImageCommonSettingsInfo>"
                               "<MakerCalibrationValueX>1000000</MakerCalibrationValueX>"
                               "<MakerCalibrationValueY>500000</MakerCalibrationValueY>"
                               "<MakerCalibrationValueZ>2000000</MakerCalibrationValueZ>"
                               "</ImageCommonSettingsInfo></ExifTagDescData>";

static size_t height_link; /* the position of the word in HEIGHT that points to the next page */

static struct bytes
lext_file(bool big, const char *xml, const char *exif, const char *name)
{
    struct bytes b, pixels = {.big = big};
    struct tag tags[] = {{0}, {0}};
    size_t last;

    for (size_t k = 0; k < 6; k++)
        add_number(&pixels, 60000 + k, 2); /* above the largest value of int16 */
    tiff_start(&b, big);
    if (exif != NULL) {
        const struct tag settings[] = {{0xa40b, 7, (uint32_t)strlen(exif), exif, 0}, {0}};
        tags[0] = number_tag(34665, 4, (double)tiff_directory(&b, settings));
    }
    last = tiff_page(&b, 4, 1, 1, 8, 3, xml, "\1\2\3", 3, tags);
    height_link = tiff_page(&b, last, 3, 2, 16, 1, name, pixels.data, pixels.n, NULL);
    tiff_page(&b, height_link, 3, 2, 1, 1, "INVALID", "\x40\x20", 2, NULL);
    drop(&pixels);
    return b;
}

static void
lext_is_read(void **state)
{
    (void)state;
    for (int big = 0; big < 2; big++)
        for (int exif = 0; exif < 2; exif++) {
            struct bytes b = lext_file(big, lext_xml, exif ? exif_xml : NULL, "HEIGHT");
            struct rc_file file = file_of(&b, "made");
            double z = 625e-12 * (exif ? 2 : 1), v[6];
            struct rc_grid *g;

            assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_lext);
            for (size_t k = 0; k < 6; k++)
                v[k] = k == 1 || k == 5 ? NAN : (60000 + (double)k) * z;
            g = read_well(&rc_format_lext, &b, 0);
            check_map(g, 3, 2, 1.25e-6, exif ? 1.25e-6 : 2.5e-6, v);
            rc_grid_free(g);
            drop(&b);
        }
}

static void
lext_is_refused(void **state)
{
    static const struct {
        const char *xml, *exif, *name, *why;
    } cases[] = {
        {lext_xml, NULL, "COLOR", "no page HEIGHT"},
        {"no XML", NULL, "HEIGHT", "no description in XML"},
        {"<TiffTagDescData><HeightInfo/></TiffTagDescData>", NULL, "HEIGHT",
         "gives no HeightDataPerPixelX"},
        {"<TiffTagDescData><HeightInfo><HeightDataPerPixelX>x</HeightDataPerPixelX></HeightInfo>"
         "</TiffTagDescData>",
         NULL, "HEIGHT", "is 'x': that is not a number"},
        {"<!DOCTYPE l [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]>"
         "<TiffTagDescData>&b;</TiffTagDescData>",
         NULL, "HEIGHT", "document type"},
        {lext_xml, "<!DOCTYPE l><ExifTagDescData/>", "HEIGHT", "document type"},
        {lext_xml, "<ExifTagDescData>", "HEIGHT", "not well-formed XML"},
        {"<TiffTagDescData><HeightInfo><HeightDataPerPixelX>0</HeightDataPerPixelX>"
         "<HeightDataPerPixelY>1</HeightDataPerPixelY><HeightDataPerPixelZ>1</HeightDataPerPixelZ>"
         "</HeightInfo></TiffTagDescData>",
         NULL, "HEIGHT", "must be positive"},
        {"<TiffTagDescData><HeightInfo><HeightDataPerPixelX>1</HeightDataPerPixelX>"
         "<HeightDataPerPixelY>1</HeightDataPerPixelY><HeightDataPerPixelZ>0</HeightDataPerPixelZ>"
         "</HeightInfo></TiffTagDescData>",
         NULL, "HEIGHT", "not 0"},
    };
    struct bytes b;

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        b = lext_file(false, cases[k].xml, cases[k].exif, cases[k].name);
        refuse(&rc_format_lext, &b, cases[k].why);
        drop(&b);
    }
    b = lext_file(true, lext_xml, exif_xml, "HEIGHT");
    refuse_cuts(&rc_format_lext, &b, height_link, 1);
    survive_changes(&rc_format_lext, &b, 150);
    drop(&b);
}

/* ---- tags that require memory ---- */

/* A directory in which every entry refers to the whole file: 3000 entries of 12 bytes would give 3000
 * copies. */
static void
many_large_tags(void **state)
{
    enum {
        ENTRIES = 3000,
        SIZE = 1 << 20
    };
    struct bytes b;
    struct rc_err err;
    struct rc_grid *g;

    (void)state;
    tiff_start(&b, false);
    set_raw(&b, 4, RC_RAW_U32, 8);
    add_number(&b, ENTRIES, 2);
    for (unsigned k = 0; k < ENTRIES; k++) {
        add_number(&b, 40000 + k, 2);
        add_number(&b, 1, 2);
        add_number(&b, SIZE - 64, 4);
        add_number(&b, 8, 4);
    }
    add_number(&b, 0, 4);
    b.data = realloc(b.data, SIZE);
    memset(b.data + b.n, 0, SIZE - b.n);
    b.n = SIZE;
    g = try_read(&rc_format_jpk, &b, &rc_no_wish, 0, &err);
    assert_null(g);
    printf("3000 tags of a megabyte each: %s\n", err.text);
    /* by the library, or by the sandbox if the library takes the memory */
    assert_true(strstr(err.text, "its first page cannot be read") != NULL ||
                strstr(err.text, "its library") != NULL);
    drop(&b);
}

/* A picture is not a map, and the message says so. */
static void
pictures_are_refused(void **state)
{
    struct rc_file file;
    struct bytes b;

    (void)state;
    tiff_start(&b, false);
    tiff_page(&b, 4, 2, 1, 8, 1, "a picture", "\1\2", 2, NULL);
    file = file_of(&b, "made.tif");
    refuse(rc_format_find(&file, NULL), &b, "pictures without heights are not read");
    drop(&b);
}

/* Directories that point back to themselves. */
static void
endless_directories(void **state)
{
    struct bytes b = lext_file(false, lext_xml, NULL, "COLOR");
    uint32_t first;

    (void)state;
    memcpy(&first, b.data + 4, 4);
    set_raw(&b, b.n - 4, RC_RAW_U32, first); /* offset of the last page */
    refuse(&rc_format_lext, &b, "no end to the pages");
    drop(&b);
}

/* 128 MiB of zeros in a file of a few hundred KiB, compressed as in TIFF, as a map and as the thumbnail
 * before a map. */
static void
tiff_bombs(void **state)
{
    const size_t side = 8192;
    unsigned char *zeros = calloc(2 * side, side), *packed;
    uLongf n = compressBound((uLong)(2 * side * side));
    struct rc_wish wish = {.dx = 1, .dy = 1, .z_unit = 1};

    (void)state;
    packed = malloc(n);
    assert_true(zeros != NULL && packed != NULL);
    assert_int_equal(compress2(packed, &n, zeros, (uLong)(2 * side * side), 9), Z_OK);
    for (int way = 0; way < 2; way++) {
        struct bytes b;
        struct rc_err err;
        struct rc_grid *g;
        size_t last;

        tiff_start(&b, false);
        if (way == 0) {
            last = tiff_page(&b, 4, 1, 1, 8, 3, lext_xml, "\1\2\3", 3, NULL);
            tiff_packed_page(&b, last, side, side, 16, 1, "HEIGHT", packed, n, NULL);
            assert_null(try_read(&rc_format_lext, &b, &wish, 0, &err));
            printf("a bomb of %zu bytes: %s\n", b.n, err.text);
            assert_non_null(strstr(err.text, "may take"));
        } else { /* the thumbnail is ignored: the map after it is read */
            last = tiff_packed_page(&b, 4, side, side, 16, 1, lext_xml, packed, n, NULL);
            tiff_page(&b, last, 3, 1, 16, 1, "HEIGHT", "\1\0\2\0\3\0", 6, NULL);
            assert_non_null(g = try_read(&rc_format_lext, &b, &wish, 0, &err));
            assert_int_equal(g->nx, 3);
            rc_grid_free(g);
        }
        drop(&b);
    }
    free(packed);
    free(zeros);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jpk_is_read),     cmocka_unit_test(jpk_volts_stay_volts_or_get_a_unit),
        cmocka_unit_test(jpk_is_refused),  cmocka_unit_test(lext_is_read),
        cmocka_unit_test(lext_is_refused), cmocka_unit_test(pictures_are_refused),
        cmocka_unit_test(many_large_tags), cmocka_unit_test(endless_directories),
        cmocka_unit_test(tiff_bombs),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
