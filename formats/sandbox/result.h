/* How the child of a sandbox hands its result to the parent. The parent checks all of it: a file
 * may have got hold of the child. */
#ifndef RC_RESULT_H
#define RC_RESULT_H

#include <stdio.h>
#include <sys/types.h>

#include "formats/core/core.h"

/* The child writes to `result` and reads from `reply`, the parent the other way round. */
struct rc_pipes {
    pid_t child;
    FILE *result;
    size_t held; /* parent: rc_child_memory_held when the values came */
    int reply;   /* a socket: writing to a child that has died must not end the parent by SIGPIPE */
};

/* All return whether everything went through. A list is n channels, of which the first `most` are
 * sent; when n is 0, `said` is the reason. */
bool rc_result_send_list(struct rc_pipes *pipes, const struct rc_channel *channel, size_t n,
                         size_t most, const struct rc_err *said);
bool rc_result_receive_list(struct rc_pipes *pipes, struct rc_channel *channel, size_t *n,
                            size_t most, struct rc_err *said);
/* A grid, or NULL with the reason in `said`. The parent copies the values out of the child's memory
 * where the system allows that; else they go through the pipe. */
bool rc_result_send_grid(struct rc_pipes *pipes, const struct rc_grid *grid,
                         const struct rc_notes *noted, const struct rc_err *said);
bool rc_result_receive_grid(struct rc_pipes *pipes, const struct rc_file *file,
                            struct rc_grid **grid, struct rc_notes *noted, struct rc_err *said);

#endif
