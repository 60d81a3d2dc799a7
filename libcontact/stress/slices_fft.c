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
#include <stdlib.h>

#include "libcontact/operator/operator.h"

enum {
    SLOTS = 2 /* spectra kept: the normal load's and the shear's */
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
    for (int k = 0; k < SLOTS; k++)
        rc_spectrum_free(sheet->slot[k].spectrum);
    rc_fft_free(sheet->fft);
    free(sheet);
}

/* For the free boundary. */
static enum rc_status
allocate_tables(struct sheet *sheet, struct rc_err *err)
{
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (sheet->task->kernels >> k & 1 &&
            (sheet->table[k] = malloc(sheet->cx * sheet->cy * sizeof(double))) == NULL)
            return rc_err_set(err, "out of memory for a kernel of %zu x %zu values", sheet->cx,
                              sheet->cy);
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

/* The kernels on a quarter of the padded map, each row transformed in x. */
static void
tabulate(struct sheet *sheet)
{
    const struct rc_stress_task *t = sheet->task;
    const struct rc_cell cell = {t->shape.dx, t->shape.dy, sheet->depth, t->options.nu};

#pragma omp parallel for num_threads(sheet->threads) schedule(dynamic, 4)
    for (size_t j = 0; j < sheet->cy; j++) {
        double *row[RC_STRESS_KERNELS];
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            row[k] = sheet->table[k] == NULL ? NULL : sheet->table[k] + j * sheet->cx;
        rc_stress_line(&cell, t->kernels, sheet->shape.dx, sheet->cx, (double)j * sheet->shape.dy,
                       row);
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            if (row[k] != NULL)
                rc_fft_quarter_row(sheet->fft, rc_stress_parity[k], row[k]);
    }
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (sheet->table[k] != NULL)
            rc_stress_count(t, k, sheet->cx * sheet->cy);
}

/* One kernel at the depth of a sheet, as rc_spectrum_sample asks for it. */
struct wave_kernel {
    int kernel;
    const struct sheet *sheet;
};

static double
symbol(const void *of, double qx, double qy)
{
    const struct wave_kernel *w = of;
    const struct rc_wave wave = rc_stress_wave(qx, qy, w->sheet->depth, w->sheet->task->options.nu);

    return rc_stress_symbol(w->kernel, &wave, &w->sheet->shape);
}

static void
set_spectrum(struct sheet *sheet, int kernel, struct rc_spectrum *s)
{
    const struct wave_kernel of = {kernel, sheet};

    if (sheet->task->options.boundary == RC_FREE) {
        rc_spectrum_set_quarter(s, sheet->fft, rc_stress_parity[kernel], sheet->table[kernel]);
        sheet->task->counts->kernel_transforms++;
    } else {
        rc_spectrum_sample(s, sheet->fft, rc_stress_parity[kernel], symbol, &of);
        rc_stress_count(sheet->task, kernel, sheet->cx * sheet->cy);
    }
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
    set_spectrum(sheet, kernel, sheet->slot[k].spectrum);
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
