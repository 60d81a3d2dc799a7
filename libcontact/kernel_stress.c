/*
 * Stresses inside a half-space under unit pressure on a cell dx x dy of its surface (Love 1929):
 * the double difference over the four corners of an antiderivative F,
 *
 *     s(x, y, z) = 1/(2 pi) sum +- F(x -+ dx/2, y -+ dy/2, z).
 *
 * With R^2 = X^2 + Y^2 + z^2, T1 = atan2(XY, zR), T2 = atan2(XY, X^2 + z^2 + zR):
 *
 *     sxx  -2 nu T1 - (1 - 2 nu) T2 + z XY / (R (X^2 + z^2));   syy with X and Y exchanged
 *     szz  -T1 - z XY / R (1/(X^2 + z^2) + 1/(Y^2 + z^2))
 *     sxy  -z/R - (1 - 2 nu) ln(R + z)
 *     sxz  z^2 Y / (R (X^2 + z^2));   syz with X and Y exchanged
 *
 * Both arctangents have a second argument that is never negative: no branch is crossed. Corners lie
 * between nodes, so X and Y are never 0 and the forms hold down to z = 0, where T1 is
 * +- pi/2. Their error is absolute, some 1e-16 of the pressure.
 */
#include "inside.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static double
normal_x(double nu, double x, double y, double z, double r)
{
    double t1 = atan2(x * y, z * r);
    double t2 = atan2(x * y, x * x + z * z + z * r);

    return -2 * nu * t1 - (1 - 2 * nu) * t2 + z * x * y / (r * (x * x + z * z));
}

static double
corner(enum rc_component component, double nu, double x, double y, double z)
{
    double r = sqrt(x * x + y * y + z * z);

    switch (component) {
    case RC_SXX:
        return normal_x(nu, x, y, z, r);
    case RC_SYY:
        return normal_x(nu, y, x, z, r);
    case RC_SZZ:
        return -atan2(x * y, z * r) -
               z * x * y / r * (1 / (x * x + z * z) + 1 / (y * y + z * z));
    case RC_SXY:
        return -z / r - (1 - 2 * nu) * log(r + z);
    case RC_SXZ:
        return z * z * y / (r * (x * x + z * z));
    default:
        return z * z * x / (r * (y * y + z * z));
    }
}

/* One line of corner differences F(x + dx/2, y) - F(x - dx/2, y) at x = i sx dx. At every node the
 * right corner of one is the left of the next. `lower`, where it stands, becomes the coefficient;
 * `next`, when not NULL, keeps the line. */
static void
difference(const struct rc_medium *m, enum rc_component component, const struct rc_lattice *at,
           double y, size_t n, double *lower, double *next)
{
    double half = at->dx / 2, right = 0;

    for (size_t i = 0; i < n; i++) {
        double x = (double)(i * at->sx) * at->dx;
        double left = i > 0 && at->sx == 1 ? right
                                           : corner(component, m->nu, x - half, y, m->depth);
        right = corner(component, m->nu, x + half, y, m->depth);
        if (lower != NULL)
            lower[i] = (right - left - lower[i]) / (2 * pi);
        if (next != NULL)
            next[i] = right - left;
    }
}

/* Each row is the difference of two lines of corners; at every node the upper line of one is the
 * lower line of the next. */
static void
rows(const struct rc_medium *m, size_t component, const struct rc_lattice *at, size_t n,
     size_t first, size_t last, double *out)
{
    double half = at->dy / 2;

    for (size_t j = first; j < last; j++, out += n) {
        double y = (double)(j * at->sy) * at->dy;
        bool keep = j + 1 < last && at->sy == 1;

        if (j == first || at->sy != 1)
            difference(m, component, at, y - half, n, NULL, out);
        difference(m, component, at, y + half, n, out, keep ? out + n : NULL);
    }
}

static const unsigned parity[RC_COMPONENTS] = {
    [RC_SXX] = 0,
    [RC_SYY] = 0,
    [RC_SZZ] = 0,
    [RC_SXY] = RC_ODD_X | RC_ODD_Y,
    [RC_SXZ] = RC_ODD_X,
    [RC_SYZ] = RC_ODD_Y,
};

const struct rc_kernel rc_kernel_stress = {
    .name = "stress",
    .summary = "the six stress components at a depth, Pa/Pa",
    .components = RC_COMPONENTS,
    .parity = parity,
    .rows = rows,
};
