/*
 * Shared by the solver's front and its methods. A method is a row of methods.list: it improves the
 * pressure step by step. The front (solver.c) judges, counts and reports.
 *
 * The problem: p with 0 <= p <= H and sum p dx dy = load that minimises 1/2 p'Kp - h'p. With the
 * gap g = Kp - h - c, c its mean over the elastic nodes (0 < p < H), the solution has g = 0 there,
 * g >= 0 where p = 0 and g <= 0 where p = H. What 0 and H are only bounds.h knows.
 *
 * struct rc_solver has four parts, each written by one file: the problem (solver.c), the iterate
 * (iterate.c; methods move its pressure, and say so), the working set (working_set.c) and the load
 * (load_search.c).
 */
#ifndef RC_SOLVER_H
#define RC_SOLVER_H

#include <math.h>

#include "bounds.h"
#include "libcontact/operator/operator.h"
#include "preconditioner.h"
#include "pyramid.h"

/* ---- methods ---- */

/* Findings of a step. */
struct rc_found {
    double change;   /* relative L1 change of p; 0: p stands still                              */
    double estimate; /* of its relative L1 error, from a fresh K p; NAN: the method has none    */
};

struct rc_method {
    struct rc_method_info info;
    bool nested; /* starts from the solution on coarser grids */
    /* Convolutions (in equivalents) to expect, from measurements, for a grid of so many nodes and a
     * tolerance of so many digits. NULL: not measured. */
    double (*convolutions)(double nodes, double digits);
    /* Bytes of its state; NULL: unknown. */
    size_t (*memory)(const struct rc_shape *shape);
    /* The method's own state; NULL and *err when memory is short. */
    void *(*new)(const struct rc_solver *solver, struct rc_err *err);
    struct rc_found (*step)(struct rc_solver *solver, void *state);
    /* Another load: the method drops what it keeps from step to step. NULL: it keeps nothing. */
    void (*forget)(void *state);
    void (*free)(void *state);
};

/* -DRC_METHODS_LIST=... replaces the list (tests/toys does). */
#ifndef RC_METHODS_LIST
#define RC_METHODS_LIST "libcontact/solver/methods.list"
#endif
#define RC_METHOD(name) extern const struct rc_method rc_method_##name;
#include RC_METHODS_LIST
#undef RC_METHOD

/* ---- the state ---- */

/* The problem as it was posed: constant after rc_solver_new, but for the heights. */
struct rc_posed {
    struct rc_shape whole; /* of the map                                               */
    struct rc_shape shape; /* of the rows held here: all maps below hold these rows    */
    struct rc_rows rows;   /* which rows of the map these are                          */
    /* The ranks that take part, each with its rows, or, on a small coarse grid, with all of them: if
     * one fails, all do. */
    const struct rc_ranks *all;
    enum rc_boundary boundary;
    size_t n, nodes; /* nodes held here, and of the whole map            */
    double cell;     /* dx dy                                                    */
    double *h;       /* heights less their maximum: a distant datum would cost digits */
    double top;      /* that maximum                                             */
    struct rc_bounds bounds;
    double height_error; /* m: error of the heights                                  */
    double tol;          /* asked relative L1 error of the pressure                  */
    double history_part; /* of it: the tolerance of a load that yields in a history; 0: 1 */
    double dents; /* N: what the pressures of earlier loads were off that left this shape     */
    size_t max_iterations; /* of one load                                              */
    int threads;
    bool rough;          /* this grid is part of a nested start: its operator is not exact, and its
                              estimate is believed without a check in double precision */
    bool discretization; /* the coarser grid is solved well enough to compare with   */
    const volatile sig_atomic_t *hurry; /* not 0: the caller cannot wait; NULL: it can */
};

struct rc_iterate {
    double *p;         /* in the box, with the load                                          */
    double *v;         /* K p - h: the gap but for a constant                                */
    bool known, fresh; /* v belongs to p; v comes from a convolution in double precision     */
    bool rested;       /* nodes near their upper bounds have been put there */
    double shift;      /* c: the gap is v - c                                                */
    size_t elastic;    /* nodes between their bounds                                         */
    size_t iterations;
    double convolutions; /* equivalents of one in double precision                             */
    double error;        /* estimated relative L1 error at the last check; NAN: none           */
    size_t checked;      /* iteration of that check                                            */
    size_t next_check;   /* iteration of the next check                                        */
};

/* The elastic nodes, and those at a bound that want to leave it. */
struct rc_working_set {
    unsigned char *w; /* 1 on it, else 0                                                       */
    float *r;         /* residual -g on it, over `length` of the load; elsewhere nothing        */
    float offset;     /* its mean there                                                        */
    /* w and r of the rows before and after those held here, while nodes are sifted; NULL: without
     * ranks */
    unsigned char *beside_w;
    float *beside_r;
    size_t size;
    bool whole;       /* no node that wants to join is left out                              */
    double saturated; /* sum of rc_room over the nodes off the set at their upper bounds       */
    double left_out;  /* pressure that the nodes sifted out would carry, times per_pressure     */
    /* Nodes that joined or left since the preconditioner was told w; INFINITY: w is a new set
     * altogether. */
    double changed;
    double turnover; /* the part of it that joined or left when it was last found */
};

/* The load that is set, and the search for the one that an approach needs. */
struct rc_load {
    double load; /* N                                                                          */
    double sum;  /* load / cell: the sum of the nodal pressures                                */
    /* Single precision has 38 decades, and gaps in metres with moduli in pascals can need more. So
     * pressures are scaled to the order of 1, by a power of 2, which rounds nothing. */
    double per_pressure; /* single precision holds p times this ...                            */
    double length;       /* ... and displacements over this (m)                                */
    double tol;          /* tolerance for this load: looser during the search                  */
    double target;       /* the shift wanted, m; 0: the load is given                          */
    double low, high;    /* loads with a smaller and a larger shift; 0, INFINITY: none yet     */
    double last_load, last_shift; /* of the last solution; 0: none                             */
    double power; /* d log load / d log shift                                           */
};

/* The start from coarser grids. */
struct rc_nested {
    bool ahead;               /* there is one, and it is not done                            */
    struct rc_solver *coarse; /* NULL: not yet begun                                         */
    bool sought; /* the coarse grid seeks the load too, and this grid begins with its result */
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
    void *state; /* the method's                                              */
    struct rc_nested nested;
    struct rc_tilt *tilt;            /* NULL: the face keeps its direction                  */
    struct rc_discretization coarse; /* figures of the coarser grid; NAN: none             */
    float *z;                        /* n numbers: corrections, times per_pressure                */
    double *partial;                 /* sums of blocks and rows: reduce.c                         */
    enum rc_stage { /* so that a call that comes too early is refused              */
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
    RC_MOST = RC_SUMS - 1 /* of this the largest is taken, of the others the sum */
};
/* A pass over nodes first .. first + n - 1, at most RC_BLOCK_NODES, which adds to sums that begin
 * at 0. Several threads, and the ranks that hold them, take the blocks; all ranks get the totals of
 * the whole map, and these do not depend on who took which block. All ranks call these. */
typedef void rc_block(void *ctx, size_t first, size_t n, double *sums);
void rc_reduce_blocks(const struct rc_solver *solver, rc_block *block, void *ctx,
                      double total[RC_SUMS]);
/* Rows of RC_SUMS numbers that these need. */
size_t rc_reduce_partials(const struct rc_shape *shape);
/* The same for rows that come out of a convolution: between these two calls each row adds to
 * rc_reduce_row. */
void rc_reduce_rows_begin(const struct rc_solver *solver);
void rc_reduce_rows_end(const struct rc_solver *solver, double total[RC_SUMS]);
static inline double *
rc_reduce_row(const struct rc_solver *s, size_t j)
{
    return s->partial + j * RC_SUMS;
}

/* ---- history.c ---- */

/* The error of the pressure that what earlier loads were off makes under this load. */
double rc_history_error(const struct rc_solver *solver);
/* The tolerance of this contact: that of the load, or less for the sake of others. */
double rc_history_goal(const struct rc_solver *solver);

/* ---- iterate.c ---- */

enum rc_status rc_iterate_new(struct rc_solver *solver);
void rc_iterate_free(struct rc_solver *solver);
/* p becomes the mean pressure everywhere, within the bounds. */
void rc_iterate_level(struct rc_solver *solver);
/* p or the load has been changed from outside: v and the estimate are unknown. */
void rc_iterate_forget(struct rc_solver *solver);
/* v = K p - h in double precision. */
void rc_iterate_displace(struct rc_solver *solver);
/* The same in single precision, where that costs less. Returns the RMS of K p in the units of the
 * operator's rows, to which the rounding error is relative; 0 where it took double precision. */
double rc_iterate_displace_rows(struct rc_solver *solver);
/* The method has moved p, and v with it. `gap`: the sum of v over so many elastic nodes, which gives
 * the shift; elastic 0: not summed, or no node is elastic. */
void rc_iterate_moved(struct rc_solver *solver, double gap, double elastic);
/* The method has moved p, and not v. */
void rc_iterate_unknown(struct rc_solver *solver);
/* Sets the counts of iterations and convolutions to 0. */
void rc_iterate_reset(struct rc_solver *solver);
/* Counts more convolutions, in equivalents. */
void rc_iterate_count(struct rc_solver *solver, double convolutions);
/* The shift: mean of v over the elastic nodes, or, when there are none, the middle between the
 * largest v at an upper bound and the smallest at a lower one. Sets `elastic` and `shift`. */
void rc_iterate_shift(struct rc_solver *solver);
/* Another shift: the one at which steps of all nodes by their gaps, within their bounds, keep the load. */
void rc_iterate_balance(struct rc_solver *solver);
/* Pressure per displacement of a node whose neighbours keep still, Pa/m. */
double rc_iterate_stiffness(const struct rc_solver *solver);
/* Puts nodes whose pressure is within ten tolerances of their upper bound there; the other elastic nodes
 * give the load for it. False when there are none. */
bool rc_iterate_rest(struct rc_solver *solver);
/* Sum of p. */
double rc_iterate_carried(const struct rc_solver *solver);
/* Whether p carries the load. Every method keeps it; without it a result does not count as
 * converged. */
bool rc_iterate_keeps_load(const struct rc_solver *solver);
/* The relative error of the pressure that follows from the operator's own error. */
double rc_iterate_operator_error(const struct rc_solver *solver);
/* Notes an estimate of the error of p; the next check comes after `again` iterations. */
void rc_iterate_checked(struct rc_solver *solver, double error, size_t again);
/* Estimates the error of p from a fresh K p, with the whole working set. */
double rc_iterate_judge(struct rc_solver *solver);

/* ---- working_set.c ---- */

enum rc_status rc_working_set_new(struct rc_solver *solver);
void rc_working_set_free(struct rc_solver *solver);
/* Finds the working set and the residual on it, from v and the shift; `sift`: without nodes that would
 * only be pushed back to their bound. */
void rc_working_set_find(struct rc_solver *solver, bool sift);
/* The same after v += factor q; off the set p is at a bound. */
void rc_working_set_follow(struct rc_solver *solver, const float *q, double factor);
/* The set becomes all nodes; r stays. */
void rc_working_set_all(struct rc_solver *solver);
/* Computes M 1 exactly where the operator requires it (see preconditioner.h). Uses z. */
void rc_working_set_spread(struct rc_solver *solver);
/* The set becomes the elastic nodes, `touching` all that carry pressure, with r = 1 on them;
 * returns their number. */
size_t rc_working_set_fix(struct rc_solver *solver, bool touching);
/* z = E' A E r; `done` as in rc_preconditioner_apply. The mean of z is still in it. */
void rc_working_set_correct(struct rc_solver *solver, rc_row *done, void *ctx);
/* Takes the pressure of a shift, `share` times rc_load_share of each node, out of z, and returns the
 * estimate of the error: the relative L1 norm of the rest of z. */
double rc_working_set_error(struct rc_solver *solver, double share);
/* The correction z and its estimate in one. */
double rc_working_set_estimate(struct rc_solver *solver);

/* How many of the n nodes from `first` on can be treated alike. *in: some may carry something; else
 * all of them are off the set and their pressures are 0. */
size_t rc_working_set_stretch(const struct rc_solver *solver, size_t first, size_t n, bool *in);

/* The next set has nothing to do with this one: the preconditioner will be told all of it. */
void rc_working_set_forget(struct rc_solver *solver);

/* ---- solver.c ---- */

/* p or the load has been changed from outside: drops all that was derived from them. */
void rc_solver_restart(struct rc_solver *solver);
/* Whether the caller cannot wait any more. */
bool rc_solver_hurried(const struct rc_solver *solver);
/* A solver of the same contact on a coarser grid, with an operator that is not exact: for a start. */
struct rc_solver *rc_solver_coarse(const struct rc_solver *fine, const struct rc_shape *shape,
                                   const double *h, const struct rc_problem *problem,
                                   struct rc_err *err);

/* ---- load_search.c ---- */

/* Of the tolerance: what a load that is sought may be off. */
#define RC_LOAD_TOL 0.1

/* RC_FAIL when there is no solution under this load: more than the bounds carry on the map. */
enum rc_status rc_load_check(double load, const struct rc_bounds *bounds, double cell, size_t nodes,
                             struct rc_err *err);
/* Sets the load and what follows from it; RC_FAIL when there is no solution. */
enum rc_status rc_load_set(struct rc_solver *solver, double load, struct rc_err *err);
/* The first load: the one given, or where one is sought a guess. */
enum rc_status rc_load_first(struct rc_solver *solver, const struct rc_problem *problem,
                             struct rc_err *err);
/* Another load: the one given, or, with an approach > 0, one that is sought from the present one. */
enum rc_status rc_load_next(struct rc_solver *solver, double load, double approach,
                            struct rc_err *err);
/* After a solution: RC_OK when its shift is the wanted one, else it sets the next load. */
enum rc_status rc_load_search(struct rc_solver *solver);
/* Whether the approach is the one that is sought, if one is. */
bool rc_load_reached(const struct rc_solver *solver);

/* ---- stiffness.c ---- */

/* X'K^-1 X on the elastic nodes, over the cell, with the columns of X 1 and the arms along x and y; false
 * where none are elastic. Uses the working set and z. room: 3 n numbers. */
bool rc_stiffness_turning(struct rc_solver *solver, float *room, double k[3][3]);

/* ---- tilt.c: all but rc_arm allow a face that keeps its direction ---- */

/* RC_FAIL where the problem asks for what cannot be, or memory is short. */
enum rc_status rc_tilt_new(struct rc_solver *solver, const struct rc_problem *problem,
                           struct rc_err *err);
void rc_tilt_free(struct rc_solver *solver);
/* The place of node k of those held here from the point of the force along an axis (0: x, 1: y), over the
 * length of the map. */
double rc_arm(const struct rc_solver *solver, size_t axis, size_t k);
/* The heights are new ones, or those of the last tilt with a new load. */
void rc_tilt_heights(struct rc_solver *solver);
void rc_tilt_load(struct rc_solver *solver);
/* What tilt has taken off the height of node k. */
double rc_tilt_rise(const struct rc_solver *solver, size_t k);
/* The iteration on this grid begins. */
void rc_tilt_begin(struct rc_solver *solver);
/* After a contact is solved: RC_OK when its moment is 0, else it tilts the face, or asks for a better
 * solution of this contact. */
enum rc_status rc_tilt_search(struct rc_solver *solver);
/* Returns `status` of the search; when that ends, the tolerance is again that of the load. */
enum rc_status rc_tilt_end(struct rc_solver *solver, enum rc_status status);
/* The tolerance of the load, which that of a contact on the way is not. */
double rc_tilt_goal(const struct rc_solver *solver);
/* The error of p from that of the contact at this tilt and from its moment. */
double rc_tilt_error(struct rc_solver *solver, double contact);
/* The shift from where a rigid body would stand. */
double rc_tilt_approach(const struct rc_solver *solver);
/* Slope of the face along an axis. */
double rc_tilt_slope(const struct rc_solver *solver, size_t axis);
/* The problem of a coarser grid, and the tilt that it found. */
void rc_tilt_pose(const struct rc_solver *solver, struct rc_problem *coarse);
void rc_tilt_from_coarse(struct rc_solver *solver, const struct rc_solver *coarse);
/* The tilt under which the elastic nodes of p have the least gaps. */
void rc_tilt_from_pressure(struct rc_solver *solver);

/* ---- nested.c ---- */

/* Sets solver->nested where the grid is worth a start from a coarser one.
 * Nothing is iterated yet. */
void rc_nested_new(struct rc_solver *solver);
void rc_nested_free(struct rc_solver *solver);
/* One iteration on the coarser grids. After the last one their pressure is the start on this grid, and
 * solver->nested.ahead is false. */
void rc_nested_step(struct rc_solver *solver);
/* Ends the nested start where it is: its present pressure is the start on this grid. */
void rc_nested_end(struct rc_solver *solver);
/* Whether the nested start is ahead and has not begun. */
bool rc_nested_untouched(const struct rc_solver *solver);
/* The solver of the grid that is being iterated: this one, or one below. */
const struct rc_solver *rc_nested_at_work(const struct rc_solver *solver);
/* Convolutions on the coarser grids so far, in equivalents on this one. */
double rc_nested_convolutions(const struct rc_solver *solver);

/* ---- projection.c ---- */

/* Makes p carry the load: scales what the elastic nodes carry above their lower bounds, within the
 * box. What they cannot carry goes to the nodes of smallest g; where nodes at their upper bounds alone
 * carry too much, all nodes are scaled. */
void rc_projection_balance(struct rc_solver *solver, const double *g);
/* The same where the load is off by more than rounding; nodes join by v. */
void rc_projection_restore(struct rc_solver *solver, double carried);

/* The nearest point of the box with the load to this map: one shift for all nodes, clipped. */
void rc_projection_of(const struct rc_solver *solver, double *y);

/* The load at one shift less the wanted load, and its slope; it grows with the shift. */
struct rc_excess {
    double load, slope;
};
typedef struct rc_excess rc_excess_at(void *ctx, double shift);
/* The shift between low and high where the excess is 0, by Newton's method from `start`; an excess up
 * to `least` counts as 0. */
double rc_newton(rc_excess_at *at, void *ctx, double low, double high, double start, double least);

/* A step of the nodes of the working set, p + alpha (d - mean), and the way back into the box. The
 * result is in p; the change of p, times per_pressure, is in delta, which is 0 off the set. */
struct rc_move {
    struct rc_solver *solver;
    const float *d; /* direction, times per_pressure; where it is 0 its mean does not count   */
    double alpha;   /* over per_pressure                                                       */
    double mean;    /* of d                                                                    */
    float *delta;
    struct rc_tile *tiles;           /* rc_tiles of them: scratch                            */
    const struct rc_tile_line *line; /* scratch                                              */
    double size;  /* found: sum of |delta|, as a pressure, or a little more                    */
    bool clipped; /* found: some node would have left the box                                  */
};
/* By one shift of all nodes of the set, the Euclidean projection. Where the set cannot carry its
 * share all nodes become the set. */
void rc_move_shift(struct rc_move *move);

/* ---- tiles.c ---- */

/* A tile after a move. */
struct rc_tile {
    double room;  /* the shift that all its elastic nodes can take   */
    size_t count; /* its elastic nodes                               */
    double left;  /* the load that it could not keep                 */
};
size_t rc_tiles(const struct rc_shape *shape);
/* Room for the tiles of a map of one row or one column that ranks share; else empty. */
struct rc_tile_line {
    struct rc_tile *tiles; /* of all ranks                     */
    size_t *from;          /* the first one of each rank, and their number */
};
/* RC_FAIL when memory is short; rc_tile_line_free in either case. */
enum rc_status rc_tile_line_new(struct rc_tile_line *line, const struct rc_posed *posed);
void rc_tile_line_free(struct rc_tile_line *line);
/* By a shift for each tile of the map. A node at its bound that would leave the box stays there, and
 * does not count as clipped. False when the load cannot be kept that way; delta then tells what has
 * been moved. */
bool rc_move_tiles(struct rc_move *move);

/* ---- safeguard.c ---- */

struct rc_safeguard {
    double energy; /* of the last p that was kept; begins with INFINITY */
};
/* Whether the energy has risen above that of the last p that was kept; if not, this p is kept. */
bool rc_safeguard_raised(struct rc_safeguard *safeguard, const struct rc_solver *solver);
/* The pressure goes back to `old`, and from there towards the projection of p - g / |K|, to the
 * lowest point on that way. t, r: scratch of n. Costs two convolutions. */
void rc_safeguard_step(struct rc_solver *solver, const double *old, double *t, double *r);

#endif
