/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The double sum without approximation, on any lattice: the engine `direct` and the coarsest level of the
 * engine `mlms`.
 */
#ifndef RC_DIRECT_H
#define RC_DIRECT_H

#include "libcontact/operator/engine.h"

struct rc_direct;

/* The kernel of `sum` between the nodes of a map of nx x ny samples at `at`. */
struct rc_direct *rc_direct_new(const struct rc_sum *sum, const struct rc_lattice *at, size_t nx,
                                size_t ny, int threads, struct rc_err *err);
void rc_direct_apply(struct rc_direct *direct, const double *p, double *u);
void rc_direct_free(struct rc_direct *direct);
RC_OWNER(rc_direct)

#endif
