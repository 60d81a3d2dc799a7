/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gzip files; see gzip.c. */
#ifndef RC_GZIP_H
#define RC_GZIP_H

#include <stddef.h>

#include "formats/core/core.h"

/* True for a gzip file. */
bool rc_file_packed(const struct rc_file *file);
/* Unpacks the file into *size bytes, at most `most`. The caller frees them. NULL, before memory is allocated,
 * if there would be more, or if the data are cut off or damaged. */
unsigned char *rc_file_unpack(const struct rc_file *file, size_t most, size_t *size,
                              struct rc_err *err);

#endif
