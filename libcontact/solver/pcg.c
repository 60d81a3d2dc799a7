/*
 * Projected conjugate gradients with the extension preconditioner (extension.h).
 *
 * Working set W: the elastic nodes and those at a bound that want to leave it, but for those that
 * would only be pushed back (joining.c). Residual r = -g on W with zero mean, z = E' A E r with
 * zero mean, direction z + beta delta conjugate to the last step delta unless that was clipped;
 * restarted when beta is negative; components that point out of the box are dropped. The step is
 * projected onto {0 <= p <= H, sum p = S} by one shift of the nodes of W (project.c). Scaling
 * instead, as in (31b) of Polonsky and Keer, fails near saturation; shifting all nodes drags every
 * separated one into contact.
 *
 * Its length is foretold from the steps before, so that the one convolution K delta of the step as
 * it was clipped serves all: the new gap, the change of the energy, which is a quadratic along
 * delta and known exactly, and the conjugacy of the next direction. A clipped step that is too long
 * for the energy is made anew, shorter; an unclipped one goes to its lowest point. So no step
 * raises the energy. Where delta leads nowhere, and every SPACER steps, a projected-gradient step
 * is made instead. By the spacer-step theorem (Luenberger and Ye, Linear and Nonlinear Programming)
 * the whole then converges to the one minimum.
 *
 * ||z||_1 / ||p||_1 estimates the error of the pressure and costs nothing here: z is at hand.
 *
 * Where the engine is the Fourier one, K delta is summed in single precision: its error is relative
 * to delta, which shrinks. The sum of what that may have spoilt is kept, and v is renewed in double
 * precision before it matters, and always before the estimate is believed.
 */
#include "pcg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "nested.h"
#include "libcontact/memory.h"

enum {
    SPACER = 30,  /* steps after which one is a projected-gradient step                  */
    PATIENCE = 40 /* steps without a better estimate, one of them a spacer, after which
                     rounding has the word                                            */
};
/* No step is longer than this, over the load: what the nodes that stay carry would be lost in
 * the rounding of the way there. Only heights beside which the displacement is nothing ask for
 * more. */
static const double longest = 1e6;

static void
state_free(void *at)
{
    struct rc_pcg *s = at;

    if (s == NULL)
        return;
    free(s->room);
    free(s->wide);
    free(s);
}

static void *
state_new(struct rc_solver *solver, struct rc_err *err)
{
    struct rc_pcg *s = calloc(1, sizeof *s);
    bool single = solver->conv == NULL || strcmp(rc_conv_engine(solver->conv), "fft") == 0;

    if (s != NULL) {
        s->room = rc_alloc(solver->n, sizeof *s->room);
        s->wide = single ? NULL : rc_alloc(2 * solver->n, sizeof *s->wide);
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
    s->rate = 1;
    rc_nested_start(solver);
    return s;
}

/* ---- the step that is sure ---- */

static void
gradient_block(void *at, size_t first, size_t n, double *sums)
{
    const struct rc_pcg_pass *c = at;
    struct rc_solver *s = c->solver;

    for (size_t k = first; k < first + n; k++) {
        float d = (float)(-(s->v[k] - s->shift) * c->a);
        s->z[k] = d;
        s->w[k] = 1;
        sums[0] += fabs((double)d);
    }
}

/* Descends at any `length`, for the way to a projection always does: 1 / |K|, or that of a
 * single node. */
static bool
gradient_step(struct rc_solver *solver, struct rc_pcg *s, double length)
{
    struct rc_pcg_pass c = {.solver = solver, .s = s, .a = solver->per_pressure * length};
    double total[RC_SUMS], size;
    bool better;

    rc_solver_blocks(solver, gradient_block, &c, total);
    rc_solver_forget(solver);
    size = total[0] / solver->per_pressure / solver->sum;
    better = rc_pcg_advance(solver, s, size > longest ? longest / size : 1, 0);
    s->curvature = 0; /* not a direction to be conjugate to */
    if (!better)
        rc_solver_residual(solver, false);
    return better;
}

/* Where the start is that far off, heights are so large beside the displacement that nodes
 * decide nearly alone whether they touch, or yield: as springs, each of the stiffness of its own
 * cell. */
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
    rc_pcg_balance(solver, rc_solver_carried(solver));
}

/* The first v, in single precision where that will do. */
static void
begin(struct rc_solver *solver, struct rc_pcg *s)
{
    rc_pcg_begin(solver, s);
    rc_solver_shift(solver);
    rc_solver_residual(solver, true);
}

/* v in double precision, and all of the working set: what is estimated from that is believed. */
static void
renew(struct rc_solver *solver, struct rc_pcg *s)
{
    rc_solver_displace(solver);
    s->drift = 0;
    rc_solver_shift(solver);
    rc_solver_residual(solver, false);
}

/* The direction, its mean, and an estimate that may be believed where it is small enough. Where
 * that is foreseen, the one that would only say so is spared. */
static void
look(struct rc_solver *solver, struct rc_pcg *s, double *mean)
{
    double before = solver->estimate;
    bool sure = solver->rough || solver->fresh;

    if (!sure && before * s->rate <= solver->tol) {
        renew(solver, s);
        sure = true;
    }
    solver->estimate = rc_pcg_precondition(solver, s, mean);
    if (solver->iterations == 0 && solver->estimate > apart && !isinf(solver->estimate)) {
        start_from_springs(solver);
        begin(solver, s);
        solver->estimate = rc_pcg_precondition(solver, s, mean);
    }
    if (!sure && (solver->estimate <= solver->tol || solver->estimate < 3 * s->drift)) {
        renew(solver, s);
        solver->estimate = rc_pcg_precondition(solver, s, mean);
    }
    s->rate = solver->estimate < before ? solver->estimate / before : 1;
}

static void
step(struct rc_solver *solver, void *at)
{
    struct rc_pcg *s = at;
    double mean = 0, alpha;
    bool still;

    if (!solver->known)
        begin(solver, s);
    solver->change = 0;
    look(solver, s, &mean);
    if (solver->estimate <= solver->tol)
        return;
    if (solver->estimate < 0.9 * s->best) {
        s->best = solver->estimate;
        s->best_at = solver->iterations;
    } else if (solver->iterations > s->best_at + PATIENCE) {
        return; /* rounding: it stands still */
    }
    alpha = solver->estimate * s->alpha > longest ? longest / solver->estimate : s->alpha;
    /* A direction cut at the bounds need not descend. Where that happens again and again, what
     * is wrong is at single nodes at the edges of contact, where a step of 1 / |K| does nothing. */
    still = solver->iterations > s->best_at + 3;
    if (solver->iterations % SPACER == SPACER - 1)
        (void)gradient_step(solver, s, 1 / rc_safeguard_norm(solver));
    else if (!rc_pcg_advance(solver, s, alpha, mean))
        (void)gradient_step(solver, s,
                            still && solver->iterations % 2 == 0
                                ? solver->estar / sqrt(solver->cell)
                                : 1 / rc_safeguard_norm(solver));
}

static void
again(void *at)
{
    struct rc_pcg *s = at;

    s->curvature = 0;
    s->best = INFINITY;
    s->best_at = 0;
    s->rate = 1;
}

/* As bench-solve found them at 512^2 to 2048^2, 1 to 99 % contact: the grid does not matter. */
static double
convolutions(double nodes, double digits)
{
    (void)nodes;
    return 16 + 2.3 * fmax(digits - 4, -2);
}

const struct rc_method rc_method_pcg = {
    .info = {.name = "pcg",
             .summary = "projected conjugate gradients with the extension preconditioner",
             .mixed = true},
    .convolutions = convolutions,
    .new = state_new,
    .step = step,
    .again = again,
    .free = state_free,
};
