/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Stress maps by Fourier transforms. The pressure, and maps of traction, are transformed once. Then, for each
 * depth, the kernels of all components are tabulated together on a quarter of the padded map. Each gives its
 * spectrum by real even or odd transforms, an even and an odd one together. One transform back gives each
 * component, from the sum of the products with the kernels of all loads.
 *
 * Periodic: the kernels have symbols, no padding is needed, and only the decay of the waves is tabulated.
 * Where one axis repeats, the quarter holds the spectra of the kernels of waves along this axis.
 * Waves that do not reach the depth are left out.
 *
 * Where the tolerance permits, transforms are in single precision. Where the depth permits too, the same is
 * done on a grid that is coarser along the free axes.
 */
#include "coarse_grid.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/body/line.h"
#include "libcontact/memory.h"

enum {
    COLUMNS =
        16 /* columns of a quarter that are written together; the fields take whole lines of them */
};

/* One grid: the transform of the pressure on it, and the kernels at one depth. */
struct grid {
    const struct rc_stress_task *task;
    struct rc_shape shape;
    struct rc_fft *fft;
    int threads;
    size_t cx, cy;                      /* columns and rows of a quarter of a kernel's period */
    size_t first_row, rows;             /* rows computed here */
    size_t first_column, columns;       /* columns held here */
    size_t reached;                     /* columns whose waves reach the depth; x free: all */
    double *quarter[RC_STRESS_KERNELS]; /* unless both axes repeat: see rc_fft_quarter */
    double *lines;            /* only x repeats: COLUMNS columns of each quarter, for each thread */
    size_t kernels;           /* quarters */
    double *known;            /* periodic map: `numbers` for each wave, columns of
                                               cy */
    size_t numbers;           /* numbers that describe a wave at the depth */
    struct rc_inside *inside; /* at the depth                                     */
    double depth;             /* depth of all tables above, m */
    struct rc_store own;
};

struct plan {
    struct rc_stress_task task;
    struct grid *fine, *coarse; /* coarse: the grid of the last depth that had one; or NULL */
    struct rc_coarse *between;  /* between fine and coarse                              */
    size_t sx, sy;              /* fine nodes per coarse node                           */
    double *field[RC_FIELDS];   /* fields on the coarse grid */
    struct rc_store own;        /* of them */
};

/* Smaller tolerances than this need double precision: single precision makes errors of up to 1e-6 of the
 * largest pressure. The errors of all loads add up. */
static const double single_floor = 1e-5;

static enum rc_precision
precision_of(const struct rc_stress_task *t)
{
    return t->options.tol / (1 + rc_stress_shear(t)) >= single_floor && !t->precise ? RC_SINGLE
                                                                                    : RC_DOUBLE;
}

bool
rc_stress_slices_single(const struct rc_stress_task *task)
{
    return precision_of(task) == RC_SINGLE;
}

static void
grid_free(struct grid *g)
{
    if (g == NULL)
        return;
    rc_inside_free(g->inside);
    rc_fft_free(g->fft);
    rc_store_free(&g->own);
    free(g);
}
RC_OWNER(grid)

/* Allocates the tables of a depth. */
static enum rc_status
make_tables(struct grid *g, struct rc_err *err)
{
    const struct rc_stress_task *task = g->task;
    const bool periodic = !rc_has_mean(task->options.boundary);

    rc_fft_quarter(g->fft, &g->cx, &g->cy);
    rc_fft_quarter_rows(g->fft, &g->first_row, &g->rows);
    rc_fft_columns(g->fft, &g->first_column, &g->columns);
    g->numbers = rc_stress_numbers(task);
    for (int k = 0; k < RC_STRESS_KERNELS && !periodic; k++)
        if (task->kernels >> k & 1) {
            g->quarter[k] = rc_store_take(&g->own, rc_fft_quarter_size(g->fft), sizeof(double));
            g->kernels++;
        }
    if (!periodic && task->options.boundary.x)
        g->lines = rc_store_take(&g->own, (size_t)g->threads * g->kernels * COLUMNS * g->cy,
                                 sizeof *g->lines);
    if (periodic)
        g->known = rc_store_take(&g->own, g->columns * g->cy * g->numbers, sizeof *g->known);
    return rc_ranks_need(task->options.ranks, !g->own.failed, err,
                         "out of memory for kernels of %zu x %zu values", g->cx, g->cy);
}

static struct grid *
grid_new(const struct rc_stress_task *task, const struct rc_shape *shape, struct rc_err *err)
{
    RC_OWN(grid, g) = calloc(1, sizeof *g);
    const struct rc_ranks *ranks = task->options.ranks;

    if (rc_ranks_need(ranks, g != NULL, err, "out of memory for a plan") != RC_OK)
        return NULL;
    g->task = task;
    g->shape = *shape;
    g->fft = rc_fft_new(ranks, NULL, shape, task->options.boundary, precision_of(task),
                        task->options.threads, err);
    if (g->fft == NULL)
        return NULL;
    g->threads = rc_fft_threads(g->fft);
    return make_tables(g, err) == RC_OK ? rc_give(&g) : NULL;
}

static enum rc_status
load(struct grid *g, size_t source, const double *map, struct rc_err *err)
{
    g->task->counts->source_transforms++;
    return rc_fft_load(g->fft, source, map, err);
}

/* ---- kernels on a quarter of the padded map ---- */

/* The kernels that are odd along an axis: RC_ODD_X or RC_ODD_Y. */
static unsigned
odd_along(unsigned axis)
{
    unsigned odd = 0;

    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        odd |= rc_stress_parity[k] & axis ? 1u << k : 0;
    return odd;
}

/* The spectra of the kernels of a wave along the axis that repeats. A wave of two nodes is left out where the
 * kernel is odd: it is zero at all nodes. */
static enum rc_status
line_of_wave(const struct grid *g, bool along_x, size_t wave, double *const out[RC_STRESS_KERNELS])
{
    const struct rc_shape *s = &g->shape, *map = &g->task->shape;
    const size_t nodes = along_x ? s->ny : s->nx, half = along_x ? g->cx : g->cy;
    const double cell = along_x ? map->dx : map->dy;
    struct rc_line_at at = {.cell = cell,
                            .step = (size_t)lround((along_x ? s->dx : s->dy) / cell),
                            .wave = rc_fourier_q(wave, nodes, along_x ? s->dy : s->dx)};
    const double most = RC_STRESS_REACH / g->depth;
    unsigned kernels = rc_stress_reaches(at.wave, g->depth) ? g->task->kernels : 0;

    if (2 * wave == nodes)
        kernels &= ~odd_along(along_x ? RC_ODD_Y : RC_ODD_X);
    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        if (out[k] != NULL && !(kernels >> k & 1))
            memset(out[k], 0, half * sizeof(double));
    at.n = half > 1 ? 2 * (half - 1) : 1;
    if (rc_line_decays(&at))
        return rc_inside_spectra(g->inside, kernels, along_x, &at, most, out, NULL);
    at.n = half;
    if (rc_inside_lines(g->inside, kernels, along_x, &at, most, out, NULL) != RC_OK)
        return RC_FAIL;
    rc_fft_quarter_line(g->fft, RC_STRESS_KERNELS, odd_along(along_x ? RC_ODD_X : RC_ODD_Y), out);
    return RC_OK;
}

/* Row j of those computed here: the kernels at the distance of j rows, or for a wave along y. */
static enum rc_status
tabulate_row(const struct grid *g, size_t j)
{
    const struct rc_stress_task *t = g->task;
    const struct rc_cell cell = {t->shape.dx, t->shape.dy};
    double *row[RC_STRESS_KERNELS];

    for (int k = 0; k < RC_STRESS_KERNELS; k++)
        row[k] = g->quarter[k] == NULL ? NULL : g->quarter[k] + j * g->cx;
    if (t->options.boundary.y)
        return line_of_wave(g, true, g->first_row + j, row);
    t->type->line(g->inside, &cell, t->kernels, g->shape.dx, g->cx,
                  (double)(g->first_row + j) * g->shape.dy, row);
    rc_fft_quarter_line(g->fft, RC_STRESS_KERNELS, odd_along(RC_ODD_X), row);
    return RC_OK;
}

/* The n columns from `first` on of those held here, at most COLUMNS: the kernels for waves along x. */
static enum rc_status
tabulate_columns(const struct grid *g, size_t first, size_t n)
{
    const size_t wide = rc_fft_quarter_wide(g->fft), cy = g->cy, size = g->kernels * cy;
    double *lines = g->lines + (size_t)omp_get_thread_num() * COLUMNS * size, *next = lines;
    double *line[RC_STRESS_KERNELS];

    for (size_t c = 0; c < n; c++) {
        for (int k = 0; k < RC_STRESS_KERNELS; k++) {
            line[k] = g->quarter[k] == NULL ? NULL : next;
            next += g->quarter[k] == NULL ? 0 : cy;
        }
        if (line_of_wave(g, false, g->first_column + first + c, line) != RC_OK)
            return RC_FAIL;
    }
    for (int k = 0; k < RC_STRESS_KERNELS; k++) {
        for (size_t j = 0; g->quarter[k] != NULL && j < cy; j++)
            for (size_t c = 0; c < n; c++)
                g->quarter[k][j * wide + first + c] = lines[c * size + j];
        lines += g->quarter[k] == NULL ? 0 : cy;
    }
    return RC_OK;
}

/* Columns held here whose waves reach the depth. */
static size_t
reached_here(const struct grid *g)
{
    return g->reached > g->first_column + g->columns ? g->columns
           : g->reached > g->first_column            ? g->reached - g->first_column
                                                     : 0;
}

/* All kernels. */
static enum rc_status
tabulate(struct grid *g, struct rc_err *err)
{
    const struct rc_stress_task *t = g->task;
    const bool by_columns = t->options.boundary.x;
    const size_t n = by_columns ? reached_here(g) : g->rows, step = by_columns ? COLUMNS : 1;
    enum rc_status status = RC_OK;

#pragma omp parallel for num_threads(g->threads) schedule(dynamic, by_columns ? 1 : 4)
    for (size_t k = 0; k < n; k += step)
        if ((by_columns ? tabulate_columns(g, k, n - k < step ? n - k : step)
                        : tabulate_row(g, k)) != RC_OK)
#pragma omp atomic write
            status = RC_FAIL;
    status = rc_ranks_need(t->options.ranks, status == RC_OK, err,
                           "out of memory for kernels of %zu x %zu values", g->cx, g->cy);
    for (int k = 0; k < RC_STRESS_KERNELS && status == RC_OK; k++)
        if (g->quarter[k] != NULL) {
            if (!by_columns)
                status = rc_fft_quarter_turn(g->fft, g->quarter[k], err);
            rc_stress_count(t, k, g->cx * g->cy);
        }
    return status;
}

/* ---- waves ---- */

/* The numbers of all waves at the depth of a periodic grid; 0 for the waves left out. */
static void
set_known(struct grid *g)
{
    enum {
        PIECE = 256
    };
    const struct rc_shape *s = &g->shape;

#pragma omp parallel for num_threads(g->threads) schedule(dynamic, 4)
    for (size_t i = 0; i < g->columns; i++) {
        double qx = rc_fourier_q(g->first_column + i, s->nx, s->dx), q[PIECE];
        double *column = g->known + i * g->cy * g->numbers;
        size_t n;
        memset(column, 0, g->cy * g->numbers * sizeof *column);
        for (size_t j = qx > 0 ? 0u : 1u; j < g->cy; j += n) { /* q increases along a column */
            for (n = 0; n < PIECE && j + n < g->cy; n++) {
                double qy = rc_fourier_q(j + n, s->ny, s->dy);
                q[n] = sqrt(qx * qx + qy * qy);
                if (!rc_stress_reaches(q[n], g->depth))
                    break;
            }
            g->task->type->waves(g->inside, n, q, column + j * g->numbers);
            if (n < PIECE)
                break;
        }
    }
}

/* A kernel at the depth of a grid. */
struct component {
    const struct grid *grid;
    int kernel;
};

static void
symbol(const void *of, size_t i, double qx, size_t n, const double *qy, double *out)
{
    enum {
        PIECE = 256
    };
    const struct component *c = of;
    const struct grid *g = c->grid;
    double x[PIECE], y[PIECE], q[PIECE], all[PIECE];

    for (size_t k = 0; k < PIECE; k++)
        all[k] = qx;
    for (size_t j = 0; j < n; j += PIECE) {
        size_t m = n - j < PIECE ? n - j : PIECE;
        const double *kept = g->known + ((i - g->first_column) * g->cy + j) * g->numbers;
        const struct rc_waves waves = {m, x, y, q, kept};
        rc_wave_directions(m, all, qy + j, x, y, q);
        rc_inside_symbol(g->inside, c->kernel, &waves, &g->shape, out + j);
    }
}

/* ---- fields ---- */

/* Two are computed together: one even and one odd in y, and szz and sxz, because szz of the shear equals sxz
 * of the normal load. */
static const enum rc_component order[RC_COMPONENTS] = {RC_SXX, RC_SXY, RC_SYY,
                                                       RC_SYZ, RC_SZZ, RC_SXZ};

static enum rc_status
go_to_depth(struct grid *g, double depth, struct rc_err *err)
{
    rc_inside_free(g->inside);
    g->inside = rc_stress_inside(g->task, depth, err);
    if (rc_ranks_agree(g->task->options.ranks, g->inside == NULL ? RC_FAIL : RC_OK, err) != RC_OK)
        return RC_FAIL;
    g->depth = depth;
    g->reached = g->cx;
    while (g->task->options.boundary.x && g->reached > 1 &&
           !rc_stress_reaches(rc_fourier_q(g->reached - 1, g->shape.nx, g->shape.dx), depth))
        g->reached--;
    if (rc_has_mean(g->task->options.boundary)) {
        g->reached = (g->reached + COLUMNS - 1) / COLUMNS * COLUMNS;
        g->reached = g->reached < g->cx ? g->reached : g->cx;
        return tabulate(g, err);
    }
    set_known(g);
    return RC_OK;
}

/* The place of a kernel among the *n of a list, to which it is added if it is new. */
static size_t
place_of(const struct grid *g, int kernel, size_t *n, struct component *of,
         struct rc_fft_kernel *list)
{
    size_t k = 0;

    while (k < *n && of[k].kernel != kernel)
        k++;
    if (k < *n)
        return k;
    of[k] = (struct component){g, kernel};
    list[k] = (struct rc_fft_kernel){rc_stress_parity[kernel], g->quarter[kernel], symbol, &of[k]};
    ++*n;
    return k;
}

/* n components c[k], to the maps s[k]. */
static enum rc_status
make_fields(struct grid *g, size_t n, const int *c, double *const *s, struct rc_err *err)
{
    const struct rc_stress_task *t = g->task;
    struct rc_fft_sum sum[RC_FIELDS] = {{0}};
    struct rc_fft_kernel kernel[RC_LINES] = {{0}};
    struct component of[RC_LINES];
    size_t kernels = 0;

    for (size_t k = 0; k < n; k++) {
        sum[k] = (struct rc_fft_sum){.u = s[k]};
        for (int load = 0; load < RC_LOADS; load++)
            if (rc_stress_has(t, load))
                sum[k].term[sum[k].n++] = (struct rc_fft_term){
                    place_of(g, rc_stress_kernel(t->type, load, c[k]), &kernels, of, kernel),
                    t->load[load].source, t->load[load].weight};
    }
    if (rc_fft_fields(g->fft, g->reached, kernels, kernel, n, sum, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < kernels; k++)
        if (rc_has_mean(t->options.boundary))
            t->counts->kernel_transforms++;
        else
            rc_stress_count(t, of[k].kernel, g->cx * g->cy);
    t->counts->field_transforms += n;
    return RC_OK;
}

/* ---- coarser grids ---- */

/* True if a coarser grid is accurate enough at this depth, and its steps. The errors of all loads add up;
 * those of the kernels of the shear are smaller. */
static bool
may_be_coarse(const struct rc_stress_task *t, double depth, size_t *sx, size_t *sy)
{
    /* If no component errs by more than e, the Mises stress of the errors is at most sqrt(15) e. No Mises
     * stress errs by more than that, and no Tresca stress by more than 2/sqrt(3) times as much. */
    double derived = t->options.wanted >> RC_COMPONENTS != 0 ? 4.5 : 1;
    double tol = t->options.tol / (derived * (1 + rc_stress_shear(t)));

    return rc_has_mean(t->options.boundary) && t->type->coarsens &&
           rc_coarse_steps(&t->shape, t->options.boundary, rc_coarse_spacing(depth, tol), sx, sy);
}

static void
coarse_free(struct plan *plan)
{
    grid_free(plan->coarse);
    rc_coarse_free(plan->between);
    rc_store_free(&plan->own);
    plan->coarse = NULL;
    plan->between = NULL;
    plan->own = (struct rc_store){0};
}

static enum rc_status
coarse_new(struct plan *plan, size_t sx, size_t sy, struct rc_err *err)
{
    const struct rc_stress_task *t = &plan->task;
    struct rc_shape shape = rc_coarse_shape(&t->shape, sx, sy);
    size_t nodes = shape.nx * rc_rows_of(t->options.ranks, &shape).n;

    if (plan->coarse != NULL && plan->sx == sx && plan->sy == sy)
        return RC_OK;
    coarse_free(plan);
    plan->sx = sx;
    plan->sy = sy;
    for (size_t k = 0; k < RC_FIELDS; k++)
        plan->field[k] = rc_store_take(&plan->own, nodes, sizeof(double));
    if (rc_ranks_need(t->options.ranks, !plan->own.failed, err,
                      "out of memory for a map of %zu x %zu nodes", shape.nx, shape.ny) != RC_OK)
        return RC_FAIL;
    plan->between = rc_coarse_new(t->options.ranks, &t->shape, sx, sy, t->options.threads, err);
    if (plan->between == NULL)
        return RC_FAIL;
    plan->coarse = grid_new(t, &shape, err);
    for (size_t k = 0; plan->coarse != NULL && k < t->sources; k++) {
        rc_coarse_reduce(plan->between, t->source[k], plan->field[0]);
        if (load(plan->coarse, k, plan->field[0], err) != RC_OK)
            coarse_free(plan);
    }
    return plan->coarse == NULL ? RC_FAIL : RC_OK;
}

/* ---- the plan ---- */

static void
plan_free(void *at)
{
    struct plan *plan = at;

    if (plan == NULL)
        return;
    grid_free(plan->fine);
    coarse_free(plan);
    free(plan);
}
RC_OWNER(plan)

double
rc_stress_slices_coarser(const struct rc_stress_task *task)
{
    const struct rc_shape *s = &task->shape;
    const double *depth = task->options.depth;
    double most = 0;
    size_t sx, sy;

    for (size_t k = 0; k < (depth == NULL ? 1 : task->options.depths); k++)
        if (may_be_coarse(task, depth == NULL ? INFINITY : depth[k], &sx, &sy)) {
            const size_t x = depth == NULL && sx > 2 ? 2 : sx, y = depth == NULL && sy > 2 ? 2 : sy;
            const struct rc_shape coarse = rc_coarse_shape(s, x, y);
            most = fmax(most, (double)(coarse.nx * coarse.ny) / (double)(s->nx * s->ny));
        }
    return most;
}

/* Checks that memory suffices for the largest coarser grid, which is made later; `fine`: bytes of the grid of
 * the map. */
static enum rc_status
reserve(const struct rc_stress_task *task, size_t fine, struct rc_err *err)
{
    const double share = rc_stress_slices_coarser(task),
                 n = (double)rc_rows_of(task->options.ranks, &task->shape).n *
                     (double)task->shape.nx;

    /* its transforms, its fields, and the rows between the two directions of the transfer */
    if (rc_memory_ask((size_t)(share * ((double)fine + RC_FIELDS * n * sizeof(double)) +
                               sqrt(share) * n * sizeof(double))))
        return RC_OK;
    return rc_err_set(err, "out of memory for a coarser grid");
}

static void *
plan_new(const struct rc_stress_task *task, struct rc_err *err)
{
    const size_t before = rc_memory_held().held;
    RC_OWN(plan, plan) = calloc(1, sizeof *plan);

    if (rc_ranks_need(task->options.ranks, plan != NULL, err, "out of memory for a plan") != RC_OK)
        return NULL;
    plan->task = *task;
    plan->fine = grid_new(&plan->task, &task->shape, err);
    for (size_t k = 0; k < task->sources; k++)
        if (plan->fine == NULL || load(plan->fine, k, task->source[k], err) != RC_OK)
            return NULL;
    return rc_ranks_agree(task->options.ranks, reserve(task, rc_memory_held().held - before, err),
                          err) == RC_OK
               ? rc_give(&plan)
               : NULL;
}

static enum rc_status
slice(void *at, double depth, double *const s[RC_COMPONENTS], struct rc_err *err)
{
    struct plan *plan = at;
    size_t sx, sy;
    bool coarse = may_be_coarse(&plan->task, depth, &sx, &sy);
    struct grid *g = plan->fine;

    if (coarse) {
        if (coarse_new(plan, sx, sy, err) != RC_OK)
            return RC_FAIL;
        g = plan->coarse;
        plan->task.counts->coarse_depths++;
    }
    if ((g->inside == NULL || g->depth != depth) && go_to_depth(g, depth, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < RC_COMPONENTS;) {
        int c[RC_FIELDS];
        double *to[RC_FIELDS];
        size_t n = 0;
        for (; k < RC_COMPONENTS && n < RC_FIELDS; k++)
            if (plan->task.components >> order[k] & 1) {
                c[n] = (int)order[k];
                to[n] = coarse ? plan->field[n] : s[c[n]];
                n++;
            }
        if (n > 0 && make_fields(g, n, c, to, err) != RC_OK)
            return RC_FAIL;
        for (size_t f = 0; coarse && f < n; f++)
            rc_coarse_expand(plan->between, to[f], s[c[f]],
                             plan->task.error == NULL ? NULL : &plan->task.error[c[f]]);
    }
    return RC_OK;
}

static enum rc_status
set_loads(void *at, const double *const source[RC_LOADS], struct rc_err *err)
{
    struct plan *plan = at;

    for (size_t k = 0; k < plan->task.sources; k++) {
        plan->task.source[k] = source[k];
        if (load(plan->fine, k, source[k], err) != RC_OK)
            return RC_FAIL;
        if (plan->coarse == NULL)
            continue;
        rc_coarse_reduce(plan->between, source[k], plan->field[0]);
        if (load(plan->coarse, k, plan->field[0], err) != RC_OK)
            return RC_FAIL;
    }
    return RC_OK;
}

const struct rc_stress_evaluator rc_stress_slices_fft = {
    .new = plan_new,
    .slice = slice,
    .free = plan_free,
    .load = set_loads,
};
