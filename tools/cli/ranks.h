/*
 * A tool under mpirun: its processes share every map, each with rows of its own. A build without
 * MPI, and a tool that was not started by a launcher of MPI, has struct tool's `ranks` NULL and is
 * alone: the functions then answer for one process.
 *
 * All processes do the same and find the same; the first one alone speaks to people and writes reports.
 */
#ifndef RC_TOOL_RANKS_H
#define RC_TOOL_RANKS_H

#include "libcontact/contact.h"
#include "tool.h"

/* Connects the processes that a launcher of MPI has started. At the start of a tool that can share maps. */
void ranks_start(struct tool *tool);
/* Disconnects the processes; nothing of them may be used any more. */
void ranks_end(struct tool *tool);

/* For the options of the library. */
const struct rc_ranks *ranks_of(const struct tool *tool);
size_t ranks_count(const struct tool *tool);
/* Whether this process prints messages and writes files that are no maps. */
bool ranks_speak(const struct tool *tool);
/* Rows of a map that are held here. */
void ranks_rows(const struct tool *tool, const struct rc_shape *shape, size_t *first, size_t *n);
/* Sums and largest values over all processes, and the CRC-32 of all parts one after another. */
double ranks_sum(const struct tool *tool, double v);
double ranks_most(const struct tool *tool, double v);
uint32_t ranks_crc(const struct tool *tool, uint32_t crc, size_t bytes);
/* RC_OK when all processes have RC_OK; else RC_FAIL for all, with the sentence of the first that cannot go
 * on. */
enum rc_status ranks_agree(const struct tool *tool, enum rc_status status, struct rc_err *err);
/* All processes get what process `root` has. */
void ranks_share(const struct tool *tool, size_t root, void *v, size_t bytes);
/* Waits until all processes have come here. */
void ranks_wait(const struct tool *tool);
/* The process whose v is the largest, the first of equals. */
size_t ranks_where_most(const struct tool *tool, double v);
/* What all processes have sent: see rc_ranks_sent. */
void ranks_sent(const struct tool *tool, struct rc_sent *sent);

/* A file of which each process reads or writes its part: for rcg.h. */
const struct rc_share *ranks_read(struct tool *tool, const char *name);
const struct rc_share *ranks_write(struct tool *tool, const char *name);
/* Waits until the disk has what all processes have written; share NULL: nothing to wait for. All get the same
 * status. */
enum rc_status ranks_settle(const struct rc_share *share, struct rc_err *err);
void ranks_close(struct tool *tool, const struct rc_share *share);

/* After a signal: makes SIGALRM come before the launcher kills its processes. Safe in a signal handler. */
void ranks_hurry(const struct tool *tool);

/* Ends this process, which cannot go on, and the others. Waits a moment for the others to come here too: then
 * the first one says why, and all end with the largest status; if not all come, this one says why, and the
 * others are killed. `say` prints the message and removes half-written files. */
_Noreturn void ranks_die(struct tool *tool, int status, const char *text,
                         void (*say)(struct tool *tool, int status, const char *text));

#endif
