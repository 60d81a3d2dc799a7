/*
 * Pipes between tools.
 */
#ifndef RC_PIPE_H
#define RC_PIPE_H

/* Where fd is a pipe and the system lets us say so, it holds 1 MiB: fewer turns between this
 * tool and the next. */
void pipe_widen(int fd);

#endif
