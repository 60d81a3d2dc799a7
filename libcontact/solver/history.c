/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A loading history: each load acts on the shape after the earlier loads, and between two loads the bodies
 * may be separated.
 *
 * The error of the pressure of a yielding load stays in the dents. The map from one shape to the next does
 * not increase this error, so the errors (N) of all earlier loads add up. Their sum over the present load is
 * a part of its relative error.
 */
#include "solver.h"

#include <math.h>

/* The smallest relative tolerance of a yielding load: below it only rounding of the sum of a map is
 * left. Not sensitive: half and double change no bit of 123 contacts (bench/constants.py). */
static const double finest = 1e-11;

double
rc_history_error(const struct rc_solver *s)
{
    return s->posed.dents > 0 ? s->posed.dents / s->load.load : 0;
}

double
rc_history_goal(const struct rc_solver *s)
{
    const struct rc_posed *posed = &s->posed;
    double yielding = fmax(posed->history_part * posed->tol, fmin(posed->tol, finest));

    if (s->load.tol > posed->tol || posed->history_part == 0)
        return s->load.tol;
    if (s->set.saturated > 0)
        return fmin(s->load.tol, yielding);
    return fmin(s->load.tol, fmax(posed->tol - rc_history_error(s), yielding));
}

enum rc_status
rc_solver_keep_shape(struct rc_solver *s, const struct rc_contact *c, double *h, struct rc_err *err)
{
    double height_error = c->shape_error, off = c->pressure_error - c->inherited_error, dents;

    if (c->yielded_nodes == 0)
        return RC_OK;
    off += s->load.target > 0 ? RC_LOAD_TOL * s->posed.tol : 0;
    dents = s->posed.dents + off * c->load;
    if (rc_solver_plastic(s, h, err) != RC_OK || rc_solver_next_heights(s, h, err) != RC_OK)
        return RC_FAIL;
    s->posed.height_error = height_error;
    s->posed.dents = dents;
    return RC_OK;
}

void
rc_contact_apart(const struct rc_ranks *ranks, const struct rc_shape *shape, const double *h,
                 double *gap, struct rc_contact *contact)
{
    const struct rc_rows rows = rc_rows_of(ranks, shape);
    size_t n = rows.n * shape->nx;
    struct rc_total sum = {0};
    double top = -INFINITY;

    for (size_t k = 0; k < n; k++) {
        top = fmax(top, h[k]);
        rc_total_add(&sum, h[k]);
    }
    top = rc_ranks_most(ranks, top);
    *contact = (struct rc_contact){.edge_load_fraction = NAN,
                                   .approach = NAN,
                                   .mean_gap = top - rc_ranks_total(ranks, sum) /
                                                         (double)(shape->nx * shape->ny),
                                   .discretization = {NAN, NAN, NAN},
                                   .converged = true};
    for (size_t k = 0; k < n && gap != NULL; k++)
        gap[k] = top - h[k];
}
