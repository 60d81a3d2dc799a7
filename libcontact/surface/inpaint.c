/*
 * Missing values as the membrane that hangs from the measured ones: Laplace's equation on the
 * five-point stencil, no flux across the edge of the map, solved by conjugate gradients that are
 * preconditioned with the modified incomplete Cholesky factor (Gustafsson 1978), whose number of
 * iterations grows with the square root of the width of a hole only.
 */
#include "libcontact/contact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEFT = 1, /* the neighbour on this side is missing too */
    RIGHT = 2,
    ABOVE = 4,
    BELOW = 8,
    VECTORS = 7, /* of the unknowns' length, in doubles */
};

/* The unknowns, numbered along rows: the neighbour on the left of k is k - 1. */
struct membrane {
    size_t n;
    double wx, wy; /* what a neighbour along x, along y pulls with                        */
    unsigned char *sides;
    size_t *above;    /* number of the neighbour above, where sides has ABOVE                */
    double *diagonal; /* weight of all neighbours that are in the map                        */
    double *pivot;    /* 1 / diagonal of the incomplete factor                               */
    double *x, *r, *z, *d, *q; /* solution, residual, preconditioned, direction, A direction     */
};

static void
membrane_free(struct membrane *m)
{
    free(m->sides);
    free(m->above);
    free(m->diagonal);
}

size_t
rc_inpaint_memory(size_t missing)
{
    return missing * (VECTORS * sizeof(double) + sizeof(size_t) + 1);
}

static enum rc_status
membrane_new(struct membrane *m, const struct rc_shape *shape, size_t n, struct rc_err *err)
{
    size_t bytes;

    *m = (struct membrane){.n = n, .wx = shape->dy / shape->dx, .wy = shape->dx / shape->dy};
    if (rc_size_mul(n, rc_inpaint_memory(1), &bytes, err) != RC_OK)
        return RC_FAIL;
    m->sides = calloc(n, 1);
    m->above = malloc(n * sizeof *m->above);
    m->diagonal = calloc(VECTORS * n, sizeof *m->diagonal);
    if (m->sides == NULL || m->above == NULL || m->diagonal == NULL)
        return rc_err_set(err, "out of memory to fill %zu missing values (%zu bytes)", n, bytes);
    m->pivot = m->diagonal + n;
    m->x = m->pivot + n;
    m->r = m->x + n;
    m->z = m->r + n;
    m->d = m->z + n;
    m->q = m->d + n;
    return RC_OK;
}

/* One neighbour of unknown k: missing too, or a value that pulls. */
static void
join(struct membrane *m, size_t k, unsigned char side, double weight, double neighbour,
     double datum)
{
    m->diagonal[k] += weight;
    if (isnan(neighbour))
        m->sides[k] |= side;
    else
        m->r[k] += weight * (neighbour - datum);
}

/* Sets up the equations: the residual of x = 0, with heights counted from the datum. */
static void
connect(struct membrane *m, const struct rc_shape *shape, const double *h, double datum)
{
    size_t nx = shape->nx, k = 0;
    size_t row_above = 0; /* first unknown that may be the upper neighbour of the next one */

    for (size_t j = 0; j < shape->ny; j++) {
        size_t row = k, upper = row_above;
        for (size_t i = 0; i < nx; i++) {
            const double *at = h + j * nx + i;
            if (j > 0 && isnan(at[-(ptrdiff_t)nx]))
                upper++;
            if (!isnan(*at))
                continue;
            if (i > 0)
                join(m, k, LEFT, m->wx, at[-1], datum);
            if (i + 1 < nx)
                join(m, k, RIGHT, m->wx, at[1], datum);
            if (j > 0)
                join(m, k, ABOVE, m->wy, at[-(ptrdiff_t)nx], datum);
            if (j + 1 < shape->ny)
                join(m, k, BELOW, m->wy, at[nx], datum);
            m->above[k] = upper - 1; /* meant only where sides has ABOVE */
            k++;
        }
        row_above = row;
    }
}

/* Pivots that keep the row sums of the matrix. They are positive: each one is at least what its
 * neighbours on the right and below pull with, and the last node of the map is reached from some
 * node that hangs on a measured value. */
static void
factor(struct membrane *m)
{
    double wx = m->wx, wy = m->wy;

    for (size_t k = 0; k < m->n; k++) {
        double pivot = m->diagonal[k];
        if (m->sides[k] & LEFT) {
            size_t l = k - 1;
            pivot -= wx * m->pivot[l] * (wx + (m->sides[l] & BELOW ? wy : 0));
        }
        if (m->sides[k] & ABOVE) {
            size_t a = m->above[k];
            pivot -= wy * m->pivot[a] * (wy + (m->sides[a] & RIGHT ? wx : 0));
        }
        m->pivot[k] = 1 / (pivot > 1e-6 * m->diagonal[k] ? pivot : m->diagonal[k]);
    }
}

/* z = M^-1 r: down the rows, then up. */
static void
precondition(struct membrane *m)
{
    double *z = m->z;

    for (size_t k = 0; k < m->n; k++) {
        double s = m->r[k];
        if (m->sides[k] & ABOVE)
            s += m->wy * z[m->above[k]];
        if (m->sides[k] & LEFT)
            s += m->wx * z[k - 1];
        z[k] = s * m->pivot[k];
    }
    for (size_t k = m->n; k-- > 0;) {
        if (m->sides[k] & LEFT)
            z[k - 1] += m->wx * z[k] * m->pivot[k - 1];
        if (m->sides[k] & ABOVE)
            z[m->above[k]] += m->wy * z[k] * m->pivot[m->above[k]];
    }
}

/* q = A d */
static void
pull(struct membrane *m)
{
    const double *d = m->d;
    double *q = m->q;

    for (size_t k = 0; k < m->n; k++) {
        q[k] = m->diagonal[k] * d[k];
        if (m->sides[k] & LEFT) {
            q[k] -= m->wx * d[k - 1];
            q[k - 1] -= m->wx * d[k];
        }
        if (m->sides[k] & ABOVE) {
            q[k] -= m->wy * d[m->above[k]];
            q[m->above[k]] -= m->wy * d[k];
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

/* Conjugate gradients from x = 0 until the residual has fallen to 1e-13 of where it began, or to
 * where rounding holds it up: within 1e-10 that is an answer. */
static enum rc_status
relax(struct membrane *m, struct rc_err *err)
{
    const double aim = 1e-13, enough = 1e-10;
    double start = sqrt(dot(m->r, m->r, m->n)), now = start, rz = 0;
    size_t most = 200 + 20 * (size_t)sqrt((double)m->n);

    for (size_t step = 0; now > aim * start && step < most; step++) {
        double before = rz, alpha, beta;

        precondition(m);
        rz = dot(m->r, m->z, m->n);
        beta = step == 0 ? 0 : rz / before;
        for (size_t k = 0; k < m->n; k++)
            m->d[k] = m->z[k] + beta * m->d[k];
        pull(m);
        alpha = rz / dot(m->d, m->q, m->n);
        for (size_t k = 0; k < m->n; k++) {
            m->x[k] += alpha * m->d[k];
            m->r[k] -= alpha * m->q[k];
        }
        now = sqrt(dot(m->r, m->r, m->n));
    }
    if (!(now <= enough * start))
        return rc_err_set(err, "filling %zu missing values stopped at a relative residual of %g",
                          m->n, now / start);
    return RC_OK;
}

enum rc_status
rc_inpaint(const struct rc_shape *shape, double *h, size_t *filled, struct rc_err *err)
{
    struct membrane m = {0};
    struct rc_statistics s;
    enum rc_status status = RC_FAIL;
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
    if (membrane_new(&m, shape, s.missing, err) != RC_OK)
        goto done;
    connect(&m, shape, h, s.mean);
    factor(&m);
    if (relax(&m, err) != RC_OK)
        goto done;
    for (size_t at = 0, k = 0; at < nodes; at++)
        if (isnan(h[at]))
            h[at] = s.mean + m.x[k++];
    *filled = s.missing;
    status = RC_OK;
done:
    membrane_free(&m);
    return status;
}
