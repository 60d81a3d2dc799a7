/* Contact and friction together: a sticking punch is stiffer by Mossakovskii's factor; pressure and tractions
 * after the alternating passes are consistent; the change decreases from pass to pass; for identical
 * materials nothing is solved twice. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>

#include "slip_case.h"

enum {
    SIDE = 64,
    NODES = SIDE * SIDE
};

static const struct rc_shape shape = {SIDE, SIDE, 1, 1};

static enum rc_status
finish(struct rc_joint *joint, struct rc_joint_figures *f)
{
    struct rc_err err = {""};
    enum rc_status status;

    do
        status = rc_joint_step(joint, &err);
    while (status == RC_MORE);
    if (status == RC_FAIL)
        fprintf(stderr, "%s\n", err.text);
    rc_joint_result(joint, f);
    return status;
}

/* ---- a flat punch ---- */

/* The approach of a punch of radius a (in nodes) under a unit load; one body is rigid, the other has
 * Poisson's ratio nu. */
static double
press_punch(double a, double nu, enum rc_coupling coupling, double *sticks)
{
    struct rc_joint_problem what = {
        .contact = {.pair = {.one = {.e = 1 - nu * nu, .nu = nu}}, .load = 1, .tol = 1e-6},
        .slip = {.mu = 1, .tol = 1e-5},
        .coupling = coupling};
    double *h = malloc(NODES * sizeof *h), middle = (SIDE - 1) / 2.0;
    struct rc_joint_figures f;
    struct rc_joint *joint;

    for (size_t k = 0; k < NODES; k++) {
        double x = (double)(k % SIDE) - middle, y = (double)(k / SIDE) - middle;
        h[k] = hypot(x, y) <= a ? 0 : -10;
    }
    joint = rc_joint_new(&shape, h, &what, NULL);
    assert_non_null(joint);
    assert_int_equal(rc_joint_set_force(joint, 1, 0, 0, NULL), RC_OK);
    assert_int_equal(finish(joint, &f), RC_OK);
    assert_true(fabs(f.slip.load - 1) < 1e-9);
    *sticks = (double)f.slip.stick_nodes / (double)(f.slip.stick_nodes + f.slip.slip_nodes);
    rc_joint_free(joint);
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

static struct rc_joint_problem
rough_problem(double mu, double nu, double load, enum rc_coupling coupling)
{
    return (struct rc_joint_problem){.contact = {.boundary = RC_PERIODIC,
                                                 .pair = {.one = {.e = 1 - nu * nu, .nu = nu}},
                                                 .load = load,
                                                 .engine = "fft64"},
                                     .slip = {.mu = mu, .tol = 1e-4},
                                     .coupling = coupling};
}

/* Solves the contact under these tractions, and the tractions under this pressure, each from zero. */
static void
check_each_other(struct rc_joint *joint, const double *h, const struct rc_joint_problem *what,
                 const struct rc_joint_figures *f)
{
    double *less = malloc(NODES * sizeof *less), change = 0, sum = 0;
    struct rc_problem contact = what->contact;
    struct rc_slip_problem alone = what->slip;
    struct rc_slip *slip;
    struct rc_slip_figures figures;
    struct pressed pressed;
    struct rc_contact apart;
    const double *p = rc_joint_pressure(joint);
    const double *q[2] = {rc_slip_traction(rc_joint_slip(joint), 0),
                          rc_slip_traction(rc_joint_slip(joint), 1)};
    const double *again[2];

    rc_slip_normal(rc_joint_slip(joint), less);
    for (size_t k = 0; k < NODES; k++)
        less[k] = h[k] - less[k];
    pressed = pressed_new(&shape, RC_PERIODIC, less, 1, f->slip.load, 1e-7);
    for (size_t k = 0; k < NODES; k++) {
        change += fabs(pressed.p[k] - p[k]);
        sum += pressed.p[k];
    }
    alone.boundary = RC_PERIODIC;
    alone.pair = contact.pair;
    alone.tol = 1e-7;
    slip = rc_slip_new(&shape, &alone, NULL);
    assert_non_null(slip);
    rc_contact_apart(NULL, &shape, h, less, &apart); /* from separated bodies, like the joint */
    assert_int_equal(rc_slip_set_pressure(slip, NULL, less, NULL), RC_OK);
    assert_int_equal(rc_slip_set_force(slip, 0, 0, NULL), RC_OK);
    assert_int_equal(slip_solve(slip, &figures), RC_OK);
    rc_slip_keep(slip);
    assert_int_equal(rc_slip_set_pressure(slip, p, NULL, NULL), RC_OK);
    assert_int_equal(rc_slip_set_force(slip, f->slip.force[0], f->slip.force[1], NULL), RC_OK);
    assert_int_equal(slip_solve(slip, &figures), RC_OK);
    again[0] = rc_slip_traction(slip, 0);
    again[1] = rc_slip_traction(slip, 1);
    print_message("  pressure off by %.1e, tractions by %.1e, estimate %.1e\n", change / sum,
                  slip_distance(NODES, q, again), f->traction_error);
    assert_true(change < 1e-4 * sum);
    assert_true(slip_distance(NODES, q, again) < 1e-4);
    rc_slip_free(slip);
    pressed_free(&pressed);
}

static void
test_pressure_and_tractions_know_each_other(void **state)
{
    static const struct {
        double mu, nu; /* beta (1 - 2 nu)/(2 (1 - nu)) */
        size_t passes; /* passes to 1e-4 of an independent program, plus two */
    } cases[] = {{0.2, 0.3, 7}, {0.5, 0.3, 8}, {1, 0.3, 9}, {0.5, 0.1, 9}};
    double load = 0.016 * NODES;

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct rc_joint_problem what =
            rough_problem(cases[k].mu, cases[k].nu, load, RC_COUPLING_FULL);
        double *h = slip_rough(&shape, 0.1, 4, 7);
        struct rc_joint *joint = rc_joint_new(&shape, h, &what, NULL);
        struct rc_joint_figures f;
        assert_non_null(joint);
        assert_int_equal(rc_joint_set_force(joint, load, cases[k].mu * load / 2, 0, NULL), RC_OK);
        assert_int_equal(finish(joint, &f), RC_OK);
        print_message("mu %.1f, beta %.3f: %zu passes, %.0f convolutions\n", cases[k].mu,
                      rc_slip_beta(rc_joint_slip(joint)), f.passes, f.convolutions);
        assert_true(f.converged && f.passes > 1 && f.passes <= cases[k].passes);
        assert_true(fabs(f.slip.force[0] - cases[k].mu * load / 2) < 1e-9 * load);
        check_each_other(joint, h, &what, &f);
        rc_joint_free(joint);
        free(h);
    }
}

/* ---- bodies that are alike ---- */

static void
test_alike_nothing_is_solved_twice(void **state)
{
    double load = 0.016 * NODES, *h = slip_rough(&shape, 0.1, 4, 7), moved[2];
    struct pressed c =
        pressed_new(&shape, RC_PERIODIC, slip_rough(&shape, 0.1, 4, 7), 1, load, 1e-6);
    struct rc_joint_problem what = {
        .contact = {.boundary = RC_PERIODIC, .pair.estar = 1, .load = load},
        .slip = {.mu = 0.3, .nu = 0.3}};
    struct rc_slip_problem alone = {.boundary = RC_PERIODIC, .pair.estar = 1, .nu = 0.3, .mu = 0.3};
    struct rc_joint *with = rc_joint_new(&shape, h, &what, NULL);
    struct rc_joint *without = rc_joint_new(&shape, NULL, &what, NULL);
    struct rc_slip *slip = rc_slip_new(&shape, &alone, NULL);
    struct rc_joint_figures f, g;
    struct rc_slip_figures s;

    (void)state;
    assert_non_null(with);
    assert_non_null(without);
    assert_non_null(slip);
    assert_true(rc_joint_memory(&shape, &what, true) > rc_joint_memory(&shape, &what, false));
    assert_true(rc_joint_memory(&shape, &what, false) > rc_slip_memory(&shape, &alone));
    rc_joint_know(with, load, c.p, c.gap);
    rc_joint_know(without, load, c.p, c.gap);
    for (int k = 0; k < 2; k++) { /* pressed, then moved */
        double force = k * 0.15 * load;
        assert_int_equal(rc_joint_set_force(with, load, force, 0, NULL), RC_OK);
        assert_int_equal(rc_joint_set_force(without, load, force, 0, NULL), RC_OK);
        assert_int_equal(finish(with, &f), RC_OK);
        assert_int_equal(finish(without, &g), RC_OK);
        assert_int_equal(rc_slip_set_pressure(slip, c.p, c.gap, NULL), RC_OK);
        assert_int_equal(rc_slip_set_force(slip, force, 0, NULL), RC_OK);
        assert_int_equal(slip_solve(slip, &s), RC_OK);
        assert_true(f.passes == 1 && g.passes == 1);
        assert_true(rc_joint_pressure(with) == c.p);
        moved[k] = s.displacement[0];
        assert_true(f.slip.displacement[0] == moved[k] && g.slip.displacement[0] == moved[k]);
        rc_joint_keep(with);
        rc_joint_keep(without);
        rc_slip_keep(slip);
    }
    assert_true(moved[0] == 0 && moved[1] > 0);
    /* half the load: with heights a contact is solved, without heights it is refused */
    assert_int_equal(rc_joint_set_force(without, load / 2, 0.1 * load, 0, NULL), RC_FAIL);
    assert_int_equal(rc_joint_set_force(with, load / 2, 0.1 * load, 0, NULL), RC_OK);
    assert_int_equal(finish(with, &f), RC_OK);
    assert_true(fabs(f.slip.load - load / 2) < 1e-9 * load && isfinite(f.approach));
    rc_joint_keep(with);
    assert_int_equal(rc_joint_set_force(with, 0, 0, 0, NULL), RC_OK);
    assert_int_equal(finish(with, &f), RC_OK);
    assert_true(f.slip.stick_nodes + f.slip.slip_nodes == 0 && rc_joint_pressure(with) == NULL);
    rc_joint_free(with);
    rc_joint_free(without);
    rc_slip_free(slip);
    pressed_free(&c);
    free(h);
}

static void
test_what_is_refused(void **state)
{
    struct rc_joint_problem what = rough_problem(0.3, 0.3, 1, RC_COUPLING_FULL);
    double *h = slip_rough(&shape, 0.1, 4, 7);
    struct rc_joint *joint = rc_joint_new(&shape, NULL, &what, NULL);
    struct rc_joint_figures f;
    struct rc_err err;

    (void)state;
    assert_null(joint); /* tractions change the pressure: heights are needed */
    what.slip.mu = 0;
    assert_null(rc_joint_new(&shape, h, &what, NULL));
    assert_int_equal(rc_joint_memory(&shape, &what, true), 0);
    what.slip.mu = 0.3;
    what.coupling = RC_COUPLING_GOODMAN;
    joint = rc_joint_new(&shape, h, &what, &err);
    assert_non_null(joint);
    assert_int_equal(rc_joint_step(joint, &err), RC_FAIL);
    assert_int_equal(rc_joint_set_force(joint, -1, 0, 0, &err), RC_FAIL);
    assert_int_equal(rc_joint_set_force(joint, NAN, 0, 0, &err), RC_FAIL);
    assert_int_equal(rc_joint_set_force(joint, 1, 0.4, 0, &err), RC_OK);
    assert_int_equal(finish(joint, &f), RC_FAIL); /* beyond friction */
    assert_false(f.converged);
    rc_joint_free(joint);
    rc_joint_free(NULL);
    free(h);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_punch_that_sticks),
        cmocka_unit_test(test_pressure_and_tractions_know_each_other),
        cmocka_unit_test(test_alike_nothing_is_solved_twice),
        cmocka_unit_test(test_what_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
