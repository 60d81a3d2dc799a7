/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cone, flat punch and two equal spheres far apart: approach, radius and load have closed forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

static const double estar = 71.3e9;

static void
cone(void **state)
{
    enum {
        M = 201
    };
    double slope = 0.013, load = 2.91, a = cone_radius(load, slope, estar), nodes = M / 2.5;
    struct rc_shape shape = {M, M, 2.5 * a / M, 2.5 * a / M};
    struct rc_problem problem = {.pair.estar = estar, .load = load, .tol = 1e-6};
    double *h = malloc(M * M * sizeof *h);
    struct solved s;

    (void)state;
    for (size_t k = 0; k < M * M; k++)
        h[k] = -slope * node_r(shape, k);
    s = solve(shape, h, problem);
    assert_int_equal(s.status, RC_OK);
    print_message("cone: radius %.2e, approach %.2e off\n",
                  sqrt(s.c.contact_area / exact_pi) / a - 1,
                  s.c.approach / cone_approach(load, slope, estar) - 1);
    assert_true(fabs(s.c.contact_area / (exact_pi * a * a) - 1) < grid_area / nodes);
    assert_true(fabs(s.c.approach / cone_approach(load, slope, estar) - 1) < grid_cone / nodes);
    solved_free(&s);
    free(h);
}

/* A plastic cone carries H over a circle: load = H pi a^2 if the elastic rim is thin. */
static void
plastic_cone(void **state)
{
    enum {
        M = 151
    };
    double slope = 0.2, load = 2.91, hardness = estar * slope / 60;
    double a = sqrt(load / (exact_pi * hardness));
    struct rc_shape shape = {M, M, 2.8 * a / M, 2.8 * a / M};
    struct rc_problem problem = {
        .pair.estar = estar, .load = load, .hardness = hardness, .tol = 1e-6};
    double *h = malloc(M * M * sizeof *h);
    struct solved s;

    (void)state;
    for (size_t k = 0; k < M * M; k++)
        h[k] = -slope * node_r(shape, k);
    s = solve(shape, h, problem);
    assert_int_equal(s.status, RC_OK);
    assert_true(s.c.max_pressure <= hardness);
    assert_true(fabs(s.c.load / load - 1) < summed);
    assert_true(s.c.plastic_area * hardness <= load);
    assert_true(s.c.plastic_area * hardness >
                0.9 * load); /* the rim: one node of 54, and the elastic deformation */
    assert_true(s.c.contact_area * hardness >= load);
    solved_free(&s);
    free(h);
}

static double
punch_error(size_t m)
{
    double load = 11.7, a = 1e-4;
    struct rc_shape shape = {m, m, 2.2 * a / (double)m, 2.2 * a / (double)m};
    struct rc_problem problem = {.pair.estar = estar, .load = load, .tol = 1e-7};
    double *h = malloc(m * m * sizeof *h), error;
    struct solved s;

    for (size_t k = 0; k < m * m; k++)
        h[k] = node_r(shape, k) <= a ? 0 : -1e-4;
    s = solve(shape, h, problem);
    assert_int_equal(s.status, RC_OK);
    error = s.c.approach / punch_approach(load, a, estar) - 1;
    print_message("flat punch %zu: approach %.2e off\n", m, error);
    solved_free(&s);
    free(h);
    return fabs(error);
}

/* The pressure at the edge is singular and the edge is a staircase: the order is at most the first. */
static void
flat_punch(void **state)
{
    double coarse = punch_error(50), fine = punch_error(199);

    (void)state;
    assert_true(coarse < 0.5 * 2.2 / 50 && fine < 0.5 * 2.2 / 199); /* half a node of the radius */
    assert_true(fine < coarse);
}

/* Two equal distant peaks carry half the load each, and each sinks further by the displacement of the other,
 * load / (2 pi E* distance). */
static void
two_peaks(void **state)
{
    enum {
        NX = 480,
        NY = 96
    };
    double load = 8.8, radius = 1.7e-3;
    struct hertz one = hertz(load / 2, radius, estar);
    struct rc_shape shape = {NX, NY, one.a / 30, one.a / 30};
    double distance = 400 * shape.dx;
    struct rc_problem problem = {.pair.estar = estar, .load = load, .tol = 1e-6};
    double *h = malloc(NX * NY * sizeof *h), left = 0, truth;
    struct solved s;

    (void)state;
    for (size_t k = 0; k < NX * NY; k++) {
        double x = fabs(node_x(shape, k)) - distance / 2, y = node_y(shape, k);
        h[k] = -(x * x + y * y) / (2 * radius);
    }
    s = solve(shape, h, problem);
    assert_int_equal(s.status, RC_OK);
    for (size_t k = 0; k < NX * NY; k++)
        if (k % NX < NX / 2)
            left += s.p[k] * shape.dx * shape.dy;
    truth = one.approach + load / 2 / (exact_pi * estar * distance);
    print_message("two peaks: left load %.2e, approach %.2e off\n", 2 * left / load - 1,
                  (s.c.approach + below_apex(shape, radius)) / truth - 1);
    assert_true(fabs(2 * left / load - 1) < 2 * problem.tol);
    assert_true(fabs((s.c.approach + below_apex(shape, radius)) / truth - 1) <
                grid_approach / (30 * 30));
    solved_free(&s);
    free(h);
}

int
main(void)
{
    int failed = 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cone),
        cmocka_unit_test(plastic_cone),
        cmocka_unit_test(flat_punch),
        cmocka_unit_test(two_peaks),
    };

    RUN_FOR_EACH_METHOD(tests, failed)
    return failed;
}
