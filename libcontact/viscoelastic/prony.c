/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Relaxation moduli and creep compliances of viscoelastic materials.
 *
 * The operational modulus is E(s) = E_0 + sum E_k s tau_k/(1 + s tau_k), and the operational compliance is
 * J(s) = 1/E(s). The poles of J are the zeros of E: s = -1/th with
 *
 *     f(th) = E_0 + sum E_k tau_k/(tau_k - th) = 0.
 *
 * f rises between its poles. One zero is therefore between two neighbouring tau_k, and with E_0 > 0 one more
 * is beyond the last tau_k. Bisection finds each of them, in a variable that resolves both ends of its
 * interval. Differences of times come from the nearer end: they do not cancel. The symmetric eigenproblem for
 * the same times loses all digits over 20 decades.
 */
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>

#include "libcontact/common.h"
#include "libcontact/memory.h"

/* Relaxation times a decade of a fit of storage and loss, and of one of E(t), whose terms end more
 * sharply. */
static const double usual_density = 1.5, usual_density_in_time = 4;
/* Storage and loss of a few sharp relaxation times need a denser grid: a term between two of its times leaves
 * a misfit of 12 % at 1.5 a decade, and of 0.5 % at 8. Smooth spectra and noise gain nothing, and more terms
 * cost time and memory. So the dense fit is taken only if the RMS error of the usual one exceeds
 * `close_enough`, and if the standard deviation by the free rows falls below this part of the former one. */
static const double dense_density = 8, close_enough = 0.005, denser_helps = 0.95;

static struct rc_relaxation *
allocate(size_t terms, struct rc_err *err)
{
    RC_OWN(rc_relaxation, r) = calloc(1, sizeof *r);

    if (r == NULL || (r->modulus = rc_alloc(4 * terms + 1, sizeof *r->modulus)) == NULL)
        return rc_err_null(err, "out of memory for %zu relaxation times", terms);
    r->time = r->modulus + terms;
    r->compliance = r->time + terms;
    r->retardation = r->compliance + terms;
    return rc_give(&r);
}

void
rc_relaxation_free(struct rc_relaxation *r)
{
    if (r != NULL)
        free(r->modulus);
    free(r);
}

/* ---- from relaxation to creep ---- */

/* A time between two ends, as its distances from both. */
struct between {
    double from_low, to_high;
};

/* x is any number: from -INFINITY at the lower end to INFINITY at the upper one. Without an upper end the
 * distance is `width` exp(x). */
static struct between
place(double x, double width, bool open)
{
    return open ? (struct between){width * exp(x), INFINITY}
                : (struct between){width / (1 + exp(-x)), width / (1 + exp(x))};
}

/* tau_k - th for a time between tau_low and the next one. */
static double
apart(const struct rc_relaxation *r, size_t k, size_t low, struct between th)
{
    return k <= low ? (r->time[k] - r->time[low]) - th.from_low
                    : (r->time[k] - r->time[low + 1]) + th.to_high;
}

/* The zero of f above tau_low. */
static struct between
find_zero(const struct rc_relaxation *r, size_t low)
{
    const bool open = low + 1 == r->terms;
    const double most =
        300; /* zeros nearer than exp(-300) of the interval to its end are at the end */
    double a = -most, b = most, width = open ? r->time[low] : r->time[low + 1] - r->time[low];

    for (;;) {
        const double x = a / 2 + b / 2;
        const struct between th = place(x, width, open);
        double f = r->relaxed;

        if (!(x > a && x < b))
            return th;
        for (size_t k = 0; k < r->terms; k++)
            f += r->modulus[k] * (r->time[k] / apart(r, k, low, th));
        *(f < 0 ? &a : &b) = x;
    }
}

static void
find_creep(struct rc_relaxation *r)
{
    double sum = r->relaxed, viscosity = 0;

    r->creep_terms = r->terms > 0 && r->relaxed == 0 ? r->terms - 1 : r->terms;
    for (size_t k = 0; k < r->terms; k++) {
        sum += r->modulus[k];
        viscosity += r->modulus[k] * r->time[k];
    }
    r->instant = 1 / sum;
    r->fluidity = r->relaxed == 0 ? 1 / viscosity : 0;
    for (size_t j = 0; j < r->creep_terms; j++) {
        const struct between at = find_zero(r, j);
        const double th = r->time[j] + at.from_low;
        double slope = 0; /* of E(s)/th at s = -1/th */
        for (size_t k = 0; k < r->terms; k++) {
            const double over = th / apart(r, k, j, at);
            slope += r->modulus[k] * (r->time[k] / th) * over * over;
        }
        r->retardation[j] = th;
        r->compliance[j] = 1 / slope;
    }
}

/* ---- makers ---- */

/* Puts a term in its place, in the order of the times. */
static enum rc_status
insert(struct rc_relaxation *r, double modulus, double time, struct rc_err *err)
{
    size_t k = r->terms;

    if (!(modulus >= 0) || isinf(modulus))
        return rc_err_set(err, "modulus %g Pa of a term: it must be at least 0 and finite",
                          modulus);
    if (!(time > 0) || isinf(time))
        return rc_err_set(err, "relaxation time %g s: it must be above 0 and finite", time);
    for (size_t j = 0; j < r->terms; j++)
        if (r->time[j] == time)
            return rc_err_set(err, "relaxation time %g s: it must be given only once", time);
    if (modulus == 0)
        return RC_OK;
    for (; k > 0 && r->time[k - 1] > time; k--) {
        r->time[k] = r->time[k - 1];
        r->modulus[k] = r->modulus[k - 1];
    }
    r->time[k] = time;
    r->modulus[k] = modulus;
    r->terms++;
    return RC_OK;
}

struct rc_relaxation *
rc_relaxation_new(double relaxed, size_t terms, const double *modulus, const double *time,
                  struct rc_err *err)
{
    RC_OWN(rc_relaxation, r) = allocate(terms, err);

    if (r == NULL)
        return NULL;
    r->relaxed = relaxed;
    if (!(relaxed >= 0) || isinf(relaxed))
        return rc_err_null(err, "relaxed modulus %g Pa: it must be at least 0 and finite", relaxed);
    for (size_t k = 0; k < terms; k++)
        if (insert(r, modulus[k], time[k], err) != RC_OK)
            return NULL;
    if (r->terms == 0 && relaxed == 0)
        return rc_err_null(err, "all moduli are 0: one must be above 0");
    find_creep(r);
    return rc_give(&r);
}

/* ---- values ---- */

double
rc_relaxation_modulus(const struct rc_relaxation *r, double t)
{
    double sum = r->relaxed;

    for (size_t k = 0; k < r->terms; k++)
        sum += r->modulus[k] * exp(-t / r->time[k]);
    return sum;
}

double
rc_relaxation_compliance(const struct rc_relaxation *r, double t)
{
    double sum = r->instant + r->fluidity * t;

    for (size_t j = 0; j < r->creep_terms; j++)
        sum -= r->compliance[j] * expm1(-t / r->retardation[j]);
    return sum;
}

/* 1/(1 + i x): its real part, and its imaginary part with the sign changed. */
static void
decay(double x, double *real, double *lag)
{
    *real = 1 / (1 + x * x);
    *lag = x > 1 ? 1 / (1 / x + x) : x / (1 + x * x);
}

void
rc_relaxation_dynamic(const struct rc_relaxation *r, double omega, double modulus[2],
                      double compliance[2])
{
    double real, lag;

    modulus[0] = r->relaxed;
    modulus[1] = 0;
    for (size_t k = 0; k < r->terms; k++) {
        decay(1 / (omega * r->time[k]), &real, &lag); /* i x/(1 + i x) = 1/(1 + 1/(i x)) */
        modulus[0] += r->modulus[k] * real;
        modulus[1] += r->modulus[k] * lag;
    }
    compliance[0] = r->instant;
    compliance[1] = r->fluidity > 0 ? -r->fluidity / omega : 0;
    for (size_t j = 0; j < r->creep_terms; j++) {
        decay(omega * r->retardation[j], &real, &lag);
        compliance[0] += r->compliance[j] * real;
        compliance[1] -= r->compliance[j] * lag;
    }
}

double
rc_relaxation_mean_compliance(const struct rc_relaxation *r, double omega)
{
    double sum = r->instant;

    for (size_t j = 0; j < r->creep_terms; j++) {
        const double y = omega * r->retardation[j];
        sum += r->compliance[j] * (y > 0 ? atan(y) / y : 1);
    }
    return sum;
}

/* ---- a master curve ---- */

/* Non-negative least squares (Lawson and Hanson 1974, Solving least squares problems, chapter 23): the x >= 0
 * with the least |a x - b|; the columns of a have the norm 1. */
struct fit {
    size_t rows, columns;
    double *a;            /* by rows */
    double *x, *trial;    /* columns */
    double *left;         /* rows: b - a x */
    double *part, *tau;   /* QR decomposition of the columns in use */
    double *right, *rest; /* rows: b                           */
    size_t *in_use, used;
};

static void
find_left(struct fit *f)
{
    for (size_t i = 0; i < f->rows; i++) {
        f->left[i] = f->right[i];
        for (size_t k = 0; k < f->columns; k++)
            f->left[i] -= f->a[i * f->columns + k] * f->x[k];
    }
}

/* Solves for the columns in use, without a sign. */
static void
solve_used(struct fit *f)
{
    gsl_matrix_view m = gsl_matrix_view_array(f->part, f->rows, f->used);
    gsl_vector_view tau = gsl_vector_view_array(f->tau, f->used);
    gsl_vector_view b = gsl_vector_view_array(f->right, f->rows);
    gsl_vector_view x = gsl_vector_view_array(f->trial, f->used);
    gsl_vector_view rest = gsl_vector_view_array(f->rest, f->rows);

    for (size_t i = 0; i < f->rows; i++)
        for (size_t q = 0; q < f->used; q++)
            f->part[i * f->used + q] = f->a[i * f->columns + f->in_use[q]];
    gsl_linalg_QR_decomp(&m.matrix, &tau.vector);
    gsl_linalg_QR_lssolve(&m.matrix, &tau.vector, &b.vector, &x.vector, &rest.vector);
}

/* Goes from x towards the trial until the first number is 0, and takes these columns out of use. */
static bool
shorten(struct fit *f)
{
    double along = 1;
    size_t kept = 0;

    for (size_t q = 0; q < f->used; q++)
        if (!(f->trial[q] > 0)) {
            const double x = f->x[f->in_use[q]];
            along = fmin(along, x > 0 ? x / (x - f->trial[q]) : 0);
        }
    for (size_t q = 0; q < f->used; q++) {
        double *x = &f->x[f->in_use[q]];
        const bool stops = !(f->trial[q] > 0) && (*x <= 0 || *x / (*x - f->trial[q]) <= along);
        *x = stops ? 0 : *x + along * (f->trial[q] - *x);
        f->in_use[kept] = f->in_use[q];
        kept += !stops;
    }
    if (kept == f->used)
        return false;
    f->used = kept;
    return kept > 0;
}

/* The unused column that lowers the misfit most; `columns`: none lowers it. */
static size_t
best_column(const struct fit *f, size_t except)
{
    double most = 1e-10 * sqrt((double)f->rows);
    size_t best = f->columns;

    for (size_t k = 0; k < f->columns; k++) {
        double along = 0;
        for (size_t i = 0; i < f->rows && f->x[k] == 0 && k != except; i++)
            along += f->a[i * f->columns + k] * f->left[i];
        if (along > most) {
            most = along;
            best = k;
        }
    }
    return best;
}

/* Rounding can make the last columns go round in a circle: the number of passes is limited. */
static void
least_squares(struct fit *f)
{
    size_t column, except = f->columns;

    for (size_t pass = 0; pass < 20 * f->columns; pass++) {
        find_left(f);
        if ((column = best_column(f, except)) == f->columns)
            return;
        f->in_use[f->used++] = column;
        do
            solve_used(f);
        while (shorten(f));
        except = f->x[column] > 0 ? f->columns : column;
    }
    find_left(f);
}

static void
fit_allocate(struct fit *f, struct rc_store *own, size_t rows, size_t columns)
{
    double **by_column[] = {&f->x, &f->trial, &f->tau},
           **by_row[] = {&f->left, &f->right, &f->rest};

    *f = (struct fit){.rows = rows, .columns = columns};
    f->in_use = rc_store_take(own, columns + 1, sizeof *f->in_use);
    f->a = rc_store_take(own, rows * columns, sizeof *f->a);
    f->part = rc_store_take(own, rows * columns, sizeof *f->part);
    for (size_t k = 0; k < 3; k++) {
        *by_column[k] = rc_store_zeros(own, columns, sizeof(double));
        *by_row[k] = rc_store_zeros(own, rows, sizeof(double));
    }
    for (size_t i = 0; i < rows && f->right != NULL; i++)
        f->right[i] = 1;
}

static enum rc_status
check_curve(size_t n, const double *omega, const double *storage, const double *loss,
            struct rc_err *err)
{
    const double *const v[] = {omega, storage, loss};
    static const char *const name[] = {"angular frequency", "storage modulus", "loss modulus"};

    if (n < 4)
        return rc_err_set(err, "a master curve of %zu frequencies: it must have at least 4", n);
    for (size_t i = 0; i < n; i++) {
        for (int c = 0; c < 3; c++)
            if (!(v[c][i] > 0) || isinf(v[c][i]))
                return rc_err_set(err, "%s %g in line %zu: it must be above 0 and finite", name[c],
                                  v[c][i], i + 1);
        for (size_t j = 0; j < i; j++)
            if (omega[i] == omega[j])
                return rc_err_set(err, "angular frequency %g rad/s: it must be given only once",
                                  omega[i]);
    }
    return RC_OK;
}

/* Column 0 is the relaxed modulus. Two rows a frequency, relative to the two moduli. */
static void
set_rows(struct fit *f, const double *time, const double *omega, const double *storage,
         const double *loss)
{
    for (size_t i = 0; i < f->rows / 2; i++)
        for (size_t k = 0; k < f->columns; k++) {
            double real = 1, lag = 0;
            if (k > 0)
                decay(1 / (omega[i] * time[k - 1]), &real, &lag);
            f->a[2 * i * f->columns + k] = real / storage[i];
            f->a[(2 * i + 1) * f->columns + k] = lag / loss[i];
        }
}

/* Gives the columns the norm 1, and stores their norms. */
static void
set_norms(struct fit *f, double *norm)
{
    for (size_t k = 0; k < f->columns; k++) {
        double sum = 0;
        for (size_t i = 0; i < f->rows; i++)
            sum += f->a[i * f->columns + k] * f->a[i * f->columns + k];
        norm[k] = sqrt(sum);
        for (size_t i = 0; i < f->rows; i++)
            f->a[i * f->columns + k] /= norm[k];
    }
}

/* Relaxation times even in the logarithm; `low` and `high` are the ends. */
static size_t
count_terms(size_t most, double low, double high, double per_decade)
{
    return (size_t)fmin((double)most, fmax(1, round(per_decade * log10(high / low))) + 1);
}

static double
even_time(double low, double high, size_t k, size_t terms)
{
    return terms > 1 ? low * pow(high / low, (double)k / (double)(terms - 1)) : sqrt(low * high);
}

/* The result: moduli in the unit of the rows. */
static void
solve_fit(struct fit *f, double *norm, double *misfit)
{
    double sum = 0;

    set_norms(f, norm);
    least_squares(f);
    for (size_t i = 0; i < f->rows; i++)
        sum += f->left[i] * f->left[i];
    *misfit = sqrt(sum / (double)f->rows);
    for (size_t k = 0; k < f->columns; k++)
        f->x[k] /= norm[k];
}

static enum rc_status
check_relaxation(size_t n, const double *time, const double *modulus, double relaxed,
                 struct rc_err *err)
{
    size_t later = 0;

    if (relaxed < 0 || isinf(relaxed))
        return rc_err_set(err, "relaxed modulus %g Pa: it must be at least 0 and finite", relaxed);
    for (size_t i = 0; i < n; i++) {
        if (!(time[i] >= 0) || isinf(time[i]))
            return rc_err_set(err, "time %g s in line %zu: it must be at least 0 and finite",
                              time[i], i + 1);
        if (!(modulus[i] > 0) || isinf(modulus[i]))
            return rc_err_set(err, "modulus %g Pa in line %zu: it must be above 0 and finite",
                              modulus[i], i + 1);
        for (size_t j = 0; j < i; j++)
            if (time[i] == time[j])
                return rc_err_set(err, "time %g s: it must be given only once", time[i]);
        later += time[i] > 0;
    }
    if (n < 4 || later < 3)
        return rc_err_set(err, "a relaxation of %zu times: it must have at least 4", n);
    return RC_OK;
}

struct rc_relaxation *
rc_relaxation_fit_time(size_t n, const double *time, const double *modulus, double relaxed,
                       double per_decade, double *misfit, struct rc_err *err)
{
    const size_t plateau = isnan(relaxed) ? 1U : 0U; /* the column of the relaxed modulus */
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    double low = INFINITY, high = 0, *tau, *norm;
    struct fit f;
    size_t terms;

    if (check_relaxation(n, time, modulus, relaxed, err) != RC_OK)
        return NULL;
    for (size_t i = 0; i < n; i++) {
        low = time[i] > 0 ? fmin(low, time[i]) : low;
        high = fmax(high, time[i]);
    }
    terms = count_terms(n, low, high, per_decade > 0 ? per_decade : usual_density_in_time);
    tau = rc_store_take(&own, terms, sizeof *tau);
    norm = rc_store_take(&own, terms + 1, sizeof *norm);
    fit_allocate(&f, &own, n, terms + plateau);
    if (own.failed)
        return rc_err_null(err, "out of memory for a fit of %zu relaxation times", terms);
    for (size_t k = 0; k < terms; k++)
        tau[k] = even_time(low, high, k, terms);
    for (size_t i = 0; i < n; i++) {
        f.right[i] = plateau ? 1 : 1 - relaxed / modulus[i];
        for (size_t k = 0; k < f.columns; k++)
            f.a[i * f.columns + k] =
                (k < plateau ? 1 : exp(-time[i] / tau[k - plateau])) / modulus[i];
    }
    solve_fit(&f, norm, misfit);
    return rc_relaxation_new(plateau ? f.x[0] : relaxed, terms, f.x + plateau, tau, err);
}

/* A fit with this number of times between the inverses of two frequencies. *spread: the standard deviation of
 * the relative errors, by the rows that the terms leave free. */
static struct rc_relaxation *
fit_terms(size_t n, const double *const curve[3], const double range[2], size_t terms,
          double *misfit, double *spread, struct rc_err *err)
{
    const double low = range[0], high = range[1];
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    double *time = rc_store_take(&own, 2 * terms + 1, sizeof *time), *norm;
    struct fit f;

    fit_allocate(&f, &own, 2 * n, terms + 1);
    if (own.failed)
        return rc_err_null(err, "out of memory for a fit of %zu relaxation times", terms);
    norm = time + terms;
    for (size_t k = 0; k < terms; k++)
        time[k] = pow(low / high, (double)k / (double)(terms - 1)) / low;
    set_rows(&f, time, curve[0], curve[1], curve[2]);
    solve_fit(&f, norm, misfit);
    *spread = *misfit * sqrt((double)f.rows / (double)(f.rows - f.used));
    return rc_relaxation_new(f.x[0], terms, f.x + 1, time, err);
}

struct rc_relaxation *
rc_relaxation_fit(size_t n, const double *omega, const double *storage, const double *loss,
                  double per_decade, double *misfit, struct rc_err *err)
{
    const double *const curve[] = {omega, storage, loss};
    double range[] = {INFINITY, 0}, spread, dense_misfit, dense_spread;
    struct rc_relaxation *r, *denser;
    size_t terms;

    if (check_curve(n, omega, storage, loss, err) != RC_OK)
        return NULL;
    for (size_t i = 0; i < n; i++) {
        range[0] = fmin(range[0], omega[i]);
        range[1] = fmax(range[1], omega[i]);
    }
    terms = count_terms(n, range[0], range[1], per_decade > 0 ? per_decade : usual_density);
    r = fit_terms(n, curve, range, terms, misfit, &spread, err);
    if (r == NULL || per_decade > 0 || *misfit <= close_enough)
        return r;
    terms = count_terms(2 * n - 1, range[0], range[1], dense_density);
    denser = fit_terms(n, curve, range, terms, &dense_misfit, &dense_spread, err);
    if (denser == NULL || dense_spread < denser_helps * spread) {
        *misfit = dense_misfit;
        rc_relaxation_free(r);
        return denser;
    }
    rc_relaxation_free(denser);
    return r;
}
