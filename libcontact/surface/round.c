/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Spheres and cylinders by least squares in z, the way in which heights are measured.
 *
 * With lengths in units of half the map, about the middle of the points, a sphere is
 *
 *     A (x^2 + y^2 + z^2) + B x + C y + z + E = 0,        R = sqrt(B^2 + C^2 + 1 - 4 A E) / 2 A,
 *
 * which for A = 0 is a plane (Pratt 1987). So no parameter diverges on shallow caps or where the apex is off
 * the map. The sign of R distinguishes a bump from a hollow. With q = A (x^2 + y^2) + B x + C y + E the
 * surface is z = -2 q / (1 + sqrt(1 - 4 A q)). A cylinder whose axis runs along v = y cos t - x sin t and
 * rises with the slope s has the same equation in the plane across it. There u = x cos t + y sin t and n = (z
 * - s v) / sqrt(1 + s^2). On a profile both are circles.
 *
 * The equation is linear in A, B, C, E; the iteration (Levenberg 1944, Marquardt 1963) starts from its
 * least-squares solution.
 */
#include "libcontact/common.h"

#include <math.h>
#include <string.h>

#include "form.h"
#include "libcontact/memory.h"
#include "robust.h"

enum {
    UNKNOWNS = 6, /* largest number; that of a quadratic polynomial */
    PAIRS = (UNKNOWNS + 1) * (UNKNOWNS + 2) / 2, /* products of the columns of the unknowns and the
                                              * heights */
    TOGETHER = 4,                                /* sums of products that one loop computes */
    GROUPS = 256,                                /* number of groups of rows that one thread sums */
    SEGMENT = 256,                               /* nodes of a row that are processed together */
    STEPS = 100,
    START_WEIGHTS = 6 /* rounds of them */
};

/* Names of the parameters. */
enum {
    A,
    B,
    C,
    E, /* for a cylinder B and C are its slopes along x and y at the middle, T its direction */
    T,
    PARAMETERS
};

/* Converged when a step moves the surface by less than this fraction of its size on average. Where the form
 * fits the heights, steps decrease quadratically; with noise, by a constant factor. */
static const double settled = 1e-9;
/* Ratio of sag and height of the points, below which the curvature is rounding. */
static const double no_curvature = 1e-11;
/* Pivot of the normal equations scaled to a diagonal of 1; below it they are singular. */
static const double no_pivot = 1e-13;

/* The surface at n positions x of a row y. e holds heights and becomes their distances above the surface, NaN
 * where the surface has no height. d becomes the derivatives with respect to the parameters, n numbers
 * each. */
typedef void surface_row(const double *p, size_t n, const double *x, double y, double *e,
                         double *d);

struct round {
    const struct rc_shape *shape;
    const struct rc_form *form;
    const char *name;
    const double *h;
    double mean, size; /* mean of the heights, m; size: root of their mean square about the mean */
    double scale;      /* m; lengths are in units of it                                     */
    double middle_x, middle_y; /* nodes                                        */
    double *residual, reach;   /* robust: residual of each height, for weights */
    double *x, *sums;
    int threads;
    size_t unknowns, unknown[UNKNOWNS]; /* which parameters they are                            */
    surface_row *surface;
};

/* Sums over the points. */
struct normal {
    double matrix[UNKNOWNS][UNKNOWNS], right[UNKNOWNS];
    double squares; /* squares of the residuals */
    double outside; /* points with weight but no surface */
};

enum {
    OUTSIDE = PAIRS, /* its place behind the sums of the pairs */
    SUMS
};

/* ---- rows of the surfaces ---- */

/* z, and d z / d q = -1 / root; both 0 where the surface has no height. */
static inline double
height(double a, double q, double *slope, bool *there)
{
    double square = 1 - 4 * a * q, root, per; /* per: one division for both */

    *there = square > 0;
    root = sqrt(*there ? square : 1);
    per = *there ? 1 / (root + root * root) : 0;
    *slope = -(1 + root) * per;
    return -2 * q * root * per;
}

RC_WIDE_CLONES static void
sphere_row(const double *p, size_t n, const double *restrict x, double y, double *restrict e,
           double *restrict d)
{
    for (size_t i = 0; i < n; i++) {
        double rho2 = x[i] * x[i] + y * y, slope;
        bool there;
        double z = height(p[A], p[A] * rho2 + p[B] * x[i] + p[C] * y + p[E], &slope, &there);
        e[i] = there ? e[i] - z : NAN;
        d[i] = slope * (rho2 + z * z);
        d[n + i] = slope * x[i];
        d[2 * n + i] = slope * y;
        d[3 * n + i] = slope;
    }
}

/* The parameters of a cylinder in its own directions. */
struct across {
    double cos, sin, rise, root; /* direction of the axis, its slope s, and sqrt(1 + s^2) */
    double slope, b;             /* slope across it at the middle, and its B */
};

static struct across
across_of(const double *p)
{
    struct across c = {.cos = cos(p[T]), .sin = sin(p[T])};

    c.rise = p[C] * c.cos - p[B] * c.sin;
    c.slope = p[B] * c.cos + p[C] * c.sin;
    c.root = sqrt(1 + c.rise * c.rise);
    c.b = -c.slope / c.root;
    return c;
}

RC_WIDE_CLONES static void
cylinder_row(const double *p, size_t n, const double *restrict x, double y, double *restrict e,
             double *restrict d)
{
    const struct across c = across_of(p);
    /* derivatives of b with respect to the rise and to the parameters */
    const double rise = c.rise / c.root;
    const double by_rise = c.slope * c.rise / (c.root * c.root * c.root);
    const double b_B = -c.cos / c.root - by_rise * c.sin;
    const double b_C = -c.sin / c.root + by_rise * c.cos;
    const double b_T = -c.rise / c.root - by_rise * c.slope;

    for (size_t i = 0; i < n; i++) {
        double u = x[i] * c.cos + y * c.sin, v = y * c.cos - x[i] * c.sin, slope;
        bool there;
        double m = height(p[A], p[A] * u * u + c.b * u + p[E], &slope, &there);
        double z_b = c.root * slope * u, z_rise = v + rise * m;
        double z_T = -c.rise * u + c.root * slope * (2 * p[A] * u + c.b) * v;
        e[i] = there ? e[i] - (c.rise * v + c.root * m) : NAN;
        d[i] = c.root * slope * (u * u + m * m);
        d[n + i] = z_b * b_B - z_rise * c.sin;
        d[2 * n + i] = z_b * b_C + z_rise * c.cos;
        d[3 * n + i] = c.root * slope;
        d[4 * n + i] = z_T + z_b * b_T - z_rise * c.slope;
    }
}

/* ---- rows of the linear equations of the start ---- */

/* A quadratic polynomial; its parameters are the coefficients of 1, x, y, x^2, xy, y^2. */
RC_WIDE_CLONES static void
quadratic_row(const double *p, size_t n, const double *restrict x, double y, double *restrict e,
              double *restrict d)
{
    for (size_t i = 0; i < n; i++) {
        const double term[UNKNOWNS] = {1, x[i], y, x[i] * x[i], x[i] * y, y * y};
        for (size_t a = 0; a < UNKNOWNS; a++) {
            d[a * n + i] = term[a];
            e[i] -= p[a] * term[a];
        }
    }
}

static void
sphere_equation(const double *p, size_t n, const double *x, double y, double *e, double *d)
{
    (void)p;
    for (size_t i = 0; i < n; i++) {
        double z = e[i];
        d[i] = -(x[i] * x[i] + y * y + z * z);
        d[n + i] = -x[i];
        d[2 * n + i] = -y;
        d[3 * n + i] = -1;
    }
}

/* Works in the plane across the axis, whose direction and slopes are known. */
static void
cylinder_equation(const double *p, size_t n, const double *x, double y, double *e, double *d)
{
    const struct across c = across_of(p);

    for (size_t i = 0; i < n; i++) {
        double u = x[i] * c.cos + y * c.sin, v = y * c.cos - x[i] * c.sin;
        e[i] = (e[i] - c.rise * v) / c.root;
        d[i] = -(u * u + e[i] * e[i]);
        d[n + i] = -u;
        d[2 * n + i] = -1;
    }
}

/* ---- sums over the points ---- */

static double
place_y(const struct round *f, size_t j)
{
    return ((double)j - f->middle_y) * f->shape->dy / f->scale;
}

/* Adds the sums of the products with each of these columns of n numbers. Several sums are computed together;
 * alone, each addition would wait for the one before. */
static inline void
product_sums(size_t n, const double *restrict t, const double *const *column, size_t columns,
             double *sums)
{
    for (size_t b = 0; b < columns; b += TOGETHER) {
        const double *c[TOGETHER];
        double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
        size_t some = columns - b < TOGETHER ? columns - b : TOGETHER;
        for (size_t k = 0; k < TOGETHER; k++)
            c[k] = column[b + (k < some ? k : 0)];
#pragma omp simd reduction(+ : s0, s1, s2, s3)
        for (size_t i = 0; i < n; i++) {
            s0 += t[i] * c[0][i];
            s1 += t[i] * c[1][i];
            s2 += t[i] * c[2][i];
            s3 += t[i] * c[3][i];
        }
        for (size_t k = 0; k < some; k++)
            sums[b + k] += (const double[]){s0, s1, s2, s3}[k];
    }
}

/* Heights of n nodes in units of the scale, and their weights, both 0 at missing points; r: the residuals for
 * the weights, or NULL. */
RC_WIDE_CLONES static void
weigh(size_t n, const double *restrict h, const double *restrict r, double reach, double mean,
      double per, double *restrict e, double *restrict w)
{
    for (size_t i = 0; i < n; i++) {
        bool there = h[i] == h[i];
        w[i] = there ? 1 : 0;
        e[i] = there ? (h[i] - mean) * per : 0;
    }
    for (size_t i = 0; i < n && r != NULL; i++)
        w[i] *= rc_biweight(r[i], reach);
}

/* Adds the sums of n nodes: the products of each column with the columns before it and with itself; the
 * heights are the last column. Counts points with weight but no surface. */
RC_WIDE_CLONES static void
add_sums(size_t n, size_t unknowns, const size_t *column, double *restrict e, double *restrict w,
         const double *restrict d, double *restrict sums)
{
    const double *of[UNKNOWNS + 1];
    double t[SEGMENT], outside = 0;

#pragma omp simd reduction(+ : outside)
    for (size_t i = 0; i < n; i++) {
        bool there = e[i] == e[i];
        outside += (!there & (w[i] > 0)) ? 1 : 0;
        w[i] = there ? w[i] : 0;
        e[i] = there ? e[i] : 0;
    }
    for (size_t a = 0; a < unknowns; a++)
        of[a] = d + column[a] * n;
    of[unknowns] = e;
    sums[OUTSIDE] += outside;
    for (size_t a = 0; a <= unknowns; a++) {
        for (size_t i = 0; i < n; i++)
            t[i] = w[i] * of[a][i];
        product_sums(n, t, of, a + 1, sums);
        sums += a + 1;
    }
}

/* Sums of a row. */
static void
sum_row(const struct round *f, size_t j, surface_row *row, const double *p, size_t unknowns,
        const size_t *column, double *sums)
{
    size_t nx = f->shape->nx;
    double e[SEGMENT], w[SEGMENT], d[UNKNOWNS * SEGMENT];

    for (size_t i = 0; i < nx; i += SEGMENT) {
        size_t n = nx - i < SEGMENT ? nx - i : SEGMENT, k = j * nx + i;
        weigh(n, f->h + k, f->reach > 0 ? f->residual + k : NULL, f->reach, f->mean, 1 / f->scale,
              e, w);
        row(p, n, f->x + i, place_y(f, j), e, d);
        add_sums(n, unknowns, column, e, w, d, sums);
    }
}

/* Sums each group of rows, then the groups in order: the result does not depend on the threads. */
static void
sum_all(const struct round *f, surface_row *row, const double *p, size_t unknowns,
        const size_t *column, struct normal *normal)
{
    double total[SUMS] = {0}, *of = total;
    size_t ny = f->shape->ny;

#pragma omp parallel for schedule(static) num_threads(f->threads)
    for (size_t g = 0; g < GROUPS; g++) {
        double *sums = f->sums + g * SUMS;
        memset(sums, 0, SUMS * sizeof *sums);
        for (size_t j = g * ny / GROUPS; j < (g + 1) * ny / GROUPS; j++)
            sum_row(f, j, row, p, unknowns, column, sums);
    }
    for (size_t g = 0; g < GROUPS; g++)
        for (size_t k = 0; k < SUMS; k++)
            total[k] += f->sums[g * SUMS + k];
    for (size_t a = 0; a < unknowns; a++)
        for (size_t b = 0; b <= a; b++)
            normal->matrix[a][b] = normal->matrix[b][a] = *of++;
    for (size_t a = 0; a < unknowns; a++)
        normal->right[a] = *of++;
    normal->squares = *of;
    normal->outside = total[OUTSIDE];
}

/* The sums that need no derivatives: squares and points outside. */
static void
sum_squares(const struct round *f, const double *p, struct normal *normal)
{
    sum_all(f, f->surface, p, 0, NULL, normal);
}

static void
sum_surface(const struct round *f, const double *p, struct normal *normal)
{
    sum_all(f, f->surface, p, f->unknowns, f->unknown, normal);
}

/* The residual of each height in row j, in units of the scale; `beside` where the surface has no height. */
static void
residual_row(const struct round *f, surface_row *row, const double *p, size_t j, double beside,
             double *to)
{
    size_t nx = f->shape->nx;
    const double per = 1 / f->scale;
    double e[SEGMENT], d[UNKNOWNS * SEGMENT];

    for (size_t i = 0; i < nx; i += SEGMENT) {
        size_t n = nx - i < SEGMENT ? nx - i : SEGMENT;
        const double *h = f->h + j * nx + i;
        for (size_t k = 0; k < n; k++)
            e[k] = (h[k] - f->mean) * per;
        row(p, n, f->x + i, place_y(f, j), e, d);
        for (size_t k = 0; k < n; k++)
            to[i + k] = isnan(h[k]) ? NAN : isnan(e[k]) ? beside : e[k];
    }
}

static void
find_residuals(const struct round *f, surface_row *row, const double *p)
{
#pragma omp parallel for schedule(static) num_threads(f->threads)
    for (size_t j = 0; j < f->shape->ny; j++)
        residual_row(f, row, p, j, INFINITY, f->residual + j * f->shape->nx);
}

/* ---- the equations ---- */

/* Solves (matrix + damping times its diagonal) x = right for n unknowns x, by Cholesky's factors of the
 * matrix scaled to a diagonal of 1. False where a pivot is below no_pivot. */
static bool
solve_damped(size_t n, const struct normal *normal, double damping, double *x)
{
    double l[UNKNOWNS][UNKNOWNS], scale[UNKNOWNS];

    for (size_t a = 0; a < n; a++) {
        if (!(normal->matrix[a][a] > 0))
            return false;
        scale[a] = 1 / sqrt(normal->matrix[a][a]);
    }
    for (size_t a = 0; a < n; a++) {
        for (size_t b = 0; b <= a; b++) {
            double s = normal->matrix[a][b] * scale[a] * scale[b] + (a == b ? damping : 0);
            for (size_t k = 0; k < b; k++)
                s -= l[a][k] * l[b][k];
            if (a == b && !(s > no_pivot))
                return false;
            l[a][b] = a == b ? sqrt(s) : s / l[b][b];
        }
        x[a] = normal->right[a] * scale[a];
        for (size_t k = 0; k < a; k++)
            x[a] -= l[a][k] * x[k];
        x[a] /= l[a][a];
    }
    for (size_t a = n; a-- > 0;) {
        for (size_t k = a + 1; k < n; k++)
            x[a] -= l[k][a] * x[k];
        x[a] /= l[a][a];
    }
    for (size_t a = 0; a < n; a++)
        x[a] *= scale[a];
    return true;
}

/* Mean square displacement of the surface in a step, times the number of points. */
static double
moved(size_t n, const struct normal *normal, const double *step)
{
    double sum = 0;

    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++)
            sum += step[a] * normal->matrix[a][b] * step[b];
    return sum;
}

static enum rc_status
undetermined(const struct round *f, struct rc_err *err)
{
    return rc_err_set(err,
                      "the points that %s do not determine a %s: too few rows or columns of them, "
                      "or no curvature; subtract a plane instead",
                      f->reach > 0 ? "are left with weight" : "are there", f->name);
}

/* Iterates p to the least squares with the present weights, until it converges or for this number of
 * steps. */
static enum rc_status
descend(const struct round *f, double *p, size_t steps, struct rc_err *err)
{
    double damping = 0, enough = settled * settled * (double)(f->shape->nx * f->shape->ny) *
                                 (f->size / f->scale) * (f->size / f->scale);
    struct normal now, next;
    size_t taken = 0;

    sum_surface(f, p, &now);
    for (size_t k = 0; k < STEPS && taken < steps; k++) {
        double step[UNKNOWNS], to[PARAMETERS];
        if (!solve_damped(f->unknowns, &now, damping, step)) {
            if (damping > 0)
                return undetermined(f, err);
            damping = 1e-3;
            continue;
        }
        memcpy(to, p, sizeof to);
        for (size_t a = 0; a < f->unknowns; a++)
            to[f->unknown[a]] += step[a];
        if (taken + 1 < steps) {
            sum_surface(f, to, &next);
        } else { /* the last pass: nothing starts from it */
            next = now;
            sum_squares(f, to, &next);
        }
        if (next.outside == 0 && next.squares <= now.squares) {
            bool last = moved(f->unknowns, &now, step) <= enough && damping <= 1e-3;
            memcpy(p, to, sizeof to);
            now = next;
            taken++;
            damping = damping > 1e-9 ? damping / 10 : 0;
            if (last)
                break;
        } else if (next.outside == 0 && moved(f->unknowns, &now, step) <= enough) {
            break; /* only rounding errors are left */
        } else {
            damping = damping > 0 ? 10 * damping : 1e-3;
            if (damping > 1e12)
                return rc_err_set(err, "no %s fits these heights: the search found no way down",
                                  f->name);
        }
    }
    return solve_damped(f->unknowns, &now, 0, (double[UNKNOWNS]){0}) ? RC_OK : undetermined(f, err);
}

/* ---- the start ---- */

/* Reduces the curvature until the surface has a height at all points with weight. */
static enum rc_status
flatten(const struct round *f, double *p, struct rc_err *err)
{
    struct normal normal;

    for (size_t k = 0; k < STEPS; k++) {
        sum_squares(f, p, &normal);
        if (normal.outside == 0)
            return RC_OK;
        p[A] *= 0.8;
    }
    return undetermined(f, err);
}

static enum rc_status
start_sphere(const struct round *f, double *p, struct rc_err *err)
{
    struct normal normal;
    double x[UNKNOWNS];

    sum_all(f, sphere_equation, p, f->unknowns, f->unknown, &normal);
    if (!solve_damped(f->unknowns, &normal, 0, x))
        return undetermined(f, err);
    for (size_t a = 0; a < f->unknowns; a++)
        p[f->unknown[a]] = x[a];
    return RC_OK;
}

/* Finds the direction of the largest curvature of a quadratic polynomial. */
static enum rc_status
start_cylinder(const struct round *f, double *p, struct rc_err *err)
{
    static const size_t column[UNKNOWNS] = {0, 1, 2, 3, 4, 5};
    bool profile = f->shape->nx == 1 || f->shape->ny == 1;
    struct normal normal;
    double x[UNKNOWNS], slope;

    p[T] = f->shape->nx == 1 ? acos(0) : 0;
    if (!profile) {
        double mean, half;
        sum_all(f, quadratic_row, (double[UNKNOWNS]){0}, UNKNOWNS, column, &normal);
        if (!solve_damped(UNKNOWNS, &normal, 0, x))
            return undetermined(f, err);
        mean = 0.5 * (x[3] + x[5]);
        half = 0.5 * hypot(x[3] - x[5], x[4]);
        p[T] = 0.5 * atan2(x[4], x[3] - x[5]); /* direction of the curvature mean + half */
        if (fabs(mean - half) > fabs(mean + half))
            p[T] += acos(0);
        p[B] = x[1];
        p[C] = x[2];
    }
    sum_all(f, cylinder_equation, p, 3, column, &normal);
    if (!solve_damped(3, &normal, 0, x))
        return undetermined(f, err);
    p[A] = x[0];
    p[E] = x[2];
    /* sets the slope across the axis for this B; keeps the slope along it */
    {
        struct across c = across_of(p);
        slope = -x[1] * c.root;
        p[B] = slope * c.cos - c.rise * c.sin;
        p[C] = slope * c.sin + c.rise * c.cos;
    }
    return RC_OK;
}

/* Weights that exclude points far from a quadratic polynomial, which is itself fitted with such weights. They
 * need not converge, because they only serve the start. */
static enum rc_status
start_weights(struct round *f, struct rc_err *err)
{
    static const size_t in_x[] = {0, 1, 3}, in_y[] = {0, 2, 5}, all[] = {0, 1, 2, 3, 4, 5};
    const size_t *column = f->shape->ny == 1 ? in_x : f->shape->nx == 1 ? in_y : all;
    size_t terms = column == all ? 6 : 3, n = f->shape->nx * f->shape->ny;
    const double none[UNKNOWNS] = {0};
    struct normal normal;

    for (size_t k = 0; k < START_WEIGHTS; k++) {
        double x[UNKNOWNS], c[UNKNOWNS] = {0}, reach;
        sum_all(f, quadratic_row, none, terms, column, &normal);
        if (!solve_damped(terms, &normal, 0, x))
            return undetermined(f, err);
        for (size_t a = 0; a < terms; a++)
            c[column[a]] = x[a];
        find_residuals(f, quadratic_row, c);
        reach = rc_biweight_reach * rc_median(f->residual, n, 0, true, f->threads);
        if (!(reach > 0))
            break;
        f->reach = reach;
    }
    return RC_OK;
}

/* ---- the fit ---- */

static void
choose_unknowns(struct round *f)
{
    bool sphere = f->form->kind == RC_SPHERE;

    f->unknown[f->unknowns++] = A;
    if (f->shape->nx > 1)
        f->unknown[f->unknowns++] = B;
    if (f->shape->ny > 1)
        f->unknown[f->unknowns++] = C;
    f->unknown[f->unknowns++] = E;
    if (!sphere && f->shape->nx > 1 && f->shape->ny > 1)
        f->unknown[f->unknowns++] = T;
    f->name = sphere ? "sphere" : "cylinder";
    f->surface = sphere ? sphere_row : cylinder_row;
}

static enum rc_status
round_new(struct round *f, struct rc_store *own, const struct rc_shape *shape,
          const struct rc_form *form, const double *h, struct rc_err *err)
{
    struct rc_box box = rc_box_of(shape, h);
    struct rc_statistics s;

    *f = (struct round){.shape = shape, .form = form, .h = h};
    choose_unknowns(f);
    if (box.infinite > 0)
        return rc_err_set(err, "%zu infinite heights: no %s fits them", box.infinite, f->name);
    if (box.count < f->unknowns)
        return rc_err_set(err,
                          "a %s has %zu unknowns, and only %zu points are there: subtract a plane",
                          f->name, f->unknowns, box.count);
    rc_measure(shape, h, &s);
    f->mean = s.mean;
    f->size = s.rms;
    f->scale = 0.5 * fmax((double)(box.right - box.left) * shape->dx,
                          (double)(box.bottom - box.top) * shape->dy);
    f->middle_x = 0.5 * (double)(box.left + box.right);
    f->middle_y = 0.5 * (double)(box.top + box.bottom);
    f->threads = rc_useful_threads(shape, form->threads);
    f->x = rc_store_take(own, shape->nx, sizeof *f->x);
    f->sums = rc_store_take(own, GROUPS, SUMS * sizeof *f->sums);
    if (form->robust)
        f->residual = rc_store_take(own, shape->nx * shape->ny, sizeof *f->residual);
    if (own->failed)
        return rc_err_set(err, "out of memory for a %s through %zu heights", f->name, box.count);
    for (size_t i = 0; i < shape->nx; i++)
        f->x[i] = ((double)i - f->middle_x) * shape->dx / f->scale;
    return RC_OK;
}

static enum rc_status
reweight(struct round *f, double *p, struct rc_err *err)
{
    size_t n = f->shape->nx * f->shape->ny;

    for (size_t k = 0; k < RC_REWEIGHT_MAX; k++) {
        double before = k == 0 ? 0 : f->reach, reach;
        find_residuals(f, f->surface, p);
        reach = rc_biweight_reach * rc_median(f->residual, n, 0, true, f->threads);
        if (rc_reweighted(reach, before, f->size / f->scale))
            break;
        f->reach = reach;
        if (descend(f, p, 1, err) != RC_OK)
            return RC_FAIL;
    }
    return f->reach > 0 ? descend(f, p, STEPS, err) : RC_OK;
}

static enum rc_status
fit_round(struct round *f, double *p, struct rc_err *err)
{
    enum rc_status status;

    if (f->form->robust && start_weights(f, err) != RC_OK)
        return RC_FAIL;
    status = f->form->kind == RC_SPHERE ? start_sphere(f, p, err) : start_cylinder(f, p, err);
    if (status != RC_OK)
        return RC_FAIL;
    if (!(fabs(p[A]) > no_curvature * f->size / f->scale))
        return undetermined(f, err);
    if (flatten(f, p, err) != RC_OK || descend(f, p, f->form->robust ? 1 : STEPS, err) != RC_OK)
        return RC_FAIL;
    return f->form->robust ? reweight(f, p, err) : RC_OK;
}

static double
radius_of(const struct round *f, const double *p)
{
    double square = 1 - 4 * p[A] * p[E];

    if (f->form->kind == RC_SPHERE) {
        square += p[B] * p[B] + p[C] * p[C];
    } else {
        double b = across_of(p).b;
        square += b * b;
    }
    return f->scale * sqrt(square) / (2 * p[A]);
}

/* Subtracts the form, in metres; changes nothing when a point lies beside the form. */
static enum rc_status
subtract(struct round *f, const double *p, double radius, double *h, struct rc_err *err)
{
    size_t nx = f->shape->nx;
    struct normal normal;

    f->reach = 0; /* all points count */
    sum_squares(f, p, &normal);
    if (normal.outside > 0)
        return rc_err_set(err,
                          "%.0f points lie beside the %s of radius %g m that fits the others: "
                          "make them missing, or cut the map",
                          normal.outside, f->name, fabs(radius));
#pragma omp parallel for schedule(static) num_threads(f->threads)
    for (size_t j = 0; j < f->shape->ny; j++) {
        residual_row(f, f->surface, p, j, NAN, h + j * nx);
        for (size_t i = 0; i < nx; i++)
            h[j * nx + i] *= f->scale;
    }
    return RC_OK;
}

enum rc_status
rc_detrend_round(const struct rc_shape *shape, const struct rc_form *form, double *h,
                 double *radius, struct rc_err *err)
{
    RC_ENDS(rc_store_free) struct rc_store own = {0};
    double p[PARAMETERS] = {0}, found;
    struct round f;

    if (round_new(&f, &own, shape, form, h, err) != RC_OK || fit_round(&f, p, err) != RC_OK)
        return RC_FAIL;
    found = radius_of(&f, p);
    if (subtract(&f, p, found, h, err) != RC_OK)
        return RC_FAIL;
    if (radius != NULL)
        *radius = found;
    return RC_OK;
}
