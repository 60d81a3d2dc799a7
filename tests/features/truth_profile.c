/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parameters of ISO 21920-2 equal closed forms for waves, triangles and steps, with ripples above and below
 * the limit for elements. Along a line of a map cubic interpolation reproduces second-degree surfaces and the
 * values at nodes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

#include "tests/exact.h"
#include "libcontact/contact.h"

static const double dx = 0.5e-6;

static void
near_at(const char *name, double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance * fabs(expected)))
        fail_msg("%s: %.17g instead of %.17g", name, got, expected);
}
#define assert_near(a, name, expected, tolerance) near_at(#name, (a).name, expected, tolerance)

static struct rc_profile
measured(size_t n, const double *z, size_t sections)
{
    struct rc_profile p;
    struct rc_err err;

    if (rc_profile_measure(n, dx, z, sections, &p, &err) != RC_OK)
        fail_msg("%s", err.text);
    return p;
}

/* Ten periods of 40 steps, with crests at nodes. */
static void
test_wave(void **state)
{
    enum {
        N = 400
    };
    const double A = 1.3e-6, q = 2 * exact_pi / 40;
    double z[N], gradient = 0, g = (90 * sin(q) - 18 * sin(2 * q) + 2 * sin(3 * q)) / (60 * dx);
    struct rc_profile p;

    (void)state;
    for (size_t k = 0; k < N; k++)
        z[k] = 2e-6 + A * cos(q * (double)k);
    for (size_t k = 3; k + 3 < N; k++)
        gradient += pow(A * g * sin(q * (double)k), 2) / (N - 6);
    p = measured(N, z, 5);
    assert_near(p, rq, A / sqrt(2), summed);
    assert_near(p, ra, A * 2 / 40 / tan(exact_pi / 40),
                summed); /* the mean of |cos| over 40 nodes, two of them 0 */
    assert_near(p, rku, 1.5, summed);
    assert_true(fabs(p.rsk) < summed);
    assert_near(p, rt, 2 * A, summed);
    assert_near(p, rpt, A, summed);
    assert_near(p, rvt, A, summed);
    assert_near(p, rz, 2 * A, summed);
    assert_near(p, rp, A, summed);
    assert_near(p, rv, A, summed);
    assert_near(p, rsm, 40 * dx, summed);
    assert_near(p, rc, 2 * A, summed);
    assert_int_equal(p.elements, 9); /* the first element begins at the first rising crossing */
    assert_near(p, rdq, sqrt(gradient), summed);
    assert_near(p, rdq, A * q / dx / sqrt(2),
                coarse_grid); /* parameters of the wave itself, over about 10 periods */
}

/* Saw teeth of 10 steps up and 10 down, from -1 to 1 um; one peak and one pit in a flat. */
static void
test_sections(void **state)
{
    enum {
        N = 200
    };
    double z[N];
    struct rc_profile p;

    (void)state;
    for (size_t k = 0; k < N; k++)
        z[k] = 1e-6 * (fabs((double)(k % 20) - 10) / 5 - 1);
    p = measured(N, z, 5);
    assert_near(p, ra, 0.5e-6, summed);
    /* among 20 nodes two each at 1, 0.8, 0.6, 0.4, 0.2 um with either sign, but only one at each extreme, and
     * two at 0 */
    assert_near(p, rq, 1e-6 * sqrt((2 * 1 + 4 * (0.64 + 0.36 + 0.16 + 0.04)) / 20), summed);
    assert_near(p, rz, 2e-6, summed);
    for (size_t k = 0; k < N; k++)
        z[k] = 0;
    z[50] = 5e-6;
    z[150] = -3e-6;
    p = measured(N, z, 5);
    assert_near(p, rt, 8e-6, summed);
    assert_near(p, rz, 8e-6 / 5, summed);
    /* depths about the mean of 2/200 um: 5 um less the mean in one section, and minus the mean in the other
     * four */
    assert_near(p, rp, (5e-6 - 5 * 2e-6 / N) / 5, summed);
    p = measured(N, z, 1);
    assert_near(p, rz, 8e-6, summed);
}

/* A ripple of 4 % of Rz crosses the mean line but is not an element; a ripple of 30 % is. */
static void
test_discrimination(void **state)
{
    enum {
        N = 2000
    };
    double z[N];
    struct rc_profile p;

    (void)state;
    for (int turn = 0; turn < 2; turn++) {
        size_t rising = 0;

        for (size_t k = 0; k < N; k++) {
            double x = 2 * exact_pi * ((double)k + 0.3) / 200;

            z[k] = 1e-6 * (cos(x) + (turn == 0 ? 0.08 : 0.6) * sin(20 * x));
            rising += k > 0 && z[k - 1] < 0 && z[k] >= 0;
        }
        p = measured(N, z, 5);
        assert_true(rising > 15); /* more elements than waves */
        if (turn == 0)
            assert_near(p, rsm, 200 * dx, 1e-3);
        else
            assert_true(p.rsm < 100 * dx && p.elements > 20);
    }
}

static void
test_undefined(void **state)
{
    const double flat[20] = {0}, hole[3] = {1, NAN, 2};
    struct rc_profile p = measured(20, flat, 5);
    struct rc_err err;

    (void)state;
    assert_true(p.ra == 0 && p.rt == 0 && p.rz == 0 && p.rdq == 0);
    assert_true(isnan(p.rsk) && isnan(p.rsm) && isnan(p.rc) && p.elements == 0);
    assert_int_equal(rc_profile_measure(3, dx, hole, 1, &p, &err), RC_FAIL);
    assert_string_equal(err.text, "point 1 of the profile was not measured");
    assert_int_equal(rc_profile_measure(3, dx, flat, 5, &p, &err), RC_FAIL);
    assert_string_equal(err.text, "a profile of 3 points has no 5 sections");
}

static double
second_degree(double x, double y)
{
    return 1e-6 + 0.1 * x - 0.2 * y + 3e3 * x * x + 5e3 * x * y - 4e3 * y * y;
}

static void
test_along(void **state)
{
    enum {
        NX = 30,
        NY = 20,
        N = 57
    };
    const struct rc_shape s = {NX, NY, 1.1e-6, 0.9e-6};
    const struct rc_place from = {-12e-6, 6.1e-6}, to = {13.3e-6, -5.4e-6};
    static double h[NX * NY];
    double z[N];

    (void)state;
    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++)
            h[j * NX + i] = second_degree(((double)i - 14.5) * s.dx, ((double)j - 9.5) * s.dy);
    rc_profile_along(&s, h, from, to, N, z);
    for (size_t k = 0; k < N; k++) {
        double t = (double)k / (N - 1);

        near_at("along", z[k],
                second_degree(from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)), summed);
    }
    h[7 * NX + 3] = NAN; /* a row beside missing points is complete */
    rc_profile_along(&s, h, (struct rc_place){-14.5 * s.dx, -1.5 * s.dy},
                     (struct rc_place){14.5 * s.dx, -1.5 * s.dy}, NX, z);
    for (size_t i = 0; i < NX; i++)
        near_at("row", z[i], h[8 * NX + i], summed);
    rc_profile_along(&s, h, (struct rc_place){-14.5 * s.dx, -2 * s.dy},
                     (struct rc_place){14.5 * s.dx, -2 * s.dy}, NX, z);
    assert_true(isnan(z[3]) && !isnan(z[10]));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wave),           cmocka_unit_test(test_sections),
        cmocka_unit_test(test_discrimination), cmocka_unit_test(test_undefined),
        cmocka_unit_test(test_along),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
