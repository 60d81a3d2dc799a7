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
    double norm; /* m/Pa: a bound of T's largest eigenvalue                                */
    double convolutions;   /* so far, in equivalents of one of a single map in double precision */
    struct rc_frame frame; /* nodes of a free map's padding that the inverse takes along */
    struct rc_fft *fft, *framed;
    size_t columns, length, cy; /* of waves; numbers of a column; and of a quarter of it          */
    double *quarter[RC_SHEAR_KERNELS];
    float *single[3];    /* of the inverse, as XX, YY, XY are of T */
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

struct rc_frame rc_tangential_frame(const struct rc_shape *shape, enum rc_boundary boundary);
/* m/Pa: what T makes of waves of wave number q, on average over their directions. */
double rc_tangential_wave(const struct rc_tangential *t, double q);
/* The power a with which that falls, T ~ q^-a: 1, and on the free boundary near 0 along a strip. Where the
 * grid has no waves as long, of the longest. */
double rc_tangential_power(const struct rc_tangential *t, double q);
/* u = T q, and q = T^-1 u on the map in its frame, of the padded map or the periodic one; u and q may be the
 * same. */
void rc_tangential_apply(struct rc_tangential *t, double *const q[2], double *const u[2]);
void rc_tangential_inverse(struct rc_tangential *t, float *const u[2], float *const q[2]);
/* u_z = C' q, and u = C p; only where beta is not 0. */
void rc_tangential_normal(struct rc_tangential *t, double *const q[2], double *uz);
void rc_tangential_pressure(struct rc_tangential *t, const double *p, double *const u[2]);

#endif
