/*
 * Layout of the transforms and spectra of kernels. A kernel that is even or odd in x and in y has a
 * spectrum that is real up to a power of -i and given by a quarter of it.
 *
 * Free boundary: zero padding to px >= 2 nx, py >= 2 ny is exact, and the spectrum is the real even
 * or odd transform of a quarter of the kernel's values. At the offset of half a period the kernel's
 * own value stands: with a zero there the spectrum of thin grids turns negative and has no useful
 * inverse. Periodic boundary: nothing is padded, the spectrum is the kernel's symbol.
 */
#include "fft.h"

#include <assert.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "dct.h"
#include "fourier.h"
#include "libcontact/memory.h"

struct rc_fft {
    struct rc_shape shape;
    enum rc_boundary boundary;
    struct rc_layout layout;
    const struct rc_fft_ops *ops;
    void *plan;
    struct rc_dct *along_x,
        *along_y;    /* of a quarter of a kernel; NULL on periods of odd length   */
    double *columns; /* COLUMNS columns of a spectrum for each thread */
};

enum {
    COLUMNS = 16, /* of a quarter transformed together: two cache lines, fetched as a pair */
    PREFETCH = 8, /* rows fetched in advance: they lie pages apart */
    ROWS = 8      /* of a kernel evaluated together */
};

struct rc_spectrum {
    unsigned parity;
    size_t columns; /* those from here on are zero */
    double total;   /* at wave number 0            */
    void *values;   /* cx columns of cy numbers, as fft.h has them, divided by px py */
    double over;    /* 0; or over these numbers, which are another's                 */
};

/* ---- layout ---- */

size_t
rc_fft_length(size_t n, size_t step)
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

static struct rc_layout
layout_of(const struct rc_shape *s, enum rc_boundary boundary, enum rc_precision precision)
{
    const size_t line = precision == RC_SINGLE ? 16 : 8; /* complex numbers in two cache lines */
    struct rc_layout l = {.nx = s->nx, .ny = s->ny, .px = s->nx, .py = s->ny};

    if (boundary == RC_FREE) {
        l.px = rc_fft_length(s->nx, 2);
        l.py = rc_fft_length(s->ny, 4);
    }
    l.cx = l.px / 2 + 1;
    l.stride = (l.cx + line - 1) / line * line;
    l.radix = l.py % 4 == 0 && l.py >= 64 ? 4 : 1;
    if (boundary == RC_FREE)
        l.radix = 4;
    l.m = l.py / l.radix;
    l.parts = boundary == RC_FREE ? 2 : l.radix;
    l.cy = l.py / 2 + 1;
    return l;
}

size_t
rc_spectrum_memory(const struct rc_shape *shape, enum rc_boundary boundary,
                   enum rc_precision precision)
{
    struct rc_layout l = layout_of(shape, boundary, precision);

    return l.cx * l.cy * (precision == RC_SINGLE ? sizeof(float) : sizeof(double));
}

size_t
rc_fft_memory(const struct rc_shape *shape, enum rc_boundary boundary, enum rc_precision precision)
{
    struct rc_layout l = layout_of(shape, boundary, precision);

    return l.ny * l.stride * 2 * (precision == RC_SINGLE ? sizeof(float) : sizeof(double)) +
           rc_spectrum_memory(shape, boundary, precision);
}

/* Whether a quarter of an even kernel's values, from offset 0 to half a period, tells all. */
static bool
by_quarter(const struct rc_layout *l)
{
    return l->px % 2 == 0 && l->py % 2 == 0;
}

struct rc_fft *
rc_fft_new(const struct rc_shape *s, enum rc_boundary boundary, enum rc_precision precision,
           size_t threads, struct rc_err *err)
{
    return rc_fft_new_in(NULL, s, boundary, precision, threads, err);
}

/* Bytes of the rows under way. */
static size_t
rows_memory(const struct rc_layout *l, enum rc_precision precision)
{
    return l->ny * l->stride * 2 * (precision == RC_SINGLE ? sizeof(float) : sizeof(double));
}

struct rc_fft *
rc_fft_new_in(struct rc_fft *lender, const struct rc_shape *s, enum rc_boundary boundary,
              enum rc_precision precision, size_t threads, struct rc_err *err)
{
    void *lent = NULL;
    struct rc_fft *f;
    size_t team;

    if (rc_shape_check(s, err) != RC_OK)
        return NULL;
    if (s->nx > (size_t)1 << 28 || s->ny > (size_t)1 << 28) {
        rc_err_set(err, "%zu x %zu nodes: a side is too long for a Fourier transform", s->nx,
                   s->ny);
        return NULL;
    }
    f = calloc(1, sizeof *f);
    if (f != NULL) {
        f->shape = *s;
        f->boundary = boundary;
        f->layout = layout_of(s, boundary, precision);
        f->layout.threads = rc_useful_threads(s, threads);
        team = (size_t)f->layout.threads;
        f->ops = precision == RC_SINGLE ? &rc_fft_single : &rc_fft_double;
        if (lender != NULL)
            lent = lender->ops->workspace(lender->plan, rows_memory(&f->layout, precision));
        f->plan = f->ops->new (&f->layout, lent);
        f->columns = rc_alloc(team * COLUMNS * f->layout.cy, sizeof *f->columns);
    }
    if (f != NULL && by_quarter(&f->layout)) {
        f->along_x = rc_dct_new(f->layout.cx, team, NULL);
        f->along_y = rc_dct_new(f->layout.cy, team, NULL);
    }
    if (f == NULL || f->plan == NULL || f->columns == NULL ||
        (by_quarter(&f->layout) && (f->along_x == NULL || f->along_y == NULL))) {
        rc_err_set(err, "out of memory for transforms of %zu x %zu nodes", s->nx, s->ny);
        rc_fft_free(f);
        return NULL;
    }
    return f;
}

void
rc_fft_free(struct rc_fft *f)
{
    if (f == NULL)
        return;
    if (f->plan != NULL)
        f->ops->free(f->plan);
    rc_dct_free(f->along_x);
    rc_dct_free(f->along_y);
    free(f->columns);
    free(f);
}

/* ---- spectra ---- */

struct rc_spectrum *
rc_spectrum_new(const struct rc_fft *f, struct rc_err *err)
{
    const struct rc_layout *l = &f->layout;
    struct rc_spectrum *k = calloc(1, sizeof *k);

    if (k != NULL)
        k->values = rc_alloc(l->cx * l->cy, f->ops->real_size);
    if (k != NULL)
        k->columns = l->cx;
    if (k == NULL || k->values == NULL) {
        rc_err_set(err, "out of memory for a kernel's spectrum of %zu x %zu numbers", l->cx, l->cy);
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
    if (k->over == 0)
        free(k->values);
    free(k);
}

static double *
columns_of(const struct rc_fft *f)
{
    return f->columns + (size_t)omp_get_thread_num() * COLUMNS * f->layout.cy;
}

static void
store_column(struct rc_spectrum *k, const struct rc_fft *f, size_t c, const double *s)
{
    const struct rc_layout *l = &f->layout;

    if (c == 0)
        k->total = s[0];
    f->ops->store(l, c, 1 / ((double)l->px * (double)l->py), k->parity & RC_ODD_Y ? -1 : 1, s,
                  k->values);
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
rc_fft_quarter_row(const struct rc_fft *f, unsigned parity, double *row)
{
    rc_dct_run(f->along_x, parity & RC_ODD_X, row);
}

static void
set_quarter(struct rc_spectrum *k, const struct rc_fft *f, unsigned parity, const double *rows,
            rc_column *each, void *ctx)
{
    size_t cx = f->layout.cx, cy = f->layout.cy;

    k->parity = parity;
    k->columns = cx;
#pragma omp parallel for num_threads(f->layout.threads) schedule(static)
    for (size_t first = 0; first < cx; first += COLUMNS) {
        double *columns = columns_of(f);
        size_t n = cx - first < COLUMNS ? cx - first : COLUMNS;

        for (size_t j = 0; j < cy; j++) {
            const double *row = rows + j * cx + first;
            if (j + PREFETCH < cy) {
                __builtin_prefetch(row + PREFETCH * cx);
                __builtin_prefetch(row + PREFETCH * cx + COLUMNS / 2);
            }
            for (size_t b = 0; b < n; b++)
                columns[b * cy + j] = row[b];
        }
        for (size_t b = 0; b < n; b++) {
            rc_dct_run(f->along_y, parity & RC_ODD_Y, columns + b * cy);
            if (each != NULL)
                each(ctx, first + b, cy, columns + b * cy);
            store_column(k, f, first + b, columns + b * cy);
        }
    }
}

void
rc_spectrum_set_quarter(struct rc_spectrum *k, const struct rc_fft *f, unsigned parity,
                        const double *rows)
{
    set_quarter(k, f, parity, rows, NULL, NULL);
}

enum rc_status
rc_spectrum_set_by(struct rc_spectrum *k, const struct rc_fft *f, const struct rc_kernel *kernel,
                   size_t component, const struct rc_medium *medium, rc_column *each, void *ctx,
                   struct rc_err *err)
{
    const struct rc_lattice nodes = {f->shape.dx, f->shape.dy, 1, 1};
    size_t cx = f->layout.cx, cy = f->layout.cy;
    unsigned parity = kernel->parity[component];
    double *own = NULL, *values = f->ops->workspace(f->plan, cx * cy * sizeof *values);

    if (values == NULL)
        values = own = rc_alloc(cx * cy, sizeof *own);
    if (values == NULL)
        return rc_err_set(err, "out of memory for a kernel of %zu x %zu values", cx, cy);
#pragma omp parallel for num_threads(f->layout.threads) schedule(dynamic)
    for (size_t first = 0; first < cy; first += ROWS) {
        size_t last = first + ROWS < cy ? first + ROWS : cy;

        kernel->rows(medium, component, &nodes, cx, first, last, values + first * cx);
        for (size_t j = first; j < last; j++)
            rc_fft_quarter_row(f, parity, values + j * cx);
    }
    set_quarter(k, f, parity, values, each, ctx);
    free(own);
    return RC_OK;
}

static enum rc_status
transform_quarter(const struct rc_fft *f, struct rc_spectrum *k, const struct rc_kernel *kernel,
                  size_t component, const struct rc_medium *medium, struct rc_err *err)
{
    return rc_spectrum_set_by(k, f, kernel, component, medium, NULL, NULL, err);
}

void
rc_fft_waves(const struct rc_fft *f, size_t *columns, size_t *n)
{
    *columns = f->layout.cx;
    *n = f->layout.cy;
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

void
rc_spectrum_sample(struct rc_spectrum *k, const struct rc_fft *f, unsigned parity,
                   rc_symbol *symbol, const void *of)
{
    const struct rc_layout *l = &f->layout;
    size_t columns = 0;

    k->parity = parity;
#pragma omp parallel num_threads(l->threads) reduction(max : columns)
    {
        double *column = columns_of(f), *qy = column + l->cy;

        for (size_t j = 0; j < l->cy; j++)
            qy[j] = rc_fourier_q(j, l->ny, f->shape.dy);
#pragma omp for schedule(static)
        for (size_t i = 0; i < l->cx; i++) {
            bool zero = 2 * i == l->nx && parity & RC_ODD_X;
            if (zero || !symbol(of, i, rc_fourier_q(i, l->nx, f->shape.dx), l->cy, qy, column))
                memset(column, 0, l->cy * sizeof *column);
            else
                columns = i + 1;
            if (2 * (l->cy - 1) == l->ny && parity & RC_ODD_Y)
                column[l->cy - 1] = 0;
            store_column(k, f, i, column);
        }
    }
    k->columns = columns;
}

/* One component of a kernel in a medium. */
struct component {
    const struct rc_kernel *kernel;
    size_t index;
    const struct rc_medium *medium;
};

static bool
symbol_of(const void *of, size_t i, double qx, size_t n, const double *qy, double *out)
{
    const struct component *c = of;

    (void)i;
    for (size_t j = 0; j < n; j++)
        out[j] = qx == 0 && qy[j] == 0 ? 0 : c->kernel->symbol(c->medium, c->index, qx, qy[j]);
    return true;
}

static enum rc_status
sample_symbol(const struct rc_fft *f, struct rc_spectrum *k, const struct rc_kernel *kernel,
              size_t component, const struct rc_medium *medium, struct rc_err *err)
{
    const struct component of = {kernel, component, medium};

    if (kernel->symbol == NULL)
        return rc_err_set(err, "the kernel '%s' has no periodic form", kernel->info.name);
    rc_spectrum_sample(k, f, kernel->parity[component], symbol_of, &of);
    return RC_OK;
}

/* ---- from the values of a periodic map of odd length ---- */

/* Values of an even kernel on the periodic map, each offset by its shortest way around. */
static void
wrapped_values(const struct rc_fft *f, const struct rc_kernel *kernel, size_t component,
               const struct rc_medium *medium, double *v)
{
    const struct rc_lattice nodes = {f->shape.dx, f->shape.dy, 1, 1};
    size_t nx = f->shape.nx, ny = f->shape.ny;

    for (size_t j = 0; j <= ny / 2; j++) {
        double *row = v + j * nx;
        kernel->rows(medium, component, &nodes, nx / 2 + 1, j, j + 1, row);
        for (size_t i = nx / 2 + 1; i < nx; i++)
            row[i] = row[nx - i];
        if (j > 0 && ny - j != j)
            memcpy(v + (ny - j) * nx, row, nx * sizeof *row);
    }
}

static enum rc_status
transform_wrapped(const struct rc_fft *f, struct rc_spectrum *k, const struct rc_kernel *kernel,
                  size_t component, const struct rc_medium *medium, struct rc_err *err)
{
    const struct rc_layout *l = &f->layout;
    double *v = rc_alloc(l->nx * l->ny, sizeof *v), *column = columns_of(f);
    double complex *s = rc_alloc(rc_fourier_size(&f->shape), sizeof *s);
    enum rc_status status = RC_FAIL;

    if (v == NULL || s == NULL) {
        rc_err_set(err, "out of memory for a kernel of %zu x %zu values", l->nx, l->ny);
        goto done;
    }
    wrapped_values(f, kernel, component, medium, v);
    k->parity = kernel->parity[component];
    k->columns = l->cx;
    status = rc_fourier_forward(&f->shape, v, s, err);
    for (size_t i = 0; i < l->cx && status == RC_OK; i++) {
        for (size_t j = 0; j < l->cy; j++)
            column[j] = creal(s[j * l->cx + i]);
        store_column(k, f, i, column);
    }
done:
    free(v);
    free(s);
    return status;
}

enum rc_status
rc_spectrum_set_values(struct rc_spectrum *k, const struct rc_fft *f,
                       const struct rc_kernel *kernel, size_t component,
                       const struct rc_medium *medium, struct rc_err *err)
{
    return (by_quarter(&f->layout) ? transform_quarter : transform_wrapped)(f, k, kernel, component,
                                                                            medium, err);
}

enum rc_status
rc_spectrum_set(struct rc_spectrum *k, const struct rc_fft *f, const struct rc_kernel *kernel,
                size_t component, const struct rc_medium *medium, struct rc_err *err)
{
    return (f->boundary == RC_FREE ? transform_quarter : sample_symbol)(f, k, kernel, component,
                                                                        medium, err);
}

/* ---- from another spectrum ---- */

struct rc_spectrum *
rc_spectrum_new_reciprocal(const struct rc_fft *f, const struct rc_spectrum *of, struct rc_err *err)
{
    struct rc_spectrum *k = malloc(sizeof *k);
    double size = (double)f->layout.px * (double)f->layout.py;

    if (k == NULL) {
        rc_err_set(err, "out of memory for a spectrum");
        return NULL;
    }
    *k = *of;
    k->over = 1 / (size * size); /* both are divided by it */
    k->total = of->total == 0 ? 0 : 1 / of->total;
    return k;
}

/* ---- use ---- */

static struct rc_factor
factor_of(const struct rc_spectrum *k)
{
    return (struct rc_factor){k->values, k->parity, k->over};
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
rc_fft_load(struct rc_fft *f, const double *p, struct rc_err *err)
{
    if (!f->ops->load(f->plan, p))
        return rc_err_set(err, "out of memory for the transform of %zu x %zu nodes", f->shape.nx,
                          f->shape.ny);
    return RC_OK;
}

void
rc_fft_field(struct rc_fft *f, const struct rc_spectrum *k, double *u)
{
    f->ops->field(f->plan, k->columns, k->values, k->parity, NULL, 0, 0, u);
}

void
rc_fft_field_pair(struct rc_fft *f, const struct rc_spectrum *k, double weight,
                  const struct rc_spectrum *also, double *u)
{
    size_t columns = k->columns > also->columns ? k->columns : also->columns;

    f->ops->field(f->plan, columns, k->values, k->parity, also->values, also->parity, weight, u);
}
