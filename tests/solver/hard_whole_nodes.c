/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The load equals the hardness times a whole number of nodes. If this number of nodes yields and no other
 * node carries pressure, they are exactly at the hardness and are counted. The solution is recognised as
 * such. All other cases agree with a dense quadratic program. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "dense.h"

enum {
    PROBLEMS = 400
};
static const double estar = 1;

static double
uniform(uint64_t *seed)
{
    return random_number(seed) + 0.5;
}

/* Some of these maps have many equal heights. */
static void
make_heights(const struct rc_shape *s, uint64_t *seed, double *h)
{
    struct rc_selfaffine rough = {.hurst = 0.8, .rms_height = 1, .seed = *seed};
    bool equal = uniform(seed) < 0.3;

    assert_int_equal(rc_synth_selfaffine(s, &rough, h, NULL), RC_OK);
    for (size_t k = 0; k < s->nx * s->ny && equal; k++)
        h[k] = round(4 * h[k]) / 4;
}

/* Every loaded node is at the hardness, and its gap is at most that of any unloaded node. */
static void
saturated_is_right(const struct dense *d, const double *h, double hardness, const struct solved *s)
{
    double under = -INFINITY, beside = INFINITY, size = 0;
    size_t full = 0;

    for (size_t k = 0; k < d->n; k++) {
        double v = dense_displacement(d, s->p, k) - h[k];
        assert_true(s->p[k] == 0 || s->p[k] == hardness);
        full += s->p[k] > 0;
        under = s->p[k] > 0 ? fmax(under, v) : under;
        beside = s->p[k] > 0 ? beside : fmin(beside, v);
        size = fmax(size, fabs(v));
    }
    assert_int_equal(full, s->c.plastic_nodes);
    assert_int_equal(full, s->c.contact_nodes);
    assert_true(under <= beside + 1e-9 * size);
}

static void
all_of_them_yield(void **state)
{
    static struct dense d;
    static double most[DENSE_NODES], p[DENSE_NODES];
    size_t saturated = 0, judged = 0;
    double worst = 0, least = INFINITY, high = 0;

    (void)state;
    for (int q = 0; q < PROBLEMS; q++) {
        uint64_t seed = 1000 + (uint64_t)q;
        struct rc_shape s = {(size_t)(4 + 9 * uniform(&seed)), (size_t)(4 + 9 * uniform(&seed)), 1,
                             1};
        size_t n = s.nx * s.ny, nodes = 1 + (size_t)(uniform(&seed) * (double)(n - 2));
        struct rc_problem problem = {.boundary = uniform(&seed) < 0.5 ? RC_PERIODIC : RC_FREE,
                                     .pair.estar = estar,
                                     .hardness = pow(10, -6 + 6 * uniform(&seed)),
                                     .tol = pow(10, -2 - 6 * uniform(&seed)),
                                     .threads = 1};
        double *h = malloc(n * sizeof *h), shift, error;
        struct solved a;
        bool elastic = false;

        problem.load = (double)nodes * problem.hardness;
        make_heights(&s, &seed, h);
        dense_fill(&d, &s, problem.boundary, estar);
        a = solve(s, h, problem);
        assert_int_equal(a.status, RC_OK);
        assert_true(a.c.converged);
        for (size_t k = 0; k < n; k++)
            elastic |= a.p[k] > 0 && a.p[k] < problem.hardness;
        if (!elastic) {
            saturated_is_right(&d, h, problem.hardness, &a);
            saturated++;
        } else {
            for (size_t k = 0; k < n; k++)
                most[k] = problem.hardness;
            memcpy(p, a.p, n * sizeof *p); /* a start */
            d.value[0] = problem.load;
            dense_solve(&d, h, most, p, &shift);
            error = distance(n, a.p, p);
            worst = fmax(worst, error / problem.tol);
            assert_true(error <= problem.tol);
            if (a.c.pressure_error > 1e-9 && a.c.pressure_error < 1e-2) {
                judged++;
                least = fmin(least, a.c.pressure_error / error);
                high = fmax(high, a.c.pressure_error / error);
            }
        }
        solved_free(&a);
        free(h);
    }
    print_message(
        "%d problems, %zu saturated; the others to %.2f of the tolerance, estimates of %zu "
        "%.3f to %.2f of the error\n",
        PROBLEMS, saturated, worst, judged, least, high);
    assert_true(saturated > PROBLEMS / 4 && judged > PROBLEMS / 8);
    assert_true(least >= 1 && high < 3);
}

/* Heights far above the displacements, and a hardness a tenth above the mean pressure: a few nodes are
 * elastic. A wrong one among them causes most of the error. The reference is the other method. */
static void
few_are_elastic(void **state)
{
    const struct rc_shape s = {40, 36, 1, 1};
    size_t n = s.nx * s.ny, judged = 0;
    double *h = malloc(n * sizeof *h), least = INFINITY, high = 0;

    (void)state;
    for (uint64_t seed = 1; seed <= 1000; seed++) {
        struct rc_problem problem = {.boundary = seed % 2 ? RC_PERIODIC : RC_FREE,
                                     .pair.estar = estar,
                                     .hardness = 0.011,
                                     .load = 0.01 * (double)n,
                                     .tol = seed % 4 < 2 ? 1e-2 : 1e-3,
                                     .threads = 1};
        struct rc_selfaffine rough = {.hurst = 0.8, .rms_height = 1, .seed = seed};
        struct solved a, exact;
        double error;

        assert_int_equal(rc_synth_selfaffine(&s, &rough, h, NULL), RC_OK);
        a = solve(s, h, problem);
        problem.tol = 1e-12;
        problem.method = strcmp(contact_method, "pcg") == 0 ? "pk99" : "pcg";
        exact = solve(s, h, problem);
        assert_int_equal(a.status, RC_OK);
        assert_int_equal(exact.status, RC_OK);
        error = distance(n, a.p, exact.p);
        if (error > 1e-9) {
            judged++;
            least = fmin(least, a.c.pressure_error / error);
            high = fmax(high, a.c.pressure_error / error);
        }
        solved_free(&a);
        solved_free(&exact);
    }
    print_message("few elastic: %zu estimates of %.3f to %.2f of the error\n", judged, least, high);
    assert_true(judged > 50 && least >= 1);
    free(h);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_of_them_yield),
        cmocka_unit_test(few_are_elastic),
    };
    int failed = 0;

    RUN_FOR_EACH_METHOD(tests, failed);
    return failed;
}
