/*
 * phi(mu) = sum over W of clip(y + mu, 0, H) - S is monotone and piecewise linear. Most nodes stay
 * on the same piece for every shift that can be meant: they are summed once, the others listed, and
 * Newton's method inside a bracket runs over the list alone.
 */
#include "solver.h"

#include <float.h>
#include <math.h>
#include <string.h>

struct search {
    struct rc_move *m;
    double within; /* shifts of at most this size are meant                            */
    double shift;
    double sum, count; /* of listed apart: nodes on the middle piece, and what they carry  */
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

    return m->solver->p[k] + (d != 0 ? m->alpha * (d - m->mean) : 0);
}

RC_CLONES static void
first_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_move *m = at;
    const struct rc_solver *s = m->solver;
    const double *p = s->p + first, hardness = s->hardness, alpha = m->alpha, mean = m->mean;
    const unsigned char *w = s->w + first;
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

/* Lists the nodes of a block that may change their piece, at its own place in the room, and
 * closes the list with a NAN where there is room left. */
static void
list_block(void *at, size_t first, size_t n, double *sums)
{
    const struct search *q = at;
    const struct rc_solver *s = q->m->solver;
    double *list = q->m->room + first, within = q->within;
    size_t listed = 0;

    for (size_t k = first; k < first + n; k++) {
        double y;
        if (!s->w[k])
            continue;
        y = target(q->m, k);
        if (y > within && y < s->hardness - within) {
            sums[SUM] += y;
            sums[COUNT]++;
        } else if (y > s->hardness + within) {
            sums[SUM] += s->hardness;
        } else if (y >= -within) {
            list[listed++] = y;
        }
    }
    if (listed < n)
        list[listed] = NAN;
}

static void
sum_block(void *at, size_t first, size_t n, double *sums)
{
    const struct search *q = at;
    const double *list = q->m->room + first;
    double hardness = q->m->solver->hardness;

    for (size_t k = 0; k < n && !isnan(list[k]); k++) {
        double y = list[k] + q->shift;
        sums[SUM] += y > 0 ? y < hardness ? y : hardness : 0;
        sums[COUNT] += y > 0 && y < hardness;
    }
}

/* Newton's method for the shift in [-within, within], halving where it leaves the bracket. */
static double
newton(struct search *q, double sum, double start)
{
    double low = -q->within, high = q->within, mu = start;

    for (int round = 0; round < 200; round++) {
        double total[RC_SUMS], phi, slope, next;

        q->shift = mu;
        rc_solver_blocks(q->m->solver, sum_block, q, total);
        phi = total[SUM] + q->sum + q->count * mu - sum;
        slope = total[COUNT] + q->count;
        if (fabs(phi) <= 4 * DBL_EPSILON * q->m->solver->sum)
            break;
        if (phi > 0)
            high = mu;
        else
            low = mu;
        next = mu - phi / slope;
        if (!(next > low && next < high))
            next = (low + high) / 2;
        if (next == mu)
            break;
        mu = next;
    }
    return mu;
}

void
rc_move_find(struct rc_move *m)
{
    struct rc_solver *s = m->solver;
    struct search q = {.m = m};
    double total[RC_SUMS], sum, phi;

    m->shift = 0;
    rc_solver_blocks(s, first_block, m, total);
    m->clipped = total[OUTER] > 0;
    if (!m->clipped && fabs(total[HELD] + total[CARRIED] - s->sum) <= 1e-14 * s->sum)
        return;
    sum = s->sum - total[HELD];
    if (!(sum > 0 && sum <= s->hardness * total[WORKING])) {
        memset(s->w, 1, s->n);
        rc_solver_forget(s);
        rc_solver_blocks(s, first_block, m, total);
        m->clipped = true;
        sum = s->sum;
    }
    phi = total[CARRIED] - sum;
    m->shift = total[INNER] > 0 ? -phi / total[INNER] : 0;
    q.within = m->shift != 0 ? 4 * fabs(m->shift) : s->sum / (double)s->n;
    for (int round = 0; round<40; round++, q.within *= round> 20 ? 1e10 : 16) {
        rc_solver_blocks(s, list_block, &q, total);
        q.sum = total[SUM];
        q.count = total[COUNT];
        m->shift = newton(&q, sum, fabs(m->shift) < q.within ? m->shift : 0);
        if (fabs(m->shift) < 0.999 * q.within)
            break;
    }
}
