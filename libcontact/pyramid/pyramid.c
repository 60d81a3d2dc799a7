/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pyramid.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "libcontact/memory.h"

enum {
    MOST_LEVELS = 64,
    FEW = 16384,       /* nodes of a level; a smaller one is processed by one thread */
    FEW_OF_RANK = 1024 /* nodes of a level per rank; with fewer, ranks no longer share the level */
};

/* ---- one direction ---- */

/* One direction of a grid: n nodes here, `coarse` on the next coarser grid. Coarse node j lies over nodes
 * 2 j and 2 j + 1 or, where this direction is kept, over node j. */
struct axis {
    size_t n, coarse;
    bool halved, round;
};

/* The coarse nodes from which node j is interpolated: 3/4 of the coarse node over it, 1/4 of the neighbour on
 * its other side. */
static void
parents(const struct axis *a, size_t j, size_t *near, size_t *far)
{
    size_t k = j / 2, last = a->coarse - 1;

    *near = k;
    if (j % 2 == 0)
        *far = k > 0 ? k - 1 : a->round ? last : k;
    else
        *far = k < last ? k + 1 : a->round ? 0 : k;
}

/* The nodes that are interpolated from coarse node k, at most 4, and its weight in each. */
static size_t
children(const struct axis *a, size_t k, size_t *at, float *weight)
{
    size_t last = a->coarse - 1, count = 0, near, far;
    size_t candidates[] = {k > 0 ? 2 * k - 1 : 2 * last + 1, 2 * k, 2 * k + 1,
                           k < last ? 2 * k + 2 : 0};

    if (!a->halved) {
        at[0] = k;
        weight[0] = 1;
        return 1;
    }
    for (size_t i = 0; i < 4; i++) {
        size_t j = candidates[i];
        bool again = false;
        for (size_t b = 0; b < i; b++)
            again = again || candidates[b] == j;
        if (j >= a->n || again)
            continue;
        parents(a, j, &near, &far);
        if (near != k && far != k)
            continue;
        at[count] = j;
        weight[count++] = (near == k ? 0.75F : 0) + (far == k ? 0.25F : 0);
    }
    return count;
}

/* out = factor P' of a row. */
RC_CLONES static void
fold_inner(size_t coarse, float factor, const float *restrict row, float *restrict out)
{
    float near = 0.75F * factor, far = 0.25F * factor;

    for (size_t k = 1; k + 1 < coarse; k++)
        out[k] = near * (row[2 * k] + row[2 * k + 1]) + far * (row[2 * k - 1] + row[2 * k + 2]);
}

static void
fold(const struct axis *a, float factor, const float *row, float *out)
{
    if (!a->halved) {
        for (size_t k = 0; k < a->n; k++)
            out[k] = factor * row[k];
        return;
    }
    fold_inner(a->coarse, factor, row, out);
    for (size_t end = 0; end < 2; end++) {
        size_t k = end == 0 ? 0 : a->coarse - 1, at[4], count;
        float weight[4], sum = 0;
        count = children(a, k, at, weight);
        for (size_t i = 0; i < count; i++)
            sum += weight[i] * row[at[i]];
        out[k] = factor * sum;
    }
}

/* out = P of a row. */
RC_CLONES static void
spread_inner(size_t coarse, const float *restrict row, float *restrict out)
{
    for (size_t k = 1; k + 1 < coarse; k++) {
        float near = 0.75F * row[k];
        out[2 * k] = near + 0.25F * row[k - 1];
        out[2 * k + 1] = near + 0.25F * row[k + 1];
    }
}

static void
spread(const struct axis *a, const float *row, float *out)
{
    size_t last = a->coarse - 1, near, far;

    if (!a->halved) {
        memcpy(out, row, a->n * sizeof *out);
        return;
    }
    spread_inner(a->coarse, row, out);
    for (size_t j = 0; j < a->n; j = j == 1 && last > 1 ? 2 * last : j + 1) {
        parents(a, j, &near, &far);
        out[j] = 0.75F * row[near] + 0.25F * row[far];
    }
}

/* ---- levels ---- */

struct level {
    struct axis x, y; /* axes from the finer level to this one */
    float k, t;       /* constants of this level */
    float whole;      /* P' of 1: 4, or 2 where one side is kept  */
    float *weight[3]; /* w; w; for pairs (w + t)^-1, xx yy xy */
    float *most[3];   /* pairs: max(w, 1)^-1 */
    float *value[3];  /* X, then y; and the same of the transpose */
    int threads;
    /* Each rank that shares the finer level computes the rows of this level over its own rows. If this level
     * is shared too, the rank keeps these rows; otherwise all ranks get all rows. */
    bool parts, shared;
    size_t own_first, own; /* computed here */
    size_t first, n;       /* held here     */
    /* Shared level: values of the rows before and after those held here, component by component. */
    float *beside;
};

struct rc_pyramid {
    struct rc_pyramid_base base;
    size_t levels;           /* 1 .. levels; level 0 is the base */
    int weights, components; /* maps of them               */
    struct level level[MOST_LEVELS];
    /* The value of y beyond the coarsest level in the extension; 0 after rc_pyramid_set, because a single
     * node has no surroundings. */
    float beyond[3];
    float *scratch; /* three rows of the base for each thread                                */
    /* where ranks share the base: */
    float *room;   /* rows computed here of the first level that all ranks hold */
    size_t *dealt; /* the first of these rows, for each rank */
    /* rows of a shared level: the first and last one held here, and their neighbours on other ranks */
    float *edge;
    struct rc_store own;
};

/* The grid of a level, from the base to the coarsest one. */
struct grid {
    size_t nx, ny, first, n, unit;
    double spacing[2];
    bool shared;
};

static struct grid
finest(const struct rc_pyramid_base *b)
{
    return (struct grid){.nx = b->shape.nx,
                         .ny = b->shape.ny,
                         .first = b->first,
                         .n = b->n,
                         .unit = b->unit,
                         .spacing = {b->shape.dx, b->shape.dy},
                         .shared = b->count > 1};
}

/* Replaces *g by the next level. Returns false if there is none. A level is no longer shared if a rank would
 * begin with an odd row or hold few nodes. */
static bool
coarser(const struct rc_pyramid_base *b, struct grid *g, struct level *l)
{
    bool x = g->nx > 1 && (g->ny == 1 || g->spacing[0] < 1.5 * g->spacing[1]);
    bool y = g->ny > 1 && (g->nx == 1 || g->spacing[1] < 1.5 * g->spacing[0]);

    if (!x && !y)
        return false;
    *l = (struct level){.x = {g->nx, x ? (g->nx + 1) / 2 : g->nx, x, b->boundary.x},
                        .y = {g->ny, y ? (g->ny + 1) / 2 : g->ny, y, b->boundary.y},
                        .whole = x && y ? 4 : 2,
                        .parts = g->shared};
    g->nx = l->x.coarse;
    g->ny = l->y.coarse;
    g->spacing[0] *= x ? 2 : 1;
    g->spacing[1] *= y ? 2 : 1;
    l->own_first = !l->parts ? 0 : y ? g->first / 2 : g->first;
    l->own = !l->parts ? g->ny : y ? (g->n + 1) / 2 : g->n;
    g->unit = y ? g->unit / 2 : g->unit;
    g->shared = l->parts && g->unit % 2 == 0 && g->nx * g->ny >= FEW_OF_RANK * b->count;
    l->shared = g->shared;
    l->first = g->first = g->shared ? l->own_first : 0;
    l->n = g->n = g->shared ? l->own : g->ny;
    return true;
}

/* Sets k and t of the level: the factor of its sums in the next level, and the weight of the coarser
 * values. */
static void
set_factors(struct level *l, const double spacing[2], rc_power_at *power, const void *of)
{
    double h = !l->x.halved   ? spacing[1]
               : !l->y.halved ? spacing[0]
                              : sqrt(spacing[0] * spacing[1]);
    double a = fmin(fmax(power(of, 1.5 / h), 0), 4), d = l->x.halved && l->y.halved ? 2 : 1;

    l->k = (float)exp2(fmin(a, d) - d);
    l->t = (float)exp2(a < 1 && d == 1 ? 5 - 4 * a : a < 2 ? 3 - 2 * a : 1 - a);
}

/* Nodes held here. */
static size_t
nodes(const struct level *l)
{
    return l->x.coarse * l->n;
}

static size_t
some(size_t n)
{
    return n > 0 ? n : 1; /* a rank without rows */
}

static void
level_new(struct rc_pyramid *p, struct level *l)
{
    l->threads = nodes(l) < FEW ? 1 : p->base.threads;
    for (int c = 0; c < p->weights; c++) {
        l->weight[c] = rc_store_take(&p->own, some(nodes(l)), sizeof(float));
        l->value[c] = rc_store_take(&p->own, some(nodes(l)), sizeof(float));
        if (p->base.pairs)
            l->most[c] = rc_store_take(&p->own, some(nodes(l)), sizeof(float));
    }
    if (l->shared)
        l->beside = rc_store_take(&p->own, 2 * (size_t)p->weights * l->x.coarse, sizeof *l->beside);
    if (!l->parts || l->shared)
        return;
    p->room = rc_store_take(&p->own, some(l->own * l->x.coarse), sizeof *p->room);
    p->dealt = rc_store_take(&p->own, p->base.count + 1, sizeof *p->dealt);
    p->edge = rc_store_take(&p->own, 4 * p->base.shape.nx, sizeof *p->edge);
}

/* Decides which rows of the first unshared level each rank computes. */
static void
deal(struct rc_pyramid *p)
{
    const struct level *l = &p->level[1];

    while (l->shared)
        l++;
    rc_ranks_gather(p->base.ranks, sizeof l->own, &l->own, p->dealt + 1);
    p->dealt[0] = 0;
    for (size_t r = 0; r < p->base.count; r++)
        p->dealt[r + 1] += p->dealt[r];
}

struct rc_pyramid_base
rc_pyramid_base_of(const struct rc_shape *shape, struct rc_boundary boundary, struct rc_frame frame,
                   const struct rc_rows *rows)
{
    size_t before = rows->first > 0 ? frame.y : 0; /* a rank without rows is the last one */
    size_t above = rows->n > 0 && rows->first == 0 ? frame.y : 0;
    size_t below = rows->n > 0 && rows->first + rows->n == rows->ny ? frame.y : 0;
    size_t both = rc_rows_unit(shape->nx) | frame.y;

    return (struct rc_pyramid_base){
        .shape = {shape->nx + 2 * frame.x, shape->ny + 2 * frame.y, shape->dx, shape->dy},
        .first = rows->first + before,
        .n = above + rows->n + below,
        .unit = both & (~both + 1), /* the largest power of 2 in both */
        .count = rc_ranks_count(rows->ranks),
        .boundary = boundary,
        .ranks = rows->ranks};
}

struct rc_pyramid *
rc_pyramid_new(const struct rc_pyramid_base *base, rc_power_at *power, const void *of,
               struct rc_err *err)
{
    RC_OWN(rc_pyramid, p) = calloc(1, sizeof *p);
    struct grid g = finest(base);
    bool fine = p != NULL;

    if (fine) {
        p->base = *base;
        p->weights = base->pairs ? 3 : 1;
        p->components = base->pairs ? 2 : 1;
        p->scratch = rc_store_take(&p->own, 3 * (size_t)base->threads * g.nx, sizeof *p->scratch);
        for (struct level *l; coarser(base, &g, l = &p->level[p->levels + 1]); p->levels++)
            level_new(p, l);
        fine = !p->own.failed;
    }
    if (rc_ranks_need(base->ranks, fine, err,
                      "out of memory for the error estimate of %zu x %zu nodes", base->shape.nx,
                      base->shape.ny) != RC_OK)
        return NULL;
    if (p->dealt != NULL)
        deal(p);
    rc_pyramid_tune(p, power, of);
    return rc_give(&p);
}

void
rc_pyramid_tune(struct rc_pyramid *p, rc_power_at *power, const void *of)
{
    struct grid g = finest(&p->base);
    struct level same;

    for (size_t m = 1; coarser(&p->base, &g, &same); m++)
        set_factors(&p->level[m], g.spacing, power, of);
}

void
rc_pyramid_free(struct rc_pyramid *p)
{
    if (p == NULL)
        return;
    rc_store_free(&p->own);
    free(p);
}

static float *
scratch(const struct rc_pyramid *p)
{
    return p->scratch + (size_t)omp_get_thread_num() * 3 * p->base.shape.nx;
}

/* ---- from a level to the next ---- */

/* The rows of a level that are held here, and the rows before and after them. */
struct source {
    const struct rc_pyramid *p;
    size_t nx, ny, first, n;
    rc_pyramid_add *add;
    const void *of;
    int c;
};

static void
add_row(const struct source *s, size_t j, float weight, float *to)
{
    const float *row;

    if (j >= s->first && j < s->first + s->n) {
        s->add(s->of, s->c, j - s->first, weight, to);
        return;
    }
    row = s->p->edge + (j == (s->first + s->n) % s->ny ? 3 : 2) * s->nx;
    for (size_t i = 0; i < s->nx; i++)
        to[i] += weight * row[i];
}

static void
fetch_beside(const struct source *s)
{
    const struct rc_pyramid_base *b = &s->p->base;
    const struct rc_rows rows = {b->ranks, s->ny, s->first, s->n};
    size_t nx = s->nx;
    float *v = s->p->edge;
    bool has[2];

    memset(v, 0, 4 * nx * sizeof *v);
    if (s->n > 0) {
        s->add(s->of, s->c, 0, 1, v);
        s->add(s->of, s->c, s->n - 1, 1, v + nx);
    }
    rc_ranks_beside(&rows, b->boundary.y, nx * sizeof *v, v, v + nx, v + 2 * nx, v + 3 * nx, has);
}

/* Sets `to`, on level m, to `factor` P' of component c of the rows of level m - 1. */
static void
pull(struct rc_pyramid *p, size_t m, rc_pyramid_add *add, const void *of, int c, float factor,
     float *to)
{
    const struct level *l = &p->level[m], *before = l - 1;
    const struct source s = {.p = p,
                             .nx = l->x.n,
                             .ny = l->y.n,
                             .first = m == 1 ? p->base.first : before->first,
                             .n = m == 1 ? p->base.n : before->n,
                             .add = add,
                             .of = of,
                             .c = c};
    bool gathered = l->parts && !l->shared;
    float *made = gathered ? p->room : to;

    if (l->parts && l->y.halved)
        fetch_beside(&s);
#pragma omp parallel for num_threads(m == 1 ? p->base.threads : l->threads) schedule(static)
    for (size_t k = 0; k < l->own; k++) {
        float weight[4], *sum = scratch(p);
        size_t at[4], count = children(&l->y, l->own_first + k, at, weight);
        memset(sum, 0, s.nx * sizeof *sum);
        for (size_t i = 0; i < count; i++)
            add_row(&s, at[i], weight[i], sum);
        fold(&l->x, factor, sum, made + k * l->x.coarse);
    }
    if (gathered)
        rc_ranks_move(p->base.ranks, l->x.coarse * sizeof *to, p->dealt, NULL, 0, made, to);
}

/* The factor of the values of a level on the way up. */
enum up {
    AS_THEY_ARE,
    AT_MOST_ONE, /* least of a weight and 1: min(w, 1) */
    AT_MOST,     /* c                     */
    COARSER      /* t / (w + t)           */
};

RC_CLONES static void
add_as_they_are(size_t n, float weight, const float *restrict v, float *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] += weight * v[i];
}

RC_CLONES static void
add_at_most_one(size_t n, float weight, const float *restrict w, float *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] += weight * (w[i] < 1 ? w[i] : 1);
}

RC_CLONES static void
add_at_most(size_t n, float weight, const float *restrict v, const float *restrict w,
            float *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] += weight * v[i] / (w[i] > 1 ? w[i] : 1);
}

RC_CLONES static void
add_coarser(size_t n, float weight, float t, const float *restrict v, const float *restrict w,
            float *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] += weight * t * v[i] / (w[i] + t);
}

/* A component of a matrix times a pair. */
RC_CLONES static void
add_times(size_t n, float weight, const float *restrict own, const float *restrict cross,
          const float *restrict v, const float *restrict other, float *restrict to)
{
    for (size_t i = 0; i < n; i++)
        to[i] += weight * (own[i] * v[i] + cross[i] * other[i]);
}

struct rows {
    const struct level *l;
    enum up up;
    bool pairs;
};

static void
add_of_pairs(const struct rows *r, int c, size_t at, float weight, float *to)
{
    const struct level *l = r->l;
    float *const *m = r->up == AT_MOST ? l->most : l->weight;
    size_t n = l->x.coarse;

    if (r->up == AS_THEY_ARE)
        add_as_they_are(n, weight, l->value[c] + at, to);
    else if (r->up == AT_MOST_ONE) /* used by make_weights */
        add_as_they_are(n, weight, l->most[c] + at, to);
    else
        add_times(n, r->up == COARSER ? weight * l->t : weight, m[c] + at, m[2] + at,
                  l->value[c] + at, l->value[1 - c] + at, to);
}

static void
add_of_level(const void *of, int c, size_t j, float weight, float *to)
{
    const struct rows *r = of;
    const struct level *l = r->l;
    size_t n = l->x.coarse;
    const float *v = l->value[0] + j * n, *w = l->weight[0] + j * n;

    if (r->pairs) {
        add_of_pairs(r, c, j * n, weight, to);
        return;
    }
    switch (r->up) {
    case AS_THEY_ARE:
        add_as_they_are(n, weight, v, to);
        break;
    case AT_MOST_ONE:
        add_at_most_one(n, weight, w, to);
        break;
    case AT_MOST:
        add_at_most(n, weight, v, w, to);
        break;
    case COARSER:
        add_coarser(n, weight, l->t, v, w, to);
        break;
    }
}

/* Sets `to`, on the level after `from`, to `factor` P' of `count` maps of values. */
static void
up(struct rc_pyramid *p, size_t from, enum up what, int count, float factor, float *const *to)
{
    const struct rows rows = {&p->level[from], what, p->base.pairs};

    for (int c = 0; c < count; c++)
        pull(p, from + 1, add_of_level, &rows, c, factor, to[c]);
}

static const float *
values(const struct level *l, int c, size_t k)
{
    size_t n = l->x.coarse;

    if (k >= l->first && k < l->first + l->n)
        return l->value[c] + (k - l->first) * n;
    return l->beside + (2 * (size_t)c + (k == (l->first + l->n) % l->y.coarse ? 1 : 0)) * n;
}

/* Row j, of level l - 1, of P of the values of level l. */
static void
row_of(const struct level *l, int c, size_t j, float *sum, float *out)
{
    size_t n = l->x.coarse, near, far;
    const float *a, *b;

    if (!l->y.halved) {
        spread(&l->x, values(l, c, j), out);
        return;
    }
    parents(&l->y, j, &near, &far);
    a = values(l, c, near);
    b = values(l, c, far);
    for (size_t i = 0; i < n; i++)
        sum[i] = 0.75F * a[i] + 0.25F * b[i];
    spread(&l->x, sum, out);
}

enum down {
    SURROUNDINGS, /* v + P v / sqrt(2)         */
    MEANS,        /* y = (X + t P y) / (w + t) */
    SUMS          /* v / (w + t) + c k P v     */
};

RC_CLONES static void
surround_row(size_t n, const float *restrict coarse, float *restrict v)
{
    for (size_t i = 0; i < n; i++)
        v[i] += (float)M_SQRT1_2 * coarse[i];
}

RC_CLONES static void
means_row(size_t n, float t, const float *restrict coarse, const float *restrict w,
          float *restrict v)
{
    for (size_t i = 0; i < n; i++)
        v[i] = (v[i] + t * coarse[i]) / (w[i] + t);
}

RC_CLONES static void
sums_row(size_t n, float t, float k, const float *restrict coarse, const float *restrict w,
         float *restrict v)
{
    for (size_t i = 0; i < n; i++)
        v[i] = v[i] / (w[i] + t) + k * coarse[i] / (w[i] > 1 ? w[i] : 1);
}

/* The same of pairs. */
RC_CLONES static void
mean_pairs(size_t n, float t, float *const coarse[2], const float *restrict xx,
           const float *restrict yy, const float *restrict xy, float *restrict x, float *restrict y)
{
    for (size_t i = 0; i < n; i++) {
        float a = x[i] + t * coarse[0][i], b = y[i] + t * coarse[1][i];
        x[i] = xx[i] * a + xy[i] * b;
        y[i] = xy[i] * a + yy[i] * b;
    }
}

static void
pairs_row(const struct level *l, enum down what, float k, float *const coarse[2], size_t at)
{
    size_t n = l->x.coarse;
    float *x = l->value[0] + at, *y = l->value[1] + at;

    mean_pairs(n, what == MEANS ? l->t : 0, coarse, l->weight[0] + at, l->weight[1] + at,
               l->weight[2] + at, x, y);
    if (what == MEANS)
        return;
    add_times(n, k, l->most[0] + at, l->most[2] + at, coarse[0], coarse[1], x);
    add_times(n, k, l->most[1] + at, l->most[2] + at, coarse[1], coarse[0], y);
}

static void
share_beside(const struct rc_pyramid *p, const struct level *l, int count)
{
    const struct rc_rows rows = {p->base.ranks, l->y.coarse, l->first, l->n};
    size_t n = l->x.coarse;
    bool has[2];

    for (int c = 0; c < count; c++) {
        float *to = l->beside + 2 * (size_t)c * n;
        rc_ranks_beside(&rows, p->base.boundary.y, n * sizeof(float), l->value[c],
                        l->value[c] + (some(l->n) - 1) * n, to, to + n, has);
    }
}

/* A row of a level, from the values of the next level in `coarse`. */
static void
down_row(const struct rc_pyramid *p, const struct level *l, enum down what, size_t j)
{
    const struct level *next = l + 1;
    size_t n = l->x.coarse, at = j * n;
    float *sum = scratch(p), *coarse[2] = {sum + p->base.shape.nx, sum + 2 * p->base.shape.nx};
    bool coarsest = l == &p->level[p->levels];
    float k = coarsest ? 0 : next->k;
    int count = what == SURROUNDINGS ? p->weights : p->components;

    for (int c = 0; c < count; c++) {
        float *row = coarse[what == SURROUNDINGS ? 0 : c];
        if (coarsest)
            for (size_t i = 0; i < n; i++)
                row[i] = what == MEANS ? p->beyond[c] : 0;
        else
            row_of(next, c, l->first + j, sum, row);
        if (what == SURROUNDINGS)
            surround_row(n, row, l->value[c] + at);
    }
    if (what == SURROUNDINGS)
        return;
    if (p->base.pairs)
        pairs_row(l, what, k, coarse, at);
    else if (what == MEANS)
        means_row(n, l->t, coarse[0], l->weight[0] + at, l->value[0] + at);
    else
        sums_row(n, l->t, k, coarse[0], l->weight[0] + at, l->value[0] + at);
}

/* Computes the values of all levels, from the coarsest to the finest, each from the next coarser one. */
static void
down(struct rc_pyramid *p, enum down what)
{
    for (size_t m = p->levels; m > 0; m--) {
        struct level *l = &p->level[m];
#pragma omp parallel for num_threads(l->threads) schedule(static)
        for (size_t j = 0; j < l->n; j++)
            down_row(p, l, what, j);
        if (l->shared)
            share_beside(p, l, what == SURROUNDINGS ? p->weights : p->components);
    }
}

/* ---- the pyramid ---- */

void
rc_pyramid_row(const struct rc_pyramid *p, int c, size_t j, float *row)
{
    if (p->levels > 0)
        row_of(&p->level[1], c, p->base.first + j, scratch(p), row);
    else
        for (size_t i = 0; i < p->base.shape.nx; i++)
            row[i] = p->beyond[c];
}

/* Replaces a symmetric matrix A = (xx, yy, xy) by f(A): the axes stay, an eigenvalue e becomes f(e). */
struct eigen {
    float mean, half; /* mean of both eigenvalues, and half of their difference */
};

static inline struct eigen
eigen_of(const float m[3])
{
    float d = (m[0] - m[1]) / 2;

    return (struct eigen){(m[0] + m[1]) / 2, sqrtf(d * d + m[2] * m[2])};
}

static inline void
of_eigen(const float m[3], struct eigen e, float high, float low, float out[3])
{
    float mean = (high + low) / 2, ratio = e.half > 0 ? (high - low) / (2 * e.half) : 0;

    out[0] = mean + ratio * (m[0] - e.mean);
    out[1] = mean + ratio * (m[1] - e.mean);
    out[2] = ratio * m[2];
}

/* From the matrices w of a level: first min(w, 1), in `most`; then the weights that the level keeps. */
static void
make_weights(struct level *l, bool keep)
{
#pragma omp parallel for num_threads(l->threads) schedule(static)
    for (size_t i = 0; i < nodes(l); i++) {
        float m[3] = {l->weight[0][i], l->weight[1][i], l->weight[2][i]}, most[3], inverse[3];
        struct eigen e = eigen_of(m);
        float high = e.mean + e.half, low = fmaxf(e.mean - e.half, 0), t = l->t;

        if (keep) {
            of_eigen(m, e, 1 / fmaxf(high, 1), 1 / fmaxf(low, 1), most);
            of_eigen(m, e, 1 / (high + t), 1 / (low + t), inverse);
        } else {
            of_eigen(m, e, fminf(high, 1), fminf(low, 1), most);
        }
        for (int c = 0; c < 3; c++) {
            l->most[c][i] = most[c];
            if (keep)
                l->weight[c][i] = inverse[c];
        }
    }
}

void
rc_pyramid_set(struct rc_pyramid *p, rc_pyramid_add *w, const void *of)
{
    struct level *l = &p->level[1];
    int count = p->weights;
    float sum = 0, part = 1, weight;

    memset(p->beyond, 0, sizeof p->beyond);
    if (p->levels == 0)
        return;
    for (size_t m = 1; m <= p->levels; m++, part *= (float)M_SQRT1_2)
        sum += part;
    weight = l->k * l->whole * sum;
    for (int c = 0; c < count; c++) {
        pull(p, 1, w, of, c, 1 / (l->whole * sum), l->value[c]);
#pragma omp parallel for simd num_threads(l->threads) schedule(static)
        for (size_t i = 0; i < nodes(l); i++)
            l->weight[c][i] = weight * l->value[c][i];
    }
    for (size_t m = 1; m <= p->levels; m++) {
        const struct level *next = &p->level[m + 1];
        if (p->base.pairs)
            make_weights(&p->level[m], false);
        if (m < p->levels) {
            up(p, m, AT_MOST_ONE, count, next->k, next->weight);
            up(p, m, AS_THEY_ARE, count, 1 / next->whole, next->value);
        }
        if (p->base.pairs)
            make_weights(&p->level[m], true);
    }
    down(p, SURROUNDINGS);
}

void
rc_pyramid_extend(struct rc_pyramid *p, rc_pyramid_add *r, const void *of, const double *beyond)
{
    int count = p->components;

    for (int c = 0; c < count; c++) {
        p->beyond[c] = beyond == NULL ? 0 : (float)beyond[c];
        if (p->levels > 0)
            pull(p, 1, r, of, c, p->level[1].k, p->level[1].value[c]);
    }
    for (size_t m = 1; m < p->levels; m++)
        up(p, m, AT_MOST, count, p->level[m + 1].k, p->level[m + 1].value);
    down(p, MEANS);
}

/* Sums the contributions of f to y beyond the coarsest level. */
static void
sum_beyond(struct rc_pyramid *p, double *beyond)
{
    const struct level *l = &p->level[p->levels];
    const struct rows rows = {l, COARSER, p->base.pairs};
    float *row = scratch(p);

    for (int c = 0; c < p->components; c++) {
        beyond[c] = 0;
        for (size_t j = 0; j < l->n; j++) {
            memset(row, 0, l->x.coarse * sizeof *row);
            add_of_level(&rows, c, j, 1 / p->level[1].k, row);
            for (size_t i = 0; i < l->x.coarse; i++)
                beyond[c] += (double)row[i];
        }
    }
}

void
rc_pyramid_gather(struct rc_pyramid *p, rc_pyramid_add *f, const void *of, double *beyond)
{
    int count = p->components;

    for (int c = 0; c < count && p->levels == 0; c++) { /* a single node: y is `beyond` */
        p->beyond[c] = 0;
        f(of, c, 0, 1, &p->beyond[c]);
        if (beyond != NULL)
            beyond[c] = (double)p->beyond[c];
        p->beyond[c] = 0;
    }
    if (p->levels == 0)
        return;
    for (int c = 0; c < count; c++)
        pull(p, 1, f, of, c, p->level[1].k,
             p->level[1].value[c]); /* k c of the base, with c = 1 on W */
    for (size_t m = 1; m < p->levels; m++)
        up(p, m, COARSER, count, 1, p->level[m + 1].value);
    if (beyond != NULL)
        sum_beyond(p, beyond);
    down(p, SUMS);
}
