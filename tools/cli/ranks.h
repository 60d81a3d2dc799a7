/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * A tool under mpirun: its processes share every map, each process with some rows. `ranks` of struct tool is
 * NULL in a build without MPI, and in a tool that was not started by a launcher of MPI. The functions then
 * work for one process. All processes do the same and get the same results; only the first one prints
 * messages and writes reports.
 */
#ifndef RC_TOOL_RANKS_H
#define RC_TOOL_RANKS_H

#include <stdlib.h>

#include "libcontact/contact.h"
#include "tool.h"

/* Connects the processes that a launcher of MPI has started; called at the start of a tool. */
void ranks_start(struct tool *tool);
/* Ends a tool that a launcher has started several times although its processes cannot share maps. */
void ranks_refuse(struct tool *tool);
#ifdef RC_MPI

/* Disconnects the processes; no function of this file may be called afterwards. */
void ranks_end(struct tool *tool);

/* The value for the library's options. */
const struct rc_ranks *ranks_of(const struct tool *tool);
size_t ranks_count(const struct tool *tool);
/* Processes on the machine of this one. */
size_t ranks_beside(const struct tool *tool);
/* True if this process prints messages and writes files other than maps. */
bool ranks_speak(const struct tool *tool);
/* The rows of a map on this process. */
void ranks_rows(const struct tool *tool, const struct rc_shape *shape, size_t *first, size_t *n);
/* Sums and largest values over all processes, and the CRC-32 of all parts in their order. */
double ranks_sum(const struct tool *tool, double v);
/* rc_sum of n values on each process, independent of their number. */
double ranks_total(const struct tool *tool, const double *v, size_t n);
double ranks_most(const struct tool *tool, double v);
uint32_t ranks_crc(const struct tool *tool, uint32_t crc, size_t bytes);
/* RC_OK if all processes have RC_OK; else RC_FAIL on all, with the message of the first one that failed. */
enum rc_status ranks_agree(const struct tool *tool, enum rc_status status, struct rc_err *err);
/* Sends the data of process `root` to all processes. */
void ranks_share(const struct tool *tool, size_t root, void *v, size_t bytes);
/* Waits until all processes have called it. */
void ranks_wait(const struct tool *tool);
/* The process with the largest v, the first of equal ones. */
size_t ranks_where_most(const struct tool *tool, double v);
/* The communication of all processes: see rc_ranks_sent. */
void ranks_sent(const struct tool *tool, struct rc_sent *sent);

/* A file that all processes read or write, each its own part: for rcg.h. */
const struct rc_share *ranks_read(struct tool *tool, const char *name);
const struct rc_share *ranks_write(struct tool *tool, const char *name);
/* Waits until the data of all processes is on the disk; returns at once if share is NULL. All get the same
 * status. */
enum rc_status ranks_settle(const struct rc_share *share, struct rc_err *err);
void ranks_close(struct tool *tool, const struct rc_share *share);

/* After a signal: makes SIGALRM come before the launcher kills its processes. Safe in a signal handler. */
void ranks_hurry(const struct tool *tool);

/* Ends this process, which cannot continue, and the others. It waits a moment for the others to call it too.
 * Then the first one prints the reason, and all end with the largest status; if some do not call it, this
 * process prints the reason. The others are killed. `say` prints the message and removes incomplete files. */
_Noreturn void ranks_die(struct tool *tool, int status, const char *text,
                         void (*say)(struct tool *tool, int status, const char *text));

#else /* there is one process */
#define ranks_end(tool) ((void)(tool))
#define ranks_of(tool) ((void)(tool), (const struct rc_ranks *)NULL)
#define ranks_count(tool) ((void)(tool), (size_t)1)
#define ranks_beside(tool) ((void)(tool), (size_t)1)
#define ranks_speak(tool) ((void)(tool), true)
#define ranks_rows(tool, shape, first, n)                                                          \
    ((void)(tool), (void)(*(first) = 0), (void)(*(n) = (shape)->ny))
#define ranks_sum(tool, v) ((void)(tool), (v))
#define ranks_total(tool, v, n) ((void)(tool), rc_sum(v, n))
#define ranks_most(tool, v) ((void)(tool), (v))
#define ranks_crc(tool, crc, bytes) ((void)(tool), (void)(bytes), (crc))
#define ranks_agree(tool, status, err) ((void)(tool), (void)(err), (status))
#define ranks_share(tool, root, v, bytes) ((void)(tool), (void)(root), (void)(v), (void)(bytes))
#define ranks_wait(tool) ((void)(tool))
#define ranks_where_most(tool, v) ((void)(tool), (void)(v), (size_t)0)
#define ranks_sent(tool, sent) ((void)(tool), (void)(*(sent) = (struct rc_sent){0}))
#define ranks_read(tool, name) ((void)(tool), (void)(name), (const struct rc_share *)NULL)
#define ranks_write(tool, name) ((void)(tool), (void)(name), (const struct rc_share *)NULL)
#define ranks_settle(share, err) ((void)(share), (void)(err), RC_OK)
#define ranks_close(tool, share) ((void)(tool), (void)(share))
#define ranks_hurry(tool) ((void)(tool))
#define ranks_die(tool, status, text, say) ((say)(tool, status, text), exit(status))
#endif

#endif
