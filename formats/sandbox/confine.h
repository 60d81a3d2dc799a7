/* The bounds within which a file may be read by a library that was not made for hostile files. */
#ifndef RC_CONFINE_H
#define RC_CONFINE_H

#include "formats/core/core.h"

/* Seconds of processor time that reading the file may take. */
double rc_confine_seconds(const struct rc_file *file);

/* Bounds the calling process for the rest of its life: rc_confine_seconds of processor time and ten times
 * that by the clock, rc_memory_limit of memory beyond what it has, no further open file, no core dump.
 * Signals get their default action back and none is blocked: when the time is over, SIGPROF or SIGALRM
 * ends the process. If the process has blocked these, SIGKILL ends it after one or two more seconds of
 * processor time. */
void rc_confine(const struct rc_file *file);

#endif
