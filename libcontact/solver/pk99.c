/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The scheme of Polonsky and Keer, Wear 231 (1999), section 3.2. It is conjugate gradients on the pressure,
 * with the contact set and the load enforced in every step. Equation numbers are the paper's; its errors are
 * corrected ((31b) scales by P0/P). The paper has no upper bound; here it is treated like the lower one. A
 * node leaves H where the gap is positive, as it enters contact where the gap is negative.
 *
 * Where many nodes join or leave at once the scheme can cycle forever. Examples are one high node above a
 * plane, and loads close to saturation. safeguard.c reverts a step that raised the energy.
 */
#include "solver.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

struct state {
    double *t;    /* conjugate direction, zero off the elastic nodes */
    double *r;    /* K t                                             */
    double *old;  /* the previous p */
    double G;     /* (22) of the last step                           */
    double delta; /* 0: the next direction is steepest descent       */
    double tau;   /* last step length, 0 before the first            */
    struct rc_safeguard safeguard;
};

static void *
state_new(struct rc_solver *solver)
{
    struct rc_store *own = &solver->own;
    struct state *s = rc_store_zeros(own, 1, sizeof *s);

    if (s == NULL)
        return NULL;
    s->t = rc_store_zeros(own, solver->posed.n, sizeof *s->t);
    s->r = rc_store_take(own, solver->posed.n, sizeof *s->r);
    s->old = rc_store_take(own, solver->posed.n, sizeof *s->old);
    s->G = 1;
    s->safeguard.energy = INFINITY;
    return own->failed ? NULL : s;
}

static double
gap(const struct rc_solver *solver, size_t k)
{
    return solver->it.v[k] - solver->it.shift;
}

/* Context of the passes below; `number`: a result of the previous pass. */
struct pass {
    struct rc_solver *solver;
    struct state *s;
    double number;
};

/* (22) */
static void
norm_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;

    for (size_t k = first; k < first + n; k++)
        sums[0] += rc_elastic(c->solver, k) ? gap(c->solver, k) * gap(c->solver, k) : 0;
}

/* (23) */
static void
direction_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;

    (void)sums;
    for (size_t k = first; k < first + n; k++)
        c->s->t[k] = rc_elastic(c->solver, k) ? gap(c->solver, k) + c->number * c->s->t[k] : 0;
}

static void
direct(struct rc_solver *solver, struct state *s)
{
    struct pass c = {.solver = solver, .s = s};
    double total[RC_SUMS], G;

    rc_reduce_blocks(solver, norm_block, &c, total);
    G = total[0];
    c.number = s->G > 0 ? s->delta * G / s->G : 0;
    rc_reduce_blocks(solver, direction_block, &c, total);
    s->G = G;
}

/* (24), and the sums of (25) and (26); t adds up over the elastic nodes to sums[3]. */
static void
length_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;
    const struct state *s = c->s;

    for (size_t k = first; k < first + n; k++)
        if (rc_elastic(c->solver, k)) {
            sums[0] += s->r[k];
            sums[1] += gap(c->solver, k) * s->t[k];
            sums[2] += s->r[k] * s->t[k];
            sums[3] += s->t[k];
        }
}

/* (24) to (26): the step length. With one elastic node (26) is 0/0. */
static void
measure(struct rc_solver *solver, struct state *s)
{
    struct pass c = {.solver = solver, .s = s};
    double total[RC_SUMS], above, below;

    if (solver->it.elastic < 2 || !(s->G > 0))
        return;
    rc_operator_apply(solver->op, s->t, s->r);
    rc_iterate_count(solver, 1);
    rc_reduce_blocks(solver, length_block, &c, total);
    above = total[1];
    below = total[2] - total[0] / (double)solver->it.elastic * total[3];
    if (below > 0 && above > 0)
        s->tau = above / below;
    else
        memset(s->t, 0, solver->posed.n * sizeof *s->t);
}

/* (28) to (30): the step and the bounds; counts the nodes that leave their bound. */
static void
move_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;
    struct rc_solver *solver = c->solver;
    const struct rc_box box = rc_box(solver, 0);
    double tau = c->number;

    for (size_t k = first; k < first + n; k++) {
        double p = solver->it.p[k], g = gap(solver, k);

        c->s->old[k] = p;
        if (rc_between(box, k, p) && solver->it.elastic > 1)
            p = rc_clip(box, k, p - tau * c->s->t[k]);
        if ((rc_at_low(box, k, p) && g < 0) || (rc_at_high(box, k, p) && g > 0)) {
            p = rc_clip(box, k, p - tau * g);
            sums[0]++;
        }
        solver->it.p[k] = p;
    }
}

static void
move(struct rc_solver *solver, struct state *s)
{
    const double safe = 1 / solver->op->diagonal; /* the step length if (26) is 0/0 */
    struct pass c = {.solver = solver, .s = s, .number = s->tau > 0 ? s->tau : safe};
    double total[RC_SUMS];

    rc_reduce_blocks(solver, move_block, &c, total);
    s->delta = total[0] > 0 ? 0 : 1;
}

static void
change_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;

    for (size_t k = first; k < first + n; k++)
        sums[0] += fabs(c->solver->it.p[k] - c->s->old[k]);
}

/* After a move: restores the load and returns (32), the relative change. */
static double
settle(struct rc_solver *solver, struct state *s)
{
    struct pass c = {.solver = solver, .s = s};
    double total[RC_SUMS];

    rc_projection_balance(solver, solver->it.v);
    rc_iterate_unknown(solver);
    rc_reduce_blocks(solver, change_block, &c, total);
    return total[0] / solver->load.sum;
}

static struct rc_found
step(struct rc_solver *solver, void *at)
{
    struct state *s = at;
    double change;

    if (!solver->it.fresh)
        rc_iterate_displace(solver);
    if (rc_safeguard_raised(&s->safeguard, solver)) {
        rc_safeguard_step(solver, s->old, s->t, s->r);
        s->delta = 0;
    } else {
        rc_iterate_shift(solver);
        direct(solver, s);
        measure(solver, s);
        move(solver, s);
    }
    change = settle(solver, s);
    if (change <= DBL_EPSILON) { /* no node can follow the paper's step: use the safeguard's step */
        rc_safeguard_step(solver, s->old, s->t, s->r);
        s->delta = 0;
        change = settle(solver, s);
    }
    return (struct rc_found){.change = change, .estimate = NAN};
}

static void
forget(void *at)
{
    struct state *s = at;

    s->G = 1;
    s->delta = s->tau = 0;
    s->safeguard.energy = INFINITY;
}

/* Most iterations find the contact; after that each digit costs only a few. */
static double
convolutions(double nodes, double digits)
{
    return 0.3 * sqrt(nodes) * (digits < 4 ? pow(3, digits / 2 - 1) : 3 + 0.3 * (digits - 4));
}

const struct rc_method rc_method_pk99 = {
    .info = {.name = "pk99",
             .summary = "conjugate gradients of Polonsky and Keer, 1999",
             .bytes = 16},
    .convolutions = convolutions,
    .new = state_new,
    .step = step,
    .forget = forget,
};
