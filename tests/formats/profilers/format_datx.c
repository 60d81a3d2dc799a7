/* SPDX-License-Identifier: GPL-3.0-or-later */
/* DATX files made by this test are read with and without the table that names their heights. Other HDF5
 * files, damaged files and heights in an unknown unit are refused. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdint.h>

#include <cmocka.h>
#include <hdf5.h>

#include "tests/formats/made/made.h"

extern const struct rc_format rc_format_datx;

struct row {
    const char *group, *key, *value;
};

static void
datx_table(hid_t file, const struct row *row, size_t n)
{
    hid_t word = H5Tcopy(H5T_C_S1), type = H5Tcreate(H5T_COMPOUND, sizeof *row), space, set;
    const hsize_t rows = n;

    H5Tset_size(word, H5T_VARIABLE);
    H5Tinsert(type, "Source", offsetof(struct row, group), word);
    H5Tinsert(type, "Link", offsetof(struct row, key), word);
    H5Tinsert(type, "Destination", offsetof(struct row, value), word);
    space = H5Screate_simple(1, &rows, NULL);
    set = H5Dcreate2(file, "MetaData", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, row) >= 0);
    H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
    H5Tclose(word);
}

/* Category, unit, and numbers as a list or, with `fixed`, as an array. */
static void
datx_converter(hid_t set, const char *name, const char *category, double metres, bool fixed)
{
    struct {
        const char *category, *unit;
        hvl_t list;
        double array[4];
    } value = {category, "Pixels", {0}, {0, metres, 0, 0}};
    const hsize_t one = 1, four = 4;
    hid_t word = H5Tcopy(H5T_C_S1), type = H5Tcreate(H5T_COMPOUND, sizeof value);
    hid_t numbers =
        fixed ? H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &four) : H5Tvlen_create(H5T_NATIVE_DOUBLE);
    hid_t space = H5Screate_simple(1, &one, NULL), a;

    value.list.len = 4;
    value.list.p = value.array;
    H5Tset_size(word, H5T_VARIABLE);
    H5Tinsert(type, "Category", 0, word);
    H5Tinsert(type, "BaseUnit", sizeof(char *), word);
    H5Tinsert(
        type, "Parameters",
        (size_t)((char *)(fixed ? (void *)value.array : (void *)&value.list) - (char *)&value),
        numbers);
    a = H5Acreate2(set, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(a >= 0 && H5Awrite(a, type, &value) >= 0);
    H5Aclose(a);
    H5Sclose(space);
    H5Tclose(numbers);
    H5Tclose(type);
    H5Tclose(word);
}

static struct bytes
datx_file(bool table, const char *unit, bool fixed, double dx)
{
    static const struct row rows[] = {{"Root", "Measurement", "{1}"},
                                      {"{1}", "Name", "a part"},
                                      {"{1}", "Surface", "{2}"},
                                      {"{2}", "Path", "/Data/Surface/{3}"}};
    const hsize_t size[] = {2, 3};
    hid_t file = hdf_start(), data, surface, set;

    data = H5Gcreate2(file, "Data", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    surface = H5Gcreate2(data, "Surface", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    datx_table(file, rows, table ? 4 : 2);
    if (table) /* the first dataset, which the table does not name */
        H5Dclose(hdf_set(surface, "a", H5T_STD_I8LE, 2, size, NULL));
    set = hdf_set(surface, "{3}", H5T_IEEE_F64LE, 2, size, NULL);
    hdf_text(set, "Unit", unit, true);
    hdf_number(set, "No Data", 100);
    hdf_number(set, "Wavelength", 632.8e-9);
    hdf_number(set, "Interferometric Scale Factor", 0.5);
    hdf_number(set, "Obliquity Factor", 1.1);
    datx_converter(set, "X Converter", "LateralCat", dx, fixed);
    datx_converter(set, "Y Converter", "LateralCat", 0.75e-6, fixed);
    datx_converter(set, "Z Converter", "HeightCat", 1, fixed);
    H5Dclose(set);
    H5Gclose(surface);
    H5Gclose(data);
    return hdf_end(file);
}

/* Files that contain only /Measurement/Surface. */
static void
measurement_alone(void **state)
{
    const hsize_t size[] = {2, 3};
    hid_t file = hdf_start(), group, set;
    struct rc_grid *g;
    struct bytes b;
    double v[6];

    (void)state;
    group = H5Gcreate2(file, "Measurement", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    set = hdf_set(group, "Surface", H5T_IEEE_F64LE, 2, size, NULL);
    hdf_text(set, "Unit", "NanoMeters", true);
    hdf_number(set, "No Data", 100);
    datx_converter(set, "X Converter", "LateralCat", 1.5e-6, false);
    datx_converter(set, "Y Converter", "LateralCat", 0.75e-6, false);
    H5Dclose(set);
    H5Gclose(group);
    b = hdf_end(file);
    for (size_t i = 0; i < 6; i++)
        v[i] = hdf_counts[i] == 100 ? NAN : hdf_counts[i] * 1e-9;
    g = read_well(&rc_format_datx, &b, 0);
    check_map(g, 3, 2, 1.5e-6, 0.75e-6, v);
    rc_grid_free(g);
    drop(&b);
}

static void
datx_is_read(void **state)
{
    static const struct {
        const char *unit;
        double metres;
    } units[] = {{"NanoMeters", 1e-9}, {"MicroMeters", 1e-6}, {"Fringes", 632.8e-9 * 0.5 * 1.1}};

    (void)state;
    for (size_t k = 0; k < 3; k++)
        for (int way = 0; way < 4; way++) {
            struct bytes b = datx_file(way & 1, units[k].unit, way & 2, 1.5e-6);
            struct rc_file file = file_of(&b, "made");
            struct rc_grid *g;
            double v[6];

            assert_ptr_equal(rc_format_find(&file, NULL), &rc_format_datx);
            for (size_t i = 0; i < 6; i++)
                v[i] = hdf_counts[i] == 100 ? NAN : hdf_counts[i] * units[k].metres;
            g = read_well(&rc_format_datx, &b, 0);
            check_map(g, 3, 2, 1.5e-6, 0.75e-6, v);
            rc_grid_free(g);
            drop(&b);
        }
}

static void
datx_is_refused(void **state)
{
    struct bytes b = datx_file(true, "Waves", false, 1e-6);

    (void)state;
    refuse(&rc_format_datx, &b, "'Waves', which is not a length");
    drop(&b);
    b = datx_file(true, "NanoMeters", false, 0); /* not calibrated */
    refuse(&rc_format_datx, &b, "does not give the spacing in x: --dx");
    drop(&b);
    b = datx_file(true, "NanoMeters", false, -1e-6);
    refuse(&rc_format_datx, &b, "must be positive");
    drop(&b);
    b = hdf_plain();
    refuse(&rc_format_datx, &b, "no DATX");
    drop(&b);
    b = datx_file(true, "NanoMeters", false, 1e-6);
    refuse_cuts(&rc_format_datx, &b, b.n, 113);
    survive_changes(&rc_format_datx, &b, 200);
    drop(&b);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(datx_is_read),
        cmocka_unit_test(measurement_alone),
        cmocka_unit_test(datx_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
