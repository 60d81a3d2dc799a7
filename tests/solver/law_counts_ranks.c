/* SPDX-License-Identifier: GPL-3.0-or-later */
/* MPI counts in ints. A size that one rank cannot count is refused on all ranks, and a size that can be sent
 * in pieces is sent. The test allocates no map: it records messages instead of sending them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/contact_mpi.h"
#include "libcontact/ranks/ranks.h"

static struct rc_ranks *ranks;

/* ---- messages that are recorded ---- */

static struct {
    bool noting;
    size_t calls, sent, received; /* bytes, or things */
    const char *next;             /* bytes sent, where no part was omitted or sent twice */
    bool wrong;                   /* a count or an offset is negative, or a gap remains */
} note;

static void
note_sent(const void *from, int count)
{
    note.wrong |= count < 0 || (note.next != NULL && from != note.next);
    note.next = (const char *)from + count;
    note.sent += (size_t)count;
}

int
MPI_Isend(const void *from, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm,
          MPI_Request *request)
{
    if (!note.noting)
        return PMPI_Isend(from, count, type, to, tag, comm, request);
    *request = MPI_REQUEST_NULL;
    note.calls++;
    if (tag == 1)
        note_sent(from, count);
    return MPI_SUCCESS;
}

int
MPI_Irecv(void *to, int count, MPI_Datatype type, int from, int tag, MPI_Comm comm,
          MPI_Request *request)
{
    if (!note.noting)
        return PMPI_Irecv(to, count, type, from, tag, comm, request);
    *request = MPI_REQUEST_NULL;
    note.wrong |= count < 0;
    note.received += tag == 1 ? (size_t)count : 0;
    return MPI_SUCCESS;
}

int
MPI_Alltoallv(const void *from, const int out[], const int out_at[], MPI_Datatype out_type,
              void *to, const int in[], const int in_at[], MPI_Datatype in_type, MPI_Comm comm)
{
    if (!note.noting)
        return PMPI_Alltoallv(from, out, out_at, out_type, to, in, in_at, in_type, comm);
    note.calls++;
    for (size_t q = 0; q < rc_ranks_count(ranks); q++) {
        note.wrong |= out[q] < 0 || out_at[q] < 0 || in[q] < 0 || in_at[q] < 0;
        note.sent += (size_t)out[q];
        note.received += (size_t)in[q];
    }
    return MPI_SUCCESS;
}

int
MPI_Allreduce(const void *from, void *to, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
    if (!note.noting)
        return PMPI_Allreduce(from, to, count, type, op, comm);
    note.calls++;
    note.wrong |= count < 0 || (note.next != NULL && (const char *)to != note.next);
    note.next = (const char *)to + (size_t)count * sizeof(double);
    note.sent += (size_t)count;
    return MPI_SUCCESS;
}

static void
begin_noting(void)
{
    memset(&note, 0, sizeof note);
    note.noting = true;
}

/* ---- exchanges ---- */

/* With this number of columns the last rank has one more than the others, and only this rank has too many. */
static void
fullest_rank_decides(void **state)
{
    const size_t count = rc_ranks_count(ranks), rows = 1 << 16, columns = 32767 * count;
    struct rc_turn turn;
    struct rc_err err = {""};

    (void)state;
    assert_int_equal(rc_turn_new(&turn, ranks, rows, 1, 0, columns, 128, &err), RC_OK);
    assert_true((turn.column[turn.own + 1] - turn.column[turn.own]) * rows <= INT_MAX);
    rc_turn_free(&turn);
    assert_int_equal(rc_turn_new(&turn, ranks, rows, 1, 0, columns + 1, 128, &err), RC_FAIL);
    rc_turn_free(&turn);
    assert_non_null(strstr(err.text, "one of them would exchange 256 GiB"));
    assert_non_null(strstr(err.text, "start more"));
    assert_null(strstr(err.text, "memory"));
}

/* Rows are distributed in units: a rank without rows gets the same result as the rank with all rows. */
static void
rows_count_too(void **state)
{
    const size_t rows = 16, columns = (size_t)1 << 27;
    struct rc_turn turn;
    struct rc_err err = {""};

    (void)state;
    assert_int_equal(rc_turn_new(&turn, ranks, rows, 16, 0, columns - 1, 16, &err), RC_OK);
    rc_turn_free(&turn);
    assert_int_equal(rc_turn_new(&turn, ranks, rows, 16, 0, columns, 16, &err), RC_FAIL);
    rc_turn_free(&turn);
    assert_non_null(strstr(err.text, "start more"));
}

/* Too large for these ranks and for any memory: the reason is not that memory is short. */
static void
sizes_beyond_all(void **state)
{
    const size_t side = (size_t)1 << (sizeof side > 4 ? 28 : 20);
    struct rc_turn turn;
    struct rc_err err = {""};

    (void)state;
    assert_int_equal(rc_turn_new(&turn, ranks, side, 16, 0, side, 128, &err), RC_FAIL);
    rc_turn_free(&turn);
    assert_non_null(strstr(err.text, "start more"));
}

/* ---- rows and lists ---- */

static void
long_rows_beside(void **state)
{
    static const size_t sizes[] = {8, INT_MAX, (size_t)INT_MAX + 1, ((size_t)5 << 30) + 3};
    const struct rc_rows rows = {ranks, 32 * rc_ranks_count(ranks), 32 * rc_ranks_own(ranks), 32};
    char at;

    (void)state;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        bool has[2];
        begin_noting();
        rc_ranks_beside(&rows, true, sizes[k], &at, &at, &at, &at, has);
        note.noting = false;
        assert_false(note.wrong);
        assert_true(note.sent == sizes[k] && note.received == sizes[k]);
        assert_int_equal(note.calls, 2 * (sizes[k] / (1 << 30) + (sizes[k] % (1 << 30) != 0)));
    }
}

static void
long_sums(void **state)
{
    static const size_t sizes[] = {0, 5, INT_MAX, (size_t)INT_MAX + 1, (size_t)3 * INT_MAX};
    double v;

    (void)state;
    if (rc_ranks_count(ranks) == 1)
        skip();
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        begin_noting();
        rc_ranks_each_sum(ranks, sizes[k], &v);
        note.noting = false;
        assert_false(note.wrong);
        assert_int_equal(note.calls, sizes[k] / INT_MAX + (sizes[k] % INT_MAX != 0));
        assert_true(note.sent == sizes[k]);
    }
}

/* Rank r holds `each` + r items; the receiver wants all of them, or the same number from every rank. */
static void
long_lists(void **state)
{
    const size_t count = rc_ranks_count(ranks), own = rc_ranks_own(ranks);
    static const size_t sizes[] = {0, 5, INT_MAX, (size_t)INT_MAX + 1, (size_t)3 * INT_MAX};
    size_t *from = calloc(2 * (count + 1), sizeof *from), *to = from + count + 1;
    char at;

    (void)state;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        size_t pieces;
        for (size_t q = 0; q < count; q++) {
            from[q + 1] = from[q] + sizes[k] + q;
            to[count - q] = 0; /* the last rank wants all, the others nothing */
        }
        to[count] = from[count];
        pieces = from[count] / INT_MAX + (from[count] % INT_MAX != 0);
        begin_noting();
        rc_ranks_move(ranks, 32, from, to, 0, &at, &at);
        note.noting = false;
        assert_false(note.wrong);
        assert_int_equal(note.calls, pieces);
        assert_int_equal(note.sent, sizes[k] + own);
        assert_int_equal(note.received, own + 1 == count ? from[count] : 0);
        begin_noting();
        rc_ranks_move(ranks, 32, from, NULL, 0, &at, &at);
        note.noting = false;
        assert_false(note.wrong);
        assert_int_equal(note.sent, count * (sizes[k] + own));
        assert_int_equal(note.received, from[count]);
    }
    free(from);
}

/* Each item arrives at its place. */
static void
lists_arrive(void **state)
{
    const size_t count = rc_ranks_count(ranks), own = rc_ranks_own(ranks);
    size_t *from = calloc(count + 1, sizeof *from), *v, *all;

    (void)state;
    for (size_t q = 0; q < count; q++)
        from[q + 1] = from[q] + 3 * q + 1;
    v = calloc(3 * own + 1, sizeof *v);
    all = calloc(from[count], sizeof *all);
    for (size_t k = 0; k < 3 * own + 1; k++)
        v[k] = 7 * (from[own] + k) + 1;
    rc_ranks_move(ranks, sizeof *v, from, NULL, 0, v, all);
    for (size_t k = 0; k < from[count]; k++)
        assert_int_equal(all[k], 7 * k + 1);
    for (size_t more = 0; more < 9; more++) { /* those held here and `more` after them */
        memset(all, 0, from[count] * sizeof *all);
        rc_ranks_move(ranks, sizeof *v, from, from, more, v, all);
        for (size_t k = 0; from[own] + k < from[count]; k++)
            assert_int_equal(all[k], k < 3 * own + 1 + more ? 7 * (from[own] + k) + 1 : 0);
    }
    free(from);
    free(v);
    free(all);
}

int
main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fullest_rank_decides),
        cmocka_unit_test(rows_count_too),
        cmocka_unit_test(sizes_beyond_all),
        cmocka_unit_test(long_rows_beside),
        cmocka_unit_test(long_sums),
        cmocka_unit_test(long_lists),
        cmocka_unit_test(lists_arrive),
    };
    struct rc_err err;
    int failed;

    MPI_Init(&argc, &argv);
    if ((ranks = rc_ranks_new(MPI_COMM_WORLD, &err)) == NULL)
        return 1;
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    rc_ranks_free(ranks);
    MPI_Finalize();
    return failed;
}
