/*
 * Projected conjugate gradients with the extension preconditioner (extension.h).
 *
 * Working set W: the elastic nodes and those at a bound that want to leave it. Residual r = -g on W
 * with zero mean, z = E' A E r with zero mean, direction z + beta delta conjugate to the last step
 * delta, whatever the way that was clipped; restarted when beta is negative; components that point
 * out of the box are dropped. The step is projected onto {0 <= p <= H, sum p = S} by one shift of the
 * nodes of W (project.c). Scaling instead, as in (31b) of Polonsky and Keer, fails near saturation;
 * shifting all nodes drags every separated one into contact.
 *
 * Its length is foretold from the steps before, so that the one convolution K delta of the step as it
 * was clipped serves all: the new gap, the change of the energy, which is a quadratic along delta and
 * known exactly, and the conjugacy of the next direction. A step that is too long for the
 * energy is shortened to its lowest point; an unclipped one always goes there. So no step raises
 * the energy. Where delta leads nowhere, and every SPACER steps, a projected-gradient step is made
 * instead. By the spacer-step theorem (Luenberger and Ye, Linear and Nonlinear Programming) the whole then
 * converges to the one minimum.
 *
 * ||z||_1 / ||p||_1 estimates the error of the pressure and costs nothing here: z is at hand.
 *
 * Where the engine is the Fourier one, K delta is summed in single precision: its error is relative to
 * delta, which shrinks. The sum of what that may have spoilt is kept, and v is renewed in double
 * precision before it matters, and always before the estimate is believed.
 */
#include "solver.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "nested.h"
#include "room.h"

enum {
    SPACER = 30,  /* steps after which one is a projected-gradient step                  */
    TRIES = 4,    /* to shorten a step                                                   */
    PATIENCE = 40 /* steps without a better estimate, one of them a spacer, after which
                     rounding has the word                                            */
};
/* Relative error of a convolution in single precision, and what a pressure needs of it: the inverse
 * of the kernel's highest symbol is about pi/2. Measured at 1024 x 1024: 1e-5 for |u| of 50. */
static const double single_epsilon = 2e-7;
/* How near the lowest point may be for a clipped step to be taken whole: nodes then come to rest at their
 * bounds. With the lowest point at a part s of the way, the whole of it still gains (2 s - 1)/s^2 of what could
 * be gained. */
static const double enough = 0.6;
/* No step is longer than this, over the load: what the nodes that stay carry would be lost in the rounding of the
 * way there. Only heights beside which the displacement is nothing ask for more. */
static const double longest = 1e6;

struct state {
    double *room;     /* 2n floats; between two steps n numbers of scratch                */
    float *delta, *q; /* the last step and K times it, in the units of single precision   */
    double curvature; /* delta'q; 0: the next direction is not conjugate to anything      */
    double alpha;     /* length foretold for the next step                                */
    double drift;     /* what single precision may have done to p, relative               */
    double best;      /* least estimate                                                   */
    size_t best_at;
    double *wide;     /* 2n: a step and its displacement for engines that know only double */
};

static void
state_free(void *at)
{
    struct state *s = at;

    if (s == NULL)
        return;
    free(s->room);
    free(s->wide);
    free(s);
}

static void *
state_new(struct rc_solver *solver, struct rc_err *err)
{
    struct state *s = calloc(1, sizeof *s);
    bool single = solver->conv == NULL || strcmp(rc_conv_engine(solver->conv), "fft") == 0;

    if (s != NULL) {
        s->room = rc_room(solver->n, sizeof *s->room);
        s->wide = single ? NULL : rc_room(2 * solver->n, sizeof *s->wide);
    }
    if (s == NULL || s->room == NULL || (!single && s->wide == NULL)) {
        rc_err_set(err, "out of memory for the iteration of %zu nodes", solver->n);
        state_free(s);
        return NULL;
    }
    s->delta = (float *)s->room;
    s->q = s->delta + solver->n;
    s->alpha = 0.9;
    s->best = INFINITY;
    rc_nested_start(solver);
    return s;
}

/* What the passes share. */
struct pass {
    struct rc_solver *solver;
    struct state *s;
    double a, b;
    struct rc_move *move;
};

/* ---- K p and K delta ---- */

/* K of the pressures that `in` writes, row by row in single precision, to `out`. */
static void
convolve(struct pass *c, rc_row *in, rc_row *out)
{
    struct rc_solver *solver = c->solver;
    size_t nx = solver->shape.nx, ny = solver->shape.ny;
    double *p = c->s->wide, *u = p + solver->n, unit = solver->length * solver->per_pressure;

    if (p == NULL) {
        rc_extension_displace(solver->extension, in, out, c);
        solver->convolutions += 0.5;
        return;
    }
#pragma omp parallel for num_threads(solver->threads) schedule(static)
    for (size_t j = 0; j < ny; j++) {
        float *row = c->s->q + j * nx;
        bool any = in(c, j, row);
        for (size_t i = 0; i < nx; i++)
            p[j * nx + i] = any ? (double)row[i] : 0;
    }
    rc_conv_apply(solver->conv, p, u);
    solver->convolutions++;
#pragma omp parallel for num_threads(solver->threads) schedule(static)
    for (size_t j = 0; j < ny; j++) {
        float *row = c->s->q + j * nx;
        for (size_t i = 0; i < nx; i++)
            row[i] = (float)(u[j * nx + i] / unit);
        out(c, j, row);
    }
}

static bool
pressure_in(void *at, size_t j, void *to)
{
    const struct rc_solver *s = ((struct pass *)at)->solver;
    size_t n = s->shape.nx;
    const double *p = s->p + j * n;
    float *row = to;
    bool any = false;

    for (size_t i = 0; i < n; i++) {
        row[i] = (float)(p[i] * s->per_pressure);
        any |= p[i] > 0;
    }
    return any;
}

static bool
gap_out(void *at, size_t j, void *from)
{
    const struct rc_solver *s = ((struct pass *)at)->solver;
    size_t n = s->shape.nx;
    const float *row = from;
    const double *h = s->h + j * n;
    double *v = s->v + j * n, sum = 0;

    for (size_t i = 0; i < n; i++) {
        double u = (double)row[i];
        v[i] = u * s->length - h[i];
        sum += u * u;
    }
    rc_row_sums(s, j)[0] = sum;
    return true;
}

/* The first v of a grid; single precision will do for a while. */
static void
begin(struct rc_solver *solver, struct state *s)
{
    struct pass c = {.solver = solver, .s = s};
    double total[RC_SUMS];

    if (s->wide != NULL) {
        rc_solver_displace(solver);
        return;
    }
    rc_solver_rows_begin(solver);
    convolve(&c, pressure_in, gap_out);
    rc_solver_rows_end(solver, total);
    s->drift = single_epsilon * sqrt(total[0] / (double)solver->n);
    solver->known = true;
    solver->fresh = false;
}

/* ---- direction ---- */

enum { /* sums of z */
    Z,
    ZQ,
    Q
};

static bool
correction_done(void *at, size_t j, void *row)
{
    const struct pass *c = at;
    size_t n = c->solver->shape.nx;
    const float *z = c->solver->z + j * n, *q = c->s->q + j * n;
    const unsigned char *w = c->solver->w + j * n;
    double sum = 0, product = 0, other = 0;

    (void)row;
    if (c->s->curvature > 0) {
#pragma omp simd reduction(+ : sum, product, other)
        for (size_t i = 0; i < n; i++) {
            double a = (double)z[i], b = (double)q[i];
            sum += a;
            product += a * b;
            other += w[i] ? b : 0;
        }
    } else {
#pragma omp simd reduction(+ : sum)
        for (size_t i = 0; i < n; i++)
            sum += (double)z[i];
    }
    rc_row_sums(c->solver, j)[Z] = sum;
    rc_row_sums(c->solver, j)[ZQ] = product;
    rc_row_sums(c->solver, j)[Q] = other;
    return true;
}

/* z becomes the direction: a is the mean of z, b beta. */
RC_CLONES static void
direct(size_t n, const double *restrict p, double hardness, const unsigned char *restrict w,
       const float *restrict delta, float mean, float beta, float *restrict z, double *sums)
{
    double size = 0, sum = 0;
    int kept = 0;

#pragma omp simd reduction(+ : size, sum, kept)
    for (size_t k = 0; k < n; k++) {
        float e = z[k] - mean, d = e + (beta != 0 ? beta * delta[k] : 0);
        bool out = ((p[k] <= 0) & (d < 0)) | ((p[k] >= hardness) & (d > 0)) | (w[k] == 0);
        size += w[k] ? (double)fabsf(e) : 0;
        d = out ? 0 : d;
        z[k] = d;
        sum += (double)d;
        kept += d != 0;
    }
    sums[0] = size;
    sums[1] = sum;
    sums[2] = kept;
}

static void
direct_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;
    const struct rc_solver *s = c->solver;

    direct(n, s->p + first, s->hardness, s->w + first, c->s->delta + first, (float)c->a,
           (float)c->b, s->z + first, sums);
}

/* Direction and its mean, and the estimate of the error of p. */
static double
precondition(struct rc_solver *solver, struct state *s, double *mean)
{
    struct pass c = {.solver = solver, .s = s};
    double total[RC_SUMS], above;

    if (solver->working < 2)
        return 0;
    rc_solver_rows_begin(solver);
    rc_solver_correct(solver, correction_done, &c);
    rc_solver_rows_end(solver, total);
    c.a = total[Z] / (double)solver->working;
    above = total[ZQ] - c.a * total[Q];
    c.b = s->curvature > 0 && above < 0 ? -above / s->curvature : 0;
    rc_solver_blocks(solver, direct_block, &c, total);
    *mean = total[2] > 0 ? total[1] / total[2] : 0;
    if (solver->elastic == 0 && solver->working > 0)
        return INFINITY; /* some want to move, but no gap says how far */
    return total[0] / solver->per_pressure / solver->sum;
}

/* ---- step ---- */

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
    const struct pass *c = at;
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
    const struct pass *c = at;
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
    SQUARE     /* q'q                                      */
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
    const struct pass *c = at;
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
    const struct pass *c = at;

    (void)sums;
    follow(n, c->s->q + first, c->a * c->solver->length, c->solver->v + first);
}

/* Takes p back by b of the step; what rounding leaves of a node that came from a bound is nothing. */
static void
back_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;
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
static void
balance(struct rc_solver *solver, double sum)
{
    /* should memory be short, a little of the load is missing, and the result says so */
    if (fabs(sum - solver->sum) > 1e-14 * solver->sum)
        (void)rc_box_balance(solver->n, solver->hardness, solver->sum, solver->v, solver->p, NULL);
}

/* What a trial step found. */
struct trial {
    double size;      /* relative L1 norm                                            */
    double carried;   /* the sum of p after it                                       */
    double room;      /* how much of it fits into the box: 1 or, not clipped, more   */
    double best;      /* how much of it leads to the lowest energy; 0: nowhere       */
    bool clipped;
    double total[RC_SUMS];
};

/* p goes along the direction in z, of that mean, back into the box; delta, q and what they say. */
static void
attempt(struct rc_solver *solver, struct state *s, double alpha, double mean, struct trial *t)
{
    struct rc_move move = {.solver = solver, .d = solver->z, .mean = mean, .room = s->room,
                           .alpha = alpha / solver->per_pressure};
    struct pass c = {.solver = solver, .s = s, .move = &move};
    double best;

    rc_move_find(&move);
    rc_solver_blocks(solver, move_block, &c, t->total);
    t->clipped = move.clipped;
    t->size = t->total[SIZE] / solver->sum;
    t->carried = t->total[CARRIED];
    t->room = move.clipped || !(t->total[RC_MOST] > 0) ? 1 : 1 / t->total[RC_MOST];
    rc_solver_rows_begin(solver);
    convolve(&c, step_in, step_out);
    rc_solver_rows_end(solver, t->total);
    best = -t->total[SLOPE] / (solver->length * t->total[CURVATURE]);
    t->best = t->total[CURVATURE] > 0 && best > 0 ? best : 0;
}

static void
undo(struct rc_solver *solver, struct state *s, const struct trial *t)
{
    struct pass c = {.solver = solver, .s = s, .b = 1};
    double total[RC_SUMS];

    rc_solver_blocks(solver, back_block, &c, total);
    balance(solver, rc_solver_carried(solver));
    s->drift += single_epsilon * t->size; /* delta was rounded */
}

/* From p along the direction in z, of that mean, back into the box, to where the energy is low. False
 * when that leads nowhere; p is then where it was. */
static bool
advance(struct rc_solver *solver, struct state *s, double alpha, double mean)
{
    struct pass c = {.solver = solver, .s = s};
    struct trial t;
    double total[RC_SUMS], part;

    attempt(solver, s, alpha, mean, &t);
    /* too far: a part of a clipped step would leave nodes just off their bounds, one after another;
     * a shorter step, clipped anew, brings them to rest */
    for (int tries = 0; tries < TRIES && t.clipped && t.best < enough; tries++) {
        undo(solver, s, &t);
        alpha *= fmin(fmax(t.best, 0.2), 0.5);
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
    s->drift += single_epsilon * part * sqrt(t.total[SQUARE] / (double)solver->n);
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
    balance(solver, t.carried);
    if (part != 1 || solver->elastic == 0)
        rc_solver_shift(solver);
    rc_solver_residual(solver);
    s->alpha = fmin(fmax(alpha * sqrt(t.best), 0.3), 1.2);
    return true;
}

/* ---- the step that is sure ---- */

static void
gradient_block(void *at, size_t first, size_t n, double *sums)
{
    const struct pass *c = at;
    struct rc_solver *s = c->solver;

    for (size_t k = first; k < first + n; k++) {
        float d = (float)(-(s->v[k] - s->shift) * c->a);
        s->z[k] = d;
        s->w[k] = 1;
        sums[0] += fabs((double)d);
    }
}

/* Descends at any `length`, for the way to a projection always does: 1 / |K|, or that of a single node. */
static bool
gradient_step(struct rc_solver *solver, struct state *s, double length)
{
    struct pass c = {.solver = solver, .s = s, .a = solver->per_pressure * length};
    double total[RC_SUMS], size;
    bool better;

    rc_solver_blocks(solver, gradient_block, &c, total);
    rc_solver_forget(solver);
    size = total[0] / solver->per_pressure / solver->sum;
    better = advance(solver, s, size > longest ? longest / size : 1, 0);
    s->curvature = 0; /* not a direction to be conjugate to */
    if (!better)
        rc_solver_residual(solver);
    return better;
}

/* Where the start is that far off, heights are so large beside the displacement that nodes decide nearly alone whether
 * they touch, or yield: as springs, each of the stiffness of its own cell. */
static const double apart = 100;

static void
start_from_springs(struct rc_solver *solver)
{
    double least = 0, stiffness;

    for (size_t k = 0; k < solver->n; k++) /* the highest is 0 */
        least = fmin(least, solver->h[k]);
    stiffness = fmin(solver->estar / sqrt(solver->cell),
                     longest * fmin(solver->hardness, solver->sum) / -least);
    for (size_t k = 0; k < solver->n; k++)
        solver->p[k] = stiffness * solver->h[k];
    rc_box_project(solver->n, NULL, solver->hardness, solver->sum, solver->p);
    balance(solver, rc_solver_carried(solver));
}

static void
step(struct rc_solver *solver, void *at)
{
    struct state *s = at;
    double mean = 0, alpha;
    bool still;

    if (!solver->known) {
        begin(solver, s);
        rc_solver_shift(solver);
        rc_solver_residual(solver);
    }
    solver->change = 0;
    solver->estimate = precondition(solver, s, &mean);
    if (solver->iterations == 0 && solver->estimate > apart && !isinf(solver->estimate)) {
        start_from_springs(solver);
        begin(solver, s);
        rc_solver_shift(solver);
        rc_solver_residual(solver);
        solver->estimate = precondition(solver, s, &mean);
    }
    if (!solver->fresh && !solver->rough &&
        (solver->estimate <= solver->tol || solver->estimate < 3 * s->drift)) {
        rc_solver_displace(solver);
        s->drift = 0;
        rc_solver_shift(solver);
        rc_solver_residual(solver);
        solver->estimate = precondition(solver, s, &mean);
    }
    if (solver->estimate <= solver->tol)
        return;
    if (solver->estimate < 0.9 * s->best) {
        s->best = solver->estimate;
        s->best_at = solver->iterations;
    } else if (solver->iterations > s->best_at + PATIENCE) {
        return; /* rounding: it stands still */
    }
    alpha = solver->estimate * s->alpha > longest ? longest / solver->estimate : s->alpha;
    /* A direction cut at the bounds need not descend. Where that happens again and again, what is wrong is at
     * single nodes at the edges of contact, where a step of 1 / |K| does nothing. */
    still = solver->iterations > s->best_at + 3;
    if (solver->iterations % SPACER == SPACER - 1)
        (void)gradient_step(solver, s, 1 / rc_guard_norm(solver));
    else if (!advance(solver, s, alpha, mean))
        (void)gradient_step(solver, s, still && solver->iterations % 2 == 0
                                           ? solver->estar / sqrt(solver->cell)
                                           : 1 / rc_guard_norm(solver));
}

static void
again(void *at)
{
    struct state *s = at;

    s->curvature = 0;
    s->best = INFINITY;
    s->best_at = 0;
}

const struct rc_method rc_method_pcg = {
    .name = "pcg",
    .summary = "projected conjugate gradients with the extension preconditioner",
    .new = state_new,
    .step = step,
    .again = again,
    .free = state_free,
};
