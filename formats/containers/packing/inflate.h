/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Streams of zlib (RFC 1950) inside files. */
#ifndef RC_INFLATE_H
#define RC_INFLATE_H

#include <stddef.h>

#include "libcontact/owned.h"

/* Unpacks the n bytes of a stream, which must give exactly `wanted` bytes; RC_FAIL if it is damaged or gives
 * another number. `what`: name of the bytes in the message. */
enum rc_status rc_inflate(const char *what, const unsigned char *from, size_t n, unsigned char *to,
                          size_t wanted, struct rc_err *err);
/* Unpacks its first bytes, at most `most`, and returns their number: 0 if it is not a stream. */
size_t rc_inflate_start(const unsigned char *from, size_t n, unsigned char *to, size_t most);

#endif
