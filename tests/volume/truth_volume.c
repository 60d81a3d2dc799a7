/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stresses and displacements by strain in slabs and by pressure agree with finite elements in depth. They
 * agree with point stresses averaged by quadrature, and with Eshelby's sphere. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <complex.h>

#include "volume_case.h"

/* ---- finite elements in depth, a wave vector at a time ---- */

enum {
    DEGREE = 10,
    POINTS = 12,
    BAND = 3 * (DEGREE + 1)
};

/* Displacements u(z) exp(i (qx x + qy y)) of a half-space with eigenstrain in slabs, clamped at a depth where
 * they have decayed. The elements use neither rotated axes nor exponentials in depth. */
struct beam {
    double qx, qy, nu, shear;
    size_t elements, nodes;
    double *z; /* elements + 1 */
    size_t *slab;
    long double complex *a, *u; /* band of the stiffness; load, then displacements */
};

/* Gauss points and weights on [0, 1], by Newton's method on Legendre's polynomial. */
static void
gauss(size_t n, double *x, double *w)
{
    for (size_t k = 0; k < n; k++) {
        double t = cos(RC_PI * ((double)k + 0.75) / ((double)n + 0.5)), slope = 1;
        for (int i = 0; i < 50; i++) {
            double p0 = 1, p1 = t;
            for (size_t m = 2; m <= n; m++) {
                double p2 = ((2 * (double)m - 1) * t * p1 - ((double)m - 1) * p0) / (double)m;
                p0 = p1;
                p1 = p2;
            }
            slope = (double)n * (t * p1 - p0) / (t * t - 1);
            t -= p1 / slope;
        }
        x[k] = (1 + t) / 2;
        w[k] = 1 / ((1 - t * t) * slope * slope);
    }
}

/* Lagrange's polynomials on Chebyshev's points of [0, 1], and their slopes. */
static void
shapes(double t, double *value, double *slope)
{
    double at[DEGREE + 1];

    for (int i = 0; i <= DEGREE; i++)
        at[i] = (1 - cos(RC_PI * i / DEGREE)) / 2;
    for (int i = 0; i <= DEGREE; i++) {
        value[i] = 1;
        slope[i] = 0;
        for (int j = 0; j <= DEGREE; j++) {
            double term = 1 / (at[i] - at[j]);
            if (j == i)
                continue;
            value[i] *= (t - at[j]) * term;
            for (int k = 0; k <= DEGREE; k++)
                if (k != i && k != j)
                    term *= (t - at[k]) / (at[i] - at[k]);
            slope[i] += term;
        }
    }
}

/* Strain of unit displacement a of shape i: xx, yy, zz, xy, xz, yz. */
static void
unit_strain(const struct beam *b, int a, double value, double slope, double complex e[6])
{
    double complex x = I * b->qx * value, y = I * b->qy * value;

    memset(e, 0, 6 * sizeof *e);
    if (a == 0) {
        e[RC_SXX] = x;
        e[RC_SXY] = y / 2;
        e[RC_SXZ] = slope / 2;
    } else if (a == 1) {
        e[RC_SYY] = y;
        e[RC_SXY] = x / 2;
        e[RC_SYZ] = slope / 2;
    } else {
        e[RC_SZZ] = slope;
        e[RC_SXZ] = x / 2;
        e[RC_SYZ] = y / 2;
    }
}

static void
hooke(const struct beam *b, const double complex e[6], double complex s[6])
{
    double lambda = 2 * b->shear * b->nu / (1 - 2 * b->nu);
    double complex trace = e[RC_SXX] + e[RC_SYY] + e[RC_SZZ];

    for (int c = 0; c < 6; c++)
        s[c] = 2 * b->shear * e[c] + (c < RC_SXY ? lambda * trace : 0);
}

static double complex
contract(const double complex s[6], const double complex e[6])
{
    double complex sum = 0;

    for (int c = 0; c < 6; c++)
        sum += (c < RC_SXY ? 1 : 2) * s[c] * conj(e[c]);
    return sum;
}

static struct beam
beam_new(double qx, double qy, double nu, double shear, size_t slabs, const double *h)
{
    const double q = hypot(qx, qy), longest = 1.2 / q;
    struct beam b = {.qx = qx, .qy = qy, .nu = nu, .shear = shear};
    double z = 0, x[POINTS], w[POINTS];

    b.z = malloc(4000 * sizeof *b.z);
    b.slab = malloc(4000 * sizeof *b.slab);
    b.z[0] = 0;
    for (size_t k = 0; k <= slabs; k++) {
        double thick = k < slabs ? h[k] : 32 / q;
        size_t parts = (size_t)ceil(thick / longest);
        for (size_t m = 0; m < parts; m++) {
            b.slab[b.elements++] = k;
            b.z[b.elements] = z + thick * (double)(m + 1) / (double)parts;
            assert_true(b.elements < 3999);
        }
        z += thick;
    }
    b.nodes = b.elements * DEGREE + 1;
    b.a = calloc(3 * b.nodes * BAND, sizeof *b.a);
    b.u = calloc(3 * b.nodes, sizeof *b.u);
    gauss(POINTS, x, w);
    for (size_t m = 0; m < b.elements; m++)
        for (int g = 0; g < POINTS; g++) {
            double value[DEGREE + 1], slope[DEGREE + 1], l = b.z[m + 1] - b.z[m];
            double complex e[BAND][6], s[6];
            shapes(x[g], value, slope);
            for (int i = 0; i < BAND; i++)
                unit_strain(&b, i % 3, value[i / 3], slope[i / 3] / l, e[i]);
            for (int j = 0; j < BAND; j++) {
                hooke(&b, e[j], s);
                for (int i = j; i < BAND; i++)
                    b.a[(3 * DEGREE * m + (size_t)i) * BAND + (size_t)(i - j)] +=
                        w[g] * l * contract(s, e[i]);
            }
        }
    return b;
}

static void
beam_free(struct beam *b)
{
    free(b->z);
    free(b->slab);
    free(b->a);
    free(b->u);
}

/* Solves for strains e[slab] (six numbers each) and a pressure, by L D L^H of the band. */
static void
beam_solve(struct beam *b, size_t slabs, double complex (*e)[6], double complex p)
{
    double x[POINTS], w[POINTS];
    size_t n = 3 * (b->nodes - 1);

    gauss(POINTS, x, w);
    b->u[2] += p;
    for (size_t m = 0; m < b->elements; m++) {
        double value[DEGREE + 1], slope[DEGREE + 1], l = b->z[m + 1] - b->z[m];
        double complex own[6], s[6];
        if (b->slab[m] == slabs)
            break;
        hooke(b, e[b->slab[m]], s);
        for (int g = 0; g < POINTS; g++) {
            shapes(x[g], value, slope);
            for (int i = 0; i < BAND; i++) {
                unit_strain(b, i % 3, value[i / 3], slope[i / 3] / l, own);
                b->u[3 * DEGREE * m + (size_t)i] += w[g] * l * contract(s, own);
            }
        }
    }
    for (size_t j = 0; j < n; j++) { /* a[i][i - j] */
        size_t end = j + BAND < n ? j + BAND : n;
        for (size_t i = j + 1; i < end; i++) {
            long double complex f = b->a[i * BAND + i - j] / b->a[j * BAND];
            for (size_t k = i; k < end; k++)
                b->a[k * BAND + k - i] -= b->a[k * BAND + k - j] * conjl(f);
            b->u[i] -= f * b->u[j];
        }
    }
    for (size_t j = n; j-- > 0;) {
        size_t end = j + BAND < n ? j + BAND : n;
        b->u[j] /= b->a[j * BAND];
        for (size_t i = j + 1; i < end; i++)
            b->u[j] -= conjl(b->a[i * BAND + i - j] / b->a[j * BAND]) * b->u[i];
    }
    for (size_t i = n; i < n + 3; i++)
        b->u[i] = 0;
}

/* Mean stress of a slab, from the elastic strain. */
static void
beam_stress(const struct beam *b, size_t slab, const double complex own[6], double complex mean[6])
{
    double x[POINTS], w[POINTS], thick = 0;

    gauss(POINTS, x, w);
    memset(mean, 0, 6 * sizeof *mean);
    for (size_t m = 0; m < b->elements; m++) {
        double value[DEGREE + 1], slope[DEGREE + 1], l = b->z[m + 1] - b->z[m];
        if (b->slab[m] != slab)
            continue;
        thick += l;
        for (int g = 0; g < POINTS; g++) {
            double complex e[6] = {0}, one[6], s[6];
            shapes(x[g], value, slope);
            for (int i = 0; i < BAND; i++) {
                unit_strain(b, i % 3, value[i / 3], slope[i / 3] / l, one);
                for (int c = 0; c < 6; c++)
                    e[c] += (double complex)b->u[3 * DEGREE * m + (size_t)i] * one[c];
            }
            for (int c = 0; c < 6; c++)
                e[c] -= own[c];
            hooke(b, e, s);
            for (int c = 0; c < 6; c++)
                mean[c] += w[g] * l * s[c];
        }
    }
    for (int c = 0; c < 6; c++)
        mean[c] /= thick;
}

/* Adds the real part of a wave to a map. */
static void
add_wave(struct rc_shape s, long kx, long ky, double complex size, double *map)
{
    for (size_t j = 0; j < s.ny; j++)
        for (size_t i = 0; i < s.nx; i++)
            map[j * s.nx + i] += creal(size * cexp(2 * RC_PI * I *
                                                   ((double)(kx * (long)i) / (double)s.nx +
                                                    (double)(ky * (long)j) / (double)s.ny)));
}

static double complex
random_complex(uint64_t *seed)
{
    double re = random_number(seed), im = random_number(seed);

    return CMPLX(re, im);
}

/* The cases are several waves of strain in slabs of very different thickness, and waves of pressure. Some
 * slabs have no strain, and there is more than one group. */
static void
equals_elements(void **state)
{
    static const struct {
        struct rc_shape shape;
        double nu;
        long k[6][2];
    } cases[] = {
        {{12, 10, 1.1e-6, 0.7e-6}, 0.3, {{1, 0}, {0, 2}, {3, -4}, {5, 1}, {2, 3}, {4, 4}}},
        {{17, 1, 0.4e-6, 3e-6}, 0.12, {{1, 0}, {3, 0}, {5, 0}, {7, 0}, {8, 0}, {2, 0}}},
        {{1, 14, 0.4e-6, 3e-6}, 0.45, {{0, 1}, {0, 2}, {0, 5}, {0, 6}, {0, 3}, {0, 4}}},
        {{7, 128, 5e-6, 1e-6}, -0.2, {{1, 60}, {3, -63}, {2, 0}, {0, 7}, {3, 33}, {1, -2}}}};
    static const double h[] = {1e-8, 0.5e-6, 0.35e-6, 2.2e-6, 0.7e-6, 0.03e-6, 5e-6, 0.9e-6, 1e-6};
    enum {
        SLABS = sizeof h / sizeof *h
    };
    static const bool strained[SLABS] = {true, true, false, true, true, true, true, false, true};
    const double shear = 7.7e10;

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct rc_shape shape = cases[k].shape;
        size_t n = shape.nx * shape.ny;
        struct rc_slabs *v = volume_new(shape, (struct rc_slabs_options){.boundary = RC_PERIODIC,
                                                                         .slabs = SLABS,
                                                                         .thickness = h,
                                                                         .shear = shear,
                                                                         .nu = cases[k].nu,
                                                                         .whole = true});
        struct voxels e = voxels_new(shape, SLABS), s = voxels_new(shape, SLABS),
                      t = voxels_new(shape, SLABS);
        double *p = calloc(n, sizeof *p), *u = calloc(n, sizeof *u), *w = calloc(n, sizeof *w);
        double most = 0, off = 0;
        uint64_t seed = 1987 + k;

        for (int m = 0; m < 6; m++) {
            long kx = cases[k].k[m][0], ky = cases[k].k[m][1];
            double qx = 2 * RC_PI * (double)kx / ((double)shape.nx * shape.dx);
            double qy = 2 * RC_PI * (double)ky / ((double)shape.ny * shape.dy);
            double complex wave[SLABS][6] = {{0}}, mean[6];
            double complex load = 1e8 * random_complex(&seed);
            struct beam beam;
            for (size_t i = 0; i < SLABS; i++) {
                for (int c = 0; c < STRAINS && strained[i]; c++)
                    wave[i][strains[c]] = 1e-3 * random_complex(&seed);
                wave[i][RC_SZZ] = -wave[i][RC_SXX] - wave[i][RC_SYY];
                for (int c = 0; c < RC_COMPONENTS; c++)
                    add_wave(shape, kx, ky, wave[i][c], voxels_map(&e, i, (enum rc_component)c));
            }
            add_wave(shape, kx, ky, load, p);
            beam = beam_new(qx, qy, cases[k].nu, shear, SLABS, h);
            beam_solve(&beam, SLABS, wave, 0);
            add_wave(shape, kx, ky, (double complex)beam.u[2], w);
            beam_free(&beam);
            beam = beam_new(qx, qy, cases[k].nu, shear, SLABS, h);
            beam_solve(&beam, SLABS, wave, load);
            for (size_t i = 0; i < SLABS; i++) {
                beam_stress(&beam, i, wave[i], mean);
                for (int c = 0; c < RC_COMPONENTS; c++)
                    add_wave(shape, kx, ky, mean[c], voxels_map(&t, i, (enum rc_component)c));
            }
            beam_free(&beam);
        }
        volume_apply(v, &e, strained, p, u, &s);
        for (size_t i = 0; i < n; i++) {
            most = fmax(most, fabs(w[i]));
            off = fmax(off, fabs(u[i] - w[i]));
        }
        print_message("case %zu: u %.1e, stress %.1e\n", k, off / most, voxels_apart(&s, &t));
        assert_true(off < 1e-10 * most);
        assert_true(voxels_apart(&s, &t) < 1e-10);
        rc_slabs_free(v);
        free(e.v);
        free(s.v);
        free(t.v);
        free(p);
        free(u);
        free(w);
    }
}

/* ---- pressure ---- */

/* Stresses of pressure equal those of rc_stress at quadrature points, including the mean. Tested are odd and
 * prime maps, and profiles along x and y. Tested is also an even map without waves of two nodes (which have
 * no effect on slabs here). */
static void
equals_point_stresses(void **state)
{
    static const struct rc_shape shapes_[] = {{13, 11, 1.1e-6, 0.7e-6}, {16, 12, 0.5e-6, 0.9e-6},
                                              {31, 1, 0.3e-6, 2e-6},    {1, 29, 2e-6, 0.3e-6},
                                              {1, 1, 1e-6, 1e-6},       {2, 9, 1e-6, 0.4e-6}};
    static const double h[] = {0.2e-6, 0.5e-6, 0.4e-6, 1e-6, 1.5e-6};
    enum {
        SLABS = sizeof h / sizeof *h,
        MANY = 24
    };
    double x[MANY], w[MANY];

    (void)state;
    gauss(MANY, x, w);
    for (size_t k = 0; k < sizeof shapes_ / sizeof *shapes_; k++) {
        struct rc_shape shape = shapes_[k];
        size_t n = shape.nx * shape.ny;
        const double nu = 0.27;
        struct rc_slabs *v = volume_new(shape, (struct rc_slabs_options){.boundary = RC_PERIODIC,
                                                                         .slabs = SLABS,
                                                                         .thickness = h,
                                                                         .shear = 7e10,
                                                                         .nu = nu,
                                                                         .whole = true});
        struct voxels s = voxels_new(shape, SLABS), t = voxels_new(shape, SLABS);
        double *p = calloc(n, sizeof *p), *raw = calloc(n, sizeof *raw), z = 0;
        double *one[RC_STRESSES] = {NULL};
        struct rc_stress_options o = {
            .boundary = RC_PERIODIC, .body.nu = nu, .wanted = (1u << RC_COMPONENTS) - 1};
        struct rc_stress *stress;
        uint64_t seed = 31 + k;

        for (size_t i = 0; i < n; i++)
            raw[i] = 1e8 * (1.3 + random_number(&seed));
        for (size_t i = 0; i < n; i++) { /* smoothed with 1-2-1 along an even side */
            size_t c = i % shape.nx, r = i / shape.nx;
            for (size_t a = 0; a < 3; a++)
                for (size_t b = 0; b < 3; b++) {
                    double by = shape.nx % 2 == 0 ? (a == 1 ? 0.5 : 0.25) : a == 1;
                    by *= shape.ny % 2 == 0 ? (b == 1 ? 0.5 : 0.25) : b == 1;
                    p[i] += by * raw[(r + b + shape.ny - 1) % shape.ny * shape.nx +
                                     (c + a + shape.nx - 1) % shape.nx];
                }
        }
        for (int c = 0; c < RC_COMPONENTS; c++)
            one[c] = calloc(n, sizeof *one[c]);
        stress = rc_stress_new(&shape, p, &o, NULL);
        assert_non_null(stress);
        for (size_t m = 0; m < SLABS; m++) {
            for (int g = 0; g < MANY; g++) {
                assert_int_equal(rc_stress_slice(stress, z + x[g] * h[m], one, NULL), RC_OK);
                for (int c = 0; c < RC_COMPONENTS; c++)
                    for (size_t i = 0; i < n; i++)
                        voxels_map(&t, m, (enum rc_component)c)[i] += w[g] * one[c][i];
            }
            z += h[m];
        }
        volume_apply(v, NULL, NULL, p, NULL, &s);
        assert_true(voxels_apart(&s, &t) < summed);
        rc_stress_free(stress);
        rc_slabs_free(v);
        for (int c = 0; c < RC_COMPONENTS; c++)
            free(one[c]);
        free(s.v);
        free(t.v);
        free(p);
        free(raw);
    }
}

/* ---- a sphere ---- */

/* Mean over the middle of a slab, for square maps. */
static double
mean_inside(const struct voxels *s, size_t slab, size_t r, enum rc_component c)
{
    double sum = 0, n = 0, half = (double)(s->nx / 2);

    for (size_t i = 0; i < s->n; i++)
        if (hypot((double)(i % s->nx) - half, (double)(i / s->nx) - half) <= (double)r) {
            sum += voxels_map(s, slab, c)[i];
            n++;
        }
    return sum / n;
}

/* Deviator stress in the middle of a sphere with a uniform deviator strain e, deep below the surface, is -2
 * mu (1 - b) e, b = 2 (4 - 5 nu)/(15 (1 - nu)) (Eshelby 1957). The sphere is made of cubes, 10 in its radius,
 * and the agreement is to 1 %. */
static void
equals_sphere(void **state)
{
    enum {
        N = 128,
        R = 10,
        SLABS = 2 * R + 2,
        MIDDLE = R + 1
    };
    const struct rc_shape shape = {N, N, 1e-6, 1e-6};
    const double nu = 0.3, shear = 8e10, b = 2 * (4 - 5 * nu) / (15 * (1 - nu)), size = 1e-3;
    double h[SLABS];
    struct voxels e = voxels_new(shape, SLABS), s = voxels_new(shape, SLABS);
    struct rc_slabs *v;

    (void)state;
    for (size_t k = 0; k < SLABS; k++)
        h[k] = k > 0 ? 1e-6 : 80e-6;
    v = volume_new(
        shape,
        (struct rc_slabs_options){
            .boundary = RC_PERIODIC, .slabs = SLABS, .thickness = h, .shear = shear, .nu = nu});
    for (int c = 0; c < STRAINS; c++) {
        double stress, other = 0;
        memset(e.v, 0, e.n * SLABS * RC_COMPONENTS * sizeof *e.v);
        for (size_t k = 0; k < SLABS; k++)
            for (size_t i = 0; i < e.n; i++) {
                double dx = (double)(i % N) - N / 2, dy = (double)(i / N) - N / 2;
                double dz = (double)k - MIDDLE;
                if (k > 0 && dx * dx + dy * dy + dz * dz < R * R)
                    voxels_map(&e, k, strains[c])[i] = size;
            }
        volume_apply(v, &e, NULL, NULL, NULL, &s);
        stress = mean_inside(&s, MIDDLE, R / 2, strains[c]);
        for (int d = 2; d < STRAINS; d++)
            if (d != c)
                other = fmax(other, fabs(mean_inside(&s, MIDDLE, R / 2, strains[d])));
        print_message("sphere, %s: %.4f of 2 mu e; %.4f on paper\n", rc_component_names[strains[c]],
                      -stress / (2 * shear * size), 1 - b);
        assert_true(fabs(-stress / (2 * shear * size) / (1 - b) - 1) < 0.01);
        assert_true(other < 0.005 * 2 * shear * size);
    }
    rc_slabs_free(v);
    free(e.v);
    free(s.v);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(equals_elements),
                                       cmocka_unit_test(equals_point_stresses),
                                       cmocka_unit_test(equals_sphere)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
