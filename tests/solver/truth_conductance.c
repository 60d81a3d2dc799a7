/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The conductance of a contact, compared with closed forms for a circle, several circles, a circle in a
 * periodic cell and Hertz's contact. A dense system of equations serves for any contact, yielding or not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "tests/contact_case.h"

static const double estar = 71.3e9, k1 = 52, k2 = 16.3;

/* The conductivities of the two bodies. */
static double
resistivity(void)
{
    return 1 / k1 + 1 / k2;
}

struct found {
    struct rc_contact c;
    struct rc_conductance g;
    double stiffness;
    double *p;
};

static struct found
conducts(struct rc_shape shape, const double *h, struct rc_problem problem)
{
    size_t n = shape.nx * shape.ny;
    struct found f = {.p = malloc(n * sizeof(double))};
    struct rc_solver *s;
    struct rc_err err;

    problem.pair.estar = estar;
    problem.method = contact_method;
    problem.tol = 1e-8;
    s = rc_solver_new(&shape, h, &problem, &err);
    assert_non_null(s);
    f.c = finish(s);
    assert_int_equal(rc_solver_stiffness(s, &f.stiffness, &err), RC_OK);
    assert_int_equal(rc_solver_conductance(s, k1, k2, &f.g, &err), RC_OK);
    memcpy(f.p, rc_solver_pressure(s), n * sizeof *f.p);
    rc_solver_free(s);
    /* the definition, and that the lower bound is a bound */
    assert_true(fabs(f.g.value * estar * resistivity() / (2 * f.g.stiffness) - 1) < 1e-6);
    assert_true(f.g.lower <= f.g.value && f.g.lower > (1 - 1e-6) * f.g.value);
    return f;
}

/* ---- a dense system ---- */

static double
of_wave(struct rc_shape s, double x, double y)
{
    double sum = 0;

    for (size_t j = 0; j < s.ny; j++)
        for (size_t i = 0; i < s.nx; i++) {
            double m = i <= s.nx / 2 ? (double)i : (double)i - (double)s.nx;
            double n = j <= s.ny / 2 ? (double)j : (double)j - (double)s.ny;
            double qx = 2 * exact_pi * m / ((double)s.nx * s.dx);
            double qy = 2 * exact_pi * n / ((double)s.ny * s.dy);
            if (i + j > 0)
                sum += 2 / (estar * hypot(qx, qy)) * cos(qx * x + qy * y);
        }
    return sum / (double)(s.nx * s.ny);
}

/* Sum of t with K t = 1 on the nodes where p > 0, times the cell. */
static double
dense_stiffness(struct rc_shape shape, struct rc_boundary boundary, const double *p)
{
    size_t nodes = shape.nx * shape.ny, n = 0, *at = malloc(nodes * sizeof *at);
    double *a, *t, sum = 0;

    for (size_t k = 0; k < nodes; k++)
        if (p[k] > 0)
            at[n++] = k;
    a = malloc(n * n * sizeof *a);
    t = malloc(n * sizeof *t);
    for (size_t i = 0; i < n; i++) {
        t[i] = 1;
        for (size_t j = 0; j < n; j++) {
            double x = node_x(shape, at[i]) - node_x(shape, at[j]);
            double y = node_y(shape, at[i]) - node_y(shape, at[j]);
            a[i * n + j] = !rc_has_mean(boundary)
                               ? of_wave(shape, x, y)
                               : love_displacement(x, y, shape.dx / 2, shape.dy / 2, estar);
        }
    }
    for (size_t k = 0; k < n; k++) /* symmetric and positive: no pivot is needed */
        for (size_t i = k + 1; i < n; i++) {
            double l = a[i * n + k] / a[k * n + k];
            for (size_t j = k; j < n; j++)
                a[i * n + j] -= l * a[k * n + j];
            t[i] -= l * t[k];
        }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++)
            t[k] -= a[k * n + j] * t[j];
        t[k] /= a[k * n + k];
        sum += t[k];
    }
    free(a);
    free(t);
    free(at);
    return sum * shape.dx * shape.dy;
}

/* Rough contacts of 10 to 23 nodes are tested, elastic and with some nodes at the hardness, free and
 * periodic. The conjugate gradients stop at 1e-8 of the sum, and single precision adds an error. */
static void
any_contact(void **state)
{
    static const struct rc_shape shape = {13, 11, 1.1e-6, 1.3e-6};
    double *h = malloc(13 * 11 * sizeof *h);
    struct rc_err err;

    (void)state;
    for (int k = 0; k < 8; k++) {
        const struct rc_boundary boundary = k & 1 ? RC_PERIODIC : RC_FREE;
        struct rc_selfaffine rough = {.hurst = 0.7, .rms_slope = 0.1, .seed = 40 + (uint64_t)k};
        struct rc_problem problem = {.boundary = boundary, .load = 0.05};
        struct found f;
        double dense;

        assert_int_equal(rc_synth_selfaffine(&shape, &rough, h, &err), RC_OK);
        if (k & 2) {
            f = conducts(shape, h, problem);
            problem.hardness = 0.5 * f.c.max_pressure;
            free(f.p);
        }
        f = conducts(shape, h, problem);
        dense = 2 * dense_stiffness(shape, boundary, f.p) / (estar * resistivity());
        print_message("%s, %zu nodes, %zu at the hardness: conductance %+.1e, bound %+.1e off\n",
                      rc_boundary_word(boundary), f.c.contact_nodes, f.c.plastic_nodes,
                      f.g.value / dense - 1, f.g.lower / dense - 1);
        assert_true((f.c.plastic_nodes > 0) == (k > 1 && (k & 2) != 0));
        assert_true(fabs(f.g.value / dense - 1) < 3e-7);
        assert_true(f.g.lower <= dense * (1 + rounding));
        if (f.c.plastic_nodes > 0) /* nodes at the hardness carry no more load, but they conduct */
            assert_true(f.stiffness < 0.99 * f.g.stiffness);
        else
            assert_true(f.stiffness == f.g.stiffness);
        free(f.p);
    }
    free(h);
}

/* ---- circles ---- */

enum {
    CIRCLES = 16
};

struct circles {
    size_t n;
    double x[CIRCLES], y[CIRCLES]; /* positions of the middles, in spacings */
};

/* Flat punches with this radius in spacings, under load. */
static struct found
circles_conduct(struct rc_shape shape, const struct circles *c, double radius,
                struct rc_boundary boundary)
{
    size_t n = shape.nx * shape.ny, inside = 0;
    double *h = malloc(n * sizeof *h);
    struct found f;

    for (size_t k = 0; k < n; k++) {
        h[k] = -1e-3;
        for (size_t i = 0; i < c->n; i++)
            if (hypot(node_x(shape, k) / shape.dx - c->x[i],
                      node_y(shape, k) / shape.dx - c->y[i]) < radius) {
                h[k] = 0;
                inside++;
            }
    }
    f = conducts(shape, h, (struct rc_problem){.boundary = boundary, .load = 1});
    assert_int_equal(f.c.contact_nodes, inside);
    free(h);
    return f;
}

/* Radius of the circle with their area, in spacings. */
static double
radius_of(const struct found *f, const struct circles *c)
{
    return sqrt((double)f->c.contact_nodes / ((double)c->n * exact_pi));
}

/* The difference, in spacings, between the radius of the circle with the area of the cells and the radius
 * with their conductance. The pressure is constant in each cell and cannot follow the infinite pressure at
 * the edge. Dense systems of 45 to 716 cells give 0.09 to 0.13. */
static const double edge = 0.117, edge_scatter = 0.02;

/* For one circle it is 4 a/(1/k1 + 1/k2), with a reduced by that difference. Returns the radius with the
 * conductance of the cells, by a dense system, in spacings. */
static double
circle(double radius)
{
    static const struct circles one = {.n = 1};
    size_t side = 2 * (size_t)radius + 5;
    struct rc_shape shape = {side, side, 1e-6, 1e-6};
    struct found f = circles_conduct(shape, &one, radius, RC_FREE);
    double dense = dense_stiffness(shape, RC_FREE, f.p) / (2 * estar), a = radius_of(&f, &one);
    double form = 4 * (a - edge) * 1e-6 / resistivity();

    print_message("circle of %.3f: conductance %+.1e off its form, %+.1e off a dense system\n", a,
                  f.g.value / form - 1, f.g.value * resistivity() / (4 * dense) - 1);
    assert_true(fabs(f.g.value / form - 1) < edge_scatter / a);
    assert_true(fabs(f.g.value * resistivity() / (4 * dense) - 1) < 3e-7);
    free(f.p);
    return dense / 1e-6;
}

static void
one_circle(void **state)
{
    (void)state;
    for (double radius = 4; radius < 14; radius *= 1.3)
        (void)circle(radius);
}

/* 1/S of equal circles with a common potential. Each contributes 1/(2 a) to itself. To another circle at the
 * distance s it contributes 1/(pi s), if it is treated as a point (Greenwood 1966), or asin(a/s)/(pi a), its
 * potential at the centre of the other. */
static double
circles_resist(const struct circles *c, double a, double spacing, bool points)
{
    double m[CIRCLES][CIRCLES], t[CIRCLES], sum = 0;

    for (size_t i = 0; i < c->n; i++) {
        t[i] = 1;
        for (size_t j = 0; j < c->n; j++) {
            double s = spacing * hypot(c->x[i] - c->x[j], c->y[i] - c->y[j]);
            m[i][j] = i == j   ? 1 / (2 * a)
                      : points ? 1 / (exact_pi * s)
                               : asin(a / s) / (exact_pi * a);
        }
    }
    for (size_t k = 0; k < c->n; k++)
        for (size_t i = k + 1; i < c->n; i++) {
            double l = m[i][k] / m[k][k];
            for (size_t j = k; j < c->n; j++)
                m[i][j] -= l * m[k][j];
            t[i] -= l * t[k];
        }
    for (size_t k = c->n; k-- > 0;) {
        for (size_t j = k + 1; j < c->n; j++)
            t[k] -= m[k][j] * t[j];
        t[k] /= m[k][k];
        sum += t[k];
    }
    return 1 / sum;
}

/* Greenwood's sum, with equal currents. */
static double
greenwood(const struct circles *c, double a, double spacing)
{
    double n = (double)c->n, sum = 1 / (2 * n * a);

    for (size_t i = 0; i < c->n; i++)
        for (size_t j = 0; j < c->n; j++)
            if (i != j)
                sum +=
                    1 / (exact_pi * n * n * spacing * hypot(c->x[i] - c->x[j], c->y[i] - c->y[j]));
    return sum;
}

static void
several_circles(void **state)
{
    static const struct {
        struct circles c;
        struct rc_shape shape;
        double equal, point, smooth; /* bounds of the error of the closed forms */
    } cases[] = {
        {{2, {-20, 20}, {0, 0}}, {61, 21, 1e-6, 1e-6}, 2e-3, 2e-3, 1e-3},
        {{2, {-40, 40}, {0, 0}}, {101, 21, 1e-6, 1e-6}, 3e-4, 3e-4, 2e-4},
        {{9, {-32, 0, 32, -32, 0, 32, -32, 0, 32}, {-32, -32, -32, 0, 0, 0, 32, 32, 32}},
         {85, 85, 1e-6, 1e-6},
         4e-3,
         6e-3,
         1e-3},
        {{5, {-30, -10, 17, 31, 2}, {20, -22, -30, 12, 29}},
         {85, 85, 1e-6, 1e-6},
         4e-3,
         5e-3,
         1e-3},
    };
    double a = circle(8) * 1e-6;

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct circles *c = &cases[k].c;
        struct found f = circles_conduct(cases[k].shape, c, 8, RC_FREE);
        double r = 2 / (f.g.value * resistivity()), alone = 1 / (2 * a * (double)c->n);
        double equal = r / greenwood(c, a, 1e-6) - 1,
               point = r / circles_resist(c, a, 1e-6, true) - 1;
        double smooth = r / circles_resist(c, a, 1e-6, false) - 1;

        print_message(
            "%zu circles: resistance off Greenwood %+.1e, points %+.1e, asin %+.1e; alone %+.2f\n",
            c->n, equal, point, smooth, r / alone - 1);
        assert_true(fabs(equal) < cases[k].equal);
        assert_true(fabs(point) < cases[k].point);
        assert_true(fabs(smooth) < cases[k].smooth);
        assert_true(r > 1.05 * alone); /* the closed form is approximate */
        free(f.p);
    }
}

/* For a circle in each square cell of side L, to the mean plane, 1/S = 1/(2 a) - M/(pi L) + N a^2/(3 pi L^3).
 * M is the lattice sum of 1/r minus that of a uniform charge, -4 zeta(1/2) beta(1/2). N is the lattice sum of
 * 1/r^3, 4 zeta(3/2) beta(3/2). The potential of the other circles is (-M/L + N r^2/(4 L^3))/pi. The mean of
 * r^2 over the charge of a circle is 2 a^2/3, for source and field. The neglected terms are of the order
 * (a/L)^5. The waves that the nodes can represent have an edge that differs by a hundredth of a spacing. */
static void
periodic_cell(void **state)
{
    static const double m = 3.90026492, n = 9.03362168;
    static const struct circles one = {.n = 1};

    (void)state;
    for (size_t side = 49; side <= 197; side = 2 * side - 1) {
        struct rc_shape shape = {side, side, 1e-6, 1e-6};
        struct found f = circles_conduct(shape, &one, 8, RC_PERIODIC);
        double a = (radius_of(&f, &one) - edge) * 1e-6, length = (double)side * 1e-6;
        double form =
            1 / (2 * a) - m / (exact_pi * length) + n * a * a / (3 * exact_pi * pow(length, 3));
        double r = 2 / (f.g.value * resistivity());

        print_message("cell of %zu: resistance %+.1e off the form, %.2f of that on a half-space\n",
                      side, r / form - 1, 2 * a * r);
        assert_true(fabs(r - form) < (2 * edge_scatter * 1e-6 / a) / (2 * a));
        assert_true(2 * a * r < 0.92);
        free(f.p);
    }
}

/* Hertz: a sphere conducts like a circle of Hertz's radius, for any position of its centre between the nodes.
 * No correction of the area is needed: the excess of the computed area compensates the error at the edge. */
static void
sphere(void **state)
{
    (void)state;
    for (double nodes = 8; nodes < 33; nodes *= 2) {
        double a = 1e-4, radius = 7.5e-3, load = 4 * estar * a * a * a / (3 * radius);
        double truth = 4 * a / resistivity(), mean = 0, worst = 0, area = 0;
        size_t side = (size_t)(2.3 * nodes) + 2;
        struct rc_shape shape = {side, side, a / nodes, a / nodes};
        double *h = malloc(side * side * sizeof *h);

        for (int k = 0; k < 6; k++) {
            double x = 0.17 * k * shape.dx, y = 0.07 * k * k * shape.dx;
            struct found f;
            for (size_t i = 0; i < side * side; i++)
                h[i] =
                    -(pow(node_x(shape, i) - x, 2) + pow(node_y(shape, i) - y, 2)) / (2 * radius);
            f = conducts(shape, h, (struct rc_problem){.load = load});
            mean += (f.g.value / truth - 1) / 6;
            worst = larger(worst, fabs(f.g.value / truth - 1));
            area += (sqrt(f.c.contact_area / exact_pi) / a - 1) / 6;
            assert_true(fabs(f.g.value / truth - 1) < 0.11 / nodes);
            free(f.p);
        }
        print_message(
            "spheres, %.0f nodes in the radius: conductance %+.1e off in the mean, %.1e at "
            "worst, radius by the area %+.1e\n",
            nodes, mean, worst, area);
        assert_true(fabs(mean) < 0.04 / nodes);
        free(h);
    }
}

/* ---- no conductance ---- */

static void
nothing_to_say(void **state)
{
    static const struct rc_layer coat = {1e-6, 200e9, 0.2};
    struct rc_shape shape = {16, 16, 1e-6, 1e-6};
    struct rc_problem problem = {.load = 0.01, .tol = 1e-4};
    struct rc_conductance g;
    struct rc_solver *s;
    struct rc_err err;
    double h[256];

    (void)state;
    for (size_t k = 0; k < 256; k++)
        h[k] = -node_r(shape, k) * node_r(shape, k) / 2e-3;
    for (int layers = 0; layers < 2; layers++) {
        problem.pair = (struct rc_pair){
            .one = {.e = 100e9, .nu = 0.3, .layers = (size_t)layers, .layer = &coat},
            .two = {.e = 70e9, .nu = 0.2}};
        s = rc_solver_new(&shape, h, &problem, &err);
        assert_non_null(s);
        assert_int_equal(rc_solver_conductance(s, 1, 2, &g, &err), RC_FAIL); /* before its result */
        (void)finish(s);
        assert_int_equal(rc_solver_conductance(s, 1, 2, &g, &err), RC_OK);
        if (layers > 0) {
            assert_true(isnan(g.value) && isnan(g.lower) && isnan(g.stiffness));
        } else { /* two bodies with all moduli */
            double one = 1 / ((1 - 0.09) / 100e9 + (1 - 0.04) / 70e9);
            assert_true(fabs(g.value * one * 1.5 / (2 * g.stiffness) - 1) < 1e-6);
        }
        assert_int_equal(rc_solver_conductance(s, 0, 2, &g, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "conductivities 0 and 2"));
        assert_int_equal(rc_solver_conductance(s, 1, INFINITY, &g, &err), RC_FAIL);
        rc_solver_free(s);
    }
    /* complete contact of a periodic map: the mean planes are in contact, without resistance */
    for (size_t k = 0; k < 256; k++)
        h[k] = 0;
    problem = (struct rc_problem){.boundary = RC_PERIODIC, .pair.estar = estar, .load = 1};
    s = rc_solver_new(&shape, h, &problem, &err);
    assert_non_null(s);
    (void)finish(s);
    assert_int_equal(rc_solver_conductance(s, 1, 2, &g, &err), RC_OK);
    assert_true(isnan(g.value));
    rc_solver_free(s);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_contact),     cmocka_unit_test(one_circle),
        cmocka_unit_test(several_circles), cmocka_unit_test(periodic_cell),
        cmocka_unit_test(sphere),          cmocka_unit_test(nothing_to_say),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
