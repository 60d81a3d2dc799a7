/*
 * Sums over all nodes that do not depend on the number of threads: each block or row adds up by
 * itself, and their sums are added in order.
 */
#include "solver.h"

#include <string.h>

static void
total_of(const double *partial, size_t n, double total[RC_SUMS])
{
    memset(total, 0, RC_SUMS * sizeof *total);
    for (size_t b = 0; b < n; b++, partial += RC_SUMS) {
        for (size_t q = 0; q < RC_MOST; q++)
            total[q] += partial[q];
        if (partial[RC_MOST] > total[RC_MOST])
            total[RC_MOST] = partial[RC_MOST];
    }
}

void
rc_reduce_blocks(const struct rc_solver *s, rc_block *block, void *ctx, double total[RC_SUMS])
{
    const size_t size = RC_BLOCK_NODES;
    size_t nodes = s->posed.n, n = (nodes + size - 1) / size;

    memset(s->partial, 0, n * RC_SUMS * sizeof *s->partial);
#pragma omp parallel for num_threads(s->posed.threads) schedule(static)
    for (size_t b = 0; b < n; b++)
        block(ctx, b * size, nodes - b * size < size ? nodes - b * size : size,
              s->partial + b * RC_SUMS);
    total_of(s->partial, n, total);
}

void
rc_reduce_rows_begin(const struct rc_solver *s)
{
    memset(s->partial, 0, s->posed.shape.ny * RC_SUMS * sizeof *s->partial);
}

void
rc_reduce_rows_end(const struct rc_solver *s, double total[RC_SUMS])
{
    total_of(s->partial, s->posed.shape.ny, total);
}
