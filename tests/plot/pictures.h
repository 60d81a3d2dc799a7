/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads pictures of rc-render for the tests: pixels, and positions of the parts of a graph. */
#ifndef RC_TEST_PICTURES_H
#define RC_TEST_PICTURES_H

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "formats/rcg/rcg.h"
#include "libcontact/grid.h"

/* Checks |a - b| <= most; prints the values otherwise. */
#define assert_near(a, b, most) check_near((a), (b), (most), __FILE__, __LINE__)
static inline void
check_near(double a, double b, double most, const char *file, int line)
{
    if (fabs(a - b) <= most)
        return;
    print_error("%.9g is not within %g of %.9g\n", a, most, b);
    _fail(file, line);
}

/* The folder in which the tests of a program draw, from set-up to tear-down of their group. */
static char folder[] = "/tmp/rc_pictures.XXXXXX";

static inline int
make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) == NULL;
}

static inline int
remove_folder(void **state)
{
    char remove[64];

    (void)state;
    snprintf(remove, sizeof remove, "rm -rf %s", folder);
    return system(remove);
}

struct picture {
    png_image head;
    unsigned char *rgb;
};

static inline void
put_file(const char *name, const char *text)
{
    char path[256];
    FILE *file;

    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* Writes frames as a stream and frees them. */
static inline void
put_stream(const char *name, struct rc_grid **grid, size_t n)
{
    char path[256];
    FILE *file;
    struct rc_writer *w;

    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "wb");
    assert_non_null(file);
    w = rc_writer_new(file, NULL);
    for (size_t k = 0; k < n; k++) {
        assert_int_equal(rc_writer_put(w, grid[k], NULL), RC_OK);
        rc_grid_free(grid[k]);
    }
    assert_int_equal(rc_writer_end(w, NULL), RC_OK);
    rc_writer_free(w);
    fclose(file);
}

/* Runs a command in the folder, the tools on its PATH, and reads the picture out.png. */
static inline struct picture
draw(const char *command)
{
    struct picture p = {.head = {.version = PNG_IMAGE_VERSION}};
    char text[2048];

    assert_non_null(getenv("RC_BIN"));
    snprintf(text, sizeof text, "cd %s && PATH=\"%s:$PATH\" && %s", folder, getenv("RC_BIN"),
             command);
    assert_int_equal(system(text), 0);
    snprintf(text, sizeof text, "%s/out.png", folder);
    assert_true(png_image_begin_read_from_file(&p.head, text));
    p.head.format = PNG_FORMAT_RGB;
    p.rgb = malloc(PNG_IMAGE_SIZE(p.head));
    assert_non_null(p.rgb);
    assert_true(png_image_finish_read(&p.head, NULL, p.rgb, 0, NULL));
    return p;
}

/* 0xRRGGBB */
static inline unsigned
pixel(const struct picture *p, size_t x, size_t y)
{
    const unsigned char *at = p->rgb + 3 * (y * p->head.width + x);

    return (unsigned)at[0] << 16 | (unsigned)at[1] << 8 | at[2];
}

/* The ink has the colour 0x222222: dark grey. */
static inline int
is_dark(const struct picture *p, size_t x, size_t y)
{
    unsigned c = pixel(p, x, y);

    return (c >> 16) < 0x80 && (c >> 8 & 0xff) < 0x80 && (c & 0xff) < 0x80 &&
           (c >> 16) == (c & 0xff);
}

/* The longest dark run of a row, and its start. */
static inline size_t
longest_run(const struct picture *p, size_t y, size_t *start)
{
    size_t longest = 0;

    for (size_t x = 0, n = 0; x < p->head.width; x++) {
        n = is_dark(p, x, y) ? n + 1 : 0;
        if (n > longest) {
            longest = n;
            *start = x + 1 - n;
        }
    }
    return longest;
}

/* The frame of the plot: the first and the last of the long dark rows, which an axis mark may lengthen. */
struct frame {
    size_t left, right, top, bottom; /* extent of the ink */
};

static inline struct frame
find_frame(const struct picture *p)
{
    struct frame f = {0};
    size_t longest = 0, start = 0, n;

    for (size_t y = 0; y < p->head.height; y++)
        if ((n = longest_run(p, y, &start)) > longest)
            longest = n;
    assert_true(longest > 100);
    for (size_t y = p->head.height; y-- > 0;)
        if ((n = longest_run(p, y, &start)) + 30 >= longest) {
            f.bottom = f.bottom == 0 ? y : f.bottom;
            f.top = y;
            f.left = start;
            f.right = start + n - 1;
        }
    return f;
}

/* Finds the middles of the dark runs of a row from x on, or of a column from y on; returns their number. */
static inline size_t
find_marks(const struct picture *p, int across, size_t line, size_t from, size_t to, double *at,
           size_t most)
{
    size_t n = 0;

    for (size_t k = from, run = 0; k <= to + 1; k++) {
        if (k <= to && (across ? is_dark(p, k, line) : is_dark(p, line, k))) {
            run++;
            continue;
        }
        if (run > 0) {
            assert_true(n < most);
            at[n++] = (double)k - 0.5 - 0.5 * (double)run;
        }
        run = 0;
    }
    return n;
}

/* The middle of the pixels of that colour inside the frame; returns their number. */
static inline size_t
find_colour(const struct picture *p, const struct frame *f, unsigned colour, double *x, double *y)
{
    size_t n = 0;

    *x = *y = 0;
    for (size_t j = f->top + 2; j < f->bottom - 1; j++)
        for (size_t i = f->left + 2; i < f->right - 1; i++)
            if (pixel(p, i, j) == colour) {
                *x += (double)i;
                *y += (double)j;
                n++;
            }
    *x /= (double)n;
    *y /= (double)n;
    return n;
}

#endif
