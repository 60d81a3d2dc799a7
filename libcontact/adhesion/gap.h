/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The iteration for the gap, and the stability of its result. Internal: never installed.
 *
 * The unknown is x on the whole grid. On the map x is the gap g = u - h - c >= 0; beyond the map x = u - c is
 * unconstrained. The iteration descends from its start to a stationary point of
 *
 *     Phi(x) = 1/2 u'A u + sum of V(g) over the map,    u = x + h + c,  h = 0 beyond the map
 *
 * if c is given. If the load is given, A ignores the mean, and Phi contains S sum x as well. S is the load
 * over the area of a cell and the number of nodes of the grid. On a periodic map the mean of x may be given
 * instead. Then p = A u is the net pressure, plus S if the load is given. If the mean is given, the mean of A
 * u + sigma over open nodes is subtracted. p + sigma is the pressure of the contact: it is >= 0 where g = 0,
 * and 0 elsewhere. Units are those of struct rc_whole.
 */
#ifndef RC_GAP_H
#define RC_GAP_H

#include "law.h"
#include "libcontact/memory.h"
#include "libcontact/operator/operator.h"

enum rc_gap_control {
    RC_GAP_SHIFT, /* c is given; free boundary */
    RC_GAP_MEAN,  /* the mean gap is given; periodic boundary */
    RC_GAP_LOAD
};

enum {
    RC_GAP_MOST = 12, /* this and the following entries: the largest values of the rows; the entries
                         before: their sums */
    RC_GAP_SUMS = 16,
    RC_GAP_FLOATS = 9, /* maps of the softest mode */
    RC_GAP_AZ = 5,     /* the map of A z; the two maps before it use the memory of `step` */
    RC_GAP_LINE = 512, /* most nodes of a row in one call of a law */
    RC_GAP_PARTED = 20 /* ranges between bodies that have separated */
};

/* Sums of a step that is clipped at the bounds: clipped nodes, x after the step, open nodes after it. */
enum {
    RC_GAP_CLIPPED,
    RC_GAP_CLIP_SUM,
    RC_GAP_CLIP_OPEN
};

/* The direction d of the next step, z + beta times the last one. W is defined in stability.c; `stiffness`
 * bounds the smallest eigenvalue from above. dwd NAN, stiffness INFINITY: unknown. */
struct rc_gap_way {
    double rz, beta, rd, dad, dwd; /* r'z, beta, r'd, d'A d, d'W d                         */
    double mean, unit;             /* mean of d on the grid; its largest value */
    double stiffness;              /* d'(A - D) d over d'W d                               */
    bool same, whole;              /* the held nodes have not changed; all other nodes move */
    bool restart;                  /* the next direction has beta 0 */
};

/* The error of the pressure, L1. */
struct rc_gap_told {
    double error,
        fresh;    /* |A z| over |p|, with drift; the same when A u was computed, INFINITY: not
                     yet */
    double drift; /* error of A u since then, because steps add to it in single precision */
    double size,
        change;     /* |p|, |A z|                                                                 */
    bool vanishes;  /* |A z| and drift are rounding beside the largest traction */
    double moves;   /* |A d| of a step */
    float *at_mark; /* the marked pressure */
    double mark, ratios[2]; /* |A z| with drift at the marked pressure, 0: none; error over |A z| at
                               the last two marks, INFINITY: not yet measured */
    double last, calm;      /* `error` of the last step; `error`, at least half the last one */
    double cut, cuts; /* error of A times a step from neglected coefficients; the same in drift */
};

/* The softest mode of the last state, by stability.c. */
struct rc_gap_mode {
    float *e[RC_GAP_FLOATS]; /* x, K^-1 x, (A - D) x; the same for its residual and for its last
                                step */
    double mu, error;        /* smallest eigenvalue, and bound of its error */
    bool known;              /* e[1] holds the mode */
    bool tracked;            /* e[1] holds a first vector, from the corrections of the descent */
    double bare;             /* stiffness of the mode without attraction; 0: not yet found */
    bool grown;              /* a node that was held when the mode was found is free */
    size_t steps, slow;      /* slow: successive steps with nearly the same mu */
};

/* The attraction may be that of another gap: V is then its tangent there, and Phi is convex. */
struct rc_gap_frozen {
    bool on;
    float *x;
};

/* The minimum of Phi as a function of the given c, mean of x or S; dPhi is `force` times its change. The
 * scales are sums of absolute values. */
struct rc_gap_energy {
    double given, phi, force;
    double phi_scale, force_scale;
    double pressure; /* sum of |p| */
    double contact;  /* nodes */
};

/* Coefficients of A near a node, by near.c. */
struct rc_gap_near {
    double *a;   /* NULL: not yet found */
    double rest; /* sum of the sizes of the other coefficients */
    float *ah;   /* A h */
    bool known;  /* A h is known */
};

/* The bodies, from rc_gap_new. */
struct rc_gap_problem {
    struct rc_whole *whole;
    struct rc_attraction law;
    size_t nx, ny, px, py; /* columns and rows of the map and of the grid */
    struct rc_rows rows;   /* rows of the grid held here; row 0 is the first of them */
    size_t on_map;         /* the number of these that are rows of the map */
    size_t n, all;         /* nodes of the grid held here; of all ranks */
    const double *h;       /* nx on_map */
    double hard;           /* bound of p + sigma; INFINITY: none */
    double *hards;         /* nx on_map bounds in place of `hard`; NULL: the same for all nodes */
    bool yields;           /* some node has such a bound                            */
};

/* The quantity that is given, from rc_gap_begin. */
struct rc_gap_set {
    enum rc_gap_control control;
    double given;     /* c, the mean of x, or S                                */
    double level;     /* p is A u + S minus this */
    double lift;      /* factor of the preconditioner for the mean */
    double stiffness; /* of contacts that pin long waves, per area; 0: not used */
    bool pinned;      /* the preconditioner contains it */
};

/* Maps of the rows of the grid held here. */
struct rc_gap_maps {
    /* x, A u, residual, its correction K r, direction d, A d; memory for a step */
    double *x, *au, *r, *z, *d, *ad, *step;
    double *a_step;     /* A times a step, in the memory of r, which is computed again */
    unsigned char *off; /* 1: the node is held at 0 */
    float *start;       /* x of the last state */
    double *beside;     /* two rows; NULL: one rank has all rows */
};

/* The residual of the free nodes, which are those not held. */
struct rc_gap_residual {
    double largest, mean;
    size_t free;
};

/* The course of the iteration since rc_gap_begin. */
struct rc_gap_run {
    bool stuck;   /* no step lowers Phi any more */
    bool parting; /* the bodies separate without remaining attraction */
    double convolutions;
    size_t iterations;
};

/* A row of the grid is one work item. The functions of rows, and those that call them, get the whole
 * state. */
struct rc_gap {
    struct rc_gap_problem problem;
    struct rc_gap_set set;
    struct rc_gap_maps maps;
    struct rc_sums sums; /* sums over the rows of the grid */
    struct rc_gap_residual residual;
    struct rc_gap_way way;
    struct rc_gap_told told;
    struct rc_gap_mode mode;
    struct rc_gap_frozen frozen;
    struct rc_gap_near near;
    struct rc_gap_run run;
    struct rc_store own;
};

/* RC_FAIL if memory is short on a rank; call rc_gap_free in either case. The caller then sets h, and the
 * hardness: `hards` is freed with the gap. */
enum rc_status rc_gap_new(struct rc_gap *g, struct rc_whole *whole, const struct rc_attraction *law,
                          struct rc_err *err);
void rc_gap_free(struct rc_gap *g);

/* Undeformed bodies, `clearance` apart at the highest node. */
void rc_gap_apart(struct rc_gap *g, double clearance);
/* Sets a control; the state starts from the present gap, shifted. `first`: the state continues no path. */
void rc_gap_begin(struct rc_gap *g, enum rc_gap_control control, double given, bool first);
/* The preconditioner of the descent of a first state contains the pinning by contacts; eigenvalues are those
 * of K alone. */
void rc_gap_pin(struct rc_gap *g, bool on);
/* rc_gap_look finds the direction of descent and the error of the pressure; rc_gap_move takes a step along
 * the direction. */
void rc_gap_look(struct rc_gap *g);
void rc_gap_move(struct rc_gap *g);
/* Finds way.stiffness without a step. */
void rc_gap_look_along(struct rc_gap *g);
/* Freezes the attraction at the present gap, or at the kept one. */
void rc_gap_freeze(struct rc_gap *g, bool at_start);
/* Phi and its derivative by the given quantity of this control, at a state of any control. */
struct rc_gap_energy rc_gap_energy(struct rc_gap *g, enum rc_gap_control control);
/* Keeps the present gap in single precision, and returns to it. */
void rc_gap_keep(struct rc_gap *g);
void rc_gap_return(struct rc_gap *g, enum rc_gap_control control, double given);
/* c of the state: the mean of u minus the means of x and h. */
double rc_gap_shift(const struct rc_gap *g);
/* p of node k of the grid. */
static inline double
rc_gap_pressure_at(const struct rc_gap_set *set, const double *au, size_t k)
{
    return au[k] + (set->control == RC_GAP_LOAD ? set->given : 0) - set->level;
}

/* ---- between gap.c and stability.c ---- */

/* Nodes of row j, of those held here, that are on the map. */
static inline size_t
rc_gap_on_map(const struct rc_gap_problem *problem, size_t j)
{
    return j < problem->on_map ? problem->nx : 0;
}
/* Computes V, sigma and D at n <= RC_GAP_LINE gaps of row j from node i on, with the hardness. */
void rc_gap_law(const struct rc_gap_problem *problem, const struct rc_gap_frozen *frozen, size_t j,
                size_t i, size_t n, const double *gap, double *v, double *s, double *d);
/* Descends along d, a direction of negative curvature, whose largest value is way.unit. */
void rc_gap_down(struct rc_gap *g, double first);

/* Makes d, whose largest value is way.unit, the direction of the next step; rd is r'd. */
void rc_gap_aim(struct rc_gap *g, double rd);

/* ---- near.c ---- */

/* Finds A times `step` without a convolution: `a` d with `cut` nodes cut off at 0. For a given mean, sum x
 * over the grid after the step is `sum`, and the step is changed to keep the mean. False if this does not
 * pay, or memory is short on a rank. */
bool rc_gap_near(struct rc_gap *g, double a, size_t cut, double sum);
/* ---- refine.c ---- */

/* Starts from the gap on a grid with every other node of this one. False if memory is short on a rank. */
bool rc_gap_refine(struct rc_gap *g, const struct rc_gap *coarse);

/* ---- stability.c ---- */

/* Improves the first vector of the search by the last correction, z minus `mean`. A z is in e[RC_GAP_AZ]. */
void rc_gap_track(struct rc_gap *g, double mean);
/* Makes a step of a locally optimal conjugate gradient iteration (Knyazev 2001) under the control. Returns
 * the smallest eigenvalue of (A - D) x = mu (K_FF)^-1 x. F are the nodes not in contact. */
void rc_gap_eigen_begin(struct rc_gap *g);
void rc_gap_eigen_step(struct rc_gap *g);
/* The error of the pressure along the softest mode, times mu; INFINITY: no stationary point is near. Finds mu
 * of the present gap. */
double rc_gap_soft_error(struct rc_gap *g);
/* Turns the next step along the softest mode. */
void rc_gap_turn(struct rc_gap *g);
/* Leaves a saddle along the eigenvector, in the direction that lowers Phi. */
void rc_gap_leave(struct rc_gap *g);

#endif
