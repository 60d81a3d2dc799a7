/* SPDX-License-Identifier: GPL-3.0-or-later */
/* On finer grids cubic polynomials are reproduced inside, parabolas up to the edge, and periodic maps like
 * their repetitions. On coarser grids each cell gets the mean of its measured points, and is missing if less
 * than half of it was measured. */
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "maps.h"

static double
place(size_t i, size_t n, double d)
{
    return ((double)i - 0.5 * (double)(n - 1)) * d;
}

static double *
random_map(const struct rc_shape *s, uint64_t seed)
{
    double *v = new_map(s);

    for (size_t k = 0; k < s->nx * s->ny; k++) {
        seed = seed * 6364136223846793005U + 1442695040888963407U;
        v[k] = (double)(seed >> 11) * 0x1p-53 - 0.3;
    }
    return v;
}

static struct rc_shape
shape_for(const struct rc_shape *from, double dx, double dy)
{
    struct rc_shape to;
    struct rc_err err;

    if (rc_resample_shape(from, dx, dy, &to, &err) != RC_OK)
        fail_msg("%s", err.text);
    return to;
}

static double *
resample(const struct rc_shape *from, const double *v, struct rc_boundary boundary,
         const struct rc_shape *to)
{
    double *out = new_map(to);
    struct rc_err err;

    if (rc_resample(from, v, boundary, to, out, &err) != RC_OK)
        fail_msg("%s", err.text);
    return out;
}

/* ---- the grid ---- */

static void
check_shape(struct rc_shape from, double dx, double dy, size_t nx, size_t ny, bool covers)
{
    struct rc_shape to = shape_for(&from, dx, dy);

    assert_int_equal(to.nx, nx);
    assert_int_equal(to.ny, ny);
    assert_true(to.dx == dx && to.dy == dy);
    assert_int_equal(rc_resample_covers(&from, &to, RC_X) && rc_resample_covers(&from, &to, RC_Y),
                     covers);
}

static void
whole_cells_that_fit(void **state)
{
    const struct rc_shape map = {33, 47, 1.1e-6, 1e-6}, line = {100, 1, 1e-6, 1e-6};
    struct rc_shape to;
    struct rc_err err;

    (void)state;
    check_shape(map, 1.1e-6, 1e-6, 33, 47, true);
    check_shape(map, 3.3e-6, 47e-6, 11, 1, true);
    check_shape(map, 3.2e-6, 1e-6, 11, 47, false); /* 11.34 cells */
    check_shape(map, 0.1e-6, 0.1e-6, 363, 470, true);
    check_shape(map, 0.7e-6, 3.1e-6, 51, 15, false); /* 51.86 and 15.16 cells */
    check_shape(line, 0.5e-6, 0.5e-6, 200, 1, true);
    check_shape(line, 3e-6, 3e-6, 33, 1, false);
    /* within a millionth: the same spacing */
    to = shape_for(&map, 1.1e-6 * (1 + 9e-7), 1e-6 * (1 - 9e-7));
    assert_memory_equal(&to, &map, sizeof to);
    assert_int_equal(rc_resample_shape(&map, 40e-6, 1e-6, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "a cell of 4e-05 m is wider than the map, 3.63e-05 m"));
    assert_int_equal(rc_resample_shape(&map, 0, 1e-6, &to, &err), RC_FAIL);
    assert_int_equal(rc_resample_shape(&map, 1e-6, NAN, &to, &err), RC_FAIL);
    assert_int_equal(rc_resample_shape(&map, 1e-6, INFINITY, &to, &err), RC_FAIL);
    assert_int_equal(rc_resample_shape(&map, 1e-300, 1e-6, &to, &err), RC_FAIL);
    assert_int_equal(rc_resample_shape(&map, 1e-16, 1e-16, &to, &err), RC_FAIL);
    /* more than 32 bits count, in one row */
    if (rc_resample_shape(&line, 2e-14, 1e-6, &to, &err) == RC_OK)
        assert_true(to.nx > UINT32_MAX);
    else
        assert_non_null(strstr(err.text, " nodes of 100"));
}

static void
beyond_the_map_is_refused(void **state)
{
    const struct rc_shape map = {10, 10, 1, 1}, to = {10, 5, 1.01, 2};
    double v[100] = {0}, out[100];
    struct rc_err err;

    (void)state;
    assert_int_equal(rc_resample(&map, v, RC_FREE, &to, out, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "go beyond the map of 10 old cells"));
}

static void
the_same_grid_changes_nothing(void **state)
{
    const struct rc_shape map = {33, 47, 1.1e-6, 1e-6}, close = {33, 47, 1.1e-6 * (1 + 9e-7), 1e-6};
    double *v = random_map(&map, 1), *a, *b;

    (void)state;
    v[0] = v[33 * 47 - 1] = v[400] = NAN;
    a = resample(&map, v, RC_FREE, &map);
    b = resample(&map, v, RC_PERIODIC, &close);
    assert_memory_equal(a, v, 33 * 47 * sizeof *v);
    assert_memory_equal(b, v, 33 * 47 * sizeof *v);
    free(v);
    free(a);
    free(b);
}

/* ---- finer ---- */

static double
power(double x, int n)
{
    return n == 0 ? 1 : x * power(x, n - 1);
}

/* The monomials x^m y^n on the old and the new grid, over their largest values. Nodes within `edge` old nodes
 * of the edges are not compared. */
static void
check_monomial(struct rc_shape from, double dx, double dy, int m, int n, size_t edge)
{
    struct rc_shape to = shape_for(&from, dx, dy);
    double *v = new_map(&from), *out;
    double x1 = place(from.nx - 1, from.nx, from.dx), y1 = place(from.ny - 1, from.ny, from.dy);
    size_t seen = 0;

    for (size_t k = 0; k < from.nx * from.ny; k++)
        v[k] = power(place(k % from.nx, from.nx, from.dx) / x1, m) *
               power(place(k / from.nx, from.ny, from.dy) / y1, n);
    out = resample(&from, v, RC_FREE, &to);
    for (size_t k = 0; k < to.nx * to.ny; k++) {
        double x = place(k % to.nx, to.nx, to.dx), y = place(k / to.nx, to.ny, to.dy);

        if (fabs(x) > x1 - (double)edge * from.dx + (edge == 0 ? from.dx : 0) ||
            fabs(y) > y1 - (double)edge * from.dy + (edge == 0 ? from.dy : 0))
            continue;
        seen++;
        assert_true(fabs(out[k] - power(x / x1, m) * power(y / y1, n)) <= rounding);
    }
    assert_true(seen >= to.nx * to.ny / 4);
    free(v);
    free(out);
}

static void
cubics_inside_parabolas_everywhere(void **state)
{
    const struct rc_shape maps[] = {{33, 47, 1.1e-6, 1e-6}, {20, 17, 1e-6, 2.3e-6}};

    (void)state;
    for (size_t k = 0; k < 2; k++)
        for (int m = 0; m <= 3; m++)
            for (int n = 0; n <= 3; n++) {
                size_t edge = m > 2 || n > 2 ? 2 : 0;

                check_monomial(maps[k], maps[k].dx / 2, maps[k].dy / 3, m, n, edge);
                check_monomial(maps[k], maps[k].dx * 0.73, maps[k].dy * 0.41, m, n, edge);
                check_monomial(maps[k], maps[k].dx, maps[k].dy * 0.9, m, n, edge);
            }
}

/* Two nodes continue a plane, one node a constant. */
static void
small_maps(void **state)
{
    const struct rc_shape two = {2, 1, 1, 1}, three = {3, 3, 1, 1}, one = {1, 1, 1, 1};
    const double line[] = {1, 3}, bend[] = {1, 0, 1, 2, 1, 2, 5, 4, 5}; /* x^2 + y^2 + 2 y + 1 */
    const double single[] = {7};
    struct rc_shape to = {8, 1, 0.25, 1};
    double *out = resample(&two, line, RC_FREE, &to);

    (void)state;
    for (size_t i = 0; i < 8; i++)
        assert_true(fabs(out[i] - (2 + 2 * place(i, 8, 0.25))) <= rounding);
    free(out);
    to = (struct rc_shape){6, 9, 0.5, 1.0 / 3};
    out = resample(&three, bend, RC_FREE, &to);
    for (size_t k = 0; k < 54; k++) {
        double x = place(k % 6, 6, 0.5), y = place(k / 6, 9, 1.0 / 3);

        assert_true(fabs(out[k] - (x * x + y * y + 2 * y + 1)) <= rounding);
    }
    free(out);
    to = (struct rc_shape){3, 2, 1.0 / 3, 0.5};
    out = resample(&one, single, RC_FREE, &to);
    for (size_t k = 0; k < 6; k++)
        assert_true(out[k] == 7);
    free(out);
}

/* A map with copies of itself on both sides along the axes that repeat gives the same result as one that
 * repeats along them. */
static void
check_copies(size_t across, size_t down)
{
    const struct rc_boundary boundary = rc_boundary_of(across > 1, down > 1);
    const struct rc_shape map = {11, 8, 1, 1.3}, many = {across * 11, down * 8, 1, 1.3};
    const struct rc_shape to = {22, 24, 0.5, 1.3 / 3}, tos = {across * 22, down * 24, 0.5, 1.3 / 3};
    double *v = random_map(&map, 5), *tiled = new_map(&many), *a, *b;

    v[3 * 11 + 1] = NAN;
    v[7 * 11 + 10] = NAN;
    for (size_t k = 0; k < many.nx * many.ny; k++)
        tiled[k] = v[k / many.nx % 8 * 11 + k % many.nx % 11];
    a = resample(&map, v, boundary, &to);
    b = resample(&many, tiled, RC_FREE, &tos);
    for (size_t j = 0; j < to.ny; j++)
        for (size_t i = 0; i < to.nx; i++) {
            double expected = b[(j + down / 2 * to.ny) * tos.nx + i + across / 2 * to.nx],
                   got = a[j * to.nx + i];

            assert_true(isnan(expected) ? isnan(got) : fabs(got - expected) <= rounding);
        }
    free(v);
    free(tiled);
    free(a);
    free(b);
}

static void
periodic_maps_wrap(void **state)
{
    (void)state;
    check_copies(3, 3);
    check_copies(1, 3);
    check_copies(3, 1);
}

/* The error of a cosine falls with the fourth power of the spacing. */
static double
cosine_error(size_t n)
{
    struct rc_shape map = {n, 1, 16.0 / (double)n, 1}, to = {4 * n, 1, 4.0 / (double)n, 1};
    double *v = new_map(&map), *out, worst = 0;

    for (size_t i = 0; i < n; i++)
        v[i] = cos(2 * exact_pi * place(i, n, map.dx) / 16);
    out = resample(&map, v, RC_PERIODIC, &to);
    for (size_t i = 0; i < 4 * n; i++)
        worst = larger(worst, fabs(out[i] - cos(2 * exact_pi * place(i, 4 * n, to.dx) / 16)));
    free(v);
    free(out);
    return worst;
}

static void
the_error_is_of_the_fourth_order(void **state)
{
    double coarse = cosine_error(64), fine = cosine_error(128);

    (void)state;
    print_message("cosine of 64 nodes: %.1e off, of 128 %.1e\n", coarse, fine);
    assert_true(coarse < 1e-5);
    assert_true(log2(coarse / fine) > 3.8 && log2(coarse / fine) < 4.2);
}

/* A plane with holes. New nodes in a missing cell are missing, and all others are on the plane. Exceptions
 * are nodes with a missing one among their four old neighbours, which get the value of their old cell. */
static void
holes_stay_what_they_are(void **state)
{
    const struct rc_shape map = {21, 19, 1, 1};
    const size_t holes[] = {0, 100, 101, 122, 250, 21 * 19 - 1};
    struct rc_shape to = shape_for(&map, 1.0 / 3, 1.0 / 3);
    double *v = new_map(&map), *out;
    size_t missing = 0, constant = 0;

    (void)state;
    for (size_t k = 0; k < 21 * 19; k++)
        v[k] = 3 * place(k % 21, 21, 1) - 2 * place(k / 21, 19, 1);
    for (size_t k = 0; k < 6; k++)
        v[holes[k]] = NAN;
    out = resample(&map, v, RC_FREE, &to);
    for (size_t j = 0; j < to.ny; j++)
        for (size_t i = 0; i < to.nx; i++) {
            double own = v[j / 3 * 21 + i / 3], got = out[j * to.nx + i];
            double plane = 3 * place(i, to.nx, to.dx) - 2 * place(j, to.ny, to.dy);

            assert_int_equal(isnan(got), isnan(own));
            missing += isnan(got) ? 1 : 0;
            if (!isnan(got) && fabs(got - plane) > rounding * 60) {
                constant++;
                assert_true(got == own);
            }
        }
    assert_int_equal(missing, 6 * 9);
    assert_in_range(constant, 1, 6 * 16);
    free(v);
    free(out);
}

/* ---- coarser ---- */

static double
overlap(double a, double b, double c, double d)
{
    return fmax(0, fmin(b, d) - fmax(a, c));
}

/* Every new cell, compared with the sum over all old cells by lengths in metres. */
static void
check_means(struct rc_shape from, double dx, double dy, double part_missing)
{
    struct rc_shape to = shape_for(&from, dx, dy);
    double *v = random_map(&from, 3), *gone = random_map(&from, 4), *out;
    double left = -0.5 * (double)from.nx * from.dx, top = -0.5 * (double)from.ny * from.dy;
    size_t there = 0, missing = 0;

    for (size_t k = 0; k < from.nx * from.ny; k++)
        if (gone[k] + 0.3 < part_missing)
            v[k] = NAN;
    out = resample(&from, v, RC_FREE, &to);
    for (size_t k = 0; k < to.nx * to.ny; k++) {
        double x = place(k % to.nx, to.nx, to.dx), y = place(k / to.nx, to.ny, to.dy);
        double sum = 0, area = 0;

        for (size_t n = 0; n < from.nx * from.ny; n++) {
            double a = left + (double)(n % from.nx) * from.dx;
            double b = top + (double)(n / from.nx) * from.dy;
            double w = overlap(a, a + from.dx, x - dx / 2, x + dx / 2) *
                       overlap(b, b + from.dy, y - dy / 2, y + dy / 2);

            if (!isnan(v[n])) {
                sum += w * v[n];
                area += w;
            }
        }
        assert_int_equal(isnan(out[k]), area < (0.5 - 1e-9) * dx * dy);
        missing += isnan(out[k]) ? 1 : 0;
        there += isnan(out[k]) ? 0 : 1;
        assert_true(isnan(out[k]) || fabs(out[k] - sum / area) <= summed);
    }
    assert_true(there > 0 && (part_missing == 0) == (missing == 0));
    free(v);
    free(gone);
    free(out);
}

static void
means_of_what_was_measured(void **state)
{
    const struct rc_shape map = {33, 47, 1.1, 1};

    (void)state;
    for (int k = 0; k < 2; k++) {
        double part = k == 0 ? 0 : 0.45;

        check_means(map, 3.3, 3, part);
        check_means(map, 2.53, 1.74, part);
        check_means(map, 1.1, 2, part);
        check_means(map, 1.2, 1, part);
        check_means((struct rc_shape){24, 1, 1, 1}, 4, 1, part);
    }
}

/* Exactly half is enough: two of four. */
static void
half_is_enough(void **state)
{
    const struct rc_shape map = {4, 2, 1, 1}, to = {2, 1, 2, 2};
    const double v[] = {NAN, 3, NAN, NAN, 1, NAN, 8, NAN};
    double *out = resample(&map, v, RC_FREE, &to);

    (void)state;
    assert_true(out[0] == 2);
    assert_true(isnan(out[1]));
    free(out);
}

static void
whole_maps_keep_their_integral(void **state)
{
    const struct rc_shape map = {60, 36, 1.1, 1};
    const struct rc_shape to[] = {{20, 9, 3.3, 4}, {7, 5, 66.0 / 7, 7.2}, {60, 1, 1.1, 36}};
    double *v = random_map(&map, 8), whole = rc_sum(v, 60 * 36) * 1.1;

    (void)state;
    for (size_t k = 0; k < 3; k++) {
        double *out = resample(&map, v, RC_FREE, &to[k]);

        assert_true(fabs(rc_sum(out, to[k].nx * to[k].ny) * to[k].dx * to[k].dy / whole - 1) <=
                    summed);
        free(out);
    }
    free(v);
}

/* One axis coarser, one finer: a plane is kept if the sizes are multiples. Functions of one coordinate do not
 * depend on the order of the axes. */
static void
one_axis_each_way(void **state)
{
    const struct rc_shape map = {24, 20, 1, 1};
    const struct rc_shape to[] = {{8, 40, 3, 0.5}, {48, 5, 0.5, 4}};

    (void)state;
    for (size_t k = 0; k < 2; k++) {
        double *v = new_map(&map), *out;

        for (size_t n = 0; n < 480; n++)
            v[n] = 0.7 * place(n % 24, 24, 1) - 0.4 * place(n / 24, 20, 1);
        out = resample(&map, v, RC_FREE, &to[k]);
        for (size_t n = 0; n < to[k].nx * to[k].ny; n++) {
            double x = place(n % to[k].nx, to[k].nx, to[k].dx);
            double y = place(n / to[k].nx, to[k].ny, to[k].dy);

            assert_true(fabs(out[n] - (0.7 * x - 0.4 * y)) <= summed);
        }
        free(v);
        free(out);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_cells_that_fit),
        cmocka_unit_test(beyond_the_map_is_refused),
        cmocka_unit_test(the_same_grid_changes_nothing),
        cmocka_unit_test(cubics_inside_parabolas_everywhere),
        cmocka_unit_test(small_maps),
        cmocka_unit_test(periodic_maps_wrap),
        cmocka_unit_test(the_error_is_of_the_fourth_order),
        cmocka_unit_test(holes_stay_what_they_are),
        cmocka_unit_test(means_of_what_was_measured),
        cmocka_unit_test(half_is_enough),
        cmocka_unit_test(whole_maps_keep_their_integral),
        cmocka_unit_test(one_axis_each_way),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
