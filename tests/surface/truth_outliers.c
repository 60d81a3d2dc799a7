/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rc_outliers removes the same points as a method that sorts every neighbourhood, also at edges and beside
 * missing points. rc_taper multiplies the heights above the mean by a raised cosine. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "maps.h"

static int
by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return x < y ? -1 : x > y;
}

/* The median of valid values; sorts v. */
static double
median(double *v, size_t n)
{
    size_t count = 0;

    for (size_t k = 0; k < n; k++)
        if (!isnan(v[k]))
            v[count++] = v[k];
    qsort(v, count, sizeof *v, by_size);
    return count == 0 ? NAN : (v[(count - 1) / 2] + v[count / 2]) / 2;
}

static double
difference(const struct rc_shape *s, struct rc_boundary boundary, const double *h, long i, long j)
{
    long nx = (long)s->nx, ny = (long)s->ny;
    double around[24];
    size_t n = 0;

    for (long b = j - 2; b <= j + 2; b++)
        for (long a = i - 2; a <= i + 2; a++) {
            bool inside = (boundary.x || (a >= 0 && a < nx)) && (boundary.y || (b >= 0 && b < ny));
            if (a == i && b == j)
                continue;
            if (inside)
                around[n++] = h[(b + 4 * ny) % ny * nx + (a + 4 * nx) % nx];
        }
    return h[j * nx + i] - median(around, n);
}

/* Removes the outliers of h by sorting; returns their number. */
static size_t
by_sorting(const struct rc_shape *s, double times, struct rc_boundary boundary, double *h)
{
    size_t n = s->nx * s->ny, count = 0;
    double *d = new_map(s), *v = new_map(s), middle, limit;

    for (size_t k = 0; k < n; k++)
        v[k] = d[k] = difference(s, boundary, h, (long)(k % s->nx), (long)(k / s->nx));
    middle = median(v, n);
    for (size_t k = 0; k < n; k++)
        v[k] = fabs(d[k] - middle);
    limit = times * 1.4826 * median(v, n);
    for (size_t k = 0; k < n; k++)
        if (fabs(d[k]) > limit) {
            h[k] = NAN;
            count++;
        }
    free(d);
    free(v);
    return count;
}

static void
check_outliers(const struct rc_shape *s, double times, struct rc_boundary boundary, int missing,
               double step)
{
    size_t n = s->nx * s->ny, count, expected;
    double *h = new_map(s), *sorted = new_map(s);
    struct rc_err err;

    for (size_t k = 0; k < n; k++) {
        h[k] = 1e-3 + 1e-6 * chance() + (rand() % 20 == 0 ? 9e-6 * chance() : 0);
        h[k] = step > 0 ? step * round(h[k] / step) : h[k];
        if (rand() % 100 < missing)
            h[k] = NAN;
    }
    memcpy(sorted, h, n * sizeof *h);
    expected = by_sorting(s, times, boundary, sorted);
    assert_int_equal(rc_outliers(s, times, boundary, 2, h, &count, &err), RC_OK);
    if (count != expected)
        fail_msg("%zu x %zu, %d %% missing: %zu outliers, not %zu", s->nx, s->ny, missing, count,
                 expected);
    for (size_t k = 0; k < n; k++)
        assert_true(isnan(sorted[k]) ? isnan(h[k]) : h[k] == sorted[k]);
    free(h);
    free(sorted);
}

static void
test_as_by_sorting(void **state)
{
    const struct rc_shape shapes[] = {{61, 47, 1e-6, 1e-6},
                                      {8, 5, 1e-6, 1e-6},
                                      {3, 4, 1e-6, 1e-6},
                                      {97, 1, 1e-6, 1e-6},
                                      {1, 97, 1e-6, 1e-6}};

    (void)state;
    srand(51);
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++)
        for (int missing = 0; missing <= 90; missing += 30)
            for (int turn = 0; turn < 4; turn++) {
                const struct rc_boundary boundary = rc_boundary_of(turn & 1, turn & 2);
                check_outliers(&shapes[k], 3, boundary, missing, 0);
                check_outliers(&shapes[k], 1, boundary, missing, 0);
                check_outliers(&shapes[k], 2, boundary, missing, 0.25e-6); /* many alike */
            }
}

/* In Gaussian noise 0.27 % of the points are beyond three standard deviations; all spikes are found. */
static void
test_share_of_noise(void **state)
{
    const struct rc_shape s = {400, 500, 1e-6, 1e-6};
    size_t n = s.nx * s.ny, count;
    double *h = new_map(&s);
    struct rc_err err;

    (void)state;
    srand(52);
    for (size_t k = 0; k < n; k++) {
        double u = (rand() + 1.0) / (RAND_MAX + 2.0), v = (rand() + 1.0) / (RAND_MAX + 2.0);
        h[k] = 1e-7 * sqrt(-2 * log(u)) * cos(2 * exact_pi * v);
    }
    assert_int_equal(rc_outliers(&s, 3, RC_FREE, 0, h, &count, &err), RC_OK);
    /* counts scatter by their square root; the median of 24 neighbours adds its own scatter */
    assert_true(fabs((double)count - 0.0027 * (double)n) < 4 * sqrt(0.0027 * (double)n));
    for (size_t k = 0; k < n; k++)
        h[k] = 1e-5 * cos((double)(k % s.nx) / 40) + 1e-7 * chance() + (k % 97 == 3 ? 1e-5 : 0);
    assert_int_equal(rc_outliers(&s, 20, RC_FREE, 0, h, &count, &err), RC_OK);
    for (size_t k = 0; k < n; k++)
        assert_true(isnan(h[k]) == (k % 97 == 3));
    free(h);
}

static void
test_taper(void **state)
{
    const struct rc_shape s = {40, 33, 1.1e-6, 1e-6};
    const double width = 7.3e-6;
    double *h = new_map(&s), *before = new_map(&s), mean = 0, n = 0;
    size_t columns, rows;
    struct rc_err err;

    (void)state;
    srand(53);
    for (size_t k = 0; k < 40 * 33; k++) {
        before[k] = h[k] = rand() % 5 == 0 ? NAN : 1e-3 + 1e-6 * chance();
        if (!isnan(h[k])) {
            mean += h[k] - 1e-3;
            n++;
        }
    }
    mean = 1e-3 + mean / n;
    assert_int_equal(rc_taper(&s, width, h, &err), RC_OK);
    rc_taper_frame(&s, width, &columns, &rows);
    assert_int_equal(columns, 7); /* 6.5 * 1.1 um is below 7.3 um, 7.5 * 1.1 um is not */
    assert_int_equal(rows, 7);    /* 6.5 um is, 7.5 um is not */
    rc_taper_frame(&(struct rc_shape){40, 1, 1.1e-6, 1.1e-6}, 1, &columns, &rows);
    assert_true(columns == 20 &&
                rows == 0); /* at most half, and none along the single row of a profile */
    for (size_t k = 0; k < 40 * 33; k++) {
        double x = ((double)(k % 40) + 0.5) * s.dx, y = ((double)(k / 40) + 0.5) * s.dy, w = 1;
        x = fmin(x, 40 * s.dx - x);
        y = fmin(y, 33 * s.dy - y);
        w *= x < width ? (1 - cos(exact_pi * x / width)) / 2 : 1;
        w *= y < width ? (1 - cos(exact_pi * y / width)) / 2 : 1;
        if (isnan(before[k]))
            assert_true(isnan(h[k]));
        else if (x >= width && y >= width)
            assert_true(h[k] == before[k]);
        else
            assert_true(fabs(h[k] - mean - w * (before[k] - mean)) <= 2 * 0x1p-53 * 1e-3);
    }
    free(h);
    free(before);
}

/* A profile has only two ends. */
static void
test_taper_of_a_profile(void **state)
{
    const struct rc_shape s = {10, 1, 1e-6, 1e-6};
    double h[10] = {1, 1, 1, 1, 1, -1, -1, -1, -1, -1};
    struct rc_err err;

    (void)state;
    assert_int_equal(rc_taper(&s, 2e-6, h, &err), RC_OK);
    assert_true(fabs(h[0] - (1 - sqrt(0.5)) / 2) < rounding);
    assert_true(fabs(h[9] + (1 - cos(exact_pi / 4)) / 2) < rounding);
    assert_true(fabs(h[1] - (1 + sqrt(0.5)) / 2) < rounding);
    assert_true(h[2] == 1 && h[7] == -1);
}

static void
refused(enum rc_status status, const struct rc_err *err, const char *reason)
{
    assert_int_equal(status, RC_FAIL);
    if (strstr(err->text, reason) == NULL)
        fail_msg("'%s' does not say '%s'", err->text, reason);
}

static void
test_refusals(void **state)
{
    const struct rc_shape s = {10, 6, 1e-6, 2e-6};
    double h[60] = {0};
    struct rc_err err;
    size_t count;

    (void)state;
    refused(rc_taper(&s, 5.1e-6, h, &err), &err, "wider than half the map, 5e-06 m");
    refused(rc_taper(&s, 1.9e-6, h, &err), &err, "narrower than a node, 2e-06 m");
    refused(rc_taper(&s, NAN, h, &err), &err, "narrower than a node");
    refused(rc_outliers(&s, 0, RC_FREE, 1, h, &count, &err), &err, "must be above 0");
    h[7] = INFINITY;
    refused(rc_taper(&s, 3e-6, h, &err), &err, "1 infinite heights");
    refused(rc_outliers(&s, 3, RC_FREE, 1, h, &count, &err), &err, "1 infinite heights");
    for (size_t k = 0; k < 60; k++)
        h[k] = NAN;
    refused(rc_taper(&s, 3e-6, h, &err), &err, "all 60 heights are missing");
    assert_int_equal(rc_outliers(&s, 3, RC_FREE, 1, h, &count, &err), RC_OK);
    assert_int_equal(count, 0);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_as_by_sorting), cmocka_unit_test(test_share_of_noise),
        cmocka_unit_test(test_taper),         cmocka_unit_test(test_taper_of_a_profile),
        cmocka_unit_test(test_refusals),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
