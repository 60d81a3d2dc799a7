/*
 * The voxels that have yielded, and what is known of each: row by row, since the rows of a slab come one
 * by one and to several threads. Other voxels take no memory. Internal: never installed.
 */
#ifndef RC_VOXELS_H
#define RC_VOXELS_H

#include "yield.h"

/* One load increment goes from e to e + x. */
struct rc_voxel {
    uint32_t i;               /* of its row                                                     */
    float beta;               /* part of `last` in the base of the increment: plastic.c         */
    double e[RC_DEVIATOR];    /* plastic strain at the last accepted load                       */
    double last[RC_DEVIATOR]; /* its last accepted increment                                    */
    double x[RC_DEVIATOR];    /* the increment that is tried                                    */
    double f[RC_DEVIATOR];    /* what the stress under e + x makes of it                        */
    double strain, grown;     /* equivalent strain, and what the last increment added */
    /* Small beside x, so that they lose nothing as it converges: sums of what the order of the integration
     * adds, over the loads before this one and in this one; what the last trial moved x by; and f - x of
     * it. */
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
    size_t slabs, rows; /* of a slab */
    struct rc_voxel_row *row;
    bool *strained; /* slabs that hold any */
};

enum rc_status rc_voxels_new(struct rc_voxels *voxels, size_t slabs, size_t rows);
void rc_voxels_free(struct rc_voxels *voxels);
static inline struct rc_voxel_row *
rc_voxels_row(const struct rc_voxels *voxels, size_t slab, size_t j)
{
    return voxels->row + slab * voxels->rows + j;
}
void rc_voxels_clear(struct rc_voxels *voxels);
/* Adds voxels, all 0, at these places, which grow and are not there yet. RC_FAIL when memory is short. */
enum rc_status rc_voxels_add(struct rc_voxel_row *row, size_t n, const uint32_t *place);
size_t rc_voxels_count(const struct rc_voxels *voxels);

#endif
