/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A flat file that is cut at any byte, or changed at any byte, is refused or gives a valid map. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "formats/format.h"
#include "made/made.h"
#include "tests/exact.h"

/* A commit cuts files at every third byte and changes each byte. With the sanitizer, which takes ten times as
 * long, it cuts and changes them at every seventh byte. */
#ifdef __SANITIZE_ADDRESS__
static const size_t step = 7, next = 7;
#else
static const size_t step = 3, next = 1;
#endif

enum {
    CHANNELS = 3, /* most bytes read of a file */
    LOOKED = 1200 /* bytes at the front that are changed */
};

/* Messages and lists must hold no control characters, which would act on a terminal. */
static void
check_words(const struct made_file *f, const char *words)
{
    if (!rc_utf8_valid(words))
        fail_msg("%s: '%s' is no UTF-8", f->title, words);
    for (const char *s = words; *s != '\0'; s++)
        if ((unsigned char)*s < ' ' || *s == 0x7f)
            fail_msg("%s: '%s' holds a control character", f->title, words);
}

/* Reads all channels; returns number `wanted`, or NULL. The bytes lie in a block of exactly their length, so
 * that the sanitizer sees a read beyond them. */
static struct rc_grid *
read_all(const struct made_file *f, const unsigned char *bytes, size_t n, size_t wanted,
         struct rc_err *err)
{
    const struct rc_format *format = rc_format_named(f->format);
    unsigned char *copy = malloc(n == 0 ? 1 : n);
    struct rc_file file = {f->name, copy, n};
    struct rc_wish wish = wish_for(f->flags);
    struct rc_channel channel[CHANNELS];
    struct rc_grid *kept = NULL;
    struct rc_maps *maps;
    size_t channels;

    memcpy(copy, bytes, n);
    rc_format_find(&file, NULL);
    err->text[0] = '\0';
    maps = rc_format_open(format, &file, &wish, err);
    channels = maps == NULL ? 0 : rc_maps_list(maps, channel, CHANNELS);
    if (channels == 0 && err->text[0] == '\0')
        fail_msg("%s, %zu bytes: not listed, without a reason", f->title, n);
    check_words(f, err->text);
    for (size_t k = 0; k < channels && k < CHANNELS; k++) {
        struct rc_notes notes = {0};
        struct rc_grid *g;

        err->text[0] = '\0';
        g = rc_format_read(maps, &wish, k, &notes, err);
        if (g == NULL && err->text[0] == '\0')
            fail_msg("%s, %zu bytes: refused without a reason", f->title, n);
        check_words(f, err->text);
        check_words(f, channel[k].name);
        check_words(f, channel[k].unit);
        if (g != NULL)
            check_sound(f->title, g, n);
        if (k == wanted)
            kept = g;
        else
            rc_grid_free(g);
    }
    rc_maps_free(maps);
    free(copy);
    return kept;
}

static bool
same_values(const struct rc_grid *a, const struct rc_grid *b)
{
    if (a->nx != b->nx || a->ny != b->ny || a->dx != b->dx || a->dy != b->dy)
        return false;
    for (size_t k = 0; k < a->nx * a->ny; k++)
        if (a->v[k] != b->v[k] && !(isnan(a->v[k]) && isnan(b->v[k])))
            return false;
    return true;
}

/* The test compares the last channel, because earlier ones need fewer bytes. */
static size_t
last_channel(const struct made_file *f)
{
    return strcmp(f->format, "gwy") == 0 || strcmp(f->format, "mi") == 0 ||
           strcmp(f->format, "nid") == 0 || strcmp(f->format, "sxm") == 0 || f->make == make_ibw;
}

static void
cut_anywhere(void **state)
{
    size_t cuts = 0;

    (void)state;
    for (size_t k = 0; k < made_files_n; k++) {
        const struct made_file *f = &made_files[k];
        size_t wanted = last_channel(f) && (f->make != make_ibw || f->variant == 2);
        struct rc_grid *whole, *g;
        struct bytes m = {0};
        struct rc_err err;

        f->make(&m, f->variant);
        whole = read_all(f, m.data, m.n, wanted, &err);
        if (whole == NULL)
            fail_msg("%s: %s", f->title, err.text);
        for (size_t n = 0; n < m.n; n += thorough(1, step), cuts++) {
            g = read_all(f, m.data, n, wanted, &err);
            if (g != NULL && (f->flags & IS_TEXT) == 0 && !same_values(g, whole))
                fail_msg("%s cut to %zu of %zu bytes is read as another map", f->title, n, m.n);
            rc_grid_free(g);
        }
        rc_grid_free(whole);
        drop(&m);
    }
    printf("%zu cuts\n", cuts);
}

static void
lies_anywhere(void **state)
{
    static const struct {
        size_t n;
        unsigned char bytes[8];
    } lies[] = {
        {1, {0}},
        {1, {1}},
        {1, {0x7f}},
        {1, {0x80}},
        {1, {0xff}},
        {1, {'-'}},
        {1, {'9'}},
        {1, {'\n'}},
        {4, {0xff, 0xff, 0xff, 0xff}},
        {4, {0xff, 0xff, 0xff, 0x7f}},
        {4, {0x7f, 0xff, 0xff, 0xff}},
        {4, {0, 0, 0, 0x80}},
        {4, {0, 0, 0xc0, 0x7f}}, /* NaN, 32 bits */
        {8, {0}},
        {8, {0, 0, 0, 0, 0, 0, 0xf8, 0x7f}}, /* NaN */
        {8, {0, 0, 0, 0, 0, 0, 0xf0, 0x7f}}, /* infinity */
        {8, {'9', '9', '9', '9', '9', '9', '9', '9'}},
    };
    size_t told = 0, believed = 0;

    (void)state;
    for (size_t k = 0; k < made_files_n; k++) {
        const struct made_file *f = &made_files[k];
        struct bytes m = {0};
        struct rc_err err;

        f->make(&m, f->variant);
        for (size_t at = 0; at < m.n && at < LOOKED; at += thorough(1, next))
            for (size_t l = thorough(0, at % 4); l < sizeof lies / sizeof *lies;
                 l += thorough(1, 4)) {
                unsigned char kept[8];
                struct rc_grid *g;

                if (at + lies[l].n > m.n)
                    continue;
                memcpy(kept, m.data + at, lies[l].n);
                memcpy(m.data + at, lies[l].bytes, lies[l].n);
                g = read_all(f, m.data, m.n, 0, &err);
                believed += g != NULL;
                told++;
                rc_grid_free(g);
                memcpy(m.data + at, kept, lies[l].n);
            }
        drop(&m);
    }
    printf("%zu lies, of which %zu still make a map\n", told, believed);
}

/* Every reader, forced with --format, refuses the files of other formats safely. */
static void
every_reader_on_every_file(void **state)
{
    (void)state;
    for (size_t k = 0; k < made_files_n; k++) {
        struct bytes m = {0};

        made_files[k].make(&m, made_files[k].variant);
        for (const struct rc_format *const *f = rc_formats; *f != NULL; f++) {
            struct made_file forced = made_files[k];
            struct rc_err err;

            forced.format = (*f)->name;
            forced.flags = NO_SPACING | NO_UNIT;
            rc_grid_free(read_all(&forced, m.data, m.n, 0, &err));
        }
        drop(&m);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cut_anywhere),
        cmocka_unit_test(lies_anywhere),
        cmocka_unit_test(every_reader_on_every_file),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
