/*
 * The scheme of Polonsky and Keer, Wear 231 (1999), section 3.2: conjugate gradients on the pressure
 * with the contact set and the load enforced in every step. Equation numbers are the paper's; its
 * slips are corrected ((31b) scales by P0/P), and the upper bound, which it leaves open, is treated
 * like the lower one: a node leaves H where the gap is positive, as it enters contact where the
 * gap is negative.
 *
 * Where many nodes change sides at once the scheme can cycle for ever (one tall node over a plain;
 * loads close to saturation): guard.c takes back what raised the energy.
 */
#include "solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct state {
    double *t;    /* conjugate direction, zero off the elastic nodes */
    double *r;    /* K t                                             */
    double *old;  /* p before the step                               */
    double G;     /* (22) of the last step                           */
    double delta; /* 0: the next direction is steepest descent       */
    double tau;   /* last step length, 0 before the first            */
    double first; /* a length that is safe where (26) is 0/0         */
    struct rc_guard guard;
};

static void
state_free(void *at)
{
    struct state *s = at;

    if (s == NULL)
        return;
    free(s->t);
    free(s->r);
    free(s->old);
    free(s);
}

static void *
state_new(struct rc_solver *solver, struct rc_err *err)
{
    struct rc_medium medium = {.estar = solver->estar};
    struct rc_lattice cell = {solver->shape.dx, solver->shape.dy, 1, 1};
    struct state *s = calloc(1, sizeof *s);
    double self;

    if (s != NULL) {
        s->t = calloc(solver->n, sizeof *s->t);
        s->r = malloc(solver->n * sizeof *s->r);
        s->old = malloc(solver->n * sizeof *s->old);
    }
    if (s == NULL || s->t == NULL || s->r == NULL || s->old == NULL) {
        rc_err_set(err, "out of memory for the iteration of %zu nodes", solver->n);
        state_free(s);
        return NULL;
    }
    s->G = 1;
    s->guard.energy = INFINITY;
    rc_kernel_boussinesq.rows(&medium, 0, &cell, 1, 0, 1, &self);
    s->first = 1 / self;
    return s;
}

/* (22), (23): the direction. */
static void
direct(struct rc_solver *solver, struct state *s)
{
    double G = 0, beta;

    for (size_t k = 0; k < solver->n; k++)
        if (rc_elastic(solver, k))
            G += solver->g[k] * solver->g[k];
    beta = s->G > 0 ? s->delta * G / s->G : 0;
    for (size_t k = 0; k < solver->n; k++)
        s->t[k] = rc_elastic(solver, k) ? solver->g[k] + beta * s->t[k] : 0;
    s->G = G;
}

/* (24) to (26): the step length. One elastic node has nothing to exchange with: 0/0. */
static void
measure(struct rc_solver *solver, struct state *s, size_t elastic)
{
    double mean = 0, above = 0, below = 0;

    if (elastic < 2 || !(s->G > 0))
        return;
    rc_conv_apply(solver->conv, s->t, s->r);
    solver->convolutions++;
    for (size_t k = 0; k < solver->n; k++)
        if (rc_elastic(solver, k))
            mean += s->r[k];
    mean /= (double)elastic;
    for (size_t k = 0; k < solver->n; k++)
        if (rc_elastic(solver, k)) {
            above += solver->g[k] * s->t[k];
            below += (s->r[k] - mean) * s->t[k];
        }
    if (below > 0 && above > 0)
        s->tau = above / below;
    else
        memset(s->t, 0, solver->n * sizeof *s->t);
}

/* (28) to (30): the step, the box, and the nodes that want to leave their bound. */
static void
move(struct rc_solver *solver, struct state *s, size_t elastic)
{
    double tau = s->tau > 0 ? s->tau : s->first;
    bool moved = false;

    for (size_t k = 0; k < solver->n; k++) {
        double p = solver->p[k], g = solver->g[k];

        if (p > 0 && p < solver->hardness && elastic > 1)
            p = fmin(fmax(p - tau * s->t[k], 0), solver->hardness);
        if ((p == 0 && g < 0) || (p == solver->hardness && g > 0)) {
            p = fmin(fmax(p - tau * g, 0), solver->hardness);
            moved = true;
        }
        solver->p[k] = p;
    }
    s->delta = moved ? 0 : 1;
}

static void
step(struct rc_solver *solver, void *at)
{
    struct state *s = at;
    double shift, sum = 0;
    size_t elastic;

    rc_conv_apply(solver->conv, solver->p, solver->g);
    solver->convolutions++;
    if (rc_guard_raised(&s->guard, solver, solver->g)) {
        rc_guard_step(&s->guard, solver, s->old, s->t, s->r);
        s->delta = 0;
    } else {
        elastic = rc_solver_gap(solver, solver->g, solver->g, &shift);
        direct(solver, s);
        measure(solver, s, elastic);
        memcpy(s->old, solver->p, solver->n * sizeof *s->old);
        move(solver, s, elastic);
    }
    if (rc_box_balance(solver->n, solver->hardness, solver->sum, solver->g, solver->p, NULL) !=
        RC_OK)
        memcpy(solver->p, s->old, solver->n * sizeof *s->old); /* out of memory: stand still */
    for (size_t k = 0; k < solver->n; k++)
        sum += fabs(solver->p[k] - s->old[k]);
    solver->change = sum / solver->sum; /* (32) */
}

const struct rc_method rc_method_pk99 = {
    .name = "pk99",
    .summary = "conjugate gradients of Polonsky and Keer, 1999",
    .new = state_new,
    .step = step,
    .free = state_free,
};
