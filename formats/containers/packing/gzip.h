/* Files that were packed with gzip; see gzip.c. */
#ifndef RC_GZIP_H
#define RC_GZIP_H

#include <stddef.h>

#include "formats/core/core.h"

/* Whether a file was packed with gzip. */
bool rc_file_packed(const struct rc_file *file);
/* Unpacks the file into *size bytes, at most `most`, which the caller frees; NULL where they would
 * be more, or are cut short or damaged, before memory is taken for them. */
unsigned char *rc_file_unpack(const struct rc_file *file, size_t most, size_t *size,
                              struct rc_err *err);

#endif
