/*
 * The iteration for the gap, and the stability of what it finds. Internal: never installed.
 *
 * Unknown is x on the whole grid: on the map the gap g = u - h - c >= 0, beyond it u - c, free. Wanted is a
 * stationary point, downhill from where it begins, of
 *
 *     Phi(x) = 1/2 u'A u + sum of V(g) over the map,    u = x + h + c,  h = 0 beyond the map
 *
 * with c given; or with the load given, where A is blind to the mean and S sum x is added, S the load over
 * the cell and the nodes of the grid; or, where the map repeats, with the mean of x given. Then p = A u (+ S;
 * less its mean over the nodes apart of A u + sigma) is the net pressure, and p + sigma that of the contact,
 * >= 0 where g = 0 and nothing elsewhere. Units are those of struct rc_whole.
 */
#ifndef RC_GAP_H
#define RC_GAP_H

#include "law.h"
#include "libcontact/operator/operator.h"

enum rc_gap_control {
    RC_GAP_SHIFT, /* c given: free */
    RC_GAP_MEAN,  /* mean gap given: periodic */
    RC_GAP_LOAD
};

enum {
    RC_GAP_MOST = 12, /* from here on the largest numbers of the rows count, before it their sums */
    RC_GAP_SUMS = 16,
    RC_GAP_FLOATS = 9, /* maps of the softest mode */
    RC_GAP_LINE = 512  /* nodes of a row that a law is asked for together, at most */
};

/* The direction d of the next step, z + beta times the last one. W is that of stability.c, and so is the
 * bound `stiffness` of its smallest eigenvalue; dwd NAN, stiffness INFINITY: not known. */
struct rc_gap_way {
    double rz, beta, rd, dad, dwd; /* r'z, beta, r'd, d'A d, d'W d                         */
    double mean, unit;             /* of d on the grid; its largest number                 */
    double stiffness;              /* d'(A - D) d over d'W d                               */
    bool same, whole;              /* as before the same nodes are held; all others move   */
    bool restart;                  /* the next one has beta 0                              */
};

/* What the pressure is off, L1. */
struct rc_gap_told {
    double error,
        fresh;    /* |A z| over |p|, with drift; the same when A u was found, INFINITY: not yet */
    double drift; /* of A u since then: steps add to it in single precision                     */
    double size,
        change;   /* |p|, |A z|                                                                 */
    double moves; /* |A d| of a step                                                            */
};

/* The softest mode of the last state, by stability.c. */
struct rc_gap_mode {
    float *
        e[RC_GAP_FLOATS]; /* x, K^-1 x, (A - D) x; the same of its residual and of its way        */
    double mu, error;     /* smallest eigenvalue, and how far one is at most                      */
    double stiffness;     /* of that of the state before, if nothing pulled                       */
    bool known, watched;  /* e[1] holds it; e[0] that of the state before, of this control        */
    size_t steps;
};

/* Where a state began. */
struct rc_gap_from {
    float *x, *slope; /* and the slope of Phi there */
    double fall;      /* of Phi since               */
};

struct rc_gap {
    struct rc_whole *whole;
    struct rc_attraction law;
    size_t nx, ny, px, py, n; /* of the map, of the grid; nodes of the grid */
    const double *h;          /* nx ny                                                 */
    double hard;              /* bound of p + sigma; INFINITY: none                    */
    double *hards;            /* nx ny, instead of it; NULL: one for all               */
    bool yields;              /* some node has such a bound                            */
    enum rc_gap_control control;
    double given; /* c, the mean of x, or S                                */
    /* x, A u, residual, its correction K r, direction, A of that; room for a step */
    double *x, *au, *r, *z, *d, *ad, *step;
    double *a_step;       /* A of a step: the room of r, which the next look finds anew */
    unsigned char *off;   /* 1: held at 0; on the whole grid                       */
    struct rc_sums sums;  /* of the rows of the grid                               */
    double level;         /* what is taken from A u + S to make p                  */
    double lift;          /* of the preconditioner at the mean                     */
    double scale, mean_r; /* of the residual: the largest, the mean                */
    size_t free;          /* nodes not held                                        */
    struct rc_gap_way way;
    struct rc_gap_told told;
    struct rc_gap_mode mode;
    struct rc_gap_from from;
    bool negative; /* stiffness there was negative, of its direction or of the softest mode */
    bool stuck;    /* no step goes down any more                            */
    bool parting;  /* drawn apart, with nothing left to hold                */
    double convolutions;
    size_t iterations;
};

/* RC_FAIL when memory is short; rc_gap_free in either case. h, hards: nx ny, of the caller's, who keeps h;
 * hards is taken over. */
enum rc_status rc_gap_new(struct rc_gap *g, struct rc_whole *whole, const struct rc_attraction *law,
                          const double *h, double hard, double *hards, struct rc_err *err);
void rc_gap_free(struct rc_gap *g);

/* Undeformed bodies, `clearance` apart at the highest node. */
void rc_gap_apart(struct rc_gap *g, double clearance);
/* A control, and the state it begins with: the gap there is, shifted. */
void rc_gap_begin(struct rc_gap *g, enum rc_gap_control control, double given);
/* The way down from here, and with it what the pressure is off; and a step along it. */
void rc_gap_look(struct rc_gap *g);
void rc_gap_move(struct rc_gap *g);
/* Finds way.stiffness without a step. */
void rc_gap_look_along(struct rc_gap *g);
/* Whether the straight way from where the state began leads over a place that is not convex: Phi has fallen
 * by more than its slope there allows. */
bool rc_gap_jumped(struct rc_gap *g);
/* c of the state: the mean of u less that of x and h. */
double rc_gap_shift(const struct rc_gap *g);
/* p of node k of the grid. */
static inline double
rc_gap_pressure_at(const struct rc_gap *g, size_t k)
{
    return g->au[k] + (g->control == RC_GAP_LOAD ? g->given : 0) - g->level;
}

/* ---- between gap.c and stability.c ---- */

/* Nodes of row j that are on the map. */
static inline size_t
rc_gap_on_map(const struct rc_gap *g, size_t j)
{
    return j < g->ny ? g->nx : 0;
}
/* V, sigma and D at n <= RC_GAP_LINE gaps of row j from node i on, with the hardness. */
void rc_gap_law(const struct rc_gap *g, size_t j, size_t i, size_t n, const double *gap, double *v,
                double *s, double *d);
/* Down from here along d, whose largest number is way.unit and which is to be a way of less than no
 * curvature. */
void rc_gap_down(struct rc_gap *g, double first);

/* ---- stability.c ---- */

/* The smallest eigenvalue of (A - D) x = mu (K_FF)^-1 x, F the nodes not in contact, under the control: a
 * step of a locally optimal conjugate gradient iteration (Knyazev 2001). */
void rc_gap_eigen_begin(struct rc_gap *g);
void rc_gap_eigen_step(struct rc_gap *g);
/* Leaves a saddle along the eigenvector, downhill. */
void rc_gap_leave(struct rc_gap *g);

#endif
