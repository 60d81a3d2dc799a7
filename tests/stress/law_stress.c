/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of every stress field: equilibrium, compatibility, the load, mirror images and sums. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

enum {
    NX = 64,
    NY = 48,
    N = NX * NY,
    SIX = (1 << RC_COMPONENTS) - 1
};
static const struct rc_shape shape = {NX, NY, 1.1e-6, 0.9e-6};
static const double size = 2.385e8; /* Pa */

static struct rc_stress_options
options(struct rc_boundary boundary, double nu, double mu)
{
    return (struct rc_stress_options){
        .boundary = boundary, .body.nu = nu, .mu = mu, .wanted = SIX, .threads = 2};
}

struct field {
    double *s[RC_STRESSES];
};

static struct field
field_new(void)
{
    struct field f = {{NULL}};

    for (int c = 0; c < RC_STRESSES; c++)
        f.s[c] = malloc(N * sizeof *f.s[c]);
    return f;
}

static void
field_free(struct field *f)
{
    for (int c = 0; c < RC_STRESSES; c++)
        free(f->s[c]);
}

static void
slice(const double *p, struct rc_stress_options o, double z, struct field *f)
{
    struct rc_err err;
    struct rc_stress *stress = rc_stress_new(&shape, p, &o, &err);

    assert_non_null(stress);
    assert_int_equal(rc_stress_slice(stress, z, f->s, &err), RC_OK);
    rc_stress_free(stress);
}

static void
rough(double *p)
{
    uint64_t seed = 1961;

    for (size_t k = 0; k < N; k++) {
        double r = hypot(node_x(shape, k) / 25e-6, node_y(shape, k) / 16e-6);
        p[k] = r < 1 ? size * (random_number(&seed) + 0.5) * sqrt(1 - r * r) : 0;
    }
}

static double
trace(const struct field *f, size_t k)
{
    return f->s[RC_SXX][k] + f->s[RC_SYY][k] + f->s[RC_SZZ][k];
}

/* ---- equilibrium ---- */

/* Sixth-order central difference. */
static double
slope(const double *v, ptrdiff_t step, double d)
{
    return (45 * (v[step] - v[-step]) - 9 * (v[2 * step] - v[-2 * step]) +
            (v[3 * step] - v[-3 * step])) /
           (60 * d);
}

/* The same for the second derivative. */
static double
curvature(double a3, double a2, double a1, double v, double b1, double b2, double b3, double d)
{
    return (2 * (a3 + b3) - 27 * (a2 + b2) + 270 * (a1 + b1) - 490 * v) / (180 * d * d);
}

/* d sxj/dx + d syj/dy + d szj/dz = 0, and the sum of the normal stresses is harmonic. Differences in the
 * slice and between seven slices test this, away from the edges of a map. With sources about 8 nodes away the
 * differences of sixth order have an error of 1e-4 of the terms. */
static void
in_equilibrium(void **state)
{
    const double z = 8 * shape.dx, step = 0.5 * shape.dx;
    double *p = malloc(N * sizeof *p);
    struct field f[7];

    (void)state;
    rough(p);
    for (int i = 0; i < 7; i++)
        f[i] = field_new();
    for (int b = 0; b < 2; b++) {
        double off[3] = {0}, harmonic = 0, largest = 0, bent = 0;
        for (int i = 0; i < 7; i++)
            slice(p, options(b == 0 ? RC_FREE : RC_PERIODIC, 0.3, 0.4), z + (i - 3) * step, &f[i]);
        for (size_t k = 0; k < N; k++) {
            static const int of[3][3] = {
                {RC_SXX, RC_SXY, RC_SXZ}, {RC_SXY, RC_SYY, RC_SYZ}, {RC_SXZ, RC_SYZ, RC_SZZ}};
            double xx, yy, zz, m = trace(&f[3], k);
            if (k % NX < 3 || k % NX > NX - 4 || k / NX < 3 || k / NX > NY - 4)
                continue;
            for (int j = 0; j < 3; j++) {
                double down[7], a, c, e;
                for (int i = 0; i < 7; i++)
                    down[i] = f[i].s[of[j][2]][k];
                a = slope(f[3].s[of[j][0]] + k, 1, shape.dx);
                c = slope(f[3].s[of[j][1]] + k, NX, shape.dy);
                e = slope(down + 3, 1, step);
                off[j] = fmax(off[j], fabs(a + c + e));
                largest = fmax(largest, fmax(fabs(a), fabs(e)));
            }
#define T(i, k) trace(&f[i], k)
            xx = curvature(T(3, k - 3), T(3, k - 2), T(3, k - 1), m, T(3, k + 1), T(3, k + 2),
                           T(3, k + 3), shape.dx);
            yy = curvature(T(3, k - 3 * NX), T(3, k - 2 * NX), T(3, k - NX), m, T(3, k + NX),
                           T(3, k + 2 * NX), T(3, k + 3 * NX), shape.dy);
            zz = curvature(T(0, k), T(1, k), T(2, k), m, T(4, k), T(5, k), T(6, k), step);
#undef T
            harmonic = fmax(harmonic, fabs(xx + yy + zz));
            bent = fmax(bent, fabs(zz));
        }
        print_message("%s: forces off by %.1e %.1e %.1e, the sum's Laplacian by %.1e of its "
                      "terms\n",
                      b == 0 ? "free" : "periodic", off[0] / largest, off[1] / largest,
                      off[2] / largest, harmonic / bent);
        for (int j = 0; j < 3; j++)
            assert_true(off[j] < 1e-4 * largest);
        assert_true(harmonic < 1e-3 * bent);
    }
    for (int i = 0; i < 7; i++)
        field_free(&f[i]);
    free(p);
}

/* The sum of the normal stresses is proportional to 1 + nu, with friction and without. */
static void
sum_follows_poisson(void **state)
{
    double *p = malloc(N * sizeof *p);
    struct field a = field_new(), b = field_new();

    (void)state;
    rough(p);
    for (int periodic = 0; periodic < 2; periodic++)
        for (double z = 0; z < 10 * shape.dx; z += 3 * shape.dx) {
            slice(p, options(periodic == 0 ? RC_FREE : RC_PERIODIC, 0, 0.3), z, &a);
            for (double nu = -0.5; nu <= 0.5; nu += 0.25) {
                slice(p, options(periodic == 0 ? RC_FREE : RC_PERIODIC, nu, 0.3), z, &b);
                for (size_t k = 0; k < N; k++)
                    assert_true(fabs(trace(&b, k) - (1 + nu) * trace(&a, k)) <= summed * size);
            }
        }
    field_free(&a);
    field_free(&b);
    free(p);
}

/* ---- the load ---- */

/* Periodic boundary: every plane carries the load and the friction. */
static void
every_layer_carries_the_load(void **state)
{
    double *p = malloc(N * sizeof *p), load;
    struct field f = field_new();

    (void)state;
    rough(p);
    load = rc_sum(p, N);
    for (double z = 0; z < 1e3 * shape.dx; z = 2 * z + shape.dx) {
        slice(p, options(RC_PERIODIC, 0.3, 0.2), z, &f);
        assert_true(fabs(rc_sum(f.s[RC_SZZ], N) + load) <= summed * load);
        assert_true(fabs(rc_sum(f.s[RC_SXZ], N) + 0.2 * load) <= summed * load);
        assert_true(fabs(rc_sum(f.s[RC_SYZ], N)) <= summed * load);
    }
    field_free(&f);
    free(p);
}

/* Free boundary: the force on the part of a plane below the map. A coefficient is the mean of the point
 * load's field over a cell. So the sum over a slice is the integral of the fields of point loads at the nodes
 * over the map. By reciprocity this is Love's rectangle of the whole map, evaluated at each node. */
static void
the_window_catches_the_load(void **state)
{
    double *p = malloc(N * sizeof *p), a = NX * shape.dx / 2, b = NY * shape.dy / 2, load;
    struct field f = field_new();

    (void)state;
    rough(p);
    load = rc_sum(p, N);
    for (double z = 0.1 * shape.dx; z < 1e3 * shape.dx; z *= 4) {
        double caught[RC_COMPONENTS] = {0}, sheared[RC_COMPONENTS] = {0};
        slice(p, options(RC_FREE, 0.3, 0), z, &f);
        for (int c = 0; c < RC_COMPONENTS; c++)
            for (size_t k = 0; k < N; k++)
                if (p[k] != 0) {
                    /* the field at x' of a force at x is the field at -x of a force at -x' */
                    caught[c] += p[k] * rectangle_stress(false, c, 0.3, -node_x(shape, k),
                                                         -node_y(shape, k), z, a, b);
                    sheared[c] += p[k] * rectangle_stress(true, c, 0.3, -node_x(shape, k),
                                                          -node_y(shape, k), z, a, b);
                }
        for (int c = 0; c < RC_COMPONENTS; c++)
            assert_true(fabs(rc_sum(f.s[c], N) - caught[c]) <= summed * load);
        slice(p, options(RC_FREE, 0.3, 1), z, &f);
        for (int c = 0; c < RC_COMPONENTS; c++)
            assert_true(fabs(rc_sum(f.s[c], N) - caught[c] - sheared[c]) <= 2 * summed * load);
    }
    field_free(&f);
    free(p);
}

/* ---- the surface ---- */

/* Both boundaries: at depth 0 the tractions are those prescribed. */
static void
tractions_at_the_surface(void **state)
{
    double *p = malloc(N * sizeof *p);
    struct field f = field_new();

    (void)state;
    rough(p);
    for (int b = 0; b < 2; b++) {
        slice(p, options(b == 0 ? RC_FREE : RC_PERIODIC, 0.3, 0.35), 0, &f);
        for (size_t k = 0; k < N; k++) {
            assert_true(fabs(f.s[RC_SZZ][k] + p[k]) <= summed * size);
            assert_true(fabs(f.s[RC_SXZ][k] + 0.35 * p[k]) <= summed * size);
            assert_true(fabs(f.s[RC_SYZ][k]) <= summed * size);
        }
    }
    field_free(&f);
    free(p);
}

/* A uniform pressure on a periodic map, and a profile in plane strain: syy = nu (sxx + szz). */
static void
uniform_and_plane(void **state)
{
    const double nu = 0.27;
    double p[37], *s[RC_STRESSES] = {NULL}, v[RC_COMPONENTS][37];
    struct rc_err err;

    (void)state;
    for (int c = 0; c < RC_COMPONENTS; c++)
        s[c] = v[c];
    for (int flat = 0; flat < 2; flat++) {
        const struct rc_shape map = {flat ? 6 : 37, flat ? 6 : 1, 1e-6, 1e-6};
        struct rc_stress_options o = options(RC_PERIODIC, nu, flat ? 0.5 : 0);
        struct rc_stress *stress;
        for (size_t k = 0; k < 37; k++)
            p[k] = flat ? size : size * (1 + sin((double)(k * k)));
        stress = rc_stress_new(&map, p, &o, &err);
        for (double z = 0; z < 9e-6; z += 1.7e-6) {
            assert_int_equal(rc_stress_slice(stress, z, s, &err), RC_OK);
            for (size_t k = 0; k < map.nx * map.ny; k++)
                if (flat) {
                    assert_true(fabs(v[RC_SZZ][k] + size) <= rounding * size);
                    assert_true(fabs(v[RC_SXZ][k] + 0.5 * size) <= rounding * size);
                    assert_true(fabs(v[RC_SXX][k] + (0.5 + nu) * size) <= rounding * size);
                    assert_true(fabs(v[RC_SYY][k] + (0.5 + nu) * size) <= rounding * size);
                } else {
                    assert_true(fabs(v[RC_SYY][k] - nu * (v[RC_SXX][k] + v[RC_SZZ][k])) <=
                                rounding * size);
                }
        }
        rc_stress_free(stress);
    }
}

/* A wave of pressure on a periodic map: exp(-qz) (1 + qz) and the other components. They are in Johnson 1985,
 * section 13.2, from Airy's stress function in plane strain. */
static void
one_wave(void **state)
{
    const double nu = 0.31, turn = 2 * exact_pi;
    double *p = malloc(N * sizeof *p);
    struct field f = field_new();

    (void)state;
    for (int along = 0; along < 2; along++) {
        double q = along ? turn * 5 / (NY * shape.dy) : turn * 5 / (NX * shape.dx);
        for (size_t k = 0; k < N; k++)
            p[k] = size * cos(q * (along ? node_y(shape, k) : node_x(shape, k)));
        for (double z = 0; z < 5 / q; z += 0.7 / q) {
            double e = exp(-q * z) * size;
            slice(p, options(RC_PERIODIC, nu, 0), z, &f);
            for (size_t k = 0; k < N; k++) {
                double x = q * (along ? node_y(shape, k) : node_x(shape, k));
                double zz = -e * (1 + q * z) * cos(x), xx = -e * (1 - q * z) * cos(x);
                const double *const *s = (const double *const *)f.s;
                assert_true(fabs(s[RC_SZZ][k] - zz) <= summed * size);
                assert_true(fabs(s[along ? RC_SYY : RC_SXX][k] - xx) <= summed * size);
                assert_true(fabs(s[along ? RC_SXX : RC_SYY][k] - nu * (xx + zz)) <= summed * size);
                assert_true(fabs(s[along ? RC_SYZ : RC_SXZ][k] + e * q * z * sin(x)) <=
                            summed * size);
                assert_true(fabs(s[RC_SXY][k]) <= summed * size);
            }
        }
    }
    field_free(&f);
    free(p);
}

/* ---- symmetry ---- */

/* The mirror image of a pressure has the mirrored stresses. With friction the traction is mirrored too, and
 * its stresses are mu times a field that is added. */
static void
mirrors_and_sums(void **state)
{
    static const double in_x[] = {1, 1, 1, -1, -1, 1}, in_y[] = {1, 1, 1, -1, 1, -1};
    double *p = malloc(N * sizeof *p), *m = malloc(N * sizeof *m);
    struct field a = field_new(), b = field_new(), c = field_new();
    const double z = 1.3 * shape.dx;

    (void)state;
    rough(p);
    for (int bd = 0; bd < 2; bd++) {
        struct rc_boundary boundary = bd == 0 ? RC_FREE : RC_PERIODIC;
        slice(p, options(boundary, 0.3, 0.2), z, &a);
        for (size_t k = 0; k < N; k++)
            m[k] = p[k / NX * NX + NX - 1 - k % NX];
        slice(m, options(boundary, 0.3, -0.2), z, &b);
        for (int i = 0; i < RC_COMPONENTS; i++)
            for (size_t k = 0; k < N; k++)
                assert_true(fabs(b.s[i][k / NX * NX + NX - 1 - k % NX] - in_x[i] * a.s[i][k]) <=
                            summed * size);
        for (size_t k = 0; k < N; k++)
            m[k] = p[(NY - 1 - k / NX) * NX + k % NX];
        slice(m, options(boundary, 0.3, 0.2), z, &b);
        for (int i = 0; i < RC_COMPONENTS; i++)
            for (size_t k = 0; k < N; k++)
                assert_true(fabs(b.s[i][(NY - 1 - k / NX) * NX + k % NX] - in_y[i] * a.s[i][k]) <=
                            summed * size);
        slice(p, options(boundary, 0.3, 0), z, &b);
        slice(p, options(boundary, 0.3, -0.4), z, &c);
        for (int i = 0; i < RC_COMPONENTS; i++)
            for (size_t k = 0; k < N; k++)
                assert_true(fabs(2 * (a.s[i][k] - b.s[i][k]) - (b.s[i][k] - c.s[i][k])) <=
                            summed * size);
    }
    field_free(&a);
    field_free(&b);
    field_free(&c);
    free(p);
    free(m);
}

/* The stresses of a contact in the middle of growing periodic maps converge to those of the free boundary,
 * including their mean. A cell holds the mean of a smooth pressure, and the waves receive the same: the
 * pressure plus d^2/24 of its Laplacian. */
static void
far_walls_do_not_matter(void **state)
{
    const double d = 1e-6, width = 8e-6;
    double off[3], *s[RC_STRESSES] = {NULL}, line[2][RC_COMPONENTS][512];

    (void)state;
    for (int grow = 0; grow < 3; grow++) {
        size_t m = (size_t)96 << grow;
        const struct rc_shape map = {m, m, d, d};
        double *p = malloc(m * m * sizeof *p);
        off[grow] = 0;
        for (int b = 0; b < 2; b++) {
            struct rc_stress_options o = options(b == 0 ? RC_FREE : RC_PERIODIC, 0.3, 0.3);
            struct rc_stress *stress;
            struct rc_err err;
            for (size_t k = 0; k < m * m; k++) {
                double r = node_r(map, k) / width, more = d * d / (6 * width * width) * (r * r - 1);
                p[k] = size * exp(-r * r) * (b == 1 ? 1 + more : 1);
            }
            o.section = 'y';
            stress = rc_stress_new(&map, p, &o, &err);
            for (int c = 0; c < RC_COMPONENTS; c++)
                s[c] = line[b][c];
            assert_int_equal(rc_stress_slice(stress, 6e-6, s, &err), RC_OK);
            rc_stress_free(stress);
        }
        for (int c = 0; c < RC_COMPONENTS; c++)
            off[grow] = fmax(off[grow], fabs(line[0][c][m / 2] - line[1][c][m / 2]) / size);
        free(p);
    }
    print_message("free against periodic: %.1e %.1e %.1e\n", off[0], off[1], off[2]);
    /* the effect of the images falls with the area of the map */
    assert_true(off[1] < off[0] / 3.5 && off[2] < off[1] / 3.5 && off[2] < 2e-4);
}

/* Invalid requests are refused, and the message names the value. */
static void
refused(void **state)
{
    const struct rc_stress_options fine = options(RC_FREE, 0.3, 0.1);
    struct rc_stress_options bad[9];
    static const char *const reason[] = {
        "Poisson's ratio 0.51", "Poisson's ratio -1", "friction coefficient inf",
        "components are empty", "empty or unknown",   "tolerance 1",
        "tolerance -0.1",       "the map ends at",    "there is no engine 'abacus'"};
    double *p = calloc(N, sizeof *p);
    struct rc_err err;

    (void)state;
    assert_non_null(p);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        bad[k] = fine;
    bad[0].body.nu = 0.51;
    bad[1].body.nu = -1;
    bad[2].mu = INFINITY;
    bad[3].wanted = 0;
    bad[4].wanted = 1u << RC_STRESSES;
    bad[5].tol = 1;
    bad[6].tol = -0.1;
    bad[7].section = 'x';
    bad[7].at = 0.51 * NX * shape.dx;
    bad[8].engine = "abacus";
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        assert_null(rc_stress_new(&shape, p, &bad[k], &err));
        if (strstr(err.text, reason[k]) == NULL)
            fail_msg("'%s' does not say '%s'", err.text, reason[k]);
    }
    free(p);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(in_equilibrium),
        cmocka_unit_test(sum_follows_poisson),
        cmocka_unit_test(every_layer_carries_the_load),
        cmocka_unit_test(the_window_catches_the_load),
        cmocka_unit_test(tractions_at_the_surface),
        cmocka_unit_test(uniform_and_plane),
        cmocka_unit_test(one_wave),
        cmocka_unit_test(mirrors_and_sums),
        cmocka_unit_test(far_walls_do_not_matter),
        cmocka_unit_test(refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
