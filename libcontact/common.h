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

/* True if one of n values is not 0. */
bool rc_any(const double *v, size_t n);
/* The largest of n values. */
double rc_highest(const double *v, size_t n);
/* The sum of |a - b| over n values, compensated for rounding; b NULL: of |a|. */
double rc_distance(const double *a, const double *b, size_t n);

/* The sum of rc_sum, value by value. */
struct rc_total {
    double sum, lost; /* lost: the rounding error of the additions */
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

/* Sums over a map that depend neither on the number of threads nor on the thread of a row or block. Each row
 * is summed separately, and the rows are added in their order, with compensation for rounding. A row has
 * `sums` numbers to add, and after them `mosts` numbers to take the largest of. */
enum {
    RC_SUMS_MOST = 16 /* numbers that are added */
};
struct rc_sums {
    double *row;
    size_t rows, sums, mosts;
    int threads;
};

/* RC_FAIL: memory is short; free(sums.row) in either case. */
enum rc_status rc_sums_new(struct rc_sums *s, size_t rows, size_t sums, size_t mosts, int threads);
/* The numbers of row j: 0 after rc_sums_clear. */
static inline double *
rc_sums_of(const struct rc_sums *s, size_t j)
{
    return s->row + j * (s->sums + s->mosts);
}
void rc_sums_clear(const struct rc_sums *s);
/* Totals of the `sums` numbers, for ranks to add to theirs, and the `mosts` largest numbers. */
void rc_sums_add(const struct rc_sums *s, struct rc_total *total, double *most);
/* The totals as numbers, followed by the largest numbers. */
void rc_sums_total(const struct rc_sums *s, double *total);
/* Clears the sums, calls the function of each row, and totals the sums. */
typedef void rc_sums_work(void *ctx, size_t j, double *sums);
void rc_sums_rows(const struct rc_sums *s, rc_sums_work *work, void *ctx, double *total);

#endif
