/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks that every reader, and every map that it returns, must pass. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/sandbox/sandbox.h"
#include "made.h"

bool
gives_reason(const char *text, const char *why)
{
    return strstr(text, why) != NULL ||
           (SIZE_MAX == UINT32_MAX && strstr(text, "more than this machine can address") != NULL);
}

void
check_sound(const char *what, const struct rc_grid *g, size_t file_size)
{
    if (!(g->dx > 0) || !isfinite(g->dx) || !(g->dy > 0) || !isfinite(g->dy))
        fail_msg("%s: the spacing is %g, %g", what, g->dx, g->dy);
    if (8 * g->nx * g->ny > rc_memory_limit(file_size))
        fail_msg("%s: %zu x %zu out of %zu bytes", what, g->nx, g->ny, file_size);
    for (size_t k = 0; k < g->nx * g->ny; k++)
        if (isinf(g->v[k]))
            fail_msg("%s: an infinite height", what);
}

struct rc_grid *
try_read(const struct rc_format *format, const struct bytes *b, const struct rc_wish *wish,
         size_t index, struct rc_err *err)
{
    struct rc_file file = file_of(b, "made");
    struct rc_notes notes = {0};

    err->text[0] = '\0';
    return read_map(format, &file, wish, index, &notes, err);
}

/* Saves a file in the folder FOLDER/FORMAT if RC_SEEDS=FOLDER is in the environment, as a seed for
 * fuzzing. */
static void
keep_seed(const struct rc_format *format, const struct bytes *b)
{
    static unsigned number;
    char path[512];
    FILE *f;

    if (getenv("RC_SEEDS") == NULL)
        return;
    snprintf(path, sizeof path, "%s/%s/test-%u", getenv("RC_SEEDS"), format->name, number++);
    if ((f = fopen(path, "wb")) == NULL)
        return;
    fwrite(b->data, 1, b->n, f);
    fclose(f);
}

struct rc_grid *
read_well(const struct rc_format *format, const struct bytes *b, size_t index)
{
    struct rc_err err;
    struct rc_grid *g = try_read(format, b, &rc_no_wish, index, &err);

    if (g == NULL)
        fail_msg("%s refused: %s", format->name, err.text);
    keep_seed(format, b);
    return g;
}

void
refuse(const struct rc_format *format, const struct bytes *b, const char *why)
{
    struct rc_err err;
    struct rc_grid *g = try_read(format, b, &rc_no_wish, 0, &err);

    if (g != NULL)
        fail_msg("%s: read, and should be refused for: %s", format->name, why);
    if (!gives_reason(err.text, why))
        fail_msg("%s: refused for '%s', not for '%s'", format->name, err.text, why);
    keep_seed(format, b);
}

void
check_map(const struct rc_grid *g, size_t nx, size_t ny, double dx, double dy, const double *v)
{
    assert_int_equal(g->nx, nx);
    assert_int_equal(g->ny, ny);
    if (fabs(g->dx - dx) > last_digit * dx || fabs(g->dy - dy) > last_digit * dy)
        fail_msg("spacings %.17g and %.17g, not %.17g and %.17g", g->dx, g->dy, dx, dy);
    assert_string_equal(g->channel, "height");
    assert_string_equal(g->unit, "m");
    for (size_t k = 0; k < nx * ny; k++)
        if (isnan(v[k]) ? !isnan(g->v[k]) : !(fabs(g->v[k] - v[k]) <= last_digit * fabs(v[k])))
            fail_msg("value %zu is %.17g, not %.17g", k, g->v[k], v[k]);
}

void
refuse_cuts(const struct rc_format *format, const struct bytes *b, size_t least, size_t step)
{
    for (size_t n = 0; n < least; n += step) {
        struct bytes cut = {.data = malloc(n == 0 ? 1 : n), .n = n};
        struct rc_err err;
        struct rc_grid *g;

        memcpy(cut.data, b->data, n); /* a block of exactly its size, for the sanitizer */
        g = try_read(format, &cut, &rc_no_wish, 0, &err);
        if (g != NULL || err.text[0] == '\0')
            fail_msg("%s: cut after %zu of %zu bytes: %s", format->name, n, b->n,
                     g != NULL ? "read" : "refused without a reason");
        drop(&cut);
    }
}

void
survive_changes(const struct rc_format *format, const struct bytes *b, size_t times)
{
    static uint64_t seed = 0x9e3779b97f4a7c15;
    static const unsigned char nasty[] = {0, 1, 0x7f, 0x80, 0xff};
    struct bytes bad = {.data = malloc(b->n), .n = b->n};
    struct rc_channel channel[8];
    const char *more = getenv("RC_FUZZ");
    bool unsandboxed = getenv("RC_UNSANDBOXED") != NULL; /* cmake/unsandboxed.c */
    size_t read = 0;

    assert_non_null(bad.data);
    if (more != NULL)
        times *= strtoul(more, NULL, 10);
    rc_sandbox_bypass(unsandboxed || getenv("RC_FUZZ_BYPASS") != NULL);
    for (size_t t = 0; t < times; t++) {
        struct rc_file file = file_of(&bad, "made");
        struct rc_err err = {""};
        struct rc_grid *g;
        size_t n;

        memcpy(bad.data, b->data, b->n);
        for (size_t k = 0; k <= t % 4; k++) {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            bad.data[(seed >> 16) % b->n] =
                seed & 1 ? nasty[(seed >> 1) % sizeof nasty] : (unsigned char)(seed >> 8);
        }
        rc_format_find(&file, NULL);
        n = list_maps(format, &file, &rc_no_wish, channel, 8, &err);
        assert_true(n > 0 || err.text[0] != '\0');
        g = try_read(format, &bad, &rc_no_wish, 0, &err);
        if (g == NULL && err.text[0] == '\0')
            fail_msg("%s: refused without a reason", format->name);
        if (g != NULL)
            check_sound(format->name, g, bad.n);
        read += g != NULL;
        rc_grid_free(g);
    }
    printf("%s: %zu files changed at random, %zu of them read, the others refused\n", format->name,
           times, read);
    rc_sandbox_bypass(unsandboxed);
    assert_true(read > 0 && read < times);
    drop(&bad);
}
