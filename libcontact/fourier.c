#include "fourier.h"

#include <fftw3.h> /* after complex.h: fftw_complex is then double complex */
#include <limits.h>

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

long
rc_fourier_number(size_t k, size_t n)
{
    return 2 * k <= n ? (long)k : -(long)(n - k);
}

/* Plans without measuring, so that the same map gives the same bytes each time. One of v and s is
 * the input. */
static enum rc_status
transform(const struct rc_shape *shape, bool forward, double *v, double complex *s,
          struct rc_err *err)
{
    const unsigned how = FFTW_ESTIMATE | (forward ? FFTW_PRESERVE_INPUT : FFTW_DESTROY_INPUT);
    fftw_plan plan;

    if (shape->nx > INT_MAX || shape->ny > INT_MAX)
        return rc_err_set(err, "%zu x %zu nodes: a side of at most %d can be transformed",
                          shape->nx, shape->ny, INT_MAX);
    /* The planner is the one part of FFTW that two threads may not enter at once. */
#pragma omp critical(rc_fftw_planner)
    plan = forward ? fftw_plan_dft_r2c_2d((int)shape->ny, (int)shape->nx, v, s, how)
                   : fftw_plan_dft_c2r_2d((int)shape->ny, (int)shape->nx, s, v, how);
    if (plan == NULL)
        return rc_err_set(err, "out of memory for the Fourier transform of %zu x %zu nodes",
                          shape->nx, shape->ny);
    fftw_execute(plan);
#pragma omp critical(rc_fftw_planner)
    fftw_destroy_plan(plan);
    return RC_OK;
}

enum rc_status
rc_fourier_forward(const struct rc_shape *shape, const double *v, double complex *s,
                   struct rc_err *err)
{
    return transform(shape, true, (double *)v, s, err);
}

enum rc_status
rc_fourier_backward(const struct rc_shape *shape, double complex *s, double *v,
                    struct rc_err *err)
{
    return transform(shape, false, v, s, err);
}

enum rc_status
rc_fourier_halves(double *lines, size_t n, size_t count, bool odd, int threads,
                  struct rc_err *err)
{
    size_t inner = odd ? n - 2 : n, start = odd ? 1 : 0;
    fftw_plan plan = NULL;

    if (inner > INT_MAX)
        return rc_err_set(err, "%zu nodes: a side of at most %d can be transformed", n, INT_MAX);
    if (inner > 0) {
#pragma omp critical(rc_fftw_planner)
        plan = fftw_plan_r2r_1d((int)inner, lines + start, lines + start,
                                odd ? FFTW_RODFT00 : FFTW_REDFT00, FFTW_ESTIMATE | FFTW_UNALIGNED);
        if (plan == NULL)
            return rc_err_set(err, "out of memory for a transform of %zu values", n);
    }
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t c = 0; c < count; c++) {
        double *line = lines + c * n;
        if (odd)
            line[0] = line[n - 1] = 0;
        if (plan != NULL)
            fftw_execute_r2r(plan, line + start, line + start);
    }
#pragma omp critical(rc_fftw_planner)
    fftw_destroy_plan(plan);
    return RC_OK;
}
