/* How much memory a file may make a reader take, whatever its header promises: packed data can
 * promise any number of values in a few bytes. */
#ifndef RC_LIMIT_H
#define RC_LIMIT_H

#include "wish.h"

/* Bytes beyond its own that reading a file of that size may take: 16 times its size and 64 MiB. */
size_t rc_memory_limit(size_t file_size);
/* RC_FAIL when the values of a map are more than that. */
enum rc_status rc_map_fits(const struct rc_file *file, size_t nx, size_t ny, struct rc_err *err);

#endif
