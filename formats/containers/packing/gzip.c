/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Gzip files (RFC 1952) with one or several members. A few packed bytes can give any number of bytes, so the
 * data are unpacked twice. The first pass counts and checks them piece by piece; the second unpacks into
 * memory of exactly their size.
 */
#include "gzip.h"

#include <stdint.h>
#include <stdlib.h>
#include <zlib.h>

enum {
    PIECE = 1 << 16,      /* size of the pieces when bytes are only counted */
    GZIP = 16 + MAX_WBITS /* zlib then expects a gzip header */
};

bool
rc_file_packed(const struct rc_file *file)
{
    return rc_file_holds(file, 0, "\x1f\x8b", 2);
}

/* Refills the input when it is empty: zlib counts in 32 bits. */
static void
feed(z_stream *z, const struct rc_file *file, size_t *given)
{
    size_t left = file->size - *given;

    if (z->avail_in > 0)
        return;
    z->avail_in = (uInt)(left < (1u << 30) ? left : (1u << 30));
    *given += z->avail_in;
}

/* The message of zlib. */
static enum rc_status
refuse(const z_stream *z, int status, size_t n, struct rc_err *err)
{
    if (status == Z_MEM_ERROR)
        return rc_err_set(err, "out of memory for zlib");
    if (status == Z_BUF_ERROR)
        return rc_err_set(err, "its gzip data are cut short: they end after %zu unpacked bytes", n);
    return rc_err_set(err, "its gzip data are damaged after %zu unpacked bytes (%s)", n,
                      z->msg == NULL ? "zlib" : z->msg);
}

/* True if another member follows; padding with zeros is allowed. */
static enum rc_status
look_on(const struct rc_file *file, const z_stream *z, bool *more, struct rc_err *err)
{
    size_t at = (size_t)(z->next_in - file->data);
    struct rc_file rest = {.data = file->data + at, .size = file->size - at};

    *more = rc_file_packed(&rest);
    for (size_t k = 0; k < rest.size && !*more; k++)
        if (rest.data[k] != 0)
            return rc_err_set(
                err, "after its gzip data the file has %zu further bytes that are not gzip data",
                rest.size);
    return RC_OK;
}

static void
end(z_stream *z)
{
    (void)inflateEnd(z);
}

/* Unpacks all members into `to`, which has *size + 1 bytes. If it is NULL, only sets *size to the number of
 * unpacked bytes, up to `most`. */
static enum rc_status
unpack(const struct rc_file *file, size_t most, unsigned char *to, size_t *size, struct rc_err *err)
{
    RC_OWNED unsigned char *piece = to == NULL ? malloc(PIECE) : NULL;
    RC_ENDS(end) z_stream z = {.next_in = (z_const Bytef *)(uintptr_t)file->data};
    size_t given = 0, n = 0;
    bool more = true;
    int said;

    if ((to == NULL && piece == NULL) || inflateInit2(&z, GZIP) != Z_OK)
        return rc_err_set(err, "out of memory for zlib");
    while (more) {
        size_t left = *size + 1 - n; /* one more, so that zlib always has space to write */
        size_t room = to == NULL ? PIECE : left < (1u << 30) ? left : (1u << 30);

        feed(&z, file, &given);
        z.next_out = to == NULL ? piece : to + n;
        z.avail_out = (uInt)room;
        said = inflate(&z, Z_NO_FLUSH);
        n += room - z.avail_out;
        if (n > most)
            return rc_err_set(
                err,
                "its %zu bytes of gzip data unpack to more than %zu MiB, the limit for a file of "
                "this size: --memory LIMIT sets another",
                file->size, most >> 20);
        if (said != Z_OK && said != Z_STREAM_END)
            return refuse(&z, said, n, err);
        if (said == Z_STREAM_END) {
            if (look_on(file, &z, &more, err) != RC_OK)
                return RC_FAIL;
            inflateReset(&z);
        }
    }
    *size = n;
    return RC_OK;
}

unsigned char *
rc_file_unpack(const struct rc_file *file, size_t most, size_t *size, struct rc_err *err)
{
    RC_OWNED unsigned char *data = NULL;

    *size = 0;
    if (unpack(file, most, NULL, size, err) != RC_OK)
        return NULL;
    if ((data = malloc(*size + 1)) == NULL)
        return rc_err_null(err, "out of memory for %zu unpacked bytes", *size);
    return unpack(file, most, data, size, err) == RC_OK ? rc_give(&data) : NULL;
}
