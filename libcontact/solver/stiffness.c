/*
 * How much more load a closer approach needs, the elastic nodes staying what they are: with t the
 * pressure that displaces all of them by one unit, K_WW t = 1, the stiffness is the sum of t.
 * Conjugate gradients with the preconditioner of the contact itself; the sum is stationary at the
 * solution, so its error is the square of theirs, and single precision is enough.
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
    size_t n = c->s->shape.nx;
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
    size_t n = c->s->shape.nx;
    const float *row = from, *d = c->d + j * n;
    const unsigned char *w = c->s->w + j * n;
    float *q = c->q + j * n;
    double sum = 0;

    for (size_t i = 0; i < n; i++) {
        q[i] = w[i] ? row[i] : 0;
        sum += (double)d[i] * (double)q[i];
    }
    rc_row_sums(c->s, j)[0] = sum;
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
        c->s->r[k] -= (float)(c->a * (double)c->q[k]);
    }
}

static void
product_block(void *at, size_t first, size_t n, double *sums)
{
    const struct system *c = at;

    for (size_t k = first; k < first + n; k++)
        sums[0] += (double)c->s->r[k] * (double)c->s->z[k];
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

static void
begin_block(void *at, size_t first, size_t n, double *sums)
{
    const struct system *c = at;
    struct rc_solver *s = c->s;

    for (size_t k = first; k < first + n; k++) {
        s->w[k] = rc_elastic(s, k);
        s->r[k] = s->w[k];
        c->t[k] = c->d[k] = 0;
        sums[0] += s->w[k];
    }
}

static double
solve(struct system *c)
{
    struct rc_solver *s = c->s;
    double total[RC_SUMS], rz = 0, sum = 0;

    for (int step = 0; step < STEPS; step++) {
        double last = rz;

        s->offset = 0;
        rc_solver_correct(s, NULL, NULL);
        rc_solver_blocks(s, product_block, c, total);
        rz = total[0];
        c->a = last > 0 ? rz / last : 0;
        rc_solver_blocks(s, turn_block, c, total);
        sum = total[0];
        /* r'z bounds the square of the energy norm of the error from above; that of t is its sum */
        if (!(rz > 0) || (step > 0 && rz <= enough * enough * sum))
            break;
        rc_solver_rows_begin(s);
        rc_preconditioner_displace(s->extension, direction_in, displaced, c);
        s->convolutions += 0.5;
        rc_solver_rows_end(s, total);
        if (!(total[0] > 0))
            break;
        c->a = rz / total[0];
        rc_solver_blocks(s, move_block, c, total);
    }
    return sum;
}

enum rc_status
rc_solver_stiffness(struct rc_solver *s, double *stiffness, struct rc_err *err)
{
    struct system c = {.s = s};
    float *room = rc_alloc(3 * s->n, sizeof *room);
    double total[RC_SUMS];

    *stiffness = NAN;
    if (room == NULL)
        return rc_err_set(err, "out of memory for the stiffness of %zu nodes", s->n);
    c.t = room;
    c.d = room + s->n;
    c.q = room + 2 * s->n;
    rc_solver_blocks(s, begin_block, &c, total);
    rc_solver_forget(s);
    if (total[0] > 0 && !(s->boundary == RC_PERIODIC && total[0] == (double)s->n))
        /* one unit of t displaces by one unit, on cells of unit area for E* = 1 */
        *stiffness = solve(&c) * s->estar * sqrt(s->cell);
    rc_solver_forget(s);
    free(room);
    return RC_OK;
}
