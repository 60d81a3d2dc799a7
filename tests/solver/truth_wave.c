/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flattened waves on a periodic map. Westergaard's area and pressure are tested from a tenth of the load of
 * full contact to the full one. The two-dimensional wave is that of Johnson, Greenwood and Higginson. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

static const double estar = 2.385e9;

static struct solved
wave(struct rc_shape shape, double amplitude, double lx, double ly, double mean, double tol)
{
    size_t n = shape.nx * shape.ny;
    double *h = malloc(n * sizeof *h);
    struct rc_problem problem = {.boundary = RC_PERIODIC,
                                 .pair.estar = estar,
                                 .tol = tol,
                                 .max_iterations = 5000,
                                 .threads = 2};
    struct solved s;

    problem.load = mean * shape.dx * shape.dy * (double)n;
    rc_synth_wave(&shape, amplitude, lx, ly, h);
    s = solve(shape, h, problem);
    free(h);
    assert_int_equal(s.status, RC_OK);
    return s;
}

static void
westergaard(void **state)
{
    static const double loads[] = {0.001, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99};
    struct rc_shape shape = {1024, 1, 1.1e-6, 0.7e-6};
    double length = 1.1e-6 * 1024, amplitude = 2.3e-6;
    double full = wave_full(amplitude, length, estar);

    (void)state;
    for (size_t k = 0; k < sizeof loads / sizeof *loads; k++) {
        double mean = loads[k] * full, above = 0, below = 0, nodes;
        struct solved s = wave(shape, amplitude, length, INFINITY, mean, 1e-7);
        for (size_t i = 0; i < 1024; i++) {
            double p = wave_pressure(mean, full, length, node_x(shape, i));
            above += fabs(s.p[i] - p);
            below += p;
        }
        print_message("%.3f of full: fraction %.5f (%.5f), L1(p) %.1e, %zu iterations\n", loads[k],
                      s.c.contact_fraction, wave_fraction(mean, full), above / below,
                      s.c.iterations);
        /* an error of a node at each edge, where the pressure falls like a square root: order 3/2 */
        nodes = 1024 * wave_fraction(mean, full);
        assert_true(fabs(s.c.contact_fraction - wave_fraction(mean, full)) <= 2.0 / 1024);
        assert_true(above / below < 1 / pow(nodes, 1.5));
        assert_true(fabs(s.c.max_pressure / (2 * sqrt(mean * full)) - 1) < 1 / pow(nodes, 1.5));
        solved_free(&s);
    }
}

/* Beyond full contact the pressure is mean + full cos, and all nodes are in contact. */
static void
full_contact(void **state)
{
    struct rc_shape shape = {64, 48, 1e-6, 1.3e-6};
    double lx = 64e-6, amplitude = 1e-7, full = wave_full(amplitude, lx, estar);
    const double tol = 1e-10;
    struct solved s = wave(shape, amplitude, lx, INFINITY, 1.7 * full, tol);

    (void)state;
    assert_int_equal(s.c.contact_nodes, 64 * 48);
    for (size_t k = 0; k < 64 * 48; k++) {
        double p = 1.7 * full + full * cos(2 * exact_pi * node_x(shape, k) / lx);
        assert_true(fabs(s.p[k] - p) < 10 * tol * full); /* the error of one node, not a mean */
    }
    assert_true(s.c.pressure_error < tol);
    /* p u / 2 with u = amplitude cos: full amplitude / 4 over the area; the mean pressure adds none */
    assert_true(fabs(s.c.elastic_energy / (full * amplitude / 4 * lx * 48 * 1.3e-6) - 1) <
                10 * tol);
    solved_free(&s);
}

/* The surface A cos cos has full contact at sqrt 2 pi E* A / L. Johnson, Greenwood and Higginson 1985. The
 * fractions at 0.2, 0.5 and 0.8 of it are from an independent computation at 512 x 512, corrected for the
 * perimeter, +-0.001. */
static void
two_dimensional_wave(void **state)
{
    static const double table[][2] = {{0.2, 0.3457}, {0.5, 0.7043}, {0.8, 0.8975}};
    enum {
        M = 192
    };
    struct rc_shape shape = {M, M, 1e-6, 1e-6};
    double amplitude = 1e-6, full = sqrt(2) * exact_pi * estar * amplitude / (M * 1e-6);
    const double known = 0.001;

    (void)state;
    for (size_t k = 0; k < 3; k++) {
        struct solved s = wave(shape, amplitude, M * 1e-6, M * 1e-6, table[k][0] * full, 1e-5);
        print_message("%.1f of full: fraction %.4f (%.4f), %zu iterations\n", table[k][0],
                      s.c.contact_fraction, table[k][1], s.c.iterations);
        /* the raw count is high by half a node along the edge, some 4 / M */
        assert_true(s.c.contact_fraction > table[k][1] - 2 * known);
        assert_true(s.c.contact_fraction < table[k][1] + 4.0 / M);
        solved_free(&s);
    }
    {
        struct solved s = wave(shape, amplitude, M * 1e-6, M * 1e-6, 1.001 * full, 1e-8);
        assert_int_equal(s.c.contact_nodes, M * M);
        solved_free(&s);
    }
}

/* A map of two periods has the solution of one period twice; shifted heights have the shifted pressure. */
static void
periods_and_shifts(void **state)
{
    struct rc_shape one = {48, 36, 1e-6, 1.2e-6}, two = {96, 36, 1e-6, 1.2e-6};
    double *h = malloc(48 * 36 * sizeof *h), *hh = malloc(96 * 36 * sizeof *hh);
    struct rc_selfaffine what = {.hurst = 0.7, .rms_height = 1e-7, .short_cut = 6e-6, .seed = 9};
    struct rc_problem problem = {.boundary = RC_PERIODIC,
                                 .pair.estar = estar,
                                 .hardness = 3e7,
                                 .tol = 1e-10,
                                 .max_iterations = 5000};
    struct solved a, b;
    struct rc_err err;
    double worst = 0;

    (void)state;
    assert_int_equal(rc_synth_selfaffine(&one, &what, h, &err), RC_OK);
    for (size_t k = 0; k < 96 * 36; k++)
        hh[k] = h[(k / 96 + 5) % 36 * 48 + (k % 96 + 11) % 48];
    problem.load = 2e7 * one.dx * one.dy * 48 * 36;
    a = solve(one, h, problem);
    problem.load *= 2;
    b = solve(two, hh, problem);
    assert_int_equal(a.status, RC_OK);
    assert_int_equal(b.status, RC_OK);
    for (size_t k = 0; k < 96 * 36; k++)
        worst = larger(worst, fabs(b.p[k] - a.p[(k / 96 + 5) % 36 * 48 + (k % 96 + 11) % 48]));
    print_message("%zu nodes at the hardness, worst difference %.1e\n", a.c.plastic_nodes,
                  worst / a.c.max_pressure);
    assert_true(a.c.plastic_nodes > 0);
    assert_true(worst <
                100 * problem.tol * a.c.max_pressure); /* the error of one node, not a mean */
    assert_true(fabs(a.c.approach / b.c.approach - 1) < 2 * problem.tol);
    solved_free(&a);
    solved_free(&b);
    free(h);
    free(hh);
}

int
main(void)
{
    int failed = 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(westergaard),
        cmocka_unit_test(full_contact),
        cmocka_unit_test(two_dimensional_wave),
        cmocka_unit_test(periods_and_shifts),
    };

    RUN_FOR_EACH_METHOD(tests, failed)
    return failed;
}
