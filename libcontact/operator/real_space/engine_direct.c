/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The sum u_ij = sum_kl K_(i-k)(j-l) p_kl, N^2 terms without approximation: the reference for other engines.
 *
 * A kernel is even or odd in y, so rows d above and d below a target row share their coefficients. Both rows
 * are added first. Then there remains one product for each (row, d, k, i), summed in registers for a block of
 * rows and a strip of columns at once.
 */
#include "direct.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "simd.h"
#include "libcontact/expected.h"

struct rc_direct {
    size_t nx, ny, width, strips;
    int threads;
    const struct rc_simd *simd;
    /* ny rows at y offsets 0 .. ny-1, each of `width`: x offsets -(nx-1) .. nx-1, padded to whole strips */
    double *k;
    double *scratch; /* memory of each thread: rows of a block, added and interleaved; and the
                        result */
    double mirror;   /* factor for negative y offsets */
};

static size_t
strips(size_t nx)
{
    return (nx + RC_STRIP - 1) / RC_STRIP;
}

static size_t
width(size_t nx)
{
    return nx - 1 + strips(nx) * RC_STRIP;
}

static size_t
scratch(size_t nx)
{
    return RC_BLOCK * (nx + strips(nx) * RC_STRIP + RC_SIMD_WIDTH);
}

void
rc_direct_free(struct rc_direct *d)
{
    if (d == NULL)
        return;
    free(d->k);
    free(d->scratch);
    free(d);
}

struct rc_direct *
rc_direct_new(const struct rc_sum *sum, const struct rc_lattice *at, size_t nx, size_t ny,
              int threads, struct rc_err *err)
{
    RC_OWN(rc_direct, d) = calloc(1, sizeof *d);
    unsigned parity = sum->kernel.parity;

    if (d == NULL || width(nx) > SIZE_MAX / sizeof(double) / ny ||
        (d->k = calloc(width(nx) * ny, sizeof(double))) == NULL ||
        (d->scratch = malloc((size_t)threads * scratch(nx) * sizeof(double))) == NULL)
        return rc_err_null(err, "out of memory for a kernel of %zu x %zu values", width(nx), ny);
    d->nx = nx;
    d->ny = ny;
    d->width = width(nx);
    d->strips = strips(nx);
    d->threads = threads;
    d->simd = rc_simd();
    d->mirror = parity & RC_ODD_Y ? -1 : 1;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (size_t j = 0; j < ny; j++) {
        double *row = d->k + j * d->width + nx - 1;
        sum->kernel.rows(sum->kernel.of, at, nx, j, j + 1, row);
        for (size_t i = 1; i < nx; i++)
            *(row - i) = parity & RC_ODD_X ? -row[i] : row[i];
    }
    return rc_give(&d);
}

/* q[a RC_BLOCK + i] = p[first + i - d][a] + mirror p[first + i + d][a], nothing outside the map.
 * False when all are zero. */
static bool
add_rows(const struct rc_direct *s, const double *p, size_t first, size_t d, double *q)
{
    double any = 0;

    for (size_t i = 0; i < RC_BLOCK; i++) {
        size_t y = first + i;
        const double *above = y < s->ny && y >= d ? p + (y - d) * s->nx : NULL;
        const double *below = d > 0 && y < s->ny && y + d < s->ny ? p + (y + d) * s->nx : NULL;
        for (size_t a = 0; a < s->nx; a++) {
            double value =
                (above != NULL ? above[a] : 0) + (below != NULL ? s->mirror * below[a] : 0);
            q[a * RC_BLOCK + i] = value;
            any = value != 0 ? 1 : any;
        }
    }
    return any != 0;
}

static void
block(const struct rc_direct *s, const double *p, size_t first, double *q, double *u)
{
    size_t wide = s->strips * RC_STRIP, rows = s->ny - first < RC_BLOCK ? s->ny - first : RC_BLOCK;
    double *sum = q + RC_BLOCK * s->nx;

    memset(sum, 0, RC_BLOCK * wide * sizeof *sum);
    for (size_t d = 0; d < s->ny; d++) {
        if (d > first + RC_BLOCK - 1 && first + d >= s->ny)
            break;
        if (!add_rows(s, p, first, d, q))
            continue;
        for (size_t x = 0; x < wide; x += RC_STRIP)
            s->simd->product(s->k + d * s->width + s->nx - 1 + x, q, s->nx, sum + x, wide);
    }
    for (size_t i = 0; i < rows; i++)
        memcpy(u + (first + i) * s->nx, sum + i * wide, s->nx * sizeof *u);
}

void
rc_direct_apply(struct rc_direct *s, const double *p, double *u)
{
#pragma omp parallel for num_threads(s->threads) schedule(dynamic)
    for (size_t first = 0; first < s->ny; first += RC_BLOCK)
        block(s, p, first, s->scratch + (size_t)omp_get_thread_num() * scratch(s->nx), u);
}

/* ---- the row ---- */

/* Starting a thread costs about as much as ten thousand terms. */
static int
useful_threads(const struct rc_sum *sum)
{
    size_t n = sum->shape.nx * sum->shape.ny, most = 1 + n / 8 * n / 100000;
    size_t threads = sum->threads == 0 ? rc_threads_available() : sum->threads;

    return (int)(threads < most ? threads : most);
}

static void *
plan_new(const struct rc_sum *sum, struct rc_err *err)
{
    const struct rc_lattice nodes = {sum->shape.dx, sum->shape.dy, 1, 1};

    if (rc_shape_check(&sum->shape, err) != RC_OK)
        return NULL;
    if (rc_repeats(sum->boundary) > 0) {
        rc_err_set(err, "the direct sum has no end on a periodic boundary: use fft");
        return NULL;
    }
    return rc_direct_new(sum, &nodes, sum->shape.nx, sum->shape.ny, useful_threads(sum), err);
}

static void
plan_apply(void *at, const double *p, double *u)
{
    rc_direct_apply(at, p, u);
}

static void
plan_free(void *at)
{
    rc_direct_free(at);
}

/* Terms of random sign add up as the square root of their number; this covers a thousand nodes a side. */
static double
error(const void *at)
{
    (void)at;
    return 1e-15;
}

static double
seconds(const struct rc_sum *sum)
{
    double n = (double)(sum->shape.nx * sum->shape.ny);

    return RC_SUM_DIRECT * n * n;
}

const struct rc_engine rc_engine_direct = {
    .info = {.name = "direct",
             .summary = "the plain double sum: exact to rounding, time N^2",
             .order = 2,
             .sum_bytes = {16.1},
             .contact_bytes = {98.8}},
    .seconds = seconds,
    .new = plan_new,
    .apply = plan_apply,
    .error = error,
    .free = plan_free,
};
