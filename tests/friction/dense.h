/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tractions of minimal energy by another method with dense matrices. One node after another is minimised
 * exactly on its disc until nothing changes. Newton's method finds the displacement of a force. */
#ifndef DENSE_H
#define DENSE_H

#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_bessel.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "libcontact/contact.h"
#include "tests/exact.h"

enum {
    DENSE_MOST = 64
};

struct dense {
    size_t n;
    double t[2 * DENSE_MOST]
            [2 * DENSE_MOST]; /* u = T q, first the x components of all nodes, then y */
    double g[DENSE_MOST], w[2 * DENSE_MOST];
};

/* The columns of T from the closed form for a uniform rectangle, E* = 1 (Love 1929, as in Johnson 1985,
 * section 3.5). truth_slip_kernel compares them with integrals of point loads. */
static inline double
corner(int kind, double x, double y)
{
    double a = y == 0 ? 0 : y * asinh(x / fabs(y)), b = x == 0 ? 0 : x * asinh(y / fabs(x));

    return kind == 0 ? a : kind == 1 ? b : -hypot(x, y);
}

static inline double
rectangle(int kind, double x, double y, double dx, double dy)
{
    return (corner(kind, x + dx / 2, y + dy / 2) - corner(kind, x - dx / 2, y + dy / 2) -
            corner(kind, x + dx / 2, y - dy / 2) + corner(kind, x - dx / 2, y - dy / 2)) /
           exact_pi;
}

static inline void
dense_matrix(struct dense *d, const struct rc_shape *s, double kap)
{
    d->n = s->nx * s->ny;
    for (size_t i = 0; i < d->n; i++)
        for (size_t j = 0; j < d->n; j++) {
            double x = ((double)(i % s->nx) - (double)(j % s->nx)) * s->dx;
            double y = ((double)(i / s->nx) - (double)(j / s->nx)) * s->dy;
            double xx = rectangle(0, x, y, s->dx, s->dy), yy = rectangle(1, x, y, s->dx, s->dy);
            double xy = rectangle(2, x, y, s->dx, s->dy);
            d->t[i][j] = (1 + kap) * xx + yy;
            d->t[d->n + i][d->n + j] = xx + (1 + kap) * yy;
            d->t[i][d->n + j] = d->t[d->n + i][j] = kap * xy;
        }
}

/* The same on a periodic map, from the response to a wave. It is 2/k along it and 2(1 + kap)/k across it; 0
 * for the mean, and 0 across for waves of two nodes. */
static inline void
periodic_matrix(struct dense *d, const struct rc_shape *s, double kap)
{
    d->n = s->nx * s->ny;
    memset(d->t, 0, sizeof d->t);
    for (size_t wave = 1; wave < d->n; wave++) {
        size_t a = wave % s->nx, b = wave / s->nx;
        double kx = 2 * exact_pi * ((double)a - (2 * a > s->nx ? (double)s->nx : 0)) /
                    ((double)s->nx * s->dx);
        double ky = 2 * exact_pi * ((double)b - (2 * b > s->ny ? (double)s->ny : 0)) /
                    ((double)s->ny * s->dy);
        double k2 = kx * kx + ky * ky, unit = 2 / (sqrt(k2) * (double)d->n);
        bool nyquist = 2 * a == s->nx || 2 * b == s->ny;
        for (size_t i = 0; i < d->n; i++)
            for (size_t j = 0; j < d->n; j++) {
                double x = ((double)(i % s->nx) - (double)(j % s->nx)) * s->dx;
                double y = ((double)(i / s->nx) - (double)(j / s->nx)) * s->dy;
                double wavy = unit * cos(kx * x + ky * y);
                double cross = nyquist ? 0 : -kap * kx * ky / k2 * wavy;
                d->t[i][j] += (1 + kap * ky * ky / k2) * wavy;
                d->t[d->n + i][d->n + j] += (1 + kap * kx * kx / k2) * wavy;
                d->t[i][d->n + j] += cross;
                d->t[d->n + i][j] += cross;
            }
    }
}

/* A map that repeats along one axis. The field of a wave Q along this axis, times 1 on a cell of the other
 * one, is the integral of 1/r, x^2/r^3 ... over the wave (Gradshteyn and Ryzhik, section 3.77), and over the
 * cell. K0, K1: Bessel functions; z = Q x. For Q = 0 the load is on a line. E* = 1. */
enum line {
    LINE_ACROSS,      /* displacement along the free axis by a traction along it */
    LINE_ALONG,       /* the same along the axis that repeats                    */
    LINE_CROSS,       /* along one axis by a traction along the other            */
    LINE_PUSH_ACROSS, /* displacement along the free axis by a pressure          */
    LINE_PUSH_ALONG
};
struct line_pair {
    double kap, beta, datum;
};

static const double line_far = 600; /* K0 and K1 are 0 to rounding there, and do not underflow */

static inline double
line_k0(double z, void *none)
{
    (void)none;
    return z > 0 && z < line_far ? gsl_sf_bessel_K0(z) : 0;
}

/* From 0 to z. */
static inline double
line_integral_of_k0(double z)
{
    const gsl_function f = {line_k0, NULL};
    gsl_integration_workspace *room = gsl_integration_workspace_alloc(200);
    double value, error;

    gsl_integration_qags(&f, 0, fmin(fabs(z), 50), 0, 1e-13, 200, room, &value, &error);
    gsl_integration_workspace_free(room);
    return copysign(value, z);
}

/* The integral of the field over x, for a wave Q >= 0. */
static inline double
line_integral(enum line what, const struct line_pair *pair, double q, double x)
{
    const double z = q * x, size = fabs(z), part = 2 / (exact_pi * q), kap = pair->kap;

    if (q == 0)
        return what == LINE_PUSH_ACROSS ? pair->beta * fabs(x)
                                        : -2 / exact_pi * (what == LINE_ALONG ? 1 + kap : 1) * x *
                                              (log(fabs(x) / pair->datum) - 1);
    switch (what) {
    case LINE_ACROSS: /* of K0 + kap |z| K1 */
        return part * ((1 + kap) * line_integral_of_k0(z) - kap * z * line_k0(size, NULL));
    case LINE_ALONG: /* of (1 + kap) K0 - kap |z| K1 */
        return part * (line_integral_of_k0(z) + kap * z * line_k0(size, NULL));
    case LINE_CROSS: /* of kap z K0 */
        return size < line_far ? -part * kap * size * gsl_sf_bessel_K1(size) : 0;
    case LINE_PUSH_ACROSS:
        return pair->beta / q * (1 - exp(-size));
    default:
        return pair->beta / q * copysign(1 - exp(-size), x);
    }
}

/* The displacement at a node by a load on the node that is so many columns and rows before it. */
static inline double
line_at(enum line what, const struct rc_shape *s, struct rc_boundary boundary,
        const struct line_pair *pair, double columns, double rows)
{
    const size_t n = boundary.x ? s->nx : s->ny;
    const double cell = boundary.x ? s->dy : s->dx,
                 length = (double)n * (boundary.x ? s->dx : s->dy);
    const double x = (boundary.x ? rows : columns) * cell,
                 phase = (boundary.x ? columns : rows) / (double)n;
    const bool odd = what == LINE_CROSS || what == LINE_PUSH_ALONG;
    double sum = 0;

    for (size_t m = odd; m < n; m++) {
        const double wave = (double)m - (2 * m > n ? (double)n : 0),
                     q = 2 * exact_pi * fabs(wave) / length;
        const double of = 2 * exact_pi * wave * phase;
        if (!(odd && 2 * m == n))
            sum += (odd ? (wave > 0 ? sin(of) : -sin(of)) : cos(of)) / (double)n *
                   (line_integral(what, pair, q, x + cell / 2) -
                    line_integral(what, pair, q, x - cell / 2));
    }
    return sum;
}

static inline void
line_matrix(struct dense *d, const struct rc_shape *s, struct rc_boundary boundary, double kap)
{
    const struct line_pair pair = {kap, 0, rc_boundary_on(s, boundary).datum};
    const enum line x = boundary.x ? LINE_ALONG : LINE_ACROSS,
                    y = boundary.x ? LINE_ACROSS : LINE_ALONG;
    const size_t n = d->n = s->nx * s->ny;
    double table[3][DENSE_MOST];

    for (size_t k = 0; k < n; k++) {
        const double i = (double)(k % s->nx), j = (double)(k / s->nx);
        table[0][k] = line_at(x, s, boundary, &pair, i, j);
        table[1][k] = line_at(y, s, boundary, &pair, i, j);
        table[2][k] = line_at(LINE_CROSS, s, boundary, &pair, i, j);
    }
    for (size_t at = 0; at < n; at++)
        for (size_t from = 0; from < n; from++) {
            const int i = (int)(at % s->nx) - (int)(from % s->nx);
            const int j = (int)(at / s->nx) - (int)(from / s->nx);
            const size_t k = (size_t)abs(j) * s->nx + (size_t)abs(i);
            d->t[at][from] = table[0][k];
            d->t[n + at][n + from] = table[1][k];
            d->t[at][n + from] = d->t[n + at][from] =
                (i < 0) == (j < 0) ? table[2][k] : -table[2][k];
        }
}

/* The matrix of this boundary. */
static inline void
matrix_of(struct dense *d, const struct rc_shape *s, struct rc_boundary boundary, double kap)
{
    if (rc_repeats(boundary) == 1)
        line_matrix(d, s, boundary, kap);
    else
        (rc_has_mean(boundary) ? dense_matrix : periodic_matrix)(d, s, kap);
}

/* min q'A q/2 - b'q over |q| <= g, A 2 x 2. (A + m)q = b, with the m >= 0 that puts q on the circle;
 * bisection finds m to the last bit. */
static inline void
on_disc(const double a[3], const double b[2], double g, double q[2])
{
    double low = 0, high = hypot(b[0], b[1]) / g + 1, m = 0;

    for (int k = 0; k < 200; k++) {
        double det = (a[0] + m) * (a[1] + m) - a[2] * a[2];
        q[0] = ((a[1] + m) * b[0] - a[2] * b[1]) / det;
        q[1] = ((a[0] + m) * b[1] - a[2] * b[0]) / det;
        if (hypot(q[0], q[1]) <= g) {
            if (m == 0)
                return;
            high = m;
        } else {
            low = m;
        }
        m = (low + high) / 2;
    }
}

static inline void
relax(const struct dense *d, const double delta[2], double *q)
{
    for (int sweep = 0; sweep < 20000; sweep++) {
        double change = 0, size = 0;
        for (size_t i = 0; i < d->n; i++) {
            size_t at[2] = {i, d->n + i};
            if (d->g[i] == 0) {
                q[at[0]] = q[at[1]] = 0;
                continue;
            }
            double a[3] = {d->t[at[0]][at[0]], d->t[at[1]][at[1]], d->t[at[0]][at[1]]}, b[2], x[2];
            for (int c = 0; c < 2; c++) {
                b[c] = d->w[at[c]] + delta[c];
                for (size_t j = 0; j < 2 * d->n; j++)
                    if (j != at[0] && j != at[1])
                        b[c] -= d->t[at[c]][j] * q[j];
            }
            on_disc(a, b, d->g[i], x);
            for (int c = 0; c < 2; c++) {
                change = fmax(change, fabs(x[c] - q[at[c]]));
                size = fmax(size, fabs(x[c]));
                q[at[c]] = x[c];
            }
        }
        if (change <= 1e-15 * size)
            break;
    }
}

static inline void
sum_of(const struct dense *d, const double *q, double sum[2])
{
    sum[0] = sum[1] = 0;
    for (size_t i = 0; i < d->n; i++) {
        sum[0] += q[i];
        sum[1] += q[d->n + i];
    }
}

/* The displacement under which the tractions carry `load`; returns the part of the load that is missing.
 * Their sum is the gradient of a convex function of the displacement; Newton's method is damped until it
 * does not overshoot. */
static inline double
carry(const struct dense *d, const double load[2], double delta[2], double *q)
{
    double size = 0, off = INFINITY;

    for (size_t i = 0; i < d->n; i++)
        size += d->g[i];
    for (int step = 0; step < 100; step++) {
        double f[2], j[2][2], h = 1e-6, trial[2 * DENSE_MOST], det, move[2], part = 1, there[2];
        relax(d, delta, q);
        sum_of(d, q, f);
        f[0] -= load[0];
        f[1] -= load[1];
        off = hypot(f[0], f[1]) / size;
        if (off < 1e-14)
            break;
        for (int c = 0; c < 2; c++) {
            double other[2] = {delta[0], delta[1]};
            double step_size = h * (1 + fabs(delta[c]));
            other[c] += step_size;
            memcpy(trial, q, sizeof trial);
            relax(d, other, trial);
            sum_of(d, trial, there);
            for (int r = 0; r < 2; r++)
                j[r][c] = (there[r] - load[r] - f[r]) / step_size;
        }
        /* if all nodes slide in one direction the derivative is 0: a small number is added */
        for (int c = 0; c < 2; c++)
            j[c][c] += 1e-6;
        det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        move[0] = -(j[1][1] * f[0] - j[0][1] * f[1]) / det;
        move[1] = -(j[0][0] * f[1] - j[1][0] * f[0]) / det;
        for (;; part /= 2) {
            double other[2] = {delta[0] + part * move[0], delta[1] + part * move[1]};
            memcpy(trial, q, sizeof trial);
            relax(d, other, trial);
            sum_of(d, trial, there);
            if (hypot(there[0] - load[0], there[1] - load[1]) < hypot(f[0], f[1]) || part < 1e-8)
                break;
        }
        delta[0] += part * move[0];
        delta[1] += part * move[1];
    }
    return off;
}

#endif
