/*
 * What keeps a method from cycling. The energy 1/2 p'Kp - h'p costs nothing to follow and must
 * fall. A step that raised it is taken back, and a projected-gradient step is made in its place,
 * which lowers it by at least |K|/2 times the square of its own length: no cycle can close.
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
    double most = INFINITY;

    for (size_t k = 0; k < solver->posed.n; k++) {
        if (t[k] < 0)
            most = fmin(most, -solver->it.p[k] / t[k]);
        else if (t[k] > 0)
            most = fmin(most, (solver->posed.hardness - solver->it.p[k]) / t[k]);
    }
    return most;
}

void
rc_safeguard_step(struct rc_solver *solver, const double *old, double *t, double *r)
{
    double above = 0, below = 0, size = 0, length, norm = solver->op->norm;

    memcpy(solver->it.p, old, solver->posed.n * sizeof *old);
    rc_iterate_displace(solver);
    rc_iterate_shift(solver);
    for (size_t k = 0; k < solver->posed.n; k++)
        t[k] = solver->it.p[k] - (solver->it.v[k] - solver->it.shift) / norm;
    rc_projection_of(solver->posed.n, solver->posed.hardness, solver->load.sum, t);
    for (size_t k = 0; k < solver->posed.n; k++) {
        t[k] -= solver->it.p[k];
        size += fabs(t[k]);
    }
    if (size <= 1e-15 * solver->load.sum)
        return; /* this is as near as rounding lets us come */
    rc_operator_apply(solver->op, t, r);
    rc_iterate_count(solver, 1);
    for (size_t k = 0; k < solver->posed.n;
         k++) { /* without the shift: t adds up to 0 but for rounding */
        above -= (solver->it.v[k] - solver->it.shift) * t[k];
        below += r[k] * t[k];
    }
    length = fmin(below > 0 && above > 0 ? above / below : 0, longest(solver, t));
    for (size_t k = 0; k < solver->posed.n; k++)
        solver->it.p[k] = fmin(fmax(solver->it.p[k] + length * t[k], 0), solver->posed.hardness);
    /* what rounding took of the load; should memory be short, that little is missing */
    (void)rc_projection_balance(solver->posed.n, solver->posed.hardness, solver->load.sum,
                                solver->it.v, solver->it.p, NULL);
}
