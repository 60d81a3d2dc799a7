/* What reading and writing of a stream share: the order of bytes and the checksum over them. */
#ifndef RC_STREAM_BYTES_H
#define RC_STREAM_BYTES_H

#include <libdeflate.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum {
    RC_CHUNK = 8192,  /* values converted at a time where they are not read as they are */
    RC_PIECE = 32768, /* values summed and passed on at a time: they stay in a cache    */
    RC_FAIL_MAX = 399 /* bytes of a message in RCGFAIL: what a reader repeats           */
};

static inline bool
rc_host_is_little(void)
{
    const uint16_t one = 1;
    unsigned char first;

    memcpy(&first, &one, 1);
    return first == 1;
}

static inline void
rc_swap_bytes(void *values, size_t n, size_t width)
{
    unsigned char *b = values;

    for (size_t k = 0; k < n; k++, b += width)
        for (size_t a = 0; a < width / 2; a++) {
            unsigned char byte = b[a];
            b[a] = b[width - 1 - a];
            b[width - 1 - a] = byte;
        }
}

/* By libdeflate: five times as fast as zlib, whose sum would take as long as the transforms of a
 * slice of stresses. */
static inline uint32_t
rc_crc_add(uint32_t crc, const void *bytes, size_t n)
{
    return libdeflate_crc32(crc, bytes, n);
}

#endif
