/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The work hardly grows with the length of a profile, or of a strip of a few rows. This holds as a row or a
 * column, periodic or free, uniform or coated. A line has its own extension, and load that a tile cannot
 * carry is shared with nearby tiles. */
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
                                       .rolloff = fmax((double)s.nx, (double)s.ny) * s.dx / 4,
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

/* The bodies: E of a coat is relative to that of its base, its thickness is in nodes; 0: no coat. */
struct kind {
    bool column;
    size_t across; /* nodes */
    struct rc_boundary boundary;
    double coat, thick;
};

/* The number of equivalent convolutions to this error, under this mean pressure. */
static double
work_of(const struct kind *kind, struct rc_shape s, const double *h, double mean, double tol,
        struct rc_contact *c)
{
    const struct rc_layer layer = {kind->thick * s.dx, kind->coat * estar, 0.3};
    struct rc_problem problem = {
        .boundary = kind->boundary, .load = mean * (double)(s.nx * s.ny) * s.dx * s.dy, .tol = tol};
    struct rc_err err;
    struct rc_solver *solver;
    double work;

    if (kind->coat > 0) {
        problem.pair.one = (struct rc_body){estar, 0.3, 1, &layer};
        problem.pair.two = (struct rc_body){INFINITY, 0, 0, NULL};
    } else {
        problem.pair.estar = estar;
    }
    solver = rc_solver_new(&s, h, &problem, &err);
    assert_non_null(solver);
    while (rc_solver_step(solver) == RC_MORE)
        continue;
    rc_solver_result(solver, NULL, NULL, c);
    work = rc_solver_convolutions(solver);
    rc_solver_free(solver);
    return work;
}

/* The mean pressure at which this fraction of the map touches. */
static double
pressure_for(const struct kind *kind, struct rc_shape s, const double *h, double part)
{
    double low = 1e-9 * estar, high = 100 * estar, mean = 0;
    struct rc_contact c = {0};

    for (int half = 0; half < 40; half++) {
        mean = sqrt(low * high);
        (void)work_of(kind, s, h, mean, 1e-2, &c);
        if (fabs(c.contact_fraction / part - 1) < 0.15)
            break;
        *(c.contact_fraction < part ? &low : &high) = mean;
    }
    return mean;
}

/* The work is limited from 1024 nodes on. From there to 16384 nodes (to `most` for a random walk) it grows at
 * most by the factor `growth`. Tests of every commit use one contact fraction, up to 4096 nodes. */
static void
works(const struct kind *kind, size_t most, double most_work, double growth)
{
    const size_t least = 1024, some = thorough(16384, 4096);
    const double parts[] = {0.3, 0.05, 0.8};
    double *h = malloc(kind->across * most * sizeof *h);

    assert_non_null(h);
    for (int walk = 0; walk < (kind->across == 1 ? 2 : 1); walk++)
        for (size_t q = 0; q < thorough(3, 1); q++) {
            double first = 0;
            for (size_t n = least; n <= (walk && q == 0 ? thorough(most, some) : some);
                 n *= n < some ? some / least : 4) {
                const struct rc_shape s = {kind->column ? kind->across : n,
                                           kind->column ? n : kind->across, 1e-6, 1e-6};
                struct rc_contact c = {0};
                double work;

                roughen(s, walk, 7, h);
                work = work_of(kind, s, h, pressure_for(kind, s, h, parts[q]), 1e-4, &c);
                print_message(
                    "%s%s of %zu, coat %g/%g, %s, %zu nodes, contact %.3f: %zu steps, %.1f "
                    "equivalents\n",
                    rc_repeats(kind->boundary) == 0 ? "free " : "", kind->column ? "column" : "row",
                    kind->across, kind->coat, kind->thick, walk ? "walk" : "self-affine", n,
                    c.contact_fraction, c.iterations, work);
                assert_true(c.converged && work <= most_work);
                first = n == least ? work : first;
                assert_true(work <= growth * first);
            }
        }
    free(h);
}

static void
rows(void **state)
{
    (void)state;
    works(&(struct kind){false, 1, RC_PERIODIC, 0, 0}, 65536, 11, 1.3);
    works(&(struct kind){false, 1, RC_FREE, 0, 0}, 65536, 11, 1.3);
}

static void
columns(void **state)
{
    (void)state;
    works(&(struct kind){true, 1, RC_PERIODIC, 0, 0}, 65536, 11, 1.3);
    works(&(struct kind){true, 1, RC_FREE, 0, 0}, 65536, 11, 1.3);
}

static void
coats(void **state)
{
    (void)state;
    for (int periodic = 0; periodic < 2; periodic++) {
        const struct rc_boundary b = periodic ? RC_PERIODIC : RC_FREE;
        works(&(struct kind){false, 1, b, 0.1, 4}, 16384, 14, 1.5);
        works(&(struct kind){false, 1, b, 10, 2}, 16384, 17, 1.5);
        works(&(struct kind){false, 1, b, 100, 2}, 16384, 40, 3);
    }
}

static void
strips(void **state)
{
    (void)state;
    for (int periodic = 0; periodic < 2; periodic++)
        for (size_t across = 2; across <= 16; across *= 8)
            works(&(struct kind){!periodic, across, periodic ? RC_PERIODIC : RC_FREE, 0, 0}, 16384,
                  15, 1.6);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rows), cmocka_unit_test(columns),
                                       cmocka_unit_test(coats), cmocka_unit_test(strips)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
