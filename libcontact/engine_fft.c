/*
 * Convolution by fast Fourier transforms on the free half-space.
 *
 * The nx x ny map is padded with zeros to px x py, px >= 2 nx and py >= 2 ny, where the circular
 * convolution equals the sum over the half-space exactly. The padded array is never formed: each
 * row is transformed by itself (real, nx of px values not zero) into `half`, ny rows of px/2 + 1
 * complex numbers; then a few columns at a time are transformed to length py, multiplied, and
 * transformed back, of which ny values are kept; then the rows.
 *
 * A kernel that is even or odd in x and in y has a spectrum that is real up to a power of -i and
 * given by a quarter of it, (px/2 + 1)(py/2 + 1) numbers, from real even or odd transforms of the
 * quarter of the kernel. At the offset of half a period the even kernel's own value stands: with a
 * zero there the spectrum of thin grids turns negative and has no useful inverse.
 *
 * Plans are one-dimensional and estimated: made in no time, and the same on every run.
 */
#include "inside.h"

#include <complex.h> /* before fftw3.h: its complex numbers are then C's own */
#include <fftw3.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum {
    BLOCK = 8 /* columns transformed together: one cache line of `half` is 4 complex numbers */
};

struct rc_fft {
    size_t nx, ny;
    double dx, dy;
    size_t px, py; /* padded lengths, even                        */
    size_t cx;     /* px/2 + 1: columns of the half spectrum       */
    int threads;
    fftw_plan row_forward, row_back, column_forward, column_back;
    fftw_complex *half;    /* ny rows of cx                         */
    fftw_complex *source;  /* cx columns of py: the transform of a loaded map, or NULL */
    double *rows;          /* a row of px and of 2 cx for each thread */
    fftw_complex *columns; /* BLOCK columns of py for each thread   */
};

struct rc_spectrum {
    size_t cx, cy; /* px/2 + 1, py/2 + 1 */
    unsigned parity;
    double *s;     /* cx columns of cy, divided by px py */
};

/* ---- sizes ---- */

/* Smallest even length >= 2n without prime factors over 7. */
static size_t
padded(size_t n)
{
    for (size_t length = 2 * n;; length += 2) {
        size_t rest = length;
        for (size_t f = 2; f <= 7; f++)
            while (rest % f == 0)
                rest /= f;
        if (rest == 1)
            return length;
    }
}

size_t
rc_fft_memory(const struct rc_shape *s)
{
    return s->ny * (padded(s->nx) / 2 + 1) * sizeof(fftw_complex) + rc_spectrum_memory(s);
}

size_t
rc_spectrum_memory(const struct rc_shape *s)
{
    return (padded(s->nx) / 2 + 1) * (padded(s->ny) / 2 + 1) * sizeof(double);
}

static size_t
row_space(const struct rc_fft *f)
{
    return (f->px + 2 * f->cx + 15) & ~(size_t)15;
}

static double *
row_of(const struct rc_fft *f, int thread)
{
    return f->rows + (size_t)thread * row_space(f);
}

static fftw_complex *
columns_of(const struct rc_fft *f, int thread)
{
    return f->columns + (size_t)thread * BLOCK * f->py;
}

static fftw_complex *
half_of_row(const struct rc_fft *f, double *row)
{
    return (fftw_complex *)(void *)(row + f->px + (f->px & 1));
}

/* ---- plan ---- */

static bool
make_plans(struct rc_fft *f)
{
    double *row = f->rows;
    fftw_complex *half = half_of_row(f, row), *column = f->columns;
    unsigned flags = FFTW_ESTIMATE | FFTW_UNALIGNED;

    f->row_forward = fftw_plan_dft_r2c_1d((int)f->px, row, half, flags);
    f->row_back = fftw_plan_dft_c2r_1d((int)f->px, half, row, flags);
    f->column_forward = fftw_plan_dft_1d((int)f->py, column, column, FFTW_FORWARD, flags);
    f->column_back = fftw_plan_dft_1d((int)f->py, column, column, FFTW_BACKWARD, flags);
    return f->row_forward != NULL && f->row_back != NULL && f->column_forward != NULL &&
           f->column_back != NULL;
}

/* Waking a thread costs about what a few thousand nodes do. */
static int
useful_threads(const struct rc_shape *s, size_t threads)
{
    size_t most = 1 + s->nx * s->ny / 8192;

    if (threads == 0)
        threads = rc_threads_available();
    return (int)(threads < most ? threads : most);
}

struct rc_fft *
rc_fft_new(const struct rc_shape *s, size_t threads, struct rc_err *err)
{
    struct rc_fft *f = NULL;

    if (rc_shape_check(s, err) != RC_OK)
        return NULL;
    if (s->nx > (size_t)1 << 29 || s->ny > (size_t)1 << 29) {
        rc_err_set(err, "%zu x %zu nodes: a side is too long for a Fourier transform", s->nx,
                   s->ny);
        return NULL;
    }
    f = calloc(1, sizeof *f);
    if (f == NULL)
        goto short_of_memory;
    f->nx = s->nx;
    f->ny = s->ny;
    f->dx = s->dx;
    f->dy = s->dy;
    f->px = padded(s->nx);
    f->py = padded(s->ny);
    f->cx = f->px / 2 + 1;
    f->threads = useful_threads(s, threads);
    f->half = fftw_alloc_complex(f->ny * f->cx);
    f->rows = fftw_alloc_real((size_t)f->threads * row_space(f));
    f->columns = fftw_alloc_complex((size_t)f->threads * BLOCK * f->py);
    if (f->half == NULL || f->rows == NULL || f->columns == NULL)
        goto short_of_memory;
    if (!make_plans(f)) {
        rc_err_set(err, "FFTW has no plan for %zu x %zu", f->px, f->py);
        rc_fft_free(f);
        return NULL;
    }
    return f;
short_of_memory:
    rc_err_set(err, "out of memory for transforms of %zu x %zu nodes", s->nx, s->ny);
    rc_fft_free(f);
    return NULL;
}

void
rc_fft_free(struct rc_fft *f)
{
    if (f == NULL)
        return;
    fftw_destroy_plan(f->row_forward);
    fftw_destroy_plan(f->row_back);
    fftw_destroy_plan(f->column_forward);
    fftw_destroy_plan(f->column_back);
    fftw_free(f->half);
    fftw_free(f->source);
    fftw_free(f->rows);
    fftw_free(f->columns);
    free(f);
}

/* ---- spectra of kernels ---- */

struct rc_spectrum *
rc_spectrum_new(const struct rc_fft *f, struct rc_err *err)
{
    struct rc_spectrum *k = calloc(1, sizeof *k);

    if (k != NULL) {
        k->cx = f->cx;
        k->cy = f->py / 2 + 1;
        k->s = calloc(k->cx * k->cy, sizeof *k->s);
    }
    if (k == NULL || k->s == NULL) {
        rc_err_set(err, "out of memory for a kernel's spectrum of %zu x %zu numbers", f->cx,
                   f->py / 2 + 1);
        rc_spectrum_free(k);
        return NULL;
    }
    return k;
}

void
rc_spectrum_free(struct rc_spectrum *k)
{
    if (k == NULL)
        return;
    free(k->s);
    free(k);
}

/* Even or odd real transform, in place, of `count` lines of n values each. A line holds half a
 * period with both ends; an odd kernel is zero at both, its transform too. */
static bool
transform_lines(double *lines, size_t n, size_t count, bool odd, int threads)
{
    size_t inner = odd ? n - 2 : n; /* n = length/2 + 1 >= 2 */
    size_t start = odd ? 1 : 0;
    fftw_plan plan = NULL;

    if (inner > 0) {
        plan = fftw_plan_r2r_1d((int)inner, lines + start, lines + start,
                                odd ? FFTW_RODFT00 : FFTW_REDFT00, FFTW_ESTIMATE | FFTW_UNALIGNED);
        if (plan == NULL)
            return false;
    }
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t c = 0; c < count; c++) {
        double *line = lines + c * n;
        if (odd)
            line[0] = line[n - 1] = 0;
        if (plan != NULL)
            fftw_execute_r2r(plan, line + start, line + start);
    }
    fftw_destroy_plan(plan);
    return true;
}

enum rc_status
rc_spectrum_set(struct rc_spectrum *k, const struct rc_fft *f, const struct rc_kernel *kernel,
                size_t component, const struct rc_medium *medium, struct rc_err *err)
{
    enum {
        ROWS = 8
    };
    const struct rc_lattice nodes = {f->dx, f->dy, 1, 1};
    size_t chunks = (k->cy + ROWS - 1) / ROWS;
    double scale = 1 / ((double)f->px * (double)f->py);
    double *table = malloc(k->cx * k->cy * sizeof *table);

    if (table == NULL)
        return rc_err_set(err, "out of memory for a kernel of %zu x %zu values", k->cx, k->cy);
    k->parity = kernel->parity[component];
#pragma omp parallel for num_threads(f->threads) schedule(dynamic)
    for (size_t c = 0; c < chunks; c++) {
        size_t first = c * ROWS, last = first + ROWS < k->cy ? first + ROWS : k->cy;
        kernel->rows(medium, component, &nodes, k->cx, first, last, table + first * k->cx);
    }
    if (!transform_lines(table, k->cx, k->cy, k->parity & RC_ODD_X, f->threads))
        goto no_plan;
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t i = 0; i < k->cx; i++)
        for (size_t j = 0; j < k->cy; j++)
            k->s[i * k->cy + j] = scale * table[j * k->cx + i];
    if (!transform_lines(k->s, k->cy, k->cx, k->parity & RC_ODD_Y, f->threads))
        goto no_plan;
    free(table);
    return RC_OK;
no_plan:
    free(table);
    return rc_err_set(err, "FFTW has no plan for a kernel of %zu x %zu values", k->cx, k->cy);
}

void
rc_spectrum_invert(struct rc_spectrum *k)
{
    size_t n = k->cx * k->cy;
    double scale = 1 / (4 * (double)(k->cx - 1) * (double)(k->cy - 1)); /* 1 / (px py) */

    for (size_t i = 0; i < n; i++)
        k->s[i] = scale * scale / k->s[i];
}

/* ---- one pass each ---- */

static void
rows_forward(struct rc_fft *f, const double *p)
{
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t j = 0; j < f->ny; j++) {
        double *row = row_of(f, omp_get_thread_num());
        memcpy(row, p + j * f->nx, f->nx * sizeof *row);
        memset(row + f->nx, 0, (f->px - f->nx) * sizeof *row);
        fftw_execute_dft_r2c(f->row_forward, row, f->half + j * f->cx);
    }
}

static void
rows_back(struct rc_fft *f, double *u)
{
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t j = 0; j < f->ny; j++) {
        double *row = row_of(f, omp_get_thread_num());
        fftw_execute_dft_c2r(f->row_back, f->half + j * f->cx, row);
        memcpy(u + j * f->nx, row, f->nx * sizeof *row);
    }
}

/* Columns first .. first+n-1 of `half` into `column`, each padded to py. */
static void
gather(const struct rc_fft *f, size_t first, size_t n, fftw_complex *column)
{
    for (size_t j = 0; j < f->ny; j++)
        for (size_t b = 0; b < n; b++)
            column[b * f->py + j] = f->half[j * f->cx + first + b];
    for (size_t b = 0; b < n; b++)
        memset(column + b * f->py + f->ny, 0, (f->py - f->ny) * sizeof *column);
}

static void
scatter(struct rc_fft *f, size_t first, size_t n, const fftw_complex *column)
{
    for (size_t j = 0; j < f->ny; j++)
        for (size_t b = 0; b < n; b++)
            f->half[j * f->cx + first + b] = column[b * f->py + j];
}

/* out = in * spectrum on one column. An odd direction brings a factor -i, and the sign of the
 * wavenumber: that of x is never negative here, that of y is beyond the middle. */
static void
multiply(const struct rc_spectrum *k, size_t c, size_t py, const fftw_complex *in,
         fftw_complex *out)
{
    const double *s = k->s + c * k->cy;
    double mirror = k->parity & RC_ODD_Y ? -1 : 1;
    int turns = ((k->parity & RC_ODD_X) != 0) + ((k->parity & RC_ODD_Y) != 0);

    for (size_t q = 0; q < py; q++) {
        double a = q < k->cy ? s[q] : mirror * s[py - q];
        if (turns == 0)
            out[q] = a * in[q];
        else if (turns == 1)
            out[q] = CMPLX(a * cimag(in[q]), -a * creal(in[q]));
        else
            out[q] = -a * in[q];
    }
}

void
rc_fft_apply(struct rc_fft *f, const struct rc_spectrum *k, const double *p, double *u)
{
    rows_forward(f, p);
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t c = 0; c < f->cx; c += BLOCK) {
        size_t n = f->cx - c < BLOCK ? f->cx - c : BLOCK;
        fftw_complex *column = columns_of(f, omp_get_thread_num());
        gather(f, c, n, column);
        for (size_t b = 0; b < n; b++) {
            fftw_complex *one = column + b * f->py;
            fftw_execute_dft(f->column_forward, one, one);
            multiply(k, c + b, f->py, one, one);
            fftw_execute_dft(f->column_back, one, one);
        }
        scatter(f, c, n, column);
    }
    rows_back(f, u);
}

enum rc_status
rc_fft_load(struct rc_fft *f, const double *p, struct rc_err *err)
{
    if (f->source == NULL && (f->source = fftw_alloc_complex(f->cx * f->py)) == NULL)
        return rc_err_set(err, "out of memory for the transform of %zu x %zu nodes", f->nx, f->ny);
    rows_forward(f, p);
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t c = 0; c < f->cx; c += BLOCK) {
        size_t n = f->cx - c < BLOCK ? f->cx - c : BLOCK;
        fftw_complex *column = f->source + c * f->py;
        gather(f, c, n, column);
        for (size_t b = 0; b < n; b++)
            fftw_execute_dft(f->column_forward, column + b * f->py, column + b * f->py);
    }
    return RC_OK;
}

void
rc_fft_field(struct rc_fft *f, const struct rc_spectrum *k, double *u)
{
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t c = 0; c < f->cx; c += BLOCK) {
        size_t n = f->cx - c < BLOCK ? f->cx - c : BLOCK;
        fftw_complex *column = columns_of(f, omp_get_thread_num());
        for (size_t b = 0; b < n; b++) {
            fftw_complex *one = column + b * f->py;
            multiply(k, c + b, f->py, f->source + (c + b) * f->py, one);
            fftw_execute_dft(f->column_back, one, one);
        }
        scatter(f, c, n, column);
    }
    rows_back(f, u);
}

/* ---- the row ---- */

struct plan {
    struct rc_fft *fft;
    struct rc_spectrum *kernel;
};

static void
plan_free(void *at)
{
    struct plan *plan = at;

    if (plan == NULL)
        return;
    rc_fft_free(plan->fft);
    rc_spectrum_free(plan->kernel);
    free(plan);
}

static void *
plan_new(const struct rc_sum *sum, struct rc_err *err)
{
    struct plan *plan = calloc(1, sizeof *plan);

    if (plan == NULL) {
        rc_err_set(err, "out of memory for a plan");
        return NULL;
    }
    if ((plan->fft = rc_fft_new(&sum->shape, sum->threads, err)) == NULL ||
        (plan->kernel = rc_spectrum_new(plan->fft, err)) == NULL ||
        rc_spectrum_set(plan->kernel, plan->fft, sum->kernel, sum->component, &sum->medium, err) !=
            RC_OK) {
        plan_free(plan);
        return NULL;
    }
    return plan;
}

static size_t
memory(const struct rc_sum *sum)
{
    return rc_fft_memory(&sum->shape);
}

/* Rounding grows with the depth of the transforms. */
static double
error(const void *at)
{
    const struct plan *plan = at;

    return 1e-16 * log2((double)plan->fft->px * (double)plan->fft->py);
}

static void
plan_apply(void *at, const double *p, double *u)
{
    struct plan *plan = at;

    rc_fft_apply(plan->fft, plan->kernel, p, u);
}

const struct rc_engine rc_engine_fft = {
    .name = "fft",
    .summary = "fast Fourier transforms with zero padding: exact to rounding, N log N",
    .memory = memory,
    .new = plan_new,
    .apply = plan_apply,
    .error = error,
    .free = plan_free,
};
