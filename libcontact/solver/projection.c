/*
 * The way back into {0 <= p <= H, sum p = S}: the load is kept exactly while pressures stay in the
 * box, the constraint that scaling alone breaks.
 *
 * The Euclidean projection of y on it is clip(y + mu, 0, H) with one shift mu for all nodes. The
 * load phi(mu) = sum clip(y + mu, 0, H) is monotone and piecewise linear in the shift: Newton's
 * method inside a bracket finds it. In a step of the solver most nodes stay on the same piece for
 * every shift that can be meant: they are summed once, the others listed, and the search runs over
 * the list alone.
 */
#include "solver.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the shift ---- */

/* The load that is too much at one shift, and how it grows with it. */
struct excess {
    double load, slope;
};
typedef struct excess excess_at(void *ctx, double shift);

/* The shift between low and high where nothing is too much, from `start`; halved where Newton's
 * step leaves the bracket. `least`: a load that is nothing. */
static double
newton(excess_at *at, void *ctx, double low, double high, double start, double least)
{
    double mu = start;

    for (int round = 0; round < 200; round++) {
        struct excess e = at(ctx, mu);
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

static struct excess
excess_of_map(void *ctx, double shift)
{
    const struct map *m = ctx;
    struct excess e = {.load = -m->sum};

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
    mu = newton(excess_of_map, &map, low, high, fmin(fmax(0, low), high), 4 * DBL_EPSILON * sum);
    for (size_t k = 0; k < n; k++)
        y[k] = fmin(fmax(y[k] + mu, 0), hardness);
}

/* ---- of a step ---- */

struct search {
    struct rc_move *m;
    double within; /* shifts of at most this size are meant                            */
    double shift;
    double sum, count; /* of listed apart: nodes on the middle piece, and what they carry  */
    double wanted;     /* the load of the working set                                  */
};

enum {    /* sums of the first pass, */
    HELD, /* by nodes off W              */
    CARRIED,
    INNER, /* nodes of W inside the box   */
    OUTER, /* outside                     */
    WORKING,
    /* of the others */
    SUM = 0,
    COUNT
};

static inline double
target(const struct rc_move *m, size_t k)
{
    double d = (double)m->d[k];

    return m->solver->it.p[k] + (d != 0 ? m->alpha * (d - m->mean) : 0);
}

RC_CLONES static void
first_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_move *m = at;
    const struct rc_solver *s = m->solver;
    const double *p = s->it.p + first, hardness = s->posed.hardness;
    const double alpha = m->alpha, mean = m->mean;
    const unsigned char *w = s->set.w + first;
    const float *d = m->d + first;
    double held = 0, carried = 0;
    int inner = 0, outer = 0, working = 0;

#pragma omp simd reduction(+ : held, carried, inner, outer, working)
    for (size_t k = 0; k < n; k++) {
        double e = (double)d[k], y = p[k] + (e != 0 ? alpha * (e - mean) : 0);
        double c = y > 0 ? y : 0;
        bool in = w[k] != 0;
        c = c < hardness ? c : hardness;
        held += in ? 0 : p[k];
        carried += in ? c : 0;
        inner += in & (y > 0) & (y < hardness);
        outer += in & ((y < 0) | (y > hardness));
        working += in;
    }
    sums[HELD] = held;
    sums[CARRIED] = carried;
    sums[INNER] = inner;
    sums[OUTER] = outer;
    sums[WORKING] = working;
}

enum {
    NO_MORE = UINT16_MAX /* ends the list of a block */
};

/* Lists the nodes of a block that may change their piece, by their places in it. */
static void
list_block(void *at, size_t first, size_t n, double *sums)
{
    const struct search *q = at;
    const struct rc_solver *s = q->m->solver;
    double within = q->within, hardness = s->posed.hardness;
    uint16_t *list = q->m->list + first;
    size_t listed = 0;

    for (size_t k = 0; k < n; k++) {
        double y;
        if (!s->set.w[first + k])
            continue;
        y = target(q->m, first + k);
        if (y > within && y < hardness - within) {
            sums[SUM] += y;
            sums[COUNT]++;
        } else if (y > hardness + within) {
            sums[SUM] += hardness;
        } else if (y >= -within) {
            list[listed++] = (uint16_t)k;
        }
    }
    if (listed < n)
        list[listed] = NO_MORE;
}

static void
sum_block(void *at, size_t first, size_t n, double *sums)
{
    const struct search *q = at;
    const uint16_t *list = q->m->list + first;
    double hardness = q->m->solver->posed.hardness;

    for (size_t k = 0; k < n && list[k] != NO_MORE; k++) {
        double y = target(q->m, first + list[k]) + q->shift;
        sums[SUM] += y > 0 ? y < hardness ? y : hardness : 0;
        sums[COUNT] += y > 0 && y < hardness;
    }
}

static struct excess
excess_of_step(void *ctx, double shift)
{
    struct search *q = ctx;
    double total[RC_SUMS];

    q->shift = shift;
    rc_reduce_blocks(q->m->solver, sum_block, q, total);
    return (struct excess){.load = total[SUM] + q->sum + q->count * shift - q->wanted,
                           .slope = total[COUNT] + q->count};
}

void
rc_move_find(struct rc_move *m)
{
    struct rc_solver *s = m->solver;
    struct search q = {.m = m};
    double total[RC_SUMS], excess, load = s->load.sum;

    m->shift = 0;
    rc_reduce_blocks(s, first_block, m, total);
    m->clipped = total[OUTER] > 0;
    if (!m->clipped && fabs(total[HELD] + total[CARRIED] - load) <= 1e-14 * load)
        return;
    q.wanted = load - total[HELD];
    if (!(q.wanted > 0 && q.wanted <= s->posed.hardness * total[WORKING])) {
        rc_working_set_all(s);
        rc_reduce_blocks(s, first_block, m, total);
        m->clipped = true;
        q.wanted = load;
    }
    excess = total[CARRIED] - q.wanted;
    m->shift = total[INNER] > 0 ? -excess / total[INNER] : 0;
    q.within = m->shift != 0 ? 4 * fabs(m->shift) : load / (double)s->posed.n;
    for (int round = 0; round<40; round++, q.within *= round> 20 ? 1e10 : 16) {
        rc_reduce_blocks(s, list_block, &q, total);
        q.sum = total[SUM];
        q.count = total[COUNT];
        m->shift = newton(excess_of_step, &q, -q.within, q.within,
                          fabs(m->shift) < q.within ? m->shift : 0, 4 * DBL_EPSILON * load);
        if (fabs(m->shift) < 0.999 * q.within)
            break;
    }
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
