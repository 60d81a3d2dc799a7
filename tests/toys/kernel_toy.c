/*
 * A kernel that is no part of the library: a file and a row of a list. The surface gives way as
 *
 *     K(x, y) = 1/(pi E* L) integral over the cell of exp(-r / L),    L the medium's depth,
 *
 * taken at the middle of the cell: short-ranged, even, with a symbol of its own.
 */
#include "libcontact/operator/operator.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static void
rows(const struct rc_medium *medium, size_t component, const struct rc_lattice *at, size_t n,
     size_t first, size_t last, double *out)
{
    double scale = at->dx * at->dy / (pi * medium->estar * medium->depth);

    (void)component;
    for (size_t j = first; j < last; j++)
        for (size_t i = 0; i < n; i++) {
            double x = (double)(i * at->sx) * at->dx, y = (double)(j * at->sy) * at->dy;
            *out++ = scale * exp(-hypot(x, y) / medium->depth);
        }
}

/* The transform of exp(-r / L) over the plane is 2 pi L^2 / (1 + q^2 L^2)^(3/2). */
static double
symbol(const struct rc_medium *medium, size_t component, double qx, double qy)
{
    double qL = hypot(qx, qy) * medium->depth;

    (void)component;
    return 2 * medium->depth / (medium->estar * pow(1 + qL * qL, 1.5));
}

static const unsigned parity[] = {0};

const struct rc_kernel rc_kernel_toy = {
    .info = {.name = "toy", .summary = "exp(-r / L) of a unit pressure, m/Pa", .components = 1},
    .parity = parity,
    .rows = rows,
    .symbol = symbol,
};
