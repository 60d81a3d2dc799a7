/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Layout of the transforms and spectra of kernels. A kernel that is even or odd in x and in y has a spectrum
 * that is real up to a power of -i. A quarter of its values determines it.
 *
 * Free axis: zero padding to px >= 2 nx or py >= 2 ny is exact; a profile needs no padding across it. The
 * spectrum is the real even or odd transform of half of the kernel's values along the axis. At the offset of
 * half a period the kernel has its own value. With 0 there the spectrum of narrow grids gets negative and has
 * no useful inverse. Axis that repeats: no padding; the values along the other axis are those of a wave.
 * Where both repeat, the spectrum is the kernel's symbol.
 */
#include "fft.h"

#include <assert.h>
#include <complex.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/body/line.h"
#include "libcontact/memory.h"
#include "libcontact/transform/transform.h"

/* Transforms of half a period of even or odd values. For a period of odd length, which has no middle node:
 * even values only, by a transform of the full period. Odd values on a period of one node are zero. */
struct half {
    struct rc_dct *dct;   /* transform of even length */
    struct rc_line *line; /* transform of odd length */
    size_t length, n;     /* length of the period; of half of it */
    double *scratch;      /* memory for each thread: the period and its transform */
};

struct rc_fft {
    struct rc_shape shape;
    struct rc_boundary boundary;
    struct rc_layout layout;
    const struct rc_fft_ops *ops;
    void *plan;
    struct half along_x, along_y; /* sides of a quarter of a kernel */
    double *columns;              /* COLUMNS columns of a spectrum for each thread */
    /* transpositions of waves and of the rows of a quarter, where ranks share it */
    struct rc_turn turn, quarter;
    struct rc_store own;
};

enum {
    /* columns of a quarter transformed together: two cache lines, fetched as a pair */
    COLUMNS = 16,
    PREFETCH = 8,    /* rows fetched in advance, because they are pages apart */
    ROWS = 8,        /* rows of a kernel that are evaluated together */
    LINE_BYTES = 128 /* columns of waves that are transformed together */
};

struct rc_spectrum {
    unsigned parity;
    double total; /* value at wave number 0 */
    void *values; /* the columns held here, of cy numbers in the order of fft.h, over px py */
    bool lent;    /* these numbers belong to another spectrum */
    struct rc_ratio ratio, first; /* factors of these numbers in a chain; of the first column */
};

static const struct rc_ratio numbers_themselves = {0, 1, 1, 0};

/* ---- layout ---- */

static size_t
line_of(enum rc_precision precision)
{
    return precision == RC_SINGLE ? rc_fft_single.line : rc_fft_double.line;
}

static size_t
real_size(enum rc_precision precision)
{
    return precision == RC_SINGLE ? sizeof(float) : sizeof(double);
}

void
rc_fft_period(const struct rc_shape *s, struct rc_boundary boundary, size_t *px, size_t *py)
{
    *px = !boundary.x && s->nx > 1 ? rc_fourier_length(s->nx, 2) : s->nx;
    *py = !boundary.y && s->ny > 1 ? rc_fourier_length(s->ny, 4) : s->ny;
}

static struct rc_layout
layout_of(const struct rc_shape *s, struct rc_boundary boundary, enum rc_precision precision)
{
    const size_t line = line_of(precision);
    struct rc_layout l = {.nx = s->nx, .ny = s->ny};

    rc_fft_period(s, boundary, &l.px, &l.py);
    l.cx = l.px / 2 + 1;
    l.stride = (l.cx + line - 1) / line * line;
    l.radix = l.py % 4 == 0 && l.py >= 64 ? 4 : 1;
    if (!boundary.y && l.py > 1)
        l.radix = 4;
    l.m = l.py / l.radix;
    l.cy = l.py / 2 + 1;
    l.rows = l.ny;
    l.columns = l.cx;
    l.wide = l.stride;
    return l;
}

/* The part that rank `own` of `count` holds: rows as maps are shared, and lines of columns. */
static void
share_layout(struct rc_layout *l, enum rc_precision precision, size_t count, size_t own,
             const struct rc_turn *turn)
{
    size_t line = line_of(precision), lines = l->stride / line;
    size_t first = rc_rows_dealt(lines, 1, count, own),
           last = rc_rows_dealt(lines, 1, count, own + 1);

    l->first = first * line < l->cx ? first * line : l->cx;
    l->wide = (last - first) * line;
    l->columns = last * line < l->cx ? l->wide : l->cx - l->first;
    l->turn = turn;
}

/* ---- half a period ---- */

static void
half_free(struct half *h)
{
    rc_dct_free(h->dct);
    rc_line_free(h->line);
}

static bool
half_new(struct half *h, struct rc_store *own, size_t length, size_t threads)
{
    *h = (struct half){.length = length, .n = length / 2 + 1};
    if (length % 2 == 0)
        return (h->dct = rc_dct_new(h->n, threads, NULL)) != NULL;
    h->line = rc_line_new(length, threads, NULL);
    h->scratch = rc_store_take(own, threads * (length + 1 + 2 * h->n), sizeof *h->scratch);
    return h->line != NULL && h->scratch != NULL;
}

static void
half_run_odd_length(const struct half *h, bool odd, double *v)
{
    double *all;
    double complex *waves;

    if (odd && h->length == 1) {
        v[0] = 0;
        return;
    }
    assert(!odd);
    all = h->scratch + (size_t)omp_get_thread_num() * (h->length + 1 + 2 * h->n);
    waves = (double complex *)(void *)(all + h->length + 1); /* the length is odd */
    memcpy(all, v, h->n * sizeof *all);
    for (size_t k = h->n; k < h->length; k++)
        all[k] = v[h->length - k];
    rc_line_forward(h->line, all, waves);
    for (size_t k = 0; k < h->n; k++)
        v[k] = creal(waves[k]);
}

/* Arguments of rc_dct_run. */
static void
half_run(const struct half *h, size_t count, unsigned odd, double *const *v)
{
    if (h->dct != NULL)
        rc_dct_run(h->dct, count, odd, v);
    for (size_t k = 0; h->dct == NULL && k < count; k++)
        if (v[k] != NULL)
            half_run_odd_length(h, odd >> k & 1, v[k]);
}

/* ---- plan ---- */

/* Sets the rows and columns of each rank. */
static enum rc_status
share(struct rc_fft *f, const struct rc_ranks *ranks, size_t row_unit, enum rc_precision precision,
      struct rc_err *err)
{
    struct rc_layout *l = &f->layout;
    size_t count = rc_ranks_count(ranks), own = rc_ranks_own(ranks);
    size_t line = line_of(precision), lines = l->stride / line;

    if (count == 1)
        return RC_OK;
    if (rc_turn_new(&f->turn, ranks, f->shape.ny, row_unit, (l->ny - f->shape.ny) / 2, lines,
                    LINE_BYTES, err) != RC_OK ||
        rc_turn_new(&f->quarter, ranks, l->cy, ROWS, 0, lines, line * sizeof(double), err) != RC_OK)
        return RC_FAIL;
    share_layout(l, precision, count, own, &f->turn);
    l->rows = f->turn.row[own + 1] - f->turn.row[own];
    return RC_OK;
}

enum rc_status
rc_boundary_check(struct rc_boundary boundary, struct rc_err *err)
{
    if (rc_repeats(boundary) == 1 && !(boundary.datum >= 0 && boundary.datum < INFINITY))
        return rc_err_set(err, "datum %g m: it must be positive and finite", boundary.datum);
    return RC_OK;
}

/* With a frame the plan makes no spectra itself. */
static struct rc_fft *
fft_new(const struct rc_ranks *ranks, struct rc_fft *lender, const struct rc_shape *s, size_t level,
        struct rc_boundary boundary, const struct rc_frame *frame, enum rc_precision precision,
        size_t threads, struct rc_err *err)
{
    RC_OWN(rc_fft, f) = calloc(1, sizeof *f);
    const size_t unit = rc_rows_unit(s->nx << level) >> level, count = rc_ranks_count(ranks),
                 at = rc_ranks_own(ranks);
    struct rc_shape own = {
        s->nx, rc_rows_dealt(s->ny, unit, count, at + 1) - rc_rows_dealt(s->ny, unit, count, at),
        s->dx, s->dy};
    void *lent = NULL;
    struct rc_layout *l;
    size_t team;

    if (f == NULL)
        return rc_err_null(err, "out of memory for a plan");
    f->shape = *s;
    f->boundary = boundary;
    l = &f->layout;
    *l = layout_of(s, boundary, precision);
    if (frame != NULL) {
        l->nx += 2 * frame->x;
        l->rows = l->ny += 2 * frame->y;
    }
    l->threads = rc_useful_threads(&own, threads); /* ranks of all processes that share these
                                                      rows */
    team = (size_t)l->threads;
    f->ops = precision == RC_SINGLE ? &rc_fft_single : &rc_fft_double;
    if (share(f, ranks, unit, precision, err) != RC_OK)
        return NULL;
    if (lender != NULL)
        lent = lender->ops->workspace(lender->plan, rc_layout_rows(l) * 2 * real_size(precision));
    f->plan = f->ops->new (l, lent);
    if (frame == NULL)
        f->columns = rc_store_take(&f->own, team * COLUMNS * l->cy, sizeof *f->columns);
    if (f->plan == NULL ||
        (frame == NULL && (f->columns == NULL || !half_new(&f->along_x, &f->own, l->px, team) ||
                           !half_new(&f->along_y, &f->own, l->py, team))))
        return rc_err_null(err, "out of memory for transforms of %zu x %zu nodes", s->nx, s->ny);
    return rc_give(&f);
}

/* RC_FAIL on one rank becomes a failure on all. */
static struct rc_fft *
agree(const struct rc_ranks *ranks, struct rc_fft *f, struct rc_err *err)
{
    if (rc_ranks_agree(ranks, f == NULL ? RC_FAIL : RC_OK, err) == RC_OK)
        return f;
    rc_fft_free(f);
    return NULL;
}

struct rc_fft *
rc_fft_new(const struct rc_ranks *ranks, struct rc_fft *lender, const struct rc_shape *s,
           struct rc_boundary boundary, enum rc_precision precision, size_t threads,
           struct rc_err *err)
{
    return rc_fft_new_coarser(ranks, lender, s, 0, boundary, precision, threads, err);
}

struct rc_fft *
rc_fft_new_coarser(const struct rc_ranks *ranks, struct rc_fft *lender, const struct rc_shape *s,
                   size_t level, struct rc_boundary boundary, enum rc_precision precision,
                   size_t threads, struct rc_err *err)
{
    if (rc_shape_check(s, err) != RC_OK || rc_boundary_check(boundary, err) != RC_OK)
        return NULL;
    if (s->nx > (size_t)1 << 28 || s->ny > (size_t)1 << 28)
        return rc_err_null(err, "%zu x %zu nodes: a side is too long for a Fourier transform",
                           s->nx, s->ny);
    return agree(ranks, fft_new(ranks, lender, s, level, boundary, NULL, precision, threads, err),
                 err);
}

struct rc_fft *
rc_fft_new_framed(const struct rc_ranks *ranks, struct rc_fft *lender, const struct rc_shape *s,
                  struct rc_boundary boundary, const struct rc_frame *frame,
                  enum rc_precision precision, size_t threads, struct rc_err *err)
{
    return agree(ranks, fft_new(ranks, lender, s, 0, boundary, frame, precision, threads, err),
                 err);
}

static const struct rc_ranks *
ranks_of(const struct rc_fft *f)
{
    return f->layout.turn == NULL ? NULL : f->layout.turn->ranks;
}

void
rc_fft_free(struct rc_fft *f)
{
    if (f == NULL)
        return;
    if (f->plan != NULL)
        f->ops->free(f->plan);
    half_free(&f->along_x);
    half_free(&f->along_y);
    rc_turn_free(&f->turn);
    rc_turn_free(&f->quarter);
    rc_store_free(&f->own);
    free(f);
}

/* ---- spectra ---- */

struct rc_spectrum *
rc_spectrum_new(const struct rc_fft *f, struct rc_err *err)
{
    const struct rc_layout *l = &f->layout;
    RC_OWN(rc_spectrum, k) = calloc(1, sizeof *k);

    if (k != NULL)
        k->values = rc_alloc(l->columns * l->cy, f->ops->real_size);
    if (rc_ranks_need(ranks_of(f), k != NULL && k->values != NULL, err,
                      "out of memory for a kernel's spectrum of %zu x %zu numbers", l->cx,
                      l->cy) != RC_OK)
        return NULL;
    k->ratio = k->first = numbers_themselves;
    return rc_give(&k);
}

void
rc_spectrum_free(struct rc_spectrum *k)
{
    if (k == NULL)
        return;
    if (!k->lent)
        free(k->values);
    free(k);
}

static double *
columns_of(const struct rc_fft *f)
{
    return f->columns + (size_t)omp_get_thread_num() * COLUMNS * f->layout.cy;
}

/* Stores column c of those held here. */
static void
store_column(struct rc_spectrum *k, const struct rc_fft *f, size_t c, const double *s)
{
    const struct rc_layout *l = &f->layout;

    if (l->first + c == 0)
        k->total = s[0];
    f->ops->store(l, c, 1 / ((double)l->px * (double)l->py), k->parity & RC_ODD_Y ? -1 : 1, s,
                  k->values);
}

/* The rank with the first column sends the total to the others. */
static void
share_total(struct rc_spectrum *k, const struct rc_fft *f)
{
    size_t root = 0;

    if (f->layout.turn == NULL)
        return;
    while (f->turn.column[root + 1] == 0)
        root++;
    rc_ranks_share(f->turn.ranks, root, sizeof k->total, &k->total);
}

double
rc_spectrum_total(const struct rc_spectrum *k)
{
    return k->total;
}

/* ---- from a quarter of the values ---- */

void
rc_fft_quarter(const struct rc_fft *f, size_t *nx, size_t *ny)
{
    *nx = f->layout.cx;
    *ny = f->layout.cy;
}

void
rc_fft_quarter_rows(const struct rc_fft *f, size_t *first, size_t *n)
{
    const struct rc_turn *t = &f->quarter;

    *first = f->layout.turn == NULL ? 0 : t->row[t->own];
    *n = f->layout.turn == NULL ? f->layout.cy : t->row[t->own + 1] - *first;
}

size_t
rc_fft_quarter_size(const struct rc_fft *f)
{
    size_t first, rows, turned = f->layout.cy * f->layout.wide;

    rc_fft_quarter_rows(f, &first, &rows);
    return f->layout.turn == NULL || rows * f->layout.cx > turned ? rows * f->layout.cx : turned;
}

size_t
rc_fft_quarter_wide(const struct rc_fft *f)
{
    return f->layout.turn == NULL ? f->layout.cx : f->layout.wide;
}

void
rc_fft_quarter_line(const struct rc_fft *f, size_t count, unsigned odd, double *const *lines)
{
    half_run(f->boundary.x ? &f->along_y : &f->along_x, count, odd, lines);
}

/* Copies the n columns from `first` on; rows are `wide` numbers long. */
static void
gather_columns(const double *rows, size_t cy, size_t wide, size_t first, size_t n, double *columns)
{
    for (size_t j = 0; j < cy; j++) {
        const double *row = rows + j * wide + first;
        if (j + PREFETCH < cy) {
            __builtin_prefetch(row + PREFETCH * wide);
            __builtin_prefetch(row + PREFETCH * wide + COLUMNS / 2);
        }
        for (size_t b = 0; b < n; b++)
            columns[b * cy + j] = row[b];
    }
}

/* From all rows of the columns held here; rows are `wide` numbers apart. `waves`: the rows stand for waves
 * along y already. */
static void
set_quarter(struct rc_spectrum *k, const struct rc_fft *f, unsigned parity, bool waves,
            const double *rows, size_t wide, rc_column *each, void *ctx)
{
    size_t cx = f->layout.columns, cy = f->layout.cy;

    k->parity = parity;
#pragma omp parallel for num_threads(f->layout.threads) schedule(static)
    for (size_t first = 0; first < cx; first += COLUMNS) {
        double *columns = columns_of(f);
        size_t n = cx - first < COLUMNS ? cx - first : COLUMNS;

        gather_columns(rows, cy, wide, first, n, columns);
        for (size_t b = 0; b < n; b++) {
            double *column = columns + b * cy;
            if (!waves)
                half_run(&f->along_y, 1, (parity & RC_ODD_Y) != 0, &column);
            if (each != NULL)
                each(ctx, f->layout.first + first + b, cy, columns + b * cy);
            store_column(k, f, first + b, columns + b * cy);
        }
    }
    share_total(k, f);
}

enum rc_status
rc_fft_quarter_turn(const struct rc_fft *f, double *quarter, struct rc_err *err)
{
    const struct rc_layout *l = &f->layout;
    size_t first, n;
    RC_OWNED double *pieces = NULL, *row = NULL;

    if (l->turn == NULL)
        return RC_OK;
    rc_fft_quarter_rows(f, &first, &n);
    pieces = rc_alloc(n * l->stride, sizeof *pieces);
    row = calloc(l->stride, sizeof *row);
    if (rc_ranks_need(ranks_of(f), pieces != NULL && row != NULL, err,
                      "out of memory for a kernel of %zu x %zu values", l->cx, l->cy) != RC_OK)
        return RC_FAIL;
    for (size_t j = 0; j < n; j++) {
        memcpy(row, quarter + j * l->cx, l->cx * sizeof *row);
        rc_turn_put(&f->quarter, j, row, pieces);
    }
    rc_ranks_turn(&f->quarter, false, pieces, quarter);
    return RC_OK;
}

/* The values of a kernel in rows first .. last - 1 of a quarter, or those of a wave along y for each
 * row where y repeats, transformed along x. */
static enum rc_status
quarter_rows(const struct rc_fft *f, const struct rc_kernel *kernel, struct rc_boundary boundary,
             size_t first, size_t last, double *values)
{
    const struct rc_lattice nodes = {f->shape.dx, f->shape.dy, 1, 1};
    struct rc_line_at line = {f->shape.dx, 1, f->layout.cx, 0, boundary.datum};
    const size_t cx = f->layout.cx;
    enum rc_status status = RC_OK;

    if (!boundary.y)
        kernel->rows(kernel->of, &nodes, cx, first, last, values);
    for (size_t j = first; j < last; j++) {
        double *row = values + (j - first) * cx;
        line.wave = rc_fft_qy(f, j);
        if (boundary.y && 2 * j == f->layout.ny && kernel->parity & RC_ODD_Y)
            memset(row, 0, cx * sizeof *row);
        else if (boundary.y && rc_kernel_line(kernel, true, &line, row, NULL) != RC_OK)
            status = RC_FAIL;
        half_run(&f->along_x, 1, (kernel->parity & RC_ODD_X) != 0, &row);
    }
    return status;
}

/* The spectrum of a kernel on a map that repeats along x only: column by column, from a line along y. */
static enum rc_status
set_columns(struct rc_spectrum *k, const struct rc_fft *f, const struct rc_kernel *kernel,
            double datum, rc_column *each, void *ctx, struct rc_err *err)
{
    const struct rc_layout *l = &f->layout;
    enum rc_status status = RC_OK;

    k->parity = kernel->parity;
#pragma omp parallel for num_threads(l->threads) schedule(dynamic)
    for (size_t c = 0; c < l->columns; c++) {
        double *column = columns_of(f);
        const size_t i = l->first + c;
        const struct rc_line_at line = {f->shape.dy, 1, l->cy, rc_fft_qx(f, i), datum};
        if (2 * i == l->nx && kernel->parity & RC_ODD_X)
            memset(column, 0, l->cy * sizeof *column);
        else if (rc_kernel_line(kernel, false, &line, column, NULL) != RC_OK)
#pragma omp atomic write
            status = RC_FAIL;
        half_run(&f->along_y, 1, (kernel->parity & RC_ODD_Y) != 0, &column);
        if (each != NULL)
            each(ctx, i, l->cy, column);
        store_column(k, f, c, column);
    }
    share_total(k, f);
    return rc_ranks_need(ranks_of(f), status == RC_OK, err,
                         "out of memory for a kernel of %zu x %zu values", l->cx, l->cy);
}

enum rc_status
rc_spectrum_set_by(struct rc_spectrum *k, const struct rc_fft *f, const struct rc_kernel *kernel,
                   struct rc_boundary boundary, rc_column *each, void *ctx, struct rc_err *err)
{
    size_t cx = f->layout.cx, from, rows;
    enum rc_status status = RC_OK;
    const size_t size = rc_fft_quarter_size(f);
    RC_OWNED double *own = NULL;
    double *values;

    if (boundary.x)
        return set_columns(k, f, kernel, boundary.datum, each, ctx, err);
    values = f->ops->workspace(f->plan, size * sizeof *values);
    rc_fft_quarter_rows(f, &from, &rows);
    if (values == NULL)
        values = own = rc_alloc(size, sizeof *own);
    if (rc_ranks_need(ranks_of(f), values != NULL, err,
                      "out of memory for a kernel of %zu x %zu values", cx, rows) != RC_OK)
        return RC_FAIL;
#pragma omp parallel for num_threads(f->layout.threads) schedule(dynamic)
    for (size_t first = from; first < from + rows; first += ROWS) {
        size_t last = first + ROWS < from + rows ? first + ROWS : from + rows;

        if (quarter_rows(f, kernel, boundary, first, last, values + (first - from) * cx) != RC_OK)
#pragma omp atomic write
            status = RC_FAIL;
    }
    if (rc_ranks_need(ranks_of(f), status == RC_OK, err,
                      "out of memory for a kernel of %zu x %zu values", cx, rows) != RC_OK ||
        rc_fft_quarter_turn(f, values, err) != RC_OK)
        return RC_FAIL;
    set_quarter(k, f, kernel->parity, boundary.y, values, rc_fft_quarter_wide(f), each, ctx);
    return RC_OK;
}

void
rc_keep_column(void *ctx, size_t i, size_t n, double *column)
{
    memcpy((double *)ctx + i * n, column, n * sizeof *column);
}

void
rc_fft_waves(const struct rc_fft *f, size_t *columns, size_t *n)
{
    *columns = f->layout.cx;
    *n = f->layout.cy;
}

int
rc_fft_threads(const struct rc_fft *f)
{
    return f->layout.threads;
}

void
rc_fft_columns(const struct rc_fft *f, size_t *first, size_t *n)
{
    *first = f->layout.first;
    *n = f->layout.columns;
}

size_t
rc_fft_column_of(const struct rc_fft *f, size_t r)
{
    const struct rc_layout *l = &f->layout;
    const size_t column = l->turn == NULL ? r * l->cx : l->turn->column[r] * f->ops->line;

    return column < l->cx ? column : l->cx;
}

size_t
rc_fft_rows(const struct rc_fft *f)
{
    return f->layout.rows;
}

double
rc_fft_qx(const struct rc_fft *f, size_t i)
{
    return rc_fourier_q(i, f->layout.px, f->shape.dx);
}

double
rc_fft_qy(const struct rc_fft *f, size_t j)
{
    return rc_fourier_q(j, f->layout.py, f->shape.dy);
}

/* ---- from a function of wave numbers ---- */

/* Column i at the wave numbers qy; waves of two nodes are left out where the kernel is odd. */
static void
sample_column(const struct rc_fft *f, unsigned parity, rc_symbol *symbol, const void *of, size_t i,
              const double *qy, double *column)
{
    const struct rc_layout *l = &f->layout;

    if (2 * i == l->nx && parity & RC_ODD_X)
        memset(column, 0, l->cy * sizeof *column);
    else
        symbol(of, i, rc_fourier_q(i, l->nx, f->shape.dx), l->cy, qy, column);
    if (2 * (l->cy - 1) == l->ny && parity & RC_ODD_Y)
        column[l->cy - 1] = 0;
}

static void
set_waves(const struct rc_fft *f, double *qy)
{
    for (size_t j = 0; j < f->layout.cy; j++)
        qy[j] = rc_fourier_q(j, f->layout.ny, f->shape.dy);
}

static void
sample(struct rc_spectrum *k, const struct rc_fft *f, unsigned parity, rc_symbol *symbol,
       const void *of)
{
    const struct rc_layout *l = &f->layout;

    k->parity = parity;
#pragma omp parallel num_threads(l->threads)
    {
        double *column = columns_of(f), *qy = column + l->cy;

        set_waves(f, qy);
#pragma omp for schedule(static)
        for (size_t c = 0; c < l->columns; c++) {
            sample_column(f, parity, symbol, of, l->first + c, qy, column);
            store_column(k, f, c, column);
        }
    }
    share_total(k, f);
}

static void
symbol_of(const void *of, size_t i, double qx, size_t n, const double *qy, double *out)
{
    const struct rc_kernel *kernel = of;

    (void)i;
    for (size_t j = 0; j < n; j++)
        out[j] = qx == 0 && qy[j] == 0 ? 0 : kernel->symbol(kernel->of, qx, qy[j]);
}

enum rc_status
rc_spectrum_set(struct rc_spectrum *k, const struct rc_fft *f, const struct rc_kernel *kernel,
                struct rc_err *err)
{
    if (rc_has_mean(f->boundary))
        return rc_spectrum_set_by(k, f, kernel, f->boundary, NULL, NULL, err);
    if (kernel->symbol == NULL)
        return rc_err_set(err, "this kernel has no periodic form");
    sample(k, f, kernel->parity, symbol_of, kernel);
    return RC_OK;
}

/* ---- from another spectrum ---- */

struct rc_spectrum *
rc_spectrum_new_reciprocal(const struct rc_fft *f, const struct rc_spectrum *of, struct rc_err *err)
{
    RC_OWN(rc_spectrum, k) = calloc(1, sizeof *k);
    double size = (double)f->layout.px * (double)f->layout.py;

    if (rc_ranks_need(ranks_of(f), k != NULL, err, "out of memory for a spectrum") != RC_OK)
        return NULL;
    *k = *of;
    k->lent = true;
    k->ratio = k->first =
        (struct rc_ratio){1 / (size * size), 0, 0, 1}; /* both are divided by size */
    k->total = of->total == 0 ? 0 : 1 / of->total;
    return rc_give(&k);
}

/* Stored numbers s are K/N or A/N, N = px py. K + D is s + D/N, 1/(K + D) is N^-2/(s + D/N) of a lent K, and
 * A/(1 + D A) is s/(1 + D N s). R'R multiplies waves along y by px, and all others by 0. */
void
rc_spectrum_add(struct rc_spectrum *k, const struct rc_fft *f, bool inverse, double plus,
                double row)
{
    const double size = (double)f->layout.px * (double)f->layout.py;
    const double all = plus + row * (double)f->layout.px;

    if (!inverse) {
        k->ratio.a = plus / size;
        k->first.a = all / size;
    } else if (k->lent) {
        k->ratio.c = plus / size;
        k->first.c = all / size;
    } else {
        k->ratio.d = plus * size;
        k->first.d = all * size;
    }
}

/* ---- use ---- */

_Thread_local const volatile sig_atomic_t *rc_fft_hurry;

static struct rc_factor
factor_of(const struct rc_spectrum *k)
{
    return (struct rc_factor){k->values, k->parity, k->ratio, k->first};
}

void
rc_fft_apply(struct rc_fft *f, const struct rc_spectrum *k, const double *p, double *u)
{
    struct rc_factor factor = factor_of(k);

    f->ops->apply(f->plan, &factor, p, u);
}

void
rc_fft_chain(struct rc_fft *f, size_t n, const struct rc_spectrum *const *kernels,
             rc_row *const *rows, void *ctx)
{
    struct rc_link links[RC_CHAIN];

    assert(n <= RC_CHAIN);
    for (size_t k = 0; k < n; k++)
        links[k] = (struct rc_link){rows[k], factor_of(kernels[k])};
    f->ops->chain(f->plan, n, links, rows[n], ctx);
}

enum rc_status
rc_fft_load(struct rc_fft *f, size_t source, const double *p, struct rc_err *err)
{
    assert(source < RC_SOURCES);
    return f->ops->load(f->plan, source, p)
               ? RC_OK
               : rc_err_set(err, "out of memory for the transform of %zu x %zu nodes", f->shape.nx,
                            f->shape.ny);
}

/* The kernels of rc_fft_fields, and memory for each thread: lines of columns, and their spectra. */
struct lines {
    const struct rc_fft *f;
    size_t count;
    const struct rc_fft_kernel *kernel;
    unsigned odd; /* bits: odd in y */
    double *columns;
    char *spectra;
};

static const void *
line_spectra(void *ctx, size_t c, size_t n)
{
    const struct lines *lines = ctx;
    const struct rc_fft *f = lines->f;
    const struct rc_layout *l = &f->layout;
    const size_t line = f->ops->line, size = line * l->cy, thread = (size_t)omp_get_thread_num();
    const double factor = 1 / ((double)l->px * (double)l->py);
    double *columns = lines->columns + thread * (lines->count + 1) * size;
    double *qy = columns + lines->count * size, *column[RC_LINES];
    char *spectra = lines->spectra + thread * lines->count * size * f->ops->real_size;

    set_waves(f, qy);
    for (size_t k = 0; k < lines->count && rc_has_mean(f->boundary); k++)
        gather_columns(lines->kernel[k].quarter, l->cy, rc_fft_quarter_wide(f), c, n,
                       columns + k * size);
    for (size_t b = 0; b < n; b++) {
        for (size_t k = 0; k < lines->count; k++) {
            const struct rc_fft_kernel *kernel = &lines->kernel[k];
            column[k] = columns + k * size + b * l->cy;
            if (!rc_has_mean(f->boundary))
                sample_column(f, kernel->parity, kernel->symbol, kernel->of, l->first + c + b, qy,
                              column[k]);
        }
        if (rc_repeats(f->boundary) == 0)
            half_run(&f->along_y, lines->count, lines->odd, column);
        for (size_t k = 0; k < lines->count; k++)
            f->ops->store(l, k * line + b, factor, lines->odd >> k & 1 ? -1 : 1, column[k],
                          spectra);
    }
    return spectra;
}

enum rc_status
rc_fft_fields(struct rc_fft *f, size_t columns, size_t kernels, const struct rc_fft_kernel *kernel,
              size_t n, const struct rc_fft_sum *sum, struct rc_err *err)
{
    const size_t size = (size_t)f->layout.threads * f->ops->line * f->layout.cy;
    RC_OWNED double *column = rc_alloc((kernels + 1) * size, sizeof *column);
    RC_OWNED char *spectra = rc_alloc(kernels * size, f->ops->real_size);
    struct lines lines = {f, kernels, kernel, 0, column, spectra};

    assert(kernels <= RC_LINES && n <= RC_FIELDS);
    for (size_t k = 0; k < kernels; k++)
        lines.odd |= kernel[k].parity & RC_ODD_Y ? 1u << k : 0;
    if (rc_ranks_sum(ranks_of(f), column == NULL || spectra == NULL) > 0 ||
        !f->ops->fields(f->plan, columns, line_spectra, &lines, kernel, n, sum))
        return rc_err_set(err, "out of memory for fields of %zu x %zu nodes", f->shape.nx,
                          f->shape.ny);
    return RC_OK;
}

/* ---- waves alone ---- */

size_t
rc_fft_length(const struct rc_fft *f)
{
    return f->layout.py;
}

size_t
rc_fft_wave(const struct rc_fft *f, size_t t)
{
    return f->layout.radix * (t % f->layout.m) + t / f->layout.m;
}

bool
rc_fft_fold(const struct rc_fft *f, struct rc_store *own, size_t **place, signed char **mirror)
{
    const size_t n = f->layout.py;

    *place = rc_store_take(own, n, sizeof **place);
    *mirror = rc_store_take(own, n, sizeof **mirror);
    for (size_t t = 0; t < n && !own->failed; t++) {
        const size_t j = rc_fft_wave(f, t);
        (*place)[t] = 2 * j <= n ? j : n - j;
        (*mirror)[t] = 2 * j <= n ? 1 : -1;
    }
    return !own->failed;
}

void
rc_fft_forward(struct rc_fft *f, rc_row *row, void *ctx, void *waves, rc_wave_column *column)
{
    f->ops->forward(f->plan, row, ctx, waves, column);
}

void
rc_fft_back(struct rc_fft *f, const void *waves, rc_wave_column *column, rc_row *row, void *ctx)
{
    f->ops->back(f->plan, waves, column, row, ctx);
}
