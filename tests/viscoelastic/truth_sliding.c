/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steady sliding over a viscoelastic half-space. A cylinder has the pressure and the friction of Hunter 1961.
 * Waves in full contact have the friction of Persson's integral. On rough maps the displacement is that of
 * the complex compliance, summed here wave by wave; gap and pressure are those of a contact. Slow and fast
 * bodies are elastic. A mirrored map slides backwards, and a turned one along y. The power of the friction is
 * the sum of the losses in all terms of the material. The estimates are above the errors of p and of the
 * friction on the grid, and the work does not grow with the map. The friction by the slopes of both bodies is
 * the same on a fine grid. A restored state gives the same bits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdio.h>
#include <string.h>

#include "tests/viscoelastic/sliding.h"

/* Slides under a mean pressure. */
static const struct rc_sliding_figures *
slide(struct rc_model *m, double pressure, double speed)
{
    const struct rc_shape s = rc_model_shape(m);

    return slide_by(m, RC_LOAD, pressure * (double)(s.nx * s.ny) * s.dx * s.dy, speed);
}

/* ---- Hunter's cylinder ---- */

/* Modified Bessel functions by quadrature: I_n(x) exp(-x) and K_n(x). */
static double
bessel_i(int n, double x)
{
    const int steps = 4000;
    double sum = 0;

    for (int k = 0; k < steps; k++) {
        const double t = exact_pi * (k + 0.5) / steps;
        sum += exp(x * (cos(t) - 1)) * cos(n * t) / steps;
    }
    return sum;
}

static double
bessel_k(int n, double x)
{
    const double step = 1e-3;
    double sum = 0;

    for (double t = step / 2; x * cosh(t) < 700; t += step)
        sum += exp(-x * cosh(t)) * cosh(n * t) * step;
    return sum;
}

/* Hunter, J. Appl. Mech. 28 (1961) 611, for a half-width a of the contact, in units of 1/Jg or 1/Ji. */
struct hunter {
    double a, radius, length, glassy, relaxed;
    double f0, f1, c, load, middle;
};

static void
find_hunter(struct hunter *q)
{
    const double k = q->a * q->relaxed / (q->glassy * q->length), m = q->a / q->length;
    const double i0 = bessel_i(0, k), i1 = bessel_i(1, k), k0 = bessel_k(0, m), k1 = bessel_k(1, m);
    double b1, b2;

    q->f1 = q->a / (2 * q->radius);
    b1 = q->f1 * (i0 - i1 / k);
    b2 = q->f1 * (k0 + k1 / m);
    q->c = (b1 * k1 + b2 * i1) / (i0 * k1 + k0 * i1);
    q->f0 = (b1 - q->c * i0) / i1;
    q->load = exact_pi * q->a * (q->c - q->f1 / 2) / q->relaxed;
    q->middle = q->length + 2 * q->radius * q->f0;
}

/* The pressure at t = (x - middle)/a: the integral of exp(-k (s - t)) q(s), with s = sin(f). */
static double
hunter_pressure(const struct hunter *q, double t)
{
    const double k = q->a * q->relaxed / (q->glassy * q->length);
    const int steps = 2000;
    double sum = 0, from, step;

    if (fabs(t) >= 1)
        return 0;
    from = asin(t); /* 40/k further on the exponential is below rounding */
    step = (asin(fmin(1, t + 40 / k)) - from) / steps;
    for (int j = 0; j < steps; j++) {
        const double s = sin(from + (j + 0.5) * step);
        sum += exp(-k * (s - t)) * (q->c - q->f0 * s - q->f1 * s * s) * step;
    }
    return sum * q->a / (q->glassy * q->length);
}

/* The friction is the moment of the pressure about the middle of the cylinder, over R. */
static double
hunter_friction(const struct hunter *q)
{
    const int steps = 2000;
    double sum = 0;

    for (int j = 0; j < steps; j++) {
        const double t = -1 + 2 * (j + 0.5) / steps;
        sum += hunter_pressure(q, t) * (q->middle + t * q->a) * 2 * q->a / steps;
    }
    return sum / (q->load * q->radius);
}

static void
compare_hunter(struct hunter q, double *peak)
{
    enum {
        NODES = 128,
        PERIOD = 128, /* in widths of the contact */
        N = NODES * PERIOD
    };
    static double h[N], p[N], exact[N];
    const double node = 2 * q.a / NODES;
    const struct rc_shape s = {N, 1, node, node};
    struct rc_relaxation *r =
        rc_relaxation_new(1 / q.relaxed, 1, (double[]){1 / q.glassy - 1 / q.relaxed},
                          (double[]){q.glassy / q.relaxed}, &err);
    const struct rc_sliding_problem law = {.material = r};
    const struct rc_sliding_figures *f;
    struct rc_model *m;
    double mu, largest = 0;

    assert_non_null(r);
    find_hunter(&q);
    for (int i = 0; i < N; i++) {
        const double x = (i - (N - 1) / 2.0) * node;
        h[i] = -x * x / (2 * q.radius);
        exact[i] = hunter_pressure(&q, (x - q.middle) / q.a);
        largest = fmax(largest, exact[i]);
    }
    m = sliding(s, RC_PERIODIC, h, 1e-7, &law);
    f = slide(m, q.load / (N * node), q.length); /* the retardation time is 1 */
    frame(m, "pressure", p);
    mu = hunter_friction(&q);
    printf("L/a %g: mu %.5f, exact %.5f; p %.2e; peak %.5f\n", q.length / q.a, f->friction, mu,
           difference(p, exact, N), rc_model_number(m, "max_pressure") / largest);
    if (q.length < 11 * q.a) /* otherwise the body has not recovered after the period of the map */
        assert_true(fabs(f->friction / mu - 1) < 2e-3);
    assert_true(difference(p, exact, N) < 3e-3);
    assert_true(fabs(rc_model_number(m, "max_pressure") / largest - 1) < 1e-3);
    *peak = largest;
    rc_model_free(m);
    rc_relaxation_free(r);
}

static void
hunter(void **state)
{
    static const double at[][3] = {
        {0.1, 0.08527, 1.09191}, {1, 0.57531, 2.02642}, {10, 0.99704, 8.23909}};
    double peak;

    (void)state;
    for (int k = 0; k < 3; k++) {
        struct hunter q = {.a = 1, .radius = 10, .length = at[k][0], .glassy = 0.1, .relaxed = 1};
        find_hunter(&q); /* the published figures: friction, and load over the relaxed one */
        assert_true(fabs(hunter_friction(&q) * q.radius / q.a - at[k][1]) < 2e-5);
        assert_true(fabs(q.load * 4 * q.radius * q.relaxed / (exact_pi * q.a * q.a) - at[k][2]) <
                    2e-5);
        compare_hunter(q, &peak);
    }
}

/* The example visc_cylindr of the program CONTACT: a rubber wheel of radius 50 mm at 1 m/s under 600 N/mm,
 * G = 1143 N/mm2, nu = 0.4. It prints 78.73, 84.72 and 85.30 N/mm2 as largest pressure (Kalker, TU Delft).
 * The width of the contact follows from the load. */
static void
wheels(void **state)
{
    static const double length[] = {9, 45, 2000}, peaks[] = {78.73, 84.72, 85.30};

    (void)state;
    for (int k = 0; k < 3; k++) {
        struct hunter q = {
            .radius = 50, .length = length[k], .glassy = 0.6 / 1143, .relaxed = 1.2 / 1143};
        double low = 1, high = 20, peak;
        for (int j = 0; j < 60; j++) {
            q.a = (low + high) / 2;
            find_hunter(&q);
            *(q.load < 600 ? &low : &high) = q.a;
        }
        compare_hunter(q, &peak);
        assert_true(fabs(peak - peaks[k]) < 0.011);
    }
}

/* ---- full contact ---- */

/* Waves h_k cos(2 pi (a x + b y) + f) pressed flat: p = E*(i w) |q|/2 h. The friction over the mean pressure
 * is the sum of |q| qx Im E |h_k|^2/4 (Persson 2001, J. Chem. Phys. 115, 3840). */
static void
flattened(void **state)
{
    enum {
        NX = 48,
        NY = 36
    };
    static const double waves[][4] = {
        {1, 0, 1e-3, 0.3}, {3, -2, 4e-4, 1}, {5, 4, 2e-4, 2}, {-2, 7, 1e-4, 0.7}};
    const struct rc_shape s = {NX, NY, 1.0 / NX, 1.5 / NY};
    struct rc_relaxation *r = power_law(0.3, 0.5);
    const struct rc_sliding_problem law = {.material = r};
    const double speed = 0.02;
    static double h[NX * NY], p[NX * NY], exact[NX * NY];
    double mu = 0, pressure = 0;
    struct rc_model *m;
    const struct rc_sliding_figures *f;

    (void)state;
    for (size_t w = 0; w < sizeof waves / sizeof *waves; w++) {
        const double qx = 2 * exact_pi * waves[w][0], qy = 2 * exact_pi * waves[w][1] / 1.5;
        double e[2], j[2], sign = qx < 0 ? -1 : 1;
        rc_relaxation_dynamic(r, fabs(qx) * speed, e, j);
        mu += hypot(qx, qy) * fabs(qx) * e[1] * waves[w][2] * waves[w][2] / 4;
        for (size_t k = 0; k < NX * NY; k++) {
            const double complex z = cexp(
                I * (qx * (double)(k % NX) * s.dx + qy * (double)(k / NX) * s.dy + waves[w][3]));
            h[k] += waves[w][2] * creal(z);
            exact[k] += hypot(qx, qy) / 2 * waves[w][2] * creal((e[0] - I * sign * e[1]) * z);
        }
    }
    for (size_t k = 0; k < NX * NY; k++)
        pressure = fmax(pressure, -1.01 * exact[k]);
    for (size_t k = 0; k < NX * NY; k++)
        exact[k] += pressure;
    mu /= pressure;
    m = sliding(s, RC_PERIODIC, h, 1e-13, &law);
    f = slide(m, pressure, speed);
    frame(m, "pressure", p);
    assert_true(rc_model_number(m, "contact_fraction") == 1);
    assert_true(fabs(f->friction / mu - 1) < summed);
    assert_true(difference(p, exact, NX * NY) < summed);
    assert_true(fabs(f->dissipated_power / (f->friction_force * speed) - 1) < summed);
    rc_model_free(m);
    rc_relaxation_free(r);
}

/* ---- rough maps ---- */

enum {
    RX = 40,
    RY = 27
};
static const struct rc_shape map = {RX, RY, 1.0 / RX, 0.03};

/* J of a wave along x, from the moduli. */
static double complex
compliance_of(const struct rc_relaxation *r, double omega)
{
    double complex e = r->relaxed;

    for (size_t k = 0; k < r->terms; k++)
        e += r->modulus[k] * omega * r->time[k] / (omega * r->time[k] - I);
    return 1 / e;
}

/* Sums the waves one by one: the displacement, and the power that all terms of the creep compliance lose.
 * `fresh`: the row qx = 0 has the mean of J, here by quadrature. */
static double
sum_waves(const struct rc_relaxation *r, double speed, double more, bool fresh, const double *p,
          double *u)
{
    double power = 0;

    memset(u, 0, RX * RY * sizeof *u);
    for (int b = 0; b < RY; b++)
        for (int a = -RX / 2 + 1; a <= RX / 2; a++) {
            const double qx = 2 * exact_pi * a,
                         qy = 2 * exact_pi * (b > RY / 2 ? b - RY : b) / (RY * map.dy);
            double complex sum = 0, j = compliance_of(r, -qx * speed);
            if (a == 0 && b == 0)
                continue;
            if (a == 0 && fresh) {
                j = 0;
                for (int k = 0; k < 20000; k++)
                    j += creal(compliance_of(r, exact_pi * speed * (k + 0.5) / 20000)) / 20000;
            }
            j = 2 * a == RX || a == 0 ? creal(j) + more : j + more;
            for (int k = 0; k < RX * RY; k++)
                sum +=
                    p[k] * cexp(-I * (qx * (k % RX) * map.dx + qy * (k / RX) * map.dy)) / (RX * RY);
            for (int k = 0; k < RX * RY; k++)
                u[k] += creal(2 * j / hypot(qx, qy) * sum *
                              cexp(I * (qx * (k % RX) * map.dx + qy * (k / RX) * map.dy)));
            for (size_t k = 0; k < r->creep_terms && 2 * a != RX; k++) {
                const double y = qx * speed * r->retardation[k];
                power += 2 / hypot(qx, qy) * qx * speed * r->compliance[k] * y / (1 + y * y) *
                         creal(sum * conj(sum)) * RY * map.dy;
            }
        }
    return power;
}

/* The conditions of contact, with the displacement of the waves. */
static void
contact(void **state)
{
    static double h[RX * RY], p[RX * RY], g[RX * RY], u[RX * RY], own[RX * RY];

    (void)state;
    rough(map, 4, 0, 3, h);
    for (int round = 0; round < 6; round++) {
        struct rc_relaxation *r = round % 2 == 0 ? power_law(0.45, 0.1) : standard();
        const struct rc_sliding_problem law = {
            .material = r, .compliance = round == 2 ? 0.1 : 0, .repeats = round == 5};
        const double speed = round == 1 ? -0.1 : 0.03;
        struct rc_model *m = sliding(map, RC_PERIODIC, h, 1e-11, &law);
        const struct rc_sliding_figures *f = slide(m, round < 3 ? 0.3 : 0.03, speed);
        double power, shift = 0, size = 0, count = 0;

        frame(m, "pressure", p);
        frame(m, "gap", g);
        frame(m, "displacement", u);
        power = sum_waves(r, speed, law.compliance, !law.repeats, p, own);
        for (int k = 0; k < RX * RY; k++) {
            shift += p[k] > 0 ? own[k] - h[k] : 0;
            count += p[k] > 0;
            size = fmax(size, fabs(own[k]));
        }
        shift /= count;
        assert_in_range((uintmax_t)count, 20, RX * RY - 20);
        for (int k = 0; k < RX * RY; k++) {
            const double gap = own[k] - h[k] - shift;
            assert_true(fabs(g[k] - gap) < 1e-9 * size);
            assert_true(p[k] > 0 ? fabs(gap) < 1e-9 * size : gap > -1e-9 * size && p[k] == 0);
            assert_true(fabs(u[k] - u[0] - own[k] + own[0]) < 1e-10 * size);
        }
        assert_true(fabs(f->dissipated_power / power - 1) < 1e-9);
        assert_true(fabs(f->friction_force * fabs(speed) / power - 1) < 1e-9);
        assert_true(f->friction > 0 && f->converged && f->pressure_error <= 1e-11);
        rc_model_free(m);
        rc_relaxation_free(r);
    }
}

/* The limits of small and large speed are elastic contacts. */
static void
limits(void **state)
{
    static double h[RX * RY], p[RX * RY], e[RX * RY];
    struct rc_relaxation *r = standard();
    const struct rc_sliding_problem law = {.material = r};
    double mu[4];

    (void)state;
    rough(map, 4, 0, 5, h);
    for (int k = 0; k < 4; k++) {
        static const double speeds[] = {0, 1e-8, 1e-7, 1e8};
        struct rc_model *m = sliding(map, RC_PERIODIC, h, 1e-9, &law);
        const struct rc_problem problem = {
            .boundary = RC_PERIODIC, .pair.estar = k < 3 ? 1 : 10, .tol = 1e-9, .threads = 1};
        struct rc_model *elastic = rc_elastic_new(&map, h, &problem, NULL, &err);
        struct rc_point to = {0};

        assert_non_null(elastic);
        mu[k] = slide(m, 0.1, speeds[k])->friction;
        rc_point_set(&to, RC_LOAD, 0.1 * RY * 0.03);
        assert_int_equal(rc_model_run(elastic, &to, &err), RC_OK);
        assert_int_equal(rc_model_look(elastic, NULL, &err), RC_OK);
        frame(m, "pressure", p);
        frame(elastic, "pressure", e);
        assert_true(difference(p, e, RX * RY) < 1e-5);
        rc_model_free(m);
        rc_model_free(elastic);
    }
    assert_true(fabs(mu[0]) < summed);
    assert_true(fabs(mu[2] / mu[1] - 10) < 1e-3); /* proportional to the speed */
    assert_true(mu[3] < 1e-6);
    rc_relaxation_free(r);
}

/* The state of a reached point gives another model the same bits, on both kinds of maps. One of a point
 * half-way gives the same within the tolerance. */
static void
restored(void **state)
{
    static double h[RX * RY], p[RX * RY], q[RX * RY];
    struct rc_relaxation *r = standard();
    const struct rc_sliding_problem law = {.material = r};
    double approach[2] = {0, 0};

    (void)state;
    rough(map, 4, 1, 7, h);
    for (int round = 0; round < 12; round++) {
        const struct rc_boundary boundary = round % 2 == 0 ? RC_PERIODIC : RC_FREE;
        const int axis = round / 2 % 2 == 0 ? RC_LOAD : RC_APPROACH;
        const bool half_way = round >= 8;
        const double tol = half_way || round < 4 ? 1e-3 : 1e-8;
        struct rc_model *m = sliding(map, boundary, h, tol, &law);
        struct rc_model *other = sliding(map, boundary, h, tol, &law);
        const double speed = round % 3 == 0 ? -0.4 : 0.4;
        struct rc_sliding_figures f, g;
        struct rc_point to = {0};
        double *v;
        size_t n;
        bool going;

        rc_point_set(&to, axis, axis == RC_LOAD ? 0.1 : approach[round % 2]);
        rc_point_set(&to, RC_SPEED, speed);
        assert_int_equal(rc_model_go(m, &to, &err), RC_MORE);
        for (size_t k = 0; rc_model_step(m, &err) == RC_MORE && !(half_way && k > 12);)
            k++;
        n = rc_model_state_size(m);
        v = calloc(n, sizeof *v);
        assert_non_null(v);
        rc_model_state(m, v);
        /* a checkpoint stores the maps of a state as frames of the map */
        assert_true((double)n == v[0] + v[1] * RX * RY);
        while (rc_model_step(m, &err) == RC_MORE)
            continue;
        assert_int_equal(rc_model_restore(other, v, n, &going, &err), RC_OK);
        assert_true(going);
        while (rc_model_step(other, &err) == RC_MORE)
            continue;
        assert_int_equal(rc_model_look(m, NULL, &err), RC_OK);
        assert_int_equal(rc_model_look(other, NULL, &err), RC_OK);
        f = *rc_sliding_result(m);
        g = *rc_sliding_result(other);
        approach[round % 2] = f.approach;
        frame(m, "pressure", p);
        frame(other, "pressure", q);
        assert_true(f.converged && g.converged);
        if (half_way) {
            assert_true(difference(q, p, RX * RY) < 2 * tol);
        } else {
            assert_memory_equal(p, q, sizeof p);
            frame(m, "gap", p);
            frame(other, "gap", q);
            assert_memory_equal(p, q, sizeof p);
            assert_true(f.friction == g.friction && f.friction_error == g.friction_error &&
                        f.dissipated_power == g.dissipated_power && f.approach == g.approach &&
                        f.contacts == g.contacts && f.iterations == g.iterations);
        }
        free(v);
        rc_model_free(m);
        rc_model_free(other);
    }
    rc_relaxation_free(r);
}

/* A mirrored map that slides backwards, a map that is turned and slides along y, and an approach in place of
 * the load. */
static void
mirrored(void **state)
{
    static double h[RX * RY], other[RX * RY], p[RX * RY], q[RX * RY], back[RX * RY];
    const struct rc_shape turned = {RY, RX, map.dy, map.dx};
    struct rc_relaxation *r = standard();
    struct rc_sliding_problem law = {.material = r};
    struct rc_model *m;
    struct rc_point to = {0};
    double mu, approach;

    (void)state;
    rough(map, 4, 0, 7, h);
    m = sliding(map, RC_PERIODIC, h, 1e-10, &law);
    mu = slide(m, 0.2, 0.04)->friction;
    approach = rc_sliding_result(m)->approach;
    frame(m, "pressure", p);
    /* the same approach, after another speed */
    slide(m, 0.1, -0.02);
    assert_int_equal(rc_model_keep(m, &err), RC_OK);
    rc_point_set(&to, RC_APPROACH, approach);
    rc_point_set(&to, RC_SPEED, 0.04);
    assert_int_equal(rc_model_run(m, &to, &err), RC_OK);
    assert_int_equal(rc_model_look(m, NULL, &err), RC_OK);
    frame(m, "pressure", q);
    assert_true(difference(q, p, RX * RY) < 1e-7);
    assert_true(fabs(rc_sliding_result(m)->approach / approach - 1) < 1e-8);
    rc_model_free(m);
    for (int k = 0; k < RX * RY; k++)
        other[k] = h[k / RX * RX + RX - 1 - k % RX];
    m = sliding(map, RC_PERIODIC, other, 1e-10, &law);
    assert_true(fabs(slide(m, 0.2, -0.04)->friction / mu - 1) < 1e-8);
    frame(m, "pressure", q);
    for (int k = 0; k < RX * RY; k++)
        back[k] = q[k / RX * RX + RX - 1 - k % RX];
    assert_true(difference(back, p, RX * RY) < 1e-8);
    rc_model_free(m);
    for (int k = 0; k < RX * RY; k++)
        other[k % RX * RY + k / RX] = h[k];
    law.along_y = true;
    m = sliding(turned, RC_PERIODIC, other, 1e-10, &law);
    assert_true(fabs(slide(m, 0.2, 0.04)->friction / mu - 1) < 1e-8);
    frame(m, "pressure", q);
    for (int k = 0; k < RX * RY; k++)
        back[k] = q[k % RX * RY + k / RX];
    assert_true(difference(back, p, RX * RY) < 1e-8);
    rc_model_free(m);
    rc_relaxation_free(r);
}

/* ---- work and estimates ---- */

/* Convolutions to 1e-4 at tan delta 0.95 and 1.7, which do not grow with the map. */
static void
work(void **state)
{
    static double h[256 * 256];

    (void)state;
    for (size_t n = 128; n <= 256; n *= 2) {
        const struct rc_shape s = {n, n, 1 / (double)n, 1 / (double)n};
        rough(s, 8, 0, 1, h);
        for (int k = 0; k < (n == 128 ? 4 : 2); k++) {
            struct rc_relaxation *r = power_law(k % 2 == 0 ? 0.47 : 0.64, 1e-2);
            const struct rc_sliding_problem law = {.material = r};
            struct rc_model *m = sliding(s, RC_PERIODIC, h, 1e-4, &law);
            const struct rc_sliding_figures *f = slide(m, k < 2 ? 1 : 20, 0.03);
            printf("%zu: tan delta %.2f, contact %.3f: %.1f convolutions\n", n, f->tan_delta_max,
                   rc_model_number(m, "contact_fraction"), f->convolutions);
            assert_true(f->converged);
            assert_true(f->convolutions < (k % 2 == 0 ? 100 : 200));
            rc_model_free(m);
            rc_relaxation_free(r);
        }
    }
}

/* True if tan delta is too large at this speed. */
static bool
too_lossy(struct rc_model *m, double speed)
{
    struct rc_point to = {0};

    rc_point_set(&to, RC_LOAD, 1);
    rc_point_set(&to, RC_SPEED, speed);
    return rc_model_go(m, &to, &err) == RC_FAIL && strstr(err.text, "tan delta") != NULL;
}

/* A random material; `seed` has the number of its terms. */
static struct rc_relaxation *
random_material(size_t seed)
{
    double modulus[6], time[6];
    struct rc_relaxation *r;

    for (int k = 0; k < 6; k++) {
        time[k] = exp(-7 + 12 * drand48());
        modulus[k] = exp(-2 + 4 * drand48());
    }
    r = rc_relaxation_new(exp(-2 + 2 * drand48()), 1 + seed % 6, modulus, time, &err);
    assert_non_null(r);
    return r;
}

/* Random materials, maps, profiles and loads: the estimates are above the errors on the grid. */
static void
estimates(void **state)
{
    enum {
        N = 48 * 48
    };
    static double h[N], p[N], exact[N];
    static struct ratios of_pressure, of_friction;

    (void)state;
    srand48(61);
    for (size_t seed = 0; seed < thorough(300, 16); seed++) {
        const struct rc_shape s = seed % 4 == 3 ? (struct rc_shape){192, 1, 1.0 / 192, 1.0 / 192}
                                                : (struct rc_shape){48, 48, 1.0 / 48, 1.0 / 48};
        const double speed = exp(-6 + 5 * drand48()), load = exp(-4 + 4 * drand48());
        struct rc_relaxation *r = random_material(seed);
        const struct rc_sliding_problem law = {.material = r};
        const double pressure = load / r->instant / 3;
        struct rc_model *m;
        double mu;

        rough(s, 3 + (double)(seed % 3) * 3, 0, 100 + seed, h);
        m = sliding(s, RC_PERIODIC, h, 1e-9, &law);
        if (too_lossy(m, speed)) {
            rc_model_free(m);
            rc_relaxation_free(r);
            continue;
        }
        rc_model_free(m);
        m = sliding(s, RC_PERIODIC, h, 1e-9, &law);
        mu = slide(m, pressure, speed)->friction;
        frame(m, "pressure", exact);
        rc_model_free(m);
        for (double tol = 0.1; tol > 1e-5; tol /= 10) {
            const struct rc_sliding_figures *f;
            m = sliding(s, RC_PERIODIC, h, tol, &law);
            f = slide(m, pressure, speed);
            frame(m, "pressure", p);
            assert_true(f->converged && f->pressure_error <= tol);
            add_ratio(&of_pressure, f->pressure_error, difference(p, exact, s.nx * s.ny));
            add_ratio(&of_friction, f->friction_error, fabs(f->friction / mu - 1));
            rc_model_free(m);
        }
        rc_relaxation_free(r);
    }
    show_ratios(&of_pressure, "pressure");
    show_ratios(&of_friction, "friction");
    assert_int_equal(of_pressure.below + of_friction.below, 0);
}

/* Nodes of grids of 2, 4 and 8 times as many: the coefficients of friction by the slopes of both bodies come
 * together, and that of the rubber is the better one. */
static void
grids(void **state)
{
    enum {
        N = 16,
        WAVES = 40,
        GRIDS = 4
    };
    static double h[(N << (GRIDS - 1)) * (N << (GRIDS - 1))];
    double apart[GRIDS] = {0}, off[2][GRIDS] = {{0}};
    static struct ratios of_grid;

    (void)state;
    srand48(80);
    for (size_t seed = 0; seed < thorough(100, 6); seed++) {
        double wave[WAVES][4], rms = 0, mu[2][GRIDS], truth;
        const double speed = exp(-5 + 4 * drand48()), load = exp(-1.5 + 3 * drand48());
        struct rc_relaxation *r = random_material(seed);
        const struct rc_sliding_problem law = {.material = r};

        for (int w = 0; w < WAVES; w++) {
            wave[w][0] = 2 * exact_pi * floor(1 + 3 * drand48());
            wave[w][1] = 2 * exact_pi * floor(-3 + 7 * drand48());
            wave[w][2] = 2 * exact_pi * drand48();
            wave[w][3] = pow(hypot(wave[w][0], wave[w][1]), -1.8);
            rms += pow(wave[w][3] * hypot(wave[w][0], wave[w][1]), 2) / 2;
        }
        for (size_t g = 0; g < GRIDS; g++) {
            const size_t n = (size_t)N << g;
            const struct rc_shape s = {n, n, 1 / (double)n, 1 / (double)n};
            const struct rc_sliding_figures *f;
            struct rc_model *m;
            for (size_t k = 0; k < n * n; k++) {
                h[k] = 0;
                for (int w = 0; w < WAVES; w++)
                    h[k] += wave[w][3] / sqrt(rms) *
                            cos(wave[w][0] * ((double)(k % n) + 0.5) * s.dx +
                                wave[w][1] * ((double)(k / n) + 0.5) * s.dy + wave[w][2]);
            }
            m = sliding(s, RC_PERIODIC, h, 1e-6, &law);
            if (g == 0 && too_lossy(m, speed)) {
                rc_model_free(m);
                break;
            }
            rc_model_free(m);
            m = sliding(s, RC_PERIODIC, h, 1e-6, &law);
            f = slide(m, load * r->instant / 10, speed);
            mu[0][g] = f->friction;
            mu[1][g] = f->friction_by_heights;
            rc_model_free(m);
            if (g < GRIDS - 1)
                continue;
            truth = (mu[0][g] * 4 - mu[0][g - 1]) / 3;
            for (size_t k = 0; k < GRIDS; k++) {
                apart[k] += fabs(mu[0][k] - mu[1][k]) / truth;
                for (int q = 0; q < 2; q++)
                    off[q][k] += fabs(mu[q][k] / truth - 1);
                if (k < 2)
                    add_ratio(&of_grid, fabs(mu[0][k] - mu[1][k]) / truth,
                              fabs(mu[0][k] / truth - 1));
            }
        }
        rc_relaxation_free(r);
    }
    for (size_t k = 0; k < GRIDS - 1; k++) {
        printf("%3d nodes: %.4f and %.4f off, %.4f apart\n", N << k, off[0][k], off[1][k],
               apart[k]);
        assert_true(off[0][k] < off[1][k]);
        assert_true(apart[k + 1] < 0.6 * apart[k]);
    }
    show_ratios(&of_grid, "difference of both over the error of the grid, which it does not bound");
}

/* ---- what is refused ---- */

static void
refused(void **state)
{
    static const double h[RX * RY];
    struct rc_relaxation *solid = standard(),
                         *lossy = rc_relaxation_new(1, 1, (double[]){99}, (double[]){0.01}, &err),
                         *fluid = rc_relaxation_new(0, 1, (double[]){1}, (double[]){1}, &err);
    const struct rc_problem problem = {.boundary = RC_PERIODIC, .threads = 1};
    struct rc_problem other = problem;
    struct rc_sliding_problem law = {.material = fluid};
    struct rc_point to = {0};
    struct rc_model *m;

    (void)state;
    assert_non_null(lossy);
    assert_null(rc_sliding_new(&map, h, &problem, &law, &err));
    assert_non_null(strstr(err.text, "relaxed modulus is 0"));
    law = (struct rc_sliding_problem){.material = lossy, .repeats = true};
    assert_null(rc_sliding_new(&map, h, &problem, &law, &err));
    assert_non_null(strstr(err.text, "repeated track"));
    law = (struct rc_sliding_problem){.material = solid, .compliance = -1};
    assert_null(rc_sliding_new(&map, h, &problem, &law, &err));
    law.compliance = 0;
    other.boundary = RC_FREE;
    law.repeats = true;
    assert_null(rc_sliding_new(&map, h, &other, &law, &err));
    assert_non_null(strstr(err.text, "periodic"));
    law.repeats = false;
    other.boundary = rc_boundary_of(false, true);
    assert_null(rc_sliding_new(&map, h, &other, &law, &err));
    assert_non_null(strstr(err.text, "not implemented for maps that repeat along one axis only"));
    other = problem;
    other.hardness = 1;
    assert_null(rc_sliding_new(&map, h, &other, &law, &err));
    law.material = lossy;
    m = rc_sliding_new(&map, h, &problem, &law, &err);
    assert_non_null(m);
    rc_point_set(&to, RC_LOAD, 1);
    rc_point_set(&to, RC_SPEED, 1);
    assert_int_equal(rc_model_go(m, &to, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "tan delta"));
    rc_model_free(m);
    rc_relaxation_free(solid);
    rc_relaxation_free(lossy);
    rc_relaxation_free(fluid);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hunter),   cmocka_unit_test(wheels),    cmocka_unit_test(flattened),
        cmocka_unit_test(contact),  cmocka_unit_test(limits),    cmocka_unit_test(mirrored),
        cmocka_unit_test(work),     cmocka_unit_test(estimates), cmocka_unit_test(grids),
        cmocka_unit_test(restored), cmocka_unit_test(refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
