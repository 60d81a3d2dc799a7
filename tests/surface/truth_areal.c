/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parameters of ISO 25178-2 equal closed forms for waves, ramps, chequerboards, posts, caps, grooves and
 * given height distributions. For maps with holes they equal plain double sums. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>

#include "tests/exact.h"
#include "libcontact/contact.h"

/* Tolerance against closed forms of continuous surfaces, with n nodes in a length: this constant over n^2.
 * There |h| has a kink or the correlation is a straight line between nodes. For |cos| with n nodes in a
 * period the constant is pi^2/3. */
static const double node_square = 4;

static void
near_at(const char *name, double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance * fabs(expected)))
        fail_msg("%s: %.17g instead of %.17g", name, got, expected);
}
#define assert_near(a, name, expected, tolerance) near_at(#name, (a).name, expected, tolerance)

static void
assert_zero(double got, double scale)
{
    if (!(fabs(got) <= summed * scale))
        fail_msg("%.17g instead of 0, beside %g", got, scale);
}

static struct rc_areal
measured(const struct rc_shape *shape, const double *h, struct rc_boundary boundary)
{
    const struct rc_surface_options options = {.boundary = boundary, .threads = 2};
    struct rc_areal a;
    struct rc_err err;

    if (rc_areal(shape, h, &options, &a, &err) != RC_OK)
        fail_msg("%s", err.text);
    assert_near(a, sz, a.sp + a.sv, rounding);
    return a;
}

static double *
room(const struct rc_shape *s)
{
    double *h = malloc(s->nx * s->ny * sizeof *h);

    assert_non_null(h);
    return h;
}

/* ---- waves ---- */

/* A cos(qx x) cos(qy y) with q the same in both directions, whole periods of 40 x 44 nodes. */
static void
test_wave(void **state)
{
    const struct rc_shape s = {200, 176, 1.1e-6, 1e-6};
    const double A = 0.7e-9, L = 44e-6, q = 2 * exact_pi / L, grid = node_square / (40.0 * 40);
    double *h = room(&s);
    struct rc_areal a;

    (void)state;
    rc_synth_wave(&s, A, L, L, h);
    a = measured(&s, h, RC_PERIODIC);
    assert_near(a, sq, A / 2, rounding);
    assert_near(a, sa, 4 * A / (exact_pi * exact_pi), 2 * grid);
    assert_zero(a.ssk, 1);
    assert_near(a, sku, 9.0 / 4, summed);
    assert_near(a, sp, A, 10 * grid); /* two half steps beside a crest */
    assert_near(a, sv, A, 10 * grid);
    /* pairs of less than one period, of 4 or 5, are omitted at the edges */
    assert_near(a, sdq, q * A / sqrt(2), coarse_grid);
    assert_near(a, sdr, q * q * A * A / 4, 2 * coarse_grid); /* slopes of 1e-4: half their square */
    /* second differences of a cosine: -q^2 becomes -2 (1 - cos q dx) / dx^2, exactly */
    assert_near(a, rms_curvature,
                A / 2 * ((1 - cos(q * s.dx)) / (s.dx * s.dx) + (1 - cos(q * s.dy)) / (s.dy * s.dy)),
                summed);
    assert_near(a, rms_curvature, q * q * A / 2, coarse_grid);
    assert_near(a, sal, acos(0.2) / q, grid);
    assert_near(a, str, acos(0.2) / (sqrt(2) * acos(sqrt(0.2))), 2 * grid);
    free(h);
}

/* One wave across the map, m periods along x and n along y. */
static struct rc_areal
oblique(const struct rc_shape *s, double m, double n, struct rc_boundary boundary)
{
    double *h = room(s);
    struct rc_areal a;

    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = 0; i < s->nx; i++)
            h[j * s->nx + i] =
                3e-9 *
                cos(2 * exact_pi * (m * (double)i / (double)s->nx + n * (double)j / (double)s->ny));
    a = measured(s, h, boundary);
    free(h);
    return a;
}

/* Ridges: y goes down the picture, angles go up. */
static void
test_ridges(void **state)
{
    const struct rc_shape s = {240, 180, 1.1e-6, 1e-6};
    const double Lx = 264e-6, Ly = 180e-6, q = 2 * exact_pi * 6 / Lx;
    struct rc_areal a = oblique(&s, 6, 0, RC_PERIODIC);

    (void)state;
    assert_near(a, sq, 3e-9 / sqrt(2), rounding);
    assert_near(a, sku, 1.5, summed);
    assert_near(a, sa, 6e-9 / exact_pi, node_square / (40.0 * 40));
    assert_near(a, sal, acos(0.2) / q, node_square / (40.0 * 40));
    assert_true(isnan(a.str)); /* along the ridges the correlation does not fall */
    assert_zero(a.std, 1);
    a = oblique(&s, 0, 5, RC_PERIODIC);
    assert_near(a, std, 90, rounding);
    assert_near(a, sal, acos(0.2) * Ly / 5 / (2 * exact_pi), node_square / (36.0 * 36));
    a = oblique(&s, 6, -5, RC_PERIODIC);
    assert_near(a, std, atan2(5 / Ly, 6 / Lx) * 180 / exact_pi, summed);
    a = oblique(&s, 6, 5, RC_PERIODIC);
    assert_near(a, std, 180 - atan2(5 / Ly, 6 / Lx) * 180 / exact_pi, summed);
    assert_true(isnan(a.str));
    assert_near(a, sal, acos(0.2) / (2 * exact_pi * hypot(5 / Ly, 6 / Lx)), coarse_grid);
    /* correlation with a window, where the map has no whole number of periods */
    a = oblique(&s, 20.4, 13.7, RC_FREE);
    assert_near(a, std, 180 - atan2(13.7 / Ly, 20.4 / Lx) * 180 / exact_pi, coarse_grid);
    assert_near(a, sal, acos(0.2) / (2 * exact_pi * hypot(13.7 / Ly, 20.4 / Lx)), 3 * coarse_grid);
}

/* ---- shapes whose slopes are known exactly ---- */

static void
test_ramp(void **state)
{
    const struct rc_shape s = {33, 47, 1.1e-6, 1e-6};
    const double gx = 0.75, gy = -1.4;
    double *h = room(&s), spread;
    struct rc_areal a;

    (void)state;
    for (size_t j = 0; j < 47; j++)
        for (size_t i = 0; i < 33; i++)
            h[j * 33 + i] = 5e-3 + gx * (double)i * s.dx + gy * (double)j * s.dy;
    a = measured(&s, h, RC_FREE);
    spread = pow(gx * s.dx, 2) * (33 * 33 - 1.0) / 12 + pow(gy * s.dy, 2) * (47 * 47 - 1.0) / 12;
    near_at("sq", a.sq, sqrt(spread), six_digits); /* the other digits are lost by the datum */
    assert_near(a, sdq, hypot(gx, gy), 1e-9);
    assert_near(a, sdr, sqrt(1 + gx * gx + gy * gy) - 1, 1e-9);
    free(h);
}

static void
test_chequerboard(void **state)
{
    const struct rc_shape s = {34, 46, 1.1e-6, 1e-6};
    const double A = 0.8e-6, gx = 2 * A / s.dx, gy = 2 * A / s.dy;
    double *h = room(&s);
    struct rc_areal a;

    (void)state;
    for (size_t k = 0; k < s.nx * s.ny; k++)
        h[k] = (k / s.nx + k % s.nx) % 2 == 0 ? A : -A;
    a = measured(&s, h, RC_FREE);
    assert_near(a, sq, A, rounding);
    assert_near(a, sa, A, rounding);
    assert_zero(a.ssk, 1);
    assert_near(a, sku, 1, rounding);
    assert_near(a, sdq, hypot(gx, gy), rounding);
    assert_near(a, sdr, sqrt(1 + gx * gx + gy * gy) - 1, rounding);
    /* the flattest 40 % are the upper level: there are no peaks, and half of the map is a pit */
    assert_true(a.sk == 0 && a.spk == 0 && a.smr1 == 0);
    assert_near(a, smr2, 0.5, rounding);
    assert_near(a, svk, 4 * A, rounding);
    assert_true(a.vmp == 0 && a.vvv == 0);
    assert_near(a, vmc, A, rounding);
    assert_near(a, vvc, A, rounding);
    /* correlations +1, -1, ... along a side: it falls to 0.2 after 0.4 of a step */
    assert_near(a, sal, 0.4 * s.dy, coarse_grid);
    free(h);
}

/* Posts of height H on a ninth of the map. */
static void
test_posts(void **state)
{
    const struct rc_shape s = {90, 60, 2e-6, 1.9e-6};
    const double H = 2.5e-6, f = 1.0 / 9, v = f * (1 - f);
    double *h = room(&s);
    struct rc_areal a;

    (void)state;
    for (size_t k = 0; k < s.nx * s.ny; k++)
        h[k] = k % s.nx % 15 < 5 && k / s.nx % 15 < 5 ? H : 0;
    a = measured(&s, h, RC_PERIODIC);
    assert_near(a, sq, H * sqrt(v), rounding);
    assert_near(a, sa, 2 * H * v, rounding);
    assert_near(a, ssk, (1 - 2 * f) / sqrt(v), rounding);
    assert_near(a, sku, 1 / v - 3, rounding);
    assert_near(a, sp, H * (1 - f), rounding);
    assert_near(a, sv, H * f, rounding);
    assert_true(a.sk == 0 && a.svk == 0 && a.vmp == 0 && a.smr2 == 1);
    assert_near(a, smr1, f, rounding);
    assert_near(a, spk, 2 * H, rounding);
    assert_near(a, vmc, f * H, rounding);
    assert_near(a, vvc, (1 - f) * H, rounding);
    assert_near(a, sxp, H, rounding);
    /* two steps of H for each row of a post, on the pairs along x (89 hold 12), and along y */
    assert_near(a, sdq, H * sqrt(11.0 / 89 / 3 / (s.dx * s.dx) + 7.0 / 59 / 3 / (s.dy * s.dy)),
                rounding);
    free(h);
}

/* A paraboloid on a disc with missing points around it: heights are uniformly distributed. */
static void
test_cap(void **state)
{
    const struct rc_shape s = {301, 331, 1.1e-6, 1e-6};
    const double R = 300e-6, radius = 160e-6, H = radius * radius / (2 * R), t = radius / R;
    double *h = room(&s);
    struct rc_areal a;

    (void)state;
    rc_synth_sphere(&s, R, h);
    for (size_t k = 0; k < s.nx * s.ny; k++)
        h[k] = h[k] < -H ? NAN : h[k];
    a = measured(&s, h, RC_FREE);
    assert_near(a, sq, H / sqrt(12), coarse_grid);
    assert_near(a, sa, H / 4, coarse_grid);
    assert_near(a, sku, 1.8, coarse_grid);
    assert_near(a, sp, H / 2, coarse_grid);
    assert_near(a, sv, H / 2, coarse_grid);
    assert_near(a, sdq, t / sqrt(2), coarse_grid);
    assert_near(a, sdr, 2 * (pow(1 + t * t, 1.5) - 1) / (3 * t * t) - 1, coarse_grid);
    assert_near(a, sk, H, coarse_grid);
    assert_near(a, vmp, 0.1 * 0.1 / 2 * H, 2 * coarse_grid);
    assert_near(a, vmc, (0.8 * 0.8 - 0.1 * 0.1) / 2 * H, coarse_grid);
    assert_near(a, vvv, 0.2 * 0.2 / 2 * H, 2 * coarse_grid);
    assert_near(a, vvc, (0.9 * 0.9 - 0.2 * 0.2) / 2 * H, coarse_grid);
    assert_near(a, sxp, 0.475 * H, coarse_grid);
    free(h);
}

/* A plateau with V-shaped grooves of depth D in three of ten columns, each of many nodes. */
static void
test_grooves(void **state)
{
    enum {
        WIDE = 400
    };
    const struct rc_shape s = {10 * WIDE, 6, 0.1e-6, 1e-6};
    const double D = 3e-6, mean = -0.15 * D;
    double *h = room(&s), square, cube;
    struct rc_areal a;

    (void)state;
    for (size_t k = 0; k < s.nx * s.ny; k++) {
        size_t i = k % s.nx, place = i % WIDE;
        double x = ((double)place + 0.5) / WIDE;
        h[k] = i / WIDE % 3 == 1 && i / WIDE < 9 ? -D * (1 - fabs(2 * x - 1)) : 0;
    }
    a = measured(&s, h, RC_FREE);
    square = 0.1 * D * D - mean * mean;
    cube = -0.3 * D * D * D / 4 - 3 * mean * 0.1 * D * D + 2 * mean * mean * mean;
    assert_near(a, sq, sqrt(square), node_square / WIDE / WIDE);
    assert_near(a, ssk, cube / pow(square, 1.5), node_square / WIDE / WIDE);
    assert_near(a, sp, 0.15 * D, node_square / WIDE / WIDE);
    assert_near(a, sv, 0.85 * D, node_square / WIDE);
    assert_true(a.sk == 0 && a.spk == 0 && a.smr1 == 0 && a.vmp == 0);
    assert_near(a, smr2, 0.7, rounding);
    assert_near(a, svk, D, node_square / WIDE);
    /* at 80 % the height is D/3 below the plateau: the rest of a groove has two thirds of its width and
     * depth */
    assert_near(a, vvv, 0.2 * (2 * D / 3) / 2, node_square / WIDE);
    assert_near(a, vvc, 0.15 * D - a.vvv, node_square / WIDE);
    assert_near(a, vmc, 0.7 * D / 3 + 0.1 * D / 6, node_square / WIDE);
    assert_zero(a.sxp, D);
    assert_zero(a.std, 1);
    free(h);
}

/* ---- given distributions, in no order ---- */

enum {
    SIDE = 251
};
static const struct rc_shape square = {SIDE, SIDE, 1e-6, 1e-6};

/* Heights quantile(p), 0 < p < 1, at equal steps of p, in a mixed order. */
static double *
distributed(double (*quantile)(double))
{
    double *h = room(&square);
    const size_t n = SIDE * SIDE;

    /* 25013 and n have no common factor */
    for (size_t k = 0; k < n; k++)
        h[k * 25013 % n] = quantile(((double)k + 0.5) / (double)n);
    return h;
}

static double
of_square(double p)
{
    return 1e-6 * p * p;
}

/* Heights u^2 with u uniform between 0 and 1: the flattest 40 % are u < 0.4, with the least-squares line 0.4
 * u - 0.4^2/6. */
static void
test_square_distribution(void **state)
{
    const double L = 1e-6, top = 0.4 - 0.16 / 6, u = sqrt(top), fine = 1e-4;
    const double m2 = 4.0 / 45, m3 = 1.0 / 7 - 1.0 / 5 + 2.0 / 27;
    double *h = distributed(of_square);
    struct rc_areal a = measured(&square, h, RC_FREE);

    (void)state;
    assert_near(a, sq, L * sqrt(m2), fine);
    assert_near(a, sa, L * 4 / (9 * sqrt(3)), fine);
    assert_near(a, ssk, m3 / pow(m2, 1.5), fine);
    assert_near(a, sp, L * 2 / 3, fine);
    assert_near(a, sv, L / 3, fine);
    assert_near(a, sk, L * 0.4, fine);
    assert_near(a, smr1, 1 - u, fine);
    assert_near(a, spk, L * 2 * ((1 - u * u * u) / 3 - top * (1 - u)) / (1 - u), fine);
    assert_true(a.smr2 == 1 && a.svk == 0);
    assert_near(a, vmp, L * ((1 - 0.729) / 3 - 0.081), fine);
    assert_near(a, vmc, L * ((1 - 0.008) / 3 - 0.032 - (1 - 0.729) / 3 + 0.081), fine);
    assert_near(a, vvv, L * (0.008 - 0.008 / 3), fine);
    assert_near(a, vvc, L * (0.486 - 0.008 + 0.008 / 3), fine);
    assert_near(a, sxp, L * (0.975 * 0.975 - 0.25), fine);
    free(h);
}

static double
of_gauss(double p)
{
    return 2e-9 * gsl_cdf_ugaussian_Pinv(p);
}

/* Gaussian heights: the flattest 40 % are the middle ones, whose least-squares line follows from the integral
 * of t Phi(t) phi(t). */
static void
test_gaussian(void **state)
{
    const double s = 2e-9, t0 = gsl_cdf_ugaussian_Pinv(0.7), t1 = gsl_cdf_ugaussian_Pinv(0.9);
    const double t2 = gsl_cdf_ugaussian_Pinv(0.8), root = sqrt(exact_pi), fine = 2e-3;
    const double sk = (erf(t0) / (2 * root) - 0.4 * gsl_ran_ugaussian_pdf(t0)) * 12 / 0.064;
    const double k = sk / 2, tail = gsl_cdf_ugaussian_Q(k);
    const double peak = gsl_ran_ugaussian_pdf(k) - k * tail;
    double *h = distributed(of_gauss);
    struct rc_areal a = measured(&square, h, RC_FREE);
    double vmp = gsl_ran_ugaussian_pdf(t1) - 0.1 * t1, vvv = gsl_ran_ugaussian_pdf(t2) - 0.2 * t2;

    (void)state;
    assert_near(a, sq, s, fine);
    assert_near(a, sa, s * sqrt(2 / exact_pi), fine);
    assert_zero(a.ssk, 1);
    assert_near(a, sku, 3, fine);
    assert_near(a, sk, s * sk, fine);
    assert_near(a, smr1, tail, fine);
    assert_near(a, smr2, 1 - tail, fine);
    assert_near(a, spk, s * 2 * peak / tail, fine);
    assert_near(a, svk, s * 2 * peak / tail, fine);
    assert_near(a, vmp, s * vmp, fine);
    assert_near(a, vvv, s * vvv, fine);
    /* mean of max(z - c, 0) is c less than that of max(c - z, 0) */
    assert_near(a, vmc, s * (vvv + t2 - vmp), fine);
    assert_near(a, vvc, s * (vmp + t1 - vvv), fine);
    assert_near(a, sxp, s * gsl_cdf_ugaussian_Pinv(0.975), fine);
    free(h);
}

/* ---- correlations by plain sums ---- */

/* The mean product of pairs at the offset (x, y), in nodes, over Sq^2; y >= 0. */
static double
correlation(const struct rc_shape *s, const double *h, struct rc_boundary wraps, long x, size_t y)
{
    double mean = 0, square_sum = 0, sum = 0, n = 0, pairs = 0;
    const long nx = (long)s->nx;

    for (size_t k = 0; k < s->nx * s->ny; k++)
        if (!isnan(h[k])) {
            mean += h[k];
            n++;
        }
    mean /= n;
    for (size_t k = 0; k < s->nx * s->ny; k++) {
        long i = (long)(k % s->nx) + x;
        size_t j = k / s->nx + y;
        if (!isnan(h[k]))
            square_sum += (h[k] - mean) * (h[k] - mean);
        if ((!wraps.x && (i < 0 || i >= nx)) || (!wraps.y && j >= s->ny))
            continue;
        i = (i + nx) % nx;
        j %= s->ny;
        if (isnan(h[k]) || isnan(h[j * s->nx + (size_t)i]))
            continue;
        sum += (h[k] - mean) * (h[j * s->nx + (size_t)i] - mean);
        pairs++;
    }
    return sum / pairs / (square_sum / n);
}

/* The offset at which it first falls to 0.2 along a column of whole nodes. */
static double
fall(const struct rc_shape *s, const double *h, struct rc_boundary wraps, long x, size_t y)
{
    double before = 1;

    for (long k = 1; labs(k * x) <= (long)s->nx / 2 && (size_t)k * y <= s->ny / 2; k++) {
        double here = correlation(s, h, wraps, k * x, (size_t)k * y);
        if (here <= 0.2)
            return ((double)k - (0.2 - here) / (before - here)) *
                   hypot((double)x * s->dx, (double)y * s->dy);
        before = here;
    }
    return NAN;
}

/* A line of a random surface, with holes or without: one direction, so that Sal is one number. */
static void
test_correlation_of_a_profile(void **state)
{
    const struct rc_selfaffine what = {
        .hurst = 0.7, .rms_height = 1e-8, .rolloff = 30e-6, .seed = 4};

    (void)state;
    for (int turn = 0; turn < 16; turn++) {
        const bool column = turn & 1, holes = turn & 2;
        const struct rc_boundary wraps = rc_boundary_of(turn & 4, turn & 8);
        const struct rc_shape s = {column ? 1 : 149, column ? 149 : 1, 1.1e-6, 1.1e-6};
        double *h = room(&s);
        struct rc_areal a;

        assert_int_equal(rc_synth_selfaffine(&s, &what, h, NULL), RC_OK);
        for (size_t k = 0; holes && k < 149; k += 5 + k % 3)
            h[k] = NAN;
        a = measured(&s, h, wraps);
        assert_near(a, sal, fall(&s, h, wraps, column ? 0 : 1, column ? 1 : 0), summed);
        assert_true(isnan(a.str) && isnan(a.std));
        free(h);
    }
}

/* The correlation of a bump with two scales falls fastest along y and slowest along x. */
static void
test_correlation_of_a_map(void **state)
{
    const struct rc_shape s = {49, 45, 1e-6, 1.1e-6};
    double *h = room(&s);

    (void)state;
    for (int turn = 0; turn < 8; turn++) {
        const bool holes = turn & 1;
        const struct rc_boundary wraps = rc_boundary_of(turn & 2, turn & 4);
        struct rc_areal a;
        for (size_t k = 0; k < s.nx * s.ny; k++) {
            double x = (double)(k % s.nx) - 24, y = (double)(k / s.nx) - 22;
            h[k] = 1e-6 * exp(-x * x / 50 - y * y / 8);
            if (holes && (k * 7919) % 13 == 0)
                h[k] = NAN;
        }
        a = measured(&s, h, wraps);
        /* with holes it may fall slightly faster beside the axis */
        assert_true(a.sal <= fall(&s, h, wraps, 0, 1) * (1 + summed));
        assert_near(a, sal, fall(&s, h, wraps, 0, 1), holes ? three_digits : summed);
        assert_near(a, str, fall(&s, h, wraps, 0, 1) / fall(&s, h, wraps, 1, 0),
                    holes ? three_digits : summed);
    }
    free(h);
}

/* ---- limits of the definitions ---- */

static void
test_flat(void **state)
{
    const struct rc_shape s = {7, 5, 1e-6, 1e-6};
    double *h = room(&s);
    struct rc_areal a;

    (void)state;
    for (size_t k = 0; k < 35; k++)
        h[k] = k == 11 ? NAN : 0.1;
    a = measured(&s, h, RC_FREE);
    assert_true(a.sq == 0 && a.sa == 0 && a.sz == 0 && a.sdq == 0 && a.sdr == 0);
    assert_true(isnan(a.ssk) && isnan(a.sku) && isnan(a.sal) && isnan(a.str) && isnan(a.std));
    assert_true(a.sk == 0 && a.spk == 0 && a.svk == 0 && a.smr1 == 0 && a.smr2 == 1);
    assert_true(a.vmp == 0 && a.vmc == 0 && a.vvc == 0 && a.vvv == 0 && a.sxp == 0);
    free(h);
}

static void
test_single_points(void **state)
{
    const struct rc_shape one = {1, 1, 1, 1}, two = {2, 2, 1, 1};
    const double h[] = {3, NAN, NAN, 5}, none[] = {NAN, INFINITY, NAN, NAN};
    struct rc_areal a = measured(&one, h, RC_FREE);

    (void)state;
    assert_true(a.sq == 0 && isnan(a.sdq) && isnan(a.sdr) && isnan(a.sal));
    a = measured(&two, h, RC_FREE);
    assert_true(a.sq == 1 && a.sku == 1 && isnan(a.sdq) && isnan(a.sdr));
    assert_int_equal(
        rc_areal(&two, none, &(struct rc_surface_options){.boundary = RC_FREE}, &a, NULL), RC_OK);
    assert_true(isnan(a.sq) && isnan(a.sz) && isnan(a.sdq) && isnan(a.sk) && isnan(a.sxp));
}

static void
test_profile_slopes(void **state)
{
    const struct rc_shape row = {4, 1, 0.5, 7}, column = {1, 4, 7, 0.5};
    const double h[] = {0, 3, 1, 5};
    double length = (sqrt(1 + 36) + sqrt(1 + 16) + sqrt(1 + 64)) / 3 - 1;

    (void)state;
    for (int k = 0; k < 2; k++) {
        struct rc_areal a = measured(k == 0 ? &row : &column, h, RC_FREE);
        assert_near(a, sdq, sqrt((36.0 + 16 + 64) / 3), rounding);
        assert_near(a, sdr, length, rounding);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wave),
        cmocka_unit_test(test_ridges),
        cmocka_unit_test(test_ramp),
        cmocka_unit_test(test_chequerboard),
        cmocka_unit_test(test_posts),
        cmocka_unit_test(test_cap),
        cmocka_unit_test(test_grooves),
        cmocka_unit_test(test_square_distribution),
        cmocka_unit_test(test_gaussian),
        cmocka_unit_test(test_correlation_of_a_profile),
        cmocka_unit_test(test_correlation_of_a_map),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_single_points),
        cmocka_unit_test(test_profile_slopes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
