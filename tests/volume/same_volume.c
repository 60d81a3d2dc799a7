/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Different ways to compute the same slabs agree: threads, precisions, rotated maps, slabs divided in two, an
 * explicit sum of plane waves. Omitting components does not change the others. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "volume_case.h"

static const double h[] = {0.3e-6, 0.5e-6, 0.02e-6, 1.1e-6, 2e-6, 0.7e-6};
enum {
    SLABS = sizeof h / sizeof *h
};
/* Odd, even and prime sizes, profiles, split columns (64 and more), more nodes than one thread takes. */
static const struct rc_shape shapes[] = {
    {12, 9, 1e-6, 0.8e-6}, {13, 7, 1.1e-6, 1e-6},  {1, 23, 1e-6, 0.6e-6},
    {24, 1, 0.6e-6, 1e-6}, {2, 2, 1e-6, 1e-6},     {6, 64, 1e-6, 0.9e-6},
    {64, 6, 1.1e-6, 1e-6}, {61, 59, 1e-6, 0.7e-6}, {180, 128, 1e-6, 0.8e-6}};
enum {
    SHAPES = sizeof shapes / sizeof *shapes
};

static struct rc_slabs_options
options(size_t threads)
{
    return (struct rc_slabs_options){.boundary = RC_PERIODIC,
                                     .slabs = SLABS,
                                     .thickness = h,
                                     .shear = 8e10,
                                     .nu = 0.3,
                                     .whole = true,
                                     .threads = threads};
}

struct all {
    struct voxels e, s;
    double *p, *u;
};

static struct all
all_new(struct rc_shape s, uint64_t seed)
{
    size_t n = s.nx * s.ny;
    struct all a = {voxels_new(s, SLABS), voxels_new(s, SLABS), calloc(n, sizeof(double)),
                    calloc(n, sizeof(double))};

    voxels_random(&a.e, 0x3b, &seed); /* not the third */
    for (size_t i = 0; i < n; i++)
        a.p[i] = 1e8 * (0.7 + random_number(&seed));
    return a;
}

static void
all_free(struct all *a)
{
    free(a->e.v);
    free(a->s.v);
    free(a->p);
    free(a->u);
}

static void
all_run(struct all *a, struct rc_shape s, struct rc_slabs_options o)
{
    struct rc_slabs *v = volume_new(s, o);

    volume_apply(v, &a->e, NULL, a->p, a->u, &a->s);
    rc_slabs_free(v);
}

static double
apart(size_t n, const double *a, const double *b)
{
    double most = 0, size = 0;

    for (size_t i = 0; i < n; i++) {
        assert_true(isfinite(a[i]) && isfinite(b[i]));
        most = fmax(most, fabs(a[i] - b[i]));
        size = fmax(size, fabs(b[i]));
    }
    return size > 0 ? most / size : most;
}

/* Any number of threads gives the same bytes, and so does a plan that was used before. */
static void
for_any_threads(void **state)
{
    (void)state;
    for (size_t k = 0; k < SHAPES; k++) {
        size_t n = shapes[k].nx * shapes[k].ny, bytes = n * SLABS * RC_COMPONENTS * sizeof(double);
        struct all a = all_new(shapes[k], k), b = all_new(shapes[k], k);
        struct rc_slabs *v = volume_new(shapes[k], options(3));

        all_run(&a, shapes[k], options(1));
        for (int again = 0; again < 2; again++) {
            volume_apply(v, &b.e, NULL, b.p, b.u, &b.s);
            assert_memory_equal(a.u, b.u, n * sizeof *a.u);
            assert_memory_equal(a.s.v, b.s.v, bytes);
        }
        rc_slabs_free(v);
        all_free(&a);
        all_free(&b);
    }
}

/* Single precision agrees to its digits. Deviators equal those of the whole stress. */
static void
in_single_and_in_part(void **state)
{
    (void)state;
    for (size_t k = 0; k < SHAPES; k++) {
        size_t n = shapes[k].nx * shapes[k].ny;
        struct all a = all_new(shapes[k], k), b = all_new(shapes[k], k);
        struct rc_slabs_options o = options(2);

        all_run(&a, shapes[k], o);
        o.precision = RC_SINGLE;
        all_run(&b, shapes[k], o);
        assert_true(voxels_apart(&b.s, &a.s) < 2e-6);
        assert_true(voxels_apart(&b.s, &a.s) > 1e-9); /* and it was */
        assert_true(apart(n, b.u, a.u) < 2e-6);
        o = options(2);
        o.whole = false;
        all_run(&b, shapes[k], o);
        for (size_t m = 0; m < SLABS; m++)
            for (size_t i = 0; i < n; i++) {
                double mean = 0;
                for (int c = 0; c < RC_SXY; c++)
                    mean += voxels_map(&a.s, m, (enum rc_component)c)[i] / 3;
                for (int c = 0; c < RC_SXY; c++)
                    voxels_map(&a.s, m, (enum rc_component)c)[i] -= mean;
            }
        assert_true(voxels_apart(&b.s, &a.s) < rounding);
        assert_true(apart(n, b.u, a.u) == same);
        all_free(&a);
        all_free(&b);
    }
}

/* x and y are exchanged: the other side of the map is transformed as rows. */
static void
turned(void **state)
{
    static const enum rc_component other[] = {RC_SYY, RC_SXX, RC_SZZ, RC_SXY, RC_SYZ, RC_SXZ};

    (void)state;
    for (size_t k = 0; k < SHAPES; k++) {
        struct rc_shape s = shapes[k], t = {s.ny, s.nx, s.dy, s.dx};
        size_t n = s.nx * s.ny;
        struct all a = all_new(s, k), b = all_new(t, k), c = all_new(s, k);

        for (size_t i = 0; i < n; i++) {
            size_t to = i % s.nx * s.ny + i / s.nx;
            b.p[to] = a.p[i];
            for (size_t m = 0; m < SLABS; m++)
                for (int d = 0; d < RC_COMPONENTS; d++)
                    voxels_map(&b.e, m, other[d])[to] =
                        voxels_map(&a.e, m, (enum rc_component)d)[i];
        }
        all_run(&a, s, options(2));
        all_run(&b, t, options(2));
        for (size_t i = 0; i < n; i++) {
            size_t to = i % s.nx * s.ny + i / s.nx;
            c.u[i] = b.u[to];
            for (size_t m = 0; m < SLABS; m++)
                for (int d = 0; d < RC_COMPONENTS; d++)
                    voxels_map(&c.s, m, (enum rc_component)d)[i] =
                        voxels_map(&b.s, m, other[d])[to];
        }
        assert_true(voxels_apart(&c.s, &a.s) < rounding);
        assert_true(apart(n, c.u, a.u) < rounding);
        all_free(&a);
        all_free(&b);
        all_free(&c);
    }
}

/* A slab equals two halves with the same strain. Its stress is their mean: for one or several groups of slabs
 * in a sweep, and for thick and thin slabs. */
static void
split(void **state)
{
    enum {
        MORE = 4
    };

    (void)state;
    for (size_t k = 0; k < SHAPES; k++) {
        struct rc_shape s = shapes[k];
        size_t n = s.nx * s.ny;
        struct all a = all_new(s, k);
        struct voxels e = voxels_new(s, MORE * SLABS), fine = voxels_new(s, MORE * SLABS),
                      mean = voxels_new(s, SLABS);
        const double shares[MORE] = {0.4, 0.001, 0.099, 0.5};
        double thick[MORE * SLABS], *u = calloc(n, sizeof *u);
        struct rc_slabs_options o = options(2);
        struct rc_slabs *v;

        for (size_t m = 0; m < MORE * SLABS; m++) {
            thick[m] = h[m / MORE] * shares[m % MORE];
            memcpy(voxels_map(&e, m, RC_SXX), voxels_map(&a.e, m / MORE, RC_SXX),
                   n * RC_COMPONENTS * sizeof(double));
        }
        o.slabs = MORE * SLABS;
        o.thickness = thick;
        v = volume_new(s, o);
        volume_apply(v, &e, NULL, a.p, u, &fine);
        rc_slabs_free(v);
        for (size_t m = 0; m < MORE * SLABS; m++)
            for (size_t i = 0; i < n * RC_COMPONENTS; i++)
                voxels_map(&mean, m / MORE, RC_SXX)[i] +=
                    shares[m % MORE] * voxels_map(&fine, m, RC_SXX)[i];
        all_run(&a, s, options(2));
        assert_true(voxels_apart(&mean, &a.s) < rounding);
        assert_true(apart(n, u, a.u) < rounding);
        all_free(&a);
        free(e.v);
        free(fine.v);
        free(mean.v);
        free(u);
    }
}

/* Slabs marked as without strain are not read, and slabs that are not requested are not returned; the others
 * do not change by a bit. After `down` there is no strain. */
struct picky {
    struct all *all;
    const bool *strained, *wanted;
    size_t last; /* slab handed out */
};

static bool
picky_strain(void *ctx, size_t slab, enum rc_component c, size_t j, double *row)
{
    struct picky *p = ctx;

    if (!p->strained[slab] || c == RC_SZZ)
        abort();
    return voxels_strain(&p->all->e, slab, c, j, row);
}

static void
picky_stress(void *ctx, size_t slab, size_t j, double *const s[RC_COMPONENTS])
{
    struct picky *p = ctx;

    if (!p->wanted[slab] || slab < p->last)
        abort();
    p->last = slab;
    voxels_stress(&p->all->s, slab, j, s);
}

static void
only_what_is_asked(void **state)
{
    static const bool strained[][SLABS] = {{true, true, false, true, true, true},
                                           {true, false, false, false, false, false},
                                           {false, false, false, true, false, false},
                                           {false, false, false, false, false, false}};
    static const bool wanted[][SLABS] = {{true, false, true, false, false, true},
                                         {false, false, false, false, true, false},
                                         {true, true, false, false, false, false}};

    (void)state;
    for (size_t k = 0; k < SHAPES; k++)
        for (size_t m = 0; m < 12; m++) {
            struct rc_shape s = shapes[k];
            size_t n = s.nx * s.ny;
            struct all a = all_new(s, k), b = all_new(s, k), none = all_new(s, k);
            struct picky picky = {&b, strained[m % 4], wanted[m / 4], 0};
            struct rc_slab_strain strain = {picky.strained, picky_strain, &picky};
            struct rc_slab_stress stress = {picky.wanted, picky_stress, &picky};
            struct rc_slabs *v = volume_new(s, options(1));

            for (size_t i = 0; i < SLABS; i++)
                if (!picky.strained[i])
                    memset(voxels_map(&a.e, i, RC_SXX), 0, n * RC_COMPONENTS * sizeof(double));
            all_run(&a, s, options(1));
            rc_slabs_up(v, &strain, b.u);
            rc_slabs_down(v, b.p, &stress);
            assert_true(apart(n, b.u, a.u) == same);
            for (size_t i = 0; i < SLABS; i++)
                assert_true(!picky.wanted[i] ||
                            apart(n * RC_COMPONENTS, voxels_map(&b.s, i, RC_SXX),
                                  voxels_map(&a.s, i, RC_SXX)) == same);
            memset(none.e.v, 0, n * SLABS * RC_COMPONENTS * sizeof(double));
            all_run(&none, s, options(1)); /* zero strain, and no strain */
            volume_apply(v, NULL, NULL, b.p, NULL, &b.s);
            assert_true(voxels_apart(&b.s, &none.s) == same);
            rc_slabs_free(v);
            all_free(&a);
            all_free(&b);
            all_free(&none);
        }
}

/* The displacement as a sum over waves, with the closed form of a sheet of strain integrated over depth by
 * quadrature. u = - exp(-qz) [ss + zz + 2 nu tt + qz (zz - ss - 2 sz)] e dz. */
static void
of_plane_waves(void **state)
{
    enum {
        MANY = 400 /* points of the midpoint rule in t, with x = t^3 (10 - 15 t + 6 t^2) */
    };
    const double nu = 0.3;

    (void)state;
    for (size_t k = 0; k + 1 < SHAPES; k++) {
        struct rc_shape s = shapes[k];
        size_t n = s.nx * s.ny;
        struct all a = all_new(s, k);
        double *u = calloc(n, sizeof *u), z0 = 0, most = 0;
        double complex *turn_x = calloc(s.nx, sizeof *turn_x),
                       *turn_y = calloc(s.ny, sizeof *turn_y);

        all_run(&a, s, options(2));
        for (size_t i = 0; i < s.nx; i++)
            turn_x[i] = cexp(2 * exact_pi * I * (double)i / (double)s.nx);
        for (size_t j = 0; j < s.ny; j++)
            turn_y[j] = cexp(2 * exact_pi * I * (double)j / (double)s.ny);
        for (size_t w = 1; w < n; w++) {
            size_t kx = w % s.nx, ky = w / s.nx;
            double qx = rc_fourier_q(kx, s.nx, s.dx), qy = rc_fourier_q(ky, s.ny, s.dy);
            double q = hypot(qx, qy), c = qx / q, d = qy / q;
            double complex sum = 0;
            if (2 * kx == s.nx || 2 * ky == s.ny)
                continue;
            z0 = 0;
            for (size_t m = 0; m < SLABS; m++) {
                double complex e[RC_COMPONENTS] = {0}, ss, tt, sz;
                double flat = 0, deep = 0;
                for (size_t i = 0; i < n; i++)
                    for (int b = 0; b < RC_COMPONENTS; b++)
                        e[b] += voxels_map(&a.e, m, (enum rc_component)b)[i] *
                                conj(turn_x[i % s.nx * kx % s.nx] * turn_y[i / s.nx * ky % s.ny]);
                for (size_t g = 0; g < MANY; g++) {
                    double t = ((double)g + 0.5) / MANY, by = 30 * t * t * (1 - t) * (1 - t);
                    double z = z0 + h[m] * t * t * t * (10 - 15 * t + 6 * t * t);
                    flat += by * h[m] / MANY * exp(-q * z);
                    deep += by * h[m] / MANY * exp(-q * z) * q * z;
                }
                ss = c * c * e[RC_SXX] + d * d * e[RC_SYY] + 2 * c * d * e[RC_SXY];
                tt = d * d * e[RC_SXX] + c * c * e[RC_SYY] - 2 * c * d * e[RC_SXY];
                sz = -I * (c * e[RC_SXZ] + d * e[RC_SYZ]);
                sum -= flat * (ss + e[RC_SZZ] + 2 * nu * tt) + deep * (e[RC_SZZ] - ss - 2 * sz);
                z0 += h[m];
            }
            for (size_t i = 0; i < n; i++)
                u[i] += creal(sum * turn_x[i % s.nx * kx % s.nx] * turn_y[i / s.nx * ky % s.ny]) /
                        (double)n;
        }
        for (size_t i = 0; i < n; i++)
            most = fmax(most, fabs(u[i]));
        print_message("%zu x %zu: %.1e\n", s.nx, s.ny, apart(n, a.u, u));
        assert_true(apart(n, a.u, u) < 1e-8); /* error of the quadrature */
        assert_true(most > 0 || n == 4);
        all_free(&a);
        free(u);
        free(turn_x);
        free(turn_y);
        if (n > 400) /* the sums are long */
            break;
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(for_any_threads),
                                       cmocka_unit_test(in_single_and_in_part),
                                       cmocka_unit_test(turned),
                                       cmocka_unit_test(split),
                                       cmocka_unit_test(only_what_is_asked),
                                       cmocka_unit_test(of_plane_waves)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
