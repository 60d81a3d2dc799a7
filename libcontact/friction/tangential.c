/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The tangential operator by Fourier transforms. A quarter of the spectrum of each kernel is stored.
 */
#include "tangential.h"

#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

/* ---- the spectra ---- */

static void
sample(const struct rc_tangential *t, const struct rc_kernel *kernel, double *to)
{
    size_t nx = t->shape.nx, ny = t->shape.ny;

#pragma omp parallel for num_threads(t->threads) schedule(static)
    for (size_t c = 0; c < t->columns.n; c++)
        for (size_t j = 0; j < t->cy; j++) {
            const size_t i = t->columns.first + c;
            /* a wave of two nodes is 0 at all nodes in a direction in which the kernel is odd */
            bool none = (i == 0 && j == 0) || (2 * i == nx && kernel->parity & RC_ODD_X) ||
                        (2 * j == ny && kernel->parity & RC_ODD_Y);
            to[c * t->cy + j] =
                none ? 0 : kernel->symbol(kernel->of, rc_fft_qx(t->fft, i), rc_fft_qy(t->fft, j));
        }
}

/* Where a column of a spectrum goes. */
struct keep {
    const struct rc_tangential *t;
    double *to;
};

static void
keep_column(void *ctx, size_t i, size_t n, double *column)
{
    const struct keep *k = ctx;

    rc_keep_column(k->to, i - k->t->columns.first, n, column);
}

/* The waves along x and along y, for all ranks. */
static void
set_axes(struct rc_tangential *t, size_t columns)
{
    const double *x = t->quarter[RC_SHEAR_XX], *y = t->quarter[RC_SHEAR_YY];

    for (size_t c = 0; c < t->columns.n; c++)
        t->axis[0][t->columns.first + c] = (x[c * t->cy] + y[c * t->cy]) / 2;
    for (size_t j = 0; j < t->cy && t->columns.n > 0 && t->columns.first == 0; j++)
        t->axis[1][j] = (x[j] + y[j]) / 2;
    rc_ranks_each_sum(t->rows.ranks, columns, t->axis[0]); /* the others have zeros */
    rc_ranks_each_sum(t->rows.ranks, t->cy, t->axis[1]);
}

static enum rc_status
set_spectra(struct rc_tangential *t, struct rc_err *err)
{
    RC_OWN(rc_spectrum, passing) = NULL;

    if (rc_has_mean(t->boundary) && (passing = rc_spectrum_new(t->fft, err)) == NULL)
        return RC_FAIL;
    for (int k = 0; k < RC_SHEAR_KERNELS; k++) {
        const struct rc_shear_field field = {&t->shear, (enum rc_shear_which)k};
        const struct rc_kernel kernel = rc_shear_kernel(&field);
        struct keep keep = {t, t->quarter[k]};

        if (t->quarter[k] == NULL)
            continue;
        if (passing == NULL)
            sample(t, &kernel, t->quarter[k]);
        else if (rc_spectrum_set_by(passing, t->fft, &kernel, t->boundary, keep_column, &keep,
                                    err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

/* The displacement due to a long wave. For a free boundary it is the displacement of the middle of the map
 * under a uniform traction. For a periodic map it is the displacement of the longest wave. If one axis
 * repeats, it is the larger of that wave and of the middle of a strip. */
static double
norm_of(const struct rc_tangential *t)
{
    double a = t->shape.dx * (double)t->shape.nx, b = t->shape.dy * (double)t->shape.ny;
    double most = (1 + fmax(t->shear.kap, 0)) / (RC_PI * t->shear.estar);

    if (!rc_has_mean(t->boundary))
        return fmax(a, b) * most;
    if (rc_repeats(t->boundary) == 1) {
        double w = t->boundary.x ? b : a, period = t->boundary.x ? a : b;
        return most * fmax(period, 2 * w * (fabs(log(2 * t->boundary.datum / w)) + 1));
    }
    return 2 * (a * asinh(b / a) + b * asinh(a / b)) * most;
}

/* The factor along a free axis, x or y, interpolated between two waves. NAN: the grid has no wave that long
 * or that short. */
static double
along(const struct rc_tangential *t, bool x, double q)
{
    size_t nodes[2], n, wave[2];
    double at;
    const double *value;

    rc_fft_period(&t->shape, t->boundary, &nodes[0], &nodes[1]);
    n = nodes[x ? 0 : 1];
    at = q * (x ? t->shape.dx : t->shape.dy) * (double)n / (2 * RC_PI);
    if (!rc_has_mean(t->boundary) || at < 1 || at > (double)(n / 2))
        return NAN;
    wave[0] = (size_t)at;
    wave[1] = (size_t)ceil(at);
    value = t->axis[x ? 0 : 1];
    return value[wave[0]] + (at - floor(at)) * (value[wave[1]] - value[wave[0]]);
}

/* The mean of two values; if one is NAN, the other. */
static double
mean_of(double x, double y)
{
    return isnan(x) ? y : isnan(y) ? x : (x + y) / 2;
}

double
rc_tangential_wave(const struct rc_tangential *t, double q)
{
    double mean = mean_of(along(t, true, q), along(t, false, q));

    return isnan(mean) ? (2 + t->shear.kap) / (q * t->shear.estar) : mean;
}

double
rc_tangential_power(const struct rc_tangential *t, double q)
{
    double last = RC_PI / fmin(t->shape.dx, t->shape.dy), power = NAN;

    for (; rc_has_mean(t->boundary) && q <= last && isnan(power); q *= 2)
        power = mean_of(log2(along(t, true, q) / along(t, true, 2 * q)),
                        log2(along(t, false, q) / along(t, false, 2 * q)));
    return isnan(power) ? 1 : power;
}

/* The first column of each rank, where this rank has those from `own` on. */
static void
gather_first(const struct rc_tangential *t, size_t own, size_t all, size_t *first)
{
    rc_ranks_gather(t->rows.ranks, sizeof own, &own, first);
    first[rc_ranks_count(t->rows.ranks)] = all;
}

/* The columns of a kernel that this rank multiplies in single precision. */
static void
move_columns(const struct rc_tangential *t, size_t all, enum rc_shear_which kernel, size_t *first,
             double *to)
{
    size_t *single = first + rc_ranks_count(t->rows.ranks) + 1;

    gather_first(t, t->columns.first, all, first);
    gather_first(t, t->single_columns.first, all, single);
    rc_ranks_move(t->rows.ranks, t->cy * sizeof *to, first, single, 0, t->quarter[kernel], to);
}

/* The inverse of (XX -XY; -XY YY), wave by wave; 0 for the mean. The caller chooses units for single
 * precision. */
static enum rc_status
set_inverse(struct rc_tangential *t, size_t all, struct rc_err *err)
{
    const size_t n = t->single_columns.n * t->cy, ranks = rc_ranks_count(t->rows.ranks);
    const bool moves = t->rows.ranks != NULL;
    RC_OWNED double *moved = moves ? rc_alloc(3 * n, sizeof *moved) : NULL;
    RC_OWNED size_t *first = moves ? rc_alloc(2 * (ranks + 1), sizeof *first) : NULL;
    const double *of[3];

    if (rc_ranks_need(t->rows.ranks, !moves || (moved != NULL && first != NULL), err,
                      "out of memory for the shear of %zu x %zu nodes", t->shape.nx,
                      t->shape.ny) != RC_OK)
        return RC_FAIL;
    for (int k = 0; k < 3; k++) {
        of[k] = moves ? moved + (size_t)k * n : t->quarter[k];
        if (moves)
            move_columns(t, all, (enum rc_shear_which)k, first, moved + (size_t)k * n);
    }
    for (size_t i = 0; i < n; i++) {
        double a = of[RC_SHEAR_XX][i], c = of[RC_SHEAR_YY][i];
        double b = of[RC_SHEAR_XY][i], determinant = a * c - b * b;
        double over = determinant > 0 ? 1 / determinant : 0;
        t->single[RC_SHEAR_XX][i] = (float)(c * over);
        t->single[RC_SHEAR_YY][i] = (float)(a * over);
        t->single[RC_SHEAR_XY][i] = (float)(-b * over);
    }
    return RC_OK;
}

/* ---- plan ---- */

void
rc_tangential_free(struct rc_tangential *t)
{
    if (t == NULL)
        return;
    rc_fft_free(t->framed); /* it uses the memory of t->fft */
    rc_fft_free(t->fft);
    rc_store_free(&t->own);
    free(t);
}

static bool
allocate(struct rc_tangential *t, size_t columns)
{
    const size_t n = t->columns.n * t->cy, single = t->single_columns.n * t->cy;
    size_t waves;

    t->length = rc_fft_length(t->fft);
    for (int k = 0; k < RC_SHEAR_KERNELS; k++)
        if (k < RC_SHEAR_XZ || t->shear.beta != 0)
            t->quarter[k] = rc_store_take(&t->own, n, sizeof(double));
    for (int k = 0; k < 3; k++)
        t->single[k] = rc_store_take(&t->own, single, sizeof(float));
    t->axis[0] = rc_store_zeros(&t->own, columns, sizeof(double));
    t->axis[1] = rc_store_zeros(&t->own, t->cy, sizeof(double));
    waves = t->columns.n * sizeof(double);
    if (t->single_columns.n * sizeof(float) > waves)
        waves = t->single_columns.n * sizeof(float);
    for (int k = 0; k < 2; k++)
        t->waves[k] = rc_store_take(&t->own, 2 * waves * t->length, 1);
    return rc_fft_fold(t->fft, &t->own, &t->wave, &t->mirror);
}

struct rc_frame
rc_tangential_frame(const struct rc_shape *shape, struct rc_boundary boundary)
{
    const struct rc_pair pair = {.estar = 1};

    return rc_operator_frame(shape,
                             &(struct rc_operator_options){.boundary = boundary, .pair = &pair});
}

struct rc_tangential *
rc_tangential_new(const struct rc_ranks *ranks, const struct rc_shape *shape,
                  struct rc_boundary boundary, const struct rc_shear *shear, size_t threads,
                  struct rc_err *err)
{
    RC_OWN(rc_tangential, t) = calloc(1, sizeof *t);
    size_t columns;

    if (rc_ranks_need(ranks, t != NULL, err, "out of memory for a plan") != RC_OK)
        return NULL;
    t->shape = *shape;
    t->rows = rc_rows_of(ranks, shape);
    t->boundary = rc_boundary_on(shape, boundary);
    t->shear = *shear;
    t->threads = rc_useful_threads(shape, threads);
    t->fft = rc_fft_new(ranks, NULL, shape, t->boundary, RC_DOUBLE, threads, err);
    if (t->fft == NULL)
        return NULL;
    t->frame = rc_tangential_frame(shape, boundary);
    t->above = t->rows.n > 0 && t->rows.first == 0 ? t->frame.y : 0;
    t->below = t->rows.n > 0 && t->rows.first + t->rows.n == shape->ny ? t->frame.y : 0;
    t->framed = rc_has_mean(boundary)
                    ? rc_fft_new_framed(ranks, t->fft, shape, t->boundary, &t->frame, RC_SINGLE,
                                        threads, err)
                    : rc_fft_new(ranks, t->fft, shape, boundary, RC_SINGLE, threads, err);
    if (t->framed == NULL)
        return NULL;
    rc_fft_waves(t->fft, &columns, &t->cy);
    rc_fft_columns(t->fft, &t->columns.first, &t->columns.n);
    rc_fft_columns(t->framed, &t->single_columns.first, &t->single_columns.n);
    if (rc_ranks_need(ranks, allocate(t, columns), err,
                      "out of memory for the shear of %zu x %zu nodes", shape->nx,
                      shape->ny) != RC_OK ||
        set_spectra(t, err) != RC_OK)
        return NULL;
    set_axes(t, columns);
    if (set_inverse(t, columns, err) != RC_OK)
        return NULL;
    t->norm = norm_of(t);
    return rc_give(&t);
}

/* ---- rows ---- */

struct pass {
    struct rc_tangential *t;
    bool single;
    const void *from;
    void *to;
    int which; /* index of the map, 0 or 1 */
};

static size_t
size_of(bool single)
{
    return single ? sizeof(float) : sizeof(double);
}

static size_t
nodes_of_row(const struct pass *p)
{
    return p->t->shape.nx + (p->single ? 2 * p->t->frame.x : 0);
}

static bool
row_in(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    size_t bytes = nodes_of_row(p) * size_of(p->single);
    const char *from = (const char *)p->from + j * bytes;

    memcpy(row, from, bytes);
    for (size_t i = 0; i < bytes; i++)
        if (from[i] != 0) /* -0 does not count as 0 */
            return true;
    return false;
}

static bool
row_out(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    size_t bytes = nodes_of_row(p) * size_of(p->single);

    memcpy((char *)p->to + j * bytes, row, bytes);
    return true;
}

/* ---- waves ---- */

/* Column i of a map. */
static const void *
column_of(const struct pass *p, int which, size_t i)
{
    return (const char *)p->t->waves[which] + 2 * i * p->t->length * size_of(p->single);
}

/* Column i of the quarter of a kernel. */
static const double *
quarter_of(const struct pass *p, enum rc_shear_which kernel, size_t i)
{
    return p->t->quarter[kernel] + i * p->t->cy;
}

/* Computes the real, then the imaginary parts of a x - b y for the requested map x. b is a kernel that is odd
 * in both directions, so its transform is (-i)^2 b. */
RC_CLONES static void
multiply(const struct rc_tangential *t, const double *a, const double *b, const double *x,
         const double *y, double *to)
{
    size_t n = t->length;

    for (size_t k = 0; k < n; k++) {
        double straight = a[t->wave[k]], cross = -(double)t->mirror[k] * b[t->wave[k]];
        to[k] = straight * x[k] + cross * y[k];
        to[n + k] = straight * x[n + k] + cross * y[n + k];
    }
}

RC_CLONES static void
multiply_single(const struct rc_tangential *t, const float *a, const float *b, const float *x,
                const float *y, float *to)
{
    size_t n = t->length;

    for (size_t k = 0; k < n; k++) {
        float straight = a[t->wave[k]], cross = -(float)t->mirror[k] * b[t->wave[k]];
        to[k] = straight * x[k] + cross * y[k];
        to[n + k] = straight * x[n + k] + cross * y[n + k];
    }
}

static void
apply_column(void *ctx, size_t i, void *to)
{
    const struct pass *p = ctx;

    multiply(p->t, quarter_of(p, p->which == 0 ? RC_SHEAR_XX : RC_SHEAR_YY, i),
             quarter_of(p, RC_SHEAR_XY, i), column_of(p, p->which, i),
             column_of(p, 1 - p->which, i), to);
}

static void
inverse_column(void *ctx, size_t i, void *to)
{
    const struct pass *p = ctx;
    size_t at = i * p->t->cy;

    multiply_single(p->t, p->t->single[p->which == 0 ? RC_SHEAR_XX : RC_SHEAR_YY] + at,
                    p->t->single[RC_SHEAR_XY] + at, column_of(p, p->which, i),
                    column_of(p, 1 - p->which, i), to);
}

/* -i (a X + b Y): the normal displacement due to both maps. */
static void
normal_column(void *ctx, size_t i, void *column)
{
    const struct pass *p = ctx;
    const struct rc_tangential *t = p->t;
    const double *a = quarter_of(p, RC_SHEAR_XZ, i), *b = quarter_of(p, RC_SHEAR_YZ, i);
    const double *x = column_of(p, 0, i), *y = column_of(p, 1, i);
    double *to = column;
    size_t n = t->length;

    for (size_t k = 0; k < n; k++) {
        double ax = a[t->wave[k]], by = (double)t->mirror[k] * b[t->wave[k]];
        to[k] = ax * x[n + k] + by * y[n + k];
        to[n + k] = -ax * x[k] - by * y[k];
    }
}

/* i a P: the tangential displacement due to a pressure. The signs are those of tractions and the normal
 * displacement. */
static void
pressure_column(void *ctx, size_t i, void *column)
{
    const struct pass *p = ctx;
    const struct rc_tangential *t = p->t;
    const double *a = quarter_of(p, p->which == 0 ? RC_SHEAR_XZ : RC_SHEAR_YZ, i);
    const double *x = column_of(p, 0, i);
    double *to = column;
    size_t n = t->length;

    for (size_t k = 0; k < n; k++) {
        double s = a[t->wave[k]] * (p->which == 0 ? 1 : (double)t->mirror[k]);
        to[k] = -s * x[n + k];
        to[n + k] = s * x[k];
    }
}

static void
forward(struct rc_tangential *t, bool single, const void *map, int which)
{
    struct pass pass = {.t = t, .single = single, .from = map};

    rc_fft_forward(single ? t->framed : t->fft, row_in, &pass, t->waves[which], NULL);
    t->convolutions += single ? 0.25 : 0.5;
}

static void
back(struct rc_tangential *t, bool single, rc_wave_column *column, void *map, int which)
{
    struct pass pass = {.t = t, .single = single, .to = map, .which = which};

    rc_fft_back(single ? t->framed : t->fft, NULL, column, row_out, &pass);
    t->convolutions += single ? 0.25 : 0.5;
}

/* ---- the interface ---- */

void
rc_tangential_apply(struct rc_tangential *t, double *const q[2], double *const u[2])
{
    for (int k = 0; k < 2; k++)
        forward(t, false, q[k], k);
    for (int k = 0; k < 2; k++)
        back(t, false, apply_column, u[k], k);
}

void
rc_tangential_inverse(struct rc_tangential *t, float *const u[2], float *const q[2])
{
    for (int k = 0; k < 2; k++)
        forward(t, true, u[k], k);
    for (int k = 0; k < 2; k++)
        back(t, true, inverse_column, q[k], k);
}

void
rc_tangential_normal(struct rc_tangential *t, double *const q[2], double *uz)
{
    for (int k = 0; k < 2; k++)
        forward(t, false, q[k], k);
    back(t, false, normal_column, uz, 0);
}

void
rc_tangential_pressure(struct rc_tangential *t, const double *p, double *const u[2])
{
    forward(t, false, p, 0);
    for (int k = 0; k < 2; k++)
        back(t, false, pressure_column, u[k], k);
}
