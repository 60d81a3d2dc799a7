/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Correlation length and direction of the texture.
 *
 * The autocorrelation is the mean product of two heights at an offset, over Sq^2, for offsets up to half the
 * map. The mean is over the pairs in the map (circular when it is periodic). Sal is the shortest offset at
 * which the correlation has fallen to 0.2; Str is Sal over the longest one. Both are found along rays from 0,
 * a node at a time.
 *
 * The direction is the maximum of the angular spectrum, to which each wave contributes its power, spread over
 * the angles up to its neighbours.
 */
#include "areal.h"

#include <stdlib.h>

#include "libcontact/memory.h"
#include "libcontact/transform/transform.h"

/* The autocorrelation of Sal and Str (ISO 25178-2, default 0.2), and the rounding of it. */
static const double fallen = 0.2, rounded = 1e-9;
/* The largest angle over which the power of a wave is spread, to either side, radians. */
static const double widest = 0.05;

enum {
    FEWEST = 180, /* rays in half a turn                                            */
    MOST = 3600,
    ANGLES = 720, /* bins of the angular spectrum in half a turn */
    PARTS = 64,   /* parts of the spectrum that are summed separately */
    WEDGE = 6     /* bins on either side of the maximum that belong to it */
};

/* ---- rows for the transform ---- */

static void
height_row(const void *of, size_t j, double *row)
{
    const struct rc_relief *r = of;
    const double *h = r->h + j * r->shape.nx;

    for (size_t i = 0; i < r->shape.nx; i++)
        row[i] = rc_there(h[i]) ? h[i] - r->mean : 0;
}

static void
there_row(const void *of, size_t j, double *row)
{
    const struct rc_relief *r = of;

    for (size_t i = 0; i < r->shape.nx; i++)
        row[i] = rc_there(r->h[j * r->shape.nx + i]) ? 1 : 0;
}

/* ---- autocorrelation ---- */

static struct rc_offsets
offsets_of(const struct rc_shape *s, struct rc_boundary boundary)
{
    struct rc_offsets at = {.px = s->nx, .py = s->ny, .mx = s->nx / 2, .my = s->ny / 2};

    if (!boundary.x)
        at.px = rc_fourier_length((at.px + at.mx + 1) / 2, 1);
    if (!boundary.y)
        at.py = rc_fourier_length((at.py + at.my + 1) / 2, 1);
    return at;
}

static size_t
sums_of(const struct rc_offsets *at)
{
    return (2 * at->mx + 1) * (at->my + 1);
}

/* Number of pairs of nodes that are (x, y) nodes apart on a map without missing points. */
static double
all_pairs(const struct rc_relief *r, const struct rc_offsets *at, size_t i, size_t j)
{
    size_t x = i > at->mx ? i - at->mx : at->mx - i;

    return (double)((r->shape.nx - (r->boundary.x ? 0 : x)) *
                    (r->shape.ny - (r->boundary.y ? 0 : j)));
}

/* Correlations, 1 at offset 0 and NAN where there is no pair; (2 mx + 1) (my + 1) of them. NULL on failure:
 * *err says why. */
static double *
correlations(const struct rc_relief *r, const struct rc_offsets *at, double sq, struct rc_err *err)
{
    size_t n = sums_of(at), width = 2 * at->mx + 1, threads = (size_t)r->threads;
    bool whole = r->there == r->shape.nx * r->shape.ny;
    RC_OWNED double *pairs = whole ? NULL : rc_alloc(n, sizeof *pairs);
    RC_OWNED double *sum = rc_alloc(n, sizeof *sum);

    if (sum == NULL || (!whole && pairs == NULL))
        return rc_err_null(err, "out of memory for the autocorrelation of %zu x %zu nodes",
                           r->shape.nx, r->shape.ny);
    if (rc_autocorrelate(&r->shape, at, height_row, r, threads, sum, err) != RC_OK)
        return NULL;
    if (!whole && rc_autocorrelate(&r->shape, at, there_row, r, threads, pairs, err) != RC_OK)
        return NULL;
#pragma omp parallel for num_threads(r->threads) schedule(static)
    for (size_t j = 0; j <= at->my; j++)
        for (size_t i = 0; i < width; i++) {
            size_t k = j * width + i;
            double count = whole ? all_pairs(r, at, i, j) : floor(pairs[k] + 0.5);
            sum[k] = count > 0 ? sum[k] / (count * sq * sq) : NAN;
        }
    return rc_give(&sum);
}

/* The correlation at whole offsets; NAN beyond the stored ones. */
static double
correlation_of(const double *c, const struct rc_offsets *at, double x, double y)
{
    if (y < 0) {
        x = -x;
        y = -y;
    }
    if (fabs(x) > (double)at->mx || y > (double)at->my)
        return NAN;
    return c[(size_t)y * (2 * at->mx + 1) + (size_t)(x + (double)at->mx)];
}

/* The correlation at the offset (x, y) in nodes; x or y is a whole number. A cubic goes through four values
 * along the other direction, because linear interpolation would give the smooth maximum a kink. It is linear
 * where the outer two of the four are missing. */
static double
correlation_at(const double *c, const struct rc_offsets *at, double x, double y)
{
    double fx = floor(x), fy = floor(y), t = x > fx ? x - fx : y - fy;
    double sx = x > fx ? 1 : 0, sy = x > fx ? 0 : 1, a, d, v[4];

    v[1] = correlation_of(c, at, fx, fy);
    if (t == 0)
        return v[1];
    v[0] = correlation_of(c, at, fx - sx, fy - sy);
    v[2] = correlation_of(c, at, fx + sx, fy + sy);
    v[3] = correlation_of(c, at, fx + 2 * sx, fy + 2 * sy);
    a = v[0] - 2 * v[1] + v[2];
    d = v[1] - 2 * v[2] + v[3];
    if (isnan(a) || isnan(d))
        a = d = 0;
    return v[1] + t * (v[2] - v[1]) - t * (1 - t) * ((2 - t) * a + (1 + t) * d) / 6;
}

/* The offset at which the correlation first falls to 0.2 along this angle, m; NAN: nowhere on the map. */
static double
falls_at(const double *c, const struct rc_offsets *at, const struct rc_shape *s, double angle)
{
    double x = cos(angle) / s->dx, y = sin(angle) / s->dy; /* nodes per metre */
    bool along_x = fabs(x) >= fabs(y);
    double step = 1 / (along_x ? fabs(x) : fabs(y)), before = 1;
    size_t most = along_x ? at->mx : at->my;

    for (size_t k = 1; k <= most; k++) {
        double r = (double)k * step, whole = (double)k, other = r * (along_x ? y : x), here;
        if (fabs(other - round(other)) < rounded)
            other = round(other); /* along a side, or a diagonal */
        if (fabs(other) > (double)(along_x ? at->my : at->mx))
            break;
        here = along_x ? correlation_at(c, at, x < 0 ? -whole : whole, other)
                       : correlation_at(c, at, other, whole);
        if (isnan(here))
            break;
        if (here <= fallen)
            return r - step * (fallen - here) / (before - here);
        before = here;
    }
    return NAN;
}

static void
measure_lengths(const struct rc_relief *r, const struct rc_offsets *at, const double *c,
                struct rc_areal *a)
{
    bool profile = r->shape.nx == 1 || r->shape.ny == 1, all = true;
    size_t rays = 4 * (at->mx + at->my);
    double nearest = INFINITY, farthest = 0;

    rays = rays < FEWEST ? FEWEST : rays > MOST ? MOST : rays / 4 * 4;
    if (profile)
        rays = 2;
#pragma omp parallel for num_threads(r->threads) schedule(dynamic, 16)                             \
    reduction(min : nearest) reduction(max : farthest) reduction(&& : all)
    for (size_t k = 0; k < rays; k++) {
        double fall = falls_at(c, at, &r->shape, RC_PI * (double)k / (double)rays);
        all = all && !isnan(fall);
        nearest = fall < nearest ? fall : nearest;
        farthest = fall > farthest ? fall : farthest;
    }
    if (isfinite(nearest))
        a->sal = nearest;
    if (all && !profile)
        a->str = nearest / farthest;
}

/* ---- direction ---- */

/* Wave number of a wave of the stored half plane, y up the picture. Returns 2 if the wave also stands for its
 * opposite, else 1. */
static inline double
wave_of(const struct rc_shape *s, size_t k, size_t j, double *qx, double *qy)
{
    *qx = rc_fourier_q(k, s->nx, s->dx);
    *qy = -rc_fourier_q(j, s->ny, s->dy);
    return k == 0 || 2 * k == s->nx ? 1 : 2;
}

/* Area below u of a triangle of area 1 over -1 .. 1. */
static double
triangle_below(double u)
{
    double rest = u < 0 ? 1 + u : 1 - u;

    return rest < 0 ? (u < 0 ? 0 : 1) : u < 0 ? rest * rest / 2 : 1 - rest * rest / 2;
}

/* Spreads a wave's power over the angles around its own, as a triangle. */
static void
add_power(double *bin, double angle, double half_width, double power)
{
    double middle = angle * ANGLES / RC_PI, half = half_width * ANGLES / RC_PI, below = 0;

    for (long b = (long)floor(middle - half); (double)b < middle + half; b++) {
        double up_to = triangle_below(((double)b + 1 - middle) / half);
        bin[(size_t)(b + 4 * ANGLES) % ANGLES] += power * (up_to - below);
        below = up_to;
    }
}

/* Sums over the columns of one part. With `toward` NAN, writes the angular spectrum into sum[ANGLES].
 * Otherwise writes cos and sin of twice the angle, weighted with power, within the wedge around that
 * angle. */
static void
sum_part(const struct rc_shape *s, const double *power, size_t part, double toward, double wedge,
         double *sum)
{
    size_t columns = rc_fourier_columns(s), ny = s->ny;
    double cell = sqrt(rc_fourier_q(1, s->nx, s->dx) * rc_fourier_q(1, s->ny, s->dy));
    double ux = cos(toward), uy = sin(toward), slope = tan(wedge);

    for (size_t k = columns * part / PARTS; k < columns * (part + 1) / PARTS; k++)
        for (size_t j = 0; j < ny; j++) {
            double qx, qy, p = power[k * ny + j] * wave_of(s, k, j, &qx, &qy);
            double q2 = qx * qx + qy * qy;
            if (q2 == 0 || p == 0)
                continue;
            if (isnan(toward))
                add_power(sum, atan2(qy, qx), fmin(cell / sqrt(q2), widest), p);
            else if (fabs(qy * ux - qx * uy) <= slope * fabs(qx * ux + qy * uy)) {
                sum[0] += p * (qx * qx - qy * qy) / q2;
                sum[1] += p * 2 * qx * qy / q2;
                sum[2] += p * sqrt(q2);
                sum[3] += p;
            }
        }
}

static void
sum_parts(const struct rc_relief *r, const double *power, double toward, double wedge,
          double (*sums)[ANGLES])
{
#pragma omp parallel for num_threads(r->threads) schedule(dynamic)
    for (size_t part = 0; part < PARTS; part++) {
        for (size_t b = 0; b < ANGLES; b++)
            sums[part][b] = 0;
        sum_part(&r->shape, power, part, toward, wedge, sums[part]);
    }
    for (size_t part = 1; part < PARTS; part++)
        for (size_t b = 0; b < ANGLES; b++)
            sums[0][b] += sums[part][b];
}

/* The middle of the strongest bin, each bin taken together with its neighbours, because several bins see one
 * wave. */
static double
strongest(const double bin[ANGLES])
{
    size_t best = 0;
    double most = -1;

    for (size_t b = 0; b < ANGLES; b++) {
        double around = bin[b] + 0.5 * (bin[(b + 1) % ANGLES] + bin[(b + ANGLES - 1) % ANGLES]);
        best = around > most ? b : best;
        most = around > most ? around : most;
    }
    return ((double)best + 0.5) * RC_PI / ANGLES;
}

static void
measure_direction(const struct rc_relief *r, const double *power, double (*sums)[ANGLES],
                  struct rc_areal *a)
{
    const struct rc_shape *s = &r->shape;
    double cell = sqrt(rc_fourier_q(1, s->nx, s->dx) * rc_fourier_q(1, s->ny, s->dy));
    double wedge = WEDGE * RC_PI / ANGLES, angle;

    sum_parts(r, power, NAN, 0, sums);
    angle = strongest(sums[0]);
    /* a window spreads a wave to its neighbours: the wedge extends two waves to either side */
    for (int pass = 0; pass < 3; pass++) {
        sum_parts(r, power, angle, wedge, sums);
        if (!(sums[0][3] > 0))
            break;
        angle = 0.5 * atan2(sums[0][1], sums[0][0]);
        wedge = fmax(WEDGE * RC_PI / ANGLES, fmin(2 * cell * sums[0][3] / sums[0][2], RC_PI / 4));
    }
    angle = fmod(angle * 180 / RC_PI + 180, 180);
    a->std = 180 - angle < 1e-9 ? 0 : angle; /* rounding error */
}

/* ---- both ---- */

static enum rc_status
find_direction(const struct rc_relief *r, struct rc_areal *a, struct rc_err *err)
{
    RC_OWNED double *power = rc_alloc(rc_fourier_size(&r->shape), sizeof *power);
    RC_OWNED double *wx = rc_alloc(r->shape.nx, sizeof *wx);
    RC_OWNED double(*sums)[ANGLES] = malloc(PARTS * sizeof *sums);
    struct rc_windowed w = {
        .shape = &r->shape, .h = r->h, .window = rc_window_hann, .boundary = r->boundary, .wx = wx};
    enum rc_status status;

    if (power == NULL || wx == NULL || sums == NULL)
        return rc_err_set(err, "out of memory for the waves of %zu x %zu nodes", r->shape.nx,
                          r->shape.ny);
    if (!rc_has_mean(r->boundary)) {
        status = rc_power(&r->shape, height_row, r, (size_t)r->threads, power, err);
    } else {
        (void)rc_windowed_lay(&w, r->mean);
        status = rc_power(&r->shape, rc_windowed_row, &w, (size_t)r->threads, power, err);
    }
    if (status == RC_OK)
        measure_direction(r, power, sums, a);
    return status;
}

enum rc_status
rc_texture(const struct rc_relief *r, struct rc_areal *a, struct rc_err *err)
{
    struct rc_offsets at = offsets_of(&r->shape, r->boundary);
    RC_OWNED double *c = correlations(r, &at, a->sq, err);

    if (c == NULL)
        return RC_FAIL;
    measure_lengths(r, &at, c, a);
    if (r->shape.nx == 1 || r->shape.ny == 1)
        return RC_OK;
    return find_direction(r, a, err);
}
