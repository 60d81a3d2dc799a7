/* The panels of a sheet are of one size, in the order of the stream, row by row, and share their
 * colours. */
#include "pictures.h"

static const double value[] = {1, 2, 3}; /* GPa; 0 is black, 4 GPa white */
static const unsigned shade[] = {0x404040, 0x808080, 0xbfbfbf};

/* Stresses at three depths, each the same everywhere, of 20 by 10 nodes. */
static void
put_depths(void)
{
    struct rc_shape shape = {20, 10, 1e-6, 1e-6};
    struct rc_grid *grid[3];

    for (size_t k = 0; k < 3; k++) {
        grid[k] = rc_grid_new(&shape, "mises", "Pa", NULL);
        assert_non_null(grid[k]);
        assert_int_equal(rc_grid_set_number(grid[k], "depth", 1e-6 * (double)(k + 1), NULL), RC_OK);
        for (size_t i = 0; i < 200; i++)
            grid[k]->v[i] = value[k] * 1e9;
    }
    put_stream("d.rcg", grid, 3);
}

struct box {
    size_t left, right, top, bottom, n;
};

/* Where the panel of a colour is: the bar has some pixels of it too, but no row of 50. */
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

/* Without a range the colours span all panels: from 0, as the stress does, to the largest. */
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

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(side_by_side),
        cmocka_unit_test(row_by_row),
        cmocka_unit_test(colours_of_all),
    };
    char remove[64];
    int failed;

    if (mkdtemp(folder) == NULL)
        return 1;
    put_depths();
    failed = cmocka_run_group_tests(tests, NULL, NULL);
    snprintf(remove, sizeof remove, "rm -rf %s", folder);
    return system(remove) == 0 ? failed : 1;
}
