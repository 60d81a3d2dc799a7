/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flow through the gaps of rough contacts. The order of convergence is checked, with the true flow between
 * those of the two rules in at least 18 of 20 cases. So is the contact fraction at which the last path
 * closes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/leak/rough_case.h"

static void
converges_from_both_sides(void **state)
{
    struct rough_grid grid = rough_converges(864, 54, 101, 10);

    (void)state;
    assert_true(grid.bracketed >= 18 && grid.covered >= 18);
    assert_true(grid.order[0] > 1.7 && grid.order[1] > 1.7);
    assert_true(grid.between < grid.coarse[0] && grid.between < grid.coarse[1]);
}

/* 0.42 (Dapp, Luecke, Persson and Mueser, Phys. Rev. Lett. 108, 2012, 244301). */
static void
closes(void **state)
{
    enum {
        N = 512,
        SEEDS = 6,
        HALVINGS = 6
    };
    const struct rc_shape s = {N, N, 1e-6, 1e-6};
    double mean = 0;

    (void)state;
    for (uint64_t seed = 1; seed <= SEEDS; seed++)
        for (int way = 0; way < 2; way++) {
            char direction = way == 0 ? 'x' : 'y';
            double *h = rough(s, 8, seed), low = 0.15, high = 0.35, contact = NAN;
            struct solved c;
            for (int halving = 0; halving < HALVINGS; halving++) {
                double middle = (low + high) / 2;
                c = rough_press(s, h, middle);
                contact = rough_contact(s, &c);
                if (rough_open(s, &c, direction))
                    low = middle;
                else
                    high = middle;
                solved_free(&c);
            }
            assert_true(low > 0.15 && high < 0.35);
            print_message("seed %d, %c: closed at contact %.3f\n", (int)seed, direction, contact);
            mean += contact / (2 * SEEDS);
            c = rough_press(s, h, 1.1 * high);
            rough_is_shut(s, &c, direction);
            solved_free(&c);
            free(h);
        }
    print_message("threshold: %.3f\n", mean);
    assert_true(fabs(mean - 0.42) < 0.03);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(converges_from_both_sides),
        cmocka_unit_test(closes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
