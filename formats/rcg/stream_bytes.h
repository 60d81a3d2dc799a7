/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading and writing of a stream share this file: byte order and checksum. */
#ifndef RC_STREAM_BYTES_H
#define RC_STREAM_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum {
    RC_CHUNK = 8192, /* values converted together */
    /* values read or written together without conversion; they are in the cache for the checksum */
    RC_PIECE = 16384,
    RC_FAIL_MAX = 399 /* bytes of a message in RCGFAIL that a reader repeats */
};

/* Precedes the exit status in RCGFAIL if it is not 1; ")" follows it. */
#define RC_FAIL_STATUS " (exit status "

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

#endif
