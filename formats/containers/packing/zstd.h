/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames of Zstandard (RFC 8878) inside files; only this file uses libzstd; without it such frames are
 * refused. */
#ifndef RC_ZSTD_H
#define RC_ZSTD_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/owned.h"

/* True if this build has libzstd. */
bool rc_zstd_is_there(void);
/* Unpacks the n bytes of a frame into *size bytes, at most `most`, followed by a NUL; the caller frees them;
 * NULL with the reason. `what`: name of the bytes in the message. */
unsigned char *rc_zstd_unpack(const char *what, const unsigned char *from, size_t n, size_t most,
                              size_t *size, struct rc_err *err);

#endif
