/*
 * Stress maps by Fourier transforms. The pressure is transformed once; then, for each depth, the
 * kernels of all components are tabulated together on a quarter of the padded map, each is
 * transformed by its real even or odd transforms, and one transform back gives each component:
 * the normal load's kernel and mu times the shear's are added before it.
 *
 * Periodic: the kernels are known by their symbols, and nothing is tabulated or padded.
 */
#include "stress.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "fft.h"
#include "fourier.h"

enum {
    COLUMNS = 8, /* taken out of a table together: a cache line              */
    SLOTS = 2    /* spectra kept: the normal load's and the shear's           */
};

struct plan {
    struct rc_stress_task task;
    struct rc_fft *fft;
    size_t cx, cy; /* of a quarter                                             */
    int threads;
    double *table[RC_STRESS_KERNELS]; /* cy rows of cx values, transformed in x */
    struct rc_halves *along_x[2], *along_y[2]; /* even, odd                     */
    double *x;     /* offsets of the columns                                   */
    double *space; /* for each thread: COLUMNS columns, or a row of offsets    */
    size_t room;   /* doubles of that                                          */
    struct {
        int kernel;
        struct rc_spectrum *spectrum;
    } slot[SLOTS];
    double depth;
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
plan_free(void *at)
{
    struct plan *plan = at;

    if (plan == NULL)
        return;
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        free(plan->table[k]);
    for (int odd = 0; odd < 2; odd++) {
        rc_halves_free(plan->along_x[odd]);
        rc_halves_free(plan->along_y[odd]);
    }
    for (int k = 0; k < SLOTS; k++)
        rc_spectrum_free(plan->slot[k].spectrum);
    rc_fft_free(plan->fft);
    free(plan->x);
    free(plan->space);
    free(plan);
}

/* What the tables of the free boundary need. */
static enum rc_status
allocate_tables(struct plan *plan, struct rc_err *err)
{
    size_t threads = (size_t)plan->threads;

    for (int odd = 0; odd < 2; odd++)
        if ((plan->along_x[odd] = rc_halves_new(plan->cx, odd, threads, err)) == NULL ||
            (plan->along_y[odd] = rc_halves_new(plan->cy, odd, threads, err)) == NULL)
            return RC_FAIL;
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (plan->task.kernels >> k & 1 &&
            (plan->table[k] = malloc(plan->cx * plan->cy * sizeof(double))) == NULL)
            return rc_err_set(err, "out of memory for a kernel of %zu x %zu values", plan->cx,
                              plan->cy);
    if ((plan->x = malloc(plan->cx * sizeof *plan->x)) == NULL)
        return rc_err_set(err, "out of memory for %zu offsets", plan->cx);
    for (size_t i = 0; i < plan->cx; i++)
        plan->x[i] = (double)i * plan->task.shape.dx;
    return RC_OK;
}

static void *
plan_new(const struct rc_stress_task *task, struct rc_err *err)
{
    struct plan *plan = calloc(1, sizeof *plan);
    enum rc_boundary boundary = task->options.boundary;

    if (plan == NULL) {
        rc_err_set(err, "out of memory for a plan");
        return NULL;
    }
    plan->task = *task;
    plan->threads = rc_useful_threads(&task->shape, task->options.threads);
    plan->fft = rc_fft_new(&task->shape, boundary, RC_DOUBLE, task->options.threads, err);
    if (plan->fft == NULL)
        goto fail;
    rc_fft_quarter(plan->fft, &plan->cx, &plan->cy);
    plan->room = room(plan->cx, plan->cy);
    plan->space = malloc((size_t)plan->threads * plan->room * sizeof *plan->space);
    if (plan->space == NULL) {
        rc_err_set(err, "out of memory for %zu columns", (size_t)COLUMNS);
        goto fail;
    }
    if (boundary == RC_FREE && allocate_tables(plan, err) != RC_OK)
        goto fail;
    for (int k = 0; k < SLOTS; k++)
        if ((k == 0 || task->options.mu != 0) &&
            (plan->slot[k].spectrum = rc_spectrum_new(plan->fft, err)) == NULL)
            goto fail;
    if (rc_fft_load(plan->fft, task->p, err) != RC_OK)
        goto fail;
    task->counts->source_transforms++;
    return plan;
fail:
    plan_free(plan);
    return NULL;
}

static size_t
memory(const struct rc_stress_task *task)
{
    enum rc_boundary boundary = task->options.boundary;
    size_t quarter = rc_spectrum_memory(&task->shape, boundary, RC_DOUBLE);
    size_t tables = boundary == RC_FREE ? count(task->kernels) : 0;

    /* the transform of p is four quarters on the free boundary, half of that on the other */
    return rc_fft_memory(&task->shape, boundary, RC_DOUBLE) +
           ((size_t)(task->options.mu != 0) + 4 + tables) * quarter;
}

/* ---- kernels ---- */

static double *
space_of(const struct plan *plan)
{
    return plan->space + (size_t)omp_get_thread_num() * plan->room;
}

/* The kernels on a quarter of the padded map, row by row, each transformed in x. */
static void
tabulate(struct plan *plan)
{
    const struct rc_stress_task *t = &plan->task;
    const struct rc_cell cell = {t->shape.dx, t->shape.dy, plan->depth, t->options.nu};

#pragma omp parallel for num_threads(plan->threads) schedule(dynamic, 4)
    for (size_t j = 0; j < plan->cy; j++) {
        double *y = space_of(plan), *row[RC_STRESS_KERNELS];
        for (size_t i = 0; i < plan->cx; i++)
            y[i] = (double)j * t->shape.dy;
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            row[k] = plan->table[k] == NULL ? NULL : plan->table[k] + j * plan->cx;
        rc_stress_coefficients(&cell, t->kernels, plan->cx, plan->x, y, row);
        for (int k = 0; k < RC_STRESS_KERNELS; k++)
            if (row[k] != NULL)
                rc_halves_run(plan->along_x[(rc_stress_parity[k] & RC_ODD_X) != 0], row[k]);
    }
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (plan->table[k] != NULL)
            rc_stress_count(t, k, plan->cx * plan->cy);
}

static void
transform_columns(struct plan *plan, int kernel, struct rc_spectrum *s)
{
    const double *table = plan->table[kernel];
    const struct rc_halves *along_y = plan->along_y[(rc_stress_parity[kernel] & RC_ODD_Y) != 0];
    size_t cx = plan->cx, cy = plan->cy;

#pragma omp parallel for num_threads(plan->threads) schedule(static)
    for (size_t first = 0; first < cx; first += COLUMNS) {
        double *column = space_of(plan);
        size_t n = cx - first < COLUMNS ? cx - first : COLUMNS;
        for (size_t j = 0; j < cy; j++)
            for (size_t b = 0; b < n; b++)
                column[b * cy + j] = table[j * cx + first + b];
        for (size_t b = 0; b < n; b++) {
            rc_halves_run(along_y, column + b * cy);
            rc_spectrum_column(s, plan->fft, first + b, column + b * cy);
        }
    }
    plan->task.counts->kernel_transforms++;
}

/* Waves of two nodes have no odd part on the nodes. */
static void
sample_symbol(struct plan *plan, int kernel, struct rc_spectrum *s)
{
    static const double turn = 6.28318530717958647692;
    const struct rc_shape *shape = &plan->task.shape;
    const struct rc_stress_row *row = &rc_stress_rows[kernel];
    double nu = plan->task.options.nu, z = plan->depth;

#pragma omp parallel for num_threads(plan->threads) schedule(static)
    for (size_t i = 0; i < plan->cx; i++) {
        double *column = space_of(plan);
        double qx = turn * (double)i / ((double)shape->nx * shape->dx);
        bool last_x = 2 * i == shape->nx && row->parity & RC_ODD_X;
        for (size_t j = 0; j < plan->cy; j++) {
            double qy = turn * (double)j / ((double)shape->ny * shape->dy), q = sqrt(qx * qx + qy * qy);
            const struct rc_wave wave = {qx, qy, q, z, exp(-q * z), nu};
            bool last_y = 2 * j == shape->ny && row->parity & RC_ODD_Y;
            column[j] = last_x || last_y ? 0
                        : q == 0         ? rc_stress_mean(kernel, nu, shape)
                                         : row->symbol(&wave);
        }
        rc_spectrum_column(s, plan->fft, i, column);
    }
    rc_stress_count(&plan->task, kernel, plan->cx * plan->cy);
}

/* The spectrum of a kernel: one that is there, or put in the place of the one not to `keep`. */
static const struct rc_spectrum *
spectrum_of(struct plan *plan, int kernel, int keep)
{
    int k = SLOTS - 1;

    for (int i = 0; i < SLOTS; i++)
        if (plan->slot[i].spectrum != NULL && plan->slot[i].kernel == kernel)
            return plan->slot[i].spectrum;
    while (plan->slot[k].spectrum == NULL || plan->slot[k].kernel == keep)
        k--;
    plan->slot[k].kernel = kernel;
    rc_spectrum_begin(plan->slot[k].spectrum, rc_stress_parity[kernel]);
    if (plan->task.options.boundary == RC_FREE)
        transform_columns(plan, kernel, plan->slot[k].spectrum);
    else
        sample_symbol(plan, kernel, plan->slot[k].spectrum);
    return plan->slot[k].spectrum;
}

/* ---- layers ---- */

/* One that shares its kernel with the one before comes after it. */
static const enum rc_component order[RC_COMPONENTS] = {RC_SXX, RC_SYY, RC_SXY,
                                                       RC_SYZ, RC_SZZ, RC_SXZ};

static enum rc_status
layer(void *at, double depth, double *const s[RC_COMPONENTS], struct rc_err *err)
{
    struct plan *plan = at;
    double mu = plan->task.options.mu;

    (void)err;
    plan->depth = depth;
    for (int k = 0; k < SLOTS; k++)
        plan->slot[k].kernel = -1;
    if (plan->task.options.boundary == RC_FREE)
        tabulate(plan);
    for (int o = 0; o < RC_COMPONENTS; o++) {
        int c = (int)order[o], normal = rc_stress_kernel(RC_NORMAL, c);
        const struct rc_spectrum *a;
        if (!(plan->task.components >> c & 1))
            continue;
        a = spectrum_of(plan, normal, -1);
        if (mu == 0)
            rc_fft_field(plan->fft, a, s[c]);
        else
            rc_fft_field_pair(plan->fft, a, mu,
                              spectrum_of(plan, rc_stress_kernel(RC_SHEAR, c), normal), s[c]);
        plan->task.counts->field_transforms++;
    }
    return RC_OK;
}

const struct rc_stress_way rc_stress_way_fft = {
    .memory = memory,
    .new = plan_new,
    .layer = layer,
    .free = plan_free,
};
