/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Outliers: erroneous single points, found by the median of the 24 neighbours in a square of 5 x 5. A few bad
 * neighbours have no effect on this median.
 */
#include "libcontact/common.h"

#include <math.h>
#include <omp.h>

#include "libcontact/memory.h"
#include "robust.h"

enum {
    HALF = 2, /* nodes of the square on either side */
    SIDE = 2 * HALF + 1,
    OTHERS = SIDE * SIDE - 1,
    LANES = 8 /* points whose medians are computed together */
};

/* ---- the median of 24 ---- */

/* The smaller one of each lane to a, the larger one to b. */
static inline void
order(double *restrict a, double *restrict b)
{
#pragma omp simd
    for (size_t l = 0; l < LANES; l++) {
        double low = a[l] < b[l] ? a[l] : b[l], high = a[l] < b[l] ? b[l] : a[l];
        a[l] = low;
        b[l] = high;
    }
}

/* The two middle values of 24. Among 14 of them neither the smallest nor the largest can be one of the two.
 * Both are dropped, another value is added, and so on until all have been added. */
static inline void
middle_two(double v[OTHERS][LANES], double *restrict low, double *restrict high)
{
    size_t next = OTHERS / 2 + 2;

    for (size_t k = OTHERS / 2 + 2; k >= 4; k--) {
        for (size_t i = 0; i < k / 2; i++)
            order(v[i], v[k - 1 - i]);
        for (size_t i = 1; i <= (k - 1) / 2; i++)
            order(v[0], v[i]);
        for (size_t i = k / 2; i + 1 < k; i++)
            order(v[i], v[k - 1]);
        for (size_t l = 0; l < LANES && next < OTHERS; l++)
            v[0][l] = v[next][l];
        next++;
    }
    for (size_t l = 0; l < LANES; l++) {
        low[l] = v[1][l] < v[2][l] ? v[1][l] : v[2][l];
        high[l] = v[1][l] < v[2][l] ? v[2][l] : v[1][l];
    }
}

/* Computes differences of LANES points of a row from the medians of their neighbours. `row` holds the SIDE
 * rows around it, shifted so that the square begins with each. Missing neighbours count alternately as above
 * and below all others, which preserves the middle. With an odd number of them the median is the lower of the
 * two middle values. */
RC_CLONES static void
differ(const double *const row[SIDE], double *d)
{
    double v[OTHERS][LANES], far[LANES], low[LANES], high[LANES], missing[LANES] = {0};
    const double *middle = row[HALF] + HALF;

    for (size_t l = 0; l < LANES; l++)
        far[l] = INFINITY;
    for (size_t k = 0; k < OTHERS; k++) {
        size_t place = k < OTHERS / 2 ? k : k + 1;
        const double *at = row[place / SIDE] + place % SIDE;
#pragma omp simd
        for (size_t l = 0; l < LANES; l++) {
            bool there = at[l] == at[l];
            v[k][l] = there ? at[l] : far[l];
            far[l] = there ? far[l] : -far[l];
            missing[l] += there ? 0 : 1;
        }
    }
    middle_two(v, low, high);
    for (size_t l = 0; l < LANES; l++) {
        double median = far[l] < 0 ? low[l] : low[l] + 0.5 * (high[l] - low[l]);
        d[l] = missing[l] < OTHERS ? middle[l] - median : NAN;
    }
}

/* ---- the map ---- */

struct square {
    const struct rc_shape *shape;
    struct rc_boundary boundary;
    size_t width;  /* width of a row with its margins */
    double *lines; /* memory for each thread: SIDE such rows */
};

/* Copies row j, which may lie outside the map, with HALF more nodes at its start and enough at its end. */
static void
take_row(const struct square *s, const double *h, ptrdiff_t j, double *to)
{
    ptrdiff_t nx = (ptrdiff_t)s->shape->nx, ny = (ptrdiff_t)s->shape->ny;
    bool there = s->boundary.y || (j >= 0 && j < ny);
    const double *row = h + (there ? (j % ny + ny) % ny : 0) * nx;

    for (ptrdiff_t i = 0; i < (ptrdiff_t)s->width; i++) {
        ptrdiff_t k = i - HALF;
        bool inside = k >= 0 && k < nx;
        if (there && s->boundary.x && k < nx + HALF)
            to[i] = row[(k % nx + nx) % nx];
        else
            to[i] = there && inside ? row[k] : NAN;
    }
}

static void
find_differences(const struct square *s, const double *h, int threads, double *d)
{
    size_t nx = s->shape->nx;

#pragma omp parallel for schedule(static) num_threads(threads)
    for (size_t j = 0; j < s->shape->ny; j++) {
        double *line = s->lines + SIDE * (size_t)omp_get_thread_num() * s->width;
        for (size_t k = 0; k < SIDE; k++)
            take_row(s, h, (ptrdiff_t)(j + k) - HALF, line + k * s->width);
        for (size_t i = 0; i < nx; i += LANES) {
            const double *row[SIDE];
            double some[LANES];
            for (size_t k = 0; k < SIDE; k++)
                row[k] = line + k * s->width + i;
            differ(row, some);
            for (size_t l = 0; l < LANES && i + l < nx; l++)
                d[j * nx + i + l] = some[l];
        }
    }
}

/* 1.4826 times the median absolute deviation is the standard deviation of a Gaussian. */
enum rc_status
rc_median_differences(const struct rc_shape *shape, struct rc_boundary boundary, size_t threads,
                      const double *h, double *d, double *spread, struct rc_err *err)
{
    struct square s = {shape, boundary, shape->nx + 2 * HALF + LANES, NULL};
    int team = rc_useful_threads(shape, threads);
    size_t n = shape->nx * shape->ny;
    struct rc_statistics figures;
    RC_OWNED double *lines = NULL;

    rc_measure(shape, h, &figures);
    if (figures.infinite > 0)
        return rc_err_set(err, "%zu infinite heights have no distance from others",
                          figures.infinite);
    s.lines = lines = rc_alloc((size_t)team, SIDE * s.width * sizeof *lines);
    if (lines == NULL)
        return rc_err_set(err, "out of memory for the neighbours of %zu heights", n);
    find_differences(&s, h, team, d);
    *spread = 1.4826 * rc_median(d, n, rc_median(d, n, 0, false, team), true, team);
    return RC_OK;
}

enum rc_status
rc_outliers(const struct rc_shape *shape, double times, struct rc_boundary boundary, size_t threads,
            double *h, size_t *count, struct rc_err *err)
{
    size_t n = shape->nx * shape->ny;
    RC_OWNED double *d = NULL;
    double spread;

    *count = 0;
    if (!(times > 0))
        return rc_err_set(err, "outliers beyond %g deviations: the number must be above 0", times);
    if ((d = rc_alloc(n, sizeof *d)) == NULL)
        return rc_err_set(err, "out of memory for outliers among %zu heights", n);
    if (rc_median_differences(shape, boundary, threads, h, d, &spread, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < n; k++)
        if (fabs(d[k]) > times * spread) {
            h[k] = NAN;
            ++*count;
        }
    return RC_OK;
}
