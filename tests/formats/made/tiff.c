/* SPDX-License-Identifier: GPL-3.0-or-later */
/* TIFF files made in memory. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "made.h"

enum {
    TAGS_MOST = 40
};

size_t
tiff_directory(struct bytes *b, const struct tag *tag)
{
    static const size_t width[] = {[1] = 1, [2] = 1, [3] = 2, [4] = 4, [7] = 1, [8] = 2, [12] = 8};
    uint32_t place[TAGS_MOST] = {0};
    size_t n = 0, at;

    while (tag[n].tag != 0) {
        const struct tag *t = &tag[n];
        place[n++] = (uint32_t)b->n;
        if (t->text != NULL)
            add(b, t->text, t->count);
        else if (t->type == 12)
            add_f64(b, t->number);
        if (b->n % 2 != 0)
            add(b, "", 1);
    }
    at = b->n;
    add_number(b, n, 2);
    for (size_t k = 0; k < n; k++) {
        const struct tag *t = &tag[k];
        size_t size = width[t->type] * t->count;

        add_number(b, t->tag, 2);
        add_number(b, t->type, 2);
        add_number(b, t->count, 4);
        if (size > 4) {
            add_number(b, place[k], 4);
        } else if (t->text != NULL) {
            add(b, t->text, t->count);
            add(b, "\0\0\0", 4 - t->count);
        } else {
            add_number(b, (uint64_t)(int64_t)t->number, width[t->type]);
            add(b, "\0\0\0", 4 - width[t->type]);
        }
    }
    add_number(b, 0, 4); /* the next page: set by tiff_page */
    return at;
}

void
tiff_start(struct bytes *b, bool big)
{
    *b = (struct bytes){.big = big};
    add(b, big ? "MM" : "II", 2);
    add_number(b, 42, 2);
    add_number(b, 0, 4);
}

/* A page like that of tiff_page, compressed by the method `compression` (tag 259). */
static size_t
tiff_any_page(struct bytes *b, size_t last, size_t nx, size_t ny, unsigned bits, unsigned samples,
              const char *description, const void *pixels, size_t n, const struct tag *more,
              unsigned compression)
{
    struct tag tag[TAGS_MOST];
    size_t k = 0, at;
    uint32_t strip = (uint32_t)b->n;

    add(b, pixels, n);
    if (b->n % 2 != 0)
        add(b, "", 1);
    tag[k++] = (struct tag){256, 4, 1, NULL, (double)nx};
    tag[k++] = (struct tag){257, 4, 1, NULL, (double)ny};
    tag[k++] = (struct tag){258, 3, 1, NULL, bits};
    tag[k++] = (struct tag){259, 3, 1, NULL, compression};
    tag[k++] = (struct tag){262, 3, 1, NULL, samples == 3 ? 2 : 1};
    if (description != NULL)
        tag[k++] = (struct tag){270, 2, (uint32_t)strlen(description) + 1, description, 0};
    tag[k++] = (struct tag){273, 4, 1, NULL, strip};
    tag[k++] = (struct tag){277, 3, 1, NULL, samples};
    tag[k++] = (struct tag){278, 4, 1, NULL, (double)ny};
    tag[k++] = (struct tag){279, 4, 1, NULL, (double)n};
    for (; more != NULL && more->tag != 0; more++)
        tag[k++] = *more;
    tag[k] = (struct tag){0};
    assert_true(k < TAGS_MOST);
    at = tiff_directory(b, tag);
    set_raw(b, last, RC_RAW_U32, (double)at);
    return b->n - 4;
}

size_t
tiff_page(struct bytes *b, size_t last, size_t nx, size_t ny, unsigned bits, unsigned samples,
          const char *description, const void *pixels, size_t n, const struct tag *more)
{
    return tiff_any_page(b, last, nx, ny, bits, samples, description, pixels, n, more, 1);
}

size_t
tiff_packed_page(struct bytes *b, size_t last, size_t nx, size_t ny, unsigned bits,
                 unsigned samples, const char *description, const void *pixels, size_t n,
                 const struct tag *more)
{
    return tiff_any_page(b, last, nx, ny, bits, samples, description, pixels, n, more, 8);
}

struct tag
text_tag(unsigned tag, const char *text)
{
    return (struct tag){(uint16_t)tag, 2, (uint32_t)strlen(text) + 1, text, 0};
}

struct tag
number_tag(unsigned tag, unsigned type, double number)
{
    return (struct tag){(uint16_t)tag, (uint16_t)type, 1, NULL, number};
}

void
pixels_i32(struct bytes *b, const int *v, size_t n)
{
    for (size_t k = 0; k < n; k++)
        add_number(b, (uint64_t)(int64_t)v[k], 4);
}

const int raw_counts[6] = {1, -2, 3, -4, 5, 1000000};
