/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For any bytes the reader named in RC_FORMAT must refuse them with a reason or return a valid map, within a
 * second and within rc_memory_limit. Without RC_FORMAT the content chooses the reader. With RC_FUZZ_BYPASS
 * readers run without their sandbox in this process, so that the sanitizers see them. With
 * RC_FUZZ_BYPASS=library memory is not counted: the library may request any amount, and the sanitizer limits
 * it (max_allocation_size_mb). */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/sandbox/sandbox.h"
#include "formats/format.h"
#include "formats/containers/containers.h"
#include "formats/core/core.h"
#include "meter.h"

enum {
    CHANNELS = 4 /* most bytes read of a file */
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
void watch_judge(void);

/* Called after each file; sandbox_watch.c defines another version. */
__attribute__((weak)) void
watch_judge(void)
{
}

static void
check(const struct rc_grid *g, size_t size)
{
    if (!(g->dx > 0) || !isfinite(g->dx) || !(g->dy > 0) || !isfinite(g->dy)) {
        fprintf(stderr, "the spacing is %g, %g\n", g->dx, g->dy);
        abort();
    }
    if (8 * g->nx * g->ny > rc_memory_limit(size)) {
        fprintf(stderr, "%zu x %zu out of %zu bytes\n", g->nx, g->ny, size);
        abort();
    }
    for (size_t k = 0; k < g->nx * g->ny; k++)
        if (isinf(g->v[k])) {
            fprintf(stderr, "an infinite value\n");
            abort();
        }
}

/* Messages and lists must hold no control characters, which would act on a terminal. */
static void
check_words(const char *words)
{
    bool good = rc_utf8_valid(words);

    for (const char *s = words; *s != '\0'; s++)
        good = good && (unsigned char)*s >= ' ' && *s != 0x7f;
    if (!good) {
        fprintf(stderr, "'%s' is not clean\n", words);
        abort();
    }
}

static void
try_file(const uint8_t *data, size_t size)
{
    /* half of the files are read with options, a quarter resampled */
    bool wishes = size > 0 && (data[size - 1] & 1) != 0;
    struct rc_wish wish = {.dx = wishes ? 1e-6 : NAN,
                           .dy = NAN,
                           .z_unit = wishes ? 1e-9 : NAN,
                           .even = size > 0 && (data[size - 1] & 2) != 0,
                           .even_step = size > 0 && (data[size - 1] & 4) != 0 ? 1e-7 : 0,
                           .labels = size > 1 ? (enum rc_label)(data[size - 2] % 5) : 0,
                           .xy_unit = size > 0 && (data[size - 1] & 8) != 0 ? 1e-6 : NAN,
                           .ignore_mask = size > 0 && (data[size - 1] & 16) != 0};
    const char *name = getenv("RC_FORMAT");
    struct rc_file file = {"fuzz.dat", data, size};
    struct rc_channel channel[CHANNELS];
    struct rc_err err = {""};
    RC_OWN(rc_maps, maps) =
        rc_format_open(name == NULL ? NULL : rc_format_named(name), &file, &wish, &err);
    size_t n = maps == NULL ? 0 : rc_maps_list(maps, channel, CHANNELS);

    if (n == 0 && err.text[0] == '\0')
        abort();
    check_words(err.text);
    for (size_t k = 0; k < (n < CHANNELS ? n : CHANNELS); k++) {
        struct rc_notes notes = {0};
        struct rc_grid *g;

        err.text[0] = '\0';
        g = rc_format_read(maps, &wish, k, &notes, &err);
        if (g == NULL && err.text[0] == '\0')
            abort();
        check_words(err.text);
        for (size_t i = 0; i < notes.n; i++)
            check_words(notes.text[i]);
        check_words(channel[k].name);
        check_words(channel[k].unit);
        if (g != NULL)
            check(g, size);
        rc_grid_free(g);
    }
}

/* The file itself, or unpacked. With RC_GZIP in the environment this function puts the header of a gzip
 * member before the bytes, so that mutations do not destroy it. */
static void
try_packed(const uint8_t *data, size_t size)
{
    static const uint8_t header[10] = {0x1f, 0x8b, 8};
    uint8_t *packed = malloc(sizeof header + size);
    struct rc_file file = {"fuzz.gz", packed, sizeof header + size};
    unsigned char *unpacked;
    struct rc_err err = {""};
    size_t n;

    if (packed == NULL)
        return;
    memcpy(packed, header, sizeof header);
    memcpy(packed + sizeof header, data, size);
    unpacked =
        rc_file_unpack(&file, rc_memory_limit(size) - (1 << 20), &n, &err); /* zlib takes some */
    if ((unpacked == NULL) != (err.text[0] != '\0'))
        abort();
    check_words(err.text);
    free(unpacked);
    free(packed);
}

int
LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *bypass = getenv("RC_FUZZ_BYPASS");
    bool library = bypass != NULL && strcmp(bypass, "library") == 0;

    rc_sandbox_bypass(bypass != NULL);
    meter_start(library ? 0 : rc_memory_limit(size));
    if (getenv("RC_GZIP") != NULL)
        try_packed(data, size);
    else
        try_file(data, size);
    meter_stop();
    watch_judge();
    return 0;
}
