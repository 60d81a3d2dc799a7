/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The position of one scan on another scan of the same surface, by the part of it that did not change.
 *
 * Coarse maps are turned by steps and correlated, which gives starts: by their phases (Kuglin and Hines
 * 1975), which suits rough surfaces, and by their heights, which suits smooth ones. From the best start a
 * shift, a rotation, two tilts and an offset are fitted on finer and finer maps. The weights of the residuals
 * are Tukey's biweights, and are renewed until they agree with the residuals. Wear lies on one side: the fit
 * starts at the most frequent residual, and its spread is that of the side with the smaller residuals.
 * Between its nodes B is the cubic spline through them, and through its holes, filled smoothly. On the
 * finest maps, nodes of patches whose mean has changed are left out, so that the rims of a groove do not
 * pull the offset. The pull of the others is found by a second reach.
 */
#include "libcontact/common.h"

#include <complex.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "handler.h"
#include "libcontact/memory.h"
#include "libcontact/transform/transform.h"
#include "robust.h"

enum {
    NUMBERS = 6,     /* shift along x and y, rotation, offset, tilt along x and y */
    ON_PROFILE = 3,  /* shift, offset, tilt                                        */
    SMALLEST = 16,   /* nodes of a side                                            */
    COARSE = 96,     /* most nodes of a side of the maps that are correlated       */
    TURNS = 12,      /* steps of rotation on either side                           */
    PEAKS = 6,       /* of each correlation, by phases and by heights: starts      */
    FIRST_PEAKS = 2, /* the others are tried if these give two maps that differ    */
    ROUNDS = 40,     /* of weights                                                 */
    TRIAL = 8,       /* rounds that compare starts, on about as many nodes as      */
    SAMPLE = 3072,
    STEPS = 12,      /* of each round                                              */
    POINTS = 1 << 20 /* most nodes of a fit                                        */
};
static const double widest_turn = 12 * RC_PI / 180;
/* Residual over heights: 0.6 to 1.3 for 32 pairs of unrelated surfaces, at most 0.05 for pairs of scans. */
static const double unlike = 0.5;
static const double reach = 4.685; /* residuals, in standard deviations, that lose all weight */

/* ---- a map between its nodes ---- */

struct spline {
    struct rc_shape shape;
    double *c;           /* coefficients         */
    unsigned char *hole; /* 1: a node is missing */
};

static void
spline_free(struct spline *s)
{
    free(s->c);
    free(s->hole);
}

/* Coefficients of the cubic spline through n values, reflected about the outermost (Unser 1999). */
static void
filter_line(double *c, size_t n, size_t step)
{
    const double z = sqrt(3) - 2;
    double sum = 0, power = 1;

    if (n == 1)
        return;
    for (size_t k = 0; k < n && fabs(power) > 1e-17; k++, power *= z)
        sum += power * 6 * c[k * step];
    c[0] = sum;
    for (size_t k = 1; k < n; k++)
        c[k * step] = 6 * c[k * step] + z * c[(k - 1) * step];
    c[(n - 1) * step] = z / (z * z - 1) * (c[(n - 1) * step] + z * c[(n - 2) * step]);
    for (size_t k = n - 1; k-- > 0;)
        c[k * step] = z * (c[(k + 1) * step] - c[k * step]);
}

static enum rc_status
spline_new(const struct rc_shape *shape, const double *h, struct spline *s, struct rc_err *err)
{
    const size_t nx = shape->nx, ny = shape->ny;
    size_t filled;

    *s = (struct spline){
        .shape = *shape, .c = rc_alloc(nx * ny, sizeof *s->c), .hole = rc_calloc(nx * ny, 1)};
    if (s->c == NULL || s->hole == NULL)
        return rc_err_set(err, "out of memory for a spline of %zu x %zu nodes", nx, ny);
    for (size_t k = 0; k < nx * ny; k++)
        if (isnan(h[k]))
            s->hole[k] = 1;
    memcpy(s->c, h, nx * ny * sizeof *h);
    if (rc_inpaint(shape, s->c, &filled, err) != RC_OK)
        return RC_FAIL;
    for (size_t j = 0; j < ny; j++)
        filter_line(s->c + j * nx, nx, 1);
    for (size_t i = 0; i < nx; i++)
        filter_line(s->c + i, ny, nx);
    return RC_OK;
}

static const double beyond =
    1e-3; /* nodes beyond the map that count as its edge: the error of a shift */

/* Four places and weights along one side, and the derivatives of the weights; x lies `part` of a node beyond
 * the second place. False: beyond the map. */
static bool
along_side(double x, size_t n, double *part, size_t place[4], double weight[4], double slope[4])
{
    const double last = (double)(n - 1);
    size_t first;
    double t;

    if (!(x >= -beyond && x <= last + beyond))
        return false;
    x = fmin(fmax(x, 0), last);
    if (n == 1) {
        memset(place, 0, 4 * sizeof *place);
        memset(slope, 0, 4 * sizeof *slope);
        memcpy(weight, (const double[]){1, 0, 0, 0}, 4 * sizeof *weight);
        *part = 0;
        return true;
    }
    first = x < last ? (size_t)x : n - 2;
    *part = t = x - (double)first;
    place[0] = first == 0 ? 1 : first - 1;
    place[1] = first;
    place[2] = first + 1;
    place[3] = first + 2 == n ? n - 2 : first + 2;
    weight[0] = (1 - t) * (1 - t) * (1 - t) / 6;
    weight[1] = (4 - 6 * t * t + 3 * t * t * t) / 6;
    weight[3] = t * t * t / 6;
    weight[2] = 1 - weight[0] - weight[1] - weight[3];
    slope[0] = -(1 - t) * (1 - t) / 2;
    slope[1] = -2 * t + 1.5 * t * t;
    slope[3] = t * t / 2;
    slope[2] = -slope[0] - slope[1] - slope[3];
    return true;
}

/* Height and gradient at a place (m from the middle). False: beyond the map, or missing: of the four nodes
 * around, missing ones have more than a quarter of the weight of linear interpolation. A single missing node
 * takes 1.6 places of another grid. */
static bool
spline_at(const struct spline *s, double x, double y, double *h, double gradient[2])
{
    const double most = 0.25;
    const size_t nx = s->shape.nx, ny = s->shape.ny;
    size_t px[4], py[4];
    double wx[4], wy[4], sx[4], sy[4], t, u, missing = 0;

    if (!along_side(x / s->shape.dx + (double)(nx - 1) / 2, nx, &t, px, wx, sx) ||
        !along_side(y / s->shape.dy + (double)(ny - 1) / 2, ny, &u, py, wy, sy))
        return false;
    for (int b = 1; b <= 2; b++)
        for (int a = 1; a <= 2; a++)
            if (s->hole[py[b] * nx + px[a]])
                missing += (a == 1 ? 1 - t : t) * (b == 1 ? 1 - u : u);
    if (missing > most)
        return false;
    *h = gradient[0] = gradient[1] = 0;
    for (int b = 0; b < 4; b++) {
        const double *row = s->c + py[b] * nx;
        double value = 0, along = 0;
        for (int a = 0; a < 4; a++) {
            value += wx[a] * row[px[a]];
            along += sx[a] * row[px[a]];
        }
        *h += wy[b] * value;
        gradient[0] += wy[b] * along / s->shape.dx;
        gradient[1] += sy[b] * value / s->shape.dy;
    }
    return true;
}

/* ---- the lowest nodes ---- */

/* The nodes of B whose height, as the mean with their neighbours, is among the lowest. The mean, because the
 * noise of a node that is chosen by its own height has a mean: chosen by a mean of m nodes, white noise of
 * variance s^2 has the mean -s^2 / m * slope, where `slope` is the density of the means at the limit over the
 * part below (Stein's identity). */
struct low {
    unsigned char *on; /* 1: chosen; NULL: all nodes */
    double slope, m;   /* 1/m, and nodes of a mean   */
    double part;       /* of the nodes               */
};

static void
low_free(struct low *low)
{
    free(low->on);
}

/* Values that are not NAN, sorted. */
static size_t
sort_present(size_t n, const double *h, double *sorted)
{
    size_t count = 0;

    for (size_t k = 0; k < n; k++)
        if (!isnan(h[k]))
            sorted[count++] = h[k];
    gsl_sort(sorted, 1, count);
    return count;
}

static enum rc_status
levelled(const struct rc_shape *shape, const double *h, double *out, struct rc_err *err)
{
    const struct rc_form plane = {.degree = 1, .threads = 1};

    memcpy(out, h, shape->nx * shape->ny * sizeof *h);
    return rc_detrend_form(shape, &plane, out, NULL, err);
}

/* Cuts the levelled heights above the lowest part of them, so that coarse maps of worn and of new plateaus
 * agree. */
static enum rc_status
cut_tops(const struct rc_shape *shape, double below, double *h, struct rc_err *err)
{
    const size_t n = shape->nx * shape->ny;
    RC_OWNED double *flat = rc_alloc(n, sizeof *flat), *sorted = rc_alloc(n, sizeof *sorted);
    size_t count;
    double limit;

    if (flat == NULL || sorted == NULL)
        return rc_err_set(err, "out of memory for the lowest of %zu heights", n);
    if (levelled(shape, h, flat, err) != RC_OK)
        return RC_FAIL;
    count = sort_present(n, flat, sorted);
    limit = gsl_stats_quantile_from_sorted_data(sorted, 1, count, below);
    for (size_t k = 0; k < n; k++)
        if (flat[k] > limit)
            h[k] -= flat[k] - limit;
    return RC_OK;
}

/* The mean in the square around a node, NAN where most of it is missing. */
static double
patch_mean(const struct rc_shape *s, const double *v, size_t k, size_t side)
{
    const size_t i = k % s->nx, j = k / s->nx;
    double sum = 0, n = 0, all = 0;

    for (size_t b = j < side ? 0 : j - side; b <= j + side && b < s->ny; b++)
        for (size_t a = i < side ? 0 : i - side; a <= i + side && a < s->nx; a++) {
            const double at = v[b * s->nx + a];
            sum += isnan(at) ? 0 : at;
            n += isnan(at) ? 0 : 1;
            all++;
        }
    return 2 * n > all ? sum / n : NAN;
}

static enum rc_status
low_new(const struct rc_shape *shape, const double *h, double below, struct low *low,
        struct rc_err *err)
{
    const size_t n = shape->nx * shape->ny;
    RC_OWNED double *flat = rc_alloc(n, sizeof *flat), *mean = rc_alloc(n, sizeof *mean);
    size_t count;
    double limit, width;

    *low = (struct low){.m = shape->ny == 1 ? 3 : 9, .part = fmin(below, 1)};
    if (!(below < 1))
        return RC_OK;
    if (flat == NULL || mean == NULL || (low->on = rc_calloc(n, 1)) == NULL)
        return rc_err_set(err, "out of memory for the lowest of %zu heights", n);
    if (levelled(shape, h, flat, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < n; k++)
        mean[k] = patch_mean(shape, flat, k, 1);
    count = sort_present(n, mean, flat);
    if (count == 0)
        return rc_err_set(err, "too few heights without holes around them");
    limit = gsl_stats_quantile_from_sorted_data(flat, 1, count, below);
    width = gsl_stats_quantile_from_sorted_data(flat, 1, count, fmin(1.1 * below, 1)) -
            gsl_stats_quantile_from_sorted_data(flat, 1, count, 0.9 * below);
    low->slope = width > 0 ? (fmin(1.1 * below, 1) / below - 0.9) / width : 0;
    for (size_t k = 0; k < n; k++)
        low->on[k] = mean[k] <= limit;
    return RC_OK;
}

/* ---- the fit ---- */

/* B turned counterclockwise and then moved lies on A. The fit has its numbers in units that make them
 * alike. */
struct fit {
    struct rc_shape shape; /* of A */
    const double *a;
    const struct spline *b;
    double unit[NUMBERS];
    double height;       /* unit of the residuals, m           */
    size_t numbers;      /* NUMBERS or ON_PROFILE              */
    size_t n, step;      /* nodes of A in the fit: every step-th */
    bool fresh;          /* the numbers are not near the result yet */
    size_t rounds;       /* most rounds of weights             */
    unsigned char *skip; /* nodes that have changed, or NULL   */
    const struct low *low;
    const double *weight; /* of n nodes; those with 0 are not computed */
    double q[NUMBERS];    /* the result, in SI                  */
    double spread;        /* of the residuals without change, m */
    double *r, *work;     /* n residuals, m; NAN: none          */
    int threads;
};

static void
set_place(const struct fit *f, size_t k, double *x, double *y)
{
    *x = ((double)(k % f->shape.nx) - (double)(f->shape.nx - 1) / 2) * f->shape.dx;
    *y = ((double)(k / f->shape.nx) - (double)(f->shape.ny - 1) / 2) * f->shape.dy;
}

/* A place on A, from the middle of B. */
static void
set_on_b(const double q[NUMBERS], double x, double y, double *u, double *v)
{
    *u = cos(q[2]) * (x - q[0]) - sin(q[2]) * (y - q[1]);
    *v = sin(q[2]) * (x - q[0]) + cos(q[2]) * (y - q[1]);
}

/* True if the nearest node of B is one of the lowest. */
static bool
in_low(const struct fit *f, size_t k)
{
    const struct rc_shape *b = &f->b->shape;
    double x, y, u, v;

    if (f->low->on == NULL)
        return true;
    set_place(f, k, &x, &y);
    set_on_b(f->q, x, y, &u, &v);
    u = round(u / b->dx + (double)(b->nx - 1) / 2);
    v = round(v / b->dy + (double)(b->ny - 1) / 2);
    return u >= 0 && u < (double)b->nx && v >= 0 && v < (double)b->ny &&
           f->low->on[(size_t)v * b->nx + (size_t)u];
}

/* True if node k may count in the fit. */
static bool
counts(const struct fit *f, size_t k)
{
    return (f->skip == NULL || !f->skip[k]) && in_low(f, k);
}

/* The order of the numbers in `q`; a profile has no shift along y, rotation and tilt along y. */
static const size_t order[NUMBERS] = {0, 3, 4, 1, 2, 5};

/* A - B at node k, and the derivatives of B there by all numbers (not NULL). NAN where one is missing. */
static double
difference(const struct fit *f, const double q[NUMBERS], size_t k, double *by)
{
    const double c = cos(q[2]), s = sin(q[2]);
    double x, y, u, v, h, g[2];

    if (isnan(f->a[k]))
        return NAN;
    set_place(f, k, &x, &y);
    set_on_b(q, x, y, &u, &v);
    if (!spline_at(f->b, u, v, &h, g))
        return NAN;
    if (by != NULL) {
        by[0] = -g[0] * c - g[1] * s;
        by[1] = g[0] * s - g[1] * c;
        by[2] = -g[0] * v + g[1] * u;
        by[3] = 1;
        by[4] = x;
        by[5] = y;
    }
    return f->a[k] - h - q[3] - q[4] * x - q[5] * y;
}

static void
from_gsl(const struct fit *f, const gsl_vector *x, double q[NUMBERS])
{
    memcpy(q, f->q, NUMBERS * sizeof *q);
    for (size_t k = 0; k < f->numbers; k++)
        q[order[k]] = gsl_vector_get(x, k) * f->unit[order[k]];
}

static int
residuals(const gsl_vector *x, void *data, gsl_vector *to)
{
    const struct fit *f = data;
    double q[NUMBERS];

    from_gsl(f, x, q);
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t i = 0; i < f->n; i++) {
        const double d = f->weight[i] > 0 ? difference(f, q, i * f->step, NULL) : NAN;
        gsl_vector_set(to, i, isnan(d) ? 0 : d / f->height);
    }
    return GSL_SUCCESS;
}

static int
derivatives(const gsl_vector *x, void *data, gsl_matrix *to)
{
    const struct fit *f = data;
    double q[NUMBERS];

    from_gsl(f, x, q);
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t i = 0; i < f->n; i++) {
        double by[NUMBERS];
        const bool there = f->weight[i] > 0 && !isnan(difference(f, q, i * f->step, by));
        for (size_t k = 0; k < f->numbers; k++)
            gsl_matrix_set(to, i, k, there ? -by[order[k]] * f->unit[order[k]] / f->height : 0);
    }
    return GSL_SUCCESS;
}

/* Standard deviation of the values about 0 that have not changed: 1.4826 times the median magnitude of the
 * positive or of the negative ones, whichever is less. A side with few values is the tail of the other
 * one. */
static double
smaller_side(const double *v, size_t n, double *room)
{
    const double least = 0.15; /* part of the values on a side: 0.25 if half of them have changed */
    double spread = INFINITY;

    for (int side = -1; side <= 1; side += 2) {
        size_t count = 0;
        for (size_t i = 0; i < n; i++)
            if (side * v[i] >= 0)
                room[count++] = fabs(v[i]);
        if ((double)count >= least * (double)n && count > 0)
            spread = fmin(spread, 1.4826 * gsl_stats_median(room, 1, count));
    }
    return spread;
}

/* The middle of the shortest interval that holds a quarter of the values: where most of them are. */
static double
most_frequent(double *v, size_t n)
{
    const size_t part = n / 4;
    double shortest = INFINITY, middle = 0;

    gsl_sort(v, 1, n);
    for (size_t i = 0; i + part < n; i++)
        if (v[i + part] - v[i] < shortest) {
            shortest = v[i + part] - v[i];
            middle = (v[i] + v[i + part]) / 2;
        }
    return middle;
}

/* Residuals of the result and their spread; returns how many nodes count. */
static size_t
find_spread(struct fit *f)
{
    size_t count = 0;

#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t i = 0; i < f->n; i++)
        f->r[i] = counts(f, i * f->step) ? difference(f, f->q, i * f->step, NULL) : NAN;
    for (size_t i = 0; i < f->n; i++)
        if (!isnan(f->r[i]))
            f->work[count++] = f->r[i];
    if (count > 0)
        f->spread = smaller_side(f->work, count, f->work + f->n);
    return count;
}

/* Moves the offset to the residual that most nodes have. */
static void
find_level(struct fit *f)
{
    const size_t enough = 1 << 15, count = find_spread(f), every = count / enough + 1;
    size_t n = 0;

    for (size_t i = 0; i < count; i += every)
        f->work[n++] = f->work[i];
    if (n > 4)
        f->q[3] += most_frequent(f->work, n);
}

static void
fit_free(struct fit *f)
{
    free(f->r);
    free(f->work);
}

static enum rc_status
fit_new(const struct rc_shape *shape, const double *a, const struct spline *b,
        const struct low *low, int threads, struct fit *f, struct rc_err *err)
{
    const size_t n = shape->nx * shape->ny;
    struct rc_statistics is;

    *f = (struct fit){.shape = *shape, .a = a, .b = b, .low = low, .threads = threads};
    f->rounds = ROUNDS;
    f->numbers = shape->ny == 1 ? ON_PROFILE : NUMBERS;
    f->step = (n + POINTS - 1) / POINTS;
    f->n = (n + f->step - 1) / f->step;
    f->r = rc_alloc(f->n, sizeof *f->r);
    f->work = rc_alloc(2 * f->n, sizeof *f->work);
    if (f->r == NULL || f->work == NULL)
        return rc_err_set(err, "out of memory for the fit of %zu heights", f->n);
    rc_measure(shape, a, &is);
    f->height = is.rms > 0 ? is.rms : 1;
    f->unit[0] = shape->dx;
    f->unit[1] = shape->dy;
    f->unit[2] = 2 / hypot((double)shape->nx, (double)shape->ny);
    f->unit[3] = f->height;
    f->unit[4] = f->height / ((double)shape->nx * shape->dx);
    f->unit[5] = f->height / ((double)shape->ny * shape->dy);
    return RC_OK;
}

/* Of two sets of numbers, or of a step, in units that end the rounds: 1e-4 nodes, and 1e-3 deviations. */
static double
largest_change(const struct fit *f, const gsl_vector *to, const gsl_vector *from)
{
    double most = 0;

    for (size_t k = 0; k < f->numbers; k++)
        most =
            fmax(most, fabs(gsl_vector_get(to, k) - (from == NULL ? 0 : gsl_vector_get(from, k))) /
                           (order[k] < 3 ? 1e-4 : 1e-3 * f->spread / f->height));
    return most;
}

/* Fits from f->q on, with weights that are renewed. RC_FAIL: memory is short. */
static enum rc_status
fit_solve(struct fit *f, struct rc_err *err)
{
    gsl_multifit_nlinear_parameters how = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_fdf what = {
        .f = residuals, .df = derivatives, .n = f->n, .p = f->numbers, .params = f};
    gsl_multifit_nlinear_workspace *w = NULL;
    gsl_vector *start = gsl_vector_alloc(f->numbers), *weight = gsl_vector_alloc(f->n);

    int status = GSL_SUCCESS;
    bool failed;

    find_level(f);
    how.solver = gsl_multifit_nlinear_solver_cholesky;
    w = gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, f->n, f->numbers);
    for (size_t round = 0; w != NULL && start != NULL && weight != NULL && round < f->rounds;
         round++) {
        double change = 0;
        if (find_spread(f) <= f->numbers || !(f->spread > 1e-12 * f->height))
            break;
        for (size_t i = 0; i < f->n; i++)
            gsl_vector_set(weight, i,
                           round == 0 && f->fresh ? (isnan(f->r[i]) ? 0 : 1)
                                                  : rc_biweight(f->r[i], reach * f->spread));
        for (size_t k = 0; k < f->numbers; k++)
            gsl_vector_set(start, k, f->q[order[k]] / f->unit[order[k]]);
        f->weight = weight->data;
        status = gsl_multifit_nlinear_winit(start, weight, &what, w);
        for (int step = 0; step < STEPS && status == GSL_SUCCESS; step++) {
            status = gsl_multifit_nlinear_iterate(w);
            if (status == GSL_SUCCESS && largest_change(f, w->dx, NULL) < 0.1)
                break;
        }
        if (status == GSL_ENOMEM)
            break;
        change = largest_change(f, w->x, start);
        from_gsl(f, w->x, f->q);
        if (change < 1)
            break;
    }
    if (w == NULL || start == NULL || weight == NULL || status == GSL_ENOMEM)
        rc_err_set(err, "out of memory for the fit of %zu heights", f->n);
    failed = start == NULL || weight == NULL || status == GSL_ENOMEM;
    gsl_vector_free(start);
    gsl_vector_free(weight);
    if (w != NULL)
        gsl_multifit_nlinear_free(w);
    return w == NULL || failed ? RC_FAIL : RC_OK;
}

/* ---- the start ---- */

struct start {
    double score, shift[2], turn;
};

/* From the highest peak on. */
struct starts {
    struct start of_phases[PEAKS], of_heights[PEAKS];
};

/* A map for the correlation: levelled, with 0 in its holes and towards its edges. */
static enum rc_status
flatten(const struct rc_shape *shape, double *h, struct rc_err *err)
{
    const struct rc_form plane = {.degree = 1, .threads = 1};
    const double rim = 0.1; /* part of a side on which the map goes to 0 */

    if (rc_detrend_form(shape, &plane, h, NULL, err) != RC_OK)
        return RC_FAIL;
    for (size_t j = 0; j < shape->ny; j++)
        for (size_t i = 0; i < shape->nx; i++) {
            const double x = ((double)i + 0.5) / (double)shape->nx,
                         y = ((double)j + 0.5) / (double)shape->ny;
            const double at[] = {fmin(x, 1 - x) / rim, shape->ny > 1 ? fmin(y, 1 - y) / rim : 1};
            double *v = h + j * shape->nx + i;
            for (int k = 0; k < 2; k++)
                *v *= at[k] < 1 ? (1 - cos(RC_PI * at[k])) / 2 : 1;
            *v = isnan(*v) ? 0 : *v;
        }
    return RC_OK;
}

struct search {
    struct rc_shape a, b, pad; /* coarse maps, and the grid of the transforms */
    double *v;
    double complex *sa, *sb, *s;
    struct starts best;
};

static void
put(const struct search *w, const struct rc_shape *shape, const double *h)
{
    memset(w->v, 0, w->pad.nx * w->pad.ny * sizeof *w->v);
    for (size_t j = 0; j < shape->ny; j++)
        memcpy(w->v + j * w->pad.nx, h + j * shape->nx, shape->nx * sizeof *h);
}

/* Keeps the highest peaks, one for each rotation. */
static void
keep(struct start *best, struct start now)
{
    for (size_t k = 0; k < PEAKS; k++)
        if (now.score > best[k].score) {
            const struct start next = best[k];
            best[k] = now;
            now = next;
        }
}

/* The highest peak of a correlation. A quarter of each side of the smaller map must lie on the other. */
static void
find_peak(struct search *w, double turn, struct start *best)
{
    const long ax = (long)w->a.nx, ay = (long)w->a.ny, bx = (long)w->b.nx, by = (long)w->b.ny;
    const long least[] = {((ax < bx ? ax : bx) + 3) / 4, ((ay < by ? ay : by) + 3) / 4};
    struct start peak = {.turn = turn};

    for (long j = least[1] - by; j <= ay - least[1]; j++)
        for (long i = least[0] - bx; i <= ax - least[0]; i++) {
            const size_t y = (size_t)(j < 0 ? j + (long)w->pad.ny : j);
            const size_t x = (size_t)(i < 0 ? i + (long)w->pad.nx : i);
            const double c = w->v[y * w->pad.nx + x];
            if (c > peak.score)
                peak = (struct start){c,
                                      {((double)i - (double)(ax - bx) / 2) * w->a.dx,
                                       ((double)j - (double)(ay - by) / 2) * w->a.dy},
                                      turn};
        }
    keep(best, peak);
}

/* Correlates A with B turned by an angle. */
static enum rc_status
correlate(struct search *w, const struct spline *b, double *room, double turn, struct rc_err *err)
{
    const size_t n = rc_fourier_size(&w->pad);
    const struct rc_shape turned = {w->b.nx, w->b.ny, w->a.dx, w->a.dy};
    double h, g[2];

    for (size_t j = 0; j < turned.ny; j++)
        for (size_t i = 0; i < turned.nx; i++) {
            const double x = ((double)i - (double)(turned.nx - 1) / 2) * turned.dx;
            const double y = ((double)j - (double)(turned.ny - 1) / 2) * turned.dy;
            room[j * turned.nx + i] =
                spline_at(b, cos(turn) * x - sin(turn) * y, sin(turn) * x + cos(turn) * y, &h, g)
                    ? h
                    : 0;
        }
    put(w, &turned, room);
    if (rc_fourier_forward(&w->pad, w->v, w->sb, err) != RC_OK)
        return RC_FAIL;
    for (int heights = 0; heights < 2; heights++) {
        for (size_t k = 0; k < n; k++) {
            const double complex c = w->sa[k] * conj(w->sb[k]);
            w->s[k] = heights || cabs(c) == 0 ? c : c / cabs(c);
        }
        if (rc_fourier_backward(&w->pad, w->s, w->v, err) != RC_OK)
            return RC_FAIL;
        find_peak(w, turn, heights ? w->best.of_heights : w->best.of_phases);
    }
    return RC_OK;
}

static enum rc_status
find_starts(const struct rc_shape *a, const double *ha, const struct rc_shape *b, const double *hb,
            struct starts *best, struct rc_err *err)
{
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    RC_ENDS(spline_free) struct spline spline = {0};
    struct search w = {.a = *a, .b = *b};
    const size_t nx = a->nx > b->nx ? a->nx : b->nx, ny = a->ny > b->ny ? a->ny : b->ny;
    double *flat_a = rc_store_copy(&own, a->nx * a->ny, sizeof *ha, ha);
    double *flat_b = rc_store_copy(&own, b->nx * b->ny, sizeof *hb, hb);
    double *room = rc_store_take(&own, b->nx * b->ny, sizeof *room);

    w.pad = (struct rc_shape){rc_fourier_length(nx, 1), ny == 1 ? 1 : rc_fourier_length(ny, 1),
                              a->dx, a->dy};
    w.v = rc_store_take(&own, w.pad.nx * w.pad.ny, sizeof *w.v);
    w.sa = rc_store_take(&own, rc_fourier_size(&w.pad), sizeof *w.sa);
    w.sb = rc_store_take(&own, rc_fourier_size(&w.pad), sizeof *w.sb);
    w.s = rc_store_take(&own, rc_fourier_size(&w.pad), sizeof *w.s);
    if (own.failed)
        return rc_err_set(err, "out of memory for the correlation of two maps");
    if (flatten(a, flat_a, err) != RC_OK || flatten(b, flat_b, err) != RC_OK ||
        spline_new(b, flat_b, &spline, err) != RC_OK)
        return RC_FAIL;
    put(&w, a, flat_a);
    if (rc_fourier_forward(&w.pad, w.v, w.sa, err) != RC_OK)
        return RC_FAIL;
    for (int k = -TURNS; k <= TURNS; k++)
        if ((a->ny > 1 || k == 0) &&
            correlate(&w, &spline, room, widest_turn * k / TURNS, err) != RC_OK)
            return RC_FAIL;
    *best = w.best;
    return RC_OK;
}

/* ---- how alike the maps are ---- */

/* A - B on all nodes. */
static void
find_change(const struct fit *f, double *out)
{
    const size_t n = f->shape.nx * f->shape.ny;

#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t k = 0; k < n; k++)
        out[k] = difference(f, f->q, k, NULL);
}

/* The spread of A - B over that of the levelled heights of A, both as median absolute deviations: of
 * unrelated surfaces too, whose differences have no side. */
static enum rc_status
find_likeness(const struct fit *f, const double *change, double *room, double *ratio,
              struct rc_err *err)
{
    const struct rc_form plane = {.degree = 1, .threads = 1};
    const size_t n = f->shape.nx * f->shape.ny;
    double *values = room + n, *work = room + 2 * n;
    size_t count = 0;

    for (size_t k = 0; k < n; k++) {
        const bool there = !isnan(change[k]) && in_low(f, k);
        room[k] = there ? f->a[k] : NAN;
        if (there)
            values[count++] = change[k];
    }
    *ratio = gsl_stats_mad(values, 1, count, work);
    if (rc_detrend_form(&f->shape, &plane, room, NULL, err) != RC_OK)
        return RC_FAIL;
    count = 0;
    for (size_t k = 0; k < n; k++)
        if (!isnan(room[k]))
            values[count++] = room[k];
    *ratio /= gsl_stats_mad(values, 1, count, work);
    return RC_OK;
}

/* ---- levels ---- */

/* A map of means with 1/factor of the nodes, without the tops above the lowest part. NULL: memory is short. */
static double *
coarsened(const struct rc_shape *from, const double *h, size_t factor, double below,
          struct rc_shape *to, struct rc_err *err)
{
    const size_t n = from->nx * from->ny;
    RC_OWNED double *cut = NULL;
    double *v;

    to->nx = (from->nx + factor - 1) / factor;
    to->ny = (from->ny + factor - 1) / factor;
    to->dx = from->dx * (double)from->nx / (double)to->nx;
    to->dy = from->dy * (double)from->ny / (double)to->ny;
    if (below < 1 && (cut = rc_alloc(n, sizeof *cut)) != NULL) {
        memcpy(cut, h, n * sizeof *h);
        if (cut_tops(from, below, cut, err) != RC_OK)
            return NULL;
    }
    if ((below < 1 && cut == NULL) || (v = rc_alloc(to->nx * to->ny, sizeof *v)) == NULL) {
        rc_err_set(err, "out of memory for the fit of two maps");
        return NULL;
    }
    rc_resample_means(from, cut != NULL ? cut : h, to, v);
    return v;
}

/* Compares the first starts or the others by some rounds on some nodes of a coarse map; from the one with the
 * least spread the fit goes on to its end. NAN: none fits, and *likeness is that of the best, or INFINITY. */
static enum rc_status
try_starts(struct fit *f, const struct starts *starts, bool others, double *likeness,
           struct rc_err *err)
{
    const size_t from = others ? FIRST_PEAKS : 0, to = others ? PEAKS : FIRST_PEAKS;
    const size_t all = f->n, n = f->shape.nx * f->shape.ny, step = f->step;
    RC_OWNED double *room = rc_alloc(4 * n, sizeof *room);
    double q[NUMBERS] = {NAN}, least = INFINITY;

    *likeness = INFINITY;
    if (room == NULL)
        return rc_err_set(err, "out of memory for the fit of %zu heights", n);
    f->step = (n + SAMPLE - 1) / SAMPLE;
    f->n = (n + f->step - 1) / f->step;
    f->rounds = TRIAL;
    for (size_t k = 2 * from; k < 2 * to; k++) {
        const struct start *start = (k % 2 == 0 ? starts->of_phases : starts->of_heights) + k / 2;
        size_t count;
        if (!(start->score > 0))
            continue;
        memset(f->q, 0, sizeof f->q);
        f->q[0] = start->shift[0];
        f->q[1] = start->shift[1];
        f->q[2] = start->turn;
        f->fresh = true;
        if (fit_solve(f, err) != RC_OK)
            return RC_FAIL;
        count = find_spread(f);
        if (10 * (double)count > f->low->part * (double)f->n && f->spread < least) {
            least = f->spread;
            memcpy(q, f->q, sizeof q);
        }
    }
    f->fresh = false;
    f->step = step;
    f->n = all;
    f->rounds = ROUNDS;
    memcpy(f->q, q, sizeof q);
    if (isnan(q[0]))
        return RC_OK;
    if (fit_solve(f, err) != RC_OK)
        return RC_FAIL;
    find_change(f, room + 3 * n);
    if (find_likeness(f, room + 3 * n, room, likeness, err) != RC_OK)
        return RC_FAIL;
    if (*likeness > unlike)
        f->q[0] = NAN;
    return RC_OK;
}

/* Improves q on maps with 1/factor of the nodes; a NAN: there is no q yet, and starts are tried. */
static enum rc_status
solve_level(const struct rc_shape *a, const double *ha, const struct rc_shape *b, const double *hb,
            double below, size_t factor, int threads, bool others, double q[NUMBERS],
            double *likeness, struct rc_err *err)
{
    struct rc_shape sa, sb;
    RC_OWNED double *va = coarsened(a, ha, factor, below, &sa, err);
    RC_OWNED double *vb = coarsened(b, hb, factor, below, &sb, err);
    RC_ENDS(spline_free) struct spline spline = {0};
    RC_ENDS(low_free) struct low low = {0};
    RC_ENDS(fit_free) struct fit f = {0};
    struct starts starts;
    const bool first = isnan(q[0]);

    if (va == NULL || vb == NULL)
        return RC_FAIL;
    if (spline_new(&sb, vb, &spline, err) != RC_OK || low_new(&sb, vb, below, &low, err) != RC_OK ||
        fit_new(&sa, va, &spline, &low, threads, &f, err) != RC_OK)
        return RC_FAIL;
    if (first) {
        if (find_starts(&sa, va, &sb, vb, &starts, err) != RC_OK ||
            try_starts(&f, &starts, others, likeness, err) != RC_OK)
            return RC_FAIL;
    } else {
        memcpy(f.q, q, sizeof f.q);
        if (fit_solve(&f, err) != RC_OK)
            return RC_FAIL;
    }
    memcpy(q, f.q, sizeof f.q);
    return RC_OK;
}

/* ---- what has changed ---- */

/* Nodes on either side of a mean, and nodes around it that are marked, because shallow rims pull the offset.
 * The first row that leaves a quarter of the map counts: plateaus that are worn all over the map leave only
 * small places. */
static const struct patch {
    size_t side, margin;
} patches[] = {{3, 10}, {3, 4}, {1, 3}, {1, 1}};

static void
mark_patch(const struct rc_shape *s, size_t k, size_t margin, unsigned char *skip)
{
    const size_t i = k % s->nx, j = k / s->nx;

    for (size_t b = j < margin ? 0 : j - margin; b <= j + margin && b < s->ny; b++)
        for (size_t a = i < margin ? 0 : i - margin; a <= i + margin && a < s->nx; a++)
            skip[b * s->nx + a] = 1;
}

/* Marks the patches whose mean is far from 0; false, and no mark, if less than a quarter of the map is
 * left. */
static bool
mark_changes(const struct fit *f, const struct patch *patch, const double *change, double *mean,
             double *room, unsigned char *skip)
{
    const double far = 4; /* standard deviations of the means */
    const size_t n = f->shape.nx * f->shape.ny;
    size_t marked = 0, there = 0, means = 0;
    double limit;

#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t k = 0; k < n; k++)
        mean[k] = patch_mean(&f->shape, change, k, patch->side);
    for (size_t k = 0; k < n; k++)
        if (!isnan(mean[k]))
            room[means++] = mean[k];
    limit = far * smaller_side(room, means, room + n);
    memset(skip, 0, n);
    for (size_t k = 0; k < n; k++)
        if (fabs(mean[k]) > limit)
            mark_patch(&f->shape, k, patch->margin, skip);
    for (size_t k = 0; k < n; k++) {
        marked += skip[k] && !isnan(change[k]) ? 1 : 0;
        there += isnan(change[k]) ? 0 : 1;
    }
    if (4 * marked > 3 * there)
        memset(skip, 0, n);
    return 4 * marked <= 3 * there;
}

static bool
mark_all(const struct fit *f, const double *change, double *mean, double *room, unsigned char *skip)
{
    for (size_t k = 0; k < sizeof patches / sizeof *patches; k++)
        if (mark_changes(f, patches + k, change, mean, room, skip))
            return true;
    return false;
}

/* ---- slight changes ---- */

/* Where the weighted mean of the residuals is 0, for another reach. */
static double
level_within(const struct fit *f, double within)
{
    double level = 0, step = INFINITY;

    for (int round = 0; round < ROUNDS && fabs(step) > 1e-6 * f->spread; round++) {
        double sum = 0, weights = 0;
        for (size_t i = 0; i < f->n; i++) {
            const double w = rc_biweight(f->r[i] - level, within);
            if (w > 0) {
                sum += w * (f->r[i] - level);
                weights += w;
            }
        }
        step = weights > 0 ? sum / weights : 0;
        level += step;
    }
    return level;
}

/* Nodes that have changed by less than the reach cannot be told from noise. If all changes within it are
 * equally frequent, they pull the offset by the square of the reach. The pull follows from two reaches; it is
 * taken away, and returned, m. */
static double
take_pull(struct fit *f)
{
    const double pull =
        (level_within(f, reach * f->spread) - level_within(f, reach / 2 * f->spread)) * 4 / 3;

    f->q[3] -= pull;
    return pull;
}

/* ---- holes ---- */

/* Nodes of A on B where a height of A or B is missing. */
struct holes {
    size_t nodes;
    double sum, square; /* m: sum of the change there; m^2: square of its uncertainty of 95 % */
};

static bool
lies_on_b(const struct fit *f, size_t k)
{
    const struct rc_shape *b = &f->b->shape;
    double x, y, u, v;

    set_place(f, k, &x, &y);
    set_on_b(f->q, x, y, &u, &v);
    return fabs(u) / b->dx <= (double)(b->nx - 1) / 2 + beyond &&
           fabs(v) / b->dy <= (double)(b->ny - 1) / 2 + beyond;
}

/* Mean square of the known changes around a box, less `mean`. */
static double
square_around(const struct rc_shape *s, const double *change, const size_t low[2],
              const size_t high[2], double mean)
{
    const size_t width = high[0] - low[0] + 1, height = high[1] - low[1] + 1;
    size_t margin = 2 + (width < height ? width : height) / 2, n = 0;
    double sum = 0;

    for (; n == 0; margin *= 2) /* one change at least is known */
        for (size_t j = low[1] < margin ? 0 : low[1] - margin; j <= high[1] + margin && j < s->ny;
             j++)
            for (size_t i = low[0] < margin ? 0 : low[0] - margin;
                 i <= high[0] + margin && i < s->nx; i++) {
                const double r = change[j * s->nx + i];
                sum += isnan(r) ? 0 : (r - mean) * (r - mean);
                n += isnan(r) ? 0 : 1;
            }
    return sum / (double)n;
}

/* Adds the hole with node k, whose nodes are joined by their sides. The uncertainty of its mean change is the
 * spread of the known changes around it: in 55 pairs of scans with holes the error of their sum was 0.2 of
 * that on average, and at most 0.64. */
static void
add_hole(const struct fit *f, const double *change, const double *filled, unsigned char *missing,
         size_t *queue, size_t k, struct holes *holes)
{
    const size_t nx = f->shape.nx, ny = f->shape.ny;
    size_t low[2] = {k % nx, k / nx}, high[2] = {k % nx, k / nx}, n = 0;
    double sum = 0;

    queue[n++] = k;
    missing[k] = 0;
    for (size_t done = 0; done < n; done++) {
        const size_t at = queue[done], i = at % nx, j = at / nx;
        const bool there[] = {i > 0, i + 1 < nx, j > 0, j + 1 < ny};
        const size_t next[] = {at - 1, at + 1, at - nx, at + nx};
        sum += filled[at];
        low[0] = i < low[0] ? i : low[0];
        high[0] = i > high[0] ? i : high[0];
        low[1] = j < low[1] ? j : low[1];
        high[1] = j > high[1] ? j : high[1];
        for (int q = 0; q < 4; q++)
            if (there[q] && missing[next[q]]) {
                missing[next[q]] = 0;
                queue[n++] = next[q];
            }
    }
    holes->nodes += n;
    holes->sum += sum;
    holes->square +=
        (double)n * (double)n * square_around(&f->shape, change, low, high, sum / (double)n);
}

/* The change in the holes is the solution of Laplace's equation between the known changes around them. */
static enum rc_status
fill_holes(const struct fit *f, const double *change, struct holes *holes, struct rc_err *err)
{
    const size_t n = f->shape.nx * f->shape.ny;
    RC_OWNED unsigned char *missing = rc_calloc(n, 1);
    RC_OWNED double *filled = NULL;
    RC_OWNED size_t *queue = NULL;
    size_t all = 0, count;

    *holes = (struct holes){0};
    if (missing == NULL)
        return rc_err_set(err, "out of memory for the holes of %zu heights", n);
    for (size_t k = 0; k < n; k++)
        all += missing[k] = isnan(change[k]) && lies_on_b(f, k) ? 1 : 0;
    if (all == 0)
        return RC_OK;
    filled = rc_alloc(n, sizeof *filled);
    queue = rc_alloc(all, sizeof *queue);
    if (filled == NULL || queue == NULL)
        return rc_err_set(err, "out of memory for the holes of %zu heights", n);
    memcpy(filled, change, n * sizeof *filled);
    if (rc_inpaint(&f->shape, filled, &count, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < n; k++)
        if (missing[k])
            add_hole(f, change, filled, missing, queue, k, holes);
    return RC_OK;
}

/* ---- uncertainty ---- */

/* Ratio of the variance of sums over blocks to that of independent nodes: how many neighbours err alike. */
static double
correlated_nodes(const struct fit *f, const double *change)
{
    double most = 1;

    for (size_t side = 4; side <= 32; side *= 2) {
        double blocks = 0, nodes = 0;
        for (size_t b = 0; b + (f->shape.ny > 1 ? side : 1) <= f->shape.ny; b += side)
            for (size_t a = 0; a + side <= f->shape.nx; a += side) {
                double sum = 0;
                for (size_t j = b; j < b + side && j < f->shape.ny; j++)
                    for (size_t i = a; i < a + side; i++) {
                        const size_t k = j * f->shape.nx + i;
                        if (!counts(f, k) || !(fabs(change[k]) < reach * f->spread))
                            continue;
                        sum += change[k];
                        nodes += change[k] * change[k];
                    }
                blocks += sum * sum;
            }
        if (nodes > 0)
            most = fmax(most, blocks / nodes);
    }
    return most;
}

/* With the residuals r and the derivatives G of B the numbers err by N^-1 sum psi(r) G, N = sum psi'(r) G G'.
 * The volume is the sum of r, which changes by -(sum G)' of that, and by the level that was taken away. In
 * the holes G has its mean, and the error of the change that is filled in is added. */
static enum rc_status
find_errors(const struct fit *f, const double *change, double level, struct rc_alignment *found,
            struct rc_err *err)
{
    /* standard deviations: 95 %; of the volume more, by the pairs of scans of tests/long/law_align.c: the
     * rims of a change are not known, and the more has changed, the less the rest stands for the whole map */
    const double bar = 2, bar_of_volume = 2.5;
    const double far_off = 3; /* deviations of a node that has changed: 0.3 % are by chance */
    const size_t n = f->shape.nx * f->shape.ny, p = f->numbers;
    double normal[NUMBERS * NUMBERS] = {0}, scatter[NUMBERS * NUMBERS] = {0}, all[NUMBERS] = {0};
    double slope = 0, weights = 0, sum = 0, changed = 0, there = 0, volume = 0, pulls[NUMBERS];
    gsl_matrix_view m = gsl_matrix_view_array(normal, p, p);
    gsl_vector_view right = gsl_vector_view_array(all, p);
    double by[NUMBERS], part;
    double chosen; /* m: bound of the mean noise of the lowest nodes */
    struct holes holes;

    if (fill_holes(f, change, &holes, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < n; k++) {
        const double r = change[k], u = r / (reach * f->spread);
        const double w = k % f->step != 0 || !counts(f, k) ? 0 : rc_biweight(u, 1);
        if (isnan(r))
            continue;
        difference(f, f->q, k, by);
        there++;
        changed += fabs(r) > far_off * f->spread;
        weights += w;
        slope += w > 0 ? (1 - u * u) * (1 - 5 * u * u) : 0;
        for (size_t i = 0; i < p; i++) {
            all[i] += by[order[i]] * f->unit[order[i]];
            for (size_t j = 0; j < p && w > 0; j++) {
                const double g =
                    by[order[i]] * f->unit[order[i]] * by[order[j]] * f->unit[order[j]];
                normal[i * p + j] += w * g;
                scatter[i * p + j] += w * w * r * r * g;
            }
        }
    }
    if (!(weights > 0) || gsl_linalg_cholesky_decomp1(&m.matrix) != GSL_SUCCESS)
        return rc_err_set(err,
                          "the unchanged part of the maps does not determine the alignment: it "
                          "is flat, or equal along a line");
    slope = fmax(slope, 0.1 * weights) / weights;
    part = there / (there + (double)holes.nodes);
    for (size_t i = 0; i < p; i++)
        all[i] /= part;
    gsl_linalg_cholesky_svx(&m.matrix, &right.vector); /* now N^-1 sum G */
    for (size_t k = 0; k < n; k++) {
        const double r = change[k];
        const double w = k % f->step != 0 || !counts(f, k) ? 0 : rc_biweight(r, reach * f->spread);
        double pull = 0;
        if (isnan(r))
            continue;
        if (w == 0 && fabs(r) >= reach * f->spread) {
            volume += f->spread * f->spread;
            continue;
        }
        difference(f, f->q, k, by);
        for (size_t i = 0; i < p; i++)
            pull += all[i] * by[order[i]] * f->unit[order[i]];
        volume += r * r * (1 - w * pull / slope) * (1 - w * pull / slope);
    }
    sum = correlated_nodes(f, change);
    for (size_t i = 0; i < p; i++) {
        gsl_vector_view e = gsl_vector_view_array(pulls, p);
        double variance = 0;
        gsl_vector_set_basis(&e.vector, i);
        gsl_linalg_cholesky_svx(&m.matrix, &e.vector);
        for (size_t a = 0; a < p; a++)
            for (size_t b = 0; b < p; b++)
                variance += pulls[a] * scatter[a * p + b] * pulls[b];
        by[order[i]] = bar * sqrt(sum * variance) / slope * f->unit[order[i]];
    }
    chosen = f->spread * f->spread * f->low->slope * fmin(1, sum / f->low->m);
    found->shift_error = p == NUMBERS ? hypot(by[0], by[1]) : by[0];
    found->rotation_error = p == NUMBERS ? by[2] : 0;
    found->changed = changed / there;
    found->volume += holes.sum * f->shape.dx * f->shape.dy;
    found->volume_error =
        (hypot(bar_of_volume * (1 + found->changed) * sqrt(sum * volume), sqrt(holes.square)) +
         (fabs(level) + chosen) * there / part) *
        f->shape.dx * f->shape.dy;
    found->overlap = there / part / (double)n;
    found->missing = 1 - part;
    return RC_OK;
}

static const char apart[] = "the two maps do not fit on each other: are they scans of one surface, "
                            "turned by less than 12 degrees, with half of the overlap unworn? "
                            "Where more is worn, rc-add --align-below 20 fits on the lowest nodes";

static enum rc_status
do_not_fit(double likeness, struct rc_err *err)
{
    if (isinf(likeness))
        return rc_err_set(err, "%s", apart);
    return rc_err_set(err, "%s (the spread of A - B is %.0f %% of that of A; the limit is %.0f %%)",
                      apart, 100 * likeness, 100 * unlike);
}

/* From the first starts or the others. *likeness: see find_likeness; INFINITY: the maps
 * do not fit, 0: not known. */
static enum rc_status
align_from(const struct rc_shape *a, const double *ha, const struct rc_shape *b, const double *hb,
           double below, int threads, bool others, double *out, struct rc_alignment *found,
           double *likeness, struct rc_err *err)
{
    const size_t n = a->nx * a->ny;
    size_t side = a->nx, factor = 1;
    RC_ENDS(spline_free) struct spline spline = {0};
    RC_ENDS(low_free) struct low low = {0};
    RC_ENDS(fit_free) struct fit f = {0};
    RC_OWNED unsigned char *skip = rc_calloc(n, 1);
    RC_OWNED double *mean = rc_alloc(n, sizeof *mean);
    RC_OWNED double *room = rc_alloc(3 * n, sizeof *room);
    double q[NUMBERS] = {NAN};
    struct rc_statistics sum;
    double pull;

    *likeness = 0;
    if (skip == NULL || mean == NULL || room == NULL)
        return rc_err_set(err, "out of memory for the alignment of %zu heights", n);
    for (size_t k = 0; k < 3; k++)
        side = (size_t)fmax((double)side, (double)(k == 0 ? a->ny : k == 1 ? b->nx : b->ny));
    while (side > factor * COARSE)
        factor *= 2;
    for (; factor > 1 || isnan(q[0]); factor = factor > 1 ? factor / 2 : 1) {
        if (solve_level(a, ha, b, hb, below, factor, threads, others, q, likeness, err) != RC_OK)
            return RC_FAIL;
        if (isnan(q[0]))
            return do_not_fit(*likeness, err);
    }
    if (spline_new(b, hb, &spline, err) != RC_OK || low_new(b, hb, below, &low, err) != RC_OK ||
        fit_new(a, ha, &spline, &low, threads, &f, err) != RC_OK)
        return RC_FAIL;
    memcpy(f.q, q, sizeof q);
    f.skip = skip;
    for (int pass = 0; pass < 3; pass++) {
        if (fit_solve(&f, err) != RC_OK)
            return RC_FAIL;
        find_change(&f, out);
        if (pass < 2 && !mark_all(&f, out, mean, room, skip))
            break;
    }
    if (find_spread(&f) <= f.numbers) {
        *likeness = INFINITY;
        return do_not_fit(*likeness, err);
    }
    pull = take_pull(&f);
    find_spread(&f);
    find_change(&f, out);
    if (find_likeness(&f, out, room, likeness, err) != RC_OK)
        return RC_FAIL;
    if (*likeness > unlike)
        return do_not_fit(*likeness, err);
    *found = (struct rc_alignment){.shift_x = f.q[0],
                                   .shift_y = f.q[1],
                                   .rotation = f.q[2],
                                   .offset = f.q[3],
                                   .tilt_x = f.q[4],
                                   .tilt_y = f.q[5],
                                   .residual = f.spread};
    rc_measure(a, out, &sum);
    found->volume = sum.sum * a->dx * a->dy;
    return find_errors(&f, out, pull, found, err);
}

static enum rc_status
check(const struct rc_shape *s, const double *h, const char *name, struct rc_err *err)
{
    struct rc_statistics is;

    rc_measure(s, h, &is);
    if (s->nx < SMALLEST || (s->ny < SMALLEST && s->ny != 1))
        return rc_err_set(err, "%s has %zu x %zu nodes: an alignment needs %d a side", name, s->nx,
                          s->ny, SMALLEST);
    if (is.infinite > 0)
        return rc_err_set(err, "%s has %zu infinite heights", name, is.infinite);
    if (4 * is.missing > 3 * s->nx * s->ny)
        return rc_err_set(err, "%s: %zu of %zu points are missing: too few for an alignment", name,
                          is.missing, s->nx * s->ny);
    return RC_OK;
}

enum rc_status
rc_align(const struct rc_shape *a, const double *ha, const struct rc_shape *b, const double *hb,
         double below, size_t threads, double *out, struct rc_alignment *found, struct rc_err *err)
{
    const int team = rc_useful_threads(a, threads);
    struct rc_shape both;
    enum rc_status status;
    double likeness;

    if (rc_add_shape(a, b, &both, err) != RC_OK || check(a, ha, "A", err) != RC_OK ||
        check(b, hb, "B", err) != RC_OK)
        return RC_FAIL;
    if ((a->ny == 1) != (b->ny == 1))
        return rc_err_set(err, "one is a profile and the other a map: they cannot be aligned");
    if (!(below > 0 && below <= 1))
        return rc_err_set(
            err, "the lowest %g of the nodes: an alignment takes a part above 0, up to 1", below);
    rc_handler_begin();
    status = align_from(a, ha, b, hb, below, team, false, out, found, &likeness, err);
    if (status != RC_OK && likeness > unlike)
        status = align_from(a, ha, b, hb, below, team, true, out, found, &likeness, err);
    rc_handler_end();
    return status;
}
