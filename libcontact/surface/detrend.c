/*
 * The least-squares polynomial over the points that are there. Products of Legendre polynomials on
 * the points' bounding box keep the equations well conditioned. A QR factorisation that takes the
 * equations block by block (GSL's tall-skinny QR) keeps memory small, and its condition number
 * shows when the points do not determine the polynomial.
 */
#include "libcontact/contact.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_matrix.h>
#include <gsl/gsl_multilarge.h>
#include <gsl/gsl_vector.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>

enum {
    BLOCK = 1024 /* points that are factored at a time; above the largest number of terms */
};

/* Reciprocal condition number below which the points do not determine the polynomial. */
static const double deficient = 1e-12;

struct fit {
    const struct rc_shape *shape;
    const double *h;
    double mean;                       /* subtracted first: a large datum would cost digits   */
    size_t nx_terms, ny_terms, degree; /* polynomials along x, along y; their sum's bound */
    size_t terms;
    double *px, *py;       /* Legendre polynomials: px[a * nx + i], py[b * ny + j] */
    gsl_matrix *equations; /* a block of them */
    gsl_vector *heights, *coefficients;
    gsl_multilarge_linear_workspace *work;
};

/* The bounding box of the points that are there, and how many they are. */
struct box {
    size_t left, right, top, bottom, count, infinite;
};

static struct box
bounding_box(const struct rc_shape *shape, const double *h)
{
    struct box b = {.left = shape->nx, .top = shape->ny};

    for (size_t j = 0; j < shape->ny; j++)
        for (size_t i = 0; i < shape->nx; i++) {
            double v = h[j * shape->nx + i];
            if (isnan(v))
                continue;
            b.count++;
            b.infinite += isinf(v) != 0;
            b.left = i < b.left ? i : b.left;
            b.right = i > b.right ? i : b.right;
            b.top = j < b.top ? j : b.top;
            b.bottom = j > b.bottom ? j : b.bottom;
        }
    return b;
}

/* P_0 ... P_(terms-1) at the n nodes of a side, first..last being -1..1 (Bonnet's recursion). */
static double *
legendre(size_t terms, size_t n, size_t first, size_t last)
{
    double middle = 0.5 * ((double)first + (double)last);
    double half = last > first ? 0.5 * (double)(last - first) : 1;
    double *p = NULL;
    size_t size;

    if (rc_size_mul(terms * sizeof *p, n, &size, NULL) != RC_OK || (p = malloc(size)) == NULL)
        return NULL;
    for (size_t i = 0; i < n; i++) {
        double s = ((double)i - middle) / half, before = 0, now = 1;
        for (size_t a = 0; a < terms; a++) {
            double next = ((2 * (double)a + 1) * s * now - (double)a * before) / ((double)a + 1);
            p[a * n + i] = now;
            before = now;
            now = next;
        }
    }
    return p;
}

static void
fit_free(struct fit *f)
{
    gsl_multilarge_linear_free(f->work);
    gsl_vector_free(f->coefficients);
    gsl_vector_free(f->heights);
    gsl_matrix_free(f->equations);
    free(f->px);
    free(f->py);
}

static size_t
count_terms(size_t nx_terms, size_t ny_terms, size_t degree)
{
    size_t n = 0;

    for (size_t b = 0; b < ny_terms; b++)
        for (size_t a = 0; a < nx_terms && a + b <= degree; a++)
            n++;
    return n;
}

static enum rc_status
fit_new(struct fit *f, const struct rc_shape *shape, size_t degree, const double *h,
        struct rc_err *err)
{
    struct rc_statistics figures;
    struct box box = bounding_box(shape, h);

    *f = (struct fit){.shape = shape, .h = h, .degree = degree};
    if (degree > RC_DEGREE_MAX)
        return rc_err_set(err, "a polynomial of degree %zu: at most %d", degree, RC_DEGREE_MAX);
    f->nx_terms = shape->nx > 1 ? degree + 1 : 1;
    f->ny_terms = shape->ny > 1 ? degree + 1 : 1;
    f->terms = count_terms(f->nx_terms, f->ny_terms, degree);
    if (box.infinite > 0)
        return rc_err_set(err, "%zu infinite heights: no polynomial fits them", box.infinite);
    if (box.count < f->terms)
        return rc_err_set(err,
                          "a polynomial of degree %zu has %zu coefficients, and only %zu "
                          "points are there: take a lower degree",
                          degree, f->terms, box.count);
    rc_measure(shape, h, &figures);
    f->mean = figures.mean;
    f->px = legendre(f->nx_terms, shape->nx, box.left, box.right);
    f->py = legendre(f->ny_terms, shape->ny, box.top, box.bottom);
    f->equations = gsl_matrix_alloc(BLOCK, f->terms);
    f->heights = gsl_vector_alloc(BLOCK);
    f->coefficients = gsl_vector_alloc(f->terms);
    f->work = gsl_multilarge_linear_alloc(gsl_multilarge_linear_tsqr, f->terms);
    if (f->px == NULL || f->py == NULL || f->equations == NULL || f->heights == NULL ||
        f->coefficients == NULL || f->work == NULL)
        return rc_err_set(err, "out of memory for a polynomial of degree %zu", degree);
    return RC_OK;
}

/* Equation k of a block, of the point (i, j): its terms, and its height. */
static void
put_equation(struct fit *f, size_t k, size_t i, size_t j)
{
    const struct rc_shape *s = f->shape;
    double *to = gsl_matrix_ptr(f->equations, k, 0);

    for (size_t b = 0; b < f->ny_terms; b++)
        for (size_t a = 0; a < f->nx_terms && a + b <= f->degree; a++)
            *to++ = f->px[a * s->nx + i] * f->py[b * s->ny + j];
    gsl_vector_set(f->heights, k, f->h[j * s->nx + i] - f->mean);
}

/* Hands the first n equations of the block to GSL, which wants at least as many as there are terms:
 * those that are missing are 0 = 0. */
static int
factor_block(struct fit *f, size_t n)
{
    size_t m = n < f->terms ? f->terms : n;
    gsl_matrix_view equations = gsl_matrix_submatrix(f->equations, 0, 0, m, f->terms);
    gsl_vector_view heights = gsl_vector_subvector(f->heights, 0, m);

    for (size_t k = n; k < m; k++) {
        for (size_t term = 0; term < f->terms; term++)
            gsl_matrix_set(f->equations, k, term, 0);
        gsl_vector_set(f->heights, k, 0);
    }
    return gsl_multilarge_linear_accumulate(&equations.matrix, &heights.vector, f->work);
}

static enum rc_status
solve(struct fit *f, struct rc_err *err)
{
    double rcond = 0, residual, norm;
    size_t n = 0; /* equations in the block */
    int code = GSL_SUCCESS;

    for (size_t j = 0; j < f->shape->ny; j++)
        for (size_t i = 0; i < f->shape->nx && code == GSL_SUCCESS; i++) {
            if (isnan(f->h[j * f->shape->nx + i]))
                continue;
            put_equation(f, n++, i, j);
            if (n == BLOCK) {
                code = factor_block(f, n);
                n = 0;
            }
        }
    if (code == GSL_SUCCESS && n > 0)
        code = factor_block(f, n);
    if (code != GSL_SUCCESS)
        return rc_err_set(err, "the fit failed: %s", gsl_strerror(code));
    code = gsl_multilarge_linear_rcond(&rcond, f->work);
    if (code != GSL_SUCCESS || !(rcond > deficient))
        return rc_err_set(err,
                          "the points that are there do not determine a polynomial of degree "
                          "%zu: too few rows or columns of them, or all on one curve; take a "
                          "lower degree",
                          f->degree);
    code = gsl_multilarge_linear_solve(0, f->coefficients, &residual, &norm, f->work);
    if (code != GSL_SUCCESS)
        return rc_err_set(err, "the fit failed: %s", gsl_strerror(code));
    return RC_OK;
}

/* h - mean - polynomial. In one row of the map that is a polynomial in x alone, with these
 * coefficients. */
static void
subtract(const struct fit *f, double *h)
{
    size_t nx = f->shape->nx, ny = f->shape->ny;

    for (size_t j = 0; j < ny; j++) {
        double in_x[RC_DEGREE_MAX + 1] = {0}, *row = h + j * nx;
        const double *c = f->coefficients->data;
        for (size_t b = 0; b < f->ny_terms; b++)
            for (size_t a = 0; a < f->nx_terms && a + b <= f->degree; a++)
                in_x[a] += *c++ * f->py[b * ny + j];
        for (size_t i = 0; i < nx; i++) {
            double value = 0;
            for (size_t a = 0; a < f->nx_terms; a++)
                value += in_x[a] * f->px[a * nx + i];
            row[i] = (row[i] - f->mean) - value;
        }
    }
}

/* GSL has one error handler for all threads, and its default ends the process: it is off while a
 * fit is made, by one thread at a time. */
static pthread_mutex_t handler_lock = PTHREAD_MUTEX_INITIALIZER;

enum rc_status
rc_detrend_poly(const struct rc_shape *shape, size_t degree, double *h, struct rc_err *err)
{
    gsl_error_handler_t *handler;
    enum rc_status status;
    struct fit f;

    pthread_mutex_lock(&handler_lock);
    handler = gsl_set_error_handler_off();
    status = fit_new(&f, shape, degree, h, err);
    if (status == RC_OK)
        status = solve(&f, err);
    if (status == RC_OK)
        subtract(&f, h);
    fit_free(&f);
    gsl_set_error_handler(handler);
    pthread_mutex_unlock(&handler_lock);
    return status;
}
