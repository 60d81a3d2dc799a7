/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Processes that share a map find the patches of one process, bit for bit and in the same order: on random
 * maps, for spirals and combs that cross edges between ranks many times, with ranks without rows and without
 * contact, on maps that repeat. Each rank needs the memory of its own rows. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/contact_case.h"
#include "libcontact/contact_mpi.h"

static struct rc_ranks *ranks;

static void
assert_same(const struct rc_patches *a, const struct rc_patches *b)
{
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->contact_nodes, b->contact_nodes);
    assert_memory_equal(&a->contact_area, &b->contact_area, sizeof a->contact_area);
    assert_memory_equal(&a->contact_area_corrected, &b->contact_area_corrected,
                        sizeof a->contact_area_corrected);
    assert_memory_equal(&a->perimeter, &b->perimeter, sizeof a->perimeter);
    assert_int_equal(a->listed, b->listed);
    assert_true((a->patch == NULL) == (b->patch == NULL));
    for (size_t k = 0; k < a->listed; k++) {
        assert_int_equal(a->patch[k].nodes, b->patch[k].nodes);
        assert_memory_equal(&a->patch[k].area, &b->patch[k].area, sizeof a->patch->area);
        assert_memory_equal(&a->patch[k].perimeter, &b->patch[k].perimeter,
                            sizeof a->patch->perimeter);
    }
}

/* With each boundary: the list of all patches, of none, of some. */
static void
compare(struct rc_shape s, const double *p)
{
    static const size_t largest[] = {SIZE_MAX, 0, 7};
    static size_t calls;
    size_t first, rows;

    rc_ranks_rows(ranks, &s, &first, &rows);
    for (size_t q = 0; q < BOUNDARIES; q++, calls++) {
        struct rc_patch_options o = {
            .boundary = each_boundary[q], .largest = largest[calls % 3], .threads = 1 + calls % 2};
        struct rc_patches alone, shared;

        assert_int_equal(rc_patches_find(&s, p, &o, &alone, NULL), RC_OK);
        assert_int_equal(alone.listed, alone.count < o.largest ? alone.count : o.largest);
        o.ranks = ranks;
        assert_int_equal(rc_patches_find(&s, p + first * s.nx, &o, &shared, NULL), RC_OK);
        assert_same(&shared, &alone);
        rc_patches_free(&alone);
        rc_patches_free(&shared);
    }
}

static double *
random_map(struct rc_shape s, double part, uint64_t seed)
{
    double *p = calloc(s.nx * s.ny, sizeof *p);

    for (size_t k = 0; k < s.nx * s.ny; k++)
        p[k] = random_number(&seed) + 0.5 < part ? 1 : 0;
    return p;
}

/* Ranks own rows in units of 16, or more where rows are short: some of these maps leave ranks without rows. */
static void
random_maps(void **state)
{
    static const size_t sides[][2] = {{131, 145}, {257, 64}, {5000, 33}, {37, 450},
                                      {300, 1},   {64, 5},   {1, 20000}, {2, 30001}};
    static const double parts[] = {0, 0.1, 0.593, 1};

    (void)state;
    for (size_t k = 0; k < sizeof sides / sizeof *sides; k++)
        for (size_t l = 0; l < sizeof parts / sizeof *parts; l++) {
            const struct rc_shape s = {sides[k][0], sides[k][1], 1.1e-6, 1.3e-6};
            double *p = random_map(s, parts[l], 10 * k + l);
            compare(s, p);
            free(p);
        }
}

static bool
is_set(struct rc_shape s, const double *p, long i, long j)
{
    return i >= 0 && j >= 0 && i < (long)s.nx && j < (long)s.ny && p[j * (long)s.nx + i] > 0;
}

/* A line from a corner inwards: it turns at the ends of the map and `apart` nodes before itself. */
static void
draw_spiral(struct rc_shape s, long apart, double *p)
{
    static const long step[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    long i = 0, j = 0;

    p[0] = 1;
    for (int side = 0, turns = 0; turns < 2;) {
        const long di = step[side][0], dj = step[side][1], x = i + di, y = j + dj;
        if (x >= 0 && y >= 0 && x < (long)s.nx && y < (long)s.ny &&
            !is_set(s, p, i + apart * di, j + apart * dj)) {
            p[y * (long)s.nx + x] = 1;
            i = x;
            j = y;
            turns = 0;
        } else {
            side = (side + 1) % 4;
            turns++;
        }
    }
}

/* A spiral, and the gap between its turns. */
static void
spirals(void **state)
{
    static const size_t sides[][2] = {{99, 163}, {64, 256}};

    (void)state;
    for (size_t k = 0; k < sizeof sides / sizeof *sides; k++)
        for (long apart = 2; apart < 4; apart++) {
            const struct rc_shape s = {sides[k][0], sides[k][1], 1.1e-6, 1.3e-6};
            double *p = calloc(s.nx * s.ny, sizeof *p);
            struct rc_patches found;

            draw_spiral(s, apart, p);
            assert_int_equal(
                rc_patches_find(&s, p, &(struct rc_patch_options){.largest = 1}, &found, NULL),
                RC_OK);
            assert_int_equal(found.count, 1);
            assert_true(found.contact_nodes > s.nx * s.ny / (size_t)(apart + 1));
            rc_patches_free(&found);
            compare(s, p);
            for (size_t q = 0; q < s.nx * s.ny; q++)
                p[q] = 1 - p[q];
            compare(s, p);
            free(p);
        }
}

/* Two combs whose teeth cross all rows, each tooth a part of its own on every rank but one. */
static void
combs(void **state)
{
    const struct rc_shape s = {401, 200, 1.1e-6, 1.3e-6};
    double *p = calloc(s.nx * s.ny, sizeof *p);

    (void)state;
    for (size_t j = 0; j < s.ny; j++)
        for (size_t i = 0; i < s.nx; i++) {
            const bool down = i % 4 == 0 && j < s.ny - 2, up = i % 4 == 2 && j > 1;
            p[j * s.nx + i] = j == 0 || j == s.ny - 1 || down || up ? 1 : 0;
        }
    compare(s, p);
    free(p);
}

/* Patches of one size in one band of rows, so that the other ranks have no contact. Their perimeters differ:
 * the order of the list is that of their first nodes, also of those across the ends of the map. */
static void
equal_patches(void **state)
{
    const struct rc_shape s = {120, 192, 1.1e-6, 1.3e-6};

    (void)state;
    for (size_t at = 0; at < s.ny; at += 47) {
        double *p = calloc(s.nx * s.ny, sizeof *p);
        for (size_t j = 0; j < 24; j++)
            for (size_t i = 0; i < s.nx; i++) {
                /* squares of 2 x 2, rows of 4 and columns of 4 nodes */
                const size_t kind = (i / 6 + j / 6) % 3, x = i % 6, y = j % 6;
                const bool touches = kind == 0   ? x < 2 && y < 2
                                     : kind == 1 ? x < 4 && y == 3
                                                 : x == 1 && y < 4;
                p[(at + j) % s.ny * s.nx + i] = touches;
            }
        compare(s, p);
        free(p);
    }
}

/* A rank needs memory for the patches of its rows, for lines of neighbouring rows, and at most 100 bytes for
 * each run of contact at edges between ranks. This is the first test, since the library only knows the most
 * memory so far. */
static void
memory(void **state)
{
    const struct rc_shape s = {1024, 1024, 1e-6, 1e-6};
    const double touching = 0.1;
    const size_t held = rc_memory_held().held;
    double *p = random_map(s, touching, 5), edges;
    struct rc_patch_options o = {.boundary = RC_PERIODIC, .largest = 10, .threads = 1};
    size_t first, rows, peak[2];
    struct rc_patches found;
    int count;

    (void)state;
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    rc_ranks_rows(ranks, &s, &first, &rows);
    for (int k = 0; k < 2; k++) {
        o.ranks = k == 0 ? ranks : NULL;
        assert_int_equal(rc_patches_find(&s, p + (k == 0 ? first * s.nx : 0), &o, &found, NULL),
                         RC_OK);
        assert_true(found.count > 80000 && found.listed == 10);
        rc_patches_free(&found);
        peak[k] = rc_memory_held().peak - held;
    }
    print_message("%zu bytes on a rank, %zu on one process\n", peak[0], peak[1]);
    edges = 100 * touching * (double)s.nx * (double)count;
    assert_true((double)peak[0] <
                1.05 * (double)peak[1] * (double)rows / (double)s.ny + 32 * (double)s.nx + edges);
    free(p);
}

int
main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory), cmocka_unit_test(random_maps),   cmocka_unit_test(spirals),
        cmocka_unit_test(combs),  cmocka_unit_test(equal_patches),
    };
    struct rc_err err;
    int failed;

    MPI_Init(&argc, &argv);
    ranks = rc_ranks_new(MPI_COMM_WORLD, &err);
    failed = ranks == NULL ? 1 : cmocka_run_group_tests(tests, NULL, NULL);
    rc_ranks_free(ranks);
    MPI_Finalize();
    return failed;
}
