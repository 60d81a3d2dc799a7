/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * HDF5: every dataset of numbers with two dimensions is a channel, rows by columns, row 0 first.
 * The attributes dx and dy (m) and unit or units, as rc-export writes them, say what it is;
 * _FillValue is a missing point. Without them the user has to.
 */
#include <stdlib.h>
#include <string.h>

#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    SETS_MOST = 256
};

/* A file and its datasets. */
struct sets {
    struct rc_hdf *hdf;
    struct rc_hdf_set set[SETS_MOST];
};

static void
sets_close(void *opened)
{
    rc_hdf_free(((struct sets *)opened)->hdf);
}

static enum rc_status
fill_values(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    const struct sets *s = map->opened;

    (void)file;
    return rc_hdf_values(s->hdf, &s->set[map->more], v, err);
}

static void
add_set(struct rc_hdf *h, const struct rc_hdf_set *set, size_t number, struct rc_maps *maps)
{
    struct rc_map *map = rc_maps_add(maps, rc_piece_of(set->path));
    char unit[RC_SHOWN];

    map->nx = set->columns;
    map->ny = set->rows;
    map->fill = fill_values;
    map->more = number;
    rc_hdf_number(h, set->path, "dx", &map->dx);
    rc_hdf_number(h, set->path, "dy", &map->dy);
    rc_hdf_text(h, set->path, "unit", unit, sizeof unit);
    if (unit[0] == '\0')
        rc_hdf_text(h, set->path, "units", unit, sizeof unit);
    rc_map_unit(map, rc_piece_of(unit));
    rc_hdf_number(h, set->path, "_FillValue", &map->missing_from);
    map->missing_to = map->missing_from;
}

static enum rc_status
hdf5_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct sets *s = rc_maps_open(maps, sizeof *s, sets_close, err);
    size_t n;

    if (s == NULL || (s->hdf = rc_hdf_new(file, err)) == NULL)
        return RC_FAIL;
    if ((n = rc_hdf_sets(s->hdf, s->set, SETS_MOST)) == 0)
        return rc_err_set(err, "the file has no dataset of numbers with two dimensions");
    for (size_t k = 0; k < n && k < SETS_MOST; k++)
        add_set(s->hdf, &s->set[k], k, maps);
    return RC_OK;
}

const struct rc_format rc_format_hdf5 = {
    .name = "hdf5",
    .suffixes = ".h5 .hdf5",
    .summary = "HDF5: datasets of two dimensions",
    .is = rc_hdf_is,
    .sure = 60, /* files of instruments have other readers */
    .find = hdf5_find,
    .sandboxed = true,
};
