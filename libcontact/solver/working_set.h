/*
 * Which nodes at a bound join the working set: joining.c.
 */
#ifndef RC_WORKING_SET_H
#define RC_WORKING_SET_H

#include "solver.h"

enum {           /* bits of solver->w, while this is undecided */
    RC_WAS = 1,  /* it was in the set before      */
    RC_WANTS = 2 /* at a bound, and wants to leave it */
};

/* Takes those that would only be pushed back out of the set whose residual is in solver->r: `w`
 * is 0 and 1 after it, r is 0 where a node stays out; the sum of r, the size of the set and the
 * nodes that changed sides follow. Uses solver->z. */
void rc_working_set_sift(struct rc_solver *solver, double *sum, double *count, double *changed);

#endif
