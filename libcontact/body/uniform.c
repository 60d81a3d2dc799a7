/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A half-space of one material. The normal displacement of its surface under unit pressure on a cell dx x dy:
 *
 *     K(x, y) = 1/(pi E*) integral over the cell of 1/|r - r'|       (Johnson 1985, eq. 3.25)
 *
 * Three forms, because no single one is accurate everywhere. Near the cell Love's closed form holds (Johnson
 * eq. 3.25). Its four terms grow with r while their sum decreases as 1/r, so its relative error grows as
 * (r/h)^2. From five cells: Gauss's rule with 6 x 6 points, whose error is below rounding. From forty cells:
 * Taylor's series of 1/r about the centre of the cell to sixth order, whose next term is below rounding.
 */
#include "uniform.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "quadrature.h"

/* Antiderivative of 1/r in x and y (Love 1929). */
static double
corner(double x, double y)
{
    double a = x == 0 ? 0 : x * asinh(y / fabs(x));
    double b = y == 0 ? 0 : y * asinh(x / fabs(y));

    return a + b;
}

double
rc_love(double x, double y, double a, double b)
{
    return (corner(x + a, y + b) - corner(x - a, y + b)) -
           (corner(x + a, y - b) - corner(x - a, y - b));
}

static double
middle(double x, double y, double a, double b)
{
    double sum = 0;

    for (int k = 0; k < 6; k++)
        for (int l = 0; l < 6; l++) {
            struct rc_gauss along = rc_gauss_point(6, k), across = rc_gauss_point(6, l);
            double u = x - a * along.x, v = y - b * across.x;
            sum += along.w * across.w / sqrt(u * u + v * v);
        }
    return a * b * sum;
}

/* Adds to out[i] for first <= i < n, x = i dx, the integral by the series. The derivatives of 1/r of order 2j
 * in x and 2k in y, times r^(2j+2k+1), are polynomials in X = (x/r)^2 and Y = (y/r)^2; integration multiplies
 * them by a^(2j) b^(2k) / ((2j+1)! (2k+1)!). */
RC_CLONES static void
far(double scale, double dx, double y, double a, double b, size_t first, size_t n, double *out)
{
    for (size_t i = first; i < n; i++) {
        double x = (double)(int)i * dx;
        double s = 1 / (x * x + y * y);
        double X = x * x * s, Y = y * y * s, A = a * a * s, B = b * b * s;
        double second = A * (3 * X - 1) + B * (3 * Y - 1);
        double fourth = A * A * ((105 * X - 90) * X + 9) / 120 + A * B * (105 * X * Y - 12) / 36 +
                        B * B * ((105 * Y - 90) * Y + 9) / 120;
        double x4y2 = 10395 * X * X * Y - 945 * X * (6 * Y + X) + 105 * (3 * Y + 6 * X) - 45;
        double x2y4 = 10395 * X * Y * Y - 945 * Y * (6 * X + Y) + 105 * (3 * X + 6 * Y) - 45;
        double sixth = (A * A * A * (((10395 * X - 14175) * X + 4725) * X - 225) +
                        B * B * B * (((10395 * Y - 14175) * Y + 4725) * Y - 225)) /
                           5040 +
                       A * B * (A * x4y2 + B * x2y4) / 720;

        out[i] += scale * 4 * a * b * sqrt(s) * (1 + second / 6 + fourth + sixth);
    }
}

void
rc_uniform_add_rows(double estar, const struct rc_lattice *at, size_t n, size_t first, size_t last,
                    double *out)
{
    double a = at->dx / 2, b = at->dy / 2, largest = fmax(at->dx, at->dy);
    double dx = (double)at->sx * at->dx, dy = (double)at->sy * at->dy;
    double scale = 1 / (RC_PI * estar);
    double near_r = 5 * largest, far_r = 40 * largest;

    for (size_t j = first; j < last; j++, out += n) {
        double y = (double)j * dy;
        double w = far_r > y ? sqrt(far_r * far_r - y * y) / dx : 0;
        size_t inner = w < (double)n ? (size_t)ceil(w) : n;

        for (size_t i = 0; i < inner; i++) {
            double x = (double)i * dx;
            out[i] += scale *
                      (x * x + y * y < near_r * near_r ? rc_love(x, y, a, b) : middle(x, y, a, b));
        }
        far(scale, dx, y, a, b, inner, n, out);
    }
}

/* ---- displacements for E* = 1 ---- */

static void
rows_of_one(const void *of, const struct rc_lattice *at, size_t n, size_t first, size_t last,
            double *out)
{
    (void)of;
    memset(out, 0, (last - first) * n * sizeof *out);
    rc_uniform_add_rows(1, at, n, first, last, out);
}

static double
symbol_of_one(const void *of, double qx, double qy)
{
    (void)of;
    return 2 / hypot(qx, qy);
}

const struct rc_kernel rc_kernel_of_one = {.rows = rows_of_one, .symbol = symbol_of_one};

/* ---- the row ---- */

struct uniform {
    struct rc_solid solid;
    double estar, nu;
};

static bool
takes(const struct rc_body *b)
{
    return b->layers == 0;
}

static enum rc_status
check(const struct rc_body *b, enum rc_use use, struct rc_err *err)
{
    if (use == RC_SURFACE && !(b->e > 0))
        return rc_err_set(err, "Young's modulus of a body is %g Pa: it must be positive", b->e);
    if (!(b->nu > -1 && b->nu <= 0.5))
        return rc_err_set(err, "Poisson's ratio %g: it must be above -1 and at most 0.5", b->nu);
    return RC_OK;
}

static struct rc_solid *
make(double estar, double nu, struct rc_err *err)
{
    struct uniform *u = malloc(sizeof *u);

    if (u == NULL)
        return rc_err_null(err, "out of memory for a body");
    *u = (struct uniform){{&rc_body_uniform}, estar, nu};
    return &u->solid;
}

struct rc_solid *
rc_uniform_new(double estar, struct rc_err *err)
{
    return make(estar, NAN, err);
}

double
rc_uniform_nu(const struct rc_solid *s)
{
    return ((const struct uniform *)s)->nu;
}

static double
compliance(const struct rc_body *b)
{
    return isinf(b->e) ? 0 : (1 - b->nu * b->nu) / b->e;
}

static struct rc_solid *
solid_new(const struct rc_body *b, struct rc_err *err)
{
    return make(1 / compliance(b), b->nu, err);
}

static void
solid_free(struct rc_solid *s)
{
    free(s);
}

static double
estar_of(const struct rc_solid *s)
{
    return ((const struct uniform *)s)->estar;
}

static double
modulus(const struct rc_solid *s, double q)
{
    (void)q;
    return estar_of(s);
}

static void
add_rows(const struct rc_solid *s, double length, double modulus, const struct rc_lattice *at,
         size_t n, size_t first, size_t last, double *out)
{
    (void)length; /* a half-space has no length of its own */
    rc_uniform_add_rows(estar_of(s) / modulus, at, n, first, last, out);
}

const struct rc_body_type rc_body_uniform = {
    .name = "uniform",
    .summary = "a half-space of one material",
    .takes = takes,
    .check = check,
    .new = solid_new,
    .free = solid_free,
    .compliance = compliance,
    .positive = true,
    .modulus = modulus,
    .modulus_of = modulus,
    .softest = estar_of,
    .add_rows = add_rows,
    .inside = &rc_uniform_inside,
};
