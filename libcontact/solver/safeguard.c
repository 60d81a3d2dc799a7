/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The safeguard that keeps a method from cycling. The energy 1/2 p'Kp - h'p follows from known fields at no
 * cost and must decrease. A step that raised it is reverted and replaced by a projected-gradient step. That
 * step lowers the energy by at least |K|/2 times the square of its length, so no cycle is possible.
 */
#include "solver.h"

#include <math.h>
#include <string.h>

struct pass {
    const struct rc_solver *solver;
};

static void
energy_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = ((const struct pass *)at)->solver;

    for (size_t k = first; k < first + n; k++) {
        double a = s->it.p[k] * s->it.v[k] / 2,
               b = s->it.p[k] * s->posed.h[k] / 2; /* v = K p - h */
        sums[0] += a - b;
        sums[1] += fabs(a) + fabs(b);
    }
}

bool
rc_safeguard_raised(struct rc_safeguard *safeguard, const struct rc_solver *solver)
{
    struct pass c = {solver};
    double total[RC_SUMS];

    rc_reduce_blocks(solver, energy_block, &c, total);
    if (total[0] > safeguard->energy + 1e-13 * total[1]) /* more than rounding */
        return true;
    safeguard->energy = total[0];
    return false;
}

/* Longest step along t that keeps p in the box. */
static double
longest(const struct rc_solver *solver, const double *t)
{
    const struct rc_box box = rc_box(solver, 0);
    double most = INFINITY;

    for (size_t k = 0; k < solver->posed.n; k++) {
        if (t[k] < 0)
            most = fmin(most, (rc_low(box, k) - solver->it.p[k]) / t[k]);
        else if (t[k] > 0)
            most = fmin(most, (rc_high(box, k) - solver->it.p[k]) / t[k]);
    }
    return -rc_ranks_most(solver->posed.rows.ranks, -most);
}

/* Context of the passes of a step. */
struct way {
    struct rc_solver *solver;
    double *t, *r;
    double length;
};

enum { /* sums along the step */
    ABOVE,
    BELOW
};

static void
aim_block(void *at, size_t first, size_t n, double *sums)
{
    const struct way *w = at;
    const struct rc_solver *s = w->solver;

    (void)sums;
    for (size_t k = first; k < first + n; k++)
        w->t[k] = s->it.p[k] - (s->it.v[k] - s->it.shift) / s->op->norm;
}

static void
turn_block(void *at, size_t first, size_t n, double *sums)
{
    const struct way *w = at;

    for (size_t k = first; k < first + n; k++) {
        w->t[k] -= w->solver->it.p[k];
        sums[0] += fabs(w->t[k]);
    }
}

static void
product_block(void *at, size_t first, size_t n, double *sums)
{
    const struct way *w = at;
    const struct rc_solver *s = w->solver;

    for (size_t k = first; k < first + n; k++) {
        /* without the shift, because the sum of t is 0 within rounding */
        sums[ABOVE] -= (s->it.v[k] - s->it.shift) * w->t[k];
        sums[BELOW] += w->r[k] * w->t[k];
    }
}

static void
move_block(void *at, size_t first, size_t n, double *sums)
{
    const struct way *w = at;
    struct rc_solver *s = w->solver;
    const struct rc_box box = rc_box(s, 0);

    (void)sums;
    for (size_t k = first; k < first + n; k++)
        s->it.p[k] = rc_settled(box, k, s->it.p[k] + w->length * w->t[k]);
}

void
rc_safeguard_step(struct rc_solver *solver, const double *old, double *t, double *r)
{
    struct way w = {.solver = solver, .t = t, .r = r};
    double total[RC_SUMS], above, below;

    memcpy(solver->it.p, old, solver->posed.n * sizeof *old);
    rc_iterate_displace(solver);
    rc_iterate_shift(solver);
    rc_reduce_blocks(solver, aim_block, &w, total);
    rc_projection_of(solver, t);
    rc_reduce_blocks(solver, turn_block, &w, total);
    if (total[0] <= 1e-15 * solver->load.sum)
        return; /* only rounding errors are left */
    rc_operator_apply(solver->op, t, r);
    rc_iterate_count(solver, 1);
    rc_reduce_blocks(solver, product_block, &w, total);
    above = total[ABOVE];
    below = total[BELOW];
    w.length = fmin(below > 0 && above > 0 ? above / below : 0, longest(solver, t));
    rc_reduce_blocks(solver, move_block, &w, total);
    rc_projection_balance(solver, solver->it.v); /* corrects the load for rounding */
}
