/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * An engine sums displacements: the row type of engines.list. Internal: never installed.
 */
#ifndef RC_ENGINE_H
#define RC_ENGINE_H

#include "libcontact/body/body.h"

struct rc_fft;

/* The sum: a kernel on a grid. */
struct rc_sum {
    struct rc_shape shape;
    struct rc_boundary boundary;
    struct rc_kernel kernel;
    double tol;                   /* asked error relative to the sum of |K| |p|; 0: rounding     */
    bool precise;                 /* in double precision throughout, even where tol permits less */
    size_t threads;               /* 0: all                                                      */
    size_t order, correction;     /* t and m_c of the paper for mlms; 0: chosen from tol         */
    const struct rc_ranks *ranks; /* ranks that share the map; engines with transforms only */
};

struct rc_engine {
    struct rc_engine_info info;
    struct rc_engine_info precise; /* the name of the engine in double precision; NULL: none */
    /* By Fourier transforms of maps: several fields share the transform of one source, and ranks can share a
     * map. */
    bool transforms;
    /* Seconds of one sum within a solve, including the work of the method; two threads, 2026. */
    double (*seconds)(const struct rc_sum *sum);
    /* Chooses, tabulates and allocates; NULL and *err on failure. */
    void *(*new)(const struct rc_sum *sum, struct rc_err *err);
    /* u = K p; p and u do not overlap. */
    void (*apply)(void *plan, const double *p, double *u);
    /* A bound of the error of u, relative to the sum of |K| |p|. */
    double (*error)(const void *plan);
    void (*free)(void *plan);
    /* The plan's transforms, so that others can use its memory; NULL: it has none. */
    struct rc_fft *(*fft)(void *plan);
};

/* Another list may include this one and add engines. */
#ifndef RC_ENGINES_LIST
#define RC_ENGINES_LIST "libcontact/operator/engines.list"
#endif
#define RC_ENGINE(name) extern const struct rc_engine rc_engine_##name;
#include RC_ENGINES_LIST
#undef RC_ENGINE

/* The engine of that name, or NULL; *precise (may be NULL): whether the name demands double precision. */
const struct rc_engine *rc_engine_named(const char *name, bool *precise);
/* The message that there is no engine of this name. */
enum rc_status rc_engine_absent(const char *name, struct rc_err *err);

/* The first engine that sums by Fourier transforms of maps. */
const struct rc_engine *rc_engine_of_transforms(void);

/* RC_FAIL, and *err says why, when this engine, requested by that name, does not support this boundary or
 * these ranks. */
enum rc_status rc_engine_serves(const struct rc_engine *engine, const char *name,
                                struct rc_boundary boundary, const struct rc_ranks *ranks,
                                struct rc_err *err);

/* RC_FAIL, and *err says why, when rc_conv_new would find no engine. */
enum rc_status rc_conv_check(const struct rc_shape *shape, const struct rc_conv_options *options,
                             struct rc_err *err);

/* rc_conv_new for these bodies, which outlive it. */
struct rc_conv *rc_conv_new_of(const struct rc_solids *bodies, const struct rc_shape *shape,
                               const struct rc_conv_options *options, struct rc_err *err);

/* The transforms of its engine; NULL: it uses none. */
struct rc_fft *rc_conv_fft(struct rc_conv *conv);

/* True if methods may iterate with it in single precision. */
bool rc_conv_mixed(const struct rc_conv *conv);

#endif
