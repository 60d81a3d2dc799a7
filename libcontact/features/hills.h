/*
 * Hills of a map: where its ascents lead to the same peak. Internal: never installed.
 */
#ifndef RC_HILLS_H
#define RC_HILLS_H

#include <float.h>
#include <stdint.h>

#include "libcontact/common.h"

enum {
    RC_NEIGHBOURS = 8,
    RC_BANDS = 64 /* of rows, at the most */
};

struct rc_field {
    struct rc_shape shape;
    const double *h;
    double sign; /* -1: upside down */
    bool wraps;
    double highest, range; /* m, of what is there */
    double least;          /* m: what stands lower above its saddle is pruned */
    size_t n;              /* nodes that are there */
    int threads;
    unsigned char *mark; /* of each node: where its ascent leads, and the bit below */
    uint32_t *hill;      /* of each node; RC_NO_HILL where there is none */
};

enum {                       /* marks */
    RC_PEAK = RC_NEIGHBOURS, /* instead of the neighbour that the ascent leads to */
    RC_ABSENT,               /* not measured                                      */
    RC_ASCENT = 15,          /* the bits of these                                 */
    RC_BORDER = 16           /* in the first or the last row or column            */
};

static const uint32_t RC_NO_HILL = UINT32_MAX;

struct rc_hill {
    double top;      /* height of the peak */
    size_t peak;     /* node                                                      */
    size_t nodes;    /* its own, and, of one that is kept, those that go to it    */
    uint32_t joined; /* a hill that it has been joined with, with a higher peak   */
    uint32_t goes;   /* pruned: the hill that its nodes go to; itself: it is kept */
    bool open;       /* reaches the edge or what was not measured */
};

struct rc_hills {
    struct rc_hill *hill;
    size_t n;
};

static inline bool
rc_field_there(double v)
{
    return fabs(v) <= DBL_MAX;
}

static inline double
rc_field_height(const struct rc_field *f, size_t k)
{
    return f->sign * f->h[k];
}

static const int rc_across[RC_NEIGHBOURS] = {-1, 0, 1, -1, 1, -1, 0, 1};
static const int rc_down[RC_NEIGHBOURS] = {-1, -1, -1, 0, 0, 1, 1, 1};

/* A coordinate one step on; n: beyond the edge. */
static inline size_t
rc_field_step(size_t i, int by, size_t n, bool wraps)
{
    if (by < 0)
        return i > 0 ? i - 1 : wraps ? n - 1 : n;
    return by == 0 ? i : i + 1 < n ? i + 1 : wraps ? 0 : n;
}

/* Neighbour d of node k; SIZE_MAX: there is none, or it was not measured. */
static inline size_t
rc_field_neighbour(const struct rc_field *f, size_t k, int d)
{
    size_t nx = f->shape.nx, ny = f->shape.ny;
    size_t i = rc_field_step(k % nx, rc_across[d], nx, f->wraps),
           j = rc_field_step(k / nx, rc_down[d], ny, f->wraps);

    if (i == nx || j == ny || !rc_field_there(f->h[j * nx + i]))
        return SIZE_MAX;
    return j * nx + i;
}

static inline bool
rc_field_before(const struct rc_field *f, size_t a, size_t b)
{
    double za = rc_field_height(f, a), zb = rc_field_height(f, b);

    return za > zb || (za == zb && a < b);
}

/* Neighbour d of node k; SIZE_MAX: there is none. Inside the map it need not have been measured. */
static inline size_t
rc_field_beside(const struct rc_field *f, size_t k, int d)
{
    return f->mark[k] & RC_BORDER
               ? rc_field_neighbour(f, k, d)
               : k + (size_t)((ptrdiff_t)f->shape.nx * rc_down[d] + rc_across[d]);
}

/* Bands of rows, each for one thread at a time. */
static inline size_t
rc_field_bands(const struct rc_field *f)
{
    return f->shape.ny < RC_BANDS ? f->shape.ny : RC_BANDS;
}

/* The first node of a band; of one beyond the last, the end of the map. */
static inline size_t
rc_field_band(const struct rc_field *f, size_t band)
{
    return f->shape.ny * band / rc_field_bands(f) * f->shape.nx;
}

/* hills.c: hills without their nodes, and the hill of each node; to be freed by the caller. RC_FAIL when
 * memory is short. */
enum rc_status rc_hills_find(struct rc_field *field, struct rc_hills *hills);

/* saddles.c: prunes them by Wolf's rule, and counts their nodes. RC_FAIL likewise. */
enum rc_status rc_hills_prune(const struct rc_field *field, struct rc_hills *hills);

#endif
