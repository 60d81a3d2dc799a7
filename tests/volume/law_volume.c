/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws of strain in slabs: reciprocity, symmetry, bounds of the stiffness with and without contact,
 * equilibrium, and a free surface. Every plane carries the load. The predicted memory is checked too. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

#include "volume_case.h"

static double *
random_pressure(size_t n, double mean, uint64_t *seed)
{
    double *p = calloc(n, sizeof *p), sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += p[i] = 1e8 * random_number(seed);
    for (size_t i = 0; i < n; i++)
        p[i] += mean - sum / (double)n;
    return p;
}

static const double h[] = {0.3e-6, 0.5e-6, 0.02e-6, 1.1e-6, 2e-6, 0.7e-6};
enum {
    SLABS = sizeof h / sizeof *h
};

/* p . u(e) = e . S p for every p without a mean, a . G b = b . G a, a . G a > 0. */
static void
is_reciprocal(void **state)
{
    static const struct rc_shape shapes[] = {{15, 12, 1e-6, 0.8e-6}, {13, 7, 1.1e-6, 1e-6},
                                             {1, 23, 1e-6, 0.6e-6},  {24, 1, 0.6e-6, 1e-6},
                                             {3, 2, 1e-6, 1e-6},     {6, 64, 1e-6, 1e-6}};

    (void)state;
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
        struct rc_shape s = shapes[k];
        size_t n = s.nx * s.ny;
        uint64_t seed = 7 + k;
        struct rc_slabs *v = volume_new(
            s,
            (struct rc_slabs_options){
                .boundary = RC_PERIODIC, .slabs = SLABS, .thickness = h, .shear = 8e10, .nu = 0.3});
        struct voxels a = voxels_new(s, SLABS), b = voxels_new(s, SLABS), ga = voxels_new(s, SLABS),
                      gb = voxels_new(s, SLABS), sp = voxels_new(s, SLABS);
        double *p = random_pressure(n, 0, &seed), *u = calloc(n, sizeof *u), pu = 0, size = 0;
        double asp, agb, bga, aga, bgb;

        voxels_random(&a, 0x2f, &seed);
        voxels_random(&b, 0x3d, &seed);
        volume_apply(v, &a, NULL, NULL, u, &ga);
        volume_apply(v, &b, NULL, NULL, NULL, &gb);
        volume_apply(v, NULL, NULL, p, NULL, &sp);
        for (size_t i = 0; i < n; i++) {
            pu += p[i] * u[i];
            size += fabs(p[i] * u[i]);
        }
        asp = voxels_product(&a, &sp, h);
        agb = voxels_product(&a, &gb, h);
        bga = voxels_product(&b, &ga, h);
        aga = voxels_product(&a, &ga, h);
        bgb = voxels_product(&b, &gb, h);
        print_message("%zu x %zu: %.1e, %.1e\n", s.nx, s.ny, (pu - asp) / size,
                      (agb - bga) / sqrt(aga * bgb));
        assert_true(size > 0 && fabs(pu - asp) < rounding * size);
        assert_true(aga < 0 && bgb < 0); /* stress is -G e */
        assert_true(fabs(agb - bga) < rounding * sqrt(aga * bgb));
        rc_slabs_free(v);
        free(a.v);
        free(b.v);
        free(ga.v);
        free(gb.v);
        free(sp.v);
        free(p);
        free(u);
    }
}

/* Adds `size` times unit deviator number m (of five) to the strain of a voxel. */
static void
add_unit(const struct voxels *e, size_t slab, size_t i, size_t m, double size)
{
    static const double of[5][6] = {
        {0.70710678118654752, -0.70710678118654752, 0, 0, 0, 0},
        {0.40824829046386302, 0.40824829046386302, -0.81649658092772603, 0, 0, 0},
        {0, 0, 0, 0.70710678118654752, 0, 0},
        {0, 0, 0, 0, 0.70710678118654752, 0},
        {0, 0, 0, 0, 0, 0.70710678118654752}};

    for (int c = 0; c < RC_COMPONENTS; c++)
        voxels_map(e, slab, (enum rc_component)c)[i] += size * of[m][c];
}

static double
along_unit(const struct voxels *s, size_t slab, size_t i, size_t m)
{
    struct voxels one = {1, 1, 1, (double[RC_COMPONENTS]){0}};
    double sum = 0;

    add_unit(&one, 0, 0, m, 1);
    for (int c = 0; c < RC_COMPONENTS; c++)
        sum += (c < RC_SXY ? 1 : 2) * one.v[c] * voxels_map(s, slab, (enum rc_component)c)[i];
    return sum;
}

/* Eigenvalues of G, and of G + S K_cc^-1 S' for sets c of nodes in contact, lie between 0 and 2 mu, for all
 * voxels of a small stack. c may be any set. K belongs to the same body. */
static void
is_bounded(void **state)
{
    static const struct rc_shape shape = {5, 3, 1e-6, 0.7e-6};
    enum {
        NODES = 15,
        ALL = NODES * SLABS * 5
    };
    const double shear = 8e10, nus[] = {0.3, 0.5, 0};
    static const unsigned contact[] = {0, 1, 0x1f, 0x5555, 0x3fff}; /* bits: nodes */

    (void)state;
    for (size_t k = 0; k < sizeof nus / sizeof *nus; k++) {
        struct rc_slabs *v = volume_new(shape, (struct rc_slabs_options){.boundary = RC_PERIODIC,
                                                                         .slabs = SLABS,
                                                                         .thickness = h,
                                                                         .shear = shear,
                                                                         .nu = nus[k],
                                                                         .whole = true});
        struct voxels e = voxels_new(shape, SLABS), s = voxels_new(shape, SLABS);
        const struct rc_conv_options o = {.boundary = RC_PERIODIC, .engine = "fft64"};
        struct rc_conv *conv =
            rc_conv_new(&shape, &(struct rc_pair){.estar = 2 * shear / (1 - nus[k])}, &o, NULL);
        gsl_matrix *g = gsl_matrix_alloc(ALL, ALL), *down = gsl_matrix_alloc(NODES, ALL);
        gsl_vector *values = gsl_vector_alloc(ALL);
        gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(ALL);
        double compliance[NODES][NODES], u[NODES], odd = 0;

        for (size_t j = 0; j < NODES; j++) {
            double p[NODES] = {0};
            p[j] = 1;
            rc_conv_apply(conv, p, compliance[j]);
        }
        for (size_t j = 0; j < ALL; j++) { /* in units in which each voxel weighs the same */
            size_t slab = j / (NODES * 5), node = j / 5 % NODES;
            memset(e.v, 0, e.n * SLABS * RC_COMPONENTS * sizeof *e.v);
            add_unit(&e, slab, node, j % 5, 1 / sqrt(h[slab]));
            volume_apply(v, &e, NULL, NULL, u, &s);
            for (size_t i = 0; i < ALL; i++) {
                size_t to = i / (NODES * 5);
                gsl_matrix_set(
                    g, i, j, -along_unit(&s, to, i / 5 % NODES, i % 5) * sqrt(h[to]) / (2 * shear));
            }
            for (size_t i = 0; i < NODES; i++)
                gsl_matrix_set(down, i, j, u[i] / sqrt(2 * shear));
        }
        for (size_t i = 0; i < ALL; i++)
            for (size_t j = 0; j < i; j++)
                odd = fmax(odd, fabs(gsl_matrix_get(g, i, j) - gsl_matrix_get(g, j, i)));
        assert_true(odd < rounding);
        for (size_t set = 0; set < sizeof contact / sizeof *contact; set++) {
            gsl_matrix *sum = gsl_matrix_alloc(ALL, ALL);
            double low, high;
            gsl_matrix_memcpy(sum, g);
            if (contact[set] != 0) {
                size_t in[NODES], n = 0;
                gsl_matrix *stiff, *part;
                for (size_t i = 0; i < NODES; i++)
                    if (contact[set] >> i & 1)
                        in[n++] = i;
                stiff = gsl_matrix_alloc(n, n);
                part = gsl_matrix_alloc(n, ALL);
                for (size_t i = 0; i < n; i++) {
                    for (size_t j = 0; j < n; j++)
                        gsl_matrix_set(stiff, i, j, compliance[in[j]][in[i]]);
                    for (size_t j = 0; j < ALL; j++)
                        gsl_matrix_set(part, i, j, gsl_matrix_get(down, in[i], j));
                }
                gsl_linalg_cholesky_decomp1(stiff); /* part <- L^-1 part; sum += part' part */
                gsl_blas_dtrsm(CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, 1, stiff, part);
                gsl_blas_dgemm(CblasTrans, CblasNoTrans, 1, part, part, 1, sum);
                gsl_matrix_free(stiff);
                gsl_matrix_free(part);
            }
            gsl_eigen_symm(sum, values, work);
            gsl_vector_minmax(values, &low, &high);
            print_message("nu %g, contact %#x: %.1e to 1 %+.1e\n", nus[k], contact[set], low,
                          high - 1);
            assert_true(low > -summed && high < 1 + summed);
            assert_true(high > 0.9); /* and the bound is nearly reached */
            gsl_matrix_free(sum);
        }
        gsl_eigen_symm_free(work);
        gsl_vector_free(values);
        gsl_matrix_free(g);
        gsl_matrix_free(down);
        rc_conv_free(conv);
        rc_slabs_free(v);
        free(e.v);
        free(s.v);
    }
}

/* ---- equilibrium ---- */

/* d/dx at node i of a periodic line of n values, n odd, with all its waves. */
static double
slope(const double *m, size_t step, size_t n, size_t i, double d)
{
    double sum = 0;

    for (size_t j = 0; j < n; j++) {
        long r = (long)i - (long)j;
        if (r != 0)
            sum +=
                (r % 2 == 0 ? 1 : -1) * m[j * step] / (2 * sin(exact_pi * (double)r / (double)n));
    }
    return sum * 2 * exact_pi / ((double)n * d);
}

/* Mean stresses of equal slabs without strain, between slabs with strain: d sxi/dx + d syi/dy + d szi/dz = 0,
 * by differences of tenth order. The surface is free, or carries p: a slab of no thickness on top. */
static void
in_equilibrium(void **state)
{
    enum {
        FIRST = 3,
        THIN = 11,
        MANY = FIRST + THIN + 2
    };
    static const struct rc_shape shape = {13, 11, 1e-6, 0.9e-6};
    static const double by[] = {5. / 6, -5. / 21, 5. / 84, -5. / 504, 1. / 1260};
    static const int of[3][3] = {
        {RC_SXX, RC_SXY, RC_SXZ}, {RC_SXY, RC_SYY, RC_SYZ}, {RC_SXZ, RC_SYZ, RC_SZZ}};
    double thick[MANY] = {1e-13, 0.3e-6, 1e-6}, off = 0, most = 0, loose = 0, large = 0, *p;
    struct voxels e = voxels_new(shape, MANY), s = voxels_new(shape, MANY);
    struct rc_slabs *v;
    uint64_t seed = 2;
    size_t n = shape.nx * shape.ny, mid = FIRST + THIN / 2;

    (void)state;
    for (size_t k = FIRST; k < MANY; k++)
        thick[k] = k < FIRST + THIN ? 0.05e-6 : 0.8e-6;
    v = volume_new(shape, (struct rc_slabs_options){.boundary = RC_PERIODIC,
                                                    .slabs = MANY,
                                                    .thickness = thick,
                                                    .shear = 8e10,
                                                    .nu = 0.3,
                                                    .whole = true});
    voxels_random(&e, 0xc007, &seed); /* the last two, and the first three */
    p = random_pressure(n, 3e7, &seed);
    volume_apply(v, &e, NULL, p, NULL, &s);
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < n; i++) {
            size_t x = i % shape.nx, y = i / shape.nx;
            double a = slope(voxels_map(&s, mid, (enum rc_component)of[c][0]) + y * shape.nx, 1,
                             shape.nx, x, shape.dx);
            double b = slope(voxels_map(&s, mid, (enum rc_component)of[c][1]) + x, shape.nx,
                             shape.ny, y, shape.dy);
            double d = 0;
            for (size_t m = 1; m <= 5; m++)
                d += by[m - 1] / thick[FIRST] *
                     (voxels_map(&s, mid + m, (enum rc_component)of[c][2])[i] -
                      voxels_map(&s, mid - m, (enum rc_component)of[c][2])[i]);
            off = fmax(off, fabs(a + b + d));
            most = fmax(most, fabs(a) + fabs(b) + fabs(d));
        }
    print_message("div sigma %.1e of its terms\n", off / most);
    assert_true(off < 1e-8 * most);
    for (size_t i = 0; i < n; i++) {
        loose = fmax(loose, fabs(voxels_map(&s, 0, RC_SZZ)[i] + p[i]));
        loose = fmax(loose, fabs(voxels_map(&s, 0, RC_SXZ)[i]));
        loose = fmax(loose, fabs(voxels_map(&s, 0, RC_SYZ)[i]));
        large = fmax(large, fabs(voxels_map(&s, 0, RC_SXX)[i]));
    }
    print_message("traction off by %.1e of sxx\n", loose / large);
    assert_true(loose < 1e-6 * large);  /* 1e-13 m, waves of 2e-6 m */
    for (size_t k = 0; k < MANY; k++) { /* the load of every plane */
        static const enum rc_component across[] = {RC_SZZ, RC_SXZ, RC_SYZ};
        for (size_t c = 0; c < 3; c++) {
            double sum = 0, size = 0;
            for (size_t i = 0; i < n; i++) {
                sum += voxels_map(&s, k, across[c])[i] + (c == 0 ? p[i] : 0);
                size += fabs(voxels_map(&s, k, across[c])[i]) + fabs(p[i]);
            }
            assert_true(fabs(sum) < of_sum * size);
        }
    }
    rc_slabs_free(v);
    free(e.v);
    free(s.v);
    free(p);
}

/* Uniform strain does not displace the surface and causes the stress of slabs constrained in their plane, in
 * closed form. */
static void
mean_is_local(void **state)
{
    static const struct rc_shape shape = {6, 5, 1e-6, 1e-6};
    const double nu = 0.3, shear = 8e10, e1 = 1.1e-3, e2 = -0.7e-3, e3 = 0.4e-3;
    struct voxels e = voxels_new(shape, SLABS), s = voxels_new(shape, SLABS);
    struct rc_slabs *v = volume_new(shape, (struct rc_slabs_options){.boundary = RC_PERIODIC,
                                                                     .slabs = SLABS,
                                                                     .thickness = h,
                                                                     .shear = shear,
                                                                     .nu = nu,
                                                                     .whole = true});
    double u[30], held = nu / (1 - nu) * (e1 + e2);

    (void)state;
    for (size_t i = 0; i < 30; i++) {
        voxels_map(&e, 1, RC_SXX)[i] = e1;
        voxels_map(&e, 1, RC_SYY)[i] = e2;
        voxels_map(&e, 1, RC_SXY)[i] = e3;
        voxels_map(&e, 1, RC_SXZ)[i] = e3;
    }
    volume_apply(v, &e, NULL, NULL, u, &s);
    for (size_t k = 0; k < SLABS; k++)
        for (size_t i = 0; i < 30; i++) {
            const double should[RC_COMPONENTS] = {
                -2 * shear * (e1 + held), -2 * shear * (e2 + held), 0, -2 * shear * e3, 0, 0};
            for (int c = 0; c < RC_COMPONENTS; c++)
                assert_true(fabs(voxels_map(&s, k, (enum rc_component)c)[i] -
                                 (k == 1 ? should[c] : 0)) < rounding * shear * e1);
            assert_true(fabs(u[i]) < rounding * e1 * h[1]);
        }
    rc_slabs_free(v);
    free(e.v);
    free(s.v);
}

/* Invalid numbers are refused, and the message has the number. */
static void
refuses(void **state)
{
    static const double bad[] = {1e-6, -1e-6};
    static const struct rc_shape shape = {8, 8, 1e-6, 1e-6};
    static const struct {
        struct rc_slabs_options o;
        const char *says;
    } cases[] = {{{.slabs = 0, .thickness = h, .shear = 8e10, .nu = 0.3}, "0 slabs"},
                 {{.slabs = 2, .thickness = bad, .shear = 8e10, .nu = 0.3}, "slab 2 is -1e-06 m"},
                 {{.slabs = 2, .thickness = h, .shear = 0, .nu = 0.3}, "shear modulus 0"},
                 {{.slabs = 2, .thickness = h, .shear = NAN, .nu = 0.3}, "shear modulus nan"},
                 {{.slabs = 2, .thickness = h, .shear = 8e10, .nu = 0.51}, "ratio 0.51"},
                 {{.slabs = 2, .thickness = h, .shear = 8e10, .nu = -1}, "ratio -1"}};

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct rc_err err = {""};
        assert_null(rc_slabs_new(&shape, &cases[k].o, &err));
        assert_non_null(strstr(err.text, cases[k].says));
    }
    assert_null(rc_slabs_new(
        &(struct rc_shape){0, 3, 1, 1},
        &(struct rc_slabs_options){
            .boundary = RC_PERIODIC, .slabs = 2, .thickness = h, .shear = 8e10, .nu = 0.3},
        NULL));
}

/* A free map is computed as the corner of a larger periodic map with zeros around it. */
static void
padded(void **state)
{
    enum {
        PAD_SLABS = 3
    };
    const struct rc_shape small = {13, 11, 1.1, 0.9}, large = {28, 24, 1.1, 0.9};
    const double thick[PAD_SLABS] = {0.5, 0.8, 0.6};
    struct rc_slabs_options o = {.boundary = RC_PERIODIC,
                                 .slabs = PAD_SLABS,
                                 .thickness = thick,
                                 .shear = 3,
                                 .nu = 0.3,
                                 .whole = true};
    struct voxels e = voxels_new(small, PAD_SLABS), wide = voxels_new(large, PAD_SLABS);
    struct voxels s = voxels_new(small, PAD_SLABS), t = voxels_new(large, PAD_SLABS);
    double p[13 * 11], q[28 * 24] = {0}, u[13 * 11], w[28 * 24], most = 0, size = 0;
    struct rc_slabs *v = volume_new(large, o), *n;
    uint64_t seed = 3;

    (void)state;
    o.boundary = RC_FREE;
    n = volume_new(small, o);
    voxels_random(&e, 0x7, &seed);
    for (size_t j = 0; j < small.ny; j++)
        for (size_t i = 0; i < small.nx; i++) {
            p[j * small.nx + i] = 1e-3 * random_number(&seed);
            q[j * large.nx + i] = p[j * small.nx + i];
            for (size_t k = 0; k < PAD_SLABS; k++)
                for (int c = 0; c < RC_COMPONENTS; c++)
                    voxels_map(&wide, k, (enum rc_component)c)[j * large.nx + i] =
                        voxels_map(&e, k, (enum rc_component)c)[j * small.nx + i];
        }
    volume_apply(v, &wide, NULL, q, w, &t);
    volume_apply(n, &e, NULL, p, u, &s);
    for (size_t j = 0; j < small.ny; j++)
        for (size_t i = 0; i < small.nx; i++) {
            size_t at = j * small.nx + i, there = j * large.nx + i;
            assert_true(fabs(u[at] - w[there]) < 1e-14);
            for (size_t k = 0; k < PAD_SLABS; k++)
                for (int c = 0; c < RC_COMPONENTS; c++) {
                    double is = voxels_map(&s, k, (enum rc_component)c)[at];
                    most = fmax(most, fabs(is - voxels_map(&t, k, (enum rc_component)c)[there]));
                    size = fmax(size, fabs(is));
                }
        }
    assert_true(most < 1e-13 * size);
    rc_slabs_free(v);
    rc_slabs_free(n);
    free(e.v);
    free(wide.v);
    free(s.v);
    free(t.v);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(padded),        cmocka_unit_test(is_reciprocal),
        cmocka_unit_test(is_bounded),    cmocka_unit_test(in_equilibrium),
        cmocka_unit_test(mean_is_local), cmocka_unit_test(refuses)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
