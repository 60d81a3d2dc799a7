/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "zip_write.h"

#include <assert.h>
#include <stdlib.h>
#include <zip.h>
#include <zlib.h>

#include "formats/core/core.h"

enum {
    CHUNK = 1 << 16,
    LEVEL = 1, /* a higher level compresses noise no better and is slower */
    TRIED = 4, /* number of chunks of a member that are tried */
    MEMBERS = 16
};

struct rc_zip_write {
    zip_source_t *made; /* the growing archive */
    zip_t *zip;         /* NULL once it is closed  */
    time_t time;
    /* Freed at the end: when memory is short libzip may or may not have freed it, without reporting which. */
    void *given[MEMBERS];
    size_t members, size; /* bytes that the archive is expected to take */
    void *reserved;       /* never touched: counts the archive, which libzip holds */
};

struct rc_zip_write *
rc_zip_write_new(int64_t time, struct rc_err *err)
{
    struct rc_zip_write *w = calloc(1, sizeof *w);

    if (w == NULL || (w->made = zip_source_buffer_create(NULL, 0, 0, NULL)) == NULL ||
        (w->zip = zip_open_from_source(w->made, ZIP_TRUNCATE, NULL)) == NULL) {
        rc_err_set(err, "out of memory for an archive");
        rc_zip_write_free(w);
        return NULL;
    }
    zip_source_keep(w->made); /* closing the archive releases its reference */
    w->time = (time_t)time;
    return w;
}

/* The part of its size to which a member is compressed, estimated from a few chunks that are distributed over
 * it. */
static double
compressed_part(const unsigned char *bytes, size_t n)
{
    static unsigned char compressed[CHUNK + CHUNK / 8];
    uLong before = 0, after = 0;

    if (n < CHUNK)
        return 0;
    for (size_t k = 0; k < TRIED; k++) {
        uLongf size = sizeof compressed;

        if (compress2(compressed, &size, bytes + (n - CHUNK) / (TRIED - 1) * k, CHUNK, LEVEL) !=
            Z_OK)
            return 0;
        before += CHUNK;
        after += size;
    }
    return (double)after / (double)before;
}

enum rc_status
rc_zip_write_add(struct rc_zip_write *w, const char *name, void *bytes, size_t n,
                 struct rc_err *err)
{
    /* other members are stored uncompressed, which makes reading several times as fast */
    double part = compressed_part(bytes, n);
    zip_int32_t method = part < 0.9 ? ZIP_CM_DEFLATE : ZIP_CM_STORE;
    zip_source_t *from;
    zip_int64_t index;

    assert(w->members < MEMBERS);
    w->given[w->members++] = bytes;
    w->size += method == ZIP_CM_STORE ? n : (size_t)(part * (double)n);
    if ((from = zip_source_buffer(w->zip, bytes, n, 0)) == NULL)
        return rc_err_set(err, "out of memory for the member '%s'", name);
    if ((index = zip_file_add(w->zip, name, from, ZIP_FL_ENC_UTF_8)) < 0) {
        zip_source_free(from);
        return rc_err_set(err, "the member '%s': %s", name, zip_strerror(w->zip));
    }
    if (zip_set_file_compression(w->zip, (zip_uint64_t)index, method, LEVEL) != 0 ||
        zip_file_set_mtime(w->zip, (zip_uint64_t)index, w->time, 0) != 0)
        return rc_err_set(err, "the member '%s': %s", name, zip_strerror(w->zip));
    return RC_OK;
}

enum rc_status
rc_zip_write_finish(struct rc_zip_write *w, FILE *out, struct rc_err *err)
{
    static char chunk[CHUNK];
    enum rc_status status = RC_OK;
    zip_int64_t n;

    if ((w->reserved = malloc(w->size)) == NULL)
        return rc_err_set(err, "out of memory for an archive of %zu bytes", w->size);
    if (zip_close(w->zip) != 0)
        return rc_err_set(err, "the archive: %s", zip_strerror(w->zip));
    w->zip = NULL;
    if (zip_source_open(w->made) != 0)
        return rc_err_set(err, "the archive cannot be read back");
    while (status == RC_OK && (n = zip_source_read(w->made, chunk, sizeof chunk)) > 0)
        status = rc_put(out, chunk, (size_t)n, err);
    zip_source_close(w->made);
    return status == RC_OK && n < 0 ? rc_err_set(err, "the archive cannot be read back") : status;
}

void
rc_zip_write_free(struct rc_zip_write *w)
{
    if (w == NULL)
        return;
    if (w->zip != NULL)
        zip_discard(w->zip);
    if (w->made != NULL)
        zip_source_free(w->made);
    while (w->members > 0)
        free(w->given[--w->members]);
    free(w->reserved);
    free(w);
}
