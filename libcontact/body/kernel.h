/*
 * What a unit pressure does: the row type of kernels.list. Internal: never installed.
 */
#ifndef RC_KERNEL_H
#define RC_KERNEL_H

#include "libcontact/common.h"

struct rc_medium {
    double estar;                 /* Pa  */
    double nu;                    /* -   */
    double depth;                 /* m   */
    const struct rc_stack *stack; /* of the kernel layered; then also, of the units of the grid: */
    double length, modulus;       /* m and Pa                                               */
    const struct rc_inside *inside; /* of the kernel stress, in a coated body: at the depth      */
};

/* Where a kernel is sampled: a cell, and the step between samples in cells. */
struct rc_lattice {
    double dx, dy;
    size_t sx, sy; /* 1: at every node */
};

enum {
    RC_ODD_X = 1, /* K(-x, y) = -K(x, y) */
    RC_ODD_Y = 2,
};

struct rc_kernel {
    struct rc_kernel_info info;
    const unsigned *parity; /* of each component */
    /* Field at (i sx dx, j sy dy), i < n, first <= j < last, of unit pressure on the cell dx x dy
     * about the origin: out[(j - first) * n + i]. */
    void (*rows)(const struct rc_medium *medium, size_t component, const struct rc_lattice *at,
                 size_t n, size_t first, size_t last, double *out);
    /* Transform of the kernel of the infinite half-space at wave numbers qx, qy (rad/m, not both
     * zero) of band-limited pressure, over (-i)^(number of odd directions): real, odd where the
     * kernel is. NULL: the kernel has none. */
    double (*symbol)(const struct rc_medium *medium, size_t component, double qx, double qy);
};

/* The list may be a longer one that includes this one: so others add kernels of their own. */
#ifndef RC_KERNELS_LIST
#define RC_KERNELS_LIST "libcontact/body/kernels.list"
#endif
#define RC_KERNEL(name) extern const struct rc_kernel rc_kernel_##name;
#include RC_KERNELS_LIST
#undef RC_KERNEL

#endif
