/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fourier.h"

#include <fftw3.h> /* after complex.h: fftw_complex is then double complex */
#include <limits.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "planner.h"

size_t
rc_fourier_columns(const struct rc_shape *shape)
{
    return shape->nx / 2 + 1;
}

size_t
rc_fourier_size(const struct rc_shape *shape)
{
    return shape->ny * rc_fourier_columns(shape);
}

/* Runs a plan and frees it. Plans are made without measuring, so that the same map gives the same bytes in
 * every run. */
static enum rc_status
run(const struct rc_shape *shape, fftw_plan plan, struct rc_err *err)
{
    if (plan == NULL)
        return rc_err_set(err, "out of memory for the Fourier transform of %zu x %zu nodes",
                          shape->nx, shape->ny);
    fftw_execute(plan);
    rc_planner_lock();
    fftw_destroy_plan(plan);
    rc_planner_unlock();
    return RC_OK;
}

enum rc_status
rc_fourier_check(const struct rc_shape *shape, struct rc_err *err)
{
    if (shape->nx > INT_MAX || shape->ny > INT_MAX)
        return rc_err_set(err, "%zu x %zu nodes: a side of at most %d can be transformed",
                          shape->nx, shape->ny, INT_MAX);
    return RC_OK;
}

size_t
rc_fourier_length(size_t n, size_t step)
{
    for (size_t length = (2 * n + step - 1) / step * step;; length += step) {
        size_t rest = length;
        for (size_t f = 2; f <= 7; f++)
            while (rest % f == 0)
                rest /= f;
        if (rest == 1)
            return length;
    }
}

enum rc_status
rc_fourier_forward(const struct rc_shape *shape, const double *v, double complex *s,
                   struct rc_err *err)
{
    size_t columns = rc_fourier_columns(shape);
    double *map = (double *)s;
    fftw_plan plan;

    if (rc_fourier_check(shape, err) != RC_OK)
        return RC_FAIL;
    rc_planner_lock();
    plan = fftw_plan_dft_r2c_2d((int)shape->ny, (int)shape->nx, map, s, FFTW_ESTIMATE);
    rc_planner_unlock();
    for (size_t j = 0; plan != NULL && j < shape->ny; j++)
        memcpy(map + 2 * j * columns, v + j * shape->nx, shape->nx * sizeof *v);
    return run(shape, plan, err);
}

enum rc_status
rc_fourier_backward(const struct rc_shape *shape, double complex *s, double *v, struct rc_err *err)
{
    fftw_plan plan;

    if (rc_fourier_check(shape, err) != RC_OK)
        return RC_FAIL;
    rc_planner_lock();
    plan = fftw_plan_dft_c2r_2d((int)shape->ny, (int)shape->nx, s, v,
                                FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
    rc_planner_unlock();
    return run(shape, plan, err);
}

/* ---- columns ---- */

enum {
    LANES = 4 /* neighbouring columns that are copied together: a cache line of numbers */
};

enum rc_status
rc_fourier_columns_backward(size_t ny, size_t wide, int threads, double complex *s,
                            struct rc_err *err)
{
    const size_t length = (ny + 3) / 4 * 4, room = LANES * length;
    RC_OWNED double complex *scratch = aligned_alloc(64, (size_t)threads * room * sizeof *scratch);
    fftw_plan plan = NULL;

    if (scratch != NULL) {
        rc_planner_lock();
        plan = fftw_plan_dft_1d((int)ny, scratch, scratch, FFTW_BACKWARD, FFTW_ESTIMATE);
        rc_planner_unlock();
    }
    if (plan == NULL)
        return rc_err_set(err, "out of memory for a transform of %zu values", ny);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t i = 0; i < wide; i += LANES) {
        double complex *column = scratch + (size_t)omp_get_thread_num() * room;
        const size_t lanes = wide - i < LANES ? wide - i : LANES;

        for (size_t j = 0; j < ny; j++)
            for (size_t l = 0; l < lanes; l++)
                column[l * length + j] = s[j * wide + i + l];
        for (size_t l = 0; l < lanes; l++)
            fftw_execute_dft(plan, column + l * length, column + l * length);
        for (size_t j = 0; j < ny; j++)
            for (size_t l = 0; l < lanes; l++)
                s[j * wide + i + l] = column[l * length + j];
    }
    rc_planner_lock();
    fftw_destroy_plan(plan);
    rc_planner_unlock();
    return RC_OK;
}

/* ---- lines ---- */

struct rc_line {
    size_t n;
    size_t per_thread; /* doubles of scratch of one thread */
    fftw_plan forward, backward;
    double *scratch;
};

static double *
values_of(const struct rc_line *l)
{
    return l->scratch + (size_t)omp_get_thread_num() * l->per_thread;
}

static double complex *
waves_of(const struct rc_line *l)
{
    return (double complex *)(void *)(values_of(l) + (l->n + 7) / 8 * 8);
}

struct rc_line *
rc_line_new(size_t n, size_t threads, struct rc_err *err)
{
    struct rc_line *l = calloc(1, sizeof *l);

    if (l == NULL || n > INT_MAX)
        goto fail;
    l->n = n;
    l->per_thread = (n + 7) / 8 * 8 + (n + 2 + 15) / 16 * 16;
    l->scratch = aligned_alloc(64, (threads * l->per_thread * sizeof(double) + 63) / 64 * 64);
    if (l->scratch == NULL)
        goto fail;
    rc_planner_lock();
    l->forward = fftw_plan_dft_r2c_1d((int)n, values_of(l), waves_of(l), FFTW_ESTIMATE);
    l->backward = fftw_plan_dft_c2r_1d((int)n, waves_of(l), values_of(l), FFTW_ESTIMATE);
    rc_planner_unlock();
    if (l->forward != NULL && l->backward != NULL)
        return l;
fail:
    rc_err_set(err, "out of memory for a transform of %zu values", n);
    rc_line_free(l);
    return NULL;
}

void
rc_line_forward(const struct rc_line *l, const double *v, double complex *s)
{
    memcpy(values_of(l), v, l->n * sizeof *v);
    fftw_execute_dft_r2c(l->forward, values_of(l), waves_of(l));
    memcpy(s, waves_of(l), (l->n / 2 + 1) * sizeof *s);
}

void
rc_line_backward(const struct rc_line *l, const double complex *s, double *v)
{
    memcpy(waves_of(l), s, (l->n / 2 + 1) * sizeof *s);
    fftw_execute_dft_c2r(l->backward, waves_of(l), values_of(l));
    memcpy(v, values_of(l), l->n * sizeof *v);
}

void
rc_line_free(struct rc_line *l)
{
    if (l == NULL)
        return;
    rc_planner_lock();
    fftw_destroy_plan(l->forward);
    fftw_destroy_plan(l->backward);
    rc_planner_unlock();
    free(l->scratch);
    free(l);
}
