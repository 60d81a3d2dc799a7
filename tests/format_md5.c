/* MD5 sums are those of RFC 1321, however the bytes are cut into pieces. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "formats/core/md5.h"

/* RFC 1321, A.5, and the million a's that go round with the SHA test vectors. */
static const struct {
    const char *text, *sum;
} vectors[] = {
    {"", "d41d8cd98f00b204e9800998ecf8427e"},
    {"a", "0cc175b9c0f1b6a831c399e269772661"},
    {"abc", "900150983cd24fb0d6963f7d28e17f72"},
    {"message digest", "f96b697d7cb7938d525a2f31aaf161d0"},
    {"abcdefghijklmnopqrstuvwxyz", "c3fcd3d76192e4007dfb496cca67e13b"},
    {"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789",
     "d174ab98d277d9f5a5611c2c9f419d9f"},
    {"12345678901234567890123456789012345678901234567890123456789012345678901234567890",
     "57edf4a22be3c955ac49da2e2107b67a"},
};

static void
vectors_of_the_rfc(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++) {
        const char *text = vectors[k].text;
        for (size_t cut = 0; cut <= strlen(text); cut++) {
            char sum[RC_MD5_TEXT];
            struct rc_md5 md5;
            rc_md5_start(&md5);
            rc_md5_add(&md5, text, cut);
            rc_md5_add(&md5, text + cut, strlen(text) - cut);
            rc_md5_end(&md5, sum);
            assert_string_equal(sum, vectors[k].sum);
        }
    }
}

static void
a_million_bytes_in_odd_pieces(void **state)
{
    char piece[997], sum[RC_MD5_TEXT];
    struct rc_md5 md5;

    (void)state;
    memset(piece, 'a', sizeof piece);
    rc_md5_start(&md5);
    for (size_t left = 1000000, n; left > 0; left -= n) {
        n = left < sizeof piece ? left : sizeof piece;
        rc_md5_add(&md5, piece, n);
    }
    rc_md5_end(&md5, sum);
    assert_string_equal(sum, "7707d6ae4e027c70eea2a935c2296f21");
}

int
main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vectors_of_the_rfc),
        cmocka_unit_test(a_million_bytes_in_odd_pieces),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
