/*
 * Pipes between tools.
 */
#ifndef RC_PIPE_H
#define RC_PIPE_H

#include <stdbool.h>

/* Where fd is a pipe and the system lets us say so, it holds 1 MiB: fewer turns between this
 * tool and the next. */
void pipe_widen(int fd);
/* Whether what is written to fd, or read from it, goes through a pipe or a socket: to or from
 * another program that runs now. */
bool pipe_is(int fd);

#endif
