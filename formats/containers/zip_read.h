/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * ZIP archives in memory; only these files use libzip. A member is read only if it is stored or deflated and
 * its packed bytes can give its size. So a few bytes cannot make a program allocate much memory.
 */
#ifndef RC_ZIP_READ_H
#define RC_ZIP_READ_H

#include <stddef.h>
#include <stdint.h>

#include "checksum.h"
#include "xml.h"
#include "formats/core/core.h"
#include "libcontact/owned.h"

struct rc_zip_read;

/* The bytes of the file must outlive the archive. NULL if they are not a ZIP archive, or damaged. */
struct rc_zip_read *rc_zip_read_new(const struct rc_file *file, struct rc_err *err);
/* The same with other bytes before the archive, whose offsets include them. */
struct rc_zip_read *rc_zip_read_behind(const struct rc_file *file, struct rc_err *err);
void rc_zip_read_free(struct rc_zip_read *archive); /* NULL is allowed */
RC_OWNER(rc_zip_read)

size_t rc_zip_read_members(const struct rc_zip_read *archive);
const char *rc_zip_read_name(const struct rc_zip_read *archive, size_t member); /* "" for none */
/* The member with this name; RC_FAIL if there is none. */
enum rc_status rc_zip_read_find(const struct rc_zip_read *archive, const char *name, size_t *member,
                                struct rc_err *err);
/* The number of members that are files (without folders and files of macOS), and the first of them. */
size_t rc_zip_read_files(const struct rc_zip_read *archive, size_t *first);
/* Its unpacked size. RC_FAIL if it is implausible. */
enum rc_status rc_zip_read_size(struct rc_zip_read *archive, size_t member, uint64_t *size,
                                struct rc_err *err);

enum {
    RC_ZIP_CHUNK = 1 << 18
};
/* Receives the next bytes of a member: RC_ZIP_CHUNK of them, fewer at the end. */
typedef enum rc_status rc_zip_take(void *arg, const unsigned char *bytes, size_t n,
                                   struct rc_err *err);
/* Unpacks a member of at most `most` bytes through `take`, checks its CRC, and returns the MD5 checksum of
 * its bytes unless `md5` is NULL. */
enum rc_status rc_zip_read_member(struct rc_zip_read *archive, size_t member, uint64_t most,
                                  rc_zip_take *take, void *arg, char md5[RC_MD5_TEXT],
                                  struct rc_err *err);

/* Returns all bytes of a member of at most `most` bytes, followed by a NUL. The caller frees them. NULL with
 * the reason. `md5` as above. */
unsigned char *rc_zip_read_bytes(struct rc_zip_read *archive, size_t member, uint64_t most,
                                 size_t *n, char md5[RC_MD5_TEXT], struct rc_err *err);

/* Parses a member of at most `most` bytes as an XML document, named `name` in messages, with `element` and
 * `arg` as in xml.h. `md5` as above. */
enum rc_status rc_zip_read_xml(struct rc_zip_read *archive, size_t member, uint64_t most,
                               const char *name, bool attributes, rc_element *element, void *arg,
                               char md5[RC_MD5_TEXT], struct rc_err *err);

#endif
