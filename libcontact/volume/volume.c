/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The sweeps over a stack of slabs: storage and order of the transforms. One map at a time is transformed
 * into waves, which are stored for each slab. At the depths between groups of RC_SWEEP_SLABS slabs the
 * passing waves are stored. Those at depths within a group are computed again on the way down.
 *
 * Storage per node, in numbers: 5 a slab, which the stresses of the slab replace, 3 a group, and 1 for the
 * map in transform. Slices need another 3 a group (downward waves besides the upward ones) and 6 for the
 * slice. Waves between the stored depths are computed for each slice.
 */
#include "volume.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "lines.h"
#include "sweep.h"

/* Numbers of waves and maps. */
struct layout {
    size_t px, py; /* nodes of the period: those of the map, or more */
    size_t slabs, groups;
    size_t length, first, columns; /* waves of a column; columns held here             */
    size_t map;                    /* numbers of a map, as waves or as rows            */
    size_t real;                   /* bytes of a number */
};

/* Strain and waves. */
struct maps {
    void *strain; /* 5 maps a slab: strain, then stress               */
    void *zz;     /* whole maps: one for each slab of a group */
    void *waves;  /* 3 maps a group: the waves at its top */
    void *down;   /* slices: 3 maps a group: the downward waves there */
    void *slice;  /* slices: 6 maps                                   */
};

struct rc_slabs {
    struct rc_store own;         /* the arrays below */
    struct rc_shape shape, here; /* the whole map; the rows held here */
    struct layout layout;
    double *thickness;
    double modulus, nu; /* 2 mu */
    bool whole;
    struct rc_boundary boundary;
    const struct rc_ranks *ranks;
    struct rc_fft *fft;
    const struct rc_sweep_ops *ops;
    double *qy, *alive; /* numbers of the waves of a column */
    struct maps maps;
    struct rc_lines *lines; /* where exactly one axis repeats */
    bool *strained;         /* slabs with strain, from the last rc_slabs_up */
    bool *passes;           /* groups: whether there are waves at its top       */
    double *rows;           /* single: RC_COMPONENTS rows for each thread       */
    double mean;            /* mean of the pressure, Pa */
    struct rc_slabs_counts counts;
};

/* ---- plan ---- */

static size_t
groups_of(size_t slabs)
{
    return (slabs + RC_SWEEP_SLABS - 1) / RC_SWEEP_SLABS;
}

static size_t
real_size(enum rc_precision precision)
{
    return precision == RC_SINGLE ? rc_sweep_single.real_size : rc_sweep_double.real_size;
}

static enum rc_status
check(const struct rc_shape *shape, const struct rc_slabs_options *o, struct rc_err *err)
{
    if (rc_shape_check(shape, err) != RC_OK)
        return RC_FAIL;
    if ((!o->boundary.x && shape->nx == 1) || (!o->boundary.y && shape->ny == 1))
        return rc_err_set(err,
                          "a profile on a free map is not supported: take the periodic boundary");
    if (o->ranks != NULL && rc_repeats(o->boundary) == 1)
        return rc_err_set(err, "plastic strain on a map that repeats along one axis only cannot be "
                               "shared among processes: take one process");
    if (o->slabs == 0)
        return rc_err_set(err, "0 slabs: a volume needs at least one");
    if (!(o->shear > 0) || isinf(o->shear))
        return rc_err_set(err, "shear modulus %g Pa: it must be positive and finite", o->shear);
    if (!(o->nu > -1 && o->nu <= 0.5))
        return rc_err_set(err, "Poisson's ratio %g: it must be above -1 and at most 0.5", o->nu);
    for (size_t k = 0; k < o->slabs; k++)
        if (!(o->thickness[k] > 0) || isinf(o->thickness[k]))
            return rc_err_set(err, "slab %zu is %g m thick: it must be positive and finite", k + 1,
                              o->thickness[k]);
    return RC_OK;
}

/* The number of values of a map: as waves of so many columns, or as rows if that is larger. */
static size_t
map_size(const struct rc_shape *shape, size_t length, size_t columns, size_t rows)
{
    size_t waves = 2 * length * columns, nodes = shape->nx * rows;

    waves = waves > nodes ? waves : nodes;
    return (waves + 15) / 16 * 16; /* whole cache lines */
}

static void
set_waves(struct rc_slabs *v)
{
    rc_fft_period(&v->shape, v->boundary, &v->layout.px, &v->layout.py);
    v->layout.length = rc_fft_length(v->fft);
    rc_fft_columns(v->fft, &v->layout.first, &v->layout.columns);
    v->layout.map = map_size(&v->shape, v->layout.length, v->layout.columns, v->here.ny);
    for (size_t t = 0; t < v->layout.length && v->qy != NULL && v->alive != NULL; t++) {
        size_t j = rc_fft_wave(v->fft, t);
        v->qy[t] = rc_fft_qy(v->fft, j);
        v->alive[t] = 2 * j != v->layout.py;
    }
}

static enum rc_status
allocate(struct rc_slabs *v, const struct rc_slabs_options *o, struct rc_err *err)
{
    const size_t size = v->layout.real;

    v->thickness = rc_store_take(&v->own, v->layout.slabs, sizeof *v->thickness);
    v->strained = rc_store_take(&v->own, v->layout.slabs, sizeof *v->strained);
    v->passes = rc_store_take(&v->own, v->layout.groups, sizeof *v->passes);
    v->qy = rc_store_take(&v->own, rc_fft_length(v->fft), sizeof *v->qy);
    v->alive = rc_store_take(&v->own, rc_fft_length(v->fft), sizeof *v->alive);
    set_waves(v);
    v->maps.strain =
        rc_store_take(&v->own, RC_SWEEP_STRAINS * v->layout.slabs, v->layout.map * size);
    v->maps.waves = rc_store_take(&v->own, RC_SWEEP_WAVES * v->layout.groups, v->layout.map * size);
    if (o->whole)
        v->maps.zz = rc_store_take(&v->own, RC_SWEEP_SLABS, v->layout.map * size);
    if (o->slices) {
        v->maps.down =
            rc_store_take(&v->own, RC_SWEEP_WAVES * v->layout.groups, v->layout.map * size);
        v->maps.slice = rc_store_take(&v->own, RC_SWEEP_STRAINS + 1, v->layout.map * size);
    }
    if (o->precision == RC_SINGLE)
        v->rows = rc_store_take(
            &v->own, (size_t)rc_fft_threads(v->fft) * RC_COMPONENTS * v->shape.nx, sizeof *v->rows);
    if (v->own.failed)
        return rc_err_set(err, "out of memory for %zu slabs of %zu x %zu nodes: take fewer slabs",
                          v->layout.slabs, v->shape.nx, v->shape.ny);
    memset(v->strained, 0, v->layout.slabs * sizeof *v->strained);
    memset(v->passes, 0, v->layout.groups * sizeof *v->passes);
    memcpy(v->thickness, o->thickness, v->layout.slabs * sizeof *v->thickness);
    return RC_OK;
}

struct rc_slabs *
rc_slabs_new(const struct rc_shape *shape, const struct rc_slabs_options *o, struct rc_err *err)
{
    struct rc_rows rows;
    RC_OWN(rc_slabs, v) = NULL;

    if (check(shape, o, err) != RC_OK)
        return NULL;
    v = calloc(1, sizeof *v);
    if (rc_ranks_need(o->ranks, v != NULL, err, "out of memory for a plan") != RC_OK)
        return NULL;
    rows = rc_rows_of(o->ranks, shape);
    *v = (struct rc_slabs){.shape = *shape,
                           .here = rc_rows_shape(&rows, shape),
                           .layout = {.slabs = o->slabs,
                                      .groups = groups_of(o->slabs),
                                      .real = real_size(o->precision)},
                           .modulus = 2 * o->shear,
                           .nu = o->nu,
                           .whole = o->whole,
                           .boundary = o->boundary,
                           .ranks = o->ranks,
                           .ops = o->precision == RC_SINGLE ? &rc_sweep_single : &rc_sweep_double};
    v->fft = rc_fft_new(o->ranks, NULL, shape, o->boundary, o->precision, o->threads, err);
    if (v->fft == NULL || rc_ranks_agree(o->ranks, allocate(v, o, err), err) != RC_OK)
        return NULL;
    if (rc_repeats(o->boundary) == 1)
        v->lines = rc_lines_new(shape, o, o->boundary.x ? v->layout.py : v->layout.px, err);
    return rc_repeats(o->boundary) == 1 && v->lines == NULL ? NULL : rc_give(&v);
}

void
rc_slabs_free(struct rc_slabs *v)
{
    if (v == NULL)
        return;
    rc_lines_free(v->lines);
    rc_fft_free(v->fft);
    rc_store_free(&v->own);
    free(v);
}

/* ---- layout ---- */

static void *
map_of(const struct layout *layout, void *maps, size_t which)
{
    return (char *)maps + which * layout->map * layout->real;
}

static void *
strain_of(const struct layout *layout, const struct maps *maps, size_t slab, size_t component)
{
    return map_of(layout, maps->strain, slab * RC_SWEEP_STRAINS + component);
}

/* The address of column i of waves, with `arrays` arrays a column. */
static void *
column_of(const struct layout *layout, void *waves, size_t arrays, size_t i)
{
    return waves == NULL ? NULL : (char *)waves + i * arrays * 2 * layout->length * layout->real;
}

/* Waves at the top of a group in column i, of v->waves or v->down; NULL below the last group. */
static void *
waves_in(const struct layout *layout, void *waves, size_t group, size_t i)
{
    if (group == layout->groups)
        return NULL;
    return column_of(layout, map_of(layout, waves, group * RC_SWEEP_WAVES), RC_SWEEP_WAVES, i);
}

static void *
waves_of(const struct layout *layout, const struct maps *maps, size_t group, size_t i)
{
    return waves_in(layout, maps->waves, group, i);
}

/* Column i of those held here. */
static struct rc_sweep_column
sweep_column(const struct rc_slabs *v, size_t i)
{
    bool dead = 2 * (v->layout.first + i) == v->layout.px;

    return (struct rc_sweep_column){.length = v->layout.length,
                                    .qx = rc_fft_qx(v->fft, v->layout.first + i),
                                    .qy = v->qy,
                                    .alive = v->alive,
                                    .dead = dead,
                                    .nu = v->nu};
}

/* The slabs of a group in column i; returns their number. */
static size_t
slabs_of(const struct rc_slabs *v, size_t group, size_t i, const bool *wanted,
         struct rc_sweep_slab slab[RC_SWEEP_SLABS])
{
    size_t first = group * RC_SWEEP_SLABS, n = v->layout.slabs - first;

    n = n < RC_SWEEP_SLABS ? n : RC_SWEEP_SLABS;
    for (size_t k = 0; k < n; k++) {
        slab[k] = (struct rc_sweep_slab){.thickness = v->thickness[first + k],
                                         .strained = v->strained[first + k],
                                         .wanted = wanted == NULL || wanted[first + k]};
        for (size_t c = 0; c < RC_SWEEP_STRAINS; c++)
            slab[k].strain[c] =
                column_of(&v->layout, strain_of(&v->layout, &v->maps, first + k, c), 1, i);
        if (v->maps.zz != NULL)
            slab[k].zz = column_of(&v->layout, map_of(&v->layout, v->maps.zz, k), 1, i);
    }
    return n;
}

/* ---- rows ---- */

/* The map in transform, and its slab. */
struct pass {
    struct rc_slabs *volume;
    const struct rc_slab_strain *strain;
    const struct rc_slab_stress *stress;
    const struct rc_slice_stress *slice;
    size_t slab, component; /* component: of kept_components */
    const double *p;
    double *u;
};

static const enum rc_component kept_components[RC_SWEEP_STRAINS + 1] = {RC_SXX, RC_SYY, RC_SXY,
                                                                        RC_SXZ, RC_SYZ, RC_SZZ};

static bool
single(const struct rc_slabs *v)
{
    return v->rows != NULL;
}

/* Scratch of this thread for a row of a component. */
static double *
row_of(double *rows, size_t nx, enum rc_component c)
{
    return rows + ((size_t)omp_get_thread_num() * RC_COMPONENTS + c) * nx;
}

RC_CLONES static void
to_single(const double *restrict from, size_t n, float *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] = (float)from[i];
}

RC_CLONES static void
to_double(const float *restrict from, size_t n, double *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] = from[i];
}

static bool
strain_row(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const struct rc_slabs *v = p->volume;
    enum rc_component c = kept_components[p->component];
    double *to = single(v) ? row_of(v->rows, v->shape.nx, c) : row;

    if (!p->strain->row(p->strain->ctx, p->slab, c, j, to))
        return false;
    if (single(v))
        to_single(to, v->shape.nx, row);
    return true;
}

static bool
pressure_row(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    size_t nx = p->volume->shape.nx;
    const double *from = p->p + j * nx;

    if (!rc_any(from, nx))
        return false;
    if (single(p->volume))
        to_single(from, nx, row);
    else
        memcpy(row, from, nx * sizeof *from);
    return true;
}

static bool
displacement_row(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    size_t nx = p->volume->shape.nx;

    if (single(p->volume))
        to_double(row, nx, p->u + j * nx);
    else
        memcpy(p->u + j * nx, row, nx * sizeof *p->u);
    if (p->volume->lines != NULL)
        rc_lines_add_u(p->volume->lines, j, p->u + j * nx);
    return true;
}

/* Where the stresses of a slab are stored, as waves and then as rows. */
static void *
stress_of(const struct layout *layout, const struct maps *maps, size_t slab, size_t component)
{
    return component < RC_SWEEP_STRAINS ? strain_of(layout, maps, slab, component)
                                        : map_of(layout, maps->zz, slab % RC_SWEEP_SLABS);
}

static bool
keep_row(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const struct rc_slabs *v = p->volume;
    size_t bytes = v->shape.nx * v->layout.real;

    rc_copy_past((char *)stress_of(&v->layout, &v->maps, p->slab, p->component) + j * bytes, row,
                 bytes);
    return true;
}

/* Passes the row of the last component on, with the stored rows of the others. */
static bool
stress_row(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const struct rc_slabs *v = p->volume;
    size_t nx = v->shape.nx, bytes = nx * v->layout.real;
    double *s[RC_COMPONENTS] = {NULL};

    for (size_t k = 0; k <= p->component; k++) {
        enum rc_component c = kept_components[k];
        void *at = k == p->component
                       ? row
                       : (char *)stress_of(&v->layout, &v->maps, p->slab, k) + j * bytes;
        s[c] = single(v) ? row_of(v->rows, v->shape.nx, c) : at;
        if (single(v))
            to_double(at, nx, s[c]);
        if (v->lines != NULL)
            rc_lines_add_stress(v->lines, p->slab, c, j, s[c]);
    }
    p->stress->row(p->stress->ctx, p->slab, j, s);
    return true;
}

/* ---- up ---- */

static void
sweep_up(struct rc_slabs *v, size_t group)
{
    bool below = group + 1 < v->layout.groups && v->passes[group + 1];

#pragma omp parallel for num_threads(rc_fft_threads(v->fft)) schedule(static)
    for (size_t i = 0; i < v->layout.columns; i++) {
        struct rc_sweep_column column = sweep_column(v, i);
        struct rc_sweep_slab slab[RC_SWEEP_SLABS];
        size_t n = slabs_of(v, group, i, NULL, slab);
        v->ops->through(&column, n, slab, false,
                        below ? waves_of(&v->layout, &v->maps, group + 1, i) : NULL,
                        waves_of(&v->layout, &v->maps, group, i));
    }
}

static void
surface_column(void *ctx, size_t i, void *to)
{
    const struct pass *p = ctx;
    struct rc_sweep_column column = sweep_column(p->volume, i);

    p->volume->ops->surface(&column, waves_of(&p->volume->layout, &p->volume->maps, 0, i), to);
}

void
rc_slabs_up(struct rc_slabs *v, const struct rc_slab_strain *strain, double *u)
{
    struct pass pass = {.volume = v, .strain = strain, .u = u};
    bool any = false;

    for (size_t group = v->layout.groups; group-- > 0;) {
        size_t end = (group + 1) * RC_SWEEP_SLABS < v->layout.slabs ? (group + 1) * RC_SWEEP_SLABS
                                                                    : v->layout.slabs;
        for (size_t k = group * RC_SWEEP_SLABS; k < end; k++) {
            v->strained[k] = strain->strained == NULL || strain->strained[k];
            any = any || v->strained[k];
            pass.slab = k;
            for (size_t c = 0; c < RC_SWEEP_STRAINS && v->strained[k]; c++) {
                pass.component = c;
                rc_fft_forward(v->fft, strain_row, &pass, strain_of(&v->layout, &v->maps, k, c),
                               NULL);
                v->counts.forward++;
            }
        }
        v->passes[group] = any;
        if (any)
            sweep_up(v, group);
    }
    if (v->lines != NULL)
        rc_lines_up(v->lines, strain, u != NULL);
    if (u == NULL)
        return;
    if (any) {
        rc_fft_back(v->fft, NULL, surface_column, displacement_row, &pass);
        v->counts.back++;
    } else
        memset(u, 0, v->here.nx * v->here.ny * sizeof *u);
}

/* ---- down ---- */

static void
reflect_column(void *ctx, size_t i, void *p)
{
    struct rc_slabs *v = ((const struct pass *)ctx)->volume;
    struct rc_sweep_column column = sweep_column(v, i);

    if (v->layout.first + i == 0 && p != NULL)
        v->mean = single(v) ? *(const float *)p : *(const double *)p;
    v->ops->reflect(&column, v->passes[0], p, 1 / v->modulus, waves_of(&v->layout, &v->maps, 0, i));
}

/* The stress due to a mean pressure, in every slab. On a map that repeats along one axis it is that of lines
 * along this axis. */
static void
add_mean(const struct rc_shape *shape, struct rc_boundary boundary, double nu, double mean,
         struct rc_sweep_slab *slab)
{
    const double along = -2 * nu * mean;
    const bool lines = rc_repeats(boundary) == 1, along_x = lines ? boundary.x : shape->nx == 1,
               along_y = lines ? boundary.y : shape->ny == 1;

    slab->szz = slab->sxx = slab->syy = -mean;
    if (along_x == along_y)
        slab->sxx = slab->syy = (along - mean) / 2;
    else if (along_x)
        slab->sxx = along;
    else
        slab->syy = along;
}

static void
sweep_down(struct rc_slabs *v, size_t group, const bool *wanted)
{
    bool below = group + 1 < v->layout.groups && v->passes[group + 1];

#pragma omp parallel for num_threads(rc_fft_threads(v->fft)) schedule(static)
    for (size_t i = 0; i < v->layout.columns; i++) {
        struct rc_sweep_column column = sweep_column(v, i);
        struct rc_sweep_slab slab[RC_SWEEP_SLABS];
        size_t n = slabs_of(v, group, i, wanted, slab);
        for (size_t k = 0; k < n && v->layout.first + i == 0; k++)
            add_mean(&v->shape, v->boundary, v->nu, v->mean, &slab[k]);
        v->ops->down(&column, n, slab, v->modulus, waves_of(&v->layout, &v->maps, group, i), below,
                     waves_of(&v->layout, &v->maps, group + 1, i));
    }
}

void
rc_slabs_down(struct rc_slabs *v, const double *p, const struct rc_slab_stress *stress)
{
    struct pass pass = {.volume = v, .stress = stress, .p = p};
    size_t end = 0, last = v->whole ? RC_SWEEP_STRAINS : RC_SWEEP_STRAINS - 1;

    for (size_t k = 0; k < v->layout.slabs; k++)
        if (stress->wanted == NULL || stress->wanted[k])
            end = k + 1;
    if (v->lines != NULL)
        rc_lines_down(v->lines, p, stress);
    v->mean = 0;
    if (p != NULL) {
        rc_fft_forward(v->fft, pressure_row, &pass, NULL, reflect_column);
        v->counts.forward++;
    } else {
#pragma omp parallel for num_threads(rc_fft_threads(v->fft)) schedule(static)
        for (size_t i = 0; i < v->layout.columns; i++)
            reflect_column(&pass, i, NULL);
    }
    for (size_t k = 0; k < end; k++) {
        if (k % RC_SWEEP_SLABS == 0)
            sweep_down(v, k / RC_SWEEP_SLABS, stress->wanted);
        if (stress->wanted != NULL && !stress->wanted[k])
            continue;
        pass.slab = k;
        for (size_t c = 0; c <= last; c++) {
            pass.component = c;
            rc_fft_back(v->fft, stress_of(&v->layout, &v->maps, k, c), NULL,
                        c < last ? keep_row : stress_row, &pass);
            v->counts.back++;
        }
    }
    memset(v->strained, 0, v->layout.slabs * sizeof *v->strained);
    memset(v->passes, 0, v->layout.groups * sizeof *v->passes);
}

/* ---- slices ---- */

void
rc_slabs_through(struct rc_slabs *v)
{
    if (v->lines != NULL)
        rc_lines_through(v->lines);
#pragma omp parallel for num_threads(rc_fft_threads(v->fft)) schedule(static)
    for (size_t i = 0; i < v->layout.columns; i++) {
        struct rc_sweep_column column = sweep_column(v, i);
        struct rc_sweep_slab slab[RC_SWEEP_SLABS];
        void *top = waves_in(&v->layout, v->maps.down, 0, i);
        memcpy(top, waves_of(&v->layout, &v->maps, 0, i),
               RC_SWEEP_WAVES * 2 * v->layout.length * v->layout.real);
        v->ops->reflect(&column, v->passes[0], NULL, 0, top);
        for (size_t group = 0; group + 1 < v->layout.groups; group++) {
            size_t n = slabs_of(v, group, i, NULL, slab);
            v->ops->through(&column, n, slab, true, waves_in(&v->layout, v->maps.down, group, i),
                            waves_in(&v->layout, v->maps.down, group + 1, i));
        }
    }
}

/* Finds a depth and its group. */
static struct rc_sweep_place
place_of(const struct layout *layout, const double *thickness, double depth, size_t *group)
{
    double top = 0;
    size_t k = 0;

    while (k < layout->slabs && depth >= top + thickness[k])
        top += thickness[k++];
    *group = k < layout->slabs ? k / RC_SWEEP_SLABS : layout->groups - 1;
    return (struct rc_sweep_place){.slab = k - *group * RC_SWEEP_SLABS,
                                   .above = depth - top,
                                   .below = k < layout->slabs ? top + thickness[k] - depth : 0};
}

static bool
slice_row(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    enum rc_component c = kept_components[p->component];
    double *to = single(p->volume) ? row_of(p->volume->rows, p->volume->shape.nx, c) : row;

    if (single(p->volume))
        to_double(row, p->volume->shape.nx, to);
    if (p->volume->lines != NULL)
        rc_lines_add_stress(p->volume->lines, 0, c, j, to);
    p->slice->row(p->slice->ctx, c, j, to);
    return true;
}

void
rc_slabs_slice(struct rc_slabs *v, double depth, const struct rc_slice_stress *stress)
{
    size_t group;
    struct rc_sweep_place place = place_of(&v->layout, v->thickness, depth, &group);
    struct pass pass = {.volume = v, .slice = stress};
    bool below = group + 1 < v->layout.groups && v->passes[group + 1];

    if (v->lines != NULL)
        rc_lines_slice(v->lines, depth, stress->components);

#pragma omp parallel for num_threads(rc_fft_threads(v->fft)) schedule(static)
    for (size_t i = 0; i < v->layout.columns; i++) {
        struct rc_sweep_column column = sweep_column(v, i);
        struct rc_sweep_slab slab[RC_SWEEP_SLABS];
        size_t n = slabs_of(v, group, i, NULL, slab);
        void *to[RC_SWEEP_STRAINS + 1];
        for (size_t c = 0; c <= RC_SWEEP_STRAINS; c++)
            to[c] = column_of(&v->layout, map_of(&v->layout, v->maps.slice, c), 1, i);
        v->ops->slice(&column, n, slab, v->modulus, &place,
                      waves_in(&v->layout, v->maps.down, group, i),
                      below ? waves_of(&v->layout, &v->maps, group + 1, i) : NULL, to);
    }
    for (size_t c = 0; c <= RC_SWEEP_STRAINS; c++) {
        if (!(stress->components >> kept_components[c] & 1))
            continue;
        pass.component = c;
        rc_fft_back(v->fft, map_of(&v->layout, v->maps.slice, c), NULL, slice_row, &pass);
        v->counts.back++;
    }
}

const struct rc_slabs_counts *
rc_slabs_counted(const struct rc_slabs *v)
{
    return &v->counts;
}
