/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Processes that share a map, each with its own rows: the lowest folder, and the only one that uses MPI.
 * Internal: never installed (users include contact_mpi.h).
 *
 * Rank r of P owns whole rows, in units that no tile of the projection (16 rows) and no block of the sums
 * (solver/reduce.c) crosses. If a map has few units, some ranks hold no rows and only take part in collective
 * calls. With NULL for the ranks, and in a build without MPI, one process owns all rows: every function is
 * then empty, and nothing is copied.
 *
 * Results are the same for every P, bit for bit, if one process uses transforms too. Each row and each column
 * is transformed separately with the same plan. Blocks are added in the same order, whichever rank owns them.
 * Their sums are compensated, so that the rounding of the total does not depend on where ranks begin (except
 * for ties: 1 in 1e15).
 *
 * Operations that are not local to rows:
 *
 *   convolutions          each rank transforms its rows, one exchange makes whole columns of them, each rank
 *                         multiplies its columns by those of the spectrum, one exchange back (fft_body.h)
 *   spectra of kernels    the same with the rows of a quarter (fft.c)
 *   sums, largest values  every rank gets the sums of all ranks, and adds them in order (solver/reduce.c)
 *   projection: the load  Newton's method on such sums; the last node that joins by its gap is found by
 *                         bisection on counts (projection.c)
 *   tiles                 a tile is always on one rank; the ranks compare to find the tile with the largest
 *                         reserve (tiles.c)
 *   selection of nodes    depends on eight neighbours: neighbouring rows are fetched (working_set.c)
 *   edge of the contact   the same (result.c)
 *   slip of neighbours    the same (discs.c)
 *   extension             each rank makes its rows of coarser grids, with the neighbouring rows; the first
 *                         grid that is small, or on which a rank would begin with an odd row, is sent to
 *                         all ranks as a whole, and from there on each does the same (pyramid.c)
 *   nested start          rows of the coarser grid are moved to the ranks that own them there; each rank
 *                         solves small grids alone, after a message that all have the memory (nested.c)
 *   padded gap            with adhesion the rows of the map move to the ranks that have them as rows of the
 *                         padded grid, and back (adhesion.c)
 *   cut-off steps         with adhesion the parts within 16 rows of other ranks are fetched (near.c)
 *   patches of contact    labelled row by row, joined across the edges between ranks
 *                         (surface/parameters/patches.c)
 *   coarser grids of      each rank reduces and expands its rows, with those of other ranks within the
 *   stresses              reach of the interpolation (coarse_grid.c)
 *   failures              no rank continues alone: makers agree on their status before any of them returns
 */
#ifndef RC_RANKS_H
#define RC_RANKS_H

#include "libcontact/common.h"

/* ---- rows ---- */

struct rc_rows {
    const struct rc_ranks *ranks; /* NULL: one process holds all rows  */
    size_t ny;                    /* shape of the whole map */
    size_t first, n;              /* held here: first .. first + n - 1 */
};

enum {
    RC_BLOCK_NODES = 4096, /* rows that are summed separately */
    RC_TILE_ROWS = 16,     /* rows that are never split */
    RC_ROW_PIECE = 1024    /* columns of neighbouring rows that are fetched together */
};
/* Rows of nx nodes that make a block; 1 also where a row exceeds a block. */
size_t rc_rows_block(size_t nx);
/* Rows that stay together on one rank. */
size_t rc_rows_unit(size_t nx);
/* The rows of a map that are held here. */
struct rc_rows rc_rows_of(const struct rc_ranks *ranks, const struct rc_shape *whole);
/* n items, in units of `unit`, dealt to `count` ranks: the first one of rank r; r = count: n. */
size_t rc_rows_dealt(size_t n, size_t unit, size_t count, size_t r);

static inline struct rc_shape
rc_rows_shape(const struct rc_rows *rows, const struct rc_shape *whole)
{
    return (struct rc_shape){whole->nx, rows->n, whole->dx, whole->dy};
}

/* The transposition of a map: ranks that hold its rows `row[r]` .. `row[r + 1] - 1` get columns `column[r]`
 * .. `column[r + 1] - 1` of all of them, row by row. On the side of rows each rank stores a piece for every
 * other rank, one after another; columns are in units of `unit` bytes. */
struct rc_turn {
    const struct rc_ranks *ranks;
    size_t count, own, unit;
    size_t *row, *column; /* count + 1 each */
};
/* Rows are dealt in units of row_unit, columns in units of 1. `frame` rows before the first and after the
 * last one, included in `row`, belong to the ranks that have the first and the last row. RC_FAIL on this rank
 * alone when its memory is short. RC_FAIL on all ranks when one of them would hold more than an exchange can
 * count. Call rc_turn_free in either case. */
enum rc_status rc_turn_new(struct rc_turn *turn, const struct rc_ranks *ranks, size_t rows,
                           size_t row_unit, size_t frame, size_t columns, size_t unit,
                           struct rc_err *err);
void rc_turn_free(struct rc_turn *turn);
/* Copies row j (of those held here) to its pieces, or from them. */
void rc_turn_put(const struct rc_turn *turn, size_t j, const void *row, void *pieces);
void rc_turn_get(const struct rc_turn *turn, size_t j, const void *pieces, void *row);

/* ---- communication ---- */

/* The data that this rank has sent. */
struct rc_traffic {
    size_t turns;            /* exchanges of whole maps between rows and columns */
    double turned, messages; /* bytes and messages of these                                     */
    double seconds;          /* in them                                                         */
    double other;            /* bytes of small messages: sums, neighbouring rows, coarser grids */
};

enum {
    RC_SUMS_MOST = 16,  /* numbers that are added at once */
    RC_MOSTS_MOST = 8,  /* numbers of which the largest is found at once */
    RC_RANKS_ROOM = 320 /* bytes of a rank */
};
#ifdef RC_MPI
/* Scratch of `RC_RANKS_ROOM` bytes for each rank, valid until the next call that gathers. */
void *rc_ranks_room(const struct rc_ranks *ranks);
size_t rc_ranks_count(const struct rc_ranks *ranks);
size_t rc_ranks_own(const struct rc_ranks *ranks);
/* all[r] becomes the value of rank r, `bytes` each. */
void rc_ranks_gather(const struct rc_ranks *ranks, size_t bytes, const void *own, void *all);
/* All ranks get the value of rank `root`. */
void rc_ranks_share(const struct rc_ranks *ranks, size_t root, size_t bytes, void *v);
/* RC_OK when `status` is RC_OK on all ranks; else RC_FAIL on all, with the sentence of the first rank that
 * failed. */
enum rc_status rc_ranks_agree(const struct rc_ranks *ranks, enum rc_status status,
                              struct rc_err *err);
/* In place, of each of n values: the largest, or the sum of whole numbers below 2^53. */
void rc_ranks_each_most(const struct rc_ranks *ranks, size_t n, double *v);
void rc_ranks_each_sum(const struct rc_ranks *ranks, size_t n, double *v);
/* Pieces to columns, or, `back`, columns to pieces. */
void rc_ranks_turn(const struct rc_turn *turn, bool back, const void *from, void *to);
/* Moves rows of `bytes`. Before, rank r holds the rows from[r] .. from[r + 1] - 1; afterwards it holds
 * to[r] .. to[r + 1] - 1 + more, but none beyond the last row. NULL: all rows. */
void rc_ranks_move(const struct rc_ranks *ranks, size_t bytes, const size_t *from, const size_t *to,
                   size_t more, const void *v, void *w);
/* The same, but afterwards rank r holds the n[r] rows from first[r] on. The first row follows the last one,
 * and the rows of several ranks may overlap. n[r] is at most the number of all rows. */
void rc_ranks_fetch(const struct rc_ranks *ranks, size_t bytes, const size_t *from,
                    const size_t *first, const size_t *n, const void *v, void *w);
/* The row before the first one held here and the one after the last. False where there is none: at the ends
 * of the map, unless it is periodic (`round`). Ranks without rows take part. */
void rc_ranks_beside(const struct rc_rows *rows, bool round, size_t bytes, const void *first,
                     const void *last, void *before, void *after, bool has[2]);
#else
static inline void
rc_ranks_each_most(const struct rc_ranks *ranks, size_t n, double *v)
{
    (void)ranks, (void)n, (void)v;
}

static inline void
rc_ranks_each_sum(const struct rc_ranks *ranks, size_t n, double *v)
{
    (void)ranks, (void)n, (void)v;
}

static inline size_t
rc_ranks_count(const struct rc_ranks *ranks)
{
    (void)ranks;
    return 1;
}

static inline size_t
rc_ranks_own(const struct rc_ranks *ranks)
{
    (void)ranks;
    return 0;
}

static inline void
rc_ranks_gather(const struct rc_ranks *ranks, size_t bytes, const void *own, void *all)
{
    (void)ranks;
    __builtin_memcpy(all, own, bytes);
}

static inline void
rc_ranks_share(const struct rc_ranks *ranks, size_t root, size_t bytes, void *v)
{
    (void)ranks, (void)root, (void)bytes, (void)v;
}

static inline enum rc_status
rc_ranks_agree(const struct rc_ranks *ranks, enum rc_status status, struct rc_err *err)
{
    (void)ranks, (void)err;
    return status;
}

static inline void
rc_ranks_move(const struct rc_ranks *ranks, size_t bytes, const size_t *from, const size_t *to,
              size_t more, const void *v, void *w)
{
    (void)ranks, (void)to, (void)more;
    __builtin_memcpy(w, v, (from[1] - from[0]) * bytes);
}

/* These two functions are not reached with one rank. */
static inline void
rc_ranks_fetch(const struct rc_ranks *ranks, size_t bytes, const size_t *from, const size_t *first,
               const size_t *n, const void *v, void *w)
{
    (void)ranks, (void)bytes, (void)from, (void)first, (void)n, (void)v, (void)w;
}

static inline void *
rc_ranks_room(const struct rc_ranks *ranks)
{
    (void)ranks;
    return NULL;
}

static inline void
rc_ranks_turn(const struct rc_turn *turn, bool back, const void *from, void *to)
{
    (void)turn, (void)back, (void)from, (void)to;
}

static inline void
rc_ranks_beside(const struct rc_rows *rows, bool round, size_t bytes, const void *first,
                const void *last, void *before, void *after, bool has[2])
{
    (void)rows, (void)round, (void)bytes, (void)first, (void)last, (void)before, (void)after;
    has[0] = has[1] = false;
}
#endif

/* RC_OK if `has` is true on all ranks, of memory for example; else RC_FAIL on all, with this sentence. */
#define rc_ranks_need(ranks, has, err, ...)                                                        \
    rc_ranks_agree(ranks, (has) ? RC_OK : rc_err_set(err, __VA_ARGS__), err)

/* The sum over all ranks, independent of their number; the largest value; the sum of counts. */
double rc_ranks_total(const struct rc_ranks *ranks, struct rc_total total);
double rc_ranks_most(const struct rc_ranks *ranks, double v);
size_t rc_ranks_sum(const struct rc_ranks *ranks, size_t n);
/* The sum over the ranks before this one. */
double rc_ranks_sum_before(const struct rc_ranks *ranks, double v);
/* Several totals, and in place the largest of several more values, at once. */
void rc_ranks_totals(const struct rc_ranks *ranks, size_t n, const struct rc_total *totals,
                     double *sums, size_t mosts, double *most);

/* Adds to n sums, rank after rank, what `add` adds for the rows held here: the order, and so the rounding, is
 * that of one process. Each rank waits for those before it; for figures, not for iterations. */
typedef void rc_ranks_adds(const void *ctx, double *sums);
void rc_ranks_in_turn(const struct rc_ranks *ranks, rc_ranks_adds *add, const void *ctx, size_t n,
                      double *sums);

/* ---- sums over a map ---- */

/* rc_sum, rc_highest and rc_distance of the n values that each rank holds. */
double rc_ranks_sum_of(const struct rc_ranks *ranks, const double *v, size_t n);
double rc_ranks_highest(const struct rc_ranks *ranks, const double *v, size_t n);
double rc_ranks_distance(const struct rc_ranks *ranks, const double *a, const double *b, size_t n);

/* Sums over a map that depend neither on the number of threads and ranks nor on the owner of a row. Each row
 * is summed separately, and the rows are added in their order, with compensation for rounding. A row has
 * `sums` numbers to add, and after them `mosts` numbers to take the largest of. */
struct rc_sums {
    double *row;
    size_t rows, sums, mosts; /* rows: of this rank */
    int threads;
    const struct rc_ranks *ranks; /* NULL: none */
};

/* RC_FAIL: memory is short on this rank; free(sums.row) in either case. */
enum rc_status rc_sums_new(struct rc_sums *s, const struct rc_ranks *ranks, size_t rows,
                           size_t sums, size_t mosts, int threads);
/* The numbers of row j: 0 after rc_sums_clear. */
static inline double *
rc_sums_of(const struct rc_sums *s, size_t j)
{
    return s->row + j * (s->sums + s->mosts);
}
void rc_sums_clear(const struct rc_sums *s);
/* The totals over all ranks as numbers, followed by the largest numbers. */
void rc_sums_total(const struct rc_sums *s, double *total);
/* Clears the sums, calls the function of each row, and totals the sums. */
typedef void rc_sums_work(void *ctx, size_t j, double *sums);
void rc_sums_rows(const struct rc_sums *s, rc_sums_work *work, void *ctx, double *total);

#endif
