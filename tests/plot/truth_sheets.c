/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The panels of a sheet have one size, are in the order of the stream, row by row, and share their
 * colours. */
#include "pictures.h"

#include <math.h>

static const double value[] = {1, 2, 3}; /* GPa; 0 is black, 4 GPa white */
static const unsigned shade[] = {0x404040, 0x808080, 0xbfbfbf};

/* Stresses at three depths, uniform at each depth, on 20 by 10 nodes. */
static int
make_depths(void **state)
{
    struct rc_shape shape = {20, 10, 1e-6, 1e-6};
    struct rc_grid *grid[3];

    if (make_folder(state) != 0)
        return 1;
    for (size_t k = 0; k < 3; k++) {
        grid[k] = rc_grid_new(&shape, "mises", "Pa", NULL);
        assert_non_null(grid[k]);
        assert_int_equal(rc_grid_set_number(grid[k], "depth", 1e-6 * (double)(k + 1), NULL), RC_OK);
        for (size_t i = 0; i < 200; i++)
            grid[k]->v[i] = value[k] * 1e9;
    }
    put_stream("d.rcg", grid, 3);
    return 0;
}

struct box {
    size_t left, right, top, bottom, n;
};

/* The position of the panel with a colour: the bar has pixels of this colour too, but no run of 50 in a
 * row. */
static struct box
find_box(const struct picture *p, unsigned colour)
{
    struct box b = {.left = SIZE_MAX, .top = SIZE_MAX};

    for (size_t y = 0; y < p->head.height; y++)
        for (size_t x = 0, run = 0; x < p->head.width; x++) {
            run = pixel(p, x, y) == colour ? run + 1 : 0;
            if (run < 50)
                continue;
            b.left = x + 1 - run < b.left ? x + 1 - run : b.left;
            b.right = x > b.right ? x : b.right;
            b.top = y < b.top ? y : b.top;
            b.bottom = y;
            b.n++;
        }
    assert_true(b.n > 0);
    return b;
}

static void
panels(const char *options, struct box b[3])
{
    struct picture p;
    char command[512];

    snprintf(command, sizeof command,
             "rc-render --colormap grey --range 0:4GPa %s -o out.png d.rcg", options);
    p = draw(command);
    for (size_t k = 0; k < 3; k++) {
        double w, h;

        b[k] = find_box(&p, shade[k]);
        w = (double)(b[k].right - b[k].left + 1);
        h = (double)(b[k].bottom - b[k].top + 1);
        assert_near(w / h, 2, 0.02);
        assert_int_equal(b[k].right - b[k].left, b[0].right - b[0].left);
        assert_int_equal(b[k].bottom - b[k].top, b[0].bottom - b[0].top);
    }
    free(p.rgb);
}

static void
side_by_side(void **state)
{
    struct box b[3];

    (void)state;
    panels("--depth 1um,2um,3um --sheet 3x1", b);
    for (size_t k = 1; k < 3; k++) {
        assert_true(b[k].left > b[k - 1].right);
        assert_int_equal(b[k].top, b[0].top);
    }
}

static void
row_by_row(void **state)
{
    struct box b[3];

    (void)state;
    panels("--sheet 2x2 --width 700", b);
    assert_true(b[1].left > b[0].right && b[1].top == b[0].top);
    assert_true(b[2].left == b[0].left && b[2].top > b[0].bottom);
}

/* Without a range the colours span all panels: from 0, because the stress is not negative, to the largest
 * value. */
static void
colours_of_all(void **state)
{
    struct picture p;

    (void)state;
    p = draw("rc-render --colormap grey --sheet auto -o out.png d.rcg");
    find_box(&p, 0x555555); /* 1 of 3 */
    find_box(&p, 0xaaaaaa);
    free(p.rgb);
}

static unsigned
middle(const struct picture *p, const struct box *b)
{
    return pixel(p, (b->left + b->right) / 2, (b->top + b->bottom) / 2);
}

/* The grey of a panel whose value is the fraction t of the range of colours. */
static void
assert_greys(const char *options, const double t[3])
{
    char command[256];
    struct picture p;
    struct box b[3];

    panels("--sheet 3x1", b);
    snprintf(command, sizeof command, "rc-render --colormap grey --sheet 3x1 %s -o out.png d.rcg",
             options);
    p = draw(command);
    for (size_t k = 0; k < 3; k++) {
        unsigned c = middle(&p, &b[k]);

        assert_near((double)(c & 0xff), 255 * t[k], 1);
        assert_int_equal(c, (c & 0xff) * 0x10101);
    }
    free(p.rgb);
}

/* Of 600 values a third are 1, a third 2 and a third 3: half are below 2, all are below 3. */
static void
percentiles_of_all(void **state)
{
    (void)state;
    assert_greys("--range 0%:50%", (const double[]){0, 1, 1});
    assert_greys("--range 0%:100%", (const double[]){0, 0.5, 1});
    assert_greys("--range 40%:100%", (const double[]){0, 0, 1});
}

/* The colours start at the smallest of all values, or at the lower end of a range. */
static void
logarithm_of_all(void **state)
{
    (void)state;
    assert_greys("--log", (const double[]){0, log(2) / log(3), 1});
    assert_greys("--log --range 0.5GPa:8GPa", (const double[]){0.25, 0.5, log(6) / log(16)});
}

/* 20 by 10 nodes of 1 um: 10 columns lie between -5 and 5 um, 4 between -2 and 2 um. */
static void
window_of_all(void **state)
{
    struct picture p;

    (void)state;
    p = draw("rc-render --colormap grey --range 0:4GPa --sheet 3x1 --window -5um:5um,-2um:2um "
             "-o out.png d.rcg");
    for (size_t k = 0; k < 3; k++) {
        struct box b = find_box(&p, shade[k]);

        assert_near((double)(b.right - b.left + 1) / (double)(b.bottom - b.top + 1), 2.5, 0.03);
    }
    free(p.rgb);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(side_by_side),     cmocka_unit_test(row_by_row),
        cmocka_unit_test(colours_of_all),   cmocka_unit_test(percentiles_of_all),
        cmocka_unit_test(logarithm_of_all), cmocka_unit_test(window_of_all),
    };

    return cmocka_run_group_tests(tests, make_depths, remove_folder);
}
