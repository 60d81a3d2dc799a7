/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Two uniform half-spaces under tractions along their surfaces. q is the traction on body 1, p the pressure,
 * x = (x, y) the vector from the source, and r = |x|. Displacements are those of body 1 less those of body 2
 * (u_z: the sum of both, as K p):
 *
 *     u_t = 1/(pi E*) [ (1/r + kap x x'/r^3) q - beta x/r^2 p ]
 *     u_z = 1/(pi E*) [ p/r + beta x.q/r^2 ]                           (Johnson 1985, eq. 3.19 and 3.76)
 *
 * kap = sum(nu/G)/sum((1-nu)/G) over the bodies, and beta is Dundurs' constant: besides E* the response
 * depends on these two numbers only. The integrals over a cell have closed forms at its corners, which lose
 * accuracy far away: beyond five cells Gauss's rule is used.
 */
#include <math.h>

#include "body.h"
#include "quadrature.h"

/* ---- the bodies ---- */

/* nu/G, (1 - nu)/G and (1 - 2 nu)/G of a body, G = E/(2 (1 + nu)). */
static void
add_body(const struct rc_body *b, double side, double sum[3])
{
    double compliance = isinf(b->e) || b->e == 0 ? 0 : 2 * (1 + b->nu) / b->e;

    sum[0] += b->nu * compliance;
    sum[1] += (1 - b->nu) * compliance;
    sum[2] += side * (1 - 2 * b->nu) * compliance;
}

enum rc_status
rc_pair_shear(const struct rc_pair *pair, double nu, struct rc_shear *shear, struct rc_err *err)
{
    double sum[3] = {0, 0, 0};

    if (rc_pair_check(pair, err) != RC_OK)
        return RC_FAIL;
    if (pair->estar > 0) {
        if (!(nu > -1 && nu <= 0.5))
            return rc_err_set(
                err,
                "Poisson's ratio %g: it must be above -1 and at most 0.5, of both bodies alike",
                nu);
        *shear = (struct rc_shear){pair->estar, nu / (1 - nu), 0};
        return RC_OK;
    }
    if (pair->one.layers > 0 || pair->two.layers > 0)
        return rc_err_set(err, "the shear of a body under layers is not known: take bare bodies");
    add_body(&pair->one, 1, sum);
    add_body(&pair->two, -1, sum);
    *shear = (struct rc_shear){2 / sum[1], sum[0] / sum[1], sum[2] / (2 * sum[1])};
    return RC_OK;
}

/* ---- the integrals over a cell, for E* = 1/pi ---- */

enum {
    XX, /* x^2/r^3 */
    YY, /* y^2/r^3 */
    XY, /* xy/r^3  */
    X,  /* x/r^2   */
    Y,  /* y/r^2   */
    INTEGRALS
};

static double
corner(int integral, double x, double y)
{
    double r = hypot(x, y);

    switch (integral) {
    case XX:
        return y == 0 ? 0 : y * asinh(x / fabs(y));
    case YY:
        return x == 0 ? 0 : x * asinh(y / fabs(x));
    case XY:
        return -r;
    case X:
        return (y == 0 ? 0 : y * log(r)) + (x == 0 ? 0 : x * atan(y / x));
    default:
        return (x == 0 ? 0 : x * log(r)) + (y == 0 ? 0 : y * atan(x / y));
    }
}

static double
point(int integral, double x, double y)
{
    const double s = 1 / (x * x + y * y);
    const double of[INTEGRALS] = {[XX] = x * x, [YY] = y * y, [XY] = x * y, [X] = x, [Y] = y};

    return of[integral] * s * (integral < X ? sqrt(s) : 1);
}

/* The integral over the cell of half sides a, b with its middle at (x, y) from the point. */
static double
near(int integral, double x, double y, double a, double b)
{
    return (corner(integral, x + a, y + b) - corner(integral, x - a, y + b)) -
           (corner(integral, x + a, y - b) - corner(integral, x - a, y - b));
}

static double
far(int integral, int n, double x, double y, double a, double b)
{
    double sum = 0;

    for (int k = 0; k < n; k++)
        for (int l = 0; l < n; l++) {
            struct rc_gauss along = rc_gauss_point(n, k), across = rc_gauss_point(n, l);
            sum += along.w * across.w * point(integral, x - a * along.x, y - b * across.x);
        }
    return a * b * sum;
}

/* ---- the kernels ---- */

const unsigned rc_shear_parity[RC_SHEAR_KERNELS] = {
    [RC_SHEAR_XX] = 0,        [RC_SHEAR_YY] = 0,        [RC_SHEAR_XY] = RC_ODD_X | RC_ODD_Y,
    [RC_SHEAR_XZ] = RC_ODD_X, [RC_SHEAR_YZ] = RC_ODD_Y,
};

/* A kernel as the sum of two of the integrals, with their factors. */
struct sum {
    int integral[2];
    double factor[2];
};

static struct sum
sum_of(const struct rc_shear_field *f)
{
    const double kap = f->shear->kap, beta = f->shear->beta;
    const struct sum of[] = {
        [RC_SHEAR_XX] = {{XX, YY}, {1 + kap, 1}}, [RC_SHEAR_YY] = {{XX, YY}, {1, 1 + kap}},
        [RC_SHEAR_XY] = {{XY, XY}, {kap, 0}},     [RC_SHEAR_XZ] = {{X, X}, {beta, 0}},
        [RC_SHEAR_YZ] = {{Y, Y}, {beta, 0}},
    };

    return of[f->kernel];
}

static void
rows(const void *of, const struct rc_lattice *at, size_t n, size_t first, size_t last, double *out)
{
    const struct rc_shear_field *f = of;
    const struct sum sum = sum_of(f);
    double a = at->dx / 2, b = at->dy / 2, half = fmax(a, b), scale = 1 / (RC_PI * f->shear->estar);
    double low = 0, high = 0;
    int points = 0;

    for (size_t j = first; j < last; j++)
        for (size_t i = 0; i < n; i++, out++) {
            double x = (double)(i * at->sx) * at->dx, y = (double)(j * at->sy) * at->dy;
            double r = hypot(x, y);

            if (r < 10 * half)
                points = 0;
            else if (points == 0 || r < low || r >= high) {
                low = 0;
                high = INFINITY;
                points = rc_gauss_points(r, half, &low, &high);
            }
            *out = 0;
            for (int k = 0; k < 2; k++)
                if (sum.factor[k] != 0)
                    *out += scale * sum.factor[k] *
                            (points == 0 ? near(sum.integral[k], x, y, a, b)
                                         : far(sum.integral[k], points, x, y, a, b));
        }
}

/* Along the wave vector the half-space is stiffer by 1 + kap than across it. */
static double
symbol(const void *of, double qx, double qy)
{
    const struct rc_shear_field *f = of;
    const struct rc_shear *s = f->shear;
    double q = hypot(qx, qy), x = qx / q, y = qy / q, normal = 2 / (s->estar * q);
    const double by_kernel[] = {
        [RC_SHEAR_XX] = normal * (1 + s->kap * y * y),
        [RC_SHEAR_YY] = normal * (1 + s->kap * x * x),
        [RC_SHEAR_XY] = normal * s->kap * x * y,
        [RC_SHEAR_XZ] = normal * s->beta * x,
        [RC_SHEAR_YZ] = normal * s->beta * y,
    };

    return by_kernel[f->kernel];
}

struct rc_kernel
rc_shear_kernel(const struct rc_shear_field *field)
{
    return (struct rc_kernel){
        .of = field, .parity = rc_shear_parity[field->kernel], .rows = rows, .symbol = symbol};
}
