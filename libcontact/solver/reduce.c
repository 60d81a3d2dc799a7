/*
 * What the solver does with all nodes: sums that do not depend on the number of threads, the gap,
 * the working set and the residual on it. At a few milliseconds a convolution these passes over
 * memory cost as much, so each does what it can in one go.
 */
#include "solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "working_set.h"

enum {
    BLOCK = 4096
};

/* ---- sums ---- */

static void
total_of(const double *partial, size_t n, double total[RC_SUMS])
{
    memset(total, 0, RC_SUMS * sizeof *total);
    for (size_t b = 0; b < n; b++, partial += RC_SUMS) {
        for (size_t q = 0; q < RC_MOST; q++)
            total[q] += partial[q];
        if (partial[RC_MOST] > total[RC_MOST])
            total[RC_MOST] = partial[RC_MOST];
    }
}

void
rc_solver_blocks(const struct rc_solver *s, rc_block *block, void *ctx, double total[RC_SUMS])
{
    size_t n = (s->n + BLOCK - 1) / BLOCK;

    memset(s->partial, 0, n * RC_SUMS * sizeof *s->partial);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (size_t b = 0; b < n; b++)
        block(ctx, b * BLOCK, s->n - b * BLOCK < BLOCK ? s->n - b * BLOCK : BLOCK,
              s->partial + b * RC_SUMS);
    total_of(s->partial, n, total);
}

void
rc_solver_rows_begin(const struct rc_solver *s)
{
    memset(s->partial, 0, s->shape.ny * RC_SUMS * sizeof *s->partial);
}

void
rc_solver_rows_end(const struct rc_solver *s, double total[RC_SUMS])
{
    total_of(s->partial, s->shape.ny, total);
}

/* ---- v, shift, residual ---- */

static void
less_heights(void *at, size_t first, size_t n, double *sums)
{
    struct rc_solver *s = at;

    (void)sums;
    for (size_t k = first; k < first + n; k++)
        s->v[k] -= s->h[k];
}

void
rc_solver_displace(struct rc_solver *s)
{
    double total[RC_SUMS];

    rc_conv_apply(s->conv, s->p, s->v);
    rc_solver_blocks(s, less_heights, s, total);
    s->convolutions++;
    s->known = s->fresh = true;
}

RC_CLONES static void
elastic_sums(size_t n, const double *p, const double *v, double hardness, double *sums)
{
    double sum = 0, count = 0;

#pragma omp simd reduction(+ : sum, count)
    for (size_t k = 0; k < n; k++) {
        bool elastic = (p[k] > 0) & (p[k] < hardness);
        sum += elastic ? v[k] : 0;
        count += elastic ? 1 : 0;
    }
    sums[0] = sum;
    sums[1] = count;
}

static void
elastic_block(void *at, size_t first, size_t n, double *sums)
{
    struct rc_solver *s = at;

    elastic_sums(n, s->p + first, s->v + first, s->hardness, sums);
}

/* No node is elastic. */
static double
middle(const struct rc_solver *s)
{
    double low = -INFINITY, high = INFINITY;

    for (size_t k = 0; k < s->n; k++)
        if (s->p[k] > 0)
            low = fmax(low, s->v[k]);
        else
            high = fmin(high, s->v[k]);
    return isinf(low) ? high : isinf(high) ? low : (low + high) / 2;
}

void
rc_solver_shift(struct rc_solver *s)
{
    double total[RC_SUMS];

    rc_solver_blocks(s, elastic_block, s, total);
    s->elastic = (size_t)total[1];
    s->shift = s->elastic > 0 ? total[0] / total[1] : middle(s);
}

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

    residual_of(n, s->p + first, s->v + first, s->hardness, s->shift, 1 / s->length, c->wants,
                s->w + first, s->r + first, sums);
}

void
rc_solver_residual(struct rc_solver *s, bool sift)
{
    struct residual c = {.s = s, .wants = sift ? RC_WANTS : 1};
    double total[RC_SUMS];

    rc_solver_blocks(s, residual_block, &c, total);
    s->aside = 0;
    if (sift)
        rc_working_set_sift(s, &total[0], &total[1], &total[2]);
    s->working = (size_t)total[1];
    s->offset = s->working > 0 ? (float)(total[0] / total[1]) : 0;
    s->changed += total[2];
    s->moved += total[2];
}

/* ---- correction ---- */

/* Parts of the working set that may change sides before the extension is told, and before it
 * measures its distances again. */
static const double little = 1e-3, much = 1.0;

void
rc_solver_correct(struct rc_solver *s, rc_row *done, void *ctx)
{
    bool measure = s->moved > much * (double)s->working;

    if (measure || s->changed > little * (double)s->working) {
        rc_preconditioner_set(s->extension, s->w, measure);
        s->convolutions += 0.5;
        s->changed = 0;
        if (measure)
            s->moved = 0;
    }
    rc_preconditioner_apply(s->extension, s->r, s->offset, s->z, done, ctx);
    s->convolutions += 1.5;
}

static void
carried_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = at;

    sums[0] = rc_sum(s->p + first, n);
}

double
rc_solver_carried(const struct rc_solver *s)
{
    double total[RC_SUMS];

    rc_solver_blocks(s, carried_block, (void *)(size_t)s, total);
    return total[0];
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
        sums[0] += c->s->w[k] ? fabs((double)c->s->z[k] - c->mean) : 0;
}

/* What the engine may have put into the pressure: its error is a bound, relative to all of |K|
 * |p|, and what the pressure makes of it was seen to be 0.2 to 0.6 of that (multi-level sums,
 * smooth and rough spheres). */
double
rc_solver_engine_error(const struct rc_solver *s)
{
    return s->conv == NULL ? 0 : 0.5 * rc_conv_error(s->conv);
}

double
rc_solver_estimate(struct rc_solver *s)
{
    struct size c = {.s = s};
    double total[RC_SUMS];

    if (s->working < 2 && s->working == s->elastic)
        return 0; /* nothing to exchange, nobody wants to move */
    if (s->elastic == 0)
        return INFINITY; /* some do, but no gap says how far */
    rc_solver_correct(s, NULL, NULL);
    rc_solver_blocks(s, sum_block, &c, total);
    c.mean = total[0] / (double)s->working;
    rc_solver_blocks(s, size_block, &c, total);
    return total[0] / s->per_pressure / s->sum + rc_solver_engine_error(s);
}
