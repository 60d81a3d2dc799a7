/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The system calls that a child in the sandbox may use. */
#ifndef RC_CALLS_H
#define RC_CALLS_H

#include <stdbool.h>

/* True if this system can filter calls: Linux on the processors that calls.c names. */
bool rc_calls_can_be_filtered(void);

/* Restricts the calling process, for the rest of its life, to computing and to writing to the file descriptor
 * `out`. Allowed are also memory that is not executable, the clock, and its exit. All else fails with EPERM:
 * opening, creating, removing and changing files, sockets, processes, signals to others, also with
 * descriptors that it has inherited. False where the filter cannot be set although the system filters
 * calls. */
bool rc_calls_filter(int out);

#endif
