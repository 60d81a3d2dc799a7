/* The distance to a set is the least of the distances to its nodes, for any spacing and any number of
 * threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "contact_case.h"
#include "libcontact/extension.h"

static void
check(struct rc_shape shape, double density, int threads)
{
    size_t n = shape.nx * shape.ny;
    unsigned char *w = calloc(n, 1);
    double *scratch = malloc(rc_distance_scratch(&shape, threads) * sizeof *scratch);
    double *d2 = malloc(n * sizeof *d2);
    uint64_t seed = 13;

    for (size_t k = 0; k < n; k++)
        w[k] = random_number(&seed) + 0.5 < density;
    w[n / 3] = 1;
    rc_distance_squared(&shape, w, threads, scratch, d2);
    for (size_t k = 0; k < n; k++) {
        double least = INFINITY;
        for (size_t m = 0; m < n; m++) {
            double x = node_x(shape, k) - node_x(shape, m), y = node_y(shape, k) - node_y(shape, m);
            if (w[m])
                least = fmin(least, x * x + y * y);
        }
        assert_true(fabs(d2[k] - least) <= 1e-12 * least);
    }
    free(w);
    free(scratch);
    free(d2);
}

static void
against_all_pairs(void **state)
{
    (void)state;
    for (int threads = 1; threads < 4; threads++) {
        check((struct rc_shape){37, 29, 1, 1}, 0.05, threads);
        check((struct rc_shape){37, 29, 1.1, 0.3}, 0.01, threads);
        check((struct rc_shape){1, 40, 1, 2}, 0.1, threads);
        check((struct rc_shape){41, 1, 1, 2}, 0, threads);
        check((struct rc_shape){20, 20, 1, 30}, 0.9, threads);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(against_all_pairs)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
