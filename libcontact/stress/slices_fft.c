/*
 * Stress maps by Fourier transforms. The pressure is transformed once; then, for each depth, the
 * kernels of all components are tabulated together on a quarter of the padded map, each is
 * transformed by its real even or odd transforms, and one transform back gives each component:
 * the normal load's kernel and mu times the shear's are added before it.
 *
 * Periodic: the kernels are known by their symbols, and nothing is tabulated or padded.
 *
 * Free, where a tolerance and the depth allow it: the same on a coarser sheet.
 */
#include "coarse.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/operator/operator.h"

enum {
    COLUMNS = 16, /* taken out of a table together: two cache lines, fetched as a pair */
    AHEAD = 8,    /* rows fetched in advance: they lie pages apart            */
    SLOTS = 2     /* spectra kept: the normal load's and the shear's           */
};

/* One grid with the transformed pressure. */
struct sheet {
    const struct rc_stress_task *task;
    struct rc_shape shape;
    struct rc_fft *fft;
    size_t cx, cy; /* of a quarter                                             */
    int threads;
    double *table[RC_STRESS_KERNELS]; /* cy rows of cx values, transformed in x */
    struct rc_dct *along_x, *along_y;
    double *x;     /* offsets of the columns                                   */
    double *space; /* for each thread: COLUMNS columns, or a row of offsets    */
    size_t room;   /* doubles of that                                          */
    struct {
        int kernel;
        struct rc_spectrum *spectrum;
    } slot[SLOTS];
    double depth;
};

struct plan {
    struct rc_stress_task task;
    struct sheet *fine, *coarse; /* coarse: that of the last depth that had one */
    struct rc_coarse *between;
    size_t sx, sy;
    double *field; /* of one component on the coarse sheet */
};

static size_t
room(size_t cx, size_t cy)
{
    return COLUMNS * cy > cx ? COLUMNS * cy : cx;
}

static size_t
count(unsigned bits)
{
    size_t n = 0;

    for (; bits != 0; bits >>= 1)
        n += bits & 1;
    return n;
}

static void
sheet_free(struct sheet *sheet)
{
    if (sheet == NULL)
        return;
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        free(sheet->table[k]);
    rc_dct_free(sheet->along_x);
    rc_dct_free(sheet->along_y);
    for (int k = 0; k < SLOTS; k++)
        rc_spectrum_free(sheet->slot[k].spectrum);
    rc_fft_free(sheet->fft);
    free(sheet->x);
    free(sheet->space);
    free(sheet);
}

/* What the tables of the free boundary need. */
static enum rc_status
allocate_tables(struct sheet *sheet, struct rc_err *err)
{
    size_t threads = (size_t)sheet->threads;

    if ((sheet->along_x = rc_dct_new(sheet->cx, threads, err)) == NULL ||
        (sheet->along_y = rc_dct_new(sheet->cy, threads, err)) == NULL)
        return RC_FAIL;
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (sheet->task->kernels >> k & 1 &&
            (sheet->table[k] = malloc(sheet->cx * sheet->cy * sizeof(double))) == NULL)
            return rc_err_set(err, "out of memory for a kernel of %zu x %zu values", sheet->cx,
                              sheet->cy);
    if ((sheet->x = malloc(sheet->cx * sizeof *sheet->x)) == NULL)
        return rc_err_set(err, "out of memory for %zu offsets", sheet->cx);
    for (size_t i = 0; i < sheet->cx; i++)
        sheet->x[i] = (double)i * sheet->shape.dx;
    return RC_OK;
}

static struct sheet *
sheet_new(const struct rc_stress_task *task, const struct rc_shape *shape, const double *p,
          struct rc_err *err)
{
    struct sheet *sheet = calloc(1, sizeof *sheet);
    enum rc_boundary boundary = task->options.boundary;

    if (sheet == NULL) {
        rc_err_set(err, "out of memory for a plan");
        return NULL;
    }
    sheet->task = task;
    sheet->shape = *shape;
    sheet->threads = rc_useful_threads(shape, task->options.threads);
    sheet->fft = rc_fft_new(shape, boundary, RC_DOUBLE, task->options.threads, err);
    if (sheet->fft == NULL)
        goto fail;
    rc_fft_quarter(sheet->fft, &sheet->cx, &sheet->cy);
    sheet->room = room(sheet->cx, sheet->cy);
    sheet->space = malloc((size_t)sheet->threads * sheet->room * sizeof *sheet->space);
    if (sheet->space == NULL) {
        rc_err_set(err, "out of memory for %d columns", COLUMNS);
        goto fail;
    }
    if (boundary == RC_FREE && allocate_tables(sheet, err) != RC_OK)
        goto fail;
    for (int k = 0; k < SLOTS; k++)
        if ((k == 0 || task->options.mu != 0) &&
            (sheet->slot[k].spectrum = rc_spectrum_new(sheet->fft, err)) == NULL)
            goto fail;
    if (rc_fft_load(sheet->fft, p, err) != RC_OK)
        goto fail;
    task->counts->source_transforms++;
    return sheet;
fail:
    sheet_free(sheet);
    return NULL;
}

static size_t
sheet_memory(const struct rc_stress_task *task, const struct rc_shape *shape)
{
    enum rc_boundary boundary = task->options.boundary;
    size_t quarter = rc_spectrum_memory(shape, boundary, RC_DOUBLE);
    size_t tables = boundary == RC_FREE ? count(task->kernels) : 0;

    /* the transform of p is as large as four spectra */
    return sizeof(struct sheet) + rc_fft_memory(shape, boundary, RC_DOUBLE) +
           ((size_t)(task->options.mu != 0) + 4 + tables) * quarter;
}

/* ---- kernels ---- */

static double *
space_of(const struct sheet *sheet)
{
    return sheet->space + (size_t)omp_get_thread_num() * sheet->room;
}

/* The kernels on a quarter of the padded map, row by row, each transformed in x. */
static void
tabulate(struct sheet *sheet)
{
    const struct rc_stress_task *t = sheet->task;
    const struct rc_cell cell = {t->shape.dx, t->shape.dy, sheet->depth, t->options.nu};

#pragma omp parallel for num_threads(sheet->threads) schedule(dynamic, 4)
    for (size_t j = 0; j < sheet->cy; j++) {
        double y = (double)j * sheet->shape.dy, *ys = space_of(sheet), *row[RC_STRESS_KERNELS];
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            row[k] = sheet->table[k] == NULL ? NULL : sheet->table[k] + j * sheet->cx;
        if (sheet->shape.dx == cell.dx) {
            rc_stress_line(&cell, t->kernels, sheet->cx, y, row);
        } else {
            for (size_t i = 0; i < sheet->cx; i++)
                ys[i] = y;
            rc_stress_coefficients(&cell, t->kernels, sheet->cx, sheet->x, ys, row);
        }
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            if (row[k] != NULL)
                rc_dct_run(sheet->along_x, rc_stress_parity[k] & RC_ODD_X, row[k]);
    }
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (sheet->table[k] != NULL)
            rc_stress_count(t, k, sheet->cx * sheet->cy);
}

static void
transform_columns(struct sheet *sheet, int kernel, struct rc_spectrum *s)
{
    const double *table = sheet->table[kernel];
    size_t cx = sheet->cx, cy = sheet->cy;

#pragma omp parallel for num_threads(sheet->threads) schedule(static)
    for (size_t first = 0; first < cx; first += COLUMNS) {
        double *column = space_of(sheet);
        size_t n = cx - first < COLUMNS ? cx - first : COLUMNS;
        for (size_t j = 0; j < cy; j++) {
            const double *row = table + j * cx + first;
            __builtin_prefetch(row + AHEAD * cx);
            __builtin_prefetch(row + AHEAD * cx + COLUMNS / 2);
            for (size_t b = 0; b < n; b++)
                column[b * cy + j] = row[b];
        }
        for (size_t b = 0; b < n; b++) {
            rc_dct_run(sheet->along_y, rc_stress_parity[kernel] & RC_ODD_Y, column + b * cy);
            rc_spectrum_column(s, sheet->fft, first + b, column + b * cy);
        }
    }
    sheet->task->counts->kernel_transforms++;
}

/* Waves of two nodes have no odd part on the nodes. */
static void
sample_symbol(struct sheet *sheet, int kernel, struct rc_spectrum *s)
{
    static const double turn = 6.28318530717958647692;
    const struct rc_shape *shape = &sheet->shape;
    const struct rc_stress_row *row = &rc_stress_rows[kernel];
    double nu = sheet->task->options.nu, z = sheet->depth;

#pragma omp parallel for num_threads(sheet->threads) schedule(static)
    for (size_t i = 0; i < sheet->cx; i++) {
        double *column = space_of(sheet);
        double qx = turn * (double)i / ((double)shape->nx * shape->dx);
        bool last_x = 2 * i == shape->nx && row->parity & RC_ODD_X;
        for (size_t j = 0; j < sheet->cy; j++) {
            double qy = turn * (double)j / ((double)shape->ny * shape->dy),
                   q = sqrt(qx * qx + qy * qy);
            const struct rc_wave wave = {qx, qy, q, z, exp(-q * z), nu};
            bool last_y = 2 * j == shape->ny && row->parity & RC_ODD_Y;
            column[j] = last_x || last_y ? 0
                        : q == 0         ? rc_stress_mean(kernel, nu, shape)
                                         : row->symbol(&wave);
        }
        rc_spectrum_column(s, sheet->fft, i, column);
    }
    rc_stress_count(sheet->task, kernel, sheet->cx * sheet->cy);
}

/* The spectrum of a kernel: one that is there, or a new one in a place that does not hold the
 * kernel to keep (-1: none). */
static const struct rc_spectrum *
spectrum_of(struct sheet *sheet, int kernel, int keep)
{
    int k = 1;

    for (int i = 0; i < SLOTS; i++)
        if (sheet->slot[i].spectrum != NULL && sheet->slot[i].kernel == kernel)
            return sheet->slot[i].spectrum;
    if (sheet->slot[k].spectrum == NULL || (keep >= 0 && sheet->slot[k].kernel == keep))
        k = 0;
    sheet->slot[k].kernel = kernel;
    rc_spectrum_begin(sheet->slot[k].spectrum, rc_stress_parity[kernel]);
    if (sheet->task->options.boundary == RC_FREE)
        transform_columns(sheet, kernel, sheet->slot[k].spectrum);
    else
        sample_symbol(sheet, kernel, sheet->slot[k].spectrum);
    return sheet->slot[k].spectrum;
}

/* ---- layers ---- */

/* One that shares its kernel with the one before comes after it. */
static const enum rc_component order[RC_COMPONENTS] = {RC_SXX, RC_SYY, RC_SXY,
                                                       RC_SYZ, RC_SZZ, RC_SXZ};

static void
begin(struct sheet *sheet, double depth)
{
    sheet->depth = depth;
    for (int k = 0; k < SLOTS; k++)
        sheet->slot[k].kernel = -1;
    if (sheet->task->options.boundary == RC_FREE)
        tabulate(sheet);
}

static void
component(struct sheet *sheet, int c, double *s)
{
    int normal = rc_stress_kernel(RC_NORMAL, c), shear = rc_stress_kernel(RC_SHEAR, c);
    const struct rc_spectrum *a = spectrum_of(sheet, normal, -1);
    double mu = sheet->task->options.mu;

    if (mu == 0)
        rc_fft_field(sheet->fft, a, s);
    else
        rc_fft_field_pair(sheet->fft, a, mu, spectrum_of(sheet, shear, normal), s);
    sheet->task->counts->field_transforms++;
}

/* ---- coarser sheets ---- */

/* Errors of the two loads add; those of the shear's kernels are the smaller. */
static bool
may_be_coarse(const struct rc_stress_task *t, double depth, size_t *sx, size_t *sy)
{
    double tol = t->options.tol / (1 + fabs(t->options.mu));

    return t->options.boundary == RC_FREE &&
           rc_coarse_steps(&t->shape, rc_coarse_spacing(depth, tol), sx, sy);
}

static void
coarse_free(struct plan *plan)
{
    sheet_free(plan->coarse);
    rc_coarse_free(plan->between);
    free(plan->field);
    plan->coarse = NULL;
    plan->between = NULL;
    plan->field = NULL;
}

static enum rc_status
coarse_new(struct plan *plan, size_t sx, size_t sy, struct rc_err *err)
{
    const struct rc_stress_task *t = &plan->task;
    struct rc_shape shape = rc_coarse_shape(&t->shape, sx, sy);

    if (plan->coarse != NULL && plan->sx == sx && plan->sy == sy)
        return RC_OK;
    coarse_free(plan);
    plan->sx = sx;
    plan->sy = sy;
    if ((plan->field = malloc(shape.nx * shape.ny * sizeof *plan->field)) == NULL)
        return rc_err_set(err, "out of memory for a map of %zu x %zu nodes", shape.nx, shape.ny);
    plan->between = rc_coarse_new(&t->shape, sx, sy, t->options.threads, err);
    if (plan->between == NULL)
        return RC_FAIL;
    rc_coarse_reduce(plan->between, t->p, plan->field);
    plan->coarse = sheet_new(t, &shape, plan->field, err);
    return plan->coarse == NULL ? RC_FAIL : RC_OK;
}

/* ---- the plan ---- */

static void
plan_free(void *at)
{
    struct plan *plan = at;

    if (plan == NULL)
        return;
    sheet_free(plan->fine);
    coarse_free(plan);
    free(plan);
}

static void *
plan_new(const struct rc_stress_task *task, struct rc_err *err)
{
    struct plan *plan = calloc(1, sizeof *plan);

    if (plan == NULL) {
        rc_err_set(err, "out of memory for a plan");
        return NULL;
    }
    plan->task = *task;
    if ((plan->fine = sheet_new(&plan->task, &task->shape, task->p, err)) == NULL) {
        plan_free(plan);
        return NULL;
    }
    return plan;
}

static size_t
memory(const struct rc_stress_task *task)
{
    size_t bytes = sizeof(struct plan) + sheet_memory(task, &task->shape), sx, sy;
    struct rc_shape c;

    /* of coarser sheets there is one at a time, the first one the largest */
    if (may_be_coarse(task, INFINITY, &sx, &sy)) {
        c = rc_coarse_shape(&task->shape, sx > 1 ? 2 : 1, sy > 1 ? 2 : 1);
        bytes += sheet_memory(task, &c) + (c.nx * c.ny + task->shape.ny * c.nx) * sizeof(double);
    }
    return bytes;
}

static enum rc_status
layer(void *at, double depth, double *const s[RC_COMPONENTS], struct rc_err *err)
{
    struct plan *plan = at;
    size_t sx, sy;
    bool coarse = may_be_coarse(&plan->task, depth, &sx, &sy);
    struct sheet *sheet = plan->fine;

    if (coarse) {
        if (coarse_new(plan, sx, sy, err) != RC_OK)
            return RC_FAIL;
        sheet = plan->coarse;
        plan->task.counts->coarse_depths++;
    }
    begin(sheet, depth);
    for (int o = 0; o < RC_COMPONENTS; o++) {
        int c = (int)order[o];
        if (!(plan->task.components >> c & 1))
            continue;
        component(sheet, c, coarse ? plan->field : s[c]);
        if (coarse)
            rc_coarse_expand(plan->between, plan->field, s[c]);
    }
    return RC_OK;
}

const struct rc_stress_way rc_stress_way_fft = {
    .memory = memory,
    .new = plan_new,
    .layer = layer,
    .free = plan_free,
};
