/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stresses under maps of traction agree with closed forms. These are partial slip of a sphere (the integral
 * of Cerruti's point loads) and a wave of traction in any direction (plane and antiplane strain). A mean
 * traction gives a uniform shear at all depths. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <gsl/gsl_integration.h>

#include "tests/contact_case.h"

static const double poisson = 0.3;

/* All six components at one depth; `out` holds a map for each. */
static void
slice(struct rc_shape shape, struct rc_boundary boundary, const double *p, const double *tx,
      const double *ty, double z, double *const out[RC_COMPONENTS])
{
    const struct rc_stress_options o = {.boundary = boundary,
                                        .body.nu = poisson,
                                        .wanted = (1U << RC_COMPONENTS) - 1,
                                        .threads = 2,
                                        .traction = {tx, ty}};
    double *to[RC_STRESSES] = {NULL};
    struct rc_err err = {""};
    struct rc_stress *stress = rc_stress_new(&shape, p, &o, &err);

    if (stress == NULL)
        print_error("%s\n", err.text);
    assert_non_null(stress);
    memcpy(to, out, RC_COMPONENTS * sizeof *to);
    assert_int_equal(rc_stress_slice(stress, z, to, &err), RC_OK);
    rc_stress_free(stress);
}

/* ---- Cattaneo and Mindlin ---- */

/* A sphere with the pressure p0 sqrt(1 - r^2/a^2), pulled in the direction phi. It carries the traction mu p
 * where it slips, and this less mu p0 c/a sqrt(1 - r^2/c^2) where it sticks, r < c (Johnson 1985, 7.2). */
static const double contact = 1, stick = 0.6, friction = 0.4, direction = 0.7;

struct disc {
    gsl_integration_workspace *inner;
    double x, y, z, radius, r;
    int component;
    bool pressure;
};

static double
around(double phi, void *at)
{
    static const int exchanged[] = {RC_SYY, RC_SXX, RC_SZZ, RC_SXY, RC_SYZ, RC_SXZ};
    const struct disc *d = at;
    double x = d->x - d->r * cos(phi), y = d->y - d->r * sin(phi), s[6], t[6];

    if (d->pressure) {
        point_stress(false, poisson, x, y, d->z, s);
        return s[d->component];
    }
    point_stress(true, poisson, x, y, d->z, s);
    point_stress(true, poisson, y, x, d->z, t);
    return cos(direction) * s[d->component] + sin(direction) * t[exchanged[d->component]];
}

/* The substitution r = radius sin(theta) removes the square root. */
static double
outwards(double theta, void *at)
{
    struct disc *d = at;
    gsl_function f = {.function = around, .params = d};
    double result, error;

    d->r = d->radius * sin(theta);
    gsl_integration_qag(&f, 0, 2 * exact_pi, 1e-11, 1e-10, 400, GSL_INTEG_GAUSS41, d->inner,
                        &result, &error);
    return result * d->radius * d->radius * cos(theta) * cos(theta) * sin(theta);
}

/* The stresses of a load sqrt(1 - r^2/radius^2). */
static double
of_disc(bool pressure, int component, double radius, double x, double y, double z,
        gsl_integration_workspace *space[2])
{
    struct disc d = {.inner = space[0],
                     .x = x,
                     .y = y,
                     .z = z,
                     .radius = radius,
                     .component = component,
                     .pressure = pressure};
    gsl_function f = {.function = outwards, .params = &d};
    double result, error;

    gsl_integration_qag(&f, 0, exact_pi / 2, 1e-11, 1e-10, 400, GSL_INTEG_GAUSS41, space[1],
                        &result, &error);
    return result;
}

/* The traction of a cell: the mean over 8 x 8 of its points. */
static double
cell_mean(struct rc_shape shape, size_t k, double radius)
{
    double sum = 0;

    for (int j = 0; j < 8; j++)
        for (int i = 0; i < 8; i++) {
            double x = node_x(shape, k) + ((i + 0.5) / 8 - 0.5) * shape.dx;
            double y = node_y(shape, k) + ((j + 0.5) / 8 - 0.5) * shape.dy;
            sum += sqrt(fmax(0, 1 - (x * x + y * y) / (radius * radius))) / 64;
        }
    return sum;
}

static void
partial_slip(void **state)
{
    static const double at[][3] = {
        {0, 0, 0.3}, {0.62, 0.1, 0.15}, {-0.9, 0.4, 0.3}, {0.3, -1.05, 0.4}, {1.1, 0.9, 1}};
    gsl_integration_workspace *space[2] = {gsl_integration_workspace_alloc(400),
                                           gsl_integration_workspace_alloc(400)};
    double last = 0;

    (void)state;
    for (size_t m = 48; m <= 192; m *= 2) {
        struct rc_shape shape = {m, m + 5, 2.6 * contact / (double)m, 2.5 * contact / (double)m};
        size_t n = shape.nx * shape.ny;
        double *map = malloc((3 + RC_COMPONENTS) * n * sizeof *map), *out[RC_COMPONENTS];
        double *p = map, *tx = map + n, *ty = map + 2 * n, worst = 0;
        for (size_t k = 0; k < n; k++) {
            double q;
            p[k] = cell_mean(shape, k, contact);
            q = friction * (p[k] - stick / contact * cell_mean(shape, k, stick));
            tx[k] = q * cos(direction);
            ty[k] = q * sin(direction);
        }
        for (int c = 0; c < RC_COMPONENTS; c++)
            out[c] = map + (size_t)(3 + c) * n;
        for (size_t q = 0; q < sizeof at / sizeof *at; q++) {
            size_t i = (size_t)(at[q][0] / shape.dx + (double)(shape.nx - 1) / 2 + 0.5);
            size_t j = (size_t)(at[q][1] / shape.dy + (double)(shape.ny - 1) / 2 + 0.5);
            size_t k = j * shape.nx + i;
            slice(shape, RC_FREE, p, tx, ty, at[q][2], out);
            for (int c = 0; c < RC_COMPONENTS; c++) {
                double x = node_x(shape, k), y = node_y(shape, k), z = at[q][2];
                double exact =
                    of_disc(true, c, contact, x, y, z, space) +
                    friction * (of_disc(false, c, contact, x, y, z, space) -
                                stick / contact * of_disc(false, c, stick, x, y, z, space));
                worst = fmax(worst, fabs(out[c][k] - exact));
            }
        }
        print_message("Cattaneo-Mindlin, %zu nodes: stresses within %.1e of p0\n", m, worst);
        /* dx^2/12 times the curvature of the stress, at these depths at most 6 p0/a^2 */
        assert_true(worst < shape.dx * shape.dx / 2);
        assert_true(m == 48 || worst < last / 2.5);
        last = worst;
        free(map);
    }
    for (int k = 0; k < 2; k++)
        gsl_integration_workspace_free(space[k]);
}

/* ---- a wave ---- */

/* Stresses of the traction cos(q s). Along the direction s of the wave they are in plane strain from Airy's
 * function z exp(-q z) sin(q s)/q. Across it, along t, they are in antiplane strain. Values are divided by
 * exp(-q z), in the axes s, t, z. */
static void
wave_stress(bool across, double qs, double qz, double s[3][3])
{
    memset(s, 0, 9 * sizeof(double));
    if (across) {
        s[0][1] = s[1][0] = -sin(qs);
        s[1][2] = s[2][1] = -cos(qs);
        return;
    }
    s[0][0] = (qz - 2) * sin(qs);
    s[2][2] = -qz * sin(qs);
    s[1][1] = poisson * (s[0][0] + s[2][2]);
    s[0][2] = s[2][0] = -(1 - qz) * cos(qs);
}

static void
waves(void **state)
{
    static const struct {
        size_t nx, ny;
        double dx, dy;
        double i, j; /* components of the wave */
    } cases[] = {{24, 19, 1, 1.3, 3, -2},
                 {16, 21, 0.7, 1, 0, 4},
                 {25, 18, 1, 1, -5, 0},
                 {9, 12, 2, 1, 1, 1}};
    static const int first[] = {0, 1, 2, 0, 0, 1}, second[] = {0, 1, 2, 1, 2, 2};
    double worst = 0;

    (void)state;
    for (size_t q = 0; q < sizeof cases / sizeof *cases; q++) {
        struct rc_shape shape = {cases[q].nx, cases[q].ny, cases[q].dx, cases[q].dy};
        size_t n = shape.nx * shape.ny;
        double qx = 2 * exact_pi * cases[q].i / ((double)shape.nx * shape.dx);
        double qy = 2 * exact_pi * cases[q].j / ((double)shape.ny * shape.dy);
        double size = hypot(qx, qy), mean[2] = {0.3, -0.2}, z = 0.8 / size;
        double axis[3][3] = {{qx / size, qy / size, 0}, {-qy / size, qx / size, 0}, {0, 0, 1}};
        double *map = calloc((3 + RC_COMPONENTS) * n, sizeof *map), *out[RC_COMPONENTS];
        double *tx = map + n, *ty = map + 2 * n, tall[2] = {1.5, -0.7}; /* along, across */
        for (int c = 0; c < RC_COMPONENTS; c++)
            out[c] = map + (size_t)(3 + c) * n;
        for (size_t k = 0; k < n; k++) {
            double wave = cos(qx * node_x(shape, k) + qy * node_y(shape, k) + 0.4);
            tx[k] = mean[0] + wave * (tall[0] * axis[0][0] + tall[1] * axis[1][0]);
            ty[k] = mean[1] + wave * (tall[0] * axis[0][1] + tall[1] * axis[1][1]);
        }
        slice(shape, RC_PERIODIC, map, tx, ty, z, out);
        for (size_t k = 0; k < n; k++)
            for (int c = 0; c < RC_COMPONENTS; c++) {
                double phase = qx * node_x(shape, k) + qy * node_y(shape, k) + 0.4;
                double exact = c == RC_SXZ ? -mean[0] : c == RC_SYZ ? -mean[1] : 0, s[3][3];
                for (int way = 0; way < 2; way++) {
                    wave_stress(way == 1, phase, size * z, s);
                    for (int a = 0; a < 3; a++)
                        for (int b = 0; b < 3; b++)
                            exact += tall[way] * exp(-size * z) * axis[a][first[c]] * s[a][b] *
                                     axis[b][second[c]];
                }
                worst = fmax(worst, fabs(out[c][k] - exact));
            }
        free(map);
    }
    print_message("waves of traction: within %.1e of their height\n", worst);
    assert_true(worst < rounding);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(partial_slip),
        cmocka_unit_test(waves),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
