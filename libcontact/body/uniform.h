/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The half-space of one material, also used by types that contain one. Internal: never installed.
 */
#ifndef RC_UNIFORM_H
#define RC_UNIFORM_H

#include "body.h"

/* A half-space of this composite modulus, Pa, without stresses inside. NULL when memory is short. */
struct rc_solid *rc_uniform_new(double estar, struct rc_err *err);
/* Poisson's ratio. */
double rc_uniform_nu(const struct rc_solid *solid);
extern const struct rc_inside_type rc_uniform_inside; /* uniform_stress.c */
/* Adds the displacement under a cell of a half-space of E* (in any unit). */
void rc_uniform_add_rows(double estar, const struct rc_lattice *at, size_t n, size_t first,
                         size_t last, double *out);

#endif
