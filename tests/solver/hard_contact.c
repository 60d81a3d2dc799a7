/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The solver stays stable in hard cases: one node, saturation, infeasible loads, sharp edges, strips, twelve
 * decades of scale. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

static const double estar = 114e9;

static void
check(struct rc_shape shape, const double *h, struct rc_problem problem, const char *what)
{
    struct solved s = solve(shape, h, problem);

    if (s.status != RC_OK || !(s.c.pressure_error <= problem.tol))
        print_error("%s: status %d, %s, error %g, KKT %g after %zu iterations\n", what, s.status,
                    s.status == RC_FAIL ? s.err.text : "", s.c.pressure_error, s.c.kkt_residual,
                    s.c.iterations);
    assert_int_equal(s.status, RC_OK);
    assert_true(s.c.pressure_error <= problem.tol);
    assert_true(fabs(s.c.load / problem.load - 1) < summed);
    for (size_t k = 0; k < shape.nx * shape.ny; k++)
        assert_true(s.p[k] >= 0 && (problem.hardness == 0 || s.p[k] <= problem.hardness));
    solved_free(&s);
}

static void
one_node_carries_all(void **state)
{
    struct rc_shape shape = {33, 47, 1.1e-6, 1e-6};
    struct rc_problem problem = {.pair.estar = estar, .load = 1e-9, .tol = 1e-8};
    double h[33 * 47] = {0};
    struct solved s;

    (void)state;
    h[777] = 1e-6;
    s = solve(shape, h, problem);
    assert_int_equal(s.status, RC_OK);
    assert_int_equal(s.c.contact_nodes, 1);
    assert_true(fabs(s.p[777] * shape.dx * shape.dy / problem.load - 1) < rounding);
    /* it sinks by Love's displacement of its own cell */
    assert_true(fabs(s.c.approach /
                         (s.p[777] * love_displacement(0, 0, shape.dx / 2, shape.dy / 2, estar)) -
                     1) < summed);
    solved_free(&s);
}

/* The four highest nodes of a ball each carry a quarter of a small load. */
static void
hardly_any_load(void **state)
{
    const struct rc_shape shape = {64, 64, 5e-6, 5e-6};
    double *h = malloc(64 * 64 * sizeof *h);

    (void)state;
    rc_synth_sphere(&shape, 7.5e-3, h);
    for (double load = 1e-6; load > 1e-41; load *= 1e-5) {
        struct rc_problem problem = {.pair.estar = estar,
                                     .load = load,
                                     .tol = 1e-6,
                                     .method = "pcg"}; /* the solver starts on coarser grids */
        struct solved s = solve(shape, h, problem);

        assert_int_equal(s.status, RC_OK);
        assert_int_equal(s.c.contact_nodes, 4);
        for (size_t k = 0; k < 4; k++)
            assert_true(fabs(s.p[(31 + k / 2) * 64 + 31 + k % 2] * 4 * shape.dx * shape.dy / load -
                             1) < 2e-6);
        solved_free(&s);
    }
    free(h);
}

static void
every_node_yields(void **state)
{
    struct rc_shape shape = {20, 13, 1e-6, 1.3e-6};
    size_t n = shape.nx * shape.ny;
    double *h = calloc(n, sizeof *h), hardness = 3.1e9, area = shape.dx * shape.dy * (double)n;
    struct rc_problem problem = {.pair.estar = estar, .hardness = hardness, .tol = 1e-8};
    uint64_t seed = 7;
    struct solved s;

    (void)state;
    for (size_t k = 0; k < n; k++)
        h[k] = 1e-7 * random_number(&seed);
    problem.load = hardness * area;
    s = solve(shape, h, problem);
    assert_int_equal(s.status, RC_OK);
    assert_int_equal(s.c.plastic_nodes, n);
    assert_true(isnan(s.c.approach));
    solved_free(&s);
    for (double part = 0.9; part < 1; part = 1 - (1 - part) / 10) {
        problem.load = part * hardness * area;
        check(shape, h, problem, "close to saturation");
        if (part > 0.9999999)
            break;
    }
    problem.load = 1.000001 * hardness * area;
    s = solve(shape, h, problem);
    assert_int_equal(s.status, RC_FAIL);
    assert_non_null(strstr(s.err.text, "hardness times area"));
    solved_free(&s);
    free(h);
}

enum shape_name {
    FLAT,
    STEP,
    GROOVES,
    NOISE,
    CAUCHY,
    SPIKE,
    SHAPES
};

static double
height(enum shape_name name, size_t i, size_t j, uint64_t *seed)
{
    switch (name) {
    case FLAT:
        return 1;
    case STEP:
        return i < 11 ? 0 : -1;
    case GROOVES:
        return i % 5 < 2 ? -1 : 0;
    case NOISE:
        return random_number(seed);
    case CAUCHY:
        return tan(exact_pi * random_number(seed));
    default:
        return i == 3 && j == 4 ? 1 : 0;
    }
}

static void
ugly_surfaces(void **state)
{
    static const double hardnesses[] = {INFINITY, 1.7, 1.05}; /* times the mean pressure */
    struct rc_shape shape = {41, 29, 1e-6, 1.2e-6};
    size_t n = shape.nx * shape.ny;
    double *h = malloc(n * sizeof *h), area = shape.dx * shape.dy * (double)n;
    uint64_t seed = 3;
    char what[96];

    (void)state;
    for (int name = 0; name < SHAPES; name++)
        for (double mean = 1e5; mean < 1e10; mean *= 100)
            for (int k = 0; k < 6; k++) {
                struct rc_problem problem = {.boundary = k < 3 ? RC_FREE : RC_PERIODIC,
                                             .pair.estar = estar,
                                             .load = mean * area,
                                             .hardness = hardnesses[k % 3] * mean,
                                             .tol = 1e-8,
                                             .max_iterations = 3000};
                for (size_t i = 0; i < n; i++)
                    h[i] = 1e-7 * height((enum shape_name)name, i % shape.nx, i / shape.nx, &seed);
                snprintf(what, sizeof what, "surface %d, mean %g, H %g, boundary %d", name, mean,
                         hardnesses[k % 3], k / 3);
                check(shape, h, problem, what);
            }
    free(h);
}

/* Heights and moduli over many decades: the results scale with them. */
static void
scales(void **state)
{
    static const double heights[] = {1e-12, 1, 1e12}, moduli[] = {1, 1e15};
    struct rc_shape shape = {37, 31, 1e-6, 1.2e-6};
    size_t n = shape.nx * shape.ny;
    double *h = malloc(n * sizeof *h), fraction = 0;

    (void)state;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 2; b++) {
            uint64_t seed = 11;
            struct rc_problem problem = {.pair.estar = moduli[b], .tol = 1e-8};
            struct solved s;
            for (size_t k = 0; k < n; k++)
                h[k] = 1e-7 * heights[a] * random_number(&seed);
            problem.load = 1e-13 * moduli[b] * heights[a];
            s = solve(shape, h, problem);
            assert_int_equal(s.status, RC_OK);
            if (a == 0 && b == 0)
                fraction = s.c.contact_fraction;
            assert_true(s.c.contact_fraction > 0.01 &&
                        s.c.contact_fraction < 0.9); /* some, not all */
            assert_true(s.c.contact_fraction == fraction);
            solved_free(&s);
        }
    free(h);
}

static void
strips_and_needles(void **state)
{
    static const struct rc_shape shapes[] = {{1, 64, 1e-6, 1e-6},  {64, 1, 1e-6, 1e-6},
                                             {3, 300, 1e-6, 1e-6}, {30, 30, 1e-6, 1e-4},
                                             {1, 1, 1e-6, 1e-6},   {2, 1, 1e-6, 1e-6}};
    uint64_t seed = 5;

    (void)state;
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
        size_t n = shapes[k].nx * shapes[k].ny;
        double *h = malloc(n * sizeof *h);
        double area = shapes[k].dx * shapes[k].dy * (double)n;
        struct rc_problem problem = {
            .pair.estar = estar, .load = 3e9 * area, .tol = 1e-8, .max_iterations = 3000};
        for (size_t i = 0; i < n; i++)
            h[i] = 1e-7 * random_number(&seed);
        check(shapes[k], h, problem, "elastic strip");
        problem.hardness = 4e9;
        check(shapes[k], h, problem, "plastic strip");
        free(h);
    }
}

/* No method can reach an error below rounding: it reports this and keeps its result. */
static void
an_accuracy_out_of_reach(void **state)
{
    struct rc_shape shape = {32, 32, 1e-6, 1e-6};
    double h[32 * 32];
    uint64_t seed = 2;
    struct rc_problem problem = {.pair.estar = estar, .load = 0.1, .tol = 1e-18};
    struct solved s;

    (void)state;
    for (size_t k = 0; k < 32 * 32; k++)
        h[k] = 5e-8 * random_number(&seed);
    s = solve(shape, h, problem);
    assert_int_equal(s.status, RC_SHORT);
    assert_false(s.c.converged);
    assert_true(s.c.pressure_error < rounding);
    assert_true(fabs(s.c.load / problem.load - 1) < summed);
    solved_free(&s);
}

/* An invalid field in an otherwise valid problem, and the message that names it. */
#define FIELD(name) #name, offsetof(struct rc_problem, name)
/* clang-format off */
static const struct {
    const char *field;
    size_t at;
    double value;
    const char *words, *rule;
} numbers[] = {
    {FIELD(pair.estar), 0, "Young's moduli of both bodies are 0", "give E*, or E and nu"},
    {FIELD(pair.estar), -1, "E* = -1 Pa", "positive"},
    {FIELD(pair.estar), NAN, "E* = nan Pa", "positive"},
    {FIELD(pair.estar), INFINITY, "E* = inf Pa", "finite"},
    {FIELD(load), 0, "load 0 N", "positive"},
    {FIELD(load), -1, "load -1 N", "positive"},
    {FIELD(load), NAN, "load nan N", "positive"},
    {FIELD(load), INFINITY, "load inf N", "finite"},
    {FIELD(hardness), -1, "hardness -1 Pa", "positive"},
    {FIELD(hardness), NAN, "hardness nan Pa", "positive"},
    {FIELD(hardness), 1, "load 1e-06 N is above hardness times area, 1 Pa x 1.6e-11 m2", "every node yields"},
    {FIELD(tol), -1, "tolerance -1", "positive"},
    {FIELD(tol), NAN, "tolerance nan", "positive"},
    {FIELD(approach), INFINITY, "approach inf m", "finite"},
};
static const struct {
    const char *field;
    size_t at;
    const char *value, *words;
} names[] = {
    {FIELD(method), "guess", "there is no method 'guess': take one of auto, pcg, pk99"},
    {FIELD(engine), "guess", "there is no engine 'guess': take one of auto, fft, fft64, mlms, direct"},
};
static const struct {
    struct rc_shape shape;
    const char *words;
} shapes[] = {
    {{4, 4, 0, 1e-6}, "dx=0 dy=1e-06 m"},
    {{4, 4, 1e-6, -1}, "dx=1e-06 dy=-1 m"},
    {{4, 4, NAN, 1e-6}, "dx=nan dy=1e-06 m"},
    {{4, 4, 1e-6, INFINITY}, "dx=1e-06 dy=inf m"},
    {{0, 4, 1e-6, 1e-6}, "0 x 4 nodes"},
    {{4, 0, 1e-6, 1e-6}, "4 x 0 nodes"},
    {{SIZE_MAX / 2, 4, 1e-6, 1e-6}, "x 4 is more than this machine can address"},
};
/* clang-format on */

static size_t
let_pass(struct rc_shape shape, const double *h, const struct rc_problem *problem,
         const char *field, const char *words, const char *rule)
{
    struct rc_err err = {""}, of_plan = {""};
    struct rc_solver *solver = rc_solver_new(&shape, h, problem, &err);
    struct rc_expected expected;
    bool refused =
        solver == NULL && strstr(err.text, words) != NULL && strstr(err.text, rule) != NULL;

    rc_solver_free(solver);
    if (!refused)
        print_error("%s: '%s' and '%s' expected: %s\n", field, words, rule,
                    solver == NULL ? err.text : "no refusal");
    if (strcmp(field, "h") == 0) /* a plan does not check this field */
        return !refused;
    if (rc_solver_expect(&shape, problem, &expected, &of_plan) != RC_FAIL ||
        strcmp(of_plan.text, err.text) != 0) {
        print_error("%s: the plan says otherwise: '%s'\n", field, of_plan.text);
        return 1;
    }
    return !refused;
}

static void
impossible_requests(void **state)
{
    const struct rc_shape shape = {4, 4, 1e-6, 1e-6};
    const struct rc_problem good = {.pair.estar = estar, .load = 1e-6, .method = contact_method};
    double h[16] = {0};
    struct rc_problem bad;
    struct rc_err err;
    struct rc_solver *solver = rc_solver_new(&shape, h, &good, &err);
    size_t passed = 0;

    (void)state;
    assert_non_null(solver);
    rc_solver_free(solver);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        bad = good;
        memcpy((char *)&bad + numbers[k].at, &numbers[k].value, sizeof numbers[k].value);
        passed += let_pass(shape, h, &bad, numbers[k].field, numbers[k].words, numbers[k].rule);
    }
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        bad = good;
        memcpy((char *)&bad + names[k].at, &names[k].value, sizeof names[k].value);
        passed += let_pass(shape, h, &bad, names[k].field, names[k].words, "");
    }
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++)
        passed += let_pass(shapes[k].shape, h, &good, "shape", shapes[k].words, "");
    h[3] = NAN;
    passed += let_pass(shape, h, &good, "h", "height 3", "finite");
    h[3] = 0;
    h[15] = -INFINITY;
    passed += let_pass(shape, h, &good, "h", "height 15", "finite");
    assert_int_equal(passed, 0);
}

int
main(void)
{
    int failed = 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_node_carries_all),
        cmocka_unit_test(hardly_any_load),
        cmocka_unit_test(every_node_yields),
        cmocka_unit_test(ugly_surfaces),
        cmocka_unit_test(scales),
        cmocka_unit_test(strips_and_needles),
        cmocka_unit_test(impossible_requests),
        cmocka_unit_test(an_accuracy_out_of_reach),
    };

    RUN_FOR_EACH_METHOD(tests, failed)
    return failed;
}
