/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Profiles of means along the axis that repeats, in two stacks of slabs of different periods. Both have zeros
 * beyond the map. The displacement of the longer one is 0 where it is farthest from the map, and the
 * half-space does not move there.
 */
#include "lines.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    NEAR,
    FAR,
    STACKS
};

struct rc_lines {
    struct rc_store own; /* the arrays below */
    bool along_x;        /* the free axis */
    size_t nx, ny, n;    /* sides of the map; nodes along the free axis */
    size_t slabs, period[STACKS];
    int threads;
    struct rc_slabs *stack[STACKS];
    double *mean;    /* of the strain: n numbers for each component of each slab */
    double *p, *row; /* n: mean of the pressure; rows of a map for each thread */
    double *u[STACKS];
    double *stress; /* n numbers for each component of each slab */
    bool *strained;
};

/* A call of one of the stacks. */
struct by {
    struct rc_lines *lines;
    int stack;
};

static size_t
axis_of(const struct rc_shape *shape, struct rc_boundary boundary)
{
    return boundary.x ? shape->ny : shape->nx;
}

size_t
rc_slabs_line_bytes(const struct rc_shape *shape, struct rc_boundary boundary, size_t slabs)
{
    /* measured on 1024 and 2048 nodes; a profile along y has whole complex transforms */
    const size_t slab = boundary.x ? 46 : 23, node = 40;

    return rc_repeats(boundary) != 1
               ? 0
               : 2 * (1 + RC_SLABS_FAR) * axis_of(shape, boundary) * (slab * slabs + node);
}

struct rc_lines *
rc_lines_new(const struct rc_shape *shape, const struct rc_slabs_options *o, size_t period,
             struct rc_err *err)
{
    const size_t n = axis_of(shape, o->boundary);
    RC_OWN(rc_lines, l) = calloc(1, sizeof *l);

    if (l == NULL)
        return rc_err_null(err, "out of memory for a plan");
    l->along_x = o->boundary.y;
    l->nx = shape->nx;
    l->ny = shape->ny;
    l->n = n;
    l->slabs = o->slabs;
    l->threads = rc_useful_threads(shape, o->threads);
    l->mean = rc_store_take(&l->own, l->slabs * RC_COMPONENTS * n, sizeof *l->mean);
    l->stress = rc_store_zeros(&l->own, l->slabs * RC_COMPONENTS * n, sizeof *l->stress);
    l->p = rc_store_take(&l->own, n, sizeof *l->p);
    l->row = rc_store_take(&l->own, (size_t)l->threads * l->nx, sizeof *l->row);
    l->strained = rc_store_take(&l->own, l->slabs, sizeof *l->strained);
    for (int k = 0; k < STACKS; k++) {
        const size_t length = l->period[k] = k == FAR ? RC_SLABS_FAR * period : period;
        const struct rc_shape profile = l->along_x
                                            ? (struct rc_shape){length, 1, shape->dx, shape->dy}
                                            : (struct rc_shape){1, length, shape->dx, shape->dy};
        struct rc_slabs_options options = *o;
        options.boundary = RC_PERIODIC;
        options.threads = 1;
        l->u[k] = rc_store_zeros(&l->own, length, sizeof **l->u);
        if ((l->stack[k] = rc_slabs_new(&profile, &options, err)) == NULL)
            return NULL;
    }
    if (l->own.failed)
        return rc_err_null(err, "out of memory for %zu slabs of %zu nodes: take fewer slabs",
                           l->slabs, n);
    return rc_give(&l);
}

void
rc_lines_free(struct rc_lines *l)
{
    if (l == NULL)
        return;
    for (int k = 0; k < STACKS; k++)
        rc_slabs_free(l->stack[k]);
    rc_store_free(&l->own);
    free(l);
}

/* ---- means ---- */

static double *
line_of(double *lines, size_t n, size_t slab, size_t c)
{
    return lines + (slab * RC_COMPONENTS + c) * n;
}

/* Adds a row of the map to the mean along the axis that repeats. */
static void
add_row(const struct rc_lines *l, const double *row, size_t j, double *mean)
{
    for (size_t i = 0; i < l->nx && l->along_x; i++)
        mean[i] += row[i] / (double)l->ny;
    if (!l->along_x)
        mean[j] = rc_sum(row, l->nx) / (double)l->nx;
}

/* Each thread reads whole maps, so that sums do not depend on the number of threads. */
static void
read_strain(struct rc_lines *l, const struct rc_slab_strain *strain)
{
    memset(l->mean, 0, l->slabs * RC_COMPONENTS * l->n * sizeof *l->mean);
    for (size_t slab = 0; slab < l->slabs; slab++)
        l->strained[slab] = strain->strained == NULL || strain->strained[slab];
#pragma omp parallel for num_threads(l->threads) schedule(dynamic)
    for (size_t k = 0; k < l->slabs * RC_COMPONENTS; k++) {
        const size_t slab = k / RC_COMPONENTS, c = k % RC_COMPONENTS;
        double *row = l->row + (size_t)omp_get_thread_num() * l->nx;
        for (size_t j = 0; j < l->ny && c != RC_SZZ && l->strained[slab]; j++)
            if (strain->row(strain->ctx, slab, (enum rc_component)c, j, row))
                add_row(l, row, j, line_of(l->mean, l->n, slab, c));
    }
}

/* ---- the stacks ---- */

/* Row j of a profile along x, or node j of one along y. */
static bool
write_row(const struct rc_lines *l, size_t period, const double *line, size_t j, double *row)
{
    if (!l->along_x) {
        row[0] = j < l->n ? line[j] : 0;
        return row[0] != 0;
    }
    memcpy(row, line, l->n * sizeof *row);
    memset(row + l->n, 0, (period - l->n) * sizeof *row);
    return true;
}

static bool
strain_row(void *ctx, size_t slab, enum rc_component c, size_t j, double *row)
{
    const struct by *by = ctx;
    const struct rc_lines *l = by->lines;

    return write_row(l, l->period[by->stack], line_of(l->mean, l->n, slab, c), j, row);
}

/* Sets the stress of the longer stack, which comes first, and subtracts that of the other. */
static void
take_row(const struct by *by, size_t slab, size_t c, size_t j, const double *s)
{
    const struct rc_lines *l = by->lines;
    double *to = line_of(l->stress, l->n, slab, c);

    if (!l->along_x && j >= l->n)
        return;
    for (size_t i = 0; i < (l->along_x ? l->n : 1); i++)
        if (by->stack == FAR)
            to[l->along_x ? i : j] = s[i];
        else
            to[l->along_x ? i : j] -= s[i];
}

static void
stress_row(void *ctx, size_t slab, size_t j, double *const s[RC_COMPONENTS])
{
    for (size_t c = 0; c < RC_COMPONENTS; c++)
        if (s[c] != NULL)
            take_row(ctx, slab, c, j, s[c]);
}

static void
slice_row(void *ctx, enum rc_component c, size_t j, const double *row)
{
    take_row(ctx, 0, c, j, row);
}

void
rc_lines_up(struct rc_lines *l, const struct rc_slab_strain *strain, bool u)
{
    read_strain(l, strain);
    for (int k = 0; k < STACKS; k++) {
        struct by by = {l, k};
        const struct rc_slab_strain lines = {l->strained, strain_row, &by};
        rc_slabs_up(l->stack[k], &lines, u ? l->u[k] : NULL);
    }
}

void
rc_lines_down(struct rc_lines *l, const double *p, const struct rc_slab_stress *stress)
{
    double *whole = l->u[FAR]; /* the displacement has been passed on */

    memset(l->p, 0, l->n * sizeof *l->p);
    for (size_t j = 0; j < l->ny && p != NULL; j++)
        add_row(l, p + j * l->nx, j, l->p);
    for (int k = STACKS; k-- > 0;) {
        struct by by = {l, k};
        const struct rc_slab_stress lines = {stress->wanted, stress_row, &by};
        memset(whole, 0, l->period[k] * sizeof *whole);
        memcpy(whole, l->p, l->n * sizeof *whole);
        rc_slabs_down(l->stack[k], p == NULL ? NULL : whole, &lines);
    }
}

void
rc_lines_through(struct rc_lines *l)
{
    for (int k = 0; k < STACKS; k++)
        rc_slabs_through(l->stack[k]);
}

void
rc_lines_slice(struct rc_lines *l, double depth, unsigned components)
{
    for (int k = STACKS; k-- > 0;) {
        struct by by = {l, k};
        const struct rc_slice_stress lines = {components, slice_row, &by};
        rc_slabs_slice(l->stack[k], depth, &lines);
    }
}

/* ---- the difference ---- */

static void
add(const struct rc_lines *l, const double *line, size_t j, double *row)
{
    for (size_t i = 0; i < l->nx; i++)
        row[i] += line[l->along_x ? i : j];
}

void
rc_lines_add_u(const struct rc_lines *l, size_t j, double *row)
{
    const double rest = l->u[FAR][(l->period[FAR] + l->n) / 2];

    if (l->along_x)
        for (size_t i = 0; i < l->nx; i++)
            row[i] += l->u[FAR][i] - l->u[NEAR][i] - rest;
    else
        for (size_t i = 0; i < l->nx; i++)
            row[i] += l->u[FAR][j] - l->u[NEAR][j] - rest;
}

void
rc_lines_add_stress(const struct rc_lines *l, size_t slab, enum rc_component c, size_t j,
                    double *row)
{
    add(l, l->stress + (slab * RC_COMPONENTS + c) * l->n, j, row);
}
