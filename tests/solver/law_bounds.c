/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Only bounds.h uses that the lower bound of the pressure is 0. On a periodic map a constant pressure causes
 * no displacement. If both bounds and the mean pressure increase by the same amount, so does the pressure
 * everywhere. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "libcontact/solver/solver.h"
#include "tests/contact_case.h"

static const struct row {
    const char *method;
    size_t nx, ny;
    double hardness; /* over the mean pressure; 0: none */
    double low;      /* over the mean pressure          */
} rows[] = {
    {"pcg", 64, 48, 0, 0.7},   {"pcg", 64, 48, 3, 0.7},    {"pcg", 64, 48, 0, -0.4},
    {"pcg", 64, 48, 3, -0.4},  {"pcg", 37, 21, 1.2, -0.7}, {"pcg", 37, 21, 1.2, 20},
    {"pk99", 37, 21, 0, -0.4}, {"pk99", 37, 21, 3, 0.7},   {"pk99", 37, 21, 1.2, -0.6},
};

/* The pressure between these bounds, higher by `low` than those between 0 and the hardness. */
static double *
pressure(const struct row *row, const double *h, double low)
{
    const double mean = 1e8;
    struct rc_shape shape = {row->nx, row->ny, 1e-6, 1.3e-6};
    size_t n = row->nx * row->ny;
    struct rc_problem problem = {.boundary = RC_PERIODIC,
                                 .pair.estar = 1e11,
                                 .load = (1 + low) * mean * (double)n * shape.dx * shape.dy,
                                 .hardness = row->hardness > 0 ? (row->hardness + low) * mean : 0,
                                 .method = row->method,
                                 .tol = 1e-9};
    struct rc_err err;
    struct rc_solver *s = rc_solver_new(&shape, h, &problem, &err);
    struct rc_bounds *b;
    double *p = calloc(n, sizeof *p);

    assert_non_null(s);
    b = &s->posed.bounds;
    b->box.low = low * mean;
    b->floor = b->box.low * (double)n;
    b->unit = b->box.high - b->box.low;
    b->highest = b->open ? b->box.low : b->highest;
    while (rc_solver_step(s) == RC_MORE)
        ;
    assert_true(s->it.error <= problem.tol);
    memcpy(p, rc_solver_pressure(s), n * sizeof *p);
    rc_solver_free(s);
    return p;
}

static void
shifted(void **state)
{
    (void)state;
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        const struct row *row = &rows[r];
        struct rc_shape shape = {row->nx, row->ny, 1e-6, 1.3e-6};
        size_t n = row->nx * row->ny, lowest = 0, highest = 0;
        const struct rc_selfaffine rough = {
            .hurst = 0.7, .rms_slope = 0.01, .short_cut = 4e-6, .seed = 3};
        double *h = calloc(n, sizeof *h), *p, *q, worst = 0, sum = 0, low = row->low * 1e8;

        assert_int_equal(rc_synth_selfaffine(&shape, &rough, h, NULL), RC_OK);
        p = pressure(row, h, 0);
        q = pressure(row, h, row->low);
        for (size_t k = 0; k < n; k++) {
            worst += fabs(q[k] - low - p[k]);
            sum += p[k];
            lowest += q[k] <= low;
            highest += row->hardness > 0 && q[k] >= (row->hardness + row->low) * 1e8;
        }
        print_message("%s %zu x %zu, hardness %g, low %g: %zu nodes at the lower bound, %zu at the "
                      "upper, off by %.1e\n",
                      row->method, row->nx, row->ny, row->hardness, row->low, lowest, highest,
                      worst / sum);
        assert_true(worst <= 1e-8 * (1 + fabs(row->low)) * sum);
        assert_true(lowest > 0 && (row->hardness == 0 || highest > 0));
        free(h);
        free(p);
        free(q);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shifted),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
