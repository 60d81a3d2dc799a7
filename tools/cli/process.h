/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sibling tools as processes. */
#ifndef RC_PROCESS_H
#define RC_PROCESS_H

#include <stdio.h>

#include "tool.h"

enum process_end {
    PROCESS_ENDED,       /* ended with exit status 0 or 3 */
    PROCESS_FAILED,      /* ended with another exit status */
    PROCESS_LATE,        /* exceeded the permitted time */
    PROCESS_INTERRUPTED, /* the tool received a signal  */
    PROCESS_DIED,        /* by a signal                 */
};

struct process {
    int in, out;        /* its standard input and output; out -1: the output goes to `said` */
    const char *folder; /* its working folder; NULL: that of this tool */
    double allowed;     /* s */
    const char *doing;  /* name for the progress line */
    char *said;         /* its standard error, which the caller frees; NULL: empty */
    int status;         /* its exit status; -1: none */
};

/* Runs a command: the tool with this name in the folder of this tool, otherwise on PATH. It reads `in` from
 * the beginning, and is killed when this tool ends. */
enum process_end process_run(struct tool *tool, const char *const word[], struct process *process);
#endif
