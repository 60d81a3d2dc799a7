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
#include <stdlib.h>
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
    size_t n;
    const double *y;
    double hardness, sum;
};

static struct rc_excess
excess_of_map(void *ctx, double shift)
{
    const struct map *m = ctx;
    struct rc_excess e = {.load = -m->sum};

    for (size_t k = 0; k < m->n; k++) {
        double v = m->y[k] + shift;
        e.load += fmin(fmax(v, 0), m->hardness);
        e.slope += v > 0 && v < m->hardness;
    }
    return e;
}

void
rc_projection_of(size_t n, double hardness, double sum, double *y)
{
    struct map map = {.n = n, .y = y, .hardness = hardness, .sum = sum};
    double least = INFINITY, most = -INFINITY, low, high, mu;

    for (size_t k = 0; k < n; k++) {
        least = fmin(least, y[k]);
        most = fmax(most, y[k]);
    }
    low = -most; /* nothing above 0 */
    high = isinf(hardness) ? sum / (double)n - least : hardness - least;
    mu = rc_newton(excess_of_map, &map, low, high, fmin(fmax(0, low), high), 4 * DBL_EPSILON * sum);
    for (size_t k = 0; k < n; k++)
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

/* Factor f with sum over the elastic nodes of min(f p, H) = target. A node that reaches the bound
 * at one factor stays there at every larger one, so each round fixes some and the rest is linear. */
static void
scale_elastic(size_t n, double hardness, double target, double *p)
{
    for (;;) {
        double free_sum = 0, error = 0, f;
        bool capped = false;

        for (size_t k = 0; k < n; k++)
            if (p[k] > 0 && p[k] < hardness) {
                double y = p[k] - error, t = free_sum + y; /* Kahan */
                error = (t - free_sum) - y;
                free_sum = t;
            }
        if (!(free_sum > 0))
            return;
        f = target / free_sum;
        for (size_t k = 0; k < n && f > 1; k++)
            if (p[k] > 0 && p[k] < hardness && f * p[k] >= hardness) {
                p[k] = hardness;
                target -= hardness;
                capped = true;
            }
        if (capped)
            continue;
        for (size_t k = 0; k < n; k++)
            if (p[k] > 0 && p[k] < hardness)
                p[k] *= f;
        return;
    }
}

struct candidate {
    double g;
    size_t k;
};

static int
by_gap(const void *a, const void *b)
{
    const struct candidate *x = a, *y = b;

    if (x->g != y->g)
        return x->g < y->g ? -1 : 1;
    return x->k < y->k ? -1 : 1;
}

/* All loaded nodes, if any, are at the bound and `rest` is still missing: nodes join by their gap. */
static enum rc_status
add_nodes(size_t n, double hardness, double rest, const double *g, double *p, struct rc_err *err)
{
    struct candidate *list = NULL;
    size_t count = 0, c = 0;

    for (size_t k = 0; k < n; k++)
        count += p[k] <= 0;
    list = malloc((count + 1) * sizeof *list);
    if (list == NULL)
        return rc_err_set(err, "out of memory for %zu nodes", count);
    for (size_t k = 0; k < n; k++)
        if (p[k] <= 0)
            list[c++] = (struct candidate){.g = g[k], .k = k};
    qsort(list, count, sizeof *list, by_gap);
    for (c = 0; c < count && rest > (isinf(hardness) ? 0 : 4 * DBL_EPSILON * hardness); c++) {
        p[list[c].k] = rest < hardness ? rest : hardness;
        rest -= p[list[c].k];
    }
    free(list);
    return RC_OK;
}

/* The nodes at the bound carry too much by themselves. */
static void
scale_all(size_t n, double sum, double *p)
{
    double f = sum / rc_sum(p, n);

    for (size_t k = 0; k < n; k++)
        p[k] *= f;
}

enum rc_status
rc_projection_balance(size_t n, double hardness, double sum, const double *g, double *p,
                      struct rc_err *err)
{
    size_t elastic = 0, full = 0;
    double target;

    for (size_t k = 0; k < n; k++) {
        elastic += p[k] > 0 && p[k] < hardness;
        full += p[k] >= hardness;
    }
    target = full == 0 ? sum : sum - hardness * (double)full;
    if (elastic == 0 && fabs(target) <= 4 * DBL_EPSILON * sum)
        return RC_OK; /* every loaded node at the bound, and that is the load */
    if (elastic > 0 && target > 0 && target <= hardness * (double)elastic) {
        scale_elastic(n, hardness, target, p);
        return RC_OK;
    }
    if (elastic + full == 0 || target > hardness * (double)elastic) {
        for (size_t k = 0; k < n; k++)
            if (p[k] > 0)
                p[k] = hardness;
        return add_nodes(n, hardness,
                         elastic + full == 0 ? sum : sum - hardness * (double)(elastic + full), g,
                         p, err);
    }
    scale_all(n, sum, p);
    return RC_OK;
}

enum rc_status
rc_projection_restore(struct rc_solver *s, double carried, struct rc_err *err)
{
    if (fabs(carried - s->load.sum) <= 1e-14 * s->load.sum)
        return RC_OK;
    return rc_projection_balance(s->posed.n, s->posed.hardness, s->load.sum, s->it.v, s->it.p, err);
}
