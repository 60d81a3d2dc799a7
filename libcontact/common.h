/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Shared by all folders of libcontact: loops for wide registers, numbers of threads, and accurate sums.
 * Internal: never installed.
 */
#ifndef RC_COMMON_H
#define RC_COMMON_H

#include <float.h>
#include <math.h>

#include "contact.h"
#include "owned.h"

RC_OWNER(rc_conv)
RC_OWNER(rc_fatigue)
RC_OWNER(rc_heat)
RC_OWNER(rc_leak)
RC_OWNER(rc_model)
RC_OWNER(rc_patches)
RC_OWNER(rc_psd)
RC_OWNER(rc_relaxation)
RC_OWNER(rc_scene)
RC_OWNER(rc_solver)
RC_OWNER(rc_stress)

#define RC_PI 3.14159265358979323846

/* Inner loops are compiled for wider registers too, and the loader takes what the processor has; some gain
 * from the widest. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define RC_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#define RC_WIDE_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define RC_CLONES
#define RC_WIDE_CLONES
#endif

/* The number of threads for a grid: starting a thread costs as much as a few thousand nodes. threads 0: all
 * cores. */
int rc_useful_threads(const struct rc_shape *shape, size_t threads);

/* True if a value is measured: finite. In loops for wide registers this is faster than isfinite(). */
static inline bool
rc_there(double v)
{
    return fabs(v) <= DBL_MAX;
}

/* The grid with half the nodes a side. A profile stays one node wide. */
static inline struct rc_shape
rc_shape_coarser(const struct rc_shape *s)
{
    return (struct rc_shape){(s->nx + 1) / 2, (s->ny + 1) / 2, s->nx > 1 ? 2 * s->dx : s->dx,
                             s->ny > 1 ? 2 * s->dy : s->dy};
}

/* Appends ": take one of A, B, C" to the sentence, the names of the rows k = 0, 1, ... (NULL past the
 * last), each once. Returns RC_FAIL. */
enum rc_status rc_err_choices(struct rc_err *err, const char *(*row)(const void *of, size_t k),
                              const void *of);

/* The sum of rc_sum, value by value. */
struct rc_total {
    double sum, lost; /* lost: the rounding error of the additions */
};
/* The same of n values; rc_sum is its value. */
struct rc_total rc_total_of(const double *v, size_t n);

/* True if one of n values is not 0. */
bool rc_any(const double *v, size_t n);
/* The largest of n values. */
double rc_highest(const double *v, size_t n);
/* The sum of |a - b| over n values, compensated for rounding; b NULL: of |a|. */
double rc_distance(const double *a, const double *b, size_t n);
struct rc_total rc_distance_of(const double *a, const double *b, size_t n);

static inline void
rc_total_add(struct rc_total *total, double v)
{
    double s = total->sum + v;

    total->lost += fabs(total->sum) >= fabs(v) ? (total->sum - s) + v : (v - s) + total->sum;
    total->sum = s;
}

static inline double
rc_total_value(const struct rc_total *total)
{
    return isfinite(total->sum) ? total->sum + total->lost : total->sum;
}

#endif
