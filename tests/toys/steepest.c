/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method that is not part of the library, in one file and one row of a list. It is steepest descent in the
 * metric of the preconditioner. Each step goes to the minimum along its direction and is projected onto the
 * bounds. */
#include "libcontact/solver/solver.h"

#include "libcontact/memory.h"

static void *
state_new(struct rc_solver *s)
{
    return rc_store_take(&s->own, s->posed.n, 2 * sizeof(double) + sizeof(float));
}

static struct rc_found
step(struct rc_solver *s, void *state)
{
    size_t n = s->posed.n;
    double *d = state, *u = d + n, slope = 0, curvature = 0;
    struct rc_move move = {.solver = s, .d = s->z, .delta = (float *)(u + n)};

    rc_iterate_displace(s);
    rc_iterate_shift(s);
    rc_working_set_find(s, true);
    rc_working_set_correct(s, NULL, NULL);
    for (size_t k = 0; k < n; k++)
        move.mean += (double)s->z[k] / (double)s->set.size;
    for (size_t k = 0; k < n; k++) {
        d[k] = s->z[k] != 0 ? (double)s->z[k] - move.mean : 0;
        slope -= (s->it.v[k] - s->it.shift) * d[k];
    }
    rc_operator_apply(s->op, d, u);
    rc_iterate_count(s, 1);
    for (size_t k = 0; k < n; k++)
        curvature += u[k] * d[k];
    move.alpha = slope > 0 ? slope / curvature : 0;
    rc_move_shift(&move);
    rc_iterate_unknown(s);
    return (struct rc_found){.change = move.size / s->load.sum, .estimate = NAN};
}

const struct rc_method rc_method_steepest = {
    .info = {.name = "steepest", .summary = "preconditioned steepest descent"},
    .new = state_new,
    .step = step,
};
