#include "extension.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "distance.h"
#include "libcontact/memory.h"
#include "libcontact/solver/solver.h"

enum {
    SUMS = 4
};
static const double fade = 0.5, surrounded = 3;

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
    free(e->far);
    free(e->partial);
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
    if (room && t->boundary == RC_PERIODIC)
        room = (e->far = rc_alloc(n, sizeof(float))) != NULL &&
               (e->partial = rc_alloc(t->shape.ny * SUMS, sizeof(double))) != NULL;
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
    size_t n = shape->nx * shape->ny, level = n * sizeof(float) + shape->ny * SUMS * sizeof(double);

    return 8 * n * sizeof(float) + (boundary == RC_PERIODIC ? level : 0) +
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

/* ---- fields without a mean ---- */

static inline void
by_n(const struct rc_extension *e, size_t k, double x, double y, double out[2])
{
    out[0] = (double)e->n[0][k] * x + (double)e->n[2][k] * y;
    out[1] = (double)e->n[2][k] * x + (double)e->n[1][k] * y;
}

/* Phi m of a node, and (1 - c P) of that. */
static inline void
far_field(const struct rc_extension *e, size_t k, const double m[2], double phi[2], double rest[2])
{
    double known[2];

    by_n(e, k, (double)e->far[k] * m[0], (double)e->far[k] * m[1], phi);
    known[0] = phi[0];
    known[1] = phi[1];
    rc_free_part(e->face[k], e->q[0][k], e->q[1][k], &known[0], &known[1]);
    for (int c = 0; c < 2; c++)
        rest[c] = phi[c] - (double)e->known[k] * known[c];
}

/* What goes back to the neighbours of a node, of v = A E r and the ties in z. */
static inline void
to_neighbours(const struct rc_extension *e, size_t k, float *const z[2], double rest[2])
{
    double own[2] = {(double)e->v[0][k], (double)e->v[1][k]};

    rc_free_part(e->face[k], e->q[0][k], e->q[1][k], &own[0], &own[1]);
    for (int c = 0; c < 2; c++)
        rest[c] = (double)e->v[c][k] - (double)e->known[k] * own[c] - (double)z[c][k];
}

/* Of a node, to be summed over the map: (1 - c P) Phi, by columns; v; Phi' of what goes back. */
static void
mean_of_far(const struct rc_extension *e, size_t k, float *const z[2], double out[SUMS])
{
    double phi[2];

    (void)z;
    far_field(e, k, (const double[2]){1, 0}, phi, &out[0]);
    far_field(e, k, (const double[2]){0, 1}, phi, &out[2]);
}

static void
mean_of_field(const struct rc_extension *e, size_t k, float *const z[2], double out[SUMS])
{
    (void)z;
    out[0] = (double)e->v[0][k];
    out[1] = (double)e->v[1][k];
}

static void
far_of_rest(const struct rc_extension *e, size_t k, float *const z[2], double out[SUMS])
{
    double rest[2];

    to_neighbours(e, k, z, rest);
    by_n(e, k, (double)e->far[k] * rest[0], (double)e->far[k] * rest[1], out);
}

/* Mean over the map; rows by themselves, in order, so that threads change nothing. */
static void
mean(const struct rc_extension *e,
     void (*of)(const struct rc_extension *e, size_t k, float *const z[2], double out[SUMS]),
     float *const z[2], double out[SUMS])
{
    size_t nx = e->t->shape.nx, ny = e->t->shape.ny;
    struct rc_total all[SUMS] = {{0}};

#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t j = 0; j < ny; j++) {
        double *sum = e->partial + j * SUMS;
        memset(sum, 0, SUMS * sizeof *sum);
        for (size_t k = j * nx; k < (j + 1) * nx; k++) {
            double node[SUMS] = {0};
            of(e, k, z, node);
            for (int c = 0; c < SUMS; c++)
                sum[c] += node[c];
        }
    }
    for (int c = 0; c < SUMS; c++) {
        for (size_t j = 0; j < ny; j++)
            rc_total_add(&all[c], e->partial[j * SUMS + (size_t)c]);
        out[c] = rc_total_value(&all[c]) / (double)(nx * ny);
    }
}

/* B^-1; false: there is none. */
static bool
invert_means(struct rc_extension *e)
{
    static const double singular = 1e-10;
    double b[SUMS], det, size = 0;

    mean(e, mean_of_far, NULL, b);
    det = b[0] * b[3] - b[1] * b[2];
    for (int k = 0; k < SUMS; k++)
        size += b[k] * b[k];
    if (!(fabs(det) > singular * size))
        return false;
    e->b[0] = b[3] / det;
    e->b[1] = -b[2] / det;
    e->b[2] = -b[1] / det;
    e->b[3] = b[0] / det;
    return true;
}

/* Takes the mean of v, and tells it to the ties. */
static void
level(struct rc_extension *e, float *const z[2])
{
    double of[SUMS], m[2];

    mean(e, mean_of_field, NULL, of);
    m[0] = e->b[0] * of[0] + e->b[1] * of[1];
    m[1] = e->b[2] * of[0] + e->b[3] * of[1];
#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t k = 0; k < e->t->shape.nx * e->t->shape.ny; k++) {
        double phi[2], rest[2];
        far_field(e, k, m, phi, rest);
        rc_free_part(e->face[k], e->q[0][k], e->q[1][k], &phi[0], &phi[1]);
        for (int c = 0; c < 2; c++) {
            e->v[c][k] -= (float)rest[c];
            z[c][k] += (float)((double)e->tie[k] * phi[c]);
        }
    }
}

/* The transpose of that. */
static void
level_transposed(struct rc_extension *e, float *const z[2])
{
    double of[SUMS], eta[2];

    mean(e, far_of_rest, z, of);
    eta[0] = e->b[0] * of[0] + e->b[2] * of[1];
    eta[1] = e->b[1] * of[0] + e->b[3] * of[1];
#pragma omp parallel for num_threads(e->t->threads) schedule(static)
    for (size_t k = 0; k < e->t->shape.nx * e->t->shape.ny; k++)
        for (int c = 0; c < 2; c++)
            e->v[c][k] -= (float)eta[c];
}

/* ---- the set ---- */

static double
self(const struct rc_extension *e, size_t k)
{
    double p[3];

    projection(e, k, p);
    return (p[0] * (double)e->self[0] + p[1] * (double)e->self[1]) / (p[0] + p[1]);
}

bool
rc_extension_set(struct rc_extension *e, const unsigned char *face, double *const q[2],
                 const float *curve, bool given)
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
        if (e->far != NULL)
            e->far[k] = (float)f;
    }
    e->level = given && e->far != NULL;
    if (e->level)
        e->level = invert_means(e);
    return e->level || !given || e->far == NULL;
}

/* ---- E' A E ---- */

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
        double v[2] = {(double)e->v[0][k], (double)e->v[1][k]}, own[2] = {v[0], v[1]}, rest[2];
        to_neighbours(e, k, z, rest);
        rc_free_part(e->face[k], e->q[0][k], e->q[1][k], &own[0], &own[1]);
        for (int c = 0; c < 2; c++)
            z[c][k] += (float)((double)e->known[k] * own[c]);
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
    if (e->level)
        level(e, z);
    rc_tangential_inverse(e->t, e->v, e->v);
    if (e->level)
        level_transposed(e, z);
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
