/*
 * The stresses of a half-space by their parts: for each component its parity, what a point load
 * does, what a uniformly loaded cell does, and what a wave does; and how they are summed over a
 * map. Internal: never installed.
 */
#ifndef RC_STRESS_H
#define RC_STRESS_H

#include <math.h>

#include "libcontact/operator/operator.h"

/* These loops gain from the widest registers. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define RC_WIDE_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define RC_WIDE_CLONES
#endif

/* ---- of a unit load: kernel_stress.c ---- */

enum {
    RC_NORMAL, /* a unit pressure                              */
    RC_SHEAR,  /* a unit traction along +x on the body         */
    RC_LOADS,
    RC_STRESS_KERNELS = RC_LOADS * RC_COMPONENTS /* load * RC_COMPONENTS + component */
};

/* Points seen from a unit force at the origin: x, y, 1/R and 1/(R + z), all at the depth z. */
struct rc_points {
    size_t n;
    const double *x, *y, *r, *w;
    double z, nu;
};

/* A corner of a cell seen from the point of the field: X, Y and the distance R, at depth z. */
struct rc_corner {
    double x, y, z, r, nu;
    double floor; /* least distance from an edge that a logarithm is taken at, m */
};

/* Waves: their directions qx/q and qy/q, their wave numbers q and what exp(-q z) leaves of them at
 * the depth z. Only the first may have q = 0. */
struct rc_waves {
    size_t n;
    const double *x, *y, *q, *decay;
    double z, nu;
    const struct rc_inside *inside; /* of a coated body; then also, of each wave: */
    const double *numbers;          /* rc_inside_wave instead of decay            */
};

struct rc_stress_forms {
    int same; /* a kernel that has the same values in one material, or -1 */
    /* out[i] += weight * 2 pi times the stress of a unit force. */
    void (*point)(const struct rc_points *points, double weight, double *out);
    /* Antiderivative in X and Y of 2 pi times that stress. */
    double (*corner)(const struct rc_corner *corner);
    /* Transform over (-i)^(number of odd directions), of each wave; q > 0. */
    void (*symbol)(const struct rc_waves *waves, double *out);
};
extern const struct rc_stress_forms rc_stress_forms[RC_STRESS_KERNELS];
extern const unsigned rc_stress_parity[RC_STRESS_KERNELS];

/* Directions and wave numbers of the waves (qx[k], qy[k]); of q = 0 the direction is 0, 0. */
void rc_stress_directions(size_t n, const double *qx, const double *qy, double *x, double *y,
                          double *q);
/* The symbol of a kernel at each wave; at q = 0 its mean on the periodic map, which is the same at
 * any depth. */
void rc_stress_symbol(int kernel, const struct rc_waves *waves, const struct rc_shape *shape,
                      double *out);

/* The kernel of a load and component, or the one that has the same values. */
int rc_stress_kernel(int load, int component, bool coated);
/* Bits of those that these components (bits) need, of the shear too or not. */
unsigned rc_stress_distinct(unsigned components, bool shear, bool coated);

/* ---- of a cell: cell.c ---- */

/* A cell and where it is seen from. */
struct rc_cell {
    double dx, dy; /* m          */
    double depth;  /* m          */
    double nu;
    const struct rc_inside *inside; /* at this depth of a coated body, instead of nu; or NULL */
};

/* Stresses at (x[i], y[i]), i < n, of unit load on the cell about the origin, of every kernel whose
 * bit is set, to out[kernel][i]. */
void rc_stress_coefficients(const struct rc_cell *cell, unsigned kernels, size_t n, const double *x,
                            const double *y, double *const out[RC_STRESS_KERNELS]);

/* The same at (i step, y), i < n; faster where the step is that from cell to cell, dx. */
void rc_stress_line(const struct rc_cell *cell, unsigned kernels, double step, size_t n, double y,
                    double *const out[RC_STRESS_KERNELS]);

/* ---- sums over a map ---- */

/* What is to be summed, and the tally of what it took. */
struct rc_stress_task {
    struct rc_shape shape;
    struct rc_stress_options options;
    const double *p; /* stays the caller's                                             */
    bool coated;
    const struct rc_stack *stack; /* of a coated body that is to be computed                    */
    unsigned components; /* bits of the six: what is wanted and what that is derived from  */
    unsigned kernels;    /* bits: what these need, one of each set of equals               */
    const struct rc_engine *engine; /* asked for or taken; NULL: there is none of that name */
    bool precise;                   /* in double precision throughout, as its name asks     */
    struct rc_stress_counts *counts;
};
/* Counts a kernel that is evaluated: shear is what would not be without the traction. */
void rc_stress_count(const struct rc_stress_task *task, int kernel, size_t coefficients);

/* ---- of a coated body: layered.c ---- */

/* One depth of it. */
struct rc_inside *rc_inside_new(const struct rc_stress_task *task, double depth,
                                struct rc_err *err);
void rc_inside_free(struct rc_inside *inside); /* NULL is allowed */
size_t rc_inside_memory(const struct rc_stress_task *task);
/* Whether closed forms, of this nu, are a part of it. */
bool rc_inside_closed(const struct rc_inside *inside, double *nu);
/* Numbers that are known of a wave, and these: see rc_stack_inside. */
size_t rc_inside_numbers(const struct rc_inside *inside);
void rc_inside_wave(const struct rc_inside *inside, double q, double *out);
/* The symbol of a kernel, from the numbers of each of n waves; and the mean on the periodic map. */
void rc_inside_symbol(const struct rc_inside *inside, int kernel, size_t n, const double *x,
                      const double *y, const double *numbers, double *out);
double rc_inside_mean(const struct rc_inside *inside, int kernel, const struct rc_shape *shape);
/* Adds what no closed form knows to rc_stress_coefficients, and to rc_stress_line. */
void rc_inside_add(const struct rc_cell *cell, unsigned kernels, size_t n, const double *x,
                   const double *y, double *const out[RC_STRESS_KERNELS]);
void rc_inside_add_line(const struct rc_cell *cell, unsigned kernels, double step, size_t n,
                        double y, double *const out[RC_STRESS_KERNELS]);

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
