/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A contact that travels. Each position is compared with a contact of its own, whose heights are summed
 * here. A ball on an inclined plane rises with the plane, also between nodes. A surface between nodes is
 * compared with its Fourier series. Convolutions are counted. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    W = 48, /* nodes of the window */
    NX = 160,
    NY = 60,
    N = W * W
};
static const double node = 1e-6, estar = 1e11, radius = 2e-3, load = 0.05; /* m, Pa, m, N */
static double rough[NX * NY], other[NX * NY];

/* A self-affine surface that repeats. */
static void
make(double *h, size_t nx, size_t ny, double height, uint64_t seed)
{
    const struct rc_shape s = {nx, ny, node, node};
    const struct rc_selfaffine o = {.hurst = 0.8,
                                    .rms_height = height,
                                    .short_cut = 8 * node,
                                    .long_cut = 50 * node,
                                    .seed = seed};
    struct rc_err err = {""};

    if (rc_synth_selfaffine(&s, &o, h, &err) != RC_OK)
        fail_msg("%s", err.text);
}

static struct rc_model *
travelling_on(struct rc_shape s, struct rc_boundary boundary, double tol,
              const struct rc_travel_problem *problem)
{
    const struct rc_problem contact = {
        .boundary = boundary, .pair.estar = estar, .tol = tol, .threads = 1};
    static const double flat[NX * NY];
    struct rc_err err = {""};
    struct rc_model *m =
        rc_travel_new(rc_elastic_new(&s, flat, &contact, NULL, &err), problem, &err);

    if (m == NULL)
        fail_msg("%s", err.text);
    return m;
}

static struct rc_model *
travelling(struct rc_shape s, double tol, const struct rc_travel_problem *problem)
{
    return travelling_on(s, RC_FREE, tol, problem);
}

/* Moves to a position given in nodes. Returns the convolutions. */
static double
move(struct rc_model *m, double nodes)
{
    struct rc_point to = {0};
    struct rc_err err = {""};

    rc_point_set(&to, RC_LOAD, load);
    rc_point_set(&to, RC_POSITION, nodes * node);
    if (rc_model_run(m, &to, &err) != RC_OK || rc_model_look(m, NULL, &err) != RC_OK)
        fail_msg("position %g: %s", nodes, err.text);
    return rc_model_number(m, "convolutions");
}

static void
sag(double *h, size_t nx, size_t ny, double middle)
{
    for (size_t k = 0; k < nx * ny; k++) {
        const double x = ((double)(k % nx) - middle) * node,
                     y = ((double)(k / nx) - (double)(ny - 1) / 2) * node;
        h[k] -= (x * x + y * y) / (2 * radius);
    }
}

/* The contact of these heights: compares its pressure, and the height of body 2. */
static void
compare_on(struct rc_model *m, struct rc_shape s, struct rc_boundary boundary, const double *h,
           double tol)
{
    const struct rc_problem contact = {
        .boundary = boundary, .pair.estar = estar, .load = load, .tol = 1e-9, .threads = 1};
    const size_t n = s.nx * s.ny;
    struct solved is = solve(s, h, contact);
    double *p = malloc(n * sizeof *p), off = 0, sum = 0, top = -INFINITY;
    struct rc_err err = {""};

    assert_int_equal(is.status, RC_OK);
    assert_int_equal(rc_model_frame(m, "pressure", p, &err), RC_OK);
    for (size_t k = 0; k < n; k++) {
        off += fabs(p[k] - is.p[k]);
        sum += is.p[k];
        top = fmax(top, h[k]);
    }
    if (off > tol * sum)
        fail_msg("pressure off by %g", off / sum);
    if (fabs(rc_travel_result(m)->height - (top - is.c.approach)) > tol * is.c.approach)
        fail_msg("height %g, not %g", rc_travel_result(m)->height, top - is.c.approach);
    free(p);
    solved_free(&is);
}

static void
compare(struct rc_model *m, struct rc_shape s, const double *h, double tol)
{
    compare_on(m, s, RC_FREE, h, tol);
}

/* ---- tests ---- */

/* By steps of whole and of half nodes, there and back, and over the seam of a periodic map. */
static void
ball_in_a_window(void **state)
{
    const struct rc_shape s = {W, W, node, node};
    const struct rc_travel_problem problem = {
        .track = {NX, NY, node, node}, .h1 = rough, .repeats = true, .radius = radius};
    static const double to[] = {-3, -2, -1, -0.5, 0, 0.25, 1, 20, 0, 75, 79, 83};
    static double h[N];
    struct rc_model *m = travelling(s, 1e-9, &problem);

    (void)state;
    for (size_t q = 0; q < sizeof to / sizeof *to; q++) {
        const double from = floor(to[q] + (NX - W) / 2 + 0.5);
        move(m, to[q]);
        for (size_t k = 0; k < N; k++)
            h[k] = rough[((NY - W) / 2 + k / W) * NX + ((size_t)from + k % W) % NX];
        sag(h, W, W, to[q] + (NX - 1) / 2.0 - from);
        compare(m, s, h, 1e-7);
    }
    rc_model_free(m);
}

/* On maps that repeat along one axis: a roller along y in a window and on the whole map, between nodes too,
 * and a ball on a map that repeats along x, over its seam. */
static void
rollers_and_balls(void **state)
{
    static const double to[] = {0, 1, 2, 0.5, -7.25, 30, 31.5};
    static double h1[64 * NY], h[64 * NY];

    (void)state;
    for (size_t k = 0; k < 64 * NY; k++)
        h1[k] = rough[k / 64 * NX + k % 64];
    for (int which = 0; which < 3; which++) {
        const bool roller = which < 2, window = which == 0;
        const struct rc_boundary boundary = rc_boundary_of(!roller, roller);
        const struct rc_shape map = {window ? NX : 64, NY, node, node},
                              s = {window ? W : 64, NY, node, node};
        const struct rc_travel_problem problem = {.track = map,
                                                  .h1 = window ? rough : h1,
                                                  .repeats = which != 1,
                                                  .radius = radius,
                                                  .cylinder = roller};
        struct rc_model *m = travelling_on(s, boundary, 1e-9, &problem);

        for (size_t q = 0; q < (which == 1 ? 5 : 7); q++) {
            const double from = window ? floor(to[q] + (NX - W) / 2 + 0.5) : 0;
            move(m, to[q]);
            for (size_t k = 0; k < s.nx * NY; k++) {
                const size_t i = ((size_t)from + k % s.nx) % map.nx, j = k / s.nx;
                double x = ((double)(k % s.nx) + from - ((double)map.nx - 1) / 2 - to[q]) * node;
                double y = ((double)j - (NY - 1) / 2.0) * node;
                x = roller ? x : remainder(x, 64 * node);
                h[k] = problem.h1[j * map.nx + i] - (x * x + (roller ? 0 : y * y)) / (2 * radius);
            }
            compare_on(m, s, boundary, h, 1e-7);
        }
        rc_model_free(m);
    }
}

/* Maps and windows of odd and even numbers of columns and rows: the ball is where it is without a window, in
 * the middle row of the map and at its position along x. Where the middle rows cannot agree, the window is
 * refused with the number of rows to take. */
static void
windows_of_all_sizes(void **state)
{
    enum {
        MOST = 37 * 30
    };
    static const double to[] = {0, 1.5, -2};
    static double h1[MOST], h[MOST], p[MOST], whole_p[MOST];
    struct rc_err err = {""};

    (void)state;
    for (size_t nx = 36; nx < 38; nx++)
        for (size_t ny = 29; ny < 31; ny++)
            for (size_t w = 26; w < 28; w++)
                for (size_t rows = 25; rows < 27; rows++) {
                    const struct rc_shape map = {nx, ny, node, node}, s = {w, rows, node, node};
                    const struct rc_problem contact = {
                        .pair.estar = estar, .tol = 1e-9, .threads = 1};
                    const struct rc_travel_problem problem = {
                        .track = map, .h1 = h1, .radius = radius};
                    struct rc_model *m, *whole;

                    for (size_t k = 0; k < nx * ny; k++)
                        h1[k] = 0.1 * rough[k / nx * NX + k % nx];
                    m = rc_travel_new(rc_elastic_new(&s, h1, &contact, NULL, &err), &problem, &err);
                    if ((ny - rows) % 2 != 0) {
                        assert_null(m);
                        assert_non_null(strstr(err.text, rows == 25 ? "a window of 26 rows"
                                                                    : "a window of 27 rows"));
                        continue;
                    }
                    whole = travelling(map, 1e-9, &problem);
                    for (size_t q = 0; q < sizeof to / sizeof *to; q++) {
                        double off = 0, sum = 0, column;
                        move(m, to[q]);
                        move(whole, to[q]);
                        column =
                            rc_travel_result(m)->window_x / node + ((double)nx - (double)w) / 2;
                        assert_true(fabs(column - round(column)) < 1e-9);
                        assert_int_equal(rc_model_frame(m, "height", h, &err), RC_OK);
                        assert_int_equal(rc_model_frame(m, "pressure", p, &err), RC_OK);
                        assert_int_equal(rc_model_frame(whole, "pressure", whole_p, &err), RC_OK);
                        for (size_t k = 0; k < w * rows; k++) {
                            const size_t i = k % w + (size_t)lround(column),
                                         j = k / w + (ny - rows) / 2;
                            const double x = ((double)i - (double)(nx - 1) / 2 - to[q]) * node,
                                         y = ((double)j - (double)(ny - 1) / 2) * node;
                            const double exact = h1[j * nx + i] - (x * x + y * y) / (2 * radius);
                            assert_true(fabs(h[k] - exact) < 1e-20);
                            off += fabs(p[k] - whole_p[j * nx + i]);
                            sum += p[k];
                        }
                        assert_true(sum > 0 && off < 1e-7 * sum);
                    }
                    rc_model_free(m);
                    rc_model_free(whole);
                }
}

/* A surface whose columns differ by an odd number from those of body 1 lies with its middle on the middle of
 * the contact, half a node between the nodes: a parabola stays exact. Its rows must agree. */
static void
middle_of_a_surface(void **state)
{
    const struct rc_shape s = {24, 20, node, node};
    static double h2[33 * 21], h[24 * 20], flat[24 * 20];
    struct rc_travel_problem problem = {
        .track = s, .h1 = flat, .counter = {33, 20, node, node}, .h2 = h2, .ratio = 1};
    const struct rc_problem contact = {.pair.estar = estar, .tol = 1e-6, .threads = 1};
    struct rc_err err = {""};
    struct rc_model *m;

    (void)state;
    for (size_t k = 0; k < 33 * 21; k++)
        h2[k] = -pow(((double)(k % 33) - 16) * node, 2) / (2 * radius) -
                pow(((double)(k / 33) - 9.5) * node, 2) / (2 * radius);
    m = travelling(s, 1e-6, &problem);
    for (double to = -1; to <= 1; to += 0.5) {
        move(m, to);
        assert_int_equal(rc_model_frame(m, "height", h, &err), RC_OK);
        for (size_t k = 0; k < 24 * 20; k++) {
            const double x = ((double)(k % 24) - 11.5 - to) * node,
                         y = ((double)(k / 24) - 9.5) * node;
            assert_true(fabs(h[k] + (x * x + y * y) / (2 * radius)) < 1e-20);
        }
    }
    rc_model_free(m);
    problem.counter.ny = 21;
    assert_null(rc_travel_new(rc_elastic_new(&s, flat, &contact, NULL, &err), &problem, &err));
    assert_non_null(strstr(err.text, "cut the map of body 2 to 20 rows"));
}

/* A rough body 2 that rolls, slides with the contact, or half as far, over the whole map. */
static void
surface_over_the_map(void **state)
{
    static const double ratio[] = {0, 1, 0.5}, to[] = {-4, -3, -2, 6};
    const struct rc_shape s = {W, W, node, node};
    static double h[N], track[N];

    (void)state;
    for (size_t k = 0; k < N; k++)
        track[k] = rough[k / W * NX + k % W];
    for (size_t r = 0; r < 3; r++) {
        const struct rc_travel_problem problem = {.track = s,
                                                  .h1 = track,
                                                  .counter = {NX, NY, node, node},
                                                  .h2 = other,
                                                  .ratio = ratio[r],
                                                  .radius = radius};
        struct rc_model *m = travelling(s, 1e-9, &problem);
        for (size_t q = 0; q < 4; q++) {
            const double shift = ratio[r] * to[q];
            if (shift != floor(shift))
                continue;
            move(m, to[q]);
            for (size_t k = 0; k < N; k++)
                h[k] = track[k] + other[((NY - W) / 2 + k / W) * NX + (NX - W) / 2 + k % W -
                                        (size_t)(ptrdiff_t)shift];
            sag(h, W, W, to[q] + (W - 1) / 2.0);
            compare(m, s, h, 1e-7);
        }
        rc_model_free(m);
    }
}

/* Between nodes, where the shortest wave has 8 nodes: a sine half a node further is known. */
static void
between_nodes(void **state)
{
    const struct rc_shape s = {W, W, node, node};
    static double h2[N], h[N], track[N];
    const double q = 2 * acos(-1) / 8;
    const struct rc_travel_problem problem = {.track = s,
                                              .h1 = track,
                                              .repeats = true,
                                              .counter = s,
                                              .h2 = h2,
                                              .counter_repeats = true,
                                              .ratio = 1,
                                              .radius = radius};
    struct rc_model *m = travelling(s, 1e-3, &problem);
    double most = 0;

    (void)state;
    for (size_t k = 0; k < N; k++)
        h2[k] = 1e-8 * cos(q * (double)(k % W));
    for (double x = -1.5; x <= 2; x += 0.5) {
        struct rc_err err;
        move(m, x);
        assert_int_equal(rc_model_frame(m, "height", h, &err), RC_OK);
        for (size_t k = 0; k < N; k++) {
            const double y = ((double)(k / W) - (W - 1) / 2.0) * node;
            double along = (double)(k % W) - (W - 1) / 2.0 - x;
            along = (along - W * round(along / W)) * node;
            most = fmax(most, fabs(h[k] - 1e-8 * cos(q * ((double)(k % W) - x)) +
                                   (along * along + y * y) / (2 * radius)));
        }
    }
    if (most > 0.012 * 1e-8) /* linear: 0.076 */
        fail_msg("heights off by %g", most / 1e-8);
    rc_model_free(m);
}

/* A ball on a plane of slope s touches at the distance s R ahead of its middle, and rises by s times its
 * travel. Its approach is that on a flat. */
static void
inclined_plane(void **state)
{
    const struct rc_shape s = {W, W, node, node};
    static double plane[NX * NY];
    const double slope = 1e-3;
    const double hertz = pow(3 * load / (4 * estar * sqrt(radius)), 2 / 3.0);
    const struct rc_travel_problem problem = {
        .track = {NX, NY, node, node}, .h1 = plane, .radius = radius};
    struct rc_model *m;
    double start = 0;

    (void)state;
    for (size_t k = 0; k < NX * NY; k++)
        plane[k] = slope * node * ((double)(k % NX) - (NX - 1) / 2.0);
    m = travelling(s, 1e-5, &problem);
    for (double x = -20; x <= 20; x += 2.5) {
        const double expected = slope * x * node + slope * slope * radius / 2;
        double height;
        move(m, x);
        height = rc_travel_result(m)->height;
        if (x == -20)
            start = height - slope * x * node;
        if (fabs(expected - height - hertz) > 0.02 * hertz ||
            fabs(height - slope * x * node - start) > 2e-3 * hertz)
            fail_msg("position %g: height %g, not %g", x, height, expected - hertz);
    }
    rc_model_free(m);
}

/* Short steps start from the last two pressures, long ones from coarser grids. */
static void
convolutions(void **state)
{
    enum {
        SIDE = 128,
        LONG = 512
    };
    static double track[LONG * SIDE], flat[SIDE * SIDE];
    const struct rc_shape s = {SIDE, SIDE, node, node};
    const struct rc_problem contact = {.pair.estar = 114e9, .tol = 1e-4, .threads = 1};
    const struct rc_travel_problem problem = {
        .track = {LONG, SIDE, node, node}, .h1 = track, .radius = 7.5e-3};
    static const double steps[] = {1, 2, 4};
    struct rc_err err = {""};

    (void)state;
    make(track, LONG, SIDE, 0.05e-6, 7);
    for (size_t q = 0; q < 3; q++) {
        struct rc_model *m =
            rc_travel_new(rc_elastic_new(&s, flat, &contact, NULL, &err), &problem, &err);
        double sum = 0, most = 0;
        assert_non_null(m);
        for (int k = 0; k < 30; k++) {
            const double now = move(m, -100 + k * steps[q]);
            sum += k > 1 ? now : 0;
            most = fmax(most, now);
        }
        print_message("steps of %g: %.2f convolutions, at most %g\n", steps[q], sum / 28, most);
        assert_true(sum / 28 < (q == 2 ? 6.5 : 5.5));
        assert_true(most < 8);
        rc_model_free(m);
    }
}

static void
refused(void **state)
{
    const struct rc_shape s = {W, W, node, node};
    struct rc_travel_problem problem = {
        .track = {NX, NY, node, node}, .h1 = rough, .radius = radius};
    const struct rc_problem contact = {.pair.estar = estar, .threads = 1};
    static const double flat[N];
    struct rc_model *m = travelling(s, 1e-3, &problem);
    struct rc_point to = {0};
    struct rc_err err = {""};

    (void)state;
    rc_point_set(&to, RC_LOAD, load);
    rc_point_set(&to, RC_POSITION, 60 * node);
    assert_int_equal(rc_model_go(m, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "take positions from -5.6e-05 to 5.6e-05 m"));
    rc_point_set(&to, RC_POSITION, 0);
    rc_point_set(&to, RC_LOAD, 0);
    assert_int_equal(rc_model_go(m, &to, &err), RC_FAIL);
    rc_model_free(m);
    problem.radius = 0;
    assert_null(rc_travel_new(rc_elastic_new(&s, flat, &contact, NULL, &err), &problem, &err));
    assert_non_null(strstr(err.text, "nothing travels"));
    problem.radius = radius;
    problem.track.nx = W - 1;
    assert_null(rc_travel_new(rc_elastic_new(&s, flat, &contact, NULL, &err), &problem, &err));
    assert_non_null(strstr(err.text, "must be smaller"));
}

/* A solver that starts from coarser grids again, and not from the pressure of a very different surface. */
static void
cold_start(void **state)
{
    const struct rc_shape s = {NX, NY, node, node};
    const struct rc_problem contact = {
        .pair.estar = estar, .load = load, .tol = 1e-4, .threads = 1};
    struct rc_err err = {""};
    struct rc_solver *a = rc_solver_new(&s, other, &contact, &err),
                     *b = rc_solver_new(&s, rough, &contact, &err);
    double off = 0, sum = 0;

    (void)state;
    assert_true(a != NULL && b != NULL);
    while (rc_solver_step(a) == RC_MORE)
        ;
    assert_int_equal(rc_solver_set_heights(a, rough, &err), RC_OK);
    assert_int_equal(rc_solver_warm_start(a, 0, NULL, &err), RC_OK);
    while (rc_solver_step(a) == RC_MORE)
        ;
    while (rc_solver_step(b) == RC_MORE)
        ;
    assert_true(fabs(rc_solver_convolutions(a) - rc_solver_convolutions(b)) < 2.5);
    for (size_t k = 0; k < NX * NY; k++) {
        off += fabs(rc_solver_pressure(a)[k] - rc_solver_pressure(b)[k]);
        sum += rc_solver_pressure(b)[k];
    }
    assert_true(off < 2e-4 * sum);
    rc_solver_free(a);
    rc_solver_free(b);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ball_in_a_window),
        cmocka_unit_test(rollers_and_balls),
        cmocka_unit_test(windows_of_all_sizes),
        cmocka_unit_test(middle_of_a_surface),
        cmocka_unit_test(surface_over_the_map),
        cmocka_unit_test(between_nodes),
        cmocka_unit_test(inclined_plane),
        cmocka_unit_test(convolutions),
        cmocka_unit_test(refused),
        cmocka_unit_test(cold_start),
    };

    make(rough, NX, NY, 0.02e-6, 1);
    make(other, NX, NY, 0.02e-6, 2);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
