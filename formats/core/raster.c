/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "raster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double apart = 0.01, /* a gap of this share of the widest one separates two nodes */
    off_most = 0.1,               /* steps between a point and its node */
    off_beside_empty = 0.02;      /* the same where some nodes have no point */

static double
widest_gap(const double *sorted, size_t points)
{
    double widest = 0;

    for (size_t k = 1; k < points; k++)
        widest = fmax(widest, sorted[k] - sorted[k - 1]);
    return widest;
}

/* The largest distance of a point from its node, in steps. */
static double
most_off(const struct rc_raster_axis *axis, const double *positions, size_t points)
{
    double off = 0;

    for (size_t k = 0; k < points; k++) {
        double at = (positions[k] - axis->first) / axis->step;

        off = fmax(off, fabs(at - round(at)));
    }
    return off;
}

static int
by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* The same axis with nodes that no point has, where the median of the gaps is the step and at most as
 * many nodes are empty as have points. */
static bool
with_empty_nodes(const double *sorted, size_t points, double threshold, struct rc_raster_axis *axis)
{
    RC_OWNED double *gap = malloc(points * sizeof *gap);
    double range = sorted[points - 1] - sorted[0], nodes;
    struct rc_raster_axis more = *axis;
    size_t n = 0, left = 0;

    if (gap == NULL || axis->n < 3)
        return false;
    for (size_t k = 1; k < points; k++)
        if (sorted[k] - sorted[k - 1] > threshold) {
            gap[n++] = sorted[k] - sorted[left];
            left = k;
        }
    qsort(gap, n, sizeof *gap, by_value);
    nodes = round(range / gap[(n - 1) / 2]) + 1;
    if (!(nodes > (double)axis->n && nodes <= 2 * (double)axis->n))
        return false;
    more.n = (size_t)nodes;
    more.empty = more.n - axis->n;
    more.step = range / (nodes - 1);
    if (!(most_off(&more, sorted, points) < off_beside_empty))
        return false;
    *axis = more;
    return true;
}

enum rc_status
rc_raster_axis(char name, const double *sorted, size_t points, struct rc_raster_axis *axis,
               struct rc_err *err)
{
    double threshold = apart * widest_gap(sorted, points);

    *axis = (struct rc_raster_axis){.first = sorted[0], .n = 1, .step = 1};
    for (size_t k = 1; k < points; k++)
        axis->n += sorted[k] - sorted[k - 1] > threshold;
    if (axis->n > 1)
        axis->step = (sorted[points - 1] - sorted[0]) / (double)(axis->n - 1);
    if (most_off(axis, sorted, points) < off_most ||
        with_empty_nodes(sorted, points, threshold, axis))
        return RC_OK;
    return rc_err_set(err,
                      "the points are on no raster: their %zu values of %c from %s on are not "
                      "evenly spaced",
                      axis->n, name, rc_number(axis->first));
}

size_t
rc_raster_node(const struct rc_raster_axis *axis, double position)
{
    return (size_t)lround((position - axis->first) / axis->step);
}

/* ---- an explanation ---- */

/* The axis of positions that deviate by less than a fifth of a step; false where there is none. */
static bool
rough_axis(const double *positions, size_t points, struct rc_raster_axis *axis)
{
    RC_OWNED double *sorted = malloc(points * sizeof *sorted);
    double half, mean[2] = {0, 0};
    size_t count[2] = {0, 0};

    if (sorted == NULL)
        return false;
    memcpy(sorted, positions, points * sizeof *sorted);
    qsort(sorted, points, sizeof *sorted, by_value);
    half = widest_gap(sorted, points) / 2;
    *axis = (struct rc_raster_axis){.n = 1};
    for (size_t k = 1; k < points; k++)
        axis->n += sorted[k] - sorted[k - 1] > half;
    if (axis->n < 2 || axis->n > points / 2)
        return false;
    for (size_t k = 0; k < points && sorted[k] - sorted[0] < half; k++, count[0]++)
        mean[0] += sorted[k];
    for (size_t k = points; k-- > 0 && sorted[points - 1] - sorted[k] < half; count[1]++)
        mean[1] += sorted[k];
    axis->first = mean[0] / (double)count[0];
    axis->step = (mean[1] / (double)count[1] - axis->first) / (double)(axis->n - 1);
    return axis->step > 0 && most_off(axis, positions, points) < 0.2;
}

/* Positions as linear functions of the numbers of column and row, by least squares: position = at[0] +
 * at[1] i + at[2] j. Gives the largest residual. */
static double
fit_plane(const double *i, const double *j, const double *position, size_t points, double at[3])
{
    double n = (double)points, mi = 0, mj = 0, mp = 0, ii = 0, ij = 0, jj = 0, ip = 0, jp = 0;
    double off = 0;

    for (size_t k = 0; k < points; k++) {
        mi += i[k] / n;
        mj += j[k] / n;
        mp += position[k] / n;
    }
    for (size_t k = 0; k < points; k++) {
        double di = i[k] - mi, dj = j[k] - mj, dp = position[k] - mp;

        ii += di * di;
        ij += di * dj;
        jj += dj * dj;
        ip += di * dp;
        jp += dj * dp;
    }
    at[1] = (ip * jj - jp * ij) / (ii * jj - ij * ij);
    at[2] = (jp * ii - ip * ij) / (ii * jj - ij * ij);
    at[0] = mp - at[1] * mi - at[2] * mj;
    for (size_t k = 0; k < points; k++)
        off = fmax(off, fabs(position[k] - at[0] - at[1] * i[k] - at[2] * j[k]));
    return off;
}

enum rc_status
rc_raster_explain(const double *x, const double *y, size_t points, struct rc_err *err)
{
    static const double degree = 3.14159265358979323846 / 180;
    RC_OWNED double *i = malloc(points * sizeof *i), *j = malloc(points * sizeof *j);
    struct rc_raster_axis ax, ay;
    double fx[3], fy[3], off, turned, rest;

    if (i == NULL || j == NULL || !rough_axis(x, points, &ax) || !rough_axis(y, points, &ay))
        return RC_FAIL;
    for (size_t k = 0; k < points; k++) {
        i[k] = round((x[k] - ax.first) / ax.step);
        j[k] = round((y[k] - ay.first) / ay.step);
    }
    off = fmax(most_off(&ax, x, points), most_off(&ay, y, points));
    rest = fmax(fit_plane(i, j, x, points, fx) / ax.step, fit_plane(i, j, y, points, fy) / ay.step);
    turned = (atan2(fy[1], fx[1]) - atan2(fx[2], fy[2])) / 2 / degree;
    if (rest < off / 4 && fabs(atan2(fy[1], fx[1]) + atan2(fx[2], fy[2])) < 0.1 * degree)
        return rc_err_set(
            err,
            "the points are on a raster of %zu x %zu that is turned by %.2g degrees: "
            "turn them back by that angle, or interpolate them to a raster along x and y",
            ax.n, ay.n, turned);
    return rc_err_set(
        err,
        "the raster of %zu x %zu is uneven: points are up to %.2g %% of a step away "
        "from even positions, up to %g %% is accepted: interpolate them to an even raster",
        ax.n, ay.n, 100 * off, 100 * apart);
}
