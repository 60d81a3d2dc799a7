/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Declarations for the interface of the solver and its methods. A method is a row of methods.list: it
 * improves the pressure step by step. solver.c judges, counts and reports.
 *
 * The problem: p with 0 <= p <= H and sum p dx dy = load that minimises 1/2 p'Kp - h'p. The gap is
 * g = Kp - h - c, c its mean over the elastic nodes (0 < p < H). The solution has g = 0 there, g >= 0 where p
 * = 0 and g <= 0 where p = H. Only bounds.h knows the values of 0 and H.
 *
 * struct rc_solver has four parts, each written by one file. They are the problem (solver.c), the iterate
 * (iterate.c; methods change its pressure and report it), the working set (working_set.c) and the load
 * (load_search.c).
 */
#ifndef RC_SOLVER_H
#define RC_SOLVER_H

#include <math.h>

#include "bounds.h"
#include "libcontact/memory.h"
#include "libcontact/operator/operator.h"
#include "preconditioner.h"

/* ---- methods ---- */

/* Findings of a step. */
struct rc_found {
    double change; /* relative L1 change of p; 0: p does not change */
    /* estimated relative L1 error of p, from a fresh K p; NAN: the method has none */
    double estimate;
};

struct rc_method {
    struct rc_method_info info;
    bool nested; /* starts with the solution on coarser grids */
    /* Expected convolutions (in equivalents), from measurements, for this number of nodes and of digits of
     * the tolerance. NULL: not measured. */
    double (*convolutions)(double nodes, double digits);
    /* The method's state, in memory of solver->own; NULL when that is short. */
    void *(*new)(struct rc_solver *solver);
    struct rc_found (*step)(struct rc_solver *solver, void *state);
    /* For a new load: the method drops the data of earlier steps. NULL: the method has none. */
    void (*forget)(void *state);
    /* A number that it keeps for later loads; NULL: none. */
    double *(*lasting)(void *state);
};

/* -DRC_METHODS_LIST=... replaces the list (tests/toys does). */
#ifndef RC_METHODS_LIST
#define RC_METHODS_LIST "libcontact/solver/methods.list"
#endif
#define RC_METHOD(name) extern const struct rc_method rc_method_##name;
#include RC_METHODS_LIST
#undef RC_METHOD

/* ---- the state ---- */

/* The problem: constant after rc_solver_new, except the heights. */
struct rc_posed {
    struct rc_shape whole; /* the whole map */
    struct rc_shape shape; /* the rows held here: all maps below have these rows */
    struct rc_rows rows;   /* place of these rows in the whole map */
    /* All ranks of the solver, each with its rows or, on a small coarse grid, with all rows. If one fails,
     * all fail. */
    const struct rc_ranks *all;
    struct rc_boundary boundary;
    size_t n, nodes; /* nodes held here, and of the whole map                                  */
    double cell;     /* dx dy                                                                  */
    double *h;       /* heights less their maximum, because a large constant would cost digits */
    double top;      /* that maximum                                                           */
    struct rc_bounds bounds;
    double height_error;   /* m: error of the heights                                             */
    double tol;            /* asked relative L1 error of the pressure                             */
    double history_part;   /* fraction of tol for a yielding load of a history; 0 stands for 1 */
    double dents;          /* N: error of the pressures of the earlier loads that made this shape */
    size_t max_iterations; /* most iterations per load */
    int threads;
    /* a grid of a nested start: its operator is not exact, and its estimate needs no check in double
     * precision */
    bool rough;
    bool discretization; /* the coarser grid is solved accurately enough for a comparison */
    const volatile sig_atomic_t *hurry; /* not 0: the caller cannot wait; NULL: never */
};

struct rc_iterate {
    double *p;         /* within its bounds, with the right load                      */
    double *v;         /* K p - h: the gap minus a constant */
    bool known, fresh; /* v belongs to p; v is from a convolution in double precision */
    bool rested;       /* nodes near their upper bounds were put at them              */
    double shift;      /* c: the gap is v - c                                         */
    size_t elastic;    /* nodes between their bounds                                  */
    size_t iterations;
    double convolutions; /* equivalents of one in double precision                             */
    double error;        /* estimated relative L1 error at the last check; NAN: none           */
    size_t checked;      /* iteration of that check                                            */
    size_t next_check;   /* iteration of the next check                                        */
};

/* The elastic nodes, and nodes at a bound with a gap of the wrong sign. */
struct rc_working_set {
    unsigned char *w; /* 1 on the set, else 0 */
    float *r;     /* residual -g on the set, divided by `length` of the load; undefined elsewhere */
    float offset; /* mean residual on the set */
    /* w and r of the rows before and after those held here, during sifting; NULL: without ranks */
    unsigned char *beside_w;
    float *beside_r;
    size_t size;
    bool whole;       /* no node that wants to join was sifted out                        */
    double saturated; /* sum of rc_room over the nodes off the set at their upper bounds  */
    double left_out;  /* pressure that the nodes sifted out would get, times per_pressure */
    /* Number of nodes that joined or left since the preconditioner was set; INFINITY: w is a new set. */
    double changed;
    double turnover; /* fraction of the set that joined or left in the last search */
};

/* The present load, and the search for the load of an approach. */
struct rc_load {
    double load; /* N                                                                          */
    double sum;  /* load / cell: the sum of the nodal pressures                                */
    /* Single precision has 38 decades; gaps in metres with moduli in pascals can need more. So pressures are
     * scaled to the order of 1 by a power of 2, which adds no rounding. */
    double per_pressure; /* single precision holds p times this */
    double length;       /* m: single precision holds displacements divided by this */
    double tol;          /* tolerance for this load: larger during the search */
    double target;       /* m: the wanted shift; 0: the load is given */
    double low, high;    /* loads with a smaller and a larger shift; 0, INFINITY: none yet */
    /* load, shift and estimated error of the last solution; 0: none */
    double last_load, last_shift, last_error;
    double power; /* d log load / d log shift, for the next load */
    /* the same from two loads that are well apart, and the logarithm of their ratio */
    double slope, apart;
    double error; /* relative error of the load; NAN: unknown until rc_load_error finds it */
};

/* The start from coarser grids. */
struct rc_nested {
    bool ahead;               /* a coarser grid exists and is not finished */
    struct rc_solver *coarse; /* NULL: not yet made */
    /* the coarse grid searches for the load too, and this grid starts from its load */
    bool sought;
    size_t lent; /* bytes of the coarser solver */
};

struct rc_solver {
    struct rc_posed posed;
    struct rc_iterate it;
    struct rc_working_set set;
    struct rc_load load;
    struct rc_operator *op;
    struct rc_preconditioner *preconditioner;
    const struct rc_method *method;
    void *state; /* state of the method */
    struct rc_nested nested;
    struct rc_tilt *tilt;            /* NULL: the counter body does not tilt        */
    struct rc_discretization coarse; /* comparison with the coarser grid; NAN: none */
    float *z;                        /* n numbers: corrections, times per_pressure  */
    double *partial;                 /* sums of blocks and rows, for reduce.c       */
    struct rc_store own;
    enum rc_stage { /* to refuse a call that comes too early       */
        RC_STAGE_NEW,
        RC_STAGE_STEPPED,
        RC_STAGE_JUDGED /* rc_solver_result describes this pressure */
    } stage;
};

static inline struct rc_box
rc_box(const struct rc_solver *s, size_t first)
{
    return rc_box_at(&s->posed.bounds, first);
}

static inline bool
rc_elastic(const struct rc_solver *s, size_t k)
{
    return rc_between(rc_box(s, 0), k, s->it.p[k]);
}

/* ---- reduce.c: sums over all nodes ---- */

enum {
    RC_SUMS = 8,
    RC_MOST = RC_SUMS - 1 /* this entry holds the largest value, the others sums */
};
/* A pass over nodes first .. first + n - 1, at most RC_BLOCK_NODES, which adds to sums that start at 0. The
 * threads of each rank process its blocks. All ranks get the totals of the whole map, which do not depend on
 * the distribution of the blocks. All ranks call these functions. */
typedef void rc_block(void *ctx, size_t first, size_t n, double *sums);
void rc_reduce_blocks(const struct rc_solver *solver, rc_block *block, void *ctx,
                      double total[RC_SUMS]);
/* Rows of RC_SUMS numbers needed by these functions. */
size_t rc_reduce_partials(const struct rc_shape *shape);
/* The same for rows of a convolution: between these two calls each row adds to rc_reduce_row. */
void rc_reduce_rows_begin(const struct rc_solver *solver);
void rc_reduce_rows_end(const struct rc_solver *solver, double total[RC_SUMS]);
static inline double *
rc_reduce_row(const struct rc_solver *s, size_t j)
{
    return s->partial + j * RC_SUMS;
}

/* ---- history.c ---- */

/* Relative error of the pressure under this load from the errors of earlier loads. */
double rc_history_error(const struct rc_solver *solver);
/* The tolerance of this contact: that of the load, or a smaller one for later loads of the history. */
double rc_history_goal(const struct rc_solver *solver);

/* ---- iterate.c ---- */

void rc_iterate_new(struct rc_solver *solver);
/* Sets p to the mean pressure everywhere, within the bounds. */
void rc_iterate_level(struct rc_solver *solver);
/* The caller changed p or the load: v and the estimate are unknown. */
void rc_iterate_forget(struct rc_solver *solver);
/* v = K p - h in double precision. */
void rc_iterate_displace(struct rc_solver *solver);
/* The same in single precision if this costs less. Returns the RMS of K p in the units of the operator's
 * rows, for the rounding error; 0 if it used double precision. */
double rc_iterate_displace_rows(struct rc_solver *solver);
/* v += factor q of n nodes. */
void rc_iterate_follow(size_t n, const float *q, double factor, double *v);
/* The method changed p and v. `gap`: the sum of v over `elastic` elastic nodes, which gives the shift;
 * elastic 0: not summed, or no node is elastic. */
void rc_iterate_moved(struct rc_solver *solver, double gap, double elastic);
/* The method changed p but not v. */
void rc_iterate_unknown(struct rc_solver *solver);
/* Sets the counts of iterations and convolutions to 0. */
void rc_iterate_reset(struct rc_solver *solver);
/* Counts more convolutions, in equivalents. */
void rc_iterate_count(struct rc_solver *solver, double convolutions);
/* The shift: the mean of v over the elastic nodes. When there are none, it is the middle between the largest
 * v at an upper bound and the smallest at a lower one. Sets `elastic` and `shift`. */
void rc_iterate_shift(struct rc_solver *solver);
/* Sets the balancing shift: with it, steps of all nodes by their gaps, within their bounds, preserve the
 * load. */
void rc_iterate_balance(struct rc_solver *solver);
/* Pressure per displacement of a node whose neighbours are fixed, Pa/m. */
double rc_iterate_stiffness(const struct rc_solver *solver);
/* Puts nodes whose pressure is within ten tolerances of their upper bound at it and takes the load from the
 * other elastic nodes. False when there are none. */
bool rc_iterate_rest(struct rc_solver *solver);
/* Sum of p. */
double rc_iterate_carried(const struct rc_solver *solver);
/* True if p carries the load. Every method preserves the load; a result without it does not count as
 * converged. */
bool rc_iterate_keeps_load(const struct rc_solver *solver);
/* The relative error of the pressure from the operator's own error. */
double rc_iterate_operator_error(const struct rc_solver *solver);
/* Stores an estimate of the error of p; the next check comes after `again` iterations. */
void rc_iterate_checked(struct rc_solver *solver, double error, size_t again);
/* Estimates the error of p from a fresh K p, with the whole working set. */
double rc_iterate_judge(struct rc_solver *solver);

/* ---- working_set.c ---- */

enum rc_status rc_working_set_new(struct rc_solver *solver);
/* Finds the working set and its residual from v and the shift; `sift`: without nodes that the next step would
 * return to their bound. */
void rc_working_set_find(struct rc_solver *solver, bool sift);
/* The same after v += factor q; off the set p is at a bound. */
void rc_working_set_follow(struct rc_solver *solver, const float *q, double factor);
/* Makes all nodes the set; r does not change. */
void rc_working_set_all(struct rc_solver *solver);
/* Computes M 1 exactly where the operator requires it (see preconditioner.h). Uses z. */
void rc_working_set_spread(struct rc_solver *solver);
/* Makes the elastic nodes or, with `touching`, all nodes with pressure the set, with r = 1 on them. Returns
 * their number. */
size_t rc_working_set_fix(struct rc_solver *solver, bool touching);
/* Sets the preconditioner for the set, unless it has hardly changed. */
void rc_working_set_tell(struct rc_solver *solver);
/* z = E' A E r; `done` as in rc_preconditioner_apply. z still contains its mean. */
void rc_working_set_correct(struct rc_solver *solver, rc_row *done, void *ctx);
/* Subtracts the pressure of a common shift, `share` times rc_load_share of each node, from z. Returns the
 * estimated error: the relative L1 norm of the remaining z. */
double rc_working_set_error(struct rc_solver *solver, double share);
/* The shift of the solution under this load, from the present gaps: their mean over the set, each with the
 * share of its node in the load of a common shift. */
double rc_working_set_shift(struct rc_solver *solver);
/* The correction z and its estimated error. */
double rc_working_set_estimate(struct rc_solver *solver);

/* The number of nodes from `first` on, at most n, that one loop can process. *in true: some may carry
 * pressure; false: all are off the set and have pressure 0. */
size_t rc_working_set_stretch(const struct rc_solver *solver, size_t first, size_t n, bool *in);

/* The next set is unrelated to this one: the preconditioner will be set anew. */
void rc_working_set_forget(struct rc_solver *solver);

/* ---- solver.c ---- */

/* The caller changed p or the load: drops all derived fields. */
void rc_solver_restart(struct rc_solver *solver);
/* rc_solver_set_heights for a caller that sets the load or the approach next. The present approach belongs to
 * the former heights: with the new ones it may be beyond complete contact, and is not checked. */
enum rc_status rc_solver_next_heights(struct rc_solver *solver, const double *h,
                                      struct rc_err *err);
/* rc_solver_new, with a compliance that differs along x; the caller keeps `along` as long as the solver. */
struct rc_solver *rc_solver_new_along(const struct rc_shape *shape, const double *h,
                                      const struct rc_problem *problem,
                                      const struct rc_along *along, struct rc_err *err);
/* RC_FAIL when rc_solver_new would refuse the problem, whatever its load or approach is, except for short
 * memory. */
enum rc_status rc_solver_check(const struct rc_shape *shape, const struct rc_problem *problem,
                               struct rc_err *err);
/* The number that the method keeps for later loads, or `none`. */
double *rc_solver_lasting(const struct rc_solver *solver, double *none);
/* After a start from a pressure: it is the solution, with these errors of contact and load, of an iteration
 * that took so much. */
void rc_solver_found(struct rc_solver *solver, double error, double load_error, size_t iterations,
                     double convolutions);
/* True if the caller cannot wait. */
bool rc_solver_hurried(const struct rc_solver *solver);
/* Adds a diagonal to the operator, as rc_operator_set_diagonal, from the next load or heights on. It does not
 * work with a free tilt. */
enum rc_status rc_solver_set_diagonal(struct rc_solver *solver, double plus, const double *part,
                                      double row, struct rc_err *err);
/* z (n Pa) = E' A E e on the elastic nodes, e (n m), less the pressure of a common shift. Costs two factors
 * of a chain. */
void rc_solver_respond(struct rc_solver *solver, const double *e, double *z);
/* A solver of the same contact on a coarser grid, for a nested start; its operator is not exact. */
struct rc_solver *rc_solver_coarse(const struct rc_solver *fine, const struct rc_shape *shape,
                                   const double *h, const struct rc_problem *problem,
                                   struct rc_err *err);

/* ---- load_search.c ---- */

/* Tolerance of the load in a search, as a fraction of the tolerance of the pressure. It is small beside
 * the tolerance of the contact. Half takes 0.7 % more convolutions. The estimate of the pressure
 * contains the error of the load. */
#define RC_LOAD_TOL 0.1

/* RC_FAIL when this load exceeds the upper bounds of all nodes of the map. */
enum rc_status rc_load_check(double load, const struct rc_bounds *bounds, double cell, size_t nodes,
                             struct rc_err *err);
/* Sets the load and its derived numbers; RC_FAIL when there is no solution. */
enum rc_status rc_load_set(struct rc_solver *solver, double load, struct rc_err *err);
/* True if there is an approach from which on the contact is complete. */
bool rc_load_completes(const struct rc_solver *solver);
/* RC_FAIL for an approach from `full` on, where the contact is complete: the highest node over the mean. */
enum rc_status rc_load_reach(double approach, double full, struct rc_err *err);
/* Sets the first load: the given one or, in a search, a guess. */
enum rc_status rc_load_first(struct rc_solver *solver, const struct rc_problem *problem,
                             struct rc_err *err);
/* Sets another load: the given one or, with an approach > 0, a search that starts from the present load. */
enum rc_status rc_load_next(struct rc_solver *solver, double load, double approach,
                            struct rc_err *err);
/* The same load or approach for other heights, unchecked: it may be out of reach there. */
enum rc_status rc_load_again(struct rc_solver *solver, struct rc_err *err);
/* After a solution: RC_OK when it has the wanted shift, else sets the next load. */
enum rc_status rc_load_search(struct rc_solver *solver);
/* The estimated relative error of the load, which is that of the pressure, too: no pressure decreases as
 * the load increases. 0 if the load was given. */
double rc_load_error(struct rc_solver *solver);
/* True if the wanted approach is reached, or if the load was given. */
bool rc_load_reached(const struct rc_solver *solver);

/* ---- stiffness.c ---- */

/* X'K^-1 X on the elastic nodes, over the cell; the columns of X are 1 and the arms along x and y. False
 * where no node is elastic. Uses the working set and z. room: 3 n numbers. */
bool rc_stiffness_turning(struct rc_solver *solver, float *room, double k[3][3]);

/* ---- tilt.c: all except rc_arm also work without a tilt ---- */

/* RC_FAIL when the problem has no solution with a free tilt, or memory is short. */
enum rc_status rc_tilt_new(struct rc_solver *solver, const struct rc_problem *problem,
                           struct rc_err *err);
/* Coordinate of node k (of those held here) along an axis (0: x, 1: y). It is counted from the point of the
 * force, and divided by the length of the map. */
double rc_arm(const struct rc_solver *solver, size_t axis, size_t k);
/* Call after new heights, or after a new load with the heights of the last tilt. */
void rc_tilt_heights(struct rc_solver *solver);
void rc_tilt_load(struct rc_solver *solver);
/* The height of node k that the tilt has subtracted. */
double rc_tilt_rise(const struct rc_solver *solver, size_t k);
/* Call when the iteration on this grid begins. */
void rc_tilt_begin(struct rc_solver *solver);
/* After a contact is solved: RC_OK when its moment is 0. Else it tilts the counter body, or demands a more
 * accurate solution of this contact. */
enum rc_status rc_tilt_search(struct rc_solver *solver);
/* Returns `status` of the search; if the search has ended, restores the tolerance of the load. */
enum rc_status rc_tilt_end(struct rc_solver *solver, enum rc_status status);
/* The tolerance of the load; contacts during the search have others. */
double rc_tilt_goal(const struct rc_solver *solver);
/* The error of p, from the error of the contact at this tilt and from its moment. */
double rc_tilt_error(struct rc_solver *solver, double contact);
/* The shift, from the position of first touch of a rigid body, and for the datum of the problem. */
double rc_tilt_approach(const struct rc_solver *solver);
/* Slope of the counter body along an axis. */
double rc_tilt_slope(const struct rc_solver *solver, size_t axis);
/* rc_tilt_pose sets the tilt of the problem on a coarser grid; the second function takes the tilt that the
 * coarser grid found. */
void rc_tilt_pose(const struct rc_solver *solver, struct rc_problem *coarse);
void rc_tilt_from_coarse(struct rc_solver *solver, const struct rc_solver *coarse);
/* The tilt with the smallest gaps at the elastic nodes of p. */
void rc_tilt_from_pressure(struct rc_solver *solver);

/* ---- nested.c ---- */

/* Sets solver->nested if a start from a coarser grid pays. Does not iterate yet. */
void rc_nested_new(struct rc_solver *solver);
void rc_nested_free(struct rc_solver *solver);
/* One iteration on the coarser grids. After the last one their pressure is the start on this grid, and
 * solver->nested.ahead is false. */
void rc_nested_step(struct rc_solver *solver);
/* Ends the nested start early: its present pressure is the start on this grid. */
void rc_nested_end(struct rc_solver *solver);
/* True if a nested start exists and has not begun. */
bool rc_nested_untouched(const struct rc_solver *solver);
/* The solver of the grid that is being iterated: this one or a coarser one. */
const struct rc_solver *rc_nested_at_work(const struct rc_solver *solver);
/* Convolutions on the coarser grids so far, in equivalents on this one. */
double rc_nested_convolutions(const struct rc_solver *solver);

/* ---- projection.c ---- */

/* Makes p carry the load: scales the pressures of the elastic nodes above their lower bounds, within the
 * bounds. The remaining load goes to the nodes of smallest g; if nodes at their upper bounds alone exceed the
 * load, all nodes are scaled. */
void rc_projection_balance(struct rc_solver *solver, const double *g);
/* The same if the load is wrong by more than rounding; nodes join in the order of v. */
void rc_projection_restore(struct rc_solver *solver, double carried);

/* The nearest map to y within the bounds and with the load: one shift of all nodes, clipped. */
void rc_projection_of(const struct rc_solver *solver, double *y);

/* The load at a shift less the wanted load, and its slope; both increase with the shift. */
struct rc_excess {
    double load, slope;
};
typedef struct rc_excess rc_excess_at(void *ctx, double shift);
/* The shift between low and high where the excess is 0, by Newton's method from `start`; an excess up
 * to `least` counts as 0. */
double rc_newton(rc_excess_at *at, void *ctx, double low, double high, double start, double least);

/* A step of the nodes of the working set, p + alpha (d - mean), returned to the bounds. The result is in p;
 * the change of p, times per_pressure, is in delta, which is 0 off the set. */
struct rc_move {
    struct rc_solver *solver;
    const float *d; /* direction, times per_pressure; nodes where it is 0 do not get the mean */
    double alpha;   /* over per_pressure                                                      */
    double mean;    /* mean of d */
    float *delta;
    struct rc_tile *tiles;           /* rc_tiles of them: scratch                               */
    const struct rc_tile_line *line; /* scratch                                                 */
    double size;                     /* result: sum of |delta|, as a pressure, or a little more */
    bool clipped;                    /* result: some node would have left the bounds            */
};
/* Moves by one shift of all nodes of the set, the Euclidean projection. If the set cannot carry its share,
 * all nodes become the set. */
void rc_move_shift(struct rc_move *move);

/* ---- tiles.c ---- */

/* The state of a tile after a move. */
struct rc_tile {
    double room;  /* the shift that all its elastic nodes can take */
    size_t count; /* its elastic nodes                             */
    double left;  /* the load that it could not carry              */
};
size_t rc_tiles(const struct rc_shape *shape);
/* The tiles of a map of one row or one column that ranks share; else empty. */
struct rc_tile_line {
    struct rc_tile *tiles; /* tiles of all ranks */
    size_t *from;          /* the first tile of each rank, and their number */
};
void rc_tile_line_new(struct rc_tile_line *line, const struct rc_posed *posed,
                      struct rc_store *own);
/* Moves by a shift of each tile of the map. A node at its bound that would leave the bounds stays there and
 * does not count as clipped. False when the load cannot be kept this way; delta then holds the changes so
 * far. */
bool rc_move_tiles(struct rc_move *move);

/* ---- safeguard.c ---- */

struct rc_safeguard {
    double energy; /* energy of the last kept p; starts at INFINITY */
};
/* True if the energy has risen above that of the last kept p. If it has not risen, keeps this p. */
bool rc_safeguard_raised(struct rc_safeguard *safeguard, const struct rc_solver *solver);
/* Resets the pressure to `old` and moves it towards the projection of p - g / |K|, to the lowest energy on
 * that line. t, r: scratch of n numbers. Costs two convolutions. */
void rc_safeguard_step(struct rc_solver *solver, const double *old, double *t, double *r);

#endif
