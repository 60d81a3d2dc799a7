/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random contacts: sizes from one node up, thin maps, cells of any aspect ratio, and heights from white noise
 * to steps. The loads cover three decades, and a hardness is one that nearly every node reaches. Two
 * independent methods, pcg and pk99, give the same pressure, and pcg takes few steps. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    PROBLEMS = 200,
    STEPS = 40 /* the largest of 600 cases was 17 */
};

static double
uniform(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

static size_t
between(uint64_t *seed, size_t least, size_t most)
{
    return least + (size_t)(uniform(seed) * (double)(most + 1 - least));
}

static struct rc_shape
any_shape(uint64_t *seed)
{
    static const double aspects[] = {1, 1, 1, 0.2, 7};
    bool thin = uniform(seed) < 0.1;
    size_t nx = between(seed, thin ? 200 : 1, thin ? 300 : 60);

    return (struct rc_shape){nx, between(seed, 1, 60), 1e-6, 1e-6 * aspects[between(seed, 0, 4)]};
}

static void
any_heights(struct rc_shape s, uint64_t *seed, double *h)
{
    size_t kind = between(seed, 0, 4);

    for (size_t k = 0; k < s.nx * s.ny; k++) {
        double u = uniform(seed) - 0.5, x = (double)(k % s.nx) / (double)s.nx;
        switch (kind) {
        case 0: /* white */
            h[k] = 1e-7 * u;
            break;
        case 1: /* mostly flat */
            h[k] = 1e-6 * u * u * u;
            break;
        case 2: /* a step */
            h[k] = x > 0.5 ? 1e-7 + 1e-9 * u : 1e-9 * u;
            break;
        case 3: /* spikes */
            h[k] = 1e-8 / (fabs(u) + 1e-3);
            break;
        default: /* a parabola */
            h[k] = -1e-8 * x * x * (double)s.nx + 1e-9 * u;
        }
    }
}

static void
two_methods_agree(void **state)
{
    uint64_t seed = 20261122;
    size_t most = 0, yielding = 0;

    (void)state;
    for (int q = 0; q < PROBLEMS; q++) {
        struct rc_shape shape = any_shape(&seed);
        size_t n = shape.nx * shape.ny;
        double *h = calloc(n, sizeof *h), mean = 1e9 * pow(10, -3 * uniform(&seed));
        double bound = mean * (1 + pow(10, 2 * uniform(&seed) - 1.5));
        const size_t axes = between(&seed, 0, 3);
        struct rc_problem problem = {.boundary = rc_boundary_of(axes % 2 == 1, axes / 2 == 1),
                                     .pair.estar = 1e11,
                                     .load = mean * (double)n * shape.dx * shape.dy,
                                     .hardness = uniform(&seed) < 0.3 ? 0 : bound,
                                     .tol = 1e-8,
                                     .threads = 1};
        struct solved a, b;

        any_heights(shape, &seed, h);
        problem.method = "pcg";
        a = solve(shape, h, problem);
        problem.method = "pk99";
        b = solve(shape, h, problem);
        if (a.status != RC_OK || b.status != RC_OK || a.c.iterations > STEPS ||
            distance(n, a.p, b.p) > 3 * problem.tol)
            print_error("problem %d, %zu x %zu: %zu and %zu steps, apart by %g\n", q, shape.nx,
                        shape.ny, a.c.iterations, b.c.iterations, distance(n, a.p, b.p));
        assert_int_equal(a.status, RC_OK);
        assert_int_equal(b.status, RC_OK);
        assert_true(a.c.iterations <= STEPS);
        assert_true(distance(n, a.p, b.p) <= 3 * problem.tol);
        most = a.c.iterations > most ? a.c.iterations : most;
        yielding += a.c.plastic_nodes > 0;
        solved_free(&a);
        solved_free(&b);
        free(h);
    }
    print_message("%d problems, %zu with nodes at the bound: at most %zu steps\n", PROBLEMS,
                  yielding, most);
    assert_true(yielding > PROBLEMS / 4);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_methods_agree),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
