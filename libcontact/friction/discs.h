/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * One increment of friction: the tractions q of least energy on discs of given radii g.
 *
 *     min  q'Tq/2 - w'q   over   |q_i| <= g_i,   sum q = S   (or minus delta'(sum q), if delta is given)
 *
 * T is the tangential operator, g the largest traction of a node, w the displacement that sticking nodes
 * keep. S is the force over the area of a cell. The displacement of the bodies, delta, is the multiplier of
 * the force. s = Tq - w - delta is the slip of a node. It is 0 where |q| < g, and opposite to q elsewhere.
 * Displacements are in units of the cell over E*, and so in Pa: no number is too large or too small for a
 * float. Internal: never installed.
 */
#ifndef RC_DISCS_H
#define RC_DISCS_H

#include <math.h>

#include "extension.h"

/* The request of an increment. */
struct rc_discs_asked {
    bool given;    /* delta is given, else the sum    */
    double sum[2]; /* sum of q, Pa */
    double tol;    /* relative L1 error of q          */
    size_t most;   /* steps                           */
};

struct rc_discs {
    struct rc_tangential *t; /* the caller's */
    size_t nx, ny, n;        /* rows and nodes held here */
    size_t all;              /* nodes of the map         */
    int threads;
    /* Maps. The caller sets g and w, and q to start the iteration from it, before rc_discs_begin. After
     * the last step only q, u and face are still needed. */
    double *g, *w[2], *q[2], *u[2]; /* u = T q                                    */
    float *r[2], *z[2];             /* residual along free directions; M r, then the direction */
    float *curve;                   /* D of slipping nodes */
    unsigned char *face;            /* enum rc_face                               */
    double *beside; /* on ranks: slip and face of the first and last row, and of their neighbours */
    double delta[2]; /* m: the given or computed displacement */
    double limit;    /* sum of g                                   */
    struct rc_discs_asked asked;
    struct {
        double estimate; /* estimated relative L1 error of q */
        double residual; /* m: largest slip where no node may slip                               */
        double slip;     /* m: the smaller of the largest slip and the motion of the bodies */
        size_t steps, fallbacks, stick, slipping;
    } found;
    struct {              /* results of one evaluation of the faces and the residual */
        bool carries;     /* the sum of q is the load                                             */
        bool measured;    /* delta is given, or is the mean over nodes inside their circles */
        double motion[2]; /* otherwise: the change of delta that minimises the residual along the
                             tangents */
        double turning;   /* the estimate without the nodes that would slip inwards after this
                             change */
    } judged;
    struct {                 /* the last step */
        double *d[2], *h[2]; /* the step d, and T d */
        double reach;        /* part of the direction that precedes the projection, 0.5 to 1 */
        double part; /* the reach of the last step; 0: the next step does not use the last one */
        bool sift;   /* nodes whose inward slip would be pushed out again stay on their circles */
        bool fell;   /* it was along the projected gradient */
    } way;
    struct rc_extension *m;
    struct rc_sums rows;
    bool borrows; /* all but q, u and face belongs to another problem */
    struct rc_store own;
};

/* Allocates the maps; NULL when memory is short. */
struct rc_discs *rc_discs_new(struct rc_tangential *t, struct rc_err *err);
/* A second problem with q, u and faces of its own. All other maps are those of `other`: only one of both can
 * be solved at a time. */
struct rc_discs *rc_discs_beside(const struct rc_discs *other, struct rc_err *err);
void rc_discs_free(struct rc_discs *d); /* NULL is allowed */
RC_OWNER(rc_discs)
/* RC_FAIL if a displacement is given on a map that repeats along one axis, and the datum is so near that a
 * larger force would move the bodies back. length: m, the unit of lengths of T. Only g is used. */
enum rc_status rc_discs_check_datum(const struct rc_discs *d, double length, struct rc_err *err);
/* Starts from q: moves it to the discs and to the load, which the discs must be able to carry, and finds
 * u. */
void rc_discs_begin(struct rc_discs *d);
/* Takes one step. RC_MORE: not finished; RC_OK: the estimate is below tol; RC_SHORT: rounding prevents
 * that. */
enum rc_status rc_discs_step(struct rc_discs *d);

/* The nearest traction on the disc of radius g, or on its circle. */
static inline void
rc_onto_disc(double g, bool circle, double *x, double *y)
{
    double r = sqrt(*x * *x + *y * *y);

    if (r > g || (circle && r > 0)) {
        *x *= g / r;
        *y *= g / r;
    }
}

#endif
