/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Synthetic surfaces follow their formulas: indenters, waves, and random roughness. Every wave of the
 * roughness has the requested power and depends only on the seed. Its RMS is the requested one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "libcontact/contact.h"
#include "libcontact/operator/operator.h"

static double
place(size_t i, size_t n, double d)
{
    return ((double)i - 0.5 * (double)(n - 1)) * d;
}

static void
assert_near(double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance * fabs(expected)))
        fail_msg("%.17g instead of %.17g", got, expected);
}

static void
test_sphere(void **state)
{
    const struct rc_shape s = {33, 47, 1.1e-6, 1e-6};
    const double radius = 2.385e-3;
    double *h = malloc(33 * 47 * sizeof *h);

    (void)state;
    rc_synth_sphere(&s, radius, h);
    for (size_t k = 0; k < 33 * 47; k++) {
        double r = hypot(place(k % 33, 33, s.dx), place(k / 33, 47, s.dy));
        assert_near(h[k], -r * r / (2 * radius), rounding);
    }
    assert_true(h[23 * 33 + 16] == 0 && !signbit(h[23 * 33 + 16]));
    free(h);
}

static void
test_wave(void **state)
{
    const struct rc_shape s = {34, 47, 1.1e-6, 1e-6};
    const double amplitude = 0.37e-6, lx = 13.7e-6, ly = 9.1e-6;
    double h[34 * 47];

    (void)state;
    for (int both = 0; both < 2; both++) {
        rc_synth_wave(&s, amplitude, lx, both ? ly : INFINITY, h);
        for (size_t k = 0; k < 34 * 47; k++) {
            double expected = amplitude * cos(2 * exact_pi * place(k % 34, 34, s.dx) / lx);
            if (both)
                expected *= cos(2 * exact_pi * place(k / 34, 47, s.dy) / ly);
            assert_true(fabs(h[k] - expected) <= rounding * amplitude);
        }
    }
    rc_synth_wave(&s, amplitude, INFINITY, ly, h);
    assert_true(h[23 * 34] == amplitude && h[23 * 34 + 33] == amplitude);
}

/* ---- indenters ---- */

static const struct rc_shape oblong = {33, 47, 1.1e-6, 1e-6};
static const struct rc_place off = {2.3e-6, -5.7e-6};

/* The position of node k from the apex, along and across a direction that is counterclockwise from x in a
 * picture whose rows run downwards. */
static void
from_apex(size_t k, double degrees, double *along, double *across)
{
    double x = place(k % 33, 33, oblong.dx) - off.x, up = -(place(k / 33, 47, oblong.dy) - off.y);
    double a = degrees * exact_pi / 180;

    *along = x * cos(a) + up * sin(a);
    *across = up * cos(a) - x * sin(a);
}

static void
test_paraboloid(void **state)
{
    const double r1 = 2.385e-3, r2 = 0.71e-3, angles[] = {0, 30, 90, 180, -45, 270, 360};
    double h[33 * 47], along, across;

    (void)state;
    for (size_t a = 0; a < 7; a++) {
        rc_synth_paraboloid(&oblong, off, r1, r2, angles[a], h);
        for (size_t k = 0; k < 33 * 47; k++) {
            from_apex(k, angles[a], &along, &across);
            assert_near(h[k], -along * along / (2 * r1) - across * across / (2 * r2), rounding);
        }
        rc_synth_paraboloid(&oblong, off, INFINITY, r2, angles[a], h);
        for (size_t k = 0; k < 33 * 47; k++) {
            from_apex(k, angles[a], &along, &across);
            assert_true(fabs(h[k] + across * across / (2 * r2)) <=
                        rounding * (along * along + across * across) / r2);
            /* an axis along y: the same in every row, and along x in every column */
            assert_true((angles[a] != 90 && angles[a] != 270) || h[k] == h[k % 33]);
            assert_true((angles[a] != 0 && angles[a] != 180) || h[k] == h[k - k % 33]);
        }
    }
    rc_synth_paraboloid(&oblong, off, r1, r1, 77, h); /* a sphere is the same in all directions */
    for (size_t k = 0; k < 33 * 47; k++) {
        from_apex(k, 0, &along, &across);
        assert_near(h[k], -(along * along + across * across) / (2 * r1), rounding);
    }
}

static void
test_cone(void **state)
{
    double h[33 * 47], along, across;

    (void)state;
    rc_synth_cone(&oblong, off, 0.037, h);
    for (size_t k = 0; k < 33 * 47; k++) {
        from_apex(k, 0, &along, &across);
        assert_near(h[k], -0.037 * hypot(along, across), rounding);
    }
    rc_synth_cone(&oblong, (struct rc_place){0, 0}, 0.037, h);
    assert_true(h[23 * 33 + 16] == 0 && !signbit(h[23 * 33 + 16]));
}

static void
test_punch(void **state)
{
    const struct rc_shape s = {21, 21, 0.1e-6, 0.1e-6};
    const double radius = 7.35e-6, edge = 20e-6, height = 0.4e-6;
    double h[33 * 47], along, across;
    size_t end = 0;

    (void)state;
    for (int rounded = 0; rounded < 2; rounded++) {
        rc_synth_punch(&oblong, off, radius, rounded ? edge : 0, height, h);
        for (size_t k = 0; k < 33 * 47; k++) {
            double r, depth;

            from_apex(k, 0, &along, &across);
            r = hypot(along, across) - radius;
            depth = r <= 0 ? 0 : rounded ? r * r / (2 * edge) : height;
            assert_true(fabs(h[k] + (depth < height ? depth : height)) <= rounding * height);
        }
    }
    /* nodes on the rim belong to the flat end: 81 lattice points have i^2 + j^2 <= 25 */
    rc_synth_punch(&s, (struct rc_place){0, 0}, 5 * 0.1e-6, 0, height, h);
    for (size_t k = 0; k < 441; k++)
        end += h[k] == 0 ? 1 : 0;
    assert_int_equal(end, 81);
}

/* ---- the transform, as sums ---- */

/* exp(-2 pi i k x / length) for all nodes of a side. */
static double complex
turn(long k, size_t i, size_t n, bool from_middle)
{
    double at = from_middle ? place(i, n, 1) : (double)i;

    return cexp(-2 * exact_pi * I * (double)k * at / (double)n);
}

/* Waves -m..m along x and -n..n along y of h, row by row and then down the columns; c[] has
 * (2m+1)(2n+1) numbers. Amplitudes are mean values; with `from_middle` the origin is the middle of the
 * map. */
static void
waves(const struct rc_shape *s, const double *h, long m, long n, bool from_middle,
      double complex *c)
{
    size_t columns = (size_t)(2 * m + 1);
    double complex *rows = calloc(s->ny * columns, sizeof *rows);

    memset(c, 0, columns * (size_t)(2 * n + 1) * sizeof *c);
    for (size_t j = 0; j < s->ny; j++)
        for (long kx = -m; kx <= m; kx++)
            for (size_t i = 0; i < s->nx; i++)
                rows[j * columns + (size_t)(kx + m)] +=
                    h[j * s->nx + i] * turn(kx, i, s->nx, from_middle) / (double)s->nx;
    for (long ky = -n; ky <= n; ky++)
        for (size_t j = 0; j < s->ny; j++)
            for (size_t a = 0; a < columns; a++)
                c[(size_t)(ky + n) * columns + a] +=
                    rows[j * columns + a] * turn(ky, j, s->ny, from_middle) / (double)s->ny;
    free(rows);
}

static void
check_transform(size_t nx, size_t ny)
{
    const struct rc_shape s = {nx, ny, 1, 1};
    long m = (long)(nx / 2), n = (long)(ny / 2);
    double *h = malloc(nx * ny * sizeof *h), *back = malloc(nx * ny * sizeof *back);
    double complex *f = malloc(rc_fourier_size(&s) * sizeof *f);
    double complex *c = malloc((size_t)((2 * m + 1) * (2 * n + 1)) * sizeof *c);

    for (size_t k = 0; k < nx * ny; k++)
        h[k] = (double)rand() / RAND_MAX;
    waves(&s, h, m, n, false, c);
    assert_int_equal(rc_fourier_forward(&s, h, f, NULL), RC_OK);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < rc_fourier_columns(&s); i++) {
            long kx = rc_fourier_number(i, nx), ky = rc_fourier_number(j, ny);
            double complex sum = c[(ky + n) * (2 * m + 1) + kx + m] * (double)(nx * ny);
            sum -= f[j * rc_fourier_columns(&s) + i];
            assert_true(cabs(sum) <= summed * (double)(nx * ny));
        }
    assert_int_equal(rc_fourier_backward(&s, f, back, NULL), RC_OK);
    for (size_t k = 0; k < nx * ny; k++)
        assert_true(fabs(back[k] - h[k] * (double)(nx * ny)) <= summed * (double)(nx * ny));
    free(h);
    free(back);
    free(f);
    free(c);
}

static void
test_transform(void **state)
{
    (void)state;
    check_transform(33, 47);
    check_transform(32, 20);
    check_transform(1, 17);
    check_transform(16, 1);
    check_transform(1, 1);
}

/* ---- roughness ---- */

static const struct rc_selfaffine rough = {.hurst = 0.73, .rms_height = 0.42e-6, .seed = 2385};

static double *
make(const struct rc_shape *s, const struct rc_selfaffine *what)
{
    double *h = malloc(s->nx * s->ny * sizeof *h);
    struct rc_err err;

    if (rc_synth_selfaffine(s, what, h, &err) != RC_OK)
        fail_msg("%s", err.text);
    return h;
}

static double
mean_square(const double *h, size_t n)
{
    long double sum = 0;

    for (size_t k = 0; k < n; k++)
        sum += (long double)h[k] * h[k];
    return (double)(sum / n);
}

static void
check_height(size_t nx, size_t ny, double dx, double dy)
{
    const struct rc_shape s = {nx, ny, dx, dy};
    double *h = make(&s, &rough);

    assert_true(fabs(rc_sum(h, nx * ny)) <= rounding * rough.rms_height * (double)(nx * ny));
    assert_near(sqrt(mean_square(h, nx * ny)), rough.rms_height, rounding);
    free(h);
}

static void
test_height_is_exact(void **state)
{
    (void)state;
    check_height(33, 47, 1.1e-6, 1e-6);
    check_height(64, 64, 1e-6, 1e-6);
    check_height(48, 10, 1e-6, 3.7e-6);
    check_height(3, 3, 1e-6, 1e-6);
    check_height(2, 31, 1e-6, 1e-6);
    check_height(101, 1, 1e-6, 1e-6);
    check_height(1, 100, 1e-6, 1.1e-6);
    check_height(97, 89, 1e-9, 1e-9);
}

/* The mean square of the gradient, from the waves of the heights. */
static void
check_slope(struct rc_shape s)
{
    struct rc_selfaffine what = rough;
    long m = (long)(s.nx / 2), n = (long)(s.ny / 2);
    double complex *c = malloc((size_t)((2 * m + 1) * (2 * n + 1)) * sizeof *c);
    double *h, squares = 0;

    what.rms_height = 0;
    what.rms_slope = 0.23;
    h = make(&s, &what);
    waves(&s, h, m, n, true, c);
    for (long ky = -n; ky <= n; ky++)
        for (long kx = -m; kx <= m; kx++) {
            double qx = 2 * exact_pi * (double)kx / ((double)s.nx * s.dx);
            double qy = 2 * exact_pi * (double)ky / ((double)s.ny * s.dy);
            double a = cabs(c[(ky + n) * (2 * m + 1) + kx + m]);
            squares += (qx * qx + qy * qy) * a * a;
        }
    assert_near(sqrt(squares), what.rms_slope, summed);
    free(h);
    free(c);
}

static void
test_slope_is_exact(void **state)
{
    (void)state;
    check_slope((struct rc_shape){33, 47, 1.1e-6, 1e-6});
    check_slope((struct rc_shape){32, 20, 1e-6, 2.3e-6});
    check_slope((struct rc_shape){64, 1, 1e-6, 1e-6});
}

/* No wave is outside of the cut-offs or has two nodes, and every other wave is present. */
static void
test_cuts(void **state)
{
    const struct rc_shape s = {32, 46, 1.1e-6, 1e-6};
    struct rc_selfaffine what = rough;
    double complex c[33 * 47];
    double *h;

    (void)state;
    what.long_cut = 17.6e-6;
    what.short_cut = 3.1e-6;
    h = make(&s, &what);
    waves(&s, h, 16, 23, true, c);
    for (long ky = -23; ky <= 23; ky++)
        for (long kx = -16; kx <= 16; kx++) {
            double q = hypot((double)kx / (32 * s.dx), (double)ky / (46 * s.dy));
            bool inside = 1 / q <= 17.6e-6 * (1 + 1e-12) && 1 / q >= 3.1e-6;
            double a = cabs(c[(ky + 23) * 33 + kx + 16]) / what.rms_height;
            assert_true(inside ? a > 1e-6 : a < rounding);
        }
    free(h);
    what.long_cut = what.short_cut = 0; /* all except the waves of two nodes */
    h = make(&s, &what);
    waves(&s, h, 16, 23, true, c);
    for (long ky = -23; ky <= 23; ky++)
        for (long kx = -16; kx <= 16; kx++) {
            double q = hypot((double)kx / (32 * s.dx), (double)ky / (46 * s.dy));
            double a = cabs(c[(ky + 23) * 33 + kx + 16]) / what.rms_height;
            bool inside = labs(kx) < 16 && labs(ky) < 23 && q > 0 && q * 2.2e-6 <= 1;
            assert_true(inside ? a > 1e-7 : a < rounding);
        }
    free(h);
}

/* On a finer grid, a coarser one and one with unequal spacings, over the same lengths, the waves are the
 * same. */
static void
test_seed_gives_the_waves(void **state)
{
    const double lx = 46.2e-6, ly = 33e-6;
    const size_t size[][2] = {{42, 33}, {84, 66}, {45, 96}};
    struct rc_selfaffine what = rough;
    double complex first[41 * 33], c[41 * 33];

    (void)state;
    what.short_cut = 2.4e-6;
    what.rolloff = 21e-6;
    for (size_t g = 0; g < 3; g++) {
        const struct rc_shape s = {size[g][0], size[g][1], lx / (double)size[g][0],
                                   ly / (double)size[g][1]};
        double *h = make(&s, &what);
        waves(&s, h, 20, 16, true, g == 0 ? first : c);
        for (size_t k = 0; g > 0 && k < 41 * 33; k++)
            assert_true(cabs(c[k] - first[k]) <= summed * what.rms_height);
        free(h);
    }
}

static void
test_seeds_differ(void **state)
{
    const struct rc_shape s = {64, 64, 1e-6, 1e-6};
    struct rc_selfaffine what = rough;
    double *a = make(&s, &what), *again = make(&s, &what), *b, product = 0;

    (void)state;
    assert_memory_equal(a, again, 64 * 64 * sizeof *a);
    /* white, so that the correlation of two seeds is an average over 4000 waves */
    what.rolloff = what.short_cut = 2e-6;
    free(a);
    a = make(&s, &what);
    what.seed++;
    b = make(&s, &what);
    for (size_t k = 0; k < 64 * 64; k++)
        product += a[k] * b[k];
    product /= 64 * 64 * what.rms_height * what.rms_height;
    assert_true(fabs(product) < 0.06);
    free(a);
    free(b);
    free(again);
}

/* ---- the law of the spectrum, over many seeds ---- */

enum {
    SEEDS = 400
};

/* Mean square and mean fourth power of each wave over the seeds. Each surface is first normalised by its
 * waves with law[k] > 0, whose power should be law[k]. The reason is that the fixed RMS of the surface
 * depends on the strong waves. The inverse of a mean of n exponential variates is n / (n - 1) on average; a
 * wave and its conjugate count once. */
static void
ensemble(const struct rc_shape *s, struct rc_selfaffine what, long m, long n, const double *law,
         double *square, double *fourth)
{
    size_t count = (size_t)((2 * m + 1) * (2 * n + 1));
    double complex *c = malloc(count * sizeof *c);

    memset(square, 0, count * sizeof *square);
    memset(fourth, 0, count * sizeof *fourth);
    for (what.seed = 0; what.seed < SEEDS; what.seed++) {
        double *h = make(s, &what), scale = 0, pairs = 0;
        waves(s, h, m, n, true, c);
        for (size_t k = 0; k < count; k++)
            if (law[k] > 0) {
                scale += 0.5 * pow(cabs(c[k]), 2) / law[k];
                pairs += 0.5;
            }
        for (size_t k = 0; k < count; k++) {
            double a2 = pow(cabs(c[k]), 2) * (pairs - 1) / scale;
            square[k] += a2 / SEEDS;
            fourth[k] += a2 * a2 / SEEDS;
        }
        free(h);
    }
    free(c);
}

/* Power over the law, averaged over a class of waves: it should be 1. */
struct group {
    double sum;
    size_t n;
};

static void
put(struct group *group, double value)
{
    group->sum += value;
    group->n++;
}

static double
mean(struct group group)
{
    return group.sum / (double)group.n;
}

/* One wave scatters by 1/sqrt(400) = 5 %, n independent ones by 5 % / sqrt(n). */
static void
assert_law(struct group group, size_t least)
{
    assert_true(group.n >= least);
    assert_near(mean(group), 1, 4 * 0.05 / sqrt(0.5 * (double)group.n));
}

static void
test_power_law(void **state)
{
    enum {
        M = 7,
        N = 10,
        COUNT = (2 * M + 1) * (2 * N + 1)
    };
    const struct rc_shape s = {21, 29, 1.1e-6, 1.7e-6}; /* 23.1 um x 49.3 um */
    struct rc_selfaffine what = rough;
    double square[COUNT], fourth[COUNT], law[COUNT], high[COUNT], bend = 1 / 15e-6;
    double qx[COUNT], qy[COUNT], q[COUNT];
    struct group flat = {0}, low = {0}, x = {0}, y = {0}, gauss = {0};

    (void)state;
    what.rolloff = 15e-6;
    what.short_cut = 4e-6;
    for (long k = 0; k < COUNT; k++) {
        const long column = k % (2 * M + 1) - M, row = k / (2 * M + 1) - N;

        qx[k] = (double)column / 23.1e-6;
        qy[k] = (double)row / 49.3e-6;
        q[k] = hypot(qx[k], qy[k]);
        law[k] = q[k] == 0 || q[k] > 1 / 4e-6 ? 0 : pow(fmax(1, q[k] / bend), -2 - 2 * what.hurst);
        high[k] = q[k] > 2 * bend ? law[k] : 0;
    }
    ensemble(&s, what, M, N, high, square, fourth);
    for (long k = 0; k < COUNT; k++) {
        if (law[k] == 0)
            continue;
        put(&gauss, fourth[k] / (square[k] * square[k]));
        if (high[k] == 0)
            put(q[k] <= bend ? &flat : &low, square[k] / law[k]);
        else
            put(fabs(qx[k]) > fabs(qy[k]) ? &x : &y, square[k] / law[k]);
    }
    assert_law(flat, 14);
    assert_law(low, 40);
    assert_law(x, 40);
    assert_law(y, 40);
    /* a complex Gaussian has <a^4> = 2 <a^2>^2 */
    assert_near(mean(gauss), 2, 0.05);
}

static void
test_power_law_of_profiles(void **state)
{
    const struct rc_shape s = {101, 1, 1.1e-6, 1.1e-6};
    double square[101], fourth[101], law[101], high[101];
    struct group low = {0};

    (void)state;
    for (long k = 0; k < 101; k++) {
        law[k] = k == 50 ? 0 : pow((double)labs(k - 50), -1 - 2 * rough.hurst);
        high[k] = labs(k - 50) >= 20 ? law[k] : 0;
    }
    ensemble(&s, rough, 50, 0, high, square, fourth);
    for (long k = 0; k < 101; k++)
        if (law[k] > 0 && high[k] == 0)
            put(&low, square[k] / law[k]);
    assert_law(low, 38);
}

/* With a lay the power is that of the isotropic surface at a wave number whose component along the lay is
 * larger by the ratio. */
static void
check_lay(double anisotropy, double degrees)
{
    enum {
        M = 9,
        N = 12,
        COUNT = (2 * M + 1) * (2 * N + 1)
    };
    const struct rc_shape s = {21, 29, 1.1e-6, 1.7e-6}; /* 23.1 um x 49.3 um */
    struct rc_selfaffine what = rough;
    double square[COUNT], fourth[COUNT], law[COUNT], high[COUNT], bend = 1 / 15e-6;
    double a = degrees * exact_pi / 180;
    struct group low = {0}, along = {0}, across = {0};

    what.rolloff = 15e-6;
    what.short_cut = 4e-6;
    what.anisotropy = anisotropy;
    what.direction = degrees;
    for (long k = 0; k < COUNT; k++) {
        const long column = k % (2 * M + 1) - M, row = k / (2 * M + 1) - N;
        double x = (double)column / 23.1e-6, up = -(double)row / 49.3e-6;
        double q = hypot(anisotropy * (x * cos(a) + up * sin(a)), up * cos(a) - x * sin(a));

        law[k] = q == 0 || q > 1 / 4e-6 ? 0 : pow(fmax(1, q / bend), -2 - 2 * what.hurst);
        high[k] = q > 1.2 * bend ? law[k] : 0;
    }
    ensemble(&s, what, M, N, high, square, fourth);
    for (long k = 0; k < COUNT; k++) {
        const long column = k % (2 * M + 1) - M, row = k / (2 * M + 1) - N;
        double x = (double)column / 23.1e-6, up = -(double)row / 49.3e-6;

        if (law[k] == 0)
            assert_true(square[k] < rounding);
        else if (high[k] == 0)
            put(&low, square[k] / law[k]);
        else
            put(fabs(x * cos(a) + up * sin(a)) * 2 > hypot(x, up) ? &along : &across,
                square[k] / law[k]);
    }
    assert_law(low, 10);
    assert_law(along, 4);
    assert_law(across, 10);
}

static void
test_lay(void **state)
{
    (void)state;
    check_lay(2.3, 30);
    check_lay(1.9, 90);
    check_lay(1.7, -60);
}

/* ---- refusals ---- */

static void
check_refused(struct rc_shape s, struct rc_selfaffine what, const char *reason)
{
    double *h = malloc(s.nx * s.ny * sizeof *h);
    struct rc_err err;

    assert_int_equal(rc_synth_selfaffine(&s, &what, h, &err), RC_FAIL);
    if (strstr(err.text, reason) == NULL)
        fail_msg("'%s' does not say '%s'", err.text, reason);
    free(h);
}

static void
test_refusals(void **state)
{
    const struct rc_shape s = {33, 47, 1.1e-6, 1e-6};
    const struct {
        size_t at;
        double value;
        const char *reason;
    } bad[] = {
        {offsetof(struct rc_selfaffine, hurst), 0, "Hurst"},
        {offsetof(struct rc_selfaffine, hurst), 1.01, "Hurst"},
        {offsetof(struct rc_selfaffine, hurst), NAN, "Hurst"},
        {offsetof(struct rc_selfaffine, rms_height), -1, "RMS height"},
        {offsetof(struct rc_selfaffine, rms_height), INFINITY, "RMS height"},
        {offsetof(struct rc_selfaffine, rms_height), 0, "one of"},
        {offsetof(struct rc_selfaffine, rms_height), NAN, "RMS height"},
        {offsetof(struct rc_selfaffine, rms_slope), 0.1, "one of"},
        {offsetof(struct rc_selfaffine, long_cut), -2e-5, "positive"},
        {offsetof(struct rc_selfaffine, long_cut), NAN, "positive"},
        {offsetof(struct rc_selfaffine, long_cut), 2e-6, "long cut-off"},
        {offsetof(struct rc_selfaffine, rolloff), -1, "positive"},
        {offsetof(struct rc_selfaffine, rolloff), INFINITY, "finite"},
        {offsetof(struct rc_selfaffine, rolloff), 2e-6, "roll-off"},
        {offsetof(struct rc_selfaffine, short_cut), 2.1e-6, "short cut-off"},
        {offsetof(struct rc_selfaffine, short_cut), 1, "no wave"},
        {offsetof(struct rc_selfaffine, anisotropy), 0.99,
         "anisotropy 0.99: it must be at least 1"},
        {offsetof(struct rc_selfaffine, anisotropy), NAN, "anisotropy"},
        {offsetof(struct rc_selfaffine, anisotropy), INFINITY, "anisotropy"},
        {offsetof(struct rc_selfaffine, direction), NAN, "direction"},
        {offsetof(struct rc_selfaffine, skewness), 3.1, "skewness 3.1: it must be from -3 to 3"},
        {offsetof(struct rc_selfaffine, skewness), NAN, "skewness"},
        {offsetof(struct rc_selfaffine, weibull), 0.7, "Weibull shape 0.7: it must be from 0.75"},
        {offsetof(struct rc_selfaffine, weibull), 101, "to 100"},
        {offsetof(struct rc_selfaffine, weibull), NAN, "Weibull"},
    };
    struct rc_selfaffine both = rough, lay = rough;

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        struct rc_selfaffine what = rough;
        memcpy((char *)&what + bad[k].at, &bad[k].value, sizeof(double));
        check_refused(s, what, bad[k].reason);
    }
    both.skewness = 1;
    both.weibull = 2;
    check_refused(s, both, "give one of them");
    lay.anisotropy = 2;
    check_refused((struct rc_shape){101, 1, 1e-6, 1e-6}, lay, "one direction only");
    check_refused((struct rc_shape){2, 2, 1, 1}, rough, "no wave");
    check_refused((struct rc_shape){1, 1, 1, 1}, rough, "no wave");
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_paraboloid),
        cmocka_unit_test(test_cone),
        cmocka_unit_test(test_punch),
        cmocka_unit_test(test_wave),
        cmocka_unit_test(test_transform),
        cmocka_unit_test(test_height_is_exact),
        cmocka_unit_test(test_slope_is_exact),
        cmocka_unit_test(test_cuts),
        cmocka_unit_test(test_seed_gives_the_waves),
        cmocka_unit_test(test_seeds_differ),
        cmocka_unit_test(test_power_law),
        cmocka_unit_test(test_power_law_of_profiles),
        cmocka_unit_test(test_lay),
        cmocka_unit_test(test_refusals),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
