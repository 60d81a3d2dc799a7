/*
 * What keeps a method from cycling. The energy 1/2 p'Kp - h'p costs nothing to follow and must
 * fall. A step that raised it is taken back, and a projected-gradient step is made in its place,
 * which lowers it by at least |K|/2 times the square of its own length: no cycle can close.
 */
#include "solver.h"

#include <math.h>
#include <string.h>

static void
energy_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = at;

    for (size_t k = first; k < first + n; k++) {
        double a = s->p[k] * s->v[k] / 2, b = s->p[k] * s->h[k] / 2; /* v = K p - h */
        sums[0] += a - b;
        sums[1] += fabs(a) + fabs(b);
    }
}

bool
rc_safeguard_raised(struct rc_safeguard *guard, const struct rc_solver *solver)
{
    double total[RC_SUMS];

    rc_solver_blocks(solver, energy_block, (void *)(size_t)solver, total);
    if (total[0] > guard->energy + 1e-13 * total[1]) /* more than rounding */
        return true;
    guard->energy = total[0];
    return false;
}

/* On the free boundary the largest row sum of K: what a uniform pressure does in the middle of a
 * rectangle a x b, 2 (a asinh(b/a) + b asinh(a/b)) / (pi E*) (Love 1929; Johnson 1985, eq.
 * 3.25). On a periodic map the eigenvalues are known, and the longest wave has the largest, 2 /
 * (E* q), q = 2 pi / L. */
double
rc_safeguard_norm(const struct rc_solver *s)
{
    const double pi = 3.14159265358979323846;
    double a = s->shape.dx * (double)s->shape.nx, b = s->shape.dy * (double)s->shape.ny;

    if (s->boundary == RC_PERIODIC)
        return fmax(a, b) / (pi * s->estar);
    return 2 * (a * asinh(b / a) + b * asinh(a / b)) / (pi * s->estar);
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
rc_safeguard_step(struct rc_solver *solver, const double *old, double *t, double *r)
{
    double above = 0, below = 0, size = 0, length, norm = rc_safeguard_norm(solver);

    memcpy(solver->p, old, solver->n * sizeof *old);
    rc_solver_displace(solver);
    rc_solver_shift(solver);
    for (size_t k = 0; k < solver->n; k++)
        t[k] = solver->p[k] - (solver->v[k] - solver->shift) / norm;
    rc_box_project(solver->n, NULL, solver->hardness, solver->sum, t);
    for (size_t k = 0; k < solver->n; k++) {
        t[k] -= solver->p[k];
        size += fabs(t[k]);
    }
    if (size <= 1e-15 * solver->sum)
        return; /* this is as near as rounding lets us come */
    rc_conv_apply(solver->conv, t, r);
    solver->convolutions++;
    for (size_t k = 0; k < solver->n;
         k++) { /* without the shift: t adds up to 0 but for rounding */
        above -= (solver->v[k] - solver->shift) * t[k];
        below += r[k] * t[k];
    }
    length = fmin(below > 0 && above > 0 ? above / below : 0, longest(solver, t));
    for (size_t k = 0; k < solver->n; k++)
        solver->p[k] = fmin(fmax(solver->p[k] + length * t[k], 0), solver->hardness);
    /* what rounding took of the load; should memory be short, that little is missing */
    (void)rc_box_balance(solver->n, solver->hardness, solver->sum, solver->v, solver->p, NULL);
}
