/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A decoder of each format that shares no code with the writer reads the written files. So does the project's
 * reader if there is one. Both find the given numbers. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "decoders.h"
#include "formats/format.h"
#include "tests/formats/made/open.h"

/* Permitted errors: of a number `step` times the range and `part` times the largest; of a spacing. Then the
 * smallest number of nodes of an axis whose spacing the file holds. */
/* clang-format off */
static const struct {
    const char *name;
    int type; /* enum rc_raw, -1: none */
    double step, part, spacing;
    size_t from;
    struct map (*decode)(const struct written *made);
    const char *reader;
} formats[] = {
    {"x3p", RC_RAW_I16, 0.501 / 65534, last_digit, 0, 1, NULL, "x3p"},
    {"x3p", RC_RAW_I32, 0.501 / 4294967294.0, last_digit, 0, 1, NULL, "x3p"},
    {"x3p", RC_RAW_F32, 0, float_rounding, 0, 1, NULL, "x3p"},
    {"x3p", RC_RAW_F64, 0, 0, 0, 1, NULL, "x3p"},
    {"sdf", -1, 0, 0, 0, 1, decode_sdf, "sdf"},
    {"sdf-binary", RC_RAW_I16, 0, 0.501 / 32767, 0, 1, decode_sdf_binary, "sdf"},
    {"sdf-binary", RC_RAW_I32, 0, 0.501 / 2147483647.0, 0, 1, decode_sdf_binary, "sdf"},
    {"sdf-binary", RC_RAW_F64, 0, 0, 0, 1, decode_sdf_binary, "sdf"},
    {"gsf", -1, 0, float_rounding, last_digit, 1, decode_gsf, "gsf"},
    {"gwy", -1, 0, 0, last_digit, 1, decode_gwy, "gwy"},
    {"npy", RC_RAW_F32, 0, float_rounding, 0, SIZE_MAX, decode_npy, "npy"},
    {"npy", RC_RAW_F64, 0, 0, 0, SIZE_MAX, decode_npy, "npy"},
    {"csv", -1, 0, 0, last_digit, 1, decode_csv, "ascii"},
    {"xyz", -1, 0, 0, last_digit, 2, decode_xyz, "xyz"},
    {"vti", RC_RAW_F32, 0, float_rounding, last_digit, 2, decode_vti, NULL},
    {"vti", RC_RAW_F64, 0, 0, last_digit, 2, decode_vti, NULL},
    {"vtr", RC_RAW_F32, 0, float_rounding, rounding, 2, decode_vtr, NULL},
    {"vtr", RC_RAW_F64, 0, 0, rounding, 2, decode_vtr, NULL},
    {"hdf5", RC_RAW_F32, 0, float_rounding, 0, 1, decode_hdf5, "hdf5"},
    {"hdf5", RC_RAW_F64, 0, 0, 0, 1, decode_hdf5, "hdf5"},
    {"mat", RC_RAW_F32, 0, float_rounding, 0, 1, decode_mat, "mat"},
    {"mat", RC_RAW_F64, 0, 0, 0, 1, decode_mat, "mat"},
    /* the offset is rounded down to a float, which widens the range */
    {"sur", RC_RAW_I16, 0.501 / 32767, 1e-11, float_rounding, 1, decode_sur, "sur"},
    {"sur", RC_RAW_I32, 0.501 / 2147483647.0, last_digit, float_rounding, 1, decode_sur, "sur"},
};
/* clang-format on */

static void
compare_spacing(size_t f, const char *by, size_t n, double wanted, double got)
{
    if (isnan(got) ? n >= formats[f].from : fabs(got - wanted) > formats[f].spacing * wanted)
        fail_msg("%s %s: the spacing of %zu nodes is %.17g, not %.17g", formats[f].name, by, n, got,
                 wanted);
}

static void
compare(size_t f, const char *by, const struct rc_grid *g, const struct map *m)
{
    double low = INFINITY, high = -INFINITY, most = 0, worst = 0, within;

    assert_int_equal(m->nx, g->nx);
    assert_int_equal(m->ny, g->ny);
    compare_spacing(f, by, g->nx, g->dx, m->dx);
    compare_spacing(f, by, g->ny, g->dy, m->dy);
    for (size_t k = 0; k < g->nx * g->ny; k++) {
        if (isnan(g->v[k]) != isnan(m->v[k]))
            fail_msg("%s %s: value %zu is %g, not %g", formats[f].name, by, k, m->v[k], g->v[k]);
        low = fmin(low, g->v[k]);
        high = fmax(high, g->v[k]);
        most = fmax(most, fabs(g->v[k]));
        worst = fmax(worst, fabs(g->v[k] - m->v[k]));
    }
    within = (high > low ? formats[f].step * (high - low) : 0) + formats[f].part * most;
    if (!(worst <= within))
        fail_msg("%s %s, type %d, %zu x %zu: off by %g, more than %g", formats[f].name, by,
                 formats[f].type, g->nx, g->ny, worst, within);
}

/* The project's reader, with options for the data that the format lacks. */
static void
compare_reader(size_t f, const struct rc_grid *g, const struct written *made)
{
    const struct rc_format *reader = rc_format_named(formats[f].reader);
    struct rc_wish wish = rc_no_wish;
    struct rc_file file = {.data = (const unsigned char *)made->bytes, .size = made->n};
    struct rc_notes notes = {0};
    struct rc_err err = {""};
    struct rc_grid *back;
    struct map m;

    if (reader == NULL)
        fail_msg("%s: there is no reader '%s'", formats[f].name, formats[f].reader);
    file.name = "made";
    if (strcmp(formats[f].name, "npy") == 0 || strcmp(formats[f].name, "xyz") == 0)
        wish = (struct rc_wish){.dx = g->dx, .dy = g->dy, .z_unit = 1};
    if ((back = read_map(reader, &file, &wish, 0, &notes, &err)) == NULL)
        fail_msg("%s, type %d, %zu x %zu: our reader says: %s", formats[f].name, formats[f].type,
                 g->nx, g->ny, err.text);
    m = (struct map){back->nx, back->ny, back->dx, back->dy, back->v};
    if (back->ny == 1 && back->dy == back->dx)
        m.dy = g->dy; /* a profile read from a file is a map with dy = dx */
    compare(f, "by our reader", g, &m);
    assert_string_equal(back->channel, "height");
    rc_grid_free(back);
}

/* The readers of text ask the user in some cases. A matrix of one column could be a profile, three points
 * could be a list, and one line is not a raster. In MATLAB a column is a profile too, and one number is not
 * a map. */
static bool
reader_takes(size_t f, const struct rc_grid *g)
{
    bool csv = strcmp(formats[f].name, "csv") == 0, xyz = strcmp(formats[f].name, "xyz") == 0;
    bool mat = strcmp(formats[f].name, "mat") == 0;

    return !(mat && g->nx == 1) && !(csv && g->nx == 1) && !(xyz && (g->nx == 1 || g->ny == 1));
}

static void
there_and_back(size_t nx, size_t ny, double missing)
{
    struct rc_grid *g = random_grid(nx, ny, missing);

    for (size_t f = 0; f < sizeof formats / sizeof *formats; f++) {
        struct rc_export_wish wish =
            formats[f].type < 0 ? plain_export : typed((enum rc_raw)formats[f].type);
        struct written made = export(formats[f].name, &g, 1, &wish);

        if (formats[f].decode != NULL) {
            struct map m = formats[f].decode(&made);
            compare(f, "decoded", g, &m);
            free(m.v);
        }
        if (formats[f].reader != NULL && reader_takes(f, g) && missing < 1)
            compare_reader(f, g, &made);
        free(made.bytes);
    }
    rc_grid_free(g);
}

static void
all_formats_on_ugly_sizes(void **state)
{
    static const size_t size[][2] = {{1, 1}, {1, 17}, {29, 1},  {2, 3},
                                     {3, 2}, {7, 13}, {61, 31}, {128, 5}};

    (void)state;
    for (size_t k = 0; k < sizeof size / sizeof *size; k++) {
        there_and_back(size[k][0], size[k][1], 0);
        there_and_back(size[k][0], size[k][1], 0.15);
    }
    there_and_back(5, 3, 1);
}

static void
every_format_is_tried(void **state)
{
    (void)state;
    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++) {
        size_t f = 0;

        if (strcmp((*e)->name, "stl") == 0)
            continue; /* not a map: see format_stl.c */
        while (f < sizeof formats / sizeof *formats && strcmp((*e)->name, formats[f].name) != 0)
            f++;
        if (f == sizeof formats / sizeof *formats)
            fail_msg("%s is in exports.list and not in this test", (*e)->name);
    }
}

static void
equal_heights(void **state)
{
    struct rc_grid *g = random_grid(4, 3, 0);

    (void)state;
    for (int sign = -1; sign <= 1; sign++) {
        for (size_t k = 0; k < 12; k++)
            g->v[k] = sign * 2.5e-6;
        for (size_t f = 0; f < sizeof formats / sizeof *formats; f++) {
            struct rc_export_wish wish =
                formats[f].type < 0 ? plain_export : typed((enum rc_raw)formats[f].type);
            struct written made = export(formats[f].name, &g, 1, &wish);
            struct map m;

            if (formats[f].decode != NULL) {
                m = formats[f].decode(&made);
                /* the offset of SUR is rounded down to a float, and the step is larger by the rest */
                compare(f, "decoded", g, &m);
                free(m.v);
            } else {
                compare_reader(f, g, &made);
            }
            free(made.bytes);
        }
    }
    rc_grid_free(g);
}

static void
same_frames_same_bytes(void **state)
{
    struct rc_grid *holes = random_grid(13, 7, 0.1), *whole = random_grid(13, 7, 0);

    (void)state;
    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++) {
        struct rc_grid *g = (*e)->relief ? whole : holes;
        struct written a = export((*e)->name, &g, 1, &plain_export),
                       b = export((*e)->name, &g, 1, &plain_export);

        assert_int_equal(a.n, b.n);
        assert_memory_equal(a.bytes, b.bytes, a.n);
        free(a.bytes);
        free(b.bytes);
    }
    rc_grid_free(holes);
    rc_grid_free(whole);
}

/* Numbers have a decimal point in every locale. */
static void
comma_locale(void **state)
{
    struct rc_grid *holes = random_grid(3, 2, 0.2), *whole = random_grid(3, 2, 0);

    (void)state;
    for (const struct rc_export *const *e = rc_exports; *e != NULL; e++) {
        struct rc_grid *g = (*e)->relief ? whole : holes;
        struct written a, b;

        setlocale(LC_NUMERIC, "C");
        a = export((*e)->name, &g, 1, &plain_export);
        if (!set_comma_locale())
            skip();
        b = export((*e)->name, &g, 1, &plain_export);
        assert_int_equal(a.n, b.n);
        assert_memory_equal(a.bytes, b.bytes, a.n);
        free(a.bytes);
        free(b.bytes);
    }
    setlocale(LC_NUMERIC, "C");
    rc_grid_free(holes);
    rc_grid_free(whole);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_is_tried),  cmocka_unit_test(all_formats_on_ugly_sizes),
        cmocka_unit_test(equal_heights),          cmocka_unit_test(same_frames_same_bytes),
        cmocka_unit_test(the_locale_has_a_comma), cmocka_unit_test(comma_locale),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
