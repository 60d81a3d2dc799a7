/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Power of the waves of real maps, and autocorrelations, which follow from it. Internal: never installed.
 */
#ifndef RC_POWER_H
#define RC_POWER_H

#include "libcontact/grid.h"

/* Writes row j of a map, nx values. Several threads call it, once for each row. */
typedef void rc_map_row(const void *map, size_t j, double *row);

/* |s|^2 of the waves of a map, for s as in fourier.h, column by column. Wave number k along x and place j
 * along y are at power[k ny + j], k <= nx/2. The other half plane is the same. threads 0: all. RC_FAIL when a
 * side is too long for FFTW or memory is short. */
enum rc_status rc_power(const struct rc_shape *shape, rc_map_row *row, const void *map,
                        size_t threads, double *power, struct rc_err *err);

/* Sums of the products of nodes that are (x, y) nodes apart, for 0 <= y <= my and -mx <= x <= mx. These are
 * my + 1 rows of 2 mx + 1 sums: opposite offsets have the same sums. The map is periodic (px = nx, py = ny)
 * or padded with zeros to px x py nodes. Then px >= nx + mx and py >= ny + my. mx <= px/2, my <= py/2, my <
 * ny. Fails likewise. */
struct rc_offsets {
    size_t px, py, mx, my;
};
enum rc_status rc_autocorrelate(const struct rc_shape *shape, const struct rc_offsets *offsets,
                                rc_map_row *row, const void *map, size_t threads, double *sums,
                                struct rc_err *err);

#endif
