/* Figures of a map. Sums are compensated and moments taken about the mean, so that neither the
 * number of nodes nor a datum far away eats digits. */
#include "libcontact/common.h"

#include <math.h>

/* Counts, extremes, sum and mean: what one pass over the values gives. */
static size_t
first_pass(const double *v, size_t n, struct rc_statistics *r)
{
    struct rc_total sum = {0};
    size_t there;

    for (size_t k = 0; k < n; k++) {
        if (isnan(v[k])) {
            r->missing++;
        } else if (isinf(v[k])) {
            r->infinite++;
        } else {
            if (!(v[k] >= r->minimum))
                r->minimum = v[k];
            if (!(v[k] <= r->maximum))
                r->maximum = v[k];
            rc_total_add(&sum, v[k]);
        }
    }
    there = n - r->missing - r->infinite;
    r->sum = rc_total_value(&sum);
    if (there > 0)
        r->mean = r->sum / (double)there;
    return there;
}

static double
rms_about(const double *v, size_t n, double mean, size_t there)
{
    struct rc_total squares = {0}, rest = {0};
    double left;

    for (size_t k = 0; k < n; k++)
        if (isfinite(v[k])) {
            rc_total_add(&squares, (v[k] - mean) * (v[k] - mean));
            rc_total_add(&rest, v[k] - mean);
        }
    /* the mean itself is rounded: what it misses is taken out */
    left = rc_total_value(&rest) / (double)there;
    return sqrt(fmax(0, rc_total_value(&squares) / (double)there - left * left));
}

/* Over the nodes whose next neighbours along each side that the map has are there. */
static double
slope(const struct rc_shape *shape, const double *v)
{
    size_t nx = shape->nx, ny = shape->ny, n = 0;
    size_t right = nx > 1 ? 1 : 0, below = ny > 1 ? nx : 0;
    struct rc_total squares = {0};

    if (nx == 1 && ny == 1)
        return NAN;
    for (size_t j = 0; j + (ny > 1) < ny; j++)
        for (size_t i = 0; i + right < nx; i++) {
            const double *at = v + j * nx + i;
            double gx = (at[right] - *at) / shape->dx, gy = (at[below] - *at) / shape->dy;
            double g2 = gx * gx + gy * gy;
            if (!isfinite(*at) || !isfinite(at[right]) || !isfinite(at[below]))
                continue;
            rc_total_add(&squares, g2);
            n++;
        }
    return n == 0 ? NAN : sqrt(rc_total_value(&squares) / (double)n);
}

void
rc_measure(const struct rc_shape *shape, const double *v, struct rc_statistics *result)
{
    size_t n = shape->nx * shape->ny, there;

    *result = (struct rc_statistics){
        .minimum = NAN, .maximum = NAN, .mean = NAN, .rms = NAN, .rms_slope = NAN};
    there = first_pass(v, n, result);
    if (there == 0)
        return;
    result->rms = rms_about(v, n, result->mean, there);
    result->rms_slope = slope(shape, v);
}
