/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Iterations on coated bodies. The coats are 0.01 to 100 times as stiff as their substrate, and one to 64
 * nodes thick. A periodic surface of 512 x 512 nodes has 2 and 40 % contact. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    M = 512,
    N = M * M
};
static const struct rc_shape shape = {M, M, 1e-6, 1e-6};
static const double wanted = 1e-4, nearly = 0.05 /* conditions of the contact of a row */;

struct row {
    double ratio, thickness; /* E_1/E_s; nodes                                        */
    double contact, mean;    /* fraction; the pressure over E_s that gives it         */
    size_t most;             /* iterations on the finest grid to a true error of 1e-4 */
};
/* The largest iterations of a prototype; for E_1/E_s = 0.1, t/dx = 4, 2 % contact it took 4, one less than
 * here. */
/* clang-format off */
static const struct row rows[] = {
    {0.01, 1, 0.02, 8.077e-05, 3}, {0.01, 4, 0.02, 2.589e-05, 5},
    {0.01, 16, 0.02, 1.202e-05, 5}, {0.01, 64, 0.02, 1.011e-05, 4},
    {0.01, 1, 0.4, 0.002577, 3}, {0.01, 4, 0.4, 0.0008467, 3},
    {0.01, 16, 0.4, 0.0003227, 3}, {0.01, 64, 0.4, 0.0002369, 4},
    {0.1, 1, 0.02, 0.0003995, 5}, {0.1, 4, 0.02, 0.000199, 5},
    {0.1, 16, 0.02, 0.000116, 4}, {0.1, 64, 0.02, 0.0001014, 5},
    {0.1, 1, 0.4, 0.01114, 3}, {0.1, 4, 0.4, 0.005674, 3},
    {0.1, 16, 0.4, 0.002956, 3}, {0.1, 64, 0.4, 0.002361, 3},
    {0.5, 1, 0.02, 0.0007993, 5}, {0.5, 4, 0.02, 0.0006219, 5},
    {0.5, 16, 0.02, 0.000526, 4}, {0.5, 64, 0.02, 0.0005045, 6},
    {0.5, 1, 0.4, 0.01961, 3}, {0.5, 4, 0.4, 0.01591, 3},
    {0.5, 16, 0.4, 0.01264, 4}, {0.5, 64, 0.4, 0.01162, 4},
    {2, 1, 0.02, 0.00119, 6}, {2, 4, 0.02, 0.001612, 6},
    {2, 16, 0.02, 0.001895, 7}, {2, 64, 0.02, 0.001973, 5},
    {2, 1, 0.4, 0.02685, 6}, {2, 4, 0.4, 0.03493, 6},
    {2, 16, 0.4, 0.04277, 5}, {2, 64, 0.4, 0.04637, 4},
    {10, 1, 0.02, 0.001839, 10}, {10, 4, 0.02, 0.005268, 9},
    {10, 16, 0.02, 0.008391, 8}, {10, 64, 0.02, 0.009668, 7},
    {10, 1, 0.4, 0.03603, 9}, {10, 4, 0.4, 0.1142, 9},
    {10, 16, 0.4, 0.1972, 7}, {10, 64, 0.4, 0.2319, 6},
    {100, 1, 0.02, 0.006823, 14}, {100, 4, 0.02, 0.03735, 14},
    {100, 16, 0.02, 0.07739, 14}, {100, 64, 0.02, 0.09475, 9},
    {100, 1, 0.4, 0.1007, 39}, {100, 4, 0.4, 0.991, 48},
    {100, 16, 0.4, 1.894, 30}, {100, 64, 0.4, 2.272, 9},
};
/* clang-format on */

static void
make(double *h)
{
    struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = 0.1, .rolloff = 128e-6, .short_cut = 8e-6, .seed = 3};
    struct rc_err err;

    assert_int_equal(rc_synth_selfaffine(&shape, &what, h, &err), RC_OK);
}

/* Iterations until the pressure is this near to `exact`. */
static size_t
iterations_to(const struct rc_problem *problem, const double *h, const double *exact,
              double *convolutions)
{
    struct rc_err err;
    struct rc_solver *s = rc_solver_new(&shape, h, problem, &err);
    struct rc_progress at;
    enum rc_status status;
    double error;

    assert_non_null(s);
    do {
        status = rc_solver_step(s);
        rc_solver_progress(s, &at);
        error = at.grid.nx == M ? distance(N, rc_solver_pressure(s), exact) : INFINITY;
    } while (status == RC_MORE && error > wanted);
    assert_true(error <= wanted);
    *convolutions = rc_solver_convolutions(s);
    rc_solver_free(s);
    return at.iterations;
}

static void
found_in_time(void **state)
{
    double *h = malloc(N * sizeof *h);
    size_t slow = 0;

    (void)state;
    make(h);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct row *row = &rows[k];
        struct rc_layer layer = {row->thickness * 1e-6, row->ratio * 1e9, 0.3};
        struct rc_body coating = {1e9, 0.3, 1, &layer};
        struct rc_problem problem = {.boundary = RC_PERIODIC,
                                     .pair.one = coating,
                                     .load = row->mean * 1e9 * N * 1e-12,
                                     .tol = 1e-9};
        struct solved exact = solve(shape, h, problem);
        double convolutions;
        size_t n;

        assert_int_equal(exact.status, RC_OK);
        assert_true(fabs(exact.c.contact_fraction / row->contact - 1) < nearly);
        problem.tol = wanted / 10;
        n = iterations_to(&problem, h, exact.p, &convolutions);
        print_message("E_1/E_s %g, t/dx %g, contact %.2f: %zu iterations (at most %zu), %.1f "
                      "convolutions\n",
                      row->ratio, row->thickness, row->contact, n, row->most, convolutions);
        slow += n > row->most;
        solved_free(&exact);
    }
    assert_int_equal(slow, 0);
    free(h);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(found_in_time)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
