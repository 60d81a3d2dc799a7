/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The least-squares polynomial over the measured points, in products of Chebyshev polynomials on the bounding
 * box of these points.
 *
 * The product of two Chebyshev polynomials is the mean of two others, of the sum and the difference of their
 * degrees. So the normal equations follow from sums of the weights times single products, up to twice the
 * degree, which are first summed along rows. The normal equations square the condition number of the problem;
 * the residual of their solution does not suffer from this, and corrects the solution. Where this is not
 * enough, a QR factorisation processes the points' equations block by block (GSL's tall-skinny QR). Its
 * condition number shows whether the points determine the polynomial.
 */
#include "libcontact/common.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_matrix.h>
#include <gsl/gsl_multilarge.h>
#include <gsl/gsl_vector.h>
#include <math.h>
#include <omp.h>
#include <string.h>

#include "form.h"
#include "handler.h"
#include "libcontact/memory.h"
#include "libcontact/surface/parameters/measure.h"
#include "robust.h"

enum {
    BLOCK = 1024,     /* points that are factored together; more than the largest number of terms */
    ROWS = 512,       /* rows of the map that are summed together */
    WINDOW = 1 << 20, /* values of rows that are read together */
    CORRECTIONS = 4   /* corrections of a solution of the normal equations */
};

/* Reciprocal condition numbers. Below the first limit for the normal equations the QR factorisation is used.
 * Below the second one for the QR factorisation the points do not determine the polynomial. */
static const double too_squared = 1e-10;
static const double deficient = 1e-12;

/* T_a(x) T_b(y) */
struct term {
    size_t a, b;
};

/* The polynomials: products of one along x and one along y. */
struct basis {
    size_t nx_terms, ny_terms, degree; /* polynomials along x, along y; largest total degree */
    size_t terms;
    struct term term[(RC_DEGREE_MAX + 1) * (RC_DEGREE_MAX + 2) / 2];
    size_t nx_orders, ny_orders; /* orders of the products of two polynomials */
    double *px, *py;             /* Chebyshev polynomials: px[a * nx + i], py[b * ny + j] */
};

/* The normal equations. */
struct system {
    double *rows;         /* sums of ROWS rows: nx_orders sums of w px, nx_terms sums of w e px */
    double *of_weights;   /* sums over the map of w T_k(x) T_l(y): at l nx_orders + k */
    double *of_residuals; /* sums of w e T_k(x) T_l(y): at l nx_terms + k */
    double *step;         /* correction of the coefficients */
    gsl_matrix *normal;
    gsl_vector *scale, *right;
};

struct fit {
    const struct rc_shape *shape;
    const double *h; /* from row `first` on: in memory, or rows that were read last to `window` */
    size_t first;
    const struct rc_row_source *from; /* NULL: in memory */
    double *window;
    bool failed; /* they could not be read, and why */
    struct rc_err problem;
    double mean; /* subtracted first, because a large constant would cost digits */
    struct basis basis;
    int threads;
    bool missing;
    double *c;               /* coefficients of the terms */
    double *residual, reach; /* robust: h - mean - polynomial, for the weights; else NULL */
    double *lines;           /* memory for each thread: e, w and w e of a row */
    struct system system;
    struct rc_store own;
};

static size_t
row_sums(const struct basis *basis)
{
    return basis->nx_orders + basis->nx_terms;
}

struct rc_box
rc_box_none(const struct rc_shape *shape)
{
    return (struct rc_box){.left = shape->nx, .top = shape->ny};
}

void
rc_box_add(struct rc_box *b, size_t nx, size_t first, size_t n, const double *h)
{
    for (size_t j = first; j < first + n; j++, h += nx)
        for (size_t i = 0; i < nx; i++) {
            double v = h[i];
            if (isnan(v))
                continue;
            b->count++;
            b->infinite += isinf(v) != 0;
            b->left = i < b->left ? i : b->left;
            b->right = i > b->right ? i : b->right;
            b->top = j < b->top ? j : b->top;
            b->bottom = j > b->bottom ? j : b->bottom;
        }
}

struct rc_box
rc_box_of(const struct rc_shape *shape, const double *h)
{
    struct rc_box b = rc_box_none(shape);

    rc_box_add(&b, shape->nx, 0, shape->ny, h);
    return b;
}

/* ---- the heights, in memory or elsewhere ---- */

static const double *
row_of(const struct fit *f, size_t j)
{
    return f->h + (j - f->first) * f->shape->nx;
}

/* The number of rows from row j on that are used together. */
static size_t
together(const struct fit *f, size_t j)
{
    const size_t most = f->from == NULL || WINDOW / f->shape->nx > ROWS ? ROWS
                        : WINDOW / f->shape->nx > 0                     ? WINDOW / f->shape->nx
                                                                        : 1;

    return f->shape->ny - j < most ? f->shape->ny - j : most;
}

/* Reads n rows from row j on, which follows those of the last call or is 0. After a failure nothing is read
 * any more. */
static void
fetch(struct fit *f, size_t j, size_t n)
{
    const struct rc_row_source *from = f->from;

    if (from == NULL || f->failed)
        return;
    f->failed = (j == 0 && from->again(from->ctx, &f->problem) != RC_OK) ||
                from->get(from->ctx, n, f->window, &f->problem) != RC_OK;
    f->first = j;
}

/* T_0 ... T_(orders-1) at the n nodes of a side, first..last being -1..1. */
static double *
chebyshev(struct rc_store *own, size_t orders, size_t n, size_t first, size_t last)
{
    double middle = 0.5 * ((double)first + (double)last);
    double half = last > first ? 0.5 * (double)(last - first) : 1;
    double *p = rc_store_take(own, n, orders * sizeof *p);

    for (size_t i = 0; i < n && p != NULL; i++) {
        double s = ((double)i - middle) / half, before = s, now = 1;
        for (size_t a = 0; a < orders; a++) {
            double next = 2 * s * now - before;
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
    gsl_matrix_free(f->system.normal);
    gsl_vector_free(f->system.scale);
    gsl_vector_free(f->system.right);
    rc_store_free(&f->own);
}

static enum rc_status
fit_allocate(struct fit *f, const struct rc_box *box, bool robust, struct rc_err *err)
{
    const struct rc_shape *s = f->shape;

    f->basis.px = chebyshev(&f->own, f->basis.nx_orders, s->nx, box->left, box->right);
    f->basis.py = chebyshev(&f->own, f->basis.ny_orders, s->ny, box->top, box->bottom);
    f->c = rc_store_zeros(&f->own, 2 * f->basis.terms, sizeof *f->c);
    f->system.rows = rc_store_take(&f->own, ROWS, row_sums(&f->basis) * sizeof *f->system.rows);
    f->system.of_weights = rc_store_take(&f->own, row_sums(&f->basis),
                                         f->basis.ny_orders * sizeof *f->system.of_weights);
    f->lines = rc_store_take(&f->own, s->nx, 3 * (size_t)f->threads * sizeof *f->lines);
    f->system.normal = gsl_matrix_alloc(f->basis.terms, f->basis.terms);
    f->system.scale = gsl_vector_alloc(f->basis.terms);
    f->system.right = gsl_vector_alloc(f->basis.terms);
    if (robust)
        f->residual = rc_store_take(&f->own, s->nx * s->ny, sizeof *f->residual);
    if (f->own.failed || f->system.normal == NULL || f->system.scale == NULL ||
        f->system.right == NULL)
        return rc_err_set(err, "out of memory for a polynomial of degree %zu", f->basis.degree);
    f->system.step = f->c + f->basis.terms;
    f->system.of_residuals = f->system.of_weights + f->basis.nx_orders * f->basis.ny_orders;
    return RC_OK;
}

/* The first pass: where heights are, and their mean. */
static void
look_through(struct fit *f, struct rc_box *box)
{
    const size_t nx = f->shape->nx;
    struct rc_first figures;

    *box = rc_box_none(f->shape);
    rc_first_begin(&figures);
    for (size_t n, j = 0; j < f->shape->ny; j += n) {
        n = together(f, j);
        fetch(f, j, n);
        rc_box_add(box, nx, j, n, row_of(f, j));
        for (size_t k = 0; k < n; k++)
            rc_first_row(&figures, row_of(f, j + k), nx);
    }
    f->mean = rc_first_mean(&figures);
}

static enum rc_status
fit_new(struct fit *f, const struct rc_shape *shape, const struct rc_form *form, const double *h,
        const struct rc_row_source *from, struct rc_err *err)
{
    struct rc_box box;

    *f = (struct fit){.shape = shape, .h = h, .from = from, .basis.degree = form->degree};
    if (f->basis.degree > RC_DEGREE_MAX)
        return rc_err_set(err, "a polynomial of degree %zu: at most %d", f->basis.degree,
                          RC_DEGREE_MAX);
    f->basis.nx_terms = shape->nx > 1 ? f->basis.degree + 1 : 1;
    f->basis.ny_terms = shape->ny > 1 ? f->basis.degree + 1 : 1;
    f->basis.nx_orders = 2 * f->basis.nx_terms - 1;
    f->basis.ny_orders = 2 * f->basis.ny_terms - 1;
    for (size_t b = 0; b < f->basis.ny_terms; b++)
        for (size_t a = 0; a < f->basis.nx_terms && a + b <= f->basis.degree; a++)
            f->basis.term[f->basis.terms++] = (struct term){a, b};
    f->threads = rc_useful_threads(shape, form->threads);
    if (from != NULL)
        f->h = f->window = rc_store_take(&f->own, shape->nx, together(f, 0) * sizeof *f->window);
    if (f->h == NULL)
        return rc_err_set(err, "out of memory for %zu rows of heights", together(f, 0));
    look_through(f, &box);
    if (f->failed)
        return RC_FAIL;
    f->missing = box.count < shape->nx * shape->ny;
    if (box.infinite > 0)
        return rc_err_set(err, "%zu infinite heights: no polynomial fits them", box.infinite);
    if (box.count < f->basis.terms)
        return rc_err_set(err,
                          "a polynomial of degree %zu has %zu coefficients, and only %zu "
                          "points are there: take a lower degree",
                          f->basis.degree, f->basis.terms, box.count);
    return fit_allocate(f, &box, form->robust, err);
}

/* ---- along rows ---- */

/* Sums over a row of v times each of `orders` polynomials. */
RC_CLONES static void
multiply_sum(size_t n, size_t orders, const double *restrict v, const double *restrict p,
             double *restrict out)
{
    for (size_t a = 0; a < orders; a++, p += n) {
        double sum = 0;
#pragma omp simd reduction(+ : sum)
        for (size_t i = 0; i < n; i++)
            sum += v[i] * p[i];
        out[a] = sum;
    }
}

/* computes to = from - mean - sum of c_a px_a */
RC_CLONES static void
subtract_row(size_t n, size_t terms, const double *c, const double *restrict px, double mean,
             const double *from, double *to, double *restrict value)
{
    memset(value, 0, n * sizeof *value);
    for (size_t a = 0; a < terms; a++, px += n)
        for (size_t i = 0; i < n; i++)
            value[i] += c[a] * px[i];
    for (size_t i = 0; i < n; i++)
        to[i] = (from[i] - mean) - value[i];
}

/* `to` = h - mean - polynomial in row j, where it is a polynomial in x alone. */
static void
residual_row(const struct fit *f, size_t j, double *to, double *scratch)
{
    double in_x[RC_DEGREE_MAX + 1] = {0};

    for (size_t t = 0; t < f->basis.terms; t++)
        in_x[f->basis.term[t].a] += f->c[t] * f->basis.py[f->basis.term[t].b * f->shape->ny + j];
    subtract_row(f->shape->nx, f->basis.nx_terms, in_x, f->basis.px, f->mean, row_of(f, j), to,
                 scratch);
}

static double *
lines_of(const struct fit *f)
{
    return f->lines + 3 * (size_t)omp_get_thread_num() * f->shape->nx;
}

/* Subtracts everywhere, into `to`, which may be h. */
static void
subtract(const struct fit *f, double *to)
{
#pragma omp parallel for schedule(static) num_threads(f->threads)
    for (size_t j = 0; j < f->shape->ny; j++)
        residual_row(f, j, to + j * f->shape->nx, lines_of(f));
}

/* Residuals e and weights w of a row, both 0 at missing points, and w e. */
static void
weigh_row(const struct fit *f, size_t j, double *e, double *w, double *we)
{
    size_t nx = f->shape->nx;

    if (f->residual != NULL)
        memcpy(e, f->residual + j * nx, nx * sizeof *e);
    else
        residual_row(f, j, e, w);
    for (size_t i = 0; i < nx; i++) {
        bool there = !isnan(e[i]);
        w[i] = !there ? 0 : f->reach > 0 ? rc_biweight(e[i], f->reach) : 1;
        e[i] = there ? e[i] : 0;
        we[i] = w[i] * e[i];
    }
}

/* Sums of w e and, with `weights`, of w over the rows from `first` on. */
static void
sum_rows(const struct fit *f, size_t first, size_t count, bool weights)
{
    size_t nx = f->shape->nx;

#pragma omp parallel for schedule(static) num_threads(f->threads)
    for (size_t k = 0; k < count; k++) {
        double *e = lines_of(f), *w = e + nx, *we = w + nx,
               *to = f->system.rows + k * row_sums(&f->basis);
        weigh_row(f, first + k, e, w, we);
        if (weights)
            multiply_sum(nx, f->basis.nx_orders, w, f->basis.px, to);
        multiply_sum(nx, f->basis.nx_terms, we, f->basis.px, to + f->basis.nx_orders);
    }
}

/* adds T_l(y) times row[k] to to[l n + k], for all l */
static void
add_row(const struct fit *f, size_t j, const double *row, size_t n, size_t orders, double *to)
{
    for (size_t l = 0; l < orders; l++)
        for (size_t k = 0; k < n; k++)
            to[l * n + k] += f->basis.py[l * f->shape->ny + j] * row[k];
}

/* Sums over the map, with `weights` also those of the weights. Without missing points and with equal weights,
 * the sums of the weights are the same in every row. */
static void
sum_map(struct fit *f, bool weights)
{
    size_t ny = f->shape->ny, orders = f->basis.nx_orders;
    bool alike = !f->missing && f->reach == 0;
    double first[2 * RC_DEGREE_MAX + 1];

    if (weights)
        memset(f->system.of_weights, 0, orders * f->basis.ny_orders * sizeof *f->system.of_weights);
    memset(f->system.of_residuals, 0,
           f->basis.nx_terms * f->basis.ny_terms * sizeof *f->system.of_residuals);
    if (weights && alike) {
        fetch(f, 0, 1);
        sum_rows(f, 0, 1, true);
        memcpy(first, f->system.rows, orders * sizeof *first);
    }
    for (size_t count, j = 0; j < ny; j += count) {
        count = together(f, j);
        fetch(f, j, count);
        sum_rows(f, j, count, weights && !alike);
        for (size_t k = 0; k < count; k++) {
            const double *row = f->system.rows + k * row_sums(&f->basis);
            if (weights)
                add_row(f, j + k, alike ? first : row, orders, f->basis.ny_orders,
                        f->system.of_weights);
            add_row(f, j + k, row + orders, f->basis.nx_terms, f->basis.ny_terms,
                    f->system.of_residuals);
        }
    }
}

/* ---- the normal equations ---- */

static size_t
apart(size_t a, size_t b)
{
    return a > b ? a - b : b - a;
}

/* The sum of two terms over the map: T_a T_b = (T_(a+b) + T_|a-b|) / 2 */
static double
of_product(size_t orders, const double *of_weights, struct term s, struct term t)
{
    size_t n = orders, more = s.a + t.a, less = apart(s.a, t.a);
    const double *high = of_weights + (s.b + t.b) * n, *low = of_weights + apart(s.b, t.b) * n;

    return 0.25 * (high[more] + high[less] + low[more] + low[less]);
}

static void
set_normal(const struct basis *basis, struct system *system)
{
    for (size_t k = 0; k < basis->terms; k++)
        for (size_t l = 0; l < basis->terms; l++)
            gsl_matrix_set(
                system->normal, k, l,
                of_product(basis->nx_orders, system->of_weights, basis->term[k], basis->term[l]));
}

/* Factors the normal equations; false when they are too badly conditioned. */
static bool
factor_normal(struct system *system, size_t terms)
{
    gsl_vector *work = gsl_vector_alloc(3 * terms);
    double rcond = 0;
    bool good = work != NULL &&
                gsl_linalg_cholesky_decomp2(system->normal, system->scale) == GSL_SUCCESS &&
                gsl_linalg_cholesky_rcond(system->normal, &rcond, work) == GSL_SUCCESS &&
                rcond > too_squared;

    gsl_vector_free(work);
    return good;
}

/* Adds the step to the coefficients; returns its largest entry. */
static double
take_step(double *c, const double *step, size_t terms)
{
    double largest = 0;

    for (size_t k = 0; k < terms; k++) {
        c[k] += step[k];
        largest = fmax(largest, fabs(step[k]));
    }
    return largest;
}

static double
solve_normal(const struct basis *basis, struct system *system, double *c)
{
    gsl_vector_view step = gsl_vector_view_array(system->step, basis->terms);

    for (size_t k = 0; k < basis->terms; k++)
        gsl_vector_set(system->right, k,
                       system->of_residuals[basis->term[k].b * basis->nx_terms + basis->term[k].a]);
    gsl_linalg_cholesky_solve2(system->normal, system->scale, system->right, &step.vector);
    return take_step(c, system->step, basis->terms);
}

/* ---- the factorisation of all equations ---- */

struct blocks {
    gsl_matrix *equations; /* one block of them */
    gsl_vector *heights;
    gsl_multilarge_linear_workspace *work;
};

/* Equation k of a block, of the point (i, j), its residual e and its weight. */
static void
put_equation(const struct basis *basis, const struct rc_shape *s, struct blocks *q, size_t k,
             size_t i, size_t j, double e, double w)
{
    double *to = gsl_matrix_ptr(q->equations, k, 0);

    for (size_t t = 0; t < basis->terms; t++)
        to[t] = sqrt(w) * basis->px[basis->term[t].a * s->nx + i] *
                basis->py[basis->term[t].b * s->ny + j];
    gsl_vector_set(q->heights, k, sqrt(w) * e);
}

/* Passes the first n equations of the block to GSL, which needs at least as many as there are terms. The
 * block is filled up with 0 = 0. */
static int
factor_block(size_t terms, struct blocks *q, size_t n)
{
    size_t m = n < terms ? terms : n;
    gsl_matrix_view equations = gsl_matrix_submatrix(q->equations, 0, 0, m, terms);
    gsl_vector_view heights = gsl_vector_subvector(q->heights, 0, m);

    for (size_t k = n; k < m; k++) {
        for (size_t term = 0; term < terms; term++)
            gsl_matrix_set(q->equations, k, term, 0);
        gsl_vector_set(q->heights, k, 0);
    }
    return gsl_multilarge_linear_accumulate(&equations.matrix, &heights.vector, q->work);
}

static int
factor_all(struct fit *f, struct blocks *q)
{
    double *e = f->lines, *w = e + f->shape->nx, *we = w + f->shape->nx;
    int code = GSL_SUCCESS;
    size_t n = 0; /* equations in the block */

    for (size_t j = 0; j < f->shape->ny; j++) {
        fetch(f, j, 1);
        weigh_row(f, j, e, w, we);
        for (size_t i = 0; i < f->shape->nx && code == GSL_SUCCESS; i++) {
            if (!(w[i] > 0))
                continue;
            put_equation(&f->basis, f->shape, q, n++, i, j, e[i], w[i]);
            if (n == BLOCK) {
                code = factor_block(f->basis.terms, q, n);
                n = 0;
            }
        }
    }
    return code == GSL_SUCCESS && n > 0 ? factor_block(f->basis.terms, q, n) : code;
}

static enum rc_status
solve_blocks(struct fit *f, struct blocks *q, struct rc_err *err)
{
    gsl_vector_view step = gsl_vector_view_array(f->system.step, f->basis.terms);
    double rcond = 0, residual, norm;
    int code;

    q->equations = gsl_matrix_alloc(BLOCK, f->basis.terms);
    q->heights = gsl_vector_alloc(BLOCK);
    q->work = gsl_multilarge_linear_alloc(gsl_multilarge_linear_tsqr, f->basis.terms);
    if (q->equations == NULL || q->heights == NULL || q->work == NULL)
        return rc_err_set(err, "out of memory for a polynomial of degree %zu", f->basis.degree);
    if ((code = factor_all(f, q)) != GSL_SUCCESS)
        return rc_err_set(err, "the fit failed: %s", gsl_strerror(code));
    code = gsl_multilarge_linear_rcond(&rcond, q->work);
    if (code != GSL_SUCCESS || !(rcond > deficient))
        return rc_err_set(err,
                          "the points that %s do not determine a polynomial of degree %zu: too few "
                          "rows or columns of them, or all on one curve; take a lower degree",
                          f->reach > 0 ? "are left with weight" : "are there", f->basis.degree);
    code = gsl_multilarge_linear_solve(0, &step.vector, &residual, &norm, q->work);
    if (code != GSL_SUCCESS)
        return rc_err_set(err, "the fit failed: %s", gsl_strerror(code));
    take_step(f->c, f->system.step, f->basis.terms);
    return RC_OK;
}

static enum rc_status
solve_all(struct fit *f, struct rc_err *err)
{
    struct blocks q = {0};
    enum rc_status status = solve_blocks(f, &q, err);

    gsl_multilarge_linear_free(q.work);
    gsl_vector_free(q.heights);
    gsl_matrix_free(q.equations);
    return status;
}

/* ---- the fit ---- */

/* The least-squares polynomial with the present weights, from any initial coefficients. */
static enum rc_status
solve(struct fit *f, struct rc_err *err)
{
    double first;

    sum_map(f, true);
    set_normal(&f->basis, &f->system);
    if (!factor_normal(&f->system, f->basis.terms))
        return solve_all(f, err);
    first = solve_normal(&f->basis, &f->system, f->c);
    for (size_t k = 0; k < CORRECTIONS && f->residual == NULL; k++) {
        sum_map(f, false);
        if (!(solve_normal(&f->basis, &f->system, f->c) > 1e-15 * first))
            break;
    }
    return RC_OK;
}

/* Alternates between weights from the residuals and a polynomial of these residuals that corrects the last
 * one. */
static enum rc_status
reweight(struct fit *f, double size, struct rc_err *err)
{
    size_t n = f->shape->nx * f->shape->ny;

    for (size_t k = 0; k < RC_REWEIGHT_MAX; k++) {
        double before = f->reach, reach;
        reach = rc_biweight_reach * rc_median(f->residual, n, 0, true, f->threads);
        if (rc_reweighted(reach, before, size))
            break;
        f->reach = reach;
        if (solve(f, err) != RC_OK)
            return RC_FAIL;
        subtract(f, f->residual);
    }
    return RC_OK;
}

static double
largest(const double *v, size_t n)
{
    double most = 0;

    for (size_t k = 0; k < n; k++)
        most = fabs(v[k]) > most ? fabs(v[k]) : most;
    return most;
}

static enum rc_status
fit_form(struct fit *f, struct rc_err *err)
{
    size_t n = f->shape->nx * f->shape->ny;
    double size;

    if (f->residual == NULL)
        return solve(f, err);
    subtract(f, f->residual);
    size = largest(f->residual, n);
    if (solve(f, err) != RC_OK)
        return RC_FAIL;
    subtract(f, f->residual);
    return reweight(f, size, err);
}

/* Subtracts from rows that are read once more, and writes them. */
static enum rc_status
subtract_rows(struct fit *f, struct rc_err *err)
{
    enum rc_status status = RC_OK;

    for (size_t n, j = 0; j < f->shape->ny && status == RC_OK && !f->failed; j += n) {
        n = together(f, j);
        fetch(f, j, n);
#pragma omp parallel for schedule(static) num_threads(f->threads)
        for (size_t k = 0; k < n; k++)
            residual_row(f, j + k, f->window + k * f->shape->nx, lines_of(f));
        if (!f->failed)
            status = f->from->put(f->from->ctx, n, f->window, err);
    }
    return status;
}

/* Of heights in memory, or from a source, which gets the result. */
static enum rc_status
detrend_polynomial(const struct rc_shape *shape, const struct rc_form *form, double *h,
                   const struct rc_row_source *from, struct rc_err *err)
{
    enum rc_status status;
    struct fit f;

    rc_handler_begin();
    status = fit_new(&f, shape, form, h, from, err);
    if (status == RC_OK)
        status = fit_form(&f, err);
    if (status == RC_OK && from == NULL)
        subtract(&f, h);
    else if (status == RC_OK && !f.failed)
        status = subtract_rows(&f, err);
    if (f.failed)
        status = rc_err_set(err, "%s", f.problem.text);
    fit_free(&f);
    rc_handler_end();
    return status;
}

enum rc_status
rc_detrend_source(const struct rc_shape *shape, const struct rc_form *form,
                  const struct rc_row_source *from, struct rc_err *err)
{
    if (form->kind != RC_POLYNOMIAL || form->robust)
        return rc_err_set(err, "row by row only a polynomial without weights is fitted");
    return detrend_polynomial(shape, form, NULL, from, err);
}

enum rc_status
rc_detrend_form(const struct rc_shape *shape, const struct rc_form *form, double *h, double *radius,
                struct rc_err *err)
{
    if (radius != NULL)
        *radius = NAN;
    if (form->kind == RC_POLYNOMIAL)
        return detrend_polynomial(shape, form, h, NULL, err);
    return rc_detrend_round(shape, form, h, radius, err);
}

enum rc_status
rc_detrend_rows(const struct rc_shape *shape, size_t degree, bool robust, double *h,
                struct rc_err *err)
{
    const struct rc_form form = {.degree = degree, .robust = robust, .threads = 1};
    const struct rc_shape line = {shape->nx, 1, shape->dx, shape->dy};

    if (degree > 2)
        return rc_err_set(err, "rows levelled with degree %zu: at most 2", degree);
    for (size_t j = 0; j < shape->ny; j++, h += shape->nx) {
        struct rc_box box = rc_box_of(&line, h);
        double median;

        if (box.infinite > 0)
            return rc_err_set(err, "%zu infinite heights in row %zu: it has no level", box.infinite,
                              j);
        if (degree > 0 && box.count >= 2 * (degree + 1)) {
            if (rc_detrend_form(&line, &form, h, NULL, err) != RC_OK)
                return RC_FAIL;
            continue;
        }
        median = rc_median(h, shape->nx, 0, false, 1);
        for (size_t i = 0; i < shape->nx; i++)
            h[i] -= median;
    }
    return RC_OK;
}
