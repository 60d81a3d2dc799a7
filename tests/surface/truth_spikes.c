/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rc_spikes finds known groups of 1 to 9 nodes on honed, turned and ground surfaces, and leaves grooves. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "maps.h"

enum {
    NX = 240,
    NY = 200,
    N = NX * NY,
    GROUPS = 120
};
static const struct rc_shape shape = {NX, NY, 1e-6, 1.1e-6};

/* ---- surfaces; heights in um, and the scale does not matter ---- */

static double
normal(void)
{
    const double u = (rand() + 1.0) / (RAND_MAX + 2.0), v = (rand() + 1.0) / (RAND_MAX + 2.0);

    return sqrt(-2 * log(u)) * cos(2 * exact_pi * v);
}

/* Noise of the instrument, and roughness of this RMS height and of some nodes. */
static void
roughen(double *h, double noise, double rough)
{
    double *fine = new_map(&shape), *v = new_map(&shape);

    for (size_t k = 0; k < N; k++)
        v[k] = normal();
    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++) {
            fine[j * NX + i] = 0;
            for (size_t b = 0; b < 4; b++)
                for (size_t a = 0; a < 4; a++)
                    fine[j * NX + i] += v[(j + b) % NY * NX + (i + a) % NX] / 4;
        }
    for (size_t k = 0; k < N; k++)
        h[k] += rough * fine[k] + noise * normal();
    free(fine);
    free(v);
}

/* A groove through (x, y) in this direction; where two cross, the deeper one stays. */
static void
cut(double *h, double x, double y, double angle, double half, double length, double depth)
{
    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++) {
            const double a = (double)i - x, b = (double)j - y;
            const double across = (a * sin(angle) - b * cos(angle)) / half;
            const double along = fabs(a * cos(angle) + b * sin(angle)) / length;
            if (fabs(across) < 1 && along < 1)
                h[j * NX + i] = fmin(h[j * NX + i], -depth * (1 - across * across) *
                                                        sqrt(1 - along * along * along * along));
        }
}

static double
from_to(double low, double high)
{
    return low + (high - low) * (chance() + 1) / 2;
}

static void
honed(double *h)
{
    memset(h, 0, N * sizeof *h);
    for (int k = 0; k < 80; k++)
        cut(h, from_to(0, NX), from_to(0, NY), (k % 2 == 0 ? 1 : -1) * from_to(0.4, 0.6),
            from_to(1, 4), 1e9, from_to(0.2, 2));
    roughen(h, 0.01, 0.03);
}

static void
turned(double *h)
{
    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++) {
            const double s = ((double)i + 0.03 * (double)j) / 17.3, t = s - floor(s) - 0.5;
            h[j * NX + i] = 8 * t * t + 0.1 * sin(2 * exact_pi * s * 3.7);
        }
    roughen(h, 0.02, 0.05);
}

static void
ground(double *h)
{
    memset(h, 0, N * sizeof *h);
    for (int k = 0; k < 1200; k++)
        cut(h, from_to(-50, NX + 50), from_to(0, NY), from_to(-0.02, 0.02), from_to(1, 4),
            from_to(30, 300), -0.3 * log(from_to(1e-6, 1)));
    roughen(h, 0.01, 0.02);
}

/* ---- spikes ---- */

/* Adds groups of 1 to 9 connected nodes of this height, upwards and downwards, apart from each other. `size`
 * has the number of nodes of the group of each node, 0: none. */
static void
add_spikes(double *h, double height, int *size)
{
    memset(size, 0, N * sizeof *size);
    for (int g = 0; g < GROUPS; g++) {
        const int nodes = g % 9 + 1, sign = g % 4 == 0 ? -1 : 1;
        int i, j, n = 0, x[9], y[9];
        bool alone = true;
        do {
            i = 5 + rand() % (NX - 10);
            j = 5 + rand() % (NY - 10);
            alone = true;
            for (int b = -5; b <= 5; b++)
                for (int a = -5; a <= 5; a++)
                    alone = alone && size[(j + b) * NX + i + a] == 0;
        } while (!alone);
        while (n < nodes) {
            x[n] = i;
            y[n] = j;
            size[j * NX + i] = nodes;
            h[j * NX + i] += sign * height * from_to(0.8, 1.2);
            n++;
            do {
                const int from = rand() % n;
                i = x[from] + rand() % 3 - 1;
                j = y[from] + rand() % 3 - 1;
            } while (n < nodes &&
                     (abs(i - x[0]) > 1 || abs(j - y[0]) > 1 || size[j * NX + i] != 0));
        }
    }
}

/* ---- what is found ---- */

struct share {
    double found, wrong; /* of the nodes of spikes; of the other nodes */
};

static struct share
remove_from(void (*surface)(double *), double height)
{
    double *h = new_map(&shape), sum = 0, square = 0, nodes = 0, all = 0;
    int *size = calloc(N, sizeof *size);
    struct share s = {0, 0};
    struct rc_err err;
    size_t count;

    assert_non_null(size);
    surface(h);
    for (size_t k = 0; k < N; k++) {
        sum += h[k];
        square += h[k] * h[k];
    }
    if (height > 0)
        add_spikes(h, height * sqrt(square / N - sum * sum / N / N), size);
    assert_int_equal(rc_spikes(&shape, 5, RC_FREE, 0, h, &count, &err), RC_OK);
    for (size_t k = 0; k < N; k++) {
        nodes += size[k] > 0;
        all += isnan(h[k]);
        s.found += isnan(h[k]) && size[k] > 0;
        s.wrong += isnan(h[k]) && size[k] == 0;
    }
    assert_true((double)count == all);
    s.found = nodes > 0 ? s.found / nodes : 1;
    s.wrong /= N - nodes;
    free(h);
    free(size);
    return s;
}

static void
test_shares(void **state)
{
    static const struct {
        const char *name;
        void (*make)(double *);
    } surfaces[] = {{"honed", honed}, {"turned", turned}, {"ground", ground}};
    static const struct {
        double height, found; /* in Sq; least share of the nodes of spikes */
    } spikes[] = {{0, 0}, {2, 0.25}, {4, 0.85}, {8, 0.999}, {16, 0.999}};
    const double wrong = 1e-3;

    (void)state;
    for (size_t k = 0; k < sizeof surfaces / sizeof *surfaces; k++)
        for (size_t q = 0; q < sizeof spikes / sizeof *spikes; q++) {
            struct share s;
            srand(71);
            s = remove_from(surfaces[k].make, spikes[q].height);
            printf("%-6s, spikes of %2g Sq: %5.1f %% of their nodes found, %.3f %% of the others "
                   "removed\n",
                   surfaces[k].name, spikes[q].height, 100 * s.found, 100 * s.wrong);
            if (!(s.wrong <= wrong) || s.found < spikes[q].found)
                fail_msg("beyond the bounds of %g %% found and %g %% wrong", 100 * spikes[q].found,
                         100 * wrong);
        }
}

/* ---- exact cases ---- */

/* The corners of a block and of a hollow stand out from the median of their neighbours; they stay. */
static void
test_corners(void **state)
{
    const struct rc_shape s = {60, 40, 1e-6, 1e-6};
    const size_t n = s.nx * s.ny;
    double *h = new_map(&s);
    struct rc_err err;
    size_t count;

    (void)state;
    srand(74);
    for (size_t k = 0; k < n; k++) {
        const size_t i = k % s.nx, j = k / s.nx;
        h[k] = 1e-9 * chance() + 1e-7 * (double)i +
               (i > 10 && i < 25 && j > 8 && j < 22 ? 1e-5 : 0) -
               (i > 35 && i < 50 && j > 18 && j < 31 ? 1e-5 : 0);
    }
    assert_int_equal(rc_spikes(&s, 8, RC_FREE, 1, h, &count, &err), RC_OK);
    assert_int_equal(count, 0);
    free(h);
}

/* Each size of a group up to nine is removed, also beside missing points and across the edges of a period;
 * ten nodes stay, and so does a groove of one node that is as deep as the spikes. */
static void
test_sizes(void **state)
{
    const struct rc_shape s = {40, 30, 1e-6, 1e-6};
    const size_t n = s.nx * s.ny;
    struct rc_err err;
    size_t count;

    (void)state;
    for (size_t nodes = 1; nodes <= 10; nodes++)
        for (int turn = 0; turn < 4; turn++) {
            double *h = new_map(&s);
            srand(72);
            for (size_t k = 0; k < n; k++)
                h[k] = 1e-3 + 1e-9 * chance() - (k % s.nx == 30 ? 1e-6 : 0);
            for (size_t q = 0; q < nodes; q++) {
                /* three columns of a block, through the corner of the map in the odd turns */
                const size_t i = (turn & 1 ? s.nx - 1 : 10) + q % 3,
                             j = (turn & 1 ? s.ny - 1 : 9) + q / 3;
                h[j % s.ny * s.nx + i % s.nx] += turn & 2 ? -1e-6 : 1e-6;
            }
            h[12 * s.nx + 11] = NAN;
            assert_int_equal(
                rc_spikes(&s, 8, rc_boundary_of(turn & 1, turn & 1), 2, h, &count, &err), RC_OK);
            if (count != (nodes > 9 ? 0 : nodes))
                fail_msg("%zu of a group of %zu nodes removed, turn %d", count, nodes, turn);
            free(h);
        }
}

/* On a profile groups of one and two nodes are spikes, and three are a step of the surface. */
static void
test_profile(void **state)
{
    const struct rc_shape s = {300, 1, 1e-6, 1e-6};
    double h[300];
    struct rc_err err;
    size_t count;

    (void)state;
    srand(73);
    for (size_t k = 0; k < 300; k++)
        h[k] =
            1e-9 * chance() + (k == 50 || k == 100 || k == 101 || (k > 200 && k < 206) ? 1e-7 : 0);
    assert_int_equal(rc_spikes(&s, 8, RC_FREE, 1, h, &count, &err), RC_OK);
    assert_int_equal(count, 3);
    assert_true(isnan(h[50]) && isnan(h[100]) && isnan(h[101]));
}

static void
test_refusals(void **state)
{
    const struct rc_shape s = {6, 5, 1e-6, 1e-6};
    double h[30] = {0};
    struct rc_err err;
    size_t count;

    (void)state;
    assert_int_equal(rc_spikes(&s, 0, RC_FREE, 1, h, &count, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "must be above 0"));
    h[3] = INFINITY;
    assert_int_equal(rc_spikes(&s, 5, RC_FREE, 1, h, &count, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "1 infinite heights"));
    for (size_t k = 0; k < 30; k++)
        h[k] = k == 7 ? 1 : NAN;
    assert_int_equal(rc_spikes(&s, 5, RC_FREE, 1, h, &count, &err), RC_OK);
    assert_int_equal(count, 0);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shares),   cmocka_unit_test(test_corners),
        cmocka_unit_test(test_sizes),    cmocka_unit_test(test_profile),
        cmocka_unit_test(test_refusals),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
