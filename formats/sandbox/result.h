/* What a process in a cage (cage.h) tells the one outside: written there, read and checked here. */
#ifndef RC_ANSWER_H
#define RC_ANSWER_H

#include <stdio.h>
#include <sys/types.h>

#include "formats/format.h"

/* Of a child and its parent. */
struct rc_pipes {
    pid_t child;
    FILE *answer; /* child to parent                                                         */
    int reply;    /* a socket: a child that has died is no reason to be ended by a signal    */
};

/* Each gives whether it went through. A list is n channels, of which `most` at most are told, or
 * the reason why there is none. */
bool rc_answer_send_list(struct rc_pipes *pipes, const struct rc_channel *channel, size_t n,
                         size_t most, const struct rc_err *said);
bool rc_answer_take_list(struct rc_pipes *pipes, struct rc_channel *channel, size_t *n, size_t most,
                         struct rc_err *said);
/* A grid, or NULL and the reason. Its values stay where they are and are fetched from there, where
 * the system lets the parent do so, else they go through the pipe. */
bool rc_answer_send_grid(struct rc_pipes *pipes, const struct rc_grid *grid,
                         const struct rc_notes *noted, const struct rc_err *said);
bool rc_answer_take_grid(struct rc_pipes *pipes, const struct rc_file *file, struct rc_grid **grid,
                         struct rc_notes *noted, struct rc_err *said);

#endif
