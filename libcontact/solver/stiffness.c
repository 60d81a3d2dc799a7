/*
 * The stiffness: the load that one unit of approach adds while the set of elastic nodes stays the
 * same. With t the pressure that displaces all of them by one unit, K_WW t = 1, it is the sum of t.
 * The equation is solved by conjugate gradients with the preconditioner of the contact. The sum is
 * stationary at the solution, so its relative error is the square of that of t, and single
 * precision is enough.
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

size_t
rc_solver_stiffness_memory(const struct rc_shape *shape, const struct rc_problem *problem)
{
    const struct system *c = NULL;
    size_t ranks = rc_ranks_count(problem->ranks);
    size_t rows = ranks > 1 ? rc_rows_most(shape, ranks) : shape->ny;

    return shape->nx * rows * (sizeof *c->t + sizeof *c->d + sizeof *c->q);
}

enum rc_status
rc_solver_stiffness(struct rc_solver *s, double *stiffness, struct rc_err *err)
{
    struct system c = {.s = s};
    size_t n = s->posed.n, elastic;
    enum rc_status status = RC_OK;

    *stiffness = NAN;
    if (s->stage != RC_STAGE_JUDGED)
        return rc_err_set(err, "the stiffness is that of a result: ask for rc_solver_result first");
    c.t = rc_alloc(n, sizeof *c.t);
    c.d = rc_alloc(n, sizeof *c.d);
    c.q = rc_alloc(n, sizeof *c.q);
    if (c.t == NULL || c.d == NULL || c.q == NULL)
        status = rc_err_set(err, "out of memory for the stiffness of %zu nodes", n);
    if (rc_ranks_agree(s->posed.rows.ranks, status, err) != RC_OK) {
        free(c.t);
        free(c.d);
        free(c.q);
        return RC_FAIL;
    }
    memset(c.t, 0, n * sizeof *c.t);
    memset(c.d, 0, n * sizeof *c.d);
    elastic = rc_working_set_elastic(s);
    if (elastic > 0 && !(s->op->mean_free && elastic == s->posed.nodes))
        /* one unit of t displaces by one unit of the operator's rows */
        *stiffness = solve(&c) * s->posed.cell / s->op->unit;
    rc_working_set_forget(s);
    rc_working_set_find(s, false); /* who goes on stepping finds the contact's own residual */
    free(c.t);
    free(c.d);
    free(c.q);
    return RC_OK;
}
