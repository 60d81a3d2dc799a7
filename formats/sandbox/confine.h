/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Limits for libraries that are not safe with malicious files. */
#ifndef RC_CONFINE_H
#define RC_CONFINE_H

#include "formats/core/core.h"

/* Seconds of processor time that reading the file may take. */
double rc_confine_seconds(const struct rc_file *file);

/* Limits the calling process for the rest of its life. It gets rc_confine_seconds of processor time, ten
 * times that of wall-clock time, and rc_memory_limit of memory beyond its own. It may open no further file
 * and dumps no core. Signals get their default action and are unblocked: at the time limit SIGPROF or SIGALRM
 * ends the process. If it has blocked these, SIGKILL ends it after one or two more seconds of processor
 * time. */
void rc_confine(const struct rc_file *file);

#endif
