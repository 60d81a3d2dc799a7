/*
 * What tractions along the surface do, as the method sees it. Internal: never installed.
 *
 *     u_t = T q + C p,   u_z = C' q          (body/shear.c; C is 0 where beta is)
 *
 * All are sums of two maps at once, along x and along y: both are transformed, multiplied wave by wave,
 * and come back. Maps of floats are summed in single precision: the caller's units are such that no decade
 * is lost.
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
    double norm;    /* m/Pa: a bound of T's largest eigenvalue                                */
    double convolutions; /* so far, in equivalents of one of a single map in double precision */
    struct rc_fft *fft, *fft_single;
    size_t columns, length, cy; /* of waves; numbers of a column; and of a quarter of it          */
    double *quarter[RC_SHEAR_KERNELS];
    float *single[3];    /* of XX, YY, XY */
    void *waves[2];      /* of both maps  */
    size_t *wave;        /* place t of a column: its number in the quarter */
    signed char *mirror; /* and -1 where that is its mirror image       */
};

struct rc_tangential *rc_tangential_new(const struct rc_shape *shape, enum rc_boundary boundary,
                                        const struct rc_shear *shear, size_t threads,
                                        struct rc_err *err);
void rc_tangential_free(struct rc_tangential *t); /* NULL is allowed */
size_t rc_tangential_memory(const struct rc_shape *shape, enum rc_boundary boundary, bool coupled,
                            size_t threads);

/* u = T q, and q = T^-1 u of the padded map or the periodic one; u and q may be the same. */
void rc_tangential_apply(struct rc_tangential *t, double *const q[2], double *const u[2]);
void rc_tangential_apply_single(struct rc_tangential *t, float *const q[2], float *const u[2]);
void rc_tangential_inverse(struct rc_tangential *t, float *const u[2], float *const q[2]);
/* u_z = C' q, and u = C p; only where beta is not 0. */
void rc_tangential_normal(struct rc_tangential *t, double *const q[2], double *uz);
void rc_tangential_pressure(struct rc_tangential *t, const double *p, double *const u[2]);

/* Between tangential.c and tangential_body.h, which is compiled once for each precision: a column of n
 * numbers, real parts and then imaginary ones, of both maps, and what becomes of one of them. */
struct rc_shear_column {
    size_t n;
    const size_t *wave;
    const signed char *mirror;
    const void *x, *y; /* the map that is wanted, and the other */
    void *to;
};
struct rc_shear_ops {
    /* a x - b y, b of a kernel that is odd in both directions: its transform is (-i)^2 b */
    void (*apply)(const struct rc_shear_column *column, const void *a, const void *b);
    /* the same of the inverse of (a -b; -b c) */
    void (*inverse)(const struct rc_shear_column *column, const void *a, const void *b,
                    const void *c);
    /* Rows of a map; false: all are 0. */
    bool (*row)(const void *from, size_t n, void *to);
};
extern const struct rc_shear_ops rc_shear_double, rc_shear_single;

#endif
