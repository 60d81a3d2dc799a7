/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steady sliding over a viscoelastic half-space on a free map. The displacement is that of coefficients found
 * here one by one, by quadrature of Love's formula behind the cell; gap and pressure are those of a contact,
 * and the losses of all terms of the material are the friction. Slow and fast bodies are elastic. A mirrored
 * map slides backwards, and a turned one along y. A ball has the friction and the pressure of one on a
 * periodic map that is many times as large. The estimate is above the error. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/viscoelastic/sliding.h"

/* ---- coefficients by quadrature ---- */

static double
corner(double x, double y)
{
    return (x == 0 ? 0 : x * asinh(y / fabs(x))) + (y == 0 ? 0 : y * asinh(x / fabs(y)));
}

/* Love 1929: on a half-space of E* = 1. */
static double
cell(double x, double y, double a, double b)
{
    if (hypot(x, y) > 1000 * fmax(a, b))
        return 4 * a * b / (exact_pi * hypot(x, y));
    return (corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b) +
            corner(x - a, y - b)) /
           exact_pi;
}

/* The integral of exp(-s/L)/L B(x + s) over s > 0: the trapezoidal rule for s = L exp(t - exp(-t)), whose
 * points crowd where s is small. Kinks at the sides of the cell are ends of pieces. */
static double
wake(double x, double y, struct rc_shape m, double length)
{
    const double a = m.dx / 2, b = m.dy / 2, reach = 45 * length;
    const double ends[] = {0, fmin(fmax(-a - x, 0), reach), fmin(fmax(a - x, 0), reach), reach};
    double sum = 0;

    for (int piece = 0; piece < 3; piece++) {
        const double from = ends[piece], width = ends[piece + 1] - from;
        for (double t = -4.2; t < 4.2 && width > 0; t += 0.02) {
            const double u = exact_pi / 2 * sinh(t), s = from + width / (1 + exp(-2 * u));
            const double weight = width * exact_pi / 4 * cosh(t) / (cosh(u) * cosh(u)) * 0.02;
            sum += weight * exp(-s / length) / length * cell(x + s, y, a, b);
        }
    }
    return sum;
}

enum {
    NX = 22,
    NY = 15
};
static const struct rc_shape map = {NX, NY, 1.0 / NX, 0.06};
struct table {
    double k[NY][2 * NX], loss[NY][2 * NX]; /* displacement, and losses over the speed */
};

static void
tabulate(const struct rc_relaxation *r, double more, double speed, struct table *t)
{
    for (int j = 0; j < NY; j++)
        for (int i = -NX + 1; i < NX; i++) {
            const double x = i * map.dx * (speed < 0 ? -1 : 1), y = j * map.dy,
                         b = cell(x, y, map.dx / 2, map.dy / 2);
            double *k = &t->k[j][NX + i], *loss = &t->loss[j][NX + i];
            *k = (r->instant + more) * b;
            *loss = 0;
            for (size_t q = 0; q < r->creep_terms; q++) {
                const double length = fabs(speed) * r->retardation[q], w = wake(x, y, map, length);
                *k += r->compliance[q] * w;
                *loss += r->compliance[q] * (b - w) / length;
            }
        }
}

/* u = K p; the sum of p times the losses. */
static double
sum(const struct table *t, const double *p, double *u)
{
    double losses = 0;

    for (int a = 0; a < NX * NY; a++) {
        u[a] = 0;
        for (int b = 0; b < NX * NY; b++) {
            const int j = abs(a / NX - b / NX), i = NX + a % NX - b % NX;
            u[a] += t->k[j][i] * p[b];
            losses += p[a] * t->loss[j][i] * p[b];
        }
    }
    return losses;
}

/* The conditions of contact with the displacement of these coefficients. */
static void
contact(void **state)
{
    static double h[NX * NY], p[NX * NY], g[NX * NY], u[NX * NY], own[NX * NY];
    static struct table t;

    (void)state;
    for (int round = 0; round < 6; round++) {
        static const double speeds[] = {0.03, -0.2, 3, 0.003, 30, 1};
        struct rc_relaxation *r = round % 2 == 0 ? power_law(0.45, 0.1) : standard();
        const struct rc_sliding_problem law = {.material = r, .compliance = round == 2 ? 0.1 : 0};
        struct rc_model *m;
        const struct rc_sliding_figures *f;
        double losses, shift = 0, size = 0, count = 0, worst = 0, least = 0, off = 0,
                       top = -INFINITY;

        rough(map, 4, round < 3 ? 0 : 2, 3 + (uint64_t)round, h);
        m = sliding(map, RC_FREE, h, 1e-11, &law);
        f = slide_by(m, RC_LOAD, round < 3 ? 0.2 : 0.02, speeds[round]);
        frame(m, "pressure", p);
        frame(m, "gap", g);
        frame(m, "displacement", u);
        tabulate(r, law.compliance, speeds[round], &t);
        losses = sum(&t, p, own) * map.dx * map.dy;
        for (int k = 0; k < NX * NY; k++) {
            top = fmax(top, h[k]);
            shift += p[k] > 0 ? own[k] - h[k] : 0;
            count += p[k] > 0;
            size = fmax(size, fabs(own[k]));
        }
        shift /= count;
        for (int k = 0; k < NX * NY; k++) {
            const double gap = own[k] - h[k] - shift;
            off = fmax(off, fabs(u[k] - own[k]));
            worst = fmax(worst, p[k] > 0 ? fabs(gap) : fabs(g[k] - gap));
            least = fmin(least, gap);
        }
        printf("tan delta %.2f, %g nodes: K p off by %.1e, gap by %.1e; friction %.6f, by losses "
               "%.6f\n",
               f->tan_delta_max, count, off / size, worst / size, f->friction,
               losses / rc_model_number(m, "load"));
        assert_true(off < 1e-6 * size && worst < 1e-6 * size && least > -1e-6 * size);
        assert_true(fabs(f->friction_force / losses - 1) < 1e-5);
        assert_true(fabs(f->dissipated_power / (losses * fabs(speeds[round])) - 1) < 1e-5);
        assert_true(fabs(f->approach - shift - top) < 1e-6 * size);
        assert_true(f->friction > 0 && f->converged && f->pressure_error <= 1e-11);
        rc_model_free(m);
        rc_relaxation_free(r);
    }
}

/* The limits of small and large speed are elastic contacts on a free map. */
static void
limits(void **state)
{
    static double h[NX * NY], p[NX * NY], e[NX * NY];
    struct rc_relaxation *r = standard();
    const struct rc_sliding_problem law = {.material = r};

    (void)state;
    rough(map, 4, 1, 5, h);
    for (int k = 0; k < 3; k++) {
        static const double speeds[] = {0, 1e-7, 1e8};
        struct rc_model *m = sliding(map, RC_FREE, h, 1e-9, &law);
        const struct rc_problem problem = {
            .boundary = RC_FREE, .pair.estar = k < 2 ? 1 : 10, .tol = 1e-9, .threads = 1};
        struct rc_model *elastic = rc_elastic_new(&map, h, &problem, NULL, &err);
        const double mu = slide_by(m, RC_LOAD, 0.1, speeds[k])->friction;
        struct rc_point to = {0};

        assert_non_null(elastic);
        rc_point_set(&to, RC_LOAD, 0.1);
        assert_int_equal(rc_model_run(elastic, &to, &err), RC_OK);
        assert_int_equal(rc_model_look(elastic, NULL, &err), RC_OK);
        frame(m, "pressure", p);
        frame(elastic, "pressure", e);
        printf("speed %g: p %.1e, friction %.1e\n", speeds[k], difference(p, e, NX * NY), mu);
        assert_true(difference(p, e, NX * NY) < 1e-5);
        assert_true(fabs(mu) < 1e-4);
        rc_model_free(m);
        rc_model_free(elastic);
    }
    rc_relaxation_free(r);
}

/* A mirrored map that slides backwards, a turned one along y, and the approach in place of the load. */
static void
mirrored(void **state)
{
    static double h[NX * NY], other[NX * NY], p[NX * NY], q[NX * NY];
    const struct rc_shape turned = {NY, NX, map.dy, map.dx};
    struct rc_relaxation *r = standard();
    double mu = 0, approach = 0;

    (void)state;
    rough(map, 4, 1, 7, h);
    for (int round = 0; round < 4; round++) {
        const struct rc_sliding_problem law = {.material = r, .along_y = round == 2};
        const struct rc_sliding_figures *f;
        struct rc_model *m;
        for (int k = 0; k < NX * NY; k++)
            other[round == 1   ? k / NX * NX + NX - 1 - k % NX
                  : round == 2 ? k % NX * NY + k / NX
                               : k] = h[k];
        m = sliding(round == 2 ? turned : map, RC_FREE, other, 1e-10, &law);
        f = slide_by(m, round == 3 ? RC_APPROACH : RC_LOAD, round == 3 ? approach : 0.1,
                     round == 1 ? -0.4 : 0.4);
        frame(m, "pressure", q);
        for (int k = 0; k < NX * NY && round == 0; k++)
            p[k] = q[k];
        if (round == 0) {
            mu = f->friction;
            approach = f->approach;
        }
        for (int k = 0; k < NX * NY; k++)
            other[k] = q[round == 1   ? k / NX * NX + NX - 1 - k % NX
                         : round == 2 ? k % NX * NY + k / NX
                                      : k];
        printf("round %d: friction off by %.1e, p by %.1e\n", round, fabs(f->friction / mu - 1),
               difference(other, p, NX * NY));
        assert_true(fabs(f->friction / mu - 1) < 1e-7);
        assert_true(difference(other, p, NX * NY) < 1e-7);
        rc_model_free(m);
    }
    rc_relaxation_free(r);
}

/* A ball of radius 1; *p is the caller's to free. */
static double
ball(size_t side, double dx, struct rc_boundary boundary, double **p)
{
    const struct rc_shape s = {side, side, dx, dx};
    struct rc_relaxation *r = standard();
    const struct rc_sliding_problem law = {.material = r};
    struct rc_model *m;
    double mu;

    *p = malloc(side * side * sizeof **p);
    assert_non_null(*p);
    for (size_t k = 0; k < side * side; k++) {
        const double x = ((double)(k % side) - (double)(side - 1) / 2) * dx,
                     y = ((double)(k / side) - (double)(side - 1) / 2) * dx;
        (*p)[k] = -(x * x + y * y) / 2;
    }
    m = sliding(s, boundary, *p, 1e-6, &law);
    mu = slide_by(m, RC_LOAD, 0.03, 1)->friction;
    frame(m, "pressure", *p);
    rc_model_free(m);
    rc_relaxation_free(r);
    return mu;
}

/* A ball on a free map and in the middle of a large periodic one. Their cells differ at the edge of the
 * contact. Measured on 64 nodes in 8 periods, 128 and 256 nodes in 16: friction 4e-4, 4e-5, 4e-5; pressure
 * 5.5e-3, 1.8e-3, 8e-4. */
static void
periods_are_many(void **state)
{
    const size_t n = thorough(128, 64), periods = thorough(16, 8), side = n * periods;
    double *p, *q, *middle = malloc(n * n * sizeof *middle);
    const double mu = ball(n, 1 / (double)n, RC_FREE, &p),
                 of_many = ball(side, 1 / (double)n, RC_PERIODIC, &q);

    (void)state;
    assert_non_null(middle);
    for (size_t j = 0; j < n; j++)
        memcpy(middle + j * n, q + (j + (side - n) / 2) * side + (side - n) / 2,
               n * sizeof *middle);
    printf("%zu: friction off by %.1e, p by %.1e\n", n, mu / of_many - 1,
           difference(p, middle, n * n));
    assert_true(fabs(mu / of_many - 1) < (double)thorough(2, 10) * 1e-4);
    assert_true(difference(p, middle, n * n) < (double)thorough(3, 9) * 1e-3);
    free(p);
    free(q);
    free(middle);
}

/* Random materials, maps and loads: the estimates are above the errors. */
static void
estimates(void **state)
{
    enum {
        N = 40
    };
    static double h[N * N], p[N * N], exact[N * N];
    const struct rc_shape s = {N, N, 1.0 / N, 1.0 / N};
    static struct ratios of_pressure, of_friction;
    size_t refused = 0;
    double steepest = 0;

    (void)state;
    srand48(62);
    for (size_t seed = 0; seed < thorough(150, 6); seed++) {
        double modulus[6], time[6], mu;
        const double speed = exp(-6 + 7 * drand48()), load = exp(-5 + 4 * drand48());
        struct rc_sliding_problem law = {0};
        struct rc_relaxation *r;
        struct rc_point to = {0};
        struct rc_model *m;

        for (int k = 0; k < 6; k++) {
            time[k] = exp(-7 + 12 * drand48());
            modulus[k] = exp(-2 + 4 * drand48());
        }
        r = rc_relaxation_new(exp(-2 + 2 * drand48()), 1 + seed % 6, modulus, time, &err);
        assert_non_null(r);
        law.material = r;
        rough(s, 3 + (double)(seed % 3) * 3, (double)(seed % 4), 100 + seed, h);
        m = sliding(s, RC_FREE, h, 1e-9, &law);
        rc_point_set(&to, RC_LOAD, load / r->instant / 3);
        rc_point_set(&to, RC_SPEED, speed);
        if (rc_model_run(m, &to, &err) != RC_OK) {
            assert_non_null(strstr(err.text, "tan delta"));
            rc_model_free(m);
            rc_relaxation_free(r);
            refused++;
            continue;
        }
        assert_int_equal(rc_model_look(m, NULL, &err), RC_OK);
        mu = rc_sliding_result(m)->friction;
        steepest = fmax(steepest, rc_sliding_result(m)->tan_delta_max);
        frame(m, "pressure", exact);
        rc_model_free(m);
        for (double tol = 0.1; tol > 1e-5; tol /= 10) {
            const struct rc_sliding_figures *f;
            m = sliding(s, RC_FREE, h, tol, &law);
            f = slide_by(m, RC_LOAD, load / r->instant / 3, speed);
            frame(m, "pressure", p);
            add_ratio(&of_pressure, f->pressure_error, difference(p, exact, N * N));
            add_ratio(&of_friction, f->friction_error, fabs(f->friction / mu - 1));
            assert_true(f->converged && f->pressure_error <= tol);
            rc_model_free(m);
        }
        rc_relaxation_free(r);
    }
    printf("%zu refused; tan delta to %.2f\n", refused, steepest);
    show_ratios(&of_pressure, "pressure");
    show_ratios(&of_friction, "friction");
    assert_int_equal(of_pressure.below + of_friction.below, 0);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contact),          cmocka_unit_test(limits),    cmocka_unit_test(mirrored),
        cmocka_unit_test(periods_are_many), cmocka_unit_test(estimates),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
