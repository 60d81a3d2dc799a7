/*
 * How a solver is stepped: a method's step, the judgement of what it has reached, other loads and
 * starts.
 */
#include "solver.h"

#include <float.h>
#include <math.h>

/* ---- judging ---- */

/* The load is a constraint that every method keeps; should one lose it, the result is none. */
bool
rc_solver_load_kept(const struct rc_solver *s)
{
    return fabs(rc_solver_carried(s) - s->sum) <= 1e-10 * s->sum;
}

static double
judge(struct rc_solver *s)
{
    if (!s->fresh)
        rc_solver_displace(s);
    rc_solver_shift(s);
    rc_solver_residual(s, false);
    return rc_solver_estimate(s);
}

/* One iteration at the load that is set. */
static enum rc_status
step(struct rc_solver *s)
{
    bool last;

    s->method->step(s, s->state);
    s->iterations++;
    if (!isnan(s->estimate)) {
        s->error = s->estimate;
        s->judged = s->iterations;
        if (s->error <= s->tol && (s->rough || rc_solver_load_kept(s)))
            return RC_OK;
        return s->iterations >= s->max_iterations || s->change == 0 ? RC_SHORT : RC_MORE;
    }
    last = s->iterations >= s->max_iterations || s->change <= DBL_EPSILON;
    /* Four convolutions to judge, two to go on: not before the steps are small, nor every time. */
    if (!last && (s->iterations < s->next_check || s->change > s->tol))
        return RC_MORE;
    s->error = judge(s);
    s->judged = s->iterations;
    s->next_check = s->iterations + 5 + s->iterations / 10;
    if (s->error <= s->tol && rc_solver_load_kept(s))
        return RC_OK;
    return last ? RC_SHORT : RC_MORE;
}

enum rc_status
rc_solver_step(struct rc_solver *s)
{
    enum rc_status status = step(s);

    if (s->watch != NULL && !s->watch(s->watcher, &s->shape, s->iterations, s->error, s->tol) &&
        s->rough)
        return RC_SHORT;
    return status == RC_OK && s->seek.target > 0 ? rc_load_search_step(s) : status;
}

void
rc_solver_restart(struct rc_solver *s)
{
    s->known = s->fresh = false;
    s->change = s->error = s->estimate = NAN;
    s->next_check = s->iterations + 1;
    s->method->again(s->state);
    rc_solver_forget(s);
}

enum rc_status
rc_solver_again(struct rc_solver *s, double load, double approach, struct rc_err *err)
{
    s->tol = s->goal;
    if (approach > 0) {
        rc_load_search_begin(s, approach);
        load = s->load; /* to begin with */
    } else {
        s->seek.target = 0;
    }
    if (rc_solver_set_load(s, load, err) != RC_OK ||
        rc_box_balance(s->n, s->hardness, s->sum, s->v, s->p, err) != RC_OK)
        return RC_FAIL;
    s->iterations = 0;
    s->convolutions = 0;
    rc_solver_restart(s);
    return RC_OK;
}

enum rc_status
rc_solver_start(struct rc_solver *s, double load, const double *p, struct rc_err *err)
{
    if (s->seek.target > 0 && rc_solver_set_load(s, load, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < s->n; k++)
        if (!isfinite(p[k]))
            return rc_err_set(err, "pressure %zu is not a finite number", k);
    for (size_t k = 0; k < s->n; k++) {
        s->p[k] = fmin(fmax(p[k], 0), s->hardness);
        s->v[k] = -s->h[k]; /* should nodes have to join, the highest first */
    }
    if (fabs(rc_solver_carried(s) - s->sum) > 1e-14 * s->sum &&
        rc_box_balance(s->n, s->hardness, s->sum, s->v, s->p, err) != RC_OK)
        return RC_FAIL;
    rc_solver_restart(s);
    return RC_OK;
}

/* ---- results ---- */

double
rc_solver_load(const struct rc_solver *s)
{
    return s->load;
}

size_t
rc_solver_iterations(const struct rc_solver *s)
{
    return s->iterations;
}

double
rc_solver_error(const struct rc_solver *s)
{
    return s->error;
}

double
rc_solver_convolutions(const struct rc_solver *s)
{
    return s->convolutions;
}

const double *
rc_solver_pressure(const struct rc_solver *s)
{
    return s->p;
}

const char *
rc_solver_engine(const struct rc_solver *s)
{
    return rc_conv_engine(s->conv);
}

const char *
rc_solver_engine_reason(const struct rc_solver *s)
{
    return rc_conv_reason(s->conv);
}

const char *
rc_solver_method(const struct rc_solver *s)
{
    return s->method->info.name;
}
