/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Real even and odd transforms of lines, given by half a period (the discrete cosine and sine
 * transforms of type I). Internal: never installed.
 */
#ifndef RC_DCT_H
#define RC_DCT_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/grid.h"

/* Transforms lines of n values, v_0 .. v_(n-1) of a period 2n - 2, with this number of threads. NULL when
 * memory is short. */
struct rc_dct;
struct rc_dct *rc_dct_new(size_t n, size_t threads, struct rc_err *err);
/* In place: an even line becomes the sum of v_j cos(pi j k / (n-1)) over the whole period. An odd line, whose
 * ends count as zero, becomes the sum of v_j sin(pi j k / (n-1)). Bit k of `odd` belongs to lines[k], which
 * may be NULL. An even and an odd line together take the time of one. The threads of one OpenMP team call it,
 * each on its own lines. */
void rc_dct_run(const struct rc_dct *dct, size_t count, unsigned odd, double *const *lines);
void rc_dct_free(struct rc_dct *dct); /* NULL is allowed */

#endif
