/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Rolling on one grid, steady or step by step. Internal: never installed.
 *
 * The contact rolls towards +x, by one column of nodes in a step. Body 2 moves over body 1 by -rigid + v in a
 * step. With S the shift by one node, (S f)_i = f_(i+1), the slip of body 1 on body 2 in a step is
 *
 *     s = (1 - S) T q + rigid - v,      |q| <= g,   s = 0 where |q| < g, else opposite to q.
 *
 * The symmetric part of B = (1 - S) T is positive definite, because q'Bq is the sum of T(k) (1 - cos kx dx)
 * |q_k|^2. So there is exactly one q. Displacements are in units of the cell over E*, and so in Pa.
 *
 * On a path each step has its own pressure and length, and moves the map by any number m of columns:
 *
 *     s = T q - S^m before + rigid - v,     before: displacement of the surfaces at the end of the last step.
 */
#ifndef RC_STEADY_H
#define RC_STEADY_H

#include "libcontact/friction/discs.h"

enum {
    RC_STEADY_PAST = 3,
    RC_STEADY_STEPS = 5 /* of the linear iteration: its vectors need most of the memory */
};

/* The correction of a step. */
struct rc_steady_step {
    double *way[2];     /* the correction; on a path, the displacement due to the pressure */
    double *old[2];     /* q before the correction; on a path, the earlier displacement */
    unsigned char *was; /* enum rc_face before the step */
};

/* The last point of a path. */
struct rc_steady_path {
    double *last[2]; /* q there; NULL: no path */
    size_t moved;    /* columns that the map has moved since then */
};

/* Vectors of the linear iteration. */
struct rc_steady_space {
    float *basis[RC_STEADY_STEPS + 1][2], *z[RC_STEADY_STEPS][2], *normal[RC_STEADY_STEPS];
    double first; /* length of the residual */
};

/* If the force is given: the change of v, an unknown of the linear iteration. */
struct rc_steady_motion {
    float *due[2][2]; /* tractions due to v, by the preconditioner             */
    size_t slipping;  /* nodes that slipped when they were found; SIZE_MAX: never */
    bool kept;        /* due and of_sum are those of a state                   */
    double limit;     /* Pa: the largest sum of q                              */
    double of_sum[4]; /* by rows: the change of v that a sum of tractions needs */
    double weight;    /* of a change of v, beside a vector */
    double rest[RC_STEADY_STEPS + 1][2]; /* the part of a vector that is a change of v */
    double dv[RC_STEADY_STEPS][2];       /* that of z */
};

struct rc_steady {
    struct rc_shape shape; /* the whole map */
    size_t n;              /* nodes of maps, held here */
    int threads;
    struct rc_tangential *t;
    double self; /* B of a node on itself, the mean of both directions */
    /* The caller sets g (0 in the last column), rigid, v, and q, then calls rc_steady_begin. */
    double *g, *q[2], *rigid[2], v[2];
    double *u[2], *s[2]; /* T q or T of a vector; slip     */
    float *curve;        /* D of nodes that slip           */
    unsigned char *face; /* enum rc_face */
    struct rc_steady_step step;
    struct rc_steady_path path;
    struct rc_steady_space space;
    struct rc_steady_motion motion;
    struct rc_extension *m; /* NULL on a path */
    struct {
        bool force; /* v is found                        */
        bool path;
        double sum[2]; /* then: of q, Pa                    */
        double tol;    /* relative L1 error of q            */
        size_t most;   /* steps                             */
    } asked;
    struct {
        double size;     /* sum of |q|                                                     */
        double residual; /* relative: change of q by a projected step of length 1/self     */
        double estimate; /* estimated relative L1 error of q */
        double left;     /* part of the residual, by the last linear iteration */
        double rest;     /* relative: sum of the tractions of the residual, and `residual` */
        double past[RC_STEADY_PAST]; /* rest before the last steps, latest first; 0: none */
        double sum[2];               /* of q */
        size_t stick, slipping, steps, fallbacks;
    } found;
    struct rc_discs *discs; /* for steps in time; NULL: none was necessary */
    struct rc_sums rows;
    struct rc_store own;
};

/* T in units of the cell over E*. path: for rc_steady_set_out, else for rc_steady_step. NULL when memory is
 * short. All ranks call each function but the last one together. */
struct rc_steady *rc_steady_new(const struct rc_ranks *ranks, const struct rc_shape *shape,
                                struct rc_boundary boundary, const struct rc_shear *shear,
                                bool force, bool path, size_t threads, struct rc_err *err);
void rc_steady_free(struct rc_steady *d); /* NULL is allowed */
RC_OWNER(rc_steady)
/* A first q, along the motion: half of what friction can carry, or E* times the creepage, about as much
 * as there is where all nodes stick, if that is less; 0 where the force is given. */
void rc_steady_guess(struct rc_steady *d);
/* Starts from q, which is moved to the discs. */
void rc_steady_begin(struct rc_steady *d);
/* The same with the q, the part left, the rests, steps and fallbacks of an interrupted iteration. */
void rc_steady_begin_again(struct rc_steady *d);
/* One step of Newton's method: RC_MORE; RC_OK when the estimate is below tol; RC_SHORT after the most steps;
 * RC_FAIL when memory is short. */
enum rc_status rc_steady_step(struct rc_steady *d, struct rc_err *err);
/* One step of rolling in time from q, which never increases the distance to the solution. */
enum rc_status rc_steady_roll(struct rc_steady *d, struct rc_err *err);
/* A step of a path in three calls. The first begins it from q, after the map has moved by these columns. The
 * second is one iteration, with a status as above. The third makes its end the start of the next step. */
enum rc_status rc_steady_set_out(struct rc_steady *d, size_t columns, struct rc_err *err);
enum rc_status rc_steady_follow(struct rc_steady *d);
void rc_steady_arrive(struct rc_steady *d);
/* In place of the first two: the end of this step is known, its q, u, v, face, estimate and counts. */
void rc_steady_reach(struct rc_steady *d, size_t columns);
/* The friction energy at node k, as q s: the mean traction of a step times its slip. On a path nodes
 * are points of the surface, and those that leave the contact in the step have a part too. In a steady
 * state this part belongs to the node in front, where the surface was before. The sum is then that of q
 * v exactly, without a loss by the grid: the mean traction times the change of T q, summed over the
 * surface, is the change of the elastic energy. all: with the rest that an iteration has left at nodes
 * that stick, and with negative values, which the sudden release of a node at a trailing edge can
 * have. */
double rc_steady_dissipated(const struct rc_steady *d, size_t k, bool all);

#endif
