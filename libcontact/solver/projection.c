/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Returns pressures to {0 <= p <= H, sum p = S}: keeps the load exactly and the pressures within their
 * bounds, which scaling alone does not.
 *
 * The Euclidean projection of y on this set is clip(y + mu, 0, H) with one shift mu for all nodes. The load
 * phi(mu) = sum clip(y + mu, 0, H) is monotone and piecewise linear in the shift: Newton's method inside a
 * bracket finds it. Most steps use tiles.c instead.
 */
#include "solver.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- the shift ---- */

/* Newton's method; where a step leaves the bracket, the bracket is halved. */
double
rc_newton(rc_excess_at *at, void *ctx, double low, double high, double start, double least)
{
    double mu = start;

    for (int round = 0; round < 200; round++) {
        struct rc_excess e = at(ctx, mu);
        double next;

        if (fabs(e.load) <= least)
            break;
        if (e.load > 0)
            high = mu;
        else
            low = mu;
        next = mu - e.load / e.slope;
        if (!(next > low && next < high))
            next = (low + high) / 2;
        if (next == mu)
            break;
        mu = next;
    }
    return mu;
}

/* ---- of a map ---- */

struct map {
    const struct rc_solver *s;
    double *y, shift;
};

enum { /* sums of a map */
    LOAD,
    ELASTIC
};

static void
load_block(void *at, size_t first, size_t n, double *sums)
{
    const struct map *m = at;
    const struct rc_box box = rc_box(m->s, 0);

    for (size_t k = first; k < first + n; k++) {
        double v = m->y[k] + m->shift;
        sums[LOAD] += rc_clip(box, k, v);
        sums[ELASTIC] += rc_between(box, k, v);
    }
}

static struct rc_excess
excess_of_map(void *ctx, double shift)
{
    struct map *m = ctx;
    double total[RC_SUMS];

    m->shift = shift;
    rc_reduce_blocks(m->s, load_block, m, total);
    return (struct rc_excess){.load = total[LOAD] - m->s->load.sum, .slope = total[ELASTIC]};
}

/* Where the load equals the sum of the upper bounds, puts all nodes at their upper bounds. */
static bool
fill(const struct rc_solver *s, double *y)
{
    const struct rc_box box = rc_box(s, 0);

    if (s->load.sum < s->posed.bounds.full)
        return false;
    for (size_t k = 0; k < s->posed.n; k++)
        y[k] = rc_high(box, k);
    return true;
}

void
rc_projection_of(const struct rc_solver *s, double *y)
{
    struct map map = {.s = s, .y = y};
    const struct rc_bounds *bounds = &s->posed.bounds;
    double least = INFINITY, most = -INFINITY, low, high, mu, sum = s->load.sum;
    struct rc_box box;

    if (fill(s, y))
        return;
    for (size_t k = 0; k < s->posed.n; k++) {
        least = fmin(least, y[k]);
        most = fmax(most, y[k]);
    }
    most = rc_ranks_most(s->posed.rows.ranks, most);
    least = -rc_ranks_most(s->posed.rows.ranks, -least);
    low = bounds->box.low - most; /* no node is above its lower bound */
    high = bounds->box.low + rc_reach(bounds, rc_above(bounds, sum)) - least;
    mu = rc_newton(excess_of_map, &map, low, high, fmin(fmax(0, low), high), 4 * DBL_EPSILON * sum);
    box = rc_box_rounded(bounds->box, fmax(most, -least));
    for (size_t k = 0; k < s->posed.n; k++)
        y[k] = rc_settled(box, k, y[k] + mu);
}

/* ---- of a step ---- */

/* Context of the passes over all nodes: on W p becomes y = p + alpha (d - mean), and then clip(y + shift, 0,
 * H). Loads count from the lower bounds. */
struct step {
    struct rc_move *m;
    struct rc_box box;
    double shift, wanted;
};

enum {    /* sums of the first pass */
    HELD, /* load of nodes off W */
    ROOM,
    /* sums of the later passes */
    CARRIED = 0,
    COUNT,
    SIZE = 0
};

static inline double
way(const struct rc_move *m, size_t k)
{
    double d = (double)m->d[k];

    return d != 0 ? m->alpha * (d - m->mean) : 0;
}

static void
aim_block(void *at, size_t first, size_t n, double *sums)
{
    const struct step *c = at;
    const struct rc_solver *s = c->m->solver;
    const struct rc_box box = rc_box(s, 0);

    for (size_t k = first; k < first + n; k++) {
        if (!s->set.w[k]) {
            sums[HELD] += s->it.p[k] - rc_low(box, k);
            continue;
        }
        sums[ROOM] += rc_room(box, k);
        s->it.p[k] += way(c->m, k);
        sums[RC_MOST] = fmax(sums[RC_MOST], fabs(s->it.p[k]));
    }
}

static void
carried_block(void *at, size_t first, size_t n, double *sums)
{
    const struct step *c = at;
    const struct rc_solver *s = c->m->solver;
    const struct rc_box box = rc_box(s, 0);

    for (size_t k = first; k < first + n; k++) {
        double y = s->it.p[k] + c->shift;
        if (!s->set.w[k])
            continue;
        sums[CARRIED] += rc_clip(box, k, y) - rc_low(box, k);
        sums[COUNT] += rc_between(box, k, y);
    }
}

static struct rc_excess
excess_of_step(void *ctx, double shift)
{
    struct step *c = ctx;
    double total[RC_SUMS];

    c->shift = shift;
    rc_reduce_blocks(c->m->solver, carried_block, c, total);
    return (struct rc_excess){.load = total[CARRIED] - c->wanted, .slope = total[COUNT]};
}

static void
settle_block(void *at, size_t first, size_t n, double *sums)
{
    const struct step *c = at;
    const struct rc_solver *s = c->m->solver;

    for (size_t k = first; k < first + n; k++) {
        double y = s->it.p[k], to, change;
        c->m->delta[k] = 0;
        if (!s->set.w[k])
            continue;
        to = rc_settled(c->box, k, y + c->shift);
        change = to - (y - way(c->m, k));
        s->it.p[k] = to;
        c->m->delta[k] = (float)(change * s->load.per_pressure);
        sums[SIZE] += fabs(change);
    }
}

void
rc_move_shift(struct rc_move *m)
{
    struct rc_solver *s = m->solver;
    const struct rc_bounds *bounds = &s->posed.bounds;
    struct step c = {.m = m};
    double total[RC_SUMS], all = rc_above(bounds, s->load.sum), high;

    rc_reduce_blocks(s, aim_block, &c, total);
    c.wanted = all - total[HELD];
    if (!(c.wanted > 0 && c.wanted <= rc_rooms(bounds, total[ROOM]))) {
        rc_working_set_all(s);
        c.wanted = all;
    }
    c.box = rc_box_rounded(bounds->box, total[RC_MOST]);
    high = rc_reach(bounds, all) + fabs(bounds->box.low) + total[RC_MOST];
    c.shift = rc_newton(excess_of_step, &c, -high, high, 0, 4 * DBL_EPSILON * s->load.sum);
    rc_reduce_blocks(s, settle_block, &c, total);
    m->size = total[SIZE];
    m->clipped = true;
}

/* ---- by scaling ---- */

/* Scales what nodes carry above their lower bounds. */
struct scale {
    struct rc_solver *s;
    double f;
    /* true: only nodes that would reach their bound move, to the bound; false: all elastic nodes are
     * multiplied */
    bool cap;
    const double *g;
    double least, most; /* nodes with gaps between these join */
};

static inline double
scaled(const struct scale *c, struct rc_box box, size_t k)
{
    double low = rc_low(box, k);

    return low + c->f * (c->s->it.p[k] - low);
}

/* sums[0]: load of the elastic nodes; sums[1]: rooms of the elastic nodes that would reach the
 * bound with the factor f. */
static void
elastic_block(void *at, size_t first, size_t n, double *sums)
{
    const struct scale *c = at;
    const struct rc_box box = rc_box(c->s, 0);
    struct rc_total sum = {0};

    for (size_t k = first; k < first + n; k++)
        if (rc_elastic(c->s, k)) {
            rc_total_add(&sum, c->s->it.p[k] - rc_low(box, k));
            if (c->f > 1 && rc_at_high(box, k, scaled(c, box, k)))
                sums[1] += rc_room(box, k);
        }
    sums[0] = rc_total_value(&sum);
}

static void
multiply_block(void *at, size_t first, size_t n, double *sums)
{
    const struct scale *c = at;
    const struct rc_box box = rc_box(c->s, 0);

    (void)sums;
    for (size_t k = first; k < first + n; k++) {
        double to = scaled(c, box, k);
        if (rc_elastic(c->s, k) && (!c->cap || rc_at_high(box, k, to)))
            c->s->it.p[k] = c->cap ? rc_high(box, k) : rc_settled(box, k, to);
    }
}

/* Factor f with sum over the elastic nodes of min(f p, H) = target. A node that reaches the bound
 * at one factor stays there at every larger one, so each round fixes some and the rest is linear. */
static void
scale_elastic(struct rc_solver *s, double target)
{
    struct scale c = {.s = s};
    double total[RC_SUMS], capped;

    do {
        c.f = 0;
        rc_reduce_blocks(s, elastic_block, &c, total);
        if (!(total[0] > 0))
            return;
        c.f = target / total[0];
        rc_reduce_blocks(s, elastic_block, &c, total);
        capped = total[1];
        c.cap = capped > 0;
        rc_reduce_blocks(s, multiply_block, &c, total);
        target -= rc_rooms(&s->posed.bounds, capped);
    } while (capped > 0);
}

/* True if a node without pressure has a gap between `least` and `most`. */
static bool
may_join(const struct scale *c, struct rc_box box, size_t k, double least, double most)
{
    return rc_at_low(box, k, c->s->it.p[k]) && c->g[k] >= least && c->g[k] <= most;
}

static void
room_block(void *at, size_t first, size_t n, double *sums)
{
    const struct scale *c = at;
    const struct rc_box box = rc_box(c->s, 0);

    for (size_t k = first; k < first + n; k++)
        if (may_join(c, box, k, c->least, c->most))
            sums[0] += rc_room(box, k);
}

/* Sum of the rooms of these nodes. */
static double
room_of_gaps(struct scale *c, double least, double most)
{
    double total[RC_SUMS];

    c->least = least;
    c->most = most;
    rc_reduce_blocks(c->s, room_block, c, total);
    return total[0];
}

/* Order of a double among all doubles as a whole number, and its inverse. */
static int64_t
rank_of(double v)
{
    int64_t bits;

    memcpy(&bits, &v, sizeof bits);
    return bits < 0 ? INT64_MIN - bits : bits;
}

static double
of_rank(int64_t rank)
{
    int64_t bits = rank < 0 ? INT64_MIN - rank : rank;
    double v;

    memcpy(&v, &bits, sizeof v);
    return v;
}

/* The gap of the last node that joins when the sum of rooms must be `wanted`: bisection over all doubles. */
static double
last_gap(struct scale *c, double wanted)
{
    int64_t low = rank_of(-INFINITY), high = rank_of(INFINITY);

    while (low < high) {
        int64_t middle = low + (int64_t)(((uint64_t)high - (uint64_t)low) / 2);
        if (room_of_gaps(c, -INFINITY, of_rank(middle)) >= wanted)
            high = middle;
        else
            low = middle + 1;
    }
    return of_rank(low);
}

/* Sum of the rooms of nodes without pressure and with exactly this gap, in the rows before those held
 * here. */
static double
equal_before(const struct scale *c, double gap)
{
    const struct rc_box box = rc_box(c->s, 0);
    double here = 0;

    if (c->s->posed.rows.ranks == NULL)
        return 0;
    for (size_t k = 0; k < c->s->posed.n; k++)
        if (may_join(c, box, k, gap, gap))
            here += rc_room(box, k);
    return rc_ranks_sum_before(c->s->posed.rows.ranks, here);
}

/* All loaded nodes, if any, are at their upper bounds and `rest` is still missing. Nodes without pressure
 * join in the order of their gap; nodes of equal gap in the order of the map. All but the last one reach
 * their upper bounds. */
static void
add_nodes(struct rc_solver *s, double rest, const double *g)
{
    const struct rc_bounds *bounds = &s->posed.bounds;
    const struct rc_box box = rc_box(s, 0);
    double wanted = rc_bounded(bounds) ? rest / bounds->unit - 4 * DBL_EPSILON : 1, last, taken;
    struct scale c = {.s = s, .g = g};

    if (!(wanted > 0))
        return;
    last = last_gap(&c, fmin(wanted, room_of_gaps(&c, -INFINITY, INFINITY)));
    taken = room_of_gaps(&c, -INFINITY, of_rank(rank_of(last) - 1)) + equal_before(&c, last);
    for (size_t k = 0; k < s->posed.n; k++) {
        if (!rc_at_low(box, k, s->it.p[k]) || g[k] > last)
            continue;
        if (g[k] < last) {
            s->it.p[k] = rc_high(box, k);
        } else if (taken < wanted) { /* only some of the nodes of this gap join */
            s->it.p[k] = rc_settled(box, k, rc_low(box, k) + rest - rc_rooms(bounds, taken));
            taken += rc_room(box, k);
        }
    }
}

static void
pressure_block(void *at, size_t first, size_t n, double *sums)
{
    const struct scale *c = at;

    sums[0] = rc_sum(c->s->it.p + first, n);
}

static void
times_block(void *at, size_t first, size_t n, double *sums)
{
    const struct scale *c = at;

    (void)sums;
    for (size_t k = first; k < first + n; k++)
        c->s->it.p[k] = scaled(c, rc_box(c->s, 0), k);
}

/* Scales all nodes, because the nodes at the bound alone exceed the load. */
static void
scale_all(struct rc_solver *s)
{
    struct scale c = {.s = s};
    double total[RC_SUMS];

    rc_reduce_blocks(s, pressure_block, &c, total);
    c.f = rc_above(&s->posed.bounds, s->load.sum) / rc_above(&s->posed.bounds, total[0]);
    rc_reduce_blocks(s, times_block, &c, total);
}

enum { /* rooms of nodes */
    IN_BETWEEN,
    FULL
};

static void
stand_block(void *at, size_t first, size_t n, double *sums)
{
    const struct scale *c = at;
    const struct rc_box box = rc_box(c->s, 0);

    for (size_t k = first; k < first + n; k++) {
        double p = c->s->it.p[k];
        sums[IN_BETWEEN] += rc_between(box, k, p) ? rc_room(box, k) : 0;
        sums[FULL] += rc_at_high(box, k, p) ? rc_room(box, k) : 0;
    }
}

void
rc_projection_balance(struct rc_solver *s, const double *g)
{
    const struct rc_bounds *bounds = &s->posed.bounds;
    const struct rc_box box = rc_box(s, 0);
    struct scale c = {.s = s};
    double total[RC_SUMS], sum = rc_above(bounds, s->load.sum), elastic, full, target;

    if (fill(s, s->it.p))
        return;
    rc_reduce_blocks(s, stand_block, &c, total);
    elastic = rc_rooms(bounds, total[IN_BETWEEN]);
    full = rc_rooms(bounds, total[FULL]);
    target = sum - full;
    if (fabs(target) <= 1e-14 * sum)
        target = 0; /* the nodes at the bound carry the whole load */
    if (elastic == 0 && target == 0)
        return;
    if (elastic > 0 && target >= 0 && target <= elastic) {
        scale_elastic(s, target);
        return;
    }
    if (elastic + full == 0 || target > elastic) {
        for (size_t k = 0; k < s->posed.n; k++)
            if (!rc_at_low(box, k, s->it.p[k]))
                s->it.p[k] = rc_high(box, k);
        add_nodes(s, sum - (elastic + full), g);
        return;
    }
    scale_all(s);
}

void
rc_projection_restore(struct rc_solver *s, double carried)
{
    if (fabs(carried - s->load.sum) > 1e-14 * s->load.sum)
        rc_projection_balance(s, s->it.v);
}
