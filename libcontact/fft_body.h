/*
 * Rows, columns and multiplication of the transform engine, in one precision: REAL, COMPLEX,
 * FFTW(name) and C99(name) are set by the file that includes this.
 *
 * The padded array is never formed. Each row is transformed by itself (real, nx of px values not
 * zero) into `half`, ny rows of px/2 + 1 complex numbers; then the columns, one cache line of them
 * at a time: gathered, transformed to length py, multiplied, transformed back, and the ny values
 * that are wanted scattered; then the rows. Every pass reads and writes each number once.
 *
 * Plans are one-dimensional, out of place and estimated: for the lengths that arise after splitting
 * they are as fast as measured ones within a tenth, are made in no time, and are the same on
 * every run.
 */
#include <complex.h> /* before fftw3.h: its complex numbers are then C's own */
#include <fftw3.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "fft.h"

enum {
    LINE = 64 / sizeof(COMPLEX), /* columns in a cache line */
    GAP = 8,                     /* complex numbers between pieces: equal places in different pieces
                                    would else fall on the same lines of the cache */
};

struct plan {
    struct rc_layout l;
    FFTW(plan) row_forward, row_back, column_forward, column_back;
    COMPLEX *half;    /* ny rows of `stride`                                                  */
    COMPLEX *source;  /* cx columns of py, transformed: a loaded map; or NULL                  */
    COMPLEX *twiddle; /* w^n, w^2n, w^3n for n < m (split 4)                                   */
    COMPLEX *scratch; /* for each thread: LINE columns, one more, and a row                    */
    size_t column;    /* complex numbers of one column in scratch: split pieces and gaps       */
    size_t space;     /* complex numbers of scratch of one thread                              */
};

static size_t
piece(const struct plan *f)
{
    return f->l.m + GAP;
}

static void
plan_free(void *at)
{
    struct plan *f = at;

    if (f == NULL)
        return;
#pragma omp critical(rc_fftw_planner)
    {
        FFTW(destroy_plan)(f->row_forward);
        FFTW(destroy_plan)(f->row_back);
        FFTW(destroy_plan)(f->column_forward);
        FFTW(destroy_plan)(f->column_back);
    }
    FFTW(free)(f->half);
    FFTW(free)(f->source);
    FFTW(free)(f->twiddle);
    FFTW(free)(f->scratch);
    free(f);
}

/* Where a thread's row (px reals and px/2 + 1 complex numbers) lies in its scratch. */
static COMPLEX *
row_of(const struct plan *f, COMPLEX *scratch)
{
    return scratch + (LINE + 1) * f->column;
}

static bool
make_plans(struct plan *f)
{
    const unsigned how = FFTW_ESTIMATE | FFTW_UNALIGNED;
    COMPLEX *a = f->scratch, *b = a + f->column, *half = row_of(f, a);
    REAL *row = (REAL *)(half + f->l.cx);
    int px = (int)f->l.px, m = (int)f->l.m;

    /* The planner is the one part of FFTW that two threads may not enter at once. */
#pragma omp critical(rc_fftw_planner)
    {
        f->row_forward = FFTW(plan_dft_r2c_1d)(px, row, half, how);
        f->row_back = FFTW(plan_dft_c2r_1d)(px, half, row, how);
        f->column_forward = FFTW(plan_dft_1d)(m, a, b, FFTW_FORWARD, how);
        f->column_back = FFTW(plan_dft_1d)(m, a, b, FFTW_BACKWARD, how);
    }
    return f->row_forward != NULL && f->row_back != NULL && f->column_forward != NULL &&
           f->column_back != NULL;
}

static void
make_twiddles(struct plan *f)
{
    const double turn = -2 * 3.14159265358979323846 / (double)f->l.py;
    size_t m = f->l.m;

    for (size_t n = 0; n < m; n++)
        for (size_t r = 1; r < 4; r++) {
            double angle = turn * (double)(r * n);
            f->twiddle[(r - 1) * m + n] = (COMPLEX)(cos(angle) + I * sin(angle));
        }
}

static void *
plan_new(const struct rc_layout *l)
{
    struct plan *f = calloc(1, sizeof *f);

    if (f == NULL)
        return NULL;
    f->l = *l;
    f->column = (l->split * (l->m + GAP) + LINE - 1) / LINE * LINE;
    f->space = (LINE + 1) * f->column + (l->cx + l->px / 2 + 1 + 2 * LINE) / LINE * LINE;
    f->half = FFTW(alloc_complex)(l->ny * l->stride);
    f->scratch = FFTW(alloc_complex)((size_t)l->threads * f->space);
    f->twiddle = FFTW(alloc_complex)(3 * l->m);
    if (f->half == NULL || f->scratch == NULL || f->twiddle == NULL || !make_plans(f)) {
        plan_free(f);
        return NULL;
    }
    if (l->split == 4)
        make_twiddles(f);
    return f;
}

static COMPLEX *
scratch_of(const struct plan *f)
{
    return f->scratch + (size_t)omp_get_thread_num() * f->space;
}

/* ---- rows ---- */

static void
rows_forward(struct plan *f, const double *p)
{
    const struct rc_layout *l = &f->l;

#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t j = 0; j < l->ny; j++) {
        REAL *row = (REAL *)(row_of(f, scratch_of(f)) + l->cx);
        const double *from = p + j * l->nx;
        bool loaded = false;

        for (size_t i = 0; i < l->nx; i++) {
            row[i] = (REAL)from[i];
            loaded |= from[i] != 0;
        }
        if (loaded) {
            memset(row + l->nx, 0, (l->px - l->nx) * sizeof *row);
            FFTW(execute_dft_r2c)(f->row_forward, row, f->half + j * l->stride);
        } else {
            memset(f->half + j * l->stride, 0, l->cx * sizeof *f->half);
        }
    }
}

static void
rows_back(struct plan *f, double *u)
{
    const struct rc_layout *l = &f->l;

#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t j = 0; j < l->ny; j++) {
        REAL *row = (REAL *)(row_of(f, scratch_of(f)) + l->cx);

        FFTW(execute_dft_c2r)(f->row_back, f->half + j * l->stride, row);
        for (size_t i = 0; i < l->nx; i++)
            u[j * l->nx + i] = (double)row[i];
    }
}

/* ---- columns ---- */

/* The first stage of the transform of n columns from `first`, out of `half`: y_r of column b stands
 * at y + b * column + r * piece. */
static void
gather(const struct plan *f, size_t first, size_t n, COMPLEX *y)
{
    const struct rc_layout *l = &f->l;
    size_t m = l->m, gap = piece(f);
    const COMPLEX *w = f->twiddle;

    if (l->split == 1) {
        for (size_t j = 0; j < m; j++)
            for (size_t b = 0; b < n; b++)
                y[b * f->column + j] = f->half[j * l->stride + first + b];
        return;
    }
    for (size_t j = 0; j < m; j++) {
        COMPLEX w1 = w[j], w2 = w[m + j], w3 = w[2 * m + j];
        for (size_t b = 0; b < n; b++) {
            const COMPLEX *x = f->half + j * l->stride + first + b;
            COMPLEX x0 = j < l->ny ? x[0] : 0;
            COMPLEX x1 = j + m < l->ny ? x[m * l->stride] : 0;
            COMPLEX x2 = l->parts > 2 ? x[2 * m * l->stride] : 0;
            COMPLEX x3 = l->parts > 2 ? x[3 * m * l->stride] : 0;
            COMPLEX even = x0 + x2, odd = x0 - x2, sum = x1 + x3, cross = x1 - x3;
            COMPLEX turned = CMPLX_OF(C99(cimag)(cross), -C99(creal)(cross)); /* -i (x1 - x3) */
            COMPLEX *to = y + b * f->column + j;
            to[0] = even + sum;
            to[gap] = (odd + turned) * w1;
            to[2 * gap] = (even - sum) * w2;
            to[3 * gap] = (odd - turned) * w3;
        }
    }
}

/* The last stage of the transform back, into `half`. */
static void
scatter(struct plan *f, size_t first, size_t n, const COMPLEX *y)
{
    const struct rc_layout *l = &f->l;
    size_t m = l->m, gap = piece(f);
    const COMPLEX *w = f->twiddle;

    if (l->split == 1) {
        for (size_t j = 0; j < m; j++)
            for (size_t b = 0; b < n; b++)
                f->half[j * l->stride + first + b] = y[b * f->column + j];
        return;
    }
    for (size_t j = 0; j < m; j++) {
        COMPLEX w1 = C99(conj)(w[j]), w2 = C99(conj)(w[m + j]), w3 = C99(conj)(w[2 * m + j]);
        for (size_t b = 0; b < n; b++) {
            const COMPLEX *from = y + b * f->column + j;
            COMPLEX y0 = from[0], y1 = from[gap] * w1, y2 = from[2 * gap] * w2;
            COMPLEX y3 = from[3 * gap] * w3;
            COMPLEX even = y0 + y2, odd = y0 - y2, sum = y1 + y3, cross = y1 - y3;
            COMPLEX turned = CMPLX_OF(-C99(cimag)(cross), C99(creal)(cross)); /* i (y1 - y3) */
            COMPLEX *x = f->half + j * l->stride + first + b;
            if (j < l->ny)
                x[0] = even + sum;
            if (j + m < l->ny)
                x[m * l->stride] = odd + turned;
            if (l->parts > 2) {
                x[2 * m * l->stride] = even - sum;
                x[3 * m * l->stride] = odd - turned;
            }
        }
    }
}

/* z[k] *= s[k] for k < n, or s[-k] when step is -1, times a power of -i. */
static void
times(COMPLEX *restrict z, size_t n, const REAL *restrict s, ptrdiff_t step, int turns, REAL sign)
{
    REAL *v = (REAL *)z;

    if (turns == 1) {
        for (size_t k = 0; k < n; k++) {
            REAL a = sign * s[(ptrdiff_t)k * step], re = v[2 * k];
            v[2 * k] = a * v[2 * k + 1];
            v[2 * k + 1] = -a * re;
        }
        return;
    }
    if (turns == 2)
        sign = -sign;
    if (step > 0)
        for (size_t k = 0; k < n; k++) {
            v[2 * k] *= sign * s[k];
            v[2 * k + 1] *= sign * s[k];
        }
    else
        for (size_t k = 0; k < n; k++) {
            v[2 * k] *= sign * *(s - k);
            v[2 * k + 1] *= sign * *(s - k);
        }
}

/* Piece r of a transformed column times the kernel's column s (packed). */
static void
multiply(const struct rc_layout *l, const REAL *s, unsigned parity, size_t r, COMPLEX *z)
{
    REAL mirror = parity & RC_ODD_Y ? -1 : 1;
    int turns = ((parity & RC_ODD_X) != 0) + ((parity & RC_ODD_Y) != 0);
    size_t m = l->m, a = m / 2 + 1, c = (m + 1) / 2;
    const REAL *A = s, *B = s + a, *C = B + m;

    switch (r) {
    case 0: /* A[k], then A[m - k] */
        times(z, a, A, 1, turns, 1);
        if (m > a)
            times(z + a, m - a, A + m - a, -1, turns, mirror);
        break;
    case 1:
        times(z, m, B, 1, turns, 1);
        break;
    case 2: /* C[k], then C[m - 1 - k] */
        times(z, c, C, 1, turns, 1);
        if (m > c)
            times(z + c, m - c, C + m - 1 - c, -1, turns, mirror);
        break;
    default: /* B[m - 1 - k] */
        times(z, m, B + m - 1, -1, turns, mirror);
    }
}

static void
apply(void *at, const void *packed, unsigned parity, const double *p, double *u)
{
    struct plan *f = at;
    const struct rc_layout *l = &f->l;
    const REAL *s = packed;

    rows_forward(f, p);
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t c = 0; c < l->cx; c += LINE) {
        size_t n = l->cx - c < LINE ? l->cx - c : LINE;
        COMPLEX *y = scratch_of(f), *z = y + LINE * f->column;

        gather(f, c, n, y);
        for (size_t b = 0; b < n; b++)
            for (size_t r = 0; r < l->split; r++) {
                COMPLEX *one = y + b * f->column + r * piece(f);
                FFTW(execute_dft)(f->column_forward, one, z);
                multiply(l, s + (c + b) * l->packed, parity, r, z);
                FFTW(execute_dft)(f->column_back, z, one);
            }
        scatter(f, c, n, y);
    }
    rows_back(f, u);
}

static bool
load(void *at, const double *p)
{
    struct plan *f = at;
    const struct rc_layout *l = &f->l;

    if (f->source == NULL && (f->source = FFTW(alloc_complex)(l->cx * l->py)) == NULL)
        return false;
    rows_forward(f, p);
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t c = 0; c < l->cx; c += LINE) {
        size_t n = l->cx - c < LINE ? l->cx - c : LINE;
        COMPLEX *y = scratch_of(f);

        gather(f, c, n, y);
        for (size_t b = 0; b < n; b++)
            for (size_t r = 0; r < l->split; r++)
                FFTW(execute_dft)(f->column_forward, y + b * f->column + r * piece(f),
                                  f->source + (c + b) * l->py + r * l->m);
    }
    return true;
}

static void
field(void *at, const void *packed, unsigned parity, double *u)
{
    struct plan *f = at;
    const struct rc_layout *l = &f->l;
    const REAL *s = packed;

#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t c = 0; c < l->cx; c += LINE) {
        size_t n = l->cx - c < LINE ? l->cx - c : LINE;
        COMPLEX *y = scratch_of(f), *z = y + LINE * f->column;

        for (size_t b = 0; b < n; b++)
            for (size_t r = 0; r < l->split; r++) {
                memcpy(z, f->source + (c + b) * l->py + r * l->m, l->m * sizeof *z);
                multiply(l, s + (c + b) * l->packed, parity, r, z);
                FFTW(execute_dft)(f->column_back, z, y + b * f->column + r * piece(f));
            }
        scatter(f, c, n, y);
    }
    rows_back(f, u);
}

static void
store(void *packed, size_t at, double value)
{
    ((REAL *)packed)[at] = (REAL)value;
}

const struct rc_fft_ops OPS = {
    .real_size = sizeof(REAL),
    .new = plan_new,
    .free = plan_free,
    .store = store,
    .apply = apply,
    .load = load,
    .field = field,
};
