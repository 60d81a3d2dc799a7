/* Streams of zlib (RFC 1950) inside files. */
#ifndef RC_INFLATE_H
#define RC_INFLATE_H

#include <stddef.h>

#include "libcontact/grid.h"

/* Unpacks the n bytes of a stream into the `wanted` bytes that it must hold; RC_FAIL where it is
 * damaged or holds another number of them. `what` they are, for the message. */
enum rc_status rc_inflate(const char *what, const unsigned char *from, size_t n, unsigned char *to,
                          size_t wanted, struct rc_err *err);
/* Unpacks its first bytes, at most `most`, and gives their number: 0 for no stream. */
size_t rc_inflate_start(const unsigned char *from, size_t n, unsigned char *to, size_t most);

#endif
