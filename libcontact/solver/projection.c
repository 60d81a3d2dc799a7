/*
 * The way back into {0 <= p <= H, sum p = S}: the load is kept exactly while pressures stay in the
 * box, the constraint that scaling alone breaks.
 *
 * The Euclidean projection of y on it is clip(y + mu, 0, H) with one shift mu for all nodes. The
 * load phi(mu) = sum clip(y + mu, 0, H) is monotone and piecewise linear in the shift: Newton's
 * method inside a bracket finds it. tiles.c has the way back that most steps take.
 */
#include "solver.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- the shift ---- */

/* The bracket is halved where Newton's step leaves it. */
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
    double hardness = m->s->posed.hardness;

    for (size_t k = first; k < first + n; k++) {
        double v = m->y[k] + m->shift;
        sums[LOAD] += fmin(fmax(v, 0), hardness);
        sums[ELASTIC] += v > 0 && v < hardness;
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

void
rc_projection_of(const struct rc_solver *s, double *y)
{
    struct map map = {.s = s, .y = y};
    double least = INFINITY, most = -INFINITY, low, high, mu, hardness = s->posed.hardness;
    double sum = s->load.sum;

    for (size_t k = 0; k < s->posed.n; k++) {
        least = fmin(least, y[k]);
        most = fmax(most, y[k]);
    }
    most = rc_ranks_most(s->posed.rows.ranks, most);
    least = -rc_ranks_most(s->posed.rows.ranks, -least);
    low = -most; /* nothing above 0 */
    high = isinf(hardness) ? sum / (double)s->posed.nodes - least : hardness - least;
    mu = rc_newton(excess_of_map, &map, low, high, fmin(fmax(0, low), high), 4 * DBL_EPSILON * sum);
    for (size_t k = 0; k < s->posed.n; k++)
        y[k] = fmin(fmax(y[k] + mu, 0), hardness);
}

/* ---- of a step ---- */

/* What the passes over all nodes share: on W p becomes y = p + alpha (d - mean), then
 * clip(y + shift, 0, H). */
struct step {
    struct rc_move *m;
    double shift, wanted;
};

enum {    /* sums of the first pass, */
    HELD, /* by nodes off W          */
    WORKING,
    /* of the others */
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

    for (size_t k = first; k < first + n; k++) {
        if (!s->set.w[k]) {
            sums[HELD] += s->it.p[k];
            continue;
        }
        sums[WORKING]++;
        s->it.p[k] += way(c->m, k);
        sums[RC_MOST] = fmax(sums[RC_MOST], fabs(s->it.p[k]));
    }
}

static void
carried_block(void *at, size_t first, size_t n, double *sums)
{
    const struct step *c = at;
    const struct rc_solver *s = c->m->solver;
    double hardness = s->posed.hardness;

    for (size_t k = first; k < first + n; k++) {
        double y = s->it.p[k] + c->shift;
        if (!s->set.w[k])
            continue;
        sums[CARRIED] += y > 0 ? y < hardness ? y : hardness : 0;
        sums[COUNT] += y > 0 && y < hardness;
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
        to = fmin(fmax(y + c->shift, 0), s->posed.hardness);
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
    struct step c = {.m = m};
    double total[RC_SUMS], high;

    rc_reduce_blocks(s, aim_block, &c, total);
    c.wanted = s->load.sum - total[HELD];
    if (!(c.wanted > 0 && c.wanted <= s->posed.hardness * total[WORKING])) {
        rc_working_set_all(s);
        c.wanted = s->load.sum;
    }
    high = (isinf(s->posed.hardness) ? s->load.sum : s->posed.hardness) + total[RC_MOST];
    c.shift = rc_newton(excess_of_step, &c, -high, high, 0, 4 * DBL_EPSILON * s->load.sum);
    rc_reduce_blocks(s, settle_block, &c, total);
    m->size = total[SIZE];
    m->clipped = true;
}

/* ---- by scaling ---- */

struct scale {
    struct rc_solver *s;
    double f;
    bool cap; /* nodes that the factor brings to the bound go there; else all are multiplied */
    const double *g;
    double least, most; /* gaps between which nodes are counted */
};

/* Of the elastic nodes; sums[1]: how many would reach the bound with the factor f. */
static void
elastic_block(void *at, size_t first, size_t n, double *sums)
{
    const struct scale *c = at;
    struct rc_total sum = {0};

    for (size_t k = first; k < first + n; k++)
        if (rc_elastic(c->s, k)) {
            rc_total_add(&sum, c->s->it.p[k]);
            sums[1] += c->f > 1 && c->f * c->s->it.p[k] >= c->s->posed.hardness;
        }
    sums[0] = rc_total_value(&sum);
}

static void
multiply_block(void *at, size_t first, size_t n, double *sums)
{
    const struct scale *c = at;
    double *p = c->s->it.p, hardness = c->s->posed.hardness;

    (void)sums;
    for (size_t k = first; k < first + n; k++)
        if (rc_elastic(c->s, k) && (!c->cap || c->f * p[k] >= hardness))
            p[k] = c->cap ? hardness : c->f * p[k];
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
        target -= capped * s->posed.hardness;
    } while (capped > 0);
}

/* Nodes without pressure whose gap is at least `least` and at most `most`. */
static void
count_block(void *at, size_t first, size_t n, double *sums)
{
    const struct scale *c = at;

    for (size_t k = first; k < first + n; k++)
        sums[0] += c->s->it.p[k] <= 0 && c->g[k] >= c->least && c->g[k] <= c->most;
}

static double
count_gaps(struct scale *c, double least, double most)
{
    double total[RC_SUMS];

    c->least = least;
    c->most = most;
    rc_reduce_blocks(c->s, count_block, c, total);
    return total[0];
}

/* Doubles in their order as whole numbers, and back. */
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

/* The gap of the last node that joins when `wanted` do: bisection over all doubles. */
static double
last_gap(struct scale *c, double wanted)
{
    int64_t low = rank_of(-INFINITY), high = rank_of(INFINITY);

    while (low < high) {
        int64_t middle = low + (int64_t)(((uint64_t)high - (uint64_t)low) / 2);
        if (count_gaps(c, -INFINITY, of_rank(middle)) >= wanted)
            high = middle;
        else
            low = middle + 1;
    }
    return of_rank(low);
}

/* Nodes without pressure of just this gap in rows that are held before those here. */
static double
equal_before(const struct scale *c, double gap)
{
    size_t here = 0;

    if (c->s->posed.rows.ranks == NULL)
        return 0;
    for (size_t k = 0; k < c->s->posed.n; k++)
        here += c->s->it.p[k] <= 0 && c->g[k] == gap;
    return (double)rc_ranks_sum_before(c->s->posed.rows.ranks, here);
}

/* All loaded nodes, if any, are at the bound and `rest` is still missing: nodes join by their gap, those of
 * equal gap by their place. All but the last come to the bound. */
static void
add_nodes(struct rc_solver *s, double rest, const double *g)
{
    double hardness = s->posed.hardness, wanted = 1, part = rest, last, before, equal;
    struct scale c = {.s = s, .g = g};

    if (!isinf(hardness)) {
        wanted = ceil(rest / hardness - 4 * DBL_EPSILON);
        part = rest - (wanted - 1) * hardness;
    }
    if (!(wanted > 0))
        return;
    wanted = fmin(wanted, count_gaps(&c, -INFINITY, INFINITY));
    last = last_gap(&c, wanted);
    before = count_gaps(&c, -INFINITY, last) - count_gaps(&c, last, last);
    equal = wanted - before - equal_before(&c, last); /* of this gap, those here that join */
    for (size_t k = 0; k < s->posed.n; k++) {
        if (s->it.p[k] > 0 || g[k] > last)
            continue;
        if (g[k] < last)
            s->it.p[k] = hardness;
        else if (equal-- > 0)
            s->it.p[k] = equal == 0 ? fmin(part, hardness) : hardness;
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
        c->s->it.p[k] *= c->f;
}

/* The nodes at the bound carry too much by themselves. */
static void
scale_all(struct rc_solver *s)
{
    struct scale c = {.s = s};
    double total[RC_SUMS];

    rc_reduce_blocks(s, pressure_block, &c, total);
    c.f = s->load.sum / total[0];
    rc_reduce_blocks(s, times_block, &c, total);
}

enum { /* nodes */
    IN_BETWEEN,
    FULL
};

static void
stand_block(void *at, size_t first, size_t n, double *sums)
{
    const struct scale *c = at;

    for (size_t k = first; k < first + n; k++) {
        sums[IN_BETWEEN] += rc_elastic(c->s, k);
        sums[FULL] += c->s->it.p[k] >= c->s->posed.hardness;
    }
}

void
rc_projection_balance(struct rc_solver *s, const double *g)
{
    struct scale c = {.s = s};
    double total[RC_SUMS], hardness = s->posed.hardness, sum = s->load.sum, elastic, full, target;

    rc_reduce_blocks(s, stand_block, &c, total);
    elastic = total[IN_BETWEEN];
    full = total[FULL];
    target = full == 0 ? sum : sum - hardness * full;
    if (elastic == 0 && fabs(target) <= 4 * DBL_EPSILON * sum)
        return; /* every loaded node at the bound, and that is the load */
    if (elastic > 0 && target > 0 && target <= hardness * elastic) {
        scale_elastic(s, target);
        return;
    }
    if (elastic + full == 0 || target > hardness * elastic) {
        for (size_t k = 0; k < s->posed.n; k++)
            if (s->it.p[k] > 0)
                s->it.p[k] = hardness;
        add_nodes(s, elastic + full == 0 ? sum : sum - hardness * (elastic + full), g);
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
