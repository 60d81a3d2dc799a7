/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The preconditioner of a first adhesive state is 1/(A + stiffness) on the whole grid: it inverts A +
 * stiffness, is symmetric and positive definite, and lies below K. Without a stiffness it is K again, to the
 * bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/operator/operator.h"
#include "tests/contact_case.h"

enum {
    MOST = 256 /* nodes of the largest grid below */
};
static const double single = 1e-5; /* of transforms in single precision, over the largest value */

struct pass {
    size_t px;
    double *in, *out;
};

static bool
write_row(void *ctx, size_t j, void *to)
{
    const struct pass *p = ctx;

    for (size_t i = 0; i < p->px; i++)
        ((float *)to)[i] = (float)p->in[j * p->px + i];
    return true;
}

static bool
read_row(void *ctx, size_t j, void *from)
{
    struct pass *p = ctx;

    for (size_t i = 0; i < p->px; i++)
        p->out[j * p->px + i] = (double)((float *)from)[i];
    return true;
}

static void
apply(struct rc_whole *w, enum rc_whole_factor which, double *in, double *out)
{
    struct pass pass = {w->grid.nx, in, out};

    rc_whole_rows(w, which, write_row, read_row, &pass);
}

/* Columns of the operator: its results of 1 on each node in turn. */
static void
find_columns(struct rc_whole *w, size_t n, double *column)
{
    double unit[MOST] = {0};

    for (size_t k = 0; k < n; k++) {
        unit[k] = 1;
        apply(w, RC_WHOLE_ROUGH, unit, column + k * n);
        unit[k] = 0;
    }
}

/* The smallest pivot of Cholesky's factorization of the symmetric m + plus, which has a positive one in each
 * row only if it is positive definite. Destroys m. */
static double
smallest_pivot(size_t n, double *m, double plus)
{
    double least = INFINITY;

    for (size_t k = 0; k < n * n; k++)
        m[k] += plus;
    for (size_t k = 0; k < n; k++) {
        least = fmin(least, m[k * n + k]);
        for (size_t i = k + 1; i < n; i++) {
            double factor = m[i * n + k] / m[k * n + k];
            for (size_t j = k; j < n; j++)
                m[i * n + j] -= factor * m[k * n + j];
        }
    }
    return least;
}

static const struct {
    struct rc_shape shape;
    bool x, y; /* axes that repeat */
} grids[] = {{{12, 10, 1, 1}, true, true},
             {{9, 15, 1.1, 0.7}, true, true},
             {{8, 7, 0.9, 1}, false, false},
             {{8, 6, 1, 1}, true, false}};

/* The largest difference of (A + stiffness) K p from p, over the largest p: a random pressure without a mean
 * where the map repeats, because K takes the mean away there. */
static double
misfit(struct rc_whole *w, size_t n, double stiffness, bool mean)
{
    double p[MOST], kp[MOST], akp[MOST], sum = 0, largest = 0, worst = 0;
    uint64_t seed = 5;

    for (size_t k = 0; k < n; k++)
        sum += p[k] = random_number(&seed);
    for (size_t k = 0; k < n && !mean; k++)
        p[k] -= sum / (double)n;
    apply(w, RC_WHOLE_ROUGH, p, kp);
    apply(w, RC_WHOLE_ROUGH_INVERSE, kp, akp);
    for (size_t k = 0; k < n; k++) {
        largest = fmax(largest, fabs(p[k]));
        worst = fmax(worst, fabs(akp[k] + stiffness * kp[k] - p[k]));
    }
    return worst / largest;
}

static double
asymmetry(size_t n, const double *column)
{
    double most = 0;

    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < i; j++)
            most = fmax(most, fabs(column[i * n + j] - column[j * n + i]) / column[0]);
    return most;
}

static void
adds_a_stiffness(void **state)
{
    static double bare[MOST * MOST], column[MOST * MOST], less[MOST * MOST];

    (void)state;
    for (size_t q = 0; q < sizeof grids / sizeof *grids; q++) {
        const struct rc_pair pair = {.estar = 2.5};
        const struct rc_operator_options options = {
            .pair = &pair, .boundary = rc_boundary_of(grids[q].x, grids[q].y)};
        const bool mean = !(grids[q].x && grids[q].y);
        const double plus = mean ? 0 : 1; /* for the wave that K does not have */
        struct rc_err err;
        struct rc_whole *w = rc_whole_new(&grids[q].shape, &options, &err);
        size_t n;

        assert_non_null(w);
        n = w->grid.nx * w->grid.ny;
        assert_true(n <= MOST);
        find_columns(w, n, bare);
        for (double stiffness = 0.03; stiffness < 5; stiffness *= 10) {
            rc_whole_pin(w, stiffness);
            find_columns(w, n, column);
            print_message("%zu nodes, stiffness %g: off by %.1e, asymmetry %.1e\n", n, stiffness,
                          misfit(w, n, stiffness, mean), asymmetry(n, column));
            assert_true(misfit(w, n, stiffness, mean) <= (1 + stiffness) * single);
            assert_true(asymmetry(n, column) <= single);
            for (size_t k = 0; k < n * n; k++)
                less[k] = bare[k] - column[k];
            assert_true(smallest_pivot(n, less, plus) > 0);
            assert_true(smallest_pivot(n, column, plus) > 0);
        }
        rc_whole_pin(w, 0);
        find_columns(w, n, column);
        assert_memory_equal(column, bare, n * n * sizeof *bare);
        rc_whole_free(w);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(adds_a_stiffness),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
