/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sphere on a half-space agrees with Hertz's contact: radius, pressure, approach, displacement, and the
 * stresses below; the errors decrease with finer grids. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

static const double radius = 2.385e-3, estar = 113.93e9, load = 37.3, nu = 0.3;

static struct rc_shape
grid(size_t m)
{
    double side = 2.4 / 0.8 * hertz(load, radius, estar).a;

    return (struct rc_shape){.nx = m, .ny = m, .dx = side / (double)m, .dy = side / (double)m};
}

static struct solved
sphere(size_t m)
{
    struct rc_shape shape = grid(m);
    struct rc_problem problem = {.pair.estar = estar, .load = load, .tol = 1e-7, .threads = 2};
    double *h = malloc(m * m * sizeof *h);
    struct solved s;

    rc_synth_sphere(&shape, radius, h);
    s = solve(shape, h, problem);
    free(h);
    assert_int_equal(s.status, RC_OK);
    return s;
}

struct errors {
    double radius, peak, approach, pressure, displacement, energy;
};

static struct errors
errors_at(size_t m)
{
    struct hertz exact = hertz(load, radius, estar);
    struct rc_shape shape = grid(m);
    struct solved s = sphere(m);
    struct errors e = {0};
    double above = 0, below = 0;

    e.radius = fabs(sqrt(s.c.contact_area / exact_pi) / exact.a - 1);
    e.peak = fabs(s.c.max_pressure / exact.p0 - 1);
    e.energy = fabs(s.c.elastic_energy / (0.4 * load * exact.approach) - 1);
    e.approach = fabs((s.c.approach + below_apex(shape, radius)) / exact.approach - 1);
    for (size_t k = 0; k < m * m; k++) {
        double r = node_r(shape, k), p = hertz_pressure(exact, r);
        above += fabs(s.p[k] - p);
        below += p;
        e.displacement =
            larger(e.displacement, fabs(s.u[k] / hertz_displacement(exact, estar, r) - 1));
    }
    e.pressure = above / below;
    solved_free(&s);
    print_message("%4zu: radius %.2e, peak %.2e, approach %.2e, L1(p) %.2e, displacement %.2e\n", m,
                  e.radius, e.peak, e.approach, e.pressure, e.displacement);
    return e;
}

static void
radius_pressure_and_approach(void **state)
{
    struct errors e[3];

    (void)state;
    for (int k = 0; k < 3; k++) {
        double m = (double)(64 << k), nodes = m / 3;
        e[k] = errors_at((size_t)m);
        /* the radius changes by whole nodes: its error is below 1/M, the bound of the paper, and erratic
         * below that */
        assert_true(e[k].radius < 1 / m);
        assert_true(e[k].peak < grid_peak / (nodes * nodes));
        assert_true(e[k].approach < grid_approach / (nodes * nodes));
        assert_true(e[k].energy < grid_approach / (nodes * nodes)); /* 2/5 of load times approach */
    }
    assert_true(e[2].radius < e[1].radius);
    /* second order in peak and approach */
    for (int k = 1; k < 3; k++) {
        assert_true(e[k].peak < e[k - 1].peak / 2);
        assert_true(e[k].approach < e[k - 1].approach / 2);
        assert_true(e[k].pressure < e[k - 1].pressure / 2);
        assert_true(e[k].displacement < e[k - 1].displacement);
    }
    /* published numerical errors with a quarter of the nodes */
    assert_true(e[2].peak < 5e-5 && e[2].approach < 2e-5);
}

/* The largest Mises stress is 0.620041 p0 at a depth of 0.480864 a for nu = 0.3 (the maximum of Johnson's eq.
 * 3.45 on the axis). */
static void
stress_under_the_contact(void **state)
{
    enum {
        M = 256,
        DEPTHS = 41
    };
    struct hertz exact = hertz(load, radius, estar);
    struct rc_shape shape = grid(M);
    struct solved solved = sphere(M);
    struct rc_err err;
    struct rc_stress_options options = {
        .body.nu = nu, .wanted = (2u << RC_MISES) - 1, .threads = 2};
    struct rc_stress *stress = rc_stress_new(&shape, solved.p, &options, &err);
    double *s[RC_STRESSES] = {NULL}, *mises, largest = 0, place = 0;
    double step = exact.a / (DEPTHS - 1);

    (void)state;
    assert_non_null(stress);
    for (int c = 0; c <= RC_MISES; c++)
        s[c] = malloc(M * M * sizeof *s[c]);
    mises = s[RC_MISES];
    for (int d = 0; d < DEPTHS; d++) {
        double z = d * step;
        assert_int_equal(rc_stress_slice(stress, z, s, &err), RC_OK);
        for (size_t k = 0; k < M * M; k++)
            if (mises[k] > largest) {
                largest = mises[k];
                place = z;
            }
        /* Near the axis, at a distance of half a diagonal of a cell: r^2 / a^2 is 7e-5. The error of the
         * stepped pressure decays over the first depths. */
        if (d > 2) {
            const double off = 1e-3 * exact.p0;
            size_t middle = (M / 2) * M + M / 2;
            assert_true(fabs(s[RC_SZZ][middle] - hertz_axis_szz(exact, z)) < off);
            assert_true(fabs(s[RC_SXX][middle] - hertz_axis_sxx(exact, nu, z)) < off);
            assert_true(fabs(s[RC_SYY][middle] - hertz_axis_sxx(exact, nu, z)) < off);
        }
    }
    print_message("largest Mises stress %.6f p0 at %.4f a\n", largest / exact.p0, place / exact.a);
    assert_true(fabs(largest / (0.620041 * exact.p0) - 1) < coarse_grid);
    assert_true(fabs(place - 0.480864 * exact.a) <= step);
    for (int c = 0; c <= RC_MISES; c++)
        free(s[c]);
    rc_stress_free(stress);
    solved_free(&solved);
}

/* Results scale with the units: metres, micrometres, and a datum added to the heights. */
static void
units_and_datum(void **state)
{
    static const double unit[] = {1, 1e6, 1e-9};
    enum {
        M = 48
    };
    struct hertz exact = hertz(load, radius, estar);
    double side = 2.9 * exact.a, approach = 0, peak = 0;

    (void)state;
    for (int k = 0; k < 3; k++) {
        double L = unit[k];
        struct rc_shape shape = {M, M, side * L / M, side * L / M};
        struct rc_problem problem = {
            .pair.estar = estar / (L * L), .load = load, .tol = 1e-9, .threads = 1};
        double h[M * M];
        struct solved s;

        rc_synth_sphere(&shape, radius * L, h);
        for (size_t i = 0; i < M * M; i++)
            h[i] += 1e3 * exact.approach * L;
        s = solve(shape, h, problem);
        assert_int_equal(s.status, RC_OK);
        if (k == 0) {
            approach = s.c.approach;
            peak = s.c.max_pressure;
        }
        assert_true(fabs(s.c.approach / (approach * L) - 1) < 2 * problem.tol);
        assert_true(fabs(s.c.max_pressure * L * L / peak - 1) < 2 * problem.tol);
        assert_true(fabs((s.c.approach + below_apex(shape, radius * L)) / (exact.approach * L) -
                         1) < grid_approach / pow(M / 2.9, 2));
        assert_true(fabs(s.c.load / load - 1) < rounding);
        solved_free(&s);
    }
}

int
main(void)
{
    int failed = 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radius_pressure_and_approach),
        cmocka_unit_test(stress_under_the_contact),
        cmocka_unit_test(units_and_datum),
    };

    RUN_FOR_EACH_METHOD(tests, failed)
    return failed;
}
