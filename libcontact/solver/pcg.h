/*
 * What the rooms of the method pcg share: its state; sums (pcg_convolve.c), direction and estimate
 * (pcg_direction.c), step (pcg_step.c).
 */
#ifndef RC_PCG_H
#define RC_PCG_H

#include "solver.h"

struct rc_pcg {
    double *room;     /* 2n floats; between two steps n numbers of scratch                */
    float *delta, *q; /* the last step and K times it, in the units of single precision   */
    double curvature; /* delta'q; 0: the next direction is not conjugate to anything      */
    double alpha;     /* length foretold for the next step                                */
    double drift;     /* what single precision may have done to p, relative               */
    double rate;      /* of the last two estimates: how much smaller it has become        */
    double best;      /* least estimate                                                   */
    size_t best_at;
    double *wide; /* 2n: a step and its displacement for engines that know only double */
};

/* What the passes over all nodes share. */
struct rc_pcg_pass {
    struct rc_solver *solver;
    struct rc_pcg *s;
    double a, b;
    struct rc_move *move;
};

/* Relative error of a convolution in single precision, and what a pressure needs of it: the inverse
 * of the kernel's highest symbol is about pi/2. Measured at 1024 x 1024: 1e-5 for |u| of 50. */
static const double rc_pcg_single = 2e-7;

/* K of the pressures that `in` writes, row by row in single precision, to `out`. */
void rc_pcg_convolve(struct rc_pcg_pass *c, rc_row *in, rc_row *out);
/* The first v of a grid, in single precision where that will do for a while. */
void rc_pcg_begin(struct rc_solver *solver, struct rc_pcg *s);
/* z becomes the direction, `mean` its mean; the estimate of the error of p. */
double rc_pcg_precondition(struct rc_solver *solver, struct rc_pcg *s, double *mean);
/* From p along the direction in solver->z, of that mean, back into the box, to where the energy
 * is low, or lower; v, the working set and the residual follow. False when that leads nowhere; p
 * is then where it was. */
bool rc_pcg_advance(struct rc_solver *solver, struct rc_pcg *s, double alpha, double mean);
/* p carries `sum`; what rounding has made of the load is put right. */
void rc_pcg_balance(struct rc_solver *solver, double sum);

#endif
