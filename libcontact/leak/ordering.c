/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The order of elimination by nested dissection (George, SIAM J. Numer. Anal. 10, 1973, 345). A separator
 * cuts a region into two sides, which share no face, and is eliminated after both. The sides are cut in the
 * same way.
 *
 * The work grows with the third power of a separator's nodes. Therefore a separator follows a seam, a path
 * across the region that advances by one node and moves at most one node sideways. Nodes in contact cost
 * nothing. The seam with the fewest nodes, found by dynamic programming, leads from contact to contact.
 */
#include "leak.h"

#include <stdlib.h>
#include <string.h>

enum {
    LEAF = 8,    /* nodes of a region that is not cut      */
    TASK = 4096, /* nodes of a region that a thread takes  */
    NONE = -1,   /* instead of a part: the region is empty */
    FAILED = -2  /* memory is short                        */
};

enum side {
    LEFT,
    RIGHT,
    SEAM
};

struct cutter {
    const struct rc_passage *a;
    struct rc_order *o;
    double per_row; /* 1/nx                   */
    int32_t *spare; /* a second list of nodes */
    int32_t room;   /* for parts */
};

/* A region in coordinates u across the seam and v along it, with its band: the columns u where the seam may
 * lie. */
struct region {
    int32_t u0, v0, wide, high;
    bool turned; /* u is the row of the map */
    int32_t from, band;
    int32_t *seam; /* u for each v */
};

static void
place_of(const struct cutter *c, const struct region *r, int32_t k, int32_t *u, int32_t *v)
{
    /* faster than a division, and as exact: the half is far above the rounding error */
    int32_t nx = (int32_t)c->a->nx, y = (int32_t)((k + 0.5) * c->per_row), x = k - y * nx;

    *u = (r->turned ? y : x) - r->u0;
    *v = (r->turned ? x : y) - r->v0;
}

static struct region
bounding_box(const struct cutter *c, const int32_t *node, int32_t n)
{
    int32_t nx = (int32_t)c->a->nx, left = nx, right = 0, top = node[0] / nx,
            low = node[n - 1] / nx;
    struct region r;

    for (int32_t m = 0; m < n; m++) { /* the nodes follow each other row by row */
        int32_t x = node[m] % nx;
        left = x < left ? x : left;
        right = x > right ? x : right;
    }
    r.turned = right - left < low - top;
    r.u0 = r.turned ? top : left;
    r.v0 = r.turned ? left : top;
    r.wide = r.turned ? low - top + 1 : right - left + 1;
    r.high = r.turned ? right - left + 1 : low - top + 1;
    return r;
}

/* The band leaves 3/8 of the nodes on either side. */
static void
set_band(const struct cutter *c, struct region *r, const int32_t *node, int32_t n, int32_t *column)
{
    int32_t sum = 0, u = 0, v, end;

    memset(column, 0, (size_t)r->wide * sizeof *column);
    for (int32_t m = 0; m < n; m++) {
        place_of(c, r, node[m], &u, &v);
        column[u]++;
    }
    for (u = 0; sum + column[u] < 3 * (int64_t)n / 8 && u < r->wide - 2; u++)
        sum += column[u];
    r->from = u > 0 ? u : 1;
    for (end = u; sum + column[end] < 5 * (int64_t)n / 8 && end < r->wide - 2; end++)
        sum += column[end];
    r->band = end >= r->from ? end - r->from + 1 : 1;
}

/* cost[v * band + u] becomes the least cost of a seam from v = 0 to here. */
static void
find_seam(struct region *r, int32_t *cost)
{
    const int32_t band = r->band;
    int32_t best = 0, *last;

    for (int32_t v = 1; v < r->high; v++) {
        const int32_t *before = cost + (size_t)(v - 1) * (size_t)band;
        int32_t *now = cost + (size_t)v * (size_t)band;
        for (int32_t u = 0; u < band; u++) {
            int32_t least = before[u];
            if (u > 0 && before[u - 1] < least)
                least = before[u - 1];
            if (u < band - 1 && before[u + 1] < least)
                least = before[u + 1];
            now[u] += least;
        }
    }
    last = cost + (size_t)(r->high - 1) * (size_t)band;
    for (int32_t u = 1; u < band; u++)
        if (last[u] < last[best])
            best = u;
    for (int32_t v = r->high - 1; v >= 0; v--) {
        r->seam[v] = r->from + best;
        if (v > 0) {
            const int32_t *before = cost + (size_t)(v - 1) * (size_t)band;
            int32_t at = best;
            if (at > 0 && before[at - 1] < before[best])
                best = at - 1;
            if (at < band - 1 && before[at + 1] < before[best])
                best = at + 1;
        }
    }
}

static enum side
side_of(const struct cutter *c, const struct region *r, int32_t k)
{
    int32_t u, v;

    place_of(c, r, k, &u, &v);
    if (v < 0 || v >= r->high)
        return SEAM;
    return u < r->seam[v] ? LEFT : u > r->seam[v] ? RIGHT : SEAM;
}

/* Also a node on the left that faces the right side around the map is part of the separator. */
static enum side
part_of(const struct cutter *c, const struct region *r, int32_t k)
{
    const int32_t nx = (int32_t)c->a->nx, last = c->a->nodes - nx;
    enum side side = side_of(c, r, k);

    if (side == LEFT && c->a->around &&
        ((k < nx && side_of(c, r, k + last) == RIGHT) ||
         (k >= last && side_of(c, r, k - last) == RIGHT)))
        return SEAM;
    return side;
}

static int32_t
add_part(struct cutter *c, struct rc_part part)
{
    struct rc_order *o = c->o;
    int32_t at = FAILED;

#pragma omp critical
    {
        if (o->parts == c->room) {
            int32_t room = c->room + c->room / 2 + 64;
            struct rc_part *more = realloc(o->part, (size_t)room * sizeof *more);
            if (more != NULL) {
                o->part = more;
                c->room = room;
            }
        }
        if (o->parts < c->room) {
            at = o->parts++;
            o->part[at] = part;
        }
    }
    return at;
}

/* Sorts the nodes into left, right and separator. */
static void
divide(struct cutter *c, const struct region *r, int32_t lo, int32_t hi, int32_t *right,
       int32_t *cut)
{
    int32_t *node = c->o->node, *spare = c->spare, n[3] = {0};

    for (int32_t m = lo; m < hi; m++) {
        enum side side = part_of(c, r, node[m]);
        n[side]++;
        if (side == LEFT)
            node[lo + n[LEFT] - 1] = node[m];
        else if (side == RIGHT)
            spare[lo + n[RIGHT] - 1] = node[m];
        else
            spare[hi - n[SEAM]] = node[m];
    }
    *right = lo + n[LEFT];
    *cut = *right + n[RIGHT];
    memcpy(node + *right, spare + lo, (size_t)n[RIGHT] * sizeof *node);
    for (int32_t m = *cut; m < hi; m++)
        node[m] = spare[hi - 1 - (m - *cut)];
}

/* Cuts node[lo] .. node[hi - 1]; returns its part. */
static int32_t
cut_region(struct cutter *c, int32_t lo, int32_t hi)
{
    const int32_t *node = c->o->node;
    struct rc_part now = {lo, lo, hi, NONE, NONE};
    struct region r;
    int32_t right, *cost;

    if (lo == hi)
        return NONE;
    if (hi - lo <= LEAF)
        return add_part(c, now);
    r = bounding_box(c, node + lo, hi - lo);
    r.seam = malloc((size_t)(r.high + r.wide) * sizeof *r.seam);
    if (r.seam == NULL)
        return FAILED;
    set_band(c, &r, node + lo, hi - lo, r.seam + r.high);
    cost = calloc((size_t)r.high * (size_t)r.band, sizeof *cost);
    if (cost == NULL) {
        free(r.seam);
        return FAILED;
    }
    for (int32_t m = lo; m < hi; m++) {
        int32_t u, v;
        place_of(c, &r, node[m], &u, &v);
        if (u >= r.from && u < r.from + r.band)
            cost[(size_t)v * (size_t)r.band + (size_t)(u - r.from)] = 1;
    }
    find_seam(&r, cost);
    free(cost);
    divide(c, &r, lo, hi, &right, &now.cut);
    free(r.seam);
#pragma omp task shared(now) if (hi - lo >= TASK)
    now.left = cut_region(c, lo, right);
    now.right = cut_region(c, right, now.cut);
#pragma omp taskwait
    return now.left == FAILED || now.right == FAILED ? FAILED : add_part(c, now);
}

enum rc_status
rc_order_set(struct rc_order *o, const struct rc_passage *a, struct rc_err *err)
{
    struct cutter c = {.a = a, .o = o, .per_row = 1 / (double)a->nx};

    *o = (struct rc_order){.root = FAILED};
    for (int32_t k = 0; k < a->nodes; k++)
        o->n += a->state[k] == RC_FLOWS;
    o->node = malloc(((size_t)o->n + 1) * sizeof *o->node);
    c.spare = malloc(((size_t)o->n + 1) * sizeof *c.spare);
    if (o->node != NULL && c.spare != NULL) {
        for (int32_t k = 0, m = 0; k < a->nodes; k++)
            if (a->state[k] == RC_FLOWS)
                o->node[m++] = k;
        o->root = cut_region(&c, 0, o->n);
    }
    free(c.spare);
    if (o->root == FAILED)
        return rc_err_set(err, "out of memory for the order of %d nodes with fluid", o->n);
    return RC_OK;
}
