/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact of coated bodies is solved to 1e-8, elastic and with a hardness. Coats are a thousandth of a node
 * to a thousand maps thick, and 1e-4 to 1e4 times as stiff as the material below. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/solver/hard_case.h"

enum {
    NX = 37,
    NY = 31
};

static const double thickness[] = {1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 37e-3};
static const double ratio[] = {1e-4, 1e-2, 1e2, 1e4};

/* The mean pressure is a hundredth of the effective E* for waves of eight nodes. */
static size_t
sweep(unsigned boundaries, double hardness)
{
    size_t failed = 0;

    for (size_t t = 0; t < sizeof thickness / sizeof *thickness; t++)
        for (size_t r = 0; r < sizeof ratio / sizeof *ratio; r++) {
            struct rc_layer layer = {thickness[t], 1e11 * ratio[r], 0.3};
            struct rc_body coating = {1e11, 0.3, 1, &layer};
            char name[64];
            struct hard_case c = {.name = name,
                                  .shape = {NX, NY, 1e-6, 1.2e-6},
                                  .boundaries = boundaries,
                                  .height = hard_noise,
                                  .unit = 1e-7,
                                  .mean = 1e-2,
                                  .hardness = hardness};
            hard_pair.one = coating;
            snprintf(name, sizeof name, "t/dx %g, E1/Es %g", thickness[t] / 1e-6, ratio[r]);
            failed += hard_failures(&c);
        }
    return failed;
}

static void
elastic(void **state)
{
    (void)state;
    assert_int_equal(sweep(BOTH, 0), 0);
}

static void
hard(void **state)
{
    (void)state;
    assert_int_equal(sweep(BOTH, 2), 0);
}

/* The bodies have stiff films in soft material, a graded coat, and a rigid base. */
static void
stacks(void **state)
{
    struct rc_layer net[] = {
        {1e-6, 1e7, 0.5}, {1e-9, 1e15, 0.2}, {3e-6, 1e7, 0.499}, {1e-6, 1e13, 0}};
    struct rc_layer graded[40];
    struct rc_pair body[] = {{.one = {1e11, 0.3, 4, net}},
                             {.one = {1e9, 0.3, 40, graded}, .two = {.e = 1e12}},
                             {.one = {INFINITY, 0.3, 2, net}}};
    size_t failed = 0;

    (void)state;
    for (int k = 0; k < 40; k++)
        graded[k] = (struct rc_layer){1e-7, 1e13 * exp(-k * 0.23), 0.5 - 0.03 * k};
    for (int b = 0; b < 3; b++)
        for (int yields = 0; yields < 2; yields++) {
            struct hard_case c = {.name = b == 0   ? "soft, stiff, soft, stiff"
                                          : b == 1 ? "40 layers"
                                                   : "on a rigid base",
                                  .shape = {NX, NY, 1e-6, 1.2e-6},
                                  .boundaries = BOTH,
                                  .height = hard_noise,
                                  .unit = 1e-7,
                                  .mean = 1e-2,
                                  .hardness = yields ? 2 : 0};
            hard_pair = body[b];
            failed += hard_failures(&c);
        }
    assert_int_equal(failed, 0);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elastic),
        cmocka_unit_test(hard),
        cmocka_unit_test(stacks),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
