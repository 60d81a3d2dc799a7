/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A separate process for libraries that are not safe with malicious files (libhdf5, libtiff). They run in a
 * child with limited memory and time that cannot open files and, where the system can filter calls, can only
 * compute. The child sends its result through a pipe. If it dies, the file is refused and nothing else is
 * affected. confine.h and calls.h have the limits. Call from one thread.
 */
#ifndef RC_SANDBOX_H
#define RC_SANDBOX_H

#include "formats/core/core.h"

/* The same as rc_maps_describe and rc_maps_read. Each opens the file in a child of its own: the maps can only
 * be listed and read by these. */
enum rc_status rc_sandbox_describe(struct rc_maps *maps, rc_maps_find *find, struct rc_err *err);
struct rc_grid *rc_sandbox_read(struct rc_maps *maps, rc_maps_find *find,
                                const struct rc_wish *wish, size_t index, struct rc_notes *notes,
                                struct rc_err *err);

/* From now on the functions run in this process, without limits: for fuzzers, whose sanitizers must see them.
 * false: in the sandbox again. */
void rc_sandbox_bypass(bool bypass);

#endif
