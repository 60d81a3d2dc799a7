/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The smallest ball about the points of a path.
 *
 * The point farthest from the present centre joins the few kept points, Welzl's recursion (1991, LNCS 555,
 * 359) finds their ball, and only the points that bear it are kept, until no point is outside. The radius
 * grows from ball to ball. Balls through given points are built point by point with an orthogonal basis
 * (Gaertner 1999, LNCS 1643, 325).
 *
 * A centre that is held in a subspace changes only the distances: what a point has outside the subspace adds
 * to its squared distance from any centre. The problem stays one of the same kind, because the difference of
 * two squared distances is linear in the centre.
 */
#include "fatigue.h"

#include <string.h>

enum {
    KEPT = RC_BALL_MOST + 2, /* most points: those that bear, and the farthest one */
    PASSES = 200             /* more than three times the largest number seen      */
};
/* Relative excess of a squared distance that is rounding: within the recursion, and for all points.
 * Half and double of these numbers and of `flat` change no bit (5 runs of bench/constants.py). */
static const double inside = 1e-14, enclosed = 1e-12;
/* Squared sine of the angle to the plane of other points below which a point is in that plane. */
static const double flat = 1e-18;

struct point {
    double x[RC_BALL_MOST];
};

/* The smallest ball with some points on its boundary. */
struct through {
    size_t n;
    const struct point *on[RC_BALL_MOST + 1];
    double basis[RC_BALL_MOST][RC_BALL_MOST]; /* orthonormal, of the plane through them */
    double centre[RC_BALL_MOST], square;      /* of the radius; -1: no point */
};

struct problem {
    size_t dim, free;
    struct point *point[KEPT];
    struct through best;
};

/* ---- balls through points ---- */

static double
square_from(const struct problem *b, const double *centre, const struct point *p)
{
    double sum = 0;

    for (size_t k = 0; k < b->dim; k++)
        sum += (p->x[k] - centre[k]) * (p->x[k] - centre[k]);
    return sum;
}

/* Adds a point to the boundary; false: it is in the plane of the others. */
static bool
pass_through(const struct problem *b, struct through *t, const struct point *p)
{
    const struct point *first = t->on[0];
    double e[RC_BALL_MOST], long_square = 0, square = 0, rhs = 0, z;

    t->on[t->n++] = p;
    if (t->n == 1) {
        memset(t->centre, 0, sizeof t->centre);
        memcpy(t->centre, p->x, b->free * sizeof *p->x);
        t->square = square_from(b, t->centre, p);
        return true;
    }
    for (size_t k = 0; k < b->dim; k++) {
        double a = p->x[k] - first->x[k];
        if (k < b->free) {
            e[k] = a;
            rhs += a * (a / 2 - (t->centre[k] - first->x[k]));
            long_square += a * a;
        } else {
            rhs += (p->x[k] * p->x[k] - first->x[k] * first->x[k]) / 2;
        }
    }
    for (int twice = 0; twice < 2; twice++)
        for (size_t i = 0; i + 2 < t->n; i++) {
            double along = 0;
            for (size_t k = 0; k < b->free; k++)
                along += e[k] * t->basis[i][k];
            for (size_t k = 0; k < b->free; k++)
                e[k] -= along * t->basis[i][k];
        }
    for (size_t k = 0; k < b->free; k++)
        square += e[k] * e[k];
    if (!(square > flat * long_square))
        return false;
    z = rhs / square; /* the basis is orthogonal to e: earlier points keep equal distances */
    for (size_t k = 0; k < b->free; k++) {
        t->centre[k] += z * e[k];
        t->basis[t->n - 2][k] = e[k] / sqrt(square);
    }
    t->square = square_from(b, t->centre, first);
    return true;
}

/* The smallest ball that contains the first n points, with the points `t` on its boundary. */
static void
recurse(struct problem *b, size_t n, const struct through *t)
{
    b->best = *t;
    if (t->n == b->free + 1)
        return;
    for (size_t i = 0; i < n; i++) {
        struct point *p = b->point[i];
        struct through next = *t;
        if (b->best.n > 0 && square_from(b, b->best.centre, p) <= b->best.square * (1 + inside))
            continue;
        if (!pass_through(b, &next, p))
            continue;
        recurse(b, i, &next);
        memmove(b->point + 1, b->point, i * sizeof(struct point *));
        b->point[0] = p;
    }
}

/* ---- all points ---- */

/* Squared distances from the centre; returns the largest. */
static inline double
squares(size_t dim, size_t n, const double *const *x, const double *centre, double *restrict out)
{
    double most = 0;

#pragma omp simd reduction(max : most)
    for (size_t t = 0; t < n; t++) {
        double sum = 0;
        for (size_t k = 0; k < dim; k++)
            sum += (x[k][t] - centre[k]) * (x[k][t] - centre[k]);
        out[t] = sum;
        most = sum > most ? sum : most;
    }
    return most;
}

RC_CLONES static double
squares_in_5(size_t n, const double *const *at, const double *c, double *restrict out)
{
    const double *const x[5] = {at[0], at[1], at[2], at[3], at[4]};
    const double centre[5] = {c[0], c[1], c[2], c[3], c[4]};

    return squares(5, n, x, centre, out);
}

RC_CLONES static double
squares_in_2(size_t n, const double *const *at, const double *c, double *restrict out)
{
    const double *const x[2] = {at[0], at[1]};
    const double centre[2] = {c[0], c[1]};

    return squares(2, n, x, centre, out);
}

static size_t
first_with(size_t n, const double *v, double value)
{
    size_t t = 0;

    while (t + 1 < n && v[t] != value)
        t++;
    return t;
}

/* Adds point t of the path to the kept ones, which are those of the last ball. */
static void
keep(struct problem *b, struct point *own, size_t kept, const double *const *x, size_t t)
{
    struct point bear[KEPT] = {0};

    for (size_t i = 0; i < kept; i++)
        bear[i] = *b->best.on[i];
    for (size_t k = 0; k < b->dim; k++)
        bear[kept].x[k] = x[k][t];
    for (size_t i = 0; i <= kept; i++) {
        own[i] = bear[kept - i];
        b->point[i] = &own[i];
    }
}

struct rc_ball
rc_ball_about(size_t dim, size_t free, size_t n, const double *const *x, double *room)
{
    double (*all)(size_t, const double *const *, const double *, double *restrict) =
        dim == 5 ? squares_in_5 : squares_in_2;
    const struct through none = {.square = -1};
    struct problem b = {.dim = dim, .free = free, .best = none};
    struct point own[KEPT];
    struct rc_ball ball = {.passes = 1};
    double most, before = -1;

    for (size_t k = 0; k < free; k++)
        ball.centre[k] = x[k][0];
    most = all(n, x, ball.centre, room);
    while (most > b.best.square * (1 + enclosed) && ball.passes < PASSES) {
        keep(&b, own, b.best.n, x, first_with(n, room, most));
        recurse(&b, b.best.n + 1, &none);
        if (!(b.best.square > before)) /* rounding */
            break;
        before = b.best.square;
        memcpy(ball.centre, b.best.centre, sizeof ball.centre);
        most = all(n, x, ball.centre, room);
        ball.passes++;
    }
    ball.radius = sqrt(most);
    return ball;
}
