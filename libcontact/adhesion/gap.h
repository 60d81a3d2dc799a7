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
    RC_GAP_SUMS = 12,
    RC_GAP_FLOATS = 11, /* maps in single precision */
    RC_GAP_LINE = 512   /* nodes of a row that a law is asked for together, at most */
};

struct rc_gap {
    struct rc_whole *whole;
    struct rc_attraction law;
    size_t nx, ny, px, py, n; /* of the map, of the grid; nodes of the grid */
    int threads;
    const double *h; /* nx ny                                                 */
    double hard;     /* bound of p + sigma; INFINITY: none                    */
    double *hards;   /* nx ny, instead of it; NULL: one for all               */
    bool yields;     /* some node has such a bound                            */
    enum rc_gap_control control;
    double given; /* c, the mean of x, or S                                */
    /* x, A u, residual, its correction K r, direction, A of that; room for a step */
    double *x, *au, *r, *z, *d, *ad, *step;
    unsigned char *off; /* 1: held at 0; on the whole grid                       */
    double *sums;       /* RC_GAP_SUMS of each row                               */
    double level;       /* what is taken from A u + S to make p                  */
    double lift;        /* of the preconditioner at the mean                     */
    /* of the last step */
    double rz, scale, mean_r, beta;
    double rd, dad, mean_d; /* of the direction: r'd, d'A d, its mean on the grid */
    double dwd;             /* d'W d, W as in stability.c; NAN: not known */
    double
        way; /* its stiffness, as an eigenvalue of stability.c, none of which is smaller than the smallest; INFINITY: not known */
    bool same, whole_way; /* the same nodes are held as before; all others move along d */
    bool restart;
    size_t free;        /* nodes not held                                        */
    double unit;        /* of a direction in single precision */
    double fresh_error; /* that error when A u came from double precision */
    double error;       /* |A z| over |p|, L1, with drift; INFINITY before the first step */
    double drift; /* of A u since it came from double precision, L1: steps add to it in single */
    double size, change, moves; /* |p|, |A z|, and |A d| of a step, L1           */
    bool negative;    /* stiffness there was negative, of its direction or of the softest mode */
    bool watched;     /* e[0] is the softest mode of the state before, of this control */
    double stiffness; /* of that mode, if nothing pulled                              */
    bool stuck;       /* no step goes down any more                            */
    bool parting;     /* drawn apart, with nothing left to hold                */
    double trial;     /* of a row's work: the length of the step               */
    float *start, *slope; /* where the state began: x, and the slope of Phi                  */
    double fall;          /* of Phi since                                                    */
    double convolutions;
    size_t iterations;
    /* of the eigenvector: x, K^-1 x, (A - D) x; the same of the residual and of the direction */
    float *e[RC_GAP_FLOATS];
    double mu, mu_error; /* smallest eigenvalue, and how far one is at most      */
    bool known;          /* e[1] holds an eigenvector of the last state           */
    size_t eigen_steps;
};

/* RC_FAIL when memory is short; rc_gap_free in either case. h, hards: nx ny, of the caller's, who keeps h;
 * hards is taken over. */
enum rc_status rc_gap_new(struct rc_gap *g, struct rc_whole *whole, const struct rc_attraction *law,
                          const double *h, double hard, double *hards, struct rc_err *err);
void rc_gap_free(struct rc_gap *g);
size_t rc_gap_memory(const struct rc_shape *grid);

/* Undeformed bodies, `clearance` apart at the highest node. */
void rc_gap_apart(struct rc_gap *g, double clearance);
/* A control, and the state it begins with: the gap there is, shifted. */
void rc_gap_begin(struct rc_gap *g, enum rc_gap_control control, double given);
/* The way down from here, and with it what the pressure is off; and a step along it. */
void rc_gap_look(struct rc_gap *g);
void rc_gap_move(struct rc_gap *g);
/* Finds `way` without a step. */
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
/* Every row of the grid by itself, then the sums in order: the same for any number of threads. */
typedef void rc_gap_work(struct rc_gap *g, size_t j, double *sums);
void rc_gap_rows(struct rc_gap *g, rc_gap_work *work, double *sums);
void rc_gap_clear(struct rc_gap *g);
void rc_gap_total(const struct rc_gap *g, double *sums);
/* V, sigma and D at n <= RC_GAP_LINE gaps of row j from node i on, with the hardness. */
void rc_gap_law(const struct rc_gap *g, size_t j, size_t i, size_t n, const double *gap, double *v,
                double *s, double *d);
/* Down from here along d, which is to be a way of less than no curvature. */
void rc_gap_down(struct rc_gap *g, double first);

/* ---- stability.c ---- */

/* The smallest eigenvalue of (A - D) x = mu (K_FF)^-1 x, F the nodes not in contact, under the control: a
 * step of a locally optimal conjugate gradient iteration (Knyazev 2001). */
void rc_gap_eigen_begin(struct rc_gap *g);
void rc_gap_eigen_step(struct rc_gap *g);
/* Leaves a saddle along the eigenvector, downhill. */
void rc_gap_leave(struct rc_gap *g);

#endif
