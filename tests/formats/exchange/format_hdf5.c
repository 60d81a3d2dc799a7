/* SPDX-License-Identifier: GPL-3.0-or-later */
/* HDF5 files made by this test are read; files with links to other files, and decompression bombs, are
 * refused. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <hdf5.h>

#include "tests/formats/made/made.h"

extern const struct rc_format rc_format_hdf5;

static void
hdf5_is_read(void **state)
{
    const hid_t types[] = {H5T_STD_I8LE,  H5T_STD_U16BE,  H5T_STD_I32LE,
                           H5T_STD_U64BE, H5T_IEEE_F32BE, H5T_IEEE_F64LE};
    const hsize_t flat[] = {2, 3}, deep[] = {1, 2, 3}, chunk[] = {2, 2}, column[] = {6};
    const double v[6] = {1e-9, 2e-9, 3e-9, NAN, 5e-9, 6e-9};

    (void)state;
    for (size_t k = 0; k < sizeof types / sizeof *types; k++)
        for (int way = 0; way < 3; way++) {
            hid_t file = hdf_start(), group, set;
            struct rc_channel channel[4];
            struct rc_file made;
            struct rc_grid *g;
            struct bytes b;

            group = H5Gcreate2(file, "scan", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
            H5Dclose(hdf_set(file, "a list", types[k], 1, column, NULL));
            set = way == 2 ? hdf_set(group, "z", types[k], 3, deep, NULL)
                           : hdf_set(group, "z", types[k], 2, flat, way == 1 ? chunk : NULL);
            hdf_number(set, "dx", 1.1e-6);
            hdf_number(set, "dy", 1.3e-6);
            hdf_text(set, way == 1 ? "units" : "unit", "nm", way == 1);
            hdf_number(set, "_FillValue", 100);
            H5Dclose(set);
            H5Gclose(group);
            b = hdf_end(file);
            made = file_of(&b, "made");
            assert_ptr_equal(rc_format_find(&made, NULL), &rc_format_hdf5);
            assert_int_equal(list_maps(&rc_format_hdf5, &made, &rc_no_wish, channel, 4, NULL), 1);
            assert_string_equal(channel->name, "scan/z");
            assert_string_equal(channel->unit, "m");
            g = read_well(&rc_format_hdf5, &b, 0);
            check_map(g, 3, 2, 1.1e-6, 1.3e-6, v);
            rc_grid_free(g);
            drop(&b);
        }
}

/* A small file cannot make the reader open another file and return its content as heights. */
static void
hdf5_stays_in_its_file(void **state)
{
    const hsize_t size[] = {4, 8};
    hid_t file = hdf_start(), space = H5Screate_simple(2, size, NULL);
    hid_t options = H5Pcreate(H5P_DATASET_CREATE), set;
    struct rc_wish wish = {.dx = 1, .dy = 1, .z_unit = 1};
    struct rc_err err;
    struct bytes b;

    (void)state;
    H5Pset_external(options, "/etc/passwd", 0, 32);
    set = H5Dcreate2(file, "stolen", H5T_STD_U8LE, space, H5P_DEFAULT, options, H5P_DEFAULT);
    assert_true(set >= 0);
    H5Dclose(set);
    H5Pclose(options);
    H5Sclose(space);
    H5Lcreate_external("/tmp/other.h5", "/z", file, "elsewhere", H5P_DEFAULT, H5P_DEFAULT);
    b = hdf_end(file);
    assert_null(try_read(&rc_format_hdf5, &b, &wish, 0, &err));
    assert_non_null(strstr(err.text, "'stolen' cannot be unpacked"));
    drop(&b);
}

/* Randomly changed HDF5 files, read without the sandbox, make libhdf5 1.10.8 read beyond its memory
 * (RC_FUZZ=10 RC_FUZZ_BYPASS=1): the sandbox protects against this. A file of a few hundred KiB holds 128 MiB
 * of zeros: as a map, and as one chunk of a tiny map. */
static void
hdf5_bombs(void **state)
{
    const hsize_t size[] = {4096, 4096}, small[] = {2, 2}, any[] = {H5S_UNLIMITED, H5S_UNLIMITED};
    struct rc_wish wish = {.dx = 1, .dy = 1, .z_unit = 1};

    (void)state;
    for (int way = 0; way < 2; way++) {
        hid_t file = hdf_start(), options = H5Pcreate(H5P_DATASET_CREATE), set;
        hid_t space = way == 0 ? H5Screate_simple(2, size, NULL) : H5Screate_simple(2, small, any);
        double *zeros = calloc(4096 * 4096, sizeof *zeros);
        struct rc_err err;
        struct bytes b;

        H5Pset_chunk(options, 2, size);
        H5Pset_deflate(options, 1);
        set = H5Dcreate2(file, "z", H5T_IEEE_F64LE, space, H5P_DEFAULT, options, H5P_DEFAULT);
        assert_true(set >= 0);
        assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros) >= 0);
        free(zeros);
        H5Dclose(set);
        H5Pclose(options);
        H5Sclose(space);
        b = hdf_end(file);
        assert_null(try_read(&rc_format_hdf5, &b, &wish, 0, &err));
        printf("a bomb of %zu bytes: %s\n", b.n, err.text);
        assert_non_null(strstr(err.text, way == 0 ? "more than the" : "cannot be unpacked"));
        drop(&b);
    }
}

/* Sizes have 64 bits in a file and may have 32 bits in memory. A number of rows whose lower half is 2 must
 * not count as 2. */
static void
hdf5_sizes_are_whole(void **state)
{
    const hsize_t size[] = {((hsize_t)1 << 32) + 2, 3}, chunk[] = {2, 3};
    const struct rc_wish wish = {.dx = 1, .dy = 1, .z_unit = 1};
    hid_t file = hdf_start(), options = H5Pcreate(H5P_DATASET_CREATE), set;
    hid_t space = H5Screate_simple(2, size, NULL);
    struct rc_err err;
    struct bytes b;

    (void)state;
    H5Pset_chunk(options, 2, chunk); /* the file holds no chunk: all values are 0 */
    set = H5Dcreate2(file, "z", H5T_IEEE_F64LE, space, H5P_DEFAULT, options, H5P_DEFAULT);
    assert_true(set >= 0);
    H5Dclose(set);
    H5Pclose(options);
    H5Sclose(space);
    b = hdf_end(file);
    assert_null(try_read(&rc_format_hdf5, &b, &wish, 0, &err));
    if (strstr(err.text, "more than") == NULL)
        fail_msg("refused for '%s'", err.text);
    drop(&b);
}

static void
hdf5_is_refused(void **state)
{
    struct bytes b = hdf_plain();
    hid_t file;

    (void)state;
    refuse_cuts(&rc_format_hdf5, &b, b.n, 31);
    survive_changes(&rc_format_hdf5, &b, 200);
    drop(&b);
    file = hdf_start();
    b = hdf_end(file);
    refuse(&rc_format_hdf5, &b, "no dataset of numbers with two dimensions");
    drop(&b);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hdf5_is_read),    cmocka_unit_test(hdf5_stays_in_its_file),
        cmocka_unit_test(hdf5_bombs),      cmocka_unit_test(hdf5_sizes_are_whole),
        cmocka_unit_test(hdf5_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
