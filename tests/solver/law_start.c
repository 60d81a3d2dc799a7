/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Making a solver does not iterate; its first steps run on coarser grids, where it can be stopped; with a
 * given start it omits them. Calls in the wrong order are refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

static const struct rc_shape shape = {150, 97, 1.1e-6, 1e-6};
static const struct rc_problem posed = {.boundary = {.x = true, .y = true},
                                        .pair.estar = 1e9,
                                        .hardness = 6e7,
                                        .load = 0.25,
                                        .tol = 1e-5};

static double *
heights(void)
{
    double *h = malloc(shape.nx * shape.ny * sizeof *h);
    struct rc_selfaffine what = {.hurst = 0.8, .rms_slope = 0.1, .short_cut = 8e-6, .seed = 11};
    struct rc_err err;

    assert_non_null(h);
    assert_int_equal(rc_synth_selfaffine(&shape, &what, h, &err), RC_OK);
    return h;
}

static struct rc_solver *
solver(const double *h, const struct rc_problem *problem)
{
    struct rc_err err;
    struct rc_solver *s = rc_solver_new(&shape, h, problem, &err);

    assert_non_null(s);
    return s;
}

static size_t
grid_nodes(const struct rc_solver *s)
{
    struct rc_progress p;

    rc_solver_progress(s, &p);
    assert_true(p.coarser == (p.grid.nx * p.grid.ny < shape.nx * shape.ny));
    return p.grid.nx * p.grid.ny;
}

/* The number of iterations on the map's own grid. */
static size_t
iterations(const struct rc_solver *s)
{
    struct rc_progress p;

    rc_solver_progress(s, &p);
    return p.coarser ? 0 : p.iterations;
}

static void
new_iterates_nothing(void **state)
{
    double *h = heights();
    struct rc_solver *s = solver(h, &posed);

    (void)state;
    assert_int_equal(iterations(s), 0);
    assert_true(rc_solver_convolutions(s) == 0);
    rc_solver_free(s);
    free(h);
}

/* Grids of 75 x 49 and 38 x 25 nodes, and then the map's own. */
static void
coarse_grids_pass_in_steps(void **state)
{
    double *h = heights(), last = 0;
    struct rc_solver *s = solver(h, &posed);
    size_t coarsest = shape.nx * shape.ny, steps = 0;
    enum rc_status status;

    (void)state;
    do {
        status = rc_solver_step(s);
        coarsest = grid_nodes(s) < coarsest ? grid_nodes(s) : coarsest;
        assert_true(rc_solver_convolutions(s) >= last);
        last = rc_solver_convolutions(s);
        steps++;
    } while (status == RC_MORE && iterations(s) == 0);
    assert_int_equal(coarsest, 19 * 13);
    assert_true(steps > 6);
    assert_true(last > 0);
    assert_int_equal(grid_nodes(s), shape.nx * shape.ny);
    rc_solver_free(s);
    free(h);
}

/* A solver that is stopped at any step has pressures that carry the load within the bounds, and does not
 * report convergence. */
static void
a_result_at_any_step(void **state)
{
    double *h = heights();
    size_t most = 1000;

    (void)state;
    for (size_t stop = 0; stop < most; stop++) {
        struct rc_solver *s = solver(h, &posed);
        struct rc_contact c;
        enum rc_status status = RC_MORE;

        for (size_t k = 0; k < stop && status == RC_MORE; k++)
            status = rc_solver_step(s);
        rc_solver_result(s, NULL, NULL, &c);
        assert_true(fabs(c.load / posed.load - 1) <= 1e-12);
        assert_true(c.max_pressure <= posed.hardness);
        assert_true(c.converged == (c.pressure_error <= posed.tol));
        assert_true(c.converged || status == RC_MORE);
        if (status != RC_MORE)
            most = 0;
        rc_solver_free(s);
    }
    free(h);
}

static void
a_given_start_does_without(void **state)
{
    double *h = heights();
    struct rc_solver *a = solver(h, &posed), *b = solver(h, &posed);
    struct rc_err err;

    (void)state;
    while (rc_solver_step(a) == RC_MORE)
        continue;
    assert_int_equal(rc_solver_warm_start(b, posed.load, rc_solver_pressure(a), &err), RC_OK);
    assert_int_equal(rc_solver_step(b), RC_OK);
    assert_int_equal(iterations(b), 1);
    /* K p by rows, a correction with its weights, and the same in double precision */
    assert_true(rc_solver_convolutions(b) <= 0.5 + 2 + 1 + 2);
    rc_solver_free(a);
    rc_solver_free(b);
    free(h);
}

/* Another load before the first step: the coarser grids are solved for this load. */
static void
another_load_before_the_first_step(void **state)
{
    struct rc_problem other = posed;
    double *h = heights();
    struct rc_solver *a, *b;
    struct rc_contact c, d;
    struct rc_err err;

    (void)state;
    other.load = 0.4;
    a = solver(h, &other);
    b = solver(h, &posed);
    assert_int_equal(rc_solver_set_load(b, other.load, 0, &err), RC_OK);
    while (rc_solver_step(a) == RC_MORE)
        continue;
    while (rc_solver_step(b) == RC_MORE)
        continue;
    rc_solver_result(a, NULL, NULL, &c);
    rc_solver_result(b, NULL, NULL, &d);
    assert_int_equal(c.iterations, d.iterations);
    assert_true(c.convolutions == d.convolutions);
    assert_memory_equal(rc_solver_pressure(a), rc_solver_pressure(b),
                        shape.nx * shape.ny * sizeof(double));
    rc_solver_free(a);
    rc_solver_free(b);
    free(h);
}

static void
wrong_order_is_refused(void **state)
{
    double *h = heights(), *p = calloc(shape.nx * shape.ny, sizeof *p), stiffness;
    struct rc_solver *s = solver(h, &posed);
    struct rc_contact c;
    struct rc_err err;

    (void)state;
    assert_int_equal(rc_solver_plastic(s, p, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "rc_solver_result"));
    assert_int_equal(rc_solver_stiffness(s, &stiffness, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "rc_solver_result"));
    assert_int_equal(rc_solver_step(s), RC_MORE);
    assert_int_equal(rc_solver_warm_start(s, posed.load, rc_solver_pressure(s), &err), RC_FAIL);
    assert_non_null(strstr(err.text, "before the first step"));
    rc_solver_result(s, NULL, NULL, &c);
    assert_int_equal(rc_solver_plastic(s, p, &err), RC_OK);
    assert_int_equal(rc_solver_stiffness(s, &stiffness, &err), RC_OK);
    assert_int_equal(rc_solver_step(s), RC_MORE);
    assert_int_equal(rc_solver_plastic(s, p, &err), RC_FAIL); /* p is the map of another pressure */
    assert_int_equal(rc_solver_set_load(s, 0.1, 0, &err), RC_OK);
    assert_int_equal(rc_solver_warm_start(s, 0.1, rc_solver_pressure(s), &err), RC_OK);
    rc_solver_free(s);
    free(h);
    free(p);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(new_iterates_nothing),
        cmocka_unit_test(coarse_grids_pass_in_steps),
        cmocka_unit_test(a_result_at_any_step),
        cmocka_unit_test(a_given_start_does_without),
        cmocka_unit_test(another_load_before_the_first_step),
        cmocka_unit_test(wrong_order_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
