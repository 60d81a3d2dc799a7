/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Semismooth Newton on the faces of the discs, as in discs.c, for the unsymmetric B.
 *
 *  1. Nodes inside their circles stick; nodes on it slip, with D = |s|/g along their tangents, or stick again
 *     if their slip points inwards. P is the projection on the free directions.
 *  2. P (B + D) P x = -P s by GMRES (Saad and Schultz 1986) to 0.3, at most 5 steps. The preconditioner
 *     inverts 1 - S by a recursion along the rows, from the leading edge to the trailing one:
 *
 *         u_i = r_i + w u_(i+1) + (1 - w) e_(i+1).
 *
 *     w = b/(b + D) at node i + 1, 1 where it sticks and 0 without load, b = B of a node on itself. e is the
 *     displacement ahead, which the pyramid of extension.h extends from u: both are found in turn. Then
 *     z = M u with M, nearly (T + D)^-1, of extension.h. Without e the steps grow with the number of nodes.
 *  3. q + x - (s + B x)/b is projected on the discs, so that a node can stick, slip and turn in one step:
 *     otherwise fronts on rough maps move by one node a step. If this does not lower the natural residual
 *     |q - Pi(q - s/b)|, nodes that slip return from q + x to their circles along the radius, and the others
 *     are cut to their discs; then from a quarter of x, thrice.
 *  4. If none does, the contact rolls one step in time: a projection of S q, which is never farther from the
 *     solution.
 *  5. The first vector of the next step, z of the residual, is nearly the error of q.
 *
 * If a force is given, v is unknown. Vectors of GMRES then have two further numbers, the part of the missing
 * sum of q. The preconditioner adds to z the tractions due to the change of v that gives z its sum. The first
 * step, from q = 0, is longer: by the change of v at which friction that is in proportion to Hertz's pressure
 * carries the force, over that of the linear theory (Vermeulen and Johnson 1964, J. Appl. Mech. 31, 338).
 */
#include "steady.h"

#include <float.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    OFF = RC_FACE_OFF,
    STICK = RC_FACE_STICK,
    SLIP = RC_FACE_SLIP,
    STEPS = RC_STEADY_STEPS,
    PAST = RC_STEADY_PAST,
    SUMS = 6, /* those of `look`, or products with STEPS vectors */
    /* Extensions of the displacement ahead of the rows. Half takes 8 % more convolutions, and double 1 %
     * fewer (24 runs: smooth and rough balls, 64 to 512 nodes a side, to 1e-2 and 1e-4). */
    SWEEPS = 4,
    /* Trials with a quarter of the step before. Half and double change no bit (22 runs of
     * bench/constants.py). */
    SHORTER = 3,
};
/* Factor of the estimate: the tractions that the preconditioner makes of the residual, and the natural
 * residual. Together, with the steps that remain, they are 1.08 to 57 times the error, with medians of 2.4 to
 * 3.1 (3,600 random runs). Half takes 8 % fewer convolutions, double 7 % more (24 runs as above). */
static const double safety = 1.1;
/* Of the linear iteration. Half takes 2 % more convolutions, double 43 % (24 runs as above). */
static const double inner_tol = 0.3;
/* Part of the nodes that may begin or cease to slip before the border is found anew. A third or three
 * times as much takes 3 % more to 3 % fewer convolutions, 0 takes 14 to 19 % more (72 runs with a
 * force: smooth and rough balls, 64 to 512 nodes a side, to 1e-2 and 1e-4). */
static const double few = 0.03;
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
all_nodes(struct rc_steady *d, of_node *of, const void *with, double sum[SUMS])
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
    double sum[SUMS], size;

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

/* to = P ((B + D) z - dv); `normal` keeps the part of B z - dv along q of nodes that slip. */
static void
multiply(struct rc_steady *d, float *const z[2], const double dv[2], float *const to[2],
         float *normal)
{
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++)
            d->step.way[c][k] = z[c][k];
    rc_tangential_apply(d->t, d->step.way, d->u);
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++) {
        double s[2];
        if (!(d->g[k] > 0))
            continue;
        for (int c = 0; c < 2; c++)
            s[c] = d->u[c][k] - d->u[c][k + 1] - dv[c];
        normal[k] =
            d->face[k] != SLIP
                ? 0
                : (float)((s[0] * d->q[0][k] + s[1] * d->q[1][k]) / hypot(d->q[0][k], d->q[1][k]));
        free_part(d->face, d->q, k, to, s[0] + d->curve[k] * z[0][k], s[1] + d->curve[k] * z[1][k]);
    }
}

/* The displacements of the nodes of a row, from the leading edge on: u_i = v_i + w u_(i+1) + (1 - w) e_(i+1),
 * with the part w of the node ahead that is known. Only u along free directions is kept. */
static void
along_row(struct rc_steady *d, size_t j, float *const v[2], const float *const e[2],
          float *const u[2])
{
    const size_t nx = d->shape.nx;
    float last[2] = {0, 0};

    for (size_t i = nx - 1; i-- > 0;) {
        const size_t k = j * nx + i;
        const float w =
            !(d->g[k + 1] > 0) ? 0 : (float)d->self / ((float)d->self + d->curve[k + 1]);
        for (int c = 0; c < 2; c++)
            last[c] = (d->g[k] > 0 ? v[c][k] : 0) + w * last[c] +
                      (1 - w) * (e[c] == NULL ? 0 : e[c][i + 1]);
        if (d->g[k] > 0)
            free_part(d->face, d->q, k, u, (double)last[0], (double)last[1]);
    }
}

/* z = (P (B + D) P)^-1 v, approximately; u: displacements, for the sweeps. */
static void
precondition(struct rc_steady *d, float *const v[2], float *const u[2], float *const z[2])
{
    for (int sweep = 0; sweep <= SWEEPS; sweep++) {
        if (sweep > 0)
            rc_extension_extend(d->m, u);
#pragma omp parallel for num_threads(d->threads) schedule(static)
        for (size_t j = 0; j < d->t->rows.n; j++) {
            const float *e[2] = {NULL, NULL};
            if (sweep > 0)
                rc_extension_row(d->m, j, e);
            along_row(d, j, v, e, u);
        }
    }
    rc_extension_apply(d->m, u, z);
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

/* Returns the length that vector `last` had after this, and makes it 1. The numbers in `motion` belong to the
 * vectors. */
static double
orthogonal(struct rc_steady *d, size_t last, double *part)
{
    double sum[SUMS], size, (*rest)[2] = d->motion.rest;

    memset(sum, 0, sizeof sum);
    if (last > 0)
        all_nodes(d, product, &last, sum);
    for (size_t m = 0; m < last; m++)
        part[m] = sum[m] + rest[last][0] * rest[m][0] + rest[last][1] * rest[m][1];
    all_nodes(d, subtract, &(struct less){last, part}, sum);
    for (size_t m = 0; m < last; m++)
        for (int c = 0; c < 2; c++)
            rest[last][c] -= part[m] * rest[m][c];
    size = sqrt(sum[0] + rest[last][0] * rest[last][0] + rest[last][1] * rest[last][1]);
    if (!(size > 0))
        return 0;
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++)
        for (int c = 0; c < 2; c++)
            d->space.basis[last][c][k] /= (float)size;
    for (int c = 0; c < 2; c++)
        rest[last][c] /= size;
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

static void
length_of(struct rc_steady *d, size_t k, const void *with, double *sum)
{
    float *const *x = with;

    (void)d;
    sum[0] += hypot(x[0][k], x[1][k]);
}

static void
sum_of(struct rc_steady *d, size_t k, const void *with, double *sum)
{
    float *const *x = with;

    (void)d;
    sum[0] += x[0][k];
    sum[1] += x[1][k];
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

/* y = m x for a matrix by rows. */
static void
times(const double m[4], const double x[2], double y[2])
{
    y[0] = m[0] * x[0] + m[1] * x[1];
    y[1] = m[2] * x[0] + m[3] * x[1];
}

/* The border of the linear problem if a force is given: tractions due to a change of v, by the
 * preconditioner, and the change of v that a sum of tractions needs. Where few nodes have begun or ceased to
 * slip, the tractions of an earlier step are taken along the free directions. False: v does not change the
 * sum. */
static bool
find_border(struct rc_steady *d)
{
    double at[2][SUMS], det, *to = d->motion.of_sum;
    const double was = (double)d->motion.slipping, is = (double)d->found.slipping;
    const bool anew =
        d->found.left > inner_tol || fabs(is - was) > few * (is + (double)d->found.stick);

    for (int c = 0; c < 2; c++) {
        float *const *due = d->motion.due[c];
        if (anew) {
            right_side(d, c);
            precondition(d, d->space.basis[0], d->space.basis[1], due);
        }
        for (size_t k = 0; k < d->n && !anew; k++)
            if (d->g[k] > 0)
                free_part(d->face, d->q, k, due, due[0][k], due[1][k]);
        all_nodes(d, sum_of, due, at[c]);
    }
    d->motion.slipping = anew ? d->found.slipping : d->motion.slipping;
    det = at[0][0] * at[1][1] - at[1][0] * at[0][1];
    memset(to, 0, sizeof d->motion.of_sum);
    if (!(fabs(det) > 0))
        return false;
    to[0] = at[1][1] / det;
    to[1] = -at[1][0] / det;
    to[2] = -at[0][1] / det;
    to[3] = at[0][0] / det;
    return true;
}

/* The change of v with which z has the sum that belongs to vector m of the basis; z gets its part. */
static void
balance(struct rc_steady *d, size_t m, float *const z[2], double dv[2])
{
    double sum[SUMS];

    all_nodes(d, sum_of, z, sum);
    times(d->motion.of_sum, sum, dv);
    for (int c = 0; c < 2; c++)
        dv[c] = d->motion.rest[m][c] / d->motion.weight - dv[c];
    for (int c = 0; c < 2; c++)
        for (size_t k = 0; k < d->n; k++)
            if (d->g[k] > 0)
                z[c][k] += (float)(dv[0] * d->motion.due[0][c][k] + dv[1] * d->motion.due[1][c][k]);
}

/* The end of a linear solution with the parts y of m vectors z, h: the products of z by the basis. */
struct linear {
    size_t m;
    double y[STEPS], h[STEPS + 1];
};

/* Turns the basis into the step before the projection, x - (s + B x - dv)/b. At nodes that slip the first
 * number is that along q, where s is -D g, and the second one is along the tangent: rounding of one does not
 * disturb the other. */
static void
find_step(struct rc_steady *d, const struct linear *l)
{
#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++) {
        double x[2] = {0, 0}, to[2] = {0, 0}, normal = 0;
        if (!(d->g[k] > 0)) {
            d->step.way[0][k] = d->step.way[1][k] = 0;
            continue;
        }
        for (int c = 0; c < 2; c++) {
            for (size_t m = 0; m < l->m; m++)
                x[c] += l->y[m] * d->space.z[m][c][k];
            for (size_t m = 0; m <= l->m; m++)
                to[c] += l->h[m] * d->space.basis[m][c][k];
            d->step.way[c][k] = x[c];
        }
        for (size_t m = 0; m < l->m; m++)
            normal += l->y[m] * d->space.normal[m][k];
        for (int c = 0; c < 2; c++)
            to[c] = x[c] - (d->s[c][k] + to[c] - d->curve[k] * x[c]) / d->self;
        if (d->face[k] == SLIP) {
            const double a = d->q[0][k], b = d->q[1][k], r = hypot(a, b);
            to[1] = (to[1] * a - to[0] * b) / r;
            to[0] = (d->curve[k] * d->g[k] - normal) / d->self;
        }
        for (int c = 0; c < 2; c++)
            d->space.basis[0][c][k] = (float)to[c];
    }
}

/* z = M r for vector m of the basis, and the change of v with it. */
static void
next_vector(struct rc_steady *d, size_t m)
{
    precondition(d, d->space.basis[m], d->space.basis[m + 1], d->space.z[m]);
    d->motion.dv[m][0] = d->motion.dv[m][1] = 0;
    if (d->asked.force)
        balance(d, m, d->space.z[m], d->motion.dv[m]);
}

/* The residual, as the first vector of the basis, and its tractions by the preconditioner. Returns their
 * sum. */
static double
find_residual(struct rc_steady *d)
{
    double sum[SUMS];

    rc_extension_set(d->m, d->face, d->q, d->curve, true);
    memset(d->motion.rest, 0, sizeof d->motion.rest);
    if (d->asked.force && (d->motion.kept || find_border(d))) {
        const double miss[2] = {d->asked.sum[0] - d->found.sum[0],
                                d->asked.sum[1] - d->found.sum[1]};
        times(d->motion.of_sum, miss, d->motion.rest[0]);
        for (int c = 0; c < 2; c++)
            d->motion.rest[0][c] *= d->motion.weight;
    }
    d->motion.kept = false;
    right_side(d, 2);
    d->space.first = orthogonal(d, 0, NULL);
    next_vector(d, 0);
    all_nodes(d, length_of, d->space.z[0], sum);
    return d->space.first * sum[0];
}

static double
share(double of, double whole)
{
    return whole > 0 ? of / whole : 0;
}

/* c is the largest part of its residual that the last linear iteration has left, or that one of the last
 * steps has left of `rest`, because nodes begin to slip one after another. If each further step leaves as
 * much, the error is 1/(1 - c) of the first of them. */
static void
estimate(struct rc_steady *d)
{
    double c = d->found.left;

    d->found.rest = find_residual(d) / fmax(d->found.size, DBL_MIN) + d->found.residual;
    for (int k = 0; k < PAST; k++)
        c = fmax(c, share(k > 0 ? d->found.past[k - 1] : d->found.rest, d->found.past[k]));
    d->found.estimate = safety * fmax((1 - inner_tol) / (1 - fmin(c, 0.95)), 1) * d->found.rest;
}

/* The length of the first step if a force is given, over that of the linear theory. */
static double
longer(const struct rc_steady *d)
{
    const double f = hypot(d->asked.sum[0], d->asked.sum[1]) / d->motion.limit;

    return d->asked.force && d->found.size == 0 && f > 0 && f < 1 ? 3 * (1 - cbrt(1 - f)) / f : 1;
}

/* The step x of Newton's method, and the change of v with it, by GMRES. */
static void
solve(struct rc_steady *d, double dv[2])
{
    double h[STEPS][STEPS + 2], made[STEPS][STEPS + 1], cs[STEPS][2], rest[STEPS + 1];
    struct linear l = {0};
    size_t m = 0;

    rest[0] = d->space.first;
    while (m < STEPS && fabs(rest[m]) > inner_tol * d->space.first) {
        double size;
        if (m > 0)
            next_vector(d, m);
        memcpy(d->motion.rest[m + 1], d->motion.rest[m], sizeof d->motion.rest[m]);
        multiply(d, d->space.z[m], d->motion.dv[m], d->space.basis[m + 1], d->space.normal[m]);
        h[m][m + 1] = orthogonal(d, m + 1, h[m]);
        memcpy(made[m], h[m], (m + 2) * sizeof *h[m]);
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
        l.y[k] = rest[k];
        for (size_t i = k + 1; i < m; i++)
            l.y[k] -= h[i][k] * l.y[i];
        l.y[k] /= h[k][k];
    }
    for (size_t k = 0; k < m; k++)
        l.y[k] *= longer(d);
    l.m = m;
    d->found.left = m > 0 ? fabs(rest[m]) / d->space.first : 0;
    dv[0] = dv[1] = 0;
    for (size_t k = 0; k < m; k++) {
        for (size_t i = 0; i <= k + 1; i++)
            l.h[i] += l.y[k] * made[k][i];
        for (int c = 0; c < 2; c++)
            dv[c] += l.y[k] * d->motion.dv[k][c];
    }
    find_step(d, &l);
}

/* ---- a step ---- */

/* Moves from the old q by a part of the way, where nodes that slip return to their circles along the radius,
 * and looks. */
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

/* Projects q + x - (s + B x)/b, after which nodes may stick, slip or turn, and looks. */
static void
take_freely(struct rc_steady *d)
{
    float *const *to = d->space.basis[0];

#pragma omp parallel for num_threads(d->threads) schedule(static)
    for (size_t k = 0; k < d->n; k++) {
        const double x = d->step.old[0][k], y = d->step.old[1][k], r = hypot(x, y);
        const bool slips = d->step.was[k] == SLIP;
        if (!(d->g[k] > 0))
            continue;
        d->q[0][k] = x + (slips ? (to[0][k] * x - to[1][k] * y) / r : to[0][k]);
        d->q[1][k] = y + (slips ? (to[0][k] * y + to[1][k] * x) / r : to[1][k]);
        rc_onto_disc(d->g[k], false, &d->q[0][k], &d->q[1][k]);
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

/* Sums: g, nodes with load. */
static void
add_limits(const void *ctx, double *sum)
{
    const struct rc_steady *d = ctx;

    for (size_t k = 0; k < d->n; k++) {
        sum[0] += d->g[k];
        sum[1] += d->g[k] > 0;
    }
}

static void
prepare(struct rc_steady *d, bool again)
{
    double sum[2] = {0, 0};

    rc_ranks_in_turn(d->t->rows.ranks, add_limits, d, 2, sum);
    d->motion.limit = sum[0];
    d->motion.weight = sqrt(sum[1]);
    d->motion.kept = again;
    d->motion.slipping = again ? d->motion.slipping : SIZE_MAX;
    for (size_t k = 0; k < d->n; k++) {
        const bool on = d->g[k] > 0;
        d->face[k] = on ? STICK : OFF;
        for (int c = 0; c < 2 && !on; c++) {
            d->q[c][k] = 0;
            for (size_t m = 0; m <= STEPS; m++)
                d->space.basis[m][c][k] = 0;
            for (size_t m = 0; m < STEPS; m++)
                d->space.z[m][c][k] = 0;
            for (int m = 0; m < 2 && d->asked.force; m++)
                d->motion.due[m][c][k] = 0;
        }
        if (!again)
            rc_onto_disc(d->g[k], false, &d->q[0][k], &d->q[1][k]);
    }
    find_slip(d);
    look(d);
    estimate(d);
}

void
rc_steady_begin(struct rc_steady *d)
{
    d->found.steps = d->found.fallbacks = 0;
    d->found.left = 0;
    memset(d->found.past, 0, sizeof d->found.past);
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
    double dv[2], part = 1;

    if (isnan(before)) { /* a number is too large */
        d->found.estimate = INFINITY;
        return RC_SHORT;
    }
    if (d->found.estimate <= d->asked.tol)
        return RC_OK;
    if (d->found.steps >= d->asked.most)
        return RC_SHORT;
    d->found.steps++;
    memmove(d->found.past + 1, d->found.past, (PAST - 1) * sizeof(double));
    d->found.past[0] = isfinite(d->found.rest) ? d->found.rest : 0;
    solve(d, dv);
    for (int c = 0; c < 2; c++)
        memcpy(d->step.old[c], d->q[c], d->n * sizeof(double));
    memcpy(d->step.was, d->face, d->n);
    for (int trial = 0; trial <= SHORTER + 1; trial++, part /= trial > 1 ? 4 : 1) {
        for (int c = 0; c < 2; c++)
            d->v[c] = v[c] + part * dv[c];
        if (trial == 0)
            take_freely(d);
        else
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
    estimate(d);
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
    rc_extension_free(d->m);
    rc_tangential_free(d->t);
    free(d->rows.row);
    rc_store_free(&d->own);
    free(d);
}

static bool
allocate(struct rc_steady *d)
{
    double **const pairs[] = {d->q, d->rigid, d->u, d->s, d->step.way, d->step.old, d->path.last};
    const bool path = d->asked.path;
    const size_t count = path ? 7 : 6, due = d->asked.force ? 4 : 0,
                 vectors = path ? 1 : 3 + 5 * STEPS + due;
    float *at = rc_store_take(&d->own, vectors * d->n, sizeof *at);

    d->g = rc_store_zeros(&d->own, (1 + 2 * count) * d->n, sizeof *d->g);
    d->face = rc_store_take(&d->own, 2 * d->n, 1);
    if (rc_sums_new(&d->rows, d->t->rows.ranks, d->t->rows.n, SUMS, 0, d->threads) != RC_OK ||
        d->own.failed)
        return false;
    memset(d->face, OFF, 2 * d->n);
    for (size_t k = 0; k < 2 * count; k++)
        pairs[k / 2][k % 2] = d->g + (1 + k) * d->n;
    d->curve = at;
    d->step.was = d->face + d->n;
    for (size_t c = 0; c < 2 && !path; c++) {
        for (size_t m = 0; m <= STEPS; m++)
            d->space.basis[m][c] = at += d->n;
        for (size_t m = 0; m < STEPS; m++)
            d->space.z[m][c] = at += d->n;
        for (size_t m = 0; m < due / 2; m++)
            d->motion.due[m][c] = at += d->n;
    }
    for (size_t m = 0; m < STEPS && !path; m++)
        d->space.normal[m] = at += d->n;
    return true;
}

struct rc_steady *
rc_steady_new(const struct rc_ranks *ranks, const struct rc_shape *shape,
              struct rc_boundary boundary, const struct rc_shear *shear, bool force, bool path,
              size_t threads, struct rc_err *err)
{
    RC_OWN(rc_steady, d) = calloc(1, sizeof *d);

    if (rc_ranks_need(ranks, d != NULL, err, "out of memory for rolling") != RC_OK)
        return NULL;
    d->shape = *shape;
    d->asked.force = force;
    d->asked.path = path;
    if ((d->t = rc_tangential_new(ranks, shape, boundary, shear, threads, err)) == NULL)
        return NULL;
    d->n = shape->nx * d->t->rows.n;
    d->threads = d->t->threads;
    d->self = self_of(d->t);
    if (!path && (d->m = rc_extension_new(d->t, err)) == NULL)
        return NULL;
    return rc_ranks_need(ranks, allocate(d), err, "out of memory for rolling of %zu x %zu nodes",
                         shape->nx, shape->ny) == RC_OK
               ? rc_give(&d)
               : NULL;
}
