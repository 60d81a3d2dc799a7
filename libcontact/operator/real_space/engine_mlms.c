/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The multi-level sum (mlms.h): N (log 1/tol)^2 operations, and little memory besides the maps.
 */
#include "mlms.h"
#include "libcontact/expected.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

/* ---- sizes ---- */

static size_t
largest(size_t a, size_t b)
{
    return a > b ? a : b;
}

/* n rounded up to whole vectors. */
static size_t
whole_vectors(size_t n)
{
    return (n + RC_SIMD_WIDTH - 1) / RC_SIMD_WIDTH * RC_SIMD_WIDTH;
}

static size_t
tiles(const struct rc_mlms_axis axis[2])
{
    return axis[RC_X].tiles * axis[RC_Y].tiles;
}

/* Rows of a tile on any level, with margins and interpolation. */
static void
set_sizes(struct rc_mlms *m)
{
    const struct rc_mlms_design *d = &m->d;
    size_t t = d->t, plane_rows = 0, rows = 0, row = 0;

    for (size_t q = 0; q < d->levels; q++) {
        const struct rc_mlms_axis *x = &d->axis[q][RC_X], *y = &d->axis[q][RC_Y];
        const struct rc_mlms_axis *next = d->axis[q + 1];
        size_t high = (y->tile + RC_BLOCK - 1) / RC_BLOCK * RC_BLOCK + 2 * y->margin;
        size_t wide = whole_vectors(x->tile + 2 * x->margin);
        size_t coarse = next[RC_X].tile << next[RC_X].halved;
        m->plane_stride = largest(m->plane_stride, wide + RC_SIMD_WIDTH);
        plane_rows = largest(plane_rows, high);
        m->ring_size = largest(m->ring_size, ((x->reach >> x->halved) + 1) *
                                                 (2 * y->margin + RC_BLOCK) * RC_STRIP);
        m->out_lead = largest(m->out_lead, whole_vectors(2 * x->margin + 1));
        m->mid_stride = largest(m->mid_stride, whole_vectors(x->tile));
        rows = largest(rows, (y->tile + RC_BLOCK - 1) / RC_BLOCK * RC_BLOCK);
        row = largest(row, largest(wide << x->halved, 2 * (coarse + 2 * t)));
    }
    /* single sources add up to 2 margins beyond a tile, and up to a vector more at its end */
    m->out_stride = m->mid_stride + 2 * m->out_lead + 2 * RC_SIMD_WIDTH;
    m->plane_size = m->plane_stride * plane_rows;
    /* two of these arrays also hold the even and odd nodes of a row that is reduced */
    m->out_size = m->out_lead + largest(m->out_stride * rows, whole_vectors(row));
    m->mid_size = largest(m->mid_stride * (rows + 2 * t), whole_vectors(row));
    m->zeros_size = whole_vectors(row);
}

/* Doubles of scratch of one thread. */
static size_t
scratch_size(const struct rc_mlms *m)
{
    return 4 * m->plane_size + 4 * m->out_size + m->ring_size + m->mid_size + m->zeros_size +
           2 * m->plane_size + whole_vectors(2 * m->d.t);
}

/* ---- plan ---- */

static void
rc_mlms_free(void *at)
{
    struct rc_mlms *m = at;

    if (m == NULL)
        return;
    rc_direct_free(m->direct);
    rc_store_free(&m->own);
    free(m);
}

RC_OWNER(rc_mlms)

static bool
allocate_scratch(struct rc_mlms *m)
{
    size_t size = scratch_size(m), threads = (size_t)m->d.threads;
    double *at = rc_store_zeros(&m->own, threads * size, sizeof *at);

    m->scratch = rc_store_zeros(&m->own, threads, sizeof *m->scratch);
    if (m->own.failed)
        return false;
    for (size_t k = 0; k < threads; k++) {
        struct rc_mlms_scratch *w = &m->scratch[k];
        for (int c = 0; c < 4; c++, at += m->plane_size)
            w->plane[c] = at;
        for (int c = 0; c < 4; c++, at += m->out_size)
            w->out[c] = at + m->out_lead;
        w->ring = at;
        w->mid = at += m->ring_size;
        w->zeros = at += m->mid_size;
        w->list = (uint32_t *)(void *)(at += m->zeros_size);
        w->near = (const double **)(void *)(at += 2 * m->plane_size);
        w->far = w->near + m->d.t;
        at += whole_vectors(2 * m->d.t);
    }
    return true;
}

static bool
allocate_levels(struct rc_mlms *m, const struct rc_sum *sum)
{
    for (size_t q = 0; q <= m->d.levels; q++) {
        struct rc_mlms_level *l = &m->level[q];
        size_t n = m->d.axis[q][RC_X].n * m->d.axis[q][RC_Y].n;
        l->axis = m->d.axis[q];
        l->loaded = rc_store_zeros(&m->own, tiles(l->axis), 1);
        if (q > 0) {
            l->p = rc_store_zeros(&m->own, n, sizeof *l->p);
            l->u = rc_store_zeros(&m->own, n, sizeof *l->u);
        }
        if (m->own.failed || (q < m->d.levels && !rc_mlms_stencils(m, sum, q)))
            return false;
    }
    return true;
}

static void *
plan_new(const struct rc_sum *sum, struct rc_err *err)
{
    RC_OWN(rc_mlms, m) = calloc(1, sizeof *m);
    struct rc_lattice lattice;
    const struct rc_mlms_axis *last;
    unsigned parity = sum->kernel.parity;

    if (m == NULL)
        return rc_err_null(err, "out of memory for a plan");
    if (!rc_mlms_design(sum, &m->d, err))
        return NULL;
    m->sign[RC_X] = parity & RC_ODD_X ? -1 : 1;
    m->sign[RC_Y] = parity & RC_ODD_Y ? -1 : 1;
    m->simd = rc_simd();
    rc_mlms_weights(m->d.t, m->s);
    set_sizes(m);
    if (!allocate_levels(m, sum) || !allocate_scratch(m))
        return rc_err_null(err, "out of memory for the multi-level sum over %zu x %zu nodes",
                           sum->shape.nx, sum->shape.ny);
    last = m->d.axis[m->d.levels];
    lattice = (struct rc_lattice){sum->shape.dx, sum->shape.dy, last[RC_X].step, last[RC_Y].step};
    m->direct = rc_direct_new(sum, &lattice, last[RC_X].n, last[RC_Y].n,
                              m->d.levels == 0 ? m->d.threads : 1, err);
    return m->direct != NULL ? rc_give(&m) : NULL;
}

/* ---- apply ---- */

static struct rc_mlms_scratch *
scratch(const struct rc_mlms *m)
{
    return &m->scratch[omp_get_thread_num()];
}

/* A single tile does not occupy several threads. */
static int
threads(const struct rc_mlms *m, size_t level)
{
    return tiles(m->level[level].axis) > 1 ? m->d.threads : 1;
}

static void
reduce(struct rc_mlms *m, size_t level, const double *p)
{
    size_t n = tiles(m->level[level + 1].axis);

#pragma omp parallel for num_threads(threads(m, level)) schedule(dynamic)
    for (size_t k = 0; k < n; k++)
        rc_mlms_reduce(m, level, p, k, scratch(m));
}

/* Displacements of a level; in the same pass corrects those of the finer level, whose pressure is `finer`. */
static void
expand(struct rc_mlms *m, size_t level, const double *p, double *u, const double *finer)
{
    size_t n = tiles(m->level[level].axis);

#pragma omp parallel for num_threads(threads(m, level)) schedule(dynamic)
    for (size_t k = 0; k < n; k++) {
        rc_mlms_expand(m, level, p, u, k, scratch(m));
        if (level > 0)
            rc_mlms_correct(m, level - 1, finer, k, scratch(m));
    }
}

static void
apply(void *at, const double *p, double *u)
{
    struct rc_mlms *m = at;
    size_t levels = m->d.levels, n = tiles(m->level[0].axis);

    if (levels == 0) {
        rc_direct_apply(m->direct, p, u);
        return;
    }
#pragma omp parallel for num_threads(threads(m, 0)) schedule(dynamic)
    for (size_t k = 0; k < n; k++)
        rc_mlms_scan(m, 0, p, k);
    for (size_t q = 0; q < levels; q++)
        reduce(m, q, q == 0 ? p : m->level[q].p);
    rc_direct_apply(m->direct, m->level[levels].p, m->level[levels].u);
    n = tiles(m->level[levels].axis);
    for (size_t k = 0; k < n; k++)
        rc_mlms_correct(m, levels - 1, levels == 1 ? p : m->level[levels - 1].p, k, m->scratch);
    for (size_t q = levels; q-- > 0;)
        expand(m, q, q == 0 ? p : m->level[q].p, q == 0 ? u : m->level[q].u,
               q <= 1 ? p : m->level[q - 1].p);
}

static double
error(const void *at)
{
    return ((const struct rc_mlms *)at)->d.error;
}

/* The work of the sum, (log 1/tol)^2, and of the method. */
static double
seconds(const struct rc_sum *sum)
{
    double digits = sum->tol > 0 ? -log10(sum->tol) : 15;

    return RC_SUM_MLMS * (digits + 6) * (double)(sum->shape.nx * sum->shape.ny);
}

const struct rc_engine rc_engine_mlms = {
    .info =
        {.name = "mlms",
         .summary =
             "multi-level multi-summation: to the requested accuracy, time N, with little memory",
         .order = 1,
         .sum_bytes = {7.7},
         .contact_bytes = {90}},
    .seconds = seconds,
    .new = plan_new,
    .apply = apply,
    .error = error,
    .free = rc_mlms_free,
};
