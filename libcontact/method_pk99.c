/*
 * The scheme of Polonsky and Keer, Wear 231 (1999), section 3.2: conjugate gradients on the pressure
 * with the contact set and the load enforced in every step. Equation numbers are the paper's; its
 * slips are corrected ((31b) scales by P0/P), and the upper bound, which it leaves open, is treated
 * like the lower one: a node leaves H where the gap is positive, as it enters contact where the
 * gap is negative.
 *
 * Where many nodes change sides at once the scheme can cycle for ever (one tall node over a plain;
 * loads close to saturation). The energy 1/2 p'Kp - h'p costs nothing to follow and must fall. A
 * step that raised it is taken back, and a projected-gradient step, which lowers it by a fixed part
 * of what is to be had, is made in its place.
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
    double energy; /* after the last step that was kept              */
    double norm;   /* bound of K's largest eigenvalue; 0: not known  */
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
    s->energy = INFINITY;
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

/* ---- when the energy rose ---- */

/* Whether it did since the last step, by more than rounding; u = K p. Remembers it when not. */
static bool
raised(struct rc_solver *solver, struct state *s, const double *u)
{
    double energy = 0, size = 0;

    for (size_t k = 0; k < solver->n; k++) {
        double a = solver->p[k] * u[k] / 2, b = solver->p[k] * solver->h[k];
        energy += a - b;
        size += fabs(a) + fabs(b);
    }
    if (energy > s->energy + 1e-13 * size)
        return true;
    s->energy = energy;
    return false;
}

/* The largest row sum of K bounds its eigenvalues. */
static double
norm(struct rc_solver *solver, struct state *s)
{
    double largest = 0;

    for (size_t k = 0; k < solver->n; k++)
        s->t[k] = 1;
    rc_conv_apply(solver->conv, s->t, s->r);
    solver->convolutions++;
    for (size_t k = 0; k < solver->n; k++)
        largest = fmax(largest, s->r[k]);
    return largest;
}

/* Longest step along t that keeps p in the box. */
static double
longest(const struct rc_solver *solver, const double *t)
{
    double most = INFINITY;

    for (size_t k = 0; k < solver->n; k++) {
        if (t[k] < 0)
            most = fmin(most, -solver->p[k] / t[k]);
        else if (t[k] > 0)
            most = fmin(most, (solver->hardness - solver->p[k]) / t[k]);
    }
    return most;
}

/* From p back at `old`: towards the projection of p - g / |K|, to the lowest point on that way. */
static void
projected_step(struct rc_solver *solver, struct state *s)
{
    double above = 0, below = 0, length;

    memcpy(solver->p, s->old, solver->n * sizeof *s->old);
    if (s->norm == 0)
        s->norm = norm(solver, s);
    rc_conv_apply(solver->conv, solver->p, solver->g);
    for (size_t k = 0; k < solver->n; k++) {
        solver->g[k] -= solver->h[k];
        s->t[k] = solver->p[k] - solver->g[k] / s->norm;
    }
    rc_box_project(solver->n, solver->hardness, solver->sum, s->t);
    for (size_t k = 0; k < solver->n; k++)
        s->t[k] -= solver->p[k];
    rc_conv_apply(solver->conv, s->t, s->r);
    solver->convolutions += 2;
    for (size_t k = 0; k < solver->n; k++) {
        above -= solver->g[k] * s->t[k];
        below += s->r[k] * s->t[k];
    }
    length = fmin(below > 0 ? above / below : 0, longest(solver, s->t));
    for (size_t k = 0; k < solver->n; k++)
        solver->p[k] = fmin(fmax(solver->p[k] + length * s->t[k], 0), solver->hardness);
    s->delta = 0;
}

/* ---- one step ---- */

static void
step(struct rc_solver *solver, void *at)
{
    struct state *s = at;
    double shift, sum = 0;
    size_t elastic;

    rc_conv_apply(solver->conv, solver->p, solver->g);
    solver->convolutions++;
    if (raised(solver, s, solver->g)) {
        projected_step(solver, s);
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
