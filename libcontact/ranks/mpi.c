/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Communication between ranks, by MPI. Only the thread that made the ranks calls these functions.
 */
#include <assert.h>
#include <limits.h>
#include <mpi.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/contact_mpi.h"
#include "ranks.h"

struct rc_ranks {
    MPI_Comm comm;
    size_t count, own;
    int *number;                /* scratch: 4 * count                     */
    struct rc_traffic *traffic; /* changed even where the ranks are const */
    void *room;                 /* RC_RANKS_ROOM * count                  */
};

struct rc_ranks *
rc_ranks_new(MPI_Comm comm, struct rc_err *err)
{
    struct rc_ranks *r = calloc(1, sizeof *r);
    int count, own, fine;

    MPI_Comm_size(comm, &count);
    MPI_Comm_rank(comm, &own);
    if (r != NULL) {
        r->number = malloc(4 * (size_t)count * sizeof *r->number);
        r->traffic = calloc(1, sizeof *r->traffic);
        r->room = malloc(RC_RANKS_ROOM * (size_t)count);
        r->count = (size_t)count;
        r->own = (size_t)own;
    }
    fine = r != NULL && r->number != NULL && r->traffic != NULL && r->room != NULL;
    MPI_Allreduce(MPI_IN_PLACE, &fine, 1, MPI_INT, MPI_MIN, comm);
    if (!fine) {
        rc_err_set(err, "out of memory for %d processes that share a map", count);
        if (r != NULL) {
            free(r->number);
            free(r->traffic);
            free(r->room);
        }
        free(r);
        return NULL;
    }
    MPI_Comm_dup(comm, &r->comm);
    return r;
}

void
rc_ranks_free(struct rc_ranks *r)
{
    if (r == NULL)
        return;
    MPI_Comm_free(&r->comm);
    free(r->number);
    free(r->traffic);
    free(r->room);
    free(r);
}

void
rc_ranks_rows(const struct rc_ranks *r, const struct rc_shape *whole, size_t *first, size_t *n)
{
    struct rc_rows rows = rc_rows_of(r, whole);

    *first = rows.first;
    *n = rows.n;
}

size_t
rc_ranks_count(const struct rc_ranks *r)
{
    return r == NULL ? 1 : r->count;
}

size_t
rc_ranks_own(const struct rc_ranks *r)
{
    return r == NULL ? 0 : r->own;
}

void
rc_ranks_sent(const struct rc_ranks *r, struct rc_sent *sent)
{
    double all[3] = {r->traffic->messages, r->traffic->turned, r->traffic->other}, seconds;

    MPI_Allreduce(MPI_IN_PLACE, all, 3, MPI_DOUBLE, MPI_SUM, r->comm);
    MPI_Allreduce(&r->traffic->seconds, &seconds, 1, MPI_DOUBLE, MPI_MAX, r->comm);
    *sent = (struct rc_sent){r->traffic->turns, all[0], all[1], all[2], seconds};
}

void *
rc_ranks_room(const struct rc_ranks *r)
{
    return r->room;
}

static bool
alone(const struct rc_ranks *r)
{
    return r == NULL || r->count == 1;
}

/* ---- sums, gathering and broadcast ---- */

void
rc_ranks_gather(const struct rc_ranks *r, size_t bytes, const void *own, void *all)
{
    if (alone(r)) {
        memcpy(all, own, bytes);
        return;
    }
    MPI_Allgather(own, (int)bytes, MPI_BYTE, all, (int)bytes, MPI_BYTE, r->comm);
    r->traffic->other += (double)(bytes * (r->count - 1));
}

void
rc_ranks_share(const struct rc_ranks *r, size_t root, size_t bytes, void *v)
{
    if (alone(r))
        return;
    MPI_Bcast(v, (int)bytes, MPI_BYTE, (int)root, r->comm);
    r->traffic->other += r->own == root ? (double)(bytes * (r->count - 1)) : 0;
}

static void
reduce(const struct rc_ranks *r, size_t n, double *v, MPI_Op op)
{
    if (alone(r))
        return;
    for (size_t at = 0; at < n; at += INT_MAX)
        MPI_Allreduce(MPI_IN_PLACE, v + at, n - at < INT_MAX ? (int)(n - at) : INT_MAX, MPI_DOUBLE,
                      op, r->comm);
    r->traffic->other += (double)(n * sizeof *v);
}

void
rc_ranks_each_most(const struct rc_ranks *r, size_t n, double *v)
{
    reduce(r, n, v, MPI_MAX);
}

void
rc_ranks_each_sum(const struct rc_ranks *r, size_t n, double *v)
{
    reduce(r, n, v, MPI_SUM);
}

enum rc_status
rc_ranks_agree(const struct rc_ranks *r, enum rc_status status, struct rc_err *err)
{
    struct rc_err text = {""};
    int first;

    if (alone(r))
        return status;
    first = status == RC_FAIL ? (int)r->own : INT_MAX;
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, r->comm);
    if (first == INT_MAX)
        return status;
    if (err != NULL && r->own == (size_t)first)
        text = *err;
    MPI_Bcast(&text, sizeof text, MPI_BYTE, first, r->comm);
    if (err != NULL)
        *err = text;
    return RC_FAIL;
}

/* ---- maps ---- */

enum {
    PIECE = 1 << 30 /* bytes of a row per message: MPI counts in ints */
};

/* A type of this many bytes, so that counts fit an int. A row of 2^28 numbers has 2^31 bytes, one more
 * than an int holds. */
static MPI_Datatype
type_of(size_t bytes)
{
    const bool wide = bytes % sizeof(uint64_t) == 0;
    const size_t count = wide ? bytes / sizeof(uint64_t) : bytes;
    MPI_Datatype type;

    assert(count <= INT_MAX);
    MPI_Type_contiguous((int)count, wide ? MPI_UINT64_T : MPI_BYTE, &type);
    MPI_Type_commit(&type);
    return type;
}

void
rc_ranks_turn(const struct rc_turn *t, bool back, const void *from, void *to)
{
    const struct rc_ranks *r = t->ranks;
    int *pieces = r->number, *at = pieces + r->count, *columns = at + r->count,
        *from_row = columns + r->count;
    size_t rows = t->row[t->own + 1] - t->row[t->own];
    size_t wide = t->column[t->own + 1] - t->column[t->own];
    MPI_Datatype type = type_of(t->unit);
    double began = MPI_Wtime();

    for (size_t q = 0; q < r->count; q++) {
        size_t theirs = t->column[q + 1] - t->column[q], height = t->row[q + 1] - t->row[q];
        size_t out = back ? height * wide : rows * theirs;
        pieces[q] = (int)(rows * theirs);
        at[q] = (int)(rows * t->column[q]);
        columns[q] = (int)(height * wide);
        from_row[q] = (int)(t->row[q] * wide);
        if (q == t->own || out == 0)
            continue;
        r->traffic->turned += (double)out * (double)t->unit;
        r->traffic->messages++;
    }
    r->traffic->turns++;
    if (back)
        MPI_Alltoallv(from, columns, from_row, type, to, pieces, at, type, r->comm);
    else
        MPI_Alltoallv(from, pieces, at, type, to, columns, from_row, type, r->comm);
    MPI_Type_free(&type);
    r->traffic->seconds += MPI_Wtime() - began;
}

/* Items first .. end - 1. */
struct range {
    size_t first, end;
};

static struct range
common(struct range a, struct range b)
{
    struct range c = {a.first > b.first ? a.first : b.first, a.end < b.end ? a.end : b.end};

    return c.first < c.end ? c : (struct range){0, 0};
}

/* Rank q holds items first[q] .. first[q + 1] - 1, and `more` after them; NULL: all. With n it holds the n[q]
 * items from first[q] on, the first item after the last one: those before that, or those after it. */
struct deal {
    const size_t *first, *n;
    size_t more;
    bool round;
};

static struct range
range_of(const struct deal *deal, size_t all, size_t q)
{
    const size_t first = deal->first == NULL ? 0 : deal->first[q];
    size_t end;

    if (deal->first == NULL)
        return (struct range){0, all};
    if (deal->n == NULL)
        return (struct range){first, deal->first[q + 1] + deal->more};
    end = first + deal->n[q];
    if (deal->round)
        return (struct range){0, end > all ? end - all : 0};
    return (struct range){first, end < all ? end : all};
}

/* Moves the items in `part`, whose number fits an int. */
static void
move_part(const struct rc_ranks *r, struct range part, size_t bytes, const size_t *from,
          const struct deal *to, const void *v, void *w)
{
    int *out = r->number, *out_at = out + r->count, *in = out_at + r->count, *in_at = in + r->count;
    const size_t all = from[r->count];
    const struct deal by = {.first = from};
    struct range held = range_of(&by, all, r->own), wanted = range_of(to, all, r->own);
    struct range out_part = common(held, part), in_part = common(wanted, part);
    MPI_Datatype type = type_of(bytes);

    for (size_t q = 0; q < r->count; q++) {
        struct range goes = common(out_part, range_of(to, all, q));
        struct range comes = common(in_part, range_of(&by, all, q));
        out[q] = (int)(goes.end - goes.first);
        out_at[q] = out[q] > 0 ? (int)(goes.first - out_part.first) : 0;
        in[q] = (int)(comes.end - comes.first);
        in_at[q] = in[q] > 0 ? (int)(comes.first - in_part.first) : 0;
        if (q != r->own)
            r->traffic->other += (double)out[q] * (double)bytes;
    }
    if (out_part.end > 0)
        v = (const char *)v + (out_part.first - held.first) * bytes;
    if (in_part.end > 0)
        w = (char *)w + (in_part.first - wanted.first) * bytes;
    MPI_Alltoallv(v, out, out_at, type, w, in, in_at, type, r->comm);
    MPI_Type_free(&type);
}

static void
move(const struct rc_ranks *r, size_t bytes, const size_t *from, const struct deal *to,
     const void *v, void *w)
{
    size_t all = from[r->count];

    for (size_t at = 0; at < all; at += INT_MAX)
        move_part(r, (struct range){at, all - at < INT_MAX ? all : at + INT_MAX}, bytes, from, to,
                  v, w);
}

void
rc_ranks_move(const struct rc_ranks *r, size_t bytes, const size_t *from, const size_t *to,
              size_t more, const void *v, void *w)
{
    move(r, bytes, from, &(struct deal){.first = to, .more = more}, v, w);
}

void
rc_ranks_fetch(const struct rc_ranks *r, size_t bytes, const size_t *from, const size_t *first,
               const size_t *n, const void *v, void *w)
{
    struct deal to = {.first = first, .n = n};
    const struct range before = range_of(&to, from[r->count], r->own);

    move(r, bytes, from, &to, v, w);
    to.round = true;
    move(r, bytes, from, &to, v, (char *)w + (before.end - before.first) * bytes);
}

/* The next rank with rows in this direction, or this rank when there is no other. */
static int
neighbour(const struct rc_ranks *r, const int *has, int step)
{
    int count = (int)r->count, q = (int)r->own;

    do
        q = (q + step + count) % count;
    while (has[q] == 0 && q != (int)r->own);
    return q;
}

void
rc_ranks_beside(const struct rc_rows *rows, bool round, size_t bytes, const void *first,
                const void *last, void *before, void *after, bool has[2])
{
    const struct rc_ranks *r = rows->ranks;
    int own = rows->n > 0, above, below;
    MPI_Request request[4];
    size_t n;

    has[0] = own && (round || rows->first > 0);
    has[1] = own && (round || rows->first + rows->n < rows->ny);
    MPI_Allgather(&own, 1, MPI_INT, r->number, 1, MPI_INT, r->comm);
    if (!own)
        return;
    above = neighbour(r, r->number, -1);
    below = neighbour(r, r->number, 1);
    /* also between the ends of a free map, where the result is not used */
    for (size_t at = 0; at < bytes; at += n) {
        n = bytes - at < PIECE ? bytes - at : PIECE;
        MPI_Irecv((char *)before + at, (int)n, MPI_BYTE, above, 1, r->comm, &request[0]);
        MPI_Irecv((char *)after + at, (int)n, MPI_BYTE, below, 2, r->comm, &request[1]);
        MPI_Isend((const char *)last + at, (int)n, MPI_BYTE, below, 1, r->comm, &request[2]);
        MPI_Isend((const char *)first + at, (int)n, MPI_BYTE, above, 2, r->comm, &request[3]);
        MPI_Waitall(4, request, MPI_STATUSES_IGNORE);
    }
    r->traffic->other += 2 * (double)bytes;
}
