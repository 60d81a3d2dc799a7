/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "raster.h"

#include <math.h>
#include <stdlib.h>

void
survey_map(const struct rc_grid *g, struct survey *s)
{
    *s = (struct survey){.min = NAN, .max = NAN};
    for (size_t k = 0; k < g->nx * g->ny; k++) {
        double v = g->v[k];

        if (isnan(v))
            s->missing++;
        else if (isfinite(v)) {
            if (v < s->min || isnan(s->min)) {
                s->min = v;
                s->min_at = k;
            }
            if (v > s->max || isnan(s->max)) {
                s->max = v;
                s->max_at = k;
            }
            s->zeros += v == 0;
        }
    }
}

/* ---- reduction and enlargement ---- */

/* The nodes that a cell covers along one axis, and the fraction of the cell for each. */
struct spans {
    size_t *first; /* first node of each cell; `start` has cells + 1 indices into `weight` */
    size_t *start;
    double *weight;
};

static void
spans_free(struct spans *s)
{
    free(s->first);
    free(s->start);
    free(s->weight);
}

static enum rc_status
spans_new(struct spans *s, size_t n, size_t cells, struct rc_err *err)
{
    const double sliver = 1e-9; /* a fraction that is only rounding is omitted, because the node
                                   could be NaN */
    size_t node = 0, used = 0;

    *s = (struct spans){.first = malloc(cells * sizeof *s->first),
                        .start = malloc((cells + 1) * sizeof *s->start),
                        .weight = malloc((n + 2 * cells) * sizeof *s->weight)};
    if (s->first == NULL || s->start == NULL || s->weight == NULL)
        return rc_err_set(err, "out of memory for a picture of %zu pixels a row", cells);
    for (size_t c = 0; c < cells; c++) {
        double a = (double)c / (double)cells, b = (double)(c + 1) / (double)cells;

        while (node + 1 < n && (double)(node + 1) / (double)n - a <= sliver * (b - a))
            node++;
        s->first[c] = node;
        s->start[c] = used;
        for (size_t k = node; k < n; k++) {
            double from = fmax(a, (double)k / (double)n), to = fmin(b, (double)(k + 1) / (double)n);
            double share = (to - from) / (b - a);

            if (k > node && share <= sliver)
                break;
            s->weight[used++] = share;
        }
    }
    s->start[cells] = used;
    return RC_OK;
}

double
raster_missing(const struct raster *r, size_t k)
{
    return r->missing == NULL ? 0 : (double)r->missing[k];
}

/* Most maps have all points, and no room for these fractions. */
static bool
add_missing(struct raster *r, size_t k, double fraction)
{
    if (r->missing == NULL && (r->missing = calloc(r->w * r->h, sizeof *r->missing)) == NULL)
        return false;
    r->missing[k] += (float)fraction;
    return true;
}

/* Adds one row of nodes, weighted, to a row of cells; r->v holds sums until they are divided. False when
 * memory is short. */
static bool
add_row(struct raster *r, size_t row, const double *v, const struct spans *x, double share,
        bool zero_is_none, double *weight)
{
    for (size_t c = 0; c < r->w; c++) {
        size_t at = row * r->w + c;

        for (size_t k = x->start[c]; k < x->start[c + 1]; k++) {
            double value = v[x->first[c] + k - x->start[c]];
            double w = share * x->weight[k];

            if (isnan(value)) {
                if (!add_missing(r, at, w))
                    return false;
            } else if (zero_is_none && value == 0) {
                r->none[at] += (float)w;
            } else {
                r->v[at] += w * value;
                weight[c] += w;
            }
        }
    }
    return true;
}

/* The rows of the raster from `first` on; false when memory is short. */
static bool
fill(struct raster *r, size_t first, const struct rc_grid *g, const struct spans *x,
     const struct spans *y, bool zero_is_none, double *weight)
{
    for (size_t row = 0; row < r->h; row++) {
        size_t of = first + row;

        for (size_t c = 0; c < r->w; c++)
            weight[c] = 0;
        for (size_t k = y->start[of]; k < y->start[of + 1]; k++)
            if (!add_row(r, row, g->v + (y->first[of] + k - y->start[of]) * g->nx, x, y->weight[k],
                         zero_is_none, weight))
                return false;
        for (size_t c = 0; c < r->w; c++)
            r->v[row * r->w + c] = weight[c] > 0 ? r->v[row * r->w + c] / weight[c] : NAN;
    }
    return true;
}

static struct raster *
raster_blank(size_t w, size_t h, struct rc_err *err)
{
    RC_OWN(raster, r) = calloc(1, sizeof *r);

    if (r != NULL)
        *r = (struct raster){.w = w,
                             .h = h,
                             .v = calloc(w * h, sizeof *r->v),
                             .none = calloc(w * h, sizeof *r->none)};
    if (r == NULL || r->v == NULL || r->none == NULL)
        return rc_err_null(err, "out of memory for a picture of %zu by %zu pixels", w, h);
    return rc_give(&r);
}

struct raster *
raster_rows(const struct rc_grid *g, bool zero_is_none, size_t w, size_t h, size_t first,
            size_t rows, struct rc_err *err)
{
    RC_OWN(raster, r) = raster_blank(w, rows, err);
    RC_ENDS(spans_free) struct spans x = {0}, y = {0};
    RC_OWNED double *weight = calloc(w, sizeof *weight);

    if (r == NULL || weight == NULL || spans_new(&x, g->nx, w, err) != RC_OK ||
        spans_new(&y, g->ny, h, err) != RC_OK || !fill(r, first, g, &x, &y, zero_is_none, weight))
        return rc_err_null(err, "out of memory for a picture of %zu by %zu pixels", w, h);
    return rc_give(&r);
}

struct raster *
raster_new(const struct rc_grid *g, bool zero_is_none, size_t w, size_t h, struct rc_err *err)
{
    return raster_rows(g, zero_is_none, w, h, 0, h, err);
}

struct raster *
raster_rows_max(const struct rc_grid *g, bool zero_is_none, size_t w, size_t h, size_t from_row,
                size_t rows, struct rc_err *err)
{
    RC_OWN(raster, r) = raster_blank(w, rows, err);

    if (r == NULL)
        return NULL;
    for (size_t row = 0; row < rows; row++) {
        size_t of = from_row + row;
        size_t first = of * g->ny / h, last = ((of + 1) * g->ny - 1) / h;

        for (size_t c = 0; c < w; c++) {
            size_t at = row * w + c, from = c * g->nx / w, to = ((c + 1) * g->nx - 1) / w;
            double largest = NAN;
            bool none = false;

            for (size_t j = first; j <= last; j++)
                for (size_t i = from; i <= to; i++) {
                    double v = g->v[j * g->nx + i];

                    if (zero_is_none && v == 0)
                        none = true;
                    else if (v > largest || isnan(largest))
                        largest = v;
                }
            r->v[at] = largest;
            r->none[at] = isnan(largest) && none ? 1 : 0;
            if (isnan(largest) && !none && !add_missing(r, at, 1))
                return rc_err_null(err, "out of memory for a picture of %zu by %zu pixels", w, h);
        }
    }
    return rc_give(&r);
}

void
raster_free(struct raster *r)
{
    if (r == NULL)
        return;
    free(r->v);
    free(r->none);
    free(r->missing);
    free(r);
}

/* ---- lines ---- */

static enum rc_status
add_line(struct lines *l, const double from[2], const double to[2], struct rc_err *err)
{
    if (l->n == l->capacity) {
        size_t capacity = 1024 + l->capacity + l->capacity / 4;
        double(*at)[4] = realloc(l->at, capacity * sizeof *at);

        if (at == NULL)
            return rc_err_set(err, "out of memory for %zu pieces of lines", capacity);
        l->at = at;
        l->capacity = capacity;
    }
    l->at[l->n][0] = from[0];
    l->at[l->n][1] = from[1];
    l->at[l->n][2] = to[0];
    l->at[l->n++][3] = to[1];
    return RC_OK;
}

static double
height_at(const struct raster *r, size_t i, size_t j)
{
    size_t k = j * r->w + i;
    double present = 1 - raster_missing(r, k);

    if (present < 0.5)
        return NAN;
    return isnan(r->v[k]) ? 0 : r->v[k] * (1 - (double)r->none[k] / present);
}

/* The line through the square between the centres of four neighbouring cells. Corners are numbered 0 upper
 * left, 1 upper right, 2 lower right, 3 lower left; side s goes from corner s to s + 1. */
static enum rc_status
cross_square(const double z[4], double level, size_t i, size_t j, struct lines *l,
             struct rc_err *err)
{
    static const double corner[4][2] = {{0.5, 0.5}, {1.5, 0.5}, {1.5, 1.5}, {0.5, 1.5}};
    double at[4][2];
    int n = 0;

    for (int s = 0; s < 4; s++) {
        int e = (s + 1) % 4;
        double t;

        if ((z[s] > level) == (z[e] > level))
            continue;
        t = (level - z[s]) / (z[e] - z[s]);
        at[n][0] = (double)i + corner[s][0] + t * (corner[e][0] - corner[s][0]);
        at[n++][1] = (double)j + corner[s][1] + t * (corner[e][1] - corner[s][1]);
    }
    if (n == 2)
        return add_line(l, at[0], at[1], err);
    if (n == 4) { /* a saddle: the mean decides which opposite corners are joined */
        bool middle = 0.25 * (z[0] + z[1] + z[2] + z[3]) > level;
        int turn = middle == (z[0] > level) ? 0 : 1;

        if (add_line(l, at[turn], at[turn + 1], err) != RC_OK)
            return RC_FAIL;
        return add_line(l, at[turn + 2], at[(turn + 3) % 4], err);
    }
    return RC_OK;
}

enum rc_status
raster_contour(const struct raster *r, double level, struct lines *l, struct rc_err *err)
{
    for (size_t j = 0; j + 1 < r->h; j++)
        for (size_t i = 0; i + 1 < r->w; i++) {
            double z[4] = {height_at(r, i, j), height_at(r, i + 1, j), height_at(r, i + 1, j + 1),
                           height_at(r, i, j + 1)};

            if (isfinite(z[0]) && isfinite(z[1]) && isfinite(z[2]) && isfinite(z[3]) &&
                cross_square(z, level, i, j, l, err) != RC_OK)
                return RC_FAIL;
        }
    return RC_OK;
}

static bool
reaches(const struct rc_grid *g, size_t i, size_t j, double level)
{
    double v = g->v[j * g->nx + i];

    return level > 0 ? v >= level : v > 0;
}

/* True if the border along a row or column of edges passes here. */
static bool
parts(const struct rc_grid *g, size_t i, size_t j, bool below, double level)
{
    return reaches(g, i, j, level) != reaches(g, below ? i : i + 1, below ? j + 1 : j, level);
}

enum rc_status
raster_border(const struct rc_grid *g, double level, size_t w, size_t h, struct lines *l,
              struct rc_err *err)
{
    double sx = (double)w / (double)g->nx, sy = (double)h / (double)g->ny;

    for (int below = 0; below < 2; below++) {
        size_t rows = below ? g->ny : g->nx, n = below ? g->nx : g->ny;

        for (size_t r = 0; r + 1 < rows; r++)
            for (size_t k = 0, end; k < n; k = end + 1) {
                double from[2], to[2];

                for (end = k; end < n && parts(g, below ? end : r, below ? r : end, below, level);)
                    end++;
                if (end == k)
                    continue;
                from[!below] = (double)k * (below ? sx : sy);
                to[!below] = (double)end * (below ? sx : sy);
                from[below] = to[below] = (double)(r + 1) * (below ? sy : sx);
                if (add_line(l, from, to, err) != RC_OK)
                    return RC_FAIL;
            }
    }
    return RC_OK;
}
