/*
 * ZIP archives in memory; the only place that knows libzip.
 *
 * A member is taken only when it is stored or deflated and its size is one that its packed bytes
 * can yield, so that no few bytes make a program ask for much memory.
 */
#ifndef RC_ZIP_READ_H
#define RC_ZIP_READ_H

#include <stddef.h>
#include <stdint.h>

#include "checksum.h"
#include "xml.h"
#include "formats/core/core.h"
#include "libcontact/grid.h"

struct rc_zip_read;

/* The file's bytes must outlive the archive. NULL when they are no ZIP archive or a damaged one. */
struct rc_zip_read *rc_zip_read_new(const struct rc_file *file, struct rc_err *err);
/* The same where other bytes stand before the archive, whose offsets count them. */
struct rc_zip_read *rc_zip_read_behind(const struct rc_file *file, struct rc_err *err);
void rc_zip_read_free(struct rc_zip_read *archive); /* NULL is allowed */

size_t rc_zip_read_members(const struct rc_zip_read *archive);
const char *rc_zip_read_name(const struct rc_zip_read *archive, size_t member); /* "" for none */
/* The member of that name; RC_FAIL when there is none. */
enum rc_status rc_zip_read_find(const struct rc_zip_read *archive, const char *name, size_t *member,
                                struct rc_err *err);
/* The number of members that are files and no folders, notes of macOS apart, and the first of them. */
size_t rc_zip_read_files(const struct rc_zip_read *archive, size_t *first);
/* Its size unpacked. RC_FAIL when it is not to be trusted. */
enum rc_status rc_zip_read_size(struct rc_zip_read *archive, size_t member, uint64_t *size,
                                struct rc_err *err);

enum {
    RC_ZIP_CHUNK = 1 << 18
};
/* Takes the next bytes of a member: RC_ZIP_CHUNK of them, at the end fewer. */
typedef enum rc_status rc_zip_take(void *arg, const unsigned char *bytes, size_t n,
                                   struct rc_err *err);
/* Unpacks a member of at most `most` bytes into `take`, checks its CRC, and gives the MD5 checksum
 * of its bytes unless `md5` is NULL. */
enum rc_status rc_zip_read_member(struct rc_zip_read *archive, size_t member, uint64_t most,
                                  rc_zip_take *take, void *arg, char md5[RC_MD5_TEXT],
                                  struct rc_err *err);

/* The whole of a member of at most `most` bytes, with a NUL behind them, which the caller frees;
 * NULL with the reason. `md5` as above. */
unsigned char *rc_zip_read_bytes(struct rc_zip_read *archive, size_t member, uint64_t most,
                                 size_t *n, char md5[RC_MD5_TEXT], struct rc_err *err);

/* Unpacks a member of at most `most` bytes that is an XML document called `name` in messages, with
 * `element` and `arg` as xml.h has them. `md5` as above. */
enum rc_status rc_zip_read_xml(struct rc_zip_read *archive, size_t member, uint64_t most,
                               const char *name, bool attributes, rc_element *element, void *arg,
                               char md5[RC_MD5_TEXT], struct rc_err *err);

#endif
