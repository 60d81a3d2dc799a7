/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Ownership of rows, and sums over ranks that do not depend on where the ranks begin.
 */
#include "ranks.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

/* ---- rows ---- */

size_t
rc_rows_block(size_t nx)
{
    size_t rows = 1;

    /* nx may be 0; other functions refuse such shapes */
    while (nx > 0 && rows <= RC_BLOCK_NODES / nx / 2)
        rows *= 2;
    return rows;
}

size_t
rc_rows_unit(size_t nx)
{
    size_t block = rc_rows_block(nx);

    return block < RC_TILE_ROWS ? RC_TILE_ROWS : block;
}

size_t
rc_rows_dealt(size_t n, size_t unit, size_t count, size_t r)
{
    size_t units = (n + unit - 1) / unit;
    /* units * r / count without overflow */
    size_t first = (units / count * r + units % count * r / count) * unit;

    return first < n ? first : n;
}

struct rc_rows
rc_rows_of(const struct rc_ranks *ranks, const struct rc_shape *whole)
{
    size_t count = rc_ranks_count(ranks), own = rc_ranks_own(ranks), unit = rc_rows_unit(whole->nx);
    struct rc_rows rows = {.ranks = count > 1 ? ranks : NULL, .ny = whole->ny};

    rows.first = rc_rows_dealt(whole->ny, unit, count, own);
    rows.n = rc_rows_dealt(whole->ny, unit, count, own + 1) - rows.first;
    return rows;
}

/* ---- transposition of a map ---- */

/* The largest share of a rank. */
static size_t
most_dealt(const size_t *first, size_t count)
{
    size_t most = 0;

    for (size_t r = 0; r < count; r++)
        most = first[r + 1] - first[r] > most ? first[r + 1] - first[r] : most;
    return most;
}

/* MPI counts units, and offsets within a rank, in ints. Every rank checks the largest share, so that all get
 * the same result. */
static enum rc_status
check_counts(const struct rc_turn *t, struct rc_err *err)
{
    size_t rows = t->row[t->count], columns = t->column[t->count];
    size_t high = most_dealt(t->row, t->count), wide = most_dealt(t->column, t->count);
    double most = fmax((double)high * (double)columns, (double)wide * (double)rows);
    double unit = (double)t->unit / (1 << 30);

    if (most <= INT_MAX)
        return RC_OK;
    return rc_err_set(err,
                      "%zu processes are too few for %zu rows: one of them would exchange %.3g GiB "
                      "at a time, where MPI can count %.3g GiB: start more",
                      t->count, rows, most * unit, INT_MAX * unit);
}

enum rc_status
rc_turn_new(struct rc_turn *t, const struct rc_ranks *ranks, size_t rows, size_t row_unit,
            size_t frame, size_t columns, size_t unit, struct rc_err *err)
{
    size_t count = rc_ranks_count(ranks);

    *t = (struct rc_turn){.ranks = ranks, .count = count, .own = rc_ranks_own(ranks), .unit = unit};
    t->row = malloc(2 * (count + 1) * sizeof *t->row);
    if (t->row == NULL)
        return rc_err_set(err, "out of memory for exchanges between %zu processes", count);
    t->column = t->row + count + 1;
    for (size_t r = 0; r <= count; r++) {
        size_t row = rc_rows_dealt(rows, row_unit, count, r);
        t->row[r] = row + (row > 0 ? frame : 0) + (row == rows ? frame : 0);
        t->column[r] = rc_rows_dealt(columns, 1, count, r);
    }
    return check_counts(t, err);
}

void
rc_turn_free(struct rc_turn *t)
{
    free(t->row);
    t->row = t->column = NULL;
}

void
rc_turn_put(const struct rc_turn *t, size_t j, const void *row, void *pieces)
{
    size_t rows = t->row[t->own + 1] - t->row[t->own];

    for (size_t r = 0; r < t->count; r++) {
        size_t wide = t->column[r + 1] - t->column[r];
        memcpy((char *)pieces + (rows * t->column[r] + j * wide) * t->unit,
               (const char *)row + t->column[r] * t->unit, wide * t->unit);
    }
}

void
rc_turn_get(const struct rc_turn *t, size_t j, const void *pieces, void *row)
{
    size_t rows = t->row[t->own + 1] - t->row[t->own];

    for (size_t r = 0; r < t->count; r++) {
        size_t wide = t->column[r + 1] - t->column[r];
        memcpy((char *)row + t->column[r] * t->unit,
               (const char *)pieces + (rows * t->column[r] + j * wide) * t->unit, wide * t->unit);
    }
}

/* ---- sums ---- */

/* A rank sends its totals, followed by its largest values. */
struct all {
    struct rc_total total[RC_SUMS_MOST];
    double most[RC_MOSTS_MOST];
};
_Static_assert(sizeof(struct all) <= RC_RANKS_ROOM, "RC_RANKS_ROOM is too small");

void
rc_ranks_totals(const struct rc_ranks *ranks, size_t n, const struct rc_total *totals, double *sums,
                size_t mosts, double *most)
{
    const size_t count = rc_ranks_count(ranks), at = n * sizeof *totals,
                 each = at + mosts * sizeof *most;
    struct rc_total sum[RC_SUMS_MOST] = {{0}};
    char own[sizeof(struct all)], *all = count > 1 ? rc_ranks_room(ranks) : own;

    if (n > 0)
        memcpy(own, totals, at);
    if (mosts > 0)
        memcpy(own + at, most, mosts * sizeof *most);
    if (count > 1)
        rc_ranks_gather(ranks, each, own, all);
    for (size_t r = 0; r < count; r++) {
        struct all of;
        memcpy(of.total, all + r * each, at);
        memcpy(of.most, all + r * each + at, mosts * sizeof *most);
        for (size_t k = 0; k < n; k++)
            if (r == 0) {
                sum[k] = of.total[k];
            } else {
                rc_total_add(&sum[k], of.total[k].sum);
                sum[k].lost += of.total[k].lost;
            }
        for (size_t k = 0; k < mosts; k++)
            most[k] = r == 0 || of.most[k] > most[k] ? of.most[k] : most[k];
    }
    for (size_t k = 0; k < n; k++)
        sums[k] = rc_total_value(&sum[k]);
}

double
rc_ranks_total(const struct rc_ranks *ranks, struct rc_total total)
{
    double sum;

    rc_ranks_totals(ranks, 1, &total, &sum, 0, NULL);
    return sum;
}

double
rc_ranks_most(const struct rc_ranks *ranks, double v)
{
    rc_ranks_totals(ranks, 0, NULL, NULL, 1, &v);
    return v;
}

size_t
rc_ranks_sum(const struct rc_ranks *ranks, size_t n)
{
    /* whole numbers below 2^53 */
    return (size_t)rc_ranks_total(ranks, (struct rc_total){.sum = (double)n});
}

double
rc_ranks_sum_before(const struct rc_ranks *ranks, double v)
{
    size_t count = rc_ranks_count(ranks), own = rc_ranks_own(ranks);
    double sum = 0, *all;

    if (count == 1)
        return 0;
    all = rc_ranks_room(ranks);
    rc_ranks_gather(ranks, sizeof v, &v, all);
    for (size_t r = 0; r < own; r++)
        sum += all[r];
    return sum;
}

void
rc_ranks_in_turn(const struct rc_ranks *ranks, rc_ranks_adds *add, const void *ctx, size_t n,
                 double *sums)
{
    const size_t count = rc_ranks_count(ranks), own = rc_ranks_own(ranks);

    for (size_t r = 0; r < count; r++) {
        if (r == own)
            add(ctx, sums);
        if (count > 1)
            rc_ranks_share(ranks, r, n * sizeof *sums, sums);
    }
}

/* ---- sums over a map ---- */

double
rc_ranks_sum_of(const struct rc_ranks *ranks, const double *v, size_t n)
{
    return rc_ranks_total(ranks, rc_total_of(v, n));
}

double
rc_ranks_highest(const struct rc_ranks *ranks, const double *v, size_t n)
{
    return rc_ranks_most(ranks, rc_highest(v, n));
}

double
rc_ranks_distance(const struct rc_ranks *ranks, const double *a, const double *b, size_t n)
{
    return rc_ranks_total(ranks, rc_distance_of(a, b, n));
}

enum rc_status
rc_sums_new(struct rc_sums *s, const struct rc_ranks *ranks, size_t rows, size_t sums, size_t mosts,
            int threads)
{
    *s = (struct rc_sums){
        .rows = rows, .sums = sums, .mosts = mosts, .threads = threads, .ranks = ranks};
    s->row = rc_alloc(rows * (sums + mosts) + 1, sizeof *s->row);
    return s->row != NULL ? RC_OK : RC_FAIL;
}

void
rc_sums_clear(const struct rc_sums *s)
{
    memset(s->row, 0, s->rows * (s->sums + s->mosts) * sizeof *s->row);
}

void
rc_sums_total(const struct rc_sums *s, double *total)
{
    const size_t each = s->sums + s->mosts;
    struct rc_total all[RC_SUMS_MOST];

    for (size_t q = 0; q < s->sums; q++) {
        struct rc_total sum = {0};
        for (size_t j = 0; j < s->rows; j++)
            rc_total_add(&sum, s->row[j * each + q]);
        all[q] = sum;
    }
    for (size_t q = s->sums; q < each; q++) {
        double most = -INFINITY;
        for (size_t j = 0; j < s->rows; j++)
            most = s->row[j * each + q] > most ? s->row[j * each + q] : most;
        total[q] = most;
    }
    rc_ranks_totals(s->ranks, s->sums, all, total, s->mosts, total + s->sums);
}

void
rc_sums_rows(const struct rc_sums *s, rc_sums_work *work, void *ctx, double *total)
{
    rc_sums_clear(s);
#pragma omp parallel for num_threads(s->threads) schedule(static)
    for (size_t j = 0; j < s->rows; j++)
        work(ctx, j, rc_sums_of(s, j));
    rc_sums_total(s, total);
}
