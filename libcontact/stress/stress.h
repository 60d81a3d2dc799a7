/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Sums the stresses inside a body (libcontact/body) over a map. Internal: never installed.
 */
#ifndef RC_STRESS_H
#define RC_STRESS_H

#include <math.h>

#include "libcontact/operator/operator.h"

/* ---- sums over a map ---- */

/* The requested sum, and counters of the work. */
struct rc_stress_task {
    struct rc_shape shape;
    struct rc_stress_options options;
    const double *p; /* owned by the caller */
    unsigned loads;  /* bits: the loads on the surface */
    size_t sources;  /* maps of the loads: the pressure, maps of traction */
    const double *source[RC_LOADS];
    struct {
        size_t source; /* its map ... */
        double weight; /* ... times this weight */
    } load[RC_LOADS];
    const struct rc_inside_type *type;
    const struct rc_solid *solid;
    /* bits of the six: those requested and those needed for derived stresses */
    unsigned components;
    unsigned kernels;               /* bits: the kernels needed, one of each set of equal ones */
    const struct rc_engine *engine; /* requested or chosen; NULL: there is none of that name */
    bool precise;                   /* true: double precision throughout, as its name demands */
    struct rc_stress_counts *counts;
    /* Pa, of each component at the last depth: the sum of the estimated errors by a coarser grid over the
     * nodes held here; NULL: not requested */
    double *error;
};
/* True if there is a load; the weight of traction relative to pressure: |mu| plus the number of traction
 * maps. */
static inline bool
rc_stress_has(const struct rc_stress_task *task, int load)
{
    return task->loads >> load & 1;
}
double rc_stress_shear(const struct rc_stress_task *task);

/* The q z from which on waves are left out at a depth z. There each wave is down to (3 + q z) exp(-q z) =
 * 7e-20. Even all of them in phase are then below the rounding of the transforms. Half and double of the
 * number change no bit (15 runs of bench/constants.py). */
enum {
    RC_STRESS_REACH = 48
};
static inline bool
rc_stress_reaches(double q, double depth)
{
    return q * depth < RC_STRESS_REACH;
}

/* Counts evaluations of a kernel, as one of the shear if only the traction needs it. */
void rc_stress_count(const struct rc_stress_task *task, int kernel, size_t coefficients);

/* Numbers stored per wave at a depth. */
size_t rc_stress_numbers(const struct rc_stress_task *task);
/* A depth of the body; free it with rc_inside_free. NULL when memory is short or the body is rigid there. */
struct rc_inside *rc_stress_inside(const struct rc_stress_task *task, double depth,
                                   struct rc_err *err);

/* ---- load_error.c: errors of the loads ---- */

/* For each wanted component the sum of |stress| over the nodes at this depth under a unit load of this source
 * on one cell, for the cell of the largest sum: times the sum of |error| of the source it bounds the sum of the
 * changes. RC_FAIL when memory is short or the body is rigid there. */
enum rc_status rc_stress_gain(const struct rc_stress_task *task, size_t source, double depth,
                              double gain[RC_STRESSES], struct rc_err *err);

/* ---- strained.c: the stress due to plastic strain ---- */

struct rc_strained;
enum rc_status rc_strained_check(const struct rc_stress_options *options, struct rc_err *err);
struct rc_strained *rc_strained_new(const struct rc_stress_task *task, struct rc_err *err);
void rc_strained_free(struct rc_strained *strained); /* NULL is allowed */
RC_OWNER(rc_strained)
/* Adds it to the components at this depth, a map or a line of each; NULL: not needed. */
void rc_strained_add(struct rc_strained *strained, double depth, double *const to[RC_COMPONENTS]);
/* The transforms so far. */
void rc_strained_count(const struct rc_strained *strained, struct rc_stress_counts *counts);

/* ---- derived.c ---- */

/* The derived stresses of n points from their six components: out[c] for each bit of `wanted` from RC_MISES
 * on. */
void rc_stress_derive(unsigned wanted, size_t n, const double *const s[RC_COMPONENTS],
                      double *const out[RC_STRESSES]);

/* ---- engines for stresses ---- */

/* Evaluates stresses: slices_fft.c, slices_engine.c and section.c each end in one. */
struct rc_stress_evaluator {
    void *(*new)(const struct rc_stress_task *task, struct rc_err *err);
    /* The components at one depth, s[c] for each bit: a map each, or a line of a section. */
    enum rc_status (*slice)(void *plan, double depth, double *const s[RC_COMPONENTS],
                            struct rc_err *err);
    void (*free)(void *plan);
    /* Other maps of the same loads; NULL: not implemented. Tables of the last depth stay. */
    enum rc_status (*load)(void *plan, const double *const source[RC_LOADS], struct rc_err *err);
};
extern const struct rc_stress_evaluator rc_stress_slices_fft; /* by transforms of maps    */
/* See rc_stress_coarser; for slices_fft.c only. */
double rc_stress_slices_coarser(const struct rc_stress_task *task);
/* True if transforms are in single precision; for slices_fft.c only. */
bool rc_stress_slices_single(const struct rc_stress_task *task);
extern const struct rc_stress_evaluator rc_stress_slices_engine; /* by a row of engines.list */
extern const struct rc_stress_evaluator rc_stress_section;       /* a line at a time         */

#endif
