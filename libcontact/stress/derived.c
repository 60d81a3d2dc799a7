/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Stresses derived from the six components, point by point.
 */
#include "stress.h"

#include <math.h>

RC_WIDE_CLONES static void
mises(size_t n, const double *const s[RC_COMPONENTS], double *restrict out)
{
    const double *restrict xx = s[RC_SXX], *restrict yy = s[RC_SYY], *restrict zz = s[RC_SZZ];
    const double *restrict xy = s[RC_SXY], *restrict xz = s[RC_SXZ], *restrict yz = s[RC_SYZ];

    for (size_t k = 0; k < n; k++) {
        double a = xx[k] - yy[k], b = yy[k] - zz[k], c = zz[k] - xx[k];
        double t = xy[k] * xy[k] + xz[k] * xz[k] + yz[k] * yz[k];
        out[k] = sqrt((a * a + b * b + c * c) / 2 + 3 * t);
    }
}

/* The smallest and the largest of n values, without NaN. */
RC_WIDE_CLONES static void
extremes(size_t n, const double *v, double *least, double *largest)
{
    double low[8], high[8];

    for (size_t i = 0; i < 8; i++)
        low[i] = INFINITY, high[i] = -INFINITY;
    for (size_t k = 0; k + 8 <= n; k += 8)
        for (size_t i = 0; i < 8; i++) {
            low[i] = v[k + i] < low[i] ? v[k + i] : low[i];
            high[i] = v[k + i] > high[i] ? v[k + i] : high[i];
        }
    for (size_t k = n / 8 * 8; k < n; k++) {
        low[0] = fmin(low[0], v[k]);
        high[0] = fmax(high[0], v[k]);
    }
    for (size_t i = 1; i < 8; i++) {
        low[0] = fmin(low[0], low[i]);
        high[0] = fmax(high[0], high[i]);
    }
    *least = low[0];
    *largest = high[0];
}

static size_t
first_of(size_t n, const double *v, size_t from, double value)
{
    for (size_t k = from; k < n; k++)
        if (v[k] == value)
            return k;
    return 0;
}

void
rc_extremes(size_t n, const double *v, size_t *least, size_t *largest)
{
    enum {
        PIECE = 4096 /* values processed together: they fit into the first cache */
    };
    double low = INFINITY, high = -INFINITY;
    size_t of_low = 0, of_high = 0;

    for (size_t k = 0; k < n; k += PIECE) {
        double a, b;
        extremes(n - k < PIECE ? n - k : PIECE, v + k, &a, &b);
        of_low = a < low ? k : of_low;
        of_high = b > high ? k : of_high;
        low = fmin(low, a);
        high = fmax(high, b);
    }
    *least = first_of(n, v, of_low, low);
    *largest = first_of(n, v, of_high, high);
}

/* ---- principal stresses ---- */

static void
cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double
dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* A unit eigenvector of B for `eigenvalue`: the cross product of the two least parallel rows of B -
 * eigenvalue. */
static void
eigenvector(double B[3][3], double eigenvalue, double v[3])
{
    double row[3][3], best = 0;

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            row[i][j] = B[i][j] - (i == j ? eigenvalue : 0);
    for (int i = 0; i < 3; i++) {
        double c[3], size;
        cross(row[i], row[(i + 1) % 3], c);
        size = sqrt(dot(c, c));
        for (int j = 0; size > best && j < 3; j++)
            v[j] = c[j] / size;
        best = fmax(best, size);
    }
}

/* Two unit vectors orthogonal to v and to each other. */
static void
frame(const double v[3], double a[3], double b[3])
{
    int least = fabs(v[0]) <= fabs(v[1]) && fabs(v[0]) <= fabs(v[2]) ? 0
                : fabs(v[1]) <= fabs(v[2])                           ? 1
                                                                     : 2;
    double axis[3] = {0}, size;

    axis[least] = 1;
    cross(v, axis, a);
    size = sqrt(dot(a, a));
    for (int j = 0; j < 3; j++)
        a[j] /= size;
    cross(v, a, b);
}

static double
between(double B[3][3], const double a[3], const double b[3])
{
    double sum = 0;

    for (int i = 0; i < 3; i++)
        sum += a[i] * dot(B[i], b);
    return sum;
}

/*
 * With m the mean of the diagonal and r^2 a sixth of the squared deviator, the eigenvalues of the deviator
 * over r are 2 cos(phi - 2 pi k / 3), cos 3 phi = det / 2 (Smith 1961, Comm. ACM 4, 168). Where two of them
 * are close, phi is accurate to half of the digits only. But the third eigenvalue is accurate; the two are
 * then computed from the matrix orthogonal to its eigenvector (Scherzinger and Dohrmann 2008, Comput. Methods
 * Appl. Mech. Eng. 197, 4007).
 */
static void
principal(const double *const s[RC_COMPONENTS], size_t k, double e[3])
{
    static const double third = 2.0943951023931954923; /* 2 pi / 3 */
    double m = (s[RC_SXX][k] + s[RC_SYY][k] + s[RC_SZZ][k]) / 3;
    double B[3][3] = {{s[RC_SXX][k] - m, s[RC_SXY][k], s[RC_SXZ][k]},
                      {s[RC_SXY][k], s[RC_SYY][k] - m, s[RC_SYZ][k]},
                      {s[RC_SXZ][k], s[RC_SYZ][k], s[RC_SZZ][k] - m}};
    double r = sqrt((dot(B[0], B[0]) + dot(B[1], B[1]) + dot(B[2], B[2])) / 6);
    double v[3] = {0}, a[3], b[3], c[3], det, phi, lone, aa, bb, half, middle;

    e[0] = e[1] = e[2] = m;
    if (!(r > 0))
        return;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            B[i][j] /= r;
    cross(B[1], B[2], c);
    det = fmax(-2, fmin(2, dot(B[0], c)));
    phi = acos(det / 2) / 3;
    lone = 2 * cos(det >= 0 ? phi : phi + third);
    eigenvector(B, lone, v);
    frame(v, a, b);
    aa = between(B, a, a);
    bb = between(B, b, b);
    half = hypot((aa - bb) / 2, between(B, a, b));
    middle = (aa + bb) / 2;
    e[det >= 0 ? 0 : 2] = m + r * lone;
    e[det >= 0 ? 1 : 0] = m + r * (middle + half);
    e[det >= 0 ? 2 : 1] = m + r * (middle - half);
}

void
rc_stress_derive(unsigned wanted, size_t n, const double *const s[RC_COMPONENTS],
                 double *const out[RC_STRESSES])
{
    if (wanted >> RC_MISES & 1)
        mises(n, s, out[RC_MISES]);
    if (wanted >> RC_TRESCA == 0)
        return;
    for (size_t k = 0; k < n; k++) {
        double e[3];
        principal(s, k, e);
        if (wanted >> RC_TRESCA & 1)
            out[RC_TRESCA][k] = e[0] - e[2];
        for (int i = 0; i < 3; i++)
            if (wanted >> (RC_S1 + i) & 1)
                out[RC_S1 + i][k] = e[i];
    }
}
