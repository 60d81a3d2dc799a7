/*
 * Depths at which to look, chosen from the pressure itself.
 *
 * A wave of pressure of wave number q is felt at the depth z as (1 + q z) exp(-q z), so the stress
 * there changes over the inverse of
 *
 *     k(z)^2 = sum of q^2 w^2 |p_q|^2 / sum of w^2 |p_q|^2,      w = (1 + q z) exp(-q z):
 *
 * near the surface the scale of roughness, deep down that of the whole contact. A straight line
 * between two depths dz apart errs by (k dz)^2 / 8 of what is left of the waves: each step is a
 * fixed part of 1/k, more where less is left. The last depth of a contact on a free half-space is
 * three radii of the Hertzian contact that is as spread out; on a periodic map it is where the
 * waves have died away.
 */
#include "libcontact/contact.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "libcontact/operator/operator.h"

enum {
    BINS = 400, /* of wave numbers, equal on a logarithmic scale */
    MOST = 2000 /* depths                                        */
};

/* A quarter of the scale leaves the largest Mises stress of Hertz's contact within 1 %. */
static const double part = 0.25, most_part = 0.75, radii = 3, died = 0.01;

struct bins {
    double q[BINS], power[BINS];
};

/* Sums |p_q|^2 over bins of q; the mean is left out. */
static enum rc_status
collect(const struct rc_shape *s, const double *p, struct bins *b, struct rc_err *err)
{
    static const double two_pi = 6.28318530717958647692;
    size_t columns = rc_fourier_columns(s);
    double complex *wave = malloc(rc_fourier_size(s) * sizeof *wave);
    double low = two_pi / (2 * fmax((double)s->nx * s->dx, (double)s->ny * s->dy));
    double high = two_pi / fmin(s->dx, s->dy), step = log(high / low) / BINS;

    if (wave == NULL)
        return rc_err_set(err, "out of memory for the waves of %zu x %zu nodes", s->nx, s->ny);
    if (rc_fourier_forward(s, p, wave, err) != RC_OK) {
        free(wave);
        return RC_FAIL;
    }
    for (int k = 0; k < BINS; k++) {
        b->q[k] = low * exp((k + 0.5) * step);
        b->power[k] = 0;
    }
    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = 0; i < columns; i++) {
            double qx = rc_fourier_q(i, s->nx, s->dx);
            double qy = rc_fourier_q(j, s->ny, s->dy);
            double q = hypot(qx, qy), a = cabs(wave[j * columns + i]);
            int k = q > 0 ? (int)(log(q / low) / step) : -1;
            if (q > 0) /* columns between the first and the last stand for two */
                b->power[k < 0      ? 0
                         : k < BINS ? k
                                    : BINS - 1] += (i == 0 || 2 * i == s->nx ? 1 : 2) * a * a;
        }
    free(wave);
    return RC_OK;
}

/* k(z) of above, and what is left of the waves at that depth, squared. */
static double
wave_number(const struct bins *b, double z, double *left)
{
    double above = 0, below = 0;

    for (int k = 0; k < BINS; k++) {
        double w = (1 + b->q[k] * z) * exp(-b->q[k] * z);
        below += w * w * b->power[k];
        above += w * w * b->power[k] * b->q[k] * b->q[k];
    }
    *left = below;
    return below > 0 ? sqrt(above / below) : 0;
}

/* Radius of the Hertzian contact with the same second moment, 2 a^2 / 5. */
static double
contact_radius(const struct rc_shape *s, const double *p)
{
    double sum = 0, x = 0, y = 0, r2 = 0;

    for (int pass = 0; pass < 2; pass++) {
        double cx = pass == 0 ? 0 : x / sum, cy = pass == 0 ? 0 : y / sum;
        for (size_t k = 0; k < s->nx * s->ny; k++) {
            double u = (double)(k % s->nx) * s->dx - cx, v = (double)(k / s->nx) * s->dy - cy;
            double weight = fabs(p[k]);
            if (pass == 0) {
                sum += weight;
                x += weight * u;
                y += weight * v;
            } else {
                r2 += weight * (u * u + v * v);
            }
        }
        if (!(sum > 0))
            return 0;
    }
    /* at least that of a single cell */
    return sqrt(2.5 * (r2 / sum + (s->dx * s->dx + s->dy * s->dy) / 12));
}

/* Three digits are enough to choose a depth by. */
static double
rounded(double z)
{
    double scale = pow(10, 2 - floor(log10(z)));

    return round(z * scale) / scale;
}

enum rc_status
rc_stress_depths(const struct rc_shape *shape, const double *p, enum rc_boundary boundary,
                 double **depths, size_t *n, struct rc_err *err)
{
    struct bins *b;
    double radius, all, left, z = 0;

    *depths = NULL;
    *n = 0;
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    b = malloc(sizeof *b);
    *depths = malloc(MOST * sizeof **depths);
    if (b == NULL || *depths == NULL) {
        free(b);
        return rc_err_set(err, "out of memory for depths");
    }
    if (collect(shape, p, b, err) != RC_OK) {
        free(b);
        return RC_FAIL;
    }
    radius = contact_radius(shape, p);
    (*depths)[(*n)++] = 0;
    wave_number(b, 0, &all);
    for (size_t k = 1; k < MOST && all > 0; k++) {
        double q = wave_number(b, z, &left);
        if (boundary == RC_FREE)
            q = fmax(q, 1 / radius); /* the longest waves do not fit on the map */
        if (boundary == RC_FREE ? z >= radii * radius : left <= died * died * all)
            break;
        z +=
            fmax(fmin(part * pow(all / left, 0.25), most_part) / q, fmin(shape->dx, shape->dy) / 2);
        (*depths)[(*n)++] = rounded(z);
    }
    free(b);
    return RC_OK;
}
