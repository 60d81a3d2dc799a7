/* Compound files of Microsoft (OLE): streams by name, in sectors that tables chain. */
#ifndef RC_OLE_H
#define RC_OLE_H

#include <stddef.h>

#include "formats/core/core.h"
#include "libcontact/grid.h"

/* Whether it begins as such a file does. */
bool rc_ole_is(const struct rc_file *file);
/* The whole of the first stream of that name (ASCII), in whichever folder, of *n bytes, which the caller
 * frees; NULL with the reason. No stream is longer than the file. */
unsigned char *rc_ole_stream(const struct rc_file *file, const char *name, size_t *n,
                             struct rc_err *err);

#endif
