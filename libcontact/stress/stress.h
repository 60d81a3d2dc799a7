/*
 * How the stresses inside a body (libcontact/body) are summed over a map. Internal: never installed.
 */
#ifndef RC_STRESS_H
#define RC_STRESS_H

#include <math.h>

#include "libcontact/operator/operator.h"

/* ---- sums over a map ---- */

/* What is to be summed, and the tally of what it took. */
struct rc_stress_task {
    struct rc_shape shape;
    struct rc_stress_options options;
    const double *p; /* stays the caller's                                             */
    unsigned loads;  /* bits: what the surface carries                                 */
    size_t sources;  /* maps of it: the pressure, maps of traction                     */
    const double *source[RC_LOADS];
    struct {
        size_t source; /* what it is made of ... */
        double weight; /* ... times this         */
    } load[RC_LOADS];
    const struct rc_inside_type *type;
    const struct rc_solid *solid; /* NULL in an estimate */
    unsigned components; /* bits of the six: what is wanted and what that is derived from  */
    unsigned kernels;    /* bits: what these need, one of each set of equals               */
    const struct rc_engine *engine; /* asked for or taken; NULL: there is none of that name */
    bool precise;                   /* in double precision throughout, as its name asks     */
    struct rc_stress_counts *counts;
    /* In an estimate: what rc_stress_memory was told. */
    const double *depth;
    size_t depths, loaded;
};
/* Whether there is a load; what the traction is at most of the pressure, or of itself where it is larger. */
static inline bool
rc_stress_has(const struct rc_stress_task *task, int load)
{
    return task->loads >> load & 1;
}
double rc_stress_shear(const struct rc_stress_task *task);

/* Counts the evaluation of a kernel: as one of the shear where only the traction needs it. */
void rc_stress_count(const struct rc_stress_task *task, int kernel, size_t coefficients);

/* Numbers kept of a wave at a depth. */
size_t rc_stress_numbers(const struct rc_stress_task *task);
/* A depth of the body, to be freed by rc_inside_free: NULL when memory is short or the body is
 * rigid there. */
struct rc_inside *rc_stress_inside(const struct rc_stress_task *task, double depth,
                                   struct rc_err *err);
/* Bytes of it. */
size_t rc_stress_inside_memory(const struct rc_stress_task *task);

/* ---- strained.c: the stress of plastic strain, where there is any ---- */

struct rc_strained;
enum rc_status rc_strained_check(const struct rc_stress_options *options, struct rc_err *err);
struct rc_strained *rc_strained_new(const struct rc_stress_task *task, struct rc_err *err);
size_t rc_strained_memory(const struct rc_stress_task *task);
void rc_strained_free(struct rc_strained *strained); /* NULL is allowed */
/* Adds it to the components at this depth, a map or a line of each; NULL: not needed. */
void rc_strained_add(struct rc_strained *strained, double depth, double *const to[RC_COMPONENTS]);
/* The transforms so far. */
void rc_strained_count(const struct rc_strained *strained, struct rc_stress_counts *counts);

/* ---- what evaluates stresses ---- */

/* What evaluates stresses: slices_fft.c, slices_engine.c and section.c end in one. */
struct rc_stress_evaluator {
    /* Bytes beside p and the results. */
    size_t (*memory)(const struct rc_stress_task *task);
    void *(*new)(const struct rc_stress_task *task, struct rc_err *err);
    /* The components at one depth, s[c] for each bit: a map each, or a line of a section. */
    enum rc_status (*slice)(void *plan, double depth, double *const s[RC_COMPONENTS],
                            struct rc_err *err);
    void (*free)(void *plan);
};
extern const struct rc_stress_evaluator rc_stress_slices_fft;    /* by transforms of maps    */
extern const struct rc_stress_evaluator rc_stress_slices_engine; /* by a row of engines.list */
extern const struct rc_stress_evaluator rc_stress_section;       /* a line at a time         */

#endif
