/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Random surfaces whose heights are not Gaussian.
 *
 * Replacing heights by those of the wanted distribution, in the same order, changes the spectrum of the
 * surface. Correcting the amplitude of each wave changes the heights. Alternating both approaches a surface
 * with both properties (Schreiber and Schmitz 1996, Phys. Rev. Lett. 77, 635; for rough surfaces Perez-Rafols
 * and Almqvist 2019, Tribol. Int. 131, 591). The last step corrects the heights, so their distribution is
 * exact.
 */
#include "synth.h"

#include <complex.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_spline.h>
#include <math.h>

#include "handler.h"
#include "libcontact/memory.h"
#include "libcontact/transform/transform.h"

enum {
    TABLE = 2049,     /* quantiles that are computed; a spline interpolates them */
    CLASSES = 1 << 16 /* number of classes of heights; ranks are interpolated within a class */
};

bool
rc_heights_skewed(const struct rc_selfaffine *what)
{
    return what->skewness != 0 || what->weibull != 0;
}

enum rc_status
rc_heights_check(const struct rc_selfaffine *what, struct rc_err *err)
{
    if (what->skewness != 0 && what->weibull != 0)
        return rc_err_set(err, "a skewness and a Weibull distribution: give one of them");
    if (!(fabs(what->skewness) <= RC_SKEWNESS_MAX))
        return rc_err_set(err, "skewness %g: it must be from -%g to %g", what->skewness,
                          RC_SKEWNESS_MAX, RC_SKEWNESS_MAX);
    if (what->weibull != 0 && !(what->weibull >= RC_WEIBULL_MIN && what->weibull <= RC_WEIBULL_MAX))
        return rc_err_set(err, "Weibull shape %g: it must be from %g to %g", what->weibull,
                          RC_WEIBULL_MIN, RC_WEIBULL_MAX);
    return RC_OK;
}

/* ---- the distribution ---- */

/* Heights as a function of the normal score z. The fraction of all heights below such a height equals the
 * fraction of the normal distribution below z. */
struct quantiles {
    gsl_spline *spline;
    gsl_interp_accel *near;
};

static double
quantile(const struct rc_selfaffine *what, double z)
{
    double below = gsl_cdf_ugaussian_P(z), above = gsl_cdf_ugaussian_Q(z);
    double shape = 4 / (what->skewness * what->skewness); /* shape of the gamma distribution */

    if (what->weibull != 0)
        return z < 0 ? gsl_cdf_weibull_Pinv(below, 1, what->weibull)
                     : gsl_cdf_weibull_Qinv(above, 1, what->weibull);
    if (what->skewness > 0)
        return z < 0 ? gsl_cdf_gamma_Pinv(below, shape, 1) : gsl_cdf_gamma_Qinv(above, shape, 1);
    return z < 0 ? -gsl_cdf_gamma_Qinv(below, shape, 1) : -gsl_cdf_gamma_Pinv(above, shape, 1);
}

static void
quantiles_free(struct quantiles *q)
{
    if (q->spline != NULL)
        gsl_spline_free(q->spline);
    if (q->near != NULL)
        gsl_interp_accel_free(q->near);
}

/* Quantiles for n heights: the lowest one has the probability 1/(2 n). */
static enum rc_status
quantiles_new(const struct rc_selfaffine *what, size_t n, struct quantiles *q, struct rc_err *err)
{
    double end = -gsl_cdf_ugaussian_Pinv(0.5 / (double)n) + 1e-6, z[TABLE], v[TABLE];

    for (int k = 0; k < TABLE; k++) {
        z[k] = end * (2.0 * k / (TABLE - 1) - 1);
        v[k] = quantile(what, z[k]);
        if (!isfinite(v[k]))
            return rc_err_set(err, "no quantile of the heights at %g of a standard deviation",
                              z[k]);
    }
    q->spline = gsl_spline_alloc(gsl_interp_cspline, TABLE);
    q->near = gsl_interp_accel_alloc();
    if (q->spline == NULL || q->near == NULL || gsl_spline_init(q->spline, z, v, TABLE) != 0)
        return rc_err_set(err, "out of memory for %d quantiles", TABLE);
    return RC_OK;
}

/* The height below which this fraction of all heights lies. */
static double
quantiles_at(const struct quantiles *q, double below)
{
    return gsl_spline_eval(q->spline, gsl_cdf_ugaussian_Pinv(below), q->near);
}

/* ---- heights ---- */

static void
extremes(const double *h, size_t n, double *low, double *high)
{
    *low = *high = h[0];
    for (size_t k = 1; k < n; k++) {
        *low = h[k] < *low ? h[k] : *low;
        *high = h[k] > *high ? h[k] : *high;
    }
}

/* Mean 0 and RMS 1. */
static void
standardise(double *h, size_t n)
{
    struct rc_shape line = {.nx = n, .ny = 1, .dx = 1, .dy = 1};
    struct rc_statistics st;

    rc_measure(&line, h, &st);
    for (size_t k = 0; k < n; k++)
        h[k] = (h[k] - st.mean) / st.rms;
}

/* Classes of heights: the lowest height of class c becomes first[c], the highest last[c]. */
struct classes {
    double low, per_height; /* class of h: (h - low) * per_height */
    size_t n;
    size_t *count;
    double *first, *last;
};

static size_t
class_of(const struct classes *c, double h, double *part)
{
    double at = (h - c->low) * c->per_height;
    size_t k = at < (double)c->n ? (size_t)at : c->n - 1;

    *part = at - (double)k;
    return k;
}

/* Replaces each height by the quantile of its rank. Ranks are exact in classes with one height; in other
 * classes heights are assumed evenly spaced. */
static void
set_heights(const struct quantiles *q, struct classes *c, double *h, size_t n)
{
    double high, part;
    size_t below = 0;

    extremes(h, n, &c->low, &high);
    c->per_height = high > c->low ? (double)c->n / (high - c->low) : 0;
    for (size_t k = 0; k < c->n; k++)
        c->count[k] = 0;
    for (size_t k = 0; k < n; k++)
        c->count[class_of(c, h[k], &part)]++;
    for (size_t k = 0; k < c->n; k++) {
        if (c->count[k] == 0)
            continue;
        c->first[k] = quantiles_at(q, ((double)below + 0.5) / (double)n);
        below += c->count[k];
        c->last[k] = quantiles_at(q, ((double)below - 0.5) / (double)n);
    }
    for (size_t k = 0; k < n; k++) {
        size_t a = class_of(c, h[k], &part);

        h[k] = c->first[a] + (c->last[a] - c->first[a]) * part;
    }
    standardise(h, n);
}

/* ---- waves ---- */

/* A wave of this column also counts for its conjugate, which is not stored. The first column and, for an even
 * number of nodes, the last are stored in full. */
static double
counted(const struct rc_shape *shape, size_t column)
{
    return column == 0 || 2 * column == shape->nx ? 1 : 2;
}

/* RMS error of the amplitudes over the RMS of the wanted ones. */
static double
misfit_of(const struct rc_shape *shape, const double complex *s, const double *amplitude)
{
    size_t columns = rc_fourier_columns(shape);
    double off = 0, whole = 0;

    for (size_t j = 0; j < shape->ny; j++) {
        double row_off = 0, row_whole = 0; /* summed row by row to keep digits */

        for (size_t i = 0; i < columns; i++) {
            double a = amplitude[j * columns + i], d = cabs(s[j * columns + i]) - a;

            row_off += counted(shape, i) * d * d;
            row_whole += counted(shape, i) * a * a;
        }
        off += row_off;
        whole += row_whole;
    }
    return sqrt(off / whole);
}

static void
set_amplitudes(double complex *s, const double *amplitude, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        double a = cabs(s[k]);

        s[k] = a > 0 ? s[k] * (amplitude[k] / a) : amplitude[k];
    }
}

/* Alternates between correcting heights and amplitudes; begins and ends with heights. */
static enum rc_status
alternate(const struct rc_shape *shape, const struct quantiles *q, struct classes *c, size_t steps,
          double *amplitude, double complex *s, double *h, double *misfit, struct rc_err *err)
{
    size_t n = shape->nx * shape->ny, waves = rc_fourier_size(shape);

    standardise(h, n);
    if (rc_fourier_forward(shape, h, s, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < waves; k++)
        amplitude[k] = cabs(s[k]);
    set_heights(q, c, h, n);
    for (size_t k = 0; k < steps; k++) {
        if (rc_fourier_forward(shape, h, s, err) != RC_OK)
            return RC_FAIL;
        set_amplitudes(s, amplitude, waves);
        if (rc_fourier_backward(shape, s, h, err) != RC_OK)
            return RC_FAIL;
        set_heights(q, c, h, n);
    }
    if (rc_fourier_forward(shape, h, s, err) != RC_OK)
        return RC_FAIL;
    *misfit = misfit_of(shape, s, amplitude);
    return RC_OK;
}

enum rc_status
rc_heights_shape(const struct rc_shape *shape, const struct rc_selfaffine *what, size_t steps,
                 double *h, double *misfit, struct rc_err *err)
{
    size_t n = shape->nx * shape->ny, waves = rc_fourier_size(shape);
    RC_ENDS(quantiles_free) struct quantiles q = {0};
    struct classes c = {.n = n < CLASSES ? n : CLASSES};
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    double *amplitude = rc_store_take(&own, waves, sizeof *amplitude);
    double complex *s = rc_store_take(&own, waves, sizeof *s);
    enum rc_status status = RC_FAIL;

    c.count = rc_store_take(&own, c.n, sizeof *c.count);
    c.first = rc_store_take(&own, c.n, sizeof *c.first);
    c.last = rc_store_take(&own, c.n, sizeof *c.last);
    if (own.failed)
        return rc_err_set(err, "out of memory for %zu waves and %zu classes of heights", waves,
                          c.n);
    rc_handler_begin();
    if (quantiles_new(what, n, &q, err) == RC_OK)
        status = alternate(shape, &q, &c, steps, amplitude, s, h, misfit, err);
    rc_handler_end();
    return status;
}
