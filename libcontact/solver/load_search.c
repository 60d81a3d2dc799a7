/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The load: given, or found for a given approach. The shift grows nearly as a power of the load (2/3 for a
 * sphere, 1 for a punch). So the search is a secant method in logarithms, inside a bracket. Each load starts
 * from the solution of the last one, and the first loads are solved to a loose tolerance, enough for the next
 * guess.
 */
#include "solver.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "libcontact/memory.h"

/* Tolerance of the first loads. Not sensitive: of the 74 contacts of bench/constants.py the 11 with a
 * given approach take within 2 % as many convolutions with half and with double. */
static const double loose = 1e-2;
/* The exponent of the law at the solution is that between two loads within `bent`, and within `farther`
 * times the logarithm of their ratio more: in 5600 contacts of few to all nodes, with all boundaries, the
 * secant was up to 7 % less steep between near loads and up to 28 % less between far ones. */
static const double bent = 1.1, farther = 0.5;
/* Change of the exponent when one of n elastic nodes reaches its hardness, times n: up to 1.6 was found. */
static const double yielding = 2;
/* Error of the shift that the shares of n nodes leave, as a part of the error of the contact times the root
 * of n: it was up to 0.25 with 5 to 8 nodes, and a few times up to 2 with 200 and more. */
static const double uneven = 0.5;

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
        s->load.sum = bounds->full; /* every node is at its upper bound, exactly */
    rc_bounds_keep_load(&s->posed.bounds, s->load.sum);
    set_units(&s->load, s->posed.nodes, s->op->unit);
    return RC_OK;
}

/* ---- the first load ---- */

static void
begin_search(struct rc_solver *s, double target)
{
    s->load.tol = fmax(s->posed.tol, loose);
    s->load.target = target;
    s->load.low = s->load.last_load = s->load.last_shift = 0;
    s->load.high = INFINITY;
    s->load.error = NAN;
    s->load.power = 1.5; /* of a ball (Hertz); the search replaces it after two loads */
    s->load.slope = s->load.power;
    s->load.apart = log(8); /* no pair of loads yet */
}

static void
depth_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_solver *s = at;

    sums[0] = rc_sum(s->posed.h + first, n);
    for (size_t k = first; k < first + n; k++)
        sums[RC_MOST] = fmax(sums[RC_MOST], -s->posed.h[k]);
}

/* RC_FAIL where every node reaches its hardness before this approach: under that load the approach is
 * undetermined. The last node to yield is the one with the largest K H - h, which is at least that of the
 * lowest node, at `depth`. */
static enum rc_status
check_yield(struct rc_solver *s, double approach, double depth, struct rc_err *err)
{
    const struct rc_box box = rc_box(s, 0);
    size_t n = s->posed.n;
    RC_OWNED double *p = NULL, *u = NULL;
    double last = -INFINITY;

    if (approach < depth || isinf(s->posed.bounds.full) || s->posed.rough)
        return RC_OK;
    p = rc_alloc(n, sizeof *p);
    u = rc_alloc(n, sizeof *u);
    if (rc_ranks_need(s->posed.rows.ranks, p != NULL && u != NULL, err,
                      "out of memory for an approach of %zu x %zu nodes", s->posed.whole.nx,
                      s->posed.whole.ny) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < n; k++)
        p[k] = rc_high(box, k);
    rc_operator_apply(s->op, p, u);
    rc_iterate_count(s, 1);
    for (size_t k = 0; k < n; k++)
        last = fmax(last, u[k] - s->posed.h[k]);
    last = rc_ranks_most(s->posed.rows.ranks, last) + s->op->rise * s->posed.bounds.full;
    if (approach >= last)
        return rc_err_set(
            err,
            "approach %.9g m: at %.9g m and a load of %.9g N every node is at its hardness, "
            "and the load cannot increase further; give a smaller approach or the load",
            approach, last, s->posed.bounds.full * s->posed.cell);
    return RC_OK;
}

/* RC_FAIL where a larger load may decrease the approach. */
static enum rc_status
check_datum(const struct rc_solver *s, struct rc_err *err)
{
    const double datum = rc_boundary_on(&s->posed.whole, s->posed.boundary).datum;

    if (rc_repeats(s->posed.boundary) == 1 && datum < s->op->nearest)
        return rc_err_set(err,
                          "datum %g m: an approach that grows with the load needs one of at least "
                          "%g m; give a larger datum or the load",
                          datum, s->op->nearest);
    return RC_OK;
}

enum rc_status
rc_load_reach(double approach, double full, struct rc_err *err)
{
    if (!(approach >= full))
        return RC_OK;
    return rc_err_set(err,
                      "approach %.9g m: the contact of this periodic surface is complete at %.9g "
                      "m, and a larger load does not change the approach; give the load instead",
                      approach, full);
}

bool
rc_load_completes(const struct rc_solver *s)
{
    return s->tilt == NULL && s->op->mean_free && !rc_bounded(&s->posed.bounds);
}

/* RC_FAIL where complete contact is reached before this approach: a larger load does not increase the
 * approach. */
static enum rc_status
check_approach(struct rc_solver *s, double approach, struct rc_err *err)
{
    bool bounded = rc_bounded(&s->posed.bounds);
    double total[RC_SUMS];

    if (check_datum(s, err) != RC_OK)
        return RC_FAIL;
    if (s->tilt != NULL || (!s->op->mean_free && !bounded))
        return RC_OK;
    rc_reduce_blocks(s, depth_block, s, total);
    if (bounded)
        return check_yield(s, approach, total[RC_MOST], err);
    return rc_load_reach(approach, -total[0] / (double)s->posed.nodes, err);
}

/* Where the load is sought, the given load is a first guess. Without one, the guess is the load of a flat
 * punch with the area of the surface above the approach. */
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
        guess = s->posed.cell / s->op->unit * problem->approach * sqrt((double)cut) /
                (1 + s->op->soft.plus / (s->op->unit * sqrt((double)cut)));
    begin_search(s, problem->approach);
    if (!problem->tilt_free && check_approach(s, problem->approach, err) != RC_OK)
        return RC_FAIL;
    return rc_load_set(s, guess < most ? guess : most, err);
}

static enum rc_status
set_next(struct rc_solver *s, double load, double approach, struct rc_err *err)
{
    s->load.tol = s->posed.tol;
    s->load.target = 0;
    if (approach > 0) {
        begin_search(s, approach);
        load = s->load.load; /* first guess */
    }
    return rc_load_set(s, load, err);
}

enum rc_status
rc_load_next(struct rc_solver *s, double load, double approach, struct rc_err *err)
{
    if (approach > 0 && check_approach(s, approach, err) != RC_OK)
        return RC_FAIL;
    return set_next(s, load, approach, err);
}

enum rc_status
rc_load_again(struct rc_solver *s, struct rc_err *err)
{
    return set_next(s, s->load.load, s->load.target, err);
}

/* ---- the search ---- */

/* The load with this shift, by the power law through the last solution. */
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

/* Lowers the tolerance. The bracket came from less accurate solutions and may miss the load, so it is
 * dropped. */
static void
tighten(struct rc_load *q, double tol)
{
    if (!(tol < q->tol))
        return;
    q->tol = tol;
    q->low = 0;
    q->high = INFINITY;
}

double
rc_load_error(struct rc_solver *s)
{
    const struct rc_load *q = &s->load;
    const bool bounded = rc_bounded(&s->posed.bounds);
    const double n = (double)s->it.elastic;
    double shift, caution, error;

    if (q->target == 0 || s->it.elastic == 0)
        return 0;
    if (!isnan(q->error))
        return q->error;
    shift = rc_tilt_approach(s) + rc_working_set_shift(s) - s->it.shift;
    caution = bent + farther * q->apart + (bounded ? yielding / n : 0);
    error = caution * fabs(pow(q->target / shift, q->slope) - 1) + uneven * s->it.error / sqrt(n);
    return bounded && q->low > 0 ? fmin(error, q->high / q->low - 1) : error;
}

bool
rc_load_reached(const struct rc_solver *s)
{
    return s->load.target == 0 ||
           fabs(rc_tilt_approach(s) / s->load.target - 1) <= 10 * s->posed.tol;
}

static void
bound_block(void *at, size_t first, size_t n, double *sums)
{
    struct rc_solver *s = at;
    const struct rc_box box = rc_box(s, 0);

    for (size_t k = first; k < first + n; k++) {
        double low = rc_low(box, k), high = rc_high(box, k);
        s->it.p[k] = s->it.p[k] > (low + high) / 2 ? high : low;
        sums[0] += s->it.p[k];
    }
}

/* While no node is elastic the approach varies at constant load: the loads next to it have approaches that
 * are too small and too large. Sets all nodes to a bound. Returns false if this contact does not have the
 * wanted approach either. */
static bool
settle(struct rc_solver *s)
{
    double total[RC_SUMS];

    rc_reduce_blocks(s, bound_block, s, total);
    rc_solver_restart(s);
    if (rc_load_set(s, total[0] * s->posed.cell, NULL) != RC_OK)
        return false;
    rc_iterate_checked(s, rc_iterate_judge(s), 1);
    return s->it.error <= s->posed.tol && rc_load_reached(s);
}

/* False if the errors of contact and load together exceed the tolerance: the contact then gets a smaller one,
 * once. */
static bool
accurate(struct rc_solver *s)
{
    struct rc_load *q = &s->load;
    const double tol = s->posed.tol, left = fmax(tol - rc_load_error(s), tol / 2);

    if (s->posed.rough || s->tilt != NULL || q->tol < tol || s->it.error <= left)
        return true;
    tighten(q, left);
    return false;
}

enum rc_status
rc_load_search(struct rc_solver *s)
{
    struct rc_load *q = &s->load;
    double most = s->posed.bounds.full * s->posed.cell, shift, next, off;
    bool closed, done;

    rc_iterate_shift(s);
    shift = rc_tilt_approach(s);
    if (q->last_load > 0 && q->last_shift > 0 && shift > 0 && shift != q->last_shift) {
        double power = log(q->load / q->last_load) / log(shift / q->last_shift);
        if (power > 0.2 && power < 20) {
            q->power = power;
            /* the errors of two contacts change the shift by more than a small step of the load */
            if (fabs(q->load / q->last_load - 1) >= q->last_error + s->it.error) {
                q->slope = power;
                q->apart = fabs(log(q->load / q->last_load));
            }
        }
    }
    q->last_error = s->it.error;
    q->last_load = q->load;
    q->last_shift = shift;
    if (shift < q->target)
        q->low = fmax(q->low, q->load);
    else
        q->high = fmin(q->high, q->load);
    next = next_load(q, q->load, shift);
    if (next > most)
        next = most;
    off = fabs(next / q->load - 1);
    closed = next == q->load || q->high <= q->low * (1 + 1e-15);
    done = closed || off <= RC_LOAD_TOL * s->posed.tol;
    if (done && q->tol > s->posed.tol) {
        /* the load is right, but the contact is not solved accurately enough */
        tighten(q, s->posed.tol);
        return RC_MORE;
    }
    if (done && (rc_load_reached(s) || !rc_bounded(&s->posed.bounds) || settle(s)))
        return accurate(s) ? RC_OK : RC_MORE;
    if (closed)
        return RC_SHORT;
    /* where nodes yield the approach jumps, so a load near the right one can still have a wrong approach */
    tighten(q, rc_bounded(&s->posed.bounds) && off < loose ? s->posed.tol
                                                           : fmax(s->posed.tol, 0.1 * off));
    if (rc_load_set(s, next, NULL) != RC_OK)
        return RC_SHORT;
    rc_projection_balance(s, s->it.v);
    rc_solver_restart(s);
    return RC_MORE;
}
