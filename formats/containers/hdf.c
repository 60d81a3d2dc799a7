/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "hdf_internal.h"

#include <hdf5_hl.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

static const unsigned char magic[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};

bool
rc_hdf_is(const struct rc_file *file)
{
    return file->size > sizeof magic && rc_file_holds(file, 0, magic, sizeof magic);
}

struct rc_hdf *
rc_hdf_new(const struct rc_file *file, struct rc_err *err)
{
    RC_OWNED struct rc_hdf *h = calloc(1, sizeof *h);
    const unsigned as_it_is = H5LT_FILE_IMAGE_DONT_COPY | H5LT_FILE_IMAGE_DONT_RELEASE;

    if (h == NULL)
        return rc_err_null(err, "out of memory for reading HDF5");
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* errors are reported here, not by the library */
    /* opened for reading: HDF5 does not write to the bytes */
    h->file = H5LTopen_file_image((void *)(uintptr_t)file->data, file->size, as_it_is);
    if (h->file >= 0)
        return rc_give(&h);
    return rc_err_null(err, "not an HDF5 file, or the file is damaged or cut off");
}

void
rc_hdf_free(struct rc_hdf *h)
{
    if (h == NULL)
        return;
    H5Fclose(h->file);
    free(h);
}

/* ---- datasets ---- */

bool
rc_hdf_is_number(hid_t type)
{
    H5T_class_t class = H5Tget_class(type);

    return class == H5T_INTEGER || class == H5T_FLOAT;
}

static bool
shape_of(hid_t set, struct rc_hdf_set *to)
{
    RC_HID space = H5Dget_space(set), type = H5Dget_type(set);
    hsize_t size[RC_HDF_RANK], last[2] = {0, 0};
    int rank = H5Sget_simple_extent_ndims(space), wide = 0;
    bool good = rank >= 2 && rank <= RC_HDF_RANK && rc_hdf_is_number(type) &&
                H5Sget_simple_extent_dims(space, size, NULL) == rank;

    for (int k = 0; good && k < rank; k++)
        if (size[k] != 1 || rank - k <= 2 - wide) { /* leading dimensions of length 1 are ignored */
            good = wide < 2 && size[k] > 0;
            if (good)
                last[wide++] = size[k];
        }
    /* a size that exceeds the memory remains too large: sizes in the file have 64 bits on every machine */
    to->rows = last[0] < SIZE_MAX ? (size_t)last[0] : SIZE_MAX;
    to->columns = last[1] < SIZE_MAX ? (size_t)last[1] : SIZE_MAX;
    return good && wide == 2;
}

bool
rc_hdf_set_at(struct rc_hdf *h, const char *path, struct rc_hdf_set *to)
{
    RC_HID set = H5Dopen2(h->file, path, H5P_DEFAULT);

    if (set < 0 || strlen(path) >= sizeof to->path || !shape_of(set, to))
        return false;
    strcpy(to->path, path);
    return true;
}

struct search {
    struct rc_hdf *hdf;
    struct rc_hdf_set *set;
    size_t n, most;
};

/* HDF5 1.12 describes objects in another structure, from a function with another name. */
#if H5_VERSION_GE(1, 12, 0)
#define visit_objects H5Ovisit3
#define object_info H5O_info2_t
#else
#define visit_objects H5Ovisit2
#define object_info H5O_info_t
#endif

static herr_t
visit(hid_t from, const char *name, const object_info *info, void *arg)
{
    struct search *s = arg;
    struct rc_hdf_set set;

    (void)from;
    if (info->type != H5O_TYPE_DATASET || !rc_hdf_set_at(s->hdf, name, &set))
        return 0;
    if (s->n < s->most)
        s->set[s->n] = set;
    s->n++;
    return 0;
}

size_t
rc_hdf_sets(struct rc_hdf *h, struct rc_hdf_set *set, size_t most)
{
    struct search s = {.hdf = h, .set = set, .most = most};

    visit_objects(h->file, H5_INDEX_NAME, H5_ITER_INC, visit, &s, H5O_INFO_BASIC);
    return s.n;
}

enum rc_status
rc_hdf_values(struct rc_hdf *h, const struct rc_hdf_set *from, double *v, struct rc_err *err)
{
    RC_HID set = H5Dopen2(h->file, from->path, H5P_DEFAULT);

    if (set >= 0 && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, v) >= 0)
        return RC_OK;
    return rc_err_set(err,
                      "the dataset '%s' cannot be unpacked: the file is damaged, needs more memory "
                      "than it may take, or is packed by a filter that libhdf5 does not have here",
                      from->path);
}
