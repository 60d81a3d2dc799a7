/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The field of a cell of width d under a wave Q along the other axis, at the distance x:
 *
 *     C(x) = 1/pi integral from 0 to infinity of S(q) d sinc(q d/2) cos(q x) dq      (odd S: sin(q x))
 *
 * At the nodes, waves whose q differ by 2 pi/d are the same. So
 *
 *     C(x) = d/pi integral from 0 to pi/d of [S(q) sinc(q d/2) + A(q)] cos(q x) dq
 *     A(q) = sin(q d/2) sum over k != 0 of (-1)^k S(q + 2 pi k/d) / (q d/2 + pi k)
 *
 * A is smooth, and is computed from a Chebyshev series. The integral is a trapezoidal rule on N points, which
 * is a Fourier transform. Its error is the field of the nearest image, at the distance R = N d - x.
 *
 * The field decreases as exp(-Q x), and nodes where this is below rounding get 0. If it is not 0 at R, the
 * transform takes S(q) [1 - w(q)] for S(q), where w(q) = erfc((q - b)/s)/2, s = 12/R, b = 6 s. The other
 * part, S(q) w(q), is integrated by Gauss's rule, on intervals as wide as their distance from q = 0. So S may
 * vary on any scale of length. For Q = 0 and even S the integral has no limit where S(q) = a/q for q -> 0.
 * With [q < c] = 1 for q < c and 0 otherwise,
 *
 *     integral from 0 to infinity of (cos(q x) - [q < c]) dq/q = -ln(x/datum),     c = exp(-gamma)/datum,
 *
 * where gamma is Euler's constant: [q < c] a d/pi/q is subtracted from the integrand.
 */
#include "line.h"

#include <gsl/gsl_fft_halfcomplex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "quadrature.h"

enum {
    LEAST = 128, /* points of the transform, so that waves with w(q) > 0 are below pi/d   */
    POINTS = 24, /* of the Chebyshev series: its error is below (2 + sqrt 3)^-24          */
    TERMS = 28,  /* of an alternating sum, see weights()                                  */
    GAUSS = RC_GAUSS_MOST,
    ANEW = 32, /* nodes after which cosines are computed anew; between, they are rotated */
    LANES = 8, /* partial sums, for wide registers                                       */
    BLOCK = 64 /* waves of a body computed together                                      */
};

static const double images = 37; /* of Q R: exp(-37) is below rounding */
/* R s and b/s: exp(-(R s/2)^2) and erfc(6) are below rounding */
static const double part = 12, edge = 6;
/* q x at the end of the first interval without a wave, where cos(q x) is 1; q over this end where S q = a */
static const double longest = 0x1p-27, limit = 1e-12;
static const double grown = 1e6; /* of S between these two: it is not bounded there */
static const double euler = 0.577215664901532861;

/* One call. The wanted functions are f = 0, 1, ... < count. */
struct line {
    const struct rc_line_source *source;
    const struct rc_line_at *at;
    size_t count, function[RC_LINE_MOST]; /* f in the source */
    bool odd[RC_LINE_MOST];
    double *out[RC_LINE_MOST];
    size_t n;                          /* nodes whose field is not 0                     */
    size_t points;                     /* N                                              */
    double far;                        /* distance of the last node, at least a cell, m  */
    double s;                          /* of w, rad/m; 0: all waves are in the transform */
    double largest;                    /* symbol at the waves of the transform           */
    double tail[RC_LINE_MOST][POINTS]; /* Chebyshev series                               */
};

/* Symbols at n wave numbers; those of function f to v + f stride. */
static void
symbols(const struct line *l, size_t n, size_t stride, const double *q, double *v)
{
    double *to[RC_LINE_MOST] = {NULL};

    for (size_t f = 0; f < l->count; f++)
        to[l->function[f]] = v + f * stride;
    l->source->symbols(l->source->of, n, q, to);
}

static double
sinc(double x)
{
    return x == 0 ? 1 : sin(x) / x;
}

/* w(q) */
static double
window(const struct line *l, double q)
{
    return l->s == 0 ? 0 : erfc(q / l->s - edge) / 2;
}

/* ---- shorter waves than pi/d ---- */

/* The sum of (-1)^k f(k) for all k >= 0 is that of w[k] f(k), k < TERMS (Cohen, Rodriguez Villegas and
 * Zagier, Exp. Math. 9 (2000) 3, algorithm 1). Its error is (3 + sqrt 8)^-TERMS if f is the transform of a
 * measure on 0..1, as exp(-k) and 1/k are. It is below 1e-13 if f has poles on other sides, 45 degrees or
 * more from the positive axis, as responses of layers have. */
static void
weights(double w[TERMS])
{
    double power = pow(3 + sqrt(8), TERMS), d = (power + 1 / power) / 2, b = -1, c = -d;

    for (int k = 0; k < TERMS; k++) {
        c = b - c;
        w[k] = c / d;
        b *= (double)(k + TERMS) * (k - TERMS) / ((k + 0.5) * (k + 1));
    }
}

/* From values at the Chebyshev points t to -2 times the terms of one parity of the series. */
static void
to_series(const double t[POINTS], bool odd_terms, double f[POINTS])
{
    double c[POINTS] = {0};

    for (int i = 0; i < POINTS; i++) {
        double before = t[i], is = 1; /* T_(n-1) and T_n */
        for (int n = 0; n < POINTS; n++) {
            double next = 2 * t[i] * is - before;
            c[n] += f[i] * is;
            before = is;
            is = next;
        }
    }
    for (int n = 0; n < POINTS; n++)
        f[n] = (n % 2 == 1) == odd_terms ? -2 * (n == 0 ? 1 : 2) * c[n] / POINTS : 0;
}

/* With p = (2 + t) pi/d, |t| <= 1, the sum over k >= 0 of (-1)^k S(p + 2 pi k/d) / (p d/2 + pi k) is a
 * function g(t). In A(q) the sum over k > 0 is -g(q d/pi), and that over k < 0 is g(-q d/pi), or -g(-q d/pi)
 * if S is odd. So terms of one parity remain. Short waves do not reach a depth: the sum ends where S does. */
static void
sum_tails(struct line *l)
{
    double w[TERMS], t[POINTS], q[POINTS], v[RC_LINE_MOST * POINTS], most = INFINITY;

    weights(w);
    memset(l->tail, 0, sizeof l->tail);
    for (int i = 0; i < POINTS; i++)
        t[i] = cos(RC_PI * (i + 0.5) / POINTS);
    for (int k = 0; k < TERMS && most > DBL_EPSILON / TERMS * l->largest; k++) {
        for (int i = 0; i < POINTS; i++)
            q[i] = (2 + t[i] + 2 * k) * RC_PI / l->at->cell;
        symbols(l, POINTS, POINTS, q, v);
        most = 0;
        for (size_t f = 0; f < l->count; f++)
            for (size_t i = 0; i < POINTS; i++) {
                most = fmax(most, fabs(v[f * POINTS + i]));
                l->tail[f][i] += w[k] * v[f * POINTS + i] / (q[i] * l->at->cell / 2);
            }
    }
    for (size_t f = 0; f < l->count; f++)
        to_series(t, !l->odd[f], l->tail[f]);
}

/* The series of terms of one parity at t, by Clenshaw's recurrence: T_(n+4) = 2 T_2 T_(n+2) - T_n. */
static double
series(const double c[POINTS], bool odd_terms, double t)
{
    double u = 2 * t * t - 1, b = 0, b1 = 0;

    for (int n = POINTS - 2 + odd_terms; n >= 0; n -= 2) {
        double b2 = b1;
        b1 = b;
        b = c[n] + 2 * u * b1 - b2;
    }
    return odd_terms ? t * (b - b1) : b - u * b1;
}

/* ---- the transform ---- */

/* From the symbols in v to the field. */
static void
transform(const struct line *l, size_t f, const double *q, double *v)
{
    size_t n = l->points;

    for (size_t k = 0; k <= n / 2; k++) {
        double half = q[k] * l->at->cell / 2, sine = sin(half);
        v[k] *= (half == 0 ? 1 : sine / half) * (1 - window(l, q[k]));
        v[k] += sine * series(l->tail[f], !l->odd[f], 2 * half / RC_PI);
        v[k] /= (double)n;
    }
    /* real parts from the beginning, imaginary parts from the end: of sines minus the amplitude */
    for (size_t k = 1; k < n / 2; k++) {
        v[n - k] = l->odd[f] ? -v[k] : 0;
        v[k] = l->odd[f] ? 0 : v[k];
    }
    if (l->odd[f])
        v[0] = v[n / 2] = 0;
    gsl_fft_halfcomplex_radix2_backward(v, 1, n);
    for (size_t i = 0; i < l->at->n; i++)
        l->out[f][i] = i < l->n ? v[i * l->at->step] : 0;
}

static enum rc_status
transform_all(struct line *l)
{
    size_t n = l->points, half = n / 2, from = l->at->wave == 0;
    RC_OWNED double *q = rc_alloc(half + 1, sizeof *q), *v = rc_alloc(l->count * n, sizeof *v);

    if (q == NULL || v == NULL)
        return RC_FAIL;
    for (size_t k = 0; k <= half; k++)
        q[k] = 2 * RC_PI * (double)k / ((double)n * l->at->cell);
    symbols(l, half + 1 - from, n, q + from, v + from);
    for (size_t f = 0; f < l->count; f++) {
        for (size_t k = from; k <= half; k++)
            l->largest = fmax(l->largest, fabs(v[f * n + k]));
        v[f * n] = from > 0 ? 0 : v[f * n]; /* w(0) = 1 */
    }
    sum_tails(l);
    for (size_t f = 0; f < l->count; f++)
        transform(l, f, q, v + f * n);
    return RC_OK;
}

/* ---- long waves ---- */

/* Waves of Gauss's rule, their cosines and sines at a node, and the rotation to the next node. */
struct waves {
    size_t n;
    double *q, *c, *s, *to_c, *to_s;
    double *v; /* n of each function: symbols, then amplitudes */
};

/* The first interval and the widest, rad/m. On an interval the phase at the last node changes by at most 4
 * radians, and the argument of erfc by at most 1. */
static void
intervals(const struct line *l, double *first, double *widest)
{
    *widest = fmin(4 / l->far, l->s);
    *first = l->at->wave > 0 ? fmin(l->at->wave / 2, *widest) : longest / l->far;
}

/* Returns the number of waves; writes them, and their weights, if q is not NULL. */
static size_t
set_rule(const struct line *l, double *q, double *weight)
{
    double from = 0, wide, widest;
    size_t n = 0;

    for (intervals(l, &wide, &widest); from < 2 * edge * l->s; wide = fmin(from, widest)) {
        for (int k = 0; k < GAUSS && q != NULL; k++) {
            struct rc_gauss g = rc_gauss_point(GAUSS, k);
            q[n + (size_t)k] = from + wide / 2 * (1 + g.x);
            weight[n + (size_t)k] = wide / 2 * g.w;
        }
        n += GAUSS;
        from += wide;
    }
    return n;
}

/* a of each function, 0 if S does not grow as 1/q. */
static void
limits(const struct line *l, double first, double a[])
{
    const double q[] = {limit * first, first};
    double v[RC_LINE_MOST * 2];

    symbols(l, 2, 2, q, v);
    for (size_t f = 0; f < l->count; f++) {
        bool grows = fabs(v[2 * f]) > grown * fabs(v[2 * f + 1]);
        a[f] = grows && !l->odd[f] ? q[0] * v[2 * f] : 0;
    }
}

/* From symbols to amplitudes. */
static void
set_amplitudes(const struct line *l, struct waves *w, const double *weight, double constant[])
{
    double d = l->at->cell, first, widest, a[RC_LINE_MOST] = {0};

    intervals(l, &first, &widest);
    if (l->at->wave == 0)
        limits(l, first, a);
    for (size_t f = 0; f < l->count; f++) {
        double *v = w->v + f * w->n;
        for (size_t j = 0; j < w->n; j++) {
            v[j] -= w->q[j] < first ? a[f] / w->q[j] : 0;
            v[j] *= weight[j] * window(l, w->q[j]) * sinc(w->q[j] * d / 2) * d / RC_PI;
        }
        constant[f] = a[f] == 0 ? 0 : a[f] * d / RC_PI * (log(first * l->at->datum) + euler);
    }
}

RC_CLONES static double
product(size_t n, const double *restrict a, const double *restrict b)
{
    double lane[LANES] = {0}, sum = 0;
    size_t j = 0;

    for (; j + LANES <= n; j += LANES)
        for (size_t k = 0; k < LANES; k++)
            lane[k] += a[j + k] * b[j + k];
    for (; j < n; j++)
        sum += a[j] * b[j];
    for (size_t k = 0; k < LANES; k++)
        sum += lane[k];
    return sum;
}

RC_CLONES static void
rotate(size_t n, const double *restrict to_c, const double *restrict to_s, double *restrict c,
       double *restrict s)
{
    for (size_t j = 0; j < n; j++) {
        double cosine = c[j] * to_c[j] - s[j] * to_s[j];
        s[j] = s[j] * to_c[j] + c[j] * to_s[j];
        c[j] = cosine;
    }
}

static void
turn_to(const struct waves *w, double x, double *c, double *s)
{
    for (size_t j = 0; j < w->n; j++) {
        c[j] = cos(w->q[j] * x);
        s[j] = sin(w->q[j] * x);
    }
}

static void
add_waves(const struct line *l, const struct waves *w, const double constant[])
{
    double h = (double)l->at->step * l->at->cell;

    turn_to(w, h, w->to_c, w->to_s);
    for (size_t i = 0; i < l->n; i++) {
        if (i % ANEW == 0)
            turn_to(w, (double)i * h, w->c, w->s);
        else
            rotate(w->n, w->to_c, w->to_s, w->c, w->s);
        for (size_t f = 0; f < l->count; f++)
            l->out[f][i] += constant[f] + product(w->n, w->v + f * w->n, l->odd[f] ? w->s : w->c);
    }
}

static enum rc_status
add_long_waves(const struct line *l)
{
    size_t n = set_rule(l, NULL, NULL);
    RC_OWNED double *of = rc_alloc((5 + l->count) * n, sizeof *of);
    struct waves w = {n, of, of + n, of + 2 * n, of + 3 * n, of + 4 * n, of + 5 * n};
    double constant[RC_LINE_MOST];

    if (of == NULL)
        return RC_FAIL;
    set_rule(l, w.q, w.c);
    symbols(l, n, n, w.q, w.v);
    set_amplitudes(l, &w, w.c, constant);
    add_waves(l, &w, constant);
    return RC_OK;
}

/* ---- functions ---- */

enum rc_status
rc_line_coefficients(const struct rc_line_source *source, const struct rc_line_at *at,
                     double *const out[], struct rc_err *err)
{
    const double shown = images / (at->wave * at->cell) / (double)at->step;
    struct line l = {.source = source, .at = at, .points = LEAST, .n = at->n};
    double cells, reach;

    for (size_t f = 0; f < source->count; f++)
        if (out[f] != NULL) {
            l.function[l.count] = f;
            l.odd[l.count] = source->odd >> f & 1;
            l.out[l.count++] = out[f];
        }
    if (l.count == 0)
        return RC_OK;
    if (shown + 2 < (double)at->n)
        l.n = (size_t)shown + 2;
    cells = (double)(l.n - 1) * (double)at->step;
    while ((double)l.points < 2 * cells && l.points <= SIZE_MAX / 4)
        l.points *= 2;
    l.far = fmax(cells, 1) * at->cell;
    reach = ((double)l.points - cells) * at->cell;
    l.s = at->wave * reach >= images ? 0 : part / reach;
    if (transform_all(&l) != RC_OK || (l.s > 0 && add_long_waves(&l) != RC_OK))
        return rc_err_set(err, "out of memory for the coefficients of %zu nodes", at->n);
    return RC_OK;
}

struct along {
    const struct rc_kernel *kernel;
    const struct rc_inside *inside;
    bool x;
    double wave;
};

static void
kernel_symbols(const void *of, size_t n, const double *q, double *const out[])
{
    const struct along *a = of;

    for (size_t k = 0; k < n; k++)
        out[0][k] = a->x ? a->kernel->symbol(a->kernel->of, q[k], a->wave)
                         : a->kernel->symbol(a->kernel->of, a->wave, q[k]);
}

enum rc_status
rc_kernel_line(const struct rc_kernel *kernel, bool along_x, const struct rc_line_at *at,
               double *out, struct rc_err *err)
{
    const unsigned along = along_x ? RC_ODD_X : RC_ODD_Y;
    const struct along a = {.kernel = kernel, .x = along_x, .wave = at->wave};
    const struct rc_line_source source = {1, (kernel->parity & along) != 0, kernel_symbols, &a};

    return rc_line_coefficients(&source, at, &out, err);
}

static void
inside_symbols(const void *of, size_t n, const double *q, double *const out[])
{
    static const struct rc_shape no_shape = {1, 1, 1, 1}; /* matters for the wave q = 0 alone */
    const struct along *a = of;
    double wave[BLOCK], x[BLOCK], y[BLOCK], size[BLOCK], numbers[BLOCK * RC_WAVE_NUMBERS];

    for (size_t k = 0; k < BLOCK; k++)
        wave[k] = a->wave;
    for (size_t from = 0; from < n; from += BLOCK) {
        size_t count = n - from < BLOCK ? n - from : BLOCK;
        const struct rc_waves waves = {count, x, y, size, numbers};
        rc_wave_directions(count, a->x ? q + from : wave, a->x ? wave : q + from, x, y, size);
        a->inside->type->waves(a->inside, count, size, numbers);
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            if (out[k] != NULL)
                rc_inside_symbol(a->inside, k, &waves, &no_shape, out[k] + from);
    }
}

enum rc_status
rc_inside_lines(const struct rc_inside *inside, unsigned kernels, bool along_x,
                const struct rc_line_at *at, double *const out[RC_STRESS_KERNELS],
                struct rc_err *err)
{
    const unsigned along = along_x ? RC_ODD_X : RC_ODD_Y;
    const struct along a = {.inside = inside, .x = along_x, .wave = at->wave};
    struct rc_line_source source = {RC_STRESS_KERNELS, 0, inside_symbols, &a};
    double *to[RC_STRESS_KERNELS] = {NULL};

    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (kernels >> k & 1) {
            source.odd |= (rc_stress_parity[k] & along) != 0 ? 1u << k : 0;
            to[k] = out[k];
        }
    return rc_line_coefficients(&source, at, to, err);
}
