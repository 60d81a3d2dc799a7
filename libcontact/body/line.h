/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Maps that repeat along one axis and are free along the other. The load is a wave along the repeating axis,
 * and along the free axis it is 1 on one cell and 0 elsewhere. Internal: never installed.
 */
#ifndef RC_LINE_H
#define RC_LINE_H

#include "body.h"

/* Nodes along the free axis, counted from the middle of the loaded cell, and the wave along the other. */
struct rc_line_at {
    double cell;    /* m: width of a cell                                                     */
    size_t step, n; /* cells from node to node, and number of nodes, both at least 1          */
    double wave;    /* rad/m, >= 0                                                            */
    double datum;   /* m: where a displacement without limit (only if the wave is 0) is 0     */
};

enum {
    RC_LINE_MOST = RC_STRESS_KERNELS
};
/* Symbols (struct rc_kernel) as functions of the wave number q along the free axis. */
struct rc_line_source {
    size_t count; /* functions computed together, at most RC_LINE_MOST */
    unsigned odd; /* bit k: function k is odd in q                     */
    /* Function k at n wave numbers, rad/m, for each out[k] that is not NULL; q > 0, or q >= 0 if the wave is
     * not 0. */
    void (*symbols)(const void *of, size_t n, const double *q, double *const out[]);
    const void *of;
};

/* Writes function k at the nodes to out[k], if this is not NULL. The field of a load cos(wave y) is
 * out cos(wave y), or out sin(wave y) if the kernel is odd in y. The error is below 1e-12 of the largest
 * value on the free axis (between the nodes too), and follows that of the symbols. Of stresses at a depth
 * which the wave hardly reaches it is below 1e-16 of the load. RC_FAIL when memory is short. */
enum rc_status rc_line_coefficients(const struct rc_line_source *source,
                                    const struct rc_line_at *at, double *const out[],
                                    struct rc_err *err);

/* The same for a kernel. The free axis is x or y. */
enum rc_status rc_kernel_line(const struct rc_kernel *kernel, bool along_x,
                              const struct rc_line_at *at, double *out, struct rc_err *err);
/* The same for the stresses at a depth whose bit is set. Symbols count as 0 where q^2 + wave^2 > most^2,
 * rad/m. */
enum rc_status rc_inside_lines(const struct rc_inside *inside, unsigned kernels, bool along_x,
                               const struct rc_line_at *at, double most,
                               double *const out[RC_STRESS_KERNELS], struct rc_err *err);
/* The transforms of the coefficients at n nodes, which are a period: the sums over its nodes x of the
 * coefficients times cos(q x), for odd functions sin(q x), at the wave numbers q = 2 pi k/(n step cell), k <=
 * n/2. They cost less than coefficients. Only if rc_line_decays: then each field is 0 at half a period. */
bool rc_line_decays(const struct rc_line_at *at);
enum rc_status rc_inside_spectra(const struct rc_inside *inside, unsigned kernels, bool along_x,
                                 const struct rc_line_at *at, double most,
                                 double *const out[RC_STRESS_KERNELS], struct rc_err *err);

#endif
