/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "extension.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

#include "libcontact/memory.h"

/* Typical wave number of a grid times its spacing, about that of a wave of four nodes. Half takes 3 %
 * more convolutions, double 1 % (52 runs of bench/constants.py). */
static const double around = 1.5;
/* Factor of T for a single node, on square cells. Half and double take 2 and 3 % more convolutions (52
 * runs of bench/constants.py). */
static const double self_of_wave = 0.84;

/* ---- plan ---- */

static double
power(const void *of, double q)
{
    return rc_tangential_power(of, q);
}

void
rc_extension_free(struct rc_extension *e)
{
    if (e == NULL)
        return;
    rc_pyramid_free(e->pyramid);
    rc_store_free(&e->own);
    free(e);
}

struct rc_extension *
rc_extension_new(struct rc_tangential *t, struct rc_err *err)
{
    RC_OWN(rc_extension, e) = calloc(1, sizeof *e);
    struct rc_pyramid_base base = rc_pyramid_base_of(&t->shape, t->boundary, t->frame, &t->rows);
    size_t n = t->shape.nx * t->rows.n, all = base.shape.nx * base.n;

    base.pairs = true;
    base.threads = t->threads;
    if (e != NULL) {
        e->known = rc_store_take(&e->own, n, sizeof *e->known);
        e->tie = rc_store_take(&e->own, n, sizeof *e->tie);
        for (size_t k = 0; k < 3; k++)
            e->n[k] = rc_store_take(&e->own, n, sizeof *e->n[k]);
        for (size_t c = 0; c < 2; c++)
            e->v[c] = rc_store_take(&e->own, all, sizeof *e->v[c]);
        e->row = rc_store_take(&e->own, 3 * (size_t)t->threads * base.shape.nx, sizeof *e->row);
    }
    if (rc_ranks_need(t->rows.ranks, e != NULL && !e->own.failed, err,
                      "out of memory for the friction of %zu x %zu nodes", t->shape.nx,
                      t->shape.ny) != RC_OK)
        return NULL;
    e->t = t;
    e->first = base.first;
    e->nx = base.shape.nx;
    e->ny = base.n;
    e->self = self_of_wave * rc_tangential_wave(t, around / fmin(t->shape.dx, t->shape.dy));
    e->pyramid = rc_pyramid_new(&base, power, t, err);
    return e->pyramid != NULL ? rc_give(&e) : NULL;
}

/* ---- rows for the pyramid ---- */

struct pass {
    const struct rc_extension *e;
    float *const *r;
};

/* Replaces row *j of the grid by the row of the map; *to: the place of its first node. Returns false if the
 * row is off the map. */
static bool
on_map(const struct rc_extension *e, size_t *j, float **to)
{
    if (*j < e->t->above || *j - e->t->above >= e->t->rows.n)
        return false;
    *j -= e->t->above;
    *to += e->t->frame.x;
    return true;
}

static void
weight_row(const void *of, int c, size_t j, float weight, float *to)
{
    const struct rc_extension *e = of;
    size_t nx = e->t->shape.nx;
    const float *n;

    if (!on_map(e, &j, &to))
        return;
    n = e->n[c] + j * nx;
    for (size_t i = 0; i < nx; i++)
        to[i] += weight * n[i];
}

static void
residual_row(const void *of, int c, size_t j, float weight, float *to)
{
    const struct pass *p = of;
    size_t nx = p->e->t->shape.nx;
    const float *known, *r;

    if (!on_map(p->e, &j, &to))
        return;
    known = p->e->known + j * nx;
    r = p->r[c] + j * nx;
    for (size_t i = 0; i < nx; i++)
        to[i] += weight * known[i] * r[i];
}

static void
field_row(const void *of, int c, size_t j, float weight, float *to)
{
    const struct rc_extension *e = of;
    size_t nx = e->nx;
    const float *v = e->v[c] + j * nx;

    for (size_t i = 0; i < nx; i++)
        to[i] += weight * v[i];
}

static void
no_row(const void *of, int c, size_t j, float weight, float *to)
{
    (void)of, (void)c, (void)j, (void)weight, (void)to;
}

/* Rows of the pyramid with `count` components. */
static float *
rows_of(const struct rc_extension *e, size_t j, int count)
{
    size_t nx = e->nx;
    float *row = e->row + 3 * (size_t)omp_get_thread_num() * nx;

    for (int c = 0; c < count; c++)
        rc_pyramid_row(e->pyramid, c, j, row + (size_t)c * nx);
    return row;
}

/* A place on the grid. */
struct place {
    bool on_map;
    size_t k;    /* index of the node of the map */
    float taper; /* off the map: factor by which fields decrease to 0 at the end of the padding */
};

static struct place
place_of(const struct rc_extension *e, size_t i, size_t j)
{
    const struct rc_frame f = e->t->frame;
    const size_t nx = e->t->shape.nx, above = e->t->above;

    if (i >= f.x && i < f.x + nx && j >= above && j < above + e->t->rows.n)
        return (struct place){true, (j - above) * nx + i - f.x, 1};
    return (struct place){false, 0,
                          rc_frame_fade(i, f.x, nx, f.x) *
                              rc_frame_fade(e->first + j, f.y, e->t->shape.ny, f.y)};
}

/* ---- fields without a mean ---- */

/* The mean of v over a periodic map. */
static void
mean_of_field(const struct rc_extension *e, double out[2])
{
    const double all = (double)e->t->shape.nx * (double)e->t->shape.ny;

    for (int c = 0; c < 2; c++) {
        struct rc_total sum = {0};
        for (size_t k = 0; k < e->nx * e->ny; k++)
            rc_total_add(&sum, (double)e->v[c][k]);
        out[c] = rc_ranks_total(e->t->rows.ranks, sum) / all;
    }
}

/* Computes v = E r (r NULL: 0), with `beyond` for the pyramid; z: the terms that tie tangents to their
 * residuals. */
static void
extend(struct rc_extension *e, float *const r[2], const double beyond[2], float *const z[2])
{
    const struct pass pass = {e, r};
    size_t nx = e->nx;

    rc_pyramid_extend(e->pyramid, r == NULL ? no_row : residual_row, &pass, beyond);
#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t j = 0; j < e->ny; j++) {
        const float *row = rows_of(e, j, 2);
        for (size_t i = 0; i < nx; i++) {
            struct place p = place_of(e, i, j);
            double v[2] = {(double)(p.taper * row[i]), (double)(p.taper * row[nx + i])}, away[2];
            size_t k = p.k;
            for (int c = 0; c < 2; c++)
                e->v[c][j * nx + i] = (float)(away[c] = v[c]);
            if (!p.on_map)
                continue;
            rc_free_part(e->face[k], e->q[0][k], e->q[1][k], &away[0], &away[1]);
            for (int c = 0; c < 2; c++) {
                double left = (r == NULL ? 0 : (double)r[c][k]) - away[c];
                e->v[c][j * nx + i] += (float)((double)e->known[k] * left);
                if (z != NULL)
                    z[c][k] = (float)((double)e->tie[k] * left);
            }
        }
    }
}

/* B^-1; false: B is singular. */
static bool
invert_means(struct rc_extension *e)
{
    /* Relative: rounding of a determinant in double precision. Half and double change no bit (52 runs
     * of bench/constants.py). */
    static const double singular = 1e-10;
    double b[2][2], det, size = 0;

    for (int c = 0; c < 2; c++) {
        double mean[2];
        extend(e, NULL, (const double[2]){c == 0, c == 1}, NULL);
        mean_of_field(e, mean);
        b[0][c] = mean[0];
        b[1][c] = mean[1];
        size += mean[0] * mean[0] + mean[1] * mean[1];
    }
    det = b[0][0] * b[1][1] - b[0][1] * b[1][0];
    if (!(fabs(det) > singular * size))
        return false;
    e->b[0] = b[1][1] / det;
    e->b[1] = -b[0][1] / det;
    e->b[2] = -b[1][0] / det;
    e->b[3] = b[0][0] / det;
    return true;
}

/* ---- the set ---- */

/* Sets n = c P. */
static void
know(struct rc_extension *e, const float *curve)
{
#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t k = 0; k < e->t->shape.nx * e->t->rows.n; k++) {
        double c = e->face[k] == RC_FACE_OFF ? 0 : 1, x = e->q[0][k], y = e->q[1][k], over;
        e->tie[k] = 0;
        e->n[0][k] = e->n[1][k] = (float)c;
        e->n[2][k] = 0;
        if (e->face[k] == RC_FACE_SLIP) {
            c = e->self / (e->self + (double)curve[k]);
            e->tie[k] =
                (float)((1 - c) / (e->self + (double)curve[k])); /* (1 - c)/D = 1/(T0 + D) */
            over = c / (x * x + y * y);
            e->n[0][k] = (float)(y * y * over);
            e->n[1][k] = (float)(x * x * over);
            e->n[2][k] = (float)(-x * y * over);
        }
        e->known[k] = (float)c;
    }
}

/* Sets n = c P (1 - part) P. The tractions of a shift are large where the surroundings are unknown. */
static void
share(struct rc_extension *e)
{
    /* Keeps shares above the rounding of single precision. Half and double change no bit (52 runs of
     * bench/constants.py). */
    static const double least = 1e-3;
    size_t nx = e->t->shape.nx, all = e->nx;

#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t j = 0; j < e->t->rows.n; j++) {
        const float *row = rows_of(e, j + e->t->above, 3) + e->t->frame.x;
        for (size_t i = 0; i < nx; i++) {
            size_t k = j * nx + i;
            double a = 1 - (double)row[i], b = 1 - (double)row[all + i],
                   c = -(double)row[2 * all + i];
            double mean = (a + b) / 2, half = hypot((a - b) / 2, c), low, high, ratio, along, x, y;
            if (e->face[k] == RC_FACE_OFF)
                continue;
            low = fmax(mean - half, least);
            high = fmax(mean + half, least);
            ratio = half > 0 ? (high - low) / (2 * half) : 0;
            a = (high + low) / 2 + ratio * (a - mean);
            b = (high + low) / 2 + ratio * (b - mean);
            c *= ratio;
            if (e->face[k] == RC_FACE_STICK) {
                e->n[0][k] = (float)a;
                e->n[1][k] = (float)b;
                e->n[2][k] = (float)c;
                continue;
            }
            x = e->q[0][k];
            y = e->q[1][k];
            along = (a * y * y - 2 * c * x * y + b * x * x) / (x * x + y * y);
            for (int m = 0; m < 3; m++)
                e->n[m][k] *= (float)along;
        }
    }
}

bool
rc_extension_set(struct rc_extension *e, const unsigned char *face, double *const q[2],
                 const float *curve, bool given)
{
    e->face = face;
    e->q = q;
    know(e, curve);
    rc_pyramid_set(e->pyramid, weight_row, e);
    if (!given)
        share(e);
    e->level = given && !rc_has_mean(e->t->boundary);
    if (!e->level)
        return true;
    return e->level = invert_means(e);
}

void
rc_extension_extend(struct rc_extension *e, float *const r[2])
{
    rc_pyramid_extend(e->pyramid, residual_row, &(struct pass){e, r}, NULL);
}

void
rc_extension_row(const struct rc_extension *e, size_t j, const float *row[2])
{
    const float *first = rows_of(e, j + e->t->above, 2) + e->t->frame.x;

    row[0] = first;
    row[1] = first + e->nx;
}

/* ---- E' A E ---- */

/* Replaces v by the part of E' v that the pyramid passes to neighbours, and adds the rest to z. `first`: the
 * ties are in z; otherwise it shifts by -eta. */
static void
to_neighbours(struct rc_extension *e, bool first, const double eta[2], float *const z[2])
{
    size_t nx = e->nx;

#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t j = 0; j < e->ny; j++)
        for (size_t i = 0; i < nx; i++) {
            struct place p = place_of(e, i, j);
            size_t at = j * nx + i, k = p.k;
            double v[2], own[2];
            for (int c = 0; c < 2; c++)
                own[c] = v[c] = first ? (double)e->v[c][at] : -eta[c];
            if (p.on_map)
                rc_free_part(e->face[k], e->q[0][k], e->q[1][k], &own[0], &own[1]);
            for (int c = 0; c < 2; c++) {
                double known = p.on_map ? (double)e->known[k] * own[c] : 0;
                double rest = (double)p.taper * (v[c] - known);
                e->v[c][at] = (float)(first ? rest - (p.on_map ? (double)z[c][k] : 0)
                                            : (double)e->v[c][at] + rest);
                if (p.on_map)
                    z[c][k] += (float)known;
            }
        }
}

void
rc_extension_apply(struct rc_extension *e, float *const r[2], float *const z[2])
{
    size_t nx = e->t->shape.nx, n = nx * e->t->shape.ny;
    double of[2], m[2], eta[2];

    extend(e, r, NULL, z);
    if (e->level) {
        mean_of_field(e, of);
        m[0] = -(e->b[0] * of[0] + e->b[1] * of[1]);
        m[1] = -(e->b[2] * of[0] + e->b[3] * of[1]);
        extend(e, r, m, z);
    }
    rc_tangential_inverse(e->t, e->v, e->v);
    to_neighbours(e, true, NULL, z);
    rc_pyramid_gather(e->pyramid, field_row, e, of);
    if (e->level) {
        eta[0] = (e->b[0] * of[0] + e->b[2] * of[1]) / (double)n;
        eta[1] = (e->b[1] * of[0] + e->b[3] * of[1]) / (double)n;
        to_neighbours(e, false, eta, z);
        rc_pyramid_gather(e->pyramid, field_row, e, NULL);
    }
#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t j = 0; j < e->t->rows.n; j++) {
        const float *row = rows_of(e, j + e->t->above, 2) + e->t->frame.x;
        for (size_t i = 0; i < nx; i++) {
            size_t k = j * nx + i;
            double back[2] = {(double)row[i], (double)row[e->nx + i]};
            rc_free_part(e->face[k], e->q[0][k], e->q[1][k], &back[0], &back[1]);
            for (int c = 0; c < 2; c++)
                z[c][k] += (float)((double)e->known[k] * back[c]);
        }
    }
}
