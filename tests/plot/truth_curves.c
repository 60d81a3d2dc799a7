/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points of a curve lie at the right positions between the marks of the axes, linear and logarithmic, and
 * laws follow their published closed forms. */
#include <gsl/gsl_integration.h>

#include "pictures.h"
#include "tools/render/render.h"
#include "tests/exact.h"

static const unsigned blue = 0x0072b2, red = 0xd55e00;

/* ---- axes and points ---- */

static void
marks_of_decades(void **state)
{
    struct picture p;
    struct frame f;
    double mark[64], major[8];
    size_t n;

    (void)state;
    put_file("a.tsv", "load/N\tapproach/m\n0.1\t1e-9\n1000\t1e-6\n");
    p = draw("rc-render --curve load:approach --log -o out.png a.tsv");
    f = find_frame(&p);
    n = find_marks(&p, 1, f.bottom + 8, f.left, f.right, major, 8);
    assert_int_equal(n, 5); /* 0.1 1 10 100 1000 */
    for (size_t k = 1; k + 1 < n; k++)
        assert_near(major[k + 1] - major[k], major[k] - major[k - 1], 1.1);
    n = find_marks(&p, 1, f.bottom + 4, f.left, f.right, mark, 64);
    assert_true(n > 36); /* marks at 2 to 9 of four decades, and the marks beyond the ends */
    for (size_t k = 0, found = 0; k < n; k++) {
        for (int d = 2; d < 10; d++)
            found += fabs(mark[k] - major[1] - log10(d) * (major[2] - major[1])) < 1;
        assert_true(k + 1 < n || found == 8);
    }
    free(p.rgb);
}

/* The position of x, from two marks with known numbers. */
static void
points_of_two_files(void **state)
{
    struct picture p;
    struct frame f;
    double major[16], up[16], x, y;
    size_t n;

    (void)state;
    put_file("a.tsv", "load/N\tapproach/m\n0.2\t3e-9\n");
    put_file("b.jsonl", "{\"load\": 300.0, \"effects\": {\"x\": [1, 2]}, \"approach\": 2e-6}\n");
    p = draw("rc-render --curve load:approach --log -o out.png a.tsv b.jsonl");
    f = find_frame(&p);
    n = find_marks(&p, 1, f.bottom + 8, f.left, f.right, major, 16);
    assert_int_equal(n, 3); /* 1 10 100 N */
    assert_int_equal(find_marks(&p, 0, f.left - 8, f.top, f.bottom, up, 16), 3);
    /* from bottom to top: 10 nm, 100 nm, 1 um */
    assert_true(find_colour(&p, &f, blue, &x, &y) > 50);
    assert_near(x, major[0] + log10(0.2) * (major[2] - major[0]) / 2, 1);
    assert_near(y, up[2] - log10(3e-9 / 1e-8) * (up[2] - up[0]) / 2, 1);
    assert_true(find_colour(&p, &f, red, &x, &y) > 50);
    assert_near(x, major[0] + log10(300) * (major[2] - major[0]) / 2, 1);
    assert_near(y, up[2] - log10(2e-6 / 1e-8) * (up[2] - up[0]) / 2, 1);
    free(p.rgb);

    p = draw("rc-render --curve load:approach -o out.png b.jsonl a.tsv");
    f = find_frame(&p);
    n = find_marks(&p, 1, f.bottom + 8, f.left - 1, f.right, major, 16);
    assert_int_equal(n, 7); /* 0 50 ... 300 N */
    assert_true(find_colour(&p, &f, blue, &x, &y) > 50);
    assert_near(x, major[6], 1);
    free(p.rgb);
}

/* Rows of arrays are curves; a point at 0 is omitted on a logarithmic axis. */
static void
arrays_of_json(void **state)
{
    struct picture p;
    struct frame f;
    double x, y;

    (void)state;
    put_file("p.json", "{\"channel\": \"height\",\n \"psd\": {\"q\": [0, 1e4, 1e5, 1e6],\n"
                       "  \"c\": [5e-20, 1e-20, 1e-22, null], \"window\": \"none\"}}\n"
                       "{\"psd\": {\"q\": [1e4, 1e5], \"c\": [1e-18, 1e-21]}}\n");
    p = draw("rc-render --curve q:psd.c --log xy -o out.png p.json");
    f = find_frame(&p);
    assert_true(find_colour(&p, &f, blue, &x, &y) > 500);
    assert_true(find_colour(&p, &f, red, &x, &y) > 500);
    free(p.rgb);
}

/* Hertz: the approach is proportional to the load to the power 2/3. So the law is a straight line on
 * logarithmic axes, and both points, calculated by hand, lie on it. */
static void
law_is_drawn_through(void **state)
{
    /* R = 7.5 mm, E* = 114 GPa: (9 F^2 / (16 R E*^2))^(1/3) */
    struct picture p;
    struct frame f;
    double x[2], y[2];
    size_t dark = 0;
    char text[256];

    (void)state;
    for (int k = 0; k < 2; k++) {
        double load = k == 0 ? 0.5 : 40;

        snprintf(text, sizeof text, "load/N\tapproach/m\n%.17g\t%.17g\n", load,
                 cbrt(9 * load * load / (16 * 7.5e-3 * 114e9 * 114e9)));
        put_file(k == 0 ? "a.tsv" : "b.tsv", text);
    }
    p = draw("rc-render --curve load:approach --log --law hertz --radius 7.5mm --estar 114GPa -o "
             "out.png a.tsv b.tsv");
    f = find_frame(&p);
    assert_true(find_colour(&p, &f, blue, &x[0], &y[0]) > 20);
    assert_true(find_colour(&p, &f, red, &x[1], &y[1]) > 20);
    for (size_t j = f.top + 2; j < f.bottom - 1; j++)
        for (size_t i = f.left + 2; i < f.right - 1; i++)
            if (is_dark(&p, i, j)) {
                double t = ((double)i - x[0]) / (x[1] - x[0]);

                assert_near((double)j, y[0] + t * (y[1] - y[0]), 4);
                dark++;
            }
    assert_true(dark > 300);
    free(p.rgb);
}

/* ---- curves of frames ---- */

static struct rc_grid *
new_grid(const char *channel, const char *unit, size_t nx, size_t ny)
{
    struct rc_shape shape = {nx, ny, 2e-6, 3e-6};
    struct rc_grid *g = rc_grid_new(&shape, channel, unit, NULL);

    assert_non_null(g);
    memset(g->v, 0, nx * ny * sizeof *g->v);
    return g;
}

/* The line passes through the nodes of the selected row, one of which is higher. */
static void
cut_of_a_map(void **state)
{
    struct rc_grid *g = new_grid("height", "m", 21, 6);
    struct picture p;
    struct frame f;
    double major[16];
    size_t n, top = 0;

    (void)state;
    for (size_t i = 0; i < 21; i++)
        g->v[1 * 21 + i] = 5e-6 * (double)i; /* another row */
    g->v[4 * 21 + 15] = 1e-6;                /* x = 10 um, y = 4.5 um */
    put_stream("g.rcg", &g, 1);
    p = draw("rc-render --cut y=5um -o out.png g.rcg");
    f = find_frame(&p);
    n = find_marks(&p, 1, f.bottom + 8, f.left, f.right, major, 16);
    assert_int_equal(n, 9);                           /* -20 ... 20 um */
    for (size_t j = f.bottom - 2; j > f.top + 2; j--) /* the row with the highest node */
        for (size_t i = f.left + 2; i < f.right - 1; i++)
            if (pixel(&p, i, j) == blue) {
                top = i;
                break;
            }
    assert_near((double)top, major[4] + 2 * (major[5] - major[4]), 1.5); /* 10 um past 0 */
    free(p.rgb);
}

/* Heights whose fraction above v is 1 - sqrt(v): the curve is the parabola v = (1 - fraction)^2. */
static void
material_ratio_of_a_parabola(void **state)
{
    struct rc_grid *g = new_grid("height", "m", 125, 80);
    struct picture p;
    struct frame f;
    double up[16];
    size_t found = 0, n;

    (void)state;
    for (size_t k = 0; k < 10000; k++) /* in a mixed order */
        g->v[k] = pow(((double)(k * 7919 % 10000) + 0.5) / 10000, 2) * 1e-6;
    put_stream("g.rcg", &g, 1);
    p = draw("rc-render --material-ratio -o out.png g.rcg");
    f = find_frame(&p);
    n = find_marks(&p, 0, f.left - 8, f.top, f.bottom + 1, up, 16);
    assert_int_equal(n, 6); /* 0 0.2 ... 1 um: up[0] is 1 um */
    for (size_t i = f.left + 9; i < f.right - 9; i += 7) {
        double share = (double)(i - f.left) / (double)(f.right - f.left);
        double sum = 0, ink = 0;

        for (size_t j = f.top + 2; j < f.bottom - 1; j++)
            if (pixel(&p, i, j) == blue) {
                sum += (double)j;
                ink++;
            }
        if (ink == 0)
            continue;
        assert_near(sum / ink, up[5] - (1 - share) * (1 - share) * (up[5] - up[0]), 2);
        found++;
    }
    assert_true(found > 80);
    free(p.rgb);
}

/* A bin with three nodes is three times as high as a bin with one. */
static void
histogram_of_few(void **state)
{
    struct rc_grid *g = new_grid("pressure", "Pa", 10, 1);
    static const double v[10] = {0, 1.01e9, 1.02e9, 0, 0, 1.03e9, 0, 3.99e9, 0, 0};
    struct picture p;
    struct frame f;
    size_t high[2] = {0, 0}, x[2];
    double major[16];

    (void)state;
    memcpy(g->v, v, sizeof v);
    put_stream("g.rcg", &g, 1);
    p = draw("rc-render --histogram -o out.png g.rcg && rc-render --histogram --verbose -o x.png "
             "g.rcg 2>&1 | grep -q 'out of contact: 60 %'");
    f = find_frame(&p);
    assert_int_equal(find_marks(&p, 1, f.bottom + 8, f.left - 1, f.right, major, 16), 9);
    for (int k = 0; k < 2; k++) { /* GPa: one value lies between 1 and 1.1, one between 3.9 and 4 */
        x[k] = (size_t)(major[0] + (k == 0 ? 1.05 : 3.95) / 0.5 * (major[1] - major[0]));
        for (size_t j = f.top + 1; j < f.bottom; j++) {
            unsigned c = pixel(&p, x[k], j);
            high[k] += (c & 0xff) > (c >> 16) + 40; /* bluish */
        }
    }
    assert_true(high[0] > 300);
    assert_near((double)high[0] / (double)high[1], 3, 0.03);
    free(p.rgb);
}

/* ---- laws ---- */

static const struct law_given steel = {
    .estar = 114e9, .radius = 7.5e-3, .rms_slope = 0.1, .area = 4e-8};

static void
hertz_by_hand(void **state)
{
    double load = 12;
    struct hertz h = hertz(load, 7.5e-3, 114e9);
    const double expected[] = {h.approach, exact_pi * h.a * h.a, h.p0, exact_pi * h.a * h.a / 4e-8};
    const char *const name[] = {"approach", "contact_area", "max_pressure", "contact_fraction"};

    (void)state;
    for (size_t k = 0; k < 4; k++)
        assert_near(law_value("hertz", &steel, "load", load, name[k]) / expected[k], 1, rounding);
    /* the law from the approach back to the load: F = 4/3 E* sqrt(R) d^(3/2) */
    assert_near(law_value("hertz", &steel, "approach", 1e-6, "load") /
                    (4.0 / 3 * 114e9 * sqrt(7.5e-3) * pow(1e-6, 1.5)),
                1, rounding);
    /* the stiffness is the slope of that */
    assert_near(law_value("hertz", &steel, "approach", 1e-6, "stiffness") /
                    (2 * 114e9 * sqrt(7.5e-3 * 1e-6)),
                1, rounding);
}

static double
density(double p, void *mean)
{
    return law_pressure_density(&steel, *(double *)mean, p);
}

static double
moment(double p, void *mean)
{
    return p * density(p, mean);
}

/* The histogram of the whole map: its area is the contact fraction, its first moment the mean pressure. */
static void
persson_adds_up(void **state)
{
    gsl_integration_workspace *w = gsl_integration_workspace_alloc(1000);

    (void)state;
    for (double mean = 0.05e9; mean < 20e9; mean *= 3) {
        double fraction = law_value("persson", &steel, "mean_pressure", mean, "contact_fraction");
        double sum, error;
        gsl_function f = {density, &mean}, g = {moment, &mean};

        gsl_integration_qag(&f, 0, mean + 100e9, 0, 1e-10, 1000, 6, w, &sum, &error);
        assert_near(sum, fraction, 1e-9);
        gsl_integration_qag(&g, 0, mean + 100e9, 0, 1e-10, 1000, 6, w, &sum, &error);
        assert_near(sum / mean, 1, 1e-9);
        assert_near(law_value("persson", &steel, "load", mean * 4e-8, "contact_area") / 4e-8,
                    fraction, rounding);
    }
    /* light loads: A / A0 = sqrt(8 / pi) p / (E* h'), the known slope of the law */
    assert_near(law_value("persson", &steel, "mean_pressure", 1e5, "contact_fraction") /
                    (sqrt(8 / exact_pi) * 1e5 / (114e9 * 0.1)),
                1, 1e-9);
    gsl_integration_workspace_free(w);
}

static void
what_laws_need(void **state)
{
    struct law_given none = {NAN, NAN, NAN, NAN};

    (void)state;
    assert_string_equal(law_lacks("hertz", &none), "--estar");
    none.estar = 1e9;
    assert_string_equal(law_lacks("hertz", &none), "--radius");
    assert_string_equal(law_lacks("persson", &none), "--rms-slope");
    assert_null(law_lacks("hertz", &steel));
    assert_false(law_knows("persson", "load", "approach"));
    assert_false(law_knows("hertz", "load", "area"));
    assert_true(law_needs_area("persson", &steel, "load", "contact_fraction"));
    assert_false(law_needs_area("persson", &steel, "mean_pressure", "contact_fraction"));
    assert_true(law_needs_area("hertz", &steel, "mean_pressure", "approach"));
    assert_false(law_needs_area("hertz", &steel, "load", "approach"));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(marks_of_decades), cmocka_unit_test(points_of_two_files),
        cmocka_unit_test(arrays_of_json),   cmocka_unit_test(law_is_drawn_through),
        cmocka_unit_test(cut_of_a_map),     cmocka_unit_test(material_ratio_of_a_parabola),
        cmocka_unit_test(histogram_of_few), cmocka_unit_test(hertz_by_hand),
        cmocka_unit_test(persson_adds_up),  cmocka_unit_test(what_laws_need),
    };

    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
