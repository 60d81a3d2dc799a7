/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Influence coefficients of shear equal the integrals of Cerruti's and Boussinesq's solutions over a cell.
 * Responses to waves equal those of plane and antiplane strain. Sums by transforms equal plain double
 * sums. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/friction/tangential.h"
#include "dense.h"
#include "tests/exact.h"

static const double quadrature = 1e-12, in_floats = 5e-6;

/* Steel on rubber, and a single body on a rigid one. */
static const struct rc_pair pairs[] = {
    {.one = {.e = 210e9, .nu = 0.29}, .two = {.e = 3e9, .nu = 0.47}},
    {.one = {.e = 70e9, .nu = 0.17}},
    {.one = {.e = 2e9, .nu = 0.5}, .two = {.e = 2e9, .nu = 0.5}},
};
enum {
    PAIRS = sizeof pairs / sizeof *pairs
};

/* ---- a force on a body ---- */

/* Displacements at (x, y) by unit forces along x on body 1 and along -x on body 2 (Johnson 1985, eq. 3.77, z
 * into each body). Along x it is body 1 minus body 2, along z the sum of both. */
struct force {
    const struct rc_pair *pair;
    int kernel;
    double x, y, a, b, u;
};

static double
point(const struct force *f, double x, double y)
{
    const struct rc_body *bodies[2] = {&f->pair->one, &f->pair->two};
    double r = sqrt(x * x + y * y), sum = 0;

    for (int k = 0; k < 2; k++) {
        double e = bodies[k]->e, nu = bodies[k]->nu, side = k == 0 ? 1 : -1, g, v = 0;
        if (e == 0)
            continue;
        g = e / (2 * (1 + nu));
        switch (f->kernel) {
        case RC_SHEAR_XX:
            v = (1 - nu) / r + nu * x * x / (r * r * r);
            break;
        case RC_SHEAR_YY:
            v = (1 - nu) / r + nu * y * y / (r * r * r);
            break;
        case RC_SHEAR_XY:
            v = nu * x * y / (r * r * r);
            break;
        case RC_SHEAR_XZ:
            v = side * (1 - 2 * nu) / 2 * x / (r * r);
            break;
        case RC_SHEAR_YZ:
            v = side * (1 - 2 * nu) / 2 * y / (r * r);
            break;
        }
        sum += v / (2 * exact_pi * g);
    }
    return sum;
}

static gsl_integration_workspace *inner, *outer;

static double
integrate(double (*f)(double, void *), void *ctx, double from, double to,
          gsl_integration_workspace *room)
{
    const gsl_function function = {f, ctx};
    double value, error;

    gsl_integration_qags(&function, from, to, 0, 2e-14, 1000, room, &value, &error);
    return value;
}

static double
along_x(double t, void *ctx)
{
    const struct force *f = ctx;

    return point(f, t, f->u);
}

/* Divides the interval at the singularity if the cell contains the point. */
static double
along_y(double t, void *ctx)
{
    struct force *f = ctx;
    double from = f->x - f->a, to = f->x + f->a;

    f->u = t;
    if (from < 0 && to > 0)
        return integrate(along_x, f, from, 0, inner) + integrate(along_x, f, 0, to, inner);
    return integrate(along_x, f, from, to, inner);
}

static double
cell(struct force f)
{
    double from = f.y - f.b, to = f.y + f.b;

    if (from < 0 && to > 0)
        return integrate(along_y, &f, from, 0, outer) + integrate(along_y, &f, 0, to, outer);
    return integrate(along_y, &f, from, to, outer);
}

static void
test_coefficients_are_integrals(void **state)
{
    static const int at[][2] = {{0, 0}, {1, 0},  {0, 1},  {1, 1},  {2, 3},   {4, 5},
                                {5, 1}, {7, 20}, {31, 2}, {0, 47}, {90, 33}, {300, 1}};
    const struct rc_lattice lattice = {1.1e-6, 0.8e-6, 1, 1};
    double worst = 0;

    (void)state;
    gsl_set_error_handler_off();
    inner = gsl_integration_workspace_alloc(1000);
    outer = gsl_integration_workspace_alloc(1000);
    for (size_t p = 0; p < PAIRS; p++) {
        struct rc_shear shear;
        assert_int_equal(rc_pair_shear(&pairs[p], NAN, &shear, NULL), RC_OK);
        for (int k = 0; k < RC_SHEAR_KERNELS; k++) {
            const struct rc_shear_field field = {&shear, (enum rc_shear_which)k};
            const struct rc_kernel kernel = rc_shear_kernel(&field);
            for (size_t n = 0; n < sizeof at / sizeof *at; n++) {
                size_t i = (size_t)at[n][0], j = (size_t)at[n][1];
                struct force f = {&pairs[p],
                                  k,
                                  (double)i * lattice.dx,
                                  (double)j * lattice.dy,
                                  lattice.dx / 2,
                                  lattice.dy / 2,
                                  0};
                double *row = malloc((i + 1) * sizeof *row), truth = cell(f), size;
                /* relative to the kernel without its angular factor, because the kernel crosses zero */
                size = (1 + shear.kap) / (exact_pi * shear.estar) * 4 * f.a * f.b /
                       fmax(hypot(f.x, f.y), f.a);
                if (k >= RC_SHEAR_XZ)
                    size = fabs(shear.beta) / (1 + shear.kap) * size;
                kernel.rows(kernel.of, &lattice, i + 1, j, j + 1, row);
                if (size == 0) /* no coupling: equal bodies */
                    assert_true(row[i] == 0);
                else
                    worst = larger(worst, fabs(row[i] - truth) / size);
                free(row);
            }
        }
    }
    print_message("coefficients: %.1e\n", worst);
    assert_true(worst < quadrature);
    gsl_integration_workspace_free(inner);
    gsl_integration_workspace_free(outer);
}

/* ---- sums ---- */

static double
noise(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 9007199254740992.0 - 0.5;
}

struct maps {
    size_t n;
    double *q[2], *u[2], *p, *uz;
};

static struct maps
maps_new(size_t n, uint64_t seed)
{
    struct maps m = {.n = n};

    for (int k = 0; k < 2; k++) {
        m.q[k] = calloc(n, sizeof(double));
        m.u[k] = calloc(n, sizeof(double));
    }
    m.p = calloc(n, sizeof(double));
    m.uz = calloc(n, sizeof(double));
    for (size_t i = 0; i < n; i++) {
        m.q[0][i] = noise(&seed);
        m.q[1][i] = noise(&seed);
        m.p[i] = noise(&seed) + 0.5;
    }
    return m;
}

static void
maps_free(struct maps *m)
{
    for (int k = 0; k < 2; k++) {
        free(m->q[k]);
        free(m->u[k]);
    }
    free(m->p);
    free(m->uz);
}

static double
dot(size_t n, const double *a, const double *b, double *size)
{
    double sum = 0;

    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
        *size += fabs(a[i] * b[i]);
    }
    return sum;
}

static const struct rc_shape shapes[] = {{7, 5, 1.1, 0.9},  {16, 64, 1, 1}, {1, 9, 1, 2},
                                         {12, 1, 0.5, 0.5}, {33, 70, 1, 4}, {64, 64, 1, 1}};
enum {
    SHAPES = sizeof shapes / sizeof *shapes
};

/* Value of a kernel at a signed offset. */
static double
at_offset(const double *table, size_t nx, unsigned parity, ptrdiff_t i, ptrdiff_t j)
{
    double sign = (parity & RC_ODD_X && i < 0 ? -1 : 1) * (parity & RC_ODD_Y && j < 0 ? -1 : 1);

    return sign * table[(size_t)labs(j) * nx + (size_t)labs(i)];
}

static void
test_free_sums_are_double_sums(void **state)
{
    struct rc_shear shear;
    double worst = 0;

    (void)state;
    assert_int_equal(rc_pair_shear(&pairs[0], NAN, &shear, NULL), RC_OK);
    for (size_t s = 0; s + 1 < SHAPES; s++) {
        const struct rc_shape *shape = &shapes[s];
        size_t nx = shape->nx, ny = shape->ny, n = nx * ny;
        const struct rc_lattice lattice = {shape->dx, shape->dy, 1, 1};
        struct rc_tangential *t = rc_tangential_new(NULL, shape, RC_FREE, &shear, 2, NULL);
        struct maps m = maps_new(n, 3 + s);
        double *table[RC_SHEAR_KERNELS], *u[3], size[3] = {0, 0, 0};

        assert_non_null(t);
        for (int k = 0; k < RC_SHEAR_KERNELS; k++) {
            const struct rc_shear_field field = {&shear, (enum rc_shear_which)k};
            const struct rc_kernel kernel = rc_shear_kernel(&field);
            table[k] = malloc(n * sizeof(double));
            kernel.rows(kernel.of, &lattice, nx, 0, ny, table[k]);
        }
        for (int c = 0; c < 3; c++)
            u[c] = calloc(n, sizeof(double));
        for (size_t at = 0; at < n; at++)
            for (size_t from = 0; from < n; from++) {
                ptrdiff_t i = (ptrdiff_t)(at % nx) - (ptrdiff_t)(from % nx);
                ptrdiff_t j = (ptrdiff_t)(at / nx) - (ptrdiff_t)(from / nx);
                double v[RC_SHEAR_KERNELS];
                for (int k = 0; k < RC_SHEAR_KERNELS; k++)
                    v[k] = at_offset(table[k], nx, rc_shear_parity[k], i, j);
                u[0][at] += v[RC_SHEAR_XX] * m.q[0][from] + v[RC_SHEAR_XY] * m.q[1][from] -
                            v[RC_SHEAR_XZ] * m.p[from];
                u[1][at] += v[RC_SHEAR_XY] * m.q[0][from] + v[RC_SHEAR_YY] * m.q[1][from] -
                            v[RC_SHEAR_YZ] * m.p[from];
                u[2][at] += v[RC_SHEAR_XZ] * m.q[0][from] + v[RC_SHEAR_YZ] * m.q[1][from];
            }
        rc_tangential_apply(t, m.q, m.u);
        for (int c = 0; c < 2; c++)
            for (size_t k = 0; k < n; k++)
                u[c][k] -= m.u[c][k];
        rc_tangential_pressure(t, m.p, m.u);
        for (int c = 0; c < 2; c++)
            for (size_t k = 0; k < n; k++)
                u[c][k] -= m.u[c][k];
        rc_tangential_normal(t, m.q, m.uz);
        for (size_t k = 0; k < n; k++) {
            size[0] = fmax(size[0], fabs(m.uz[k]));
            size[1] = fmax(size[1], fabs(u[2][k] - m.uz[k]));
            size[2] = fmax(size[2], fmax(fabs(u[0][k]), fabs(u[1][k])));
        }
        worst = larger(worst, fmax(size[1], size[2]) / size[0]);
        for (int c = 0; c < 3; c++)
            free(u[c]);
        for (int k = 0; k < RC_SHEAR_KERNELS; k++)
            free(table[k]);
        maps_free(&m);
        rc_tangential_free(t);
    }
    print_message("double sums: %.1e\n", worst);
    assert_true(worst < 3e-13);
}

/* On a map that repeats along one axis: sums of the closed forms of waves along it. */
static void
test_sums_of_waves_are_double_sums(void **state)
{
    static const struct rc_shape maps[] = {{7, 5, 1.1, 0.9}, {8, 8, 1, 1},   {1, 9, 1, 2},
                                           {16, 1, 0.5, 3},  {6, 10, 1, 40}, {2, 31, 0.01, 1}};
    static const struct rc_boundary boundaries[] = {
        {.x = true}, {.y = true}, {.y = true, .datum = 3}};
    struct rc_shear shear;
    double worst = 0;

    (void)state;
    assert_int_equal(rc_pair_shear(&pairs[0], NAN, &shear, NULL), RC_OK);
    shear.estar = 1;
    for (size_t s = 0; s < 6; s++)
        for (int b = 0; b < 3; b++) {
            const struct rc_shape *shape = &maps[s];
            const size_t n = shape->nx * shape->ny;
            const struct line_pair pair = {shear.kap, shear.beta,
                                           rc_boundary_on(shape, boundaries[b]).datum};
            const bool along_x = boundaries[b].x;
            struct rc_tangential *t =
                rc_tangential_new(NULL, shape, boundaries[b], &shear, 2, NULL);
            struct maps m = maps_new(n, 3 + s), pushed = maps_new(n, 3 + s);
            struct dense d;
            double size = 0, off = 0;

            assert_non_null(t);
            line_matrix(&d, shape, boundaries[b], shear.kap);
            rc_tangential_apply(t, m.q, m.u);
            rc_tangential_pressure(t, m.p, pushed.u);
            rc_tangential_normal(t, m.q, m.uz);
            for (size_t at = 0; at < n; at++) {
                double u[2] = {0, 0}, p[2] = {0, 0}, uz = 0;
                for (size_t from = 0; from < n; from++) {
                    const double i = (double)(at % shape->nx) - (double)(from % shape->nx);
                    const double j = (double)(at / shape->nx) - (double)(from / shape->nx);
                    for (int c = 0; c < 2; c++) {
                        const double push =
                            line_at((c == 0) == along_x ? LINE_PUSH_ALONG : LINE_PUSH_ACROSS, shape,
                                    boundaries[b], &pair, i, j);
                        u[c] += d.t[(size_t)c * n + at][from] * m.q[0][from] +
                                d.t[(size_t)c * n + at][n + from] * m.q[1][from];
                        p[c] -= push * m.p[from];
                        uz += push * m.q[c][from];
                    }
                }
                for (int c = 0; c < 2; c++) {
                    size = fmax(size, fabs(u[c]));
                    off = larger(off, fabs(u[c] - m.u[c][at]));
                    off = larger(off, fabs(p[c] - pushed.u[c][at]));
                }
                off = larger(off, fabs(uz - m.uz[at]));
            }
            worst = larger(worst, off / size);
            maps_free(&m);
            maps_free(&pushed);
            rc_tangential_free(t);
        }
    print_message("double sums of waves: %.1e\n", worst);
    assert_true(worst < quadrature);
}

/* ---- in single precision ---- */

/* The inverse applied to T q gives q minus its mean, in single precision. On a periodic map this is tested
 * also on a map without waves of two nodes. */
static void
test_the_inverse_in_single_precision(void **state)
{
    const struct rc_shear shear = {1, 0.6, 0};
    double worst = 0;
    size_t tried = 0;

    (void)state;
    for (size_t s = 0; s < SHAPES; s++) {
        struct rc_tangential *t = rc_tangential_new(NULL, &shapes[s], RC_PERIODIC, &shear, 2, NULL);
        struct maps m = maps_new(shapes[s].nx * shapes[s].ny, 5);
        float *u[2];

        assert_non_null(t);
        rc_tangential_apply(t, m.q, m.u);
        for (int c = 0; c < 2; c++) {
            u[c] = malloc(m.n * sizeof(float));
            for (size_t k = 0; k < m.n; k++)
                u[c][k] = (float)m.u[c][k];
        }
        rc_tangential_inverse(t, u, u);
        for (int c = 0; c < 2 && shapes[s].nx % 2 == 1 && shapes[s].ny % 2 == 1; c++, tried++) {
            double mean = 0;
            for (size_t k = 0; k < m.n; k++)
                mean += m.q[c][k] / (double)m.n;
            for (size_t k = 0; k < m.n; k++)
                worst = larger(worst, fabs((double)u[c][k] - m.q[c][k] + mean));
        }
        free(u[0]);
        free(u[1]);
        maps_free(&m);
        rc_tangential_free(t);
    }
    print_message("single precision: %.1e\n", worst);
    assert_true(tried > 0 && worst < in_floats);
}

/* The response of T to waves on a free plane is (2 + kap)/(q E*). 0.84 of that at q = 1.5/dx is the
 * displacement of a node under its own traction. Along a strip the response decreases slowly with q, like a
 * logarithm: by 2/pi for each factor of e. */
static void
test_waves_of_planes_and_strips(void **state)
{
    const struct rc_shape plane = {256, 256, 1, 1}, strip = {4096, 1, 1, 1};
    const struct rc_lattice lattice = {1, 1, 1, 1};
    const struct rc_shear shear = {1, 0.5, 0};
    struct rc_tangential *t = rc_tangential_new(NULL, &plane, RC_FREE, &shear, 2, NULL);
    double self = 0, own, fall;

    (void)state;
    assert_non_null(t);
    for (int k = RC_SHEAR_XX; k <= RC_SHEAR_YY; k++) {
        const struct rc_shear_field field = {&shear, (enum rc_shear_which)k};
        const struct rc_kernel kernel = rc_shear_kernel(&field);
        kernel.rows(kernel.of, &lattice, 1, 0, 1, &own);
        self += own / 2;
    }
    assert_true(fabs(0.84 * rc_tangential_wave(t, 1.5) / self - 1) < 0.05);
    for (double q = 0.1; q < 1; q *= 2) {
        assert_true(fabs(rc_tangential_wave(t, q) * q / 2.5 - 1) < 0.05);
        assert_true(fabs(rc_tangential_power(t, q) - 1) < 0.1);
    }
    rc_tangential_free(t);
    t = rc_tangential_new(NULL, &strip, RC_FREE, &shear, 2, NULL);
    assert_non_null(t);
    fall = rc_tangential_wave(t, 0.01) - rc_tangential_wave(t, 0.02);
    print_message("a strip: falls by %.4f, as a logarithm by %.4f\n", fall,
                  2.5 / exact_pi * log(2));
    assert_true(fabs(fall / (2.5 / exact_pi * log(2)) - 1) < 0.05);
    assert_true(rc_tangential_power(t, 0.01) < 0.2);
    rc_tangential_free(t);
}

/* ---- waves ---- */

/* Plane strain, and antiplane, of a wave k along s. A unit traction along s displaces the surface by (1 -
 * nu)/(G k) along s and by (1 - 2 nu)/(2 G k) along z, a quarter of a wave later. A unit traction across s
 * displaces it by 1/(G k). */
static void
test_waves_are_plane_and_antiplane(void **state)
{
    static const int waves[][2] = {{1, 0}, {0, 3}, {2, 1}, {5, -4}, {-3, 7}};
    const struct rc_shape shape = {24, 27, 0.7, 1.3};
    size_t n = shape.nx * shape.ny;
    double worst = 0;

    (void)state;
    for (size_t p = 0; p < PAIRS; p++) {
        const struct rc_body *bodies[2] = {&pairs[p].one, &pairs[p].two};
        struct rc_shear shear;
        struct rc_tangential *t;
        struct maps m = maps_new(n, p);
        double along = 0, across = 0, couples = 0;

        for (int k = 0; k < 2; k++)
            if (bodies[k]->e > 0) {
                double g = bodies[k]->e / (2 * (1 + bodies[k]->nu)), nu = bodies[k]->nu;
                along += (1 - nu) / g;
                across += 1 / g;
                couples += (k == 0 ? 1 : -1) * (1 - 2 * nu) / (2 * g);
            }
        assert_int_equal(rc_pair_shear(&pairs[p], NAN, &shear, NULL), RC_OK);
        t = rc_tangential_new(NULL, &shape, RC_PERIODIC, &shear, 2, NULL);
        assert_non_null(t);
        for (size_t w = 0; w < sizeof waves / sizeof *waves; w++) {
            double kx = 2 * exact_pi * waves[w][0] / (shape.dx * (double)shape.nx);
            double ky = 2 * exact_pi * waves[w][1] / (shape.dy * (double)shape.ny);
            double k = hypot(kx, ky), sx = kx / k, sy = ky / k;
            for (int direction = 0; direction < 2; direction++) {
                double ax = direction == 0 ? sx : -sy, ay = direction == 0 ? sy : sx;
                double factor = direction == 0 ? along : across;
                for (size_t at = 0; at < n; at++) {
                    double phase = kx * shape.dx * (double)(at % shape.nx) +
                                   ky * shape.dy * (double)(at / shape.nx);
                    m.q[0][at] = ax * cos(phase);
                    m.q[1][at] = ay * cos(phase);
                    m.p[at] = sin(phase);
                }
                rc_tangential_apply(t, m.q, m.u);
                for (size_t at = 0; at < n; at++)
                    for (int c = 0; c < 2; c++)
                        worst = larger(worst, fabs(m.u[c][at] * k - factor * m.q[c][at]) / along);
                if (shear.beta == 0)
                    continue;
                rc_tangential_normal(t, m.q, m.uz);
                for (size_t at = 0; at < n; at++)
                    worst = larger(worst,
                                   fabs(m.uz[at] * k - (direction == 0 ? couples * m.p[at] : 0)) /
                                       along);
            }
        }
        rc_tangential_free(t);
        maps_free(&m);
    }
    print_message("waves: %.1e\n", worst);
    assert_true(worst < of_sum * 100);
}

/* ---- laws ---- */

static void
test_loads_and_displacements_are_reciprocal(void **state)
{
    struct rc_shear shear;
    double worst = 0;

    (void)state;
    assert_int_equal(rc_pair_shear(&pairs[0], NAN, &shear, NULL), RC_OK);
    for (size_t s = 0; s < SHAPES; s++)
        for (int boundary = 0; boundary < 4; boundary++) {
            size_t n = shapes[s].nx * shapes[s].ny;
            struct rc_tangential *t = rc_tangential_new(
                NULL, &shapes[s], rc_boundary_of(boundary & 1, boundary & 2), &shear, 2, NULL);
            struct maps a = maps_new(n, 11), b = maps_new(n, 12);
            double size = 0, there, back;

            assert_non_null(t);
            rc_tangential_apply(t, a.q, a.u);
            rc_tangential_apply(t, b.q, b.u);
            there = dot(n, a.u[0], b.q[0], &size) + dot(n, a.u[1], b.q[1], &size);
            back = dot(n, b.u[0], a.q[0], &size) + dot(n, b.u[1], a.q[1], &size);
            worst = larger(worst, fabs(there - back) / size);
            size = 0;
            rc_tangential_normal(t, a.q, a.uz);
            rc_tangential_pressure(t, b.p, b.u);
            there = dot(n, a.uz, b.p, &size);
            back = dot(n, b.u[0], a.q[0], &size) + dot(n, b.u[1], a.q[1], &size);
            if (size > 0)
                worst = larger(worst, fabs(there - back) / size);
            maps_free(&a);
            maps_free(&b);
            rc_tangential_free(t);
        }
    print_message("reciprocity: %.1e\n", worst);
    assert_true(worst < of_sum);
}

/* Equal bodies have no coupling; a body on a rigid one has (1 - 2 nu)/(2 (1 - nu)). */
static void
test_bodies_in_two_numbers(void **state)
{
    struct rc_shear shear;
    struct rc_err err;
    const struct rc_layer layer = {1e-6, 1e9, 0.3};

    (void)state;
    assert_int_equal(rc_pair_shear(&pairs[1], NAN, &shear, NULL), RC_OK);
    assert_true(fabs(shear.kap - 0.17 / 0.83) < rounding);
    assert_true(fabs(shear.beta - 0.66 / 1.66) < rounding);
    assert_true(fabs(shear.estar / (70e9 / (1 - 0.17 * 0.17)) - 1) < rounding);
    assert_int_equal(rc_pair_shear(&pairs[2], NAN, &shear, NULL), RC_OK);
    assert_true(fabs(shear.kap - 1) < rounding && shear.beta == 0);
    assert_int_equal(rc_pair_shear(&(struct rc_pair){.estar = 3e9}, 0.25, &shear, NULL), RC_OK);
    assert_true(shear.estar == 3e9 && fabs(shear.kap - 1 / 3.0) < rounding && shear.beta == 0);
    assert_int_equal(rc_pair_shear(&(struct rc_pair){.estar = 3e9}, 0.6, &shear, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "Poisson's ratio 0.6"));
    assert_int_equal(
        rc_pair_shear(&(struct rc_pair){.one = {.e = 1e9, .nu = 0.3, .layers = 1, .layer = &layer}},
                      NAN, &shear, &err),
        RC_FAIL);
    assert_non_null(strstr(err.text, "layers"));
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bodies_in_two_numbers),
        cmocka_unit_test(test_coefficients_are_integrals),
        cmocka_unit_test(test_free_sums_are_double_sums),
        cmocka_unit_test(test_sums_of_waves_are_double_sums),
        cmocka_unit_test(test_the_inverse_in_single_precision),
        cmocka_unit_test(test_waves_of_planes_and_strips),
        cmocka_unit_test(test_waves_are_plane_and_antiplane),
        cmocka_unit_test(test_loads_and_displacements_are_reciprocal),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
