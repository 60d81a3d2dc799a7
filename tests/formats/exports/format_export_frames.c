/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Other content of written files: members and checksums, several frames; frames that a format cannot hold are
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
#include <zip.h>

#include "formats/containers/containers.h"
#include "decoders.h"

/* ---- metadata of a file ---- */

static zip_t *
unzip(const struct written *made)
{
    zip_source_t *from = zip_source_buffer_create(made->bytes, made->n, 0, NULL);
    zip_t *zip = zip_open_from_source(from, ZIP_RDONLY, NULL);

    assert_non_null(zip);
    return zip;
}

static void
member(zip_t *zip, const char *name, char *to, size_t size)
{
    zip_file_t *f = zip_fopen(zip, name, 0);
    zip_int64_t n;

    if (f == NULL)
        fail_msg("the archive has no %s", name);
    n = zip_fread(f, to, size - 1);
    assert_true(n >= 0);
    to[n] = '\0';
    zip_fclose(f);
}

/* Points 1 and 9 of ten are missing: by the standard, lowest bit first, the bytes are 1111 1101 and 01. */
static void
x3p_parts(void **state)
{
    struct rc_grid *g = random_grid(5, 2, 0);
    char xml[8192], bytes[200], element[100], md5[RC_MD5_TEXT];
    struct written made;
    zip_t *zip;

    (void)state;
    g->v[1] = g->v[9] = NAN;
    rc_grid_set(g, "file.date", "2024-02-29T12:30:00Z", NULL);
    rc_grid_set(g, "file.creator", "A. <B> & \"C\"", NULL);
    rc_grid_set(g, "history", "rc-import 0.1.0", NULL);
    made = export("x3p", &g, 1, &plain_export);
    zip = unzip(&made);
    member(zip, "main.xml", xml, sizeof xml);
    assert_non_null(strstr(xml, "<Date>2024-02-29T12:30:00Z</Date>"));
    assert_non_null(strstr(xml, "<Creator>A. &lt;B&gt; &amp; &quot;C&quot;</Creator>"));
    assert_non_null(strstr(xml, "<Comment>rc-import 0.1.0</Comment>"));
    assert_non_null(strstr(xml, "<AxisType>A</AxisType><DataType>D</DataType>"));
    assert_non_null(strstr(xml, "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>"));
    member(zip, "bindata/valid.bin", bytes, sizeof bytes);
    assert_memory_equal(bytes, "\xfd\x01", 3);
    /* the checksum of those two bytes by md5sum(1) */
    assert_non_null(strstr(xml, "<MD5ChecksumValidPoints>6e21d8e0df90323085b1dd30ef380d95<"));
    member(zip, "bindata/data.bin", bytes, sizeof bytes);
    rc_md5_of(bytes, 8 * 10, md5);
    snprintf(element, sizeof element, "<MD5ChecksumPointData>%s<", md5);
    assert_non_null(strstr(xml, element));
    member(zip, "md5checksum.hex", bytes, sizeof bytes);
    rc_md5_of(xml, strlen(xml), md5);
    assert_memory_equal(bytes, md5, 32);
    assert_string_equal(bytes + 32, " *main.xml\n");
    zip_discard(zip);
    free(made.bytes);
    g->v[1] = g->v[9] = 1e-6;
    made = export("x3p", &g, 1, &plain_export);
    zip = unzip(&made);
    member(zip, "main.xml", xml, sizeof xml);
    assert_null(strstr(xml, "ValidPoints"));
    assert_true(zip_name_locate(zip, "bindata/valid.bin", 0) < 0);
    zip_discard(zip);
    free(made.bytes);
    rc_grid_free(g);
}

/* Noise in all bits would not become smaller and is stored; a slope is compressed. */
static void
x3p_compresses_what_shrinks(void **state)
{
    static const zip_uint16_t method[] = {ZIP_CM_STORE, ZIP_CM_DEFLATE};

    (void)state;
    for (size_t k = 0; k < 2; k++) {
        struct rc_grid *g = random_grid(300, 200, 0);
        struct written made;
        zip_stat_t st;
        zip_t *zip;

        for (size_t i = 0; k == 1 && i < 60000; i++)
            g->v[i] = 1e-6 * (double)(i % 300);
        made = export("x3p", &g, 1, &plain_export);
        zip = unzip(&made);
        assert_int_equal(zip_stat(zip, "bindata/data.bin", 0, &st), 0);
        assert_int_equal(st.size, 480000);
        assert_int_equal(st.comp_method, method[k]);
        zip_discard(zip);
        free(made.bytes);
        rc_grid_free(g);
    }
}

/* ---- several frames ---- */

enum {
    STACK = 6
};

/* mises and szz at three depths, in the order of a stream; each value encodes its position. */
static void
make_stack(struct rc_grid *frame[STACK], const double depth[3])
{
    for (size_t k = 0; k < STACK; k++) {
        struct rc_shape shape = {.nx = 3, .ny = 2, .dx = 1e-6, .dy = 2e-6};
        frame[k] = rc_grid_new(&shape, k % 2 == 0 ? "mises" : "szz", "Pa", NULL);
        rc_grid_set_number(frame[k], "depth", depth[k / 2], NULL);
        for (size_t i = 0; i < 6; i++)
            frame[k]->v[i] = 100.0 * (double)(k % 2) + 10.0 * (double)(k / 2) + (double)i;
    }
}

static void
drop_stack(struct rc_grid *frame[STACK])
{
    for (size_t k = 0; k < STACK; k++)
        rc_grid_free(frame[k]);
}

static void
check_stack(const struct written *made)
{
    static const char *const name[] = {"mises", "szz"};

    for (size_t a = 0; a < 2; a++) {
        size_t bytes;
        const char *data = appended(made, name[a], &bytes);
        assert_int_equal(bytes, 8 * 18);
        for (size_t k = 0; k < 18; k++)
            assert_true(f64(data + 8 * k) ==
                        100.0 * (double)a + 10.0 * (double)(k / 6) + (double)(k % 6));
    }
    assert_non_null(strstr(made->bytes, ">Pa</InformationKey>"));
}

static void
depths_make_a_stack(void **state)
{
    static const double even[] = {1e-6, 2.5e-6, 4e-6}, uneven[] = {0, 1e-6, 4e-6};
    struct rc_grid *frame[STACK], *swapped[STACK];
    struct written made;
    const char *z;
    size_t bytes;

    (void)state;
    make_stack(frame, even);
    made = export("vti", frame, STACK, &plain_export);
    assert_non_null(strstr(made.bytes, "WholeExtent=\"0 2 0 1 0 2\" Origin=\"-1e-06 -1e-06 1e-06\" "
                                       "Spacing=\"1e-06 2e-06 1.5e-06\""));
    check_stack(&made);
    free(made.bytes);
    for (size_t k = 0; k < STACK; k++)
        swapped[k] = frame[STACK - 1 - k]; /* the deepest first */
    made = export("vti", swapped, STACK, &plain_export);
    check_stack(&made);
    free(made.bytes);
    drop_stack(frame);
    make_stack(frame, uneven);
    refuse_export("vti", frame, STACK, &plain_export, "uneven steps");
    made = export("vtr", frame, STACK, &plain_export);
    check_stack(&made);
    z = appended(&made, "z", &bytes);
    assert_int_equal(bytes, 24);
    for (size_t k = 0; k < 3; k++)
        assert_true(f64(z + 8 * k) == uneven[k]);
    free(made.bytes);
    refuse_export("vti", frame, STACK - 1, &plain_export, "mises has 3 depths and szz has 2");
    rc_grid_set(frame[5], "depth", NULL, NULL);
    refuse_export("vtr", frame, STACK, &plain_export, "some have none");
    rc_grid_set_number(frame[5], "depth", 5e-6, NULL);
    refuse_export("vtr", frame, STACK, &plain_export, "different depths");
    rc_grid_set_number(frame[4], "depth", 1e-6, NULL);
    refuse_export("vtr", frame, STACK, &plain_export, "two frames of channel mises at one depth");
    drop_stack(frame);
}

/* The header according to NumPy's description of the format, then mises slice by slice. */
static void
depths_make_an_array(void **state)
{
    static const double even[] = {1e-6, 2.5e-6, 4e-6}, uneven[] = {0, 1e-6, 4e-6};
    static const char head[] = "\x93NUMPY\x01\x00\x76\x00"
                               "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2, 3), }";
    struct rc_grid *frame[STACK], *deepest[3];
    struct written made;

    (void)state;
    make_stack(frame, even);
    for (size_t k = 0; k < 3; k++)
        deepest[k] = frame[4 - 2 * k];
    made = export("npy", deepest, 3, &plain_export);
    assert_int_equal(made.n, 128 + 8 * 18);
    assert_memory_equal(made.bytes, head, sizeof head - 1);
    for (size_t k = 0; k < 18; k++)
        assert_true(f64(made.bytes + 128 + 8 * k) == 10.0 * (double)(k / 6) + (double)(k % 6));
    free(made.bytes);
    made = export("npy", deepest, 1, &plain_export); /* a single depth is a map */
    assert_non_null(strstr(made.bytes + 10, "'shape': (2, 3), }"));
    assert_true(made.n == 128 + 8 * 6 && f64(made.bytes + 128 + 8) == 21);
    free(made.bytes);
    refuse_export("npy", frame, STACK, &plain_export,
                  "one map, or the depths of one channel and case on one grid");
    rc_grid_set(frame[2], "case", "2", NULL);
    refuse_export("npy", deepest, 3, &plain_export,
                  "one map, or the depths of one channel and case on one grid");
    drop_stack(frame);
    make_stack(frame, uneven);
    for (size_t k = 0; k < 3; k++)
        deepest[k] = frame[2 * k];
    refuse_export("npy", deepest, 3, &plain_export,
                  "uneven steps, which npy cannot say: write vtr or hdf5");
    rc_grid_set_number(frame[2], "depth", 0, NULL);
    refuse_export("npy", deepest, 3, &plain_export, "two frames of channel mises at one depth");
    drop_stack(frame);
}

/* ---- HDF5: the file read by its library ---- */

static hid_t
open_hdf5(const struct written *made)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS), file;

    H5Pset_fapl_core(access, 1 << 16, false);
    assert_true(H5Pset_file_image(access, made->bytes, made->n) >= 0);
    file = H5Fopen("made", H5F_ACC_RDONLY, access);
    assert_true(file >= 0);
    H5Pclose(access);
    return file;
}

/* The values of a dataset of this rank; its sizes into `size`. */
static double *
hdf5_values(hid_t set, int rank, hsize_t *size)
{
    hid_t space = H5Dget_space(set);
    double *v;
    size_t n = 1;

    assert_true(set >= 0);
    assert_int_equal(H5Sget_simple_extent_ndims(space), rank);
    H5Sget_simple_extent_dims(space, size, NULL);
    for (int k = 0; k < rank; k++)
        n *= (size_t)size[k];
    v = malloc(n * sizeof *v);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, v) >= 0);
    H5Sclose(space);
    return v;
}

/* The scale of the first axis is the dataset of these depths. The attribute DIMENSION_LIST leads to it; its
 * entries are lists of references (specification of dimension scales). Returns its name. */
static void
check_scale(hid_t set, int rank, const double *depth, size_t n, char *name, size_t size)
{
    hid_t attribute = H5Aopen(set, "DIMENSION_LIST", H5P_DEFAULT), type = H5Aget_type(attribute);
    hid_t scale, word, text;
    hvl_t list[3];
    hsize_t rows;
    char class[32] = "";
    double *v;

    assert_true(attribute >= 0 && H5Aread(attribute, type, list) >= 0);
    assert_int_equal(list[0].len, 1);
    for (int k = 1; k < rank; k++)
        assert_int_equal(list[k].len, 0);
    scale = H5Rdereference2(set, H5P_DEFAULT, H5R_OBJECT, list[0].p);
    free(list[0].p);
    v = hdf5_values(scale, 1, &rows);
    assert_int_equal(rows, n);
    for (size_t k = 0; k < n; k++)
        assert_true(v[k] == depth[k]);
    free(v);
    word = H5Aopen(scale, "CLASS", H5P_DEFAULT);
    text = H5Aget_type(word);
    assert_true(H5Aread(word, text, class) >= 0);
    assert_string_equal(class, "DIMENSION_SCALE");
    H5Tclose(text);
    assert_true(H5Iget_name(scale, name, size) > 0);
    H5Aclose(word);
    H5Dclose(scale);
    H5Tclose(type);
    H5Aclose(attribute);
}

static void
hdf5_stacks_know_their_depths(void **state)
{
    static const double uneven[] = {0, 1e-6, 4e-6};
    static const char *const name[] = {"mises", "szz"};
    struct rc_grid *frame[STACK];
    char scale[2][64];
    struct written made, again;
    hsize_t size[3];
    hid_t file, set;

    (void)state;
    make_stack(frame, uneven);
    made = export("hdf5", frame, STACK, &plain_export);
    file = open_hdf5(&made);
    for (size_t a = 0; a < 2; a++) {
        double *v;

        set = H5Dopen2(file, name[a], H5P_DEFAULT);
        v = hdf5_values(set, 3, size);

        assert_true(size[0] == 3 && size[1] == 2 && size[2] == 3);
        for (size_t k = 0; k < 18; k++)
            assert_true(v[k] == 100.0 * (double)a + 10.0 * (double)(k / 6) + (double)(k % 6));
        free(v);
        check_scale(set, 3, uneven, 3, scale[a], sizeof scale[a]);
        assert_true(hdf5_number(set, "dx") == 1e-6 && hdf5_number(set, "dy") == 2e-6);
        assert_int_equal(H5Aexists(set, "depth"), 0); /* no single depth holds for all slices */
        H5Dclose(set);
    }
    assert_string_equal(scale[0], "/depth");
    assert_string_equal(scale[1], "/depth"); /* one for both */
    H5Fclose(file);
    again = export("hdf5", frame, STACK, &plain_export);
    assert_int_equal(made.n, again.n);
    assert_memory_equal(made.bytes, again.bytes, made.n);
    free(again.bytes);
    free(made.bytes);
    made = export("hdf5", frame, 1, &plain_export); /* a single depth is a map with the key depth */
    file = open_hdf5(&made);
    set = H5Dopen2(file, "mises_z0", H5P_DEFAULT);
    free(hdf5_values(set, 2, size));
    H5Dclose(set);
    H5Fclose(file);
    free(made.bytes);
    drop_stack(frame);
}

/* A channel may have the name depth, and its depths may differ from those of the next channel. */
static void
hdf5_scales_have_names_of_their_own(void **state)
{
    static const double uneven[] = {0, 1e-6, 4e-6}, other[] = {0, 1e-6, 5e-6};
    struct rc_grid *frame[STACK];
    char scale[64];
    struct written made;
    hsize_t size[3];
    hid_t file, set;

    (void)state;
    make_stack(frame, uneven);
    rc_grid_set_number(frame[5], "depth", other[2], NULL);
    for (size_t k = 1; k < STACK; k += 2)
        rc_text_set(&frame[k]->channel, "depth", NULL);
    made = export("hdf5", frame, STACK, &plain_export);
    file = open_hdf5(&made);
    set = H5Dopen2(file, "depth", H5P_DEFAULT);
    free(hdf5_values(set, 3, size));
    check_scale(set, 3, other, 3, scale, sizeof scale);
    assert_string_equal(scale, "/depth_3");
    H5Dclose(set);
    set = H5Dopen2(file, "mises", H5P_DEFAULT);
    check_scale(set, 3, uneven, 3, scale, sizeof scale);
    assert_string_equal(scale, "/depth_2");
    H5Dclose(set);
    H5Fclose(file);
    free(made.bytes);
    drop_stack(frame);
}

/* ---- sections ---- */

static struct rc_grid *
make_section(const char *depths)
{
    struct rc_shape shape = {.nx = 2, .ny = 3, .dx = 1e-6, .dy = 2e-6};
    struct rc_grid *g = rc_grid_new(&shape, "height", "m", NULL);

    for (size_t k = 0; k < 6; k++)
        g->v[k] = (double)k;
    rc_grid_set(g, "section", "y", NULL);
    rc_grid_set_number(g, "at", 7e-6, NULL);
    rc_grid_set(g, "depths", depths, NULL);
    return g;
}

static void
uneven_depths_are_not_made_even(void **state)
{
    static const char *const tell[] = {"vtr", "xyz", "hdf5"};
    struct rc_grid *even = make_section("0,2e-06,4e-06"), *uneven = make_section("0,1e-06,4e-06");
    struct rc_grid *few = make_section("0,1e-06"), *back = make_section("0,2e-06,1e-06");

    (void)state;
    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++) {
        bool tells = false;
        struct written made = export((*e)->name, &even, 1, &plain_export);

        free(made.bytes);
        for (size_t k = 0; k < sizeof tell / sizeof *tell; k++)
            tells = tells || strcmp((*e)->name, tell[k]) == 0;
        refuse_export((*e)->name, &few, 1, &plain_export, "3 rows without as many depths");
        refuse_export((*e)->name, &back, 1, &plain_export, "must rise from row to row");
        if (!tells) {
            refuse_export((*e)->name, &uneven, 1, &plain_export,
                          "cannot say: write vtr, or resample them with --even");
            continue;
        }
        made = export((*e)->name, &uneven, 1, &plain_export);
        free(made.bytes);
    }
    rc_grid_free(even);
    rc_grid_free(uneven);
    rc_grid_free(few);
    rc_grid_free(back);
}

static void
those_that_can_tell_where_rows_are(void **state)
{
    static const double depth[] = {0, 1e-6, 4e-6};
    struct rc_grid *g = make_section("0,1e-06,4e-06");
    struct written made = export("xyz", &g, 1, &plain_export);
    char scale[64];
    hsize_t size[2];
    hid_t file, set;
    double *v;

    (void)state;
    assert_string_equal(made.bytes, "-5e-07 0 0\n5e-07 0 1\n-5e-07 1e-06 2\n5e-07 1e-06 3\n"
                                    "-5e-07 4e-06 4\n5e-07 4e-06 5\n");
    free(made.bytes);
    made = export("hdf5", &g, 1, &plain_export);
    file = open_hdf5(&made);
    set = H5Dopen2(file, "height", H5P_DEFAULT);
    v = hdf5_values(set, 2, size);
    assert_true(size[0] == 3 && size[1] == 2 && v[5] == 5);
    check_scale(set, 2, depth, 3, scale, sizeof scale);
    free(v);
    H5Dclose(set);
    H5Fclose(file);
    free(made.bytes);
    rc_grid_free(g);
}

static void
a_section_stands_upright(void **state)
{
    struct rc_shape shape = {.nx = 3, .ny = 2, .dx = 1e-6, .dy = 4e-6};
    struct rc_grid *g = rc_grid_new(&shape, "mises", "Pa", NULL);
    struct written made;
    size_t bytes;
    const char *at;

    (void)state;
    for (size_t k = 0; k < 6; k++)
        g->v[k] = (double)k;
    rc_grid_set(g, "section", "y", NULL);
    rc_grid_set_number(g, "at", 7e-6, NULL);
    refuse_export("vtr", &g, 1, &plain_export, "without as many depths");
    rc_grid_set(g, "depths", "0,4e-06", NULL);
    made = export("vti", &g, 1, &plain_export);
    assert_non_null(strstr(made.bytes, "WholeExtent=\"0 2 0 0 0 1\" Origin=\"-1e-06 7e-06 0\" "
                                       "Spacing=\"1e-06 1e-06 4e-06\""));
    free(made.bytes);
    rc_grid_set(g, "section", "x", NULL);
    made = export("vtr", &g, 1, &plain_export);
    assert_non_null(strstr(made.bytes, "WholeExtent=\"0 0 0 2 0 1\""));
    at = appended(&made, "x", &bytes);
    assert_true(bytes == 8 && f64(at) == 7e-6);
    at = appended(&made, "mises", &bytes);
    assert_true(bytes == 48 && f64(at + 40) == 5);
    free(made.bytes);
    rc_grid_free(g);
}

static void
frames_have_names_of_their_own(void **state)
{
    struct rc_grid *frame[3];
    struct written made;

    (void)state;
    for (size_t k = 0; k < 3; k++)
        frame[k] = random_grid(4, 3, 0);
    rc_grid_set(frame[1], "case", "2", NULL);
    rc_grid_set(frame[2], "case", "2", NULL);
    made = export("vti", frame, 3, &plain_export);
    assert_non_null(strstr(made.bytes, "Name=\"height_case1\""));
    assert_non_null(strstr(made.bytes, "Name=\"height_case2\""));
    assert_non_null(strstr(made.bytes, "Name=\"height_case2_2\""));
    free(made.bytes);
    made = export("gwy", frame, 3, &plain_export);
    assert_string_equal(gwy_item(made.bytes, made.bytes + made.n, "/2/data/title", 's'),
                        "height_case2_2");
    free(made.bytes);
    frame[0]->dx *= 2;
    refuse_export("vti", frame, 3, &plain_export, "another grid");
    made = export("hdf5", frame, 3, &plain_export); /* there each frame has its own grid */
    free(made.bytes);
    for (size_t k = 0; k < 3; k++)
        rc_grid_free(frame[k]);
}

/* ---- refusals ---- */

static void
what_cannot_be_said(void **state)
{
    static const char *const finite[] = {"x3p", "sdf", "sdf-binary", "sur"};
    struct rc_grid *g = random_grid(4, 3, 0);
    struct rc_export_wish narrow = typed(RC_RAW_F32);

    (void)state;
    g->v[6] = 1e300;
    refuse_export("npy", &g, 1, &narrow, "too large for the type f32");
    refuse_export("gsf", &g, 1, &plain_export, "too large for the type f32");
    refuse_export("sur", &g, 1, &plain_export, "beyond the floats");
    g->v[6] = -INFINITY;
    for (size_t k = 0; k < sizeof finite / sizeof *finite; k++)
        refuse_export(finite[k], &g, 1, &plain_export, "column 2, row 1 (from 0) is infinite");
    rc_grid_free(g);
    g = random_grid(65536, 1, 0);
    refuse_export("sdf-binary", &g, 1, &plain_export, "at most 65535");
    rc_grid_free(g);
}

static void
full_device(void **state)
{
    struct rc_grid *g = random_grid(300, 300, 0.1), *whole = random_grid(300, 300, 0);
    FILE *f = fopen("/dev/full", "wb");

    (void)state;
    assert_non_null(f);
    setvbuf(f, NULL, _IONBF, 0);
    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++) {
        struct rc_err err = {""};
        if ((*e)->write(f, (*e)->relief ? &whole : &g, 1, &plain_export, &err) == RC_OK ||
            strstr(err.text, "writing failed") == NULL)
            fail_msg("%s: a full device is not told (%s)", (*e)->name, err.text);
    }
    fclose(f);
    rc_grid_free(g);
    rc_grid_free(whole);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(x3p_parts),
        cmocka_unit_test(x3p_compresses_what_shrinks),
        cmocka_unit_test(depths_make_a_stack),
        cmocka_unit_test(depths_make_an_array),
        cmocka_unit_test(hdf5_stacks_know_their_depths),
        cmocka_unit_test(hdf5_scales_have_names_of_their_own),
        cmocka_unit_test(uneven_depths_are_not_made_even),
        cmocka_unit_test(those_that_can_tell_where_rows_are),
        cmocka_unit_test(a_section_stands_upright),
        cmocka_unit_test(frames_have_names_of_their_own),
        cmocka_unit_test(what_cannot_be_said),
        cmocka_unit_test(full_device),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
