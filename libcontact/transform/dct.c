/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The whole period is laid out and transformed as a real line. An even line has a real transform and an odd
 * one an imaginary transform, so that one transform of their sum serves both. FFTW's even and odd transforms
 * of half a period do not use vector registers and take twice as long (1025 values: 5.0 us against 2.5).
 */
#include "dct.h"

#include <complex.h> /* before fftw3.h: its complex numbers are then C's own */
#include <fftw3.h>
#include <limits.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "planner.h"
#include "libcontact/common.h"
#include "libcontact/memory.h"

struct rc_dct {
    size_t n;
    fftw_plan plan;    /* plan of the whole period; NULL for a single value, which needs none */
    size_t per_thread; /* doubles of scratch of one thread                               */
    double *scratch;   /* memory for each thread: the period, and its transform */
};

/* FFTW uses vector registers only on aligned data: both arrays begin a cache line. */
static size_t
whole_lines(size_t n)
{
    return (n + 7) / 8 * 8;
}

static double *
period_of(const struct rc_dct *d)
{
    return d->scratch + (size_t)omp_get_thread_num() * d->per_thread;
}

static double complex *
transform_of(const struct rc_dct *d, double *period)
{
    return (double complex *)(void *)(period + whole_lines(2 * d->n - 2));
}

struct rc_dct *
rc_dct_new(size_t n, size_t threads, struct rc_err *err)
{
    struct rc_dct *d = calloc(1, sizeof *d);
    size_t period = 2 * n - 2;

    if (d == NULL || n > INT_MAX / 2)
        goto fail;
    d->n = n;
    if (n == 1)
        return d;
    d->per_thread = whole_lines(period) + whole_lines(period + 2);
    d->scratch = rc_alloc(threads * d->per_thread, sizeof *d->scratch);
    if (d->scratch == NULL)
        goto fail;
    rc_planner_lock();
    d->plan =
        fftw_plan_dft_r2c_1d((int)period, d->scratch, transform_of(d, d->scratch), FFTW_ESTIMATE);
    rc_planner_unlock();
    if (d->plan != NULL)
        return d;
fail:
    rc_err_set(err, "out of memory for a transform of %zu values", n);
    rc_dct_free(d);
    return NULL;
}

void
rc_dct_free(struct rc_dct *d)
{
    if (d == NULL)
        return;
    rc_planner_lock();
    fftw_destroy_plan(d->plan);
    rc_planner_unlock();
    free(d->scratch);
    free(d);
}

RC_CLONES static void
lay_out(size_t n, double sign, const double *restrict line, double *restrict period)
{
    double *end = period + 2 * n - 2;

    memcpy(period, line, n * sizeof *period);
    for (size_t j = 1; j + 1 < n; j++)
        *(end - j) = sign * line[j];
}

/* The sum of an even and an odd line. */
RC_CLONES static void
lay_out_both(size_t n, const double *restrict even, const double *restrict odd,
             double *restrict period)
{
    double *end = period + 2 * n - 2;

    period[0] = even[0];
    period[n - 1] = even[n - 1];
    for (size_t j = 1; j + 1 < n; j++) {
        period[j] = even[j] + odd[j];
        *(end - j) = even[j] - odd[j];
    }
}

/* The real or the imaginary parts, which is every second number, times the sign. */
RC_CLONES static void
take_parts(size_t n, double sign, const double *restrict parts, double *restrict line)
{
    for (size_t k = 0; k < n; k++)
        line[k] = sign * parts[2 * k];
}

/* Either may be NULL. */
static void
run(const struct rc_dct *d, double *even, double *odd)
{
    double *period;
    double complex *transform;

    if (odd != NULL)
        odd[0] = odd[d->n - 1] = 0;
    if (d->plan == NULL)
        return;
    period = period_of(d);
    transform = transform_of(d, period);
    if (even != NULL && odd != NULL)
        lay_out_both(d->n, even, odd, period);
    else
        lay_out(d->n, even != NULL ? 1 : -1, even != NULL ? even : odd, period);
    fftw_execute_dft_r2c(d->plan, period, transform);
    if (even != NULL)
        take_parts(d->n, 1, (const double *)transform, even);
    if (odd != NULL)
        take_parts(d->n, -1, (const double *)transform + 1, odd);
}

/* The first line of this parity from *k on, which is set to the next one; NULL: none. */
static double *
next_line(size_t count, unsigned odd, double *const *lines, bool of_odd, size_t *k)
{
    while (*k < count && (lines[*k] == NULL || (odd >> *k & 1) != of_odd))
        ++*k;
    return *k < count ? lines[(*k)++] : NULL;
}

void
rc_dct_run(const struct rc_dct *d, size_t count, unsigned odd, double *const *lines)
{
    size_t i = 0, j = 0;

    for (;;) {
        double *a = next_line(count, odd, lines, false, &i);
        double *b = next_line(count, odd, lines, true, &j);
        if (a == NULL && b == NULL)
            return;
        run(d, a, b);
    }
}
