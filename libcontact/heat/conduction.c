/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Temperatures of maps of heat flux by Fourier transforms. Free axes are padded; the coefficients are
 * transformed along them by their even and odd parts; a quarter of each part determines the whole. A map that
 * repeats along both axes needs only the symbol.
 */
#include <stdlib.h>
#include <string.h>

#include "heat.h"
#include "libcontact/memory.h"

/* ---- plan ---- */

void
rc_conduction_free(struct rc_conduction *c)
{
    if (c == NULL)
        return;
    if (c->framed != c->fft)
        rc_fft_free(c->framed); /* it uses the memory of c->fft */
    rc_fft_free(c->fft);
    rc_store_free(&c->own);
    free(c);
}

struct rc_conduction *
rc_conduction_new(const struct rc_shape *shape, struct rc_boundary boundary,
                  const struct rc_ranks *ranks, size_t threads, struct rc_err *err)
{
    const struct rc_pair pair = {.estar = 1};
    const struct rc_operator_options options = {.boundary = boundary, .pair = &pair};
    RC_OWN(rc_conduction, c) = calloc(1, sizeof *c);
    struct rc_shape own;
    size_t all;

    if (rc_ranks_need(ranks, c != NULL, err, "out of memory for a plan") != RC_OK)
        return NULL;
    c->shape = *shape;
    c->rows = rc_rows_of(ranks, shape);
    c->boundary = rc_boundary_on(shape, boundary);
    own = rc_rows_shape(&c->rows, shape);
    c->threads = rc_useful_threads(&own, threads);
    if ((c->fft = rc_fft_new(ranks, NULL, shape, boundary, RC_DOUBLE, threads, err)) == NULL)
        return NULL;
    c->framed = c->fft;
    if (rc_has_mean(boundary)) {
        c->frame = rc_operator_frame(shape, &options);
        c->above = c->rows.n > 0 && c->rows.first == 0 ? c->frame.y : 0;
        c->below = c->rows.n > 0 && c->rows.first + c->rows.n == shape->ny ? c->frame.y : 0;
        c->framed = rc_fft_new_framed(ranks, c->fft, shape, c->boundary, &c->frame, RC_DOUBLE,
                                      threads, err);
        if (c->framed == NULL)
            return NULL;
    }
    rc_fft_waves(c->fft, &all, &c->cy);
    rc_fft_columns(c->fft, &c->first, &c->columns);
    c->length = rc_fft_length(c->fft);
    c->waves = rc_store_take(&c->own, 2 * c->columns * c->length, sizeof *c->waves);
    if (rc_ranks_need(ranks, rc_fft_fold(c->fft, &c->own, &c->wave, &c->mirror), err,
                      "out of memory for the heat of %zu x %zu nodes", shape->nx,
                      shape->ny) != RC_OK)
        return NULL;
    return rc_give(&c);
}

/* ---- the spectrum of a body ---- */

static void
sample(struct rc_warming *w, const struct rc_conduction *c, const struct rc_heated *body)
{
    const struct rc_heat_waves waves = rc_heat_waves_of(body);
    const size_t nx = c->shape.nx, ny = c->shape.ny;

#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t i = 0; i < c->columns; i++)
        for (size_t j = 0; j < c->cy; j++) {
            double part[RC_HEAT_PARTS];
            rc_heat_symbol_parts(&waves, rc_fft_qx(c->fft, c->first + i), rc_fft_qy(c->fft, j),
                                 part);
            /* a wave of two nodes is 0 at all nodes in a direction in which the part is odd */
            for (unsigned k = 0; k < RC_HEAT_PARTS; k++)
                if (w->part[k] != NULL)
                    w->part[k][i * c->cy + j] =
                        (2 * (c->first + i) == nx && k & RC_ODD_X) || (2 * j == ny && k & RC_ODD_Y)
                            ? 0
                            : part[k];
        }
}

/* The columns of a spectrum that are held here, from `first` on. */
struct kept {
    size_t first;
    double *to;
};

static void
keep_column(void *ctx, size_t i, size_t n, double *column)
{
    const struct kept *kept = ctx;

    rc_keep_column(kept->to, i - kept->first, n, column);
}

static enum rc_status
transform(struct rc_warming *w, const struct rc_conduction *c, const struct rc_heated *body,
          struct rc_err *err)
{
    struct rc_shape offsets = {.dx = c->shape.dx, .dy = c->shape.dy};
    RC_OWN(rc_heat_cells, cells) = NULL;
    RC_OWN(rc_spectrum, passing) = NULL;

    rc_fft_quarter(c->fft, &offsets.nx, &offsets.ny);
    offsets.nx = c->boundary.x ? c->shape.nx : offsets.nx;
    offsets.ny = c->boundary.y ? c->shape.ny : offsets.ny;
    cells = rc_heat_cells_new(&offsets, c->boundary, body, err);
    if (rc_ranks_agree(c->rows.ranks, cells != NULL ? RC_OK : RC_FAIL, err) != RC_OK ||
        (passing = rc_spectrum_new(c->fft, err)) == NULL)
        return RC_FAIL;
    for (unsigned k = 0; k < RC_HEAT_PARTS; k++) {
        const struct rc_heat_part part = {cells, k};
        const struct rc_kernel kernel = rc_heat_kernel(&part);
        struct kept kept = {c->first, w->part[k]};
        if (w->part[k] != NULL && rc_spectrum_set_by(passing, c->fft, &kernel, c->boundary,
                                                     keep_column, &kept, err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

enum rc_status
rc_warming_new(struct rc_warming *w, struct rc_store *own, const struct rc_conduction *c,
               const struct rc_heated *body, struct rc_err *err)
{
    *w = (struct rc_warming){{NULL}};
    for (unsigned k = 0; k < RC_HEAT_PARTS; k++)
        if (!(k & RC_ODD_X && body->px == 0) && !(k & RC_ODD_Y && body->py == 0))
            w->part[k] = rc_store_zeros(own, c->columns * c->cy, sizeof(double));
    return rc_ranks_need(c->rows.ranks, !own->failed, err,
                         "out of memory for the heat of %zu x %zu nodes", c->shape.nx, c->shape.ny);
}

enum rc_status
rc_warming_set(struct rc_warming *w, struct rc_store *own, struct rc_conduction *c,
               const struct rc_heated *body, struct rc_err *err)
{
    if (rc_warming_new(w, own, c, body, err) != RC_OK)
        return RC_FAIL;
    if (rc_has_mean(c->boundary))
        return transform(w, c, body, err);
    sample(w, c, body);
    return RC_OK;
}

/* ---- use ---- */

struct pass {
    struct rc_conduction *c;
    const double *from;
    double *to;
    float *framed; /* the source and the result of an inverse */
    size_t n;
    const struct rc_warming *const *warming;
    const struct rc_heating *heating;
};

static bool
row_in(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const size_t nx = p->c->shape.nx;

    memcpy(row, p->from + j * nx, nx * sizeof(double));
    return rc_any(p->from + j * nx, nx);
}

static bool
row_out(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const size_t nx = p->c->shape.nx;

    memcpy(p->to + j * nx, row, nx * sizeof(double));
    return true;
}

/* The real, then the imaginary parts of the spectrum of all bodies; a part with one odd direction has the
 * factor -i, one with two has -1. */
RC_CLONES static void
add_spectra(const struct pass *p, size_t i, double *to)
{
    const struct rc_conduction *c = p->c;
    const size_t n = c->length;

    memset(to, 0, 2 * n * sizeof *to);
    for (size_t b = 0; b < p->n; b++)
        for (unsigned k = 0; k < RC_HEAT_PARTS; k++) {
            const bool odd = k == RC_ODD_X || k == RC_ODD_Y;
            const double sign = k == 0 ? 1 : -1, *part = p->warming[b]->part[k];
            double *out = odd ? to + n : to;
            if (part == NULL)
                continue;
            part += i * c->cy;
            for (size_t t = 0; t < n; t++)
                out[t] += sign * (k & RC_ODD_Y ? (double)c->mirror[t] : 1) * part[c->wave[t]];
        }
}

RC_CLONES static void
multiply(size_t n, const double *x, double *to)
{
    for (size_t t = 0; t < n; t++) {
        const double re = to[t], im = to[n + t];
        to[t] = re * x[t] - im * x[n + t];
        to[n + t] = re * x[n + t] + im * x[t];
    }
}

/* to = x/to */
RC_CLONES static void
divide(size_t n, const double *x, double *to)
{
    for (size_t t = 0; t < n; t++) {
        const double re = to[t], im = to[n + t], size = re * re + im * im;
        const double over = size > 0 ? 1 / size : 0;
        to[t] = over * (re * x[t] + im * x[n + t]);
        to[n + t] = over * (re * x[n + t] - im * x[t]);
    }
}

static void
field_column(void *ctx, size_t i, void *column)
{
    const struct pass *p = ctx;
    const size_t n = p->c->length;

    add_spectra(p, i, column);
    (p->framed != NULL ? divide : multiply)(n, p->c->waves + 2 * i * n, column);
}

void
rc_conduction_load(struct rc_conduction *c, const double *q)
{
    struct pass pass = {.c = c, .from = q};

    rc_fft_forward(c->fft, row_in, &pass, c->waves, NULL);
    c->count += 0.5;
}

void
rc_conduction_field(struct rc_conduction *c, size_t n, const struct rc_warming *const *w,
                    double *out)
{
    struct pass pass = {.c = c, .to = out, .n = n, .warming = w};

    rc_fft_back(c->fft, NULL, field_column, row_out, &pass);
    c->count += 0.5;
}

size_t
rc_conduction_size(const struct rc_conduction *c)
{
    return 2 * c->columns * c->length;
}

void
rc_conduction_keep(const struct rc_conduction *c, double *waves)
{
    memcpy(waves, c->waves, rc_conduction_size(c) * sizeof *waves);
}

/* Adds part k of a spectrum times x. */
RC_CLONES static void
add_product(const struct rc_conduction *c, unsigned k, double times, const double *part,
            const double *x, double *to)
{
    const bool odd = k == RC_ODD_X || k == RC_ODD_Y;
    const double sign = k == 0 ? times : -times;
    const size_t n = c->length, re = odd ? n : 0, im = odd ? 0 : n;

    for (size_t t = 0; t < n; t++) {
        const double v = sign * (k & RC_ODD_Y ? (double)c->mirror[t] : 1) * part[c->wave[t]];
        to[re + t] += v * x[t];
        to[im + t] += odd ? -v * x[n + t] : v * x[n + t];
    }
}

static void
sum_column(void *ctx, size_t i, void *column)
{
    const struct pass *p = ctx;
    const struct rc_conduction *c = p->c;
    const size_t n = c->length;

    memset(column, 0, 2 * n * sizeof(double));
    for (size_t m = 0; m < p->n; m++)
        for (unsigned k = 0; k < RC_HEAT_PARTS; k++) {
            const struct rc_heating *h = &p->heating[m];
            if (h->body->part[k] != NULL)
                add_product(c, k, h->times, h->body->part[k] + i * c->cy, h->waves + 2 * i * n,
                            column);
        }
}

void
rc_conduction_sum(struct rc_conduction *c, size_t n, const struct rc_heating *heating, double *out)
{
    struct pass pass = {.c = c, .to = out, .n = n, .heating = heating};

    rc_fft_back(c->fft, NULL, sum_column, row_out, &pass);
    c->count += 0.5;
}

void
rc_warming_add(const struct rc_conduction *c, struct rc_warming *to, double times,
               const struct rc_warming *w)
{
    for (unsigned k = 0; k < RC_HEAT_PARTS; k++)
        for (size_t i = 0; i < c->columns * c->cy && w->part[k] != NULL; i++)
            to->part[k][i] += times * w->part[k][i];
}

static bool
framed_row_in(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const size_t nx = p->c->shape.nx + 2 * p->c->frame.x;
    double *to = row;

    for (size_t i = 0; i < nx; i++)
        to[i] = (double)p->framed[j * nx + i];
    return rc_any(to, nx);
}

static bool
framed_row_out(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const size_t nx = p->c->shape.nx + 2 * p->c->frame.x;
    const double *from = row;

    for (size_t i = 0; i < nx; i++)
        p->framed[j * nx + i] = (float)from[i];
    return true;
}

void
rc_conduction_inverse(struct rc_conduction *c, const struct rc_warming *const w[2], float *v)
{
    struct pass pass = {.c = c, .framed = v, .n = 2, .warming = w};

    rc_fft_forward(c->framed, framed_row_in, &pass, c->waves, NULL);
    rc_fft_back(c->framed, NULL, field_column, framed_row_out, &pass);
    c->count += 1;
}
