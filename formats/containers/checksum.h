/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * MD5 (RFC 1321), the checksum of X3P files; only this file uses libmd. It detects accidental damage, not
 * manipulation.
 */
#ifndef RC_CHECKSUM_H
#define RC_CHECKSUM_H

#include <stddef.h>

#include "libcontact/owned.h"

enum {
    RC_MD5_TEXT = 33 /* 32 hexadecimal digits in lower case, and the NUL */
};

/* The checksum of n bytes. */
void rc_md5_of(const void *bytes, size_t n, char text[RC_MD5_TEXT]);

/* The same for bytes in several blocks. */
struct rc_md5;

struct rc_md5 *rc_md5_new(struct rc_err *err); /* NULL when memory is short */
void rc_md5_add(struct rc_md5 *md5, const void *bytes, size_t n);
void rc_md5_get(struct rc_md5 *md5, char text[RC_MD5_TEXT]); /* once, last */
void rc_md5_free(struct rc_md5 *md5);                        /* NULL is allowed */
RC_OWNER(rc_md5)

#endif
