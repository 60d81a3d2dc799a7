/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Patches equal those of a plain flood fill. Count, area and perimeter of each are tested on free maps and
 * across the edges of periodic ones, and their order, for any number of threads. The search is fast. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "tests/exact.h"
#include "libcontact/contact.h"

/* ---- a flood fill ---- */

struct filled {
    size_t first;              /* its first node */
    size_t nodes, ends, sides; /* edges of length dy, and of length dx */
};

struct fill {
    const struct rc_shape *shape;
    const double *p;
    struct rc_boundary boundary;
    char *seen;
    size_t *stack, n;
};

/* The neighbour of node k on that side; false at the end of the map. */
static bool
beside(const struct fill *f, size_t k, int side, size_t *at)
{
    size_t nx = f->shape->nx, ny = f->shape->ny, i = k % nx, j = k / nx;

    if (!f->boundary.x && ((side == 0 && i == 0) || (side == 1 && i + 1 == nx)))
        return false;
    if (!f->boundary.y && ((side == 2 && j == 0) || (side == 3 && j + 1 == ny)))
        return false;
    i = side == 0 ? (i + nx - 1) % nx : side == 1 ? (i + 1) % nx : i;
    j = side == 2 ? (j + ny - 1) % ny : side == 3 ? (j + 1) % ny : j;
    *at = j * nx + i;
    return true;
}

static struct filled
fill_from(struct fill *f, size_t start)
{
    struct filled patch = {.first = start};

    f->seen[start] = 1;
    f->stack[f->n++] = start;
    while (f->n > 0) {
        size_t k = f->stack[--f->n], to;
        patch.nodes++;
        for (int side = 0; side < 4; side++) {
            if (!beside(f, k, side, &to))
                continue;
            if (!(f->p[to] > 0)) {
                patch.ends += side < 2 ? 1 : 0;
                patch.sides += side < 2 ? 0 : 1;
            } else if (!f->seen[to]) {
                f->seen[to] = 1;
                f->stack[f->n++] = to;
            }
        }
    }
    return patch;
}

static int
by_size(const void *a, const void *b)
{
    const struct filled *x = a, *y = b;

    return x->nodes != y->nodes ? (x->nodes < y->nodes ? 1 : -1)
                                : (x->first > y->first) - (x->first < y->first);
}

static size_t
fill_all(const struct rc_shape *s, const double *p, struct rc_boundary boundary,
         struct filled **patches)
{
    size_t n = s->nx * s->ny, count = 0;
    struct fill f = {.shape = s,
                     .p = p,
                     .boundary = boundary,
                     .seen = calloc(n, 1),
                     .stack = malloc(n * sizeof *f.stack)};

    *patches = malloc((n + 1) * sizeof **patches);
    for (size_t k = 0; k < n; k++)
        if (p[k] > 0 && !f.seen[k])
            (*patches)[count++] = fill_from(&f, k);
    qsort(*patches, count, sizeof **patches, by_size);
    free(f.seen);
    free(f.stack);
    return count;
}

/* ---- the same ---- */

static void
assert_near(double got, double expected)
{
    if (!(fabs(got - expected) <= summed * fabs(expected)))
        fail_msg("%.17g instead of %.17g", got, expected);
}

static void
check(const struct rc_shape *s, const double *p, struct rc_boundary boundary, size_t threads)
{
    const struct rc_patch_options options = {
        .boundary = boundary, .largest = SIZE_MAX, .threads = threads};
    double cell = s->dx * s->dy, perimeter = 0, edges = 0;
    struct filled *filled;
    size_t count = fill_all(s, p, boundary, &filled), nodes = 0;
    struct rc_patches found;

    assert_int_equal(rc_patches_find(s, p, &options, &found, NULL), RC_OK);
    assert_int_equal(found.count, count);
    for (size_t k = 0; k < count; k++) {
        nodes += filled[k].nodes;
        edges += (double)(filled[k].ends + filled[k].sides);
        perimeter += (double)filled[k].ends * s->dy + (double)filled[k].sides * s->dx;
    }
    assert_int_equal(found.contact_nodes, nodes);
    assert_near(found.contact_area, (double)nodes * cell);
    assert_near(found.perimeter, perimeter);
    assert_near(found.contact_area_corrected,
                (double)nodes * cell - (exact_pi - 1 + log(2)) / 24 * cell * edges);
    assert_int_equal(found.listed, count);
    for (size_t k = 0; k < count; k++) {
        assert_int_equal(found.patch[k].nodes, filled[k].nodes);
        assert_near(found.patch[k].area, (double)filled[k].nodes * cell);
        assert_near(found.patch[k].perimeter,
                    (double)filled[k].ends * s->dy + (double)filled[k].sides * s->dx);
    }
    rc_patches_free(&found);
    free(filled);
}

static void
test_flood_fill(void **state)
{
    static const size_t sides[][2] = {{33, 47}, {64, 64}, {1, 90}, {90, 1},   {2, 60},
                                      {60, 2},  {1, 1},   {3, 3},  {201, 180}};
    static const double parts[] = {0, 0.1, 0.5, 0.593, 0.7, 1};

    (void)state;
    srand(3);
    for (size_t k = 0; k < sizeof sides / sizeof *sides; k++)
        for (size_t l = 0; l < sizeof parts / sizeof *parts; l++)
            for (int turn = 0; turn < 8; turn++) {
                const struct rc_shape s = {sides[k][0], sides[k][1], 1.1e-6, 1.3e-6};
                double *p = malloc(s.nx * s.ny * sizeof *p);
                for (size_t i = 0; i < s.nx * s.ny; i++)
                    p[i] = rand() < parts[l] * RAND_MAX ? 1e6 + (double)i : 0;
                check(&s, p, rc_boundary_of(turn & 1, turn & 4), turn & 2 ? 5 : 1);
                free(p);
            }
}

/* A frame around the map is one patch, periodic or not; four corners are one patch if the map is
 * periodic, two if it repeats along one axis, else four. The arms of a cross join across the edges; two
 * spirals remain two patches. */
static void
test_edges(void **state)
{
    const struct rc_shape s = {12, 10, 2e-6, 1e-6};
    const struct rc_patch_options free_map = {.boundary = RC_FREE, .largest = SIZE_MAX};
    const struct rc_patch_options periodic = {.boundary = RC_PERIODIC, .largest = SIZE_MAX};
    double p[120] = {0};
    struct rc_patches found;

    (void)state;
    p[0] = p[11] = p[108] = p[119] = 1;
    assert_int_equal(rc_patches_find(&s, p, &free_map, &found, NULL), RC_OK);
    assert_int_equal(found.count, 4);
    assert_near(found.perimeter, 4 * 3e-6); /* the border of the map does not count */
    rc_patches_free(&found);
    for (int axis = 0; axis < 2; axis++) {
        const struct rc_patch_options one = {.boundary = rc_boundary_of(axis == 0, axis == 1)};
        assert_int_equal(rc_patches_find(&s, p, &one, &found, NULL), RC_OK);
        assert_int_equal(found.count, 2);
        assert_near(found.perimeter, 2 * (axis == 0 ? 2 * 2e-6 + 2 * 1e-6 : 2 * 1e-6 + 2 * 2e-6));
        rc_patches_free(&found);
    }
    assert_int_equal(rc_patches_find(&s, p, &periodic, &found, NULL), RC_OK);
    assert_int_equal(found.count, 1);
    assert_near(found.patch[0].area, 4 * 2e-12);
    assert_near(found.perimeter, 4 * 2e-6 + 4 * 1e-6);
    rc_patches_free(&found);
    for (size_t k = 0; k < 120; k++)
        p[k] = k % 12 == 5 || k / 12 == 4 ? 1 : 0;
    assert_int_equal(rc_patches_find(&s, p, &periodic, &found, NULL), RC_OK);
    assert_int_equal(found.count, 1);
    assert_near(found.perimeter, 2 * 9 * 1e-6 + 2 * 11 * 2e-6);
    rc_patches_free(&found);
}

/* Half of the nodes at random, correlated with their neighbours: the largest patch spans the map. Processor
 * time is measured, so that other programs do not count. */
static void
test_percolating(void **state)
{
    const struct rc_shape s = {2048, 2048, 1e-6, 1e-6};
    const struct rc_patch_options options = {
        .boundary = RC_PERIODIC, .largest = SIZE_MAX, .threads = 1};
    double *p = malloc(s.nx * s.ny * sizeof *p), seconds;
    struct rc_patches found;
    clock_t start;

    (void)state;
    srand(9);
    for (size_t k = 0; k < s.nx * s.ny; k++)
        p[k] = rand() < 0.593 * RAND_MAX ? 1 : 0;
    start = clock();
    assert_int_equal(rc_patches_find(&s, p, &options, &found, NULL), RC_OK);
    seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    print_message("%zu patches, the largest of %zu nodes, in %.2f s\n", found.count,
                  found.patch[0].nodes, seconds);
    assert_true(found.count > 100000 && found.patch[0].nodes > 400000);
    assert_true(seconds < 1);
    rc_patches_free(&found);
    free(p);
}

/* A map without columns or rows is refused, without an endless loop. */
static void
test_no_map(void **state)
{
    const struct rc_shape none[] = {{0, 5, 1e-6, 1e-6}, {5, 0, 1e-6, 1e-6}};
    const struct rc_patch_options options = {.boundary = RC_FREE};
    const double p = 1;
    struct rc_patches found;
    struct rc_err err;

    (void)state;
    for (size_t k = 0; k < sizeof none / sizeof *none; k++) {
        assert_int_equal(rc_patches_find(&none[k], &p, &options, &found, &err), RC_FAIL);
        rc_patches_free(&found);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flood_fill),
        cmocka_unit_test(test_edges),
        cmocka_unit_test(test_percolating),
        cmocka_unit_test(test_no_map),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
