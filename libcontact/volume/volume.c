/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The sweeps over a stack of slabs: storage and order of the transforms. One map at a time is transformed
 * into waves, which are stored for each slab. At the depths between groups of RC_SWEEP_SLABS slabs the
 * passing waves are stored. Those at depths within a group are computed again on the way down.
 *
 * Deep slabs may have fewer nodes, every 2nd, 4th, ... node of the map along each axis, because only long
 * waves reach them. The waves of such a level are the longest waves of the map, with the same coefficients.
 * Where the level changes between two groups, waves that the deeper level has pass, and others end. Upward
 * and downward passes are transposes of each other, so that G stays symmetric. Ranks deal the columns of each
 * level evenly. At a change of the level the columns of the deeper one therefore move to the ranks that have
 * them in the other, and back.
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

enum {
    LEVELS = 16, /* more than any map can have */
    SIDE = 16    /* fewest nodes of a coarser grid along an axis */
};

/* The nodes of a level, 2^level apart in units of the spacing of the map, and their waves. */
struct level {
    struct rc_fft *fft;            /* NULL: no slab has this level */
    size_t nx, rows;               /* nodes of a row; rows held here */
    size_t px, py;                 /* nodes of the period: those of the level, or more */
    size_t length, first, columns; /* waves of a column; columns held here             */
    size_t map;                    /* numbers of a map, as waves or as rows            */
    double *qy, *alive;            /* numbers of the waves of a column                 */
    size_t *deal;                  /* of each rank: its first column; ranks only       */
    size_t *place;                 /* of each wave of a column in one of the map; level 0: NULL */
};

/* Slabs of one level that are swept together. */
struct group {
    size_t first, n, level;
    size_t at; /* place of its waves, in numbers */
    size_t
        *place; /* of the waves of a column, in a column of the group above; NULL: the same level */
};

/* Numbers of waves and maps. */
struct layout {
    size_t slabs, groups;
    size_t real; /* bytes of a number */
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
    struct level level[LEVELS];
    struct group *group;
    size_t *level_of, *at; /* of each slab: level, and place of its strain in numbers */
    const struct rc_sweep_ops *ops;
    struct maps maps;
    char *passing;          /* waves of a column between levels, for each thread */
    void *moved;            /* ranks: columns of a level, dealt as those of a finer one */
    size_t *deal;           /* the first of them on each rank */
    struct rc_lines *lines; /* where exactly one axis repeats */
    bool *strained;         /* slabs with strain, from the last rc_slabs_up */
    bool *passes;           /* groups: whether there are waves at its top       */
    double *rows;           /* single: RC_COMPONENTS rows for each thread       */
    double mean;            /* mean of the pressure, Pa */
    struct rc_slabs_counts counts;
};

/* ---- plan ---- */

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

static struct rc_shape
coarser(const struct rc_shape *shape, size_t level)
{
    const double wide = (double)((size_t)1 << level);

    return (struct rc_shape){shape->nx >> level, shape->ny >> level, wide * shape->dx,
                             wide * shape->dy};
}

/* True if the nodes of a level are nodes of the map, its waves are waves of the map, and a unit of rows that
 * ranks share has whole rows of it. */
static bool
has_level(const struct rc_shape *shape, struct rc_boundary boundary, size_t level)
{
    const struct rc_shape s = coarser(shape, level);
    size_t px, py, qx, qy;

    rc_fft_period(shape, boundary, &px, &py);
    rc_fft_period(&s, boundary, &qx, &qy);
    return s.nx >= SIDE && s.ny >= SIDE && s.nx << level == shape->nx &&
           s.ny << level == shape->ny && qx << level == px && qy << level == py &&
           rc_rows_unit(shape->nx) >> level > 0;
}

/* Sets the level of each slab, and returns the number of groups. */
static size_t
set_levels(const struct rc_shape *shape, const struct rc_slabs_options *o, size_t *level)
{
    const double step = fmax(shape->dx, shape->dy);
    const bool only = o->slices || rc_repeats(o->boundary) == 1;
    size_t groups = 0, in = 0;
    double z = 0;

    for (size_t k = 0; k < o->slabs; k++) {
        const double middle = z + o->thickness[k] / 2;
        z += o->thickness[k];
        level[k] = k > 0 ? level[k - 1] : 0;
        while (!only && level[k] + 1 < LEVELS && has_level(shape, o->boundary, level[k] + 1) &&
               ldexp(step, (int)level[k] + 1) <= o->coarser * middle)
            level[k]++;
        if (k == 0 || level[k] != level[k - 1] || in == RC_SWEEP_SLABS)
            in = 0;
        groups += in++ == 0;
    }
    return groups;
}

double
rc_slabs_by_nodes(const struct rc_shape *shape, const struct rc_slabs_options *o)
{
    RC_OWNED size_t *level = rc_alloc(o->slabs, sizeof *level);
    double sum = 0;

    if (level == NULL)
        return (double)o->slabs;
    (void)set_levels(shape, o, level);
    for (size_t k = 0; k < o->slabs; k++)
        sum += ldexp(1, -2 * (int)level[k]);
    return sum;
}

/* Whether several ranks hold the map. */
static bool
shared(const struct rc_slabs *v)
{
    return rc_ranks_count(v->ranks) > 1;
}

/* The place of each wave of a column in a column of a finer level; SIZE_MAX: it is dead. */
static size_t *
places_in(struct rc_slabs *v, const struct level *l, const struct level *finer)
{
    size_t *place = rc_store_take(&v->own, l->length, sizeof *place),
           *of = rc_store_take(&v->own, finer->length, sizeof *of);

    for (size_t t = 0; t < finer->length && of != NULL; t++)
        of[rc_fft_wave(finer->fft, t)] = t;
    for (size_t t = 0; t < l->length && place != NULL && of != NULL; t++) {
        const size_t j = rc_fft_wave(l->fft, t);
        place[t] = 2 * j == l->py ? SIZE_MAX : of[2 * j < l->py ? j : finer->py - (l->py - j)];
    }
    return place;
}

static enum rc_status
make_level(struct rc_slabs *v, const struct rc_slabs_options *o, size_t which, struct rc_err *err)
{
    const struct rc_shape s = coarser(&v->shape, which);
    struct level *l = &v->level[which];

    l->fft = rc_fft_new_coarser(o->ranks, v->level[0].fft, &s, which, o->boundary, o->precision,
                                o->threads, err);
    if (l->fft == NULL)
        return RC_FAIL;
    rc_fft_period(&s, o->boundary, &l->px, &l->py);
    l->nx = s.nx;
    l->rows = rc_fft_rows(l->fft);
    l->length = rc_fft_length(l->fft);
    rc_fft_columns(l->fft, &l->first, &l->columns);
    l->map = map_size(&s, l->length, l->columns, l->rows);
    l->qy = rc_store_take(&v->own, l->length, sizeof *l->qy);
    l->alive = rc_store_take(&v->own, l->length, sizeof *l->alive);
    for (size_t t = 0; t < l->length && l->qy != NULL && l->alive != NULL; t++) {
        size_t j = rc_fft_wave(l->fft, t);
        l->qy[t] = rc_fft_qy(l->fft, j);
        l->alive[t] = 2 * j != l->py;
    }
    if (which > 0)
        l->place = places_in(v, l, &v->level[0]);
    if (shared(v))
        l->deal = rc_store_take(&v->own, rc_ranks_count(o->ranks) + 1, sizeof *l->deal);
    for (size_t r = 0; l->deal != NULL && r <= rc_ranks_count(o->ranks); r++)
        l->deal[r] = rc_fft_column_of(l->fft, r);
    return RC_OK;
}

/* Sets the groups and the places of their numbers; returns the numbers of all strains and waves. */
static void
set_groups(struct rc_slabs *v, size_t *strains, size_t *waves)
{
    struct group *g = v->group;

    *strains = *waves = 0;
    for (size_t k = 0; k < v->layout.slabs; k++) {
        const struct level *l = &v->level[v->level_of[k]];
        v->at[k] = *strains;
        *strains += RC_SWEEP_STRAINS * l->map;
        if (k > 0 && v->level_of[k] == g->level && g->n < RC_SWEEP_SLABS) {
            g->n++;
            continue;
        }
        g += k > 0;
        *g = (struct group){.first = k, .n = 1, .level = v->level_of[k], .at = *waves};
        if (k > 0 && g->level != (g - 1)->level)
            g->place = places_in(v, l, &v->level[(g - 1)->level]);
        *waves += RC_SWEEP_WAVES * l->map;
    }
}

/* Numbers of the columns of a level whose columns of a finer level are held here. */
static size_t
most_moved(const struct rc_slabs *v)
{
    size_t most = 0;

    for (size_t k = 1; k < LEVELS; k++)
        for (size_t q = 0; q < k && v->level[k].fft != NULL; q++) {
            const struct level *l = &v->level[k], *finer = &v->level[q];
            const size_t n = finer->columns * RC_SWEEP_WAVES * 2 * l->length;
            most = finer->fft != NULL && n > most ? n : most;
        }
    return most;
}

static enum rc_status
allocate(struct rc_slabs *v, const struct rc_slabs_options *o, struct rc_err *err)
{
    const size_t size = v->layout.real, threads = (size_t)rc_fft_threads(v->level[0].fft);
    size_t strains = 0, waves = 0;

    v->thickness = rc_store_take(&v->own, v->layout.slabs, sizeof *v->thickness);
    v->strained = rc_store_take(&v->own, v->layout.slabs, sizeof *v->strained);
    v->passes = rc_store_take(&v->own, v->layout.groups, sizeof *v->passes);
    v->group = rc_store_take(&v->own, v->layout.groups, sizeof *v->group);
    v->at = rc_store_take(&v->own, v->layout.slabs, sizeof *v->at);
    if (v->group != NULL && v->at != NULL)
        set_groups(v, &strains, &waves);
    v->maps.strain = rc_store_take(&v->own, strains, size);
    v->maps.waves = rc_store_take(&v->own, waves, size);
    if (v->level_of[v->layout.slabs - 1] > 0)
        v->passing =
            rc_store_take(&v->own, threads * RC_SWEEP_WAVES * 2 * v->level[0].length, size);
    if (v->passing != NULL && shared(v)) {
        v->moved = rc_store_take(&v->own, most_moved(v), size);
        v->deal = rc_store_take(&v->own, rc_ranks_count(v->ranks) + 1, sizeof *v->deal);
    }
    if (o->whole)
        v->maps.zz = rc_store_take(&v->own, RC_SWEEP_SLABS, v->level[0].map * size);
    if (o->slices) {
        v->maps.down = rc_store_take(&v->own, waves, size);
        v->maps.slice = rc_store_take(&v->own, RC_SWEEP_STRAINS + 1, v->level[0].map * size);
    }
    if (o->precision == RC_SINGLE)
        v->rows = rc_store_take(&v->own, threads * RC_COMPONENTS * v->shape.nx, sizeof *v->rows);
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
    enum rc_status status = RC_OK;
    RC_OWN(rc_slabs, v) = NULL;

    if (check(shape, o, err) != RC_OK)
        return NULL;
    v = calloc(1, sizeof *v);
    if (v != NULL)
        v->level_of = rc_store_take(&v->own, o->slabs, sizeof *v->level_of);
    if (rc_ranks_need(o->ranks, v != NULL && v->level_of != NULL, err,
                      "out of memory for a plan") != RC_OK)
        return NULL;
    rows = rc_rows_of(o->ranks, shape);
    v->shape = *shape;
    v->here = rc_rows_shape(&rows, shape);
    v->layout = (struct layout){.slabs = o->slabs,
                                .groups = set_levels(shape, o, v->level_of),
                                .real = real_size(o->precision)};
    v->modulus = 2 * o->shear;
    v->nu = o->nu;
    v->whole = o->whole;
    v->boundary = o->boundary;
    v->ranks = o->ranks;
    v->ops = o->precision == RC_SINGLE ? &rc_sweep_single : &rc_sweep_double;
    status = make_level(v, o, 0, err);
    for (size_t k = 0; k < o->slabs && status == RC_OK; k++)
        if (v->level[v->level_of[k]].fft == NULL)
            status = make_level(v, o, v->level_of[k], err);
    if (status != RC_OK || rc_ranks_agree(o->ranks, allocate(v, o, err), err) != RC_OK)
        return NULL;
    if (rc_repeats(o->boundary) == 1)
        v->lines = rc_lines_new(shape, o, o->boundary.x ? v->level[0].py : v->level[0].px, err);
    return rc_repeats(o->boundary) == 1 && v->lines == NULL ? NULL : rc_give(&v);
}

size_t
rc_slabs_level(const struct rc_slabs *v, size_t slab)
{
    return v->level_of[slab];
}

void
rc_slabs_free(struct rc_slabs *v)
{
    if (v == NULL)
        return;
    rc_lines_free(v->lines);
    for (size_t k = LEVELS; k-- > 0;) /* the others work in the memory of the first */
        rc_fft_free(v->level[k].fft);
    rc_store_free(&v->own);
    free(v);
}

/* ---- layout ---- */

static const struct level *
level_of(const struct rc_slabs *v, size_t slab)
{
    return &v->level[v->level_of[slab]];
}

/* The address of number `at` of an array in the precision of the sweeps. */
static void *
number_of(const struct rc_slabs *v, void *array, size_t at)
{
    return (char *)array + at * v->layout.real;
}

static void *
strain_of(const struct rc_slabs *v, size_t slab, size_t component)
{
    return number_of(v, v->maps.strain, v->at[slab] + component * level_of(v, slab)->map);
}

/* The address of column i of the waves at the top of a group, of v->maps.waves or down; NULL below the last
 * group. */
static void *
waves_in(const struct rc_slabs *v, void *waves, size_t group, size_t i)
{
    const struct group *g = &v->group[group];

    return group == v->layout.groups
               ? NULL
               : number_of(v, waves, g->at + i * RC_SWEEP_WAVES * 2 * v->level[g->level].length);
}

static void *
waves_of(const struct rc_slabs *v, size_t group, size_t i)
{
    return waves_in(v, v->maps.waves, group, i);
}

/* Column i of those held here. */
static struct rc_sweep_column
sweep_column(const struct rc_slabs *v, const struct level *l, size_t i)
{
    bool dead = 2 * (l->first + i) == l->px;

    return (struct rc_sweep_column){.length = l->length,
                                    .qx = rc_fft_qx(l->fft, l->first + i),
                                    .qy = l->qy,
                                    .alive = l->alive,
                                    .dead = dead,
                                    .nu = v->nu};
}

/* The slabs of a group in column i. */
static void
slabs_of(const struct rc_slabs *v, const struct group *g, size_t i, const bool *wanted,
         struct rc_sweep_slab slab[RC_SWEEP_SLABS])
{
    const size_t first = g->first, at = i * 2 * v->level[g->level].length;

    for (size_t k = 0; k < g->n; k++) {
        slab[k] = (struct rc_sweep_slab){.thickness = v->thickness[first + k],
                                         .strained = v->strained[first + k],
                                         .wanted = wanted == NULL || wanted[first + k]};
        for (size_t c = 0; c < RC_SWEEP_STRAINS; c++)
            slab[k].strain[c] = number_of(v, strain_of(v, first + k, c), at);
        if (v->maps.zz != NULL)
            slab[k].zz = number_of(v, v->maps.zz, k * v->level[0].map + at);
    }
}

/* ---- rows ---- */

/* The map in transform, and its slab. */
struct pass {
    struct rc_slabs *volume;
    const struct rc_slab_strain *strain;
    const struct rc_slab_stress *stress;
    const struct rc_slice_stress *slice;
    const struct group *group; /* of the slab */
    size_t slab, component;    /* component: of kept_components */
    const double *p;
    double *u;
    void *waves;         /* of a map that is refined */
    const size_t *place; /* of each of them in a column of the map */
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
        to_single(to, level_of(v, p->slab)->nx, row);
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
stress_of(const struct rc_slabs *v, const struct group *g, size_t slab, size_t component)
{
    return component < RC_SWEEP_STRAINS
               ? strain_of(v, slab, component)
               : number_of(v, v->maps.zz, (slab - g->first) * v->level[0].map);
}

static bool
keep_row(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const struct rc_slabs *v = p->volume;
    size_t nx = level_of(v, p->slab)->nx;

    rc_copy_past(number_of(v, stress_of(v, p->group, p->slab, p->component), j * nx), row,
                 nx * v->layout.real);
    return true;
}

/* Passes the row of the last component on, with the stored rows of the others. */
static bool
stress_row(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const struct rc_slabs *v = p->volume;
    size_t nx = level_of(v, p->slab)->nx;
    double *s[RC_COMPONENTS] = {NULL};

    for (size_t k = 0; k <= p->component; k++) {
        enum rc_component c = kept_components[k];
        void *at =
            k == p->component ? row : number_of(v, stress_of(v, p->group, p->slab, k), j * nx);
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

/* Memory of this thread for the waves of a column between two levels. */
static void *
passing_of(const struct rc_slabs *v)
{
    return number_of(v, v->passing,
                     (size_t)omp_get_thread_num() * RC_SWEEP_WAVES * 2 * v->level[0].length);
}

/* Copies the waves of a column of a coarser group into a column of the group above it, or `back`. The other
 * waves of the finer column are 0: those that come from it have decayed there. */
static void
copy_waves(const struct rc_slabs *v, const struct group *coarse, bool back, char *of, char *finer)
{
    const size_t length = v->level[coarse->level].length, real = v->layout.real,
                 longer = v->level[(coarse - 1)->level].length;

    if (!back)
        memset(finer, 0, RC_SWEEP_WAVES * 2 * longer * real);
    for (size_t c = 0; c < RC_SWEEP_WAVES * 2; c++)
        for (size_t t = 0; t < length; t++) {
            char *here = of + (c * length + t) * real;
            if (coarse->place[t] == SIZE_MAX)
                memset(here, 0, back ? real : 0);
            else if (back)
                memcpy(here, finer + (c * longer + coarse->place[t]) * real, real);
            else
                memcpy(finer + (c * longer + coarse->place[t]) * real, here, real);
        }
}

/* Moves columns of `numbers` each of a level to the ranks that have these columns in a finer level, into
 * v->moved, or `back`. */
static void
move_columns(struct rc_slabs *v, const struct level *l, const struct level *finer, size_t numbers,
             bool back, void *waves)
{
    const size_t count = rc_ranks_count(v->ranks), bytes = numbers * v->layout.real;

    for (size_t r = 0; r <= count; r++)
        v->deal[r] = finer->deal[r] < l->deal[count] ? finer->deal[r] : l->deal[count];
    if (back)
        rc_ranks_move(v->ranks, bytes, v->deal, l->deal, 0, v->moved, waves);
    else
        rc_ranks_move(v->ranks, bytes, l->deal, v->deal, 0, waves, v->moved);
}

/* Moves the waves at the top of a group whose level differs from that of the group above it. */
static void
move_waves(struct rc_slabs *v, size_t group, bool back)
{
    const struct group *g = &v->group[group];
    const struct level *l = &v->level[g->level];

    if (g->place != NULL && shared(v))
        move_columns(v, l, &v->level[(g - 1)->level], RC_SWEEP_WAVES * 2 * l->length, back,
                     waves_of(v, group, 0));
}

/* The waves at the top of a group in column i of the group above it. */
static void *
waves_below(const struct rc_slabs *v, size_t group, size_t i)
{
    const struct group *g = &v->group[group];

    return g->place != NULL && shared(v)
               ? number_of(v, v->moved, i * RC_SWEEP_WAVES * 2 * v->level[g->level].length)
               : waves_of(v, group, i);
}

enum passage {
    ENDS, /* the group below does not have this column */
    DIES, /* it has it, but waves of two nodes are 0   */
    PASSES
};

/* Whether column i of a group, of those held here, continues in the group below it. */
static enum passage
continues(const struct rc_slabs *v, const struct group *below, size_t i)
{
    const struct level *l = &v->level[below->level];
    const size_t column = v->level[(below - 1)->level].first + i;

    if (below->place == NULL)
        return PASSES;
    return column > l->px / 2 ? ENDS : 2 * column == l->px ? DIES : PASSES;
}

static void
sweep_up(struct rc_slabs *v, size_t group)
{
    const struct group *g = &v->group[group], *next = g + 1;
    const struct level *l = &v->level[g->level];
    const bool below = group + 1 < v->layout.groups && v->passes[group + 1];

    if (below)
        move_waves(v, group + 1, false);
#pragma omp parallel for num_threads(rc_fft_threads(l->fft)) schedule(static)
    for (size_t i = 0; i < l->columns; i++) {
        struct rc_sweep_column column = sweep_column(v, l, i);
        struct rc_sweep_slab slab[RC_SWEEP_SLABS];
        void *from = below && continues(v, next, i) == PASSES ? waves_below(v, group + 1, i) : NULL;
        if (from != NULL && next->place != NULL) {
            copy_waves(v, next, false, from, passing_of(v));
            from = passing_of(v);
        }
        slabs_of(v, g, i, NULL, slab);
        v->ops->through(&column, g->n, slab, false, from, waves_of(v, group, i));
    }
}

static void
surface_column(void *ctx, size_t i, void *to)
{
    const struct rc_slabs *v = ((const struct pass *)ctx)->volume;
    struct rc_sweep_column column = sweep_column(v, &v->level[0], i);

    v->ops->surface(&column, waves_of(v, 0, i), to);
}

void
rc_slabs_up(struct rc_slabs *v, const struct rc_slab_strain *strain, double *u)
{
    struct pass pass = {.volume = v, .strain = strain, .u = u};
    bool any = false;

    for (size_t group = v->layout.groups; group-- > 0;) {
        const struct group *g = &v->group[group];
        for (size_t k = g->first; k < g->first + g->n; k++) {
            v->strained[k] = strain->strained == NULL || strain->strained[k];
            any = any || v->strained[k];
            pass.slab = k;
            for (size_t c = 0; c < RC_SWEEP_STRAINS && v->strained[k]; c++) {
                pass.component = c;
                rc_fft_forward(v->level[g->level].fft, strain_row, &pass, strain_of(v, k, c), NULL);
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
        rc_fft_back(v->level[0].fft, NULL, surface_column, displacement_row, &pass);
        v->counts.back++;
    } else
        memset(u, 0, v->here.nx * v->here.ny * sizeof *u);
}

/* ---- down ---- */

static void
reflect_column(void *ctx, size_t i, void *p)
{
    struct rc_slabs *v = ((const struct pass *)ctx)->volume;
    struct rc_sweep_column column = sweep_column(v, &v->level[0], i);

    if (v->level[0].first + i == 0 && p != NULL)
        v->mean = single(v) ? *(const float *)p : *(const double *)p;
    v->ops->reflect(&column, v->passes[0], p, 1 / v->modulus, waves_of(v, 0, i));
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
    const struct group *g = &v->group[group], *next = g + 1;
    const struct level *l = &v->level[g->level];
    const bool last = group + 1 == v->layout.groups, below = !last && v->passes[group + 1];

    if (below)
        move_waves(v, group + 1, false);
#pragma omp parallel for num_threads(rc_fft_threads(l->fft)) schedule(static)
    for (size_t i = 0; i < l->columns; i++) {
        struct rc_sweep_column column = sweep_column(v, l, i);
        struct rc_sweep_slab slab[RC_SWEEP_SLABS];
        const enum passage passage = last ? ENDS : continues(v, next, i);
        const bool on = passage == PASSES, turns = !last && next->place != NULL;
        void *to = passage != ENDS ? waves_below(v, group + 1, i) : NULL, *through = on ? to : NULL;
        if (on && turns) {
            through = passing_of(v);
            if (below)
                copy_waves(v, next, false, to, through);
        } else if (passage == DIES)
            memset(to, 0, RC_SWEEP_WAVES * 2 * v->level[next->level].length * v->layout.real);
        slabs_of(v, g, i, wanted, slab);
        for (size_t k = 0; k < g->n && l->first + i == 0; k++)
            add_mean(&v->shape, v->boundary, v->nu, v->mean, &slab[k]);
        v->ops->down(&column, g->n, slab, v->modulus, waves_of(v, group, i), below && on, through);
        if (on && turns)
            copy_waves(v, next, true, to, through);
    }
    if (!last)
        move_waves(v, group + 1, true);
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
        rc_fft_forward(v->level[0].fft, pressure_row, &pass, NULL, reflect_column);
        v->counts.forward++;
        rc_ranks_each_sum(v->ranks, 1, &v->mean); /* one rank has it; the others have 0 */
    } else {
#pragma omp parallel for num_threads(rc_fft_threads(v->level[0].fft)) schedule(static)
        for (size_t i = 0; i < v->level[0].columns; i++)
            reflect_column(&pass, i, NULL);
    }
    for (size_t k = 0, group = 0; k < end; k++) {
        if (k == v->group[group].first + v->group[group].n)
            group++;
        if (k == v->group[group].first)
            sweep_down(v, group, stress->wanted);
        if (stress->wanted != NULL && !stress->wanted[k])
            continue;
        pass.slab = k;
        pass.group = &v->group[group];
        for (size_t c = 0; c <= last; c++) {
            pass.component = c;
            rc_fft_back(level_of(v, k)->fft, stress_of(v, pass.group, k, c), NULL,
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
#pragma omp parallel for num_threads(rc_fft_threads(v->level[0].fft)) schedule(static)
    for (size_t i = 0; i < v->level[0].columns; i++) {
        struct rc_sweep_column column = sweep_column(v, &v->level[0], i);
        struct rc_sweep_slab slab[RC_SWEEP_SLABS];
        void *top = waves_in(v, v->maps.down, 0, i);
        memcpy(top, waves_of(v, 0, i), RC_SWEEP_WAVES * 2 * v->level[0].length * v->layout.real);
        v->ops->reflect(&column, v->passes[0], NULL, 0, top);
        for (size_t group = 0; group + 1 < v->layout.groups; group++) {
            slabs_of(v, &v->group[group], i, NULL, slab);
            v->ops->through(&column, v->group[group].n, slab, true,
                            waves_in(v, v->maps.down, group, i),
                            waves_in(v, v->maps.down, group + 1, i));
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
    const struct level *l = &v->level[0];
    size_t group;
    struct rc_sweep_place place = place_of(&v->layout, v->thickness, depth, &group);
    struct pass pass = {.volume = v, .slice = stress};
    bool below = group + 1 < v->layout.groups && v->passes[group + 1];

    if (v->lines != NULL)
        rc_lines_slice(v->lines, depth, stress->components);

#pragma omp parallel for num_threads(rc_fft_threads(l->fft)) schedule(static)
    for (size_t i = 0; i < l->columns; i++) {
        struct rc_sweep_column column = sweep_column(v, l, i);
        struct rc_sweep_slab slab[RC_SWEEP_SLABS];
        void *to[RC_SWEEP_STRAINS + 1];
        slabs_of(v, &v->group[group], i, NULL, slab);
        for (size_t c = 0; c <= RC_SWEEP_STRAINS; c++)
            to[c] = number_of(v, v->maps.slice, c * l->map + i * 2 * l->length);
        v->ops->slice(&column, v->group[group].n, slab, v->modulus, &place,
                      waves_in(v, v->maps.down, group, i), below ? waves_of(v, group + 1, i) : NULL,
                      to);
    }
    for (size_t c = 0; c <= RC_SWEEP_STRAINS; c++) {
        if (!(stress->components >> kept_components[c] & 1))
            continue;
        pass.component = c;
        rc_fft_back(l->fft, number_of(v, v->maps.slice, c * l->map), NULL, slice_row, &pass);
        v->counts.back++;
    }
}

/* ---- between levels ---- */

static bool
node_row(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const struct rc_slabs *v = p->volume;
    const size_t nx = level_of(v, p->slab)->nx;

    if (single(v))
        to_single(p->u + j * nx, nx, row);
    else
        memcpy(row, p->u + j * nx, nx * sizeof *p->u);
    return true;
}

static void
refined_column(void *ctx, size_t i, void *to)
{
    const struct pass *p = ctx;
    const struct rc_slabs *v = p->volume;
    const struct level *l = level_of(v, p->slab), *all = &v->level[0];
    const size_t real = v->layout.real;

    memset(to, 0, 2 * all->length * real);
    for (size_t t = 0; t < l->length && 2 * (all->first + i) < l->px; t++)
        for (size_t half = 0; half < 2 && p->place[t] != SIZE_MAX; half++)
            memcpy((char *)to + (half * all->length + p->place[t]) * real,
                   number_of(v, p->waves, (2 * i + half) * l->length + t), real);
}

static bool
refined_row(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const size_t nx = p->volume->shape.nx;

    if (single(p->volume))
        to_double(row, nx, p->u + j * nx);
    else
        memcpy(p->u + j * nx, row, nx * sizeof *p->u);
    return true;
}

void
rc_slabs_refine(struct rc_slabs *v, size_t slab, double *map)
{
    const struct level *l = level_of(v, slab);
    struct pass pass = {
        .volume = v, .slab = slab, .u = map, .waves = strain_of(v, slab, 0), .place = l->place};

    if (v->level_of[slab] == 0)
        return;
    rc_fft_forward(l->fft, node_row, &pass, pass.waves, NULL);
    if (shared(v)) {
        move_columns(v, l, &v->level[0], 2 * l->length, false, pass.waves);
        pass.waves = v->moved;
    }
    rc_fft_back(v->level[0].fft, NULL, refined_column, refined_row, &pass);
}

const struct rc_slabs_counts *
rc_slabs_counted(const struct rc_slabs *v)
{
    return &v->counts;
}
