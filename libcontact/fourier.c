#include "fourier.h"

#include <fftw3.h> /* after complex.h: fftw_complex is then double complex */
#include <limits.h>
#include <stdlib.h>

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

struct rc_halves {
    size_t n;
    bool odd;
    fftw_plan plan; /* NULL: an odd line without inner values */
};

struct rc_halves *
rc_halves_new(size_t n, bool odd, struct rc_err *err)
{
    struct rc_halves *h = calloc(1, sizeof *h);
    size_t inner = odd ? n - 2 : n;
    double *line = fftw_alloc_real(n);
    fftw_r2r_kind kind = odd ? FFTW_RODFT00 : FFTW_REDFT00;

    if (h == NULL || line == NULL || inner > INT_MAX)
        goto fail;
    h->n = n;
    h->odd = odd;
    if (inner > 0) {
#pragma omp critical(rc_fftw_planner)
        h->plan = fftw_plan_r2r_1d((int)inner, line, line, kind, FFTW_ESTIMATE | FFTW_UNALIGNED);
        if (h->plan == NULL)
            goto fail;
    }
    fftw_free(line);
    return h;
fail:
    rc_err_set(err, "out of memory for a transform of %zu values", n);
    fftw_free(line);
    free(h);
    return NULL;
}

void
rc_halves_run(const struct rc_halves *h, double *line)
{
    double *inner = line + (h->odd ? 1 : 0);

    if (h->odd)
        line[0] = line[h->n - 1] = 0;
    if (h->plan != NULL)
        fftw_execute_r2r(h->plan, inner, inner);
}

void
rc_halves_free(struct rc_halves *h)
{
    if (h == NULL)
        return;
#pragma omp critical(rc_fftw_planner)
    fftw_destroy_plan(h->plan);
    free(h);
}
