/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual of the least-squares polynomial is orthogonal to every polynomial of its degree over the
 * measured points. It is 0 if the surface was such a polynomial. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/exact.h"
#include "maps.h"

enum {
    NX = 33,
    NY = 47,
    N = NX * NY
};
static const struct rc_shape shape = {.nx = NX, .ny = NY, .dx = 1.1e-6, .dy = 1e-6};

/* Coordinates in -1..1, so that powers do not become large. */
static double
along(size_t i, size_t n)
{
    return n == 1 ? 0 : 2 * (double)i / (double)(n - 1) - 1;
}

/* A polynomial of total degree `degree` with random coefficients, in plain powers. */
static void
make_poly(const struct rc_shape *s, size_t degree, double *h)
{
    memset(h, 0, s->nx * s->ny * sizeof *h);
    for (size_t b = 0; b <= degree; b++)
        for (size_t a = 0; a + b <= degree; a++) {
            double c = 1e-6 * chance();
            for (size_t k = 0; k < s->nx * s->ny; k++)
                h[k] += c * pow(along(k % s->nx, s->nx), (double)a) *
                        pow(along(k / s->nx, s->ny), (double)b);
        }
}

static void
cut_holes(double *h, size_t n)
{
    for (size_t k = 0; k < n; k++)
        if (rand() % 4 == 0)
            h[k] = NAN;
}

static enum rc_status
detrend(const struct rc_shape *s, size_t degree, double *h, struct rc_err *err)
{
    return rc_detrend_form(s, &(struct rc_form){.degree = degree}, h, NULL, err);
}

static double
highest(const double *h, size_t n)
{
    double m = 0;

    for (size_t k = 0; k < n; k++)
        m = isnan(h[k]) ? m : fmax(m, fabs(h[k]));
    return m;
}

static void
check_removed(const struct rc_shape *s, size_t degree, double *h, double tolerance)
{
    double before = highest(h, s->nx * s->ny), after;
    struct rc_err err;

    if (detrend(s, degree, h, &err) != RC_OK)
        fail_msg("degree %zu: %s", degree, err.text);
    after = highest(h, s->nx * s->ny);
    if (!(after <= tolerance * before))
        fail_msg("degree %zu leaves %g of %g", degree, after, before);
}

static void
test_polynomials_vanish(void **state)
{
    double *h = malloc(sizeof(double[N]));

    (void)state;
    srand(17);
    for (size_t degree = 0; degree <= RC_DEGREE_MAX; degree += degree < 6 ? 1 : 7) {
        size_t missing = 0;
        make_poly(&shape, degree, h);
        cut_holes(h, N);
        check_removed(&shape, degree, h, summed);
        for (size_t k = 0; k < N; k++)
            missing += isnan(h[k]) ? 1 : 0;
        assert_true(missing > N / 5); /* a missing point stays missing */
    }
    free(h);
}

/* Heights on a datum a million times their size keep their remaining digits. */
static void
test_far_datum(void **state)
{
    double *h = malloc(sizeof(double[N]));

    (void)state;
    for (size_t k = 0; k < N; k++)
        h[k] = 1e6 + 0x3p-6 * (double)(k % NX) - 0x5p-7 * (double)(k / NX); /* exact */
    check_removed(&shape, 1, h, 1e-18);
    free(h);
}

static void
test_residual_is_orthogonal(void **state)
{
    double *h = malloc(sizeof(double[N]));
    const size_t degree = 4;
    struct rc_err err;

    (void)state;
    srand(18);
    for (size_t k = 0; k < N; k++)
        h[k] = 1e-6 * chance() + 3e-6;
    cut_holes(h, N);
    assert_int_equal(detrend(&shape, degree, h, &err), RC_OK);
    for (size_t b = 0; b <= degree; b++)
        for (size_t a = 0; a + b <= degree; a++) {
            long double sum = 0;
            for (size_t k = 0; k < N; k++)
                if (!isnan(h[k]))
                    sum += (long double)h[k] * powl(along(k % NX, NX), (long double)a) *
                           powl(along(k / NX, NY), (long double)b);
            if (!(fabsl(sum) <= summed * N * 1e-6))
                fail_msg("x^%zu y^%zu: %Lg", a, b, sum);
        }
    assert_true(highest(h, N) > 0.5e-6);
    free(h);
}

/* The same plane from GSL's dense least squares in metres. */
static void
test_against_dense_fit(void **state)
{
    double *h = malloc(sizeof(double[N])), *copy = malloc(sizeof(double[N])), chisq;
    gsl_matrix *x, *covariance = gsl_matrix_alloc(3, 3);
    gsl_vector *y, *c = gsl_vector_alloc(3);
    gsl_multifit_linear_workspace *work;
    size_t n = 0, row = 0;
    struct rc_err err;

    (void)state;
    srand(19);
    for (size_t k = 0; k < N; k++)
        h[k] = 1e-6 * chance();
    cut_holes(h, N);
    for (size_t k = 0; k < N; k++)
        n += isnan(h[k]) ? 0 : 1;
    memcpy(copy, h, sizeof(double[N]));
    x = gsl_matrix_alloc(n, 3);
    y = gsl_vector_alloc(n);
    work = gsl_multifit_linear_alloc(n, 3);
    for (size_t k = 0; k < N; k++) {
        if (isnan(h[k]))
            continue;
        gsl_matrix_set(x, row, 0, 1);
        gsl_matrix_set(x, row, 1, (double)(k % NX) * shape.dx);
        gsl_matrix_set(x, row, 2, (double)(k / NX) * shape.dy);
        gsl_vector_set(y, row++, h[k]);
    }
    gsl_multifit_linear(x, y, c, covariance, &chisq, work);
    assert_int_equal(detrend(&shape, 1, h, &err), RC_OK);
    for (size_t k = 0; k < N; k++) {
        double expected = copy[k] - gsl_vector_get(c, 0) -
                          gsl_vector_get(c, 1) * (double)(k % NX) * shape.dx -
                          gsl_vector_get(c, 2) * (double)(k / NX) * shape.dy;
        assert_true(isnan(copy[k]) ? isnan(h[k]) : fabs(h[k] - expected) <= summed * 1e-6);
    }
    gsl_multifit_linear_free(work);
    gsl_matrix_free(x);
    gsl_matrix_free(covariance);
    gsl_vector_free(y);
    gsl_vector_free(c);
    free(h);
    free(copy);
}

static void
test_profiles(void **state)
{
    const struct rc_shape row = {97, 1, 1.1e-6, 1e-6}, column = {1, 97, 1e-6, 1.1e-6};
    const struct rc_shape point = {1, 1, 1e-6, 1e-6};
    double h[97], one = 4.2e-6;

    (void)state;
    srand(20);
    for (size_t degree = 1; degree <= 7; degree += 3) {
        make_poly(&row, degree, h);
        cut_holes(h, 97);
        check_removed(&row, degree, h, summed);
        make_poly(&column, degree, h);
        check_removed(&column, degree, h, summed);
    }
    check_removed(&point, 3, &one, 0);
}

/* As many points as coefficients: the polynomial passes through them. */
static void
test_just_enough_points(void **state)
{
    const struct rc_shape s = {4, 4, 1, 1};
    double h[16];

    (void)state;
    for (size_t k = 0; k < 16; k++)
        h[k] = NAN;
    h[0] = 3;
    h[7] = -2;
    h[13] = 5;
    check_removed(&s, 1, h, rounding);
}

static void
check_refused(struct rc_shape s, size_t degree, double *h, const char *reason)
{
    size_t bytes = s.nx * s.ny * sizeof *h;
    double *before = malloc(bytes);
    struct rc_err err;

    memcpy(before, h, bytes);
    assert_int_equal(detrend(&s, degree, h, &err), RC_FAIL);
    if (strstr(err.text, reason) == NULL)
        fail_msg("'%s' does not say '%s'", err.text, reason);
    assert_memory_equal(h, before, bytes);
    free(before);
}

static void
test_refusals(void **state)
{
    double *h = malloc(sizeof(double[N]));

    (void)state;
    for (size_t k = 0; k < N; k++)
        h[k] = NAN;
    check_refused(shape, 0, h, "only 0 points");
    h[3] = h[70] = 1;
    check_refused(shape, 1, h, "only 2 points");
    for (size_t k = 0; k < NX; k++)
        h[k * NX + k] = (double)(k * k); /* heights on a line across the map */
    h[3] = h[70] = NAN;
    check_refused(shape, 1, h, "do not determine");
    for (size_t k = 0; k < N; k++)
        h[k] = k / NX == 5 ? 1 : NAN; /* one row */
    check_refused(shape, 1, h, "do not determine");
    for (size_t k = 0; k < N; k++)
        h[k] = k % NX < 3 ? 1 : NAN; /* three columns do not determine a cubic */
    check_removed(&shape, 2, h, rounding);
    check_refused(shape, 3, h, "do not determine");
    h[1] = -INFINITY;
    check_refused(shape, 1, h, "infinite");
    check_refused(shape, RC_DEGREE_MAX + 1, h, "at most 20");
    free(h);
}

/* A row of n values that is orthogonal to all parabolas on them (Gram 1883), at most 1 in size. */
static double
gram_three(size_t i, size_t n)
{
    double s = (double)i - 0.5 * (double)(n - 1), m = 0.5 * (double)(n - 1);
    double square = (3 * (double)(n * n) - 7) / 20;

    return s * (s * s - square) / (m * (m * m - square));
}

/* A profile that levelling of row j with this degree leaves unchanged: for degree 0 one with the median 0. It
 * is 0 in rows with missing points. */
static double
kept_of(size_t degree, size_t i, size_t j)
{
    if (j % 3 == 1)
        return 0;
    return 1e-8 * (double)(j + 1) *
           (degree > 0 ? gram_three(i, NX) : ((double)i - 16) * (1 + (double)(i % 2)));
}

static void
make_rows(size_t degree, double *h)
{
    for (size_t j = 0; j < NY; j++) {
        double c[3] = {1e-6 * chance(), 1e-6 * chance(), 1e-6 * chance()};

        for (size_t i = 0; i < NX; i++) {
            double x = along(i, NX);

            h[j * NX + i] = kept_of(degree, i, j) + c[0] + (degree > 0 ? c[1] * x : 0) +
                            (degree > 1 ? c[2] * x * x : 0);
        }
        if (j % 3 == 1)
            cut_holes(h + j * NX, NX);
    }
    for (size_t i = 0; i < NX; i++)
        h[NX + i] = NAN; /* a row without a point */
}

/* A surface whose rows have been shifted, tilted or bent is recovered; missing points stay missing. */
static void
test_rows_are_levelled(void **state)
{
    double h[N], levelled[N];
    struct rc_err err;

    (void)state;
    srand(23);
    for (size_t degree = 0; degree <= 2; degree++) {
        make_rows(degree, h);
        memcpy(levelled, h, sizeof h);
        assert_int_equal(rc_detrend_rows(&shape, degree, false, levelled, &err), RC_OK);
        for (size_t k = 0; k < N; k++)
            if (isnan(h[k])
                    ? !isnan(levelled[k])
                    : !(fabs(levelled[k] - kept_of(degree, k % NX, k / NX)) < 1e-6 * summed))
                fail_msg("degree %zu, node %zu: %g, not %g", degree, k, levelled[k],
                         kept_of(degree, k % NX, k / NX));
    }
    assert_int_equal(rc_detrend_rows(&shape, 3, false, levelled, &err), RC_FAIL);
    levelled[NX + 2] = INFINITY;
    assert_int_equal(rc_detrend_rows(&shape, 1, false, levelled, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "1 infinite heights in row 1"));
}

/* Spikes in every row: medians and robust fits ignore them; a row with too few points for a fit is levelled
 * by its median. */
static void
test_rows_resist(void **state)
{
    double h[N], levelled[N];
    struct rc_err err;

    (void)state;
    srand(29);
    for (size_t degree = 0; degree <= 2; degree++) {
        make_rows(degree, h);
        for (size_t j = 0; j < NY; j++)
            for (size_t i = 0; i < NX; i++)
                h[j * NX + i] -= kept_of(degree, i, j);
        for (size_t j = 0; j < NY; j++)
            h[j * NX + 7] += 1e-6;
        for (size_t i = 3; i < NX; i++)
            h[4 * NX + i] = NAN;
        h[4 * NX] = h[4 * NX + 1] = 2e-6;
        h[4 * NX + 2] = 5e-6;
        memcpy(levelled, h, sizeof h);
        assert_int_equal(rc_detrend_rows(&shape, degree, true, levelled, &err), RC_OK);
        for (size_t k = 0; k < N; k++) {
            double wanted = k / NX == 4 ? (k % NX == 2 ? 3e-6 : 0) : k % NX == 7 ? 1e-6 : 0;

            if (!isnan(h[k]) && !(fabs(levelled[k] - wanted) < 1e-13))
                fail_msg("degree %zu, node %zu: %g, not %g", degree, k, levelled[k], wanted);
        }
    }
}

static void
unwanted(const char *reason, const char *file, int line, int number)
{
    fail_msg("GSL's handler was called: %s (%s:%d, %d)", reason, file, line, number);
}

static void
test_handler_is_given_back(void **state)
{
    double *h = malloc(sizeof(double[N]));

    (void)state;
    gsl_set_error_handler(unwanted);
    make_poly(&shape, 2, h);
    check_removed(&shape, 2, h, summed);
    for (size_t k = 0; k < N; k++)
        h[k] = k / NX == 5 ? 1 : NAN;
    check_refused(shape, 1, h, "do not determine");
    assert_ptr_equal(gsl_set_error_handler(NULL), unwanted);
    free(h);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_polynomials_vanish),
        cmocka_unit_test(test_far_datum),
        cmocka_unit_test(test_residual_is_orthogonal),
        cmocka_unit_test(test_against_dense_fit),
        cmocka_unit_test(test_profiles),
        cmocka_unit_test(test_just_enough_points),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_rows_are_levelled),
        cmocka_unit_test(test_rows_resist),
        cmocka_unit_test(test_handler_is_given_back),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
