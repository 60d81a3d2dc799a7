/*
 * The working set, the residual on it, and the correction that follows from it.
 *
 * On it are the elastic nodes, and nodes at a bound that want to leave it. A node that penetrates
 * the other body (p = 0 and g < 0; the like at the hardness) need not want to: next to an edge of
 * contact that is about to be pressed less, it overlaps a little, and once its neighbours are in
 * touch it would have to pull. Were it to join, the preconditioner would count on that pull, which
 * the bound then takes away, and the step would be too long: at 2048 x 2048 and 50 % contact that
 * doubled the number of steps.
 *
 * What the set would load it with is z = A r, A the inverse of the operator, r the residual
 * extended smoothly: (A r)_i ~ sum_j a_ij (r_i - r_j), on a half-space with a_ij = |x_i -
 * x_j|^(-3). The sum falls off so fast that its sign can be told from the eight neighbours. A node
 * joins unless that sign is the wrong one; one without neighbours in the set always does, and so do
 * all as the residual of their neighbours goes to 0. The estimate that is believed at last is made
 * with all of them.
 */
#include "solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {        /* bits of w, while this is undecided */
    WAS = 1,  /* it was in the set before      */
    WANTS = 2 /* at a bound, and wants to leave it */
};

void
rc_working_set_forget(struct rc_solver *s)
{
    s->set.changed = s->set.moved = INFINITY; /* the preconditioner has been told nothing of it */
}

enum rc_status
rc_working_set_new(struct rc_solver *s)
{
    s->set.w = rc_alloc(s->posed.n, sizeof *s->set.w);
    s->set.r = rc_alloc(s->posed.n, sizeof *s->set.r);
    if (s->set.w == NULL || s->set.r == NULL)
        return RC_FAIL;
#pragma omp parallel for num_threads(s->posed.threads) schedule(static)
    for (size_t k = 0; k < s->posed.n; k++)
        s->set.w[k] = 0;
    rc_working_set_forget(s);
    return RC_OK;
}

void
rc_working_set_free(struct rc_solver *s)
{
    free(s->set.w);
    free(s->set.r);
}

/* ---- nodes that would only be pushed back ---- */

struct sift {
    struct rc_solver *s;
    float weight[3][3]; /* a_ij */
};

/* sum_j a_kj (r_k - r_j) over the neighbours of k = j nx + i that are in the set. */
static float
pull(const struct sift *c, size_t i, size_t j)
{
    const struct rc_solver *s = c->s;
    size_t nx = s->posed.shape.nx, ny = s->posed.shape.ny;
    bool round = s->posed.boundary == RC_PERIODIC;
    float own = s->set.r[j * nx + i], sum = 0;

    for (size_t b = 0; b < 3; b++) {
        size_t y = j + b; /* one more than the row */
        if ((y == 0 || y > ny) && !round)
            continue;
        y = y == 0 ? ny - 1 : y > ny ? 0 : y - 1;
        for (size_t a = 0; a < 3; a++) {
            size_t x = i + a, k;
            if ((x == 0 || x > nx) && !round)
                continue;
            x = x == 0 ? nx - 1 : x > nx ? 0 : x - 1;
            k = y * nx + x;
            sum += s->set.w[k] != 0 ? c->weight[b][a] * (own - s->set.r[k]) : 0;
        }
    }
    return sum;
}

/* First of the nodes from k on that wants to join, or end. */
static size_t
next(const unsigned char *w, size_t k, size_t end)
{
    static const uint64_t wants = UINT64_C(0x0101010101010101) * WANTS;
    uint64_t eight;

    for (; k + 8 <= end; k += 8) {
        memcpy(&eight, w + k, sizeof eight);
        if ((eight & wants) != 0)
            break;
    }
    while (k < end && (w[k] & WANTS) == 0)
        k++;
    return k;
}

/* Leaves in z whether a node that wants to is to join: it is at p = 0 with r > 0, or at the
 * hardness with r < 0. */
static void
decide(const struct sift *c)
{
    struct rc_solver *s = c->s;
    size_t nx = s->posed.shape.nx;

#pragma omp parallel for num_threads(s->posed.threads) schedule(static)
    for (size_t j = 0; j < s->posed.shape.ny; j++)
        for (size_t k = next(s->set.w, j * nx, (j + 1) * nx); k < (j + 1) * nx;
             k = next(s->set.w, k + 1, (j + 1) * nx)) {
            float f = pull(c, k - j * nx, j);
            s->z[k] = (s->it.p[k] > 0 ? -f : f) < 0 ? 0 : 1;
        }
}

enum { /* sums */
    RESIDUAL,
    OUT,
    CHANGED,
    SIZE
};

static void
settle_block(void *at, size_t first, size_t n, double *sums)
{
    struct rc_solver *s = at;

    for (size_t k = next(s->set.w, first, first + n); k < first + n;
         k = next(s->set.w, k + 1, first + n)) {
        bool was = (s->set.w[k] & WAS) != 0, in = s->z[k] > 0;
        s->set.w[k] = in;
        if (in)
            continue;
        sums[RESIDUAL] += (double)s->set.r[k];
        sums[OUT]++;
        sums[SIZE] += fabs((double)s->set.r[k]);
        sums[CHANGED] += was ? 1 : -1; /* they were counted as if they had joined */
        s->set.r[k] = 0;
    }
}

/* Takes those that would only be pushed back out of the set; the sums of the residual, of the
 * nodes and of those that changed sides follow. Uses z. */
static void
sift_out(struct rc_solver *s, double *residual, double *count, double *changed)
{
    double total[RC_SUMS];
    struct sift c = {.s = s};

    for (int b = 0; b < 3; b++)
        for (int a = 0; a < 3; a++)
            c.weight[b][a] = (float)s->op->neighbour[b][a];
    decide(&c);
    rc_reduce_blocks(s, settle_block, s, total);
    *residual -= total[RESIDUAL];
    *count -= total[OUT];
    *changed += total[CHANGED];
    s->set.left_out = s->op->inverse_diagonal * total[SIZE];
}

/* ---- the set and its residual ---- */

/* `wants` is what is noted of a node at a bound that wants to leave it. */
RC_CLONES static void
residual_of(size_t n, const double *restrict p, const double *restrict v, double hardness,
            double shift, double scale, unsigned char wants, unsigned char *restrict w,
            float *restrict r, double *sums)
{
    double sum = 0;
    int count = 0, changed = 0;

#pragma omp simd reduction(+ : sum, count, changed)
    for (size_t k = 0; k < n; k++) {
        double g = v[k] - shift;
        bool low = p[k] <= 0, high = p[k] >= hardness;
        bool free = !low & !high, leaves = (low & (g < 0)) | (high & (g > 0)), in = free | leaves;
        double to = in ? -g * scale : 0;
        changed += in != w[k];
        w[k] = free ? 1 : leaves ? (unsigned char)(wants | (w[k] & (wants >> 1))) : 0;
        r[k] = (float)to;
        sum += to;
        count += in;
    }
    sums[0] = sum;
    sums[1] = count;
    sums[2] = changed;
}

struct residual {
    struct rc_solver *s;
    unsigned char wants;
};

static void
residual_block(void *at, size_t first, size_t n, double *sums)
{
    const struct residual *c = at;
    struct rc_solver *s = c->s;

    residual_of(n, s->it.p + first, s->it.v + first, s->posed.hardness, s->it.shift,
                1 / s->load.length, c->wants, s->set.w + first, s->set.r + first, sums);
}

void
rc_working_set_find(struct rc_solver *s, bool sift)
{
    struct residual c = {.s = s, .wants = sift ? WANTS : 1};
    double total[RC_SUMS];

    rc_reduce_blocks(s, residual_block, &c, total);
    s->set.left_out = 0;
    if (sift)
        sift_out(s, &total[0], &total[1], &total[2]);
    s->set.size = (size_t)total[1];
    s->set.offset = s->set.size > 0 ? (float)(total[0] / total[1]) : 0;
    s->set.changed += total[2];
    s->set.moved += total[2];
}

void
rc_working_set_all(struct rc_solver *s)
{
    memset(s->set.w, 1, s->posed.n);
    rc_working_set_forget(s);
}

static void
elastic_block(void *at, size_t first, size_t n, double *sums)
{
    struct rc_solver *s = at;

    for (size_t k = first; k < first + n; k++) {
        s->set.w[k] = rc_elastic(s, k);
        s->set.r[k] = s->set.w[k];
        sums[0] += s->set.w[k];
    }
}

size_t
rc_working_set_elastic(struct rc_solver *s)
{
    double total[RC_SUMS];

    rc_reduce_blocks(s, elastic_block, s, total);
    rc_working_set_forget(s);
    s->set.size = (size_t)total[0];
    s->set.offset = 0;
    return s->set.size;
}

/* ---- the correction, and the error that it tells ---- */

/* Parts of the working set that may change sides before the preconditioner is told, and before it
 * measures its distances again. */
static const double little = 1e-3, much = 1.0;

void
rc_working_set_correct(struct rc_solver *s, rc_row *done, void *ctx)
{
    struct rc_working_set *set = &s->set;
    bool measure = set->moved > much * (double)set->size;

    if (measure || set->changed > little * (double)set->size) {
        rc_preconditioner_set(s->preconditioner, set->w, measure);
        rc_iterate_count(s, s->op->factor_cost);
        set->changed = 0;
        if (measure)
            set->moved = 0;
    }
    rc_preconditioner_apply(s->preconditioner, set->r, set->offset, s->z, done, ctx);
    rc_iterate_count(s, 3 * s->op->factor_cost);
}

struct size {
    struct rc_solver *s;
    double mean;
};

static void
sum_block(void *at, size_t first, size_t n, double *sums)
{
    const struct size *c = at;

    for (size_t k = first; k < first + n; k++)
        sums[0] += (double)c->s->z[k];
}

static void
size_block(void *at, size_t first, size_t n, double *sums)
{
    const struct size *c = at;

    for (size_t k = first; k < first + n; k++)
        sums[0] += c->s->set.w[k] ? fabs((double)c->s->z[k] - c->mean) : 0;
}

double
rc_working_set_estimate(struct rc_solver *s)
{
    struct size c = {.s = s};
    double total[RC_SUMS];

    if (s->set.size < 2 && s->set.size == s->it.elastic)
        return 0; /* nothing to exchange, nobody wants to move */
    if (s->it.elastic == 0)
        return INFINITY; /* some do, but no gap says how far */
    rc_working_set_correct(s, NULL, NULL);
    rc_reduce_blocks(s, sum_block, &c, total);
    c.mean = total[0] / (double)s->set.size;
    rc_reduce_blocks(s, size_block, &c, total);
    return total[0] / s->load.per_pressure / s->load.sum + rc_iterate_operator_error(s);
}
