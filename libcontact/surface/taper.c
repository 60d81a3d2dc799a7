/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Edges tapered to one height, so that a map can be repeated. */
#include "libcontact/common.h"

#include <math.h>
#include <stdlib.h>

/* Distance of node i from the nearer edge of its side. */
static double
from_edge(size_t i, size_t n, double d)
{
    return ((double)(i < n - 1 - i ? i : n - 1 - i) + 0.5) * d;
}

/* Weight of each node of a side: a raised cosine of the node's distance from the edge up to `width`, then 1.
 * It is 1 on a side of one node. NULL when memory is short. */
static double *
weights(size_t n, double d, double width)
{
    double *w = calloc(n, sizeof *w);

    for (size_t i = 0; i < n && w != NULL; i++) {
        double from = from_edge(i, n, d);
        w[i] = n == 1 || from >= width ? 1 : 0.5 - 0.5 * cos(RC_PI * from / width);
    }
    return w;
}

static enum rc_status
check(const struct rc_shape *shape, double width, const struct rc_statistics *s, struct rc_err *err)
{
    double node = 0, side = INFINITY;

    if (shape->nx > 1 || shape->ny == 1) {
        node = shape->dx;
        side = (double)shape->nx * shape->dx;
    }
    if (shape->ny > 1) {
        node = fmax(node, shape->dy);
        side = fmin(side, (double)shape->ny * shape->dy);
    }
    if (!(width >= node))
        return rc_err_set(err, "a taper of %g m is narrower than a node, %g m", width, node);
    if (!(width <= 0.5 * side))
        return rc_err_set(err, "a taper of %g m is wider than half the map, %g m", width,
                          0.5 * side);
    if (s->infinite > 0)
        return rc_err_set(err, "%zu infinite heights: they have no mean", s->infinite);
    if (s->missing == shape->nx * shape->ny)
        return rc_err_set(err, "all %zu heights are missing: nothing to taper", s->missing);
    return RC_OK;
}

static size_t
changed(size_t n, double d, double width)
{
    size_t k = 0;

    while (k < n / 2 && from_edge(k, n, d) < width)
        k++;
    return k;
}

void
rc_taper_frame(const struct rc_shape *shape, double width, size_t *columns, size_t *rows)
{
    *columns = changed(shape->nx, shape->dx, width);
    *rows = changed(shape->ny, shape->dy, width);
}

enum rc_status
rc_taper(const struct rc_shape *shape, double width, double *h, struct rc_err *err)
{
    RC_OWNED double *wx = NULL;
    RC_OWNED double *wy = NULL;
    struct rc_statistics s;

    rc_measure(shape, h, &s);
    if (check(shape, width, &s, err) != RC_OK)
        return RC_FAIL;
    wx = weights(shape->nx, shape->dx, width);
    wy = weights(shape->ny, shape->dy, width);
    if (wx == NULL || wy == NULL) {
        return rc_err_set(err, "out of memory for the edges of %zu x %zu nodes", shape->nx,
                          shape->ny);
    }
    for (size_t j = 0; j < shape->ny; j++)
        for (size_t i = 0; i < shape->nx; i++) {
            double *at = h + j * shape->nx + i, w = wx[i] * wy[j];
            if (w < 1)
                *at = s.mean + w * (*at - s.mean);
        }
    return RC_OK;
}
