/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Kalker's linear theory of rolling: where no node slips, an ellipse with the semi-axes a (along x) and b
 * carries
 *
 *     Fx = C11 G a b vx,   Fy = G a b (C22 vy + C23 sqrt(ab) phi)
 *
 * under a motion v, phi of body 2 over body 1 per length rolled. G is the shear modulus of similar bodies.
 *
 * His simplified theory (Vehicle System Dynamics 11, 1982, "A fast algorithm for the simplified theory of
 * rolling contact") lets each place move by L times its own traction, and bounds the traction by a
 * paraboloid. The L that give the forces above are
 *
 *     L1 = 8 a/(3 G C11),   L2 = 8 a/(3 G C22),   L3 = pi a sqrt(a/b)/(4 G C23).
 */
#include <math.h>

#include "libcontact/common.h"
#include "libcontact/friction/friction.h"

enum {
    NUS = 3, /* Poisson's ratios 0, 0.25, 0.5 */
    TENTHS = 10
};

/* Kalker 1990, Three-dimensional elastic bodies in rolling contact, table E.3: C11, C22, C23; rows: the
 * lesser semi-axis over the larger one, 0.1 to 1. */
static const double table[2][TENTHS][3][NUS] = {
    {/* a < b */
     {{2.51, 3.31, 4.85}, {2.51, 2.52, 2.53}, {.334, .473, .731}},
     {{2.59, 3.37, 4.81}, {2.59, 2.63, 2.66}, {.483, .603, .809}},
     {{2.68, 3.44, 4.80}, {2.68, 2.75, 2.81}, {.607, .715, .889}},
     {{2.78, 3.53, 4.82}, {2.78, 2.88, 2.98}, {.720, .823, .977}},
     {{2.88, 3.62, 4.83}, {2.88, 3.01, 3.14}, {.827, .929, 1.07}},
     {{2.98, 3.72, 4.91}, {2.98, 3.14, 3.31}, {.930, 1.03, 1.18}},
     {{3.09, 3.81, 4.97}, {3.09, 3.28, 3.48}, {1.03, 1.14, 1.29}},
     {{3.19, 3.91, 5.05}, {3.19, 3.41, 3.65}, {1.13, 1.25, 1.40}},
     {{3.29, 4.01, 5.12}, {3.29, 3.54, 3.82}, {1.23, 1.36, 1.51}},
     {{3.40, 4.12, 5.20}, {3.40, 3.67, 3.98}, {1.33, 1.47, 1.63}}},
    {/* a > b */
     {{10.7, 11.7, 12.9}, {10.7, 12.8, 16.0}, {12.2, 14.6, 18.0}},
     {{6.96, 7.78, 8.82}, {6.96, 8.14, 9.79}, {5.72, 6.63, 7.89}},
     {{5.57, 6.34, 7.34}, {5.57, 6.40, 7.51}, {3.79, 4.32, 5.01}},
     {{4.84, 5.57, 6.57}, {4.84, 5.48, 6.31}, {2.88, 3.24, 3.70}},
     {{4.37, 5.10, 6.11}, {4.37, 4.90, 5.56}, {2.35, 2.62, 2.96}},
     {{4.06, 4.78, 5.80}, {4.06, 4.50, 5.04}, {2.01, 2.23, 2.50}},
     {{3.82, 4.54, 5.58}, {3.82, 4.21, 4.67}, {1.76, 1.95, 2.18}},
     {{3.65, 4.36, 5.42}, {3.65, 3.99, 4.39}, {1.58, 1.75, 1.94}},
     {{3.51, 4.22, 5.30}, {3.51, 3.81, 4.16}, {1.44, 1.59, 1.77}},
     {{3.40, 4.12, 5.20}, {3.40, 3.67, 3.98}, {1.33, 1.47, 1.63}}}};

void
rc_kalker(double ratio, double nu, double c[3])
{
    const double g = TENTHS * fmin(ratio, 1 / ratio);
    const size_t first = (size_t)fmin(fmax(g, 1), TENTHS - 1), side = ratio > 1;
    const double part = log(g / (double)first) / log(1 + 1 / (double)first);
    /* 1/C is nearly a parabola of nu, and log C nearly linear in log g */
    const double weight[NUS] = {8 * (nu - 0.25) * (nu - 0.5), -16 * nu * (nu - 0.5),
                                8 * nu * (nu - 0.25)};

    for (int k = 0; k < 3; k++) {
        double sum = 0;
        for (int m = 0; m < NUS; m++) {
            const double low = table[side][first - 1][k][m], high = table[side][first][k][m];
            sum += weight[m] / (low * pow(high / low, part));
        }
        /* the ratio of a rounded contact may miss 0.1 a little */
        c[k] = g >= 0.99 && nu >= 0 && nu <= 0.5 ? 1 / sum : NAN;
    }
}

void
rc_fastsim(const double axis[2], double g, const double c[3], double limit, const double creep[2],
           double spin, double force[2])
{
    enum {
        STRIPS = 100, /* along y */
        STEPS =
            200 /* along x, in each strip: the force is 3e-4 off at a fiftieth of the limit, less above */
    };
    const double a = axis[0], b = axis[1];
    const double soft[3] = {8 * a / (3 * g * c[0]), 8 * a / (3 * g * c[1]),
                            RC_PI * a * sqrt(a / b) / (4 * g * c[2])};

    force[0] = force[1] = 0;
    for (int j = 0; j < STRIPS; j++) {
        const double y = (2 * (j + 0.5) / STRIPS - 1) * b, half = a * sqrt(1 - y * y / (b * b));
        const double dx = 2 * half / STEPS, area = dx * 2 * b / STRIPS;
        double q[2] = {0};
        for (int i = 0; i < STEPS; i++) {
            const double x = half - (i + 0.5) * dx;
            /* the traction in the middle of a step: the first one is half as long */
            const double way = i == 0 ? dx / 2 : dx;
            const double middle = x + way / 2; /* of this way */
            const double most =
                2 * limit / (RC_PI * a * b) * (1 - x * x / (a * a) - y * y / (b * b));
            double size;
            q[0] += way * (creep[0] / soft[0] - spin * y / soft[2]);
            q[1] += way * (creep[1] / soft[1] + spin * middle / soft[2]);
            size = hypot(q[0], q[1]);
            for (int k = 0; k < 2; k++) {
                if (size > most)
                    q[k] *= most / size;
                force[k] += q[k] * area;
            }
        }
    }
}
