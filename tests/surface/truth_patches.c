/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The corrected area of a contact is nearer to Hertz's than the area of its nodes. It is nearer by more than
 * half on average over twelve positions of the sphere between the nodes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

#include "tests/exact.h"
#include "libcontact/contact.h"

static const double radius = 7.5e-3, estar = 113.93e9, load = 240;

/* The area of the nodes and the corrected area, relative to Hertz's, for a sphere whose apex is (x, y) nodes
 * from the middle. */
static void
areas(size_t n, double x, double y, double *plain, double *corrected)
{
    struct hertz exact = hertz(load, radius, estar);
    const double d = 2.6 * exact.a / (double)n, area = exact_pi * exact.a * exact.a;
    const struct rc_shape s = {n, n, d, d};
    const struct rc_problem problem = {
        .pair.estar = estar, .load = load, .tol = 1e-6, .threads = 1};
    double *h = malloc(n * n * sizeof *h);
    struct rc_patches found;
    struct rc_solver *solver;

    for (size_t k = 0; k < n * n; k++) {
        size_t i = k % n, j = k / n;
        double u = (double)i - 0.5 * (double)(n - 1) - x;
        double v = (double)j - 0.5 * (double)(n - 1) - y;
        h[k] = -(u * u + v * v) * d * d / (2 * radius);
    }
    solver = rc_solver_new(&s, h, &problem, NULL);
    assert_non_null(solver);
    while (rc_solver_step(solver) == RC_MORE)
        ;
    assert_int_equal(rc_patches_find(&s, rc_solver_pressure(solver),
                                     &(struct rc_patch_options){.boundary = RC_FREE}, &found, NULL),
                     RC_OK);
    assert_int_equal(found.count, 1);
    *plain = found.contact_area / area - 1;
    *corrected = found.contact_area_corrected / area - 1;
    rc_patches_free(&found);
    rc_solver_free(solver);
    free(h);
}

static void
test_hertz(void **state)
{
    static const size_t sizes[] = {64, 128};

    (void)state;
    for (size_t k = 0; k < 2; k++) {
        double before = 0, after = 0;
        for (int i = 0; i < 12; i++) {
            double plain, corrected;
            areas(sizes[k], 0.5 * i / 12, 0.5 * (i * 5 % 12) / 12, &plain, &corrected);
            before += fabs(plain) / 12;
            after += fabs(corrected) / 12;
        }
        print_message("%zu nodes a side: area off by %.2e, corrected %.2e\n", sizes[k], before,
                      after);
        assert_true(after < 0.5 * before);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_hertz)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
