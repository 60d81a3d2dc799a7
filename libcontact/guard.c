/*
 * What keeps a method from cycling. The energy 1/2 p'Kp - h'p costs nothing to follow and must fall. A
 * step that raised it is taken back, and a projected-gradient step is made in its place, which lowers
 * it by at least |K|/2 times the square of its own length: no cycle can close.
 */
#include "solver.h"

#include <math.h>
#include <string.h>

bool
rc_guard_raised(struct rc_guard *guard, const struct rc_solver *solver, const double *u)
{
    double energy = 0, size = 0;

    for (size_t k = 0; k < solver->n; k++) {
        double a = solver->p[k] * u[k] / 2, b = solver->p[k] * solver->h[k];
        energy += a - b;
        size += fabs(a) + fabs(b);
    }
    if (energy > guard->energy + 1e-13 * size) /* more than rounding */
        return true;
    guard->energy = energy;
    return false;
}

/* The largest row sum of K bounds its eigenvalues; on a periodic map they are known, and the longest
 * wave has the largest. t and r are scratch. */
static double
norm(struct rc_solver *solver, double *t, double *r)
{
    double largest = 0;
    double lx = solver->shape.dx * (double)solver->shape.nx;
    double ly = solver->shape.dy * (double)solver->shape.ny;

    if (solver->boundary == RC_PERIODIC) /* 2 / E* q, q = 2 pi / L */
        return fmax(lx, ly) / (3.14159265358979323846 * solver->estar);

    for (size_t k = 0; k < solver->n; k++)
        t[k] = 1;
    rc_conv_apply(solver->conv, t, r);
    solver->convolutions++;
    for (size_t k = 0; k < solver->n; k++)
        largest = fmax(largest, r[k]);
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

void
rc_guard_step(struct rc_guard *guard, struct rc_solver *solver, const double *old, double *t,
              double *r)
{
    double above = 0, below = 0, size = 0, length, shift;

    memcpy(solver->p, old, solver->n * sizeof *old);
    if (guard->norm == 0)
        guard->norm = norm(solver, t, r);
    rc_conv_apply(solver->conv, solver->p, r);
    solver->convolutions++;
    rc_solver_gap(solver, r, solver->g, &shift); /* without its mean: t adds up to 0 but for rounding */
    for (size_t k = 0; k < solver->n; k++)
        t[k] = solver->p[k] - solver->g[k] / guard->norm;
    rc_box_project(solver->n, NULL, solver->hardness, solver->sum, t);
    for (size_t k = 0; k < solver->n; k++) {
        t[k] -= solver->p[k];
        size += fabs(t[k]);
    }
    if (size <= 1e-15 * solver->sum)
        return; /* this is as near as rounding lets us come */
    rc_conv_apply(solver->conv, t, r);
    solver->convolutions++;
    for (size_t k = 0; k < solver->n; k++) {
        above -= solver->g[k] * t[k];
        below += r[k] * t[k];
    }
    length = fmin(below > 0 && above > 0 ? above / below : 0, longest(solver, t));
    for (size_t k = 0; k < solver->n; k++)
        solver->p[k] = fmin(fmax(solver->p[k] + length * t[k], 0), solver->hardness);
    /* what rounding took of the load; should memory be short, that little is missing */
    (void)rc_box_balance(solver->n, solver->hardness, solver->sum, solver->g, solver->p, NULL);
}
