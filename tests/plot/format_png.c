/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pixels of a picture are the values of the map in the documented colours. Its chunks describe how it was
 * made: decoded by libpng, compared with colour tables from the literature. */
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tools/canvas/canvas.h"
#include "tools/plot/raster.h"
#include "tools/plot/ticks.h"
#include "tests/exact.h"
#include "pictures.h"

static struct rc_grid *
grid_of(const char *channel, const char *unit, size_t nx, size_t ny, const double *v)
{
    struct rc_shape shape = {nx, ny, 1.1e-6, 1.3e-6};
    struct rc_grid *g = rc_grid_new(&shape, channel, unit, NULL);

    assert_non_null(g);
    memcpy(g->v, v, nx * ny * sizeof *v);
    return g;
}

/* The picture of a map by rc-render with these options. */
static struct picture
render(const char *options, struct rc_grid *g)
{
    char text[512];

    put_stream("in.rcg", &g, 1);
    snprintf(text, sizeof text, "rc-render %s -o out.png in.rcg", options);
    return draw(text);
}

enum {
    ANY = 0x1000000 /* in place of a colour */
};

/* Pixel k of a raw picture, counted along its rows, has this colour. */
static void
is_colour(const struct picture *p, size_t k, unsigned colour, int within, const char *what)
{
    unsigned c = pixel(p, k % p->head.width, k / p->head.width);

    for (int shift = 0; shift < 24 && colour != ANY; shift += 8)
        if (abs((int)(c >> shift & 0xff) - (int)(colour >> shift & 0xff)) > within)
            fail_msg("%s: colour %06x of pixel %zu is not %06x", what, c, k, colour);
}

/* ---- raw pictures ---- */

/* Up to six nodes and their colours, to `within` of 255. Greys are those of the values; the ends and middles
 * of viridis and magma are as published (van der Walt and Smith 2015). */
/* clang-format off */
static const struct {
    const char *what, *options, *channel, *unit;
    size_t nx, ny;
    double v[6];
    unsigned colour[6];
    int within;
} raws[] = {
    {"a pixel for each node", "--colormap grey", "height", "m", 3, 2,
     {0, 51e-6, 102e-6, 153e-6, 204e-6, 255e-6},
     {0, 0x333333, 0x666666, 0x999999, 0xcccccc, 0xffffff}, 1},
#define RANGE(range)                                                                               \
    {"values beyond " range " have the end colours", "--colormap grey --range " range,             \
     "some.stress", "Pa", 6, 1, {-5e9, 1e9, 2e9, 3e9, INFINITY, -INFINITY},                        \
     {0, 0, 0x808080, 0xffffff, 0xffffff, 0}, 1}
    RANGE("1GPa:3GPa"), RANGE("1e9,3e9"), RANGE("1000MPa:3e3MPa"),
    /* log10(30) / 3 = 0.492374 */
    {"equal ratios have equal steps", "--colormap grey --log", "some.stress", "Pa", 6, 1,
     {1e6, 1e7, 1e8, 1e9, 0, 3e7}, {0, 0x555555, 0xaaaaaa, 0xffffff, 0, 0x7e7e7e}, 1},
    {"equal ratios in a range", "--colormap grey --log --range 1e5:1e9", "some.stress", "Pa", 4, 1,
     {1e6, 1e7, 1e8, 1e9}, {0x404040, 0x808080, 0xbfbfbf, 0xffffff}, 1},
    {"compression alone ends at zero", "", "szz", "Pa", 4, 1,
     {-4e9, -1e9, 0, 1e3}, {0x000004, ANY, 0xfcfdbf, 0xfcfdbf}, 1},
    {"tension alone begins at zero", "", "szz", "Pa", 4, 1,
     {4e9, 1e9, 0, -1e3}, {0xfcfdbf, ANY, 0x000004, 0x000004}, 1},
    {"heights have viridis", "", "height", "m", 3, 1,
     {1e-6, 2e-6, 3e-6}, {0x440154, 0x21918c, 0xfde725}, 2},
    {"stresses have magma", "", "mises", "Pa", 3, 1,
     {1e3, 0.5e9, 1e9}, {0x000004, 0xb73779, 0xfcfdbf}, 2},
    {"categories have three colours", "", "state", "1", 4, 1,
     {0, 1, 2, 1}, {0xeaeaea, 0x440154, 0xfde725, 0x440154}, 0},
};
/* clang-format on */

static void
raw_pixels_have_the_colours_of_their_nodes(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof raws / sizeof *raws; k++) {
        char options[128];
        struct picture p;

        snprintf(options, sizeof options, "--raw %s", raws[k].options);
        p = render(options,
                   grid_of(raws[k].channel, raws[k].unit, raws[k].nx, raws[k].ny, raws[k].v));
        assert_int_equal(p.head.width, raws[k].nx);
        assert_int_equal(p.head.height, raws[k].ny);
        for (size_t n = 0; n < raws[k].nx * raws[k].ny; n++)
            is_colour(&p, n, raws[k].colour[n], raws[k].within, raws[k].what);
        free(p.rgb);
    }
}

/* The grey of pixel k is that of a value between lo and hi. */
static void
is_between(const struct picture *p, size_t k, double value, double lo, double hi, const char *what)
{
    double t = fmin(fmax((value - lo) / (hi - lo), 0), 1);

    is_colour(p, k, 0x010101 * (unsigned)floor(255 * t + 0.5), t > 0 && t < 1, what);
}

/* The values 0 to 999 um in a mixed order: node k has 7 k modulo 1000, because 7 and 1000 have no common
 * factor. In some rows node 0 has 5000 um instead: one value far from its neighbours does not compress the
 * colours of the others. */
static const struct {
    const char *options;
    double first, lo, hi; /* um; the ends of the colours */
} ranks[] = {
    {"--range 10%:90%", 0, 99.9, 899.1}, /* rank 0.1 * 999 among 0, 1, 2, ... is 99.9 */
    {"--clip", 0, 4.995, 994.005},       {"--range symmetric", 0, -999, 999},
    {"", 5000, 1 + 4.995, 1 + 994.005}, /* ranks count from the smallest value, which is 1 */
    {"--range 0%:100%", 5000, 1, 5000},
};

static void
percentiles_are_ranks(void **state)
{
    (void)state;
    for (size_t row = 0; row < sizeof ranks / sizeof *ranks; row++) {
        char options[128];
        double v[1000];
        struct picture p;

        for (size_t k = 0; k < 1000; k++)
            v[k] = (k == 0 ? ranks[row].first : (double)(7 * k % 1000)) * 1e-6;
        snprintf(options, sizeof options, "--raw --colormap grey %s", ranks[row].options);
        p = render(options, grid_of("height", "m", 40, 25, v));
        for (size_t k = 0; k < 1000; k++)
            is_between(&p, k, 1e6 * v[k], ranks[row].lo, ranks[row].hi, options);
        free(p.rgb);
    }
}

static void
a_peak_with_rising_neighbours_is_not_an_outlier(void **state)
{
    double v[900];
    struct picture p;

    (void)state;
    for (int k = 0; k < 900; k++)
        v[k] = exp(-0.05 * (pow(k % 30 - 12.0, 2) + pow(floor(k / 30.0) - 9, 2)));
    p = render("--raw --colormap grey", grid_of("height", "m", 30, 30, v));
    for (size_t k = 0; k < 900; k++)
        is_between(&p, k, v[k], 0, 1, "a peak");
    free(p.rgb);
}

/* Checks a picture drawn by another program: in the area of the map, each cell except its edge has the colour
 * of its value. */
static void
an_svg_has_the_nodes_at_their_places(void **state)
{
    struct rc_grid *g = grid_of("height", "m", 3, 2, raws[0].v);
    double x = 0, y = 0, w = 0, h = 0;
    char text[512];
    struct picture p;
    FILE *file;

    (void)state;
    put_stream("in.rcg", &g, 1);
    p = draw("rc-render --colormap grey --width 600 -o out.svg in.rcg && "
             "rsvg-convert -o out.png out.svg");
    snprintf(text, sizeof text, "%s/out.svg", folder);
    file = fopen(text, "r");
    assert_non_null(file);
    while (w == 0 && fgets(text, sizeof text, file) != NULL)
        if (sscanf(text, "<image x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\"", &x, &y, &w,
                   &h) != 4)
            w = 0;
    fclose(file);
    assert_true(w > 200 && h > 100);
    assert_int_equal(p.head.width, 600);
    for (size_t k = 0; k < 6; k++)
        for (int place = 0; place < 9; place++) {
            double across = (double)(k % 3) + 0.5 + 0.48 * (place % 3 - 1);
            double down = (double)(k / 3) + 0.5 + 0.48 * (place / 3 - 1);

            is_colour(&p, (size_t)(y + down / 2 * h) * 600 + (size_t)(x + across / 3 * w),
                      raws[0].colour[k], 1, "SVG");
        }
    free(p.rgb);
}

static void
both_signs_have_two_colours_from_zero(void **state)
{
    static const double v[] = {-1e9, 0, 0.5e9};
    struct picture p = render("--raw", grid_of("szz", "Pa", 3, 1, v));
    const unsigned char *c = p.rgb;

    (void)state;
    assert_true(c[2] > 100 && c[0] < 60);  /* blue: compression */
    assert_true(abs(c[3] - c[5]) <= 1);    /* neither           */
    assert_true(c[6] > 200 && c[8] < 200); /* reddish: tension  */
    free(p.rgb);
}

/* A pixel of many nodes has the mean of their colours, never that of a category that is not there: half no
 * contact (0) and half slip (2) is not stick (1). */
static void
categories_mix_their_colours(void **state)
{
    static double fine[1600 * 800];
    struct picture p;

    (void)state;
    for (size_t k = 0; k < 1600 * 800; k++)
        fine[k] = (k + k / 1600) % 2 == 0 ? 0 : 2;
    p = render("--width 480", grid_of("state", "1", 1600, 800, fine));
    is_colour(&p, p.head.height / 2 * p.head.width + p.head.width / 2, 0xf4e988, 12, "a mixture");
    free(p.rgb);
}

static bool
on_the_scale(const char *map, unsigned colour)
{
    for (int k = 0; k <= 1000; k++) {
        struct rgb c = colormap_at(colormap_find(map), k / 1000.0);

        if (abs(c.r - (int)(colour >> 16)) + abs(c.g - (int)(colour >> 8 & 0xff)) +
                abs(c.b - (int)(colour & 0xff)) <
            24)
            return true;
    }
    return false;
}

static void
missing_and_no_contact_are_no_values(void **state)
{
    static const char *const maps[] = {"viridis", "magma", "bluered", "grey"};
    static const double v[] = {0, 1, NAN, 5e8, 1e9, -0.0};

    (void)state;
    for (size_t m = 0; m < sizeof maps / sizeof *maps; m++) {
        char options[64];
        struct picture p;

        snprintf(options, sizeof options, "--raw --colormap %s", maps[m]);
        p = render(options, grid_of("pressure", "Pa", 6, 1, v));
        assert_int_equal(pixel(&p, 0, 0), pixel(&p, 5, 0));
        assert_int_not_equal(pixel(&p, 0, 0), pixel(&p, 2, 0));
        assert_int_not_equal(pixel(&p, 0, 0), pixel(&p, 1, 0));
        assert_false(on_the_scale(maps[m], pixel(&p, 0, 0)));
        assert_false(on_the_scale(maps[m], pixel(&p, 2, 0)));
        assert_true(on_the_scale(maps[m], pixel(&p, 1, 0)));
        free(p.rgb);
    }
}

/* ---- colours ---- */

/* The largest change of L* by rounding dark colours to 8 bits. */
static const double eight_bits = 0.35;

/* Eyes that see the colours. */
static const struct {
    const char *name;
    double of[3][3]; /* acts on linear red, green, blue */
} eyes[] = {
    {"all cones", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    /* Machado, Oliveira and Fernandes 2009, severity 1 */
    {"protanopia",
     {{0.152286, 1.052583, -0.204868},
      {0.114503, 0.786281, 0.099216},
      {-0.003882, -0.048116, 1.051998}}},
    {"deuteranopia",
     {{0.367322, 0.860646, -0.227968},
      {0.280085, 0.672501, 0.047413},
      {-0.011820, 0.042940, 0.968881}}},
    {"tritanopia",
     {{1.255528, -0.076749, -0.178779},
      {-0.078411, 0.930809, 0.147602},
      {0.004733, 0.691367, 0.303900}}},
};

static double
cube_root(double t)
{
    return t > 216.0 / 24389 ? cbrt(t) : (t * 24389 / 27 + 16) / 116;
}

/* CIELAB of a colour as seen with this colour blindness (IEC 61966-2-1, D65). */
static void
seen(struct rgb c, size_t by, double lab[3])
{
    static const double xyz[3][3] = {
        {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    static const double white[3] = {0.9505, 1, 1.089};
    const unsigned char byte[3] = {c.r, c.g, c.b};
    double linear[3], other[3] = {0}, f[3];

    for (int k = 0; k < 3; k++) {
        double s = byte[k] / 255.0;
        linear[k] = s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
    }
    for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++)
            other[k] += eyes[by].of[k][l] * linear[l];
        other[k] = fmin(fmax(other[k], 0), 1);
    }
    for (int k = 0; k < 3; k++) {
        double sum = 0;
        for (int l = 0; l < 3; l++)
            sum += xyz[k][l] * other[l];
        f[k] = cube_root(sum / white[k]);
    }
    lab[0] = 116 * f[1] - 16;
    lab[1] = 500 * (f[0] - f[1]);
    lab[2] = 200 * (f[1] - f[2]);
}

static double
lightness(struct rgb c)
{
    double lab[3];

    seen(c, 0, lab);
    return lab[0];
}

/* Values in the middle and at both ends of cells, and at the steps of the list of colours. */
static void
a_table_has_the_colours_of_the_map(void **state)
{
    static struct colormap_table table;

    (void)state;
    for (size_t m = 0; colormap_name(m) != NULL; m++) {
        const struct colormap *map = colormap_find(colormap_name(m));
        size_t n = 4 * (size_t)COLORMAP_CELLS * (map->points - 1);
        colormap_tabulate(&table, map);
        for (size_t k = 0; k <= n + 1; k++) {
            double t = ((double)k - 0.5) / (double)(n / 2) - 0.5; /* goes from before 0 to beyond
                                                                     1 */
            struct rgb a = colormap_at(map, t), b = colormap_look_up(&table, t);
            assert_true(a.r == b.r && a.g == b.g && a.b == b.b);
            t = nextafter((double)k / (double)n, k % 2 == 0 ? -1 : 1);
            a = colormap_at(map, t);
            b = colormap_look_up(&table, t);
            assert_true(a.r == b.r && a.g == b.g && a.b == b.b);
        }
    }
}

static void
lightness_rises_and_evenly(void **state)
{
    static const char *const maps[] = {"viridis", "magma", "grey"};

    (void)state;
    for (size_t m = 0; m < 3; m++) {
        const struct colormap *map = colormap_find(maps[m]);
        double low = lightness(colormap_at(map, 0)), high = lightness(colormap_at(map, 1));
        double last = low;

        assert_true(high - low > 70);
        for (int k = 1; k <= 256; k++) {
            double l = lightness(colormap_at(map, k / 256.0));

            assert_true(l > last - eight_bits);
            assert_true(fabs(l - low - (high - low) * k / 256) < 6);
            last = l;
        }
    }
}

static double
difference(const struct colormap *map, double s, double t, size_t by)
{
    double a[3], b[3];

    seen(colormap_at(map, s), by, a);
    seen(colormap_at(map, t), by, b);
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

/* The lightness rises or falls monotonically along a colour map, or along each half of a diverging one.
 * Colours at a distance of a tenth of the range look different: 5 is twice the just noticeable difference. */
static void
other_eyes_tell_values_apart(void **state)
{
    const char *name;

    (void)state;
    for (size_t m = 0; (name = colormap_name(m)) != NULL; m++)
        for (size_t by = 0; by < sizeof eyes / sizeof *eyes; by++) {
            const struct colormap *map = colormap_find(name);
            double last[3], lab[3];

            seen(colormap_at(map, 0), by, last);
            for (int k = 1; k <= 64; k++) {
                bool rises = !map->diverging || k <= 32;

                seen(colormap_at(map, k / 64.0), by, lab);
                if (rises ? lab[0] <= last[0] : lab[0] >= last[0])
                    fail_msg("%s, %s: lightness turns at %d of 64", name, eyes[by].name, k);
                memcpy(last, lab, sizeof last);
            }
            for (int k = 0; k <= 54; k++)
                if (!(map->diverging && k < 30 && k + 6 > 30) &&
                    difference(map, k / 60.0, (k + 6) / 60.0, by) < 5)
                    fail_msg("%s, %s: too alike from %d of 60", name, eyes[by].name, k);
            for (int k = 8; map->diverging && k <= 30; k++)
                if (difference(map, (30 - k) / 60.0, (30 + k) / 60.0, by) < 10)
                    fail_msg("%s, %s: both signs alike at %d of 30", name, eyes[by].name, k);
        }
}

static void
bluered_is_as_light_on_both_sides(void **state)
{
    const struct colormap *map = colormap_find("bluered");
    double last = lightness(colormap_at(map, 0.5));

    (void)state;
    assert_true(map->diverging && last > 90);
    for (int k = 1; k <= 128; k++) {
        double cold = lightness(colormap_at(map, 0.5 - k / 256.0));
        double warm = lightness(colormap_at(map, 0.5 + k / 256.0));

        assert_true(fabs(cold - warm) < 1);
        assert_true(cold < last + eight_bits);
        last = cold;
    }
    assert_true(last < 40);
}

/* ---- reduction ---- */

static void
cells_are_means_of_what_they_cover(void **state)
{
    static const double v[] = {1, 3, 0, 2, NAN, 8, 5, 7, 0, 0, 6, NAN};
    struct rc_grid *g = grid_of("pressure", "Pa", 6, 2, v);
    struct raster *r = raster_new(g, true, 3, 1, NULL);

    (void)state;
    assert_non_null(r);
    /* columns 0-1: 1 3 5 7; columns 2-3: 0 2 0 0; columns 4-5: NaN 8 6 NaN */
    assert_true(fabs(r->v[0] - 4) <= 4 * rounding && r->none[0] == 0 && r->missing[0] == 0);
    assert_true(fabs(r->v[1] - 2) <= 2 * rounding && r->none[1] == 0.75F);
    assert_true(fabs(r->v[2] - 7) <= 7 * rounding && r->missing[2] == 0.5F);
    raster_free(r);
    r = raster_new(g, true, 6 * 5, 2 * 3, NULL); /* enlarged: every node is a block */
    assert_non_null(r);
    for (size_t j = 0; j < r->h; j++)
        for (size_t i = 0; i < r->w; i++) {
            double wanted = v[j / 3 * 6 + i / 5], got = r->v[j * r->w + i];

            assert_true(isnan(got) == (isnan(wanted) || wanted == 0));
            assert_true(isnan(got) || fabs(got - wanted) <= rounding * wanted);
        }
    raster_free(r);
    rc_grid_free(g);
}

static void
contours_of_a_plane_are_straight(void **state)
{
    double v[7 * 5];
    struct lines l = {0};
    struct rc_grid *g;
    struct raster *r;
    double length = 0;

    (void)state;
    for (size_t k = 0; k < 35; k++)
        v[k] = 2.0 * (double)(k % 7) + 1;
    g = grid_of("height", "m", 7, 5, v);
    r = raster_new(g, false, 7, 5, NULL);
    assert_int_equal(raster_contour(r, 4.5, &l, NULL), RC_OK); /* at column 1.75, middle 2.25 */
    for (size_t k = 0; k < l.n; k++) {
        assert_true(fabs(l.at[k][0] - 2.25) <= 2.25 * rounding);
        assert_true(fabs(l.at[k][2] - 2.25) <= 2.25 * rounding);
        length += fabs(l.at[k][3] - l.at[k][1]);
    }
    assert_true(fabs(length - 4) <= 4 * rounding);
    free(l.at);
    raster_free(r);
    rc_grid_free(g);
}

/* ---- words ---- */

static void
numbers_read_as_people_write_them(void **state)
{
    static const struct {
        double value;
        const char *unit, *text;
    } cases[] = {
        {5.83e9, "Pa", "5.83 GPa"},
        {1e-6, "m", "1 µm"},
        {-4.239e-7, "m", "−423.9 nm"},
        {240, "N", "240 N"},
        {0, "Pa", "0"},
        {999.96, "m", "1 km"},
        {0.31, "1", "0.31"},
        {1e-3, "m/s", "1 mm/s"},
        {0.05, "J/m2", "50 mJ/m²"},
        {2e-5, "rad", "20·10⁻⁶ rad"},
        {3.5e-24, "m4", "3.5·10⁻²⁴ m⁴"},
        {12, "W/m2*K", "12 W/m²·K"},
        {12, "m-1", "12 m⁻¹"},
        {12, "um", "12 µm"},
        {12, "H2O", "12 H2O"},
    };
    static const char *const labels[] = {"−0.2", "0.0", "0.2", "0.4", "0.6"};
    char text[TICKS_TEXT];
    struct ticks t;

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_string_equal(scale_value_to(text, cases[k].value, cases[k].unit), cases[k].text);
    ticks_choose(&t, -0.3, 0.7, 5);
    assert_int_equal(t.last - t.first, 4);
    for (long long k = t.first; k <= t.last; k++)
        assert_string_equal(ticks_text_to(text, &t, k), labels[k - t.first]);
}

static double
slack(double lo, double hi)
{
    return 1e-8 * fmax(fabs(lo), fabs(hi)) + 1e-300;
}

/* Few marks, all within the range: of ranges at the ends of double precision too. */
static void
every_range_has_few_marks(void **state)
{
    static const double ends[] = {0,     5e-324, 1e-310, 2.3e-308, 1e-300,   1,
                                  1e300, 1e307,  9e307,  1.79e308, INFINITY, NAN};
    enum {
        ENDS = sizeof ends / sizeof *ends
    };
    struct ticks t;

    (void)state;
    for (int i = 0; i < 4 * ENDS * ENDS; i++) {
        const double lo = (i & 1 ? -1 : 1) * ends[i / 4 % ENDS],
                     hi = (i & 2 ? -1 : 1) * ends[i / 4 / ENDS];
        if (lo >= hi)
            continue;
        ticks_choose(&t, lo, hi, 5);
        assert_true(t.last - t.first <= 40 && t.last - t.first >= -1);
        if (isfinite(lo) && isfinite(hi))
            for (long long k = t.first; k <= t.last; k++)
                assert_true(ticks_at(&t, k) >= lo - slack(lo, hi) &&
                            ticks_at(&t, k) <= hi + slack(lo, hi));
    }
}

/* ---- text ---- */

enum {
    SIDE = 200 /* pixels of a canvas for text */
};

static const struct canvas_font font = {.size = 40};

/* The extent of the ink: rows and columns from the first to after the last; sum: its amount. */
struct ink {
    size_t left, right, top, bottom;
    unsigned long sum;
};

static struct ink
ink_on(struct canvas *c)
{
    struct ink ink = {SIDE, 0, SIDE, 0, 0};
    unsigned char rgb[3 * SIDE];

    for (size_t y = 0; y < SIDE; y++) {
        assert_int_equal(canvas_row(c, y, rgb, NULL), RC_OK);
        for (size_t x = 0; x < SIDE; x++) {
            if (rgb[3 * x] == 255)
                continue;
            ink.left = x < ink.left ? x : ink.left;
            ink.right = x + 1 > ink.right ? x + 1 : ink.right;
            ink.top = y < ink.top ? y : ink.top;
            ink.bottom = y + 1;
            ink.sum += (unsigned long)(255 - rgb[3 * x]) * (1 + x + SIDE * y);
        }
    }
    return ink;
}

/* Draws the text in the middle, upwards or to the right, and returns its width. */
static struct ink
ink_of(const char *text, bool upwards, double *width)
{
    struct canvas *c = canvas_new(SIDE, SIDE, NULL);
    struct ink ink;

    assert_non_null(c);
    *width = canvas_text_width(c, &font, text);
    if (upwards)
        canvas_text_upwards(c, &font, 100, 100, text);
    else
        canvas_text(c, &font, 100, 100, 0.5, text);
    ink = ink_on(c);
    canvas_free(c);
    return ink;
}

static void
text_lies_where_it_is_measured(void **state)
{
    struct ink flat, upright;
    double w, w2;

    (void)state;
    flat = ink_of("HoH", false, &w);
    assert_true(w > 2 * font.size && w < 3 * font.size);
    assert_true(fabs((double)flat.left - (100 - w / 2)) < 6);
    assert_true(fabs((double)flat.right - (100 + w / 2)) < 6);
    assert_true(flat.bottom >= 100 && flat.bottom <= 102); /* stands on the base line */
    assert_true((double)flat.top > 100 - font.size && (double)flat.top < 100 - 0.6 * font.size);
    upright = ink_of("HoH", true, &w2);
    assert_true(w == w2);
    assert_true(fabs((double)upright.top - (double)flat.left) <= 1);
    assert_true(fabs((double)upright.bottom - (double)flat.right) <= 1);
    assert_true(upright.right >= 100 && upright.right <= 102);
}

static void
raised_digits_are_smaller_and_higher(void **state)
{
    static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    double w, plain, wide;

    (void)state;
    (void)ink_of("m", false, &plain);
    for (int digit = 0; digit < 10; digit++) {
        char text[2] = {(char)('0' + digit), '\0'}, power[16], line[16];
        struct ink own = ink_of(text, false, &wide), high = ink_of(raised[digit], false, &w);
        double ratio = (double)(high.bottom - high.top) / (double)(own.bottom - own.top);

        assert_true(ratio > 0.6 && ratio < 0.8);
        assert_true(fabs(w / wide - 0.7) < 0.02);
        assert_true((double)high.bottom < 100 - 0.25 * font.size && high.top < own.top);
        snprintf(power, sizeof power, "m%s", raised[digit]);
        snprintf(line, sizeof line, "m%s", text);
        (void)ink_of(power, false, &w);
        (void)ink_of(line, false, &wide);
        assert_true(w > plain && w < wide);
    }
}

static void
what_no_font_has_is_a_question_mark_and_told(void **state)
{
    const char *private = "\xf4\x8f\xbf\xbd"; /* U+10FFFD: the last private character */
    struct canvas *c = canvas_new(SIDE, SIDE, NULL), *d = canvas_new(SIDE, SIDE, NULL);
    char text[64], told[64];

    (void)state;
    assert_true(c != NULL && d != NULL);
    canvas_text(c, &font, 100, 60, 0.5, "Ωж²");
    assert_string_equal(canvas_unknown(c), "");
    snprintf(text, sizeof text, "a%sb%s", private, private);
    canvas_text(c, &font, 100, 120, 0.5, text);
    snprintf(told, sizeof told, "%s", canvas_unknown(c));
    assert_string_equal(told, private);
    canvas_text(d, &font, 100, 60, 0.5, "Ωж²");
    canvas_text(d, &font, 100, 120, 0.5, "a?b?");
    assert_int_equal(ink_on(c).sum, ink_on(d).sum);
    canvas_text(d, &font, 100, 180, 0.5, "\xff\xfe"); /* no text, and the program continues */
    assert_int_equal(canvas_check(d, NULL), RC_OK);
    canvas_free(c);
    canvas_free(d);
}

/* ---- chunks ---- */

static void
chunks_say_how_it_was_made(void **state)
{
    static const double v[] = {1e-6, 2e-6, 3e-6, 4e-6};
    struct rc_grid *g = grid_of("height", "m", 2, 2, v);
    char name[128];
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_textp text;
    FILE *file;
    int intent, n, found = 0;

    (void)state;
    assert_int_equal(rc_grid_set(g, "source", "Prüfling 7.x3p", NULL), RC_OK);
    assert_int_equal(rc_grid_history(g, "rc-import 9.9 --format x3p", NULL), RC_OK);
    free(render("--range 0:8um --title 'Prüfling µ'", g).rgb);
    snprintf(name, sizeof name, "%s/out.png", folder);
    file = fopen(name, "rb");
    assert_non_null(file);
    png_init_io(png, file);
    png_read_info(png, info);
    assert_int_equal(png_get_bit_depth(png, info), 8);
    assert_int_equal(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
    assert_true(png_get_sRGB(png, info, &intent));
    assert_false(png_get_valid(png, info, PNG_INFO_tIME));
    n = png_get_text(png, info, &text, NULL);
    for (int k = 0; k < n; k++) {
        if (strcmp(text[k].key, "Title") == 0)
            found += strcmp(text[k].text, "Prüfling µ") == 0;
        if (strcmp(text[k].key, "Source") == 0)
            found += strcmp(text[k].text, "Prüfling 7.x3p") == 0;
        if (strcmp(text[k].key, "Software") == 0)
            found += strncmp(text[k].text, "rc-render ", 10) == 0;
        if (strcmp(text[k].key, "Description") == 0)
            found += strncmp(text[k].text, "rc-import 9.9 --format x3p | rc-render ", 38) == 0 &&
                     strstr(text[k].text, "--range 0:8e-06") != NULL;
    }
    assert_int_equal(found, 4);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(raw_pixels_have_the_colours_of_their_nodes),
        cmocka_unit_test(percentiles_are_ranks),
        cmocka_unit_test(a_peak_with_rising_neighbours_is_not_an_outlier),
        cmocka_unit_test(an_svg_has_the_nodes_at_their_places),
        cmocka_unit_test(both_signs_have_two_colours_from_zero),
        cmocka_unit_test(categories_mix_their_colours),
        cmocka_unit_test(missing_and_no_contact_are_no_values),
        cmocka_unit_test(a_table_has_the_colours_of_the_map),
        cmocka_unit_test(lightness_rises_and_evenly),
        cmocka_unit_test(bluered_is_as_light_on_both_sides),
        cmocka_unit_test(other_eyes_tell_values_apart),
        cmocka_unit_test(cells_are_means_of_what_they_cover),
        cmocka_unit_test(contours_of_a_plane_are_straight),
        cmocka_unit_test(numbers_read_as_people_write_them),
        cmocka_unit_test(every_range_has_few_marks),
        cmocka_unit_test(text_lies_where_it_is_measured),
        cmocka_unit_test(raised_digits_are_smaller_and_higher),
        cmocka_unit_test(what_no_font_has_is_a_question_mark_and_told),
        cmocka_unit_test(chunks_say_how_it_was_made),
    };

    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
