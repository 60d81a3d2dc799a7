/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "inflate.h"

#include <limits.h>
#include <zlib.h>

/* Limits both sizes to the range of zlib; further bytes are ignored. */
static z_stream
stream_of(const unsigned char *from, size_t n, unsigned char *to, size_t most)
{
    return (z_stream){.next_in = (z_const Bytef *)from,
                      .avail_in = n < UINT_MAX ? (uInt)n : UINT_MAX,
                      .next_out = to,
                      .avail_out = most < UINT_MAX ? (uInt)most : UINT_MAX};
}

enum rc_status
rc_inflate(const char *what, const unsigned char *from, size_t n, unsigned char *to, size_t wanted,
           struct rc_err *err)
{
    z_stream z = stream_of(from, n, to, wanted);
    int status;

    if (inflateInit(&z) != Z_OK)
        return rc_err_set(err, "out of memory for zlib");
    status = inflate(&z, Z_FINISH);
    inflateEnd(&z);
    if (status != Z_STREAM_END || z.total_out != wanted)
        return rc_err_set(
            err, "the compressed %s are damaged: only %lu of %zu bytes can be unpacked%s%s", what,
            z.total_out, wanted, z.msg == NULL ? "" : ", ", z.msg == NULL ? "" : z.msg);
    return RC_OK;
}

size_t
rc_inflate_start(const unsigned char *from, size_t n, unsigned char *to, size_t most)
{
    z_stream z = stream_of(from, n, to, most);

    if (inflateInit(&z) != Z_OK)
        return 0;
    inflate(&z, Z_SYNC_FLUSH);
    inflateEnd(&z);
    return z.total_out;
}
