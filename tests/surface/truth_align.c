/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rc_align finds the known position of a scan on another one, and the worn volume within its uncertainty. */
#include "scans.h"

/* Bounds: shift .02 nodes, rotation .01 degrees, and the volume within its bar. Errors beyond a bar of 95 %
 * occur in one of twenty cases; these are six of the cases of tests/long/law_align.c. */
static void
test_random(void **state)
{
    struct surface s;

    (void)state;
    srand(91);
    for (int k = 0; k < 6; k++) {
        const struct scans c = random_scans(150, 130);
        struct errors e;
        make_surface(&s, 1);
        e = align_scans(&s, &c);
        if (!(e.shift < 0.02 && e.turn < 0.01 && fabs(e.volume) < e.bar))
            fail_msg(
                "case %d: shift off by %g nodes, rotation by %g degrees, volume by %g of %g m3, "
                "its bar is %g",
                k, e.shift, e.turn, e.volume, e.worn, e.bar);
        assert_true(e.bar < 0.1 * fabs(e.worn));
    }
}

/* A honed surface that has lost the tops of half of its nodes, all over the map. */
static void
test_worn(void **state)
{
    struct surface s;
    struct scans c;
    struct errors e;

    (void)state;
    srand(1005);
    c = worn_scans(150, 130, &s);
    e = align_scans(&s, &c);
    assert_true(c.share > 0.45);
    assert_true(e.shift < 0.02 && e.turn < 0.01);
    assert_true(fabs(e.volume) < e.bar && e.bar < 0.05 * fabs(e.worn));
    assert_true(e.found.residual < 1.1 * sqrt(2) * c.noise);
}

/* Wear of 55 to 76 % of the nodes: the grooves, the lowest 20 % of the unworn surface, give the place. Without
 * them these pairs are refused, or have a wrong place. */
static void
test_heavy_wear(void **state)
{
    struct surface s;

    (void)state;
    srand(97);
    for (int k = 0; k < 6; k++) {
        struct scans c = worn_scans(150, 130, &s);
        struct errors e;
        c.share = uniform(0.55, 0.76);
        c.cut = find_cut(&s, &c);
        c.below = 0.2;
        e = align_scans(&s, &c);
        if (!(e.shift < 0.02 && e.turn < 0.01 && fabs(e.volume) < e.bar))
            fail_msg(
                "case %d, %.0f %% worn: shift off by %g nodes, rotation by %g degrees, volume by "
                "%g of %g m3, its bar is %g",
                k, 100 * c.share, e.shift, e.turn, e.volume, e.worn, e.bar);
        assert_true(e.bar < 0.05 * fabs(e.worn));
    }
}

/* Holes of single nodes and of radii up to 5 nodes: the volume is that of the whole overlap, and a single
 * missing node of B takes 1.6 nodes of the result on average. Six of the cases of tests/long/law_align.c. */
static void
test_holes(void **state)
{
    struct surface s;

    (void)state;
    srand(91);
    for (int k = 0; k < 6; k++) {
        struct scans c = random_scans(150, 130);
        struct errors e;
        add_shares(&c);
        make_surface(&s, 1);
        e = align_scans(&s, &c);
        if (!(e.shift < 0.02 && e.turn < 0.01 && fabs(e.volume) < e.bar))
            fail_msg("case %d: shift off by %g nodes, rotation by %g degrees, volume by %g of %g "
                     "m3, its bar is %g",
                     k, e.shift, e.turn, e.volume, e.worn, e.bar);
        assert_true(fabs(e.found.missing - e.missing / e.on_b) < 1e-3);
        assert_true(fabs(e.found.overlap * (double)(c.a.nx * c.a.ny) / e.on_b - 1) < 1e-3);
        if (c.size == 0) /* by chance the overlap has some holes more */
            assert_true(e.found.missing <
                        1.1 * (1 + 1.61) * c.missing + 8 * sqrt(c.missing / e.on_b));
    }
}

/* Without noise and wear only the spline is left. */
static void
test_clean(void **state)
{
    const struct scans c = {.a = {90, 80, 1e-6, 1.2e-6},
                            .b = {100, 84, 1e-6, 1.2e-6},
                            .shift_x = 3.4e-6,
                            .shift_y = -5.7e-6,
                            .turn = 0.05,
                            .tilt_x = 0.01,
                            .offset = 1e-3};
    struct surface s;
    struct errors e;

    (void)state;
    srand(92);
    make_surface(&s, 1);
    e = align_scans(&s, &c);
    assert_true(e.shift < 2e-3 && e.turn < 2e-3);
    assert_true(fabs(e.found.tilt_x - 0.01) < 1e-4 && fabs(e.found.tilt_y) < 1e-4);
    assert_true(fabs(e.found.offset - 1e-3) < 2e-9);
    assert_true(e.found.residual < 10e-9);
    assert_true(fabs(e.volume) < 1e-10 * 90 * 80 * 1.2e-12); /* 0.1 nm on the whole map */
}

/* Profiles have a shift along x, a tilt and an offset. */
static void
test_profile(void **state)
{
    const struct scans c = {.a = {600, 1, 1e-6, 1e-6},
                            .b = {560, 1, 1e-6, 1e-6},
                            .shift_x = 31.3e-6,
                            .tilt_x = 0.01,
                            .offset = 2e-6,
                            .noise = 5e-9,
                            .groove = 1e-6,
                            .width = 20e-6};
    struct surface s;
    struct errors e;

    (void)state;
    srand(93);
    make_surface(&s, 1);
    e = align_scans(&s, &c);
    assert_true(e.shift < 0.02 && e.turn == 0);
    assert_true(fabs(e.volume) < e.bar && e.bar < 0.1 * fabs(e.worn));
}

static void
test_refusals(void **state)
{
    const struct rc_shape s = {20, 20, 1e-6, 1e-6}, line = {400, 1, 1e-6, 1e-6},
                          other = {20, 20, 2e-6, 1e-6}, small = {20, 12, 1e-6, 1e-6};
    static double h[400], out[400];
    struct rc_alignment found;
    struct rc_err err;

    (void)state;
    srand(94);
    for (int k = 0; k < 400; k++)
        h[k] = chance();
    assert_int_equal(rc_align(&s, h, &other, h, 1, 1, out, &found, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "nodes do not meet"));
    assert_int_equal(rc_align(&s, h, &small, h, 1, 1, out, &found, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "B has 20 x 12 nodes"));
    assert_int_equal(rc_align(&s, h, &line, h, 1, 1, out, &found, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "one is a profile"));
    h[0] = INFINITY;
    assert_int_equal(rc_align(&s, h, &s, h, 1, 1, out, &found, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "A has 1 infinite heights"));
    for (int k = 0; k < 320; k++)
        h[k] = NAN;
    assert_int_equal(rc_align(&s, h, &s, h, 1, 1, out, &found, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "too few for an alignment"));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random),     cmocka_unit_test(test_worn),
        cmocka_unit_test(test_heavy_wear), cmocka_unit_test(test_clean),
        cmocka_unit_test(test_profile),    cmocka_unit_test(test_holes),
        cmocka_unit_test(test_refusals),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
