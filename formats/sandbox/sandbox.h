/*
 * A separate process for libraries that are not safe with malicious files (libhdf5, libtiff). They run in a
 * child with limited memory and time that cannot open files and, where the system can filter calls, can only
 * compute. The child sends its result through a pipe. If it dies, the file is refused and nothing else is
 * affected. confine.h and calls.h have the limits. Call from one thread.
 */
#ifndef RC_SANDBOX_H
#define RC_SANDBOX_H

#include "formats/core/core.h"

/* The same as rc_maps_list and rc_maps_read. */
size_t rc_sandbox_list(rc_maps_find *find, const struct rc_file *file, const struct rc_wish *wish,
                       struct rc_channel *channel, size_t most, struct rc_err *err);
struct rc_grid *rc_sandbox_read(rc_maps_find *find, const struct rc_file *file,
                                const struct rc_wish *wish, size_t index, struct rc_notes *notes,
                                struct rc_err *err);

/* From now on the functions run in this process, without limits: for fuzzers, whose sanitizers must see them.
 * false: in the sandbox again. */
void rc_sandbox_bypass(bool bypass);

#endif
