/*
 * What the solver's front and its methods share. A method is a row of methods.list: it improves
 * solver->p step by step; the front judges, counts and reports.
 *
 * The problem: p with 0 <= p <= H and sum p dx dy = load that minimises 1/2 p'Kp - h'p. With the
 * gap g = Kp - h - c, c its mean over the elastic nodes (0 < p < H), the solution has g = 0 there,
 * g >= 0 where p = 0 and g <= 0 where p = H.
 */
#ifndef RC_SOLVER_H
#define RC_SOLVER_H

#include <math.h>

#include "preconditioner.h"
#include "libcontact/operator/operator.h"

struct rc_method {
    struct rc_method_info info;
    /* Convolutions (in equivalents) that it takes, as others were seen to take: nodes of the grid,
     * and digits that the tolerance asks for. */
    double (*convolutions)(double nodes, double digits);
    /* State beside the solver's own; NULL and *err when memory is short. */
    void *(*new)(struct rc_solver *solver, struct rc_err *err);
    void (*step)(struct rc_solver *solver, void *state);
    /* The load has changed: what belongs to the last one is forgotten. */
    void (*again)(void *state);
    void (*free)(void *state);
};

/* The list may be a longer one that includes this one: so others add methods of their own. */
#ifndef RC_METHODS_LIST
#define RC_METHODS_LIST "libcontact/solver/methods.list"
#endif
#define RC_METHOD(name) extern const struct rc_method rc_method_##name;
#include RC_METHODS_LIST
#undef RC_METHOD

/* seek.c: the search for the load that an approach needs. */
struct rc_load_search {
    double target;      /* the shift wanted, m; 0: the load is given                    */
    double low, high;   /* loads with a smaller and a larger shift; 0, INFINITY: none yet */
    double load, shift; /* of the last solution; 0: none                                */
    double power;       /* d log load / d log shift                                     */
};

struct rc_solver {
    struct rc_shape shape;
    enum rc_boundary boundary;
    size_t n;
    double cell; /* dx dy                                                       */
    double estar, hardness, load;
    double tol, goal; /* asked of this load, and at last: looser while the load is sought */
    double top;       /* what was taken from the heights                             */
    rc_watch *watch;  /* NULL, or told of each iteration                             */
    void *watcher;
    bool stages; /* the coarser grid is solved well enough to compare with      */
    struct rc_discretization coarse; /* its figures; NAN: none                              */
    struct rc_load_search seek;
    double sum; /* load / cell: what the nodal pressures add up to             */
    size_t max_iterations;
    int threads;
    bool rough;           /* a coarse grid of another's start: nobody asks for a proof   */
    struct rc_conv *conv; /* NULL: a rough solver has none                              */
    struct rc_preconditioner *extension;
    const struct rc_method *method;
    void *state;
    double *h;             /* heights less their maximum: the datum costs digits          */
    double *p;             /* the iterate: in the box, with the load                      */
    double *v;             /* K p - h: the gap but for a constant                         */
    bool known, fresh;     /* v belongs to p; and comes from a double-precision convolution */
    double shift;          /* c: the gap is v - c                                         */
    size_t elastic;        /* nodes with 0 < p < H                                        */
    size_t working;        /* nodes of the working set: those, and those that want to leave
                                their bound                                                 */
    unsigned char *w;      /* 1 on the working set, else 0                                */
    double changed, moved; /* nodes that changed sides since the extension was told w, and since
                                it measured distances                                       */
    float *r;              /* residual -g on it, else 0, over `length`                    */
    float offset;          /* its mean there                                              */
    double aside;          /* what the nodes sifted out of it would carry, times per_pressure */
    float *z;              /* scratch of n: corrections, times `per_pressure`             */
    double per_pressure, length; /* single precision: pressures of about 1, and what those displace
                                on cells of unit area for E* = 1                           */
    double *partial;             /* sums of blocks and rows                                     */
    size_t iterations;
    double convolutions; /* equivalents of one double-precision convolution             */
    double change;       /* relative L1 change of p in the last step; 0: it stands still */
    double estimate;     /* of the relative L1 error of p, by a method that has it at hand from a
                                fresh K p; NAN: it has not                                  */
    double error;        /* estimated relative L1 error at the last check; NAN: none    */
    size_t judged;       /* iteration of that check                                     */
    size_t next_check;   /* iteration at which the error is estimated again             */
};

/* Where a node stands in the box. */
static inline bool
rc_elastic(const struct rc_solver *s, size_t k)
{
    return s->p[k] > 0 && s->p[k] < s->hardness;
}

/* Sets the load and what follows from it; RC_FAIL when there is no solution. */
enum rc_status rc_solver_set_load(struct rc_solver *solver, double load, struct rc_err *err);
/* p becomes the mean pressure everywhere. */
void rc_solver_level(struct rc_solver *solver);
/* p has been changed from outside, or the load. */
void rc_solver_restart(struct rc_solver *solver);
/* The load is sought that gives this shift: the first ones are solved loosely. */
void rc_load_search_begin(struct rc_solver *solver, double target);
/* After a solution: RC_OK when its shift is the one wanted, else the next load is set. */
enum rc_status rc_load_search_step(struct rc_solver *solver);

/* The same contact on another grid, roughly: a method may start from it. */
struct rc_solver *rc_solver_rough(const struct rc_shape *shape, const double *h,
                                  const struct rc_problem *problem, struct rc_err *err);

/* ---- passes.c: what runs over all nodes ---- */

enum {
    RC_SUMS = 8,
    RC_MOST = RC_SUMS - 1 /* of this the largest is taken, of the others the sum */
};
/* Does something with nodes first .. first + n - 1 and adds to sums, which begin at 0. Blocks are
 * taken by several threads; their sums are added in order, whoever took them. */
typedef void rc_block(void *ctx, size_t first, size_t n, double *sums);
void rc_solver_blocks(const struct rc_solver *solver, rc_block *block, void *ctx,
                      double total[RC_SUMS]);
/* The same where rows come out of a convolution: each adds to rc_row_sums, between these two. */
void rc_solver_rows_begin(const struct rc_solver *solver);
void rc_solver_rows_end(const struct rc_solver *solver, double total[RC_SUMS]);
static inline double *
rc_row_sums(const struct rc_solver *s, size_t row)
{
    return s->partial + row * RC_SUMS;
}

/* v = K p - h by a convolution in double precision. */
void rc_solver_displace(struct rc_solver *solver);
/* The shift: mean of v over the elastic nodes, or, when there are none, the middle between the
 * largest v under p = H and the smallest under p = 0. Sets `elastic` and `shift`. */
void rc_solver_shift(struct rc_solver *solver);
/* The working set and the residual on it, from v and the shift; sifted, without those that would
 * only be pushed back to their bound (joining.h). Sets w, changed, r, offset, working. */
void rc_solver_residual(struct rc_solver *solver, bool sift);
/* Forgets what the extension was told: w is another set altogether. */
static inline void
rc_solver_forget(struct rc_solver *s)
{
    s->changed = s->moved = INFINITY;
}
/* z = E' A E r; `done` as in rc_preconditioner_apply. The mean of z is still in it. */
void rc_solver_correct(struct rc_solver *solver, rc_row *done, void *ctx);
/* Sum of p. */
double rc_solver_carried(const struct rc_solver *solver);
/* The load is a constraint that every method keeps; should one lose it, the result is none. */
bool rc_solver_load_kept(const struct rc_solver *solver);
/* What the engine's own error makes of the pressure, relative. */
double rc_solver_engine_error(const struct rc_solver *solver);
/* Relative L1 norm of that correction without its mean: the estimate of the error. */
double rc_solver_estimate(struct rc_solver *solver);

/* ---- box.c, project.c ---- */

/* box.c: p becomes the sum by scaling its elastic nodes, as far as the box lets them; what they
 * cannot carry goes to the nodes of smallest g, what is too much is taken from all. */
enum rc_status rc_box_balance(size_t n, double hardness, double sum, const double *g, double *p,
                              struct rc_err *err);

/* box.c: the nearest point of {0 <= y <= H, sum y = sum} over the nodes with w set (NULL: all): one
 * shift for them, clipped. They have to be able to carry the sum. */
void rc_box_project(size_t n, const unsigned char *w, double hardness, double sum, double *y);

/* project.c: a step and the way back into the box. On W the pressure becomes
 *
 *     clip(p + alpha (d - mean)[d != 0] + shift, 0, H),
 *
 * with the one shift that keeps the load: the Euclidean projection of the step, where W can
 * carry its share; where it cannot, all nodes become W. */
struct rc_move {
    struct rc_solver *solver;
    const float *d; /* direction, times per_pressure; not 0 only on W                  */
    double alpha;
    double mean;  /* of d                                                            */
    double *room; /* n numbers of scratch                                            */
    double shift; /* found                                                           */
    bool clipped; /* found: some node would have left the box                        */
};
void rc_move_find(struct rc_move *move);
/* guard.c: begins with energy INFINITY. */
struct rc_safeguard {
    double energy; /* of the last p that was kept */
};
/* A bound of K's largest eigenvalue. */
double rc_safeguard_norm(const struct rc_solver *solver);
/* Whether the energy of solver->p has risen above that of the last p kept; else this one
 * is. */
bool rc_safeguard_raised(struct rc_safeguard *guard, const struct rc_solver *solver);
/* solver->p goes back to `old`, and from there towards the projection of p - g / |K|, to the lowest
 * point on that way. t, r: scratch of n. Costs two convolutions. */
void rc_safeguard_step(struct rc_solver *solver, const double *old, double *t, double *r);

#endif
