/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A kernel: the field of a unit pressure on one cell, for engines and transforms. Internal: never installed.
 */
#ifndef RC_KERNEL_H
#define RC_KERNEL_H

#include "libcontact/common.h"

/* Where a kernel is sampled: a cell, and the step between samples in cells. */
struct rc_lattice {
    double dx, dy;
    size_t sx, sy; /* 1: at every node */
};

struct rc_line_at;

enum {
    RC_ODD_X = 1, /* K(-x, y) = -K(x, y) */
    RC_ODD_Y = 2,
};

struct rc_kernel {
    const void
        *of; /* first argument of the functions; it outlives every plan that uses the kernel */
    unsigned parity; /* RC_ODD_X, RC_ODD_Y                                                   */
    /* Computes the field at (i sx dx, j sy dy), i < n, first <= j < last, of unit pressure on the cell dx x
     * dy about the origin. out[(j - first) * n + i] receives it. */
    void (*rows)(const void *of, const struct rc_lattice *at, size_t n, size_t first, size_t last,
                 double *out);
    /* The transform of the kernel of the infinite half-space under band-limited pressure, at wave numbers qx,
     * qy (rad/m, not both zero). It is divided by (-i)^(number of odd directions), and is then real, and odd
     * where the kernel is. NULL: it is not known. */
    double (*symbol)(const void *of, double qx, double qy);
    /* rc_kernel_line of this kernel; NULL: the symbol is integrated. */
    enum rc_status (*line)(const void *of, bool along_x, const struct rc_line_at *at, double *out,
                           struct rc_err *err);
};

#endif
