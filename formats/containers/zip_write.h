/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writing of ZIP archives; only this file and zip_read.c use libzip. */
#ifndef RC_ZIP_WRITE_H
#define RC_ZIP_WRITE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "libcontact/owned.h"

struct rc_zip_write;

/* `time` is the time of all members, in seconds since 1970. */
struct rc_zip_write *rc_zip_write_new(int64_t time, struct rc_err *err);
/* Adds a member; at most 16 are possible. The bytes come from malloc; the archive takes them over, also on
 * failure. */
enum rc_status rc_zip_write_add(struct rc_zip_write *archive, const char *name, void *bytes,
                                size_t n, struct rc_err *err);
/* Compresses the members and writes the archive; called once, at the end. */
enum rc_status rc_zip_write_finish(struct rc_zip_write *archive, FILE *out, struct rc_err *err);
void rc_zip_write_free(struct rc_zip_write *archive); /* NULL is allowed */
RC_OWNER(rc_zip_write)

#endif
