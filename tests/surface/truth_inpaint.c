/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inpainted points solve Laplace's equation: discrete harmonic surfaces are restored exactly, and small maps
 * agree with a dense solution. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "tests/exact.h"
#include "libcontact/contact.h"

static const double solved =
    1e-10; /* residual of the equations, relative to the range of heights */

typedef double (*surface)(const struct rc_shape *s, size_t i, size_t j);

static double
plane(const struct rc_shape *s, size_t i, size_t j)
{
    return 3e-6 + 0.011 * (double)i * s->dx - 0.017 * (double)j * s->dy;
}

/* x^2 - y^2 + xy: second differences of a square are exact on any spacing. */
static double
saddle(const struct rc_shape *s, size_t i, size_t j)
{
    double x = ((double)i - 5) * s->dx, y = ((double)j - 9) * s->dy;

    return 1e3 * (x * x - y * y + x * y);
}

/* cosh(a i) cos(m pi (j + 1/2) / ny), a such that the five-point stencil gives 0. The normal slope is 0 at
 * the upper and lower edges, half a cell outside of the first and last row. */
static double
membrane(const struct rc_shape *s, size_t i, size_t j)
{
    double k = 3 * exact_pi / (double)s->ny, ratio = s->dx / s->dy;
    double a = acosh(1 + ratio * ratio * (1 - cos(k)));

    return 1e-9 * cosh(a * (double)i) * cos(k * ((double)j + 0.5));
}

static double *
make(const struct rc_shape *s, surface f)
{
    double *h = malloc(s->nx * s->ny * sizeof *h);

    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = 0; i < s->nx; i++)
            h[j * s->nx + i] = f(s, i, j);
    return h;
}

/* Inpaints h, which is `whole` with holes, and compares. */
static void
check_restored(const struct rc_shape *s, double *h, const double *whole)
{
    size_t n = s->nx * s->ny, holes = 0, inpainted;
    double highest = 0;
    struct rc_err err;

    for (size_t k = 0; k < n; k++) {
        holes += isnan(h[k]) ? 1 : 0;
        highest = fmax(highest, fabs(whole[k]));
    }
    assert_true(holes > 0);
    assert_int_equal(rc_inpaint(s, h, &inpainted, &err), RC_OK);
    assert_int_equal(inpainted, holes);
    for (size_t k = 0; k < n; k++)
        if (!(fabs(h[k] - whole[k]) <= solved * highest))
            fail_msg("node %zu: %.17g instead of %.17g", k, h[k], whole[k]);
}

/* Holes of all shapes, none at the edge. */
static void
cut_inside(const struct rc_shape *s, double *h)
{
    srand(99);
    for (size_t j = 1; j + 1 < s->ny; j++)
        for (size_t i = 1; i + 1 < s->nx; i++) {
            double u = (double)i - 14, v = (double)j - 27;
            if (rand() % 3 == 0 || (u * u + v * v < 100 && u * u + v * v > 9))
                h[j * s->nx + i] = NAN;
        }
}

static void
check_inside(surface f)
{
    const struct rc_shape s = {33, 47, 1.1e-6, 1e-6};
    double *whole = make(&s, f), *h = make(&s, f);

    cut_inside(&s, h);
    check_restored(&s, h, whole);
    for (size_t i = 0; i < s.nx; i++)
        assert_true(h[i] == whole[i]); /* measured points keep their bits */
    free(whole);
    free(h);
}

static void
test_plane(void **state)
{
    (void)state;
    check_inside(plane);
}

static void
test_saddle(void **state)
{
    (void)state;
    check_inside(saddle);
}

static void
test_hole_across_the_map(void **state)
{
    const struct rc_shape s = {33, 47, 1.1e-6, 1e-6};
    double *whole = make(&s, membrane), *h = make(&s, membrane);

    (void)state;
    for (size_t j = 0; j < s.ny; j++)
        for (size_t i = 7; i < 29; i++)
            h[j * s.nx + i] = NAN;
    check_restored(&s, h, whole);
    free(whole);
    free(h);
}

/* In a profile it is a straight line between two points, and constant beyond the last one. */
static void
check_profile(struct rc_shape s)
{
    double h[] = {NAN, NAN, 1, NAN, NAN, NAN, 3, NAN};
    const double whole[] = {1, 1, 1, 1.5, 2, 2.5, 3, 3};

    check_restored(&s, h, whole);
}

static void
test_profiles(void **state)
{
    (void)state;
    check_profile((struct rc_shape){8, 1, 1.1e-6, 3e-3});
    check_profile((struct rc_shape){1, 8, 3e-3, 1.1e-6});
}

static void
test_one_point_measured(void **state)
{
    const struct rc_shape s = {13, 9, 2.3e-6, 1e-6};
    double h[13 * 9], whole[13 * 9];

    (void)state;
    for (size_t at = 0; at < 13 * 9; at += 58) {
        for (size_t k = 0; k < 13 * 9; k++) {
            h[k] = NAN;
            whole[k] = -4.5e-6;
        }
        h[at] = -4.5e-6;
        check_restored(&s, h, whole);
    }
}

/* The equations of one node for the Gaussian elimination. */
static void
put_equation(const struct rc_shape *s, const double *h, size_t k, gsl_matrix *a, gsl_vector *b)
{
    size_t i = k % s->nx, j = k / s->nx;
    const struct {
        bool there;
        ptrdiff_t step;
        double d;
    } side[] = {{i > 0, -1, s->dx},
                {i + 1 < s->nx, 1, s->dx},
                {j > 0, -(ptrdiff_t)s->nx, s->dy},
                {j + 1 < s->ny, (ptrdiff_t)s->nx, s->dy}};

    if (!isnan(h[k])) {
        gsl_matrix_set(a, k, k, 1);
        gsl_vector_set(b, k, h[k]);
        return;
    }
    for (size_t m = 0; m < 4; m++)
        if (side[m].there) {
            double w = 1e-12 / (side[m].d * side[m].d);
            size_t other = (size_t)((ptrdiff_t)k + side[m].step);
            gsl_matrix_set(a, k, k, gsl_matrix_get(a, k, k) + w);
            gsl_matrix_set(a, k, other, -w);
        }
}

static void
test_against_gauss(void **state)
{
    enum {
        NX = 11,
        NY = 13,
        N = NX * NY
    };
    const struct rc_shape s = {NX, NY, 2.7e-6, 1e-6};
    gsl_permutation *order = gsl_permutation_alloc(N);
    gsl_matrix *a = gsl_matrix_alloc(N, N);
    gsl_vector *b = gsl_vector_alloc(N), *x = gsl_vector_alloc(N);
    double h[N], whole[N];
    int sign;

    (void)state;
    srand(5);
    for (int share = 20; share <= 95; share += 15) {
        h[0] = 1e-6; /* at least one */
        for (size_t k = 1; k < N; k++)
            h[k] = rand() % 100 < share ? NAN : 1e-6 * rand() / RAND_MAX;
        gsl_matrix_set_zero(a);
        gsl_vector_set_zero(b);
        for (size_t k = 0; k < N; k++)
            put_equation(&s, h, k, a, b);
        gsl_linalg_LU_decomp(a, order, &sign);
        gsl_linalg_LU_solve(a, order, b, x);
        for (size_t k = 0; k < N; k++)
            whole[k] = gsl_vector_get(x, k);
        check_restored(&s, h, whole);
    }
    gsl_permutation_free(order);
    gsl_matrix_free(a);
    gsl_vector_free(b);
    gsl_vector_free(x);
}

static void
test_large_hole_is_quick(void **state)
{
    const struct rc_shape s = {520, 530, 1.1e-6, 1e-6};
    double *whole = make(&s, plane), *h = make(&s, plane);
    clock_t begin;

    (void)state;
    for (size_t j = 12; j < 512; j++)
        for (size_t i = 9; i < 509; i++)
            h[j * s.nx + i] = NAN;
    begin = clock();
    check_restored(&s, h, whole);
    /* it takes about half a second; the bound detects another order of growth */
    assert_true((double)(clock() - begin) / CLOCKS_PER_SEC < 30);
    free(whole);
    free(h);
}

static void
test_nothing_to_do(void **state)
{
    const struct rc_shape s = {2, 2, 1, 1};
    double h[] = {1, 2, 3, 4};
    const double whole[] = {1, 2, 3, 4};
    size_t inpainted = 7;

    (void)state;
    assert_int_equal(rc_inpaint(&s, h, &inpainted, NULL), RC_OK);
    assert_int_equal(inpainted, 0);
    assert_memory_equal(h, whole, sizeof h);
}

static void
test_refusals(void **state)
{
    const struct rc_shape s = {2, 2, 1, 1};
    double nothing[] = {NAN, NAN, NAN, NAN}, infinite[] = {NAN, 1, INFINITY, 2};
    struct rc_err err;
    size_t inpainted;

    (void)state;
    assert_int_equal(rc_inpaint(&s, nothing, &inpainted, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "all 4"));
    assert_int_equal(rc_inpaint(&s, infinite, &inpainted, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "infinite"));
    assert_true(isnan(infinite[0]));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plane),
        cmocka_unit_test(test_saddle),
        cmocka_unit_test(test_hole_across_the_map),
        cmocka_unit_test(test_profiles),
        cmocka_unit_test(test_one_point_measured),
        cmocka_unit_test(test_against_gauss),
        cmocka_unit_test(test_large_hole_is_quick),
        cmocka_unit_test(test_nothing_to_do),
        cmocka_unit_test(test_refusals),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
