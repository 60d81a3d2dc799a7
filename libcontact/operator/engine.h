/*
 * How sums are done: the row type of engines.list. Internal: never installed.
 */
#ifndef RC_ENGINE_H
#define RC_ENGINE_H

#include "libcontact/body/body.h"

struct rc_fft;

/* What is to be summed: a kernel on a grid. */
struct rc_sum {
    struct rc_shape shape;
    enum rc_boundary boundary;
    struct rc_kernel kernel;
    double tol;     /* asked error relative to the sum of |K| |p|; 0: as good as rounding        */
    bool precise;   /* in double precision throughout, even where tol would allow less           */
    size_t threads; /* 0: all                                                        */
    size_t order, correction; /* of mlms by hand: t and m_c of the paper; 0: from tol          */
    const struct rc_ranks *ranks; /* that share the map; only engines that transform can        */
};

struct rc_engine {
    struct rc_engine_info info;
    struct rc_engine_info
        precise; /* the word that asks for double precision; without a name: none */
    /* By Fourier transforms of maps: fields of one source share its transform, and ranks a map. */
    bool transforms;
    /* Seconds that one sum takes in a solve, the work of the method around it included; two threads
     * of 2026. */
    double (*seconds)(const struct rc_sum *sum);
    /* Bytes of a plan, beside p and u. */
    size_t (*memory)(const struct rc_sum *sum);
    /* All choosing, tabulating and allocating; NULL and *err when that fails. */
    void *(*new)(const struct rc_sum *sum, struct rc_err *err);
    /* u = K p; p and u do not overlap. */
    void (*apply)(void *plan, const double *p, double *u);
    /* The plan's own bound on the error of u, relative to the sum of |K| |p|. */
    double (*error)(const void *plan);
    void (*free)(void *plan);
    /* The transforms of a plan that sums by them, for others to share its memory; NULL: none. */
    struct rc_fft *(*fft)(void *plan);
};

/* The list may be a longer one that includes this one: so others add engines of their own. */
#ifndef RC_ENGINES_LIST
#define RC_ENGINES_LIST "libcontact/operator/engines.list"
#endif
#define RC_ENGINE(name) extern const struct rc_engine rc_engine_##name;
#include RC_ENGINES_LIST
#undef RC_ENGINE

/* The engine of that name, or NULL; *precise (which may be NULL): whether the name asks for double
 * precision. */
const struct rc_engine *rc_engine_named(const char *name, bool *precise);

/* The first engine that sums by Fourier transforms of maps. */
const struct rc_engine *rc_engine_of_transforms(void);

/* RC_FAIL, and *err says why, when an engine, asked for by that name, sums no maps of this
 * boundary, or none that these ranks share. */
enum rc_status rc_engine_serves(const struct rc_engine *engine, const char *name,
                                enum rc_boundary boundary, const struct rc_ranks *ranks,
                                struct rc_err *err);

/* RC_FAIL, and *err says why, when rc_conv_new would find no engine. */
enum rc_status rc_conv_check(const struct rc_shape *shape, const struct rc_conv_options *options,
                             struct rc_err *err);

/* rc_conv_new of these bodies, which outlive it. */
struct rc_conv *rc_conv_new_of(const struct rc_solids *bodies, const struct rc_shape *shape,
                               const struct rc_conv_options *options, struct rc_err *err);

/* The transforms by which it sums; NULL: it sums in another way. */
struct rc_fft *rc_conv_fft(struct rc_conv *conv);

/* Whether methods may iterate with it in single precision. */
bool rc_conv_mixed(const struct rc_conv *conv);

#endif
