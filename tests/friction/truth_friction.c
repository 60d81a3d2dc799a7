/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact and friction together: a sticking punch is stiffer by Mossakovskii's factor; pressure and tractions
 * after the alternating passes are consistent. The change decreases from pass to pass; for identical
 * materials nothing is solved twice. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>

#include "libcontact/friction/friction.h"
#include "slip_case.h"

enum {
    SIDE = 64,
    NODES = SIDE * SIDE
};

static const struct rc_shape shape = {SIDE, SIDE, 1, 1};

/* ---- a flat punch ---- */

/* The approach of a punch of radius a (in nodes) under a unit load; one body is rigid, the other has
 * Poisson's ratio nu. */
static double
press_punch(double a, double nu, enum rc_coupling coupling, double *sticks)
{
    const struct rc_pair pair = {.one = {.e = 1 - nu * nu, .nu = nu}};
    const struct rc_problem contact = {.pair = pair, .tol = 1e-6};
    const struct rc_friction_problem law = {
        .law = {.pair = pair, .mu = 1, .tol = 1e-5}, .coupling = coupling, .increments = 1};
    double *h = malloc(NODES * sizeof *h), middle = (SIDE - 1) / 2.0;
    struct rc_friction_figures f;
    struct rc_model *m;

    for (size_t k = 0; k < NODES; k++) {
        double x = (double)(k % SIDE) - middle, y = (double)(k / SIDE) - middle;
        h[k] = hypot(x, y) <= a ? 0 : -10;
    }
    m = slip_model(&shape, h, &contact, &law, NULL);
    assert_non_null(m);
    assert_int_equal(slip_go(m, 1, 0, 0, false, NULL), RC_OK);
    f = *rc_friction_result(m);
    assert_true(fabs(f.last.load - 1) < 1e-9);
    *sticks = (double)f.last.stick_nodes / (double)(f.last.stick_nodes + f.last.slip_nodes);
    rc_model_free(m);
    free(h);
    return f.approach;
}

/* (1 - nu) ln(3 - 4 nu)/(1 - 2 nu): the stiffness of a sticking punch over that of a frictionless one
 * (Mossakovskii 1954; Spence 1968). At this mu all of it sticks, except a ring at the edge that is narrower
 * than a node. */
static void
test_a_punch_that_sticks(void **state)
{
    static const double nus[] = {0, 0.3};

    (void)state;
    for (int k = 0; k < 2; k++) {
        double nu = nus[k], exact = (1 - nu) * log(3 - 4 * nu) / (1 - 2 * nu), sticks, ratio[2];
        for (int fine = 0; fine < 2; fine++) {
            double a = fine ? 24.3 : 12.2;
            double smooth = press_punch(a, nu, RC_COUPLING_NONE, &sticks);
            double goodman = press_punch(a, nu, RC_COUPLING_GOODMAN, &sticks);
            ratio[fine] = smooth / press_punch(a, nu, RC_COUPLING_FULL, &sticks);
            assert_true(fabs(smooth / goodman - 1) < 1e-6);
        }
        print_message("nu %.1f: %.4f, %.4f times as stiff, exact %.4f; %.3f sticks\n", nu, ratio[0],
                      ratio[1], exact, sticks);
        for (int fine = 0; fine < 2; fine++)
            assert_true(fabs(ratio[fine] - exact) < 0.08 * (exact - 1));
        assert_true(sticks > 0.85);
    }
}

/* ---- rough surfaces ---- */

static const double load = 0.016 * NODES;

static struct rc_friction_problem
rough_law(double mu, double nu, struct rc_boundary boundary, enum rc_coupling coupling)
{
    return (struct rc_friction_problem){.law = {.boundary = boundary,
                                                .pair = {.one = {.e = 1 - nu * nu, .nu = nu}},
                                                .mu = mu,
                                                .tol = 1e-4},
                                        .coupling = coupling,
                                        .increments = 1};
}

static struct rc_model *
rough_model(const double *h, const struct rc_friction_problem *law, struct rc_err *err)
{
    const struct rc_problem contact = {.boundary = law->law.boundary,
                                       .pair = law->law.pair,
                                       .engine = "fft64",
                                       .tol = law->law.tol / 4};

    return slip_model(&shape, h, &contact, law, err);
}

/* Solves the contact under these tractions, and the tractions under this pressure, each from zero. */
static void
check_each_other(struct rc_model *m, const double *h, const struct rc_friction_problem *law)
{
    const struct rc_friction_figures *f = rc_friction_result(m);
    double *less = malloc(NODES * sizeof *less), change = 0, sum = 0;
    double *p = malloc(NODES * sizeof *p),
           *q[2] = {malloc(NODES * sizeof *p), malloc(NODES * sizeof *p)};
    const double *found[2] = {q[0], q[1]}, *again[2];
    struct rc_friction_law alone = law->law;
    struct rc_friction_solver *slip;
    struct rc_friction_increment figures;
    struct pressed pressed;
    struct rc_contact apart;

    assert_int_equal(rc_model_frame(m, "pressure", p, NULL), RC_OK);
    assert_int_equal(rc_model_frame(m, "traction-x", q[0], NULL), RC_OK);
    assert_int_equal(rc_model_frame(m, "traction-y", q[1], NULL), RC_OK);
    alone.tol = 1e-7;
    slip = rc_friction_solver_new(&shape, &alone, NULL);
    assert_non_null(slip);
    rc_friction_solver_start(slip, found);
    rc_friction_solver_normal(slip, less);
    rc_friction_solver_free(slip);
    for (size_t k = 0; k < NODES; k++)
        less[k] = h[k] - less[k];
    pressed = pressed_new(&shape, law->law.boundary, less, 1, f->last.load, 1e-7);
    for (size_t k = 0; k < NODES; k++) {
        change += fabs(pressed.p[k] - p[k]);
        sum += pressed.p[k];
    }
    slip = rc_friction_solver_new(&shape, &alone, NULL);
    assert_non_null(slip);
    rc_contact_apart(NULL, &shape, h, less, &apart); /* the path starts from separated bodies, as in
                                                        the model */
    assert_int_equal(rc_friction_solver_set_pressure(slip, NULL, less, NULL), RC_OK);
    assert_int_equal(rc_friction_solver_set_force(slip, 0, 0, NULL), RC_OK);
    assert_int_equal(slip_solve(slip, &figures), RC_OK);
    rc_friction_solver_keep(slip);
    assert_int_equal(rc_friction_solver_set_pressure(slip, p, NULL, NULL), RC_OK);
    assert_int_equal(rc_friction_solver_set_force(slip, f->last.force[0], f->last.force[1], NULL),
                     RC_OK);
    assert_int_equal(slip_solve(slip, &figures), RC_OK);
    again[0] = rc_friction_solver_traction(slip, 0);
    again[1] = rc_friction_solver_traction(slip, 1);
    print_message("  pressure off by %.1e, tractions by %.1e, estimate %.1e\n", change / sum,
                  slip_distance(NODES, found, again), f->traction_error);
    assert_true(change < 1e-4 * sum);
    assert_true(slip_distance(NODES, found, again) < 1e-4);
    rc_friction_solver_free(slip);
    pressed_free(&pressed);
    free(p);
    free(q[0]);
    free(q[1]);
}

static void
test_pressure_and_tractions_know_each_other(void **state)
{
    static const struct {
        double mu, nu; /* beta (1 - 2 nu)/(2 (1 - nu)) */
        size_t passes; /* two more than the passes of an independent program to 1e-4 */
        bool x, y;     /* the map repeats */
    } cases[] = {{0.2, 0.3, 7, true, true}, {0.5, 0.3, 8, true, true},  {1, 0.3, 9, true, true},
                 {0.5, 0.1, 9, true, true}, {0.5, 0.3, 8, true, false}, {0.5, 0.1, 9, false, true}};

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct rc_friction_problem law = rough_law(
            cases[k].mu, cases[k].nu, rc_boundary_of(cases[k].x, cases[k].y), RC_COUPLING_FULL);
        double *h = slip_rough(&shape, 0.1, 4, 7);
        struct rc_model *m = rough_model(h, &law, NULL);
        struct rc_friction_figures f;
        assert_non_null(m);
        assert_int_equal(slip_go(m, load, cases[k].mu * load / 2, 0, false, NULL), RC_OK);
        f = *rc_friction_result(m);
        print_message("mu %.1f, nu %.1f: %zu passes, %.0f convolutions\n", cases[k].mu, cases[k].nu,
                      f.passes, f.convolutions);
        assert_true(f.converged && f.passes > 1 && f.passes <= cases[k].passes);
        assert_true(fabs(f.last.force[0] - cases[k].mu * load / 2) < 1e-9 * load);
        check_each_other(m, h, &law);
        rc_model_free(m);
        free(h);
    }
}

/* Each pass starts from the tractions of the pass before: on a long periodic profile a pass takes at most 40
 * convolutions, with its contact, also at 0.95 of the limiting force. */
static void
test_passes_of_a_profile(void **state)
{
    const struct rc_shape line = {16384, 1, 1, 1};
    const struct rc_selfaffine rough = {
        .hurst = 0.8, .rms_slope = 0.05, .rolloff = 4096, .short_cut = 4, .seed = 5};
    const struct rc_pair pair = {.one = {.e = 1 - 0.3 * 0.3, .nu = 0.3}};
    const double force = 0.00546 * 16384;
    const struct rc_problem contact = {.boundary = RC_PERIODIC, .pair = pair, .tol = 2.5e-3};
    const struct rc_friction_problem law = {
        .law = {.boundary = RC_PERIODIC, .pair = pair, .mu = 0.3, .tol = 1e-2}, .increments = 1};
    double *h = malloc(line.nx * sizeof *h);
    struct rc_model *m;

    (void)state;
    assert_int_equal(rc_synth_selfaffine(&line, &rough, h, NULL), RC_OK);
    m = slip_model(&line, h, &contact, &law, NULL);
    assert_non_null(m);
    for (int k = 0; k < 2; k++) { /* pressed, then moved */
        const struct rc_friction_figures *f = rc_friction_result(m);
        assert_int_equal(slip_go(m, force, k * 0.285 * force, 0, false, NULL), RC_OK);
        print_message("%zu passes, %.0f convolutions\n", f->passes, f->convolutions);
        assert_true(f->passes > 3 && f->convolutions <= 40 * (double)f->passes);
        assert_int_equal(rc_model_keep(m, NULL), RC_OK);
    }
    rc_model_free(m);
    free(h);
}

/* ---- equal bodies ---- */

/* With heights, and without: the known contact is not solved; other ones are, or are refused. */
static void
test_alike_nothing_is_solved_twice(void **state)
{
    double *h = slip_rough(&shape, 0.1, 4, 7), moved[2], *p = malloc(NODES * sizeof *p);
    struct pressed c =
        pressed_new(&shape, RC_PERIODIC, slip_rough(&shape, 0.1, 4, 7), 1, load, 1e-6);
    struct rc_friction_problem law = rough_law(0.3, 0.3, RC_PERIODIC, RC_COUPLING_FULL);
    struct rc_model *with, *without;
    struct rc_friction_solver *slip;
    struct rc_friction_figures f, g;
    struct rc_friction_increment s;
    struct rc_err err;

    (void)state;
    law.law.pair = (struct rc_pair){.estar = 1};
    law.law.nu = 0.3;
    law.known_load = load;
    law.known_p = c.p;
    law.known_gap = c.gap;
    with = rough_model(h, &law, NULL);
    without = rough_model(NULL, &law, NULL);
    slip = rc_friction_solver_new(&shape, &law.law, NULL);
    assert_true(with != NULL && without != NULL && slip != NULL);
    for (int k = 0; k < 2; k++) { /* pressed, then moved */
        double force = k * 0.15 * load;
        assert_int_equal(slip_go(with, load, force, 0, false, NULL), RC_OK);
        assert_int_equal(slip_go(without, load, force, 0, false, NULL), RC_OK);
        f = *rc_friction_result(with);
        g = *rc_friction_result(without);
        assert_int_equal(rc_friction_solver_set_pressure(slip, c.p, c.gap, NULL), RC_OK);
        assert_int_equal(rc_friction_solver_set_force(slip, force, 0, NULL), RC_OK);
        assert_int_equal(slip_solve(slip, &s), RC_OK);
        assert_true(f.passes == 1 && g.passes == 1);
        assert_true(f.convolutions == g.convolutions && f.contact_error == 0);
        assert_int_equal(rc_model_frame(with, "pressure", p, NULL), RC_OK);
        assert_memory_equal(p, c.p, NODES * sizeof *p);
        moved[k] = s.displacement[0];
        assert_true(f.last.displacement[0] == moved[k] && g.last.displacement[0] == moved[k]);
        assert_int_equal(rc_model_keep(with, NULL), RC_OK);
        assert_int_equal(rc_model_keep(without, NULL), RC_OK);
        rc_friction_solver_keep(slip);
    }
    assert_true(moved[0] == 0 && moved[1] > 0);
    assert_int_equal(slip_go(without, load / 2, 0.1 * load, 0, false, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "without heights it cannot be solved"));
    assert_int_equal(slip_go(without, 0, 0, 0, false, NULL), RC_OK);
    assert_int_equal(slip_go(with, load / 2, 0.1 * load, 0, false, NULL), RC_OK);
    f = *rc_friction_result(with);
    assert_true(fabs(f.last.load - load / 2) < 1e-9 * load && isfinite(f.approach));
    assert_int_equal(rc_model_keep(with, NULL), RC_OK);
    assert_int_equal(slip_go(with, 0, 0, 0, false, NULL), RC_OK);
    f = *rc_friction_result(with);
    assert_int_equal(rc_model_frame(with, "pressure", p, NULL), RC_OK);
    assert_true(f.last.stick_nodes + f.last.slip_nodes == 0 && rc_sum(p, NODES) == 0);
    rc_model_free(with);
    rc_model_free(without);
    rc_friction_solver_free(slip);
    pressed_free(&c);
    free(h);
    free(p);
}

static void
test_what_is_refused(void **state)
{
    struct rc_friction_problem law = rough_law(0.3, 0.3, RC_PERIODIC, RC_COUPLING_FULL);
    double *h = slip_rough(&shape, 0.1, 4, 7);
    struct rc_err err;
    struct rc_model *m;

    (void)state;
    assert_null(rough_model(NULL, &law, &err));
    assert_non_null(strstr(err.text, "depends on their tractions: give heights"));
    law.fewer = 1;
    assert_null(rough_model(h, &law, &err));
    assert_non_null(strstr(err.text, "its own inner model"));
    law.fewer = 3;
    assert_null(rough_model(h, &law, &err));
    assert_non_null(strstr(err.text, "3 ways with fewer increments"));
    law.fewer = 0;
    law.law.mu = 0;
    assert_null(rough_model(h, &law, &err));
    law.law.mu = 0.3;
    assert_null(slip_model(&shape, h, &(struct rc_problem){.pair = law.law.pair}, &law, &err));
    assert_non_null(strstr(err.text, "the boundary of the friction model is "));
    law.coupling = RC_COUPLING_GOODMAN;
    m = rough_model(h, &law, &err);
    assert_non_null(m);
    assert_int_equal(slip_go(m, -1, 0, 0, false, &err), RC_FAIL);
    assert_int_equal(slip_go(m, NAN, 0, 0, false, &err), RC_FAIL);
    assert_int_equal(slip_go(m, 1, 0.4, 0, false, &err), RC_FAIL); /* beyond friction */
    rc_model_free(m);
    free(h);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_punch_that_sticks),
        cmocka_unit_test(test_pressure_and_tractions_know_each_other),
        cmocka_unit_test(test_passes_of_a_profile),
        cmocka_unit_test(test_alike_nothing_is_solved_twice),
        cmocka_unit_test(test_what_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
