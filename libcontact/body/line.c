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
 *
 * Where C is 0 at half of a period of N nodes, S(q) sinc(q d/2) + A(q) itself is the transform of the period.
 */
#include "line.h"

#include <assert.h>
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
    ANEW = 32,  /* nodes after which cosines are computed anew; between, they are rotated */
    LANES = 8,  /* partial sums, for wide registers                                       */
    LONGER = 8, /* of the transform, see points_for() */
    WAVES = 32, /* waves whose series are summed together                                */
    BLOCK = 64  /* waves of a body computed together                                      */
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
    size_t points, waves;              /* N; waves 2 pi k/(N d), k = 0, 1, ... that are not 0 */
    double last;                       /* the largest q that is not 0, rad/m             */
    double far;                        /* distance of the last node, at least a cell, m  */
    double s;                          /* of w, rad/m; 0: all waves are in the transform */
    double largest[RC_LINE_MOST];      /* symbol at the waves of the transform           */
    double tail[RC_LINE_MOST][POINTS]; /* Chebyshev series                               */
    int terms[RC_LINE_MOST]; /* of the series, an even number: the others are negligible */
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

/* The waves of the transform. Arrays have room for WAVES more. */
struct comb {
    double *q, *t;         /* rad/m; q d/pi */
    double *sine, *factor; /* sin(q d/2); sinc(q d/2) (1 - w(q)) */
    double *v;             /* `stride` of each function: symbols, then amplitudes */
    size_t stride;
    struct rc_store own;
};

static double
largest(size_t n, const double *v)
{
    double most = 0;

    for (size_t k = 0; k < n; k++)
        most = fabs(v[k]) > most ? fabs(v[k]) : most;
    return most;
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
    double w[TERMS], t[POINTS], q[POINTS], v[RC_LINE_MOST * POINTS], most[RC_LINE_MOST];
    bool more = true;

    weights(w);
    memset(l->tail, 0, sizeof l->tail);
    for (int i = 0; i < POINTS; i++)
        t[i] = cos(RC_PI * (i + 0.5) / POINTS);
    for (size_t f = 0; f < l->count; f++)
        most[f] = INFINITY;
    for (int k = 0; k < TERMS && more && (1 + 2 * k) * RC_PI / l->at->cell <= l->last; k++) {
        for (int i = 0; i < POINTS; i++)
            q[i] = (2 + t[i] + 2 * k) * RC_PI / l->at->cell;
        symbols(l, POINTS, POINTS, q, v);
        more = false;
        for (size_t f = 0; f < l->count; f++) {
            if (!(most[f] > DBL_EPSILON / TERMS * l->largest[f]))
                continue;
            more = true;
            most[f] = largest(POINTS, v + f * POINTS);
            for (size_t i = 0; i < POINTS; i++)
                l->tail[f][i] += w[k] * v[f * POINTS + i] / (q[i] * l->at->cell / 2);
        }
    }
    for (size_t f = 0; f < l->count; f++) {
        const double least = DBL_EPSILON / POINTS * l->largest[f];
        if (!(largest(POINTS, l->tail[f]) > least))
            continue;
        to_series(t, !l->odd[f], l->tail[f]);
        l->terms[f] = POINTS;
        while (l->terms[f] > 0 && !(largest(2, l->tail[f] + l->terms[f] - 2) > least))
            l->terms[f] -= 2;
    }
}

/* Eight waves: the sums of several stay in registers, which plain loops do not achieve. */
typedef double vector __attribute__((vector_size(64), aligned(8)));

/* Adds sin(q d/2) times the series of terms of one parity, by Clenshaw's recurrence, T_(n+4) = 2 T_2
 * T_(n+2) - T_n, to the symbols times their factors. */
RC_WIDE_CLONES static void
add_series(size_t n, const double *restrict c, int terms, bool odd_terms,
           const struct comb *restrict comb, double *restrict v)
{
    enum {
        VECTORS = WAVES / 8
    };
    const vector *restrict t = (const vector *)comb->t, *restrict sine = (const vector *)comb->sine;
    const vector *restrict factor = (const vector *)comb->factor;

    for (size_t from = 0; 8 * from < n; from += VECTORS) {
        vector twice[VECTORS], b[VECTORS] = {{0}}, b1[VECTORS] = {{0}};
        vector *restrict to = (vector *)v + from;
        for (size_t k = 0; k < VECTORS; k++)
            twice[k] = 4 * t[from + k] * t[from + k] - 2;
        for (int m = terms - 2 + odd_terms; m >= 0; m -= 2)
            for (size_t k = 0; k < VECTORS; k++) {
                vector next = twice[k] * b[k] + (c[m] - b1[k]);
                b1[k] = b[k];
                b[k] = next;
            }
        for (size_t k = 0; k < VECTORS; k++) {
            vector sum = odd_terms ? t[from + k] * (b[k] - b1[k]) : b[k] - twice[k] / 2 * b1[k];
            to[k] = to[k] * factor[from + k] + sine[from + k] * sum;
        }
    }
}

/* ---- the transform ---- */

static void
comb_free(struct comb *c)
{
    rc_store_free(&c->own);
}

/* The sines by rotation from wave to wave. */
static void
set_comb(const struct line *l, struct comb *c)
{
    const double turn = RC_PI / (double)l->points, by_c = cos(turn), by_s = sin(turn);
    double cosine = 1, sine = 0;

    for (size_t k = 0; k < l->waves + WAVES; k++) {
        const double half = turn * (double)k, before = cosine;
        if (k % ANEW == 0) {
            cosine = cos(half);
            sine = sin(half);
        } else {
            cosine = cosine * by_c - sine * by_s;
            sine = sine * by_c + before * by_s;
        }
        c->q[k] = 2 * half / l->at->cell;
        c->t[k] = 2 * half / RC_PI;
        c->sine[k] = sine;
        c->factor[k] = (k == 0 ? 1 : sine / half) * (1 - window(l, c->q[k]));
    }
}

/* The amplitudes of the waves: N/d times the integrand. They have room for `room` numbers of each
 * function. */
static enum rc_status
comb_new(struct line *l, size_t room, struct comb *c)
{
    const size_t from = l->at->wave == 0, n = l->waves + WAVES;

    *c = (struct comb){.stride = room > n ? room : n};
    c->q = rc_store_take(&c->own, n, sizeof *c->q);
    c->t = rc_store_take(&c->own, n, sizeof *c->t);
    c->sine = rc_store_take(&c->own, n, sizeof *c->sine);
    c->factor = rc_store_take(&c->own, n, sizeof *c->factor);
    c->v = rc_store_take(&c->own, l->count * c->stride, sizeof *c->v);
    if (c->own.failed)
        return RC_FAIL;
    set_comb(l, c);
    symbols(l, l->waves - from, c->stride, c->q + from, c->v + from);
    for (size_t f = 0; f < l->count; f++) {
        double *v = c->v + f * c->stride;
        v[0] = from > 0 ? 0 : v[0]; /* w(0) = 1 */
        l->largest[f] = largest(l->waves, v);
    }
    sum_tails(l);
    for (size_t f = 0; f < l->count; f++)
        add_series(l->waves, l->tail[f], l->terms[f], !l->odd[f], c, c->v + f * c->stride);
    return RC_OK;
}

/* From amplitudes to the field. */
static void
transform(const struct line *l, size_t f, double *v)
{
    size_t n = l->points;

    for (size_t k = 0; k < l->waves; k++)
        v[k] /= (double)n;
    memset(v + l->waves, 0, (n - l->waves) * sizeof *v);
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
    RC_ENDS(comb_free) struct comb c;

    if (comb_new(l, l->points, &c) != RC_OK)
        return RC_FAIL;
    for (size_t f = 0; f < l->count; f++)
        transform(l, f, c.v + f * c.stride);
    return RC_OK;
}

/* From the amplitudes at all cells of a period to the transform at its nodes, every step-th cell: waves that
 * differ by 2 pi/(step d) are the same. */
static void
fold(const struct line *l, size_t f, const double *v)
{
    const size_t n = l->at->n;
    const double step = (double)l->at->step;
    double *out = l->out[f];

    memset(out, 0, (n / 2 + 1) * sizeof *out);
    for (size_t k = 0; k < l->waves && 2 * k <= n; k++)
        out[k] = v[k] / step;
    for (size_t k = n / 2; l->at->step > 1 && k < l->waves; k++) {
        const size_t right = k % n, left = (n - right) % n;
        if (2 * right <= n && 2 * k > n)
            out[right] += v[k] / step;
        if (2 * left <= n && k > 0 && 2 * k != l->points)
            out[left] += (l->odd[f] ? -v[k] : v[k]) / step;
    }
    if (l->odd[f])
        out[0] = 0;
    if (l->odd[f] && n % 2 == 0)
        out[n / 2] = 0;
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

static struct line
begin(const struct rc_line_source *source, const struct rc_line_at *at, double most,
      double *const out[], size_t points)
{
    struct line l = {.source = source, .at = at, .points = points, .last = most};
    double waves;

    for (size_t f = 0; f < source->count; f++)
        if (out[f] != NULL) {
            l.function[l.count] = f;
            l.odd[l.count] = source->odd >> f & 1;
            l.out[l.count++] = out[f];
        }
    if (isfinite(most))
        l.last = sqrt(fmax(0, most * most - at->wave * at->wave));
    waves = l.last * (double)points * at->cell / (2 * RC_PI);
    l.waves = 1 + (waves < (double)(points / 2) ? (size_t)waves : points / 2);
    return l;
}

/* N: at least twice the nodes, and more where the field then decays as far as the nearest image: up to LONGER
 * times the transform costs less than the long waves. */
static size_t
points_for(const struct rc_line_at *at, double cells)
{
    size_t points = LEAST, longer;

    while ((double)points < 2 * cells && points <= SIZE_MAX / 4)
        points *= 2;
    longer = points;
    while (at->wave * ((double)longer - cells) * at->cell < images && longer / points < LONGER &&
           longer <= SIZE_MAX / 4)
        longer *= 2;
    return at->wave * ((double)longer - cells) * at->cell < images ? points : longer;
}

static enum rc_status
coefficients(const struct rc_line_source *source, const struct rc_line_at *at, double most,
             double *const out[], struct rc_err *err)
{
    const double shown = images / (at->wave * at->cell) / (double)at->step;
    const size_t n = shown + 2 < (double)at->n ? (size_t)shown + 2 : at->n;
    const double cells = (double)(n - 1) * (double)at->step;
    struct line l = begin(source, at, most, out, points_for(at, cells));
    double reach;

    if (l.count == 0)
        return RC_OK;
    l.n = n;
    l.far = fmax(cells, 1) * at->cell;
    reach = ((double)l.points - cells) * at->cell;
    l.s = at->wave * reach >= images ? 0 : part / reach;
    if (transform_all(&l) != RC_OK || (l.s > 0 && add_long_waves(&l) != RC_OK))
        return rc_err_set(err, "out of memory for the coefficients of %zu nodes", at->n);
    return RC_OK;
}

enum rc_status
rc_line_coefficients(const struct rc_line_source *source, const struct rc_line_at *at,
                     double *const out[], struct rc_err *err)
{
    return coefficients(source, at, INFINITY, out, err);
}

bool
rc_line_decays(const struct rc_line_at *at)
{
    /* from the edge of the cell to the node at half a period */
    return at->wave * ((double)at->n * (double)at->step - 1) * at->cell / 2 >= images;
}

static enum rc_status
spectra(const struct rc_line_source *source, const struct rc_line_at *at, double most,
        double *const out[], struct rc_err *err)
{
    struct line l = begin(source, at, most, out, at->n * at->step);
    RC_ENDS(comb_free) struct comb c = {.stride = 0};

    assert(rc_line_decays(at));
    if (l.count > 0 && comb_new(&l, 0, &c) != RC_OK)
        return rc_err_set(err, "out of memory for the transforms of %zu coefficients", at->n);
    for (size_t f = 0; f < l.count; f++)
        fold(&l, f, c.v + f * c.stride);
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

    if (kernel->line != NULL)
        return kernel->line(kernel->of, along_x, at, out, err);
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

static struct rc_line_source
inside_source(const struct along *along, unsigned kernels, double *const out[RC_STRESS_KERNELS],
              double *to[RC_STRESS_KERNELS])
{
    const unsigned axis = along->x ? RC_ODD_X : RC_ODD_Y;
    struct rc_line_source source = {RC_STRESS_KERNELS, 0, inside_symbols, along};

    for (int k = 0; k < RC_STRESS_KERNELS; k++) {
        source.odd |= (rc_stress_parity[k] & axis) != 0 ? 1u << k : 0;
        to[k] = kernels >> k & 1 ? out[k] : NULL;
    }
    return source;
}

enum rc_status
rc_inside_lines(const struct rc_inside *inside, unsigned kernels, bool along_x,
                const struct rc_line_at *at, double most, double *const out[RC_STRESS_KERNELS],
                struct rc_err *err)
{
    const struct along a = {.inside = inside, .x = along_x, .wave = at->wave};
    double *to[RC_STRESS_KERNELS];
    const struct rc_line_source source = inside_source(&a, kernels, out, to);

    return coefficients(&source, at, most, to, err);
}

enum rc_status
rc_inside_spectra(const struct rc_inside *inside, unsigned kernels, bool along_x,
                  const struct rc_line_at *at, double most, double *const out[RC_STRESS_KERNELS],
                  struct rc_err *err)
{
    const struct along a = {.inside = inside, .x = along_x, .wave = at->wave};
    double *to[RC_STRESS_KERNELS];
    const struct rc_line_source source = inside_source(&a, kernels, out, to);

    return spectra(&source, at, most, to, err);
}
