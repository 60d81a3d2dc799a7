/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Sections: rows at any depths are interpolated to even rows, so that each depth is at its position on the
 * axis. In a coated body stresses jump at interfaces, where the curves end.
 */
#include "render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    ROWS = 900, /* largest number of rows of the even map, and approximate number of columns */
    COLUMNS = 900
};

double *
section_depths(struct tool *t, const struct rc_grid *g)
{
    const char *text = rc_grid_get(g, "depths");
    struct numbers d = {0};

    if (text == NULL) {
        d.v = tool_room(t, g->ny, sizeof *d.v, "the depths of a section");
        for (size_t j = 0; j < g->ny; j++)
            d.v[j] = (double)j * g->dy;
        return d.v;
    }
    if (unit_numbers(text, UNIT_M, &d, &t->err) != RC_OK)
        tool_refuse(t, g, "its key depths: %s", t->err.text);
    if (d.n != g->ny)
        tool_refuse(t, g, "its key depths has %zu depths, but there are %zu rows", d.n, g->ny);
    for (size_t j = 1; j < g->ny; j++)
        if (!(d.v[j] > d.v[j - 1]))
            tool_refuse(t, g, "its key depths must rise from row to row");
    return d.v;
}

/* ---- between rows ---- */

/* The slope at row j of a smooth monotonic curve through the values (Fritsch and Butland 1984). It is a
 * weighted harmonic mean of the slopes beside it, and 0 at an extreme. */
static double
slope(const double *z, const double *v, size_t n, size_t j)
{
    double before, after, h0, h1, w0, w1;

    if (j == 0 || j + 1 == n) {
        size_t k = j == 0 ? 0 : n - 2;
        return (v[k + 1] - v[k]) / (z[k + 1] - z[k]);
    }
    h0 = z[j] - z[j - 1];
    h1 = z[j + 1] - z[j];
    before = (v[j] - v[j - 1]) / h0;
    after = (v[j + 1] - v[j]) / h1;
    if (!(before * after > 0))
        return 0;
    w0 = 2 * h1 + h0;
    w1 = h1 + 2 * h0;
    return (w0 + w1) / (w0 / before + w1 / after);
}

/* The value at depth `at`, between rows j and j + 1. */
static double
between(const double *z, const double *v, size_t n, size_t j, double at)
{
    double h = z[j + 1] - z[j], t = (at - z[j]) / h, s = 1 - t;

    if (isnan(v[j]) || isnan(v[j + 1]))
        return t < 0.5 ? v[j] : v[j + 1];
    return v[j] * s * s * (1 + 2 * t) + v[j + 1] * t * t * (3 - 2 * t) +
           h * t * s * (slope(z, v, n, j) * s - slope(z, v, n, j + 1) * t);
}

/* ---- the even map ---- */

/* Column i of `even`, where `times` columns correspond to one column of the map: linear between the
 * centres. */
static double
across(const struct rc_grid *g, size_t row, size_t i, size_t times)
{
    double x = ((double)i + 0.5) / (double)times - 0.5, t;
    size_t k;

    if (x <= 0 || g->nx == 1)
        return g->v[row * g->nx];
    if (x >= (double)g->nx - 1)
        return g->v[row * g->nx + g->nx - 1];
    k = (size_t)x;
    t = x - (double)k;
    if (t == 0)
        return g->v[row * g->nx + k];
    return (1 - t) * g->v[row * g->nx + k] + t * g->v[row * g->nx + k + 1];
}

/* The rows of a section: their depths and media. */
struct rows {
    const double *depth;
    const struct layers *layers;
    size_t *medium;
    double *v; /* values of one column */
    size_t n;
};

/* The value at depth `at`, between rows j and j + 1. It lies on the curve through the neighbouring rows in
 * the same medium. If the two rows are in different media, it is the value of the row in the medium of
 * `at`. */
static double
value_at(const struct rows *r, size_t j, double at)
{
    size_t first = j, end = j + 1, in;

    if (r->medium[j] != r->medium[j + 1]) {
        in = rc_body_material(&r->layers->body, at);
        if (in != r->medium[j] && in != r->medium[j + 1]) /* a medium without a row */
            return at - r->depth[j] < r->depth[j + 1] - at ? r->v[j] : r->v[j + 1];
        return in == r->medium[j] ? r->v[j] : r->v[j + 1];
    }
    /* slopes depend on two rows on each side */
    for (int k = 0; k < 2 && first > 0 && r->medium[first - 1] == r->medium[j]; k++)
        first--;
    for (int k = 0; k < 2 && end + 1 < r->n && r->medium[end + 1] == r->medium[j]; k++)
        end++;
    return between(r->depth + first, r->v + first, end - first + 1, j - first, at);
}

static void
fill_column(const struct rc_grid *g, const struct rows *r, struct rc_grid *even, size_t i,
            double top)
{
    size_t times = even->nx / g->nx, j = 0;

    for (size_t k = 0; k < g->ny; k++)
        r->v[k] = across(g, k, i, times);
    for (size_t k = 0; k < even->ny; k++) {
        double at = top + ((double)k + 0.5) * even->dy;

        while (j + 2 < g->ny && at > r->depth[j + 1])
            j++;
        even->v[k * even->nx + i] = g->ny == 1 ? r->v[0] : value_at(r, j, at);
    }
}

struct rc_grid *
section_even(struct tool *t, const struct rc_grid *g, const double *depth,
             const struct layers *layers, double top, double bottom)
{
    size_t times = g->nx < COLUMNS ? (size_t)fmax(1, round((double)COLUMNS / (double)g->nx)) : 1;
    struct rc_shape shape = {times * g->nx, ROWS, g->dx / (double)times, (bottom - top) / ROWS};
    struct rows r = {depth, layers, tool_room(t, g->ny, sizeof *r.medium, "a section"),
                     tool_room(t, g->ny, sizeof *r.v, "a section"), g->ny};
    struct rc_grid *even = tool_made(t, g, rc_grid_new(&shape, g->channel, g->unit, &t->err));
    for (size_t j = 0; j < g->ny; j++)
        r.medium[j] = rc_body_material(&layers->body, depth[j]);
    for (size_t i = 0; i < even->nx; i++)
        fill_column(g, &r, even, i, top);
    free(r.medium);
    free(r.v);
    return even;
}

/* ---- depths ---- */

void
section_range(struct tool *t, const char *text, const struct rc_grid *g, const double *depth,
              double *top, double *bottom)
{
    double first = depth[0], last = depth[g->ny - 1];
    double pair[2];

    *top = first;
    *bottom = last;
    if (g->ny == 1) { /* a strip around the only depth */
        *top = fmax(0, first - 0.5 * g->dy);
        *bottom = *top + g->dy;
    }
    if (text == NULL)
        return;
    if (look_pair(text, UNIT_M, pair, &t->err) != RC_OK)
        tool_usage(t, "--depth-range %s: %s", text, t->err.text);
    if (strchr(text, ':') == NULL || !(pair[0] < pair[1]) || pair[0] < 0)
        tool_usage(t, "--depth-range %s: it must be Z0:Z1, two depths, the lesser first", text);
    if (g->ny > 1) {
        *top = fmax(pair[0], first);
        *bottom = fmin(pair[1], last);
    } else if (pair[0] > first || pair[1] < first)
        *bottom = *top; /* the only depth is left out */
    if (!(*top < *bottom))
        tool_refuse(t, g, "--depth-range %s: its depths go from %s to %s", text,
                    scale_value(first, "m"), scale_value(last, "m"));
}
