/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rc_filter is the Gaussian regression filter of order 0: its weighting function and its transmission are the
 * formulas of ISO 16610-61. With missing points, at edges and with robust weights it agrees with explicit
 * sums. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "maps.h"

enum {
    NX = 47,
    NY = 61,
    N = NX * NY
};
static const struct rc_shape shape = {.nx = NX, .ny = NY, .dx = 1.1e-6, .dy = 1e-6};

/* Random heights of about a micrometre, one in four missing. */
static double *
rough(const struct rc_shape *s)
{
    double *h = new_map(s);

    for (size_t k = 0; k < s->nx * s->ny; k++)
        h[k] = rand() % 4 == 0 ? NAN : 1e-6 * chance() + 3e-6;
    return h;
}

static double *
copy_of(const struct rc_shape *s, const double *h)
{
    double *copy = new_map(s);

    memcpy(copy, h, s->nx * s->ny * sizeof *h);
    return copy;
}

static void
filter(const struct rc_shape *s, struct rc_filter what, double *h)
{
    struct rc_err err;

    if (rc_filter(s, &what, h, &err) != RC_OK)
        fail_msg("cut-off %g: %s", what.cutoff, err.text);
}

/* ---- the sums written out ---- */

/* The factor of the weighting function along one side at a distance of `steps` nodes. If it repeats, this is
 * the sum over all repetitions within its range. */
static double
factor(long steps, double d, size_t n, double cutoff, bool repeats)
{
    double a = sqrt(log(2) / exact_pi) * cutoff, w = 0;
    long far = repeats ? 5 : 0;

    for (long p = -far; p <= far; p++) {
        double x = (double)(steps + p * (long)n) * d / a;
        w += exp(-exact_pi * x * x);
    }
    return w;
}

/* The low-pass of h with weights m (NULL: 1), at every measured point. */
static double *
dense(const struct rc_shape *s, double cutoff, struct rc_boundary boundary, const double *h,
      const double *m)
{
    double *low = new_map(s);
    long nx = (long)s->nx, ny = (long)s->ny;
    double *fx = malloc((size_t)(2 * nx) * sizeof *fx), *fy = malloc((size_t)(2 * ny) * sizeof *fy);

    for (long i = 0; i < 2 * nx; i++)
        fx[i] = factor(i - nx, s->dx, s->nx, cutoff, boundary.x);
    for (long j = 0; j < 2 * ny; j++)
        fy[j] = factor(j - ny, s->dy, s->ny, cutoff, boundary.y);
    for (long k = 0; k < nx * ny; k++) {
        long double above = 0, below = 0;
        for (long l = 0; l < nx * ny; l++) {
            long double w = fx[l % nx - k % nx + nx] * (long double)fy[l / nx - k / nx + ny];
            if (isnan(h[l]))
                continue;
            w *= m == NULL ? 1 : m[l];
            above += w * h[l];
            below += w;
        }
        low[k] = isnan(h[k]) ? NAN : (double)(above / below);
    }
    free(fx);
    free(fy);
    return low;
}

static void
compare(const struct rc_shape *s, const double *found, const double *expected, double tolerance,
        const char *what)
{
    for (size_t k = 0; k < s->nx * s->ny; k++) {
        if (isnan(expected[k]) != isnan(found[k]))
            fail_msg("%s: point %zu is %g, not %g", what, k, found[k], expected[k]);
        if (fabs(found[k] - expected[k]) > tolerance)
            fail_msg("%s: point %zu is %.17g, not %.17g", what, k, found[k], expected[k]);
    }
}

/* Short and long cut-offs up to the length of the map; from 30 nodes on the filter sums on coarser nodes. */
static void
check_dense(const struct rc_shape *s, double cutoff, struct rc_boundary boundary)
{
    double *h = rough(s), *low = copy_of(s, h), *high = copy_of(s, h), *expected;
    char what[80];

    snprintf(what, sizeof what, "cut-off %g, %s", cutoff, rc_boundary_word(boundary));
    expected = dense(s, cutoff, boundary, h, NULL);
    filter(s, (struct rc_filter){.cutoff = cutoff, .boundary = boundary}, low);
    filter(s, (struct rc_filter){.cutoff = cutoff, .boundary = boundary, .high = true}, high);
    compare(s, low, expected, summed * 4e-6, what);
    for (size_t k = 0; k < s->nx * s->ny; k++)
        assert_true(isnan(h[k]) || fabs(low[k] + high[k] - h[k]) <= of_sum * 4e-6);
    free(h);
    free(low);
    free(high);
    free(expected);
}

static void
test_missing_points_and_edges(void **state)
{
    const double cutoffs[] = {2.2e-6, 5.3e-6, 17e-6, 31e-6, 33.5e-6, 50e-6, 61e-6};

    (void)state;
    srand(31);
    for (size_t k = 0; k < sizeof cutoffs / sizeof *cutoffs; k++) {
        check_dense(&shape, cutoffs[k], RC_FREE);
        check_dense(&shape, cutoffs[k], RC_PERIODIC);
        check_dense(&shape, cutoffs[k], rc_boundary_of(true, false));
        check_dense(&shape, cutoffs[k], rc_boundary_of(false, true));
    }
}

static void
test_profiles(void **state)
{
    const struct rc_shape row = {397, 1, 1.1e-6, 1e-6}, column = {1, 397, 1e-6, 1.1e-6};
    const double cutoffs[] = {2.2e-6, 20e-6, 80e-6, 436e-6};

    (void)state;
    srand(32);
    for (size_t k = 0; k < sizeof cutoffs / sizeof *cutoffs; k++)
        for (int turn = 0; turn < 4; turn++) {
            check_dense(&row, cutoffs[k], rc_boundary_of(turn & 1, turn & 2));
            check_dense(&column, cutoffs[k], rc_boundary_of(turn & 1, turn & 2));
        }
}

/* A point of height 1 in a wide plain becomes the weighting function, times the area of its
 * cell. */
static void
test_weighting_function(void **state)
{
    const struct rc_shape s = {241, 283, 1.1e-6, 1e-6};
    const double cutoffs[] = {10e-6, 45e-6};

    (void)state;
    for (size_t c = 0; c < 2; c++) {
        double a = sqrt(log(2) / exact_pi) * cutoffs[c], *h = new_map(&s);
        for (size_t k = 0; k < s.nx * s.ny; k++)
            h[k] = k == 141 * s.nx + 120 ? 1 : 0;
        filter(&s, (struct rc_filter){.cutoff = cutoffs[c]}, h);
        /* away from the edges, where weights are missing */
        for (size_t j = 90; j < 193; j++)
            for (size_t i = 70; i < 171; i++) {
                double x = ((double)i - 120) * s.dx / a, y = ((double)j - 141) * s.dy / a;
                double weight = exp(-exact_pi * (x * x + y * y)) * s.dx * s.dy / (a * a);
                if (fabs(h[j * s.nx + i] - weight) > 1e-6 * s.dx * s.dy / (a * a))
                    fail_msg("(%zu, %zu): %.9g, not %.9g", i, j, h[j * s.nx + i], weight);
            }
        free(h);
    }
}

/* A wave of the wavelength l keeps exp(-pi (alpha L / l)^2) of its height: half at L. */
static void
test_transmission(void **state)
{
    const struct rc_shape s = {360, 270, 1e-6, 1.2e-6};
    const double cutoffs[] = {12e-6, 40e-6, 90e-6};
    const size_t waves[][2] = {{0, 1}, {1, 0}, {3, 2}, {4, 0}, {9, 0}, {0, 27}, {30, 0}, {20, 20}};

    (void)state;
    for (size_t c = 0; c < 3; c++)
        for (size_t w = 0; w < sizeof waves / sizeof *waves; w++) {
            double qx = (double)waves[w][0] / 360e-6, qy = (double)waves[w][1] / 324e-6;
            double gain = exp(-log(2) * cutoffs[c] * cutoffs[c] * (qx * qx + qy * qy));
            double *h = new_map(&s), *wave;
            for (size_t k = 0; k < s.nx * s.ny; k++)
                h[k] = cos(0.3 +
                           2 * exact_pi *
                               (qx * (double)(k % s.nx) * s.dx + qy * (double)(k / s.nx) * s.dy));
            wave = copy_of(&s, h);
            if (qy == 0 && qx * cutoffs[c] > 1 - 1e-9 && qx * cutoffs[c] < 1 + 1e-9)
                assert_true(fabs(gain - 0.5) < rounding);
            filter(&s, (struct rc_filter){.cutoff = cutoffs[c], .boundary = RC_PERIODIC}, h);
            for (size_t k = 0; k < s.nx * s.ny; k++)
                if (fabs(h[k] - gain * wave[k]) > 1e-6)
                    fail_msg("cut-off %g, wave %zu: %.9g, not %.9g", cutoffs[c], w, h[k],
                             gain * wave[k]);
            free(h);
            free(wave);
        }
}

/* A datum of one millimetre added to micrometre heights costs only the last digit of a millimetre; a flat
 * stays flat. */
static void
test_datum(void **state)
{
    const double datum = 1e-3, last = 0x1p-53 * 1e-3;
    double *h, *shifted, *flat = new_map(&shape);

    (void)state;
    srand(33);
    h = rough(&shape);
    shifted = new_map(&shape);
    for (size_t k = 0; k < N; k++) {
        shifted[k] = h[k] + datum;
        h[k] = shifted[k] - datum; /* the same heights to the last digit */
        flat[k] = datum;
    }
    filter(&shape, (struct rc_filter){.cutoff = 40e-6, .high = true}, h);
    filter(&shape, (struct rc_filter){.cutoff = 40e-6, .high = true}, shifted);
    filter(&shape, (struct rc_filter){.cutoff = 40e-6, .high = true}, flat);
    compare(&shape, shifted, h, 2 * last, "with a datum");
    for (size_t k = 0; k < N; k++)
        assert_true(fabs(flat[k]) <= last);
    free(h);
    free(shifted);
    free(flat);
}

/* ---- reweighted ---- */

static int
by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return x < y ? -1 : x > y;
}

static double
median_size(const double *r, size_t n)
{
    double *sorted = malloc(n * sizeof *sorted), median;
    size_t count = 0;

    for (size_t k = 0; k < n; k++)
        if (!isnan(r[k]))
            sorted[count++] = fabs(r[k]);
    qsort(sorted, count, sizeof *sorted, by_size);
    median = (sorted[(count - 1) / 2] + sorted[count / 2]) / 2;
    free(sorted);
    return median;
}

/* Waves with noise, and spikes at one point in ten. */
static double *
spiky(void)
{
    double *h = new_map(&shape);

    for (size_t k = 0; k < N; k++) {
        h[k] = 1e-6 * cos((double)(k % NX) / 9) + 0.05e-6 * chance() + 2e-6;
        if (rand() % 10 == 0)
            h[k] += 20e-6;
        if (rand() % 4 == 0)
            h[k] = NAN;
    }
    return h;
}

static void
test_robust_is_reweighting(void **state)
{
    const double cutoffs[] = {7e-6, 42e-6, 9e-6, 35e-6};

    (void)state;
    srand(34);
    for (size_t c = 0; c < 4; c++) {
        const struct rc_boundary boundary = rc_boundary_of(c == 1 || c == 3, c == 1 || c == 2);
        double *h = spiky(), *low = copy_of(&shape, h), *r = new_map(&shape), *m = new_map(&shape);
        double *expected = dense(&shape, cutoffs[c], boundary, h, NULL), reach = 0, before;
        do {
            before = reach;
            for (size_t k = 0; k < N; k++)
                r[k] = h[k] - expected[k];
            reach = 4.4478 * median_size(r, N);
            if (fabs(reach - before) <= 1e-3 * before)
                break;
            for (size_t k = 0; k < N; k++)
                m[k] = fabs(r[k]) < reach ? pow(1 - r[k] * r[k] / (reach * reach), 2) : 0;
            free(expected);
            expected = dense(&shape, cutoffs[c], boundary, h, m);
        } while (true);
        filter(&shape,
               (struct rc_filter){.cutoff = cutoffs[c], .robust = true, .boundary = boundary}, low);
        compare(&shape, low, expected, 1e-10 * 2e-5, "robust");
        free(h);
        free(low);
        free(r);
        free(m);
        free(expected);
    }
}

/* Spikes of ten micrometres, which would raise the filtered surface by one, raise it by less than the
 * noise. */
static void
test_spikes_are_left_out(void **state)
{
    double *with = new_map(&shape), *without = new_map(&shape), *plain, worst = 0, usual = 0;

    (void)state;
    srand(35);
    for (size_t k = 0; k < N; k++) {
        without[k] = 0.1e-6 * chance();
        with[k] = without[k] + (rand() % 10 == 0 ? 10e-6 : 0);
    }
    plain = copy_of(&shape, with);
    filter(&shape, (struct rc_filter){.cutoff = 20e-6}, without);
    filter(&shape, (struct rc_filter){.cutoff = 20e-6}, plain);
    filter(&shape, (struct rc_filter){.cutoff = 20e-6, .robust = true}, with);
    for (size_t k = 0; k < N; k++) {
        worst = fmax(worst, fabs(with[k] - without[k]));
        usual = fmax(usual, fabs(plain[k] - without[k]));
    }
    assert_true(usual > 1e-6);
    if (worst > 0.05e-6) /* half of the noise */
        fail_msg("spikes move it by %g m", worst);
    free(with);
    free(without);
    free(plain);
}

/* More than half of the points have exactly the same height, the others are far away. */
static void
test_exact_ground(void **state)
{
    double *h = new_map(&shape);

    (void)state;
    srand(36);
    for (size_t k = 0; k < N; k++)
        h[k] = 5e-6 + (rand() % 5 == 0 ? 1e-6 : 0);
    filter(&shape, (struct rc_filter){.cutoff = 12e-6, .robust = true}, h);
    for (size_t k = 0; k < N; k++)
        assert_true(fabs(h[k] - 5e-6) <= summed * 5e-6);
    free(h);
}

/* ---- threads and unusual calls ---- */

static void
test_threads_and_high(void **state)
{
    double *h, *one, *many;

    (void)state;
    srand(37);
    for (int robust = 0; robust < 2; robust++) {
        const struct rc_shape s = {131, 257, 1e-6, 1e-6};
        h = rough(&s);
        one = copy_of(&s, h);
        many = copy_of(&s, h);
        filter(&s, (struct rc_filter){.cutoff = 35e-6, .robust = robust, .threads = 1}, one);
        filter(&s, (struct rc_filter){.cutoff = 35e-6, .robust = robust, .threads = 3}, many);
        for (size_t k = 0; k < s.nx * s.ny; k++)
            assert_true(isnan(h[k]) ? isnan(many[k]) : one[k] == many[k]);
        memcpy(many, h, s.nx * s.ny * sizeof *h);
        filter(&s, (struct rc_filter){.cutoff = 35e-6, .robust = robust, .high = true}, many);
        for (size_t k = 0; k < s.nx * s.ny; k++)
            assert_true(isnan(h[k]) || fabs(one[k] + many[k] - h[k]) <= of_sum * 4e-6);
        free(h);
        free(one);
        free(many);
    }
}

static void
check_refused(const struct rc_shape *s, double cutoff, double *h, const char *reason)
{
    double *before = copy_of(s, h);
    struct rc_err err;

    assert_int_equal(rc_filter(s, &(struct rc_filter){.cutoff = cutoff}, h, &err), RC_FAIL);
    if (strstr(err.text, reason) == NULL)
        fail_msg("'%s' does not say '%s'", err.text, reason);
    assert_memory_equal(h, before, s->nx * s->ny * sizeof *h);
    free(before);
}

static void
test_refusals(void **state)
{
    const struct rc_shape profile = {NX * NY, 1, 1e-6, 5e-6};
    double *h;

    (void)state;
    srand(38);
    h = rough(&shape);
    check_refused(&shape, 2.1e-6, h, "a cut-off of 2.1e-06 m is below two nodes, 2.2e-06 m");
    check_refused(&shape, 62e-6, h, "longer than the map, 6.1e-05 m");
    check_refused(&shape, NAN, h, "below two nodes");
    check_refused(&shape, INFINITY, h, "longer than the map");
    filter(&profile, (struct rc_filter){.cutoff = 2e-6}, h); /* dy of a profile does not count */
    h[3] = INFINITY;
    check_refused(&shape, 20e-6, h, "1 infinite heights");
    for (size_t k = 0; k < N; k++)
        h[k] = NAN;
    check_refused(&shape, 20e-6, h, "all 2867 heights are missing");
    free(h);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_missing_points_and_edges),
        cmocka_unit_test(test_profiles),
        cmocka_unit_test(test_weighting_function),
        cmocka_unit_test(test_transmission),
        cmocka_unit_test(test_datum),
        cmocka_unit_test(test_robust_is_reweighting),
        cmocka_unit_test(test_spikes_are_left_out),
        cmocka_unit_test(test_exact_ground),
        cmocka_unit_test(test_threads_and_high),
        cmocka_unit_test(test_refusals),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
