/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Order, correction region and levels of the multi-level sum.
 */
#include "mlms.h"

#include <math.h>
#include <string.h>

/* ---- accuracy ---- */

/*
 * Interpolation of 1/x from the 2t nodes at odd distances about a node, in units of the fine spacing, has the
 * relative error
 *
 *     Q(t, r) = product over k = 1 .. t of (2k-1)^2 / (r^2 - (2k-1)^2)
 *
 * at distance r: exactly for a pole; 1/r has this error along the axes and less elsewhere. So the largest
 * coefficient neglected beyond a region of m_c nodes is Q(t, m_c + 1) times the kernel there. `one`, this
 * over the kernel at the node, is the error under a single loaded node. Pressures on many nodes can have
 * larger errors if they follow the signs of the error about a node. The error is then many_over_one() times
 * this, relative to the largest sum of |K| |p|. For a kernel that decreases faster than 1/r, or is smooth
 * about the node, the relevant figure is `all`. It is the sum of the neglected coefficients over that of |K|
 * within the region (rc_mlms_left_out).
 *
 * Measured on 256 x 256 nodes: e the error about a loaded node (four, of all parities), pressures
 * |e|^a sign(e) with a = 0, 1/2, 1 where |e| is above one of 19 fractions of its largest, and 1
 * everywhere; worst: the largest error over the largest sum of |K| |p|; estimate: measured() below,
 * which is at least `worst` for all six stresses too, at depths of 0.1 to 20 spacings.
 *
 *      t  m_c     one   one/Q   worst  estimate |   t  m_c     one   one/Q   worst  estimate
 *      2    5  5.6e-4    1.24  4.5e-3    9.9e-3 |   6   15  2.8e-8    1.02  3.4e-7    4.9e-7
 *      2    9  3.7e-5    1.30  5.2e-4    9.1e-4 |   6   20  4.4e-10   1.07  8.2e-9    9.0e-9
 *      3    8  2.2e-5    1.02  2.6e-4    4.1e-4 |   8   18  2.7e-9    1.04  3.8e-8    4.6e-8
 *      3   15  2.8e-7    1.00  5.0e-6    7.3e-6 |   8   22  3.9e-11   1.02  7.4e-10   7.2e-10
 *      4   10  3.1e-6    1.02  4.7e-5    5.6e-5 |   8   25  3.3e-12   1.04  6.3e-11   6.7e-11
 *      4   16  4.2e-8    1.16  9.6e-7    9.6e-7 |  10   23  2.8e-11   1.03  3.4e-10   4.8e-10
 *      5   12  4.9e-7    1.03  7.0e-6    8.5e-6 |  12   27  2.3e-12   2.22  1.5e-11   3.8e-11
 *      5   15  3.1e-8    1.01  3.9e-7    5.9e-7 |  12   30  3.1e-14   1.02  5.1e-13   5.5e-13
 */
static double
many_over_one(double t, double reach)
{
    return 9 + 3.5 * reach / t;
}

/* It holds for the displacement kernel on equal spacings. A cell's own pressure displaces it by 3.525 times
 * as much as its load would, as a point load, one spacing away. */
static double
expected_error(size_t t, size_t reach)
{
    double r = (double)reach + 1, q = 1.08 / (3.525 * r);

    for (size_t k = 1; k <= t; k++) {
        double at = 2 * (double)k - 1;
        q *= at * at / (r * r - at * at);
    }
    return many_over_one((double)t, (double)reach) * q;
}

/* The smallest region whose expected error is at most tol; a region as large as the map neglects nothing. */
static size_t
reach_for(size_t t, double tol, const struct rc_shape *s)
{
    double longest = fmax((double)s->nx * s->dx, (double)s->ny * s->dy);
    size_t low = 2 * t, high = low + (size_t)fmin(1e9, longest / fmin(s->dx, s->dy));

    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (expected_error(t, middle) > tol)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* ---- correction region ---- */

static double
spacing(const struct rc_mlms_axis *a, double cell)
{
    return (double)a->step * cell;
}

/* The region lies within `reach` coarser spacings (half a node more, in an ellipse) of the source's cell
 * rather than its node. A long cell is close to the nodes beside its long side. Where both directions are
 * interpolated and the source itself is used, the corners of the ellipse are corrected too. The source's own
 * coefficient is far from smooth on coarse levels. */
ptrdiff_t
rc_mlms_extent(const struct rc_mlms_design *d, const struct rc_shape *shape,
               const struct rc_mlms_axis axis[2], size_t k, bool odd)
{
    const struct rc_mlms_axis *x = &axis[RC_X], *y = &axis[RC_Y];
    double hx = spacing(x, shape->dx), hy = spacing(y, shape->dy), slack = 1 + 1e-9;
    double edge_x = fmax(0, (shape->dx - shape->dy) / 2);
    double edge_y = fmax(0, (shape->dy - shape->dx) / 2);
    double h = fmax(x->halved ? hx : 0, y->halved ? hy : 0), l = -1;
    double r = ((double)d->reach + (d->square ? 0 : 0.5)) * h * slack;
    double at = fmax(0, (double)k * hx - edge_x);
    size_t most = y->n - 1 + (y->halved ? 2 * d->t : 0);

    if (k > x->n - 1 + (x->halved ? 2 * d->t : 0))
        return -1;
    if (at <= r)
        l = ((d->square ? r : sqrt(r * r - at * at)) + edge_y) / hy;
    if (odd && !d->square && k < 2 * d->t)
        l = fmax(l, 2 * (double)d->t - 1);
    return l < (double)most ? (ptrdiff_t)floor(l) : (ptrdiff_t)most;
}

/* Counts the offsets in the region, and those that join nodes of the same class. */
static void
count(const struct rc_mlms_design *d, const struct rc_shape *shape,
      const struct rc_mlms_axis axis[2], double *all, double *same)
{
    *all = *same = 0;
    for (size_t k = 0;; k++) {
        ptrdiff_t l = rc_mlms_extent(d, shape, axis, k, false);
        double twice = k == 0 ? 1 : 2;
        if (l < 0)
            return;
        *all += twice * (double)(2 * l + 1);
        if (k % 2 == 0 || !axis[RC_X].halved)
            *same += twice * (double)(axis[RC_Y].halved ? l / 2 * 2 + 1 : 2 * l + 1);
    }
}

/* ---- levels ---- */

/* A tile has about RC_MLMS_TILE places. Axes long enough for two threads have at least two tiles. */
static void
set_tiles(struct rc_mlms_axis *a)
{
    size_t places = (a->n + a->halved) >> a->halved;
    size_t tiles = (places + RC_MLMS_TILE / 2) / RC_MLMS_TILE;

    tiles = tiles > 1 ? tiles : places >= RC_MLMS_TILE ? 2 : 1;
    a->tile = ((places + tiles - 1) / tiles + RC_SIMD_WIDTH - 1) / RC_SIMD_WIDTH * RC_SIMD_WIDTH;
    a->tiles = (places + a->tile - 1) / a->tile;
}

/* True if a grid is coarsened, and in which direction: that of the smaller spacing until both are equal.
 * Otherwise the correction region would be many nodes long in that direction. A direction that would not get
 * shorter is kept. */
static bool
halve(struct rc_mlms_axis axis[2], const struct rc_shape *shape, size_t t)
{
    /* Just above sqrt(2): after a halving the other direction is the larger one. */
    static const double alike = 1.42;
    double h[2] = {spacing(&axis[RC_X], shape->dx), spacing(&axis[RC_Y], shape->dy)};
    bool can[2];

    for (int a = 0; a < 2; a++)
        can[a] = axis[a].n / 2 + 2 * t - 1 < axis[a].n;
    for (int a = 0; a < 2; a++) {
        axis[a].halved = can[a] && (!can[1 - a] || h[a] <= alike * h[1 - a]);
        axis[a].coarse = axis[a].halved ? axis[a].n / 2 + 2 * t - 1 : axis[a].n;
    }
    return axis[RC_X].halved || axis[RC_Y].halved;
}

static void
set_reach(const struct rc_mlms_design *d, const struct rc_shape *shape, struct rc_mlms_axis axis[2])
{
    size_t k = 0;
    ptrdiff_t l = rc_mlms_extent(d, shape, axis, 0, false);

    while (rc_mlms_extent(d, shape, axis, k + 1, false) >= 0)
        k++;
    axis[RC_X].reach = k;
    axis[RC_Y].reach = (size_t)l;
    for (int a = 0; a < 2; a++)
        if (axis[RC_X].halved && axis[RC_Y].halved && axis[a].reach < 2 * d->t - 1 && !d->square)
            axis[a].reach = 2 * d->t - 1;
    for (int a = 0; a < 2; a++)
        axis[a].margin = axis[a].halved ? (axis[a].reach + 1) / 2 : axis[a].reach;
}

/* Products of one level in (10) to (17), and their approximate cost: corrections count half, because offsets
 * of both signs share a product. */
static double
level_terms(const struct rc_mlms_design *d, const struct rc_shape *shape,
            const struct rc_mlms_axis axis[2], double *work)
{
    double fine = 1, coarse = 1, even = 1, all, same, corrections, transfers = 0;

    for (int a = 0; a < 2; a++) {
        fine *= (double)axis[a].n;
        coarse *= (double)axis[a].coarse;
        even *= (double)((axis[a].n + axis[a].halved) >> axis[a].halved);
    }
    count(d, shape, axis, &all, &same);
    corrections = (fine - even) * all + coarse * (all - same);
    /* one direction after the other; the same for the interpolation back */
    if (axis[RC_Y].halved)
        transfers += 4 * (double)d->t * (double)axis[RC_X].n * (double)axis[RC_Y].n / 2;
    if (axis[RC_X].halved)
        transfers += 4 * (double)d->t * (double)axis[RC_X].n / 2 *
                     (double)(axis[RC_Y].halved ? axis[RC_Y].coarse : axis[RC_Y].n);
    *work = 0.6 * corrections + transfers + 10 * fine + 2e4;
    return corrections + transfers;
}

static double
direct_work(const struct rc_mlms_axis axis[2])
{
    double nx = (double)axis[RC_X].n, ny = (double)axis[RC_Y].n;

    return 0.75 * nx * ceil(nx / RC_STRIP) * RC_STRIP * ny * ny;
}

/* Coarsens as often as possible, then uses the number of levels with the lowest cost. */
static void
choose_levels(struct rc_mlms_design *d, const struct rc_shape *shape)
{
    double terms = 0, work = 0;

    memset(d->axis, 0, sizeof d->axis);
    d->axis[0][RC_X] = (struct rc_mlms_axis){.n = shape->nx, .step = 1};
    d->axis[0][RC_Y] = (struct rc_mlms_axis){.n = shape->ny, .step = 1};
    d->work = INFINITY;
    for (size_t q = 0;; q++) {
        struct rc_mlms_axis *axis = d->axis[q];
        double n = (double)axis[RC_X].n * (double)axis[RC_Y].n, more, direct = direct_work(axis);
        if (work + direct < d->work) {
            d->work = work + direct;
            d->terms = terms + n * n;
            d->levels = q;
        }
        if (q == RC_MLMS_LEVELS || !halve(axis, shape, d->t))
            break;
        set_reach(d, shape, axis);
        terms += level_terms(d, shape, axis, &more);
        work += more;
        for (int a = 0; a < 2; a++) {
            set_tiles(&axis[a]);
            d->axis[q + 1][a] =
                (struct rc_mlms_axis){.n = axis[a].coarse, .step = axis[a].step << axis[a].halved};
        }
    }
    for (int a = 0; a < 2; a++) {
        struct rc_mlms_axis *last = &d->axis[d->levels][a];
        *last = (struct rc_mlms_axis){.n = last->n, .coarse = last->n, .step = last->step};
        set_tiles(last);
    }
}

/* Starting a thread costs about as much as a few thousand nodes. */
static int
useful_threads(const struct rc_sum *sum)
{
    size_t most = 1 + sum->shape.nx * sum->shape.ny / 4096;
    size_t threads = sum->threads == 0 ? rc_threads_available() : sum->threads;

    return (int)(threads < most ? threads : most);
}

/* The cheapest order whose expected error is at most tol. */
static void
cheapest(struct rc_mlms_design *d, const struct rc_sum *sum, double tol)
{
    struct rc_mlms_design best = {.work = INFINITY};
    size_t first = sum->order > 0 ? sum->order : 2, last = sum->order > 0 ? sum->order : 24;

    for (size_t t = first; t <= last; t++) {
        d->t = t;
        d->reach = sum->correction > 0 ? sum->correction : reach_for(t, tol, &sum->shape);
        choose_levels(d, &sum->shape);
        if (d->work < best.work)
            best = *d;
    }
    *d = best;
}

static double
measured(const struct rc_mlms_design *d, const struct rc_sum *sum)
{
    static const double rounding = 1e-14;
    double one, all;

    rc_mlms_left_out(sum, d, &one, &all);
    return rounding + fmax(4 * all, fmin(many_over_one((double)d->t, (double)d->reach) * one,
                                         2 * one + 20 * all));
}

/* The expected error holds for one kernel. The error of the actual kernel is measured, and the tolerance of
 * the expectation is changed until the measured error fits. */
static void
fit(struct rc_mlms_design *d, const struct rc_sum *sum, double tol)
{
    struct rc_mlms_design best = {.work = INFINITY, .error = INFINITY};
    double ask = tol;

    for (int tries = 0; tries < 6; tries++) {
        bool fits;
        cheapest(d, sum, ask);
        d->error = measured(d, sum);
        fits = d->error <= tol;
        if (fits ? d->work < best.work || best.error > tol : d->error < best.error)
            best = *d;
        if (d->levels == 0 || (fits && d->error > tol / 30))
            break;
        ask *= 0.6 * tol / d->error;
        if (ask > 1 || ask < 1e-18)
            break;
    }
    if (best.work < INFINITY) /* otherwise memory is short, and allocating the plan will fail */
        *d = best;
}

bool
rc_mlms_design(const struct rc_sum *sum, struct rc_mlms_design *d, struct rc_err *err)
{
    static const double floor = 2e-14;

    if (rc_shape_check(&sum->shape, err) != RC_OK)
        return false;
    if (rc_repeats(sum->boundary) > 0) {
        rc_err_set(err, "the multi-level sum has no end on a periodic boundary: use fft");
        return false;
    }
    if (sum->order > RC_MLMS_HALF_MAX) {
        rc_err_set(err, "order %zu of the multi-level sum is more than %d", sum->order,
                   RC_MLMS_HALF_MAX);
        return false;
    }
    if (sum->order == 0 && sum->correction > 0) {
        rc_err_set(err, "a correction region of %zu nodes needs an order of the multi-level sum",
                   sum->correction);
        return false;
    }
    d->square = sum->correction > 0;
    if (d->square) {
        cheapest(d, sum, 1);
        d->error = measured(d, sum);
    } else {
        fit(d, sum, fmax(sum->tol, floor));
    }
    d->threads = useful_threads(sum);
    return true;
}
