/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The iterate: the pressure, its gap, and its estimated error.
 */
#include "solver.h"

#include <math.h>

#include "libcontact/memory.h"

void
rc_iterate_new(struct rc_solver *s)
{
    s->it = (struct rc_iterate){.error = NAN, .next_check = 1};
    s->it.p = rc_store_take(&s->own, s->posed.n, sizeof *s->it.p);
    s->it.v = rc_store_take(&s->own, s->posed.n, sizeof *s->it.v);
}

void
rc_iterate_level(struct rc_solver *s)
{
    const struct rc_box box = rc_box(s, 0);
    double mean = s->load.sum / (double)s->posed.nodes;

#pragma omp parallel for num_threads(s->posed.threads) schedule(static)
    for (size_t k = 0; k < s->posed.n; k++)
        s->it.p[k] = rc_clip(box, k, mean);
    if (box.highs != NULL) /* nodes that were not clipped carry the rest */
        rc_projection_of(s, s->it.p);
}

void
rc_iterate_forget(struct rc_solver *s)
{
    s->it.known = s->it.fresh = false;
    s->it.error = NAN;
    s->it.next_check = s->it.iterations + 1;
}

void
rc_iterate_reset(struct rc_solver *s)
{
    s->it.iterations = 0;
    s->it.rested = false;
    s->it.convolutions = 0;
}

void
rc_iterate_count(struct rc_solver *s, double convolutions)
{
    s->it.convolutions += convolutions;
}

/* ---- v, shift ---- */

static void
less_heights(void *at, size_t first, size_t n, double *sums)
{
    struct rc_solver *s = at;

    (void)sums;
    for (size_t k = first; k < first + n; k++)
        s->it.v[k] -= s->posed.h[k];
}

void
rc_iterate_displace(struct rc_solver *s)
{
    double total[RC_SUMS];

    rc_operator_apply(s->op, s->it.p, s->it.v);
    rc_reduce_blocks(s, less_heights, s, total);
    s->it.convolutions++;
    s->it.known = s->it.fresh = true;
}

void
rc_iterate_unknown(struct rc_solver *s)
{
    s->it.known = s->it.fresh = false;
}

static bool
pressure_in(void *at, size_t j, void *to)
{
    const struct rc_solver *s = at;
    size_t n = s->posed.shape.nx;
    const double *p = s->it.p + j * n;
    float *row = to;
    bool any = false;

    for (size_t i = 0; i < n; i++) {
        row[i] = (float)(p[i] * s->load.per_pressure);
        any |= p[i] != 0;
    }
    return any;
}

static bool
gap_out(void *at, size_t j, void *from)
{
    const struct rc_solver *s = at;
    size_t n = s->posed.shape.nx;
    const float *row = from;
    const double *h = s->posed.h + j * n;
    double *v = s->it.v + j * n, sum = 0;

    for (size_t i = 0; i < n; i++) {
        double u = (double)row[i];
        v[i] = u * s->load.length - h[i];
        sum += u * u;
    }
    rc_reduce_row(s, j)[0] = sum;
    return true;
}

double
rc_iterate_displace_rows(struct rc_solver *s)
{
    double total[RC_SUMS];

    if (s->op->row_cost >= 1) { /* double precision costs no more here */
        rc_iterate_displace(s);
        return 0;
    }
    rc_reduce_rows_begin(s);
    rc_operator_apply_rows(s->op, pressure_in, gap_out, s);
    rc_iterate_count(s, s->op->row_cost);
    rc_reduce_rows_end(s, total);
    s->it.known = true;
    s->it.fresh = false;
    return sqrt(total[0] / (double)s->posed.nodes);
}

RC_CLONES static void
follow(size_t n, const float *restrict q, double factor, double *restrict v)
{
    for (size_t k = 0; k < n; k++)
        v[k] += factor * (double)q[k];
}

void
rc_iterate_follow(size_t n, const float *q, double factor, double *v)
{
    follow(n, q, factor, v);
}

void
rc_iterate_moved(struct rc_solver *s, double gap, double elastic)
{
    s->it.fresh = false;
    s->it.elastic = (size_t)elastic;
    if (elastic > 0)
        s->it.shift = gap / elastic;
}

RC_INLINE void
sums_between(struct rc_box box, size_t n, const double *p, const double *v, double *sums)
{
    double sum = 0, count = 0;

#pragma omp simd reduction(+ : sum, count)
    for (size_t k = 0; k < n; k++) {
        bool elastic = (p[k] > rc_low(box, k)) & (p[k] < rc_high(box, k));
        sum += elastic ? v[k] : 0;
        count += elastic ? 1 : 0;
    }
    sums[0] = sum;
    sums[1] = count;
}

RC_CLONES static void
elastic_sums(struct rc_box box, size_t n, const double *p, const double *v, double *sums)
{
    if (box.highs == NULL)
        sums_between(rc_box_of_numbers(box), n, p, v, sums);
    else
        sums_between(box, n, p, v, sums);
}

static void
elastic_block(void *at, size_t first, size_t n, double *sums)
{
    struct rc_solver *s = at;

    elastic_sums(rc_box(s, first), n, s->it.p + first, s->it.v + first, sums);
}

/* The shift where no node is elastic: the wanted shift if it is admissible for this pressure, else the middle
 * of the admissible interval. */
static double
middle(const struct rc_solver *s)
{
    const struct rc_box box = rc_box(s, 0);
    double low = -INFINITY, high = INFINITY;
    double sought = s->load.target - (rc_tilt_approach(s) - s->it.shift);

    for (size_t k = 0; k < s->posed.n; k++)
        if (rc_at_low(box, k, s->it.p[k]))
            high = fmin(high, s->it.v[k]);
        else
            low = fmax(low, s->it.v[k]);
    low = rc_ranks_most(s->posed.rows.ranks, low);
    high = -rc_ranks_most(s->posed.rows.ranks, -high);
    if (s->load.target > 0 && low <= high)
        return fmin(fmax(sought, low), high);
    return isinf(low) ? high : isinf(high) ? low : (low + high) / 2;
}

void
rc_iterate_shift(struct rc_solver *s)
{
    double total[RC_SUMS];

    rc_reduce_blocks(s, elastic_block, s, total);
    s->it.elastic = (size_t)total[1];
    s->it.shift = s->it.elastic > 0 ? total[0] / total[1] : middle(s);
}

double
rc_iterate_stiffness(const struct rc_solver *s)
{
    return s->op->near.inverse[1][1] / (s->load.length * s->load.per_pressure);
}

/* Allowed relative error of the load for the balancing shift, which only selects a working set. At 1e-4
 * the search took 5.5 % of a solve in which nearly all nodes yield, with far smaller values 9 %. Not
 * sensitive: half and double change no count of 123 contacts (bench/constants.py). */
static const double unbalanced = 1e-4;

/* Context of the search for the balancing shift. Each node moves by its gap times the stiffness of a node
 * whose neighbours are fixed, within its bounds. */
struct balance {
    struct rc_solver *s;
    double stiffness, shift;
};

static void
balance_block(void *at, size_t first, size_t n, double *sums)
{
    const struct balance *c = at;
    const struct rc_solver *s = c->s;
    const struct rc_box box = rc_box(s, 0);

    for (size_t k = first; k < first + n; k++) {
        double y = s->it.p[k] - c->stiffness * (s->it.v[k] - c->shift);
        sums[0] += rc_clip(box, k, y) - s->it.p[k];
        sums[1] += rc_between(box, k, y);
    }
}

static struct rc_excess
excess_of_balance(void *ctx, double shift)
{
    struct balance *c = ctx;
    double total[RC_SUMS];

    c->shift = shift;
    rc_reduce_blocks(c->s, balance_block, c, total);
    return (struct rc_excess){.load = total[0], .slope = total[1] * c->stiffness};
}

static void
farthest_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = at;

    for (size_t k = first; k < first + n; k++)
        sums[RC_MOST] = fmax(sums[RC_MOST], fabs(s->it.v[k] - s->it.shift));
}

void
rc_iterate_balance(struct rc_solver *s)
{
    struct balance c = {.s = s, .stiffness = rc_iterate_stiffness(s)};
    double total[RC_SUMS], shift = s->it.shift, far;

    rc_reduce_blocks(s, farthest_block, s, total);
    far = total[RC_MOST];
    s->it.shift =
        rc_newton(excess_of_balance, &c, shift - far, shift + far, shift, unbalanced * s->load.sum);
}

/* ---- the load ---- */

static void
carried_block(void *at, size_t first, size_t n, double *sums)
{
    const double *p = at;

    sums[0] = rc_sum(p + first, n);
}

double
rc_iterate_carried(const struct rc_solver *s)
{
    double total[RC_SUMS];

    rc_reduce_blocks(s, carried_block, s->it.p, total);
    return total[0];
}

bool
rc_iterate_keeps_load(const struct rc_solver *s)
{
    return fabs(rc_iterate_carried(s) - s->load.sum) <= 1e-10 * s->load.sum;
}

/* ---- nodes near their upper bounds ---- */

static void
rest_block(void *at, size_t first, size_t n, double *sums)
{
    struct rc_solver *s = at;
    const struct rc_box box = rc_box(s, 0);
    /* The tolerance refers to the whole map: these nodes can hold most of the error. Not sensitive: half
     * and double of the factor 10 change no bit of 123 contacts (bench/constants.py). */
    const double near = fmin(10 * s->load.tol, 1e-2);

    for (size_t k = first; k < first + n; k++) {
        double most = rc_high(box, k), p = s->it.p[k];
        if (p < most && p >= most * (1 - near)) {
            s->it.p[k] = most;
            sums[0]++;
        }
    }
}

bool
rc_iterate_rest(struct rc_solver *s)
{
    double total[RC_SUMS];

    if (!rc_bounded(&s->posed.bounds))
        return false;
    rc_reduce_blocks(s, rest_block, s, total);
    if (total[0] > 0)
        rc_projection_restore(s, rc_iterate_carried(s));
    return total[0] > 0;
}

/* ---- the error ---- */

void
rc_iterate_checked(struct rc_solver *s, double error, size_t again)
{
    s->it.error = error;
    s->it.checked = s->it.iterations;
    s->it.next_check = s->it.iterations + again;
}

/* The operator's error is a bound relative to |K| |p|. The measured error of the pressure was 0.2 to 0.6 of
 * it (multi-level sums, smooth and rough spheres). */
double
rc_iterate_operator_error(const struct rc_solver *s)
{
    return 0.5 * s->op->error;
}

double
rc_iterate_judge(struct rc_solver *s)
{
    if (s->posed.rough) /* coarser grids need no convolutions in double precision */
        (void)rc_iterate_displace_rows(s);
    else if (!s->it.fresh)
        rc_iterate_displace(s);
    rc_iterate_shift(s);
    rc_working_set_find(s, false);
    return rc_working_set_estimate(s);
}
