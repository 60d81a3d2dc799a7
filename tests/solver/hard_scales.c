/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact is solved to 1e-8 for all units, shapes of cells and shapes of maps; results scale with the
 * units. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hard_case.h"

static double
crest(struct rc_shape s, size_t k, double a, uint64_t *seed)
{
    double x = node_x(s, k) / (s.dx * (double)s.nx), y = node_y(s, k) / (s.dy * (double)s.ny);

    return -(x * x + y * y) * a + hard_noise(s, k, 0, seed);
}

#define MAP                                                                                        \
    {                                                                                              \
        37, 31, 1e-6, 1.2e-6                                                                       \
    }

/* With a mean pressure in proportion to the heights the contact is the same; otherwise it ranges from one
 * node to all nodes. */
static const struct hard_case units[] = {
    {"heights x 1e-12", MAP, BOTH, hard_noise, 0, 1e-19, 3e-14, 0, 0, NULL, 0},
    {"heights x 1e+12", MAP, BOTH, hard_noise, 0, 1e+5, 3e+10, 0, 0, NULL, 0},
    {"E* = 1 Pa", MAP, BOTH, hard_noise, 0, 1e-7, 1e-2, 0, 1, NULL, 0},
    {"E* = 1e15 Pa", MAP, BOTH, hard_noise, 0, 1e-7, 1e-2, 0, 1e15, NULL, 0},
    {"E* = 1 Pa, heights x 1e-12", MAP, BOTH, hard_noise, 0, 1e-19, 1e-14, 0, 1, NULL, 0},
    {"E* = 1e15 Pa, heights x 1e12", MAP, BOTH, hard_noise, 0, 1e5, 1e10, 0, 1e15, NULL, 0},
    {"E* = 1e15 Pa, hard", MAP, BOTH, hard_noise, 0, 1e-7, 1e-2, 2, 1e15, NULL, 0},
    {"heights x 1e-6, same load", MAP, BOTH, hard_noise, 0, 1e-13, 1e-2, 0, 0, NULL, 2e-14},
    {"heights x 1e-12, same load", MAP, BOTH, hard_noise, 0, 1e-19, 1e-2, 0, 0, NULL, 1e-14},
    {"heights x 1e+6, same load", MAP, BOTH, hard_noise, 0, 1e-1, 1e-2, 0, 0, NULL, 0},
    {"heights x 1e+12, same load", MAP, BOTH, hard_noise, 0, 1e+5, 1e-2, 0, 0, NULL, 0},
    {"nodes of 1 nm", {37, 31, 1e-9, 1.2e-9}, BOTH, hard_noise, 0, 1e-10, 1e-2, 0, 0, NULL, 0},
    {"nodes of 1 km", {37, 31, 1e3, 1.2e3}, BOTH, hard_noise, 0, 1e2, 1e-2, 0, 0, NULL, 0},
};

static void
units_of_all_sizes(void **state)
{
    (void)state;
    HARD_RUN(units);
}

/* The same contact in other units is the same contact. */
static void
numbers_follow(void **state)
{
    static const double scales[][2] = {{1, 1},     {1e-12, 1}, {1e12, 1},
                                       {1, 1e-11}, {1, 1e4},   {1e-12, 1e4}};
    double *first[2] = {NULL, NULL};

    (void)state;
    for (size_t k = 0; k < sizeof scales / sizeof *scales; k++)
        for (int b = 0; b < 2; b++) {
            struct hard_case c = {"",
                                  MAP,
                                  BOTH,
                                  crest,
                                  3,
                                  1e-7 * scales[k][0],
                                  1e-2 * scales[k][0],
                                  5,
                                  1e11 * scales[k][1],
                                  NULL,
                                  0};
            struct rc_problem problem = hard_problem(&c, b == 0 ? RC_FREE : RC_PERIODIC);
            double *h = hard_heights(&c), apart = 0, size = 0;
            struct solved s = solve(c.shape, h, problem);
            size_t n = c.shape.nx * c.shape.ny;
            assert_int_equal(s.status, RC_OK);
            if (first[b] == NULL) {
                first[b] = malloc(n * sizeof *first[b]);
                memcpy(first[b], s.p, n * sizeof *first[b]);
            }
            for (size_t i = 0; i < n; i++) {
                apart += fabs(s.p[i] / (scales[k][0] * scales[k][1]) - first[b][i]);
                size += first[b][i];
            }
            print_message("x %g, E* x %g: %.1e apart, %zu plastic\n", scales[k][0], scales[k][1],
                          apart / size, s.c.plastic_nodes);
            assert_true(apart <= 2 * hard_tol * size); /* each within its tolerance */
            assert_true(s.c.plastic_nodes > 0);
            solved_free(&s);
            free(h);
        }
    free(first[0]);
    free(first[1]);
}

static const struct hard_case grids[] = {
    {"cells 1:100", {40, 40, 1e-6, 1e-4}, BOTH, hard_noise, 0, 1e-6, 1e-2, 0, 0, NULL, 0},
    {"cells 100:1", {40, 40, 1e-4, 1e-6}, BOTH, hard_noise, 0, 1e-6, 1e-2, 0, 0, NULL, 0},
    {"cells 1:100, body", {64, 64, 1e-6, 1e-4}, BOTH, crest, 9, 1e-6, 3e-2, 0, 0, NULL, 0},
    {"cells 1:100, hard", {64, 64, 1e-6, 1e-4}, BOTH, crest, 9, 1e-6, 3e-2, 3, 0, NULL, 0},
    {"3 x 1000", {3, 1000, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-6, 1e-2, 0, 0, NULL, 0},
    {"1000 x 3", {1000, 3, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-6, 1e-2, 0, 0, NULL, 0},
    {"3 x 1000, hard", {3, 1000, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-6, 1e-2, 1.5, 0, NULL, 0},
    {"3 x 1000, body", {3, 1000, 1e-6, 1e-6}, BOTH, crest, 100, 1e-6, 1e-2, 0, 0, NULL, 0},
    {"1 x N", {1, 500, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-6, 1e-2, 0, 0, NULL, 0},
    {"N x 1", {500, 1, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-6, 1e-2, 0, 0, NULL, 0},
    {"N x 1, hard", {500, 1, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-6, 1e-2, 1.2, 0, NULL, 0},
    {"N x 1, narrow cells", {500, 1, 1e-6, 1e-4}, BOTH, hard_noise, 0, 1e-6, 1e-2, 0, 0, NULL, 0},
    {"N x 1, wide cells", {500, 1, 1e-4, 1e-6}, BOTH, hard_noise, 0, 1e-6, 1e-2, 0, 0, NULL, 0},
    {"1 x 1", {1, 1, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-6, 1e-2, 0, 0, NULL, 0},
    {"1 x 2", {1, 2, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-8, 1e-2, 0, 0, NULL, 0},
    {"2 x 2", {2, 2, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-8, 1e-2, 0, 0, NULL, 0},
    {"2 x 2, hard", {2, 2, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-8, 1e-2, 1.3, 0, NULL, 0},
    {"3 x 5", {3, 5, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-7, 1e-2, 0, 0, NULL, 0},
    {"3 x 5, hard", {3, 5, 1e-6, 1e-6}, BOTH, hard_noise, 0, 1e-7, 1e-2, 1.3, 0, NULL, 0},
};

static void
strips_and_needles(void **state)
{
    (void)state;
    HARD_RUN(grids);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(units_of_all_sizes),
        cmocka_unit_test(numbers_follow),
        cmocka_unit_test(strips_and_needles),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
