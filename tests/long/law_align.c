/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Of random pairs of scans at least 95 of 100 are aligned to .02 nodes and .01 degrees, and have their worn
 * volume within its bar. */
#include "tests/surface/scans.h"

enum kind {
    GROOVE,
    HONED,
    HOLED,
    HONED_HOLED
};

static struct scans
make_case(enum kind kind, struct surface *s)
{
    struct scans c;

    if (kind == HONED || kind == HONED_HOLED)
        c = worn_scans(150, 130, s);
    else
        c = random_scans(150, 130);
    if (kind == HOLED || kind == HONED_HOLED)
        add_shares(&c);
    if (kind == GROOVE || kind == HOLED)
        make_surface(s, 1);
    return c;
}

static void
campaign(enum kind kind)
{
    enum {
        CASES = 100
    };
    int shifts = 0, turns = 0, volumes = 0;
    struct surface s;

    srand(91);
    for (int k = 0; k < CASES; k++) {
        const struct scans c = make_case(kind, &s);
        const struct errors e = align_scans(&s, &c);
        shifts += e.shift < 0.02;
        turns += e.turn < 0.01;
        volumes += fabs(e.volume) < e.bar;
        if (!(e.shift < 0.02 && e.turn < 0.01 && fabs(e.volume) < e.bar))
            printf("case %d: shift off by %.3g nodes (bar %.2g), rotation by %.3g degrees, volume "
                   "by %.3g "
                   "of %.3g m3 (bar %.2g), noise %.2g um\n",
                   k, e.shift, e.found.shift_error / c.a.dx, e.turn, e.volume, e.worn, e.bar,
                   1e6 * c.noise);
    }
    printf("of %d: shift below .02 nodes in %d, rotation below .01 degrees in %d, volume within "
           "its bar in "
           "%d\n",
           CASES, shifts, turns, volumes);
    assert_true(shifts >= 0.95 * CASES);
    assert_true(turns >= 0.95 * CASES);
    assert_true(volumes >= 0.95 * CASES);
}

static void
test_groove(void **state)
{
    (void)state;
    campaign(GROOVE);
}

static void
test_honed(void **state)
{
    (void)state;
    campaign(HONED);
}

static void
test_holed(void **state)
{
    (void)state;
    campaign(HOLED);
}

static void
test_honed_holed(void **state)
{
    (void)state;
    campaign(HONED_HOLED);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_groove),
        cmocka_unit_test(test_honed),
        cmocka_unit_test(test_holed),
        cmocka_unit_test(test_honed_holed),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
