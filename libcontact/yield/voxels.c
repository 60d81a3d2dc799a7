/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "voxels.h"

#include <stdlib.h>

#include "libcontact/grid.h"

enum rc_status
rc_voxels_new(struct rc_voxels *v, size_t slabs, size_t rows)
{
    *v = (struct rc_voxels){.slabs = slabs, .rows = rows};
    v->row = calloc(slabs * rows + 1, sizeof *v->row);
    v->strained = calloc(slabs, sizeof *v->strained);
    return v->row != NULL && v->strained != NULL ? RC_OK : RC_FAIL;
}

void
rc_voxels_clear(struct rc_voxels *v)
{
    for (size_t k = 0; k < v->slabs * v->rows && v->row != NULL; k++) {
        free(v->row[k].v);
        v->row[k] = (struct rc_voxel_row){0};
    }
}

void
rc_voxels_free(struct rc_voxels *v)
{
    rc_voxels_clear(v);
    free(v->row);
    free(v->strained);
    *v = (struct rc_voxels){0};
}

enum rc_status
rc_voxels_add(struct rc_voxel_row *row, size_t n, const uint32_t *place)
{
    size_t from = row->n, to = row->n + n;
    struct rc_voxel *more = NULL;

    /* A row is a small block, which realloc never refuses; all rows together are most of the memory. It grows
     * seldom, so without spare memory. */
    if (rc_memory_ask(n * sizeof *more))
        more = realloc(row->v, to * sizeof *more);
    if (more == NULL)
        return RC_FAIL;
    row->v = more;
    row->n = to;
    while (n > 0) { /* from the end, so that each voxel moves once */
        if (from > 0 && row->v[from - 1].i > place[n - 1])
            row->v[--to] = row->v[--from];
        else
            row->v[--to] = (struct rc_voxel){.i = place[--n]};
    }
    return RC_OK;
}

size_t
rc_voxels_count(const struct rc_voxels *v)
{
    size_t count = 0;

    for (size_t k = 0; k < v->slabs * v->rows; k++)
        count += v->row[k].n;
    return count;
}
