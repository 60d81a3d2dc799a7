/*
 * Normal displacement of the surface of a half-space under unit pressure on a cell dx x dy:
 *
 *     K(x, y) = 1/(pi E*) integral over the cell of 1/|r - r'|       (Johnson 1985, eq. 3.25)
 *
 * Three forms, because no single one keeps its digits everywhere. Near the cell Love's closed form
 * (Johnson eq. 3.25), whose four terms grow with r while their sum falls as 1/r: it loses
 * (r/h)^2 in relative accuracy. Farther out Gauss's rule with 6 x 6 points, whose error at five
 * cells is below rounding. Far away Taylor's series of 1/r about the centre of the cell to sixth
 * order, whose next term at forty cells is below rounding.
 */
#include "body.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Antiderivative of 1/r in x and y (Love 1929). */
static double
corner(double x, double y)
{
    double a = x == 0 ? 0 : x * asinh(y / fabs(x));
    double b = y == 0 ? 0 : y * asinh(x / fabs(y));

    return a + b;
}

static double
near(double x, double y, double a, double b)
{
    return (corner(x + a, y + b) - corner(x - a, y + b)) -
           (corner(x + a, y - b) - corner(x - a, y - b));
}

/* Abscissas and weights of Gauss's six-point rule on (-1, 1) (Abramowitz and Stegun 1964, 25.4). */
static const double gauss_x[6] = {-0.932469514203152028, -0.661209386466264514,
                                  -0.238619186083196909, 0.238619186083196909,
                                  0.661209386466264514,  0.932469514203152028};
/* clang-format off */
static const double gauss_w[6] = {0.171324492379170345, 0.360761573048138608,
                                  0.467913934572691047, 0.467913934572691047,
                                  0.360761573048138608, 0.171324492379170345};
/* clang-format on */

static double
middle(double x, double y, double a, double b)
{
    double sum = 0;

    for (int k = 0; k < 6; k++)
        for (int l = 0; l < 6; l++) {
            double u = x - a * gauss_x[k], v = y - b * gauss_x[l];
            sum += gauss_w[k] * gauss_w[l] / sqrt(u * u + v * v);
        }
    return a * b * sum;
}

/* out[i] for first <= i < n at x = i dx. The derivatives of 1/r of order 2j in x and 2k in y, times
 * r^(2j+2k+1), are polynomials in X = (x/r)^2 and Y = (y/r)^2; the integral of the series takes
 * a^(2j) b^(2k) / (2j+1)! (2k+1)!. */
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

        out[i] = scale * 4 * a * b * sqrt(s) * (1 + second / 6 + fourth + sixth);
    }
}

static void
rows(const struct rc_medium *medium, size_t component, const struct rc_lattice *at, size_t n,
     size_t first, size_t last, double *out)
{
    double a = at->dx / 2, b = at->dy / 2, largest = fmax(at->dx, at->dy);
    double dx = (double)at->sx * at->dx, dy = (double)at->sy * at->dy;
    double scale = 1 / (pi * medium->estar);
    double near_r = 5 * largest, far_r = 40 * largest;

    (void)component;
    for (size_t j = first; j < last; j++, out += n) {
        double y = (double)j * dy;
        double w = far_r > y ? sqrt(far_r * far_r - y * y) / dx : 0;
        size_t inner = w < (double)n ? (size_t)ceil(w) : n;

        for (size_t i = 0; i < inner; i++) {
            double x = (double)i * dx;
            out[i] =
                scale * (x * x + y * y < near_r * near_r ? near(x, y, a, b) : middle(x, y, a, b));
        }
        far(scale, dx, y, a, b, inner, n, out);
    }
}

/* Westergaard 1939: a wave of pressure of wave number q makes a wave of displacement 2 / (E* q) as
 * high. */
static double
symbol(const struct rc_medium *medium, size_t component, double qx, double qy)
{
    (void)component;
    return 2 / (medium->estar * hypot(qx, qy));
}

static const unsigned parity[] = {0};

const struct rc_kernel rc_kernel_boussinesq = {
    .info = {.name = "boussinesq",
             .summary = "normal displacement of the surface, m/Pa",
             .components = 1},
    .parity = parity,
    .rows = rows,
    .symbol = symbol,
};
