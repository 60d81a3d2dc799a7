/* The distance to a set is the least of the distances to its nodes, exactly where it is near and
 * to a sixth where it is far, for any spacing, on both boundaries, for any number of threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "contact_case.h"
#include "libcontact/solver/preconditioner.h"

/* The shortest way around a period, or the only one. */
static double
apart(double d, double period, enum rc_boundary boundary)
{
    d = fabs(d);
    return boundary == RC_PERIODIC && d > period / 2 ? period - d : d;
}

static void
check(struct rc_shape shape, enum rc_boundary boundary, double density, int threads)
{
    size_t n = shape.nx * shape.ny;
    unsigned char *w = calloc(n, 1);
    float *scratch = malloc(rc_distance_scratch(&shape) * sizeof *scratch);
    float *steps = malloc(n * sizeof *steps), *d2 = malloc(shape.nx * sizeof *d2);
    uint64_t seed = 13;

    for (size_t k = 0; k < n; k++)
        w[k] = random_number(&seed) + 0.5 < density;
    w[n / 3] = 1;
    rc_distance_columns(&shape, boundary, w, threads, steps);
    for (size_t k = 0; k < n; k++) {
        double least = INFINITY;
        bool near;
        if (k % shape.nx == 0)
            rc_distance_row(&shape, boundary, scratch, steps + k, d2);
        for (size_t m = 0; m < n; m++) {
            double x =
                apart(node_x(shape, k) - node_x(shape, m), (double)shape.nx * shape.dx, boundary);
            double y =
                apart(node_y(shape, k) - node_y(shape, m), (double)shape.ny * shape.dy, boundary);
            if (w[m])
                least = fmin(least, x * x + y * y);
        }
        /* blocks stand for what is farther away than 8 columns */
        near = least <= 8 * 8 * shape.dx * shape.dx;
        assert_true(fabs(sqrt((double)d2[k % shape.nx]) - sqrt(least)) <=
                    (near ? 1e-6 : 1. / 6) * sqrt(least));
    }
    free(w);
    free(scratch);
    free(steps);
    free(d2);
}

static void
against_all_pairs(void **state)
{
    (void)state;
    for (int threads = 1; threads < 4; threads++)
        for (int boundary = RC_FREE; boundary <= RC_PERIODIC; boundary++) {
            enum rc_boundary b = (enum rc_boundary)boundary;
            check((struct rc_shape){37, 29, 1, 1}, b, 0.05, threads);
            check((struct rc_shape){37, 29, 1.1, 0.3}, b, 0.01, threads);
            check((struct rc_shape){150, 40, 1, 1.5}, b, 0, threads);
            check((struct rc_shape){97, 31, 0.1, 3}, b, 0.01, threads);
            check((struct rc_shape){1500, 3, 0.5, 1}, b, 0, threads);
            check((struct rc_shape){1501, 2, 0.5, 1}, b, 1e-3, threads);
            check((struct rc_shape){1, 40, 1, 2}, b, 0.1, threads);
            check((struct rc_shape){41, 1, 1, 2}, b, 0, threads);
            check((struct rc_shape){20, 20, 1, 30}, b, 0.9, threads);
        }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(against_all_pairs)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
