/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Sums over all nodes that depend neither on the number of threads nor on the number of ranks. Each block or
 * row is summed separately. These sums are added in a fixed order with compensation for rounding. A block is
 * some rows, or a part of one row, on one rank.
 */
#include "solver.h"

#include <string.h>

static void
total_of(const struct rc_solver *s, size_t n, double total[RC_SUMS])
{
    const struct rc_sums rows = {.row = s->partial,
                                 .rows = n,
                                 .sums = RC_MOST,
                                 .mosts = RC_SUMS - RC_MOST,
                                 .threads = s->posed.threads,
                                 .ranks = s->posed.rows.ranks};

    rc_sums_total(&rows, total);
    total[RC_MOST] = fmax(total[RC_MOST], 0);
}

void
rc_reduce_blocks(const struct rc_solver *s, rc_block *block, void *ctx, double total[RC_SUMS])
{
    size_t nx = s->posed.shape.nx, rows = rc_rows_block(nx);
    size_t size = rows > 1 || nx <= RC_BLOCK_NODES ? rows * nx : RC_BLOCK_NODES;
    size_t parts = (rows * nx + size - 1) / size; /* blocks of a row that is longer than a block */
    size_t n = (s->posed.shape.ny + rows - 1) / rows * parts;

    memset(s->partial, 0, n * RC_SUMS * sizeof *s->partial);
#pragma omp parallel for num_threads(s->posed.threads) schedule(static)
    for (size_t b = 0; b < n; b++) {
        size_t first = b / parts * rows * nx + b % parts * size;
        size_t end = parts == 1 ? s->posed.n : (b / parts + 1) * nx;
        block(ctx, first, end - first < size ? end - first : size, s->partial + b * RC_SUMS);
    }
    total_of(s, n, total);
}

size_t
rc_reduce_partials(const struct rc_shape *shape)
{
    /* at most the number of rows, or of their parts */
    return shape->ny * (shape->nx / RC_BLOCK_NODES + 1) + 1;
}

void
rc_reduce_rows_begin(const struct rc_solver *s)
{
    memset(s->partial, 0, s->posed.shape.ny * RC_SUMS * sizeof *s->partial);
}

void
rc_reduce_rows_end(const struct rc_solver *s, double total[RC_SUMS])
{
    total_of(s, s->posed.shape.ny, total);
}
