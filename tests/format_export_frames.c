/* What a written file says beside its numbers: parts and sums, several frames, and what it cannot
 * say. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>
#include <zip.h>

#include "decoders.h"

/* ---- what a file says beside its numbers ---- */

static zip_t *
unzip(const struct made *made)
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

/* Points 1 and 9 of ten are missing: 1111 1101, 01 by the standard, lowest bit first. */
static void
x3p_parts(void **state)
{
    struct rc_grid *g = random_grid(5, 2, 0);
    char xml[8192], bytes[200], element[100], md5[RC_MD5_TEXT];
    struct made made;
    zip_t *zip;

    (void)state;
    g->v[1] = g->v[9] = NAN;
    rc_grid_set(g, "file.date", "2024-02-29T12:30:00Z", NULL);
    rc_grid_set(g, "file.creator", "A. <B> & \"C\"", NULL);
    rc_grid_set(g, "history", "rc-import 0.1.0", NULL);
    made = export("x3p", &g, 1, &plain);
    zip = unzip(&made);
    member(zip, "main.xml", xml, sizeof xml);
    assert_non_null(strstr(xml, "<Date>2024-02-29T12:30:00Z</Date>"));
    assert_non_null(strstr(xml, "<Creator>A. &lt;B&gt; &amp; &quot;C&quot;</Creator>"));
    assert_non_null(strstr(xml, "<Comment>rc-import 0.1.0</Comment>"));
    assert_non_null(strstr(xml, "<AxisType>A</AxisType><DataType>D</DataType>"));
    assert_non_null(strstr(xml, "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>"));
    member(zip, "bindata/valid.bin", bytes, sizeof bytes);
    assert_memory_equal(bytes, "\xfd\x01", 3);
    /* of those two bytes, by md5sum(1) */
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
    made = export("x3p", &g, 1, &plain);
    zip = unzip(&made);
    member(zip, "main.xml", xml, sizeof xml);
    assert_null(strstr(xml, "ValidPoints"));
    assert_true(zip_name_locate(zip, "bindata/valid.bin", 0) < 0);
    zip_discard(zip);
    free(made.bytes);
    rc_grid_free(g);
}

/* Noise in all of its bits would not shrink, and is stored; a slope is compressed. */
static void
x3p_compresses_what_shrinks(void **state)
{
    static const zip_uint16_t method[] = {ZIP_CM_STORE, ZIP_CM_DEFLATE};

    (void)state;
    for (size_t k = 0; k < 2; k++) {
        struct rc_grid *g = random_grid(300, 200, 0);
        struct made made;
        zip_stat_t st;
        zip_t *zip;

        for (size_t i = 0; k == 1 && i < 60000; i++)
            g->v[i] = 1e-6 * (double)(i % 300);
        made = export("x3p", &g, 1, &plain);
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

/* mises and szz at three depths, in the order of a stream; the value tells where it stands. */
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
check_stack(const struct made *made)
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
    struct made made;
    const char *z;
    size_t bytes;

    (void)state;
    make_stack(frame, even);
    made = export("vti", frame, STACK, &plain);
    assert_non_null(strstr(made.bytes, "WholeExtent=\"0 2 0 1 0 2\" Origin=\"-1e-06 -1e-06 1e-06\" "
                                       "Spacing=\"1e-06 2e-06 1.5e-06\""));
    check_stack(&made);
    free(made.bytes);
    for (size_t k = 0; k < STACK; k++)
        swapped[k] = frame[STACK - 1 - k]; /* the deepest first */
    made = export("vti", swapped, STACK, &plain);
    check_stack(&made);
    free(made.bytes);
    drop_stack(frame);
    make_stack(frame, uneven);
    refuse("vti", frame, STACK, &plain, "uneven steps");
    made = export("vtr", frame, STACK, &plain);
    check_stack(&made);
    z = appended(&made, "z", &bytes);
    assert_int_equal(bytes, 24);
    for (size_t k = 0; k < 3; k++)
        assert_true(f64(z + 8 * k) == uneven[k]);
    free(made.bytes);
    refuse("vti", frame, STACK - 1, &plain, "mises has 3 depths and szz has 2");
    rc_grid_set(frame[5], "depth", NULL, NULL);
    refuse("vtr", frame, STACK, &plain, "some have none");
    rc_grid_set_number(frame[5], "depth", 5e-6, NULL);
    refuse("vtr", frame, STACK, &plain, "different depths");
    rc_grid_set_number(frame[4], "depth", 1e-6, NULL);
    refuse("vtr", frame, STACK, &plain, "two frames of channel mises at one depth");
    drop_stack(frame);
}

static void
a_section_stands_upright(void **state)
{
    struct rc_shape shape = {.nx = 3, .ny = 2, .dx = 1e-6, .dy = 4e-6};
    struct rc_grid *g = rc_grid_new(&shape, "mises", "Pa", NULL);
    struct made made;
    size_t bytes;
    const char *at;

    (void)state;
    for (size_t k = 0; k < 6; k++)
        g->v[k] = (double)k;
    rc_grid_set(g, "section", "y", NULL);
    rc_grid_set_number(g, "at", 7e-6, NULL);
    refuse("vtr", &g, 1, &plain, "without as many depths");
    rc_grid_set(g, "depths", "0,4e-06", NULL);
    made = export("vti", &g, 1, &plain);
    assert_non_null(strstr(made.bytes, "WholeExtent=\"0 2 0 0 0 1\" Origin=\"-1e-06 7e-06 0\" "
                                       "Spacing=\"1e-06 1e-06 4e-06\""));
    free(made.bytes);
    rc_grid_set(g, "section", "x", NULL);
    made = export("vtr", &g, 1, &plain);
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
    struct made made;

    (void)state;
    for (size_t k = 0; k < 3; k++)
        frame[k] = random_grid(4, 3, 0);
    rc_grid_set(frame[1], "case", "2", NULL);
    rc_grid_set(frame[2], "case", "2", NULL);
    made = export("vti", frame, 3, &plain);
    assert_non_null(strstr(made.bytes, "Name=\"height_case1\""));
    assert_non_null(strstr(made.bytes, "Name=\"height_case2\""));
    assert_non_null(strstr(made.bytes, "Name=\"height_case2_2\""));
    free(made.bytes);
    made = export("gwy", frame, 3, &plain);
    assert_string_equal(gwy_item(made.bytes, made.bytes + made.n, "/2/data/title", 's'),
                        "height_case2_2");
    free(made.bytes);
    frame[0]->dx *= 2;
    refuse("vti", frame, 3, &plain, "another grid");
    made = export("hdf5", frame, 3, &plain); /* each has a grid of its own there */
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
    refuse("npy", &g, 1, &narrow, "too large for the type f32");
    refuse("gsf", &g, 1, &plain, "too large for the type f32");
    refuse("sur", &g, 1, &plain, "beyond the floats");
    g->v[6] = -INFINITY;
    for (size_t k = 0; k < sizeof finite / sizeof *finite; k++)
        refuse(finite[k], &g, 1, &plain, "column 2, row 1 (from 0) is infinite");
    rc_grid_free(g);
    g = random_grid(65536, 1, 0);
    refuse("sdf-binary", &g, 1, &plain, "at most 65535");
    rc_grid_free(g);
}

static void
full_device(void **state)
{
    struct rc_grid *g = random_grid(300, 300, 0.1);
    FILE *f = fopen("/dev/full", "wb");

    (void)state;
    assert_non_null(f);
    setvbuf(f, NULL, _IONBF, 0);
    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++) {
        struct rc_err err = {""};
        if ((*e)->write(f, &g, 1, &plain, &err) == RC_OK ||
            strstr(err.text, "writing failed") == NULL)
            fail_msg("%s: a full device is not told (%s)", (*e)->name, err.text);
    }
    fclose(f);
    rc_grid_free(g);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(x3p_parts),
        cmocka_unit_test(x3p_compresses_what_shrinks),
        cmocka_unit_test(depths_make_a_stack),
        cmocka_unit_test(a_section_stands_upright),
        cmocka_unit_test(frames_have_names_of_their_own),
        cmocka_unit_test(what_cannot_be_said),
        cmocka_unit_test(full_device),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
