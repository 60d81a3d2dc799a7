/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flow through the gaps of small rough contacts: the errors of the two rules for faces have opposite signs
 * and converge to 0. Little contact leaves paths open, much contact closes all. Larger contacts and the
 * threshold are in tests/long. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "rough_case.h"

/* With waves of 4 and 12 nodes the order of convergence is not yet 2. */
static void
converges_from_both_sides(void **state)
{
    struct rough_grid grid = rough_converges(432, 36, 101, 3);

    (void)state;
    assert_true(grid.bracketed >= 5 && grid.covered >= 5);
    assert_true(grid.order[0] > 1.4 && grid.order[1] > 1.4);
    assert_true(grid.between < grid.coarse[0] && grid.between < grid.coarse[1]);
}

/* At contact fractions of about 0.3 and 0.6; the threshold is 0.42. */
static void
closes(void **state)
{
    const struct rc_shape s = {256, 256, 1e-6, 1e-6};

    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        double *h = rough(s, 8, seed);
        struct solved few = rough_press(s, h, 0.13), many = rough_press(s, h, 0.35);
        print_message("contact %.3f, %.3f\n", rough_contact(s, &few), rough_contact(s, &many));
        assert_true(rough_open(s, &few, 'x') && rough_open(s, &few, 'y'));
        rough_is_shut(s, &many, 'x');
        rough_is_shut(s, &many, 'y');
        solved_free(&few);
        solved_free(&many);
        free(h);
    }
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
