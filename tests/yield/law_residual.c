/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual stress of an unloaded body that has yielded in its volume is in equilibrium. Its divergence is
 * 0, the surface is free, no plane carries a force, and tractions do not jump between slabs. The stresses are
 * computed at Chebyshev points of each slab, where they are smooth functions (exponentials times
 * polynomials), and differentiated there. Along z they are differentiated by the polynomial through these
 * points, along x and y by the waves through the nodes. Waves of two nodes along a direction have no
 * derivative at the nodes and are removed first. They cause only the local stress of their strain. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/yield/yield.h"
#include "tests/contact_case.h"

enum {
    SLABS = 9,
    BELOW = 2,   /* number of intervals below the slabs */
    POINTS = 32, /* number of points of an interval */
    NODES = 1200 /* at most                   */
};
static const double poisson = 0.3;

/* Stresses at the points of an interval. */
static double s[POINTS][RC_COMPONENTS][NODES];

/* ---- derivatives ---- */

/* Matrix of the derivative at the points, per half an interval, and weights that extrapolate to the upper and
 * the lower end. Chebyshev points of the first kind, with barycentric weights (Berrut and Trefethen, SIAM
 * Rev. 46, 2004, 501). */
struct along {
    double at[POINTS], by[POINTS][POINTS], end[2][POINTS];
};

static struct along
along_z(void)
{
    struct along z;
    double w[POINTS];

    for (int k = 0; k < POINTS; k++) {
        double angle = exact_pi * (2 * k + 1) / (2 * POINTS);
        z.at[k] = -cos(angle);
        w[k] = (k % 2 == 0 ? 1 : -1) * sin(angle);
    }
    for (int k = 0; k < POINTS; k++) {
        z.by[k][k] = 0;
        for (int l = 0; l < POINTS; l++)
            if (l != k) {
                z.by[k][l] = w[l] / w[k] / (z.at[k] - z.at[l]);
                z.by[k][k] -= z.by[k][l];
            }
    }
    for (int q = 0; q < 2; q++) {
        double sum = 0;
        for (int k = 0; k < POINTS; k++)
            sum += z.end[q][k] = w[k] / ((q == 0 ? -1 : 1) - z.at[k]);
        for (int k = 0; k < POINTS; k++)
            z.end[q][k] /= sum;
    }
    return z;
}

/* The derivative at node i of the sum of waves through n nodes that is 1 at node k and 0 at the others. */
static double
wave_derivative(size_t n, double d, size_t i, size_t k)
{
    double angle = exact_pi * ((double)i - (double)k) / (double)n, sign = (i + k) % 2 == 0 ? 1 : -1;

    if (i == k)
        return 0;
    return exact_pi / ((double)n * d) * sign / (n % 2 == 0 ? tan(angle) : sin(angle));
}

/* Adds df/dx, or df/dy, to `to`. */
static void
add_derivative(struct rc_shape shape, bool y, const double *f, double *to)
{
    size_t n = y ? shape.ny : shape.nx, step = y ? shape.nx : 1, other = y ? 1 : shape.nx;

    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++) {
            double by = wave_derivative(n, y ? shape.dy : shape.dx, i, k);
            for (size_t l = 0; l < shape.nx * shape.ny / n; l++)
                to[i * step + l * other] += by * f[k * step + l * other];
        }
}

static void
take_out_two_node_waves(struct rc_shape shape, bool y, double *f)
{
    size_t n = y ? shape.ny : shape.nx, step = y ? shape.nx : 1, other = y ? 1 : shape.nx;

    for (size_t l = 0; n % 2 == 0 && l < shape.nx * shape.ny / n; l++) {
        double sum = 0;
        for (size_t i = 0; i < n; i++)
            sum += (i % 2 == 0 ? 1 : -1) * f[i * step + l * other] / (double)n;
        for (size_t i = 0; i < n; i++)
            f[i * step + l * other] -= (i % 2 == 0 ? 1 : -1) * sum;
    }
}

/* ---- a body with residual stress ---- */

struct body {
    struct rc_shape shape;
    double yield, thickness[SLABS];
    double *map[SLABS * 5];
    struct rc_eigenstrain strain;
    struct rc_stress *stress;
    double none[NODES];
};

static void
press_and_let_go(struct body *b, const double *h, double hardening, double mean_pressure)
{
    const struct rc_shape *shape = &b->shape;
    size_t nodes = shape->nx * shape->ny;
    struct rc_yield_problem problem = {
        .contact = {.boundary = RC_PERIODIC,
                    .pair = {.one = {.e = 1, .nu = poisson}, .two.e = INFINITY},
                    .tol = 1e-4},
        .law = {.stress = b->yield, .modulus = hardening},
        .slabs = SLABS,
        .thickness = b->thickness,
        .increments = 8};
    struct rc_stress_options options = {.boundary = RC_PERIODIC,
                                        .body = {.e = 1, .nu = poisson},
                                        .wanted = (1U << RC_COMPONENTS) - 1,
                                        .strain = &b->strain};
    struct rc_yield_solver *plastic = rc_yield_solver_new(shape, h, &problem, NULL);
    double loads[2] = {mean_pressure * (double)nodes * shape->dx * shape->dy, 0}, most = 0;
    enum rc_status status;

    assert_non_null(plastic);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(rc_yield_solver_set_load(plastic, loads[k], NULL), RC_OK);
        while ((status = rc_yield_solver_step(plastic, NULL)) == RC_MORE)
            ;
        assert_int_equal(status, RC_OK);
    }
    for (size_t k = 0; k < SLABS; k++) {
        double *to[RC_YIELD_STRAINS] = {NULL};
        for (size_t c = 0; c < 5; c++)
            to[c] = b->map[k * 5 + c] = calloc(nodes, sizeof(double));
        rc_yield_solver_strain(plastic, k, to);
        for (size_t i = 0; i < nodes; i++)
            most = fmax(most, fabs(b->map[k * 5][i]));
    }
    assert_true(most > 0.1 * b->yield); /* yield/E is the elastic strain */
    rc_yield_solver_free(plastic);
    b->strain = (struct rc_eigenstrain){SLABS, b->thickness, (const double *const *)b->map};
    memset(b->none, 0, sizeof b->none);
    b->stress = rc_stress_new(shape, b->none, &options, NULL);
    assert_non_null(b->stress);
}

static void
forget(struct body *b)
{
    rc_stress_free(b->stress);
    for (size_t k = 0; k < SLABS * 5; k++)
        free(b->map[k]);
}

static void
slice(const struct body *b, double depth, double (*to)[NODES])
{
    double *const at[RC_STRESSES] = {to[0], to[1], to[2], to[3], to[4], to[5]};

    assert_int_equal(rc_stress_slice(b->stress, depth, at, NULL), RC_OK);
    for (int c = 0; c < RC_COMPONENTS; c++) {
        take_out_two_node_waves(b->shape, false, to[c]);
        take_out_two_node_waves(b->shape, true, to[c]);
    }
}

/* ---- equilibrium ---- */

/* Components of the stress on a plane x, y or z = constant. */
static const enum rc_component row_of[3][3] = {
    {RC_SXX, RC_SXY, RC_SXZ}, {RC_SXY, RC_SYY, RC_SYZ}, {RC_SXZ, RC_SYZ, RC_SZZ}};

/* The errors are over the yield stress. The first is that of the divergence times dx, ... */
struct wrong {
    double divergence, surface, plane, face;
};

static void
tell(double *most, double value, double yield)
{
    assert_true(isfinite(value));
    *most = fmax(*most, fabs(value) / yield);
}

static void
in_interval(const struct body *b, const struct along *z, double half, struct wrong *wrong)
{
    size_t nodes = b->shape.nx * b->shape.ny;
    double div[NODES];

    for (int q = 0; q < 3; q++)
        for (int k = 0; k < POINTS; k++) {
            double force = 0;
            memset(div, 0, sizeof div);
            add_derivative(b->shape, false, s[k][row_of[q][0]], div);
            add_derivative(b->shape, true, s[k][row_of[q][1]], div);
            for (int l = 0; l < POINTS; l++)
                for (size_t i = 0; i < nodes; i++)
                    div[i] += z->by[k][l] / half * s[l][row_of[q][2]][i];
            for (size_t i = 0; i < nodes; i++) {
                tell(&wrong->divergence, div[i] * b->shape.dx, b->yield);
                force += s[k][row_of[q][2]][i] / (double)nodes;
            }
            tell(&wrong->plane, force, b->yield);
        }
}

static void
in_equilibrium(const struct body *b, const char *name)
{
    const struct along z = along_z();
    size_t nodes = b->shape.nx * b->shape.ny;
    static double before[3][NODES], surface[RC_COMPONENTS][NODES];
    struct wrong wrong = {0};
    double top = 0, most = 0;

    slice(b, 0, surface);
    for (int q = 0; q < 3; q++)
        for (size_t i = 0; i < nodes; i++)
            tell(&wrong.surface, surface[row_of[q][2]][i], b->yield);
    for (size_t k = 0; k < SLABS + BELOW; k++) {
        double half = b->thickness[k < SLABS ? k : SLABS - 1] / 2;
        for (int l = 0; l < POINTS; l++) {
            slice(b, top + half * (1 + z.at[l]), s[l]);
            for (size_t i = 0; i < nodes; i++)
                most = fmax(most, fabs(s[l][RC_SXX][i]) / b->yield);
        }
        in_interval(b, &z, half, &wrong);
        for (int q = 0; q < 3; q++)
            for (size_t i = 0; i < nodes; i++) {
                double end[2] = {0};
                for (int l = 0; l < POINTS; l++)
                    for (int side = 0; side < 2; side++)
                        end[side] += z.end[side][l] * s[l][row_of[q][2]][i];
                tell(&wrong.face, end[0] - (k == 0 ? 0 : before[q][i]), b->yield);
                before[q][i] = end[1];
            }
        top += 2 * half;
    }
    print_message("%s: largest sxx %.2f Y; over Y: divergence %.1e/dx, traction on the surface "
                  "%.1e, forces on planes "
                  "%.1e, jumps of traction %.1e\n",
                  name, most, wrong.divergence, wrong.surface, wrong.plane, wrong.face);
    assert_true(most > 0.1);
    assert_true(wrong.divergence < 1e-8);
    assert_true(wrong.surface < 1e-8);
    assert_true(wrong.plane < 1e-8);
    assert_true(wrong.face < 1e-8);
}

static void
set_slabs(struct body *b, double first, double growth)
{
    for (size_t k = 0; k < SLABS; k++, first *= growth)
        b->thickness[k] = first;
}

static void
under_a_ball(void **state)
{
    static struct body b = {.shape = {32, 32, 1, 1}, .yield = 0.02};
    double h[NODES];

    (void)state;
    set_slabs(&b, 0.5, 1.2);
    for (size_t k = 0; k < 32 * 32; k++)
        h[k] = -pow(node_r(b.shape, k), 2) / 80;
    press_and_let_go(&b, h, 0.01, 0.003);
    in_equilibrium(&b, "ball");
    forget(&b);
}

/* The bodies have no hardening, odd rows and oblong cells. */
static void
rough(void **state)
{
    static struct body b = {.shape = {30, 27, 1, 1.2}, .yield = 0.03};
    const struct rc_selfaffine surface = {
        .hurst = 0.8, .rms_slope = 0.2, .short_cut = 4, .rolloff = 20, .seed = 3};
    double h[NODES];

    (void)state;
    set_slabs(&b, 0.6, 1.15);
    assert_int_equal(rc_synth_selfaffine(&b.shape, &surface, h, NULL), RC_OK);
    press_and_let_go(&b, h, 0, 0.015);
    in_equilibrium(&b, "rough");
    forget(&b);
}

static void
profile(void **state)
{
    static struct body b = {.shape = {64, 1, 1, 1}, .yield = 0.01};
    double h[NODES];

    (void)state;
    set_slabs(&b, 1, 1.1);
    for (size_t k = 0; k < 64; k++)
        h[k] = cos(2 * exact_pi * (double)k / 64) + 0.2 * sin(6 * exact_pi * (double)k / 64);
    press_and_let_go(&b, h, 0.02, 0.01);
    in_equilibrium(&b, "profile");
    forget(&b);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(under_a_ball),
        cmocka_unit_test(rough),
        cmocka_unit_test(profile),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
