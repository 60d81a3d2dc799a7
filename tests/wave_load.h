/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stresses of a load that is a wave along y and a cell along x, as a sum over the points of real space. */
#ifndef WAVE_LOAD_H
#define WAVE_LOAD_H

#include <gsl/gsl_integration.h>

#include "tests/exact.h"
#include "libcontact/body/body.h"

/* The integral over y of f(x, y) cos(Q y), or f(x, y) sin(Q y) for kernels odd in y, is a sum over y = j h.
 * Its error is exp(Q R - 2 pi R/h), R the distance of the nearest load. The sum ends smoothly: its terms are
 * multiplied by erfc(Q y/12 - 9)/2, whose error is exp(-36). */
static inline double
end_of_sum(double wave, double y)
{
    return erfc(wave * y / 12 - 9) / 2;
}

static const double sum_end = 15 * 12; /* of Q y */

/* Adds the stresses of a uniform body under a line across the cell, by points of Gauss's rule. */
static inline void
add_points(double nu, double d, double x, double y, double z, const double *u, const double *w,
           size_t points, double sum[RC_STRESS_KERNELS])
{
    for (size_t k = 0; k < points; k++) {
        double one[RC_COMPONENTS], two[RC_COMPONENTS], three[RC_COMPONENTS];
        point_stress(false, nu, x - u[k] * d, y, z, one);
        point_stress(true, nu, x - u[k] * d, y, z, two);
        point_stress(true, nu, y, x - u[k] * d, z, three);
        for (int c = 0; c < RC_COMPONENTS; c++) {
            sum[c] += w[k] * d * one[c];
            sum[RC_COMPONENTS + c] += w[k] * d * two[c];
            sum[2 * RC_COMPONENTS + (int)rc_stress_exchanged[c]] += w[k] * d * three[c];
        }
    }
}

/* The stresses of a uniform body at (x, z) under a load that is 1 on a cell |x| < d/2 and cos(wave y)
 * along y, for x >= 0 and x >= d/2 or z not much below d/2: the amplitude of cos(wave y), or of
 * sin(wave y) for kernels odd in y. */
static inline void
wave_load_stress(double nu, double d, double wave, double x, double z,
                 double sum[RC_STRESS_KERNELS])
{
    enum {
        GAUSS = 20
    };
    gsl_integration_glfixed_table *g = gsl_integration_glfixed_table_alloc(GAUSS);
    double u[GAUSS], w[GAUSS], h = 2 * exact_pi / (wave + 38 / fmax(z, x - d / 2));

    for (size_t k = 0; k < GAUSS; k++)
        gsl_integration_glfixed_point(-0.5, 0.5, k, u + k, w + k, g);
    gsl_integration_glfixed_table_free(g);
    memset(sum, 0, RC_STRESS_KERNELS * sizeof *sum);
    for (size_t j = 0; (double)j * h * wave < sum_end; j++) {
        double y = (double)j * h, of[RC_STRESS_KERNELS] = {0};
        double weight = (j == 0 ? 1 : 2) * h * end_of_sum(wave, y);
        add_points(nu, d, x, y, z, u, w, GAUSS, of);
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            sum[k] +=
                weight * of[k] * (rc_stress_parity[k] & RC_ODD_Y ? sin(wave * y) : cos(wave * y));
    }
}

#endif
