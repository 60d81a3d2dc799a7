/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stresses on maps that repeat along one axis agree with closed forms of plane and antiplane strain
 * (strips, a roller that slides, its first yield), and with sums of point loads under waves. A map of
 * equal rows is one row, and a map that is turned has the turned stresses. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"
#include "tests/wave_load.h"

enum {
    SIX = (1 << RC_COMPONENTS) - 1
};

static const double poisson = 0.29;

/* A map that repeats along y, or the same map with x and y exchanged. */
struct scene {
    struct rc_shape shape;
    bool turned;
    double *load[RC_LOADS]; /* NULL: none, except of the pressure */
    double nu;
    size_t threads;
};

/* Value (i, j) of a map that repeats along y, in the scene. */
static size_t
node(const struct scene *s, size_t i, size_t j)
{
    return s->turned ? i * s->shape.ny + j : j * s->shape.nx + i;
}

/* The component that is c of the map that repeats along y. */
static int
component(const struct scene *s, int c)
{
    return s->turned ? (int)rc_stress_exchanged[c] : c;
}

static struct scene
scene_new(size_t nx, size_t ny, double dx, double dy, bool turned)
{
    struct scene s = {.shape = {nx, ny, dx, dy}, .turned = turned, .nu = poisson, .threads = 2};

    for (int k = 0; k < RC_LOADS; k++)
        s.load[k] = calloc(nx * ny, sizeof(double));
    return s;
}

static void
scene_free(struct scene *s)
{
    for (int k = 0; k < RC_LOADS; k++)
        free(s->load[k]);
}

static struct rc_shape
turned_shape(const struct scene *s)
{
    const struct rc_shape *n = &s->shape;

    return s->turned ? (struct rc_shape){n->ny, n->nx, n->dy, n->dx} : *n;
}

/* The stresses at a depth: component c at node (i, j) is out[c][j nx + i], whether turned or not. */
static void
slice(const struct scene *s, double z, double *out[RC_COMPONENTS])
{
    const struct rc_shape *n = &s->shape;
    const struct rc_shape shape = turned_shape(s);
    const struct rc_stress_options o = {.boundary = rc_boundary_of(s->turned, !s->turned),
                                        .body.nu = s->nu,
                                        .wanted = SIX,
                                        .threads = s->threads,
                                        .traction = {s->load[s->turned ? RC_TURNED : RC_SHEAR],
                                                     s->load[s->turned ? RC_SHEAR : RC_TURNED]}};
    double *to[RC_STRESSES] = {NULL};
    struct rc_err err = {""};
    struct rc_stress *stress = rc_stress_new(&shape, s->load[RC_NORMAL], &o, &err);

    if (stress == NULL)
        print_error("%s\n", err.text);
    assert_non_null(stress);
    for (int c = 0; c < RC_COMPONENTS; c++)
        to[c] = malloc(n->nx * n->ny * sizeof *to[c]);
    assert_int_equal(rc_stress_slice(stress, z, to, &err), RC_OK);
    for (int c = 0; c < RC_COMPONENTS; c++)
        for (size_t k = 0; k < n->nx * n->ny; k++)
            out[c][k] = to[component(s, c)][node(s, k % n->nx, k / n->nx)];
    for (int c = 0; c < RC_COMPONENTS; c++)
        free(to[c]);
    rc_stress_free(stress);
}

static void
maps_new(const struct scene *s, double *out[RC_COMPONENTS])
{
    for (int c = 0; c < RC_COMPONENTS; c++)
        out[c] = malloc(s->shape.nx * s->shape.ny * sizeof *out[c]);
}

static void
maps_free(double *out[RC_COMPONENTS])
{
    for (int c = 0; c < RC_COMPONENTS; c++)
        free(out[c]);
}

/* ---- no wave ---- */

/* A strip with uniform pressure and tractions, at the surface and at depths from 1e-5 to 1e4 of its width. */
static void
strips(void **state)
{
    enum {
        NX = 37,
        NY = 6,
        FIRST = 9,
        LAST = 22
    };
    static const double weight[] = {1, 0.37, -0.21};
    double worst = 0;

    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        struct scene s = scene_new(NX, NY, 1.1e-6, 0.7e-6, turned);
        const double a = (LAST - FIRST) * s.shape.dx / 2;
        double *out[RC_COMPONENTS];
        maps_new(&s, out);
        for (int k = 0; k < RC_LOADS; k++)
            for (size_t j = 0; j < NY; j++)
                for (size_t i = FIRST; i < LAST; i++)
                    s.load[k][node(&s, i, j)] = weight[k] * 2.4e9;
        for (double depth = 0; depth < 2e4; depth = depth == 0 ? 1e-5 : 7 * depth) {
            const double z = 2 * a * depth;
            slice(&s, z, out);
            for (size_t k = 0; k < NX * NY; k++) {
                const double middle = (FIRST + LAST - 1) / 2.0;
                const double x = ((double)(k % NX) - middle) * s.shape.dx;
                double truth[RC_COMPONENTS] = {0};
                for (int load = 0; load < RC_LOADS; load++)
                    line_load_stress(load, s.nu, line_load_strip(x, z, a), weight[load], truth);
                for (int c = 0; c < RC_COMPONENTS; c++)
                    worst = larger(worst, fabs(out[c][k] / 2.4e9 - truth[c]));
            }
        }
        maps_free(out);
        scene_free(&s);
    }
    print_message("strips: error %.1e of the pressure\n", worst);
    assert_true(worst <= summed);
}

/* Hertz's pressure and mu times it, from its means over cells. */
static void
press_roller(struct scene *s, double a, double p0, double mu)
{
    for (size_t k = 0; k < s->shape.nx * s->shape.ny; k++) {
        const double x = ((double)(k % s->shape.nx) - (double)(s->shape.nx - 1) / 2) * s->shape.dx;
        const double p =
            p0 * (roller_load(a, x + s->shape.dx / 2) - roller_load(a, x - s->shape.dx / 2)) /
            s->shape.dx;
        const size_t at = node(s, k % s->shape.nx, k / s->shape.nx);
        s->load[RC_NORMAL][at] = p;
        s->load[RC_SHEAR][at] = mu * p;
    }
}

/* A roller that slides (McEwen; Johnson 1985, 4.3 and 7.1). The error is that of the cells, which
 * decreases with their square: at the node of a depth and beside it. */
static void
sliding_roller(void **state)
{
    static const double depths[] = {0.1, 0.3, 0.786, 2, 9};
    const double p0 = 1.3e9, mu = 0.3;
    double error[5][2] = {{0}};

    (void)state;
    for (int n = 0; n < 4; n++) {
        const size_t nx = n / 2 == 0 ? 66 : 132;
        struct scene s = scene_new(nx, 3, 3.3e-4 / (double)nx, 1e-6, n % 2);
        const double a = 1e-4;
        double *out[RC_COMPONENTS];
        maps_new(&s, out);
        press_roller(&s, a, p0, mu);
        for (int d = 0; d < 5; d++) {
            slice(&s, depths[d] * a, out);
            for (size_t k = 0; k < 3 * nx; k++) {
                const double x = ((double)(k % nx) - (double)(nx - 1) / 2) * s.shape.dx;
                double truth[RC_COMPONENTS] = {0};
                line_load_stress(RC_NORMAL, s.nu, line_load_roller(x, depths[d] * a, a), p0, truth);
                line_load_stress(RC_SHEAR, s.nu, line_load_roller(x, depths[d] * a, a), mu * p0,
                                 truth);
                for (int c = 0; c < RC_COMPONENTS; c++)
                    error[d][n / 2] = larger(error[d][n / 2], fabs(out[c][k] - truth[c]) / p0);
            }
        }
        maps_free(out);
        scene_free(&s);
    }
    for (int d = 0; d < 5; d++) {
        print_message("roller, depth %g a: error %.1e p0, with half the cells %.2f of it\n",
                      depths[d], error[d][0], error[d][1] / error[d][0]);
        assert_true(error[d][0] < 5e-4 / depths[d] && error[d][1] < 0.35 * error[d][0]);
    }
}

struct peak {
    double value, depth;
};

static void
keep(struct peak *p, double value, double depth)
{
    if (value > p->value)
        *p = (struct peak){value, depth};
}

/* Under a roller: the largest shear is .300 p0 at .786 a, the largest shear on planes along the surface
 * .250 p0 at .5 a, and the first yield is at p0 = 1.79 Y for nu = .3 (Johnson 1985, 4.3 and 6.2). The
 * strain is plane. */
static void
roller_maxima(void **state)
{
    enum {
        NX = 260
    };
    const double a = 1;
    struct peak shear = {0}, orthogonal = {0}, mises = {0};
    double strain = 0;

    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        struct scene s = scene_new(NX, 1, 2.5 / NX, 1, turned);
        double *out[RC_COMPONENTS];
        s.nu = 0.3;
        maps_new(&s, out);
        press_roller(&s, a, 1, 0);
        for (double z = 0.4; z < 0.9; z += 0.002) {
            slice(&s, z * a, out);
            for (size_t k = 0; k < NX; k++) {
                double six[RC_COMPONENTS];
                for (int c = 0; c < RC_COMPONENTS; c++)
                    six[c] = out[c][k];
                keep(&orthogonal, six[RC_SXZ], z);
                keep(&mises, mises_of(six), z);
                keep(&shear, hypot((six[RC_SXX] - six[RC_SZZ]) / 2, six[RC_SXZ]), z);
                strain = larger(strain, fabs(six[RC_SYY] - s.nu * (six[RC_SXX] + six[RC_SZZ])));
            }
        }
        maps_free(out);
        scene_free(&s);
    }
    print_message("shear %.4f p0 at %.3f a, orthogonal %.4f at %.3f a, yield at %.4f Y\n",
                  shear.value, shear.depth, orthogonal.value, orthogonal.depth, 1 / mises.value);
    assert_true(fabs(shear.value - 0.300) < 5e-4 && fabs(shear.depth - 0.786) < 3e-3);
    assert_true(fabs(orthogonal.value - 0.25) < 1e-4 && fabs(orthogonal.depth - 0.5) < 5e-3);
    assert_true(fabs(1 / mises.value - 1.79) < 5e-3);
    assert_true(strain <= rounding);
}

/* Automatic depths find the largest Mises stress of a roller, .5575 p0, within 1 %. They end at six
 * half-widths, also if the roller is long in the map. */
static void
chosen_depths(void **state)
{
    enum {
        NX = 128,
        NY = 300
    };
    const double exact = 1 / 1.7937;

    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        struct scene s = scene_new(NX, NY, 2.5 / NX, 0.1, turned);
        const struct rc_shape shape = turned_shape(&s);
        const struct rc_body body = {.nu = 0.3};
        double *out[RC_COMPONENTS], *depths, found = 0;
        struct rc_err err;
        size_t n;
        s.nu = body.nu;
        maps_new(&s, out);
        press_roller(&s, 1, 1, 0);
        assert_int_equal(rc_stress_depths(NULL, &shape, s.load[RC_NORMAL],
                                          rc_boundary_of(turned, !turned), &body, &depths, &n,
                                          &err),
                         RC_OK);
        assert_true(depths[n - 1] > 5.8 && depths[n - 1] < 8 && n < 40);
        for (size_t k = 0; k < n; k++) {
            slice(&s, depths[k], out);
            for (size_t i = 0; i < NX; i++) {
                double six[RC_COMPONENTS];
                for (int c = 0; c < RC_COMPONENTS; c++)
                    six[c] = out[c][i];
                found = fmax(found, mises_of(six));
            }
        }
        print_message("%zu depths, largest Mises stress %.4f of the exact\n", n, found / exact);
        assert_true(fabs(found / exact - 1) < 0.01);
        free(depths);
        maps_free(out);
        scene_free(&s);
    }
}

/* ---- a wave ---- */

/* All loads are the same wave along y on a strip. The truth is a sum over point loads. */
static void
waves_on_a_strip(void **state)
{
    enum {
        NX = 12,
        FIRST = 4,
        LAST = 7
    };
    static const struct {
        size_t ny, wave;
        double depth; /* cells */
    } at[] = {{8, 1, 2.2}, {9, 4, 0.7}, {16, 3, 1.1}, {10, 2, 5}};
    static const double weight[] = {1, 0.37, -0.21};
    const double d = 1.4;
    double worst = 0;

    (void)state;
    for (int n = 0; n < 8; n++) {
        const size_t ny = at[n / 2].ny;
        struct scene s = scene_new(NX, ny, d, 0.9, n % 2);
        const double q = 2 * exact_pi * (double)at[n / 2].wave / ((double)ny * s.shape.dy);
        double *out[RC_COMPONENTS], truth[RC_STRESS_KERNELS], field[RC_COMPONENTS][NX][2] = {{{0}}};
        maps_new(&s, out);
        for (int k = 0; k < RC_LOADS; k++)
            for (size_t j = 0; j < ny; j++)
                for (size_t i = FIRST; i < LAST; i++)
                    s.load[k][node(&s, i, j)] = weight[k] * cos(q * s.shape.dy * (double)j);
        slice(&s, at[n / 2].depth * d, out);
        /* amplitudes of cos(q y) and sin(q y) of each component */
        for (size_t i = 0; i < NX; i++)
            for (size_t from = FIRST; from < LAST; from++) {
                const bool right = i >= from;
                wave_load_stress(s.nu, d, q, (double)(right ? i - from : from - i) * d,
                                 at[n / 2].depth * d, truth);
                for (int k = 0; k < RC_STRESS_KERNELS; k++) {
                    const unsigned parity = rc_stress_parity[k];
                    const double sign = right || !(parity & RC_ODD_X) ? 1 : -1;
                    field[k % RC_COMPONENTS][i][(parity & RC_ODD_Y) != 0] +=
                        sign * weight[k / RC_COMPONENTS] * truth[k];
                }
            }
        for (int c = 0; c < RC_COMPONENTS; c++)
            for (size_t k = 0; k < NX * ny; k++) {
                const double phase = q * s.shape.dy * (double)(k / NX);
                const double *f = field[c][k % NX];
                worst = larger(worst, fabs(out[c][k] - f[0] * cos(phase) - f[1] * sin(phase)));
            }
        maps_free(out);
        scene_free(&s);
    }
    print_message("waves on a strip: error %.1e of the pressure\n", worst);
    assert_true(worst <= summed);
}

/* ---- laws ---- */

static void
load_at_random(struct scene *s, uint64_t seed)
{
    const size_t nx = s->shape.nx, ny = s->shape.ny;

    for (int k = 0; k < RC_LOADS; k++)
        for (size_t at = 0; at < nx * ny; at++)
            s->load[k][node(s, at % nx, at / nx)] = random_number(&seed);
}

/* Maps of any sides, with all loads: turned by exchange of x and y. */
static void
turned_maps(void **state)
{
    static const size_t side[][2] = {{17, 12}, {12, 17}, {1, 9},  {9, 1},
                                     {6, 90},  {90, 6},  {40, 40}};
    double worst = 0;

    (void)state;
    for (size_t m = 0; m < sizeof side / sizeof *side; m++) {
        struct scene s = scene_new(side[m][0], side[m][1], 1.1, 0.8, false),
                     t = scene_new(side[m][0], side[m][1], 1.1, 0.8, true);
        double *a[RC_COMPONENTS], *b[RC_COMPONENTS];
        maps_new(&s, a);
        maps_new(&t, b);
        load_at_random(&s, 11 + m);
        load_at_random(&t, 11 + m);
        for (double z = 0; z < 60; z = 2.7 * z + 0.2) {
            slice(&s, z, a);
            slice(&t, z, b);
            for (int c = 0; c < RC_COMPONENTS; c++)
                for (size_t k = 0; k < side[m][0] * side[m][1]; k++)
                    worst = larger(worst, fabs(a[c][k] - b[c][k]));
        }
        maps_free(a);
        maps_free(b);
        scene_free(&s);
        scene_free(&t);
    }
    print_message("turned maps differ by %.1e of the largest load\n", worst);
    assert_true(worst <= summed);
}

/* The repeated pressure of one row; and a period taken twice. */
static void
equal_rows(void **state)
{
    static const size_t rows[] = {1, 4, 7};
    double worst = 0;

    (void)state;
    for (int n = 0; n < 6; n++) {
        struct scene one = scene_new(30, rows[n / 2], 1.1, 0.8, n % 2),
                     two = scene_new(30, 2 * rows[n / 2], 1.1, 0.8, n % 2);
        double *a[RC_COMPONENTS], *b[RC_COMPONENTS];
        maps_new(&one, a);
        maps_new(&two, b);
        load_at_random(&one, 5);
        for (int k = 0; k < RC_LOADS; k++)
            for (size_t at = 0; at < 60 * rows[n / 2]; at++)
                two.load[k][node(&two, at % 30, at / 30)] =
                    one.load[k][node(&one, at % 30, at / 30 % rows[n / 2])];
        for (double z = 0; z < 60; z = 2.7 * z + 0.2) {
            slice(&one, z, a);
            slice(&two, z, b);
            for (int c = 0; c < RC_COMPONENTS; c++)
                for (size_t k = 0; k < 60 * rows[n / 2]; k++)
                    worst = larger(worst, fabs(b[c][k] - a[c][k % (30 * rows[n / 2])]));
        }
        maps_free(a);
        maps_free(b);
        scene_free(&one);
        scene_free(&two);
    }
    print_message("rows taken twice differ by %.1e of the largest load\n", worst);
    assert_true(worst <= summed);
}

/* The pressure at any depth carries the load: its sum over a map that is wide along the free axis, and the
 * closed form of the part beyond, where the load is a line. */
static void
pressure_carries_the_load(void **state)
{
    enum {
        NX = 301,
        NY = 8
    };

    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        struct scene s = scene_new(NX, NY, 1, 0.8, turned);
        double *out[RC_COMPONENTS], load = 0;
        uint64_t seed = 3;
        maps_new(&s, out);
        for (size_t j = 0; j < NY; j++)
            for (size_t i = 149; i < 152; i++)
                load += s.load[RC_NORMAL][node(&s, i, j)] = 2 + random_number(&seed);
        for (double z = 0; z < 20; z = 2.7 * z + 0.2) {
            const double x = 150.5 / z;
            const double within = z == 0 ? 1 : 2 / exact_pi * (atan(x) + x / (1 + x * x));
            double sum = 0;
            slice(&s, z, out);
            for (size_t k = 0; k < NX * NY; k++)
                sum -= out[RC_SZZ][k];
            /* a sum over nodes is not quite the integral: exp(-2 pi z) */
            assert_true(fabs(sum / load - within) < (z == 0 ? rounding : 1e-4));
        }
        maps_free(out);
        scene_free(&s);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strips),           cmocka_unit_test(sliding_roller),
        cmocka_unit_test(roller_maxima),    cmocka_unit_test(chosen_depths),
        cmocka_unit_test(waves_on_a_strip), cmocka_unit_test(turned_maps),
        cmocka_unit_test(equal_rows),       cmocka_unit_test(pressure_carries_the_load),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
