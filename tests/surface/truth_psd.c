/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Power spectra. The power of a wave is in the right ring, and Parseval's theorem holds to 1e-9 with each
 * window and without. A known spectrum is recovered for any shape of the map. The Hurst exponent is that of
 * the surface to 0.05. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "libcontact/contact.h"

static const double parseval = 1e-9;
/* Permitted error of an exponent; a requirement, not derived. */
static const double exponent = 0.05;

static void
assert_near(double got, double expected, double tolerance)
{
    if (!(fabs(got - expected) <= tolerance * fabs(expected)))
        fail_msg("%.17g instead of %.17g", got, expected);
}

static struct rc_psd *
spectrum(const struct rc_shape *s, const double *h, const struct rc_psd_options *options)
{
    struct rc_err err;
    struct rc_psd *psd = rc_psd_new(s, h, options, &err);

    if (psd == NULL)
        fail_msg("%s", err.text);
    return psd;
}

static double
total(const struct rc_psd *psd)
{
    double sum = 0;

    for (size_t k = 0; k < psd->rings; k++)
        sum += (double)psd->modes[k] * psd->c[k];
    return sum;
}

/* ---- wave numbers of the power ---- */

/* A cos(2 pi (m i/nx + n j/ny)): |FFT|^2 = (A nx ny/2)^2 for two waves, so c = A^2 Lx Ly / 4. */
static void
check_wave(size_t nx, size_t ny, long m, long n)
{
    const struct rc_shape s = {nx, ny, 1.1e-6, ny == 1 ? 1.1e-6 : 1e-6};
    const double A = 3e-9, Lx = (double)nx * s.dx, Ly = ny == 1 ? 1 : (double)ny * s.dy;
    double *h = malloc(nx * ny * sizeof *h), *map = malloc(nx * ny * sizeof *map);
    struct rc_psd *psd;
    double q = 2 * exact_pi * hypot((double)m / Lx, (double)n / Ly), found = 0, rest = 0;
    size_t at = (size_t)((long)(ny / 2) + n) * nx + (size_t)((long)(nx / 2) + m);
    size_t opposite = (size_t)((long)(ny / 2) - n) * nx + (size_t)((long)(nx / 2) - m), waves = 0;

    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            h[j * nx + i] =
                5e-8 +
                A * cos(2 * exact_pi *
                        ((double)m * (double)i / (double)nx + (double)n * (double)j / (double)ny));
    psd = spectrum(&s, h, &(struct rc_psd_options){.boundary = RC_PERIODIC, .map = map});
    assert_near(map[at], A * A * Lx * Ly / 4, summed);
    assert_near(map[opposite], A * A * Lx * Ly / 4, summed);
    for (size_t k = 0; k < nx * ny; k++)
        rest = fmax(rest, k == at || k == opposite ? 0 : map[k]);
    assert_true(rest <= 1e-20 * map[at]); /* 1e-10 of the amplitude */
    for (size_t k = 0; k < psd->rings; k++) {
        waves += psd->modes[k];
        assert_true(k == 0 || psd->q[k] > psd->q[k - 1]);
        if (psd->c[k] * (double)psd->modes[k] > A * A * Lx * Ly / 4) {
            found++;
            assert_near(psd->q[k], q, ny == 1 ? rounding : 0.5 / hypot((double)m, (double)n));
            assert_near(psd->c[k] * (double)psd->modes[k], A * A * Lx * Ly / 2, summed);
        }
    }
    assert_true(found == 1);
    assert_int_equal(waves, nx * ny - 1); /* all but the mean */
    assert_string_equal(psd->window, "none");
    rc_psd_free(psd);
    free(map);
    free(h);
}

static void
test_wave(void **state)
{
    (void)state;
    check_wave(64, 48, 5, 7);
    check_wave(63, 47, -5, 7);
    check_wave(33, 48, 9, 0);
    check_wave(64, 35, 0, -4);
    check_wave(90, 1, 7, 0);
}

/* ---- windows ---- */

/* Weights of node i of n from the literature (Harris 1978, Proc. IEEE 66, 51), at the centre of its cell. */
static double
none(double t)
{
    (void)t;
    return 1;
}

static double
hann(double t)
{
    return sin(exact_pi * t) * sin(exact_pi * t);
}

static double
hamming(double t)
{
    return 0.08 + 0.92 * hann(t);
}

static double
blackman(double t)
{
    return 0.42 - 0.5 * cos(2 * exact_pi * t) + 0.08 * cos(4 * exact_pi * t);
}

static const struct {
    const char *name;
    double (*at)(double t);
} windows[] = {{"none", none}, {"hann", hann}, {"hamming", hamming}, {"blackman", blackman}};

enum {
    WINDOWS = sizeof windows / sizeof *windows
};

/* A map that repeats along one axis has no window along it. */
static double
weight(size_t k, struct rc_boundary boundary, const struct rc_shape *s, size_t node)
{
    const bool one = boundary.x != boundary.y;
    double x = ((double)(node % s->nx) + 0.5) / (double)s->nx;
    double y = ((double)(node / s->nx) + 0.5) / (double)s->ny;

    return (s->nx == 1 || (one && boundary.x) ? 1 : windows[k].at(x)) *
           (s->ny == 1 || (one && boundary.y) ? 1 : windows[k].at(y));
}

/* Computes for heights under window k: their mean, the mean square about it, and the mean square of the
 * window. */
static void
seen_through(size_t k, struct rc_boundary boundary, const struct rc_shape *s, const double *h,
             double *mean, double *square, double *power)
{
    size_t n = s->nx * s->ny;
    double sum = 0, weights = 0;

    *square = *power = 0;
    for (size_t i = 0; i < n; i++) {
        sum += weight(k, boundary, s, i) * h[i];
        weights += weight(k, boundary, s, i);
    }
    *mean = sum / weights;
    for (size_t i = 0; i < n; i++) {
        double w = weight(k, boundary, s, i);
        *square += w * w * (h[i] - *mean) * (h[i] - *mean) / (double)n;
        *power += w * w / (double)n;
    }
}

/* The sum over all waves is the mean square under the window divided by that of the window. It is not scaled
 * to Sq^2, which is a separate figure. */
static void
test_parseval(void **state)
{
    static const struct rc_shape shapes[] = {{64, 48, 1.1e-6, 1e-6}, {33, 47, 1e-6, 1.3e-6},
                                             {1, 101, 2e-6, 1e-6},   {97, 1, 1e-6, 1e-6},
                                             {2, 2, 1e-6, 1e-6},     {500, 3, 1e-6, 1e-6}};

    (void)state;
    srand(7);
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
        const struct rc_shape *s = &shapes[k];
        double *h = malloc(s->nx * s->ny * sizeof *h);
        double lx = s->nx == 1 ? 1 : (double)s->nx * s->dx;
        double ly = s->ny == 1 ? 1 : (double)s->ny * s->dy;
        struct rc_statistics statistics;
        for (size_t i = 0; i < s->nx * s->ny; i++)
            h[i] = 4e-6 + 1e-6 * rand() / RAND_MAX + 1e-7 * (double)(i % s->nx);
        rc_measure(s, h, &statistics);
        for (size_t b = 0; b < 4 * WINDOWS + 4; b++) {
            const struct rc_psd_options options = {.boundary = rc_boundary_of(b & 1, b & 2),
                                                   .window = b < 4 * WINDOWS ? windows[b / 4].name
                                                                             : NULL};
            size_t window = b < 4 * WINDOWS ? b / 4 : b % 4 == 3 ? 0 : 1;
            struct rc_psd *psd = spectrum(s, h, &options);
            double mean, square, power;
            seen_through(window, options.boundary, s, h, &mean, &square, &power);
            assert_near(total(psd) / (lx * ly), square / power, parseval);
            assert_near(psd->sum, square / power, parseval);
            assert_near(psd->mean_square, statistics.rms * statistics.rms, parseval);
            assert_string_equal(psd->window, windows[window].name);
            rc_psd_free(psd);
        }
        free(h);
    }
}

/* Each window by plain sums: the wave (m, n) of (h - mean) w, where the mean is weighted by w. */
static void
test_window(void **state)
{
    const struct rc_shape s = {24, 18, 1.1e-6, 1e-6};
    const size_t n = s.nx * s.ny;
    double h[24 * 18], map[24 * 18];

    (void)state;
    srand(11);
    for (size_t k = 0; k < n; k++) {
        double x = ((double)(k % s.nx) + 0.5) / (double)s.nx;
        h[k] = 1e-6 * rand() / RAND_MAX + 3e-6 * x * x;
    }
    for (size_t turn = 0; turn < 3 * WINDOWS; turn++) {
        const size_t b = turn / 3;
        const struct rc_psd_options options = {.boundary =
                                                   rc_boundary_of(turn % 3 == 1, turn % 3 == 2),
                                               .window = windows[b].name,
                                               .map = map};
        double mean, square, power;
        rc_psd_free(spectrum(&s, h, &options));
        seen_through(b, options.boundary, &s, h, &mean, &square, &power);
        if (b == 1)
            assert_near(power, turn % 3 == 0 ? 9.0 / 64 : 3.0 / 8, summed);
        for (long ky = -9; ky < 9; ky += 2)
            for (long kx = -12; kx < 12; kx += 3) {
                double re = 0, im = 0;
                for (size_t k = 0; k < n; k++) {
                    double phase = 2 * exact_pi *
                                   ((double)kx * (double)(k % s.nx) / (double)s.nx +
                                    (double)ky * (double)(k / s.nx) / (double)s.ny);
                    re += weight(b, options.boundary, &s, k) * (h[k] - mean) * cos(phase);
                    im += weight(b, options.boundary, &s, k) * (h[k] - mean) * sin(phase);
                }
                assert_near(map[(size_t)(ky + 9) * s.nx + (size_t)(kx + 12)],
                            (re * re + im * im) * s.dx * s.dy / (double)n / power, 1e-9);
            }
    }
}

/* A wave of whole periods under a Hann window. It has A^2/2 in total, of which (mean w)^2/mean(w^2) = 4/9 is
 * at its own wave number and the rest at the neighbours. */
static void
test_wave_under_hann(void **state)
{
    const struct rc_shape s = {64, 50, 1.1e-6, 1e-6};
    const double A = 3e-9, area = (double)(s.nx * s.ny) * s.dx * s.dy;
    double h[64 * 50], map[64 * 50];
    struct rc_psd *psd;

    (void)state;
    for (size_t k = 0; k < s.nx * s.ny; k++)
        h[k] = 5e-8 + A * cos(2 * exact_pi *
                              (9 * (double)(k % s.nx) / 64 - 7 * (double)(k / s.nx) / 50 + 0.123));
    psd = spectrum(&s, h, &(struct rc_psd_options){.map = map});
    assert_near(psd->sum, A * A / 2, summed);
    assert_near(psd->mean_square, A * A / 2, summed);
    assert_near(map[(25 - 7) * s.nx + 32 + 9], A * A * area / 4 * 4 / 9, summed);
    rc_psd_free(psd);
}

/* ---- a known spectrum ---- */

/* A quarter of a periodic surface with c = C0 up to the wave number of the roll-off and C0 (q/q0)^(-2-2H)
 * beyond. A remaining bow, large or small, must not change the waves. Over the rings from twice the roll-off
 * up to half the shortest wave, the mean squares of heights and of slopes are the known ones. They are so
 * within the scatter of 8 surfaces: about 1200 independent waves of the heights, 3 %. */
static void
test_known(void **state)
{
    enum {
        N = 256,
        SIDE = 2 * N,
        SEEDS = 8
    };
    static const double scatter = 0.04, hurst = 0.7, rms = 1e-8, d = 0.7e-6;
    const struct rc_shape s = {N, N, d, d}, whole = {SIDE, SIDE, d, d};
    const double q0 = 2 * exact_pi / (32 * d), unit = 2 * exact_pi / (SIDE * d);
    const double from = 2 * q0, to = exact_pi / (2 * d);
    double *h = malloc(sizeof *h * SIDE * SIDE), power = 0;

    (void)state;
    for (long n = -SIDE / 2; n < SIDE / 2; n++)
        for (long m = -SIDE / 2; m < SIDE / 2; m++)
            if (m != 0 || n != 0)
                power += pow(fmax(unit * hypot((double)m, (double)n) / q0, 1), -2 - 2 * hurst);
    for (int bow = 0; bow < 3; bow++) {
        double height = 0, slope = 0, known_height = 0, known_slope = 0, sums = 0;
        for (uint64_t seed = 1; seed <= SEEDS; seed++) {
            const struct rc_selfaffine what = {
                .hurst = hurst, .rms_height = rms, .rolloff = 32 * d, .seed = seed};
            struct rc_psd *psd;
            assert_int_equal(rc_synth_selfaffine(&whole, &what, h, NULL), RC_OK);
            for (size_t j = 1; j < N; j++)
                memmove(h + j * N, h + j * SIDE, N * sizeof *h);
            for (size_t k = 0; k < N * N; k++) {
                double x = ((double)(k % N) + 0.5) / N - 0.5;
                h[k] += bow * 10 * rms * x * x;
            }
            psd = spectrum(&s, h, &(struct rc_psd_options){0});
            sums += psd->sum / psd->mean_square / SEEDS;
            for (size_t k = 0; k < psd->rings; k++) {
                double q = psd->q[k], modes = (double)psd->modes[k];
                double c = rms * rms * SIDE * SIDE * d * d / power * pow(q / q0, -2 - 2 * hurst);
                if (q < from || q > to)
                    continue;
                height += modes * psd->c[k];
                slope += modes * psd->c[k] * q * q;
                known_height += modes * c;
                known_slope += modes * c * q * q;
            }
            rc_psd_free(psd);
        }
        print_message("bow %d: heights %.4f of the known, slopes %.4f, sum %.4f of Sq^2\n", bow,
                      height / known_height, slope / known_slope, sums);
        assert_near(height, known_height, scatter);
        assert_near(slope, known_slope, scatter);
        assert_true(bow == 0 ? fabs(sums - 1) < 2 * scatter : sums < 0.9); /* not made 1 */
    }
    free(h);
}

/* ---- Hurst exponents ---- */

struct made {
    size_t n;
    double rolloff, short_cut; /* in nodes; 0: none */
};

/* told: the range of the fit is given, otherwise it is found automatically. The largest error over seeds. A
 * map that is not periodic is a quarter of a periodic one. */
static double
worst(const struct made *made, double hurst, struct rc_boundary boundary, bool told)
{
    const double d = 0.7e-6;
    const size_t n = made->n, side = rc_repeats(boundary) == 0 ? 2 * n : n;
    const struct rc_shape s = {n, n, d, d}, whole = {side, side, d, d};
    double *h = malloc(side * side * sizeof *h), most = 0;

    for (uint64_t seed = 1; seed <= 4; seed++) {
        const struct rc_selfaffine what = {.hurst = hurst,
                                           .rms_height = 1e-8,
                                           .rolloff = made->rolloff * d,
                                           .short_cut = made->short_cut * d,
                                           .seed = seed};
        struct rc_psd_options options = {.boundary = boundary};
        struct rc_psd *psd;
        double shortest = (made->short_cut > 0 ? made->short_cut : 2) * d;
        double longest = (made->rolloff > 0 ? made->rolloff : (double)made->n) * d;
        assert_int_equal(rc_synth_selfaffine(&whole, &what, h, NULL), RC_OK);
        for (size_t j = 1; j < n; j++)
            memmove(h + j * n, h + j * side, n * sizeof *h);
        if (told) {
            options.shortest = shortest;
            options.longest = longest;
        }
        psd = spectrum(&s, h, &options);
        if (!(fabs(psd->hurst - hurst) <= exponent))
            print_message("H %g: %g, from %g to %g m, seed %u\n", hurst, psd->hurst, psd->shortest,
                          psd->longest, (unsigned)seed);
        most = larger(fabs(psd->hurst - hurst), most);
        /* the standard error agrees, for about fifty surfaces; most of it allows for deviations of real
         * surfaces from a power law, which these have not */
        assert_true(fabs(psd->hurst - hurst) <= 3 * psd->hurst_error);
        assert_true(psd->hurst_error < exponent);
        /* the automatic range lies in the true one, except for some waves at its ends, and covers at least
         * half of it */
        assert_true(psd->shortest >= 0.9 * shortest && psd->longest <= 2 * longest);
        assert_true(psd->longest / psd->shortest >= sqrt(longest / shortest));
        rc_psd_free(psd);
    }
    free(h);
    return most;
}

static void
test_hurst(void **state)
{
    static const struct made made[] = {{256, 0, 0}, {512, 64, 0}, {512, 0, 6}, {1024, 128, 6}};
    static const double hursts[] = {0.3, 0.5, 0.8};

    (void)state;
    for (size_t k = 0; k < sizeof made / sizeof *made; k++)
        for (size_t i = 0; i < 3; i++) {
            double found = worst(&made[k], hursts[i], RC_PERIODIC, false);
            double told = worst(&made[k], hursts[i], RC_PERIODIC, true);
            print_message("%zu nodes, roll-off %g, cut-off %g: H %g off by %.3f, told %.3f\n",
                          made[k].n, made[k].rolloff, made[k].short_cut, hursts[i], found, told);
            assert_true(found <= exponent && told <= exponent);
        }
}

/* Under a window a quarter of the waves are independent. */
static void
test_hurst_windowed(void **state)
{
    static const struct made made[] = {{512, 0, 0}, {512, 64, 0}};
    static const double hursts[] = {0.3, 0.5, 0.8};

    (void)state;
    for (size_t k = 0; k < sizeof made / sizeof *made; k++)
        for (size_t i = 0; i < 3; i++) {
            double found = worst(&made[k], hursts[i], RC_FREE, false);
            double told = worst(&made[k], hursts[i], RC_FREE, true);
            print_message("%zu nodes, roll-off %g: H %g off by %.3f, told %.3f, windowed\n",
                          made[k].n, made[k].rolloff, hursts[i], found, told);
            assert_true(found <= exponent && told <= exponent);
        }
}

static void
test_hurst_of_profiles(void **state)
{
    enum {
        N = 65536
    };
    const struct rc_shape row = {N, 1, 1e-6, 1e-6}, column = {1, N, 1e-6, 1e-6};
    static const double hursts[] = {0.3, 0.5, 0.8};
    double *h = malloc(N * sizeof *h);

    (void)state;
    for (size_t i = 0; i < 3; i++) {
        const struct rc_selfaffine what = {.hurst = hursts[i], .rms_height = 1e-8, .seed = 3};
        const struct rc_psd_options options = {.boundary = RC_PERIODIC};
        struct rc_psd *psd;
        assert_int_equal(rc_synth_selfaffine(&row, &what, h, NULL), RC_OK);
        psd = spectrum(&row, h, &options);
        assert_true(fabs(psd->hurst - hursts[i]) <= exponent);
        rc_psd_free(psd);
        psd = spectrum(&column, h, &options);
        assert_true(fabs(psd->hurst - hursts[i]) <= exponent);
        rc_psd_free(psd);
    }
    free(h);
}

/* Surfaces without a power law have no exponent: noise, a wave, a flat. */
static void
test_no_power_law(void **state)
{
    const struct rc_shape s = {128, 128, 1e-6, 1e-6};
    double *h = malloc(128 * 128 * sizeof *h);

    (void)state;
    srand(5);
    for (int k = 0; k < 3; k++) {
        struct rc_psd *psd;
        for (size_t i = 0; i < 128 * 128; i++)
            h[i] = k == 0   ? 1e-9 * rand() / RAND_MAX
                   : k == 1 ? 1e-9 * cos(2 * exact_pi * (double)(i % 128) / 16)
                            : 0;
        psd = spectrum(&s, h, &(struct rc_psd_options){.boundary = RC_PERIODIC});
        if (!isnan(psd->hurst) || !isnan(psd->longest))
            fail_msg("surface %d: H %g from %g to %g m", k, psd->hurst, psd->shortest,
                     psd->longest);
        rc_psd_free(psd);
    }
    free(h);
}

/* The number of threads does not change a digit. */
static void
test_threads(void **state)
{
    const struct rc_shape s = {300, 257, 1e-6, 1.1e-6};
    double *h = malloc(s.nx * s.ny * sizeof *h);
    struct rc_psd *one, *many;

    (void)state;
    srand(17);
    for (size_t k = 0; k < s.nx * s.ny; k++)
        h[k] = 1e-9 * rand() / RAND_MAX;
    one = spectrum(&s, h, &(struct rc_psd_options){.threads = 1});
    many = spectrum(&s, h, &(struct rc_psd_options){.threads = 7});
    assert_int_equal(one->rings, many->rings);
    assert_memory_equal(one->q, many->q, one->rings * sizeof *one->q);
    assert_memory_equal(one->c, many->c, one->rings * sizeof *one->c);
    rc_psd_free(one);
    rc_psd_free(many);
    free(h);
}

/* ---- refusals ---- */

static void
refused(const struct rc_shape *s, const double *h, const struct rc_psd_options *options,
        const char *why)
{
    struct rc_err err = {""};

    assert_null(rc_psd_new(s, h, options, &err));
    assert_string_equal(err.text, why);
}

static void
test_refusals(void **state)
{
    const struct rc_shape s = {4, 3, 1e-6, 1e-6}, one = {1, 1, 1e-6, 1e-6};
    double h[12] = {1, 2, 3, 4, NAN, 6, 7, 8, 9, 10, 11, INFINITY};
    const struct rc_psd_options plain = {0};

    (void)state;
    refused(&s, h, &plain, "2 of 12 heights are missing or infinite: a spectrum needs all");
    refused(&one, h, &plain, "a single node has no spectrum");
    h[4] = h[11] = 5;
    refused(&s, h, &(struct rc_psd_options){.shortest = 2e-6, .longest = 1e-6},
            "wavelengths from 2e-06 m to 1e-06 m: the shortest comes first, both are positive");
    refused(&s, h, &(struct rc_psd_options){.window = "Hann"},
            "no window is called Hann: there are none, hann, hamming, blackman");
    refused(&s, h, &(struct rc_psd_options){.shortest = 1e-3, .longest = 2e-3},
            "the map holds no two rings of waves from 0.001 m to 0.002 m");
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wave),           cmocka_unit_test(test_parseval),
        cmocka_unit_test(test_window),         cmocka_unit_test(test_wave_under_hann),
        cmocka_unit_test(test_known),          cmocka_unit_test(test_hurst),
        cmocka_unit_test(test_hurst_windowed), cmocka_unit_test(test_hurst_of_profiles),
        cmocka_unit_test(test_no_power_law),   cmocka_unit_test(test_threads),
        cmocka_unit_test(test_refusals),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
