/*
 * The stiffness: the load that one unit of approach adds while a set of nodes moves together, no
 * node changing sides. With t the pressure that displaces all of them by one unit, K_WW t = 1, it
 * is the sum of t. The equation is solved by conjugate gradients with the preconditioner of the
 * contact. The sum is stationary at the solution, so its relative error is the square of that of t,
 * and single precision is enough.
 *
 * For d load / d approach the set is that of the elastic nodes: one at its upper bound carries no
 * more. For the conductance it is that of all nodes in contact: the potential at the surface of a
 * conductor is that of the current as the displacement is that of the pressure (Barber 2003), and
 * it is one number wherever the bodies touch. Any t then gives a bound, (sum t)^2 / t'K t <= S, by
 * Schwarz's inequality in the scalar product of K.
 */
#include "solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    STEPS = 60
};
static const double enough = 1e-4; /* of the energy norm: 1e-8 of the sum */

struct system {
    struct rc_solver *s;
    float *t, *d, *q; /* solution, direction, K d on W */
    double a;
};

static bool
direction_in(void *at, size_t j, void *to)
{
    const struct system *c = at;
    size_t n = c->s->posed.shape.nx;
    const float *d = c->d + j * n;
    bool any = false;

    memcpy(to, d, n * sizeof *d);
    for (size_t i = 0; i < n; i++)
        any |= d[i] != 0;
    return any;
}

static bool
displaced(void *at, size_t j, void *from)
{
    const struct system *c = at;
    size_t n = c->s->posed.shape.nx;
    const float *row = from, *d = c->d + j * n;
    const unsigned char *w = c->s->set.w + j * n;
    float *q = c->q + j * n;
    double sum = 0;

    for (size_t i = 0; i < n; i++) {
        q[i] = w[i] ? row[i] : 0;
        sum += (double)d[i] * (double)q[i];
    }
    rc_reduce_row(c->s, j)[0] = sum;
    return true;
}

/* t and r along d: a is the length. */
static void
move_block(void *at, size_t first, size_t n, double *sums)
{
    const struct system *c = at;

    (void)sums;
    for (size_t k = first; k < first + n; k++) {
        c->t[k] += (float)(c->a * (double)c->d[k]);
        c->s->set.r[k] -= (float)(c->a * (double)c->q[k]);
    }
}

static void
product_block(void *at, size_t first, size_t n, double *sums)
{
    const struct system *c = at;

    for (size_t k = first; k < first + n; k++)
        sums[0] += (double)c->s->set.r[k] * (double)c->s->z[k];
}

static void
turn_block(void *at, size_t first, size_t n, double *sums)
{
    const struct system *c = at;

    for (size_t k = first; k < first + n; k++) {
        c->d[k] = c->s->z[k] + (float)(c->a * (double)c->d[k]);
        sums[0] += (double)c->t[k];
    }
}

static double
solve(struct system *c)
{
    struct rc_solver *s = c->s;
    const struct rc_spectrum *factors[] = {s->op->kernel};
    rc_row *rows[] = {direction_in, displaced};
    double total[RC_SUMS], rz = 0, sum = 0;

    for (int step = 0; step < STEPS; step++) {
        double last = rz;

        rc_working_set_correct(s, NULL, NULL);
        rc_reduce_blocks(s, product_block, c, total);
        rz = total[0];
        c->a = last > 0 ? rz / last : 0;
        rc_reduce_blocks(s, turn_block, c, total);
        sum = total[0];
        /* r'z bounds the square of the energy norm of the error from above; that of t is its sum */
        if (!(rz > 0) || (step > 0 && rz <= enough * enough * sum))
            break;
        rc_reduce_rows_begin(s);
        rc_operator_chain(s->op, 1, factors, rows, c);
        rc_iterate_count(s, s->op->factor_cost);
        rc_reduce_rows_end(s, total);
        if (!(total[0] > 0))
            break;
        c->a = rz / total[0];
        rc_reduce_blocks(s, move_block, c, total);
    }
    return sum;
}

static size_t
nodes_held(const struct rc_shape *shape, const struct rc_problem *problem)
{
    size_t ranks = rc_ranks_count(problem->ranks);

    return shape->nx * (ranks > 1 ? rc_rows_most(shape, ranks) : shape->ny);
}

size_t
rc_solver_stiffness_memory(const struct rc_shape *shape, const struct rc_problem *problem)
{
    const struct system *c = NULL;

    return nodes_held(shape, problem) * (sizeof *c->t + sizeof *c->d + sizeof *c->q);
}

static void
system_free(struct system *c)
{
    free(c->t);
    free(c->d);
    free(c->q);
    *c = (struct system){.s = c->s};
}

static enum rc_status
system_new(struct system *c, struct rc_solver *s, struct rc_err *err)
{
    size_t n = s->posed.n;
    enum rc_status status = RC_OK;

    *c = (struct system){.s = s};
    if (s->stage != RC_STAGE_JUDGED)
        return rc_err_set(err, "the stiffness is that of a result: ask for rc_solver_result first");
    c->t = rc_alloc(n, sizeof *c->t);
    c->d = rc_alloc(n, sizeof *c->d);
    c->q = rc_alloc(n, sizeof *c->q);
    if (c->t == NULL || c->d == NULL || c->q == NULL)
        status = rc_err_set(err, "out of memory for the stiffness of %zu nodes", n);
    if (rc_ranks_agree(s->posed.rows.ranks, status, err) != RC_OK) {
        system_free(c);
        return RC_FAIL;
    }
    memset(c->t, 0, n * sizeof *c->t);
    memset(c->d, 0, n * sizeof *c->d);
    return RC_OK;
}

/* The stiffness of the elastic nodes, or of all in contact, N/m; NAN where there are none, and
 * where they are all of a periodic map, whose mean nothing moves. */
static double
stiffness_of(struct system *c, bool touching)
{
    struct rc_solver *s = c->s;
    size_t moving = rc_working_set_fix(s, touching);
    double found = NAN;

    if (moving > 0 && !(s->op->mean_free && moving == s->posed.nodes))
        /* one unit of t displaces by one unit of the operator's rows */
        found = solve(c) * s->posed.cell / s->op->unit;
    rc_working_set_forget(s);
    rc_working_set_find(s, false); /* who goes on stepping finds the contact's own residual */
    return found;
}

enum rc_status
rc_solver_stiffness(struct rc_solver *s, double *stiffness, struct rc_err *err)
{
    struct system c;

    *stiffness = NAN;
    if (system_new(&c, s, err) != RC_OK)
        return RC_FAIL;
    *stiffness = stiffness_of(&c, false);
    system_free(&c);
    return RC_OK;
}

/* ---- conductance ---- */

struct bound {
    const float *t;
    double *p, *u; /* t and K t, in double precision */
};

size_t
rc_solver_conductance_memory(const struct rc_shape *shape, const struct rc_problem *problem)
{
    const struct bound *b =
        NULL; /* two maps instead of the two that are then gone, which are smaller */

    return nodes_held(shape, problem) * (sizeof *b->t + sizeof *b->p + sizeof *b->u);
}

static void
widen_block(void *at, size_t first, size_t n, double *sums)
{
    const struct bound *b = at;

    (void)sums;
    for (size_t k = first; k < first + n; k++)
        b->p[k] = (double)b->t[k];
}

static void
energy_block(void *at, size_t first, size_t n, double *sums)
{
    const struct bound *b = at;

    for (size_t k = first; k < first + n; k++) {
        sums[0] += b->p[k];
        sums[1] += b->p[k] * b->u[k];
    }
}

/* A bound of the stiffness from below, N/m, by a convolution in double precision. */
static enum rc_status
bound_below(struct rc_solver *s, const float *t, double *bound, struct rc_err *err)
{
    struct bound b = {
        .t = t, .p = rc_alloc(s->posed.n, sizeof *b.p), .u = rc_alloc(s->posed.n, sizeof *b.u)};
    enum rc_status status = RC_OK;
    double total[RC_SUMS];

    if (b.p == NULL || b.u == NULL)
        status = rc_err_set(err, "out of memory for a bound of the conductance of %zu nodes",
                            s->posed.n);
    status = rc_ranks_agree(s->posed.rows.ranks, status, err);
    if (status == RC_OK) {
        rc_reduce_blocks(s, widen_block, &b, total);
        rc_operator_apply(s->op, b.p, b.u);
        rc_iterate_count(s, 1);
        rc_reduce_blocks(s, energy_block, &b, total);
        *bound = total[0] * total[0] / total[1] * s->posed.cell / (1 + s->op->error);
    }
    free(b.p);
    free(b.u);
    return status;
}

enum rc_status
rc_solver_conductance(struct rc_solver *s, double k1, double k2, struct rc_conductance *found,
                      struct rc_err *err)
{
    double stiffness, lower = NAN, per_stiffness;
    enum rc_status status = RC_OK;
    struct system c;

    *found = (struct rc_conductance){NAN, NAN, NAN};
    if (!(k1 > 0) || !(k2 > 0) || isinf(k1) || isinf(k2))
        return rc_err_set(err, "conductivities %g and %g: they must be positive and finite", k1,
                          k2);
    if (system_new(&c, s, err) != RC_OK)
        return RC_FAIL;
    if (!isnan(s->op->estar) && !isnan(stiffness = stiffness_of(&c, true))) {
        float *t = c.t;
        c.t = NULL;
        system_free(&c);
        status = bound_below(s, t, &lower, err);
        per_stiffness = 2 / (s->op->estar * (1 / k1 + 1 / k2));
        *found = (struct rc_conductance){stiffness, per_stiffness * fmax(stiffness, lower),
                                         per_stiffness * lower};
        free(t);
    }
    system_free(&c);
    return status;
}
