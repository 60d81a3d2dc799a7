/*
 * One increment of friction: the tractions q of least energy on discs of given radii g.
 *
 *     min  q'Tq/2 - w'q   over   |q_i| <= g_i,   sum q = S   (or minus delta'(sum q), if delta is given)
 *
 * T is the tangential operator, g the largest traction of a node, w the displacement that sticking nodes
 * keep, S the force over the area of a cell, delta its multiplier: the displacement of the bodies. s = Tq - w
 * - delta is the slip of a node: 0 where |q| < g, else opposite to q. Displacements are in units of the cell
 * over E*, and so in Pa: no number is too large or too small for a float. Internal: never installed.
 */
#ifndef RC_DISCS_H
#define RC_DISCS_H

#include "extension.h"

struct rc_discs {
    struct rc_tangential *t; /* the caller's */
    size_t nx, ny, n;
    int threads;
    /* Maps. The caller sets g, w, and q where the iteration starts from it, before rc_discs_begin. */
    double *g, *w[2], *q[2], *u[2]; /* u = T q                                    */
    float *r[2], *z[2];             /* residual along free directions; M r, then the direction */
    float *curve;                   /* D of nodes that slip                       */
    unsigned char *face;            /* enum rc_face                               */
    double delta[2];                /* m: given, or found                         */
    double limit;                   /* sum of g                                   */
    struct {
        bool given;    /* delta is given, else the sum    */
        double sum[2]; /* of q, Pa                        */
        double tol;    /* relative L1 error of q          */
        size_t most;   /* steps                           */
    } asked;
    struct {
        double estimate; /* of the relative L1 error of q                                        */
        double residual; /* m: largest slip where no node may slip                               */
        double slip;     /* m: largest slip, or the motion of the bodies where that is less      */
        size_t steps, fallbacks, stick, slipping;
    } found;
    struct {              /* by one look at the faces and the residual */
        bool carries;     /* the sum of q is the load                                             */
        bool measured;    /* delta is given, or the mean of nodes inside their circles            */
        double motion[2]; /* else the change of delta that leaves least along the tangents        */
        double turning;   /* estimate without the nodes that would then slip inwards              */
    } judged;
    struct {                 /* a step, the last one */
        double *d[2], *h[2]; /* the way, and T of it                                         */
        double reach; /* part of the direction at which the way back begins, 0.5 to 1        */
        double part;  /* the reach of the last step; 0: the next step keeps nothing of it    */
        bool sift;    /* nodes that would slip inwards and back again stay on their circles  */
    } way;
    struct rc_extension *m;
    struct { /* where the maps and the sums of rows are */
        double *maps;
        float *single;
        struct rc_sums rows;
    } memory;
};

/* Allocates the maps; NULL when memory is short. */
struct rc_discs *rc_discs_new(struct rc_tangential *t, struct rc_err *err);
void rc_discs_free(struct rc_discs *d); /* NULL is allowed */
/* Starts from q: moves it to the discs and to the load, which the discs must be able to carry, and finds
 * u. */
void rc_discs_begin(struct rc_discs *d);
/* One step: RC_MORE, RC_OK when the estimate is below tol, RC_SHORT when it cannot get there. */
enum rc_status rc_discs_step(struct rc_discs *d);

#endif
