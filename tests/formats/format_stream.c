/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* memmem */
/* A grid stream is read back bit by bit. A damaged one is refused with the reason, without a crash and
 * without a frame that was not written. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "formats/core/core.h"
#include "formats/rcg/rcg.h"
#include "made/made.h"

/* With the address sanitizer, too, an impossible allocation returns NULL. */
const char *__asan_default_options(void);
const char *
__asan_default_options(void)
{
    return "allocator_may_return_null=1";
}

/* ---- making streams ---- */

struct stream {
    char *data;
    size_t size;
};

static struct stream
write_frames(struct rc_grid *const *g, size_t n)
{
    struct stream b = {0};
    FILE *file = open_memstream(&b.data, &b.size);
    struct rc_writer *w = rc_writer_new(file, NULL);
    struct rc_err err;

    for (size_t k = 0; k < n; k++)
        if (rc_writer_put(w, g[k], &err) != RC_OK)
            fail_msg("%s", err.text);
    assert_int_equal(rc_writer_end(w, &err), RC_OK);
    rc_writer_free(w);
    fclose(file);
    return b;
}

/* A stream of one frame made by hand: the header after the line RCG1, and n zero bytes. */
static struct stream
by_hand(const char *header, size_t n)
{
    struct stream b = {0};
    FILE *file = open_memstream(&b.data, &b.size);
    unsigned long crc;

    fprintf(file, "RCG1\n%s\n", header);
    for (size_t k = 0; k < n; k++)
        putc(0, file);
    fflush(file);
    crc = crc32(0, (const unsigned char *)b.data, (unsigned)b.size);
    fprintf(file, "crc32 %08lx\nRCGEND 1\n", crc);
    fclose(file);
    return b;
}

/* The same with a changed line in a valid 2 x 1 header: `line` replaces the line with its key or is added.
 * NULL removes the line of that key. */
static struct stream
with_line(const char *key, const char *line)
{
    static const char *const good[] = {"channel=height", "nx=2",   "ny=1",    "dx=1.1e-06",
                                       "dy=1e-06",       "unit=m", "type=f64"};
    char header[2048] = "";
    bool put = line == NULL;

    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        const char *use = good[k];
        if (strncmp(use, key, strlen(key)) == 0 && use[strlen(key)] == '=') {
            put = true;
            use = line;
        }
        if (use != NULL)
            strcat(strcat(header, use), "\n");
    }
    if (!put)
        strcat(strcat(header, line), "\n");
    return by_hand(header, 16);
}

/* ---- reading them ---- */

/* Reads the whole stream: returns the last status, the number of frames, and the last frame if requested. */
static enum rc_status
read_all(const char *data, size_t size, size_t *frames, struct rc_grid **last, struct rc_err *err)
{
    FILE *file = fmemopen((void *)data, size, "rb");
    struct rc_reader *r = rc_reader_new(file, 0, 0, err);
    enum rc_status status;
    struct rc_grid *g;

    *frames = 0;
    err->text[0] = '\0';
    while ((status = rc_reader_next(r, &g, err)) == RC_MORE) {
        ++*frames;
        if (last != NULL) {
            rc_grid_free(*last);
            *last = g;
        } else {
            rc_grid_free(g);
        }
    }
    assert_null(g);
    rc_reader_free(r);
    fclose(file);
    return status;
}

static struct rc_grid *
read_one(struct stream b)
{
    struct rc_grid *g = NULL;
    struct rc_err err;
    size_t frames;

    if (read_all(b.data, b.size, &frames, &g, &err) != RC_OK)
        fail_msg("%s", err.text);
    assert_int_equal(frames, 1);
    free(b.data);
    return g;
}

static void
check_refused(struct stream b, size_t whole_frames, const char *reason)
{
    struct rc_err err;
    size_t frames;

    if (read_all(b.data, b.size, &frames, NULL, &err) != RC_FAIL)
        fail_msg("taken, and should not: %s", reason);
    assert_int_equal(frames, whole_frames);
    if (!gives_reason(err.text, reason))
        fail_msg("'%s' does not say '%s'", err.text, reason);
    free(b.data);
}

/* ---- round trips ---- */

static double
of_bits(uint64_t bits)
{
    double v;

    memcpy(&v, &bits, sizeof v);
    return v;
}

static struct rc_grid *
ugly_grid(void)
{
    const struct rc_shape shape = {5, 2, 1.1e-6, 1e-6 / 3};
    const double v[] = {1.0 / 3,  -0.0,      DBL_TRUE_MIN, DBL_MAX,
                        INFINITY, -INFINITY, NAN,          of_bits(UINT64_C(0xfff8123456789abc)),
                        1e-6,     -4.2e-6};
    struct rc_grid *g = rc_grid_new(&shape, "height", "m", NULL);

    memcpy(g->v, v, sizeof v);
    rc_grid_set(g, "source", "a\\b\nc = \xc2\xb5m \\n", NULL);
    rc_grid_set(g, "file.operator", "", NULL);
    rc_grid_set(g, "history", "rc-import 0.1.0 | rc-detrend 0.1.0 --plane", NULL);
    return g;
}

static void
test_round_trip_f64(void **state)
{
    struct rc_grid *g = ugly_grid(), *back = read_one(write_frames(&g, 1));

    (void)state;
    assert_int_equal(back->nx, 5);
    assert_int_equal(back->ny, 2);
    assert_true(back->dx == g->dx && back->dy == g->dy && back->type == RC_F64);
    assert_string_equal(back->channel, "height");
    assert_string_equal(back->unit, "m");
    assert_memory_equal(back->v, g->v, 10 * sizeof *g->v);
    assert_int_equal(back->keys, g->keys);
    for (size_t k = 0; k < g->keys; k++) {
        assert_string_equal(back->key[k].name, g->key[k].name);
        assert_string_equal(back->key[k].value, g->key[k].value);
    }
    rc_grid_free(g);
    rc_grid_free(back);
}

/* More values than are converted at a time; values that a float can hold come back unchanged. */
static void
test_round_trip_f32(void **state)
{
    const struct rc_shape shape = {331, 47, 1.1e-6, 1e-6};
    struct rc_grid *g = rc_grid_new(&shape, "pressure", "Pa", NULL), *back;

    (void)state;
    for (size_t k = 0; k < 331 * 47; k++)
        g->v[k] = (double)(float)((float)k * 1.7e-3f);
    g->v[5] = NAN;
    g->v[6] = -INFINITY;
    g->v[7] = -0.0;
    g->v[331 * 47 - 1] = 1e300;
    g->type = RC_F32;
    back = read_one(write_frames(&g, 1));
    assert_int_equal(back->type, RC_F32);
    assert_true(isnan(back->v[5]) && back->v[6] == -INFINITY && signbit(back->v[7]));
    assert_true(back->v[331 * 47 - 1] == INFINITY); /* out of the range of a float */
    for (size_t k = 7; k < 331 * 47 - 1; k++)
        assert_true(back->v[k] == g->v[k]);
    rc_grid_free(g);
    rc_grid_free(back);
}

/* Rows are those of whole frames, also again; skipped values are not compared with their checksum, read ones
 * are. A frame that is written in pieces has the same bytes. */
static void
test_rows(void **state)
{
    const struct rc_shape shape = {3, 5, 1.1e-6, 1e-6};
    struct rc_grid *g[2], *head;
    struct stream b;

    (void)state;
    for (int k = 0; k < 2; k++) {
        g[k] = rc_grid_new(&shape, "height", "m", NULL);
        for (size_t i = 0; i < 15; i++)
            g[k]->v[i] = (double)i * (k + 1);
        g[k]->type = k == 0 ? RC_F64 : RC_F32;
        rc_grid_set_number(g[k], "case", k + 1, NULL);
    }
    b = write_frames(g, 2);
    for (int damaged = 0; damaged < 2; damaged++) {
        FILE *file = fmemopen(b.data, b.size, "rb");
        struct rc_reader *r = rc_reader_new(file, 0, 0, NULL);
        struct rc_err err;
        double v[15];

        rc_reader_by_rows(r);
        assert_int_equal(rc_reader_head(r, &head, &err), RC_MORE);
        assert_int_equal(head->elsewhere, 5);
        assert_int_equal(rc_reader_left(r), 5);
        assert_int_equal(rc_reader_rows(r, 2, v, &err), RC_OK);
        assert_int_equal(rc_reader_left(r), 3);
        assert_int_equal(rc_reader_again(r, &err), RC_OK);
        for (int pass = 0; pass < 2 && !damaged; pass++) {
            memset(v, 0, sizeof v);
            assert_int_equal(rc_reader_rows(r, 4, v, &err), RC_OK);
            assert_int_equal(rc_reader_rows(r, 1, v + 12, &err), RC_OK);
            assert_memory_equal(v, g[0]->v, sizeof v);
            if (pass == 0)
                assert_int_equal(rc_reader_again(r, &err), RC_OK);
        }
        if (damaged) /* a value of the first frame */
            assert_int_equal(rc_reader_skip(r, &err), RC_OK);
        rc_grid_free(head);
        assert_int_equal(rc_reader_head(r, &head, &err), RC_MORE);
        assert_int_equal(rc_reader_rows(r, 5, v, &err), RC_OK);
        assert_memory_equal(v, g[1]->v, sizeof v);
        rc_grid_free(head);
        assert_int_equal(rc_reader_head(r, &head, &err), RC_OK);
        rc_reader_free(r);
        fclose(file);
        ((char *)memmem(b.data, b.size, "\n\n", 2))[10] ^= 1;
    }
    { /* the damaged value, read */
        FILE *file = fmemopen(b.data, b.size, "rb");
        struct rc_reader *r = rc_reader_new(file, 0, 0, NULL);
        struct rc_err err;
        double v[15];

        ((char *)memmem(b.data, b.size, "\n\n", 2))[11] ^= 1;
        rc_reader_by_rows(r);
        assert_int_equal(rc_reader_head(r, &head, &err), RC_MORE);
        assert_int_equal(rc_reader_rows(r, 5, v, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "checksum"));
        rc_grid_free(head);
        rc_reader_free(r);
        fclose(file);
    }
    {                           /* skipped values that end too early */
        FILE *file = tmpfile(); /* fmemopen does not seek beyond the end */
        struct rc_reader *r = rc_reader_new(file, 0, 0, NULL);
        struct rc_err err;

        assert_int_equal(fwrite(b.data, 1, 150, file), 150);
        rewind(file);
        rc_reader_by_rows(r);
        assert_int_equal(rc_reader_head(r, &head, &err), RC_MORE);
        assert_int_equal(rc_reader_skip(r, &err), RC_FAIL);
        assert_non_null(strstr(err.text, "the stream stops"));
        rc_grid_free(head);
        rc_reader_free(r);
        fclose(file);
    }
    free(b.data);
    for (int k = 0; k < 2; k++) {
        struct stream whole = write_frames(&g[k], 1), pieces = {0};
        FILE *file = open_memstream(&pieces.data, &pieces.size);
        struct rc_writer *w = rc_writer_new(file, NULL);

        assert_int_equal(rc_writer_begin(w, g[k], NULL), RC_OK);
        assert_int_equal(rc_writer_values(w, g[k]->v, 3, NULL), RC_OK);
        assert_int_equal(rc_writer_values(w, g[k]->v + 3, 12, NULL), RC_OK);
        assert_int_equal(rc_writer_end(w, NULL), RC_OK);
        rc_writer_free(w);
        fclose(file);
        assert_int_equal(pieces.size, whole.size);
        assert_memory_equal(pieces.data, whole.data, whole.size);
        free(pieces.data);
        free(whole.data);
        rc_grid_free(g[k]);
    }
}

/* The bytes are those of the manual. */
static void
test_layout(void **state)
{
    static const char header[] = "RCG1\nchannel=height\nnx=2\nny=1\ndx=1.1e-06\ndy=1.29e-06\n"
                                 "unit=m\ntype=f64\nsource=a\\\\b\\nc\n\n";
    static const unsigned char values[] = {0, 0, 0, 0, 0, 0, 0xf8, 0x3f, 0, 0, 0, 0, 0, 0, 0, 0xc0};
    const struct rc_shape shape = {2, 1, 1.1e-6, 1.29e-6};
    struct rc_grid *g = rc_grid_new(&shape, "height", "m", NULL);
    size_t n = strlen(header);
    struct stream b;
    char tail[64];

    (void)state;
    g->v[0] = 1.5;
    g->v[1] = -2;
    rc_grid_set(g, "source", "a\\b\nc", NULL);
    b = write_frames(&g, 1);
    assert_memory_equal(b.data, header, n);
    assert_memory_equal(b.data + n, values, 16);
    snprintf(tail, sizeof tail, "crc32 %08lx\nRCGEND 1\n",
             crc32(0, (const unsigned char *)b.data, (unsigned)n + 16));
    assert_int_equal(b.size, n + 16 + strlen(tail));
    assert_memory_equal(b.data + n + 16, tail, strlen(tail));
    rc_grid_free(g);
    free(b.data);
}

static void
test_no_frames(void **state)
{
    struct stream b = write_frames(NULL, 0);
    struct rc_err err;
    size_t frames;

    (void)state;
    assert_int_equal(read_all(b.data, b.size, &frames, NULL, &err), RC_OK);
    assert_int_equal(frames, 0);
    free(b.data);
}

/* ---- damage ---- */

static void
test_every_truncation(void **state)
{
    struct rc_grid *g[] = {ugly_grid(), ugly_grid()};
    struct stream b;
    struct rc_err err;
    size_t frames;

    (void)state;
    g[1]->type = RC_F32;
    b = write_frames(g, 2);
    for (size_t size = 0; size < b.size; size++) {
        char *part = malloc(
            size + 1); /* a separate block, so that the sanitizer sees a read beyond its end */
        memcpy(part, b.data, size);
        if (read_all(part, size, &frames, NULL, &err) != RC_FAIL || err.text[0] == '\0')
            fail_msg("cut off after %zu of %zu bytes, and taken", size, b.size);
        free(part);
    }
    rc_grid_free(g[0]);
    rc_grid_free(g[1]);
    free(b.data);
}

static void
test_every_flipped_bit(void **state)
{
    struct rc_grid *g = ugly_grid();
    struct stream b = write_frames(&g, 1);
    struct rc_err err;
    size_t frames;

    (void)state;
    for (size_t bit = 0; bit < 8 * b.size; bit++) {
        b.data[bit / 8] ^= (char)(1 << bit % 8);
        if (read_all(b.data, b.size, &frames, NULL, &err) != RC_FAIL)
            fail_msg("bit %zu of byte %zu flipped, and taken", bit % 8, bit / 8);
        b.data[bit / 8] ^= (char)(1 << bit % 8);
    }
    rc_grid_free(g);
    free(b.data);
}

static void
test_wrong_checksum_and_count(void **state)
{
    struct rc_grid *g = ugly_grid();
    struct stream b = write_frames(&g, 1);

    (void)state;
    memcpy(b.data + b.size - strlen("RCGEND 1\n"), "RCGEND 2\n", strlen("RCGEND 2\n"));
    check_refused(b, 1, "counts 2 frames, 1 were read");
    b = write_frames(&g, 1);
    memcpy(strstr(b.data + b.size - 24, "crc32 ") + 6, "0badf00d", 8);
    check_refused(b, 0, "the stream is damaged");
    rc_grid_free(g);
}

/* Headers that promise fewer or more values than follow. */
static void
test_lying_sizes(void **state)
{
    (void)state;
    check_refused(with_line("nx", "nx=1"), 0, "do not match");
    check_refused(with_line("nx", "nx=3"), 0, "no crc32 line follows the values");
    check_refused(with_line("nx", "nx=200"), 0, "stops");
    check_refused(with_line("type", "type=f32"), 0, "do not match");
}

/* ---- messages of the producer ---- */

static struct stream
failed_stream(const char *message)
{
    struct rc_grid *g = ugly_grid();
    struct stream b = {0};
    FILE *file = open_memstream(&b.data, &b.size);
    struct rc_writer *w = rc_writer_new(file, NULL);

    rc_writer_put(w, g, NULL);
    rc_stream_fail(file, message, 1);
    rc_writer_free(w);
    fclose(file);
    rc_grid_free(g);
    return b;
}

static void
test_failure_is_repeated(void **state)
{
    char message[3000];

    (void)state;
    check_refused(failed_stream("rc-solve: the load is too high"), 1,
                  "failed: rc-solve: the load is too high");
    check_refused(failed_stream("one\ntwo"), 1, "failed: one two");
    memset(message, 'x', sizeof message);
    message[sizeof message - 1] = '\0';
    check_refused(failed_stream(message), 1, "failed: xxx");
}

/* The bytes that rc_stream_fail writes if nothing was written before. */
static struct stream
failure(const char *message, int status)
{
    struct stream b = {0};
    FILE *file = open_memstream(&b.data, &b.size);

    rc_stream_fail(file, message, status);
    fclose(file);
    return b;
}

static void
check_failure(const char *message, int status, const char *expected)
{
    struct stream b = failure(message, status);
    FILE *file = fmemopen(b.data, b.size, "rb");
    struct rc_reader *r;
    struct rc_grid *g;
    struct rc_err err;
    int read = 0;

    assert_true(b.size <= strlen("RCGFAIL \n") + 399);
    assert_true(rc_utf8_valid(b.data));
    r = rc_reader_new(file, 0, 0, &err);
    assert_null(rc_reader_failure(r, &read));
    assert_int_equal(rc_reader_next(r, &g, &err), RC_FAIL);
    assert_non_null(rc_reader_failure(r, &read));
    assert_string_equal(rc_reader_failure(r, &read), expected);
    assert_int_equal(read, status);
    rc_reader_free(r);
    fclose(file);
    free(b.data);
}

/* A stream that fails before its first frame: its reader gets the message and the exit status. A message that
 * is too long is cut between characters. */
static void
test_failure_and_its_status(void **state)
{
    char text[1000], cut[1000];

    (void)state;
    check_failure("rc-solve: no", 1, "rc-solve: no");
    check_failure("rc-solve: no", 2, "rc-solve: no");
    check_failure("", 2, "without a message");
    check_failure("one\ttwo\x1b[2J", 2, "one two [2J");
    check_failure("caf\xe9", 1, "caf?");
    check_failure("(exit status 2) of another", 1, "(exit status 2) of another");
    for (int before = 0; before < 4; before++) { /* the limits lie on each byte of a character */
        size_t n = 0;
        memset(text, 'x', (size_t)before);
        text[before] = '\0';
        for (n = (size_t)before; n + 3 < 900; n += 3)
            memcpy(text + n, "\xe2\x82\xac", 4);
        strcpy(cut, text);
        cut[before + (399 - before) / 3 * 3] = '\0';
        check_failure(text, 1, cut);
        cut[before + (399 - 16 - before) / 3 * 3] = '\0';
        check_failure(text, 2, cut);
    }
}

/* ---- headers ---- */

static void
test_missing_and_doubled_keys(void **state)
{
    static const char *const names[] = {"channel", "nx", "ny", "dx", "dy", "unit", "type"};
    char text[64];

    (void)state;
    rc_grid_free(read_one(with_line("source", "source=x"))); /* the good one */
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        snprintf(text, sizeof text, "no %s= line", names[k]);
        check_refused(with_line(names[k], NULL), 0, text);
        snprintf(text, sizeof text, "note=x\n%s=2", names[k]);
        check_refused(with_line("note", text), 0, "occurs twice");
    }
    check_refused(with_line("note", "note=x\nother=y\nnote=x"), 0, "'note' occurs twice");
}

static void
test_spacings(void **state)
{
    static const char *const bad[] = {"0",      "-1e-06", "nan",    "inf",  "-inf",
                                      "1e400",  "1e-400", "",       "wide", "1,1e-06",
                                      "1e-06 ", " 1e-06", "0x1p-20"};
    char line[64];

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        snprintf(line, sizeof line, "dx=%s", bad[k]);
        check_refused(with_line("dx", line), 0, "dx=");
        snprintf(line, sizeof line, "dy=%s", bad[k]);
        check_refused(with_line("dy", line), 0, "dy=");
    }
}

static void
test_sizes(void **state)
{
    static const char *const bad[] = {"0", "-2", "+2", "2.0", "", " 2", "2 ", "0x2", "two"};
    static const char *const huge[] = {"18446744073709551616", "99999999999999999999999"};
    char line[64];

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        snprintf(line, sizeof line, "nx=%s", bad[k]);
        check_refused(with_line("nx", line), 0, "whole number");
        snprintf(line, sizeof line, "ny=%s", bad[k]);
        check_refused(with_line("ny", line), 0, "whole number");
    }
    for (size_t k = 0; k < sizeof huge / sizeof *huge; k++) {
        snprintf(line, sizeof line, "nx=%s", huge[k]);
        check_refused(with_line("nx", line), 0, "more than this machine can address");
    }
    check_refused(by_hand("channel=h\nnx=4294967296\nny=4294967296\ndx=1\ndy=1\nunit=m\n"
                          "type=f64\n",
                          16),
                  0, "more than this machine can address");
    check_refused(with_line("ny", "ny=4611686018427387904"), 0,
                  "more than this machine can address");
    /* addressable, but more than the machine has */
    check_refused(with_line("ny", "ny=1000000000000000"), 0,
                  "out of memory for a map of 2 x 1000000000000000 nodes");
}

static void
test_words(void **state)
{
    (void)state;
    check_refused(with_line("type", "type=f16"), 0, "type=f16");
    check_refused(with_line("type", "type="), 0, "neither f64 nor f32");
    check_refused(with_line("x", "no equals sign"), 0, "has no '='");
    check_refused(with_line("x", "Upper=1"), 0, "not of the form");
    check_refused(with_line("x", "=1"), 0, "not of the form");
    check_refused(with_line("x", "x=a\\tb"), 0, "backslash");
    check_refused(with_line("x", "x=a\\"), 0, "backslash");
    check_refused(with_line("case", "case=0"), 0, "case=0");
    check_refused(with_line("case", "case=1.5"), 0, "case=1.5");
    check_refused(with_line("case", "case=first"), 0, "case=first");
}

static void
test_utf8(void **state)
{
    static const char *const bad[] = {"\xff",
                                      "\x80",
                                      "a\xc3",
                                      "\xc0\xaf",
                                      "\xe0\x80\xaf",
                                      "\xed\xa0\x80",
                                      "\xf0\x80\x80\xaf",
                                      "\xf4\x90\x80\x80",
                                      "\xe2\x82",
                                      "\xf8\x88\x80\x80\x80"};
    static const char *const good[] = {"\xc2\xb5m", "\xe2\x82\xac", "\xf0\x9f\x94\xac",
                                       "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"};
    char line[64];

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        snprintf(line, sizeof line, "note=%s", bad[k]);
        check_refused(with_line("note", line), 0, "not UTF-8");
    }
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        struct rc_grid *g;
        snprintf(line, sizeof line, "note=%s", good[k]);
        g = read_one(with_line("note", line));
        assert_string_equal(rc_grid_get(g, "note"), good[k]);
        rc_grid_free(g);
    }
}

/* A NUL byte cannot hide the rest of a line. */
static void
test_nul(void **state)
{
    struct stream b = with_line("note", "note=abc");

    (void)state;
    *strstr(b.data, "abc") = '\0';
    check_refused(b, 0, "NUL");
}

/* A header of exactly `total` bytes, including the line RCG1 and the empty line. */
static struct stream
long_header(size_t total)
{
    static const char start[] = "channel=h\nnx=1\nny=1\ndx=1\ndy=1\nunit=m\ntype=f64\nnote=";
    size_t n = total - strlen("RCG1\n") - strlen("\n");
    char *header = malloc(n + 1);
    struct stream b;

    memset(header, 'x', n);
    memcpy(header, start, strlen(start));
    header[n - 1] = '\n';
    header[n] = '\0';
    b = by_hand(header, 8);
    free(header);
    return b;
}

static void
test_longest_header(void **state)
{
    struct rc_grid *g = read_one(long_header(RC_HEADER_MAX));
    size_t most = strlen(rc_grid_get(g, "note"));
    struct stream b = write_frames(&g, 1); /* the writer has the same limit */
    char *longer = calloc(most + 2, 1);
    struct rc_writer *w;
    struct rc_err err;
    FILE *file;

    (void)state;
    free(b.data);
    for (size_t extra = 1; extra < 8; extra++)
        check_refused(long_header(RC_HEADER_MAX + extra), 0, "longer than 65536 bytes");
    memset(longer, 'x', most + 1);
    rc_grid_set(g, "note", longer, NULL);
    file = fopen("/dev/null", "wb");
    w = rc_writer_new(file, NULL);
    assert_int_equal(rc_writer_put(w, g, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "longer than 65536 bytes"));
    rc_writer_free(w);
    fclose(file);
    free(longer);
    rc_grid_free(g);
}

/* The largest number of keys that fit: names of one or two letters, three or four bytes a line. */
static void
test_many_keys(void **state)
{
    char *header = malloc(RC_HEADER_MAX);
    struct rc_grid *g;
    size_t n = 0;

    (void)state;
    strcpy(header, "channel=h\nnx=1\nny=1\ndx=1\ndy=1\nunit=m\ntype=f64\n");
    for (char *end = header + strlen(header); n < 8000; n++)
        end += sprintf(end, "k%zx=\n", n);
    g = read_one(by_hand(header, 8));
    assert_int_equal(g->keys, 8000);
    rc_grid_free(g);
    free(header);
}

static void
test_no_stream_at_all(void **state)
{
    static const char *const texts[] = {"",
                                        "\n",
                                        "RCG1",
                                        "RCG1\r\nchannel=h\r\n",
                                        "RCG2\n",
                                        "x,y,z\n1,2,3\n",
                                        "RCGEND\n",
                                        "RCGEND x\n",
                                        "RCGEND 1\n",
                                        "RCGEND 0",
                                        "\x89PNG\r\n\x1a\n"};
    struct rc_err err;
    size_t frames;

    (void)state;
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        assert_int_equal(read_all(texts[k], strlen(texts[k]), &frames, NULL, &err), RC_FAIL);
        assert_int_equal(frames, 0);
        assert_true(err.text[0] != '\0');
    }
}

/* ---- several streams ---- */

static struct stream
two_cases(void)
{
    struct rc_grid *g[] = {ugly_grid(), ugly_grid()};
    struct stream b;

    rc_grid_set(g[1], "case", "2", NULL);
    b = write_frames(g, 2);
    rc_grid_free(g[0]);
    rc_grid_free(g[1]);
    return b;
}

static void
test_cases_number_on(void **state)
{
    struct stream b = two_cases();
    char *three = malloc(3 * b.size);
    FILE *file;
    struct rc_reader *r;
    struct rc_grid *g;
    struct rc_err err;

    (void)state;
    for (size_t k = 0; k < 3; k++)
        memcpy(three + k * b.size, b.data, b.size);
    file = fmemopen(three, 3 * b.size, "rb");
    r = rc_reader_new(file, 4, 0, &err);
    for (size_t number = 5; number <= 10; number++) {
        assert_int_equal(rc_reader_next(r, &g, &err), RC_MORE);
        assert_int_equal(rc_grid_case(g), number);
        assert_int_equal(rc_reader_last_case(r), number);
        rc_grid_free(g);
    }
    assert_int_equal(rc_reader_next(r, &g, &err), RC_OK);
    rc_reader_free(r);
    fclose(file);
    free(three);
    free(b.data);
}

/* The second of two streams is cut off: the end line of the first one does not count for it. */
static void
test_second_stream_cut(void **state)
{
    struct stream b = two_cases(), both = {malloc(2 * b.size), 2 * b.size - 9};

    (void)state;
    memcpy(both.data, b.data, b.size);
    memcpy(both.data + b.size, b.data, b.size - 9);
    check_refused(both, 4, "without an end line");
    free(b.data);
}

/* ---- limits ---- */

static void
test_memory(void **state)
{
    struct stream b = two_cases();
    struct rc_grid *g;
    struct rc_err err;

    (void)state;
    for (size_t memory = 79; memory <= 80; memory++) {
        FILE *file = fmemopen(b.data, b.size, "rb");
        struct rc_reader *r = rc_reader_new(file, 0, memory, &err);
        assert_int_equal(rc_reader_next(r, &g, &err), memory < 80 ? RC_FAIL : RC_MORE);
        rc_grid_free(g);
        rc_reader_free(r);
        fclose(file);
    }
    free(b.data);
}

/* A history that would be too long keeps the first step and as many of the last ones as fit into 32 KiB, all
 * complete. */
static void
test_long_history(void **state)
{
    enum {
        MOST = 32 * 1024,
        STEP = 1000, /* bytes of a step, with its separator */
        STEPS = 90
    };
    static const char cut[] = "first | ...";
    const char separator[] = " | ", *at;
    struct rc_grid *g = ugly_grid();
    size_t kept;

    (void)state;
    assert_int_equal(rc_grid_set(g, "history", "first", NULL), RC_OK);
    for (size_t k = 1; k <= STEPS; k++) {
        char step[STEP];
        snprintf(step, sizeof step, "step %03zu %0*d", k, STEP - 3 - 9, 0);
        assert_int_equal(rc_grid_history(g, step, NULL), RC_OK);
        at = rc_grid_get(g, "history");
        assert_true(strlen(at) <= MOST);
        if (strlen("first") + k * STEP <= MOST)
            assert_int_equal(strlen(at), strlen("first") + k * STEP);
    }
    assert_memory_equal(at, cut, strlen(cut));
    at += strlen(cut);
    kept = strlen(at) / STEP;
    assert_int_equal(strlen(at), kept * STEP);
    assert_true(strlen(cut) + (kept + 1) * STEP > MOST);
    for (size_t k = STEPS - kept + 1; k <= STEPS; k++, at += STEP) {
        char step[STEP];
        snprintf(step, sizeof step, "%sstep %03zu 0", separator, k);
        assert_memory_equal(at, step, strlen(step));
    }
    rc_grid_free(g);
}

/* A single step that is too long is cut at its end, never inside a character, for any number of other
 * steps. */
static void
test_long_step(void **state)
{
    enum {
        MOST = 32 * 1024,
        LONG = 40001
    };
    struct rc_grid *g = ugly_grid();
    char *step = malloc(LONG + 1);
    const char *at;

    (void)state;
    assert_non_null(step);
    for (size_t k = 0; k < 4; k++) {
        memset(step, (int)('a' + k), LONG);
        for (size_t i = k; i + 1 < LONG; i += 2) /* two bytes a character */
            memcpy(step + i, "\xc3\xa4", 2);
        step[LONG] = '\0';
        assert_int_equal(rc_grid_history(g, step, NULL), RC_OK);
        at = rc_grid_get(g, "history");
        assert_true(strlen(at) <= MOST);
        assert_int_equal(memcmp(at + strlen(at) - 5, "\xc3\xa4...", 5), 0);
        assert_true(k == 0 || strstr(at, " | ") != NULL);
    }
    free(step);
    rc_grid_free(g);
}

static void
test_full_disk(void **state)
{
    struct rc_grid *g = ugly_grid();
    FILE *file = fopen("/dev/full", "wb");
    struct rc_writer *w;
    struct rc_err err;

    (void)state;
    if (file == NULL)
        skip();
    w = rc_writer_new(file, NULL);
    rc_writer_put(w, g, &err);
    assert_int_equal(rc_writer_end(w, &err), RC_FAIL);
    assert_non_null(strstr(err.text, "writing failed"));
    rc_writer_free(w);
    fclose(file);
    rc_grid_free(g);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip_f64),
        cmocka_unit_test(test_round_trip_f32),
        cmocka_unit_test(test_rows),
        cmocka_unit_test(test_layout),
        cmocka_unit_test(test_no_frames),
        cmocka_unit_test(test_every_truncation),
        cmocka_unit_test(test_every_flipped_bit),
        cmocka_unit_test(test_wrong_checksum_and_count),
        cmocka_unit_test(test_lying_sizes),
        cmocka_unit_test(test_failure_is_repeated),
        cmocka_unit_test(test_failure_and_its_status),
        cmocka_unit_test(test_missing_and_doubled_keys),
        cmocka_unit_test(test_spacings),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_words),
        cmocka_unit_test(test_utf8),
        cmocka_unit_test(test_nul),
        cmocka_unit_test(test_longest_header),
        cmocka_unit_test(test_many_keys),
        cmocka_unit_test(test_no_stream_at_all),
        cmocka_unit_test(test_cases_number_on),
        cmocka_unit_test(test_second_stream_cut),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_long_history),
        cmocka_unit_test(test_long_step),
        cmocka_unit_test(test_full_disk),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
