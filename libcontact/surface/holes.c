/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Widths of holes: exact distances of missing points from measured ones. The time is proportional to the
 * size of the map (Felzenszwalb and Huttenlocher, Theory of Computing 8, 2012).
 *
 * A count down and one up each column gives the steps from every node to the nearest measured node of its
 * column. Along a row the squared distance of column i is then the least of f_k + (i - k)^2 over the columns
 * k. f_k is the square of that count, in units of dx. These are parabolas of one shape, and any two of them
 * cross once. Their lower envelope is a list of parabolas from left to right, each the lowest on one run of
 * columns.
 */
#include "libcontact/common.h"
#include "libcontact/memory.h"

#include <math.h>
#include <stdint.h>

struct parabola {
    double f, apex;
    double from; /* this parabola is the lowest from here on, up to the start of the next one */
};

struct widths {
    struct rc_shape shape;
    uint32_t *above; /* steps down to every node from the nearest measured one above it; `never` */
    uint32_t *below; /* the same from below, for the present row */
    struct parabola *list;
};

static const uint32_t never = UINT32_MAX;

static uint32_t
one_more(uint32_t steps)
{
    return steps < never ? steps + 1 : never;
}

static void
count_down(struct widths *w, const double *h)
{
    size_t nx = w->shape.nx;

    for (size_t i = 0; i < nx; i++)
        w->above[i] = isnan(h[i]) ? never : 0;
    for (size_t k = nx; k < nx * w->shape.ny; k++)
        w->above[k] = isnan(h[k]) ? one_more(w->above[k - nx]) : 0;
}

/* The lower envelope of a row of f; returns the number of its parabolas. */
static size_t
envelope(const struct widths *w, const uint32_t *above)
{
    double aspect = w->shape.dy / w->shape.dx;
    size_t m = 0;

    for (size_t k = 0; k < w->shape.nx; k++) {
        uint32_t steps = above[k] < w->below[k] ? above[k] : w->below[k];
        struct parabola next = {.apex = (double)k, .from = -INFINITY};

        if (steps == never)
            continue;
        next.f = aspect * steps * (aspect * steps);
        for (; m > 0; m--) {
            const struct parabola *last = &w->list[m - 1];
            double apart = next.apex - last->apex;

            next.from = last->apex + 0.5 * ((next.f - last->f) / apart + apart);
            if (next.from > last->from)
                break;
            next.from = -INFINITY;
        }
        w->list[m++] = next;
    }
    return m;
}

/* The largest square of a distance in row j, in units of dx. */
static double
largest_in_row(struct widths *w, const double *h, size_t j)
{
    const uint32_t *above = w->above + j * w->shape.nx;
    double largest = 0;
    size_t m, k = 0;

    m = envelope(w, above); /* never empty: some row has a measured value */
    for (size_t i = 0; i < w->shape.nx; i++) {
        double d;

        while (k + 1 < m && w->list[k + 1].from <= (double)i)
            k++;
        d = (double)i - w->list[k].apex;
        if (isnan(h[j * w->shape.nx + i]))
            largest = fmax(largest, w->list[k].f + d * d);
    }
    return largest;
}

enum rc_status
rc_hole_width(const struct rc_shape *shape, const double *h, double *width, struct rc_err *err)
{
    size_t nx = shape->nx, nodes = nx * shape->ny, missing = 0;
    struct widths w = {.shape = *shape};
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    double largest = 0;

    for (size_t k = 0; k < nodes; k++)
        missing += isnan(h[k]) ? 1 : 0;
    *width = missing == nodes ? INFINITY : 0;
    if (missing == 0 || missing == nodes)
        return RC_OK;
    w.above = rc_store_take(&own, nodes, sizeof *w.above);
    w.below = rc_store_take(&own, nx, sizeof *w.below);
    w.list = rc_store_take(&own, nx, sizeof *w.list);
    if (own.failed)
        return rc_err_set(err, "out of memory for the distances of %zu x %zu nodes", nx, shape->ny);
    count_down(&w, h);
    for (size_t i = 0; i < nx; i++)
        w.below[i] = never;
    for (size_t j = shape->ny; j-- > 0;) {
        bool whole = true;

        for (size_t i = 0; i < nx; i++) {
            bool gone = isnan(h[j * nx + i]);
            w.below[i] = gone ? one_more(w.below[i]) : 0;
            whole = whole && !gone;
        }
        if (!whole)
            largest = fmax(largest, largest_in_row(&w, h, j));
    }
    *width = 2 * sqrt(largest) * shape->dx;
    return RC_OK;
}
