/*
 * The integral is a convolution in the logarithms of q and r, with the kernel exp(x) J_m(exp(x)), whose
 * Fourier transform is 2^(iw) Gamma((1 + m + iw)/2) / Gamma((1 + m - iw)/2). So one transform of samples at
 * even steps of ln q gives r f(r) at even steps of ln r. What does not decay as q -> 0 is taken off
 * beforehand and added in closed form: tail exp(-q s)/q, which makes tail/sqrt(r^2 + s^2).
 *
 * Kept is f sqrt(r^2 + s^2), which is bounded and smooth in ln r, with six-point interpolation; near the
 * axis, where ln r has no end, the power series of the Bessel function is summed.
 */
#include "radial.h"

#include <gsl/gsl_fft_complex.h>
#include <gsl/gsl_sf_gamma.h>
#include <math.h>
#include <stdlib.h>

#include "libcontact/memory.h"

static const double pi = 3.14159265358979323846;

enum {
    SAMPLES = 2048, /* of ln q                           */
    FINER = 8,      /* steps of ln r in one of ln q      */
    POINTS = 6,     /* of the interpolation              */
    TERMS = 10      /* of the power series               */
};

static const double step = 0.05;    /* of ln q                              */
static const double near = 0.125;   /* of s: from there on the table        */
static const double farthest = 1e6; /* of s: from there on as at its end    */

struct rc_radial {
    int order;
    double scale, near;
    double series[TERMS]; /* coefficients of r^(m + 2k)                        */
    double first;         /* ln r of table[0]                                  */
    size_t n;
    double *table; /* f sqrt(r^2 + s^2)                                 */
};

static double
sample(size_t n, double unit)
{
    return exp(((double)n - SAMPLES / 2) * step) / unit;
}

/* w ln 2 + 2 arg Gamma((1 + m + i w)/2), by which the wave k of ln q is turned. */
static double
turn(int order, double w)
{
    gsl_sf_result size, angle;

    gsl_sf_lngamma_complex_e((1 + order) / 2.0, w / 2, &size, &angle);
    return w * log(2) + 2 * angle.val;
}

/* r f(r), without its tail, at r = exp(j step/FINER)/q_last, j < FINER SAMPLES; in out[2 j]. */
static void
transform(const struct rc_radial_source *source, const double *g, double *out)
{
    size_t all = (size_t)SAMPLES * FINER;
    double *h = out; /* SAMPLES complex numbers, then all */
    double range = (SAMPLES - 1) * step;

    for (size_t n = 0; n < SAMPLES; n++) {
        double q = sample(n, source->unit);
        h[2 * n] = q * g[n] - source->tail * exp(-q * source->scale);
        h[2 * n + 1] = 0;
    }
    gsl_fft_complex_radix2_forward(h, 1, SAMPLES);
    for (size_t k = SAMPLES; k < all; k++)
        out[2 * k] = out[2 * k + 1] = 0;
    for (size_t k = SAMPLES / 2 + 1; k < SAMPLES; k++) { /* negative waves to the end */
        size_t to = all - SAMPLES + k;
        out[2 * to] = h[2 * k];
        out[2 * to + 1] = h[2 * k + 1];
        h[2 * k] = h[2 * k + 1] = 0;
    }
    h[SAMPLES] = h[SAMPLES + 1] = 0; /* the wave of two samples */
    for (size_t k = 0; k < SAMPLES / 2; k++) {
        /* r begins at 1/q_last: ln(q_0 r) = - range there */
        double w = 2 * pi * (double)k / (SAMPLES * step),
               angle = turn(source->order, w) + w * range;
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

static void
set_series(struct rc_radial *f, const struct rc_radial_source *source, const double *g)
{
    for (int k = 0; k < TERMS; k++) {
        double sum = 0, factor = k % 2 == 0 ? 1 : -1;

        for (size_t n = 0; n < SAMPLES; n++) {
            double q = sample(n, source->unit) * source->scale; /* else powers overflow */
            if (g[n] != 0)
                sum += pow(q, source->order + 2 * k + 2) * g[n];
        }
        for (int i = 1; i <= source->order + k; i++)
            factor /= i;
        for (int i = 1; i <= k; i++)
            factor /= i;
        /* of (r/s)^(m + 2k) */
        f->series[k] =
            factor * step * sum / pow(2, source->order + 2 * k) / (source->scale * source->scale);
    }
}

/* The table from what stands at out[2 j]. */
static enum rc_status
set_table(struct rc_radial *f, const struct rc_radial_source *source, const double *out)
{
    double fine = step / FINER, begin = -log(sample(SAMPLES - 1, source->unit));
    size_t from = (size_t)((log(near * source->scale) - begin) / fine) - POINTS;
    size_t to = (size_t)((log(farthest * source->scale) - begin) / fine) + POINTS;

    f->first = begin + (double)from * fine;
    f->n = to - from;
    if ((f->table = rc_alloc(f->n, sizeof *f->table)) == NULL)
        return RC_FAIL;
    for (size_t j = 0; j < f->n; j++) {
        double r = exp(f->first + (double)j * fine);
        f->table[j] = source->tail + out[2 * (from + j)] / r * hypot(r, source->scale);
    }
    return RC_OK;
}

struct rc_radial *
rc_radial_new(const struct rc_radial_source *source)
{
    struct rc_radial *f = calloc(1, sizeof *f);
    double *g = malloc(SAMPLES * sizeof *g);
    double *out = malloc(2 * (size_t)SAMPLES * FINER * sizeof *out);

    if (f == NULL || g == NULL || out == NULL)
        goto fail;
    f->order = source->order;
    f->scale = source->scale;
    f->near = near * source->scale;
    for (size_t n = 0; n < SAMPLES; n++) {
        double q = sample(n, source->unit);
        g[n] = q * source->unit > source->last ? 0 : source->wave(source->ctx, q);
    }
    set_series(f, source, g);
    transform(source, g, out);
    if (set_table(f, source, out) != RC_OK)
        goto fail;
    free(g);
    free(out);
    return f;
fail:
    free(g);
    free(out);
    rc_radial_free(f);
    return NULL;
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

static double
by_series(const struct rc_radial *f, double r)
{
    double x = r / f->scale, sum = 0;

    for (int k = TERMS; k-- > 0;)
        sum = sum * x * x + f->series[k];
    for (int k = 0; k < f->order; k++)
        sum *= x;
    return sum;
}

/* Lagrange's polynomial through six even points, at t from the third of them, 0 <= t < 1. */
static inline double
interpolate(const double *v, double t)
{
    double a = t + 2, b = t + 1, c = t, d = t - 1, e = t - 2, f = t - 3;

    return -v[0] * b * c * d * e * f / 120 + v[1] * a * c * d * e * f / 24 -
           v[2] * a * b * d * e * f / 12 + v[3] * a * b * c * e * f / 12 -
           v[4] * a * b * c * d * f / 24 + v[5] * a * b * c * d * e / 120;
}

void
rc_radial_values(const struct rc_radial *f, size_t n, const double *r, double *out)
{
    const double per = FINER / step;
    double most = (double)(f->n - POINTS);

    for (size_t k = 0; k < n; k++) {
        double x, whole;

        if (r[k] < f->near) {
            out[k] = by_series(f, r[k]);
            continue;
        }
        x = (log(r[k]) - f->first) * per;
        x = x < most ? x : most;
        whole = floor(x);
        out[k] = interpolate(f->table + (size_t)whole - 2, x - whole) /
                 sqrt(r[k] * r[k] + f->scale * f->scale);
    }
}
