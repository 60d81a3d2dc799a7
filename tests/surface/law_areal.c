/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Surface parameters do not depend on the position of the surface, its orientation, its units, or the number
 * of threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "libcontact/contact.h"

enum {
    NX = 57,
    NY = 40,
    FIGURES = sizeof(struct rc_areal) / sizeof(double)
};
static const struct rc_shape shape = {NX, NY, 1.1e-6, 1e-6};

static const char *const names[FIGURES] = {
    "sq", "sa",  "ssk", "sku",  "sp",   "sv",  "sz",  "sdq", "sdr", "sal", "str",          "std",
    "sk", "spk", "svk", "smr1", "smr2", "vmp", "vmc", "vvc", "vvv", "sxp", "rms_curvature"};

/* The powers of height and of length in the unit of a parameter. */
static const int of_height[FIGURES] = {1, 1, 0, 0, 1, 1, 1, 1, 2, 0, 0, 0,
                                       1, 1, 1, 0, 0, 1, 1, 1, 1, 1, 1};
static const int of_length[FIGURES] = {[7] = -1, [8] = -2, [9] = 1, [22] = -2};

/* Random heights, some of them missing; slopes of 1e-4, so that Sdr is half their square. */
static void
make(double h[NX * NY], bool holes)
{
    const struct rc_selfaffine what = {
        .hurst = 0.6, .rms_slope = 1e-4, .rolloff = 15e-6, .seed = 12};

    assert_int_equal(rc_synth_selfaffine(&shape, &what, h, NULL), RC_OK);
    for (size_t k = 0; holes && k < NX * NY; k++)
        if (k * 104729 % 11 == 0 || (k / NX > 30 && k % NX > 50))
            h[k] = NAN;
}

static struct rc_areal
measured(const struct rc_shape *s, const double *h, struct rc_boundary boundary, size_t threads)
{
    const struct rc_surface_options options = {.boundary = boundary, .threads = threads};
    struct rc_areal a;
    struct rc_err err;

    if (rc_areal(s, h, &options, &a, &err) != RC_OK)
        fail_msg("%s", err.text);
    return a;
}

static double
figure(const struct rc_areal *a, size_t k)
{
    double v;

    memcpy(&v, (const char *)a + k * sizeof v, sizeof v);
    return v;
}

/* Each parameter of b is that of a, times the factors of height and length to their powers. */
static void
check(const struct rc_areal *a, const struct rc_areal *b, double heights, double lengths,
      double tolerance)
{
    for (size_t k = 0; k < FIGURES; k++) {
        double scale = pow(heights, of_height[k]) * pow(lengths, of_length[k]);
        double got = figure(b, k), expected = scale * figure(a, k);
        if (!(fabs(got - expected) <= tolerance * fmax(fabs(expected), k == 2 ? 1 : 0)))
            fail_msg("%s: %.17g instead of %.17g", names[k], got, expected);
    }
}

static void
test_everything_is_there(void **state)
{
    static double h[NX * NY];

    (void)state;
    for (int turn = 0; turn < 8; turn++) {
        struct rc_areal a;
        make(h, turn & 1);
        a = measured(&shape, h, rc_boundary_of(turn & 2, turn & 4), 1);
        for (size_t k = 0; k < FIGURES; k++)
            if (!isfinite(figure(&a, k)))
                fail_msg("%s of turn %d: %g", names[k], turn, figure(&a, k));
        assert_true(a.sk > 0 && a.spk > 0 && a.svk > 0 && 0 < a.smr1 && a.smr1 < a.smr2 &&
                    a.smr2 < 1);
        assert_true(a.sal > 0 && a.str > 0 && a.str <= 1 && a.std >= 0 && a.std < 180);
    }
}

static void
test_units_and_datum(void **state)
{
    static double h[NX * NY], g[NX * NY];
    const struct rc_shape wide = {NX, NY, 1e3 * shape.dx, 1e3 * shape.dy};

    (void)state;
    for (int turn = 0; turn < 8; turn++) {
        struct rc_boundary boundary = rc_boundary_of(turn & 2, turn & 4);
        struct rc_areal a, b;
        make(h, turn & 1);
        a = measured(&shape, h, boundary, 2);
        for (size_t k = 0; k < NX * NY; k++)
            g[k] = 8 * h[k];
        b = measured(&wide, g, boundary, 2);
        check(&a, &b, 8, 1e3,
              1e-6); /* Sdr: relative to half the square of a slope, its fourth power */
        for (size_t k = 0; k < NX * NY; k++)
            g[k] = h[k] + 1e-6;
        b = measured(&shape, g, boundary, 2);
        check(&a, &b, 1, 1, 1e-9); /* digits lost by the datum */
    }
}

/* A rotation by 180 degrees changes nothing; mirroring left to right reflects the direction about y.
 * Exchanging x and y reflects it about the diagonal of the picture. */
static void
test_turned(void **state)
{
    static double h[NX * NY], g[NX * NY];
    const struct rc_shape tall = {NY, NX, shape.dy, shape.dx};

    (void)state;
    for (int turn = 0; turn < 8; turn++) {
        struct rc_boundary boundary = rc_boundary_of(turn & 2, turn & 4);
        struct rc_areal a, b;
        make(h, turn & 1);
        a = measured(&shape, h, boundary, 2);
        for (size_t k = 0; k < NX * NY; k++)
            g[k] = h[NX * NY - 1 - k];
        b = measured(&shape, g, boundary, 2);
        check(&a, &b, 1, 1, 1e-9);
        for (size_t k = 0; k < NX * NY; k++)
            g[k] = h[k / NX * NX + NX - 1 - k % NX];
        b = measured(&shape, g, boundary, 2);
        b.std = fmod(180 - b.std, 180);
        check(&a, &b, 1, 1, 1e-9);
        for (size_t k = 0; k < NX * NY; k++)
            g[k % NX * NY + k / NX] = h[k];
        b = measured(&tall, g, rc_boundary_of(boundary.y, boundary.x), 2);
        b.std = fmod(270 - b.std, 180);
        check(&a, &b, 1, 1, 1e-9);
    }
}

/* A map that repeats along y is the same surface from any row on, and with two of its periods. */
static void
test_periods(void **state)
{
    static double h[NX * NY], g[2 * NX * NY];
    const struct rc_shape two = {NX, 2 * NY, shape.dx, shape.dy};

    (void)state;
    for (int turn = 0; turn < 4; turn++) {
        const struct rc_boundary boundary = rc_boundary_of(turn & 2, true);
        struct rc_areal a, b;
        make(h, turn & 1);
        a = measured(&shape, h, boundary, 2);
        for (size_t k = 0; k < 2 * NX * NY; k++)
            g[k] = h[(k + 17 * NX) % (NX * NY)];
        b = measured(&shape, g, boundary, 2);
        b.sdq = a.sdq, b.sdr = a.sdr; /* without the steps across the edges */
        check(&a, &b, 1, 1, 1e-9);
        b = measured(&two, g, boundary, 2);
        assert_true(fabs(b.sq / a.sq - 1) < 1e-9 && fabs(b.sku / a.sku - 1) < 1e-9 &&
                    fabs(b.rms_curvature / a.rms_curvature - 1) < 1e-9);
        assert_true(fabs(b.sal / a.sal - 1) < 1e-4); /* along other rays */
    }
}

/* If the sign of the heights changes, peaks and pits are exchanged. */
static void
test_turned_over(void **state)
{
    static double h[NX * NY];
    struct rc_areal a, b;

    (void)state;
    make(h, true);
    a = measured(&shape, h, RC_FREE, 2);
    for (size_t k = 0; k < NX * NY; k++)
        h[k] = -h[k];
    b = measured(&shape, h, RC_FREE, 2);
    assert_true(fabs(a.sp - b.sv) <= rounding * a.sp && fabs(a.sv - b.sp) <= rounding * a.sv);
    assert_true(fabs(a.ssk + b.ssk) <= summed);
    assert_true(fabs(a.spk - b.svk) <= summed * a.spk && fabs(a.svk - b.spk) <= summed * a.svk);
    assert_true(fabs(a.smr1 + b.smr2 - 1) <= summed && fabs(a.smr2 + b.smr1 - 1) <= summed);
}

static void
test_threads(void **state)
{
    static double h[NX * NY];

    (void)state;
    for (int turn = 0; turn < 8; turn++) {
        struct rc_boundary boundary = rc_boundary_of(turn & 2, turn & 4);
        const struct rc_shape large = {570, 400, 1.1e-6, 1e-6};
        double *v = malloc(570 * 400 * sizeof *v);
        struct rc_areal a, b;
        make(h, turn & 1);
        for (size_t k = 0; k < 570 * 400; k++)
            v[k] = h[k / 570 % NY * NX + k % 570 % NX] + 1e-12 * (double)(k * 7919 % 10007);
        a = measured(&large, v, boundary, 1);
        b = measured(&large, v, boundary, 7);
        assert_memory_equal(&a, &b, sizeof a);
        free(v);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_everything_is_there),
        cmocka_unit_test(test_units_and_datum),
        cmocka_unit_test(test_turned),
        cmocka_unit_test(test_periods),
        cmocka_unit_test(test_turned_over),
        cmocka_unit_test(test_threads),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
