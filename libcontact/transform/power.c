/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Rows are transformed as they arrive and stored as complex numbers. Then columns are transformed a few at a
 * time, two cache lines of each row. Columns are never written back whole. Of a spectrum only the squares are
 * written, of an autocorrelation only the rows of y >= 0, which replace the rows of the map.
 */
#include "power.h"

#include <complex.h>
#include <fftw3.h> /* after complex.h: fftw_complex is then double complex */
#include <limits.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "fourier.h"
#include "libcontact/common.h"
#include "libcontact/memory.h"
#include "planner.h"

enum {
    COLUMNS = 8 /* processed together */
};

struct work {
    struct rc_shape shape;
    struct rc_offsets at; /* mx = my = 0: only the spectrum        */
    size_t columns;       /* complex numbers of a row              */
    size_t lane;          /* complex numbers of scratch per column */
    int threads;
    rc_map_row *row;
    const void *map;
    double complex *rows; /* ny rows of `columns`                         */
    double complex *room; /* COLUMNS columns and one more for each thread */
    double *line;         /* px values for each thread                    */
    struct rc_line *along_x;
    fftw_plan down, back; /* plans of a column: its waves, and the sums of their squares */
};

/* Scratch of a row in doubles, of a column in complex numbers: whole cache lines. */
static size_t
whole_lines(size_t n)
{
    return (n + 7) / 8 * 8;
}

static void
work_free(struct work *w)
{
    rc_planner_lock();
    fftw_destroy_plan(w->down);
    fftw_destroy_plan(w->back);
    rc_planner_unlock();
    rc_line_free(w->along_x);
    free(w->line);
    free(w->room);
    free(w->rows);
}

static enum rc_status
work_new(struct work *w, const struct rc_shape *shape, const struct rc_offsets *at, rc_map_row *row,
         const void *map, size_t threads, struct rc_err *err)
{
    size_t team;

    *w = (struct work){.shape = *shape,
                       .at = *at,
                       .columns = at->px / 2 + 1,
                       .lane = whole_lines(at->py),
                       .threads = rc_useful_threads(shape, threads),
                       .row = row,
                       .map = map};
    if (at->px > INT_MAX || at->py > INT_MAX)
        return rc_err_set(err, "%zu x %zu nodes: a side is too long for a Fourier transform",
                          shape->nx, shape->ny);
    team = (size_t)w->threads;
    w->rows = rc_alloc(shape->ny * w->columns, sizeof *w->rows);
    w->room = rc_alloc(team * (COLUMNS + 1) * w->lane, sizeof *w->room);
    w->line = rc_alloc(team * whole_lines(at->px), sizeof *w->line);
    w->along_x = rc_line_new(at->px, team, err);
    if (w->rows != NULL && w->room != NULL) {
        rc_planner_lock();
        w->down = fftw_plan_dft_1d((int)at->py, w->room, w->room, FFTW_FORWARD, FFTW_ESTIMATE);
        w->back =
            fftw_plan_dft_r2c_1d((int)at->py, (double *)w->room, w->room + w->lane, FFTW_ESTIMATE);
        rc_planner_unlock();
    }
    if (w->rows == NULL || w->room == NULL || w->line == NULL || w->along_x == NULL ||
        w->down == NULL || w->back == NULL)
        return rc_err_set(err, "out of memory for the waves of %zu x %zu nodes", shape->nx,
                          shape->ny);
    return RC_OK;
}

static double *
line_of(const struct work *w)
{
    return w->line + (size_t)omp_get_thread_num() * whole_lines(w->at.px);
}

static void
transform_rows(const struct work *w)
{
#pragma omp parallel for num_threads(w->threads) schedule(static)
    for (size_t j = 0; j < w->shape.ny; j++) {
        double *line = line_of(w);
        w->row(w->map, j, line);
        memset(line + w->shape.nx, 0, (w->at.px - w->shape.nx) * sizeof *line);
        rc_line_forward(w->along_x, line, w->rows + j * w->columns);
    }
}

/* The squares of a column's waves, py numbers, over its first ny values in `v`. */
static double *
squares(const struct work *w, double complex *v)
{
    double *power = (double *)v;

    memset(v + w->shape.ny, 0, (w->at.py - w->shape.ny) * sizeof *v);
    fftw_execute_dft(w->down, v, v);
    for (size_t j = 0; j < w->at.py; j++)
        power[j] = creal(v[j]) * creal(v[j]) + cimag(v[j]) * cimag(v[j]);
    return power;
}

/* The columns from `first` on that are processed together: into `power` or, if it is NULL, back as rows of
 * sums. */
static void
transform_columns(const struct work *w, size_t first, double *power)
{
    double complex *room = w->room + (size_t)omp_get_thread_num() * (COLUMNS + 1) * w->lane;
    size_t n = w->columns - first < COLUMNS ? w->columns - first : COLUMNS;

    for (size_t j = 0; j < w->shape.ny; j++)
        for (size_t k = 0; k < n; k++)
            room[(k + 1) * w->lane + j] = w->rows[j * w->columns + first + k];
    for (size_t k = 0; k < n; k++) {
        double complex *column = room + (k + 1) * w->lane;
        double *of = squares(w, column);
        if (power != NULL)
            memcpy(power + (first + k) * w->shape.ny, of, w->shape.ny * sizeof *of);
        else
            /* into the column before, which is no longer needed, or into the extra one */
            fftw_execute_dft_r2c(w->back, of, column - w->lane);
    }
    for (size_t j = 0; power == NULL && j <= w->at.my && j < w->shape.ny; j++)
        for (size_t k = 0; k < n; k++)
            w->rows[j * w->columns + first + k] = conj(room[k * w->lane + j]);
}

static void
transform_all_columns(const struct work *w, double *power)
{
#pragma omp parallel for num_threads(w->threads) schedule(dynamic)
    for (size_t i = 0; i < w->columns; i += COLUMNS)
        transform_columns(w, i, power);
}

enum rc_status
rc_power(const struct rc_shape *shape, rc_map_row *row, const void *map, size_t threads,
         double *power, struct rc_err *err)
{
    const struct rc_offsets at = {.px = shape->nx, .py = shape->ny};
    RC_ENDS(work_free) struct work w = {0};

    if (work_new(&w, shape, &at, row, map, threads, err) != RC_OK)
        return RC_FAIL;
    transform_rows(&w);
    transform_all_columns(&w, power);
    return RC_OK;
}

enum rc_status
rc_autocorrelate(const struct rc_shape *shape, const struct rc_offsets *at, rc_map_row *row,
                 const void *map, size_t threads, double *sums, struct rc_err *err)
{
    double scale = 1 / ((double)at->px * (double)at->py);
    RC_ENDS(work_free) struct work w = {0};

    if (work_new(&w, shape, at, row, map, threads, err) != RC_OK)
        return RC_FAIL;
    transform_rows(&w);
    transform_all_columns(&w, NULL);
#pragma omp parallel for num_threads(w.threads) schedule(static)
    for (size_t j = 0; j <= at->my; j++) {
        double *line = line_of(&w), *out = sums + j * (2 * at->mx + 1);
        rc_line_backward(w.along_x, w.rows + j * w.columns, line);
        for (size_t i = 0; i < 2 * at->mx + 1; i++)
            out[i] = scale * line[(i + at->px - at->mx) % at->px];
    }
    return RC_OK;
}
