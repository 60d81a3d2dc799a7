/*
 * A loading history: each load acts on the shape that the earlier loads have left, and between two
 * loads the bodies may be taken apart.
 */
#include "solver.h"

#include <math.h>

enum rc_status
rc_solver_keep_shape(struct rc_solver *s, const struct rc_contact *c, double *h, struct rc_err *err)
{
    double height_error = c->shape_error;

    if (c->yielded_nodes == 0)
        return RC_OK;
    if (rc_solver_plastic(s, h, err) != RC_OK || rc_solver_set_heights(s, h, err) != RC_OK)
        return RC_FAIL;
    s->posed.height_error = height_error;
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
