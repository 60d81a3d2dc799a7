/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Power spectral densities, and the Hurst exponent.
 *
 * A map is multiplied by a window along its free axes, after its windowed mean is subtracted. So the mean
 * does not leak into the waves. The density is divided by the mean square of the window and by nothing else,
 * so it is unbiased for a statistically homogeneous surface. A factor that made the sum equal Sq^2 would
 * scale all waves. It would depend on long waves, or on a remaining form, near the edges.
 *
 * The Hurst exponent is fitted to log c over log q by least squares over 24 bins per decade. The relative
 * error of a bin of n waves is about 1/sqrt(n/2) (squares of waves are distributed exponentially, and
 * opposite waves are equal). The mean of a logarithm is biased by psi(n/2) - ln(n/2). No real surface follows
 * a power law better than a few per cent, which limits the weight of the many short waves. If no range is
 * given, the chosen range balances the misfit of the line against the number of excluded bins.
 */
#include "areal.h"

#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "libcontact/transform/transform.h"

enum {
    PARTS = 64,     /* parts of the spectrum, at most, that are summed separately */
    PER_DECADE = 24 /* bins of the fit                                            */
};

/* Relative error of a power law; cost of an excluded bin, equal to a misfit of twice the expected one. Then:
 * the smallest ratio of the wavelengths at the ends of a power law, and its largest misfit over the expected
 * one. Last: the possible Hurst exponents, with an allowance. */
static const double model_error = 0.05, price = 4, span = 3, fits = 3;
static const double lowest = -0.05, highest = 1.1;
/* Relative, so that waves at the ends of a range belong to it. The second is the fraction of the largest
 * density below which there is only rounding. */
static const double slack = 1e-9, rounded = 1e-27;
/* The fit ends at this fraction of the wave number of the shortest wave that the grid resolves in all
 * directions. Waves of exactly two nodes are only partly seen. */
static const double resolved = 0.98;

/* ---- windows ---- */

/* a[0] - a[1] cos(x) + a[2] cos(2 x), x from 0 to 2 pi along a side. The number of its waves is the number of
 * neighbours to which it spreads a wave of the surface (Harris 1978, Proc. IEEE 66, 51). */
struct rc_window {
    const char *name;
    size_t waves;
    double a[3];
};

static const struct rc_window windows[] = {
    {"none", 0, {1, 0, 0}},
    {"hann", 1, {0.5, 0.5, 0}},
    {"hamming", 1, {0.54, 0.46, 0}},
    {"blackman", 2, {0.42, 0.5, 0.08}},
};

enum {
    WINDOWS = sizeof windows / sizeof *windows
};

const struct rc_window *const rc_window_hann = &windows[1];

const char *
rc_window_name(size_t k)
{
    return k < WINDOWS ? windows[k].name : NULL;
}

/* NULL: no window has this name. */
static const struct rc_window *
window_of(const struct rc_psd_options *o)
{
    const char *name = o->window != NULL ? o->window : rc_has_mean(o->boundary) ? "hann" : "none";

    for (size_t k = 0; k < WINDOWS; k++)
        if (strcmp(windows[k].name, name) == 0)
            return &windows[k];
    return NULL;
}

/* The window along an axis. A map that repeats along both has the given one. */
static const struct rc_window *
along(const struct rc_windowed *w, enum rc_map_axis axis)
{
    return rc_repeats(w->boundary) == 1 && rc_wraps(w->boundary, axis) ? &windows[0] : w->window;
}

static double
weight(const struct rc_window *w, size_t i, size_t n)
{
    double x = 2 * RC_PI * ((double)i + 0.5) / (double)n;

    return n == 1 || w->waves == 0 ? 1 : w->a[0] - w->a[1] * cos(x) + w->a[2] * cos(2 * x);
}

/* For the weights of a side: the mean square, and the number of correlated waves that count as one. This
 * number is the mean fourth power over the square of the mean square, 35/18 for Hann's. */
static void
side_figures(const struct rc_window *w, size_t n, double *square, double *alike)
{
    struct rc_total two = {0}, four = {0};

    for (size_t i = 0; i < n; i++) {
        double f = weight(w, i, n);
        rc_total_add(&two, f * f);
        rc_total_add(&four, f * f * f * f);
    }
    *square = rc_total_value(&two) / (double)n;
    *alike = rc_total_value(&four) / (double)n / (*square * *square);
}

/* Lowest rings, into which the mean leaks. */
static double
leaked(const struct rc_window *w)
{
    return w->waves > 0 ? (double)w->waves + 1.5 : 0;
}

/* Rings by which a given range is narrowed at either end, because waves beyond it may follow another law. */
static double
spread(const struct rc_window *w)
{
    return w->waves > 0 ? (double)w->waves + 0.5 : 0;
}

void
rc_windowed_row(const void *of, size_t j, double *row)
{
    const struct rc_windowed *w = of;
    const double *h = w->h + j * w->shape->nx, wy = weight(along(w, RC_Y), j, w->shape->ny);

    for (size_t i = 0; i < w->shape->nx; i++)
        row[i] = rc_there(h[i]) ? w->wx[i] * wy * (h[i] - w->mean) : 0;
}

double
rc_windowed_lay(struct rc_windowed *w, double mean)
{
    struct rc_total weights = {0}, weighted = {0}, squares = {0};
    const size_t nx = w->shape->nx, ny = w->shape->ny;

    for (size_t i = 0; i < nx; i++)
        w->wx[i] = weight(along(w, RC_X), i, nx);
    for (size_t j = 0; j < ny; j++) {
        const double *h = w->h + j * nx, wy = weight(along(w, RC_Y), j, ny);
        double row[3] = {0};
        for (size_t i = 0; i < nx; i++) {
            bool there = rc_there(h[i]);
            double f = there ? w->wx[i] * wy : 0, d = there ? h[i] - mean : 0;
            row[0] += f;
            row[1] += f * d;
            row[2] += d * d;
        }
        rc_total_add(&weights, row[0]);
        rc_total_add(&weighted, row[1]);
        rc_total_add(&squares, row[2]);
    }
    w->mean = mean + rc_total_value(&weighted) / rc_total_value(&weights);
    return rc_total_value(&squares) / ((double)nx * (double)ny);
}

/* Makes the window, the factor that turns |FFT|^2 into a density, and Sq^2. */
static enum rc_status
lay_window(struct rc_windowed *w, double *factor, double *square, double *alike, struct rc_err *err)
{
    const struct rc_shape *s = w->shape;
    double nodes = (double)s->nx * (double)s->ny, mean = rc_sum(w->h, s->nx * s->ny) / nodes;
    double square_x, square_y, alike_x, alike_y;

    if (!isfinite(mean)) {
        size_t bad = 0;
        for (size_t k = 0; k < s->nx * s->ny; k++)
            bad += rc_there(w->h[k]) ? 0 : 1;
        return bad == 0 ? rc_err_set(err, "the heights are too large to be added up")
                        : rc_err_set(err,
                                     "%zu of %zu heights are missing or infinite: a spectrum "
                                     "needs all",
                                     bad, s->nx * s->ny);
    }
    *square = rc_windowed_lay(w, mean);
    side_figures(along(w, RC_X), s->nx, &square_x, &alike_x);
    side_figures(along(w, RC_Y), s->ny, &square_y, &alike_y);
    *alike = alike_x * alike_y; /* waves that count as one */
    *factor = (s->nx > 1 ? s->dx / (double)s->nx : 1) * (s->ny > 1 ? s->dy / (double)s->ny : 1) /
              (square_x * square_y);
    return RC_OK;
}

/* ---- rings ---- */

/* Sums over one ring: over all waves, and over those of the fit. */
struct ring {
    double n, q, c;
    double fit_n, fit_q, fit_c; /* fit_c: of c q^steep */
};

struct rings {
    struct rc_shape shape;
    double width; /* rad/m */
    size_t n;
    double low, high; /* low and high of the fit, rad/m */
    int steep;        /* c q^steep hardly varies across a ring */
    struct ring *ring;
};

/* Wave number of the shortest wave that the grid resolves in all directions. */
static double
nyquist(const struct rc_shape *s)
{
    return RC_PI / (s->nx == 1 ? s->dy : s->ny == 1 ? s->dx : fmax(s->dx, s->dy));
}

static struct rings
rings_of(const struct rc_shape *s)
{
    double qx = s->nx > 1 ? rc_fourier_q(1, s->nx, s->dx) : INFINITY;
    double qy = s->ny > 1 ? rc_fourier_q(1, s->ny, s->dy) : INFINITY;
    double corner = hypot(s->nx > 1 ? rc_fourier_q(s->nx / 2, s->nx, s->dx) : 0,
                          s->ny > 1 ? rc_fourier_q(s->ny / 2, s->ny, s->dy) : 0);
    struct rings r = {.shape = *s, .steep = s->nx > 1 && s->ny > 1 ? 3 : 2};

    /* on a strip with very different sides, most rings as narrow as the lowest wave number would be empty */
    r.width = fmax(fmin(fabs(qx), fabs(qy)), corner / (2 * (double)(s->nx + s->ny)));
    r.n = (size_t)floor(corner / r.width + 0.5) + 1;
    return r;
}

static void
add_column(const struct rings *r, const double *power, size_t k, double factor, struct ring *ring)
{
    const struct rc_shape *s = &r->shape;
    double qx = rc_fourier_q(k, s->nx, s->dx), twice = k == 0 || 2 * k == s->nx ? 1 : 2;

    for (size_t j = 0; j < s->ny; j++) {
        double qy = rc_fourier_q(j, s->ny, s->dy), q = sqrt(qx * qx + qy * qy);
        double c = factor * power[k * s->ny + j];
        struct ring *to;
        if (k == 0 && j == 0)
            continue;
        to = &ring[(size_t)(q / r->width + 0.5)];
        to->n += twice;
        to->q += twice * q;
        to->c += twice * c;
        if (q < r->low || q > r->high)
            continue;
        to->fit_n += twice;
        to->fit_q += twice * q;
        to->fit_c += twice * c * (r->steep == 3 ? q * q * q : q * q);
    }
}

/* Number of parts of the spectrum, so few that their rings together are a fraction of its size. */
static size_t
parts_of(const struct rings *r)
{
    size_t most = rc_fourier_columns(&r->shape) * r->shape.ny / (4 * r->n);

    return most < 1 ? 1 : most < PARTS ? most : PARTS;
}

/* Sums each part of the spectrum into its own rings, then adds the parts in order. */
static enum rc_status
fill_rings(struct rings *r, const double *power, double factor, int threads, struct rc_err *err)
{
    size_t columns = rc_fourier_columns(&r->shape), parts = parts_of(r);

    r->ring = calloc(parts * r->n, sizeof *r->ring);
    if (r->ring == NULL)
        return rc_err_set(err, "out of memory for %zu rings of wave numbers", r->n);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (size_t part = 0; part < parts; part++)
        for (size_t k = columns * part / parts; k < columns * (part + 1) / parts; k++)
            add_column(r, power, k, factor, r->ring + part * r->n);
    for (size_t part = 1; part < parts; part++)
        for (size_t b = 0; b < r->n; b++) {
            struct ring *to = &r->ring[b];
            const struct ring *from = &r->ring[part * r->n + b];
            *to = (struct ring){to->n + from->n,         to->q + from->q,
                                to->c + from->c,         to->fit_n + from->fit_n,
                                to->fit_q + from->fit_q, to->fit_c + from->fit_c};
        }
    return RC_OK;
}

/* ---- the power law ---- */

/* Bins of the fit: log of c q^steep over log of q, its variance, and the range of wave numbers. */
struct bin {
    double x, y, variance, low, high;
};

/* ln(n) - psi(n): Abramowitz and Stegun 6.3.18, n >= 1. */
static double
log_bias(double n)
{
    return 1 / (2 * n) + 1 / (12 * n * n) - 1 / (120 * n * n * n * n);
}

/* psi'(n), 6.4.12. */
static double
log_variance(double n)
{
    return 1 / n + 1 / (2 * n * n) + 1 / (6 * n * n * n);
}

static size_t
make_bins(const struct rings *r, double alike, struct bin *bin)
{
    double share = 2 * alike, most = 0; /* share: number of waves per independent square */
    size_t bins = 0, b = 0;

    for (size_t k = 0; k < r->n; k++)
        most = r->ring[k].n > 0 ? fmax(most, r->ring[k].c / r->ring[k].n) : most;
    while (b < r->n) {
        double n = 0, q = 0, c = 0, end = INFINITY, low = 0, high = 0;
        for (; b < r->n && (double)b * r->width < end; b++) {
            const struct ring *ring = &r->ring[b];
            if (ring->fit_n == 0 || ring->c <= rounded * most * ring->n)
                continue;
            if (n == 0) {
                low = ring->fit_q / ring->fit_n;
                end = low * pow(10, 1.0 / PER_DECADE);
            }
            n += ring->fit_n;
            q += ring->fit_q;
            c += ring->fit_c;
            high = ring->fit_q / ring->fit_n;
        }
        if (n > 0) {
            double m = fmax(n / share, 1);
            bin[bins++] = (struct bin){.x = log(q / n),
                                       .y = log(c / n) + log_bias(m),
                                       .variance = log_variance(m) + model_error * model_error,
                                       .low = low,
                                       .high = high};
        }
    }
    return bins;
}

struct line {
    double w, x, y, xx, xy, yy; /* weighted sums */
};

static void
line_add(struct line *l, const struct bin *b)
{
    double w = 1 / b->variance;

    l->w += w;
    l->x += w * b->x;
    l->y += w * b->y;
    l->xx += w * b->x * b->x;
    l->xy += w * b->x * b->y;
    l->yy += w * b->y * b->y;
}

/* Slope; *left: the sum of squared misfits, each over its variance. */
static double
line_slope(const struct line *l, double *left)
{
    double sxx = l->xx - l->x * l->x / l->w, sxy = l->xy - l->x * l->y / l->w;
    double slope = sxy / sxx;

    *left = l->yy - l->y * l->y / l->w - slope * sxy;
    return slope;
}

/* c ~ q^(-2-2H) on maps, q^(-1-2H) on profiles. */
static double
hurst_of(const struct rings *r, double slope)
{
    return 0.5 * ((double)r->steep - slope - (r->steep == 3 ? 2 : 1));
}

/* Fits bins from .. to-1. */
static void
fit(const struct rings *r, const struct bin *bin, size_t from, size_t to, struct rc_psd *psd)
{
    struct line l = {0};
    double left;

    for (size_t b = from; b < to; b++)
        line_add(&l, &bin[b]);
    psd->hurst = hurst_of(r, line_slope(&l, &left));
    psd->hurst_error = 0.5 / sqrt(l.xx - l.x * l.x / l.w);
}

/* The bins that a power law fits best; from = to: none. */
static void
find_range(const struct rings *r, const struct bin *bin, size_t bins, size_t *from, size_t *to)
{
    double best = INFINITY;

    *from = *to = 0;
    for (size_t a = 0; a < bins; a++) {
        struct line l = {0};
        for (size_t b = a; b < bins; b++) {
            double left, cost, hurst;
            line_add(&l, &bin[b]);
            if (bin[b].high < span * bin[a].low || b < a + 3)
                continue;
            hurst = hurst_of(r, line_slope(&l, &left));
            cost = left + price * (double)(bins - (b + 1 - a));
            if (hurst < lowest || hurst > highest || left > fits * (double)(b - a - 1) ||
                cost >= best)
                continue;
            best = cost;
            *from = a;
            *to = b + 1;
        }
    }
}

static enum rc_status
fit_hurst(const struct rings *r, const struct rc_psd_options *options, double alike,
          struct rc_psd *psd, struct rc_err *err)
{
    bool told = options->shortest > 0;
    RC_OWNED struct bin *bin = malloc(r->n * sizeof *bin);
    size_t bins, from = 0, to;

    if (bin == NULL)
        return rc_err_set(err, "out of memory for %zu rings of wave numbers", r->n);
    to = bins = make_bins(r, alike, bin);
    if (!told)
        find_range(r, bin, bins, &from, &to);
    if (to > from + 1) {
        fit(r, bin, from, to, psd);
        psd->shortest = told ? options->shortest : 2 * RC_PI / bin[to - 1].high;
        psd->longest = told ? options->longest : 2 * RC_PI / bin[from].low;
    }
    if (told && bins < 2 && psd->c[0] > 0)
        return rc_err_set(err, "the map holds no two rings of waves from %g m to %g m",
                          options->shortest, options->longest);
    return RC_OK;
}

/* ---- results ---- */

static enum rc_status
list_rings(const struct rings *r, struct rc_psd *psd, struct rc_err *err)
{
    const struct rc_shape *s = &r->shape;
    struct rc_total sum = {0};

    psd->q = malloc(r->n * sizeof *psd->q);
    psd->c = malloc(r->n * sizeof *psd->c);
    psd->modes = malloc(r->n * sizeof *psd->modes);
    if (psd->q == NULL || psd->c == NULL || psd->modes == NULL)
        return rc_err_set(err, "out of memory for %zu rings of wave numbers", r->n);
    for (size_t b = 0; b < r->n; b++) {
        const struct ring *ring = &r->ring[b];
        if (ring->n == 0)
            continue;
        rc_total_add(&sum, ring->c);
        psd->q[psd->rings] = ring->q / ring->n;
        psd->c[psd->rings] = ring->c / ring->n;
        psd->modes[psd->rings++] = (size_t)ring->n;
    }
    psd->sum = rc_total_value(&sum) / (s->nx > 1 ? (double)s->nx * s->dx : 1) /
               (s->ny > 1 ? (double)s->ny * s->dy : 1);
    return RC_OK;
}

/* The whole plane, wave number 0 at node (nx/2, ny/2). */
static void
draw_map(const struct rc_shape *s, const double *power, double factor, double *map)
{
    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = 0; i < s->nx; i++) {
            size_t k = (i + s->nx - s->nx / 2) % s->nx, l = (j + s->ny - s->ny / 2) % s->ny;
            if (2 * k > s->nx) { /* the opposite wave is stored */
                k = s->nx - k;
                l = (s->ny - l) % s->ny;
            }
            map[j * s->nx + i] = k == 0 && l == 0 ? 0 : factor * power[k * s->ny + l];
        }
}

static enum rc_status
check(const struct rc_shape *s, const struct rc_psd_options *o, struct rc_err *err)
{
    if (rc_shape_check(s, err) != RC_OK)
        return RC_FAIL;
    if (s->nx * s->ny == 1)
        return rc_err_set(err, "a single node has no spectrum");
    if (window_of(o) == NULL)
        return rc_err_set(err, "no window is called %s: there are none, hann, hamming, blackman",
                          o->window);
    if ((o->shortest != 0 || o->longest != 0) &&
        !(o->shortest > 0 && o->longest > o->shortest && isfinite(o->longest)))
        return rc_err_set(err,
                          "wavelengths from %g m to %g m: the shortest comes first, both are "
                          "positive",
                          o->shortest, o->longest);
    return RC_OK;
}

/* The memory of the transforms is free again before the map is drawn. */
static enum rc_status
transform(const struct rc_windowed *w, const struct rc_psd_options *options, double *power,
          struct rc_err *err)
{
    enum rc_status status;

    if (options->map != NULL)
        rc_memory_lend();
    status = rc_power(w->shape, rc_windowed_row, w, options->threads, power, err);
    if (options->map != NULL)
        rc_memory_return(rc_memory_lent());
    return status;
}

static enum rc_status
make(const struct rc_shape *s, const double *h, const struct rc_psd_options *options, double *power,
     double *wx, struct rc_psd *psd, struct rc_err *err)
{
    const struct rc_window *window = window_of(options);
    struct rc_windowed w = {
        .shape = s, .h = h, .window = window, .boundary = options->boundary, .wx = wx};
    struct rings r = rings_of(s);
    enum rc_status status = RC_FAIL;
    double factor = 0, alike = 1;

    psd->window = window->name;
    r.low = leaked(window) * r.width;
    r.high = resolved * nyquist(s);
    if (options->shortest > 0) {
        r.low = (1 - slack) * 2 * RC_PI / options->longest;
        r.high = (1 + slack) * 2 * RC_PI / options->shortest;
    }
    if (options->shortest > 0 && r.high - r.low > 6 * spread(window) * r.width) {
        r.low += spread(window) * r.width;
        r.high -= spread(window) * r.width;
    }
    if (lay_window(&w, &factor, &psd->mean_square, &alike, err) == RC_OK &&
        transform(&w, options, power, err) == RC_OK &&
        fill_rings(&r, power, factor, rc_useful_threads(s, options->threads), err) == RC_OK &&
        list_rings(&r, psd, err) == RC_OK)
        status = fit_hurst(&r, options, alike, psd, err);
    if (status == RC_OK && options->map != NULL)
        draw_map(s, power, factor, options->map);
    free(r.ring);
    return status;
}

#define FIGURE(member) RC_FIGURE(struct rc_psd, member)
const struct rc_figure rc_figures_psd[] = {
    {FIGURE(hurst), NULL, "Hurst exponent"},
    {FIGURE(hurst_error), NULL, "Standard error of the Hurst exponent"},
    {RC_FIGURE_AS("psd_sum", struct rc_psd, sum), "m2", "Sum of the spectrum"},
    {FIGURE(mean_square), "m2", "Mean square of the heights"},
    {0},
};

struct rc_psd *
rc_psd_new(const struct rc_shape *shape, const double *h, const struct rc_psd_options *options,
           struct rc_err *err)
{
    RC_OWN(rc_psd, psd) = NULL;
    RC_OWNED double *wx = NULL;
    RC_OWNED double *power = NULL;

    if (check(shape, options, err) != RC_OK)
        return NULL;
    psd = calloc(1, sizeof *psd);
    power = rc_alloc(rc_fourier_size(shape), sizeof *power);
    wx = rc_alloc(shape->nx, sizeof *wx);
    if (psd == NULL || power == NULL || wx == NULL)
        return rc_err_null(err, "out of memory for the spectrum of %zu x %zu nodes", shape->nx,
                           shape->ny);
    psd->hurst = psd->hurst_error = psd->shortest = psd->longest = NAN;
    return make(shape, h, options, power, wx, psd, err) == RC_OK ? rc_give(&psd) : NULL;
}

void
rc_psd_free(struct rc_psd *psd)
{
    if (psd == NULL)
        return;
    free(psd->q);
    free(psd->c);
    free(psd->modes);
    free(psd);
}
