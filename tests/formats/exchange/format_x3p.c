/* SPDX-License-Identifier: GPL-3.0-or-later */
/* X3P files are tested with their types, missing points, positions and checksums. */
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

/* Six numbers in each type, as explicit bytes and as text; with increment 1/4 and offset -2 every height is
 * exact. */
static const struct {
    const char *type;
    unsigned char bytes[48];
    size_t n;
    const char *list;
    double height[6];
} types[] = {
    {"I",
     {0x00, 0x80, 0xff, 0x7f, 0xff, 0xff, 0x00, 0x00, 0x01, 0x00, 0x2c, 0x01},
     12,
     "<Datum>-32768</Datum><Datum>32767</Datum><Datum>-1</Datum><Datum>0</Datum><Datum>1</Datum>"
     "<Datum>300</Datum>",
     {-8194, 8189.75, -2.25, -2, -1.75, 73}},
    {"L",
     {0x00, 0x00, 0x00, 0x80, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0xff,
      0x00, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x70, 0x11, 0x01, 0x00},
     24,
     "<Datum>-2147483648</Datum><Datum>2147483647</Datum><Datum>-1</Datum><Datum>0</Datum>"
     "<Datum>1</Datum><Datum>70000</Datum>",
     {-536870914.0, 536870909.75, -2.25, -2, -1.75, 17498}},
    {"F", /* 1, -1, 0.5, NaN, 0, 6 */
     {0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x80, 0xbf, 0x00, 0x00, 0x00, 0x3f,
      0x00, 0x00, 0xc0, 0x7f, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xc0, 0x40},
     24,
     "<Datum>1</Datum><Datum>-1.0</Datum><Datum>5e-1</Datum><Datum/><Datum>0</Datum>"
     "<Datum> 6 </Datum>",
     {-1.75, -2.25, -1.875, NAN, -2, -0.5}},
    {"D",
     {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xf0, 0x3f, 0x00, 0x00, 0x00, 0x00,
      0x00, 0x00, 0xf0, 0xbf, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xe0, 0x3f,
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xf8, 0x7f, 0x00, 0x00, 0x00, 0x00,
      0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x18, 0x40},
     48,
     "<Datum>1.0E+0000</Datum><Datum>-1</Datum><Datum>.5</Datum><Datum></Datum>"
     "<Datum>0</Datum><Datum>6</Datum>",
     {-1.75, -2.25, -1.875, NAN, -2, -0.5}},
};

static void
check_heights(const struct rc_grid *g, const double *height)
{
    assert_int_equal(g->nx, 3);
    assert_int_equal(g->ny, 2);
    assert_true(g->dx == 1.1e-6 && g->dy == 1.29e-6);
    assert_string_equal(g->channel, "height");
    assert_string_equal(g->unit, "m");
    for (size_t k = 0; k < 6; k++)
        if (isnan(height[k]) ? !isnan(g->v[k]) : g->v[k] != height[k])
            fail_msg("height %zu is %.17g, not %.17g", k, g->v[k], height[k]);
}

static void
all_types_as_bytes_and_as_text(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof types / sizeof *types; k++) {
        char *binary = binary_xml(types[k].type, ""),
             *list = with(main_xml, "@TYPE@", types[k].type);
        char data[600];
        struct rc_file file = pack(binary, types[k].bytes, types[k].n);
        struct rc_notes notes;
        struct rc_grid *g = read_file(&file, &notes);

        assert_int_equal(notes.n, 0);
        check_heights(g, types[k].height);
        rc_grid_free(g);
        drop_file(&file);
        snprintf(data, sizeof data, "<DataList>%s</DataList>", types[k].list);
        alter(&list, "@DATA@", data);
        file = pack(list, NULL, 0);
        g = read_file(&file, &notes);
        assert_int_equal(notes.n, 0);
        check_heights(g, types[k].height);
        rc_grid_free(g);
        drop_file(&file);
        free(binary);
        free(list);
    }
}

static void
increment_and_offset_default(void **state)
{
    static const char *const absent[] = {"", "<Increment/><Offset/>",
                                         "<Increment> </Increment><Offset></Offset>"};

    (void)state;
    for (size_t k = 0; k < sizeof absent / sizeof *absent; k++) {
        char *xml = binary_xml("D", "");
        struct rc_notes notes;
        struct rc_file file;
        struct rc_grid *g;

        alter(&xml, "<Increment>0.25</Increment><Offset>-2</Offset>", absent[k]);
        file = pack(xml, plain_bytes, sizeof plain_bytes);
        g = read_file(&file, &notes);
        check_heights(g, plain_heights);
        rc_grid_free(g);
        drop_file(&file);
        free(xml);
    }
}

/* Points 1 and 5 are missing: bits 1 and 5 of the first byte, counted from the lowest, are 0. */
static const unsigned char mask[1] = {0x1d};
static const double masked[6] = {-1.75, NAN, -1.25, -1, -0.75, NAN};

static struct rc_file
masked_file(const char *more, const void *bits, size_t n)
{
    char *xml = binary_xml("D", more);
    struct member member[] = {{"main.xml", xml, strlen(xml)},
                              {"bindata/data.bin", plain_bytes, sizeof plain_bytes},
                              {"bindata/valid.bin", bits, n}};
    struct rc_file file = archive_file(member, 3);

    free(xml);
    return file;
}

static void
valid_points(void **state)
{
    static const char link[] = "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>";
    static const unsigned char long_mask[9] = {0x1d};
    char more[200], md5[RC_MD5_TEXT];
    struct rc_notes notes;
    struct rc_file file;
    struct rc_grid *g;

    (void)state;
    for (size_t n = 1; n <= 8; n += 7) {
        file = masked_file(link, n == 1 ? mask : long_mask, n);
        g = read_file(&file, &notes);
        check_heights(g, masked);
        rc_grid_free(g);
        drop_file(&file);
    }
    file = masked_file(link, long_mask, 9);
    refuse_file(&file, "promises 1 bytes of valid points, the file has 9");
    drop_file(&file);
    file = masked_file(link, "", 0);
    refuse_file(&file, "promises 1 bytes of valid points, the file has 0");
    drop_file(&file);
    rc_md5_of(mask, 1, md5);
    snprintf(more, sizeof more, "%s<MD5ChecksumValidPoints>%s</MD5ChecksumValidPoints>", link, md5);
    file = masked_file(more, mask, 1);
    rc_grid_free(read_file(&file, &notes));
    drop_file(&file);
    file = masked_file(more, long_mask + 1, 1);
    refuse_file(&file, md5);
    drop_file(&file);
}

/* These checksums were computed by md5sum(1). */
static const char plain_md5[] = "50DA13748603A71B2A148AB7B8EE9DC2"; /* MD5 of the bytes of 1.0 to
                                                                       6.0 */
static const char main_md5[] = "a6dfd3c456eb1c49b3391fa8dc64551d";  /* MD5 of main.xml around
                                                                       them */

static void
checksums(void **state)
{
    static const char good[] = "<MD5ChecksumPointData>@MD5@</MD5ChecksumPointData>";
    char *more = with(good, "@MD5@", plain_md5), *xml = binary_xml("D", more);
    struct rc_notes notes;
    struct rc_file file;
    struct rc_grid *g;

    (void)state;
    file = pack(xml, plain_bytes, sizeof plain_bytes);
    g = read_file(&file, &notes);
    assert_int_equal(notes.n, 0);
    rc_grid_free(g);
    drop_file(&file);
    alter(&xml, plain_md5, "00112233445566778899aabbccddeeff");
    refuse_xml(xml, "main.xml says 00112233445566778899aabbccddeeff");
    refuse_xml(xml, "their MD5 sum is 50da13748603a71b2a148ab7b8ee9dc2");
    alter(&xml, "00112233445566778899aabbccddeeff", "not available");
    file = pack(xml, plain_bytes, sizeof plain_bytes);
    g = read_file(&file, &notes);
    assert_true(noted(&notes, "'not available' is no MD5 sum"));
    rc_grid_free(g);
    drop_file(&file);
    free(more);
    free(xml);
}

/* 480,000 bytes, the doubles 0 to 59999: more than the reader unpacks at a time. */
static void
checksum_over_several_chunks(void **state)
{
    enum {
        N = 60000
    };
    static const char md5[] = "11ee837700c35fe3b2369d627b2e9d34";
    static double v[N];
    char more[100], *xml;
    struct rc_notes notes;
    struct rc_file file;

    (void)state;
    for (size_t k = 0; k < N; k++)
        v[k] = (double)k;
    snprintf(more, sizeof more, "<MD5ChecksumPointData>%s</MD5ChecksumPointData>", md5);
    xml = binary_xml("D", more);
    alter(&xml, "<SizeX>3</SizeX><SizeY>2", "<SizeX>300</SizeX><SizeY>200");
    file = pack_doubles(xml, v, N);
    rc_grid_free(read_file(&file, &notes));
    drop_file(&file);
    v[N - 1] = 0;
    file = pack_doubles(xml, v, N);
    refuse_file(&file, "main.xml says 11ee837700c35fe3b2369d627b2e9d34");
    drop_file(&file);
    free(xml);
}

static void
checksum_of_main_is_only_noted(void **state)
{
    char *xml = binary_xml("D", "");
    static const struct {
        const char *file, *note;
    } cases[] = {
        {main_md5, NULL},
        {"00112233445566778899aabbccddeeff *main.xml\n", "says 00112233445566778899aabbccddeeff"},
        {"00112233445566778899aabbccddeeff *main.xml\n", main_md5},
        {"what?\n", "has no MD5 sum"},
        {"", "has no MD5 sum"},
        {NULL, "has no md5checksum.hex"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct member member[] = {
            {"main.xml", xml, strlen(xml)},
            {"bindata/data.bin", plain_bytes, sizeof plain_bytes},
            {"md5checksum.hex", cases[k].file, cases[k].file == NULL ? 0 : strlen(cases[k].file)}};
        struct rc_file file = archive_file(member, cases[k].file == NULL ? 2 : 3);
        struct rc_notes notes;
        struct rc_grid *g = read_file(&file, &notes);

        assert_int_equal(notes.n, cases[k].note != NULL);
        assert_true(cases[k].note == NULL || noted(&notes, cases[k].note));
        rc_grid_free(g);
        drop_file(&file);
    }
    free(xml);
}

static void
members_under_one_folder(void **state)
{
    char *xml = binary_xml("D", "");
    struct member member[] = {{"__MACOSX/main.xml", "junk", 4},
                              {"some folder/main.xml", xml, strlen(xml)},
                              {"some folder/bindata/data.bin", plain_bytes, sizeof plain_bytes}};
    struct rc_notes notes;
    struct rc_file file;

    (void)state;
    file = archive_file(member, 3);
    assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_x3p);
    rc_grid_free(read_file(&file, &notes));
    drop_file(&file);
    alter(&xml, "bindata/data.bin", "./bindata\\data.bin");
    member[1] = (struct member){"some folder/main.xml", xml, strlen(xml)};
    file = archive_file(member, 3);
    rc_grid_free(read_file(&file, &notes));
    drop_file(&file);
    file = archive_file(member, 1);
    refuse_file(&file, "it has no main.xml");
    drop_file(&file);
    free(xml);
}

static void
words_become_keys(void **state)
{
    struct rc_file file = plain_file();
    struct rc_notes notes;
    struct rc_grid *g = read_file(&file, &notes);
    char *xml, comment[5000];

    (void)state;
    assert_string_equal(rc_grid_get(g, "file.creator"), "A. \xc3\x85ngstr\xc3\xb6m");
    assert_string_equal(rc_grid_get(g, "file.date"), "2024-02-29");
    assert_string_equal(rc_grid_get(g, "file.manufacturer"), "M");
    assert_string_equal(rc_grid_get(g, "file.model"), "\xc2\xb5X");
    assert_string_equal(rc_grid_get(g, "file.serial"), "7");
    assert_string_equal(rc_grid_get(g, "file.probe-type"), "NonContacting");
    assert_string_equal(rc_grid_get(g, "file.probe"), "20x");
    assert_string_equal(rc_grid_get(g, "file.comment"), "a <b> \xce\xbc");
    assert_null(rc_grid_get(g, "file.calibrated"));
    rc_grid_free(g);
    drop_file(&file);
    /* another encoding, control characters, and a text that is too long for a header */
    xml = binary_xml("D", "");
    alter(&xml, "UTF-8", "ISO-8859-1");
    alter(&xml, "A. \xc3\x85ngstr\xc3\xb6m", "\xc5ngstr\xf6m");
    memset(comment, '\xb5', sizeof comment - 1);
    comment[sizeof comment - 1] = '\0';
    comment[0] = 'a';
    comment[1] = '\n';
    alter(&xml, "a &lt;b&gt; &#x3bc;", comment);
    file = pack(xml, plain_bytes, sizeof plain_bytes);
    g = read_file(&file, &notes);
    assert_string_equal(rc_grid_get(g, "file.creator"), "\xc3\x85ngstr\xc3\xb6m");
    assert_memory_equal(rc_grid_get(g, "file.comment"), "a \xc2\xb5", 4);
    assert_true(strlen(rc_grid_get(g, "file.comment")) < 4096);
    assert_true(rc_utf8_valid(rc_grid_get(g, "file.comment")));
    rc_grid_free(g);
    drop_file(&file);
    free(xml);
}

static void
profiles(void **state)
{
    char *xml = binary_xml("D", "");
    struct rc_notes notes;
    struct rc_file file;
    struct rc_grid *g;

    (void)state;
    alter(&xml, "SUR", "PRF");
    refuse_xml(xml, "SizeY must be 1");
    alter(&xml, "<SizeX>3", "<SizeX>6");
    alter(&xml, "<SizeY>2", "<SizeY>1");
    alter(&xml, "<Increment>1.29e-6</Increment>", "");
    file = pack(xml, plain_bytes, sizeof plain_bytes);
    g = read_file(&file, &notes);
    assert_int_equal(g->nx, 6);
    assert_int_equal(g->ny, 1);
    assert_true(g->dx == 1.1e-6 && g->dy == 1.1e-6);
    rc_grid_free(g);
    drop_file(&file);
    free(xml);
}

/* A map of the six heights whose points have x (32 bits, nm), y (floats, um) or both; falling positions start
 * at the far end. The last position is wrong by `off`. */
static struct rc_file
placed_map(bool has_x, bool has_y, bool falls, double off)
{
    char *xml = binary_xml("D", "");
    struct bytes b = {0};
    struct rc_file file;

    if (has_x)
        alter(&xml, "<CX><AxisType>I</AxisType><DataType>D</DataType><Increment>1.1e-6",
              "<CX><AxisType>A</AxisType><DataType>L</DataType><Increment>1e-9");
    if (has_y)
        alter(&xml, "<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>1.29e-6",
              "<CY><AxisType>A</AxisType><DataType>F</DataType><Increment>1e-6");
    for (size_t k = 0; k < 6; k++) {
        size_t i = falls ? 2 - k % 3 : k % 3, j = falls ? 1 - k / 3 : k / 3;

        if (has_x)
            add_raw(&b, RC_RAW_I32, 5000 + 1100 * (double)i + (k == 5 ? off : 0));
        if (has_y)
            add_f32(&b, -2 + 1.29 * (double)j);
        add_f64(&b, plain_heights[j * 3 + i]);
    }
    file = pack(xml, b.data, b.n);
    drop(&b);
    free(xml);
    return file;
}

static void
maps_with_positions(void **state)
{
    static const struct {
        bool x, y, falls;
    } ways[] = {
        {true, false, false}, {false, true, false}, {true, true, false}, {true, true, true}};
    struct rc_notes notes;

    (void)state;
    for (size_t way = 0; way < sizeof ways / sizeof *ways; way++) {
        struct rc_file file = placed_map(ways[way].x, ways[way].y, ways[way].falls, 0);
        struct rc_channel channel;
        struct rc_grid *g;

        assert_int_equal(list_maps(&rc_format_x3p, &file, &rc_no_wish, &channel, 1, NULL), 1);
        g = read_file(&file, &notes);
        assert_true(fabs(g->dx - 1.1e-6) <= last_digit * 1.1e-6 && channel.dx == g->dx);
        assert_true(fabs(g->dy - 1.29e-6) <= 2 * float_rounding * 2e-6 && channel.dy == g->dy);
        for (size_t k = 0; k < 6; k++)
            assert_true(g->v[k] == 0.25 * plain_heights[k] - 2);
        rc_grid_free(g);
        drop_file(&file);
    }
}

static void
positions_off_a_grid(void **state)
{
    static const struct {
        double off;
        const char *why;
    } cases[] = {{300, "the places of axis CX do not form a grid: point 6"}, {20, NULL}};

    (void)state;
    for (size_t k = 0; k < 2; k++) {
        struct rc_file file = placed_map(true, true, false, cases[k].off);

        if (cases[k].why != NULL)
            refuse_file(&file, cases[k].why);
        else {
            struct rc_notes notes;
            struct rc_grid *g = read_file(&file, &notes);

            rc_grid_free(g);
        }
        drop_file(&file);
    }
}

/* main.xml of a profile of 5 points with x, or x and y, of each point; x in nanometres. */
static char *
profile_xml(const char *data, const char *y_axis)
{
    char *xml = with(main_xml, "@DATA@", data);

    alter(&xml, "@TYPE@", "D");
    alter(&xml, "SUR", "PRF");
    alter(&xml,
          "<CX><AxisType>I</AxisType><DataType>D</DataType><Increment>1.1e-6</Increment>"
          "<Offset>0</Offset>",
          "<CX><AxisType>A</AxisType><DataType>L</DataType><Increment>1e-9</Increment>"
          "<Offset>7e-3</Offset>");
    alter(&xml, "<CY><AxisType>I</AxisType><DataType>D</DataType>", y_axis);
    alter(&xml, "<SizeX>3</SizeX><SizeY>2</SizeY>", "<SizeX>5</SizeX><SizeY>1</SizeY>");
    return xml;
}

/* Heights 1, 2, 3, 5, 6 at 0, 1, 2, 4 and 5 um lie on a straight line. Resampled at even nodes they stay on
 * it. */
static void
check_resampled(char *xml, const struct bytes *data)
{
    static const struct rc_wish even = {.dx = NAN, .dy = NAN, .z_unit = NAN, .even = true};
    struct rc_file file = pack(xml, data->data, data->n);
    struct rc_notes notes;
    struct rc_err err;
    struct rc_grid *g;

    refuse_file(&file, "the positions are not evenly spaced: point 3");
    refuse_file(&file, "--even resamples the profile to even steps");
    g = read_with(&file, &even, &notes, &err);
    if (g == NULL)
        fail_msg("refused: %s", err.text);
    assert_int_equal(g->nx, 6);
    assert_int_equal(g->ny, 1);
    assert_true(fabs(g->dx - 1e-6) <= rounding * 7e-3 &&
                g->dy == g->dx); /* equal to the rounding of 7 mm + 1 um */
    for (size_t k = 0; k < 6; k++)
        assert_true(fabs(g->v[k] - (-1.75 + 0.25 * (double)k)) <= rounding * 7e-3 / 1e-6);
    rc_grid_free(g);
    drop_file(&file);
    free(xml);
}

static void
profiles_with_positions(void **state)
{
    static const double x[5] = {0, 1000, 2000, 4000, 5000}, z[5] = {1, 2, 3, 5, 6};
    static const char incremental[] = "<CY><AxisType>I</AxisType><DataType>D</DataType>",
                      absolute[] = "<CY><AxisType>A</AxisType><DataType>I</DataType>";
    struct bytes none = {0}, two = {0}, three = {0}, falling = {0};
    char link[200];

    (void)state;
    for (size_t k = 0; k < 5; k++) {
        add_number(&two, (uint64_t)x[k], 4);
        add_f64(&two, z[k]);
        add_number(&three, (uint64_t)x[k], 4);
        add_number(&three, 17, 2);
        add_f64(&three, z[k]);
        add_number(&falling, (uint64_t)x[4 - k], 4);
        add_f64(&falling, z[4 - k]);
    }
    check_resampled(profile_xml("<DataList><Datum>0;1</Datum><Datum>1000;2</Datum><Datum>2000;3"
                                "</Datum><Datum>4000;5</Datum><Datum>5000;6</Datum></DataList>",
                                incremental),
                    &none);
    check_resampled(
        profile_xml("<DataList><Datum>5000;0;6</Datum><Datum>4000;0;5</Datum><Datum>2000"
                    ";0;3</Datum><Datum>1000;;2</Datum><Datum>0;0;1</Datum></DataList>",
                    absolute),
        &none);
    snprintf(link, sizeof link, "%s", binary_link);
    *strstr(link, "@MORE@") = '\0';
    strcat(link, "</DataLink>");
    check_resampled(profile_xml(link, incremental), &two);
    check_resampled(profile_xml(link, absolute), &three);
    check_resampled(profile_xml(link, incremental), &falling);
    drop(&two);
    drop(&three);
    drop(&falling);
}

static void
positions_that_are_refused(void **state)
{
    static const struct {
        const char *list, *why;
    } wrong[] = {
        {"<Datum>0;1</Datum><Datum>2;1</Datum><Datum>1;1</Datum><Datum>3;1</Datum><Datum>4;1</"
         "Datum>",
         "the positions change direction at point 3"},
        {"<Datum>0;1</Datum><Datum>0;1</Datum><Datum>1;1</Datum><Datum>3;1</Datum><Datum>4;1</"
         "Datum>",
         "the positions change direction at point 2"},
        {"<Datum>0;1</Datum><Datum/>", "Datum 2 is '': x;z are expected"},
        {"<Datum>0;1;2</Datum>", "Datum 1 is '0;1;2': x;z are expected"},
        {"<Datum>5</Datum>", "Datum 1 is '5': x;z are expected"},
        {"<Datum>inf;1</Datum>", "Datum 1 is 'inf;1': x;z are expected"},
        {"<Datum>0;1</Datum>", "main.xml lists 1"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char data[400], *xml;

        snprintf(data, sizeof data, "<DataList>%s</DataList>", wrong[k].list);
        xml = profile_xml(data, "<CY><AxisType>I</AxisType><DataType>D</DataType>");
        refuse_xml(xml, wrong[k].why);
        free(xml);
    }
}

/* The positions are numbers of both lengths, a datum, and multiples of the increment. */
static void
infinite_heights_are_missing(void **state)
{
    static const unsigned char floats[24] = {0,    0, 0x80, 0x3f, 0, 0, 0x80, 0x7f,
                                             0,    0, 0x40, 0x40, 0, 0, 0x80, 0xff,
                                             0xff, 0, 0xc0, 0x7f, 0, 0, 0xc0, 0x40};
    const double doubles[6] = {1, INFINITY, 3, -INFINITY, NAN, 6}, wide[6] = {1, 8, 3, -8, NAN, 6};
    static const char data[] = "<DataList><Datum>1</Datum><Datum>inf</Datum><Datum>3</Datum>"
                               "<Datum>-INF</Datum><Datum/><Datum>6</Datum></DataList>";
    const double height[6] = {-1.75, NAN, -1.25, NAN, NAN, -0.5};

    (void)state;
    for (int k = 0; k < 4; k++) {
        char *xml = k == 1 ? with(main_xml, "@DATA@", data) : binary_xml(k == 2 ? "F" : "D", "");
        struct rc_notes notes;
        struct rc_file file;
        struct rc_grid *g;

        if (k == 1)
            alter(&xml, "@TYPE@", "D");
        if (k == 3)
            alter(&xml, "<Increment>0.25", "<Increment>2.5e307");
        file = k == 1   ? pack(xml, NULL, 0)
               : k == 2 ? pack(xml, floats, sizeof floats)
                        : pack_doubles(xml, k == 3 ? wide : doubles, 6);
        g = read_file(&file, &notes);
        if (k < 3)
            check_heights(g, height);
        for (size_t i = 0; i < 6; i++)
            assert_int_equal(isnan(g->v[i]), isnan(height[i]));
        assert_int_equal(notes.n, 1);
        assert_string_equal(notes.text[0], "2 of 6 values are infinite and read as missing, the "
                                           "first at column 1, row 0 (from 0)");
        rc_grid_free(g);
        drop_file(&file);
        free(xml);
    }
}

static void
root_without_its_part(void **state)
{
    char *xml = binary_xml("D", "");
    struct rc_notes notes;
    struct rc_file file;
    struct rc_grid *g;

    (void)state;
    alter(&xml, "<p:ISO5436_2 ", "<p:ISO5436 ");
    refuse_xml(xml, "not well-formed XML");
    alter(&xml, "</p:ISO5436_2>", "</p:ISO5436>");
    file = pack(xml, plain_bytes, sizeof plain_bytes);
    g = read_file(&file, &notes);
    check_heights(g, (const double[6]){-1.75, -1.5, -1.25, -1, -0.75, -0.5});
    assert_int_equal(notes.n, 1);
    assert_true(
        noted(&notes, "the root of its main.xml is ISO5436, where the standard has ISO5436_2"));
    rc_grid_free(g);
    drop_file(&file);
    alter(&xml, "<p:ISO5436 ", "<p:ISO54 ");
    alter(&xml, "</p:ISO5436>", "</p:ISO54>");
    refuse_xml(xml, "the root of its main.xml is 'ISO54', not ISO5436_2");
    free(xml);
}

static void
rotation_is_noted(void **state)
{
    static const char *const matrices[] = {
        "</CZ><Rotation><r11>1.0</r11><r12>0</r12><r22>1</r22></Rotation>",
        "</CZ><Rotation><r11>-1</r11><r22>-1</r22><r33>1</r33></Rotation>"};

    (void)state;
    for (size_t k = 0; k < 2; k++) {
        char *xml = binary_xml("D", "");
        struct rc_notes notes;
        struct rc_file file;

        alter(&xml, "</CZ>", matrices[k]);
        file = pack(xml, plain_bytes, sizeof plain_bytes);
        rc_grid_free(read_file(&file, &notes));
        assert_int_equal(noted(&notes, "rotation matrix"), k);
        drop_file(&file);
        free(xml);
    }
}

static void
wishes_win(void **state)
{
    struct rc_wish wish = {.dx = 2e-6, .dy = NAN, .z_unit = NAN};
    char *xml = binary_xml("D", "");
    struct rc_file file = pack(xml, plain_bytes, sizeof plain_bytes);
    struct rc_notes notes;
    struct rc_err err;
    struct rc_grid *g = read_with(&file, &wish, &notes, &err);

    (void)state;
    assert_non_null(g);
    assert_true(g->dx == 2e-6 && g->dy == 2e-6);
    assert_true(noted(&notes, "in x is 2e-06 m as given; the file says 1.1e-06 m"));
    rc_grid_free(g);
    wish = (struct rc_wish){.dx = NAN, .dy = 3e-6, .z_unit = 1e-6};
    g = read_with(&file, &wish, &notes, &err);
    assert_non_null(g);
    assert_true(g->dx == 1.1e-6 && g->dy == 3e-6);
    assert_true(fabs(g->v[5] - -0.5e-6) <= last_digit * 0.5e-6);
    assert_int_equal(notes.n, 2);
    rc_grid_free(g);
    drop_file(&file);
    alter(&xml, "<Increment>1.1e-6</Increment>", "");
    file = pack(xml, plain_bytes, sizeof plain_bytes);
    refuse_file(&file, "the spacing in x: --dx LENGTH says it");
    wish = (struct rc_wish){.dx = 2e-6, .dy = 1.29e-6, .z_unit = NAN};
    g = read_with(&file, &wish, &notes, &err);
    assert_non_null(g);
    assert_int_equal(notes.n, 0);
    rc_grid_free(g);
    drop_file(&file);
    free(xml);
}

static void
list_tells_size_and_spacing(void **state)
{
    struct rc_file file = plain_file();
    struct rc_channel channel;
    struct rc_err err;

    (void)state;
    assert_int_equal(list_maps(&rc_format_x3p, &file, &rc_no_wish, &channel, 1, &err), 1);
    assert_int_equal(channel.nx, 3);
    assert_int_equal(channel.ny, 2);
    assert_true(channel.dx == 1.1e-6 && channel.dy == 1.29e-6);
    assert_string_equal(channel.unit, "m");
    drop_file(&file);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_locale_has_a_comma), /* and the others run under it */
        cmocka_unit_test(all_types_as_bytes_and_as_text),
        cmocka_unit_test(increment_and_offset_default),
        cmocka_unit_test(valid_points),
        cmocka_unit_test(checksums),
        cmocka_unit_test(checksum_over_several_chunks),
        cmocka_unit_test(checksum_of_main_is_only_noted),
        cmocka_unit_test(members_under_one_folder),
        cmocka_unit_test(words_become_keys),
        cmocka_unit_test(profiles),
        cmocka_unit_test(profiles_with_positions),
        cmocka_unit_test(maps_with_positions),
        cmocka_unit_test(positions_off_a_grid),
        cmocka_unit_test(positions_that_are_refused),
        cmocka_unit_test(infinite_heights_are_missing),
        cmocka_unit_test(root_without_its_part),
        cmocka_unit_test(rotation_is_noted),
        cmocka_unit_test(wishes_win),
        cmocka_unit_test(list_tells_size_and_spacing),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
