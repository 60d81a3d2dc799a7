/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text matrices give the same map in every notation; other text is refused with the number of the line. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "formats/format.h"
#include "made/made.h"

extern const struct rc_format rc_format_ascii;

/* options for files without a header */
static const struct rc_wish plain_wish = {.dx = 1.1e-6, .dy = 1.29e-6, .z_unit = 1};

/* The bytes lie at the end of a block of memory, so that the sanitizer sees a read beyond them. */
static struct rc_grid *
read_bytes(const char *text, size_t n, const struct rc_wish *wish, struct rc_notes *notes,
           struct rc_err *err)
{
    unsigned char *copy = malloc(n == 0 ? 1 : n);
    struct rc_file file = {.name = "made.txt", .data = copy, .size = n};
    struct rc_channel channel;
    struct rc_grid *g;

    memcpy(copy, text, n);
    *notes = (struct rc_notes){0};
    err->text[0] = '\0';
    rc_format_find(&file, NULL);
    list_maps(&rc_format_ascii, &file, wish, &channel, 1, NULL);
    g = read_map(&rc_format_ascii, &file, wish, 0, notes, err);
    if (g == NULL && err->text[0] == '\0')
        fail_msg("refused without a reason");
    if (g != NULL)
        check_sound(text, g, n);
    free(copy);
    return g;
}

static struct rc_grid *
read_text(const char *text, const struct rc_wish *wish)
{
    struct rc_notes notes;
    struct rc_err err;
    struct rc_grid *g = read_bytes(text, strlen(text), wish, &notes, &err);

    if (g == NULL)
        fail_msg("'%s' is refused: %s", text, err.text);
    return g;
}

static void
refuse_text(const char *text, const struct rc_wish *wish, const char *why)
{
    struct rc_notes notes;
    struct rc_err err;
    struct rc_grid *g = read_bytes(text, strlen(text), wish, &notes, &err);

    if (g != NULL)
        fail_msg("'%s' is read, and should be refused for: %s", text, why);
    if (!gives_reason(err.text, why))
        fail_msg("'%s' is refused for '%s', not for '%s'", text, err.text, why);
}

static bool
is_near(double value, double truth)
{
    return isnan(truth) ? isnan(value) : fabs(value - truth) <= last_digit * fabs(truth);
}

static void
check(const char *text, const struct rc_grid *g, size_t nx, size_t ny, const double *height)
{
    if (g->nx != nx || g->ny != ny)
        fail_msg("'%s' is read as %zu x %zu", text, g->nx, g->ny);
    for (size_t k = 0; k < nx * ny; k++)
        if (!is_near(g->v[k], height[k]))
            fail_msg("'%s': height %zu is %.17g, not %.17g", text, k, g->v[k], height[k]);
}

/* ---- headers ---- */

static const double counts[6] = {1, -2, 3, 4.5, 5, 6};

static void
headers(void **state)
{
    static const struct {
        const char *text;
        double dx, dy, z;
        const char *channel;
    } cases[] = {
        {"# Channel: My heights\n# Width: 6 \xc2\xb5m\n# Height: 5000 nm\n# Value units: m\n@",
         2e-6, 2.5e-6, 1, "My heights"},
        {"# Channel: a\n# Width: 6 \xce\xbcm\n# Height: 5 \xb5m\n# Value units: nm\n@", 2e-6,
         2.5e-6, 1e-9, "a"},
        {"# Width: 0.03 mm\n# Height: 1e2 \xc3\x85\n# Value units: um\n@", 1e-5, 5e-9, 1e-6, NULL},
        /* German, in UTF-8 and Latin-1, with the decimal comma of its locale */
        {"# Kanal: H\xc3\xb6"
         "hen\n# Breite: 6,00 \xc2\xb5m\n# H\xc3\xb6he: 2,50 \xc2\xb5m\n"
         "# Werteinheiten: m\n@",
         2e-6, 1.25e-6, 1, "H\xc3\xb6hen"},
        {"# Kanal: H\xf6hen\n# Breite: 6,00 \xb5m\n# H\xf6he: 2,50 \xb5m\n# Werteinheiten: m\n@",
         2e-6, 1.25e-6, 1, "H\xc3\xb6hen"},
        /* Japanese, with wide colons */
        {"# \xe3\x83\x81\xe3\x83\xa3\xef\xbc\x9a Topo\n# \xe5\xb9\x85: 6 \xc2\xb5m\n"
         "# \xe9\xab\x98\xe3\x81\x95\xef\xbc\x9a 5 \xc2\xb5m\n# \xe5\x80\xa4: m\n@",
         2e-6, 2.5e-6, 1, "Topo"},
        {"\xef\xbb\xbf# Channel: with a byte order mark\n# Width: 3 m\n# Height: 2 m\n"
         "# Value units: m\n@",
         1, 1, 1, "with a byte order mark"},
        {"h=2 w=3\npixel size=3.69862e-007 m\ndata unit=rad\n"
         "height conversion factor (-> m)=2.91818e-008\n@",
         3.69862e-7, 3.69862e-7, 2.91818e-8, NULL},
        {"h=2 w=3\npixel size=1e-7 m\ndata unit=m\n@", 1e-7, 1e-7, 1, NULL},
        {"# File Format = ASCII\n# x-pixels = 3\n# y-pixels = 2\n# x-length = 600\n"
         "# y-length = 500\n# x-offset = 0\n# Bit2nm = 0.5\n# Start of Data:\n@",
         2e-7, 2.5e-7, 0.5e-9, NULL},
        {"\\*File list\n\\Version: 0x05120130\n\\*Ciao image list\n\\Scan Size: 6 5 um\n"
         "\\*File list end\n\\Exported image units: nm\n@",
         2e-6, 2.5e-6, 1e-9, NULL},
        /* lengths are in nanometres for any unit of the heights */
        {"# x-pixels = 3\n# y-pixels = 2\n# x-length = 600\n# y-length = 500\n# z-unit = um\n@",
         2e-7, 2.5e-7, 1e-6, NULL},
        {"# x-pixels = 3\n# y-pixels = 2\n# x-length = 6 um\n# y-length = 500 [nm]\n"
         "# z-unit = [nm]\n# Bit2nm = 2\n@",
         2e-6, 2.5e-7, 1e-9, NULL},
        /* Daisy of attocube, with the units in separate lines */
        {"# Daisy frame view snapshot\n# 2009-07-14T10:12:34\n# x-pixels: 3\n# y-pixels: 2\n"
         "# x-length: 6\n# y-length: 500\n# x-offset: 0\n# y-offset: 0\n# x-unit: um\n"
         "# y-unit: nm\n# z-unit: nm\n# scanspeed: 2\n# display: Topography\n# Start of Data:\n@",
         2e-6, 2.5e-7, 1e-9, "Topography"},
        {"# x-unit: um\n# x-length: 6\n# y-length: 5\n# z-unit: pm\n@", 2e-6, 2.5e-6, 1e-12, NULL},
        /* Nova of NT-MDT */
        {"File Format = ASCII\nCreated by Nova\nNX = 3\nNY = 2\nScale X = 0.5\nScale Y = 0.25\n"
         "Scale Data = 3\nBias X = 0\nUnit X = um\nUnit Y = um\nUnit Data = nm\n"
         "DataScaleNeeded = No\nStart of Data :\n@",
         5e-7, 2.5e-7, 1e-9, NULL},
        {"File Format = ASCII\nScale X = 0.5\nScale Y = 0.5\nUnit X = um\nUnit Data = nm\n"
         "Scale Data = 3\nDataScaleNeeded = Yes\nStart of Data :\n@",
         5e-7, 5e-7, 3e-9, NULL},
        {"WSxM file copyright Nanotec Electronica\r\nWSxM ASCII Matrix file\r\nX Amplitude: 6 "
         "\xb5m\r\n"
         "Y Amplitude: 5 \xb5m\r\nZ Amplitude: 12.5 \xc5\r\n\r\n@",
         2e-6, 2.5e-6, 1e-10, NULL},
        {"# Width: 6 [um]\n# Height: 5 (um)\n# Value units: [nm]\n@", 2e-6, 2.5e-6, 1e-9, NULL},
        {"\"\\Scan Size: 600 nm\"\r\n\"\\Exported image units: nm\"\r\n@", 2e-7, 3e-7, 1e-9, NULL},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[1000];
        double height[6];
        struct rc_grid *g;
        const char *channel;

        snprintf(text, sizeof text, "%.*s1 -2 3\n4.5 5 6\n", (int)strcspn(cases[k].text, "@"),
                 cases[k].text);
        for (size_t i = 0; i < 6; i++)
            height[i] = counts[i] * cases[k].z;
        g = read_text(text, &rc_no_wish);
        check(text, g, 3, 2, height);
        if (!is_near(g->dx, cases[k].dx) || !is_near(g->dy, cases[k].dy))
            fail_msg("'%s': dx is %.17g, dy is %.17g", text, g->dx, g->dy);
        channel = rc_grid_get(g, "file.channel");
        if (cases[k].channel == NULL ? channel != NULL
                                     : channel == NULL || strcmp(channel, cases[k].channel) != 0)
            fail_msg("'%s': channel '%s'", text, channel == NULL ? "" : channel);
        rc_grid_free(g);
    }
}

static void
headers_that_are_refused(void **state)
{
    static const struct {
        const char *text, *why;
    } cases[] = {
        {"1 2 3\n4 5 6\n", "--dx LENGTH"},
        {"1 2 3\n4 5 6\n", "the unit of its heights is missing too: give --z-unit UNIT"},
        {"# Width: 6 um\n# Height: 5 um\n1 2 3\n4 5 6\n", "--z-unit"},
        {"# Width: 6 um\n# Height: 5 um\n# Value units: V\n1 2 3\n4 5 6\n",
         "'V', which is not a length"},
        {"# Width: 0 um\n# Height: 5 um\n# Value units: m\n1 2 3\n4 5 6\n", "spacing in x is 0 m"},
        {"# Width: -6 um\n# Height: 5 um\n# Value units: m\n1 2 3\n4 5 6\n", "positive and finite"},
        {"# Width: 6 um\n# Height: 0 um\n# Value units: m\n1 2 3\n4 5 6\n", "spacing in y is 0 m"},
        {"# Width: 6 deg\n# Height: 5 um\n# Value units: m\n1 2 3\n4 5 6\n", "--dx LENGTH"},
        {"# x-unit: deg\n# x-length: 6\n# y-length: 5\n# z-unit: nm\n1 2 3\n4 5 6\n",
         "--dx LENGTH"},
        {"# x-length = 6\n# y-length = 5\n# z-unit = V\n# Bit2nm = 1\n1 2 3\n4 5 6\n",
         "'V', which is not a length"},
        {"h=3 w=3\npixel size=1 m\ndata unit=m\n1 2 3\n4 5 6\n", "promises 3 columns and 3 rows"},
        {"h=2 w=4\npixel size=1 m\ndata unit=m\n1 2 3\n4 5 6\n", "promises 4 columns and 2 rows"},
        {"h=2 w=4294967299\npixel size=1 m\ndata unit=m\n1 2 3\n4 5 6\n",
         "promises 42949672"}, /* for any size of addresses */
        {"h=2 w=3\npixel size=nan m\ndata unit=m\n1 2 3\n4 5 6\n", "--dx LENGTH"},
        {"# Channel: a\n# Width: 6 um\n", "no numbers in the file"},
        {"\xff\xfe"
         "1 2",
         "UTF-16"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        refuse_text(cases[k].text, &rc_no_wish, cases[k].why);
}

/* ---- several images ---- */

#define BLOCK(name, width, height, unit)                                                           \
    "# Channel: " name "\n# Width: " width "\n# Height: " height "\n# Value units: " unit "\n"

/* Image `index` of the text, or NULL. */
static struct rc_grid *
read_image(const char *text, const struct rc_wish *wish, size_t index, struct rc_err *err)
{
    struct rc_file file = {"made.txt", (const unsigned char *)text, strlen(text)};
    struct rc_notes notes = {0};

    return read_map(&rc_format_ascii, &file, wish, index, &notes, err);
}

static void
images(void **state)
{
    static const char text[] =
        BLOCK("Phase", "6 um", "5 um", "deg") "1 2 3\n# a note\n4 5 6\n\n" BLOCK(
            "Height", "4 um", "9 um", "nm") "1 2\n3 4\n5 6\n"
                                            "# Kanal: Zoom\n# Breite: 3,0 nm\n# H\xc3\xb6he: 1 nm\n"
                                            "# Werteinheiten: m\n7 8 9\n";
    static const double all[] = {1, 2, 3, 4, 5, 6}, nm[] = {1e-9, 2e-9, 3e-9, 4e-9, 5e-9, 6e-9},
                        last[] = {7, 8, 9}, wished[] = {1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3};
    static const struct {
        const char *name, *unit, *channel;
        size_t nx, ny;
        double dx, dy;
        const double *v;
    } rows[] = {
        {"Phase", "deg", "Phase", 3, 2, 2e-6, 2.5e-6, all},
        {"Height", "m", "height", 2, 3, 2e-6, 3e-6, nm},
        {"Zoom", "m", "height", 3, 1, 1e-9, 1e-9, last},
    };
    struct rc_file file = {"made.txt", (const unsigned char *)text, strlen(text)};
    struct rc_channel channel[4];
    struct rc_wish wish = rc_no_wish;
    struct rc_err err;
    struct rc_grid *g;

    (void)state;
    assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_ascii);
    assert_int_equal(list_maps(&rc_format_ascii, &file, &rc_no_wish, channel, 4, NULL), 3);
    assert_int_equal(rc_format_topography(channel, 3, "m").index, 1);
    for (size_t k = 0; k < 3; k++) {
        if ((g = read_image(text, &rc_no_wish, k, &err)) == NULL)
            fail_msg("image %zu: %s", k, err.text);
        check(rows[k].name, g, rows[k].nx, rows[k].ny, rows[k].v);
        assert_true(is_near(g->dx, rows[k].dx) && is_near(g->dy, rows[k].dy));
        assert_string_equal(g->channel, rows[k].channel);
        assert_string_equal(g->unit, rows[k].unit);
        assert_string_equal(rc_grid_get(g, "file.channel"), rows[k].name);
        assert_string_equal(channel[k].name, rows[k].name);
        assert_string_equal(channel[k].unit, rows[k].unit);
        assert_true(channel[k].nx == g->nx && channel[k].ny == g->ny && channel[k].dx == g->dx);
        rc_grid_free(g);
    }
    wish.z_unit = 1e-3; /* values in another unit may be read as heights */
    if ((g = read_image(text, &wish, 0, &err)) == NULL)
        fail_msg("%s", err.text);
    check("Phase as heights", g, 3, 2, wished);
    assert_string_equal(g->unit, "m");
    rc_grid_free(g);
    assert_null(read_image(text, &rc_no_wish, 3, &err));
    assert_non_null(strstr(err.text, "no channel 4: the file has 3"));
    /* a comment that is not a header does not begin another image */
    g = read_image(BLOCK("a", "6 um", "5 um", "m") "1 2 3\n# Date: today\n4 5 6\n", &rc_no_wish, 0,
                   &err);
    check("a comment", g, 3, 2, all);
    rc_grid_free(g);
    /* and rows of another width are refused, not moved to another image */
    assert_null(read_image(BLOCK("a", "6 um", "5 um", "m") "1 2 3\n4 5\n", &rc_no_wish, 0, &err));
}

/* ---- columns ---- */

static void
separators_and_decimal_marks(void **state)
{
    static const double truth[6] = {0, 1.5, -2.25, 3, 4e-3, 5000};
    static const char *const texts[] = {
        "0 1.5 -2.25\n3 4e-3 5000\n",
        "0\t1.5\t-2.25\n3\t4e-3\t5000\n",
        "0\t1.5\t-2.25\t\n3\t4e-3\t5000\t\n", /* a separator is the last character of the row */
        "  0   1.5 -2.25  \r\n\t3 4e-003   +5e3 \r\n",
        "0,1.5,-2.25\n3,.004,5000\n",
        "0, 1.5, -2.25\n3, 4.e-3, 5000\n",
        "0,1.5,-2.25,\n3,4e-3,5000,\n",
        "0;1.5;-2.25\n3;4E-3;5000",
        "0 1,5 -2,25\n3 0,004 5000,0\n",
        "0,0 1,5 -2,25\n3,0 4,0e-3 5000\n",
        "0\t1,5\t-2,25\n3\t4e-3\t5000\n",
        "0;1,5;-2,25\n3;0,004;5000,0\n",
        "0 ; 1,5 ; -2,25\n3 ; 0,004 ; 5000\n",
        "0 1.5 -2.25\r3 4e-3 5000\r",
        "\"0\",\"1.5\",\"-2.25\"\n\"3\",\"4e-3\",\"5000\"\n", /* in quotes */
        "\"0\";\"1,5\";\"-2,25\"\n\"3\";\" 0,004 \";\"5000\";\n",
        "\"0\" \"1,5\" -2,25\n3 \"4e-3\" \"5000\"\n",
        "sep=;\n0;1.5;-2.25\n3;4E-3;5000",
        "sep=|\r\n0|1.5|-2.25\r\n3|4E-3|5000\r\n",
        "\n# note\n0 1.5 -2.25\n\n% note\n3 4e-3 5000\n\n\n",
    };

    (void)state;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        struct rc_grid *g = read_text(texts[k], &plain_wish);
        check(texts[k], g, 3, 2, truth);
        assert_true(g->dx == 1.1e-6 && g->dy == 1.29e-6);
        rc_grid_free(g);
    }
}

static void
wishes_for_text(void **state)
{
    static const double truth[4] = {1.5, 2, NAN, 4};
    static const struct {
        const char *text, *separator, *missing;
        char decimal;
    } cases[] = {
        {"1.5|2\nnan|4\n", "|", NULL, 0},          {"1,5 2\nnan 4\n", NULL, NULL, ','},
        {"1,5 2\nnan 4\n", " ", NULL, ','},        {"1.5,2\n,4\n", ",", NULL, '.'},
        {"1.5 2\n-9999.00 4\n", NULL, "-9999", 0}, {"\"1,5\",\"2\"\n\"\",\"4\"\n", NULL, NULL, ','},
        {"1.5 2\nlost 4\n", NULL, "lost", 0},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct rc_wish wish = plain_wish;
        struct rc_grid *g;
        wish.separator = cases[k].separator;
        wish.missing = cases[k].missing;
        wish.decimal = cases[k].decimal;
        g = read_text(cases[k].text, &wish);
        check(cases[k].text, g, 2, 2, truth);
        rc_grid_free(g);
    }
}

static void
missing_values(void **state)
{
    static const double truth[6] = {1, NAN, 3, NAN, 5, NAN};
    static const char *const texts[] = {
        "1 NaN 3\nnan 5 NAN\n",    "1 BAD 3\nBad 5 bad\n", "1 --- 3\n--- 5 --\n",
        "1\tN/A\t3\nNA\t5\tn/a\n", "1,,3\n,5,\n",          "1;;3\n;5;\n",
        "1\t\t3\n\t5\t\n",         "1, ,3\n ,5, \n",       "1 1.#QNAN 3\n-1.#IND 5 -nan\n",
        "1,,3,\n,5,,\n",
    };

    (void)state;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        struct rc_grid *g = read_text(texts[k], &plain_wish);
        check(texts[k], g, 3, 2, truth);
        rc_grid_free(g);
    }
}

static void
columns_that_are_refused(void **state)
{
    static const struct {
        const char *text, *why;
    } cases[] = {
        {"1 2 3\n4 5\n", "line 2: 2 values, where the first row (line 1) has 3"},
        {"# note\n\n1 2 3\n4 5 6\n7 8 9 10\n", "line 5: 4 values, where the first row (line 3)"},
        {"1 2\r\n3 4\r\n5\r\n", "line 3: 1 values"},
        {"1 2 3\n4 five 6\n", "line 2: 'five' is not a number"},
        {"1 2 3\n4 5x 6\n", "line 2: '5x' is not a number"},
        {"1 2 3\n4 0x1p3 6\n", "line 2: '0x1p3' is not a number"},
        {"1 2 3\n4 infi 6\n", "line 2: 'infi' is not a number"},
        {"1 2 3\n4 1e999 6\n", "line 2: '1e999' is not a number"},
        {"1 2 3\n4 - 6\n", "line 2: '-' is not a number"},
        {"1 2 3\n4 . 6\n", "line 2: '.' is not a number"},
        {"1 2 3\n4 1.2.3 6\n", "line 2: '1.2.3' is not a number"},
        {"1.5 2 3\n4 5,5 6\n", "line 2: '5,5' is not a number with the decimal mark '.'"},
        {"1,5 2 3\n4 5.5 6\n", "line 2: '5.5' is not a number with the decimal mark ','"},
        {"1;2;3\n4;5 6;7\n", "line 2: two values with white space between them"},
        {"1,5, 2 3\n", "some commas look like decimal marks"},
        {"1,5\n2,5\n", "may be a decimal mark or a separator"},
        {"1 2 3\n4 \x1b[2J 6\n", "line 2: ' [2J' is not a number"},
        {"", "no numbers in the file"},
        {"\n\n# only words\n", "no numbers in the file"},
        {"5\n6\n7\n", "3 numbers in one column"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        refuse_text(cases[k].text, &plain_wish, cases[k].why);
}

/* Infinite values as C libraries write them, and values that become infinite by their unit. */
static void
infinite_heights_are_missing(void **state)
{
    static const char *const texts[] = {"1 2\n3 inf\n", "1, 2\n3, -inf\n", "1 2\n3 +Infinity\n",
                                        "1;2\n3;-1.#INF\n", "1 2\n3 4e300\n"};
    struct rc_wish wish = plain_wish;

    (void)state;
    wish.z_unit = 1e100;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        struct rc_file file = {"a.txt", (const unsigned char *)texts[k], strlen(texts[k])};
        struct rc_notes notes = {0};
        struct rc_err err = {""};
        struct rc_grid *g = read_map(&rc_format_ascii, &file, &wish, 0, &notes, &err);

        if (g == NULL)
            fail_msg("'%s' is refused: %s", texts[k], err.text);
        assert_true(g->v[0] == 1e100 && g->v[1] == 2 * 1e100 && g->v[2] == 3 * 1e100 &&
                    isnan(g->v[3]));
        assert_int_equal(notes.n, 1);
        assert_string_equal(notes.text[0], "1 of 4 values is infinite and read as missing, the "
                                           "first at column 1, row 1 (from 0)");
        rc_grid_free(g);
    }
    refuse_text("inf inf\nnan -inf\n", &wish, "every value that is there is infinite (3 of 2 x 2)");
}

static void
lists_of_points_are_no_matrices(void **state)
{
    static const char *const lists[] = {
        "0 0 7\n1 0 8\n2 0 7\n0 1 6\n1 1 8\n2 1 9\n",   /* x fast        */
        "0 0 7\n0 1 8\n0 2 7\n1 0 6\n1 1 8\n1 2 9\n",   /* y fast        */
        "0 5 7\n1 5 8\n2 5 nan\n0 4 6\n1 4 8\n2 4 9\n", /* y falls       */
    };
    static const char matrix[] = "0 0 7\n0 0 8\n2 0 7\n0 1 6\n1 1 8\n2 1 9\n";
    static const char header[] = "# Width: 3 um\n# Height: 6 um\n# Value units: m\n";
    char text[200];

    (void)state;
    for (size_t k = 0; k < 3; k++) {
        refuse_text(lists[k], &plain_wish, "a list of points (x, y, z)");
        snprintf(text, sizeof text, "%s%s", header, lists[k]);
        rc_grid_free(read_text(text, &rc_no_wish));
    }
    refuse_text("0 5\n1 4\n3 2\n", &plain_wish, "a profile (x, z)");
    rc_grid_free(read_text("0 5\n1 4\n1 2\n", &plain_wish));
    rc_grid_free(read_text(matrix, &plain_wish));
}

/* ---- numbers ---- */

/* The C library rounds correctly; this function must give the same to the last bit. */
static void
numbers_are_those_of_the_c_library(void **state)
{
    static const char *const ways[] = {"%.17g", "%.16e", "%.3e", "%.9g", "%.0f", "%.25f", "%.30e"};
    enum {
        LINES = 3000,
        TEXT_MOST = 400
    };
    size_t n = sizeof ways / sizeof *ways;
    char *text = malloc(LINES * n * TEXT_MOST), *to = text;
    double *truth = malloc(LINES * n * sizeof *truth);
    uint64_t seed = 20250117;
    struct rc_grid *g;

    (void)state;
    for (size_t k = 0; k < LINES * n; k++) {
        double value;
        char one[TEXT_MOST];
        seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        value = ((double)(seed >> 11) / 9007199254740992.0 - 0.5) *
                pow(10, (double)((seed >> 33) % 60) - 45);
        snprintf(one, sizeof one, ways[k % n], value);
        truth[k] = strtod(one, NULL);
        to += sprintf(to, "%s%c", one, (k + 1) % n == 0 ? '\n' : ' ');
    }
    g = read_text(text, &plain_wish);
    assert_int_equal(g->nx, n);
    for (size_t k = 0; k < LINES * n; k++)
        if (g->v[k] != truth[k])
            fail_msg("number %zu is %.17g, not %.17g", k, g->v[k], truth[k]);
    rc_grid_free(g);
    free(truth);
    free(text);
}

/* ---- damage ---- */

static void
every_truncation(void **state)
{
    static const char *const texts[] = {
        "\xef\xbb\xbf# Channel: a\n# Width: 6,0 \xc2\xb5m\n# Height: 5 \xb5m\n# Value units: m\n"
        "1.5e-3\tNaN\t+3\t\r\n4\t-5\t6.25\t\r\n",
        "h=2 w=3\npixel size=1e-7 m\ndata unit=rad\nheight conversion factor (-> m)=1e-8\n"
        "1,5;;3\n---;5;6,25e-17",
        "\"\\Scan Size: 600 500 nm\"\r\n\\Exported image units: nm\r\n1.5, 2, 3\r\n4, 5, 6\r\n",
        BLOCK("a", "6 um", "5 um", "V") "\"1\";\"\"\n" BLOCK("b", "6 um", "5 um", "m") "1 2\n",
    };

    (void)state;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++)
        for (size_t n = 0; n <= strlen(texts[k]); n++) {
            struct rc_notes notes;
            struct rc_err err;
            rc_grid_free(read_bytes(texts[k], n, &rc_no_wish, &notes, &err));
            rc_grid_free(read_bytes(texts[k], n, &plain_wish, &notes, &err));
        }
}

static void
every_byte_damaged(void **state)
{
    char text[] = "# Channel: a\n# Width: 6 um\n# Height: 5 um\n# Value units: m\n1.5,2,3\n4,,6\n";

    (void)state;
    for (size_t k = 0; k < sizeof text - 1; k++) {
        static const char bytes[] = "\0\n\r\t ,;.=#%\\\"-+e9\xff\xef";
        char good = text[k];
        for (size_t b = 0; b < sizeof bytes - 1; b++) {
            struct rc_notes notes;
            struct rc_err err;
            text[k] = bytes[b];
            rc_grid_free(read_bytes(text, sizeof text - 1, &rc_no_wish, &notes, &err));
        }
        text[k] = good;
    }
}

static void
many_empty_rows_need_no_memory(void **state)
{
    size_t n = 200000;
    char *text = malloc(2 * n + 1);

    (void)state;
    for (size_t k = 0; k < n; k++) /* one row of many columns, then many of one */
        memcpy(text + 2 * k, k < n / 2 ? "1 " : "\n1", 2);
    text[2 * n] = '\0';
    refuse_text(text, &plain_wish, "some row is too short");
    free(text);
}

static void
what_is_no_text_is_not_recognised(void **state)
{
    static const char *const texts[] = {"This is nonsense.", "columns 10\nrows 10\n1\n",
                                        "cBCR-1.0\nManufacID = x\n", "X,y\n1\n"};

    (void)state;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        struct rc_file file = {
            .name = "a.txt", .data = (const unsigned char *)texts[k], .size = strlen(texts[k])};
        struct rc_err err;
        assert_null(rc_format_find(&file, &err));
        assert_non_null(strstr(err.text, "not recognised"));
    }
}

/* Files that are not heights are refused by what they are. */
static void
other_files(void **state)
{
    static const struct {
        const char *begin, *why;
    } rows[] = {
        {"\x89PNG\r\n\x1a\n", "a PNG picture has colours, no heights"},
        {"\xff\xd8\xff\xe0", "a JPEG picture"},
        {"%PDF-1.7\n1 0 obj\n", "a PDF document"},
        {"BZh91AY&SY", "packed with bzip2"},
        {"\xfd"
         "7zXZ",
         "packed with xz: unpack it first (unxz)"},
        {"\x28\xb5\x2f\xfd\x24", "packed with zstd"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct rc_file file = {.name = "a",
                               .data = (const unsigned char *)rows[k].begin,
                               .size = strlen(rows[k].begin)};
        struct rc_err err;

        assert_null(rc_format_find(&file, &err));
        assert_non_null(strstr(err.text, rows[k].why));
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(headers),
        cmocka_unit_test(headers_that_are_refused),
        cmocka_unit_test(images),
        cmocka_unit_test(separators_and_decimal_marks),
        cmocka_unit_test(wishes_for_text),
        cmocka_unit_test(missing_values),
        cmocka_unit_test(columns_that_are_refused),
        cmocka_unit_test(infinite_heights_are_missing),
        cmocka_unit_test(lists_of_points_are_no_matrices),
        cmocka_unit_test(numbers_are_those_of_the_c_library),
        cmocka_unit_test(every_truncation),
        cmocka_unit_test(every_byte_damaged),
        cmocka_unit_test(many_empty_rows_need_no_memory),
        cmocka_unit_test(what_is_no_text_is_not_recognised),
        cmocka_unit_test(other_files),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
