/* ZIP archives on their way out; beside archive.c the only place that knows libzip. */
#ifndef RC_ZIP_WRITE_H
#define RC_ZIP_WRITE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "libcontact/grid.h"

struct rc_pack;

/* `time` is that of all members, in seconds since 1970. */
struct rc_pack *rc_pack_new(int64_t time, struct rc_err *err);
/* Adds a member. The bytes come from malloc and become the pack's own, whatever the answer. */
enum rc_status rc_pack_add(struct rc_pack *pack, const char *name, void *bytes, size_t n,
                           struct rc_err *err);
/* Packs and writes; once. */
enum rc_status rc_pack_write(struct rc_pack *pack, FILE *out, struct rc_err *err);
void rc_pack_free(struct rc_pack *pack); /* NULL is allowed */

#endif
