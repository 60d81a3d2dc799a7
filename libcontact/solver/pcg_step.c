/*
 * The step of the method pcg: along a direction, clipped, with one convolution of what was left of
 * it.
 */
#include "pcg.h"

#include <math.h>

enum {
    TRIES = 4 /* to shorten a step */
};
/* How near the lowest point may be for a clipped step to be taken whole: nodes then come to rest
 * at their bounds. With the lowest point at a part s of the way, the whole of it still gains (2
 * s - 1)/s^2 of what could be gained. */
static const double enough = 0.75;

enum { /* sums of a move */
    SIZE,
    CARRIED
};

/* W moves by rc_move, the others stay; where nothing is clipped, how much of it fits into the box. */
RC_CLONES static void
move_by(size_t n, double *restrict p, const unsigned char *restrict w, const float *restrict d,
        double hardness, double alpha, double mean, double shift, double scale,
        float *restrict delta, double *sums)
{
    double size = 0, carried = 0;

#pragma omp simd reduction(+ : size, carried)
    for (size_t k = 0; k < n; k++) {
        double e = (double)d[k], y = p[k] + shift + (e != 0 ? alpha * (e - mean) : 0), change;
        y = y > 0 ? y : 0;
        y = y < hardness ? y : hardness;
        y = w[k] ? y : p[k];
        change = y - p[k];
        p[k] = y;
        delta[k] = (float)(change * scale);
        size += fabs(change);
        carried += y;
    }
    sums[SIZE] = size;
    sums[CARRIED] = carried;
}

/* After a move: the largest part of the way to a bound that any node has gone. */
RC_CLONES static double
farthest(size_t n, const double *restrict p, const float *restrict delta, double hardness,
         double scale)
{
    double most = 0;

#pragma omp simd reduction(max : most)
    for (size_t k = 0; k < n; k++) {
        double e = (double)delta[k] * scale, was = p[k] - e;
        double part = e < 0 ? -e / was : e > 0 ? e / (hardness - was) : 0;
        most = part > most ? part : most;
    }
    return most;
}

static void
move_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_pcg_pass *c = at;
    struct rc_solver *s = c->solver;
    const struct rc_move *m = c->move;
    float *delta = c->s->delta + first;

    move_by(n, s->p + first, s->w + first, m->d + first, s->hardness, m->alpha, m->mean, m->shift,
            s->per_pressure, delta, sums);
    if (!m->clipped)
        sums[RC_MOST] = farthest(n, s->p + first, delta, s->hardness, 1 / s->per_pressure);
}

static bool
step_in(void *at, size_t j, void *to)
{
    const struct rc_pcg_pass *c = at;
    size_t n = c->solver->shape.nx;
    const float *delta = c->s->delta + j * n;
    float *row = to;
    bool any = false;

    for (size_t i = 0; i < n; i++) {
        row[i] = delta[i];
        any |= delta[i] != 0;
    }
    return any;
}

enum {
    SLOPE,     /* delta'g                                  */
    CURVATURE, /* delta'q                                  */
    GAP,       /* v after the whole step on elastic nodes  */
    ELASTIC,
    SQUARE /* q'q                                      */
};

RC_CLONES static void
along(size_t n, const double *restrict p, const double *restrict v, double hardness, double shift,
      double length, const float *delta, const float *row, float *q, double *sums)
{
    double slope = 0, curvature = 0, gap = 0, elastic = 0, square = 0;

#pragma omp simd reduction(+ : slope, curvature, gap, elastic, square)
    for (size_t i = 0; i < n; i++) {
        double d = (double)delta[i], u = (double)row[i];
        bool in = (p[i] > 0) & (p[i] < hardness);
        q[i] = row[i];
        slope += d * (v[i] - shift);
        curvature += d * u;
        square += u * u;
        gap += in ? v[i] + length * u : 0;
        elastic += in ? 1 : 0;
    }
    sums[SLOPE] = slope;
    sums[CURVATURE] = curvature;
    sums[GAP] = gap;
    sums[ELASTIC] = elastic;
    sums[SQUARE] = square;
}

static bool
step_out(void *at, size_t j, void *from)
{
    const struct rc_pcg_pass *c = at;
    const struct rc_solver *s = c->solver;
    size_t n = s->shape.nx, k = j * n;

    along(n, s->p + k, s->v + k, s->hardness, s->shift, s->length, c->s->delta + k, from,
          c->s->q + k, rc_row_sums(s, j));
    return true;
}

RC_CLONES static void
follow(size_t n, const float *restrict q, double factor, double *restrict v)
{
    for (size_t k = 0; k < n; k++)
        v[k] += factor * (double)q[k];
}

/* v goes along with p: a is how much of the step. */
static void
follow_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_pcg_pass *c = at;

    (void)sums;
    follow(n, c->s->q + first, c->a * c->solver->length, c->solver->v + first);
}

/* Takes p back by b of the step; what rounding leaves of a node that came from a bound is nothing. */
static void
back_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_pcg_pass *c = at;
    double hardness = c->solver->hardness, *p = c->solver->p;
    const float *delta = c->s->delta;

    (void)sums;
    for (size_t k = first; k < first + n; k++) {
        double e = (double)delta[k] / c->solver->per_pressure, y = p[k] - c->b * e;
        double rounding = 1e-6 * fabs(e);
        if (e == 0)
            continue;
        p[k] = y <= rounding ? 0 : y >= hardness - rounding ? hardness : y;
    }
}

/* p carries `sum`. */
void
rc_pcg_balance(struct rc_solver *solver, double sum)
{
    /* should memory be short, a little of the load is missing, and the result says so */
    if (fabs(sum - solver->sum) > 1e-14 * solver->sum)
        (void)rc_box_balance(solver->n, solver->hardness, solver->sum, solver->v, solver->p, NULL);
}

/* What a trial step found. */
struct trial {
    double size;    /* relative L1 norm                                            */
    double carried; /* the sum of p after it                                       */
    double room;    /* how much of it fits into the box: 1 or, not clipped, more   */
    double best;    /* how much of it leads to the lowest energy; 0: nowhere       */
    bool clipped;
    double total[RC_SUMS];
};

/* p goes along the direction in z, of that mean, back into the box; delta, q and what they say. */
static void
attempt(struct rc_solver *solver, struct rc_pcg *s, double alpha, double mean, struct trial *t)
{
    struct rc_move move = {.solver = solver,
                           .d = solver->z,
                           .mean = mean,
                           .room = s->room,
                           .alpha = alpha / solver->per_pressure};
    struct rc_pcg_pass c = {.solver = solver, .s = s, .move = &move};
    double best;

    rc_move_find(&move);
    rc_solver_blocks(solver, move_block, &c, t->total);
    t->clipped = move.clipped;
    t->size = t->total[SIZE] / solver->sum;
    t->carried = t->total[CARRIED];
    t->room = move.clipped || !(t->total[RC_MOST] > 0) ? 1 : 1 / t->total[RC_MOST];
    rc_solver_rows_begin(solver);
    rc_pcg_convolve(&c, step_in, step_out);
    rc_solver_rows_end(solver, t->total);
    best = -t->total[SLOPE] / (solver->length * t->total[CURVATURE]);
    t->best = t->total[CURVATURE] > 0 && best > 0 ? best : 0;
}

static void
undo(struct rc_solver *solver, struct rc_pcg *s, const struct trial *t)
{
    struct rc_pcg_pass c = {.solver = solver, .s = s, .b = 1};
    double total[RC_SUMS];

    rc_solver_blocks(solver, back_block, &c, total);
    rc_pcg_balance(solver, rc_solver_carried(solver));
    s->drift += rc_pcg_single * t->size; /* delta was rounded */
}

/* From p along the direction in z, of that mean, back into the box, to where the energy is low.
 * False when that leads nowhere; p is then where it was. */
bool
rc_pcg_advance(struct rc_solver *solver, struct rc_pcg *s, double alpha, double mean)
{
    struct rc_pcg_pass c = {.solver = solver, .s = s};
    struct trial t;
    double total[RC_SUMS], part;

    attempt(solver, s, alpha, mean, &t);
    /* too far: a part of a clipped step would leave nodes just off their bounds, one after another;
     * a shorter step, clipped anew, brings them to rest */
    for (int tries = 0; tries < TRIES && t.clipped && t.best < enough; tries++) {
        undo(solver, s, &t);
        alpha *= fmax(t.best, 0.2);
        attempt(solver, s, alpha, mean, &t);
    }
    if (t.best == 0) {
        undo(solver, s, &t);
        s->curvature = 0;
        return false;
    }
    part = !t.clipped ? fmin(t.best, t.room) : t.best >= enough ? 1 : t.best;
    c.a = part;
    c.b = 1 - part;
    s->curvature = t.clipped ? 0 : t.total[CURVATURE];
    s->drift += rc_pcg_single * part * sqrt(t.total[SQUARE] / (double)solver->n);
    solver->change = t.size * part;
    solver->fresh = false;
    if (part == 1) {
        solver->elastic = (size_t)t.total[ELASTIC];
        if (solver->elastic > 0)
            solver->shift = t.total[GAP] / t.total[ELASTIC];
    }
    rc_solver_blocks(solver, follow_block, &c, total);
    if (part != 1) {
        rc_solver_blocks(solver, back_block, &c, total);
        t.carried = rc_solver_carried(solver);
    }
    rc_pcg_balance(solver, t.carried);
    if (part != 1 || solver->elastic == 0)
        rc_solver_shift(solver);
    rc_solver_residual(solver, true);
    s->alpha = fmin(fmax(alpha * sqrt(t.best), 0.3), 1.2);
    return true;
}
