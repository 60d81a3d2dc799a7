/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums, moments and slopes of maps agree with closed forms and sums in long double, for any datum and missing
 * points. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "libcontact/contact.h"

enum {
    NX = 33,
    NY = 47
};
static const struct rc_shape shape = {.nx = NX, .ny = NY, .dx = 1.1e-6, .dy = 1e-6};

static void
assert_near(double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance * fabs(expected)))
        fail_msg("%.17g instead of %.17g", got, expected);
}

static void
test_sum_of_what_cancels(void **state)
{
    const double v[] = {1, 1e100, 1, -1e100};

    (void)state;
    assert_true(rc_sum(v, 4) == 2);
    assert_true(rc_sum(v, 0) == 0);
}

static void
test_sum_does_not_wear_out(void **state)
{
    enum {
        N = 3000000
    };
    double *v = malloc(N * sizeof *v);

    (void)state;
    for (size_t k = 0; k < N; k++)
        v[k] = 0.1;
    /* the nearest double to 0.1 times N, rounded once */
    assert_near(rc_sum(v, N), (double)((long double)0.1 * N), DBL_EPSILON);
    free(v);
}

static void
test_sum_keeps_infinity(void **state)
{
    const double v[] = {1, INFINITY, 3};

    (void)state;
    assert_true(rc_sum(v, 3) == INFINITY);
}

/* The plane a i + b j: mean a (nx-1)/2 + b (ny-1)/2, variance a^2 (nx^2-1)/12 + b^2 (ny^2-1)/12. */
static void
check_plane(double a, double b, double datum)
{
    double *h = malloc(sizeof(double[NX * NY]));
    struct rc_statistics s;

    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++)
            h[j * NX + i] = datum + a * (double)i + b * (double)j;
    rc_measure(&shape, h, &s);
    assert_near(s.mean, datum + 0.5 * (a * (NX - 1) + b * (NY - 1)), rounding);
    assert_near(s.rms, sqrt((a * a * (NX * NX - 1.0) + b * b * (NY * NY - 1.0)) / 12), rounding);
    assert_near(s.rms_slope, hypot(a / shape.dx, b / shape.dy), rounding);
    assert_near(s.sum, NX * NY * (datum + 0.5 * (a * (NX - 1) + b * (NY - 1))), rounding);
    assert_true(s.minimum == fmin(h[0], h[(NY - 1) * NX]));
    assert_true(s.maximum == fmax(h[NX * NY - 1], h[NX - 1]));
    assert_int_equal(s.missing, 0);
    assert_int_equal(s.infinite, 0);
    free(h);
}

static void
test_plane(void **state)
{
    (void)state;
    check_plane(3, 2, 0.25);
    check_plane(3, -2, -7);
}

/* Small whole numbers added to 1e6 are exact: no digit of the roughness may be lost. */
static void
test_far_datum(void **state)
{
    (void)state;
    check_plane(0x1p-20, 0x3p-21, 1e6);
}

/* Plain sums over the valid points in long double. */
static void
test_holes(void **state)
{
    double *h = malloc(sizeof(double[NX * NY]));
    long double sum = 0, squares = 0, slopes = 0;
    size_t n = 0, pairs = 0, missing = 0, infinite = 0;
    struct rc_statistics s;

    (void)state;
    srand(4711);
    for (size_t k = 0; k < NX * NY; k++) {
        h[k] = 1e-6 * rand() / RAND_MAX;
        if (rand() % 10 == 0)
            h[k] = NAN;
        else if (rand() % 40 == 0)
            h[k] = rand() % 2 == 0 ? INFINITY : -INFINITY;
        missing += isnan(h[k]) ? 1 : 0;
        infinite += isinf(h[k]) ? 1 : 0;
        n += isfinite(h[k]) ? 1 : 0;
        sum += isfinite(h[k]) ? (long double)h[k] : 0;
    }
    for (size_t k = 0; k < NX * NY; k++)
        if (isfinite(h[k]))
            squares += (h[k] - sum / n) * (h[k] - sum / n);
    for (size_t j = 0; j + 1 < NY; j++)
        for (size_t i = 0; i + 1 < NX; i++) {
            double *at = h + j * NX + i;
            if (!isfinite(at[0]) || !isfinite(at[1]) || !isfinite(at[NX]))
                continue;
            slopes += powl((at[1] - at[0]) / (long double)shape.dx, 2) +
                      powl((at[NX] - at[0]) / (long double)shape.dy, 2);
            pairs++;
        }
    assert_true(missing > 100 && infinite > 10 && pairs > 500);
    rc_measure(&shape, h, &s);
    assert_int_equal(s.missing, missing);
    assert_int_equal(s.infinite, infinite);
    assert_near(s.sum, (double)sum, rounding);
    assert_near(s.mean, (double)(sum / n), rounding);
    assert_near(s.rms, (double)sqrtl(squares / n), rounding);
    assert_near(s.rms_slope, (double)sqrtl(slopes / pairs), rounding);
    free(h);
}

static void
test_profiles_and_points(void **state)
{
    const double v[] = {0, 3, 1, 5};
    const struct rc_shape row = {4, 1, 0.5, 7}, column = {1, 4, 7, 0.5}, point = {1, 1, 1, 1};
    struct rc_statistics s;

    (void)state;
    rc_measure(&row, v, &s);
    assert_near(s.rms_slope, sqrt((36.0 + 16 + 64) / 3), rounding);
    assert_near(s.rms, sqrt((5.0625 + 0.5625 + 1.5625 + 7.5625) / 4), rounding);
    rc_measure(&column, v, &s);
    assert_near(s.rms_slope, sqrt((36.0 + 16 + 64) / 3), rounding);
    rc_measure(&point, v + 1, &s);
    assert_true(s.mean == 3 && s.rms == 0 && isnan(s.rms_slope));
    assert_true(s.minimum == 3 && s.maximum == 3 && s.sum == 3);
}

static void
test_nothing_there(void **state)
{
    const double v[] = {NAN, NAN, INFINITY, NAN};
    const struct rc_shape two = {2, 2, 1, 1};
    struct rc_statistics s;

    (void)state;
    rc_measure(&two, v, &s);
    assert_int_equal(s.missing, 3);
    assert_int_equal(s.infinite, 1);
    assert_true(isnan(s.mean) && isnan(s.rms) && isnan(s.rms_slope) && isnan(s.minimum) &&
                isnan(s.maximum) && s.sum == 0);
}

/* Rows of a map in memory. */
struct rows {
    const struct rc_shape *shape;
    const double *v;
    size_t at, passes;
};

static enum rc_status
again(void *of, struct rc_err *err)
{
    struct rows *r = of;

    (void)err;
    r->at = 0;
    r->passes++;
    return RC_OK;
}

static enum rc_status
next(void *of, size_t n, double *v, struct rc_err *err)
{
    struct rows *r = of;

    if (r->at + n > r->shape->ny)
        return rc_err_set(err, "there are no more rows");
    memcpy(v, r->v + r->at * r->shape->nx, n * r->shape->nx * sizeof *v);
    r->at += n;
    return RC_OK;
}

/* A map row by row has the figures of the map in memory, bit for bit. Pieces of rows end within the map. */
static void
test_rows(void **state)
{
    const struct rc_shape shapes[] = {{37, 4001, 1e-6, 2e-6}, {9001, 29, 1e-6, 1e-6},
                                      {70001, 1, 1e-6, 1e-6}, {1, 70001, 1e-6, 1e-6},
                                      {1, 1, 1e-6, 1e-6},     {11, 3, 1e-6, 1e-6}};
    (void)state;

    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++)
        for (int holes = 0; holes < 3; holes++) {
            const size_t n = shapes[k].nx * shapes[k].ny;
            double *v = malloc(n * sizeof *v);
            struct rows rows = {.shape = &shapes[k], .v = v};
            const struct rc_row_source source = {&rows, again, next, NULL};
            struct rc_statistics whole, by_rows;
            struct rc_err err;
            for (size_t i = 0; i < n; i++)
                v[i] = holes == 2 || (holes == 1 && i % 17 == 3)
                           ? NAN
                           : 0.1 * (double)(i * i % 10007) - 300;
            rc_measure(&shapes[k], v, &whole);
            assert_int_equal(rc_measure_source(&shapes[k], &source, &by_rows, &err), RC_OK);
            assert_memory_equal(&whole, &by_rows, sizeof whole);
            assert_int_equal(rows.passes, holes < 2 ? 2 : 1);
            free(v);
        }
}

static enum rc_status
fails(void *of, size_t n, double *v, struct rc_err *err)
{
    struct rows *r = of;

    return r->passes == 2 && r->at > 0 ? rc_err_set(err, "a cut file") : next(of, n, v, err);
}

/* The sentence of a source that fails, in the second pass too. */
static void
test_source_fails(void **state)
{
    const struct rc_shape long_map = {1, 70001, 1e-6, 1e-6};
    double *v = calloc(70001, sizeof *v);
    struct rows rows = {.shape = &long_map, .v = v};
    const struct rc_row_source source = {&rows, again, fails, NULL};
    struct rc_statistics s;
    struct rc_err err;
    (void)state;

    assert_int_equal(rc_measure_source(&long_map, &source, &s, &err), RC_FAIL);
    assert_string_equal(err.text, "a cut file");
    free(v);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sum_of_what_cancels),
        cmocka_unit_test(test_sum_does_not_wear_out),
        cmocka_unit_test(test_sum_keeps_infinity),
        cmocka_unit_test(test_plane),
        cmocka_unit_test(test_far_datum),
        cmocka_unit_test(test_holes),
        cmocka_unit_test(test_profiles_and_points),
        cmocka_unit_test(test_nothing_there),
        cmocka_unit_test(test_rows),
        cmocka_unit_test(test_source_fails),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
