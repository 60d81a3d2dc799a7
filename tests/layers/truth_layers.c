/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Displacements of coated bodies, from thin films to coats a thousand maps thick. Responses to waves and
 * influence coefficients of cells are compared with independent solutions. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"
#include "libcontact/body/stack.h"
#include "tests/body_case.h"

/* Known responses have twelve digits, known coefficients eleven. */
static const double twelve_digits = 1e-11, eleven_digits = 1e-10;
/* The difference between a coat a thousand maps thick and one material is of the order of map over
 * thickness. */
static const double of_thick_coat = 1e-3;

static struct rc_stack *
stack_of(const struct rc_layer *layer, size_t n, double e, double nu)
{
    struct rc_body coating = {.layers = n, .layer = layer, .e = e, .nu = nu};
    struct rc_err err;
    struct rc_stack *s = rc_stack_new(&coating, &err);

    assert_non_null(s);
    return s;
}

/* Airy's stress functions solved with 50 digits, substrate E = 1, nu = 0.3. */
static void
response(void **state)
{
    static const double q[] = {0.1, 0.5, 1, 2, 5};
    static const struct {
        struct rc_layer layer[3];
        size_t n;
        double g[5];
    } body[] = {
        {{{1, 10, 0.3}},
         1,
         {0.837728821569, 0.628869614955, 0.335134848371, 0.135386669642, 0.0913861664268}},
        {{{1, 0.1, 0.3}},
         1,
         {1.25587208116, 2.6409382943, 4.38543373399, 7.21865266332, 9.07580743052}},
        {{{0.25, 4, 0.2}, {0.5, 0.2, 0.45}, {1, 10, 0.3}},
         3,
         {0.855414012131, 0.730621324924, 0.694806936189, 1.17717611955, 0.782928607402}},
    };

    (void)state;
    for (size_t b = 0; b < sizeof body / sizeof *body; b++) {
        struct rc_stack *s = stack_of(body[b].layer, body[b].n, 1, 0.3);
        for (size_t k = 0; k < 5; k++)
            assert_true(fabs(rc_stack_response(s, q[k]) / body[b].g[k] - 1) < twelve_digits);
        rc_stack_free(s);
    }
}

/* The response to long waves is that of the substrate, to short ones that of the top layer. The limits of
 * these ranges are right for ratios of stiffness of 1e-6 to 1e6. For one material it is 1/E* for all
 * waves. */
static void
ends(void **state)
{
    (void)state;
    for (double ratio = 1e-6; ratio < 2e6; ratio *= 10) {
        struct rc_layer layer[] = {{1e-6, 70e9 * ratio, 0.2}, {3e-6, 5e9, 0.45}};
        struct rc_stack *s = stack_of(layer, 2, 70e9, 0.3);
        double top = (1 - 0.04) / layer[0].e, bottom = (1 - 0.09) / 70e9;

        assert_true(fabs(rc_stack_response(s, 1e12) / top - 1) < rounding);
        assert_true(fabs(rc_stack_response(s, 1e-16) / bottom - 1) < rounding);
        for (double q = 1e-4; q < 1e16; q *= 3)
            assert_true(rc_stack_response(s, q) > 0 && isfinite(rc_stack_response(s, q)));
        rc_stack_free(s);
    }
    for (double q = 1e-3; q < 1e12; q *= 7) {
        struct rc_layer layer[] = {{1e-6, 70e9, 0.3}, {3e-7, 70e9, 0.3}};
        struct rc_stack *s = stack_of(layer, 2, 70e9, 0.3);
        assert_true(fabs(rc_stack_response(s, q) * 70e9 / 0.91 - 1) < rounding);
        rc_stack_free(s);
    }
}

/* Compares the table of symbols with the recursion over 16 decades of wave numbers. The coats are a thousand
 * times stiffer and softer than the material below. */
static void
table(void **state)
{
    (void)state;
    for (double ratio = 1e-3; ratio < 2e3; ratio *= 1e3) {
        struct rc_layer layer[] = {{1e-6, 70e9 * ratio, 0.2}, {3e-8, 5e9, 0.45}, {2e-5, 7e9, 0.1}};
        struct rc_stack *s = stack_of(layer, 3, 70e9, 0.3);
        for (double q = 1e-4; q < 1e12; q *= 1.0137) {
            double q2 = q * q, g;
            rc_stack_responses(s, 1, &q2, &g);
            assert_true(fabs(g / rc_stack_response(s, q) - 1) < twelve_digits);
        }
        rc_stack_free(s);
    }
}

/* Displacements at nodes (0,0), (1,0), (0,1), (2,1), (10,7), (100,30) of a cell dx = 1 under unit pressure.
 * They come from direct integration over the wave number. */
static void
coefficients(void **state)
{
    static const int node[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 1}, {10, 7}, {100, 30}};
    static const struct {
        struct rc_layer layer[3];
        size_t n;
        double dy, k[6];
    } body[] = {
        {{{4, 10, 0.3}},
         1,
         1,
         {0.15550423313, 0.082779154634, 0.082779154634, 0.063301132576, 0.024646849782,
          0.0027323995579}},
        {{{0.5, 10, 0.3}},
         1,
         1,
         {0.48283767228, 0.28232310038, 0.28232310038, 0.13282291319, 0.02335220944,
          0.0027725942062}},
        {{{4, 0.1, 0.3}},
         1,
         1,
         {9.3338554316, 2.1522330862, 2.1522330862, 0.53536640743, 0.022833410533,
          0.0027754925653}},
        {{{16, 0.1, 0.3}},
         1,
         1,
         {9.991522505, 2.7867239455, 2.7867239455, 1.0880419743, 0.062636015074, 0.0027834781983}},
        {{{2, 4, 0.2}, {4, 0.2, 0.45}, {8, 10, 0.3}},
         3,
         2,
         {0.77082225827, 0.51551981654, 0.38959852156, 0.2936321338, 0.029492617818,
          0.0048401183122}},
    };

    (void)state;
    for (size_t b = 0; b < sizeof body / sizeof *body; b++) {
        struct rc_lattice at = {1, body[b].dy, 1, 1};
        struct body_case c;
        double row[101];

        surface_case(&c, (struct rc_pair){.one = {1, 0.3, body[b].n, body[b].layer}});
        for (size_t k = 0; k < 6; k++) {
            size_t j = (size_t)node[k][1];
            c.kernel.rows(c.kernel.of, &at, 101, j, j + 1, row);
            assert_true(fabs(row[node[k][0]] / body[b].k[k] - 1) < eleven_digits);
        }
        body_case_free(&c);
    }
}

/* Layers of the substrate's material have no effect. */
static void
one_material(void **state)
{
    struct rc_layer layer[] = {{0.7, 1, 0.3}, {0.05, 1, 0.3}};
    struct body_case of_one, bare;
    struct rc_lattice at = {1, 1.3, 1, 1};
    double a[40 * 60], b[40 * 60];

    (void)state;
    surface_case(&of_one, (struct rc_pair){.one = {1, 0.3, 2, layer}});
    surface_case(&bare, (struct rc_pair){.estar = 1 / 0.91});
    of_one.kernel.rows(of_one.kernel.of, &at, 60, 0, 40, a);
    bare.kernel.rows(bare.kernel.of, &at, 60, 0, 40, b);
    for (size_t k = 0; k < 40 * 60; k++)
        assert_true(fabs(a[k] / b[k] - 1) < summed);
    body_case_free(&of_one);
    body_case_free(&bare);
}

/* The displacement of two bodies is the sum of their separate displacements. For two equal bodies it is twice
 * that of one against a rigid body; for a layered and a uniform body it is the sum of both. */
static void
both_bodies(void **state)
{
    const struct rc_layer layer[] = {{2, 4, 0.2}, {4, 0.2, 0.45}};
    const struct rc_body layered = {1, 0.3, 2, layer}, plain = {.e = 3, .nu = 0.25};
    const struct rc_pair pairs[] = {{.one = layered},
                                    {.one = layered, .two = layered},
                                    {.one = plain},
                                    {.one = layered, .two = plain}};
    const struct rc_lattice at = {1, 1.3, 1, 1};
    double k[4][30 * 20], symbol[4];

    (void)state;
    for (int p = 0; p < 4; p++) {
        struct body_case c;
        surface_case(&c, pairs[p]);
        c.kernel.rows(c.kernel.of, &at, 30, 0, 20, k[p]);
        symbol[p] = c.kernel.symbol(c.kernel.of, 0.7, 0.4);
        body_case_free(&c);
    }
    for (size_t n = 0; n < 30 * 20; n++) {
        assert_true(fabs(k[1][n] / (2 * k[0][n]) - 1) < rounding);
        assert_true(fabs(k[3][n] / (k[0][n] + k[2][n]) - 1) < rounding);
    }
    assert_true(fabs(symbol[1] / (2 * symbol[0]) - 1) < rounding);
    assert_true(fabs(symbol[3] / (symbol[0] + symbol[2]) - 1) < rounding);
}

/* Contacts with extreme coatings are solved to the tolerance. The coats are a thousandth of a node to a
 * thousand maps thick, with ratios of stiffness of 1e-4 to 1e4. A thick coat equals a uniform body. */
static void
thin_and_thick(void **state)
{
    enum {
        N = 48
    };
    struct rc_shape shape = {N, N, 1e-6, 1e-6};
    struct rc_selfaffine what = {.hurst = 0.8, .rms_slope = 0.1, .short_cut = 5e-6, .seed = 5};
    double h[N * N];
    struct rc_err err;

    (void)state;
    assert_int_equal(rc_synth_selfaffine(&shape, &what, h, &err), RC_OK);
    for (int boundary = 0; boundary < 2; boundary++)
        for (double ratio = 1e-4; ratio < 2e4; ratio *= 100) {
            const double thickness[] = {1e-9, 1e3 * N * 1e-6};
            for (int k = 0; k < 2; k++) {
                struct rc_layer layer = {thickness[k], ratio * 1e9, 0.3};
                struct rc_body coating = {1e9, 0.3, 1, &layer};
                double e = (k == 0 ? 1e9 : ratio * 1e9) / 0.91;
                struct rc_problem on = {.boundary = boundary == 0 ? RC_FREE : RC_PERIODIC,
                                        .pair.one = coating,
                                        .load = 0.02 * e * N * N * 1e-12,
                                        .tol = 1e-5},
                                  bare = on;
                struct solved a, b;
                double off = 0;

                bare.pair = (struct rc_pair){.estar = e};
                a = solve(shape, h, on);
                b = solve(shape, h, bare);
                assert_int_equal(a.status, RC_OK);
                for (size_t i = 0; i < N * N; i++)
                    off += fabs(a.p[i] - b.p[i]);
                /* a soft coat of a thousandth of a node deforms as much as the nodes, and a stiff one
                 * prevents displacements along the surface. Only the thick coat equals one material */
                if (k == 1)
                    assert_true(off * 1e-12 / on.load < of_thick_coat);
                solved_free(&a);
                solved_free(&b);
            }
        }
}

static void
refusals(void **state)
{
    struct rc_layer layer = {1e-6, 1e9, 0.3};
    struct rc_body good = {1e9, 0.3, 1, &layer}, bad;
    struct rc_err err;

    (void)state;
#define REFUSED(change)                                                                            \
    bad = good;                                                                                    \
    layer = (struct rc_layer){1e-6, 1e9, 0.3};                                                     \
    change;                                                                                        \
    assert_int_equal(rc_body_type(&bad)->check(&bad, RC_SURFACE, &err), RC_FAIL)
    REFUSED(layer.thickness = 0);
    REFUSED(layer.thickness = INFINITY);
    REFUSED(layer.thickness = NAN);
    REFUSED(layer.e = -1);
    REFUSED(layer.e = INFINITY);
    REFUSED(layer.nu = 0.51);
    REFUSED(layer.nu = -1);
    REFUSED(bad.e = 0);
    REFUSED(bad.nu = NAN);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(response),       cmocka_unit_test(both_bodies),
        cmocka_unit_test(ends),           cmocka_unit_test(table),
        cmocka_unit_test(coefficients),   cmocka_unit_test(one_material),
        cmocka_unit_test(thin_and_thick), cmocka_unit_test(refusals),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
