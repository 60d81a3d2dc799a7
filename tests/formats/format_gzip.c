/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gzip files are unpacked completely or refused, and a decompression bomb takes no memory. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include <cmocka.h>
#include <zlib.h>

#include "formats/containers/containers.h"
#include "made/made.h"

enum {
    UNPACKED = 300000
};

/* Appends a member that holds data[0..n) `times` over, with a name and a comment in its header. */
static void
add_member(struct bytes *b, const void *data, size_t n, size_t times)
{
    unsigned char piece[4096];
    gz_header header = {.name = (Bytef *)(uintptr_t) "map.txt", .comment = (Bytef *)(uintptr_t) ""};
    z_stream z = {0};
    int said;

    assert_int_equal(deflateInit2(&z, 6, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY), Z_OK);
    deflateSetHeader(&z, &header);
    for (size_t k = 0; k < times; k++) {
        z.next_in = (z_const Bytef *)(uintptr_t)data;
        z.avail_in = (uInt)n;
        do {
            z.next_out = piece;
            z.avail_out = sizeof piece;
            said = deflate(&z, k + 1 == times ? Z_FINISH : Z_NO_FLUSH);
            add(b, piece, sizeof piece - z.avail_out);
        } while (z.avail_out == 0);
    }
    assert_int_equal(said, times == 0 ? Z_OK : Z_STREAM_END);
    deflateEnd(&z);
}

/* Bytes that compress to about a half, from a linear congruential generator. */
static unsigned char *
some_bytes(void)
{
    unsigned char *data = malloc(UNPACKED);
    uint32_t state = 7;

    for (size_t k = 0; k < UNPACKED; k++) {
        state = state * 1664525 + 1013904223;
        data[k] = (unsigned char)('0' + (state >> 24) % 10);
    }
    return data;
}

static void
expect(const struct bytes *b, const unsigned char *data, size_t n)
{
    struct rc_file file = file_of(b, "a.gz");
    struct rc_err err = {""};
    size_t size;
    unsigned char *got = rc_file_unpack(&file, n, &size, &err);

    if (got == NULL)
        fail_msg("refused: %s", err.text);
    assert_int_equal(size, n);
    assert_memory_equal(got, data, n);
    free(got);
}

static void
expect_refusal(const struct bytes *b, size_t most, const char *why)
{
    struct rc_file file = file_of(b, "a.gz");
    struct rc_err err = {""};
    size_t size;

    assert_null(rc_file_unpack(&file, most, &size, &err));
    if (strstr(err.text, why) == NULL)
        fail_msg("refused for '%s', not for '%s'", err.text, why);
}

static void
members_are_joined(void **state)
{
    static const size_t cuts[] = {0, 1, 65535, 65536, 65537, UNPACKED};
    unsigned char *data = some_bytes();

    (void)state;
    for (size_t k = 0; k < sizeof cuts / sizeof *cuts; k++) {
        struct bytes b = {0};

        add_member(&b, data, cuts[k], 1);
        expect(&b, data, cuts[k]);
        add_member(&b, data + cuts[k], UNPACKED - cuts[k], 1);
        expect(&b, data, UNPACKED);
        add(&b, "\0\0\0", 3);
        expect(&b, data, UNPACKED);
        expect_refusal(&b, UNPACKED - 1, "unpack to more than 0 MiB");
        add(&b, "x", 1);
        expect_refusal(&b, UNPACKED, "the file has 4 further bytes that are not gzip data");
        drop(&b);
    }
    free(data);
}

/* A file that is cut anywhere is refused, except for a cut between members. */
static void
every_truncation(void **state)
{
    unsigned char *data = some_bytes();
    struct bytes b = {0};
    size_t first;

    (void)state;
    add_member(&b, data, 1000, 1);
    first = b.n;
    add_member(&b, data, 1000, 1);
    for (size_t n = 2; n < b.n; n++) {
        struct bytes cut = {.data = b.data, .n = n};

        if (n == first)
            expect(&cut, data, 1000);
        else
            expect_refusal(&cut, UNPACKED,
                           n == first + 1 ? "the file has 1 further bytes that are not gzip data"
                                          : "cut short");
    }
    drop(&b);
    free(data);
}

/* A changed byte in the data or in the checksums never gives other data. */
static void
every_byte_damaged(void **state)
{
    unsigned char *data = some_bytes();
    struct bytes b = {0};

    (void)state;
    add_member(&b, data, 1000, 1);
    for (size_t k = 0; k < b.n; k++) {
        struct rc_file file = file_of(&b, "a.gz");
        unsigned char *got;
        size_t size;

        b.data[k] ^= 0x55;
        got = rc_file_unpack(&file, UNPACKED, &size, NULL);
        if (got != NULL) { /* the changed byte is the time, the name or the system in the header */
            assert_in_range(k, 4, 19);
            assert_int_equal(size, 1000);
            assert_memory_equal(got, data, 1000);
        }
        free(got);
        b.data[k] ^= 0x55;
    }
    drop(&b);
    free(data);
}

static size_t
peak_memory(void)
{
    struct rusage usage;

    getrusage(RUSAGE_SELF, &usage);
    return (size_t)usage.ru_maxrss * 1024;
}

static void
a_bomb_takes_no_memory(void **state)
{
    static const unsigned char zeros[1 << 20];
    struct bytes b = {0};
    size_t before, most;

    (void)state;
    add_member(&b, zeros, sizeof zeros, 128);
    most = rc_memory_limit(b.n);
    assert_true(most > 64 << 20 && most < 80 << 20);
    before = peak_memory();
    expect_refusal(&b, most, "bytes of gzip data unpack to more than ");
    assert_true(peak_memory() - before < 4 << 20);
    drop(&b);
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(
            a_bomb_takes_no_memory), /* the first test, because it measures the peak of memory */
        cmocka_unit_test(members_are_joined),
        cmocka_unit_test(every_truncation),
        cmocka_unit_test(every_byte_damaged),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
