/* What rc-solve shows while it works: the grid, the iteration, how far it is, and about how long
 * it will take. */
#include "solve.h"

#include <math.h>

/* Seconds until the error is `tol`, if it goes on shrinking as it has on this grid; NAN: it
 * can't be told yet. */
static double
left(struct progress *q, size_t nodes, size_t iterations, double error, double tol)
{
    double now = solve_now(), rate;

    if (nodes != q->nodes || iterations <= q->iterations ||
        isnan(q->error)) { /* another grid, or load */
        *q = (struct progress){.nodes = nodes, .iterations = iterations, .error = error, .at = now};
        return NAN;
    }
    if (!(error < q->error) || !(error > tol))
        return NAN;
    rate = log(q->error / error) / (now - q->at);
    return log(error / tol) / rate;
}

void
solve_progress(struct run *run, const struct rc_solver *solver)
{
    struct rc_progress p;
    char how_far[64] = "", how_long[64] = "";
    double seconds;
    size_t nodes;

    rc_solver_progress(solver, &p);
    nodes = p.grid.nx * p.grid.ny;
    seconds = left(&run->progress, nodes, p.iterations, p.error, p.tol);
    if (!isnan(p.error))
        snprintf(how_far, sizeof how_far, ", error %.1e of %.1e", p.error, p.tol);
    if (!isnan(seconds) && nodes == run->nodes)
        snprintf(how_long, sizeof how_long, ", about %.*f s left", seconds < 10 ? 1 : 0, seconds);
    tool_progress(&run->t, "case %zu, %zu x %zu, iteration %zu%s%s", run->number, p.grid.nx,
                  p.grid.ny, p.iterations, how_far, how_long);
}
