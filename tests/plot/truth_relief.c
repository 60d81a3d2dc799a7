/* SPDX-License-Identifier: GPL-3.0-or-later */
/* In a relief higher parts hide the parts behind them, the map rotates with the azimuth of the viewer.
 * Heights are exaggerated by the factor in the figure. In a hillshade the slopes that face the upper left are
 * bright. */
#include "pictures.h"

enum {
    N = 200
};

/* A map of N by N nodes with a spacing of 1 um; `height` in micrometres. */
static void
put_map(const char *channel, const char *unit, double size, double (*height)(size_t i, size_t j))
{
    struct rc_shape shape = {N, N, 1e-6, 1e-6};
    struct rc_grid *g = rc_grid_new(&shape, channel, unit, NULL);

    assert_non_null(g);
    for (size_t j = 0; j < N; j++)
        for (size_t i = 0; i < N; i++)
            g->v[j * N + i] = size * height(i, j);
    put_stream("m.rcg", &g, 1);
}

/* Reddish and bluish pixels left of the colour bar, their number and middle. */
struct spot {
    size_t n, top, left, right;
    double x, y;
};

static struct spot
find_spot(const struct picture *p, bool red)
{
    struct spot s = {.top = SIZE_MAX, .left = SIZE_MAX};

    for (size_t y = 0; y < p->head.height; y++)
        for (size_t x = 0; x < p->head.width * 8 / 10; x++) {
            unsigned c = pixel(p, x, y);
            int more = (int)(c >> 16) - (int)(c & 0xff);

            if (red ? more < 40 : more > -40)
                continue;
            s.x += (double)x;
            s.y += (double)y;
            s.top = y < s.top ? y : s.top;
            s.left = x < s.left ? x : s.left;
            s.right = x > s.right ? x : s.right;
            s.n++;
        }
    s.x /= (double)s.n;
    s.y /= (double)s.n;
    return s;
}

static bool
is_blue(const struct picture *p, size_t x, size_t y)
{
    unsigned c = pixel(p, x, y);

    return (c & 0xff) > (c >> 16) + 40;
}

/* ---- hidden surfaces ---- */

/* A ridge along x at the front, and a ditch directly behind it. */
static double
ridge_and_ditch(size_t i, size_t j)
{
    (void)i;
    return j >= 150 && j < 170 ? 1 : j >= 130 && j < 150 ? -1 : 0;
}

static void
ditch_is_hidden(void **state)
{
    struct picture p;
    size_t front, back;

    (void)state;
    put_map("height", "m", 1e-6, ridge_and_ditch);
    p = draw("rc-render --colormap bluered --view 0,20 -o out.png m.rcg");
    front = find_spot(&p, false).n;
    assert_true(find_spot(&p, true).n > 5000);
    free(p.rgb);
    p = draw("rc-render --colormap bluered --view 180,20 -o out.png m.rcg");
    back = find_spot(&p, false).n;
    free(p.rgb);
    p = draw("rc-render --colormap bluered --view 0,90 -o out.png m.rcg");
    assert_true(find_spot(&p, false).n > 10 * back / 2);
    free(p.rgb);
    assert_true(back > 1000); /* from the other side the ditch is visible */
    assert_int_equal(front, 0);
}

/* ---- the viewer walks around ---- */

/* A hill in the upper left quarter of the map. */
static double
upper_left(size_t i, size_t j)
{
    return i >= 20 && i < 60 && j >= 30 && j < 70 ? 1 : 0;
}

static void
map_turns(void **state)
{
    /* from above: the position of the hill from the middle of the map: of 200 nodes it is 60.5 to the left
     * and 50.5 upwards */
    static const struct {
        const char *view;
        double right, down;
    } seen[] = {{"0,90", -60.5, -50.5},
                {"90,90", 50.5, -60.5},
                {"180,90", 60.5, 50.5},
                {"270,90", -50.5, 60.5}};
    char command[256];

    (void)state;
    put_map("height", "m", 1e-6, upper_left);
    for (size_t k = 0; k < 4; k++) {
        struct picture p;
        struct spot hill;
        struct frame f;
        double node;

        snprintf(command, sizeof command,
                 "rc-render --colormap bluered --range -1um:1um --view %s -o out.png m.rcg",
                 seen[k].view);
        p = draw(command);
        hill = find_spot(&p, true);
        f = find_frame(&p); /* the edge of the floor; its lowest line is an axis */
        node = (double)(f.right - f.left) / N;
        assert_true(hill.n > 1000);
        assert_near((double)hill.right - (double)hill.left, 40 * node, 2 * node);
        assert_near((hill.x - 0.5 * (double)(f.left + f.right)) / node, seen[k].right, 2);
        assert_near((hill.y - ((double)f.bottom - 100 * node)) / node, seen[k].down, 2);
        free(p.rgb);
    }
}

/* ---- how high ---- */

/* The left half is high, the right half low. */
static double
step(size_t i, size_t j)
{
    (void)j;
    return i < N / 2 ? 1 : -1;
}

/* 2 um over a map of 200 um. A height of 0.4 times the side would be an exaggeration of 40, of which the next
 * lower round number is 20. The height of 40 um, seen at 30 degrees, is a fifth of the width times cos 30. */
static void
heights_are_exaggerated(void **state)
{
    struct picture p;
    struct spot high, low;
    size_t far_edge = 0; /* edge of the low half */
    double width;

    (void)state;
    put_map("height", "m", 1e-6, step);
    p = draw("rc-render --colormap bluered --view 0,30 -o out.png m.rcg && tr '\\0' = <out.png | "
             "grep -aq 'Description='");
    high = find_spot(&p, true);
    low = find_spot(&p, false);
    width = (double)low.right - (double)high.left;
    while (!is_blue(&p, high.left + (size_t)(0.75 * width), far_edge))
        far_edge++;
    assert_near((double)(far_edge - high.top) / width, 0.2 * sqrt(0.75), 0.005);
    free(p.rgb);
}

/* In a reduced pressure map each piece shows the largest value of its nodes. */
static double
spike(size_t i, size_t j)
{
    return i == 77 && j == 120 ? 1 : 0;
}

static void
peak_is_drawn(void **state)
{
    struct rc_shape shape = {2200, 50, 1e-6, 1e-6};
    struct rc_grid *g = rc_grid_new(&shape, "pressure", "Pa", NULL);
    struct picture p;

    (void)state;
    memset(g->v, 0, 2200 * 50 * sizeof *g->v);
    g->v[25 * 2200 + 1001] = 1e9;
    put_stream("m.rcg", &g, 1);
    p = draw("rc-render --colormap bluered --range -1GPa:1GPa --view 0,40 -o out.png m.rcg");
    assert_true(find_spot(&p, true).n > 20);
    free(p.rgb);
    put_map("pressure", "Pa", 1e9, spike);
    p = draw("rc-render --colormap bluered --range -1GPa:1GPa --view 20,40 -o out.png m.rcg");
    assert_true(find_spot(&p, true).n > 20);
    free(p.rgb);
}

/* ---- hillshade ---- */

static double
pyramid(size_t i, size_t j)
{
    double x = fabs((double)i - 99.5), y = fabs((double)j - 99.5);

    return 100 - (x > y ? x : y);
}

/* The left and the upper face of a pyramid are equally bright, and brighter than the others. */
static void
upper_left_is_bright(void **state)
{
    static const int at[4][2] = {{-60, 0}, {0, -60}, {60, 0}, {0, 60}};
    unsigned bright[4];
    struct picture p;
    struct frame f;

    (void)state;
    put_map("height", "m", 1e-6, pyramid);
    p = draw("rc-render --colormap grey --range -1mm:1mm --hillshade -o out.png m.rcg");
    f = find_frame(&p);
    for (size_t k = 0; k < 4; k++) {
        double node = (double)(f.right - f.left) / N;

        bright[k] = pixel(&p, (size_t)(0.5 * (double)(f.left + f.right) + at[k][0] * node),
                          (size_t)(0.5 * (double)(f.top + f.bottom) + at[k][1] * node)) &
                    0xff;
    }
    assert_near(bright[0], bright[1], 2); /* heights differ by a node */
    assert_near(bright[2], bright[3], 2);
    /* for slopes of 0.7 and light at 45 degrees the cosines are (0.71 + 0.35) / 1.22 and (0.71 - 0.35) /
     * 1.22, relative to that of a flat map. The grey is 127.5 to 140 */
    assert_near((double)bright[0] / bright[2],
                (0.35 + 0.65 * 1.4950 / 1.2207) / (0.35 + 0.65 * 0.5050 / 1.2207), 0.05);
    free(p.rgb);
}

static double
hilly(size_t i, size_t j)
{
    double x = (double)i - 60, y = (double)j - 90;

    return i > 120 && j > 130 && i < 150 && j < 170 ? NAN : 20 * exp(-(x * x + y * y) / 1500);
}

/* The edges of letters and lines differ there. */
static void
svg_is_the_same(void **state)
{
    struct picture p, q;
    size_t other = 0;

    (void)state;
    put_map("height", "m", 1e-6, hilly);
    p = draw("rc-render --quiet --view 30,50 --width 900 -o out.png m.rcg");
    q = draw("rc-render --quiet --view 30,50 --width 900 -o out.svg m.rcg && "
             "rsvg-convert -o out.png out.svg");
    assert_int_equal(p.head.width, q.head.width);
    assert_int_equal(p.head.height, q.head.height);
    for (size_t y = 0; y < p.head.height; y++)
        for (size_t x = 0; x < p.head.width; x++) {
            unsigned a = pixel(&p, x, y), b = pixel(&q, x, y);

            for (int k = 0; k < 24; k += 8)
                if (abs((int)(a >> k & 0xff) - (int)(b >> k & 0xff)) > 64) {
                    other++;
                    break;
                }
        }
    assert_true(other < p.head.width * p.head.height / 100);
    free(p.rgb);
    free(q.rgb);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ditch_is_hidden),         cmocka_unit_test(map_turns),
        cmocka_unit_test(heights_are_exaggerated), cmocka_unit_test(peak_is_drawn),
        cmocka_unit_test(upper_left_is_bright),    cmocka_unit_test(svg_is_the_same),
    };

    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
