/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The stresses of a half-space of one material in closed form. The loads are a unit force, a uniform load on
 * a cell (a sum over its corners), and a wave. Internal: never installed.
 */
#ifndef RC_FORMS_H
#define RC_FORMS_H

#include "body.h"

/* Points seen from a unit force at the origin: x, y, 1/R and 1/(R + z), all at the depth z. */
struct rc_points {
    size_t n;
    const double *x, *y, *r, *w;
    double z, nu;
};

/* A corner of a cell seen from the point of the field: X, Y and the distance R, at depth z. */
struct rc_corner {
    double x, y, z, r, nu;
    double floor; /* m: smallest distance from an edge at which a logarithm is evaluated */
};

struct rc_stress_forms {
    /* out[i] += weight * 2 pi times the stress of a unit force. */
    void (*point)(const struct rc_points *points, double weight, double *out);
    /* Antiderivative in X and Y of 2 pi times that stress. */
    double (*corner)(const struct rc_corner *corner);
    /* Transform over (-i)^(number of odd directions), of each wave; q > 0. The number of a wave is
     * its decay exp(-q z) at the depth z. */
    void (*symbol)(const struct rc_waves *waves, double z, double nu, double *out);
};
extern const struct rc_stress_forms rc_stress_forms[RC_TURNED * RC_COMPONENTS];

/* cell.c: a depth of a uniform body, with the functions of rc_inside_type. */
struct rc_closed {
    double depth, nu;
};
void rc_closed_coefficients(const struct rc_closed *at, const struct rc_cell *cell,
                            unsigned kernels, size_t n, const double *x, const double *y,
                            double *const out[RC_STRESS_KERNELS]);
void rc_closed_line(const struct rc_closed *at, const struct rc_cell *cell, unsigned kernels,
                    double step, size_t n, double y, double *const out[RC_STRESS_KERNELS]);

#endif
