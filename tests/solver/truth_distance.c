/* The distance to a set is the least of the distances to its nodes, to rounding, for any set, any
 * spacing and any size, on both boundaries, for any number of threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <float.h>

#include "tests/contact_case.h"
#include "libcontact/slip/distance.h"

/* Eight roundings in single precision, half a unit of the last place each. */
#define ROUNDING (4 * (double)FLT_EPSILON)

/* The squares of the distances, as the extension under slip finds them. */
static void
find(struct rc_shape shape, enum rc_boundary boundary, const unsigned char *w, int threads,
     float *d2)
{
    size_t n = shape.nx * shape.ny;
    float *scratch = malloc(rc_distance_scratch(&shape) * sizeof *scratch);
    float *steps = malloc(n * sizeof *steps);

    rc_distance_columns(&shape, boundary, w, threads, steps);
    for (size_t k = 0; k < n; k += shape.nx)
        rc_distance_row(&shape, boundary, scratch, steps + k, d2 + k);
    free(scratch);
    free(steps);
}

/* Squares of `count` spacings, the shorter way around a period. */
static double
square(size_t a, size_t b, size_t period, double spacing, enum rc_boundary boundary)
{
    size_t count = a > b ? a - b : b - a;

    if (boundary == RC_PERIODIC && period - count < count)
        count = period - count;
    return (double)count * spacing * ((double)count * spacing);
}

/* Against the least over all nodes of the set. Where squares are whole numbers below 2^24 there is
 * nothing to round. */
static void
check(struct rc_shape shape, enum rc_boundary boundary, const unsigned char *w, int threads)
{
    size_t n = shape.nx * shape.ny, count = 0;
    size_t *set = malloc(n * sizeof *set);
    float *d2 = malloc(n * sizeof *d2);

    for (size_t k = 0; k < n; k++)
        if (w[k])
            set[count++] = k;
    find(shape, boundary, w, threads, d2);
    for (size_t k = 0; k < n; k++) {
        double least = INFINITY;
        bool whole = shape.dx == 1 && shape.dy == 1;

        for (size_t m = 0; m < count; m++)
            least = fmin(least,
                         square(k % shape.nx, set[m] % shape.nx, shape.nx, shape.dx, boundary) +
                             square(k / shape.nx, set[m] / shape.nx, shape.ny, shape.dy, boundary));
        assert_true(fabs((double)d2[k] - least) <=
                    (whole && least < 1 << 24 ? 0 : ROUNDING * least));
    }
    free(set);
    free(d2);
}

static const struct rc_shape shapes[] = {
    {37, 29, 1, 1},  {53, 53, 1, 1},   {37, 29, 1.1, 0.3}, {64, 48, 0.7, 0.71}, {97, 31, 0.1, 3},
    {20, 20, 1, 30}, {211, 7, 3.3, 1}, {1501, 2, 0.5, 1},  {1, 40, 1, 2},       {41, 1, 1, 2},
    {1, 1, 1, 1},    {2, 2, 1, 1},     {2, 3, 1.5, 1},
};

enum {
    SHAPES = sizeof shapes / sizeof *shapes
};

/* Every shape, on both boundaries, with what `set` makes of an empty set. */
static void
all_shapes(void (*set)(struct rc_shape shape, double density, uint64_t *seed, unsigned char *w),
           double density)
{
    uint64_t seed = 13;

    for (int run = 0; run < 6; run++)
        for (size_t k = 0; k < SHAPES; k++) {
            unsigned char *w = calloc(shapes[k].nx * shapes[k].ny, 1);

            set(shapes[k], density, &seed, w);
            check(shapes[k], run % 2 ? RC_PERIODIC : RC_FREE, w, run / 2 + 1);
            free(w);
        }
}

static void
one_node(struct rc_shape shape, double density, uint64_t *seed, unsigned char *w)
{
    size_t n = shape.nx * shape.ny;

    (void)density;
    w[(size_t)((random_number(seed) + 0.5) * (double)n) % n] = 1;
}

static void
random_nodes(struct rc_shape shape, double density, uint64_t *seed, unsigned char *w)
{
    for (size_t k = 0; k < shape.nx * shape.ny; k++)
        w[k] = random_number(seed) + 0.5 < density;
    one_node(shape, 0, seed, w);
}

/* Patches, whose edges, corners and hollows are many nodes long, and single nodes between them. */
static void
patches(struct rc_shape shape, double density, uint64_t *seed, unsigned char *w)
{
    double phase = 6 * random_number(seed);

    for (size_t k = 0; k < shape.nx * shape.ny; k++)
        w[k] = sin(0.21 * (double)(k % shape.nx) + phase) * cos(0.13 * (double)(k / shape.nx)) >
               0.8 - density;
    one_node(shape, 0, seed, w);
}

static void
one_row(struct rc_shape shape, double density, uint64_t *seed, unsigned char *w)
{
    size_t j = (size_t)((random_number(seed) + 0.5) * (double)shape.ny) % shape.ny;

    (void)density;
    memset(w + j * shape.nx, 1, shape.nx);
}

static void
all_nodes(struct rc_shape shape, double density, uint64_t *seed, unsigned char *w)
{
    (void)density;
    (void)seed;
    memset(w, 1, shape.nx * shape.ny);
}

static void
to_random_nodes(void **state)
{
    (void)state;
    all_shapes(random_nodes, 0.003);
    all_shapes(random_nodes, 0.03);
    all_shapes(random_nodes, 0.3);
    all_shapes(random_nodes, 0.95);
}

static void
to_patches(void **state)
{
    (void)state;
    all_shapes(patches, 0);
    all_shapes(patches, 1);
}

static void
to_few_or_all(void **state)
{
    (void)state;
    all_shapes(one_node, 0);
    all_shapes(one_row, 0);
    all_shapes(all_nodes, 0);
}

/* Farther than 4096 steps squares are no longer exact, but right to rounding. */
static void
far_away(void **state)
{
    static const struct rc_shape large[] = {{9001, 3, 1, 1}, {3, 9001, 1, 1}, {9001, 2, 1.1, 0.9}};
    uint64_t seed = 7;

    (void)state;
    for (int run = 0; run < 4; run++)
        for (size_t k = 0; k < sizeof large / sizeof *large; k++) {
            unsigned char *w = calloc(large[k].nx * large[k].ny, 1);

            one_node(large[k], 0, &seed, w);
            if (run / 2)
                one_node(large[k], 0, &seed, w);
            check(large[k], run % 2 ? RC_PERIODIC : RC_FREE, w, 2);
            free(w);
        }
}

/* No set, no distance. */
static void
to_nothing(void **state)
{
    struct rc_shape shape = {11, 7, 1, 2};
    unsigned char w[77] = {0};
    float d2[77];

    (void)state;
    for (int run = 0; run < 2; run++) {
        find(shape, run ? RC_PERIODIC : RC_FREE, w, 1, d2);
        for (size_t k = 0; k < 77; k++)
            assert_true(isinf(d2[k]));
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(to_random_nodes), cmocka_unit_test(to_patches),
        cmocka_unit_test(to_few_or_all),   cmocka_unit_test(far_away),
        cmocka_unit_test(to_nothing),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
