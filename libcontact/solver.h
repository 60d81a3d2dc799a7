/*
 * What the solver's front and its methods share. A method is a row of methods.list: it improves
 * solver->p step by step; the front judges, counts and reports.
 *
 * The problem: p with 0 <= p <= H and sum p dx dy = load that minimises 1/2 p'Kp - h'p. With the gap
 * g = Kp - h - c, c its mean over the elastic nodes (0 < p < H), the solution has g = 0 there,
 * g >= 0 where p = 0 and g <= 0 where p = H.
 */
#ifndef RC_SOLVER_H
#define RC_SOLVER_H

#include "extension.h"
#include "inside.h"

struct rc_method {
    const char *name;
    const char *summary;
    /* State beside the solver's own; NULL and *err when memory is short. */
    void *(*new)(struct rc_solver *solver, struct rc_err *err);
    void (*step)(struct rc_solver *solver, void *state);
    void (*free)(void *state);
};

#define RC_METHOD(name) extern const struct rc_method rc_method_##name;
#include "methods.list"
#undef RC_METHOD

struct rc_solver {
    struct rc_shape shape;
    enum rc_boundary boundary;
    size_t n;
    double cell;             /* dx dy                                                       */
    double estar, hardness, load, tol;
    double sum;              /* load / cell: what the nodal pressures add up to             */
    size_t max_iterations, threads;
    struct rc_conv *conv;
    struct rc_extension *extension;
    const struct rc_method *method;
    void *state;
    double *h;               /* heights less their maximum: the datum costs digits          */
    double *p;               /* the iterate: in the box, with the load                      */
    double *g;               /* scratch of n                                                */
    double *z;               /* scratch of n                                                */
    unsigned char *working;  /* scratch of n                                                */
    size_t iterations;
    double convolutions;     /* equivalents of one double-precision convolution             */
    double change;           /* relative L1 change of p in the last step                    */
    double estimate;         /* of the relative L1 error of p, by a method that has it at hand from a
                                fresh K p; NAN: it has not                                  */
    double error;            /* estimated relative L1 error at the last check; NAN: none    */
    size_t judged;           /* iteration of that check                                     */
    size_t next_check;       /* iteration at which the error is estimated again             */
};

/* Where a node stands in the box. */
static inline bool
rc_elastic(const struct rc_solver *s, size_t k)
{
    return s->p[k] > 0 && s->p[k] < s->hardness;
}

/* Whether a node at a bound wants to leave it, by solver->g. */
static inline bool
rc_wants_out(const struct rc_solver *s, size_t k)
{
    return (s->p[k] <= 0 && s->g[k] < 0) || (s->p[k] >= s->hardness && s->g[k] > 0);
}

/* g = K p - h, and then less its mean over the elastic nodes, or, when there are none, less the
 * middle between the largest g under p = H and the smallest under p = 0. Returns the number of
 * elastic nodes; *shift is what was subtracted. */
size_t rc_solver_gap(struct rc_solver *solver, const double *u, double *g, double *shift);

/* box.c: p becomes the sum by scaling its elastic nodes, as far as the box lets them; what they
 * cannot carry goes to the nodes of smallest g, what is too much is taken from all. */
enum rc_status rc_box_balance(size_t n, double hardness, double sum, const double *g, double *p,
                              struct rc_err *err);


/* box.c: the nearest point of {0 <= y <= H, sum y = sum} over the nodes with w set (NULL: all): one
 * shift for them, clipped. They have to be able to carry the sum. */
void rc_box_project(size_t n, const unsigned char *w, double hardness, double sum, double *y);

/* guard.c: begins with energy INFINITY, norm 0. */
struct rc_guard {
    double energy; /* of the last p that was kept                 */
    double norm;   /* bound of K's largest eigenvalue; 0: unknown */
};
/* Whether the energy of solver->p, u = K p, has risen above that of the last p kept; else this one
 * is. */
bool rc_guard_raised(struct rc_guard *guard, const struct rc_solver *solver, const double *u);
/* solver->p goes back to `old`, and from there towards the projection of p - g / |K|, to the lowest
 * point on that way. t, r: scratch of n. Costs two convolutions, three the first time. */
void rc_guard_step(struct rc_guard *guard, struct rc_solver *solver, const double *old, double *t,
                   double *r);

#endif
