/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A body from one file and one row of a list works like any other. The solver finds its contact with an error
 * estimate, free and periodic, with yielding; stresses, which this body does not define, are refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"
#include "libcontact/body/body.h"

enum {
    N = 48
};
static const struct rc_layer springs = {4e-6, 1e9, 0};
static const struct rc_pair pair = {.one = {INFINITY, 0.3, 1, &springs}};
static const struct rc_shape shape = {N, N, 1e-6, 1.2e-6};

static void
pressed(void **state)
{
    struct rc_selfaffine what = {.hurst = 0.8, .rms_slope = 0.05, .short_cut = 6e-6, .seed = 3};
    double h[N * N];
    struct rc_err err;

    (void)state;
    assert_string_equal(rc_body_type(&pair.one)->name, "springs");
    assert_int_equal(rc_synth_selfaffine(&shape, &what, h, &err), RC_OK);
    for (int k = 0; k < 4; k++) {
        struct rc_problem problem = {.boundary = k % 2 ? RC_PERIODIC : RC_FREE,
                                     .pair = pair,
                                     .load = 2e7 * N * N * 1.2e-12,
                                     .hardness = k < 2 ? 0 : 6e7,
                                     .tol = 1e-8};
        struct solved s = solve(shape, h, problem);
        print_message("estimate %.1e, gap off by %.1e\n", s.c.pressure_error, s.c.kkt_residual);
        assert_int_equal(s.status, RC_OK);
        assert_true(s.c.converged && s.c.kkt_residual < 1e-6);
        assert_true(s.c.contact_nodes > 10 && s.c.contact_nodes < N * N);
        assert_int_equal(s.c.hardness_active, k >= 2);
        solved_free(&s);
    }
}

/* The displacement of a node by another loaded node is the value of the kernel. */
static void
displaced(void **state)
{
    const struct rc_conv_options o = {.engine = "fft"};
    double p[N * N] = {0}, u[N * N];
    struct rc_err err;
    struct rc_conv *conv = rc_conv_new(&shape, &pair, &o, &err);

    (void)state;
    assert_non_null(conv);
    p[7 * N + 20] = 3e6;
    rc_conv_apply(conv, p, u);
    for (size_t k = 0; k < N * N; k++) {
        double x = node_x(shape, k) - node_x(shape, 7 * N + 20);
        double y = node_y(shape, k) - node_y(shape, 7 * N + 20);
        double exact = 3e6 * 1.2e-12 / (exact_pi * 1e9 * 4e-6) * exp(-hypot(x, y) / 4e-6);
        assert_true(fabs(u[k] - exact) < rounding * u[7 * N + 20]);
    }
    rc_conv_free(conv);
}

static void
inside(void **state)
{
    const struct rc_stress_options o = {.body = pair.one, .wanted = 1};
    const double p[N * N] = {0};
    struct rc_err err;

    (void)state;
    assert_null(rc_stress_new(&shape, p, &o, &err));
    assert_string_equal(err.text, "stresses inside a body that is springs are not implemented");
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pressed),
        cmocka_unit_test(displaced),
        cmocka_unit_test(inside),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
