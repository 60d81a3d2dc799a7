/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Chooses the depths of stress maps from the pressure.
 *
 * A pressure wave of wave number q has the amplitude (1 + q z) exp(-q z) at the depth z, so the stress there
 * varies over a length 1/k,
 *
 *     k(z)^2 = sum of q^2 w^2 |p_q|^2 / sum of w^2 |p_q|^2,      w = (1 + q z) exp(-q z):
 *
 * near the surface the scale of roughness, deep down that of the whole contact. Linear interpolation between
 * two depths dz apart has an error of (k dz)^2 / 8 of the remaining waves. So each step is a fixed fraction
 * of 1/k, larger where the waves are weaker. On a free half-space the last depth is three radii of the
 * Hertzian contact with the same second moment. If one axis repeats, it is six half-widths of the roller's
 * contact with the same second moment: in both cases a quarter of the largest shear stress is left. On a
 * periodic map it is where the waves have decayed.
 *
 * In a layered body the stresses also vary over the thickness of a layer, and jump at its interfaces.
 */
#include "libcontact/contact.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "libcontact/memory.h"
#include "libcontact/operator/operator.h"
#include "libcontact/operator/waves.h"

enum {
    BINS = 400, /* bins of wave numbers, equal on a logarithmic scale */
    MOST = 2000 /* depths                                        */
};

/* With a quarter of 1/k the largest Mises stress of Hertz's contact is accurate to 1 %. Half and double
 * of `part` change the largest Mises stress of 4 contacts by up to 0.8 and 3 % (bench/constants.py). */
static const double part = 0.25, most_part = 0.75, radii = 3, half_widths = 6, died = 0.01;
/* Shares of a layer's thickness: largest step; distance of the depth just below an interface. */
static const double layer_part = 0.25, just_below = 1e-6;

struct bins {
    double q[BINS], power[BINS];
};

/* ---- waves ---- */

struct scan {
    const struct rc_shape *s;
    struct bins *b;
    double low, step; /* lowest q of the bins, and their step of log q */
};

static struct scan
scan_of(const struct rc_shape *s, struct bins *b)
{
    static const double two_pi = 6.28318530717958647692;
    double high = two_pi / fmin(s->dx, s->dy);
    struct scan c = {
        .s = s, .b = b, .low = two_pi / (2 * fmax((double)s->nx * s->dx, (double)s->ny * s->dy))};

    c.step = log(high / c.low) / BINS;
    for (int k = 0; k < BINS; k++) {
        b->q[k] = c.low * exp((k + 0.5) * c.step);
        b->power[k] = 0;
    }
    return c;
}

/* Adds the power of wave i along x and j along y; the mean is left out. */
static void
collect_wave(struct scan *c, size_t i, size_t j, double power)
{
    double q = hypot(rc_fourier_q(i, c->s->nx, c->s->dx), rc_fourier_q(j, c->s->ny, c->s->dy));
    int k = q > 0 ? (int)(log(q / c->low) / c->step) : -1;

    if (q > 0) /* columns between the first and the last count twice */
        c->b->power[k < 0      ? 0
                    : k < BINS ? k
                               : BINS - 1] += (i == 0 || 2 * i == c->s->nx ? 1 : 2) * power;
}

/* Sums |p_q|^2 over bins of q. */
static enum rc_status
collect(const struct rc_shape *s, const double *p, struct bins *b, struct rc_err *err)
{
    size_t columns = rc_fourier_columns(s);
    RC_OWNED double complex *wave = malloc(rc_fourier_size(s) * sizeof *wave);
    struct scan c = scan_of(s, b);

    if (wave == NULL)
        return rc_err_set(err, "out of memory for the waves of %zu x %zu nodes", s->nx, s->ny);
    if (rc_fourier_forward(s, p, wave, err) != RC_OK)
        return RC_FAIL;
    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = 0; i < columns; i++) {
            double a = cabs(wave[j * columns + i]);
            collect_wave(&c, i, j, a * a);
        }
    return RC_OK;
}

/* ---- waves of a map that ranks share ---- */

static void
collect_amplitude(void *scan, size_t i, size_t j, double amplitude)
{
    collect_wave(scan, i, j, amplitude * amplitude);
}

static enum rc_status
collect_shared(const struct rc_ranks *ranks, const struct rc_shape *s, const double *p,
               struct bins *b, struct rc_err *err)
{
    const size_t count = rc_ranks_count(ranks);
    struct scan c = scan_of(s, b);
    RC_OWNED double *power = malloc(count * sizeof b->power);

    if (rc_ranks_need(ranks, power != NULL, err, "out of memory for the waves of %zu x %zu nodes",
                      s->nx, s->ny) != RC_OK ||
        rc_waves_visit(ranks, s, p, collect_amplitude, &c, err) != RC_OK)
        return RC_FAIL;
    rc_ranks_gather(ranks, sizeof b->power, b->power, power);
    for (int k = 0; k < BINS; k++) {
        b->power[k] = 0;
        for (size_t q = 0; q < count; q++)
            b->power[k] += power[q * BINS + (size_t)k];
    }
    return RC_OK;
}

/* ---- scales ---- */

/* k(z) as above, and the squared fraction of the waves that remains at that depth. */
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

/* Radius of the Hertzian contact with the same second moment, 2 a^2 / 5; if one axis repeats, half of
 * the width of the roller's contact with the same second moment along the other, a^2 / 4. */
static double
contact_radius(const struct rc_ranks *ranks, const struct rc_shape *s, struct rc_boundary boundary,
               const double *p)
{
    const double along_x = boundary.x ? 0 : 1, along_y = boundary.y ? 0 : 1;
    const double shape = rc_repeats(boundary) == 0 ? 2.5 : 4;
    struct rc_rows rows = rc_rows_of(ranks, s);
    double total[3] = {0}, second, cx, cy;
    struct rc_total sum[3] = {{0}}, r2 = {0};

    for (size_t k = 0; k < s->nx * rows.n; k++) {
        double weight = fabs(p[k]);
        rc_total_add(&sum[0], weight);
        rc_total_add(&sum[1], weight * (double)(k % s->nx) * s->dx);
        rc_total_add(&sum[2], weight * (double)(rows.first + k / s->nx) * s->dy);
    }
    rc_ranks_totals(ranks, 3, sum, total, 0, NULL);
    if (!(total[0] > 0))
        return 0;
    cx = total[1] / total[0];
    cy = total[2] / total[0];
    for (size_t k = 0; k < s->nx * rows.n; k++) {
        double u = (double)(k % s->nx) * s->dx - cx;
        double v = (double)(rows.first + k / s->nx) * s->dy - cy;
        rc_total_add(&r2, fabs(p[k]) * (along_x * u * u + along_y * v * v));
    }
    second = rc_ranks_total(ranks, r2);
    /* at least that of a single cell */
    return sqrt(shape *
                (second / total[0] + (along_x * s->dx * s->dx + along_y * s->dy * s->dy) / 12));
}

static double
rounded(double z, int digits)
{
    double scale = pow(10, digits - 1 - floor(log10(z)));

    return round(z * scale) / scale;
}

/* ---- down through layers ---- */

struct descent {
    const struct rc_body *body;
    size_t layer;  /* the layer that contains z */
    double bottom; /* m, of that layer          */
    double z;      /* m                         */
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
    return d->layer < d->body->layers;
}

/* Adds both sides of the interface below; false where none follows. */
static bool
cross(struct descent *d)
{
    const struct rc_body *c = d->body;
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

/* Rounds to three digits, unless that leaves the layer or gives no step. */
static bool
go_down(struct descent *d, double step)
{
    double z;

    if (in_layer(d)) {
        double thickness = d->body->layer[d->layer].thickness;
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
rc_stress_depths(const struct rc_ranks *ranks, const struct rc_shape *shape, const double *p,
                 struct rc_boundary boundary, const struct rc_body *body, double **depths,
                 size_t *n, struct rc_err *err)
{
    const bool open = rc_has_mean(boundary);
    const double last = rc_repeats(boundary) == 0 ? radii : half_widths;
    struct descent d = {.body = body};
    RC_OWNED struct bins *b = malloc(sizeof *b);
    RC_OWNED double *found = malloc(MOST * sizeof *found);
    double radius, all, left;

    *depths = NULL;
    *n = 0;
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    if (rc_ranks_need(ranks, b != NULL && found != NULL, err, "out of memory for depths") !=
            RC_OK ||
        (rc_ranks_count(ranks) > 1 ? collect_shared(ranks, shape, p, b, err)
                                   : collect(shape, p, b, err)) != RC_OK)
        return RC_FAIL;
    radius = contact_radius(ranks, shape, boundary, p);
    d.depths = found;
    d.bottom = in_layer(&d) ? body->layer[0].thickness : INFINITY;
    add(&d, 0);
    wave_number(b, 0, &all);
    while (d.n + 2 <= MOST && all > 0) {
        double q = wave_number(b, d.z, &left);
        if (open)
            q = fmax(q, 1 / radius); /* the longest waves are longer than the map */
        if (open ? d.z >= last * radius : left <= died * died * all)
            break;
        if (!go_down(&d, fmax(fmin(part * pow(all / left, 0.25), most_part) / q,
                              fmin(shape->dx, shape->dy) / 2)))
            break;
    }
    *n = d.n;
    *depths = rc_give(&found);
    return RC_OK;
}
