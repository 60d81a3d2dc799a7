/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Soft coats, from a thirtieth of a cell to five cells thick, compressible or not. The pressure equals that
 * of a dense quadratic program with the influence coefficients of the engines. The estimated error is not
 * below the error. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/solver/dense.h"

enum {
    PROBLEMS = 400
};
static const double cell = 1e-6, base = 1e9;

static double
uniform(uint64_t *seed)
{
    return random_number(seed) + 0.5;
}

/* The influence of the cell in the corner on all others. */
static void
fill(struct dense *d, const struct rc_shape *s, const struct rc_problem *problem)
{
    struct rc_conv_options options = {.boundary = problem->boundary};
    struct rc_conv *conv = rc_conv_new(s, &problem->pair, &options, NULL);
    double *p = calloc(s->nx * s->ny, sizeof *p), *u = calloc(s->nx * s->ny, sizeof *u);

    assert_non_null(conv);
    p[0] = 1;
    rc_conv_apply(conv, p, u);
    if (!rc_has_mean(problem->boundary)) /* their mean is 0: any other mean makes K definite */
        for (size_t k = 0; k < s->nx * s->ny; k++)
            u[k] += p[0] * cell / base;
    dense_of(d, s, u);
    rc_conv_free(conv);
    free(p);
    free(u);
}

static struct rc_problem
problem_of(uint64_t *seed, const struct rc_shape *s, struct rc_layer *coat)
{
    static const double thick[] = {0.03, 0.1, 0.1, 0.3, 1, 5}, nu[] = {0.5, 0.5, 0.48, 0.4, 0.2};
    struct rc_problem problem = {.boundary = uniform(seed) < 0.7 ? RC_FREE : RC_PERIODIC,
                                 .tol = pow(10, -2 - 2 * uniform(seed)),
                                 .threads = 1};

    *coat = (struct rc_layer){thick[(int)(6 * uniform(seed))] * (0.8 + 0.4 * uniform(seed)) * cell,
                              base * pow(10, -3 + 3 * uniform(seed)), nu[(int)(5 * uniform(seed))]};
    problem.pair.one = (struct rc_body){base, 0.5, 1, coat};
    problem.load = pow(10, 6 + 2 * uniform(seed)) * (double)(s->nx * s->ny) * cell * cell;
    return problem;
}

static void
estimates_are_not_below(void **state)
{
    static struct dense d;
    static double most[DENSE_NODES], p[DENSE_NODES];
    double least = INFINITY, high = 0;
    size_t judged = 0;

    (void)state;
    for (size_t k = 0; k < DENSE_NODES; k++)
        most[k] = INFINITY;
    for (int q = 0; q < PROBLEMS; q++) {
        uint64_t seed = 77 + (uint64_t)q;
        struct rc_shape s = {(size_t)(12 + 8 * uniform(&seed)), (size_t)(12 + 8 * uniform(&seed)),
                             cell, cell};
        struct rc_selfaffine rough = {.hurst = 0.8, .rms_height = 1e-7, .seed = seed};
        struct rc_layer coat;
        struct rc_problem problem = problem_of(&seed, &s, &coat);
        size_t n = s.nx * s.ny;
        double *h = malloc(n * sizeof *h), shift, error;
        struct solved a;

        assert_int_equal(rc_synth_selfaffine(&s, &rough, h, NULL), RC_OK);
        a = solve(s, h, problem);
        assert_int_equal(a.status, RC_OK);
        fill(&d, &s, &problem);
        d.value[0] = problem.load / (cell * cell);
        memcpy(p, a.p, n * sizeof *p); /* a start */
        dense_solve(&d, h, most, p, &shift);
        error = distance(n, a.p, p);
        if (error > 2e-7) { /* corrections are in single precision */
            double ratio = a.c.pressure_error / error;
            judged++;
            least = fmin(least, ratio);
            high = fmax(high, ratio);
            if (ratio < 1 || ratio > 3)
                print_message("%s, %.3g cells, E %.2g of the base, nu %g, contact %.2f: error "
                              "%.2e, estimate %.3f of it\n",
                              rc_boundary_word(problem.boundary), coat.thickness / cell,
                              coat.e / base, coat.nu, a.c.contact_fraction, error, ratio);
        }
        solved_free(&a);
        free(h);
    }
    print_message("%d problems, %zu errors above 2e-7: estimates %.3f to %.2f of them\n", PROBLEMS,
                  judged, least, high);
    assert_true(judged > PROBLEMS / 2);
    assert_true(least >= 1 && high <= 3);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(estimates_are_not_below),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
