/*
 * The whole period is laid out and transformed as a real line. FFTW's even and odd transforms of half a
 * period do not use vector registers and take twice as long (1025 values: 5.0 us against 2.5).
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

/* The real or the imaginary parts, which is every second number, times the sign. */
RC_CLONES static void
take_parts(size_t n, double sign, const double *restrict parts, double *restrict line)
{
    for (size_t k = 0; k < n; k++)
        line[k] = sign * parts[2 * k];
}

void
rc_dct_run(const struct rc_dct *d, bool odd, double *line)
{
    double sign = odd ? -1 : 1, *period;
    double complex *transform;

    if (odd)
        line[0] = line[d->n - 1] = 0;
    if (d->plan == NULL)
        return;
    period = period_of(d);
    transform = transform_of(d, period);
    lay_out(d->n, sign, line, period);
    fftw_execute_dft_r2c(d->plan, period, transform);
    take_parts(d->n, sign, (const double *)transform + odd, line);
}
