/*
 * What tractions along the surface do, as the method sees it. Internal: never installed.
 *
 *     u_t = T q + C p,   u_z = C' q          (body/shear.c; C is 0 where beta is)
 *
 * All are sums of two maps at once: both are transformed, multiplied wave by wave, and come back. A map is two:
 * along x, along y.
 */
#ifndef RC_TANGENTIAL_H
#define RC_TANGENTIAL_H

#include "libcontact/operator/operator.h"

struct rc_tangential {
    struct rc_shape shape;
    enum rc_boundary boundary;
    struct rc_shear shear;
    int threads;
    double self[2]; /* m/Pa: displacement of a node along x and y under a unit traction on it */
    double convolutions; /* so far, in equivalents of one of a single map                         */
    struct rc_fft *fft;
    size_t columns, length, cy; /* of waves; numbers of a column; and of a quarter of it          */
    double *quarter[RC_SHEAR_KERNELS];
    double *waves[2]; /* of both maps */
    size_t *wave;     /* place t of a column: its number in the quarter                           */
    double *mirror;   /* and -1 where that is its mirror image                                    */
};

struct rc_tangential *rc_tangential_new(const struct rc_shape *shape, enum rc_boundary boundary,
                                        const struct rc_shear *shear, size_t threads,
                                        struct rc_err *err);
void rc_tangential_free(struct rc_tangential *t); /* NULL is allowed */
size_t rc_tangential_memory(const struct rc_shape *shape, enum rc_boundary boundary, bool coupled,
                            size_t threads);

/* u = T q; u and q may be the same. */
void rc_tangential_apply(struct rc_tangential *t, double *const q[2], double *const u[2]);
/* q = W (T + d)^-1 W u, of the padded map or the periodic one, d in m/Pa; W: a weight for each node, or NULL:
 * 1. With `add` it is added to q. */
void rc_tangential_inverse(struct rc_tangential *t, double d, const double *weight,
                           double *const u[2], double *const q[2], bool add);
/* u_z = C' q, and u = C p; only where beta is not 0. */
void rc_tangential_normal(struct rc_tangential *t, double *const q[2], double *uz);
void rc_tangential_pressure(struct rc_tangential *t, const double *p, double *const u[2]);

#endif
