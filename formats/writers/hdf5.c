/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * HDF5: a dataset for each frame, rows by columns, named by its channel. The depths of one channel and case
 * are one dataset, depth by rows by columns. Its attributes are dx and dy (m), unit, channel, and every key
 * of the frame as text; a missing point is NaN. If rows or slices are depths, the depths are a dataset too,
 * the dimension scale of their axis. The library must seek, so it makes the file in memory.
 */
#include <hdf5_hl.h>
#include <stdlib.h>
#include <string.h>

#include "encode.h"
#include "formats/containers/hdf_id.h"
#include "formats/export.h"
#include "stack.h"

enum {
    TYPES = RC_TYPE_F32 | RC_TYPE_F64,
    GROWTH = 1 << 20 /* step in bytes by which the file in memory grows */
};

static bool
put_number(hid_t set, const char *name, double value)
{
    RC_HID space = H5Screate(H5S_SCALAR);
    RC_HID attribute = H5Acreate2(set, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT);

    return attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0;
}

static bool
put_text(hid_t set, const char *name, const char *value)
{
    RC_HID space = H5Screate(H5S_SCALAR), type = H5Tcopy(H5T_C_S1), attribute = -1;

    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    attribute = H5Acreate2(set, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    return attribute >= 0 && H5Awrite(attribute, type, &value) >= 0;
}

/* Omits the key `depth` in a stack, because its scale has the depths of all its frames. */
static bool
put_attributes(hid_t set, const struct rc_grid *g, bool stack)
{
    bool good = put_number(set, "dx", g->dx) && put_number(set, "dy", g->dy) &&
                put_text(set, "unit", g->unit) && put_text(set, "channel", g->channel);

    for (size_t k = 0; good && k < g->keys; k++)
        if (!stack || strcmp(g->key[k].name, "depth") != 0)
            good = put_text(set, g->key[k].name, g->key[k].value);
    return good;
}

static hid_t
new_set(hid_t file, const char *name, int rank, const hsize_t *size, enum rc_raw raw)
{
    RC_HID space = H5Screate_simple(rank, size, NULL), options = H5Pcreate(H5P_DATASET_CREATE);

    H5Pset_obj_track_times(options, false); /* the same frames give the same bytes */
    return H5Dcreate2(file, name, raw == RC_RAW_F32 ? H5T_IEEE_F32LE : H5T_IEEE_F64LE, space,
                      H5P_DEFAULT, options, H5P_DEFAULT);
}

/* ---- depths along an axis ---- */

struct scale {
    double *at;
    size_t n;
    char name[RC_LABEL];
};

/* The file under construction. */
struct output {
    hid_t file;
    struct scale *scale; /* the names written so far */
    size_t scales;
};

/* The depths of a stack's slices or a section's rows, which the caller frees; NULL if they are unknown or
 * memory is short. */
static double *
depths_of(const struct rc_stack *s, size_t *n)
{
    const struct rc_grid *g = s->layer[0];
    bool section = rc_grid_get(g, "section") != NULL && rc_grid_get(g, "depths") != NULL;
    RC_OWNED double *at = NULL;

    *n = s->n > 1 ? s->n : g->ny;
    if ((s->n == 1 && !section) || (at = malloc(*n * sizeof *at)) == NULL)
        return NULL;
    for (size_t k = 0; s->n > 1 && k < s->n; k++)
        at[k] = rc_stack_depth(s, k);
    return s->n > 1 || rc_export_depths(g, at, NULL) == RC_OK ? rc_give(&at) : NULL;
}

/* Writes the scale; its name is the first of depth, depth_2, ... that is free. */
static bool
put_scale(struct output *o, struct scale *scale)
{
    const hsize_t size = scale->n;
    RC_HID set = -1;

    strcpy(scale->name, "depth");
    for (int k = 2; H5Lexists(o->file, scale->name, H5P_DEFAULT) > 0; k++)
        snprintf(scale->name, sizeof scale->name, "depth_%d", k);
    set = new_set(o->file, scale->name, 1, &size, RC_RAW_F64);
    return set >= 0 &&
           H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, scale->at) >= 0 &&
           H5DSset_scale(set, "depth") >= 0 && put_text(set, "unit", "m");
}

/* Makes the depths the scale of the first axis; a scale of the same depths that was written before
 * is used again. Takes over `at`. */
static bool
attach_depths(struct output *o, hid_t set, double *at, size_t n)
{
    size_t k = 0;
    RC_HID scale = -1;

    while (k < o->scales && (o->scale[k].n != n || memcmp(o->scale[k].at, at, n * sizeof *at) != 0))
        k++;
    if (k < o->scales) {
        free(at);
    } else {
        o->scale[o->scales++] = (struct scale){.at = at, .n = n};
        if (!put_scale(o, &o->scale[k]))
            return false;
    }
    scale = H5Dopen2(o->file, o->scale[k].name, H5P_DEFAULT);
    return scale >= 0 && H5DSattach_scale(set, scale, 0) >= 0 &&
           H5DSset_label(set, 0, "depth") >= 0;
}

/* ---- frames ---- */

static bool
put_layer(hid_t set, const struct rc_stack *s, size_t k)
{
    const struct rc_grid *g = s->layer[k];
    const hsize_t from[3] = {k, 0, 0}, size[3] = {1, g->ny, g->nx};
    RC_HID memory = H5Screate_simple(3, size, NULL), space = H5Dget_space(set);

    if (s->n == 1)
        H5Sselect_all(space);
    else
        H5Sselect_hyperslab(space, H5S_SELECT_SET, from, NULL, size, NULL);
    return H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, g->v) >= 0;
}

static bool
put_stack(struct output *o, const char *name, const struct rc_stack *s, enum rc_raw raw)
{
    const struct rc_grid *g = s->layer[0];
    const hsize_t size[3] = {s->n, g->ny, g->nx};
    bool deep = s->n > 1;
    RC_HID set = new_set(o->file, name, deep ? 3 : 2, deep ? size : size + 1, raw);
    bool good = set >= 0;

    for (size_t k = 0; good && k < s->n; k++)
        good = put_layer(set, s, k);
    return good && put_attributes(set, g, deep);
}

static bool
put_depths(struct output *o, const char *name, const struct rc_stack *s)
{
    size_t n;
    double *at = depths_of(s, &n);
    RC_HID set = at == NULL ? -1 : H5Dopen2(o->file, name, H5P_DEFAULT);

    return at == NULL || attach_depths(o, set, at, n);
}

static enum rc_status
put_image(hid_t file, FILE *out, struct rc_err *err)
{
    ssize_t size;
    RC_OWNED void *bytes = NULL;

    if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 || (size = H5Fget_file_image(file, NULL, 0)) <= 0)
        return rc_err_set(err, "the HDF5 library could not make the file");
    if ((bytes = malloc((size_t)size)) == NULL)
        return rc_err_set(err, "out of memory for a file of %zu bytes", (size_t)size);
    return H5Fget_file_image(file, bytes, (size_t)size) == size
               ? rc_put(out, bytes, (size_t)size, err)
               : rc_err_set(err, "the HDF5 library could not make the file");
}

/* Links must not contain a slash or be a point. */
static void
clean_name(char *name)
{
    for (char *s = name; *s != '\0'; s++)
        if (*s == '/')
            *s = '_';
    if (*name == '\0' || *name == '.')
        *name = '_';
}

static enum rc_status
put_stacks(struct output *o, const struct rc_stack *stack, size_t stacks,
           const struct rc_export_wish *wish, struct rc_err *err)
{
    RC_OWNED struct rc_grid **first = calloc(stacks, sizeof(struct rc_grid *));
    char(*name)[RC_LABEL] = calloc(stacks, sizeof *name);
    enum rc_status status = RC_OK;

    o->scale = calloc(stacks, sizeof *o->scale);
    if (first == NULL || name == NULL || o->scale == NULL)
        status = rc_err_set(err, "out of memory for %zu names", stacks);
    for (size_t a = 0; status == RC_OK && a < stacks; a++)
        first[a] = stack[a].layer[0];
    for (size_t a = 0; status == RC_OK && a < stacks; a++) {
        rc_export_label(name[a], first, stacks, a, stack[a].n == 1);
        clean_name(name[a]);
        if (!put_stack(o, name[a], &stack[a], rc_export_raw(first[a], wish, TYPES)))
            status = rc_err_set(err, "the HDF5 library could not write %s", name[a]);
    }
    for (size_t a = 0; status == RC_OK && a < stacks; a++) /* written last: the names of frames
                                                              have precedence */
        if (!put_depths(o, name[a], &stack[a]))
            status = rc_err_set(err, "the HDF5 library could not write the depths of %s", name[a]);
    for (size_t k = 0; k < o->scales; k++)
        free(o->scale[k].at);
    free(o->scale);
    free(name);
    return status;
}

/* A block of the size of the file that is never touched: it counts the memory of the library. */
static void *
reserve(struct rc_grid *const *frame, size_t frames, const struct rc_export_wish *wish,
        struct rc_err *err)
{
    size_t bytes = GROWTH;
    void *reserved;

    for (size_t k = 0; k < frames; k++)
        bytes += frame[k]->nx * frame[k]->ny * rc_raw_width(rc_export_raw(frame[k], wish, TYPES));
    if ((reserved = malloc(bytes)) == NULL)
        rc_err_set(err, "out of memory for a file of %zu bytes", bytes);
    return reserved;
}

static enum rc_status
hdf5_write(FILE *out, struct rc_grid *const *frame, size_t frames,
           const struct rc_export_wish *wish, struct rc_err *err)
{
    struct output o = {.file = -1};
    RC_HID access = -1;
    struct rc_stack *stack;
    size_t stacks;
    enum rc_status status = rc_stacks_make(&stack, &stacks, frame, frames, err);
    RC_OWNED void *reserved = NULL;

    if (status == RC_OK && (reserved = reserve(frame, frames, wish, err)) == NULL)
        status = RC_FAIL;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, GROWTH, false);
    if (status == RC_OK) {
        o.file = H5Fcreate("export", H5F_ACC_TRUNC, H5P_DEFAULT, access);
        status = o.file < 0 ? rc_err_set(err, "the HDF5 library could not make a file in memory")
                            : put_stacks(&o, stack, stacks, wish, err);
    }
    if (status == RC_OK)
        status = put_image(o.file, out, err);
    H5Fclose(o.file);
    rc_stacks_free(stack, stacks);
    return status;
}

const struct rc_export rc_export_hdf5 = {
    .name = "hdf5",
    .suffixes = ".h5 .hdf5",
    .summary = "HDF5, a dataset for each frame or stack of depths",
    .several = true,
    .types = TYPES,
    .uneven = true,
    .write = hdf5_write,
};
