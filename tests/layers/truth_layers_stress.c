/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stresses in a coated body equal those of the integral equations of its contact and, if all layers have one
 * material, those of a half-space. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_linalg.h>

#include "tests/contact_case.h"
#include "libcontact/body/stack.h"
#include "libcontact/stress/stress.h"
#include "tests/body_case.h"

/* ---- a paraboloid on one layer, on the axis ---- */

enum {
    NODES = 64, /* number of nodes of chi on (0, a) */
    PANEL = 20  /* points in a panel of wave numbers */
};

/* A rigid paraboloid on a layer of thickness 1 and modulus E_1 on a substrate of modulus 1, both with nu =
 * 0.3; a = 1. With p(q) = integral over 0..a of chi(t) cos(q t) dt, and u = 2 g p/q,
 *
 *     pi g(infinity) chi(x) + integral of chi(t) (k(x - t) + k(x + t)) dt = delta - x^2/R,
 *     k(y) = integral of (g - g(infinity)) cos(q y) dq, chi(a) = 0. */
struct cap {
    struct rc_stack *stack;
    double chi[NODES], t[NODES], w[NODES];
    double p0; /* 5: p(0) of the table, in units of 2 E*_s a/pi R */
};

static double
each_panel(double to, double width, double (*f)(const void *, double), const void *ctx)
{
    gsl_integration_glfixed_table *g = gsl_integration_glfixed_table_alloc(PANEL);
    double sum = 0;

    for (double from = 0; from < to; from += width)
        for (size_t k = 0; k < PANEL; k++) {
            double q, w;
            gsl_integration_glfixed_point(from, from + width, k, &q, &w, g);
            sum += w * f(ctx, q);
        }
    gsl_integration_glfixed_table_free(g);
    return sum;
}

struct kernel_at {
    const struct rc_stack *stack;
    double y;
};

static double
kernel_wave(const void *ctx, double q)
{
    const struct kernel_at *at = ctx;

    return rc_stack_excess(at->stack, q) * cos(q * at->y);
}

static double
kernel(const struct rc_stack *s, double y)
{
    const struct kernel_at at = {s, y};

    return each_panel(20, 0.5, kernel_wave, &at);
}

static double
pair_of(const struct rc_stack *s, double x, double t)
{
    return kernel(s, x - t) + kernel(s, x + t);
}

/* Solves for chi with the right-hand sides 1 and x^2/R, R = 1; delta makes chi(a) = 0. */
static struct cap
cap_new(double e, double p0)
{
    struct rc_layer layer = {1, e, 0.3};
    struct rc_body coating = {1, 0.3, 1, &layer};
    struct rc_err err;
    struct cap c = {.stack = rc_stack_new(&coating, &err), .p0 = p0};
    gsl_integration_glfixed_table *g = gsl_integration_glfixed_table_alloc(NODES);
    gsl_matrix *m = gsl_matrix_alloc(NODES, NODES);
    gsl_permutation *p = gsl_permutation_alloc(NODES);
    gsl_vector *one = gsl_vector_alloc(NODES), *square = gsl_vector_alloc(NODES);
    gsl_vector *x = gsl_vector_alloc(NODES), *y = gsl_vector_alloc(NODES);
    double at_one = 0, at_square = 0, delta;
    int sign;

    assert_non_null(c.stack);
    for (size_t k = 0; k < NODES; k++)
        gsl_integration_glfixed_point(0, 1, k, &c.t[k], &c.w[k], g);
    for (size_t i = 0; i < NODES; i++) {
        for (size_t j = 0; j < NODES; j++)
            gsl_matrix_set(m, i, j,
                           c.w[j] * pair_of(c.stack, c.t[i], c.t[j]) +
                               (i == j ? exact_pi * c.stack->top : 0));
        gsl_vector_set(one, i, 1);
        gsl_vector_set(square, i, c.t[i] * c.t[i]);
    }
    gsl_linalg_LU_decomp(m, p, &sign);
    gsl_linalg_LU_solve(m, p, one, x);
    gsl_linalg_LU_solve(m, p, square, y);
    for (size_t j = 0; j < NODES; j++) {
        double k = c.w[j] * pair_of(c.stack, 1, c.t[j]);
        at_one += k * gsl_vector_get(x, j);
        at_square += k * gsl_vector_get(y, j);
    }
    /* pi g chi(a) = delta (1 - at_one) - (1 - at_square) = 0 */
    delta = (1 - at_square) / (1 - at_one);
    for (size_t j = 0; j < NODES; j++)
        c.chi[j] = delta * gsl_vector_get(x, j) - gsl_vector_get(y, j);
    gsl_vector_free(one);
    gsl_vector_free(square);
    gsl_vector_free(x);
    gsl_vector_free(y);
    gsl_matrix_free(m);
    gsl_permutation_free(p);
    gsl_integration_glfixed_table_free(g);
    return c;
}

struct axis {
    const struct cap *cap;
    size_t medium;
    double z;
    bool radial; /* srr, else szz */
};

static double
axis_wave(const void *ctx, double q)
{
    const struct axis *a = ctx;
    double f[RC_UNDER_BOTH], p = 0;

    for (size_t k = 0; k < NODES; k++)
        p += a->cap->w[k] * a->cap->chi[k] * cos(q * a->cap->t[k]);
    rc_stack_inside(a->cap->stack, a->medium, a->z, q, RC_UNDER_BOTH, f);
    return p * q * (a->radial ? (f[RC_P_L] + f[RC_P_N]) / 2 : f[RC_P_S]);
}

/* Over p(0). */
static double
on_axis(const struct cap *c, double z, size_t medium, bool radial)
{
    struct axis a = {c, medium, z, radial};
    double p0 = c->p0 * 2 / (exact_pi * (1 - 0.3 * 0.3));

    return each_panel(40 / z, 0.5, axis_wave, &a) / p0;
}

/* szz and srr over p(0) at z/t = .25, .5, .9, 1-, 1+, 1.5, 3, published with nine decimals. They are an
 * independent solution of the dual integral equations. */
static const double depth[] = {.25, .5, .9, 1, 1, 1.5, 3};
static const struct {
    double e, p0, szz[7], srr[7];
} paraboloid[] = {
    {0.1,
     0.1259888053,
     {-0.956611611, -0.854974911, -0.671160493, -0.620735079, -0.620735079, -0.392472306,
      -0.120370019},
     {-0.297590040, -0.162373446, -0.198135882, -0.252407839, -0.129814508, -0.027264895,
      0.003775681}},
    {0.5,
     0.5587488114,
     {-0.948558037, -0.826077429, -0.606641916, -0.553768767, -0.553768767, -0.342459977,
      -0.108073607},
     {-0.350022582, -0.175189540, -0.128600654, -0.149697953, -0.062066434, -0.008704119,
      0.004400205}},
    {2,
     1.7129462976,
     {-0.930809618, -0.763763314, -0.480672536, -0.430676208, -0.430676208, -0.267337895,
      -0.091224118},
     {-0.470334420, -0.180835405, 0.102155296, 0.171541811, -0.006516853, 0.006241395,
      0.005085996}},
    {10,
     5.4728630450,
     {-0.900793205, -0.660131870, -0.283901605, -0.244188998, -0.244188998, -0.164416304,
      -0.068408768},
     {-0.739185908, -0.155614337, 0.687851023, 0.948545444, 0.000667359, 0.003734690, 0.003585409}},
};
/* Half of the ninth decimal, and the rounding of p(0) in the tenth. */
static const double nine_decimals = 0.6e-9;

static void
axis_of_a_paraboloid(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof paraboloid / sizeof *paraboloid; k++) {
        struct cap c = cap_new(paraboloid[k].e, paraboloid[k].p0);
        double off = 0;
        for (int i = 0; i < 7; i++) {
            size_t medium = i < 4 ? 0 : 1;
            off = larger(off, fabs(on_axis(&c, depth[i], medium, false) - paraboloid[k].szz[i]));
            off = larger(off, fabs(on_axis(&c, depth[i], medium, true) - paraboloid[k].srr[i]));
        }
        print_message("E_1/E_s = %g: off by %.1e p(0)\n", paraboloid[k].e, off);
        assert_true(off <= nine_decimals);
        rc_stack_free(c.stack);
    }
}

/* ---- layers of one material ---- */

enum {
    NX = 33,
    NY = 28,
    N = NX * NY,
    SIX = (1 << RC_COMPONENTS) - 1
};
static const struct rc_shape shape = {NX, NY, 1.1e-6, 0.9e-6};
static const double one_nu = 0.31, mu = 0.35;
static const struct rc_layer one_material[] = {
    {2.1e-6, 7e10, 0.31}, {0.4e-6, 7e10, 0.31}, {5e-6, 7e10, 0.31}};
static const struct rc_body of_one = {7e10, 0.31, 3, one_material};

static double *
random_pressure(void)
{
    double *p = malloc(N * sizeof *p);
    uint64_t seed = 1961;

    for (size_t k = 0; k < N; k++)
        p[k] = 1e9 * random_number(&seed);
    return p;
}

static void
slice_of(const double *p, struct rc_stress_options o, double z, double *s)
{
    double *to[RC_STRESSES] = {NULL};
    struct rc_err err;
    struct rc_stress *stress = rc_stress_new(&shape, p, &o, &err);

    assert_non_null(stress);
    for (int c = 0; c < RC_COMPONENTS; c++)
        to[c] = s + (size_t)c * N;
    assert_int_equal(rc_stress_slice(stress, z, to, &err), RC_OK);
    rc_stress_free(stress);
}

/* Depths are above, at, between and below the interfaces. The sum over cells is in extended precision (Love
 * 1929). */
static void
one_material_free(void **state)
{
    static const double depths[] = {0.3e-6, 2.1e-6, 2.3e-6, 2.5e-6, 6e-6, 7.5e-6, 20e-6};
    double *p = random_pressure(), *s = malloc(6 * N * sizeof *s);

    (void)state;
    for (size_t d = 0; d < sizeof depths / sizeof *depths; d++) {
        double off = 0;
        slice_of(p,
                 (struct rc_stress_options){.mu = mu, .wanted = SIX, .body = of_one, .threads = 2},
                 depths[d], s);
        for (size_t k = 5; k < N; k += 97)
            for (int c = 0; c < RC_COMPONENTS; c++) {
                double sum = 0;
                for (size_t l = 0; l < N; l++) {
                    double x = node_x(shape, k) - node_x(shape, l);
                    double y = node_y(shape, k) - node_y(shape, l);
                    for (int load = 0; load < 2; load++)
                        sum += (load == 0 ? 1 : mu) * p[l] *
                               rectangle_stress(load == 1, c, one_nu, x, y, depths[d], shape.dx / 2,
                                                shape.dy / 2);
                }
                off = larger(off, fabs(s[(size_t)c * N + k] - sum) / 1e9);
            }
        print_message("%g m: off by %.1e of the pressure\n", depths[d], off);
        assert_true(off <= summed);
    }
    free(p);
    free(s);
}

/* Compared with the symbols of one material, which have separate tests; also for a profile. */
static void
one_material_periodic(void **state)
{
    static const double depths[] = {0, 2.1e-6, 2.3e-6, 6e-6, 20e-6};
    double *p = random_pressure(), *s = malloc(6 * N * sizeof *s),
           *bare = malloc(6 * N * sizeof *s);

    (void)state;
    for (size_t d = 0; d < sizeof depths / sizeof *depths; d++) {
        struct rc_stress_options o = {
            .boundary = RC_PERIODIC, .body.nu = one_nu, .mu = mu, .wanted = SIX, .threads = 2};
        double off = 0;
        slice_of(p, o, depths[d], bare);
        o.body = of_one;
        slice_of(p, o, depths[d], s);
        for (size_t k = 0; k < 6 * N; k++)
            off = larger(off, fabs(s[k] - bare[k]) / 1e9);
        print_message("periodic, %g m: off by %.1e of the pressure\n", depths[d], off);
        assert_true(off <= summed);
    }
    free(p);
    free(s);
    free(bare);
}

/* ---- the mean pressure of a periodic map ---- */

/* A uniform pressure everywhere. The in-plane strains of the layer are those of the substrate, which is under
 * an unbounded loaded patch: sxx = -(1 + 2 nu_s) p/2 in the substrate. On a profile the strain along y is
 * 0. */
static void
uniform_pressure(void **state)
{
    const struct rc_layer layer = {1e-6, 2e11, 0.21};
    const struct rc_body coating = {7e10, 0.33, 1, &layer};
    const double pressure = 3e8, es = 7e10, nus = 0.33, e = 2e11, nu = 0.21;
    double p[16], v[6 * 16], *s[RC_STRESSES] = {NULL};

    (void)state;
    for (int k = 0; k < 16; k++)
        p[k] = pressure;
    for (int c = 0; c < 6; c++)
        s[c] = v + 16 * c;
    for (int profile = 0; profile < 2; profile++) {
        const struct rc_shape map = {profile ? 16 : 4, profile ? 1 : 4, 1e-6, 1e-6};
        const struct rc_stress_options o = {
            .boundary = RC_PERIODIC, .mu = mu, .wanted = SIX, .body = coating, .threads = 1};
        struct rc_err err;
        struct rc_stress *stress = rc_stress_new(&map, p, &o, &err);
        /* strain along x of the substrate: sxx = -p in plane strain, -(1 + 2 nu) p/2 else */
        double xx = profile ? -pressure : -(1 + 2 * nus) / 2 * pressure;
        double yy = profile ? nus * (xx - pressure) : xx;
        double ex = (xx - nus * (yy - pressure)) / es, ey = (yy - nus * (xx - pressure)) / es;
        double plane = e / (1 - nu * nu), thick = -nu / (1 - nu) * pressure;
        assert_non_null(stress);
        for (int medium = 0; medium < 2; medium++) {
            assert_int_equal(rc_stress_slice(stress, medium == 0 ? 0.5e-6 : 3e-6, s, &err), RC_OK);
            if (medium == 0) {
                xx = plane * (ex + nu * ey) + thick;
                yy = plane * (ey + nu * ex) + thick;
            } else {
                xx = profile ? -pressure : -(1 + 2 * nus) / 2 * pressure;
                yy = profile ? nus * (xx - pressure) : xx;
            }
            for (int k = 0; k < 16; k++) {
                assert_true(fabs(s[RC_SXX][k] - xx) <= rounding * pressure);
                assert_true(fabs(s[RC_SYY][k] - yy) <= rounding * pressure);
                assert_true(fabs(s[RC_SZZ][k] + pressure) <= rounding * pressure);
                assert_true(fabs(s[RC_SXZ][k] + mu * pressure) <= rounding * pressure);
                assert_true(fabs(s[RC_SXY][k]) + fabs(s[RC_SYZ][k]) <= rounding * pressure);
            }
        }
        rc_stress_free(stress);
    }
}

/* ---- coefficients of a cell ---- */

/* The integral over all waves of the response to a unit load on the cell dx x dy, in polar coordinates. It
 * uses panels in q, and even steps of the angle, which converge very fast. The values in the top layer omit
 * the part of one material. */
struct wave_sum {
    const struct rc_stack *stack;
    size_t medium;
    double z, x, y, dx, dy, scale;
};

static double
sinc(double x)
{
    return fabs(x) < 1e-4 ? 1 - x * x / 6 : sin(x) / x;
}

/* Stresses of a wave exp(i(qx x + qy y)) of pressure, and of traction along x. This traction has the
 * component c along the wave and -s across it. */
static void
stresses_of_wave(double c, double s, const double *f, double complex out[12])
{
    const double *t = f + RC_T_S;
    double along[2][4] = {{f[RC_P_S], f[RC_P_T], f[RC_P_L], f[RC_P_N]}, {t[0], t[1], t[2], t[3]}};

    for (int load = 0; load < 2; load++) {
        /* a pressure varies as cos: szz, sll, snn as cos, slz as sin = -i. A traction varies as sin, that is,
         * times i */
        double complex even = load == 0 ? 1 : I * c, odd = load == 0 ? -I : c;
        double complex zz = even * along[load][0], lz = odd * along[load][1];
        double complex ll = even * along[load][2], nn = even * along[load][3];
        double complex nz = load == 0 ? 0 : -f[RC_T_R] * -s, ln = load == 0 ? 0 : I * f[RC_T_V] * s;
        double complex *to = out + 6 * load;
        /* l = (c, s), n = (-s, c) */
        to[RC_SXX] = c * c * ll + s * s * nn - 2 * c * s * -ln;
        to[RC_SYY] = s * s * ll + c * c * nn + 2 * c * s * -ln;
        to[RC_SZZ] = zz;
        to[RC_SXY] = c * s * (ll - nn) + (c * c - s * s) * -ln;
        to[RC_SXZ] = c * lz - s * nz;
        to[RC_SYZ] = s * lz + c * nz;
    }
}

static void
sum_waves(const struct wave_sum *w, double sum[12])
{
    gsl_integration_glfixed_table *g = gsl_integration_glfixed_table_alloc(PANEL);
    double reach = hypot(w->x, w->y) + hypot(w->dx, w->dy), last = 40 / w->scale;
    double most = fmin(8 / reach, last / 20),
           width = 1e-3; /* a coat has an effect from 1/(t E_1/E_s) on */

    for (int k = 0; k < 12; k++)
        sum[k] = 0;
    for (double from = 0; from < last; from += width, width = fmin(most, from))
        for (size_t k = 0; k < PANEL; k++) {
            double q, weight, f[RC_UNDER_BOTH], b[RC_UNDER_BOTH];
            int n;
            gsl_integration_glfixed_point(from, from + width, k, &q, &weight, g);
            n = 2 * (int)(q * reach / 2 + 20);
            rc_stack_inside(w->stack, w->medium, w->z, q, RC_UNDER_BOTH, f);
            if (w->medium == 0) {
                double x = q * w->z, e = exp(-x), nu = w->stack->material[0].nu;
                const double half[] = {-(1 + x), -x, x - 1, -2 * nu, x, x - 1, 2 - x, 2 * nu, 1, 1};
                for (int i = 0; i < RC_UNDER_BOTH; i++)
                    b[i] = half[i] * e;
                for (int i = 0; i < RC_UNDER_BOTH; i++)
                    f[i] -= b[i];
            }
            for (int j = 0; j < 2 * n; j++) {
                double angle = exact_pi * (j + 0.5) / n, c = cos(angle), s = sin(angle);
                double cell = sinc(q * c * w->dx / 2) * sinc(q * s * w->dy / 2) * w->dx * w->dy;
                double complex wave = cexp(I * q * (c * w->x + s * w->y)), out[12];
                stresses_of_wave(c, s, f, out);
                for (int i = 0; i < 12; i++)
                    sum[i] += weight * q * cell * creal(out[i] * wave) * exact_pi / n /
                              (4 * exact_pi * exact_pi);
            }
        }
    gsl_integration_glfixed_table_free(g);
}

/* Cells measure from many times to a fraction of the thickness of the top layer. They lie on stiff, soft and
 * several layers, on both sides of interfaces. */
static void
coefficients(void **state)
{
    static const struct rc_layer stiff[] = {{0.12, 100, 0.2}}, soft[] = {{3, 0.02, 0.5}},
                                 three[] = {{1, 4, 0.2}, {0.6, 0.2, 0.45}, {2, 10, 0.3}};
    static const struct {
        struct rc_body coating;
        double z[4];
        double x[4], y[4];
    } cases[] = {
        {{1, 0.3, 1, stiff}, {0.03, 0.12, 0.13, 0.5}, {0, 1, 0, 1}, {0, 0, 1.3, 1.3}},
        {{1, 0.3, 1, soft}, {0.4, 2, 3.1, 9}, {0, 1, 0, 9}, {0, 0, 1.3, 5.2}},
        {{1, 0.3, 3, three}, {0.7, 1, 1.4, 1.8}, {0, 2, 5, 12}, {0, 1.3, 2.6, 7.8}},
    };

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct rc_err err;
        struct rc_stack *s = rc_stack_new(&cases[k].coating, &err);
        for (int d = 0; d < 4; d++) {
            double z = cases[k].z[d], off = 0, largest = 1;
            const struct rc_cell cell = {1, 1.3};
            struct body_case at;
            stress_case(&at, cases[k].coating, z, RC_FREE, 0);
            for (int i = 0; i < 4; i++) {
                size_t medium = rc_stack_medium(s, z);
                double x = cases[k].x[i], y = cases[k].y[i], value[12] = {NAN}, sum[12], *to[12];
                const struct wave_sum w = {.stack = s,
                                           .medium = medium,
                                           .z = z,
                                           .x = x,
                                           .y = y,
                                           .dx = 1,
                                           .dy = 1.3,
                                           .scale =
                                               medium > 0 ? z : 2 * s->material[0].thickness - z};
                sum_waves(&w, sum);
                for (int c = 0; c < 12; c++) {
                    to[c] = &value[c];
                    if (medium == 0)
                        sum[c] +=
                            rectangle_stress(c >= 6, c % 6, s->material[0].nu, x, y, z, 0.5, 0.65);
                }
                at.inside->type->coefficients(at.inside, &cell, (1u << 12) - 1, 1, &x, &y, to);
                for (int c = 0; c < 12; c++) {
                    off = larger(off, fabs(value[c] - sum[c]));
                    largest = larger(largest, fabs(sum[c]));
                }
            }
            print_message("body %zu, depth %g: off by %.1e of %.2g\n", k, z, off, largest);
            assert_true(off <= summed * largest);
            body_case_free(&at);
        }
        rc_stack_free(s);
    }
}

/* Values along a line equal those at its single points; from 80 cells on they are interpolated between
 * nodes. */
static void
lines_are_places(void **state)
{
    enum {
        LENGTH = 300
    };
    static const struct rc_layer three[] = {{1, 4, 0.2}, {0.6, 0.2, 0.45}, {2, 10, 0.3}};
    static const struct rc_body body = {1, 0.3, 3, three};
    static const double depths_of[] = {0, 0.5, 1, 1.3, 5, 100}, lines[] = {0, 1.3, 26, 130};
    double line[12][LENGTH], places[12][LENGTH], x[LENGTH], y[LENGTH], *a[12], *b[12];
    double off = 0;

    (void)state;
    for (int k = 0; k < 12; k++) {
        a[k] = line[k];
        b[k] = places[k];
    }
    for (int d = 0; d < 6; d++) {
        const struct rc_cell cell = {1, 1.3};
        struct body_case at;
        stress_case(&at, body, depths_of[d], RC_FREE, 0);
        for (int l = 0; l < 4; l++) {
            for (int i = 0; i < LENGTH; i++) {
                x[i] = i;
                y[i] = lines[l];
            }
            at.inside->type->line(at.inside, &cell, (1u << 12) - 1, 1, LENGTH, lines[l], a);
            at.inside->type->coefficients(at.inside, &cell, (1u << 12) - 1, LENGTH, x, y, b);
            for (int k = 0; k < 12; k++)
                for (int i = 0; i < LENGTH; i++)
                    off = larger(off, fabs(line[k][i] - places[k][i]));
        }
        body_case_free(&at);
    }
    print_message("lines are off by %.1e\n", off);
    assert_true(off <= rounding);
}

/* ---- a solved contact ---- */

/* The same paraboloid by the solver, with about 25 nodes in the contact radius, and the slices below its
 * middle node. */
static void
axis_of_a_solution(void **state)
{
    enum {
        M = 65
    };
    const struct rc_shape map = {M, M, 0.04, 0.04};
    const struct rc_layer layer = {1, 10, 0.3};
    const struct rc_body coating = {1, 0.3, 1, &layer};
    const double estar = 1 / (1 - 0.3 * 0.3), factor = 5.9423756139,
                 p0 = 5.4728630450 * 2 / exact_pi;
    /* the radius 1000 makes slopes small; a = 1 */
    struct rc_problem problem = {
        .load = factor * 4 * estar / 3 / 1000, .tol = 1e-6, .pair.one = coating, .threads = 2};
    double h[M * M], one[6 * M * M], *to[RC_STRESSES] = {NULL};
    struct rc_stress_options o = {.mu = 0, .wanted = SIX, .body = coating, .threads = 2};
    struct rc_stress *stress;
    struct rc_err err;
    struct solved s;
    double off = 0;

    (void)state;
    rc_synth_sphere(&map, 1000, h);
    s = solve(map, h, problem);
    assert_int_equal(s.status, RC_OK);
    stress = rc_stress_new(&map, s.p, &o, &err);
    assert_non_null(stress);
    for (int c = 0; c < RC_COMPONENTS; c++)
        to[c] = one + c * M * M;
    for (int i = 0; i < 7; i++) {
        size_t k = M * M / 2;
        double z = depth[i] * (i == 4 ? 1 + 1e-9 : 1), unit = p0 * estar / 1000;
        assert_int_equal(rc_stress_slice(stress, z, to, &err), RC_OK);
        off = larger(off, fabs(to[RC_SZZ][k] / unit - paraboloid[3].szz[i]));
        off = larger(off, fabs(to[RC_SXX][k] / unit - paraboloid[3].srr[i]));
        off = larger(off, fabs(to[RC_SYY][k] / unit - paraboloid[3].srr[i]));
    }
    print_message("solved on a grid: off by %.1e p(0)\n", off);
    assert_true(off <= grid_peak / (25 * 25));
    rc_stress_free(stress);
    solved_free(&s);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(axis_of_a_paraboloid), cmocka_unit_test(coefficients),
        cmocka_unit_test(lines_are_places),     cmocka_unit_test(axis_of_a_solution),
        cmocka_unit_test(one_material_free),    cmocka_unit_test(one_material_periodic),
        cmocka_unit_test(uniform_pressure),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
