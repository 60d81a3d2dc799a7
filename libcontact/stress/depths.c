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
 *
 * In a coated body the stresses change over the thickness of a layer too, and jump at its sides.
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
/* Of a layer, and of what is just below an interface. */
static const double layer_part = 0.25, just_below = 1e-6;

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

static double
rounded(double z, int digits)
{
    double scale = pow(10, digits - 1 - floor(log10(z)));

    return round(z * scale) / scale;
}

/* ---- down through layers ---- */

struct descent {
    const struct rc_coating *coating; /* NULL: one material         */
    size_t layer;                     /* where z is                 */
    double bottom;                    /* m, of that layer           */
    double z;                         /* m                          */
    double *depths;
    size_t n;
};

static void
add(struct descent *d, double z)
{
    d->depths[d->n++] = z;
}

static bool
in_layer(const struct descent *d)
{
    return d->coating != NULL && d->layer < d->coating->layers;
}

/* Both sides of the interface below; false where nothing follows. */
static bool
cross(struct descent *d)
{
    const struct rc_coating *c = d->coating;
    double side = d->bottom, past;

    add(d, side);
    d->layer++;
    if (!in_layer(d) && isinf(c->e))
        return false;
    past = just_below * (in_layer(d) ? fmin(side, c->layer[d->layer].thickness) : side);
    d->z = rounded(side + past, 8);
    if (!(fabs(d->z - side - past) < 0.1 * past))
        d->z = side + past;
    add(d, d->z);
    if (in_layer(d))
        d->bottom += c->layer[d->layer].thickness;
    return true;
}

/* Three digits are enough, where they do not leave the layer or stand still. */
static bool
go_down(struct descent *d, double step)
{
    double z;

    if (in_layer(d)) {
        double thickness = d->coating->layer[d->layer].thickness;
        step = fmin(step, layer_part * thickness);
        if (d->z + step > d->bottom - layer_part / 4 * thickness)
            return cross(d);
    }
    d->z += step;
    z = rounded(d->z, 3);
    add(d, z > d->depths[d->n - 1] && !(in_layer(d) && z >= d->bottom) ? z : d->z);
    return true;
}

enum rc_status
rc_stress_depths(const struct rc_shape *shape, const double *p, enum rc_boundary boundary,
                 const struct rc_coating *coating, double **depths, size_t *n, struct rc_err *err)
{
    struct descent d = {.coating = coating};
    struct bins *b;
    double radius, all, left;

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
    d.depths = *depths;
    d.bottom = in_layer(&d) ? coating->layer[0].thickness : INFINITY;
    add(&d, 0);
    wave_number(b, 0, &all);
    while (d.n + 2 <= MOST && all > 0) {
        double q = wave_number(b, d.z, &left);
        if (boundary == RC_FREE)
            q = fmax(q, 1 / radius); /* the longest waves do not fit on the map */
        if (boundary == RC_FREE ? d.z >= radii * radius : left <= died * died * all)
            break;
        if (!go_down(&d, fmax(fmin(part * pow(all / left, 0.25), most_part) / q,
                              fmin(shape->dx, shape->dy) / 2)))
            break;
    }
    *n = d.n;
    free(b);
    return RC_OK;
}
