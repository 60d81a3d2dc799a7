/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the tests of adhesion. It has the solution of the states of a path, and Maugis' closed forms. */
#ifndef ADHESION_CASE_H
#define ADHESION_CASE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "libcontact/adhesion/adhesion.h"

static struct rc_err adhesion_err;

static inline struct rc_adhesion_solver *
adhesion_new(struct rc_shape shape, const double *h, struct rc_adhesion_problem problem)
{
    struct rc_adhesion_solver *a = rc_adhesion_solver_new(&shape, h, &problem, &adhesion_err);

    if (a == NULL)
        print_error("%s\n", adhesion_err.text);
    assert_non_null(a);
    return a;
}

static inline enum rc_status
adhesion_run(struct rc_adhesion_solver *a)
{
    enum rc_status status;

    while ((status = rc_adhesion_solver_step(a, &adhesion_err)) == RC_MORE)
        ;
    return status;
}

static inline const struct rc_adhesion_state *
adhesion_to_approach(struct rc_adhesion_solver *a, double approach)
{
    assert_int_equal(rc_adhesion_solver_set_approach(a, approach, &adhesion_err), RC_OK);
    (void)adhesion_run(a);
    return rc_adhesion_solver_result(a);
}

static inline const struct rc_adhesion_state *
adhesion_to_load(struct rc_adhesion_solver *a, double load)
{
    assert_int_equal(rc_adhesion_solver_set_load(a, load, &adhesion_err), RC_OK);
    (void)adhesion_run(a);
    return rc_adhesion_solver_result(a);
}

static inline const struct rc_adhesion_state *
adhesion_pull(struct rc_adhesion_solver *a)
{
    assert_int_equal(rc_adhesion_solver_pull_off(a, &adhesion_err), RC_OK);
    (void)adhesion_run(a);
    return rc_adhesion_solver_result(a);
}

/* Relative L1 distance of a from b. */
static inline double
adhesion_distance(size_t n, const double *a, const double *b)
{
    double sum = 0, all = 0;

    for (size_t k = 0; k < n; k++) {
        sum += fabs(a[k] - b[k]);
        all += fabs(b[k]);
    }
    return sum / all;
}

#endif
