/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The work of the method pcg does not grow with the grid: convolutions to 1e-4 on surfaces with
 * ever more, and ever shorter, waves. The work of the method pk99 is proportional to the number of nodes a
 * side. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

struct row {
    struct rc_boundary boundary;
    double mean;     /* pressure over E*; the RMS slope is 0.1 */
    double hardness; /* over the mean pressure; 0: none        */
    double most;     /* convolutions                           */
    double cut;      /* shortest waves over the spacing        */
};

static const struct row rows[] = {
    {{.x = true, .y = true}, 4e-4, 0, 8, 8},
    {{.x = true, .y = true}, 0.018, 0, 8, 8},
    {{.x = true, .y = true}, 0.028, 0, 8, 8},
    {{.x = true, .y = true}, 0.05, 0, 8, 8},
    {{.x = true, .y = true}, 0.12, 0, 8, 8},
    {{.x = true, .y = true}, 0.01, 3, 11, 8},
    /* nearly all that is loaded yields */
    {{.x = true, .y = true}, 6e-4, 1 / 0.6, 12, 2},
    {{.x = true, .y = true}, 9e-4, 1 / 0.9, 12, 2},
    {{.x = false}, 1.5e-3, 1 / 0.3, 12, 2},
    /* flat maps, which carry load up to their edges */
    {{.x = false}, 8e-4, 0, 9, 2},
    {{.x = false}, 0.0176, 0, 8, 2},
    {{.x = false}, 0.054, 0, 8, 2},
};

static double
work(const struct row *row, size_t m, const char *method)
{
    struct rc_shape s = {m, m, 1e-6, 1e-6};
    double *h = calloc(m * m, sizeof *h), mean = 1e9 * row->mean, convolutions;
    struct rc_selfaffine what = {.hurst = 0.8,
                                 .rms_slope = 0.1,
                                 .rolloff = (double)m * s.dx / 8,
                                 .short_cut = row->cut * s.dx,
                                 .seed = 5};
    struct rc_problem problem = {.boundary = row->boundary,
                                 .pair.estar = 1e9,
                                 .method = method,
                                 .tol = 1e-4,
                                 .load = mean * s.dx * s.dy * (double)(m * m),
                                 .hardness = row->hardness > 0 ? row->hardness * mean : INFINITY};
    struct solved found;
    struct rc_err err;

    assert_int_equal(rc_synth_selfaffine(&s, &what, h, &err), RC_OK);
    found = solve(s, h, problem);
    assert_int_equal(found.status, RC_OK);
    convolutions = found.c.convolutions;
    solved_free(&found);
    free(h);
    return convolutions;
}

static void
does_not_grow(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        double small = work(&rows[k], 128, "pcg"), large = work(&rows[k], 512, "pcg");
        print_message("%s, mean %.4f, hardness %.0f: %.1f convolutions at 128, %.1f at 512\n",
                      rc_boundary_word(rows[k].boundary), rows[k].mean, rows[k].hardness, small,
                      large);
        /* sixteen times the nodes: with pk99 the work would be four times as large */
        assert_true(large <= 1.3 * small);
        assert_true(large <= rows[k].most);
    }
}

/* Otherwise the surfaces would be too easy for this test. */
static void
grows_by_the_paper(void **state)
{
    double small, large;

    (void)state;
    small = work(&rows[2], 64, "pk99");
    large = work(&rows[2], 256, "pk99");
    print_message("pk99: %.0f convolutions at 64, %.0f at 256\n", small, large);
    assert_true(large > 2 * small);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(does_not_grow),
                                       cmocka_unit_test(grows_by_the_paper)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
