/*
 * HDF5: a dataset for each frame, rows by columns, named by its channel. Its attributes are dx and
 * dy (m), unit, channel, and every key of the frame as text; a missing point is NaN.
 *
 * The library wants to seek, so it makes the file in memory.
 */
#include <hdf5.h>
#include <stdlib.h>
#include <string.h>

#include "encode.h"
#include "formats/export.h"

enum {
    TYPES = RC_TYPE_F32 | RC_TYPE_F64,
    GROWTH = 1 << 20 /* bytes that the file in memory grows by */
};

static bool
put_number(hid_t set, const char *name, double value)
{
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(set, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT);
    bool good = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0;

    H5Aclose(attribute);
    H5Sclose(space);
    return good;
}

static bool
put_text(hid_t set, const char *name, const char *value)
{
    hid_t space = H5Screate(H5S_SCALAR), type = H5Tcopy(H5T_C_S1), attribute;
    bool good;

    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    attribute = H5Acreate2(set, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    good = attribute >= 0 && H5Awrite(attribute, type, &value) >= 0;
    H5Aclose(attribute);
    H5Tclose(type);
    H5Sclose(space);
    return good;
}

static bool
put_attributes(hid_t set, const struct rc_grid *g)
{
    bool good = put_number(set, "dx", g->dx) && put_number(set, "dy", g->dy) &&
                put_text(set, "unit", g->unit) && put_text(set, "channel", g->channel);

    for (size_t k = 0; good && k < g->keys; k++)
        good = put_text(set, g->key[k].name, g->key[k].value);
    return good;
}

static bool
put_frame(hid_t file, const char *name, const struct rc_grid *g, enum rc_raw raw)
{
    const hsize_t size[2] = {g->ny, g->nx};
    hid_t space = H5Screate_simple(2, size, NULL), options = H5Pcreate(H5P_DATASET_CREATE), set;
    bool good;

    H5Pset_obj_track_times(options, false); /* the same frames give the same bytes */
    set = H5Dcreate2(file, name, raw == RC_RAW_F32 ? H5T_IEEE_F32LE : H5T_IEEE_F64LE, space,
                     H5P_DEFAULT, options, H5P_DEFAULT);
    good = set >= 0 && H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, g->v) >= 0 &&
           put_attributes(set, g);
    H5Dclose(set);
    H5Pclose(options);
    H5Sclose(space);
    return good;
}

static enum rc_status
put_image(hid_t file, FILE *out, struct rc_err *err)
{
    enum rc_status status;
    ssize_t size;
    void *bytes;

    if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0 || (size = H5Fget_file_image(file, NULL, 0)) <= 0)
        return rc_err_set(err, "the HDF5 library could not make the file");
    if ((bytes = malloc((size_t)size)) == NULL)
        return rc_err_set(err, "out of memory for a file of %zu bytes", (size_t)size);
    status = H5Fget_file_image(file, bytes, (size_t)size) == size
                 ? rc_put(out, bytes, (size_t)size, err)
                 : rc_err_set(err, "the HDF5 library could not make the file");
    free(bytes);
    return status;
}

/* Links may not hold a slash or be a point. */
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
hdf5_write(FILE *out, struct rc_grid *const *frame, size_t frames,
           const struct rc_export_wish *wish, struct rc_err *err)
{
    enum rc_status status = RC_FAIL;
    char name[RC_LABEL];
    hid_t access, file;

    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, GROWTH, false);
    file = H5Fcreate("export", H5F_ACC_TRUNC, H5P_DEFAULT, access);
    if (file < 0) {
        rc_err_set(err, "the HDF5 library could not make a file in memory");
        goto done;
    }
    for (size_t k = 0; k < frames; k++) {
        rc_export_label(name, frame, frames, k, true);
        clean_name(name);
        if (!put_frame(file, name, frame[k], rc_export_raw(frame[k], wish, TYPES))) {
            rc_err_set(err, "the HDF5 library could not write frame %zu (%s)", k + 1, name);
            goto done;
        }
    }
    status = put_image(file, out, err);
done:
    H5Fclose(file);
    H5Pclose(access);
    return status;
}

const struct rc_export rc_export_hdf5 = {
    .name = "hdf5",
    .suffixes = ".h5 .hdf5",
    .summary = "HDF5, a dataset for each frame",
    .several = true,
    .types = TYPES,
    .write = hdf5_write,
};
