/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compound files of Microsoft (OLE): named streams in sectors, which tables chain. */
#ifndef RC_OLE_H
#define RC_OLE_H

#include <stddef.h>

#include "formats/core/core.h"
#include "libcontact/owned.h"

/* True if it begins like such a file. */
bool rc_ole_is(const struct rc_file *file);
/* Returns the *n bytes of the first stream with this name (ASCII) in any folder. The caller frees them. NULL
 * with the reason. No stream is longer than the file. */
unsigned char *rc_ole_stream(const struct rc_file *file, const char *name, size_t *n,
                             struct rc_err *err);

#endif
