/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Other heights in the same solver. The result is that of a new solver, whatever the heights before. A
 * loading history in one solver equals the same history in new solvers, step by step. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

static const struct rc_shape shape = {61, 50, 1.65e-6, 1.95e-6};
enum {
    N = 61 * 50
};
static double first[N], other[N];

static void
make_heights(void)
{
    struct rc_selfaffine rough = {
        .hurst = 0.7, .rms_slope = 0.05, .short_cut = 9e-6, .long_cut = 60e-6, .seed = 4};

    assert_int_equal(rc_synth_selfaffine(&shape, &rough, first, NULL), RC_OK);
    rough.seed = 5;
    assert_int_equal(rc_synth_selfaffine(&shape, &rough, other, NULL), RC_OK);
}

static struct rc_problem
problem_of(int boundary, bool plastic)
{
    return (struct rc_problem){.boundary = boundary == 0 ? RC_FREE : RC_PERIODIC,
                               .pair.estar = 3.7e9,
                               .load = 0.8,
                               .tol = 1e-7,
                               .hardness = plastic ? 2e8 : 0,
                               .method = contact_method};
}

/* Heights of another shape, a thousand times as high or low, and far from 0. They are set before the first
 * step, in the middle, and after the last one. */
static void
as_a_new_solver(void **state)
{
    static const struct {
        double times, datum;
    } rows[] = {{1, 0}, {1e-3, 0}, {3, 1e-3}, {30, -2e-6}};
    static double h[N];

    (void)state;
    for (int way = 0; way < 8; way++)
        for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
            for (int steps = 0; steps < 3; steps++) {
                struct rc_problem problem = problem_of(way & 1, (way & 2) != 0), given = problem;
                struct rc_solver *s, *t;
                struct rc_contact c, d;

                if (way & 4) { /* the load is searched for */
                    problem.load = 0;
                    problem.approach = 1e-7 * fmin(rows[r].times, 1);
                    if (rows[r].times > 1)
                        continue;
                }
                for (size_t k = 0; k < N; k++)
                    h[k] = rows[r].times * other[k] + rows[r].datum;
                s = rc_solver_new(&shape, first, &problem, NULL);
                assert_non_null(s);
                for (int k = 0; k < 3 * steps; k++)
                    (void)rc_solver_step(s);
                if (steps == 2)
                    (void)finish(s);
                assert_int_equal(rc_solver_set_heights(s, h, NULL), RC_OK);
                c = finish(s);
                given.load = c.load;
                t = rc_solver_new(&shape, h, &given, NULL);
                assert_non_null(t);
                d = finish(t);
                assert_true(distance(N, rc_solver_pressure(s), rc_solver_pressure(t)) <
                            2 * problem.tol); /* each to that */
                assert_true(isnan(c.approach) == isnan(d.approach));
                assert_true(isnan(c.approach) ||
                            fabs(c.approach - d.approach) < 1e-5 * fabs(d.approach));
                assert_true(!(way & 4) || fabs(c.approach / problem.approach - 1) < 1e-5);
                rc_solver_free(s);
                rc_solver_free(t);
            }
}

/* The figures from a coarser grid are those of these heights and this load, or there are none. */
static void
grid_error_is_its_own(void **state)
{
    struct rc_problem problem = problem_of(1, false);
    struct rc_solver *s, *t;
    struct rc_contact c, d;

    (void)state;
    if (strcmp(contact_method, "pcg") != 0)
        skip(); /* it comes with the nested start */
    problem.discretization = true;
    s = rc_solver_new(&shape, first, &problem, NULL);
    c = finish(s);
    problem.load *= 3;
    assert_int_equal(rc_solver_set_load(s, problem.load, 0, NULL), RC_OK);
    assert_int_equal(rc_solver_set_heights(s, other, NULL), RC_OK);
    c = finish(s);
    t = rc_solver_new(&shape, other, &problem, NULL);
    d = finish(t);
    assert_true(fabs(c.discretization.max_pressure - d.discretization.max_pressure) < 1e-6);
    assert_true(fabs(c.discretization.approach - d.discretization.approach) < 1e-6);
    rc_solver_free(s);
    rc_solver_free(t);
}

static void
refused(void **state)
{
    struct rc_problem problem = problem_of(1, false);
    struct rc_solver *s = rc_solver_new(&shape, first, &problem, NULL);
    static double h[N], p[N];
    struct rc_err err;

    (void)state;
    (void)finish(s);
    memcpy(p, rc_solver_pressure(s), sizeof p);
    memcpy(h, other, sizeof h);
    h[77] = NAN;
    assert_int_equal(rc_solver_set_heights(s, h, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "height 77 is not a finite number"));
    (void)finish(s); /* it is unchanged */
    assert_true(distance(N, rc_solver_pressure(s), p) < 2 * problem.tol);
    assert_int_equal(rc_solver_set_load(s, 0, 1e-3, &err), RC_FAIL);
    assert_non_null(
        strstr(err.text, "approach 0.001 m: the contact of this periodic surface is complete at "));
    rc_solver_free(s);
}

/* The history is touch, load, separation, a higher load, a lower one, and again. It runs by keep_shape, and
 * by new solvers with the kept shapes. */
static void
history(void **state)
{
    static const double loads[] = {0.3, 0.8, 0, 0.8, 0.5, 1.4, 1.4};
    static double h[N], g[N], gap[N];

    (void)state;
    for (int boundary = 0; boundary < 2; boundary++) {
        struct rc_problem problem = problem_of(boundary, true);
        struct rc_solver *s;
        double height_error = 0;
        size_t yielded = 0;

        problem.load = loads[0];
        problem.history_part =
            0.1 * 0.3 / 0.8; /* the errors of later loads must stay within the tolerance */
        s = rc_solver_new(&shape, first, &problem, NULL);
        memcpy(h, first, sizeof h);
        memcpy(g, first, sizeof g);
        for (size_t k = 0; k < sizeof loads / sizeof *loads; k++) {
            struct rc_contact c, d;
            struct rc_solver *t;

            if (loads[k] == 0) {
                double top = -INFINITY, mean = 0;
                rc_contact_apart(NULL, &shape, h, gap, &c);
                for (size_t i = 0; i < N; i++) {
                    top = larger(top, h[i]);
                    mean += gap[i] / N;
                }
                for (size_t i = 0; i < N; i++)
                    assert_true(gap[i] == top - h[i]);
                assert_true(c.load == 0 && c.contact_nodes == 0 && c.converged);
                assert_true(fabs(c.mean_gap - mean) < 1e-12 * mean);
                continue;
            }
            assert_int_equal(rc_solver_set_load(s, loads[k], 0, NULL), RC_OK);
            c = finish(s);
            assert_int_equal(rc_solver_keep_shape(s, &c, h, NULL), RC_OK);
            problem.load = loads[k];
            problem.height_error = height_error;
            t = rc_solver_new(&shape, g, &problem, NULL);
            d = finish(t);
            assert_true(distance(N, rc_solver_pressure(s), rc_solver_pressure(t)) <
                        8 * problem.tol);
            assert_int_equal(c.yielded_nodes > 0, d.yielded_nodes > 0);
            if (d.yielded_nodes > 0) {
                assert_int_equal(rc_solver_plastic(t, g, NULL), RC_OK);
                height_error = larger(height_error, d.gap_error);
                yielded++;
            }
            assert_true(d.shape_error == height_error);
            assert_true(distance(N, h, g) < 8 * problem.tol);
            rc_solver_free(t);
        }
        assert_int_equal(yielded, 3); /* the values are 0.3, 0.8 and 1.4, each once */
        rc_solver_free(s);
    }
}

/* Loaded again to the same load, directly or after a smaller one, a yielded shape is at the hardness in the
 * same places. The same nodes are counted; at a tolerance of 1e-4 one node may differ. */
static void
reload_reaches_the_same_nodes(void **state)
{
    static const double loads[] = {0.8, 0.3, 0.8, 0.8, 0.1, 0.8};
    static double h[N];

    (void)state;
    for (int boundary = 0; boundary < 2; boundary++)
        for (int t = 0; t < 3; t++) {
            struct rc_problem problem = problem_of(boundary, true);
            struct rc_solver *s;
            size_t full = 0;

            problem.tol = (double[]){1e-4, 1e-7, 1e-9}[t];
            problem.history_part = 0.1 * 0.1 / 0.8;
            s = rc_solver_new(&shape, first, &problem, NULL);
            memcpy(h, first, sizeof h);
            for (size_t k = 0; k < sizeof loads / sizeof *loads; k++) {
                struct rc_contact c;
                assert_int_equal(rc_solver_set_load(s, loads[k], 0, NULL), RC_OK);
                c = finish(s);
                full = k == 0 ? c.plastic_nodes : full;
                assert_true(full > 50 && (c.yielded_nodes > 0) == (k == 0));
                if (loads[k] == loads[0])
                    assert_true(fabs((double)c.plastic_nodes - (double)full) <= (t == 0));
                assert_int_equal(rc_solver_keep_shape(s, &c, h, NULL), RC_OK);
            }
            rc_solver_free(s);
        }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_a_new_solver),
        cmocka_unit_test(grid_error_is_its_own),
        cmocka_unit_test(refused),
        cmocka_unit_test(history),
        cmocka_unit_test(reload_reaches_the_same_nodes),
    };
    int failed = 0;

    make_heights();
    RUN_FOR_EACH_METHOD(tests, failed);
    return failed;
}
