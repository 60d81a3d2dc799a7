/*
 * One increment of friction: the tractions q of the least energy on discs of given radii.
 *
 *     min  q'Tq/2 - w'q   over   |q_i| <= g_i,   sum q = S   (or less delta'(sum q), delta given)
 *
 * T the tangential operator, g what friction can carry at a node, w the displacement that nodes which
 * stick keep, S the load over the area of a cell, delta its multiplier: how far the bodies have moved. s =
 * Tq - w - delta is how far a node slips: 0 where |q| < g, else along -q. Units are such that floats lose
 * no decade: displacements over what E* and the cell make of a traction, in Pa. Internal: never installed.
 */
#ifndef RC_DISCS_H
#define RC_DISCS_H

#include "extension.h"

struct rc_discs {
    struct rc_tangential *t; /* the caller's */
    size_t nx, ny, n;
    int threads;
    /* what is asked: set by the caller before rc_discs_begin */
    double *g, *w[2];
    bool given;              /* delta is, else the sum */
    double sum[2], delta[2]; /* S, Pa; delta, m        */
    double tol;              /* relative L1 error of q */
    size_t most;             /* outer steps            */
    /* what has been found */
    double *q[2], *u[2]; /* q, where a start is to stand too; u = T q */
    double estimate;     /* of the relative L1 error of q */
    double residual;     /* largest slip where nothing may slip, over the largest slip, m */
    double slip;         /* largest slip, or what the bodies have moved where that is less, m */
    size_t steps, fallbacks, stick, slipping;
    /* of one step, and of the last one */
    struct rc_extension *m;
    double *d[2], *h[2]; /* where it goes, and T of that                               */
    bool carries;        /* q adds up to the load                                          */
    bool measured;       /* delta: given, or the mean of nodes inside their circles        */
    double motion[2];    /* else what it is to change by to leave least along the tangents */
    double turning;      /* estimate without the nodes which would then slip inwards       */
    double limit;        /* sum of g                                                       */
    double reach;        /* how far along the direction the way back begins, 0.5 to 1      */
    double part;         /* that of the last step; 0: nothing of it is kept                */
    bool sift;          /* nodes that would slip inwards and back again are left on their circles */
    float *r[2], *z[2]; /* residual along what is free; M r, then the direction       */
    float *curve;       /* D of nodes that slip                                       */
    unsigned char *face; /* enum rc_face                                               */
    double *maps;        /* where the maps lie                                             */
    float *single;
    double *partial; /* sums of rows                                               */
};

/* Rooms for maps; NULL when memory is short. */
struct rc_discs *rc_discs_new(struct rc_tangential *t, struct rc_err *err);
void rc_discs_free(struct rc_discs *d); /* NULL is allowed */
size_t rc_discs_memory(const struct rc_shape *shape, enum rc_boundary boundary);
/* Starts from what stands in q, which is put on the discs and the load; the load must be one that the discs
 * can carry. u is found. */
void rc_discs_begin(struct rc_discs *d);
/* One step: RC_MORE, RC_OK when the estimate is below tol, RC_SHORT when it cannot get there. */
enum rc_status rc_discs_step(struct rc_discs *d);

#endif
