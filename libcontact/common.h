/*
 * What all folders of libcontact share: loops for wide registers, threads that pay, and sums that
 * keep their digits. Internal: never installed.
 */
#ifndef RC_COMMON_H
#define RC_COMMON_H

#include <math.h>

#include "contact.h"

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

/* Threads that pay on a grid: waking one costs about what a few thousand nodes do. threads 0: as
 * many as there are. */
int rc_useful_threads(const struct rc_shape *shape, size_t threads);

/* Whether one of n values is not 0. */
bool rc_any(const double *v, size_t n);

/* The sum of rc_sum, value by value. */
struct rc_total {
    double sum, lost; /* lost: what the additions have rounded away */
};

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
