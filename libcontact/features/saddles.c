/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Hills that are too low to count, by Wolf's rule. Where two hills touch, the lower of both nodes is a pass
 * from one to the other, and their highest pass is their saddle. Saddles are processed from the highest down.
 * A saddle may join two hills that are not joined yet. The hill with the lower peak is then pruned if that
 * peak is less than 5 % of Sz above the saddle. Its nodes go to the other hill. The result equals Wolf's
 * rule, which prunes the hill of least height first: that hill always joins one with a higher peak.
 *
 * Passes are found row by row, in bands of rows, and only saddles are sorted.
 */
#include "hills.h"

#include <stdlib.h>

#include "libcontact/memory.h"

enum {
    PIECE = 256,     /* nodes of a row processed together */
    SLOTS = 1 << 14, /* pairs of hills that a band remembers */
    FEW = 64         /* saddles sorted together, on average */
};

/* ---- saddles ---- */

struct saddle {
    double z;
    /* RC_NEIGHBOURS times the node of the pass, plus the direction of its neighbour on the other hill */
    size_t pass;
    uint32_t a, b; /* the hills, a < b */
};

struct saddles {
    struct saddle *v;
    size_t n, room;
};

static bool
saddles_add(struct saddles *s, const struct saddle *v)
{
    if (s->n == s->room) {
        size_t room = s->room > 0 ? 2 * s->room : PIECE; /* most bands have few */
        struct saddle *more = realloc(s->v, room * sizeof *more);
        if (more == NULL)
            return false;
        s->v = more;
        s->room = room;
    }
    s->v[s->n++] = *v;
    return true;
}

/* Sets bit d of `other` if neighbour d of a node belongs to another hill and is higher, or is missing. It
 * does so for n nodes of a row from k on that have all neighbours. */
RC_CLONES static void
find_others(const struct rc_field *f, size_t k, size_t n, unsigned char *restrict other)
{
    const double *h = f->h + k, sign = f->sign;
    const uint32_t *hill = f->hill + k;
    uint32_t differs[PIECE] = {0};
    /* also bits: numbers of equal width are processed several at a time */
    double higher[PIECE] = {0};

    for (int d = 0; d < RC_NEIGHBOURS; d++) {
        const ptrdiff_t by = rc_down[d] * (ptrdiff_t)f->shape.nx + rc_across[d];
        const bool first = d < RC_NEIGHBOURS / 2; /* the first of equal heights */
        const double *above = h + by, bit = (double)(1U << d);
        const uint32_t *beyond = hill + by;
        for (size_t i = 0; i < n; i++) {
            double z = sign * h[i], up = sign * above[i];
            higher[i] += ((up > z) | ((up == z) & first) | !rc_there(up)) ? bit : 0;
        }
        for (size_t i = 0; i < n; i++)
            differs[i] |= hill[i] != beyond[i] ? 1U << d : 0;
    }
    for (size_t i = 0; i < n; i++)
        other[i] = (unsigned char)(differs[i] & (uint32_t)(int)higher[i]);
}

/* The same for any node. */
static unsigned char
others(const struct rc_field *f, size_t k)
{
    unsigned found = 0;

    for (int d = 0; d < RC_NEIGHBOURS; d++) {
        size_t m = rc_field_neighbour(f, k, d);
        if (m == SIZE_MAX || (f->hill[m] != f->hill[k] && rc_field_before(f, m, k)))
            found |= 1U << d;
    }
    return (unsigned char)found;
}

/* The search of a band: the highest pass found for each pair of hills. A new pair in an occupied slot moves
 * the old one to the list: it may appear again, and be listed twice. */
struct search {
    const struct rc_field *f;
    struct rc_hills *hills;
    struct saddle *slot;
    struct saddles *found;
    bool failed;
};

static void
see_pass(struct search *s, double z, size_t pass, uint32_t a, uint32_t b)
{
    uint32_t low = a < b ? a : b, high = a < b ? b : a;
    struct saddle *at = &s->slot[(low * 3 + high * 5) % SLOTS];

    if (at->a == low && at->b == high) {
        if (z > at->z) /* the first of equal heights stays */
            *at = (struct saddle){z, pass, low, high};
        return;
    }
    if (at->a != RC_NO_HILL && !saddles_add(s->found, at))
        s->failed = true;
    *at = (struct saddle){z, pass, low, high};
}

static void
look_around(struct search *s, size_t k, unsigned other)
{
    const struct rc_field *f = s->f;
    uint32_t hill = f->hill[k];

    for (int d = 0; d < RC_NEIGHBOURS; d++) {
        size_t m;
        if ((other >> d & 1) == 0)
            continue;
        m = rc_field_beside(f, k, d);
        if (m != SIZE_MAX && f->hill[m] != RC_NO_HILL) {
            see_pass(s, rc_field_height(f, k), k * RC_NEIGHBOURS + (size_t)d, hill, f->hill[m]);
        } else {
#pragma omp atomic write
            s->hills->hill[hill].open = true;
        }
    }
}

/* Adds nodes to their hills, and examines their neighbours. */
static void
search_row(struct search *s, size_t row)
{
    const struct rc_field *f = s->f;
    size_t nx = f->shape.nx, nodes = 0;
    unsigned char other[PIECE];

    for (size_t i = 0; i < nx; i++) {
        size_t k = row + i, inside = (i + PIECE - 1) % PIECE;
        bool border = (f->mark[k] & RC_BORDER) != 0;
        if (!border && inside == 0)
            find_others(f, k, nx - 1 - i < PIECE ? nx - 1 - i : PIECE, other);
        nodes++;
        if (f->hill[k] != RC_NO_HILL)
            look_around(s, k, border ? others(f, k) : other[inside]);
        if (i + 1 < nx && f->hill[k + 1] == f->hill[k])
            continue;
        if (f->hill[k] != RC_NO_HILL) {
#pragma omp atomic
            s->hills->hill[f->hill[k]].nodes += nodes;
        }
        nodes = 0;
    }
}

static bool
search_band(const struct rc_field *f, size_t band, struct rc_hills *hills, struct saddles *found)
{
    struct search s = {f, hills, malloc(SLOTS * sizeof *s.slot), found, false};

    if (s.slot == NULL)
        return false;
    for (size_t k = 0; k < SLOTS; k++)
        s.slot[k].a = RC_NO_HILL;
    for (size_t k = rc_field_band(f, band); k < rc_field_band(f, band + 1); k += f->shape.nx)
        search_row(&s, k);
    for (size_t k = 0; k < SLOTS && !s.failed; k++)
        if (s.slot[k].a != RC_NO_HILL)
            s.failed = !saddles_add(found, &s.slot[k]);
    free(s.slot);
    return !s.failed;
}

static int
by_height(const void *a, const void *b)
{
    const struct saddle *x = a, *y = b;

    if (x->z != y->z)
        return x->z > y->z ? -1 : 1;
    return x->pass < y->pass ? -1 : x->pass > y->pass;
}

/* Steps of height, from the highest down. */
struct steps {
    double top, per_height;
    size_t n;
};

static size_t
step_of(const struct steps *s, double z)
{
    double at = (s->top - z) * s->per_height;

    return at < (double)(s->n - 1) ? (size_t)at : s->n - 1;
}

/* Merges the saddles of all bands into one list, the highest first: sorts into equal steps of height, then
 * within each step. */
static enum rc_status
sort_saddles(const struct rc_field *f, struct saddles *band, struct saddles *all)
{
    struct steps steps = {.top = f->sign > 0 ? f->highest : f->range - f->highest};
    RC_OWNED size_t *end = NULL;

    for (size_t b = 0; b < RC_BANDS; b++)
        all->n += band[b].n;
    steps.n = all->n / FEW + 1;
    steps.per_height = (double)steps.n / f->range;
    all->v = rc_alloc(all->n, sizeof *all->v);
    end = calloc(steps.n + 1, sizeof *end);
    if (all->v == NULL || end == NULL) {
        return RC_FAIL;
    }
    for (size_t b = 0; b < RC_BANDS; b++)
        for (size_t k = 0; k < band[b].n; k++)
            end[step_of(&steps, band[b].v[k].z) + 1]++;
    for (size_t k = 0; k < steps.n; k++)
        end[k + 1] += end[k];
    for (size_t b = 0; b < RC_BANDS; b++) {
        for (size_t k = 0; k < band[b].n; k++)
            all->v[end[step_of(&steps, band[b].v[k].z)]++] = band[b].v[k];
        free(band[b].v);
        band[b].v = NULL;
    }
#pragma omp parallel for num_threads(f->threads) schedule(dynamic, 64)
    for (size_t k = 0; k < steps.n; k++) {
        size_t start = k > 0 ? end[k - 1] : 0;
        qsort(all->v + start, end[k] - start, sizeof *all->v, by_height);
    }
    return RC_OK;
}

/* All saddles, the highest first; some may be listed twice. Counts the nodes of hills. */
static enum rc_status
find_saddles(const struct rc_field *f, struct rc_hills *hills, struct saddles *all)
{
    struct saddles band[RC_BANDS] = {{NULL, 0, 0}};
    enum rc_status status = RC_FAIL;
    bool found = true;

#pragma omp parallel for num_threads(f->threads) schedule(dynamic) reduction(&& : found)
    for (size_t b = 0; b < rc_field_bands(f); b++)
        found = search_band(f, b, hills, &band[b]) && found;
    if (found)
        status = sort_saddles(f, band, all);
    for (size_t b = 0; b < RC_BANDS; b++)
        free(band[b].v);
    return status;
}

/* ---- pruning ---- */

static uint32_t
root(struct rc_hills *s, uint32_t a)
{
    while (s->hill[a].joined != a) {
        s->hill[a].joined = s->hill[s->hill[a].joined].joined;
        a = s->hill[a].joined;
    }
    return a;
}

static void
join(const struct rc_field *f, struct rc_hills *s, const struct saddle *at)
{
    uint32_t a = root(s, at->a), b = root(s, at->b);
    const struct rc_hill *x = &s->hill[a], *y = &s->hill[b];
    bool a_lower = x->top < y->top || (x->top == y->top && x->peak > y->peak);
    struct rc_hill *lower = &s->hill[a_lower ? a : b];

    if (a == b)
        return;
    lower->joined = a_lower ? b : a;
    if (lower->top - at->z < f->least)
        lower->goes = a_lower ? at->b : at->a;
}

/* The kept hill to which this one was pruned, or itself. */
static uint32_t
kept(struct rc_hills *s, uint32_t a)
{
    while (s->hill[a].goes != a) {
        s->hill[a].goes = s->hill[s->hill[a].goes].goes;
        a = s->hill[a].goes;
    }
    return a;
}

enum rc_status
rc_hills_prune(const struct rc_field *f, struct rc_hills *s)
{
    struct saddles saddles = {NULL, 0, 0};
    enum rc_status status = find_saddles(f, s, &saddles);

    for (size_t k = 0; k < saddles.n && status == RC_OK; k++)
        join(f, s, &saddles.v[k]);
    free(saddles.v);
    for (size_t a = 0; a < s->n; a++) {
        struct rc_hill *from = &s->hill[a], *to = &s->hill[kept(s, (uint32_t)a)];
        if (from == to)
            continue;
        to->nodes += from->nodes;
        to->open = to->open || from->open;
    }
    return status;
}
