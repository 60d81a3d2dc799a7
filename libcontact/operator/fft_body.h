/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Rows, columns and multiplication of the transform engine, in one precision. The file that includes this
 * sets REAL, COMPLEX, FFTW(name) and C99(name).
 *
 * The padded array is never formed. Each row is transformed separately (real, nx of px values not zero) into
 * `waves`, ny rows of px/2 + 1 complex numbers. Then columns are taken together, as many as fill a cache
 * line. They are gathered, transformed to length py, multiplied and transformed back, and the needed ny
 * values are scattered. Then the rows are transformed back. Every pass reads and writes each number once.
 *
 * Plans are one-dimensional, out of place and estimated (FFTW_ESTIMATE). For the lengths after splitting
 * they are as fast as measured plans within a tenth. They take no time to make, and are the same in every
 * run.
 */
#include <complex.h> /* before fftw3.h: its complex numbers are then C's own */
#include <fftw3.h>
#include <math.h>
#include <omp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "fft.h"
#include "libcontact/transform/transform.h"
#include "libcontact/memory.h"

enum {
    /* columns processed together: two cache lines, fetched as a pair */
    LINE = 128 / sizeof(COMPLEX),
    PREFETCH = 8, /* rows fetched in advance */
    /* complex numbers between pieces, so that equal places of different pieces do not share lines of the
     * cache */
    GAP = 8,
};

struct map {
    const double *p;
    double *u;
    size_t nx;
};

struct plan {
    struct rc_layout l;
    FFTW(plan) row_forward, row_back, column_forward, column_back;
    COMPLEX *waves;              /* the columns held here, of each row: ny rows of `wide` */
    COMPLEX *pieces;             /* parts of the rows held here, for other ranks; NULL: no ranks */
    COMPLEX *second;             /* as `waves`, of the second of two fields; NULL: not yet needed */
    COMPLEX *source[RC_SOURCES]; /* transformed columns of a loaded map, in pieces; or NULL */
    COMPLEX *twiddle;    /* w^n, w^2n, w^3n for each n < m (radix 4)                           */
    COMPLEX *scratch;    /* memory for each thread: LINE columns, one more, a row, and a spectrum's
                       * column */
    size_t column;       /* complex numbers of one column in scratch: radix pieces and gaps    */
    size_t scratch_size; /* complex numbers of scratch of one thread                           */
    struct rc_store own; /* memory of all these arrays, except of lent `waves` */
};

/* FFTW uses vector instructions only on aligned data: every array begins a cache line. */
static size_t
whole_lines(size_t n)
{
    return (n + LINE - 1) / LINE * LINE;
}

static COMPLEX *
allocate(struct plan *f, size_t n)
{
    return rc_store_take(&f->own, whole_lines(n), sizeof(COMPLEX));
}

static size_t
piece(const struct plan *f)
{
    return whole_lines(f->l.m) + GAP;
}

static COMPLEX *
source_of(const struct plan *f, size_t source, size_t column, size_t r)
{
    return f->source[source] + column * f->column + r * piece(f);
}

static void
plan_free(void *at)
{
    struct plan *f = at;

    if (f == NULL)
        return;
    rc_planner_lock();
    FFTW(destroy_plan)(f->row_forward);
    FFTW(destroy_plan)(f->row_back);
    FFTW(destroy_plan)(f->column_forward);
    FFTW(destroy_plan)(f->column_back);
    rc_planner_unlock();
    rc_store_free(&f->own);
    free(f);
}

/* A thread's row of px reals in its scratch; before it lies the memory of its transform. */
static REAL *
row_of(const struct plan *f, COMPLEX *scratch)
{
    return (REAL *)(scratch + (LINE + 1) * f->column + f->l.stride);
}

static bool
make_plans(struct plan *f)
{
    const unsigned how = FFTW_ESTIMATE;
    COMPLEX *a = f->scratch, *b = a + f->column;
    REAL *row = row_of(f, a);
    COMPLEX *waves = (COMPLEX *)row - f->l.stride;
    int px = (int)f->l.px, m = (int)f->l.m;

    rc_planner_lock();
    f->row_forward = FFTW(plan_dft_r2c_1d)(px, row, waves, how);
    f->row_back = FFTW(plan_dft_c2r_1d)(px, waves, row, how);
    f->column_forward = FFTW(plan_dft_1d)(m, a, b, FFTW_FORWARD, how);
    f->column_back = FFTW(plan_dft_1d)(m, a, b, FFTW_BACKWARD, how);
    rc_planner_unlock();
    return f->row_forward != NULL && f->row_back != NULL && f->column_forward != NULL &&
           f->column_back != NULL;
}

static void
make_twiddles(struct plan *f)
{
    const double step = -2 * 3.14159265358979323846 / (double)f->l.py;
    size_t m = f->l.m;

    for (size_t n = 0; n < m; n++)
        for (size_t r = 1; r < 4; r++) {
            double angle = step * (double)(r * n);
            f->twiddle[3 * n + r - 1] = (COMPLEX)(cos(angle) + I * sin(angle));
        }
}

static void *
plan_new(const struct rc_layout *l, void *lent)
{
    struct plan *f = calloc(1, sizeof *f);

    if (f == NULL)
        return NULL;
    f->l = *l;
    f->column = l->radix * piece(f);
    f->scratch_size = (LINE + 1) * f->column + l->stride + whole_lines(l->px / 2 + 1) +
                      whole_lines(l->cy / 2 + 1);
    f->waves = lent != NULL ? lent : allocate(f, rc_layout_rows(l));
    f->scratch = allocate(f, (size_t)l->threads * f->scratch_size);
    f->twiddle = allocate(f, 3 * l->m);
    if (f->own.failed || !make_plans(f)) {
        plan_free(f);
        return NULL;
    }
    if (l->turn != NULL)
        f->pieces = f->waves + l->ny * l->wide;
    if (l->radix == 4)
        make_twiddles(f);
    return f;
}

static void *
workspace(void *at, size_t bytes)
{
    struct plan *f = at;

    return bytes <= rc_layout_rows(&f->l) * sizeof *f->waves ? f->waves : NULL;
}

static COMPLEX *
scratch_of(const struct plan *f)
{
    return f->scratch + (size_t)omp_get_thread_num() * f->scratch_size;
}

/* ---- rows ---- */

RC_CLONES static void
to_real(const double *restrict from, size_t n, REAL *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] = (REAL)from[i];
}

RC_CLONES static void
to_double(const REAL *restrict from, size_t n, double *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] = (double)from[i];
}

/* Row j of the source, from a map of doubles. */
static bool
row_in(void *map, size_t j, void *row)
{
    const struct map *m = map;
    const double *from = m->p + j * m->nx;

    if (!rc_any(from, m->nx))
        return false;
    to_real(from, m->nx, row);
    return true;
}

static bool
row_out(void *map, size_t j, void *row)
{
    const struct map *m = map;

    to_double(row, m->nx, m->u + j * m->nx);
    return true;
}

/* Rows are written by one function and read by the next; the first or the last may be missing. Between two
 * kernels a row passes without a map. Columns from `columns` on count as zero after the transform, whatever
 * they contain. */
static void
transform_some(struct plan *f, size_t columns, void *ctx, rc_row *make, bool back, bool forward)
{
    const struct rc_layout *l = &f->l;
    const volatile sig_atomic_t *hurry = rc_fft_hurry;

#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t j = 0; j < l->rows; j++) {
        REAL *row = row_of(f, scratch_of(f));
        COMPLEX *waves = l->turn == NULL ? f->waves + j * l->wide : (COMPLEX *)row - l->stride;
        bool any;

        if (hurry != NULL && *hurry != 0)
            continue;
        if (back && l->turn != NULL)
            rc_turn_get(l->turn, j, f->pieces, waves);
        if (back && columns < l->cx)
            memset(waves + columns, 0, (l->cx - columns) * sizeof *waves);
        if (back)
            FFTW(execute_dft_c2r)(f->row_back, waves, row);
        any = make(ctx, j, row);
        if (!forward)
            continue;
        /* the columns that fill up a line are gathered too */
        memset(waves + (any ? l->cx : 0), 0, (l->stride - (any ? l->cx : 0)) * sizeof *waves);
        if (any) {
            memset(row + l->nx, 0, (l->px - l->nx) * sizeof *row);
            FFTW(execute_dft_r2c)(f->row_forward, row, waves);
        }
        if (l->turn != NULL)
            rc_turn_put(l->turn, j, waves, f->pieces);
    }
}

/* Moves data from rows to columns, and back. */
static void
turn(struct plan *f, bool back)
{
    if (f->l.turn == NULL)
        return;
    if (back)
        rc_ranks_turn(f->l.turn, true, f->waves, f->pieces);
    else
        rc_ranks_turn(f->l.turn, false, f->pieces, f->waves);
}

static void
transform_rows(struct plan *f, void *ctx, rc_row *make, bool back, bool forward)
{
    transform_some(f, f->l.cx, ctx, make, back, forward);
}

/* ---- columns ---- */

/* Rows are pages apart, and hardware prefetchers do not cross pages. */
static inline void
prefetch(const COMPLEX *x)
{
    __builtin_prefetch(x);
    __builtin_prefetch(x + LINE / 2);
}

/* One butterfly: y_r = w^r sum_s (-i)^(r s) x_s for a whole line of columns. The `have` values x_s are `step`
 * apart, and y_r of column b is at y + b * column + r * gap. */
static inline void
butterfly(const struct plan *f, const COMPLEX *x, size_t step, int have, const COMPLEX w[3],
          COMPLEX *restrict y)
{
    size_t gap = piece(f);

    for (size_t b = 0; b < LINE; b++, y += f->column) {
        COMPLEX x0 = x[b], x1 = have > 1 ? x[step + b] : 0;
        COMPLEX x2 = have > 2 ? x[2 * step + b] : 0, x3 = have > 3 ? x[3 * step + b] : 0;
        COMPLEX even = x0 + x2, odd = x0 - x2, sum = x1 + x3, cross = x1 - x3;
        COMPLEX rotated = CMPLX_OF(C99(cimag)(cross), -C99(creal)(cross)); /* -i (x1 - x3) */
        y[0] = even + sum;
        y[gap] = (odd + rotated) * w[0];
        y[2 * gap] = (even - sum) * w[1];
        y[3 * gap] = (odd - rotated) * w[2];
    }
}

/* The inverse butterfly; `want` of its values are written. */
static inline void
butterfly_back(const struct plan *f, COMPLEX *x, size_t step, int want, const COMPLEX w[3],
               const COMPLEX *restrict y)
{
    size_t gap = piece(f);
    COMPLEX w1 = C99(conj)(w[0]), w2 = C99(conj)(w[1]), w3 = C99(conj)(w[2]);

    for (size_t b = 0; b < LINE; b++, y += f->column) {
        COMPLEX y0 = y[0], y1 = y[gap] * w1, y2 = y[2 * gap] * w2, y3 = y[3 * gap] * w3;
        COMPLEX even = y0 + y2, odd = y0 - y2, sum = y1 + y3, cross = y1 - y3;
        COMPLEX rotated = CMPLX_OF(-C99(cimag)(cross), C99(creal)(cross)); /* i (y1 - y3) */
        x[b] = even + sum;
        if (want > 1)
            x[step + b] = odd + rotated;
        if (want > 2)
            x[2 * step + b] = even - sum;
        if (want > 3)
            x[3 * step + b] = odd - rotated;
    }
}

/* The number of nodes j, j + m, ... on the map is the same for the places from j to *end of a piece; returns
 * it. */
static int
nodes_of(const struct rc_layout *l, size_t j, size_t *end)
{
    size_t whole = l->ny / l->m, more = l->ny % l->m;

    *end = j < more ? more : l->m;
    return (int)(j < more ? whole + 1 : whole);
}

/* Places j < end of a line of columns x, each of `have` nodes; `have` is a constant at every call. */
static inline void
gather_run(const struct plan *f, const COMPLEX *x, size_t j, size_t end, int have, COMPLEX *y)
{
    size_t wide = f->l.wide, step = f->l.m * wide;

    for (; j < end; j++) {
        for (int q = 0; q < have; q++)
            prefetch(x + (j + PREFETCH) * wide + (size_t)q * step);
        butterfly(f, x + j * wide, step, have, f->twiddle + 3 * j, y + j);
    }
}

static inline void
scatter_run(const struct plan *f, COMPLEX *x, size_t j, size_t end, int want, const COMPLEX *y)
{
    size_t wide = f->l.wide, step = f->l.m * wide;

    for (; j < end; j++) {
        for (int q = 0; q < want; q++)
            prefetch(x + (j + PREFETCH) * wide + (size_t)q * step);
        butterfly_back(f, x + j * wide, step, want, f->twiddle + 3 * j, y + j);
    }
}

/* The first stage of the transform of a line of columns from `first`, out of `waves`. */
RC_CLONES static void
gather(const struct plan *f, size_t first, COMPLEX *y)
{
    const struct rc_layout *l = &f->l;
    const COMPLEX *x = f->waves + first;

    for (size_t j = 0, end; j < l->m; j = end) {
        int have = nodes_of(l, j, &end);
        if (l->radix == 1)
            for (; j < end; j++)
                for (size_t b = 0; b < LINE; b++)
                    y[b * f->column + j] = x[j * l->wide + b];
        else if (have == 4)
            gather_run(f, x, j, end, 4, y);
        else if (have == 3)
            gather_run(f, x, j, end, 3, y);
        else if (have == 2)
            gather_run(f, x, j, end, 2, y);
        else if (have == 1)
            gather_run(f, x, j, end, 1, y);
        else
            for (; j < end; j++)
                for (size_t b = 0; b < LINE; b++)
                    for (size_t r = 0; r < 4; r++)
                        y[b * f->column + r * piece(f) + j] = 0;
    }
}

/* The last stage of the transform back, into `waves`. */
RC_CLONES static void
scatter(const struct plan *f, COMPLEX *waves, size_t first, const COMPLEX *y)
{
    const struct rc_layout *l = &f->l;
    COMPLEX *x = waves + first;

    for (size_t j = 0, end; j < l->m; j = end) {
        int want = nodes_of(l, j, &end);
        if (l->radix == 1)
            for (; j < end; j++)
                for (size_t b = 0; b < LINE; b++)
                    x[j * l->wide + b] = y[b * f->column + j];
        else if (want == 4)
            scatter_run(f, x, j, end, 4, y);
        else if (want == 3)
            scatter_run(f, x, j, end, 3, y);
        else if (want == 2)
            scatter_run(f, x, j, end, 2, y);
        else if (want == 1)
            scatter_run(f, x, j, end, 1, y);
    }
}

/* The target of a product: written, or increased by a weight times the product. */
struct target {
    COMPLEX *z;
    bool more;
    REAL weight;
};

static inline REAL
put(bool more, REAL weight, REAL there, REAL v)
{
    return more ? there + weight * v : v;
}

/* Computes z[k] s[k] for k < n, or z[k] s[-k] when step is -1, times the sign and a power of -i. `to` may be
 * z. */
static inline void
products(COMPLEX *to, bool more, REAL weight, const COMPLEX *z, size_t n, const REAL *s,
         ptrdiff_t step, int power, REAL sign)
{
    const REAL *v = (const REAL *)z;
    REAL *w = (REAL *)to;

    if (power == 2)
        sign = -sign;
    if (power == 1) {
#pragma omp simd
        for (size_t k = 0; k < n; k++) {
            REAL a = sign * s[(ptrdiff_t)k * step], re = v[2 * k], im = v[2 * k + 1];
            w[2 * k] = put(more, weight, w[2 * k], a * im);
            w[2 * k + 1] = put(more, weight, w[2 * k + 1], -a * re);
        }
    } else {
#pragma omp simd
        for (size_t k = 0; k < n; k++) {
            REAL a = sign * s[(ptrdiff_t)k * step], re = v[2 * k], im = v[2 * k + 1];
            w[2 * k] = put(more, weight, w[2 * k], a * re);
            w[2 * k + 1] = put(more, weight, w[2 * k + 1], a * im);
        }
    }
}

RC_WIDE_CLONES static void
scale(const struct target *to, size_t first, const COMPLEX *z, size_t n, const REAL *s,
      ptrdiff_t step, int power, REAL sign)
{
    if (to->more && step > 0)
        products(to->z + first, true, to->weight, z + first, n, s, 1, power, sign);
    else if (to->more)
        products(to->z + first, true, to->weight, z + first, n, s, -1, power, sign);
    else if (step > 0)
        products(to->z + first, false, 0, z + first, n, s, 1, power, sign);
    else
        products(to->z + first, false, 0, z + first, n, s, -1, power, sign);
}

/* Piece r of a transformed column, z, times column s of the kernel's spectrum. */
static void
multiply(const struct rc_layout *l, const REAL *s, unsigned parity, size_t r, const COMPLEX *z,
         const struct target *to)
{
    REAL mirror = parity & RC_ODD_Y ? -1 : 1;
    int power = ((parity & RC_ODD_X) != 0) + ((parity & RC_ODD_Y) != 0);
    size_t m = l->m, a = m / 2 + 1, c = (m + 1) / 2;
    const REAL *A = s, *B = s + a, *C = B + m;

    switch (r) {
    case 0: /* A[k], then A[m - k] */
        scale(to, 0, z, a, A, 1, power, 1);
        if (m > a)
            scale(to, a, z, m - a, A + m - a, -1, power, mirror);
        break;
    case 1:
        scale(to, 0, z, m, B, 1, power, 1);
        break;
    case 2: /* C[k], then C[m - 1 - k] */
        scale(to, 0, z, c, C, 1, power, 1);
        if (m > c)
            scale(to, c, z, m - c, C + m - 1 - c, -1, power, mirror);
        break;
    default: /* B[m - 1 - k] */
        scale(to, 0, z, m, B + m - 1, -1, power, mirror);
    }
}

/* The ratio of n numbers. The inverse of a wave without stiffness is 0, also with a diagonal term, which
 * may be small: the load determines the mean. */
RC_CLONES static void
divide(size_t n, const REAL *restrict s, const struct rc_ratio *of, REAL *restrict to)
{
    const REAL a = (REAL)of->a, b = (REAL)of->b, c = (REAL)of->c, d = (REAL)of->d;

    for (size_t k = 0; k < n; k++)
        to[k] = c + d * s[k] == 0 || (b == 0 && s[k] == 0) ? 0 : (a + b * s[k]) / (c + d * s[k]);
}

/* Columns: transformed, multiplied, transformed back. */
static void
convolve_columns(struct plan *f, const struct rc_factor *factor)
{
    const struct rc_layout *l = &f->l;
    const volatile sig_atomic_t *hurry = rc_fft_hurry;

#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t c = 0; c < l->columns; c += LINE) {
        size_t n = l->columns - c < LINE ? l->columns - c : LINE;
        COMPLEX *y = scratch_of(f), *z = y + LINE * f->column;
        REAL *ratio = (REAL *)(row_of(f, y)) + 2 * whole_lines(l->px / 2 + 1);

        if (hurry != NULL && *hurry != 0)
            continue;
        gather(f, c, y);
        for (size_t b = 0; b < n; b++) {
            const REAL *s = (const REAL *)factor->spectrum + (c + b) * l->cy;
            const struct rc_ratio *of = l->first + c + b == 0 ? &factor->first : &factor->ratio;
            if (of->a != 0 || of->d != 0) {
                divide(l->cy, s, of, ratio);
                s = ratio;
            }
            for (size_t r = 0; r < l->radix; r++) {
                COMPLEX *one = y + b * f->column + r * piece(f);
                FFTW(execute_dft)(f->column_forward, one, z);
                multiply(l, s, factor->parity, r, z, &(struct target){.z = z});
                FFTW(execute_dft)(f->column_back, z, one);
            }
        }
        scatter(f, f->waves, c, y);
    }
}

static void
apply(void *at, const struct rc_factor *factor, const double *p, double *u)
{
    struct plan *f = at;
    struct map map = {.p = p, .u = u, .nx = f->l.nx};

    transform_rows(f, &map, row_in, false, true);
    turn(f, false);
    convolve_columns(f, factor);
    turn(f, true);
    transform_rows(f, &map, row_out, true, false);
}

static void
chain(void *at, size_t n, const struct rc_link *links, rc_row *last, void *ctx)
{
    struct plan *f = at;

    for (size_t k = 0; k < n; k++) {
        transform_rows(f, ctx, links[k].row, k > 0, true);
        turn(f, false);
        convolve_columns(f, &links[k].factor);
        turn(f, true);
    }
    transform_rows(f, ctx, last, true, false);
}

static bool
load(void *at, size_t source, const double *p)
{
    struct plan *f = at;
    const struct rc_layout *l = &f->l;
    struct map map = {.p = p, .nx = l->nx};

    if (f->source[source] == NULL)
        f->source[source] = allocate(f, l->columns * f->column);
    if (rc_ranks_sum(l->turn == NULL ? NULL : l->turn->ranks, f->source[source] == NULL) > 0)
        return false;
    transform_rows(f, &map, row_in, false, true);
    turn(f, false);
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t c = 0; c < l->columns; c += LINE) {
        size_t n = l->columns - c < LINE ? l->columns - c : LINE;
        COMPLEX *y = scratch_of(f);

        gather(f, c, y);
        for (size_t b = 0; b < n; b++)
            for (size_t r = 0; r < l->radix; r++)
                FFTW(execute_dft)
        (f->column_forward, y + b * f->column + r * piece(f), source_of(f, source, c + b, r));
    }
    return true;
}

/* One field: products of a line of n columns from `first`, transformed back into `waves`. */
static void
field_line(struct plan *f, size_t first, size_t n, const REAL *spectra,
           const struct rc_fft_kernel *kernel, const struct rc_fft_sum *sum, COMPLEX *waves)
{
    const struct rc_layout *l = &f->l;
    COMPLEX *y = scratch_of(f), *z = y + LINE * f->column;

    for (size_t b = 0; b < n; b++)
        for (size_t r = 0; r < l->radix; r++) {
            for (size_t k = 0; k < sum->n; k++) {
                const struct rc_fft_term *t = &sum->term[k];
                const struct target to = {z, k > 0, (REAL)t->weight};
                multiply(l, spectra + (t->kernel * LINE + b) * l->cy, kernel[t->kernel].parity, r,
                         source_of(f, t->source, first + b, r), &to);
            }
            FFTW(execute_dft)(f->column_back, z, y + b * f->column + r * piece(f));
        }
    scatter(f, waves, first, y);
}

static bool
fields(void *at, size_t columns, rc_line_spectra *spectra, void *ctx,
       const struct rc_fft_kernel *kernel, size_t n_fields, const struct rc_fft_sum *sum)
{
    struct plan *f = at;
    const struct rc_layout *l = &f->l;
    COMPLEX *waves[RC_FIELDS] = {f->waves, f->second};
    size_t here; /* columns that are not zero */

    if (n_fields > 1 && waves[1] == NULL)
        waves[1] = f->second = allocate(f, l->ny * l->wide);
    if (rc_ranks_sum(l->turn == NULL ? NULL : l->turn->ranks, n_fields > 1 && waves[1] == NULL) > 0)
        return false;
    /* whole lines of columns are scattered */
    columns = whole_lines(columns) < l->cx ? whole_lines(columns) : l->cx;
    here = columns < l->first                ? 0
           : columns - l->first < l->columns ? columns - l->first
                                             : l->columns;
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t c = 0; c < here; c += LINE) {
        size_t n = here - c < LINE ? here - c : LINE;
        const REAL *s = spectra(ctx, c, n);

        for (size_t k = 0; k < n_fields; k++)
            field_line(f, c, n, s, kernel, &sum[k], waves[k]);
    }
    for (size_t k = 0; k < n_fields; k++) {
        struct map map = {.u = sum[k].u, .nx = l->nx};

        f->waves = waves[k];
        turn(f, true);
        transform_some(f, columns, &map, row_out, true, false);
    }
    f->waves = waves[0];
    return true;
}

/* Splits n complex numbers, times `factor`, into real and imaginary parts, and joins them. */
RC_CLONES static void
part(const COMPLEX *restrict z, size_t n, REAL factor, REAL *restrict re, REAL *restrict im)
{
    const REAL *v = (const REAL *)z;

    for (size_t k = 0; k < n; k++) {
        re[k] = factor * v[2 * k];
        im[k] = factor * v[2 * k + 1];
    }
}

RC_CLONES static void
join(const REAL *restrict re, const REAL *restrict im, size_t n, COMPLEX *restrict z)
{
    REAL *v = (REAL *)z;

    for (size_t k = 0; k < n; k++) {
        v[2 * k] = re[k];
        v[2 * k + 1] = im[k];
    }
}

static void
forward(void *at, rc_row *row, void *ctx, void *waves, rc_wave_column *column)
{
    struct plan *f = at;
    const struct rc_layout *l = &f->l;
    const REAL factor = (REAL)(1 / ((double)l->px * (double)l->py));

    transform_rows(f, ctx, row, false, true);
    turn(f, false);
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t c = 0; c < l->columns; c += LINE) {
        size_t n = l->columns - c < LINE ? l->columns - c : LINE;
        COMPLEX *y = scratch_of(f), *z = y + LINE * f->column;

        gather(f, c, y);
        for (size_t b = 0; b < n; b++) {
            COMPLEX *one = y + b * f->column;
            REAL *to = (REAL *)one;
            for (size_t r = 0; r < l->radix; r++)
                FFTW(execute_dft)(f->column_forward, one + r * piece(f), z + r * piece(f));
            for (size_t r = 0; r < l->radix; r++)
                part(z + r * piece(f), l->m, factor, to + r * l->m, to + l->py + r * l->m);
            if (waves == NULL)
                column(ctx, c + b, to);
            else
                rc_copy_past((REAL *)waves + 2 * (c + b) * l->py, to, 2 * l->py * sizeof *to);
        }
    }
}

static void
back(void *at, const void *waves, rc_wave_column *column, rc_row *row, void *ctx)
{
    struct plan *f = at;
    const struct rc_layout *l = &f->l;

#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t c = 0; c < l->columns; c += LINE) {
        size_t n = l->columns - c < LINE ? l->columns - c : LINE;
        COMPLEX *y = scratch_of(f), *z = y + LINE * f->column;

        for (size_t b = 0; b < n; b++) {
            COMPLEX *one = y + b * f->column;
            const REAL *from = (const REAL *)one;
            if (waves == NULL)
                column(ctx, c + b, one);
            else
                from = (const REAL *)waves + 2 * (c + b) * l->py;
            for (size_t r = 0; r < l->radix; r++)
                join(from + r * l->m, from + l->py + r * l->m, l->m, z + r * piece(f));
            for (size_t r = 0; r < l->radix; r++)
                FFTW(execute_dft)(f->column_back, z + r * piece(f), one + r * piece(f));
        }
        scatter(f, f->waves, c, y);
    }
    turn(f, true);
    transform_rows(f, ctx, row, true, false);
}

static void
store(const struct rc_layout *l, size_t c, double factor, double mirror, const double *s,
      void *spectrum)
{
    REAL *to = (REAL *)spectrum + c * l->cy;
    size_t m = l->m, py = l->py;

    for (size_t k = 0; k <= m / 2; k++)
        *to++ = (REAL)(factor * s[l->radix * k]);
    if (l->radix == 1)
        return;
    for (size_t k = 0; k < m; k++) {
        size_t q = 4 * k + 1;
        *to++ = (REAL)(factor * (2 * q <= py ? s[q] : mirror * s[py - q]));
    }
    for (size_t k = 0; k < (m + 1) / 2; k++)
        *to++ = (REAL)(factor * s[4 * k + 2]);
}

const struct rc_fft_ops OPS = {
    .real_size = sizeof(REAL),
    .line = LINE,
    .new = plan_new,
    .free = plan_free,
    .workspace = workspace,
    .store = store,
    .apply = apply,
    .chain = chain,
    .load = load,
    .fields = fields,
    .forward = forward,
    .back = back,
};
