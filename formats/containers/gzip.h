/* Files that were packed with gzip; see gzip.c. */
#ifndef RC_GZIP_H
#define RC_GZIP_H

#include <stddef.h>

#include "formats/core/core.h"

/* Whether a file was packed with gzip. */
bool rc_file_packed(const struct rc_file *file);
/* Its *size bytes unpacked, up to `most`, which the caller frees; NULL where they are more, cut
 * short or damaged, before any memory is taken for them. */
unsigned char *rc_file_unpack(const struct rc_file *file, size_t most, size_t *size,
                              struct rc_err *err);

#endif
