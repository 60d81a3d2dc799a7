/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The stiffness: the load that one unit of approach adds while a set of nodes moves together and no node
 * joins or leaves. If t is the pressure that displaces all of them by one unit, K_WW t = 1, the stiffness is
 * the sum of t. The equation is solved by conjugate gradients with the preconditioner of the contact. The sum
 * is stationary at the solution, so its relative error is the square of the relative error of t, and single
 * precision is enough.
 *
 * For d load / d approach the set holds the elastic nodes, because nodes at their upper bounds carry no
 * further load. For the conductance it holds all nodes in contact. Electrical potential and current
 * density at the surface obey the same equation as displacement and pressure (Barber 2003). The potential is
 * uniform in the contact. Any t then gives a lower bound, (sum t)^2 / t'K t <= S, by Schwarz's inequality in
 * the scalar product of K.
 *
 * Where the counter body may tilt, each node of the set is also displaced by its arm about the force, along x
 * or y.
 */
#include "solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    /* Most steps: they end at `enough` after fewer than 30 in 123 contacts (bench/constants.py: half
     * changes nothing). */
    STEPS = 60
};
/* Error in the energy norm: 1e-8 of the sum, because the sum is the energy. Half and double change the
 * convolutions of lists and free tilts by 6 % at most, and no pressure in three digits
 * (bench/constants.py). */
static const double enough = 1e-4;

struct system {
    struct rc_solver *s;
    float *t, *d, *q; /* solution, direction, K d on W */
    double a;
    size_t by; /* all nodes of W are displaced by 1 (0) or by their arms along x (1) or y (2) */
    bool arms; /* the moments of t are needed */
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

/* A step of length a along d, for t and r. */
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
    for (size_t k = first; k < first + n && c->arms; k++)
        if (c->t[k] != 0)
            for (size_t a = 0; a < 2; a++)
                sums[1 + a] += (double)c->t[k] * rc_arm(c->s, a, k);
}

/* `sum`: the sum of t, and its moments if they are needed. */
static void
solve(struct system *c, double sum[3])
{
    struct rc_solver *s = c->s;
    const struct rc_spectrum *factors[] = {s->op->kernel};
    rc_row *rows[] = {direction_in, displaced};
    double total[RC_SUMS], rz = 0;

    for (int step = 0; step < STEPS; step++) {
        double last = rz;

        rc_working_set_correct(s, NULL, NULL);
        rc_reduce_blocks(s, product_block, c, total);
        rz = total[0];
        c->a = last > 0 ? rz / last : 0;
        rc_reduce_blocks(s, turn_block, c, total);
        for (size_t q = 0; q < 3; q++)
            sum[q] = total[q];
        /* r'z bounds the squared energy norm of the error from above; the squared norm of t is t'K t */
        if (!(rz > 0) || (step > 0 && rz <= enough * enough * sum[c->by]))
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
}

static void
system_free(struct system *c)
{
    free(c->t);
    free(c->d);
    free(c->q);
}

static enum rc_status
system_new(struct system *c, struct rc_solver *s, struct rc_err *err)
{
    const size_t n = s->posed.n;

    *c = (struct system){.s = s};
    c->t = rc_alloc(n, sizeof *c->t);
    c->d = rc_alloc(n, sizeof *c->d);
    c->q = rc_alloc(n, sizeof *c->q);
    return rc_ranks_need(s->posed.rows.ranks, c->t != NULL && c->d != NULL && c->q != NULL, err,
                         "out of memory for the stiffness of %zu nodes", n);
}

static enum rc_status
check_judged(const struct rc_solver *s, struct rc_err *err)
{
    if (s->stage != RC_STAGE_JUDGED)
        return rc_err_set(err, "the stiffness belongs to a result: call rc_solver_result first");
    return RC_OK;
}

static void
by_arms(void *at, size_t first, size_t n, double *sums)
{
    const struct system *c = at;

    (void)sums;
    for (size_t k = first; k < first + n; k++)
        c->s->set.r[k] *= (float)rc_arm(c->s, c->by - 1, k);
}

/* Finds t for the elastic nodes or for all nodes in contact, and its sums; c->by selects the displacement.
 * Returns the number of nodes. */
static size_t
fix_and_solve(struct system *c, bool touching, double sum[3])
{
    struct rc_solver *s = c->s;
    size_t moving = rc_working_set_fix(s, touching);
    double total[RC_SUMS];

    memset(c->t, 0, s->posed.n * sizeof *c->t);
    memset(c->d, 0, s->posed.n * sizeof *c->d);
    sum[0] = sum[1] = sum[2] = 0;
    if (c->by > 0)
        rc_reduce_blocks(s, by_arms, c, total);
    if (moving > 0 && !(s->op->mean_free && moving == s->posed.nodes))
        solve(c, sum);
    else
        moving = 0;
    rc_working_set_forget(s);
    rc_working_set_find(s, false); /* restores the residual of the contact for further steps */
    return moving;
}

/* The stiffness, N/m, for the datum of the problem, from that for the datum of K. NAN where the datum
 * lies among the nodes that move, so that the approach does not grow with the load. */
static double
to_datum(const struct rc_solver *s, double stiffness)
{
    const double compliance = 1 / stiffness + s->op->rise / s->posed.cell;

    return s->op->rise == 0 ? stiffness : compliance > 0 ? 1 / compliance : NAN;
}

/* The stiffness of the elastic nodes, or of all nodes in contact, N/m. NAN without such nodes, and if they
 * are all nodes of a periodic map, whose mean displacement is undefined. */
static double
stiffness_of(struct system *c, bool touching)
{
    double sum[3];

    if (fix_and_solve(c, touching, sum) == 0)
        return NAN;
    /* a pressure t of one unit displaces by one unit of the rows of the operator */
    return to_datum(c->s, sum[0] * c->s->posed.cell / c->s->op->unit);
}

static bool
turning(struct system *c, double k[3][3])
{
    c->arms = true;
    for (c->by = 0; c->by < 3; c->by++) {
        if (fix_and_solve(c, false, k[c->by]) == 0)
            return false;
        for (size_t q = 0; q < 3; q++)
            k[c->by][q] /= c->s->op->unit;
    }
    return true;
}

bool
rc_stiffness_turning(struct rc_solver *s, float *room, double k[3][3])
{
    size_t n = s->posed.n;
    struct system c = {.s = s, .t = room, .d = room + n, .q = room + 2 * n};

    return turning(&c, k);
}

/* The stiffness with a free tilt, from k of shift and rotations: 1 over the shift caused by a unit load
 * without moment. An axis about which the contact does not resist rotation does not rotate. */
static double
free_to_turn(double k[3][3])
{
    const double least = 1e-12 * k[0][0];
    double x = k[1][1] + least, y = k[2][2] + least, xy = k[1][2];
    double det = x * y - xy * xy, bx = k[0][1], by = k[0][2];

    return k[0][0] - (bx * bx * y - 2 * bx * by * xy + by * by * x) / det;
}

enum rc_status
rc_solver_stiffness(struct rc_solver *s, double *stiffness, struct rc_err *err)
{
    RC_ENDS(system_free) struct system c = {0};
    double k[3][3];

    *stiffness = NAN;
    if (check_judged(s, err) != RC_OK || system_new(&c, s, err) != RC_OK)
        return RC_FAIL;
    if (s->tilt == NULL)
        *stiffness = stiffness_of(&c, false);
    else if (turning(&c, k))
        *stiffness = free_to_turn(k) * s->posed.cell;
    return RC_OK;
}

/* ---- conductance ---- */

struct bound {
    const float *t;
    double *p, *u; /* t and K t, in double precision */
};

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

/* A lower bound of the stiffness, N/m, by a convolution in double precision. */
static enum rc_status
bound_below(struct rc_solver *s, const float *t, double *bound, struct rc_err *err)
{
    RC_OWNED double *p = rc_alloc(s->posed.n, sizeof *p);
    RC_OWNED double *u = rc_alloc(s->posed.n, sizeof *u);
    struct bound b = {t, p, u};
    double total[RC_SUMS];

    if (rc_ranks_need(s->posed.rows.ranks, p != NULL && u != NULL, err,
                      "out of memory for a bound of the conductance of %zu nodes",
                      s->posed.n) != RC_OK)
        return RC_FAIL;
    rc_reduce_blocks(s, widen_block, &b, total);
    rc_operator_apply(s->op, p, u);
    rc_iterate_count(s, 1);
    rc_reduce_blocks(s, energy_block, &b, total);
    *bound = to_datum(s, total[0] * total[0] / total[1] * s->posed.cell / (1 + s->op->error));
    return RC_OK;
}

enum rc_status
rc_solver_conductance(struct rc_solver *s, double k1, double k2, struct rc_conductance *found,
                      struct rc_err *err)
{
    double stiffness, lower = NAN, per_stiffness;
    enum rc_status status = RC_OK;
    RC_ENDS(system_free) struct system c = {0};

    *found = (struct rc_conductance){NAN, NAN, NAN};
    if (!(k1 > 0) || !(k2 > 0) || isinf(k1) || isinf(k2))
        return rc_err_set(err, "conductivities %g and %g: they must be positive and finite", k1,
                          k2);
    if (check_judged(s, err) != RC_OK || system_new(&c, s, err) != RC_OK)
        return RC_FAIL;
    if (!isnan(s->op->estar) && !isnan(stiffness = stiffness_of(&c, true))) {
        free(c.d); /* the bound takes the memory */
        free(c.q);
        c.d = c.q = NULL;
        status = bound_below(s, c.t, &lower, err);
        per_stiffness = 2 / (s->op->estar * (1 / k1 + 1 / k2));
        *found = (struct rc_conductance){stiffness, per_stiffness * fmax(stiffness, lower),
                                         per_stiffness * lower};
    }
    return status;
}
