/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "hdf_internal.h"

#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

enum {
    RECORDS_MOST = 100000 /* most members of a table; most values of an attribute */
};

/* ---- attributes ---- */

static hid_t
open_attribute(struct rc_hdf *h, const char *path, const char *name)
{
    if (H5Aexists_by_name(h->file, path, name, H5P_DEFAULT) <= 0)
        return -1;
    return H5Aopen_by_name(h->file, path, name, H5P_DEFAULT, H5P_DEFAULT);
}

/* The number of values of an attribute; 0 if it is implausibly large, or if there is no attribute. */
static size_t
values_in(hid_t attribute)
{
    RC_HID space = H5Aget_space(attribute);
    hssize_t n = H5Sget_simple_extent_npoints(space);

    return n > 0 && n <= RECORDS_MOST ? (size_t)n : 0;
}

bool
rc_hdf_number(struct rc_hdf *h, const char *path, const char *name, double *value)
{
    RC_HID attribute = open_attribute(h, path, name), type = H5Aget_type(attribute);
    size_t n = values_in(attribute);
    RC_OWNED double *v = NULL;

    if (n == 0 || !rc_hdf_is_number(type) || (v = calloc(n, sizeof *v)) == NULL ||
        H5Aread(attribute, H5T_NATIVE_DOUBLE, v) < 0)
        return false;
    *value = v[0];
    return true;
}

/* The text of a member or attribute at `at`, with the type `type` in memory. */
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
    RC_HID attribute = open_attribute(h, path, name), type = H5Aget_type(attribute);
    RC_HID space = H5Aget_space(attribute);
    RC_OWNED unsigned char *bytes = NULL;
    size_t n = values_in(attribute);

    to[0] = '\0';
    if (n == 0 || H5Tget_class(type) != H5T_STRING ||
        (bytes = calloc(n, H5Tget_size(type))) == NULL || H5Aread(attribute, type, bytes) < 0)
        return to;
    take_text(type, bytes, to, size);
    if (H5Tis_variable_str(type) > 0)
        H5Dvlen_reclaim(type, space, H5P_DEFAULT, bytes);
    return to;
}

/* ---- tables ---- */

/* The numbers of a member that is an array or a list of doubles. */
static void
take_numbers(hid_t type, const unsigned char *at, struct rc_hdf_record *record)
{
    RC_HID of = H5Tget_super(type);
    hsize_t size[RC_HDF_RANK];
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
        record->numbers = n < 4 ? n : 4;
        if (record->numbers > 0)
            memcpy(record->number, at, record->numbers * sizeof *record->number);
    }
}

static void
take_records(hid_t type, const unsigned char *bytes, size_t n, rc_hdf_take_record *take, void *arg)
{
    size_t width = H5Tget_size(type);
    int members = H5Tget_nmembers(type);

    for (size_t k = 0; k < n; k++) {
        struct rc_hdf_record record = {.numbers = 0};
        size_t texts = 0;

        for (unsigned m = 0; m < (unsigned)members; m++) {
            RC_HID member = H5Tget_member_type(type, m);
            const unsigned char *at = bytes + k * width + H5Tget_member_offset(type, m);
            H5T_class_t class = H5Tget_class(member);

            if (class == H5T_STRING && texts < 3)
                take_text(member, at, record.text[texts++], sizeof record.text[0]);
            else if ((class == H5T_VLEN || class == H5T_ARRAY) && record.numbers == 0)
                take_numbers(member, at, &record);
        }
        take(arg, &record);
    }
}

bool
rc_hdf_table(struct rc_hdf *h, const char *path, const char *attribute, rc_hdf_take_record *take,
             void *arg)
{
    RC_HID from = attribute != NULL ? open_attribute(h, path, attribute)
                                    : H5Dopen2(h->file, path, H5P_DEFAULT);
    RC_HID stored = attribute != NULL ? H5Aget_type(from) : H5Dget_type(from);
    RC_HID space = attribute != NULL ? H5Aget_space(from) : H5Dget_space(from);
    RC_HID type = -1;
    RC_OWNED unsigned char *bytes = NULL;
    hssize_t n = H5Sget_simple_extent_npoints(space);

    if (H5Tget_class(stored) == H5T_COMPOUND && n > 0 && n <= RECORDS_MOST)
        type = H5Tget_native_type(stored, H5T_DIR_ASCEND);
    if (type < 0 || (bytes = calloc((size_t)n, H5Tget_size(type))) == NULL ||
        (attribute != NULL ? H5Aread(from, type, bytes)
                           : H5Dread(from, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes)) < 0)
        return false;
    take_records(type, bytes, (size_t)n, take, arg);
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, bytes);
    return true;
}
