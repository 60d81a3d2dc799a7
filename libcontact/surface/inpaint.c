/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Inpainting: missing values solve Laplace's equation on the five-point stencil. The measured values are the
 * boundary values, and no flux crosses the edge of the map. The solver is conjugate gradients with the
 * modified incomplete Cholesky factor as preconditioner (Gustafsson 1978). Its iterations grow only with the
 * square root of the width of a hole.
 */
#include "libcontact/common.h"
#include "libcontact/memory.h"

#include <math.h>

enum {
    LEFT = 1, /* the neighbour on this side is missing too */
    RIGHT = 2,
    ABOVE = 4,
    BELOW = 8,
    VECTORS = 7, /* number of arrays of the length of the unknowns, in doubles */
};

/* A x = b. Unknowns are numbered along rows: the missing neighbour on the left of k is k - 1. */
struct equations {
    size_t n;
    double wx, wy; /* weights of a neighbour along x, along y in the stencil              */
    unsigned char *sides;
    size_t *above;             /* number of the neighbour above, where sides has ABOVE  */
    double *diagonal;          /* diagonal of A: sum of the weights of all neighbours in the map */
    double *pivot;             /* 1 / diagonal of the incomplete factor                 */
    double *x, *r, *z, *d, *q; /* solution, residual, preconditioned, direction, A direction     */
};

static enum rc_status
equations_new(struct equations *e, struct rc_store *own, const struct rc_shape *shape, size_t n,
              struct rc_err *err)
{
    size_t bytes;

    *e = (struct equations){.n = n, .wx = shape->dy / shape->dx, .wy = shape->dx / shape->dy};
    if (rc_size_mul(n, VECTORS * sizeof *e->diagonal + sizeof *e->above + 1, &bytes, err) != RC_OK)
        return RC_FAIL;
    e->sides = rc_store_zeros(own, n, 1);
    e->above = rc_store_take(own, n, sizeof *e->above);
    e->diagonal = rc_store_zeros(own, VECTORS * n, sizeof *e->diagonal);
    if (own->failed)
        return rc_err_set(err, "out of memory to fill %zu missing values (%zu bytes)", n, bytes);
    e->pivot = e->diagonal + n;
    e->x = e->pivot + n;
    e->r = e->x + n;
    e->z = e->r + n;
    e->d = e->z + n;
    e->q = e->d + n;
    return RC_OK;
}

/* Adds a neighbour of unknown k: another unknown, or a measured value to the right-hand side. */
static void
add_neighbour(struct equations *e, size_t k, unsigned char side, double weight, double neighbour,
              double datum)
{
    e->diagonal[k] += weight;
    if (isnan(neighbour))
        e->sides[k] |= side;
    else
        e->r[k] += weight * (neighbour - datum);
}

/* Sets up the equations and the residual of x = 0; heights are relative to the datum. */
static void
set_up(struct equations *e, const struct rc_shape *shape, const double *h, double datum)
{
    size_t nx = shape->nx, k = 0;
    size_t row_above = 0; /* first unknown that can be the upper neighbour of the next one */

    for (size_t j = 0; j < shape->ny; j++) {
        size_t row = k, upper = row_above;
        for (size_t i = 0; i < nx; i++) {
            const double *at = h + j * nx + i;
            if (j > 0 && isnan(at[-(ptrdiff_t)nx]))
                upper++;
            if (!isnan(*at))
                continue;
            if (i > 0)
                add_neighbour(e, k, LEFT, e->wx, at[-1], datum);
            if (i + 1 < nx)
                add_neighbour(e, k, RIGHT, e->wx, at[1], datum);
            if (j > 0)
                add_neighbour(e, k, ABOVE, e->wy, at[-(ptrdiff_t)nx], datum);
            if (j + 1 < shape->ny)
                add_neighbour(e, k, BELOW, e->wy, at[nx], datum);
            e->above[k] = upper - 1; /* used only where sides has ABOVE */
            k++;
        }
        row_above = row;
    }
}

/* Pivots that preserve the row sums of A. But for rounding they are positive: each is at least the sum of the
 * weights of the missing neighbours on the right and below. The last unknown, which has neither, keeps the
 * weights of its measured neighbours. If rounding leaves next to nothing, the diagonal of A replaces the
 * pivot. */
static void
factor(struct equations *e)
{
    double wx = e->wx, wy = e->wy;

    for (size_t k = 0; k < e->n; k++) {
        double pivot = e->diagonal[k];
        if (e->sides[k] & LEFT) {
            size_t l = k - 1;
            pivot -= wx * e->pivot[l] * (wx + (e->sides[l] & BELOW ? wy : 0));
        }
        if (e->sides[k] & ABOVE) {
            size_t a = e->above[k];
            pivot -= wy * e->pivot[a] * (wy + (e->sides[a] & RIGHT ? wx : 0));
        }
        e->pivot[k] = 1 / (pivot > 1e-6 * e->diagonal[k] ? pivot : e->diagonal[k]);
    }
}

/* z = M^-1 r: forward substitution along the rows, then backward. */
static void
precondition(struct equations *e)
{
    double *z = e->z;

    for (size_t k = 0; k < e->n; k++) {
        double s = e->r[k];
        if (e->sides[k] & ABOVE)
            s += e->wy * z[e->above[k]];
        if (e->sides[k] & LEFT)
            s += e->wx * z[k - 1];
        z[k] = s * e->pivot[k];
    }
    for (size_t k = e->n; k-- > 0;) {
        if (e->sides[k] & LEFT)
            z[k - 1] += e->wx * z[k] * e->pivot[k - 1];
        if (e->sides[k] & ABOVE)
            z[e->above[k]] += e->wy * z[k] * e->pivot[e->above[k]];
    }
}

/* q = A d */
static void
multiply(struct equations *e)
{
    const double *d = e->d;
    double *q = e->q;

    for (size_t k = 0; k < e->n; k++) {
        q[k] = e->diagonal[k] * d[k];
        if (e->sides[k] & LEFT) {
            q[k] -= e->wx * d[k - 1];
            q[k - 1] -= e->wx * d[k];
        }
        if (e->sides[k] & ABOVE) {
            q[k] -= e->wy * d[e->above[k]];
            q[e->above[k]] -= e->wy * d[k];
        }
    }
}

static double
dot(const double *a, const double *b, size_t n)
{
    double s = 0;

    for (size_t k = 0; k < n; k++)
        s += a[k] * b[k];
    return s;
}

/* Conjugate gradients from x = 0 until the residual is 1e-13 of the first one. If rounding keeps it above
 * that for too many steps, 1e-10 is enough. */
static enum rc_status
solve(struct equations *e, struct rc_err *err)
{
    const double aim = 1e-13, enough = 1e-10;
    double start = sqrt(dot(e->r, e->r, e->n)), now = start, rz = 0;
    size_t most = 200 + 20 * (size_t)sqrt((double)e->n);

    for (size_t step = 0; now > aim * start && step < most; step++) {
        double before = rz, alpha, beta;

        precondition(e);
        rz = dot(e->r, e->z, e->n);
        beta = step == 0 ? 0 : rz / before;
        for (size_t k = 0; k < e->n; k++)
            e->d[k] = e->z[k] + beta * e->d[k];
        multiply(e);
        alpha = rz / dot(e->d, e->q, e->n);
        for (size_t k = 0; k < e->n; k++) {
            e->x[k] += alpha * e->d[k];
            e->r[k] -= alpha * e->q[k];
        }
        now = sqrt(dot(e->r, e->r, e->n));
    }
    if (!(now <= enough * start))
        return rc_err_set(err, "filling %zu missing values stopped at a relative residual of %g",
                          e->n, now / start);
    return RC_OK;
}

enum rc_status
rc_inpaint(const struct rc_shape *shape, double *h, size_t *filled, struct rc_err *err)
{
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    struct equations e;
    struct rc_statistics s;
    size_t nodes = shape->nx * shape->ny;

    rc_measure(shape, h, &s);
    *filled = 0;
    if (s.missing == 0)
        return RC_OK;
    if (s.infinite > 0)
        return rc_err_set(err,
                          "%zu of %zu values are infinite: missing ones cannot be filled from "
                          "them",
                          s.infinite, nodes);
    if (s.missing == nodes)
        return rc_err_set(err, "all %zu values are missing: nothing to fill them from", nodes);
    if (equations_new(&e, &own, shape, s.missing, err) != RC_OK)
        return RC_FAIL;
    set_up(&e, shape, h, s.mean);
    factor(&e);
    if (solve(&e, err) != RC_OK)
        return RC_FAIL;
    for (size_t at = 0, k = 0; at < nodes; at++)
        if (isnan(h[at]))
            h[at] = s.mean + e.x[k++];
    *filled = s.missing;
    return RC_OK;
}
