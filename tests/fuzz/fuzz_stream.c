/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For any bytes the reader of grid streams must refuse them with a reason or return valid frames. It must do
 * so within a second and the memory of one frame. The frames, written and read again, must be unchanged.
 * Bytes are changed anywhere, also in values and sizes. Then, in three quarters of the cases, checksums and
 * counts of frames are corrected, so that the fuzzing gets past the first frame. */
#include <inttypes.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"
#include "formats/rcg/rcg.h"
#include "meter.h"

enum {
    FRAMES_MOST = 64,
    MEMORY = 1 << 22, /* --memory of the reader */
    BESIDE = 1 << 20  /* bytes that the reader holds beside a frame, a quarter of them for keys */
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed);

static void
demand(bool holds, const char *what)
{
    if (holds)
        return;
    fprintf(stderr, "%s\n", what);
    abort();
}

/* ---- functions that read ---- */

static void
check(const struct rc_grid *g)
{
    demand(g->dx > 0 && isfinite(g->dx) && g->dy > 0 && isfinite(g->dy), "a spacing is unsound");
    demand(g->nx > 0 && g->ny > 0 && g->nx <= MEMORY / 8 / g->ny, "a size is unsound");
    demand(rc_utf8_valid(g->channel) && rc_utf8_valid(g->unit), "channel or unit is no UTF-8");
    for (size_t k = 0; k < g->keys; k++)
        demand(rc_key_valid(g->key[k].name) && rc_utf8_valid(g->key[k].value), "a key is unsound");
    demand(rc_grid_case(g) > 0, "a case is unsound");
}

static bool
same(const struct rc_grid *a, const struct rc_grid *b)
{
    bool equal = a->nx == b->nx && a->ny == b->ny && a->dx == b->dx && a->dy == b->dy &&
                 a->type == b->type && a->keys == b->keys && strcmp(a->channel, b->channel) == 0 &&
                 strcmp(a->unit, b->unit) == 0;

    for (size_t k = 0; equal && k < a->keys; k++)
        equal = strcmp(a->key[k].name, b->key[k].name) == 0 &&
                strcmp(a->key[k].value, b->key[k].value) == 0;
    for (size_t k = 0; equal && k < a->nx * a->ny; k++)
        equal = memcmp(&a->v[k], &b->v[k], sizeof *a->v) == 0 || (isnan(a->v[k]) && isnan(b->v[k]));
    return equal;
}

/* A frame that is written and read is unchanged. The writer refuses a header that exceeds the limit because
 * its numbers are written with all digits. */
static void
round_trip(const struct rc_grid *g)
{
    struct rc_grid *again = NULL;
    struct rc_reader *reader;
    struct rc_writer *writer;
    struct rc_err err = {""};
    char *bytes = NULL;
    size_t size;
    FILE *f = open_memstream(&bytes, &size);
    bool put;

    writer = rc_writer_new(f, &err);
    put = rc_writer_put(writer, g, &err) == RC_OK && rc_writer_end(writer, &err) == RC_OK;
    rc_writer_free(writer);
    fclose(f);
    demand(put || strstr(err.text, "header") != NULL, "a frame that was read is not written");
    if (put) {
        f = fmemopen(bytes, size, "rb");
        reader = rc_reader_new(f, 0, 0, &err);
        demand(rc_reader_next(reader, &again, &err) == RC_MORE, "what was written is not read");
        demand(same(g, again), "a frame comes back changed");
        rc_grid_free(again);
        demand(rc_reader_next(reader, &again, &err) == RC_OK, "what was written does not end");
        rc_reader_free(reader);
        fclose(f);
    }
    free(bytes);
}

int
LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum rc_status status;
    struct rc_reader *reader;
    struct rc_err err = {""};
    struct rc_grid *g;
    size_t frames = 0;
    const char *head;
    FILE *f;
    int how;

    if (size == 0)
        return 0;
    f = fmemopen((void *)(uintptr_t)data, size, "rb");
    demand(f != NULL, "no memory");
    meter_start(MEMORY + BESIDE);
    reader = rc_reader_new(f, size % 3, MEMORY, &err);
    while ((status = rc_reader_next(reader, &g, &err)) == RC_MORE && frames++ < FRAMES_MOST) {
        check(g);
        if (8 * g->nx * g->ny < MEMORY / 4)
            round_trip(g);
        rc_grid_free(g);
    }
    if (status == RC_FAIL)
        demand(g == NULL && err.text[0] != '\0', "refused without a reason");
    (void)rc_reader_foreign(reader, &head);
    (void)rc_reader_failure(reader, &how);
    if (status == RC_MORE)
        rc_grid_free(g);
    rc_reader_free(reader);
    fclose(f);
    meter_stop();
    return 0;
}

/* ---- changes of a stream ---- */

/* The number in the header line NAME=...; 0 without this line. */
static size_t
number_of(const uint8_t *head, size_t n, const char *name)
{
    size_t length = strlen(name);

    for (size_t k = 0; k + length + 1 < n; k++)
        if (head[k] == '\n' && memcmp(head + k + 1, name, length) == 0) {
            size_t value = 0;

            for (k += length + 1; k < n && head[k] >= '0' && head[k] <= '9' && value < 1 << 20; k++)
                value = 10 * value + (head[k] - '0');
            return value;
        }
    return 0;
}

/* Corrects the checksum of the frame at data[0..size); returns the end of the frame, or 0 if it has no line
 * with a checksum. */
static size_t
seal(uint8_t *data, size_t size)
{
    size_t head = 5, values, end;
    char line[16];

    while (head + 2 <= size && memcmp(data + head - 1, "\n\n", 2) != 0)
        head++;
    if (head + 2 > size)
        return 0;
    values = number_of(data, head, "nx=") * number_of(data, head, "ny=");
    end = head + 1 + values * (memmem(data, head, "\ntype=f32\n", 10) != NULL ? 4 : 8);
    if (values > size || end + 15 > size || memcmp(data + end, "crc32 ", 6) != 0)
        return 0;
    snprintf(line, sizeof line, "crc32 %08" PRIx32 "\n", rc_crc32_add(0, data, end));
    memcpy(data + end, line, 15);
    return end + 15;
}

size_t
LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    unsigned frames = 0;
    size_t at = 0, n;

    size = LLVMFuzzerMutate(data, size, most);
    if (seed % 4 == 0)
        return size;
    while (at + 5 < size) {
        if (memcmp(data + at, "RCG1\n", 5) == 0 && (n = seal(data + at, size - at)) > 0) {
            at += n;
            frames++;
        } else if (at + 9 <= size && memcmp(data + at, "RCGEND ", 7) == 0) {
            if (frames < 10)
                data[at + 7] = (uint8_t)('0' + frames);
            at += 9;
            frames = 0;
        } else {
            break;
        }
    }
    return size;
}
