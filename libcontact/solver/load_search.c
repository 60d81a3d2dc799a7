/*
 * The load that an approach needs. The shift grows with the load, nearly as a power of it (2/3 for
 * a sphere, 1 for a punch): secants in logarithms, inside a bracket. Each load starts from the
 * solution of the last, and the first are solved only as well as the next guess can use.
 */
#include "solver.h"

#include <math.h>

static const double loose = 1e-2; /* tolerance of the first loads */

void
rc_load_search_begin(struct rc_solver *s, double target)
{
    s->tol = fmax(s->goal, loose);
    s->seek = (struct rc_load_search){.target = target, .high = INFINITY, .power = 1.5};
}

/* The load at which the shift would be the target, by the power law through the last solution. */
static double
next_load(const struct rc_load_search *q, double load, double shift)
{
    double next = shift > 0 ? load * pow(q->target / shift, q->power) : 2 * load;

    next = fmin(fmax(next, load / 8), load * 8);
    if (next > q->low && next < q->high)
        return next;
    if (q->low > 0 && !isinf(q->high))
        return sqrt(q->low * q->high);
    return shift < q->target ? load * 2 : load / 2;
}

enum rc_status
rc_load_search_step(struct rc_solver *s)
{
    struct rc_load_search *q = &s->seek;
    double most = s->hardness * s->cell * (double)s->n, shift, next, off;

    rc_solver_shift(s);
    shift = s->elastic > 0 ? s->shift : INFINITY; /* saturated: too much */
    if (q->load > 0 && q->shift > 0 && shift > 0 && !isinf(shift) && shift != q->shift) {
        double power = log(s->load / q->load) / log(shift / q->shift);
        if (power > 0.2 && power < 20)
            q->power = power;
    }
    q->load = s->load;
    q->shift = isinf(shift) ? 0 : shift;
    if (shift < q->target)
        q->low = fmax(q->low, s->load);
    else
        q->high = fmin(q->high, s->load);
    next = next_load(q, s->load, isinf(shift) ? 1e3 * q->target : shift);
    if (next > most)
        next = most;
    off = fabs(next / s->load - 1);
    if (off <= 0.1 * s->goal || next == s->load || q->high <= q->low * (1 + 1e-15)) {
        if (s->tol <= s->goal)
            return RC_OK;
        s->tol = s->goal; /* the right load, but not yet well solved */
        s->change = 1;
        return RC_MORE;
    }
    s->tol = fmax(s->goal, fmin(loose, 0.1 * off));
    if (rc_solver_set_load(s, next, NULL) != RC_OK ||
        rc_box_balance(s->n, s->hardness, s->sum, s->v, s->p, NULL) != RC_OK)
        return RC_SHORT;
    rc_solver_restart(s);
    return RC_MORE;
}
