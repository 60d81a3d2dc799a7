/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Pipes between tools.
 */
#ifndef RC_PIPE_H
#define RC_PIPE_H

#include <stdbool.h>

/* If fd is a pipe and the system permits it, sets its capacity to 1 MiB: fewer switches between this tool and
 * the next. */
void pipe_widen(int fd);
/* True if fd is a pipe or a socket: connected to another program that runs now. */
bool pipe_is(int fd);

#endif
