#include "extension.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "distance.h"
#include "libcontact/memory.h"
#include "libcontact/solver/solver.h"

static const double fade = 0.5, surrounded = 3; /* as in solver/preconditioner.c */

/* ---- G ---- */

static void
rows(const void *of, const struct rc_lattice *at, size_t n, size_t first, size_t last, double *out)
{
    (void)of;
    for (size_t j = first; j < last; j++)
        for (size_t i = 0; i < n; i++) {
            double x = (double)(i * at->sx) * at->dx, y = (double)(j * at->sy) * at->dy;
            double r2 = x * x + y * y;
            *out++ = r2 > 0 ? 1 / (r2 * sqrt(sqrt(r2))) : 0;
        }
}

static const struct rc_kernel spread = {.rows = rows};

/* ---- plan ---- */

void
rc_extension_free(struct rc_extension *e)
{
    if (e == NULL)
        return;
    rc_spectrum_free(e->spread);
    free(e->close);
    free(e->known);
    free(e->tie);
    for (int k = 0; k < 3; k++)
        free(e->n[k]);
    for (int k = 0; k < 2; k++)
        free(e->v[k]);
    free(e);
}

struct rc_extension *
rc_extension_new(struct rc_tangential *t, struct rc_err *err)
{
    struct rc_extension *e = calloc(1, sizeof *e);
    size_t n = t->shape.nx * t->shape.ny;
    bool room = e != NULL;

    if (room) {
        float **maps[] = {&e->close, &e->known, &e->tie,  &e->n[0],
                          &e->n[1],  &e->n[2],  &e->v[0], &e->v[1]};
        for (size_t k = 0; k < sizeof maps / sizeof *maps; k++)
            room = (*maps[k] = rc_alloc(n, sizeof(float))) != NULL && room;
    }
    if (!room) {
        rc_err_set(err, "out of memory for the friction of %zu nodes", n);
        rc_extension_free(e);
        return NULL;
    }
    e->t = t;
    for (int c = 0; c < 2; c++)
        e->self[c] = (float)t->self[c];
    if ((e->spread = rc_spectrum_new(t->fft_single, err)) != NULL &&
        rc_spectrum_set_values(e->spread, t->fft_single, &spread, err) == RC_OK)
        return e;
    rc_extension_free(e);
    return NULL;
}

size_t
rc_extension_memory(const struct rc_shape *shape, enum rc_boundary boundary)
{
    return 8 * shape->nx * shape->ny * sizeof(float) +
           rc_spectrum_memory(shape, boundary, RC_SINGLE, 1);
}

enum rc_status
rc_extension_measure(struct rc_extension *e, const unsigned char *face, struct rc_err *err)
{
    const struct rc_shape *s = &e->t->shape;
    size_t nx = s->nx, own = rc_distance_scratch(s) + nx;
    float *scratch = rc_alloc((size_t)e->t->threads * own, sizeof *scratch);

    if (scratch == NULL)
        return rc_err_set(err, "out of memory for the distances of %zu x %zu nodes", nx, s->ny);
    rc_distance_columns(s, e->t->boundary, face, e->t->threads, e->close);
#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t j = 0; j < s->ny; j++) {
        float *room = scratch + (size_t)omp_get_thread_num() * own;
        float *d2 = room + rc_distance_scratch(s), *close = e->close + j * nx;
        rc_distance_row(s, e->t->boundary, room, close, d2);
        for (size_t i = 0; i < nx; i++) {
            double d = sqrt((double)d2[i]) - 0.5;
            /* beside a node that carries something lie others */
            close[i] = (float)(1 / sqrt(face[j * nx + i] ? 0.5 : fmax(d, 0.25)));
        }
    }
    free(scratch);
    return RC_OK;
}

/* ---- one map, by G ---- */

struct pass {
    struct rc_extension *e;
    float *const *r;
    int which; /* of both components; of N's */
    const float *from;
    float *to;
};

/* P of a node. */
static inline void
projection(const struct rc_extension *e, size_t k, double p[3])
{
    double x = e->q[0][k], y = e->q[1][k], over;

    p[0] = p[1] = e->face[k] == RC_FACE_OFF ? 0 : 1;
    p[2] = 0;
    if (e->face[k] != RC_FACE_SLIP)
        return;
    over = 1 / (x * x + y * y);
    p[0] = y * y * over;
    p[1] = x * x * over;
    p[2] = -x * y * over;
}

static bool
known_in(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    size_t nx = p->e->t->shape.nx;
    float *to = row;
    bool any = false;

    for (size_t i = 0; i < nx; i++) {
        double of[3];
        size_t k = j * nx + i;
        projection(p->e, k, of);
        to[i] = (float)(of[p->which] * (double)p->e->known[k]);
        any |= p->e->face[k] != RC_FACE_OFF;
    }
    return any;
}

static bool
residual_in(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    size_t nx = p->e->t->shape.nx, at = j * nx;
    const float *known = p->e->known + at, *r = p->from + at;
    float *to = row;

    for (size_t i = 0; i < nx; i++)
        to[i] = known[i] * r[i];
    return true;
}

static bool
row_in(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    size_t nx = p->e->t->shape.nx;

    memcpy(row, p->from + j * nx, nx * sizeof(float));
    return true;
}

static bool
row_out(void *ctx, size_t j, void *row)
{
    const struct pass *p = ctx;
    size_t nx = p->e->t->shape.nx;

    memcpy(p->to + j * nx, row, nx * sizeof(float));
    return true;
}

static void
by_spread(struct rc_extension *e, rc_row *in, struct pass pass)
{
    const struct rc_spectrum *factor[] = {e->spread};
    rc_row *both[] = {in, row_out};

    pass.e = e;
    rc_fft_chain(e->t->fft_single, 1, factor, both, &pass);
    e->t->convolutions += 0.5;
}

/* ---- the set ---- */

static double
self(const struct rc_extension *e, size_t k)
{
    double p[3];

    projection(e, k, p);
    return (p[0] * (double)e->self[0] + p[1] * (double)e->self[1]) / (p[0] + p[1]);
}

void
rc_extension_set(struct rc_extension *e, const unsigned char *face, double *const q[2],
                 const float *curve)
{
    size_t n = e->t->shape.nx * e->t->shape.ny;

    e->face = face;
    e->q = q;
#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t k = 0; k < n; k++) {
        double own, c;
        e->known[k] = face[k] == RC_FACE_OFF ? 0 : 1;
        e->tie[k] = 0;
        if (face[k] != RC_FACE_SLIP)
            continue;
        own = self(e, k);
        c = own / (own + (double)curve[k]);
        e->known[k] = (float)c;
        e->tie[k] = (float)((1 - c) / (own + (double)curve[k])); /* (1 - c)/D = 1/(T0 + D) */
    }
    for (int k = 0; k < 3; k++)
        by_spread(e, known_in, (struct pass){.which = k, .to = e->n[k]});
#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t k = 0; k < n; k++) {
        double a = (double)e->n[0][k], c = (double)e->n[1][k], b = (double)e->n[2][k], det;
        double near = fmax((a + c) / 2, 0), close = (double)e->close[k];
        double part = near / (surrounded * close),
               f = fade * close / (1 + part * part * part * part);
        a = fmax(a, 0) + f;
        c = fmax(c, 0) + f;
        det = a * c - b * b;
        if (!(det > 0)) /* of rounding */
            det = a * c, b = 0;
        e->n[0][k] = (float)(c / det);
        e->n[1][k] = (float)(a / det);
        e->n[2][k] = (float)(-b / det);
    }
}

/* ---- E' A E ---- */

static inline void
by_n(const struct rc_extension *e, size_t k, double x, double y, double out[2])
{
    out[0] = (double)e->n[0][k] * x + (double)e->n[2][k] * y;
    out[1] = (double)e->n[2][k] * x + (double)e->n[1][k] * y;
}

/* v from the sums of what neighbours know; z: what ties tangents to their residuals. */
static void
extend(struct rc_extension *e, float *const r[2], float *const z[2])
{
#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t k = 0; k < e->t->shape.nx * e->t->shape.ny; k++) {
        double v[2], away[2];
        by_n(e, k, (double)e->v[0][k], (double)e->v[1][k], v);
        away[0] = v[0];
        away[1] = v[1];
        rc_free_part(e->face[k], e->q[0][k], e->q[1][k], &away[0], &away[1]);
        for (int c = 0; c < 2; c++) {
            double left = (double)r[c][k] - away[c];
            e->v[c][k] = (float)(v[c] + (double)e->known[k] * left);
            z[c][k] = (float)((double)e->tie[k] * left);
        }
    }
}

/* The transpose, of v = A E r and the ties in z: v becomes what goes back to the neighbours. */
static void
gather(struct rc_extension *e, float *const z[2])
{
#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t k = 0; k < e->t->shape.nx * e->t->shape.ny; k++) {
        double v[2] = {(double)e->v[0][k], (double)e->v[1][k]}, own[2] = {v[0], v[1]};
        double rest[2], known = (double)e->known[k];
        rc_free_part(e->face[k], e->q[0][k], e->q[1][k], &own[0], &own[1]);
        for (int c = 0; c < 2; c++)
            rest[c] = v[c] - known * own[c] - (double)z[c][k];
        for (int c = 0; c < 2; c++)
            z[c][k] += (float)(known * own[c]);
        by_n(e, k, rest[0], rest[1], v);
        e->v[0][k] = (float)v[0];
        e->v[1][k] = (float)v[1];
    }
}

void
rc_extension_apply(struct rc_extension *e, float *const r[2], float *const z[2])
{
    for (int c = 0; c < 2; c++)
        by_spread(e, residual_in, (struct pass){.from = r[c], .to = e->v[c]});
    extend(e, r, z);
    rc_tangential_inverse(e->t, e->v, e->v);
    gather(e, z);
    for (int c = 0; c < 2; c++)
        by_spread(e, row_in, (struct pass){.from = e->v[c], .to = e->v[c]});
#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t k = 0; k < e->t->shape.nx * e->t->shape.ny; k++) {
        double back[2] = {(double)(e->known[k] * e->v[0][k]), (double)(e->known[k] * e->v[1][k])};
        rc_free_part(e->face[k], e->q[0][k], e->q[1][k], &back[0], &back[1]);
        z[0][k] += (float)back[0];
        z[1][k] += (float)back[1];
    }
}
