/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The preconditioner E' A E is symmetric and positive. It is at least as large as the exact inverse and close
 * to it: eigenvalues of E' A E K on given contact sets show this. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

#include "tests/contact_case.h"
#include "libcontact/solver/preconditioner.h"

enum set_name {
    RANDOM,
    DISC,
    ROUGH, /* the contact of a rough surface */
    ALMOST_ALL,
    STRIP,
    SETS
};
static const char *const set_names[] = {"random", "disc", "rough", "almost all", "strip"};

/* Fills w and returns the number of nodes in the set. */
static size_t
choose(struct rc_shape s, struct rc_boundary boundary, enum set_name name, unsigned char *w)
{
    size_t n = s.nx * s.ny, count = 0;
    uint64_t seed = 29;

    if (name == ROUGH) {
        double *h = malloc(n * sizeof *h);
        struct rc_selfaffine what = {
            .hurst = 0.8, .rms_slope = 0.1, .short_cut = 6 * fmax(s.dx, s.dy), .seed = 4};
        struct rc_problem problem = {.boundary = boundary,
                                     .pair.estar = 1e9,
                                     .load = 1.5e7 * s.dx * s.dy * (double)n,
                                     .tol = 1e-7};
        struct solved a;
        struct rc_err err;
        assert_int_equal(rc_synth_selfaffine(&s, &what, h, &err), RC_OK);
        a = solve(s, h, problem);
        assert_int_equal(a.status, RC_OK);
        for (size_t k = 0; k < n; k++)
            w[k] = a.p[k] > 0;
        solved_free(&a);
        free(h);
    }
    for (size_t k = 0; k < n; k++) {
        if (name == RANDOM)
            w[k] = random_number(&seed) < 0;
        else if (name == DISC)
            w[k] = node_r(s, k) < 0.3 * s.dx * (double)s.nx;
        else if (name == ALMOST_ALL)
            w[k] = k % 97 != 5;
        else if (name == STRIP)
            w[k] = k % s.nx > 3 && k % s.nx < s.nx / 2;
        count += w[k];
    }
    return count;
}

/* Random numbers on w whose sum is 0. */
static void
random_vector(size_t n, const unsigned char *w, size_t count, uint64_t *seed, float *r)
{
    double sum = 0;

    for (size_t k = 0; k < n; k++) {
        r[k] = w[k] ? (float)random_number(seed) : 0;
        sum += (double)r[k];
    }
    for (size_t k = 0; k < n; k++)
        r[k] = w[k] ? (float)((double)r[k] - sum / (double)count) : 0;
}

static double
product(size_t n, const float *a, const float *b)
{
    double sum = 0;

    for (size_t k = 0; k < n; k++)
        sum += (double)a[k] * (double)b[k];
    return sum;
}

static const struct rc_shape shapes[] = {
    {32, 32, 1e-6, 1e-6}, {48, 37, 1.1e-6, 1e-6}, {30, 41, 1e-6, 7e-6}, {200, 3, 1e-6, 1e-6}};

enum {
    SHAPES = sizeof shapes / sizeof *shapes
};

/* a'(E'AE b) = b'(E'AE a) holds in single precision, relative to the norms of both; a'(E'AE a) > 0. */
static void
symmetric_and_positive(void **state)
{
    double worst = 0, least = INFINITY;

    (void)state;
    for (size_t q = 0; q < SHAPES * SETS * 2; q++) {
        struct rc_shape s = shapes[q / SETS / 2];
        struct rc_boundary boundary = q % 2 == 0 ? RC_FREE : RC_PERIODIC;
        size_t n = s.nx * s.ny, count;
        unsigned char *w = malloc(n);
        float *v = malloc(4 * n * sizeof *v), *a = v, *b = v + n, *za = v + 2 * n, *zb = v + 3 * n;
        struct rc_err err;
        struct rc_operator_options options = {.boundary = boundary,
                                              .pair = &(struct rc_pair){.estar = 1}};
        struct rc_operator *op = rc_operator_new(&s, &options, &err);
        struct rc_preconditioner *e;
        uint64_t seed = 2;
        assert_non_null(op);
        e = rc_preconditioner_new(op, &err);
        assert_non_null(e);
        count = choose(s, boundary, (enum set_name)(q / 2 % SETS), w);
        assert_true(count > 1);
        rc_preconditioner_set(e, w);
        for (int round = 0; round < 5; round++) {
            double aa, bb, ab, ba;
            random_vector(n, w, count, &seed, a);
            random_vector(n, w, count, &seed, b);
            if (round ==
                4) /* after a change of the set the weights are old: the operator must stay symmetric */
                for (size_t k = 0; k < n; k += 31)
                    if (w[k]) {
                        w[k] = 0;
                        a[k] = b[k] = 0;
                    }
            rc_preconditioner_apply(e, a, 0, za, NULL, NULL);
            rc_preconditioner_apply(e, b, 0, zb, NULL, NULL);
            ab = product(n, a, zb);
            ba = product(n, b, za);
            aa = product(n, a, za);
            bb = product(n, b, zb);
            assert_true(aa > 0 && bb > 0);
            worst = fmax(worst, fabs(ab - ba) / sqrt(aa * bb));
            least = fmin(least, fmin(aa / product(n, a, a), bb / product(n, b, b)));
            for (size_t k = 0; k < n; k++)
                assert_true(w[k] || za[k] == 0);
        }
        rc_preconditioner_free(e);
        rc_operator_free(op);
        free(w);
        free(v);
    }
    print_message("asymmetry %.1e, least r'z / r'r %.3f\n", worst, least);
    assert_true(worst < 1e-5);
    assert_true(least > 0);
}

/* K between the nodes of W in the units of the operator's rows, column by column through the engine. */
static gsl_matrix *
restricted(const struct rc_operator *op, const struct rc_pair *pair, const size_t *at, size_t count)
{
    size_t n = op->shape.nx * op->shape.ny;
    double *p = calloc(n, sizeof *p), *u = malloc(n * sizeof *u);
    struct rc_conv_options options = {.boundary = op->boundary, .engine = "fft"};
    struct rc_err err;
    struct rc_conv *conv = rc_conv_new(&op->shape, pair, &options, &err);
    gsl_matrix *k = gsl_matrix_alloc(count, count);

    assert_non_null(conv);
    for (size_t j = 0; j < count; j++) {
        p[at[j]] = 1;
        rc_conv_apply(conv, p, u);
        p[at[j]] = 0;
        for (size_t i = 0; i < count; i++)
            gsl_matrix_set(k, i, j, u[at[i]] / op->unit);
    }
    rc_conv_free(conv);
    free(p);
    free(u);
    return k;
}

/* B = E'AE between the nodes of W. */
static gsl_matrix *
corrections(struct rc_operator *op, const unsigned char *w, const size_t *at, size_t count)
{
    size_t n = op->shape.nx * op->shape.ny;
    float *r = calloc(n, sizeof *r), *z = malloc(n * sizeof *z);
    struct rc_err err;
    struct rc_preconditioner *e = rc_preconditioner_new(op, &err);
    gsl_matrix *b = gsl_matrix_alloc(count, count);

    assert_non_null(e);
    rc_preconditioner_set(e, w);
    for (size_t j = 0; j < count; j++) {
        r[at[j]] = 1;
        rc_preconditioner_apply(e, r, 0, z, NULL, NULL);
        r[at[j]] = 0;
        for (size_t i = 0; i < count; i++)
            gsl_matrix_set(b, i, j, (double)z[at[i]]);
    }
    rc_preconditioner_free(e);
    free(r);
    free(z);
    return b;
}

/* Columns of (count) x (count - 1) that span the vectors of zero mean, orthonormal (Helmert). */
static gsl_matrix *
without_mean(size_t count)
{
    gsl_matrix *q = gsl_matrix_calloc(count, count - 1);

    for (size_t j = 0; j + 1 < count; j++) {
        double m = (double)j + 1, size = sqrt(m * (m + 1));
        for (size_t i = 0; i <= j; i++)
            gsl_matrix_set(q, i, j, 1 / size);
        gsl_matrix_set(q, j + 1, j, -m / size);
    }
    return q;
}

static gsl_matrix *
projected(const gsl_matrix *m, const gsl_matrix *q)
{
    gsl_matrix *t = gsl_matrix_alloc(m->size1, q->size2), *c = gsl_matrix_alloc(q->size2, q->size2);

    gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, m, q, 0, t);
    gsl_blas_dgemm(CblasTrans, CblasNoTrans, 1, q, t, 0, c);
    gsl_matrix_free(t);
    return c;
}

/* The smallest and the largest eigenvalue of B K on vectors of zero mean, as in the solver. With K = L L',
 * the matrix L' B L has the same eigenvalues. */
static void
extremes(const gsl_matrix *k, const gsl_matrix *b, double *least, double *most)
{
    gsl_matrix *z = without_mean(k->size1), *l = projected(k, z), *c = projected(b, z);
    gsl_vector *values = gsl_vector_alloc(l->size1);
    gsl_eigen_symm_workspace *workspace = gsl_eigen_symm_alloc(l->size1);

    assert_int_equal(gsl_linalg_cholesky_decomp1(l), GSL_SUCCESS);
    gsl_blas_dtrmm(CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, 1, l, c);
    gsl_blas_dtrmm(CblasLeft, CblasLower, CblasTrans, CblasNonUnit, 1, l, c);
    gsl_eigen_symm(c, values, workspace);
    gsl_vector_minmax(values, least, most);
    gsl_eigen_symm_free(workspace);
    gsl_vector_free(values);
    gsl_matrix_free(l);
    gsl_matrix_free(c);
    gsl_matrix_free(z);
}

/* If all eigenvalues are at least 1, r'z >= r' (K_WW)^-1 r holds. The error estimate is then not below the
 * error in the energy norm. The largest eigenvalue is 1.28 on one material (free, contact of a rough
 * surface), and 1.61, 2.52 and 1.23 under these coats on periodic maps. On the free boundary A of a stiff
 * coat is not exact, because its padded kernel may be negative. The margin of this small map is as narrow as
 * the bending length of the coats, and the eigenvalues are 0.98 to 13. */
static void
spectrum(void **state)
{
    static const struct rc_layer coats[] = {{2, 40, 0.3}, {2, 400, 0.3}, {8, 400, 0.3}};
    static const struct {
        const char *name;
        struct rc_pair pair;
        double above;
    } bodies[] = {
        {"one material", {.estar = 1}, 1.4},
        {"40, 2", {.one = {1, 0.3, 1, &coats[0]}, .two = {.e = INFINITY}}, 1.8},
        {"400, 2", {.one = {1, 0.3, 1, &coats[1]}, .two = {.e = INFINITY}}, 2.8},
        {"400, 8", {.one = {1, 0.3, 1, &coats[2]}, .two = {.e = INFINITY}}, 1.35},
    };
    const double unit = sqrt(1.2);
    const struct rc_shape s = {32, 32, 1 / unit, 1.2 / unit};
    size_t n = s.nx * s.ny;
    unsigned char *w = malloc(n);
    size_t *at = malloc(n * sizeof *at);

    (void)state;
    for (size_t q = 0; q < SETS * (1 + sizeof bodies / sizeof *bodies); q++) {
        size_t body = q < SETS ? 0 : q / SETS - 1, set = q % SETS, count = 0;
        struct rc_operator_options options = {.boundary = q < SETS ? RC_FREE : RC_PERIODIC,
                                              .pair = &bodies[body].pair};
        struct rc_err err;
        struct rc_operator *op = rc_operator_new(&s, &options, &err);
        gsl_matrix *k, *b;
        double least, most;

        assert_non_null(op);
        (void)choose((struct rc_shape){s.nx, s.ny, 1e-6, 1.2e-6}, options.boundary,
                     (enum set_name)set, w);
        if (set == ALMOST_ALL ||
            set == RANDOM) /* a dense problem: three quarters of the rows are enough */
            for (size_t i = 0; i < n; i++)
                w[i] = w[i] && i / s.nx % 4 != 3;
        for (size_t i = 0; i < n; i++)
            if (w[i])
                at[count++] = i;
        k = restricted(op, &bodies[body].pair, at, count);
        b = corrections(op, w, at, count);
        extremes(k, b, &least, &most);
        print_message("%-12s %-10s %s, %3zu nodes: eigenvalues %.5f to %.3f\n", bodies[body].name,
                      set_names[set], rc_boundary_word(options.boundary), count, least, most);
        assert_true(least >= 1 - 1e-4);
        assert_true(most <= bodies[body].above);
        gsl_matrix_free(k);
        gsl_matrix_free(b);
        rc_operator_free(op);
    }
    free(w);
    free(at);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(symmetric_and_positive),
        cmocka_unit_test(spectrum),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
