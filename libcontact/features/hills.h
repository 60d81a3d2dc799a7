/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Hills of a map: the nodes whose ascents reach the same peak. Internal: never installed.
 */
#ifndef RC_HILLS_H
#define RC_HILLS_H

#include <stdint.h>

#include "libcontact/common.h"

enum {
    RC_NEIGHBOURS = 8,
    RC_BANDS = 64 /* most blocks of rows */
};

struct rc_field {
    struct rc_shape shape;
    const double *h;
    double sign; /* -1: upside down */
    struct rc_boundary boundary;
    double highest, range; /* m, of the measured heights */
    double least;          /* m: hills with a smaller height above their saddle are pruned */
    size_t n;              /* measured nodes */
    int threads;
    unsigned char *mark; /* for each node: direction of its ascent, and a bit */
    uint32_t *hill;      /* hill of each node; RC_NO_HILL: none */
};

enum {                       /* marks                                   */
    RC_PEAK = RC_NEIGHBOURS, /* value in place of the direction of the ascent */
    RC_ABSENT,               /* not measured                            */
    RC_ASCENT = 15,          /* the bits of the values above            */
    RC_BORDER = 16           /* the hill has a node in the first or the last row or column */
};

static const uint32_t RC_NO_HILL = UINT32_MAX;

struct rc_hill {
    double top;      /* height of the peak                                          */
    size_t peak;     /* node                                                        */
    size_t nodes;    /* its own and, for a kept hill, those of hills pruned into it */
    uint32_t joined; /* a hill with a higher peak to which it has been joined       */
    uint32_t goes;   /* the hill that gets its nodes; itself: it is kept            */
    bool open;       /* reaches the edge or a missing node                          */
};

struct rc_hills {
    struct rc_hill *hill;
    size_t n;
};

static inline double
rc_field_height(const struct rc_field *f, size_t k)
{
    return f->sign * f->h[k];
}

static const int rc_across[RC_NEIGHBOURS] = {-1, 0, 1, -1, 1, -1, 0, 1};
static const int rc_down[RC_NEIGHBOURS] = {-1, -1, -1, 0, 0, 1, 1, 1};

/* The next coordinate; n: beyond the edge. */
static inline size_t
rc_field_step(size_t i, int by, size_t n, bool wraps)
{
    if (by < 0)
        return i > 0 ? i - 1 : wraps ? n - 1 : n;
    return by == 0 ? i : i + 1 < n ? i + 1 : wraps ? 0 : n;
}

/* Neighbour d of node k; SIZE_MAX: beyond the edge, or missing. */
static inline size_t
rc_field_neighbour(const struct rc_field *f, size_t k, int d)
{
    size_t nx = f->shape.nx, ny = f->shape.ny;
    size_t i = rc_field_step(k % nx, rc_across[d], nx, f->boundary.x),
           j = rc_field_step(k / nx, rc_down[d], ny, f->boundary.y);

    if (i == nx || j == ny || !rc_there(f->h[j * nx + i]))
        return SIZE_MAX;
    return j * nx + i;
}

static inline bool
rc_field_before(const struct rc_field *f, size_t a, size_t b)
{
    double za = rc_field_height(f, a), zb = rc_field_height(f, b);

    return za > zb || (za == zb && a < b);
}

/* Neighbour d of node k; SIZE_MAX: beyond the edge. Inside the map it may be missing. */
static inline size_t
rc_field_beside(const struct rc_field *f, size_t k, int d)
{
    return f->mark[k] & RC_BORDER
               ? rc_field_neighbour(f, k, d)
               : k + (size_t)((ptrdiff_t)f->shape.nx * rc_down[d] + rc_across[d]);
}

/* Bands of rows; a thread processes one at a time. */
static inline size_t
rc_field_bands(const struct rc_field *f)
{
    return f->shape.ny < RC_BANDS ? f->shape.ny : RC_BANDS;
}

/* The first node of a band; for a band beyond the last one, the end of the map. */
static inline size_t
rc_field_band(const struct rc_field *f, size_t band)
{
    return f->shape.ny * band / rc_field_bands(f) * f->shape.nx;
}

/* hills.c: hills without their nodes, and the hill of each node, which the caller frees. RC_FAIL when memory
 * is short. */
enum rc_status rc_hills_find(struct rc_field *field, struct rc_hills *hills);

/* saddles.c: prunes hills by Wolf's rule, and counts their nodes. RC_FAIL likewise. */
enum rc_status rc_hills_prune(const struct rc_field *field, struct rc_hills *hills);

#endif
