/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contact of a small map as a dense quadratic program: an influence matrix from closed forms, an
 * active-set method, Cholesky's factorisation. It shares no code with the library. */
#ifndef DENSE_H
#define DENSE_H

#include "tests/contact_case.h"

#ifndef DENSE_MOST
#define DENSE_MOST 576
#endif

enum {
    DENSE_NODES = DENSE_MOST,
    DENSE_SUMS = 3 /* number of sums of constraints */
};

struct dense {
    size_t n, sums;
    double
        sum[DENSE_SUMS]
           [DENSE_NODES]; /* sum_k sum[c][k] p[k] = value[c]; in the first one all factors are 1 */
    double value[DENSE_SUMS];
    double K[DENSE_NODES][DENSE_NODES];
};

static double dense_factor[DENSE_NODES][DENSE_NODES];

/* The displacement i columns and j rows away from a unit pressure on one cell. It is that of Love's
 * rectangle. On a periodic map it is the sum of the waves of the grid plus the mean of one cell. This mean
 * only changes the shift and makes K definite. */
static inline double
dense_influence(const struct rc_shape *s, struct rc_boundary boundary, double estar, size_t i,
                size_t j)
{
    double u = s->dx / estar, nodes = (double)(s->nx * s->ny);

    if (rc_repeats(boundary) == 0)
        return love_displacement((double)i * s->dx, (double)j * s->dy, s->dx / 2, s->dy / 2, estar);
    for (size_t a = 0; a < s->nx; a++)
        for (size_t b = 0; b < s->ny; b++) {
            double ka = (double)a - (a > s->nx / 2 ? (double)s->nx : 0);
            double kb = (double)b - (b > s->ny / 2 ? (double)s->ny : 0);
            double q =
                2 * exact_pi * hypot(ka / ((double)s->nx * s->dx), kb / ((double)s->ny * s->dy));
            double phase =
                2 * exact_pi *
                ((double)(a * i % s->nx) / (double)s->nx + (double)(b * j % s->ny) / (double)s->ny);
            if (a + b > 0)
                u += 2 / (estar * q) * cos(phase) / nodes;
        }
    return u;
}

/* The matrix for this influence of the corner cell, and the constraint on the sum of all pressures. */
static inline void
dense_of(struct dense *d, const struct rc_shape *s, const double *at)
{
    d->n = s->nx * s->ny;
    d->sums = 1;
    assert_true(d->n <= DENSE_NODES);
    for (size_t k = 0; k < d->n; k++) {
        d->sum[0][k] = 1;
        for (size_t l = 0; l < d->n; l++) {
            size_t i = k % s->nx, j = k / s->nx, x = l % s->nx, y = l / s->nx;
            d->K[k][l] = at[(j > y ? j - y : y - j) * s->nx + (i > x ? i - x : x - i)];
        }
    }
}

/* The same for a half-space. */
static inline void
dense_fill(struct dense *d, const struct rc_shape *s, struct rc_boundary boundary, double estar)
{
    static double at[DENSE_NODES];

    assert_true(s->nx * s->ny <= DENSE_NODES);
    for (size_t k = 0; k < s->nx * s->ny; k++)
        at[k] = dense_influence(s, boundary, estar, k % s->nx, k / s->nx);
    dense_of(d, s, at);
}

/* K p at a node. */
static inline double
dense_displacement(const struct dense *d, const double *p, size_t k)
{
    double u = 0;

    for (size_t l = 0; l < d->n; l++)
        u += d->K[k][l] * p[l];
    return u;
}

/* Solves the equations of the part of K with these nodes; x: right-hand sides, one after another, replaced by
 * the solutions. */
static inline void
dense_part(const struct dense *d, size_t n, const size_t *node, size_t sides,
           double (*x)[DENSE_NODES])
{
    for (size_t k = 0; k < n; k++)
        for (size_t l = 0; l <= k; l++) {
            double sum = d->K[node[k]][node[l]];
            for (size_t m = 0; m < l; m++)
                sum -= dense_factor[k][m] * dense_factor[l][m];
            assert_true(k != l || sum > 0);
            dense_factor[k][l] = k == l ? sqrt(sum) : sum / dense_factor[l][l];
        }
    for (size_t c = 0; c < sides; c++) {
        for (size_t k = 0; k < n; k++) {
            for (size_t m = 0; m < k; m++)
                x[c][k] -= dense_factor[k][m] * x[c][m];
            x[c][k] /= dense_factor[k][k];
        }
        for (size_t k = n; k-- > 0;) {
            for (size_t m = k + 1; m < n; m++)
                x[c][k] -= dense_factor[m][k] * x[c][m];
            x[c][k] /= dense_factor[k][k];
        }
    }
}

/* Solves a x = b for a few unknowns, by elimination with pivots; b becomes x. */
static inline void
dense_few(size_t n, double (*a)[DENSE_SUMS], double *b)
{
    for (size_t c = 0; c < n; c++) {
        size_t best = c;
        for (size_t r = c; r < n; r++)
            best = fabs(a[r][c]) > fabs(a[best][c]) ? r : best;
        for (size_t q = 0; q < n; q++) {
            double t = a[c][q];
            a[c][q] = a[best][q];
            a[best][q] = t;
        }
        double t = b[c];
        b[c] = b[best];
        b[best] = t;
        for (size_t r = 0; r < n; r++) {
            double f = a[r][c] / a[c][c];
            if (r == c)
                continue;
            for (size_t q = 0; q < n; q++)
                a[r][q] -= f * a[c][q];
            b[r] -= f * b[c];
        }
    }
    for (size_t c = 0; c < n; c++)
        b[c] /= a[c][c];
}

enum dense_side {
    DENSE_LOW,
    DENSE_ELASTIC,
    DENSE_HIGH
};

/* Solves (K p)_E = h_E + sum_c shift_c sum_c,E and the constraints for given sets of elastic nodes E and
 * nodes at a bound. */
static inline void
dense_equilibrium(const struct dense *d, const double *h, const double *most,
                  const enum dense_side *side, double *p, double *shift)
{
    static double x[1 + DENSE_SUMS][DENSE_NODES];
    static size_t node[DENSE_NODES];
    double a[DENSE_SUMS][DENSE_SUMS];
    size_t n = 0;

    for (size_t k = 0; k < d->n; k++) {
        p[k] = side[k] == DENSE_HIGH ? most[k] : 0;
        if (side[k] == DENSE_ELASTIC)
            node[n++] = k;
    }
    assert_true(n >= d->sums);
    for (size_t e = 0; e < n; e++) {
        x[0][e] = h[node[e]] - dense_displacement(d, p, node[e]);
        for (size_t c = 0; c < d->sums; c++)
            x[1 + c][e] = d->sum[c][node[e]];
    }
    dense_part(d, n, node, 1 + d->sums, x);
    for (size_t c = 0; c < d->sums; c++) {
        shift[c] = d->value[c];
        for (size_t k = 0; k < d->n; k++)
            shift[c] -= d->sum[c][k] * p[k];
        for (size_t e = 0; e < n; e++)
            shift[c] -= d->sum[c][node[e]] * x[0][e];
        for (size_t q = 0; q < d->sums; q++) {
            a[c][q] = 0;
            for (size_t e = 0; e < n; e++)
                a[c][q] += d->sum[c][node[e]] * x[1 + q][e];
        }
    }
    dense_few(d->sums, a, shift);
    for (size_t e = 0; e < n; e++) {
        p[node[e]] = x[0][e];
        for (size_t c = 0; c < d->sums; c++)
            p[node[e]] += shift[c] * x[1 + c][e];
    }
}

/* Changes the active sets until all signs are right, which holds only for the solution; the first sets are
 * those of p. `shift` receives the multipliers of the constraints. */
static inline void
dense_solve(const struct dense *d, const double *h, const double *most, double *p, double *shift)
{
    static enum dense_side side[DENSE_NODES];
    double tiny = 1e-13 * d->value[0] / (double)d->n;
    bool all = true;

    for (size_t k = 0; k < d->n; k++)
        side[k] = p[k] <= 0 ? DENSE_LOW : p[k] >= most[k] ? DENSE_HIGH : DENSE_ELASTIC;
    for (int round = 0; round < 400; round++) {
        size_t wrong = 0;

        dense_equilibrium(d, h, most, side, p, shift);
        for (size_t k = 0; k < d->n; k++) {
            enum dense_side was = side[k];
            double gap = dense_displacement(d, p, k) - h[k];
            for (size_t c = 0; c < d->sums; c++)
                gap -= shift[c] * d->sum[c][k];
            if (was == DENSE_ELASTIC)
                side[k] = p[k] < -tiny            ? DENSE_LOW
                          : p[k] > most[k] + tiny ? DENSE_HIGH
                                                  : DENSE_ELASTIC;
            else if (was == DENSE_LOW ? gap < 0 : gap > 0)
                side[k] = DENSE_ELASTIC;
            wrong += side[k] != was;
            /* changing all nodes together may cycle: then one at a time */
            if (side[k] != was && !all)
                break;
        }
        if (wrong == 0)
            return;
        all = round < 60;
    }
    fail_msg("the active sets go round");
}

#endif
