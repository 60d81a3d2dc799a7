/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * MATLAB, MAT version 7.3 (save -v7.3): HDF5 behind 512 bytes of MATLAB's own. Each variable is a dataset or
 * group at the top, the attribute MATLAB_class says what it is. Numbers run down the columns, so that to HDF5
 * an array is the transposed one. The variables have the same meaning as in version 5 (mat.c).
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "matlab.h"
#include "formats/containers/containers.h"
#include "formats/format.h"

enum {
    AT_VERSION = 124,
    AT_HDF = 512,
    SETS_MOST = 1024,
    TEXT_MOST = 64
};

static const char version[] = "\0\2IM", hdf_magic[] = "\x89HDF\r\n\x1a\n";

static const char *const number_classes[] = {"double", "single", "int8",   "uint8", "int16",
                                             "uint16", "int32",  "uint32", "int64", "uint64"};

struct mat73 {
    struct rc_hdf *hdf;
    struct rc_hdf_set set[SETS_MOST];
    size_t n, at;
};

static void
mat73_close(void *opened)
{
    rc_hdf_free(((struct mat73 *)opened)->hdf);
}

static void
start(struct rc_matlab_source *s)
{
    ((struct mat73 *)s->arg)->at = 0;
}

/* Reads one number, or a short text, which HDF5 stores as codes of UTF-16. */
static enum rc_status
read_short(struct mat73 *m, const struct rc_hdf_set *set, struct rc_matlab_array *a,
           struct rc_err *err)
{
    size_t n = set->rows * set->columns, length = 0;
    double v[TEXT_MOST];
    char text[3 * TEXT_MOST];

    if (rc_hdf_values(m->hdf, set, v, err) != RC_OK)
        return RC_FAIL;
    a->first = v[0];
    for (size_t k = 0; k < n && a->is_text; k++)
        length += rc_utf8_put(text + length, v[k] > 0 && v[k] < 65536 ? (unsigned)v[k] : ' ');
    rc_text_clean(a->text, sizeof a->text, text, length);
    return RC_OK;
}

static enum rc_status
next(struct rc_matlab_source *s, struct rc_matlab_array *a, struct rc_err *err)
{
    struct mat73 *m = s->arg;
    const struct rc_hdf_set *set;
    char class[RC_SHOWN] = "";

    do {
        if (m->at >= m->n)
            return RC_OK;
        set = &m->set[m->at++];
    } while (strchr(set->path, '/') != NULL || strlen(set->path) >= sizeof a->name);
    *a = (struct rc_matlab_array){
        .rows = set->columns, .columns = set->rows, .first = NAN, .at = m->at - 1};
    strcpy(a->name, set->path);
    rc_hdf_text(m->hdf, set->path, "MATLAB_class", class, sizeof class);
    a->is_text = strcmp(class, "char") == 0;
    a->other = "of another class";
    for (size_t k = 0; k < sizeof number_classes / sizeof *number_classes; k++)
        if (a->is_text || strcmp(class, number_classes[k]) == 0)
            a->other = NULL;
    if (a->other == NULL && set->rows < TEXT_MOST && set->columns <= TEXT_MOST / set->rows &&
        (a->is_text || set->rows * set->columns == 1) && read_short(m, set, a, err) != RC_OK)
        return RC_FAIL;
    return RC_MORE;
}

static enum rc_status
numbers_of(struct rc_matlab_source *s, const struct rc_matlab_array *a, double *v,
           struct rc_err *err)
{
    struct mat73 *m = s->arg;

    return rc_hdf_values(m->hdf, &m->set[a->at], v, err);
}

static enum rc_status
fill_numbers(const struct rc_file *file, const struct rc_map *map, double *v, struct rc_err *err)
{
    const struct mat73 *m = map->opened;

    (void)file;
    return rc_hdf_values(m->hdf, &m->set[map->more], v, err);
}

static enum rc_status
place(struct rc_matlab_source *s, const struct rc_matlab_array *a, struct rc_map *map,
      struct rc_err *err)
{
    map->fill = fill_numbers;
    map->more = a->at;
    return rc_map_fits(s->file, map->nx, map->ny, err);
}

static bool
has_magic(const struct rc_file *file)
{
    return rc_file_holds(file, AT_VERSION, version, 4) && rc_file_holds(file, AT_HDF, hdf_magic, 8);
}

static enum rc_status
mat73_find(const struct rc_file *file, struct rc_maps *maps, struct rc_err *err)
{
    struct mat73 *m = rc_maps_open(maps, sizeof *m, mat73_close, err);
    struct rc_matlab_source source = {file, m, start, next, numbers_of, place};

    if (m == NULL || (m->hdf = rc_hdf_new(file, err)) == NULL)
        return RC_FAIL;
    m->n = rc_hdf_sets(m->hdf, m->set, SETS_MOST);
    m->n = m->n < SETS_MOST ? m->n : SETS_MOST;
    return rc_matlab_maps(&source, maps, err);
}

const struct rc_format rc_format_mat73 = {
    .name = "mat73",
    .suffixes = ".mat",
    .summary = "MATLAB arrays of two dimensions, MAT version 7.3 (save -v7.3)",
    .is = has_magic,
    .refusal =
        "not a MAT file of version 7.3: its header lacks version 2, or no HDF5 follows the header",
    .find = mat73_find,
    .sandboxed = true,
};
