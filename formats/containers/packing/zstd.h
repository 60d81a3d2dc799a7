/* Frames of Zstandard (RFC 8878) inside files; the only place that knows libzstd, without which they are
 * refused. */
#ifndef RC_ZSTD_H
#define RC_ZSTD_H

#include <stdbool.h>
#include <stddef.h>

#include "libcontact/grid.h"

/* Whether this build has libzstd. */
bool rc_zstd_is_there(void);
/* Unpacks the n bytes of a frame into *size bytes, at most `most`, with a NUL behind them, which the caller
 * frees; NULL with the reason. `what` they are, for that. */
unsigned char *rc_zstd_unpack(const char *what, const unsigned char *from, size_t n, size_t most,
                              size_t *size, struct rc_err *err);

#endif
