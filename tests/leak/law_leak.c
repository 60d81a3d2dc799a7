/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of the flow: rotation, mirroring, shifts and other units do not change it. Wider gaps have more flow,
 * and the flow equals a dense solution of the same network. Flowing and stagnant fluid are those found by
 * removing nodes. The critical gap is that found by closing narrower nodes. The proven bounds agree at any
 * contrast. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "leak_case.h"
#include "libcontact/leak/leak.h"

enum {
    MOST = 24
};

/* Gaps over this number of decades; some nodes, but no corners, are in contact. */
static void
random_gap(struct rc_shape s, double decades, double contact, uint64_t *seed, double *g)
{
    for (size_t k = 0; k < s.nx * s.ny; k++)
        g[k] = leak_random(seed) < contact ? 0 : 1e-6 * pow(10, -decades * leak_random(seed));
}

/* ---- a dense solve ---- */

/* An independent network. The conductance between neighbours with gaps a and b comes from the mean of 1/g^3
 * of the rule. */
static double
joined(double a, double b, bool linear)
{
    if (a == 0 || b == 0)
        return 0;
    return linear ? 2 * a * a * b * b / (a + b) : 2 / (pow(a, -3) + pow(b, -3));
}

/* Flow per width and U/2 between neighbours with equal pressure, half of the path with gap a, half with b. */
static double
dragged(double a, double b)
{
    return a == 0 || b == 0 ? 0 : (pow(a, -2) + pow(b, -2)) / (pow(a, -3) + pow(b, -3));
}

/* Gaussian elimination without reordering, on all nodes connected to the inlet or the outlet. The fluid flows
 * from x edge to x edge: driven by a pressure of 1, or, with equal pressures at the edges, dragged with U/2 =
 * 1 by a face that slides along x. */
static double
dense_flow(struct rc_shape s, const double *g, bool around, bool linear, bool slides)
{
    static double m[MOST * MOST][MOST * MOST + 1], diagonal[MOST * MOST];
    static bool wet[MOST * MOST];
    size_t n = s.nx * s.ny;
    double flow = 0, aspect = s.dy / s.dx;
    bool more = true;

    for (size_t k = 0; k < n; k++)
        wet[k] = g[k] > 0 && (k % s.nx == 0 || k % s.nx == s.nx - 1);
    while (more) { /* the pressure of enclosed fluid is undetermined */
        more = false;
        for (size_t k = 0; k < n; k++) {
            size_t on = k % s.nx < s.nx - 1 ? k + 1 : k;
            size_t down = k / s.nx < s.ny - 1 ? k + s.nx : around ? k % s.nx : k;
            size_t to[2] = {on, down};
            for (int d = 0; d < 2; d++)
                if (g[k] > 0 && g[to[d]] > 0 && wet[k] != wet[to[d]])
                    wet[k] = wet[to[d]] = more = true;
        }
    }
    memset(m, 0, sizeof m);
    for (size_t k = 0; k < n; k++) {
        size_t on = k % s.nx < s.nx - 1 ? k + 1 : k;
        size_t down = k / s.nx < s.ny - 1 ? k + s.nx : around ? k % s.nx : k;
        size_t to[2] = {on, down};
        double end = 2 * g[k] * g[k] * g[k] * aspect;
        if (slides && wet[k]) {
            double flow_on = on == k ? 0 : s.dy * dragged(g[k], g[on]);
            m[k][n] -= on == k ? s.dy * g[k] : flow_on;
            m[k][n] += k % s.nx == 0 ? s.dy * g[k] : 0;
            m[on][n] += flow_on;
        }
        for (int d = 0; d < 2; d++) {
            double c = joined(g[k], g[to[d]], linear) * (d == 0 ? aspect : 1 / aspect);
            if (to[d] == k || !wet[k] || !wet[to[d]])
                continue;
            m[k][k] += c;
            m[to[d]][to[d]] += c;
            m[k][to[d]] -= c;
            m[to[d]][k] -= c;
        }
        if (!wet[k])
            m[k][k] = 1;
        else {
            m[k][k] += (k % s.nx == 0 ? end : 0) + (k % s.nx == s.nx - 1 ? end : 0);
            m[k][n] += k % s.nx == 0 && !slides ? end : 0;
        }
    }
    for (size_t k = 0; k < n;
         k++) /* diagonal 1: contrasts that are not in series cause no loss of digits */
        diagonal[k] = sqrt(m[k][k]);
    for (size_t k = 0; k < n; k++)
        for (size_t l = 0; l <= n; l++)
            m[k][l] /= diagonal[k] * (l < n ? diagonal[l] : 1);
    for (size_t k = 0; k < n; k++)
        for (size_t l = k + 1; l < n; l++) {
            double part = m[l][k] / m[k][k];
            for (size_t q = k; q <= n && part != 0; q++)
                m[l][q] -= part * m[k][q];
        }
    for (size_t k = n; k-- > 0;) {
        for (size_t l = k + 1; l < n; l++)
            m[k][n] -= m[k][l] * m[l][n];
        m[k][n] /= m[k][k];
    }
    for (size_t k = s.nx - 1; k < n; k += s.nx) /* the outlet at the other edge */
        if (wet[k])
            flow += 2 * g[k] * g[k] * g[k] * aspect * m[k][n] / diagonal[k] +
                    (slides ? s.dy * g[k] : 0);
    return flow;
}

static void
agrees_with_dense(void **state)
{
    static const struct rc_shape shapes[] = {
        {24, 24, 1e-6, 1e-6}, {17, 9, 1e-6, 0.6e-6}, {1, 5, 1e-6, 1e-6}, {6, 1, 1e-6, 2e-6},
        {7, 2, 1.1e-6, 1e-6}, {1, 1, 1e-6, 3e-6},    {9, 23, 1e-6, 1e-6}};
    size_t open = 0;
    double worst = 0;

    (void)state;
    for (size_t k = 0; k < 4 * sizeof shapes / sizeof *shapes; k++) {
        struct rc_shape s = shapes[k / 4];
        bool around = k % 2 == 1;
        double g[MOST * MOST], unit[MOST * MOST], dense, linear, drag, off;
        uint64_t seed = 11 + k;
        struct rc_leak_figures f;

        random_gap(s, 1, s.nx * s.ny < 20 ? 0 : 0.25, &seed, g);
        for (size_t i = 0; i < s.nx * s.ny; i++)
            unit[i] = g[i] / 1e-6;
        dense = 1e-18 * dense_flow(s, unit, around, false, false);
        linear = 1e-18 * dense_flow(s, unit, around, true, false);
        drag = 1e-6 * dense_flow(s, unit, around, false, true) / ((double)s.ny * s.dy);
        f = leak_figures(s, NULL, g, 'x', around);
        assert_true(f.percolates == (f.conductance > 0));
        if (!f.percolates) {
            assert_true(fabs(dense) < 1e-30 && f.shear_stress_factor == 0);
            assert_true(fabs(drag) < 1e-12 * f.mean_gap);
            continue;
        }
        open++;
        off = larger(fabs(f.conductance / dense - 1), fabs(f.conductance_linear / linear - 1));
        off = larger(off, fabs(f.shear_stress_factor - drag / f.mean_gap));
        assert_true(isnan(f.shear_flow_factor) == (s.nx * s.ny == 1)); /* an even gap */
        if (s.nx * s.ny > 1)
            off =
                larger(off, fabs(f.mean_gap + f.gap_rms * f.shear_flow_factor - drag) / f.mean_gap);
        worst = larger(worst, off);
        assert_true(off < 1e-10);
    }
    print_message("%zu flows beside dense ones: %.1e\n", open, worst);
    assert_true(open > 20);
}

/* ---- stagnant fluid, by removing nodes ---- */

/* True if the inlet (node n, at column 0) or the outlet (node n + 1) can be reached from node k without
 * passing `gone`. */
static bool
reaches_an_end(struct rc_shape s, const double *g, bool around, size_t k, size_t gone)
{
    size_t list[64], n = s.nx * s.ny, count = 1;
    bool seen[64] = {false};

    list[0] = k;
    seen[k] = true;
    for (size_t m = 0; m < count; m++) {
        size_t i = list[m] % s.nx, j = list[m] / s.nx, to[4], last = s.nx - 1;
        if ((i == 0 && gone != n) || (i == last && gone != n + 1))
            return true;
        to[0] = i < last ? list[m] + 1 : list[m];
        to[1] = i > 0 ? list[m] - 1 : list[m];
        to[2] = j < s.ny - 1 ? list[m] + s.nx : around ? i : list[m];
        to[3] = j > 0 ? list[m] - s.nx : around ? n - s.nx + i : list[m];
        for (int d = 0; d < 4; d++)
            if (g[to[d]] > 0 && !seen[to[d]] && to[d] != gone) {
                seen[to[d]] = true;
                list[count++] = to[d];
            }
    }
    return false;
}

/* Menger's theorem: two paths from k, to inlet and outlet, that share only k exist if no single node
 * separates k from both. */
static bool
flows_by_force(struct rc_shape s, const double *g, bool around, size_t k)
{
    for (size_t gone = 0; gone < s.nx * s.ny + 2; gone++)
        if (gone != k && !reaches_an_end(s, g, around, k, gone))
            return false;
    return true;
}

static void
tells_what_stands(void **state)
{
    static const struct rc_shape shapes[] = {{8, 8, 1, 1}, {7, 5, 1, 1}, {5, 2, 1, 1},
                                             {1, 9, 1, 1}, {9, 1, 1, 1}, {2, 3, 1, 1}};
    size_t dead = 0, flowing = 0, shut = 0;
    uint64_t seed = 5;

    (void)state;
    for (size_t k = 0; k < 600; k++) {
        struct rc_shape s = shapes[k % (sizeof shapes / sizeof *shapes)];
        bool around = k / 6 % 2 == 1, any = false;
        double g[64];
        struct leak_flow flow;

        random_gap(s, 0.5, 0.1 + 0.4 * leak_random(&seed), &seed, g);
        flow = leak_flow(s, NULL, g, 'x', around);
        for (size_t i = 0; i < s.nx * s.ny; i++) {
            bool on = g[i] > 0 && flows_by_force(s, g, around, i);
            assert_true(flow.channel[i] == (g[i] == 0 ? 0 : on ? 2 : 1));
            assert_true(g[i] == 0 ? isnan(flow.flux[i])
                        : on      ? flow.flux[i] >= 0
                                  : flow.flux[i] == 0);
            assert_true(!on || (flow.pressure[i] >= 0 && flow.pressure[i] <= 1));
            if (g[i] > 0 && !on)
                assert_true(isnan(flow.pressure[i]) ==
                            !reaches_an_end(s, g, around, i, s.nx * s.ny + 2));
            any = any || on;
            flowing += on;
            dead += g[i] > 0 && !on;
            shut += g[i] > 0 && isnan(flow.pressure[i]);
        }
        assert_true(any == flow.f.percolates && any == (flow.f.conductance > 0));
        leak_flow_free(&flow);
    }
    print_message("%zu nodes flow, %zu stand, %zu of them shut in\n", flowing, dead, shut);
    assert_true(flowing > 1000 && dead > 1000 && shut > 200);
}

/* ---- the critical gap, by closing ---- */

static bool
open_above(struct rc_shape s, const double *g, bool around, bool corners, double least)
{
    size_t n = s.nx * s.ny, count = 0;
    size_t *list = malloc(n * sizeof *list);
    bool *seen = calloc(n, sizeof *seen), through = false;

    for (size_t k = 0; k < n; k += s.nx)
        if (g[k] >= least && g[k] > 0) {
            seen[k] = true;
            list[count++] = k;
        }
    for (size_t m = 0; m < count; m++) {
        long i = (long)(list[m] % s.nx), j = (long)(list[m] / s.nx);
        through = through || i == (long)s.nx - 1;
        for (long b = -1; b <= 1; b++)
            for (long a = -1; a <= 1; a++) {
                long x = i + a, y = j + b;
                size_t to;
                if ((a != 0 && b != 0 && !corners) || x < 0 || x >= (long)s.nx)
                    continue;
                if (around)
                    y = (y + (long)s.ny) % (long)s.ny;
                if (y < 0 || y >= (long)s.ny)
                    continue;
                to = (size_t)(y * (long)s.nx + x);
                if (g[to] >= least && g[to] > 0 && !seen[to]) {
                    seen[to] = true;
                    list[count++] = to;
                }
            }
    }
    free(list);
    free(seen);
    return through;
}

static void
finds_the_critical_gap(void **state)
{
    static const struct rc_shape s = {19, 14, 1e-6, 0.9e-6};
    size_t open = 0, corners = 0;
    uint64_t seed = 77;

    (void)state;
    for (int k = 0; k < 200; k++) {
        bool around = k % 2 == 1;
        double g[19 * 14], at;
        struct rc_leak_figures f;
        size_t node;

        random_gap(s, 1, 0.3 + 0.2 * leak_random(&seed), &seed, g);
        f = leak_figures(s, NULL, g, 'x', around);
        assert_true(f.percolates == open_above(s, g, around, false, 0));
        assert_true(f.percolates_diagonal == open_above(s, g, around, true, 0));
        corners += f.percolates != f.percolates_diagonal;
        if (!f.percolates)
            continue;
        open++;
        node = (size_t)lround(f.critical_y / s.dy + (double)(s.ny - 1) / 2) * s.nx +
               (size_t)lround(f.critical_x / s.dx + (double)(s.nx - 1) / 2);
        at = g[node];
        assert_true(fabs(f.critical_gap / at - 1) < rounding);
        assert_true(open_above(s, g, around, false, at));
        assert_true(!open_above(s, g, around, false, at * (1 + 1e-9)));
    }
    print_message("%zu of 200 open, %zu by corners alone\n", open, corners);
    assert_true(open > 50 && corners > 10);
}

/* ---- bounds ---- */

/* For random networks, and for pools behind constrictions in series, where only the last one connects inlet
 * and outlet. */
static void
bounds_meet(void **state)
{
    enum {
        N = 60
    };
    static double g[N * N];
    const struct rc_shape s = {N, N, 1e-6, 1.2e-6};
    double worst = 0;
    uint64_t seed = 3;

    (void)state;
    for (int decades = 0; decades <= 10; decades++)
        for (int series = 0; series < 2; series++) {
            struct rc_leak_figures f;
            random_gap(s, series ? 0 : decades, series ? 0 : 0.1, &seed, g);
            for (size_t k = 0; series && k < N * N; k++) {
                size_t i = k % N, j = k / N;
                if (i == 20 || i == 40)
                    g[k] = j > 28 && j < 33 ? 1e-6 * pow(10, -decades) : 0;
            }
            f = leak_figures(s, NULL, g, 'x', false);
            worst = larger(worst, fabs(f.upper / f.conductance - 1));
            worst = larger(worst, fabs(f.lower / f.conductance - 1));
            /* throats of 4 nodes, two in series: 4 g^3/2 where they are far narrower than the pools */
            if (series && decades >= 6)
                assert_true(fabs(f.conductance / (4 * 1.2 * pow(1e-6 * pow(10, -decades), 3) / 2) -
                                 1) < 1e-12);
        }
    print_message("bounds, contrasts to 1e30: %.1e\n", worst);
    assert_true(worst < 1e-12);
}

/* ---- symmetries ---- */

static void
is_the_same(const struct leak_flow *a, const struct leak_flow *b, struct rc_shape s,
            size_t (*place)(struct rc_shape s, size_t k))
{
    const double near = 1e-11; /* pressures, in another order */

    assert_true(fabs(a->f.conductance / b->f.conductance - 1) < summed);
    assert_true(fabs(a->f.conductance_linear / b->f.conductance_linear - 1) < summed);
    assert_true(fabs(a->f.flow_factor / b->f.flow_factor - 1) < summed);
    assert_true(fabs(a->f.shear_flow_factor / b->f.shear_flow_factor - 1) < summed);
    assert_true(a->f.critical_gap == b->f.critical_gap);
    assert_true(fabs(a->f.slope / b->f.slope - 1) < summed);
    assert_int_equal(a->f.throat_nodes, b->f.throat_nodes);
    assert_int_equal(a->f.unknowns, b->f.unknowns);
    assert_int_equal(a->f.dead_nodes, b->f.dead_nodes);
    for (size_t k = 0; k < s.nx * s.ny; k++) {
        size_t l = place(s, k);
        assert_true(a->channel[k] == b->channel[l]);
        assert_true(isnan(a->pressure[k]) == isnan(b->pressure[l]));
        if (!isnan(a->pressure[k]))
            assert_true(fabs(a->pressure[k] - b->pressure[l]) < near);
        assert_true(isnan(a->flux[k]) == isnan(b->flux[l]));
        if (!isnan(a->flux[k]))
            assert_true(fabs(a->flux[k] - b->flux[l]) <= near * (a->flux[k] + 1e-14));
    }
}

static size_t
across_mirror(struct rc_shape s, size_t k)
{
    return (s.ny - 1 - k / s.nx) * s.nx + k % s.nx;
}

static size_t
turn(struct rc_shape s, size_t k)
{
    return k % s.nx * s.ny + s.ny - 1 - k / s.nx;
}

static size_t
shift_down(struct rc_shape s, size_t k)
{
    return (k / s.nx + 5) % s.ny * s.nx + k % s.nx;
}

static void
is_symmetric(void **state)
{
    static const struct rc_shape s = {31, 26, 1e-6, 1.3e-6}, turned = {26, 31, 1.3e-6, 1e-6};
    double g[31 * 26], other[31 * 26];
    uint64_t seed = 9;

    (void)state;
    for (int around = 0; around < 2; around++) {
        struct leak_flow a, b;
        struct rc_leak_figures back;
        random_gap(s, 0.7, 0.25, &seed, g);
        a = leak_flow(s, NULL, g, 'x', around != 0);
        assert_true(a.f.percolates && a.f.dead_nodes > 0);
        for (size_t k = 0; k < s.nx * s.ny; k++)
            other[across_mirror(s, k)] = g[k];
        b = leak_flow(s, NULL, other, 'x', around != 0);
        is_the_same(&a, &b, s, across_mirror);
        leak_flow_free(&b);
        for (size_t k = 0; k < s.nx * s.ny; k++) /* clockwise: the left side becomes the top */
            other[turn(s, k)] = g[k];
        b = leak_flow(turned, NULL, other, 'y', around != 0);
        is_the_same(&a, &b, s, turn);
        leak_flow_free(&b);
        for (size_t k = 0; around && k < s.nx * s.ny; k++)
            other[shift_down(s, k)] = g[k];
        if (around) {
            b = leak_flow(s, NULL, other, 'x', true);
            is_the_same(&a, &b, s, shift_down);
            leak_flow_free(&b);
        }
        for (size_t k = 0; k < s.nx * s.ny; k++) /* inlet and outlet change places */
            other[k / s.nx * s.nx + s.nx - 1 - k % s.nx] = g[k];
        back = leak_figures(s, NULL, other, 'x', around != 0);
        assert_true(fabs(back.conductance / a.f.conductance - 1) < summed);
        assert_true(fabs(back.shear_flow_factor / a.f.shear_flow_factor - 1) < summed);
        leak_flow_free(&a);
    }
}

/* Gaps times s give the conductance times s^3; lengths in the plane times s do not change it. A wider gap
 * anywhere increases the flow (Rayleigh), and the conductances of the two rules keep their order. */
static void
scales_and_grows(void **state)
{
    static const struct rc_shape s = {21, 23, 1e-6, 0.8e-6}, wide = {21, 23, 1e3, 0.8e3};
    double g[21 * 23], other[21 * 23];
    uint64_t seed = 21;
    struct rc_leak_figures a, b;

    (void)state;
    random_gap(s, 0.7, 0.2, &seed, g);
    a = leak_figures(s, NULL, g, 'y', false);
    assert_true(a.percolates);
    for (int k = -120; k <= 120; k += 40) {
        double size = pow(10, k / 2.0);
        for (size_t m = 0; m < 21 * 23; m++)
            other[m] = g[m] * size;
        b = leak_figures(s, NULL, other, 'y', false);
        assert_true(fabs(b.conductance / a.conductance / (size * size * size) - 1) < summed);
        assert_true(fabs(b.flow_factor / a.flow_factor - 1) < summed);
        assert_true(fabs(b.shear_flow_factor / a.shear_flow_factor - 1) < summed);
    }
    b = leak_figures(wide, NULL, g, 'y', false);
    assert_true(fabs(b.conductance / a.conductance - 1) < summed);
    assert_true(fabs(b.critical_x / a.critical_x / 1e9 - 1) < rounding);
    for (size_t m = 0; m < 21 * 23; m += 7) {
        memcpy(other, g, sizeof g);
        other[m] += 1e-7;
        b = leak_figures(s, NULL, other, 'y', false);
        assert_true(b.conductance >= a.conductance * (1 - rounding));
        assert_true(b.conductance_linear > b.conductance);
    }
}

/* ---- threads and memory ---- */

struct run {
    double conductance;
    double *p, *rest; /* of all nodes; freed by the caller */
};

static struct run
run(struct rc_passage *a, int threads, int32_t keep)
{
    size_t n = (size_t)a->nodes + 2;
    struct rc_levels levels = {calloc(n, sizeof(double)), calloc(n, sizeof(double))};
    struct run r = {.p = levels.p, .rest = levels.rest};
    struct rc_err err;
    struct rc_elimination *e;

    assert_int_equal(rc_blocks(a, &err), RC_OK);
    e = rc_elimination_new(a, threads, &err);
    assert_non_null(e);
    assert_int_equal(rc_elimination_run(e, RC_HARMONIC, &levels, keep, &r.conductance, &err),
                     RC_OK);
    rc_elimination_free(e);
    return r;
}

/* Any number of threads gives the same bits, and so do rows that are computed again instead of kept. The map
 * without contact has fronts that threads share. */
static void
takes_any_threads_and_memory(void **state)
{
    enum {
        NX = 421,
        NY = 380
    };
    static double g[NX * NY];
    static uint8_t flows[NX * NY];
    static const int32_t keep[] = {5000, 100, 30000, INT32_MAX};
    uint64_t seed = 8;

    (void)state;
    for (int around = 0; around < 2; around++) {
        struct rc_passage a = {NX, NY, NX * NY, NX * NY, NX * NY + 1, 0.8, around != 0, g, flows};
        size_t bytes = (NX * NY + 2) * sizeof(double);
        struct run first;
        random_gap((struct rc_shape){NX, NY, 1, 1}, 4, around ? 0.25 : 0, &seed, g);
        first = run(&a, 1, 0);
        assert_true(first.conductance > 0);
        for (int k = 0; k < 4; k++) {
            struct run r = run(&a, k % 3 + 1, keep[k]);
            assert_true(r.conductance == first.conductance);
            assert_memory_equal(r.p, first.p, bytes);
            assert_memory_equal(r.rest, first.rest, bytes);
            free(r.p);
            free(r.rest);
        }
        free(first.p);
        free(first.rest);
    }
}

/* Another gap in an existing solver, before and after its steps, gives exactly the numbers of a new
 * solver. */
static void
takes_another_gap(void **state)
{
    static const struct rc_shape s = {31, 26, 1e-6, 1.3e-6};
    const struct rc_leak_options options = {.direction = 'y', .around = true, .threads = 1};
    double g[31 * 26], p[31 * 26] = {0}, flux[31 * 26], bad[31 * 26];
    const struct rc_leak_figures *is;
    uint64_t seed = 31;
    struct rc_err err;
    struct rc_leak *l;

    (void)state;
    random_gap(s, 0.9, 0.25, &seed, g);
    l = rc_leak_new(&s, NULL, g, &options, &err);
    assert_non_null(l);
    for (int k = 0; k < 4; k++) {
        struct rc_leak_figures fresh;
        random_gap(s, 0.7, k == 2 ? 0.8 : 0.25, &seed, g); /* the one of k = 2 is closed */
        p[40 * k] = 1;
        memcpy(bad, g, sizeof g);
        bad[77] = NAN;
        assert_int_equal(rc_leak_set_gap(l, p, bad, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "has no finite gap"));
        assert_int_equal(rc_leak_set_gap(l, p, g, &err), RC_OK);
        if (k == 0)
            continue;
        while (rc_leak_step(l, &err) == RC_MORE)
            ;
        fresh = leak_figures(s, p, g, 'y', true);
        assert_int_equal(fresh.percolates, k != 2);
        is = rc_leak_result(l);
        if (is->conductance != fresh.conductance || is->lower != fresh.lower ||
            is->upper != fresh.upper || is->conductance_linear != fresh.conductance_linear ||
            is->mean_gap != fresh.mean_gap || is->critical_gap != fresh.critical_gap ||
            is->unknowns != fresh.unknowns || is->fluid_nodes != fresh.fluid_nodes)
            fail_msg("gap %d: conductance %.17g, new %.17g", k, is->conductance, fresh.conductance);
        rc_leak_flux(l, flux);
        assert_true(p[40 * k] == 1 && isnan(flux[40 * k]));
    }
    rc_leak_free(l);
}

static void
refuses(void **state)
{
    const struct rc_shape s = {3, 2, 1e-6, 1e-6}, none = {0, 2, 1e-6, 1e-6};
    const struct rc_shape huge = {65536, 32768, 1e-6, 1e-6};
    const double g[6] = {1, 1, 1, 1, NAN, 1}, p[6] = {0, 0, INFINITY, 0, 0, 0}, good[6] = {0};
    struct rc_leak_options options = {0};
    struct rc_err err;

    (void)state;
    assert_null(rc_leak_new(&s, NULL, g, &options, &err));
    assert_non_null(strstr(err.text, "node (1, 1) has no finite gap"));
    assert_null(rc_leak_new(&s, p, good, &options, &err));
    assert_non_null(strstr(err.text, "node (2, 0) has no finite pressure"));
    assert_null(rc_leak_new(&none, NULL, g, &options, &err));
    assert_null(rc_leak_new(&huge, NULL, g, &options, &err));
    assert_non_null(strstr(err.text, "cut the map"));
    options.direction = 'z';
    assert_null(rc_leak_new(&s, NULL, good, &options, &err));
    assert_non_null(strstr(err.text, "x or y, not 'z'"));
    options.direction = 'y'; /* contact everywhere is not an error */
    assert_false(leak_figures(s, NULL, good, 'y', true).percolates);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_dense),
        cmocka_unit_test(tells_what_stands),
        cmocka_unit_test(finds_the_critical_gap),
        cmocka_unit_test(bounds_meet),
        cmocka_unit_test(is_symmetric),
        cmocka_unit_test(scales_and_grows),
        cmocka_unit_test(takes_any_threads_and_memory),
        cmocka_unit_test(takes_another_gap),
        cmocka_unit_test(refuses),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
