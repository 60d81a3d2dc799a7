/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "even.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The unit of the last decimal of any position: 0.01 for 0.5, 0.75, 1. */
static double
last_place(const double *x, size_t points)
{
    double place = 1, scaled;

    for (size_t k = 0; k < points; k++)
        while (place > 1e-12 &&
               (scaled = x[k] / place, fabs(scaled - round(scaled)) > 1e-6 * fmax(1, fabs(scaled))))
            place /= 10;
    return place;
}

/* Positions count as even if they deviate by their rounding in the file, or by a twentieth of a step. A
 * stylus drifts that much, and such a shift hardly changes the heights. */
static enum rc_status
judge_steps(const double *x, size_t points, struct rc_err *err)
{
    double step = (x[points - 1] - x[0]) / (double)(points - 1), place = last_place(x, points);
    double most = 0.05 * step, off = 0;
    size_t worst = 0;

    if (place < 0.7 * step)
        most = fmax(most, 1.01 * place);
    for (size_t k = 0; k < points; k++) {
        double here = fabs(x[k] - (x[0] + step * (double)k));
        if (here > off) {
            off = here;
            worst = k;
        }
    }
    if (off <= most)
        return RC_OK;
    return rc_err_set(
        err,
        "the positions are not evenly spaced: point %zu is at %s, but even steps of %s lead to %s, "
        "%.2g steps away; up to %.2g is accepted: --even resamples the profile to even steps",
        worst + 1, rc_number(x[worst]), rc_number(step), rc_number(x[0] + step * (double)worst),
        off / step, most / step);
}

static int
by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static enum rc_status
median_spacing(const double *x, size_t points, double *median, struct rc_err *err)
{
    size_t n = points - 1;
    RC_OWNED double *d = calloc(points, sizeof *d);

    assert(points >= 2);
    if (d == NULL)
        return rc_err_set(err, "out of memory for %zu spacings", n);
    for (size_t k = 0; k < n; k++)
        d[k] = x[k + 1] - x[k];
    qsort(d, n, sizeof *d, by_value);
    *median = (d[(n - 1) / 2] + d[n / 2]) / 2;
    return RC_OK;
}

/* The requested step in the unit of the positions, or the step of the points. */
static enum rc_status
pick_step(const struct rc_wish *wish, double metres, double length, double median, double *step,
          struct rc_err *err)
{
    if (!(wish->even_step > 0)) {
        *step = length / fmax(1, round(length / median));
        return RC_OK;
    }
    if (isnan(metres))
        return rc_err_set(err, "the positions have no unit, so that --even takes no step here: "
                               "--even without one resamples, and --dx says how wide its step is");
    *step = wish->even_step / metres;
    if (*step <= length * (1 + 1e-9))
        return RC_OK;
    return rc_err_set(err, "--even %s m is longer than the profile, %s m",
                      rc_number(wish->even_step), rc_number(length * metres));
}

enum rc_status
rc_even_new(const double *x, size_t points, double metres, const struct rc_file *file,
            const struct rc_wish *wish, struct rc_even *even, struct rc_err *err)
{
    double length = x[points - 1] - x[0], median = 0, nodes;

    *even = (struct rc_even){
        .first = x[0], .step = length / (double)(points - 1), .n = points, .widest = 0};
    if (!wish->even)
        return judge_steps(x, points, err);
    if (!(wish->even_step > 0) && judge_steps(x, points, NULL) == RC_OK)
        return RC_OK;
    if (median_spacing(x, points, &median, err) != RC_OK ||
        pick_step(wish, metres, length, median, &even->step, err) != RC_OK)
        return RC_FAIL;
    nodes = floor(length / even->step * (1 + 1e-12) + 1e-9) + 1;
    if (!(nodes < 1e15 && nodes < (double)SIZE_MAX))
        return rc_err_set(err, "%g nodes are too many: --even STEP gives a wider step", nodes);
    even->n = (size_t)nodes;
    even->widest = RC_EVEN_GAP * fmax(median, even->step) * (1 + 1e-9);
    return rc_map_fits(file, even->n, 4, err); /* a reader makes several copies */
}

static void
find_extremes(const double *z, size_t n, double *least, double *most)
{
    *least = INFINITY;
    *most = -INFINITY;
    for (size_t k = 0; k < n; k++)
        if (isfinite(z[k])) {
            *least = fmin(*least, z[k]);
            *most = fmax(*most, z[k]);
        }
}

static void
note_extremes(const double *z, size_t points, const double *v, size_t n, struct rc_notes *notes)
{
    double least, most, low, high;

    find_extremes(z, points, &least, &most);
    find_extremes(v, n, &low, &high);
    if (!(most > least) || low > high)
        return;
    notes->above = (most - high) / (most - least);
    notes->below = (low - least) / (most - least);
}

void
rc_even_heights(const struct rc_even *even, const double *x, const double *z, size_t points,
                double *v, struct rc_notes *notes)
{
    double near = 1e-9 * even->step; /* a point this near to a node counts as on it */
    size_t left = 0;

    if (even->widest == 0) {
        memcpy(v, z, points * sizeof *v);
        return;
    }
    for (size_t k = 0; k < even->n; k++) {
        double at = even->first + even->step * (double)k, gap;

        while (left + 2 < points && x[left + 1] <= at + near)
            left++;
        gap = x[left + 1] - x[left];
        if (fabs(at - x[left]) <= near)
            v[k] = z[left];
        else if (at >= x[left + 1] - near)
            v[k] = z[left + 1];
        else
            v[k] = gap > even->widest ? NAN
                                      : z[left] + (z[left + 1] - z[left]) * ((at - x[left]) / gap);
    }
    if (notes != NULL)
        note_extremes(z, points, v, even->n, notes);
}

bool
rc_even_one_way(const double *x, size_t points, size_t stride)
{
    double path = 0;

    for (size_t k = 1; k < points; k++)
        path += fabs(x[k * stride] - x[(k - 1) * stride]);
    return points > 1 && path > 0 && fabs(x[(points - 1) * stride] - x[0]) >= 0.9 * path;
}

enum rc_status
rc_axis_step(const char *name, double *x, size_t n, double *step, struct rc_err *err)
{
    bool falls = x[n - 1] < x[0];

    for (size_t k = 0; k < n / 2 && falls; k++) {
        double kept = x[k];

        x[k] = x[n - 1 - k];
        x[n - 1 - k] = kept;
    }
    *step = (x[n - 1] - x[0]) / (double)(n - 1);
    for (size_t k = 0; k < n; k++)
        if (!isfinite(x[k]))
            return rc_err_set(err, "position %zu of the axis '%s' is not a finite number", k + 1,
                              rc_word_shown(name));
    if (*step > 0 && judge_steps(x, n, NULL) == RC_OK)
        return RC_OK;
    return rc_err_set(err, "the positions of the axis '%s' are not evenly spaced, as a map needs",
                      rc_word_shown(name));
}
