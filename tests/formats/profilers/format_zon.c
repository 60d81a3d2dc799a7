/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keyence ZON files made by this test: an archive after a picture, with marks for points that were not
 * measured. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "formats/containers/containers.h"
#include "tests/formats/made/made.h"

extern const struct rc_format rc_format_zon;

static const char calibration[] =
    "<?xml version=\"1.0\"?><Calibration><XYCalibration><MeterPerPixel>1.1E-06"
    "</MeterPerPixel></XYCalibration><ZCalibration><MeterPerUnit>1E-10"
    "</MeterPerUnit></ZCalibration></Calibration>";
static const char device[] = "<Device><DeviceModelName>VR-3200</DeviceModelName><DeviceSerialId>#1"
                             "</DeviceSerialId></Device>";

static const char scan[] = "<Scan><ScanDateTime>2024-02-29T10:00:00</ScanDateTime></Scan>";

/* An array of NX x NY, each row followed by `padding` bytes. An array of marks has 1, 2 and 0x80 at points 1
 * to 3. */
static struct bytes
array(size_t width, size_t padding)
{
    struct bytes b = {0};

    add_raw(&b, RC_RAW_I32, NX);
    add_raw(&b, RC_RAW_I32, NY);
    add_raw(&b, RC_RAW_I32, (double)width);
    add_raw(&b, RC_RAW_I32, (double)(NX * width + padding));
    if (width == 4)
        add_map(&b, RC_RAW_I32, ROWS, 50, padding);
    for (size_t k = 0; width == 1 && k < NX * NY; k++) {
        static const unsigned char marks[] = {0, 1, 2, 0x80, 0, 0};

        add_raw(&b, RC_RAW_U8, marks[k]);
        if (k % NX == NX - 1)
            add_zeros(&b, padding);
    }
    return b;
}

/* A zstd frame in one uncompressed block, with or without its size before it (RFC 8878). */
static struct bytes
frame(const void *bytes, size_t n, bool sized)
{
    struct bytes b = {0};

    add(&b, "\x28\xb5\x2f\xfd", 4);
    add_raw(&b, RC_RAW_U8, sized ? 0xa0 : 0);
    if (sized)
        add_raw(&b, RC_RAW_U32, (double)n);
    else
        add_raw(&b, RC_RAW_U8, 0x50); /* the window */
    add_number(&b, (uint64_t)n << 3 | 1, 3);
    add(&b, bytes, n);
    return b;
}

/* The file of zon_file in this variant (KPK0 or KPK1), with the first `frames` members compressed. */
static struct bytes
packed_file(const char *kind, const struct bytes *heights, const struct bytes *marks, int frames,
            bool sized)
{
    struct member members[] = {
        {"686613b8-27b5-4a29-8ffc-438c2780873e", calibration, strlen(calibration)},
        {"cbc1d39b-215f-4d56-a20e-cf8e5f570755", device, strlen(device)},
        {"1d35862b-3b48-4df2-9235-833ef590b043", scan, strlen(scan)},
        {"4cdb0c75-5706-48cc-a9a1-adf395d609ae", heights->data, heights->n},
        {"9e7ca6dd-0e6a-4d7b-8986-f0a7b773c916", marks->data, marks->n},
    };
    struct bytes b = {0}, zip, part[5];

    for (int k = 0; k < frames; k++) {
        part[k] = frame(members[k].bytes, members[k].n, sized);
        members[k].bytes = part[k].data;
        members[k].n = part[k].n;
    }
    zip = archive(members, 5);
    add_text(&b, kind);
    add_raw(&b, RC_RAW_U32, 2);
    add_text(&b, "BM");
    add(&b, zip.data, zip.n);
    drop(&zip);
    for (int k = 0; k < frames; k++)
        drop(&part[k]);
    return b;
}

static struct bytes
zon_file(const char *xml, const struct bytes *heights, const struct bytes *marks)
{
    const struct member members[] = {
        {"686613b8-27b5-4a29-8ffc-438c2780873e", xml, strlen(xml)},
        {"cbc1d39b-215f-4d56-a20e-cf8e5f570755", device, strlen(device)},
        {"1d35862b-3b48-4df2-9235-833ef590b043", scan, strlen(scan)},
        {"4cdb0c75-5706-48cc-a9a1-adf395d609ae", heights->data, heights->n},
        {"9e7ca6dd-0e6a-4d7b-8986-f0a7b773c916", marks == NULL ? NULL : marks->data,
         marks == NULL ? 0 : marks->n},
    };
    struct bytes b = {0}, zip = archive(members, marks == NULL ? 4 : 5);

    add_text(&b, "KPK0");
    add_raw(&b, RC_RAW_U32, 15);
    add_text(&b, "BM and a pictur");
    add(&b, zip.data, zip.n);
    drop(&zip);
    return b;
}

static void
zon_is_read(void **state)
{
    struct bytes heights = array(4, 4), marks = array(1, 5), b;
    struct rc_file file;
    struct rc_grid *g;
    double v[NX * NY];

    (void)state;
    for (int marked = 0; marked < 2; marked++) {
        for (size_t k = 0; k < NX * NY; k++)
            v[k] = marked && (k == 1 || k == 2) ? NAN : value_of(k, true) * 1e-10;
        b = zon_file(calibration, &heights, marked ? &marks : NULL);
        file = file_of(&b, "noname");
        assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_zon);
        g = read_well(&rc_format_zon, &b, 0);
        check_map(g, NX, NY, 1.1e-6, 1.1e-6, v);
        assert_string_equal(rc_grid_get(g, "file.model"), "VR-3200");
        assert_string_equal(rc_grid_get(g, "file.serial"), "#1");
        assert_string_equal(rc_grid_get(g, "file.date"), "2024-02-29T10:00:00");
        rc_grid_free(g);
        drop(&b);
    }
    drop(&heights);
    drop(&marks);
}

static void
packed_by_zstd(void **state)
{
    struct bytes heights = array(4, 4), marks = array(1, 5), b;
    double v[NX * NY];

    (void)state;
    for (size_t k = 0; k < NX * NY; k++)
        v[k] = k == 1 || k == 2 ? NAN : value_of(k, true) * 1e-10;
    for (int sized = 0; sized < 2; sized++) {
        b = packed_file("KPK1", &heights, &marks, 5, sized);
        if (rc_zstd_is_there()) {
            struct rc_grid *g = read_well(&rc_format_zon, &b, 0);

            check_map(g, NX, NY, 1.1e-6, 1.1e-6, v);
            rc_grid_free(g);
            refuse_cuts(&rc_format_zon, &b, b.n, 7);
            survive_changes(&rc_format_zon, &b, 1000);
        } else
            refuse(&rc_format_zon, &b, "this program was built without zstd");
        drop(&b);
    }
    for (int frames = 0; frames <= 5 && rc_zstd_is_there(); frames++) {
        struct rc_grid *g;

        b = packed_file(frames % 2 == 0 ? "KPK0" : "KPK1", &heights, &marks, frames, false);
        g = read_well(&rc_format_zon, &b, 0);
        check_map(g, NX, NY, 1.1e-6, 1.1e-6, v);
        rc_grid_free(g);
        drop(&b);
    }
    drop(&heights);
    drop(&marks);
}

/* Frames that announce too many bytes, end early, or are not zstd frames. */
static void
frames_that_lie(void **state)
{
    struct bytes b = frame("abcdefgh", 8, true);
    unsigned char *bytes;
    struct rc_err err;
    size_t n;

    (void)state;
    if (!rc_zstd_is_there())
        skip();
    bytes = rc_zstd_unpack("letters", b.data, b.n, 8, &n, &err);
    assert_non_null(bytes);
    assert_int_equal(n, 8);
    assert_memory_equal(bytes, "abcdefgh", 9);
    free(bytes);
    assert_null(rc_zstd_unpack("letters", b.data, b.n, 7, &n, &err));
    assert_non_null(strstr(err.text, "more bytes than can be"));
    assert_null(rc_zstd_unpack("letters", b.data, b.n - 1, 8, &n, &err));
    assert_non_null(strstr(err.text, "cut off"));
    assert_null(rc_zstd_unpack("letters", b.data + 1, b.n - 1, 8, &n, &err));
    drop(&b);
    b = frame("abcdefgh", 8, false);
    assert_null(rc_zstd_unpack("letters", b.data, b.n, 7, &n, &err));
    drop(&b);
}

static void
zon_is_refused(void **state)
{
    struct bytes heights = array(4, 0), marks = array(1, 0), b;
    char *xml = with(calibration, "MeterPerPixel>1.1E-06", "MeterPerPixel>wide");

    (void)state;
    b = zon_file(xml, &heights, NULL);
    refuse(&rc_format_zon, &b, "'wide'");
    drop(&b);
    free(xml);
    b = zon_file("<a/>", &heights, NULL);
    refuse(&rc_format_zon, &b, "does not give the spacing");
    b.data[3] = '2';
    refuse(&rc_format_zon, &b, "not a ZON file");
    b.data[3] = '0';
    set_raw(&b, 4, RC_RAW_U32, 1e9);
    refuse(&rc_format_zon, &b, "the picture takes 1000000000 bytes");
    drop(&b);
    set_raw(&marks, 4, RC_RAW_I32, 1);
    b = zon_file(calibration, &heights, &marks);
    refuse(&rc_format_zon, &b, "do not belong together");
    drop(&b);
    b = zon_file(calibration, &marks, NULL);
    refuse(&rc_format_zon, &b, "elements of 1 bytes");
    drop(&b);
    set_raw(&heights, 0, RC_RAW_I32, 1e8);
    b = zon_file(calibration, &heights, NULL);
    refuse(&rc_format_zon, &b, "promises 100000000 x 2 elements");
    drop(&b);
    drop(&heights);
    drop(&marks);
}

static void
cuts_and_changes(void **state)
{
    struct bytes heights = array(4, 4), marks = array(1, 5);
    struct bytes b = zon_file(calibration, &heights, &marks);

    (void)state;
    refuse_cuts(&rc_format_zon, &b, b.n, 1);
    survive_changes(&rc_format_zon, &b, 3000);
    drop(&b);
    drop(&heights);
    drop(&marks);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zon_is_read),      cmocka_unit_test(packed_by_zstd),
        cmocka_unit_test(frames_that_lie),  cmocka_unit_test(zon_is_refused),
        cmocka_unit_test(cuts_and_changes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
