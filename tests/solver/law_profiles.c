/* The work on the period of a profile hardly grows, whether it lies as a row or as a column: the extension off
 * a line is one of its own, and load that tiles of a step cannot keep stays near. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

static const double estar = 1e9;

/* A random walk whose ends meet, or self-affine roughness cut at 8 nodes. */
static void
roughen(struct rc_shape s, bool walk, uint64_t seed, double *h)
{
    const size_t n = s.nx * s.ny;
    const struct rc_selfaffine what = {.hurst = 0.8,
                                       .rms_slope = 0.1,
                                       .rolloff = (double)n * s.dx / 4,
                                       .short_cut = 8 * s.dx,
                                       .seed = seed};
    double at = 0;

    if (!walk) {
        assert_int_equal(rc_synth_selfaffine(&s, &what, h, NULL), RC_OK);
        return;
    }
    for (size_t k = 0; k < n; k++) {
        h[k] = at;
        for (int q = 0; q < 12; q++) { /* nearly Gaussian */
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            at += s.dx / 100 * ((double)(seed >> 11) / 9007199254740992.0 - 0.5);
        }
    }
    for (size_t k = 0; k < n; k++)
        h[k] -= at * (double)k / (double)n;
}

/* Equivalents of a convolution to this error, under this mean pressure. */
static double
work_of(struct rc_shape s, const double *h, double mean, double tol, struct rc_contact *c)
{
    const struct rc_problem problem = {.boundary = RC_PERIODIC,
                                       .pair.estar = estar,
                                       .load = mean * (double)(s.nx * s.ny) * s.dx * s.dy,
                                       .tol = tol};
    struct rc_err err;
    struct rc_solver *solver = rc_solver_new(&s, h, &problem, &err);
    double work;

    assert_non_null(solver);
    while (rc_solver_step(solver) == RC_MORE)
        continue;
    rc_solver_result(solver, NULL, NULL, c);
    work = rc_solver_convolutions(solver);
    rc_solver_free(solver);
    return work;
}

/* The mean pressure under which this part of the map touches. */
static double
pressure_for(struct rc_shape s, const double *h, double part)
{
    double low = 1e-9 * estar, high = 10 * estar, mean = 0;
    struct rc_contact c = {0};

    for (int half = 0; half < 40; half++) {
        mean = sqrt(low * high);
        (void)work_of(s, h, mean, 1e-2, &c);
        if (fabs(c.contact_fraction / part - 1) < 0.05)
            break;
        *(c.contact_fraction < part ? &low : &high) = mean;
    }
    return mean;
}

static void
work_grows_little(bool column)
{
    const size_t least = 1024, most = 262144;
    const double parts[] = {0.05, 0.3, 0.8};
    double *h = malloc(most * sizeof *h);

    assert_non_null(h);
    for (int walk = 0; walk < 2; walk++)
        for (size_t q = 0; q < 3; q++) {
            double first = 0;
            for (size_t n = least; n <= (walk && q == 1 ? most : most / 16); n *= 16) {
                const struct rc_shape s = {column ? 1 : n, column ? n : 1, 1e-6, 1e-6};
                struct rc_contact c = {0};
                double work;

                roughen(s, walk, 7, h);
                work = work_of(s, h, pressure_for(s, h, parts[q]), 1e-4, &c);
                print_message("%s, %zu nodes, contact %.3f: %zu steps, %.1f equivalents\n",
                              walk ? "walk" : "self-affine", n, c.contact_fraction, c.iterations,
                              work);
                assert_true(c.converged && work <= 11);
                first = n == least ? work : first;
                assert_true(work <= 1.3 * first);
            }
        }
    free(h);
}

static void
rows(void **state)
{
    (void)state;
    work_grows_little(false);
}

static void
columns(void **state)
{
    (void)state;
    work_grows_little(true);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rows), cmocka_unit_test(columns)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
