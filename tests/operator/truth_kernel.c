/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The influence coefficients are the integrals of the point-load solutions over a cell. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>

#include "tests/exact.h"
#include "libcontact/operator/operator.h"
#include "tests/body_case.h"

/* The field at (x, y, z) of a unit force at the origin: Boussinesq (Johnson 1985, eqs. 3.19, 3.22). */
enum field {
    DISPLACEMENT = -1
}; /* otherwise: an enum rc_component */

struct where {
    int field;
    double x, y, z, nu; /* the point relative to the centre of the cell */
    double a, b;        /* half sides */
    double u;           /* the position of the outer integral */
};

static double
point_load(const struct where *w, double x, double y)
{
    double z = w->z, r2 = x * x + y * y, R = sqrt(r2 + z * z), R3 = R * R * R, R5 = R3 * R * R;
    double c = 1 - 2 * w->nu;

    switch (w->field) {
    case DISPLACEMENT:
        return 1 / (exact_pi * R); /* E* = 1 */
    case RC_SXX:
    case RC_SYY: {
        double s = w->field == RC_SXX ? x : y, t = w->field == RC_SXX ? y : x;
        return 1 / (2 * exact_pi) *
               (c / r2 * ((1 - z / R) * (s * s - t * t) / r2 + z * t * t / R3) -
                3 * z * s * s / R5);
    }
    case RC_SZZ:
        return -3 / (2 * exact_pi) * z * z * z / R5;
    case RC_SXY:
        return 1 / (2 * exact_pi) *
               (c / r2 * ((1 - z / R) * 2 * x * y / r2 - x * y * z / R3) - 3 * x * y * z / R5);
    case RC_SXZ:
        return -3 / (2 * exact_pi) * x * z * z / R5;
    default:
        return -3 / (2 * exact_pi) * y * z * z / R5;
    }
}

static gsl_integration_workspace *inner_space, *outer_space;

static double
along_y(double v, void *at)
{
    const struct where *w = at;

    return point_load(w, w->x - w->u, w->y - v);
}

static double
along_x(double u, void *at)
{
    struct where *w = at;
    gsl_function f = {.function = along_y, .params = w};
    double result, error;

    w->u = u;
    gsl_integration_qag(&f, -w->b, w->b, 1e-15, 1e-12, 400, GSL_INTEG_GAUSS41, inner_space, &result,
                        &error);
    return result;
}

static double
quadrature(struct where w)
{
    gsl_function f = {.function = along_x, .params = &w};
    double result, error;

    gsl_integration_qag(&f, -w.a, w.a, 1e-15, 1e-11, 400, GSL_INTEG_GAUSS41, outer_space, &result,
                        &error);
    return result;
}

/* The kernel of a field, of E* = 1 and this Poisson's ratio. */
static void
field_case(struct body_case *c, int field, double nu, double depth)
{
    if (field == DISPLACEMENT)
        surface_case(c, (struct rc_pair){.estar = 1});
    else
        stress_case(c, (struct rc_body){.nu = nu}, depth, RC_FREE, field);
}

static double
coefficient(int field, double nu, double depth, double dx, double dy, size_t i, size_t j)
{
    struct body_case c;
    struct rc_lattice at = {dx, dy, 1, 1};
    double *row = test_malloc((i + 1) * sizeof *row), value;

    field_case(&c, field, nu, depth);
    c.kernel.rows(c.kernel.of, &at, i + 1, j, j + 1, row);
    body_case_free(&c);
    value = row[i];
    test_free(row);
    return value;
}

static void
displacement_is_the_integral(void **state)
{
    static const size_t at[][2] = {{1, 0},  {0, 2},   {3, 2},   {4, 3},  {5, 1},   {12, 7},
                                   {39, 0}, {29, 29}, {40, 11}, {0, 41}, {300, 2}, {2000, 1500}};
    static const double sides[][2] = {{1, 1}, {1.1, 1}, {1, 3}, {7, 1}};

    (void)state;
    for (size_t s = 0; s < 4; s++)
        for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
            double dx = sides[s][0], dy = sides[s][1];
            struct where w = {.field = DISPLACEMENT,
                              .x = (double)at[k][0] * dx,
                              .y = (double)at[k][1] * dy,
                              .a = dx / 2,
                              .b = dy / 2};
            double truth = quadrature(w);
            double value = coefficient(DISPLACEMENT, 0.3, 0, dx, dy, at[k][0], at[k][1]);
            /* includes the error of the quadrature */
            if (!(fabs(value - truth) <= 2 * rounding * truth))
                print_error("sides %g %g at %zu %zu: %.17g, quadrature %.17g\n", dx, dy, at[k][0],
                            at[k][1], value, truth);
            assert_true(fabs(value - truth) <= 2 * rounding * truth);
        }
}

/* Love's value at the centre of a unit square: 4 ln(1 + sqrt 2) / pi E*. */
static void
displacement_of_a_cell_on_itself(void **state)
{
    double truth = 4 * log(1 + sqrt(2)) / exact_pi;

    (void)state;
    assert_true(fabs(coefficient(DISPLACEMENT, 0, 0, 1, 1, 0, 0) - truth) <= rounding * truth);
    for (double dy = 0.01; dy < 200; dy *= 10) {
        truth = love_displacement(0, 0, 0.5, dy / 2, 1);
        assert_true(fabs(coefficient(DISPLACEMENT, 0, 0, 1, dy, 0, 0) - truth) <= rounding * truth);
    }
}

static void
stresses_are_the_integrals(void **state)
{
    static const double depths[] = {0.05, 0.3, 1, 4.7, 30};
    static const double ratios[] = {0, 0.28, 0.5};
    static const size_t at[][2] = {{1, 0}, {0, 2}, {3, 2}, {12, 7}};

    (void)state;
    for (int c = 0; c < RC_COMPONENTS; c++)
        for (size_t d = 0; d < 5; d++)
            for (size_t n = 0; n < 3; n++)
                for (size_t k = 0; k < 4; k++) {
                    double dx = 1.1, dy = 0.9;
                    struct where w = {.field = c,
                                      .x = (double)at[k][0] * dx,
                                      .y = (double)at[k][1] * dy,
                                      .z = depths[d],
                                      .nu = ratios[n],
                                      .a = dx / 2,
                                      .b = dy / 2};
                    double truth = quadrature(w);
                    double value = coefficient(c, w.nu, w.z, dx, dy, at[k][0], at[k][1]);
                    if (!(fabs(value - truth) <= of_sum))
                        print_error("%s nu %g z %g at %zu %zu: %.17g, quadrature %.17g\n",
                                    rc_component_names[c], w.nu, w.z, at[k][0], at[k][1], value,
                                    truth);
                    assert_true(fabs(value - truth) <= of_sum); /* relative to the unit pressure */
                }
}

/* Stresses on the axis of a uniformly loaded square of half side 1, nu = 0.3 (Love 1929). */
static void
stresses_under_a_square(void **state)
{
    static const double table[][3] = {{0.1, -0.9992593, -0.6838138},
                                      {0.5, -0.9298650, -0.3025023},
                                      {1, -0.7008859, -0.0828904},
                                      {2, -0.3361076, 0.0014088},
                                      {5, -0.0716135, 0.0039679}};
    const double digits = 6e-8; /* seven decimals: half a unit of the last one, and its rounding */

    (void)state;
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        double szz = coefficient(RC_SZZ, 0.3, table[k][0], 2, 2, 0, 0);
        double sxx = coefficient(RC_SXX, 0.3, table[k][0], 2, 2, 0, 0);
        assert_true(fabs(szz - table[k][1]) < digits && fabs(sxx - table[k][2]) < digits);
    }
}

/* At z = 0 inside the cell szz = -p, outside it is 0. At the middle of a square sxx = syy = -(1 + 2 nu) p /
 * 2; the trace is -2 (1 + nu) times that of szz's arctangent. */
static void
stresses_at_the_surface(void **state)
{
    (void)state;
    for (double nu = 0; nu <= 0.5; nu += 0.1) {
        double sxx = coefficient(RC_SXX, nu, 0, 1.7, 1.7, 0, 0);
        assert_true(fabs(sxx + (1 + 2 * nu) / 2) < rounding);
        assert_true(fabs(coefficient(RC_SZZ, nu, 0, 1.7, 0.3, 0, 0) + 1) < rounding);
        assert_true(fabs(coefficient(RC_SZZ, nu, 0, 1.7, 0.3, 2, 1)) < rounding);
        assert_true(coefficient(RC_SXZ, nu, 0, 1.7, 0.3, 2, 1) == 0);
    }
}

/* A coarser lattice of the same cell has the same values at its nodes, also in blocks of rows. */
static void
a_coarser_lattice_is_a_sample(void **state)
{
    struct rc_lattice fine = {1.1, 0.9, 1, 1}, coarse = {1.1, 0.9, 2, 3};
    double all[13][13], some[4][5];
    const double last_bits = 1e-15; /* relative to a unit pressure, by another Gauss rule */

    (void)state;
    for (int field = DISPLACEMENT; field < RC_COMPONENTS; field++) {
        struct body_case c;
        field_case(&c, field, 0.3, 0.8);
        c.kernel.rows(c.kernel.of, &fine, 13, 0, 13, all[0]);
        c.kernel.rows(c.kernel.of, &coarse, 5, 0, 4, some[0]);
        body_case_free(&c);
        for (size_t j = 0; j < 4; j++)
            for (size_t i = 0; i < 5; i++)
                assert_true(fabs(some[j][i] - all[3 * j][2 * i]) <= last_bits);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(displacement_is_the_integral),
        cmocka_unit_test(displacement_of_a_cell_on_itself),
        cmocka_unit_test(stresses_are_the_integrals),
        cmocka_unit_test(stresses_under_a_square),
        cmocka_unit_test(stresses_at_the_surface),
        cmocka_unit_test(a_coarser_lattice_is_a_sample),
    };

    gsl_set_error_handler_off(); /* GSL reports that rounding prevents the requested 1e-15, as expected */
    inner_space = gsl_integration_workspace_alloc(400);
    outer_space = gsl_integration_workspace_alloc(400);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
