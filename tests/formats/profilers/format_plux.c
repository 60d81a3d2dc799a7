/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PLUX files made by this test are read; damaged files, files with wrong sizes and decompression bombs are
 * refused. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/formats/made/made.h"

extern const struct rc_format rc_format_plux, rc_format_x3p;

static const char plux_xml[] =
    "<?xml version=\"1.0\"?><xml><GENERAL><DATE>2023-05-17 10:00</DATE>"
    "<IMAGE_SIZE_X>3</IMAGE_SIZE_X><IMAGE_SIZE_Y>2</IMAGE_SIZE_Y>"
    "<FOV_X>1.25</FOV_X><FOV_Y>0.75</FOV_Y></GENERAL>"
    "<LAYER_0><FILENAME_Z>LAYER_0.raw</FILENAME_Z></LAYER_0>"
    "<LAYER_1><FILENAME_Z>./LAYER_1.raw</FILENAME_Z></LAYER_1>"
    "<INFO><ITEM_0><NAME>Device</NAME><VALUE>S neox</VALUE></ITEM_0></INFO></xml>";

static const double heights[6] = {1.5, -2.25, NAN, 0, 1000, -0.5};

static struct bytes
plux_file(const char *xml, size_t less)
{
    struct bytes first = {0}, second = {0}, b;

    for (size_t k = 0; k < 6; k++) {
        add_f32(&first, heights[k]);
        add_f32(&second, k == 5 ? (less == 99 ? INFINITY : 7) : 2 * heights[k]);
    }
    b = archive((struct member[]){{"index.xml", xml, strlen(xml)},
                                  {"LAYER_0.raw", first.data, first.n - (less == 99 ? 0 : less)},
                                  {"LAYER_1.raw", second.data, second.n}},
                3);
    drop(&first);
    drop(&second);
    return b;
}

static void
plux_is_read(void **state)
{
    struct bytes b = plux_file(plux_xml, 0);
    struct rc_file file = file_of(&b, "made");
    struct rc_channel channel[4];
    struct rc_grid *g;
    double v[6];

    (void)state;
    assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_plux);
    assert_int_equal(list_maps(&rc_format_plux, &file, &rc_no_wish, channel, 4, NULL), 2);
    assert_string_equal(channel[1].name, "Layer 1");
    for (size_t layer = 0; layer < 2; layer++) {
        for (size_t k = 0; k < 6; k++)
            v[k] = (layer == 0 ? heights[k] : k == 5 ? 7 : 2 * heights[k]) * 1e-6;
        g = read_well(&rc_format_plux, &b, layer);
        check_map(g, 3, 2, 1.25e-6, 0.75e-6, v);
        assert_string_equal(rc_grid_get(g, "file.model"), "S neox");
        assert_string_equal(rc_grid_get(g, "file.date"), "2023-05-17 10:00");
        rc_grid_free(g);
    }
    drop(&b);
}
static void
plux_is_refused(void **state)
{
    static const struct {
        const char *from, *to, *why;
    } cases[] = {
        {"<IMAGE_SIZE_X>3</IMAGE_SIZE_X>", "", "no size of an image"},
        {"SIZE_X>3", "SIZE_X>0", "empty"},
        {"SIZE_X>3", "SIZE_X>-3", "whole number"},
        {"SIZE_X>3", "SIZE_X>999999999", "999999999 x 2 values need 15258 MiB"},
        {"SIZE_X>3</IMAGE_SIZE_X><IMAGE_SIZE_Y>2",
         "SIZE_X>999999999999999</IMAGE_SIZE_X><IMAGE_SIZE_Y>999999999999999",
         "more than this machine can address"},
        {"SIZE_X>3", "SIZE_X>18446744073709551616", "whole number"},
        {"SIZE_X>3", "SIZE_X>4", "promises 32 bytes of heights, the file has 24"},
        {"FOV_X>1.25", "FOV_X>0", "must be positive"},
        {"FOV_X>1.25", "FOV_X>-1", "must be positive"},
        {"FOV_X>1.25", "FOV_X>nan", "does not give the spacing"},
        {"FOV_X>1.25", "FOV_X>inf", "must be positive and finite"},
        {"FOV_X>1.25", "FOV_X>wide", "not a number"},
        {"LAYER_0.raw", "LAYER_9.raw", "no member 'LAYER_9.raw'"},
        {"LAYER_0.raw", "../../etc/passwd", "no member"},
        {"<?xml version=\"1.0\"?>",
         "<!DOCTYPE x [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]>", "document type"},
        {"</xml>", "", "not well-formed XML"},
    };
    struct bytes b;

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char *xml = with(plux_xml, cases[k].from, cases[k].to);
        b = plux_file(xml, 0);
        refuse(&rc_format_plux, &b, cases[k].why);
        drop(&b);
        free(xml);
    }
    b = plux_file(plux_xml, 4);
    refuse(&rc_format_plux, &b, "promises 24 bytes of heights, the file has 20");
    drop(&b);
    b = archive((struct member[]){{"other.xml", plux_xml, 4}}, 1);
    refuse(&rc_format_plux, &b, "no index.xml");
    drop(&b);
    b = plux_file(plux_xml, 0);
    refuse_cuts(&rc_format_plux, &b, b.n, 1);
    survive_changes(&rc_format_plux, &b, 3000);
    drop(&b);
}

static void
plux_infinite(void **state)
{
    struct bytes b = plux_file(plux_xml, 99);
    struct rc_err err;
    struct rc_grid *g = read_well(&rc_format_plux, &b, 1);
    double v[6];

    (void)state;
    for (size_t k = 0; k < 6; k++)
        v[k] = k == 5 ? NAN : 2e-6 * heights[k];
    check_map(g, 3, 2, 1.25e-6, 0.75e-6, v);
    rc_grid_free(g);
    assert_null(try_read(&rc_format_plux, &b, &rc_no_wish, 2, &err));
    assert_non_null(strstr(err.text, "there is no channel 3: the file has 2"));
    drop(&b);
}

/* 64 MiB of zeros compress to 64 KiB, and would give 128 MiB of heights. */
static void
zip_bombs(void **state)
{
    enum {
        SIDE = 4096
    };
    static const char x3p_xml[] =
        "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\"><Record1>"
        "<FeatureType>SUR</FeatureType><Axes><CX><AxisType>I</AxisType><Increment>1</Increment></"
        "CX>"
        "<CY><AxisType>I</AxisType><Increment>1</Increment></CY><CZ><DataType>F</DataType></CZ></"
        "Axes>"
        "</Record1><Record3><MatrixDimension><SizeX>4096</SizeX><SizeY>4096</SizeY><SizeZ>1</SizeZ>"
        "</MatrixDimension><DataLink><PointDataLink>data.bin</PointDataLink></DataLink></Record3>"
        "</p:ISO5436_2>";
    char *zeros = calloc((size_t)SIDE * SIDE, 4), *one, *two;
    struct bytes b;

    (void)state;
    assert_non_null(zeros);
    one = with(plux_xml, "SIZE_X>3", "SIZE_X>4096");
    two = with(one, "SIZE_Y>2", "SIZE_Y>4096");
    b = archive((struct member[]){{"index.xml", two, strlen(two)},
                                  {"LAYER_0.raw", zeros, (size_t)SIDE * SIDE * 4}},
                2);
    printf("a bomb of %zu bytes\n", b.n);
    refuse(&rc_format_plux, &b, "4096 x 4096 values need 128 MiB, more than the 65");
    drop(&b);
    b = archive((struct member[]){{"main.xml", x3p_xml, strlen(x3p_xml)},
                                  {"data.bin", zeros, (size_t)SIDE * SIDE * 4}},
                2);
    refuse(&rc_format_x3p, &b, "4096 x 4096 values need 128 MiB, more than the 65");
    drop(&b);
    free(one);
    free(two);
    free(zeros);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plux_is_read),
        cmocka_unit_test(plux_is_refused),
        cmocka_unit_test(plux_infinite),
        cmocka_unit_test(zip_bombs),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
