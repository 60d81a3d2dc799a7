/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flow through gaps with closed-form solutions: waves along and across, parallel channels, narrow
 * constrictions, distant discs, the checkerboard. The order of convergence of the grid is checked too. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "leak_case.h"

/* g0 (1 + A cos): along the flow each line is a channel, <(1 + A cos)^3> = 1 + 3 A^2/2. Across it the
 * resistances add up, <(1 + A cos)^-3> = (1 + A^2/2) (1 - A^2)^-5/2. Patir and Cheng's factors are these. A
 * face that slides along grooves drags the mean gap; across them <g^-2>/<g^-3>, <(1 + A cos)^-2> = (1 -
 * A^2)^-3/2. */
static void
waves(void **state)
{
    enum {
        N = 32,
        M = 20
    };
    const double amplitude = 0.9, g0 = 2.3e-6;
    const double along = 1 + 1.5 * amplitude * amplitude;
    const double across = pow(1 - amplitude * amplitude, 2.5) / (1 + 0.5 * amplitude * amplitude);
    const double drag = (1 - amplitude * amplitude) / (1 + 0.5 * amplitude * amplitude);
    static double g[N * M];

    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        struct rc_shape s = {turned ? M : N, turned ? N : M, 1e-6, 1.3e-6};
        struct rc_leak_figures f;
        double error;
        for (size_t k = 0; k < s.nx * s.ny; k++) {
            size_t i = turned ? k / s.nx : k % s.nx;
            g[k] = g0 * (1 + amplitude * cos(2 * exact_pi * (double)i / N));
        }
        f = leak_figures(s, NULL, g, turned ? 'x' : 'y', true);
        print_message("along: %.1e\n", f.flow_factor / along - 1);
        assert_true(fabs(f.flow_factor / along - 1) < rounding);
        assert_true(fabs(f.mean_gap / g0 - 1) < rounding);
        assert_true(fabs(f.gap_rms / (g0 * amplitude / sqrt(2)) - 1) < rounding);
        assert_true(fabs(f.shear_flow_factor) < summed);
        assert_true(fabs(f.shear_stress_factor - 1) < rounding);
        f = leak_figures(s, NULL, g, turned ? 'y' : 'x', true);
        error = f.flow_factor / across - 1;
        print_message("across: harmonic %.1e, linear %.1e\n", error,
                      f.conductance_linear / f.conductance * f.flow_factor / across - 1);
        assert_true(fabs(error) < 6e-5);
        assert_true(fabs(f.shear_stress_factor / drag - 1) < 6e-5);
        assert_true(fabs(f.shear_flow_factor * amplitude / sqrt(2) / (drag - 1) - 1) < 6e-5);
        /* the estimate is half of the difference between these two */
        assert_true(f.conductance_linear / f.conductance * f.flow_factor / across - 1 < 0.075);
        assert_true(f.error > 0.03 && f.error < 0.04);
        /* a wave of 32 nodes, whose lowest point is a node */
        assert_true(fabs(f.critical_gap / (g0 * (1 - amplitude)) - 1) < rounding);
    }
}

/* Low waves, cos(q x) cos(r y) with edges along lines of symmetry: to second order in e = rms/<g> the flow
 * factor is 1 + (3 - 9c) e^2 and the shear flow factor -3c e, c = q^2/(q^2 + r^2). The grid's errors are of
 * second order. */
static void
low_waves(void **state)
{
    enum {
        N = 96
    };
    const struct rc_shape s = {N, N, 1e-6, 1e-6};
    const double e = 0.01;
    static double g[N * N];

    (void)state;
    for (int q = 1; q <= 2; q++)
        for (int r = 1; r <= 2; r++)
            for (int way = 0; way < 2; way++) {
                double a = way == 0 ? q : r, b = way == 0 ? r : q, c = a * a / (a * a + b * b);
                struct rc_leak_figures f;
                for (size_t k = 0; k < (size_t)N * N; k++)
                    g[k] = 1e-6 * (1 + 2 * e * cos(2 * exact_pi * q * ((double)(k % N) + 0.5) / N) *
                                           cos(2 * exact_pi * r * ((double)(k / N) + 0.5) / N));
                f = leak_figures(s, NULL, g, way == 0 ? 'x' : 'y', true);
                print_message("c %.1f: flow %+.4f e^2, shear %+.4f e\n", c,
                              (f.flow_factor - 1) / (e * e), f.shear_flow_factor / e);
                assert_true(fabs(f.gap_rms / (1e-6 * e) - 1) < summed);
                assert_true(fabs((f.flow_factor - 1) / (e * e) - (3 - 9 * c)) < 0.02);
                assert_true(fabs(f.shear_flow_factor / e + 3 * c) < 0.01);
            }
    for (size_t k = 0; k < (size_t)N * N; k++) /* an even gap has no roughness */
        g[k] = 0.3e-6;
    assert_true(isnan(leak_figures(s, NULL, g, 'x', true).shear_flow_factor));
}

/* Parallel channels with different gaps between walls of contact; sides closed. The walls have a tiny gap,
 * and only the pressure shows that they touch. */
static void
channels(void **state)
{
    enum {
        NX = 11,
        NY = 13
    };
    static const double row[NY] = {1, 0, 2, 2, 0, 3, 3, 3, 0, 1.5, 0, 0.5, 0.5};
    const struct rc_shape s = {NX, NY, 2e-6, 0.7e-6};
    double g[NX * NY], p[NX * NY], sum = 0, widest = 3e-7;

    (void)state;
    for (size_t k = 0; k < NX * NY; k++) {
        g[k] = row[k / NX] > 0 ? 1e-7 * row[k / NX] : 1e-9;
        p[k] = row[k / NX] > 0 ? 0 : 1e6;
    }
    for (size_t j = 0; j < NY; j++)
        sum += pow(1e-7 * row[j], 3) * s.dy;
    for (int around = 0; around < 2; around++) {
        struct leak_flow flow = leak_flow(s, p, g, 'x', around != 0);
        assert_true(fabs(flow.f.conductance / (sum / (NX * s.dx)) - 1) < rounding);
        assert_true(fabs(flow.f.conductance_linear / flow.f.conductance - 1) < rounding);
        assert_true(fabs(flow.f.critical_gap / widest - 1) < rounding);
        assert_int_equal(flow.f.throat_nodes, 3);
        assert_int_equal(flow.f.dead_nodes, 0);
        assert_int_equal(flow.f.unknowns, 9 * NX);
        for (size_t k = 0; k < NX * NY; k++) {
            double x = ((double)(k % NX) + 0.5) / NX;
            assert_true(flow.channel[k] == (p[k] > 0 ? 0 : 2));
            if (p[k] > 0)
                assert_true(isnan(flow.pressure[k]) && isnan(flow.flux[k]));
            else
                assert_true(fabs(flow.pressure[k] - (1 - x)) < rounding &&
                            fabs(flow.flux[k] / (g[k] * g[k] * g[k] / (NX * s.dx)) - 1) < rounding);
        }
        leak_flow_free(&flow);
        /* no fluid flows across the walls: the flow is exactly 0 */
        flow = leak_flow(s, p, g, 'y', around != 0);
        assert_true(!flow.f.percolates && flow.f.conductance == 0 && flow.f.flow_factor == 0);
        assert_true(flow.f.conductance_linear == 0 && flow.f.upper == 0 && flow.f.lower == 0);
        assert_true(flow.f.critical_gap == 0 && isnan(flow.f.error));
        for (size_t k = 0; k < NX * NY; k++) {
            assert_true(p[k] > 0 ? isnan(flow.flux[k]) : flow.flux[k] == 0);
            assert_true(flow.channel[k] == (p[k] > 0 ? 0 : 1));
            if (p[k] == 0 && k < NX)
                assert_true(flow.pressure[k] == 1);
            else if (p[k] == 0 && k >= 11 * NX)
                assert_true(flow.pressure[k] == 0);
            else
                assert_true(isnan(flow.pressure[k]));
        }
        leak_flow_free(&flow);
    }
}

/* A channel with the gap (1 - (2y/w)^2)^(3/2), as at contact edges of elastic bodies; w is in cells, and its
 * middle is at any position between nodes. The integral of (1 - t^2)^(9/2) from -1 to 1 is 63 pi/256. */
static double
throat_error(double cells)
{
    enum {
        NY = 12,
        PLACES = 40
    };
    const struct rc_shape s = {3, NY, 1e-6, 1e-6};
    double worst = 0, truth = cells / 2 * 63 * exact_pi / 256 / 3;

    for (int m = 0; m < PLACES; m++) {
        double middle = 5.5 + (double)m / PLACES, g[3 * NY], off;
        for (size_t k = 0; k < 3 * NY; k++) {
            double t = 2 * ((double)(k / 3) - middle) / cells;
            g[k] = t * t < 1 ? pow(1 - t * t, 1.5) : 0;
        }
        off = fabs(leak_figures(s, NULL, g, 'x', false).conductance / truth - 1);
        worst = larger(worst, off);
    }
    print_message("throat of %g cells: %.1e\n", cells, worst);
    return worst;
}

static void
throats(void **state)
{
    (void)state;
    assert_true(throat_error(4) < 1.5e-3);
    assert_true(throat_error(3) < 2e-2);
    assert_true(throat_error(2) < 0.3);
    assert_true(throat_error(2) >
                0.1); /* therefore a constriction of fewer than 3 nodes gets a warning */
}

/* Impermeable discs in a square array, a tenth of the area, in a constant gap give (1 - f)/(1 + f). The array
 * changes this by 1e-4 (Rayleigh 1892). The gap jumps at their rims, so the order is the first. The number of
 * nodes in a disc depends on its position between them, so the mean over positions is compared. */
static void
discs(void **state)
{
    enum {
        PLACES = 5
    };
    double before = 0;

    (void)state;
    for (int radius = 8; radius <= 32; radius *= 2) {
        size_t n = (size_t)lround(radius * sqrt(exact_pi / 0.1));
        double fraction = exact_pi * radius * radius / (double)(n * n);
        struct rc_shape s = {n, n, 1e-6, 1e-6};
        double *g = malloc(n * n * sizeof *g), error = 0;
        for (size_t m = 0; m < PLACES * PLACES; m++) {
            double x = (double)(n / 2) + (double)(m % PLACES) / PLACES;
            double y = (double)(n / 2) + (double)(m / PLACES) / PLACES;
            for (size_t k = 0; k < n * n; k++)
                g[k] = hypot((double)(k % n) - x, (double)(k / n) - y) < radius ? 0 : 1e-6;
            error += leak_figures(s, NULL, g, 'x', true).conductance / 1e-18 * (1 + fraction) /
                         (1 - fraction) -
                     1;
        }
        error /= PLACES * PLACES;
        print_message("discs of %d nodes: %.1e\n", radius, error);
        assert_true(fabs(error) < 0.11 / radius);
        assert_true(before == 0 || (fabs(error) < 0.6 * before && fabs(error) > 0.4 * before));
        before = fabs(error);
        free(g);
    }
}

/* A checkerboard of squares with g^3 = 1 and c, with edges along lines of symmetry, gives sqrt(c) (Keller
 * 1964, Dykhne 1971). */
static void
checkerboard(void **state)
{
    enum {
        SQUARE = 64,
        N = 2 * SQUARE
    };
    static double g[N * N];
    const double c = 0.1;
    const struct rc_shape s = {N, N, 1e-6, 1e-6};

    (void)state;
    for (size_t k = 0; k < N * N; k++)
        g[k] =
            ((k % N + SQUARE / 2) / SQUARE + (k / N + SQUARE / 2) / SQUARE) % 2 == 0 ? 1 : cbrt(c);
    for (int way = 0; way < 4; way++) {
        struct rc_leak_figures f = leak_figures(s, NULL, g, way % 2 == 0 ? 'x' : 'y', way < 2);
        double harmonic = f.conductance / sqrt(c), linear = f.conductance_linear / sqrt(c);
        print_message("checkerboard: harmonic %.4f, linear %.4f\n", harmonic, linear);
        assert_true(harmonic > 0.9735 && harmonic < 1);
        assert_true(linear > 1 && linear < 1.0075);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves),   cmocka_unit_test(low_waves), cmocka_unit_test(channels),
        cmocka_unit_test(throats), cmocka_unit_test(discs),     cmocka_unit_test(checkerboard),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
