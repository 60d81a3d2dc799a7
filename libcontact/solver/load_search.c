/*
 * The load: it is given, or it is sought for a given approach. The shift grows nearly as a power of
 * the load (2/3 for a sphere, 1 for a punch), so the search takes secants in logarithms, inside a
 * bracket. Each load starts from the solution of the last one, and the first loads are solved only
 * as accurately as the next guess needs.
 */
#include "solver.h"

#include <float.h>
#include <math.h>

static const double loose = 1e-2; /* tolerance of the first loads */

static void
set_units(struct rc_load *load, size_t n, double unit)
{
    int exponent;

    (void)frexp(load->sum / (double)n, &exponent);
    load->per_pressure = ldexp(1, -exponent);
    load->length = unit * ldexp(1, exponent);
}

enum rc_status
rc_load_check(double load, const struct rc_bounds *bounds, double cell, size_t nodes,
              struct rc_err *err)
{
    if (!(load > 0) || isinf(load))
        return rc_err_set(err, "load %g N: it must be positive and finite", load);
    return rc_bounds_carry(bounds, load, cell, nodes, err);
}

enum rc_status
rc_load_set(struct rc_solver *s, double load, struct rc_err *err)
{
    const struct rc_bounds *bounds = &s->posed.bounds;

    if (rc_load_check(load, bounds, s->posed.cell, s->posed.nodes, err) != RC_OK)
        return RC_FAIL;
    s->load.load = load;
    s->load.sum = load / s->posed.cell;
    if (s->load.sum >= bounds->full * (1 - 8 * DBL_EPSILON))
        s->load.sum = bounds->full; /* every node yields, whatever the rounding */
    rc_bounds_keep_load(&s->posed.bounds, s->load.sum);
    set_units(&s->load, s->posed.nodes, s->op->unit);
    return RC_OK;
}

/* ---- where it begins ---- */

static void
begin_search(struct rc_solver *s, double target)
{
    s->load.tol = fmax(s->posed.tol, loose);
    s->load.target = target;
    s->load.low = s->load.last_load = s->load.last_shift = 0;
    s->load.high = INFINITY;
    s->load.power = 1.5;
}

static void
height_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = at;

    sums[0] = rc_sum(s->posed.h + first, n);
}

/* RC_FAIL where complete contact is reached before this approach: the bodies come no nearer. */
static enum rc_status
check_approach(struct rc_solver *s, double approach, struct rc_err *err)
{
    double total[RC_SUMS], full;

    if (!s->op->mean_free || rc_bounded(&s->posed.bounds))
        return RC_OK;
    rc_reduce_blocks(s, height_block, s, total);
    full = -total[0] / (double)s->posed.nodes;
    if (approach >= full)
        return rc_err_set(err,
                          "approach %.9g m: contact is complete at %.9g m, and from there "
                          "the load of a periodic surface grows at the same approach; "
                          "give the load",
                          approach, full);
    return RC_OK;
}

/* Where the load is sought, the given load is a guess; without it, the guess is the load of a flat
 * punch that is as large as the part of the surface above the approach. */
enum rc_status
rc_load_first(struct rc_solver *s, const struct rc_problem *problem, struct rc_err *err)
{
    double guess = problem->load;
    double most = s->posed.bounds.full * s->posed.cell / 2;
    size_t cut = 0;

    s->load = (struct rc_load){.tol = s->posed.tol};
    if (!(problem->approach > 0))
        return rc_load_set(s, problem->load, err);
    for (size_t k = 0; k < s->posed.n; k++)
        cut += s->posed.h[k] >= -problem->approach;
    cut = rc_ranks_sum(s->posed.rows.ranks, cut);
    if (!(guess > 0))
        guess = s->posed.cell / s->op->unit * problem->approach * sqrt((double)cut);
    begin_search(s, problem->approach);
    if (check_approach(s, problem->approach, err) != RC_OK)
        return RC_FAIL;
    return rc_load_set(s, guess < most ? guess : most, err);
}

enum rc_status
rc_load_next(struct rc_solver *s, double load, double approach, struct rc_err *err)
{
    s->load.tol = s->posed.tol;
    s->load.target = 0;
    if (approach > 0) {
        if (check_approach(s, approach, err) != RC_OK)
            return RC_FAIL;
        begin_search(s, approach);
        load = s->load.load; /* to begin with */
    }
    return rc_load_set(s, load, err);
}

/* ---- the search ---- */

/* The load at which the shift would be the target, by the power law through the last solution. */
static double
next_load(const struct rc_load *q, double load, double shift)
{
    double next = shift > 0 ? load * pow(q->target / shift, q->power) : 2 * load;

    next = fmin(fmax(next, load / 8), load * 8);
    if (next > q->low && next < q->high)
        return next;
    if (q->low > 0 && !isinf(q->high))
        return sqrt(q->low * q->high);
    return shift < q->target ? load * 2 : load / 2;
}

/* The next solution is more accurate. The bracket, which came from less accurate ones, may not hold the
 * load that is sought: it is dropped. */
static void
tighten(struct rc_load *q, double tol)
{
    if (!(tol < q->tol))
        return;
    q->tol = tol;
    q->low = 0;
    q->high = INFINITY;
}

enum rc_status
rc_load_search(struct rc_solver *s)
{
    struct rc_load *q = &s->load;
    double most = s->posed.bounds.full * s->posed.cell, shift, next, off;

    rc_iterate_shift(s);
    shift = s->it.elastic > 0 ? rc_tilt_approach(s) : INFINITY; /* saturated: too much */
    if (q->last_load > 0 && q->last_shift > 0 && shift > 0 && !isinf(shift) &&
        shift != q->last_shift) {
        double power = log(q->load / q->last_load) / log(shift / q->last_shift);
        if (power > 0.2 && power < 20)
            q->power = power;
    }
    q->last_load = q->load;
    q->last_shift = isinf(shift) ? 0 : shift;
    if (shift < q->target)
        q->low = fmax(q->low, q->load);
    else
        q->high = fmin(q->high, q->load);
    next = next_load(q, q->load, isinf(shift) ? 1e3 * q->target : shift);
    if (next > most)
        next = most;
    off = fabs(next / q->load - 1);
    if (off <= 0.1 * s->posed.tol || next == q->load || q->high <= q->low * (1 + 1e-15)) {
        if (q->tol <= s->posed.tol)
            return RC_OK;
        tighten(q, s->posed.tol); /* the right load, but not yet well solved */
        return RC_MORE;
    }
    tighten(q, fmax(s->posed.tol, 0.1 * off));
    if (rc_load_set(s, next, NULL) != RC_OK)
        return RC_SHORT;
    rc_projection_balance(s, s->it.v);
    rc_solver_restart(s);
    return RC_MORE;
}
