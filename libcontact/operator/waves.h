/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The waves of a map that ranks share, without a map of them in one process. Internal: never installed.
 */
#ifndef RC_WAVES_H
#define RC_WAVES_H

#include "libcontact/common.h"
#include "libcontact/ranks/ranks.h"

/* Column i of the spectrum, wave number i along x, and row j, wave number j along y or j - ny in the upper
 * half; `amplitude` is that of sum v exp(-i q x). The other half plane has the same amplitudes: columns
 * between the first and the last one stand for two waves. */
typedef void rc_wave_visit(void *ctx, size_t i, size_t j, double amplitude);
/* Visits each wave once, on the rank that owns its column, column by column. v: the rows of this rank.
 * RC_FAIL on all ranks when one of them lacks memory: twice its part of the map. */
enum rc_status rc_waves_visit(const struct rc_ranks *ranks, const struct rc_shape *shape,
                              const double *v, rc_wave_visit *visit, void *ctx, struct rc_err *err);

#endif
