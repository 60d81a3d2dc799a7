/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rotated and mirrored maps obey the laws of rotation and reflection, bit for bit; a cropped map equals the
 * part. The sum of a surface and its replica is flat, and the order of two surfaces does not matter. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/contact.h"

enum {
    NX = 67,
    NY = 41,
    N = NX * NY
};

static const struct rc_shape map = {NX, NY, 1.1e-6, 1e-6};

/* Different values, some of them missing. */
static double *
new_map(size_t n)
{
    double *v = malloc(n * sizeof *v);

    assert_non_null(v);
    for (size_t k = 0; k < n; k++)
        v[k] = k % 17 == 3 ? NAN : 0.1 * (double)(k * k % 10007) - 300;
    return v;
}

static double *
copy_of(const double *v, size_t n)
{
    double *w = malloc(n * sizeof *w);

    assert_non_null(w);
    return memcpy(w, v, n * sizeof *w);
}

/* Rotates v in place; returns the new shape. */
static struct rc_shape
turn(struct rc_shape shape, double *v, size_t quarters)
{
    double *w = copy_of(v, shape.nx * shape.ny);

    rc_rotate(&shape, w, quarters, v);
    free(w);
    return rc_rotate_shape(&shape, quarters);
}

static void
the_right_column_becomes_the_top_row(void **state)
{
    const double v[] = {1, 2, 3, 4, 5, 6}; /* 1 2 3 over 4 5 6 */
    const double expected[4][6] = {
        {1, 2, 3, 4, 5, 6}, {3, 6, 2, 5, 1, 4}, {6, 5, 4, 3, 2, 1}, {4, 1, 5, 2, 6, 3}};
    const struct rc_shape s = {3, 2, 1.1, 1};

    (void)state;
    for (size_t q = 0; q < 4; q++) {
        struct rc_shape to = rc_rotate_shape(&s, q);
        double out[6];

        rc_rotate(&s, v, q, out);
        assert_memory_equal(out, expected[q], sizeof out);
        assert_int_equal(to.nx, q % 2 == 0 ? 3 : 2);
        assert_int_equal(to.ny, q % 2 == 0 ? 2 : 3);
        assert_true(to.dx == (q % 2 == 0 ? 1.1 : 1) && to.dy == (q % 2 == 0 ? 1 : 1.1));
    }
}

static void
four_quarters_are_none(void **state)
{
    double *v = new_map(N), *w = copy_of(v, N);
    struct rc_shape shape = map;

    (void)state;
    for (size_t k = 0; k < 4; k++) {
        shape = turn(shape, w, 1);
        /* compares bits, not values */
        /* NOLINTNEXTLINE(bugprone-suspicious-memory-comparison,cert-exp42-c,cert-flp37-c) */
        assert_int_equal(memcmp(v, w, N * sizeof *v) == 0, k == 3);
    }
    assert_memory_equal(&shape, &map, sizeof map);
    for (size_t q = 0; q < 4; q++) {
        shape = turn(map, w, q);
        turn(shape, w, 4 - q);
        assert_memory_equal(v, w, N * sizeof *v);
    }
    free(v);
    free(w);
}

static void
mirrors_turn(void **state)
{
    double *v = new_map(N), *a = copy_of(v, N), *b = copy_of(v, N);
    struct rc_shape shape;

    (void)state;
    rc_mirror(&map, 'x', a);
    for (size_t k = 0; k < N; k++)
        assert_memory_equal(&a[k], &v[k / NX * NX + NX - 1 - k % NX], sizeof *v);
    rc_mirror(&map, 'y', a);
    turn(map, b, 2);
    assert_memory_equal(a, b, N * sizeof *v);
    rc_mirror(&map, 'x', a);
    rc_mirror(&map, 'y', a);
    assert_memory_equal(a, v, N * sizeof *v);
    /* mirroring, then rotating is rotating back, then mirroring */
    memcpy(b, v, N * sizeof *v);
    rc_mirror(&map, 'x', a);
    turn(map, a, 1);
    shape = turn(map, b, 3);
    rc_mirror(&shape, 'x', b);
    assert_memory_equal(a, b, N * sizeof *v);
    free(v);
    free(a);
    free(b);
}

static void
a_part_is_the_part(void **state)
{
    const struct rc_shape part = {20, 11, 1.1e-6, 1e-6}, wide = {20, 42, 1, 1};
    double *v = new_map(N), *w = copy_of(v, N), out[220];
    struct rc_err err;

    (void)state;
    assert_int_equal(rc_crop(&map, v, 47, 30, &part, out, &err), RC_OK);
    for (size_t k = 0; k < 220; k++)
        assert_memory_equal(&out[k], &v[(30 + k / 20) * NX + 47 + k % 20], sizeof *v);
    assert_int_equal(rc_crop(&map, w, 47, 30, &part, w, &err), RC_OK);
    assert_memory_equal(w, out, sizeof out);
    assert_int_equal(rc_crop(&map, v, 48, 30, &part, out, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "20 x 11 nodes from column 48 and row 30 on: the map has "
                                     "columns 0 to 66 and rows 0 to 40"));
    assert_int_equal(rc_crop(&map, v, 47, 31, &part, out, &err), RC_FAIL);
    assert_int_equal(rc_crop(&map, v, SIZE_MAX, 0, &part, out, &err), RC_FAIL);
    assert_int_equal(rc_crop(&map, v, 0, 0, &wide, out, &err), RC_FAIL);
    free(v);
    free(w);
}

/* ---- face to face ---- */

/* The numbers of nodes cut on each side of each axis, computed by hand, for maps of na and of nb nodes. */
static void
check_sum(struct rc_shape a, struct rc_shape b)
{
    double *ha = new_map(a.nx * a.ny), *hb = new_map(b.nx * b.ny + 5), *out, *back;
    struct rc_shape sum;
    struct rc_err err;
    size_t ax, ay, bx, by;

    memmove(hb, hb + 5, b.nx * b.ny * sizeof *hb); /* another one */
    assert_int_equal(rc_add_shape(&a, &b, &sum, &err), RC_OK);
    assert_int_equal(sum.nx, a.nx < b.nx ? a.nx : b.nx);
    assert_int_equal(sum.ny, a.ny < b.ny ? a.ny : b.ny);
    assert_true(sum.dx == a.dx && sum.dy == a.dy);
    ax = (a.nx - sum.nx) / 2;
    ay = (a.ny - sum.ny) / 2;
    bx = (b.nx - sum.nx) / 2;
    by = (b.ny - sum.ny) / 2;
    out = new_map(sum.nx * sum.ny);
    back = new_map(sum.nx * sum.ny);
    assert_int_equal(rc_add(&a, ha, &b, hb, out, &err), RC_OK);
    for (size_t j = 0; j < sum.ny; j++)
        for (size_t i = 0; i < sum.nx; i++) {
            double x = ha[(j + ay) * a.nx + i + ax];
            double y = hb[(j + by) * b.nx + bx + sum.nx - 1 - i];
            double z = out[j * sum.nx + i];

            assert_true(isnan(x) || isnan(y) ? isnan(z) : z == x + y);
        }
    assert_int_equal(rc_add(&b, hb, &a, ha, back, &err), RC_OK);
    rc_mirror(&sum, 'x', back);
    for (size_t k = 0; k < sum.nx * sum.ny; k++)
        assert_true(isnan(out[k]) ? isnan(back[k]) : out[k] == back[k]);
    assert_int_equal(rc_subtract(&a, ha, &b, hb, back, &err), RC_OK);
    for (size_t k = 0; k < sum.nx * sum.ny; k++) {
        double x = ha[(k / sum.nx + ay) * a.nx + k % sum.nx + ax];
        double y = hb[(k / sum.nx + by) * b.nx + k % sum.nx + bx];

        assert_true(isnan(x) || isnan(y) ? isnan(back[k]) : back[k] == x - y);
    }
    assert_int_equal(rc_add(&a, ha, &b, hb, ha, &err), RC_OK); /* in place of a */
    for (size_t k = 0; k < sum.nx * sum.ny; k++)
        assert_true(isnan(out[k]) ? isnan(ha[k]) : out[k] == ha[k]);
    free(ha);
    free(hb);
    free(out);
    free(back);
}

static void
sums_on_the_overlap(void **state)
{
    (void)state;
    check_sum(map, map);
    check_sum(map, (struct rc_shape){60, 30, 1.1e-6, 1e-6});
    check_sum((struct rc_shape){60, 50, 1.1e-6 * (1 + 9e-7), 1e-6}, map);
    check_sum((struct rc_shape){8, 1, 1e-6, 1e-6}, (struct rc_shape){5, 4, 1e-6, 1e-6});
}

static void
a_surface_closes_on_its_replica(void **state)
{
    double *h = new_map(N), *replica = copy_of(h, N), *sum = new_map(N);
    struct rc_err err;

    (void)state;
    for (size_t k = 0; k < N; k++)
        replica[k] = -h[k];
    rc_mirror(&map, 'x', replica);
    assert_int_equal(rc_add(&map, h, &map, replica, sum, &err), RC_OK);
    for (size_t k = 0; k < N; k++)
        assert_true(isnan(h[k]) ? isnan(sum[k]) : sum[k] == 0);
    free(h);
    free(replica);
    free(sum);
}

static void
other_spacings_are_refused(void **state)
{
    const struct rc_shape other[] = {{NX, NY, 1.1e-6 * (1 + 1.1e-6), 1e-6},
                                     {NX, NY, 1.1e-6, 1e-6 * (1 - 1.1e-6)},
                                     {NX, NY, NAN, 1e-6}};
    double *v = new_map(N), out[N];
    struct rc_err err;

    (void)state;
    for (size_t k = 0; k < 3; k++)
        assert_int_equal(rc_add(&map, v, &other[k], v, out, &err), RC_FAIL);
    assert_int_equal(rc_subtract(&map, v, &other[0], v, out, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "nodes do not meet"));
    free(v);
}

/* A reflected map is even about its edges and periodic. A cosine with its crests at the edges is again a
 * cosine of the whole period, and heights and slopes are unchanged. */
static void
reflections_repeat(void **state)
{
    const struct rc_shape shapes[] = {{NX, NY, 1.1e-6, 1e-6},
                                      {4, 3, 1e-6, 1e-6},
                                      {9, 1, 1e-6, 1e-6},
                                      {1, 8, 1e-6, 2e-6},
                                      {1, 1, 1e-6, 1e-6}};
    const double pi = 3.14159265358979323846;

    (void)state;
    for (size_t turn = 0; turn < 4 * (sizeof shapes / sizeof *shapes); turn++) {
        const struct rc_shape *s = &shapes[turn / 4];
        const struct rc_boundary along = rc_boundary_of(turn & 1, turn & 2);
        struct rc_shape to = rc_reflect_shape(s, along);
        double *v = malloc(s->nx * s->ny * sizeof *v), *out = malloc(to.nx * to.ny * sizeof *out);
        struct rc_statistics was, is;
        struct rc_seam seam;

        assert_int_equal(to.nx, !along.x || s->nx == 1 ? s->nx : 2 * s->nx);
        assert_int_equal(to.ny, !along.y || s->ny == 1 ? s->ny : 2 * s->ny);
        assert_true(to.dx == s->dx && to.dy == s->dy);
        for (size_t n = 0; n < s->nx * s->ny; n++)
            v[n] = cos(3 * pi * ((double)(n % s->nx) + 0.5) / (double)s->nx) *
                   cos(2 * pi * ((double)(n / s->nx) + 0.5) / (double)s->ny);
        rc_reflect(s, v, along, out);
        for (size_t n = 0; n < to.nx * to.ny; n++) {
            size_t i = n % to.nx, j = n / to.nx;
            double wave = cos(3 * pi * ((double)i + 0.5) / (double)s->nx) *
                          cos(2 * pi * ((double)j + 0.5) / (double)s->ny);
            assert_true(fabs(out[n] - wave) < 1e-13);
            if (i < s->nx && j < s->ny)
                assert_true(out[n] == v[j * s->nx + i]);
            if (along.x && to.nx > 1)
                assert_true(out[n] == out[j * to.nx + to.nx - 1 - i]);
            if (along.y && to.ny > 1)
                assert_true(out[n] == out[(to.ny - 1 - j) * to.nx + i]);
        }
        rc_measure_seam(NULL, &to, out, &seam);
        assert_true(!(along.x && seam.across[0] > 0) && !(along.y && seam.across[1] > 0));
        for (size_t n = 0; n < s->nx * s->ny; n++)
            v[n] = n % 17 == 3 ? NAN : (double)(n * n % 10007);
        rc_reflect(s, v, along, out);
        rc_measure(s, v, &was);
        rc_measure(&to, out, &is);
        assert_int_equal(is.missing, was.missing * (to.nx / s->nx) * (to.ny / s->ny));
        assert_true(fabs(is.mean - was.mean) <= 1e-12 * fabs(was.mean));
        assert_true(fabs(is.rms - was.rms) <= 1e-12 * was.rms);
        free(v);
        free(out);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_right_column_becomes_the_top_row),
        cmocka_unit_test(four_quarters_are_none),
        cmocka_unit_test(mirrors_turn),
        cmocka_unit_test(a_part_is_the_part),
        cmocka_unit_test(sums_on_the_overlap),
        cmocka_unit_test(a_surface_closes_on_its_replica),
        cmocka_unit_test(other_spacings_are_refused),
        cmocka_unit_test(reflections_repeat),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
