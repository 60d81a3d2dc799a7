/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two ways to compute a stress in a coated body agree: engines, sections and slices, threads; and without
 * layers nothing is computed for them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    SIX = (1 << RC_COMPONENTS) - 1,
    NX = 40,
    NY = 33,
    N = NX * NY
};
static const struct rc_shape shape = {NX, NY, 1.1e-6, 0.8e-6};

static const struct rc_layer stiff[] = {{3e-6, 2e12, 0.25}}, thin[] = {{0.05e-6, 5e11, 0.2}},
                             soft[] = {{4e-6, 1e8, 0.5}},
                             three[] = {
                                 {1.3e-6, 4e11, 0.2}, {0.7e-6, 2e10, 0.45}, {4e-6, 9e10, 0.3}};
static const struct {
    const char *what;
    struct rc_body coating;
} bodies[] = {{"stiff", {2e10, 0.3, 1, stiff}},
              {"thin", {2e11, 0.3, 1, thin}},
              {"soft", {2e11, 0.3, 1, soft}},
              {"three", {2e11, 0.28, 3, three}}};
enum {
    BODIES = sizeof bodies / sizeof *bodies
};
static const double depths[] = {0, 0.05e-6, 0.6e-6, 1.3e-6, 1.7e-6, 3e-6, 5e-6, 12e-6};
enum {
    DEPTHS = sizeof depths / sizeof *depths
};

/* Pressure on an off-centre patch with gaps in it. */
static double *
pressure(double *largest)
{
    double *p = malloc(N * sizeof *p);
    uint64_t seed = 1927;

    *largest = 0;
    for (size_t k = 0; k < N; k++) {
        double x = (double)(k % NX) / NX - 0.45, y = (double)(k / NX) / NY - 0.55;
        double r = 2.2 * hypot(x, y), u = random_number(&seed);
        p[k] = r < 1 && u > -0.2 ? 1e9 * (0.6 + 0.5 * u) * sqrt(1 - r * r) : 0;
        *largest = fmax(*largest, p[k]);
    }
    return p;
}

/* Six components at a depth, of `values` numbers each. */
static size_t
compute(const double *p, struct rc_stress_options o, double z, double *s,
        struct rc_stress_counts *counts)
{
    struct rc_err err = {""};
    struct rc_stress *stress = rc_stress_new(&shape, p, &o, &err);
    double *to[RC_STRESSES] = {NULL};
    size_t n;

    if (stress == NULL)
        print_error("%s\n", err.text);
    assert_non_null(stress);
    n = rc_stress_values(stress);
    for (int c = 0; c < RC_COMPONENTS; c++)
        to[c] = s + (size_t)c * n;
    assert_int_equal(rc_stress_slice(stress, z, to, &err), RC_OK);
    if (counts != NULL)
        *counts = *rc_stress_counted(stress);
    rc_stress_free(stress);
    return n;
}

static double
apart(size_t n, const double *a, const double *b)
{
    double worst = 0;

    for (size_t k = 0; k < n; k++)
        worst = larger(worst, fabs(a[k] - b[k]));
    return worst;
}

static double
size_of(size_t n, const double *a)
{
    double most = 0;

    for (size_t k = 0; k < n; k++)
        most = larger(most, fabs(a[k]));
    return most;
}

/* Rounding is relative to the largest stress, which in a stiff coat is several times the pressure. */
static void
engines_agree(void **state)
{
    double largest, *p = pressure(&largest);
    double *a = malloc(6 * N * sizeof *a), *b = malloc(6 * N * sizeof *b);

    (void)state;
    for (int i = 0; i < BODIES; i++)
        for (int d = 0; d < DEPTHS; d++) {
            struct rc_stress_options o = {
                .mu = 0.35, .wanted = SIX, .body = bodies[i].coating, .threads = 2};
            compute(p, o, depths[d], a, NULL);
            o.engine = "direct";
            compute(p, o, depths[d], b, NULL);
            assert_true(apart(6 * N, a, b) <= rounding * larger(largest, size_of(6 * N, a)));
            o.engine = "mlms";
            for (double tol = d % 3 == 1 ? 1e-2 : 0; tol > 1e-7; tol /= 1e4) {
                o.tol = tol;
                compute(p, o, depths[d], b, NULL);
                if (apart(6 * N, a, b) > tol * largest)
                    print_error("%s, depth %g, tol %g: off by %.1e\n", bodies[i].what, depths[d],
                                tol, apart(6 * N, a, b) / largest);
                assert_true(apart(6 * N, a, b) <= tol * largest);
            }
        }
    free(p);
    free(a);
    free(b);
}

/* A section along a row or a column of nodes equals this line of the slice. */
static void
sections_are_lines(void **state)
{
    double largest, *p = pressure(&largest);
    double *a = malloc(6 * N * sizeof *a), *b = malloc(6 * N * sizeof *b);

    (void)state;
    for (int boundary = 0; boundary < BOUNDARIES; boundary++)
        for (int i = 0; i < BODIES; i++)
            for (int d = 0; d < DEPTHS; d++) {
                struct rc_stress_options o = {.boundary = each_boundary[boundary],
                                              .mu = 0.35,
                                              .wanted = SIX,
                                              .body = bodies[i].coating,
                                              .threads = 2};
                double off = 0, scale;
                compute(p, o, depths[d], a, NULL);
                scale = larger(largest, size_of(6 * N, a));
                o.section = 'y';
                o.at = node_y(shape, 11 * NX);
                assert_int_equal(compute(p, o, depths[d], b, NULL), NX);
                for (int c = 0; c < 6; c++)
                    off = larger(off, apart(NX, a + c * N + 11 * NX, b + c * NX));
                o.section = 'x';
                o.at = node_x(shape, 23);
                assert_int_equal(compute(p, o, depths[d], b, NULL), NY);
                for (int c = 0; c < 6; c++)
                    for (int j = 0; j < NY; j++)
                        off = larger(off, fabs(a[c * N + j * NX + 23] - b[c * NY + j]));
                assert_true(off <= rounding * scale);
            }
    free(p);
    free(a);
    free(b);
}

/* A pressure that is rotated by a quarter turn, and the section across it: x and y are exchanged. */
static void
sections_across(void **state)
{
    const struct rc_shape square = {NX, NX, 1e-6, 1e-6};
    double *p = malloc(2 * NX * NX * sizeof *p), *q = p + NX * NX, a[NX], b[NX];
    double *s[RC_STRESSES] = {[RC_SXX] = a}, *t[RC_STRESSES] = {[RC_SYY] = b};
    uint64_t seed = 7;

    (void)state;
    for (size_t k = 0; k < NX * NX; k++)
        p[k] = random_number(&seed);
    for (size_t k = 0; k < NX * NX; k++)
        q[k] = p[k % NX * NX + k / NX];
    for (int boundary = 0; boundary < BOUNDARIES; boundary++) {
        struct rc_stress_options o = {.boundary = each_boundary[boundary],
                                      .wanted = 1 << RC_SXX,
                                      .section = 'y',
                                      .at = 0.3e-6,
                                      .body = bodies[3].coating,
                                      .threads = 2};
        struct rc_err err;
        struct rc_stress *one = rc_stress_new(&square, p, &o, &err), *other;
        o.section = 'x';
        o.boundary = rc_boundary_of(o.boundary.y, o.boundary.x);
        o.wanted = 1 << RC_SYY;
        other = rc_stress_new(&square, q, &o, &err);
        for (int d = 0; d < DEPTHS; d++) {
            assert_int_equal(rc_stress_slice(one, depths[d], s, &err), RC_OK);
            assert_int_equal(rc_stress_slice(other, depths[d], t, &err), RC_OK);
            assert_true(apart(NX, a, b) <= rounding * larger(1, size_of(NX, a)));
        }
        rc_stress_free(one);
        rc_stress_free(other);
    }
    free(p);
}

/* The result does not depend on the threads to the last bit. */
static void
threads_agree(void **state)
{
    double largest, *p = pressure(&largest);
    double *a = malloc(6 * N * sizeof *a), *b = malloc(6 * N * sizeof *b);

    (void)state;
    for (int boundary = 0; boundary < BOUNDARIES; boundary++)
        for (int section = 0; section < 2; section++) {
            struct rc_stress_options o = {.boundary = each_boundary[boundary],
                                          .mu = 0.2,
                                          .wanted = SIX,
                                          .section = section ? 'y' : 0,
                                          .body = bodies[3].coating,
                                          .threads = 1};
            size_t n = compute(p, o, 1.7e-6, a, NULL);
            o.threads = 3;
            compute(p, o, 1.7e-6, b, NULL);
            assert_true(apart(6 * n, a, b) == 0);
        }
    free(p);
    free(a);
    free(b);
}

/* A slice costs the same with layers, except for one kernel. In a uniform body this kernel is shared (szz of
 * the traction is sxz of the pressure). Without friction no kernels of traction are computed. Coarser grids
 * are not used. */
static void
only_what_is_asked(void **state)
{
    double largest, *p = pressure(&largest), *s = malloc(6 * N * sizeof *s);

    (void)state;
    for (int coated = 0; coated < 2; coated++)
        for (int friction = 0; friction < 2; friction++) {
            struct rc_stress_options o = {.body = coated ? bodies[0].coating
                                                         : (struct rc_body){.nu = 0.3},
                                          .mu = friction ? 0.3 : 0,
                                          .wanted = SIX,
                                          .tol = 5e-2,
                                          .threads = 1};
            struct rc_stress_counts c;
            compute(p, o, 60e-6, s, &c);
            assert_int_equal(c.normal_kernels, 6);
            assert_int_equal(c.shear_kernels, friction ? 5 + coated : 0);
            assert_int_equal(c.kernel_transforms, c.normal_kernels + c.shear_kernels);
            assert_int_equal(c.field_transforms, 6);
            assert_int_equal(c.coarse_depths, coated ? 0 : 1);
            o.wanted = 1 << RC_SZZ;
            compute(p, o, 60e-6, s, &c);
            assert_int_equal(c.normal_kernels, 1);
            assert_int_equal(c.shear_kernels, friction);
        }
    free(p);
    free(s);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(engines_agree),      cmocka_unit_test(sections_are_lines),
        cmocka_unit_test(sections_across),    cmocka_unit_test(threads_agree),
        cmocka_unit_test(only_what_is_asked),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
