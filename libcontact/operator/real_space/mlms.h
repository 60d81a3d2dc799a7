/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Multi-level multi-summation after Polonsky and Keer 1999 (Wear 231, section 3.1; "the paper").
 *
 * A smooth kernel can be interpolated from every second node. So the sum over the fine grid
 *
 *     u_i = sum_j K_(i-j) p_j
 *
 * is a sum over a grid of every second node, of pressures reduced with the transpose of the interpolation
 * (10), interpolated back to the fine nodes (15), and exact except for pairs of nodes that are too close for
 * the interpolation. Stencils correct those pairs, once for the interpolation to the source (13), (14), once
 * for that to the target (16), (17). The coarse sum is computed the same way, down to a grid that is summed
 * directly.
 *
 * Nodes of a fine grid fall into classes by the parity of their indices. In a direction that is
 * halved, node i = 2a + s belongs to place a of class s, and coarse node I lies on fine node
 * 2(I - t + 1): t - 1 coarse nodes overhang at either end. In a direction that is not halved every
 * node is of class 0 and its own coarse node. Stencils lead from one class to another and are
 * contiguous there.
 */
#ifndef RC_MLMS_H
#define RC_MLMS_H

#include "direct.h"
#include "libcontact/memory.h"
#include "simd.h"

enum {
    RC_MLMS_HALF_MAX = 64, /* largest t                          */
    RC_MLMS_LEVELS = 64,
    RC_MLMS_TILE = 64 /* approximate places of a class in a tile, in each direction */
};

/* Coefficients from one class of sources to one of targets. Column j stands for the x offsets +-k
 * of the j-th |k| of its parity. */
struct rc_mlms_stencil {
    size_t columns;
    struct rc_column *column;
    double *sparse; /* the same unfolded, rows of `width` from the lowest l and k   */
    size_t width, rows;
    ptrdiff_t first_x, first_y; /* places of the lowest k and l */
};

struct rc_mlms_axis {
    size_t n;      /* fine nodes                               */
    size_t coarse; /* coarse nodes                             */
    size_t step;   /* cells between fine nodes                 */
    size_t halved; /* 1, or 0: this direction is not coarsened */
    size_t reach;  /* largest corrected offset, nodes          */
    size_t margin; /* the same in places                       */
    size_t tile;   /* places of a class in a tile              */
    size_t tiles;
};

/* The levels for a grid and an accuracy, before any allocation. */
struct rc_mlms_design {
    size_t t, reach; /* m_c, in nodes of the coarser of the halved spacings */
    bool square;     /* correction regions are rectangles, not ellipses     */
    double error;
    size_t levels; /* levels that are coarsened */
    /* the last: of the grid that is not coarsened */
    struct rc_mlms_axis axis[RC_MLMS_LEVELS + 1][2];
    double terms, work; /* products in (10) to (17); estimated effective number */
    int threads;
};

struct rc_mlms_level {
    const struct rc_mlms_axis *axis;
    double *p, *u;         /* p and u of this level; NULL on the finest, where the caller owns
                              them */
    unsigned char *loaded; /* tiles with pressure */
    struct rc_mlms_stencil fine[4][4]; /* [target][source], class x + 2 y; target 0 unused */
    struct rc_mlms_stencil coarse[4];  /* [source], to coarse nodes; 0 unused              */
};

/* The scratch memory of one thread. */
struct rc_mlms_scratch {
    double *plane[4]; /* pressures by class, with margins    */
    double *out[4];   /* results by class, with margins in x */
    double *ring;     /* columns of a strip                  */
    double *mid;      /* rows after one direction            */
    uint32_t *list;   /* loaded nodes, y << 16 | x           */
    double *zeros;
    const double **near, **far;
};

struct rc_mlms {
    struct rc_mlms_design d;
    double s[RC_MLMS_HALF_MAX]; /* (8): weights at distances 1, 3, 5, ... */
    double sign[2];             /* factor for negative offsets            */
    const struct rc_simd *simd;
    struct rc_mlms_level level[RC_MLMS_LEVELS + 1];
    struct rc_direct *direct;
    size_t plane_stride, plane_size, out_stride, out_size; /* doubles, enough on every level */
    size_t ring_size, mid_stride, mid_size, zeros_size, out_lead;
    struct rc_mlms_scratch *scratch;
    struct rc_store own;
};

/* mlms_design.c */
bool rc_mlms_design(const struct rc_sum *sum, struct rc_mlms_design *d, struct rc_err *err);
/* Largest corrected y offset at x offset k of a level, -1: none; `odd`: between classes that differ in both
 * directions. */
ptrdiff_t rc_mlms_extent(const struct rc_mlms_design *d, const struct rc_shape *shape,
                         const struct rc_mlms_axis axis[2], size_t k, bool odd);

/* mlms_stencil.c */
/* (8): s[i], i < t, weighs the nodes at the distances +-(2i + 1). */
void rc_mlms_weights(size_t t, double *s);
/* In memory of m->own; false when that is short. */
bool rc_mlms_stencils(struct rc_mlms *m, const struct rc_sum *sum, size_t level);
/* The coefficients that corrections neglect on the worst level. *one: the largest, over the kernel of a
 * nearby node: the error under pressure on one node. *all: their sum over the sum of |K| within the region:
 * the error under pressures of the worst signs everywhere. INFINITY when memory is short. */
void rc_mlms_left_out(const struct rc_sum *sum, const struct rc_mlms_design *d, double *one,
                      double *all);

/* mlms_tile.c: operations on one tile of a level; tiles are numbered row by row. p and u are those of the
 * level. */
void rc_mlms_scan(const struct rc_mlms *m, size_t level, const double *p, size_t tile);
/* (10): pressures of a tile of the next level. */
void rc_mlms_reduce(const struct rc_mlms *m, size_t level, const double *p, size_t tile,
                    struct rc_mlms_scratch *w);
/* (14): corrects a tile of the displacements of the next level. */
void rc_mlms_correct(const struct rc_mlms *m, size_t level, const double *p, size_t tile,
                     struct rc_mlms_scratch *w);
/* (15), (17): displacements of a tile from those of the next level. */
void rc_mlms_expand(const struct rc_mlms *m, size_t level, const double *p, double *u, size_t tile,
                    struct rc_mlms_scratch *w);

#endif
