/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The channels of a MAT file, refused files, and damaged files. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <hdf5.h>

#include "tests/formats/made/made.h"

extern const struct rc_format rc_format_mat, rc_format_mat73;

enum {
    MI_DOUBLE = 9,
    CELL = 1,
    STRUCT = 2,
    SPARSE = 5,
    DOUBLE = 6,
    COMPLEX = 0x800
};

/* Doubles 0 to n - 1 times a factor. */
static struct bytes
rising(size_t n, double factor)
{
    struct bytes b = {0};

    for (size_t k = 0; k < n; k++)
        add_f64(&b, factor * (double)k);
    return b;
}

static void
add_rising(struct bytes *m, const char *name, unsigned flags, size_t rows, size_t columns,
           double factor)
{
    struct bytes b = rising(rows * columns, factor);

    mat_array(m, name, flags, rows, columns, MI_DOUBLE, b.data, b.n);
    drop(&b);
}

/* Several arrays are several channels; single numbers are not channels; the unit then applies to none of
 * them. */
static void
several_arrays(void **state)
{
    struct bytes m = {0};
    struct rc_channel channel[4];
    struct rc_file file;

    (void)state;
    mat_header(&m, false);
    mat_number(&m, "dx", 2);
    mat_text(&m, "dunit", "um");
    mat_text(&m, "unit", "nm");
    add_rising(&m, "phase", DOUBLE, 3, 4, 1);
    add_rising(&m, "Z", DOUBLE, 3, 4, 1);
    add_rising(&m, "row", DOUBLE, 1, 9, 1);
    file = file_of(&m, "a.mat");
    assert_int_equal(list_maps(&rc_format_mat, &file, &rc_no_wish, channel, 4, NULL), 2);
    assert_string_equal(channel[0].name, "phase");
    assert_string_equal(channel[1].name, "Z");
    assert_string_equal(channel[1].unit, "");
    assert_int_equal(channel[1].nx, 4);
    assert_int_equal(channel[1].ny, 3);
    assert_true(fabs(channel[1].dx - 2e-6) < 1e-20 && channel[1].dy == channel[1].dx);
    assert_int_equal(rc_format_topography(channel, 2, NULL).index, 1);
    drop(&m);
}

/* A vector is a profile if the file has no map, also if x is the only vector. */
static void
vectors(void **state)
{
    static const double wanted[] = {0, 1e-9, 2e-9, 3e-9};
    struct rc_wish wish = rc_no_wish;
    struct bytes m = {0};
    struct rc_err err;
    struct rc_grid *g;

    (void)state;
    mat_header(&m, false);
    add_rising(&m, "x", DOUBLE, 4, 1, 0.5);
    add_rising(&m, "h", DOUBLE, 1, 4, 1);
    mat_text(&m, "dunit", "mm");
    mat_text(&m, "unit", "nm");
    g = read_well(&rc_format_mat, &m, 0);
    check_map(g, 4, 1, 0.5e-3, 0.5e-3, wanted);
    rc_grid_free(g);
    m.n = 128;
    add_rising(&m, "x", DOUBLE, 4, 1, 1);
    wish.dx = 1;
    wish.z_unit = 1e-9;
    g = try_read(&rc_format_mat, &m, &wish, 0, &err);
    assert_non_null(g);
    check_map(g, 4, 1, 1, 1, wanted);
    rc_grid_free(g);
    drop(&m);
}

static void
refusals(void **state)
{
    static const struct {
        const char *name;
        unsigned flags;
        const char *why;
    } rows[] = {
        {"s", STRUCT, "'s' is a struct"},
        {"c", CELL, "'c' is a cell array"},
        {"p", SPARSE, "'p' is sparse"},
        {"z", DOUBLE | COMPLEX, "'z' is complex"},
    };
    struct bytes m = {0};

    (void)state;
    mat_header(&m, false);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        m.n = 128;
        add_rising(&m, rows[k].name, rows[k].flags, 3, 4, 1);
        refuse(&rc_format_mat, &m, rows[k].why);
    }
    m.n = 128;
    add_rising(&m, "", DOUBLE, 3, 4, 1); /* the workspace of functions */
    refuse(&rc_format_mat, &m, "no real array of numbers with two dimensions: save");
    m.n = 128;
    mat_number(&m, "one", 1);
    refuse(&rc_format_mat, &m, "'one' is one number, or empty");
    m.n = 128;
    add_rising(&m, "h", DOUBLE, 3, 4, 1);
    refuse(&rc_format_mat, &m, "--dx LENGTH"); /* and the message asks for the unit too */
    mat_number(&m, "dx", 0.5);
    refuse(&rc_format_mat, &m, "its steps are 0.5 and 0.5 of a unit not given");
    m.n = 128;
    add_rising(&m, "x", DOUBLE, 1, 4, 1);
    m.data[m.n - 1] = 0x41; /* the last position is far away */
    add_rising(&m, "y", DOUBLE, 1, 3, 1);
    add_rising(&m, "h", DOUBLE, 3, 4, 1);
    refuse(&rc_format_mat, &m, "the positions of the axis 'x' are not evenly spaced");
    m.n = 128;
    add_rising(&m, "h", DOUBLE, 3, 4, 1);
    set_raw(&m, 128 + 8 + 16 + 8, RC_RAW_I32, 4); /* 4 rows */
    refuse(&rc_format_mat, &m, "the header promises 128 bytes of h, the file has 96");
    m.n = 60;
    refuse(&rc_format_mat, &m, "no MAT file of version 5");
    drop(&m);
}

/* A file with a wrong checksum of zlib is refused. */
static void
damaged_packing(void **state)
{
    struct bytes m = {0};

    (void)state;
    make_mat(&m, 1);
    m.data[m.n - 1] ^= 1;
    refuse(&rc_format_mat, &m, "the compressed numbers are damaged");
    drop(&m);
}

static void
cuts_and_changes(void **state)
{
    (void)state;
    for (int variant = 0; variant < 5; variant++) {
        struct bytes m = {0};

        make_mat(&m, variant);
        survive_changes(&rc_format_mat, &m, 3000);
        drop(&m);
    }
}

/* ---- version 7.3 ---- */

static void
hdf_variable(hid_t file, const char *name, const char *class, hsize_t columns, hsize_t rows,
             const double *v)
{
    const hsize_t size[] = {columns, rows};
    hid_t space = H5Screate_simple(2, size, NULL);
    hid_t set = H5Dcreate2(file, name, strcmp(class, "char") == 0 ? H5T_STD_U16LE : H5T_IEEE_F64LE,
                           space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);

    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, v) >= 0);
    hdf_text(set, "MATLAB_class", class, false);
    H5Dclose(set);
    H5Sclose(space);
}

static struct bytes
hdf_behind_header(hid_t file)
{
    struct bytes b = {0}, hdf = hdf_end(file);

    add_text(&b, "MATLAB 7.3 MAT-file, made by hand");
    add_zeros(&b, 124 - b.n);
    add(&b, "\0\2IM", 4);
    add_zeros(&b, 512 - b.n);
    add(&b, hdf.data, hdf.n);
    drop(&hdf);
    return b;
}

/* Arrays are transposed, fields of structs are not variables, and a file without an array is refused. */
static void
version_7_3(void **state)
{
    /* column after column, as in MATLAB */
    static const double v[] = {1, 4, 2, NAN, 3, 6}, steps[] = {2, 3}, um[] = {'u', 'm'};
    static const double nm[] = {'n', 'm'}, wanted[] = {1e-9, 2e-9, 3e-9, 4e-9, NAN, 6e-9};
    struct rc_channel channel[4];
    hid_t file = hdf_start(), group;
    struct rc_file made;
    struct rc_grid *g;
    struct bytes b;

    (void)state;
    group = H5Gcreate2(file, "s", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    hdf_variable(group, "field", "double", 3, 2, v);
    H5Gclose(group);
    hdf_variable(file, "dunit", "char", 2, 1, um);
    hdf_variable(file, "dx", "double", 1, 1, steps);
    hdf_variable(file, "dy", "double", 1, 1, steps + 1);
    hdf_variable(file, "h", "double", 3, 2, v);
    hdf_variable(file, "l", "logical", 3, 2, v);
    hdf_variable(file, "unit", "char", 2, 1, nm);
    b = hdf_behind_header(file);
    made = file_of(&b, "made");
    assert_ptr_equal(rc_format_find(&made, NULL), &rc_format_mat73);
    assert_int_equal(list_maps(&rc_format_mat73, &made, &rc_no_wish, channel, 4, NULL), 1);
    assert_string_equal(channel->name, "h");
    g = read_well(&rc_format_mat73, &b, 0);
    check_map(g, 3, 2, 2e-6, 3e-6, wanted);
    rc_grid_free(g);
    refuse_cuts(&rc_format_mat73, &b, b.n - 1, b.n / 7);
    survive_changes(&rc_format_mat73, &b, 30);
    drop(&b);
    file = hdf_start();
    hdf_variable(file, "l", "logical", 3, 2, v);
    b = hdf_behind_header(file);
    refuse(&rc_format_mat73, &b, "'l' is of another class");
    b.data[125] = 1;
    refuse(&rc_format_mat73, &b, "not a MAT file of version 7.3");
    drop(&b);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(several_arrays),   cmocka_unit_test(vectors),
        cmocka_unit_test(refusals),         cmocka_unit_test(damaged_packing),
        cmocka_unit_test(cuts_and_changes), cmocka_unit_test(version_7_3),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
