/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Displacements due to tractions along the surface. Internal: never installed.
 *
 *     u_t = T q + C p,   u_z = C' q          (body/shear.c; C is 0 where beta is 0)
 *
 * Each operator acts on two maps at once, along x and along y: it transforms both, multiplies them wave by
 * wave and transforms them back. Maps of floats are processed in single precision: the caller chooses units
 * in which no number is too large or too small for a float.
 */
#ifndef RC_TANGENTIAL_H
#define RC_TANGENTIAL_H

#include "libcontact/memory.h"
#include "libcontact/operator/operator.h"

struct rc_tangential {
    struct rc_shape shape; /* the whole map  */
    struct rc_rows rows;   /* of maps, held here */
    size_t above, below;   /* rows of the frame before and after them, held here */
    struct rc_boundary boundary;
    struct rc_shear shear;
    int threads;
    double norm;           /* m/Pa: an upper bound of the largest eigenvalue of T */
    double convolutions;   /* until now, in equivalents of one convolution of a single map in
                              double precision */
    struct rc_frame frame; /* the padded map on which the inverse acts */
    struct rc_fft *fft, *framed;
    size_t length, cy; /* numbers in a column; rows of a quarter of a column */
    /* Columns of waves held here, of fft and of framed, which differ among ranks. */
    struct {
        size_t first, n;
    } columns, single_columns;
    double *quarter[RC_SHEAR_KERNELS];
    double *axis[2];     /* of waves along x, along y: mean of XX and YY */
    float *single[3];    /* XX, YY, XY of the inverse */
    void *waves[2];      /* transforms of both maps */
    size_t *wave;        /* the row in the quarter of place t of a column */
    signed char *mirror; /* -1 where this row is the mirror image, else 1 */
    struct rc_store own;
};

struct rc_tangential *rc_tangential_new(const struct rc_ranks *ranks, const struct rc_shape *shape,
                                        struct rc_boundary boundary, const struct rc_shear *shear,
                                        size_t threads, struct rc_err *err);
void rc_tangential_free(struct rc_tangential *t); /* NULL is allowed */
RC_OWNER(rc_tangential)

struct rc_frame rc_tangential_frame(const struct rc_shape *shape, struct rc_boundary boundary);
/* m/Pa: the factor of T for waves of wave number q, averaged over their directions. */
double rc_tangential_wave(const struct rc_tangential *t, double q);
/* The power a of the decrease, T ~ q^-a. It is 1, but near 0 along a strip with a free boundary. If the grid
 * has no wave that long, the power belongs to its longest wave. */
double rc_tangential_power(const struct rc_tangential *t, double q);
/* u = T q, and q = T^-1 u on the padded or periodic map. u and q may be the same. */
void rc_tangential_apply(struct rc_tangential *t, double *const q[2], double *const u[2]);
void rc_tangential_inverse(struct rc_tangential *t, float *const u[2], float *const q[2]);
/* u_z = C' q and u = C p, both only if beta is not 0. */
void rc_tangential_normal(struct rc_tangential *t, double *const q[2], double *uz);
void rc_tangential_pressure(struct rc_tangential *t, const double *p, double *const u[2]);

#endif
