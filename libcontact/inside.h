/*
 * What the rooms of libcontact share and nobody else sees: the row types of kernels.list and
 * engines.list.
 */
#ifndef RC_INSIDE_H
#define RC_INSIDE_H

#include "contact.h"

/* Inner loops are compiled for wider registers too, and the loader takes what the processor has. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define RC_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define RC_CLONES
#endif

/* Threads that pay on a grid: waking one costs about what a few thousand nodes do. threads 0: as many
 * as there are. */
int rc_useful_threads(const struct rc_shape *shape, size_t threads);

/* ---- kernels: what a unit pressure does ---- */

struct rc_medium {
    double estar; /* Pa  */
    double nu;    /* -   */
    double depth; /* m   */
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
    const char *name;
    const char *summary;
    size_t components;
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

#define RC_KERNEL(name) extern const struct rc_kernel rc_kernel_##name;
#include "kernels.list"
#undef RC_KERNEL

/* ---- engines: how sums are done ---- */

/* What is to be summed: one component of one kernel on one grid. */
struct rc_sum {
    struct rc_shape shape;
    enum rc_boundary boundary;
    const struct rc_kernel *kernel;
    size_t component;
    struct rc_medium medium;
    double tol;     /* asked error relative to the sum of |K| |p|; 0: as good as rounding      */
    size_t threads; /* 0: all                                                                  */
    size_t order, correction; /* of mlms by hand: t and m_c of the paper; 0: from tol          */
};

struct rc_engine {
    const char *name;
    const char *summary;
    /* Bytes of a plan, beside p and u. */
    size_t (*memory)(const struct rc_sum *sum);
    /* All choosing, tabulating and allocating; NULL and *err when that fails. */
    void *(*new)(const struct rc_sum *sum, struct rc_err *err);
    /* u = K p; p and u do not overlap. */
    void (*apply)(void *plan, const double *p, double *u);
    /* The plan's own bound on the error of u, relative to the sum of |K| |p|. */
    double (*error)(const void *plan);
    void (*free)(void *plan);
};

#define RC_ENGINE(name) extern const struct rc_engine rc_engine_##name;
#include "engines.list"
#undef RC_ENGINE

#endif
