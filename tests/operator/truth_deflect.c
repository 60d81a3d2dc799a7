/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Displacements have closed forms: Love's loaded rectangle on the free boundary, waves on the periodic one.
 * Their bits are the same for any number of threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"
#include "libcontact/operator/operator.h"

static const double estar = 2.385e9;

static struct rc_conv *
conv(struct rc_shape shape, struct rc_conv_options options)
{
    struct rc_err err;
    struct rc_conv *c = rc_conv_new(&shape, &(struct rc_pair){.estar = estar}, &options, &err);

    if (c == NULL)
        print_error("%s\n", err.text);
    assert_non_null(c);
    return c;
}

/* A rectangle of 31 x 18 cells under 1 MPa in a map of 97 x 61. */
static void
loves_rectangle(void **state)
{
    static const char *const engines[] = {"auto", "fft", "direct"};
    static const double tols[] = {0, 1e-4};
    struct rc_shape shape = {97, 61, 1.1e-6, 0.9e-6};
    size_t n = shape.nx * shape.ny;
    double *p = calloc(n, sizeof *p), *u = malloc(n * sizeof *u);
    double a = 31 * shape.dx / 2, b = 18 * shape.dy / 2, x0, y0;

    (void)state;
    for (size_t j = 20; j < 38; j++)
        for (size_t i = 40; i < 71; i++)
            p[j * shape.nx + i] = 1e6;
    x0 = node_x(shape, 40) - shape.dx / 2 + a;
    y0 = node_y(shape, 20 * shape.nx) - shape.dy / 2 + b;
    for (size_t e = 0; e < 3; e++)
        for (size_t t = 0; t < 2; t++) {
            struct rc_conv *c =
                conv(shape, (struct rc_conv_options){.engine = engines[e], .tol = tols[t]});
            double worst = 0;
            rc_conv_apply(c, p, u);
            for (size_t k = 0; k < n; k++) {
                double truth = 1e6 * love_displacement(node_x(shape, k) - x0, node_y(shape, k) - y0,
                                                       a, b, estar);
                worst = larger(worst, fabs(u[k] / truth - 1));
            }
            print_message("%s, tol %g: %.1e, own bound %.1e\n", rc_conv_engine(c), tols[t], worst,
                          rc_conv_error(c));
            /* the requested error is relative to the largest sum: for 1e-4 the actual error is 1e-6 */
            assert_true(worst <= (tols[t] == 0 ? of_sum : tols[t] / 10));
            assert_true(
                worst <=
                30 * rc_conv_error(c)); /* it is a bound relative to the sum, not to each u */
            rc_conv_free(c);
        }
    free(p);
    free(u);
}

/* cos(q.r) on a periodic map is displaced by 2 / (E* |q|) cos(q.r), whatever the size. */
static void
periodic_waves(void **state)
{
    static const struct rc_shape shapes[] = {{64, 48, 1e-6, 1.3e-6}, {33, 47, 1.1e-6, 1e-6},
                                             {97, 1, 2e-6, 1e-6},    {1, 60, 1e-6, 2e-6},
                                             {30, 256, 1e-6, 1e-8},  {8, 4, 1, 1}};
    static const int waves[][2] = {{1, 0}, {0, 1}, {2, 3}, {3, -5}, {0, 0}};
    size_t fitting = 0;

    (void)state;
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++)
        for (size_t w = 0; w < sizeof waves / sizeof *waves; w++) {
            struct rc_shape shape = shapes[s];
            size_t n = shape.nx * shape.ny;
            double qx = 2 * exact_pi * waves[w][0] / ((double)shape.nx * shape.dx);
            double qy = 2 * exact_pi * waves[w][1] / ((double)shape.ny * shape.dy);
            double q = hypot(qx, qy), factor = q == 0 ? 0 : 2 / (estar * q), worst = 0, largest;
            double *p = malloc(n * sizeof *p), *u = malloc(n * sizeof *u);
            struct rc_conv *c = conv(shape, (struct rc_conv_options){.boundary = RC_PERIODIC});
            bool fits =
                2 * (size_t)abs(waves[w][0]) < shape.nx && 2 * (size_t)abs(waves[w][1]) < shape.ny;

            for (size_t k = 0; k < n; k++)
                p[k] = cos(qx * node_x(shape, k) + qy * node_y(shape, k) + 0.3);
            rc_conv_apply(c, p, u);
            for (size_t k = 0; k < n; k++)
                worst = larger(worst, fabs(u[k] - factor * p[k]));
            largest = of_sum * fmax(factor, shape.dx / estar);
            if (fits && !(worst <= largest))
                print_error("%zu x %zu, wave %d %d: %g of %g\n", shape.nx, shape.ny, waves[w][0],
                            waves[w][1], worst, factor);
            assert_true(!fits || worst <= largest);
            fitting += fits;
            rc_conv_free(c);
            free(p);
            free(u);
        }
    assert_true(fitting == 5 + 5 + 2 + 2 + 5 + 3);
}

static void
what_an_engine_cannot_do_is_said(void **state)
{
    struct rc_shape shape = {8, 8, 1, 1};
    struct rc_err err;
    struct rc_conv_options options = {.boundary = RC_PERIODIC, .engine = "direct"};

    (void)state;
    assert_null(rc_conv_new(&shape, &(struct rc_pair){.estar = estar}, &options, &err));
    assert_non_null(strstr(err.text, "on a periodic boundary"));
    options = (struct rc_conv_options){.engine = "guess"};
    assert_null(rc_conv_new(&shape, &(struct rc_pair){.estar = estar}, &options, &err));
    assert_non_null(strstr(err.text, "there is no engine 'guess'"));
    shape.dx = -1;
    options = (struct rc_conv_options){.engine = "fft"};
    assert_null(rc_conv_new(&shape, &(struct rc_pair){.estar = estar}, &options, &err));
    assert_non_null(strstr(err.text, "dx=-1 dy=1 m: both must be positive"));
}

/* "auto" chooses the direct sum for small grids. It chooses mlms for sparse maps if the accuracy allows it,
 * and for maps that do not fit into memory. It chooses transforms for the others and for all periodic
 * maps. */
static void
the_choice_and_its_reason(void **state)
{
    struct rc_shape small = {20, 20, 1, 1}, large = {600, 500, 1, 1};
    static const struct {
        bool large;
        struct rc_conv_options options;
        const char *engine, *reason;
    } table[] = {
        {false, {.tol = 0}, "direct", "small"},
        {false, {.boundary = {.x = true, .y = true}}, "fft", "periodic"},
        {true, {.tol = 0}, "fft", "rounding"},
        {true, {.tol = 1e-3, .loaded = 0.5}, "fft", "fastest"},
        {true, {.tol = 1e-3, .loaded = 0.03}, "mlms", "few nodes"},
        {true, {.tol = 1e-12, .loaded = 0.03}, "fft", "fastest"},
        {true, {.tol = 1e-6, .memory = 5000000}, "mlms", "memory"},
        {true, {.order = 4, .correction = 10}, "mlms", "order"},
        {true, {.engine = "mlms"}, "mlms", "asked"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        struct rc_conv *c = conv(table[k].large ? large : small, table[k].options);
        assert_string_equal(rc_conv_engine(c), table[k].engine);
        assert_non_null(strstr(rc_conv_reason(c), table[k].reason));
        rc_conv_free(c);
    }
}

/* A map large enough to use threads gives the same bits for 1, 2 and 5 threads, and from plan to plan. */
static void
threads_change_no_bit(void **state)
{
    struct rc_shape shape = {300, 211, 1e-6, 1.2e-6};
    size_t n = shape.nx * shape.ny;
    double *p = malloc(n * sizeof *p), *u = malloc(n * sizeof *u), *v = malloc(n * sizeof *v);
    static const size_t threads[] = {1, 2, 5, 2};

    (void)state;
    for (int boundary = 0; boundary < 2; boundary++)
        for (int tol = 0; tol < 2; tol++)
            for (size_t t = 0; t < 4; t++) {
                uint64_t seed = 17;
                struct rc_conv *c =
                    conv(shape,
                         (struct rc_conv_options){.boundary = boundary == 0 ? RC_FREE : RC_PERIODIC,
                                                  .tol = 1e-4 * tol,
                                                  .threads = threads[t]});
                for (size_t k = 0; k < n; k++)
                    p[k] = random_number(&seed);
                rc_conv_apply(c, p, t == 0 ? u : v);
                assert_true(t == 0 || memcmp(u, v, n * sizeof *u) == 0);
                rc_conv_free(c);
            }
    free(p);
    free(u);
    free(v);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loves_rectangle),
        cmocka_unit_test(periodic_waves),
        cmocka_unit_test(what_an_engine_cannot_do_is_said),
        cmocka_unit_test(the_choice_and_its_reason),
        cmocka_unit_test(threads_change_no_bit),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
