/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A map that repeats along one axis takes as much work as the free and the periodic map of the same heights:
 * squares and strips, rough in both directions or extruded, bare or coated. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

/* The work under several pressures together. An estimate just above the tolerance takes a step more: a fifth
 * under one of them. */
static const double as_much = 1.15;

static double *
rough(const struct rc_shape *s, bool extruded)
{
    const struct rc_shape own = {s->nx, extruded ? 1 : s->ny, s->dx, s->dy};
    const struct rc_selfaffine what = {.hurst = 0.8,
                                       .rms_slope = 0.1,
                                       .short_cut = 4 * s->dx,
                                       .rolloff =
                                           0.2 * (double)(s->nx > s->ny ? s->nx : s->ny) * s->dx,
                                       .seed = 3};
    double *h = malloc(s->nx * s->ny * sizeof *h);
    struct rc_err err;

    assert_non_null(h);
    if (rc_synth_selfaffine(&own, &what, h, &err) != RC_OK)
        fail_msg("%s", err.text);
    for (size_t k = own.nx * own.ny; k < s->nx * s->ny; k++)
        h[k] = h[k - s->nx];
    return h;
}

/* E of a coat of four nodes over that of the base; 0: none. */
static void
work(struct rc_shape s, bool extruded, double coat)
{
    static const double pressures[] = {4e-4, 5e-3, 0.04, 0.1}; /* over E* */
    const struct rc_layer layer = {4 * s.dx, coat * 1e9, 0.3};
    double *h = rough(&s, extruded), sum[4] = {0};

    for (size_t k = 0; k < sizeof pressures / sizeof *pressures; k++) {
        for (int b = 0; b < 4; b++) {
            struct rc_problem problem = {.boundary = rc_boundary_of(b & 1, b >> 1),
                                         .load = pressures[k] * 1e9 * (double)(s.nx * s.ny) * s.dx *
                                                 s.dy,
                                         .tol = 1e-4,
                                         .threads = 1};
            struct solved a;
            if (coat > 0)
                problem.pair.one = (struct rc_body){1e9, 0.3, 1, &layer};
            else
                problem.pair.estar = 1e9;
            a = solve(s, h, problem);
            assert_int_equal(a.status, RC_OK);
            sum[b] += a.c.convolutions;
            solved_free(&a);
        }
    }
    print_message("%4zu x %4zu%s, coat %g: free %.1f, x %.1f, y %.1f, both %.1f\n", s.nx, s.ny,
                  extruded ? ", extruded" : "", coat, sum[0], sum[1], sum[2], sum[3]);
    assert_true(fmax(sum[1], sum[2]) <= as_much * fmax(sum[0], sum[3]));
    free(h);
}

static void
squares(void **state)
{
    (void)state;
    for (size_t n = 128; n <= thorough(1024, 256); n *= 2)
        for (int extruded = 0; extruded < 2; extruded++)
            work((struct rc_shape){n, n, 1e-6, 1e-6}, extruded, 0);
}

static void
strips(void **state)
{
    const size_t n = thorough(4096, 1024);

    (void)state;
    for (size_t side = 4; side < 64; side *= 2) {
        work((struct rc_shape){side, n, 1e-6, 1e-6}, false, 0);
        work((struct rc_shape){n, side, 1e-6, 1e-6}, false, 0);
    }
}

static void
coats(void **state)
{
    static const double ratio[] = {0.01, 0.3, 10};

    (void)state;
    for (int k = 0; k < 3; k++) {
        work((struct rc_shape){128, 128, 1e-6, 1e-6}, false, ratio[k]);
        work((struct rc_shape){32, 512, 1e-6, 1e-6}, false, ratio[k]);
        work((struct rc_shape){512, 32, 1e-6, 1e-6}, false, ratio[k]);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(squares),
        cmocka_unit_test(strips),
        cmocka_unit_test(coats),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
