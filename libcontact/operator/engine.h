/*
 * How sums are done: the row type of engines.list. Internal: never installed.
 */
#ifndef RC_ENGINE_H
#define RC_ENGINE_H

#include "kernel.h"

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
