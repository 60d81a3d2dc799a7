/* The bounds within which a file may be read by a library that was not made for hostile files. */
#ifndef RC_CONFINE_H
#define RC_CONFINE_H

#include "formats/core/core.h"

/* Seconds of processor time that reading the file may take. */
double rc_confine_seconds(const struct rc_file *file);

/* Bounds the calling process for the rest of its life: rc_confine_seconds of processor time and ten
 * times that by the clock, rc_memory_limit of memory beyond what it has, no further open file, no
 * core dump. Signals have their default action again and none is blocked: SIGPROF or SIGALRM ends it when
 * its time is over, and where it has come to block these, SIGKILL after one to two more of the processor. */
void rc_confine(const struct rc_file *file);

#endif
