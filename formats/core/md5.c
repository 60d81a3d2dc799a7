#include "md5.h"

#include <string.h>

/* floor(2^32 |sin(k + 1)|), RFC 1321 section 3.4 */
/* clang-format off */
static const uint32_t sines[64] = {
    0xd76aa478, 0xe8c7b756, 0x242070db, 0xc1bdceee, 0xf57c0faf, 0x4787c62a,
    0xa8304613, 0xfd469501, 0x698098d8, 0x8b44f7af, 0xffff5bb1, 0x895cd7be,
    0x6b901122, 0xfd987193, 0xa679438e, 0x49b40821, 0xf61e2562, 0xc040b340,
    0x265e5a51, 0xe9b6c7aa, 0xd62f105d, 0x02441453, 0xd8a1e681, 0xe7d3fbc8,
    0x21e1cde6, 0xc33707d6, 0xf4d50d87, 0x455a14ed, 0xa9e3e905, 0xfcefa3f8,
    0x676f02d9, 0x8d2a4c8a, 0xfffa3942, 0x8771f681, 0x6d9d6122, 0xfde5380c,
    0xa4beea44, 0x4bdecfa9, 0xf6bb4b60, 0xbebfbc70, 0x289b7ec6, 0xeaa127fa,
    0xd4ef3085, 0x04881d05, 0xd9d4d039, 0xe6db99e5, 0x1fa27cf8, 0xc4ac5665,
    0xf4292244, 0x432aff97, 0xab9423a7, 0xfc93a039, 0x655b59c3, 0x8f0ccc92,
    0xffeff47d, 0x85845dd1, 0x6fa87e4f, 0xfe2ce6e0, 0xa3014314, 0x4e0811a1,
    0xf7537e82, 0xbd3af235, 0x2ad7d2bb, 0xeb86d391,
};
/* clang-format on */

static const unsigned char turns[4][4] = {
    {7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}};

static uint32_t
rotate(uint32_t x, unsigned n)
{
    return x << n | x >> (32 - n);
}

static uint32_t
little_word(const unsigned char *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* One step of a round: what does not wait for b is summed first, b comes last in its own chain. */
static inline uint32_t
step(uint32_t a, uint32_t b, uint32_t early, uint32_t late, unsigned turn)
{
    return b + rotate(a + early + late, turn);
}

/* Unrolled, so that the turns are constants and the four words change their names, not places. */
#define ROUND(number, pick, early, late)                                                           \
    _Pragma("GCC unroll 16") for (unsigned k = 0; k < 16; k++)                                     \
    {                                                                                              \
        const uint32_t first = sines[16 * (number) + k] + word[(pick) % 16];                       \
        const uint32_t next = step(a, b, first + (early), late, turns[number][k % 4]);             \
        a = d;                                                                                     \
        d = c;                                                                                     \
        c = b;                                                                                     \
        b = next;                                                                                  \
    }

static void
add_block(uint32_t state[4], const unsigned char *block)
{
    uint32_t word[16], a = state[0], b = state[1], c = state[2], d = state[3];

    for (size_t k = 0; k < 16; k++)
        word[k] = little_word(block + 4 * k);
    ROUND(0, k, 0, d ^ (b & (c ^ d)))
    ROUND(1, 5 * k + 1, c & ~d, b & d)
    ROUND(2, 3 * k + 5, 0, b ^ (c ^ d))
    ROUND(3, 7 * k, 0, c ^ (b | ~d))
    state[0] += a;
    state[1] += b;
    state[2] += c;
    state[3] += d;
}

void
rc_md5_start(struct rc_md5 *m)
{
    *m = (struct rc_md5){.state = {0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476}};
}

void
rc_md5_add(struct rc_md5 *m, const void *bytes, size_t n)
{
    const unsigned char *b = bytes;
    size_t held = (size_t)(m->bytes % sizeof m->block);

    m->bytes += n;
    if (held > 0) {
        size_t take = sizeof m->block - held < n ? sizeof m->block - held : n;

        memcpy(m->block + held, b, take);
        b += take;
        n -= take;
        if (held + take < sizeof m->block)
            return;
        add_block(m->state, m->block);
    }
    for (; n >= sizeof m->block; n -= sizeof m->block, b += sizeof m->block)
        add_block(m->state, b);
    if (n > 0)
        memcpy(m->block, b, n);
}

void
rc_md5_end(struct rc_md5 *m, char text[RC_MD5_TEXT])
{
    static const char digits[] = "0123456789abcdef";
    static const unsigned char padding[64] = {0x80};
    unsigned char length[8];
    uint64_t bits = m->bytes << 3;

    for (unsigned k = 0; k < 8; k++)
        length[k] = (unsigned char)(bits >> 8 * k);
    rc_md5_add(m, padding, 1 + (119 - (size_t)(m->bytes % 64)) % 64);
    rc_md5_add(m, length, sizeof length);
    for (unsigned k = 0; k < 16; k++) {
        uint32_t byte = m->state[k / 4] >> 8 * (k % 4) & 0xffU;
        text[2 * k] = digits[byte >> 4];
        text[2 * k + 1] = digits[byte & 15U];
    }
    text[32] = '\0';
}
