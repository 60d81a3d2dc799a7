/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tractions of minimal energy equal those of another method with dense matrices, up to 24 nodes, with a
 * history. It minimises one node after another exactly on its disc until nothing changes, and Newton's method
 * finds the displacement for the force. Displacements are also given on periodic maps, where the contact may
 * be complete. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <stdio.h>

#include "libcontact/friction/friction.h"
#include "dense.h"
#include "slip_case.h"

enum {
    PROBLEMS = 20,
    PERIODIC = 80
};
static const double bound = 1e-9;

/* The motion of the surfaces along each other by a pressure, x then y; 0 for bodies that are alike. */
static void
push_by(const struct rc_shape *s, struct rc_boundary boundary, const struct line_pair *pair,
        const double *p, double *to)
{
    const size_t n = s->nx * s->ny;

    for (size_t k = 0; k < 2 * n; k++) {
        const size_t at = k % n;
        const enum line what = (k < n) == boundary.x ? LINE_PUSH_ALONG : LINE_PUSH_ACROSS;
        to[k] = 0;
        for (size_t from = 0; from < n && pair->beta != 0; from++)
            to[k] -= p[from] * line_at(what, s, boundary, pair,
                                       (double)(at % s->nx) - (double)(from % s->nx),
                                       (double)(at / s->nx) - (double)(from / s->nx));
    }
}

static void
another_method_finds_the_same(struct rc_boundary boundary)
{
    double worst = 0, moved = 0;
    size_t stuck = 0, slid = 0;

    for (int problem = 0; problem < PROBLEMS; problem++) {
        uint64_t seed = 77 + (uint64_t)problem;
        static const struct rc_shape shapes[] = {{6, 4, 1, 1},   {4, 5, 1, 1.7}, {3, 3, 1, 1},
                                                 {8, 3, 0.6, 1}, {2, 1, 1, 1},   {1, 7, 1, 1}};
        const struct rc_shape shape = shapes[problem % 6];
        size_t n = shape.nx * shape.ny;
        double nu = problem % 3 == 0 ? 0 : 0.5 * slip_noise(&seed), kap = nu / (1 - nu);
        bool given = problem % 4 == 3;
        /* a body on a rigid one, which its pressure moves along it */
        const bool alone = rc_repeats(boundary) == 1 && problem % 2 == 1;
        const struct line_pair pair = {kap, alone ? (1 - 2 * nu) / (2 * (1 - nu)) : 0,
                                       rc_boundary_on(&shape, boundary).datum};
        struct rc_friction_law what = {.boundary = boundary,
                                       .pair.estar = 1,
                                       .nu = nu,
                                       .mu = 0.1 + slip_noise(&seed),
                                       .tau_max = problem % 5 == 2 ? 0.2 : 0,
                                       .tol = 1e-13};
        struct rc_err err;
        struct rc_friction_solver *slip = rc_friction_solver_new(&shape, &what, &err);
        struct dense d = {.n = 0};
        double q[2 * DENSE_MOST] = {0}, delta[2] = {0, 0}, origin[2 * DENSE_MOST] = {0};

        if (alone) {
            rc_friction_solver_free(slip);
            what.pair = (struct rc_pair){.one = {.e = 1 - nu * nu, .nu = nu}};
            slip = rc_friction_solver_new(&shape, &what, &err);
        }
        assert_non_null(slip);
        matrix_of(&d, &shape, boundary, kap);
        for (int increment = 0; increment < 3; increment++) {
            double p[DENSE_MOST], limit = 0, load[2], angle = 6.3 * slip_noise(&seed), size = 0,
                                  far = 0, pushed[2 * DENSE_MOST];
            struct rc_friction_increment figures;
            enum rc_status status;
            for (size_t k = 0; k < n; k++) {
                p[k] = fmax(0, slip_noise(&seed) - 0.2);
                if (k == 0)
                    p[k] = 0.5;
                d.g[k] = fmin(what.mu * p[k], what.tau_max > 0 ? what.tau_max : INFINITY);
                limit += d.g[k];
            }
            push_by(&shape, boundary, &pair, p, pushed);
            for (size_t k = 0; k < 2 * n; k++)
                d.w[k] = origin[k] - pushed[k];
            for (int c = 0; c < 2; c++)
                load[c] =
                    (0.1 + 0.85 * slip_noise(&seed)) * limit * (c == 0 ? cos(angle) : sin(angle));
            assert_int_equal(rc_friction_solver_set_pressure(slip, p, NULL, &err), RC_OK);
            if (given) {
                for (int c = 0; c < 2; c++)
                    delta[c] = (slip_noise(&seed) - 0.5) * 2 * limit / sqrt((double)n);
                relax(&d, delta, q);
                assert_int_equal(
                    rc_friction_solver_set_displacement(slip, delta[0], delta[1], &err), RC_OK);
            } else {
                carry(&d, load, delta, q);
                assert_int_equal(rc_friction_solver_set_force(slip, load[0] * shape.dx * shape.dy,
                                                              load[1] * shape.dx * shape.dy, &err),
                                 RC_OK);
            }
            status = slip_solve(slip, &figures);
            if (status != RC_OK)
                print_message("problem %d, increment %d: %d after %zu, estimate %.1e\n", problem,
                              increment, status, figures.steps, figures.traction_error);
            for (size_t k = 0; k < 2 * n; k++) {
                far = fmax(far, fabs(rc_friction_solver_traction(slip, k >= n)[k % n] - q[k]));
                size = fmax(size, fabs(q[k]));
            }
            stuck += figures.stick_nodes;
            slid += figures.slip_nodes;
            worst = larger(worst, far / size);
            if (figures.stick_nodes >
                0) /* otherwise delta is nearly undetermined if all nodes slide in one direction */
                for (int c = 0; c < 2; c++)
                    moved = larger(moved, fabs(figures.displacement[c] - delta[c]) /
                                              hypot(delta[0], delta[1]));
            for (size_t k = 0; k < 2 * n; k++) {
                origin[k] = pushed[k] - delta[k >= n];
                for (size_t j = 0; j < 2 * n; j++)
                    origin[k] += d.t[k][j] * q[j];
            }
            rc_friction_solver_keep(slip);
        }
        rc_friction_solver_free(slip);
    }
    print_message("%s: tractions %.1e, displacements %.1e; %zu stick, %zu slip\n",
                  rc_boundary_word(boundary), worst, moved, stuck, slid);
    assert_true(worst < bound && moved < bound);
    assert_true(stuck > 100 && slid > 100);
}

static void
test_another_method_finds_the_same(void **state)
{
    (void)state;
    another_method_finds_the_same(RC_FREE);
    another_method_finds_the_same(rc_boundary_of(true, false));
    another_method_finds_the_same(rc_boundary_of(false, true));
}

/* Three displacements, small or large, move a periodic map, for partial and complete contact. If all nodes
 * stick nothing resists the mean motion, and with continuing motion they slide. */
static void
test_displacements_of_periodic_maps(void **state)
{
    static const struct rc_shape shapes[] = {{6, 4, 1, 1},   {4, 5, 1, 1.7}, {3, 3, 1, 1},
                                             {8, 3, 0.6, 1}, {4, 4, 1, 3},   {1, 7, 1, 1}};
    double worst = 0;
    size_t most = 0, slid = 0, stuck = 0, wrong = 0;

    (void)state;
    for (int problem = 0; problem < PERIODIC; problem++) {
        uint64_t seed = 4321 + (uint64_t)problem;
        const struct rc_shape shape = shapes[problem % 6];
        size_t n = shape.nx * shape.ny;
        double nu = problem % 3 == 0 ? 0 : 0.5 * slip_noise(&seed);
        struct rc_friction_law what = {
            .boundary = RC_PERIODIC, .pair.estar = 1, .nu = nu, .mu = 0.3, .tol = 1e-12};
        struct rc_friction_solver *slip = rc_friction_solver_new(&shape, &what, NULL);
        struct dense d;
        double q[2 * DENSE_MOST] = {0}, delta[2] = {0, 0}, origin[2 * DENSE_MOST] = {0},
                     p[DENSE_MOST];
        double missing = problem % 4 < 2 ? 0 : 0.4, far = pow(10, 2 - 4 * slip_noise(&seed));

        assert_non_null(slip);
        periodic_matrix(&d, &shape, nu / (1 - nu));
        for (size_t k = 0; k < n; k++) {
            p[k] = fmax(0, slip_noise(&seed) - missing) + (k == 0 ? 0.5 : 0);
            d.g[k] = what.mu * p[k];
        }
        for (int increment = 0; increment < 3; increment++) {
            struct rc_friction_increment figures;
            double off = 0, size = 0;
            enum rc_status status;
            memcpy(d.w, origin, sizeof origin);
            for (int c = 0; c < 2; c++)
                delta[c] += far * (slip_noise(&seed) - 0.5);
            relax(&d, delta, q);
            assert_int_equal(rc_friction_solver_set_pressure(slip, p, NULL, NULL), RC_OK);
            assert_int_equal(rc_friction_solver_set_displacement(slip, delta[0], delta[1], NULL),
                             RC_OK);
            status = slip_solve(slip, &figures);
            for (size_t k = 0; k < 2 * n; k++) {
                off = fmax(off, fabs(rc_friction_solver_traction(slip, k >= n)[k % n] - q[k]));
                size = fmax(size, fabs(q[k]));
            }
            if (status != RC_OK || off > bound * size)
                print_message("problem %d, increment %d: %d after %zu steps, off by %.1e, estimate "
                              "%.1e\n",
                              problem, increment, status, figures.steps, off / size,
                              figures.traction_error),
                    wrong++;
            most = figures.steps > most ? figures.steps : most;
            worst = larger(worst, off / size);
            stuck += figures.stick_nodes;
            slid += figures.slip_nodes;
            for (size_t k = 0; k < 2 * n; k++) {
                origin[k] = -delta[k >= n];
                for (size_t j = 0; j < 2 * n; j++)
                    origin[k] += d.t[k][j] * q[j];
            }
            rc_friction_solver_keep(slip);
        }
        rc_friction_solver_free(slip);
    }
    print_message("tractions %.1e, up to %zu steps; %zu stick, %zu slip\n", worst, most, stuck,
                  slid);
    assert_int_equal(wrong, 0);
    assert_true(stuck > 300 && slid > 300);
}

/* ---- the model of friction, and rc_solver and rc_friction_solver driven by hand ---- */

enum {
    SIDE = 20,
    NODES = SIDE * SIDE,
    EACH = 3 /* increments from point to point */
};

struct by_hand {
    struct rc_solver *solver;
    struct rc_friction_solver *slip;
    double h[NODES], less[NODES], gap[NODES];
};

static struct by_hand *
by_hand_new(const struct rc_shape *shape, const double *h, const struct rc_problem *contact,
            const struct rc_friction_law *slip)
{
    struct by_hand *b = malloc(sizeof *b);
    struct rc_friction_increment f;
    struct rc_contact apart;

    b->solver = rc_solver_new(shape, h, contact, NULL);
    b->slip = rc_friction_solver_new(shape, slip, NULL);
    assert_true(b->solver != NULL && b->slip != NULL);
    memcpy(b->h, h, sizeof b->h);
    rc_contact_apart(NULL, shape, h, b->gap, &apart);
    assert_int_equal(rc_friction_solver_set_pressure(b->slip, NULL, b->gap, NULL), RC_OK);
    assert_int_equal(rc_friction_solver_set_force(b->slip, 0, 0, NULL), RC_OK);
    assert_int_equal(slip_solve(b->slip, &f), RC_OK);
    rc_friction_solver_keep(b->slip);
    return b;
}

/* One increment, in so many passes of pressure and tractions. It returns the approach from first touch of
 * h. */
static double
by_hand_go(struct by_hand *b, const double to[3], bool moved, bool full,
           struct rc_friction_increment *f)
{
    struct rc_contact contact;
    double top = -INFINITY, less = -INFINITY;

    for (int pass = 0; pass < (full ? 30 : 1); pass++) {
        rc_friction_solver_normal(b->slip, b->less);
        top = less = -INFINITY;
        for (size_t k = 0; k < NODES; k++) {
            b->less[k] = b->h[k] - (full ? b->less[k] : 0);
            top = fmax(top, b->h[k]);
            less = fmax(less, b->less[k]);
        }
        assert_int_equal(rc_solver_set_heights(b->solver, b->less, NULL), RC_OK);
        assert_int_equal(rc_solver_set_load(b->solver, to[0], 0, NULL), RC_OK);
        while (rc_solver_step(b->solver) == RC_MORE)
            ;
        rc_solver_result(b->solver, NULL, b->gap, &contact);
        assert_int_equal(
            rc_friction_solver_set_pressure(b->slip, rc_solver_pressure(b->solver), b->gap, NULL),
            RC_OK);
        assert_int_equal(moved ? rc_friction_solver_set_displacement(b->slip, to[1], to[2], NULL)
                               : rc_friction_solver_set_force(b->slip, to[1], to[2], NULL),
                         RC_OK);
        assert_int_equal(slip_solve(b->slip, f), RC_OK);
    }
    rc_friction_solver_keep(b->slip);
    return contact.approach + top - less;
}

/* Largest relative distance of the results at points of a path, under loads, and forces or displacements. */
static double
apart_from_hand(const struct rc_problem *contact, const struct rc_friction_problem *law,
                const double (*at)[3], size_t points, bool moved)
{
    const struct rc_shape shape = {SIDE, SIDE, 1e-6, 1e-6};
    const bool full = law->coupling == RC_COUPLING_FULL && law->law.pair.estar == 0;
    double *h = slip_rough(&shape, 0.1, 4e-6, 3), q[2][NODES], before[3] = {0, 0, 0}, worst = 0;
    struct rc_model *m = slip_model(&shape, h, contact, law, NULL);
    struct by_hand *b = by_hand_new(&shape, h, contact, &law->law);

    assert_non_null(m);
    for (size_t k = 0; k < points; k++) {
        const struct rc_leg falls = {.increments = EACH, .falls = at[k][0] < before[0]};
        struct rc_friction_increment f;
        double approach = 0;
        for (size_t i = 1; i <= EACH; i++) {
            double v[3];
            for (int a = 0; a < 3; a++)
                v[a] = before[a] + (at[k][a] - before[a]) * rc_leg_part(&falls, i, EACH);
            approach = by_hand_go(b, v, moved, full, &f);
        }
        assert_int_equal(slip_go(m, at[k][0], at[k][1], at[k][2], moved, NULL), RC_OK);
        assert_true(rc_model_frame(m, "traction-x", q[0], NULL) == RC_OK &&
                    rc_model_frame(m, "traction-y", q[1], NULL) == RC_OK);
        worst = larger(worst,
                       slip_distance(NODES, (const double *[2]){q[0], q[1]},
                                     (const double *[2]){rc_friction_solver_traction(b->slip, 0),
                                                         rc_friction_solver_traction(b->slip, 1)}));
        worst = larger(worst, fabs(rc_friction_result(m)->approach / approach - 1));
        worst = larger(worst, fabs(rc_model_number(m, moved ? "tangential_x" : "displacement_x") /
                                       (moved ? f.force[0] : f.displacement[0]) -
                                   1));
        assert_int_equal(rc_model_keep(m, NULL), RC_OK);
        memcpy(before, at[k], sizeof before);
    }
    rc_solver_free(b->solver);
    rc_friction_solver_free(b->slip);
    free(b);
    rc_model_free(m);
    free(h);
    return worst;
}

static void
test_model(void **state)
{
    static const double forces[][3] = {{2e-3, 3e-4, 1e-4}, {3e-3, -2e-4, 4e-4}, {1e-3, 1e-4, 1e-4}};
    static const double moves[][3] = {{2e-3, 1e-8, 2e-9}, {3e-3, -1e-8, 5e-9}, {1e-3, 3e-8, 1e-9}};
    struct rc_problem contact = {.pair.estar = 1e9, .load = 1e-3, .tol = 1e-9, .threads = 1};
    struct rc_friction_problem law = {
        .law = {.pair.estar = 1e9, .nu = 0.3, .mu = 0.3, .tol = 1e-8, .threads = 1},
        .increments = EACH};

    (void)state;
    assert_true(apart_from_hand(&contact, &law, forces, 3, false) < 1e-6);
    assert_true(apart_from_hand(&contact, &law, moves, 3, true) < 1e-6);
    contact.pair = law.law.pair = (struct rc_pair){.one = {1e9, 0.3}, .two.e = INFINITY};
    law.law.nu = 0;
    assert_true(apart_from_hand(&contact, &law, moves, 3, true) < 1e-5);
    law.coupling = RC_COUPLING_GOODMAN;
    assert_true(apart_from_hand(&contact, &law, forces, 3, false) < 1e-6);
}

/* Requests that a model of friction refuses, with their messages. */
static void
test_model_refuses(void **state)
{
    const struct rc_shape shape = {8, 8, 1e-6, 1e-6};
    const struct rc_friction_problem law = {.law = {.pair.estar = 1e9, .nu = 0.3, .mu = 0.3}};
    const struct rc_problem contact = {.pair.estar = 1e9};
    double *h = slip_sphere(&shape, 1e-4);
    struct rc_err err = {""};
    struct rc_model *m =
        rc_friction_new(rc_elastic_new(&shape, h, &contact, NULL, &err), h, &law, &err);
    struct rc_point to = {0};

    (void)state;
    assert_non_null(m);
    rc_point_set(&to, RC_LOAD, 1e-4);
    assert_int_equal(rc_model_go(m, &to, &err), RC_FAIL);
    assert_string_equal(err.text, "a point of the friction model needs the tangential_x");
    rc_point_set(&to, RC_TANGENTIAL_X, 1e-5);
    rc_point_set(&to, RC_DISPLACEMENT_Y, 1e-9);
    assert_int_equal(rc_model_go(m, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "give two forces or two displacements"));
    rc_point_set(&to, RC_TANGENTIAL_Y, 1e-4); /* more than mu P */
    assert_int_equal(rc_model_run(m, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "friction carries less than"));
    rc_point_set(&to, RC_TANGENTIAL_Y, 0);
    assert_int_equal(rc_model_run(m, &to, &err), RC_OK); /* as without the failure */
    rc_model_free(m);
    assert_null(rc_friction_new(NULL, h, &law, &err));
    free(h);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_model),
        cmocka_unit_test(test_model_refuses),
        cmocka_unit_test(test_another_method_finds_the_same),
        cmocka_unit_test(test_displacements_of_periodic_maps),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
