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
#include "libcontact/memory.h"

#include <assert.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "fourier.h"

struct rc_fft {
    struct rc_shape shape;
    enum rc_boundary boundary;
    struct rc_layout layout;
    const struct rc_fft_ops *ops;
    void *plan;
};

struct rc_spectrum {
    const struct rc_fft_ops *ops;
    unsigned parity;
    void *packed; /* cx columns of layout.packed numbers, divided by px py */
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
    l.split = l.py % 4 == 0 && l.py >= 64 ? 4 : 1;
    if (boundary == RC_FREE)
        l.split = 4;
    l.m = l.py / l.split;
    l.parts = boundary == RC_FREE ? 2 : l.split;
    l.packed = l.py / 2 + 1;
    return l;
}

size_t
rc_spectrum_memory(const struct rc_shape *shape, enum rc_boundary boundary,
                   enum rc_precision precision)
{
    struct rc_layout l = layout_of(shape, boundary, precision);

    return l.cx * l.packed * (precision == RC_SINGLE ? sizeof(float) : sizeof(double));
}

size_t
rc_fft_memory(const struct rc_shape *shape, enum rc_boundary boundary, enum rc_precision precision)
{
    struct rc_layout l = layout_of(shape, boundary, precision);

    return l.ny * l.stride * 2 * (precision == RC_SINGLE ? sizeof(float) : sizeof(double)) +
           rc_spectrum_memory(shape, boundary, precision);
}

struct rc_fft *
rc_fft_new(const struct rc_shape *s, enum rc_boundary boundary, enum rc_precision precision,
           size_t threads, struct rc_err *err)
{
    struct rc_fft *f;

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
        f->ops = precision == RC_SINGLE ? &rc_fft_single : &rc_fft_double;
        f->plan = f->ops->new (&f->layout);
    }
    if (f == NULL || f->plan == NULL) {
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
    free(f);
}

/* ---- spectra ---- */

struct rc_spectrum *
rc_spectrum_new(const struct rc_fft *f, struct rc_err *err)
{
    const struct rc_layout *l = &f->layout;
    struct rc_spectrum *k = calloc(1, sizeof *k);

    if (k != NULL) {
        k->ops = f->ops;
        k->packed = rc_alloc(l->cx * l->packed, f->ops->real_size);
    }
    if (k == NULL || k->packed == NULL) {
        rc_err_set(err, "out of memory for a kernel's spectrum of %zu x %zu numbers", l->cx,
                   l->packed);
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
    free(k->packed);
    free(k);
}

enum {
    ROWS = 8,   /* of a kernel's table evaluated together                                    */
    COLUMNS = 8 /* taken out of it together: a cache line                                    */
};

void
rc_fft_quarter(const struct rc_fft *f, size_t *nx, size_t *ny)
{
    *nx = f->layout.cx;
    *ny = f->layout.packed;
}

void
rc_spectrum_begin(struct rc_spectrum *k, unsigned parity)
{
    k->parity = parity;
}

void
rc_spectrum_column(struct rc_spectrum *k, const struct rc_fft *f, size_t c, const double *s)
{
    const struct rc_layout *l = &f->layout;

    f->ops->pack(l, c, 1 / ((double)l->px * (double)l->py), k->parity & RC_ODD_Y ? -1 : 1, s,
                 k->packed);
}

static void
finish_column(const struct rc_fft *f, struct rc_spectrum *k, size_t c, const double *s)
{
    rc_spectrum_column(k, f, c, s);
}

/* The kernel's values at the nodes of a quarter period, row by row, each transformed in x. */
static void
table_rows(const struct rc_fft *f, const struct rc_kernel *kernel, size_t component,
           const struct rc_medium *medium, const struct rc_dct *transform, double *table)
{
    const struct rc_layout *l = &f->layout;
    const struct rc_lattice nodes = {f->shape.dx, f->shape.dy, 1, 1};

#pragma omp parallel for num_threads(l->threads) schedule(dynamic)
    for (size_t first = 0; first < l->packed; first += ROWS) {
        size_t last = first + ROWS < l->packed ? first + ROWS : l->packed;
        double *rows = table + first * l->cx;

        kernel->rows(medium, component, &nodes, l->cx, first, last, rows);
        for (size_t j = first; j < last; j++)
            rc_dct_run(transform, table + j * l->cx);
    }
}

/* Columns of that table, each transformed in y. `space` holds COLUMNS columns for each thread. */
static void
table_columns(const struct rc_fft *f, struct rc_spectrum *k, const struct rc_dct *transform,
              const double *table, double *space)
{
    const struct rc_layout *l = &f->layout;

#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t first = 0; first < l->cx; first += COLUMNS) {
        double *s = space + (size_t)omp_get_thread_num() * COLUMNS * l->packed;
        size_t n = l->cx - first < COLUMNS ? l->cx - first : COLUMNS;

        for (size_t j = 0; j < l->packed; j++)
            for (size_t b = 0; b < n; b++)
                s[b * l->packed + j] = table[j * l->cx + first + b];
        for (size_t b = 0; b < n; b++) {
            rc_dct_run(transform, s + b * l->packed);
            finish_column(f, k, first + b, s + b * l->packed);
        }
    }
}

static enum rc_status
transform_values(const struct rc_fft *f, struct rc_spectrum *k, const struct rc_kernel *kernel,
                 size_t component, const struct rc_medium *medium, struct rc_err *err)
{
    const struct rc_layout *l = &f->layout;
    size_t threads = (size_t)l->threads;
    struct rc_dct *along_x = rc_dct_new(l->cx, k->parity & RC_ODD_X, threads, err);
    struct rc_dct *along_y = rc_dct_new(l->packed, k->parity & RC_ODD_Y, threads, err);
    size_t n = l->cx * l->packed;
    double *own = NULL, *table = f->ops->borrow(f->plan, n * sizeof *table);
    double *space = malloc((size_t)l->threads * COLUMNS * l->packed * sizeof *space);
    enum rc_status status = RC_FAIL;

    if (table == NULL)
        table = own = rc_alloc(n, sizeof *own);
    if (table == NULL || space == NULL) {
        rc_err_set(err, "out of memory for a kernel of %zu x %zu values", l->cx, l->packed);
    } else if (along_x != NULL && along_y != NULL) {
        table_rows(f, kernel, component, medium, along_x, table);
        table_columns(f, k, along_y, table, space);
        status = RC_OK;
    }
    rc_dct_free(along_x);
    rc_dct_free(along_y);
    free(own);
    free(space);
    return status;
}

static enum rc_status
sample_symbol(const struct rc_fft *f, struct rc_spectrum *k, const struct rc_kernel *kernel,
              size_t component, const struct rc_medium *medium, struct rc_err *err)
{
    const struct rc_layout *l = &f->layout;
    const double turn = 2 * 3.14159265358979323846;
    double *space;

    if (kernel->symbol == NULL)
        return rc_err_set(err, "the kernel '%s' has no periodic form", kernel->info.name);
    space = malloc((size_t)l->threads * l->packed * sizeof *space);
    if (space == NULL)
        return rc_err_set(err, "out of memory for a symbol of %zu x %zu values", l->cx, l->packed);
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t i = 0; i < l->cx; i++) {
        double *s = space + (size_t)omp_get_thread_num() * l->packed;
        double qx = turn * (double)i / ((double)l->nx * f->shape.dx);

        for (size_t j = 0; j < l->packed; j++) {
            double qy = turn * (double)j / ((double)l->ny * f->shape.dy);
            s[j] = i == 0 && j == 0 ? 0 : kernel->symbol(medium, component, qx, qy);
        }
        finish_column(f, k, i, s);
    }
    free(space);
    return RC_OK;
}

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
    double *v = rc_alloc(l->nx * l->ny, sizeof *v), *column = malloc(l->packed * sizeof *column);
    double complex *s = rc_alloc(rc_fourier_size(&f->shape), sizeof *s);
    enum rc_status status = RC_FAIL;

    if (v == NULL || s == NULL || column == NULL) {
        rc_err_set(err, "out of memory for a kernel of %zu x %zu values", l->nx, l->ny);
        goto done;
    }
    wrapped_values(f, kernel, component, medium, v);
    status = rc_fourier_forward(&f->shape, v, s, err);
    for (size_t i = 0; i < l->cx && status == RC_OK; i++) {
        for (size_t j = 0; j < l->packed; j++)
            column[j] = creal(s[j * l->cx + i]);
        finish_column(f, k, i, column);
    }
done:
    free(v);
    free(s);
    free(column);
    return status;
}

enum rc_status
rc_spectrum_set_values(struct rc_spectrum *k, const struct rc_fft *f,
                       const struct rc_kernel *kernel, size_t component,
                       const struct rc_medium *medium, struct rc_err *err)
{
    k->parity = kernel->parity[component];
    if (f->boundary == RC_FREE)
        return transform_values(f, k, kernel, component, medium, err);
    return transform_wrapped(f, k, kernel, component, medium, err);
}

enum rc_status
rc_spectrum_set(struct rc_spectrum *k, const struct rc_fft *f, const struct rc_kernel *kernel,
                size_t component, const struct rc_medium *medium, struct rc_err *err)
{
    k->parity = kernel->parity[component];
    return (f->boundary == RC_FREE ? transform_values : sample_symbol)(f, k, kernel, component,
                                                                       medium, err);
}

void
rc_spectrum_set_reciprocal(struct rc_spectrum *k, const struct rc_fft *f,
                           const struct rc_spectrum *of)
{
    const struct rc_layout *l = &f->layout;
    double size = (double)l->px * (double)l->py; /* both are stored divided by it */
    size_t n = l->cx * l->packed;

    k->parity = of->parity;
    if (f->ops->real_size == sizeof(float)) {
        const float *s = of->packed;
        float *to = k->packed;
#pragma omp parallel for num_threads(l->threads) schedule(static)
        for (size_t q = 0; q < n; q++)
            to[q] = s[q] == 0 ? 0 : (float)(1 / (size * size * (double)s[q]));
    } else {
        const double *s = of->packed;
        double *to = k->packed;
#pragma omp parallel for num_threads(l->threads) schedule(static)
        for (size_t q = 0; q < n; q++)
            to[q] = s[q] == 0 ? 0 : 1 / (size * size * s[q]);
    }
}

/* ---- use ---- */

void
rc_fft_apply(struct rc_fft *f, const struct rc_spectrum *k, const double *p, double *u)
{
    f->ops->apply(f->plan, k->packed, k->parity, p, u);
}

void
rc_fft_chain(struct rc_fft *f, size_t n, const struct rc_spectrum *const *kernels,
             rc_row *const *rows, void *ctx)
{
    struct rc_link links[RC_CHAIN];

    assert(n <= RC_CHAIN);
    for (size_t k = 0; k < n; k++)
        links[k] = (struct rc_link){rows[k], kernels[k]->packed, kernels[k]->parity};
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
    f->ops->field(f->plan, k->packed, k->parity, NULL, 0, 0, u);
}

void
rc_fft_field_pair(struct rc_fft *f, const struct rc_spectrum *k, double weight,
                  const struct rc_spectrum *also, double *u)
{
    f->ops->field(f->plan, k->packed, k->parity, also->packed, also->parity, weight, u);
}
