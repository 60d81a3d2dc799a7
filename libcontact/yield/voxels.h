/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * The yielded voxels and their numbers, stored row by row, because the rows of a slab are computed one by one
 * by several threads. Other voxels take no memory. Internal: never installed.
 */
#ifndef RC_VOXELS_H
#define RC_VOXELS_H

#include "law.h"

/* An increment changes the plastic strain from e to e + x. */
struct rc_voxel {
    uint32_t i;               /* column of the voxel in its row */
    float beta;               /* part of `last` in the base of the increment, see plastic.c */
    double e[RC_DEVIATOR];    /* plastic strain at the last accepted load                       */
    double last[RC_DEVIATOR]; /* its last accepted increment                                    */
    double x[RC_DEVIATOR];    /* the increment that is tried                                    */
    double f[RC_DEVIATOR];    /* F(x): the increment under the stress of e + x */
    double strain, grown;     /* equivalent strain, and its growth in the last increment */
    /* Small beside x, so that single precision is enough. They are the sums of the terms of second order over
     * earlier loads and over this load, the change of x by the last trial, and its f - x. */
    float before[RC_DEVIATOR], missed[RC_DEVIATOR], moved[RC_DEVIATOR], left[RC_DEVIATOR];
};

enum { /* sums over the voxels of a row */
    RC_LAG,
    RC_FLOWING,
    RC_NEW_OLD,
    RC_CHANGE,
    RC_ADVANCE,
    RC_RESISTED,
    RC_VOXEL_SUMS
};

struct rc_voxel_row {
    size_t n;
    struct rc_voxel *v; /* by i */
    double sums[RC_VOXEL_SUMS];
};

struct rc_voxels {
    size_t slabs, rows; /* rows of a slab */
    struct rc_voxel_row *row;
    bool *strained; /* slabs with yielded voxels */
};

enum rc_status rc_voxels_new(struct rc_voxels *voxels, size_t slabs, size_t rows);
void rc_voxels_free(struct rc_voxels *voxels);
static inline struct rc_voxel_row *
rc_voxels_row(const struct rc_voxels *voxels, size_t slab, size_t j)
{
    return voxels->row + slab * voxels->rows + j;
}
void rc_voxels_clear(struct rc_voxels *voxels);
/* Adds voxels with zero numbers at these new places, in increasing order. RC_FAIL if memory is short. */
enum rc_status rc_voxels_add(struct rc_voxel_row *row, size_t n, const uint32_t *place);
size_t rc_voxels_count(const struct rc_voxels *voxels);

#endif
