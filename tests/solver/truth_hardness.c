/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A map of hardness. The pressure is that of a dense quadratic program with an individual bound for each
 * node. It obeys the laws of contact in hard cases: two phases, equal heights, saturation, nodes without a
 * hardness. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "dense.h"

static const double estar = 1e11;

/* ---- the equations ---- */

static uint64_t seed;

static double
uniform(void)
{
    return random_number(&seed) + 0.5;
}

static void
make_rough(const struct rc_shape *shape, uint64_t which, double *h)
{
    struct rc_selfaffine rough = {
        .hurst = 0.7, .rms_slope = 0.02, .short_cut = 4 * shape->dx, .seed = which};

    assert_int_equal(rc_synth_selfaffine(shape, &rough, h, NULL), RC_OK);
}

static struct solved
press(const struct rc_shape *shape, const double *h, struct rc_problem problem)
{
    struct solved s;

    problem.pair.estar = estar;
    s = solve(*shape, h, problem);
    if (s.status == RC_FAIL)
        fail_msg("%s", s.err.text);
    return s;
}

/* The load that is this fraction of the map's capacity; if a node has no hardness, a fraction of the mean of
 * the finite values. */
static double
load_of(const struct rc_shape *shape, const double *map, double part)
{
    double sum = 0, count = 0;

    for (size_t k = 0; k < shape->nx * shape->ny; k++)
        if (isfinite(map[k])) {
            sum += map[k];
            count++;
        }
    return part * sum / count * (double)(shape->nx * shape->ny) * shape->dx * shape->dy;
}

/* Checks 0 <= p <= H, the load, the signs of the gaps, and the count of nodes at their hardness. */
static size_t
lawful(const struct rc_shape *shape, const double *map, double load, const struct solved *a)
{
    size_t n = shape->nx * shape->ny, full = 0;
    double sum = 0;

    assert_true(a->c.converged);
    for (size_t k = 0; k < n; k++) {
        double p = a->p[k], most = isnan(map[k]) ? INFINITY : map[k];
        assert_true(p >= 0 && p <= most);
        sum += p;
        full += p >= most;
        assert_true((p > 0 && p < most) || (p == 0 && a->gap[k] >= -a->c.gap_error) ||
                    (p == most && a->gap[k] <= a->c.gap_error));
        assert_true(p == 0 || p == most || fabs(a->gap[k]) <= a->c.gap_error);
    }
    assert_true(fabs(sum * shape->dx * shape->dy / load - 1) < summed);
    assert_int_equal(full, a->c.plastic_nodes);
    return full;
}

/* ---- the dense quadratic program ---- */

enum {
    SIDE = 24,
    N = SIDE * SIDE
};

static void
as_a_quadratic_program(void **state)
{
    static double h[N], map[N], most[N], p[N];
    static struct dense d;
    struct rc_shape shape = {SIDE, SIDE, 1e-6, 1.2e-6};
    size_t plastic = 0, missing = 0;
    double worst = 0;

    (void)state;
    for (int boundary = 0; boundary < 2; boundary++) {
        dense_fill(&d, &shape, (boundary == 0 ? RC_FREE : RC_PERIODIC), estar);
        for (size_t r = 0; r < 10; r++) {
            struct rc_problem problem = {.boundary = boundary == 0 ? RC_FREE : RC_PERIODIC,
                                         .hardness_map = map,
                                         .tol = 1e-12};
            struct solved a;
            double shift;

            seed = 17 * r + (size_t)boundary;
            make_rough(&shape, r + 1, h);
            for (size_t k = 0; k < N; k++) {
                map[k] = 4e8 * pow(10, 1.5 * uniform());
                if (r % 2 == 1 && uniform() < 0.2)
                    map[k] = uniform() < 0.5 ? NAN : INFINITY;
                most[k] = isnan(map[k]) ? INFINITY : map[k];
                missing += isinf(most[k]) ? 1 : 0;
            }
            problem.load = load_of(&shape, map, 0.05 + 0.08 * (double)r);
            d.value[0] = problem.load / (shape.dx * shape.dy);
            for (size_t k = 0; k < N; k++)
                p[k] = isinf(most[k]) ? 1 : most[k] / 2; /* all elastic */
            dense_solve(&d, h, most, p, &shift);
            a = press(&shape, h, problem);
            plastic += a.c.plastic_nodes;
            worst = larger(worst, distance(N, a.p, p));
            assert_true(distance(N, a.p, p) < 1e-9);
            solved_free(&a);
        }
    }
    print_message("20 maps, %zu nodes at their hardness, %zu without: L1 %.1e\n", plastic, missing,
                  worst);
    assert_true(plastic > 1000 && missing > 500);
}

/* ---- uniform maps ---- */

static void
one_number_is_that_number(void **state)
{
    struct rc_shape shape = {70, 61, 1e-6, 1e-6};
    size_t n = shape.nx * shape.ny;
    double *h = malloc(n * sizeof *h), *map = malloc(n * sizeof *map);

    (void)state;
    make_rough(&shape, 3, h);
    for (int boundary = 0; boundary < 2; boundary++)
        for (int none = 0; none < 2; none++) {
            struct rc_problem number = {.boundary = boundary == 0 ? RC_FREE : RC_PERIODIC,
                                        .load = 5e8 * (double)n * 1e-12,
                                        .hardness = none ? 0 : 1.5e9},
                              mapped = number;
            struct solved a, b;
            for (size_t k = 0; k < n; k++)
                map[k] = none ? NAN : 1.5e9;
            mapped.hardness = 0;
            mapped.hardness_map = map;
            a = press(&shape, h, number);
            b = press(&shape, h, mapped);
            assert_memory_equal(a.p, b.p, n * sizeof *a.p);
            assert_memory_equal(a.gap, b.gap, n * sizeof *a.gap);
            assert_int_equal(a.c.plastic_nodes > 0, !none);
            assert_true(a.c.convolutions == b.c.convolutions);
            solved_free(&a);
            solved_free(&b);
        }
    free(h);
    free(map);
}

/* A map of nearly one value takes the same steps as that number, and gives the same pressure. */
static void
as_quick_as_a_number(void **state)
{
    static const struct rc_shape shapes[] = {{256, 256, 1e-6, 1e-6}, {500, 37, 1e-6, 1.3e-6}};

    (void)state;
    for (int way = 0; way < 4; way++) {
        struct rc_shape shape = shapes[way / 2];
        size_t n = shape.nx * shape.ny;
        double *h = malloc(n * sizeof *h), *map = malloc(n * sizeof *map);
        struct rc_problem number = {.boundary = way % 2 ? RC_PERIODIC : RC_FREE,
                                    .load = 6e8 * (double)n * shape.dx * shape.dy,
                                    .hardness = 1.5e9,
                                    .tol = 1e-6},
                          mapped = number;
        struct solved a, b;

        make_rough(&shape, 3, h);
        for (size_t k = 0; k < n; k++)
            map[k] = 1.5e9 * (1 + 1e-12 * (double)(k % 2));
        mapped.hardness = 0;
        mapped.hardness_map = map;
        a = press(&shape, h, number);
        b = press(&shape, h, mapped);
        assert_true(distance(n, b.p, a.p) < 2 * number.tol);
        assert_true(b.c.iterations <=
                    a.c.iterations + 1); /* the number of nodes at a bound may differ by one */
        assert_true(a.c.plastic_nodes > 1000);
        solved_free(&a);
        solved_free(&b);
        free(h);
        free(map);
    }
}

/* A hardness that no node reaches has no effect, whatever its values. */
static void
far_away_is_elastic(void **state)
{
    struct rc_shape shape = {64, 64, 1e-6, 1e-6};
    size_t n = shape.nx * shape.ny;
    double *h = malloc(n * sizeof *h), *map = malloc(n * sizeof *map);
    struct rc_problem elastic = {.load = 2e8 * (double)n * 1e-12, .tol = 1e-9}, mapped = elastic;
    struct solved a, b;

    (void)state;
    make_rough(&shape, 3, h);
    a = press(&shape, h, elastic);
    for (size_t k = 0; k < n; k++)
        map[k] = (10 + (double)(k % 7)) * a.c.max_pressure;
    mapped.hardness_map = map;
    b = press(&shape, h, mapped);
    assert_true(distance(n, b.p, a.p) < 2 * elastic.tol);
    assert_false(b.c.hardness_active);
    solved_free(&a);
    solved_free(&b);
    free(h);
    free(map);
}

/* ---- hard cases ---- */

/* Flats of equal height and patches of equal hardness; loads up to the capacity of all nodes. */
static void
ties_and_saturation(void **state)
{
    static const double parts[] = {0.3, 0.9, 0.999, 1};
    struct rc_shape shape = {33, 47, 1e-6, 1.1e-6};
    size_t n = shape.nx * shape.ny;
    double *h = malloc(n * sizeof *h), *map = malloc(n * sizeof *map);

    (void)state;
    for (int way = 0; way < 8; way++)
        for (size_t r = 0; r < sizeof parts / sizeof *parts; r++) {
            struct rc_problem problem = {
                .boundary = way & 1 ? RC_PERIODIC : RC_FREE, .hardness_map = map, .tol = 1e-7};
            struct solved a;
            size_t full;
            double load;

            for (size_t k = 0; k < n; k++) {
                bool soft = (k % shape.nx / 8 + k / shape.nx / 8) % 2 == 0;
                h[k] = way & 2 ? 1e-9 * (double)(k % 3) : 0;
                if (way & 4)
                    h[k] += k % shape.nx < 11 ? 1e-3 : 0; /* a step that no pressure flattens */
                map[k] = soft ? 1e8 : 3e8;
            }
            problem.load = load = load_of(&shape, map, parts[r]);
            a = press(&shape, h, problem);
            full = lawful(&shape, map, load, &a);
            assert_true(parts[r] < 1 || full == n);
            solved_free(&a);
        }
    free(h);
    free(map);
}

/* One node without a hardness carries all the load that the others cannot carry. */
static void
one_node_without(void **state)
{
    struct rc_shape shape = {30, 31, 1e-6, 1e-6};
    size_t n = shape.nx * shape.ny, which = 15 * 30 + 11;
    double *h = malloc(n * sizeof *h), *map = malloc(n * sizeof *map), rest, load;

    (void)state;
    for (int boundary = 0; boundary < 2; boundary++) {
        struct rc_problem problem = {
            .boundary = boundary == 0 ? RC_FREE : RC_PERIODIC, .hardness_map = map, .tol = 1e-7};
        struct solved a;
        for (size_t k = 0; k < n; k++) {
            h[k] = k == which ? -1e-6 : 1e-9 * (double)(k % 5);
            map[k] = k == which ? NAN : 1e6 * (double)(1 + k % 2);
        }
        load = problem.load = 2 * load_of(&shape, map, 1);
        a = press(&shape, h, problem);
        (void)lawful(&shape, map, load, &a);
        rest = load / 1e-12;
        for (size_t k = 0; k < n; k++)
            rest -= k == which ? 0 : map[k];
        assert_int_equal(a.c.plastic_nodes, n - 1);
        assert_true(fabs(a.p[which] / rest - 1) < summed);
        solved_free(&a);
    }
    free(h);
    free(map);
}

/* Two phases in stripes and spots, and coarser grids on which their edges lie inside cells. */
static void
two_phases(void **state)
{
    const bool pcg = strcmp(contact_method, "pcg") == 0;
    size_t side = pcg ? 1024 : 65;
    struct rc_shape shape = {side, side - 1, 1e-6, 1e-6};
    size_t n = shape.nx * shape.ny;
    double *h = malloc(n * sizeof *h), *map = malloc(n * sizeof *map);

    (void)state;
    for (int boundary = 0; boundary < 2; boundary++) {
        struct rc_problem problem = {
            .boundary = boundary == 0 ? RC_FREE : RC_PERIODIC, .hardness_map = map, .tol = 1e-5};
        double load, soft = 0, hard = 0;
        struct solved a;

        make_rough(&shape, 7, h);
        for (size_t k = 0; k < n; k++) {
            size_t i = k % shape.nx, j = k / shape.nx;
            bool spot = (i / 13 + j / 29) % 3 == 0 || hypot((double)i - 30, (double)j - 30) < 20;
            map[k] = spot ? 6e8 : 2.4e9;
        }
        load = problem.load = load_of(&shape, map, 0.2);
        a = press(&shape, h, problem);
        (void)lawful(&shape, map, load, &a);
        for (size_t k = 0; k < n; k++)
            if (a.p[k] >= map[k])
                *(map[k] < 1e9 ? &soft : &hard) += 1;
        print_message("%zu nodes: %.3g of the nodes at the lower hardness, %.3g at the higher; "
                      "%.3g convolutions\n",
                      n, soft / (double)n, hard / (double)n, a.c.convolutions);
        assert_true(soft > 100 && hard > 10);
        solved_free(&a);
    }
    free(h);
    free(map);
}

/* A mirrored map, a mirrored pressure. */
static void
mirrored(void **state)
{
    struct rc_shape shape = {45, 38, 1e-6, 1.2e-6};
    size_t n = shape.nx * shape.ny;
    double *h = malloc(n * sizeof *h), *map = malloc(n * sizeof *map);
    double *g = malloc(n * sizeof *h), *other = malloc(n * sizeof *map);

    (void)state;
    make_rough(&shape, 9, h);
    seed = 3;
    for (size_t k = 0; k < n; k++)
        map[k] = uniform() < 0.1 ? NAN : 5e8 * (1 + 3 * uniform());
    for (size_t k = 0; k < n; k++) {
        g[n - 1 - k] = h[k];
        other[n - 1 - k] = map[k];
    }
    for (int boundary = 0; boundary < 2; boundary++) {
        struct rc_problem problem = {.boundary = boundary == 0 ? RC_FREE : RC_PERIODIC,
                                     .hardness_map = map,
                                     .load = load_of(&shape, map, 0.4),
                                     .tol = 1e-9};
        struct solved a = press(&shape, h, problem), b;
        problem.hardness_map = other;
        b = press(&shape, g, problem);
        for (size_t k = 0; k < n / 2; k++) {
            double p = b.p[k];
            b.p[k] = b.p[n - 1 - k];
            b.p[n - 1 - k] = p;
        }
        assert_true(distance(n, b.p, a.p) < 2 * problem.tol);
        assert_true(a.c.plastic_nodes > 100);
        solved_free(&a);
        solved_free(&b);
    }
    free(h);
    free(g);
    free(map);
    free(other);
}

/* An approach, a history, and a start from a saved pressure give the same as with one number. */
static void
other_ways(void **state)
{
    struct rc_shape shape = {60, 52, 1e-6, 1e-6};
    size_t n = shape.nx * shape.ny;
    double *h = malloc(n * sizeof *h), *map = malloc(n * sizeof *map), load, sought;
    double *kept = malloc(n * sizeof *kept);
    struct rc_problem problem = {.pair.estar = estar,
                                 .hardness_map = map,
                                 .boundary = RC_PERIODIC,
                                 .tol = 1e-8,
                                 .method = contact_method};
    struct rc_solver *s;
    struct rc_contact c, again;

    (void)state;
    make_rough(&shape, 2, h);
    for (size_t k = 0; k < n; k++)
        map[k] = k % shape.nx < 20 ? NAN : k % shape.nx < 40 ? 8e8 : 2e9;
    problem.load = load = load_of(&shape, map, 0.3);
    s = rc_solver_new(&shape, h, &problem, NULL);
    assert_non_null(s);
    memset(map, 0, n * sizeof *map); /* it was copied */
    while (rc_solver_step(s) == RC_MORE)
        ;
    rc_solver_result(s, NULL, NULL, &c);
    assert_true(c.converged && c.yielded_nodes > 100);
    memcpy(kept, rc_solver_pressure(s), n * sizeof *kept);
    assert_int_equal(rc_solver_set_load(s, 0, c.approach, NULL), RC_OK);
    while (rc_solver_step(s) == RC_MORE)
        ;
    sought = rc_solver_load(s);
    assert_true(fabs(sought / load - 1) < 1e-6);
    assert_int_equal(rc_solver_set_load(s, load, 0, NULL), RC_OK);
    assert_int_equal(rc_solver_warm_start(s, load, kept, NULL), RC_OK);
    while (rc_solver_step(s) == RC_MORE)
        ;
    rc_solver_result(s, NULL, NULL, &again);
    assert_true(distance(n, rc_solver_pressure(s), kept) < 2 * problem.tol);
    assert_int_equal(rc_solver_keep_shape(s, &again, h, NULL), RC_OK);
    while (rc_solver_step(s) == RC_MORE)
        ;
    rc_solver_result(s, NULL, NULL, &again);
    assert_int_equal(again.yielded_nodes, 0);
    assert_true(distance(n, rc_solver_pressure(s), kept) < 8 * problem.tol);
    rc_solver_free(s);
    free(h);
    free(map);
    free(kept);
}

/* ---- refusals ---- */

static void
refusals(void **state)
{
    struct rc_shape shape = {8, 6, 1e-6, 1e-6};
    double h[48] = {0}, map[48];
    struct rc_problem problem = {.pair.estar = estar, .load = 0.03, .hardness_map = map};
    struct rc_expected expected;
    struct rc_err err;

    (void)state;
    for (size_t k = 0; k < 48; k++)
        map[k] = k < 24 ? 1e8 : 2e9; /* 0.0504 N */
    problem.load = 0.051;
    assert_null(rc_solver_new(&shape, h, &problem, &err));
    assert_non_null(strstr(err.text,
                           "load 0.051 N is above the sum of the hardness map times the cell, "
                           "5.04e+10 Pa x 1e-12 m2 = 0.0504 N"));
    assert_int_equal(rc_solver_expect(&shape, &problem, &expected, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "= 0.0504 N"));
    map[5] = NAN; /* which carries anything */
    assert_int_equal(rc_solver_expect(&shape, &problem, &expected, &err), RC_OK);
    map[11] = 0;
    map[12] = -INFINITY;
    map[30] = -1;
    assert_null(rc_solver_new(&shape, h, &problem, &err));
    assert_non_null(
        strstr(err.text, "3 of 48 hardnesses are not above 0, the first in column 3 of row 1"));
    problem.hardness = 1e9;
    assert_null(rc_solver_new(&shape, h, &problem, &err));
    assert_non_null(strstr(err.text, "hardness 1e+09 Pa and a map of hardness"));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_a_quadratic_program),
        cmocka_unit_test(one_number_is_that_number),
        cmocka_unit_test(as_quick_as_a_number),
        cmocka_unit_test(far_away_is_elastic),
        cmocka_unit_test(ties_and_saturation),
        cmocka_unit_test(one_node_without),
        cmocka_unit_test(two_phases),
        cmocka_unit_test(mirrored),
        cmocka_unit_test(other_ways),
        cmocka_unit_test(refusals),
    };
    int failed = 0;

    RUN_FOR_EACH_METHOD(tests, failed);
    return failed;
}
