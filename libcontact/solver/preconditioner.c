/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "preconditioner.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"
#include "libcontact/pyramid/pyramid.h"

enum {
    LEVELS = 6 /* most values of D, see preconditioner.h */
};
/* Ratio of two of them, at most, unless that needs more. The wear runs of bench/constants.py have one
 * level. */
static const double apart = 8;
/* Compliance of the bodies for waves of two nodes, in dx/E*: 2/pi = 0.64 for a uniform body. Where rows
 * move by more than this under the load of sqrt(nx) nodes, they are split off, see preconditioner.h.
 * Half and double change the convolutions of 26 runs of wear by at most 3 % (bench/constants.py). */
static const double shortest = 0.6;

struct rc_preconditioner {
    struct rc_operator *op; /* owned by the caller */
    struct rc_pyramid *pyramid;
    float *node; /* minus rc_load_share on W                                       */
    const unsigned char *w;
    int threads;
    size_t above, below; /* rows of the frame that are held here                           */
    float *row;          /* a row of the framed map, for each thread */
    float *
        /* a field on the frame, row by row: all nodes of the row, or those left and right of the map; NULL:
         * no frame */
        frame;
    /* A diagonal that differs by node has `levels` typical values, each `ratio` times the last; else 1.
     * Node k has place[k] among them, 0 to levels - 1; `sum`: of the fields of all levels. NULL: never
     * needed. */
    size_t levels;
    bool used[LEVELS];   /* by a node */
    double first, ratio; /* m/Pa; see d_of */
    float *place, *sum;
    /* Where rows are split off: the residual less its mean on each row, and these means. NULL: not needed. */
    float *flat, *mean;
    struct rc_store own;
};

/* ---- the frame ---- */

static size_t
framed_nx(const struct rc_preconditioner *e)
{
    return e->op->shape.nx + 2 * e->op->frame.x;
}

/* Nodes of the frame before those of row j of the framed map. */
static size_t
frame_before(const struct rc_preconditioner *e, size_t j)
{
    size_t x = e->op->frame.x, y = e->above, ny = e->op->shape.ny, all = framed_nx(e);

    if (j <= y)
        return j * all;
    return j <= y + ny ? y * all + (j - y) * 2 * x : y * all + ny * 2 * x + (j - y - ny) * all;
}

static bool
is_on_map(const struct rc_preconditioner *e, size_t j)
{
    return j >= e->above && j - e->above < e->op->shape.ny;
}

/* The part of a framed row that is on the map; *j becomes its row of the map. NULL where it is off the
 * map. */
static float *
on_map(const struct rc_preconditioner *e, size_t *j, void *row)
{
    if (!is_on_map(e, *j))
        return NULL;
    *j -= e->above;
    return (float *)row + e->op->frame.x;
}

/* The field of level 0 is copied, those of others are added. */
static void
put(size_t level, size_t n, const float *row, float *to)
{
    if (level == 0)
        memcpy(to, row, n * sizeof *to);
    for (size_t i = 0; i < n && level > 0; i++)
        to[i] += row[i];
}

static void
keep_frame(struct rc_preconditioner *e, size_t level, size_t j, const float *row)
{
    float *to;
    size_t x = e->op->frame.x, nx = e->op->shape.nx;

    if (e->frame == NULL)
        return;
    to = e->frame + frame_before(e, j);
    if (!is_on_map(e, j)) {
        put(level, nx + 2 * x, row, to);
        return;
    }
    put(level, x, row, to);
    put(level, x, row + x + nx, to + x);
}

/* Factor of the extension in column i of a frame row whose own factor is `of_row`. */
static float
frame_factor(const struct rc_preconditioner *e, size_t i, float of_row)
{
    size_t x = e->op->frame.x;

    return of_row * rc_frame_fade(i, x, e->op->shape.nx, x);
}

static float
frame_row_factor(const struct rc_preconditioner *e, size_t j)
{
    return rc_frame_fade(j, e->above, e->op->shape.ny, e->op->frame.y);
}

static void
fade_frame(const struct rc_preconditioner *e, size_t j, float *row)
{
    size_t x = e->op->frame.x, nx = e->op->shape.nx;
    float of_row = frame_row_factor(e, j);
    bool all = !is_on_map(e, j);

    if (e->frame == NULL)
        return;
    for (size_t i = 0; i < nx + 2 * x; i++)
        if (all || i < x || i >= x + nx)
            row[i] *= frame_factor(e, i, of_row);
}

/* Adds `weight` times the kept frame field, with its decrease, to a row. */
static void
add_frame(const struct rc_preconditioner *e, size_t j, float weight, float *to)
{
    size_t x = e->op->frame.x, nx = e->op->shape.nx;
    float of_row = weight * frame_row_factor(e, j);
    const float *from;

    if (e->frame == NULL)
        return;
    from = e->frame + frame_before(e, j);
    if (!is_on_map(e, j)) {
        for (size_t i = 0; i < nx + 2 * x; i++)
            to[i] += frame_factor(e, i, of_row) * from[i];
        return;
    }
    for (size_t i = 0; i < x; i++) {
        to[i] += frame_factor(e, i, of_row) * from[i];
        to[nx + x + i] += frame_factor(e, nx + x + i, of_row) * from[x + i];
    }
}

/* ---- life ---- */

static double
power(const void *of, double q)
{
    return rc_operator_power(of, q);
}

static enum rc_status
make_room(struct rc_preconditioner *e, struct rc_err *err)
{
    const struct rc_operator *op = e->op;
    size_t frame;

    e->node = rc_store_take(&e->own, op->shape.nx * op->shape.ny, sizeof *e->node);
    e->row = rc_store_take(&e->own, (size_t)e->threads * framed_nx(e), sizeof *e->row);
    frame = frame_before(e, e->above + op->shape.ny + e->below);
    if (frame > 0)
        e->frame = rc_store_take(&e->own, frame, sizeof *e->frame);
    if (!e->own.failed)
        return RC_OK;
    return rc_err_set(err, "out of memory for the error estimate of %zu x %zu nodes", op->shape.nx,
                      op->shape.ny);
}

static bool
splits(const struct rc_preconditioner *e)
{
    return e->op->soft.row * e->op->shape.dx * sqrt((double)e->op->shape.nx) >
           shortest * e->op->unit;
}

static enum rc_status
make_split(struct rc_preconditioner *e, struct rc_err *err)
{
    const size_t ny = e->op->shape.ny;

    if (!splits(e) || e->mean != NULL)
        return RC_OK;
    e->flat = rc_store_take(&e->own, e->op->shape.nx * ny, sizeof *e->flat);
    e->mean = rc_store_take(&e->own, ny, sizeof *e->mean);
    return e->flat != NULL && e->mean != NULL
               ? RC_OK
               : rc_err_set(err, "out of memory for the motion of %zu rows", ny);
}

struct rc_preconditioner *
rc_preconditioner_new(struct rc_operator *op, struct rc_err *err)
{
    RC_OWN(rc_preconditioner, e) = calloc(1, sizeof *e);
    const double unit = sqrt(op->whole.dx) * sqrt(op->whole.dy);
    const struct rc_shape shape = {op->whole.nx, op->whole.ny, op->whole.dx / unit,
                                   op->whole.dy / unit};
    struct rc_pyramid_base base = rc_pyramid_base_of(&shape, op->boundary, op->frame, &op->rows);
    enum rc_status status;

    base.threads = rc_useful_threads(&op->shape, op->threads);
    if (e == NULL) {
        status = rc_err_set(err, "out of memory for the error estimate of %zu x %zu nodes",
                            op->shape.nx, op->shape.ny);
    } else {
        e->op = op;
        e->levels = 1;
        e->used[0] = true;
        e->threads = base.threads;
        e->above = op->shape.ny > 0 && op->rows.first == 0 ? op->frame.y : 0;
        e->below = op->shape.ny > 0 && op->rows.first + op->rows.n == op->rows.ny ? op->frame.y : 0;
        status = make_room(e, err) == RC_OK ? make_split(e, err) : RC_FAIL;
    }
    if (rc_ranks_agree(op->rows.ranks, status, err) != RC_OK ||
        (e->pyramid = rc_pyramid_new(&base, power, op, err)) == NULL)
        return NULL;
    return rc_give(&e);
}

static float
weight_at(float place, size_t level)
{
    return sqrtf(fmaxf(1 - fabsf(place - (float)level), 0));
}

/* D of a level. Nodes below the least D that matters share the first level. */
static double
d_of(const struct rc_preconditioner *e, size_t level)
{
    const double d = e->first * pow(e->ratio, (double)level);

    return d <= RC_LEAST_OWN * e->op->unit ? d / 3 : d;
}

/* The levels of a diagonal that differs by node, and the places of the nodes. */
static enum rc_status
set_levels(struct rc_preconditioner *e, double *weight, struct rc_err *err)
{
    const struct rc_operator *op = e->op;
    const size_t n = op->shape.nx * op->shape.ny;
    const double floor = RC_LEAST_OWN * op->unit;
    double least, most;

    e->levels = 1;
    e->ratio = 1;
    if (op->soft.part == NULL)
        return RC_OK;
    rc_operator_own_range(op, &least, &most);
    e->first = fmax(least, floor);
    if (!(most > e->first))
        return RC_OK;
    e->levels = 1 + (size_t)fmin(ceil(log(most / e->first) / log(apart)), LEVELS - 1);
    e->ratio = pow(most / e->first, 1 / (double)(e->levels - 1));
    if (e->place == NULL)
        e->place = rc_store_take(&e->own, n, sizeof *e->place);
    if (e->sum == NULL)
        e->sum = rc_store_take(&e->own, n, sizeof *e->sum);
    if (e->place == NULL || e->sum == NULL)
        return rc_err_set(err, "out of memory for the compliance of %zu nodes", n);
    for (size_t k = 0; k < n; k++) {
        e->place[k] = (float)(log(fmax(rc_operator_own(op, k), floor) / e->first) / log(e->ratio));
        for (size_t l = 0; l < e->levels; l++)
            weight[l] = fmax(weight[l], (double)weight_at(e->place[k], l));
    }
    return RC_OK;
}

enum rc_status
rc_preconditioner_tune(struct rc_preconditioner *e, struct rc_err *err)
{
    double weight[LEVELS] = {0};
    enum rc_status status = set_levels(e, weight, err);

    if (status == RC_OK)
        status = make_split(e, err);
    if (rc_ranks_agree(e->op->rows.ranks, status, err) != RC_OK)
        return RC_FAIL;
    for (size_t l = 0; l < e->levels; l++)
        e->used[l] = e->levels == 1 || rc_ranks_most(e->op->rows.ranks, weight[l]) > 1e-3;
    if (e->levels == 1 && e->op->soft.part != NULL)
        rc_operator_set_inverse(e->op, d_of(e, 0));
    rc_pyramid_tune(e->pyramid, power, e->op);
    return RC_OK;
}

double
rc_preconditioner_factors(const struct rc_preconditioner *e)
{
    double used = 0;

    for (size_t l = 0; l < e->levels; l++)
        used += e->used[l];
    return used;
}

void
rc_preconditioner_free(struct rc_preconditioner *e)
{
    if (e == NULL)
        return;
    rc_pyramid_free(e->pyramid);
    rc_store_free(&e->own);
    free(e);
}

/* ---- the working set ---- */

/* Numbers on the nodes where w is 1. */
struct field {
    const struct rc_preconditioner *e;
    const unsigned char *w;
    const float *r; /* minus the offset; NULL: 1 */
    float offset;
};

RC_CLONES static void
add_ones(size_t n, float weight, const unsigned char *w, float *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] += w[i] == 1 ? weight : 0;
}

RC_CLONES static void
add_numbers(size_t n, float weight, const unsigned char *w, const float *r, float offset,
            float *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] += w[i] == 1 ? weight * (r[i] - offset) : 0;
}

static void
field_row(const void *of, int c, size_t j, float weight, float *row)
{
    const struct field *f = of;
    size_t n = f->e->op->shape.nx;
    float *to = on_map(f->e, &j, row);

    (void)c;
    if (to == NULL)
        return;
    if (f->r == NULL)
        add_ones(n, weight, f->w + j * n, to);
    else
        add_numbers(n, weight, f->w + j * n, f->r + j * n, f->offset, to);
}

/* The pressure M 1 of a common shift of W is large at nodes with few neighbours on W. It is nearly
 * proportional to the missing part of their surroundings. */
RC_CLONES static void
share(size_t n, const unsigned char *w, const float *part, float *restrict node)
{
    for (size_t i = 0; i < n; i++) {
        float missing = 1 - part[i], least = missing > RC_LEAST_SHARE ? missing : RC_LEAST_SHARE;
        node[i] = w[i] ? -least : 0;
    }
}

void
rc_preconditioner_set(struct rc_preconditioner *e, const unsigned char *w)
{
    const struct field ones = {e, w, NULL, 0};
    size_t nx = e->op->shape.nx, x = e->op->frame.x;

    e->w = w;
    rc_pyramid_set(e->pyramid, field_row, &ones);
#pragma omp parallel for num_threads(e->threads) schedule(static)
    for (size_t j = 0; j < e->op->shape.ny; j++) {
        float *row = e->row + (size_t)omp_get_thread_num() * framed_nx(e);
        rc_pyramid_row(e->pyramid, 0, e->above + j, row);
        share(nx, w + j * nx, row + x, e->node + j * nx);
    }
}

void
rc_preconditioner_spread(struct rc_preconditioner *e, float *z)
{
    size_t n = e->op->shape.nx * e->op->shape.ny;
    float most = 0;

    for (size_t k = 0; k < n; k++)
        z[k] = 1;
    rc_preconditioner_apply(e, z, 0, z, NULL, NULL);
    for (size_t k = 0; k < n; k++)
        most = z[k] > most ? z[k] : most;
    most = (float)rc_ranks_most(e->op->rows.ranks, (double)most);
    for (size_t k = 0; k < n && most > 0; k++)
        if (e->w[k])
            e->node[k] = -fmaxf(z[k] / most, RC_LEAST_SHARE);
}

const float *
rc_preconditioner_nodes(const struct rc_preconditioner *e)
{
    return e->node;
}

/* ---- E ---- */

void
rc_preconditioner_extend(struct rc_preconditioner *e, const unsigned char *w, const float *r,
                         float *out)
{
    const struct field ones = {e, w, NULL, 0}, field = {e, w, r, 0};
    size_t nx = e->op->shape.nx;

    rc_pyramid_set(e->pyramid, field_row, &ones);
    rc_pyramid_extend(e->pyramid, field_row, &field, NULL);
#pragma omp parallel for num_threads(e->threads) schedule(static)
    for (size_t j = 0; j < e->op->shape.ny; j++) {
        float *row = e->row + (size_t)omp_get_thread_num() * framed_nx(e);
        rc_pyramid_row(e->pyramid, 0, e->above + j, row);
        memcpy(out + j * nx, row + e->op->frame.x, nx * sizeof *out);
    }
}

/* ---- E' A E ---- */

struct correction {
    struct rc_preconditioner *e;
    const float *r;
    float offset, *z;
    size_t level;
};

/* Multiplies row j of the framed map by the weights of the level; the frame has those of the nearest nodes of
 * the map. */
static void
weigh(const struct correction *c, size_t j, float *row)
{
    const struct rc_preconditioner *e = c->e;
    const size_t nx = e->op->shape.nx, ny = e->op->shape.ny, x = e->op->frame.x;
    const size_t of = j < e->above ? 0 : j - e->above < ny ? j - e->above : ny - 1;
    const float *place = e->place + of * nx;

    for (size_t i = 0; i < nx + 2 * x && e->levels > 1; i++) {
        row[i] *= weight_at(place[i < x ? 0 : i - x < nx ? i - x : nx - 1], c->level);
    }
}

RC_CLONES static void
extend(size_t n, const unsigned char *w, const float *r, float offset, float *restrict row)
{
    for (size_t i = 0; i < n; i++)
        row[i] = w[i] ? r[i] - offset : row[i];
}

static bool
extended(void *at, size_t j, void *row)
{
    struct correction *c = at;
    const struct rc_preconditioner *e = c->e;
    const size_t n = e->op->shape.nx, at_row = j;
    float *field;

    rc_pyramid_row(e->pyramid, 0, j, row);
    fade_frame(e, j, row);
    if ((field = on_map(e, &j, row)) != NULL)
        extend(n, e->w + j * n, c->r + j * n, c->offset, field);
    weigh(c, at_row, row);
    return true;
}

static bool
field_out(void *at, size_t j, void *row)
{
    struct correction *c = at;
    size_t n = c->e->op->shape.nx;
    const float *field;

    weigh(c, j, row);
    keep_frame(c->e, c->level, j, row);
    if ((field = on_map(c->e, &j, row)) != NULL)
        put(c->level, n, field, c->z + j * n);
    return true;
}

RC_CLONES static void
add_off(size_t n, float weight, const unsigned char *w, const float *z, float *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] += w[i] ? 0 : weight * z[i];
}

/* The field off W. */
static void
off_row(const void *of, int component, size_t j, float weight, float *row)
{
    const struct correction *c = of;
    size_t n = c->e->op->shape.nx;
    float *to;

    (void)component;
    add_frame(c->e, j, weight, row);
    if ((to = on_map(c->e, &j, row)) != NULL)
        add_off(n, weight, c->e->w + j * n, c->z + j * n, to);
}

RC_CLONES static void
add(size_t n, const unsigned char *w, const float *row, float *restrict z)
{
    for (size_t i = 0; i < n; i++)
        z[i] = w[i] ? z[i] + row[i] : 0;
}

/* Takes the mean over W off `from`, and adds `more` there; returns the mean, and *count nodes. */
static float
level(size_t n, const unsigned char *w, const float *from, float more, float *to, size_t *count)
{
    double sum = 0, in = 0;
    float mean;

    for (size_t i = 0; i < n; i++) {
        sum += w[i] ? (double)from[i] : 0;
        in += w[i] != 0;
    }
    mean = in > 0 ? (float)(sum / in) : 0;
    for (size_t i = 0; i < n; i++)
        to[i] = w[i] ? from[i] - mean + more : 0;
    *count = (size_t)in;
    return mean;
}

/* Row j of z, from the residual without its mean: without its own mean, and with the pressure that moves the
 * row by the mean of the residual. The stiffness of the bodies for such rows lies between that of the
 * shortest waves and that of a wave as long as the row. */
static void
join(const struct rc_preconditioner *e, size_t j, float *z)
{
    const struct rc_operator *op = e->op;
    const size_t n = op->shape.nx;
    size_t count = 0;
    float more = 0;

    for (size_t i = 0; i < n; i++)
        count += e->w[j * n + i] != 0;
    if (count > 0)
        more = e->mean[j] /
               (float)((op->soft.plus + op->soft.row * op->shape.dx * (double)count) / op->unit +
                       shortest * sqrt((double)count));
    (void)level(n, e->w + j * n, z, more, z, &count);
}

void
rc_preconditioner_apply(struct rc_preconditioner *e, const float *r, float offset, float *z,
                        rc_row *done, void *ctx)
{
    const bool split = splits(e);
    struct correction c = {.e = e,
                           .r = split ? e->flat : r,
                           .offset = split ? 0 : offset,
                           .z = e->levels > 1 ? e->sum : z};
    const struct field residual = {e, e->w, c.r, c.offset};
    const struct rc_spectrum *factors[] = {e->op->inverse};
    rc_row *rows[] = {extended, field_out};
    size_t n = e->op->shape.nx, in;

    for (size_t j = 0; j < e->op->shape.ny && split; j++)
        e->mean[j] = level(n, e->w + j * n, r + j * n, 0, e->flat + j * n, &in) - offset;
    rc_pyramid_extend(e->pyramid, field_row, &residual, NULL);
    for (c.level = 0; c.level < e->levels; c.level++) { /* the first one is used */
        if (!e->used[c.level])
            continue;
        if (e->levels > 1)
            rc_operator_set_inverse(e->op, d_of(e, c.level));
        rc_operator_chain_framed(e->op, 1, factors, rows, &c);
    }
    if (e->levels > 1) /* r may be z */
        memcpy(z, e->sum, n * e->op->shape.ny * sizeof *z);
    c.z = z;
    rc_pyramid_gather(e->pyramid, off_row, &c, NULL);
#pragma omp parallel for num_threads(e->threads) schedule(static)
    for (size_t j = 0; j < e->op->shape.ny; j++) {
        float *row = e->row + (size_t)omp_get_thread_num() * framed_nx(e);
        rc_pyramid_row(e->pyramid, 0, e->above + j, row);
        add(n, e->w + j * n, row + e->op->frame.x, z + j * n);
        if (split)
            join(e, j, z + j * n);
        if (done != NULL)
            (void)done(ctx, j, row + e->op->frame.x);
    }
}
