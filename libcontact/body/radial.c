/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The integral is a convolution in the logarithms of q and r with the kernel exp(x) J_m(exp(x)). The kernel's
 * Fourier transform is 2^(iw) Gamma((1 + m + iw)/2) / Gamma((1 + m - iw)/2). So one transform of samples at
 * even steps of ln q gives r f(r) at even steps of ln r. The part tail exp(-q s)/q, which does not decay as q
 * -> 0, is subtracted before. Its integral, tail/sqrt(r^2 + s^2), is added in closed form.
 *
 * The table holds f sqrt(r^2 + s^2), which is bounded and smooth in ln r, for six-point interpolation. Near
 * the axis, where ln r is unbounded, the power series of the Bessel function is summed.
 */
#include "radial.h"

#include <gsl/gsl_fft_complex.h>
#include <gsl/gsl_sf_gamma.h>
#include <math.h>
#include <stdlib.h>

#include "libcontact/memory.h"

enum {
    SAMPLES = 2048, /* number of samples of ln q */
    FINER = 8,      /* steps of ln r per step of ln q */
    POINTS = 6,     /* number of points of the interpolation */
    TERMS = 10      /* terms of the power series */
};

static const double step = 0.05;    /* step of ln q */
static const double near = 0.125;   /* the table starts at this s                      */
static const double farthest = 1e6; /* beyond this s, the value at the end of the table */

struct rc_radial {
    size_t n; /* functions                                          */
    int order[RC_RADIAL_MOST];
    double scale, near;
    double series[TERMS][RC_RADIAL_MOST]; /* coefficients of r^(m + 2k)                   */
    double first;                         /* ln r of table[0]                                  */
    size_t length;
    double *table; /* f sqrt(r^2 + s^2), of all functions at each r       */
};

static double
sample(size_t n, double unit)
{
    return exp(((double)n - 0.5 * SAMPLES) * step) / unit;
}

/* w ln 2 + 2 arg Gamma((1 + m + i w)/2): the phase of the wave k of ln q. */
static double
turn(int order, double w)
{
    gsl_sf_result size, angle;

    gsl_sf_lngamma_complex_e((1 + order) / 2.0, w / 2, &size, &angle);
    return w * log(2) + 2 * angle.val;
}

/* r f(r) of function i, without its tail, at r = exp(j step/FINER)/q_last, j < FINER SAMPLES; in out[2 j]. */
static void
transform(const struct rc_radial_source *source, size_t i, const double *g, double *out)
{
    size_t all = (size_t)SAMPLES * FINER;
    double *h = out; /* SAMPLES complex numbers, then all */
    double range = (SAMPLES - 1) * step;

    for (size_t n = 0; n < SAMPLES; n++) {
        double q = sample(n, source->unit);
        h[2 * n] = q * g[n * source->n + i] - source->tail * exp(-q * source->scale);
        h[2 * n + 1] = 0;
    }
    gsl_fft_complex_radix2_forward(h, 1, SAMPLES);
    for (size_t k = SAMPLES; k < all; k++)
        out[2 * k] = out[2 * k + 1] = 0;
    for (size_t k = SAMPLES / 2 + 1; k < SAMPLES; k++) { /* negative waves follow */
        size_t to = all - SAMPLES + k;
        out[2 * to] = h[2 * k];
        out[2 * to + 1] = h[2 * k + 1];
        h[2 * k] = h[2 * k + 1] = 0;
    }
    h[SAMPLES] = h[SAMPLES + 1] = 0; /* the wave of two samples */
    for (size_t k = 0; k < SAMPLES / 2; k++) {
        /* r begins at 1/q_last: ln(q_0 r) = - range there */
        double w = 2 * RC_PI * (double)k / (SAMPLES * step),
               angle = turn(source->order[i], w) + w * range;
        double c = cos(angle), s = sin(angle), re = out[2 * k], im = out[2 * k + 1];
        size_t minus = all - k;

        out[2 * k] = re * c - im * s;
        out[2 * k + 1] = re * s + im * c;
        if (k > 0) { /* h is real: the negative wave is the conjugate */
            out[2 * minus] = out[2 * k];
            out[2 * minus + 1] = -out[2 * k + 1];
        }
    }
    gsl_fft_complex_radix2_forward(out, 1, all);
    for (size_t j = 0; j < all; j++)
        out[2 * j] /= SAMPLES;
}

/* The coefficients use powers of q s, which do not overflow. */
static void
set_series(struct rc_radial *f, const struct rc_radial_source *source, const double *g)
{
    double per = step / (source->scale * source->scale);

    for (size_t n = 0; n < SAMPLES; n++) {
        double q = sample(n, source->unit) * source->scale;
        for (size_t i = 0; i < f->n; i++) {
            double power = g[n * f->n + i] == 0 ? 0 : pow(q, f->order[i] + 2) * g[n * f->n + i];
            for (int k = 0; k < TERMS && power != 0; k++) {
                f->series[k][i] += power;
                power *= q * q;
            }
        }
    }
    for (size_t i = 0; i < f->n; i++)
        for (int k = 0; k < TERMS; k++) {
            double factor = k % 2 == 0 ? 1 : -1;
            for (int l = 1; l <= f->order[i] + k; l++)
                factor /= l;
            for (int l = 1; l <= k; l++)
                factor /= l;
            /* of (r/s)^(m + 2k) */
            f->series[k][i] *= factor * per / pow(2, f->order[i] + 2 * k);
        }
}

static void
table_range(const struct rc_radial_source *source, size_t *from, size_t *to)
{
    double fine = step / FINER, begin = -log(sample(SAMPLES - 1, source->unit));

    *from = (size_t)((log(near * source->scale) - begin) / fine) - POINTS;
    *to = (size_t)((log(farthest * source->scale) - begin) / fine) + POINTS;
}

static enum rc_status
table_new(struct rc_radial *f, const struct rc_radial_source *source)
{
    size_t from, to;

    table_range(source, &from, &to);
    f->first = -log(sample(SAMPLES - 1, source->unit)) + (double)from * step / FINER;
    f->length = to - from;
    f->table = rc_alloc(f->length, f->n * sizeof *f->table);
    return f->table == NULL ? RC_FAIL : RC_OK;
}

/* Sets the table of function i from out[2 j]. */
static void
set_table(struct rc_radial *f, const struct rc_radial_source *source, size_t i, const double *out)
{
    size_t from, to;

    table_range(source, &from, &to);
    for (size_t j = 0; j < f->length; j++) {
        double r = exp(f->first + (double)j * step / FINER);
        f->table[j * f->n + i] = source->tail + out[2 * (from + j)] / r * hypot(r, source->scale);
    }
}

struct rc_radial *
rc_radial_new(const struct rc_radial_source *source)
{
    RC_OWN(rc_radial, f) = calloc(1, sizeof *f);
    RC_OWNED double *g = calloc(SAMPLES * source->n, sizeof *g);
    RC_OWNED double *out = malloc(2 * (size_t)SAMPLES * FINER * sizeof *out);

    if (f == NULL || g == NULL || out == NULL)
        return NULL;
    f->n = source->n;
    f->scale = source->scale;
    f->near = near * source->scale;
    if (table_new(f, source) != RC_OK)
        return NULL;
    for (size_t i = 0; i < f->n; i++)
        f->order[i] = source->order[i];
    for (size_t n = 0; n < SAMPLES; n++) {
        double q = sample(n, source->unit);
        if (q * source->unit <= source->last)
            source->wave(source->ctx, q, g + n * f->n);
    }
    set_series(f, source, g);
    for (size_t i = 0; i < f->n; i++) {
        transform(source, i, g, out);
        set_table(f, source, i, out);
    }
    return rc_give(&f);
}

void
rc_radial_free(struct rc_radial *f)
{
    if (f == NULL)
        return;
    free(f->table);
    free(f);
}

/* ---- values ---- */

static void
by_series(const struct rc_radial *f, double r, double *out)
{
    double x = r / f->scale, x2 = x * x;

    for (size_t i = 0; i < f->n; i++) {
        double sum = 0;
        for (int k = TERMS; k-- > 0;)
            sum = sum * x2 + f->series[k][i];
        for (int k = 0; k < f->order[i]; k++)
            sum *= x;
        out[i] = sum;
    }
}

/* Weights of Lagrange's polynomial through six equidistant points, at t from the third of them, 0 <= t <
 * 1. */
static inline void
weigh(double t, double w[POINTS])
{
    double a = t + 2, b = t + 1, c = t, d = t - 1, e = t - 2, f = t - 3;

    w[0] = -b * c * d * e * f / 120;
    w[1] = a * c * d * e * f / 24;
    w[2] = -a * b * d * e * f / 12;
    w[3] = a * b * c * e * f / 12;
    w[4] = -a * b * c * d * f / 24;
    w[5] = a * b * c * d * e / 120;
}

void
rc_radial_values(const struct rc_radial *f, size_t points, const double *r, double *out)
{
    const double per = FINER / step;
    double most = (double)(f->length - POINTS);
    size_t n = f->n;

    for (size_t k = 0; k < points; k++, out += n) {
        double x, whole, over, w[POINTS];
        const double *v;

        if (r[k] < f->near) {
            by_series(f, r[k], out);
            continue;
        }
        x = (log(r[k]) - f->first) * per;
        x = x < most ? x : most;
        whole = floor(x);
        weigh(x - whole, w);
        v = f->table + ((size_t)whole - 2) * n;
        over = 1 / sqrt(r[k] * r[k] + f->scale * f->scale);
        for (size_t i = 0; i < n; i++)
            out[i] = over * (w[0] * v[i] + w[1] * v[n + i] + w[2] * v[2 * n + i] +
                             w[3] * v[3 * n + i] + w[4] * v[4 * n + i] + w[5] * v[5 * n + i]);
    }
}
