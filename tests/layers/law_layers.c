/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For coated bodies as for one material: the estimated error is not below the error, load and bounds hold, a
 * mirrored surface has mirrored pressures. A layer divided in two gives the same result. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    NX = 96,
    NY = 80,
    N = NX * NY
};
static const struct rc_shape shape = {NX, NY, 1e-6, 1.1e-6};
static const double e = 10e9;

static void
make_surface(double *h)
{
    struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = 0.1, .rolloff = 30e-6, .short_cut = 4.4e-6, .seed = 11};
    struct rc_err err;

    assert_int_equal(rc_synth_selfaffine(&shape, &what, h, &err), RC_OK);
}

/* The bound of the ratio of estimate and error. The largest ratio here is 1.42 if the coat is at most twice
 * as stiff as the material below, and 2.5 at 10 times. It is never below 1. */
static const double over_soft = 1.6, over_stiff = 3;

static void
estimates(void **state)
{
    static const double ratio[] = {0.01, 0.1, 2, 10}, thickness[] = {1e-6, 8e-6};
    double h[N];

    (void)state;
    make_surface(h);
    for (int b = 0; b < 2; b++)
        for (size_t r = 0; r < 4; r++)
            for (size_t t = 0; t < 2; t++)
                for (int yields = 0; yields < 2; yields++) {
                    struct rc_layer layer = {thickness[t], ratio[r] * e, 0.3};
                    struct rc_body coating = {e, 0.3, 1, &layer};
                    double hard = 0.03 * fmin(ratio[r], 1) * e;
                    struct rc_problem problem = {.boundary = b == 0 ? RC_FREE : RC_PERIODIC,
                                                 .pair = {.one = coating, .two = {.e = 1e12}},
                                                 .load = 0.2 * hard * N * 1.1e-12,
                                                 .hardness = yields ? hard : 0,
                                                 .tol = 1e-4};
                    struct solved s = solve(shape, h, problem), exact;
                    double error, sum = 0;

                    problem.tol = 1e-10;
                    exact = solve(shape, h, problem);
                    assert_int_equal(s.status, RC_OK);
                    assert_int_equal(exact.status, RC_OK);
                    error = distance(N, s.p, exact.p);
                    if (getenv("RC_PRINT") != NULL)
                        printf("%d ratio %g t %g yields %d: %g / %g = %.2f, %zu steps\n", b,
                               ratio[r], thickness[t], yields, s.c.pressure_error, error,
                               s.c.pressure_error / error, s.c.iterations);
                    assert_true(s.c.pressure_error + exact.c.pressure_error >= error);
                    assert_true(s.c.pressure_error <=
                                (ratio[r] > 2 ? over_stiff : over_soft) * error);
                    for (size_t k = 0; k < N; k++) {
                        assert_true(s.p[k] >= 0 && (!yields || s.p[k] <= hard));
                        sum += s.p[k];
                    }
                    assert_true(fabs(sum * 1.1e-12 / problem.load - 1) < summed);
                    solved_free(&s);
                    solved_free(&exact);
                }
}

/* Stiff coats, rough down to the grid: convolutions to 1e-4, and the estimate, which is not below the error.
 * With the extension for one material the convolutions would be 64, 66 and 149. */
static void
stiff(void **state)
{
    enum {
        M = 256
    };
    static const struct {
        double ratio, thickness, mean; /* E_1/E_s; nodes; pressure over E_s */
        double most;                   /* convolutions                      */
        size_t ny;
        struct rc_boundary boundary;
    } rows[] = {{100, 2, 0.199, 13, M, {.x = true, .y = true}},
                {100, 2, 1.12, 12.5, M, {.x = true, .y = true}},
                {400, 1, 0.3205, 24.5, M, {.x = true, .y = true}},
                {400, 16, 0.01, 16, M, {.x = false}},
                {400, 16, 0.1, 16, M / 2, {.x = false}}};
    struct rc_selfaffine what = {
        .hurst = 0.8, .rms_slope = 0.1, .rolloff = 64e-6, .short_cut = 2e-6, .seed = 1};
    double *h = malloc(M * M * sizeof *h);
    struct rc_err err;

    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct rc_shape s = {M, rows[k].ny, 1e-6, 1e-6};
        size_t n = s.nx * s.ny;
        struct rc_layer layer = {rows[k].thickness * 1e-6, rows[k].ratio * e, 0.3};
        struct rc_problem problem = {.boundary = rows[k].boundary,
                                     .pair.one = {e, 0.3, 1, &layer},
                                     .load = rows[k].mean * e * (double)n * 1e-12,
                                     .tol = 1e-4};
        struct solved found, exact;
        double error;

        assert_int_equal(rc_synth_selfaffine(&s, &what, h, &err), RC_OK);
        found = solve(s, h, problem);
        problem.tol = 1e-8;
        exact = solve(s, h, problem);
        assert_int_equal(found.status, RC_OK);
        assert_int_equal(exact.status, RC_OK);
        error = distance(n, found.p, exact.p);
        print_message("%s E_1/E_s %g, t/dx %g, contact %.3f: %.1f convolutions, estimate %.2f of "
                      "the error\n",
                      rc_boundary_word(rows[k].boundary), rows[k].ratio, rows[k].thickness,
                      exact.c.contact_fraction, found.c.convolutions,
                      found.c.pressure_error / error);
        assert_true(found.c.convolutions <= rows[k].most);
        assert_true(found.c.pressure_error + exact.c.pressure_error >= error);
        assert_true(found.c.pressure_error <= over_stiff * error);
        solved_free(&found);
        solved_free(&exact);
    }
    free(h);
}

static void
mirrored_and_cut(void **state)
{
    struct rc_layer one = {5e-6, 4 * e, 0.25}, two[] = {{2e-6, 4 * e, 0.25}, {3e-6, 4 * e, 0.25}};
    struct rc_body whole = {e, 0.3, 1, &one}, cut = {e, 0.3, 2, two};
    struct rc_problem problem = {.pair.one = whole, .load = 1e-2, .tol = 1e-9};
    double h[N], mirrored[N];
    struct solved a, b, c;

    (void)state;
    make_surface(h);
    for (size_t k = 0; k < N; k++)
        mirrored[k] = h[k / NX * NX + NX - 1 - k % NX];
    a = solve(shape, h, problem);
    b = solve(shape, mirrored, problem);
    problem.pair.one = cut;
    c = solve(shape, h, problem);
    for (size_t k = 0; k < N; k++) {
        assert_true(fabs(a.p[k] - b.p[k / NX * NX + NX - 1 - k % NX]) < 1e-7 * a.c.max_pressure);
        assert_true(fabs(a.p[k] - c.p[k]) < 1e-7 * a.c.max_pressure);
    }
    solved_free(&a);
    solved_free(&b);
    solved_free(&c);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(estimates),
        cmocka_unit_test(stiff),
        cmocka_unit_test(mirrored_and_cut),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
