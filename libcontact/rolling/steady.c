/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Semismooth Newton on the faces of the discs, as in discs.c, for the unsymmetric B.
 *
 *  1. Nodes inside their circles stick; nodes on it slip, with D = |s|/g along their tangents, or stick again
 *     if their slip points inwards. P is the projection on the free directions.
 *  2. P (B + D) P x = -P s by GMRES (Saad and Schultz 1986) to a tenth, at most 8 steps.
 *     Preconditioner: 1/(D + b) with b = B of a node on itself; where most nodes stick
 *
 *         sqrt(w) T^-1 (1 - rho S)^-1 sqrt(w) + (1 - w)/(D + b),   w = b/(b + D),   1 where nodes stick.
 *
 *     (1 - rho S)^-1 is a recursion along the rows, from the leading edge to the trailing one.
 *     rho = 1 - 1/run ends its tail behind the contact.
 *  3. Nodes that slip return to their circles along the radius, and the others are cut to their discs.
 *     The whole step is accepted if it lowers the natural residual |q - Pi(q - s/b)|, else a quarter of it,
 *     thrice.
 *  4. If none does, the contact rolls one step in time: a projection of S q, which is never farther from the
 *     solution.
 *
 * If a force is given, v is unknown. Two further right sides give the corrections due to v, and the sum of q
 * determines v.
 */
#include "steady.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    OFF = RC_FACE_OFF,
    STICK = RC_FACE_STICK,
    SLIP = RC_FACE_SLIP,
    STEPS = RC_STEADY_STEPS,
    /* Trials with a quarter of the step before. Half and double change no bit (22 runs of
     * bench/constants.py). */
    SHORTER = 3,
};
/* |x| over the error before the step was 0.6 to 1.5. Half takes 4 % fewer convolutions, with errors up
 * to 20 times as large, and double takes 2 % more (22 runs of bench/constants.py). */
static const double safety = 1.7;
/* The natural residual after the step is 0.3 to 1.7 of its error. It tells that the next step moves a
 * front, as all rows of a roller do at once. Half leaves 2 estimates of 450 random rollers below the
 * error; neither half nor double changes the convolutions by 1 %. */
static const double of_residual = 2;
/* Of the linear iteration. Half takes 10 % more convolutions. Double takes 9 % fewer, with errors up to
 * 73 times as large (22 runs of bench/constants.py). */
static const double inner_tol = 0.1;
/* Part of the nodes that stick; above it T^-1 pays. Half changes no bit; double takes 1 % fewer
 * convolutions, and one run 16 % fewer (22 runs of bench/constants.py). */
static const double few = 0.1;
/* Relative: rounding of a radius. Half and double change no bit (22 runs of bench/constants.py). */
static const double on_circle = 1e-12;

/* ---- rows and sums ---- */

typedef void of_node(struct rc_steady *d, size_t k, const void *with, double *sum);

struct row {
    struct rc_steady *d;
    of_node *of;
    const void *with;
};

static void
sum_row(void *ctx, size_t j, double *sum)
{
    const struct row *r = ctx;
    const size_t nx = r->d->shape.nx;

    for (size_t k = j * nx; k < (j + 1) * nx; k++)
        if (r->d->g[k] > 0)
            r->of(r->d, k, r->with, sum);
}

/* Calls `of` for each node with load, and returns the sums. */
static void
all_nodes(struct rc_steady *d, of_node *of, const void *with, double sum[STEPS + 1])
{
    struct row row = {d, of, with};

    rc_sums_rows(&d->rows, sum_row, &row, sum);
}

/* ---- slip and faces ---- */

static void
find_slip(struct rc_steady *d)
{
    const size_t nx = d->shape.nx;

    rc_tangential_apply(d->t, d->q, d->u);
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++)
            d->s[c][k] =
                (k + 1) % nx == 0 ? 0 : d->u[c][k] - d->u[c][k + 1] + d->rigid[c][k] - d->v[c];
}

/* Sums: |q|, natural residual, both components of q, nodes that stick, nodes that slip. */
static void
look_at(struct rc_steady *d, size_t k, const void *with, double *sum)
{
    const double g = d->g[k], x = d->q[0][k], y = d->q[1][k], size = sqrt(x * x + y * y);
    const double inwards = size > 0 ? (d->s[0][k] * x + d->s[1][k] * y) / size : 0;
    double back[2] = {x - d->s[0][k] / d->self, y - d->s[1][k] / d->self};

    (void)with;
    d->face[k] = size >= g * (1 - on_circle) && inwards <= 0 ? SLIP : STICK;
    d->curve[k] = d->face[k] == SLIP ? (float)(-inwards / g) : 0;
    rc_onto_disc(g, false, &back[0], &back[1]);
    sum[0] += size;
    sum[1] += hypot(x - back[0], y - back[1]);
    sum[2] += x;
    sum[3] += y;
    sum[d->face[k] == SLIP ? 5 : 4]++;
}

static void
look(struct rc_steady *d)
{
    double sum[STEPS + 1], size;

    all_nodes(d, look_at, NULL, sum);
    size = fmax(sum[0], DBL_MIN);
    d->found.size = sum[0];
    d->found.residual = sum[1] / size;
    d->found.sum[0] = sum[2];
    d->found.sum[1] = sum[3];
    d->found.stick = (size_t)sum[4];
    d->found.slipping = (size_t)sum[5];
    if (d->asked.force)
        d->found.residual += hypot(d->asked.sum[0] - sum[2], d->asked.sum[1] - sum[3]) / size;
}

/* ---- the linear iteration ---- */

static inline void
free_part(const unsigned char *face, double *const *q, size_t k, float *const to[2], double x,
          double y)
{
    rc_free_part(face[k], q[0][k], q[1][k], &x, &y);
    to[0][k] = (float)x;
    to[1][k] = (float)y;
}

/* to = P (B + D) P z */
static void
multiply(struct rc_steady *d, float *const z[2], float *const to[2])
{
    for (int c = 0; c < 2; c++)
        for (size_t k = 0; k < d->n; k++)
            d->step.way[c][k] = z[c][k];
    rc_tangential_apply(d->t, d->step.way, d->u);
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        if (d->g[k] > 0)
            free_part(d->face, d->q, k, to, d->u[0][k] - d->u[0][k + 1] + d->curve[k] * z[0][k],
                      d->u[1][k] - d->u[1][k + 1] + d->curve[k] * z[1][k]);
}

/* frame = T^-1 (1 - rho S)^-1 sqrt(w) v */
static void
invert(struct rc_steady *d, float *const v[2])
{
    const size_t nx = d->shape.nx, fx = d->t->frame.x, fy = d->t->frame.y, wide = nx + 2 * fx;
    const float rho = (float)(1 - 1 / fmax(d->run, 2));

    for (int c = 0; c < 2; c++) {
        memset(d->space.frame[c], 0, wide * (d->shape.ny + 2 * fy) * sizeof(float));
        for (size_t j = 0; j < d->shape.ny; j++) {
            float *row = d->space.frame[c] + (j + fy) * wide, last = 0;
            for (size_t i = nx + fx; i-- > 0;) {
                const size_t k = j * nx + i - fx;
                row[i] = last *= rho;
                if (i >= fx && d->g[k] > 0)
                    row[i] = last +=
                        v[c][k] * sqrtf((float)d->self / ((float)d->self + d->curve[k]));
            }
        }
    }
    rc_tangential_inverse(d->t, d->space.frame, d->space.frame);
}

static void
precondition(struct rc_steady *d, float *const v[2], float *const z[2])
{
    const size_t nx = d->shape.nx, wide = nx + 2 * d->t->frame.x;
    const bool whole = (double)d->found.stick > few * (double)(d->found.stick + d->found.slipping);

    if (whole)
        invert(d, v);
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++) {
        const size_t at = (k / nx + d->t->frame.y) * wide + d->t->frame.x + k % nx;
        const double b = d->self + d->curve[k], w = whole ? d->self / b : 0;
        double x[2];

        if (!(d->g[k] > 0))
            continue;
        for (int c = 0; c < 2; c++)
            x[c] = (1 - w) / b * v[c][k] + (whole ? sqrt(w) * d->space.frame[c][at] : 0);
        free_part(d->face, d->q, k, z, x[0], x[1]);
    }
}

/* The products of vector `with` of the basis with those before. */
static void
product(struct rc_steady *d, size_t k, const void *with, double *sum)
{
    const size_t last = *(const size_t *)with;
    const float x = d->space.basis[last][0][k], y = d->space.basis[last][1][k];

    for (size_t m = 0; m < last; m++)
        sum[m] += (double)x * d->space.basis[m][0][k] + (double)y * d->space.basis[m][1][k];
}

struct less {
    size_t last;
    const double *part;
};

/* Makes a vector orthogonal to those before; the sum: its square. */
static void
subtract(struct rc_steady *d, size_t k, const void *with, double *sum)
{
    const struct less *l = with;
    double x[2];

    for (int c = 0; c < 2; c++) {
        x[c] = d->space.basis[l->last][c][k];
        for (size_t m = 0; m < l->last; m++)
            x[c] -= l->part[m] * d->space.basis[m][c][k];
        d->space.basis[l->last][c][k] = (float)x[c];
    }
    sum[0] += x[0] * x[0] + x[1] * x[1];
}

/* Returns the length that vector `last` had after this, and makes it 1. */
static double
orthogonal(struct rc_steady *d, size_t last, double *part)
{
    double sum[STEPS + 1], size;

    if (last > 0)
        all_nodes(d, product, &last, sum);
    memcpy(part, sum, last * sizeof *part);
    all_nodes(d, subtract, &(struct less){last, part}, sum);
    size = sqrt(sum[0]);
    for (size_t k = 0; k < d->n && size > 0; k++)
        for (int c = 0; c < 2; c++)
            d->space.basis[last][c][k] /= (float)size;
    return size;
}

/* The turn (cos, sin) that makes y 0. */
static void
turn(const double cs[2], double *x, double *y)
{
    const double was = *x;

    *x = cs[0] * was + cs[1] * *y;
    *y = cs[0] * *y - cs[1] * was;
}

/* to = (P (B + D) P)^-1 of the right side in basis[0], by GMRES. */
static void
solve(struct rc_steady *d, double *const to[2])
{
    double h[STEPS][STEPS + 2], cs[STEPS][2], rest[STEPS + 1], y[STEPS], first;
    size_t m = 0;

    first = rest[0] = orthogonal(d, 0, h[0]);
    while (m < STEPS && fabs(rest[m]) > inner_tol * first) {
        double size;
        precondition(d, d->space.basis[m], d->space.z[m]);
        multiply(d, d->space.z[m], d->space.basis[m + 1]);
        h[m][m + 1] = orthogonal(d, m + 1, h[m]);
        for (size_t k = 0; k < m; k++)
            turn(cs[k], &h[m][k], &h[m][k + 1]);
        size = hypot(h[m][m], h[m][m + 1]);
        if (!(size > 0))
            break;
        cs[m][0] = h[m][m] / size;
        cs[m][1] = h[m][m + 1] / size;
        turn(cs[m], &h[m][m], &h[m][m + 1]);
        rest[m + 1] = 0;
        turn(cs[m], &rest[m], &rest[m + 1]);
        m++;
    }
    for (size_t k = m; k-- > 0;) {
        y[k] = rest[k];
        for (size_t l = k + 1; l < m; l++)
            y[k] -= h[l][k] * y[l];
        y[k] /= h[k][k];
    }
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++) {
            double x = 0;
            for (size_t l = 0; l < m; l++)
                x += y[l] * d->space.z[l][c][k];
            to[c][k] = x;
        }
}

/* ---- a step ---- */

static void
length_of(struct rc_steady *d, size_t k, const void *with, double *sum)
{
    double *const *x = with;

    (void)d;
    sum[0] += hypot(x[0][k], x[1][k]);
    sum[1] += x[0][k];
    sum[2] += x[1][k];
}

/* The right side in the free directions: -s, or for c < 2 a unit change of v. */
static void
right_side(struct rc_steady *d, int c)
{
    for (size_t k = 0; k < d->n; k++)
        if (d->g[k] > 0)
            free_part(d->face, d->q, k, d->space.basis[0], c < 2 ? c == 0 : -d->s[0][k],
                      c < 2 ? c == 1 : -d->s[1][k]);
}

/* The change of v that gives q the asked sum; the way with it. */
static void
find_motion(struct rc_steady *d, double dv[2])
{
    double at[3][STEPS + 1], miss[2], det;

    for (int c = 0; c < 2; c++) {
        right_side(d, c);
        solve(d, d->step.way_of[c]);
        all_nodes(d, length_of, d->step.way_of[c], at[c]);
    }
    right_side(d, 2);
    solve(d, d->step.way);
    all_nodes(d, length_of, d->step.way, at[2]);
    for (int c = 0; c < 2; c++)
        miss[c] = d->asked.sum[c] - d->found.sum[c] - at[2][1 + c];
    det = at[0][1] * at[1][2] - at[1][1] * at[0][2];
    if (!(fabs(det) > 0))
        return;
    dv[0] = (miss[0] * at[1][2] - at[1][1] * miss[1]) / det;
    dv[1] = (at[0][1] * miss[1] - miss[0] * at[0][2]) / det;
    for (int c = 0; c < 2; c++)
        for (size_t k = 0; k < d->n; k++)
            d->step.way[c][k] += dv[0] * d->step.way_of[0][c][k] + dv[1] * d->step.way_of[1][c][k];
}

/* What further steps change over what this one does: c/(1 - c), if each changes c times as much as the one
 * before. The last step may have been better than the next ones: c is the root of its ratio. */
static double
left_over(double change, double before)
{
    /* Half of `least` changes three estimates, double takes 1 % more convolutions; half and double of
     * `worst`, where the changes hardly fall, change no bit (22 runs of bench/constants.py). */
    static const double least = 0.3, worst = 0.95;
    const double c = fmin(sqrt(change / before), worst);

    return before > 0 ? fmax(least, c / (1 - c)) : 1;
}

/* Moves from the old q by a part of the way, and looks. */
static void
take(struct rc_steady *d, double part)
{
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++) {
        for (int c = 0; c < 2; c++)
            d->q[c][k] = d->g[k] > 0 ? d->step.old[c][k] + part * d->step.way[c][k] : 0;
        rc_onto_disc(d->g[k], d->step.was[k] == SLIP, &d->q[0][k], &d->q[1][k]);
    }
    find_slip(d);
    look(d);
}

/* The displacement that a node keeps if it sticks. `before` is that of the surfaces until now, in the
 * map that then moves by some columns. Surface that comes in is free, so that its displacement does not
 * matter. */
static inline double
held(const struct rc_tangential *t, const double *rigid, const double *before, size_t columns,
     size_t k)
{
    const size_t nx = t->shape.nx, i = k % nx + columns;
    const bool round = t->boundary.x;

    return (i < nx || round ? before[k - k % nx + i % nx] : 0) - rigid[k];
}

/* Poses a step in time. */
static enum rc_status
set_out(struct rc_steady *d, double *const before[2], size_t columns, double tol,
        struct rc_err *err)
{
    struct rc_discs *discs = d->discs;

    if (discs == NULL && (discs = d->discs = rc_discs_new(d->t, err)) == NULL)
        return RC_FAIL;
    memcpy(discs->g, d->g, d->n * sizeof *d->g);
    if (!d->asked.force &&
        rc_discs_check_datum(discs, sqrt(d->shape.dx) * sqrt(d->shape.dy), err) != RC_OK)
        return RC_FAIL;
    for (int c = 0; c < 2; c++)
        for (size_t k = 0; k < d->n; k++) {
            discs->q[c][k] = d->q[c][k];
            discs->w[c][k] = held(d->t, d->rigid[c], before[c], columns, k) + d->v[c];
        }
    discs->asked.given = !d->asked.force;
    memcpy(discs->asked.sum, d->asked.sum, sizeof d->asked.sum);
    discs->asked.tol = tol;
    discs->delta[0] = discs->delta[1] = 0;
    rc_discs_begin(discs);
    return RC_OK;
}

enum rc_status
rc_steady_roll(struct rc_steady *d, struct rc_err *err)
{
    rc_tangential_apply(d->t, d->q, d->u);
    if (set_out(d, d->u, 1, fmax(d->found.estimate / 100, d->asked.tol / 10), err) != RC_OK)
        return RC_FAIL;
    while (rc_discs_step(d->discs) == RC_MORE)
        ;
    for (int c = 0; c < 2; c++) {
        memcpy(d->q[c], d->discs->q[c], d->n * sizeof(double));
        d->v[c] += d->asked.force ? d->discs->delta[c] : 0;
    }
    find_slip(d);
    look(d);
    return RC_OK;
}

/* Takes the tractions and the slip of a step in time. */
static void
take_step(struct rc_steady *d)
{
    const struct rc_discs *discs = d->discs;

    for (int c = 0; c < 2; c++) {
        const double delta = discs->delta[c];
        memcpy(d->q[c], discs->q[c], d->n * sizeof(double));
        memcpy(d->u[c], discs->u[c], d->n * sizeof(double));
        for (size_t k = 0; k < d->n; k++)
            d->s[c][k] = discs->u[c][k] - discs->w[c][k] - delta;
        d->v[c] = d->asked.force ? delta : d->v[c];
    }
    look(d);
    memcpy(d->face, discs->face, d->n);
    d->found.stick = discs->found.stick;
    d->found.slipping = discs->found.slipping;
    d->found.steps = discs->found.steps;
    d->found.fallbacks = discs->found.fallbacks;
    d->found.estimate = discs->found.estimate;
}

enum rc_status
rc_steady_set_out(struct rc_steady *d, size_t columns, struct rc_err *err)
{
    for (int c = 0; c < 2 && d->asked.force; c++)
        d->v[c] = 0;
    d->path.moved = columns;
    if (set_out(d, d->step.old, columns, d->asked.tol, err) != RC_OK)
        return RC_FAIL;
    d->discs->asked.most = d->asked.most;
    take_step(d);
    d->found.estimate = INFINITY;
    return RC_OK;
}

void
rc_steady_reach(struct rc_steady *d, size_t columns)
{
    const size_t stick = d->found.stick, slipping = d->found.slipping;

    d->path.moved = columns;
    memcpy(d->step.was, d->face, d->n);
    for (int c = 0; c < 2; c++) {
        const double v = d->asked.force ? 0 : d->v[c], delta = d->v[c] - v;
        for (size_t k = 0; k < d->n; k++)
            d->s[c][k] =
                d->u[c][k] - (held(d->t, d->rigid[c], d->step.old[c], columns, k) + v) - delta;
    }
    look(d);
    memcpy(d->face, d->step.was, d->n);
    d->found.stick = stick;
    d->found.slipping = slipping;
}

enum rc_status
rc_steady_follow(struct rc_steady *d)
{
    const enum rc_status status = rc_discs_step(d->discs);

    take_step(d);
    return status;
}

void
rc_steady_arrive(struct rc_steady *d)
{
    for (int c = 0; c < 2; c++) {
        memcpy(d->path.last[c], d->q[c], d->n * sizeof(double));
        for (size_t k = 0; k < d->n; k++)
            d->step.old[c][k] = d->u[c][k] + d->step.way[c][k];
    }
}

/* The traction, before the step, of the surface that is at node k now. */
static double
before_step(const struct rc_steady *d, int c, size_t k)
{
    const size_t nx = d->shape.nx, i = k % nx + d->path.moved;

    if (!d->asked.path)
        return d->q[c][k + 1];
    return i < nx || d->t->boundary.x ? d->path.last[c][k - k % nx + i % nx] : 0;
}

/* The mean traction of the step times its slip. */
static double
spent(const struct rc_steady *d, size_t k)
{
    double sum = 0;

    for (int c = 0; c < 2; c++)
        sum -= (d->q[c][k] + before_step(d, c, k)) / 2 * d->s[c][k];
    return sum;
}

double
rc_steady_dissipated(const struct rc_steady *d, size_t k, bool all)
{
    const bool on = d->g[k] > 0, own = on ? all || d->face[k] != STICK : d->asked.path;
    const bool leaves = on && !d->asked.path && k % d->shape.nx > 0 && !(d->g[k - 1] > 0);
    const double sum = (own ? spent(d, k) : 0) + (leaves ? spent(d, k - 1) : 0);

    return all ? sum : fmax(sum, 0);
}

void
rc_steady_guess(struct rc_steady *d)
{
    for (size_t k = 0; k < d->n; k++) {
        const double x = d->v[0] - d->rigid[0][k], y = d->v[1] - d->rigid[1][k], r = hypot(x, y);
        const double part = r > 0 && !d->asked.force ? fmin(d->g[k] / (2 * r), 1) : 0;

        d->q[0][k] = part * x;
        d->q[1][k] = part * y;
    }
}

static void
prepare(struct rc_steady *d, bool again)
{
    size_t loaded = 0, runs = 0;

    for (size_t k = 0; k < d->n; k++) {
        const bool on = d->g[k] > 0;
        d->face[k] = on ? STICK : OFF;
        loaded += on;
        runs += on && !(d->g[k + 1] > 0);
        for (int c = 0; c < 2 && !on; c++) {
            d->q[c][k] = 0;
            for (size_t m = 0; m <= STEPS; m++)
                d->space.basis[m][c][k] = 0;
            for (size_t m = 0; m < STEPS; m++)
                d->space.z[m][c][k] = 0;
        }
        if (!again)
            rc_onto_disc(d->g[k], false, &d->q[0][k], &d->q[1][k]);
    }
    d->run = runs > 0 ? (double)loaded / (double)runs : 0;
    find_slip(d);
    look(d);
}

void
rc_steady_begin(struct rc_steady *d)
{
    d->found.steps = d->found.fallbacks = 0;
    d->found.estimate = INFINITY;
    d->found.change = 0;
    prepare(d, false);
}

void
rc_steady_begin_again(struct rc_steady *d)
{
    prepare(d, true);
}

enum rc_status
rc_steady_step(struct rc_steady *d, struct rc_err *err)
{
    const double before = d->found.residual, v[2] = {d->v[0], d->v[1]};
    double dv[2] = {0, 0}, part = 1, sum[STEPS + 1];

    if (before == 0)
        d->found.estimate = 0;
    if (isnan(before)) { /* a number is too large */
        d->found.estimate = INFINITY;
        return RC_SHORT;
    }
    if (d->found.estimate <= d->asked.tol)
        return RC_OK;
    if (d->found.steps >= d->asked.most)
        return RC_SHORT;
    d->found.steps++;
    if (d->asked.force) {
        find_motion(d, dv);
    } else {
        right_side(d, 2);
        solve(d, d->step.way);
    }
    all_nodes(d, length_of, d->step.way, sum);
    for (int c = 0; c < 2; c++)
        memcpy(d->step.old[c], d->q[c], d->n * sizeof(double));
    memcpy(d->step.was, d->face, d->n);
    for (int trial = 0; trial <= SHORTER; trial++, part /= 4) {
        for (int c = 0; c < 2; c++)
            d->v[c] = v[c] + part * dv[c];
        take(d, part);
        if (d->found.residual < before)
            break;
    }
    if (!(d->found.residual < before)) {
        memcpy(d->v, v, sizeof v);
        for (int c = 0; c < 2; c++)
            memcpy(d->q[c], d->step.old[c], d->n * sizeof(double));
        d->found.fallbacks++;
        if (rc_steady_roll(d, err) != RC_OK)
            return RC_FAIL;
    }
    d->found.estimate =
        fmax(safety * left_over(sum[0], d->found.change) * sum[0] / fmax(d->found.size, DBL_MIN),
             of_residual * d->found.residual);
    d->found.change = sum[0];
    return d->found.estimate <= d->asked.tol ? RC_OK : RC_MORE;
}

/* ---- memory ---- */

/* B of a node on itself: the displacement of a node under its own traction less that of the node behind. */
static double
self_of(const struct rc_tangential *t)
{
    const struct rc_lattice lattice = {t->shape.dx, t->shape.dy, 1, 1};
    double sum = 0;

    for (int c = 0; c < 2; c++) {
        const struct rc_shear_field field = {&t->shear, c == 0 ? RC_SHEAR_XX : RC_SHEAR_YY};
        const struct rc_kernel kernel = rc_shear_kernel(&field);
        double at[2];
        kernel.rows(kernel.of, &lattice, 2, 0, 1, at);
        sum += (at[0] - at[1]) / 2;
    }
    return sum;
}

void
rc_steady_free(struct rc_steady *d)
{
    if (d == NULL)
        return;
    rc_discs_free(d->discs);
    rc_tangential_free(d->t);
    free(d->rows.row);
    rc_store_free(&d->own);
    free(d);
}

static bool
allocate(struct rc_steady *d)
{
    double **const pairs[] = {
        d->q, d->rigid, d->u, d->s, d->step.way, d->step.old, d->step.way_of[0], d->step.way_of[1]};
    const bool path = d->asked.path;
    const size_t count = path             ? 7
                         : d->asked.force ? 8
                                          : 6,
                 vectors = path ? 1 : 3 + 4 * STEPS,
                 grid = path
                            ? 0
                            : (d->shape.nx + 2 * d->t->frame.x) * (d->shape.ny + 2 * d->t->frame.y);
    float *at = rc_store_take(&d->own, vectors * d->n + 2 * grid, sizeof *at);

    d->g = rc_store_zeros(&d->own, (1 + 2 * count) * d->n, sizeof *d->g);
    d->face = rc_store_take(&d->own, 2 * d->n, 1);
    if (rc_sums_new(&d->rows, d->shape.ny, STEPS + 1, 0, d->threads) != RC_OK || d->own.failed)
        return false;
    memset(d->face, OFF, 2 * d->n);
    for (size_t k = 0; k < 2 * count; k++)
        pairs[k / 2][k % 2] = d->g + (1 + k) * d->n;
    if (path) {
        memcpy(d->path.last, d->step.way_of[0], sizeof d->path.last);
        d->step.way_of[0][0] = d->step.way_of[0][1] = NULL;
    }
    d->curve = at;
    d->step.was = d->face + d->n;
    for (size_t c = 0; c < 2 && !path; c++) {
        for (size_t m = 0; m <= STEPS; m++)
            d->space.basis[m][c] = at += d->n;
        for (size_t m = 0; m < STEPS; m++)
            d->space.z[m][c] = at += d->n;
    }
    d->space.frame[0] = path ? NULL : at + d->n;
    d->space.frame[1] = path ? NULL : d->space.frame[0] + grid;
    return true;
}

struct rc_steady *
rc_steady_new(const struct rc_shape *shape, struct rc_boundary boundary,
              const struct rc_shear *shear, bool force, bool path, size_t threads,
              struct rc_err *err)
{
    RC_OWN(rc_steady, d) = calloc(1, sizeof *d);

    if (d == NULL)
        return rc_err_null(err, "out of memory for rolling");
    d->shape = *shape;
    d->n = shape->nx * shape->ny;
    d->asked.force = force;
    d->asked.path = path;
    if ((d->t = rc_tangential_new(shape, boundary, shear, threads, err)) == NULL)
        return NULL;
    d->threads = d->t->threads;
    d->self = self_of(d->t);
    if (!allocate(d))
        return rc_err_null(err, "out of memory for rolling of %zu x %zu nodes", shape->nx,
                           shape->ny);
    return rc_give(&d);
}
