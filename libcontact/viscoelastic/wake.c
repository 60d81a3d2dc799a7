/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Sliding on a free map. Each term of the creep compliance leaves a wake: with L = v th, a cell under unit
 * pressure displaces the surface by
 *
 *     I(x, y) = integral of exp(-s/L)/L B(x + s, y) ds, s > 0,
 *
 * where B is the displacement of the cell on an elastic half-space. Nothing comes back around a period, and
 * the wake leaves the map. From node to node I(x) = exp(-dx/L) I(x + dx) + the integral over one interval.
 * Near the cell this integral is summed by Gauss's rule with exp(-s/L) as variable; further off B is a cubic
 * between four nodes.
 *
 * Coefficients up to the length of the map make K p exact on the map. The padded map is three times as long;
 * in the middle third coefficients ahead of the cell change smoothly into those behind it. As p is 0 outside
 * the map, the padded K serves as K in the iteration and in its bounds. Its waves have almost the phases of
 * the material: the largest tan(d/2) was 0.62, in the material 0.52, for the longest waves.
 */
#include "wake.h"

#include <complex.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/body/quadrature.h"
#include "libcontact/memory.h"
#include "libcontact/operator/operator.h"

enum {
    POINTS = 8,
    /* In intervals. Not sensitive: half and double change no count of 6 runs (bench/constants.py). */
    NEAR = 16,
    /* In cells: further off a cell acts as a point load, to (a/r)^4. Not sensitive: half and double
     * change no count of 6 runs (bench/constants.py). */
    FAR = 30
};

/* No wake is resolved that is shorter than this part of a cell. Half and double change no bit of 6 runs
 * (bench/constants.py). */
static const double shortest = 1e-9;

/* A term of the creep compliance. */
struct term {
    double compliance, length; /* 1/Pa, m */
    double decay, half;        /* exp(-dx/L) and exp(-dx/2L), the decay of I */
    double cubic[4];           /* weights of B at four nodes */
};

struct own {
    struct rc_wake wake;
    struct rc_store store;     /* the arrays below, without place and mirror */
    struct rc_shape map, grid; /* grid: half of the padded map, as the transform has it */
    size_t px, py, cx, cy;     /* the padded map, and a quarter of its waves */
    double *size, *turn;       /* V and tan(d/2), by columns                 */
    double *loss;              /* of the losses                              */
    double *p, *g;             /* waves of the pressure and of G             */
    double *factor;            /* V over V of the elastic half-space         */
    size_t *place, length;
    signed char *mirror;
    struct rc_fft *fft;
    struct term *term;
    size_t terms;
    double instant; /* 1/Pa */
    double *part;   /* even or odd part of the coefficients */
};

/* ---- coefficients ---- */

/* The integral of exp(-k t) k t^n over 0 < t < 1. */
static double
moment(int n, double k)
{
    double sum = 0;

    if (k >= 1)
        return n == 0 ? -expm1(-k) : n / k * moment(n - 1, k) - exp(-k);
    for (int g = 0; g < POINTS; g++) {
        const struct rc_gauss at = rc_gauss_point(POINTS, g);
        const double t = (1 + at.x) / 2;
        sum += at.w / 2 * k * exp(-k * t) * pow(t, n);
    }
    return sum;
}

static struct term
term_of(double compliance, double length, double dx)
{
    const double k = dx / length, a = moment(0, k), b = moment(1, k), c = moment(2, k),
                 d = moment(3, k);
    return (struct term){.compliance = compliance,
                         .length = length,
                         .decay = exp(-k),
                         .cubic = {(-d + 3 * c - 2 * b) / 6, (d - 2 * c - b + 2 * a) / 2,
                                   (-d + c + 2 * b) / 2, (d - b) / 6},
                         .half = exp(-k / 2)};
}

/* B on a half-space of E* = 1. */
static double
elastic(double x, double y, const struct rc_shape *s)
{
    const double r2 = x * x + y * y, a2 = s->dx * s->dx, b2 = s->dy * s->dy;

    if (r2 < FAR * FAR * fmax(a2, b2))
        return rc_love(x, y, s->dx / 2, s->dy / 2) / RC_PI;
    return s->dx * s->dy / (RC_PI * sqrt(r2)) *
           (1 + ((3 * x * x / r2 - 1) * a2 + (3 * y * y / r2 - 1) * b2) / (24 * r2));
}

/* The integral up to s = end, in pieces that begin with a length up to `first` and become longer. */
static double
behind(const struct term *t, double x, double y, const struct rc_shape *s, double first, double end)
{
    double sum = 0, to;

    end = fmin(end, 40 * t->length);
    for (double from = 0; from < end; from = to) {
        to = fmin(from > 0 ? 2 * from : fmin(t->length, first), end);
        for (int g = 0; g < POINTS; g++) {
            const struct rc_gauss at = rc_gauss_point(POINTS, g);
            const double d = from + (to - from) * (1 + at.x) / 2;
            sum += at.w / 2 * (to - from) / t->length * exp(-d / t->length) * elastic(x + d, y, s);
        }
    }
    return sum;
}

/* The coefficients of row j at x = i dx, |i| <= n: line[n + i], and those of the losses. b: n + 3 numbers,
 * sums: one of each term. */
static void
find_line(const struct own *w, size_t j, long n, double *b, double *sums, double *line,
          double *losses)
{
    const struct rc_shape *s = &w->map;
    const struct rc_lattice nodes = {s->dx, s->dy, 1, 1};
    const double y = (double)j * s->dy;
    const double last = (double)(n + 1) * s->dx, half = s->dx / 2;
    const bool beside = y - s->dy / 2 < NEAR * s->dx;

    rc_kernel_of_one.rows(NULL, &nodes, (size_t)n + 3, j, j + 1, b);
    for (size_t k = 0; k < w->terms; k++)
        sums[k] = behind(&w->term[k], last, y, s, last, INFINITY);
    for (long i = n; i >= -n; i--) {
        const double four[] = {b[labs(i - 1)], b[labs(i)], b[labs(i + 1)], b[labs(i + 2)]};
        double sum = w->instant * four[1], lost = 0;
        for (size_t k = 0; k < w->terms; k++) {
            const struct term *t = &w->term[k];
            const double x = (double)i * s->dx;
            if (beside &&
                labs(i) <= NEAR) /* the sides of the cell are in the middle of an interval */
                for (int q = 1; q >= 0; q--)
                    sums[k] = t->half * sums[k] + behind(t, x + q * half, y, s, half, half);
            else
                sums[k] = t->decay * sums[k] + t->cubic[0] * four[0] + t->cubic[1] * four[1] +
                          t->cubic[2] * four[2] + t->cubic[3] * four[3];
            sum += t->compliance * sums[k];
            lost += t->compliance / t->length * (sums[k] - four[1]);
        }
        line[n + i] = sum;
        losses[n + i] = lost;
    }
}

/* The coefficient i of a period, 0 <= i < px, from those of a line. */
static double
around(const struct own *w, const double *line, size_t n, size_t i)
{
    const size_t nx = w->map.nx, rest = w->px - i;
    double t, f;

    if (i < nx)
        return line[n + i];
    if (rest < nx)
        return line[n - rest];
    t = (double)(i - nx + 1) / (double)(w->px - 2 * nx + 2);
    f = t - sin(2 * RC_PI * t) / (2 * RC_PI);
    return (1 - f) * line[n + i] + f * line[n - rest];
}

/* Even and odd parts of all coefficients, and the even part of those of the losses: cy rows of cx numbers. */
static enum rc_status
find_coefficients(const struct own *w, int threads, double *part[3], struct rc_err *err)
{
    const size_t n = w->px - w->map.nx, each = 5 * n + 5 + w->terms;
    RC_OWNED double *room = rc_alloc((size_t)threads * each, sizeof *room);

    if (room == NULL)
        return rc_err_set(err, "out of memory for coefficients of %zu nodes", n);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (size_t j = 0; j < w->cy; j++) {
        double *line = room + (size_t)omp_get_thread_num() * each, *lost = line + 2 * n + 1,
               *b = lost + 2 * n + 1;
        find_line(w, j, (long)n, b, b + n + 3, line, lost);
        for (size_t i = 0; i < w->cx; i++) {
            const size_t back = (w->px - i) % w->px;
            const double ahead = around(w, line, n, i), behind = around(w, line, n, back);
            part[0][j * w->cx + i] = (ahead + behind) / 2;
            part[1][j * w->cx + i] = (ahead - behind) / 2;
            part[2][j * w->cx + i] = (around(w, lost, n, i) + around(w, lost, n, back)) / 2;
        }
    }
    return RC_OK;
}

static void
part_rows(const void *of, const struct rc_lattice *at, size_t n, size_t first, size_t last,
          double *out)
{
    const struct own *w = of;

    (void)at;
    memcpy(out, w->part + first * n, (last - first) * n * sizeof *out);
}

/* ---- waves ---- */

struct pass {
    struct own *w;
    enum rc_wake_field field;
    const double *from;
    double *to;
};

static bool
row_in(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const size_t nx = p->w->map.nx;

    if (j >= p->w->map.ny)
        return false;
    memset(row, 0, p->w->grid.nx * sizeof(double));
    memcpy(row, p->from + j * nx, nx * sizeof(double));
    return true;
}

static bool
row_out(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    const size_t nx = p->w->map.nx;

    if (j < p->w->map.ny)
        memcpy(p->to + j * nx, row, nx * sizeof(double));
    return true;
}

static void
field_column(void *ctx, size_t i, void *column)
{
    const struct pass *pass = ctx;
    struct own *w = pass->w;
    const size_t n = w->length;
    const double *p = w->p + 2 * i * n;
    double *g = w->g + 2 * i * n, *to = column;

    for (size_t k = 0; k < n; k++) {
        const size_t at = i * w->cy + w->place[k];
        const double complex half = I * w->turn[at], p_k = p[k] + I * p[n + k],
                             even = w->size[at] * p_k;
        double complex z = even;
        if (pass->field == RC_WAKE_LAG)
            z *= 2 * half / (1 - half);
        else if (pass->field == RC_WAKE_SLOPE)
            z = w->loss[at] * p_k;
        else if (pass->field == RC_WAKE_REFLECT) {
            z = half * (2 * even + (g[k] + I * g[n + k]));
            g[k] = creal(z);
            g[n + k] = cimag(z);
        }
        to[k] = creal(z);
        to[n + k] = cimag(z);
    }
}

void
rc_wake_load(struct rc_wake *wake, const double *p)
{
    struct own *w = (struct own *)wake;
    struct pass pass = {.w = w, .from = p};

    rc_fft_forward(w->fft, row_in, &pass, w->p, NULL);
}

void
rc_wake_field(struct rc_wake *wake, enum rc_wake_field field, double *u)
{
    struct own *w = (struct own *)wake;
    struct pass pass = {.w = w, .field = field, .to = u};

    rc_fft_back(w->fft, NULL, field_column, row_out, &pass);
}

double *
rc_wake_waves(struct rc_wake *wake, size_t *n)
{
    struct own *w = (struct own *)wake;

    *n = 2 * w->cx * w->length;
    return w->g;
}

/* ---- plan ---- */

/* Turns the transforms of the even and the odd part into V and tan(d/2). */
static void
split(struct own *w, double sign)
{
    double steepest = 0;

    for (size_t k = 0; k < w->cx * w->cy; k++) {
        const double re = w->size[k], im = -sign * w->turn[k];
        w->size[k] = hypot(re, im);
        w->turn[k] = im / (w->size[k] + re);
        steepest = fmax(steepest, re > 0 ? fabs(im) / re : INFINITY);
    }
    w->wake.steepest = steepest;
}

static enum rc_status
find_spectra(struct own *w, double sign, int threads, struct rc_err *err)
{
    const size_t n = w->cx * w->cy;
    RC_OWNED double *all = rc_alloc(3 * n, sizeof *all);
    double *part[] = {all, all + n, all + 2 * n}, *to[] = {w->size, w->turn, w->loss};
    RC_OWN(rc_spectrum, passing) = rc_spectrum_new(w->fft, err);
    enum rc_status status = RC_FAIL;

    if (all == NULL)
        rc_err_set(err, "out of memory for %zu coefficients", n);
    else if (passing != NULL)
        status = find_coefficients(w, threads, part, err);
    for (int k = 0; k < 3 && status == RC_OK; k++) {
        const struct rc_kernel kernel = {
            .of = w, .parity = k == 1 ? RC_ODD_X : 0, .rows = part_rows};
        w->part = part[k];
        status = rc_spectrum_set_by(passing, w->fft, &kernel, RC_FREE, rc_keep_column, to[k], err);
    }
    if (status == RC_OK)
        split(w, sign);
    return status;
}

/* 1 on coarser grids, from which the solver only starts. */
static double
factor_at(const void *of, double dx, double x, double y)
{
    const struct own *w = of;
    const size_t i = (size_t)(x / w->map.dx + 0.5), j = (size_t)(y / w->map.dy + 0.5);

    if (dx > 1.2 * w->map.dx)
        return 1;
    return w->factor[(j < w->grid.ny ? j : w->grid.ny - 1) * w->grid.nx +
                     (i < w->grid.nx ? i : w->grid.nx - 1)];
}

static bool
first_in(void *ctx, size_t j, void *row)
{
    memset(row, 0, ((struct pass *)ctx)->w->grid.nx * sizeof(double));
    *(double *)row = j == 0;
    return j == 0;
}

static bool
grid_out(void *ctx, size_t j, void *row)
{
    const struct own *w = ((struct pass *)ctx)->w;

    memcpy(w->factor + j * w->grid.nx, row, w->grid.nx * sizeof(double));
    return true;
}

/* V of a pressure on the first node is a quarter of its coefficients. */
static enum rc_status
find_factor(struct own *w, double typical, struct rc_err *err)
{
    const struct rc_lattice nodes = {w->map.dx, w->map.dy, 1, 1};
    struct pass pass = {.w = w, .field = RC_WAKE_EVEN};
    RC_OWNED double *b = rc_alloc(w->grid.nx, sizeof *b);

    if (b == NULL)
        return rc_err_set(err, "out of memory for %zu coefficients", w->grid.nx);
    rc_fft_forward(w->fft, first_in, &pass, w->p, NULL);
    rc_fft_back(w->fft, NULL, field_column, grid_out, &pass);
    for (size_t j = 0; j < w->grid.ny; j++) {
        rc_kernel_of_one.rows(NULL, &nodes, w->grid.nx, j, j + 1, b);
        for (size_t i = 0; i < w->grid.nx; i++) {
            double *f = &w->factor[j * w->grid.nx + i];
            *f /= b[i] * typical;
            w->wake.along.most = fmax(w->wake.along.most, *f);
        }
    }
    return RC_OK;
}

static enum rc_status
make_terms(struct own *w, const struct rc_sliding_medium *m, struct rc_err *err)
{
    const struct rc_relaxation *r = m->material;

    w->terms = r->creep_terms;
    w->instant = r->instant + m->compliance;
    if ((w->term = rc_store_take(&w->store, w->terms + 1, sizeof *w->term)) == NULL)
        return rc_err_set(err, "out of memory for %zu retardation times", w->terms);
    for (size_t k = 0; k < w->terms; k++)
        w->term[k] =
            term_of(r->compliance[k],
                    fmax(fabs(m->speed) * r->retardation[k], shortest * w->map.dx), w->map.dx);
    return RC_OK;
}

static enum rc_status
make_room(struct own *w, size_t threads, struct rc_err *err)
{
    size_t px, py, waves;

    rc_fft_period(&w->map, RC_FREE, &px, &py); /* of the solver */
    w->grid = w->map;
    w->grid.nx = 3 * w->map.nx / 2 > px / 2 ? 3 * w->map.nx / 2 + 1 : px / 2 + 1;
    w->grid.ny = py / 2 + 1;
    rc_fft_period(&w->grid, RC_FREE, &w->px, &w->py);
    if ((w->fft = rc_fft_new(NULL, NULL, &w->grid, RC_FREE, RC_DOUBLE, threads, err)) == NULL)
        return RC_FAIL;
    rc_fft_waves(w->fft, &w->cx, &w->cy);
    w->length = rc_fft_length(w->fft);
    waves = 2 * w->cx * w->length;
    w->size = rc_store_take(&w->store, w->cx * w->cy, sizeof *w->size);
    w->turn = rc_store_take(&w->store, w->cx * w->cy, sizeof *w->turn);
    w->loss = rc_store_take(&w->store, w->cx * w->cy, sizeof *w->loss);
    w->p = rc_store_take(&w->store, waves, sizeof *w->p);
    w->g = rc_store_take(&w->store, waves, sizeof *w->g);
    w->factor = rc_store_take(&w->store, w->grid.nx * w->grid.ny, sizeof *w->factor);
    if (w->store.failed || !rc_fft_fold(w->fft, &w->store, &w->place, &w->mirror))
        return rc_err_set(err, "out of memory for the waves of %zu x %zu nodes", w->px, w->py);
    memset(w->g, 0, waves * sizeof *w->g);
    return RC_OK;
}

struct rc_wake *
rc_wake_new(const struct rc_shape *shape, const struct rc_sliding_medium *m, size_t threads,
            struct rc_err *err)
{
    struct own *w = calloc(1, sizeof *w);

    if (w == NULL)
        return rc_err_null(err, "out of memory for sliding");
    w->map = *shape;
    w->wake.along = (struct rc_along){.at = factor_at, .of = w};
    if (make_room(w, threads, err) == RC_OK && make_terms(w, m, err) == RC_OK &&
        find_spectra(w, copysign(1, m->speed), rc_useful_threads(shape, threads), err) == RC_OK &&
        find_factor(w, m->typical, err) == RC_OK)
        return &w->wake;
    rc_wake_free(&w->wake);
    return NULL;
}

void
rc_wake_free(struct rc_wake *wake)
{
    struct own *w = (struct own *)wake;

    if (w == NULL)
        return;
    rc_fft_free(w->fft);
    rc_store_free(&w->store);
    free(w);
}
