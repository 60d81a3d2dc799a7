/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A compliance c of every node for itself adds c to the diagonal of K. The pressure is that of a dense
 * quadratic program with K + c I, with a c that differs by node, or with rows that move. It is also that of a
 * thin layer without Poisson's ratio, bare and over coats, on both boundaries and by each engine. The
 * estimate of its error is not below the error. Gap and displacement are those of the elastic bodies. With
 * c = 0 the contact is the one without compliance, to the last bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "dense.h"

enum {
    PROBLEMS = 160, /* number of random small maps */
    SIDE = 64,
    NODES = SIDE * SIDE
};
static const double cell = 1e-6,
                    base = 1e9;      /* dx, E of the base and E*: c is in units of dx / E* */
static const double reported = 1e-9; /* errors of the pressure are told down to here       */

static double
uniform(uint64_t *seed)
{
    return random_number(seed) + 0.5;
}

/* The influence of the cell in the corner on all others, with c on itself. */
static void
fill(struct dense *d, const struct rc_shape *s, const struct rc_problem *problem, double c)
{
    struct rc_conv_options options = {.boundary = problem->boundary};
    struct rc_conv *conv = rc_conv_new(s, &problem->pair, &options, NULL);
    double *p = calloc(s->nx * s->ny, sizeof *p), *u = calloc(s->nx * s->ny, sizeof *u);

    assert_non_null(conv);
    p[0] = 1;
    rc_conv_apply(conv, p, u);
    u[0] += c;
    if (!rc_has_mean(problem->boundary)) /* any mean changes only the shift */
        for (size_t k = 0; k < s->nx * s->ny; k++)
            u[k] += cell / base;
    dense_of(d, s, u);
    rc_conv_free(conv);
    free(p);
    free(u);
}

/* The contact of these heights under a load, with a compliance. */
static struct rc_model *
contact_of(const struct rc_shape *s, const double *h, const struct rc_problem *problem, double c,
           const double *part, double along)
{
    struct rc_err err = {""};
    struct rc_model *m = rc_elastic_new(s, h, problem, NULL, &err);
    struct rc_point to = {0};

    if (m == NULL || rc_model_set_compliance(m, c, part, along, &err) != RC_OK)
        fail_msg("%s", err.text);
    rc_point_set(&to, RC_LOAD, problem->load);
    if (rc_model_run(m, &to, &err) != RC_OK || rc_model_look(m, NULL, &err) != RC_OK)
        fail_msg("compliance %g dx/E*: %s", c * base / cell, err.text);
    return m;
}

static struct rc_model *
contact(const struct rc_shape *s, const double *h, const struct rc_problem *problem, double c)
{
    return contact_of(s, h, problem, c, NULL, 0);
}

/* Numbers from 0 to 1 by which c is multiplied: two phases, a disc of 0, or waves over some decades. */
static void
parts(uint64_t *seed, const struct rc_shape *s, double *part)
{
    const int kind = (int)(3 * uniform(seed)), side = 2 + (int)(6 * uniform(seed));
    const double least = pow(10, -2 * uniform(seed)), radius = 2 + 5 * uniform(seed);

    for (size_t k = 0; k < s->nx * s->ny; k++) {
        int i = (int)(k % s->nx), j = (int)(k / s->nx);
        part[k] = kind == 0   ? (i / side + j / side) % 2 ? 1 : least
                  : kind == 1 ? hypot(i - 6, j - 6) < radius ? 0 : 1
                              : pow(least, 0.5 + 0.5 * sin(0.6 * i) * cos(0.4 * j));
    }
}

static void
frame(struct rc_model *m, const char *name, double *to)
{
    struct rc_err err = {""};

    if (rc_model_frame(m, name, to, &err) != RC_OK)
        fail_msg("%s", err.text);
}

static void
rough(uint64_t *seed, const struct rc_shape *s, double *h)
{
    const double phase[] = {6 * uniform(seed), 6 * uniform(seed), 6 * uniform(seed)};

    for (size_t k = 0; k < s->nx * s->ny; k++) {
        double x = (double)(k % s->nx) / (double)s->nx, y = (double)(k / s->nx) / (double)s->ny;
        h[k] = cell * (0.4 * sin(2 * exact_pi * x + phase[0]) +
                       0.3 * cos(2 * exact_pi * (2 * x - y) + phase[1]) +
                       0.2 * sin(6 * exact_pi * y + phase[2]) + 0.1 * random_number(seed));
    }
}

static void
estimates_are_not_below(void **state)
{
    static struct dense d;
    static double most[DENSE_NODES], p[DENSE_NODES], h[DENSE_NODES], found[DENSE_NODES];
    static double part[DENSE_NODES];
    double high = 0;

    (void)state;
    for (size_t q = 0; q < PROBLEMS; q++) {
        uint64_t seed = 1 + q;
        struct rc_shape s = {12 + (size_t)(13 * uniform(&seed)), 10 + (size_t)(12 * uniform(&seed)),
                             cell, (0.8 + 0.4 * uniform(&seed)) * cell};
        struct rc_layer coat = {cell, base * pow(10, 1 - 2 * uniform(&seed)), 0.3};
        struct rc_problem problem = {.boundary = q % 2 == 0 ? RC_FREE : RC_PERIODIC,
                                     .tol = pow(10, -2 - 4 * uniform(&seed)),
                                     .threads = 1};
        const double c = q % 16 == 8 ? 0 : pow(10, -2 + 6 * uniform(&seed)) * cell / base;
        const double along =
            q % 8 < 2 && q % 3 != 2 ? pow(10, -3 + 5 * uniform(&seed)) / base : 0; /* no parts */
        const size_t n = s.nx * s.ny;
        double error = 0, estimate, shift[DENSE_SUMS], sum = 0;
        struct rc_model *m;

        problem.pair.estar = base;
        if (q % 3 == 0)
            problem.pair = (struct rc_pair){.one = {base, 0.3, 1, &coat}, .two.e = INFINITY};
        problem.load = pow(10, 7 + uniform(&seed)) * (double)n * s.dx * s.dy;
        problem.hardness = q % 5 == 0 ? 3 * problem.load / ((double)n * s.dx * s.dy) : 0;
        rough(&seed, &s, h);
        parts(&seed, &s, part);
        for (size_t k = 0; k < n && q / 2 % 2 == 0; k++)
            part[k] = 1;
        m = contact_of(&s, h, &problem, c, q / 2 % 4 == 0 ? NULL : part, along);
        frame(m, "pressure", found);
        estimate = rc_model_number(m, "pressure_error_estimate");
        fill(&d, &s, &problem, 0);
        for (size_t k = 0; k < n; k++) {
            d.K[k][k] += c * part[k];
            for (size_t i = 0; i < s.nx; i++)
                d.K[k][k / s.nx * s.nx + i] += along * s.dx;
        }
        d.value[0] = problem.load / (s.dx * s.dy);
        for (size_t k = 0; k < n; k++) {
            most[k] = problem.hardness > 0 ? problem.hardness : INFINITY;
            p[k] = found[k];
        }
        dense_solve(&d, h, most, p, shift);
        for (size_t k = 0; k < n; k++) {
            error += fabs(p[k] - found[k]);
            sum += p[k];
        }
        error /= sum;
        if (error > estimate + reported || estimate > problem.tol)
            fail_msg("%zu: %zu x %zu nodes, compliance %.3g dx/E*, of rows %.3g/E*: error %.3g, "
                     "estimated %.3g, tol %.2g\n",
                     q, s.nx, s.ny, c * base / cell, along * base, error, estimate, problem.tol);
        high = error > reported ? fmax(high, estimate / error) : high;
        rc_model_free(m);
    }
    print_message("largest estimate: %.2g of the error\n", high);
}

/* ---- a thin layer ---- */

static double
differ(size_t n, const double *a, const double *b)
{
    double off = 0, size = 0;

    for (size_t k = 0; k < n; k++) {
        off += fabs(a[k] - b[k]);
        size += fabs(b[k]);
    }
    return off / size;
}

/* E = thickness / c and no Poisson's ratio: each column of the layer is a spring. What its thickness of 1e-4
 * nodes spreads to the sides, and the tolerance, are within `alike`. */
static void
a_thin_layer_is_the_same(void **state)
{
    static const double alike = 2e-6, thickness = 1e-4;
    static const struct rc_shape s = {SIDE, SIDE, 1e-6, 1.1e-6};
    static double h[NODES], p[NODES], want[NODES];
    const char *engines[] = {"fft", "fft64", "direct", "mlms"};
    uint64_t seed = 7;

    (void)state;
    rough(&seed, &s, h);
    for (int q = 0; q < 10; q++) {
        const double c = (q % 2 == 0 ? 0.3 : 30) * cell / base;
        struct rc_layer layers[2] = {{thickness * cell, thickness * cell / c, 0},
                                     {2 * cell, 4 * base, 0.3}};
        struct rc_problem problem = {.pair.one = {base, 0.3, q < 6 ? 0 : 1, layers + 1},
                                     .pair.two.e = INFINITY,
                                     .boundary = q < 4 || q > 7 ? RC_FREE : RC_PERIODIC,
                                     .engine = q < 4 ? engines[q] : NULL,
                                     .load = 4e-3,
                                     .tol = 1e-7,
                                     .threads = 1};
        struct rc_model *m = contact(&s, h, &problem, c), *thin;

        problem.pair.one.layers++;
        problem.pair.one.layer = layers;
        problem.engine = NULL;
        thin = contact(&s, h, &problem, 0);
        frame(m, "pressure", p);
        frame(thin, "pressure", want);
        if (!(differ(NODES, p, want) <= alike))
            fail_msg("compliance %g dx/E*, %s engine, case %d: the pressures differ by %.2e of the "
                     "layer's",
                     c * base / cell, problem.engine, q, differ(NODES, p, want));
        rc_model_free(m);
        rc_model_free(thin);
    }
}

/* ---- figures of the answer ---- */

/* The displacement is K p. The gap, with the displaced film, is that of heights less c p and the motion of
 * rows. Those heights have the same pressure without a compliance. */
static void
figures_are_those_of_the_bodies(void **state)
{
    static const struct rc_shape s = {SIDE, SIDE, 1e-6, 1e-6};
    static double h[NODES], p[NODES], u[NODES], g[NODES], want[NODES], again[NODES];
    const double c = 3 * cell / base, along = 0.2 / base;
    const struct rc_problem problem = {
        .pair.estar = base, .load = 5e-3, .tol = 1e-9, .boundary = RC_PERIODIC, .threads = 1};
    const struct rc_conv_options options = {.boundary = RC_PERIODIC};
    struct rc_conv *conv = rc_conv_new(&s, &problem.pair, &options, NULL);
    uint64_t seed = 3;
    double energy = 0, shift = NAN, top = -INFINITY;
    struct rc_model *m, *bare;
    struct rc_point at;

    (void)state;
    rough(&seed, &s, h);
    m = contact_of(&s, h, &problem, c, NULL, along);
    assert_int_equal(rc_model_look(m, &at, NULL), RC_OK);
    frame(m, "pressure", p);
    frame(m, "displacement", u);
    frame(m, "gap", g);
    rc_conv_apply(conv, p, want);
    assert_true(differ(NODES, u, want) < 1e-8);
    for (size_t k = 0; k < NODES; k++) {
        top = fmax(top, h[k]);
        energy += p[k] * want[k] / 2 * s.dx * s.dy;
        h[k] -= c * p[k];
        for (size_t i = 0; i < SIDE; i++)
            h[k] -= along * s.dx * p[k / SIDE * SIDE + i];
    }
    shift = at.at[RC_APPROACH] - top;
    for (size_t k = 0; k < NODES; k++)
        assert_true(fabs(g[k] - (want[k] - h[k] - shift)) < 1e-8 * cell);
    assert_true(fabs(rc_model_number(m, "elastic_energy") / energy - 1) < 1e-8);
    bare = contact(&s, h, &problem, 0);
    frame(bare, "pressure", again);
    assert_true(differ(NODES, again, p) < 4 * problem.tol);
    rc_model_free(m);
    rc_model_free(bare);
    rc_conv_free(conv);
}

/* Compliance set to 0 again, and never set, gives the same bytes and as many convolutions. */
static void
none_is_the_contact_without(void **state)
{
    static const struct rc_shape s = {SIDE, SIDE, 1e-6, 1e-6};
    static double h[NODES], p[2][NODES];
    struct rc_problem problem = {.pair.estar = base, .load = 5e-3, .threads = 1};
    struct rc_err err = {""};
    double cost[2];
    uint64_t seed = 3;

    (void)state;
    rough(&seed, &s, h);
    for (int q = 0; q < 4; q++) {
        problem.boundary = q % 2 == 0 ? RC_FREE : RC_PERIODIC;
        for (int k = 0; k < 2; k++) {
            struct rc_model *m = rc_elastic_new(&s, h, &problem, NULL, &err);
            struct rc_point to = {0};
            rc_point_set(&to, RC_LOAD, problem.load);
            assert_int_equal(rc_model_go(m, &to, &err), RC_MORE);
            if (k > 0) {
                assert_int_equal(rc_model_set_compliance(m, 1e-14, NULL, 1e-8, &err), RC_OK);
                assert_int_equal(rc_model_set_compliance(m, 0, NULL, 0, &err), RC_OK);
            }
            assert_int_equal(rc_model_run(m, &to, &err), RC_OK);
            frame(m, "pressure", (rc_model_look(m, NULL, &err), p[k]));
            cost[k] = rc_model_number(m, "convolutions");
            rc_model_free(m);
        }
        assert_memory_equal(p[0], p[1], sizeof p[0]);
        assert_true(cost[0] == cost[1]);
    }
}

static void
nonsense_is_refused(void **state)
{
    static const struct rc_shape s = {4, 4, 1e-6, 1e-6};
    static const double h[16] = {0};
    const struct rc_problem problem = {.pair.estar = base, .tilt_free = true},
                            plain = {.pair.estar = base};
    struct rc_err err = {""};
    struct rc_model *m = rc_elastic_new(&s, h, &plain, NULL, &err);

    (void)state;
    for (const double *c = (const double[]){-1e-15, NAN, INFINITY, 0}; *c != 0; c++)
        assert_int_equal(rc_model_set_compliance(m, *c, NULL, 0, &err), RC_FAIL);
    for (const double *bad = (const double[]){-1, NAN, INFINITY, 0}; *bad != 0; bad++) {
        const double part[16] = {1, 0, 2, *bad};
        assert_int_equal(rc_model_set_compliance(m, 0, NULL, *bad, &err), RC_FAIL);
        assert_int_equal(rc_model_set_compliance(m, 1e-15, part, 0, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "node 3"));
    }
    assert_int_equal(rc_model_set_compliance(m, 1e-15, h, 1e-9, &err), RC_FAIL);
    rc_model_free(m);
    m = rc_elastic_new(&s, h, &problem, NULL, &err);
    assert_int_equal(rc_model_set_compliance(m, 1e-15, NULL, 0, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "tilt"));
    rc_model_free(m);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(estimates_are_not_below),
        cmocka_unit_test(a_thin_layer_is_the_same),
        cmocka_unit_test(figures_are_those_of_the_bodies),
        cmocka_unit_test(none_is_the_contact_without),
        cmocka_unit_test(nonsense_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
