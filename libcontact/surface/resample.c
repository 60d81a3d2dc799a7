/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Maps on other grids: means over coarser cells, cubic polynomials between nodes for finer ones.
 *
 * Positions along an axis are in cells of the old grid, from its first edge. Old cell i extends from i to i +
 * 1, with its node at i + 1/2. The middles of both grids coincide.
 */
#include "libcontact/contact.h"

#include <math.h>
#include <string.h>

#include "libcontact/memory.h"

struct axis {
    size_t from, to;
    double step; /* step of the new cells */
    bool whole;  /* the new cells cover the old map exactly */
};

static bool
near(double a, double b)
{
    return fabs(a - b) <= RC_SAME_SPACING * b;
}

static struct axis
axis_of(size_t from, double from_d, size_t to, double to_d)
{
    struct axis a = {.from = from, .to = to, .step = to_d / from_d};

    a.whole = near((double)to * to_d, (double)from * from_d);
    if (a.whole || (from == 1 && to == 1)) { /* a single row has no width */
        a.whole = true;
        a.step = (double)from / (double)to;
    }
    return a;
}

/* Where new cell k begins; for k + 1/2, where its node is. Whole numbers are exact. */
static double
edge(const struct axis *a, double k)
{
    double n = (double)a->from;
    double at = a->whole ? k * n / (double)a->to : 0.5 * n + (k - 0.5 * (double)a->to) * a->step;

    return at < 0 ? 0 : at > n ? n : at;
}

static bool
unchanged(const struct axis *a)
{
    return a->whole && a->from == a->to;
}

static bool
finer(const struct axis *a)
{
    return a->step < 1 && !unchanged(a);
}

/* ---- means ---- */

/* Sum of v over the part of a row between two positions, and the measured length of that part. */
static void
add_row(const double *v, double first, double last, double weight, double *sum, double *measured)
{
    for (size_t i = (size_t)first; (double)i < last; i++) {
        double low = fmax(first, (double)i), high = fmin(last, (double)i + 1);

        if (isnan(v[i]))
            continue;
        *sum += weight * (high - low) * v[i];
        *measured += weight * (high - low);
    }
}

static double
cell_mean(const double *v, size_t nx, const double x[2], const double y[2])
{
    double sum = 0, measured = 0;

    for (size_t j = (size_t)y[0]; (double)j < y[1]; j++)
        add_row(v + j * nx, x[0], x[1], fmin(y[1], (double)j + 1) - fmax(y[0], (double)j), &sum,
                &measured);
    /* a new node needs half of its area measured, less the rounding */
    return measured >= 0.4999999999 * (x[1] - x[0]) * (y[1] - y[0]) ? sum / measured : NAN;
}

static void
means(const struct axis *x, const struct axis *y, const double *v, double *out)
{
    for (size_t j = 0; j < y->to; j++) {
        double row[2] = {edge(y, (double)j), edge(y, (double)j + 1)};

        for (size_t i = 0; i < x->to; i++) {
            double column[2] = {edge(x, (double)i), edge(x, (double)i + 1)};

            out[j * x->to + i] = cell_mean(v, x->from, column, row);
        }
    }
}

void
rc_resample_means(const struct rc_shape *from, const double *v, const struct rc_shape *to,
                  double *out)
{
    struct axis x = axis_of(from->nx, (double)to->nx, to->nx, (double)from->nx);
    struct axis y = axis_of(from->ny, (double)to->ny, to->ny, (double)from->ny);

    means(&x, &y, v, out);
}

/* ---- cubic polynomials ---- */

enum {
    POINTS = 6,
    ENDS = 3 /* nodes at an end that extrapolate the map */
};

/* The nodes from which a value is interpolated, and their weights. */
struct stencil {
    size_t at[POINTS];
    double weight[POINTS];
};

/* Cubic convolution of Keys 1981 (IEEE Trans. ASSP 29, 1153, section VI) at t from node 2 to node 3 of six.
 * The cubic has the values of these two nodes and the slopes there, of fourth order, from five nodes about
 * each. */
static void
keys(double t, double weight[POINTS])
{
    static const double slope[5] = {1.0 / 12, -8.0 / 12, 0, 8.0 / 12, -1.0 / 12};
    double u = 1 - t;

    memset(weight, 0, POINTS * sizeof *weight);
    weight[2] = (1 + 2 * t) * u * u;
    weight[3] = (3 - 2 * t) * t * t;
    for (size_t k = 0; k < 5; k++) {
        weight[k] += slope[k] * t * u * u;
        weight[k + 1] -= slope[k] * t * t * u;
    }
}

/* Distributes the weight of a node `beyond` the end of a line to the last nodes of the line, end[0] the
 * outermost. Three nodes extrapolate by a parabola, two by a line. */
static void
extend(double beyond, double weight, size_t nodes, double *end[ENDS])
{
    if (nodes == 1) {
        *end[0] += weight;
    } else if (nodes == 2) {
        *end[0] += weight * (1 + beyond);
        *end[1] -= weight * beyond;
    } else {
        *end[0] += weight * (beyond + 1) * (beyond + 2) / 2;
        *end[1] -= weight * beyond * (beyond + 2);
        *end[2] += weight * beyond * (beyond + 1) / 2;
    }
}

/* The stencil of new node k: the six nodes around it or, at an end of an axis that does not repeat,
 * the last six. */
static struct stencil
stencil_at(const struct axis *a, size_t k, bool repeats)
{
    double place = edge(a, (double)k + 0.5) - 0.5, weight[POINTS];
    long n = (long)a->from, first = (long)floor(place) - 2, start = first, last;
    struct stencil s = {{0}, {0}};

    keys(place - floor(place), weight);
    if (!repeats) {
        start = start > n - POINTS ? n - POINTS : start;
        start = start < 0 ? 0 : start;
    }
    last = n - 1 - start; /* the end of the line, where the stencil reaches it */
    for (long m = 0; m < POINTS; m++) {
        long node = start + m;

        s.at[m] = (size_t)(repeats ? (node % n + n) % n : node < n ? node : n - 1);
    }
    for (long m = 0; m < POINTS; m++) {
        long node = first + m;
        double *low[ENDS] = {&s.weight[0], &s.weight[1], &s.weight[2]};
        double *high[ENDS] = {&s.weight[last < POINTS ? last : 0],
                              &s.weight[last >= 1 && last < POINTS ? last - 1 : 0],
                              &s.weight[last >= 2 && last < POINTS ? last - 2 : 0]};

        if (repeats || (node >= 0 && node < n))
            s.weight[node - start] += weight[m];
        else if (node < 0)
            extend((double)-node, weight[m], a->from, low);
        else
            extend((double)(node - n + 1), weight[m], a->from, high);
    }
    return s;
}

/* The two nodes next to new node k, weighted by distance; beyond the last node, linear extrapolation. */
static struct stencil
between(const struct axis *a, size_t k, bool repeats)
{
    double place = edge(a, (double)k + 0.5) - 0.5, t;
    long n = (long)a->from, first = (long)floor(place);

    if (!repeats) {
        first = first > n - 2 ? n - 2 : first;
        first = first < 0 ? 0 : first;
    }
    t = n == 1 ? 0 : place - (double)first;
    return (struct stencil){{(size_t)((first + n) % n), (size_t)((first + 1) % n)}, {1 - t, t}};
}

/* Nodes with zero weight may be missing. */
static double
product(const double *v, size_t nx, const struct stencil *x, const struct stencil *y)
{
    double sum = 0;

    for (size_t l = 0; l < POINTS; l++)
        for (size_t k = 0; k < POINTS; k++)
            if (x->weight[k] * y->weight[l] != 0)
                sum += x->weight[k] * y->weight[l] * v[y->at[l] * nx + x->at[k]];
    return sum;
}

/* The map, its new axes, and how it continues. */
struct between_nodes {
    const double *v;
    const struct axis *x, *y;
    struct rc_boundary boundary;
};

/* A value with a missing node among its neighbours. */
static double
beside_hole(const struct between_nodes *b, size_t i, size_t j, const struct stencil *sx,
            const struct stencil *sy)
{
    size_t column = (size_t)edge(b->x, (double)i + 0.5), row = (size_t)edge(b->y, (double)j + 0.5);
    double own = b->v[row * b->x->from + column];
    double value = product(b->v, b->x->from, sx, sy);
    struct stencil lx, ly;

    if (isnan(own) || !isnan(value))
        return isnan(own) ? NAN : value;
    lx = between(b->x, i, b->boundary.x);
    ly = between(b->y, j, b->boundary.y);
    value = product(b->v, b->x->from, &lx, &ly);
    return isnan(value) ? own : value;
}

/* Values at the columns of the old grid, at the position of a new row. */
static void
row_at(const double *v, size_t nx, const struct stencil *s, double *row)
{
    for (size_t i = 0; i < nx; i++) {
        double sum = 0;

        for (size_t l = 0; l < POINTS; l++)
            sum += s->weight[l] * v[s->at[l] * nx + i];
        row[i] = sum;
    }
}

static enum rc_status
cubic(const struct between_nodes *b, double *out, struct rc_err *err)
{
    size_t nx = b->x->to;
    RC_OWNED struct stencil *columns = rc_alloc(nx, sizeof *columns);
    RC_OWNED double *row = rc_alloc(b->x->from, sizeof *row);

    if (columns == NULL || row == NULL)
        return rc_err_set(err, "out of memory for the weights of %zu columns", nx);
    for (size_t i = 0; i < nx; i++)
        columns[i] = stencil_at(b->x, i, b->boundary.x);
    for (size_t j = 0; j < b->y->to; j++) {
        struct stencil s = stencil_at(b->y, j, b->boundary.y);

        row_at(b->v, b->x->from, &s, row);
        for (size_t i = 0; i < nx; i++) {
            double sum = 0;

            for (size_t k = 0; k < POINTS; k++)
                sum += columns[i].weight[k] * row[columns[i].at[k]];
            out[j * nx + i] = isnan(sum) ? beside_hole(b, i, j, &columns[i], &s) : sum;
        }
    }
    return RC_OK;
}

/* ---- the new grid ---- */

static enum rc_status
fit(size_t from, double from_d, double d, size_t *n, double *to_d, struct rc_err *err)
{
    double cells = (double)from * from_d / d;

    *to_d = d;
    *n = from;
    if (!(d > 0) || isinf(d))
        return rc_err_set(err, "spacing %g m: it must be positive and finite", d);
    if (near(d, from_d))
        *to_d = from_d;
    if (from == 1 || near(d, from_d))
        return RC_OK;
    cells *= 1 + RC_SAME_SPACING; /* a cell that is whole within the tolerance of spacings */
    if (cells < 1)
        return rc_err_set(err, "a cell of %g m is wider than the map, %g m", d,
                          (double)from * from_d);
    if (cells > 1e15 || cells >= (double)SIZE_MAX)
        return rc_err_set(err, "spacing %g m: that makes %g nodes of %zu", d, cells, from);
    *n = (size_t)cells;
    return RC_OK;
}

enum rc_status
rc_resample_shape(const struct rc_shape *from, double dx, double dy, struct rc_shape *to,
                  struct rc_err *err)
{
    if (fit(from->nx, from->dx, dx, &to->nx, &to->dx, err) != RC_OK ||
        fit(from->ny, from->dy, dy, &to->ny, &to->dy, err) != RC_OK)
        return RC_FAIL;
    return rc_shape_check(to, err);
}

bool
rc_resample_covers(const struct rc_shape *from, const struct rc_shape *to, enum rc_map_axis axis)
{
    return axis == RC_X ? axis_of(from->nx, from->dx, to->nx, to->dx).whole
                        : axis_of(from->ny, from->dy, to->ny, to->dy).whole;
}

/* ---- from one grid to the other ---- */

static enum rc_status
check_inside(const struct axis *a, struct rc_err *err)
{
    if (!a->whole && (double)a->to * a->step > (double)a->from)
        return rc_err_set(
            err, "%zu cells, each as wide as %g old ones, go beyond the map of %zu old cells",
            a->to, a->step, a->from);
    return RC_OK;
}

/* One axis gets coarser, the other finer: first the coarser one, into an intermediate map. */
static enum rc_status
by_way_of(const struct axis *x, const struct axis *y, const double *v, struct rc_boundary boundary,
          double *out, struct rc_err *err)
{
    struct axis same_x = {x->from, x->from, 1, true}, same_y = {y->from, y->from, 1, true};
    const struct axis *coarse_x = finer(x) ? &same_x : x, *coarse_y = finer(y) ? &same_y : y;
    struct axis fine_x = finer(x) ? *x : (struct axis){x->to, x->to, 1, true};
    struct axis fine_y = finer(y) ? *y : (struct axis){y->to, y->to, 1, true};
    struct between_nodes b = {.x = &fine_x, .y = &fine_y, .boundary = boundary};
    size_t n = 0;
    RC_OWNED double *half = NULL;

    if (rc_size_mul(coarse_x->to, coarse_y->to, &n, err) != RC_OK)
        return RC_FAIL;
    if ((half = rc_alloc(n, sizeof *half)) == NULL)
        return rc_err_set(err, "out of memory for a map of %zu x %zu nodes", coarse_x->to,
                          coarse_y->to);
    means(coarse_x, coarse_y, v, half);
    b.v = half;
    return cubic(&b, out, err);
}

enum rc_status
rc_resample(const struct rc_shape *from, const double *v, struct rc_boundary boundary,
            const struct rc_shape *to, double *out, struct rc_err *err)
{
    struct axis x, y;

    if (rc_shape_check(from, err) != RC_OK || rc_shape_check(to, err) != RC_OK)
        return RC_FAIL;
    x = axis_of(from->nx, from->dx, to->nx, to->dx);
    y = axis_of(from->ny, from->dy, to->ny, to->dy);
    if (check_inside(&x, err) != RC_OK || check_inside(&y, err) != RC_OK)
        return RC_FAIL;
    if (!finer(&x) && !finer(&y)) {
        means(&x, &y, v, out);
        return RC_OK;
    }
    if ((finer(&x) || unchanged(&x)) && (finer(&y) || unchanged(&y)))
        return cubic(&(struct between_nodes){v, &x, &y, boundary}, out, err);
    return by_way_of(&x, &y, v, boundary, out, err);
}
