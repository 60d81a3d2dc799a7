/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Means over the cells of another grid keep the integral; if one size is a multiple of the other, they also
 * keep a plane. The transfer back is the transpose of the transfer: for any sizes, to coarser and to finer
 * grids. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <math.h>
#include <stdlib.h>
#include <cmocka.h>

#include "libcontact/contact.h"

/* clang-format off */
static const struct {
    struct rc_shape map;
    size_t nx, ny; /* shape of the other grid */
} cases[] = {
    {{96, 64, 1.1e-6, 1.29e-6}, 24, 16}, {{97, 61, 1e-6, 3e-6}, 24, 15}, {{66, 62, 2, 1}, 8, 8},
    {{33, 47, 1.1, 1}, 17, 24},          {{512, 1, 1, 1}, 64, 1},        {{3, 3, 1, 1}, 1, 1},
    {{33, 47, 1.1, 1}, 33, 47},          {{7, 5, 1, 2}, 5, 7},           {{50, 40, 1, 1}, 49, 39},
};
/* clang-format on */

enum {
    CASES = sizeof cases / sizeof *cases
};

static struct rc_shape
other(size_t k)
{
    const struct rc_shape *s = &cases[k].map;

    return (struct rc_shape){cases[k].nx, cases[k].ny, s->dx * (double)s->nx / (double)cases[k].nx,
                             s->dy * (double)s->ny / (double)cases[k].ny};
}

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
integrals_are_kept_and_the_way_back_is_the_transpose(void **state)
{
    (void)state;
    for (size_t k = 0; k < CASES; k++) {
        const struct rc_shape *f = &cases[k].map;
        struct rc_shape c = other(k);
        double *h = new_map(f, 1), *p = new_map(&c, 2), *mean = new_map(&c, 3),
               *back = new_map(f, 4);
        double area = (double)f->nx * f->dx * (double)f->ny * f->dy;

        rc_resample_means(f, h, &c, mean);
        rc_resample_means(&c, p, f, back);
        assert_near(integral(&c, mean, NULL), integral(f, h, NULL), 1e-13 * area);
        assert_near(integral(f, back, NULL), integral(&c, p, NULL), 1e-13 * area);
        assert_near(integral(&c, mean, p), integral(f, h, back), 1e-13 * area);
        free(h);
        free(p);
        free(mean);
        free(back);
    }
}

/* If one size is a multiple of the other, the mean of a plane over a block is its value at the centre of the
 * block. A constant is kept for all sizes. */
static void
planes_and_constants_stay_what_they_are(void **state)
{
    (void)state;
    for (size_t k = 0; k < CASES; k++) {
        const struct rc_shape *f = &cases[k].map;
        struct rc_shape c = other(k);
        double *h = new_map(f, 1), *mean = new_map(&c, 3);
        double slope = f->nx % c.nx == 0 && f->ny % c.ny == 0 ? 0.7 : 0;

        for (size_t i = 0; i < f->nx * f->ny; i++)
            h[i] = 2.5 + slope * ((double)(i % f->nx) + 0.5) / (double)f->nx -
                   0.3 * slope * ((double)(i / f->nx) + 0.5) / (double)f->ny;
        rc_resample_means(f, h, &c, mean);
        for (size_t i = 0; i < c.nx * c.ny; i++)
            assert_near(mean[i],
                        2.5 + slope * ((double)(i % c.nx) + 0.5) / (double)c.nx -
                            0.3 * slope * ((double)(i / c.nx) + 0.5) / (double)c.ny,
                        1e-13);
        free(h);
        free(mean);
    }
}

/* A single value: each cell of the other grid receives the fraction of the cell that lies in it, by the
 * lengths in metres. */
static void
a_cell_gets_what_lies_in_it(void **state)
{
    (void)state;
    for (size_t k = 0; k < CASES; k++) {
        const struct rc_shape *f = &cases[k].map;
        struct rc_shape c = other(k);
        double *v = new_map(f, 1), *mean = new_map(&c, 2);
        size_t x = f->nx / 2, y = f->ny / 3;

        for (size_t i = 0; i < f->nx * f->ny; i++)
            v[i] = 0;
        v[y * f->nx + x] = 1;
        rc_resample_means(f, v, &c, mean);
        for (size_t i = 0; i < c.nx * c.ny; i++) {
            double a = (double)(i % c.nx) * c.dx, b = (double)(i / c.nx) * c.dy;
            double wide = fmin(a + c.dx, (double)(x + 1) * f->dx) - fmax(a, (double)x * f->dx);
            double high = fmin(b + c.dy, (double)(y + 1) * f->dy) - fmax(b, (double)y * f->dy);

            assert_near(mean[i], fmax(wide, 0) * fmax(high, 0) / (c.dx * c.dy), 1e-13);
        }
        free(v);
        free(mean);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integrals_are_kept_and_the_way_back_is_the_transpose),
        cmocka_unit_test(planes_and_constants_stay_what_they_are),
        cmocka_unit_test(a_cell_gets_what_lies_in_it)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
