#include "hdf.h"

#include <hdf5.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"

static const unsigned char magic[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};

enum {
    GROWTH = 1 << 16,
    ROWS_MOST = 100000, /* of a table */
    RANK_MOST = 8,
};

struct rc_hdf {
    hid_t file;
};

bool
rc_hdf_is(const struct rc_file *file)
{
    return file->size > sizeof magic && memcmp(file->data, magic, sizeof magic) == 0;
}

/* ---- the bytes as they are, where the library would copy them thrice ---- */

static void *
image_malloc(size_t size, H5FD_file_image_op_t op, void *image)
{
    (void)size, (void)op;
    return image;
}

static void *
image_memcpy(void *to, const void *from, size_t size, H5FD_file_image_op_t op, void *image)
{
    (void)op, (void)image;
    if (to != from)
        memmove(to, from, size);
    return to;
}

static void *
image_realloc(void *bytes, size_t size, H5FD_file_image_op_t op, void *image)
{
    (void)bytes, (void)size, (void)op, (void)image;
    return NULL; /* a file that is only read does not grow */
}

static herr_t
image_free(void *bytes, H5FD_file_image_op_t op, void *image)
{
    (void)bytes, (void)op, (void)image;
    return 0;
}

static void *
image_share(void *image)
{
    return image;
}

static herr_t
image_leave(void *image)
{
    (void)image;
    return 0;
}

static bool
set_image(hid_t access, const struct rc_file *file)
{
    void *image = (void *)(uintptr_t)file->data; /* opened to be read: nothing is written to it */
    H5FD_file_image_callbacks_t callbacks = {
        .image_malloc = image_malloc,   .image_memcpy = image_memcpy,
        .image_realloc = image_realloc, .image_free = image_free,
        .udata_copy = image_share,      .udata_free = image_leave,
        .udata = image};

    return H5Pset_fapl_core(access, GROWTH, false) >= 0 &&
           H5Pset_file_image_callbacks(access, &callbacks) >= 0 &&
           H5Pset_file_image(access, image, file->size) >= 0;
}

struct rc_hdf *
rc_hdf_new(const struct rc_file *file, struct rc_err *err)
{
    struct rc_hdf *h = calloc(1, sizeof *h);
    hid_t access;

    if (h == NULL) {
        rc_err_set(err, "out of memory for reading HDF5");
        return NULL;
    }
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* what matters is said here */
    access = H5Pcreate(H5P_FILE_ACCESS);
    h->file = set_image(access, file) ? H5Fopen("file", H5F_ACC_RDONLY, access) : -1;
    H5Pclose(access);
    if (h->file >= 0)
        return h;
    rc_err_set(err, "no HDF5 file, or one that is damaged or cut off");
    free(h);
    return NULL;
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

static bool
is_number(hid_t type)
{
    H5T_class_t class = H5Tget_class(type);

    return class == H5T_INTEGER || class == H5T_FLOAT;
}

static bool
shape_of(hid_t set, struct rc_hdf_set *to)
{
    hid_t space = H5Dget_space(set), type = H5Dget_type(set);
    hsize_t size[RANK_MOST], last[2] = {0, 0};
    int rank = H5Sget_simple_extent_ndims(space), wide = 0;
    bool good = rank >= 2 && rank <= RANK_MOST && is_number(type) &&
                H5Sget_simple_extent_dims(space, size, NULL) == rank;

    for (int k = 0; good && k < rank; k++)
        if (size[k] != 1 || rank - k <= 2 - wide) { /* ones in front are no dimension of a map */
            good = wide < 2 && size[k] > 0;
            if (good)
                last[wide++] = size[k];
        }
    to->rows = (size_t)last[0];
    to->columns = (size_t)last[1];
    H5Tclose(type);
    H5Sclose(space);
    return good && wide == 2;
}

bool
rc_hdf_set_at(struct rc_hdf *h, const char *path, struct rc_hdf_set *to)
{
    hid_t set = H5Dopen2(h->file, path, H5P_DEFAULT);
    bool good = set >= 0 && strlen(path) < sizeof to->path && shape_of(set, to);

    if (good)
        strcpy(to->path, path);
    if (set >= 0)
        H5Dclose(set);
    return good;
}

struct search {
    struct rc_hdf *hdf;
    struct rc_hdf_set *set;
    size_t n, most;
};

static herr_t
visit(hid_t from, const char *name, const H5O_info_t *info, void *arg)
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

    H5Ovisit2(h->file, H5_INDEX_NAME, H5_ITER_INC, visit, &s, H5O_INFO_BASIC);
    return s.n;
}

enum rc_status
rc_hdf_values(struct rc_hdf *h, const struct rc_hdf_set *from, double *v, struct rc_err *err)
{
    hid_t set = H5Dopen2(h->file, from->path, H5P_DEFAULT);
    bool good = set >= 0 &&
                H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, v) >= 0;

    if (set >= 0)
        H5Dclose(set);
    if (good)
        return RC_OK;
    return rc_err_set(err, "the dataset '%s' cannot be unpacked: the file is damaged, needs more "
                           "memory than it may take, or is packed by a filter that libhdf5 does "
                           "not have here", from->path);
}

/* ---- attributes ---- */

static hid_t
open_attribute(struct rc_hdf *h, const char *path, const char *name)
{
    if (H5Aexists_by_name(h->file, path, name, H5P_DEFAULT) <= 0)
        return -1;
    return H5Aopen_by_name(h->file, path, name, H5P_DEFAULT, H5P_DEFAULT);
}

/* How many values an attribute has; 0 for more than can be meant. */
static size_t
values_in(hid_t attribute)
{
    hid_t space = H5Aget_space(attribute);
    hssize_t n = H5Sget_simple_extent_npoints(space);

    H5Sclose(space);
    return n > 0 && n <= ROWS_MOST ? (size_t)n : 0;
}

bool
rc_hdf_number(struct rc_hdf *h, const char *path, const char *name, double *value)
{
    hid_t attribute = open_attribute(h, path, name), type;
    size_t n;
    double *v = NULL;
    bool good = false;

    if (attribute < 0)
        return false;
    type = H5Aget_type(attribute);
    n = values_in(attribute);
    if (n > 0 && is_number(type) && (v = malloc(n * sizeof *v)) != NULL &&
        H5Aread(attribute, H5T_NATIVE_DOUBLE, v) >= 0) {
        *value = v[0];
        good = true;
    }
    free(v);
    H5Tclose(type);
    H5Aclose(attribute);
    return good;
}

/* Text of a member or attribute at `at`, whose type in memory is `type`. */
static void
take_text(hid_t type, const unsigned char *at, char *to, size_t size)
{
    const char *text = (const char *)at;
    size_t n = H5Tget_size(type);

    if (H5Tis_variable_str(type) > 0) {
        memcpy(&text, at, sizeof text);
        n = text == NULL ? 0 : strlen(text);
    } else if (memchr(text, '\0', n) != NULL) {
        n = strlen(text);
    }
    rc_text_clean(to, size, n == 0 ? "" : text, n);
}

char *
rc_hdf_text(struct rc_hdf *h, const char *path, const char *name, char *to, size_t size)
{
    hid_t attribute = open_attribute(h, path, name), type, space;
    unsigned char *bytes = NULL;
    size_t n;

    to[0] = '\0';
    if (attribute < 0)
        return to;
    type = H5Aget_type(attribute);
    space = H5Aget_space(attribute);
    n = values_in(attribute);
    if (n > 0 && H5Tget_class(type) == H5T_STRING &&
        (bytes = calloc(n, H5Tget_size(type))) != NULL && H5Aread(attribute, type, bytes) >= 0) {
        take_text(type, bytes, to, size);
        if (H5Tis_variable_str(type) > 0)
            H5Dvlen_reclaim(type, space, H5P_DEFAULT, bytes);
    }
    free(bytes);
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(attribute);
    return to;
}

/* ---- tables ---- */

/* Numbers of a member that is an array or a list of doubles. */
static void
take_numbers(hid_t type, const unsigned char *at, struct rc_hdf_row *row)
{
    hid_t of = H5Tget_super(type);
    hsize_t size[RANK_MOST];
    size_t n = 0;

    if (of >= 0 && H5Tequal(of, H5T_NATIVE_DOUBLE) > 0) {
        if (H5Tget_class(type) == H5T_VLEN) {
            hvl_t list;
            memcpy(&list, at, sizeof list);
            at = list.p;
            n = at == NULL ? 0 : list.len;
        } else if (H5Tget_array_ndims(type) == 1 && H5Tget_array_dims2(type, size) == 1) {
            n = (size_t)size[0];
        }
        row->numbers = n < 4 ? n : 4;
        if (row->numbers > 0)
            memcpy(row->number, at, row->numbers * sizeof *row->number);
    }
    H5Tclose(of);
}

static void
take_rows(hid_t type, const unsigned char *bytes, size_t n, rc_hdf_take_row *take, void *arg)
{
    size_t width = H5Tget_size(type);
    int members = H5Tget_nmembers(type);

    for (size_t k = 0; k < n; k++) {
        struct rc_hdf_row row = {.numbers = 0};
        size_t texts = 0;

        for (unsigned m = 0; m < (unsigned)members; m++) {
            hid_t member = H5Tget_member_type(type, m);
            const unsigned char *at = bytes + k * width + H5Tget_member_offset(type, m);
            H5T_class_t class = H5Tget_class(member);

            if (class == H5T_STRING && texts < 3)
                take_text(member, at, row.text[texts++], sizeof row.text[0]);
            else if ((class == H5T_VLEN || class == H5T_ARRAY) && row.numbers == 0)
                take_numbers(member, at, &row);
            H5Tclose(member);
        }
        take(arg, &row);
    }
}

bool
rc_hdf_table(struct rc_hdf *h, const char *path, const char *attribute, rc_hdf_take_row *take,
             void *arg)
{
    hid_t from = attribute != NULL ? open_attribute(h, path, attribute)
                                   : H5Dopen2(h->file, path, H5P_DEFAULT);
    hid_t stored = -1, type = -1, space = -1;
    unsigned char *bytes = NULL;
    bool good = false;
    hssize_t n;

    if (from < 0)
        return false;
    stored = attribute != NULL ? H5Aget_type(from) : H5Dget_type(from);
    space = attribute != NULL ? H5Aget_space(from) : H5Dget_space(from);
    n = H5Sget_simple_extent_npoints(space);
    if (H5Tget_class(stored) == H5T_COMPOUND && n > 0 && n <= ROWS_MOST)
        type = H5Tget_native_type(stored, H5T_DIR_ASCEND);
    if (type >= 0 && (bytes = calloc((size_t)n, H5Tget_size(type))) != NULL)
        good = (attribute != NULL
                    ? H5Aread(from, type, bytes)
                    : H5Dread(from, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes)) >= 0;
    if (good) {
        take_rows(type, bytes, (size_t)n, take, arg);
        H5Dvlen_reclaim(type, space, H5P_DEFAULT, bytes);
    }
    free(bytes);
    H5Tclose(type);
    H5Tclose(stored);
    H5Sclose(space);
    if (attribute != NULL)
        H5Aclose(from);
    else
        H5Dclose(from);
    return good;
}
