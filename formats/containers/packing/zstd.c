/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "zstd.h"

#include <stdint.h>
#include <stdlib.h>

#ifdef RC_HAS_ZSTD

#include <zstd.h>

enum {
    FIRST = 1 << 16,  /* initial size of the buffer if the frame does not give its size */
    WINDOW_MOST = 25, /* binary logarithm of the largest window of a frame */
};

bool
rc_zstd_is_there(void)
{
    return true;
}

/* Unpacks into a buffer that grows as needed up to `most`; returns the number of bytes, or SIZE_MAX. */
static size_t
unpack(ZSTD_DCtx *d, ZSTD_inBuffer *in, unsigned char **room, size_t capacity, size_t most)
{
    ZSTD_outBuffer out = {*room, capacity, 0};
    size_t left = 1;

    while (left != 0) {
        size_t before = in->pos + out.pos;

        left = ZSTD_decompressStream(d, &out, in);
        if (ZSTD_isError(left))
            return SIZE_MAX;
        if (left != 0 && out.pos == out.size && out.size < most) {
            size_t more = out.size > most / 2 ? most : 2 * out.size;
            unsigned char *larger = realloc(*room, more + 1);

            if (larger == NULL)
                return SIZE_MAX;
            out.dst = *room = larger;
            out.size = more;
        } else if (left != 0 && in->pos + out.pos == before)
            return SIZE_MAX; /* cut off, or more than allowed */
    }
    return out.pos;
}

unsigned char *
rc_zstd_unpack(const char *what, const unsigned char *from, size_t n, size_t most, size_t *size,
               struct rc_err *err)
{
    unsigned long long said = ZSTD_getFrameContentSize(from, n);
    size_t capacity = said <= most ? (size_t)said : most < FIRST ? most : FIRST;
    ZSTD_inBuffer in = {from, n, 0};
    RC_OWNED unsigned char *room = NULL;
    ZSTD_DCtx *d = NULL;

    *size = SIZE_MAX;
    if (said == ZSTD_CONTENTSIZE_ERROR || (said != ZSTD_CONTENTSIZE_UNKNOWN && said > most))
        return rc_err_null(err, "the %s are not a frame of zstd, or one of more bytes than can be",
                           what);
    if ((d = ZSTD_createDCtx()) == NULL || (room = malloc(capacity + 1)) == NULL ||
        ZSTD_isError(ZSTD_DCtx_setParameter(d, ZSTD_d_windowLogMax, WINDOW_MOST)))
        rc_err_set(err, "out of memory for zstd");
    else if ((*size = unpack(d, &in, &room, capacity, most)) == SIZE_MAX)
        rc_err_set(err, "the %s that zstd packed are damaged, cut off or more than can be", what);
    else
        room[*size] = '\0';
    ZSTD_freeDCtx(d);
    return *size != SIZE_MAX ? rc_give(&room) : NULL;
}

#else

bool
rc_zstd_is_there(void)
{
    return false;
}

unsigned char *
rc_zstd_unpack(const char *what, const unsigned char *from, size_t n, size_t most, size_t *size,
               struct rc_err *err)
{
    (void)from, (void)n, (void)most, (void)size;
    return rc_err_null(err, "the %s are packed by zstd, but this program was built without zstd",
                       what);
}

#endif
