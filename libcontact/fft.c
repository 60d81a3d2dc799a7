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

#include <math.h>
#include <stdlib.h>

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

/* Smallest multiple of `step` from 2n up without prime factors over 7. */
static size_t
padded(size_t n, size_t step)
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
    const size_t line = precision == RC_SINGLE ? 8 : 4; /* complex numbers in a cache line */
    struct rc_layout l = {.nx = s->nx, .ny = s->ny, .px = s->nx, .py = s->ny};

    if (boundary == RC_FREE) {
        l.px = padded(s->nx, 2);
        l.py = padded(s->ny, 4);
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
        f->layout.threads = useful_threads(s, threads);
        f->ops = precision == RC_SINGLE ? &rc_fft_single : &rc_fft_double;
        f->plan = f->ops->new(&f->layout);
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
        k->packed = calloc(l->cx * l->packed, f->ops->real_size);
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

size_t
rc_packed_place(const struct rc_layout *l, size_t q, double mirror, double *sign)
{
    size_t m = l->m, b = m / 2 + 1, c = b + m;

    *sign = 1;
    if (l->split == 1)
        return q;
    switch (q % 4) {
    case 0:
        return q / 4;
    case 1:
        return b + q / 4;
    case 2:
        return c + q / 4;
    default: /* stands for its mirror image 4 (m - 1 - k) + 1 */
        *sign = mirror;
        return b + m - 1 - q / 4;
    }
}

/* Packs one column s of py/2 + 1 numbers. */
static void
pack(const struct rc_fft *f, struct rc_spectrum *k, size_t column, const double *s)
{
    const struct rc_layout *l = &f->layout;
    double mirror = k->parity & RC_ODD_Y ? -1 : 1, sign;

    for (size_t q = 0; q < l->packed; q++) {
        size_t place = rc_packed_place(l, q, mirror, &sign);
        f->ops->store(k->packed, column * l->packed + place, sign * s[q]);
    }
}

/* Spectrum of the kernel's values on the padded grid, column by column: s has cx columns of
 * py/2 + 1. */
static enum rc_status
transform_values(const struct rc_fft *f, const struct rc_kernel *kernel, size_t component,
                 const struct rc_medium *medium, double *s, struct rc_err *err)
{
    enum {
        ROWS = 8
    };
    const struct rc_layout *l = &f->layout;
    const struct rc_lattice nodes = {f->shape.dx, f->shape.dy, 1, 1};
    size_t cy = l->packed, chunks = (cy + ROWS - 1) / ROWS;
    unsigned parity = kernel->parity[component];
    double *table = malloc(l->cx * cy * sizeof *table);
    enum rc_status status = RC_FAIL;

    if (table == NULL)
        return rc_err_set(err, "out of memory for a kernel of %zu x %zu values", l->cx, cy);
#pragma omp parallel for num_threads(l->threads) schedule(dynamic)
    for (size_t c = 0; c < chunks; c++) {
        size_t first = c * ROWS, last = first + ROWS < cy ? first + ROWS : cy;
        kernel->rows(medium, component, &nodes, l->cx, first, last, table + first * l->cx);
    }
    if (rc_fourier_halves(table, l->cx, cy, parity & RC_ODD_X, l->threads, err) != RC_OK)
        goto done;
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t i = 0; i < l->cx; i++)
        for (size_t j = 0; j < cy; j++)
            s[i * cy + j] = table[j * l->cx + i];
    status = rc_fourier_halves(s, cy, l->cx, parity & RC_ODD_Y, l->threads, err);
done:
    free(table);
    return status;
}

static enum rc_status
sample_symbol(const struct rc_fft *f, const struct rc_kernel *kernel, size_t component,
              const struct rc_medium *medium, double *s, struct rc_err *err)
{
    const struct rc_layout *l = &f->layout;
    const double turn = 2 * 3.14159265358979323846;

    if (kernel->symbol == NULL)
        return rc_err_set(err, "the kernel '%s' has no periodic form", kernel->name);
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t i = 0; i < l->cx; i++)
        for (size_t j = 0; j < l->packed; j++) {
            double qx = turn * (double)i / ((double)l->nx * f->shape.dx);
            double qy = turn * (double)j / ((double)l->ny * f->shape.dy);
            s[i * l->packed + j] =
                i == 0 && j == 0 ? 0 : kernel->symbol(medium, component, qx, qy);
        }
    return RC_OK;
}

static enum rc_status
set(struct rc_spectrum *k, const struct rc_fft *f, const struct rc_kernel *kernel,
    size_t component, const struct rc_medium *medium, bool inverse, struct rc_err *err)
{
    const struct rc_layout *l = &f->layout;
    double scale = 1 / ((double)l->px * (double)l->py);
    double *s = malloc(l->cx * l->packed * sizeof *s);
    enum rc_status status;

    if (s == NULL)
        return rc_err_set(err, "out of memory for a kernel of %zu x %zu values", l->cx, l->packed);
    k->parity = kernel->parity[component];
    status = (f->boundary == RC_FREE ? transform_values : sample_symbol)(f, kernel, component,
                                                                         medium, s, err);
    if (status == RC_OK) {
#pragma omp parallel for num_threads(l->threads) schedule(static)
        for (size_t i = 0; i < l->cx; i++) {
            double *column = s + i * l->packed;
            for (size_t q = 0; q < l->packed; q++)
                column[q] = !inverse ? scale * column[q] : column[q] == 0 ? 0 : scale / column[q];
            pack(f, k, i, column);
        }
    }
    free(s);
    return status;
}

enum rc_status
rc_spectrum_set(struct rc_spectrum *k, const struct rc_fft *f, const struct rc_kernel *kernel,
                size_t component, const struct rc_medium *medium, struct rc_err *err)
{
    return set(k, f, kernel, component, medium, false, err);
}

enum rc_status
rc_spectrum_set_inverse(struct rc_spectrum *k, const struct rc_fft *f,
                        const struct rc_kernel *kernel, size_t component,
                        const struct rc_medium *medium, struct rc_err *err)
{
    return set(k, f, kernel, component, medium, true, err);
}

/* ---- use ---- */

void
rc_fft_apply(struct rc_fft *f, const struct rc_spectrum *k, const double *p, double *u)
{
    f->ops->apply(f->plan, k->packed, k->parity, p, u);
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
    f->ops->field(f->plan, k->packed, k->parity, u);
}
