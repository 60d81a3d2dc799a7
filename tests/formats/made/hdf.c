/* SPDX-License-Identifier: GPL-3.0-or-later */
/* HDF5 files made in memory. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "made.h"

const double hdf_counts[6] = {1, 2, 3, 100, 5, 6};

hid_t
hdf_start(void)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS), file;

    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    H5Pset_fapl_core(access, 1 << 16, false);
    file = H5Fcreate("made", H5F_ACC_TRUNC, H5P_DEFAULT, access);
    assert_true(file >= 0);
    H5Pclose(access);
    return file;
}

struct bytes
hdf_end(hid_t file)
{
    struct bytes b = {0};

    H5Fflush(file, H5F_SCOPE_GLOBAL);
    b.n = (size_t)H5Fget_file_image(file, NULL, 0);
    b.data = malloc(b.n);
    assert_true(H5Fget_file_image(file, b.data, b.n) == (ssize_t)b.n);
    H5Fclose(file);
    return b;
}

void
hdf_number(hid_t set, const char *name, double value)
{
    const hsize_t one = 1;
    hid_t space = H5Screate_simple(1, &one, NULL);
    hid_t a = H5Acreate2(set, name, H5T_IEEE_F64BE, space, H5P_DEFAULT, H5P_DEFAULT);

    assert_true(H5Awrite(a, H5T_NATIVE_DOUBLE, &value) >= 0);
    H5Aclose(a);
    H5Sclose(space);
}

void
hdf_text(hid_t set, const char *name, const char *text, bool variable)
{
    const hsize_t one = 1;
    hid_t space = H5Screate_simple(1, &one, NULL), type = H5Tcopy(H5T_C_S1), a;

    H5Tset_size(type, variable ? H5T_VARIABLE : strlen(text));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    a = H5Acreate2(set, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(a, type, variable ? (const void *)&text : text) >= 0);
    H5Aclose(a);
    H5Tclose(type);
    H5Sclose(space);
}

hid_t
hdf_set(hid_t in, const char *name, hid_t type, int rank, const hsize_t *size, const hsize_t *chunk)
{
    hid_t space = H5Screate_simple(rank, size, NULL), options = H5Pcreate(H5P_DATASET_CREATE), set;

    if (chunk != NULL) {
        H5Pset_chunk(options, rank, chunk);
        H5Pset_shuffle(options);
        H5Pset_deflate(options, 6);
    }
    set = H5Dcreate2(in, name, type, space, H5P_DEFAULT, options, H5P_DEFAULT);
    assert_true(set >= 0);
    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, hdf_counts) >= 0);
    H5Pclose(options);
    H5Sclose(space);
    return set;
}

struct bytes
hdf_plain(void)
{
    const hsize_t size[] = {2, 3};
    hid_t file = hdf_start(), set = hdf_set(file, "z", H5T_IEEE_F64LE, 2, size, NULL);

    hdf_number(set, "dx", 1e-6);
    hdf_number(set, "dy", 1e-6);
    hdf_text(set, "unit", "m", false);
    H5Dclose(set);
    return hdf_end(file);
}
