/* SPDX-License-Identifier: GPL-3.0-or-later */
/* On maps that repeat along one axis temperatures agree with integrals of Bessel functions, at all Peclet
 * numbers and in all directions of motion, with closed forms in time, and with images. */
#include <complex.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <setjmp.h> /* after stdarg.h and stddef.h: cmocka needs them */

#include <cmocka.h>
#include <gsl/gsl_sf_expint.h>

#include "libcontact/body/quadrature.h"
#include "libcontact/common.h"
#include "tests/exact.h"

static void
near(double value, double truth, double tolerance, const char *what)
{
    if (!(fabs(value - truth) <= tolerance))
        fail_msg("%s: %.15g instead of %.15g, off by %.2g, allowed %.2g", what, value, truth,
                 value - truth, tolerance);
}

/* ---- a wave of heat on a band ---- */

/* (1 - exp(-z))/z */
static double complex
mean_of_decay(double complex z)
{
    return cabs(z) < 1e-3 ? 1 - z / 2 * (1 - z / 3 * (1 - z / 4)) : (1 - cexp(-z)) / z;
}

/* M = sqrt(p^2 + Q^2 + 2 i Q across), and M - p without cancellation. */
static double complex
decay_of(double p, double q, double across, double complex *m)
{
    *m = csqrt(CMPLX(p * p + q * q, 2 * q * across));
    return p > 0 ? CMPLX(q * q, 2 * q * across) / (*m + p) : *m - p;
}

/* The steady temperature for k = 1 due to the heat exp(i Q y) of a band of half width l, at the distance x
 * from its middle:
 *
 *     1/pi int exp(p s) K0(M |s|) ds  from x - l to x + l
 *
 * K0(z) is the integral of exp(-z cosh t) over t > 0. The integral over s is done first, that over t = w sinh
 * v by the trapezoidal rule in v, whose error decreases exponentially with the number of points. */
static double complex
on_one_side(double from, double to, double p, double q, double across)
{
    static const double step = 0.02;
    double complex m, sum = 0, term = 0;
    const double complex off = decay_of(p, q, across, &m);
    const double width = fmin(1, 1 / sqrt(cabs(m) * to));

    for (int k = 0; k == 0 || cabs(term) > 1e-18 * cabs(sum); k++) {
        const double t = width * sinh(k * step), s = sinh(t / 2);
        const double complex decay = off + 2 * m * s * s;
        term = cexp(-decay * from) * (to - from) * mean_of_decay(decay * (to - from)) * width *
               cosh(k * step);
        sum += (k == 0 ? 0.5 : 1) * term;
    }
    return sum * step / RC_PI;
}

static double complex
on_surface(double x, double l, double p, double q, double across)
{
    const double from = x - l, to = x + l;

    return (to > 0 ? on_one_side(fmax(from, 0), to, p, q, across) : 0) +
           (from < 0 ? on_one_side(fmax(-to, 0), -from, -p, q, across) : 0);
}

/* exp(p s) K0(M r)/pi at a depth z, r^2 = s^2 + z^2 */
static double complex
line_source(double s, double z, double p, double q, double across)
{
    static const double step = 0.02;
    const double r = hypot(s, z);
    double complex m, sum = 0, term = 0;

    decay_of(p, q, across, &m);
    for (int k = 0; k == 0 || cabs(term) > 1e-18 * cabs(sum); k++) {
        term = cexp(p * s - m * r * cosh(k * step));
        sum += (k == 0 ? 0.5 : 1) * term;
    }
    return sum * step / RC_PI;
}

static double complex
at_depth(double x, double l, double z, double p, double q, double across)
{
    const int parts = (int)ceil(2 * l * (4 / z + 2 * hypot(p, across) + q));
    const double wide = 2 * l / parts;
    double complex sum = 0;

    for (int k = 0; k < parts; k++)
        for (int g = 0; g < RC_GAUSS_MOST; g++) {
            const struct rc_gauss at = rc_gauss_point(RC_GAUSS_MOST, g);
            sum +=
                wide / 2 * at.w * line_source(x - l + wide * (k + (1 + at.x) / 2), z, p, q, across);
        }
    return sum;
}

/* The temperature at a time t after heating began, kap = 1, as an integral over s = sqrt(4 kap (t - t')). */
static double complex
in_time(double x, double l, double z, double p, double q, double across, double t)
{
    const double end = sqrt(4 * t);
    double complex sum = 0;

    for (double from = 0, to; from < end; from = to) {
        to = fmin(end, from + fmin(fmax(from / 4, l / 40),
                                   1 / (4 * fabs(p) + q * (1 + fabs(across) * from))));
        for (int g = 0; g < RC_GAUSS_MOST; g++) {
            const struct rc_gauss at = rc_gauss_point(RC_GAUSS_MOST, g);
            const double s = from + (to - from) * (1 + at.x) / 2, moved = p * s * s / 2;
            sum += (to - from) / 2 * at.w * (erf((x + l - moved) / s) - erf((x - l - moved) / s)) /
                   2 * exp(-z * z / (s * s)) * cexp(-CMPLX(q * q, 2 * q * across) * s * s / 4);
        }
    }
    return sum / sqrt(RC_PI);
}

enum {
    FREE = 48,
    ROUND = 16,
    FIRST = 17 /* first node of the band along the free axis */
};

/* A band of n nodes across, with the heat 1 + cos(Q y + phase). The free axis is x, or y. */
struct band {
    bool x;
    int n, wave;
    double p, across; /* of body 2, along the free axis and along the other */
    double depth, time;
};
static const double spacing = 1.1, around = 0.9, phase = 0.3;

static size_t
node(const struct band *b, int i, int j)
{
    return (size_t)(b->x ? j * FREE + i : i * ROUND + j);
}

/* Temperature of body 2, with k = kap = 1, into which all heat flows. */
static void
heat_band(const struct band *b, double *t)
{
    static double q[FREE * ROUND];
    const struct rc_shape shape = {b->x ? FREE : ROUND, b->x ? ROUND : FREE,
                                   b->x ? spacing : around, b->x ? around : spacing};
    struct rc_heat_problem problem = {.boundary = rc_boundary_of(!b->x, b->x),
                                      .body = {{1, 1, {0, 0}, 0}, {1, 1, {0, 0}, 0}},
                                      .partition = RC_HEAT_SHARE,
                                      .time = b->time,
                                      .threads = 1};
    struct rc_err err = {""};
    struct rc_heat *h;

    problem.body[1].velocity[b->x ? 0 : 1] = 2 * b->p;
    problem.body[1].velocity[b->x ? 1 : 0] = 2 * b->across;
    memset(q, 0, sizeof q);
    for (int i = 0; i < b->n; i++)
        for (int j = 0; j < ROUND; j++)
            q[node(b, FIRST + i, j)] = 1 + cos(2 * RC_PI * b->wave * j / ROUND + phase);
    if ((h = rc_heat_new(&shape, &problem, q, NULL, &err)) == NULL)
        fail_msg("%s", err.text);
    assert_int_equal(rc_heat_step(h, &err), RC_OK);
    assert_int_equal(rc_heat_temperature(h, 1, b->depth, t, &err), RC_OK);
    rc_heat_free(h);
}

static double complex
exact(const struct band *b, double x, double q)
{
    const double l = b->n * spacing / 2;

    return b->time > 0    ? in_time(x, l, b->depth, b->p, q, b->across, b->time)
           : b->depth > 0 ? at_depth(x, l, b->depth, b->p, q, b->across)
                          : on_surface(x, l, b->p, q, b->across);
}

/* Compares every fifth line of nodes. */
static void
compare(const struct band *b, double tolerance)
{
    static double t[FREE * ROUND];
    const double q = 2 * RC_PI * b->wave / (ROUND * around);
    double most = 0;

    heat_band(b, t);
    for (int k = 0; k < FREE * ROUND; k++)
        most = fmax(most, t[k]);
    for (int i = 2; i < FREE; i += 5) {
        const double x = (i - FIRST - (b->n - 1) / 2.0) * spacing;
        const double complex mean = exact(b, x, 0), wave = exact(b, x, q);
        for (int j = 0; j < ROUND; j++)
            if (!(fabs(t[node(b, i, j)] - creal(mean) -
                       creal(wave * cexp(I * (2 * RC_PI * b->wave * j / ROUND + phase)))) <=
                  tolerance * most))
                fail_msg(
                    "p %g, across %g, wave %d, %d nodes, depth %g, time %g, node %d, %d: %.15g "
                    "instead of %.15g",
                    b->p, b->across, b->wave, b->n, b->depth, b->time, i, j, t[node(b, i, j)],
                    creal(mean + wave * cexp(I * (2 * RC_PI * b->wave * j / ROUND + phase))));
    }
}

/* From the free axis to the other. At small angles the wake of a wave turns slowly. */
static const double angle[] = {0,  1e-3, 0.1, 0.8, 1.3, 1.5, 1.57, 1.5707, 2, 3.1415926535897931,
                               -1, -1e-3};

/* Jaeger's band, moving in all directions; the mean of the heat moves along the free axis only. */
static void
steady(void **state)
{
    (void)state;
    for (int x = 0; x < 2; x++)
        for (int n = 1; n < 10; n += 8)
            for (int wave = 1; wave < ROUND / 2; wave += wave == 1 ? 2 : 4)
                for (double p = 0.01; p < 2e4; p *= 10)
                    for (size_t k = 0; k < sizeof angle / sizeof *angle; k++) {
                        const struct band b = {.x = x == 0,
                                               .n = n,
                                               .wave = wave,
                                               .p = p * cos(angle[k]),
                                               .across = p * sin(angle[k])};
                        compare(&b, 1e-11);
                    }
}

static void
below(void **state)
{
    (void)state;
    for (int x = 0; x < 2; x++)
        for (double depth = 0.8; depth < 10; depth *= 5)
            for (double p = 0.01; p < 20; p *= 10)
                for (size_t k = 0; k < sizeof angle / sizeof *angle; k += thorough(1, 5)) {
                    const struct band b = {.x = x == 0,
                                           .n = 4,
                                           .wave = 2,
                                           .depth = depth,
                                           .p = p * cos(angle[k]),
                                           .across = p * sin(angle[k])};
                    compare(&b, 1e-10);
                }
}

/* Also without motion along the free axis, and without any. */
static void
after_a_time(void **state)
{
    (void)state;
    for (int x = 0; x < 2; x++)
        for (double time = 0.3; time < 1e4; time *= 15)
            for (double p = 0; p < 200; p = p == 0 ? 0.02 : 10 * p)
                for (int k = 0; k < 5; k++) {
                    static const double turned[] = {0, 0.5, 1.1, 1.55, 0.5 * RC_PI};
                    const struct band b = {.x = x == 0,
                                           .n = 4,
                                           .wave = 2,
                                           .time = time,
                                           .depth = p == 2 ? 2 : 0,
                                           .p = k == 4 ? 0 : p * cos(turned[k]),
                                           .across = p * sin(turned[k])};
                    compare(&b, 1e-11);
                }
}

/* The middle of a band at rest that heats since t = 0 (Carslaw and Jaeger 1959, 10.5): 2 sqrt(kap t/pi)/k
 * [erf X + X/sqrt(pi) E1(X^2)], X = l/(2 sqrt(kap t)). */
static void
at_rest(void **state)
{
    (void)state;
    for (double time = 1; time < 1e7; time *= 10) {
        static double t[FREE * ROUND];
        const struct band b = {.x = true, .n = 9, .wave = 1, .time = time};
        const double half = 9 * spacing / (4 * sqrt(time)),
                     mean = 2 * sqrt(time / RC_PI) *
                            (erf(half) + half / sqrt(RC_PI) * gsl_sf_expint_E1(half * half));
        double sum = 0;

        heat_band(&b, t);
        for (int j = 0; j < ROUND; j++)
            sum += t[node(&b, FIRST + 4, j)] / ROUND;
        near(sum, mean, 1e-11 * mean, "middle of a band at rest");
    }
}

/* A body that hardly moves: K0(P s) = -ln(P s/2) - gamma near the band. */
static void
slow(void **state)
{
    (void)state;
    for (double p = 1e-5; p > 1e-30; p /= 100) {
        static double t[FREE * ROUND];
        const struct band b = {.x = true, .n = 1, .wave = 1, .p = p};
        const double half = spacing / 2,
                     truth = spacing / RC_PI * (1 - log(p * half / 2) - 0.57721566490153286);
        double sum = 0;

        heat_band(&b, t);
        for (int j = 0; j < ROUND; j++)
            sum += t[node(&b, FIRST, j)] / ROUND;
        near(sum, truth, (1e-11 + 10 * p) * truth, "a band that hardly moves");
    }
}

/* ---- images ---- */

enum {
    SIDE = 48,
    IMAGES = 5 /* odd */
};

/* A moving ball on a map that repeats is a row of balls on a free map. The heat is smooth, so that cells and
 * waves agree. */
static void
images(void **state)
{
    static double q[SIDE * SIDE * IMAGES], t[2][SIDE * SIDE * IMAGES];
    (void)state;

    for (int x = 0; x < 2; x++)
        for (int depth = 0; depth < 2; depth++) {
            for (int map = 0; map < 2; map++) {
                const size_t rows = map == 0 ? SIDE : SIDE * IMAGES;
                const struct rc_shape shape = {x == 0 ? SIDE : rows, x == 0 ? rows : SIDE, 1, 1};
                struct rc_heat_problem problem = {
                    .boundary = map == 0 ? rc_boundary_of(x == 1, x == 0) : RC_FREE,
                    .body = {{1, 1, {0, 0}, 0}, {1, 1, {0, 0}, 0}},
                    .partition = RC_HEAT_SHARE,
                    .threads = 1};
                struct rc_err err = {""};
                struct rc_heat *h;
                problem.body[1].velocity[x] = 1;
                problem.body[1].velocity[1 - x] = -0.3;
                for (size_t i = 0; i < SIDE; i++)
                    for (size_t j = 0; j < rows; j++)
                        q[x == 0 ? j * SIDE + i : i * rows + j] =
                            exp(-(pow((double)i - 12, 2) + pow((double)(j % SIDE) - 20, 2)) / 72);
                h = rc_heat_new(&shape, &problem, q, NULL, &err);
                if (h == NULL)
                    fail_msg("%s", err.text);
                assert_int_equal(rc_heat_step(h, &err), RC_OK);
                assert_int_equal(rc_heat_temperature(h, 1, 3 * depth, t[map], &err), RC_OK);
                rc_heat_free(h);
            }
            for (size_t i = 0; i < SIDE; i++)
                for (size_t j = 0; j < SIDE; j++) {
                    const size_t k = j + SIDE * (IMAGES / 2);
                    near(t[0][x == 0 ? j * SIDE + i : i * SIDE + j],
                         t[1][x == 0 ? k * SIDE + i : i * SIDE * IMAGES + k],
                         3e-3 * t[0][20 * SIDE + 12], "a row of balls");
                }
        }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steady),  cmocka_unit_test(below), cmocka_unit_test(after_a_time),
        cmocka_unit_test(at_rest), cmocka_unit_test(slow),  cmocka_unit_test(images),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
