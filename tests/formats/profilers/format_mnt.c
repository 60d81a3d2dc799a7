/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Documents of Mountains: data other than measured surfaces are refused, and so are false tables and
 * blocks. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/formats/made/made.h"

extern const struct rc_format rc_format_mnt;

/* Replaces the first occurrence of these bytes by a number. */
static void
replace(struct bytes *b, const void *from, size_t n, uint32_t to)
{
    for (size_t at = 0; at + n <= b->n; at++)
        if (memcmp(b->data + at, from, n) == 0) {
            set_raw(b, at, RC_RAW_U32, to);
            return;
        }
    fail_msg("nothing to replace");
}

static void
refusals(void **state)
{
    static const struct {
        const char from[4];
        uint32_t to;
        const char *why;
    } cases[] = {
        {"\x34\x23\0", 9013, "the document has no measured surface"}, /* class 9012 */
        {"\x66\x23\0", 9063, "the document has no measured surface"}, /* 9062 */
        {"\x59\x23\0", 9050, "the document has no measured surface"}, /* 9049 */
    };
    struct bytes b = {0}, none = {0};

    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        make_mnt(&b, 0);
        replace(&b, cases[k].from, 4, cases[k].to);
        refuse(&rc_format_mnt, &b, cases[k].why);
        drop(&b);
    }
    add_zeros(&none, 200);
    ole_file(&b, "ScopedContents", &none);
    refuse(&rc_format_mnt, &b, "the document has no measured surface");
    drop(&b);
    ole_file(&b, "WordDocument", &none);
    refuse(&rc_format_mnt, &b, "has no stream 'ScopedContents'");
    b.data[30] = 40; /* sectors of 2^40 bytes */
    refuse(&rc_format_mnt, &b, "whose header is damaged");
    drop(&b);
    drop(&none);
}

/* A cyclic chain of sectors ends after the bytes of its stream. */
static void
chains(void **state)
{
    struct bytes b = {0};

    (void)state;
    make_mnt(&b, 1);
    set_raw(&b, 512 + 4 * 4, RC_RAW_U32, 3);
    refuse(&rc_format_mnt, &b, "the document has no measured surface");
    set_raw(&b, 512 + 4 * 4, RC_RAW_U32, 0xfffffffe);
    refuse(&rc_format_mnt, &b, "is damaged");
    drop(&b);
}

static void
cuts_and_changes(void **state)
{
    (void)state;
    for (int variant = 0; variant < 2; variant++) {
        struct bytes b = {0};

        make_mnt(&b, variant);
        refuse_cuts(&rc_format_mnt, &b, b.n - 512, 1);
        survive_changes(&rc_format_mnt, &b, 4000);
        drop(&b);
    }
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refusals),
        cmocka_unit_test(chains),
        cmocka_unit_test(cuts_and_changes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
