/* Which arrays of a MAT file are channels, what is refused, and what damaged files do. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "made/made.h"

extern const struct rc_format rc_format_mat;

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

/* Several arrays are several channels, numbers among them are none; the unit is of neither. */
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
    assert_int_equal(rc_format_mat.list(&file, &rc_no_wish, channel, 4, NULL), 2);
    assert_string_equal(channel[0].name, "phase");
    assert_string_equal(channel[1].name, "Z");
    assert_string_equal(channel[1].unit, "");
    assert_int_equal(channel[1].nx, 4);
    assert_int_equal(channel[1].ny, 3);
    assert_true(fabs(channel[1].dx - 2e-6) < 1e-20 && channel[1].dy == channel[1].dx);
    assert_int_equal(rc_format_topography(channel, 2, NULL).index, 1);
    drop(&m);
}

/* A vector is a profile where there is no map; x alone is one too. */
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
    mat_number(&m, "one", 1);
    refuse(&rc_format_mat, &m, "'one' is one number or none");
    m.n = 128;
    add_rising(&m, "h", DOUBLE, 3, 4, 1);
    refuse(&rc_format_mat, &m, "--dx LENGTH"); /* and the unit is asked for at once */
    mat_number(&m, "dx", 0.5);
    refuse(&rc_format_mat, &m, "its steps are 0.5 and 0.5 of a unit not given");
    m.n = 128;
    add_rising(&m, "x", DOUBLE, 1, 4, 1);
    m.data[m.n - 1] = 0x41; /* the last position is far away */
    add_rising(&m, "y", DOUBLE, 1, 3, 1);
    add_rising(&m, "h", DOUBLE, 3, 4, 1);
    refuse(&rc_format_mat, &m, "the positions of the axis 'x' are not evenly apart");
    m.n = 128;
    add_rising(&m, "h", DOUBLE, 3, 4, 1);
    set_raw(&m, 128 + 8 + 16 + 8, RC_RAW_I32, 4); /* 4 rows */
    refuse(&rc_format_mat, &m, "the header promises 128 bytes of h, the file has 96");
    m.n = 60;
    refuse(&rc_format_mat, &m, "no MAT file of version 5");
    drop(&m);
}

/* What zlib's own checksum finds is refused. */
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

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(several_arrays),   cmocka_unit_test(vectors),
        cmocka_unit_test(refusals),         cmocka_unit_test(damaged_packing),
        cmocka_unit_test(cuts_and_changes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
