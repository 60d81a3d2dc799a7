#include "zip_write.h"

#include <stdlib.h>
#include <zip.h>
#include <zlib.h>

#include "encode.h"

enum {
    PIECE = 1 << 16,
    LEVEL = 1, /* noise packs no better at a higher one, only slower */
    LOOKED = 4 /* pieces of a member that are tried                   */
};

struct rc_pack {
    zip_source_t *made; /* where the archive grows */
    zip_t *zip;         /* NULL once it is closed  */
    time_t time;
};

struct rc_pack *
rc_pack_new(int64_t time, struct rc_err *err)
{
    struct rc_pack *p = calloc(1, sizeof *p);

    if (p == NULL || (p->made = zip_source_buffer_create(NULL, 0, 0, NULL)) == NULL ||
        (p->zip = zip_open_from_source(p->made, ZIP_TRUNCATE, NULL)) == NULL) {
        rc_err_set(err, "out of memory for an archive");
        rc_pack_free(p);
        return NULL;
    }
    zip_source_keep(p->made); /* closing the archive gives up its own hold */
    p->time = (time_t)time;
    return p;
}

/* Whether bytes become a tenth fewer at least, as far as pieces spread over them tell. What does
 * not is stored as it is: a reader has them several times as fast. */
static bool
packs_well(const unsigned char *bytes, size_t n)
{
    static unsigned char packed[PIECE + PIECE / 8];
    uLong before = 0, after = 0;

    if (n < PIECE)
        return true;
    for (size_t k = 0; k < LOOKED; k++) {
        uLongf size = sizeof packed;

        if (compress2(packed, &size, bytes + (n - PIECE) / (LOOKED - 1) * k, PIECE, LEVEL) != Z_OK)
            return true;
        before += PIECE;
        after += size;
    }
    return (double)after < 0.9 * (double)before;
}

enum rc_status
rc_pack_add(struct rc_pack *p, const char *name, void *bytes, size_t n, struct rc_err *err)
{
    zip_int32_t method = packs_well(bytes, n) ? ZIP_CM_DEFLATE : ZIP_CM_STORE;
    zip_source_t *from = zip_source_buffer(p->zip, bytes, n, 1);
    zip_int64_t index;

    if (from == NULL) {
        free(bytes);
        return rc_err_set(err, "out of memory for the member '%s'", name);
    }
    if ((index = zip_file_add(p->zip, name, from, ZIP_FL_ENC_UTF_8)) < 0) {
        zip_source_free(from);
        return rc_err_set(err, "the member '%s': %s", name, zip_strerror(p->zip));
    }
    if (zip_set_file_compression(p->zip, (zip_uint64_t)index, method, LEVEL) != 0 ||
        zip_file_set_mtime(p->zip, (zip_uint64_t)index, p->time, 0) != 0)
        return rc_err_set(err, "the member '%s': %s", name, zip_strerror(p->zip));
    return RC_OK;
}

enum rc_status
rc_pack_write(struct rc_pack *p, FILE *out, struct rc_err *err)
{
    static char piece[PIECE];
    enum rc_status status = RC_OK;
    zip_int64_t n;

    if (zip_close(p->zip) != 0)
        return rc_err_set(err, "the archive: %s", zip_strerror(p->zip));
    p->zip = NULL;
    if (zip_source_open(p->made) != 0)
        return rc_err_set(err, "the archive cannot be read back");
    while (status == RC_OK && (n = zip_source_read(p->made, piece, sizeof piece)) > 0)
        status = rc_put(out, piece, (size_t)n, err);
    zip_source_close(p->made);
    return status == RC_OK && n < 0 ? rc_err_set(err, "the archive cannot be read back") : status;
}

void
rc_pack_free(struct rc_pack *p)
{
    if (p == NULL)
        return;
    if (p->zip != NULL)
        zip_discard(p->zip);
    if (p->made != NULL)
        zip_source_free(p->made);
    free(p);
}
