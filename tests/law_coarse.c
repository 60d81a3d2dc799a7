/* A map on fewer nodes keeps its mean and what is linear in it; a pressure that goes back keeps
 * its load; the two ways are each other's transpose: for sizes that divide and sizes that don't. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <stdlib.h>
#include <cmocka.h>

#include "tools/cost/coarse.h"

/* clang-format off */
static const struct {
    struct rc_shape map;
    unsigned factor;
    size_t nx, ny; /* expected */
} cases[] = {
    {{96, 64, 1.1e-6, 1.29e-6}, 4, 24, 16}, {{97, 61, 1e-6, 3e-6}, 4, 24, 15}, {{66, 62, 2, 1}, 8, 8, 8},
    {{33, 47, 1.1, 1}, 2, 17, 24},          {{512, 1, 1, 1}, 8, 64, 1},        {{3, 3, 1, 1}, 8, 1, 1},
};
/* clang-format on */

enum {
    CASES = sizeof cases / sizeof *cases
};

static void
assert_near(double a, double b, double within)
{
    assert_true(fabs(a - b) <= within);
}

static double *
new_map(const struct rc_shape *s, uint64_t seed)
{
    double *v = malloc(s->nx * s->ny * sizeof *v);

    assert_non_null(v);
    for (size_t k = 0; k < s->nx * s->ny; k++) {
        seed = seed * 6364136223846793005U + 1442695040888963407U;
        v[k] = (double)(seed >> 11) / 9007199254740992.0 - 0.3;
    }
    return v;
}

static double
integral(const struct rc_shape *s, const double *v, const double *w)
{
    double sum = 0;

    for (size_t k = 0; k < s->nx * s->ny; k++)
        sum += v[k] * (w == NULL ? 1 : w[k]);
    return sum * s->dx * s->dy;
}

static void
test_area(void **state)
{
    (void)state;
    for (size_t k = 0; k < CASES; k++) {
        const struct rc_shape *f = &cases[k].map;
        struct rc_shape c = coarse_shape(f, cases[k].factor);

        assert_int_equal(c.nx, cases[k].nx);
        assert_int_equal(c.ny, cases[k].ny);
        assert_near((double)c.nx * c.dx / ((double)f->nx * f->dx), 1, 1e-15);
        assert_near((double)c.ny * c.dy / ((double)f->ny * f->dy), 1, 1e-15);
    }
}

static void
test_integrals(void **state)
{
    (void)state;
    for (size_t k = 0; k < CASES; k++) {
        const struct rc_shape *f = &cases[k].map;
        struct rc_shape c = coarse_shape(f, cases[k].factor);
        double *h = new_map(f, 1), *p = new_map(&c, 2), *mean = new_map(&c, 3),
               *spread = new_map(f, 4);
        double area = (double)f->nx * f->dx * (double)f->ny * f->dy;

        coarse_means(f, h, &c, mean);
        coarse_spread(&c, p, f, spread);
        assert_near(integral(&c, mean, NULL), integral(f, h, NULL), 1e-13 * area);
        assert_near(integral(f, spread, NULL), integral(&c, p, NULL), 1e-13 * area);
        assert_near(integral(&c, mean, p), integral(f, h, spread), 1e-13 * area);
        free(h);
        free(p);
        free(mean);
        free(spread);
    }
}

/* Where the sizes divide, the mean of a plane over a block is the plane at its middle; a
 * constant stays one anywhere. */
static void
test_planes(void **state)
{
    (void)state;
    for (size_t k = 0; k < CASES; k++) {
        const struct rc_shape *f = &cases[k].map;
        struct rc_shape c = coarse_shape(f, cases[k].factor);
        double *h = new_map(f, 1), *mean = new_map(&c, 3);
        double slope = f->nx % c.nx == 0 && f->ny % c.ny == 0 ? 0.7 : 0;

        for (size_t i = 0; i < f->nx * f->ny; i++)
            h[i] = 2.5 + slope * ((double)(i % f->nx) + 0.5) / (double)f->nx -
                   0.3 * slope * ((double)(i / f->nx) + 0.5) / (double)f->ny;
        coarse_means(f, h, &c, mean);
        for (size_t i = 0; i < c.nx * c.ny; i++)
            assert_near(mean[i],
                        2.5 + slope * ((double)(i % c.nx) + 0.5) / (double)c.nx -
                            0.3 * slope * ((double)(i / c.nx) + 0.5) / (double)c.ny,
                        1e-13);
        free(h);
        free(mean);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_area),
                                       cmocka_unit_test(test_integrals),
                                       cmocka_unit_test(test_planes)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
