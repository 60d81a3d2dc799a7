/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Histories: growing contact, falling loads and turning forces converge with the number of increments, and
 * dissimilar bodies under a normal load have Spence's stick radius. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <gsl/gsl_sf_ellint.h>
#include <stdio.h>

#include "slip_case.h"

/* ---- increments, nu 0.3, bodies alike ---- */

enum {
    SIDE = 64,
    NODES = SIDE * SIDE
};

struct corner {
    double load, fx, fy; /* load over the final load, forces over mu times the final load */
};

/* Follows straight lines between corners, each in the given number of increments; the first touch is under
 * the load of the first corner. */
static void
follow(struct rc_solver *solver, const double *h, double load, size_t corners,
       const struct corner *at, size_t increments, double *const q[2], double *dissipated)
{
    const struct rc_shape shape = {SIDE, SIDE, 1, 1};
    struct rc_friction_law what = {
        .boundary = RC_PERIODIC, .pair.estar = 1, .nu = 0.3, .mu = 0.3, .tol = 1e-7};
    struct rc_friction_solver *slip = rc_friction_solver_new(&shape, &what, NULL);
    double *gap = malloc(NODES * sizeof *gap);
    struct rc_friction_increment f;
    struct rc_contact c;

    assert_non_null(slip);
    (void)h;
    *dissipated = 0;
    for (size_t corner = 0; corner < corners; corner++)
        for (size_t k = corner == 0 ? increments : 1; k <= increments; k++) {
            double part = (double)k / (double)increments;
            struct corner to = at[corner], from = corner > 0 ? at[corner - 1] : to;
            double p = load * (from.load + part * (to.load - from.load));
            assert_int_equal(rc_solver_set_load(solver, p, 0, NULL), RC_OK);
            while (rc_solver_step(solver) == RC_MORE)
                ;
            rc_solver_result(solver, NULL, gap, &c);
            assert_int_equal(
                rc_friction_solver_set_pressure(slip, rc_solver_pressure(solver), gap, NULL),
                RC_OK);
            assert_int_equal(rc_friction_solver_set_force(
                                 slip, 0.3 * load * (from.fx + part * (to.fx - from.fx)),
                                 0.3 * load * (from.fy + part * (to.fy - from.fy)), NULL),
                             RC_OK);
            assert_int_equal(slip_solve(slip, &f), RC_OK);
            *dissipated += f.dissipated;
            rc_friction_solver_keep(slip);
        }
    for (int c2 = 0; c2 < 2; c2++)
        memcpy(q[c2], rc_friction_solver_traction(slip, c2), NODES * sizeof(double));
    free(gap);
    rc_friction_solver_free(slip);
}

static void
test_increments_converge(void **state)
{
    static const struct {
        const char *name;
        size_t corners;
        struct corner at[4];
        double most[3]; /* error of q with 1, 2, 4 increments per line; it is that of an independent
                  * program, plus a fifth */
    } paths[] = {
        {"P constant, F to 0.7", 2, {{1, 0, 0}, {1, 0.7, 0}}, {6e-3, 6e-3, 4e-3}},
        {"and back to 0", 3, {{1, 0, 0}, {1, 0.7, 0}, {1, 0, 0}}, {1.3e-2, 1.3e-2, 9e-3}},
        {"0.6 along x, then along y",
         3,
         {{1, 0, 0}, {1, 0.6, 0}, {1, 0.6, 0.6}},
         {6e-2, 4.5e-2, 2.6e-2}},
        {"P to half, F held", 3, {{1, 0, 0}, {1, 0.4, 0}, {0.5, 0.4, 0}}, {8e-3, 8e-3, 6e-3}},
        {"P and F grow", 3, {{0.3, 0, 0}, {0.3, 0.2, 0}, {1, 0.6, 0}}, {6.5e-2, 4e-2, 2e-2}},
    };
    const struct rc_shape shape = {SIDE, SIDE, 1, 1};
    double *h = slip_rough(&shape, 0.1, 4, 7), load = 0.016 * NODES;
    struct rc_problem problem = {
        .boundary = RC_PERIODIC, .pair.estar = 1, .load = load, .tol = 1e-7, .engine = "fft64"};
    struct rc_solver *solver = rc_solver_new(&shape, h, &problem, NULL);
    double *q[2][2], work[2];

    (void)state;
    assert_non_null(solver);
    for (int k = 0; k < 4; k++)
        q[k / 2][k % 2] = malloc(NODES * sizeof(double));
    for (size_t path = 0; path < sizeof paths / sizeof *paths; path++) {
        double error[3];
        follow(solver, h, load, paths[path].corners, paths[path].at, 16, q[0], &work[0]);
        for (int k = 0; k < 3; k++) {
            follow(solver, h, load, paths[path].corners, paths[path].at, 1u << k, q[1], &work[1]);
            error[k] =
                slip_distance(NODES, (const double *const *)q[1], (const double *const *)q[0]);
        }
        print_message("%-26s %.1e %.1e %.1e with 1, 2, 4 increments a leg\n", paths[path].name,
                      error[0], error[1], error[2]);
        for (int k = 0; k < 3; k++)
            assert_true(error[k] < paths[path].most[k]);
        assert_true(error[2] < error[0]);
    }
    for (int k = 0; k < 4; k++)
        free(q[k / 2][k % 2]);
    rc_solver_free(solver);
    free(h);
}

/* ---- dissimilar bodies ---- */

/* A ball on a flat, one of them rigid. It is pressed in equal increments of the contact radius. Goodman:
 * tractions do not change the pressure. Returns c/a, the stick radius from the areas. */
static double
press_ball(double mu, size_t increments, bool goodman, size_t *passes, double *lighter)
{
    const struct rc_shape shape = {SIDE, SIDE, 1, 1};
    const struct rc_pair pair = {.one = {.e = 0.91, .nu = 0.3}}; /* E* = 1, beta 2/7 */
    double radius = 500, a = 21, gone = 0, *h = slip_sphere(&shape, radius);
    double *less = malloc(NODES * sizeof *less), *last = malloc(NODES * sizeof *last);
    struct rc_problem contact = {.pair = pair, .load = 1, .tol = 1e-6};
    struct rc_friction_law what = {.pair = pair, .mu = mu, .tol = 1e-6};
    struct rc_solver *solver = rc_solver_new(&shape, h, &contact, NULL);
    struct rc_friction_solver *slip = rc_friction_solver_new(&shape, &what, NULL);
    struct rc_friction_increment f;
    struct rc_shear shear;

    assert_non_null(solver);
    assert_non_null(slip);
    assert_int_equal(rc_pair_shear(&pair, 0, &shear, NULL), RC_OK);
    assert_true(fabs(shear.beta - 2 / 7.0) < rounding);
    *passes = 0;
    for (size_t k = 1; k <= increments; k++) {
        double to = a * (double)k / (double)increments, load = 4 * to * to * to / (3 * radius);
        double change = 1;
        memcpy(less, h, NODES * sizeof *less);
        for (size_t pass = 0; pass < 30 && change > 1e-4; pass++) {
            const double *p;
            double sum = 0;
            if (!goodman && pass + k > 1) {
                rc_friction_solver_normal(slip, less);
                for (size_t n = 0; n < NODES; n++)
                    less[n] = h[n] - less[n];
            }
            assert_int_equal(rc_solver_set_heights(solver, less, NULL), RC_OK);
            assert_int_equal(rc_solver_set_load(solver, load, 0, NULL), RC_OK);
            while (rc_solver_step(solver) == RC_MORE)
                ;
            p = rc_solver_pressure(solver);
            change = 0;
            for (size_t n = 0; n < NODES; n++) {
                change += pass == 0 ? p[n] : fabs(p[n] - last[n]);
                sum += p[n];
            }
            change = goodman ? 0 : change / sum;
            memcpy(last, p, NODES * sizeof *p);
            assert_int_equal(rc_friction_solver_set_pressure(slip, p, NULL, NULL), RC_OK);
            assert_int_equal(rc_friction_solver_set_force(slip, 0, 0, NULL), RC_OK);
            assert_int_equal(slip_solve(slip, &f), RC_OK);
            ++*passes;
        }
        assert_true(change <= 1e-4);
        assert_true(fabs(f.force[0]) + fabs(f.force[1]) < 1e-9 * load);
        rc_friction_solver_keep(slip);
    }
    gone = (double)(f.stick_nodes + f.slip_nodes);
    *lighter = gone / (exact_pi * a * a);
    rc_solver_free(solver);
    rc_friction_solver_free(slip);
    free(h);
    free(less);
    free(last);
    return sqrt((double)f.stick_nodes / gone);
}

/* Spence's stick radius (J. Elast. 5, 1975) with Goodman's simplification: (a/2c) ln((a + c)/(a - c)) =
 * (mu/beta) K(k'), k' = sqrt(1 - c^2/a^2). */
static double
spence(double mu, double beta)
{
    double low = 1e-9, high = 1 - 1e-12;

    for (int k = 0; k < 100; k++) {
        double c = (low + high) / 2, left = log((1 + c) / (1 - c)) / (2 * c);
        double right = mu / beta * gsl_sf_ellint_Kcomp(sqrt(1 - c * c), GSL_PREC_DOUBLE);
        if (left < right)
            low = c;
        else
            high = c;
    }
    return (low + high) / 2;
}

static void
test_a_load_alone_sticks_inside(void **state)
{
    static const double mus[] = {0.15, 0.3};

    (void)state;
    for (int k = 0; k < 2; k++) {
        size_t passes, whole;
        double area, shrunk, exact = spence(mus[k], 2 / 7.0);
        double coarse = press_ball(mus[k], 16, true, &passes, &area);
        double fine = press_ball(mus[k], 32, true, &passes, &area), full;
        full = press_ball(mus[k], 8, false, &whole, &shrunk);
        print_message(
            "mu %.2f: c/a %.3f, %.3f, so %.3f, Spence %.3f; coupled %.3f in %zu passes, area %.3f "
            "of %.3f\n",
            mus[k], coarse, fine, 2 * fine - coarse, exact, full, whole, shrunk, area);
        assert_true(fabs(2 * fine - coarse - exact) < 0.01);
        /* full coupling: the numbers are from an independent program */
        assert_true(fabs(full - (k == 0 ? 0.46 : 0.83)) < 0.03);
        assert_true(shrunk / area > 0.96 && shrunk / area < 0.995);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_increments_converge),
        cmocka_unit_test(test_a_load_alone_sticks_inside),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
