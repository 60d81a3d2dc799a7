/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "zip_read.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>

#include "formats/core/core.h"

enum {
    DEFLATE_MOST = 1032 /* most bytes from one deflated byte: 258 for two bits */
};

struct rc_zip_read {
    zip_t *zip;
    size_t size;
};

static zip_t *
open_zip(const struct rc_file *file, zip_error_t *why)
{
    zip_source_t *source = zip_source_buffer_create(file->data, file->size, 0, why);
    zip_t *zip = source == NULL ? NULL : zip_open_from_source(source, ZIP_RDONLY, why);

    if (zip == NULL)
        zip_source_free(source);
    return zip;
}

struct rc_zip_read *
rc_zip_read_new(const struct rc_file *file, struct rc_err *err)
{
    if (file->size >= 4 && rc_file_holds(file, 0, "PK", 2))
        return rc_zip_read_behind(file, err);
    return rc_err_null(err, "no ZIP archive: it does not begin with 'PK'");
}

struct rc_zip_read *
rc_zip_read_behind(const struct rc_file *file, struct rc_err *err)
{
    RC_OWNED struct rc_zip_read *a = calloc(1, sizeof *a);
    RC_ENDS(zip_error_fini) zip_error_t why;

    zip_error_init(&why);
    if (a == NULL)
        return rc_err_null(err, "out of memory for an archive (%zu bytes)", sizeof *a);
    a->size = file->size;
    if ((a->zip = open_zip(file, &why)) == NULL)
        return rc_err_null(err, "the ZIP archive is damaged or cut off: %s",
                           zip_error_strerror(&why));
    return rc_give(&a);
}

void
rc_zip_read_free(struct rc_zip_read *a)
{
    if (a == NULL)
        return;
    zip_discard(a->zip);
    free(a);
}

size_t
rc_zip_read_members(const struct rc_zip_read *a)
{
    zip_int64_t n = zip_get_num_entries(a->zip, 0);

    return n < 0 ? 0 : (size_t)n;
}

const char *
rc_zip_read_name(const struct rc_zip_read *a, size_t member)
{
    const char *name = zip_get_name(a->zip, member, ZIP_FL_ENC_RAW);

    return name == NULL ? "" : name;
}

enum rc_status
rc_zip_read_find(const struct rc_zip_read *a, const char *name, size_t *member, struct rc_err *err)
{
    size_t n = rc_zip_read_members(a);

    for (size_t k = 0; k < n; k++)
        if (strcmp(rc_zip_read_name(a, k), name) == 0) {
            *member = k;
            return RC_OK;
        }
    return rc_err_set(err, "the archive has no member '%s'", rc_word_shown(name));
}

enum rc_status
rc_zip_read_size(struct rc_zip_read *a, size_t member, uint64_t *size, struct rc_err *err)
{
    const zip_uint64_t needed =
        ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
    const char *name = rc_zip_read_name(a, member);
    char shown[RC_SHOWN];
    zip_stat_t st;

    rc_word_shown_to(shown, name);
    if (zip_stat_index(a->zip, member, 0, &st) != 0 || (st.valid & needed) != needed)
        return rc_err_set(err, "member '%s' of the archive: no size is given", shown);
    if (st.encryption_method != ZIP_EM_NONE)
        return rc_err_set(err, "member '%s' of the archive is encrypted", shown);
    if (st.comp_method != ZIP_CM_STORE && st.comp_method != ZIP_CM_DEFLATE)
        return rc_err_set(err,
                          "member '%s' of the archive is packed by method %u: only stored and "
                          "deflated ones are read",
                          shown, (unsigned)st.comp_method);
    if (st.comp_size > a->size)
        return rc_err_set(
            err, "member '%s' of the archive promises %" PRIu64 " packed bytes, the file has %zu",
            shown, (uint64_t)st.comp_size, a->size);
    if (st.size / DEFLATE_MOST > st.comp_size)
        return rc_err_set(err,
                          "member '%s' of the archive promises %" PRIu64
                          " bytes, which its %" PRIu64 " packed ones cannot hold",
                          shown, (uint64_t)st.size, (uint64_t)st.comp_size);
    *size = st.size;
    return RC_OK;
}

/* Unpacks the next n bytes, or fewer at the end; -1 on failure. */
static zip_int64_t
read_fully(zip_file_t *f, unsigned char *to, size_t n)
{
    size_t have = 0;

    while (have < n) {
        zip_int64_t got = zip_fread(f, to + have, n - have);
        if (got < 0)
            return -1;
        if (got == 0)
            break;
        have += (size_t)got;
    }
    return (zip_int64_t)have;
}

/* Passes all bytes of a member in chunks to `take` and, unless it is NULL, to `md5`. */
static enum rc_status
unpack(zip_file_t *f, const char *shown, uint64_t size, unsigned char *chunk, struct rc_md5 *md5,
       rc_zip_take *take, void *arg, struct rc_err *err)
{
    uint64_t done = 0;

    /* The read that finds the end checks the CRC. */
    for (;;) {
        zip_int64_t n = read_fully(f, chunk, RC_ZIP_CHUNK);

        if (n < 0)
            return rc_err_set(err, "member '%s' of the archive is damaged: %s", shown,
                              zip_file_strerror(f));
        done += (uint64_t)n;
        if (done > size || (n < RC_ZIP_CHUNK && done < size))
            return rc_err_set(err,
                              "member '%s' of the archive promises %" PRIu64 " bytes and holds %s",
                              shown, size, done > size ? "more" : "fewer");
        if (md5 != NULL)
            rc_md5_add(md5, chunk, (size_t)n);
        if (n > 0 && take(arg, chunk, (size_t)n, err) != RC_OK)
            return RC_FAIL;
        if (n < RC_ZIP_CHUNK)
            return RC_OK;
    }
}

static void
close_file(zip_file_t **f)
{
    if (*f != NULL)
        zip_fclose(*f);
}

enum rc_status
rc_zip_read_member(struct rc_zip_read *a, size_t member, uint64_t most, rc_zip_take *take,
                   void *arg, char md5[RC_MD5_TEXT], struct rc_err *err)
{
    enum rc_status status;
    const char *name = rc_zip_read_name(a, member);
    RC_OWNED unsigned char *chunk = NULL;
    RC_OWN(rc_md5, checksum) = NULL;
    RC_ENDS(close_file) zip_file_t *f = NULL;
    char shown[RC_SHOWN];
    uint64_t size;

    rc_word_shown_to(shown, name);
    if (rc_zip_read_size(a, member, &size, err) != RC_OK)
        return RC_FAIL;
    if (size > most)
        return rc_err_set(err,
                          "member '%s' of the archive holds %" PRIu64
                          " bytes, more than the %" PRIu64 " that are read",
                          shown, size, most);
    if ((f = zip_fopen_index(a->zip, member, 0)) == NULL)
        return rc_err_set(err, "member '%s' of the archive cannot be read: %s", shown,
                          zip_strerror(a->zip));
    if ((chunk = malloc(RC_ZIP_CHUNK)) == NULL)
        return rc_err_set(err, "out of memory for %d bytes", RC_ZIP_CHUNK);
    if (md5 != NULL && (checksum = rc_md5_new(err)) == NULL)
        return RC_FAIL;
    status = unpack(f, shown, size, chunk, checksum, take, arg, err);
    if (status == RC_OK && checksum != NULL)
        rc_md5_get(checksum, md5);
    return status;
}

struct buffer {
    unsigned char *bytes;
    size_t n;
};

static enum rc_status
take_bytes(void *arg, const unsigned char *bytes, size_t n, struct rc_err *err)
{
    struct buffer *b = arg;

    (void)err;
    memcpy(b->bytes + b->n, bytes, n);
    b->n += n;
    return RC_OK;
}

unsigned char *
rc_zip_read_bytes(struct rc_zip_read *a, size_t member, uint64_t most, size_t *n,
                  char md5[RC_MD5_TEXT], struct rc_err *err)
{
    struct buffer b = {0};
    uint64_t size;

    if (rc_zip_read_size(a, member, &size, err) != RC_OK)
        return NULL;
    size = size < most ? size : most; /* a larger one is refused before it is unpacked */
    if ((b.bytes = malloc((size_t)size + 1)) == NULL)
        return rc_err_null(err, "out of memory for %" PRIu64 " bytes", size);
    if (rc_zip_read_member(a, member, most, take_bytes, &b, md5, err) != RC_OK) {
        free(b.bytes);
        return NULL;
    }
    b.bytes[b.n] = '\0';
    *n = b.n;
    return b.bytes;
}

static enum rc_status
take_xml(void *arg, const unsigned char *bytes, size_t n, struct rc_err *err)
{
    return rc_xml_feed(arg, bytes, n, err);
}

enum rc_status
rc_zip_read_xml(struct rc_zip_read *a, size_t member, uint64_t most, const char *name,
                bool attributes, rc_element *element, void *arg, char md5[RC_MD5_TEXT],
                struct rc_err *err)
{
    RC_OWN(rc_xml, xml) = rc_xml_new(name, attributes, element, arg, err);

    if (xml == NULL)
        return RC_FAIL;
    return rc_zip_read_member(a, member, most, take_xml, xml, md5, err) == RC_OK
               ? rc_xml_end(xml, err)
               : RC_FAIL;
}

size_t
rc_zip_read_files(const struct rc_zip_read *archive, size_t *first)
{
    size_t files = 0, members = rc_zip_read_members(archive);

    *first = 0;
    for (size_t k = 0; k < members; k++) {
        const char *name = rc_zip_read_name(archive, k);
        size_t n = strlen(name);

        if (n == 0 || name[n - 1] == '/' || strncmp(name, "__MACOSX/", 9) == 0)
            continue;
        if (files++ == 0)
            *first = k;
    }
    return files;
}
