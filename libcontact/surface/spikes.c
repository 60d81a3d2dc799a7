/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Spikes: nodes and small groups that stand alone, unlike the nodes of a groove, which has neighbours of the
 * same depth along its way.
 *
 * The height of a peak is the drop from its top to the level at which the nodes above it become more than a
 * small group: the difference between the map and its area opening (Vincent 1992). A groove or a ridge is
 * larger than that at its own depth, so that only its unevenness along the way remains. Pits are the peaks of
 * the map upside down.
 */
#include "libcontact/common.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "robust.h"

enum {
    MOST = 9,         /* nodes of a group on a map ...                       */
    MOST_PROFILE = 2, /* ... and on a profile, where four nodes are neighbours */
    FRONT = 8 * (MOST + 1),
    HALF = 4 /* nodes on either side of a peak in which the irregularity is measured */
};
/* Part of the limit that the other nodes of a group must exceed. */
static const double flank = 0.5;

struct group {
    size_t node[MOST], n; /* the top first */
    double sign, level;   /* 1: a peak, -1: a pit; of the heights, times the sign */
};

struct groups {
    struct group *v;
    size_t n, room;
};

struct map {
    const struct rc_shape *shape;
    struct rc_boundary boundary;
    const double *h;
    double sign; /* 1: peaks, -1: pits */
    size_t most; /* nodes of a group   */
};

/* The neighbour of node k in a direction from 0 to 7; the node itself beyond a free edge. */
static inline size_t
neighbour(const struct map *m, size_t k, int direction)
{
    static const int x[] = {-1, 0, 1, -1, 1, -1, 0, 1}, y[] = {-1, -1, -1, 0, 0, 1, 1, 1};
    const size_t nx = m->shape->nx, ny = m->shape->ny, i = k % nx, j = k / nx;
    const int a = x[direction], b = y[direction];

    if ((!m->boundary.x && ((i == 0 && a < 0) || (i + 1 == nx && a > 0))) ||
        (!m->boundary.y && ((j == 0 && b < 0) || (j + 1 == ny && b > 0))))
        return k;
    return (j + ny + (size_t)b) % ny * nx + (i + nx + (size_t)a) % nx;
}

static bool
among(const size_t *node, size_t n, size_t k)
{
    for (size_t q = 0; q < n; q++)
        if (node[q] == k)
            return true;
    return false;
}

/* Adds the highest neighbours one by one, until there are too many for a group. The level is the lowest of
 * them, and the group are those added before it: all others around it are lower. */
static void
grow(const struct map *m, size_t top, struct group *g)
{
    size_t in[MOST + 1] = {top}, front[FRONT], n = 1, ahead = 0;

    *g = (struct group){.node = {top}, .n = 1, .sign = m->sign, .level = m->sign * m->h[top]};
    for (;;) {
        size_t best = 0;
        for (int way = 0; way < 8; way++) {
            const size_t k = neighbour(m, in[n - 1], way);
            if (!isnan(m->h[k]) && !among(in, n, k) && !among(front, ahead, k))
                front[ahead++] = k;
        }
        if (ahead == 0) { /* an island between missing nodes has no neighbours to stand out from */
            g->n = 0;
            return;
        }
        for (size_t q = 1; q < ahead; q++)
            if (m->sign * m->h[front[q]] > m->sign * m->h[front[best]])
                best = q;
        in[n] = front[best];
        front[best] = front[--ahead];
        if (m->sign * m->h[in[n]] < g->level) {
            g->level = m->sign * m->h[in[n]];
            g->n = n;
        }
        if (++n > m->most)
            break;
    }
    for (size_t q = 0; q < g->n; q++)
        g->node[q] = in[q];
}

/* Of equal neighbours the first one is the top. */
static bool
is_top(const struct map *m, size_t k)
{
    if (isnan(m->h[k]))
        return false;
    for (int way = 0; way < 8; way++) {
        const size_t q = neighbour(m, k, way);
        const double rise = m->sign * (m->h[q] - m->h[k]);
        if (rise > 0 || (rise == 0 && q < k))
            return false;
    }
    return true;
}

static enum rc_status
store(struct groups *all, const struct group *g, struct rc_err *err)
{
    struct group *more;

    if (all->n == all->room) {
        const size_t room = 2 * all->room + 64;
        if ((more = realloc(all->v, room * sizeof *more)) == NULL)
            return rc_err_set(err, "out of memory for %zu groups of nodes", room);
        all->v = more;
        all->room = room;
    }
    all->v[all->n++] = *g;
    return RC_OK;
}

/* A group with several tops is that of its highest one, of equal ones of the first. */
static bool
is_highest(const struct map *m, const struct group *g)
{
    for (size_t q = 1; q < g->n; q++) {
        const double rise = m->sign * (m->h[g->node[q]] - m->h[g->node[0]]);
        if (rise > 0 || (rise == 0 && g->node[q] < g->node[0]))
            return false;
    }
    return true;
}

/* All groups higher than the limit, in the order of their nodes. */
static enum rc_status
find_groups(const struct map *m, double limit, struct groups *all, struct rc_err *err)
{
    struct group g;

    for (size_t k = 0; k < m->shape->nx * m->shape->ny; k++) {
        if (!is_top(m, k))
            continue;
        grow(m, k, &g);
        if (g.n > 0 && m->sign * m->h[k] - g.level > limit && is_highest(m, &g) &&
            store(all, &g, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

/* RMS around a node of the differences from the neighbours. */
static double
irregularity(const struct map *m, const double *d, size_t top)
{
    const ptrdiff_t nx = (ptrdiff_t)m->shape->nx, ny = (ptrdiff_t)m->shape->ny;
    const ptrdiff_t i = (ptrdiff_t)top % nx, j = (ptrdiff_t)top / nx;
    double sum = 0, n = 0;

    for (ptrdiff_t b = j - HALF; b <= j + HALF; b++)
        for (ptrdiff_t a = i - HALF; a <= i + HALF; a++) {
            double v;
            if ((!m->boundary.x && (a < 0 || a >= nx)) || (!m->boundary.y && (b < 0 || b >= ny)))
                continue;
            v = d[(b % ny + ny) % ny * nx + (a % nx + nx) % nx];
            sum += isnan(v) ? 0 : v * v;
            n += isnan(v) ? 0 : 1;
        }
    return n > 0 ? sqrt(sum / n) : 0;
}

/* Removes the groups that exceed the limit of their surroundings. d are the differences of a map without
 * groups. */
static size_t
remove_groups(const struct map *m, const struct groups *all, double times, double spread,
              const double *d, double *h)
{
    size_t count = 0;

    for (struct group *g = all->v; g < all->v + all->n; g++) {
        const double limit = times * fmax(spread, irregularity(m, d, g->node[0]));
        size_t kept = 0;
        if (g->sign * h[g->node[0]] - g->level > limit)
            for (size_t q = 0; q < g->n; q++)
                if (g->sign * h[g->node[q]] - g->level > flank * limit)
                    g->node[kept++] = g->node[q];
        g->n = kept;
    }
    for (const struct group *g = all->v; g < all->v + all->n; g++)
        for (size_t q = 0; q < g->n; q++) {
            count += isnan(h[g->node[q]]) ? 0 : 1;
            h[g->node[q]] = NAN;
        }
    return count;
}

enum rc_status
rc_spikes(const struct rc_shape *shape, double times, struct rc_boundary boundary, size_t threads,
          double *h, size_t *count, struct rc_err *err)
{
    const bool map = shape->nx >= 5 && shape->ny >= 5;
    struct map m = {shape, boundary, h, 1, map ? MOST : MOST_PROFILE};
    const size_t n = shape->nx * shape->ny;
    RC_OWNED double *d = NULL;
    RC_OWNED double *without = NULL;
    RC_OWNED struct group *found = NULL;
    struct groups all = {0};
    enum rc_status status;
    double spread, other;

    *count = 0;
    if (!(times > 0))
        return rc_err_set(err, "spikes beyond %g deviations: the number must be above 0", times);
    if ((d = rc_alloc(n, sizeof *d)) == NULL || (without = rc_alloc(n, sizeof *d)) == NULL)
        return rc_err_set(err, "out of memory for spikes among %zu heights", n);
    if (rc_median_differences(shape, boundary, threads, h, d, &spread, err) != RC_OK)
        return RC_FAIL;
    status = find_groups(&m, times * spread, &all, err);
    m.sign = -1;
    if (status == RC_OK)
        status = find_groups(&m, times * spread, &all, err);
    found = all.v;
    if (status != RC_OK || all.n == 0)
        return status;
    memcpy(without, h, n * sizeof *h);
    for (size_t g = 0; g < all.n; g++)
        for (size_t q = 0; q < found[g].n; q++)
            without[found[g].node[q]] = found[g].sign * found[g].level;
    if (rc_median_differences(shape, boundary, threads, without, d, &other, err) != RC_OK)
        return RC_FAIL;
    *count = remove_groups(&m, &all, times, spread, d, h);
    return RC_OK;
}
