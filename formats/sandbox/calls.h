/* The calls to the system that are left to a child in the sandbox. */
#ifndef RC_CALLS_H
#define RC_CALLS_H

#include <stdbool.h>

/* Whether this system can filter calls: Linux on the processors that calls.c names. */
bool rc_calls_can_be_filtered(void);

/* Leaves the calling process, for the rest of its life, what it needs to compute and to write to the file
 * descriptor `out`: memory that is not executable, the clock, its own end. All else fails with EPERM: opening,
 * creating, removing and changing files, sockets, processes, signals to others, also with descriptors that it
 * has inherited. False where the filter cannot be set although the system filters calls. */
bool rc_calls_filter(int out);

#endif
