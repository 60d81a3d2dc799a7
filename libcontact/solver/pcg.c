/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Projected conjugate gradients with the extension preconditioner (preconditioner.h).
 *
 * Working set W: the elastic nodes, and the nodes at a bound whose gap has the wrong sign. Nodes that the
 * next step would return to the bound do not belong to it (working_set.c). Residual r = -g on W with zero
 * mean, z = E' A E r with zero mean. Direction z + beta delta, conjugate to the last step delta unless much
 * of that step was clipped; it is restarted when beta is negative. The step is returned to {0 <= p <= H, sum
 * p = S} tile by tile (tiles.c). Where this does not lower the energy, one shift of all nodes of W returns it
 * (projection.c). Scaling instead, as in (31b) of Polonsky and Keer, fails near saturation. One shift of all
 * nodes of the map puts every separated node into contact.
 *
 * The length of a step is predicted from earlier steps. So one convolution K delta of the clipped step is
 * enough for three purposes. These are the new gap, the change of the energy (a quadratic along delta, known
 * exactly) and the conjugacy of the next direction. A clipped step that goes far beyond the lowest energy is
 * repeated with a smaller length; an unclipped one ends at the lowest energy. So no step raises the energy.
 * Every SPACER steps, and where no length lowers the energy, a projected-gradient step is taken instead. By
 * the spacer-step theorem (Luenberger and Ye, Linear and Nonlinear Programming) the iteration then converges
 * to the unique minimum.
 *
 * ||z||_1 / ||p||_1 estimates the error of the pressure at no cost, because z is known.
 *
 * Where the operator allows it, K delta is summed in single precision: its error is relative to delta, which
 * shrinks. `drift` is a bound of the resulting error of p. v is recomputed in double precision before this
 * error matters, and always before an estimate ends the iteration.
 */
#include "solver.h"

#include <math.h>
#include <stdlib.h>

#include "libcontact/memory.h"

enum {
    /* Steps after which one is a projected-gradient step. Its convergence is proven, that of the others
     * is not. With half 123 contacts take 1 % more convolutions, with double 1 % fewer
     * (bench/constants.py). */
    SPACER = 30,
    /* Steps without a better estimate, after which only rounding errors are left; at least one of them
     * is a spacer step. With 25 a wave of 16384 nodes, 3.5 % in contact, ended at 4e-4. Not sensitive:
     * half and double change no bit of 123 contacts (bench/constants.py). */
    PATIENCE = 40,
    /* Attempts to shorten a step: each leaves at least a fifth of it. Not sensitive: half and double
     * change the convolutions of 123 contacts by less than 1 % together (bench/constants.py). */
    TRIES = 4,
    /* Times the elastic nodes: a larger set does not use their mean gap. Not sensitive: half and double
     * change the convolutions of 123 contacts by at most 1 % together (bench/constants.py). */
    LARGE = 2
};
/* The longest step, relative to the load: beyond it rounding loses the pressure of the nodes that stay.
 * Only heights that far exceed the displacement need longer steps. A load of 1e-21 of what the heights
 * ask for needed this bound. Not sensitive: half and double change no count of 123 contacts
 * (bench/constants.py). */
static const double longest = 1e6;
/* The smallest predicted length of a step: the first steps under a stiff coating are as short as this.
 * Not sensitive: half and double change the convolutions of 123 contacts by less than 1 % together
 * (bench/constants.py). */
static const double shortest = 0.15;
/* A clipped step is taken whole, so that its clipped nodes stay at their bounds. The condition is that
 * the lowest energy lies at least this fraction s of the way along it. The whole step then has at least
 * (2 s - 1)/s^2 of the largest possible gain. At 0.75 this is 8/9 of it. Half takes 1 % fewer
 * convolutions. No step is as good as double asks, which takes 40 % more (74 contacts of
 * bench/constants.py). */
static const double enough = 0.75;
/* An estimate above this at the start means that the heights far exceed the displacements: each node
 * touches or yields nearly independently of the others. A bed of springs, each with the stiffness of
 * its own cell, is then a better start. On 49 x 25 nodes 31 steps became 1. Not sensitive: half and
 * double change the convolutions of 123 contacts by less than 1 % together (bench/constants.py). */
static const double apart = 100;
/* The largest clipped step, relative to the load, for which the next direction is made conjugate. On
 * uniform bodies, where the eigenvalues are near 1, a larger limit saves no steps and makes the
 * estimate less accurate. The estimate is most accurate for errors along the smallest eigenvalues. Half
 * changes no count of 123 contacts, and double takes 0.5 % more convolutions (bench/constants.py). */
static const double conjugate = 1e-2;
/* In conjugate gradients on a fixed set the factor of the last direction is b = (z'r) / (the previous
 * z'r). This is about the square of the ratio of two estimates. If nodes joined or left, z'q also
 * contains their residuals, and the next step would repeat the last one. With b limited to this square,
 * uniform bodies at 33 % contact took four steps in place of six (Gilbert and Nocedal, SIAM J. Optim.
 * 2, 1992). But under coatings a few eigenvalues can lie far from the others, and the two values of b
 * differ. Seven elastic nodes under a coating 10^4 times as stiff as its base took 100 steps. So b is
 * not limited if at most this fraction of the set joined or left. On uniform bodies a larger fraction
 * would save nothing and make the estimate too small: 0.96 of the error at 99 % contact. Not sensitive:
 * half and double change no bit of 123 contacts (bench/constants.py). */
static const double few = 3e-4;

struct pcg {
    float *delta, *q;      /* the last step and K times it, in the units of the operator's rows */
    struct rc_tile *tiles; /* scratch of a move                                            */
    struct rc_tile_line line; /* the same                                               */
    double curvature;         /* delta'q; 0: the next direction is not made conjugate   */
    double alpha;             /* predicted length of the next step                      */
    double drift;             /* bound of the relative error of p from single precision */
    double estimate;          /* the last one; NAN: none yet                */
    double before;            /* the estimate one iteration earlier         */
    double rate;              /* ratio of the last two estimates, at most 1 */
    double best;              /* the least estimate                         */
    size_t best_at;           /* and its iteration                          */
};

/* Context of the passes over all nodes. */
struct pass {
    struct rc_solver *solver;
    struct pcg *s;
    double a, b;
};

static void
forget(void *at)
{
    struct pcg *s = at;

    s->curvature = 0;
    s->estimate = NAN;
    s->best = INFINITY;
    s->best_at = 0;
    s->rate = 1;
}

static double *
lasting(void *at)
{
    return &((struct pcg *)at)->alpha;
}

static void *
state_new(struct rc_solver *solver)
{
    struct rc_store *own = &solver->own;
    struct pcg *s = rc_store_zeros(own, 1, sizeof *s);
    const size_t n = solver->posed.n;

    if (s == NULL)
        return NULL;
    s->delta = rc_store_take(own, n, sizeof *s->delta);
    s->q = rc_store_take(own, n, sizeof *s->q);
    s->tiles = rc_store_take(own, rc_tiles(&solver->posed.shape), sizeof *s->tiles);
    rc_tile_line_new(&s->line, &solver->posed, own);
    /* The first length. Half takes 9 % more convolutions, double 3 % (74 contacts of bench/constants.py). */
    s->alpha = 0.9;
    forget(s);
    return own->failed ? NULL : s;
}

/* ---- v, the working set, the residual ---- */

/* The working set for v. Where nearly all loaded nodes yield, only a few are elastic. Their mean gap then
 * says little about the shift, and with it the nodes that leave their bounds would all move the same way.
 * There the shift makes the load of the joining nodes equal that of the leaving nodes. */
static void
settle(struct rc_solver *solver)
{
    if (solver->set.saturated == 0 || solver->set.size <= LARGE * solver->it.elastic)
        return;
    rc_iterate_balance(solver);
    rc_working_set_find(solver, true);
}

/* True if the caller cannot wait: the last convolution, of v or for it, may be undefined. */
static bool
cut_short(struct rc_solver *solver)
{
    if (!rc_solver_hurried(solver))
        return false;
    rc_iterate_unknown(solver);
    return true;
}

/* Computes the first v, in single precision for a rough solution. The error of single precision is relative
 * to the whole displacement, so on large maps v would have to be recomputed during the iteration. */
static void
begin(struct rc_solver *solver, struct pcg *s)
{
    s->drift = 0;
    if (solver->posed.rough)
        s->drift = solver->op->row_error * rc_iterate_displace_rows(solver);
    else
        rc_iterate_displace(solver);
    if (cut_short(solver))
        return;
    rc_iterate_shift(solver);
    rc_working_set_find(solver, true);
    settle(solver);
}

/* v in double precision and the whole working set: an estimate from them may end the iteration. */
static void
renew(struct rc_solver *solver, struct pcg *s)
{
    if (!solver->it.fresh)
        rc_iterate_displace(solver);
    if (cut_short(solver))
        return;
    s->drift = 0;
    rc_iterate_shift(solver);
    rc_working_set_find(solver, false);
    rc_working_set_spread(solver);
}

/* ---- the direction, and with it the estimate of the error ---- */

enum { /* sums of z */
    Z,
    ZQ,
    LOAD,
    LOAD_Q
};

enum {
    /* nodes of a row that are processed together: their intermediate values stay in the cache */
    PIECE = 256
};

RC_CLONES static void
products(size_t n, const unsigned char *restrict w, const float *restrict z,
         const float *restrict node, const float *restrict q, double *restrict sums)
{
    double sum = 0, product = 0, load = 0, other = 0;
    float m[PIECE];

    for (size_t i = 0; i < n; i++)
        m[i] = w[i] ? rc_load_share(node[i]) : 0;
#pragma omp simd reduction(+ : sum, load)
    for (size_t i = 0; i < n; i++) {
        sum += (double)z[i];
        load += (double)m[i];
    }
    sums[Z] += sum;
    sums[LOAD] += load;
    if (q == NULL)
        return;
#pragma omp simd reduction(+ : product, other)
    for (size_t i = 0; i < n; i++) {
        product += (double)z[i] * (double)q[i];
        other += (double)m[i] * (double)q[i];
    }
    sums[ZQ] += product;
    sums[LOAD_Q] += other;
}

static bool
corrected(void *at, size_t j, void *row)
{
    const struct pass *c = at;
    const struct rc_solver *s = c->solver;
    size_t nx = s->posed.shape.nx;
    const float *node = rc_preconditioner_nodes(s->preconditioner);
    double *sums = rc_reduce_row(s, j);

    (void)row;
    for (size_t i = 0; i < nx; i += PIECE) {
        size_t k = j * nx + i;
        products(nx - i < PIECE ? nx - i : PIECE, s->set.w + k, s->z + k, node + k,
                 c->s->curvature > 0 ? c->s->q + k : NULL, sums);
    }
    return true;
}

/* The direction z + b delta on W, and its sum. */
static void
turn_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;
    const struct rc_solver *s = c->solver;
    const float b = (float)c->b;

    for (size_t k = first; k < first + n; k++) {
        s->z[k] += s->set.w[k] ? b * c->s->delta[k] : 0;
        sums[0] += s->set.w[k] ? (double)s->z[k] : 0;
    }
}

/* z becomes the direction and `mean` its mean over W; returns the estimated error of p. */
static double
precondition(struct rc_solver *solver, struct pcg *s, double *mean)
{
    struct pass c = {.solver = solver, .s = s};
    double total[RC_SUMS], above, share, estimate, ratio;

    *mean = 0;
    if (solver->set.size < 2)
        return 0;
    rc_reduce_rows_begin(solver);
    rc_working_set_correct(solver, corrected, &c);
    rc_reduce_rows_end(solver, total);
    if (rc_solver_hurried(solver)) /* z may be undefined */
        return s->before;
    share = total[Z] / total[LOAD];
    above = total[ZQ] - share * total[LOAD_Q];
    c.b = s->curvature > 0 && above < 0 ? -above / s->curvature : 0;
    estimate = rc_working_set_error(solver, share);
    ratio = estimate / s->before;
    if (c.b > ratio * ratio && (!isnan(solver->op->estar) || solver->set.turnover > few))
        c.b = ratio * ratio;
    if (c.b > 0) {
        rc_reduce_blocks(solver, turn_block, &c, total);
        *mean = total[0] / (double)solver->set.size;
    }
    return estimate;
}

/* Corrects the load for rounding. */
static void
restore(struct rc_solver *solver)
{
    rc_projection_restore(solver, rc_iterate_carried(solver));
}

static void
start_from_springs(struct rc_solver *solver)
{
    double least = 0, stiffness;

    for (size_t k = 0; k < solver->posed.n; k++) /* the largest height is 0 */
        least = fmin(least, solver->posed.h[k]);
    least = -rc_ranks_most(solver->posed.rows.ranks, -least);
    stiffness =
        fmin(1 / (solver->op->unit + solver->op->soft.plus),
             longest * fmin(rc_reach(&solver->posed.bounds, solver->load.sum), solver->load.sum) /
                 -least);
    for (size_t k = 0; k < solver->posed.n; k++)
        solver->it.p[k] = stiffness * solver->posed.h[k];
    rc_projection_of(solver, solver->it.p);
    restore(solver);
}

/* Finds the direction, its mean and the estimate; if the caller cannot wait, the estimate may be that of the
 * last step. An estimate below the tolerance counts only if v was computed in double precision; where the
 * last estimates predict one, v is recomputed at once. */
static void
find_direction(struct rc_solver *solver, struct pcg *s, double *mean)
{
    bool sure = solver->posed.rough || (solver->it.fresh && solver->set.whole);

    s->before = s->estimate;
    if (!sure && s->before * s->rate <= solver->load.tol) {
        renew(solver, s);
        sure = true;
    }
    if (solver->set.size > 1)
        rc_working_set_tell(solver);
    if (rc_solver_hurried(solver))
        return;
    s->estimate = precondition(solver, s, mean);
    if (solver->it.iterations == 0 && s->estimate > apart && !isinf(s->estimate)) {
        start_from_springs(solver);
        begin(solver, s);
        s->estimate = precondition(solver, s, mean);
    }
    if (!sure && (s->estimate <= solver->load.tol || s->estimate < 3 * s->drift)) {
        if (rc_solver_hurried(solver)) { /* not confirmed in double precision */
            s->estimate = isnan(s->before) ? INFINITY : s->before;
            return;
        }
        renew(solver, s);
        s->estimate = precondition(solver, s, mean);
    }
    s->rate = s->estimate < s->before ? s->estimate / s->before : 1;
}

/* ---- a clipped step along it, with one convolution of the clipped step ---- */

RC_INLINE double
farthest_in(struct rc_box box, size_t n, const double *restrict p, const float *restrict delta,
            double scale)
{
    double most = 0;

#pragma omp simd reduction(max : most)
    for (size_t k = 0; k < n; k++) {
        double e = (double)delta[k] * scale, was = p[k] - e;
        double below = was - rc_low(box, k), above = rc_high(box, k) - was;
        double part = e < 0 ? -e / below : e > 0 ? e / above : 0;
        most = part > most ? part : most;
    }
    return most;
}

/* After a move: the largest fraction of the distance to a bound that any node has covered. */
RC_CLONES static double
farthest(struct rc_box box, size_t n, const double *p, const float *delta, double scale)
{
    return box.highs == NULL ? farthest_in(rc_box_of_numbers(box), n, p, delta, scale)
                             : farthest_in(box, n, p, delta, scale);
}

static void
farthest_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;
    const struct rc_solver *s = c->solver;

    sums[RC_MOST] = farthest(rc_box(s, first), n, s->it.p + first, c->s->delta + first,
                             1 / s->load.per_pressure);
}

RC_CLONES static bool
copy(size_t n, const float *restrict from, float *restrict to)
{
    int any = 0;

#pragma omp simd reduction(| : any)
    for (size_t i = 0; i < n; i++) {
        to[i] = from[i];
        any |= from[i] != 0;
    }
    return any != 0;
}

static bool
step_in(void *at, size_t j, void *to)
{
    const struct pass *c = at;
    size_t n = c->solver->posed.shape.nx;

    return copy(n, c->s->delta + j * n, to);
}

enum {
    SLOPE,     /* delta'g                     */
    CURVATURE, /* delta'q                     */
    SQUARE,    /* q'q                         */
    GAP,       /* sum of v over the elastic nodes */
    PULL,      /* sum of q over the elastic nodes */
    ELASTIC,   /* number of elastic nodes     */
    CARRIED    /* sum of p */
};

RC_INLINE void
along_in(struct rc_box box, size_t n, const double *restrict p, const double *restrict v,
         double shift, const float *restrict delta, const float *restrict row, float *restrict q,
         double *restrict sums)
{
    double slope = 0, curvature = 0, square = 0, gap = 0, pull = 0, elastic = 0, carried = 0;

#pragma omp simd reduction(+ : slope, curvature, square, gap, pull, elastic, carried)
    for (size_t i = 0; i < n; i++) {
        double d = (double)delta[i], u = (double)row[i];
        double in = p[i] <= rc_low(box, i) ? 0 : p[i] < rc_high(box, i) ? 1 : 0;
        q[i] = row[i];
        slope += d * (v[i] - shift);
        curvature += d * u;
        square += u * u;
        gap += in * v[i];
        pull += in * u;
        elastic += in;
        carried += p[i];
    }
    sums[SLOPE] += slope;
    sums[CURVATURE] += curvature;
    sums[SQUARE] += square;
    sums[GAP] += gap;
    sums[PULL] += pull;
    sums[ELASTIC] += elastic;
    sums[CARRIED] += carried;
}

RC_CLONES static void
along(struct rc_box box, size_t n, const double *p, const double *v, double shift,
      const float *delta, const float *row, float *q, double *sums)
{
    if (box.highs == NULL)
        along_in(rc_box_of_numbers(box), n, p, v, shift, delta, row, q, sums);
    else
        along_in(box, n, p, v, shift, delta, row, q, sums);
}

/* The same for nodes outside the set that have not moved and carry no pressure. */
RC_CLONES static double
beside(size_t n, const float *restrict row, float *restrict q)
{
    double square = 0;

#pragma omp simd reduction(+ : square)
    for (size_t i = 0; i < n; i++) {
        q[i] = row[i];
        square += (double)row[i] * (double)row[i];
    }
    return square;
}

static bool
step_out(void *at, size_t j, void *from)
{
    const struct pass *c = at;
    const struct rc_solver *s = c->solver;
    size_t nx = s->posed.shape.nx;
    double *sums = rc_reduce_row(s, j);
    const float *row = from;

    for (size_t i = 0, n; i < nx; i += n) {
        size_t k = j * nx + i;
        bool in;
        n = rc_working_set_stretch(s, k, nx - i, &in);
        if (in)
            along(rc_box(s, k), n, s->it.p + k, s->it.v + k, s->it.shift, c->s->delta + k, row + i,
                  c->s->q + k, sums);
        else
            sums[SQUARE] += beside(n, row + i, c->s->q + k);
    }
    return true;
}

/* Updates v to the changed p; p took the fraction a of the step. */
static void
follow_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;

    (void)sums;
    rc_iterate_follow(n, c->s->q + first, c->a * c->solver->load.length, c->solver->it.v + first);
}

/* Takes back a fraction b of the step. A node that left a bound returns to it exactly. */
static void
back_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;
    const struct rc_box box = rc_box(c->solver, 0);
    double *p = c->solver->it.p;
    const float *delta = c->s->delta;

    (void)sums;
    for (size_t k = first; k < first + n; k++) {
        double e = (double)delta[k] / c->solver->load.per_pressure, y = p[k] - c->b * e;
        double rounding = 1e-6 * fabs(e);
        if (e == 0)
            continue;
        p[k] = rc_at_low(box, k, y - rounding)    ? rc_low(box, k)
               : rc_at_high(box, k, y + rounding) ? rc_high(box, k)
                                                  : y;
    }
}

/* A trial step. */
struct trial {
    double size; /* relative L1 norm                                             */
    double fits; /* factor by which the step can be lengthened within the bounds */
    double best; /* fraction of the step with the lowest energy; 0: none         */
    bool clipped;
    double total[RC_SUMS];
};

static void
undo(struct rc_solver *solver, struct pcg *s, double size)
{
    struct pass c = {.solver = solver, .s = s, .b = 1};
    double total[RC_SUMS];

    rc_reduce_blocks(solver, back_block, &c, total);
    restore(solver);
    s->drift += solver->op->row_error * size; /* rounding of delta */
}

/* Moves p along the direction in z with the given mean, and back into the bounds; sets delta, q and the
 * figures in *t. */
static void
attempt(struct rc_solver *solver, struct pcg *s, double alpha, double mean, bool tiles,
        struct trial *t)
{
    struct rc_move move = {.solver = solver,
                           .d = solver->z,
                           .mean = mean,
                           .delta = s->delta,
                           .tiles = s->tiles,
                           .line = &s->line,
                           .alpha = alpha / solver->load.per_pressure};
    struct pass c = {.solver = solver, .s = s};
    double best;

    if (tiles && !rc_move_tiles(&move)) {
        undo(solver, s, move.size / solver->load.sum);
        tiles = false;
    }
    if (!tiles)
        rc_move_shift(&move);
    t->clipped = move.clipped;
    t->size = move.size / solver->load.sum;
    t->fits = 1;
    if (!move.clipped) {
        rc_reduce_blocks(solver, farthest_block, &c, t->total);
        t->fits = t->total[RC_MOST] > 0 ? 1 / t->total[RC_MOST] : 1;
    }
    rc_reduce_rows_begin(solver);
    rc_operator_apply_rows(solver->op, step_in, step_out, &c);
    rc_iterate_count(solver, solver->op->row_cost);
    rc_reduce_rows_end(solver, t->total);
    best = -t->total[SLOPE] / (solver->load.length * t->total[CURVATURE]);
    t->best = t->total[CURVATURE] > 0 && best > 0 ? best : 0;
    if (cut_short(solver)) /* p is admissible: no other step is tried */
        t->best = 1;
}

/* Tries shorter and shorter steps until one is good enough; *alpha becomes its length. */
static void
make_best(struct rc_solver *solver, struct pcg *s, double *alpha, double mean, bool tiles,
          struct trial *t)
{
    attempt(solver, s, *alpha, mean, tiles, t);
    /* The step is too long. A fraction of a clipped step would leave its clipped nodes just off their bounds.
     * A shorter step that is clipped anew puts them on their bounds. */
    for (int tries = 0; tries < TRIES && t->clipped && t->best < enough; tries++) {
        undo(solver, s, t->size);
        *alpha *= fmax(t->best, 0.2);
        attempt(solver, s, *alpha, mean, tiles, t);
    }
    if (t->best == 0)
        undo(solver, s, t->size);
}

/* Updates v, the working set and the residual after that fraction of a step. */
static void
follow_step(struct rc_solver *solver, struct pcg *s, const struct trial *t, double part)
{
    struct pass c = {.solver = solver, .s = s, .a = part, .b = 1 - part};
    double total[RC_SUMS], gap = t->total[GAP] + part * solver->load.length * t->total[PULL];
    bool kept = fabs(t->total[CARRIED] - solver->load.sum) <= 1e-14 * solver->load.sum;

    s->drift += solver->op->row_error * part * sqrt(t->total[SQUARE] / (double)solver->posed.nodes);
    if (kept && part == 1 && t->total[ELASTIC] > 0) {
        rc_iterate_moved(solver, gap, t->total[ELASTIC]);
        rc_working_set_follow(solver, s->q, solver->load.length);
        settle(solver);
        return;
    }
    rc_iterate_moved(solver, 0, 0);
    rc_reduce_blocks(solver, follow_block, &c, total);
    if (part != 1)
        rc_reduce_blocks(solver, back_block, &c, total);
    restore(solver);
    rc_iterate_shift(solver);
    rc_working_set_find(solver, true);
    settle(solver);
}

/* Makes one step of p along the direction in z with the given mean, and back into the bounds, that lowers the
 * energy. Updates v, the working set and the residual. Returns the relative change of p; 0 when no length
 * lowers the energy, and p is unchanged. */
static double
advance(struct rc_solver *solver, struct pcg *s, double alpha, double mean, bool tiles)
{
    struct trial t;
    double length = alpha, part;

    make_best(solver, s, &length, mean, tiles, &t);
    if (t.best == 0 && tiles) {
        length = alpha;
        make_best(solver, s, &length, mean, false, &t);
    }
    if (t.best == 0 || !solver->it.known) {
        s->curvature = 0;
        return t.best;
    }
    part = !t.clipped ? fmin(t.best, t.fits) : t.best >= enough ? 1 : t.best;
    s->curvature = t.clipped && t.size > conjugate ? 0 : t.total[CURVATURE];
    follow_step(solver, s, &t, part);
    /* A longer prediction than 1.2 is clipped more often. Half of it takes 12 % more convolutions, and double
     * 2 % fewer on average, but 24 % more at worst (74 contacts of bench/constants.py). */
    s->alpha = fmin(fmax(length * sqrt(t.best), shortest), 1.2);
    return t.size * part;
}

/* ---- the projected-gradient step, which always lowers the energy ---- */

static void
gradient_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;
    struct rc_solver *s = c->solver;

    for (size_t k = first; k < first + n; k++) {
        float d = (float)(-(s->it.v[k] - s->it.shift) * c->a);
        s->z[k] = d;
        sums[0] += fabs((double)d);
    }
}

/* A projected-gradient step. The path to the projection descends for any `length`; 1 / |K| and the compliance
 * of a single node are used. */
static double
gradient_step(struct rc_solver *solver, struct pcg *s, double length)
{
    struct pass c = {.solver = solver, .s = s, .a = solver->load.per_pressure * length};
    double total[RC_SUMS], size, change;

    rc_reduce_blocks(solver, gradient_block, &c, total);
    rc_working_set_all(solver);
    size = total[0] / solver->load.per_pressure / solver->load.sum;
    change = advance(solver, s, size > longest ? longest / size : 1, 0, false);
    s->curvature = 0; /* the next direction is not made conjugate to it */
    if (change == 0)
        rc_working_set_find(solver, false);
    return change;
}

/* ---- the iteration ---- */

static struct rc_found
iterate(struct rc_solver *solver, struct pcg *s)
{
    struct rc_found found = {0};
    double mean = 0, alpha, short_wave = solver->op->unit + solver->op->soft.plus;
    bool still;

    if (!solver->it.known && !rc_solver_hurried(solver))
        begin(solver, s);
    if (!rc_solver_hurried(solver))
        find_direction(solver, s, &mean);
    found.estimate = s->estimate;
    if (s->estimate <= solver->load.tol)
        return found;
    if (s->estimate < 0.9 * s->best) { /* not sensitive: with half no bit of 123 contacts changes */
        s->best = s->estimate;
        s->best_at = solver->it.iterations;
    } else if (solver->it.iterations > s->best_at + PATIENCE) {
        return found; /* only rounding errors are left */
    }
    if (rc_solver_hurried(solver)) /* p and v stay */
        return (struct rc_found){.estimate = isnan(s->estimate) ? INFINITY : s->estimate,
                                 .change = 1};
    /* A clipped direction may raise the energy. If this happens repeatedly, the error is that of single nodes
     * at edges of the contact, which a step of 1 / |K| hardly moves. */
    alpha = s->estimate * s->alpha > longest ? longest / s->estimate : s->alpha;
    still = solver->it.iterations > s->best_at + 3;
    if (solver->it.iterations % SPACER == SPACER - 1)
        found.change = gradient_step(solver, s, 1 / solver->op->norm);
    else if ((found.change = advance(solver, s, alpha, mean, true)) == 0)
        found.change = gradient_step(
            solver, s,
            1 / (still && solver->it.iterations % 2 == 0 ? short_wave : solver->op->norm));
    return found;
}

/* If the caller cannot wait, the convolutions end early, and v is unknown where p has changed. */
static struct rc_found
step(struct rc_solver *solver, void *at)
{
    struct rc_found found;

    rc_fft_hurry = solver->posed.hurry;
    found = iterate(solver, at);
    rc_fft_hurry = NULL;
    if (rc_solver_hurried(solver))
        rc_working_set_forget(solver); /* the preconditioner may be undefined */
    if (!solver->it.known)
        found = (struct rc_found){.estimate = INFINITY, .change = 1};
    return found;
}

/* Fit to bench-solve, 512^2 to 2048^2, 1 to 99 % contact: the number does not depend on the grid size. */
static double
convolutions(double nodes, double digits)
{
    (void)nodes;
    return 6.5 + 1.1 * fmax(digits - 4, -2);
}

const struct rc_method rc_method_pcg = {
    .info = {.name = "pcg",
             .summary = "projected conjugate gradients with the extension preconditioner",
             .mixed = true},
    .nested = true,
    .convolutions = convolutions,
    .new = state_new,
    .step = step,
    .forget = forget,
    .lasting = lasting,
};
