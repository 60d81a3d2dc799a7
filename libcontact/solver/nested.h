/*
 * A start from coarser grids.
 */
#ifndef RC_NESTED_H
#define RC_NESTED_H

#include "solver.h"

/* solver->p becomes the pressure of the same contact on every second node, solved roughly (and
 * there by the same start), repeated; on small grids, or without memory for it, the constant
 * start stays. */
void rc_nested_start(struct rc_solver *solver);

#endif
