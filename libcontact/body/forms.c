/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Stresses in a half-space, component by component, for a normal and for a tangential load.
 *
 * Of a unit force at the origin (Boussinesq, Cerruti; Johnson 1985, eqs. 3.19 and 3.75), times
 * 2 pi, with r = 1/R, w = 1/(R + z), c = 1 - 2 nu:
 *
 *     normal  sxx  c (z r^3 - w r + x^2 r^2 w (r + w)) - 3 x^2 z r^5
 *             sxy  c x y r^2 w (r + w) - 3 x y z r^5
 *             szz  -3 z^3 r^5         sxz  -3 x z^2 r^5         syz  -3 y z^2 r^5
 *     along x sxx  -3 x^3 r^5 + c x (r^3 - 3 r w^2 + x^2 r^2 w^2 (r + 2 w))
 *             syy  -3 x y^2 r^5 + c x r^2 w (z (r + w) + y^2 w (r + 2 w))
 *             sxy  -3 x^2 y r^5 + c y (x^2 r^2 w^2 (r + 2 w) - r w^2)
 *             szz  -3 x z^2 r^5       sxz  -3 x^2 z r^5         syz  -3 x y z r^5
 *
 * and syy of the normal one is sxx with x and y exchanged.
 *
 * Integrated over a cell these are differences over its corners (Love 1929 for the normal load). Here T1 =
 * atan2(XY, zR), T2 = atan2(XY, X^2 + z^2 + zR), LX = asinh(X / sqrt(Y^2 + z^2)):
 *
 *     normal  sxx  -2 nu T1 - c T2 + z XY / (R (X^2 + z^2))
 *             szz  -T1 - z XY / R (1/(X^2 + z^2) + 1/(Y^2 + z^2))
 *             sxy  -z/R - c ln(R + z)      sxz  z^2 Y / (R (X^2 + z^2))
 *     along x sxx  2 LY + 2 nu Y/(R + z) + z Y/(R (R + z)) - z^2 Y / (R (X^2 + z^2))
 *             syy  2 nu LY - 2 nu Y/(R + z) - z Y/(R (R + z))
 *             sxy  LX - 2 nu X/(R + z) - z X/(R (R + z))
 *             sxz  -T1 + z XY / (R (X^2 + z^2))   szz as sxz of the normal load   syz  -z/R
 *
 * The second argument of both arctangents is never negative, so no branch is crossed.
 *
 * Limits. At z = 0 the terms with a factor z are 0. On an edge or a corner of the cell the arctangents with X
 * = 0 or Y = 0 are 0. The sum over the corners is then the mean of the limits from all sides. So szz is -1/2
 * on an edge and -1/4 at a corner. Logarithms have no limit there (normal: sxy at corners; along x: sxx and
 * syy on the edges across x, sxy on those along it). They are evaluated at a small distance, `floor`.
 *
 * The periodic half-space under a wave of pressure or shear: q^2 = qx^2 + qy^2, each times
 * exp(-q z). Under a uniform load the limit q -> 0 depends on the direction of q.
 */
#include "forms.h"

#include <math.h>

/* ---- a point load ---- */

#define POINT(name, value)                                                                         \
    RC_WIDE_CLONES static void name##_point(const struct rc_points *s, double weight,              \
                                            double *restrict out)                                  \
    {                                                                                              \
        const double *restrict xs = s->x, *restrict ys = s->y;                                     \
        const double *restrict rs = s->r, *restrict ws = s->w;                                     \
        double z = s->z, c = 1 - 2 * s->nu;                                                        \
                                                                                                   \
        for (size_t i = 0; i < s->n; i++) {                                                        \
            double x = xs[i], y = ys[i], r = rs[i], w = ws[i], r2 = r * r;                         \
            (void)x, (void)y, (void)w, (void)z, (void)c, (void)r2;                                 \
            out[i] += weight * (value);                                                            \
        }                                                                                          \
    }

#define R3 (r * r2)
#define R5 (r * r2 * r2)
POINT(n_xx, c *(z *R3 - w * r + x * x * r2 * w * (r + w)) - 3 * z * x * x * R5)
POINT(n_yy, c *(z *R3 - w * r + y * y * r2 * w * (r + w)) - 3 * z * y * y * R5)
POINT(n_zz, -3 * z * z * z * R5)
POINT(n_xy, x *y *(c *r2 *w *(r + w) - 3 * z * R5))
POINT(n_xz, -3 * x * z * z * R5)
POINT(n_yz, -3 * y * z * z * R5)
POINT(t_xx, x *(c *(R3 - 3 * r * w * w + x * x * r2 * w * w * (r + 2 * w)) - 3 * x * x * R5))
POINT(t_yy, x *(c *r2 *w *(z *(r + w) + y * y * w * (r + 2 * w)) - 3 * y * y * R5))
POINT(t_xy, y *(c *(x *x *r2 *w *w *(r + 2 * w) - r * w * w) - 3 * x * x * R5))
POINT(t_xz, -3 * z * x * x * R5)
POINT(t_yz, -3 * z * x * y * R5)

/* ---- a cell, at a corner ---- */

static double
t1(const struct rc_corner *k)
{
    return atan2(k->x * k->y, k->z * k->r);
}

/* z XY / (R (X^2 + z^2)) and its like: 0 at the surface. */
static double
xy_x(const struct rc_corner *k)
{
    return k->z == 0 ? 0 : k->z * k->x * k->y / (k->r * (k->x * k->x + k->z * k->z));
}

static double
xy_y(const struct rc_corner *k)
{
    return k->z == 0 ? 0 : k->z * k->x * k->y / (k->r * (k->y * k->y + k->z * k->z));
}

/* asinh of a coordinate over the distance from the edge that runs along it. */
static double
along(const struct rc_corner *k, double coordinate, double other)
{
    return asinh(coordinate / fmax(hypot(other, k->z), k->floor));
}

/* 2 nu Y/(R + z) + z Y / (R (R + z)); Y may be X. */
static double
tilt(const struct rc_corner *k, double y)
{
    double w = k->r + k->z;

    return w == 0 ? 0 : (2 * k->nu + k->z / k->r) * y / w;
}

#define CORNER(name, value)                                                                        \
    static double name##_corner(const struct rc_corner *k)                                         \
    {                                                                                              \
        const double x = k->x, y = k->y, z = k->z, r = k->r, nu = k->nu, c = 1 - 2 * nu;           \
                                                                                                   \
        (void)x, (void)y, (void)z, (void)r, (void)nu, (void)c;                                     \
        return value;                                                                              \
    }

CORNER(n_xx, -2 * nu * t1(k) - c * atan2(x * y, x *x + z * (z + r)) + xy_x(k))
CORNER(n_yy, -2 * nu * t1(k) - c * atan2(x * y, y *y + z * (z + r)) + xy_y(k))
CORNER(n_zz, -t1(k) - xy_x(k) - xy_y(k))
CORNER(n_xy, (z == 0 ? 0 : -z / r) - c * log(fmax(r + z, k->floor)))
CORNER(n_xz, z == 0 ? 0 : z * z * y / (r * (x * x + z * z)))
CORNER(n_yz, z == 0 ? 0 : z * z * x / (r * (y * y + z * z)))
CORNER(t_xx, 2 * along(k, y, x) + tilt(k, y) - n_xz_corner(k))
CORNER(t_yy, 2 * nu * along(k, y, x) - tilt(k, y))
CORNER(t_xy, along(k, x, y) - tilt(k, x))
CORNER(t_xz, -t1(k) + xy_x(k))
CORNER(t_yz, z == 0 ? 0 : -z / r)

/* ---- a wave ---- */

#define SYMBOL(name, value)                                                                        \
    RC_WIDE_CLONES static void name##_symbol(const struct rc_waves *s, double z, double nu,        \
                                             double *restrict out)                                 \
    {                                                                                              \
        const double *restrict xs = s->x, *restrict ys = s->y;                                     \
        const double *restrict qs = s->q, *restrict decays = s->numbers;                           \
        double c = 1 - 2 * nu;                                                                     \
                                                                                                   \
        for (size_t i = 0; i < s->n; i++) {                                                        \
            double x = xs[i], y = ys[i], q = qs[i];                                                \
            (void)x, (void)y, (void)q, (void)z, (void)nu, (void)c;                                 \
            out[i] = (value)*decays[i];                                                            \
        }                                                                                          \
    }

SYMBOL(n_xx, -2 * nu - (c - z * q) * x * x)
SYMBOL(n_yy, -2 * nu - (c - z * q) * y * y)
SYMBOL(n_zz, -1 - z * q)
SYMBOL(n_xy, (c - z * q) * x * y)
SYMBOL(n_xz, -z *q *x)
SYMBOL(n_yz, -z *q *y)
SYMBOL(t_xx, -x *(2 * (1 + nu) - (2 * nu + z * q) * x * x))
SYMBOL(t_yy, -x *(2 * nu - (2 * nu + z * q) * y * y))
SYMBOL(t_xy, -y *(1 - (2 * nu + z * q) * x * x))
SYMBOL(t_xz, z *q *x *x - 1)
SYMBOL(t_yz, -z *q *x *y)

RC_WIDE_CLONES static void
directions(size_t n, const double *restrict qx, const double *restrict qy, double *restrict x,
           double *restrict y, double *restrict q)
{
    for (size_t k = 0; k < n; k++) {
        double size = sqrt(qx[k] * qx[k] + qy[k] * qy[k]), over = size > 0 ? 1 / size : 0;
        x[k] = qx[k] * over;
        y[k] = qy[k] * over;
        q[k] = size;
    }
}

void
rc_wave_directions(size_t n, const double *qx, const double *qy, double *x, double *y, double *q)
{
    directions(n, qx, qy, x, y, q);
}

/* ---- the components ---- */

/* Load, component, its forms above, its parity; szz under the shear is sxz under the pressure. The shear
 * along y needs no forms of its own. */
#define KERNELS                                                                                    \
    KERNEL(NORMAL, SXX, n_xx, 0)                                                                   \
    KERNEL(NORMAL, SYY, n_yy, 0)                                                                   \
    KERNEL(NORMAL, SZZ, n_zz, 0)                                                                   \
    KERNEL(NORMAL, SXY, n_xy, RC_ODD_X | RC_ODD_Y)                                                 \
    KERNEL(NORMAL, SXZ, n_xz, RC_ODD_X)                                                            \
    KERNEL(NORMAL, SYZ, n_yz, RC_ODD_Y)                                                            \
    KERNEL(SHEAR, SXX, t_xx, RC_ODD_X)                                                             \
    KERNEL(SHEAR, SYY, t_yy, RC_ODD_X)                                                             \
    KERNEL(SHEAR, SZZ, n_xz, RC_ODD_X)                                                             \
    KERNEL(SHEAR, SXY, t_xy, RC_ODD_Y)                                                             \
    KERNEL(SHEAR, SXZ, t_xz, 0)                                                                    \
    KERNEL(SHEAR, SYZ, t_yz, RC_ODD_X | RC_ODD_Y)
#define TURNED_KERNELS                                                                             \
    KERNEL(TURNED, SXX, , RC_ODD_Y)                                                                \
    KERNEL(TURNED, SYY, , RC_ODD_Y)                                                                \
    KERNEL(TURNED, SZZ, , RC_ODD_Y)                                                                \
    KERNEL(TURNED, SXY, , RC_ODD_X)                                                                \
    KERNEL(TURNED, SXZ, , RC_ODD_X | RC_ODD_Y)                                                     \
    KERNEL(TURNED, SYZ, , 0)

#define KERNEL(load, component, name, parity)                                                      \
    [RC_##load * RC_COMPONENTS + RC_##component] = {name##_point, name##_corner, name##_symbol},
const struct rc_stress_forms rc_stress_forms[RC_TURNED * RC_COMPONENTS] = {KERNELS};
#undef KERNEL

#define KERNEL(load, component, name, parity) [RC_##load * RC_COMPONENTS + RC_##component] = parity,
const unsigned rc_stress_parity[RC_STRESS_KERNELS] = {KERNELS TURNED_KERNELS};
#undef KERNEL
