/*
 * Semismooth Newton on the faces of the discs.
 *
 *  1. A node with |q| < g sticks: both components are free. One on its circle slips, its tangent alone is free, but for
 *     one whose slip points inwards: that sticks again. delta is the mean of Tq - w over |q| < g.
 *  2. Two steps of preconditioned conjugate gradients on T + D, D = |s|/g along the tangents: the curvature of the
 *     circle, without which it is not Newton's method.
 *  3. Back: nodes that slip radially on to their circles, the others to the nearest tractions on the discs that carry
 *     the load. The energy is the judge: where that does not lower it, a part of the step goes the same way, and where this
 *     does not either, a step of the projected gradient, which always does.
 *
 * The preconditioner is that of extension.h. Applied to the residual it is also the estimate of the error.
 */
#include "discs.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    OFF = RC_FACE_OFF,
    STICK = RC_FACE_STICK,
    SLIP = RC_FACE_SLIP
};
enum {
    SUMS = 8,
    STEPS = 2 /* of conjugate gradients */
};
static const double safety = 1.2; /* of the estimate */
static const double many = 0.05;  /* of the nodes that stick: these are other faces */

static const double on_circle = 1e-12;

/* ---- rows and sums ---- */

/* Rows are summed by themselves and added in order: any number of threads gives the same. */
static void
total(const struct rc_discs *d, size_t sums, double *out)
{
    struct rc_total t[SUMS] = {{0}};

    for (size_t j = 0; j < d->ny; j++)
        for (size_t k = 0; k < sums; k++)
            rc_total_add(&t[k], d->partial[j * SUMS + k]);
    for (size_t k = 0; k < sums; k++)
        out[k] = rc_total_value(&t[k]);
}

static double
most(const struct rc_discs *d, size_t k)
{
    double m = 0;

    for (size_t j = 0; j < d->ny; j++)
        m = fmax(m, d->partial[j * SUMS + k]);
    return m;
}

static double *
sums_of(const struct rc_discs *d, size_t j)
{
    double *s = d->partial + j * SUMS;

    memset(s, 0, SUMS * sizeof *s);
    return s;
}

/* Of what a symmetric 2 x 2 matrix (xx, yy, xy) maps to v; across its null space where it has one. */
static void
solve(const double m[3], const double v[2], double x[2])
{
    double trace = m[0] + m[1], det = m[0] * m[1] - m[2] * m[2];

    if (!(trace > 0)) {
        x[0] = x[1] = 0;
    } else if (det > 1e-14 * trace * trace) {
        x[0] = (m[1] * v[0] - m[2] * v[1]) / det;
        x[1] = (m[0] * v[1] - m[2] * v[0]) / det;
    } else { /* of rank 1: over the square of its trace */
        x[0] = (m[0] * v[0] + m[2] * v[1]) / (trace * trace);
        x[1] = (m[2] * v[0] + m[1] * v[1]) / (trace * trace);
    }
}

/* ---- the load ---- */

/* What the nodes that are not skipped carry when y is moved by nu, and how that grows with nu; part 2 to 6:
 * xx yy xy of the growth, and the function whose gradient that is. */
static void
carried(const struct rc_discs *d, double *const y[2], int skip, const double nu[2], double out[6])
{
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++) {
        double *sum = sums_of(d, j);
        for (size_t k = j * d->nx; k < (j + 1) * d->nx; k++) {
            double x = y[0][k] + nu[0], v = y[1][k] + nu[1], r, g = d->g[k], e;
            if (d->face[k] == OFF || d->face[k] == skip)
                continue;
            r = sqrt(x * x + v * v);
            if (r <= g) {
                sum[0] += x;
                sum[1] += v;
                sum[2] += 1;
                sum[3] += 1;
                sum[5] += r * r / 2;
                continue;
            }
            e = g / r;
            sum[0] += e * x;
            sum[1] += e * v;
            sum[2] += e * v * v / (r * r);
            sum[3] += e * x * x / (r * r);
            sum[4] -= e * x * v / (r * r);
            sum[5] += g * (r - g / 2);
        }
    }
    total(d, 6, out);
}

/* nu, so that the nearest tractions on the discs to y + nu carry `load` on the nodes that are not skipped:
 * the minimum of a convex function, by Newton's method. False where they cannot. */
static bool
find_shift(const struct rc_discs *d, double *const y[2], int skip, const double load[2],
           double nu[2])
{
    double at[6], size = hypot(d->sum[0], d->sum[1]);

    nu[0] = nu[1] = 0;
    carried(d, y, skip, nu, at);
    for (int step = 0; step < 100; step++) {
        double f[2] = {load[0] - at[0], load[1] - at[1]}, move[2], next[2], there[6], part = 1;
        double value = at[5] - load[0] * nu[0] - load[1] * nu[1], slope;

        if (hypot(f[0], f[1]) <= 4 * DBL_EPSILON * (size + hypot(load[0], load[1])))
            return true;
        solve(&at[2], f, move);
        slope = move[0] * f[0] + move[1] * f[1];
        if (!(slope > 0))
            return step > 0 && hypot(f[0], f[1]) <= 1e-9 * size;
        for (;; part /= 2) {
            next[0] = nu[0] + part * move[0];
            next[1] = nu[1] + part * move[1];
            carried(d, y, skip, next, there);
            if (there[5] - load[0] * next[0] - load[1] * next[1] <=
                value - 1e-4 * part * slope + 1e-13 * fabs(value))
                break;
            if (part < 1e-6)
                return hypot(f[0], f[1]) <= 1e-9 * size;
        }
        /* nothing is left but rounding */
        if (step > 3 && hypot(load[0] - there[0], load[1] - there[1]) >= hypot(f[0], f[1]) &&
            hypot(f[0], f[1]) <= 1e-12 * size)
            return true;
        nu[0] = next[0];
        nu[1] = next[1];
        memcpy(at, there, sizeof at);
    }
    return false;
}

static inline void
on_disc(double g, double *x, double *y)
{
    double r = sqrt(*x * *x + *y * *y);

    if (r > g) {
        *x *= g / r;
        *y *= g / r;
    }
}

/* y becomes the nearest tractions on the discs, that carry the load where one is asked for; with `faces`
 * what slips goes radially on to its circle, and the others carry the rest if they can. */
static void
project(const struct rc_discs *d, double *const y[2], bool faces)
{
    double rest[2] = {d->sum[0], d->sum[1]}, nu[2] = {0, 0}, slips[3];
    bool apart = faces;

#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++) {
        double *sum = sums_of(d, j);
        for (size_t k = j * d->nx; k < (j + 1) * d->nx; k++) {
            double r = hypot(y[0][k], y[1][k]);
            if (d->face[k] == STICK)
                sum[2] += d->g[k];
            if (d->face[k] != SLIP || r == 0)
                continue;
            sum[0] += d->g[k] / r * y[0][k];
            sum[1] += d->g[k] / r * y[1][k];
        }
    }
    total(d, 3, slips);
    if (faces && !d->given) {
        rest[0] -= slips[0];
        rest[1] -= slips[1];
        apart = hypot(rest[0], rest[1]) < slips[2] && find_shift(d, y, SLIP, rest, nu);
    }
    if (!apart && !d->given)
        find_shift(d, y, OFF, d->sum, nu);
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++) {
        double r = hypot(y[0][k], y[1][k]);
        if (d->face[k] == SLIP && apart && r > 0) {
            y[0][k] *= d->g[k] / r;
            y[1][k] *= d->g[k] / r;
        } else if (d->face[k] != OFF) {
            y[0][k] += nu[0];
            y[1][k] += nu[1];
            on_disc(d->g[k], &y[0][k], &y[1][k]);
        }
    }
}

/* ---- faces ---- */

/* The load that is carried when all slip against G - delta, G = Tq - w; part 2 to 4: how that grows with
 * delta; 5: sum g |G - delta|, whose gradient it is. */
static void
slides(const struct rc_discs *d, const double delta[2], double out[6])
{
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++) {
        double *sum = sums_of(d, j);
        for (size_t k = j * d->nx; k < (j + 1) * d->nx; k++) {
            double x = delta[0] - (d->u[0][k] - d->w[0][k]);
            double y = delta[1] - (d->u[1][k] - d->w[1][k]), r = sqrt(x * x + y * y);
            if (d->face[k] == OFF || r == 0)
                continue;
            x /= r;
            y /= r;
            sum[0] += d->g[k] * x;
            sum[1] += d->g[k] * y;
            sum[2] += d->g[k] / r * y * y;
            sum[3] += d->g[k] / r * x * x;
            sum[4] -= d->g[k] / r * x * y;
            sum[5] += d->g[k] * r;
        }
    }
    total(d, 6, out);
}

/* delta where no node sticks: the largest S'delta - sum g |G - delta|, by Newton's method. */
static void
delta_of_slip(struct rc_discs *d)
{
    double at[6], size = hypot(d->sum[0], d->sum[1]);

    slides(d, d->delta, at);
    for (int step = 0; step < 100; step++) {
        double f[2] = {d->sum[0] - at[0], d->sum[1] - at[1]}, move[2], next[2], there[6], part = 1;
        double value = d->sum[0] * d->delta[0] + d->sum[1] * d->delta[1] - at[5], slope;

        if (hypot(f[0], f[1]) <= 1e-14 * size)
            return;
        solve(&at[2], f, move);
        slope = move[0] * f[0] + move[1] * f[1];
        for (;; part /= 2) {
            if (!(slope > 0) || part < 1e-9)
                return;
            next[0] = d->delta[0] + part * move[0];
            next[1] = d->delta[1] + part * move[1];
            slides(d, next, there);
            if (d->sum[0] * next[0] + d->sum[1] * next[1] - there[5] >=
                value + 1e-4 * part * slope - 1e-14 * fabs(at[5]))
                break;
        }
        d->delta[0] = next[0];
        d->delta[1] = next[1];
        memcpy(at, there, sizeof at);
    }
}

static void
find_delta(struct rc_discs *d)
{
    double at[3];

    if (d->given)
        return;
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++) {
        double *sum = sums_of(d, j);
        for (size_t k = j * d->nx; k < (j + 1) * d->nx; k++)
            if (d->face[k] != OFF && hypot(d->q[0][k], d->q[1][k]) < d->g[k] * (1 - on_circle)) {
                sum[0] += d->u[0][k] - d->w[0][k];
                sum[1] += d->u[1][k] - d->w[1][k];
                sum[2]++;
            }
    }
    total(d, 3, at);
    if (at[2] == 0) {
        delta_of_slip(d);
        return;
    }
    d->delta[0] = at[0] / at[2];
    d->delta[1] = at[1] / at[2];
}

/* Faces, D, the residual along what is free, B'B. */
static void
find_faces(struct rc_discs *d)
{
    double at[8];

#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++) {
        double *sum = sums_of(d, j);
        for (size_t k = j * d->nx; k < (j + 1) * d->nx; k++) {
            double g = d->g[k], x = d->q[0][k], y = d->q[1][k], size = hypot(x, y), inwards, slip;
            double sx, sy;
            for (int c = 0; c < 2; c++)
                d->r[c][k] = 0;
            d->curve[k] = 0;
            if (d->face[k] == OFF)
                continue;
            sx = d->u[0][k] - d->w[0][k] - d->delta[0];
            sy = d->u[1][k] - d->w[1][k] - d->delta[1];
            slip = hypot(sx, sy);
            inwards = size > 0 ? (sx * x + sy * y) / size : 0;
            if (slip > sum[6])
                sum[6] = slip;
            if (size < g * (1 - on_circle) || inwards > 0) {
                d->face[k] = STICK;
                d->r[0][k] = (float)-sx;
                d->r[1][k] = (float)-sy;
                sum[0]++;
                sum[2]++;
                sum[3]++;
            } else {
                double tx = -y / size, ty = x / size, along = sx * tx + sy * ty;
                d->face[k] = SLIP;
                d->curve[k] = (float)(-inwards / g);
                d->r[0][k] = (float)(-along * tx);
                d->r[1][k] = (float)(-along * ty);
                sum[1]++;
                sum[2] += tx * tx;
                sum[3] += ty * ty;
                sum[4] += tx * ty;
            }
            slip = hypot((double)d->r[0][k], (double)d->r[1][k]);
            if (slip > sum[5])
                sum[5] = slip;
        }
    }
    total(d, 5, at);
    d->stick = (size_t)at[0];
    d->slipping = (size_t)at[1];
    memcpy(d->bb, &at[2], sizeof d->bb);
    d->residual = most(d, 5);
    d->slip = most(d, 6);
}

/* ---- along what is free ---- */

static void
sum_of(const struct rc_discs *d, float *const v[2], double out[2])
{
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++) {
        double *sum = sums_of(d, j);
        for (size_t k = j * d->nx; k < (j + 1) * d->nx; k++) {
            sum[0] += (double)v[0][k];
            sum[1] += (double)v[1][k];
        }
    }
    total(d, 2, out);
}

/* v loses what a shift of all nodes explains of it, B (B'B)^-1 B'v, with B the free part of a shift: v'B is
 * the load of tractions, and of a residual what delta may still be. */
static void
without_shift(const struct rc_discs *d, float *const v[2])
{
    double load[2], mu[2];

    if (d->given)
        return;
    sum_of(d, v, load);
    solve(d->bb, load, mu);
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++) {
        double x = mu[0], y = mu[1];
        rc_free_part(d->face[k], d->q[0][k], d->q[1][k], &x, &y);
        v[0][k] -= (float)x;
        v[1][k] -= (float)y;
    }
}

static double
dot(const struct rc_discs *d, float *const a[2], float *const b[2])
{
    double out;

#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++) {
        double *sum = sums_of(d, j);
        for (size_t k = j * d->nx; k < (j + 1) * d->nx; k++)
            sum[0] += (double)a[0][k] * (double)b[0][k] + (double)a[1][k] * (double)b[1][k];
    }
    total(d, 1, &out);
    return out;
}

/* |z|_1/|q|_1. In 50 problems |z|_1 alone was 1.02 to 1.46 of the error below 1e-2, next to sliding down
 * to 0.9 of it. */
static double
relative(const struct rc_discs *d)
{
    double out[2];

#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++) {
        double *sum = sums_of(d, j);
        for (size_t k = j * d->nx; k < (j + 1) * d->nx; k++) {
            sum[0] += hypot((double)d->z[0][k], (double)d->z[1][k]);
            sum[1] += hypot(d->q[0][k], d->q[1][k]);
        }
    }
    total(d, 2, out);
    return out[0] == 0 ? 0 : safety * out[0] / out[1];
}

/* ---- steps ---- */

/* z = M r, of the load 0 */
static void
precondition(struct rc_discs *d)
{
    without_shift(d, d->r);
    rc_extension_apply(d->m, d->r, d->z);
    without_shift(d, d->z);
}

/* Nodes that stick and have left their discs. */
static double
left(const struct rc_discs *d)
{
    double out;

#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++) {
        double *sum = sums_of(d, j);
        for (size_t k = j * d->nx; k < (j + 1) * d->nx; k++)
            sum[0] += d->face[k] == STICK && hypot(d->q[0][k] + (double)d->x[0][k],
                                                   d->q[1][k] + (double)d->x[1][k]) > d->g[k];
    }
    total(d, 1, &out);
    return out;
}

/* x: some steps towards the minimum on the faces. z is M r when it begins. */
static void
conjugate_gradients(struct rc_discs *d)
{
    double last = 0;

    for (int c = 0; c < 2; c++)
        memset(d->x[c], 0, d->n * sizeof *d->x[c]);
    for (int step = 0; step < STEPS; step++) {
        double rz = dot(d, d->r, d->z), beta = step > 0 ? rz / last : 0, curvature, alpha;

        last = rz;
#pragma omp parallel for num_threads(d->threads) schedule(static)
        for (size_t k = 0; k < d->n; k++)
            for (int c = 0; c < 2; c++)
                d->p[c][k] = d->z[c][k] + (step > 0 ? (float)beta * d->p[c][k] : 0);
        rc_tangential_apply_single(d->t, d->p, d->y);
#pragma omp parallel for num_threads(d->threads) schedule(static)
        for (size_t k = 0; k < d->n; k++) {
            double y[2];
            for (int c = 0; c < 2; c++)
                y[c] = (double)(d->y[c][k] + d->curve[k] * d->p[c][k]);
            rc_free_part(d->face[k], d->q[0][k], d->q[1][k], &y[0], &y[1]);
            for (int c = 0; c < 2; c++)
                d->y[c][k] = (float)y[c];
        }
        curvature = dot(d, d->p, d->y);
        if (!(curvature > 0))
            break;
        alpha = rz / curvature;
#pragma omp parallel for num_threads(d->threads) schedule(static)
        for (size_t k = 0; k < d->n; k++)
            for (int c = 0; c < 2; c++) {
                d->x[c][k] += (float)alpha * d->p[c][k];
                d->r[c][k] -= (float)alpha * d->y[c][k];
            }
        d->inner++;
        if (left(d) > many * (double)d->stick)
            break;
        if (step + 1 < STEPS)
            precondition(d);
    }
}

/* h = T (q_new - q), d the difference; the decrease that the energy's quadratic has along it: below 1/2 it
 * rises. Where all is rounding, 1. */
static double
judge(struct rc_discs *d)
{
    double out[3];

#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++)
            d->d[c][k] = d->face[k] == OFF ? 0 : d->d[c][k] - d->q[c][k];
    rc_tangential_apply(d->t, d->d, d->h);
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++) {
        double *sum = sums_of(d, j);
        for (size_t k = j * d->nx; k < (j + 1) * d->nx; k++)
            for (int c = 0; c < 2; c++) {
                double slip = d->u[c][k] - d->w[c][k] - d->delta[c];
                sum[0] -= d->d[c][k] * slip;
                sum[1] += d->d[c][k] * d->h[c][k];
                sum[2] += d->g[k] * fabs(slip);
            }
    }
    total(d, 3, out);
    if (out[1] / 2 - out[0] <= 4 * DBL_EPSILON * out[2] && out[1] <= 16 * DBL_EPSILON * out[2])
        return 1;
    return out[1] > 0 ? out[0] / out[1] : out[0] > 0 ? 1 : 0;
}

/* d: from q along so much of x, and back. */
static double
go(struct rc_discs *d, double part)
{
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++)
            d->d[c][k] = d->q[c][k] + part * (double)d->x[c][k];
    project(d, d->d, true);
    return judge(d);
}

static void
take(struct rc_discs *d)
{
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++) {
            d->q[c][k] += d->d[c][k];
            d->u[c][k] += d->h[c][k];
        }
}

/* A step of the projected gradient. */
static double
fall_back(struct rc_discs *d)
{
    d->fallbacks++;
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++)
            d->d[c][k] = d->q[c][k] - (d->u[c][k] - d->w[c][k] - d->delta[c]) / d->t->norm;
    project(d, d->d, false);
    return judge(d);
}

/* Whether the tractions add up to the load. */
static bool
carries(const struct rc_discs *d)
{
    double out[3];

#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t j = 0; j < d->ny; j++) {
        double *sum = sums_of(d, j);
        for (size_t k = j * d->nx; k < (j + 1) * d->nx; k++) {
            sum[0] += d->q[0][k];
            sum[1] += d->q[1][k];
            sum[2] += d->g[k];
        }
    }
    total(d, 3, out);
    return d->given || hypot(out[0] - d->sum[0], out[1] - d->sum[1]) <= 1e-9 * out[2];
}

/* Of the residual, where a displacement is given; false: rounding. */
static bool
has_mean(const struct rc_discs *d, double mean[2])
{
    sum_of(d, d->r, mean);
    mean[0] /= (double)d->n;
    mean[1] /= (double)d->n;
    return hypot(mean[0], mean[1]) > 1e-6 * d->slip;
}

/* Complete contact that sticks: no traction of a periodic map resists the motion of its mean plane, and
 * tractions grow along it up to the first circle. */
static void
to_first_circle(struct rc_discs *d, const double mean[2])
{
    double size = hypot(mean[0], mean[1]), x = mean[0] / size, y = mean[1] / size, far = INFINITY;

    for (size_t k = 0; k < d->n; k++) {
        double along = d->q[0][k] * x + d->q[1][k] * y, across = d->q[1][k] * x - d->q[0][k] * y;
        far = fmin(far, sqrt(fmax(d->g[k] * d->g[k] - across * across, 0)) - along);
    }
    for (size_t k = 0; k < d->n; k++) {
        d->q[0][k] += far * x;
        d->q[1][k] += far * y;
    }
}

enum rc_status
rc_discs_step(struct rc_discs *d)
{
    double part, mean[2];

    find_delta(d);
    find_faces(d);
    if (!rc_extension_set(d->m, d->face, d->q, d->curve, d->given) && has_mean(d, mean)) {
        d->estimate = 1;
        if (d->steps++ >= d->most)
            return RC_SHORT;
        if (d->slipping == 0)
            to_first_circle(d, mean);
        else if (fall_back(d) > 0.5)
            take(d);
        return RC_MORE;
    }
    precondition(d);
    d->estimate = relative(d);
    if (!(d->estimate > d->tol))
        return carries(d) ? RC_OK : RC_SHORT;
    if (d->steps >= d->most)
        return RC_SHORT;
    d->steps++;
    conjugate_gradients(d);
    part = go(d, 1);
    if (!(part > 0.5))
        part = go(d, fmax(part, 0.1));
    if (part > 0.5 || fall_back(d) > 0.5)
        take(d);
    return RC_MORE;
}

enum rc_status
rc_discs_begin(struct rc_discs *d, struct rc_err *err)
{
    for (size_t k = 0; k < d->n; k++)
        d->face[k] = d->g[k] > 0 ? STICK : OFF;
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++)
            if (d->face[k] == OFF)
                d->q[c][k] = 0;
    project(d, d->q, false);
    rc_tangential_apply(d->t, d->q, d->u);
    d->steps = d->inner = d->fallbacks = 0;
    return rc_extension_measure(d->m, d->face, err);
}

/* ---- room ---- */

/* Maps in pairs, of doubles and of floats. */
static double **
pair_of(struct rc_discs *d, size_t k)
{
    double **const pairs[] = {d->w, d->q, d->u, d->d, d->h};

    return pairs[k];
}

static float **
single_pair_of(struct rc_discs *d, size_t k)
{
    float **const pairs[] = {d->x, d->r, d->z, d->p, d->y};

    return pairs[k];
}
enum {
    PAIRS = 5
};

static bool
allocate(struct rc_discs *d)
{
    for (size_t k = 0; k < PAIRS; k++)
        for (int c = 0; c < 2; c++) {
            double *map = pair_of(d, k)[c] = rc_alloc(d->n, sizeof *map);
            if (map == NULL || (single_pair_of(d, k)[c] = rc_alloc(d->n, sizeof(float))) == NULL)
                return false;
            memset(map, 0, d->n * sizeof *map);
        }
    d->g = rc_alloc(d->n, sizeof *d->g);
    d->curve = rc_alloc(d->n, sizeof *d->curve);
    d->face = rc_alloc(d->n, 1);
    d->partial = rc_alloc(d->ny * SUMS, sizeof *d->partial);
    return d->g != NULL && d->curve != NULL && d->face != NULL && d->partial != NULL;
}

struct rc_discs *
rc_discs_new(struct rc_tangential *t, struct rc_err *err)
{
    struct rc_discs *d = calloc(1, sizeof *d);

    if (d == NULL)
        goto short_of_memory;
    *d = (struct rc_discs){.t = t,
                           .nx = t->shape.nx,
                           .ny = t->shape.ny,
                           .n = t->shape.nx * t->shape.ny,
                           .threads = t->threads,
                           .most = 200};
    if (!allocate(d))
        goto short_of_memory;
    if ((d->m = rc_extension_new(t, err)) != NULL)
        return d;
    rc_discs_free(d);
    return NULL;
short_of_memory:
    rc_err_set(err, "out of memory for the friction of %zu x %zu nodes", t->shape.nx, t->shape.ny);
    rc_discs_free(d);
    return NULL;
}

void
rc_discs_free(struct rc_discs *d)
{
    if (d == NULL)
        return;
    for (size_t k = 0; k < PAIRS; k++)
        for (int c = 0; c < 2; c++) {
            free(pair_of(d, k)[c]);
            free(single_pair_of(d, k)[c]);
        }
    rc_extension_free(d->m);
    free(d->g);
    free(d->curve);
    free(d->face);
    free(d->partial);
    free(d);
}

size_t
rc_discs_memory(const struct rc_shape *shape, enum rc_boundary boundary)
{
    size_t n = shape->nx * shape->ny;

    return n * (2 * PAIRS + 1) * sizeof(double) + n * (2 * PAIRS + 1) * sizeof(float) + n +
           shape->ny * SUMS * sizeof(double) + rc_extension_memory(shape, boundary);
}
