/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The width of the widest hole agrees with a search over all pairs of nodes, and with known sizes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

#include "tests/exact.h"
#include "libcontact/contact.h"

enum {
    NODES = 400 * 400
};

/* Twice the largest of the distances to the nearest measured point. */
static double
brute_force(const struct rc_shape *s, const double *h)
{
    double widest = 0;

    for (size_t k = 0; k < s->nx * s->ny; k++) {
        double nearest = INFINITY;

        if (!isnan(h[k]))
            continue;
        for (size_t m = 0; m < s->nx * s->ny; m++)
            if (!isnan(h[m])) {
                double x = ((double)(k % s->nx) - (double)(m % s->nx)) * s->dx;
                double y = ((double)(k / s->nx) - (double)(m / s->nx)) * s->dy;
                nearest = fmin(nearest, hypot(x, y));
            }
        widest = fmax(widest, nearest);
    }
    return 2 * widest;
}

static double
width_of(const struct rc_shape *s, const double *h)
{
    struct rc_err err;
    double width = NAN;

    assert_int_equal(rc_hole_width(s, h, &width, &err), RC_OK);
    return width;
}

static void
check(const struct rc_shape *s, const double *h, double expected)
{
    double width = width_of(s, h);

    if (!(fabs(width - expected) <= rounding * expected))
        fail_msg("%zu x %zu nodes: %.17g, expected %.17g", s->nx, s->ny, width, expected);
}

/* Few and many missing points, in clusters and scattered, with equal and unequal spacings; also maps of one
 * line. */
static void
every_pair_of_nodes(void **state)
{
    static const struct rc_shape shapes[] = {
        {33, 47, 1.1e-6, 1e-6}, {47, 33, 1e-6, 7.3e-6}, {40, 40, 1, 1}, {1, 60, 2, 2},
        {60, 1, 2, 2},          {7, 90, 3e-9, 1e-9},    {2, 2, 1, 5},
    };
    static double h[NODES];

    (void)state;
    srand(4);
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++)
        for (int trial = 0; trial < 12; trial++) {
            const struct rc_shape *s = &shapes[k];
            size_t n = s->nx * s->ny, there = 0;
            double share = trial / 12. + 0.04;

            for (size_t m = 0; m < n; m++)
                h[m] = rand() < share * RAND_MAX ? NAN : 1e-6;
            if (trial % 3 == 2) /* a block of them */
                for (size_t m = n / 5; m < n / 2; m++)
                    h[m] = NAN;
            if (trial == 10) /* a single point is measured */
                for (size_t m = 0; m < n; m++)
                    h[m] = m == n / 3 ? 0 : NAN;
            for (size_t m = 0; m < n; m++)
                there += isnan(h[m]) ? 0 : 1;
            if (there > 0)
                check(s, h, brute_force(s, h));
        }
}

/* A disc of radius 120.3 dx about a node. The nearest measured node is 121 steps away along an axis, or
 * nearer in other directions, but at most a cell beyond the radius. */
static void
a_disc(void **state)
{
    const struct rc_shape s = {400, 400, 0.5e-6, 0.5e-6};
    static double h[NODES];
    double width;

    (void)state;
    for (size_t j = 0; j < s.ny; j++)
        for (size_t i = 0; i < s.nx; i++)
            h[j * s.nx + i] = hypot((double)i - 190, (double)j - 210) <= 120.3 ? NAN : 0;
    width = width_of(&s, h);
    assert_true(width >= 2 * 120.3 * s.dx && width <= 2 * 121 * s.dx * (1 + rounding));
}

static void
strips(void **state)
{
    const struct rc_shape s = {400, 300, 1e-6, 2e-6};
    static double h[NODES];

    (void)state;
    /* 31 columns inside: the middle one is 16 steps from either rim */
    for (size_t k = 0; k < s.nx * s.ny; k++)
        h[k] = k % s.nx >= 100 && k % s.nx < 131 ? NAN : INFINITY;
    check(&s, h, 32e-6);
    /* 31 rows at the edge: the outermost is 31 steps from the only rim */
    for (size_t k = 0; k < s.nx * s.ny; k++)
        h[k] = k / s.nx < 31 ? NAN : 0;
    check(&s, h, 124e-6);
    for (size_t k = 0; k < s.nx * s.ny; k++)
        h[k] = k == 12345 ? NAN : 0;
    check(&s, h, 2e-6);
}

static void
all_and_nothing(void **state)
{
    const struct rc_shape s = {3, 2, 1, 1};
    const double whole[] = {0, 1, 2, 3, 4, 5}, gone[] = {NAN, NAN, NAN, NAN, NAN, NAN};

    (void)state;
    assert_true(width_of(&s, whole) == 0);
    assert_true(isinf(width_of(&s, gone)));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pair_of_nodes),
        cmocka_unit_test(a_disc),
        cmocka_unit_test(strips),
        cmocka_unit_test(all_and_nothing),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
