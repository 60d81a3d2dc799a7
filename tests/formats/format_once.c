/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file is opened once: whatever its reader took from it at first is not looked at again for the values. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "formats/format.h"
#include "made/made.h"

/* Bytes that a reader has no more use for after the file was opened are overwritten. A second look at them
 * would find no file of the format any more. */
static void
wipe(struct bytes *b, size_t from, size_t to)
{
    memset(b->data + from, '\a', to - from);
}

static struct rc_maps *
open_maps(const struct rc_format *format, const struct rc_file *file, const struct rc_wish *wish)
{
    struct rc_err err = {""};
    struct rc_maps *maps = rc_format_open(format, file, wish, &err);

    if (maps == NULL)
        fail_msg("%s", err.text);
    return maps;
}

/* Reads map `index` twice and compares its values. */
static void
expect(struct rc_maps *maps, const struct rc_wish *wish, size_t index, double dx, const double *v,
       size_t n)
{
    for (size_t time = 0; time < 2; time++) {
        struct rc_notes notes = {0};
        struct rc_err err = {""};
        struct rc_grid *g = rc_format_read(maps, wish, index, &notes, &err);

        if (g == NULL)
            fail_msg("%s, map %zu: %s", maps->format->name, index + 1, err.text);
        assert_int_equal(g->nx * g->ny, n);
        assert_true(g->dx == dx);
        for (size_t k = 0; k < n; k++)
            assert_true(g->v[k] == v[k]);
        rc_grid_free(g);
    }
}

/* Text with two maps, the format that it is recognised as, and the text from which on it is looked at again:
 * matrices are kept as text until they are read. */
static const struct {
    const char *text, *format, *kept;
    size_t maps;
} texts[] = {
    {"x [m],z1 [m],z2 [m],z3 [m]\n0.5,1,-1,0\n1.0,2,-2,0\n1.5,3,-3,0\n2.0,4,-4,1\n", "profile",
     NULL, 3},
    {"x [m];z [m]\n2,0;4\n1,5;3\n1,0;2\n0,5;1\n", "profile", NULL, 1},
    {"x/m\ty/m\tz1/m\tz2/m\n1\t1\t3\t-3\n1.5\t1\t4\t-4\n1\t0.5\t1\t-1\n1.5\t0.5\t2\t-2\n", "xyz",
     NULL, 2},
    {"x [m] y [m] z [m]\n0.5 0 2\n0 0 1\n1.5 0 4\n1 0 3\n", "xyz", NULL, 1},
    {"# Channel: a\n# Width: 1 m\n# Height: 1 m\n# Value units: m\n1 2\n3 4\n"
     "# Channel: b\n# Width: 1 m\n# Height: 1 m\n# Value units: m\n-1 -2\n-3 -4\n",
     "ascii", "1 2\n3 4\n", 2},
};

/* The format is chosen, and the maps are listed and read, from what was opened for the choice. */
static void
text_is_opened_once(void **state)
{
    static const double v[3][4] = {{1, 2, 3, 4}, {-1, -2, -3, -4}, {0, 0, 0, 1}};

    (void)state;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        struct bytes b = {0};
        struct rc_channel channel[2];
        RC_OWN(rc_maps, maps) = NULL;
        struct rc_file file;

        add_text(&b, texts[k].text);
        file = file_of(&b, "text.txt");
        maps = open_maps(NULL, &file, &rc_no_wish);
        assert_string_equal(maps->format->name, texts[k].format);
        wipe(&b, 0,
             texts[k].kept == NULL
                 ? b.n
                 : (size_t)(strstr(texts[k].text, texts[k].kept) - texts[k].text));
        assert_int_equal(rc_maps_list(maps, channel, 2), texts[k].maps);
        for (size_t m = texts[k].maps; m-- > 0;)
            expect(maps, &rc_no_wish, m, 0.5, v[m], 4);
        drop(&b);
    }
}

/* Files of instruments: those whose numbers were unpacked, and headers of text up to the first number. */
static const struct {
    const char *format;
    made_maker *make;
    int variant;
    const char *kept; /* as above */
} files[] = {
    {"vk", make_vk6, 0, NULL},
    {"mnt", make_mnt, 0, NULL},
    {"keyence", make_keyence, 0, "\"10.0\""},
    {"wykotext", make_wykotext, 2, "\r\n0.000"},
    {"zygo", make_zygo, 0, "#\n1"},
};

static void
a_header_is_read_once(void **state)
{
    const struct rc_wish wish = wish_for(0);

    (void)state;
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        const struct rc_format *format = rc_format_named(files[k].format);
        struct rc_err err = {""};
        struct bytes b = {0};
        RC_OWN(rc_maps, maps) = NULL;
        RC_OWN(rc_grid, g) = NULL;
        RC_OWN(rc_grid, after) = NULL;
        struct rc_file file;
        const char *at;

        files[k].make(&b, files[k].variant);
        file = file_of(&b, "made");
        at = files[k].kept == NULL ? (const char *)b.data + b.n
                                   : rc_piece_find(rc_file_piece(&file), files[k].kept);
        assert_non_null(at);
        if ((g = read_map(format, &file, &wish, 0, NULL, &err)) == NULL)
            fail_msg("%s: %s", files[k].format, err.text);
        maps = open_maps(format, &file, &wish);
        wipe(&b, 0, (size_t)(at - (const char *)b.data));
        if ((after = rc_format_read(maps, &wish, 0, NULL, &err)) == NULL)
            fail_msg("%s: %s", files[k].format, err.text);
        assert_int_equal(after->nx * after->ny, NX * NY);
        for (size_t i = 0; i < NX * NY; i++)
            assert_true(after->v[i] == g->v[i] ||
                        (after->v[i] != after->v[i] && g->v[i] != g->v[i]));
        drop(&b);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_opened_once),
        cmocka_unit_test(a_header_is_read_once),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
